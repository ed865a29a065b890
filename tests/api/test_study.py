"""Parameter studies: what is run, on which executor, what is kept, what is skipped."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trbdyn as trb
from trbdyn import study
from trbdyn.base.shipped import CASES
from trbdyn.cli import main
from trbdyn.errors import FileError, InputError, StepError, TrbError
from trbdyn.extras.study import executors, runner, work
from trbdyn.extras.study.definition import Base, put, split_path
from trbdyn.extras.study.gather import unit_of
from trbdyn.extras.study.index import INDEX, Entry, Index, read_lines

OPTIONS = study.RunOptions(duration=1e-3, save_every=5e-5, save_groups=("cage", "torque", "power"))
FAST = {"effects.n_slices": 4}


def small(**changes: Any) -> study.Study:
    """Four short cases: two speeds from two starts."""
    axes = {
        "scene.speed_rpm": [1000.0, 3000.0],
        "start": {"equal": {"start.kind": "equal"}, "whirl": {"start.kind": "whirl"}},
    }
    return study.grid(trb.cases.paper_30310(), axes | changes.pop("axes", {}), OPTIONS, fixed=FAST | changes)


def records(folder: Path) -> dict[str, dict[str, np.ndarray]]:
    """Every field of every result file of a folder."""
    found = {}
    for path in sorted(folder.glob("*.h5")):
        result = trb.load(path)
        with result._source.held_open():
            found[path.name] = {field.name: result[field.name] for field in result.fields} | {"end": result.final_state}
    return found


def same(one: dict[str, Any], other: dict[str, Any]) -> bool:
    return one.keys() == other.keys() and all(
        one[file].keys() == other[file].keys()
        and all(np.array_equal(one[file][name], other[file][name], equal_nan=True) for name in one[file])
        for file in one
    )


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, Path]:
    folder = tmp_path_factory.mktemp("serial")
    return study.run(small(), folder, executor="serial"), folder


class TestOverrides:
    def test_paths(self) -> None:
        assert split_path("scene.gravity[1]") == ("scene", "gravity", 1)
        assert split_path("bearing.cage.other_pockets[2].index") == ("bearing", "cage", "other_pockets", 2, "index")
        assert split_path("lubricant") == ("lubricant",)

    @pytest.mark.parametrize("path", ["", "speed_rpm", "scene", "scene..x", "scene.gravity[y]", "other.x", "scene.x-y"])
    def test_paths_that_lead_nowhere(self, path: str) -> None:
        with pytest.raises(InputError):
            split_path(path)

    def test_put(self) -> None:
        tables: dict[str, Any] = {"scene": {"gravity": [0.0, -9.8, 0.0], "speed_rpm": 1.0}}
        put(tables, "scene.gravity[1]", -1.0)
        put(tables, "bearing.cage.mass", 0.3)
        assert tables == {"scene": {"gravity": [0.0, -1.0, 0.0], "speed_rpm": 1.0}, "bearing": {"cage": {"mass": 0.3}}}
        for path in ("scene.gravity[3]", "scene.speed_rpm.x", "scene.displacement[0]"):
            with pytest.raises(InputError):
                put(tables, path, 1.0)

    def test_a_scene_as_base_comes_back_unchanged(self) -> None:
        for scene in (
            trb.cases.scene_30310(effects=trb.Effects.standard(), radial_load=100.0),
            trb.cases.scene_32216(start=trb.Scene.model_fields["start"].default),
        ):
            built, run = Base.of(scene, OPTIONS).build({})
            assert built == scene
            assert built.fingerprint == scene.fingerprint
            assert run == OPTIONS

    def test_values(self) -> None:
        base = Base.of(trb.cases.paper_30310(), OPTIONS)
        history = trb.History.ramp(0.0, 1.0, 1000.0, 2000.0)
        oil = trb.lubricants.vg100(80.0)
        overrides = {
            "scene.speed_rpm": history,
            "bearing.cage.mass": np.float64(0.3),
            "lubricant": oil,
            "run.rtol": 1e-4,
        }
        scene, run = base.build(overrides)
        assert scene.speed_rpm == history
        assert scene.bearing.cage.mass == 0.3
        assert scene.lubricant == oil
        assert run.rtol == 1e-4
        scene, _ = base.build({"scene.gravity[1]": 0.0, "effects.friction.speed_floor": 1e-4})
        assert scene.gravity == (0.0, 0.0, 0.0)
        assert scene.effects.friction.speed_floor == 1e-4

    def test_an_oil_at_another_temperature_is_another_oil(self) -> None:
        base = Base.of(trb.cases.paper_30310(), OPTIONS)
        scene, _ = base.build({"lubricant.temperature_c": 80.0})
        assert scene.lubricant == trb.lubricants.vg100(80.0)
        numbers = trb.lubricants.vg100().replace(viscosity=0.05)
        with pytest.raises(InputError, match="viscosities"):
            Base.of(trb.cases.paper_30310(lubricant=numbers), OPTIONS).build({"lubricant.temperature_c": 80.0})
        scene, _ = base.build({"lubricant.oil": "vg100", "lubricant.temperature_c": 80.0})
        assert scene.lubricant == trb.lubricants.vg100(80.0)
        scene, _ = Base.of("rig_30310").build({"lubricant.temperature_c": 80.0})
        assert scene.lubricant == trb.lubricants.vg100(80.0)


class TestDefinition:
    def test_grid(self) -> None:
        made = small(axes={"bearing.cage.mass": [0.1, 0.2, 0.4]})
        assert made.shape == (2, 2, 3)
        assert [axis.name for axis in made.axes] == ["speed_rpm", "start", "mass"]
        scene = made.cases[-1].scene
        assert scene is not None
        assert (scene.speed_rpm, scene.start.kind, scene.bearing.cage.mass) == (3000.0, "whirl", 0.4)
        assert len({case.fingerprint for case in made.cases}) == 12
        assert len({case.name for case in made.cases}) == 12

    def test_names_of_axes_that_would_be_the_same(self) -> None:
        axes = {"lubricant.dicke.a": [300.0], "lubricant.dicke.b": [3.0], "start.seed": [1, 2]}
        made = study.grid(trb.cases.paper_30310(), axes, OPTIONS)
        assert [axis.name for axis in made.axes] == ["a", "b", "seed"]
        scatter = "bearing.roller.diameter_scatter"
        both = {f"{scatter}.seed": [3, 4], "start.seed": [1, 2]}
        made = study.grid(trb.cases.paper_30310(), both, OPTIONS, fixed={scatter: {"range": 1e-6}})
        assert [axis.name for axis in made.axes] == [f"{scatter}.seed", "start.seed"]

    @pytest.mark.parametrize(
        "axes",
        [
            {"scene.speed_rpm": []},
            {"scene.speed_rpm": [1000.0, 1000.0]},
            {"speed": [1000.0]},
            {"scene.speed": [1000.0]},
            {"bearing.cage.mas": [0.1, 0.2]},
        ],
    )
    def test_grids_that_cannot_be_used(self, axes: dict[str, Any]) -> None:
        with pytest.raises(InputError):
            study.grid(trb.cases.paper_30310(), axes, OPTIONS)

    def test_a_list_is_any_iterable(self) -> None:
        made = study.cases(trb.cases.paper_30310(), ({"scene.speed_rpm": 500.0 * k} for k in (1, 2, 3)), OPTIONS)
        assert [case.parameters for case in made.cases] == [{"speed_rpm": 500.0 * k} for k in (1, 2, 3)]
        assert made.shape == (3,)

    @given(count=st.integers(1, 12), seed=st.integers(0, 2**32))
    @settings(max_examples=3, deadline=None)
    def test_random_draws_are_seeded_and_keep_the_first(self, count: int, seed: int) -> None:
        ranges = {
            "bearing.cage.mass": {"low": 0.05, "high": 0.8, "scale": "log"},
            "scene.axial_load": (1230.0, 4930.0),
            "start.seed": (0, 5),
        }
        scene = trb.cases.paper_30310()
        made = study.random(scene, ranges, count, seed, OPTIONS)
        more = study.random(
            scene, {**ranges, "scene.speed_rpm": {"choice": [1000.0, 2000.0]}}, count + 2, seed, OPTIONS
        )
        for one, other in zip(made.cases, more.cases, strict=False):
            assert one.parameters.items() <= other.parameters.items()
            assert 0.05 <= one.parameters["mass"] <= 0.8
            assert one.parameters["seed"] in range(6)
        assert study.random(scene, ranges, count, seed, OPTIONS) == made

    @pytest.mark.parametrize("entry", [(2.0, 1.0), {"low": 1.0}, {"low": -1.0, "high": 1.0, "scale": "log"}])
    def test_ranges_that_cannot_be_used(self, entry: Any) -> None:
        with pytest.raises(InputError):
            study.random(trb.cases.paper_30310(), {"bearing.cage.mass": entry}, 2, 1, OPTIONS)

    def test_the_fingerprint_is_scene_and_options(self) -> None:
        scene = trb.cases.paper_30310()
        print_ = study.fingerprint(scene, OPTIONS)
        assert print_ == study.fingerprint(trb.cases.paper_30310(), OPTIONS.replace())
        assert print_ != study.fingerprint(scene, OPTIONS.replace(duration=5e-3))
        assert print_ != study.fingerprint(trb.cases.paper_30310(2000.0), OPTIONS)


class TestExecutors:
    @pytest.mark.usefixtures("workers")
    @pytest.mark.parametrize("kind", ["threads", pytest.param("processes", marks=pytest.mark.slow)])
    def test_threads_and_processes_equal_serial(self, serial: tuple[Any, Path], tmp_path: Path, kind: str) -> None:
        data, folder = serial
        other = study.run(small(), tmp_path, executor=kind)
        assert same(records(folder), records(tmp_path))
        deterministic = [name for name in data.data_vars if not str(name).startswith("wall")]
        assert other[deterministic].identical(data[deterministic])

    @pytest.mark.slow
    def test_a_dask_cluster_equals_serial(self, serial: tuple[Any, Path], tmp_path: Path) -> None:
        distributed = pytest.importorskip("dask.distributed")
        with (
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
            distributed.Client(cluster) as client,
        ):
            data = study.run(
                small(), tmp_path, executor=client, observables={"records": len, "last": lambda r: r.time[-1]}
            )
            assert client.submit(int, 1).result() == 1
        assert same(records(serial[1]), records(tmp_path))
        assert np.all(data.records == 21)
        assert np.all(data["last"] == OPTIONS.duration)

    @pytest.mark.slow
    def test_any_executor(self, serial: tuple[Any, Path], tmp_path: Path) -> None:
        with ThreadPoolExecutor(2) as pool:
            study.run(small(), tmp_path, executor=pool)
            assert pool.submit(int, 1).result() == 1
        assert same(records(serial[1]), records(tmp_path))

    def test_what_is_no_executor(self) -> None:
        for arguments in ({"executor": "cluster"}, {"executor": 3}, {"workers": 0}):
            with pytest.raises(InputError):
                study.run(small(), **arguments)

    def test_workers_are_limited_to_the_cores(self, monkeypatch: pytest.MonkeyPatch) -> None:
        asked: list[int] = []

        class Pool(ThreadPoolExecutor):
            def __init__(self, count: int) -> None:
                asked.append(count)
                super().__init__(count)

        monkeypatch.setattr(executors, "ThreadPoolExecutor", Pool)
        list(executors.execute(lambda task, _: task, [1, 2], "threads", 10_000))
        assert asked == [executors.cores()]

    @pytest.fixture
    def module(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
        """Work that a spawned process can import."""
        (tmp_path / "study_work.py").write_text(
            "import os, signal, time\n"
            "def deadly(task, stopped):\n"
            "    if task == 'die':\n"
            "        os.kill(os.getpid(), signal.SIGKILL)\n"
            "    if task == 'raise':\n"
            "        raise ValueError(task)\n"
            "    return 2 * task\n"
            "def patient(task, stopped):\n"
            "    end = time.monotonic() + 60\n"
            "    while task and not stopped() and time.monotonic() < end:\n"
            "        time.sleep(0.01)\n"
            "    return task\n"
        )
        monkeypatch.syspath_prepend(tmp_path)
        import study_work

        yield study_work
        sys.modules.pop("study_work", None)

    @pytest.mark.usefixtures("workers")
    def test_a_process_that_dies_takes_only_its_own_task(self, module: Any) -> None:
        tasks = [1, 2, "die", 3, "raise", 4, "die", 5]
        outcomes = list(executors.execute(module.deadly, tasks, "processes", 2))
        assert len(outcomes) == len(tasks)
        assert sorted(o.value for o in outcomes if o.error is None) == [2, 4, 6, 8, 10]
        failed = [o for o in outcomes if o.error is not None]
        assert sorted(str(o.task) for o in failed) == ["die", "die", "raise"]
        assert all(isinstance(o.error, TrbError if o.task == "die" else ValueError) for o in failed)

    @pytest.mark.usefixtures("workers")
    @pytest.mark.parametrize("kind", ["threads", "processes"])
    def test_closing_stops_what_is_under_way(self, module: Any, kind: str) -> None:
        began = time.monotonic()
        outcomes = executors.execute(module.patient, [0, 1, 2, 3], kind, 2)
        assert next(outcomes).value == 0
        outcomes.close()
        assert time.monotonic() - began < 30


class TestFailures:
    def test_failures_are_recorded_and_the_rest_goes_on(self, tmp_path: Path) -> None:
        loads = [4930.0, -1.0, 1230.0]
        made = study.cases(trb.cases.paper_30310(), [{"scene.axial_load": load} for load in loads], OPTIONS)
        data = study.run(made, tmp_path, executor="serial", observables={"top": _top})
        assert data.status.values.tolist() == ["done", "failed", "done"]
        assert "axial_load" in str(data.message.values[1])
        assert np.isnan(data.torque.values[1])
        assert np.isfinite(data.torque.values[[0, 2]]).all()
        assert data.file.values[1] == ""
        assert data.axial_load.values.tolist() == loads
        assert {entry.status for entry in read_lines(tmp_path / INDEX)} == {"done", "failed"}

    def test_a_step_that_fails(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        real = work.simulation

        def failing(scene: Any, run: Any) -> Any:
            sim = real(scene, run)
            if scene.speed_rpm == 3000.0:
                ran = sim.run

                def run_(**options: Any) -> Any:
                    ran(**options)
                    raise StepError("roller 3 : went astray", time=1e-3, body="roller 3")

                sim.run = run_
            return sim

        monkeypatch.setattr(work, "simulation", failing)
        data = study.run(small(), tmp_path, executor="serial")
        assert data.sel(speed_rpm=3000.0).status.values.tolist() == ["failed", "failed"]
        assert data.sel(speed_rpm=1000.0).status.values.tolist() == ["done", "done"]
        assert "went astray" in str(data.message.values[1, 0])
        files = [str(name) for name in data.sel(speed_rpm=3000.0).file.values]
        assert all(name.endswith(".failed.h5") and (tmp_path / name).is_file() for name in files)
        monkeypatch.setattr(work, "simulation", real)
        assert np.all(study.run(small(), tmp_path, executor="serial").status == "done")

    def test_an_observable_that_fails(self, tmp_path: Path) -> None:
        wrong = {"wrong": lambda result: 1 / 0, "right": lambda result: float(len(result))}
        data = study.run(small(), tmp_path, executor="threads", observables=wrong)
        assert np.all(data.status == "done")
        assert "the observable 'wrong' failed: ZeroDivisionError" in str(data.message.values[0, 0])
        assert np.all(data["right"] > 1)
        assert np.all(np.isfinite(data["mean_friction_torque"] if "mean_friction_torque" in data else data["wall_s"]))
        wrong["wrong"] = lambda result: 7.0
        again = study.run(small(), tmp_path, executor="threads", observables=wrong)
        assert np.all(again["wrong"] == 7.0)
        assert "failed" not in str(again.message.values[0, 0])

    def test_a_lambda_for_processes_is_told_at_once(self) -> None:
        with pytest.raises(InputError, match="top level of a module") as caught:
            study.run(small(), observables={"top": lambda result: 1.0})
        assert caught.value.field == "observables.top"

    def test_a_number_in_place_of_values(self) -> None:
        with pytest.raises(InputError, match="must be a sequence of values") as caught:
            study.grid(trb.cases.paper_30310(), {"bearing.cage.mass": 0.1}, OPTIONS)
        assert caught.value.field == "bearing.cage.mass"

    def test_nothing_half_written_stays(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def interrupted(scene: Any, run: Any) -> Any:
            raise KeyboardInterrupt

        monkeypatch.setattr(work, "simulation", interrupted)
        with pytest.raises(KeyboardInterrupt):
            study.run(small(), tmp_path, executor="serial")
        assert [path.name for path in tmp_path.iterdir()] == []

    def test_a_folder_that_cannot_be_used(self, tmp_path: Path) -> None:
        (tmp_path / "file").write_text("")
        with pytest.raises(FileError):
            study.run(small(), tmp_path / "file", executor="serial")


def _top(result: Any) -> float:
    return float(result.cage_position[:, 1].max())


class TestResume:
    @pytest.fixture
    def counted(self, monkeypatch: pytest.MonkeyPatch) -> list[str]:
        ran: list[str] = []

        def counting(task: Any, stopped: Any) -> Any:
            ran.append(task.fingerprint)
            return work.run_case(task, stopped)

        monkeypatch.setattr(runner, "run_case", counting)
        return ran

    def test_resume_skips_what_is_done(self, tmp_path: Path, counted: list[str]) -> None:
        made = small()
        first = study.run(made, tmp_path, executor="serial")
        assert len(counted) == 4
        again = study.run(made, tmp_path, executor="serial")
        assert len(counted) == 4
        assert again.identical(first)
        (tmp_path / str(first.file.values[0, 1])).unlink()
        study.run(made, tmp_path, executor="serial")
        assert len(counted) == 5
        study.run(small(axes={"bearing.cage.mass": [0.2, 0.3]}), tmp_path, executor="serial")
        assert len(counted) == 9, "0.2 kg is the base: those cases are done"
        study.run(made, tmp_path, executor="serial", resume=False)
        assert len(counted) == 13
        assert study.collect(made, tmp_path).status.values.tolist() == [["done"] * 2] * 2

    def test_observables_asked_for_later_are_read_from_the_files(self, tmp_path: Path, counted: list[str]) -> None:
        study.run(small(), tmp_path, executor="serial")
        data = study.run(
            small(), tmp_path, executor="serial", observables={"top": _top, "path": lambda r: r.cage_position[:3]}
        )
        assert len(counted) == 4
        assert np.isfinite(data.top).all()
        assert data.path.shape == (2, 2, 3, 3)

    def test_cases_that_are_the_same_are_run_once(self, tmp_path: Path, counted: list[str]) -> None:
        made = study.cases(
            trb.cases.paper_30310(), [{"scene.speed_rpm": 1000.0}, {}, {"scene.speed_rpm": 3000.0}], OPTIONS
        )
        data = study.run(made, tmp_path, executor="serial")
        assert len(counted) == 2
        assert data.torque.values[1] == data.torque.values[2]

    def test_a_damaged_index_costs_only_its_line(self, tmp_path: Path, counted: list[str]) -> None:
        study.run(small(), tmp_path, executor="serial")
        path = tmp_path / INDEX
        lines = path.read_bytes().splitlines(keepends=True)
        path.write_bytes(b"".join(lines[:3]) + lines[3][: len(lines[3]) // 2])
        study.run(small(), tmp_path, executor="serial")
        assert len(counted) == 5
        assert len(list(read_lines(path))) == 4

    OVERRIDES = tuple(
        {"scene.speed_rpm": 1000.0 * (1 + k % 2), "bearing.cage.mass": 0.1 * (1 + k // 2)} for k in range(4)
    )

    def test_the_order_of_cases_does_not_matter(self, tmp_path: Path) -> None:
        scene = trb.cases.scene_30310(effects=trb.Effects.minimal())
        order, folders = [2, 0, 3, 1], [tmp_path / "straight", tmp_path / "mixed"]
        straight, mixed = (
            study.run(study.cases(scene, overrides, OPTIONS), folder, executor=executor)
            for overrides, folder, executor in zip(
                (self.OVERRIDES, [self.OVERRIDES[k] for k in order]), folders, ("serial", "threads"), strict=True
            )
        )
        assert same(*map(records, folders))
        for name in (n for n in straight.variables if not str(n).startswith("wall") and n != "case"):
            np.testing.assert_array_equal(straight[name].values[order], mixed[name].values, err_msg=str(name))


class TestDataset:
    def test_variables_and_units(self, serial: tuple[Any, Path]) -> None:
        data, _ = serial
        assert data.sizes == {"speed_rpm": 2, "start": 2}
        assert data.torque.attrs == {"long_name": "friction torque of the shaft", "units": "N m"}
        assert data.speed_rpm.attrs == {"path": "scene.speed_rpm", "long_name": "scene.speed_rpm", "units": "rpm"}
        assert data.torque_by_loss_rolling.attrs["units"] == "N m"
        assert data.cage_motion.dtype == object
        assert float(data.torque.sel(speed_rpm=3000.0, start="whirl")) > float(
            data.torque.sel(speed_rpm=1000.0, start="whirl")
        )

    def test_save_and_load(self, serial: tuple[Any, Path], tmp_path: Path) -> None:
        data, folder = serial
        path = study.save(data.assign(large=("start", [1, 2**40])), tmp_path / "a.nc")
        back = study.load(path)
        assert back.drop_vars("large").equals(data)
        assert back.large.values.tolist() == [1.0, 2.0**40]
        assert study.load(folder / runner.DATASET).equals(data)
        with pytest.raises(FileError):
            study.load(tmp_path / "b.nc")
        (tmp_path / "c.nc").write_text("no")
        with pytest.raises(FileError):
            study.load(tmp_path / "c.nc")

    def test_scenes_without_files(self) -> None:
        scenes = [trb.cases.paper_30310(speed) for speed in (1000.0, 2000.0)]
        data = study.run(scenes, options=OPTIONS, executor="threads")
        assert data.sizes == {"case": 2}
        assert np.all(data.status == "done")
        assert np.all(data.file == "")
        with pytest.raises(InputError):
            study.run(scenes, executor="threads")

    def test_entries_survive_the_index(self, tmp_path: Path) -> None:
        entry = Entry("a", "f", "done", "reached", {"mass": 0.1 + 0.2, "start": "é"}, "a.h5", {"x": 1 / 3, "y": None})
        Index(tmp_path).add(entry)
        assert Index(tmp_path).entries == {"f": entry}


STUDY = """
[study]
case = "rig_30310"
{kind}
[run]
duration = 1e-3
save_every = 5e-5
revolutions = 1e9
[effects]
n_slices = 4
"""


class TestCommand:
    def write(self, path: Path, kind: str) -> Path:
        path.write_text(STUDY.format(kind=kind).replace("revolutions = 1e9\n", ""))
        text = path.read_text()
        case = CASES.find("rig_30310").read_text().replace("revolutions = 50.0", "")
        (path.parent / "case.toml").write_text(case)
        path.write_text(text.replace('case = "rig_30310"', 'case = "case.toml"'))
        return path

    def test_sweep(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        kind = '[study.grid]\n"scene.speed_rpm" = [1000.0, 3000.0]\n"scene.axial_load" = [4930.0, -1.0]'
        file = self.write(tmp_path / "loads.toml", kind)
        assert main(["sweep", str(file), "-o", str(tmp_path / "out"), "--workers", "2"]) == 1
        said = capsys.readouterr()
        assert "axial_load" in said.err
        assert "orbit_rms_over_cpr" in said.out
        data = study.load(tmp_path / "out" / "observables.nc")
        assert data.sizes == {"speed_rpm": 2, "axial_load": 2}
        assert (data.status == "done").sum() == 2

    def test_kinds(self, tmp_path: Path) -> None:
        listed = self.write(
            tmp_path / "a.toml",
            '[[study.list]]\n"scene.speed_rpm" = 1000.0\n[[study.list]]\n"scene.speed_rpm" = 2000.0',
        )
        assert study.load_study(listed).shape == (2,)
        draws = self.write(
            tmp_path / "b.toml",
            '[study.random]\ncount = 3\nseed = 1\n[study.random.ranges]\n"scene.axial_load" = [1230.0, 4930.0]\n'
            '"lubricant.temperature_c" = { choice = [40.0, 80.0] }',
        )
        assert study.load_study(draws).shape == (3,)

    @pytest.mark.parametrize("kind", ["", "x = 1", "random = {}", "grid = {}\nlist = []", "list = []"])
    def test_files_that_cannot_be_used(self, tmp_path: Path, kind: str) -> None:
        with pytest.raises(InputError):
            study.load_study(self.write(tmp_path / "a.toml", kind))
        with pytest.raises(FileError):
            study.load_study(tmp_path / "none.toml")

    def test_shipped_studies_can_be_built(self) -> None:
        assert study.shipped_studies()
        for name in study.shipped_studies():
            made = study.load_study(name)
            assert all(case.scene is not None for case in made.cases)

    @pytest.mark.slow
    @pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
    def test_ctrl_c_ends_cleanly_and_resume_goes_on(self, tmp_path: Path) -> None:
        kind = '[study.grid]\n"scene.speed_rpm" = [1000.0, 2000.0, 3000.0]\n"bearing.cage.mass" = [0.1, 0.2]'
        file = self.write(tmp_path / "many.toml", kind)
        file.write_text(file.read_text().replace("duration = 1e-3", "duration = 0.02"))
        out = tmp_path / "out"
        words = [sys.executable, "-P", "-m", "trbdyn", "sweep", str(file), "-o", str(out), "--workers", "2", "--quiet"]
        with subprocess.Popen(words, start_new_session=True, stderr=subprocess.PIPE) as process:
            for _ in range(600):
                if (out / INDEX).is_file() and (out / INDEX).read_text(encoding="utf-8").endswith("\n"):
                    break
                time.sleep(0.1)
            os.killpg(process.pid, signal.SIGINT)
            assert process.wait(60) == 130
            said = process.stderr.read().decode() if process.stderr else ""
        assert "the cases that are done are kept" in said
        assert f"-m trbdyn sweep {file} -o {out}" in said
        done = [out / entry.file for entry in read_lines(out / INDEX)]
        assert 1 <= len(done) < 6
        assert not list(out.glob(".*.part"))
        assert set(done) <= set(out.glob("*.h5"))
        before = {path: path.stat().st_mtime_ns for path in done}
        assert main(["sweep", str(file), "-o", str(out), "--quiet"]) == 0
        assert len([json.loads(line) for line in (out / INDEX).read_text().splitlines()]) == 6
        assert {path: path.stat().st_mtime_ns for path in before} == before


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("bearing.cage.mass", "kg"),
        ("scene.speed_rpm", "rpm"),
        ("run.save_every", "s"),
        ("effects.friction.boundary_decay", "1"),
        ("scene.moment_x", "N m"),
        ("lubricant.oil", ""),
        ("start", ""),
    ],
)
def test_axes_have_the_units_of_their_fields(path: str, unit: str) -> None:
    assert unit_of(path) == unit
