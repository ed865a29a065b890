"""Attributes and rows written through the low interface of h5py.

A result has a hundred datasets with six attributes each, and the usual interface looks each of them up by name again and asks for
its type several times.
"""

from __future__ import annotations

from collections.abc import Mapping

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.results.file_format import stored

_ONE = h5py.h5s.create(h5py.h5s.SCALAR)


def describe(dataset: h5py.Dataset, attributes: Mapping[str, str | int]) -> None:
    """Give a new dataset its attributes: texts of fixed length, and whole numbers of 64 bit.

    Parameters
    ----------
    dataset : Dataset
        Without these attributes.
    attributes : mapping
        Their values by name.
    """
    for name, value in attributes.items():
        data = np.asarray(stored(value))
        place = h5py.h5a.create(dataset.id, name.encode(), h5py.h5t.py_create(data.dtype), _ONE)
        place.write(data)


def append(dataset: h5py.h5d.DatasetID, start: int, rows: NDArray[np.float64]) -> None:
    """Add rows to a dataset that can grow along its first axis.

    Parameters
    ----------
    dataset : DatasetID
        The dataset.
    start : int
        Rows that it has.
    rows : ndarray, shape (n, ...)
        What is added.
    """
    dataset.set_extent((start + rows.shape[0], *rows.shape[1:]))
    place = dataset.get_space()
    place.select_hyperslab((start, *(0,) * (rows.ndim - 1)), rows.shape)
    dataset.write(h5py.h5s.create_simple(rows.shape), place, np.ascontiguousarray(rows))
