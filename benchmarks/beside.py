"""Variants of a scene beside each other in one run: time, steps, and error of the cage's centre."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

import common
import numpy as np

from trbdyn import Scene, Simulation, Start
from trbdyn.run.options import Tolerances

SHOWN = ("ms_per_turn", "steps_per_turn", "evaluations_per_turn", "error", "time_ratio")
COLUMNS = {
    "ms_per_turn": "ms: processor time of the steps of a turn of the shaft, mean of the pieces",
    "steps_per_turn": "1: steps a turn",
    "evaluations_per_turn": "1: evaluations of the equations of motion a turn",
    "error": "1: largest error of the cage's centre within a window, over Cpr, mean of the windows",
    "time_ratio": "1: time over that of the first variant",
}
WINDOWS = 16
"""States of each run from which its error is measured."""
WINDOW = 3e-3
"""Bearing time of the comparison with tight tolerances (s)."""
TIGHTER = 50.0
"""Factor of the tight tolerances."""


def open_report(
    name: str, text: str | None, columns: Mapping[str, str], arguments: Sequence[str] | None
) -> tuple[common.Report, int]:
    """The report of a benchmark that runs variants beside each other, and how many pieces each of them runs."""
    parser = common.parser(text)
    options = parser.parse_args(arguments)
    return common.Report(name, options, columns), 1 if options.smoke else 16 if options.quick else 160


def close_report(report: common.Report, shown: Sequence[str]) -> common.Report:
    """Print and keep it."""
    report.readme = common.table(report.results, shown)
    print(report.readme)
    report.finish()
    return report


def advance(simulation: Simulation, duration: float) -> float:
    """Step on for some bearing time (s); gives the processor time (s)."""
    end, begin = simulation.time + duration, time.process_time()
    while simulation.time < end:
        simulation.step()
    return time.process_time() - begin


def finer(scene: Scene, simulation: Simulation, factor: float) -> Simulation:
    """A run from the simulation's state on, its tolerances times a factor."""
    usual = simulation.options.tolerances.to_dict()
    start = scene.replace(start=Start.state(simulation.state))
    return Simulation(start, **{name: factor * usual[name] for name in Tolerances.model_fields})


def path_of(simulation: Simulation) -> Any:
    """The cage's centre within the window (m)."""
    return simulation.run(duration=WINDOW, save_every=WINDOW / 30)["cage_position"]


def error_of(scene: Scene, simulation: Simulation) -> float:
    """Largest error of the cage's centre over Cpr within the window from the simulation's state on; of one bearing alone."""
    if len(simulation.bearings) > 1:
        return float("nan")
    usual, tight = (path_of(finer(scene, simulation, factor)) for factor in (1.0, 1.0 / TIGHTER))
    return float(np.max(np.abs(tight - usual)) / scene.bearing.cage.play_radial)


def front_of(scene: Scene, factors: Sequence[float], windows: int, speed_rpm: float) -> tuple[list[float], list[float]]:
    """Time a turn (ms) and error of the cage's centre (Cpr, geometric mean), for factors of the tolerances.

    They are measured over windows from states of one run.
    """
    simulation = Simulation(scene)
    advance(simulation, 120.0 / speed_rpm)
    taken, errors = np.zeros(len(factors)), np.zeros((windows, len(factors)))
    for window in range(windows):
        advance(simulation, 4.0 * WINDOW)
        tight = path_of(finer(scene, simulation, min(factors) / TIGHTER))
        for at, factor in enumerate(factors):
            path = path_of(finer(scene, simulation, factor))
            errors[window, at] = np.max(np.abs(path - tight)) / scene.bearing.cage.play_radial
            taken[at] += advance(finer(scene, simulation, factor), WINDOW)
    turns = windows * WINDOW * speed_rpm / 60.0
    return list(1e3 * taken / turns), list(np.exp(np.mean(np.log(errors), axis=0)))


def rows_of(variants: Mapping[str, Scene | Simulation], pieces: int, speed_rpm: float) -> dict[str, dict[str, Any]]:
    """Every variant, pieces of a quarter of a turn in turns; the first one is what the others are compared with.

    The error of bearings on a shaft is not measured: nan.
    """
    first, quarter = next(iter(variants)), 15.0 / speed_rpm
    sims = {name: Simulation(one) if isinstance(one, Scene) else one for name, one in variants.items()}
    for sim in sims.values():
        advance(sim, 8 * quarter)
    before = {name: sim.statistics for name, sim in sims.items()}
    taken: dict[str, list[float]] = {name: [] for name in sims}
    errors: dict[str, list[float]] = {name: [] for name in sims}
    every = max(pieces // WINDOWS, 1)
    for piece in range(pieces):
        for name, sim in sims.items():
            taken[name].append(advance(sim, quarter))
            if piece % every == every - 1 and isinstance(sim, Simulation):
                errors[name].append(error_of(sim.scene, sim))
    out = {}
    for name, sim in sims.items():
        now, turns = sim.statistics, pieces / 4
        out[name] = {
            "ms_per_turn": 4e3 * float(np.mean(taken[name])),
            "steps_per_turn": (now["steps"] - before[name]["steps"]) / turns,
            "evaluations_per_turn": (now["rhs_evaluations"] - before[name]["rhs_evaluations"]) / turns,
            "error": float(np.mean(errors[name])) if errors[name] else float("nan"),
            "time_ratio": float(np.sum(taken[name]) / np.sum(taken[first])),
        }
    return out
