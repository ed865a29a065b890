"""Runs a random scene for a bounded number of steps and judges it by what must hold whatever it is.

A run is *right* if its energy adds up and its losses and the speed of its rollers agree with those of a run with a tenth of the
tolerances of 'reference' and every force exact, *warned* if the program itself said that it is not, *stopped* if the program
ended it and said why, and *refused* if no run was begun. It is *chance* if its loss is off, but by less than the interval its
summary states, and runs of the same scene from states that are moved a little are right in the mean (`chance`). It is *wrong*
if none of this holds, and *hanging* if its steps became so small that it would not end. It is *unjudged* where the tight run did
not come to its end, so that only its energy is known to be right.

With `checked` the check of the run (`trbdyn.check`) is asked for its loss, too, as a user may do: a run whose loss is off is
*told* by it if it calls the loss biased or unsettled, or states an error that holds the true one; what it says of right runs is
kept with the verdict.
"""

from __future__ import annotations

import math
import time as clock
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

import chance
import numpy as np
import pairs
from numpy.typing import NDArray
from random_scenes import ORDINARY, Table, make

import trbdyn as trb
from trbdyn.run.options import ACCURACY
from trbdyn.run.watch import Watch

Array = NDArray[np.float64]

MOST_STEPS = 6000
"""Steps of the judged run; the others run over the same time."""
TIGHT: dict[str, Any] = {
    "integrator": "bdf",
    "accuracy": "reference",
    "rings_share": 0.0,
    **{name: 0.1 * value for name, value in ACCURACY["reference"].model_dump().items()},
}
"""Of the runs that are right: a run with 'reference' itself may be off by some per cent where rollers vibrate."""
MOST_TIGHT_STEPS = 200_000
MOST_STEPS_UNTIL_STOP = 250_000
"""Steps of a run that seems to hang, within which the program has to end it."""
PATIENCE_S = 60.0
"""Processor time after which a run is given up."""
PATIENCE_UNTIL_STOP_S = 300.0
"""The same of a run that seems to hang."""
SMALLEST_STEP = 2e-8
"""Mean step below which a run hangs (s): a thousandth of the period of a contact's vibration, 35 kHz."""

CLOSURE = 1e-2
"""Largest residual of the energy audit over dissipated work and energy turned over."""
LOSS = 0.03
"""Largest difference of the loss from that of the tight run, of the larger of both."""
SLIP = 0.02
"""Largest difference of the mean speed of the rollers from that of the tight run, over the kinematic speed."""

LEAST_PATH = 10.0
"""Path of the rollers over which their mean speed is judged at least, in circumferential plays of a pocket."""


@dataclass
class Run:
    """What a bounded run gave. Energies in J, work and loss since the start."""

    status: str = "done"
    message: str = ""
    time: float = 0.0
    steps: int = 0
    cpu_s: float = 0.0
    loss: float = math.nan
    residual: float = math.nan
    turned_over: float = math.nan
    stored: float = math.nan
    roller_speed: float = math.nan
    mean_step: float = math.nan
    warnings: tuple[str, ...] = ()
    asked: tuple[float, float] = (math.nan, math.nan)
    """Loss (J) and speed of the rollers at the time that was asked for, which lies within the last step."""

    @property
    def closure(self) -> float:
        scale = max(self.turned_over, 1e-3 * self.stored, 1e-9)
        return abs(self.residual) / scale


@dataclass
class Verdict:
    """How a scene was judged, and by what."""

    table: Table
    status: str = "right"
    broken: list[str] = field(default_factory=list)
    run: Run | None = None
    tight: Run | None = None
    check: dict[str, Any] = field(default_factory=dict)
    """What the check of the run says of its loss; empty if it was not asked, or has nothing to say."""

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


CHECKED = ("right", "warned", "chance", "wrong")


def judge(table: Table, *, checked: bool = False) -> Verdict:
    verdict = _judge_pair(table) if "arrangement" in table else _judge_scene(table)
    if checked and verdict.status in CHECKED:
        _ask_check(table, verdict)
    return verdict


