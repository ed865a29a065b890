"""Whether the energy adds up: closures of the energy audit over speed, load, preset and effects.

    python benchmarks/closures.py [--quick] [--json FILE] [--jobs N]
    python benchmarks/closures.py --write      writes benchmarks/closures.md and its picture as well

The 30310 at 0.01 to 30 000 rpm, axial loads 500 to 20 000 N and radial loads of 0.5 and 1.5 times that under which the first
roller loses its load, in two directions; each with every preset, with the effects of the paper and the usual ones, from equal
spacing and from a whirling cage. A run is as long as 3000 steps or three turns of the shaft, whichever is shorter.

Two measures of closure are given. Both are the residual of the audit (work put in, less losses, less growth of kinetic and
elastic energy). `closure` is the residual over the energy turned over, as the watch over every run measures it
(`trbdyn.run.watch`): half the sum of all changes of works, losses and stored energies between 100 records; an exchange below
1e-3 of the stored energy counts as this share. `closure_dissipated` is the residual over the losses alone, `energy_closure`
of a result: where hardly anything was lost yet, it is large without being wrong.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing as mp
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import common
from closure import grid
from closure.page import draw, page, results, worst

COLUMNS = {
    "speed_rpm": "rpm: speed of the shaft",
    "axial_load": "N: axial load",
    "radial_load": "N: radial load",
    "radial_share": "1: radial load over that under which the first roller loses its load",
    "direction_deg": "deg: direction of the radial load",
    "load": "text: the load in short",
    "effects": "text: preset of the effects, with 8 Gauss nodes a contact",
    "preset": "text: preset of the accuracy",
    "start": "text: equal spacing, or a whirling cage (0.9 Cpr)",
    "status": "text: done, ended (by the watch), refused (no such equilibrium) or error",
    "message": "text: why it ended",
    "time_s": "s: bearing time of the run",
    "turns": "1: turns of the shaft",
    "steps": "1: steps of the integrator",
    "mean_step_s": "s: mean step of the second half of the steps",
    "repeated_share": "1: repeated steps over steps",
    "closure": "1: residual of the energy over the energy turned over, as the watch measures it",
    "closure_dissipated": "1: residual of the energy over the losses, energy_closure of a result",
    "residual_j": "J: work less losses less growth of the stored energy, over the run",
    "largest_residual_j": "J: largest size of the residual at any record",
    "dissipated_j": "J: losses over the run",
    "turned_over_j": "J: energy turned over in the run",
    "loss_w": "W: mean power loss",
    "warnings": "list: what the watch over the run said",
    "cpu_s": "s: processor time of the point, two runs",
    "largest": "object: largest closures by preset",
    "bad": "list: runs that are findings, and why",
}


@dataclass(frozen=True)
class Plan:
    """How much is run: the grid, steps and turns of a run at most."""

    points: tuple[grid.Point, ...]
    steps: int
    turns: float


FULL = Plan(tuple(grid.points()), 3000, 3.0)
QUICK = Plan(
    tuple(
        grid.points(
            speeds=(0.01, 10.0, 100.0, 3000.0, 30_000.0),
            axial=(500.0, 4930.0),
            shares=(1.5,),
            directions=(90.0,),
            starts=("equal",),
        )
    ),
    1500,
    2.0,
)
SMOKE = Plan((grid.Point(3000.0, 4930.0, 0.0, 90.0, "paper", "standard", "whirl"),), 200, 1.0)


def measured(plan: Plan, jobs: int) -> Iterator[dict[str, Any]]:
    """Rows of every point, as they come."""
    count = len(plan.points)
    rest = [plan.steps] * count, [plan.turns] * count
    if jobs == 1:
        yield from map(grid.measure, plan.points, *rest)
        return
    with ProcessPoolExecutor(jobs, mp_context=mp.get_context("spawn")) as pool:
        yield from pool.map(grid.measure, plan.points, *rest, chunksize=4)


def run(plan: Plan, options: argparse.Namespace) -> common.Report:
    """Everything."""
    report = common.Report("closures", options, COLUMNS)
    bad = []
    for done, row in enumerate(measured(plan, options.jobs), 1):
        report.add(**row)
        why = grid.is_bad(row)
        if why is not None:
            bad.append({name: row[name] for name in ("speed_rpm", "load", "effects", "preset", "start")} | {"why": why})
            text = ", ".join(f"{value}" for value in bad[-1].values())
            print(f"  {text}", flush=True)
            if options.bad is not None:
                with options.bad.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(common.plain(row | {"why": why})) + "\n")
        if done % 96 == 0:
            print(f"  {done} of {len(plan.points)}", flush=True)
    report.summary["bad"] = bad
    report.summary["largest"] = worst(report.results)
    report.inputs = {"steps": plan.steps, "turns": plan.turns, "points": len(plan.points)}
    return report


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--steps", type=int, help="steps of a run at most, instead of the plan's")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--write", action="store_true", help="write the page and its picture")
    parser.add_argument(
        "--from-json", type=Path, metavar="FILE", help="measure nothing, take the results of such a file"
    )
    parser.add_argument("--bad", type=Path, metavar="FILE", help="append every finding to a file, a line of JSON each")
    options = parser.parse_args(arguments)
    plan = SMOKE if options.smoke else QUICK if options.quick else FULL
    if options.from_json is None:
        report = run(replace(plan, steps=options.steps) if options.steps else plan, options)
    else:
        report = common.Report("closures", options, COLUMNS)
        report.take(options.from_json)
    text = page(report)
    print("\n" + text)
    report.readme = results(report)
    if options.write:
        (common.HERE / "closures.md").write_text(report.stamped(text), encoding="utf-8")
        print("wrote benchmarks/closures.md")
    if options.write and not options.no_picture:
        common.save_picture(draw(report), "closures")
    report.finish()
    return report


if __name__ == "__main__":
    main()
