"""Against what a user would pick instead: the same force model in NumPy under SciPy's and scikit-sundae's integrators.

The model (`numpy_model`) is checked against the core, then a whirling, colliding cage (30310, 4930 N, 3000 rpm) is run from
mid-collision states, at several tolerances, by every alternative and by the core. The error is that over a short window: the
largest distance of the cage's centre from a reference of the core's explicit method at far tighter tolerances, in units of
the radial play Cpr, as a geometric mean over the windows. The time is that of a turn of the shaft from the first of these
states; for the slowest alternatives both are of three windows. `ratio` is an alternative's time over that of the core's
standard integrator at equal error: the error of accuracy="standard", both interpolated in log-log; `ratio_low` and
`ratio_high` are the least and the largest of it from a third to three times that error.

Alternatives come twice: as their package offers them (pattern of the Jacobian, states in batches, limit of order, where it
takes these), and handed the core's idea of a Jacobian, written for NumPy: "our Jacobian". `best_ratio` is of the former,
`best_ratio_our_jacobian` of the latter.

Times are of the processor, so that other processes count little, and each is put in relation to a run of the core over the
same stretch just before and after it. Alternatives integrate the state without its tail (spin angles, energies), which spares
them something.
"""

from __future__ import annotations

import importlib.util
import sys
import time as clock
from collections.abc import Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

import common
from peer_cost.bench import AXIAL_LOAD, LENGTH, SPEED_RPM, Bench, Method, Point
from peer_cost.compare import compared, least
from peer_cost.methods import OURS, alternatives, own
from peer_cost.picture import draw

from trbdyn import Simulation
from trbdyn.run.options import ACCURACY

COLUMNS = {
    "name": "1: integrator, with the package it comes from",
    "model": "1: force model under it, 'numpy' or 'core'",
    "ratio": "1: its time over that of the core at equal error",
    "ratio_low": "1: least ratio at errors from a third to three times as large",
    "ratio_high": "1: largest ratio at errors from a third to three times as large",
    "us_per_evaluation": "us: time of one force evaluation",
    "us_per_jacobian": "us: time of one Jacobian; null where the integrator's own times are not known",
    "us_per_step": "us: time of the whole integration over its steps",
    "wall_s_per_revolution": "s: time per turn of the shaft at the error compared",
    "error_cage_over_cpr": "1: error of the cage's centre over Cpr at which it is compared",
    "steps": "1: steps per turn of the shaft at the error compared",
    "evaluations": "1: force evaluations per turn of the shaft, without those for Jacobians",
    "jacobians": "1: Jacobians per turn of the shaft",
    "points": "1: every tolerance measured: factor on the tolerances of 'standard', and the quantities above",
    "failure": "1: why it could not be measured, or null",
    "target_error_over_cpr": "1: error of accuracy='standard' of the core, at which ratios are taken",
    "jacobian": "text: the package's own or ours, handed to it; null for the core",
    "best_alternative": "1: alternative with the smallest ratio, of those that the packages offer",
    "best_ratio": "1: its ratio",
    "best_our_jacobian": "1: alternative with the smallest ratio, of those handed our Jacobian",
    "best_ratio_our_jacobian": "1: its ratio",
    "us_per_evaluation_numpy": "us: one force evaluation in NumPy, median over states of the windows",
    "us_per_evaluation_core": "us: one force evaluation of the core, called from Python",
    "difference_of_rates": "1: largest difference of NumPy's rates from the core's, over the forces that make them",
    "error_of_reference_over_cpr": "1: distance between the reference and one at tolerances ten times as large",
    "impacts": "1: contacts of rollers and cage that begin, per window",
    "floor": "estimate: operations of a force evaluation over measured rates; see numpy_model/floor.py",
}


