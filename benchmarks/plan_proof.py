"""Whether plans keep what they promise: `trbdyn.plan` on many scenes, each against a long run with everything on.

The truth of a scene is its own effects with 32 Gauss nodes and the preset 'reference', run from the start of the scene and
averaged over much more than the plan's run, behind the time that the plan's run starts at (half of the truth at most). A
promise is kept where the difference between the run of the plan and the truth is at most what was promised, beside the
statistical error of the truth itself; the wish is kept where it is at most what was wanted. Costs are processor times of runs:
of the plan, of the truth's settings for as exact a run as the plan expects to need with them, and of the scene as given, as
long as the plan's.

    python benchmarks/plan_proof.py --jobs 2                 twenty scenes that were chosen
    python benchmarks/plan_proof.py --jobs 2 --drawn 20      twenty that were drawn, as `make adversary` draws scenes of practice
"""

from __future__ import annotations

import multiprocessing as mp
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import common
import numpy as np

import trbdyn as trb
from trbdyn.extras.design.planning import Plan
from trbdyn.extras.design.planning.candidates import TRUE_NODES, numerics
from trbdyn.results import numbers

COLUMNS = {
    "scene": "text: name",
    "text": "text: what it is",
    "quantity": "text: average of the summary",
    "wanted": "1: wanted relative error",
    "promised": "1: promised relative error",
    "error": "1: difference of the plan's run from the truth, over the size that the plan's errors are shares of",
    "truth": "unit of the quantity: value of the truth",
    "truth_half_width": "1: relative half width of the truth's own 95 % confidence interval",
    "promise_kept": "1: the error is at most what was promised, beside the truth's half width",
    "wish_kept": "1: the same with what was wanted",
    "reached": "1: the plan said that the wish is within reach",
    "left_out": "text: effects that the plan leaves out",
    "nodes": "1: nodes along a contact",
    "accuracy": "text: preset of the tolerances",
    "duration": "s: bearing time of the plan's run",
    "probes_s": "s: processor time of the probes",
    "plan_s": "s: processor time of the plan's run",
    "given_s": "s: processor time of the scene as given with the preset standard, as long",
    "everything_s": "s: expected processor time of a run as exact with everything on, 32 nodes and reference",
    "truth_s": "s: processor time of the truth",
    "promises_kept": "1: share of promises kept",
    "wishes_kept": "1: share of wishes kept, of those that the plan said are within reach",
    "cost_over_everything": "1: processor time of the plan over that with everything on, geometric mean",
    "cost_over_given": "1: processor time of the plan over that of the scene as given, geometric mean",
}
EFFORT = 15.0
TRUTH_S = 60.0
"""Processor time of a truth at most (s)."""
LONGER = 6.0
"""Length of the truth's averaging over that of the plan's run."""
QUICK = ("rig_30310", "32216", "combined")
DRAWN = "drawn "
"""Begin of the names of scenes that are drawn; the seed follows."""
DRAWN_SEED = 7000
DRAWN_WISHES = {"torque": 0.02, "axis_distance_over_cpr": 0.1}


