"""``python benchmarks/validation``: every measurement beside its prediction with a band, and beside SKF's formula.

    .venv/bin/python benchmarks/validation [--quick] [--json FILE] [--write-readme]

The assumptions are those of `validation.assumptions`, measurements those of `validation.measured`. ``--write-readme`` puts the
table into docs/validation.md, and the numbers into benchmarks/validation/validation.json.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import common
import numpy as np

import trbdyn as trb
from validation import skf
from validation.assumptions import CATALOGUE, SAMPLES, SEED, TURNS, bands_of, scene_of
from validation.measured import MEASUREMENTS, NOT_ENOUGH, Measurement

HERE = Path(__file__).resolve().parent
PAGE = HERE.parents[1] / "docs" / "validation.md"
COLUMNS = {
    "source": "1: where it is published",
    "bearing": "1: bearing",
    "quantity": "1: what was measured",
    "speed_rpm": "rpm: speed of the shaft",
    "axial_load": "N: axial load",
    "radial_load": "N: radial load, down",
    "measured": "unit of the quantity",
    "reading_error": "unit of the quantity: how far the reading may be off",
    "predicted": "unit of the quantity: with every open input at its value",
    "low": "unit of the quantity: 95 % of the draws lie above half of the rest",
    "high": "unit of the quantity: the same, below",
    "is_inside": "1: whether the measured value lies within the band, or its reading may",
    "error": "%: predicted over measured, less 100 %",
    "skf": "unit of the quantity: SKF's model",
    "paper_law": "unit of the quantity: predicted, but with the law of rolling resistance of Zhou and Hoeprich",
    "shares": "1: inputs that make most of the band's variance",
    "inside": "1: share of measured points within their band",
    "mean_error": "%: mean size of the error, torques",
    "max_error": "%: largest size of the error, torques",
    "median_band": "%: median of half the band's width over the prediction, torques",
    "skf_mean_error": "%: mean size of SKF's error, torques",
    "bearings": "1: number of bearings",
}


def main() -> int:
    """Run all measurements; print the table."""
    options = common.parser(__doc__).parse_args()
    report = common.Report("validation", options, COLUMNS)
    points = [MEASUREMENTS[1], MEASUREMENTS[-1]] if options.quick else MEASUREMENTS
    samples = 16 if options.quick else SAMPLES
    report.inputs = {"samples": samples, "seed": SEED, "turns": TURNS}
    for point in points:
        found = torque(point, samples) if point.quantity == "torque" else loaded_rollers(point)
        inside = found["low"] - point.reading_error <= point.value <= found["high"] + point.reading_error
        report.add(
            source=point.source,
            bearing=point.bearing,
            quantity=point.quantity,
            speed_rpm=point.speed_rpm,
            axial_load=point.axial_load,
            radial_load=point.radial_load,
            measured=point.value,
            reading_error=point.reading_error,
            is_inside=bool(inside),
            error=100.0 * (found["predicted"] / point.value - 1.0),
            **found,
        )
    torques = [row for row in report.results if row["quantity"] == "torque"]
    sizes = [abs(row["error"]) for row in torques]
    report.summary = {
        "inside": float(np.mean([row["is_inside"] for row in report.results])),
        "mean_error": float(np.mean(sizes)),
        "max_error": max(sizes),
        "median_band": float(np.median([50.0 * (row["high"] - row["low"]) / row["predicted"] for row in torques])),
        "skf_mean_error": float(np.mean([100.0 * abs(row["skf"] / row["measured"] - 1.0) for row in torques])),
        "bearings": len({row["bearing"] for row in report.results}),
    }
    report.notes = [f"not used, {name}: {why}" for name, why in NOT_ENOUGH.items()]
    text = common.table(shown(report.results), list(shown(report.results)[0]))
    words = ", ".join(f"`{name}` {value:.3g}" for name, value in report.summary.items())
    print(f"{text}\n\n{words}")
    if options.write_readme:
        options.json = options.json or HERE / "validation.json"
        common.write_readme("validation", f"{text}\n\n{words} (errors and bands in %).", PAGE)
    report.finish()
    return 0


def torque(point: Measurement, samples: int) -> dict[str, Any]:
    """Prediction and band of a torque (N m)."""
    scene = scene_of(point)
    run = trb.RunOptions(revolutions=TURNS, accuracy="fast")
    found = trb.uncertainty(scene, bands_of(point), samples=samples, seed=SEED, options=run)["torque"]
    other = scene.replace(effects=scene.effects.replace(rolling_law="zhou_hoeprich"))
    page = CATALOGUE[point.bearing]
    oil = scene.lubricant
    largest = sorted(found.shares.items(), key=lambda entry: -entry[1])[:2]
    return {
        "predicted": found.value,
        "low": found.low,
        "high": found.high,
        "skf": skf.torque(
            **page,
            speed_rpm=point.speed_rpm,
            axial_load=point.axial_load,
            radial_load=point.radial_load,
            viscosity=1e6 * oil.viscosity / oil.density,
        ),
        "paper_law": trb.Simulation(other, accuracy="fast").run(revolutions=TURNS).summary()["torque"],
        "shares": dict(largest),
    }


def loaded_rollers(point: Measurement) -> dict[str, Any]:
    """Number of rollers that carry, at the equilibrium; its band is that of the cup's angle."""
    scene = scene_of(point)
    counts = [count(scene)]
    band = next(band for band in bands_of(point) if band.path == "bearing.cup_half_angle_deg")
    for angle in np.linspace(band.low, band.high, 9):
        counts.append(count(scene.replace(bearing=scene.bearing.replace(cup_half_angle_deg=float(angle)))))
    return {
        "predicted": counts[0],
        "low": min(counts),
        "high": max(counts),
        "shares": {"bearing.cup_half_angle_deg": 1.0},
    }


def count(scene: trb.Scene) -> float:
    """Rollers that the inner raceway loads."""
    return float(np.count_nonzero(trb.Simulation(scene).equilibrium.inner_load > 1.0))


def shown(rows: list[dict[str, Any]]) -> list[dict[str, str]]:
    """The rows as they are printed."""
    out = []
    for row in rows:
        digits = 2 if row["quantity"] == "torque" else 0
        load = f"{row['axial_load'] / 1e3:g}" + (f", Fr {row['radial_load'] / 1e3:g}" if row["radial_load"] else "")
        out.append(
            {
                "bearing": row["bearing"],
                "quantity": row["quantity"].replace("_", " "),
                "rpm": f"{row['speed_rpm']:g}",
                "Fa (kN)": load,
                "measured": f"{row['measured']:.{digits}f}",
                "predicted": f"{row['predicted']:.{digits}f}",
                "band": f"{row['low']:.{digits}f} to {row['high']:.{digits}f}",
                "inside": "yes" if row["is_inside"] else "no",
                "error": f"{row['error']:+.0f} %",
                "SKF": f"{row['skf']:.2f}" if "skf" in row else "-",
                "with the paper's law": f"{row['paper_law']:.2f}" if "paper_law" in row else "-",
            }
        )
    return out
