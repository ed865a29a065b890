"""The blind table: SKF's formula and replenishment against second implementations, the command, and the page that shows it."""

from __future__ import annotations

import json
import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import trbdyn as trb

ROOT = Path(__file__).resolve().parents[2]
BENCHMARKS = ROOT / "benchmarks"
pytestmark = pytest.mark.skipif(not BENCHMARKS.is_dir(), reason="the benchmarks are not part of a source distribution")


@pytest.fixture(scope="module")
def kept() -> dict[str, Any]:
    found: dict[str, Any] = json.loads((BENCHMARKS / "validation" / "validation.json").read_text(encoding="utf-8"))
    return found


@pytest.mark.parametrize(("speed", "radial"), [(500.0, 0.0), (4000.0, 6500.0), (20.0, 0.0)])
def test_skf_against_a_second_implementation(speed: float, radial: float) -> None:
    from validation import skf

    page = {"series": "322", "bore": 0.08, "outside": 0.14, "Y": 1.4}
    found = skf.torque(**page, speed_rpm=speed, axial_load=6000.0, radial_load=radial, viscosity=60.0)  # type: ignore[arg-type]
    m = mpmath
    with m.workdps(30):
        n, nu, dm = m.mpf(speed), m.mpf(60), m.mpf(110)
        ish = 1 / (1 + m.mpf("1.84e-9") * m.power(n * dm, m.mpf("1.28")) * m.power(nu, m.mpf("0.64")))
        rs = m.exp(-m.mpf("3e-8") * nu * n * 220 * m.sqrt(m.mpf(6) / 120))
        grr = (
            m.mpf("2.27e-6")
            * m.power(dm, m.mpf("2.38"))
            * m.power(radial + m.mpf("10.9") * m.mpf("1.4") * 6000, m.mpf("0.31"))
        )
        gsl = m.mpf("0.018") * m.power(dm, m.mpf("0.82")) * (radial + 2 * m.mpf("1.4") * 6000)
        bl = m.exp(-m.mpf("2.6e-8") * m.power(n * nu, m.mpf("1.4")) * dm)
        expected = ish * rs * grr * m.power(nu * n, m.mpf("0.6")) + gsl * (
            bl * m.mpf("0.15") + (1 - bl) * m.mpf("0.002")
        )
    assert found == pytest.approx(float(expected) / 1000.0, rel=1e-12)


def test_replenishment() -> None:
    """-30 % at 4000 rpm and -16 % at 2000 rpm for the 32216 in a low bath, as published; none at standstill."""
    oil = trb.lubricants.vg100(50.0)
    bearing = trb.cases.bearing_32216()
    size = {"pitch_diameter": bearing.pitch_diameter, "roller_diameter": bearing.roller.diameter}
    decline = trb.lubricants.replenishment_decline(oil, 3e-8, **size)
    for speed, kept in ((4000.0, 0.70), (2000.0, 0.84)):
        assert math.exp(-decline * speed * math.pi / 30.0) == pytest.approx(kept, abs=0.02)
    assert trb.lubricants.replenishment_decline(oil, 0.0, **size) == 0.0


def test_measurements_are_those_of_the_package() -> None:
    from validation.measured import MEASUREMENTS, SOURCES

    torques = {
        (p.speed_rpm, p.radial_load): p.value
        for p in MEASUREMENTS
        if (p.quantity, p.bearing, p.held_back) == ("torque", "32216", False)
    }
    axial = {(speed, 0.0): value for speed, value in trb.cases.MEASURED_TORQUE_32216.items()}
    combined = {(speed, 6500.0): value for speed, value in trb.cases.MEASURED_TORQUE_32216_COMBINED.items()}
    assert torques == axial | combined
    assert {point.source for point in MEASUREMENTS} <= {source.key for source in SOURCES}


def test_points_that_were_held_back(kept: dict[str, Any]) -> None:
    """A 32216 at 42 C in place of 50 C, and two HM801349 with a seal of 0.1 N m: half of the rest is that of one bearing."""
    held = [row for row in kept["results"] if row["is_held_back"]]
    by_name = {name: [row for row in held if row["bearing"] == name] for name in ("32216", "HM801349")}
    assert [len(rows) for rows in by_name.values()] == [5, 4]
    assert {row["temperature_c"] for row in by_name["32216"]} == {42.0}
    measured = [row["measured"] for row in by_name["HM801349"]]
    assert measured == pytest.approx([0.625, 0.75, 0.425, 0.775])
    summary = kept["summary"]
    assert summary["held_back"] == pytest.approx({name: weighted(rows) for name, rows in by_name.items()})
    assert summary["held_back"]["32216"] < 15.0
    assert summary["held_back"]["HM801349"] < 48.0


