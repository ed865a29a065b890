"""Whatever lies beside a run, and whatever happens to its file: nobody's file is lost, and the run's own records are
kept.
"""

from __future__ import annotations

import contextlib
import os
import signal
import stat
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared import Cut, cut_after, environment

import trbdyn as trb
from trbdyn.base.locks import take_lock
from trbdyn.cli import main
from trbdyn.errors import FileError, InputError, TrbError
from trbdyn.model.cases import paper_30310
from trbdyn.run import checkpoint
from trbdyn.run.checkpoint import checkpoint_path, previous_path

SPAN: dict[str, Any] = {"duration": 4e-3, "save_every": 1e-5, "save_groups": ("cage", "energy")}
FOREIGN = b"days of work of somebody else\n"


def run(output: Path | str, **options: Any) -> trb.Result:
    return trb.Simulation(paper_30310()).run(output=output, **SPAN | options)


def cut_run(output: Path, after: float = 0.0, **options: Any) -> None:
    with pytest.raises(Cut):
        run(output, callback=cut_after(after), **{"checkpoint_every": 1e-3} | options)


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


# ---- what lies there already ----


def test_the_command_line_replaces_only_if_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, summary = tmp_path / "run.h5", tmp_path / "summary.json"
    words = ["run", "rig_30310", "--duration", "1e-4", "--quiet", "-o", str(path), "--summary", str(summary)]
    assert main(words) == 0
    before = path.read_bytes(), summary.read_bytes()
    assert main(words) == 2
    assert "--overwrite" in capsys.readouterr().err
    path.rename(tmp_path / "other.h5")
    assert main(words) == 2, "the summary is there still"
    assert not path.exists()
    assert (tmp_path / "other.h5").read_bytes(), summary.read_bytes() == before
    assert main([*words, "--overwrite"]) == 0
    assert main([*words[:-1], str(path), "--overwrite"]) == 2, "result and summary are one file"
    assert trb.load(path).success


def test_a_file_that_appears_while_a_run_is_prepared_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from trbdyn.results import hdf5_file

    path, make = tmp_path / "run.h5", hdf5_file.make

    def meanwhile(*arguments: Any, **options: Any) -> None:
        make(*arguments, **options)
        path.write_bytes(FOREIGN)

    monkeypatch.setattr(hdf5_file, "make", meanwhile)
    with pytest.raises(FileError, match="exists already"):
        run(path)
    assert path.read_bytes() == FOREIGN
    assert names(tmp_path) == ["run.h5"]


def test_files_with_names_like_a_runs_stay(tmp_path: Path) -> None:
    """A run is one file, also when it has been resumed: whatever lies beside it is not its own."""
    path = tmp_path / "run.h5"
    cut_run(path, 2e-3)
    text, other = tmp_path / "run.part2.h5", tmp_path / "run.part3.h5"
    text.write_bytes(FOREIGN)
    run(other, duration=1e-4)
    trb.resume(path)
    run(path, duration=1e-4, overwrite=True)
    assert names(tmp_path) == ["run.h5", "run.part2.h5", "run.part3.h5"]
    assert text.read_bytes() == FOREIGN
    assert trb.load(other).success


def test_drafts_that_a_killed_process_left_are_removed_at_the_next_start(tmp_path: Path) -> None:
    """Those of this file only, and none that somebody is writing."""
    path, dead, alive = tmp_path / "run.h5", ".run.h5.0123456789ab.new", ".run.h5.ba9876543210.new"
    (tmp_path / ".run.h5.checkpoint.0123456789ab.new").write_bytes(FOREIGN)
    others = [".other.h5.0123456789ab.new", ".run.h5.notes.new", ".run.h5.mine"]
    for name in (dead, alive, *others):
        (tmp_path / name).write_bytes(FOREIGN)
    with take_lock(tmp_path / alive):
        assert run(path, checkpoint_every=1e-3).success
    assert names(tmp_path) == sorted(["run.h5", alive, *others])


KILLED_IN_A_DRAFT = """
import os, signal, sys
import trbdyn as trb
from trbdyn.model.cases import scene_30310
from trbdyn.results import result_file

result_file.put_in_place = lambda *rest, **options: os.kill(os.getpid(), signal.SIGKILL)
trb.Simulation(scene_30310()).run(duration=1e-3, output=sys.argv[1])
"""


