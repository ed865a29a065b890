"""Pictures of the cage's motion: locus, orbit radius, axial motion, tilt, spectrum and the map of whirl over operating points.

All of them raise `InputError` for a run without a cage.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle
from matplotlib.ticker import MultipleLocator

from trbdyn.errors import InputError
from trbdyn.plot.style import COLOURS, GREY, LINES, canvas, is_own, legend, line, pair, scaled, sequence
from trbdyn.results import observables
from trbdyn.results.result import Result

LEAST_SPAN: Final = 0.1
"""Room on both sides of the marks of a map, over the largest value."""


def revolutions(result: Result) -> np.ndarray:
    """Turns of the shaft, or of the outer ring where the shaft rests, shape (T,)."""
    return np.abs(result.turned) / (2.0 * np.pi)


def turns_label(result: Result) -> str:
    """What an axis over `revolutions` says."""
    return "shaft revolutions" if result.scene.turning_ring == "shaft" else "revolutions of the outer ring"


def need_cage(result: Result) -> None:
    """An error if the run has no cage."""
    if not result.has_cage:
        raise InputError.of(
            ("effects", "bodies"), result.scene.effects.bodies, "has no cage: there is nothing to draw of it"
        )


def last_turns(result: Result, turns: float | None) -> Result:
    """The last `turns` revolutions of the shaft; all of them for None."""
    if turns is None:
        return result
    turned = revolutions(result)
    first = int(np.searchsorted(turned, turned[-1] - turns - 1e-9))
    return result.window(start=float(result["time"][first]))


def cage_locus(
    result: Result,
    ax: Axes | None = None,
    plane: Literal["centre", "rail"] = "centre",
    colour_by_time: bool = True,
    circles: Mapping[str, float] | None = None,
) -> Axes:
    """Locus of the cage's centre in units of the radial play, with circles of clearance.

    Cpr and Cpc are the radial and the circumferential play of the cage, one-sided: how far a centred cage can move towards a
    roller, and along the pitch circle, before its pocket touches that roller. The cage as a whole comes as far as the solid
    circle, Cpr, when the rollers give way, and about as far as the dashed one, Cpc, while they stay evenly spaced.

    Parameters
    ----------
    plane : {"centre", "rail"}
        Roller-centre plane, or plane of the large-end rail.
    colour_by_time : bool
        Colour the path by the turns of the shaft, dark to light; else one colour.
    circles : mapping of str to float, optional
        Labels and radii (in units of Cpr) of circles to draw; by default Cpr and Cpc with their sizes.
    """
    need_cage(result)
    path = result.cage_locus(plane)
    plays = result.clearances
    if circles is None:
        circles = {
            f"radial play $C_{{pr}}$ = {1e3 * plays.radial:.3g} mm": 1.0,
            f"circumferential play $C_{{pc}}$ = {1e3 * plays.circumferential:.3g} mm": plays.circumferential
            / plays.radial,
        }
    where = "" if plane == "centre" else " at the large-end rail"
    with canvas(ax, (5.4, 5.2), f"Locus of the cage's centre{where}") as ax:
        if colour_by_time and len(path) > 1:
            keep = max(1, len(path) // 50000)
            points, turned = path[::keep], revolutions(result)[::keep]
            segments = LineCollection(
                list(np.stack([points[:-1], points[1:]], axis=1)), array=turned[:-1], cmap=sequence(), linewidths=0.9
            )
            ax.add_collection(segments)
            bar = ax.figure.colorbar(segments, ax=ax, shrink=0.8, pad=0.02)
            bar.set_label(turns_label(result))
        else:
            ax.plot(path[:, 0], path[:, 1], color=COLOURS[0], linewidth=0.9)
        for index, (label, radius) in enumerate(circles.items()):
            ax.add_patch(Circle((0, 0), radius, fill=False, linestyle=LINES[index], linewidth=1.2))
            ax.plot([], [], color="black", linestyle=LINES[index], label=label)
        ax.plot(*path.mean(axis=0), marker="+", color="black", markersize=8, linestyle="none", label="mean place")
        ax.plot(*path[-1], marker="o", color="black", markersize=5, linestyle="none", label="end")
        ax.axhline(0, color=GREY, linewidth=0.5)
        ax.axvline(0, color=GREY, linewidth=0.5)
        reach = 1.08 * max(1.0, *circles.values(), float(np.abs(path).max()))
        ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
        ax.xaxis.set_major_locator(MultipleLocator(0.5))
        ax.yaxis.set_major_locator(MultipleLocator(0.5))
        ax.set(xlabel="$x/C_{pr}$", ylabel="$y/C_{pr}$")
        if is_own(ax):  # below everything: above the axes it would reach under the colour bar
            ax.figure.legend(loc="outside lower center", ncols=2)
        else:  # there is no room for a legend that covers no path
            for label, radius in circles.items():
                ax.annotate(label, (0, radius), ha="center", va="center", fontsize=7).set_bbox(
                    {"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.85}
                )
    return ax


def orbit_radius(result: Result, ax: Axes | None = None) -> Axes:
    """Orbit radius of the cage's centre about its mean place, and its distance from the bearing axis, over the shaft's turns.

    Both in units of the radial play Cpr. The mean place is that of the part after the transient, whose start is marked; the
    legend says whether the motion has settled there.
    """
    need_cage(result)
    turned, settling, play = revolutions(result), result.settling(), result.clearances.radial
    place, distance = result["cage_position"][:, :2], result.axis_distance_over_cpr
    orbit = np.hypot(*(place - place[settling.index :].mean(axis=0)).T) / play
    with canvas(ax, (6.4, 3.6), "Orbit of the cage's centre") as ax:
        line(ax, turned, distance, 1, "distance from the bearing axis", linestyle="-", linewidth=0.8, alpha=0.8)
        line(ax, turned, orbit, 0, "orbit radius about the mean place", linestyle="-", linewidth=0.8)
        rms = float(np.sqrt(np.mean(orbit[settling.index :] ** 2)))
        known = {"settled": "settled", "drifting": "drifting", "unknown": "not known to have settled"}[settling.answer]
        ax.plot(
            [turned[settling.index], turned[-1]],
            [rms, rms],
            color="black",
            linestyle="--",
            label=f"orbit radius, rms after the transient: {rms:.3f} ({known})",
        )
        ax.axvline(turned[settling.index], color=GREY, linewidth=0.8, linestyle=":")
        ax.set(xlabel=turns_label(result), ylabel="distance / $C_{pr}$", xlim=(turned[0], turned[-1]))
        ax.set_ylim(0, 1.08 * max(1.0, float(distance.max()), float(orbit.max())))
        legend(ax, ncols=1)
    return ax


def axial_motion(result: Result, ax: Axes | None = None) -> Axes:
    """Axial motion of the cage as a share of its axial play; zero is contact at the large ends."""
    need_cage(result)
    with canvas(ax, (6.4, 3.2), "Axial position of the cage; zero: rollers' large ends touch") as ax:
        turned = revolutions(result)
        line(ax, turned, 100.0 * result.axial_motion, linewidth=0.8)
        ax.axhline(0, color=GREY, linewidth=0.8)
        ax.set(xlabel=turns_label(result), ylabel="axial position (% of play)", xlim=(turned[0], turned[-1]))
    return ax


def tilt(result: Result, ax: Axes | None = None, last: float | None = 12.0) -> Axes:
    """Tilt of the cage's axis, theta_x and theta_y, over the turns of the shaft."""
    need_cage(result)
    shown = last_turns(result, last)
    with canvas(ax, (6.4, 3.4), "Tilt of the cage's axis") as ax:
        turned = revolutions(shown)
        pair(ax, turned, 1e3 * shown["cage_tilt"], r"$\theta_{}$")
        ax.axhline(0, color=GREY, linewidth=0.8)
        ax.set(xlabel=turns_label(result), ylabel="cage tilt (mrad)", xlim=(turned[0], turned[-1]))
        legend(ax)
    return ax