def _ask_check(table: Table, verdict: Verdict) -> None:
    """Run the same time again as a user does, and ask how accurate its loss is."""
    assert verdict.run is not None
    pair = "arrangement" in table
    subject = pairs.make(table) if pair else make(table)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sim = trb.Simulation(subject, accuracy=((pairs.ORDINARY if pair else ORDINARY) | table)["accuracy"])
        try:
            found = trb.check(sim.run(duration=verdict.run.time, save_every=verdict.run.time / 100))
        except trb.TrbError as error:
            verdict.check = {"note": str(error).splitlines()[0][:200]}
            return
    losses = {name: one for name, one in found.numbers.items() if name.endswith("power_loss")}
    verdict.check = {"spent_s": found.spent_s, "pairs": found.pairs, "covered": found.covered, "note": found.note}
    if not losses:
        return
    answers = {one.answer for one in losses.values()}
    verdict.check["answer"] = next(answer for answer in ("biased", "unsettled", "clear") if answer in answers)
    verdict.check["error"] = max(one.error for one in losses.values())
    if verdict.status == "wrong" and all(text.startswith(("loss off", "moved runs")) for text in verdict.broken):
        off = _off(verdict)
        if verdict.check["answer"] != "clear" or (off is not None and off <= verdict.check["error"]):
            verdict.status = "told"


def _off(verdict: Verdict) -> float | None:
    """Difference of the loss from that of the tight run, over it."""
    run, tight = verdict.run, verdict.tight
    return None if run is None or tight is None or not tight.asked[0] else abs(run.loss / tight.asked[0] - 1.0)


def _judge_pair(table: Table) -> Verdict:
    """Two bearings on a shaft."""
    verdict = Verdict(table)
    accuracy = (pairs.ORDINARY | table)["accuracy"]
    try:
        assembly = pairs.make(table)
        trb.Simulation(assembly, accuracy=accuracy)
    except trb.TrbError as error:
        verdict.status, verdict.broken = "refused", [f"{type(error).__name__}: {str(error).splitlines()[0][:200]}"]
        return verdict
    duration = pairs.duration_of(table)
    try:
        found, _ = pairs.run(assembly, duration, accuracy=accuracy)
    except trb.TrbError as error:
        verdict.status, verdict.broken = "stopped", [str(error).splitlines()[0][:200]]
        return verdict
    verdict.run = Run(
        **{name: found[name] for name in ("status", "message", "time", "steps", "cpu_s", "loss", "stored")},
        warnings=tuple(found["warnings"]),
    )
    if found["status"] == "ended":
        verdict.status, verdict.broken = "stopped", [found["message"]]
        return verdict
    if not found["closure"] <= CLOSURE:
        verdict.broken.append(f"closure {found['closure']:.2g}")
    try:
        tight, _ = pairs.run(assembly, duration, **TIGHT, when_wrong="go_on")
        scale = max(abs(found["loss"]), abs(tight["loss"]), 1e-6 * tight["stored"], 1e-9)
        if _differ(found, tight, scale):
            ours = [found, *(pairs.run(assembly, duration, **one)[0] for one in _near(accuracy))]
            theirs = [tight, *(pairs.run(assembly, duration, **one, when_wrong="go_on")[0] for one in _near_tight())]
            _compare_means(ours, theirs, scale, verdict)
    except trb.TrbError as error:
        if not verdict.broken:
            verdict.status, verdict.broken = "unjudged", [f"tight run: {str(error).splitlines()[0][:200]}"]
            return verdict
    if verdict.broken:
        verdict.status = "warned" if verdict.run.warnings else "wrong"
    return verdict


def _near(accuracy: str) -> list[dict[str, Any]]:
    rtol = ACCURACY[accuracy].rtol
    return [{"accuracy": accuracy, "rtol": factor * rtol} for factor in NEARBY]


def _near_tight() -> list[dict[str, Any]]:
    return [TIGHT | {"rtol": factor * TIGHT["rtol"]} for factor in NEARBY]


