"""What accuracy costs: error against wall time over tolerances, methods, slices and quadratures; where the presets stand.

    python benchmarks/work_precision.py [--quick] [--json FILE]
    python benchmarks/work_precision.py --make-states    writes benchmarks/data/states.npz, from which trajectories begin
    python benchmarks/work_precision.py --make-table     writes trbdyn/data/accuracy.json, which Simulation.estimate() reads

Errors are deviations from a reference within windows of at least 4 ms and 10 impacts from stored states of a whirling cage in
the middle of a collision (see `accuracy.states`); beyond those, colliding motion is chaotic and statistics are compared. The
reference is an explicit Runge-Kutta method at 1e-4 of the base tolerances, checked against BDF at the same. Tolerances are
given as a scale of the base: rtol 1e-3, 3e-10 m, 3e-8 rad, 1e-4 m/s, 1e-2 rad/s.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import common
from accuracy import measure, states
from accuracy.picture import draw_front

from trbdyn import Simulation
from trbdyn.run_options import ACCURACY

COLUMNS = {
    "sweep": "text: tolerances, presets, slices or statistics",
    "case": "text: smooth, collision or combined",
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
    "whirl_radius": "1: mean distance of the cage's centre from the bearing axis over Cpr",
    "whirl_radius_half_width": "1: half the 95 % confidence interval",
    "torque": "N m: mean torque of the shaft",
    "torque_half_width": "N m: half the 95 % confidence interval",
    "cage_speed_ratio": "1: turn of the cage over turn of the shaft",
    "cage_speed_ratio_half_width": "1: half the 95 % confidence interval",
    "batches": "1: runs that the statistics are over",
    "energy_closure": "1: residual of the energy audit over the dissipated work",
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
    revolutions : float
        Turns of each run in which wall time is measured.
    statistics : float
        Turns of each batch of the statistics; 0: none.
    slices : dict of str to tuple of int
        Quadratures and their numbers of slices.
    checked : int
        References of each case that are checked with BDF.
    """

    states: dict[str, int]
    scales: tuple[float, ...]
    methods: dict[str, tuple[float, ...]]
    revolutions: float
    statistics: float
    slices: dict[str, tuple[int, ...]]
    checked: int


FULL = Plan(
    {"collision": 5, "smooth": 5, "combined": 5},
    (30.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.5, 0.3, 0.1, 0.03, 0.01),
    {
        "bdf2exact": (10.0, 3.0, 1.0, 0.3, 0.1),
        "bdf1": (1.0,),
        "bdf3": (0.1,),
        "bdf5": (0.3, 0.1, 0.01, 1e-3),
        "erk": (1.0, 0.1, 0.01),
    },
    3.0,
    20.0,
    {"uniform": (8, 16, 20, 32, 64), "gauss": (4, 6, 8, 12, 16, 24)},
    2,
)
QUICK = Plan(
    {"collision": 5, "smooth": 2, "combined": 2},
    (10.0, 3.0, 1.0, 0.3, 0.1),
    {"bdf2exact": (1.0,), "bdf5": (0.01,), "erk": (0.1,)},
    2.0,
    5.0,
    {"uniform": (20,), "gauss": (8, 16)},
    1,
)
SMOKE = Plan({"collision": 1}, (1.0,), {"erk": (1.0,)}, 0.1, 0.2, {"gauss": (8,)}, 0)

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
    return {"max_order": int(method.removeprefix("bdf").removesuffix("exact"))} | exact


def sweep(report: common.Report, references: measure.References, plan: Plan) -> None:
    """Tolerances, methods and presets on a case."""
    case = references.case
    points: list[tuple[str, str, str | None, float, dict[str, Any]]] = [
        (f"preset {name}", "bdf2", name, measure.preset_scale(name), settings)
        for name, settings in measure.preset_settings().items()
    ]
    for method, scales in {"bdf2": plan.scales, **plan.methods}.items():
        for scale in scales:
            settings = measure.scaled(scale, **method_settings(method))
            points.append((f"{method} {scale:g}", method, None, scale, settings))
    for name, method, preset, scale, settings in points:
        print(f"  {name}", flush=True)
        found = measure.median_and_worst(references.errors_of(settings))
        few = case.states if preset and scale > LOOSE else case.states[:3]
        loose = scale > LOOSE and method.startswith("bdf2")
        revolutions = plan.revolutions if loose else min(plan.revolutions, 0.5)
        cost = measure.wall_time(case.scene, few, settings, revolutions, repeats=3 if loose else 1)
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


