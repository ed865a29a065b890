"""What accuracy costs: error against time over scenes, tolerances, methods, slices and quadratures; where the presets stand.

    python benchmarks/work_precision.py [--quick] [--json FILE]
    python benchmarks/work_precision.py --write-readme         puts the tables into benchmarks/README.md
    python benchmarks/work_precision.py --make-states [NAME]   writes benchmarks/data/states.npz, where trajectories begin
    python benchmarks/work_precision.py --make-table [FILE]    writes trbdyn/data/accuracy.json for Simulation.estimate()

Errors are deviations from a reference within windows of at least 4 ms and 10 impacts (40 ms at 100 rpm, 1.5 ms at 10 000 rpm)
from stored states, in most scenes of a cage in the middle of a collision (see `accuracy.states`). What tolerances do to means
and peaks of longer runs, which are chaotic, is measured at the run itself (`trb.check`). The reference is an explicit
Runge-Kutta method at 1e-4 of the base tolerances, checked against BDF at the same, or BDF checked against the explicit method
where explicit steps are far too short.
Tolerances are given as a scale of the base: rtol 1e-3, 3e-10 m, 3e-8 rad, 1e-4 m/s, 1e-2 rad/s.
"""

from __future__ import annotations

import json
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import common
from accuracy import measure, states, user
from accuracy.picture import draw_front
from accuracy.tables import text_of

from trbdyn import Simulation
from trbdyn.run.options import ACCURACY

COLUMNS = {
    "sweep": "text: tolerances, presets, slices or user",
    "case": "text: name of the scene, see summary.scenes",
    "name": "text: name of the point",
    "method": "text: integrator and its highest order; exact: without tangents of the rings' forces",
    "preset": "text: preset that the point is, or null",
    "scale": "1: tolerances over the base",
    "quadrature": "text: nodes along a contact line, uniform or gauss",
    "n_slices": "1: their number",
    "wall_s_per_revolution": "s: wall time a revolution of the shaft, median over states; a record every millisecond",
    "cpu_s_per_revolution": "s: processor time of the same: wall time on a machine with nothing else to do",
    "wall_s_per_revolution_default_output": "s: the same with a record every 0.1 ms",
    "real_time_factor": "1: bearing time over wall time",
    "steps_per_revolution": "1: steps a revolution",
    "evaluations_per_revolution": "1: force evaluations of the integrator a revolution",
    "jacobians_per_revolution": "1: Jacobians a revolution",
    "us_per_evaluation": "us: wall time of one evaluation of all forces",
    "error_cage_over_cpr": "1: largest deviation of the cage's centre within the window over Cpr, median over states",
    "error_load": "1: rms deviation of the outer raceways' loads over their mean, median over states",
    "error_cage_speed": "1: largest deviation of the cage's speed over its mean, median over states",
    "error_power": "1: deviation of the energy lost within the window over it, median over states",
    **{f"{name}_worst": "1: the same, worst state" for name in measure.QUANTITIES},
    "error_displacement": "1: deviation of the ring's axial place under load over its place: stiffness",
    **user.COLUMNS,
    "energy_closure": "1: residual of the energy audit over the dissipated work",
    "warnings": "1: warnings of the watch over the runs of the windows, all states",
    "scenes": "object: what each scene is",
    "presets": "object: the figures of each preset on the colliding cage",
    "pareto": "object: names of the points on the front, by case",
    "reference_disagreement": "object: largest deviation between explicit and implicit reference, by case",
    "windows": "object: length (s) and impacts of each window, by case",
}

TABLE = Path(__file__).resolve().parents[1] / "trbdyn" / "data" / "accuracy.json"


@dataclass(frozen=True)
class Plan:
    """How much is run.

    Attributes
    ----------
    states : dict of str to int
        Cases, and the states of each.
    scales : tuple of float
        Scales of the tolerances of BDF of order 2.
    methods : dict of str to tuple of float
        Other methods, and their scales.
    fewer : tuple of str
        Cases that get only `FEWER_SCALES` and no other methods.
    revolutions : float
        Turns of each run in which time is measured.
    slices : dict of str to tuple of int
        Quadratures and their numbers of slices.
    checked : int
        References of each case that are checked with the other method.
    repeats : int
        Repeats of a timed run.
    """

    states: dict[str, int]
    scales: tuple[float, ...]
    methods: dict[str, tuple[float, ...]]
    fewer: tuple[str, ...]
    revolutions: float
    slices: dict[str, tuple[int, ...]]
    checked: int
    repeats: int


