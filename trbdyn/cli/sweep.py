"""The subcommand ``sweep``: run a study from a TOML file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trbdyn.cli.called import command
from trbdyn.cli.declared import Options, argument, subcommand
from trbdyn.cli.outcome import DONE, FAILED, INTERRUPTED, say

if TYPE_CHECKING:
    import xarray


@subcommand(
    "sweep",
    "run a parameter study",
    argument("study", "a TOML file, or the name of a shipped study", "STUDY"),
    argument("-o --output", "folder (default: STUDY without its ending)", "FOLDER"),
    argument("--workers", "worker processes (default, and at most: the cores)", "N", type=int),
    argument("--again", "run cases again that are done"),
    argument("--quiet", "no progress bar, no table"),
)
def sweep(options: Options) -> int:
    """Run a parameter study from a TOML file."""
    from trbdyn import study as studies

    study = studies.load_study(options.study)
    folder = Path(options.study).stem if options.output is None else options.output
    try:
        data = studies.run(study, folder, workers=options.workers, resume=not options.again, progress=not options.quiet)
    except KeyboardInterrupt:
        again = command(*(word for word in options.words if word != "--again"))
        say(
            f"trbdyn: stopped; the cases that are done are kept in {folder}. Go on with the others: {again}",
            file=sys.stderr,
        )
        return INTERRUPTED
    failed = int((data.status != "done").sum())
    if not options.quiet:
        say(table(data))
        say(f"\n{data.status.size} cases, results and observables.nc in {folder}")
    for line in problems(data):
        say(f"trbdyn: {line}", file=sys.stderr)
    return FAILED if failed else DONE


def problems(data: xarray.Dataset) -> list[str]:
    """What the cases that failed say, one line each."""
    rows = data[["status", "message"]].to_dataframe()
    bad = rows[rows["status"] != "done"]
    return [
        f"{where}: {str(message).splitlines()[0] if message else 'not run'}"
        for where, message in bad["message"].items()
    ]


def table(data: xarray.Dataset) -> str:
    """Parameters and some observables as a table for people."""
    from trbdyn.extras.study.gather import listed_in

    shown = ["status", *listed_in(data, "sweep")]
    parameters = [str(dim) for dim in data.dims if dim in data.coords and dim != "case"]
    parameters += [str(name) for name in data.coords if name not in parameters and data[name].dims == ("case",)]
    frame = data[shown].to_dataframe().reset_index()
    frame = frame[[name for name in parameters if name in frame and name != "case"] + shown]
    rows = [
        [str(name) for name in frame.columns],
        *([_text(value) for value in row] for row in frame.itertuples(index=False)),
    ]
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows)


def _text(value: Any) -> str:
    if isinstance(value, float):
        return "-" if value != value else f"{value:.5g}"
    return str(value) or "-"
