"""What a plan stands on: a run of the scene with everything on, from its start until the motion has settled, as far as the time
for it reaches. It gives the state that the probes and the run of the plan start from, the averages with their scatter, and what
is left of settling.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from trbdyn.errors import InputError, StepError
from trbdyn.extras.design.planning.averaged import Records, least_size, of_bearing, size_of
from trbdyn.extras.design.planning.candidates import USUAL_ACCURACY
from trbdyn.extras.design.planning.probes import BATCHES, TOO_LONG, Array, Length, in_batches, number_in, run_quietly
from trbdyn.results.numbers import TABLE

if TYPE_CHECKING:
    from trbdyn.model.assembly import Subject
    from trbdyn.model.scene import Start
    from trbdyn.results.observables import MotionSettling

LEAST_TURNS: Final = 20.0
"""Turns of the shaft below which a note says so."""
LEAST_RECORDS: Final = 200
"""Records of a run at least."""
MOST_TURNS: Final = 1000.0
"""Turns of the shaft after which the run ends, however fast it is."""
UNKNOWN_SCATTER: Final = 2.0 * 2.1
"""Half width over the standard error of twenty batches (Student's t: 2.1), twice as large as they may not be independent."""
TOLD_FROM_SCATTER: Final = 2.8
"""Difference of two means of five batches each over its standard error (Student's t: 2.78) from which it is a drift."""


@dataclass(frozen=True)
class Ground:
    """A run of a scene with everything on."""

    start: Start  # the state at its end
    value: dict[str, float]  # the averages over its settled part
    size: dict[str, float]  # what their errors are shares of (`trbdyn.extras.design.planning.averaged`)
    scatter: Array  # half widths of their confidence intervals over their sizes, shape (W,)
    drift: Array  # what they may still change by, over their sizes, shape (W,)
    window: float  # length of the settled part (s)
    creep_time: float  # time of the rollers' creep (s); nan where it is not known
    rate: float  # processor time for a second of bearing time (s)
    notes: tuple[str, ...]  # where it could be wrong


def run_ground(subject: Subject, want: Mapping[str, float], period: float, length: Length, effort: float) -> Ground:
    """Run a scene or an assembly with everything on, as long as its share of the time allows: how dear a second of bearing time
    is once the motion has settled is not known beforehand. `period` is the time of a turn (s), `effort` the processor time of
    the whole plan (s), which must be enough for as many records as averages need.
    """
    ran = run_quietly(subject, USUAL_ACCURACY, replace(length, duration=MOST_TURNS * period))
    if ran.records is None or ran.end is None or ran.failure not in ("", TOO_LONG):
        raise StepError(f"the scene cannot be run: {ran.failure}", time=(subject.start or subject.part.start).time)
    records = ran.records
    began, end = float(records.time[0]), float(records.time[-1])
    if records.time.size < LEAST_RECORDS:
        share = f"{length.patience:.2g} s, the share of one run,"
        allowed = f"is not enough: {share} bring {(end - began) / period:.2g} turns of the {subject.turning_ring} (s)"
        raise InputError.of("effort", effort, allowed)
    names, settling = list(want), records.settling()
    settled_from = settling.time if settling.settled else 0.5 * (began + end)
    window = records.window(settled_from)
    found = window.averages()
    value = {name: number_in(found, name) for name in names}
    for name in names:
        bearing, own = of_bearing(name)
        orbit = found.get(f"{bearing}orbit_rms_over_cpr", 1.0)
        if own.startswith("whirl_") and orbit < least_size("orbit_rms_over_cpr"):
            value[name] = math.nan
    size = {name: size_of(name, value[name]) for name in names}
    scatter, notes = _scatter(window, names, size)
    notes += [f"the motion is not known to have settled after {end - began:.3g} s: {settling.reason}"] * (
        not settling.settled
    )
    notes += [f"in the run that it is based on: {text}" for text in records.warnings]
    turns = (end - began) / period
    if turns < LEAST_TURNS:
        notes.append(f"only {turns:.2g} turns of the {subject.turning_ring} could be looked at; allow more effort")
    drift = np.zeros(len(names)) if settling.settled else _drift(records, names, size, settling)
    return Ground(ran.end, value, size, scatter, drift, end - settled_from, settling.creep_time, ran.rate, tuple(notes))


def _scatter(window: Records, names: Sequence[str], size: Mapping[str, float]) -> tuple[Array, list[str]]:
    """Half widths over the sizes: those of the summary, else guessed from batches and said so."""
    known = window.half_widths()
    parts = in_batches(window, names, 0.0)
    notes, found = [], []
    for name in names:
        if name in known and size[name] > 0.0:
            found.append(known[name] / size[name])
            continue
        spread = float(np.std(parts[name], ddof=1)) / math.sqrt(BATCHES)
        found.append(UNKNOWN_SCATTER * spread / size[name] if size[name] > 0.0 else math.inf)
        notes.append(f"the statistical error of {name} is a guess: its batches are too few or not independent")
    return np.array(found), notes


def _drift(records: Records, names: Sequence[str], size: Mapping[str, float], settling: MotionSettling) -> Array:
    """What the averages may still change by: their change from the third to the last quarter of the run. Where it stands out of
    the scatter and the motion drifts, it goes on at this rate for the time scale of the drift; where the whirl grows, up to the
    play of the cage (`_left_to_grow`).
    """
    time = records.time
    quarter = 0.25 * float(time[-1] - time[0])
    longer = max(1.0, settling.time_scale / quarter) if math.isfinite(settling.time_scale) else 1.0
    last, grown = records.window(time[-1] - quarter), settling.growth_rate * quarter
    sides = [records.window(time[-1] - 2.0 * quarter, time[-1] - quarter), last]
    batches = [in_batches(side, names, 0.0, 5) for side in sides]
    found = []
    for name in names:
        before, after = (part[name] for part in batches)
        change = abs(float(after.mean() - before.mean()))
        power = TABLE[of_bearing(name)[1]].grows
        goes_on = max(longer, _left_to_grow(last, grown, power)) if grown > 0.0 else longer
        noise = TOLD_FROM_SCATTER * math.hypot(
            *(float(part.std(ddof=1)) / math.sqrt(part.size) for part in (before, after))
        )
        found.append(change * (goes_on if change > noise else 1.0) / size[name] if size[name] > 0.0 else math.inf)
    return np.array(found)


def _left_to_grow(last: Records, grown: float, power: float) -> float:
    """What is still to come of a change, over what a growing whirl brought it from the quarter before to the last one. The
    whirl grows by `grown` (ln of its size) in a quarter, and cannot become larger than the play of the cage; of several cages
    the one that moves most counts. The average changes with the `power` of its size.
    """
    sizes = [float(value) for name, value in last.averages().items() if name.endswith("orbit_rms_over_cpr")]
    size = max(*sizes, 1e-6)
    return max(size**-power - 1.0, 0.0) / -math.expm1(-power * grown)