NEW = ("light", "heavy", "slow", "fast", "scatter")
FULL = Plan(
    dict.fromkeys(states.CASES, 5),
    (30.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.5, 0.3, 0.1, 0.03, 0.01),
    {
        "bdf2exact": (10.0, 3.0, 1.0, 0.3, 0.1),
        "bdf1": (1.0,),
        "bdf3": (0.1,),
        "bdf5": (0.3, 0.1, 0.01, 1e-3),
        "erk": (1.0, 0.1, 0.01),
    },
    NEW,
    3.0,
    {"uniform": (8, 16, 20, 32, 64), "gauss": (4, 6, 8, 12, 16, 24)},
    1,
    3,
)
QUICK = Plan(
    {"collision": 3, "smooth": 2, "combined": 2} | dict.fromkeys(NEW, 1),
    (10.0, 3.0, 1.0, 0.3, 0.1),
    {"bdf2exact": (1.0,), "bdf5": (0.01,), "erk": (0.1,)},
    NEW,
    1.0,
    {"uniform": (20,), "gauss": (8,)},
    1,
    2,
)
SMOKE = Plan({"collision": 2, "slow": 1}, (1.0,), {"erk": (1.0,)}, NEW, 0.1, {"gauss": (8,)}, 0, 1)

FEWER_SCALES = (10.0, 3.0, 1.0, 0.3, 0.1)
FINE = 96
"""Gauss nodes of the reference of slices and quadratures."""
SLICES_SCALE = 0.01
"""Tolerances in the comparison of slices: well below what is compared."""
LOOSE = 0.03
"""Scale of tolerances below which a point of the sweep is timed once over one turn."""


def method_settings(method: str) -> dict[str, Any]:
    """Settings of a method's name: bdf2 is BDF of order up to 2, bdf2exact the same without tangents of the rings' forces."""
    if method == "erk":
        return {"integrator": "erk"}
    exact = {"rings_share": 0.0} if method.endswith("exact") else {}
    return {"integrator": "bdf", "max_order": int(method.removeprefix("bdf").removesuffix("exact"))} | exact


def sweep(report: common.Report, references: measure.References, plan: Plan) -> None:
    """Tolerances, methods and presets on a case."""
    case = references.case
    points: list[tuple[str, str, str | None, float, dict[str, Any]]] = [
        (f"preset {name}", "bdf2", name, measure.preset_scale(name), settings | {"integrator": "bdf"})
        for name, settings in measure.preset_settings().items()
    ]
    fewer = case.name in plan.fewer
    short = FEWER_SCALES if plan is FULL else (1.0,)
    for method, scales in ({"bdf2": short} if fewer else {"bdf2": plan.scales, **plan.methods}).items():
        for scale in scales:
            settings = measure.scaled(scale, **method_settings(method))
            points.append((f"{method} {scale:g}", method, None, scale, settings))
    for name, method, preset, scale, settings in points:
        found = measure.median_and_worst(references.errors_of(settings))
        few = case.states if preset else case.states[:3]
        loose = scale > LOOSE and method.startswith("bdf2")
        turns = case.definition.timed * (plan.revolutions if loose else min(plan.revolutions, 0.5))
        cost = measure.wall_time(case.scene, few, settings, turns, repeats=plan.repeats if loose else 1)
        report.add(
            sweep="presets" if preset else "tolerances",
            case=case.name,
            name=name,
            method=method,
            preset=preset,
            scale=scale,
            quadrature=case.scene.effects.quadrature,
            n_slices=case.scene.effects.n_slices,
            **cost,
            **found,
        )


