"""Ordinary scenes, drawn by a seed: whether any is slower than real time, and whether all are right.

    python benchmarks/ordinary.py [--seed 0] [--scenes 60] [--beside bdf] [--quick] [--json FILE]

Bearings are those of catalogue pages, and the two that are shipped; 400 to 7000 rpm and loads of 2 to 40 % of the dynamic rating
C, each drawn evenly in its logarithm, half of the scenes with a radial load of 0.3 to 3 times the axial one; effects and
tolerances are those that a user gets without asking. Each scene runs for a turn that is forgotten, then for another one in
which processor time and steps are counted. It is judged against a run of the same part with the tolerances of `reference`,
exact forces of raceways and ribs and no tangents, of `bdf`: the mean loss. With ``--beside`` another integrator takes the same
part in turns with the usual one, a tenth of it at a time, and is judged likewise.
"""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Sequence
from typing import Any, Final

import common
import numpy as np

import trbdyn as trb
from trbdyn.model.cases import bearing_32216, rig_30310

PAGES: Final[dict[str, dict[str, float]]] = {
    "30205": {"bore": 0.025, "outside": 0.052, "width": 0.01625, "C": 30.8e3, "e": 0.37},
    "32008": {"bore": 0.040, "outside": 0.068, "width": 0.019, "C": 52.8e3, "e": 0.37},
    "33213": {"bore": 0.065, "outside": 0.120, "width": 0.041, "C": 194e3, "e": 0.40},
    "32220": {"bore": 0.100, "outside": 0.180, "width": 0.049, "C": 319e3, "e": 0.43},
}
"""Boundary dimensions (m), dynamic rating (N) and factor e of catalogue pages."""
SHIPPED: Final = {"30310": (rig_30310, 130e3), "32216": (bearing_32216, 187e3)}
"""Bearings of the package with their dynamic ratings (N)."""

COLUMNS: Final = {
    "scene": "1: its number",
    "bearing": "text: its name",
    "speed_rpm": "rpm: of the shaft",
    "axial_load": "N: on the inner ring",
    "radial_load": "N: on the inner ring",
    "share_of_C": "1: size of the load over the dynamic rating",
    "real_time_factor": "1: bearing time over processor time of the steps",
    "ms": "ms: processor time of the steps of a turn",
    "steps": "1: steps a turn",
    "evaluations": "1: force evaluations of the integrator a turn",
    "exact": "1: share of the rollers whose forces at raceways and ribs are evaluated and not followed",
    "loss": "W: mean loss",
    "loss_off": "1: its difference from the tight run, over it",
    "closure": "1: residual of the energy audit over the dissipated work",
    "warnings": "1: warnings of the run",
    "time_ratio": "1: processor time of the other integrator over that of the usual one, median of ten parts in turns",
    "body_ratio": "1: steps of bodies of the usual integrator over those of the other one",
    "beside_loss_off": "1: difference of the other integrator's loss from the tight run, over it",
    "beside_closure": "1: its residual of the energy audit over the dissipated work",
    "beside_warnings": "1: warnings of its run",
    "mean_time_ratio": "1: geometric mean of the ratios of time",
    "worst_time_ratio": "1: largest of them",
    "mean_body_ratio": "1: geometric mean of the ratios of steps",
    "worst_beside_loss_off": "1: largest difference of its loss from the tight run",
    "median_beside_loss_off": "1: median of these differences",
    "scenes": "1: scenes",
    "slower": "1: of them slower than real time",
    "median_factor": "1: median of their real-time factors",
    "least_factor": "1: least of their real-time factors",
    "median_ms": "ms: median of a turn's time",
    "median_steps": "1: median of the steps a turn",
    "worst_loss_off": "1: largest difference of a loss from its tight run",
    "median_loss_off": "1: median of these differences",
    "warned": "1: scenes with a warning",
}


