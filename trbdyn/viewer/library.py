"""Finds three.js, the 3-D library of the view, in the installed package that carries it."""

from __future__ import annotations

import importlib.util
import re
import sys
from functools import cache
from pathlib import Path

from trbdyn.errors import FileError

PACKAGE = "jupyter_threejs_sage"


@cache
def three_js() -> str:
    """The text of three.js with its orbit controls, a classic script that defines ``THREE``."""
    for folder in _folders():
        versions = {
            int(match[1]): path
            for path in folder.glob("r*/three.min.js")
            if (match := re.fullmatch(r"r(\d+)", path.parent.name))
        }
        if versions:
            return versions[max(versions)].read_text(encoding="utf-8")
    raise FileError(
        "the 3-D view needs three.js: install the package jupyter-threejs-sage (on conda-forge: threejs-sage)"
    )


def _folders() -> list[Path]:
    """Where packages put it: inside the Python package, or among the shared files of Jupyter."""
    spec = importlib.util.find_spec(PACKAGE)
    inside = [Path(place) / "static" for place in (spec.submodule_search_locations or ())] if spec else []
    return [*inside, Path(sys.prefix) / "share" / "jupyter" / "nbextensions" / "threejs-sage"]
