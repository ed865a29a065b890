"""The commands ``cases`` and ``new``: the cases that ship, and a case to begin with."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from trbdyn.cli.case import case_with_changes
from trbdyn.cli.outcome import DONE
from trbdyn.errors import FileError, InputError


def add_case_parsers(commands: Any, common: Sequence[argparse.ArgumentParser]) -> None:
    """Add the commands ``cases`` and ``new``."""
    cases = commands.add_parser("cases", parents=[*common], help="list the cases that ship with the package")
    cases.add_argument(
        "--print", dest="name", metavar="NAME", help="print this case with every number and what it means"
    )
    cases.set_defaults(command=_cases)

    new = commands.add_parser(
        "new", parents=[*common], help="write a case with every number, to change for your own bearing"
    )
    new.add_argument("file", metavar="FILE", help="a TOML file that does not exist yet")
    new.add_argument("--case", default="rig_30310", metavar="NAME", help="the case to begin with (default: rig_30310)")
    new.set_defaults(command=_new)


def _new(options: argparse.Namespace) -> int:
    from trbdyn.run.case_text import case_text

    path = Path(options.file)
    if path.suffix != ".toml":
        raise InputError.of("FILE", options.file, "must end in .toml")
    text = case_text(*case_with_changes(options.case, ()), title=f"Begun from the case {options.case}.")
    try:
        with path.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError:
        raise FileError(f"{path}: exists already; choose another name, nothing was written") from None
    except OSError as error:
        raise FileError(f"{path}: {error.strerror or error}") from None
    print(f"{path} written: change its numbers, then run it with: trbdyn run {path}")
    return DONE


def _cases(options: argparse.Namespace) -> int:
    from trbdyn.run.case_text import case_text
    from trbdyn.run.toml_case import find_case, shipped_cases

    if options.name is not None:
        first = find_case(options.name).read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
        print(case_text(*case_with_changes(options.name, ()), title=first), end="")
        return DONE
    for name in shipped_cases():
        first = find_case(name).read_text(encoding="utf-8").partition("\n")[0]
        print(f"{name:<16} {first.lstrip('# ')}")
    return DONE
