"""The paper's statements beside our numbers in one picture, from ``paper.json`` alone: nothing is computed again.

python -c "from paper.overview import draw; draw('overview.png')"
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from paper.points import FIGURES, STARTS, Condition, Inputs, Point, StartKind
from paper.statements import NAMED
from trbdyn import plot
from trbdyn.plot.style import COLOURS, GREY, STYLE

HERE: Final = Path(__file__).resolve().parent
SEEDS: Final = (0, 1, 2, 3)
SCATTERS: Final = (0.0, 0.2e-6, 1e-6)
DIRECTIONS: Final = (90.0, 180.0, 0.0, -90.0)
ZONES: Final = {90.0: "on top", 180.0: "rollers descend", 0.0: "rollers rise", -90.0: "at the bottom"}
CPC_OVER_CPR: Final = 0.48

Numbers = Mapping[str, Any]


def kept() -> Numbers:
    """`paper.json`."""
    found: Numbers = json.loads((HERE / "paper.json").read_text(encoding="utf-8"))
    return found


SHOWN: Final = {
    "8a-measured": "loci at three speeds, 3080 N, measured (8a) and simulated (12a): circles, larger with the speed",
    "8b-load": "loci at three axial loads, 3000 rpm, measured (8b) and simulated (12b): larger with the load",
    "8b-one": "the same: at 4930 N the locus fills the radial play",
    "12b-none": "the same, simulated: no clear whirl at 1230 N",
    "9-small": "axial motion over time at three speeds: grows with the speed, small against the axial play",
    "10-frequency": "tilt over time at two points, with the turns of the cage",
    "10-direction": "the same, beside the displacement",
    "13-forces": "normal forces between a roller and the cage over time, 1000 and 3000 rpm",
    "14-yields": "angles between neighbouring rollers over time at 1230 N",
    "14-persists": "the same at 4930 N",
    "15-scatter": "locus at 1230 N with rollers that differ by 1 um",
    "16-smaller": "loci under combined load, measured (11) and simulated (16)",
    "16-size": "the same at three speeds and three radial loads",
    "17-movable": "how far the cage can move with equal and with unequal spacing, by geometry",
    "18-equalises": "angles between neighbouring rollers under combined load, from the start on",
}
"""What the paper's figures show, by the statement that is read from them."""


def table(found: Numbers) -> str:
    """Figures of the paper beside what the campaign finds, as the page has it: from random spacing with the load on top and equal
    rollers, and with the named set of inputs.
    """
    named = {entry["key"]: entry for entry in found["statements_by_inputs"][NAMED.name]}
    lines = [
        "| Fig. | the paper shows | load on top, equal rollers | agrees | named set | agrees |",
        "|" + " --- |" * 6,
    ]
    for entry in found["statements"]:
        if entry["key"] in SHOWN:
            cells = [*_ours(entry, "unequal"), *_ours(named.get(entry["key"], entry), "equal")]
            lines.append(f"| {entry['figure']} | {SHOWN[entry['key']]} | {' | '.join(cells)} |")
    return "\n".join(lines)


def columns(found: Numbers) -> str:
    """How far the locus reaches under combined load (95 %, Cpr), in brackets the orbit: means over seeds, with a column for each
    direction and scatter.
    """
    points = found["points"]
    asked = [Inputs(direction, scatter) for scatter in SCATTERS for direction in DIRECTIONS]
    conditions = tuple(dict.fromkeys((*FIGURES["16a"], *FIGURES["16b"])))
    lines = [f"| rpm / Fr (N) | {' | '.join(inputs.name for inputs in asked)} |", "|" + " --- |" * (1 + len(asked))]
    for condition in conditions:
        cells = []
        for inputs in asked:
            chosen = condition.within(inputs)
            reach = values(points, chosen, "equal", "whirl_radius_over_cpr", "p95")
            orbit = values(points, chosen, "equal", "orbit_over_cpr")
            cells.append(f"{sum(reach) / len(reach):.2f} ({sum(orbit) / len(orbit):.2f})" if reach else "–")
        lines.append(f"| {condition.speed_rpm:g} / {condition.radial_load:g} | {' | '.join(cells)} |")
    return "\n".join(lines)


