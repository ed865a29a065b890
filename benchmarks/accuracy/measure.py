"""Trajectories compared with a reference, wall time a revolution, and means of longer runs."""

from __future__ import annotations

import time as clock
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from accuracy.states import Case, at_state
from trbdyn import Scene, Simulation
from trbdyn.errors import RunWarning
from trbdyn.results.result import Result
from trbdyn.run.options import ACCURACY, RunOptions
from trbdyn.run.simulation import State

Array = NDArray[np.float64]
Settings = Mapping[str, Any]

BASE: Final = {"rtol": 1e-3, "atol_position": 3e-10, "atol_angle": 3e-8, "atol_velocity": 1e-4, "atol_spin": 1e-2}
"""Tolerances of scale 1; a scale multiplies all of them. Their proportions are the best of a search around them: tighter
positions and angles cost little and keep the cage's path, tighter velocities cost much, rtol hardly matters.
"""
REFERENCE_SCALE: Final = 1e-4
SAMPLE: Final = 2e-5
"""Time between compared records (s)."""
TIMING_SAVE: Final = 1e-3
"""Time between records where wall time is measured (s): output is cheap then."""
QUANTITIES: Final = ("error_cage_over_cpr", "error_load", "error_cage_speed", "error_power")
SHORT: Final = 2e-3
"""Length over which a reference by BDF is checked with the explicit method (s)."""
BATCH_RECORDS: Final = 3000
"""Records of a longer run."""
PATIENCE: Final = 0.6
"""Processor time after which a timed run is not repeated (s)."""
_GROUPS_OF_BATCHES: Final = ("time", "cage", "rollers", "energy")
_GROUPS: Final = ("time", "cage", "contacts", "energy")


def scaled(scale: float, **more: Any) -> dict[str, Any]:
    """Tolerances `BASE` times a scale, and other settings."""
    return {name: value * scale for name, value in BASE.items()} | more


def scale_of(tolerances: Settings) -> float:
    """Geometric mean of tolerances over `BASE`: the scale of settings that are not a multiple of it."""
    ratios = [float(tolerances[name]) / value for name, value in BASE.items()]
    return float(np.exp(np.mean(np.log(ratios))))


def preset_settings() -> dict[str, dict[str, Any]]:
    """Settings of the package's presets by name."""
    return {name: {"accuracy": name} for name in ACCURACY}


def preset_scale(name: str) -> float:
    """Scale of a preset's tolerances."""
    return scale_of(ACCURACY[name].model_dump())


@dataclass(frozen=True)
class Trajectory:
    """What is compared.

    Attributes
    ----------
    cage : ndarray, shape (T, 2)
        Cage centre over Cpr.
    load : ndarray, shape (T, Z)
        Loads on the outer raceway (N).
    speed : ndarray, shape (T,)
        Cage's speed of rotation (rad/s).
    lost : float
        Energy lost within the window (J).
    warnings : int
        What the watch over the run had to say.
    """

    cage: Array
    load: Array
    speed: Array
    lost: float
    warnings: int = 0


def lost_of(result: Result) -> float:
    """Energy lost in a run (J)."""
    losses = [field.name for field in result.fields if field.name.startswith("loss_")]
    return float(sum(result[name][-1] - result[name][0] for name in losses))


def trajectory_of(result: Result) -> Trajectory:
    """What is compared, out of a result."""
    return Trajectory(
        result.cage_locus(),
        result["outer_load"],
        result["cage_angular_velocity"][:, 2],
        lost_of(result),
        len(result.warnings),
    )


def run_window(scene: Scene, state: State, window: float, settings: Settings) -> Trajectory:
    """Trajectory from a state over its window."""
    sim = Simulation(at_state(scene, state), **settings)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RunWarning)
        return trajectory_of(sim.run(duration=window, save_every=SAMPLE, save_groups=_GROUPS))


