"""How fast a whirl grows or dies: the logarithm of its amplitude (`trbdyn.observables.whirl_amplitude`) over time gives the rate
of growth, and how long the growth would still take.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.observables.drift import whirl_amplitude
from trbdyn.paper.files import History

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


def growth_of(time: Array, amplitude: Array) -> Growth:
    """Growth from the size of the amplitude over Cpr by turns: the last half of the record decides."""
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


def growth_of_history(history: History, radial_play: float) -> Growth:
    """Growth of the whirl in a point's history.

    Parameters
    ----------
    history : History
        What came before the statistics.
    radial_play : float
        Cpr (m).
    """
    time, amplitude = whirl_amplitude(history["time"], history["cage_position"], history["cage_angle"])
    return growth_of(time, np.abs(amplitude) / radial_play)
