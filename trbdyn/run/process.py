"""What a run needs of the process around it: Ctrl-C that waits for the end of a step, and how many cores are free."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from types import FrameType


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
