"""Cage behaviour over creep number and Froude number: growth, yielding, direction of the load, and the paper's points
on the map.

Creep numbers come from the core's laws at static equilibrium; growth, yielding and direction are measured in the
complete model (8 Gauss nodes); the map is drawn by the planar model of `creep.planar`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import common
import numpy as np
import paper.points as paper
from creep import outcome, planar, whirl

import trbdyn as trb
from trbdyn.statics.creep import creep, growth_per_turn

COLUMNS = {
    "part": "1: chi, growth, yielding, direction, map, point or statement",
    "model": "1: complete or planar",
    "statement": "1: figure of the paper and what it states",
    "scatter": "1: whether roller diameters scatter over 1 um",
    "drift": "1: change of whirl in the last turns, over Cpr",
    "reach": "1: 95th percentile of the distance from the axis over the last turns, over Cpr",
    "lasting": "1: mean of the rollers' pattern over the last turns, over Cpr",
    "varying": "1: rms of what varies of the pattern over the last turns, over Cpr",
    "small": "1: verdict from the small orbit; * not settled",
    "large": "1: verdict from the large orbit; * not settled",
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
    "law": "1: growth a turn by trbdyn.statics.creep.growth_per_turn",
    "theory": "1: growth a turn by (2 cos^4(gamma)/Z) (Cpc/Cpr) chi Fn",
    "fit": "1: growth a turn by 0.070 chi (Fn - 0.20), for the 30310 only",
    "stated": "1: rate without radial load by law, times 1 - l sin(gamma)/2",
    "whirl": "1: synchronous whirl radius over the last turns, over Cpr",
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
    make = trb.cases.paper_30310 if name == "30310" else trb.cases.scene_32216
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
] + [
    {"speed": 3000.0, "load": 4930.0, "radial": 1400.0, "direction": direction, **other}
    for other in ({"gravity": 4.9}, {"gravity": 20.0}, {"load": 6000.0, "name": "32216"})
    for direction in (90.0, -90.0)
]
YIELD_SMALL: list[dict[str, Any]] = [
    {"speed": 3000.0, "load": 3080.0},
    {"speed": 3000.0, "load": 1800.0},
    {"speed": 3000.0, "load": 1500.0},
    {"speed": 3000.0, "load": 1230.0},
]
STARTS = {"small": 0.2, "large": 0.9}
TURNS = 20
"""Turns of the runs from which statements are judged."""


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


def behaviour(report: common.Report, quick: bool) -> tuple[Any, Any, Any, int]:
    """Whirl radius of the planar model from 0.5 Cpr, and the number of turns after which it is taken."""
    chi = np.geomspace(0.03, 110.0, 9 if quick else 24)
    froude = np.array([0.1, 0.2, 0.437, 0.8]) if quick else np.array([0.045, 0.1, 0.194, 0.3, 0.437, 0.8])
    radius = np.empty((froude.size, chi.size))
    turns = 20
    for i, value in enumerate(froude):
        motion = planar.simulate(chi, value, turns, 0.5)
        # bars that bend without loss flutter with friction at small creep: such a run says nothing
        sound = np.abs(motion.position).max(axis=0) < outcome.FLUTTER
        radius[i] = [outcome.outcome(motion, case).whirl if sound[case] else math.nan for case in range(chi.size)]
        for x, y in zip(chi, radius[i], strict=True):
            report.add(part="map", model="planar", chi=x, froude=value, eccentricity=0.5, whirl=y)
    return chi, froude, radius, turns


def draw(report: common.Report, path: Path, chi: Any, froude: Any, radius: Any, turns: int) -> None:
    """The map, with the paper's axial points: a mark for each rheology, a colour for each load."""
    plt = common.pyplot()
    figure, axes = plt.subplots(figsize=(9.0, 6.8), layout="constrained")
    filled = axes.contourf(chi, froude, radius, levels=np.linspace(0.0, 1.1, 12), cmap="viridis")
    figure.colorbar(filled, label="synchronous whirl radius of the cage / Cpr")
    rows = [row for row in report.results if row["part"] == "chi"]
    names = list(dict.fromkeys(row["rheology"] for row in rows))
    marks = dict(
        zip([name for name in names if "contact 70" not in name and "0.5" not in name], "osD^v<>PX*hd", strict=False)
    )
    for name, mark in marks.items():
        axes.plot([], [], mark, mfc="white", mec="black", ls="", label=name)
        for load, colour in ((1230.0, "white"), (3080.0, "orange"), (4930.0, "red")):
            part = [row for row in rows if row["rheology"] == name and row["axial_load"] == load]
            x, y = [row["chi"] for row in part], [row["froude"] for row in part]
            axes.plot(x, y, mark, mfc=colour, mec="black", ms=6, ls="")
    for load, colour in ((1230.0, "white"), (3080.0, "orange"), (4930.0, "red")):
        axes.plot([], [], "o", mfc=colour, mec="black", ls="", label=f"{load:g} N (colour)")
    axes.set(xscale="log", yscale="log", xlim=(0.03, 110.0), ylim=(0.045, 0.8))
    axes.set(xlabel="creep number χ (1)", ylabel="Froude number Fn (1)")
    axes.set_yticks([0.0485, 0.1, 0.194, 0.437, 0.8], ["0.049", "0.1", "0.194", "0.437", "0.8"])
    axes.minorticks_on()
    axes.yaxis.set_minor_formatter(plt.NullFormatter())
    limit = 2.0 * 12 / math.cos(math.radians(26.39))
    axes.axvline(limit, color="white", ls="--", label=f"stated yield limit {limit:.1f}")
    axes.set_title(
        f"Planar model, {turns} turns of the cage after a start at 0.5 Cpr (white: it flutters).\n"
        "Marks: the paper's axial points, Fn 0.049, 0.194, 0.437 at 1000, 2000, 3000 rpm",
        fontsize=10,
    )
    figure.legend(
        *axes.get_legend_handles_labels(), fontsize=8, loc="outside lower center", ncols=3, facecolor="lightgrey"
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)
    print(f"wrote {path.name}", flush=True)


