"""A page in the browser, on the own machine: choose a bearing, run it, see results, without programming (`trbdyn app`).

It is built on NiceGUI, the extra ``trbdyn[app]``. The page holds no physics: a `Design` is what was typed, its tables are those
of a case file, and tasks in processes of their own call the functions that a program would call.
"""

from __future__ import annotations

from importlib.util import find_spec

from trbdyn.errors import MissingExtra

__all__ = ["need_nicegui"]


def need_nicegui() -> None:
    """Check that the page can be made."""
    if find_spec("nicegui") is None:
        words = "pip install 'trbdyn[app]', or '.[app]' in a folder with the sources"
        raise MissingExtra(f"the page needs NiceGUI, which is not installed: {words}")
