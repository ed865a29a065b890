"""Where a result reads its fields from: records in memory, or a window of another source; a file is `file_source`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.results.fields import Field

Array = NDArray[np.float64]


class Source:
    """Where a result reads its fields from: `fields` can be read, in the order of the record, of `n_records` records. What reads
    from a file says so; others have none.
    """

    fields: tuple[Field, ...]
    n_records: int

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it reads from."""
        return ()

    @property
    def is_part(self) -> bool:
        """Whether records of the run are left out."""
        return False

    def read(self, name: str) -> Array:
        """All records of one field, time first."""
        raise NotImplementedError

    def moved(self, path: Path) -> None:
        """The file that it reads from has another name now."""

    def held_open(self) -> AbstractContextManager[None]:
        """Opens its file once for all that is read inside."""
        return nullcontext()


class RecordsSource(Source):
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


class WindowSource(Source):
    """Part of another source: some of its fields, and the records from `start` to `stop`."""

    def __init__(self, source: Source, fields: tuple[Field, ...], start: int, stop: int) -> None:
        self.fields, self.n_records = fields, stop - start
        self._source, self._rows = source, slice(start, stop)

    def read(self, name: str) -> Array:
        """All records of one field within the window, time first."""
        return self._source.read(name)[self._rows]

    @property
    def is_part(self) -> bool:
        """Whether records of the run are left out."""
        return self.n_records < self._source.n_records or self._source.is_part

    @property
    def files(self) -> tuple[Path, ...]:
        """The files of the other source."""
        return self._source.files

    def moved(self, path: Path) -> None:
        """The file of the other source has another name now."""
        self._source.moved(path)

    def held_open(self) -> AbstractContextManager[None]:
        """Opens the file of the other source."""
        return self._source.held_open()


def files_of(result: Any) -> list[Path]:
    """The files that a result, or results by name, or None, is read from."""
    parts = result.values() if isinstance(result, Mapping) else [result]
    return [path for part in parts if hasattr(part, "_source") for path in part._source.files]
