"""Cage behaviour over creep number and Froude number: growth, yielding, direction of the load, and the paper's points on the map.

Creep numbers come from the core's laws at static equilibrium; growth, yielding and direction are measured in the complete model
(8 Gauss nodes); the map is drawn by the planar model of `creep.planar`.
"""

from __future__ import annotations

import math
from typing import Any

import common
import numpy as np
from creep import planar, whirl

import trbdyn as trb
from trbdyn.paper.creep import creep, growth_per_turn

COLUMNS = {
    "part": "1: chi, growth, yielding, direction or map",
    "bearing": "1: bearing",
    "rheology": "1: viscosity law, temperature, starvation factor",
    "accuracy": "1: preset of tolerances",
    "speed_rpm": "1/min: shaft speed",
    "axial_load": "N: axial load",
    "radial_load": "N: radial load",
    "direction_deg": "deg: direction of the radial load on the inner ring; 90: loaded zone on top",
    "gravity": "m/s2: gravity",
    "eccentricity": "1: whirl radius at the start over Cpr",
    "chi": "1: creep number",
    "froude": "1: Froude number",
    "unevenness": "1: 0.5 ln(v'max/v'min), positive with the loaded zone on top",
    "film_parameter": "1: smallest film parameter of both raceways",
    "chi_yield": "1: stated yield limit 2 Z/cos(gamma)",
    "rate": "1: growth of the rollers' pattern a turn of the cage, measured",
    "error": "1: standard error of rate",
    "law": "1: growth a turn by trbdyn.paper.creep.growth_per_turn",
    "theory": "1: growth a turn by (2 cos^4(gamma)/Z) (Cpc/Cpr) chi Fn",
    "fit": "1: growth a turn by 0.070 chi (Fn - 0.20), for the 30310 only",
    "stated": "1: rate without radial load by law, times 1 - l sin(gamma)/2",
    "whirl": "1: synchronous whirl radius over the last 10 turns, over Cpr",
    "rest": "1: distance of the mean place over the last 10 turns, over Cpr",
    "cpu": "s: processor time",
    "law_rms": "1: rms of (law - rate)/chi over the growth points",
    "theory_rms": "1: rms of (theory - rate)/chi over the growth points",
    "fit_rms": "1: rms of (fit - rate)/chi over the growth points of the 30310",
}
GAUSS = trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
G = 9.80665


def numbers(bearing: trb.Bearing) -> dict[str, float]:
    """What the laws take of a bearing; the lean from the plays, as the pocket is built."""
    cage, geometry = bearing.cage, bearing.geometry
    ratio = cage.play_circumferential / cage.play_radial
    axis, taper = (
        geometry.roller_axis_angle,
        math.tan(geometry.roller_half_angle) * math.sin(geometry.roller_axis_angle),
    )
    # sin(gamma) cos(axis) - ratio cos(gamma) = taper
    size = math.hypot(math.cos(axis), ratio)
    lean = math.asin(taper / size) + math.atan2(ratio, math.cos(axis))
    inertia = cage.inertia_axial / (cage.mass * (0.5 * bearing.pitch_diameter) ** 2)
    return {"n_rollers": bearing.n_rollers, "lean": lean, "play_ratio": ratio, "inertia": inertia}


def scene(
    speed: float,
    load: float,
    gravity: float = G,
    name: str = "30310",
    radial: float = 0.0,
    direction: float = 90.0,
    e: float = 0.4,
) -> trb.Scene:
    """A whirling start in either bearing."""
    make = trb.cases.scene_30310 if name == "30310" else trb.cases.scene_32216
    return make(
        speed,
        load,
        radial,
        effects=GAUSS,
        gravity=(0.0, -gravity, 0.0),
        radial_direction_deg=direction,
        start=trb.Start.whirl(e),
    )


def rheologies(report: common.Report, quick: bool) -> None:
    """Creep numbers of the paper's axial points for each rheology."""
    cases: list[tuple[str, float, float, float]] = [(law, 60.0, 60.0, 1.0) for law in ("dicke", "roelands", "barus")]
    if not quick:
        cases += [(law, 60.0, warm, 1.0) for law in ("dicke", "roelands", "barus") for warm in (70.0, 80.0)]
        cases += [(law, 80.0, 80.0, 1.0) for law in ("dicke", "roelands", "barus")]
        cases += [(law, 60.0, 60.0, thin) for law in ("dicke", "roelands", "barus") for thin in (0.5, 0.3)]
    for law, oil_c, warm, thin in cases:
        oil, hot = (trb.lubricants.vg100(t, pressure_law=law) for t in (oil_c, warm))  # type: ignore[arg-type]
        for speed in (1000.0, 2000.0, 3000.0):
            for load in (1230.0, 3080.0, 4930.0):
                found = creep(
                    trb.cases.scene_30310(speed, load, lubricant=oil, effects=GAUSS.replace(starvation_factor=thin)),
                    contact_oil=hot,
                )
                report.add(
                    part="chi",
                    rheology=f"{law}, oil {oil_c:g} C, contact {warm:g} C, film x {thin:g}",
                    speed_rpm=speed,
                    axial_load=load,
                    chi=found.chi,
                    froude=found.froude,
                    film_parameter=float(found.film_parameter.min()),
                )