def statistics(report: common.Report, case: states.Case, plan: Plan) -> None:
    """Means beyond the comparable window, with confidence intervals, for the presets and a tight tolerance."""
    points = {f"preset {name}": settings for name, settings in measure.preset_settings().items() if name != "reference"}
    points |= {f"bdf2 {scale:g}": measure.scaled(scale) for scale in ((3.0, 1.0, 0.1) if plan is FULL else (0.1,))}
    for name, settings in points.items():
        found = measure.long_run(case, settings, plan.statistics)
        report.add(
            sweep="statistics",
            case=case.name,
            name=name,
            batches=found["whirl_radius"].batches,
            **{key: found[key].value for key in ("whirl_radius", "torque", "cage_speed_ratio")},
            **{f"{key}_half_width": found[key].half_width for key in ("whirl_radius", "torque", "cage_speed_ratio")},
        )


def preset_figures(report: common.Report, case: states.Case, plan: Plan) -> dict[str, Any]:
    """What the issue asks for of each preset, on the colliding cage."""
    wanted = (
        "scale",
        "wall_s_per_revolution",
        "cpu_s_per_revolution",
        "real_time_factor",
        *measure.QUANTITIES,
        *(f"{name}_worst" for name in measure.QUANTITIES),
    )
    rows = {row["preset"]: row for row in report.results if row.get("preset") and row["case"] == case.name}
    out = {}
    for name, row in rows.items():
        settings = {"accuracy": name}
        revolutions = min(plan.revolutions, 0.5) if name == "reference" else plan.revolutions
        repeats = 1 if name == "reference" else 3
        few = case.states[:2] if name == "reference" else case.states
        usual = measure.wall_time(case.scene, few, settings, revolutions, save_every=1e-4, repeats=repeats)
        sim = Simulation(states.at_state(case.scene, case.states[0]), **settings)
        out[name] = {key: row[key] for key in wanted} | {
            "tolerances": ACCURACY[name].model_dump(),
            "wall_s_per_revolution_default_output": usual["wall_s_per_revolution"],
            "energy_closure": sim.run(revolutions=revolutions, save_every=1e-3).energy_closure,
        }
    return out


def run(plan: Plan, options: argparse.Namespace) -> common.Report:
    """Everything."""
    report = common.Report("work_precision", options, COLUMNS)
    report.summary["reference_disagreement"] = {}
    report.summary["windows"] = {}
    cases = {name: states.load_case(name).first(count) for name, count in plan.states.items()}
    for name, case in cases.items():
        print(f"{name}: {case.text}")
        references = measure.References(case)
        report.summary["windows"][name] = [
            {"window_s": window, "impacts": impacts} for window, impacts in zip(case.windows, case.impacts, strict=True)
        ]
        if plan.checked:
            report.summary["reference_disagreement"][name] = references.disagreement(plan.checked)
        sweep(report, references, plan)
    first = cases["collision"]
    report.summary["presets"] = preset_figures(report, first, plan)
    slices(report, first.first(3) if options.quick else first, plan)
    for case in cases.values() if plan is FULL else [first]:
        statistics(report, case, plan)
    report.summary["pareto"] = {name: front_of(report.results, name) for name in cases}
    report.inputs = {
        "base_tolerances": measure.BASE,
        "reference": f"erk of order 5 at scale {measure.REFERENCE_SCALE:g}",
        "scene": "30310 rig, effects of the paper, 8 Gauss nodes a contact",
        "instruction_set": Simulation(first.scene).instruction_set,
    }
    report.notes = [
        "Points 'tolerances' are timed from 3 states, presets from all: the fastest of 3 repeats of each, then the median over "
        "states; wall time is that inside the core.",
        "Slices and quadratures: the reference has 96 Gauss nodes and starts from the same states, which were taken with "
        "8: their first contact is a small kick that all share.",
    ]
    return report


