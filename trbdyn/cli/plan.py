"""The command ``plan``: the cheapest simulation of a case that gives some averages as exactly as is wanted."""

from __future__ import annotations

import sys
from pathlib import Path

from trbdyn.cli.called import command
from trbdyn.cli.case import named_numbers, subject_with_changes
from trbdyn.cli.declared import CASE, SET, Options, argument, subcommand
from trbdyn.cli.outcome import DONE, FAILED, say


@subcommand(
    "plan",
    "find the cheapest simulation that is as exact as is wanted",
    CASE,
    argument(
        "--want",
        "an average with its relative error, for instance torque=0.02 for 2 %% (may be given several times)",
        "NAME=ERROR",
        action="append",
        required=True,
    ),
    argument("--budget", "most computing time of the run: the most exact one within it", "S", type=float),
    argument("--effort", "computing time for the probes, about (default: 15)", "S", type=float),
    argument("-o --output", "writes NAME.toml and NAME.png (default: CASE_plan)", "NAME"),
    argument("--overwrite", "replace these files"),
    SET,
)
def plan(options: Options) -> int:
    """Find the cheapest simulation of a case that gives averages of its summary as exactly as is wanted: which effects it
    needs, how many nodes, which tolerances, how long. Writes the case that it proposes, and a picture.
    """
    from trbdyn import plan
    from trbdyn.base.own_files import output_path, write_whole
    from trbdyn.run.case_text import case_text, rounded

    want = named_numbers("--want", options.want, "NAME=ERROR", "torque=0.02")
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


def _words(want: dict[str, float]) -> str:
    return ", ".join(f"{name} within {100.0 * share:.3g} %" for name, share in want.items())
