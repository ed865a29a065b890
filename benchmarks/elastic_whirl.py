"""What elasticity of the cage changes in the whirl of the 30310: motion of rigid and elastic cages over speed, from two starts.

    python benchmarks/elastic_whirl.py [--quick] [--json FILE]

The cage of the paper's rig, of steel and of PA66-GF25, with mass and moments of inertia that follow from its dimensions and the
material, so that the rigid cage beside an elastic one has the same. Axial load 3080 N, as where a whirl begins at the rig; the
play is that of the drawing at every speed.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import common

from trbdyn import Cage, ElasticCage, Material, Scene, cases, whirl_onset

COLUMNS = {
    "material": "text: of the cage",
    "modes": "1: natural modes of the cage; 0: it is rigid",
    "start": "text: equal: from rest in the middle; whirl: from a large whirl",
    "speed_rpm": "rpm: speed",
    "motion": "text: class of the motion of the cage",
    "orbit": "1: orbit of the cage over its radial play",
    "decided": "1: whether class and orbit stayed over the second half of the run",
    "seconds": "s: time of computing for the cage with this number of modes, all speeds and starts",
}
SPEEDS = (1000.0, 1500.0, 2000.0, 2500.0, 3000.0, 4000.0, 6000.0)
MODES = (0, 6, 20)


def scene_of(material: Material, modes: int) -> Scene:
    """The rig at 3080 N with a cage of a material."""
    rig, body = cases.rig_30310(), cases.cage_body_30310()
    plays = {"play_radial": rig.cage.play_radial, "play_circumferential": rig.cage.play_circumferential}
    bearing = rig.replace(cage=Cage(**plays, body=body, material=material))
    elastic = ElasticCage(n_modes=modes) if modes else None
    return Scene(bearing, speed_rpm=3000.0, axial_load=3080.0, elastic_cage=elastic)


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("elastic_whirl", options, COLUMNS)
    materials = {"steel": Material.steel(), "PA66-GF25": Material.polyamide()}
    report.inputs = {"axial_load": 3080.0, "turns_of_the_cage": 40.0}
    for name, material in list(materials.items())[: 1 if options.quick else None]:
        for modes in MODES[:2] if options.quick else MODES:
            began = time.perf_counter()
            found = whirl_onset(scene_of(material, modes), SPEEDS[:1] if options.quick else SPEEDS, longest=40.0)
            seconds = time.perf_counter() - began
            print(f"{name}, {modes} modes\n{found}", flush=True)
            for start in found.data["start"].values:
                for speed in found.data["speed_rpm"].values:
                    at = found.data.sel(start=start, speed_rpm=speed)
                    report.add(
                        material=name,
                        modes=modes,
                        start=str(start),
                        speed_rpm=float(speed),
                        motion=str(at["kind"].values),
                        orbit=float(at["orbit"]),
                        decided=float(at["decided"]),
                        seconds=seconds,
                    )
    shown = list(COLUMNS)
    print("\n" + common.table(report.results, shown))
    report.readme = side_by_side(report)
    report.finish()
    return report


def side_by_side(report: common.Report) -> str:
    """A line for each start and speed, a column for each cage: motion and orbit."""
    lines: dict[tuple[str, float], dict[str, object]] = {}
    for row in report.results:
        line = lines.setdefault(
            (row["start"], row["speed_rpm"]), {"start": row["start"], "speed_rpm": row["speed_rpm"]}
        )
        cage = f"{row['material']}, {row['modes']} modes" if row["modes"] else f"{row['material']}, rigid"
        line[cage] = f"{row['motion']} {row['orbit']:.2f}" + ("" if row["decided"] else ", not decided")
    return common.table(list(lines.values()), list(next(iter(lines.values()))))


if __name__ == "__main__":
    main()
