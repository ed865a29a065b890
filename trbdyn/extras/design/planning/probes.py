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
from functools import lru_cache, singledispatch
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError, LoadError, StepError
from trbdyn.extras.design.planning.averaged import Records
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.ring_body import counts_from_the_start
from trbdyn.model.scene import Scene, Start
from trbdyn.results import observables
from trbdyn.run.running import STOPPED
from trbdyn.run.simulation import Simulation
from trbdyn.statics.core_model import build_model
from trbdyn.statics.seating import seated
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
    """How long probes are, and what they keep."""

    duration: float  # bearing time (s)
    save_every: float  # time between records (s)
    groups: tuple[Any, ...]  # of records
    patience: float  # processor time after which a run is ended (s) that has taken more than `steps`
    steps: float = 0.0  # the watch over a run may take longer than its steps, so fewer never end it


@dataclass(frozen=True)
class Probe:
    """What a short run gave."""

    batches: dict[str, Array]  # the wanted averages in each batch
    rate: float  # processor time of the steps for a second of bearing time (s)
    failure: str = ""  # why it cannot be used; empty if it can
    warned: tuple[str, ...] = ()  # what the watch over the run said
    steps: float = 0.0  # how many it took


TOO_LONG: Final = "it took much longer than was expected"
"""Failure of a run whose patience was at its end."""


@dataclass(frozen=True)
class Ran:
    """A run of a scene or an assembly. What is held begins at its place in the state at the end only where the model counts
    displacements from the start: another model places it again.
    """

    rate: float  # processor time of the steps for a second of bearing time (s)
    failure: str  # why it cannot be used; empty if it can
    records: Records | None = None
    end: Start | None = None  # the state at its end
    steps: float = 0.0  # how many it took


def run_quietly(subject: Subject, accuracy: str, length: Length) -> Ran:
    """Run a scene or an assembly as long as patience lasts, without warnings."""
    impatient = False

    def look(now: Simulation) -> bool:
        nonlocal impatient
        impatient = clock.process_time() - began > length.patience and now.statistics["steps"] > length.steps
        return impatient

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            simulation = Simulation(subject, accuracy=accuracy)
            began = clock.process_time()
            result = simulation.run(
                duration=length.duration,
                save_every=length.save_every,
                save_groups=length.groups,
                callback=look,
            )
            stepping = result.stats["stepping_s"] / max(result.stats["wall_s"], 1e-300)
            spent = stepping * (clock.process_time() - began)
        except (InputError, LoadError, StepError) as error:
            return Ran(math.nan, str(error).splitlines()[0])
    if result.message.startswith(
        STOPPED
    ):  # a run keeps what it has; a plan has nothing to keep, and ends as a study does
        raise KeyboardInterrupt
    records, end = Records.of(subject, result), Start.state(simulation.state)
    if len(records.parts) > 1 or not counts_from_the_start(simulation.scene):
        end = end.replace(displacement=None, housing_load=None)
    bearing = max(float(records.time[-1] - records.time[0]), 1e-300)
    failure = "" if result.success else TOO_LONG if impatient else result.message
    return Ran(spent / bearing, failure, records, end, simulation.statistics["steps"])


def probe(subject: Subject, accuracy: str, length: Length, names: Sequence[str]) -> Probe:
    """Run a scene or an assembly from the state that it starts with, and average it in batches."""
    ran = run_quietly(subject, accuracy, length)
    if ran.records is None or ran.failure:
        return Probe({}, ran.rate, ran.failure)
    return Probe(in_batches(ran.records, names, TRANSIENT), ran.rate, "", ran.records.warnings, ran.steps)


@singledispatch
def _layouts(subject: Any) -> tuple[int, list[Any]]:
    """Length of the state of a subject, and the layout of the part of each bearing."""
    raise NotImplementedError


@_layouts.register(Scene)
def _of_scene(scene: Scene) -> tuple[int, list[Any]]:
    model = build_model(scene.replace(start=Start.equal()), "")
    return model.n_state, [model.state_layout()]


@_layouts.register(Assembly)
def _of_assembly(assembly: Assembly) -> tuple[int, list[Any]]:
    return _seated(assembly.replace(start=None))


@lru_cache(maxsize=4)
def _seated(assembly: Assembly) -> tuple[int, list[Any]]:
    found = seated(assembly)
    return found.vector.size, [one.layout for one in found.bearings]


def carried_over(subject: Subject, state: Start, of: Subject) -> Subject:
    """A subject that starts from a state of another one, whose switches differ. Places and velocities are the same; integrals
    of losses begin at zero where the two do not have the same losses.
    """
    (_, befores), (size, layouts) = _layouts(of), _layouts(subject)
    given, vector = np.array(state.state_vector), np.zeros(size)
    for before, layout in zip(befores, layouts, strict=True):
        old, new = StateView(before, given), StateView(layout, vector)
        for name in set(old.names) & set(new.names):
            if old[name].shape == new[name].shape:
                new[name] = old[name]
    return subject.replace(start=state.replace(state_vector=tuple(vector.tolist())))


def in_batches(records: Records, names: Sequence[str], transient: float, number: int = BATCHES) -> dict[str, Array]:
    """Averages in batches of equal length after a share of the records; nan where there is none."""
    time = records.time
    edges = np.linspace(transient * (time.size - 1), time.size - 1, number + 1).astype(int)
    if np.diff(edges).min() < 3:
        return {name: np.full(number, math.nan) for name in names}
    parts = [records.window(time[a + 1], time[b]).averages() for a, b in pairwise(edges)]
    return {name: np.array([number_in(part, name) for part in parts]) for name in names}


def number_in(averages: Mapping[str, Any], name: str) -> float:
    """An average; nan where there is none."""
    value = averages.get(name)
    return math.nan if value is None else float(value)


@dataclass(frozen=True)
class Influence:
    """What a change does to an average, over its size (`trbdyn.extras.design.planning.averaged`).

    Attributes
    ----------
    change : float
        Mean relative difference; nan where it cannot be told, as it still drifts at the end of the probes.
    half_width : float
        Half width of its 95 % confidence interval.
    """

    change: float
    half_width: float

    @property
    def bound(self) -> float:
        """Largest size that is likely."""
        return abs(self.change) + self.half_width if math.isfinite(self.change) else math.inf


def influence(other: Probe, base: Probe, scale: Mapping[str, float], name: str) -> Influence:
    """Influence of what differs between two probes on an average, over its size."""
    unknown = Influence(math.nan, math.nan)
    if other.failure or base.failure or scale[name] == 0.0:
        return unknown
    difference = (other.batches[name] - base.batches[name]) / abs(scale[name])
    half_width = observables.half_width(difference) if np.isfinite(difference).all() else math.nan
    return Influence(float(difference.mean()), half_width) if math.isfinite(half_width) else unknown
