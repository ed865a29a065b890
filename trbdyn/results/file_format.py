"""What a result file holds: HDF5, written while a run goes on, read field by field (docs/file_format.md has the schema).

A file is data: nothing in it is executed, and links or storage that lead out of the file are refused. `trbdyn.load` reads the
JSON texts in ``/run`` and neither attributes nor labels of axes, which are for other programs: HDF5 has no checksum for texts of
variable length.

A file is closed while records wait in memory. To add records it is opened in HDF5's SWMR mode (single writer, multiple readers),
which writes in an order that leaves the structure of the file sound at every instant; the number of records that count is written
last. A run that is killed in this moment leaves a file with HDF5's mark of a writer, which is read in SWMR mode.
"""

from __future__ import annotations

import errno
import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.results.fields import Field

Array = NDArray[np.float64]

SCHEMA = "trbdyn-result"
SCHEMA_VERSION = 2

ASSEMBLY = "assembly"
"""Dataset of the file of an assembly: JSON with schema, versions, the names of its bearings and their description."""
ASSEMBLY_SCHEMA = "trbdyn-assembly"
ASSEMBLY_VERSION = 1

BLOCK_ROWS = 512
"""Most rows of a chunk: what waits in memory is written in whole chunks where that is possible."""
BLOCK_BYTES = 8 << 20
"""Most bytes of the chunks of all fields together."""

SINGLE = ("contacts", "pocket", "torque", "power", "peaks")
"""Groups that are kept as float32, to 7 digits. Motion and energies, from which the others can be found again, are not."""

DIGITS = {"cage": 12, "rollers": 12, "ring": 12, "housing": 12, "peaks": 9}
"""Digits of the float64 numbers of a group, where it is not all: the bits of the others are zero, which packs better. A roller's
place to 12 digits is exact to less than a ten-thousandth of a nanometre; peaks keep nothing but times as float64."""

LIBVER = ("v110", "v110")
"""Format of the file: the oldest with checksums of all metadata, and the oldest that knows SWMR."""


@dataclass(slots=True)
class RunInfo:
    """What is known of a run besides its records, as `Result` describes it; `scene` as plain data, and `peaks` of the whole run
    (`trbdyn.results.peaks`), empty where none are known.
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


def stored_type(entry: Field) -> np.dtype[Any]:
    """Type of a field's numbers in a file; times are kept as float64."""
    return np.dtype("f4" if entry.group in SINGLE and entry.unit != "s" else "f8")


def as_kept(entry: Field, values: Array) -> NDArray[Any]:
    """A field's numbers as a file keeps them, with the type and the digits that it has there."""
    kind = stored_type(entry)
    digits = DIGITS.get(entry.group)
    if kind != np.float64 or digits is None:
        return values.astype(kind)
    dropped = 52 - math.ceil(digits * math.log2(10.0))
    bits = values.view(np.int64) + (1 << (dropped - 1)) & -(1 << dropped)
    return bits.view(np.float64)


def block_rows(expected: int | None, record_bytes: int) -> int:
    """Rows of a chunk of every field, so that whole chunks of all fields are full at the same time: for at most as many records
    as are expected (None: nobody knows), of some bytes each.
    """
    return max(1, min(expected or BLOCK_ROWS, BLOCK_ROWS, BLOCK_BYTES // max(1, record_bytes)))
