"""The command: run the study, compare, draw, write."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from paper.sensitivity import effects, plan, report
from paper.sensitivity.indicators import OBSERVABLES
from trbdyn.errors import FileError, InputError

DONE, FAILED = 0, 1
JSON, TABLES, RUNS = "sensitivity.json", "tables.md", "runs"
LEAST_PICTURE: Final = 2
"""Nominal seeds without which there is no noise to draw."""


def parser() -> argparse.ArgumentParser:
    """The command line."""
    made = argparse.ArgumentParser(
        prog="python benchmarks/paper/sensitivity",
        description="Sensitivity of the cage's motion to the inputs that the paper does not give. A seed is about 400 runs, "
        "ten minutes of one core's time and 1.7 GB; runs that are in the folder already are not run again.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    made.add_argument("-o", "--output", metavar="FOLDER", default="sensitivity", help="folder")
    made.add_argument("--seeds", type=int, default=2, metavar="N", help="seeds of each level")
    made.add_argument(
        "--points", nargs="+", default=[], metavar="NAME", help="operating points (all, if none is given)"
    )
    made.add_argument("--inputs", nargs="+", default=[], metavar="NAME", help="inputs (all, if none is given)")
    made.add_argument(
        "--quick", action="store_true", help="a check of everything in a minute: too short to tell anything"
    )
    made.add_argument("--report", action="store_true", help="run nothing: compare what is there")
    made.add_argument("--json", type=Path, metavar="FILE", help="another place for the JSON file")
    made.add_argument("--workers", type=int, metavar="N", help="worker processes (default, and at most: the cores)")
    made.add_argument("--quiet", action="store_true", help="no progress bar, no tables")
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 0 if no run failed."""
    made = parser()
    options = made.parse_args(arguments)
    try:
        chosen = plan_of(options)
    except InputError as error:
        made.error(str(error))
    values = run(
        chosen,
        Path(options.output),
        options.json,
        run_cases=not options.report,
        workers=options.workers,
        progress=not options.quiet,
    )
    if not options.quiet:
        print((Path(options.output) / TABLES).read_text(encoding="utf-8"))
        print(
            f"{values['runs']['done']} of {values['runs']['planned']} runs; tables, JSON and pictures in {options.output}"
        )
    return FAILED if values["runs"]["failed"] else DONE


def plan_of(options: argparse.Namespace) -> plan.Plan:
    """The plan that was asked for.

    Raises
    ------
    InputError
        If there is no such point or input, or no seed.
    """
    if options.seeds < 1:
        raise InputError.of("seeds", options.seeds, "must be at least 1")
    made = plan.Plan.quick() if options.quick else plan.Plan.full(options.seeds)
    names = [entry.name for entry in made.inputs]
    for name in options.inputs:
        if name not in names:
            raise InputError.of("inputs", name, f"must be among {', '.join(names)}")
    kept = tuple(entry for entry in made.inputs if not options.inputs or entry.name in options.inputs)
    return replace(made, places=plan.chosen(made.places, options.points), inputs=kept)


def run(
    chosen: plan.Plan,
    folder: Path,
    json_file: Path | None = None,
    *,
    run_cases: bool = True,
    workers: int | None = None,
    executor: Any = "processes",
    progress: bool = False,
) -> dict[str, Any]:
    """Run a plan and write tables, pictures and JSON.

    Parameters
    ----------
    chosen : Plan
        What is run.
    folder : Path
        Where everything goes; runs into its folder ``runs``.
    json_file : Path, optional
        Another place for the JSON file.
    run_cases : bool
        Run what is missing; else take what is there.
    workers : int, optional
        Number of workers.
    executor : object
        As in `trbdyn.study.run`.
    progress : bool
        Show a progress bar.

    Returns
    -------
    dict
        What the JSON file holds, see `paper.sensitivity.report`.

    Raises
    ------
    FileError
        If something cannot be written.
    """
    from paper.sensitivity.picture import tornado
    from trbdyn import plot
    from trbdyn.extras.study.runner import collect
    from trbdyn.extras.study.runner import run as run_study
    from trbdyn.results.summary import write_json

    made = plan.study(chosen)
    if run_cases:
        data = run_study(
            made,
            folder / RUNS,
            executor=executor,
            workers=workers,
            observables=OBSERVABLES,
            progress=progress,
        )
    else:
        data = collect(made, folder / RUNS)
    runs = effects.runs_of(data)
    nominal = {place.name: effects.nominals(runs, place.name) for place in chosen.places}
    found, judged = effects.effects(runs, chosen), effects.judge(runs, chosen)
    values = report.to_dict(chosen, data, nominal, found, judged)
    plot.make_folder(folder)
    write_json(values, json_file or folder / JSON, overwrite=True)
    try:
        (folder / TABLES).write_text(report.markdown(chosen, nominal, found, judged), encoding="utf-8")
    except OSError as error:
        raise FileError(f"{folder / TABLES}: cannot be written: {error.strerror}") from error
    for place in chosen.places:
        table = nominal[place.name]
        if table and all(value.count >= LEAST_PICTURE for value in table.values()):
            figure = tornado(place, table, found, chosen.inputs)
            plot.save(figure, folder / f"sensitivity_{place.name}.png", overwrite=True)
    return values
