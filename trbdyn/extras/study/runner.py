"""Running a study: every case once, results in a folder, observables gathered."""

from __future__ import annotations

import os
import pickle
from collections.abc import Iterable, Mapping
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

from trbdyn.base.own_files import folder_path
from trbdyn.base.validation import Model
from trbdyn.base.version import __version__
from trbdyn.errors import FileError, InputError
from trbdyn.extras.study import gather
from trbdyn.extras.study.definition import Case, Study
from trbdyn.extras.study.design import of_scenes
from trbdyn.extras.study.executors import Outcome, execute
from trbdyn.extras.study.index import INDEX, Entry, Index
from trbdyn.extras.study.work import Observable, Report, Task, apply, as_plain, run_case, said
from trbdyn.model.assembly import Subject
from trbdyn.results.assembly import load
from trbdyn.run.options import RunOptions

if TYPE_CHECKING:
    import xarray

DATASET = "observables.nc"


class Running(TypedDict, total=False):
    """Arguments of `run` that every function has which makes runs: ``folder``, ``executor``, ``workers`` and ``progress``.

    In a folder the runs are kept, and a second call with the same folder makes only those that are missing. Without an executor
    runs go side by side in threads.
    """

    folder: str | os.PathLike[str] | None
    executor: Any
    workers: int | None
    progress: bool


def run(
    study: Study | Iterable[Subject | tuple[Subject, RunOptions]],
    folder: str | os.PathLike[str] | None = None,
    *,
    options: RunOptions | None = None,
    executor: Any = "processes",
    workers: int | None = None,
    observables: Mapping[str, Observable] | None = None,
    resume: bool = True,
    progress: bool = False,
) -> xarray.Dataset:
    """Run every case of a study and gather its observables.

    Parameters
    ----------
    study : Study or iterable of Scene
        The cases; scenes may come with run options of their own, as (scene, options).
    folder : path-like, optional
        Where each case gets its result file, beside ``index.jsonl`` and the dataset ``observables.nc``; without it no
        files are written.
    options : RunOptions, optional
        How scenes are run; a study has its own.
    executor : {'processes', 'threads', 'serial'} or object
        Worker processes of its own (spawned: a script needs ``if __name__ == "__main__":``), threads, this thread; or
        any executor with ``submit`` as in `concurrent.futures`; or a Dask client, whose workers must see the same
        folder.
    workers : int, optional
        Number of own workers; by default, and at most, the cores.
    observables : mapping of str to callable, optional
        Functions of a `Result` besides its summary, giving a number, a text or an array; for processes they must
        pickle.
    resume : bool
        Skip cases that are done: those whose scene and run options have a finished file in the folder. Cases that
        failed are run again.
    progress : bool
        Show a progress bar.

    Returns
    -------
    xarray.Dataset
        See `trbdyn.extras.study.gather.dataset`. Cases that failed have the status ``failed`` and say why in ``message``.

    Raises
    ------
    InputError
        If no case can be built, or an argument cannot be used.
    FileError
        If the folder cannot be used.
    """
    if isinstance(study, Model | str | os.PathLike) or not isinstance(study, Study | Iterable):
        raise InputError.of(
            "study", study, "must be a Study, or scenes in a list; trb.study.load_study reads a study from a file"
        )
    study = study if isinstance(study, Study) else of_scenes(study, options)
    place = None if folder is None else folder_path(folder, "folder")
    if place is not None and (place / DATASET).exists() and not (place / INDEX).exists():
        raise FileError(
            f"{place / DATASET}: belongs to no study of this folder, and would be replaced; give another folder"
        )
    index, functions = Index(place), dict(observables or {})
    if executor == "processes":
        _check_pickle(functions)
    waiting = {case.fingerprint: case for case in study.cases}
    if resume:
        waiting = {key: case for key, case in waiting.items() if not index.done(key)}
    unbuilt = [case for case in waiting.values() if case.scene is None]
    for case in unbuilt:
        index.add(_entry(case, Report("failed", case.error)))
    tasks = [_task(case, place, functions) for case in waiting.values() if case.scene is not None]
    failed = len(unbuilt)
    with (
        _bar(len(study.cases), len(study.cases) - len(tasks), progress) as bar,
        closing(execute(run_case, tasks, executor, workers)) as outcomes,
    ):
        for outcome in outcomes:
            entry = _entry(waiting[outcome.task.fingerprint], _report(outcome))
            index.add(entry)
            failed += entry.status == "failed"
            bar.set_postfix_str(f"{failed} failed" if failed else "", refresh=False)
            bar.update()
    data = gather.dataset(study, [_observed(index, case, functions) for case in study.cases])
    if place is not None:
        gather.save(data, place / DATASET, overwrite=True)
    return data


def collect(study: Study, folder: str | os.PathLike[str]) -> xarray.Dataset:
    """Gather what a folder holds of a study, without running anything.

    Raises
    ------
    FileError
        If the folder cannot be used.
    """
    index = Index(folder_path(folder, "folder"))
    return gather.dataset(study, [index.entries.get(case.fingerprint) for case in study.cases])


def _check_pickle(functions: Mapping[str, Observable]) -> None:
    """Worker processes get observables by pickle, which takes functions of a module alone: say so before anything
    runs.
    """
    for name, function in functions.items():
        try:
            pickle.dumps(function)
        except Exception as error:
            limit = (
                "must be a function at the top level of a module for executor = 'processes', not a lambda or an inner function "
                f"({error}); or give executor = 'threads'"
            )
            raise InputError.of(("observables", name), function, limit) from None


def _bar(total: int, done: int, show: bool) -> Any:
    from tqdm import tqdm

    return tqdm(total=total, initial=done, disable=not show, unit="case")


def _task(case: Case, folder: Path | None, functions: Mapping[str, Observable]) -> Task:
    if case.scene is None:
        raise InputError.of("case", case.name, case.error)
    path = "" if folder is None else str(folder.absolute() / f"{case.name}.h5")
    return Task(case.fingerprint, case.scene.to_dict(), case.run.to_dict(), path, functions)


def _report(outcome: Outcome[Task]) -> Report:
    if outcome.error is not None:
        return Report("failed", said(outcome.error))
    report: Report = outcome.value
    return report


def _entry(case: Case, report: Report) -> Entry:
    return Entry(
        name=case.name,
        fingerprint=case.fingerprint,
        status=report.status,
        message=report.message,
        parameters={key: as_plain(value) for key, value in case.parameters.items()},
        file=report.file,
        values=report.values,
        wall_s=report.wall_s,
        finished=datetime.now(UTC).isoformat(timespec="seconds"),
        version=__version__,
    )


def _observed(index: Index, case: Case, functions: Mapping[str, Observable]) -> Entry | None:
    """The entry of a case; observables that an earlier run was not asked for are read from its file, and kept."""
    entry = index.entries.get(case.fingerprint)
    if entry is None or entry.status != "done" or index.folder is None or not entry.file:
        return entry
    missing = {name: function for name, function in functions.items() if name not in entry.values}
    if not missing:
        return entry
    result = load(index.folder / entry.file)
    values, mistakes = apply(result, missing)
    message = "; ".join([entry.message.partition("; the observable")[0], *mistakes])
    entry = Entry(**{**entry.__dict__, "values": entry.values | values, "message": message})
    index.add(entry)
    return entry
