"""The command ``thermal``: the temperatures at which a case makes as much heat as it gives off."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from trbdyn.cli.case import add_set, subject_with_changes
from trbdyn.cli.outcome import DONE, say
from trbdyn.errors import InputError


def add_thermal_parser(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    """Add the command ``thermal``."""
    thermal = commands.add_parser(
        "thermal",
        parents=[*parents],
        help="find the temperatures at which losses and cooling balance",
        description="Find the temperatures of rings, rollers and oil at which a case makes as much heat as it gives off. Writes "
        "a picture.",
    )
    thermal.add_argument("case", metavar="CASE", help="a TOML file, or the name of a shipped case")
    thermal.add_argument(
        "--heat",
        action="append",
        required=True,
        metavar="NAME=VALUE",
        help="a conductance (W/K) or a temperature outside (C) of trbdyn.HeatPaths, for instance "
        "outer_ring_to_surroundings=3.2 (may be given several times)",
    )
    thermal.add_argument("-o", "--output", metavar="FILE", help="the picture (default: CASE_thermal.png)")
    thermal.add_argument("--overwrite", action="store_true", help="replace the picture")
    add_set(thermal)
    thermal.set_defaults(command=_thermal)


def _thermal(options: argparse.Namespace) -> int:
    from trbdyn.base.own_files import output_path
    from trbdyn.model.heat import HeatPaths
    from trbdyn.study.thermal import thermal

    given: dict[str, Any] = {}
    for text in options.heat:
        name, equals, value = text.partition("=")
        try:
            given[name.strip()] = float(value)
        except ValueError:
            equals = ""
        if not equals:
            raise InputError.of("--heat", text, "must be NAME=VALUE, for instance outer_ring_to_surroundings=3.2")
    paths = HeatPaths(**given)
    subject, run = subject_with_changes(options.case, options.changes)
    picture = options.output or f"{Path(options.case).stem}_thermal.png"
    output_path(picture, overwrite=options.overwrite, reads=[options.case])
    found = thermal(subject, paths, options=run)
    found.picture(picture, overwrite=options.overwrite)
    say(found)
    say(f"\n{picture}")
    return DONE