def slices(report: common.Report, case: states.Case, plan: Plan) -> None:
    """Numbers of slices and quadratures against many Gauss nodes."""

    def with_nodes(quadrature: str, count: int) -> Any:
        return case.scene.replace(effects=case.scene.effects.replace(quadrature=quadrature, n_slices=count))

    fine = with_nodes("gauss", FINE)
    references = measure.References(case, fine)
    place = Simulation(fine).equilibrium.displacement[2]
    for quadrature, counts in plan.slices.items():
        for count in counts:
            scene = with_nodes(quadrature, count)
            sim = Simulation(states.at_state(scene, case.states[0]))
            cost = partial(sim.derivative, sim.state.vector)
            found = measure.median_and_worst(references.errors_of(measure.scaled(SLICES_SCALE), scene))
            report.add(
                sweep="slices",
                case=case.name,
                name=f"{quadrature} {count}",
                quadrature=quadrature,
                n_slices=count,
                us_per_evaluation=1e6 * measure.least_per_call(cost),
                error_displacement=abs(sim.equilibrium.displacement[2] / place - 1.0),
                **found,
            )


def preset_figures(report: common.Report, case: states.Case, plan: Plan) -> dict[str, Any]:
    """What is asked for of each preset, on the colliding cage."""
    wanted = (
        "scale",
        "wall_s_per_revolution",
        "cpu_s_per_revolution",
        "real_time_factor",
        *measure.QUANTITIES,
        *(f"{name}_worst" for name in measure.QUANTITIES),
    )
    rows = {row["preset"]: row for row in report.results if row["sweep"] == "presets" and row["case"] == case.name}
    out = {}
    for name, row in rows.items():
        settings = {"accuracy": name}
        usual = measure.wall_time(case.scene, case.states[:2], settings, plan.revolutions, save_every=1e-4, repeats=1)
        sim = Simulation(states.at_state(case.scene, case.states[0]), **settings)
        out[name] = {key: row[key] for key in wanted} | {
            "tolerances": ACCURACY[name].model_dump(),
            "wall_s_per_revolution_default_output": usual["wall_s_per_revolution"],
            "energy_closure": sim.run(revolutions=plan.revolutions, save_every=1e-3).energy_closure,
        }
    return out


def run(plan: Plan, report: common.Report) -> None:
    """Everything, into a report."""
    report.summary |= {"reference_disagreement": {}, "windows": {}, "scenes": {}, "pareto": {}}
    cases = {name: states.load_case(name).first(count) for name, count in plan.states.items()}
    report.inputs = {
        "base_tolerances": measure.BASE,
        "reference": f"scale {measure.REFERENCE_SCALE:g}: "
        + ", ".join(f"{name} by {case.reference}" for name, case in cases.items()),
        "scene": "30310 rig, effects of the paper ('scatter': as by default), 8 Gauss nodes a contact",
        "instruction_set": Simulation(cases["collision"].scene).instruction_set,
    }
    report.notes = [
        "Points 'tolerances' are timed from 3 states, presets from all: the fastest of the repeats of each, then the median over "
        "states; wall time is that inside the core.",
        "Slices and quadratures: the reference has 96 Gauss nodes and starts from the same states, which were taken with "
        "8: their first contact is a small kick that all share.",
    ]
    began = clock.process_time()
    for name, case in cases.items():
        print(f"{name}: {case.text}", flush=True)
        references = measure.References(case)
        report.summary["scenes"][name] = {"text": case.text} | operating_point(case)
        report.summary["windows"][name] = [
            {"window_s": window, "impacts": impacts} for window, impacts in zip(case.windows, case.impacts, strict=True)
        ]
        if plan.checked:
            report.summary["reference_disagreement"][name] = references.disagreement(plan.checked)
        sweep(report, references, plan)
        report.summary["pareto"][name] = front_of(report.results, name)
        print(f"  {clock.process_time() - began:.0f} s of processor time", flush=True)
    first = cases["collision"]
    report.summary["presets"] = preset_figures(report, first, plan)
    errors = {
        row["preset"]: row["error_cage_over_cpr"]
        for row in report.results
        if row["sweep"] == "presets" and row["case"] == first.name
    }
    turns = user.TURNS if plan is FULL else 10.0 if plan is QUICK else 1.0
    for row in user.rows_of(first, errors, turns, plan.repeats):
        report.add(**row)
    slices(report, first if plan is FULL else first.first(1), plan)


