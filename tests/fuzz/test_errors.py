"""Inputs that Python itself would refuse, or that would take the machine's memory: each is one of the package's own
errors.
"""

from __future__ import annotations

import copy
import json
import os
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from shared import environment

import trbdyn as trb
from trbdyn import plot, study
from trbdyn.errors import FileError, InputError
from trbdyn.extras.study.index import Index, read_lines
from trbdyn.extras.study.index import _checksum as checksum
from trbdyn.model.cases import paper_30310
from trbdyn.run.options import RunOptions
from trbdyn.run.toml_case import case_from_dict, load_case

HUGE = 10**400
CSRC = Path(__file__).parents[2] / "csrc"


@pytest.fixture(scope="module")
def sim() -> trb.Simulation:
    return trb.Simulation(paper_30310())


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("written") / "run.h5"
    trb.Simulation(paper_30310()).run(duration=1e-3, save_every=1e-5, output=path)
    return path


# ---- numbers ----


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda sim: paper_30310(HUGE), "speed_rpm"),
        (lambda sim: paper_30310(-HUGE, 4930.0), "speed_rpm"),
        (lambda sim: paper_30310(gravity=(0.0, HUGE, 0.0)), "gravity[1]"),
        (lambda sim: trb.Lubricant.from_dict(trb.lubricants.vg100().to_dict() | {"viscosity": HUGE}), "lubricant"),
        (lambda sim: RunOptions(save_every=HUGE, duration=1.0), "run.save_every"),
        (lambda sim: RunOptions(max_order=HUGE), "run.max_order"),
        (lambda sim: trb.Start.unequal(HUGE), "start.seed"),
        (lambda sim: trb.Start.state([HUGE]), "start.state_vector"),
        (lambda sim: trb.Start.state("abc"), "start.state_vector"),
        (lambda sim: trb.Start.state([[1.0], [2.0, 3.0]]), "start.state_vector"),
        (lambda sim: trb.Start.state(None), "start"),
        (lambda sim: trb.History(times=(0.0, HUGE), values=(0.0, 1.0)), "history.times[1]"),
        (lambda sim: trb.History(times=(0.0, 1.0), values=(0.0, HUGE)), "history.values[1]"),
        (lambda sim: trb.History.table(3, 4), "history.times"),
        (lambda sim: paper_30310(speed_rpm={1: 2}), "speed_rpm"),
        (lambda sim: sim.set_state([HUGE]), "state"),
        (lambda sim: sim.set_state(sim.state, time=HUGE), "time"),
        (lambda sim: sim.set_state(sim.state, time="now"), "time"),
        (lambda sim: sim.set_state(sim.state, time=float("nan")), "time"),
        (lambda sim: sim.derivative(time=HUGE), "time"),
        (lambda sim: sim.record(vector=[HUGE]), "state"),
        (lambda sim: sim.run(duration=HUGE), "duration"),
        (lambda sim: sim.run(duration=1e300), "run.duration"),
        (lambda sim: sim.run(revolutions=1e300), "run.revolutions"),
        (lambda sim: sim.run(duration=1.0, save_every=1e-300), "run.save_every"),
        (lambda sim: sim.run(duration=1.0, save_every=1e-12), "run.save_every"),
        (lambda sim: sim.estimate(duration=1e300), "run.duration"),
    ],
)
def test_numbers_beyond_what_can_be_used(
    sim: trb.Simulation, make: Callable[[trb.Simulation], object], field: str
) -> None:
    with pytest.raises(InputError) as found:
        make(sim)
    assert any(field in problem.line(found.value.root) for problem in found.value.problems), str(found.value)


def test_a_number_of_thousands_of_digits_can_be_told() -> None:
    """Python refuses to print it."""
    with pytest.raises(InputError, match="speed_rpm = a whole number of thousands of digits"):
        paper_30310(10**5000)


# ---- texts ----


@pytest.mark.parametrize(
    "text",
    ["x = " + "[" * 20_000, "x = " + "[" * 900 + "]" * 900, "x = " + "9" * 5000, ".".join("a" * 2000) + " = 1", "\xff"],
)
def test_toml_that_python_does_not_read(tmp_path: Path, text: str) -> None:
    path = tmp_path / "case.toml"
    path.write_text(text, encoding="latin-1")
    for read in (load_case, study.load_study):
        with pytest.raises(FileError, match=r"not a TOML file|no text in UTF-8"):
            read(path)


def test_endless_files_are_not_read() -> None:
    with pytest.raises(FileError, match="is no regular file"):
        load_case("/dev/zero")


@pytest.mark.parametrize("text", ["[" * 100_000, "1" * 5000, 3, None])
def test_json_that_python_does_not_read(text: Any) -> None:
    with pytest.raises(InputError, match="must be JSON text"):
        trb.Scene.from_json(text)


