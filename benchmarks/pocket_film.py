"""What an oil film between rollers and bars changes in the whirl of a cage, and what it costs.

    python benchmarks/pocket_film.py [--quick] [--json FILE]

The 30310 under an axial load of 4930 N with the default effects, from a start in a whirl (0.9 Cpr): without a film in pockets,
and with one that begins at gaps from 10 to 200 um; then with rougher and smoother pockets. The second half of each run is told.
Steps and evaluations do not depend on the machine; times are those of one core, and only ratios within a run of this command
can be compared.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Final

import common

import trbdyn as trb

COLUMNS: Final = {
    "speed_rpm": "rpm: speed",
    "film": "um: gap in which the oil makes a film; 0: none",
    "roughness": "um: of the pockets",
    "motion": "text: class of the motion of the cage",
    "orbit": "Cpr: orbit of the cage (root mean square about its mean place)",
    "pocket_p95": "N: force at a pocket that 95 % of the records stay below",
    "pocket_peak": "N: largest force at a pocket",
    "dry": "W: lost by dry friction in the pockets",
    "wet": "W: lost in the films of the pockets",
    "loss": "W: lost in the bearing",
    "steps": "1: steps for a turn",
    "ms": "ms: for a turn",
}
FILMS: Final = (0.0, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6)
SPEEDS: Final = (3000.0, 6000.0)


def measure(report: common.Report, speed: float, film: float, turns: float, roughness: float = 1e-6) -> None:
    """Run one case and add its row."""
    bearing = trb.cases.rig_30310().replace({"roughness.pocket": roughness})
    effects = trb.Effects.standard().replace(pocket_film=film)
    scene = trb.Scene(bearing, speed_rpm=speed, axial_load=4930.0, effects=effects, start=trb.Start.whirl(0.9))
    began = time.perf_counter()
    result = trb.Simulation(scene).run(revolutions=turns)
    seconds = time.perf_counter() - began
    late = result.window(0.5 * float(result.time[-1]), float(result.time[-1]))
    summary, motion = late.summary(), late.cage_motion
    report.add(
        speed_rpm=speed,
        film=1e6 * film,
        roughness=1e6 * roughness,
        motion=motion.kind,
        orbit=motion.orbit_over_play,
        pocket_p95=summary["pocket_force_p95"],
        pocket_peak=summary["pocket_force_peak"],
        dry=float(late["power_pocket"].mean()),
        wet=float(late["power_pocket_film"].mean()),
        loss=float(late.power_loss.mean()),
        steps=result.stats["steps"] / turns,
        ms=1e3 * seconds / turns,
    )


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("pocket_film", options, COLUMNS)
    turns = 4.0 if options.quick else 50.0
    report.inputs = {"axial_load": 4930.0, "revolutions": turns}
    for speed in SPEEDS[:1] if options.quick else SPEEDS:
        for film in FILMS:
            measure(report, speed, film, turns)
    for roughness in (0.2e-6, 5e-6):
        measure(report, SPEEDS[0], 50e-6, turns, roughness)
    report.readme = common.table(report.results, list(COLUMNS))
    print("\n" + report.readme)
    report.finish()
    return report


if __name__ == "__main__":
    main()
