"""How well a mean over a run is known: from its values in batches, with all time scales of the motion that they leave possible
(docs/theory/whirl.md#how-well-a-mean-is-known).

The cosine transform of the values shows their spectrum at half a wave, one wave, ... in the record; the error of the mean is
told by the spectrum at frequency zero. That is taken as a constant and a slow part (an Ornstein-Uhlenbeck process) of unknown
size and time scale: a grid of them is weighed by how likely each makes the cosines seen (Bayes, with `NOTHING_SLOW` as the
chance beforehand that there is none). It is the method of Müller and Watson (Econometrica 86 (2018) 775-804) with an explicit
prior; with nothing slow in sight it is about Student's t.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

WINDOW: Final = 5.0
"""Length of the sum of the autocorrelation, in correlation times."""
LEAST_BATCHES: Final = 16
"""Batches below which no error is given."""
MOST_COSINES: Final = 24
"""Cosines that are looked at, at most; at most half as many as there are batches."""
TIME_SCALES: Final = tuple(np.geomspace(0.02, 4.0, 10))
"""Time scales of the slow part that are thought possible, over the length of the record."""
SIZES: Final = (1.0, 4.0, 16.0, 64.0, 256.0, 1e4)
"""Spectrum of the slow part at frequency zero over the constant part."""
NOTHING_SLOW: Final = 0.7
"""Chance, before anything is seen, that there is no slow part."""
SLOW: Final = 0.4
"""Time scale over the length of the record from which a slow part is a drift: its mean cannot be told."""
DRIFTS: Final = 0.4
"""Chance of a drift, after all is seen, from which no interval is given."""
CONFIDENCE: Final = 0.95


def correlation_time(time: ArrayLike, values: ArrayLike) -> float:
    """Time over which a signal remembers itself: integral of its normalised autocorrelation over positive and negative delays.

    The sum ends where it is lost in its own noise (Sokal, Monte Carlo Methods in Statistical Mechanics, 1996: the smallest window
    that is five times the correlation time). What is slower than a small part of the record is not seen.

    Parameters
    ----------
    time : array_like, shape (T,)
        Increasing times at equal distances, s.
    values : array_like, shape (T,)
        The signal.

    Returns
    -------
    float
        Seconds, one record's distance at least: a mean over the time T is as good as that of T over this time independent
        values. A signal that does not change has that of one record. nan if the record is shorter than the window of the sum.

    Examples
    --------
    >>> import numpy as np
    >>> from trbdyn import observables
    >>> t = np.arange(100_000) * 1e-3
    >>> noise = np.random.default_rng(1).normal(size=t.size)
    >>> bool(abs(observables.correlation_time(t, noise) - 1e-3) < 1e-4)
    True
    """
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if t.size < 2:
        return math.nan
    step = float(t[-1] - t[0]) / (t.size - 1)
    x = x - x.mean()
    size = float(np.abs(x).max())
    if size == 0.0:
        return step
    x = x / size
    spectrum = np.fft.rfft(x, 2 * x.size)
    product = np.fft.irfft(spectrum * spectrum.conj())[: x.size]
    if not product[0] > 0.0:
        return step
    sums = 2.0 * np.cumsum(product / product[0]) - 1.0
    enough = np.arange(x.size) >= WINDOW * np.maximum(sums, 1.0)
    if not enough.any():
        return math.nan
    return step * max(float(sums[int(np.argmax(enough))]), 1.0)


@dataclass(frozen=True, slots=True)
class MeanError:
    """What the values in batches tell of the error of their mean.

    Attributes
    ----------
    half_width : float
        Half width of the confidence interval of the mean, in the unit of the values; nan where it cannot be told.
    drift : float
        Chance that something slower than `SLOW` of the record is in the values, 0 to 1.
    """

    half_width: float
    drift: float


def mean_error(values: ArrayLike, confidence: float = CONFIDENCE) -> MeanError:
    """Error of a mean, from the values of a quantity in batches of equal length that follow each other.

    Parameters
    ----------
    values : array_like, shape (K,)
        The quantity in each batch. What repeats itself must repeat itself in each batch: batches of a whirling cage are whole
        turns of it.
    confidence : float
        Share of cases in which the interval holds the true mean.

    Returns
    -------
    MeanError
        With the half width nan for fewer than sixteen batches, where one has no value, or where it is likely that something in
        them drifts: what is as slow as the record itself may go anywhere after it.

    Examples
    --------
    >>> import numpy as np
    >>> from trbdyn import observables
    >>> rng = np.random.default_rng(1)
    >>> round(observables.mean_error(rng.normal(size=400)).half_width, 2)  # 0.10 with all that is known of it
    0.12
    >>> round(observables.mean_error(np.linspace(0.0, 1.0, 400)).drift, 2)
    1.0
    """
    x = np.asarray(values, dtype=float)
    if x.size < LEAST_BATCHES or not np.isfinite(x).all():
        return MeanError(math.nan, math.nan)
    away = x - x.mean()
    size = float(np.abs(away).max())
    if size <= 1e-14 * float(np.abs(x).max()):
        return MeanError(size, 0.0)
    number = min(x.size // 2, MOST_COSINES)
    grid = _grid(number)
    seen = _cosines(number, x.size) @ (away / size) / x.size
    squares = np.sum((grid.whiten @ seen) ** 2, axis=1)
    weight = grid.weight - 0.5 * number * np.log(squares)
    chance = np.exp(weight - weight.max())
    chance /= chance.sum()
    drift = float(chance[grid.time_scale > SLOW].sum())
    if drift > DRIFTS:
        return MeanError(math.nan, drift)
    return MeanError(size * _quantile(chance, np.sqrt(grid.mean * squares / number), number, confidence), drift)


def half_width(values: ArrayLike, confidence: float = CONFIDENCE) -> float:
    """Half width of the confidence interval of a mean: `mean_error` without the rest.

    Parameters
    ----------
    values : array_like, shape (K,)
        The quantity in each batch.
    confidence : float
        Share of cases in which the interval holds the true mean.

    Returns
    -------
    float
        In the unit of the values; nan where it cannot be told.
    """
    return mean_error(values, confidence).half_width


def _quantile(chance: Array, scale: Array, freedom: int, confidence: float) -> float:
    """Half width that a mixture of Student's distributions about zero exceeds by chance."""
    from scipy import optimize, special

    def beyond(half: float) -> float:
        return float(chance @ (2.0 * special.stdtr(freedom, -half / scale))) - (1.0 - confidence)

    factor = float(special.stdtrit(freedom, 0.5 + 0.5 * confidence))
    low, high = factor * float(scale.min()), factor * float(scale.max())
    return float(optimize.brentq(beyond, 0.99 * low, 1.01 * high))


