"""What the cage of the 30310 does over speed and axial load, from rest in the middle and from a large whirl.

    python benchmarks/cage_map.py [--quick] [--json FILE]

With the default effects and the preset 'fast', as `trb.cage_map` runs it: 40 turns of the cage, then 160 and 640 where the
motion is not decided.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Final

import common
import matplotlib.pyplot as plt

import trbdyn as trb

COLUMNS: Final = {
    "start": "text: in the middle ('equal'), or in a large whirl",
    "axial_load": "N: axial load",
    "speed_rpm": "rpm: speed",
    "motion": "text: class of the motion of the cage",
    "orbit": "1: orbit of the cage over the radial play",
    "decided": "text: whether class and orbit stand",
    "turns": "1: turns of the cage of the last run; in the summary, of all runs together",
    "seconds": "s: wall time of the map",
    "decided_after_40_turns": "1: share of the points that were decided in the first runs",
    "turns_without_early_end": "1: turns of the cage that would be run if no run ended early",
}
SPEEDS: Final = (500.0, 1000.0, 2000.0, 3000.0, 4500.0, 6000.0)
LOADS: Final = (620.0, 1230.0, 2460.0, 4930.0, 9860.0)


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("cage_map", options, COLUMNS)
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000.0, axial_load=4930.0)
    speeds, loads, longest = ((1000.0, 4500.0), (1230.0,), 40.0) if options.quick else (SPEEDS, LOADS, 640.0)
    speeds = speeds[-1:] if options.smoke else speeds
    began = time.perf_counter()
    found = trb.cage_map(scene, speeds, loads, longest=longest)
    seconds = time.perf_counter() - began
    for place in found.data["kind"].stack(point=("start", "axial_load", "speed_rpm")).point.values:
        start, load, speed = place
        at = found.data.sel(start=start, axial_load=load, speed_rpm=speed)
        report.add(
            start=str(start),
            axial_load=float(load),
            speed_rpm=float(speed),
            motion=str(at["kind"].values),
            orbit=float(at["orbit"]),
            decided="yes" if bool(at["decided"]) else "no",
            turns=float(at["turns"]),
        )
    turns = [row["turns"] for row in report.results]
    report.summary = {
        "seconds": round(seconds),
        "decided_after_40_turns": sum(turn == 40.0 for turn in turns) / len(turns),
        "turns": sum(sum(length for length in (40.0, 160.0, 640.0) if length <= turn) for turn in turns),
        "turns_without_early_end": longest * len(turns),
    }
    print(found)
    if not options.quick:
        found.picture(common.HERE / "pictures" / "cage_map.png", overwrite=True)
        plt.close("all")
    words = [word for word in str(found).splitlines() if word.strip()]
    report.readme = "```\n" + "\n".join(words) + "\n```\n\n" + _summary(report)
    report.finish()
    return report


def _summary(report: common.Report) -> str:
    got = report.summary
    share = 100.0 * got["decided_after_40_turns"]
    return (
        f"{got['seconds']} s on two cores; {share:.0f} % of the points were decided after 40 turns of the cage. All runs "
        f"together had {got['turns']:.0f} turns of the cage; {got['turns_without_early_end']:.0f} would be run if none "
        "ended early."
    )


if __name__ == "__main__":
    main()
