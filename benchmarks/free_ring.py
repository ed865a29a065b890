"""What a ring that is free costs: time, steps and error of the cage beside those of a held ring, in one run, in turns.

    python benchmarks/free_ring.py [--quick] [--json FILE]

The same scenes with a held ring, with a free ring of 0.7 kg, with a rotor of 20 kg, and with an outer ring that moves with its
housing beside a held and a free inner ring; and two such bearings, their cages
colliding, preloaded against each other on a shaft of 5 kg, beside one of them with its ring held. Time is processor time of the
steps alone, of pieces of bearing time that all of them take in turns. The error is that of the cage's centre after a few
milliseconds from a state in the middle of the run, against a fiftieth of the tolerances; it is measured for each ring beside
itself, and not for the two bearings on a shaft.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import beside
import common
import numpy as np

from trbdyn import Housing, RingBody, Scene, Simulation, Start, cases
from trbdyn.statics.seat import Seat, Seating

SHOWN = ("scene", "ring", *beside.SHOWN)

COLUMNS = {
    "scene": "text: what turns",
    "ring": "text: held, or free with its mass; a housing where the outer ring moves, too",
    **beside.COLUMNS,
    "worst_ratio": "1: largest time_ratio of a ring of 0.7 kg",
}
LIGHT = RingBody.hollow_cylinder(mass=0.7, inner_diameter=0.05, outer_diameter=0.072, length=0.027)
HEAVY = RingBody.hollow_cylinder(mass=20.0, outer_diameter=0.08, length=0.5)
HOUSING = Housing.hollow_cylinder(mass=9.0, inner_diameter=0.11, outer_diameter=0.17, length=0.06).replace(
    support_radial=3e8, support_axial=2e8, support_tilt=4e5
)
RINGS: dict[str, dict[str, Any]] = {
    "held": {},
    "free, 0.7 kg": {"ring": "free", "ring_body": LIGHT},
    "free, 20 kg": {"ring": "free", "ring_body": HEAVY},
    "held, housing of 9 kg": {"housing": HOUSING},
    "free, 0.7 kg, housing of 9 kg": {"ring": "free", "ring_body": LIGHT, "housing": HOUSING},
}
"""Fields of the scene; the moments of a free ring are free, as those of a held ring are not."""


def scenes() -> dict[str, Scene]:
    """What is run, with held rings."""
    rig = cases.rig_30310()
    return {
        "colliding cage": Scene(rig, speed_rpm=3000.0, axial_load=4930.0, start=Start.whirl(0.9)),
        "combined load": Scene(rig, speed_rpm=3000.0, axial_load=4930.0, radial_load=5530.0),
    }


def pair() -> dict[str, Scene | Simulation]:
    """One held bearing, and two on a shaft, the second one the other way round."""
    body = RingBody(mass=5.0, inertia_axial=5e-3, inertia_transverse=3e-2)
    preload, weight = -20e-6, 9.80665
    seats = {
        name: Seat(
            Scene(
                cases.rig_30310(),
                speed_rpm=sign * 3000.0,
                displacement=(0.0, 0.0, preload),
                gravity=(0.0, -sign * weight, 0.0),
                start=Start.whirl(0.9),
            ),
            mass_offset=-0.05,
            turned=sign < 0.0,
            shift=preload * (1.0 - sign),
        )
        for name, sign in (("left", 1.0), ("right", -1.0))
    }
    shaft = np.array([0.0, 0.0, preload, 0.0, 0.0])
    return {"held": seats["left"].scene, "two on a shaft": Simulation(Seating(seats, body, shaft))}


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    report, pieces = beside.open_report("free_ring", __doc__, COLUMNS, arguments)
    for name, scene in scenes().items():
        variants = {ring: scene.replace(**fields) for ring, fields in RINGS.items()}
        for ring, row in beside.rows_of(variants, pieces, float(scene.speed_rpm)).items():
            report.add(scene=name, ring=ring, **row)
    for ring, row in beside.rows_of(pair(), pieces, 3000.0).items():
        report.add(scene="preloaded, colliding", ring=ring, **row)
    report.summary["worst_ratio"] = max(row["time_ratio"] for row in report.results if row["ring"] == "free, 0.7 kg")
    return beside.close_report(report, SHOWN)


if __name__ == "__main__":
    main()
