"""What tests of several folders share: on the path of every test (`pythonpath` in pyproject.toml)."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import trbdyn as trb

FRICTIONLESS = trb.Effects.standard().replace(
    bodies="rollers",
    gravity=False,
    lubrication="full_film",
    traction="none",
    rolling_resistance=False,
    rolling_pressure_force=False,
)
"""Rollers alone on films that nothing shears, with the damping that contacts have by default."""


def tolerances(rtol: float) -> dict[str, float]:
    """All tolerances in the proportions of the presets."""
    parts = {"atol_position": 1e-5, "atol_angle": 1e-3, "atol_velocity": 0.1, "atol_spin": 10.0}
    return {"rtol": rtol} | {name: part * rtol for name, part in parts.items()}


def lost(result: trb.Result) -> float:
    """Energy lost in a run (J)."""
    return float(_sum(result, "loss_")[-1])


def missing(result: trb.Result) -> float:
    """Energy at the end that was not there at the start, not put in and not lost (J)."""
    stored = result["kinetic_energy"] + result["elastic_energy"]
    return float(stored[-1] - stored[0] - _sum(result, "work_")[-1]) + lost(result)


def _sum(result: trb.Result, prefix: str) -> NDArray[np.float64]:
    """Sum of the fields of a prefix, from the start of the run on."""
    values = [np.asarray(result[field.name]) for field in result.fields if field.name.startswith(prefix)]
    return np.sum([one - one[0] for one in values], axis=0)


def assert_same_fields(one: trb.Result, other: Any) -> None:
    """Records of a bearing and those of another result, or of a dictionary, to the last bit; files are opened once for all."""
    with ExitStack() as files:
        for part in (one, other):
            if isinstance(part, trb.Result):
                files.enter_context(part._source.held_open())
        for name in other if isinstance(other, dict) else [field.name for field in other.fields]:
            np.testing.assert_array_equal(one[name], other[name], err_msg=name)


class Cut(Exception):
    """Ends a run from within, as a bug in a user's callback would."""


def cut_after(time: float) -> Callable[[trb.Simulation], None]:
    """A callback that ends a run after a time (s)."""

    def callback(sim: trb.Simulation) -> None:
        if sim.time > time:
            raise Cut

    return callback


def environment(**more: str) -> dict[str, str]:
    """For a process that finds the package where this one does."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry), **more}


def work_undrawn(*given: Any) -> None:
    """A task of the page in its process, whose report has no images and a check of some tenths of a second."""
    from trbdyn.extras.app import tasks
    from trbdyn.reporting import page
    from trbdyn.run import check

    page.image = lambda *_: ""  # type: ignore[assignment]
    check.BUDGET_S = 0.1  # type: ignore[misc]
    tasks.work(*given)


def benchmark(name: str, folder: Path, *words: str) -> tuple[dict[str, Any], str]:
    """What a script in benchmarks/ writes as JSON into a folder, and what it prints."""
    path = folder / f"{name}.json"
    script = Path(__file__).resolve().parents[2] / "benchmarks" / f"{name}.py"
    command = [sys.executable, str(script), *words, "--no-picture", "--json", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment(), check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(path.read_text(encoding="utf-8")), done.stdout
