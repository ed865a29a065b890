"""The cage as a spacer beside the cage: time, and how far averages are apart.

    python benchmarks/spacer.py [--quick] [--json FILE]
    python benchmarks/spacer.py --write-readme         puts the table into benchmarks/README.md

Scenes of three bearings under axial and combined loads, with the effects and tolerances that a user gets without asking. Each
runs with its cage and with a spacer in its place, parts of a turn in turns; which comes first alternates. What settles is left
out. Time is that of the stepping thread, without records.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Sequence
from typing import Any, Final

import common
import numpy as np
from ordinary import PAGES

import trbdyn as trb

SCENES: Final[tuple[tuple[str, float, float, float], ...]] = (
    ("30310", 3000.0, 4930.0, 0.0),
    ("30310", 3000.0, 1230.0, 0.0),
    ("30310", 3000.0, 150.0, 0.0),
    ("30310", 300.0, 4930.0, 0.0),
    ("30310", 2000.0, 4930.0, 5530.0),
    ("32216", 1500.0, 10000.0, 0.0),
    ("32216", 1500.0, 8000.0, 16000.0),
    ("30205", 5000.0, 1500.0, 0.0),
    ("30205", 5000.0, 1500.0, 3000.0),
)
"""Bearing, speed (rpm), axial and radial load (N)."""
PARTS: Final = 10

COLUMNS: Final = {
    "bearing": "text: its name",
    "speed_rpm": "rpm: of the shaft",
    "axial_load": "N: on the inner ring",
    "radial_load": "N: on the inner ring",
    "time_ratio": "1: processor time of the steps with a spacer over that with the cage, median of the parts in turns",
    "steps_ratio": "1: steps with a spacer over those with the cage",
    "largest_load_off": "%: difference of the largest load of a roller on the inner raceway, over that with the cage",
    "loss_off": "%: the same of the mean loss",
    "torque_off": "%: the same of the mean torque",
    "film_off": "%: the same of the mean film parameter at the inner raceway",
    "slip_cage": "%: slip of the set with the cage",
    "slip_spacer": "%: the same with the spacer",
    "slow": "1: median ratio of time",
    "worst_loss_off": "%: largest difference of a loss",
}


def scene_of(bearing: str, speed: float, axial: float, radial: float, bodies: str) -> trb.Scene:
    """A scene with a cage or a spacer."""
    one = {"30310": trb.cases.rig_30310, "32216": trb.cases.bearing_32216}
    made = one[bearing]() if bearing in one else trb.Bearing.from_catalogue(**PAGES[bearing], name=bearing)
    return trb.Scene(made, speed_rpm=speed, axial_load=axial, radial_load=radial, effects=trb.Effects(bodies=bodies))


def averages(result: trb.Result) -> dict[str, float]:
    """What is compared."""
    numbers = result.summary()
    time_ = np.asarray(result["time"])
    lost = sum(
        float(result[field.name][-1] - result[field.name][0])
        for field in result.fields
        if field.name.startswith("loss_")
    )
    load = np.asarray(result["inner_load"]).max(axis=1)
    return {
        "largest_load": float(np.mean(load)),
        "loss": lost / float(time_[-1] - time_[0]),
        "torque": float(numbers["torque"]),
        "film": float(numbers["film_parameter_inner"]),
        "slip": 100.0 * float(numbers["cage_slip"]),
    }


def row_of(scene: tuple[str, float, float, float], settle: float, turns: float) -> dict[str, Any]:
    """Both in turns for the time; then a run of each for the averages."""
    scenes = [scene_of(*scene, bodies=bodies) for bodies in ("rollers_and_cage", "rollers_and_spacer")]
    sims, turn = [trb.Simulation(one) for one in scenes], 60.0 / scene[1]
    for sim in sims:
        while sim.time < settle * turn:
            sim.step()
    before, spent = [sim.statistics["steps"] for sim in sims], np.zeros((2, PARTS))
    for part in range(PARTS):
        for k in (0, 1) if part % 2 else (1, 0):
            began = time.thread_time()
            while sims[k].time < (settle + (part + 1) * turns / PARTS) * turn:
                sims[k].step()
            spent[k, part] = time.thread_time() - began
    steps = [sim.statistics["steps"] - was for sim, was in zip(sims, before, strict=True)]
    cage, spacer = (averages(sim.run(revolutions=turns, save_every=turn / 200)) for sim in sims)
    off = {
        f"{name}_off": 100.0 * (spacer[name] / cage[name] - 1.0) for name in ("largest_load", "loss", "torque", "film")
    }
    return {
        "time_ratio": float(np.median(spent[1] / spent[0])),
        "steps_ratio": steps[1] / steps[0],
        **off,
        "slip_cage": cage["slip"],
        "slip_spacer": spacer["slip"],
    }


def main(arguments: Sequence[str] | None = None) -> common.Report:
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("spacer", options, COLUMNS)
    settle, turns, scenes = (
        (0.2, 0.2, SCENES[:1]) if options.smoke else (2.0, 4.0, SCENES) if options.quick else (10.0, 20.0, SCENES)
    )
    report.inputs = {"settle_turns": settle, "turns": turns, "parts": PARTS}
    warnings.simplefilter("ignore")
    for scene in scenes:
        report.add(
            **dict(zip(("bearing", "speed_rpm", "axial_load", "radial_load"), scene, strict=True)),
            **row_of(scene, settle, turns),
        )
    report.summary["slow"] = float(np.median([row["time_ratio"] for row in report.results]))
    report.summary["worst_loss_off"] = max((row["loss_off"] for row in report.results), key=abs)
    report.readme = common.table(report.results, [name for name in COLUMNS if name not in report.summary])
    print("\n" + report.readme)
    report.finish()
    return report


if __name__ == "__main__":
    main()
