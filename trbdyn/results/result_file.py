"""Writing a result file while the run goes on; `trbdyn.results.file_format` says what it holds."""

from __future__ import annotations

import errno
import os
import shutil
import time
import uuid
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from types import TracebackType
from typing import Any, BinaryIO, Self
from weakref import WeakSet

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.base.own_files import copy_content, create_draft, exists_already, is_same, output_path, put_in_place
from trbdyn.base.version import __version__
from trbdyn.errors import FileError
from trbdyn.results import fields as field_table
from trbdyn.results.fields import Field, Layout
from trbdyn.results.file_format import (
    CHUNK_BYTES,
    LIBVER,
    PEAKS,
    SCHEMA,
    SCHEMA_VERSION,
    chunk_rows,
    json_text,
    reason,
    stored,
)
from trbdyn.results.hdf5_marks import lock, take_lock
from trbdyn.results.hdf5_quick import append, describe

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
    overwrite : bool
        Replace a file that is there.

    Raises
    ------
    FileError
        If the file cannot be created, or is there and is not to be replaced.
    InputError
        If a group is unknown, or the path names no file.

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
        overwrite: bool = False,
    ) -> None:
        self.path = output_path(path, overwrite=overwrite)
        self.run_id = run_id or uuid.uuid4().hex
        self.n_written = 0
        self._places = {name: (offset, tuple(shape)) for name, offset, shape in layout}
        self.fields = tuple(f for f in field_table.select(fields, groups) if f.name in self._places)
        self._datasets: dict[str, h5py.h5d.DatasetID] = {}
        self._pending: list[Array] = []
        self._pending_bytes = 0
        self._last_flush = time.monotonic()
        with self._guard("cannot be written"):
            replaced = take_lock(self.path) if overwrite and self.path.exists() else None
            try:
                self._begin(
                    scene, {"segment": segment, "first_record": first_record}, meta, geometry, compression, replaced
                )
            finally:
                if replaced is not None:
                    replaced.close()
        _WRITERS.add(self)

    def _begin(
        self,
        scene: Any,
        place: dict[str, Any],
        meta: Mapping[str, Any] | None,
        geometry: Mapping[str, float] | None,
        compression: str | None,
        replaced: BinaryIO | None,
    ) -> None:
        """Make every object of the file in a draft, which then takes its place."""
        # segments of one run that are begun at the same time must not share a draft
        draft, stream = create_draft(self.path, uuid.uuid4().hex)
        try:
            self._lock = lock(stream)
            self._file = h5py.File(draft, "w", libver=LIBVER)
            head = {"run_id": self.run_id} | place
            self._write_header(head, scene.to_dict(), dict(meta or {}), dict(geometry or {}), compression)
            self._file.flush()
            self._file.swmr_mode = True
            try:
                put_in_place(draft, self.path, replace=replaced is not None)
            except FileExistsError:
                raise exists_already(self.path) from None
        except BaseException:
            with suppress(AttributeError, OSError, RuntimeError):
                self._file.close()
            stream.close()
            draft.unlink(missing_ok=True)
            raise

    def _write_header(
        self,
        place: dict[str, Any],
        scene: dict[str, Any],
        meta: dict[str, Any],
        geometry: dict[str, float],
        compression: str | None,
    ) -> None:
        head = {"schema": SCHEMA, "schema_version": SCHEMA_VERSION, "trbdyn_version": __version__} | place
        head |= {"created": datetime.now(UTC).isoformat(), "geometry": json_text(geometry), "meta": json_text(meta)}
        head |= {name: value for name, value in meta.items() if isinstance(value, str | bool | int | float)}
        self._file.attrs.update({name: stored(value) for name, value in head.items()})
        self._file.create_dataset("scene", data=stored(json_text(scene)))
        self._file.create_dataset("final_state", shape=(0,), maxshape=(None,), dtype="f8", chunks=(512,))
        self._file.create_dataset("ending", shape=(0,), maxshape=(None,), dtype="u1", chunks=(4096,))
        group = self._file.create_group("fields")
        peaks = self._file.create_group("peaks")
        for index, entry in enumerate(self.fields):
            shape = self._places[entry.name][1]
            if entry.group == PEAKS:
                whole = peaks.create_dataset(entry.name, (0, *shape), "f8", maxshape=(1, *shape), chunks=(1, *shape))
                self._describe(whole, entry, index)
            dataset = group.create_dataset(
                entry.name,
                shape=(0, *shape),
                maxshape=(None, *shape),
                dtype="f8",
                chunks=(chunk_rows(shape), *shape),
                compression=compression,
                shuffle=compression is not None,
            )
            self._describe(dataset, entry, index)
            self._datasets[entry.name] = dataset.id

    def _describe(self, dataset: h5py.Dataset, entry: Field, index: int) -> None:
        attributes = {"unit": entry.unit, "description": entry.text, "group": entry.group, "kind": entry.kind}
        attributes["dims"] = " ".join(("time", *entry.dims))
        describe(dataset, attributes | {"index": index})

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
            Full records in the layout given at the start.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        rows = np.array(records, dtype=float, ndmin=2)
        if rows.shape[0] == 0:
            return
        self._pending.append(rows)
        self._pending_bytes += rows.nbytes
        if self._pending_bytes >= FLUSH_BYTES or time.monotonic() - self._last_flush >= FLUSH_SECONDS:
            self.flush()

    def flush(self) -> None:
        """Write what waits in memory, so that it survives a kill.

        Raises
        ------
        FileError
            If the file cannot be written. What waited is lost then; what was written before stays readable. Also if another
            program has removed the file, which is then put back, or has put another one in its place, which is left alone: the
            records are then in a file beside it. The message names it.
        """
        if not self._file:
            raise FileError(f"{self.path}: the result file is closed already")
        pending, size = self._pending, self._pending_bytes
        self._pending, self._pending_bytes = [], 0
        with self._guard("cannot be written"):
            if pending:
                self._reserve(size + len(self.fields) * CHUNK_BYTES + SPARE_BYTES)
                self._write(pending[0] if len(pending) == 1 else np.concatenate(pending))
            self._file.flush()
        self._last_flush = time.monotonic()
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
        self._pending, self._pending_bytes = [], 0
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

    def _write(self, rows: Array) -> None:
        start, stop = self.n_written, self.n_written + rows.shape[0]
        for entry in self.fields:
            offset, shape = self._places[entry.name]
            size = int(np.prod(shape))
            append(self._datasets[entry.name], start, rows[:, offset : offset + size].reshape(-1, *shape))
        self.n_written = stop

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
        self.flush()
        with self._guard("cannot be written"):
            self._reserve(SPARE_BYTES)
            if final_state is not None:
                self._put("final_state", np.asarray(final_state, dtype=float))
            whole = self._file["peaks"]
            for name, values in (peaks or {}).items():
                append(whole[name].id, 0, np.asarray(values, dtype=float)[np.newaxis])
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
        if not self._file:
            return
        try:
            self.flush()
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


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_all)
