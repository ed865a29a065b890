"""Work that a second thread does while the first one goes on."""

from __future__ import annotations

import threading
from collections.abc import Callable


class SecondThread:
    """One piece of work at a time, done by a thread of its own.

    An error of the work is kept and raised in the thread that waits for it. Python waits for the work before it ends. Unlike
    the threads of an executor, this one ends with its work, so that a process without work under way can be forked.
    """

    def __init__(self) -> None:
        self._thread: threading.Thread | None = None
        self._error: BaseException | None = None

    def start(self, work: Callable[[], object]) -> None:
        """Begin a piece of work; waits for the one before, and raises its error if it had one."""
        self.wait()

        def do() -> None:
            try:
                work()
            except BaseException as error:
                self._error = error

        self._thread = threading.Thread(target=do, name="trbdyn writer")
        self._thread.start()

    def settle(self) -> None:
        """Wait for the work; its error is raised by the next `wait`."""
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def wait(self) -> None:
        """Wait for the work, and raise the error that it had, once."""
        self.settle()
        error, self._error = self._error, None
        if error is not None:
            raise error
