"""Answers within a minute: does the cage whirl; twelve catalogue bearings, beside long runs.

    python benchmarks/answers.py [--quick] [--scenes FIRST:END] [--scatter UM] [--answers FILE] [--follow] [--json FILE]

Each bearing has three loads (light, combined, heavy) at a speed between 300 and 6000 rpm: 36 scenes, with rollers whose diameters
differ by 1 um unless `--scatter` gives another range, for `trb.cage_answer`, with 60 s of processor time each. One bearing has
sizes in inches, two are cylindrical. `--others` takes eight scenes of other bearings, by which no bound of the rule was chosen.
`--answers` takes the answers from a file of an earlier run. `--follow` runs each ten times as long as its answer took, from rest,
or, where a direction was told, from the starts whose way it is: they are there when the mean of 20 turns of the cage is. Where
the start decides both outer starts are followed for as long as was said. Temperatures and slip
were judged once (README, Verdicts beside long runs).
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import common
import numpy as np

import trbdyn as trb
from trbdyn import observables
from trbdyn.extras.maps.cage_answer import ORDER, STARTS, WINDOW

BEARINGS: Final = {
    "30205": 6000.0,
    "30206": 3000.0,
    "LM67048": 2000.0,
    "32208": 2000.0,
    "30310": 1500.0,
    "32310": 3000.0,
    "31312": 1500.0,
    "33113": 1000.0,
    "33217": 1000.0,
    "32024X": 300.0,
    "NJ308": 3000.0,
    "NJ2210": 1500.0,
}
"""Speeds (rpm)."""
LOADS: Final = {"light": (0.02, 0.0), "combined": (0.06, 0.08), "heavy": (0.12, 0.0)}
"""Axial and radial load over the dynamic rating."""
OF_CYLINDERS: Final = {"light": (0.002, 0.03), "combined": (0.01, 0.1), "heavy": (0.002, 0.2)}
"""The same of cylindrical bearings: an axial load only presses the ribs together."""
OTHERS: Final = (
    ("30208", "combined", 3000.0),
    ("32216", "combined", 1200.0),
    ("32004X", "light", 4500.0),
    ("32307", "light", 2000.0),
    ("33208", "combined", 2500.0),
    ("M12649", "combined", 3000.0),
    ("30310", "light", 3000.0),
    ("NJ210", "combined", 3000.0),
)
"""Bearings, loads and speeds (rpm) that served no choice."""
TENFOLD: Final = 10.0
SCATTER: Final = 1.0
"""Range of the diameters of ordinary rollers (um; ISO 12297, grade 1)."""
NEAR: Final = 0.05
"""How much further than its own error the orbit of an answer may be off (1); at least twice as much in all."""
OF_STARTS: Final = ("start decides", "two motions")
OF_ONE: Final = ("agreed", "alike")
SO_FAR: Final = "so far"
COLUMNS: Final = {
    "bearing": "text: designation",
    "load": "text: light, combined or heavy",
    "speed_rpm": "rpm: speed",
    "answer": "text: the verdict",
    "kind": "text: class of the cage's motion",
    "value": "1: orbit over Cpr",
    "rate": "1/s: rate of the start between, over Cpr",
    "turns": "1: turns of the cage of the longest run of the answer, or of a direction's starts",
    "error": "1: how far the orbit may be off, over Cpr",
    "kinds": "text: classes from rest and from a large whirl",
    "near": "text: classes that the answer leaves possible",
    "movers": "text: starts whose way a direction is: rest, whirl 0.9, whirl 0.3",
    "creep_turns": "1: turns of the cage within which the rollers creep",
    "seconds": "s: processor time",
    "scatter": "m: range of the rollers' diameters",
    "from_rest": "1: orbit from rest, over Cpr",
    "from_large": "1: orbit from a large whirl, over Cpr",
    "time_low": "s: time that is left at least, or within which starts decide",
    "time_high": "s: time that is left at most",
    "time_there": "s: time after which the followed start had come there, by the mean of 20 turns of the cage",
    "followed": "value of the long run",
    "followed_kind": "text: class of the motion in the last half of the long run",
    "agreed": "1: number of scenes with an agreed verdict",
    "alike": "1: number of scenes whose starts are of one class with orbits that differ",
    "so_far": "1: number of scenes with a class of all starts that may go on",
    "went_on": "1: of these, those with another class or orbit in the long run",
    "told": "1: number of scenes with a verdict or a direction",
    "of_verdicts": "number of scenes by verdict",
    "forecasts": "1: directions that were followed",
    "forecasts_held": "1: of these, those whose time lies within the forecast",
    "wrong_classes": "1: verdicts that the long run contradicts: another class, or an orbit apart by more than is allowed",
    "scenes": "1: number of scenes",
    "largest_difference": "largest difference of an agreed orbit from the long run (1)",
}


def scene_of(name: str, load: str, speed_rpm: float) -> trb.Scene:
    """One of the scenes."""
    bearing = trb.Bearing.named(name)
    cylinders = name.startswith("N")
    loads: dict[str, Any] = {"axial_load": 10.0, "radial_load": 1000.0} if cylinders else {"axial_load": 1000.0}
    rating = float(trb.rating(trb.Scene(bearing, speed_rpm=1000.0, **loads)).dynamic_rating)
    axial, radial = (share * rating for share in (OF_CYLINDERS if cylinders else LOADS)[load])
    return trb.Scene(bearing, speed_rpm=speed_rpm, axial_load=axial, radial_load=radial, lubricant="vg68")


def all_scenes() -> Iterator[tuple[str, str, float]]:
    """Names of bearings and loads, and speeds (rpm)."""
    return ((name, load, speed) for name, speed in BEARINGS.items() for load in LOADS)


def answered(name: str, load: str, speed_rpm: float, seconds: float, width: float) -> dict[str, Any]:
    """What the cage does, with a scatter of the rollers (m)."""
    scene = scene_of(name, load, speed_rpm)
    found = trb.cage_answer(scene, scatter=[width], processor_time=seconds)
    (row,) = found.rows
    compared = row.found
    print(f"{name} {load}: {row.words} ({row.processor_time:.0f} s)", flush=True)
    return {
        "bearing": name,
        "load": load,
        "speed_rpm": scene.speed_rpm,
        "scatter": width,
        "answer": compared.verdict,
        "kind": row.kind,
        "value": compared.orbit,
        "rate": compared.rate,
        "time_low": compared.time_low,
        "time_high": compared.time_high,
        "creep_turns": found.creep_turns[""],
        "turns": row.turns,
        "error": compared.error,
        "kinds": " / ".join(row.kinds),
        "near": " / ".join(row.near),
        "movers": " / ".join(ORDER[k] for k in compared.movers),
        "from_rest": compared.ends[0],
        "from_large": compared.ends[1],
        "seconds": row.processor_time,
    }


def followed(row: dict[str, Any]) -> dict[str, Any]:
    """What longer runs show of an answer; rollers as those of the answer."""
    scene, groups = scene_of(row["bearing"], row["load"], row["speed_rpm"]), ("cage", "rollers")
    if row["scatter"]:
        roller = scene.bearing.roller.replace(diameter_scatter=trb.Scatter(range=row["scatter"], seed=1))
        scene = scene.replace(bearing=scene.bearing.replace(roller=roller))
    told = row["turns"] / scene.bearing.geometry.cage_speed_ratio * 60.0 / scene.speed_rpm  # time of the answer (s)

    def alone(start: trb.Start, duration: float) -> trb.Result:
        options: dict[str, Any] = {"duration": duration, "save_groups": groups}
        return trb.Simulation(scene.replace(start=start), accuracy="fast").run(**options)

    if row["answer"] in (*OF_ONE, SO_FAR):
        run = alone(trb.Start.equal(), TENFOLD * told)
        late = run.window(0.5 * run.duration).cage_motion
        return {"followed": late.orbit_over_play, "followed_kind": late.kind}
    if row["answer"] in OF_STARTS:
        length = TENFOLD * told if math.isnan(row["time_low"]) else min(TENFOLD * told, row["time_low"])
        moved = [
            abs(run.window(0.9 * run.duration).cage_motion.orbit_over_play - end)
            for start, end in ((trb.Start.equal(), row["from_rest"]), (trb.Start.whirl(0.9), row["from_large"]))
            for run in [alone(start, told + length)]
        ]
        return {"followed": max(moved)}
    length = TENFOLD * told if math.isinf(row["time_high"]) else told + 2.0 * row["time_high"]
    runs = [alone(STARTS[name], length) for name in row["movers"].split(" / ")]
    whens, orbits = zip(*(_smooth(*run.turn_means()) for run in runs), strict=True)
    size = min(map(len, orbits))
    when, first = whens[0][:size], orbits[0][:size]
    left = (
        orbits[1][:size] - first
        if len(runs) > 1
        else (row["value"] - first) * (-1.0 if row["answer"] == "dies" else 1.0)
    )
    there = (when >= told) & (left <= observables.LIMITS["orbit radius"])
    late = runs[0].window(0.9 * runs[0].duration).cage_motion
    wait = float(when[int(np.argmax(there))]) - told if there.any() else math.inf
    return {"followed": late.orbit_over_play, "followed_kind": late.kind, "time_there": wait}


def _smooth(when: Any, means: dict[str, Any]) -> tuple[Any, Any]:
    """Ends of the last 20 turns of the cage (s), and orbit over Cpr as the mean of them."""
    return when[WINDOW - 1 :], np.convolve(means["orbit radius"], np.full(WINDOW, 1.0 / WINDOW), "valid")


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    parser.add_argument("--scenes", default=":", help="which scenes, FIRST:END")
    parser.add_argument("--others", action="store_true", help="scenes of other bearings, which served no choice")
    parser.add_argument("--follow", action="store_true", help="run long ones, too")
    parser.add_argument("--answers", type=Path, metavar="FILE", help="answers of an earlier run")
    parser.add_argument("--scatter", type=float, default=SCATTER, help="range of the rollers' diameters (um)")
    parser.add_argument("--seconds", type=float, default=60.0, help="processor time of an answer on a cage")
    options = parser.parse_args(arguments)
    report = common.Report("answers", options, COLUMNS)
    first, end = (int(part) if part else None for part in options.scenes.split(":"))
    chosen = list(OTHERS if options.others else all_scenes())
    scenes = [("32208", "light", BEARINGS["32208"])] if options.quick else chosen[first:end]
    given = json.loads(options.answers.read_text(encoding="utf-8"))["results"] if options.answers else []
    known = {(row["bearing"], row["load"], row["speed_rpm"]): row for row in given}
    for scene in scenes:
        if options.answers and scene not in known:
            continue
        row = known.get(scene) or answered(*scene, 4.0 if options.quick else options.seconds, 1e-6 * options.scatter)
        report.add(**row, **(followed(row) if options.follow and row["answer"] != "unknown" else {}))
    report.summary = _summary(report.results)
    print(common.table(report.results, ("bearing", "load", "answer", "kind", "value", "followed", "seconds")))
    print(report.summary)
    report.finish()
    return report


def _summary(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    long = [row for row in rows if "followed" in row]
    starts = [row for row in long if row["answer"] in OF_STARTS]
    ways = [row for row in long if row["answer"] in ("grows", "dies", "meets")]
    off = [abs(row["followed"] - row["value"]) for row in long if row["answer"] == "agreed"]
    return {
        "scenes": len(rows),
        "of_verdicts": {name: sum(row["answer"] == name for row in rows) for name in _verdicts(rows)},
        "agreed": sum(row["answer"] == "agreed" for row in rows),
        "alike": sum(row["answer"] == "alike" for row in rows),
        "so_far": sum(row["answer"] == SO_FAR for row in rows),
        "went_on": sum(is_wrong(row) for row in long if row["answer"] == SO_FAR),
        "told": sum(row["answer"] not in ("unknown", SO_FAR) for row in rows),
        "largest_difference": max(off, default=None),
        "wrong_classes": sum(is_wrong(row) for row in long if row["answer"] in OF_ONE)
        + sum(row["followed"] > 2.0 * NEAR for row in starts),
        "forecasts": len(ways),
        "forecasts_held": sum(row["time_low"] <= row["time_there"] <= row["time_high"] for row in ways),
    }


def is_wrong(row: dict[str, Any]) -> bool:
    """Whether a long run contradicts the class or the orbit of an answer."""
    classes = {_circles(kind) for kind in (row["kind"], *row["near"].split(" / ")) if kind != "unknown"}
    off = abs(row["followed"] - row["value"])
    return bool(_circles(row["followed_kind"]) not in classes or (off > max(2.0 * NEAR, row["error"] + NEAR)))


def _verdicts(rows: Sequence[dict[str, Any]]) -> list[str]:
    return sorted({row["answer"] for row in rows})


def _circles(kind: str) -> str:
    """A class, with those that do not circle as one."""
    return "does not whirl" if kind in ("stable", "rocking") else kind


if __name__ == "__main__":
    main()
