"""Processor time of the steps in two builds, in pairs: does a change of the core make it slower?

    python benchmarks/paired.py OTHER/.venv/bin/python [--pairs 9] [--quick] [--json FILE]

OTHER is the checkout of another version with its environment (``make install`` there). In each pair every scene is run once by
both builds, each in a process of its own and in turns, so that a machine that gets slower meets both; the median of the ratios
counts. Only steps are timed: no records, no files. The builds may round differently, and a colliding cage then takes other
steps: so the ratio of the time a step is given as well.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import common
import numpy as np

COLUMNS = {
    "scene": "text: what is run",
    "turns": "1: turns of the shaft",
    "other_ms": "ms: processor time a turn of the other build, median",
    "this_ms": "ms: processor time a turn of this build, median",
    "ratio": "1: this over the other, median of the pairs",
    "least": "1: smallest ratio of a pair",
    "most": "1: largest ratio of a pair",
    "ratio_per_step": "1: ratio of the time a step, median of the pairs",
}
TURNS = 4.0
WORK = """
import json, sys, time
import trbdyn as trb

name, turns = sys.argv[1], float(sys.argv[2])
effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
scenes = {
    "colliding cage": lambda: trb.cases.scene_30310(3000.0, 4930.0, effects=effects, start=trb.Start.whirl(0.9)),
    "combined load": lambda: trb.cases.scene_30310(
        2000.0, 4930.0, effects=effects, start=trb.Start.whirl(0.9), radial_load=5530.0
    ),
    "smooth rolling": lambda: trb.cases.scene_30310(3000.0, 4930.0, effects=effects),
    "24 slices": lambda: trb.cases.scene_30310(
        3000.0, 4930.0, effects=effects.replace(quadrature="uniform", n_slices=24), start=trb.Start.whirl(0.9)
    ),
}
scene = scenes[name]()
simulation = trb.Simulation(scene, accuracy="standard")
turn = 60.0 / scene.speed_rpm
while simulation.time < turn:
    simulation.step()
began, steps = time.process_time(), 0
while simulation.time < (1.0 + turns) * turn:
    simulation.step()
    steps += 1
print(json.dumps([time.process_time() - began, steps]))
"""
SCENES = ("colliding cage", "combined load", "smooth rolling", "24 slices")


def timed(python: str, scene: str, turns: float) -> tuple[float, int]:
    """Processor time (s) and number of the steps in a build."""
    words = [python, "-P", "-c", WORK, scene, str(turns)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, cwd="/")
    if done.returncode:
        raise SystemExit(f"{python}: {scene} failed:\n{done.stderr[-2000:]}")
    seconds, steps = json.loads(done.stdout)
    return float(seconds), int(steps)


def row_of(scene: str, other: str, turns: float, pairs: int) -> dict[str, Any]:
    """The row of a scene; which build comes first alternates."""
    found: tuple[list[tuple[float, int]], list[tuple[float, int]]] = ([], [])
    builds = (other, sys.executable)
    for pair in range(pairs):
        for build in (0, 1) if pair % 2 else (1, 0):
            found[build].append(timed(builds[build], scene, turns))
    before, now = (np.array(values, dtype=float) for values in found)
    ratios = now[:, 0] / before[:, 0]
    return {
        "scene": scene,
        "turns": turns,
        "other_ms": 1e3 * float(np.median(before[:, 0])) / turns,
        "this_ms": 1e3 * float(np.median(now[:, 0])) / turns,
        "ratio": float(np.median(ratios)),
        "least": float(ratios.min()),
        "most": float(ratios.max()),
        "ratio_per_step": float(np.median(ratios * before[:, 1] / now[:, 1])),
    }


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("other", type=Path, help="Python of the other build's environment")
    parser.add_argument("--pairs", type=int, default=9)
    options = parser.parse_args(arguments)
    report = common.Report("paired", options, COLUMNS)
    other = str(options.other.absolute())
    pairs = 3 if options.quick else options.pairs
    report.inputs = {"pairs": pairs, "turns": TURNS, "accuracy": "standard"}
    for scene in SCENES:
        report.add(**row_of(scene, other, TURNS, pairs))
    print("\n" + common.table(report.results, COLUMNS))
    report.finish()
    return report


if __name__ == "__main__":
    main()