GROWTH: list[dict[str, Any]] = [
    {"speed": 3000.0, "load": 4930.0},
    {"speed": 3000.0, "load": 4930.0, "gravity": 4.9},
    {"speed": 3000.0, "load": 4930.0, "gravity": 20.0},
    {"speed": 2000.0, "load": 4930.0},
    {"speed": 2000.0, "load": 4930.0, "gravity": 20.0},
    {"speed": 1000.0, "load": 4930.0},
    {"speed": 3000.0, "load": 4200.0},
    {"speed": 2000.0, "load": 3080.0},
    {"speed": 3000.0, "load": 6000.0, "name": "32216"},
    {"speed": 2000.0, "load": 6000.0, "name": "32216"},
]
YIELD: list[dict[str, Any]] = [
    {"speed": 3000.0, "load": 3080.0},
    {"speed": 3000.0, "load": 2200.0},
    {"speed": 3000.0, "load": 1800.0},
    {"speed": 3000.0, "load": 1500.0},
    {"speed": 3000.0, "load": 1350.0},
    {"speed": 3000.0, "load": 1230.0},
    {"speed": 3000.0, "load": 1230.0, "gravity": 4.0},
    {"speed": 3000.0, "load": 1800.0, "gravity": 25.0},
]
DIRECTION: list[dict[str, Any]] = [
    {"speed": speed, "load": 4930.0, "radial": radial, "direction": direction}
    for speed, radial in ((3000.0, 700.0), (3000.0, 1400.0), (2000.0, 1400.0))
    for direction in (90.0, -90.0, 0.0)
]


def measure(
    report: common.Report, part: str, case: dict[str, Any], turns: float, e: float, accuracy: str = "fast"
) -> None:
    """One run of the complete model beside the laws."""
    what = scene(**case, e=e)
    found, run = creep(what), whirl.run(what, turns, accuracy=accuracy)
    parts = numbers(what.bearing)
    upward = math.sin(math.radians(case.get("direction", 90.0)))
    uneven = found.unevenness * upward if case.get("radial") else 0.0
    c, z, ratio = math.cos(parts["lean"]), parts["n_rollers"], parts["play_ratio"]
    row: dict[str, Any] = {
        "part": part,
        "bearing": what.bearing.name,
        "accuracy": accuracy,
        "speed_rpm": case["speed"],
        "axial_load": case["load"],
        "gravity": case.get("gravity", G),
        "eccentricity": e,
        "chi": found.chi,
        "froude": found.froude,
        "cpu": run.cpu_s,
    }
    if part == "yielding":
        turn = np.exp(-2j * np.pi * np.arange(run.motion.position.shape[0]) / run.motion.samples)
        last = slice(-10 * run.motion.samples - 1, -1)
        row["whirl"] = float(abs((run.motion.position[:, 0] * turn)[last].mean()))
        row["rest"] = float(abs(run.motion.position[last, 0].mean()))
        row["chi_yield"] = 2.0 * z / c
    else:
        even = growth_per_turn(found.chi, found.froude, **parts)  # type: ignore[arg-type]
        row |= {"rate": run.rate, "error": run.error, "theory": 2.0 * c**4 / z * ratio * found.chi * found.froude}
        row["law"] = growth_per_turn(found.chi, found.froude, unevenness=uneven, **parts)  # type: ignore[arg-type]
        if what.bearing.name == "30310":
            row["fit"] = 0.070 * found.chi * (found.froude - 0.20)
    if part == "direction":
        row |= {"radial_load": case["radial"], "direction_deg": case["direction"], "unevenness": uneven}
        row["stated"] = even * (1.0 - 0.5 * uneven * math.sin(parts["lean"]))
    report.add(**row)