def warm_contact(temperature_c: float) -> trb.Lubricant:
    """VG100 (Dicke) as it is at a temperature in the contacts, with the films of 60 C.

    The film alone takes the pressure coefficient, so that it is raised until the thinnest film at 3000 rpm, 4930 N is
    that of 60 C; rolling resistance takes it as well.
    """

    def thinnest(oil: trb.Lubricant) -> float:
        return float(creep(trb.cases.scene_30310(3000.0, 4930.0, lubricant=oil, effects=GAUSS)).film_parameter.min())

    wanted, oil = thinnest(trb.lubricants.vg100(60.0)), trb.lubricants.vg100(temperature_c)
    for _ in range(4):
        # the film grows with about the 0.5th power of the coefficient
        raised = oil.pressure_coefficient * (wanted / thinnest(oil)) ** 2
        # without validation, which asks for one pressure law in films and traction
        oil = trb.Lubricant.model_construct(**{**dict(oil), "oil": None, "pressure_coefficient": raised})
    return oil


def statements(report: common.Report, quick: bool) -> None:
    """The paper's statements with each rheology: complete model for four, planar model for the axial points of all."""
    oils = {
        "dicke, 60 C": (trb.lubricants.vg100(60.0), 1.0),
        "dicke, contact 80 C": (warm_contact(80.0), 1.0),
        "dicke, film x 0.3": (trb.lubricants.vg100(60.0), 0.3),
        "barus, 60 C": (trb.lubricants.vg100(60.0, pressure_law="barus"), 1.0),
    }
    for name, (oil, thin) in list(oils.items())[: 1 if quick else None]:
        for start, e in STARTS.items():
            found = {}
            for key in outcome.LOADS if quick else outcome.POINTS:
                speed, load, radial, scatter = key
                what = paper.Condition(speed, load, radial, scatter=scatter)
                built = paper.Point(what, "whirl").scene()
                built = built.replace(
                    lubricant=oil, effects=GAUSS.replace(starvation_factor=thin), start=trb.Start.whirl(e)
                )
                run = whirl.run(built, TURNS)
                found[key] = outcome.outcome(run.motion)
                numbers_of = creep(built)
                _point(report, "complete", name, key, e, numbers_of.chi, numbers_of.froude, found[key], cpu=run.cpu_s)
            _judged(report, "complete", name, start, found)
        show(report, "point")
    rows = [row for row in report.results if row["part"] == "chi"]
    names = list(dict.fromkeys(row["rheology"] for row in rows))
    for start, e in STARTS.items():
        ends: dict[str, dict[outcome.Key, outcome.Outcome]] = {name: {} for name in names}
        for speed in (1000.0, 2000.0, 3000.0):
            part = [
                row for row in rows if row["speed_rpm"] == speed and (row["axial_load"] == 3080.0 or speed == 3000.0)
            ]
            motion = planar.simulate(np.array([row["chi"] for row in part]), part[0]["froude"], TURNS, e)
            for case, row in enumerate(part):
                if np.abs(motion.position[:, case]).max() >= outcome.FLUTTER:
                    continue
                key, end = outcome.point(speed, row["axial_load"]), outcome.outcome(motion, case)
                ends[row["rheology"]][key] = end
                _point(report, "planar", row["rheology"], key, e, row["chi"], row["froude"], end)
        for name in names:
            _judged(report, "planar", name, start, ends[name])


