"""Records that wait in memory until a result file takes them."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class WaitingRows:
    """Records in the order in which they came, given away all at once or in whole blocks.

    A result file keeps the records in chunks. A chunk that is written whole costs one write; one that is written in parts is
    looked up again each time. While nothing presses, only whole blocks of records are therefore given away.
    """

    def __init__(self, block: int) -> None:
        self._block = block
        self._pieces: list[Array] = []
        self._n_taken = 0
        self._taken_at = time.monotonic()
        self.nbytes = 0
        """Bytes that wait."""

    @property
    def seconds(self) -> float:
        """Wall time since records were last given away (s)."""
        return time.monotonic() - self._taken_at

    def append(self, rows: Array) -> None:
        """Add records, which are not copied."""
        self._pieces.append(rows)
        self.nbytes += rows.nbytes

    def take(self, *, whole_blocks: bool = False) -> list[Array]:
        """Give away what waits, in order; or only whole blocks, counted from the first record of all, while the rest goes on
        waiting.
        """
        taken, self._pieces = self._pieces, []
        count = sum(map(len, taken))
        left = (self._n_taken + count) % self._block if whole_blocks else 0
        left = min(left, count)
        self._n_taken += count - left
        while left:
            piece = taken.pop()
            if len(piece) > left:
                taken.append(piece[:-left])
            self._pieces.insert(0, piece[-left:])
            left -= len(self._pieces[0])
        self.nbytes = sum(piece.nbytes for piece in self._pieces)
        if taken:
            self._taken_at = time.monotonic()
        return taken
