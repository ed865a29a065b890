"""Result files: HDF5, written while a run goes on, read field by field.

Schema ``trbdyn-result``, version 1:

- attributes of the root: ``schema``, ``schema_version``, ``trbdyn_version``, ``created``, ``run_id``, ``segment`` (its number),
  ``first_record`` (place of its first record in the run); as JSON ``geometry`` and ``meta`` (versions of the core and of
  SUNDIALS, instruction set, settings), whose texts and numbers are attributes too; all texts are UTF-8 bytes of fixed length
- ``/scene``: the whole scene as JSON text (a dataset, because attributes end at 64 kB)
- ``/fields/NAME``: one float64 dataset a recorded quantity, time first, with the attributes ``unit``, ``description``, ``group``,
  ``kind``, ``dims`` and ``index`` (its place in the record)
- ``/ending``: bytes of a JSON text with ``success``, ``message``, ``stats``, ``counters``, ``warnings`` and ``final_time``;
  empty until the run
  has ended
- ``/final_state``: the state vector at ``final_time``; empty until then
- ``/peaks/NAME``: peaks of the whole run, one record each, with the attributes of ``/fields``; empty until then; missing if
  no peaks are kept

A file is data: nothing in it is executed, and links or storage that lead out of the file are refused.

It is written in HDF5's SWMR mode (single writer, multiple readers): every object is made first, under another name, and the file
takes its place only then; from there on datasets only grow, in an order that leaves the file consistent at every instant. So
readers can follow a run live, and a killed run leaves a file that can be read, whenever the kill comes. Such a file keeps the
mark of a writer, which other programs refuse unless they open it in SWMR mode; `trbdyn.load` reads it as it is, and resuming
the run takes the mark away (`trbdyn.results.hdf5_marks`). It is never opened for writing again: a run that is resumed writes a
segment of its own, ``run.part1.h5``, ``run.part2.h5`` beside ``run.h5``, and `trbdyn.load` joins them by ``run_id`` and
``first_record``: where two hold a record, the later segment counts.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SCHEMA = "trbdyn-result"
SCHEMA_VERSION = 1

CHUNK_BYTES = 16384
"""Size aimed at for an HDF5 chunk where nobody knows how many records will come."""
BLOCK_ROWS = 256
"""Most rows of a chunk where it is known: a chunk that is not full is written again at each flush."""
BLOCK_BYTES = 8 << 20
"""Most bytes of the chunks of all fields together."""

PEAKS = "peaks"
"""The group of fields that are peaks of each record's interval."""

JSON_ATTRIBUTES = ("geometry", "meta")

LIBVER = ("v110", "v110")
"""Format of the file: the oldest that knows SWMR."""


@dataclass(slots=True)
class RunInfo:
    """What is known of a run besides its records.

    Attributes
    ----------
    scene : dict
        The scene as plain data.
    success : bool
        Whether the run reached its end.
    message : str
        How it ended, in a sentence.
    stats : dict
        Solver statistics: steps, rhs_evaluations, wall_s and others.
    counters : dict
        Evaluations of each effect.
    warnings : tuple of str
        What the watch over the run found, see `trbdyn.run.watch`.
    final_time : float
        Time of the final state, s.
    final_state : ndarray or None
        The state vector there.
    geometry : dict
        Derived geometry of the bearing, SI.
    meta : dict
        Versions, instruction set and settings.
    peaks : mapping of str to ndarray
        Peaks of the whole run (`trbdyn.results.peaks`); empty if none are known.
    """

    scene: dict[str, Any]
    success: bool = False
    message: str = ""
    stats: dict[str, Any] = field(default_factory=dict)
    counters: dict[str, int] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    final_time: float = float("nan")
    final_state: Array | None = None
    geometry: dict[str, float] = field(default_factory=dict)
    meta: dict[str, Any] = field(default_factory=dict)
    peaks: Mapping[str, Array] = field(default_factory=dict)


def _plain(value: Any) -> Any:
    """NumPy scalars and arrays as plain Python, for JSON."""
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"cannot write {type(value).__name__} as JSON")


def reason(error: BaseException) -> str:
    """Why HDF5 failed, in a few words."""
    text = str(error)
    if "file signature not found" in text:
        return "this is not an HDF5 file"
    if "unable to lock file" in text:
        return "the file is still open in another program"
    if isinstance(error, OSError) and error.errno == errno.EBUSY:
        return str(error.strerror)
    if "truncated file" in text:
        return "the file is cut short and cannot be read"
    if isinstance(error, OSError) and error.errno:
        return os.strerror(error.errno).lower()
    if isinstance(error, MemoryError):
        return "it takes more memory than there is"
    return text.splitlines()[0] if text else type(error).__name__


def json_text(value: Any) -> str:
    return json.dumps(value, default=_plain)


def stored(value: Any) -> Any:
    """Text as text of fixed length: HDF5 keeps what varies in length in a heap without a checksum, where damage makes it hang."""
    if not isinstance(value, str):
        return value
    data = value.encode()
    return np.array(data, dtype=f"S{max(len(data), 1)}")


def chunk_rows(shape: tuple[int, ...]) -> int:
    """Rows of a chunk of a field where nobody knows how many records will come."""
    return max(1, CHUNK_BYTES // (8 * max(1, int(np.prod(shape)))))


def block_rows(expected: int, record_bytes: int) -> int:
    """Rows of a chunk of every field, so that whole chunks of all fields are full at the same time.

    Parameters
    ----------
    expected : int
        Records that will come at most.
    record_bytes : int
        Bytes of a record.
    """
    return max(1, min(expected, BLOCK_ROWS, BLOCK_BYTES // max(1, record_bytes)))
