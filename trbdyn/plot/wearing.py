"""The picture of wear and of the power of friction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from trbdyn.plot.style import COLOURS, line, sequence, styled

if TYPE_CHECKING:
    import xarray


def wear_map(found: xarray.Dataset) -> Figure:
    """Depth that wears off raceways and rib in an hour, and where contacts are heated most by friction.

    Parameters
    ----------
    found : xarray.Dataset
        Of `trbdyn.wear`.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(500.0, 4930.0, lubricant=trb.lubricants.vg100(110.0))
    >>> found = trb.wear(trb.Simulation(scene).run(revolutions=1), coefficient=1e-17, records=20)
    >>> len(trb.plot.wear_map(found).axes)
    6
    """
    station, angle = 1e3 * found.station.values, found.angle.values
    middle = 0.5 * (station[1:] + station[:-1])
    ends = np.concatenate([[1.5 * station[0] - 0.5 * station[1]], middle, [1.5 * station[-1] - 0.5 * station[-2]]])
    edges = np.linspace(0.0, 360.0, angle.size + 1)
    with styled():
        figure, axes = plt.subplots(4, 1, figsize=(6.8, 9.0), layout="constrained")
        figure.suptitle(
            f"Wear by Archard's law, k = {found.attrs['coefficient']:.1e} m²/N, and heat by sliding", fontsize=11
        )
        for ax, race in zip(axes[:2], ("outer", "inner"), strict=True):
            depth = 1e9 * found.raceway_depth.sel(race=race).values
            mesh = ax.pcolormesh(edges, ends, depth.T, cmap=sequence(), vmin=0.0, vmax=max(float(depth.max()), 1e-12))
            ax.set(title=f"{race} raceway", ylabel="along the roller (mm)", xticks=range(0, 361, 45))
            ax.grid(visible=False)
            bar: Any = figure.colorbar(mesh, ax=ax)
            bar.set_label("depth (nm/h)")
        axes[1].set_xlabel("place on the ring from x towards y (deg)")
        line(axes[2], 1e3 * found.height.values, 1e9 * found.rib_depth.values, 0)
        axes[2].set(title="back-face rib", xlabel="height above the raceway (mm)", ylabel="depth (nm/h)")
        for index, race in enumerate(("outer", "inner")):
            power = 1e-3 * found.friction_power.sel(race=race).values
            axes[3].plot(angle, power, color=COLOURS[2 * index], label=f"{race} raceway", linewidth=1.2)
        axes[3].set(
            title="largest power of friction for the area of a contact",
            xlabel="place around the bearing from x towards y (deg)",
            ylabel="power (kW/m²)",
            xticks=range(0, 361, 45),
            xlim=(0, 360),
        )
        axes[3].legend(fontsize=8)
    return figure
