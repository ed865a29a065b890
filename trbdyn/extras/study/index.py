"""The index of a study's folder: one line of JSON for each finished case, appended when it finishes.

A line holds ``name``, ``fingerprint``, ``parameters``, ``status`` ('done' or 'failed'), ``message``, ``file``, ``values`` (the
observables), ``wall_s``, ``finished`` (UTC), ``version``, and ``checksum``: the first 16 digits of the SHA-256 of the line
without it. The last line of a fingerprint counts. A line that was cut short by a crash, or has been damaged, is passed over with
a warning.
"""

from __future__ import annotations

import hashlib
import json
import os
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Literal

import numpy as np
from pydantic import AfterValidator, ConfigDict, FiniteFloat, TypeAdapter

from trbdyn.errors import FileError

INDEX = "index.jsonl"


def _name_of_file(text: str) -> str:
    if text and Path(text).name != text:
        raise ValueError("must be a name without folders")
    return text


def _observable(value: Any) -> Any:
    """A number, a text, or an array of numbers that are lists in lists of equal lengths."""
    if value is None or isinstance(value, str | float):
        return value
    if np.array(value).dtype.kind not in "bif":
        raise ValueError("must be a number, a text or an array of numbers")
    return value


@dataclass(frozen=True)
class Entry:
    """How one case ended: a line of the index."""

    __pydantic_config__: ClassVar = ConfigDict(strict=True, extra="forbid")

    name: str
    fingerprint: str  # of scene and run options
    status: Literal["done", "failed"]
    message: str  # how it ended, in a sentence
    parameters: dict[str, Any] = field(default_factory=dict)  # what told it from the other cases
    file: Annotated[str, AfterValidator(_name_of_file)] = ""  # its result file in the folder; empty if there is none
    values: dict[str, Annotated[Any, AfterValidator(_observable)]] = field(default_factory=dict)  # observables
    wall_s: FiniteFloat = 0.0  # wall time (s)
    finished: str = ""  # when, UTC
    version: str = ""  # of trbdyn


_ENTRY: Final = TypeAdapter(Entry)


class Index:
    """The index of a folder, which is made if it is missing; without a folder the entries are in memory only."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self.entries: dict[str, Entry] = {}
        if folder is None:
            return
        try:
            folder.mkdir(parents=True, exist_ok=True)
            for entry in read_lines(folder / INDEX):
                self.entries[entry.fingerprint] = entry
        except OSError as error:
            raise FileError(f"{folder}: the folder cannot be used: {error.strerror or error}") from error

    def add(self, entry: Entry) -> None:
        """Add an entry, on disk too."""
        self.entries[entry.fingerprint] = entry
        if self.folder is None:
            return
        path = self.folder / INDEX
        try:
            with path.open("ab+") as stream:
                stream.seek(0, os.SEEK_END)
                if stream.tell() and _last_byte(path) != b"\n":
                    stream.write(b"\n")
                values = asdict(entry)
                line = json.dumps(values | {"checksum": _checksum(values)}, allow_nan=False)
                stream.write(line.encode() + b"\n")
                stream.flush()
                os.fsync(stream.fileno())
        except OSError as error:
            raise FileError(f"{path}: the index cannot be written: {error.strerror or error}") from error

    def done(self, fingerprint: str) -> bool:
        """Whether a case is done, and its file still there."""
        entry = self.entries.get(fingerprint)
        if entry is None or entry.status != "done":
            return False
        return self.folder is None or not entry.file or (self.folder / entry.file).is_file()


def _last_byte(path: Path) -> bytes:
    with path.open("rb") as stream:
        stream.seek(-1, os.SEEK_END)
        return stream.read(1)


def read_lines(path: Path) -> Iterator[Entry]:
    """Entries of an index file, in the order in which they were written. Damaged lines are passed over with a warning: their
    cases count as not run.
    """
    if not path.is_file():
        return
    with path.open("rb") as stream:
        for number, line in enumerate(stream, start=1):
            entry = _entry_in(line)
            if entry is not None:
                yield entry
            elif line.strip():
                text = f"{path}: line {number} is damaged or cut short and is passed over; its case counts as not run"
                warnings.warn(text, UserWarning, stacklevel=2)


def _entry_in(line: bytes) -> Entry | None:
    try:
        values = json.loads(line)
        if values.pop("checksum") != _checksum(values):
            return None
        return _ENTRY.validate_json(json.dumps(values))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None


def _checksum(values: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()[:16]
