"""Where a result reads its fields from: arrays in memory, a window of another source, or a file."""

from __future__ import annotations

import json
import os
import re
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import file_path
from trbdyn.errors import FileError
from trbdyn.results.fields import Field
from trbdyn.results.file_format import JSON_ATTRIBUTES, PEAKS, SCHEMA, SCHEMA_VERSION, RunInfo, reason
from trbdyn.results.hdf5_checks import check_stored, own, own_stored
from trbdyn.results.hdf5_marks import open_to_read

Array = NDArray[np.float64]

_READ_ERRORS = (
    OSError,
    RuntimeError,
    KeyError,
    ValueError,
    TypeError,
    AttributeError,
    OverflowError,
    MemoryError,
    RecursionError,
)


class Source(Protocol):
    """Where a result reads its fields from."""

    @property
    def fields(self) -> tuple[Field, ...]:
        """The fields that can be read, in the order of the record."""

    @property
    def n_records(self) -> int:
        """Number of records."""

    def read(self, name: str) -> Array:
        """All records of one field, time first."""


@dataclass(frozen=True, slots=True)
class MemorySource:
    """Fields as arrays in memory."""

    fields: tuple[Field, ...]
    n_records: int
    arrays: Mapping[str, Array]

    def read(self, name: str) -> Array:
        """All records of one field, time first."""
        return self.arrays[name]


@dataclass(frozen=True, slots=True)
class WindowSource:
    """Part of another source: some of its fields, and the records from `start` to `stop`."""

    source: Source
    fields: tuple[Field, ...]
    start: int
    stop: int

    @property
    def n_records(self) -> int:
        """Number of records."""
        return self.stop - self.start

    def read(self, name: str) -> Array:
        """All records of one field within the window, time first."""
        return self.source.read(name)[self.start : self.stop]


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """A result file, open to be read; what goes wrong inside is a FileError that names it.

    Raises
    ------
    FileError
        If the file is missing, damaged, of another kind or of a later version.
    """
    if not path.is_file():
        raise FileError(f"{path}: there is no such file")
    with _said(path), open_to_read(path) as file:
        _check_schema(path, file)
        yield file


@contextmanager
def _said(path: Path) -> Iterator[None]:
    """What goes wrong while a result file is read is a FileError that names it."""
    try:
        yield
    except _READ_ERRORS as error:
        if isinstance(error, FileError):
            raise
        why = reason(error) if isinstance(error, OSError) else f"the file is damaged ({reason(error)})"
        raise FileError(f"{path}: the result cannot be read: {why}") from error


def _check_schema(path: Path, file: h5py.File) -> None:
    if _text(file.attrs.get("schema", "")) != SCHEMA:
        raise FileError(f"{path}: this HDF5 file is not a result of trbdyn (no schema {SCHEMA!r})")
    version = int(file.attrs["schema_version"])
    if version > SCHEMA_VERSION:
        raise FileError(f"{path}: written with schema version {version}; this trbdyn reads up to {SCHEMA_VERSION}")


def run_id_in(path: Path) -> str | None:
    """Name of the run whose records are in a file; None where there is no result that can be opened."""
    try:
        with opened(path) as file:
            return _text(file.attrs["run_id"])
    except FileError:
        return None


@dataclass(frozen=True, slots=True)
class Written:
    """What a process knows of the file that it has just written, so that it need not look through it again.

    Attributes
    ----------
    fields : tuple of Field
        The fields in the file, in the order of the record.
    n_records : int
        Number of records.
    peaks : mapping of str to ndarray
        Peaks of the whole run.
    """

    fields: tuple[Field, ...]
    n_records: int
    peaks: Mapping[str, Array]


