"""What runs from several starts, side by side, tell of the motion of a cage in the long run
(docs/theory/whirl.md#starts-side-by-side).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from trbdyn.results.observables.rates import (
    LEAST_BLOCKS,
    Drift,
    drift,
    forecast,
    latest,
    mean_unknown,
    time_left,
)
from trbdyn.results.observables.slow_motion import CREEP_TIMES, LIMITS, moving

Array = NDArray[np.float64]
Turns = tuple[Array, Mapping[str, Array]]
"""Times of the turns of a run (s), and means over these turns by the names of `LIMITS`, as `turn_means` gives them."""

COMPARED: Final = "orbit radius"
"""Quantity by which starts are compared."""
WANDERS: Final = 0.1
"""Error of the mean orbit of a start, over Cpr, up to which starts of one class are told to be alike; and difference of their
orbits from which on this takes runs of three creep times.
"""
ALIKE: Final = 0.25
"""Difference of the orbits of starts of one class up to which they are told to be alike, and longest way that none of the starts
has gone where the third only moves towards the motion of the others; in units of Cpr.
"""
MOVED: Final = 0.02
"""Way of a start within a part of its run from which on a direction is told, in units of Cpr."""
SHARE: Final = 0.2
"""Change of the roller spacing, over the spacing, up to which it does not matter, within the time in which nothing must go on."""
OF_STARTS: Final = ("from rest", "from a large whirl", "from a small whirl")
"""The starts in words."""
SLOW: Final = 250.0
"""Turns of the cage within which the rollers creep from which on starts are not expected to agree: the start decides."""
NO_WHIRL: Final = frozenset({"stable", "rocking"})
"""Classes of a cage that does not circle: a cage that hangs still and one that rocks by as much as the limit are one motion."""


@dataclass(frozen=True, slots=True)
class Compared:
    """What runs from several starts, side by side, tell of the motion in the long run.

    Attributes
    ----------
    verdict : {"agreed", "alike", "so far", "grows", "dies", "meets", "two motions", "start decides", "unknown"}
        Agreed: all starts have come to the same motion, or two of three have, and the last one moves towards it and is near to
        where one of these began. Alike: their motion is of one class, but their orbits differ by more, or wander.
        Grows, dies: they have not, and the start between the two others moves towards the larger or the smaller one, or it is
        there already and the other follows. Meets: a larger one moves down and a smaller one up. Two motions: the outer ones have
        settled apart, and the start between them has gone to one of them; or a smaller one moves down and a larger one up. Start
        decides: the rollers creep within more than `SLOW` turns, and each start keeps its own motion for a time that is told.
        Unknown: none of these.
    orbit : float
        Agreed, alike, so far: the orbit of the cage, mean of the starts. Grows, dies: that of the start towards which it moves.
        Meets: between these two. Over Cpr.
    error : float
        Largest difference of a start from it, or half of the way that is left (Cpr).
    rate : float
        Rate of the start that shows the direction, Cpr in a second (meets: of the distance; agreed: of the start that has not
        come there yet), in the latest part of its run in which it stands out of the scatter; nan where there is none.
    rate_error : float
        Its standard error.
    time_low, time_high : float
        Grows, dies, meets: how much longer the way is expected to take, but for the limit of an orbit, s; the latter infinite
        where the start slows down so that it may not come there. Start decides: `time_low` is the time within which no start is
        expected to move by more than the limit of an orbit, or has not moved by it.
    reason : str
        Unknown: why. So far: what goes on.
    ends : tuple of float
        Orbits of the outer starts in their last window, from rest and from a large whirl, over Cpr.
    open : tuple of int
        Starts whose longer runs may tell more: 0 from rest, 1 from a large whirl, 2 the one between. Where a direction is told,
        one that stands and one that follows behind are not among them.
    movers : tuple of int
        Grows, dies, meets: the starts whose way the rate and the times are of; agreed: the one that has not come there yet.
    """

    verdict: Literal["agreed", "alike", "so far", "grows", "dies", "meets", "two motions", "start decides", "unknown"]
    orbit: float
    error: float
    rate: float = math.nan
    rate_error: float = math.nan
    time_low: float = math.nan
    time_high: float = math.nan
    reason: str = ""
    ends: tuple[float, float] = (math.nan, math.nan)
    open: tuple[int, ...] = (0, 1, 2)
    movers: tuple[int, ...] = ()


def _alike(kinds: Collection[str]) -> bool:
    """Whether classes are one, or only such that do not circle."""
    return "unknown" not in kinds and (len(set(kinds)) <= 1 or set(kinds) <= NO_WHIRL)


def _similar(kinds: Collection[str]) -> bool:
    """The same, where some runs move without order, so that their class may be another in the next window."""
    return _alike([kind for kind in kinds if kind != "unstable"])


def agree(orbits: Collection[float], unknown: Collection[float], kinds: Collection[str]) -> bool:
    """Whether runs from several starts have come to one motion.

    Parameters
    ----------
    orbits : collection of float
        Mean orbit radius at the end of each, over Cpr.
    unknown : collection of float
        How far each mean may be off (`mean_unknown`), over Cpr.
    kinds : collection of str
        Classes of their motion: one class, or only such that do not circle.

    Returns
    -------
    bool
        All orbits lie within the limit of an orbit, and each is known within it.

    Examples
    --------
    >>> from trbdyn import observables
    >>> observables.agree([0.10, 0.12], [0.01, 0.02], ["stable", "rocking"])
    True
    """
    limit = LIMITS[COMPARED]
    return (
        _alike(kinds) and max(orbits) - min(orbits) <= limit and all(one <= limit for one in unknown)
    )  # nan is not known


def compare_starts(
    outer: tuple[Turns, Turns],
    between: Turns | None = None,
    *,
    window: int,
    creep_turns: float = math.nan,
    kinds: Sequence[str] = (),
) -> Compared:
    """What runs from a quiet start, from a large whirl and, where these do not agree, from one between tell.

    Parameters
    ----------
    outer : pair of pairs
        Of the run from rest and of the one from a large whirl, as `turn_means` gives them: times of the turns of the cage (s),
        and the means over these turns by the names of `LIMITS`, of which the orbit radius must be there.
    between : pair, optional
        The same of the start between. Runs may differ in length.
    window : int
        Turns of the cage in a window. The last window of each run is compared, or, where this scatters too much, the last half.
        The first window is a transient, from which no rate is taken.
    creep_turns : float
        Time of the rollers' creep in turns of the cage; nan where it is not known.
    kinds : sequence of str, optional
        Classes of the motion in the last window of the outer runs, and of the one between: only those of one class agree, or that
        both do not circle.

    Returns
    -------
    Compared

    Examples
    --------
    >>> import numpy as np
    >>> from trbdyn import observables
    >>> turns = np.arange(60.0)
    >>> rest, large = ((turns, {"orbit radius": 0.1 + size * np.exp(-turns / 5)}) for size in (0.0, 0.8))
    >>> found = observables.compare_starts((rest, large), window=20)
    >>> found.verdict, round(found.orbit, 2)
    ('agreed', 0.1)
    """
    limit, of_outer = LIMITS[COMPARED], kinds[:2]
    size = min(means[COMPARED].size for _, means in outer)
    # a start between that has only begun tells nothing yet
    third = None if between is None or min(between[0].size, size) < 2 * window else between
    runs = [*outer, *([] if third is None else [third])]
    series = [(when, means[COMPARED]) for when, means in runs]
    ends = (float(series[0][1][-window:].mean()), float(series[1][1][-window:].mean()))
    middle, apart = 0.5 * sum(ends), abs(ends[1] - ends[0])
    alike: Compared | None = None
    unknown, halves = [math.inf, math.inf], [max(window, min(when.size, size) // 2) for when, _ in series]
    goes = [_goes_on(run, half, creep_turns) for run, half in zip(runs, halves, strict=True)]
    ways = "; ".join(f"{of} the {way}" for of, way in zip(OF_STARTS, goes, strict=False) if way)
    for parts in ([window] * len(runs), halves):
        last_ones = [(when[-part:], values[-part:]) for (when, values), part in zip(series, parts, strict=True)]
        means = [float(values.mean()) for _, values in last_ones]
        unknown = [mean_unknown(*one) for one in last_ones]
        both, low, high = (means[0], means[1]), min(means), max(means)
        error, differ = 0.5 * (high - low) + max(unknown), high - low
        of_all = kinds[: len(runs)]
        if agree(means, unknown, of_all) and not any(goes):
            return Compared("agreed", 0.5 * (low + high), error, ends=both)
        long_enough = size >= max(2 * window, CREEP_TIMES * np.nan_to_num(creep_turns) if differ > WANDERS else 0.0)
        if differ <= ALIKE and all(one <= WANDERS for one in unknown) and long_enough and of_all and _similar(of_all):
            verdict: Literal["alike", "so far"] = "so far" if ways else "alike"
            alike = Compared(verdict, 0.5 * (low + high), error, reason=ways, ends=both)
    if alike is not None and not ways:
        return alike
    creeps = "" if math.isnan(creep_turns) else f"; the rollers creep within {creep_turns:.3g} turns of the cage"
    classes = "" if len(set(of_outer)) <= 1 else f"; one of them is {', the other '.join(sorted(set(of_outer)))}"
    said = (
        f"from rest the orbit is {ends[0]:.2f} Cpr, from a large whirl {ends[1]:.2f} Cpr{classes}{ways and '; '}{ways}"
    )
    if third is None:
        if size >= 2 * window and (keeps := _keeps(series[:2], window)) and creep_turns > SLOW and apart > limit:
            return Compared("start decides", middle, 0.5 * apart, time_low=keeps, ends=ends)
        return alike or Compared("unknown", middle, 0.5 * apart, reason=f"{said}{creeps}", ends=ends)
    moves = [_Motion.of(when, values, window) for when, values in series]
    now = float(series[2][1][-window:].mean())
    places = (*ends, now)
    near_end = min(ends, key=lambda end: abs(now - end))
    gone = abs(now - near_end) <= limit < apart
    for k, other, last in ((0, 2, 1), (1, 2, 0), (0, 1, 2)):
        known = [mean_unknown(series[one][0][-window:], series[one][1][-window:]) for one in (k, other)]
        classes_of = [kinds[one] for one in (k, other)] if len(kinds) == len(series) else []
        if (
            not any(_goes_on(runs[one], window, creep_turns) for one in (k, other))
            and agree([places[k], places[other]], known, classes_of)
            and _comes(series[last], series, window, moves[last].way, places[k])
        ):
            orbit, rate = 0.5 * (places[k] + places[other]), moves[last].rate
            off = 0.5 * abs(places[k] - places[other]) + max(known)
            return Compared("agreed", orbit, off, rate.rate, rate.error, ends=ends, movers=(last,))
    small = moves[2].rate
    stand = moves[0].way == moves[1].way == 0.0 and not any(goes)
    if gone and stand and size >= CREEP_TIMES * creep_turns and apart > limit + sum(unknown):
        return Compared("two motions", near_end, 0.5 * apart, small.rate, small.error, ends=ends)

    def towards(
        verdict: Literal["grows", "dies", "meets"],
        to: float,
        way: float,
        motion: _Motion,
        movers: tuple[int, ...],
        goes_on: Collection[int] = (0, 1, 2),
    ) -> Compared:
        low, high = time_left(max(way - limit, MOVED), motion.rate, motion.before, motion.apart)
        still_open = tuple(k for k in goes_on if moves[k].way or k == 2 or unknown[k] > limit)
        rate = motion.rate
        return Compared(verdict, to, 0.5 * way, rate.rate, rate.error, low, high, "", ends, still_open, movers)

    ups, downs = ([k for k, one in enumerate(moves) if one.way == way] for way in (1.0, -1.0))
    if ups and downs:
        low, high = max(ups, key=lambda k: places[k]), min(downs, key=lambda k: places[k])
        way = places[high] - places[low]
        if way > limit:
            pair = (low, high) if 2 in (low, high) else (0, 1)
            distance = moves[high].less(moves[low])
            return towards("meets", 0.5 * (places[low] + places[high]), way, distance, (low, high), pair)
        first = [float(values[window : 2 * window].mean()) for _, values in series]
        if way < 0.0 and max(first[k] for k in downs) < min(first[k] for k in ups):
            # what was smaller shrinks and what was larger grows: a motion that nothing keeps lies between
            return Compared("two motions", near_end, 0.5 * apart, small.rate, small.error, ends=ends)
    if (ups or downs) and not (ups and downs):
        to = max(places) if ups else min(places)
        # one that moves alone tells a direction only where the start between moves, too, or has gone to the other side
        if moves[2].way:
            end = 1 if ups else 0
            goes_on = (end, 2) if places[end] == to else (0, 1, 2)
            return towards("grows" if ups else "dies", to, abs(to - now), moves[2], (2,), goes_on)
        if gone and (alone := [k for k in (0, 1) if moves[k].way and abs(places[k] - now) > limit]):
            one, place = moves[alone[0]], places[alone[0]]
            return towards("grows" if ups else "dies", to, abs(to - place), one, (alone[0],), alone)
    if creep_turns > SLOW and apart > limit and (keeps := _keeps(series, window)):
        return Compared("start decides", middle, 0.5 * apart, time_low=keeps, ends=ends)
    if alike is not None:
        return alike
    how = f"a start between them moves by {small.rate:+.2g} with an error of {small.error:.1g} Cpr in a second"
    reason = f"{said}, and {how}{creeps}"
    return Compared("unknown", middle, 0.5 * apart, small.rate, small.error, reason=reason, ends=ends)


def _goes_on(run: Turns, length: int, creep_turns: float) -> str:
    """What drifts in the last turns of a run so that it will matter within these or three times of the creep, in words; empty
    where nothing does. As `motion_settling` has it; but a spacing may change by a share of itself.
    """
    when, means = run[0][-length:], {name: values[-length:] for name, values in run[1].items()}
    turn = float(np.ptp(when)) / (when.size - 1)
    horizon = turn * max(float(length), CREEP_TIMES * float(np.nan_to_num(creep_turns)))
    rates = {name: drift(when, values) for name, values in means.items()}
    found = [
        one for one in moving(when, means, rates, horizon) if one[0] != "roller spacing" or one[1] * SHARE < horizon
    ]
    name, _, words = min(found, key=lambda entry: entry[1], default=("", 0.0, ""))
    return f"{name} {words}" if found else ""


@dataclass(frozen=True, slots=True)
class _Motion:
    """How a start moves: 1 up, -1 down, 0 not; its rate in the latest part in which it moves, that in the part before, and the
    time between the middles of both (s).
    """

    way: float
    rate: Drift
    before: Drift
    apart: float

    @classmethod
    def of(cls, when: Array, values: Array, window: int) -> _Motion:
        """From a run without its first window."""
        rate, before, length = latest(when[window:], values[window:], 2 * window, MOVED)
        moved = rate.significant and abs(rate.rate) * length > MOVED
        return cls(math.copysign(1.0, rate.rate) if moved else 0.0, rate, before, length)

    def less(self, other: _Motion) -> _Motion:
        """How the distance to another one changes."""

        def of(one: Drift, two: Drift) -> Drift:
            error = math.hypot(one.error, two.error)
            return Drift(one.mean - two.mean, one.rate - two.rate, error, min(one.freedom, two.freedom))

        rate, before = of(self.rate, other.rate), of(self.before, other.before)
        return _Motion(math.copysign(1.0, rate.rate), rate, before, min(self.apart, other.apart))


def _keeps(series: Sequence[tuple[Array, Array]], window: int) -> float:
    """Time (s) within which no start is expected to move by more than the limit of an orbit: as long as their rates let it be, or
    that of their runs after the first window where none has moved by it; else 0.
    """
    limit, rest = LIMITS[COMPARED], [(when[window:], values[window:]) for when, values in series]
    spans = [float(np.ptp(when)) for when, _ in rest]
    rated = limit / max(max(drift(*one).bound for one in rest), 1e-300)
    if rated > max(spans):
        return rated
    kept = all(abs(float(values[-window:].mean() - values[:window].mean())) <= limit for _, values in rest)
    return min(spans) if kept else 0.0


def _comes(
    series: tuple[Array, Array], all_of: Sequence[tuple[Array, Array]], window: int, way: float, to: float
) -> bool:
    """Whether a start moves (1 up, -1 down, 0 not) to a place over Cpr, does not slow down before it by its `forecast`, and has
    come near to where another one began.
    """
    when, values = series[0][window:], series[1][window:]
    now = float(values[-window:].mean())
    began = (float(other[1][:LEAST_BLOCKS].mean()) for other in all_of if other is not series)
    if way * (to - now) <= 0.0 or min(way * (one - now) for one in began) > ALIKE or values.size < 2 * LEAST_BLOCKS:
        return False
    ends = forecast(when, values)
    return ends.high >= to - LIMITS[COMPARED] if way > 0.0 else ends.low <= to + LIMITS[COMPARED]
