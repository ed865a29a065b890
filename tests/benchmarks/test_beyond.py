"""benchmarks/beyond.py end to end on two short runs."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def output(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], Path]:
    """Its JSON file and its folder of pictures."""
    folder = tmp_path_factory.mktemp("beyond")
    script = BENCHMARKS / "beyond.py"
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONSAFEPATH"}
    command = [sys.executable, str(script), "--quick", "--json", str(folder / "beyond.json"), "-o", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads((folder / "beyond.json").read_text()), folder


def test_pictures_are_drawn(output: tuple[dict[str, Any], Path]) -> None:
    names = {path.stem for path in output[1].glob("beyond_*.png")}
    assert {
        f"beyond_{name}" for name in ("frequencies", "spectra", "lean", "attitude", "slip", "torque", "reach")
    } <= names


def test_every_entry_is_described(output: tuple[dict[str, Any], Path]) -> None:
    for row in [*output[0]["results"], output[0]["summary"]]:
        assert set(row) <= set(output[0]["columns"])


def test_sliding_friction_balances_rolling_resistance(output: tuple[dict[str, Any], Path]) -> None:
    """The balance of a free roller; the bars may add to it where they touch."""
    rows = {(row["side"], row["quantity"]): row for row in output[0]["results"] if row["part"] == "slip"}
    for side, sense in (("outer", -1.0), ("inner", 1.0)):
        assert rows[side, "friction"]["light"] == pytest.approx(sense * rows[side, "rolling"]["light"], rel=0.1)
        assert rows[side, "coefficient"]["light"] > rows[side, "coefficient"]["heavy"]


def test_torque_is_near_the_measured_one(output: tuple[dict[str, Any], Path]) -> None:
    for row in (row for row in output[0]["results"] if row["part"] == "torque"):
        assert math.isclose(row["inner_torque"], row["measured"], rel_tol=0.25)


def test_uneven_rollers_let_the_cage_move_farther_as_geometry_says(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from mechanism import reach

    equal, uneven = reach.run(0.0, 15.0), reach.run(0.6, 15.0)
    for found in (equal, uneven):
        assert found["reach"] == pytest.approx(found["geometry"], abs=0.04)
        assert found["roller_drift"] < 0.05
    assert uneven["reach"] > 1.5 * equal["reach"]


def test_phasor_of_a_known_lean(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from mechanism import motions

    turn = np.linspace(0.0, 20.0 * np.pi, 2001)
    place = 0.7 * np.exp(1j * turn)
    found = motions.phasor(place, 2e-4 * place * np.exp(0.5j))
    assert found.phase_deg == pytest.approx(math.degrees(0.5))
    assert found.coherence == pytest.approx(1.0)
    assert motions.turning(place, turn) == pytest.approx(1.0, abs=1e-3)
    assert motions.turning(np.conj(place), turn) == pytest.approx(0.0, abs=1e-3)
