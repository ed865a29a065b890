"""Pictures of a shaft on several bearings: its section, preload diagram, load zones, its motion and the bearings' loads."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle
from numpy.typing import NDArray

from trbdyn.base.display import amount
from trbdyn.base.display import plain as number
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly, ShaftBearing
from trbdyn.model.motion import value_at
from trbdyn.model.outlines import cone_outline, cup_outline
from trbdyn.plot.around import name_angles
from trbdyn.plot.cage import revolutions, turns_label
from trbdyn.plot.drawing import ROLLER, STEEL, placed, roller_outline
from trbdyn.plot.ring import draw_motion, draw_path
from trbdyn.plot.style import COLOURS, GREY, LIGHT, LINES, canvas, legend, line, plain, scaled, styled
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.statics.assembly import ShaftEquilibrium, equilibrium
from trbdyn.statics.preload import PreloadDiagram
from trbdyn.statics.preload import preload_diagram as diagram_of

Array = NDArray[np.float64]

ARROW: Final = 0.55
"""Length of the largest load's arrow, over the largest radius that is drawn."""

__all__ = ["bearing_loads", "load_zones", "preload_diagram", "shaft_drawing", "shaft_motion", "shaft_orbits"]


def preload_diagram(diagram: PreloadDiagram, ax: Axes | None = None) -> Axes:
    """Axial load of each bearing, and the axial force on the shaft, over the shaft's axial displacement.

    Parameters
    ----------
    diagram : PreloadDiagram
        What `trbdyn.preload_diagram` gave.
    """
    with canvas(ax, title="Preload diagram") as ax:
        place = 1e6 * diagram.displacement
        factor, unit = scaled("N", *diagram.loads.values(), diagram.axial_force)
        for index, (name, load) in enumerate(diagram.loads.items()):
            line(ax, place, factor * load, index, f"axial load of {name}")
        line(ax, place, factor * diagram.axial_force, len(diagram.loads), "axial force on the shaft")
        for found, label, inside in (
            (diagram.preload, "without axial force", "white"),
            (diagram.operating, "operating point", GREY),
        ):
            where = 1e6 * float(found.displacement()[2])
            loads = [factor * one.axial_load for one in found.bearings]
            ax.plot([where] * len(loads), loads, "o", color=GREY, markerfacecolor=inside, ms=5, label=label, zorder=3)
            ax.axvline(where, color=GREY, linewidth=0.8, linestyle=":")
        ax.axhline(0.0, color=GREY, linewidth=0.8)
        ax.set(xlabel="axial displacement of the shaft to the right (µm)", ylabel=f"axial load ({unit})")
        legend(ax)
    return ax


def load_zones(found: ShaftEquilibrium) -> Figure:
    """Loads of the rollers around each bearing (polar), looking along the shaft's z axis: x to the right, y upwards.

    Parameters
    ----------
    found : ShaftEquilibrium
        What `trbdyn.equilibrium` gave.
    """
    with styled():
        count = len(found.bearings)
        figure, axes = plt.subplots(
            1, count, figsize=(3.6 * count, 4.4), subplot_kw={"projection": "polar"}, squeeze=False
        )
        factor, unit = scaled("N", *(one.outer_load for one in found.bearings))
        largest = max(1.0, factor * max(float(one.outer_load.max()) for one in found.bearings))
        for ax, one in zip(axes[0], found.bearings, strict=True):
            order = np.argsort(one.angles)
            around = np.append(one.angles[order], one.angles[order][0])
            for index, (label, load) in enumerate((("outer ring", one.outer_load), ("inner ring", one.inner_load))):
                values = factor * np.append(load[order], load[order][0])
                style = {"color": COLOURS[index], "linestyle": LINES[index], "marker": "o", "markersize": 3.0}
                ax.plot(
                    around, values, label=f"{label}, {number(values.min())} to {number(values.max())} {unit}", **style
                )
            ax.set_ylim(0.0, 1.05 * largest)
            name_angles(ax)
            ax.set_title(f"{one.name}: $F_a$ {amount(one.axial_load, 'N')}, $F_r$ {amount(one.radial_load, 'N')}")
            ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08))
        figure.suptitle(f"Loads of the rollers ({unit})", fontsize=11)
    return figure


