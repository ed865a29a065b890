"""The paper's figures from our runs: rows are starts, columns are conditions; every title names the conditions.

All of them show the time of the statistics, but for the history of settling and Fig. 18. A panel of a point that was not run says
so; one that had not settled is marked.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from paper.movable import Movable, Pockets
from paper.point_numbers import Run, Runs
from paper.points import FIGURES, Condition, Point, StartKind
from trbdyn import plot
from trbdyn.plot.style import COLOURS, GREY, LIGHT, LINES, STYLE, line
from trbdyn.results import observables
from trbdyn.results.observables import whirl_amplitude

Array = NDArray[np.float64]

START_WORDS: Final[dict[StartKind, str]] = {
    "equal": "start: equal spacing",
    "unequal": "start: random spacing",
    "whirl": "start: whirling",
}
NEIGHBOURS: Final = 5
"""Gaps that Fig. 14 and 18 show."""
SEED_MARKS: Final = ("", "o", "^", "s")
"""Marks of seeds 0, 1, 2, 3."""
TURNS_SHOWN: Final = 6.0
"""Turns of the cage that curves over time show."""

Draw = Callable[[Axes, Run], None]


def cage_turns(run: Run, whole: bool = False) -> Array:
    """Turns of the cage: over the statistics, from their start; or over everything, from the start of the run."""
    angle = run.history["cage_angle"] if whole else run.result["cage_angle"]
    return np.abs(angle - angle[0]) / (2.0 * np.pi)


def _last(run: Run, turns: float = TURNS_SHOWN) -> NDArray[np.bool_]:
    turned = cage_turns(run)
    return turned >= turned[-1] - turns


def panels(
    runs: Runs,
    figure: str,
    conditions: Sequence[Condition],
    draw: Draw,
    title: str,
    size: tuple[float, float] = (2.7, 2.5),
) -> Figure:
    """A figure with one row for each start and one column for each condition."""
    starts = runs.starts
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(
            len(starts),
            len(conditions),
            figsize=(0.5 + size[0] * len(conditions), 0.8 + size[1] * len(starts)),
            squeeze=False,
            sharex="col" if figure in ("14", "18") else False,
        )
        fig.suptitle(f"Fig. {figure}: {title}", fontsize=10)
        for (row, column), ax in np.ndenumerate(axes):
            run = runs.first(conditions[column], starts[row])
            if run is None:
                ax.text(0.5, 0.5, "not run", ha="center", va="center", transform=ax.transAxes, color=GREY)
                ax.set(xticks=[], yticks=[])
            else:
                draw(ax, run)
                if not run.settled:
                    _mark(ax, "not settled")
            if row == 0:
                ax.set_title(conditions[column].title.replace(", scatter", ",\nscatter"), fontsize=9)
            if row < len(starts) - 1:
                ax.set_xlabel("")
        words = next((ax.get_ylabel() for ax in axes.flat if ax.get_ylabel()), "")
        for (row, column), ax in np.ndenumerate(axes):
            ax.set_ylabel("" if column else f"{START_WORDS[starts[row]]}\n{words}", fontsize=9)
        handles = _handles(axes)
        if handles:
            fig.legend(*handles, loc="outside lower center", ncols=min(len(handles[1]), 6), fontsize=8.5)
    return fig


def _mark(ax: Axes, text: str) -> None:
    box = {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.0}
    ax.text(0.99, 0.02, text, ha="right", va="bottom", transform=ax.transAxes, color="#D55E00", fontsize=8, bbox=box)


def _handles(axes: NDArray[Any]) -> tuple[list[Any], list[str]] | None:
    for ax in axes.flat:
        found = ax.get_legend_handles_labels()
        if found[1]:
            return found[0], found[1]
    return None


def _locus(ax: Axes, run: Run) -> None:
    path, rail = run.result.cage_locus("centre"), run.result.cage_locus("rail")
    plays = run.result.clearances
    ax.plot(rail[:, 0], rail[:, 1], color=LIGHT, linewidth=0.6, label="at the large-end rail")
    ax.plot(path[:, 0], path[:, 1], color=COLOURS[0], linewidth=0.8, label="in the roller-centre plane")
    for index, (radius, label) in enumerate(((1.0, "$C_{pr}$"), (plays.circumferential / plays.radial, "$C_{pc}$"))):
        ax.add_patch(Circle((0, 0), radius, fill=False, linestyle=LINES[index], linewidth=0.9))
        ax.plot([], [], color="black", linestyle=LINES[index], linewidth=0.9, label=label)
    reach = 1.15 * max(1.0, float(np.abs(path).max()))
    ax.set(xlim=(-reach, reach), ylim=(-reach, 1.35 * reach), aspect="equal", xticks=(-1, 0, 1), yticks=(-1, 0, 1))
    ax.set(xlabel="$x/C_{pr}$", ylabel="$y/C_{pr}$")
    numbers = run.numbers
    text = f"from the axis {numbers['whirl_radius_over_cpr']['mean']:.2f}, orbit {numbers['orbit_over_cpr']:.2f}"
    if numbers["cage_motion"] == "circling":
        text += f"\nwhirl / cage frequency {numbers['whirl_ratio']:.2f}"
    ax.text(0.02, 0.99, text, transform=ax.transAxes, fontsize=7.5, va="top")


def figure_8_12(runs: Runs) -> dict[str, Figure]:
    """Cage locus: over the speed, and over the axial load."""
    words = "locus of the cage's centre in units of $C_{pr}$, axial load"
    return {
        "fig_08a_12a": panels(runs, "8a/12a", FIGURES["12a"], _locus, words),
        "fig_08b_12b": panels(runs, "8b/12b", FIGURES["12b"], _locus, words),
    }


def figure_11_16(runs: Runs) -> dict[str, Figure]:
    """Cage locus under combined load: over the speed, and over the radial load."""
    words = "locus of the cage's centre in units of $C_{pr}$, combined load"
    return {
        "fig_11a_16a": panels(runs, "11a/16a", FIGURES["16a"], _locus, words),
        "fig_11b_16b": panels(runs, "11b/16b", FIGURES["16b"], _locus, words),
    }


def figure_15(runs: Runs) -> dict[str, Figure]:
    """Cage locus with and without scatter of the rollers' diameters."""
    words = "locus of the cage's centre in units of $C_{pr}$"
    return {"fig_15": panels(runs, "15", FIGURES["15"], _locus, words, (2.9, 2.5))}


