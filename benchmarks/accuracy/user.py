"""What a user's run takes beside the bare steps: default records of all groups, written to a file, 24 slices a contact."""

from __future__ import annotations

import tempfile
import time as clock
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from accuracy.states import Case, at_state
from trbdyn import Simulation
from trbdyn.model.scene import Scene

SLICES: Final = 24
TURNS: Final = 50.0
"""Turns of the shaft of a user's run, those of ``make demo``."""


def scene_of(case: Case) -> Scene:
    """The case as a user runs it, from its first state."""
    effects = case.scene.effects.replace(quadrature="uniform", n_slices=SLICES)
    return at_state(case.scene.replace(effects=effects), case.states[0])


def times_of(case: Case, accuracy: str, turns: float, repeats: int) -> dict[str, float]:
    """Wall times a turn (s): of the steps alone, of the run in memory, of the run with a file; the least of the repeats.

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

    def to_file() -> None:
        with tempfile.TemporaryDirectory() as folder:
            Simulation(scene, accuracy=accuracy).run(duration=length, output=Path(folder) / "run.h5")

    kinds: dict[str, Callable[[], None]] = {"bare": bare, "memory": in_memory, "file": to_file}
    found: dict[str, list[float]] = {name: [] for name in kinds}
    for _ in range(repeats):
        for name, run in kinds.items():
            began = clock.perf_counter()
            run()
            found[name].append((clock.perf_counter() - began) / turns)
    return {name: min(walls) for name, walls in found.items()}


def rows_of(case: Case, presets: dict[str, float], turns: float, repeats: int) -> list[dict[str, Any]]:
    """A row for each preset; presets: the error of the cage's centre of each."""
    rows = []
    for name, error in presets.items():
        walls = times_of(case, name, turns, repeats)
        rows.append(
            {
                "sweep": "user",
                "case": case.name,
                "name": f"user {name}",
                "preset": name,
                "n_slices": SLICES,
                "quadrature": "uniform",
                "error_cage_over_cpr": error,
                "wall_s_bare": walls["bare"],
                "wall_s_memory": walls["memory"],
                "wall_s_file": walls["file"],
                "file_over_bare": walls["file"] / walls["bare"],
            }
        )
    return rows