def scenes() -> dict[str, tuple[str, trb.Scene, dict[str, float]]]:
    """Name, words, scene and wishes."""
    usual, paper, whirl = trb.Effects(), trb.Effects.paper(), trb.Start.whirl(0.9)
    rig = trb.cases.paper_30310
    torque, cage = {"torque": 0.02}, {"torque": 0.02, "axis_distance_over_cpr": 0.1}
    bearing = trb.cases.rig_30310()
    uneven = bearing.replace(
        roller=bearing.roller.replace(diameter_scatter=trb.Scatter(range=2e-6, seed=1)),
    )
    return {
        "rig_30310": ("the paper's rig, 3000 rpm, 4930 N", rig(3000.0, 4930.0, effects=paper, start=whirl), torque),
        "paper_light": ("the paper's rig, 3000 rpm, 1230 N", rig(3000.0, 1230.0, effects=paper, start=whirl), cage),
        "paper_slow": ("the paper's rig, 1000 rpm, 4930 N", rig(1000.0, 4930.0, effects=paper, start=whirl), torque),
        "usual": ("3000 rpm, 4930 N, usual effects", rig(3000.0, 4930.0, effects=usual, start=whirl), cage),
        "32216": ("32216, 1500 rpm", trb.cases.scene_32216(1500.0), torque),
        "combined": (
            "2000 rpm, 4930 N axial, 5530 N radial",
            rig(2000.0, 4930.0, effects=usual).replace(radial_load=5530.0),
            {"torque": 0.02, "pocket_force_p95": 0.3},
        ),
        "radial": (
            "1000 rpm, 3000 N axial, 9000 N radial: rollers without load",
            rig(1000.0, 3000.0, effects=usual).replace(radial_load=9000.0),
            torque,
        ),
        "light": (
            "3000 rpm, 1230 N, usual effects",
            rig(3000.0, 1230.0, effects=usual, start=whirl),
            {"torque": 0.02, "pocket_duty": 0.2},
        ),
        "heavy": ("3000 rpm, 20 kN", rig(3000.0, 20_000.0, effects=usual), {"torque": 0.02, "cage_slip": 0.1}),
        "fast": ("10 000 rpm, 4930 N", rig(10_000.0, 4930.0, effects=usual, start=whirl), cage),
        "slow": ("100 rpm, 4930 N", rig(100.0, 4930.0, effects=usual), {"torque": 0.03}),
        "uneven": (
            "rollers of unequal diameter, 2 um",
            rig(3000.0, 4930.0, effects=usual).replace(bearing=uneven),
            {"torque": 0.02, "orbit_rms_over_cpr": 0.2},
        ),
        "misaligned": (
            "inner ring misaligned by 0.5 mrad",
            rig(3000.0, 4930.0, effects=usual).replace(misalignment_x=5e-4),
            torque,
        ),
        "drag": (
            "6000 rpm, a fifth of the space full of oil",
            rig(6000.0, 4930.0, effects=usual.replace(oil_fill=0.2)),
            {"torque": 0.03, "cage_slip": 0.1},
        ),
        "drag_film": (
            "3000 rpm, 30 % of the space full of oil: torque and film",
            rig(3000.0, 8000.0, effects=usual.replace(oil_fill=0.3)),
            {"torque": 0.01, "film_parameter_outer": 0.01},
        ),
        "land": (
            "3000 rpm, 4930 N, a cage on a land of the outer ring",
            rig(3000.0, 4930.0, effects=usual.replace(guidance="outer_land")),
            {"torque": 0.02, "orbit_rms_over_cpr": 0.1},
        ),
        "land_inner": (
            "1500 rpm, 3000 N axial, 2000 N radial, a cage on a land of the inner ring",
            rig(1500.0, 3000.0, effects=usual.replace(guidance="inner_land")).replace(radial_load=2000.0),
            {"torque": 0.02, "axis_distance_over_cpr": 0.1},
        ),
        "land_drag": (
            "6000 rpm, 4930 N, a cage on a land of the outer ring in a fifth of oil",
            rig(6000.0, 4930.0, effects=usual.replace(guidance="outer_land", oil_fill=0.2)),
            {"torque": 0.02, "film_parameter_inner": 0.02, "orbit_rms_over_cpr": 0.2},
        ),
        "cold": (
            "1500 rpm, oil at 20 C",
            rig(1500.0, 4930.0, effects=usual).replace(lubricant=trb.lubricants.vg100(20.0)),
            torque,
        ),
        "least": (
            "planar, dry friction (preset minimal)",
            rig(3000.0, 4930.0, effects=trb.Effects.minimal(), start=trb.Start.equal()),
            {"torque": 0.05},
        ),
    }