def _differ(one: dict[str, Any], other: dict[str, Any], scale: float) -> bool:
    off = np.abs(np.subtract(one["speeds"], other["speeds"])).max()
    return bool(abs(one["loss"] - other["loss"]) > LOSS * scale or off > SLIP)


def _compare_means(ours: list[dict[str, Any]], theirs: list[dict[str, Any]], scale: float, verdict: Verdict) -> None:
    """Bodies that hit each other go their own ways: the means of runs that are as good are compared."""
    quantities = {"loss": (LOSS * scale, lambda run: run["loss"])}
    for number in range(len(ours[0]["speeds"])):
        quantities[f"speed of the rollers of bearing {number + 1}"] = (SLIP, lambda run, k=number: run["speeds"][k])
    for name, (allowed, value) in quantities.items():
        first, second = (np.array([value(run) for run in runs]) for runs in (ours, theirs))
        off = abs(first.mean() - second.mean()) - 2.0 * math.sqrt(_error_of_mean(first) + _error_of_mean(second))
        if off > allowed:
            verdict.broken.append(f"{name} off by {off / (scale if name == 'loss' else 1.0):.2g} in the mean")


def _judge_scene(table: Table) -> Verdict:
    verdict = Verdict(table)
    try:
        scene = make(table)
        sim = trb.Simulation(scene, accuracy=(ORDINARY | table)["accuracy"])
    except trb.TrbError as error:
        verdict.status, verdict.broken = "refused", [f"{type(error).__name__}: {str(error).splitlines()[0][:200]}"]
        return verdict
    whole = ORDINARY | table
    duration = whole["duration_s"] or scene_duration(scene)
    most_steps = math.inf if whole["duration_s"] else MOST_STEPS
    verdict.run = run = bounded_run(sim, duration, most_steps, pieces=whole["pieces"])
    if run.status == "error":
        verdict.status, verdict.broken = "stopped", [run.message]
        return verdict
    if run.mean_step < SMALLEST_STEP and run.time < duration:
        verdict.run = run = bounded_run(
            trb.Simulation(scene, accuracy=sim.options.accuracy),
            duration,
            MOST_STEPS_UNTIL_STOP,
            patience=PATIENCE_UNTIL_STOP_S,
        )
        if run.status != "ended" and run.mean_step < SMALLEST_STEP:
            verdict.status, verdict.broken = "hanging", [f"mean step {run.mean_step:.2g} s after {run.steps} steps"]
            return verdict
    if run.status == "ended":
        verdict.status, verdict.broken = "stopped", [run.message]
        return verdict
    if not run.closure <= CLOSURE:
        verdict.broken.append(f"closure {run.closure:.2g}")
    verdict.tight = bounded_run(trb.Simulation(scene, **TIGHT), run.time, MOST_TIGHT_STEPS, watched=False)
    if verdict.tight.status == "done":
        _compare(scene, sim, run, verdict.tight, verdict)
    elif not verdict.broken:
        verdict.status, verdict.broken = "unjudged", [f"tight run: {verdict.tight.status} {verdict.tight.message}"]
        return verdict
    if verdict.broken:
        verdict.status = "warned" if run.warnings else "wrong"
    if verdict.status == "wrong" and all(text.startswith("loss off") for text in verdict.broken):
        _look_for_chance(whole, run.time, verdict)
    return verdict


def losses(table: Table, duration: float) -> Callable[[int], tuple[float, float]]:
    """A function that gives losses of a moved scene by its own tolerances and by tight ones (J); nan where a run did not end."""

    def both(number: int) -> tuple[float, float]:
        ways = {"accuracy": table["accuracy"]}, TIGHT
        sims = [chance.move(trb.Simulation(make(table), **way), number) for way in ways]
        found = [bounded_run(sim, duration, MOST_TIGHT_STEPS, watched=False) for sim in sims]
        own, tight = (run.asked[0] if run.status == "done" else math.nan for run in found)
        return own, tight

    return both


def by_chance(off: float, error: float) -> bool:
    """Whether moved runs of a scene are right in the mean, and this is known well enough."""
    return abs(off) <= error and abs(off) + error <= LOSS


