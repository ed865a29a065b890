"""How well a mean over a run is known: batch means over the correlation time of the motion
(docs/theory/whirl.md#how-well-a-mean-is-known).

Neighbouring records of a whirling cage tell nearly the same, so the scatter of the records says little about the error of their
mean. The record is therefore cut into batches that are long against the time over which the motion remembers itself; means of
such batches scatter as independent numbers do, and their scatter gives the error of the mean of all (Student's t). The
correlation time is the integral of the normalised autocorrelation, cut off where it is lost in its own noise (Sokal, Monte Carlo
Methods in Statistical Mechanics, 1996: the smallest window that is five times the correlation time).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

WINDOW: Final = 5.0
"""Length of the sum of the autocorrelation, in correlation times."""
BATCH: Final = 4.0
"""Least length of a batch, in correlation times (of the slowest signal)."""
MOST_BATCHES: Final = 20
LEAST_BATCHES: Final = 5
"""Batches below which no error is given."""
CONFIDENCE: Final = 0.95
ALIKE: Final = 2.326
"""Standard deviations that only 1 of 100 normal values exceeds."""


def correlation_time(time: ArrayLike, values: ArrayLike) -> float:
    """Time over which a signal remembers itself: integral of its normalised autocorrelation over positive and negative delays.

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


def batches(time: ArrayLike, signals: Sequence[ArrayLike], least: float = 0.0) -> list[slice]:
    """Cut a record into batches whose means scatter as independent numbers do.

    Parameters
    ----------
    time : array_like, shape (T,)
        Increasing times at equal distances, s.
    signals : sequence of array_like, shape (T,) each
        What must be independent: the slowest one counts.
    least : float
        Least length of a batch (s), for instance a turn of the cage.

    Returns
    -------
    list of slice
        The records of each batch, all of one length, up to the end of the record; empty where it is too short for five.
    """
    t = np.asarray(time, dtype=float)
    if t.size < 2 * LEAST_BATCHES:
        return []
    step = float(t[-1] - t[0]) / (t.size - 1)
    found = [correlation_time(t, signal) for signal in signals]
    slowest = math.nan if any(map(math.isnan, found)) else max(found, default=step)
    if math.isnan(slowest):
        return []
    length = max(math.ceil(max(BATCH * slowest, least) / step - 1e-9), 2, t.size // MOST_BATCHES)
    number = t.size // length
    if number < LEAST_BATCHES:
        return []
    first = t.size - number * length
    return [slice(first + i * length, first + (i + 1) * length) for i in range(number)]


def half_width(values: ArrayLike, confidence: float = CONFIDENCE) -> float:
    """Half width of the confidence interval of a mean, from its values in batches (Student's t).

    Parameters
    ----------
    values : array_like, shape (K,)
        The quantity in each batch.
    confidence : float
        Share of cases in which the interval holds the true mean.

    Returns
    -------
    float
        In the unit of the values; nan for fewer than five batches, where one has no value, or where values that follow each other
        are more alike than chance makes them: then they are not independent, and their scatter tells too small an error.

    Examples
    --------
    >>> from trbdyn import observables
    >>> round(observables.half_width([1.0, 4.0, 2.0, 5.0, 3.0]), 3)
    1.963
    """
    from scipy import stats

    x = np.asarray(values, dtype=float)
    if x.size < LEAST_BATCHES or not np.isfinite(x).all():
        return math.nan
    if _follows(x):
        return math.nan
    factor = float(stats.t.ppf(0.5 + 0.5 * confidence, x.size - 1))
    return factor * float(x.std(ddof=1)) / math.sqrt(x.size)


def _follows(x: Array) -> bool:
    """Whether neighbours are more alike than those of independent values would be in all but 1 of 100 cases: the correlation of
    neighbours has the mean -1/K and nearly the variance 1/K (Anderson, Ann. Math. Stat. 13 (1942) 1-13).
    """
    away = x - x.mean()
    size = float(np.sum(away**2))
    if size == 0.0:
        return False
    alike = float(np.sum(away[:-1] * away[1:])) / size
    return alike > ALIKE / math.sqrt(x.size) - 1.0 / x.size