def drawn(seed: int) -> tuple[str, trb.Scene, dict[str, float]]:
    """A scene of practice that nobody chose: 1 to 20 000 rpm, 0.5 to 32 kN, oil at 10 to 110 C."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "adversary"))
    import random_scenes

    table = random_scenes.draw("usual", seed)
    scene = random_scenes.make(table)
    text = (
        f"{table['bearing']}, {table['speed_rpm']:.3g} rpm, {table['axial_load']:.3g} N axial, {scene.radial_load:.3g} N radial, "
        f"{table['temperature_c']:.0f} C, {table['effects']}, {table['start']}"
    )
    return text, scene, DRAWN_WISHES


def proof(name: str, effort: float = EFFORT, truth_most_s: float = TRUTH_S) -> list[dict[str, Any]]:
    """The plan of a scene, its run, and the truth; a row for each wanted average; none where nothing carries the load."""
    warnings.simplefilter("ignore")
    try:
        text, scene, want = drawn(int(name.removeprefix(DRAWN))) if name.startswith(DRAWN) else scenes()[name]
        trb.Simulation(scene)
    except trb.TrbError as error:
        print(f"{name} is refused: {error}", flush=True)
        return []
    plan = trb.plan(scene, want, effort=effort)
    plan_s, result = _timed(plan, plan.scene, plan.accuracy, plan.duration)
    found = plan.averages(result)
    given_s, _ = _timed(plan, scene, "standard", plan.duration)
    rate = plan.computing_s_everything / max(plan.duration, 1e-12)
    everything = scene.replace(effects=scene.effects.replace(**numerics(TRUE_NODES)))
    begun = plan.scene.start.time - scene.start.time
    length = min(begun + LONGER * plan.duration, max(truth_most_s / rate, 2.0 * plan.duration))
    truth_s, true = _timed(plan, everything, "reference", length)
    window = true.window(float(true["time"][0]) + max(min(begun, 0.5 * length), 0.25 * length))
    values, widths = numbers.all_averages(window), numbers.half_widths(window)
    rows = []
    for wanted, wish in want.items():
        value = float(values[wanted])
        size = plan.size[wanted]
        half = widths.get(wanted, np.nan) / size
        error, slack = abs(found[wanted] - value) / size, 0.0 if np.isnan(half) else half
        rows.append(
            {
                "scene": name,
                "text": text,
                "quantity": wanted,
                "wanted": wish,
                "promised": plan.promised[wanted],
                "error": error,
                "truth": value,
                "truth_half_width": half,
                "promise_kept": bool(error <= plan.promised[wanted] + slack),
                "wish_kept": bool(error <= wish + slack),
                "reached": plan.reached,
                "left_out": ", ".join(plan.left_out),
                "nodes": plan.scene.effects.n_slices,
                "accuracy": plan.accuracy,
                "duration": plan.duration,
                "probes_s": plan.spent_s,
                "plan_s": plan_s,
                "given_s": given_s,
                "everything_s": plan.computing_s_everything,
                "truth_s": truth_s,
            }
        )
    return rows


def _timed(plan: Plan, scene: trb.Scene, accuracy: str, duration: float) -> tuple[float, trb.Result]:
    """Processor time of a run with the records of a plan, with its construction, and its result."""
    began = time.process_time()
    simulation = trb.Simulation(scene, accuracy=accuracy)
    result = simulation.run(duration=duration, save_every=plan.save_every, save_groups=plan.save_groups)
    return time.process_time() - began, result


def main() -> None:
    """Run the benchmark."""
    parser = common.parser(__doc__)
    parser.add_argument("--jobs", type=int, default=1, help="scenes at once")
    parser.add_argument("--from", dest="taken", type=Path, metavar="FILE", help="take the results of an earlier run")
    parser.add_argument(
        "--drawn", type=int, metavar="COUNT", help="scenes that are drawn in place of those that were chosen"
    )
    parser.add_argument("--seed", type=int, default=DRAWN_SEED, help="seed of the first of them")
    parser.add_argument("--scenes", nargs="+", choices=list(scenes()), default=None, help="only these")
    parser.add_argument("--effort", type=float, default=EFFORT, help="processor time for the probes of a plan (s)")
    parser.add_argument("--truth", type=float, default=TRUTH_S, help="processor time of a truth at most (s)")
    options = parser.parse_args()
    report = common.Report("plan_proof", options, COLUMNS)
    if options.taken:
        report.take(options.taken)
        report.readme = _page(report.results, report.summary)
        report.finish()
        return
    if options.smoke:
        options.effort, options.truth = 2.0, 5.0
    names = options.scenes or (QUICK[:1] if options.smoke else QUICK if options.quick else list(scenes()))
    if options.drawn is not None:
        names = [f"{DRAWN}{seed}" for seed in range(options.seed, options.seed + options.drawn)]
        if options.write_readme:
            parser.error("--write-readme is for the scenes that were chosen")
    report.inputs = {"effort_s": options.effort, "truth_s": options.truth, "scenes": list(names)}
    with ProcessPoolExecutor(options.jobs, mp_context=mp.get_context("spawn")) as pool:
        for rows in pool.map(partial(proof, effort=options.effort, truth_most_s=options.truth), names):
            for row in rows:
                report.add(**row)
                print({key: row[key] for key in ("scene", "quantity", "promised", "error", "promise_kept")}, flush=True)
    rows = report.results
    one = {row["scene"]: row for row in rows}.values()
    reached = [row for row in rows if row["reached"]]
    report.summary = {
        "promises_kept": float(np.mean([row["promise_kept"] for row in rows])),
        "wishes_kept": float(np.mean([row["wish_kept"] for row in reached])) if reached else None,
        "cost_over_everything": _mean([row["plan_s"] / row["everything_s"] for row in one]),
        "cost_over_given": _mean([row["plan_s"] / row["given_s"] for row in one]),
    }
    report.readme = _page(rows, report.summary)
    print(report.readme)
    report.finish()


def _mean(ratios: list[float]) -> float:
    return float(np.exp(np.mean(np.log(ratios))))


def _page(rows: list[dict[str, Any]], summary: dict[str, Any]) -> str:
    """The tables of the page."""
    shown = []
    for row in rows:
        percent = {key: _percent(row[key]) for key in ("wanted", "promised", "error", "truth_half_width")}
        shown.append(
            {
                "scene": row["text"],
                "quantity": row["quantity"],
                "wanted": percent["wanted"],
                "promised": percent["promised"],
                "error": f"{percent['error']} ± {percent['truth_half_width']}",
                "kept": "yes" if row["promise_kept"] else "**no**",
                "left out": row["left_out"] or "nothing",
                "nodes, preset": f"{row['nodes']}, {row['accuracy']}",
                "plan (s)": f"{row['plan_s']:.2g}",
                "as given (s)": f"{row['given_s']:.2g}",
                "everything (s)": f"{row['everything_s']:.2g}",
            }
        )
    table = common.table(shown, list(shown[0]))
    share = 100.0 * summary["promises_kept"]
    return (
        f"{share:.0f} % of {len(rows)} promises kept. The runs of the plans take {summary['cost_over_everything']:.2g} of "
        "the processor time with everything on, and "
        f"{summary['cost_over_given']:.2g} of that of the scene as given (geometric means).\n\n"
        f"{table}"
    )


def _percent(share: float | None) -> str:
    return "-" if share is None or np.isnan(share) else f"{100.0 * share:.2g} %"


if __name__ == "__main__":
    main()
