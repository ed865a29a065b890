"""Slow change of the cage's motion: by turns of the cage, with the error of its rate, and whether a run has settled
(docs/theory/whirl.md#when-a-run-has-settled).

Rollers creep slowly when the cage leans on them. So the spacing of the rollers and the whirl of the cage may change over tens of
seconds, long after everything fast has come to rest. A short record that looks steady proves nothing: whether it has settled is
told by the rates of change with their errors, and by the time that the creep takes.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.results.observables.rates import FACTOR, LEAST_BLOCKS, Drift, by_turns, drift, forecast, mean_unknown
from trbdyn.results.observables.signals import settling

Array = NDArray[np.float64]
Answer = Literal["settled", "drifting", "unknown"]

LEAST_TURNS: Final = 10
"""Turns of the cage after the transient from which a motion can be called settled."""
STANDSTILL: Final = 1e-6
"""Turns of the cage up to which it stands: no length of a run can be told from them."""
CREEP_TIMES: Final = 3.0
"""Length after the transient, in times of the creep, from which a motion can be called settled."""
LEAST_GROWTH: Final = 0.1
"""Growth (ln of the whirl amplitude) over the record after the transient from which a whirl counts as growing."""
GROWS: Final = "grows"
KNOWN_TURNS: Final = 24
"""Turns after the transient from which the scatter is known well enough for a longest length."""
SHORT_MEMORY: Final = 1.1
"""Factor of the error by the memory of blocks up to which a length is told from their scatter."""
LIMITS: Final = {"whirl amplitude": 0.05, "orbit radius": 0.05, "roller spacing": 0.1}
"""Changes that matter, in units of Cpr, Cpr and the angle Cpc/(Dpw/2)."""


@dataclass(frozen=True, slots=True)
class MotionSettling:
    """Whether the motion of rollers and cage has settled.

    Attributes
    ----------
    answer : {"settled", "drifting", "unknown"}
        Settled: the record after the transient is long against the creep of the rollers, and no quantity drifts. Drifting: a
        quantity changes beyond its scatter. Unknown: neither can be told from this record.
    index : int
        First record after the transient; the middle of the record at the latest.
    time : float
        Its time, s.
    time_scale : float
        Drifting: time in which the quantity that drifts fastest would change by its own size, s; else nan.
    reason : str
        Why, in words.
    creep_time : float
        Time that the creep of the rollers needs to change the cage's whirl, s; nan where it is not known.
    drifts : dict of str to Drift
        The rates, by the names of `LIMITS`; empty for records that are too short.
    needed : float
        Shortest length of a record that is expected to tell whether the motion has settled, s; nan where it is told already or
        no length is known. Unknown: ten turns of the cage and three times of the creep after the transient, and so long that the
        rates are known well enough. Drifting: until the rate is expected to matter no more (`forecast`).
    needed_high : float
        Longest length that is expected to be needed, s, in 95 of 100 records; nan where none is known: in records that are too
        short to show scatter, of scatter as slow as the blocks of the record, and while it drifts.
    growth_rate : float
        Rate of an exponential growth of the whirl, 1/s; 0 where it does not grow so. It does not tell what a whirl grows to.
    """

    answer: Answer
    index: int
    time: float
    time_scale: float
    reason: str
    creep_time: float
    drifts: dict[str, Drift] = field(default_factory=dict)
    needed: float = math.nan
    growth_rate: float = 0.0
    needed_high: float = math.nan

    @property
    def settled(self) -> bool:
        """Whether the answer is "settled"."""
        return self.answer == "settled"

    def __str__(self) -> str:
        return {"settled": "yes", "drifting": "no, it drifts: ", "unknown": "cannot be told: "}[
            self.answer
        ] + self.reason


def whirl_amplitude(
    time: ArrayLike, position: ArrayLike, cage_angle: ArrayLike
) -> tuple[Array, NDArray[np.complex128]]:
    """Complex amplitude of the whirl at the cage's frequency, by turns of the cage.

    A whirl at the cage's frequency stands still in the cage's frame. So its amplitude is the mean, over a turn of the cage, of
    the centre's place in that frame; a cage that merely hangs aside, or circles faster, has none.

    Parameters
    ----------
    time : array_like, shape (T,)
        Times, s.
    position : array_like, shape (T, 2) or (T, 3)
        Place of the cage's centre, m.
    cage_angle : array_like, shape (T,)
        Turn of the cage, rad.

    Returns
    -------
    time : ndarray, shape (N,)
        Mean time of each whole turn, s.
    amplitude : ndarray of complex, shape (N,)
        Mean place in the cage's frame, x + i y, in the unit of the position.
    """
    place, angle = np.asarray(position, dtype=float), np.asarray(cage_angle, dtype=float)
    fixed = (place[:, 0] + 1j * place[:, 1]) * np.exp(-1j * (angle - angle[0]))
    return by_turns(angle, time), by_turns(angle, fixed.real) + 1j * by_turns(angle, fixed.imag)


def turn_means(
    time: ArrayLike,
    roller_angle: ArrayLike,
    spacing: ArrayLike,
    position: ArrayLike | None = None,
    cage_angle: ArrayLike | None = None,
) -> tuple[Array, dict[str, Array]]:
    """Means over whole turns of the quantities by which the motion is judged, by the names of `LIMITS`; with the times of the
    turns, s, shape (N,). Arguments as in `motion_settling`.
    """
    t, turned = np.asarray(time, dtype=float), np.asarray(roller_angle, dtype=float)
    when = by_turns(turned, t)
    means = {"roller spacing": by_turns(turned, np.asarray(spacing, dtype=float))}
    if position is not None and cage_angle is not None:
        centre = np.asarray(position, dtype=float)
        x, y = by_turns(turned, centre[:, 0]), by_turns(turned, centre[:, 1])
        square = by_turns(turned, centre[:, 0] ** 2 + centre[:, 1] ** 2)
        means["orbit radius"] = np.sqrt(np.maximum(square - x**2 - y**2, 0.0))
        means["whirl amplitude"] = np.abs(whirl_amplitude(t, centre, cage_angle)[1])
    count = min(when.size, *map(len, means.values()))  # rollers and cage may end in different turns
    return when[:count], {name: values[:count] for name, values in means.items()}


def motion_settling(
    time: ArrayLike,
    roller_angle: ArrayLike,
    spacing: ArrayLike,
    position: ArrayLike | None = None,
    cage_angle: ArrayLike | None = None,
    creep_time: float = math.nan,
) -> MotionSettling:
    """Whether the motion of rollers and cage has settled: settled, drifting, or not to be told from this record.

    The transient is cut off by the marginal standard error rule (`settling`) over turns of the roller set. For the rest, the
    rates of change of the whirl amplitude, the orbit radius and the spacing are taken from means over turns. It drifts if a rate
    stands out of its scatter and changes the quantity by more than its limit (`LIMITS`) within the record or three times of
    the creep, or if the whirl grows exponentially. It has settled if it does not drift, the record after the transient holds
    ten turns and three times of the creep, and no rate that the scatter leaves likely would change a quantity by more than twice
    its limit within this record. Else it cannot be told.

    Parameters
    ----------
    time : array_like, shape (T,)
        Increasing times, s.
    roller_angle : array_like, shape (T,)
        Mean angle by which the rollers have turned around the bearing, rad.
    spacing : array_like, shape (T,)
        Standard deviation of the rollers' spacing in units of the angle Cpc/(Dpw/2).
    position : array_like, shape (T, 2) or (T, 3), optional
        Place of the cage's centre in units of Cpr; without a cage None.
    cage_angle : array_like, shape (T,), optional
        Turn of the cage, rad.
    creep_time : float
        Time that the creep of the rollers needs to change the cage's whirl, s; nan: not known.

    Returns
    -------
    MotionSettling

    Examples
    --------
    >>> import numpy as np
    >>> from trbdyn import observables
    >>> t = np.linspace(0.0, 1.0, 2001)
    >>> found = observables.motion_settling(t, 130.0 * t, 0.1 + 0.2 * t, creep_time=4.0)
    >>> found.answer, round(found.time_scale, 1)
    ('drifting', 1.2)
    """
    t, turned = np.asarray(time, dtype=float), np.asarray(roller_angle, dtype=float)
    spread = np.asarray(spacing, dtype=float)
    turns = float(abs(turned[-1] - turned[0])) / (2.0 * np.pi) if t.size else 0.0
    middle = max(min(t.size // 2, t.size - 2), 0)  # averages need two records
    length = float(t[-1] - t[0]) if t.size else 0.0
    after = max(
        LEAST_TURNS * length / turns if turns > STANDSTILL else math.nan, CREEP_TIMES * np.nan_to_num(creep_time)
    )
    if turns < 4.0:
        reason, needed = f"only {turns:.2g} turns of the cage", length + after
        return MotionSettling("unknown", middle, float(t[middle]), math.nan, reason, creep_time, needed=needed)
    first = float(t[0])
    signals = {"roller spacing": spread}
    centre = None if position is None else np.asarray(position, dtype=float)
    if centre is not None:
        signals["orbit radius"] = np.hypot(centre[:, 0] - centre[:, 0].mean(), centre[:, 1] - centre[:, 1].mean())
    found = settling(t, np.column_stack(list(signals.values())), min(int(turns), 50))
    rest = slice(found.index, None)
    angle = None if cage_angle is None else np.asarray(cage_angle, dtype=float)[rest]
    when, means = turn_means(t[rest], turned[rest], spread[rest], None if centre is None else centre[rest], angle)
    count = when.size
    length = float(t[-1] - found.time)

    def result(
        answer: Answer,
        reason: str,
        scale: float = math.nan,
        drifts: dict[str, Drift] | None = None,
        needed: float = found.time - first + after,
    ) -> MotionSettling:
        rates = drifts or {}
        high = math.nan
        if (
            answer == "unknown"
            and when.size >= KNOWN_TURNS
            and all(one.memory < SHORT_MEMORY for one in rates.values())
        ):
            # what rates may add up to goes down with the square root of the length; half may be cut off as a transient
            shares = (_share(name, one.likely_bound, length) for name, one in rates.items())
            high = max(needed, 2.0 * after, found.time - first + length * max(shares, default=0.0) ** 2)
        return MotionSettling(
            answer, found.index, found.time, scale, reason, creep_time, rates, needed, needed_high=high
        )

    if count < LEAST_BLOCKS or not all(np.isfinite(values).all() for values in means.values()):
        return result(
            "unknown", f"only {when.size} turns of the cage after the transient, or too few records in a turn"
        )
    drifts = {name: drift(when, values) for name, values in means.items()}
    horizon = length if math.isnan(creep_time) else max(length, CREEP_TIMES * creep_time)
    moving = _moving(when, means, drifts, horizon)
    if moving:
        name, scale, words = min(moving, key=lambda entry: entry[1])
        growth = next((1.0 / one for _, one, how in moving if how == GROWS), 0.0)
        left = 0.0 if growth else _left(when, means, {one[0] for one in moving}, horizon)
        still = float(t[-1]) - first + min(left, CREEP_TIMES * scale)
        drifting = result("drifting", f"the {name} {words}, time scale {scale:.2g} s", scale, drifts, still)
        return replace(drifting, growth_rate=growth)
    if not math.isnan(creep_time) and length < CREEP_TIMES * creep_time:
        return result(
            "unknown",
            f"the rollers creep within {creep_time:.2g} s, and this takes {CREEP_TIMES:.0f} times as long; "
            f"after the transient there are {length:.2g} s",
            drifts=drifts,
        )
    if when.size < LEAST_TURNS:
        return result("unknown", f"only {when.size} turns of the cage after the transient", drifts=drifts)
    for name, rate in drifts.items():
        if _share(name, rate.bound, length) > 1.0:
            unit = "Cpc" if name == "roller spacing" else "Cpr"
            size = f"its rate is {rate.rate:.2g} with an error of {rate.error:.1g} {unit} in a second"
            memory = "" if rate.memory < SHORT_MEMORY else "; its scatter is as slow as a twelfth of the record"
            needed = float(t[-1]) - first
            return result("unknown", f"the {name} scatters too much: {size}{memory}", drifts=drifts, needed=needed)
    return result("settled", "", drifts=drifts, needed=math.nan)


def _left(when: Array, means: dict[str, Array], names: Collection[str], horizon: float) -> float:
    """After how much more time (s), at least, drifts are expected to have become small enough to matter no more within a horizon
    (s), each as an exponential approach; 0 where rates do not become smaller, or turns are few.
    """
    left, half = 0.0, when.size // 2
    for name in names if half >= LEAST_BLOCKS else ():
        values = means[name]
        ratio = abs(drift(when[half:], values[half:]).rate) * horizon / LIMITS[name]
        scale = forecast(when, values).time_low / math.log(20.0)
        left = max(left, scale * math.log(max(ratio, 1.0)))
    return left


def _share(name: str, rate: float, length: float) -> float:
    """What a rate changes in a time (s), over twice the limit of the quantity (1)."""
    return rate * length / (2.0 * LIMITS[name])


def _moving(
    when: Array, means: dict[str, Array], drifts: dict[str, Drift], horizon: float
) -> list[tuple[str, float, str]]:
    """The quantities that drift: name, time scale (s), words."""
    found: list[tuple[str, float, str]] = []
    for name, rate in drifts.items():
        if rate.significant and abs(rate.rate) * horizon > LIMITS[name]:
            scale = max(abs(rate.mean), LIMITS[name]) / abs(rate.rate)
            found.append((name, scale, "increases" if rate.rate > 0.0 else "decreases"))
    if "whirl amplitude" in means:
        size = means["whirl amplitude"]
        log = drift(when, np.log(np.maximum(size, 1e-9)))
        grown = log.rate * float(when[-1] - when[0])
        if log.significant and grown > LEAST_GROWTH and _matters(float(size[-1]), log.rate, horizon):
            found.append(("whirl amplitude", 1.0 / log.rate, GROWS))
    return found


def _matters(size: float, rate: float, horizon: float) -> bool:
    """Whether growth at this rate goes beyond its limit within the horizon."""
    return bool(size * math.expm1(min(rate * horizon, 100.0)) > LIMITS["whirl amplitude"])


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
"""Way of a start within what is judged from which on a direction is told, in units of Cpr."""
SLOW: Final = 250.0
"""Turns of the cage within which the rollers creep from which on starts are not expected to agree: the start decides."""
NO_WHIRL: Final = frozenset({"stable", "rocking"})
"""Classes of a cage that does not circle: a cage that hangs still and one that rocks by as much as the limit are one motion."""


@dataclass(frozen=True, slots=True)
class Compared:
    """What runs from several starts, side by side, tell of the motion in the long run.

    Attributes
    ----------
    verdict : {"agreed", "alike", "grows", "dies", "meets", "two motions", "start decides", "unknown"}
        Agreed: all starts have come to the same motion, or the one between and another have, and the third moves towards it and
        is near to where the one between began. Alike: their motion is of one class, but their orbits differ by more, or wander.
        Grows, dies: they have not, and the start between the two others moves towards the larger or the smaller one, or it is
        there already and the other follows. Meets: a larger one moves down and a smaller one up. Two motions: the outer ones have
        settled apart, and the start between them has gone to one of them; or a smaller one moves down and a larger one up. Start
        decides: the rollers creep within more than `SLOW` turns, and each start keeps its own motion for a time that is told.
        Unknown: none of these.
    orbit : float
        Agreed, alike: the orbit of the cage, mean of the starts. Grows, dies: that of the start towards which it moves. Meets:
        between these two. Over Cpr.
    error : float
        Largest difference of a start from it, or half of the way that is left (Cpr).
    rate : float
        Rate of the start that shows the direction, Cpr in a second (meets: of the distance; agreed: of the start that has not
        come there yet); nan where there is none.
    rate_error : float
        Its standard error.
    time_low, time_high : float
        Grows, dies, meets: how much longer the way is expected to take, s. Start decides: `time_low` is the time within which no
        start is expected to move by more than the limit of an orbit, or has not moved by it.
    reason : str
        Unknown: why.
    ends : tuple of float
        Orbits of the outer starts in their last window, from rest and from a large whirl, over Cpr.
    open : tuple of int
        Starts whose longer runs may tell more: 0 from rest, 1 from a large whirl, 2 the one between. Where a direction is told,
        one that stands and one that follows behind are not among them.
    """

    verdict: Literal["agreed", "alike", "grows", "dies", "meets", "two motions", "start decides", "unknown"]
    orbit: float
    error: float
    rate: float = math.nan
    rate_error: float = math.nan
    time_low: float = math.nan
    time_high: float = math.nan
    reason: str = ""
    ends: tuple[float, float] = (math.nan, math.nan)
    open: tuple[int, ...] = (0, 1, 2)


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
    outer: tuple[tuple[Array, Array], tuple[Array, Array]],
    between: tuple[Array, Array] | None = None,
    *,
    window: int,
    creep_turns: float = math.nan,
    kinds: Sequence[str] = (),
) -> Compared:
    """What runs from a quiet start, from a large whirl and, where these do not agree, from one between tell.

    Parameters
    ----------
    outer : pair of pairs of arrays
        Times (s) and orbit radius over Cpr by turns of the cage: of the run from rest and of the one from a large whirl.
    between : pair of arrays, optional
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
    >>> found = observables.compare_starts(((turns, 0 * turns + 0.1), (turns, 0.1 + 0.8 * np.exp(-turns / 5))), window=20)
    >>> found.verdict, round(found.orbit, 2)
    ('agreed', 0.1)
    """
    limit, size = LIMITS[COMPARED], min(values.size for _, values in outer)
    series, of_outer = [*outer, *([] if between is None else [between])], kinds[:2]
    ends = (float(outer[0][1][-window:].mean()), float(outer[1][1][-window:].mean()))
    middle, apart = 0.5 * sum(ends), abs(ends[1] - ends[0])
    alike: Compared | None = None
    unknown = [math.inf, math.inf]
    for length in dict.fromkeys((window, max(window, size // 2))):
        means = [float(values[-length:].mean()) for _, values in outer]
        unknown = [mean_unknown(when[-length:], values[-length:]) for when, values in outer]
        error = 0.5 * abs(means[1] - means[0]) + max(unknown)
        if agree(means, unknown, of_outer):
            return Compared("agreed", 0.5 * sum(means), error, ends=(means[0], means[1]))
        differ = abs(means[1] - means[0])
        long_enough = size >= max(2 * window, CREEP_TIMES * np.nan_to_num(creep_turns) if differ > WANDERS else 0.0)
        if differ <= ALIKE and all(one <= WANDERS for one in unknown) and long_enough and of_outer and _similar(kinds):
            alike = Compared("alike", 0.5 * sum(means), error, ends=(means[0], means[1]))
    if alike is not None:
        return alike
    creeps = "" if math.isnan(creep_turns) else f"; the rollers creep within {creep_turns:.3g} turns of the cage"
    classes = "" if len(set(of_outer)) <= 1 else f"; one of them is {', the other '.join(sorted(set(of_outer)))}"
    said = f"from rest the orbit is {ends[0]:.2f} Cpr, from a large whirl {ends[1]:.2f} Cpr{classes}"
    if between is None or between[1].size < 2 * window or size < 2 * window:
        if size >= 2 * window and (keeps := _keeps(outer, window)) and creep_turns > SLOW and apart > limit:
            return Compared("start decides", middle, 0.5 * apart, time_low=keeps, ends=ends)
        return Compared("unknown", middle, 0.5 * apart, reason=f"{said}{creeps}", ends=ends)
    rates = [drift(when[window:], values[window:]) for when, values in series]
    moves = [_moves(when[window:], values[window:]) for when, values in series]
    now = float(between[1][-window:].mean())
    places = (*ends, now)
    near_end = min(ends, key=lambda end: abs(now - end))
    gone = abs(now - near_end) <= limit < apart
    for k, last in ((0, 1), (1, 0)):
        known = [mean_unknown(series[one][0][-window:], series[one][1][-window:]) for one in (k, 2)]
        classes_of = [kinds[one] for one in (k, 2)] if len(kinds) == len(series) else []
        stand = not any(_moves(*(part[-window:] for part in series[one])) for one in (k, 2))
        if (
            stand
            and agree([places[k], now], known, classes_of)
            and _comes(series[last], between, window, moves[last], places[k])
        ):
            orbit, rate = 0.5 * (places[k] + now), rates[last]
            return Compared("agreed", orbit, 0.5 * abs(places[k] - now) + max(known), rate.rate, rate.error, ends=ends)
    if gone and moves[0] == moves[1] == 0.0 and size >= CREEP_TIMES * creep_turns and apart > limit + sum(unknown):
        return Compared("two motions", near_end, 0.5 * apart, rates[2].rate, rates[2].error, ends=ends)

    def towards(
        verdict: Literal["grows", "dies", "meets"],
        to: float,
        way: float,
        rate: float,
        error: float,
        goes_on: Collection[int] = (0, 1, 2),
    ) -> Compared:
        # between a constant rate and an exponential approach that ends within the limit
        left = max(way, limit) / abs(rate) * math.sqrt(max(math.log(max(way, limit) / limit), 1.0))
        goes = tuple(k for k in goes_on if moves[k] or k == 2 or unknown[k] > limit)
        return Compared(verdict, to, 0.5 * way, rate, error, left / FACTOR, left * FACTOR, ends=ends, open=goes)

    ups, downs = ([k for k in range(3) if moves[k] == way] for way in (1.0, -1.0))
    if ups and downs:
        low, high = max(ups, key=lambda k: places[k]), min(downs, key=lambda k: places[k])
        one, other, way = rates[low], rates[high], places[high] - places[low]
        if way > 0.0:
            error = math.hypot(one.error, other.error)
            pair = (low, high) if 2 in (low, high) else (0, 1)
            return towards("meets", 0.5 * (places[low] + places[high]), way, other.rate - one.rate, error, pair)
        first = [float(values[window : 2 * window].mean()) for _, values in series]
        if max(first[k] for k in downs) < min(first[k] for k in ups):
            # what was smaller shrinks and what was larger grows: a motion that nothing keeps lies between
            return Compared("two motions", near_end, 0.5 * apart, rates[2].rate, rates[2].error, ends=ends)
    if (ups or downs) and not (ups and downs):
        to = max(places) if ups else min(places)
        # one that moves alone tells a direction only where the start between moves, too, or has gone to the other side
        if moves[2]:
            end = 1 if ups else 0
            goes_on = (end, 2) if places[end] == to else (0, 1, 2)
            return towards("grows" if ups else "dies", to, abs(to - now), rates[2].rate, rates[2].error, goes_on)
        if gone and (alone := [k for k in (0, 1) if moves[k] and abs(places[k] - now) > limit]):
            one, place = rates[alone[0]], places[alone[0]]
            return towards("grows" if ups else "dies", to, abs(to - place), one.rate, one.error, alone)
    if creep_turns > SLOW and apart > limit and (keeps := _keeps(series, window)):
        return Compared("start decides", middle, 0.5 * apart, time_low=keeps, ends=ends)
    how = f"a start between them moves by {rates[2].rate:+.2g} with an error of {rates[2].error:.1g} Cpr in a second"
    reason = f"{said}, and {how}{creeps}"
    return Compared("unknown", middle, 0.5 * apart, rates[2].rate, rates[2].error, reason=reason, ends=ends)


def _moves(when: Array, values: Array) -> float:
    """Whether a start moves: 1 up, -1 down, 0 not."""
    rate = drift(when, values)
    return math.copysign(1.0, rate.rate) if rate.significant and abs(rate.rate) * float(np.ptp(when)) > MOVED else 0.0


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


def _comes(series: tuple[Array, Array], between: tuple[Array, Array], window: int, way: float, to: float) -> bool:
    """Whether a start moves (1 up, -1 down, 0 not) to a place over Cpr, does not slow down before it by its `forecast`, and has
    come near to where another one began that has gone there.
    """
    when, values = series[0][window:], series[1][window:]
    now, began = float(values[-window:].mean()), float(between[1][:LEAST_BLOCKS].mean())
    if way * (to - now) <= 0.0 or way * (began - now) > ALIKE or values.size < 2 * LEAST_BLOCKS:
        return False
    ends = forecast(when, values)
    return ends.high >= to - LIMITS[COMPARED] if way > 0.0 else ends.low <= to + LIMITS[COMPARED]
