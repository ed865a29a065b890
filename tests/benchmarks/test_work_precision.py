"""The benchmarks of accuracy and scaling run, and write what they promise; the table of estimates is whole. No timings."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trbdyn import InputError, Simulation, cases
from trbdyn.effects import Effects
from trbdyn.estimate import estimate, table
from trbdyn.run_options import ACCURACY

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
PRESET_FIGURES = {"wall_s_per_revolution", "real_time_factor", "error_cage_over_cpr", "error_cage_over_cpr_worst"}


def smoke(name: str, folder: Path) -> dict[str, Any]:
    """What a script writes when it does the least."""
    path = folder / f"{name}.json"
    command = [sys.executable, str(BENCHMARKS / f"{name}.py"), "--smoke", "--no-picture", "--json", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=_environment())
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def _environment() -> dict[str, str]:
    """Without PYTHONSAFEPATH, which would hide the scripts' own folder from them."""
    import os

    return {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}


@pytest.fixture(scope="module")
def work_precision(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return smoke("work_precision", tmp_path_factory.mktemp("work_precision"))


def test_every_entry_is_described(work_precision: dict[str, Any]) -> None:
    assert work_precision["schema"] == "trbdyn-benchmark-1"
    for row in [*work_precision["results"], work_precision["summary"]]:
        assert set(row) <= set(work_precision["columns"])


def test_presets_have_their_figures(work_precision: dict[str, Any]) -> None:
    presets = work_precision["summary"]["presets"]
    assert set(presets) == set(ACCURACY)
    for figures in presets.values():
        assert set(figures) >= PRESET_FIGURES
        assert all(np.isfinite(figures[name]) and figures[name] > 0.0 for name in PRESET_FIGURES)


def test_tighter_presets_are_more_accurate(work_precision: dict[str, Any]) -> None:
    presets = work_precision["summary"]["presets"]
    assert presets["reference"]["error_cage_over_cpr"] < 1e-3
    assert presets["reference"]["error_cage_over_cpr"] < presets["fast"]["error_cage_over_cpr"]


def test_stored_windows_are_long_enough(work_precision: dict[str, Any]) -> None:
    for window in work_precision["summary"]["windows"]["collision"]:
        assert window["window_s"] >= 4e-3
        assert window["impacts"] >= 10


def test_scaling(tmp_path: Path) -> None:
    found = smoke("scaling", tmp_path)
    sweeps = {row["sweep"] for row in found["results"]}
    assert sweeps == {"rollers", "slices", "speed", "load", "threads", "memory"}
    assert set(found["summary"]["slopes"]) >= {"rollers", "slices"}


@pytest.fixture(scope="module")
def sim() -> Simulation:
    return Simulation(cases.scene_30310(effects=Effects.paper().replace(quadrature="gauss", n_slices=8)))


class TestEstimate:
    def test_leaves_the_simulation_alone(self, sim: Simulation) -> None:
        before = sim.state
        estimate(sim, revolutions=10.0)
        assert sim.time == before.time
        assert np.array_equal(sim.state.vector, before.vector)

    def test_grows_with_the_run(self, sim: Simulation) -> None:
        found = estimate(sim, duration=0.2)
        assert found.bearing_time == pytest.approx(0.2)
        assert found.records == 2001
        assert found.wall_s > 0.0
        assert found.steps > 100
        assert found.evaluations >= found.steps
        assert 0.0 <= found.error_cage_over_cpr <= found.error_cage_over_cpr_worst
        assert "of Cpr" in str(found)

    def test_refuses_nothing_to_do(self, sim: Simulation) -> None:
        with pytest.raises(InputError, match="revolutions"):
            estimate(sim)
        with pytest.raises(InputError, match="probe"):
            estimate(sim, duration=0.1, probe=0.0)

    def test_table_falls_with_the_tolerance(self) -> None:
        for points in table()["points"].values():
            scales = [point["scale"] for point in points]
            assert scales == sorted(scales)
            assert points[0]["error_cage_over_cpr"] < points[-1]["error_cage_over_cpr"]

    def test_tighter_tolerances_promise_less_error(self) -> None:
        scene = cases.scene_30310(effects=Effects.paper().replace(quadrature="gauss", n_slices=8))
        errors = [estimate(Simulation(scene, accuracy=name), duration=1e-3).error_cage_over_cpr for name in ACCURACY]
        assert errors == sorted(errors, reverse=True)
