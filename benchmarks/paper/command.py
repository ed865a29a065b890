"""The command: run the paper's operating points, draw its figures, judge its statements."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from contextlib import closing
from dataclasses import asdict, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from common import defaults_mark, revision
from tqdm import tqdm

from paper.figures import draw_all, movable_limits
from paper.keep import keep
from paper.point_numbers import Runs, read_run
from paper.points import DIRECTION, STARTS, Inputs, Point, points
from paper.settle import Plan, PointTask, is_done, is_there, run_point
from paper.statements import NAMED, by_inputs, judge_all, judge_inputs, markdown
from trbdyn import __version__, plot
from trbdyn.base.own_files import folder_path
from trbdyn.cli.outcome import DONE, FAILED, Parser, let_any_name_be_printed, run_command
from trbdyn.errors import FileError, InputError
from trbdyn.extras.study.executors import execute
from trbdyn.extras.study.work import said
from trbdyn.model.motion import MAX_TIME
from trbdyn.results.summary import clean, write_json

SCHEMA: Final = "trbdyn-paper-2"
SHORT: Final = (
    *(Inputs(direction) for direction in (0.0, 90.0, 180.0, -90.0)),
    *(Inputs(180.0, scatter) for scatter in (0.2e-6, 1e-6)),
)
"""Directions and scatters of ``--quick``."""
POINTS, FIGURES, NUMBERS, TABLE = "points", "figures", "paper.json", "statements.md"


def parser() -> argparse.ArgumentParser:
    """The command line."""
    paper = Parser(
        prog="python benchmarks/paper",
        description="Run the operating points of Sakaguchi and Harada 2006 until they settle, draw the paper's figures and judge "
        "its statements. Without further options that is about three dozen points of 3 to 60 s of bearing time each.",
    )
    paper.add_argument("-o", "--output", metavar="FOLDER", default="paper", help="folder (default: paper)")
    paper.add_argument(
        "--points",
        nargs="+",
        default=[],
        metavar="NAME",
        help="points or conditions, with * and ?, for instance '3000rpm_*'; 'all': every speed with every load",
    )
    paper.add_argument(
        "--starts", nargs="+", choices=("equal", "unequal", "whirl"), metavar="START", help="equal, unequal, whirl"
    )
    paper.add_argument(
        "--seeds", nargs="+", type=int, default=[0], metavar="N", help="seeds of spacing and scatter (default: 0)"
    )
    paper.add_argument(
        "--directions",
        nargs="+",
        type=float,
        default=[DIRECTION],
        metavar="DEG",
        help="directions of the radial load from +x towards +y; gravity acts along -y (default: 90)",
    )
    paper.add_argument(
        "--scatters",
        nargs="+",
        type=float,
        default=[0.0],
        metavar="UM",
        help="widths of the range of roller diameters in um (default: 0)",
    )
    paper.add_argument(
        "--quick",
        action="store_true",
        help="the statements from equal spacing with four directions and three scatters, 1 s of bearing time each",
    )
    paper.add_argument("--smoke", action="store_true", help="a check of everything in a minute: nothing settles")
    paper.add_argument("--min-time", type=float, metavar="S", help="shortest bearing time before the statistics")
    paper.add_argument("--max-time", type=float, metavar="S", help="longest bearing time before the statistics")
    paper.add_argument(
        "--resume",
        action="store_true",
        help="skip points that are done, go on with those that had not settled or were stopped",
    )
    paper.add_argument(
        "--early",
        metavar="FOLDER",
        help="folder of points that were run with --min-time 0.5 --max-time 0.5, as far as the paper could: a column beside",
    )
    paper.add_argument(
        "--into",
        metavar="FILE",
        type=Path,
        help="run nothing: add the points that are there to the paper.json of an earlier campaign, and judge all again",
    )
    paper.add_argument("--report", action="store_true", help="run nothing: figures and table of what is there")
    paper.add_argument("--workers", type=int, metavar="N", help="worker processes (default, and at most: the cores)")
    paper.add_argument("--quiet", action="store_true", help="no progress bar, no table")
    paper.add_argument("--debug", action="store_true", help="show where an error arose")
    return paper


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; exit codes as those of ``python -m trbdyn``."""
    let_any_name_be_printed()
    return run_command(run_paper, parser().parse_args(arguments))


def run_paper(options: argparse.Namespace) -> int:
    """Run the points and report; the exit code is 0 if none failed."""
    folder = folder_path(options.output, "output")
    for name, time in (("max_time", options.max_time), ("min_time", options.min_time)):
        if time is not None and not 0.0 < time <= MAX_TIME:
            raise InputError.of(name, time, f"must be above 0 and at most {MAX_TIME:g} (s)")
    if options.workers is not None and options.workers < 1:
        raise InputError.of("workers", options.workers, "must be at least 1")
    if not all(0 <= seed < 2**63 for seed in options.seeds):
        raise InputError.of("seeds", options.seeds, "must be whole numbers from 0 on, of less than 64 bits")
    plan = _plan(options)
    chosen = _chosen(options)
    failures: dict[str, str] = {}
    if not options.report and options.into is None:
        failures = run_points(chosen, folder, plan, options.workers, resume=options.resume, progress=not options.quiet)
    runs = read_runs(folder)
    if not runs.all:
        why = next(iter(failures.values()), "").partition("\n")[0]
        raise FileError(f"{folder}: holds no points to report on{f'; the first that failed: {why}' if why else ''}")
    if options.into is not None:
        print(keep(options.into, runs))
        return DONE
    early = None if options.early is None else read_runs(folder_path(options.early, "early"))
    text = report(runs, folder, plan, failures, early)
    if not options.quiet:
        print(text)
        print(f"points, figures, {NUMBERS} and {TABLE} in {folder}")
    for name, message in failures.items():
        print(f"trbdyn: {name}: {message.splitlines()[0]}", file=sys.stderr)
    return FAILED if failures else DONE


