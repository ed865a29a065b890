"""The command ``app``: a page in the browser, on this machine, to choose, run and look without programming."""

from __future__ import annotations

from pathlib import Path

from trbdyn.cli.declared import Options, argument, subcommand
from trbdyn.cli.outcome import DONE


@subcommand(
    "app",
    "a page in the browser: choose a bearing, run it, see results, without programming",
    argument("--port", "port on this machine (default: any that is free)", "N", type=int, default=0),
    argument("--no-browser", "print the address, open no browser"),
    argument("--folder", "keeps what was typed and all runs (default: trbdyn_app in your home folder)", "FOLDER"),
)
def app(options: Options) -> int:
    """Serve a page for the browser of this machine: choose a bearing, run it, see results, without programming. Nothing
    leaves this machine. Needs the extra: pip install 'trbdyn[app]', or '.[app]' in a folder with the sources.
    """
    from trbdyn.base.extras import of_extras
    from trbdyn.base.own_files import folder_path

    of_extras("need_nicegui")()

    folder = Path.home() / "trbdyn_app" if options.folder is None else folder_path(options.folder, "--folder")
    of_extras("serve")(folder.absolute(), port=options.port, browser=not options.no_browser)
    return DONE
