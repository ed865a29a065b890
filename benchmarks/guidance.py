"""A cage that is guided by rollers, by a land of the inner ring and by one of the outer ring, from 1000 to 15 000 rpm.

    python benchmarks/guidance.py [--quick] [--json FILE]

The 30310 under an axial load of 4930 N, with the oil of the paper. The lands have a radial clearance of 60 um, less than the
pockets leave to the cage, and the assumed dimensions of the package in all else. Every run begins with a small whirl of a tenth
of the radial play (25 um) and has 60 turns of the shaft; the second half is told.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import common

import trbdyn as trb

COLUMNS = {
    "guidance": "text: what guides the cage",
    "speed_rpm": "rpm: speed",
    "motion": "text: class of the motion of the cage",
    "orbit": "um: orbit of the cage (root mean square about its mean place)",
    "off_axis": "um: mean distance of the cage's centre from the axis",
    "whirl_ratio": "1: frequency of the whirl over the cage's",
    "cage_slip": "1: how much slower than by pure rolling the cage turns",
    "pocket_p95": "N: force at a pocket that 95 % of the records stay below",
    "pocket_peak": "N: largest force at a pocket",
    "land_peak": "N: largest force of film and contact at the land",
    "eccentricity": "1: mean eccentricity over the land's clearance",
    "land_loss": "W: lost at the land",
    "loss": "W: lost in the bearing",
}
SPEEDS = (1000.0, 3000.0, 6000.0, 10000.0, 15000.0)
GUIDANCES = ("rollers", "inner_land", "outer_land")
CLEARANCE = 60e-6


def scene_of(guidance: str, speed: float) -> trb.Scene:
    """The bearing with a cage that is guided so."""
    bearing = trb.cases.rig_30310().replace({"land.clearance": CLEARANCE})
    effects = trb.Effects.standard().replace(guidance=guidance)
    return trb.Scene(bearing, speed_rpm=speed, axial_load=4930.0, effects=effects, start=trb.Start.whirl(0.1))


def measured(scene: trb.Scene, turns: float) -> dict[str, Any]:
    """The second half of a run."""
    result = trb.Simulation(scene, accuracy="fast").run(revolutions=turns)
    late = result.window(0.5 * float(result.time[-1]), float(result.time[-1]))
    summary, motion = late.summary(), late.cage_motion
    play = scene.bearing.cage.play_radial
    found = {
        "motion": motion.kind,
        "orbit": 1e6 * motion.orbit_over_play * play,
        "off_axis": 1e6 * summary["axis_distance_over_cpr"] * play,
        "whirl_ratio": summary["whirl_ratio"],
        "cage_slip": summary["cage_slip"],
        "pocket_p95": summary["pocket_force_p95"],
        "pocket_peak": summary["pocket_force_peak"],
        "loss": float(late.power_loss.mean()),
    }
    if scene.effects.guidance != "rollers":
        force = late["land_film_force"] + late["land_contact_force"]
        lost = late["power_land"] + late["power_land_film"]
        found |= {"land_peak": float(force.max()), "eccentricity": float(late["land_eccentricity"].mean())}
        found["land_loss"] = float(lost.mean())
    return found


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("guidance", options, COLUMNS)
    turns = 4.0 if options.quick else 60.0
    report.inputs = {"axial_load": 4930.0, "clearance": CLEARANCE, "revolutions": turns}
    for speed in SPEEDS[1:2] if options.quick else SPEEDS:
        for guidance in GUIDANCES:
            row = measured(scene_of(guidance, speed), turns)
            report.add(guidance=guidance, speed_rpm=speed, **row)
            print(guidance, speed, row, flush=True)
    print("\n" + common.table(report.results, list(COLUMNS)))
    report.readme = common.table(report.results, list(COLUMNS))
    report.finish()
    return report


if __name__ == "__main__":
    main()