class FileSource:
    """Reads fields from one file when they are asked for. The file is open only while reading.

    Parameters
    ----------
    path : path-like
        A file that `ResultWriter` has written.
    written : Written, optional
        What is known of it. Without, the file is looked through and checked.

    Attributes
    ----------
    fields : tuple of Field
        The fields in the file, in the order of the record.
    n_records : int
        Number of whole records.
    info : RunInfo
        Everything besides the records.
    run_id : str
        Name of the run that it is a segment of.
    first_record : int
        Place of its first record in the run.
    finished : bool
        Whether its writer has ended it.

    Raises
    ------
    FileError
        If the file is missing, damaged, of another kind or of a later version.
    """

    def __init__(self, path: str | os.PathLike[str], written: Written | None = None) -> None:
        self.path = file_path(path, "path")
        self._cache: dict[str, Array] = {}
        self._held: dict[int, h5py.File] = {}
        with opened(self.path) as file:
            self._created = _text(file.attrs["created"])
            self.run_id = _text(file.attrs["run_id"])
            self.first_record = int(file.attrs["first_record"])
            if self.first_record < 0:
                raise FileError(f"{self.path}: the file is damaged (first_record = {self.first_record})")
            ending = own(file, "ending", h5py.Dataset)[()]
            self.finished = ending.size > 0
            self._ending = json.loads(ending.astype("u1").tobytes()) if self.finished else {}
            if written is None:
                self.fields, lengths = self._read_fields(file)
                self.n_records = min(lengths, default=0)
            else:
                self.fields, self.n_records = written.fields, written.n_records
            self.info = self._read_info(file, None if written is None else written.peaks)

    def _read_fields(self, file: h5py.File) -> tuple[tuple[Field, ...], list[int]]:
        found: list[tuple[int, Field, int]] = []
        group, room = own(file, "fields", h5py.Group), []
        for name in group:
            dataset, storage = own_stored(group, name, h5py.Dataset)
            room.append(storage)
            attributes = {key: _text(dataset.attrs[key]) for key in ("group", "kind", "unit", "description")}
            entry = Field(name, attributes["group"], attributes["kind"], attributes["unit"], attributes["description"])
            if dataset.dtype != np.float64 or dataset.ndim != 1 + len(entry.dims):
                raise FileError(f"{self.path}: the dataset of {name!r} is damaged ({dataset.dtype}, {dataset.shape})")
            found.append((int(dataset.attrs["index"]), entry, int(dataset.shape[0])))
        check_stored(group, "its fields together", *room)
        found.sort(key=lambda row: row[0])
        return tuple(entry for _, entry, _ in found), [length for _, _, length in found]

    def _read_info(self, file: h5py.File, known: Mapping[str, Array] | None) -> RunInfo:
        attributes = file.attrs
        geometry, meta = (_table(json.loads(_text(attributes[key]))) for key in JSON_ATTRIBUTES)
        stats, counters = (_table(self._ending.get(key, {})) for key in ("stats", "counters"))
        meta |= {key: _text(attributes[key]) for key in ("trbdyn_version", "created")}
        meta |= {key: int(attributes[key]) for key in ("schema_version", "segment")}
        peaks = dict(known) if known is not None else self._read_peaks(file) if self.finished else {}
        message, final_time = str(self._ending.get("message", "")), float(self._ending.get("final_time", np.nan))
        state = np.asarray(own(file, "final_state", h5py.Dataset)[()], dtype=float)
        if not self.finished:
            message = "the run was cut off before its end; the records up to the last write are here"
            if self.n_records and "time" in file["fields"]:
                final_time = float(file["fields"]["time"][self.n_records - 1])
                message = f"the run was cut off before its end; its last record is at t = {final_time:.6g} s"
        return RunInfo(
            scene=_table(json.loads(_text(own(file, "scene", h5py.Dataset)[()]))),
            success=self._ending.get("success") is True,
            message=message,
            stats=stats,
            counters=counters,
            warnings=_texts(self._ending.get("warnings")),
            final_time=final_time,
            final_state=state if self.finished and state.size else None,
            geometry=geometry,
            meta=meta,
            peaks=peaks,
        )

    def _read_peaks(self, file: h5py.File) -> dict[str, Array]:
        """Peaks of the whole run; none in files of runs that kept none."""
        found: dict[str, Array] = {}
        if "peaks" not in file:
            return found
        group = own(file, "peaks", h5py.Group)
        fields = file["fields"]
        for name in (entry.name for entry in self.fields if entry.group == PEAKS):
            dataset = own(group, name, h5py.Dataset)
            shape = fields[name].shape[1:]
            if dataset.dtype != np.float64 or dataset.shape not in ((0, *shape), (1, *shape)):
                raise FileError(f"{self.path}: the dataset of {name!r} is damaged ({dataset.dtype}, {dataset.shape})")
            if dataset.shape[0] == 1:
                found[name] = np.asarray(dataset[0], dtype=float)
        return found

    def read(self, name: str) -> Array:
        """All records of one field, shape (n_records, ...); read once and kept.

        Raises
        ------
        FileError
            If the file is damaged, or has been replaced since it was opened first.
        """
        if name not in self._cache:
            held = self._held.get(threading.get_ident())
            if held is not None:
                with _said(self.path):
                    values = self._values(held, name)
            else:
                with opened(self.path) as file:
                    values = self._values(file, name)
            values.flags.writeable = False
            self._cache[name] = values
        return self._cache[name]

    def _values(self, file: h5py.File, name: str) -> Array:
        if _text(file.attrs["created"]) != self._created:
            raise FileError(f"{self.path}: the file has been replaced since it was loaded; load it again")
        return np.asarray(own(file["fields"], name, h5py.Dataset)[: self.n_records], dtype=float)

    @contextmanager
    def held_open(self) -> Iterator[None]:
        """Opens the file once for all that this thread reads inside. What goes wrong inside comes out as it is."""
        me = threading.get_ident()
        if me in self._held or not self.path.is_file():
            yield
            return
        with _said(self.path):
            file = open_to_read(self.path)
        try:
            with _said(self.path):
                _check_schema(self.path, file)
            self._held[me] = file
            yield
        finally:
            self._held.pop(me, None)
            file.close()


