"""Growth of the whirl in a point's history (`trbdyn.observables.whirl_growth`)."""

from __future__ import annotations

import numpy as np

from paper.files import History
from trbdyn.results.observables import Growth, whirl_amplitude, whirl_growth


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
    return whirl_growth(time, np.abs(amplitude) / radial_play)
