"""What a ring that is free costs: time, steps and error of the cage beside those of a held ring, in one run, in turns.

    python benchmarks/free_ring.py [--quick] [--json FILE]

The same scenes with a held ring, with a free ring of 0.7 kg and with a rotor of 20 kg. Time is processor time of the steps alone,
of pieces of bearing time that all of them take in turns. The error is that of the cage's centre after a few milliseconds from a
state in the middle of the run, against a fiftieth of the tolerances; it is measured for each ring beside itself.
"""

from __future__ import annotations

from collections.abc import Sequence

import beside
import common

from trbdyn import RingBody, Scene, Start, cases

SHOWN = ("scene", "ring", *beside.SHOWN)

COLUMNS = {
    "scene": "text: what turns",
    "ring": "text: held, or free with its mass",
    **beside.COLUMNS,
    "worst_ratio": "1: largest time_ratio of a ring of 0.7 kg",
}
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


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    parser.add_argument("--smoke", action="store_true", help="the least that goes through everything; seconds")
    options = parser.parse_args(arguments)
    report = common.Report("free_ring", options, COLUMNS)
    for name, scene in scenes().items():
        variants = {ring: with_ring(scene, body) for ring, body in RINGS.items()}
        for ring, row in beside.rows_of(variants, 1 if options.smoke else 16 if options.quick else 160).items():
            report.add(scene=name, ring=ring, **row)
    report.summary["worst_ratio"] = max(row["time_ratio"] for row in report.results if row["ring"] == "free, 0.7 kg")
    report.readme = common.table(report.results, SHOWN)
    print(report.readme)
    report.finish()
    return report


if __name__ == "__main__":
    main()
