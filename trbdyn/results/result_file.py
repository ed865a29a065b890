"""Writing a result file while the run goes on; `trbdyn.results.file_format` says what it holds."""

from __future__ import annotations

import errno
import os
import shutil
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self
from weakref import WeakSet

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.base.own_files import copy_content, create_draft, exists_already, is_same, output_path, put_in_place
from trbdyn.base.second_thread import SecondThread
from trbdyn.errors import FileError, InputError
from trbdyn.results import fields as field_table
from trbdyn.results.fields import Field, Layout
from trbdyn.results.file_format import LIBVER, block_rows, json_text, reason
from trbdyn.results.file_head import make_columns, write_head
from trbdyn.results.hdf5_marks import lock, take_lock
from trbdyn.results.hdf5_quick import Column
from trbdyn.results.waiting_rows import WaitingRows

Array = NDArray[np.float64]


FLUSH_SECONDS = 2.0
"""Longest wall time that records wait in memory before they are written."""

FLUSH_BYTES = 8 << 20
"""Most bytes of records that wait in memory."""

SPARE_BYTES = 1 << 20
"""Room for HDF5's own bookkeeping that is made sure of before a write."""


class ResultWriter:
    """Writes the records of a run into an HDF5 file while it goes on.

    Parameters
    ----------
    path : path-like
        File to write.
    scene : Scene
        The scene; ``scene.to_dict()`` is stored.
    layout : sequence of (name, offset, shape)
        Places of the fields in a record.
    fields : sequence of Field
        The table that describes them.
    groups : iterable of str, optional
        Groups of fields to write; all by default. The group ``"time"`` is always written.
    meta : mapping, optional
        Versions, instruction set, settings: anything that JSON can hold.
    geometry : mapping of str to float, optional
        Derived geometry of the bearing, SI.
    compression : {"gzip", "lzf"}, optional
        Compression of the datasets; none by default.
    run_id : str, optional
        Name of the run, the same in all of its segments; a new one by default.
    segment : int
        Number of the segment.
    first_record : int
        Place of the segment's first record in the run.
    expected : int, optional
        Records that will come at most, where it is known: the file is made for them.
    overwrite : bool
        Replace a file that is there.
    beside : bool
        Make and write the file with a second thread while the caller goes on. What goes wrong is then raised by a later call;
        `wait` tells whether the file is there.

    Raises
    ------
    FileError
        If the file cannot be created, or is there and is not to be replaced.
    InputError
        If a group or the compression is unknown, or the path names no file.

    Notes
    -----
    Records are written and flushed when two seconds have gone by or 8 MB wait. A run that is killed leaves a file that holds
    everything up to the last flush. Room on the disk is made sure of before each write, so that a full disk is an error and
    leaves a readable file too. Use it as a context manager, or call `close`.

    The file belongs to the process that made it: in a forked child the writer is closed, and nothing that the child does reaches
    the file. If another program removes or replaces the file, the records are kept (see `flush`).
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        scene: Any,
        layout: Layout,
        fields: Sequence[Field],
        groups: Sequence[str] | None = None,
        meta: Mapping[str, Any] | None = None,
        geometry: Mapping[str, float] | None = None,
        compression: str | None = None,
        run_id: str | None = None,
        segment: int = 0,
        first_record: int = 0,
        expected: int | None = None,
        overwrite: bool = False,
        beside: bool = False,
    ) -> None:
        if compression not in (None, "gzip", "lzf"):
            raise InputError.of("compression", compression, "must be 'gzip', 'lzf' or None")
        self.path = output_path(path, overwrite=overwrite)
        self.run_id = run_id or uuid.uuid4().hex
        self.n_written = 0
        self._places = {name: (offset, tuple(shape)) for name, offset, shape in layout}
        self.fields = tuple(f for f in field_table.select(fields, groups) if f.name in self._places)
        self._width = sum(int(np.prod(self._places[f.name][1])) for f in self.fields)
        self._block = None if expected is None else block_rows(expected, 8 * self._width)
        self._waiting = WaitingRows(self._block)
        self._columns: dict[str, Column] = {}
        self._whole_run: dict[str, Column] = {}
        self._failed = False
        self._second = SecondThread() if beside else None
        self._file: Any = None
        head = {"run_id": self.run_id, "segment": segment, "first_record": first_record}
        header = partial(self._write_header, head, scene, dict(meta or {}), dict(geometry or {}), compression)
        with self._guard("cannot be written"):
            replaced = take_lock(self.path) if overwrite and self.path.exists() else None
            try:
                # segments of one run that are begun at the same time must not share a draft
                draft, stream = create_draft(self.path, uuid.uuid4().hex)
                _WRITERS.add(self)
                make = partial(self._make, draft, stream, header, replace=replaced is not None)
                if self._second is None or replaced is not None:
                    make()
                else:
                    self._second.start(make)
            finally:
                if replaced is not None:
                    replaced.close()

    def _make(self, draft: Path, stream: BinaryIO, header: Callable[[h5py.File], None], *, replace: bool) -> None:
        """Make every object of the file in a draft, which then takes its place."""
        with self._guard("cannot be written"):
            try:
                self._lock = lock(stream)
                self._file = h5py.File(draft, "w", libver=LIBVER)
                # ext4 writes a file that was emptied to the disk when it is closed the next time: better now than in the end
                draft.open("rb").close()
                header(self._file)
                self._file.flush()
                self._file.swmr_mode = True
                try:
                    put_in_place(draft, self.path, replace=replace)
                except FileExistsError:
                    raise exists_already(self.path) from None
            except BaseException:
                with suppress(AttributeError, OSError, RuntimeError):
                    file, self._file = self._file, None
                    if file is not None:
                        file.close()
                stream.close()
                draft.unlink(missing_ok=True)
                raise

    def _write_header(
        self,
        head: dict[str, Any],
        scene: Any,
        meta: dict[str, Any],
        geometry: dict[str, float],
        compression: str | None,
        file: h5py.File,
    ) -> None:
        write_head(file, head, scene, meta, geometry)
        shapes = {entry.name: self._places[entry.name][1] for entry in self.fields}
        self._columns, self._whole_run = make_columns(
            file, self.fields, shapes, rows=self._block, compression=compression
        )

    @contextmanager
    def _guard(self, what: str) -> Iterator[None]:
        try:
            yield
        except FileError:
            raise
        except (OSError, RuntimeError, MemoryError) as error:
            raise FileError(f"{self.path}: the result file {what}: {reason(error)}") from error

    def append(self, records: ArrayLike) -> None:
        """Add records.

        Parameters
        ----------
        records : array_like, shape (n, record_length)
            Full records in the layout given at the start. They may be written later: do not change them.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        rows = np.atleast_2d(np.asarray(records, dtype=float))
        if rows.shape[0] == 0:
            return
        self._waiting.append(rows)
        is_late = self._waiting.seconds >= FLUSH_SECONDS
        if not is_late and self._waiting.nbytes < FLUSH_BYTES:
            return
        rows_to_write = self._waiting.take(whole_blocks=not is_late)
        if self._second is None:
            self._flush(rows_to_write)
        else:
            self.wait()
            self._second.start(partial(self._flush, rows_to_write))

    def flush(self) -> None:
        """Write what waits in memory, so that it survives a kill.

        Raises
        ------
        FileError
            If the file cannot be written; what the disk had room for stays readable. Also if another
            program has removed the file, which is then put back, or has put another one in its place, which is left alone: the
            records are then in a file beside it. The message names it.
        """
        rows = self._waiting.take()
        self.wait()
        self._flush(rows)

    def _flush_or_drop(self) -> None:
        """At the end: what came after an error, which has been raised already, is not written."""
        self.wait()
        if self._failed:
            self._waiting.take()
        self.flush()

    def wait(self) -> None:
        """Wait for the second thread, and raise what went wrong there.

        Raises
        ------
        FileError
            If the file cannot be made or written.
        """
        if self._second is not None:
            self._second.wait()

    def _flush(self, pieces: list[Array]) -> None:
        if not self._file:
            raise FileError(f"{self.path}: the result file is closed already")
        with self._guard("cannot be written"):
            if pieces:
                self._write(pieces)
            self._file.flush()
        if not is_same(self.path, self._lock):
            self._rescue()

    def _rescue(self) -> None:
        """Keep the records of a file that has lost its name, and say where they are."""
        with self._guard("was removed or replaced while it was written, and cannot be put back"):
            used = self._file.id.get_filesize()
            self._file.close()
            os.ftruncate(self._lock.fileno(), used)
            kept, what = self.path, "was removed by another program; it is put back with the records so far"
            try:
                copy_content(self._lock, kept)
            except FileExistsError:
                kept = self.path.with_name(f"{self.path.stem}.{self.run_id[:12]}{self.path.suffix}")
                copy_content(self._lock, kept)
                what = f"was replaced by another program; the records so far are in {kept}"
            self._lock.close()
        raise FileError(f"{self.path}: the result file {what}")

    def _forget(self) -> None:
        """In a forked child: the file is the parent's. What HDF5 still writes goes nowhere, the lock stays with the parent."""
        if not self._file:
            return
        nowhere = os.memfd_create("trbdyn") if hasattr(os, "memfd_create") else os.open(os.devnull, os.O_RDWR)
        os.dup2(nowhere, self._file.id.get_vfd_handle(), inheritable=False)
        os.dup2(nowhere, self._lock.fileno(), inheritable=False)
        os.close(nowhere)
        self._waiting.take()
        self._second = None
        with suppress(OSError, RuntimeError):
            self._file.close()
        self._lock.close()

    def sync(self) -> None:
        """Write what waits, and have the system put it on the disk.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        self.flush()
        with self._guard("cannot be written"):
            os.fsync(self._lock.fileno())

    def _reserve(self, size: int) -> None:
        """Make sure that the disk has room: HDF5 brings the process down when it runs out of it in the middle of a write."""
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(self._lock.fileno(), self._file.id.get_filesize(), size)
        elif shutil.disk_usage(self.path.parent).free < size:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def _write(self, pieces: list[Array]) -> None:
        """Add pieces of records, or as many as the disk has room for. After an error nothing more is written: it would lie
        behind a gap.
        """
        if self._failed:
            raise OSError("records before these could not be written")
        self._failed = True
        count, full = sum(map(len, pieces)), None
        while True:
            try:
                self._reserve(sum(column.room_for(count) for column in self._columns.values()) + SPARE_BYTES)
                break
            except OSError as error:
                if count < 2:
                    raise
                full, count = error, count // 2
        for entry in self.fields:
            offset, shape = self._places[entry.name]
            end = offset + int(np.prod(shape))
            rows = np.concatenate([piece[:, offset:end] for piece in pieces])[:count]
            self._columns[entry.name].append(rows.reshape(-1, *shape))
        self.n_written += count
        if full is not None:
            self._file.flush()
            raise full
        self._failed = False

    def finish(
        self,
        success: bool,
        message: str,
        stats: Mapping[str, Any],
        counters: Mapping[str, int],
        final_time: float,
        final_state: ArrayLike | None,
        peaks: Mapping[str, Array] | None = None,
        warnings: Sequence[str] = (),
    ) -> None:
        """Write how the run ended, and close the file.

        Parameters
        ----------
        success : bool
            Whether the run reached its end.
        message : str
            How it ended, in a sentence.
        stats : mapping
            Solver statistics.
        counters : mapping of str to int
            Evaluations of each effect.
        final_time : float
            Time of the final state, s.
        final_state : array_like or None, shape (n_state,)
            The last good state.
        peaks : mapping of str to ndarray, optional
            Peaks of the whole run.
        warnings : sequence of str
            What the watch over the run found.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        self._flush_or_drop()
        with self._guard("cannot be written"):
            self._reserve(SPARE_BYTES)
            if final_state is not None:
                self._put("final_state", np.asarray(final_state, dtype=float))
            for name, values in (peaks or {}).items():
                self._whole_run[name].append(np.asarray(values, dtype=float)[np.newaxis])
            ending = {"success": bool(success), "message": str(message), "final_time": float(final_time)}
            ending |= {"stats": dict(stats), "counters": dict(counters), "warnings": list(warnings)}
            self._put("ending", np.frombuffer(json_text(ending).encode(), dtype="u1"))
        self.close()

    def _put(self, name: str, values: NDArray[Any]) -> None:
        self._file[name].resize(values.size, axis=0)
        self._file[name][:] = values
        self._file.flush()

    def close(self) -> None:
        """Write what waits and close the file; an unfinished run stays marked as such."""
        try:
            self.wait()
            if self._file:
                self._flush_or_drop()
        finally:
            self._close()

    def _close(self) -> None:
        if self._file:
            with self._guard("cannot be closed"):
                used = self._file.id.get_filesize()
                self._file.close()
                os.ftruncate(self._lock.fileno(), used)
                self._lock.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


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
