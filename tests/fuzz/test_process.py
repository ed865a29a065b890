"""The process that simulations live in: threads, memory, callbacks, signals."""

from __future__ import annotations

import contextlib
import gc
import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.cases import paper_30310
from trbdyn.run.checkpoint import checkpoint_path


def scene(number: int) -> trb.Scene:
    return paper_30310(1000.0 * (1 + number % 3), 4930.0, start=trb.Start.unequal(number))


def run(number: int) -> trb.Result:
    return trb.Simulation(scene(number)).run(duration=8e-3, checkpoint_every=2e-3)


def test_threads_equal_serial() -> None:
    serial = [run(number) for number in range(4)]
    with ThreadPoolExecutor(4) as pool:
        for one, other in zip(serial, pool.map(run, range(4)), strict=True):
            np.testing.assert_array_equal(one.final_state, other.final_state)
            np.testing.assert_array_equal(one.cage_position, other.cage_position)


ASKED = ("record", "contacts", "derivative", "restart", "state", "copy", "set_state", "step", "counters", "statistics")


@pytest.mark.parametrize("what", ASKED)
def test_one_simulation_in_two_threads_is_refused(what: str) -> None:
    """Whatever a thread asks of a simulation that another thread steps."""
    sim = trb.Simulation(scene(0))
    state, records = sim.state, np.empty((1, sim.bearings[0].model.record_length))
    enough = threading.Event()

    def ask() -> None:
        asked = sim.set_state(state) if what == "set_state" else getattr(sim, what)
        if callable(asked):
            asked()

    def step_on() -> None:
        while not enough.is_set():
            # refused itself where the other thread was the first
            with contextlib.suppress(RuntimeError):
                sim._core.run(np.array([1e6]), records, 1000)

    thread = threading.Thread(target=step_on)
    thread.start()
    until = time.monotonic() + 60.0
    refusal = ""
    while not refusal and time.monotonic() < until:
        with contextlib.suppress(RuntimeError):
            # answered, with the interpreter's lock held: the other thread is not in the core now
            sim.record()
            continue
        try:
            ask()
        except RuntimeError as error:
            refusal = str(error)
    enough.set()
    thread.join()
    assert "another thread" in refusal
    assert sim.step() > 0.0


INNER = """
import sys
sys.path[:] = {path!r}
try:
    import trbdyn._core
    print("imported", flush=True)
except ImportError as error:
    print("refused:", error, flush=True)
"""

OUTER = """
import sys
try:
    import _interpreters as interpreters
except ImportError:
    import _xxsubinterpreters as interpreters
if sys.argv[1] == "after the main one":
    import trbdyn._core
interpreters.run_string(interpreters.create(), sys.argv[2])
import trbdyn as trb
print(trb.Simulation(trb.cases.paper_30310()).step() > 0.0)
"""


