"""Datasets, attributes and rows written through the low interface of h5py.

A result has more than a hundred datasets with six attributes each. The usual interface looks each one up by name again, and makes
a type for every single value.

Rows go into the file chunk by chunk. HDF5's own way keeps every chunk of a dataset in memory and writes it at each flush as far
as it is filled, which takes twice as long. So chunks that are not compressed are put together here and written as they are. One
that is not full yet is written with zeros in its free rows, and again, at the same place, when rows have come: rows that count do
not change by that, so that the file can be read at every instant.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.results.file_format import stored

Array = NDArray[np.float64]

_ONE = h5py.h5s.create(h5py.h5s.SCALAR)
_GZIP_LEVEL = 4


@cache
def _type(kind: str) -> h5py.h5t.TypeID:
    return h5py.h5t.py_create(np.dtype(kind))


def _creation(rows: int, shape: tuple[int, ...], compression: str | None) -> h5py.h5p.PropDCID:
    """How a dataset is stored."""
    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    made.set_obj_track_times(False)
    made.set_chunk((rows, *shape))
    if compression is not None:
        made.set_shuffle()
    if compression == "gzip":
        made.set_deflate(_GZIP_LEVEL)
    elif compression == "lzf":
        made.set_filter(h5py.h5z.FILTER_LZF, h5py.h5z.FLAG_OPTIONAL)
    return made


class Column:
    """A new dataset of float64 that grows along its first axis.

    Parameters
    ----------
    group : Group
        Where it is.
    name : str
        Name there.
    shape : tuple of int
        Shape of a row.
    rows : int
        Rows of a chunk.
    most : int, optional
        Rows that it can have; any number by default.
    compression : {"gzip", "lzf"}, optional
        How it is compressed; not at all by default.
    """

    def __init__(
        self,
        group: h5py.Group,
        name: str,
        shape: tuple[int, ...],
        rows: int,
        *,
        most: int | None = None,
        compression: str | None = None,
    ) -> None:
        space = h5py.h5s.create_simple((0, *shape), (h5py.h5s.UNLIMITED if most is None else most, *shape))
        made = _creation(rows, shape, compression)
        self._dataset = h5py.h5d.create(group.id, name.encode(), h5py.h5t.NATIVE_DOUBLE, space, made)
        self._length = rows
        self._packed = compression is not None
        self._shape = shape
        self._chunk_bytes = 8 * rows * math.prod(shape)
        self._size = 0
        self._begun: Array = np.empty((0, *shape))
        """Rows of the last chunk, where it is not full."""

    def describe(self, attributes: Mapping[str, str | int]) -> None:
        """Give it its attributes: texts of fixed length, and whole numbers of 64 bit.

        Parameters
        ----------
        attributes : mapping
            Their values by name; none of them is there yet.
        """
        for name, value in attributes.items():
            data = np.asarray(stored(value))
            kind = _type(data.dtype.str)
            h5py.h5a.create(self._dataset, name.encode(), kind, _ONE).write(data, kind)

    def room_for(self, count: int) -> int:
        """Bytes that the file may grow by for a number of further rows; more where they are compressed."""
        new_chunks = -(-(self._size + count) // self._length) - -(-self._size // self._length)
        return self._chunk_bytes * (new_chunks + self._packed)

    def append(self, rows: Array) -> None:
        """Add rows.

        Parameters
        ----------
        rows : ndarray, shape (n, ...)
            What is added.
        """
        start, self._size = self._size, self._size + len(rows)
        self._dataset.set_extent((self._size, *self._shape))
        if self._packed:
            self._select(start, np.ascontiguousarray(rows))
            return
        if len(self._begun):
            rows = np.concatenate([self._begun, rows])
            start -= len(self._begun)
        whole = len(rows) - len(rows) % self._length
        for at in range(0, whole, self._length):
            self._put(start + at, rows[at : at + self._length])
        self._begun = rows[whole:].copy()
        if len(self._begun):
            padded = np.zeros((self._length, *self._shape))
            padded[: len(self._begun)] = self._begun
            self._put(start + whole, padded)

    def _put(self, start: int, chunk: Array) -> None:
        self._dataset.write_direct_chunk((start, *(0,) * len(self._shape)), chunk)

    def _select(self, start: int, rows: Array) -> None:
        place = self._dataset.get_space()
        place.select_hyperslab((start, *(0,) * len(self._shape)), rows.shape)
        self._dataset.write(h5py.h5s.create_simple(rows.shape), place, rows)
