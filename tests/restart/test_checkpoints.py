"""The schedule, the checkpoint file, and what is made of damaged ones."""

from __future__ import annotations

import json
import math
import shutil
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared import Cut, assert_same_fields, cut_after

import trbdyn as trb
from trbdyn import _core
from trbdyn.errors import FileError, InputError
from trbdyn.model.cases import paper_30310
from trbdyn.run import checkpoint
from trbdyn.run.checkpoint import Checkpoint, checkpoint_path, next_time, previous_path

EVERY, END = 0.9e-3, 5e-3
GROUPS = ("cage", "rollers", "energy", "peaks")  # those that are compared


def scene() -> trb.Scene:
    return paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))


def run(output: Path | None = None, **options: Any) -> trb.Result:
    chosen: dict[str, Any] = {
        "duration": END,
        "checkpoint_every": EVERY,
        "save_every": 2e-5,
        "save_groups": GROUPS,
    } | options
    return trb.Simulation(scene()).run(output=output, **chosen)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> trb.Result:
    """In a file, as the runs that are compared with it: forces have 7 digits there."""
    return run(tmp_path_factory.mktemp("reference") / "run.h5")


@pytest.fixture(scope="module")
def cut(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that an exception has ended half way."""
    folder = tmp_path_factory.mktemp("cut")
    with pytest.raises(Cut):
        run(folder / "run.h5", callback=cut_after(3e-3))
    return folder


@pytest.fixture
def broken(cut: Path, tmp_path: Path) -> Path:
    """A copy of this run with its checkpoints."""
    shutil.copytree(cut, tmp_path, dirs_exist_ok=True)
    return tmp_path / "run.h5"


def same(result: trb.Result, reference: trb.Result) -> None:
    assert result.success, result.message
    assert reference.final_state is not None
    np.testing.assert_array_equal(result.final_state, reference.final_state)
    names = ("time", "cage_position", "roller_position", "work_shaft", "pocket_force_peak", "pocket_impulse_peak")
    assert_same_fields(result, {name: reference[name] for name in names})
    for name in reference.peaks:
        np.testing.assert_array_equal(result.peaks[name], reference.peaks[name], err_msg=name)


@pytest.mark.parametrize("save_every", [3.3e-5, 1.0])
def test_output_times_change_no_bit(reference: trb.Result, save_every: float) -> None:
    other = run(save_every=save_every)
    np.testing.assert_array_equal(other.final_state, reference.final_state)
    assert other.stats["steps"] == reference.stats["steps"]
    assert other.stats["restarts"] == reference.stats["restarts"] == 1 + int(END / EVERY)
    for name in reference.peaks:
        np.testing.assert_array_equal(other.peaks[name], reference.peaks[name], err_msg=name)


@pytest.mark.parametrize(
    ("integrator", "share"), [("bdf", 1.0), pytest.param("erk", 0.125, marks=pytest.mark.slow), ("multirate", 1.0)]
)
def test_runs_in_pieces_follow_one_schedule(integrator: str, share: float, tmp_path: Path) -> None:
    """Progress, callbacks, files and the borders between runs change nothing."""
    every, second, end = share * EVERY, share * 0.003, share * 0.008
    whole = trb.Simulation(scene(), integrator=integrator, checkpoint_every=every)
    whole.run(duration=end, save_every=share * 1e-3)
    pieces = trb.Simulation(scene(), integrator=integrator, checkpoint_every=every)
    pieces.run(duration=every, save_every=1e-5, output=tmp_path / "run.h5")
    pieces.run(duration=second, callback=lambda sim: None)
    pieces.run(duration=end - second - every, progress=True)
    np.testing.assert_array_equal(pieces.state.vector, whole.state.vector)
    assert pieces.statistics == whole.statistics
    assert pieces.counters == whole.counters


def test_a_schedule_is_a_part_of_the_run(reference: trb.Result) -> None:
    """Without it, or with another one, steps differ, and so does what is chaotic; what is not agrees."""
    other = run(checkpoint_every=None)
    assert other.stats["restarts"] == 1
    assert (other.final_state != reference.final_state).any()
    np.testing.assert_allclose(other.orbit_radius.mean(), reference.orbit_radius.mean(), rtol=0.02)


def test_times_of_the_schedule() -> None:
    assert next_time(0.0, None) == math.inf
    assert next_time(0.0, 0.1) == 0.1
    assert next_time(0.1, 0.1) == 0.2
    assert next_time(-0.25, 0.1) == pytest.approx(-0.2)
    for every in (1e-9, 1e-3, 1 / 3, 0.7):
        at = 0.0
        for _ in range(1000):
            later = next_time(at, every)
            assert at < later <= at + every * (1 + 1e-9)
            at = later


def test_every_run_that_ended_early_goes_on(broken: Path, reference: trb.Result) -> None:
    assert "Cut" in trb.load(broken).message
    result = trb.resume(broken)
    same(result, reference)
    assert result.stats["steps"] == reference.stats["steps"]
    assert [path.name for path in sorted(broken.parent.iterdir())] == ["run.h5"]
    same(trb.resume(broken), reference)
    with pytest.raises(ValueError, match="read-only"):
        result["cage_position"][0] = 0.0


def test_a_run_resumed_and_broken_again(broken: Path, reference: trb.Result) -> None:
    for later in (3.6e-3, 4.3e-3):
        with pytest.raises(Cut):
            trb.resume(broken, callback=cut_after(later))
    same(trb.resume(broken), reference)
    assert [path.name for path in broken.parent.iterdir()] == ["run.h5"]


def test_a_new_run_takes_the_place_of_an_old_one(broken: Path, reference: trb.Result) -> None:
    trb.resume(broken)
    result = run(broken, overwrite=True)
    same(result, reference)
    assert [path.name for path in sorted(broken.parent.iterdir())] == ["run.h5"]


def damage(data: bytes, how: str) -> bytes:
    match how:
        case "empty":
            return b""
        case "short":
            return data[: len(data) // 2]
        case "one byte less":
            return data[:-1]
        case "one bit":
            middle = len(data) // 2
            return data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :]
        case "noise":
            return np.random.default_rng(1).bytes(len(data))
        case _:
            return b"trbdyn-checkpoint 99\n" + data.split(b"\n", 1)[1]


HOW = ["empty", "short", "one byte less", "one bit", "noise", "later version"]


def falls_back(broken: Path) -> str:
    """What is told when a run goes on from the checkpoint before the newest one, which cannot be used."""
    before = checkpoint.read(previous_path(checkpoint_path(broken)))
    told: list[str] = []
    assert checkpoint.read_last_good(broken, told.append).to_bytes() == before.to_bytes()
    (text,) = told
    assert "going on from the one before it" in text
    return text


def test_the_last_good_checkpoint_is_used_and_said(broken: Path, reference: trb.Result) -> None:
    newest = checkpoint_path(broken)
    whole = newest.read_bytes()
    for how in HOW:
        newest.write_bytes(damage(whole, how))
        falls_back(broken)
    with pytest.warns(UserWarning, match="going on from the one before it"):
        result = trb.resume(broken)
    same(result, reference)
    assert "going on from the one before it" in result.meta["notes"][0]


def test_a_missing_checkpoint_falls_back_too(broken: Path, reference: trb.Result) -> None:
    checkpoint_path(broken).unlink()
    with pytest.warns(UserWarning, match="no such file"):
        same(trb.resume(broken), reference)


@pytest.mark.parametrize("how", HOW)
def test_without_a_good_checkpoint_nothing_is_touched(broken: Path, how: str) -> None:
    for path in (checkpoint_path(broken), previous_path(checkpoint_path(broken))):
        path.write_bytes(damage(path.read_bytes(), how))
    before = trb.load(broken).time
    with pytest.raises(FileError, match=r"run\.h5\.checkpoint: .*; .*run\.h5\.checkpoint\.previous: "):
        trb.resume(broken)
    np.testing.assert_array_equal(trb.load(broken).time, before)


def test_runs_without_a_schedule_cannot_be_resumed(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    with pytest.raises(Cut):
        run(path, callback=cut_after(0.0), checkpoint_every=None)
    with pytest.raises(FileError, match="no schedule of checkpoints"):
        trb.resume(path)
    with pytest.raises(FileError, match="no such file"):
        trb.resume(tmp_path / "nothing.h5")


def test_a_checkpoint_of_another_run_is_refused(broken: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.h5"
    with pytest.raises(Cut):
        run(other, callback=cut_after(2e-3))
    checkpoint_path(other).replace(checkpoint_path(broken))
    with pytest.raises(FileError, match="belongs to another run"):
        trb.resume(broken)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.95])
def test_a_damaged_result_file_costs_its_own_records_alone(broken: Path, reference: trb.Result, share: float) -> None:
    data = broken.read_bytes()
    broken.write_bytes(data[: int(share * len(data))])
    with pytest.warns(UserWarning, match="its records are lost"):
        part = trb.resume(broken)
    assert part.success
    part = trb.load(broken)
    assert "records of it are missing" in part.message
    kept = broken.with_name("run.h5.damaged")
    assert kept.exists() is bool(share), "what is left of the damaged one is kept"
    np.testing.assert_array_equal(part.final_state, reference.final_state)
    np.testing.assert_array_equal(part.cage_position, reference.cage_position[-len(part) :])


def test_a_lost_result_file_before_the_first_checkpoint_is_made_anew(tmp_path: Path, reference: trb.Result) -> None:
    path = tmp_path / "run.h5"
    with pytest.raises(Cut):
        run(path, callback=cut_after(0.0))
    start = previous_path(checkpoint_path(path))
    if start.exists():
        start.replace(checkpoint_path(path))
    path.write_bytes(b"")
    if checkpoint.read(checkpoint_path(path)).done == 0:
        with pytest.warns(UserWarning, match="its records are lost"):
            same(trb.resume(path), reference)


def change(path: Path, **changes: Any) -> None:
    """Other values in a checkpoint, under a checksum that fits."""
    found = checkpoint.read(path)
    values = {name: getattr(found, name) for name in Checkpoint.__dataclass_fields__}
    checkpoint.write(path, Checkpoint(**values | changes))


def test_another_instruction_set_is_said_and_can_be_forced(broken: Path) -> None:
    with pytest.warns(UserWarning, match="going on with instruction set scalar instead of"):
        result = trb.resume(broken, instruction_set="scalar")
    assert result.success
    assert result.meta["instruction_set"] == "scalar"


def test_the_same_instruction_set_by_name_says_nothing(broken: Path, reference: trb.Result) -> None:
    named = checkpoint.read(checkpoint_path(broken)).instruction_set
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message="going on with instruction set")
        same(trb.resume(broken, instruction_set=named), reference)


def test_an_instruction_set_that_this_machine_lacks(broken: Path) -> None:
    change(checkpoint_path(broken), instruction_set="avx4096")
    with pytest.raises(InputError, match=r"avx4096.*this machine runs"):
        trb.resume(broken)
    with pytest.raises(InputError, match="must be one of"):
        trb.resume(broken, instruction_set="mmx")
    with pytest.warns(UserWarning, match="instead of avx4096"):
        assert trb.resume(broken, instruction_set=_core.instruction_sets()[-1]).success


def test_another_build_is_said(broken: Path, reference: trb.Result) -> None:
    change(checkpoint_path(broken), build="0" * 64)
    with pytest.warns(UserWarning, match="another build"):
        same(trb.resume(broken), reference)


@pytest.mark.parametrize(
    "changes",
    [
        {"scene": {}},
        {"scene": {"bearing": 3}},
        {"model": "0" * 64},
        {"options": {"rtol": -1.0}},
        {"options": {"nonsense": 1}},
        {"state": np.zeros(3)},
        {"state": np.full(10_000, 1e300)},
        {"done": 10**9},
        {"peaks": np.zeros(3)},
    ],
)
def test_checkpoints_that_say_what_cannot_be_are_refused(broken: Path, changes: dict[str, Any]) -> None:
    change(checkpoint_path(broken), **changes)
    with pytest.raises(FileError, match="cannot be used"):
        trb.resume(broken)


def test_a_checkpoint_of_a_core_that_takes_other_numbers_is_told_from_a_damaged_one(broken: Path) -> None:
    change(checkpoint_path(broken), model="0" * 64)
    with pytest.raises(FileError, match="is not the one that its model hash belongs to"):
        trb.resume(broken)
    change(checkpoint_path(broken), build="0" * 64)
    with pytest.raises(FileError, match=r"another build wrote it.*run the scene again from its start"):
        trb.resume(broken)


def test_checkpoints_of_wrong_kinds_fall_back(broken: Path) -> None:
    path = checkpoint_path(broken)
    found = checkpoint.read(path)
    values = {name: getattr(found, name) for name in Checkpoint.__dataclass_fields__}
    wrong: list[dict[str, Any]] = [
        {"time": "now"},
        {"done": -1},
        {"done": True},
        {"start": 1.0, "end": 0.0},
        {"counters": {"pocket": "three"}},
        {"state": np.array([np.nan])},
        {"peaks": np.array([np.nan])},
    ]
    for changes in wrong:
        path.write_bytes(Checkpoint(**values | changes).to_bytes())
        assert "cannot be used" in falls_back(broken), changes


def test_the_file_is_small_and_readable(broken: Path) -> None:
    data = checkpoint_path(broken).read_bytes()
    assert len(data) < 100_000
    name, _, head = data.split(b"\n")[:3]
    assert name == b"trbdyn-checkpoint 4"
    values = json.loads(head)
    assert values["instruction_set"] in _core.instruction_sets()
    assert values["model"] == scene().fingerprint


def test_a_checkpoint_that_cannot_be_written_leaves_the_old_ones(broken: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = checkpoint_path(broken)
    before = path.read_bytes()

    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(checkpoint.os, "fsync", full)
    with pytest.raises(FileError, match="No space left"):
        checkpoint.write(path, checkpoint.read(path))
    assert path.read_bytes() == before
    assert not list(path.parent.glob(".*"))


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, 1e-12, "often", True])
def test_schedules_that_cannot_be(value: Any) -> None:
    with pytest.raises(InputError, match="checkpoint_every"):
        trb.Simulation(scene()).run(duration=1e-3, checkpoint_every=value)
