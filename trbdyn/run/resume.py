"""Going on with a run that was cut off."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from pathlib import Path

from trbdyn import _core
from trbdyn.base.locks import take_lock
from trbdyn.base.own_files import file_path, set_aside
from trbdyn.errors import FileError, InputError
from trbdyn.model.assembly import subject_from_dict
from trbdyn.results.assembly import AssemblyResult, load
from trbdyn.results.file_format import reason
from trbdyn.results.file_source import FileSource, names_in
from trbdyn.results.result import Result
from trbdyn.run import checkpoint
from trbdyn.run.checkpoint import Checkpoint
from trbdyn.run.controlled import Controlled, control_again
from trbdyn.run.keeping import interval
from trbdyn.run.options import OF_ONE_RUN, RunOptions
from trbdyn.run.running import Callback, Run, motions_digest, output_times
from trbdyn.run.simulation import Simulation


def resume(
    path: str | Path,
    *,
    instruction_set: str | None = None,
    progress: bool = False,
    callback: Callback | None = None,
) -> Result | AssemblyResult:
    """Go on with a run that was cut off, from its last checkpoint.

    It takes the steps that the uninterrupted run would have taken: records and final state are bit-identical, on the
    same build and instruction set. The records before the checkpoint are copied into a new file, which takes the place of the
    old one.

    Parameters
    ----------
    path : path-like
        The run's result file; its checkpoints lie beside it.
    instruction_set : str, optional
        Kernel variant to go on with, where it shall not be that of the checkpoint.
    progress : bool
        Show a progress bar.
    callback : callable, optional
        As in `Simulation.run`; must be given for a run whose callback gives inputs. It finds `simulation.memory` as it was at the
        checkpoint.

    Returns
    -------
    Result or AssemblyResult
        The whole run. If it was complete already, nothing is done.

    Raises
    ------
    FileError
        If there is no checkpoint that can be used, or another process is writing the run.
    InputError
        If this machine does not run the instruction set, or a run whose callback gives inputs has none.
    StepError
        As in `Simulation.run`.

    Warns
    -----
    UserWarning
        If an older checkpoint had to be used, or results will not be bit-identical; ``result.meta["notes"]`` says so
        too.
    """
    output = file_path(path, "path")
    output = Path(os.path.realpath(output)) if output.is_symlink() else output
    notes: list[str] = []

    def tell(note: str) -> None:
        notes.append(note)
        warnings.warn(note, UserWarning, stacklevel=3)

    is_lost = not output.exists()
    older = None if is_lost else _records_in(output, tell)
    if older is not None and older[0].info.success:
        return load(output)
    found = checkpoint.read_last_good(output, tell)
    if is_lost and found.done:
        tell(f"{output}: there is no such file; its records are lost, those from the checkpoint on will be written")
    where = checkpoint.checkpoint_path(output)
    if older is not None and any(one.run_id != found.run_id for one in older):
        raise FileError(f"{where}: the checkpoint belongs to another run than {output}")
    if found.control is not None and callback is None:
        limit = "must be given: the run that is resumed had a callback that gives inputs"
        raise InputError.of("callback", None, limit)
    sim, options = _revived(output, found, instruction_set, tell)
    every = options.save_every or interval(found.end - found.start, sim.scene.turning_rpm)
    times = output_times(found.start, found.end, every)
    if found.done >= times.size:
        raise FileError(f"{where}: the checkpoint cannot be used: it has too many records")
    if older is not None and any(one.first_record + one.n_records < found.done for one in older):
        raise FileError(f"{output}: the result file holds fewer records than its checkpoint says")
    kind = Run if found.control is None else Controlled
    run = kind(sim, options, times, callback, found.done)
    run.spent = found.stepping_s
    for bearing in run.bearings:
        bearing.notes[:] = notes
        said = [text for text in found.warnings if text.startswith(bearing.of.said)]
        bearing.doubts[:] = [text.removeprefix(bearing.of.said) for text in said]
    # refused if another process has begun to write a file meanwhile that was not there
    run.write_to(output, found.run_id, older=older, overwrite=older is not None)
    return run.go(progress=progress)


def _records_in(output: Path, tell: Callable[[str], None]) -> list[FileSource] | None:
    """Each bearing in a result file that no other process writes; None where the file cannot be read: it is moved aside."""
    try:
        take_lock(output).close()
        try:
            older = [FileSource(output, name) for name in names_in(output)]
            for one in older:
                one.check()
            return older
        except FileError as error:
            kept = ""
            if output.stat().st_size:
                # one that cannot be read may still hold something
                kept = f"; it is kept as {set_aside(output)}"
            else:
                output.unlink()
            tell(f"{error}; its records are lost, those from the checkpoint on will be written{kept}")
            return None
    except OSError as error:
        raise FileError(f"{output}: cannot be resumed: {reason(error)}") from error


def _revived(
    output: Path, found: Checkpoint, instruction_set: str | None, tell: Callable[[str], None]
) -> tuple[Simulation, RunOptions]:
    """A simulation as it was when a checkpoint was written, and the options of its run; a FileError if the checkpoint cannot be
    used.
    """
    where = checkpoint.checkpoint_path(output)
    variant = checkpoint.check_instruction_set(found, instruction_set, tell)
    try:
        subject, options = subject_from_dict(found.scene), RunOptions.from_dict(found.options)
        if subject.fingerprint != found.model:
            kind = type(subject).__name__.lower()
            why = f"its {kind} is not the one that its model hash belongs to"
            if found.build != checkpoint.build_digest():
                why = f"another build wrote it, to which its {kind} meant other numbers; run the {kind} again from its start"
            raise FileError(f"{where}: the checkpoint cannot be used: {why}")
        settings = {name: getattr(options, name) for name in RunOptions.model_fields if name not in OF_ONE_RUN}
        sim = Simulation(subject, instruction_set=variant, **settings)
        if found.build != checkpoint.build_digest():
            tell("going on with another build of the core: results may differ in rounding from the uninterrupted run")
        elif found.control is None and found.motion != motions_digest(sim):
            tell("the equilibrium differs in rounding on this machine: results may differ from the uninterrupted run")
        if found.control is not None:
            control_again(sim, found.control)
        sim._begin(found.time, found.state)
        if found.peaks.size:
            sim._core.restore_peaks(found.peaks)
    except (InputError, _core.CoreInputError) as error:
        raise FileError(f"{where}: the checkpoint cannot be used: {error}") from error
    sim._totals, sim._counted = dict(found.statistics), dict(found.counters)
    return sim, options