def _look_for_chance(table: Table, duration: float, verdict: Verdict) -> None:
    """It is chance where the summary's interval is as wide, and moved runs of this scene show no bias of the tolerances."""
    ways = {"accuracy": table["accuracy"]}, TIGHT
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        own, tight = (trb.Simulation(make(table), **way).run(duration=duration) for way in ways)
        if not chance.within_its_interval(own, tight):
            return
        off, error = chance.mean_difference(losses(table, duration))
    verdict.broken.append(f"moved runs: {100.0 * off:.2g} +/- {100.0 * error:.2g} % in the mean")
    if by_chance(off, error):
        verdict.status = "chance"


def _compare(scene: trb.Scene, sim: trb.Simulation, run: Run, tight: Run, verdict: Verdict) -> None:
    """Against the tight run. Bodies that hit each other go their own ways after some impacts, and each run is one of many that
    are as good: where the judged run is off, more runs with tolerances near those of both tell whether their means are.
    """

    # the last step of a tight run reaches beyond the end of the judged one, in a short run by much of it
    tight_loss, tight_speed = tight.asked
    scale = max(abs(run.loss), abs(tight_loss), 1e-3 * tight.turned_over, 1e-6 * tight.stored, 1e-9)
    found, best = _figures(run.loss, run.roller_speed), _figures(tight_loss, tight_speed)
    if _differ(found, best, scale):
        ours = [found, *_asked_of(scene, _near(sim.options.accuracy), run.time)]
        _compare_means(ours, [best, *_asked_of(scene, _near_tight(), run.time)], scale, verdict)


def _figures(loss: float, speed: float) -> dict[str, Any]:
    return {"loss": loss, "speeds": [speed]}


NEARBY = (0.5, 0.7, 1.4, 2.0)
"""Factors of the relative tolerance of runs that are as good."""


def _asked_of(scene: trb.Scene, options: list[dict[str, Any]], duration: float) -> list[dict[str, Any]]:
    runs = [bounded_run(trb.Simulation(scene, **one), duration, MOST_TIGHT_STEPS, watched=False) for one in options]
    return [_figures(*run.asked) for run in runs if run.status == "done"]


def _error_of_mean(values: np.ndarray) -> float:
    """Square of the standard error."""
    return float(np.var(values, ddof=1) / values.size) if values.size > 1 else 0.0


