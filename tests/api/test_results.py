"""Results in memory and in files: the same arrays, whole or cut off, and damaged files told apart."""

from __future__ import annotations

import copy
import errno
import itertools
import json
import math
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import h5py
import numpy as np
import pytest
from shared import assert_same_fields, environment
from synthetic import StubScene, make_run

import trbdyn as trb
from trbdyn.errors import FileError, InputError
from trbdyn.results import fields as field_table
from trbdyn.results import file_source, result_file
from trbdyn.results.assembly import load
from trbdyn.results.file_format import BLOCK_ROWS, SCHEMA_VERSION, SINGLE
from trbdyn.results.file_format import as_kept as kept_in_a_file
from trbdyn.results.hdf5_file import Part
from trbdyn.results.result import Result
from trbdyn.results.result_file import ResultWriter


def write(path: Path, run: Any, scene: Any, *, chunk: int = 500, finish: bool = True, **options: Any) -> Path:
    fields = field_table.select(run.fields, options.pop("groups", None))
    part = Part(scene, run.layout, fields, options.pop("meta", {}), run.geometry)
    with ResultWriter(path, part, **options) as writer:
        for start in range(0, len(run.records), chunk):
            writer.append(run.records[start : start + chunk])
        if finish:
            writer.finish(run.ending())
    return path


def test_the_header_has_all_fields(header_fields: list[tuple[str, ...]]) -> None:
    assert len(header_fields) == len({row[0] for row in header_fields}) > 70
    assert header_fields[0][0] == "time"
    groups = (
        "time",
        "cage",
        "rollers",
        "contacts",
        "outer_ribs",
        "pocket",
        "ring",
        "housing",
        "torque",
        "power",
        "energy",
    )
    assert tuple(dict.fromkeys(row[1] for row in header_fields)) == groups


def test_the_table_of_the_core_is_that_of_the_header(header_fields: list[tuple[str, ...]]) -> None:
    from trbdyn import _core as core

    assert [tuple(row) for row in core.field_table()] == header_fields
    assert field_table.table()[0].name == "time"


def test_shapes_of_fields() -> None:
    def shape(kind: str) -> tuple[int, ...]:
        return field_table.Field("x", "cage", kind, "m", "").shape(12, 4)

    kinds = ("scalar", "vec2", "vec3", "quaternion", "roller", "roller_vec3", "roller_quat", "pocket_face")
    assert [shape(kind) for kind in kinds] == [(), (2,), (3,), (4,), (12,), (12, 3), (12, 4), (12, 4)]
    with pytest.raises(InputError, match="tensor"):
        field_table.Field("x", "cage", "tensor", "m", "")


def test_attributes_are_the_recorded_fields(synthetic: Any, whirling: Result) -> None:
    for name, _, shape in synthetic.layout:
        values = getattr(whirling, name)
        assert values.shape == (4001, *shape)
        np.testing.assert_array_equal(values, synthetic.column(name))
    assert whirling.success
    assert whirling.message == "reached the end"
    assert whirling.stats["steps"] == 1234
    assert whirling.counters["front_rib"] == 0
    assert whirling.final_state.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert "cage_position" in dir(whirling)
    assert "cage_position" in whirling
    assert len(whirling) == 4001
    assert whirling.n_rollers == 12
    with pytest.raises(ValueError, match="read-only"):
        whirling.cage_position[0, 0] = 1.0
    with pytest.raises(AttributeError, match="no_such"):
        whirling.no_such  # noqa: B018


def test_a_name_that_summary_and_result_share_means_one_thing(whirling: Result) -> None:
    """A series of the result whose name the summary has, too, has the summary's number as its mean over the summary's window."""
    values, compared = whirling.summary(), []
    window = whirling.window(values["window_start"])
    for name, value in values.items():
        series = getattr(window, name, None)
        if isinstance(value, float) and isinstance(series, np.ndarray):
            compared.append(name)
            assert series.mean() == pytest.approx(value, rel=1e-9), name
    assert "axis_distance_over_cpr" in compared
    assert "orbit_radius_over_cpr" not in values


