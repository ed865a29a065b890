"""Answers within a minute: does the cage whirl, what is the temperature; twelve catalogue bearings, beside long runs.

    python benchmarks/answers.py [--quick] [--scenes FIRST:END] [--only cage|thermal|slip] [--follow] [--json FILE]

Each bearing has three loads (light, combined, heavy) at a speed between 300 and 6000 rpm: 36 scenes with equal rollers for
`trb.cage_answer`, with 60 s of processor time each; `--follow` runs each on from rest, ten times as long as its answer took.
`trb.thermal` and `trb.least_load` are run for each bearing at its combined load, the former beside a full run of 64 turns at its
temperature, the latter beside 64 turns from rolling.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any, Final

import common
import numpy as np

import trbdyn as trb

BEARINGS: Final = {
    "30205": (0.025, 0.052, 0.01625, 6000.0),
    "32004X": (0.020, 0.042, 0.015, 4500.0),
    "30206": (0.030, 0.062, 0.01725, 3000.0),
    "LM67048": (0.03175, 0.05913, 0.01588, 2000.0),
    "32208": (0.040, 0.080, 0.02475, 2000.0),
    "30310": (0.050, 0.110, 0.02925, 1500.0),
    "32310": (0.050, 0.110, 0.04225, 3000.0),
    "31312": (0.060, 0.130, 0.0335, 1500.0),
    "33113": (0.065, 0.110, 0.034, 1000.0),
    "32216": (0.080, 0.140, 0.03525, 800.0),
    "33217": (0.085, 0.150, 0.049, 1000.0),
    "32024X": (0.120, 0.180, 0.038, 300.0),
}
"""Bore, outside diameter and width (m), and speed (rpm)."""
LOADS: Final = {"light": (0.02, 0.0), "combined": (0.06, 0.08), "heavy": (0.12, 0.0)}
"""Axial and radial load over the dynamic rating."""
COLUMNS: Final = {
    "question": "text: cage, thermal or slip",
    "bearing": "text: designation",
    "load": "text: light, combined or heavy",
    "speed_rpm": "rpm: speed",
    "answer": "text: the verdict",
    "kind": "text: class of the cage's motion",
    "value": "orbit over Cpr (1), temperature of the films (C), or slip (1)",
    "rate": "1/s: rate of the start between, over Cpr",
    "creep_turns": "1: turns of the cage within which the rollers creep",
    "seconds": "s: processor time",
    "followed": "value of the long run",
    "followed_kind": "text: class of the motion in the last half of the long run",
    "agreed": "1: number of scenes with an agreed verdict",
    "told": "1: number of scenes with a verdict or a direction",
    "scenes": "1: number of scenes",
    "largest_difference": "largest difference of an agreed orbit from the long run (1)",
    "largest_kelvin": "K: largest difference of a temperature from that of the long run's power",
    "wrong_slips": "1: verdicts of slip that the long run contradicts",
    "unknown_slips": "1: verdicts of slip that are not known",
}


def scene_of(name: str, load: str) -> trb.Scene:
    """One of the scenes."""
    bearing = trb.Bearing.named(name)
    rating = trb.rating(trb.Scene(bearing, speed_rpm=1000.0, axial_load=1000.0)).dynamic_rating
    axial, radial = (share * float(rating) for share in LOADS[load])
    return trb.Scene(bearing, speed_rpm=BEARINGS[name][3], axial_load=axial, radial_load=radial, lubricant="vg68")


def all_scenes() -> Iterator[tuple[str, str]]:
    """Names of bearings and loads."""
    return ((name, load) for name in BEARINGS for load in LOADS)


def cage(report: common.Report, name: str, load: str, seconds: float, *, follow: bool) -> None:
    """What the cage does."""
    scene = scene_of(name, load)
    found = trb.cage_answer(scene, scatter=[0.0], processor_time=seconds)
    (row,) = found.rows
    more: dict[str, Any] = {}
    if follow:
        turns = 10.0 * row.turns / scene.bearing.geometry.cage_speed_ratio
        groups: Any = ["cage", "rollers"]
        alone = trb.Simulation(scene, accuracy="fast").run(revolutions=turns, save_groups=groups)
        late = alone.window(0.5 * alone.duration).cage_motion
        more = {"followed": late.orbit_over_play, "followed_kind": late.kind}
    compared = row.found
    report.add(
        question="cage",
        bearing=name,
        load=load,
        speed_rpm=scene.speed_rpm,
        answer=compared.verdict,
        kind=row.kind,
        value=compared.orbit,
        rate=compared.rate,
        creep_turns=found.creep_turns[""],
        seconds=row.processor_time,
        **more,
    )
    print(f"{name} {load}: {row.words} ({row.processor_time:.0f} s)", flush=True)


def thermal(report: common.Report, name: str, *, follow: bool) -> None:
    """The temperature of its films, and that which the power of a long run at this temperature makes."""
    scene, (bore, outside, width, _) = scene_of(name, "combined"), BEARINGS[name]
    paths = trb.HeatPaths.reference(bore=bore, outside=outside, width=width, oil_flow=5.0, oil_inlet_c=40.0)
    began = time.process_time()
    found = trb.thermal(scene, paths)
    spent, film = time.process_time() - began, found.temperatures["film"]
    more: dict[str, Any] = {}
    if follow:
        groups: Any = ["torque", "power", "energy", "contacts"]
        power = (
            trb.Simulation(found.scene, accuracy="fast")
            .run(revolutions=64.0, save_groups=groups)
            .summary()["power_loss"]
        )
        cold = float(found.curve[0, 0])
        more = {"followed": cold + (film - cold) * power / found.power}
    report.add(question="thermal", bearing=name, load="combined", answer="found", value=film, seconds=spent, **more)
    print(f"{name}: films {film:.1f} C ({spent:.0f} s) {more}", flush=True)


def slip(report: common.Report, name: str, *, follow: bool) -> None:
    """Whether rollers roll under a fiftieth of the usual least load, with some oil in the bearing."""
    scene = scene_of(name, "light").replace(effects=trb.Effects.standard().replace(oil_fill=0.1))
    load = 0.0004 * float(trb.rating(scene).dynamic_rating)
    began = time.process_time()
    data = trb.least_load(scene, [3.0 * scene.speed_rpm], [load]).data.isel(temperature_c=0, speed_rpm=0, load=0)
    spent, verdict, more = time.process_time() - began, str(data["verdict"].values), {}
    if follow:
        fast = scene.replace(speed_rpm=3.0 * scene.speed_rpm, axial_load=load)
        groups: Any = ["cage", "rollers"]
        alone = trb.Simulation(fast, accuracy="fast").run(revolutions=64.0, save_groups=groups)
        more = {"followed": float(alone.cage_slip[-len(alone) // 8 :].mean())}
    value = float(data["cage_slip"])
    report.add(question="slip", bearing=name, load="least", answer=verdict, value=value, seconds=spent, **more)
    print(f"{name}: {verdict}, {100.0 * value:.3g} % ({spent:.0f} s) {more}", flush=True)


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    parser.add_argument("--scenes", default=":", help="which scenes, FIRST:END; bearings for thermal and slip")
    parser.add_argument("--only", choices=("cage", "thermal", "slip"), help="one of the questions")
    parser.add_argument("--follow", action="store_true", help="run long ones, too")
    parser.add_argument("--seconds", type=float, default=60.0, help="processor time of an answer on a cage")
    options = parser.parse_args(arguments)
    report = common.Report("answers", options, COLUMNS)
    first, end = (int(part) if part else None for part in options.scenes.split(":"))
    asked = [options.only] if options.only else ["cage", "thermal", "slip"]
    names, scenes = list(BEARINGS)[first:end], list(all_scenes())[first:end]
    if options.quick:
        names, scenes, asked = ["32208"], [("32208", "light")], ["cage", "thermal"]
    if "cage" in asked:
        for name, load in scenes:
            cage(report, name, load, 4.0 if options.quick else options.seconds, follow=options.follow)
    for name in names if "thermal" in asked else ():
        thermal(report, name, follow=options.follow)
    for name in names if "slip" in asked else ():
        slip(report, name, follow=options.follow)
    report.summary = _summary(report.results)
    print(
        common.table(report.results, ("question", "bearing", "load", "answer", "kind", "value", "followed", "seconds"))
    )
    print(report.summary)
    report.finish()
    return report


def _summary(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    of = {name: [row for row in rows if row["question"] == name] for name in ("cage", "thermal", "slip")}
    apart = {
        name: [abs(row["followed"] - row["value"]) for row in of[name] if "followed" in row and row["answer"] in ok]
        for name, ok in (("cage", ("agreed",)), ("thermal", ("found",)))
    }
    told = [row for row in of["slip"] if "followed" in row and row["answer"] in ("rolls", "slips")]
    return {
        "scenes": len(of["cage"]),
        "agreed": sum(row["answer"] == "agreed" for row in of["cage"]),
        "told": sum(row["answer"] != "unknown" for row in of["cage"]),
        "largest_difference": max(apart["cage"], default=None),
        "largest_kelvin": max(apart["thermal"], default=None),
        "wrong_slips": int(np.sum([(row["followed"] > 0.1) != (row["answer"] == "slips") for row in told])),
        "unknown_slips": sum(row["answer"] == "not known" for row in of["slip"]),
    }


if __name__ == "__main__":
    main()
