"""Writing a result file while the run goes on; `trbdyn.results.file_format` says what it holds."""

from __future__ import annotations

import errno
import os
import shutil
import uuid
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import zip_longest
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from weakref import WeakSet

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.base.locks import LockedFile, take_lock
from trbdyn.base.own_files import copy_content, create_draft, exists_already, output_path, put_in_place
from trbdyn.base.second_thread import SecondThread
from trbdyn.errors import FileError
from trbdyn.results import hdf5_file
from trbdyn.results import peaks as peak_table
from trbdyn.results.fields import Field
from trbdyn.results.file_format import block_rows, json_text, reason
from trbdyn.results.file_source import FileSource
from trbdyn.results.hdf5_file import Part
from trbdyn.results.waiting_rows import WaitingRows

Array = NDArray[np.float64]

FLUSH_SECONDS = 2.0
"""Wall time that records wait in memory before they are written, if they fill a chunk."""

LONGEST_SECONDS = 60.0
"""Longest wall time that records wait which fill no chunk. A part of a chunk is written again as a whole when more has come, and
its first place is lost; so each part waits twice as long as the one before, and the file grows by less than half of it.
"""

FLUSH_BYTES = 8 << 20
"""Most bytes of records that wait in memory."""

COPIED_ROWS = 4096
"""Records that are copied at a time."""

SPARE_BYTES = 1 << 20
"""Room for HDF5's own bookkeeping that must be free before a write."""


