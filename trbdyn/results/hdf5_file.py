"""HDF5 files of a result: how they are made, and records added; `trbdyn.results.file_format` says what they hold.

Datasets and attributes are made through the low interface of h5py: a result has more than a hundred of them, and the usual one
looks each up by name again, and makes a type for every single value.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.base.version import __version__
from trbdyn.results.chunks import LEVEL, packed
from trbdyn.results.fields import DIMENSIONS, Field, Layout
from trbdyn.results.file_format import (
    ASSEMBLY,
    ASSEMBLY_SCHEMA,
    ASSEMBLY_VERSION,
    LIBVER,
    SCHEMA,
    SCHEMA_VERSION,
    as_kept,
    json_text,
    stored_type,
)

_LABELS = {dim for dims in DIMENSIONS.values() for dim in dims} - {"roller", "slot", "mode"}
"""Dimensions whose entries have the letters of the name as labels."""


@dataclass(frozen=True)
class Part:
    """A bearing of a run, as its file has it: its scene, where fields are in a record, those that are kept, what JSON holds of
    versions and settings, its derived geometry (SI), and its group in the file, none where it has the file for itself.
    """

    scene: Any
    layout: Layout
    fields: Sequence[Field]
    meta: Mapping[str, Any] = field(default_factory=dict)
    geometry: Mapping[str, float] = field(default_factory=dict)
    name: str = ""

    @cached_property
    def places(self) -> dict[str, tuple[int, tuple[int, ...]]]:
        """Offset and shape of each field that is kept, in a record."""
        every = {name: (offset, tuple(shape)) for name, offset, shape in self.layout}
        return {entry.name: every[entry.name] for entry in self.fields}

    @property
    def row_bytes(self) -> int:
        """Bytes of a record in the file."""
        sizes = {name: int(np.prod(shape)) for name, (_, shape) in self.places.items()}
        return sum(stored_type(entry).itemsize * sizes[entry.name] for entry in self.fields)

    def group(self, file: h5py.File) -> h5py.Group:
        """Its part of a file of `make`."""
        return file[self.name] if self.name else file

    def append(self, file: h5py.File, pieces: Sequence[NDArray[np.float64]], count: int) -> None:
        """Add the first records of some pieces."""
        group = self.group(file)
        for entry in self.fields:
            offset, shape = self.places[entry.name]
            end = offset + int(np.prod(shape))
            rows = np.concatenate([piece[:, offset:end] for piece in pieces])[:count]
            append(group, entry.name, as_kept(entry, rows).reshape(-1, *shape))


def make(
    path: Path, parts: Sequence[Part], run: Mapping[str, Any], assembly: Mapping[str, Any] | None, *, rows: int
) -> None:
    """Make a result file without records, with so many rows in a chunk; a file that is there is emptied. `run` names the run and
    its first record; `assembly` says what several bearings sit on.
    """
    with h5py.File(path, "w", libver=LIBVER, locking=False) as file:
        if parts[0].name:
            about = {"schema": ASSEMBLY_SCHEMA, "schema_version": ASSEMBLY_VERSION, "trbdyn_version": __version__}
            about |= {"created": datetime.now(UTC).isoformat()}
            file.attrs.update(about)
            text = json_text(about | {"bearings": [part.name for part in parts], "assembly": assembly}).encode()
            file.create_dataset(ASSEMBLY, data=np.array([text]), chunks=(1,), fletcher32=True)
        for part in parts:
            _fill(file.create_group(part.name) if part.name else file, part, run, rows=rows)


def _fill(file: h5py.Group, part: Part, of_run: Mapping[str, Any], *, rows: int) -> None:
    """Make the objects of a bearing in an empty file or group."""
    created = datetime.now(UTC).isoformat()
    about = {"schema": SCHEMA, "schema_version": SCHEMA_VERSION, "trbdyn_version": __version__, "created": created}
    head = {"scene": part.scene.to_dict(), "meta": dict(part.meta), "geometry": dict(part.geometry)}
    table = [[entry.name, entry.group, entry.kind, entry.unit, entry.text] for entry in part.fields]
    text = json_text(about | dict(of_run) | head | {"fields": table}).encode()
    simple = {name: value for name, value in part.meta.items() if isinstance(value, str | bool | int | float)}
    file.attrs.update(about | {"run_id": of_run["run_id"]} | simple)
    run = file.create_group("run")
    # each a scale of its own: netCDF's readers would have to make up dimensions otherwise
    made = [
        _dataset(run, "head", (1,), np.dtype(f"S{len(text)}")),
        # not packed: it is written again and again in the same place
        _dataset(run, "committed", (3,), np.dtype("i8"), packed=False),
        _dataset(run, "ending", (), np.dtype("u1"), rows=4096),
        _dataset(run, "final_state", (), np.dtype("f8"), rows=512),
        _dataset(run, "peaks", (), np.dtype("f8"), rows=512),
    ]
    for dataset in made:
        h5py.h5ds.set_scale(dataset, h5py.h5i.get_name(dataset).rpartition(b"/")[2])
    run["head"][0] = np.bytes_(text)
    _make_fields(file, part, rows=rows)
    commit(file, 0)


def _make_fields(file: h5py.Group, part: Part, *, rows: int) -> None:
    scales: dict[str, h5py.h5d.DatasetID] = {}
    shapes = {name: shape for name, (_, shape) in part.places.items()}
    for dim, size in {
        dim: size for entry in part.fields for dim, size in zip(entry.dims, shapes[entry.name], strict=True)
    }.items():
        if dim in _LABELS:
            scales[dim] = file.create_dataset(dim, data=list(dim), dtype=h5py.string_dtype(), chunks=(size,)).id
        else:
            scales[dim] = _dataset(file, dim, (size,), np.dtype("i4"))
            file[dim][:] = np.arange(size)
    made = {
        entry.name: _dataset(file, entry.name, shapes[entry.name], stored_type(entry), rows=rows)
        for entry in part.fields
    }
    scales["time"] = made["time"]
    for dim, scale in scales.items():
        h5py.h5ds.set_scale(scale, dim.encode())
    for entry in part.fields:
        for name, value in (("units", entry.unit), ("long_name", entry.text), ("group", entry.group)):
            attribute = h5py.h5a.create(made[entry.name], name.encode(), _text(), h5py.h5s.create(h5py.h5s.SCALAR))
            attribute.write(np.array(value, dtype=h5py.string_dtype()))
        if entry.name != "time":
            for axis, dim in enumerate(("time", *entry.dims)):
                h5py.h5ds.attach_scale(made[entry.name], scales[dim], axis)


@cache
def _text() -> h5py.h5t.TypeID:
    return h5py.h5t.py_create(h5py.string_dtype(), logical=True)


def _dataset(
    group: h5py.Group,
    name: str,
    shape: tuple[int, ...],
    kind: np.dtype[Any],
    *,
    rows: int | None = None,
    packed: bool = True,
) -> h5py.h5d.DatasetID:
    """A new dataset with checksums; with `rows` one that grows by such rows of a shape, which are its chunks."""
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_obj_track_times(False)
    how.set_chunk(shape if rows is None else (rows, *shape))
    if packed:
        how.set_shuffle()
        how.set_deflate(LEVEL)
    how.set_fletcher32()
    most = shape if rows is None else (h5py.h5s.UNLIMITED, *shape)
    space = h5py.h5s.create_simple(shape if rows is None else (0, *shape), most)
    return h5py.h5d.create(group.id, name.encode(), h5py.h5t.py_create(kind), space, how)


@contextmanager
def opened_to_append(path: Path) -> Iterator[h5py.File]:
    """A file of `make`, open in SWMR mode until the end of the block. Hold its lock: HDF5's own would let readers stop a run."""
    access = h5py.h5p.create(h5py.h5p.FILE_ACCESS)
    access.set_libver_bounds(h5py.h5f.LIBVER_V110, h5py.h5f.LIBVER_V110)
    access.set_fclose_degree(h5py.h5f.CLOSE_STRONG)
    access.set_file_locking(False, False)
    flags = h5py.h5f.ACC_RDWR | h5py.h5f.ACC_SWMR_WRITE
    with h5py.File(h5py.h5f.open(bytes(path), flags, access)) as file:
        yield file