def test_a_scene_of_nested_values() -> None:
    deep: Any = 1.0
    for _ in range(500):
        deep = [deep]
    with pytest.raises(InputError):
        case_from_dict({"bearing": {"case": "30310"}, "scene": {"speed_rpm": deep}})


@pytest.mark.parametrize(
    "text",
    [
        "grid = 3",
        "list = 3",
        "list = [3]",
        "random = 3",
        "grid = {'scene.speed_rpm' = 3}",
        "grid = {'scene.speed_rpm' = 'abc'}",
        "grid = {'scene.speed_rpm' = []}",
        "grid = {'nowhere' = [1]}",
        "grid = {'oil' = {thin = 3}}",
        "grid = {'scene.speed_rpm' = [1979-05-27]}",
        "name = 3\ngrid = {'scene.speed_rpm' = [1000]}",
        "case = 3\ngrid = {'scene.speed_rpm' = [1000]}",
        "case = 'nowhere'\ngrid = {'scene.speed_rpm' = [1000]}",
        "random = {count = 1.5, seed = 1, ranges = {}}",
        "random = {count = 2, seed = 'a', ranges = {}}",
        "random = {count = 2, seed = 1, ranges = 3}",
        "random = {count = 2, seed = 1, ranges = {'scene.speed_rpm' = 3}}",
        "random = {count = 2, seed = 1, ranges = {'scene.speed_rpm' = [1, 2, 3]}}",
        "random = {count = 2, seed = 1, ranges = {'scene.speed_rpm' = ['a', 'b']}}",
        "random = {count = 2, seed = 1, ranges = {'scene.speed_rpm' = [1e308, inf]}}",
        "random = {count = 2, seed = 1, ranges = {'scene.speed_rpm' = {low = 1, high = 2, scale = 3}}}",
        "random = {count = 2, seed = 1, ranges = {'scene.speed_rpm' = {choice = []}}}",
        "random = {count = 10000000000, seed = 1, ranges = {'scene.speed_rpm' = [1, 2]}}",
    ],
)
def test_tables_of_a_study(tmp_path: Path, text: str) -> None:
    path = tmp_path / "study.toml"
    path.write_text(
        f'[bearing]\ncase = "30310"\n[scene]\nspeed_rpm = 1000\naxial_load = 3000\n[run]\nduration = 1e-4\n[study]\n{text}\n'
    )
    with pytest.raises((InputError, FileError)) as found:
        study.load_study(path)
    assert str(found.value)


def test_a_study_whose_names_are_long(tmp_path: Path) -> None:
    """A letter of Chinese takes three bytes of the 255 of a file's name."""
    word = "保持架质量" * 18
    made = study.grid(
        paper_30310(),
        {word: {word: {"scene.speed_rpm": 2000.0}}},
        RunOptions(duration=2e-4, save_every=1e-5),
        name=word,
    )
    data = study.run(made, tmp_path / "study", executor="serial")
    assert data.status.values.tolist() == ["done"]
    again = study.load(tmp_path / "study" / "observables.nc")
    assert again.status.values.tolist() == ["done"]
    assert dict(again.sizes) == dict(data.sizes) == {word: 1}
    assert again.attrs["study"] == word
    assert again[word].values.tolist() == [word]
    assert all(len(os.fsencode(path.name)) < 200 for path in (tmp_path / "study").iterdir())


GOOD = {"name": "a", "fingerprint": "f", "status": "done", "message": "", "values": {"torque": 1.0}}


def line_of(values: dict[str, Any]) -> str:
    """A line whose checksum is right."""
    return json.dumps(values | {"checksum": checksum(values)})


@pytest.mark.parametrize(
    "line",
    [
        "[" * 100_000,
        "3",
        "[]",
        "{}",
        line_of(GOOD | {"values": 3}),
        line_of(GOOD | {"values": {"torque": {}}}),
        line_of(GOOD | {"values": {"torque": [[1.0], [2.0, 3.0]]}}),
        line_of(GOOD | {"values": {"torque": 10**400}}),
        line_of(GOOD | {"wall_s": "long"}),
        line_of(GOOD | {"wall_s": 1e300}).replace("1e+300", "1e999"),
        line_of(GOOD | {"status": "perhaps"}),
        line_of(GOOD | {"fingerprint": ["f"]}),
        line_of(GOOD | {"file": "../../etc/passwd"}),
        line_of(GOOD | {"file": 3}),
        line_of(GOOD | {"message": None}),
        "\xff\xfe",
    ],
)
def test_lines_of_an_index_that_are_no_entries(tmp_path: Path, line: str) -> None:
    (tmp_path / "index.jsonl").write_bytes(line.encode("latin-1") + b"\n" + line_of(GOOD).encode() + b"\n")
    with pytest.warns(UserWarning, match="line 1 is damaged"):
        assert [entry.name for entry in read_lines(tmp_path / "index.jsonl")] == ["a"]


