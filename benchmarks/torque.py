"""Friction torque of a 32216 bearing beside measured values: every preset of effects that has lubricated friction.

    .venv/bin/python benchmarks/torque.py [--quick] [--json FILE]

Oil FVA3 at 50 C; axial load 6 kN, and 6 kN with a radial load of 6.5 kN. Measured values: Wingertszahn et al. 2023, Lubricants
11:369, read from its figures (1.20, 2.75, 3.80 N m are results of its own simulation). What it leaves open is assumed, see
`trb.cases.bearing_32216`. The torques of both rings are shown: where they differ, the rolling film's pressure force is left out.
"""

from __future__ import annotations

import argparse
from typing import Any

import common
import numpy as np

import trbdyn as trb

AXIAL_LOAD, RADIAL_LOAD = 6000.0, 6500.0
PRESETS = ("standard", "paper")
COLUMNS = {
    "preset": "1: preset of the effects",
    "radial_load": "N: radial load",
    "speed_rpm": "rpm: speed of the shaft",
    "measured": "N m: measured friction torque",
    "shaft": "N m: friction torque of the shaft, mean",
    "outer_ring": "N m: friction torque on the outer ring, mean",
    "deviation": "%: shaft torque over the measured one, less 100 %",
    "drift": "N m: change of the shaft torque between the quarters of the run that count",
    "rolling": "N m: share of rolling resistance and its pressure force, power loss over shaft speed",
    "rib": "N m: share of the back-face rib",
    "other": "N m: share of traction, pockets, front rib, boundary friction and damping",
    "mean_deviation": "%: mean size of the deviation, by preset",
    "worst_deviation": "%: largest size of the deviation, by preset",
    "rings_differ": "%: largest difference of the rings' torques, by preset",
}


def points(quick: bool) -> list[tuple[float, float, float]]:
    """(radial load, speed, measured torque) of every measurement; with `quick` one of each kind of load."""
    found = [(0.0, speed, torque) for speed, torque in trb.cases.MEASURED_TORQUE_32216.items()]
    combined = [(RADIAL_LOAD, speed, torque) for speed, torque in trb.cases.MEASURED_TORQUE_32216_COMBINED.items()]
    return [found[1], combined[2]] if quick else found + combined


def run(preset: str, radial_load: float, speed_rpm: float, turns: float) -> dict[str, Any]:
    """Torques of one run (N m), over the last half of its turns."""
    effects = getattr(trb.Effects, preset)()
    scene = trb.cases.scene_32216(speed_rpm, AXIAL_LOAD, radial_load, effects=effects)
    result = trb.Simulation(scene).run(
        revolutions=turns, save_every=0.15 / speed_rpm, save_groups=("torque", "power", "energy")
    )
    last = result.window(0.5 * result.final_time)
    first, second = np.array_split(last["inner_torque"], 2)
    lost = last.torque_by_loss
    rolling = sum(value for name, value in lost.items() if name.startswith("rolling"))
    return {
        "shaft": float(last["inner_torque"].mean()),
        "outer_ring": float(last["outer_torque"].mean()),
        "drift": float(second.mean() - first.mean()),
        "rolling": rolling,
        "rib": lost.get("rib", 0.0),
        "other": sum(lost.values()) - rolling - lost.get("rib", 0.0),
    }


def shown(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The rows as they are printed: sizes with two decimals, deviations in whole per cent."""
    return [
        {
            "load": f"{AXIAL_LOAD / 1e3:g} kN"
            + (f", Fr {row['radial_load'] / 1e3:g} kN" if row["radial_load"] else ""),
            "rpm": f"{row['speed_rpm']:g}",
            "preset": row["preset"],
            "shaft (N m)": f"{row['shaft']:.2f}",
            "outer ring (N m)": f"{row['outer_ring']:.2f}",
            "measured (N m)": f"{row['measured']:.2f}",
            "deviation": f"{row['deviation']:+.0f} %",
        }
        for row in rows
    ]


def main(arguments: argparse.Namespace | None = None) -> dict[str, Any]:
    """Run all points with all presets; print the table."""
    options = arguments or common.parser(__doc__).parse_args()
    report = common.Report("torque", options, COLUMNS)
    turns = 2.0 if options.quick else 6.0
    report.inputs = {"bearing": "32216", "axial_load": AXIAL_LOAD, "oil": "FVA3, 50 C", "turns": turns}
    for radial_load, speed, measured in points(options.quick):
        for preset in PRESETS:
            found = run(preset, radial_load, speed, turns)
            deviation = 100.0 * (found["shaft"] / measured - 1.0)
            report.add(
                preset=preset, radial_load=radial_load, speed_rpm=speed, measured=measured, deviation=deviation, **found
            )
    for preset in PRESETS:
        rows = [row for row in report.results if row["preset"] == preset]
        sizes = [abs(row["deviation"]) for row in rows]
        between = max(100.0 * abs(row["outer_ring"] / row["shaft"] - 1.0) for row in rows)
        for name, value in (("mean", float(np.mean(sizes))), ("worst", max(sizes))):
            report.summary.setdefault(f"{name}_deviation", {})[preset] = value
        report.summary.setdefault("rings_differ", {})[preset] = between
    lines = shown(report.results)
    report.readme = common.table(lines, list(lines[0]))
    print(report.readme)
    for preset in PRESETS:
        figures = (report.summary[name][preset] for name in ("mean_deviation", "worst_deviation", "rings_differ"))
        print(
            "{}: deviation {:.0f} % in the mean, {:.0f} % at worst; rings differ by up to {:.1f} %".format(
                preset, *figures
            )
        )
    return report.finish()


if __name__ == "__main__":
    main()
