"""The command ``view``: a result as a moving 3-D view in a browser."""

from __future__ import annotations

import argparse
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trbdyn.base.own_files import file_path, output_path
from trbdyn.cli.outcome import say

if TYPE_CHECKING:
    from trbdyn.results.result import Result


def add_view_parser(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    """Add the command ``view``."""
    view = commands.add_parser("view", parents=[*parents], help="show a result as a moving 3-D view in a browser")
    view.add_argument("file", metavar="FILE", help="a result file")
    view.add_argument(
        "-o", "--output", metavar="HTML", help="HTML file to write (default: FILE without its ending, + _view.html)"
    )
    view.add_argument(
        "--revolutions",
        type=float,
        default=10.0,
        metavar="N",
        help="last turns of the shaft to show (default 10); 0: all",
    )
    view.add_argument("--frames", type=int, default=600, metavar="N", help="most records to take (default 600)")
    view.add_argument(
        "--max-size", type=float, default=12.0, metavar="MB", help="largest size of the file (default 12 MB)"
    )
    view.add_argument(
        "--exaggeration",
        type=float,
        metavar="X",
        help="factor by which motion and clearances are drawn larger at the start",
    )
    view.add_argument("--gltf", metavar="GLB", help="also write an animated glTF file (its last 2 turns of the shaft)")
    view.add_argument("--overwrite", action="store_true", help="replace these files if they are there")
    view.add_argument("--no-open", action="store_true", help="write the file, open no browser")
    view.set_defaults(command=_view)


def _view(options: argparse.Namespace) -> int:
    from trbdyn.results.assembly import load
    from trbdyn.viewer import save_gltf, view

    result = load(options.file)
    output = Path(options.output or f"{Path(options.file).with_suffix('')}_view.html")
    moving: dict[Path, Result] = {}
    if options.gltf:
        path = file_path(options.gltf, "gltf")
        for name, one in result.by_name.items():
            moving[path.with_name(f"{path.stem}.{name}{path.suffix}") if name else path] = one
        for path in moving:
            output_path(path, overwrite=options.overwrite, field="gltf")
    view(
        result,
        output,
        revolutions=options.revolutions or None,
        max_frames=options.frames,
        max_size_mb=options.max_size,
        exaggeration=options.exaggeration,
        overwrite=options.overwrite,
    )
    say(f"{output}: open it in a browser; it needs no network")
    for path, one in moving.items():
        say(save_gltf(one, path, exaggeration=options.exaggeration, overwrite=options.overwrite))
    if not options.no_open:
        webbrowser.open(output.resolve().as_uri())
    return 0