class JoinedSource:
    """The segments of one run as a whole. Where two hold a record, the later segment counts.

    Parameters
    ----------
    segments : sequence of FileSource
        The segments, in order.

    Attributes
    ----------
    missing : int
        Records that no segment holds.
    segments : list of FileSource
        The segments, in order.
    """

    def __init__(self, segments: Sequence[FileSource]) -> None:
        self.fields = segments[-1].fields
        self.missing = 0
        self._parts: list[tuple[FileSource, int]] = []
        limit: int | None = None
        for segment in reversed(segments):
            held = segment.n_records
            if limit is not None:
                held = min(held, max(limit - segment.first_record, 0))
                self.missing += max(limit - segment.first_record - held, 0)
            self._parts.insert(0, (segment, held))
            limit = segment.first_record if limit is None else min(limit, segment.first_record)
        self.segments = list(segments)
        if any(segment.fields != self.fields for segment in segments):
            raise FileError(f"{segments[-1].path}: holds other fields than the segments before it")
        self.n_records = sum(held for _, held in self._parts)

    def read(self, name: str) -> Array:
        """All records of one field, time first."""
        values = np.concatenate([segment.read(name)[:held] for segment, held in self._parts])
        values.flags.writeable = False
        return values


@contextmanager
def held_open(source: Source) -> Iterator[None]:
    """Opens the files of a source once for all that is read inside, whatever kind of source it is."""
    with ExitStack() as stack:
        for file in _files_of(source):
            stack.enter_context(file.held_open())
        yield


def _files_of(source: Source) -> list[FileSource]:
    if isinstance(source, WindowSource):
        return _files_of(source.source)
    if isinstance(source, JoinedSource):
        return source.segments
    return [source] if isinstance(source, FileSource) else []


def segment_paths(path: str | os.PathLike[str]) -> dict[int, Path]:
    """Files of the later segments of a run that begins in a file: number and path, ascending; whether they belong to the same
    run is not looked at.
    """
    first = Path(path)
    pattern = re.compile(re.escape(first.stem) + r"\.part([1-9]\d{0,8})" + re.escape(first.suffix))
    found: dict[int, Path] = {}
    if first.parent.is_dir():
        for entry in first.parent.iterdir():
            if (match := pattern.fullmatch(entry.name)) and not entry.is_symlink() and entry.is_file():
                found[int(match.group(1))] = entry
    return dict(sorted(found.items()))


def open_run(path: str | os.PathLike[str]) -> tuple[Source, RunInfo]:
    """Records and all else of a run, its segments joined.

    Parameters
    ----------
    path : path-like
        The run's first file, or one of its later segments, which is then read alone.

    Raises
    ------
    FileError
        If a segment is missing, damaged, of another kind or of a later version.
    """
    first = FileSource(path)
    if first.info.success and first.info.meta["segment"] == 0 and not first.first_record:
        return first, first.info  # complete in one file
    segments = [first]
    for place in segment_paths(path).values():
        try:
            segment = FileSource(place)
        except FileError as error:
            raise FileError(f"{error}; the other segments can be loaded one by one, by their own names") from error
        if segment.run_id == first.run_id:
            segments.append(segment)
    lost = first.first_record if first.info.meta["segment"] == 0 else 0
    if len(segments) == 1:
        return first, _with_missing(first.info, lost)
    joined, info = JoinedSource(segments), segments[-1].info
    return joined, _with_missing(info, lost + joined.missing)


def _with_missing(info: RunInfo, missing: int) -> RunInfo:
    """What is known of a run, with what is missing of it said."""
    return replace(info, message=f"{info.message}; {missing} records of it are missing") if missing else info


def _table(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ValueError("a table of named values is missing")
    return value


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _texts(value: object) -> tuple[str, ...]:
    """A list of sentences; nothing where a file holds anything else."""
    return tuple(str(text) for text in value) if isinstance(value, list) else ()
