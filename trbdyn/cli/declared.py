"""How a command is declared: its name and its arguments stand above the function that does it."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from inspect import getdoc
from typing import Any

Options = argparse.Namespace
Argument = tuple[list[str], dict[str, Any]]


def argument(names: str, words: str, metavar: str = "", **how: Any) -> Argument:
    """An argument by its names, with what argparse takes besides; a switch if it has neither metavar nor choices.
    Those of one `group` exclude each other.
    """
    kind: dict[str, Any] = {"metavar": metavar} if metavar else {} if "choices" in how else {"action": "store_true"}
    return names.split(), kind | how | {"help": words}


CASE = argument("case", "a TOML file, or the name of a shipped case", "CASE")
FILE = argument("file", "a result file", "FILE")
SET = argument(
    "--set",
    "change a value of the case, for instance scene.speed_rpm=1000 (may be given several times)",
    "KEY=VALUE",
    action="append",
    default=[],
    dest="changes",
)
WORKERS = argument("--workers", "runs at a time (default, and at most: the cores)", "N", type=int)
LENGTH = (
    argument("--revolutions", "turns of the shaft", "N", type=float),
    argument("--accuracy", "preset of the tolerances", choices=("fast", "standard", "reference")),
    argument("--quiet", "no progress bar, no summary"),
)
"""How long and how exact a run is."""


@dataclass(frozen=True)
class Command:
    """A command: it runs with the options of its arguments and gives an exit code. Its description is that of the function."""

    name: str
    words: str  # for the list of all commands
    arguments: tuple[Argument, ...]
    run: Callable[[Options], int]

    def add_to(self, commands: Any, common: argparse.ArgumentParser) -> None:
        """Add its parser, with what all commands have in common, to those of the others."""
        parser = commands.add_parser(self.name, parents=[common], help=self.words, description=getdoc(self.run))
        groups = {"": parser}
        for names, how in self.arguments:
            group, own = how.get("group", ""), {key: value for key, value in how.items() if key != "group"}
            if group not in groups:
                groups[group] = parser.add_mutually_exclusive_group()
            groups[group].add_argument(*names, **own)
        parser.set_defaults(command=self.run)


def subcommand(name: str, words: str, *arguments: Argument) -> Callable[[Callable[[Options], int]], Command]:
    """Make a command of the function below."""
    return lambda run: Command(name, words, arguments, run)
