"""Ask for an accuracy, get the cheapest simulation that has it.

The scene as it is given, with all effects that it has switched on, is taken for the truth; how well that model fits a real
bearing is another question. A first run of it tells how long the motion takes to settle and how much the averages scatter. Then
each simplification, alone, runs from the state that the first run has reached (`trbdyn.study.planning.probes`): what it changes,
and what it saves. The cheapest set whose errors add up to less than the wish is chosen (`trbdyn.study.planning.choice`), and it
is run once more as a whole against the most exact probe, since simplifications may act together. Where that shows a larger error
than promised, the simplification with the largest error of its own is struck out, and the choice is made again.
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import Any, Final

import numpy as np

from trbdyn.errors import InputError
from trbdyn.model.motion import History
from trbdyn.model.scene import Scene, Start
from trbdyn.results.confidence import AVERAGES
from trbdyn.run.until import groups_for
from trbdyn.study.planning.candidates import (
    TRUE_ACCURACY,
    TRUE_NODES,
    USUAL_ACCURACY,
    USUAL_NODES,
    Candidate,
    candidates,
    numerics,
)
from trbdyn.study.planning.choice import Choice, Option, Task, choose
from trbdyn.study.planning.ground import MOST_TURNS, computing_rate, run_ground
from trbdyn.study.planning.probes import PATIENCE, Influence, Length, Probe, carried_over, influence, probe
from trbdyn.study.planning.proposal import Plan, Row, words

EFFORT: Final = 15.0
"""Computing time for the probes (s)."""
OF_GROUND: Final = 0.25
OF_OTHER_START: Final = 0.15
OF_PROBES: Final = 0.6
"""Shares of it for the run that all stands on, for one from another start, and for the probes."""
PROBE_TURNS: Final = 100.0
"""Most turns of the shaft of a probe."""
LEAST_RECORDS: Final = 200
"""Records of a run at least."""
RECORDS: Final = 40
"""Records in a turn of the shaft."""
RECORDS_OF_POCKETS: Final = 200
"""The same where averages of pocket forces are wanted, which come and go within less than a millisecond."""
TRUTH_IN_PROBES: Final = 4.0
"""Computing time of the most exact probe over that of the others, about."""
LEAST_SAVING: Final = 0.03
"""Share of the computing time that a simplification must save; more where two runs of one probe took times that differ more."""
OF_CLOCK: Final = 0.2
"""Length of the run that the machine is timed with, over that of a probe."""
BASE: Final = "base"
AGAIN: Final = "base, again"
TOLD_APART: Final = 0.3
"""Half width of an influence over the wish, up to which it counts as told apart from chance."""
LEAST_AVERAGING: Final = 12.0
MOST_AVERAGING: Final = 20_000.0
"""Turns of the shaft of the averaging."""
TRIES: Final = 4
"""Choices that are run as a whole at most."""


def plan(scene: Scene, want: Mapping[str, float], *, budget: float | None = None, effort: float = EFFORT) -> Plan:
    """The cheapest simulation of a scene that gives some averages as exactly as is wanted.

    The scene with all effects that it has switched on is the truth that errors are counted from. The error is split over effects
    that are left out, nodes along the contacts, tolerances, settling, and the scatter of a mean over a run of finite length; each
    part is measured by short runs of this scene.

    Parameters
    ----------
    scene : Scene
        What is simulated; with constant speed and loads.
    want : mapping of str to float
        Wanted relative error by the name of an average of the summary, for instance ``{"torque": 0.02}`` for 2 %.
    budget : float, optional
        Most computing time of the run (s): then the most exact choice within it is made. Errors are weighed by `want`.
    effort : float
        Computing time for the probes, about (s). More effort tells smaller influences apart.

    Returns
    -------
    Plan
        Scene and options that are ready to run, what each effect gives and costs, and where the answer could be wrong. Print it.

    Raises
    ------
    InputError
        If a name or number cannot be used, or the scene has no constant speed and loads.
    LoadError
        If the bearing cannot carry the load.
    StepError
        If the scene cannot be run.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(3000.0, 4930.0)
    >>> proposal = trb.plan(scene, {"torque": 0.05}, effort=2.0)
    >>> proposal.reached
    True
    """
    names = _checked(scene, want, budget, effort)
    return _Planner(scene, {name: float(want[name]) for name in names}, budget, effort).plan()


def _checked(scene: Scene, want: Mapping[str, float], budget: float | None, effort: float) -> list[str]:
    if not want:
        raise InputError.of("want", dict(want), "must name an average with its error, for instance torque = 0.02")
    for name, wish in want.items():
        if name not in AVERAGES:
            near = get_close_matches(str(name), AVERAGES, 1)
            meant = f"did you mean {near[0]}? " if near else ""
            raise InputError.of("want", name, f"{meant}must name averages of the summary: {', '.join(AVERAGES)}")
        if isinstance(wish, bool) or not isinstance(wish, int | float) or not 0.0 < wish < 1.0:
            raise InputError.of(("want", name), wish, "must be a number above 0 and below 1: error over average (1)")
        if _of_cage(name) and scene.effects.bodies == "rollers":
            raise InputError.of("want", name, "needs a cage: effects.bodies = 'rollers_and_cage'")
    for field, value in (("budget", budget), ("effort", effort)):
        if value is not None and not (isinstance(value, int | float) and 0.0 < value < 1e7):
            raise InputError.of(field, value, "must be > 0 and < 1e7 (s)")
    for field in type(scene).model_fields:
        quantity = getattr(scene, field)
        parts = quantity if isinstance(quantity, tuple) else (quantity,)
        if any(isinstance(part, History) for part in parts):
            raise InputError.of(field, "a history", "must be constant: averages of a changing motion cannot be planned")
    if scene.speed_rpm == 0.0:
        raise InputError.of(
            "speed_rpm", 0.0, "must not be 0: averages of a bearing that stands still cannot be planned (rpm)"
        )
    return list(want)


def changed(scene: Scene, effects: Mapping[str, Any], start: Start) -> Scene:
    """A scene with other effects, and its start; without a cage none of the cage's starts is left."""
    new = scene.effects.replace(**effects)
    own = Start.equal() if start.kind == "whirl" and new.bodies == "rollers" else start
    return scene.replace(effects=new, start=own)