def axial_columns(found: Numbers) -> str:
    """Orbit under axial load alone (Cpr) and the frequency of the whirl over that of the cage, with a column for each scatter."""
    points = found["points"]
    conditions = tuple(dict.fromkeys((*FIGURES["12a"], *FIGURES["12b"], *FIGURES["10"])))
    names = [Inputs(scatter=scatter).name.partition(", ")[2] for scatter in SCATTERS]
    lines = [f"| rpm / Fa (N) | {' | '.join(names)} |", "|" + " --- |" * (1 + len(SCATTERS))]
    for condition in sorted(conditions):
        cells = []
        for scatter in SCATTERS:
            chosen = condition.within(Inputs(scatter=scatter))
            orbit = values(points, chosen, "equal", "orbit_over_cpr")
            ratio = values(points, chosen, "equal", "whirl_ratio")
            cells.append(f"{sum(orbit) / len(orbit):.2f}, ratio {sum(ratio) / len(ratio):.2f}" if orbit else "–")
        lines.append(f"| {condition.speed_rpm:g} / {condition.axial_load:g} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _ours(entry: Mapping[str, Any], start: str) -> tuple[str, str]:
    """What was found from a start, or from one that is judged, and whether it agrees."""
    rows = entry["by_start"]
    judged = [row for row in (rows.get(start), *rows.values()) if row is not None and row["agrees"] is not None]
    ours = judged[0] if judged else next(iter(rows.values()))
    return ours["finding"], {True: "yes", False: "**no**", None: "–"}[ours["agrees"]]


def values(points: Numbers, condition: Condition, start: StartKind, *names: str | int) -> list[float]:
    """A number of every seed that was run."""
    out = []
    for name in dict.fromkeys(Point(condition, start, seed).name for seed in SEEDS):
        if name in points:
            value: Any = points[name]
            for part in names:
                value = value[part]
            out.append(float(value))
    return out


def _over(ax: Axes, points: Numbers, figure: str, along: str, *names: str | int) -> None:
    for index, start in enumerate(STARTS):
        for condition in FIGURES[figure]:
            found = values(points, condition, start, *names)
            x = [getattr(condition, along)] * len(found)
            ax.plot(x, found, "osd"[index], color=COLOURS[index], markersize=5, fillstyle="none")
        ax.plot([], [], "osd"[index], color=COLOURS[index], fillstyle="none", label=f"start: {start}")
    ax.legend(fontsize=7)
    ax.set_ylim(bottom=0.0)


def _combined(ax: Axes, points: Numbers) -> None:
    conditions = tuple(dict.fromkeys((*FIGURES["16a"], *FIGURES["16b"])))
    for index, direction in enumerate(DIRECTIONS):
        label: str | None = f"{direction:g}°: {ZONES[direction]}"
        for place, condition in enumerate(conditions):
            chosen = condition.within(Inputs(direction))
            found = values(points, chosen, "equal", "whirl_radius_over_cpr", "p95")
            shifted = [place + 0.12 * (index - 1.5)] * len(found)
            ax.plot(shifted, found, "osdv"[index], color=COLOURS[index], markersize=5, label=label if found else None)
            label = None if found else label
    ax.axhline(CPC_OVER_CPR, color=GREY, linestyle="--", linewidth=0.9)
    names = [f"{c.speed_rpm:g} rpm\n{c.radial_load:g} N" for c in conditions]
    ax.set_xticks(range(len(names)), names, fontsize=7)
    ax.set(ylabel="reach (95 %) / $C_{pr}$", ylim=(0.0, 1.1))
    ax.legend(fontsize=7, ncols=2)


def draw(path: str | Path) -> None:
    """Draw it."""
    points = kept()["points"]
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(2, 2, figsize=(8.6, 6.6))
        (speed, load), (axial, combined) = axes
        _over(speed, points, "12a", "speed_rpm", "orbit_over_cpr")
        speed.set(xlabel="speed (rpm)", ylabel="orbit / $C_{pr}$")
        speed.set_title("Fig. 8a, 12a: the radius grows with the speed (3080 N)", fontsize=8.5)
        _over(load, points, "12b", "axial_load", "orbit_over_cpr")
        load.set(xlabel="axial load (N)", ylabel="orbit / $C_{pr}$")
        load.set_title("Fig. 8b, 12b: it grows with the load, to about 1 (3000 rpm)", fontsize=8.5)
        _over(axial, points, "9", "speed_rpm", "axial_range", 1)
        axial.axhline(0.15, color=GREY, linestyle="--", linewidth=0.9)
        axial.set(xlabel="speed (rpm)", ylabel="axial place (95 %) / play")
        axial.set_title("Fig. 9: axial motion grows with the speed, below 15 %", fontsize=8.5)
        _combined(combined, points)
        combined.set_title("Fig. 11, 16: combined load, about $C_{pc}/C_{pr}$ (dashed)", fontsize=8.5)
        plot.save(fig, Path(path), overwrite=True)