def shaft_drawing(assembly: Assembly, ax: Axes | None = None) -> Axes:
    """The shaft with its bearings in section, their load lines and load centres, and the loads at the time 0.

    Parameters
    ----------
    assembly : Assembly
        The assembly.

    Examples
    --------
    >>> import trbdyn as trb
    >>> trb.plot.shaft_drawing(trb.load_assembly("pair_30310")).get_xlabel()
    'along the shaft, z (mm)'
    """
    tops, bores, ends = [], [], [1e3 * assembly.shaft.mass_position]
    with canvas(ax, (7.2, 4.6), "The shaft and its bearings") as ax:
        for name, one in zip(assembly.names, assembly.bearings, strict=True):
            outlines = [
                _in_place(one, 1e3 * np.array(points)[:, ::-1])
                for points in (cup_outline(one.bearing), cone_outline(one.bearing))
            ]
            for points in outlines:
                _mirrored(ax, points, facecolor=STEEL, hatch="///", alpha=0.9)
            roller = _in_place(one, placed(one.bearing, roller_outline(one.bearing)))
            _mirrored(ax, roller, facecolor=ROLLER, zorder=3)
            middle, centre = roller.mean(axis=0), 1e3 * one.position
            for side in (1.0, -1.0):
                ax.plot([middle[0], centre], [side * middle[1], 0.0], color=COLOURS[0], linewidth=0.8, linestyle=":")
            ax.plot(centre, 0.0, "o", color=COLOURS[0], ms=4, zorder=5)
            top = max(points[:, 1].max() for points in outlines)
            ax.annotate(
                f"{name}: {plain(one.bearing.name)}",
                (middle[0], top),
                (0, 5),
                textcoords="offset points",
                ha="center",
                fontsize=9,
            )
            tops.append(top)
            bores.append(min(points[:, 1].min() for points in outlines))
            ends += [*(end for points in outlines for end in points[:, 0]), centre]
        arrows = _arrows(assembly, max(tops))
        ends += [place for one in arrows for place in (one.start[0], one.end[0])]
        low, high = min(ends) - 8.0, max(ends) + 8.0
        ax.add_patch(
            Rectangle((low, -min(bores)), high - low, 2.0 * min(bores), facecolor="#F5F6F7", edgecolor=LIGHT, zorder=0)
        )
        ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle=(0, (8, 2, 1, 2)))
        ax.plot(
            1e3 * assembly.shaft.mass_position,
            0.0,
            "P",
            color="black",
            ms=7,
            zorder=6,
            label="centre of mass of the shaft",
        )
        ax.plot([], [], "o:", color=COLOURS[0], ms=4, label="load centres")
        _draw(arrows, ax)
        ax.set_aspect("equal")
        ax.set(xlim=(low - 4.0, high + 4.0), ylim=(-1.15 * max(tops), 1.25 * max(tops)))
        ax.set(xlabel="along the shaft, z (mm)", ylabel="across, y (mm)")
        ax.grid(visible=False)
        legend(ax, ncols=3)
    return ax


def _in_place(one: ShaftBearing, points: Array) -> Array:
    """Points of a bearing, (z, r) in mm, where it sits on the shaft."""
    return np.column_stack([1e3 * one.centre_plane - one.side * points[:, 0], points[:, 1]])


def _mirrored(ax: Axes, points: Array, **style: Any) -> None:
    for side in (1.0, -1.0):
        ax.add_patch(Polygon(points * [1.0, side], edgecolor="black", linewidth=0.8, **style))


@dataclass(frozen=True)
class _Arrow:
    """A load in the drawing, (z, y) in mm."""

    start: tuple[float, float]
    end: tuple[float, float]
    words: str


def _arrows(assembly: Assembly, reach: float) -> list[_Arrow]:
    """Forces in the plane of the drawing, y and z, and how large the part across it, x, is.

    A force that acts further from the axis than what is drawn, up to `reach` (mm), as that of the road on a wheel, is drawn at
    the border, and the words tell where it acts.
    """
    forces = [[value_at(part, 0.0) for part in load.force] for load in assembly.loads]
    largest = max((math.hypot(*force[1:]) for force in forces), default=0.0)
    scale = ARROW * reach / largest if largest > 0.0 else 0.0
    found = []
    for load, force in zip(assembly.loads, forces, strict=True):
        at, along, up = 1e3 * load.offset[1], scale * force[2], scale * force[1]
        outside = abs(at) > reach
        start = min(max(at, -reach - min(up, 0.0)), reach - max(up, 0.0)) if outside else at
        words = amount(math.hypot(*force[1:]), "N") + (f", x {amount(force[0], 'N')}" if force[0] else "")
        if outside:
            words += f", acts at y = {at:.4g} mm"
        place = 1e3 * load.position
        found.append(_Arrow((place, start), (place + along, start + up), words))
    return found