def _of_cage(name: str) -> bool:
    return groups_for(name)[-1] in ("cage", "pocket")


class _Clock:
    """Computing times as they would be on a machine that does nothing else: beside each probe a short run, always the same, is
    timed, and the slower it is the less a probe's time counts.
    """

    def __init__(self, timed: Callable[[], float]) -> None:
        self.timed, self.fastest = timed, math.inf

    def at_rest(self, rate: float) -> float:
        """A rate over that of the short run now."""
        now = self.timed()
        self.fastest = min(self.fastest, now)
        return rate / now


class _Planner:
    """One plan in the making."""

    def __init__(self, scene: Scene, want: dict[str, float], budget: float | None, effort: float) -> None:
        self.scene, self.want, self.budget, self.effort = scene, want, budget, effort
        self.names = list(want)
        self.wish = np.array([want[name] for name in self.names])
        assert isinstance(scene.speed_rpm, float)
        self.period = 60.0 / abs(scene.speed_rpm)
        groups = sorted({"cage", "rollers", *(group for name in self.names for group in groups_for(name))})
        pockets = any("pocket" in groups_for(name) for name in self.names)
        every = self.period / (RECORDS_OF_POCKETS if pockets else RECORDS)
        self.keep = Length(self.period, max(every, 1e-6), tuple(groups), effort)
        self.usual = scene.replace(effects=scene.effects.replace(**numerics(USUAL_NODES)))
        self.began = clock.process_time()
        self.notes: list[str] = []

    def plan(self) -> Plan:
        self.candidates = candidates(self.scene, wants_cage=any(map(_of_cage, self.names)))
        self._stand()
        self._probe_all()
        choice, found = self._choose()
        return self._proposal(choice, found)

    # ---- the runs ----

    def _length(self, share: float, rate: float, turns: float) -> Length:
        """How long a run is that may take a share of the effort, and a number of turns of the shaft."""
        seconds = share * self.effort
        duration = min(seconds / rate, turns * self.period)
        every = max(min(self.keep.save_every, duration / LEAST_RECORDS), 1e-9)
        return replace(self.keep, duration=duration, save_every=every, patience=PATIENCE * seconds)

    def _stand(self) -> None:
        """The run that all stands on, and one from another start."""
        rate = computing_rate(self.usual, self.period, replace(self.keep, patience=0.1 * self.effort))
        self.ground = run_ground(self.usual, self.want, self.period, self._length(OF_GROUND, rate, MOST_TURNS))
        self.notes += self.ground.notes
        zero = [name for name in self.names if not abs(self.ground.value[name]) > 0.0]
        if zero:
            raise InputError.of(
                "want", zero[0], "is zero in this scene, or does not exist; a relative error of it cannot be planned"
            )
        self.rows = [row for row in [self._other_start(rate)] if row]

    def _other_start(self, rate: float) -> Row | None:
        start = self.scene.start
        if start.kind == "state" or self.effort * OF_OTHER_START / rate < LEAST_AVERAGING * self.period:
            self.notes.append("no other start was tried: whether the motion depends on its start is not known")
            return None
        whirls = start.kind == "whirl" or self.usual.effects.bodies == "rollers"
        other = self.usual.replace(start=Start.unequal(start.seed + 1) if whirls else Start.whirl(0.9))
        try:
            found = run_ground(other, self.want, self.period, self._length(OF_OTHER_START, rate, MOST_TURNS))
        except Exception as error:
            self.notes.append(f"a run from another start failed: {str(error).splitlines()[0]}")
            return None
        influences = {}
        for k, name in enumerate(self.names):
            own = self.ground.value[name]
            change = (found.value[name] - own) / abs(own)
            half = math.hypot(self.ground.scatter[k], found.scatter[k])
            influences[name] = Influence(change, half)
            if abs(change) > max(half + self.ground.drift[k] + found.drift[k], 0.5 * self.wish[k]):
                self.notes.append(
                    f"another start ({other.start.kind}) leads to a {name} that differs by {words(influences[name])}: "
                    "there may be two motions, or it takes longer to settle; the promise is for the start of the scene"
                )
        return Row(
            f"another start ({other.start.kind})", "start", influences, math.nan, "shown; the start stays as given"
        )

    def _probe(self, effects: Mapping[str, Any], accuracy: str, cost: float = 1.0, share: float = 1.0) -> Probe:
        try:
            scene = carried_over(changed(self.usual, effects, Start.equal()), self.ground.start, self.usual)
        except InputError as error:
            return Probe({}, math.nan, str(error).splitlines()[0])
        length = replace(self.length, patience=self.length.patience * cost, duration=self.length.duration * share)
        return probe(scene, accuracy, length, self.names)

    def _probe_all(self) -> None:
        """The usual and the most exact choice, and each candidate alone."""
        number = (1.0 + OF_CLOCK) * (len(self.candidates) + 3) + TRUTH_IN_PROBES
        self.length = self._length(OF_PROBES / number, self.ground.rate, PROBE_TURNS)
        self.clock = _Clock(lambda: self._probe({}, USUAL_ACCURACY, share=OF_CLOCK).rate)
        self.base = self._probe({}, USUAL_ACCURACY)
        self.truth = self._probe(numerics(TRUE_NODES), TRUE_ACCURACY, 2.0 * TRUTH_IN_PROBES)
        exact = self.clock.at_rest(self.truth.rate)
        for one, name in ((self.base, "usual"), (self.truth, "most exact")):
            if one.failure:
                raise InputError.of(
                    "effort", self.effort, f"is not enough, or the {name} probe failed: {one.failure} (s)"
                )
        rates: dict[str, float] = {BASE: self.clock.at_rest(self.base.rate)}
        self.probes: dict[str, Probe] = {}
        for candidate in self.candidates:
            found = self._probe(candidate.effects, candidate.accuracy)
            rates[candidate.name] = self.clock.at_rest(found.rate)
            self.probes[candidate.name] = found
        rates[AGAIN] = self.clock.at_rest(self._probe({}, USUAL_ACCURACY).rate)
        fastest = self.clock.fastest
        self.probes = {name: replace(one, rate=rates[name] * fastest) for name, one in self.probes.items()}
        self.least_saving = max(LEAST_SAVING, abs(rates[AGAIN] / rates[BASE] - 1.0))
        self.truth = replace(self.truth, rate=exact * fastest)
        self.base = replace(self.base, rate=0.5 * (rates[BASE] + rates[AGAIN]) * fastest)

    def _influences(self, other: Probe, base: Probe) -> dict[str, Influence]:
        return {name: influence(other, base, self.ground.value, name) for name in self.names}

    # ---- the choice ----

    def _choose(self) -> tuple[Choice, Probe]:
        """Choose, run the choice as a whole, and choose again where its error is larger than that of its parts."""
        ground = self.ground
        self.usual_error = self._influences(self.base, self.truth)
        self.alone = {name: self._influences(one, self.base) for name, one in self.probes.items()}
        task = Task(
            want=self.wish,
            fixed=ground.drift,
            scatter=ground.scatter,
            window=ground.window,
            settle=ground.settle,
            least=LEAST_AVERAGING * self.period,
            most=MOST_AVERAGING * self.period,
            rate=self.base.rate,
        )
        self.task, struck = task, set[str]()
        for _ in range(TRIES):
            effects, numbers = self._options(struck)
            choice = choose(task, effects, numbers, self.budget)
            found = self._as_a_whole(choice)
            whole = self._errors(self._influences(found, self.truth))
            if found.failure or np.any(whole + ground.drift > np.maximum(choice.bounds, 0.8 * self.wish)):
                worst = self._worst(choice, [*effects, *numbers])
                if worst:
                    struck.add(worst)
                    continue
            break
        self.struck = struck
        errors = whole + ground.drift + (choice.errors - choice.bounds)
        dearer = self.clock.at_rest(found.rate) * self.clock.fastest * (ground.settle + choice.averaging)
        within = bool(np.all(errors <= self.wish * (1.0 + 1e-9))) and (
            self.budget is None or dearer <= 1.1 * self.budget
        )
        return replace(choice, bounds=whole + ground.drift, errors=errors, cost=dearer, within=within), found

    def _worst(self, choice: Choice, options: list[Option]) -> str:
        """The simplification of a choice with the largest error over its wish; empty if there is none."""
        made = [one for one in options if one.name in (*choice.left_out, choice.numerics) and one.name not in KEPT]
        return max(made, key=lambda one: float(np.max(one.bounds / self.wish))).name if made else ""

    def _errors(self, found: Mapping[str, Influence]) -> np.ndarray:
        """Bounds of errors; where chance hides a small one, the difference that was seen counts alone, and that is said."""
        bounds = []
        for name, wish in self.want.items():
            one = found[name]
            hidden = one.half_width > TOLD_APART * wish and abs(one.change) <= one.half_width
            bounds.append(abs(one.change) if hidden else one.bound)
        return np.array(bounds)

    def _options(self, struck: set[str]) -> tuple[list[Option], list[Option]]:
        def of(name: str) -> Option:
            bounds = np.array([self.alone[name][wanted].bound for wanted in self.names])
            return Option(name, bounds, self.probes[name].rate / self.base.rate)

        def fine(name: str) -> bool:
            bound_fits = all(self.alone[name][wanted].bound <= self.want[wanted] for wanted in self.names)
            return bound_fits and name not in struck and not self.probes[name].failure

        kinds = {one.name: one.kind for one in self.candidates}
        effects = [of(name) for name, kind in kinds.items() if kind == "effect" and fine(name)]
        effects = [one for one in effects if one.time_ratio < 1.0 - self.least_saving]
        error = self._errors(self.usual_error)
        usual = Option(USUAL, error, 1.0)
        coarse = [usual, *(of(name) for name, kind in kinds.items() if kind in ("nodes", "as given") and fine(name))]
        loose = [of(name) for name, kind in kinds.items() if kind == "tolerances" and fine(name)]
        own = [one if one is usual else replace(one, bounds=one.bounds + error) for one in coarse]
        both = [
            Option(f"{one.name}{AND}{other.name}", one.bounds + other.bounds, one.time_ratio * other.time_ratio)
            for one in own
            for other in loose
        ]
        exact = Option(EXACT, np.zeros(self.wish.size), self.truth.rate / self.base.rate)
        return effects, [one for one in [*own, *both] if one.name not in struck] + [exact]

    def _made(self, choice: Choice) -> list[Candidate]:
        names = {*choice.left_out, *choice.numerics.split(AND)}
        return [one for one in self.candidates if one.name in names]

    def _settings(self, choice: Choice) -> tuple[dict[str, Any], str]:
        """Fields of effects, and the preset of the tolerances."""
        if choice.numerics == EXACT:
            changes, accuracy = numerics(TRUE_NODES), TRUE_ACCURACY
        else:
            changes, accuracy = numerics(USUAL_NODES), USUAL_ACCURACY
        for one in self._made(choice):
            changes |= one.effects
            accuracy = one.accuracy if one.kind == "tolerances" else accuracy
        return changes, accuracy

    def _as_a_whole(self, choice: Choice) -> Probe:
        return self._probe(*self._settings(choice), cost=TRUTH_IN_PROBES if choice.numerics == EXACT else 1.0)

    # ---- the proposal ----

    def _proposal(self, choice: Choice, found: Probe) -> Plan:
        ground, task = self.ground, self.task
        changes, accuracy = self._settings(choice)
        made = {one.name for one in self._made(choice)}
        rows = [*self.rows, self._row_of_the_usual(choice)]
        rows += [self._row(one, one.name in made) for one in self.candidates]
        given = next((self.probes[one.name].rate for one in self.candidates if one.kind == "as given"), self.base.rate)
        exact = choose(task, [], [Option(EXACT, np.zeros(self.wish.size), self.truth.rate / self.base.rate)])
        length = ground.settle + choice.averaging
        self._note_what_is_hidden(found)
        settling, statistics = ground.drift, choice.errors - choice.bounds
        parts = {
            name: {
                "model and numerics": float(choice.bounds[k] - settling[k]),
                "settling": float(settling[k]),
                "statistics": float(statistics[k]),
            }
            for k, name in enumerate(self.names)
        }
        return Plan(
            scene=changed(self.scene, changes, self.scene.start),
            accuracy=accuracy,
            duration=length,
            settle=ground.settle,
            save_every=self.keep.save_every,
            save_groups=self.keep.groups,
            want=dict(self.want),
            promised={name: float(choice.errors[k]) for k, name in enumerate(self.names)},
            parts=parts,
            value=dict(ground.value),
            reached=choice.within,
            rows=tuple(rows),
            wall_s=choice.cost,
            wall_s_everything=exact.cost,
            wall_s_given=given * length if math.isfinite(given) else math.nan,
            spent_s=clock.process_time() - self.began,
            budget=self.budget,
            warnings=tuple(dict.fromkeys(self.notes)),
        )

    def _note_what_is_hidden(self, found: Probe) -> None:
        for name, one in self._influences(found, self.truth).items():
            if one.half_width > TOLD_APART * self.want[name]:
                self.notes.append(
                    f"the error of model and numerics in {name} is hidden by chance: {words(one)}, as the motions of two probes "
                    "part; the promise counts what was seen. What could not be told apart is kept; more effort tells more"
                )
            elif one.moving:
                self.notes.append(f"the influence of the choice on {name} still changed at the end of the probes")
        follow = self.length.duration
        if not self.ground.creep_time <= follow:
            creep = "an unknown time" if math.isnan(self.ground.creep_time) else f"{self.ground.creep_time:.2g} s"
            self.notes.append(
                f"the probes followed each change for {follow:.2g} s, and the rollers creep within {creep}: an effect that "
                "acts only by this creep, on the whirl of the cage for instance, is not seen"
            )

    def _row_of_the_usual(self, choice: Choice) -> Row:
        taken = choice.numerics == USUAL
        ratio = self.base.rate / self.truth.rate
        said = "taken" if taken else f"taken: {choice.numerics}" if choice.numerics == EXACT else "not needed"
        name = f"{USUAL}, against {TRUE_NODES} and '{TRUE_ACCURACY}'"
        return Row(name, "truth", self.usual_error, ratio, said, taken)

    def _row(self, one: Candidate, made: bool) -> Row:
        found, alone = self.probes[one.name], self.alone[one.name]
        ratio = found.rate / self.base.rate if not found.failure else math.nan
        return Row(one.name, one.kind, alone, ratio, self._decision(one, made, ratio), made)

    def _decision(self, one: Candidate, made: bool, ratio: float) -> str:
        found, alone = self.probes[one.name], self.alone[one.name]
        seen = [name for name in self.names if abs(alone[name].change) > alone[name].half_width]
        if found.failure:
            return f"cannot be run: {found.failure}"
        if one.kind == "off":
            return f"off in the scene, stays off{', though it changes ' + ', '.join(seen) if seen else ''}"
        taken, kept = ("left out", "kept") if one.kind == "effect" else ("taken", "not taken")
        if made:
            return taken
        large = [name for name in self.names if alone[name].bound > self.want[name]]
        if set(large) & set(seen):
            return f"{kept}: it matters for {', '.join(name for name in large if name in seen)}"
        if large:
            return f"{kept}: not told apart from chance in {', '.join(large)}"
        if one.name in self.struck:
            return f"{kept}: together with the others the error was larger than the wish"
        if one.kind == "effect" and ratio >= 1.0 - self.least_saving:
            return f"{kept}: it saves no time"
        return f"{kept}: another choice is cheaper"


AND: Final = " and "
USUAL: Final = f"{USUAL_NODES} nodes, tolerances '{USUAL_ACCURACY}'"
EXACT: Final = f"{TRUE_NODES} nodes, tolerances '{TRUE_ACCURACY}'"
KEPT: Final = (USUAL, EXACT)
"""Choices that are never struck out."""
