"""Processor time of the steps in two builds, side by side: does a change of the core make it slower?

    python benchmarks/paired.py OTHER/.venv/bin/python [--rounds 2000] [--quick] [--json FILE]

OTHER is the checkout of another version with its environment (``make install`` there). Each scene runs in both builds at once,
each in a process of its own, and the two take turns: one computes a tenth of a turn of the shaft while the other waits, then
the other. A machine that gets slower or faster within seconds so meets both alike. A round gives a ratio of the times; the
median of all rounds counts, with its interval of 95 % confidence from the order of the ratios. Only steps are timed: no
records, no files. The builds may round differently, and a colliding cage then takes other steps: so the ratio of the time a
step is given as well.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import common
import numpy as np
from scipy.stats import binom

COLUMNS: Final = {
    "scene": "text: what is run",
    "rounds": "1: parts of the run, of a tenth of a turn each",
    "other_ms": "ms: processor time a turn of the other build, mean",
    "this_ms": "ms: processor time a turn of this build, mean",
    "ratio": "1: this over the other, median of the rounds",
    "low": "1: lower end of the median's interval of 95 % confidence",
    "high": "1: its upper end",
    "ratio_per_step": "1: ratio of the time a step, median of the rounds",
    "low_per_step": "1: lower end of its interval",
    "high_per_step": "1: its upper end",
}
PART: Final = 0.1
"""Turns of the shaft in a round."""
WORK: Final = """
import json, sys, time
import trbdyn as trb

name, part = sys.argv[1], float(sys.argv[2])
effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
scenes = {
    "colliding cage": lambda: trb.cases.scene_30310(3000.0, 4930.0, effects=effects, start=trb.Start.whirl(0.9)),
    "combined load": lambda: trb.cases.paper_30310(
        2000.0, 4930.0, effects=effects, start=trb.Start.whirl(0.9), radial_load=5530.0
    ),
    "smooth rolling": lambda: trb.cases.scene_30310(3000.0, 4930.0, effects=effects),
    "24 slices": lambda: trb.cases.paper_30310(
        3000.0, 4930.0, effects=effects.replace(quadrature="uniform", n_slices=24), start=trb.Start.whirl(0.9)
    ),
    "two bearings": lambda: trb.Assembly.pair(
        trb.cases.rig_30310(),
        "back to back",
        spread=0.15,
        end_play=-40e-6,
        shaft=trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3),
        speed_rpm=3000.0,
        start=trb.Start.whirl(0.9),
    ),
}
scene = scenes[name]()
simulation = trb.Simulation(scene, accuracy="standard")
turn, end = 60.0 / scene.speed_rpm, 1.0
while simulation.time < end * turn:
    simulation.step()
for _ in sys.stdin:
    end += part
    began, steps = time.process_time(), 0
    while simulation.time < end * turn:
        simulation.step()
        steps += 1
    print(json.dumps([time.process_time() - began, steps]), flush=True)
"""
SCENES: Final = ("colliding cage", "combined load", "smooth rolling", "24 slices", "two bearings")


class Worker:
    """A scene in a build, in a process of its own."""

    def __init__(self, python: str, scene: str) -> None:
        self.what = f"{python}: {scene}"
        words = [python, "-P", "-c", WORK, scene, str(PART)]
        self.process = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd="/"
        )

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.communicate()

    def timed(self) -> tuple[float, int]:
        """Processor time (s) and number of the steps of the next part."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        try:
            self.process.stdin.write("\n")
            self.process.stdin.flush()
            seconds, steps = json.loads(self.process.stdout.readline())
        except (OSError, ValueError):
            raise SystemExit(f"{self.what} failed:\n{self.process.communicate()[1][-2000:]}") from None
        return float(seconds), int(steps)


def interval(values: np.ndarray) -> tuple[float, float]:
    """Interval of 95 % confidence of a median: values in order, whose ranks follow from the binomial distribution."""
    ordered, n = np.sort(values), len(values)
    rank = max(int(binom.ppf(0.025, n, 0.5)) - 1, 0)
    return float(ordered[rank]), float(ordered[n - 1 - rank])


def row_of(scene: str, other: str, rounds: int) -> dict[str, Any]:
    """The row of a scene; which build comes first alternates."""
    found: tuple[list[tuple[float, int]], list[tuple[float, int]]] = ([], [])
    with Worker(other, scene) as before, Worker(sys.executable, scene) as now:
        for part in range(rounds + 1):
            for build in (0, 1) if part % 2 else (1, 0):
                found[build].append((before, now)[build].timed())
    old, new = (np.array(values[1:], dtype=float) for values in found)
    ratios, per_step = new[:, 0] / old[:, 0], new[:, 0] / new[:, 1] / (old[:, 0] / old[:, 1])
    return {
        "scene": scene,
        "rounds": rounds,
        "other_ms": 1e3 * float(old[:, 0].mean()) / PART,
        "this_ms": 1e3 * float(new[:, 0].mean()) / PART,
        "ratio": float(np.median(ratios)),
        "low": interval(ratios)[0],
        "high": interval(ratios)[1],
        "ratio_per_step": float(np.median(per_step)),
        "low_per_step": interval(per_step)[0],
        "high_per_step": interval(per_step)[1],
    }


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("other", type=Path, help="Python of the other build's environment")
    parser.add_argument("--rounds", type=int, default=2000)
    options = parser.parse_args(arguments)
    report = common.Report("paired", options, COLUMNS)
    other = str(options.other.absolute())
    rounds = 50 if options.quick else options.rounds
    report.inputs = {"rounds": rounds, "part": PART, "accuracy": "standard"}
    for scene in SCENES:
        report.add(**row_of(scene, other, rounds))
    print("\n" + common.table(report.results, COLUMNS))
    report.finish()
    return report


if __name__ == "__main__":
    main()
