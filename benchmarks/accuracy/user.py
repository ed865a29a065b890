"""What a user's run takes beside the bare steps: default records of all groups, written to a file, 24 slices a contact."""

from __future__ import annotations

import tempfile
import time as clock
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np

from accuracy.states import Case, at_state
from trbdyn import Simulation
from trbdyn.model.scene import Scene

SLICES: Final = 24
TURNS: Final = 50.0
"""Turns of the shaft of a user's run, those of ``make demo``."""

COLUMNS: Final = {
    "wall_s_bare": "s: wall time a revolution of the steps alone, 24 uniform slices, with construction",
    "wall_s_memory": "s: the same of a user's run: default records of all groups, in memory",
    "wall_s_file": "s: the same, written to a file",
    "memory_over_bare": "1: wall time of the run in memory over that of the steps alone",
    "file_over_bare": "1: wall time of the run with a file over that of the steps alone",
    "process_memory_over_bare": "1: processor time of all threads of the run in memory over that of the steps alone",
    "process_file_over_bare": "1: the same of the run with a file",
}


def scene_of(case: Case) -> Scene:
    """The case as a user runs it, from its first state."""
    effects = case.scene.effects.replace(quadrature="uniform", n_slices=SLICES)
    return at_state(case.scene.replace(effects=effects), case.states[0])


def times_of(case: Case, accuracy: str, turns: float, repeats: int) -> dict[str, list[float]]:
    """Times a turn (s) of each repeat: of the steps alone, of the run in memory, of the run with a file.

    Wall times by these names; processor times of all threads by the same with ``process_`` before them.

    Parameters
    ----------
    case : Case
        The scene, and where it begins.
    accuracy : str
        Preset.
    turns : float
        Turns of the shaft.
    repeats : int
        How often each is run, in turns.
    """
    scene = scene_of(case)
    length = turns * 60.0 / case.definition.speed_rpm

    def bare() -> None:
        simulation = Simulation(scene, accuracy=accuracy)
        end = simulation.time + length
        while simulation.time < end:
            simulation.step()

    def in_memory() -> None:
        Simulation(scene, accuracy=accuracy).run(duration=length)

    def to_file(folder: str) -> None:
        Simulation(scene, accuracy=accuracy).run(duration=length, output=Path(folder) / "run.h5")

    kinds: dict[str, Callable[[str], None]] = {
        "bare": lambda _: bare(),
        "memory": lambda _: in_memory(),
        "file": to_file,
    }
    found: dict[str, list[float]] = {f"{before}{name}": [] for before in ("", "process_") for name in kinds}
    for _ in range(repeats):
        for name, run in kinds.items():
            with tempfile.TemporaryDirectory() as folder:  # removed outside the time that counts
                began, spent = clock.perf_counter(), clock.process_time()
                run(folder)
                found[name].append((clock.perf_counter() - began) / turns)
                found[f"process_{name}"].append((clock.process_time() - spent) / turns)
    return found


def columns_of(times: dict[str, list[float]]) -> dict[str, float]:
    """The entries of a row of results, which `COLUMNS` describes, for what `times_of` gave: medians of the repeats.

    A ratio is the median of the ratios within a repeat, as the speed of a machine drifts.
    """
    named = {f"wall_s_{name}": float(np.median(times[name])) for name in ("bare", "memory", "file")}
    for before in ("", "process_"):
        bare = np.array(times[f"{before}bare"])
        named |= {
            f"{before}{name}_over_bare": float(np.median(times[f"{before}{name}"] / bare))
            for name in ("memory", "file")
        }
    return named


def rows_of(case: Case, presets: dict[str, float], turns: float, repeats: int) -> list[dict[str, Any]]:
    """A row for each preset; presets: the error of the cage's centre of each."""
    rows: list[dict[str, Any]] = []
    for name, error in presets.items():
        row = {"sweep": "user", "case": case.name, "name": f"user {name}", "preset": name}
        row |= {"n_slices": SLICES, "quadrature": "uniform", "error_cage_over_cpr": error}
        rows.append(row | columns_of(times_of(case, name, turns, repeats)))
    return rows
