"""The runs of a plan: one that all stands on, one from another start, and a probe of each simplification alone."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np

from trbdyn.errors import InputError, LoadError, StepError
from trbdyn.extras.design.planning.averaged import groups_of, least_size
from trbdyn.extras.design.planning.candidates import (
    TRUE_ACCURACY,
    TRUE_NODES,
    USUAL_ACCURACY,
    USUAL_NODES,
    Candidate,
    candidates,
    numerics,
)
from trbdyn.extras.design.planning.ground import LEAST_RECORDS, Ground, run_ground
from trbdyn.extras.design.planning.probes import PATIENCE, TRANSIENT, Influence, Length, Probe, influence, probe
from trbdyn.extras.design.planning.proposal import Row, words
from trbdyn.extras.design.planning.wishes import Wishes, changed, with_effects
from trbdyn.model.assembly import ShaftBearing
from trbdyn.model.scene import Scene, Start

OF_GROUND: Final = 0.25
OF_OTHER_START: Final = 0.15
OF_PROBES: Final = 0.6
"""Shares of the effort for the run that all stands on, for one from another start, and for the probes."""
MOST_EFFORT: Final = 1.5
"""Processor time over the effort after which no further candidate is looked at: what the watch over the runs measures is not
known beforehand."""
PROBE_TURNS: Final = 100.0
"""Most turns of the shaft of a probe."""
LEAST_AVERAGING: Final = 12.0
"""Turns of the shaft of an averaging at least."""
RECORDS: Final = 40
"""Records in a turn of the shaft."""
RECORDS_OF_POCKETS: Final = 200
"""The same where averages of pocket forces are wanted, which come and go within less than a millisecond."""
TRUTH_IN_PROBES: Final = 4.0
"""Computing time of the most exact probe over that of the others, about."""
LEAST_SAVING: Final = 0.03
"""Share of the computing time that a simplification must save; more where two runs of one probe took times that differ more."""


@dataclass(frozen=True)
class Tried:
    """A candidate alone."""

    candidate: Candidate
    probe: Probe
    change: dict[str, Influence]  # against the usual nodes and tolerances, by average
    time_ratio: float  # computing time with it over that without it


@dataclass
class Seen:
    """What the runs of a plan have shown."""

    ground: Ground
    base: Probe  # with all effects, the usual nodes and tolerances
    truth: Probe  # the same, and the most exact ones
    tried: list[Tried]  # what may be simplified
    usual_error: dict[str, Influence]  # the usual against the most exact, by average
    least_saving: float  # share of the time that a simplification must save to be seen
    rows: list[Row] = field(default_factory=list)  # what was looked at beside the candidates
    notes: list[str] = field(default_factory=list)  # where the answer could be wrong


class Looker:
    """The runs of one plan."""

    def __init__(self, wishes: Wishes) -> None:
        self.wishes, scene, period = wishes, wishes.scene, wishes.period
        groups = sorted(
            {
                "cage",
                "rollers",
                "energy",
                *(group for name in wishes.names for group in groups_of(name)),
            }
        )
        pockets = any("pocket" in groups_of(name) for name in wishes.names)
        every = period / (RECORDS_OF_POCKETS if pockets else RECORDS)
        self.keep = Length(period, max(every, 1e-6), tuple(groups), wishes.effort)
        self.usual = with_effects(scene, numerics(USUAL_NODES))
        self.notes: list[str] = []
        self.began = clock.process_time()

    def look(self) -> Seen:
        """Make all runs but those of whole choices. An average that is zero, too little effort, and a scene that cannot be run
        are errors.
        """
        wishes = self.wishes
        self.ground = run_ground(self.usual, wishes.want, wishes.period, self._share(OF_GROUND), wishes.effort)
        self.notes += self.ground.notes
        zero = [name for name in wishes.names if not abs(self.ground.value[name]) > 0.0]
        if zero:
            allowed = "is zero in this scene, or does not exist, as the whirl of a cage whose orbit is below "
            allowed += f"{least_size('orbit_rms_over_cpr'):g} Cpr does not; a relative error of it cannot be planned"
            raise InputError.of("want", zero[0], allowed)
        other = self._other_start()
        seen = self._probe_all(candidates(wishes.scene, wants_cage=wishes.of_cage))
        seen.rows += [other] if other else []
        seen.notes += self.notes
        return seen

    @property
    def settle(self) -> float:
        """Time in which the motion follows a change of the model, at the begin of a probe and of the run of the plan (s)."""
        return TRANSIENT * self.length.duration

    def probe(self, effects: Mapping[str, Any], accuracy: str, cost: float = 1.0) -> Probe:
        """Run the scene with other fields of `Effects` from the state that all probes start from. `cost` is the computing time
        that is expected, over that of the usual probe.
        """
        try:
            scene = changed(self.usual, effects, self.ground.start)
        except InputError as error:
            return Probe({}, math.nan, str(error).splitlines()[0])
        return probe(scene, accuracy, replace(self.length, patience=cost * self.length.patience), self.wishes.names)

    def influences(self, other: Probe, base: Probe) -> dict[str, Influence]:
        """What differs between two probes, by the name of the average."""
        return {name: influence(other, base, self.ground.size, name) for name in self.wishes.names}

    def _share(self, share: float) -> Length:
        """A run that goes on as long as a share of the effort lasts."""
        return replace(self.keep, patience=share * self.wishes.effort)

    def _length(self, share: float, rate: float, turns: float) -> Length:
        """How long a run is that may take a share of the effort, and a number of turns of the shaft."""
        seconds = share * self.wishes.effort
        duration = min(seconds / rate, turns * self.wishes.period)
        every = max(min(self.keep.save_every, duration / LEAST_RECORDS), 1e-9)
        return replace(self.keep, duration=duration, save_every=every, patience=PATIENCE * seconds)

    def _other_start(self) -> Row | None:
        wishes, other = self.wishes, self.usual
        start = other.start or other.part.start
        if other.part.effects.bodies == "rollers_and_spacer":
            return None  # rollers at even spacing have one start
        if start.kind == "state" or wishes.effort * OF_OTHER_START / self.ground.rate < LEAST_AVERAGING * wishes.period:
            self.notes.append("no other start was tried: whether the motion depends on its start is not known")
            return None
        try:
            for place, part in self.usual.parts.items():
                whirls = start.kind == "whirl" or not part.effects.has_cage
                other = other.with_part(place, start=Start.unequal(start.seed + 1) if whirls else thrown(part))
            found = run_ground(other, wishes.want, wishes.period, self._share(OF_OTHER_START), wishes.effort)
        except (InputError, LoadError, StepError) as error:
            self.notes.append(f"a run from another start failed: {str(error).splitlines()[0]}")
            return None
        influences, kind = {}, other.part.start.kind
        for k, name in enumerate(wishes.names):
            own = self.ground.value[name]
            change = (found.value[name] - own) / self.ground.size[name]
            half = math.hypot(self.ground.scatter[k], found.scatter[k] * found.size[name] / self.ground.size[name])
            influences[name] = Influence(change, half)
            if abs(change) > max(half + self.ground.drift[k] + found.drift[k], 0.5 * wishes.size[k]):
                self.notes.append(
                    f"another start ({kind}) leads to a {name} that differs by {words(influences[name])}: "
                    "there may be two motions, or it takes longer to settle; the promise is for the start of the scene"
                )
        return Row(f"another start ({kind})", "start", influences, math.nan, "shown; the start stays as given")

    def _probe_all(self, found: list[Candidate]) -> Seen:
        """The usual and the most exact choice, and each candidate alone."""
        number = len(found) + 3 + TRUTH_IN_PROBES
        self.length = self._length(OF_PROBES / number, self.ground.rate, PROBE_TURNS)
        base = self._usable("usual", self.probe({}, USUAL_ACCURACY, PATIENCE))
        self.length = replace(self.length, steps=PATIENCE * base.steps)
        truth = self._usable("most exact", self.probe(numerics(TRUE_NODES), TRUE_ACCURACY, 2.0 * TRUTH_IN_PROBES))
        probes = [self._alone(one) for one in found]
        again = self._usable("second usual", self.probe({}, USUAL_ACCURACY))
        rate = 0.5 * (base.rate + again.rate)
        return Seen(
            ground=self.ground,
            base=replace(base, rate=rate),
            truth=truth,
            tried=[
                Tried(one, probe, self.influences(probe, base), probe.rate / rate)
                for one, probe in zip(found, probes, strict=True)
            ],
            usual_error=self.influences(base, truth),
            least_saving=max(LEAST_SAVING, abs(again.rate / base.rate - 1.0)),
        )

    def _alone(self, one: Candidate) -> Probe:
        """A candidate by itself, while the effort lasts."""
        if clock.process_time() - self.began > MOST_EFFORT * self.wishes.effort:
            return Probe({}, math.nan, "no time was left for it; allow more effort")
        return self.probe(one.effects, one.accuracy)

    def _usable(self, name: str, found: Probe) -> Probe:
        """A probe that others are compared with: an error where it failed, or a batch has no value of a wanted average."""
        if not found.failure and all(np.isfinite(batch).all() for batch in found.batches.values()):
            return found
        why = found.failure or "it is too short for averages of each of its parts"
        raise InputError.of("effort", self.wishes.effort, f"is not enough, or the {name} probe failed: {why} (s)")


def thrown(part: Scene | ShaftBearing) -> Start:
    """A start with the cage of a bearing thrown sideways, as far as a land that guides it allows."""
    bearing, guided = part.bearing, part.effects.guidance != "rollers"
    free = bearing.land.clearance - bearing.land.contact_film if guided else math.inf
    return Start.whirl(min(0.9, 0.9 * free / bearing.cage.play_radial))
