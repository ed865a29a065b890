"""Runs that are killed at random times, and resumed until they end, give the same bits as one that was never interrupted."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared import assert_same_fields, environment

import trbdyn as trb
from trbdyn import study
from trbdyn.errors import FileError
from trbdyn.model.cases import paper_30310
from trbdyn.results.file_source import FileSource
from trbdyn.run import checkpoint
from trbdyn.run.options import RunOptions

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")

SCHEDULE: dict[str, Any] = {"duration": 0.04, "save_every": 1e-4, "checkpoint_every": 4e-3}

RUN = """
import sys
import trbdyn as trb
from trbdyn.results import result_file
from trbdyn.model.cases import paper_30310

result_file.FLUSH_SECONDS = 0.02
scene = paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))
print("ready", flush=True)
trb.Simulation(scene).run(duration=0.04, save_every=1e-4, checkpoint_every=4e-3, output=sys.argv[1])
"""

RESUME = """
import sys
import trbdyn as trb
from trbdyn.results import result_file

result_file.FLUSH_SECONDS = 0.02
print("ready", flush=True)
trb.resume(sys.argv[1])
"""


def whirl() -> trb.Scene:
    """The scene of all runs here: chaotic enough that one bit more or less shows at its end."""
    return paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory: pytest.TempPathFactory) -> trb.Result:
    """The run without an interruption."""
    path: Path = tmp_path_factory.mktemp("uninterrupted") / "run.h5"
    return trb.Simulation(whirl()).run(**SCHEDULE, output=path)


def start(script: str, path: Path) -> subprocess.Popen[bytes]:
    """A process that has imported the package and begins to step."""
    process = subprocess.Popen(
        [sys.executable, "-P", "-W", "ignore", "-c", script, str(path)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment(),
    )
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    return process


def same(result: Any, reference: Any) -> None:
    """Every record and the final state, to the last bit."""
    assert result.success, result.message
    assert len(result) == len(reference)
    assert result.final_time == reference.final_time
    np.testing.assert_array_equal(result.final_state.view(np.int64), reference.final_state.view(np.int64))
    assert_same_fields(result, reference)
    for name in reference.peaks:
        np.testing.assert_array_equal(result.peaks[name], reference.peaks[name], err_msg=name)
    for name in ("steps", "rhs_evaluations", "jacobian_evaluations", "restarts", "smallest_step"):
        assert result.stats[name] == reference.stats[name]
    assert result.counters == reference.counters


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(1, 10))])
def test_random_kills_change_no_bit(tmp_path: Path, uninterrupted: trb.Result, seed: int) -> None:
    """At least two kills a seed, twenty in all, wherever they come: at the start, in a write, in a resumed run."""
    draw = random.Random(seed)
    path = tmp_path / "run.h5"
    wall = float(uninterrupted.stats["wall_s"])
    kills, script = 0, RUN
    while kills < 2:
        process = start(script, path)
        time.sleep(draw.uniform(0.0, 0.45) * wall)
        process.send_signal(signal.SIGKILL)
        _, said = process.communicate()
        if process.returncode == 0 or (path.exists() and trb.load(path).success):
            # the run had ended before the signal came: once more from the start
            same(trb.load(path), uninterrupted)
            path.unlink()
            script = RUN
            continue
        assert process.returncode == -signal.SIGKILL, said.decode()
        kills += 1
        if path.exists():
            partial = trb.load(path)
            assert not partial.success
            np.testing.assert_array_equal(partial.time, uninterrupted.time[: len(partial)])
        newest = checkpoint.checkpoint_path(path)
        if newest.exists() or checkpoint.previous_path(newest).exists():
            script = RESUME
        else:
            # killed before its first checkpoint: nothing to resume, and a new run replaces no file unasked
            path.unlink(missing_ok=True)
    process = start(script, path)
    _, said = process.communicate()
    assert process.returncode == 0, said.decode()
    same(trb.load(path), uninterrupted)
    assert not checkpoint.checkpoint_path(path).exists()


def test_a_reader_follows_live(tmp_path: Path, uninterrupted: trb.Result) -> None:
    path = tmp_path / "run.h5"
    process = start(RUN, path)
    seen: list[int] = []
    while process.poll() is None:
        time.sleep(0.03)
        if path.exists():
            live = trb.load(path)
            np.testing.assert_array_equal(live.time, uninterrupted.time[: len(live)])
            np.testing.assert_array_equal(live.cage_position, uninterrupted.cage_position[: len(live)])
            seen.append(len(live))
    assert process.returncode == 0
    assert seen == sorted(seen)
    assert len(set(seen)) > 3
    same(trb.load(path), uninterrupted)


def test_one_run_one_writer(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    process = start(RUN, path)
    while not checkpoint.checkpoint_path(path).exists():
        time.sleep(0.01)
    try:
        with pytest.raises(FileError, match="another run is writing it"):
            trb.resume(path)
        with pytest.raises(FileError, match="another run is writing it"):
            trb.Simulation(whirl()).run(duration=1e-3, output=path, overwrite=True)
    finally:
        process.kill()
        process.communicate()
    trb.resume(path)
    assert FileSource(path).info.success
    assert [place.name for place in tmp_path.iterdir()] == ["run.h5"]


@pytest.mark.slow
def test_the_command_line_resumes(tmp_path: Path, uninterrupted: trb.Result) -> None:
    path = tmp_path / "run.h5"
    process = start(RUN, path)
    while not checkpoint.previous_path(checkpoint.checkpoint_path(path)).exists():
        time.sleep(0.005)
    process.kill()
    process.communicate()
    words = [sys.executable, "-P", "-m", "trbdyn", "resume", str(path), "--quiet"]
    done = subprocess.run(words, capture_output=True, env=environment(), check=False)
    assert done.returncode == 0, done.stderr.decode()
    same(trb.load(path), uninterrupted)


FULL = """
import resource, signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (MOST, MOST))
"""


@pytest.mark.parametrize(
    "limit", [1_500_000, *(pytest.param(size, marks=pytest.mark.slow) for size in (1_000_000, 2_000_000))]
)
def test_a_full_disk_loses_nothing(tmp_path: Path, uninterrupted: trb.Result, limit: int) -> None:
    path = tmp_path / "run.h5"
    process = start(FULL.replace("MOST", str(limit)) + RUN, path)
    _, said = process.communicate()
    assert process.returncode == 1
    assert b"FileError" in said
    partial = trb.load(path)
    np.testing.assert_array_equal(partial.time, uninterrupted.time[: len(partial)])
    same(trb.resume(path), uninterrupted)


STUDY = """
import os, sys
import trbdyn as trb
from trbdyn import study
from trbdyn.model.cases import scene_30310
from trbdyn.run.options import RunOptions

