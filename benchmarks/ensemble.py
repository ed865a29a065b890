"""How many designs of a cage can be run in a minute, and how well a fit to them predicts designs that it has not seen.

    python benchmarks/ensemble.py [--quick] [--json FILE] [--folder FOLDER]

Draws of seven inputs of the 30310 together: both plays of the pocket, density of the cage (its mass and moments of inertia
follow), temperature of the oil, boundary friction, speed and axial load. Every run begins in a large whirl and has 25 turns of
the shaft, about ten of the cage. With a folder (2.4 MB a design) a run that was stopped goes on.
The fits are those of `trbdyn.surrogate`.
"""

from __future__ import annotations

import os
import re
import time
from collections import Counter
from collections.abc import Sequence

import common

import trbdyn as trb

COLUMNS = {
    "quantity": "text: observable that is predicted",
    "unit": "text: its unit",
    "low": "as unit: of 95 % of the designs",
    "high": "as unit: of 95 % of the designs",
    "error": "as unit: root mean square error on designs that the fit has not seen",
    "explained": "1: share of the variance that it predicts there",
    "inputs": "text: total indices of Sobol, the largest first",
    "designs": "1: that could be run",
    "seconds": "s: for all runs",
    "per_core_minute": "1/min: designs run in a minute of a core",
    "fit_seconds": "s: for a fit, its error and the indices",
}
BANDS = {
    "bearing.cage.play_circumferential": (0.06e-3, 0.20e-3),
    "bearing.cage.play_radial": (0.15e-3, 0.30e-3),
    "bearing.cage.material.density": (1300.0, 7850.0),
    "lubricant.temperature_c": (40.0, 90.0),
    "effects.friction.boundary_limit": (0.07, 0.2),
    "scene.speed_rpm": (1000.0, 6000.0),
    "scene.axial_load": (1000.0, 5000.0),
}
QUANTITIES = (
    "torque",
    "orbit_rms_over_cpr",
    "axis_distance_over_cpr",
    "pocket_force_peak",
)


def scene() -> trb.Scene:
    """The rig with a cage whose mass follows from its density."""
    rig, body = trb.cases.rig_30310(), trb.cases.cage_body_30310()
    cage = trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=body, material=trb.Material.steel())
    oil = trb.cases.scene_30310(3000.0, 3080.0).lubricant
    bearing = rig.replace(cage=cage)
    return trb.Scene(bearing, speed_rpm=3000.0, axial_load=3080.0, lubricant=oil, start=trb.Start.whirl(0.9))


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    parser.add_argument("--designs", type=int, default=2000, metavar="N", help="how many are drawn (2000)")
    parser.add_argument("--folder", metavar="FOLDER", help="keep the runs there")
    options = parser.parse_args(arguments)
    report = common.Report("ensemble", options, COLUMNS)
    count, turns = (64, 2.0) if options.quick else (options.designs, 25.0)
    report.inputs = {"bands": BANDS, "designs": count, "revolutions": turns}
    began = time.perf_counter()
    run = trb.RunOptions(revolutions=turns, accuracy="fast")
    found = trb.uncertainty(scene(), BANDS, samples=count, options=run, folder=options.folder)
    seconds = time.perf_counter() - began
    per_minute = 60.0 * found.draws / seconds / (os.cpu_count() or 1)
    reasons = Counter(re.sub(r"-?\d[\d.e-]*", "#", text) for text in found.refused)
    print(*(f"{number} refused: {text}" for text, number in reasons.most_common(5)), sep="\n", flush=True)
    for name in QUANTITIES:
        if name not in found.spreads:
            continue
        began = time.perf_counter()
        fast = trb.surrogate(found, name)
        took = time.perf_counter() - began
        print(fast, flush=True)
        ordered = sorted(fast.indices.items(), key=lambda entry: -entry[1].total)
        inputs = ", ".join(f"{path.split('.')[-1]} {index.total:.2f}" for path, index in ordered if index.total >= 0.05)
        report.add(
            quantity=name,
            unit=fast.unit,
            low=found[name].low,
            high=found[name].high,
            error=fast.error,
            explained=fast.explained,
            inputs=inputs,
            designs=found.draws,
            seconds=seconds,
            per_core_minute=per_minute,
            fit_seconds=took,
        )
    print("\n" + common.table(report.results, list(COLUMNS)))
    report.readme = common.table(report.results, list(COLUMNS)[:7])
    report.finish()
    return report


if __name__ == "__main__":
    main()
