"""The process that simulations live in: threads, memory, callbacks, signals."""

from __future__ import annotations

import gc
import os
import signal
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.cases import scene_30310


def scene(number: int) -> trb.Scene:
    return scene_30310(1000.0 * (1 + number % 3), 4930.0, start=trb.Start.unequal(number))


def run(number: int) -> trb.Result:
    return trb.Simulation(scene(number)).run(duration=0.02, checkpoint_every=4e-3)


def test_threads_equal_serial() -> None:
    serial = [run(number) for number in range(6)]
    with ThreadPoolExecutor(4) as pool:
        for one, other in zip(serial, pool.map(run, range(6)), strict=True):
            np.testing.assert_array_equal(one.final_state, other.final_state)
            np.testing.assert_array_equal(one.cage_position, other.cage_position)


def test_one_simulation_in_two_threads_is_refused() -> None:
    sim = trb.Simulation(scene(0))
    inside, go_on = threading.Event(), threading.Event()
    troubles: list[BaseException] = []

    def step_on() -> None:
        inside.set()
        try:
            sim.run(duration=0.2, callback=lambda now: go_on.is_set())
        except RuntimeError as error:
            troubles.append(error)

    thread = threading.Thread(target=step_on)
    thread.start()
    inside.wait()
    try:
        for _ in range(20000):
            sim.step()
    except RuntimeError as error:
        troubles.append(error)
    go_on.set()
    thread.join()
    assert all("another thread" in str(error) for error in troubles)


def resident() -> int:
    """Memory of this process now (bytes)."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs /proc")
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


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs /proc")
def test_models_and_equilibria_do_not_leak() -> None:
    base = scene(0)
    for _ in range(50):
        trb.Simulation(base).step()
    gc.collect()
    before = resident()
    for _ in range(500):
        trb.Simulation(base).run(duration=1e-4)
    gc.collect()
    assert resident() - before < 1_000_000


class Broken(Exception):
    pass


def test_what_a_callback_raises_comes_out_and_the_simulation_goes_on(tmp_path: Path) -> None:
    def callback(now: trb.Simulation) -> None:
        raise Broken("by the callback")

    sim = trb.Simulation(scene(0))
    with pytest.raises(Broken, match="by the callback"):
        sim.run(duration=0.1, output=tmp_path / "run.h5", callback=callback)
    kept = trb.load(tmp_path / "run.h5")
    assert not kept.success
    assert "Broken" in kept.message
    assert len(kept) > 0
    assert sim.run(duration=1e-3).success


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_ctrl_c_while_stepping_ends_the_run_and_resume_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    timer = threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    result = trb.Simulation(scene(0)).run(duration=0.8, save_every=1e-3, checkpoint_every=0.05, output=path)
    timer.join()
    if result.success:
        pytest.skip("this machine is faster than the signal")
    assert "stopped by the user" in result.message
    whole = trb.Simulation(scene(0)).run(duration=0.8, save_every=1e-3, checkpoint_every=0.05)
    np.testing.assert_array_equal(trb.resume(path).final_state, whole.final_state)