def main(arguments: Sequence[str] | None = None) -> dict[str, Any]:
    """Run the benchmark."""
    parser = common.parser(__doc__)
    parser.add_argument("--slices", type=int, metavar="N", default=8, help="N slices along a contact, for all")
    options = parser.parse_args(arguments)
    report = common.Report("peers", options, COLUMNS)
    bench = Bench(options)
    difference = bench.check()
    print(f"NumPy's rates differ from the core's by {difference:.1e} of the forces that make them")
    if difference > 1e-9:
        raise SystemExit("the NumPy model does not give what the core gives")
    measured: list[tuple[Method, list[Point], str | None]] = []
    for method in [*own(bench), *alternatives(bench, options.quick, options.smoke)]:
        began = clock.perf_counter()
        points, failure = attempt(bench, method)
        measured.append((method, points, failure))
        print(f"  {method.name:40s} {clock.perf_counter() - began:6.1f} s  {failure or ''}", flush=True)
    costs = bench.costs()
    standard = measured[0][1]
    if not standard:
        raise SystemExit(f"the core could not be measured: {measured[0][2]}")
    target = next(point.error for point in standard if point.factor == 1.0)
    for method, points, failure in measured:
        bench.settle(points)
        row: dict[str, Any] = dict.fromkeys(
            ("ratio", "ratio_low", "ratio_high", "wall_s_per_revolution", "error_cage_over_cpr", "steps", "evaluations",
             "jacobians", "us_per_step", "us_per_jacobian")
        )  # fmt: skip
        if points:
            row |= compared(points, standard, target)
        row["us_per_evaluation"] = costs[method.model]
        ours = method.name.endswith(OURS)
        if ours:
            row["us_per_jacobian"] = costs["jacobian"]
        row["jacobian"] = None if method.model == "core" else "ours" if ours else "its own"
        listed = [vars(point) for point in points]
        report.add(name=method.name, model=method.model, points=listed, failure=failure, **row)

    best = {jacobian: _best(report.results, jacobian) for jacobian in ("its own", "ours")}
    report.summary = {
        "target_error_over_cpr": target,
        "best_alternative": best["its own"]["name"],
        "best_ratio": best["its own"]["ratio"],
        "best_our_jacobian": best["ours"]["name"],
        "best_ratio_our_jacobian": best["ours"]["ratio"],
        "us_per_evaluation_numpy": costs["numpy"],
        "us_per_evaluation_core": costs["core"],
        "us_per_jacobian": costs["jacobian"],
        "difference_of_rates": difference,
        "error_of_reference_over_cpr": max(window.uncertainty for window in bench.windows),
        "impacts": [window.impacts for window in bench.windows],
        "floor": least(bench, report.results[0], costs["core"]),
    }
    report.inputs = {
        "scene": f"30310, {SPEED_RPM:g} rpm, {AXIAL_LOAD:g} N, effects of the paper, cage whirling at 0.9 Cpr",
        "nodes": f"{bench.scene.effects.n_slices} {bench.scene.effects.quadrature}",
        "windows": [float(window.times[0]) for window in bench.windows],
        "window_s": LENGTH,
        "slow": [method.name for method, _, _ in measured if method.slow],
        "standard_tolerances": ACCURACY["standard"].model_dump(),
        "instruction_set": Simulation(bench.scene).instruction_set,
        "scikit_sundae": _version("sksundae"),
    }
    report.notes = [
        "LSODA takes a dense Jacobian only; solve_ivp does not hand on its limits of order: 'order 2' goes around it.",
        "SciPy's BDF has no limit of order: 'order 2' changes a private constant while it steps.",
        "Radau, BDF and scikit-sundae take one relative tolerance for all entries, LSODA one for each.",
        "Our Jacobian is one batched call (24 states), sparse where the package takes it.",
        "trbdyn's bdf takes forces of raceways and ribs from tangents between exact evaluations; 'exact' does not.",
    ]
    report.readme = text_of(report)
    print(report.readme)
    if not options.no_picture:
        draw(report.results, report.summary)
    return report.finish()


def attempt(bench: Bench, method: Method) -> tuple[list[Point], str | None]:
    """Points of an integrator and None, or none and why it could not be measured."""
    try:
        return bench.measure(method), None
    except Exception as error:
        return [], f"{type(error).__name__}: {error}"


def text_of(report: common.Report) -> str:
    """The tables: the best alternatives first; then what could not be measured."""
    summary, bottom = report.summary, report.summary["floor"]
    best = [
        {
            "Jacobian": "the package's own" if jacobian == "its own" else "ours, handed to it",
            "best alternative": row["name"],
            "its time over the core's at equal error": row["ratio"],
        }
        for jacobian in ("its own", "ours")
        if (row := _best(report.results, jacobian))["ratio"] is not None
    ]
    forces = {
        "NumPy (us)": summary["us_per_evaluation_numpy"],
        "core (us)": summary["us_per_evaluation_core"],
        "floor (us)": bottom["us_per_evaluation"],
    }
    shown = ("name", "ratio", "ratio_low", "ratio_high", "us_per_evaluation", "us_per_step", "wall_s_per_revolution",
             "error_cage_over_cpr", "steps", "evaluations", "jacobians")  # fmt: skip
    return "\n\n".join(
        (
            *((common.table(best, best[0]),) if best else ()),
            f"A force evaluation; the floor is an estimate: {bottom['nodes']} nodes of {bottom['ns_per_node']:.1f} ns "
            f"({bottom['rates']} rates).",
            common.table([forces], forces),
            f"One evaluation of the forces takes {forces['NumPy (us)'] / forces['core (us)']:.0f} times as long in NumPy as in "
            "the core: that part of a ratio is not the integrator's.",
            common.table(report.results, shown),
            *(f"Not measured: {row['name']} ({row['failure']})." for row in report.results if row["failure"]),
        )
    )


def _best(rows: list[dict[str, Any]], jacobian: str) -> dict[str, Any]:
    """The row with the smallest ratio of those with a kind of Jacobian."""
    found = [row for row in rows if row["jacobian"] == jacobian and row["ratio"] is not None]
    return min(found, key=lambda row: float(row["ratio"]), default={"name": None, "ratio": None})


def _version(package: str) -> str | None:
    if importlib.util.find_spec(package) is None:
        return None
    version: str = __import__(package).__version__
    return version


if __name__ == "__main__":
    main()
