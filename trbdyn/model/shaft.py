"""Turns of the shaft: how far it turns in a time, and how long it takes for a number of turns.

Whatever counts turns of the shaft outside of the core asks here; the core integrates the same cubic curves
(`csrc/motion/ring_motion.c`).
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import scipy
from numpy.typing import NDArray

from trbdyn.errors import InputError
from trbdyn.model.motion import History

Array = NDArray[np.float64]

WHOLE_PERIOD = 1e-12
"""Share of a period's turns that counts as rounding when whole periods are counted."""


def turns(speed_rpm: float | History, start: float, end: float) -> float:
    """Turns of the shaft from `start` to `end` (s), negative against positive speed."""
    if isinstance(speed_rpm, History):
        return speed_rpm.integral(start, end) / 60.0
    return speed_rpm * (end - start) / 60.0


def angle_turned(speed_rpm: float | History, start: float, end: float) -> float:
    """Angle by which the shaft turns from `start` to `end` (s), in rad."""
    if isinstance(speed_rpm, History):
        return speed_rpm.integral(start, end) * math.pi / 30.0
    return speed_rpm * math.pi / 30.0 * (end - start)


def time_to_turn(revolutions: float, speed_rpm: float | History, start: float) -> float:
    """How long the shaft takes from `start` (s) until it has turned by a number of turns > 0, one way or the other (s); refused
    if it never does.

    A shaft that turns to and fro has turned by the distance from where it was at `start`.
    """
    if not isinstance(speed_rpm, History):
        if speed_rpm == 0.0:
            raise InputError.of(("run", "revolutions"), revolutions, "the shaft is at rest; give duration (s)")
        return 60.0 * revolutions / abs(speed_rpm)
    return (_repeating if speed_rpm.repeats else _ending)(revolutions, speed_rpm, start)


def _ending(revolutions: float, speed_rpm: History, start: float) -> float:
    """For a speed that is constant after its last time."""
    last = max(speed_rpm.times[-1], start)
    marks, turned = _monotone(speed_rpm, start, last)
    found = [_reach(revolutions, sign * turned, marks, speed_rpm) for sign in (1.0, -1.0)]
    if times := [time for time in found if time is not None]:
        return min(times) - start
    final = speed_rpm.values[-1] / 60.0
    left = revolutions - math.copysign(1.0, final) * float(turned[-1])
    if final == 0.0:
        raise _never(revolutions)
    return last - start + left / abs(final)


def _repeating(revolutions: float, speed_rpm: History, start: float) -> float:
    """For a speed that repeats: in the period in which the shaft comes that far for the first time."""
    period = speed_rpm.times[-1] - speed_rpm.times[0]
    marks, turned = _monotone(speed_rpm, start, start + period)
    whole, found = float(turned[-1]), []
    for sign in (1.0, -1.0):
        ahead, farthest = sign * whole, float(np.max(sign * turned))
        before = 0.0
        if farthest < revolutions:
            if ahead <= WHOLE_PERIOD * float(np.max(np.abs(turned))):
                continue
            before = math.ceil((revolutions - farthest) / ahead - WHOLE_PERIOD)
        left = min(revolutions - before * ahead, farthest)
        time = _reach(left, sign * turned, marks, speed_rpm)
        if time is not None:
            found.append(before * period + time - start)
    if not found:
        raise _never(revolutions)
    return min(found)


def _monotone(speed_rpm: History, start: float, end: float) -> tuple[Array, Array]:
    """Times between which the shaft turns one way only (s), and the turns from `start` to each of them."""
    if end <= start:
        return np.array([start]), np.zeros(1)
    knots = np.concatenate([[start], speed_rpm.knots(start, end), [end]])
    marks = [start]
    for low, high in itertools.pairwise(knots):
        middle = 0.5 * (low + high)
        curve = scipy.interpolate.PPoly(_cubic(speed_rpm, middle)[:, None], [low - middle, high - middle])
        # a stretch at rest has no single time of rest: SciPy marks it with nan
        rests = np.unique(curve.roots(discontinuity=False, extrapolate=False))
        marks += [float(middle + rest) for rest in rests if np.isfinite(rest) and low < middle + rest < high]
        marks.append(float(high))
    return np.array(marks), np.array([turns(speed_rpm, start, mark) for mark in marks])


def _cubic(speed_rpm: History, middle: float) -> Array:
    """Coefficients of the cubic piece about a time within it (s), highest power first."""
    return np.array([speed_rpm.derivative(middle, order) / math.factorial(order) for order in (3, 2, 1, 0)])


def _reach(wanted: float, turned: Array, marks: Array, speed_rpm: History) -> float | None:
    """The first time at which the turned distance, given at marks between which it rises or falls, reaches a value."""
    for low, high, before, after in zip(marks[:-1], marks[1:], turned[:-1], turned[1:], strict=True):
        if before < wanted <= after:
            way = math.copysign(1.0, turns(speed_rpm, low, high))
            left = min(wanted - before, way * turns(speed_rpm, low, high))  # they differ by rounding
            return float(scipy.optimize.brentq(_left, low, high, args=(speed_rpm, low, way, left), xtol=1e-300))
    return None


def _left(time: float, speed_rpm: History, begin: float, way: float, wanted: float) -> float:
    return way * turns(speed_rpm, begin, time) - wanted


def _never(revolutions: float) -> InputError:
    limit = "the shaft does not turn that often; give duration (s)"
    return InputError.of(("run", "revolutions"), revolutions, limit)