def test_the_orbit_is_not_the_distance_from_the_axis(build: Callable[..., tuple[Any, Result]]) -> None:
    """A cage that hangs at 0.9 Cpr and hardly moves has next to no orbit, though it is as far from the axis as a whirling one."""
    _, hanging = build(radius=0.01e-3, centre=(0.0, -0.225e-3), duration=1.0)
    _, whirling = build(radius=0.225e-3, duration=1.0)
    for result, orbit, distance in ((hanging, 0.04, 0.9), (whirling, 0.9, 0.9)):
        values = result.summary()
        assert values["orbit_rms_over_cpr"] == pytest.approx(orbit, rel=2e-2)
        assert values["axis_distance_over_cpr"] == pytest.approx(distance, rel=2e-2)
        assert result.orbit_radius_over_cpr.mean() == pytest.approx(orbit, rel=5e-2)
    words = [line.strip() for line in _summary_text(hanging).splitlines()]
    order = [
        next(k for k, line in enumerate(words) if line.startswith(start))
        for start in ("orbit radius", "distance of the cage")
    ]
    assert order == sorted(order)
    assert not any("whirl radius" in line for line in words)


def _summary_text(result: Result) -> str:
    from trbdyn.results import summary

    return summary.table(result.summary())


def test_nothing_is_said_of_a_cage_that_is_not_there(whirling: Result) -> None:
    whirling.scene.effects = SimpleNamespace(
        **(vars(whirling.scene.effects) | {"bodies": "rollers", "has_cage": False, "has_pockets": False})
    )
    for read in (
        whirling.cage_locus,
        whirling.pocket_statistics,
        lambda: whirling.orbit_radius,
        lambda: whirling.axis_distance,
        lambda: whirling.whirl_ratio,
        lambda: whirling.cage_motion,
        lambda: whirling.axial_motion,
    ):
        with pytest.raises(InputError, match="has no cage"):
            read()
    values = whirling.summary()
    assert "orbit_rms_over_cpr" not in values
    assert values["torque"] == pytest.approx(1.25, rel=1e-2)


def test_torques_that_differ_are_explained(whirling: Result) -> None:
    assert "without the film's pressure force" in whirling.summary()["torque_note"]
    assert "both rings agree" in " ".join(_summary_text(whirling).split())
    effects = vars(whirling.scene.effects)
    whirling.scene.effects = SimpleNamespace(**(effects | {"rolling_pressure_force": True}))
    assert "speed up or slow down" in whirling.summary()["torque_note"]
    from trbdyn.results.notes import torque_note

    assert torque_note(whirling, 1.25, 1.2501) is None


def test_selection_and_windows(whirling: Result) -> None:
    cage = whirling.select(["cage"])
    assert cage.groups == ("time", "cage")
    with pytest.raises(InputError, match="was not recorded"):
        cage["power_loss"]
    part = whirling.window(0.1, 0.2)
    assert part.time[0] == pytest.approx(0.1)
    assert part.time[-1] == pytest.approx(0.2)
    assert len(part.window(0.15)) == 501
    assert part.energy_audit.dissipated == pytest.approx(39.27)
    with pytest.raises(InputError, match="window"):
        whirling.window(5.0, 6.0)
    with pytest.raises(InputError, match="did you mean 'cage'"):
        whirling.select(["cages"])
    with pytest.raises(InputError, match="sequence"):
        whirling.select("cage")


@pytest.mark.parametrize("where", ["memory", "pieces", "file", "window"])
@pytest.mark.parametrize("how", ["pickle", "copy", "deepcopy"])
def test_results_can_be_copied_and_sent(tmp_path: Path, whirling: Result, how: str, where: str) -> None:
    """To another process, say; a result in a file is read from there."""
    path = tmp_path / "run.h5"
    ways: dict[str, Callable[[Any], Any]] = {
        "pickle": lambda result: pickle.loads(pickle.dumps(result)),
        "copy": copy.copy,
        "deepcopy": copy.deepcopy,
    }
    if where in ("pieces", "file"):
        scene = trb.cases.paper_30310(3000.0)
        output = path if where == "file" else None
        result = trb.Simulation(scene).run(duration=1e-3, save_every=1e-5, output=output, save_groups=["cage"])
    else:
        result = whirling.window(0.2) if where == "window" else whirling
    again = ways[how](result)
    assert again.groups == result.groups
    assert again.success is result.success
    assert np.array_equal(again.cage_position, result.cage_position)
    with pytest.raises(AttributeError, match="_nothing"):
        again._nothing  # noqa: B018


def test_xarray_has_names_units_and_coordinates(whirling: Result) -> None:
    dataset = whirling.to_xarray()
    assert dict(dataset.sizes) == {"time": 4001, "xyz": 3, "xy": 2, "wxyz": 4, "roller": 12, "slot": 4}
    assert dataset.pocket_force.dims == ("time", "roller", "slot")
    assert dataset.cage_position.attrs["units"] == "m"
    assert "cage centre" in dataset.cage_position.attrs["long_name"]
    assert float(dataset.cage_position.sel(xyz="x").isel(time=0)) == pytest.approx(
        whirling.cage_position[0, 0], rel=5e-13
    )
    assert float(dataset.time[-1]) == pytest.approx(0.4)


