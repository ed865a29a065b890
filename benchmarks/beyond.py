"""The mechanism behind the paper's figures, and what goes beyond them: whirl against rotation, classes of motion with spectra,
direction of the cage's lean, slip budget of the rollers, their skew and tilt, and torque against measurements.

Reads the points of a campaign (``python benchmarks/paper -o FOLDER``, then ``--runs FOLDER``); without one it runs two
short points. Pictures go to ``-o FOLDER`` as ``beyond_<name>.png``.
"""

from __future__ import annotations

import json
import time as clock
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import common
import numpy as np
from mechanism import motions, pictures, reach, slip, torque
from paper.files import read_about
from paper.points import Condition, Point

import trbdyn as trb
from trbdyn.results.result import Result

COLUMNS = {
    "part": "1: motion, slip, torque or reach",
    "point": "1: speed, axial load, radial load, start",
    "settled": "1: whether the campaign found the point settled",
    "kind": "1: class of the cage's motion",
    "cage_hz": "Hz: rotation of the cage",
    "whirl_hz": "Hz: mean rate of the angle of the centre about its mean place; positive with the shaft",
    "peak_hz": "Hz: peak of the two-sided spectrum of the centre",
    "whirl_ratio": "1: whirl_hz over cage_hz",
    "orbit_over_cpr": "1: rms distance from the mean place over Cpr",
    "centre_over_cpr": "1: distance of the mean place from the axis over Cpr",
    "coherence": "1: 1 for a round forward orbit, -1 backward, 0 without sense",
    "speed_deviation": "1: standard deviation over mean of the centre's speed",
    "synchronous_share": "1: share of the motion about the mean place that turns with the cage",
    "lean_deg": "deg: direction of the cage's lean, from that of its displacement",
    "lean_coherence": "1: 1 for a fixed direction",
    "lean_moving_deg": "deg: the same of both without their means",
    "lean_moving_coherence": "1: the same of both without their means",
    "skew_rms_mrad": "mrad: rms skew of the rollers",
    "tilt_rms_mrad": "mrad: rms tilt of the rollers",
    "side": "1: raceway",
    "quantity": "1: rolling, friction along the orbit, coefficient, slide_roll, orbit (speed over mean less 1), orbit_by_slip",
    "exponent": "1: power of the load that fits the size of the quantity",
    "light": "unit of the quantity: mean over the tenth with the smallest load",
    "heavy": "unit of the quantity: mean over the tenth with the largest load",
    "load_light": "N: largest load of the lightest tenth",
    "load_heavy": "N: smallest load of the heaviest tenth",
    "speed_rpm": "1/min: shaft speed",
    "pressure_force": "1: with the pressure force of the rolling film on the roller",
    "inner_torque": "N m: mean friction torque on the inner ring",
    "outer_torque": "N m: mean friction torque on the outer ring",
    "drift": "N m: second less first half of the time that counts",
    "shares": "N m: inner torque by source",
    "measured": "N m: measured torque",
    "eccentricity": "1: place of the cage (Cpr) around which the rollers stand in the middle of their pockets; 0: equal spacing",
    "direction_deg": "deg: direction of the push",
    "reach": "1: distance of the cage's centre from the axis along the push in a run, over Cpr",
    "shake": "1: its standard deviation",
    "geometry": "1: the same by geometry with the rollers as they started",
    "free": "1: the same by geometry with rollers that give way",
    "roller_drift": "1: largest change of a roller's place against the mean in the run, over Cpr",
    "cpu": "s: processor time",
    "kinds": "1: number of points by class",
    "torque_error": "1: inner torque over the measured one, less one, without and with the pressure force, by speed",
}
MOTION = (
    "point",
    "settled",
    "kind",
    "cage_hz",
    "whirl_ratio",
    "peak_hz",
    "orbit_over_cpr",
    "centre_over_cpr",
    "coherence",
)
MORE = ("speed_deviation", "synchronous_share", "lean_deg", "lean_coherence", "skew_rms_mrad", "tilt_rms_mrad")
SLIP = ("side", "quantity", "exponent", "light", "heavy")
TORQUE = ("speed_rpm", "pressure_force", "inner_torque", "outer_torque", "drift", "measured", "cpu")

REACH = ("eccentricity", "direction_deg", "reach", "shake", "geometry", "free", "roller_drift", "cpu")
PUSHES = (
    (0.0, 0.0),
    (0.0, 15.0),
    (0.0, -90.0),
    *((e, way) for e in (0.15, 0.3, 0.45, 0.6, 0.75, 0.9) for way in (-90.0, 15.0)),
)
"""Eccentricity and direction of each push."""

AXIAL = Condition(3000.0, 4930.0)
COMBINED = Condition(2000.0, 4930.0, 5530.0)
SHORT = 0.1
"""Bearing time of a point that is run here (s); the second half counts."""

SPECTRA = (
    "1000rpm_1230N_whirl",
    "3000rpm_1230N_whirl",
    "3000rpm_1230N_scatter_whirl0",
    "2000rpm_3080N_equal",
    "2000rpm_3080N_whirl",
    "3000rpm_4930N_whirl",
    "3000rpm_4930N_equal",
    "2000rpm_4930N_2780N_whirl",
    "2000rpm_4930N_8380N_whirl",
)
LEANS = ("1000rpm_1230N_whirl", "3000rpm_4930N_equal", "3000rpm_4930N_unequal0", "3000rpm_4930N_whirl")
ATTITUDES = ("3000rpm_4930N_whirl", "2000rpm_4930N_5530N_unequal0", "2000rpm_4930N_8380N_unequal0")
BUDGET = "2000rpm_4930N_5530N_unequal0"