def test_entries_that_do_not_fit_each_other(tmp_path: Path) -> None:
    """Numbers, lists and lists of lists under one name: those like the first list stay."""
    made = study.grid(paper_30310(), {"scene.speed_rpm": [1000, 2000, 3000]}, RunOptions(duration=1e-4))
    index = Index(tmp_path)
    for case, value in zip(made.cases, (1.0, [1.0, 2.0], [[3.0]]), strict=True):
        line = GOOD | {"fingerprint": case.fingerprint, "values": {"own": value}}
        with (tmp_path / "index.jsonl").open("a") as stream:
            stream.write(line_of(line) + "\n")
    assert not index.entries
    data = study.collect(made, tmp_path)
    np.testing.assert_array_equal(data.own.values, [[np.nan, np.nan], [1.0, 2.0], [np.nan, np.nan]])


def test_a_folder_of_something_else_is_not_a_study(tmp_path: Path) -> None:
    (tmp_path / "observables.nc").write_bytes(b"other")
    made = study.grid(paper_30310(), {"scene.speed_rpm": [1000]}, RunOptions(duration=1e-4))
    with pytest.raises(FileError, match="belongs to no study"):
        study.run(made, tmp_path, executor="serial")
    assert (tmp_path / "observables.nc").read_bytes() == b"other"


# ---- result files ----


def changed(path: Path, folder: Path, change: Callable[[h5py.File], None]) -> Path:
    other = folder / "bad.h5"
    shutil.copy(path, other)
    with h5py.File(other, "r+") as file:
        change(file)
    return other


def put_head(file: h5py.File, text: bytes) -> None:
    del file["run/head"]
    file.create_dataset("run/head", data=np.array([text]), chunks=(1,), fletcher32=True)


@pytest.mark.parametrize("name", ["first_record", "schema_version"])
@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan, "x", None])
def test_numbers_of_the_head_that_are_none(written: Path, tmp_path: Path, name: str, value: Any) -> None:
    def change(file: h5py.File) -> None:
        put_head(file, json.dumps(json.loads(file["run/head"][0]) | {name: value}).encode())

    with pytest.raises(FileError, match=r"damaged|schema version"):
        trb.load(changed(written, tmp_path, change))


def test_json_that_is_nested_in_a_file(written: Path, tmp_path: Path) -> None:
    with pytest.raises(FileError, match="damaged"):
        trb.load(changed(written, tmp_path, lambda file: put_head(file, b"[" * 60_000)))


MEMORY = """
import resource, sys
import trbdyn as trb
used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
try:
    result = trb.load(sys.argv[1])
    for field in result.fields:
        result[field.name]
except trb.FileError as error:
    print(error, file=sys.stderr)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - used)
"""


@pytest.mark.parametrize("which", ["time", "all", "ending", "final_state"])
def test_datasets_that_claim_more_than_the_file_holds(written: Path, tmp_path: Path, which: str) -> None:
    def change(file: h5py.File) -> None:
        if which == "ending":
            file["run/ending"].resize(4_000_000_000, axis=0)
            file["run/committed"][1] = 4_000_000_000
        elif which == "final_state":
            file["run/final_state"].resize(1_000_000_000, axis=0)
        else:
            file["run/committed"][0] = 2_000_000
            for name, dataset in file.items():
                if "units" in dataset.attrs and which in ("all", name):
                    dataset.resize(2_000_000, axis=0)

    path = changed(written, tmp_path, change)
    assert path.stat().st_size < 4 << 20
    words = [sys.executable, "-P", "-c", MEMORY, str(path)]
    done = subprocess.run(words, capture_output=True, text=True, env=environment(), check=True)
    assert "damaged" in done.stderr
    assert int(done.stdout) < 100 << 10, "kilobytes"


def test_a_packed_file_of_zeros_is_no_damage(tmp_path: Path) -> None:
    """What is compressed may be much smaller than what it holds."""
    from trbdyn.results.hdf5_file import Part
    from trbdyn.results.result_file import ResultWriter

    scene, rows = paper_30310(), 200_000
    layout = [("time", 0, ()), ("cage_angular_velocity", 1, (3,)), ("roller_position", 4, (17, 3))]
    records = np.zeros((rows, 55))
    records[:, 0] = np.arange(rows)
    path = tmp_path / "zeros.h5"
    from trbdyn.results import fields

    kept = [entry for entry in fields.table() if entry.name in {name for name, *_ in layout}]
    with ResultWriter(path, Part(scene, layout, kept)) as writer:
        writer.append(records)
        ending = {"success": True, "message": "", "stats": {}, "counters": {}, "final_time": 1.0, "final_state": None}
        writer.finish(ending)
    assert path.stat().st_size < 4 << 20
    assert trb.load(path).roller_position.shape == (rows, 17, 3)