def _axial(ax: Axes, run: Run) -> None:
    shown, turned = _last(run), cage_turns(run)
    line(ax, turned[shown], 100.0 * run.result.axial_motion[shown], linewidth=0.9)
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    ax.axhline(15.0, color=GREY, linewidth=0.8, linestyle="--")
    low, high = 110.0 * float(run.result.axial_motion[shown].min()), 110.0 * float(run.result.axial_motion[shown].max())
    ax.set_ylim(min(-3.0, low), max(20.0, high))
    ax.set(xlabel="turns of the cage", ylabel="axial motion (% of play)")


def figure_9(runs: Runs) -> dict[str, Figure]:
    """Axial motion of the cage."""
    words = "axial motion of the cage; zero: large ends touch; dashed: 15 % of the axial play"
    return {"fig_09": panels(runs, "9", FIGURES["9"], _axial, words, (2.9, 1.9))}


def _tilt(ax: Axes, run: Run) -> None:
    shown, turned = _last(run, 3.0), cage_turns(run)
    tilt, y = 1e3 * run.result["cage_tilt"][shown], run.result.cage_locus()[shown, 1]
    line(ax, turned[shown], tilt[:, 0], 0, r"$\theta_x$ (mrad)")
    line(ax, turned[shown], tilt[:, 1], 1, r"$\theta_y$ (mrad)")
    line(ax, turned[shown], y, 2, "$y/C_{pr}$ of the cage's centre")
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    ax.set(xlabel="turns of the cage", ylabel=r"tilt (mrad); $y/C_{pr}$")


def figure_10(runs: Runs) -> dict[str, Figure]:
    """Tilt of the cage, and the side to which it is displaced."""
    words = "tilt of the cage, and the place of its centre"
    return {"fig_10": panels(runs, "10", FIGURES["10"], _tilt, words, (3.8, 2.0))}


