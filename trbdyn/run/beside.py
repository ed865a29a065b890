"""What a run needs of the process around it, and what it says of a step that failed: Ctrl-C, free cores, the body at fault."""

from __future__ import annotations

import contextlib
import math
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from types import FrameType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import StepError

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation

Array = NDArray[np.float64]


@contextlib.contextmanager
def interrupts() -> Iterator[list[int]]:
    """A list that Ctrl-C adds to, so that it comes between steps and records and never gets lost; a second one comes
    at once.
    """
    caught: list[int] = []
    before = signal.getsignal(signal.SIGINT)

    def catch(number: int, frame: FrameType | None) -> None:
        caught.append(number)
        signal.signal(signal.SIGINT, before)

    if threading.current_thread() is not threading.main_thread() or before is not signal.default_int_handler:
        yield caught
        return
    signal.signal(signal.SIGINT, catch)
    try:
        yield caught
    finally:
        signal.signal(signal.SIGINT, before)


def has_a_spare_core() -> bool:
    """Whether records and peaks may be computed by a second thread: not in workers of a study, which use all cores already."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    alone = multiprocessing.parent_process() is None and threading.current_thread() is threading.main_thread()
    return cores > 1 and alone


def culprit(text: str) -> tuple[str | None, str | None]:
    """Body and quantity named at the end of the core's message."""
    _, _, named = text.partition("largest error: ")
    body, _, quantity = named.partition(", ")
    return (body or None, quantity or None) if quantity else (None, None)


def check_apart(sim: Simulation, records: Array) -> None:
    """Rollers without a cage must not touch each other, as nothing in the model keeps them apart."""
    places = {name: (offset, shape) for name, offset, shape in sim._model.record_layout()}
    offset, (count,) = places["roller_orbit_angle"]
    angles = np.sort(np.mod(records[:, offset : offset + count], 2.0 * math.pi), axis=1)
    gaps = np.diff(np.concatenate([angles, angles[:, :1] + 2.0 * math.pi], axis=1), axis=1)
    bearing = sim.scene.bearing
    nearest = bearing.pitch_diameter * np.sin(0.5 * gaps.min(axis=1))
    if float(nearest.min()) < bearing.roller.diameter:
        raise StepError(
            f"two rollers touch before {sim.time:.6g} s: without a cage nothing in the model keeps them apart; "
            "shorten the run or give effects.bodies = 'rollers_and_cage'",
            time=sim.time,
            body="rollers",
            quantity="spacing",
        )