def weighted(rows: list[dict[str, Any]], key: str = "predicted") -> float:
    """Mean over bearings of the mean size of the error of each (%)."""
    names = sorted({row["bearing"] for row in rows})
    return float(
        np.mean(
            [
                np.mean([100.0 * abs(row[key] / row["measured"] - 1.0) for row in rows if row["bearing"] == name])
                for name in names
            ]
        )
    )


def test_the_summary_follows_from_the_rows(kept: dict[str, Any]) -> None:
    rows, summary = kept["results"], kept["summary"]
    assert not kept["quick"]
    every = [row for row in rows if row["quantity"] in ("torque", "rolling_torque")]
    torques = [row for row in every if not row["is_held_back"]]
    inside = [
        row["low"] - row["reading_error"] <= row["measured"] <= row["high"] + row["reading_error"] for row in rows
    ]
    assert inside == [row["is_inside"] for row in rows]
    fast = [row for row in torques if row["speed_rpm"] >= 1000.0]
    errors = [100.0 * (row["predicted"] / row["measured"] - 1.0) for row in fast]
    assert summary["inside"] == pytest.approx(np.mean(inside))
    assert summary["mean_error"] == pytest.approx(weighted(fast))
    assert summary["mean_error_slow"] == pytest.approx(weighted([r for r in torques if r["speed_rpm"] < 1000.0]))
    assert summary["max_error"] == pytest.approx(np.max(np.abs(errors)))
    halves = [50.0 * (row["high"] - row["low"]) / row["predicted"] for row in every]
    assert summary["median_band"] == pytest.approx(np.median(halves))
    assert (summary["bearings"], summary["torques"]) == (len({row["bearing"] for row in fast}), len(fast))
    record = json.loads((ROOT / "trbdyn" / "data" / "torque_record.json").read_text(encoding="utf-8"))
    assert {name: record[name] for name in ("no_drag", "drag_of_the_state")} == summary["record"]
    assert record["no_drag"]["mean_error"] == pytest.approx(weighted(fast, "no_drag"))


def test_the_error_that_is_quoted_leaves_each_bearing_out(kept: dict[str, Any]) -> None:
    """By brute force: the supply of a bath that the other bearings give, from a straight line between two supplies."""
    chosen = [row for row in kept["results"] if "by_supply" in row and not row["is_held_back"]]
    fast = [row for row in chosen if row["speed_rpm"] >= 1000.0]

    def at(row: dict[str, Any], supply: float) -> float:
        low, high = row["by_supply"]
        return float(low + (high - low) * (supply - 0.7) / 0.3) if row["supply"] == "bath" else float(row["predicted"])

    errors = []
    for name in sorted({row["bearing"] for row in fast}):
        others = [row for row in fast if row["bearing"] != name]
        tried = np.linspace(0.5, 1.2, 141)
        best = min(
            tried,
            key=lambda c: weighted([{**row, "predicted": at(row, c)} for row in others if row["supply"] == "bath"]),
        )
        errors.append(weighted([{**row, "predicted": at(row, best)} for row in fast if row["bearing"] == name]))
    assert kept["summary"]["left_out_error"] == pytest.approx(np.mean(errors), rel=1e-6)


def test_users_and_validation_have_one_list_of_open_inputs() -> None:
    from validation.assumptions import DEFAULT, OPTIONS, bands_of, own_bands, scene_of
    from validation.measured import MEASUREMENTS

    from trbdyn.extras.study import open_inputs

    for point in MEASUREMENTS:
        scene = scene_of(point, OPTIONS[DEFAULT])
        own, users = own_bands(point, scene), open_inputs(scene)
        given = {band.path for band in own}
        assert list(bands_of(point, scene)) == [*(band for band in users if band.path not in given), *own]
        paths = {band.path for band in users}
        wanted = {"lubricant.temperature_c", "effects.supply", "effects.friction.rib_boundary_limit"}
        assert wanted | {"effects.oil_fill"} <= paths
        assert ("bearing.roller.profile.a_p" in paths) == (point.bearing != "32216")  # the source gives that one
        t = scene.lubricant.temperature_c
        band = next(band for band in users if band.path == "lubricant.temperature_c")
        assert (band.low, band.high) == (t - 3.0, t + 10.0)