def front_of(rows: Sequence[dict[str, Any]], case: str) -> list[str]:
    """Names of the points on a case's Pareto front of processor time and median cage error."""
    points = [row for row in rows if row["case"] == case and row["sweep"] in ("tolerances", "presets")]
    on = measure.pareto([(row["cpu_s_per_revolution"], row["error_cage_over_cpr"]) for row in points])
    return [points[i]["name"] for i in on]


def show(report: common.Report) -> None:
    """Print the tables."""
    cost = ("wall_s_per_revolution", "cpu_s_per_revolution", "real_time_factor", "steps_per_revolution")
    for title, kinds, names in (
        ("Tolerances and presets", ("presets", "tolerances"), ("case", "name", *cost, *measure.QUANTITIES)),
        (
            "Slices and quadratures",
            ("slices",),
            ("name", "us_per_evaluation", "error_displacement", *measure.QUANTITIES),
        ),
        (
            "Statistics beyond",
            ("statistics",),
            ("case", "name", "whirl_radius", "whirl_radius_half_width", "torque", "torque_half_width", "batches"),
        ),
    ):
        print(f"\n{title}\n\n{common.table([row for row in report.results if row['sweep'] in kinds], names)}")
    print("\nPresets on the colliding cage\n")
    rows = [{"preset": name, **figures} for name, figures in report.summary["presets"].items()]
    names = ("preset", "scale", *cost[:3], "wall_s_per_revolution_default_output", *measure.QUANTITIES[:1])
    print(common.table(rows, (*names, "error_cage_over_cpr_worst", "energy_closure")))
    for name, front in report.summary["pareto"].items():
        print(f"\nPareto front, {name}: {', '.join(front)}")


def write_table(report: common.Report) -> None:
    """Errors and costs over the tolerances' scale, for `trbdyn.estimate`."""
    kept = ("scale", "cpu_s_per_revolution", *measure.QUANTITIES, *(f"{name}_worst" for name in measure.QUANTITIES))
    rows: dict[str, list[dict[str, float]]] = {}
    for row in report.results:
        if row["sweep"] == "tolerances" and row["method"] == "bdf2":
            rows.setdefault(row["case"], []).append({name: float(f"{row[name]:.4g}") for name in kept})
    windows = {name: [one["window_s"] for one in found] for name, found in report.summary["windows"].items()}
    table = {
        "made_by": "python benchmarks/work_precision.py --make-table",
        "text": "errors of bdf of order 2 over the scale of the base tolerances: medians and worst over stored states",
        "base_tolerances": measure.BASE,
        "windows_s": windows,
        "presets": {
            name: {"tolerances": figures["tolerances"]} | {key: float(f"{figures[key]:.4g}") for key in kept}
            for name, figures in report.summary["presets"].items()
        },
        "points": {name: sorted(found, key=lambda one: one["scale"]) for name, found in rows.items()},
    }
    TABLE.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    print(f"wrote {TABLE.name}")


def main(arguments: Sequence[str] | None = None) -> common.Report | None:
    parser = common.parser(__doc__)
    parser.add_argument("--smoke", action="store_true", help="the least that goes through everything; seconds")
    parser.add_argument("--make-states", action="store_true", help="write the stored states and stop")
    parser.add_argument("--make-table", action="store_true", help="write the table of trbdyn.estimate as well")
    options = parser.parse_args(arguments)
    if options.make_states:
        states.make_file()
        return None
    report = run(SMOKE if options.smoke else QUICK if options.quick else FULL, options)
    show(report)
    if not options.no_picture:
        common.save_picture(draw_front(report), "work_precision")
    if options.make_table:
        write_table(report)
    report.finish()
    return report


if __name__ == "__main__":
    main()
