"""Drawings from the inputs: the bearing in section with its dimensions, and a pocket with its roller.

Contact surfaces are drawn as they are simulated. What the model does not know (outer surface of the cup, bore of the
cone, body of the cage) is drawn in usual proportions, dashed.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import NDArray

from trbdyn.base.extras import of_extras
from trbdyn.base.own_files import digest_of
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.cage_drawing import STEP_ENDINGS
from trbdyn.model.outlines import cone_outline, cup_outline, rail_bands
from trbdyn.model.pocket import Face, pocket_axes
from trbdyn.model.profiles import profile_drop
from trbdyn.model.trace import Trace
from trbdyn.plot.style import COLOURS, GREY, canvas, colour_of, plain, styled

Array = NDArray[np.float64]

STEEL, ROLLER, _CAGE = "#DCE1E6", "#F1F3F5", "#E8CF9B"


def bearing_drawing(bearing: Bearing, ax: Axes | None = None) -> Axes:
    """The bearing in section, with its main dimensions.

    Examples
    --------
    >>> import trbdyn as trb
    >>> trb.plot.bearing_drawing(trb.cases.rig_30310()).get_ylabel()
    'radius (mm)'
    """
    roller = bearing.roller
    with canvas(ax, (6.4, 5.6), f"{plain(bearing.name)}: section through the bearing") as ax:
        for outline in (cup_outline(bearing), cone_outline(bearing)):
            corners = 1e3 * np.array(outline)[:, ::-1]
            ax.add_patch(Polygon(corners, facecolor=STEEL, edgecolor="black", linewidth=0.9, hatch="///", alpha=0.9))
        half = 0.5 * roller.total_length
        ax.add_patch(
            Polygon(
                placed(bearing, roller_outline(bearing)), facecolor=ROLLER, edgecolor="black", linewidth=1.0, zorder=3
            )
        )
        for low, high, near, far, _ in rail_bands(bearing):
            corners = np.array([(near, low), (far, low), (far, high), (near, high)])
            ax.add_patch(Polygon(placed(bearing, corners), facecolor=_CAGE, edgecolor=GREY, linestyle="--", zorder=2))
        axis = placed(bearing, np.array([(-1.35 * half, 0.0), (1.35 * half, 0.0)]))
        ax.plot(*axis.T, color=GREY, linewidth=0.8, linestyle=(0, (8, 2, 1, 2)), zorder=4)
        ax.axhline(0, color=GREY, linewidth=0.8, linestyle=(0, (8, 2, 1, 2)))
        _dimensions(bearing, ax)
        ax.set_aspect("equal")
        outer = 1e3 * max(point[0] for point in cup_outline(bearing))
        wide = 1.1e3 * max(abs(point[1]) for point in (*cup_outline(bearing), *cone_outline(bearing)))
        ax.set(xlim=(-wide, max(2.4 * wide, 1.05 * outer - wide)), ylim=(-0.06 * outer, 1.1 * outer))
        ax.set(xlabel="from the roller-centre plane towards the large ends (mm)", ylabel="radius (mm)")
        ax.grid(visible=False)
    return ax


def roller_outline(bearing: Bearing) -> Array:
    """Outline of a roller with its profile and its sphere end, as (along its axis, outward from it), shape (n, 2) (m)."""
    geometry = bearing.geometry
    half = 0.5 * bearing.roller.total_length
    stations = np.linspace(-half, half, 41)
    radius = (
        0.5 * bearing.roller.diameter + stations * np.tan(geometry.roller_half_angle) - profile_drop(bearing, stations)
    )
    upper, lower = (np.stack([stations, side * radius], axis=1) for side in (1.0, -1.0))
    inside = np.linspace(1.0, -1.0, 15)[1:-1] * radius[-1]
    end = geometry.sphere_centre - geometry.apex_to_mid + np.sqrt(geometry.sphere_radius**2 - inside**2)
    return np.vstack([upper, np.stack([end, inside], axis=1), lower[::-1]])


def placed(bearing: Bearing, points: Array) -> Array:
    """Points (along the roller's axis, outward from it) as (z, r) in mm."""
    geometry = bearing.geometry
    cosine, sine = np.cos(geometry.roller_axis_angle), np.sin(geometry.roller_axis_angle)
    along, outward = points.T
    r = 0.5 * bearing.pitch_diameter + along * sine + outward * cosine
    z = along * cosine - outward * sine
    return 1e3 * np.stack([z, r], axis=1)


def _dimensions(bearing: Bearing, ax: Axes) -> None:
    """Pitch diameter, roller diameter and length, angles."""
    geometry, roller = bearing.geometry, bearing.roller
    mid = placed(bearing, np.array([(0.0, 0.0)]))[0]
    half, size = 0.5 * roller.effective_length, 0.5 * roller.diameter

    box: dict[str, Any] = {"bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.85}}

    def measure(ends: Array, words: str, shift: tuple[float, float], align: str = "left") -> None:
        look = {"arrowstyle": "<->", "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
        start, stop = ((float(z), float(r)) for z, r in ends)
        ax.annotate("", stop, start, arrowprops=look, zorder=6)
        middle = (0.5 * (start[0] + stop[0]), 0.5 * (start[1] + stop[1]))
        ax.annotate(words, middle, shift, textcoords="offset points", fontsize=9, zorder=7, ha=align, **box)

    diameter = placed(bearing, np.array([(0.0, -size), (0.0, size)]))
    measure(diameter, f"Dwe {1e3 * roller.diameter:.4g}", (4, -3))
    above = 1.35 * size
    length = placed(bearing, np.array([(-half, above), (half, above)]))
    measure(length, f"Lwe {1e3 * roller.effective_length:.4g}", (0, 7), "center")
    measure(np.array([[mid[0], 0.0], mid]), f"Dpw/2 {5e2 * bearing.pitch_diameter:.5g}", (5, -20))
    lines = [
        f"Z = {bearing.n_rollers} rollers",
        *(
            (
                f"cylindrical, {bearing.ribs.flanges}",
                f"radial internal clearance {1e6 * bearing.radial_clearance:.3g} µm",
            )
            if bearing.is_cylindrical
            else (
                f"cup half angle {bearing.cup_half_angle_deg:.4g}°",
                f"cone half angle {np.degrees(geometry.cone_half_angle):.4g}°",
                f"roller half angle {np.degrees(geometry.roller_half_angle):.4g}°",
            )
        ),
        f"rib contact {1e3 * bearing.ribs.contact_height:.3g} mm above the raceway",
        "lengths in mm",
    ]
    ax.annotate(
        "\n".join(lines), (0.98, 0.3), xycoords="axes fraction", fontsize=8.5, va="center", ha="right", zorder=8
    )


def pocket_drawing(bearing: Bearing, pocket: int = 0) -> Figure:
    """A pocket of the cage with its roller: seen along the roller's axis, and from outside.

    Raises
    ------
    InputError
        If there is no such pocket.
    """
    _check_pocket(bearing, pocket)
    geometry, roller = bearing.geometry, bearing.roller
    gaps = bearing.pocket_of(pocket).gaps(bearing.geometry)
    around = np.linspace(0.0, 2.0 * np.pi, 121)
    half = 0.5e3 * roller.total_length
    with styled():
        figure, (end, top) = plt.subplots(1, 2, figsize=(8.4, 5.0), width_ratios=(1.0, 1.3))
        size = 0.5e3 * roller.diameter
        end.plot(size * np.cos(around), size * np.sin(around), color="black", linewidth=1.0)
        end.plot(0, 0, marker="+", color=GREY)
        stations = np.linspace(-0.5, 0.5, 3) * roller.total_length
        radius = 1e3 * (0.5 * roller.diameter + stations * np.tan(geometry.roller_half_angle))
        outline = np.concatenate([np.stack([1e3 * stations, radius], 1), np.stack([1e3 * stations, -radius], 1)[::-1]])
        top.add_patch(Polygon(outline, facecolor=ROLLER, edgecolor="black", linewidth=1.0))
        for (name, many, colour), facets in _surfaces(bearing, pocket):
            gap = round(1e3 * min(gaps[face.name] for face in facets), 6)
            label = f"{name}: gap {gap:.3g} mm{many}"
            for face in facets:
                corners = 1e3 * np.vstack([face.vertices, face.vertices[:1]])
                look = {"color": colour, "linewidth": 1.8 / math.sqrt(len(facets))}
                end.plot(corners[:, 1], corners[:, 0], label=label if face is facets[0] else None, **look)
                top.plot(corners[:, 2], corners[:, 1], **look)
        end.set(aspect="equal", xlabel="in the direction of rotation, t (mm)", ylabel="outward, n (mm)")
        end.set_title("seen along the roller's axis", pad=8)
        top.set(aspect="equal", xlabel="along the roller, large end to the right (mm)", ylabel="t (mm)")
        top.set_title("seen from outside")
        top.set_xlim(-1.35 * half, 1.35 * half)
        figure.legend(*end.get_legend_handles_labels(), loc="outside lower center", ncols=2)
        figure.suptitle(
            f"{plain(bearing.name)}, pocket {pocket}, roller centred and its large end touching\n"
            f"Cpr {1e3 * bearing.cage.play_radial:.3g} mm, Cpc {1e3 * bearing.cage.play_circumferential:.3g} mm",
            fontsize=10,
        )
    return figure


def cage_drawing(bearing: Bearing, pocket: int = 0) -> Figure:
    """A pocket in the drawing that its cage comes from, and beside it the surfaces that were recognised in it.

    Raises
    ------
    InputError
        If the cage comes from no STEP file, or from one that has changed, or there is no such pocket.
    FileError
        If the file cannot be read.
    ImportError
        If the extra ``trbdyn[cad]`` is not installed.
    """
    _check_pocket(bearing, pocket)
    drawn = triangles_in_pocket(bearing, pocket)
    with styled():
        figure, light = plt.figure(figsize=(10.5, 5.0)), LightSource(azdeg=225.0, altdeg=45.0)
        for place, title in enumerate(("as drawn", "recognised: what a roller can touch")):
            ax = figure.add_subplot(1, 2, place + 1, projection="3d")
            grey = Poly3DCollection(
                drawn, facecolors="#D9DEE3", shade=True, lightsource=light, alpha=0.35 if place else 1.0
            )
            ax.add_collection3d(grey, autolim=False)
            for (name, many, colour), facets in _surfaces(bearing, pocket) if place else ():
                corners = [1e3 * np.asarray(face.vertices)[:, [1, 2, 0]] for face in facets]
                look = {"facecolor": colour, "edgecolor": colour, "linewidth": 0.3, "label": f"{name}{many}"}
                ax.add_collection3d(Poly3DCollection(corners, **look), autolim=False)
            points = drawn.reshape(-1, 3)
            low, high = points.min(axis=0), points.max(axis=0)
            ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
            ax.set_box_aspect(high - low)
            ax.view_init(elev=42.0, azim=-28.0)
            ax.zaxis.set_major_locator(MaxNLocator(3))
            ax.set(xlabel="t (mm)", ylabel="a (mm)")
            ax.set_zlabel("n (mm)", labelpad=-0.5)
            ax.set_title(title)
        figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8)
        figure.suptitle(f"{plain(bearing.name)}, pocket {pocket} of {plain(Path(bearing.cage.drawing.file).name)}")  # type: ignore[union-attr]
    return figure


def _surfaces(bearing: Bearing, pocket: int) -> list[tuple[tuple[str, str, Any], list[Face]]]:
    """The surfaces of a pocket, with name, number of facets in words, and colour, and their facets."""
    found: dict[int, list[Face]] = {}
    for face in bearing.pocket_of(pocket).faces:
        found.setdefault(face.slot, []).append(face)
    return [
        ((of[0].name.replace("_", " "), f", {len(of)} facets" if len(of) > 1 else "", colour_of(index)), of)
        for index, of in enumerate(found.values())
    ]


def _check_pocket(bearing: Bearing, pocket: object) -> None:
    if not isinstance(pocket, int) or not 0 <= pocket < bearing.n_rollers:
        raise InputError.of("pocket", pocket, f"must be a whole number from 0 to {bearing.n_rollers - 1}")


def triangles_in_pocket(bearing: Bearing, pocket: int) -> Array:
    """Triangles of a drawn cage around a pocket, in the frame of the pocket as (t, a, n), shape (T, 3, 3) (mm)."""
    drawing = bearing.cage.drawing
    if drawing is None or Path(drawing.file).suffix.lower() not in STEP_ENDINGS:
        raise InputError.of(("cage", "drawing"), drawing, "must be a STEP file (Cage.from_step)")
    if digest_of(drawing.file) != drawing.sha256:
        limit = f"must be that of {drawing.file}, which has changed since"
        raise InputError.of(("cage", "drawing", "sha256"), drawing.sha256, limit)
    size = bearing.roller.diameter
    with of_extras("opened")(drawing.file, mesh_size=0.2 * size, unit="mm") as solid:
        triangles = np.concatenate([face.triangles for face in solid.faces])
    in_cage = (triangles - np.array(drawing.origin)) @ np.array(drawing.axes).T
    angle = 2.0 * np.pi * pocket / bearing.n_rollers
    middle = 0.5 * bearing.pitch_diameter * np.array([np.cos(angle), np.sin(angle), 0.0])
    found = ((in_cage - middle) @ pocket_axes(bearing, pocket).T)[..., [1, 2, 0]]
    centres = found.mean(axis=1)
    near = (np.abs(centres[:, 0]) < 0.75 * size) & (np.abs(centres[:, 2]) < size)
    return np.asarray(1e3 * found[near])


def profile_trace(trace: Trace, ax: Axes | None = None) -> Axes:
    """A measured or drawn profile: the levelled points, those that were left out, and the profile that is used.

    Parameters
    ----------
    trace : Trace
        What `trbdyn.read_trace` gave.
    """
    with canvas(ax, (7.2, 4.2), "Profile: levelled trace and the profile used") as ax:
        points, heights, out = 1e3 * trace.points, 1e6 * trace.heights, trace.outlier
        word = f"trace, {trace.angle_deg:.3g}° taken out" if trace.cutoff else "drawn line"
        look = {"linewidth": 0.6} if trace.cutoff else {"linewidth": 0, "marker": "o", "markersize": 4}
        ax.plot(points[~out], heights[~out], color="#9AA5B1", label=word, **look)
        used = "profile used" + (f", cut-off {1e3 * trace.cutoff:.3g} mm" if trace.cutoff else "")
        ax.plot(1e3 * trace.stations, -1e6 * trace.drops, color=COLOURS[0], linewidth=1.8, label=used)
        low, high = np.min(heights[~out]), np.max(heights[~out])
        room = 0.15 * (high - low)
        if out.any():
            shown = np.clip(heights[out], low - 0.6 * room, high + 0.6 * room)
            label = f"{np.count_nonzero(out)} outliers, left out; far ones at the edge"
            ax.plot(points[out], shown, "x", color=COLOURS[1], markersize=5, label=label, zorder=3)
        ax.set(ylim=(low - room, high + room), xlabel="from mid length towards the large end (mm)")
        ax.set_ylabel("height, away from the material (µm)")
        ax.legend(loc="center", bbox_to_anchor=(0.5, 0.35))
    return ax