def _chosen(options: argparse.Namespace) -> tuple[Point, ...]:
    """The points that the options ask for."""
    asked = [Inputs(direction, 1e-6 * scatter) for direction in options.directions for scatter in options.scatters]
    if options.quick and asked == [Inputs()]:
        return points(options.points, options.starts or STARTS[:1], options.seeds, SHORT)
    return points(options.points, options.starts or STARTS, options.seeds, asked)


def _plan(options: argparse.Namespace) -> Plan:
    plan = Plan.smoke() if options.smoke else Plan.quick() if options.quick else Plan()
    if options.max_time is not None:
        plan = replace(plan, most_time=options.max_time, most_time_combined=options.max_time)
        plan = replace(
            plan,
            least_time=min(plan.least_time, options.max_time),
            least_time_combined=min(plan.least_time_combined, options.max_time),
        )
    if options.min_time is not None:
        plan = replace(plan, least_time=options.min_time, least_time_combined=options.min_time)
    return plan


def run_points(
    chosen: Sequence[Point],
    folder: Path,
    plan: Plan,
    workers: int | None = None,
    *,
    resume: bool = False,
    progress: bool = False,
    executor: Any = "processes",
) -> dict[str, str]:
    """Run points side by side, the longest first.

    Parameters
    ----------
    chosen : sequence of Point
        What to run.
    folder : Path
        Each point gets a file in its folder ``points``.
    plan : Plan
        How long, how fine.
    workers : int, optional
        Number of workers.
    resume : bool
        Skip points that are done, go on with those that are not.
    progress : bool
        Show a progress bar.
    executor : object
        As in `trbdyn.study.run`.

    Returns
    -------
    dict of str to str
        Points that failed, and why.

    Raises
    ------
    InputError
        If there are such points already, and `resume` is not set.
    FileError
        If the folder cannot be made.
    """
    place = folder / POINTS
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{place}: the folder cannot be made: {error.strerror}") from error
    tasks = [PointTask(point, plan, str(place.absolute() / f"{point.name}.h5")) for point in chosen]
    if resume:
        tasks = [task for task in tasks if not is_done(task)]
    elif any(is_there(Path(task.path)) for task in tasks):
        raise InputError.of(
            "output", str(folder), "holds some of these points; give --resume to go on, or another folder"
        )
    tasks.sort(key=lambda task: -plan.limits(task.point)[1] * task.point.condition.speed_rpm)
    failures: dict[str, str] = {}
    with (
        tqdm(total=len(chosen), initial=len(chosen) - len(tasks), disable=not progress, unit="point") as bar,
        closing(execute(run_point, tasks, executor, workers)) as outcomes,
    ):
        for outcome in outcomes:
            name = outcome.task.point.name
            message = said(outcome.error) if outcome.error is not None else outcome.value.message
            if outcome.error is not None or outcome.value.status == "failed":
                failures[name] = message
            bar.set_postfix_str(f"{name}: {message.splitlines()[0][:40]}", refresh=False)
            bar.update()
    return failures


def read_runs(folder: Path) -> Runs:
    """Every point in a folder.

    Raises
    ------
    FileError
        If a file is damaged.
    """
    found = [read_run(path) for path in sorted((folder / POINTS).glob("[!.]*.h5"))]
    return Runs([run for run in found if run is not None])


def report(runs: Runs, folder: Path, plan: Plan, failures: dict[str, str], early: Runs | None = None) -> str:
    """Write figures, ``paper.json`` and the table of statements; gives the table.

    Raises
    ------
    FileError
        If something cannot be written.
    """
    pictures = plot.make_folder(folder / FIGURES)
    sets = {inputs: judge_inputs(runs, inputs) for inputs in runs.inputs}
    every, runs = runs, runs.within(NAMED if NAMED in sets and Inputs() not in sets else Inputs())
    limits = movable_limits(runs)
    judged = judge_all(runs, limits)
    draw_all(runs, pictures, limits)
    then = [] if early is None else judge_all(early)
    table = markdown(judged, then) + (f"\n{by_inputs(sets)}" if len(sets) > 1 else "")
    movable = {
        name: {"min": float(found.distance.min()), "max": float(found.distance.max())}
        for name, found in (("equal", limits.equal), ("free", limits.free))
    }
    values = {
        "schema": SCHEMA,
        "trbdyn_version": __version__,
        "revision": revision(),
        "defaults": defaults_mark(),
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "plan": asdict(plan),
        "assumptions": "cases.rig_30310, VG100 at 60 C, Effects.paper() with 8 Gauss nodes a contact, the same for all points",
        "points": {run.point.name: run.numbers for run in every.all},
        "failed": failures,
        "movable_over_cpr": movable,
        "statements": [entry.to_dict() for entry in judged],
        "statements_by_inputs": {inputs.name: [entry.to_dict() for entry in found] for inputs, found in sets.items()},
        "statements_from_half_a_second_to_one": [entry.to_dict() for entry in then],
    }
    write_json(json.loads(json.dumps(clean(values))), folder / NUMBERS, overwrite=True)
    try:
        (folder / TABLE).write_text(table, encoding="utf-8")
    except OSError as error:
        raise FileError(f"{folder / TABLE}: cannot be written: {error.strerror}") from error
    return table
