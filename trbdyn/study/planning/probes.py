"""Short paired runs that tell what a simplification changes in an average, and what it saves.

All probes go on from one state, which a settled run has reached, so that a probe and the one it is compared with see the same
rollers and the same cage at first. Their averages are compared batch by batch; the differences scatter much less than the
averages themselves where the motion is smooth, and about as much where the cage collides, for then the two motions soon part.
Both are seen in the confidence interval of the mean difference.
"""

from __future__ import annotations

import math
import time as clock
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError, LoadError, StepError
from trbdyn.model.scene import Scene, Start
from trbdyn.results import observables
from trbdyn.results.result import Result
from trbdyn.results.summary import averages
from trbdyn.run.running import STOPPED
from trbdyn.run.simulation import Simulation
from trbdyn.statics.core_model import build_model
from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]

BATCHES: Final = 20
"""Batches of a probe that are compared."""
TRANSIENT: Final = 0.25
"""Share of a probe that is left out of the averages, in which the motion follows a change of the model."""
PATIENCE: Final = 4.0
"""A probe that takes so many times the computing time that was expected is ended."""


@dataclass(frozen=True)
class Length:
    """How long probes are, and what they keep.

    Attributes
    ----------
    duration, save_every : float
        Bearing time, and time between records (s).
    groups : tuple of str
        Groups of records.
    patience : float
        Processor time after which a probe is ended (s).
    """

    duration: float
    save_every: float
    groups: tuple[Any, ...]
    patience: float


@dataclass(frozen=True)
class Probe:
    """What a short run gave.

    Attributes
    ----------
    batches : dict of str to ndarray
        The wanted averages in each batch.
    rate : float
        Processor time for a second of bearing time, with records (s).
    failure : str
        Why it cannot be used; empty if it can.
    warned : tuple of str
        What the watch over the run said.
    """

    batches: dict[str, Array]
    rate: float
    failure: str = ""
    warned: tuple[str, ...] = ()


TOO_LONG: Final = "it took much longer than was expected"
"""Failure of a run whose patience was at its end."""


def run_quietly(scene: Scene, accuracy: str, length: Length) -> tuple[Result | None, float, str]:
    """A run with its processor time for a second of bearing time, and why it cannot be used."""
    impatient = False

    def look(_: Simulation) -> bool:
        nonlocal impatient
        impatient = clock.process_time() - began > length.patience
        return impatient

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            simulation = Simulation(scene, accuracy=accuracy)
            began = clock.process_time()
            result = simulation.run(
                duration=length.duration,
                save_every=length.save_every,
                save_groups=length.groups,
                callback=look,
            )
            spent = clock.process_time() - began
        except (InputError, LoadError, StepError) as error:
            return None, math.nan, str(error).splitlines()[0]
    if result.message.startswith(
        STOPPED
    ):  # a run keeps what it has; a plan has nothing to keep, and ends as a study does
        raise KeyboardInterrupt
    bearing = max(float(result["time"][-1] - result["time"][0]), 1e-300)
    failure = "" if result.success else TOO_LONG if impatient else result.message
    return result, spent / bearing, failure


def probe(scene: Scene, accuracy: str, length: Length, names: Sequence[str]) -> Probe:
    """Run a scene from a state and average it in batches.

    Parameters
    ----------
    scene : Scene
        The scene, with the state that it starts from.
    accuracy : str
        Preset of the tolerances.
    length : Length
        How long, and what to keep.
    names : sequence of str
        Averages of the summary.
    """
    result, rate, failure = run_quietly(scene, accuracy, length)
    if result is None or failure:
        return Probe({}, rate, failure)
    return Probe(in_batches(result, names, TRANSIENT), rate, warned=tuple(result.warnings))


def carried_over(scene: Scene, state: Start, of: Scene) -> Scene:
    """A scene that starts from a state of another one, whose switches differ.

    Places and velocities are the same; integrals of losses begin at zero where the two scenes do not have the same losses.

    Parameters
    ----------
    scene : Scene
        The scene.
    state : Start
        The state.
    of : Scene
        The scene it is a state of.

    Raises
    ------
    InputError
        If the scene cannot be used.
    """
    old_model, model = build_model(of, ""), build_model(scene.replace(start=Start.equal()), "")
    old, vector = StateView(old_model.state_layout(), np.array(state.state_vector)), np.zeros(model.n_state)
    new = StateView(model.state_layout(), vector)
    for name in set(old.names) & set(new.names):
        if old[name].shape == new[name].shape:
            new[name] = old[name]
    start = state.replace(state_vector=tuple(vector.tolist()))
    return scene.replace(start=start)


def in_batches(result: Result, names: Sequence[str], transient: float, number: int = BATCHES) -> dict[str, Array]:
    """Averages in batches of equal length after a share of the records; nan where there is none."""
    time = result["time"]
    edges = np.linspace(transient * (time.size - 1), time.size - 1, number + 1).astype(int)
    if np.diff(edges).min() < 3:
        return {name: np.full(number, math.nan) for name in names}
    parts = [averages(result.window(time[a + 1], time[b])) for a, b in pairwise(edges)]
    return {name: np.array([_number(part.get(name)) for part in parts]) for name in names}


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


@dataclass(frozen=True)
class Influence:
    """What a change does to an average, over its size (`trbdyn.study.planning.sizes`).

    Attributes
    ----------
    change : float
        Mean relative difference; nan where it cannot be told.
    half_width : float
        Half width of its 95 % confidence interval.
    moving : bool
        Whether the difference still drifts from batch to batch, so that it is not known where it ends. The bound is then twice
        the largest one seen.
    """

    change: float
    half_width: float
    moving: bool = False

    @property
    def bound(self) -> float:
        """Largest size that is likely."""
        return abs(self.change) + self.half_width if math.isfinite(self.change) else math.inf


def influence(other: Probe, base: Probe, scale: Mapping[str, float], name: str) -> Influence:
    """Influence of what differs between two probes on an average.

    Parameters
    ----------
    other, base : Probe
        The probe with the change, and the one without.
    scale : mapping of str to float
        The averages' sizes.
    name : str
        The average.
    """
    if other.failure or base.failure or scale[name] == 0.0:
        return Influence(math.nan, math.nan)
    difference = (other.batches[name] - base.batches[name]) / abs(scale[name])
    if not np.isfinite(difference).all():
        return Influence(math.nan, math.nan)
    change, half_width = float(difference.mean()), observables.half_width(difference)
    if math.isfinite(half_width):
        return Influence(change, half_width)
    largest = float(np.abs(difference).max())
    return Influence(change, 2.0 * largest - abs(change), moving=True)
