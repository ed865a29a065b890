"""Rates of change of means over turns of the cage, with their errors; and what they tell: whether a mean is known, on which side
of a limit a quantity stays, and where a drift leads (docs/theory/whirl.md#when-a-run-has-settled).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.results.observables.uncertainty import LEAST_BATCHES, half_width

Array = NDArray[np.float64]
Side = Literal["above", "below", "unknown"]

BLOCKS: Final = 12
"""Stretches of a record into which turns are gathered, at most: the error of a rate comes from their scatter about the line."""
LEAST_BLOCKS: Final = 5
SIGNIFICANT: Final = 0.00135
"""Chance by which scatter alone would show a drift: that of three standard errors, one-sided."""
BOUND: Final = 0.0228
"""Chance that a rate lies above its bound: that of two standard errors, one-sided."""
MOST_ALIKE: Final = 0.9
"""Largest correlation of a block with the one before that is taken from few of them."""
ONE_IN_20: Final = 0.05
"""Chance that the scatter of a longer record is larger than is taken."""
FACTOR: Final = 2.0
"""Factor within which a forecast tells the way and the time that are left; measured on runs that were followed."""


@dataclass(frozen=True, slots=True)
class Drift:
    """Rate of change of a quantity: slope of the least-squares line through the means of blocks of turns.

    Attributes
    ----------
    mean : float
        Mean of the quantity.
    rate : float
        Its change in a second.
    error : float
        Standard error of the rate, from the scatter of the blocks about the line.
    freedom : int
        Degrees of freedom of the error: number of blocks less two.
    memory : float
        Factor that is in the error because blocks are like those before them; 1 where they are not.
    """

    mean: float
    rate: float
    error: float
    freedom: int
    memory: float = 1.0

    @property
    def significant(self) -> bool:
        """Whether the rate stands out of the scatter."""
        return abs(self.rate) > student(SIGNIFICANT, self.freedom) * self.error

    @property
    def bound(self) -> float:
        """Largest rate, either way, that the scatter leaves likely."""
        return abs(self.rate) + student(BOUND, self.freedom) * self.error

    @property
    def likely_bound(self) -> float:
        """Largest bound that another record of this length is expected to have, of a quantity that does not drift: its rate by
        chance is up to two standard errors, and the error that few blocks tell may be too small (chi-square).
        """
        from scipy import stats

        small = math.sqrt(self.freedom / float(stats.chi2.ppf(ONE_IN_20, self.freedom)))
        return (2.0 + student(BOUND, self.freedom)) * small * self.error


@dataclass(frozen=True, slots=True)
class Forecast:
    """Where a drift leads, from its rate in the two halves of a record as an exponential approach; right within a factor of 2.

    Attributes
    ----------
    low, high : float
        Between which values it is expected to end; one is infinite where the rate does not become smaller.
    time_low, time_high : float
        After how much more time it is expected to have come there but for a twentieth of the way (s); the latter infinite where
        the rate does not become smaller.
    """

    low: float
    high: float
    time_low: float
    time_high: float


def student(chance: float, freedom: int) -> float:
    """Factor of a standard error that scatter exceeds, one-sided, with a chance (1)."""
    from scipy import stats

    return float(stats.t.isf(chance, freedom))


def by_turns(turned: ArrayLike, values: ArrayLike) -> Array:
    """Means over whole turns.

    Parameters
    ----------
    turned : array_like, shape (T,)
        Angle turned, rad.
    values : array_like, shape (T,)
        Values.

    Returns
    -------
    ndarray, shape (N,)
        Mean of each whole turn since the first record. nan for a turn without a record.
    """
    angle = np.asarray(turned, dtype=float)
    turns = np.abs(angle - angle[0]) / (2.0 * np.pi)
    whole = int(turns[-1])
    index = turns.astype(int)
    kept = index < whole
    count = np.bincount(index[kept], minlength=whole)
    with np.errstate(invalid="ignore"):
        return np.asarray(
            np.bincount(index[kept], weights=np.asarray(values, dtype=float)[kept], minlength=whole) / count
        )


def _blocks(time: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    """Means of time and quantity over blocks of turns."""
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if t.size < LEAST_BLOCKS or t.shape != x.shape:
        raise ValueError(f"needs at least {LEAST_BLOCKS} times and as many values, not shapes {t.shape} and {x.shape}")
    parts = np.array_split(np.arange(t.size), min(BLOCKS, t.size))
    return np.array([t[part].mean() for part in parts]), np.array([x[part].mean() for part in parts])


def _longer_than_blocks(left: Array) -> float:
    """Factor of a standard error where what is left of blocks remembers the block before: that of an autoregressive series of
    order one, sqrt((1 + r)/(1 - r)), with the bias of r of a short series, -(1 + 4 r)/n, taken out (Kendall 1954, Biometrika 41,
    403).
    """
    size = float(left @ left)
    if size == 0.0:
        return 1.0
    seen = float(left[1:] @ left[:-1]) / size
    r = min(max(seen + (1.0 + 4.0 * seen) / left.size, 0.0), MOST_ALIKE)
    return math.sqrt((1.0 + r) / (1.0 - r))


def drift(time: ArrayLike, values: ArrayLike) -> Drift:
    """Rate of change of a quantity, with its error.

    Parameters
    ----------
    time : array_like, shape (N,)
        Times, s: of turns of the cage, so that nothing periodic within a turn is seen.
    values : array_like, shape (N,)
        Means of the turns.

    Returns
    -------
    Drift

    Raises
    ------
    ValueError
        If there are fewer values than `LEAST_BLOCKS`.
    """
    times, means = _blocks(time, values)
    centred = times - times.mean()
    size, freedom = float(centred @ centred), len(times) - 2
    rate = float(centred @ means) / size
    left = means - means.mean() - rate * centred
    memory = _longer_than_blocks(left)
    error = memory * math.sqrt(float(left @ left) / freedom / size)
    return Drift(float(np.mean(np.asarray(values, dtype=float))), rate, error, freedom, memory)


def mean_unknown(time: ArrayLike, values: ArrayLike) -> float:
    """How far the mean of a quantity over turns may lie from the mean that a longer record gives.

    Parameters
    ----------
    time : array_like, shape (N,)
        Times of the turns, s.
    values : array_like, shape (N,)
        Means of the turns.

    Returns
    -------
    float
        The half width of `mean_error`, with all that may be slow in the values; of fewer than sixteen values two standard errors
        (Student's), with what each remembers of the one before; of values that drift these and the range of their blocks. Where
        the rate stands out of the scatter, what it changes within the record is added. In the unit of the values.

    Raises
    ------
    ValueError
        If there are fewer values than `LEAST_BLOCKS`.

    Examples
    --------
    >>> from trbdyn import observables
    >>> values = [1.01, 0.99, 1.01, 0.99, 1.01, 0.99, 1.01, 0.99]
    >>> round(observables.mean_unknown(range(8), values), 4)
    0.0092
    """
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    found = drift(t, x)
    moves = abs(found.rate) * float(np.ptp(t)) if found.significant else 0.0
    if math.isfinite(width := half_width(x)):
        return width + moves
    left = x - x.mean() - (found.rate * (t - t.mean()) if found.significant else 0.0)
    error = _longer_than_blocks(left) * math.sqrt(float(left @ left) / (x.size - 1) / x.size)
    drifts = float(np.ptp(_blocks(t, x)[1])) if x.size >= LEAST_BATCHES else 0.0
    return student(BOUND, x.size - 1) * error + max(moves, drifts)


def side_of(limit: float, time: ArrayLike, values: ArrayLike) -> Side:
    """On which side of a limit a quantity stays, as far as a record tells.

    Parameters
    ----------
    limit : float
        The limit.
    time : array_like, shape (N,)
        Times, s.
    values : array_like, shape (N,)
        Means over these times.

    Returns
    -------
    {'above', 'below', 'unknown'}
        The side on which the last half of the record ends, if no likely rate brings the quantity back to the limit within as
        much time as that half has.

    Raises
    ------
    ValueError
        If the last half has fewer values than `LEAST_BLOCKS`.

    Examples
    --------
    >>> from trbdyn import observables
    >>> [observables.side_of(0.1, range(20), [0.002 * k + start for k in range(20)]) for start in (0.08, 0.05)]
    ['above', 'unknown']
    """
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    half = slice(t.size // 2, None)
    found = drift(t[half], x[half])
    length = float(np.ptp(t[half]))
    end = found.mean + 0.5 * found.rate * length
    likely = student(BOUND, found.freedom) * found.error
    if end > limit < end + (found.rate - likely) * length:
        return "above"
    return "below" if end < limit > end + (found.rate + likely) * length else "unknown"


def forecast(time: ArrayLike, values: ArrayLike) -> Forecast:
    """Where a quantity that drifts leads, as an exponential approach by its rates in the halves of a record.

    Parameters
    ----------
    time : array_like, shape (N,)
        Times, s.
    values : array_like, shape (N,)
        Means over these times.

    Returns
    -------
    Forecast

    Raises
    ------
    ValueError
        If a half has fewer values than `LEAST_BLOCKS`.

    Examples
    --------
    >>> import numpy as np
    >>> from trbdyn import observables
    >>> t = np.linspace(0.0, 1.0, 40)
    >>> found = observables.forecast(t, 1.0 - np.exp(-t))
    >>> bool(found.low < 1.0 < found.high), bool(found.time_low < 3.0 < found.time_high)
    (True, True)
    """
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    middle = t.size // 2
    before, after = drift(t[:middle], x[:middle]), drift(t[middle:], x[middle:])
    apart = float(t[middle:].mean() - t[:middle].mean())
    end = after.mean + 0.5 * after.rate * float(np.ptp(t[middle:]))
    if not before.rate * after.rate > 0.0 or abs(after.rate) >= abs(before.rate):
        whole = drift(t, x).rate
        low, high = (end, math.inf) if whole > 0.0 else (-math.inf, end)
        return Forecast(low, high, 0.0, math.inf)
    scale = apart / math.log(before.rate / after.rate)
    # the rate now is a quarter of the record behind the middle of the last half
    left = after.rate * math.exp(-0.5 * float(np.ptp(t[middle:])) / scale) * scale
    ends = sorted((end + left / FACTOR, end + left * FACTOR))
    wait = math.log(20.0) * scale
    return Forecast(ends[0], ends[1], wait / FACTOR, wait * FACTOR)


def latest(time: ArrayLike, values: ArrayLike, part: int, least: float = 0.0) -> tuple[Drift, Drift, float]:
    """Rate of a quantity in the latest part of a record in which it moves, and in the part before.

    Parameters
    ----------
    time : array_like, shape (N,)
        Times, s.
    values : array_like, shape (N,)
        Means over these times.
    part : int
        Number of values of the shortest part. It is doubled until the rate stands out of the scatter and the way in the part is
        more than the least one, or half of the record is reached.
    least : float
        Least way, in the unit of the values.

    Returns
    -------
    now, before : Drift
        Of the latest part, and of one as long before it.
    apart : float
        Time between the beginnings of both parts, s.

    Raises
    ------
    ValueError
        If half of the record has fewer values than `LEAST_BLOCKS`.

    Examples
    --------
    >>> import numpy as np
    >>> from trbdyn import observables
    >>> t = np.linspace(0.0, 1.0, 81)
    >>> now, before, apart = observables.latest(t, np.where(t < 0.5, t, 3.0 * t - 1.0), 40)
    >>> round(now.rate, 1), round(before.rate, 1), round(apart, 1)
    (3.0, 1.0, 0.5)
    """
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    most = t.size // 2
    size = min(part, most)
    while True:
        now, apart = drift(t[-size:], x[-size:]), float(t[-size] - t[-2 * size])
        if size == most or (now.significant and abs(now.rate) * apart > least):
            return now, drift(t[-2 * size : -size], x[-2 * size : -size]), apart
        size = min(2 * size, most)


def time_left(way: float, now: Drift, before: Drift, apart: float) -> tuple[float, float]:
    """Time that a way is expected to take, from its rate and the rate a while before.

    A motion of slow rollers speeds up as their spacing grows, and slows down where it comes to rest. So the time lies between
    that of a constant rate, and that of a rate which goes on changing by the same factor in the same time (`FACTOR` either way).

    Parameters
    ----------
    way : float
        Way that is left, in the direction of the rate now, in the unit of the quantity.
    now, before : Drift
        Rates, as `latest` gives them.
    apart : float
        Time between the two, s.

    Returns
    -------
    tuple of float
        Shortest and longest time, s; the longest is infinite where the rate becomes so much smaller that the way has no end.

    Examples
    --------
    >>> from trbdyn import observables
    >>> steady = observables.Drift(mean=0.5, rate=0.1, error=0.01, freedom=10)
    >>> [round(one, 3) for one in observables.time_left(0.4, steady, steady, 1.0)]
    [2.0, 8.0]
    """
    rate, first = abs(now.rate), before.rate * math.copysign(1.0, now.rate)
    constant = way / rate
    if first <= 0.0:  # it has only begun to move
        return constant / FACTOR**2, constant * FACTOR
    growth = math.log(rate / first) / apart
    ahead = growth * constant
    changing = constant if abs(ahead) < 1e-9 else math.log1p(ahead) / growth if ahead > -1.0 else math.inf
    return min(constant, changing) / FACTOR, max(constant, changing) * FACTOR