def test_a_measured_error_is_told_of_effects_that_were_measured_alone() -> None:
    from trbdyn.run.torque_laws import record, record_words

    standard = trb.Effects()
    assert f"{record()['no_drag']['left_out_error']:.0f} %" in record_words(standard)
    state = record_words(standard.replace(oil_fill="bath"))
    assert f"{record()['drag_of_the_state']['left_out_error']:.0f} %" in state
    for changes in (
        {"oil_fill": 0.2},
        {"supply": 0.9},
        {"friction.rib_boundary_limit": 0.1},
        {"rolling_law": "aihara"},
    ):
        assert record_words(standard.replace(changes)) == ""


def test_the_default_is_judged_by_formulas_of_makers(kept: dict[str, Any]) -> None:
    """Kept ratios follow from the formulas of today; starting torque of a 32208 under 2 kN by hand: 1.18 mm x 0.2 x 2 kN."""
    from validation import makers

    summary = kept["summary"]
    assert set(summary["formulas"]) == {"aihara", "skf", "palmgren"}
    assert all(one["low"] < one["median"] < one["high"] for one in summary["formulas"].values())
    fast = [row for row in kept["results"] if "skf" in row and row["speed_rpm"] >= 1000.0]
    for name, by in (("skf", lambda row: row["skf"]), ("aihara", lambda row: row["options"]["aihara, full supply"])):
        assert summary["formulas"][name]["measured"] == pytest.approx(np.median([r["measured"] / by(r) for r in fast]))
    scene = trb.Scene(
        trb.Bearing.named("32208"), speed_rpm=1.0, axial_load=2000.0, lubricant=trb.lubricants.iso_vg(100, 40.0)
    )
    own, maker = makers.starting_torque(scene)
    assert maker == pytest.approx(0.473, rel=0.01)
    assert own == pytest.approx(maker, rel=0.3)
    scene = scene.replace(speed_rpm=1000.0, axial_load=7770.0, lubricant=trb.lubricants.iso_vg(100, 50.0))
    same = scene.replace({"effects.rolling_law": "aihara", "effects.supply": 1.0})
    rib = trb.Simulation(same).contacts()
    speed = 1000.0 * math.pi / 30.0
    raceways = float(np.sum(rib["power"]) - np.sum(rib["rib_friction"] * rib["rib_sliding_speed"])) / speed
    assert raceways == pytest.approx(makers.aihara(scene), rel=0.03)


def test_the_page_shows_these_rows(kept: dict[str, Any]) -> None:
    page = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
    part = page.split("<!-- validation -->")[1].split("<!-- /validation -->")[0]
    head, _, *lines = [line for line in part.split("\n\n")[0].splitlines() if line.startswith("| ")]
    names = [cell.strip() for cell in head.strip("|").split("|")]
    assert len(lines) == len(kept["results"])
    for line, row in zip(lines, kept["results"], strict=True):
        cells = dict(zip(names, (cell.strip() for cell in line.strip("|").split("|")), strict=True))
        assert float(cells["measured"]) == pytest.approx(row["measured"], abs=0.06)
        assert float(cells["predicted"]) == pytest.approx(
            row["predicted"], abs=0.06 if row["quantity"] == "torque_change" else 0.006
        )
        assert cells["inside"] == ("yes" if row["is_inside"] else "no")
        assert cells["held back"] == ("yes" if row["is_held_back"] else "")
    assert re.search(rf"`inside` {kept['summary']['inside']:.3g}", part)


@pytest.mark.slow
def test_the_command(tmp_path: Path, kept: dict[str, Any]) -> None:
    """Its predictions are those that were kept, with fewer draws."""
    path = tmp_path / "found.json"
    command = [sys.executable, str(BENCHMARKS / "validation"), "--quick", "--json", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=500, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(path.read_text(encoding="utf-8"))
    assert {"inside", "mean_error", "left_out_error", "median_band"} <= set(found["summary"])
    parts = ("bearing", "quantity", "speed_rpm", "axial_load", "radial_load", "temperature_c")
    before = {tuple(row[part] for part in parts): row for row in kept["results"]}
    for row in found["results"]:
        there = before[tuple(row[part] for part in parts)]
        assert row["predicted"] == pytest.approx(there["predicted"], rel=0.01)
