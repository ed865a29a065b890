"""How well the averages of a run are known: half widths of 95 % confidence intervals, from whole turns of the cage
(docs/theory/whirl.md#how-well-a-mean-is-known).

Each average of the summary is computed again in each turn, or some turns, of the cage, and the values tell the error of the
whole (`trbdyn.observables.mean_error`). What is no mean, such as a percentile, is first made one by its influence function.
Where the cage's motion is not known to have settled, averages of that motion have no interval; those of loads, films, speeds and
losses, which follow the load at once, have, and what the scatter and the rate of the cage's share of the losses leave open is
added to those of torque and power loss.
Another whirl that another start would lead to, and errors of the model, are not in them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.results import observables
from trbdyn.results.observables.uncertainty import LEAST_BATCHES, MOST_COSINES

if TYPE_CHECKING:
    from trbdyn.results.number import Number
    from trbdyn.results.records import Records

Array = NDArray[np.float64]

OF_CAGE: Final = ("pocket", "land", "cage")
"""Beginnings of the names of losses at the cage."""
FOLLOWING: Final = ("load", "loss")
"""Averages that follow load and speed at once, whatever the cage does (`Number.interval`)."""

SLOPE: Final = 0.04
"""Share of the records on either side of a percentile whose distance tells how dense they are there."""


def confidence(
    window: Records,
    rows: Iterable[Number],
    average: Callable[[Records, Iterable[Number]], Mapping[str, Any]],
    unsettled: str = "",
) -> tuple[dict[str, float] | None, str]:
    """Half widths of the confidence intervals of averages over a window, in their units, None where they cannot be told; and in
    words from how many batches of which length they are, or why they cannot be told.

    `average` gives the numbers of some rows for a part of the records, by their names. `unsettled` says why the cage's motion is
    not known to have settled: then only what follows the load at once has intervals (`Number.interval`).
    """
    edges, turns = _batches(window)
    if len(edges) <= LEAST_BATCHES and unsettled:
        edges, turns = _of_records(window), 0.0  # what follows the load needs no whole turns of the cage
    if len(edges) <= LEAST_BATCHES:
        found = f"the window has {turns:.3g} turns of the cage" if turns else f"the window has {len(window)} records"
        return None, f"they cannot be told: {found}, and it takes {LEAST_BATCHES} turns"
    time = window["time"]
    wanted = [row for row in rows if row.interval in FOLLOWING or not unsettled]
    plain = [row for row in wanted if row.series is None]
    parts = [average(window.window(time[a], time[b]), plain) for a, b in pairwise(edges)]
    of_cage = _of_cage(window, edges) if unsettled else 0.0
    widths: dict[str, float] = {}
    untold: list[str] = []
    for row in wanted:
        name = row.name
        if row.series is not None:
            series = row.series(window)
            values = np.array([series[a:b].mean() for a, b in pairwise(edges)])
        else:
            values = np.array([math.nan if part[name] is None else part[name] for part in parts], dtype=float)
        if not np.isfinite(values).all():
            continue
        width = observables.half_width(values)
        if math.isfinite(width):
            widths[name] = width + (of_cage * abs(float(values.mean())) if row.interval == "loss" else 0.0)
        else:
            untold.append(name)
    each = f"{turns / (len(edges) - 1):.2g} turns of the cage" if turns else f"{time[edges[1]] - time[edges[0]]:.3g} s"
    none = f"; none for what drifts in the window: {', '.join(untold)}" if untold else ""
    if unsettled:
        none += f"; none for the cage's motion, which is not known to have settled: {unsettled}"
    return widths or None, (
        f"half widths of 95 % confidence intervals, from {len(edges) - 1} batches of {each}{none}; another whirl that another "
        "start leads to, and errors of the model, are not in them"
    )


def _of_cage(window: Records, edges: Sequence[int]) -> float:
    """How far the share of the losses that the cage has part in may be off: it goes with the cage's motion, so its rate and its
    scatter over the batches count.
    """
    if "power" not in window.groups:
        return 0.0
    time = window["time"]
    splits = [window.window(time[a], time[b]).power_split for a, b in pairwise(edges)]
    lost = float(np.mean([sum(split.values()) for split in splits]))
    if not lost > 0.0:
        return 0.0
    cage = [sum(value for name, value in split.items() if name.startswith(OF_CAGE)) for split in splits]
    return observables.mean_unknown([0.5 * (time[a] + time[b]) for a, b in pairwise(edges)], np.array(cage) / lost)


def _batches(window: Records) -> tuple[list[int], float]:
    """First records of batches of whole turns of the cage, with the last record, and the number of turns in all of them.

    Where the rollers stand or were not recorded, batches have one length and there are no turns.
    """
    most = 2 * MOST_COSINES
    if "rollers" in window.groups:
        angle = window["roller_orbit_angle"].mean(axis=1)
        turned = np.abs(angle[-1] - angle) / (2.0 * math.pi)  # back from the end
        whole = int(turned.max())
        if whole >= 1:
            each = math.ceil(whole / most)
            back = np.arange(whole // each, -1, -1) * each
            edges = [int(np.argmin(np.abs(turned - turn))) for turn in back]
            return edges if min(np.diff(edges)) >= 2 else [], float(back[0])
    return _of_records(window), 0.0


def _of_records(window: Records) -> list[int]:
    """First records of batches of one length, with the last record."""
    records = len(window)
    length = max(math.ceil((records - 1) / (2 * MOST_COSINES)), 2)
    return list(range((records - 1) % length, records, length))


def percentile_as_mean(values: Array, share: float, away: Array | None) -> Array:
    """A series over the records whose mean changes as a percentile, to first order.

    Where the values are distances from the mean place (`away`, shape (T, 2)), the percentile also changes with that place: it
    falls by what the place moves towards the records near the percentile.
    """
    at, low, high = np.quantile(values, (share, share - SLOPE, share + SLOPE))
    series = at + (high - low) / (2.0 * SLOPE) * (share - (values <= at))
    if away is None:
        return series
    near = (low <= values) & (values <= high) & (values > 0.0)
    return series - away @ (away[near] / values[near, np.newaxis]).mean(axis=0) if near.any() else series