def append(group: h5py.Group, name: str, rows: NDArray[Any]) -> None:
    """Add rows, shape (n, ...), to a dataset that is packed."""
    dataset = h5py.h5d.open(group.id, name.encode())
    start = dataset.shape[0]
    dataset.set_extent((start + len(rows), *rows.shape[1:]))
    rows = np.ascontiguousarray(rows, dtype=dataset.dtype)
    size = dataset.get_create_plist().get_chunk()[0]
    origin = (0,) * (rows.ndim - 1)
    # a chunk that is begun is read and written again by HDF5
    begun = min(-start % size, len(rows))
    if begun:
        place = dataset.get_space()
        place.select_hyperslab((start, *origin), rows[:begun].shape)
        dataset.write(h5py.h5s.create_simple(rows[:begun].shape), place, rows[:begun])
    for at in range(begun, len(rows), size):
        chunk = rows[at : at + size]
        if len(chunk) < size:  # a chunk is a whole one in the file
            chunk = np.concatenate([chunk, np.zeros((size - len(chunk), *rows.shape[1:]), dtype=rows.dtype)])
        dataset.write_direct_chunk((start + at, *origin), packed(chunk))


def commit(file: h5py.Group, n_records: int, n_ending: int = 0) -> None:
    """Let the records so far count, once they are written."""
    file.file.flush()
    # the last number tells it from zeros, whose checksum is zero
    file["run/committed"][:] = (n_records, n_ending, 1)
