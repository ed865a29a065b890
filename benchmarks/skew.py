"""How far rollers skew by the friction at the rib, over its friction, the film, the load and the curvature of the large end.

    python benchmarks/skew.py [--quick] [--json FILE]

Rollers of an LM501300 tapered bearing with a poor film at the rib were measured to skew by 2.6 to 10.5 mrad. Its dimensions
here are those of the series, the insides an estimate; oil, speeds and loads of the measurement are not known, so both are varied.
The mixed friction of the rib is that of an exponential share of asperities, with its film for a contact along rolling.

Beside each run stands what a balance of the roller alone gives. Friction mu Q at the large end turns the roller about its radial
axis with the arm l from the centre of mass to the end. The sphere of a skewed end moves sideways over the rib, and its load turns
the roller back. With R from the apex to the end and rho R the radius of the sphere, it moves by skew rho R / (1 - rho):
skew = mu l (1/rho - 1) / R.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from itertools import product
from typing import Any

import common
import numpy as np

import trbdyn as trb
from trbdyn.model.lubricants import iso_vg
from trbdyn.statics.plausible import UnusualInput

COLUMNS = {
    "sphere_ratio": "1: radius of the large end over its distance from the apex",
    "boundary": "1: boundary friction at large slip",
    "oil": "text: grade and temperature",
    "speed_rpm": "rpm: speed",
    "axial_load": "N: axial load",
    "film_parameter": "1: film parameter at the rib",
    "rib_friction": "1: friction of the rib over its load",
    "skew": "mrad: mean skew of the rollers",
    "balance": "mrad: skew by the balance of the roller alone",
    "largest": "mrad: largest skew of all runs",
    "largest_difference": "1: largest difference of both where the film parameter is below 0.5, over the skew",
}
MEASURED = (2.6, 10.5)
"""Skew (mrad)."""


def scene_of(ratio: float, boundary: float, oil: tuple[int, float], speed: float, load: float) -> trb.Scene:
    """The bearing with a boundary friction and an oil."""
    bearing = trb.Bearing.from_catalogue(bore=0.041275, outside=0.073431, width=0.019558, C=55e3, e=0.40)
    effects = trb.Effects.standard().replace(mixed_law="exponential", rib_film="needle", rib_turning=True)
    effects = effects.replace(friction=effects.friction.replace(boundary_limit=boundary))
    bearing = bearing.replace({"roller.sphere_ratio": ratio})
    return trb.Scene(bearing, speed_rpm=speed, axial_load=load, lubricant=iso_vg(*oil), effects=effects)


def measured(scene: trb.Scene, turns: float) -> dict[str, Any]:
    """Means over the second half of a run."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualInput)
        result = trb.Simulation(scene, accuracy="fast").run(revolutions=turns)
    half, geometry = slice(len(result) // 2, None), scene.bearing.geometry
    friction = float(np.mean(result["rib_friction"][half] / result["rib_load"][half]))
    arm = geometry.large_end_station - geometry.roller_mass_offset
    lever = arm * (1.0 / scene.bearing.roller.sphere_ratio - 1.0) / geometry.apex_to_large_end
    return {
        "film_parameter": float(result["rib_film_parameter"][half].mean()),
        "rib_friction": friction,
        "skew": 1e3 * float(result["roller_skew"][half].mean()),
        "balance": 1e3 * friction * lever,
    }


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("skew", options, COLUMNS)
    ratios, oils = (0.95, 0.90, 0.80, 0.70), ((220, 40.0), (32, 80.0))
    cases = list(product(ratios, (0.1, 0.2), oils, (200.0, 2000.0), (1000.0, 5000.0)))
    report.inputs = {"measured_mrad": MEASURED, "revolutions": 8.0}
    for ratio, boundary, oil, speed, load in cases[-6:-5] if options.quick else cases:
        scene = scene_of(ratio, boundary, oil, speed, load)
        row = measured(scene, 2.0 if options.quick else 8.0)
        named = {"sphere_ratio": ratio, "boundary": boundary, "oil": f"VG {oil[0]}, {oil[1]:g} C"}
        report.add(**named, speed_rpm=speed, axial_load=load, **row)
    thin = [row for row in report.results if row["film_parameter"] < 0.5]
    report.summary["largest"] = max(row["skew"] for row in report.results)
    if thin:
        report.summary["largest_difference"] = max(abs(row["balance"] / row["skew"] - 1.0) for row in thin)
    shown = [name for name in COLUMNS if not name.startswith("largest")]
    print("\n" + common.table(report.results, shown))
    report.readme = common.table([row for row in report.results if row["axial_load"] > 1000.0], shown)
    report.finish()
    return report


if __name__ == "__main__":
    main()