if __name__ == "__main__":
    print("ready", flush=True)
    cases = study.grid(scene_30310(), {"scene.speed_rpm": [1000, 2000, 3000]}, RunOptions(duration=float(sys.argv[2])))
    study.run(cases, sys.argv[1], workers=2)
"""


def children(pid: int) -> list[int]:
    """Processes that a process has started."""
    found = Path(f"/proc/{pid}/task/{pid}/children")
    return [int(word) for word in found.read_text().split()] if found.exists() else []


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="needs /proc")
def test_workers_of_a_killed_study_end_and_the_next_start_cleans_up(tmp_path: Path) -> None:
    script, folder = tmp_path / "study_of_three.py", tmp_path / "study"
    script.write_text(STUDY)
    words = [sys.executable, "-P", str(script), str(folder)]
    process = subprocess.Popen([*words, "1000.0"], stdout=subprocess.DEVNULL, env=environment())
    try:
        # both workers are in the middle of a case that would take hours
        until = time.monotonic() + 60.0
        while len(list(folder.glob(".*.h5.part"))) < min(2, os.cpu_count() or 1) and time.monotonic() < until:
            time.sleep(0.05)
        workers = children(process.pid)
        assert len(workers) >= 2, "the workers, and the process that looks after what they share"
    finally:
        process.kill()
        process.wait()
    until = time.monotonic() + 5.0
    while any(map(is_alive, workers)) and time.monotonic() < until:
        time.sleep(0.05)
    assert not [pid for pid in workers if is_alive(pid)]
    cases = study.grid(whirl(), {"scene.speed_rpm": [1000]}, RunOptions(duration=1e-4))
    (folder / f"..{cases.cases[0].name}.h5.part.0123456789ab.new").touch()
    study.run(cases, folder, executor="serial")
    # a worker on a machine with much other work may have had no time to take its own file away; its case replaces it
    assert not list(folder.glob(f".*{cases.cases[0].name}*"))