def test_no_records_make_no_trouble(synthetic: Any, stub_scene: Any) -> None:
    about = {"success": False, "message": "failed at once", "final_time": 0.0, "final_state": None, "geometry": {}}
    empty = synthetic.result(stub_scene, synthetic.records[:0], stats={}, counters={}, **about)
    assert empty.duration == empty.revolutions == 0.0
    assert empty.summary()["success"] is False


def as_kept(entry: field_table.Field, values: Any) -> Any:
    """Numbers of a field with the digits that a file keeps."""
    return kept_in_a_file(entry, np.asarray(values)).astype(float)


def test_a_file_gives_back_every_number(tmp_path: Path, synthetic: Any, whirling: Result, stub_scene: Any) -> None:
    """Energies to the last bit, motion to twelve digits, what follows from them to seven."""
    meta = {"core_version": "1.2", "settings": {"rtol": 1e-5, "integrator": "bdf"}}
    loaded = load(write(tmp_path / "run.h5", synthetic, stub_scene, chunk=777, meta=meta))
    assert [f.name for f in loaded.fields] == [f.name for f in whirling.fields]
    assert loaded.fields == whirling.fields
    assert_same_fields(loaded, {field.name: as_kept(field, whirling[field.name]) for field in whirling.fields})
    for field in whirling.fields:
        if field.group in ("time", "energy"):
            np.testing.assert_array_equal(loaded[field.name], whirling[field.name])
        elif field.group in ("cage", "rollers", "ring"):
            np.testing.assert_allclose(loaded[field.name], whirling[field.name], rtol=5e-13)
    assert loaded.success
    assert loaded.message == whirling.message
    assert loaded.stats == whirling.stats
    assert loaded.counters == whirling.counters
    assert loaded.geometry == whirling.geometry
    assert loaded.final_time == whirling.final_time
    np.testing.assert_array_equal(loaded.final_state, whirling.final_state)
    assert loaded.meta["settings"] == meta["settings"]
    assert loaded.meta["schema_version"] == 2


def test_a_file_describes_itself(tmp_path: Path, synthetic: Any, stub_scene: Any) -> None:
    path = write(tmp_path / "run.h5", synthetic, stub_scene, meta={"instruction_set": "avx2"}, groups=["cage"])
    with h5py.File(path) as file:
        assert file.attrs["schema"] == "trbdyn-result"
        assert file.attrs["instruction_set"] == "avx2"
        head = json.loads(file["run/head"][0])
        assert head["scene"] == {"stub": True}
        names = {f.name for f in synthetic.fields if f.group in ("time", "cage")}
        assert {name for name, member in file.items() if "units" in member.attrs} == names
        assert {row[0] for row in head["fields"]} == names
        attributes = file["cage_position"].attrs
        assert (attributes["units"], attributes["group"]) == ("m", "cage")
        assert "cage centre" in attributes["long_name"]
        assert [axis[0].name for axis in file["cage_position"].dims] == ["/time", "/xyz"]


@pytest.mark.slow
def test_xarray_opens_a_file(tmp_path: Path, synthetic: Any, stub_scene: Any, whirling: Result) -> None:
    """One variable of each kind and dimensions and all coordinates: units, names of dimensions, numbers as `load` gives them."""
    xarray, path = pytest.importorskip("xarray"), tmp_path / "run.h5"
    pytest.importorskip("h5netcdf")
    write(path, synthetic, stub_scene)
    wanted = load(path).to_xarray()
    kinds = {
        (variable.dims, variable.dtype, name if name in wanted.coords else ""): name
        for name, variable in wanted.variables.items()
    }
    kept = {*kinds.values(), "pocket_force", "cage_position"}
    others = [name for name in wanted.variables if name not in kept]
    with xarray.open_dataset(path, engine="h5netcdf", drop_variables=others) as data:
        assert len(load(path)) == data.sizes["time"]  # while it is open there, with locks of its own
        assert dict(data.sizes) == dict(wanted.sizes)
        for name, variable in wanted.drop_vars(others).variables.items():
            assert data[name].dims == variable.dims
            np.testing.assert_array_equal(data[name], variable)
        assert data.pocket_force.attrs["units"] == "N"
        assert float(data.cage_position.sel(xyz="x").isel(time=0)) == pytest.approx(
            whirling.cage_position[0, 0], rel=5e-13
        )
    with xarray.open_dataset(path, engine="h5netcdf", group="run") as run:
        assert int(run.committed[0]) == len(whirling)
        np.testing.assert_array_equal(run.final_state, whirling.final_state)
        assert not [dim for dim in run.sizes if "phony" in str(dim)]


