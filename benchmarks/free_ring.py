"""What a ring that is free costs: time, steps and error of the cage beside those of a held ring, in one run, in turns.

    python benchmarks/free_ring.py [--quick] [--json FILE]

The same scenes with a held ring, with a free ring of 0.7 kg and with a rotor of 20 kg. Time is processor time of the steps alone,
of pieces of bearing time that all of them take in turns. The error is that of the cage's centre after a few milliseconds from a
state in the middle of the run, against a fiftieth of the tolerances; it is measured for each ring beside itself.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import common
import numpy as np

from trbdyn import RingBody, Scene, Simulation, Start, cases
from trbdyn.run.options import Tolerances

SHOWN = ("scene", "ring", "ms_per_turn", "steps_per_turn", "evaluations_per_turn", "error", "time_ratio")

COLUMNS = {
    "scene": "text: what turns",
    "ring": "text: held, or free with its mass",
    "ms_per_turn": "ms: processor time of the steps of a turn of the shaft, median of the pieces",
    "steps_per_turn": "1: steps a turn",
    "evaluations_per_turn": "1: evaluations of the equations of motion a turn",
    "error": "1: largest error of the cage's centre within the window, over Cpr",
    "time_ratio": "1: time over that of the held ring",
    "worst_ratio": "1: largest time_ratio of a ring of 0.7 kg",
}
WINDOW = 3e-3
"""Bearing time of the comparison with tight tolerances (s)."""
TIGHTER = 50.0
"""Factor of the tight tolerances."""
RINGS = {
    "held": None,
    "free, 0.7 kg": RingBody.hollow_cylinder(mass=0.7, inner_diameter=0.05, outer_diameter=0.072, length=0.027),
    "free, 20 kg": RingBody.hollow_cylinder(mass=20.0, outer_diameter=0.08, length=0.5),
}


def scenes() -> dict[str, Scene]:
    """What is run, with held rings."""
    rig = cases.rig_30310()
    return {
        "colliding cage": Scene(rig, speed_rpm=3000.0, axial_load=4930.0, start=Start.whirl(0.9)),
        "combined load": Scene(rig, speed_rpm=3000.0, axial_load=4930.0, radial_load=5530.0),
    }


def with_ring(scene: Scene, body: RingBody | None) -> Scene:
    """The scene with a free ring; its moments are free, as those of a held ring are not."""
    return scene if body is None else scene.replace(ring="free", ring_body=body)


def advance(simulation: Simulation, duration: float) -> float:
    """Step on for some bearing time (s); gives the processor time (s)."""
    end, begin = simulation.time + duration, time.process_time()
    while simulation.time < end:
        simulation.step()
    return time.process_time() - begin


def error_of(scene: Scene, simulation: Simulation) -> float:
    """Largest error of the cage's centre over Cpr within the window from the simulation's state on."""
    start = scene.replace(start=Start.state(simulation.state))
    usual = simulation.options.tolerances.to_dict()
    paths = []
    for factor in (1.0, 1.0 / TIGHTER):
        finer = Simulation(start, **{name: factor * usual[name] for name in Tolerances.model_fields})
        paths.append(finer.run(duration=WINDOW, save_every=WINDOW / 30)["cage_position"])
    return float(np.max(np.abs(paths[1] - paths[0])) / scene.bearing.cage.play_radial)


def rows_of(name: str, scene: Scene, pieces: int) -> list[dict[str, Any]]:
    """One scene with every ring, pieces of a quarter of a turn in turns."""
    quarter = 15.0 / float(scene.speed_rpm)
    sims = {ring: Simulation(with_ring(scene, body)) for ring, body in RINGS.items()}
    for sim in sims.values():
        advance(sim, 8 * quarter)
    before = {ring: sim.statistics for ring, sim in sims.items()}
    taken: dict[str, list[float]] = {ring: [] for ring in sims}
    for _ in range(pieces):
        for ring, sim in sims.items():
            taken[ring].append(advance(sim, quarter))
    out = []
    for ring, sim in sims.items():
        now, turns = sim.statistics, pieces / 4
        out.append(
            {
                "scene": name,
                "ring": ring,
                "ms_per_turn": 4e3 * float(np.mean(taken[ring])),
                "steps_per_turn": (now["steps"] - before[ring]["steps"]) / turns,
                "evaluations_per_turn": (now["rhs_evaluations"] - before[ring]["rhs_evaluations"]) / turns,
                "error": error_of(sim.scene, sim),
                "time_ratio": float(np.sum(taken[ring]) / np.sum(taken["held"])),
            }
        )
    return out


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    parser.add_argument("--smoke", action="store_true", help="the least that goes through everything; seconds")
    options = parser.parse_args(arguments)
    report = common.Report("free_ring", options, COLUMNS)
    for name, scene in scenes().items():
        for row in rows_of(name, scene, 1 if options.smoke else 16 if options.quick else 160):
            report.add(**row)
    report.summary["worst_ratio"] = max(row["time_ratio"] for row in report.results if row["ring"] == "free, 0.7 kg")
    report.readme = common.table(report.results, SHOWN)
    print(report.readme)
    report.finish()
    return report


if __name__ == "__main__":
    main()