# ---- short runs, callbacks, copies ----


@pytest.mark.parametrize("records", [1, 2, 7])
def test_the_shortest_runs_have_a_summary(tmp_path: Path, records: int) -> None:
    result = trb.Simulation(paper_30310()).run(duration=records * 1e-5, save_every=1e-5)
    values = result.summary()
    assert values["torque"] > 0.0
    assert values["settled"] is False
    assert values["window_end"] > values["window_start"]
    if len(result) < 8:
        with pytest.raises(InputError, match="at least 8 records"):
            plot.all(result, tmp_path, ["spectrum"])


def test_pictures_need_no_later_matplotlib(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Matplotlib 3.8 knows no argument of get_figure."""
    from matplotlib.axes import Axes

    result = trb.Simulation(paper_30310()).run(duration=1e-4, save_every=1e-5)
    picture = plot.tilt(result)
    monkeypatch.setattr(Axes, "get_figure", lambda self: self.figure)
    with pytest.raises(TypeError):
        picture.get_figure(root=True)
    monkeypatch.setattr(picture.figure, "savefig", lambda target, **how: target.write(b"x"))
    assert plot.save(picture, tmp_path / "tilt.png").is_file()


@pytest.mark.parametrize(
    "act",
    [
        lambda sim: sim.restart(),
        lambda sim: sim.set_state(sim.state),
        lambda sim: sim.step(),
        lambda sim: sim.run(duration=1e-4),
    ],
)
def test_a_callback_cannot_move_the_simulation(act: Callable[[trb.Simulation], object], tmp_path: Path) -> None:
    """It is told so, and a callback that goes on in spite of it has changed nothing."""
    reference = trb.Simulation(paper_30310()).run(duration=2e-3, save_every=1e-5, output=tmp_path / "reference.h5")
    told: list[str] = []

    def callback(sim: trb.Simulation) -> None:
        try:
            act(sim)
        except InputError as error:
            told.append(str(error))

    sim = trb.Simulation(paper_30310())
    result = sim.run(duration=2e-3, save_every=1e-5, callback=callback, output=tmp_path / "run.h5")
    assert told
    assert all("must not be called while a run goes on" in line for line in told)
    assert result.success
    np.testing.assert_array_equal(result.time, reference.time)
    np.testing.assert_array_equal(result.cage_position, reference.cage_position)

    def unguarded(sim: trb.Simulation) -> None:
        act(sim)

    other = trb.Simulation(paper_30310())
    with pytest.raises(InputError, match="must not be called"):
        other.run(duration=2e-3, save_every=1e-5, callback=unguarded, output=tmp_path / "other.h5")
    assert len(trb.load(tmp_path / "other.h5")) > 100
    act(other)


@pytest.mark.parametrize("make", [copy.copy, copy.deepcopy, lambda sim: sim.copy()])
def test_copies_step_on_their_own(make: Callable[[trb.Simulation], trb.Simulation]) -> None:
    sim = trb.Simulation(paper_30310())
    sim.step()
    before = sim.state
    other = make(sim)
    for _ in range(5):
        other.step()
    assert other.time > sim.time == before.time
    np.testing.assert_array_equal(sim.state.vector, before.vector)


def test_simulations_do_not_pickle(sim: trb.Simulation) -> None:
    with pytest.raises(TypeError, match="keep its scene and its state"):
        pickle.dumps(sim)


# ---- the build ----

FLAGS = ["-ffast-math", "-ffinite-math-only", "-funsafe-math-optimizations", "-O2 -ffast-math"]


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("flags", [*FLAGS, "-O2 -fno-math-errno"])
def test_builds_with_fast_math_are_refused(tmp_path: Path, flags: str) -> None:
    cmake = shutil.which("cmake", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    if cmake is None:
        pytest.skip("needs CMake")
    (tmp_path / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.20)\nproject(p LANGUAGES C)\nset(CMAKE_BUILD_TYPE Release)\n"
        f'include("{CSRC}/cmake/TrbFlags.cmake")\n'
    )
    words = [cmake, "-S", str(tmp_path), "-B", str(tmp_path / "build"), f"-DCMAKE_C_FLAGS={flags}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    refused = flags in FLAGS
    assert (done.returncode != 0) is refused, done.stderr
    assert ("allow fast math" in " ".join(done.stderr.split())) is refused
