"""How fast a whirl grows or dies: the logarithm of its amplitude (`whirl_amplitude`) over time gives the rate of growth, and how
long the growth would still take.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BLOCKS: Final = 12
"""Stretches into which the fitted part is divided: the error of the rate comes from their scatter about the line."""
SIGMAS: Final = 3.0
"""Standard errors from which a rate is one."""
LEAST_GROWTH: Final = 0.1
"""Growth (ln of the amplitude) along the fitted part from which a whirl counts as growing."""
FULL: Final = 0.75
"""Amplitude over Cpr up to which growth is extrapolated: where whirls that have settled stand at the highest load and speed."""


@dataclass(frozen=True)
class Growth:
    """Amplitude of a whirl, and its rate.

    Attributes
    ----------
    amplitude : float
        Amplitude over Cpr at the end of the record.
    rate, rate_error : float
        Rate of its logarithm over the last half of the record, and the standard error (1/s); nan for short records.
    fitted : float
        Length of the part that the rate is taken from (s).
    """

    amplitude: float
    rate: float
    rate_error: float
    fitted: float

    @property
    def growing(self) -> bool:
        """Whether it grows, beyond the noise, and is not there yet."""
        return self.rate > SIGMAS * self.rate_error and self.rate * self.fitted > LEAST_GROWTH and self.amplitude < FULL

    @property
    def time_to_full(self) -> float:
        """Bearing time that growth at this rate would take to `FULL` (s); nan if it does not grow."""
        return math.log(FULL / self.amplitude) / self.rate if self.growing else math.nan


def whirl_growth(time: Array, amplitude: Array) -> Growth:
    """Growth of a whirl from its amplitude by turns of the cage: the last half of the record decides.

    Parameters
    ----------
    time : ndarray, shape (N,)
        Times (s), as `whirl_amplitude` gives them.
    amplitude : ndarray, shape (N,)
        Amplitude over the radial play Cpr (1); its size counts.

    Returns
    -------
    Growth
        Its rate is nan if the last half has fewer than 24 turns.

    Examples
    --------
    >>> import numpy as np
    >>> from trbdyn import observables
    >>> time = np.linspace(0.0, 10.0, 200)
    >>> found = observables.whirl_growth(time, 0.01 * np.exp(0.3 * time))
    >>> round(found.rate, 6), found.growing
    (0.3, True)
    """
    half = slice(time.size // 2, None)
    t, size = time[half], np.abs(amplitude[half])
    if t.size < 2 * BLOCKS:
        return Growth(float(size.mean()) if size.size else math.nan, math.nan, math.nan, 0.0)
    parts = np.array_split(np.arange(t.size), BLOCKS)
    x = np.array([t[part].mean() for part in parts])
    y = np.array([math.log(max(float(size[part].mean()), 1e-9)) for part in parts])
    centred = x - x.mean()
    rate = float(centred @ y / (centred @ centred))
    left = y - y.mean() - rate * centred
    error = math.sqrt(float(left @ left) / (BLOCKS - 2) / float(centred @ centred))
    return Growth(float(size[parts[-1]].mean()), rate, error, float(t[-1] - t[0]))