def behaviour(report: common.Report, quick: bool) -> tuple[Any, Any, Any]:
    """Whirl radius of the planar model after 40 turns from 0.5 Cpr."""
    chi = np.geomspace(0.3, 60.0, 9 if quick else 16)
    froude = (
        np.array([0.1, 0.2, 0.437, 0.8]) if quick else np.array([0.05, 0.1, 0.15, 0.194, 0.25, 0.32, 0.437, 0.6, 0.8])
    )
    radius = np.empty((froude.size, chi.size))
    turns = 20 if quick else 40
    for i, value in enumerate(froude):
        motion = planar.simulate(chi, value, turns, 0.5)
        turn = np.exp(-2j * np.pi * np.arange(motion.position.shape[0]) / motion.samples)[:, None]
        last = slice(-10 * motion.samples - 1, -1)
        radius[i] = np.abs((motion.position * turn)[last].mean(axis=0))
        for x, y in zip(chi, radius[i], strict=True):
            report.add(part="map", chi=x, froude=value, eccentricity=0.5, whirl=y)
    return chi, froude, radius


def draw(report: common.Report, chi: Any, froude: Any, radius: Any) -> None:
    """The map, with the paper's axial points."""
    plt = common.pyplot()
    figure, axes = plt.subplots(figsize=(8.5, 5.5), layout="constrained")
    filled = axes.contourf(chi, froude, radius, levels=np.linspace(0.0, 1.1, 12), cmap="viridis")
    figure.colorbar(filled, label="synchronous whirl radius of the cage / Cpr")
    rows = [row for row in report.results if row["part"] == "chi"]
    names = list(dict.fromkeys(row["rheology"] for row in rows))
    plain = [name for name in names if "oil 60 C" in name and ("contact 60 C" in name or "contact 80 C" in name)]
    for name, mark in zip(plain, "osD^v<>PX*hd", strict=False):
        part = [row for row in rows if row["rheology"] == name]
        x, y = [row["chi"] for row in part], [row["froude"] for row in part]
        axes.plot(x, y, mark, mfc="white", mec="black", ms=6, alpha=0.85, label=name.replace(", oil 60 C", ""))
    axes.set(
        xscale="log", xlim=(0.05, 300.0), ylim=(0.04, 0.8), xlabel="creep number χ (1)", ylabel="Froude number Fn (1)"
    )
    axes.axvline(2.0 * 12 / math.cos(math.radians(26.39)), color="red", ls="--")
    axes.set_title(
        "Planar model after turns from 0.5 Cpr; red: stated yield limit; marks: 1230-4930 N, 1000-3000 rpm", fontsize=9
    )
    axes.legend(fontsize=7, loc="upper right")
    (common.HERE / "paper").mkdir(exist_ok=True)
    figure.savefig(common.HERE / "paper" / "creep_map.png", dpi=120)


def main() -> None:
    """Run the benchmark."""
    options = common.parser(__doc__).parse_args()
    report, quick = common.Report("creep_map", options, COLUMNS), options.quick
    rheologies(report, quick)
    for case in GROWTH[:3] if quick else GROWTH:
        for e in (0.4,) if quick else (0.2, 0.4):
            measure(report, "growth", case, 20, e)
    for case in [] if quick else [GROWTH[0], GROWTH[3]]:
        measure(report, "growth", case, 20, 0.4, "standard")
    for case in YIELD[::4] if quick else YIELD:
        measure(report, "yielding", case, 30, 0.9)
    for case in DIRECTION[:2] if quick else DIRECTION:
        measure(report, "direction", case, 12, 0.3)
    rows = [row for row in report.results if row["part"] == "growth"]
    for name in ("law", "theory", "fit"):
        wrong = [(row[name] - row["rate"]) / row["chi"] for row in rows if name in row]
        report.summary[f"{name}_rms"] = float(np.sqrt(np.mean(np.square(wrong))))
    for part, names in (
        ("chi", ("rheology", "speed_rpm", "axial_load", "chi", "froude", "film_parameter")),
        (
            "growth",
            (
                "bearing",
                "accuracy",
                "speed_rpm",
                "axial_load",
                "gravity",
                "eccentricity",
                "chi",
                "froude",
                "rate",
                "error",
                "law",
                "theory",
                "fit",
            ),
        ),
        ("yielding", ("speed_rpm", "axial_load", "gravity", "chi", "froude", "chi_yield", "whirl", "rest")),
        (
            "direction",
            ("speed_rpm", "radial_load", "direction_deg", "unevenness", "chi", "rate", "error", "law", "stated"),
        ),
    ):
        print(f"\n{part}\n{common.table([row for row in report.results if row['part'] == part], names)}", flush=True)
    print(report.summary)
    found = behaviour(report, quick)
    if not options.no_picture:
        draw(report, *found)
    report.finish()


if __name__ == "__main__":
    main()
