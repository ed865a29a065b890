"""Runs a hard scene and says what held and what did not."""

from __future__ import annotations

import math
import time as clock
from dataclasses import dataclass, field
from functools import cache
from typing import Any
from unittest.mock import patch

import numpy as np
from hard_scenes import Hard, smooth
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn.results.assembly import AssemblyResult
from trbdyn.run import running
from trbdyn.run.options import ACCURACY
from trbdyn.run.vibrations import Vibrations

Array = NDArray[np.float64]
Model = trb.Scene | trb.Assembly
Found = trb.Result | AssemblyResult

WATCH_RECORDS = 16
"""Records between looks at the count of steps."""

TIGHT: dict[str, Any] = {
    "rtol": 1e-7,
    "atol_position": 1e-12,
    "atol_angle": 1e-10,
    "atol_velocity": 1e-8,
    "atol_spin": 1e-6,
    "when_wrong": "go_on",  # steps as small as these tolerances need do not end a run; its energy is judged here
}
"""Tolerances of the runs that the others are compared with, and of comparisons between methods."""

NEAR = (0.8, 1.3)
"""Least and largest tolerances of runs that stand beside one another, in those of the first of them."""

LATE = 10.0
"""Bound of the steps a second after an event, in those of the smooth scene."""

PATIENCE = 240.0
"""Processor time beyond which a run of a scene that is not slow is given up (s)."""


@dataclass
class Verdict:
    """What a hard scene did.

    Attributes
    ----------
    status : str
        'ok', 'error' (the promised one) or 'failed'.
    broken : list of str
        What did not hold.
    steps, smallest_step, wall_s_per_revolution, closure, tolerances, path, twin, ratio
        Measured: see `Hard`; `ratio` is steps a second over those of the smooth scene.
    """

    name: str
    status: str = "ok"
    message: str = ""
    broken: list[str] = field(default_factory=list)
    steps: int = 0
    smallest_step: float = math.nan
    wall_s_per_revolution: float = math.nan
    closure: float = math.nan
    twin: float = math.nan
    tolerances: float = math.nan
    path: float = math.nan
    ratio: float = math.nan

    def demand(self, holds: bool, what: str) -> None:
        if not holds:
            self.broken.append(what)


def judge(hard: Hard, *, quick: bool = False) -> Verdict:
    """Run a scene in every way; `quick` leaves out the comparisons."""
    verdict = Verdict(hard.name)
    try:
        scene = hard.make()
        sim = trb.Simulation(scene, accuracy=hard.accuracy)
        result, watched = _run(sim, hard.duration, hard.slow)
    except Exception as error:
        if hard.error is not None and isinstance(error, hard.error) and hard.words in str(error):
            verdict.status, verdict.message = "error", f"{type(error).__name__}: {str(error).splitlines()[0]}"
        else:
            verdict.status = "failed"
            verdict.broken.append(f"{type(error).__name__}: {error}")
        return verdict
    verdict.demand(hard.error is None, f"ends without the promised {getattr(hard.error, '__name__', '')}")
    _look_at(hard, result, watched, verdict)
    if not quick and not verdict.broken:
        _compare(hard, scene, result, verdict)
    if verdict.broken:
        verdict.status = "failed"
    return verdict


def _beside(sim: trb.Simulation, duration: float, slow: bool = False) -> Found:
    """A run that another one is compared with: what its steps take from vibrations is not measured, which takes longer than the
    run.
    """
    with patch.object(Vibrations, "judge", lambda *_: None):
        return _run(sim, duration, slow)[0]


def _run(sim: trb.Simulation, duration: float, slow: bool = False) -> tuple[Found, Array]:
    watched: list[tuple[float, float]] = [(sim.time, 0.0)]

    def watch(now: trb.Simulation) -> bool:
        watched.append((now.time, now.statistics["steps"]))
        return not slow and clock.process_time() - began > PATIENCE

    began = clock.process_time()
    before = running.CHUNK_RECORDS
    running.CHUNK_RECORDS = WATCH_RECORDS
    try:
        result = sim.run(duration=duration, save_every=max(duration / 2000, 1e-5), callback=watch)
    finally:
        running.CHUNK_RECORDS = before
    return result, np.array(watched)


@cache
def _smooth_rate() -> float:
    """Steps a second of bearing time of the smooth scene."""
    sim = trb.Simulation(smooth())
    sim.run(duration=0.04)
    return float(sim.statistics["steps"]) / sim.time


def _look_at(hard: Hard, result: Found, watched: Array, verdict: Verdict) -> None:
    verdict.steps = int(result.stats["steps"])
    verdict.smallest_step = float(result.stats["smallest_step"])
    verdict.wall_s_per_revolution = float(result.stats["wall_s_per_revolution"])
    verdict.message = result.message
    verdict.demand(result.success, f"did not finish: {result.message}")
    for one in result.parts:
        for entry in one.fields:
            values = one[entry.name]
            if "film_parameter_min" in entry.name:
                values = values[~np.isnan(values)]  # no film carried a load
            verdict.demand(bool(np.isfinite(values).all()), f"{entry.name} is not finite")
            if entry.kind in ("quaternion", "roller_quat"):
                norm = np.linalg.norm(values, axis=-1)
                unit = bool(np.allclose(norm, 1.0, rtol=0.0, atol=1e-12))
                verdict.demand(unit, f"{entry.name} is not of unit length")
    verdict.closure = closure(result)
    verdict.demand(
        verdict.closure <= hard.closure, f"energy closes to {verdict.closure:.2g} only, not {hard.closure:g}"
    )
    verdict.ratio = verdict.steps / hard.duration / _smooth_rate()
    verdict.demand(
        verdict.ratio <= hard.steps, f"{verdict.ratio:.3g} times the steps of the smooth scene, not {hard.steps:g}"
    )
    if hard.calm is not None:
        after = watched[watched[:, 0] >= hard.calm]
        late = (after[-1, 1] - after[0, 1]) / (after[-1, 0] - after[0, 0]) / _smooth_rate()
        verdict.demand(
            late <= LATE, f"steps do not recover: {late:.3g} times those of the smooth scene after the event"
        )


