"""The command ``plan``: the cheapest simulation of a case that gives some averages as exactly as is wanted."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from trbdyn.cli.called import command
from trbdyn.cli.case import add_set, subject_with_changes
from trbdyn.cli.outcome import DONE, FAILED, say
from trbdyn.errors import InputError


def add_plan_parser(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    """Add the command ``plan``."""
    plan = commands.add_parser(
        "plan",
        parents=[*parents],
        help="find the cheapest simulation that is as exact as is wanted",
        description="Find the cheapest simulation of a case that gives averages of its summary as exactly as is wanted: which "
        "effects it needs, how many nodes, which tolerances, how long. Writes the case that it proposes, and a picture.",
    )
    plan.add_argument("case", metavar="CASE", help="a TOML file, or the name of a shipped case")
    plan.add_argument(
        "--want",
        action="append",
        required=True,
        metavar="NAME=ERROR",
        help="an average with its relative error, for instance torque=0.02 for 2 %% (may be given several times)",
    )
    plan.add_argument(
        "--budget", type=float, metavar="S", help="most computing time of the run: the most exact one within it"
    )
    plan.add_argument("--effort", type=float, metavar="S", help="computing time for the probes, about (default: 15)")
    plan.add_argument("-o", "--output", metavar="NAME", help="writes NAME.toml and NAME.png (default: CASE_plan)")
    plan.add_argument("--overwrite", action="store_true", help="replace these files")
    add_set(plan)
    plan.set_defaults(command=_plan)


def _plan(options: argparse.Namespace) -> int:
    from trbdyn.base.own_files import output_path, write_whole
    from trbdyn.run.case_text import case_text, rounded
    from trbdyn.study.planning import plan

    want = _wishes(options.want)
    scene, _ = subject_with_changes(options.case, options.changes)
    name = options.output or f"{Path(options.case).stem}_plan"
    again = {"overwrite": options.overwrite}
    files = [output_path(f"{name}{ending}", reads=[options.case], **again) for ending in (".toml", ".png")]
    effort = {} if options.effort is None else {"effort": options.effort}
    found = plan(scene, want, budget=options.budget, **effort)
    say(found)
    kept = {"duration": found.duration, "save_every": found.save_every}
    text = case_text(
        found.scene, found.options.replace(**rounded(kept)), title=f"The plan of {options.case} for {_words(want)}"
    )
    write_whole(files[0], text, **again)
    found.picture(files[1], **again)
    say(f"\n{files[0]}\n{files[1]}\n{command('run', files[0])}")
    say(
        "(The promise is for the averages from the end of the settling on; the summary of a run averages over its second half.)"
    )
    if not found.reached:
        say("trbdyn: what was wanted is not within reach; see above for what is", file=sys.stderr)
    return DONE if found.reached else FAILED


def _wishes(texts: Sequence[str]) -> dict[str, float]:
    found: dict[str, float] = {}
    for text in texts:
        name, share = _wish(text)
        if name in found:
            raise InputError.of("--want", text, f"must name an average once: {name} was given before")
        found[name] = share
    return found


def _wish(text: str) -> tuple[str, float]:
    name, equals, number = text.partition("=")
    try:
        share = float(number)
    except ValueError:
        share = math.nan
    if not equals or not math.isfinite(share):
        raise InputError.of("--want", text, "must be NAME=ERROR, for instance torque=0.02")
    return name.strip(), share


def _words(want: dict[str, float]) -> str:
    return ", ".join(f"{name} within {100.0 * share:.3g} %" for name, share in want.items())
