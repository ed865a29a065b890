"""The command ``view``: a result as a moving 3-D view in a browser."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from trbdyn.base.own_files import file_path, output_path
from trbdyn.cli.declared import FILE, Options, argument, subcommand
from trbdyn.cli.outcome import say

if TYPE_CHECKING:
    from trbdyn.results.result import Result


@subcommand(
    "view",
    "show a result as a moving 3-D view in a browser",
    FILE,
    argument("-o --output", "HTML file to write (default: FILE without its ending, + _view.html)", "HTML"),
    argument("--revolutions", "last turns of the shaft to show (default 10); 0: all", "N", type=float, default=10.0),
    argument("--frames", "most records to take (default 600)", "N", type=int, default=600),
    argument("--max-size", "largest size of the file (default 12 MB)", "MB", type=float, default=12.0),
    argument("--exaggeration", "factor by which motion and clearances are drawn larger at the start", "X", type=float),
    argument("--gltf", "also write an animated glTF file (its last 2 turns of the shaft)", "GLB"),
    argument("--overwrite", "replace these files if they are there"),
    argument("--no-open", "write the file, open no browser"),
)
def view(options: Options) -> int:
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
