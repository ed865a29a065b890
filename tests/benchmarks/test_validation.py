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
        (p.speed_rpm, p.radial_load): p.value for p in MEASUREMENTS if p.quantity == "torque" and p.bearing == "32216"
    }
    axial = {(speed, 0.0): value for speed, value in trb.cases.MEASURED_TORQUE_32216.items()}
    combined = {(speed, 6500.0): value for speed, value in trb.cases.MEASURED_TORQUE_32216_COMBINED.items()}
    assert torques == axial | combined
    assert {point.source for point in MEASUREMENTS} <= {source.key for source in SOURCES}


def test_the_summary_follows_from_the_rows(kept: dict[str, Any]) -> None:
    rows, summary = kept["results"], kept["summary"]
    assert not kept["quick"]
    torques = [row for row in rows if row["quantity"] in ("torque", "rolling_torque")]
    inside = [
        row["low"] - row["reading_error"] <= row["measured"] <= row["high"] + row["reading_error"] for row in rows
    ]
    assert inside == [row["is_inside"] for row in rows]
    errors = [100.0 * (row["predicted"] / row["measured"] - 1.0) for row in torques if row["speed_rpm"] >= 1000.0]
    assert summary["inside"] == pytest.approx(np.mean(inside))
    assert summary["mean_error"] == pytest.approx(np.mean(np.abs(errors)))
    assert summary["max_error"] == pytest.approx(np.max(np.abs(errors)))
    halves = [50.0 * (row["high"] - row["low"]) / row["predicted"] for row in torques]
    assert summary["median_band"] == pytest.approx(np.median(halves))
    best = min(summary["by_option"], key=lambda name: summary["by_option"][name]["mean_error"])
    assert summary["best"] == best
    assert summary["bearings"] >= 4


def test_the_page_shows_these_rows(kept: dict[str, Any]) -> None:
    page = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
    part = page.split("<!-- validation -->")[1].split("<!-- /validation -->")[0]
    lines = [line for line in part.split("\n\n")[0].splitlines()[2:] if line.startswith("| ")]
    lines = [line for line in lines if not line.startswith(("| bearing", "| ---"))]
    assert len(lines) == len(kept["results"])
    for line, row in zip(lines, kept["results"], strict=True):
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        assert float(cells[4]) == pytest.approx(row["measured"], abs=0.06)
        assert float(cells[5]) == pytest.approx(
            row["predicted"], abs=0.06 if row["quantity"] == "torque_change" else 0.006
        )
        assert cells[7] == ("yes" if row["is_inside"] else "no")
    assert re.search(rf"`inside` {kept['summary']['inside']:.3g}", part)


@pytest.mark.slow
def test_the_command(tmp_path: Path, kept: dict[str, Any]) -> None:
    """Its predictions are those that were kept, with fewer draws."""
    path = tmp_path / "found.json"
    command = [sys.executable, str(BENCHMARKS / "validation"), "--quick", "--json", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=500, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(path.read_text(encoding="utf-8"))
    assert {"inside", "mean_error", "max_error", "median_band"} <= set(found["summary"])
    before = {(row["quantity"], row["speed_rpm"], row["radial_load"]): row for row in kept["results"]}
    for row in found["results"]:
        there = before[row["quantity"], row["speed_rpm"], row["radial_load"]]
        assert row["predicted"] == pytest.approx(there["predicted"], rel=0.01)
