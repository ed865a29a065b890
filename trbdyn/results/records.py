"""Records in memory as a run leaves them: row after row, in pieces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from trbdyn.results.fields import Field
from trbdyn.results.sources import WithoutFile

Array = NDArray[np.float64]


class RecordsSource(WithoutFile):
    """Fields within pieces of records, each of shape (n, length), in their order; they are kept, and must not change. `places`
    says where each field is in a record: offset and shape.

    The array of a field is put together when it is first read: most results are asked for a few of their hundred quantities,
    and all of them would cost a tenth of a run's time and twice its memory.
    """

    def __init__(
        self, pieces: Sequence[Array], fields: tuple[Field, ...], places: Mapping[str, tuple[int, tuple[int, ...]]]
    ) -> None:
        self.fields = fields
        self.n_records = sum(len(piece) for piece in pieces)
        self._pieces = tuple(pieces)
        self._places = {field.name: places[field.name] for field in fields}
        self._arrays: dict[str, Array] = {}

    def read(self, name: str) -> Array:
        """All records of one field, time first."""
        pieces = self._pieces  # first: another thread may let go of them below
        if name not in self._arrays:
            offset, shape = self._places[name]
            end = offset + int(np.prod(shape))
            columns = [piece[:, offset:end] for piece in pieces]
            values = (np.concatenate(columns) if columns else np.empty((0, end - offset))).reshape(-1, *shape)
            values.flags.writeable = False
            self._arrays[name] = values
            if len(self._arrays) == len(self.fields):
                self._pieces = ()
        return self._arrays[name]
