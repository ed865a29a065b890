"""What a free inner ring changes in the paper's operating points: the same runs with a held ring, a ring alone and a rotor.

    python benchmarks/paper_free_ring.py [--quick] [--json FILE]

Every condition of the paper's figures (benchmarks/paper) from the start "whirl", with the effects of the paper, and with those of
`Effects.standard`: ring held in its equilibrium, as in the paper; free with the mass of the ring, 0.7 kg; free with a rotor of
20 kg, without any damping but that of the bearing, and with a damper to the surroundings that takes some per cent of the critical
damping. The weight of what moves is carried by a force, so that the bearing has the paper's load. The moments of a free ring are
zero; a held ring does not tilt. Given are means over the last half of each run. The motion of the cage is irregular and creeps:
where the same run from another start differs as much as free and held, the ring has changed nothing that could be told. So each
held run stands there twice, with `other start`, unequally spaced rollers.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import common
import numpy as np
from paper.points import Point, conditions, effects

from trbdyn import Effects, RingBody, Scene, Simulation, Start
from trbdyn.errors import RunWarning
from trbdyn.results.result import Result
from trbdyn.statics.plausible import UnusualInput

COLUMNS = {
    "effects": "text: of the paper, or standard",
    "point": "text: speed, axial load, radial load",
    "ring": "text: held, held from another start, or free with its mass",
    "orbit": "1: mean orbit radius of the cage over Cpr",
    "whirl": "1: mean rate of the centre's direction over the cage's rotation",
    "spacing": "deg: standard deviation of the rollers' spacing",
    "hit": "N: 95 % of the pocket forces in contact",
    "torque": "N m: mean torque of the shaft",
    "ring_radial": "um: rms radial motion of the ring about its mean place",
    "ring_axial": "um: the same along the axis",
    "warned": "1: the run has warnings",
    "largest_change": "1: of the orbit between held and free rings, without the undamped rotor, over Cpr, of all points",
    "largest_scatter": "1: the same between the two starts of the held ring",
}
SHOWN = ("effects", "point", "ring", "orbit", "whirl", "spacing", "hit", "torque", "ring_radial", "ring_axial")
RING = RingBody.hollow_cylinder(mass=0.7, inner_diameter=0.05, outer_diameter=0.072, length=0.027)
ROTOR = RingBody.hollow_cylinder(mass=20.0, outer_diameter=0.08, length=0.5)
RINGS: dict[str, RingBody | Start | None] = {
    "held": None,
    "held, other start": Start.unequal(1),
    "free, 0.7 kg": RING,
    "free, 20 kg": ROTOR,
    "free, 20 kg, damped": ROTOR.replace(damping=3e3, damping_turns=10.0),
}


def with_ring(scene: Scene, ring: RingBody | Start | None) -> Scene:
    """The scene with another ring or another start; the paper's radial load points upwards, against the weight."""
    if not isinstance(ring, RingBody):
        return scene if ring is None else scene.replace(start=ring)
    carried = float(scene.radial_load) + ring.mass * abs(float(scene.gravity[1]))
    return scene.replace(ring="free", ring_body=ring, radial_load=carried)


def measured(result: Result) -> dict[str, Any]:
    """What is compared, over the last half."""
    numbers = result.window(0.5 * result.time[-1]).summary()
    place = 1e6 * result["ring_position"][len(result) // 2 :]
    about = place - place.mean(axis=0)
    return {
        "orbit": numbers["orbit_radius_over_cpr"],
        "whirl": numbers["whirl_ratio"],
        "spacing": numbers["spacing_std_deg"],
        "hit": numbers["pocket_force_p95"],
        "torque": numbers["torque"],
        "ring_radial": float(np.sqrt(np.mean(np.sum(about[:, :2] ** 2, axis=1)))),
        "ring_axial": float(np.std(about[:, 2])),
        "warned": int(bool(result.warnings)),
    }


def rows_of(scene: Scene, turns: float) -> Iterable[tuple[str, dict[str, Any]]]:
    """Each ring of a scene, and what was measured."""
    for name, ring in RINGS.items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RunWarning)
            warnings.simplefilter("ignore", UnusualInput)
            result = Simulation(with_ring(scene, ring)).run(revolutions=turns, save_groups=GROUPS)
        yield name, measured(result)


GROUPS = ("cage", "rollers", "contacts", "pocket", "ring", "torque", "power", "energy", "peaks")


def by_point(rows: Sequence[Mapping[str, Any]]) -> str:
    """The table of the page: a line for each point, with what the rings have side by side."""
    points: dict[tuple[str, str], dict[str, Mapping[str, Any]]] = {}
    for row in rows:
        points.setdefault((row["effects"], row["point"].replace("_", " ")), {})[row["ring"]] = row
    shown = {
        "orbit": ("orbit", list(RINGS)),
        "torque (N m)": ("torque", [name for name in RINGS if "start" not in name]),
        "radial motion of the ring (um)": ("ring_radial", [name for name in RINGS if name.startswith("free")]),
    }
    columns = {f"{words}: {name}": (key, name) for words, (key, names) in shown.items() for name in names}
    lines = [
        {"effects": used, "point": point} | {title: of[name][key] for title, (key, name) in columns.items()}
        for (used, point), of in points.items()
    ]
    return common.table(lines, lines[0])


def largest(rows: Sequence[Mapping[str, Any]], wanted: Iterable[str]) -> float:
    """Largest change of the orbit from that of the held ring."""
    held = {(row["effects"], row["point"]): row["orbit"] for row in rows if row["ring"] == "held"}
    return max(abs(row["orbit"] - held[row["effects"], row["point"]]) for row in rows if row["ring"] in set(wanted))


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    options = parser.parse_args(arguments)
    report = common.Report("paper_free_ring", options, COLUMNS)
    turns, chosen = (10.0, conditions()[:1]) if options.quick else (100.0, conditions())
    report.inputs = {"revolutions": turns, "start": "whirl at 0.9 Cpr"}
    for label, used in (("paper", effects()), ("standard", Effects.standard())):
        for condition in chosen:
            scene = Point(condition, "whirl").scene().replace(effects=used)
            for ring, row in rows_of(scene, turns):
                report.add(effects=label, point=condition.name, ring=ring, **row)
    report.summary["largest_change"] = largest(report.results, ["free, 0.7 kg", "free, 20 kg, damped"])
    report.summary["largest_scatter"] = largest(report.results, ["held, other start"])
    print("\n" + common.table(report.results, SHOWN))
    report.readme = by_point(report.results)
    report.finish()
    return report


if __name__ == "__main__":
    main()
