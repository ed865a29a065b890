"""The command line: run cases, draw pictures, look into files and cases.

Exit codes: 0 done; 1 a run failed or was stopped by Ctrl-C (what it recorded is kept); 2 input, case or file that
cannot be used; 3 a fault of trbdyn itself; 130 stopped by Ctrl-C outside of a run.

Each command imports what it needs when it runs, so that ``--help`` comes at once.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from trbdyn.base.version import __version__
from trbdyn.cli.app import add_app_parser
from trbdyn.cli.cases import add_case_parsers
from trbdyn.cli.demo import add_demo_parser
from trbdyn.cli.ensemble import add_ensemble_parser
from trbdyn.cli.look import add_look_parsers
from trbdyn.cli.outcome import BAD_INPUT, DONE, FAILED, FAULT, INTERRUPTED, Parser, let_any_name_be_printed, run_command
from trbdyn.cli.plan import add_plan_parser
from trbdyn.cli.rating import add_rating_parser
from trbdyn.cli.report import add_report_parser
from trbdyn.cli.run import add_run_parsers
from trbdyn.cli.sweep import add_sweep_parser
from trbdyn.cli.thermal import add_thermal_parser
from trbdyn.cli.torque import add_torque_parser
from trbdyn.cli.view import add_view_parser

__all__ = ["BAD_INPUT", "DONE", "FAILED", "FAULT", "INTERRUPTED", "main", "make_parser"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line with the words after the program's name, by default those of the process; gives the exit code."""
    let_any_name_be_printed()
    options = make_parser().parse_args(arguments)
    return run_command(options.command, options)


def make_parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    parser = Parser(prog="trbdyn", description="Dynamics of tapered and cylindrical roller bearings.")
    parser.add_argument("--version", action="version", version=f"trbdyn {__version__}")
    debug = Parser(add_help=False)
    debug.add_argument("--debug", action="store_true", help="show where an error arose")
    turns = Parser(add_help=False)
    turns.add_argument("--revolutions", type=float, metavar="N", help="turns of the shaft")
    turns.add_argument("--accuracy", choices=("fast", "standard", "reference"), help="preset of the tolerances")
    turns.add_argument("--quiet", action="store_true", help="no progress bar, no summary")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    common, length = [debug], [turns]
    add_run_parsers(commands, common, length)
    add_look_parsers(commands, common)
    add_demo_parser(commands, common, length)
    add_report_parser(commands, common)
    add_view_parser(commands, common)
    add_sweep_parser(commands, common)
    add_ensemble_parser(commands, common)
    add_plan_parser(commands, common)
    add_rating_parser(commands, common)
    add_torque_parser(commands, common)
    add_thermal_parser(commands, common)
    add_app_parser(commands, common)
    add_case_parsers(commands, common)
    return parser
