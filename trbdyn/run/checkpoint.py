"""Checkpoints: states from which a run can go on, each in a small file.

A run with a schedule (`checkpoint_every`) starts its integrator again at the first step that ends at or after each multiple of
that time, whether or not anybody resumes it. So a run that goes on from a checkpoint, in another process, takes the same steps
as one that was never interrupted: to the last bit, on the same build and instruction set.

The file ``run.h5.checkpoint`` beside ``run.h5``, format version 4: a line that names the format and its version; the SHA-256 of
all that follows; a line of JSON; the state vector and the peaks so far as little-endian float64. It is written under another
name, synchronised to the disk and then renamed; the one before it stays as ``run.h5.checkpoint.previous``. Nothing in it is
executed.

A checkpoint names its run. Only files that name the same run are replaced or removed.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn import _core
from trbdyn.base.own_files import create_draft, fill, set_aside
from trbdyn.errors import FileError, InputError

Array = NDArray[np.float64]

MAGIC = b"trbdyn-checkpoint"
VERSION = 4

LARGEST = 64 << 20
"""Size of a file beyond which it is no checkpoint (bytes)."""


_NUMBERS = ("state", "peaks")
"""What is written as numbers, after the line of JSON."""


def build_digest() -> str:
    """SHA-256 of the compiled core: results are bit-identical only within one build."""
    return hashlib.sha256(Path(_core.__file__).read_bytes()).hexdigest()


def digest_of(values: ArrayLike) -> str:
    """SHA-256 of an array's numbers."""
    return hashlib.sha256(np.ascontiguousarray(values, dtype="<f8").tobytes()).hexdigest()


@dataclass(frozen=True)
class Checkpoint:
    """What a run needs to go on.

    The scene or assembly and the options are plain data; `model`, `build` and `motion` are digests of the scene, the compiled
    core and the prescribed motion of the rings. The run goes from `start` to `end` (s). At `time` (s) it had made `done` records,
    in a wall time of stepping of `stepping_s` (s). What the integrator and the effects had done, and what the watch had found, is
    that of by then, and so are the state, shape (n_state,), and the peaks, as the core saves them, empty if the run keeps none.
    Of a run whose callback gives inputs, `control` has those in force and the numbers that the callback keeps.
    """

    run_id: str
    scene: dict[str, Any]
    model: str
    options: dict[str, Any]
    instruction_set: str
    build: str
    motion: str
    start: float
    end: float
    time: float
    done: int
    statistics: dict[str, float]
    counters: dict[str, int]
    stepping_s: float
    state: Array = field(repr=False)
    peaks: Array = field(repr=False)
    warnings: list[str] = field(default_factory=list)
    control: dict[str, Any] | None = None

    def to_bytes(self) -> bytes:
        """The file's content."""
        head = {entry.name: getattr(self, entry.name) for entry in fields(self) if entry.name not in _NUMBERS}
        head["n_state"] = self.state.size
        numbers = np.concatenate([self.state, self.peaks]).astype("<f8").tobytes()
        body = json.dumps(head, allow_nan=False).encode() + b"\n" + numbers
        return b"%s %d\n%s\n" % (MAGIC, VERSION, hashlib.sha256(body).hexdigest().encode()) + body

    @classmethod
    def from_bytes(cls, data: bytes) -> Self:
        """The checkpoint that `to_bytes` wrote; a ValueError that says why if the content is anything else."""
        first, _, rest = data.partition(b"\n")
        name, _, version = first.partition(b" ")
        if name != MAGIC:
            raise ValueError("this is not a checkpoint of trbdyn" if data else "the file is empty")
        if version != b"%d" % VERSION:
            raise ValueError(f"written with format version {version[:20].decode(errors='replace')}, not {VERSION}")
        digest, _, body = rest.partition(b"\n")
        if hashlib.sha256(body).hexdigest().encode() != digest:
            raise ValueError("the file is damaged or cut short: its checksum does not fit")
        head, newline, numbers = body.partition(b"\n")
        if not newline or len(numbers) % 8:
            raise ValueError("the state vector is cut short")
        values = json.loads(head)
        if not isinstance(values, dict):
            raise ValueError("its table of values is missing")
        vector, length = np.frombuffer(numbers, dtype="<f8").astype(np.float64), values.pop("n_state", None)
        if not isinstance(length, int) or not 0 < length <= vector.size:
            raise ValueError("the state vector is cut short")
        values["state"], values["peaks"] = vector[:length], vector[length:]
        names = {entry.name for entry in fields(cls)}
        if values.keys() != names:
            raise ValueError(f"entries missing or unknown: {', '.join(sorted(values.keys() ^ names))}")
        found = cls(**values)
        found._check()
        return found

    def _check(self) -> None:
        kinds: dict[str, type | tuple[type, ...]] = {
            **dict.fromkeys(("run_id", "model", "instruction_set", "build", "motion"), str),
            **dict.fromkeys(("scene", "options", "statistics", "counters"), dict),
            **dict.fromkeys(("start", "end", "time", "stepping_s"), (int, float)),
            "done": int,
        }
        for name, kind in kinds.items():
            value = getattr(self, name)
            if not isinstance(value, kind) or isinstance(value, bool):
                raise ValueError(f"{name} is not what a checkpoint holds there")
        for table in (self.statistics, self.counters):
            if not all(isinstance(value, int | float) and math.isfinite(value) for value in table.values()):
                raise ValueError("its counts are not numbers")
        if not (math.isfinite(self.time) and math.isfinite(self.start) and self.start < self.end < math.inf):
            raise ValueError("its times are not in order")
        if self.done < 0 or not np.isfinite(self.state).all():
            raise ValueError("its state is not finite")
        if not isinstance(self.warnings, list) or not all(isinstance(text, str) for text in self.warnings):
            raise ValueError("its warnings are not texts")
        if np.isnan(self.peaks).any():
            raise ValueError("its peaks are not numbers")
        if self.control is not None and (
            not isinstance(self.control, dict) or self.control.keys() != {"inputs", "memory"}
        ):
            raise ValueError("its inputs are not what a checkpoint holds there")


