"""What a run tells and leaves behind: copies made in its callback, its progress, its statistics, a start that failed."""

from __future__ import annotations

import math
import os
import re
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tqdm

import trbdyn as trb
from trbdyn.errors import FileError, InputError
from trbdyn.model.cases import paper_30310
from trbdyn.results.fields import Field
from trbdyn.run import checkpoint, memory, running


def test_a_copy_made_in_a_callback_goes_its_own_way() -> None:
    sim, copies = trb.Simulation(paper_30310()), []

    def callback(now: trb.Simulation) -> bool:
        copies.append(now.copy())
        with pytest.raises(InputError, match="while a run goes on"):
            now.step()
        return True

    sim.run(duration=1e-3, callback=callback)
    before = copies[0].time
    assert copies[0].step() > before


def test_progress_is_counted_over_the_whole_run(monkeypatch: pytest.MonkeyPatch) -> None:
    bars: list[Any] = []

    class Bar(tqdm.tqdm):  # type: ignore[type-arg]
        def __init__(self, *words: Any, **options: Any) -> None:
            super().__init__(*words, **options)
            bars.append(self)

    monkeypatch.setattr(tqdm, "tqdm", Bar)
    sim = trb.Simulation(paper_30310())
    sim.run(duration=2e-3, save_every=5e-4, progress=True)
    sim.run(duration=3e-3, save_every=5e-4, progress=True)
    assert [bar.total for bar in bars] == pytest.approx([2e-3, 3e-3])
    assert [bar.n for bar in bars] == pytest.approx([2e-3, 3e-3])


def test_wall_time_of_less_than_a_turn_and_of_none() -> None:
    part = trb.Simulation(paper_30310(3000.0)).run(duration=1e-3)
    assert part.stats["revolutions"] == pytest.approx(0.05)
    assert part.stats["wall_s_per_revolution"] == pytest.approx(part.stats["stepping_s"] / 0.05)
    still = trb.Simulation(paper_30310(0.0)).run(duration=1e-4)
    assert still.stats["revolutions"] == 0.0
    assert math.isnan(still.stats["wall_s_per_revolution"])


def test_statistics_are_those_of_the_solver() -> None:
    """Counts are whole numbers, times and sizes keep their fractions."""
    sim = trb.Simulation(paper_30310())
    stats = sim.run(duration=1e-3).stats
    for name, value in sim.statistics.items():
        assert stats[name] == value, name
    assert isinstance(stats["steps"], int)
    assert 0.0 < stats["last_step"] < 1e-3


