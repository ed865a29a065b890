"""The benchmark of accuracy runs and writes what it promises; the table of estimates is whole. One slow test of timings."""

from __future__ import annotations

import importlib
import itertools
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared import benchmark, environment

from trbdyn import InputError, Scene, Simulation, Start, cases
from trbdyn.model.bearing import Scatter
from trbdyn.model.effects import Effects
from trbdyn.run.estimate import _Part, _steady, case_like, estimate, table
from trbdyn.run.options import ACCURACY

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
PRESET_FIGURES = {"wall_s_per_revolution", "real_time_factor", "error_cage_over_cpr", "error_cage_over_cpr_worst"}


def smoke(name: str, folder: Path, *more: str, least: str = "--smoke") -> dict[str, Any]:
    """What a script writes when it does the least."""
    return benchmark(name, folder, least, *more)[0]


@pytest.fixture(scope="module")
def made_table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("table") / "accuracy.json"


@pytest.fixture(scope="module")
def work_precision(tmp_path_factory: pytest.TempPathFactory, made_table: Path) -> dict[str, Any]:
    return smoke("work_precision", tmp_path_factory.mktemp("work_precision"), "--make-table", str(made_table))


@pytest.mark.slow
def test_every_entry_is_described(work_precision: dict[str, Any]) -> None:
    assert work_precision["schema"] == "trbdyn-benchmark-1"
    for row in [*work_precision["results"], work_precision["summary"]]:
        assert set(row) <= set(work_precision["columns"])


@pytest.mark.slow
def test_presets_have_their_figures(work_precision: dict[str, Any]) -> None:
    presets = work_precision["summary"]["presets"]
    assert set(presets) == set(ACCURACY)
    for figures in presets.values():
        assert set(figures) >= PRESET_FIGURES
        assert all(np.isfinite(figures[name]) and figures[name] > 0.0 for name in PRESET_FIGURES)


@pytest.mark.slow
def test_tighter_presets_are_more_accurate(work_precision: dict[str, Any]) -> None:
    presets = work_precision["summary"]["presets"]
    assert presets["reference"]["error_cage_over_cpr"] < 1e-3
    assert presets["reference"]["error_cage_over_cpr"] < presets["fast"]["error_cage_over_cpr"]


@pytest.mark.slow
def test_stored_windows_are_long_enough(work_precision: dict[str, Any]) -> None:
    for window in work_precision["summary"]["windows"]["collision"]:
        assert window["window_s"] >= 4e-3
        assert window["impacts"] >= 10


def test_stored_scenes() -> None:
    from accuracy import states

    for name, definition in states.CASES.items():
        case = states.load_case(name)
        assert len(case.states) == len(case.windows) == 5
        assert min(case.windows) >= definition.least_window - 1e-12
        both = [states.at_state(scene, case.states[0]) for scene in (case.scene, states.scene_of(definition))]
        stored, defined = (Simulation(scene).derivative() for scene in both)
        assert np.allclose(stored, defined, rtol=1e-9, atol=1e-9 * np.abs(stored).max())
    points = {(one.speed_rpm, one.axial_load, one.radial_load > 0.0) for one in states.CASES.values()}
    wanted = {(3000.0, 1230.0), (3000.0, 20e3), (100.0, 4930.0), (10e3, 4930.0)}
    assert points >= {(speed, load, False) for speed, load in wanted}


@pytest.mark.slow
def test_short_table_has_every_scene_and_preset(work_precision: dict[str, Any]) -> None:
    found = {(row["case"], row["preset"]) for row in work_precision["results"] if row["sweep"] == "presets"}
    assert found == {(case, preset) for case in work_precision["summary"]["scenes"] for preset in ACCURACY}


def test_ratios_of_a_users_run_are_those_within_a_repeat() -> None:
    """The machine was half as fast in the second and third repeat."""
    from accuracy import user

    wall = {"bare": [1.0, 2.0, 2.0], "memory": [1.1, 2.2, 2.2], "file": [1.3, 2.4, 2.6]}
    processor = {"process_bare": [1.0, 2.0, 2.0], "process_memory": [1.5, 3.0, 3.2], "process_file": [2.0, 4.0, 4.4]}
    found = user.columns_of(wall | processor)
    assert found["wall_s_file"] == pytest.approx(2.4)
    assert found["memory_over_bare"] == pytest.approx(1.1)
    assert found["file_over_bare"] == pytest.approx(1.3)
    assert found["process_memory_over_bare"] == pytest.approx(1.5)
    assert found["process_file_over_bare"] == pytest.approx(2.0)
    assert set(found) == set(user.COLUMNS)


@pytest.mark.slow
def test_what_was_measured_is_written_when_it_ends_early(tmp_path: Path) -> None:
    path = tmp_path / "early.json"
    code = (
        "import sys; import work_precision as w\n"
        "def fail(*a): raise RuntimeError('power cut')\n"
        "w.slices = fail\n"
        f"w.main(['--smoke', '--no-picture', '--json', {str(path)!r}])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=300, cwd=BENCHMARKS, env=environment()
    )
    assert done.returncode != 0
    found = json.loads(path.read_text(encoding="utf-8"))
    assert any("power cut" in note for note in found["notes"])
    assert any(row["sweep"] == "presets" for row in found["results"])


