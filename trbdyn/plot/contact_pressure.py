"""Picture of the pressure between a roller and a raceway, of two half spaces and of slices."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from trbdyn.base.display import amount
from trbdyn.base.expected import expect
from trbdyn.plot.style import legend, line, scaled, sequence, styled
from trbdyn.run.contact_pressure import ContactPressure

SEEN = 1.05
"""Half width of the map over the half width of the contact."""


def contact_pressure(found: ContactPressure) -> Figure:
    """Map of the pressure; along the line the largest pressure, the load, and the largest shear stress below the surface.

    Parameters
    ----------
    found : ContactPressure
        Of `trbdyn.contact_pressure`.

    Examples
    --------
    >>> import trbdyn as trb
    >>> figure = trb.plot.contact_pressure(trb.contact_pressure(trb.cases.scene_32216()))
    >>> figure.axes[1].get_ylabel()
    'Largest pressure (MPa)'
    """
    expect("found", found, ContactPressure)
    x, y = 1e3 * found.x, 1e3 * found.y
    loaded = np.flatnonzero(found.pressure.any(axis=0))
    half = SEEN * float(np.abs(found.x[loaded]).max() + 0.5 * found.cell[0])
    shear = found.shear
    factor, unit = scaled("Pa", found.pressure)
    with styled():
        figure, axes = plt.subplots(4, 1, sharex=True, figsize=(6.8, 8.6), layout="constrained")
        mesh = axes[0].pcolormesh(y, x, factor * found.pressure.T, cmap=sequence(), vmin=0.0, shading="nearest")
        axes[0].set(ylabel="Across (mm)", ylim=(-1e3 * half, 1e3 * half))
        axes[0].grid(visible=False)
        figure.colorbar(mesh, ax=axes[0], label=f"Pressure ({unit})")
        for ax, values, slices in (
            (axes[1], factor * found.along, factor * found.slice_pressure),
            (axes[2], 1e-3 * found.load_per_length, 1e-3 * found.slice_load_per_length),
        ):
            line(ax, y, values, 0, "half spaces")
            line(ax, y, slices, 1, "slices")
            legend(ax)
        axes[1].set(ylabel=f"Largest pressure ({unit})")
        axes[2].set(ylabel="Load per length (N/mm)")
        line(axes[3], y, factor * shear.largest, 0, "half of the difference of principal stresses")
        line(axes[3], y, factor * shear.orthogonal, 1, "in planes along the surface")
        axes[3].set(
            ylabel=f"Largest shear stress\nbelow the surface ({unit})",
            xlabel="Place along the roller, towards its large end (mm)",
        )
        legend(axes[3])
        title = f"Roller {found.roller} on the {found.raceway} raceway: {amount(found.load, 'N')}"
        figure.suptitle("\n".join([title, *found.warnings[:2]]), fontsize=10, wrap=True)
    return figure