def errors(found: Trajectory, reference: Trajectory) -> dict[str, float]:
    """Deviations from a reference, all relative.

    The cage's centre: largest within the window, over Cpr. Contact load: root mean square over time and rollers, over the
    mean load. Cage speed: largest, over its mean. Power: energy lost within the window.
    """
    cage = float(np.linalg.norm(found.cage - reference.cage, axis=1).max())
    load = float(np.sqrt(np.mean((found.load - reference.load) ** 2)) / reference.load.mean())
    speed = float(np.abs(found.speed - reference.speed).max() / abs(reference.speed.mean()))
    power = abs(found.lost - reference.lost) / abs(reference.lost)
    return dict(zip(QUANTITIES, (cage, load, speed, power), strict=True)) | {"warnings": found.warnings}


REFERENCES: Final[dict[str, dict[str, Any]]] = {
    "erk": {"integrator": "erk"},
    "bdf": {"max_order": 5, "rings_share": 0.0},
}
"""Methods of reference trajectories: an explicit Runge-Kutta method of order 5, and BDF of order up to 5 with exact forces."""


class References:
    """Reference trajectories of a case, at 1e-4 of the base tolerances: explicit, or by BDF where the case says so.

    `disagreement` repeats some by the other method at the same tolerances: another formula, with or without Newton's method
    and Jacobians. Where BDF is the reference, the explicit method follows it for `SHORT` only.
    """

    def __init__(self, case: Case, scene: Scene | None = None) -> None:
        self.case = case
        self.scene = case.scene if scene is None else scene
        self._method = case.reference
        settings = scaled(REFERENCE_SCALE, **REFERENCES[self._method])
        self.trajectories = tuple(
            run_window(self.scene, state, window, settings)
            for state, window in zip(case.states, case.windows, strict=True)
        )

    def errors_of(self, settings: Settings, scene: Scene | None = None) -> list[dict[str, float]]:
        """Errors of settings (and perhaps another scene) from each state."""
        scene = self.scene if scene is None else scene
        places = zip(self.case.states, self.case.windows, self.trajectories, strict=True)
        return [errors(run_window(scene, state, window, settings), against) for state, window, against in places]

    def disagreement(self, count: int) -> dict[str, float]:
        """Largest deviation of the other method at the reference's tolerances from the first `count` references."""
        other = "bdf" if self._method == "erk" else "erk"
        found = []
        for i in range(min(count, len(self.trajectories))):
            state, window, against = self.case.states[i], self.case.windows[i], self.trajectories[i]
            if other == "erk" and window > SHORT:
                window = SHORT
                settings = scaled(REFERENCE_SCALE, **REFERENCES[self._method])
                against = run_window(self.scene, state, window, settings)
            settings = scaled(REFERENCE_SCALE, **REFERENCES[other])
            found.append(errors(run_window(self.scene, state, window, settings), against))
        return {name: max(one[name] for one in found) for name in QUANTITIES}


