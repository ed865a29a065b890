"""The picture of a search for the best designs: what was run, the front, the chosen and the first design."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from trbdyn.plot.style import COLOURS, GREY, LIGHT, plain, styled
from trbdyn.results.numbers import find

if TYPE_CHECKING:
    from trbdyn.extras.design.optimise import Design, Optimum


def draw_front(found: Optimum) -> Any:
    """Draw the designs over the first two aims; of one aim over the order in which they were run."""
    aims, names = list(found.want)[:2], found.subjects[0].names

    def places(designs: tuple[Design, ...]) -> Any:
        own = [[one.expected[aim] for aim in aims] for one in designs]
        return np.array(
            [[one.number, *row] if len(aims) == 1 else row for one, row in zip(designs, own, strict=True)]
        ).T

    with styled():
        figure, ax = plt.subplots()
        raw = np.array(
            [[one.number if len(aims) == 1 else one.values[aims[0]], one.values[aims[-1]]] for one in found.designs]
        )
        ax.plot(*raw.T, ".", color=LIGHT, label="as run")
        ax.plot(*places(found.designs), "o", color=GREY, ms=3.5, label="as all runs together tell")
        front = places(tuple(sorted(found.front, key=lambda one: one.expected[aims[0]])))
        # designs without longer runs may lie beyond it: they are not known to keep what they promise
        of = "front of the designs with longer runs" if found.chosen.confirmed else "front"
        ax.plot(*front, "o-" if len(aims) > 1 else "o", color=COLOURS[0], ms=5.0, label=of)
        ax.plot(*places((found.first,)), "s", color=COLOURS[1], ms=8.0, label="first design")
        ax.plot(*places((found.chosen,)), "D", color=COLOURS[3], ms=8.0, label="chosen design")
        ax.set_xlabel(_label(aims[0], names) if len(aims) > 1 else "number of the design")
        ax.set_ylabel(_label(aims[-1], names))
        ax.legend(loc="best")
        figure.suptitle(f"Designs of {plain(found.subjects[0].part.bearing.name)} for {len(found.want)} aims")
    return figure


def _label(name: str, bearings: tuple[str, ...]) -> str:
    known = find(name, bearings)
    unit = known.unit if known is not None else ""
    return plain(f"{known.words if known is not None else name}{f' ({unit})' if unit else ''}".strip())
