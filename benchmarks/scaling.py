"""How cost grows: with rollers, slices, speed, load, independent simulations in threads; and memory over time.

    python benchmarks/scaling.py [--quick] [--json FILE]

Rollers: 8 to 60 of the 30310's, on a pitch circle that grows with them (same gap between rollers), with the load of each
roller kept. Slopes are those of straight lines through log cost over log size: 1 is linear, and below 1 costs a roller or a
slice less the more there are. Time is processor time of the core; for threads wall time, against one simulation in the
same run.
"""

from __future__ import annotations

import argparse
import resource
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import common
import numpy as np
from accuracy import measure

from trbdyn import Scene, Simulation, Start, cases
from trbdyn.model.effects import Effects

COLUMNS = {
    "sweep": "text: rollers, slices, speed, load, threads or memory",
    "x": "1: what is varied; rpm, N or s where it has a unit",
    "us_per_evaluation": "us: one evaluation of all forces",
    "cpu_s_per_revolution": "s: processor time a revolution of the shaft",
    "steps_per_revolution": "1: steps a revolution",
    "us_per_step": "us: processor time a step, all told",
    "wall_s": "s: wall time of all simulations together",
    "throughput": "1: simulations a second over those of one thread",
    "cpu_ratio": "1: processor time a simulation over that in one thread: 1 if threads do not wait for each other",
    "resident_mb": "MB: largest memory of the process so far",
    "slopes": "object: slopes in log-log of the cost of an evaluation and of a step",
    "memory_growth_mb": "MB: growth from the first to the last of the memory rows",
    "throughput_of_two": "1: throughput of two threads",
}


@dataclass(frozen=True)
class Plan:
    """What is run."""

    rollers: tuple[int, ...]
    slices: tuple[int, ...]
    speeds: tuple[float, ...]
    loads: tuple[float, ...]
    revolutions: float
    threads: tuple[int, ...]
    memory_s: tuple[float, ...]


FULL = Plan(
    (8, 12, 16, 20, 30, 40, 60),
    (5, 8, 12, 16, 24, 32, 48, 64, 100),
    (500.0, 1000.0, 2000.0, 3000.0, 6000.0, 10000.0),
    (500.0, 1230.0, 3080.0, 4930.0, 10000.0, 20000.0),
    5.0,
    (1, 2),
    (0.4, 0.4, 0.8, 1.6),
)
QUICK = Plan(
    (8, 12, 20, 36, 60),
    (5, 12, 24, 48, 100),
    (1000.0, 3000.0, 10000.0),
    (1230.0, 4930.0, 20000.0),
    2.0,
    (1, 2),
    (0.3, 0.3, 0.6),
)
SMOKE = Plan((8, 12), (5, 8), (3000.0,), (4930.0,), 0.05, (1, 2), (1e-3, 2e-3))

EFFECTS = Effects.paper().replace(quadrature="gauss", n_slices=8)
WHIRL = Start.whirl(0.9)


def with_rollers(count: int) -> Scene:
    """The rig with another number of rollers: pitch circle, load, cage in proportion; the cage keeps its length."""
    rig = cases.rig_30310()
    factor = count / rig.n_rollers
    axial = rig.cage.inertia_axial
    along = rig.cage.inertia_transverse - 0.5 * axial  # what the cage's length adds
    cage = rig.cage.replace(
        mass=factor * rig.cage.mass,
        inertia_axial=factor**3 * axial,
        inertia_transverse=0.5 * factor**3 * axial + factor * along,
    )
    bearing = rig.replace(n_rollers=count, pitch_diameter=factor * rig.pitch_diameter, cage=cage)
    return cases.scene_30310(3000.0 / factor, 4930.0 * factor, bearing=bearing, effects=EFFECTS, start=WHIRL)


def with_slices(count: int) -> Scene:
    """The rig with another number of uniform slices."""
    return cases.scene_30310(effects=EFFECTS.replace(quadrature="uniform", n_slices=count), start=WHIRL)


