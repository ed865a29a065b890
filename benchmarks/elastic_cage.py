"""What an elastic cage costs: time, steps and error of the cage beside those of a rigid one, in one run, in turns.

    python benchmarks/elastic_cage.py [--quick] [--json FILE]

Scenes of the 30310 with a cage of steel and of PA66-GF25, rigid and with some numbers of modes. Time is processor time of the
steps alone, of pieces of bearing time that all of them take in turns. The error is that of the cage's centre after a few
milliseconds from a state in the middle of the run, against a fiftieth of the tolerances; it is measured for each cage beside
itself. At the same tolerances an elastic cage has the larger error: what it costs at the error of the rigid one is read from its
times and errors at several tolerances.
"""

from __future__ import annotations

from collections.abc import Sequence

import beside
import common
import numpy as np

from trbdyn import Cage, ElasticCage, Material, Scene, Simulation, Start, cases

SHOWN = ("scene", "modes", *beside.SHOWN, "impacts_per_turn")
COLUMNS = {
    "scene": "text: what turns",
    "modes": "1: natural modes of the cage; 0: it is rigid",
    **beside.COLUMNS,
    "impacts_per_turn": "1: how often a turn rollers begin to touch their pockets, in the second half of a run of its own",
    "ratio_20": "1: time_ratio of the colliding cage of steel with 20 modes",
    "ratio_20_same_error": "1: the same with tolerances that give it the error of the rigid cage",
}
MODES = (0, 6, 20, 40)
FACTORS = (1.0, 0.5, 0.25, 0.1)
"""Of the tolerances."""


def scenes() -> dict[str, Scene]:
    """What is run, with rigid cages."""
    rig, body = cases.rig_30310(), cases.cage_body_30310()
    plays = {"play_radial": rig.cage.play_radial, "play_circumferential": rig.cage.play_circumferential}
    steel, plastic = (
        rig.replace(cage=Cage(**plays, body=body, material=material))
        for material in (Material.steel(), Material.polyamide())
    )
    return {
        "colliding cage": Scene(steel, speed_rpm=3000.0, axial_load=4930.0, start=Start.whirl(0.9)),
        "combined load": Scene(steel, speed_rpm=3000.0, axial_load=4930.0, radial_load=5530.0),
        "colliding cage, PA66": Scene(plastic, speed_rpm=3000.0, axial_load=4930.0, start=Start.whirl(0.9)),
    }


def impacts_per_turn(scene: Scene, turns: int) -> float:
    """How often a turn rollers begin to touch their pockets, in the second half of a run of so many turns."""
    result = Simulation(scene).run(revolutions=turns)
    half = result.window(float(result["time"][len(result) // 2]))
    return float(half.peaks["pocket_impacts"].sum()) / (0.5 * turns)


def ratio_at_same_error(scene: Scene, windows: int) -> float:
    """Time of 20 modes over that of the rigid cage, at the error that the rigid cage has with the usual tolerances."""
    elastic = scene.replace(elastic_cage=ElasticCage(n_modes=20))
    speed = float(scene.speed_rpm)
    (rigid_ms,), (error,) = beside.front_of(scene, FACTORS[:1], windows, speed)
    times, errors = beside.front_of(elastic, FACTORS, windows, speed)
    return float(np.exp(np.interp(np.log(error), np.log(errors[::-1]), np.log(times[::-1])))) / rigid_ms


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    report, pieces = beside.open_report("elastic_cage", __doc__, COLUMNS, arguments)
    for name, scene in scenes().items():
        variants = {
            str(count): scene.replace(elastic_cage=ElasticCage(n_modes=count) if count else None) for count in MODES
        }
        for count, row in beside.rows_of(variants, pieces, float(scene.speed_rpm)).items():
            impacts = impacts_per_turn(variants[count], turns=max(pieces // 8, 2))
            report.add(scene=name, modes=int(count), **row, impacts_per_turn=impacts)
    rows = {(row["scene"], row["modes"]): row for row in report.results}
    report.summary["ratio_20"] = rows["colliding cage", 20]["time_ratio"]
    report.summary["ratio_20_same_error"] = ratio_at_same_error(scenes()["colliding cage"], pieces // 2 or 1)
    return beside.close_report(report, SHOWN)


if __name__ == "__main__":
    main()
