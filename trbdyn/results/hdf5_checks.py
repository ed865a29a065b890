"""Checks of what lies in a result file before it is read: a file from elsewhere may be damaged, or made to lead astray."""

from __future__ import annotations

import math
from typing import Any, Final

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import FileError

MOST_TEXT: Final = 64 << 20
"""Most bytes of what a result holds besides its records: texts, last state, peaks."""


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
    if most is not None and size > most:
        raise FileError(f"{where}: {name!r} would take {size / 1e6:.0f} MB in memory, more than a result holds there")
    return np.asarray(dataset[:wanted])
