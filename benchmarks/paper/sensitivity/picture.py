"""Tornado plots: the largest effects on each indicator at a point, with the noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from paper.sensitivity.effects import Effect, Nominal
from paper.sensitivity.indicators import INDICATORS
from paper.sensitivity.inputs import Input
from paper.sensitivity.plan import Place
from trbdyn.plot.style import COLOURS, LIGHT, STYLE

SHOWN: Final = ("orbit_growth", "whirl_radius", "pocket_force", "torque")
"""Indicators with a panel; at a point without small starts the first panel shows the orbit."""
ROWS: Final = 14
"""Inputs in a panel: those with the largest effects."""


def tornado(place: Place, nominal: Mapping[str, Nominal], effects: Sequence[Effect], inputs: Sequence[Input]) -> Figure:
    """One panel for each of four indicators at a point; inputs are sorted by their largest effect there."""
    order = {entry.name: [level.label for level in entry.levels] for entry in inputs}
    names = [name if name in nominal else "orbit" for name in SHOWN]
    with plt.rc_context(STYLE):
        figure, panels = plt.subplots(2, 2, figsize=(11.0, 10.5))
        for ax, name in zip(panels.flat, names, strict=False):
            _panel(
                ax, name, nominal[name], [e for e in effects if e.point == place.name and e.indicator == name], order
            )
        handles: list[Any] = [
            Patch(color=COLOURS[0], label="lower or first level"),
            Patch(color=COLOURS[1], label="higher or second level"),
            Patch(color=LIGHT, label="noise (95 %)"),
            Line2D([], [], color="black", marker="$*$", linestyle="", label="beyond noise"),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=4)
        figure.suptitle(f"{place.condition.title}: change of an indicator by one input")
    return figure


def _panel(ax: Axes, name: str, nominal: Nominal, effects: Sequence[Effect], order: Mapping[str, list[str]]) -> None:
    indicator = next(entry for entry in INDICATORS if entry.name == name)
    largest: dict[str, float] = {}
    for effect in effects:
        largest[effect.input] = max(largest.get(effect.input, 0.0), abs(effect.change))
    chosen = sorted(largest, key=lambda entry: -largest[entry])[:ROWS]
    reach = max([largest[entry] for entry in chosen] + [0.0])
    for row, entry in enumerate(chosen):
        mine = [effect for effect in effects if effect.input == entry]
        widest = max(effect.noise for effect in mine)
        ax.barh(row, 2.0 * widest, 0.92, left=-widest, color=LIGHT, zorder=1)
        for effect in mine:
            place = order[entry].index(effect.level)
            height = row + (place - 0.5 * (len(order[entry]) - 1)) * 0.38
            ax.barh(height, effect.change, 0.36, color=COLOURS[place], zorder=2)
            left = effect.change < 0.0
            text = f"{effect.level} *" if effect.beyond else effect.level
            ax.annotate(
                text,
                (effect.change, height),
                (-3 if left else 3, 0),
                textcoords="offset points",
                ha="right" if left else "left",
                va="center",
                fontsize=6.5,
                zorder=3,
            )
    ax.set_yticks(range(len(chosen)), chosen)
    ax.set_ylim(len(chosen) - 0.4, -0.6)
    if reach > 0.0:
        ax.set_xlim(-1.45 * reach, 1.45 * reach)
    ax.locator_params(axis="x", nbins=5)
    ax.axvline(0.0, color="black", linewidth=0.8, zorder=3)
    ax.grid(visible=False, axis="y")
    ax.set_xlabel(f"change of {indicator.text} ({indicator.unit})")
    ax.set_title(f"nominal {nominal.mean:.3g} ± {nominal.deviation:.2g} {indicator.unit} ({nominal.count} seeds)")
