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
from trbdyn.model.scene import Scene
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.file_format import reason
from trbdyn.results.result import Result, load
from trbdyn.results.sources import FileSource
from trbdyn.run import checkpoint
from trbdyn.run.assembly_resume import is_of_assembly, resume_assembly
from trbdyn.run.checkpoint import Checkpoint
from trbdyn.run.keeping import kept_by_default
from trbdyn.run.options import OF_ONE_RUN, RunOptions
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
        sim, options = _revive(output, found, instruction_set, tell)
        kept = kept_by_default(
            found.end - found.start,
            sim.scene.turning_rpm,
            options.save_every,
            options.save_groups,
            housing=sim.scene.housing is not None,
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


def _revive(
    output: Path, found: Checkpoint, instruction_set: str | None, tell: Callable[[str], None]
) -> tuple[Simulation, RunOptions]:
    """A simulation at a checkpoint."""
    where = checkpoint.checkpoint_path(output)
    variant = checkpoint.check_instruction_set(found, instruction_set, tell)
    try:
        scene, options = Scene.from_dict(found.scene), RunOptions.from_dict(found.options)
        if scene.fingerprint != found.model:
            raise FileError(
                f"{where}: the checkpoint cannot be used: its scene is not the one that its model hash belongs to"
            )
        settings = {name: getattr(options, name) for name in RunOptions.model_fields if name not in OF_ONE_RUN}
        sim = Simulation(scene, instruction_set=variant, **settings)
        if found.build != checkpoint.build_digest():
            tell("going on with another build of the core: results may differ in rounding from the uninterrupted run")
        elif found.motion != checkpoint.digest_of(sim._motion.table):
            tell(
                "the ring's equilibrium differs in rounding on this machine: results may differ from the uninterrupted run"
            )
        sim._begin(found.time, found.state)
        if found.peaks.size:
            sim._core.restore_peaks(found.peaks)
    except (InputError, _core.CoreInputError) as error:
        raise FileError(f"{where}: the checkpoint cannot be used: {error}") from error
    sim._totals, sim._counted = dict(found.statistics), dict(found.counters)
    return sim, options
