"""Checks of what lies in a result file before it is read: a file from elsewhere may be damaged, or made to lead astray."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import h5py

from trbdyn.errors import FileError
from trbdyn.results.result_file import FLUSH_BYTES

SMALL = 2 * FLUSH_BYTES
"""Bytes that a file may claim beyond what it holds: a writer makes room for its records, then writes them."""


def own(group: h5py.Group, name: str, kind: type) -> Any:
    """A member that lies in this file itself: no links or storage that lead elsewhere."""
    return own_stored(group, name, kind)[0]


def own_stored(group: h5py.Group, name: str, kind: type) -> tuple[Any, Storage]:
    """The same, with the room that it takes."""
    links, key = group.id.links, name.encode()
    if not links.exists(key) or links.get_info(key).type != h5py.h5l.TYPE_HARD:
        raise FileError(f"{group.file.filename}: {name!r} leads out of the file, which results never do")
    member, storage = group[name], Storage(0, 0, elsewhere=False)
    if not isinstance(member, kind):
        raise FileError(f"{group.file.filename}: {name!r} is not what a result holds there")
    if isinstance(member, h5py.Dataset):
        storage = Storage.of(member)
        if storage.elsewhere:
            raise FileError(f"{group.file.filename}: {name!r} leads out of the file, which results never do")
        check_stored(group, repr(name), storage)
    return member, storage


@dataclass(frozen=True, slots=True)
class Storage:
    """Bytes that a dataset claims to have and those that it takes in the file, and whether they lie in another file."""

    claimed: int
    stored: int
    elsewhere: bool

    @classmethod
    def of(cls, dataset: h5py.Dataset) -> Storage:
        place, made = dataset.id, dataset.id.get_create_plist()
        layout, size = made.get_layout(), place.get_type().get_size()
        packed = layout == h5py.h5d.CHUNKED and made.get_nfilters() > 0
        stored = place.get_num_chunks() * math.prod(made.get_chunk()) * size if packed else place.get_storage_size()
        elsewhere = layout == h5py.h5d.VIRTUAL or made.get_external_count() > 0
        return cls(place.get_space().get_simple_extent_npoints() * size, stored, elsewhere)


def check_stored(group: h5py.Group, name: str, *datasets: Storage) -> None:
    """A file must hold what it claims: values that were never written take no room in it, but much when they are read."""
    claimed, stored = sum(one.claimed for one in datasets), sum(one.stored for one in datasets)
    if claimed > SMALL + 2 * stored:
        raise FileError(
            f"{group.file.filename}: the file is damaged: {name} claims {claimed} bytes, but holds {stored}"
        )
