"""Reads a result file: what it says of itself, its fields, and the bearings in it.

A file from elsewhere may be damaged, or made to lead astray: what lies in it is looked at before it is read.
"""

from __future__ import annotations

import json
import math
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.base.locks import is_locked
from trbdyn.base.own_files import file_path
from trbdyn.base.reading import checked_file, unpacked_limit
from trbdyn.errors import FileError
from trbdyn.results import peaks as peak_table
from trbdyn.results.fields import Field
from trbdyn.results.file_format import (
    ASSEMBLY,
    ASSEMBLY_SCHEMA,
    ASSEMBLY_VERSION,
    SCHEMA,
    SCHEMA_VERSION,
    RunInfo,
    reason,
    stored_type,
)
from trbdyn.results.sources import Source

Array = NDArray[np.float64]

SMALL: Final = 16 << 20
"""Bytes of a dataset up to which nothing is asked."""
MOST_TEXT: Final = 64 << 20
"""Most bytes of what a result holds besides its records: texts, last state, peaks."""
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


def open_to_read(path: Path) -> h5py.File:
    """A file that is complete, is being written now, or whose writer was killed; an OSError if it cannot be read."""
    if not is_locked(path):
        try:
            return h5py.File(path, "r", locking=False)
        except OSError as error:
            # open in this process by others, such as xarray, with locks of their own
            if "flag values don't match" in str(error):
                return h5py.File(path, "r")
            if "already open for" not in str(error):
                raise
    return h5py.File(path, "r", swmr=True, locking=False)


@contextmanager
def opened(path: Path, bearing: str = "") -> Iterator[h5py.Group]:
    """A result file, or a bearing's part of one, open to be read; what goes wrong inside is a FileError that names it."""
    checked_file(path, "HDF5")
    with _said(path), open_to_read(path) as file:
        yield part_of(file, bearing)


def part_of(file: h5py.File, bearing: str) -> h5py.Group:
    """A bearing's part of the file of an assembly, or a FileError if there is none; without a name the whole of any file."""
    if not bearing:
        return file
    key = bearing.encode()
    own = (
        bearing.isidentifier() and file.id.links.exists(key) and file.id.links.get_info(key).type == h5py.h5l.TYPE_HARD
    )
    group = file[bearing] if own else None
    if not isinstance(group, h5py.Group) or "run" not in group:
        raise FileError(f"{file.filename}: the file holds no bearing of the name {bearing!r}")
    return group


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


def _read_head(path: Path, file: h5py.Group) -> bytes:
    """What the file says of itself, as it is stored."""
    if "run/head" not in file:
        if "schema" in file.attrs and "fields" in file:
            raise FileError(
                f"{path}: written with format version 1, by a trbdyn before its first release; this one reads version "
                f"{SCHEMA_VERSION} only: run the case again"
            )
        raise FileError(f"{path}: this HDF5 file is not a result of trbdyn (no schema {SCHEMA!r})")
    return bytes(read_text_or_state(_run(file), "head")[0])


def _run(file: h5py.Group) -> h5py.Group:
    group = file["run"] if file.id.links.get_info(b"run").type == h5py.h5l.TYPE_HARD else None
    if not isinstance(group, h5py.Group):
        raise FileError(f"{file.file.filename}: 'run' leads out of the file, which results never do")
    return group


def _table_of_head(path: Path, head: bytes) -> dict[str, Any]:
    """The head as a table, of a version that can be read."""
    table = _table(json.loads(head))
    if table["schema"] != SCHEMA or table["schema_version"] != SCHEMA_VERSION:
        raise FileError(
            f"{path}: written with schema version {table['schema_version']!r}; this trbdyn reads version {SCHEMA_VERSION}"
        )
    return table


def run_id_in(path: Path) -> str | None:
    """Name of the run whose records are in a file; None where there is no result that can be opened."""
    try:
        return FileSource(path, names_in(path)[0]).run_id
    except FileError:
        return None


def assembly_in(path: str | os.PathLike[str]) -> dict[str, Any] | None:
    """What a file says of its assembly: ``bearings``, their names, and ``assembly``; None where it is the file of one bearing.
    A FileError if the file cannot be read, or is of a later version.
    """
    where = file_path(path, "path")
    with opened(where) as file:
        if ASSEMBLY not in file:
            return None
        table = _table(json.loads(bytes(read_text_or_state(file, ASSEMBLY)[0])))
        _check_files(where, table)
        names = table.get("bearings")
        if table.get("schema") == ASSEMBLY_SCHEMA and not (
            isinstance(names, list) and names and all(isinstance(name, str) for name in names)
        ):
            raise FileError(f"{where}: the file is damaged (the names of its bearings are missing)")
    if table.get("schema") != ASSEMBLY_SCHEMA or table.get("schema_version") != ASSEMBLY_VERSION:
        raise FileError(
            f"{where}: written with schema version {table.get('schema_version')!r} of an assembly; this trbdyn reads version "
            f"{ASSEMBLY_VERSION}"
        )
    return table