def next_time(after: float, every: float | None) -> float:
    """The first multiple of a time that lies after another time (s); infinite without a schedule."""
    if every is None:
        return math.inf
    count = math.floor(after / every)
    while count * every <= after:
        count += 1
    return count * every


def checkpoint_path(output: str | os.PathLike[str]) -> Path:
    """The checkpoint file of a run that writes to a result file."""
    path = Path(output)
    return path.with_name(path.name + ".checkpoint")


def previous_path(path: Path) -> Path:
    """The checkpoint before it."""
    return path.with_name(path.name + ".previous")


def _both(output: str | os.PathLike[str]) -> tuple[Path, Path]:
    """The two checkpoint files of a run, the newest one first."""
    newest = checkpoint_path(output)
    return newest, previous_path(newest)


def write(path: Path, checkpoint: Checkpoint) -> None:
    """Write a checkpoint; the one that was there becomes the previous one. Killed at any instant, one of them stays whole. A
    FileError, which leaves those that were there, if it cannot be written, or that of another run lies there.
    """
    older = previous_path(path)
    try:
        draft, locked = create_draft(path, checkpoint.run_id)
        try:
            with locked:
                fill(draft, checkpoint.to_bytes())
                whole = _belongs(path, checkpoint.run_id)
                # the older one is kept where the newer one is damaged
                if whole and (_belongs(older, checkpoint.run_id) or not older.exists()):
                    os.replace(path, older)
                os.replace(draft, path)
        except BaseException:
            draft.unlink(missing_ok=True)
            raise
        _sync_folder(path.parent)
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{path}: the checkpoint cannot be written: {error.strerror or error}") from error


def _belongs(path: Path, run_id: str) -> bool:
    """Whether a checkpoint of this run is at a path; a damaged file, which says nothing of its run, is moved aside. A FileError
    if it belongs to another run, or is no file.
    """
    if not os.path.lexists(path):
        return False
    if path.is_symlink() or not path.is_file():
        raise FileError(f"{path}: the checkpoint cannot be written: something else has its name")
    try:
        found = read(path)
    except FileError:
        set_aside(path)
        return False
    if found.run_id != run_id:
        raise FileError(f"{path}: the checkpoint cannot be written: that of another run lies there")
    return True


