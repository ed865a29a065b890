"""Signals: even sampling, spectra, and where a signal has settled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

MAX_JITTER = 1e-6
"""Largest relative deviation of a sampling interval that still counts as even."""


def uniform(time: ArrayLike, values: ArrayLike) -> tuple[float, NDArray[Any]]:
    """Values at even times.

    Parameters
    ----------
    time : array_like, shape (T,)
        Increasing times, s.
    values : array_like, shape (T, ...)
        Samples, real or complex.

    Returns
    -------
    interval : float
        Sampling interval, s.
    values : ndarray, shape (T, ...)
        The values as given where the times are even, else interpolated linearly to as many even times.

    Raises
    ------
    ValueError
        If there are fewer than two samples or the times do not increase.
    """
    t = np.asarray(time, dtype=float)
    x = np.asarray(values)
    if t.ndim != 1 or t.size < 2 or x.shape[:1] != t.shape:
        raise ValueError(f"needs at least two times and as many values, not shapes {t.shape} and {x.shape}")
    steps = np.diff(t)
    if not np.all(steps > 0):
        raise ValueError("times must increase")
    interval = float((t[-1] - t[0]) / (t.size - 1))
    if np.max(np.abs(steps - interval)) <= MAX_JITTER * interval:
        return interval, x
    even = np.linspace(t[0], t[-1], t.size)
    flat = x.reshape(t.size, -1)
    columns = [np.interp(even, t, flat[:, k]) for k in range(flat.shape[1])]
    return interval, np.stack(columns, axis=1).reshape(x.shape)


def spectrum(time: ArrayLike, values: ArrayLike, segments: int = 1) -> tuple[Array, Array]:
    """Power spectral density by Welch's method, with a Hann window and the mean removed, of the power of the whole signal.

    A window weighs the ends of a signal less than its middle, so that single hits would count by where they lie: the density is
    scaled to the mean square of the samples. A stationary signal it changes by per mille.

    Parameters
    ----------
    time : array_like, shape (T,)
        Times, s.
    values : array_like, shape (T,)
        Samples. Complex samples x + i y give a two-sided spectrum, in which positive frequencies turn from x to y.
    segments : int
        Number of segments, overlapping by half, that are averaged. One gives the finest resolution.

    Returns
    -------
    frequency : ndarray, shape (F,)
        Increasing frequencies, Hz.
    density : ndarray, shape (F,)
        Density in the square of the values' unit per Hz; its integral is the mean square about the mean.

    Raises
    ------
    ValueError
        If there are fewer than eight samples in a segment.
    """
    frequency, density, x = windowed(time, values, segments)
    power = float(np.trapezoid(density, frequency))
    return frequency, density * (float(np.var(x)) / power if power > 0.0 else 1.0)


def windowed(time: ArrayLike, values: ArrayLike, segments: int = 1) -> tuple[Array, Array, NDArray[Any]]:
    """As `spectrum`, but of the power that the window leaves, with the samples at even times: a line has its amplitude by it."""
    from scipy import signal

    interval, x = uniform(time, values)
    length = int(2 * x.size // (segments + 1))
    if length < 8:
        raise ValueError(f"a spectrum needs at least 8 samples in a segment, not {length}")
    two_sided = np.iscomplexobj(x)
    frequency, density = signal.welch(
        x, fs=1.0 / interval, window="hann", nperseg=length, detrend="constant", return_onesided=not two_sided
    )
    order = np.argsort(frequency)
    return np.asarray(frequency[order], dtype=float), np.asarray(np.real(density[order]), dtype=float), x


FOLDED = 0.1
"""Largest share of a spectrum's power in its highest octave: where more lies there, more lies above it too, and records fold that
to lower frequencies."""


def high_share(frequency: ArrayLike, density: ArrayLike) -> float:
    """Share of a spectrum's power in the highest octave that the samples resolve: large where faster parts are folded.

    Parameters
    ----------
    frequency, density : array_like, shape (F,)
        A spectrum at even, increasing frequencies, up to half of the frequency of the samples.

    Returns
    -------
    float
        The share (1), see `FOLDED`; 0 for a signal that is constant.
    """
    f, p = np.abs(np.asarray(frequency, dtype=float)), np.asarray(density, dtype=float)
    total = float(p.sum())
    return float(p[f >= 0.5 * f.max()].sum() / total) if total > 0.0 else 0.0


def peak_frequency(frequency: ArrayLike, density: ArrayLike) -> float:
    """Frequency of a spectrum's highest peak, by a parabola through the logarithms of the peak and its neighbours.

    Parameters
    ----------
    frequency, density : array_like, shape (F,)
        A spectrum at even, increasing frequencies.

    Returns
    -------
    float
        Frequency in the unit of `frequency`; nan if the spectrum is zero everywhere.
    """
    f = np.asarray(frequency, dtype=float)
    p = np.asarray(density, dtype=float)
    k = int(np.argmax(p))
    if not p[k] > 0:
        return float("nan")
    if not 0 < k < p.size - 1 or min(p[k - 1], p[k + 1]) <= 0:
        return float(f[k])
    left, peak, right = np.log(p[k - 1 : k + 2])
    bend = left - 2 * peak + right
    shift = 0.5 * (left - right) / bend if bend < 0 else 0.0
    return float(f[k] + shift * (f[1] - f[0]))


@dataclass(frozen=True, slots=True)
class Settling:
    """Where a signal has settled.

    Attributes
    ----------
    index : int
        First sample of the settled part.
    time : float
        Time of that sample, s.
    settled : bool
        False if the signal still drifts at the end: then `index` is the middle of the record, and averages over the rest
        are those of a transient.
    """

    index: int
    time: float
    settled: bool


def settling(time: ArrayLike, values: ArrayLike, batches: int = 50) -> Settling:
    """Find where a signal has settled: the marginal standard error rule over means of batches.

    The record is cut into equal batches. Of all truncations up to half of the record, the one is taken that gives the mean of
    the remaining batch means the smallest standard error, sum((b - mean b)^2)/n^2: cutting more removes the transient's share
    of the numerator, cutting too much makes n small. If the best truncation is the last one allowed, the signal has not settled.

    Parameters
    ----------
    time : array_like, shape (T,)
        Increasing times, s.
    values : array_like, shape (T,) or (T, K)
        One or several signals. Of several, the one that settles last decides.
    batches : int
        Number of batches, at least 4. A batch should hold at least one period of the cage.

    Returns
    -------
    Settling
        Index and time of the first settled sample, and whether there is one.

    Raises
    ------
    ValueError
        If there are fewer than 4 batches, or shapes that do not belong together.

    References
    ----------
    White, K. P., An effective truncation heuristic for bias reduction in simulation output, Simulation 69 (1997) 323-334.
    """
    t = np.asarray(time, dtype=float)
    x = np.asarray(values, dtype=float)
    x = x[:, None] if x.ndim == 1 else x
    if t.ndim != 1 or x.ndim != 2 or x.shape[0] != t.size:
        raise ValueError(f"needs a value for each time, not shapes {t.shape} and {x.shape}")
    n = min(int(batches), t.size)
    if n < 4:
        raise ValueError(f"needs at least 4 batches of at least one sample, not {n}")
    edges = np.linspace(0, t.size, n + 1).astype(int)
    best, settled = 0, True
    for column in x.T:
        means = np.add.reduceat(column, edges[:-1]) / np.diff(edges)
        scale = np.max(np.abs(means))
        if np.ptp(means) <= 1e-12 * scale:
            continue
        truncation = _best_truncation(means)
        best = max(best, truncation)
        settled = settled and truncation < n // 2
    index = int(edges[best])
    return Settling(index, float(t[index]), settled)


def _best_truncation(means: Array) -> int:
    """Number of leading batch means to drop, at most half of them."""
    errors = [float(np.var(means[k:])) / (means.size - k) for k in range(means.size // 2 + 1)]
    return int(np.argmin(errors))
