"""The command line: run cases, draw pictures, look into files and cases.

Exit codes: 0 done; 1 a run failed or was stopped by Ctrl-C (what it recorded is kept); 2 input, case or file that
cannot be used; 3 a fault of trbdyn itself; 130 stopped by Ctrl-C outside of a run.

Each command imports what it needs when it runs, so that ``--help`` comes at once.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Final

from trbdyn.base.version import __version__
from trbdyn.cli import (
    answers,
    app,
    cases,
    check,
    demo,
    ensemble,
    fmu,
    look,
    plan,
    rating,
    report,
    run,
    sweep,
    thermal,
    torque,
    view,
)
from trbdyn.cli.outcome import BAD_INPUT, DONE, FAILED, FAULT, INTERRUPTED, Parser, let_any_name_be_printed, run_command

__all__ = ["BAD_INPUT", "DONE", "FAILED", "FAULT", "INTERRUPTED", "main", "make_parser"]

COMMANDS: Final = (
    run.run,
    run.resume,
    look.plot,
    look.info,
    check.check,
    demo.demo,
    report.report,
    view.view,
    sweep.sweep,
    ensemble.ensemble,
    plan.plan,
    rating.rating,
    answers.fit,
    answers.spectrum,
    answers.stiffness,
    answers.export,
    torque.torque,
    thermal.thermal,
    fmu.fmu,
    app.app,
    cases.cases,
    cases.new,
)
"""In the order in which they are listed."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line with the words after the program's name, by default those of the process; gives the exit code."""
    let_any_name_be_printed()
    words = list(sys.argv[1:] if arguments is None else arguments)
    options = make_parser().parse_args(words, argparse.Namespace(words=words))
    return run_command(options.command, options)


def make_parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    parser = Parser(prog="trbdyn", description="Dynamics of tapered and cylindrical roller bearings.")
    parser.add_argument("--version", action="version", version=f"trbdyn {__version__}")
    debug = Parser(add_help=False)
    debug.add_argument("--debug", action="store_true", help="show where an error arose")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for one in COMMANDS:
        one.add_to(commands, debug)
    return parser
