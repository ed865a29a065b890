"""benchmarks/skew.py: the skew by rib friction beside the balance of a roller alone."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from skew import measured, scene_of


def test_skew_follows_from_the_rib_alone() -> None:
    """Friction, arm and curvature of the end decide; not the load."""
    rows = [
        measured(scene_of(ratio, 0.2, (32, 80.0), 200.0, load), 4.0) for ratio, load in ((0.9, 5000.0), (0.7, 1000.0))
    ]
    for row in rows:
        assert row["film_parameter"] < 0.3
        assert row["rib_friction"] == pytest.approx(0.127, abs=0.01)
        assert row["skew"] == pytest.approx(row["balance"], rel=0.15)
    assert rows[1]["skew"] > 3.0 * rows[0]["skew"]