PAGE = Path(__file__).parents[2] / "docs" / "file_format.md"


@pytest.mark.skipif(not PAGE.is_file(), reason="the documentation is not part of a source distribution")
def test_the_page_on_the_format_names_what_is_in_a_file(tmp_path: Path, synthetic: Any, stub_scene: Any) -> None:
    """Every member and every attribute, and none besides; the recorded quantities come from the table of the core."""
    text = PAGE.read_text(encoding="utf-8")
    said = set(re.findall(r"`/([a-z_/]+)`", text))
    with h5py.File(write(tmp_path / "run.h5", synthetic, stub_scene)) as file:
        recorded = {name for name, member in file.items() if "units" in member.attrs}
        assert recorded == {field.name for field in synthetic.fields}
        assert said == {"time", *(set(file) - recorded - {"run"}), *(f"run/{name}" for name in file["run"])}
        own = {key for name in recorded for key in file[name].attrs} - {
            "CLASS",
            "NAME",
            "DIMENSION_LIST",
            "REFERENCE_LIST",
        }
        assert own == {"units", "long_name", "group"}
        assert all(f"`{key}`" in text for key in own)
        kinds = {
            group: {str(file[f.name].dtype) for f in synthetic.fields if f.group == group}
            for group in file_groups(file)
        }
    assert {group for group, found in kinds.items() if found == {"float32"}} == set(SINGLE) - {"peaks"}
    single, words = (
        text[text.index("are float64;") :],
        {"contacts": "contacts", "pocket": "pockets", "torque": "torque"},
    )
    assert all(single.index(words.get(group, group)) < single.index("are float32") for group in SINGLE)
    assert f"version {SCHEMA_VERSION} of the format" in text
    assert f"a chunk of {BLOCK_ROWS} records" in text


def file_groups(file: h5py.File) -> set[str]:
    return {str(member.attrs["group"]) for member in file.values() if "group" in member.attrs}


def test_every_dataset_has_checksums(tmp_path: Path, synthetic: Any, stub_scene: Any) -> None:
    found: dict[str, bool] = {}

    def look(name: str, member: Any) -> None:
        if isinstance(member, h5py.Dataset):
            found[name] = bool(member.fletcher32) and bool(member.chunks)

    with h5py.File(write(tmp_path / "run.h5", synthetic, stub_scene)) as file:
        file.visititems(look)
        # the letters that name axes are texts, which HDF5 keeps elsewhere; no reader of ours looks at them
        assert {name for name, has in found.items() if not has} <= {"xyz", "xy", "wxyz"}
        assert len(found) > 80


def test_a_real_scene_survives_the_file(tmp_path: Path, synthetic: Any) -> None:
    from trbdyn.model.cases import paper_30310
    from trbdyn.model.pocket_shapes import drafted_pocket
    from trbdyn.model.scene import Start

    scene = paper_30310(start=Start.state(np.linspace(0.0, 1.0, 20000) / 3.0, time=0.25))
    cage = scene.bearing.cage.replace(pocket=drafted_pocket(scene.bearing, 30.0))
    scene = scene.replace(bearing=scene.bearing.replace(cage=cage))
    loaded = load(write(tmp_path / "run.h5", synthetic, scene))
    assert loaded.scene == scene
    np.testing.assert_allclose(loaded.axis_distance_over_cpr, 0.9, rtol=1e-12)


def test_an_unfinished_file_is_readable_and_says_so(tmp_path: Path, synthetic: Any, stub_scene: Any) -> None:
    loaded = load(write(tmp_path / "run.h5", synthetic, stub_scene, finish=False))
    assert not loaded.success
    assert "cut off" in loaded.message
    assert loaded.final_state is None
    assert loaded.final_time == pytest.approx(0.4)
    assert len(loaded) == 4001


LOADER = """
import sys
from synthetic import StubScene, make_run
from trbdyn.results import result_file
result_file.FLUSH_SECONDS = 0.0
run = make_run(n=2001)
part = result_file.Part(StubScene(), run.layout, run.fields)
writer = result_file.ResultWriter(sys.argv[1], part, beside=sys.argv[2] == "True")
"""