def median_and_worst(found: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Median over states of every error, and the worst as ``<name>_worst``; warnings of all of them."""
    out = {}
    for name in QUANTITIES:
        values = np.array([one[name] for one in found])
        known = values[np.isfinite(values)]
        out[name] = float(np.median(known)) if known.size else float("nan")
        out[f"{name}_worst"] = float(known.max()) if known.size else float("nan")
    return out | {"warnings": sum(one["warnings"] for one in found)}


def wall_time(
    scene: Scene,
    states: Iterable[State],
    settings: Settings,
    revolutions: float,
    save_every: float = TIMING_SAVE,
    repeats: int = 3,
) -> dict[str, float]:
    """Wall time and work a revolution of the shaft: from each state the fastest of some repeats, then medians over states.

    What slows a repeat down is other work of the machine: the runs are the same to the bit. Up to twice as many are
    made while the fastest waits for more than a tenth of its time; a state's runs end once they took `PATIENCE`.
    """
    rows = []
    for state in states:
        runs = []
        for done in range(2 * repeats):
            runs.append(timed_run(Simulation(at_state(scene, state), **settings), revolutions, save_every))
            quietest = {name: min(one[name] for one in runs) for name in ("wall", "cpu")}
            if done + 1 >= repeats and quietest["wall"] < 1.1 * quietest["cpu"]:
                break
            if sum(one["cpu"] for one in runs) > PATIENCE:
                break
        stats = runs[0]
        rows.append(
            {
                "wall_s_per_revolution": quietest["wall"] / revolutions,
                "cpu_s_per_revolution": quietest["cpu"] / revolutions,
                "real_time_factor": stats["bearing_s"] / quietest["wall"],
                "steps_per_revolution": stats["steps"] / revolutions,
                "evaluations_per_revolution": stats["rhs_evaluations"] / revolutions,
                "jacobians_per_revolution": stats["jacobian_evaluations"] / revolutions,
            }
        )
    return {name: float(np.median([row[name] for row in rows])) for name in rows[0]}


def timed_run(sim: Simulation, revolutions: float, save_every: float) -> dict[str, float]:
    """Wall and processor time of the core alone (s), the bearing time (s), and what the integrator did."""
    end = RunOptions(revolutions=revolutions).end_time(sim.scene, sim.time)
    bearing = end - sim.time
    times = np.append(np.arange(sim.time + save_every, end - 1e-9, save_every), end)
    records = np.empty((times.size, sim.bearings[0].model.record_length))
    wall, cpu = clock.perf_counter(), clock.thread_time()
    sim._core.run(times, records, 10**9)
    wall, cpu = clock.perf_counter() - wall, clock.thread_time() - cpu
    return {"wall": wall, "cpu": cpu, "bearing_s": bearing} | sim.statistics


def least_per_call(function: Callable[[], Any], *, repeats: int = 15, least: float = 4e-3) -> float:
    """Processor time of a short call (s): the fastest of some loops, each at least `least` seconds long."""
    count = 1
    while (spent := _cpu_loop(function, count)) < least:
        count = max(2 * count, int(1.2 * count * least / max(spent, 1e-9)))
    return min(_cpu_loop(function, count) for _ in range(repeats)) / count


def _cpu_loop(function: Callable[[], Any], count: int) -> float:
    began = clock.thread_time()
    for _ in range(count):
        function()
    return clock.thread_time() - began


@dataclass(frozen=True)
class Mean:
    """A mean over batches with its 95 % confidence interval (Student's t)."""

    value: float
    half_width: float
    batches: int


def batch_mean(values: Sequence[float] | Array) -> Mean:
    """Mean of independent batches with its confidence interval."""
    from scipy.stats import t

    batches = np.asarray(values, dtype=float)
    if batches.size < 2:
        return Mean(float(batches.mean()), float("nan"), batches.size)
    half = float(t.ppf(0.975, batches.size - 1) * batches.std(ddof=1) / np.sqrt(batches.size))
    return Mean(float(batches.mean()), half, batches.size)


def long_run(case: Case, settings: Settings, revolutions: float, scene: Scene) -> dict[str, Mean]:
    """Torque, distance of the axes over Cpr and speed of the cage over that of the shaft: means of a run from each state.

    All settings start from the same states, so that slow changes of the bearing's motion are the same in all.
    """
    found: dict[str, list[float]] = {"torque": [], "whirl_radius": [], "cage_speed_ratio": []}
    for state in case.states:
        sim = Simulation(at_state(scene, state), **settings)
        every = (RunOptions(revolutions=revolutions).end_time(sim.scene, sim.time) - sim.time) / BATCH_RECORDS
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RunWarning)
            result = sim.run(revolutions=revolutions, save_every=every, save_groups=_GROUPS_OF_BATCHES)
        if not result.success:
            raise RuntimeError(result.message)
        turn = result["shaft_angle"][-1] - result["shaft_angle"][0]
        turned = result["cage_angle"] if result.has_cage else result["roller_orbit_angle"].mean(axis=1)
        found["torque"].append(float((result["work_shaft"][-1] - result["work_shaft"][0]) / turn))
        found["whirl_radius"].append(float(result.axis_distance_over_cpr.mean()) if result.has_cage else np.nan)
        found["cage_speed_ratio"].append(float((turned[-1] - turned[0]) / turn))
    return {name: batch_mean(values) for name, values in found.items()}


def pareto(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of the points (cost, error) that no other one beats in both, by rising cost."""
    front: list[int] = []
    best = np.inf
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            front.append(i)
            best = points[i][1]
    return front