def test_a_run_that_is_killed_before_its_file_appears_leaves_nothing_for_long(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    words = [sys.executable, "-P", "-c", KILLED_IN_A_DRAFT, str(path)]
    assert subprocess.run(words, env=environment(), check=False).returncode == -signal.SIGKILL
    assert [name.endswith(".new") for name in names(tmp_path)] == [True]
    assert run(path).success
    assert names(tmp_path) == ["run.h5"]


@pytest.mark.parametrize(("one", "two"), [("x.h5", "x.hdf5"), ("v3000.5", "v3000.6"), ("x", "x.h5")])
def test_checkpoints_of_neighbours_do_not_collide(tmp_path: Path, one: str, two: str) -> None:
    first, second = tmp_path / one, tmp_path / two
    cut_run(first, 2e-3)
    cut_run(second, 1e-3)
    assert checkpoint_path(first) != checkpoint_path(second)
    assert run(second, overwrite=True, checkpoint_every=1e-3).success
    resumed = trb.resume(first)
    assert resumed.success
    assert resumed.time[-1] == 4e-3


@pytest.mark.parametrize("name", ["y.checkpoint", "y.h5.checkpoint.previous", "y.new"])
def test_a_result_cannot_have_a_checkpoints_name(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="must not end in"):
        run(tmp_path / name, checkpoint_every=1e-3)
    assert names(tmp_path) == []


def test_a_file_with_a_checkpoints_name_stays(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    for place in (checkpoint_path(path), previous_path(checkpoint_path(path))):
        place.write_bytes(FOREIGN)
        with pytest.raises(FileError, match="not a checkpoint"):
            run(path, checkpoint_every=1e-3, overwrite=True)
        assert place.read_bytes() == FOREIGN
        assert names(tmp_path) == [place.name]
        place.unlink()


def test_the_checkpoint_of_a_lost_result_stays(tmp_path: Path) -> None:
    """It is all that is left of a run: a new one does not replace it without being asked."""
    path = tmp_path / "run.h5"
    cut_run(path, 2e-3)
    path.unlink()
    kept = checkpoint_path(path).read_bytes()
    with pytest.raises(FileError, match="a checkpoint of another run lies there"):
        run(path, checkpoint_every=1e-3)
    assert checkpoint_path(path).read_bytes() == kept
    assert run(path, checkpoint_every=1e-3, overwrite=True).success
    assert names(tmp_path) == ["run.h5"]


def test_a_checkpoint_of_another_run_is_never_replaced_or_removed(tmp_path: Path) -> None:
    other, path = tmp_path / "other.h5", tmp_path / "run.h5"
    cut_run(other, 2e-3)
    foreign = checkpoint_path(other).read_bytes()

    def put(sim: trb.Simulation) -> None:
        checkpoint_path(path).write_bytes(foreign)

    with pytest.raises(FileError, match="that of another run lies there"):
        run(path, checkpoint_every=1e-3, callback=put)
    assert checkpoint_path(path).read_bytes() == foreign
    checkpoint.remove(path, "a" * 32)
    assert checkpoint_path(path).read_bytes() == foreign


def test_noise_in_place_of_a_checkpoint_is_moved_aside(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    cut_run(path, 2e-3)
    checkpoint_path(path).write_bytes(FOREIGN)
    with pytest.warns(UserWarning, match="the one before it"):
        assert trb.resume(path).success
    assert (tmp_path / "run.h5.checkpoint.damaged").read_bytes() == FOREIGN


# ---- what is no regular file ----


def test_devices_pipes_and_folders_are_refused_at_once(tmp_path: Path) -> None:
    pipe, folder = tmp_path / "pipe.h5", tmp_path / "folder.h5"
    os.mkfifo(pipe)
    folder.mkdir()
    device = Path("/dev/null")
    kind = stat.S_IFMT(device.stat().st_mode)
    for place in (pipe, folder, device, "/dev/zero"):
        for overwrite in (False, True):
            with pytest.raises(FileError, match=r"not a regular file|is a folder"):
                run(place, overwrite=overwrite)
    assert stat.S_IFMT(device.stat().st_mode) == kind
    assert names(tmp_path) == ["folder.h5", "pipe.h5"]


def test_a_symbolic_link_is_followed_not_replaced(tmp_path: Path) -> None:
    target, link = tmp_path / "disk" / "run.h5", tmp_path / "run.h5"
    target.parent.mkdir()
    link.symlink_to(target)
    cut_run(link, 2e-3)
    assert link.is_symlink()
    assert len(trb.load(link))
    with pytest.raises(FileError, match="exists already"):
        run(link)
    assert trb.resume(link).success
    assert names(tmp_path) == ["disk", "run.h5"]
    loop = tmp_path / "loop.h5"
    loop.symlink_to(loop)
    with pytest.raises(FileError):
        run(loop, overwrite=True)


def test_a_link_with_a_drafts_name_is_not_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Somebody who knows the draft's name cannot have a foreign file truncated through it."""
    import uuid

    known = uuid.UUID(int=7)
    monkeypatch.setattr(uuid, "uuid4", lambda: known)
    foreign, path = tmp_path / "foreign.txt", tmp_path / "run.h5"
    foreign.write_bytes(FOREIGN)
    for name in ("run.h5", "run.h5.checkpoint"):
        for draft in (f".{name}.new", f".{name}.{known.hex[:12]}.new"):
            (tmp_path / draft).symlink_to(foreign)
    assert run(path, checkpoint_every=1e-3).success
    assert foreign.read_bytes() == FOREIGN
    assert not path.is_symlink()


@pytest.mark.parametrize("output", ["", ".", "..", "a/", "/", "nul\0.h5", 3, None, b"run.h5", "\ud800.h5"])
def test_what_names_no_file(output: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    if output is not None:
        with pytest.raises(InputError) as found:
            run(output, duration=1e-4)
        assert found.value.field == "output"
    for act in (trb.load, trb.resume):
        with pytest.raises(TrbError):
            act(output)
    assert names(tmp_path) == []


def test_long_names_are_refused_before_the_run(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="too long"):
        run(tmp_path / ("保" * 80 + ".h5"), checkpoint_every=1e-3)
    assert run(tmp_path / ("保" * 60 + ".h5"), checkpoint_every=1e-3, duration=1e-4).success


# ---- what happens during the run ----


def test_a_result_removed_during_the_run_is_put_back(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    seen: list[int] = []

    def remove(sim: trb.Simulation) -> None:
        seen.append(1)
        path.unlink(missing_ok=True)

    with pytest.raises(FileError, match="removed by another program; it is put back"):
        run(path, duration=8e-3, checkpoint_every=1e-3, callback=remove)
    kept = trb.load(path)
    assert len(kept) > 1
    assert trb.resume(path).success, "the run goes on from there"
    np.testing.assert_array_equal(trb.load(path).time[: len(kept)], kept.time)


@pytest.mark.parametrize("by", ["text", "success"])
def test_a_result_replaced_during_the_run_is_kept_beside(tmp_path: Path, by: str) -> None:
    """The other file is left alone, and is not read as the run's success."""
    path, other = tmp_path / "run.h5", tmp_path / "other.h5"
    if by == "text":
        other.write_bytes(FOREIGN)
    else:
        run(other, duration=1e-4)
    content = other.read_bytes()

    def replace(sim: trb.Simulation) -> None:
        if other.exists():
            other.replace(path)

    with pytest.raises(FileError, match="replaced by another program; the records so far are in ") as found:
        run(path, callback=replace)
    assert path.read_bytes() == content
    kept = Path(str(found.value).rpartition(" are in ")[2])
    assert kept.parent == tmp_path
    assert len(trb.load(kept)) > 1


def test_a_result_replaced_after_the_last_write_is_not_read_as_success(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from trbdyn.results.result_file import ResultWriter

    path, other = tmp_path / "run.h5", tmp_path / "other.h5"
    run(other, duration=1e-4)
    close = ResultWriter.close

    def then_replace(self: ResultWriter) -> None:
        close(self)
        other.replace(path)

    monkeypatch.setattr(ResultWriter, "close", then_replace)
    with pytest.raises(FileError, match="replaced by another program"):
        run(path)


CHILD = """
import os, sys, time
import trbdyn as trb
from trbdyn.results import result_file
from trbdyn.model.cases import paper_30310

result_file.FLUSH_SECONDS = 0.0
calls = 0

def callback(sim):
    global calls
    calls += 1
    if calls != 2:
        return
    pid = os.fork()
    if pid:
        if how != "lives on":
            os.waitpid(pid, 0)
        return
    if how == "raises":
        raise SystemExit(0)
    if how == "stops":
        return True
    if how == "lives on":
        os.close(1)
        time.sleep(20)
        os._exit(0)

for how in sys.argv[2:]:
    calls = 0
    try:
        trb.Simulation(paper_30310()).run(duration=6e-3, save_every=1e-5, save_groups=("cage", "energy"),
        checkpoint_every=1e-3, output=f"{sys.argv[1]}/{how}.h5", callback=callback)
    except trb.TrbError as error:
        print("child of", how, error, flush=True)
        sys.exit(0)
    print("parent done", how, flush=True)
"""


@pytest.fixture(scope="module")
def forkless(tmp_path_factory: pytest.TempPathFactory) -> trb.Result:
    """The same run without a child."""
    return run(tmp_path_factory.mktemp("forkless") / "run.h5", duration=6e-3, checkpoint_every=1e-3)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_child_leaves_the_file_alone(tmp_path: Path, forkless: trb.Result) -> None:
    """A callback may fork, as a pool of workers does: the child writes nothing, removes nothing and keeps no lock."""
    hows = ["goes on", "stops", "raises", "lives on"]
    words = [sys.executable, "-P", "-c", CHILD, str(tmp_path), *hows]
    process = subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment(), text=True, start_new_session=True
    )
    try:
        assert process.stdout is not None
        said = ""
        while "parent done lives on" not in said:
            line = process.stdout.readline()
            assert line, process.stderr.read() if process.stderr else ""
            said += line
        process.wait(60)
        for how in hows:
            path = tmp_path / f"{how}.h5"
            assert (f"child of {how}" in said) is (how in ("goes on", "stops"))
            take_lock(path).close()
            result = trb.load(path)
            assert result.success
            for name in ("time", "cage_position", "work_shaft"):
                np.testing.assert_array_equal(result[name], forkless[name])
        assert names(tmp_path) == sorted(f"{how}.h5" for how in hows)
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


# ---- resuming ----

RESUME = "import sys, trbdyn as trb\nprint('ready', flush=True)\nsys.stdin.readline()\ntrb.resume(sys.argv[1])\nprint('done')"


@pytest.mark.slow
def test_of_two_that_resume_a_lost_result_one_goes_on(tmp_path: Path) -> None:
    """The other one is told at once, and what the one gives is whole from the checkpoint on."""
    path = tmp_path / "run.h5"
    cut_run(path, 2e-3, duration=0.05)
    path.unlink()
    words = [sys.executable, "-P", "-c", RESUME, str(path)]
    pipes: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    both = [subprocess.Popen(words, **pipes, env=environment(), text=True) for _ in range(2)]
    for process in both:
        assert process.stdout.readline() == "ready\n"
    for process in both:
        process.stdin.write("\n")
        process.stdin.flush()
    began = time.monotonic()
    said = [process.communicate() for process in both]
    # one that comes after the other has ended finds the run complete, and is given it
    codes = sorted(process.returncode for process in both)
    assert codes in ([0, 1], [0, 0]), (said, time.monotonic() - began)
    for (_, refused), process in zip(said, both, strict=True):
        if process.returncode:
            assert "FileError" in refused
            # or the checkpoint is gone, as the other one came to its end meanwhile
            why = (
                "exists already",
                "another run is writing it",
                "checkpoint.previous: there is no such file",
                "or is complete",
            )
            assert any(text in refused for text in why), refused
    result = trb.load(path)
    assert result.success
    assert "records of it are missing" in result.message
    assert 0.0 < result.time[0] < result.time[-1] == pytest.approx(0.05)
    assert names(tmp_path) == ["run.h5"]


def test_a_lost_result_that_another_process_begins_to_write_is_left_to_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file comes between the look whether it is there and the first record."""
    path = tmp_path / "run.h5"
    cut_run(path, 2e-3)
    begun = path.read_bytes()
    there = names(tmp_path)
    path.unlink()
    read = checkpoint.read_last_good

    def read_while_another_begins(*arguments: Any) -> checkpoint.Checkpoint:
        path.write_bytes(begun)
        return read(*arguments)

    monkeypatch.setattr(checkpoint, "read_last_good", read_while_another_begins)
    with pytest.raises(FileError, match="exists already"), pytest.warns(UserWarning, match="there is no such file"):
        trb.resume(path)
    assert path.read_bytes() == begun
    assert names(tmp_path) == there


def test_resuming_touches_nothing_of_others(tmp_path: Path) -> None:
    """A file of another run in the place of the result, or beside it, is read and left as it is."""
    path, part = tmp_path / "run.h5", tmp_path / "run.part1.h5"
    cut_run(path, 2e-3)
    cut_run(part, 1e-3, checkpoint_every=None)
    before = part.read_bytes()
    assert trb.resume(path).success
    assert part.read_bytes() == before
    assert names(tmp_path) == ["run.h5", "run.part1.h5"]
    other = tmp_path / "other.h5"
    cut_run(other, 2e-3)
    run(path, duration=1e-4, overwrite=True).final_time  # noqa: B018
    path.replace(other)
    before = other.read_bytes()
    with (
        pytest.raises(FileError, match="belongs to another run")
        if not trb.load(other).success
        else contextlib.nullcontext()
    ):
        assert trb.resume(other).success
    assert other.read_bytes() == before