def check_free(output: Path, replaced: str | None, *, overwrite: bool) -> None:
    """See that a new run with a schedule may write its checkpoints beside its result file; a FileError if a file lies there
    that must not be replaced. Those of the run whose result it replaces may be, and with `overwrite` those of any run.
    """
    for place in _both(output):
        if not os.path.lexists(place):
            continue
        regular = place.is_file() and not place.is_symlink()
        if not regular or place.read_bytes()[: len(MAGIC)] not in (MAGIC, b""):
            raise FileError(f"{place}: this is not a checkpoint, and a run of that name would replace it")
        owner = run_id_of(place)
        if not overwrite and (owner is None or owner != replaced):
            raise FileError(
                f"{place}: a checkpoint of another run lies there; resume that run, give another name, or overwrite=True "
                "(--overwrite on the command line) to replace it"
            )


def run_id_of(path: Path) -> str | None:
    """Name of the run that a checkpoint belongs to; None if it is missing or damaged."""
    try:
        return read(path).run_id
    except FileError:
        return None


def _sync_folder(folder: Path) -> None:
    if not hasattr(os, "O_DIRECTORY"):
        return  # Windows puts names on the disk itself
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def remove(output: str | os.PathLike[str], run_id: str) -> None:
    """Remove the checkpoints of a run; those of others, and files that do not say whose they are, stay."""
    for place in _both(output):
        if run_id_of(place) == run_id:
            place.unlink(missing_ok=True)


def clear(output: Path) -> None:
    """Remove every checkpoint that `check_free` has let pass."""
    for place in _both(output):
        place.unlink(missing_ok=True)


def read(path: Path) -> Checkpoint:
    """One checkpoint file; a FileError that says why if it is missing, damaged or of another kind."""
    try:
        if not path.is_file() and path.exists():
            raise ValueError("it is not a regular file")
        with path.open("rb") as stream:
            data = stream.read(LARGEST + 1)
        if len(data) > LARGEST:
            raise ValueError("this is not a checkpoint of trbdyn: the file is too large")
        return Checkpoint.from_bytes(data)
    except FileNotFoundError:
        raise FileError(f"{path}: there is no such file") from None
    except OSError as error:
        raise FileError(f"{path}: the checkpoint cannot be read: {error.strerror or error}") from error
    except (ValueError, TypeError, KeyError, RecursionError, OverflowError) as error:
        raise FileError(f"{path}: the checkpoint cannot be used: {error}") from error


def read_last_good(output: str | os.PathLike[str], tell: Callable[[str], None]) -> Checkpoint:
    """The newest checkpoint of a run that can be used, beside its result file. `tell` is told, in a sentence, if that is not
    the newest one. If there is none, a FileError says why of each.
    """
    troubles: list[str] = []
    for path in _both(output):
        try:
            found = read(path)
        except FileError as error:
            troubles.append(str(error))
            continue
        if troubles:
            tell(f"{troubles[0]}; going on from the one before it, at t = {found.time:.9g} s")
        return found
    if not any(path.exists() for path in _both(output)):
        why = "the run had no schedule of checkpoints, or is complete"
        raise FileError(f"{checkpoint_path(output)}: there is no such file: {why}")
    raise FileError("; ".join(troubles))


def check_instruction_set(checkpoint: Checkpoint, wanted: str | None, tell: Callable[[str], None]) -> str:
    """The kernel variant to go on with: the one that is wanted, by default that of the checkpoint. `tell` is told, in a
    sentence, if the results will not be bit-identical; an InputError if this machine cannot run it.
    """
    here = _core.instruction_sets()
    was, names = checkpoint.instruction_set, ", ".join(here)
    if wanted is not None and wanted not in here:
        raise InputError.of("instruction_set", wanted, f"must be one of those that this machine runs: {names}")
    if wanted is None and was not in here:
        allowed = f"this machine runs {names} only; name one of them to go on with results that differ in rounding"
        raise InputError.of("instruction_set", was, f"was in use when the checkpoint was written; {allowed}")
    if wanted is not None and wanted != was:
        tell(
            f"going on with instruction set {wanted} instead of {was}: results are not bit-identical to the uninterrupted run"
        )
    return wanted or was
