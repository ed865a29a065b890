"""The command ``fmu``: a bearing as a unit for co-simulation by FMI 3."""

from __future__ import annotations

from pathlib import Path

from trbdyn.cli.case import subject_with_changes
from trbdyn.cli.declared import CASE, SET, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, say


@subcommand(
    "fmu",
    "write a bearing as a unit of FMI 3, which other programs step",
    CASE,
    argument("-o --output", "the unit (default: CASE.fmu)", "FILE"),
    argument("--ring", "what goes in: the motion of the inner ring (default), or forces", "KIND", default="motion"),
    argument("--overwrite", "replace the unit if it is there"),
    SET,
)
def fmu(options: Options) -> int:
    """Write a bearing as a unit for co-simulation by FMI 3. Python with trbdyn has to be there where the unit runs."""
    from trbdyn import write_fmu

    scene, run = subject_with_changes(options.case, options.changes)
    output = options.output or f"{Path(options.case).stem}.fmu"
    path = write_fmu(scene, output, ring=options.ring, accuracy=run.accuracy, overwrite=options.overwrite)
    say(f"{path} written")
    return DONE
