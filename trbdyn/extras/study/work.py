"""What a worker does: run one case, write its file, read its observables."""

from __future__ import annotations

import glob
import time as clock
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from trbdyn.errors import StepError, TrbError
from trbdyn.model.assembly import Subject, subject_from_dict
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.options import RunOptions
from trbdyn.run.simulation import Simulation

AnyResult = Result | AssemblyResult
Observable = Callable[[Any], Any]

NOT_OBSERVABLE: Final = ("success", "message")
"""Entries of a summary that are told otherwise."""


@dataclass(frozen=True)
class Task:
    """What a worker is to do: scene and run options as plain data, and functions of the result that are wanted besides the
    summary.
    """

    fingerprint: str  # of the case
    scene: dict[str, Any]
    run: dict[str, Any]
    path: str = ""  # result file; empty to keep records in memory
    observables: Mapping[str, Observable] = field(default_factory=dict)


@dataclass(frozen=True)
class Report:
    """How a task ended."""

    status: Literal["done", "failed"]
    message: str  # how it ended, in a sentence
    file: str = ""  # name of the result file; empty if there is none
    values: dict[str, Any] = field(default_factory=dict)  # observables, as plain data
    wall_s: float = 0.0  # wall time (s)


def simulation(scene: Subject, run: RunOptions) -> Simulation[Any]:
    """A simulation with the settings of run options."""
    return Simulation(scene, **run.of_simulation())


def run_case(task: Task, stopped: Callable[[], bool]) -> Report:
    """Run one case. A file appears under its name when it is complete; records of a run that failed on the way are kept under a
    name of its own. Nothing is kept of a run that was stopped before its end, which raises KeyboardInterrupt.
    """
    began = clock.perf_counter()
    path = Path(task.path) if task.path else None
    part = path.with_name(f".{path.name}.part") if path else None
    try:
        result, report = _run(task, part, stopped)
    except KeyboardInterrupt:
        _clear(part)
        raise
    file = ""
    if path is not None and part is not None and part.is_file():
        kept = path if report.status == "done" else path.with_name(f"{path.stem}.failed.h5")
        part.replace(kept)
        file = kept.name
        if result is not None:
            result = result.moved(kept)
    values: dict[str, Any] = {}
    if result is not None and report.status == "done":
        values, mistakes = observe(result, task.observables)
        if mistakes:
            report = Report(report.status, "; ".join([report.message, *mistakes]))
    return Report(report.status, report.message, file, values, clock.perf_counter() - began)


def _run(task: Task, part: Path | None, stopped: Callable[[], bool]) -> tuple[AnyResult | None, Report]:
    try:
        scene, run = subject_from_dict(task.scene), RunOptions.from_dict(task.run)
        result = simulation(scene, run).run(
            revolutions=run.revolutions,
            duration=run.duration,
            until=run.until,
            save_every=run.save_every,
            save_groups=run.save_groups,
            output=part,
            overwrite=True,
            callback=lambda _: stopped(),
        )
    except StepError as error:
        return None, Report("failed", str(error))
    except Exception as error:
        _clear(part)
        return None, Report("failed", said(error))
    if not result.success:
        raise KeyboardInterrupt
    return result, Report("done", result.message)


def _clear(part: Path | None) -> None:
    """Remove an unfinished file, and checkpoints beside it."""
    if part is not None:
        for leftover in (part, *part.parent.glob(f"{glob.escape(part.name)}.checkpoint*")):
            leftover.unlink(missing_ok=True)


def said(error: Exception) -> str:
    """What an error says: its text, with its kind and place unless it is meant for users."""
    if isinstance(error, TrbError):
        return str(error)
    frames = traceback.extract_tb(error.__traceback__)
    place = f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}: {error}{place}"


def observe(result: AnyResult, functions: Mapping[str, Observable]) -> tuple[dict[str, Any], list[str]]:
    """Summary and further observables of a result, as plain data; tables of the summary become ``table_entry``.

    An observable that fails has no value, and a sentence says why: it costs neither the run nor the other observables.
    """
    values = {name: value for name, value in result.numbers().items() if name not in NOT_OBSERVABLE}
    found, mistakes = apply(result, functions)
    return values | found, mistakes


def apply(result: AnyResult, functions: Mapping[str, Observable]) -> tuple[dict[str, Any], list[str]]:
    """Observables of a result as plain data, and a sentence for each that failed."""
    values: dict[str, Any] = {}
    mistakes: list[str] = []
    for name, function in functions.items():
        try:
            values[name] = as_plain(function(result))
        except Exception as error:
            mistakes.append(f"the observable {name!r} failed: {said(error)}")
    return values, mistakes


def as_plain(value: Any) -> Any:
    """A number, text or array as JSON holds it; numbers that are not finite become None."""
    if isinstance(value, str | bool | int) or value is None:
        return value
    array = np.asarray(value)
    if array.dtype == object:
        raise TypeError(f"an observable must give a number, a text or an array of numbers, not {type(value).__name__}")
    if array.ndim:
        return [as_plain(entry) for entry in array.tolist()]
    scalar = array.item()
    return None if isinstance(scalar, float) and not np.isfinite(scalar) else scalar
