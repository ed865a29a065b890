"""How often the 95 % intervals of the summary hold the value of a long run: many runs of three scenes that whirl or collide.

Each run starts otherwise. An interval counts as right if the long run's value lies within it, beside the half width of the long
run itself. Averages without an interval are counted, too: what cannot be told is not wrong.

    python benchmarks/interval_coverage.py [--runs 40] [--folder DIR] [--json FILE]

Each scene is run twice from each start: for a stated number of turns, and until the torque is known to 1 %. Whoever ends when an
interval is narrow ends with those that are narrow by chance, so these runs are judged apart, and only those that `until` ended.
Half an hour of processor time.

With --folder the runs are kept as files, and taken from there the next time: to judge another estimate, nothing is run again.
"""

from __future__ import annotations

import math
import tempfile
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import common
import numpy as np

import trbdyn as trb
from trbdyn.results.numbers import averages

COLUMNS = {
    "scene": "text: name",
    "end": "text: what ended the runs, a number of turns or `until`",
    "quantity": "text: average of the summary",
    "truth": "unit of the quantity: value of the long run",
    "truth_half_width": "unit of the quantity: half width of its own interval",
    "runs": "1: runs",
    "given": "1: runs with an interval",
    "held": "1: of these, intervals that hold the value of the long run",
    "scatter": "unit of the quantity: standard deviation of the average over the runs with an interval",
    "half_width": "unit of the quantity: median half width",
    "coverage": "1: share of the intervals that hold the value of the long run",
    "share_given": "1: share of the averages that have an interval",
}
SCENES = {
    "light": (3000.0, 1230.0, 0.0, 100.0, 1500.0),
    "fast": (6000.0, 4930.0, 0.0, 600.0, 4000.0),
    "combined": (6000.0, 4930.0, 5530.0, 300.0, 3000.0),
}
"""Speed (rpm), axial and radial load (N), turns of the shaft of a run and of the long run."""
RECORDS = 20
"""Records in a turn of the shaft."""
GROUPS = ("cage", "rollers", "pocket", "torque", "power", "energy")


UNTIL = {"torque": 0.01}
"""What a run that ends by itself must know: half width of the interval over the average."""
LONGEST = 1.0
"""Turns after which such a run is given up, over those of the other runs."""


def one(folder: Path, scene: str, seed: int, turns: float, until: dict[str, float] | None = None) -> dict[str, Any]:
    """Summary of a run, from its file where there is one; a run that ends by itself has at most so many turns."""
    path = folder / f"{scene}_{seed}_{turns:g}{'_until' if until else ''}.h5"
    if not path.exists():
        speed, axial, radial = SCENES[scene][:3]
        start = trb.Start.whirl(0.9, direction_deg=float(137 * seed % 360))
        given = trb.cases.scene_30310(speed, axial, radial, effects=trb.Effects.standard(), start=start)
        trb.Simulation(given, accuracy="fast").run(
            revolutions=turns, save_every=60.0 / speed / RECORDS, save_groups=GROUPS, output=path, until=until
        )
    return trb.load(path).summary()


def ended(runs: Sequence[dict[str, Any]], turns: float) -> list[dict[str, Any]]:
    """Those that `until` ended, before their longest."""
    return [run for run in runs if run["revolutions"] < 0.999 * turns]


def judge(scene: str, end: str, long: dict[str, Any], runs: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """A row for each average of a scene."""
    rows = []
    for name in averages():
        own = long.get("confidence", {}).get(name, math.nan)
        if long.get(name) is None or math.isnan(own):
            continue
        told = [(run[name], run["confidence"][name]) for run in runs if name in run.get("confidence", {})]
        held = sum(abs(value - long[name]) <= math.hypot(half, own) for value, half in told)
        rows.append(
            {
                "scene": scene,
                "end": end,
                "quantity": name,
                "truth": long[name],
                "truth_half_width": own,
                "runs": len(runs),
                "given": len(told),
                "held": held,
                "scatter": float(np.std([value for value, _ in told])) if told else None,
                "half_width": float(np.median([half for _, half in told])) if told else None,
            }
        )
    return rows


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--runs", type=int, default=40, help="runs of each scene")
    parser.add_argument("--folder", type=Path, help="where runs are kept as files")
    parser.add_argument("--scenes", nargs="+", choices=list(SCENES), default=list(SCENES), help="only these")
    options = parser.parse_args(arguments)
    report = common.Report("interval_coverage", options, COLUMNS)
    count = 2 if options.smoke else 4 if options.quick else options.runs
    report.inputs = {"runs": count, "scenes": {name: SCENES[name] for name in options.scenes}}
    warnings.simplefilter("ignore", UserWarning)
    with tempfile.TemporaryDirectory() as own:
        folder = options.folder or Path(own)
        folder.mkdir(parents=True, exist_ok=True)
        for scene in options.scenes[:1] if options.smoke else options.scenes:
            share = 0.05 if options.smoke else 0.2 if options.quick else 1.0
            turns, most = SCENES[scene][3:]
            if options.smoke:
                turns = 0.2 * turns
            long = one(folder, scene, 0, share * most)
            runs = [one(folder, scene, seed, turns) for seed in range(1, count + 1)]
            alone = [one(folder, scene, seed, LONGEST * turns, UNTIL) for seed in range(1, count + 1)]
            for end, these in (("turns", runs), ("until", ended(alone, LONGEST * turns))):
                for row in judge(scene, end, long, these):
                    report.add(**row)
                    print({key: row[key] for key in ("scene", "end", "quantity", "given", "held")}, flush=True)
    rows = report.results
    given, held = (sum(row[key] for row in rows) for key in ("given", "held"))
    report.summary = {
        "coverage": held / given if given else None,
        "share_given": given / max(sum(row["runs"] for row in rows), 1),
    }
    for scene, end in dict.fromkeys((row["scene"], row["end"]) for row in rows):
        given, held = (
            sum(row[key] for row in rows if (row["scene"], row["end"]) == (scene, end)) for key in ("given", "held")
        )
        report.notes.append(f"{scene}, ended by {end}: {held} of {given} intervals hold the long run's value")
    print("\n".join(report.notes))
    report.finish()
    return report


if __name__ == "__main__":
    main()
