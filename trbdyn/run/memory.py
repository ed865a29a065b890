"""Records of a run that stay in memory: the run ends before they fill it, and what is not kept of them takes no room."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.results.fields import Field, Layout
from trbdyn.results.sources import RecordsSource

Array = NDArray[np.float64]

LOOK_EVERY: Final = 64 << 20
"""Bytes of records between looks at the memory that is free."""
RESERVE: Final = 512 << 20
"""Memory that a run leaves to everything else (byte)."""
_OWN_GROUPS: Final = Path("/proc/self/cgroup")
_GROUPS: Final = (
    ("", Path("/sys/fs/cgroup"), "memory.max", "memory.current", "inactive_file"),
    (
        "memory",
        Path("/sys/fs/cgroup/memory"),
        "memory.limit_in_bytes",
        "memory.usage_in_bytes",
        "total_inactive_file",
    ),
)
"""Limits of Linux control groups, as containers and services have them, in both versions: the controller in `_OWN_GROUPS`;
folder; files of the limit and of what is taken; the name in ``memory.stat`` of files that make room when they must."""


def available() -> int | None:
    """Memory that this process can still take without swapping: of the machine, and within the limits that a container or
    ``ulimit -v`` sets (byte); None where the system does not tell.
    """
    found = [_of_machine(), _of_process()]
    for controller, folder, *names in _GROUPS:
        found += [_of_group(one, *names) for one in _own_groups(controller, folder)]
    return min((free for free in found if free is not None), default=None)


def _of_machine() -> int | None:
    import psutil

    try:
        return int(psutil.virtual_memory().available)
    except (OSError, psutil.Error):
        return None


def _own_groups(controller: str, folder: Path) -> list[Path]:
    """Folders of the group that this process is in and of the groups around it: each may have a limit of its own.

    In a container the outermost folder is the container's own group, and the path of the process may not be there.
    """
    try:
        lines = [line.split(":", 2) for line in _OWN_GROUPS.read_text(encoding="utf-8").splitlines()]
    except OSError:
        lines = []
    own = [Path(words[2].strip("/")) for words in lines if len(words) == 3 and controller in words[1].split(",")]
    return [folder, *(folder / group for path in own for group in (path, *path.parents) if group != Path())]


def _of_group(folder: Path, limit: str, taken: str, files: str) -> int | None:
    try:
        most, now = (int((folder / name).read_text(encoding="ascii")) for name in (limit, taken))
    except (OSError, ValueError):  # no such group, or "max": no limit
        return None
    return most - now + _entries(folder / "memory.stat").get(files, 0)


def _of_process() -> int | None:
    import psutil

    process = psutil.Process()
    try:
        most, _ = process.rlimit(psutil.RLIMIT_AS)
        return None if most == psutil.RLIM_INFINITY else most - int(process.memory_info().vms)
    except (AttributeError, OSError, psutil.Error):  # only Linux has it
        return None


def _entries(path: Path) -> dict[str, int]:
    """The first two words of each line; none where there is no such file."""
    try:
        lines = [line.split() for line in path.read_text(encoding="ascii").splitlines()]
    except OSError:
        return {}
    return {words[0]: int(words[1]) for words in lines if len(words) > 1 and words[1].isdecimal()}


class Kept:
    """Records in memory, a piece at a time, as far as a run keeps their fields; `size` is what they take so far (byte)."""

    def __init__(self, layout: Layout, fields: Sequence[Field]) -> None:
        self.size = 0
        places = {name: (offset, shape) for name, offset, shape in layout}
        self.fields = tuple(field for field in fields if field.name in places)
        self._places: dict[str, tuple[int, tuple[int, ...]]] = {}
        self._columns: list[slice] = []
        """Where the fields are in a full record; in a record that is kept they follow each other."""
        width = 0
        for field in self.fields:
            offset, shape = places[field.name]
            count = math.prod(shape)
            self._places[field.name] = (width, tuple(shape))
            self._columns.append(slice(offset, offset + count))
            width += count
        self._whole = width == max((offset + math.prod(shape) for offset, shape in places.values()), default=0)
        if self._whole:
            self._places = {field.name: places[field.name] for field in self.fields}
        self._pieces: list[Array] = []
        self._looked = 0

    def append(self, records: Array) -> None:
        """Add full records; they are kept as they are, and must not change, unless fields are left out."""
        kept = records if self._whole else np.hstack([records[:, place] for place in self._columns])
        self._pieces.append(kept)
        self.size += kept.nbytes

    def is_full(self) -> bool:
        """Whether there is room for no more of them and for the arrays that are read from them; looks only now and then."""
        if self.size - self._looked < LOOK_EVERY:
            return False
        self._looked = self.size
        free = available()
        return free is not None and free < RESERVE + self.size

    def said(self, time: float) -> str:
        """Why a run ends that has no more room at a time (s)."""
        return (
            f"the memory is nearly full at {time:.6g} s: the records so far take {self.size / 1e9:.3g} GB; "
            "write them to a file (output=...), make fewer (save_every=...) or keep fewer groups (save_groups=...)"
        )

    def source(self) -> RecordsSource:
        """The records so far, to read fields from."""
        return RecordsSource(self._pieces, self.fields, self._places)