WRITE_ON = """
for turn in range(10000):
    for start in range(0, 2000, 40):
        writer.append(run.records[start : start + 40])
        if turn == start == 0:
            writer.flush()
            print("ready", flush=True)
"""

FILL_UP = """
import resource
from trbdyn.errors import FileError
resource.setrlimit(resource.RLIMIT_FSIZE, (2_500_000, 2_500_000))
try:
    for start in range(0, 2000, 40):
        writer.append(run.records[start : start + 40])
except FileError as error:
    print(error)
    writer.finish(run.ending() | {"success": False, "message": "the disk was full"})
"""


def start_writer(tmp_path: Path, then: str, *, beside: bool) -> subprocess.Popen[bytes]:
    """A process that opens run.h5 for writing, flushes every record at once, and then does as told."""
    script = tmp_path / "writer.py"
    script.write_text(LOADER + then)
    command = [sys.executable, str(script), str(tmp_path / "run.h5"), str(beside)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, env=environment())


@pytest.mark.skipif(not hasattr(os, "posix_fallocate"), reason="needs a limit of file size")
@pytest.mark.parametrize("beside", [False, True])
def test_a_full_disk_is_an_error_and_leaves_a_readable_file(tmp_path: Path, beside: bool) -> None:
    """What comes after the error is not written: it would lie behind a gap."""
    with start_writer(tmp_path, FILL_UP, beside=beside) as process:
        said, _ = process.communicate()
    assert process.returncode == 0
    assert b"cannot be written" in said
    loaded = load(tmp_path / "run.h5")
    assert loaded.message == "the disk was full"
    assert not loaded.success
    assert len(loaded) >= 40
    np.testing.assert_allclose(np.diff(loaded.time), 0.4 / 2000, rtol=1e-9)


@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
@pytest.mark.parametrize(("seed", "beside"), [(0, False), (1, True), (2, True)])
def test_a_killed_writer_leaves_a_readable_file(tmp_path: Path, seed: int, beside: bool) -> None:
    with start_writer(tmp_path, WRITE_ON, beside=beside) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        time.sleep(0.1 + 0.137 * seed)
        process.send_signal(signal.SIGKILL)
    loaded = load(tmp_path / "run.h5")
    assert not loaded.success
    assert len(loaded) >= 40
    assert len(loaded) % 40 == 0 or len(loaded) % BLOCK_ROWS == 0
    step = np.diff(loaded.time[: min(len(loaded), 2000)])
    np.testing.assert_allclose(step, 0.4 / 2000, rtol=1e-9)
    assert loaded.pocket_force.shape == (len(loaded), 12, 4)


