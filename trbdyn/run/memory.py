"""Records of a run that stay in memory: the run ends before they fill it, and they are joined piece by piece."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

if sys.platform != "win32":
    import resource

Array = NDArray[np.float64]

LOOK_EVERY: Final = 64 << 20
"""Bytes of records between looks at the memory that is free."""
RESERVE: Final = 512 << 20
"""Memory that a run leaves to everything else (byte)."""
_MEMINFO: Final = Path("/proc/meminfo")
_GROUPS: Final = (
    (Path("/sys/fs/cgroup"), "memory.max", "memory.current", "inactive_file"),
    (Path("/sys/fs/cgroup/memory"), "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
)
"""What a container may take, in both versions of Linux control groups: folder; files of the limit and of what is taken; the name
in ``memory.stat`` of files that make room when they must."""


def available() -> int | None:
    """Memory that this process can still take without swapping: of the machine, and within the limits that a container or
    ``ulimit -v`` sets (byte); None where the system does not tell.
    """
    found = [_of_machine(), *(_of_group(*names) for names in _GROUPS), _of_process()]
    return min((free for free in found if free is not None), default=None)


def _of_machine() -> int | None:
    kilobytes = _entries(_MEMINFO).get("MemAvailable:")
    return None if kilobytes is None else 1024 * kilobytes


def _of_group(folder: Path, limit: str, taken: str, files: str) -> int | None:
    try:
        most, now = ((folder / name).read_text(encoding="ascii").strip() for name in (limit, taken))
    except OSError:
        return None
    if most == "max":
        return None
    return int(most) - int(now) + _entries(folder / "memory.stat").get(files, 0)


def _of_process() -> int | None:
    if sys.platform == "win32":
        return None
    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    size = next(iter(_entries(Path("/proc/self/statm"))), None)
    if most == resource.RLIM_INFINITY or size is None:
        return None
    return most - int(size) * resource.getpagesize()


def _entries(path: Path) -> dict[str, int]:
    """The first two words of each line; none where there is no such file."""
    try:
        lines = [line.split() for line in path.read_text(encoding="ascii").splitlines()]
    except OSError:
        return {}
    return {words[0]: int(words[1]) for words in lines if len(words) > 1}


class Kept:
    """Records in memory, a piece at a time.

    Attributes
    ----------
    width : int
        Length of a record.
    size : int
        Bytes so far.
    """

    def __init__(self, width: int) -> None:
        self.width = width
        self.size = 0
        self._pieces: list[Array] = []
        self._looked = 0

    def append(self, records: Array) -> None:
        self._pieces.append(records)
        self.size += records.nbytes

    def is_full(self) -> bool:
        """Whether there is room for no more of them and for the result, which has a copy; looks only now and then."""
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

    def joined(self) -> Array:
        """All records so far in one array, shape (records, width); pieces are let go one by one while they are copied."""
        if len(self._pieces) != 1:
            whole, done = np.empty((sum(len(piece) for piece in self._pieces), self.width)), 0
            self._pieces.reverse()
            while self._pieces:
                piece = self._pieces.pop()
                whole[done : done + len(piece)] = piece
                done += len(piece)
            self._pieces = [whole]
        return self._pieces[0]