def operating_point(case: states.Case) -> dict[str, Any]:
    """What `trbdyn.run.estimate` finds a case by."""
    definition = case.definition
    return {
        "speed_rpm": definition.speed_rpm,
        "axial_load": definition.axial_load,
        "radial_load": definition.radial_load,
        "diameter_range": definition.diameter_range,
        "colliding": definition.colliding,
    }


def front_of(rows: Sequence[dict[str, Any]], case: str) -> list[str]:
    """Names of the points on a case's Pareto front of processor time and median cage error."""
    points = [row for row in rows if row["case"] == case and row["sweep"] in ("tolerances", "presets")]
    on = measure.pareto([(row["cpu_s_per_revolution"], row["error_cage_over_cpr"]) for row in points])
    return [points[i]["name"] for i in on]


def write_table(report: common.Report, path: Path) -> None:
    """Errors and costs over the tolerances' scale, for `trbdyn.run.estimate`."""
    errors = (*measure.QUANTITIES, *(f"{name}_worst" for name in measure.QUANTITIES))
    kept = ("scale", "cpu_s_per_revolution", *errors)

    def short(row: dict[str, Any], names: Sequence[str]) -> dict[str, float | None]:
        values = {name: row.get(name) for name in names}
        return {name: None if value is None else float(f"{value:.4g}") for name, value in values.items()}

    rows: dict[str, list[dict[str, Any]]] = {}
    presets: dict[str, dict[str, Any]] = {}
    for row in report.results:
        if row["sweep"] == "tolerances" and row["method"] == "bdf2":
            rows.setdefault(row["case"], []).append(short(row, kept))
        elif row["sweep"] == "presets":
            tolerances = {"tolerances": ACCURACY[row["preset"]].model_dump()}
            presets.setdefault(row["case"], {})[row["preset"]] = tolerances | short(row, kept)
    windows = {name: [one["window_s"] for one in found] for name, found in report.summary["windows"].items()}
    table = {
        "made_by": "python benchmarks/work_precision.py --make-table",
        "text": "errors of bdf of order 2 over the scale of the base tolerances: medians and worst over stored states",
        "quick": report.options.quick,
        "base_tolerances": measure.BASE,
        "scenes": report.summary["scenes"],
        "windows_s": windows,
        "presets": presets["collision"],
        "presets_of_scenes": presets,
        "points": {name: sorted(found, key=lambda one: one["scale"]) for name, found in rows.items()},
    }
    before = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    if "load_drop" in before:  # measured apart: docs/howto/loads.md
        table["load_drop"] = before["load_drop"]
    path.write_text(json.dumps(common.plain(table), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    print(f"wrote {path}")


def main(arguments: Sequence[str] | None = None) -> common.Report | None:
    parser = common.parser(__doc__)
    parser.add_argument(
        "--make-states",
        nargs="*",
        metavar="NAME",
        help="write stored states of cases, by default those missing, and stop",
    )
    parser.add_argument(
        "--make-table",
        nargs="?",
        type=Path,
        const=TABLE,
        metavar="FILE",
        help="write the table of trbdyn.run.estimate as well",
    )
    parser.add_argument(
        "--from-json", type=Path, metavar="FILE", help="measure nothing, take the results of such a file"
    )
    options = parser.parse_args(arguments)
    if options.make_states is not None:
        states.make_file(options.make_states)
        return None
    report = common.Report("work_precision", options, COLUMNS)
    try:
        if options.from_json is not None:
            report.take(options.from_json)
        else:
            run(SMOKE if options.smoke else QUICK if options.quick else FULL, report)
    except BaseException as error:
        report.notes.append(f"ended early by {type(error).__name__}: {error}")
        report.finish()
        raise
    print("\n" + text_of(report, everything=True))
    if not options.no_picture:
        common.save_picture(draw_front(report), "work_precision")
    if options.make_table is not None:
        write_table(report, options.make_table)
    report.readme = text_of(report)
    report.finish()
    return report


if __name__ == "__main__":
    main()
