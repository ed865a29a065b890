"""Runs of bearings on a shaft that were cut off go on from their checkpoints."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from shared import assert_same_fields

import trbdyn as trb
from trbdyn.errors import FileError
from trbdyn.run import running
from trbdyn.run.checkpoint import checkpoint_path
from trbdyn.run.running import Run

HOUSING = trb.SharedHousing.hollow_cylinder(
    mass=12.0, inner_diameter=0.11, outer_diameter=0.16, length=0.25
).on_supports((-0.1, 0.1), radial=1e8, axial=5e7)


def simulation(housing: trb.SharedHousing | None = None, **options: object) -> trb.Simulation:
    subject = trb.load_assembly("pair_30310").replace(shared_housing=housing)
    return trb.Simulation(subject, accuracy="fast", **options)


class Cut(BaseException):
    """In place of a kill."""


def cut_off(
    path: Path,
    after: float,
    monkeypatch: pytest.MonkeyPatch,
    housing: trb.SharedHousing | None = None,
    **how: object,
) -> None:
    """A run of 0.25 turns that ends at a time as if it were killed: nothing is written after that."""
    sim = simulation(housing, checkpoint_every=1e-3)
    keep = Run._keep

    def watched(self: Run, records: np.ndarray) -> None:
        keep(self, records)
        if self.sim.time >= after:
            raise Cut

    def killed(self: Run, *_: object) -> None:
        assert self.writer is not None
        self.writer._waiting.take()
        self.writer._let_go()

    with monkeypatch.context() as patch:
        patch.setattr(Run, "_keep", watched)
        patch.setattr(Run, "_finish", killed)
        patch.setattr(running, "_hand_over", lambda *_: None)
        with pytest.raises(Cut):
            sim.run(revolutions=0.25, save_every=1e-4, output=path, **how)


def test_a_pair_in_one_housing_goes_on_to_the_same_bits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A pair that is held: tests/api/test_both_subjects.py."""
    sim = simulation(HOUSING, checkpoint_every=1e-3)
    whole = sim.run(revolutions=0.25, save_every=1e-4, output=tmp_path / "whole.h5")
    path = tmp_path / "pair.h5"
    cut_off(path, 3.5e-3, monkeypatch, HOUSING)
    assert not trb.load(path).success
    assert checkpoint_path(path).exists()
    resumed = trb.resume(path)
    assert isinstance(resumed, trb.AssemblyResult)
    assert resumed.success
    assert resumed.assembly == whole.assembly
    assert not checkpoint_path(path).exists()
    assert sorted(place.name for place in tmp_path.iterdir()) == ["pair.h5", "whole.h5"]
    for name in whole:
        one, other = whole[name], resumed[name]
        assert len(one) == len(other) == 51
        assert_same_fields(one, other)
        assert one.summary()["steps"] == other.summary()["steps"]
        assert one.summary()["pocket_force_peak"] == other.summary()["pocket_force_peak"]
    again = trb.resume(path)
    assert isinstance(again, trb.AssemblyResult)
    assert again.success


def test_what_a_cut_off_pair_needs_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "pair.h5"
    cut_off(path, 2.5e-3, monkeypatch)
    with pytest.raises(FileError, match=r"another run|overwrite"):
        simulation().run(revolutions=0.1, output=path, checkpoint_every=1e-3)
    for wanted in ("left", "right"):
        assert len(trb.load(path, bearing=wanted)) >= 10
    path.unlink()
    with pytest.warns(UserWarning, match="its records are lost"):
        resumed = trb.resume(path, callback=lambda sim: False)
    assert resumed.success
    assert "records of it are missing" in resumed.message
    with pytest.raises(FileError, match="no such file"):
        trb.resume(tmp_path / "other.h5")


def test_a_pair_that_replaces_another_leaves_no_checkpoints(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "pair.h5"
    cut_off(path, 2.5e-3, monkeypatch)
    assert checkpoint_path(path).exists()
    simulation().run(revolutions=0.05, output=path, overwrite=True)
    assert [place.name for place in tmp_path.iterdir()] == ["pair.h5"]
    assert trb.resume(path).success


def test_a_file_of_the_version_before_is_read(tmp_path: Path) -> None:
    """A pair that an earlier trbdyn wrote, with its bearings put together at the end of the run."""
    path = tmp_path / "pair.h5"
    path.write_bytes((Path(__file__).parent / "pair_version_1.h5").read_bytes())
    old = trb.load(path)
    assert list(old) == ["left", "right"]
    assert old.success
    assert old.assembly is not None
    assert old.assembly.names == ("left", "right")
    for one in old.values():
        assert one.cage_position.shape == (5, 3)
        assert np.abs(one.cage_position).max() < 1e-3
    assert trb.resume(path).success


@pytest.mark.slow
def test_a_killed_command_is_resumed(tmp_path: Path) -> None:
    words = ["run", "pair_30310", "-o", "pair.h5", "--revolutions", "4", "--checkpoint-every", "1e-3", "--quiet"]
    process = subprocess.Popen([sys.executable, "-m", "trbdyn", *words], cwd=tmp_path)
    path = tmp_path / "pair.h5"
    begun = time.monotonic()
    while not checkpoint_path(path).exists() and time.monotonic() - begun < 60.0:
        time.sleep(0.01)
    time.sleep(0.3)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not trb.load(path).success
    done = subprocess.run(
        [sys.executable, "-m", "trbdyn", "resume", "pair.h5"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert "radial load, mean, N" in done.stdout
    result = trb.load(path)
    assert result.success
    times = result["left"]["time"]
    assert times[0] == 0.0
    assert np.ptp(np.diff(times)) < 1e-9
    assert trb.load(path)["right"].message == f"reached {times[-1]:.6g} s"
    assert os.listdir(tmp_path) == ["pair.h5"]