class ResultWriter:
    """Writes the records of a run into an HDF5 file while it goes on.

    Records are written when two seconds have gone by or 8 MB wait, a part of a chunk less often (`LONGEST_SECONDS`). A run that
    is killed leaves a file that holds everything up to the last write. Room on the disk is made sure of at the beginning and
    before each write, so that a full disk is an error and leaves a readable file too. Use it as a context manager, or call
    `close`. What cannot be made or written is a FileError.

    The file belongs to the process that made it: in a forked child the writer is closed. If another program removes or replaces
    the file, the records are kept (see `flush`).

    `first_record` is the place of the file's first record in the run. A run that goes on takes over the first records of its
    older file (`taken_over`: each bearing there, and how many), whose place the new one takes. The file is made for `expected`
    records, where that is known. `beside`: a second thread makes and writes the file while the caller goes on; what goes wrong
    is then raised by a later call, and `wait` tells whether the file is there.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *parts: Part,
        assembly: Mapping[str, Any] | None = None,
        run_id: str | None = None,
        first_record: int = 0,
        taken_over: tuple[Sequence[FileSource], int] | None = None,
        expected: int | None = None,
        overwrite: bool = False,
        beside: bool = False,
    ) -> None:
        self.path = output_path(path, overwrite=overwrite)
        self.run_id = run_id or uuid.uuid4().hex
        self.n_written = 0
        self._parts = parts
        self._row_bytes = sum(part.row_bytes for part in parts)
        self._block = block_rows(expected, self._row_bytes)
        self._waiting = WaitingRows(self._block)
        self._patience = FLUSH_SECONDS
        self._failed = False
        self._second = SecondThread() if beside else None
        self._lock: LockedFile | None = None
        run = {"run_id": self.run_id, "first_record": first_record}
        make = partial(hdf5_file.make, parts=parts, run=run, assembly=assembly, rows=self._block)
        with self._guard("cannot be written"):
            replaced = take_lock(self.path) if overwrite and self.path.exists() else None
            try:
                draft, self._lock = create_draft(self.path, uuid.uuid4().hex)
                # a full disk is refused before the first step: a short run is written at its end, and would be lost
                with self._or_given_up(draft):
                    self._reserve(self._row_bytes + SPARE_BYTES)
                _WRITERS.add(self)
                begin = partial(self._begin, draft, make, taken_over, replace=replaced is not None)
                if self._second is None or replaced is not None:
                    begin()
                else:
                    self._second.start(begin)
            finally:
                if replaced is not None:
                    replaced.close()

    @contextmanager
    def _or_given_up(self, draft: Path) -> Iterator[None]:
        """If what is done inside fails, the file is given up and its draft removed."""
        try:
            yield
        except BaseException:
            self._let_go()
            draft.unlink(missing_ok=True)
            raise

    def _begin(
        self, draft: Path, make: partial[None], taken_over: tuple[Sequence[FileSource], int] | None, *, replace: bool
    ) -> None:
        """Make every object of the file in a draft, which then takes its place."""
        with self._or_given_up(draft), self._guard("cannot be written"):
            make(draft)
            if taken_over is not None:
                self._take_over(draft, *taken_over)
            try:
                put_in_place(draft, self.path, replace=replace)
            except FileExistsError:
                raise exists_already(self.path) from None

    def _take_over(self, draft: Path, older: Sequence[FileSource], count: int) -> None:
        """Copy the first records of an older file of the run."""
        self._reserve(count * self._row_bytes + SPARE_BYTES)
        with hdf5_file.opened_to_append(draft) as file:
            for part, source in zip(self._parts, older, strict=True):
                group = part.group(file)
                with source.held_open():
                    for start in range(0, count, COPIED_ROWS):
                        rows = slice(start, min(start + COPIED_ROWS, count))
                        for entry in part.fields:
                            hdf5_file.append(group, entry.name, source.part(entry.name, rows))
                hdf5_file.commit(group, count)
        self.n_written = count

    @contextmanager
    def _guard(self, what: str) -> Iterator[None]:
        try:
            yield
        except FileError:
            raise
        except (OSError, RuntimeError, MemoryError) as error:
            raise FileError(f"{self.path}: the result file {what}: {reason(error)}") from error

    def append(self, records: ArrayLike) -> None:
        """Add full records, shape (n, record_length), in the layout given at the start. They may be written later: do not
        change them.
        """
        rows = np.atleast_2d(np.asarray(records, dtype=float))
        if rows.shape[0] == 0:
            return
        self._waiting.append(rows)
        if self._waiting.seconds < FLUSH_SECONDS and self._waiting.nbytes < FLUSH_BYTES:
            return
        rows_to_write = self._waiting.take(whole_blocks=True)
        if rows_to_write:
            self._patience = FLUSH_SECONDS
        elif self._waiting.seconds >= self._patience:
            rows_to_write = self._waiting.take()
            self._patience = min(2.0 * self._patience, LONGEST_SECONDS)
        else:
            return
        if self._second is None:
            self._write(rows_to_write)
        else:
            self.wait()
            self._second.start(partial(self._write, rows_to_write))

    def flush(self) -> None:
        """Write what waits in memory, so that it survives a kill.

        What the disk had room for stays readable. If another program has removed the file, it is put back; one that it has put
        in its place is left alone, and the records are then in a file beside it. Both are a FileError that names the file.
        """
        rows = self._waiting.take()
        self.wait()
        self._write(rows)

    def wait(self) -> None:
        """Wait for the second thread, and raise what went wrong there."""
        if self._second is not None:
            self._second.wait()

    def _write(self, pieces: list[Array], endings: Sequence[Mapping[str, NDArray[Any]]] = ()) -> None:
        """Add pieces of records, and at the end what is known of each bearing. After an error nothing more is written: it would
        lie behind a gap.
        """
        locked, lost = self._lock, None
        if locked is None:
            raise FileError(f"{self.path}: the result file is closed already")
        with self._guard("was removed or replaced while it was written, and cannot be put back"):
            if not locked.is_at(self.path):
                lost = self._rescue(locked)
        with self._guard("cannot be written"):
            if pieces and self._failed:
                raise OSError("records before these could not be written")
            failed, self._failed = self._failed, True
            count, full = self._room_for(sum(map(len, pieces)))
            if count or endings:
                with hdf5_file.opened_to_append(self.path) as file:
                    for part, ending in zip_longest(self._parts, endings):
                        group = part.group(file)
                        if count:
                            part.append(file, pieces, count)
                        for name, values in (ending or {}).items():
                            hdf5_file.append(group["run"], name, values)
                        hdf5_file.commit(group, self.n_written + count, len(ending["ending"]) if ending else 0)
            self.n_written += count
            if full is not None:
                raise full
            self._failed = failed
        if lost:
            self._let_go()
            raise FileError(f"{lost}")

    def _room_for(self, count: int) -> tuple[int, OSError | None]:
        """How many of some records the disk has room for, and the error if these are not all."""
        full = None
        while True:
            try:
                begun = self.n_written % self._block if count else 0
                self._reserve((count + begun) * self._row_bytes + SPARE_BYTES)
                return count, full
            except OSError as error:
                if count < 2:
                    raise
                full, count = error, count // 2

    def _rescue(self, locked: LockedFile) -> str:
        """Put back a file that has lost its name, under another one if that is taken; says what has happened."""
        stream = locked.stream
        if stream is None:
            raise FileError(
                f"{self.path}: the result file was removed or replaced by another program; its records are lost"
            )
        lost, what = self.path, "was removed by another program; it is put back with the records so far"
        try:
            copy_content(stream, self.path)
        except FileExistsError:
            self.path = lost.with_name(f"{lost.stem}.{self.run_id[:12]}{lost.suffix}")
            copy_content(stream, self.path)
            what = f"was replaced by another program; the records so far are in {self.path}"
        return f"{lost}: the result file {what}"

    def _let_go(self) -> None:
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def _forget(self) -> None:
        """In a forked child: the file and its lock are the parent's."""
        self._waiting.take()
        self._second = None
        self._let_go()

    def sync(self) -> None:
        """Write what waits, and have the system put it on the disk."""
        self.flush()
        with self._guard("cannot be written"), self.path.open("r+b") as stream:
            os.fsync(stream.fileno())

    def _reserve(self, size: int) -> None:
        """Make sure that the disk has room: HDF5 brings the process down when it runs out of it in the middle of a write. HDF5
        gives back what it does not need when it closes the file.
        """
        stream = self._lock.stream if self._lock is not None else None
        if stream is not None and hasattr(os, "posix_fallocate"):
            os.posix_fallocate(stream.fileno(), os.fstat(stream.fileno()).st_size, size)
        elif shutil.disk_usage(self.path.parent).free < size:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def finish(self, *endings: Mapping[str, Any]) -> None:
        """Write how the run ended, for each bearing the arguments of `_ending`, and close the file."""
        self.wait()
        rows = self._waiting.take()
        written = [_ending(part.fields, **ending) for part, ending in zip(self._parts, endings, strict=True)]
        self._write([] if self._failed else rows, written)
        self.close()

    def close(self) -> None:
        """Write what waits and close the file; an unfinished run stays marked as such."""
        try:
            self.wait()
            rows = self._waiting.take()
            if self._lock is not None and rows and not self._failed:
                self._write(rows)
        finally:
            self._let_go()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _ending(
    fields: Sequence[Field],
    success: bool,
    message: str,
    stats: Mapping[str, Any],
    counters: Mapping[str, int],
    final_time: float,
    final_state: ArrayLike | None,
    peaks: Mapping[str, Array] | None = None,
    warnings: Sequence[str] = (),
) -> dict[str, NDArray[Any]]:
    """What the group ``run`` holds of how a run ended: `final_time` in s, `final_state` the last good state or None, `peaks`
    those of the whole run by name.
    """
    how = {"success": bool(success), "message": str(message), "final_time": float(final_time)}
    how |= {"stats": dict(stats), "counters": dict(counters), "warnings": list(warnings)}
    ending: dict[str, NDArray[Any]] = {"ending": np.frombuffer(json_text(how).encode(), dtype="u1")}
    if final_state is not None:
        ending["final_state"] = np.asarray(final_state, dtype=float)
    kept = [np.ravel(peaks[entry.name]) for entry in fields if entry.group == peak_table.GROUP] if peaks else []
    if kept:
        ending["peaks"] = np.concatenate(kept, dtype=float)
    return ending


_WRITERS: WeakSet[ResultWriter] = WeakSet()
"""Writers of this process."""


def _forget_all() -> None:
    for writer in list(_WRITERS):
        writer._forget()
    _WRITERS.clear()


def _settle_all() -> None:
    """Before a fork: a thread in the middle of a write would leave HDF5's lock taken for ever in the child."""
    for writer in list(_WRITERS):
        if writer._second is not None:
            writer._second.settle()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_settle_all, after_in_child=_forget_all)