def _forces(ax: Axes, run: Run) -> None:
    shown, turned = _last(run, 3.0), cage_turns(run)
    force = run.result["pocket_force"][shown]
    names = run.result.slot_names
    pocket = int(np.argmax(force.sum(axis=(0, 2))))
    looks = {
        "leading_bar": (1.0, 0),
        "trailing_bar": (-1.0, 1),
        "large_end_wall": (1.0, 2),
        "small_end_wall": (-1.0, 3),
    }
    for name, (sign, index) in looks.items():
        if name in names:
            curve = sign * force[:, pocket, names.index(name)]
            label = f"{name.replace('_', ' ')} ({'+' if sign > 0 else '−'})"
            line(ax, turned[shown], curve, index, label, linestyle="-", linewidth=0.8)
    ax.text(
        0.02,
        0.98,
        f"pocket {pocket + 1}; 95 %: {run.numbers['pocket_force_p95']:.1f} N",
        va="top",
        transform=ax.transAxes,
        fontsize=8,
    )
    ax.set(xlabel="turns of the cage", ylabel="force (N)")


def figure_13(runs: Runs) -> dict[str, Figure]:
    """Forces between rollers and cage; both speeds have the same scale."""
    figure = panels(
        runs,
        "13",
        FIGURES["13"],
        _forces,
        "normal force between a roller and the cage, in the pocket with the most of it",
        (3.8, 2.1),
    )
    drawn = [ax for ax in figure.axes if ax.lines]
    if drawn:
        reach = 1.15 * max(abs(edge) for ax in drawn for edge in ax.get_ylim())
        for ax in drawn:
            ax.set_ylim(-reach, reach)
    return {"fig_13": figure}


def _spacing(ax: Axes, run: Run) -> None:
    shown, turned = _last(run), cage_turns(run)
    gaps = np.degrees(run.result.spacing_angles())[shown]
    for index in range(NEIGHBOURS):
        line(ax, turned[shown], gaps[:, index], index, f"rollers {index + 1}–{index + 2}", linewidth=0.9)
    _spacing_axes(ax, run, gaps)


def _spacing_axes(ax: Axes, run: Run, gaps: Array) -> None:
    even = 360.0 / run.result.n_rollers
    reach = max(0.1, 1.15 * float(np.abs(gaps - even).max()))
    ax.axhline(even, color=GREY, linewidth=0.8)
    ax.set_ylim(even - reach, even + reach)
    ax.set(xlabel="turns of the cage", ylabel="gap (deg)")


def figure_14(runs: Runs) -> dict[str, Figure]:
    """Spacing of adjacent rollers under axial load."""
    words = f"gaps between {NEIGHBOURS + 1} adjacent rollers (nominal {360 / 12:g} deg)"
    return {"fig_14": panels(runs, "14", FIGURES["14"], _spacing, words, (3.8, 2.1))}


def _settling_spacing(ax: Axes, run: Run) -> None:
    angles = run.history["roller_orbit_angle"]
    gaps, turned = np.degrees(observables.spacing(angles)), cage_turns(run, whole=True)
    for roller in range(NEIGHBOURS, gaps.shape[1]):
        line(ax, turned, gaps[:, roller], color=LIGHT, linestyle="-", linewidth=0.5, zorder=1)
    for index in range(NEIGHBOURS):
        line(ax, turned, gaps[:, index], index, f"rollers {index + 1}–{index + 2}", linewidth=0.9)
    _spacing_axes(ax, run, gaps)


def _slip(ax: Axes, run: Run) -> None:
    result = run.result
    for index, side in enumerate(("outer", "inner")):
        load, slip = result[f"{side}_load"], 1e4 * result[f"{side}_slide_roll"]
        place, mean = _binned(load, slip)
        ax.plot(
            place,
            mean,
            color=COLOURS[index],
            marker="os"[index],
            markersize=3,
            linewidth=1.0,
            label=f"{side} raceway",
        )
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    ax.set(xlabel="load of a roller (N)", ylabel=r"slide-roll ratio ($10^{-4}$)")


def _binned(x: Array, y: Array, bins: int = 24) -> tuple[Array, Array]:
    """Means of y over even bins of x."""
    edges = np.linspace(float(x.min()), float(x.max()) + 1e-9, bins + 1)
    index = np.digitize(x.ravel(), edges) - 1
    count = np.bincount(index, minlength=bins)[:bins]
    total = np.bincount(index, weights=y.ravel(), minlength=bins)[:bins]
    used = count > 0
    return 0.5 * (edges[:-1] + edges[1:])[used], total[used] / count[used]


