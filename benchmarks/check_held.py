"""Whether the error that the check of a run states holds the true one, in the sixty ordinary scenes of ordinary.py.

    python benchmarks/check_held.py [--seed 0] [--scenes 60] [--turns 1] [--quick] [--json FILE]

Each scene is run from its usual start as a user runs it, and `trbdyn.check` is asked with its usual time. The true error is the
difference of the run's number from the mean of three runs with a tenth of the tolerances of 'reference', every force exact,
which begin in states that are moved by a millionth, each in another way than those of the check.
"""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Sequence
from typing import Any, Final

import common
import numpy as np
from ordinary import drawn

import trbdyn as trb
from trbdyn.results import numbers
from trbdyn.results.number import Number, Seen
from trbdyn.run.options import ACCURACY

JUDGED: Final = ("power_loss", "torque", "outer_load_mean", "inner_load_mean", "rib_load_mean", "pocket_force_peak")
"""Numbers that are judged."""
TIGHT: Final[dict[str, Any]] = {
    "integrator": "bdf",
    "accuracy": "reference",
    "rings_share": 0.0,
    **{name: 0.1 * value for name, value in ACCURACY["reference"].model_dump().items()},
}
RUNS: Final = 3
"""Tight runs of a scene."""
MOVED: Final = 1e-6
COLUMNS: Final = {
    "scene": "1: its number",
    "bearing": "text: its name",
    "number": "text: name of the number",
    "answer": "text: what the check says of it",
    "stated": "1: error that the check states, over the number",
    "true": "1: true error, over the number",
    "bias": "1: bias that the check found, over the number",
    "half_width": "1: half of its interval",
    "scatter": "1: standard deviation of repetitions, over the number",
    "degrees": "1: degrees of freedom that the scatter is known by",
    "held": "1: whether the stated error holds the true one",
    "run_s": "s: processor time of the run",
    "check_s": "s: processor time of the check",
    "judged": "1: numbers that were judged",
    "share_held": "1: share of them whose stated error holds the true one",
    "share_clear": "1: share of them that the check calls right within 3 %",
    "clear_held": "1: share of those called so whose true error is below 3 %",
    "largest_check_s": "s: longest processor time of a check, less a tenth of its run",
    "doubted_scenes": "1: share of the scenes with a loss that is right within 3 %, and is not called so",
}


def held(row: dict[str, Any], scene: trb.Scene, turns: float) -> list[dict[str, Any]]:
    """What the check states of each number of a scene, and its true error."""
    duration = turns * 60.0 / float(scene.speed_rpm)
    options: dict[str, Any] = {"duration": duration, "save_every": duration / 200.0}
    began = time.process_time()
    result = trb.Simulation(scene).run(**options)
    spent = time.process_time() - began
    found = trb.check(result)
    since = float(result.settling().time)
    rows = [one for one in numbers.rows() if one.name in JUDGED]
    own = _values(result, since, rows)
    random = np.random.default_rng(977)
    right = []
    for _ in range(RUNS):
        sim = trb.Simulation(scene, **TIGHT)
        vector = sim.state.vector
        sim.set_state(vector * (1.0 + MOVED * random.standard_normal(vector.size)), sim.time)
        right.append(_values(sim.run(**options), since, rows))
    judged = []
    for name, one in found.numbers.items():
        if name in own and all(name in values for values in right):
            mean = float(np.mean([values[name] for values in right]))
            off = abs(own[name] - mean) / max(abs(mean), abs(own[name]), 1e-300)
            judged.append(
                row
                | {"number": name, "answer": one.answer, "stated": one.error, "true": off, "held": off <= one.error}
                | {"bias": one.bias, "half_width": one.half_width, "scatter": one.scatter, "degrees": one.degrees}
                | {"run_s": spent, "check_s": found.spent_s}
            )
    return judged


def _values(result: Any, since: float, rows: Sequence[Number]) -> dict[str, float]:
    seen = Seen(result, result.window(since))
    values = {row.name: seen.value(row) for row in rows}
    return {name: float(value) for name, value in values.items() if value is not None and math.isfinite(value)}


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--turns", type=float, default=1.0, help="length of each run")
    options = parser.parse_args(arguments)
    report = common.Report("check_held", options, COLUMNS)
    count, turns = (1, 0.1) if options.quick else (options.scenes, options.turns)
    report.inputs = {"seed": options.seed, "scenes": count, "turns": turns, "tight": TIGHT, "runs": RUNS}
    for number in range(count):
        row, scene = drawn(np.random.default_rng([options.seed, number]))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = held({"scene": number, "bearing": row["bearing"]}, scene, turns)
        for one in found:
            report.add(**one)
        doubted = ", ".join(f"{one['number']} {100 * one['true']:.2g} of {100 * one['stated']:.2g} %" for one in found)
        print(f"{number} {row['bearing']}: {doubted}", flush=True)
    report.summary = _summary(report.results)
    for name in JUDGED:
        of = [one for one in report.results if one["number"] == name]
        print(f"{name}: {sum(one['held'] for one in of)} of {len(of)} held, {_worst(of)}")
    print(report.summary)
    report.finish()
    return report


def _worst(rows: Sequence[dict[str, Any]]) -> str:
    outside = max((one for one in rows if not one["held"]), key=lambda one: one["true"], default=None)
    if outside is None:
        return "none outside"
    return f"worst outside: scene {outside['scene']}, {100 * outside['true']:.2g} % for {100 * outside['stated']:.2g} %"


def _summary(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    clear = [one for one in rows if one["answer"] == "clear"]
    losses = [one for one in rows if one["number"] == "power_loss" and one["true"] < 0.03]
    return {
        "judged": len(rows),
        "share_held": float(np.mean([one["held"] for one in rows])),
        "share_clear": len(clear) / len(rows),
        "clear_held": float(np.mean([one["true"] < 0.03 for one in clear])) if clear else math.nan,
        "largest_check_s": max(one["check_s"] - 0.1 * one["run_s"] for one in rows),
        "doubted_scenes": float(np.mean([one["answer"] != "clear" for one in losses])) if losses else math.nan,
    }


if __name__ == "__main__":
    main()