@dataclass(frozen=True, slots=True)
class _Grid:
    """Slow parts that are thought possible: what makes the cosines of each independent and of variance one, ln of its chance
    beforehand and of its density, variance of the mean, and time scale (0: there is none).
    """

    whiten: Array
    weight: Array
    mean: Array
    time_scale: Array


def _cosines(number: int, batches: int) -> Array:
    """Cosines of 1/2, 1, 3/2, ... waves in a record, with the mean square one, shape (number, batches)."""
    middle = (np.arange(batches) + 0.5) / batches
    return math.sqrt(2.0) * np.cos(math.pi * np.outer(np.arange(1, number + 1), middle))


@lru_cache
def _grid(number: int) -> _Grid:
    """All slow parts; variances over that of the mean of the constant part alone."""
    fine = 8 * number + 128
    middle = (np.arange(fine) + 0.5) / fine
    apart, waves = np.abs(middle[:, None] - middle), _cosines(number, fine) / fine
    whiten, weight, mean, scales = [np.eye(number)], [math.log(NOTHING_SLOW)], [1.0], [0.0]
    chance = math.log((1.0 - NOTHING_SLOW) / (len(TIME_SCALES) * len(SIZES)))
    for time_scale in TIME_SCALES:
        alike = np.exp(-apart / time_scale) / (2.0 * time_scale)
        of_waves, of_mean = waves @ alike @ waves.T, float(alike.mean())
        for size in SIZES:
            factor = np.linalg.cholesky(np.eye(number) + size * of_waves)
            whiten.append(np.linalg.inv(factor))
            weight.append(chance - float(np.log(np.diag(factor)).sum()))
            mean.append(1.0 + size * of_mean)
            scales.append(float(time_scale))
    return _Grid(np.array(whiten), np.array(weight), np.array(mean), np.array(scales))
