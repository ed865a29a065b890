"""Running tasks on executors: worker processes, threads, this process, or any executor that is handed in."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, Generic, TypeVar

from trbdyn.errors import InputError, TrbError

T = TypeVar("T")
Stopped = Callable[[], bool]
Work = Callable[[T, Stopped], Any]
"""A function of a task, and of a function that says whether to stop early."""

Outcomes = Generator["Outcome[T]", None, None]

FOREIGN_WINDOW = 1000
"""Tasks that an executor from outside holds at a time."""

KINDS = ("processes", "threads", "serial")

DIED = "the worker process died (killed, out of memory, or a crash of the core)"

_event: Any = None
"""In a worker process: set when the study is stopped."""

_orphaned = threading.Event()
"""In a worker process: set when its parent has died."""

_working = threading.Lock()
"""In a worker process: held while a task is under way."""

LAST_SECONDS = 5.0
"""Wall time that a worker has at most to take its unfinished files away when its parent has died."""


@dataclass(frozen=True)
class Outcome(Generic[T]):
    """How a task ended: what the work gave, or what it raised instead."""

    task: T
    value: Any = None
    error: Exception | None = None


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def execute(work: Work[T], tasks: Iterable[T], executor: Any = "processes", workers: int | None = None) -> Outcomes[T]:
    """Do the work of every task; outcomes come as tasks end, in any order. Closing the generator stops the work.

    `work` is called as ``work(task, stopped)``, and should end soon once ``stopped()`` is true; for processes and clusters it
    and the tasks must pickle. Executors are those of `trbdyn.study.run`. Worker processes that cannot be started are a
    `TrbError`.
    """
    if workers is not None and workers < 1:
        raise InputError.of("workers", workers, "must be at least 1")
    count = min(workers or cores(), cores())
    if executor == "serial":
        return _serial(work, tasks)
    if executor == "threads":
        return _threads(work, tasks, count)
    if executor == "processes":
        return _processes(work, tasks, count)
    if hasattr(executor, "get_executor"):
        return _foreign(work, tasks, executor.get_executor(pure=False))
    if hasattr(executor, "submit"):
        return _foreign(work, tasks, executor)
    raise InputError.of("executor", executor, f"must be one of {', '.join(KINDS)}, an executor or a Dask client")


def _never() -> bool:
    return False


def _serial(work: Work[T], tasks: Iterable[T]) -> Outcomes[T]:
    for task in tasks:
        try:
            outcome = Outcome(task, work(task, _never))
        except Exception as error:
            outcome = Outcome(task, None, error)
        yield outcome


def _outcome(task: T, future: Future[Any]) -> Outcome[T]:
    try:
        return Outcome(task, future.result())
    except Exception as error:
        return Outcome(task, None, error)


def _flow(submit: Callable[[T], Future[Any]], tasks: Iterable[T], window: int) -> Outcomes[T]:
    """Outcomes of submitted tasks, at most `window` of them under way; what is under way is cancelled at the end."""
    waiting, under_way = iter(tasks), dict[Future[Any], T]()
    try:
        while True:
            for task in waiting:
                under_way[_submitted(submit, task)] = task
                if len(under_way) >= window:
                    break
            if not under_way:
                return
            done, _ = wait(under_way, return_when=FIRST_COMPLETED)
            for future in done:
                yield _outcome(under_way.pop(future), future)
    finally:
        for future in under_way:
            future.cancel()


def _submitted(submit: Callable[[T], Future[Any]], task: T) -> Future[Any]:
    """A future of the task; where it cannot be handed in, one that has failed."""
    try:
        return submit(task)
    except (BrokenExecutor, RuntimeError) as error:
        failed: Future[Any] = Future()
        failed.set_exception(error)
        return failed


def _threads(work: Work[T], tasks: Iterable[T], count: int) -> Outcomes[T]:
    event = threading.Event()
    with ThreadPoolExecutor(count) as pool:
        try:
            yield from _flow(lambda task: pool.submit(work, task, event.is_set), tasks, count + 1)
        finally:
            event.set()


def _foreign(work: Work[T], tasks: Iterable[T], executor: Any) -> Outcomes[T]:
    return _flow(lambda task: executor.submit(work, task, _never), tasks, FOREIGN_WINDOW)


def _in_worker(event: Any) -> None:
    """Start of a worker process: Ctrl-C is handled by the parent, which sets the event."""
    global _event
    _event = event
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, name="trbdyn parent", daemon=True).start()


def _end_with_parent() -> None:
    """Wait for the death of the parent, which a closed pipe tells, however it comes; then stop the run under way, and end."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    parent.join()
    _orphaned.set()
    _working.acquire(timeout=LAST_SECONDS)
    os._exit(1)


def _is_set() -> bool:
    # an orphan leaves the event alone: its lock may have been taken by the one who died
    return _orphaned.is_set() or (_event is not None and bool(_event.is_set()))


def _call(work: Work[T], task: T) -> Any:
    with _working:
        return work(task, _is_set)


class _Pool:
    """Own worker processes; spawned, so that threads and locks of this process are not copied."""

    def __init__(self, count: int) -> None:
        context = multiprocessing.get_context("spawn")
        self.event = context.Event()
        self.pool = ProcessPoolExecutor(count, mp_context=context, initializer=_in_worker, initargs=(self.event,))

    def submit(self, work: Work[T], task: T) -> Future[Any]:
        return self.pool.submit(_call, work, task)

    def close(self) -> None:
        self.event.set()
        self.pool.shutdown(wait=True, cancel_futures=True)


def _processes(work: Work[T], tasks: Iterable[T], count: int) -> Outcomes[T]:
    """Tasks in worker processes. If a process dies, those under way are done again, each in a process of its own: only the one
    that kills its process again has failed.
    """
    waiting = iter(tasks)
    ended = False
    while not ended:
        suspects: list[T] = []
        workers = _Pool(count)
        try:
            for outcome in _flow(partial(workers.submit, work), _until(waiting, suspects), count + 1):
                if isinstance(outcome.error, BrokenExecutor):
                    suspects.append(outcome.task)
                else:
                    yield outcome
        finally:
            workers.close()
        ended = not suspects
        if suspects:
            _check_workers_start()
        for task in suspects:
            yield _alone(work, task)


def _until(tasks: Iterator[T], suspects: list[T]) -> Iterator[T]:
    """The tasks, up to the first failure of a process."""
    while not suspects:
        try:
            task = next(tasks)
        except StopIteration:
            return
        yield task


def _alone(work: Work[T], task: T) -> Outcome[T]:
    workers = _Pool(1)
    try:
        outcome = _outcome(task, workers.submit(work, task))
    finally:
        workers.close()
    return Outcome(task, None, TrbError(DIED)) if isinstance(outcome.error, BrokenExecutor) else outcome


def _check_workers_start() -> None:
    workers = _Pool(1)
    try:
        workers.pool.submit(_is_set).result()
    except BrokenExecutor:
        raise TrbError(
            "worker processes cannot be started; in a script, call it under if __name__ == '__main__':, "
            "or give executor='threads'"
        ) from None
    finally:
        with suppress(BrokenExecutor):
            workers.close()