def bounded_run(
    sim: trb.Simulation,
    duration: float,
    most_steps: float,
    *,
    patience: float = PATIENCE_S,
    pieces: int = 1,
    watched: bool = True,
) -> Run:
    """Step for a time, at most a number of steps or a processor time; watched as so many runs of one simulation."""
    run = Run()
    first = sim.record()
    begin, turned, last = sim.time, 0.0, first
    place = sim.state
    found: list[str] = []
    length = duration / pieces
    watch = Watch(sim, sim.bearings[0], begin + length, found) if watched else None
    looks = np.linspace(0.0, duration, 17 if pieces == 1 else pieces + 1)[1:] + begin
    began, half = clock.process_time(), (begin, 0)
    # a run that is cut short is looked at as often as a whole one, so that no exchange of energy is missed
    often = max(min(most_steps, MOST_STEPS) // 16, 1)
    try:
        for look in looks:
            if pieces > 1 and watch is not None:
                watch = Watch(sim, sim.bearings[0], look, found)
            while sim.time < look and run.steps < most_steps:
                place = sim.state
                sim.step()
                run.steps += 1
                if run.steps % 4000 == 0 and _look(watch, run):
                    most_steps = run.steps
                if run.steps % often == 0:
                    now = sim.record()
                    turned += 0.5 * _turned_over(last, now)
                    last = now
                if 2 * run.steps == most_steps:
                    half = (sim.time, run.steps)
                if run.steps % 256 == 0 and clock.process_time() - began > patience:
                    most_steps = run.steps
            if _look(watch, run, final=run.steps >= most_steps or look == looks[-1] or pieces > 1):
                most_steps = run.steps
            now = sim.record()
            turned += 0.5 * _turned_over(last, now)
            last = now
            if run.steps >= most_steps:
                break
    except trb.TrbError as error:
        run.status, run.message = "error", str(error).splitlines()[0][:200]
    if run.status == "done" and sim.time < begin + duration and run.steps >= most_steps:
        run.status = "bounded"
    run.time, run.warnings = sim.time - begin, tuple(found)
    run.cpu_s = clock.process_time() - began
    run.mean_step = (sim.time - half[0]) / max(run.steps - half[1], 1)
    run.loss = _sum(last, "loss_") - _sum(first, "loss_")
    stored = _stored(last)
    run.residual = _sum(last, "work_") - _sum(first, "work_") - (stored - _stored(first)) - run.loss
    run.turned_over, run.stored = turned, stored
    run.roller_speed = _path(first, last) / _nominal_path(sim, run.time)
    run.asked = run.loss, run.roller_speed
    if run.status == "done" and run.time > duration:
        earlier = sim.record(place.vector, place.time)
        share = (begin + duration - place.time) / (sim.time - place.time)
        lost = (1.0 - share) * (_sum(earlier, "loss_") - _sum(first, "loss_")) + share * run.loss
        path = (1.0 - share) * _path(first, earlier) + share * _path(first, last)
        run.asked = lost, path / _nominal_path(sim, duration)
    return run


def _look(watch: Watch | None, run: Run, *, final: bool = False) -> bool:
    """What the program's own watch says now; whether it ends the run."""
    if watch is None:
        return False
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        reason = watch.look(final=final)
    if reason is not None:
        run.status, run.message = "ended", reason
    return reason is not None


def scene_duration(scene: trb.Scene) -> float:
    """A turn of the shaft, between 4 ms and 0.3 s; histories to their end, those that repeat at least for a period."""
    speed = scene.turning_rpm
    histories = [q for q in (scene.speed_rpm, scene.axial_load, scene.radial_load) if isinstance(q, trb.History)]
    if histories and not any(q.repeats for q in histories):
        return float(1.2 * max(q.times[-1] for q in histories))
    turn = min(max(60.0 / abs(_largest(speed)), 4e-3), 0.3)
    return float(max([turn, *(min(q.times[-1], 0.3) for q in histories)]))


def _largest(speed: float | trb.History) -> float:
    return max(map(abs, speed.values)) if isinstance(speed, trb.History) else abs(speed)


def _path(first: dict[str, Array], last: dict[str, Array]) -> float:
    """Angle by which the rollers have gone on about the bearing's axis, in the mean."""
    return float(np.mean(last["roller_orbit_angle"] - first["roller_orbit_angle"]))


def _nominal_path(sim: trb.Simulation, time: float) -> float:
    """The same in pure rolling at the largest speed. A roller may be anywhere in its pocket: a mean speed over less than some
    plays of the pocket says nothing of slip.
    """
    bearing = sim.scene.bearing
    least = LEAST_PATH * bearing.cage.play_circumferential / (0.5 * bearing.pitch_diameter)
    return max(abs(float(bearing.geometry.cage_speed_ratio) * _speed(sim)) * time, least)


def _speed(sim: trb.Simulation) -> float:
    return (_largest(sim.scene.speed_rpm) + _largest(sim.scene.outer_speed_rpm)) * math.pi / 30.0


def _sum(record: dict[str, Array], prefix: str) -> float:
    return float(sum(float(value) for name, value in record.items() if name.startswith(prefix)))


def _stored(record: dict[str, Array]) -> float:
    return float(record["kinetic_energy"]) + float(record["elastic_energy"])


def _turned_over(before: dict[str, Array], now: dict[str, Array]) -> float:
    """Energy that changed hands between two records."""
    names = [
        name for name in now if name.startswith(("loss_", "work_")) or name in ("kinetic_energy", "elastic_energy")
    ]
    return float(sum(abs(float(now[name]) - float(before[name])) for name in names))
