"""A simulation at a checkpoint, of one bearing or of several."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from trbdyn import _core
from trbdyn.errors import FileError, InputError
from trbdyn.run import checkpoint
from trbdyn.run.checkpoint import Checkpoint
from trbdyn.run.options import OF_ONE_RUN, RunOptions

Sim = TypeVar("Sim", bound=Any)


def revive(
    output: Path,
    found: Checkpoint,
    instruction_set: str | None,
    tell: Callable[[str], None],
    *,
    subject: Callable[[], Any],
    make: Callable[..., Sim],
    motion: Callable[[Sim], str],
) -> tuple[Sim, RunOptions]:
    """A simulation as it was when a checkpoint was written, and the options of its run.

    Parameters
    ----------
    output : Path
        Result file of the run.
    found : Checkpoint
        What was read of its checkpoint.
    instruction_set : str, optional
        Instruction set to go on with; that of the checkpoint by default.
    tell : callable
        Called with what a user should know.
    subject : callable
        Reads the scene or the assembly out of the checkpoint.
    make : callable
        Makes a simulation of it.
    motion : callable
        Digest of what the simulation prescribes, the equilibrium of the rings among it.

    Raises
    ------
    FileError
        If the checkpoint cannot be used.
    """
    where = checkpoint.checkpoint_path(output)
    variant = checkpoint.check_instruction_set(found, instruction_set, tell)
    try:
        simulated, options = subject(), RunOptions.from_dict(found.options)
        if simulated.fingerprint != found.model:
            kind = type(simulated).__name__.lower()
            why = f"its {kind} is not the one that its model hash belongs to"
            if found.build != checkpoint.build_digest():
                why = f"another build wrote it, to which its {kind} meant other numbers; run the {kind} again from its start"
            raise FileError(f"{where}: the checkpoint cannot be used: {why}")
        settings = {name: getattr(options, name) for name in RunOptions.model_fields if name not in OF_ONE_RUN}
        sim = make(simulated, instruction_set=variant, **settings)
        if found.build != checkpoint.build_digest():
            tell("going on with another build of the core: results may differ in rounding from the uninterrupted run")
        elif found.motion != motion(sim):
            tell("the equilibrium differs in rounding on this machine: results may differ from the uninterrupted run")
        sim._begin(found.time, found.state)
        if found.peaks.size:
            sim._core.restore_peaks(found.peaks)
    except (InputError, _core.CoreInputError) as error:
        raise FileError(f"{where}: the checkpoint cannot be used: {error}") from error
    sim._totals, sim._counted = dict(found.statistics), dict(found.counters)
    return sim, options
