"""Where a result reads its fields from: arrays in memory, a window of another source, or a file."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import FileError
from trbdyn.fields import Field
from trbdyn.result_file import JSON_ATTRIBUTES, SCHEMA, SCHEMA_VERSION, RunInfo, reason

Array = NDArray[np.float64]

_READ_ERRORS = (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError)


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


class FileSource:
    """Reads fields from one file when they are asked for. The file is open only while reading.

    Parameters
    ----------
    path : path-like
        A file that `ResultWriter` has written.

    Attributes
    ----------
    fields : tuple of Field
        The fields in the file, in the order of the record.
    n_records : int
        Number of whole records.
    info : RunInfo
        Everything besides the records.

    Raises
    ------
    FileError
        If the file is missing, damaged, of another kind or of a later version.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._cache: dict[str, Array] = {}
        with self._open() as file:
            self._created = _text(file.attrs["created"])
            self.fields, lengths = self._read_fields(file)
            self.n_records = min(lengths, default=0)
            self.info = self._read_info(file)

    @contextmanager
    def _open(self) -> Iterator[h5py.File]:
        if not self.path.is_file():
            raise FileError(f"{self.path}: there is no such file")
        try:
            with h5py.File(self.path, "r") as file:
                self._check_schema(file)
                yield file
        except _READ_ERRORS as error:
            if isinstance(error, FileError):
                raise
            why = reason(error) if isinstance(error, OSError) else f"the file is damaged ({reason(error)})"
            raise FileError(f"{self.path}: the result cannot be read: {why}") from error

    def _check_schema(self, file: h5py.File) -> None:
        if _text(file.attrs.get("schema", "")) != SCHEMA:
            raise FileError(f"{self.path}: this HDF5 file is not a result of trbdyn (no schema {SCHEMA!r})")
        version = int(file.attrs["schema_version"])
        if version > SCHEMA_VERSION:
            raise FileError(
                f"{self.path}: written with schema version {version}; this trbdyn reads up to {SCHEMA_VERSION}"
            )

    def _read_fields(self, file: h5py.File) -> tuple[tuple[Field, ...], list[int]]:
        found: list[tuple[int, Field, int]] = []
        for name in _own(file, "fields", h5py.Group):
            dataset = _own(file["fields"], name, h5py.Dataset)
            attributes = {key: _text(dataset.attrs[key]) for key in ("group", "kind", "unit", "description")}
            entry = Field(name, attributes["group"], attributes["kind"], attributes["unit"], attributes["description"])
            if dataset.dtype != np.float64 or dataset.ndim != 1 + len(entry.dims):
                raise FileError(f"{self.path}: the dataset of {name!r} is damaged ({dataset.dtype}, {dataset.shape})")
            found.append((int(dataset.attrs["index"]), entry, int(dataset.shape[0])))
        found.sort(key=lambda row: row[0])
        return tuple(entry for _, entry, _ in found), [length for _, _, length in found]

    def _read_info(self, file: h5py.File) -> RunInfo:
        attributes = file.attrs
        stats, counters, geometry, meta = (json.loads(_text(attributes[key])) for key in JSON_ATTRIBUTES)
        meta |= {key: _text(attributes[key]) for key in ("trbdyn_version", "created")}
        meta |= {key: int(attributes[key]) for key in ("schema_version", "segment")}
        finished, message = bool(attributes["finished"]), _text(attributes["message"])
        state = None
        if "final_state" in file:
            state = np.asarray(_own(file, "final_state", h5py.Dataset)[()], dtype=float)
        final_time = float(attributes.get("final_time", np.nan))
        if not finished:
            message = "the run was cut off before its end; the records up to the last write are here"
            if self.n_records and "time" in file["fields"]:
                final_time = float(file["fields"]["time"][self.n_records - 1])
                message = f"the run was cut off before its end; its records reach to t = {final_time:.6g} s"
        return RunInfo(
            scene=json.loads(_text(_own(file, "scene", h5py.Dataset)[()])),
            success=bool(attributes["success"]) and finished,
            message=message,
            stats=stats,
            counters=counters,
            final_time=final_time,
            final_state=state,
            geometry=geometry,
            meta=meta,
        )

    def read(self, name: str) -> Array:
        """All records of one field, shape (n_records, ...); read once and kept.

        Raises
        ------
        FileError
            If the file is damaged, or has been replaced since it was opened first.
        """
        if name not in self._cache:
            with self._open() as file:
                if _text(file.attrs["created"]) != self._created:
                    raise FileError(f"{self.path}: the file has been replaced since it was loaded; load it again")
                values = np.asarray(_own(file["fields"], name, h5py.Dataset)[: self.n_records], dtype=float)
            values.flags.writeable = False
            self._cache[name] = values
        return self._cache[name]


def _own(group: h5py.Group, name: str, kind: type) -> Any:
    """A member that lies in this file itself: no links or storage that lead elsewhere."""
    if not isinstance(group.get(name, getlink=True), h5py.HardLink):
        raise FileError(f"{group.file.filename}: {name!r} leads out of the file, which results never do")
    member = group[name]
    if not isinstance(member, kind):
        raise FileError(f"{group.file.filename}: {name!r} is not what a result holds there")
    if isinstance(member, h5py.Dataset) and (member.external or member.is_virtual):
        raise FileError(f"{group.file.filename}: {name!r} leads out of the file, which results never do")
    return member


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)
