"""Slow change of the cage's motion: by turns of the cage, with the error of its rate, and whether a run has settled
(docs/theory/whirl.md#when-a-run-has-settled).

Rollers creep slowly when the cage leans on them. So the spacing of the rollers and the whirl of the cage may change over tens of
seconds, long after everything fast has come to rest. A short record that looks steady proves nothing: whether it has settled is
told by the rates of change with their errors, and by the time that the creep takes.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field, replace
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.results.observables.rates import LEAST_BLOCKS, Drift, by_turns, drift, forecast
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
    ways = moving(when, means, drifts, horizon)
    if ways:
        name, scale, words = min(ways, key=lambda entry: entry[1])
        growth = next((1.0 / one for _, one, how in ways if how == GROWS), 0.0)
        left = 0.0 if growth else _left(when, means, {one[0] for one in ways}, horizon)
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


def moving(
    when: Array, means: dict[str, Array], drifts: dict[str, Drift], horizon: float
) -> list[tuple[str, float, str]]:
    """The quantities that drift by more than matters within a horizon (s): name, time scale (s), words."""
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