def figure_18(runs: Runs) -> dict[str, Figure]:
    """Spacing under combined load, from the start on; and where the slip is that brings it about."""
    return {
        "fig_18": panels(
            runs,
            "18",
            FIGURES["18"],
            _settling_spacing,
            "gaps between rollers from the start on (grey: others)",
            (5.6, 2.0),
        ),
        "fig_18_slip": panels(
            runs,
            "18, why",
            FIGURES["18"],
            _slip,
            "slip over a roller's load (positive: roller faster)",
            (5.4, 2.1),
        ),
    }


@dataclass(frozen=True)
class MovableLimits:
    """Fig. 17 in numbers: distances in units of Cpr, by direction in the cage's frame.

    Attributes
    ----------
    equal : Movable
        Rollers held at equal spacing.
    free : Movable
        Rollers that give way.
    found : dict of str to Movable
        Rollers held where a run had them on average, by its start; from the cage's mean place in its frame.
    """

    equal: Movable
    free: Movable
    found: dict[StartKind, Movable]


def movable_limits(runs: Runs, steps: int = 4) -> MovableLimits:
    """How far the cage can move with rollers at equal spacing, with free ones, and with those of the runs.

    Parameters
    ----------
    runs : Runs
        The points.
    steps : int
        Directions in the angle between two rollers.
    """
    condition = FIGURES["17"][0]
    present = {start: run for start in runs.starts if (run := runs.first(condition, start)) is not None}
    scene = next(iter(present.values())).result.scene if present else Point(condition, "equal").scene()
    pockets, count = Pockets(scene), scene.bearing.n_rollers
    directions = 2.0 * np.pi * np.arange(steps * count) / (steps * count)
    play = scene.bearing.cage.play_radial
    found = {}
    for start, run in present.items():
        centre = complex(_in_cage(run).mean()) * play
        limit = pockets.held(_places(run), directions, (centre.real, centre.imag))
        found[start] = Movable(directions, limit.distance / play)

    def around(part: Movable) -> Movable:
        """Equal pockets: what holds between two rollers holds between all."""
        return Movable(directions, np.tile(part.distance, count) / play)

    return MovableLimits(around(pockets.held(0.0, directions[:steps])), around(pockets.free(directions[:steps])), found)


def _places(run: Run) -> Array:
    """Mean angle of each roller from its even place in the cage's frame (rad), less their mean."""
    result = run.result
    even = 2.0 * np.pi * np.arange(result.n_rollers) / result.n_rollers
    off = (result["roller_orbit_angle"] - result["cage_angle"][:, None] - even).mean(axis=0)
    return np.asarray(observables.wrap_angle(off - off.mean()))


def figure_17(runs: Runs, limits: MovableLimits | None = None) -> dict[str, Figure]:
    """Distance that the cage can move, by geometry, and where it moved in the runs.

    The limit for rollers held as in a run is drawn around the cage's mean place there: with their spacing it may not be able to
    stand in the middle.
    """
    condition = FIGURES["17"][0]
    limits = movable_limits(runs) if limits is None else limits
    present: list[StartKind | None] = [start for start in runs.starts if runs.first(condition, start) is not None]
    present = present or [None]
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(1, len(present), figsize=(0.4 + 2.9 * len(present), 3.7), squeeze=False, sharey=True)
        fig.suptitle(
            f"Fig. 17: distance that the cage can move, and its path in the cage's frame, {condition.title}",
            fontsize=10,
        )
        for ax, start in zip(axes[0], present, strict=True):
            run = None if start is None else runs.first(condition, start)
            if run is not None and start is not None:
                turned = _in_cage(run)
                ax.plot(turned.real, turned.imag, color=COLOURS[0], linewidth=0.7, label="path of the cage's centre")
                ax.set_title(START_WORDS[start], fontsize=9)
                label = "rollers held as on average in this run"
                _outline(ax, limits.found[start], COLOURS[1], label, LINES[3], complex(turned.mean()))
            _outline(ax, limits.free, "black", "free rollers", LINES[0])
            _outline(ax, limits.equal, "black", "rollers held at equal spacing", LINES[1])
            ax.set(aspect="equal", xlim=(-1.2, 1.2), ylim=(-1.2, 1.2), xlabel="$x/C_{pr}$ in the cage's frame")
        axes[0, 0].set_ylabel("$y/C_{pr}$")
        fig.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize=8.5)
    return {"fig_17": fig}


