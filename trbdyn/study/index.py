"""The index of a study's folder: one line of JSON for each finished case, appended when it finishes.

A line holds ``name``, ``fingerprint``, ``parameters``, ``status`` ('done' or 'failed'), ``message``, ``file``, ``values`` (the
observables), ``wall_s``, ``finished`` (UTC), ``version``, and ``checksum``: the first 16 digits of the SHA-256 of the line
without it. The last line of a fingerprint counts. A line that was cut short by a crash, or has been damaged, is passed over with
a warning.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from trbdyn.errors import FileError

INDEX = "index.jsonl"


@dataclass(frozen=True)
class Entry:
    """How one case ended: a line of the index."""

    name: str
    fingerprint: str  # of scene and run options
    status: Literal["done", "failed"]
    message: str  # how it ended, in a sentence
    parameters: dict[str, Any] = field(default_factory=dict)  # what told it from the other cases
    file: str = ""  # its result file in the folder; empty if there is none
    values: dict[str, Any] = field(default_factory=dict)  # observables
    wall_s: float = 0.0  # wall time (s)
    finished: str = ""  # when, UTC
    version: str = ""  # of trbdyn


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
        entry = Entry(**values)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None
    return entry if _is_sound(entry) else None


def _checksum(values: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()[:16]


def _is_sound(entry: Entry) -> bool:
    """Whether every value of a line is of its kind."""
    texts = (entry.name, entry.fingerprint, entry.message, entry.file, entry.finished, entry.version)
    wall = entry.wall_s
    return (
        all(isinstance(text, str) for text in texts)
        and entry.status in ("done", "failed")
        and isinstance(entry.parameters, dict)
        and isinstance(entry.values, dict)
        and all(_is_observable(value) for value in entry.values.values())
        and isinstance(wall, int | float)
        and not isinstance(wall, bool)
        and abs(wall) < math.inf
        and (not entry.file or Path(entry.file).name == entry.file)
    )


def _is_observable(value: object) -> bool:
    """Whether a value is a number, a text, or an array of numbers that are lists in lists of equal lengths."""
    if value is None or isinstance(value, str | bool | int | float):
        return not isinstance(value, int) or abs(value) < 2**63
    try:
        return isinstance(value, list) and np.array(value, dtype=float).size >= 0
    except (ValueError, TypeError, OverflowError):
        return False