def drawn(rng: np.random.Generator) -> tuple[dict[str, Any], trb.Scene]:
    """What a scene is, and the scene."""
    name = str(rng.choice([*PAGES, *SHIPPED]))
    if name in PAGES:
        rating, bearing = PAGES[name]["C"], trb.Bearing.from_catalogue(**PAGES[name], name=name)
    else:
        make, rating = SHIPPED[name]
        bearing = make()
    speed = math.exp(rng.uniform(math.log(400.0), math.log(7000.0)))
    share = math.exp(rng.uniform(math.log(0.02), math.log(0.4)))
    ratio = math.exp(rng.uniform(math.log(0.3), math.log(3.0))) if rng.random() < 0.5 else 0.0
    axial = share * rating / math.hypot(1.0, ratio)
    row = {
        "bearing": name,
        "speed_rpm": speed,
        "axial_load": axial,
        "radial_load": ratio * axial,
        "share_of_C": share,
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        scene = trb.cases.scene_30310(speed, axial, ratio * axial)
        scene = scene.replace(bearing=bearing)
    return row, scene


def measured(scene: trb.Scene, settle: float, turns: float) -> tuple[dict[str, Any], Any]:
    """Time and steps of a part, and the state from which it started."""
    sim = trb.Simulation(scene)
    turn = 60.0 / float(scene.speed_rpm)
    while sim.time < settle * turn:
        sim.step()
    state, before, counted = sim.state, sim.statistics, sim.counters
    end, began = sim.time + turns * turn, time.process_time()
    while sim.time < end:
        sim.step()
    spent, bearing = time.process_time() - began, sim.time - state.time
    found = {name: (sim.statistics[key] - before[key]) / turns for name, key in NAMES.items()}
    exact, followed = (sim.counters[name] - counted[name] for name in ("exact_rollers", "tangent_rollers"))
    found["exact"] = exact / (exact + followed)
    return found | {"ms": 1e3 * spent * turn / bearing, "real_time_factor": bearing / spent}, state


def in_turns(scene: trb.Scene, settle: float, turns: float, other: str) -> dict[str, float]:
    """Time and steps of another integrator beside the usual one; which comes first alternates."""
    sims = [trb.Simulation(scene), trb.Simulation(scene, integrator=other)]
    turn = 60.0 / float(scene.speed_rpm)
    spent: tuple[list[float], list[float]] = ([], [])
    for sim in sims:
        while sim.time < settle * turn:
            sim.step()
    before = [sim.statistics["body_steps"] for sim in sims]
    for part in range(1, 11):
        for k in (0, 1) if part % 2 else (1, 0):
            began = time.thread_time()
            while sims[k].time < (settle + 0.1 * part * turns) * turn:
                sims[k].step()
            spent[k].append(time.thread_time() - began)
    steps = [sim.statistics["body_steps"] - was for sim, was in zip(sims, before, strict=True)]
    return {"time_ratio": float(np.median(np.divide(spent[1], spent[0]))), "body_ratio": steps[0] / steps[1]}


NAMES: Final = {"steps": "steps", "evaluations": "rhs_evaluations"}
TIGHT: Final[dict[str, Any]] = {"integrator": "bdf", "accuracy": "reference", "rings_share": 0.0}


def loss_of(scene: trb.Scene, state: Any, duration: float, settings: dict[str, Any]) -> tuple[float, float, int]:
    """Mean loss (W), closure and warnings of a run from a state."""
    sim = trb.Simulation(scene.replace(start=trb.Start.state(state.vector, time=state.time)), **settings)
    result = sim.run(duration=duration, save_every=duration / 50.0, save_groups=("time", "energy"))
    losses = [field.name for field in result.fields if field.name.startswith("loss_")]
    lost = sum(float(result[name][-1] - result[name][0]) for name in losses)
    return lost / result.duration, result.energy_closure, len(result.warnings)


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--unjudged", action="store_true", help="no tight runs")
    parser.add_argument("--beside", choices=("bdf", "erk"), help="another integrator, in turns with the usual one")
    options = parser.parse_args(arguments)
    report = common.Report("ordinary", options, COLUMNS)
    count, settle, turns = (6, 0.3, 0.1) if options.quick else (options.scenes, 1.0, 1.0)
    report.inputs = {"seed": options.seed, "scenes": count, "settle_turns": settle, "turns": turns, "tight": TIGHT}
    for number in range(count):
        row, scene = drawn(np.random.default_rng([options.seed, number]))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found, state = measured(scene, settle, turns)
            if not options.unjudged:
                duration = 0.2 * turns * 60.0 / row["speed_rpm"]
                loss, closure, warned = loss_of(scene, state, duration, {})
                tight, _, _ = loss_of(scene, state, duration, TIGHT)
                found |= {"loss": loss, "loss_off": abs(loss / tight - 1.0), "closure": closure, "warnings": warned}
            if options.beside:
                found |= in_turns(scene, settle, turns, options.beside)
            if options.beside and not options.unjudged:
                loss, closure, warned = loss_of(scene, state, duration, {"integrator": options.beside})
                off = abs(loss / tight - 1.0)
                found |= {"beside_loss_off": off, "beside_closure": closure, "beside_warnings": warned}
        report.add(scene=number, **row, **found)
        print(common.table(report.results[-1:], SHOWN).splitlines()[-1], flush=True)
    factors = np.array([row["real_time_factor"] for row in report.results])
    report.summary = {
        "scenes": count,
        "slower": int((factors < 1.0).sum()),
        "median_factor": float(np.median(factors)),
        "least_factor": float(factors.min()),
        "median_ms": float(np.median([row["ms"] for row in report.results])),
        "median_steps": float(np.median([row["steps"] for row in report.results])),
    }
    if not options.unjudged:
        off = np.array([row["loss_off"] for row in report.results])
        report.summary |= {
            "worst_loss_off": float(off.max()),
            "median_loss_off": float(np.median(off)),
            "warned": sum(row["warnings"] > 0 for row in report.results),
        }
    if options.beside:
        ratios, bodies = (np.array([row[name] for row in report.results]) for name in ("time_ratio", "body_ratio"))
        report.summary |= {
            "mean_time_ratio": float(np.exp(np.log(ratios).mean())),
            "worst_time_ratio": float(ratios.max()),
            "mean_body_ratio": float(np.exp(np.log(bodies).mean())),
        }
    if options.beside and not options.unjudged:
        off = np.array([row["beside_loss_off"] for row in report.results])
        report.summary |= {"worst_beside_loss_off": float(off.max()), "median_beside_loss_off": float(np.median(off))}
    shown = (*SHOWN, *BESIDE) if options.beside else SHOWN
    print("\n" + common.table(report.results, shown) + "\n\n" + common.table([report.summary], report.summary))
    report.finish()
    return report


SHOWN: Final = (
    "scene",
    "bearing",
    "speed_rpm",
    "axial_load",
    "radial_load",
    "real_time_factor",
    "ms",
    "steps",
    "evaluations",
    "exact",
    "loss_off",
    "closure",
    "warnings",
)

BESIDE: Final = ("time_ratio", "body_ratio")

if __name__ == "__main__":
    main()
