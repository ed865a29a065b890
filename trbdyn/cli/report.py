"""The command ``report``: one HTML file of a run, or of two side by side."""

from __future__ import annotations

from pathlib import Path

from trbdyn.cli.declared import FILE, Options, argument, subcommand
from trbdyn.cli.outcome import say


@subcommand(
    "report",
    "write a report of a run, or of two side by side",
    FILE,
    argument("other", "a second result file to compare with", "OTHER", nargs="?"),
    argument("-o --output", "HTML file to write (default: FILE without its ending, + _report.html)", "HTML"),
    argument("--pdf", "also write a PDF (needs Chromium)"),
    argument("--overwrite", "replace the report if it is there"),
    argument("--title", "title", "TEXT", default=""),
)
def report(options: Options) -> int:
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