def closure(result: Found) -> float:
    """Residual of the energy audit over what was dissipated, or a thousandth of the largest energy, or 1 uJ: the largest of the
    bearings and of the whole.
    """
    audits = [(one.energy_audit, _energy(one)) for one in result.parts]
    if isinstance(result, AssemblyResult):
        audits.append((result.energy, sum(energy for _, energy in audits)))
    return max(abs(audit.residual) / max(abs(audit.dissipated), 1e-3 * energy, 1e-6) for audit, energy in audits)


def _energy(result: Found) -> float:
    """Largest kinetic and elastic energy (J)."""
    return sum(float(np.max(np.abs(one.kinetic_energy) + np.abs(one.elastic_energy))) for one in result.parts)


def _compare(hard: Hard, scene: Model, result: Found, verdict: Verdict) -> None:
    short = min(hard.duration, hard.compared)
    tight = _beside(trb.Simulation(scene, **TIGHT), short, hard.slow)
    verdict.demand(tight.success, f"the reference did not finish: {tight.message}")
    verdict.demand(closure(tight) <= hard.closure, f"energy of the reference closes to {closure(tight):.2g} only")
    ours = [result, *_runs_beside(hard, scene, short, ACCURACY[hard.accuracy].model_dump())]
    verdict.tolerances = _difference_of_losses(ours, [tight, *_runs_beside(hard, scene, short, TIGHT)], tight.time[-1])
    verdict.demand(verdict.tolerances <= hard.tolerances, f"two tolerances differ by {verdict.tolerances:.2g}")
    if isinstance(scene, trb.Scene):
        verdict.twin = _made_by_twin(scene, min(short, 0.02))
        verdict.demand(verdict.twin <= hard.twin, f"without friction {verdict.twin:.2g} of the energy is made or lost")
    verdict.path = _difference_of_methods(hard, scene)
    verdict.demand(verdict.path <= hard.path, f"two methods differ by {verdict.path:.2g} in their speeds")


def _runs_beside(hard: Hard, scene: Model, duration: float, options: dict[str, Any]) -> list[Found]:
    """The other runs of a scene whose single runs part: with tolerances a little smaller and larger."""
    results = []
    for factor in np.linspace(*NEAR, hard.runs - 1):
        scaled = {name: value if isinstance(value, str) else factor * value for name, value in options.items()}
        results.append(_beside(trb.Simulation(scene, accuracy=hard.accuracy, **scaled), duration, hard.slow))
    return results


def _lost(result: Found, time: float) -> float:
    """Energy lost up to a time (J)."""
    here = int(np.argmin(np.abs(result.time - time)))
    lost = (one[entry.name] for one in result.parts for entry in one.fields if entry.name.startswith("loss_"))
    return sum(float(values[here]) for values in lost)


def _difference_of_losses(ours: list[Found], theirs: list[Found], time: float) -> float:
    """Relative difference of the mean loss, over the same time."""
    our, their = (float(np.mean([_lost(result, time) for result in results])) for results in (ours, theirs))
    return abs(our - their) / max(abs(our), abs(their), 1e-3 * _energy(theirs[0]), 1e-6)


def _made_by_twin(scene: trb.Scene, duration: float) -> float:
    none: dict[str, Any] = {
        "lubrication": "full_film",
        "traction": "none",
        "thermal": False,
        "rolling_resistance": False,
    }
    twin = scene.replace(effects=scene.effects.replace(**none, rolling_pressure_force=False, damping="off"))
    result = _beside(trb.Simulation(twin, **TIGHT), duration)
    residual = np.abs(result.energy_balance["residual"]).max()
    return float(residual / np.max(result.kinetic_energy + result.elastic_energy))


def _difference_of_methods(hard: Hard, scene: Model) -> float:
    second: dict[str, Any] = {"integrator": "erk"} if hard.second == "erk" else {"max_order": 5}
    speeds = []
    for options in ({"max_order": 2}, second):
        sim = trb.Simulation(scene, **TIGHT, **options)
        result = _beside(sim, min(hard.window, hard.duration))
        if not result.success:
            return math.inf
        parts = [part.reshape(-1) for one in result.parts for part in (one.roller_velocity, one.cage_velocity)]
        if isinstance(result, AssemblyResult):
            parts.append(np.gradient(result.shaft_position, result.time, axis=0).reshape(-1))
        speeds.append(np.concatenate(parts))
    scale = max(float(np.abs(speeds[0]).max()), 1e-3)
    return float(np.abs(speeds[0] - speeds[1]).max()) / scale
