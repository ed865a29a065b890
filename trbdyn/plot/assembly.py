"""Pictures of a shaft on several bearings: preload diagram and load zones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from trbdyn.plot.style import COLOURS, GREY, LINES, canvas, legend, line, styled

if TYPE_CHECKING:
    from trbdyn.statics.assembly import ShaftEquilibrium
    from trbdyn.statics.preload import PreloadDiagram


def preload_diagram(diagram: PreloadDiagram, ax: Axes | None = None) -> Axes:
    """Axial load of each bearing, and the axial force on the shaft, over the shaft's axial displacement.

    Parameters
    ----------
    diagram : PreloadDiagram
        What `trbdyn.preload_diagram` gave.
    ax : Axes, optional
        Axes to draw into.

    Returns
    -------
    Axes
    """
    with canvas(ax, title="Preload diagram") as ax:
        place = 1e6 * diagram.displacement
        for index, (name, load) in enumerate(diagram.loads.items()):
            line(ax, place, 1e-3 * load, index, f"axial load of {name}")
        line(ax, place, 1e-3 * diagram.axial_force, len(diagram.loads), "axial force on the shaft")
        middle = 1e6 * float(diagram.preload.displacement()[2])
        for one in diagram.preload.bearings:
            ax.plot(middle, 1e-3 * one.axial_load, "o", color=GREY, ms=5)
        ax.axhline(0.0, color=GREY, linewidth=0.8)
        ax.axvline(middle, color=GREY, linewidth=0.8, linestyle=":")
        ax.set(xlabel="axial displacement of the shaft to the right (um)", ylabel="axial load (kN)")
        legend(ax)
    return ax


def load_zones(found: ShaftEquilibrium) -> Figure:
    """Loads of the rollers around each bearing (polar), looking along the shaft's z axis: x to the right, y upwards.

    Parameters
    ----------
    found : ShaftEquilibrium
        What `trbdyn.equilibrium` gave.

    Returns
    -------
    Figure
    """
    with styled():
        count = len(found.bearings)
        figure, axes = plt.subplots(
            1, count, figsize=(3.6 * count, 4.4), subplot_kw={"projection": "polar"}, squeeze=False
        )
        largest = max(1.0, *(float(one.outer_load.max()) for one in found.bearings))
        for ax, one in zip(axes[0], found.bearings, strict=True):
            order = np.argsort(one.angles)
            around = np.append(one.angles[order], one.angles[order][0])
            for index, (label, load) in enumerate((("outer ring", one.outer_load), ("inner ring", one.inner_load))):
                values = np.append(load[order], load[order][0])
                style = {"color": COLOURS[index], "linestyle": LINES[index], "marker": "o", "markersize": 3.0}
                ax.plot(around, values, label=f"{label}, {load.min():.4g} to {load.max():.4g} N", **style)
            ax.set_ylim(0.0, 1.05 * largest)
            ax.set_thetagrids(range(0, 360, 45), ["x", "45°", "y", "135°", "-x", "225°", "-y", "315°"])
            ax.set_rlabel_position(22.5)
            ax.set_title(f"{one.name}: $F_a$ {one.axial_load:.4g} N, $F_r$ {one.radial_load:.4g} N")
            ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08))
        figure.suptitle("Loads of the rollers (N)", fontsize=11)
    return figure
