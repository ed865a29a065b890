"""Answers within a minute: does the cage whirl, what is the temperature; twelve catalogue bearings, beside long runs.

    python benchmarks/answers.py [--quick] [--scenes FIRST:END] [--only cage|thermal|slip] [--scatter UM] [--follow] [--json FILE]

Each bearing has three loads (light, combined, heavy) at a speed between 300 and 6000 rpm: 36 scenes, with equal rollers unless
`--scatter` gives a range of their diameters, for `trb.cage_answer`, with 60 s of processor time each. One bearing has sizes in
inches, two are cylindrical. `--follow` runs each ten times as long as its answer took, from rest, or, where a direction was told,
from the start between, until it has come there. Where the start decides both outer starts are followed for as long as was said.
`trb.thermal` is run for each bearing, and `trb.least_load` for each tapered one, at its combined load: the former beside a full
run of 64 turns at its temperature, the latter beside 64 turns from rolling.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from typing import Any, Final

import common
import numpy as np

import trbdyn as trb

BEARINGS: Final = {
    "30205": (0.025, 0.052, 0.01625, 6000.0),
    "30206": (0.030, 0.062, 0.01725, 3000.0),
    "LM67048": (0.03175, 0.05913, 0.01588, 2000.0),
    "32208": (0.040, 0.080, 0.02475, 2000.0),
    "30310": (0.050, 0.110, 0.02925, 1500.0),
    "32310": (0.050, 0.110, 0.04225, 3000.0),
    "31312": (0.060, 0.130, 0.0335, 1500.0),
    "33113": (0.065, 0.110, 0.034, 1000.0),
    "33217": (0.085, 0.150, 0.049, 1000.0),
    "32024X": (0.120, 0.180, 0.038, 300.0),
    "NJ308": (0.040, 0.090, 0.023, 3000.0),
    "NJ2210": (0.050, 0.090, 0.023, 1500.0),
}
"""Bore, outside diameter and width (m), and speed (rpm)."""
LOADS: Final = {"light": (0.02, 0.0), "combined": (0.06, 0.08), "heavy": (0.12, 0.0)}
"""Axial and radial load over the dynamic rating."""
OF_CYLINDERS: Final = {"light": (0.002, 0.03), "combined": (0.01, 0.1), "heavy": (0.002, 0.2)}
"""The same of cylindrical bearings: an axial load only presses the ribs together."""
TENFOLD: Final = 10.0
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
    "scatter": "m: range of the rollers' diameters",
    "time_low": "s: time that is left at least, or within which starts decide",
    "time_high": "s: time that is left at most",
    "time_there": "s: time after which the followed start had come there",
    "followed": "value of the long run",
    "followed_kind": "text: class of the motion in the last half of the long run",
    "agreed": "1: number of scenes with an agreed verdict",
    "told": "1: number of scenes with a verdict or a direction",
    "of_verdicts": "number of scenes by verdict",
    "forecasts": "1: directions that were followed",
    "forecasts_held": "1: of these, those whose time lies within the forecast",
    "wrong_classes": "1: verdicts that the long run contradicts: another class, or an orbit apart by more than 0.1 Cpr",
    "scenes": "1: number of scenes",
    "largest_difference": "largest difference of an agreed orbit from the long run (1)",
    "largest_kelvin": "K: largest difference of a temperature from that of the long run's power",
    "wrong_slips": "1: verdicts of slip that the long run contradicts",
    "unknown_slips": "1: verdicts of slip that are not known",
}


def scene_of(name: str, load: str) -> trb.Scene:
    """One of the scenes."""
    bearing = trb.Bearing.named(name)
    cylinders = name.startswith("N")
    loads: dict[str, Any] = {"axial_load": 10.0, "radial_load": 1000.0} if cylinders else {"axial_load": 1000.0}
    rating = float(trb.rating(trb.Scene(bearing, speed_rpm=1000.0, **loads)).dynamic_rating)
    axial, radial = (share * rating for share in (OF_CYLINDERS if cylinders else LOADS)[load])
    return trb.Scene(bearing, speed_rpm=BEARINGS[name][3], axial_load=axial, radial_load=radial, lubricant="vg68")


def all_scenes() -> Iterator[tuple[str, str]]:
    """Names of bearings and loads."""
    return ((name, load) for name in BEARINGS for load in LOADS)


def cage(report: common.Report, name: str, load: str, seconds: float, *, scatter: float, follow: bool) -> None:
    """What the cage does."""
    scene = scene_of(name, load)
    found = trb.cage_answer(scene, scatter=[scatter], processor_time=seconds)
    (row,) = found.rows
    compared = row.found
    report.add(
        question="cage",
        bearing=name,
        load=load,
        speed_rpm=scene.speed_rpm,
        scatter=scatter,
        answer=compared.verdict,
        kind=row.kind,
        value=compared.orbit,
        rate=compared.rate,
        time_low=compared.time_low,
        time_high=compared.time_high,
        creep_turns=found.creep_turns[""],
        seconds=row.processor_time,
        **(_followed(scene, row) if follow and not scatter and compared.verdict != "unknown" else {}),
    )
    print(f"{name} {load}: {row.words} ({row.processor_time:.0f} s)", flush=True)


def _followed(scene: trb.Scene, row: Any) -> dict[str, Any]:
    """What longer runs show of an answer; equal rollers, as those of the answer."""
    compared, groups = row.found, ("cage", "rollers")
    told = (
        row.turns / scene.bearing.geometry.cage_speed_ratio * 60.0 / scene.speed_rpm
    )  # bearing time of the answer (s)

    def alone(start: trb.Start, duration: float) -> trb.Result:
        options: dict[str, Any] = {"duration": duration, "save_groups": groups}
        return trb.Simulation(scene.replace(start=start), accuracy="fast").run(**options)

    if compared.verdict == "agreed":
        run = alone(trb.Start.equal(), TENFOLD * told)
        late = run.window(0.5 * run.duration).cage_motion
        return {"followed": late.orbit_over_play, "followed_kind": late.kind}
    if compared.verdict in ("start decides", "two motions"):
        length = min(TENFOLD * told, compared.time_low)  # the first where the latter is not a number
        moved = [
            abs(run.window(0.9 * run.duration).cage_motion.orbit_over_play - end)
            for start, end in zip((trb.Start.equal(), trb.Start.whirl(0.9)), compared.ends, strict=True)
            for run in [alone(start, told + length)]
        ]
        return {"followed": max(moved)}
    run = alone(trb.Start.whirl(0.3), told + 2.0 * compared.time_high)
    when, means = run.turn_means()
    there = np.abs(means["orbit radius"] - compared.orbit) <= max(compared.error, 0.05)
    late = run.window(0.9 * run.duration).cage_motion
    first = float(when[int(np.argmax(there))]) - told if there.any() else math.inf
    return {"followed": late.orbit_over_play, "followed_kind": late.kind, "time_there": first}


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
    parser.add_argument("--scatter", type=float, default=0.0, help="range of the rollers' diameters (um)")
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
            most = 4.0 if options.quick else options.seconds
            cage(report, name, load, most, scatter=1e-6 * options.scatter, follow=options.follow)
    for name in names if "thermal" in asked else ():
        thermal(report, name, follow=options.follow)
    for name in (one for one in names if not one.startswith("N")) if "slip" in asked else ():
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
    followed = [row for row in of["cage"] if "followed" in row]
    agreed = [row for row in followed if row["answer"] == "agreed"]
    decides = [row for row in followed if row["answer"] in ("start decides", "two motions")]
    ways = [row for row in followed if row["answer"] in ("grows", "dies", "meets")]
    warm = [abs(row["followed"] - row["value"]) for row in of["thermal"] if "followed" in row]
    slips = [row for row in of["slip"] if "followed" in row and row["answer"] in ("rolls", "slips")]
    off = [abs(row["followed"] - row["value"]) for row in agreed]
    wrong = [_circles(row["kind"]) != _circles(row["followed_kind"]) for row in agreed]
    return {
        "scenes": len(of["cage"]),
        "of_verdicts": {name: sum(row["answer"] == name for row in of["cage"]) for name in _verdicts(of["cage"])},
        "agreed": sum(row["answer"] == "agreed" for row in of["cage"]),
        "told": sum(row["answer"] != "unknown" for row in of["cage"]),
        "largest_difference": max(off, default=None),
        "wrong_classes": sum(one or apart > 0.1 for one, apart in zip(wrong, off, strict=True))
        + sum(row["followed"] > 0.1 for row in decides),
        "forecasts": len(ways),
        "forecasts_held": sum(row["time_low"] <= row["time_there"] <= row["time_high"] for row in ways),
        "largest_kelvin": max(warm, default=None),
        "wrong_slips": int(np.sum([(row["followed"] > 0.1) != (row["answer"] == "slips") for row in slips])),
        "unknown_slips": sum(row["answer"] == "not known" for row in of["slip"]),
    }


def _verdicts(rows: Sequence[dict[str, Any]]) -> list[str]:
    return sorted({row["answer"] for row in rows})


def _circles(kind: str) -> str:
    """A class, with those that do not circle as one."""
    return "does not whirl" if kind in ("stable", "rocking") else kind


if __name__ == "__main__":
    main()
