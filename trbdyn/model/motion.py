"""Quantities that change in time.

Wherever a scene takes a `Quantity` it takes a number or a `History`: values at times, joined by a smooth monotone curve
(PCHIP, Fritsch and Carlson 1980) whose slope is zero at both ends, so that the quantity stays smooth where it is
constant outside its table. A history may also repeat for ever, as `History.harmonic` does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Annotated, Any, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray
from pydantic import PlainSerializer, PlainValidator

from trbdyn.base.validation import Flag, Model, Number, as_number, number_of, unit
from trbdyn.errors import InputError, Path

FloatArray = NDArray[np.float64]

MAX_TIME = 1e6
"""Latest time of anything (s): up to there times are told apart to a tenth of a nanosecond, the first steps of a
run.
"""

HARMONIC_PIECES = 24
"""Cubic pieces of a period of `History.harmonic`: a multiple of four."""

STEP_RISE = 1e-3
"""How long a step of `History.step` takes if nothing better is known (s); assumed."""

MOST_REPETITIONS = 1000
"""Most repetitions of a quantity before everything that repeats begins again together."""

SAME_PERIOD = 1e-11
"""Periods whose ratio differs by no more than this from a fraction belong together."""

KINK = 0.1
"""Jump of the second derivative, over its largest value, that ends a part of a curve whose slopes are given."""

SAME_TIME = 4e-15
"""Times that differ by this share of the largest one at most are the same."""


class History(Model):
    """A quantity given at times. Before the first and after the last time it is constant, unless it repeats.

    Parameters
    ----------
    times : sequence of float
        Times (s), ascending, at least two, from -1e6 to 1e6.
    values : sequence of float
        The quantity at each time.
    slopes : sequence of float, optional
        Its derivative in time at each time; without it the curve is monotone between two times.
    repeats : bool
        The curve repeats itself before the first and after the last time: `times` span one period.
    """

    times: tuple[Annotated[Number, unit("s")], ...]
    values: tuple[Number, ...]
    slopes: tuple[Number, ...] | None = None
    repeats: Flag = False

    def _check(self) -> None:
        if len(self.times) < 2:
            raise InputError.of("times", self.times, "must have at least two entries (s)")
        for name, given in (("values", self.values), ("slopes", self.slopes)):
            if given is not None and len(given) != len(self.times):
                raise InputError.of(name, given, f"must have one entry for each time, {len(self.times)}")
        steps = np.diff(self.times)
        if not np.all(steps > 0):
            place = int(np.argmin(steps > 0)) + 1
            raise InputError.of(("times", place), self.times[place], "must be later than the time before it (s)")
        farthest = int(np.argmax(np.abs(self.times)))
        if abs(self.times[farthest]) > MAX_TIME:
            raise InputError.of(
                ("times", farthest), self.times[farthest], f"must be from {-MAX_TIME:g} to {MAX_TIME:g} (s)"
            )
        if self.repeats:
            for name, given in (("values", self.values), ("slopes", self.slopes)):
                if given is not None and given[0] != given[-1]:
                    limit = f"must be {given[0]:g} as the first: a history that repeats ends as it begins"
                    raise InputError.of((name, len(given) - 1), given[-1], limit)
        self._check_curve(steps)

    def _check_curve(self, steps: FloatArray) -> None:
        with np.errstate(all="ignore"):
            try:
                finite = bool(np.isfinite(self._curve.c).all())
            except ValueError:  # SciPy refuses slopes that are not finite
                finite = False
            steepest = int(np.argmax(np.abs(np.diff(self.values) / steps))) + 1
        if not finite:
            raise InputError.of(
                ("values", steepest),
                self.values[steepest],
                "must be closer to the value before it: the curve overflows",
            )

    @classmethod
    def table(cls, times: Sequence[float] | FloatArray, values: Sequence[float] | FloatArray) -> Self:
        """A history through `values` at `times` (s)."""
        return cls(times=_listed("times", times), values=_listed("values", values))

    @classmethod
    def ramp(cls, start: float, end: float, before: float, after: float) -> Self:
        """A smooth change from `before` to `after` between the times `start` and `end` (s)."""
        return cls(times=(start, end), values=(before, after))

    @classmethod
    def step(cls, times: ArrayLike, values: Sequence[float] | FloatArray, *, rise: float = STEP_RISE) -> Self:
        """Steps: from each value to the next at a time, each within a short time.

        Nothing jumps in no time: a ring that jumped would meet its rollers at any speed, and its peaks would mean nothing. How
        fast a load comes or goes is a property of the machine and an assumption here, `rise`; forces in the pockets depend on it.

        Parameters
        ----------
        times : float or sequence of float
            When each step begins (s), ascending, at least `rise` apart.
        values : sequence of float
            The quantity before the first step and after each of them: one entry more than `times`.
        rise : float
            How long each step takes (s); 1 ms, if nothing better is known: about a period of a shaft's axial vibration on its
            bearings.

        Raises
        ------
        InputError
            If an argument is not allowed.

        Examples
        --------
        >>> import trbdyn as trb
        >>> drop = trb.History.step((0.1, 0.12), (3000.0, 300.0, 3000.0))
        >>> drop.times
        (0.1, 0.101, 0.12, 0.121)
        """
        begins = _listed("times", [times] if isinstance(times, int | float | np.number) else times)
        levels = _listed("values", values)
        taken = number_of("rise", rise)
        if not taken > 0.0:
            limit = "must be > 0: a load that jumps in no time would move the ring at any speed; 1e-3 is usual (s)"
            raise InputError.of("rise", rise, limit)
        if len(levels) != len(begins) + 1:
            raise InputError.of(
                ("history", "values"), values, f"must have one entry more than times, {len(begins) + 1}"
            )
        knots = [part for begin in begins for part in (begin, begin + taken)]
        between = [level for level in levels[1:-1] for _ in range(2)]
        return cls(times=tuple(knots), values=(levels[0], *between, levels[-1]))

    @classmethod
    def harmonic(
        cls, mean: float = 0.0, amplitude: float = 1.0, *, frequency_hz: float, phase_deg: float = 0.0
    ) -> Self:
        """A harmonic change without beginning and end: mean + amplitude cos(2 pi f t + phase).

        Parameters
        ----------
        mean : float
            Mean value.
        amplitude : float
            Amplitude, >= 0.
        frequency_hz : float
            Frequency f (Hz), > 0.
        phase_deg : float
            Phase (deg): 0 begins at the largest value, -90 at the mean, rising.

        Returns
        -------
        History
            One period of 24 cubic pieces, off the cosine by at most 1.3e-5 of the amplitude.

        Raises
        ------
        InputError
            If an argument is not allowed.

        Examples
        --------
        >>> import trbdyn as trb
        >>> load = trb.History.harmonic(3000.0, 500.0, frequency_hz=50.0)
        >>> float(load.value(0.0)), float(load.value(0.01))
        (3500.0, 2500.0)
        """
        found = {"mean": mean, "amplitude": amplitude, "phase_deg": phase_deg}
        for name, value in found.items():
            found[name] = number_of(name, value)
            if not math.isfinite(found[name]):
                raise InputError.of(name, value, "must be a finite number")
        if found["amplitude"] < 0.0:
            raise InputError.of("amplitude", amplitude, "must be >= 0; turn phase_deg by 180 for the opposite")
        period = 1.0 / number_of("frequency_hz", frequency_hz, "Hz", ge=1e-6, le=1e6)
        # the knots lie at the extremes and at the mean, so that the curve keeps to its amplitude exactly
        steps = np.arange(HARMONIC_PIECES + 1) / HARMONIC_PIECES
        times = (steps - math.fmod(found["phase_deg"], 360.0) / 360.0) * period
        waves = np.cos(2.0 * math.pi * steps), -np.sin(2.0 * math.pi * steps)
        quarter = HARMONIC_PIECES // 4
        for place in range(5):
            waves[0][place * quarter] = (1.0, 0.0, -1.0, 0.0, 1.0)[place]
            waves[1][place * quarter] = (0.0, -1.0, 0.0, 1.0, 0.0)[place]
        values = found["mean"] + found["amplitude"] * waves[0]
        slopes = found["amplitude"] * 2.0 * math.pi / period * waves[1]
        return cls(times=tuple(times), values=tuple(values), slopes=tuple(slopes), repeats=True)

    @property
    def period(self) -> float | None:
        """How long it takes to repeat (s); None where it does not."""
        return self.times[-1] - self.times[0] if self.repeats else None

    @cached_property
    def _curve(self) -> scipy.interpolate.CubicHermiteSpline:
        times, values = np.array(self.times), np.array(self.values)
        if self.slopes is not None:
            return scipy.interpolate.CubicHermiteSpline(times, values, np.array(self.slopes))
        if self.repeats:
            period = times[-1] - times[0]
            around = np.concatenate([times[:-1] - period, times, times[1:] + period])
            again = np.concatenate([values[:-1], values, values[1:]])
            slopes = scipy.interpolate.PchipInterpolator(around, again).derivative()(times)
            slopes[-1] = slopes[0]
        else:
            slopes = scipy.interpolate.PchipInterpolator(times, values).derivative()(times)
            slopes[0] = slopes[-1] = 0.0
        return scipy.interpolate.CubicHermiteSpline(times, values, slopes)

    @cached_property
    def extremes(self) -> tuple[float, float]:
        """Smallest and largest value that the curve takes."""
        if self.slopes is None:
            return min(self.values), max(self.values)
        turns = self._curve.derivative().roots(discontinuity=False, extrapolate=False)
        inside = self._curve(turns[np.isfinite(turns)])
        return min(*self.values, *inside), max(*self.values, *inside)

    def _inside(self, time: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Times within the table, and how many periods lie between them and the given ones."""
        given, (first, last) = np.asarray(time, dtype=np.float64), (self.times[0], self.times[-1])
        if not self.repeats:
            return np.clip(given, first, last), np.zeros_like(given)
        count = np.floor((given - first) / (last - first))
        return np.clip(given - count * (last - first), first, last), count

    def value(self, time: ArrayLike) -> FloatArray:
        """The quantity at a time or at times (s); same shape as `time`."""
        return np.asarray(self._curve(self._inside(time)[0]), dtype=np.float64)

    def slope(self, time: ArrayLike) -> FloatArray:
        """Its derivative in time at a time or at times (s); same shape as `time`."""
        slope = self._curve(self._inside(time)[0], 1)
        if not self.repeats:
            given = np.asarray(time, dtype=np.float64)
            slope = np.where((given < self.times[0]) | (given > self.times[-1]), 0.0, slope)
        return np.asarray(slope, dtype=np.float64)

    def slopes_about(self, time: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Its derivative just before and just after times (s): they differ where the history has a kink, which slopes that are
        given may leave at its first and its last time.
        """
        slope = self.slope(time)
        if self.repeats or self.slopes is None:
            return slope, slope
        off = SAME_TIME * np.max(np.abs(self.times))
        first, last = np.abs(time - self.times[0]) <= off, np.abs(time - self.times[-1]) <= off
        before, after = np.where(first, 0.0, slope), np.where(last, 0.0, slope)
        return np.where(last, self.slopes[-1], before), np.where(first, self.slopes[0], after)

    @cached_property
    def _joints(self) -> NDArray[np.bool_]:
        """Which of its knots end a part of the history: all, but for curves with given slopes.

        Those may sample something smooth, such as a wave. Of their knots those count at which the curve turns, in value or
        curvature, or has a kink: where its second derivative jumps by `KINK` of its largest value.
        """
        found = np.ones(len(self.times), dtype=bool)
        if self.slopes is None or len(self.times) < 3:
            return found
        curve, steps = self._curve, np.diff(self.times)
        before, after = curve.c[1, :-1] * 2.0 + 6.0 * curve.c[0, :-1] * steps[:-1], curve.c[1, 1:] * 2.0
        largest = max(float(np.max(np.abs(before))), float(np.max(np.abs(after))))
        found[1:-1] = np.abs(after - before) > KINK * largest
        for course in (np.array(self.slopes), np.concatenate([[math.nan], 0.5 * (before + after), [math.nan]])):
            turns = np.flatnonzero(course[:-1] * course[1:] < 0.0)
            found[np.where(np.abs(course[turns]) < np.abs(course[turns + 1]), turns, turns + 1)] = True
            found[course == 0.0] = True
        return found

    def derivative(self, time: float, order: int) -> float:
        """Its derivative of an order at a time (s); order 0: the quantity itself."""
        inside = float(self._inside(time)[0])
        return float(self._curve(inside, order)) if self.repeats or inside == time or order == 0 else 0.0

    def integral(self, start: float, end: float) -> float:
        """Its integral in time from `start` to `end` (s)."""
        first, last = self.times[0], self.times[-1]
        if self.repeats:
            whole = float(self._curve.integrate(first, last))
            (low, high), (before, after) = self._inside([start, end])
            return float(self._curve.integrate(low, high)) + (after - before) * whole
        inside = float(self._curve.integrate(min(max(start, first), last), min(max(end, first), last)))
        before = self.values[0] * (min(end, first) - min(start, first))
        after = self.values[-1] * (max(end, last) - max(start, last))
        return before + inside + after

    def knots(self, start: float, end: float, *, joints: bool = False) -> FloatArray:
        """Times of its knots after `start` and before `end` (s), ascending; with `joints` those alone that end a part of it."""
        times = np.array(self.times)
        chosen = self._joints if joints else np.ones(len(times), dtype=bool)
        if self.repeats:
            first, period = self.times[0], self.times[-1] - self.times[0]
            counts = np.arange(math.floor((start - first) / period), math.ceil((end - first) / period) + 1)
            times = (times[:-1][chosen[:-1]] + period * counts[:, None]).ravel()
        else:
            times = times[chosen]
        return times[(times > start) & (times < end)]


def _listed(name: str, values: object) -> tuple[Any, ...]:
    if isinstance(values, str | bytes) or not isinstance(values, Iterable):
        raise InputError.of(("history", name), values, "must be a sequence of numbers")
    return tuple(values)


def _as_quantity(value: object) -> float | History:
    """A number or a History, without trying one after the other, so that messages stay short."""
    if isinstance(value, History):
        return value
    if isinstance(value, Mapping):
        return History(**{str(key): entry for key, entry in value.items()})
    try:
        number = as_number(value)
    except ValueError:
        raise ValueError("must be a number or a History of times and values") from None
    if not math.isfinite(number):
        raise ValueError("must be a finite number")
    return number


def _plain(value: float | History) -> Any:
    return value.to_dict() if isinstance(value, History) else value


Quantity = Annotated[float | History, PlainValidator(_as_quantity), PlainSerializer(_plain)]


def value_at(quantity: float | History, time: float) -> float:
    """A quantity at a time (s)."""
    return float(quantity.value(time)) if isinstance(quantity, History) else quantity


def values_of(quantity: float | History) -> tuple[float, ...]:
    """Every number that a quantity is given by, with the smallest and the largest that it takes."""
    if not isinstance(quantity, History):
        return (quantity,)
    return quantity.values if quantity.slopes is None else (*quantity.values, *quantity.extremes)


def is_constant(quantity: float | History) -> bool:
    """Whether a quantity never changes."""
    return len(set(values_of(quantity))) == 1


def check_size(field: str | Path, quantity: float | History, most: float, symbol: str) -> None:
    """Refuse a quantity that is beyond a size at some time, in one direction or the other."""
    largest = max(values_of(quantity), key=abs)
    if abs(largest) > most:
        raise InputError.of(field, largest, f"must be from {-most:.4g} to {most:.4g} ({symbol})")


def settled_time(quantities: Sequence[float | History], start: float) -> float:
    """From when on nothing changes any more but what repeats (s); not before `start`."""
    return max([start, *(q.times[-1] for q in quantities if isinstance(q, History) and not q.repeats)])


def periods_of(quantities: Mapping[str, float | History]) -> dict[str, float]:
    """Periods (s) of those quantities that repeat, by their names."""
    return {name: q.period for name, q in quantities.items() if isinstance(q, History) and q.period is not None}


def common_period(periods: Mapping[str, float]) -> float | None:
    """The shortest time after which everything that repeats, by the field's name, begins again together (s); None if there is
    nothing. Refused if there is none within `MOST_REPETITIONS`.
    """
    if not periods:
        return None
    (base_name, base), *others = periods.items()
    repeated = 1
    for name, period in others:
        ratio = Fraction(period / base).limit_denominator(MOST_REPETITIONS)
        if ratio <= 0 or abs(float(ratio) * base / period - 1.0) > SAME_PERIOD:
            raise InputError.of(
                name,
                period,
                f"must repeat together with {base_name}, whose period is {base:.9g} s: no common period within "
                f"{MOST_REPETITIONS} repetitions; give one of them as a table that covers the run (s)",
            )
        repeated = math.lcm(repeated, ratio.numerator)
    if repeated > MOST_REPETITIONS:
        raise InputError.of(
            base_name,
            base,
            f"must have a common period with the others within {MOST_REPETITIONS} repetitions, not {repeated} (s)",
        )
    return repeated * base


def knot_times(quantities: Sequence[float | History], start: float = 0.0, end: float | None = None) -> FloatArray:
    """`start`, `end` and every time between them at which one of the quantities has a knot (s); ascending, shape (K,).

    Without `end`: up to the last knot of what does not repeat, and one longest period of what repeats.
    """
    if end is None:
        periods = [q.times[-1] - q.times[0] for q in quantities if isinstance(q, History) and q.repeats]
        end = settled_time(quantities, start) + max(periods, default=0.0)
    times = {start, end}
    for quantity in quantities:
        if isinstance(quantity, History):
            times.update(quantity.knots(start, end).tolist())
    return _apart(np.array(sorted(times)))


def joint_times(quantities: Sequence[float | History], start: float, end: float) -> FloatArray:
    """Times between `start` and `end` (s) at which a part of one of the quantities ends; ascending."""
    found = [q.knots(start, end, joints=True) for q in quantities if isinstance(q, History)]
    return np.unique(np.concatenate([[], *found]))


def _apart(times: FloatArray) -> FloatArray:
    """The times without those that are the same but for rounding."""
    if len(times) < 3:
        return times
    least = SAME_TIME * max(float(np.max(np.abs(times))), float(times[-1] - times[0]))
    kept = [times[0]]
    for time in times[1:-1]:
        if time - kept[-1] > least and times[-1] - time > least:
            kept.append(time)
    return np.array([*kept, times[-1]])


def knot_table(
    quantities: Sequence[float | History],
    start: float = 0.0,
    settled: float | None = None,
    period: float | None = None,
    joints: FloatArray | None = None,
) -> FloatArray:
    """Knots of a cubic Hermite curve for each of C quantities, all at the same times, as the core takes prescribed motion, shape
    (K, 2 + 2 C): time (s), value and slope of each, 1 where the curves go on smoothly, or 0.

    Two rows of the same time are a kink. The curves are those of the histories, exactly: a cubic piece split at another channel's
    knot stays the same cubic. A motion that never changes has one knot, at time 0. From `settled` on (s) nothing changes but what
    repeats; with a `period` (s) the table ends one later. At `joints` (s) a part of what happens ends, so that a step ends there,
    too; by default they are those of the quantities.
    """
    settled = settled_time(quantities, start) if settled is None else settled
    if not any(isinstance(q, History) for q in quantities):
        return np.array([[0.0, *(part for quantity in quantities for part in (quantity, 0.0)), 0.0]])
    if period is None:
        times = knot_times(quantities, start, settled) if settled > start else np.array([start])
    else:
        before = knot_times(quantities, start, settled)[:-1] if settled > start else np.empty(0)
        times = np.concatenate([before, knot_times(quantities, settled, settled + period)])
    table = np.zeros((len(times), 2 + 2 * len(quantities)))
    table[:, 0] = times
    left = np.zeros((len(times), len(quantities)))
    for channel, quantity in enumerate(quantities):
        if isinstance(quantity, History):
            table[:, 1 + 2 * channel] = quantity.value(times)
            left[:, channel], table[:, 2 + 2 * channel] = quantity.slopes_about(times)
        else:
            table[:, 1 + 2 * channel] = quantity
    joints = joint_times(quantities, start, float(times[-1])) if joints is None else joints
    table[1:-1, -1] = _not_among(times[1:-1], np.append(joints, settled))
    if period is not None:
        left[-1] = left[int(np.searchsorted(times, settled))]
        table[-1, 1:-1] = table[int(np.searchsorted(times, settled)), 1:-1]
    kinks = np.flatnonzero(np.any(left[1:-1] != table[1:-1, 2:-1:2], axis=1)) + 1
    doubled = np.insert(table, kinks, table[kinks], axis=0)
    doubled[kinks + np.arange(kinks.size), 2:-1:2] = left[kinks]
    if period is None and len(times) > 1:
        doubled[-1, 2:-1:2] = left[-1]
    return doubled


def _not_among(times: FloatArray, joints: FloatArray) -> FloatArray:
    """1 for each time that is none of the joints, but for rounding, or 0."""
    if not times.size:
        return np.zeros(0)
    place = np.searchsorted(np.sort(joints), times)
    near = np.pad(np.sort(joints), 1, constant_values=(-math.inf, math.inf))
    off = SAME_TIME * float(np.max(np.abs(times)))
    return np.asarray(np.minimum(times - near[place], near[place + 1] - times) > off, dtype=np.float64)
