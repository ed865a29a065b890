"""The picture of a plan: what each simplification changes, and what it saves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from trbdyn.plot.style import COLOURS, GREY, LIGHT, MARKERS, styled

if TYPE_CHECKING:
    from trbdyn.extras.design.planning.proposal import Plan, Row

LEAST = 1e-2
"""Smallest change that is drawn (%)."""


def draw(plan: Plan) -> Any:
    """Draw the influence of each simplification on each wanted average, and its computing time."""
    rows = [row for row in plan.rows if math.isfinite(row.time_ratio)][::-1]
    with styled():
        figure, (left, right) = plt.subplots(
            1,
            2,
            sharey=True,
            figsize=(9.5, 2.0 + 0.26 * len(rows) + 0.2 * len(plan.want)),
            gridspec_kw={"width_ratios": (2.2, 1.0)},
        )
        _influences(left, plan, rows)
        _times(right, rows)
        left.set_yticks(range(len(rows)), [_label(row) for row in rows])
        left.set_ylim(-0.6, len(rows) - 0.4)
        figure.legend(loc="outside lower center", ncols=2)
        figure.suptitle(
            "What each simplification changes in the averages that were asked for, and what it saves", fontsize=11
        )
    return figure


def _label(row: Row) -> str:
    name = f"without {row.name}" if row.kind == "effect" else row.name
    return f"{name}  ✓" if row.chosen else name


def _influences(ax: Any, plan: Plan, rows: list[Row]) -> None:
    share = 0.7 / len(plan.want)
    for k, (name, wish) in enumerate(plan.want.items()):
        colour, place = COLOURS[k % len(COLOURS)], (k - 0.5 * (len(plan.want) - 1)) * share
        for y, row in enumerate(rows):
            found = row.influence.get(name)
            if found is None or not math.isfinite(found.change):
                continue
            middle = max(100.0 * abs(found.change), LEAST)
            low = max(100.0 * (abs(found.change) - found.half_width), LEAST)
            ax.plot(
                [low, max(100.0 * found.bound, LEAST)], [y + place] * 2, color=colour, lw=2.0, solid_capstyle="butt"
            )
            ax.plot(
                middle, y + place, MARKERS[k % len(MARKERS)], color=colour, ms=5, mfc=colour if row.chosen else "white"
            )
        ax.plot([], [], MARKERS[k % len(MARKERS)], color=colour, label=f"{name}, change with its 95 % interval")
        ax.axvline(100.0 * wish, color=colour, ls="--", lw=1.0, label=f"{name}, wanted within {100.0 * wish:.3g} %")
    ax.set_xscale("log")
    ax.set_xlim(left=LEAST)
    ax.set_xlabel(f"size of the change (%); {LEAST:g}: or less")


def _times(ax: Any, rows: list[Row]) -> None:
    ratios = np.array([row.time_ratio for row in rows])
    colours = [COLOURS[3] if row.chosen else LIGHT for row in rows]
    ax.barh(range(len(rows)), ratios, height=0.6, color=colours)
    for y, ratio in enumerate(ratios):
        ax.annotate(
            f"{ratio:.2f}", (ratio, y), xytext=(3, 0), textcoords="offset points", va="center", fontsize=8, color=GREY
        )
    ax.axvline(1.0, color=GREY, lw=1.0)
    ax.set_xlim(0.0, 1.2 * max(1.0, float(ratios.max(initial=1.0))))
    ax.set_xlabel("computing time (1)")
    ax.plot([], [], color=COLOURS[3], lw=6, label="computing time over the usual one: made by the plan (✓)")
    ax.plot([], [], color=LIGHT, lw=6, label="the same: not made")