def _check_files(path: Path, values: Any) -> None:
    """Refuse a scene or an assembly that, when it is built, would open a file to see what is in it."""
    if isinstance(values, dict):
        elastic = values.get("elastic_cage")
        if isinstance(elastic, dict) and elastic.get("file") is not None and elastic.get("file_sha256") is None:
            raise FileError(f"{path}: the file is damaged: elastic_cage.file has no checksum")
        values = list(values.values())
    for entry in values if isinstance(values, list) else ():
        _check_files(path, entry)


def names_in(path: str | os.PathLike[str]) -> tuple[str, ...]:
    """Names of the bearings in a file; one without a name where it has the file for itself."""
    table = assembly_in(path)
    return ("",) if table is None else tuple(table["bearings"])


class FileSource(Source):
    """Reads the fields of a bearing from a file of `ResultWriter` when they are asked for; the file is open only while reading.

    `first_record` is the place of its first record in the run: records before it are missing. `finished` tells whether its
    writer has ended it. A file that is missing, damaged, of another kind or of a later version is a FileError.
    """

    def __init__(self, path: str | os.PathLike[str], bearing: str = "") -> None:
        self.path, self.bearing = file_path(path, "path"), bearing
        self._cache: dict[str, Array] = {}
        self._held: dict[int, h5py.Group] = {}
        self._checked: set[int] = set()
        with opened(self.path, bearing) as file:
            self._head = _read_head(self.path, file)
            head = _table_of_head(self.path, self._head)
            self.run_id, self.first_record = str(head["run_id"]), head["first_record"]
            if not isinstance(self.first_record, int) or self.first_record < 0:
                raise FileError(f"{self.path}: the file is damaged (first_record = {self.first_record!r})")
            self.fields = tuple(Field(*(str(text) for text in row)) for row in head["fields"])
            count, size, sound = map(int, read_text_or_state(_run(file), "committed", 3))
            if sound != 1:
                raise FileError(f"{self.path}: the file is damaged (its number of records is missing)")
            self.n_records, self.finished = count, size > 0
            ending = (
                _table(json.loads(read_text_or_state(_run(file), "ending", size).tobytes())) if self.finished else {}
            )
            self.info = self._read_info(file, head, ending)

    def moved(self, path: Path) -> None:
        """The file has another name now."""
        self.path = path

    @property
    def files(self) -> tuple[Path, ...]:
        """The file that it reads from."""
        return (self.path,)

    def _read_info(self, file: h5py.Group, head: dict[str, Any], ending: dict[str, Any]) -> RunInfo:
        geometry, meta, scene = (_table(head[key]) for key in ("geometry", "meta", "scene"))
        _check_files(self.path, scene)
        stats, counters = (_table(ending.get(key, {})) for key in ("stats", "counters"))
        meta |= {key: head[key] for key in ("trbdyn_version", "created", "schema_version")}
        meta |= {"notes": list(_texts(meta["notes"]))} if "notes" in meta else {}
        message, final_time = str(ending.get("message", "")), float(ending.get("final_time", np.nan))
        state = np.asarray(read_text_or_state(_run(file), "final_state"), dtype=float) if self.finished else np.empty(0)
        if not self.finished:
            message = "the run was cut off before its end; the records up to the last write are here"
            if self.n_records and self.fields and self.fields[0].name == "time":
                final_time = float(read_own(file, "time", self.n_records)[-1])
                message = f"the run was cut off before its end; its last record is at t = {final_time:.6g} s"
        if self.first_record:
            message = f"{message}; {self.first_record} records of it are missing"
        return RunInfo(
            scene=scene,
            success=ending.get("success") is True,
            message=message,
            stats=stats,
            counters=counters,
            warnings=_texts(ending.get("warnings")),
            final_time=final_time,
            final_state=state if state.size else None,
            geometry=geometry,
            meta=meta,
            peaks=self._read_peaks(file) if self.finished else {},
        )

    def _read_peaks(self, file: h5py.Group) -> dict[str, Array]:
        """Peaks of the whole run; none in files of runs that kept none."""
        row, found, at = np.asarray(read_text_or_state(_run(file), "peaks"), dtype=float), {}, 0
        kept = [entry for entry in self.fields if entry.group == peak_table.GROUP] if row.size else []
        sizes = {dim: len(file[dim]) for dim in {dim for entry in kept for dim in entry.dims}}
        for entry in kept:
            shape = tuple(sizes[dim] for dim in entry.dims)
            size = math.prod(shape)
            found[entry.name] = row[at : at + size].reshape(shape)
            at += size
        if at != row.size:
            raise FileError(f"{self.path}: the file is damaged (its peaks of the whole run do not fit its fields)")
        return found

    def check(self) -> None:
        """Read every record once; a FileError if one of them is damaged."""
        with self.held_open():
            for entry in self.fields:
                self.read(entry.name)
                del self._cache[entry.name]

    def part(self, name: str, rows: slice) -> Array:
        """Some records of one field, which are not kept."""
        with self.held_open(), _said(self.path):
            return np.asarray(self._file()[name][rows], dtype=float)

    def read(self, name: str) -> Array:
        """All records of one field, shape (n_records, ...); read once and kept. A FileError if the file is damaged, or has been
        replaced since it was opened first.
        """
        if name not in self._cache:
            with self.held_open(), _said(self.path):
                values = self._values(self._file(), name)
            values.flags.writeable = False
            self._cache[name] = values
        return self._cache[name]

    def _file(self) -> h5py.Group:
        """What this thread holds open, which is looked at once: a file that holds another run by now is refused. A run that was
        resumed has a new file with the same records.
        """
        me = threading.get_ident()
        if me not in self._held:
            raise FileError(f"{self.path}: there is no such file")
        if me not in self._checked:
            head = _read_head(self.path, self._held[me])
            if head != self._head:
                table = _table_of_head(self.path, head)
                if (table["run_id"], table["first_record"]) != (self.run_id, self.first_record):
                    raise FileError(f"{self.path}: the file has been replaced since it was loaded; load it again")
            self._checked.add(me)
        return self._held[me]

    def _values(self, file: h5py.Group, name: str) -> Array:
        entry = next(entry for entry in self.fields if entry.name == name)
        values = read_own(file, name, self.n_records)
        if values.dtype != stored_type(entry) or values.ndim != 1 + len(entry.dims):
            raise FileError(f"{self.path}: the dataset of {name!r} is damaged ({values.dtype}, {values.shape})")
        return np.asarray(values, dtype=float)

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
                self._held[me] = part_of(file, self.bearing)
            yield
        finally:
            self._held.pop(me, None)
            self._checked.discard(me)
            with _said(self.path):
                file.close()


