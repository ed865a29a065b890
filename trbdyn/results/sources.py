"""Where a result reads its fields from: arrays in memory, or a window of another source; a file is `file_source`."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from trbdyn.results.fields import Field

Array = NDArray[np.float64]


class Source(Protocol):
    """Where a result reads its fields from."""

    @property
    def fields(self) -> tuple[Field, ...]:
        """The fields that can be read, in the order of the record."""

    @property
    def n_records(self) -> int:
        """Number of records."""

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it reads from."""

    def read(self, name: str) -> Array:
        """All records of one field, time first."""

    def moved(self, path: Path) -> None:
        """The file that it reads from has another name now."""

    def held_open(self) -> AbstractContextManager[None]:
        """Opens its file once for all that is read inside."""


class WithoutFile:
    """What a source answers that reads from no file."""

    __slots__ = ()

    @property
    def files(self) -> tuple[Path, ...]:
        """There are none."""
        return ()

    def moved(self, path: Path) -> None:
        """There is no file."""

    def held_open(self) -> AbstractContextManager[None]:
        """There is nothing to open."""
        return nullcontext()


@dataclass(frozen=True, slots=True)
class MemorySource(WithoutFile):
    """Fields as arrays in memory."""

    fields: tuple[Field, ...]
    n_records: int
    arrays: Mapping[str, Array]

    def read(self, name: str) -> Array:
        """All records of one field, time first."""
        return self.arrays[name]


@dataclass(frozen=True, slots=True)
class WindowSource:
    """Part of another source: some of its fields, and the records from `start` to `stop`."""

    source: Source
    fields: tuple[Field, ...]
    start: int
    stop: int

    @property
    def n_records(self) -> int:
        """Number of records."""
        return self.stop - self.start

    def read(self, name: str) -> Array:
        """All records of one field within the window, time first."""
        return self.source.read(name)[self.start : self.stop]

    @property
    def files(self) -> tuple[Path, ...]:
        """The files of the other source."""
        return self.source.files

    def moved(self, path: Path) -> None:
        """The file of the other source has another name now."""
        self.source.moved(path)

    def held_open(self) -> AbstractContextManager[None]:
        """Opens the file of the other source."""
        return self.source.held_open()


def files_of(result: Any) -> list[Path]:
    """The files that a result, or results by name, or None, is read from."""
    parts = result.values() if isinstance(result, Mapping) else [result]
    return [path for part in parts if hasattr(part, "_source") for path in part._source.files]