def cost_of(scene: Scene, plan: Plan) -> dict[str, float]:
    """Cost of an evaluation, of a step, of a turn, after half a turn of settling."""
    sim = Simulation(scene)
    sim.run(revolutions=min(0.5, plan.revolutions), save_every=1e-3)
    state = sim.state
    vector = state.vector
    found = measure.wall_time(scene, [state], {}, plan.revolutions, repeats=2)
    return {
        "us_per_evaluation": 1e6 * measure.least_per_call(lambda: sim.derivative(vector), repeats=9),
        "cpu_s_per_revolution": found["cpu_s_per_revolution"],
        "steps_per_revolution": found["steps_per_revolution"],
        "us_per_step": 1e6 * found["cpu_s_per_revolution"] / found["steps_per_revolution"],
    }


def slope(rows: Sequence[dict[str, Any]], name: str) -> float:
    """Slope in log-log."""
    x, y = (np.log([row[key] for row in rows]) for key in ("x", name))
    return float(np.polyfit(x, y, 1)[0])


def threads(report: common.Report, plan: Plan) -> None:
    """Independent simulations side by side: the core lets other threads run while it steps."""
    one = cpu = 0.0
    scene = cases.scene_30310(effects=EFFECTS, start=WHIRL)
    for count in plan.threads:
        best = spent = float("inf")
        for _ in range(5):
            sims = [Simulation(scene) for _ in range(count)]
            workers = [
                threading.Thread(target=sim.run, kwargs={"revolutions": 4 * plan.revolutions, "save_every": 1e-3})
                for sim in sims
            ]
            began, used = time.perf_counter(), time.process_time()
            for worker in workers:
                worker.start()
            for worker in workers:
                worker.join()
            best = min(best, time.perf_counter() - began)
            spent = min(spent, (time.process_time() - used) / count)
        one, cpu = one or best / count, cpu or spent
        report.add(sweep="threads", x=count, wall_s=best, throughput=count * one / best, cpu_ratio=spent / cpu)


def memory(report: common.Report, plan: Plan) -> None:
    """Largest memory after longer and longer stretches of one run that keeps no records in memory."""
    import tempfile
    from pathlib import Path

    sim = Simulation(cases.scene_30310(effects=EFFECTS, start=WHIRL))
    with tempfile.TemporaryDirectory() as folder:
        for i in range(2):  # until buffers of the file have their size
            sim.run(duration=plan.memory_s[0], output=Path(folder) / f"first{i}.h5")
        for i, duration in enumerate(plan.memory_s):
            sim.run(duration=duration, output=Path(folder) / f"{i}.h5")
            used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
            report.add(sweep="memory", x=duration, resident_mb=used)


def run(plan: Plan, options: argparse.Namespace) -> common.Report:
    """Everything."""
    report = common.Report("scaling", options, COLUMNS)
    memory(report, plan)
    sweeps: dict[str, list[tuple[float, Scene]]] = {
        "rollers": [(count, with_rollers(count)) for count in plan.rollers],
        "slices": [(count, with_slices(count)) for count in plan.slices],
        "speed": [(rpm, cases.scene_30310(rpm, effects=EFFECTS, start=WHIRL)) for rpm in plan.speeds],
        "load": [(load, cases.scene_30310(3000.0, load, effects=EFFECTS, start=WHIRL)) for load in plan.loads],
    }
    slopes = {}
    for sweep, scenes in sweeps.items():
        rows = [report.add(sweep=sweep, x=x, **cost_of(scene, plan)) for x, scene in scenes]
        if len(rows) > 1:
            names = ("us_per_evaluation", "us_per_step", "steps_per_revolution")
            slopes[sweep] = {name: slope(rows, name) for name in names}
    threads(report, plan)
    used = [row["resident_mb"] for row in report.results if row["sweep"] == "memory"]
    report.summary = {
        "slopes": slopes,
        "memory_growth_mb": used[-1] - used[0],
        "throughput_of_two": next(
            (row["throughput"] for row in report.results if row["sweep"] == "threads" and row["x"] == 2), None
        ),
    }
    report.inputs = {
        "scene": "30310 rig, 3000 rpm, 4930 N, whirling cage, 8 Gauss nodes a contact (sweep slices: uniform)",
        "accuracy": "standard",
        "revolutions": plan.revolutions,
        "instruction_set": Simulation(with_rollers(12)).instruction_set,
    }
    report.notes = [
        "Rollers: pitch diameter, axial load and cage mass grow with their number, speed falls with it, so that each roller "
        "sees the same speeds and load.",
        "Memory: records go to a file every 0.1 ms of bearing time; two stretches went before the first row.",
        "Threads: the best of 5; throughput says as much about what else the machine does, cpu_ratio does not.",
    ]
    return report