def _table(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ValueError("a table of named values is missing")
    return value


def _texts(value: object) -> tuple[str, ...]:
    """A list of sentences; nothing where a file holds anything else."""
    return tuple(str(text) for text in value) if isinstance(value, list) else ()


def read_text_or_state(group: h5py.Group, name: str, count: int | None = None) -> NDArray[Any]:
    """What `read_own` gives of a dataset beside the records, which is never large, however small it is packed."""
    return read_own(group, name, count, most=MOST_TEXT)


def read_own(group: h5py.Group, name: str, count: int | None = None, *, most: int | None = None) -> NDArray[Any]:
    """A dataset that lies in this file itself, or its first `count` rows: no links or storage that lead elsewhere, and no
    values that were never written, which take no room in a file but much when they are read.

    A FileError if there is no such dataset, or it does not hold so many rows, or they take more than `most` bytes in memory.
    """
    where, links, key = group.file.filename, group.id.links, name.encode()
    if not links.exists(key):
        raise FileError(f"{where}: the file is damaged: it has no {name!r}")
    if links.get_info(key).type != h5py.h5l.TYPE_HARD:
        raise FileError(f"{where}: {name!r} leads out of the file, which results never do")
    dataset = group[name]
    if not isinstance(dataset, h5py.Dataset) or dataset.ndim < 1:
        raise FileError(f"{where}: {name!r} is not what a result holds there")
    made = dataset.id.get_create_plist()
    if made.get_layout() == h5py.h5d.VIRTUAL or made.get_external_count() > 0:
        raise FileError(f"{where}: {name!r} leads out of the file, which results never do")
    wanted = dataset.shape[0] if count is None else count
    shape = dataset.chunks
    held = (
        0 if shape is None else dataset.id.get_num_chunks() * math.prod(shape) // max(1, math.prod(dataset.shape[1:]))
    )
    if not 0 <= wanted <= min(dataset.shape[0], held):
        raise FileError(
            f"{where}: the file is damaged: {wanted} values of {name!r} shall be there, but it holds {held}"
        )
    size = max(math.prod(dataset.shape[1:]) * wanted, math.prod(shape or ())) * dataset.dtype.itemsize
    packed = os.stat(where).st_size if size > SMALL else 0
    if size > (most or size) or (size > SMALL and size > unpacked_limit(packed)):
        raise FileError(f"{where}: {name!r} would take {size / 1e6:.0f} MB in memory, more than a result holds there")
    return np.asarray(dataset[:wanted])