def _in_cage(run: Run) -> NDArray[np.complex128]:
    """Path of the cage's centre in the cage's frame, x + i y in units of Cpr."""
    path = run.result.cage_locus()
    return np.asarray((path[:, 0] + 1j * path[:, 1]) * np.exp(-1j * run.result["cage_angle"]))


def _outline(ax: Axes, movable: Movable, colour: str, label: str, dashes: Any, centre: complex = 0.0) -> None:
    angle, size = np.append(movable.direction, movable.direction[0]), np.append(movable.distance, movable.distance[0])
    x, y = centre.real + size * np.cos(angle), centre.imag + size * np.sin(angle)
    ax.plot(x, y, color=colour, linestyle=dashes, linewidth=1.1, label=label)


def _history(ax: Axes, runs: Runs, condition: Condition) -> None:
    for index, start in enumerate(runs.starts):
        for run in runs.of(condition, start):
            history = run.history
            time, amplitude = whirl_amplitude(history["time"], history["cage_position"], history["cage_angle"])
            label = START_WORDS[start] + (f", seed {run.point.seed}" if run.point.start == "unequal" else "")
            size = np.abs(amplitude) / run.result.clearances.radial
            dashes, marker = LINES[run.point.seed % len(LINES)], SEED_MARKS[run.point.seed % len(SEED_MARKS)]
            options: dict[str, Any] = {"linestyle": dashes, "marker": marker, "markevery": 0.2, "markersize": 3.5}
            ax.semilogy(time, size, color=COLOURS[index], linewidth=0.8, label=label, **options)
    ax.set_title(condition.title, fontsize=9)
    ax.set(ylim=(1e-3, 1.5), xlim=(0.0, None), xlabel="bearing time (s)")


def figure_settling(runs: Runs) -> dict[str, Figure]:
    """Amplitude of the whirl by turns of the cage, every condition and seed: what the starts do to it."""
    conditions = sorted({run.point.condition for run in runs.all})
    columns = min(3, len(conditions)) or 1
    rows = -(-len(conditions) // columns) or 1
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(
            rows, columns, figsize=(0.5 + 3.4 * columns, 1.1 + 1.9 * rows), squeeze=False, sharey=True
        )
        words = "Amplitude at the cage's own frequency, a value a turn of the cage; dashes and marks: seeds"
        fig.suptitle(words, fontsize=10)
        for ax, condition in zip(axes.flat, conditions, strict=False):
            _history(ax, runs, condition)
        for ax in axes.flat[len(conditions) :]:
            ax.set_visible(False)
        for row in axes:
            row[0].set_ylabel("amplitude / $C_{pr}$")
        labels: dict[str, Any] = {}
        for ax in axes.flat:
            labels |= {text: handle for handle, text in zip(*ax.get_legend_handles_labels(), strict=True)}
        if labels:
            fig.legend(labels.values(), labels.keys(), loc="outside lower center", ncols=3, fontsize=8.5)
    return {"settling": fig}


def draw_all(runs: Runs, folder: Path, limits: MovableLimits | None = None) -> list[Path]:
    """Draw and save every figure.

    Parameters
    ----------
    runs : Runs
        The points.
    folder : Path
        Folder of the pictures.
    limits : MovableLimits, optional
        Fig. 17 in numbers; computed by default.

    Returns
    -------
    list of Path
        The files.
    """
    makers: list[Callable[[Runs], dict[str, Figure]]] = [
        figure_8_12,
        figure_9,
        figure_10,
        figure_11_16,
        figure_13,
        figure_14,
        figure_15,
        lambda given: figure_17(given, limits),
        figure_18,
        figure_settling,
    ]
    written = []
    for make in makers:
        for name, figure in make(runs).items():
            written.append(plot.save(figure, folder / f"{name}.png", overwrite=True))
    return written