def spectrum(result: Result, ax: Axes | None = None, orders: float = 4.0, segments: int = 1) -> Axes:
    """Two-sided spectrum of the cage centre's motion x + i y over the order of the cage's rotation.

    Parameters
    ----------
    result : Result
        Needs the groups time and cage; best after settling.
    orders : float
        Highest order to show; negative orders are backward whirl.
    """
    need_cage(result)
    path = result.cage_locus()
    frequency, density = observables.spectrum(result["time"], path[:, 0] + 1j * path[:, 1], segments)
    cage = abs(result.cage_frequency)
    order = frequency / cage
    shown = np.abs(order) <= orders
    with canvas(ax, (6.4, 3.4), "Spectrum of the cage centre's motion $x + iy$") as ax:
        ax.semilogy(order[shown], density[shown], color=COLOURS[0])
        highest = float(density[shown].max()) if shown.any() else 1.0
        ax.set_ylim(max(highest * 1e-10, float(np.min(density[shown], initial=highest))), 4 * highest)
        ax.axvline(1.0, color="black", linewidth=0.9, linestyle="--", label=f"cage frequency, {cage:.2f} Hz")
        ax.set(
            xlabel="whirl frequency / cage frequency", ylabel="spectral density ($C_{pr}^2$/Hz)", xlim=(-orders, orders)
        )
        legend(ax)
    return ax


def whirl_map(results: Iterable[Result], ax: Axes | None = None) -> Axes:
    """Whirl of the cage over speed and axial load: one mark for each operating point, with the orbit radius about its mean place.

    The orbit radius is the root mean square after the transient, in units of the radial play Cpr.

    Parameters
    ----------
    results : iterable of Result
        Runs at several operating points, with the groups time, cage, rollers and ring.
    """
    results = list(results)
    for result in results:
        need_cage(result)
    points = [
        (
            float(np.mean(np.abs(result.turning_speed))) * 30.0 / np.pi,
            float(np.mean(np.abs(result["ring_force"][:, 2]))),
            result.settled.cage_motion.orbit_over_play,
        )
        for result in results
    ]
    speed, load, radius = np.array(points).T
    factor, unit = scaled("N", load)
    load = factor * load
    with canvas(ax, (5.6, 4.4), "Orbit radius of the cage over speed and load") as ax:
        sizes, colours = 60 + 400 * np.clip(radius, 0, 1.2), {"c": radius, "cmap": sequence(), "vmin": 0, "vmax": 1}
        marks = ax.scatter(speed, load, s=sizes, edgecolors="black", **colours)
        for x, y, value in zip(speed, load, radius, strict=True):
            ax.annotate(f"{value:.2f}", (x, y), xytext=(14, 8), textcoords="offset points", fontsize=9)
        ax.figure.colorbar(marks, ax=ax, shrink=0.8, pad=0.02).set_label("orbit radius, rms / $C_{pr}$")
        ax.margins(0.18)
        # runs at one load or one speed must not look as if they differed
        for values, limits, set_limits in ((speed, ax.get_xlim(), ax.set_xlim), (load, ax.get_ylim(), ax.set_ylim)):
            around = LEAST_SPAN * float(np.abs(values).max())
            set_limits(min(limits[0], float(values.min()) - around), max(limits[1], float(values.max()) + around))
        ax.set(xlabel="shaft speed (rpm)", ylabel=f"axial load ({unit})")
    return ax