@pytest.mark.skipif(
    not any(importlib.util.find_spec(name) for name in ("_interpreters", "_xxsubinterpreters")),
    reason="this Python cannot make sub-interpreters",
)
@pytest.mark.parametrize("when", ["first", "after the main one"])
def test_sub_interpreters_are_refused(when: str) -> None:
    """The one that asks is told; the main one works on."""
    path = [entry for entry in sys.path if entry]
    words = [sys.executable, "-P", "-c", OUTER, when, INNER.format(path=path)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path)}
    done = subprocess.run(words, capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    refusal, works = done.stdout.splitlines()
    assert refusal.startswith("refused:")
    assert re.search("sub-?interpreters", refusal)
    assert works == "True"


CORE_HEADER = Path(__file__).parents[2] / "csrc" / "python" / "core.h"


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("free_threaded", [False, True])
def test_free_threaded_builds_are_refused(tmp_path: Path, free_threaded: bool) -> None:
    """The extension does not compile for a Python without the global interpreter lock, and says why."""
    if sysconfig.get_config_var("Py_GIL_DISABLED") and not free_threaded:
        pytest.skip("this Python is free-threaded")
    source = tmp_path / "module.c"
    source.write_text(f'#include "{CORE_HEADER}"\n')
    folders = [sysconfig.get_path("include"), np.get_include(), str(CORE_HEADER.parents[1])]
    words = ["cc", "-std=c11", "-fsyntax-only", *(f"-I{folder}" for folder in folders), str(source)]
    done = subprocess.run(words + ["-DPy_GIL_DISABLED"] * free_threaded, capture_output=True, text=True, check=False)
    assert (done.returncode != 0) is free_threaded, done.stderr
    assert ("free-threaded builds of Python are not supported" in done.stderr) is free_threaded


def resident() -> int:
    """Memory of this process now (bytes)."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs /proc")
@pytest.mark.slow
def test_no_leaks_over_ten_thousand_cycles() -> None:
    """Create, step, look, fail, free: what 10 000 leave behind is less than 100 bytes each."""
    base = trb.Simulation(scene(0))

    def cycle() -> None:
        sim = base.copy()
        sim.step()
        sim.record()
        with pytest.raises(trb.InputError):
            sim.set_state(np.full(base.state.vector.size, np.nan))

    for _ in range(1000):
        cycle()
    gc.collect()
    before = resident()
    for _ in range(10_000):
        cycle()
    gc.collect()
    assert resident() - before < 1_000_000


MADE_AND_FREED = """
import gc, os, statistics
from pathlib import Path
import trbdyn as trb

def median_of_three():
    # a large block comes and goes
    looks = []
    for _ in range(3):
        for _ in range(40):
            trb.Simulation(scene).run(duration=1e-4)
        gc.collect()
        looks.append(int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE"))
    return statistics.median(looks)

scene = trb.cases.paper_30310(1000.0, 4930.0, start=trb.Start.unequal(0))
before = median_of_three()
for _ in range(260):
    trb.Simulation(scene).run(duration=1e-4)
print(median_of_three() - before)
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs /proc")
def test_models_and_equilibria_do_not_leak() -> None:
    """What 300 leave behind is less than 3.4 kB each, in a process of its own, whose memory nothing else touches. Its threads
    share one heap: else it depends on chance which of several heaps keeps what was freed.
    """
    words = [sys.executable, "-P", "-c", MADE_AND_FREED]
    done = subprocess.run(
        words, capture_output=True, text=True, check=False, env={**os.environ, "MALLOC_ARENA_MAX": "1"}
    )
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 1_000_000


OUT_OF_MEMORY = """
import resource
from pathlib import Path
import trbdyn as trb

scene = trb.cases.paper_30310(3000.0, 4930.0)
first = trb.Simulation(scene)
first.run(duration=1e-3)
size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (size + 30_000_000, resource.RLIM_INFINITY))
kept = []
try:
    while len(kept) < 10_000:
        kept.append(trb.Simulation(scene))
except MemoryError:
    print("MemoryError")
del kept
print(first.run(duration=1e-3).success, trb.Simulation(scene).step() > 0.0)
"""


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs /proc")
def test_out_of_memory_is_a_memory_error_and_the_process_goes_on() -> None:
    words = [sys.executable, "-P", "-c", OUT_OF_MEMORY]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["MemoryError", "True", "True"]


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_signals_while_stepping_change_no_bit(tmp_path: Path) -> None:
    """Another handler than that of Ctrl-C, called a thousand times a second: in steps, in writes, between them."""
    schedule = {"duration": 0.04, "save_every": 2e-5, "checkpoint_every": 0.01}
    undisturbed = trb.Simulation(scene(0)).run(output=tmp_path / "undisturbed.h5", **schedule)
    caught: list[int] = []
    before = signal.signal(signal.SIGALRM, lambda number, frame: caught.append(number))
    signal.setitimer(signal.ITIMER_REAL, 1e-3, 1e-3)
    try:
        disturbed = trb.Simulation(scene(0)).run(output=tmp_path / "disturbed.h5", **schedule)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert len(caught) > 5
    assert disturbed.success
    np.testing.assert_array_equal(disturbed.final_state, undisturbed.final_state)
    np.testing.assert_array_equal(disturbed.cage_position, undisturbed.cage_position)


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_ctrl_c_while_stepping_ends_the_run_and_resume_goes_on(tmp_path: Path) -> None:
    """The signal comes when the file holds records, a moment into a run that would take minutes."""
    path = tmp_path / "run.h5"
    schedule = {"save_every": 1e-3, "checkpoint_every": 0.05}

    def press() -> None:
        while not checkpoint_path(path).exists():
            time.sleep(0.01)
        time.sleep(0.2)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=press, daemon=True).start()
    began = time.perf_counter()

    def too_late(now: trb.Simulation) -> bool:
        return time.perf_counter() - began > 60.0

    result = trb.Simulation(scene(0)).run(duration=1000.0, output=path, callback=too_late, **schedule)
    assert "stopped by the user" in result.message
    assert result.final_time < 500.0
    # a twin of the run, to a time a little after the signal
    end = result.final_time + 0.1
    whole = trb.Simulation(scene(0)).run(duration=end, output=tmp_path / "whole.h5", **schedule)
    resumed = trb.resume(path, callback=lambda now: now.time >= end)
    n = len(whole) - 1  # its last record is its end
    assert len(result) < n <= len(resumed)
    for name in ("time", "cage_position", "roller_position"):
        np.testing.assert_array_equal(resumed[name][:n], whole[name][:n])
