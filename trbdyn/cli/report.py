"""The command ``report``: one HTML file of a run, or of two side by side."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from trbdyn.cli.outcome import say


def add_report_parser(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    """Add the command ``report``."""
    report = commands.add_parser("report", parents=[*parents], help="write a report of a run, or of two side by side")
    report.add_argument("file", metavar="FILE", help="a result file")
    report.add_argument("other", metavar="OTHER", nargs="?", help="a second result file to compare with")
    report.add_argument(
        "-o", "--output", metavar="HTML", help="HTML file to write (default: FILE without its ending, + _report.html)"
    )
    report.add_argument("--pdf", action="store_true", help="also write a PDF (needs Chromium)")
    report.add_argument("--overwrite", action="store_true", help="replace the report if it is there")
    report.add_argument("--title", default="", metavar="TEXT", help="title")
    report.set_defaults(command=_report)


def _report(options: argparse.Namespace) -> int:
    from trbdyn.reporting import report
    from trbdyn.results.assembly import load

    output = Path(options.output or f"{Path(options.file).with_suffix('')}_report.html")
    names = [Path(name).stem for name in (options.file, options.other or "second")]
    if names[0] == names[1]:
        names = [str(options.file), str(options.other)]
    other = load(options.other) if options.other else None
    how = {"names": names, "title": options.title, "pdf": options.pdf, "overwrite": options.overwrite}
    say(report(load(options.file), output, other=other, **how))
    if options.pdf:
        say(output.with_suffix(".pdf"))
    return 0
