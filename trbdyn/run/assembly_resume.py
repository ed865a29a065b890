"""Going on with a run of bearings on one shaft that was cut off."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

from trbdyn import _core
from trbdyn.errors import FileError, InputError
from trbdyn.model.assembly import Assembly
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.assembly_file import description_in
from trbdyn.run import checkpoint
from trbdyn.run.assembly import AssemblySimulation
from trbdyn.run.assembly_run import AssemblyRun, motions_digest, older_parts, subject_of
from trbdyn.run.checkpoint import Checkpoint
from trbdyn.run.keeping import kept_by_default
from trbdyn.run.options import OF_ONE_RUN, RunOptions
from trbdyn.run.running import output_times


def is_of_assembly(output: Path) -> bool:
    """Whether a result file, or the checkpoint beside it, is that of bearings on a shaft."""
    newest = checkpoint.checkpoint_path(output)
    for path in (newest, checkpoint.previous_path(newest)):
        with contextlib.suppress(FileError):
            return subject_of(checkpoint.read(path)) is not None
    try:
        return output.exists() and description_in(output) is not None
    except FileError:
        return False


def resume_assembly(
    output: Path, *, instruction_set: str | None, progress: bool, tell: Callable[[str], None]
) -> AssemblyResult:
    """Go on with a run of bearings on one shaft; see `trbdyn.resume`."""
    try:
        found = checkpoint.read_last_good(output, tell)
    except FileError:
        if output.exists():
            return AssemblyResult.load(output)
        raise
    sim, options = _revive(output, found, instruction_set, tell)
    housing = any(seat.scene.housing is not None for seat in sim.seats.values())
    speed = sim._first.turning_rpm
    kept = kept_by_default(found.end - found.start, speed, options.save_every, options.save_groups, housing=housing)
    times = output_times(found.start, found.end, kept["save_every"])
    if found.done >= times.size:
        where = checkpoint.checkpoint_path(output)
        raise FileError(f"{where}: the checkpoint cannot be used: it has too many records")
    run = AssemblyRun(sim, options, times, found.done)
    for bearing in run.bearings:
        said = [
            text.removeprefix(f"{bearing.name}: ") for text in found.warnings if text.startswith(f"{bearing.name}: ")
        ]
        bearing.doubts[:] = said
    run.spent = found.stepping_s
    older = older_parts(output, list(sim.seats), found)
    run.write_to(output, overwrite=output.exists(), older=older, run_id=found.run_id)
    return run.go(progress=progress)


def _revive(
    output: Path, found: Checkpoint, instruction_set: str | None, tell: Callable[[str], None]
) -> tuple[AssemblySimulation, RunOptions]:
    """A simulation at a checkpoint."""
    where = checkpoint.checkpoint_path(output)
    variant = checkpoint.check_instruction_set(found, instruction_set, tell)
    try:
        assembly, options = Assembly.from_dict(subject_of(found) or {}), RunOptions.from_dict(found.options)
        if assembly.fingerprint != found.model:
            raise FileError(
                f"{where}: the checkpoint cannot be used: its assembly is not the one that its model hash belongs to"
            )
        settings = {name: getattr(options, name) for name in RunOptions.model_fields if name not in OF_ONE_RUN}
        sim = AssemblySimulation(assembly, instruction_set=variant, **settings)
        if found.build != checkpoint.build_digest():
            tell("going on with another build of the core: results may differ in rounding from the uninterrupted run")
        elif found.motion != motions_digest(sim):
            tell("the equilibrium differs in rounding on this machine: results may differ from the uninterrupted run")
        sim._begin(found.time, found.state)
        if found.peaks.size:
            sim._core.restore_peaks(found.peaks)
    except (InputError, _core.CoreInputError) as error:
        raise FileError(f"{where}: the checkpoint cannot be used: {error}") from error
    sim._totals, sim._counted = dict(found.statistics), dict(found.counters)
    return sim, options
