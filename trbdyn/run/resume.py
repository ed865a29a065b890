"""Going on with a run that was cut off."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

from trbdyn.base.locks import take_lock
from trbdyn.base.own_files import file_path, set_aside
from trbdyn.errors import FileError, InputError
from trbdyn.model.scene import Scene
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.file_format import reason
from trbdyn.results.result import Result, load
from trbdyn.results.sources import FileSource
from trbdyn.run import checkpoint
from trbdyn.run.assembly_resume import is_of_assembly, resume_assembly
from trbdyn.run.keeping import groups_of, kept_by_default
from trbdyn.run.revive import revive
from trbdyn.run.running import Callback, Run, output_times
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
        As in `Simulation.run`; not for bearings on a shaft.

    Returns
    -------
    Result or AssemblyResult
        The whole run. If it was complete already, nothing is done.

    Raises
    ------
    FileError
        If there is no checkpoint that can be used, or another process is writing the run.
    InputError
        If this machine does not run the instruction set.
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

    if is_of_assembly(output):
        if callback is not None:
            raise InputError.of("callback", callback, "must not be given for an assembly")
        return resume_assembly(output, instruction_set=instruction_set, progress=progress, tell=tell)

    def run_on(older: FileSource | None) -> Result:
        found = checkpoint.read_last_good(output, tell)
        if older is not None and older.run_id != found.run_id:
            raise FileError(
                f"{checkpoint.checkpoint_path(output)}: the checkpoint belongs to another run than {output}"
            )
        sim, options = revive(
            output,
            found,
            instruction_set,
            tell,
            subject=lambda: Scene.from_dict(found.scene),
            make=Simulation,
            motion=lambda sim: checkpoint.digest_of(sim._motion.table),
        )
        kept = kept_by_default(
            found.end - found.start,
            sim.scene.turning_rpm,
            options.save_every,
            options.save_groups,
            optional=groups_of([sim.scene]),
        )
        times = output_times(found.start, found.end, kept["save_every"])
        if found.done >= times.size:
            raise FileError(
                f"{checkpoint.checkpoint_path(output)}: the checkpoint cannot be used: it has too many records"
            )
        if older is not None and older.first_record + older.n_records < found.done:
            raise FileError(f"{output}: the result file holds fewer records than its checkpoint says")
        run = Run(sim, options, times, callback, found.done)
        run.notes, run.spent, run.doubts = notes, found.stepping_s, list(found.warnings)
        run.write_to(output, found.run_id, older=older, overwrite=older is not None)
        return run.go(progress=progress)

    if not output.exists():
        found = checkpoint.read_last_good(output, lambda note: None)
        if found.done:
            tell(f"{output}: there is no such file; its records are lost, those from the checkpoint on will be written")
        # refused if another process has begun to write the file meanwhile
        return run_on(None)
    older: FileSource | None = None
    try:
        take_lock(output).close()
        try:
            older = FileSource(output)
            older.check()
        except FileError as error:
            older, kept = None, ""
            if output.stat().st_size:
                # one that cannot be read may still hold something
                kept = f"; it is kept as {set_aside(output)}"
            else:
                output.unlink()
            tell(f"{error}; its records are lost, those from the checkpoint on will be written{kept}")
    except OSError as error:
        raise FileError(f"{output}: cannot be resumed: {reason(error)}") from error
    if older is not None and older.info.success:
        return load(output)
    return run_on(older)
