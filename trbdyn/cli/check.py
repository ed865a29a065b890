"""The command ``check``: how accurate the numbers of a run are, measured by repeating it."""

from __future__ import annotations

import json
from dataclasses import asdict

from trbdyn.cli.declared import FILE, Options, argument, subcommand
from trbdyn.cli.outcome import DONE


@subcommand(
    "check",
    "how accurate the numbers of a run are",
    FILE,
    argument("--budget", "processor time (s); default: 2, or a tenth of that of the run", "S", type=float),
    argument("--json", "print what was found as JSON"),
)
def check(options: Options) -> int:
    """Repeat a run, or pieces of it, with its own tolerances and with tighter ones, and say what the tolerances do to losses,
    torque, loads, films and forces in pockets.
    """
    from trbdyn.results.assembly import load
    from trbdyn.results.summary import clean
    from trbdyn.run.check import check

    found = check(load(options.file), budget_s=options.budget)
    print(json.dumps(clean(asdict(found)), indent=2, allow_nan=False) if options.json else found)
    return DONE
