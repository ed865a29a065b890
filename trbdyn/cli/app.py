"""The command ``app``: a page in the browser, on this machine, to choose, run and look without programming."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from trbdyn.cli.outcome import DONE


def add_app_parser(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    """Add the command ``app``."""
    app = commands.add_parser(
        "app",
        parents=[*parents],
        help="a page in the browser: choose a bearing, run it, see results, without programming",
        description="Serve a page for the browser of this machine: choose a bearing, run it, see results, without programming. "
        "Nothing leaves this machine. Needs the extra: pip install 'trbdyn[app]'.",
    )
    app.add_argument(
        "--port", type=int, default=0, metavar="N", help="port on this machine (default: any that is free)"
    )
    app.add_argument("--no-browser", action="store_true", help="print the address, open no browser")
    app.add_argument(
        "--folder", metavar="FOLDER", help="keeps what was typed and all runs (default: trbdyn_app in your home folder)"
    )
    app.set_defaults(command=_app)


def _app(options: argparse.Namespace) -> int:
    from trbdyn.app import need_nicegui
    from trbdyn.base.own_files import folder_path

    need_nicegui()
    from trbdyn.app.server import serve

    folder = Path.home() / "trbdyn_app" if options.folder is None else folder_path(options.folder, "--folder")
    serve(folder.absolute(), port=options.port, browser=not options.no_browser)
    return DONE
