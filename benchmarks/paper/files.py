"""A point's file: a result file of the statistics, with the history before it in a group of its own.

Beside what every result file holds (`trbdyn.results.file_format`) there are ``/history``: the fields `HISTORY` at the coarse
interval, ``state`` and its time ``reached``, from which the point can go on; and the attribute ``paper``: JSON of what was run
and whether it has settled. Readers of results see the statistics only.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import FileError

if TYPE_CHECKING:
    from trbdyn.results.result import Result
    from trbdyn.run.simulation import State

Array = NDArray[np.float64]

HISTORY: Final = ("time", "shaft_angle", "cage_position", "cage_tilt", "cage_angle", "roller_orbit_angle")
"""Fields of the history."""

OMITTED: Final = ("roller_position", "roller_orientation", "roller_velocity", "roller_angular_velocity")
"""Fields that a point's file leaves out: they follow from the others, and would be half of it."""


@dataclass(frozen=True)
class History:
    """What came before the statistics.

    Attributes
    ----------
    fields : dict of str to ndarray, shape (T, ...)
        The fields `HISTORY`.
    reached : float
        Time of the state (s).
    state : ndarray, shape (n_state,)
        State of the simulation there.
    wall : float
        Wall time spent (s).
    """

    fields: dict[str, Array]
    reached: float
    state: Array
    wall: float

    def __getitem__(self, name: str) -> Array:
        return self.fields[name]

    @property
    def end(self) -> float:
        """Time of the last record (s); zero without any."""
        return float(self.fields["time"][-1]) if self.fields else 0.0

    def extended(self, result: Result, state: State, wall: float) -> History:
        """The history with the records of another segment, but its first, where the last segment ended."""
        new = {name: np.array(result[name]) for name in HISTORY}
        if self.fields:
            new = {name: np.concatenate([self.fields[name], values[1:]]) for name, values in new.items()}
        return History(new, state.time, state.vector, self.wall + wall)


@dataclass(frozen=True)
class Finished:
    """What a finished point says of itself."""

    settled: bool
    time: float


def write_progress(path: Path, history: History, fingerprint: str) -> None:
    """Save what a point has reached; the file is either the old one or the whole new one.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    part = path.with_name(f"{path.name}.part")
    try:
        part.unlink(missing_ok=True)
        with h5py.File(part, "x") as file:
            file.attrs["fingerprint"] = fingerprint
            _put(file, history)
        part.replace(path)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error}") from error


def _put(file: h5py.File, history: History) -> None:
    group = file.create_group("history")
    group.attrs.update({"reached": history.reached, "wall_s": history.wall})
    for name, values in history.fields.items():
        group.create_dataset(name, data=values, compression="gzip", shuffle=True)
    group["state"] = history.state


def read_history(path: Path, fingerprint: str | None = None) -> History | None:
    """The history in a file; None if there is no such file, or it is damaged or of another point.

    Parameters
    ----------
    path : Path
        A point's file, or one of its progress.
    fingerprint : str, optional
        What the file must be of.
    """
    try:
        with h5py.File(path, "r") as file:
            if fingerprint is not None and file.attrs["fingerprint"] != fingerprint:
                return None
            group = file["history"]
            fields = {name: np.asarray(group[name][()], dtype=float) for name in HISTORY}
            state = np.asarray(group["state"][()], dtype=float)
            return History(fields, float(group.attrs["reached"]), state, float(group.attrs["wall_s"]))
    except (OSError, KeyError, ValueError, TypeError, RuntimeError):
        return None


def read_about(path: Path) -> dict[str, Any] | None:
    """What a point's file says of itself; None if there is none, or it is damaged."""
    try:
        with h5py.File(path, "r") as file:
            about: dict[str, Any] = json.loads(file.attrs["paper"])
            return about | {"fingerprint": str(file.attrs["fingerprint"])}
    except (OSError, KeyError, ValueError, RuntimeError):
        return None


def is_finished(path: Path, fingerprint: str) -> Finished | None:
    """Whether a point's file is whole and of this fingerprint."""
    about = read_about(path)
    if about is None or about["fingerprint"] != fingerprint:
        return None
    history = read_history(path)
    return None if history is None else Finished(bool(about["settled"]), history.end)


def write_point(path: Path, result: Result, history: History, about: Mapping[str, Any], fingerprint: str) -> None:
    """Write a point's file; it appears when it is whole.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    from trbdyn.results.hdf5_file import Part
    from trbdyn.results.result_file import ResultWriter

    fields = [entry for entry in result.fields if entry.name not in OMITTED]
    arrays = [result[entry.name].reshape(len(result), -1) for entry in fields]
    layout, offset = [], 0
    for entry, values in zip(fields, arrays, strict=True):
        layout.append((entry.name, offset, result[entry.name].shape[1:]))
        offset += values.shape[1]
    part = path.with_name(f".{path.stem}.part.h5")
    stats = dict(result.stats) | {"wall_s": result.stats["wall_s"] + history.wall}
    ending = {"stats": stats} | {
        name: getattr(result, name) for name in ("success", "message", "counters", "final_time", "final_state")
    }
    whole = Part(result.scene, layout, fields, result.meta, result.geometry)
    with ResultWriter(part, whole, overwrite=True) as writer:
        writer.append(np.hstack(arrays))
        writer.finish(ending)
    try:
        with h5py.File(part, "r+") as file:
            file.attrs["paper"] = json.dumps(dict(about))
            file.attrs["fingerprint"] = fingerprint
            _put(file, history)
        os.replace(part, path)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error}") from error
