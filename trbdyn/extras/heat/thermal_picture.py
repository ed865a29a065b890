"""The picture of a thermal balance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from trbdyn.plot.style import COLOURS, GREY, MARKERS, plain, scaled, styled


def draw_balance(balances: Sequence[Any]) -> Any:
    """Draw what `trbdyn.thermal` gave, a row for each bearing: the power that is lost over the temperature of films, the point
    where it balances, and all temperatures.
    """
    with styled():
        size = (10.0, 4.0 * len(balances))
        figure, places = plt.subplots(len(balances), 2, figsize=size, width_ratios=(1.2, 1.0), squeeze=False)
        for row, found in zip(places, balances, strict=True):
            _draw(row[0], row[1], found)
    return figure


def _draw(left: Any, right: Any, found: Any) -> None:
    film = found.temperatures["film"]
    factor, unit = scaled("W", found.curve[:, 1])
    left.plot(found.curve[:, 0], factor * found.curve[:, 1], marker="o", ms=4, color=COLOURS[0], label="lost, by runs")
    coldest = min(outside for conductance, outside in found.paths.outer_links.values() if conductance > 0.0)
    left.plot(film, factor * found.power, "s", color=COLOURS[6], ms=8, label="given off as well")
    left.axvline(film, color=GREY, lw=0.8, ls=":")
    left.set(
        xlabel="temperature of films (°C)", ylabel=f"power ({unit})", title=plain(found.scene.bearing.name) or "bearing"
    )
    left.set_ylim(bottom=0.0)
    left.set_xlim(left=min(coldest, found.curve[0, 0]) - 2.0)
    left.legend()
    names = list(found.temperatures)
    for k, name in enumerate(names):
        low, high = found.bands[name]
        right.plot([low, high], [k, k], color=COLOURS[k % len(COLOURS)], lw=3.0, alpha=0.5, solid_capstyle="butt")
        right.plot(found.temperatures[name], k, MARKERS[k % len(MARKERS)], color=COLOURS[k % len(COLOURS)])
    right.set_yticks(np.arange(len(names)), [name.replace("_", " ") for name in names])
    right.set_ylim(len(names) - 0.5, -0.5)
    right.set(xlabel="temperature (°C)", title="95 % of the draws of conductances")
