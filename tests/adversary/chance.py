"""Whether a loss is off by the way of one motion, or by a bias of the tolerances.

Bodies that hit each other go their own ways: the first impacts of a run decide about its loss. The same scene is run again from
states that are moved by some millionths, which changes the way and not the problem, with the tolerances that are judged and with
tight ones. Where tolerances are at fault, the means of both differ; where the way is, they do not. Scenes with other speeds and
loads would be no help: they dilute a bias that belongs to this scene.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

import trbdyn as trb

MOVED = 5e-6
"""Share by which the numbers of the state at the start are moved."""
RUNS = 12
"""Runs with either tolerances."""
FEWEST = 0.75
"""Share of them that must have come to their end."""


def move(sim: trb.Simulation, number: int) -> trb.Simulation:
    """Begin a simulation in a state that is a little beside its own, another one for each number; number 0 changes nothing."""
    if number:
        vector = sim.state.vector
        sim.set_state(vector * (1.0 + MOVED * np.random.default_rng(number).standard_normal(vector.size)))
    return sim


def mean_difference(losses: Callable[[int], tuple[float, float]], count: int = RUNS) -> tuple[float, float]:
    """By how much losses of moved runs of a scene are off in the mean, and twice its standard error; infinite if too few ended.

    Parameters
    ----------
    losses : callable
        Losses of the run of a number by the tolerances that are judged, and by tight ones (J); nan where it did not come to its
        end.
    count : int
        How many runs; three quarters of them must have come to their end.

    Returns
    -------
    tuple of float
        Over the mean loss by tight tolerances.
    """
    pairs = np.array([losses(number) for number in range(count)])
    own, tight = (values[np.isfinite(values)] for values in pairs.T)
    if min(own.size, tight.size) < FEWEST * count or not tight.mean() > 0.0:
        return math.inf, math.inf
    error = 2.0 * math.sqrt(float(np.var(own, ddof=1)) / own.size + float(np.var(tight, ddof=1)) / tight.size)
    return float(own.mean() / tight.mean() - 1.0), error / float(tight.mean())


def within_its_interval(result: trb.Result, tight: trb.Result) -> bool:
    """Whether the power loss of the tight run lies in the 95 % interval that the summary of the other one states."""
    said, right = result.summary(), tight.summary()
    half = (said.get("confidence") or {}).get("power_loss")
    return half is not None and abs(said["power_loss"] - right["power_loss"]) <= half