SWEEPS = {
    "rollers": "rollers",
    "slices": "uniform slices a contact",
    "speed": "speed (rpm)",
    "load": "axial load (N)",
}


def text_of(report: common.Report) -> str:
    """The tables: how cost grows first, then the points behind it."""
    slopes = report.summary["slopes"]
    parts = [
        "Exponents: cost grows as the quantity to this power.",
        "",
        common.table(
            [{"quantity": SWEEPS[name], **found} for name, found in slopes.items()],
            ("quantity", "us_per_evaluation", "us_per_step", "steps_per_revolution"),
            digits=2,
        ),
    ]
    names = ("us_per_evaluation", "us_per_step", "steps_per_revolution", "cpu_s_per_revolution")
    for sweep, title in SWEEPS.items():
        rows = [{title: row["x"], **row} for row in report.results if row["sweep"] == sweep]
        parts += ["", common.table(rows, (title, *names))]
    rows = [{"threads": row["x"], **row} for row in report.results if row["sweep"] == "threads"]
    parts += ["", common.table(rows, ("threads", "wall_s", "throughput", "cpu_ratio"))]
    rows = [{"bearing time (s)": row["x"], **row} for row in report.results if row["sweep"] == "memory"]
    parts += ["", common.table(rows, ("bearing time (s)", "resident_mb"), digits=5)]
    return "\n".join(parts)


def draw(report: common.Report) -> Any:
    """A panel a sweep."""
    plt = common.pyplot()
    figure, grid = plt.subplots(2, 3, figsize=(13.0, 8.0), layout="constrained")
    for axes, (sweep, label) in zip(grid.ravel(), SWEEPS.items(), strict=False):
        rows = [row for row in report.results if row["sweep"] == sweep]
        x = [row["x"] for row in rows]
        slopes = report.summary["slopes"].get(sweep, {})
        series = {"us_per_evaluation": "force evaluation (µs)", "us_per_step": "step, all told (µs)"}
        if sweep in ("speed", "load"):
            series = {"us_per_step": "step, all told (µs)", "steps_per_revolution": "steps a revolution"}
        for name, text in series.items():
            tail = f", slope {slopes[name]:.2f}" if name in slopes else ""
            axes.loglog(x, [row[name] for row in rows], "o-", label=text + tail)
        axes.set_xlabel(label)
        axes.set_title(f"cost against {sweep}")
        axes.set_xticks(x, [f"{value:g}" for value in x])
        values = [row[name] for row in rows for name in series]
        if max(values) < 30.0 * min(values):
            ticks = [t for t in (5, 7, 10, 15, 20, 30, 40, 50, 70, 100, 150) if min(values) <= t <= max(values)]
            axes.set_yticks(ticks, [f"{tick}" for tick in ticks])
        axes.minorticks_off()
        axes.legend(fontsize=8)
        axes.grid(alpha=0.3)
    left, right = grid.ravel()[-2:]
    rows = [row for row in report.results if row["sweep"] == "threads"]
    left.bar([str(row["x"]) for row in rows], [row["throughput"] for row in rows], width=0.5)
    left.set_xlabel("threads, one simulation each")
    left.set_ylabel("simulations a second, over one thread")
    left.set_title("independent simulations")
    rows = [row for row in report.results if row["sweep"] == "memory"]
    right.plot(np.cumsum([row["x"] for row in rows]), [row["resident_mb"] for row in rows], "o-")
    right.set_ylim(0.0, 1.3 * max(row["resident_mb"] for row in rows))
    right.set_xlabel("bearing time (s)")
    right.set_ylabel("memory of the process (MB)")
    right.set_title("memory over time")
    return figure


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    options = parser.parse_args(arguments)
    report = run(SMOKE if options.smoke else QUICK if options.quick else FULL, options)
    report.readme = text_of(report)
    print("\n" + report.readme)
    if not options.no_picture:
        common.save_picture(draw(report), "scaling")
    report.finish()
    return report


if __name__ == "__main__":
    main()