def short_runs() -> dict[str, tuple[Result, bool]]:
    """Two points, run for a short time: not settled."""
    found = {}
    for point in (Point(AXIAL, "whirl"), Point(COMBINED, "unequal")):
        result = trb.Simulation(point.scene(), accuracy="fast").run(duration=SHORT, save_every=2e-4)
        found[point.name] = (result.window(0.5 * SHORT), False)
    return found


def campaign(folder: Path) -> dict[str, tuple[Result, bool]]:
    """Every point of a campaign by name, and whether it had settled.

    Raises
    ------
    SystemExit
        If there is none.
    """
    found = {}
    for path in sorted((folder / "points").glob("*.h5")):
        about = read_about(path)
        if about is not None:
            found[path.stem] = (trb.load(path), bool(about["settled"]))
    if not found:
        raise SystemExit(f"{folder / 'points'}: no points of a campaign")
    return found


def chosen(results: Mapping[str, Result], names: Iterable[str]) -> dict[str, Result]:
    """Those of the names that are there; all if none is."""
    return {name: results[name] for name in names if name in results} or dict(results)


def slip_rows(report: common.Report, name: str, result: Result) -> tuple[slip.Budget, dict[str, float]]:
    """Slip budget over one turn of the cage."""
    found, exponents = slip.budget(result), {}
    for index, side in enumerate(slip.SIDES):
        load = found.load[:, index]
        low, high = np.quantile(load, (0.1, 0.9))
        values = {key: getattr(found, key)[:, index] for key in ("rolling", "friction", "coefficient", "slide_roll")}
        if side == "outer":
            values |= {"orbit": found.orbit, "orbit_by_slip": found.orbit_by_slip}
        for quantity, array in values.items():
            light, heavy = slip.ends(load, array)
            # a power of the load means nothing for deviations from a mean
            power = float("nan") if quantity.startswith("orbit") else slip.exponent(load, np.abs(array))
            exponents[f"{quantity}_{side}"] = power
            report.add(
                part="slip",
                point=name,
                side=side,
                quantity=quantity,
                exponent=power,
                light=light,
                heavy=heavy,
                load_light=low,
                load_heavy=high,
            )
    return found, exponents


def torque_rows(report: common.Report, quick: bool) -> list[dict[str, Any]]:
    """The 32216 at the speeds of the measurements."""
    measured = trb.cases.MEASURED_TORQUE_32216
    rows, errors = [], {}
    for force in (False, True):
        for speed in list(measured)[: 1 if quick else None]:
            found = torque.run(speed, force, 1.0 if quick else torque.TURNS)
            rows.append(report.add(part="torque", measured=measured[speed], **found))
            errors[f"{speed:g} rpm, {'with' if force else 'without'}"] = found["inner_torque"] / measured[speed] - 1.0
    report.summary["torque_error"] = errors
    return rows


def main() -> dict[str, Any]:
    """Run everything; print tables; draw."""
    parser = common.parser(__doc__)
    parser.add_argument("--runs", type=Path, metavar="FOLDER", default=None, help="folder of a campaign")
    parser.add_argument("-o", dest="folder", type=Path, default=common.PICTURES, help="folder of the pictures")
    options = parser.parse_args()
    report = common.Report("beyond", options, COLUMNS)
    began = clock.process_time()
    runs = short_runs() if options.runs is None else campaign(options.runs)
    results = {name: result for name, (result, _) in runs.items()}
    report.inputs = {"points": len(results), "short_runs": options.runs is None}

    rows = [
        report.add(part="motion", point=name, settled=settled, **motions.row(result))
        for name, (result, settled) in runs.items()
    ]
    print(common.table(rows, MOTION, 2), common.table(rows, ("point", *MORE), 2), sep="\n\n")
    report.summary["kinds"] = {kind: sum(row["kind"] == kind for row in rows) for kind in pictures.KINDS}
    name = BUDGET if BUDGET in results else next(reversed(results))
    budget, exponents = slip_rows(report, name, results[name])
    print(common.table([row for row in report.results if row["part"] == "slip"], SLIP))
    torques = torque_rows(report, options.quick)
    print(common.table(torques, TORQUE))
    pushed = [report.add(part="reach", **reach.run(*push)) for push in PUSHES[: 1 if options.quick else None]]
    print(common.table(pushed, REACH))
    report.summary["cpu"] = clock.process_time() - began
    print(json.dumps(common.plain(report.summary)))

    if not options.no_picture:
        figures = {
            "frequencies": pictures.frequencies(rows),
            "spectra": pictures.spectra(chosen(results, SPECTRA)),
            "lean": pictures.leans(chosen(results, LEANS)),
            "attitude": pictures.attitudes(chosen(results, ATTITUDES)),
            "slip": pictures.slips(budget, exponents, pictures.short(name)),
            "torque": pictures.torques(torques, trb.cases.MEASURED_TORQUE_32216, torque.AXIAL_LOAD),
            "reach": pictures.reaches(pushed),
        }
        options.folder.mkdir(parents=True, exist_ok=True)
        for title, figure in figures.items():
            figure.savefig(options.folder / f"beyond_{title}.png", dpi=90 if title == "spectra" else 100)
    return report.finish()


if __name__ == "__main__":
    main()
