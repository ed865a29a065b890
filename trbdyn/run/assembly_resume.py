"""Going on with a run of bearings on one shaft that was cut off."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

from trbdyn.errors import FileError
from trbdyn.model.assembly import Assembly
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.assembly_file import description_in
from trbdyn.run import checkpoint
from trbdyn.run.assembly import AssemblySimulation
from trbdyn.run.assembly_run import AssemblyRun, motions_digest, older_parts, subject_of
from trbdyn.run.keeping import groups_of, kept_by_default
from trbdyn.run.revive import revive
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
    sim, options = revive(
        output,
        found,
        instruction_set,
        tell,
        subject=lambda: Assembly.from_dict(subject_of(found) or {}),
        make=AssemblySimulation,
        motion=motions_digest,
    )
    optional = groups_of(seat.scene for seat in sim.seats.values())
    speed = sim._first.turning_rpm
    kept = kept_by_default(found.end - found.start, speed, options.save_every, options.save_groups, optional=optional)
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
