"""Quantities that change in time.

Wherever a scene takes a `Quantity` it takes a number or a `History`: values at times, joined by a smooth monotone curve
(PCHIP, Fritsch and Carlson 1980) whose slope is zero at both ends, so that the quantity stays smooth where it is
constant outside its table.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import model_validator
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from trbdyn.errors import InputError
from trbdyn.validation import Model, Number, as_number, unit

FloatArray = NDArray[np.float64]

MAX_TIME = 1e6
"""Latest time of anything (s): up to there times are told apart to a tenth of a nanosecond, the first steps of a run."""


class History(Model):
    """A quantity given at times; constant before the first and after the last.

    Parameters
    ----------
    times : sequence of float
        Times (s), ascending, at least two, from -1e6 to 1e6.
    values : sequence of float
        The quantity at each time.
    """

    times: tuple[Annotated[Number, unit("s")], ...]
    values: tuple[Number, ...]

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.times) < 2:
            raise InputError.of("times", self.times, "must have at least two entries (s)")
        if len(self.values) != len(self.times):
            raise InputError.of("values", self.values, f"must have one entry a time: {len(self.times)}")
        steps = np.diff(self.times)
        if not np.all(steps > 0):
            place = int(np.argmin(steps > 0)) + 1
            raise InputError.of(("times", place), self.times[place], "must be later than the time before it (s)")
        farthest = int(np.argmax(np.abs(self.times)))
        if abs(self.times[farthest]) > MAX_TIME:
            raise InputError.of(
                ("times", farthest), self.times[farthest], f"must be from {-MAX_TIME:g} to {MAX_TIME:g} (s)"
            )
        self._check_curve(steps)
        return self

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

    @cached_property
    def _curve(self) -> CubicHermiteSpline:
        times, values = np.array(self.times), np.array(self.values)
        slopes = PchipInterpolator(times, values).derivative()(times)
        slopes[0] = slopes[-1] = 0.0
        return CubicHermiteSpline(times, values, slopes)

    def value(self, time: ArrayLike) -> FloatArray:
        """The quantity at a time or at times (s); same shape as `time`."""
        return np.asarray(self._curve(np.clip(time, self.times[0], self.times[-1])), dtype=np.float64)

    def slope(self, time: ArrayLike) -> FloatArray:
        """Its derivative in time at a time or at times (s); same shape as `time`."""
        inside = np.clip(time, self.times[0], self.times[-1])
        return np.asarray(self._curve(inside, 1), dtype=np.float64)

    def integral(self, start: float, end: float) -> float:
        """Its integral in time from `start` to `end` (s)."""
        first, last = self.times[0], self.times[-1]
        inside = float(self._curve.integrate(min(max(start, first), last), min(max(end, first), last)))
        before = self.values[0] * (min(end, first) - min(start, first))
        after = self.values[-1] * (max(end, last) - max(start, last))
        return before + inside + after


def _listed(name: str, values: object) -> tuple[Any, ...]:
    if isinstance(values, str | bytes) or not isinstance(values, Iterable):
        raise InputError.of(("history", name), values, "must be a sequence of numbers")
    return tuple(values)


def _as_quantity(value: object) -> float | History:
    if isinstance(value, History):
        return value
    if isinstance(value, Mapping):
        return History(**{str(key): entry for key, entry in value.items()})
    try:
        return as_number(value)
    except ValueError:
        raise ValueError("must be a number or a History of times and values") from None


def _finite(value: float | History) -> float | History:
    if isinstance(value, float) and not np.isfinite(value):
        raise ValueError("must be a finite number")
    return value


class _QuantitySchema:
    """Tells pydantic to take a number or a History without trying one after the other, so that messages stay short."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(
            lambda value: _finite(_as_quantity(value)),
            serialization=core_schema.plain_serializer_function_ser_schema(_plain, when_used="always"),
        )


def _plain(value: float | History) -> object:
    return value.to_dict() if isinstance(value, History) else value


Quantity = Annotated[float | History, _QuantitySchema]


def value_at(quantity: float | History, time: float) -> float:
    """A quantity at a time (s)."""
    return float(quantity.value(time)) if isinstance(quantity, History) else quantity


def values_of(quantity: float | History) -> tuple[float, ...]:
    """Every number that a quantity is given by; a history stays between the smallest and the largest of them."""
    return quantity.values if isinstance(quantity, History) else (quantity,)


def is_constant(quantity: float | History) -> bool:
    """Whether a quantity never changes."""
    return len(set(values_of(quantity))) == 1


def knot_times(quantities: Sequence[float | History], start: float = 0.0) -> FloatArray:
    """Every time at which one of the quantities has a knot, and `start` (s); ascending, shape (K,)."""
    times = {start}
    for quantity in quantities:
        if isinstance(quantity, History):
            times.update(quantity.times)
    return np.array(sorted(times))


def knot_table(quantities: Sequence[float | History]) -> FloatArray:
    """Knots of a cubic Hermite curve for each quantity, all at the same times: as the core takes prescribed motion.

    Parameters
    ----------
    quantities : sequence of float or History, length C
        A channel each.

    Returns
    -------
    ndarray, shape (K, 1 + 2 C)
        Time (s), then value and slope of each channel. The curves are those of the histories, exactly: a cubic piece
        split at another channel's knot stays the same cubic.
    """
    times = knot_times(quantities) if any(isinstance(q, History) for q in quantities) else np.zeros(1)
    table = np.zeros((len(times), 1 + 2 * len(quantities)))
    table[:, 0] = times
    for channel, quantity in enumerate(quantities):
        if isinstance(quantity, History):
            table[:, 1 + 2 * channel] = quantity.value(times)
            table[:, 2 + 2 * channel] = quantity.slope(times)
        else:
            table[:, 1 + 2 * channel] = quantity
    return table