def _draw(arrows: list[_Arrow], ax: Axes) -> None:
    for one in arrows:
        style = {"arrowstyle": "-|>", "color": COLOURS[6], "linewidth": 1.6}
        ax.annotate("", one.end, one.start, arrowprops=style, zorder=7)
        ax.annotate(one.words, one.end, (4, 4), textcoords="offset points", color=COLOURS[6], fontsize=8, zorder=8)
    if arrows:
        ax.plot([], [], color=COLOURS[6], linewidth=1.6, label="loads, their part in this plane")


def bearing_loads(result: AssemblyResult, ax: Axes | None = None) -> Axes:
    """Axial and radial load of the shaft on each bearing.

    Parameters
    ----------
    result : AssemblyResult
        Needs the group ring.
    """
    with canvas(ax, title="Loads of the bearings") as ax:
        factor, unit = scaled("N", *(values for name in result for values in result.loads(name).values()))
        for index, (name, one) in enumerate(result.items()):
            for load, style in (("axial_load", "-"), ("radial_load", (0, (5, 1.5)))):
                values = factor * result.loads(name)[load]
                line(ax, revolutions(one), values, index, f"{name}, {load[:-5]}", linestyle=style)
        ax.set(xlabel=turns_label(one), ylabel=f"load ({unit})")
        legend(ax)
    return ax


def shaft_orbits(result: AssemblyResult) -> Figure:
    """Path of the shaft's axis across the axis in the plane of each bearing's rollers, seen against z: x to the right, y upwards.

    Parameters
    ----------
    result : AssemblyResult
        Needs the group ring, and the assembly.

    Raises
    ------
    InputError
        If the assembly is not known.
    """
    assembly = _known(result)
    with styled():
        count = len(result)
        figure, axes = plt.subplots(1, count, figsize=(3.8 * count, 4.0), squeeze=False)
        figure.suptitle("Path of the shaft's axis at its bearings", fontsize=11)
        for ax, (name, one), bearing in zip(axes[0], result.items(), assembly.bearings, strict=True):
            place = 1e6 * result.shaft_displacement(bearing.centre_plane)[:, :2]
            points = draw_path(ax, place, revolutions(one))
            ax.set_title(name)
            ax.set_aspect("equal", adjustable="datalim")
        figure.colorbar(points, ax=list(axes[0]), label=turns_label(one), location="bottom", shrink=0.6, aspect=40)
    return figure


def shaft_motion(result: AssemblyResult) -> Figure:
    """Displacement of the shaft's centre of mass and its tilt over the turns of the shaft.

    Parameters
    ----------
    result : AssemblyResult
        Needs the group ring.
    """
    tilt = result.shaft_axis[:, [1, 0]] * [-1.0, 1.0]
    return draw_motion("Motion of the shaft", result.parts[0], result.shaft_position, tilt, "across")


def _known(result: AssemblyResult) -> Assembly:
    if result.assembly is None:
        raise InputError.of("assembly", None, "must be known, to say where the bearings sit")
    return result.assembly


def of_result(result: Result | AssemblyResult) -> dict[str, Callable[[], Axes | Figure]]:
    """The pictures of a shaft by name, none of one bearing alone; those of each bearing are in `trbdyn.plot.PICTURES`."""
    if isinstance(result, Result):
        return {}
    found: dict[str, Callable[[], Axes | Figure]] = {
        "bearing_loads": lambda: bearing_loads(result),
        "shaft_motion": lambda: shaft_motion(result),
    }
    if (assembly := result.assembly) is None:
        return found
    start = float(result.time[0])
    return {
        "shaft_drawing": lambda: shaft_drawing(assembly),
        **found,
        "shaft_orbits": lambda: shaft_orbits(result),
        "load_zones": lambda: load_zones(equilibrium(assembly, time=start)),
        "preload_diagram": lambda: preload_diagram(diagram_of(assembly, time=start)),
    }
