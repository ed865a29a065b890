"""Records of a run that stay in memory: the run ends before they fill it, and they are joined piece by piece."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LOOK_EVERY: Final = 64 << 20
"""Bytes of records between looks at the memory that is free."""
RESERVE: Final = 512 << 20
"""Memory that a run leaves to everything else (byte)."""
_MEMINFO: Final = Path("/proc/meminfo")


def available() -> int | None:
    """Memory that programs can still take without swapping (byte); None where the system does not tell."""
    try:
        lines = _MEMINFO.read_text(encoding="ascii").splitlines()
    except OSError:
        return None
    found = next((line.split() for line in lines if line.startswith("MemAvailable:")), None)
    return int(found[1]) * 1024 if found else None


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