def test_a_start_that_fails_leaves_a_simulation_without_looks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first checkpoint cannot be written: the simulation then makes rows of records alone, and runs as before."""
    sim = trb.Simulation(paper_30310())

    def fail(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(checkpoint, "write", fail)
        with pytest.raises(FileError, match="no space left"):
            sim.run(duration=1e-3, checkpoint_every=1e-4, output=tmp_path / "run.h5")
    assert sim._core.row_length == sim.bearings[0].model.record_length
    assert sim.run(duration=1e-3).success


@pytest.mark.parametrize("groups", [None, ("cage", "peaks"), ("cage", "pocket")])
def test_a_second_thread_changes_no_bit(monkeypatch: pytest.MonkeyPatch, groups: tuple[str, ...] | None) -> None:
    """Records and peaks are computed beside the steps where there is a core for it."""
    found = []
    for beside in (False, True):
        monkeypatch.setattr(running, "has_a_spare_core", lambda answer=beside: answer)
        scene = paper_30310(3000.0, 1230.0, start=trb.Start.whirl(0.9))
        found.append(trb.Simulation(scene).run(duration=0.01, save_every=3e-5, save_groups=groups))
    here, there = found
    for field in here.fields:
        np.testing.assert_array_equal(there[field.name], here[field.name])
    np.testing.assert_array_equal(there.final_state, here.final_state)
    for name, values in (here.peaks if "peaks" in here.groups else {}).items():
        np.testing.assert_array_equal(there.peaks[name], values)


def test_workers_of_studies_and_threads_compute_alone() -> None:
    """Their neighbours use the other cores."""
    answers: list[bool] = []
    thread = threading.Thread(target=lambda: answers.append(running.has_a_spare_core()))
    thread.start()
    thread.join()
    assert answers == [False]
    assert running.has_a_spare_core() == (len(os.sched_getaffinity(0)) > 1)


def test_a_run_in_memory_ends_before_the_memory_is_full(monkeypatch: pytest.MonkeyPatch) -> None:
    """With all records so far, and the simulation can go on."""
    free = iter([1 << 40, memory.RESERVE])
    monkeypatch.setattr(memory, "LOOK_EVERY", 1)
    monkeypatch.setattr(memory, "available", lambda: next(free))
    sim = trb.Simulation(trb.cases.paper_30310(3000.0))
    result = sim.run(duration=10.0, save_every=1e-5)
    assert not result.success
    assert re.search(r"memory is nearly full at .* s: .* GB; write them to a file \(output=", result.message)
    assert len(result) == 2 * running.CHUNK_RECORDS
    monkeypatch.setattr(memory, "available", lambda: None)
    short = trb.Simulation(trb.cases.paper_30310(3000.0)).run(duration=len(result) * 1e-5, save_every=1e-5)
    assert np.array_equal(result["cage_position"], short["cage_position"][: len(result)])
    assert sim.run(duration=1e-4).success


def test_a_run_that_is_complete_needs_no_more_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "LOOK_EVERY", 1)
    monkeypatch.setattr(memory, "available", lambda: memory.RESERVE)
    result = trb.Simulation(trb.cases.paper_30310(3000.0)).run(duration=1e-4, save_every=1e-5)
    assert result.success
    assert len(result) == 11


def test_free_memory_is_what_the_system_says(monkeypatch: pytest.MonkeyPatch) -> None:
    free = memory.available()
    if free is not None:
        assert 1 << 20 < free < os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    monkeypatch.setattr(memory, "_of_machine", lambda: None)
    monkeypatch.setattr(memory, "_of_process", lambda: None)
    monkeypatch.setattr(memory, "_GROUPS", ())
    assert memory.available() is None


@pytest.mark.parametrize(
    ("controller", "limit", "taken", "files"),
    [
        ("", "memory.max", "memory.current", "inactive_file"),
        ("memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
    ],
)
def test_free_memory_knows_the_limit_of_a_container(
    controller: str, limit: str, taken: str, files: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Written as the kernel writes them; files that were read and are no longer used make room."""
    monkeypatch.setattr(memory, "_of_machine", lambda: 9_000_000 * 1024)
    monkeypatch.setattr(memory, "_OWN_GROUPS", tmp_path / "own")
    monkeypatch.setattr(memory, "_of_process", lambda: None)  # these tests may run under a limit of their own
    monkeypatch.setattr(memory, "_GROUPS", ((controller, tmp_path / "groups", limit, taken, files),))
    assert memory.available() == 9_000_000 * 1024

    def group(place: str, most: int | str, now: int) -> None:
        folder = tmp_path / "groups" / place
        folder.mkdir(parents=True, exist_ok=True)
        (folder / limit).write_text(f"{most}\n")
        (folder / taken).write_text(f"{now}\n")
        (folder / "memory.stat").write_text(f"anon 1900000000\n{files} 400000000\n")

    group("", 3_000_000_000, 2_500_000_000)
    assert memory.available() == 900_000_000
    group("", "max" if limit == "memory.max" else 9223372036854771712, 2_500_000_000)
    assert memory.available() == 9_000_000 * 1024
    (tmp_path / "own").write_text(f"2:cpu,cpuacct:/elsewhere\n4:{controller}:/user/ours\n")
    group("user", 2_000_000_000, 1_800_000_000)
    group("user/ours", 1_000_000_000, 900_000_000)
    assert memory.available() == 500_000_000
    group("user", 2_000_000_000, 2_100_000_000)
    assert memory.available() == 300_000_000


def test_free_memory_knows_the_limit_of_the_process() -> None:
    """In a process of its own: the limit cannot be raised again."""
    code = (
        "import resource, trbdyn.run.memory as memory\n"
        "resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))\n"
        "before = memory.available()\n"
        "kept = bytearray(256 << 20)\n"
        "print(before, memory.available())\n"
    )
    before, after = map(int, subprocess.check_output([sys.executable, "-c", code], text=True).split())
    assert 0 < after < before < 3 << 30
    assert before - after == pytest.approx(256 << 20, rel=0.05)


def test_pieces_are_joined_in_their_order() -> None:
    layout = [("time", 0, ()), ("angle", 1, (2,)), ("force", 3, (2, 3))]
    fields = tuple(
        Field(name, group, kind, "", "")
        for name, group, kind in (("time", "time", "scalar"), ("angle", "cage", "vec2"), ("force", "ring", "vec3"))
    )
    rows = np.arange(70.0).reshape(7, 10)
    for kept_fields, width in ((fields, 10), ((fields[0], fields[2]), 7)):
        kept = memory.Kept(layout, kept_fields)
        assert kept.source().read("time").shape == (0,)
        assert kept.source().read("force").shape == (0, 2, 3)
        for start, stop in ((0, 2), (2, 3), (3, 7)):
            kept.append(rows[start:stop].copy())
            source = kept.source()
            assert source.n_records == stop
            assert np.array_equal(source.read("force"), rows[:stop, 3:9].reshape(-1, 2, 3))
            assert source.read("force") is source.read("force")
        assert kept.size == 7 * width * 8
        source = kept.source()
        for field in kept_fields:
            offset, size = {name: (at, int(np.prod(shape))) for name, at, shape in layout}[field.name]
            assert np.array_equal(source.read(field.name).reshape(7, -1), rows[:, offset : offset + size])
        assert np.array_equal(source.read("time"), rows[:, 0])  # again, when all have been read
