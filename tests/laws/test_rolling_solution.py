"""Laws of rolling resistance beside a numerical solution of the line contact, which no fit enters (benchmarks/rolling)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trbdyn import laws
from trbdyn.results.notes import RANGES

SOLUTION = Path(__file__).resolve().parents[2] / "benchmarks" / "rolling" / "solution.py"
pytestmark = pytest.mark.skipif(not SOLUTION.is_file(), reason="the benchmarks are not part of a source distribution")

POINTS = [(2.8e-5, 1e-10, 4460.0), (1e-4, 1e-10, 3745.0), (2e-6, 1e-10, 4460.0)]
"""W, U and G: the loads of bearings, and a contact that hardly deforms."""


@pytest.fixture(scope="module")
def solved() -> dict[tuple[float, float, float], Any]:
    from rolling import solution

    return {point: solution.solve(*point, nodes=100) for point in POINTS}


@pytest.mark.parametrize("point", POINTS)
def test_the_solution_balances(
    solved: dict[tuple[float, float, float], Any], point: tuple[float, float, float]
) -> None:
    """The pressure carries the load, and its slope and its moment give the same force."""
    found = solved[point]
    assert np.trapezoid(found.pressure, found.x) == pytest.approx(0.5 * np.pi, rel=1e-9)
    assert found.moment == pytest.approx(found.force, rel=2e-3)
    assert found.pressure.min() == 0.0


def test_films_of_the_solution(solved: dict[tuple[float, float, float], Any]) -> None:
    """Pan and Hamrock's film for loaded contacts, Martin's for a stiff one."""
    for point in POINTS[:2]:
        assert solved[point].central == pytest.approx(laws.film_line_elastic(*point), rel=0.2)
    w, u, _ = POINTS[2]
    assert laws.film_line_rigid(w, u) == pytest.approx(solved[POINTS[2]].central, rel=0.3)


@pytest.mark.parametrize("point", POINTS)
def test_the_default_law(solved: dict[tuple[float, float, float], Any], point: tuple[float, float, float]) -> None:
    (low, high), (thin, thick) = RANGES["biboulet_houpert"]
    assert low < point[0] < high
    assert thin < point[2] < thick
    assert laws.rolling_biboulet_houpert(*point) / point[2] == pytest.approx(solved[point].force, rel=0.1)


def test_laws_that_agree_and_one_that_does_not(solved: dict[tuple[float, float, float], Any]) -> None:
    w, u, g = POINTS[0]
    assert laws.rolling_matsuyama(w, u, g) / g == pytest.approx(solved[POINTS[0]].force, rel=0.1)
    assert laws.rolling_line(w, u, g) / g < 0.6 * solved[POINTS[0]].force
