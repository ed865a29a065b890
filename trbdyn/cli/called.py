"""How the program was called, so that what it advises can be typed as it stands."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from pathlib import Path


def command(*words: object) -> str:
    """A command of trbdyn for the shell that called this one: ``.venv/bin/python -m trbdyn resume run.h5``."""
    return shlex.join([*program(), *map(str, words)])


def program() -> list[str]:
    """The program's own words: the script `trbdyn` if that was called, else this Python with ``-m trbdyn``."""
    called = Path(sys.argv[0] or "-")
    if called.name == "trbdyn" and called.is_file():
        return [_typed(called)]
    return [_typed(Path(sys.executable)), "-m", "trbdyn"]


def _typed(path: Path) -> str:
    """A program as it is typed: by its name where the shell finds it so, below this folder without what leads to it."""
    absolute = Path(os.path.abspath(path))  # links stay: the Python of an environment is a link to another one
    found = shutil.which(path.name)
    if found is not None and os.path.abspath(found) == str(absolute):
        return path.name
    here = Path.cwd()
    return str(absolute.relative_to(here)) if absolute.is_relative_to(here) else str(absolute)