def _point(
    report: common.Report,
    model: str,
    name: str,
    key: outcome.Key,
    e: float,
    chi: float,
    froude: float,
    end: outcome.Outcome,
    **more: Any,
) -> None:
    speed, load, radial, scatter = key
    place = {"speed_rpm": speed, "axial_load": load, "radial_load": radial, "scatter": scatter, "eccentricity": e}
    report.add(part="point", model=model, rheology=name, chi=chi, froude=froude, **place, **vars(end), **more)


def _judged(
    report: common.Report, model: str, name: str, start: str, found: dict[outcome.Key, outcome.Outcome]
) -> None:
    """Verdicts from one start, beside those from the other."""
    ratio = numbers(trb.cases.rig_30310())["play_ratio"]
    for statement, (holds, settled) in outcome.judge(found, ratio).items():
        verdict = ("yes" if holds else "no") + ("" if settled else "*")
        same = {"part": "statement", "model": model, "rheology": name, "statement": statement}
        rows = [row for row in report.results if all(row.get(k) == v for k, v in same.items())]
        (rows[0] if rows else report.add(**same))[start] = verdict


def matrix(report: common.Report, model: str) -> str:
    """Rheology against statement: verdicts from the small and the large orbit."""
    rows = [row for row in report.results if row["part"] == "statement" and row["model"] == model]
    lines: dict[str, dict[str, str]] = {}
    for row in rows:
        lines.setdefault(row["rheology"], {"rheology": row["rheology"]})[row["statement"]] = (
            f"{row.get('small', 'open')} / {row.get('large', 'open')}"
        )
    return common.table(list(lines.values()), list(dict.fromkeys(key for line in lines.values() for key in line)))


PARTS = {
    "chi": "rheology speed_rpm axial_load chi froude film_parameter",
    "growth": "bearing accuracy speed_rpm axial_load gravity eccentricity chi froude rate error law theory fit",
    "yielding": "speed_rpm axial_load gravity eccentricity chi froude chi_yield whirl rest",
    "direction": "bearing speed_rpm axial_load gravity radial_load direction_deg unevenness chi froude rate error law stated",
    "point": "model rheology speed_rpm axial_load radial_load scatter eccentricity chi whirl drift reach lasting varying rate",
}


def show(report: common.Report, part: str) -> None:
    """Print a part's table."""
    rows = [row for row in report.results if row["part"] == part]
    print(f"\n{part}\n{common.table(rows, PARTS[part].split())}", flush=True)


def main() -> None:
    """Run the benchmark."""
    parser = common.parser(__doc__)
    parser.add_argument(
        "--picture", type=Path, default=None, help="draw the map here; pictures/creep_map.png, with --quick nowhere"
    )
    options = parser.parse_args()
    report, quick = common.Report("creep_map", options, COLUMNS), options.quick
    rheologies(report, quick)
    show(report, "chi")
    picture = options.picture or (None if quick else common.PICTURES / "creep_map.png")
    found = behaviour(report, quick)
    if picture is not None and not options.no_picture:
        draw(report, picture, *found)
    for case in GROWTH[:3] if quick else GROWTH:
        for e in (0.4,) if quick else (0.2, 0.4):
            measure(report, "growth", case, 20, e)
    for case in [] if quick else [GROWTH[0], GROWTH[3]]:
        measure(report, "growth", case, 20, 0.4, "standard")
    rows = [row for row in report.results if row["part"] == "growth"]
    for name in ("law", "theory", "fit"):
        wrong = [(row[name] - row["rate"]) / row["chi"] for row in rows if name in row]
        report.summary[f"{name}_rms"] = float(np.sqrt(np.mean(np.square(wrong))))
    show(report, "growth")
    print(report.summary, flush=True)
    for case in DIRECTION[:2] if quick else DIRECTION:
        measure(report, "direction", case, 12, 0.3)
    show(report, "direction")
    for case in YIELD[::4] if quick else YIELD:
        measure(report, "yielding", case, 30, 0.9)
    for case in [] if quick else YIELD_SMALL:
        measure(report, "yielding", case, 30, 0.2)
    show(report, "yielding")
    statements(report, quick)
    show(report, "point")
    for model in ("complete", "planar"):
        print(
            f"\nstatements, {model} model: from {STARTS['small']} / from {STARTS['large']} Cpr\n{matrix(report, model)}"
        )
    report.finish()


if __name__ == "__main__":
    main()