def test_records_wait_in_memory_only_until_flushed(
    tmp_path: Path, synthetic: Any, stub_scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("trbdyn.results.result_file.FLUSH_SECONDS", 1e3)  # however busy the machine is
    writer = ResultWriter(tmp_path / "run.h5", Part(stub_scene, synthetic.layout, synthetic.fields))
    writer.append(synthetic.records[:10])
    writer.append(synthetic.records[10])
    writer.append(synthetic.records[:0])
    assert writer.n_written == 0
    writer.flush()
    assert writer.n_written == 11
    writer.close()
    writer.close()
    with pytest.raises(FileError, match="closed already"):
        writer.finish(synthetic.ending())
    np.testing.assert_array_equal(load(tmp_path / "run.h5").time, synthetic.column("time")[:11])


@pytest.mark.parametrize(
    ("expected", "beside"),
    [
        (None, False),
        (100, True),
        (100_000, True),
        *(pytest.param(some, True, marks=pytest.mark.slow) for some in (None, 7, 4001)),
        *(pytest.param(some, False, marks=pytest.mark.slow) for some in (7, 100, 4001, 100_000)),
    ],
)
def test_what_is_written_is_what_was_recorded(
    tmp_path: Path,
    synthetic: Any,
    stub_scene: Any,
    beside: bool,
    expected: int | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In chunks of all lengths, full or not, that come in pieces of other lengths; some are flushed halfway."""
    monkeypatch.setattr(result_file, "FLUSH_BYTES", 100_000)
    part = Part(stub_scene, synthetic.layout, synthetic.fields)
    path = tmp_path / "run.h5"
    with ResultWriter(path, part, expected=expected, beside=beside) as writer:
        start, sizes = 0, itertools.cycle([40, 1, 333, 512, 2])
        while start < len(synthetic.records):
            stop = start + next(sizes)
            writer.append(synthetic.records[start:stop])
            if stop - start == 1:
                writer.flush()
                with h5py.File(path, locking=False) as file:  # as any program does: the writer has closed it
                    np.testing.assert_array_equal(file["time"], synthetic.column("time")[:stop])
            start = stop
        writer.finish(synthetic.ending())
    loaded = load(path)
    assert len(loaded) == len(synthetic.records)
    assert_same_fields(loaded, {one.name: as_kept(one, synthetic.column(one.name)) for one in synthetic.fields})


@pytest.mark.parametrize("expected", [None, 4001])
def test_a_full_disk_keeps_what_it_has_room_for(
    tmp_path: Path, synthetic: Any, stub_scene: Any, expected: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = Part(stub_scene, synthetic.layout, synthetic.fields)
    writer = ResultWriter(tmp_path / "run.h5", part, expected=expected)
    room, reserve, asked = 6_000_000, writer._reserve, []

    def limited(size: int) -> None:
        asked.append(size)
        if size > room:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        reserve(size)

    monkeypatch.setattr(writer, "_reserve", limited)
    monkeypatch.setattr(result_file, "FLUSH_BYTES", 1 << 30)
    monkeypatch.setattr(result_file, "FLUSH_SECONDS", 1e9)
    writer.append(synthetic.records[:2000])
    with pytest.raises(FileError, match="no space"):
        writer.flush()
    assert asked[0] > room >= asked[-1]
    writer.append(synthetic.records[2000:2010])
    with pytest.raises(FileError, match="records before these"):
        writer.flush()
    writer.close()
    loaded = load(tmp_path / "run.h5")
    assert len(loaded) >= 100
    kept = {one.name: as_kept(one, synthetic.column(one.name)[: len(loaded)]) for one in synthetic.fields}
    assert_same_fields(loaded, kept)


def test_an_error_of_the_second_thread_reaches_the_next_call(
    tmp_path: Path, synthetic: Any, stub_scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The records before it stay, those after it are not written."""
    monkeypatch.setattr(result_file, "FLUSH_SECONDS", 0.0)
    writer = ResultWriter(tmp_path / "run.h5", Part(stub_scene, synthetic.layout, synthetic.fields), beside=True)
    writer.append(synthetic.records[:40])
    writer.flush()
    threads = []

    def full(size: int) -> None:
        threads.append(threading.current_thread())
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(writer, "_reserve", full)
        writer.append(synthetic.records[40:80])
        with pytest.raises(FileError, match="no space"):
            writer.append(synthetic.records[80:120])
    assert threads
    assert threading.current_thread() not in threads
    writer.close()
    assert len(load(tmp_path / "run.h5")) == 40


def test_foreign_and_missing_files_are_told_apart(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"(?i)no such file"):
        load(tmp_path / "nothing.h5")
    (tmp_path / "text.h5").write_text("not a result")
    with pytest.raises(FileError, match="not an HDF5 file"):
        load(tmp_path / "text.h5")
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["data"] = [1.0]
    with pytest.raises(FileError, match="not a result of trbdyn"):
        load(tmp_path / "foreign.h5")


def refusal(path: Path) -> str:
    """Why a file is refused, without its name."""
    with pytest.raises(FileError) as caught:
        load(path).time  # noqa: B018
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    return text.removeprefix(f"{path}: ")


@pytest.fixture(scope="module")
def whole_file(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """What is in the file of a run."""
    return write(tmp_path_factory.mktemp("whole") / "run.h5", make_run(), StubScene()).read_bytes()


@pytest.fixture
def written(tmp_path: Path, whole_file: bytes) -> Path:
    """A file of one's own with the same content."""
    path = tmp_path / "run.h5"
    path.write_bytes(whole_file)
    return path


def damage(name: str) -> Callable[[h5py.File], None]:
    def put_head(file: h5py.File, text: str) -> None:
        del file["run/head"]
        file.create_dataset("run/head", data=np.array([text.encode()]), chunks=(1,), fletcher32=True)

    def newer(file: h5py.File) -> None:
        put_head(file, json.dumps(json.loads(file["run/head"][0]) | {"schema_version": 99}))

    def before(file: h5py.File) -> None:
        del file["run/head"]
        file.create_group("fields")

    def no_scene(file: h5py.File) -> None:
        put_head(file, json.dumps({k: v for k, v in json.loads(file["run/head"][0]).items() if k != "scene"}))

    def bad_json(file: h5py.File) -> None:
        put_head(file, "{oops")

    def wrong_kind(file: h5py.File) -> None:
        head = json.loads(file["run/head"][0])
        head["fields"][0][2] = "tensor"
        put_head(file, json.dumps(head))

    def no_records(file: h5py.File) -> None:
        file["run/committed"][:] = 0

    def wrong_type(file: h5py.File) -> None:
        del file["time"]
        file.create_dataset("time", data=np.arange(4001), chunks=(7,))

    def shorter(file: h5py.File) -> None:
        file["time"].resize(4000, axis=0)

    def leads_out(file: h5py.File) -> None:
        del file["time"]
        file["time"] = h5py.ExternalLink("/etc/passwd", "/x")

    def external(file: h5py.File) -> None:
        del file["run/final_state"]
        file.create_dataset("run/final_state", (4,), "f8", external=[("/etc/hostname", 0, h5py.h5f.UNLIMITED)])

    return locals()[name]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("newer", "schema version 99"),
        ("before", "written with format version 1"),
        ("no_scene", "scene"),
        ("bad_json", "damaged"),
        ("no_records", "damaged"),
        ("wrong_type", "damaged"),
        ("shorter", "damaged"),
        ("wrong_kind", "tensor"),
        ("leads_out", "leads out of the file"),
        ("external", "leads out of the file"),
    ],
)
def test_damaged_files_are_refused_clearly(written: Path, name: str, words: str) -> None:
    with h5py.File(written, "r+") as file:
        damage(name)(file)
    assert words in refusal(written)


def test_truncated_files_raise_file_errors(tmp_path: Path, whole_file: bytes) -> None:
    data = whole_file
    assert len(data) == int.from_bytes(data[28:36], "little")  # its end, as the superblock has it
    for share in (0.0, 0.001, 0.01, 0.3, 0.9, 0.999):
        path = tmp_path / f"cut{share}.h5"
        path.write_bytes(data[: int(share * len(data))])
        assert "cut short" in refusal(path) or "not an HDF5 file" in refusal(path)


def test_an_open_file_is_checked_once_for_all_fields(written: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the file says of itself is read once for each time it is opened, not for each field."""
    result = load(written)
    read, heads = file_source._read_head, []
    monkeypatch.setattr(file_source, "_read_head", lambda *given: heads.append(1) or read(*given))
    with result._source.held_open():
        for entry in result.fields[:5]:
            result._source.read(entry.name)
    assert len(heads) == 1
    result._source.read(result.fields[5].name)
    assert len(heads) == 2


def test_damage_that_shows_when_a_bearing_is_looked_for_is_said(written: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file was damaged after it was loaded: HDF5's own error is none that users can do something with."""
    result = load(written)

    def broken(*_: Any) -> None:
        raise RuntimeError("bad object header version number")

    monkeypatch.setattr(file_source, "part_of", broken)
    with pytest.raises(FileError, match=r"run\.h5.*damaged"), result._source.held_open():
        raise AssertionError


def test_a_file_replaced_behind_its_result_is_noticed(written: Path, synthetic: Any, stub_scene: Any) -> None:
    loaded = load(written)
    time_before = loaded.time
    write(written, synthetic, stub_scene, overwrite=True)
    assert loaded.time is time_before
    with pytest.raises(FileError, match="replaced"):
        loaded.cage_position  # noqa: B018


def test_files_that_cannot_be_made(tmp_path: Path, synthetic: Any, stub_scene: Any) -> None:
    with pytest.raises(FileError, match=r"cannot be written: there is no folder"):
        write(tmp_path / "missing" / "run.h5", synthetic, stub_scene)
    with (
        ResultWriter(tmp_path / "open.h5", Part(stub_scene, synthetic.layout, synthetic.fields)),
        pytest.raises(FileError),
    ):
        write(tmp_path / "open.h5", synthetic, stub_scene)
    with pytest.raises(InputError, match="groups"):
        write(tmp_path / "run.h5", synthetic, stub_scene, groups=["wheels"])
    assert not (tmp_path / "run.h5").exists()


def test_a_summary_is_written(tmp_path: Path, whirling: Result) -> None:
    from trbdyn.results import summary

    values = whirling.summary()
    assert (values["steps"], values["rhs_evaluations"]) == (1234, 5678)
    assert values["orbit_rms_over_cpr"] == pytest.approx(0.9, rel=1e-2)
    assert (values["settled"], values["settling"]) == (False, "unknown")
    written = json.loads(summary.write_json(values, tmp_path / "summary.json").read_text())
    assert written == values
    text = summary.table(values)
    assert "orbit radius of the cage about its mean place, rms / Cpr" in text
    assert "cannot be told: only" in text
    assert "0.9" in text
    with pytest.raises(FileError, match="cannot be written"):
        summary.write_json(values, tmp_path / "missing" / "summary.json")
    with pytest.raises(ValueError, match="JSON compliant"):  # JSON has no nan: a reader would refuse the file
        summary.write_json({"torque": math.nan}, tmp_path / "nan.json")


def test_summary_leaves_out_what_was_not_recorded(whirling: Result) -> None:
    values = whirling.select(["torque"]).summary()
    assert values["torque"] == pytest.approx(1.25, rel=1e-2)
    assert "orbit_rms_over_cpr" not in values
    assert (values["settling"], values["settled"]) == ("unknown", False)
    assert "energy_closure" not in values
    assert json.dumps(values, allow_nan=False)


def test_fields_of_a_file_cannot_be_changed_by_mistake(tmp_path: Path) -> None:
    scene = trb.cases.paper_30310(3000.0, 4930.0)
    result = trb.Simulation(scene).run(duration=1e-3, output=tmp_path / "run.h5")
    for one in (result, trb.load(tmp_path / "run.h5")):
        with pytest.raises(ValueError, match="read-only"):
            one["cage_position"][0] = 0.0


def test_power_split_needs_the_powers_or_the_energies() -> None:
    scene = trb.cases.paper_30310(3000.0, 4930.0)
    for group in ("power", "energy"):
        found = trb.Simulation(scene).run(duration=2e-3, save_groups=("cage", group)).power_split
        assert found["rolling"] > 0.0
    with pytest.raises(InputError, match="power"):
        _ = trb.Simulation(scene).run(duration=2e-3, save_groups=("cage",)).power_split


def test_a_summary_opens_the_file_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Records of many fields are read with the file opened once; the answers are those of records in memory."""
    path = tmp_path / "run.h5"
    scene = trb.cases.paper_30310(3000.0)
    in_memory = trb.Simulation(scene).run(duration=2e-3, save_every=1e-4)
    trb.Simulation(scene).run(duration=2e-3, save_every=1e-4, output=path)
    result, opens = trb.load(path), []
    ordinary = file_source.open_to_read
    monkeypatch.setattr(file_source, "open_to_read", lambda place: opens.append(place) or ordinary(place))
    found, wanted = result.summary(), in_memory.summary()
    assert len(opens) == 1
    for name in ("torque", "axis_distance_over_cpr", "cage_speed_ratio"):
        assert found[name] == pytest.approx(wanted[name], rel=1e-6)
    with pytest.raises(KeyError, match="mine"), result._source.held_open():
        raise KeyError("mine")
    again = trb.load(path)
    path.unlink()
    with pytest.raises(FileError, match="there is no such file"):
        again.summary()


def test_a_law_outside_of_its_range_says_so() -> None:
    """By hand: W = Q/(l E' Re) of a roller's outer contact under 4930 N, and G = alpha0 E' of a cold oil."""
    from trbdyn.results.notes import load_groups

    default = trb.cases.scene_30310(3000.0, 4930.0)
    other = default.replace(effects=default.effects.replace(rolling_law="zhou_hoeprich"))
    result = trb.Simulation(other).run(duration=2e-3, save_every=1e-4)
    assert load_groups(result).min() == pytest.approx(1832.9 / (19.8e-3 * 226.37e9 * 8.163e-3), rel=0.01)
    note = result.summary()["rolling_note"]
    assert "zhou_hoeprich" in note
    assert "100 % of the loaded contacts lie outside, W is 5e-05 to " in note
    assert "rolling_note" not in trb.Simulation(default).run(duration=2e-3).summary()
    tilted = default.replace(misalignment_x=3e-4)
    assert "tilted ring" in trb.Simulation(tilted).run(duration=2e-3).summary()["rolling_note"]
    oil = default.lubricant.replace(pressure_coefficient=3e-8, pressure_law="barus", dicke=None)
    cold = trb.Simulation(default.replace(lubricant=oil)).run(duration=2e-3, save_groups=("cage", "rollers", "torque"))
    assert "G = alpha0 E' is 6791" in cold.summary()["rolling_note"]
    inside = trb.cases.scene_30310(3000.0, 15_000.0).replace(effects=other.effects)
    assert "rolling_note" not in trb.Simulation(inside).run(duration=2e-3, save_every=1e-4).summary()