@pytest.mark.slow
def test_makes_the_table_of_estimates(
    work_precision: dict[str, Any], made_table: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import importlib

    module = importlib.import_module("trbdyn.run.estimate")
    monkeypatch.setattr(module, "TABLE", made_table)
    module.table.cache_clear()
    try:
        sim = Simulation(cases.paper_30310(start=Start.whirl(0.9)), accuracy="standard")
        found = sim.estimate(duration=1e-3)
        assert found.case == "collision"
        assert np.isfinite([found.error_cage_over_cpr, found.error_power]).all()
        assert Simulation(cases.paper_30310(60.0)).estimate(duration=1e-4).case == "slow"
    finally:
        monkeypatch.undo()
        module.table.cache_clear()


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
        assert found.records == 321  # 32 a turn
        assert found.wall_s > 0.0
        assert found.steps > 100
        assert found.evaluations >= found.steps
        assert 0.0 <= found.error_cage_over_cpr <= found.error_cage_over_cpr_worst
        assert "of Cpr" in str(found)

    @pytest.mark.parametrize(
        ("fields", "case"),
        [
            ({"start": Start.whirl(0.9)}, "collision"),
            ({}, "smooth"),
            ({"radial_load": 2000.0}, "combined"),
            ({"axial_load": 900.0}, "light"),
            ({"axial_load": 30e3}, "heavy"),
            ({"speed_rpm": 20.0}, "slow"),
            ({"speed_rpm": -15e3}, "fast"),
            ({"bearing": "unequal"}, "scatter"),
        ],
    )
    def test_takes_the_scene_most_like_it(self, fields: dict[str, Any], case: str) -> None:
        from accuracy import states
        from work_precision import operating_point

        scenes = {name: operating_point(states.load_case(name)) for name in states.CASES}
        bearing = cases.rig_30310()
        if fields.get("bearing"):
            roller = bearing.roller.replace(diameter_scatter=Scatter(range=1e-6, seed=3))
            fields = {"bearing": bearing.replace(roller=roller)}
        assert case_like(Simulation(cases.paper_30310(**fields)), scenes) == case

    def test_follows_rollers_until_they_are_as_busy_as_they_stay(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Rollers begin to bounce after half a turn of a combined load. How fast the machine is does not matter."""
        scene = cases.scene_32216(5510.0, 6500.0, 13400.0)
        found = estimate(Simulation(scene), revolutions=8.0)
        taken = Simulation(scene).run(revolutions=8.0, save_every=1e-3).stats["steps"]
        assert found.steps == pytest.approx(taken, rel=0.3)
        assert found.wall_s_low <= found.wall_s <= found.wall_s_high
        ticks = itertools.count()
        module = importlib.import_module("trbdyn.run.estimate")
        monkeypatch.setattr(module.clock, "perf_counter", lambda: float(next(ticks)))
        assert estimate(Simulation(scene), revolutions=8.0).steps == found.steps

    @pytest.mark.parametrize(
        ("make", "speed", "axial", "radial", "start"),
        [
            (cases.scene_30310, 3000.0, 4930.0, 5530.0, Start.unequal(3)),
            (cases.scene_30310, 6000.0, 6500.0, 12000.0, Start.equal()),
            (cases.scene_32216, 1000.0, 4930.0, 5530.0, Start.unequal(3)),
            (cases.scene_32216, 3000.0, 4930.0, 5530.0, Start.equal()),
        ],
    )
    def test_combined_loads_cost_what_was_estimated(
        self, make: Callable[..., Scene], speed: float, axial: float, radial: float, start: Start
    ) -> None:
        """Steps and evaluations, which a busy machine does not change, lie within 1.6 times in either direction."""
        scene = make(speed, axial, radial, start=start)
        found = estimate(Simulation(scene), revolutions=12.0)
        taken = Simulation(scene).run(revolutions=12.0).stats
        assert 1 / 1.6 < found.steps / taken["steps"] < 1.6
        assert 1 / 1.6 < found.evaluations / taken["rhs_evaluations"] < 1.6

    @pytest.mark.slow
    def test_combined_loads_take_the_time_that_was_estimated(self) -> None:
        """The middle one of four scenes: what else the machine does meanwhile is in both times, but seldom alike."""
        ratios = []
        for make, speed in itertools.product((cases.scene_30310, cases.scene_32216), (1000.0, 3000.0)):
            scene = make(speed, 4930.0, 5530.0)
            found = estimate(Simulation(scene), revolutions=12.0)
            ratios.append(found.wall_s / Simulation(scene).run(revolutions=12.0).stats["wall_s"])
        assert 1 / 1.6 < float(np.median(ratios)) < 1.6, ratios

    def test_a_probe_goes_on_while_the_motion_changes(self) -> None:
        rising = [_Part(1.0, 1.0, steps, steps) for steps in (100.0, 200.0, 400.0, 400.0)]
        assert not _steady(rising)
        assert _steady(rising[2:])

    def test_refuses_nothing_to_do(self, sim: Simulation) -> None:
        with pytest.raises(InputError, match="revolutions"):
            estimate(sim)

    def test_table_falls_with_the_tolerance(self) -> None:
        for points in table()["points"].values():
            scales = [point["scale"] for point in points]
            assert scales == sorted(scales)
            assert points[0]["error_cage_over_cpr"] < points[-1]["error_cage_over_cpr"]

    def test_tighter_tolerances_promise_less_error(self) -> None:
        scene = cases.scene_30310(effects=Effects.paper().replace(quadrature="gauss", n_slices=8))
        errors = [estimate(Simulation(scene, accuracy=name), duration=1e-3).error_cage_over_cpr for name in ACCURACY]
        assert errors == sorted(errors, reverse=True)
