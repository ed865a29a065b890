"""Time at equal error: the front of points, and the fixed program."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def front() -> Any:
    import front

    return front


def test_cost_at_an_error_lies_on_the_front(front: Any) -> None:
    rows = [
        {"ms": 1.0, "error": 1e-2},
        {"ms": 2.0, "error": 1e-3},
        {"ms": 3.0, "error": 5e-3},
        {"ms": 8.0, "error": 1e-4},
    ]
    assert front.at_error(rows, 1e-3, "ms") == pytest.approx(2.0)
    assert front.at_error(rows, math.sqrt(1e-7), "ms") == pytest.approx(4.0)
    # looser than every point: the cheapest one; better than every point: unknown
    assert front.at_error(rows, 0.1, "ms") == pytest.approx(1.0)
    assert math.isnan(front.at_error(rows, 1e-5, "ms"))


def test_the_yardstick_is_a_time(front: Any, tmp_path: Path) -> None:
    ruler = front.yardstick(tmp_path)
    try:
        times = [float(ruler.ask("")) for _ in range(3)]
    finally:
        ruler.close()
    assert all(0.0 < one < 10.0 for one in times)


def test_the_yardstick_has_not_changed() -> None:
    """Ratios of different days stand on it."""
    import hashlib

    digest = hashlib.sha256((BENCHMARKS / "yardstick.c").read_bytes()).hexdigest()
    assert digest == "104d9577dd121d4003beaa5a6e304d1329812db02baac81c0e77ed50d5952525"


def test_states_of_the_unloaded_case_are_stored(front: Any) -> None:
    for name in front.CASES:
        case = front.states.load_case(name)
        assert len(case.states) == 5
        assert min(case.windows) >= case.definition.least_window - 1e-12
