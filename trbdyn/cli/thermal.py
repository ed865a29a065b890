"""The command ``thermal``: the temperatures at which a case makes as much heat as it gives off."""

from __future__ import annotations

from pathlib import Path

from trbdyn.cli.case import named_numbers, subject_with_changes
from trbdyn.cli.declared import CASE, SET, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, say


@subcommand(
    "thermal",
    "find the temperatures at which losses and cooling balance",
    CASE,
    argument(
        "--heat",
        "a conductance (W/K) or a temperature outside (C) of trbdyn.HeatPaths, for instance "
        "outer_ring_to_surroundings=3.2 (may be given several times)",
        "NAME=VALUE",
        action="append",
        required=True,
    ),
    argument("-o --output", "the picture (default: CASE_thermal.png)", "FILE"),
    argument("--overwrite", "replace the picture"),
    SET,
)
def thermal(options: Options) -> int:
    """Find the temperatures of rings, rollers and oil at which a case makes as much heat as it gives off. Writes a
    picture.
    """
    from trbdyn import HeatPaths, thermal
    from trbdyn.base.own_files import output_path

    given = named_numbers("--heat", options.heat, "NAME=VALUE", "outer_ring_to_surroundings=3.2")
    paths = HeatPaths(**given)
    subject, run = subject_with_changes(options.case, options.changes)
    picture = options.output or f"{Path(options.case).stem}_thermal.png"
    output_path(picture, overwrite=options.overwrite, reads=[options.case])
    found = thermal(subject, paths, options=run)
    found.picture(picture, overwrite=options.overwrite)
    say(found)
    say(f"\n{picture}")
    return DONE
