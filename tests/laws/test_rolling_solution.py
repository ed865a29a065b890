"""Laws of rolling resistance beside a numerical solution of the line contact, which no fit enters (line_contact_solution.py)."""

from __future__ import annotations

from typing import Any

import line_contact_solution as solution
import numpy as np
import pytest

from trbdyn import laws
from trbdyn.results.notes import RANGES

POINTS = [(2.8e-5, 1e-10, 4460.0), (1e-4, 1e-10, 3745.0), (2e-6, 1e-10, 4460.0)]
"""W, U and G: the loads of bearings, and a contact that hardly deforms."""


@pytest.fixture(scope="module")
def solved() -> dict[tuple[float, float, float], Any]:
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
def test_the_theory(solved: dict[tuple[float, float, float], Any], point: tuple[float, float, float]) -> None:
    (low, high), (thin, thick) = RANGES["biboulet_houpert"]
    assert low < point[0] < high
    assert thin < point[2] < thick
    assert laws.rolling_biboulet_houpert(*point) / point[2] == pytest.approx(solved[point].force, rel=0.1)


def test_laws_that_agree_and_one_that_does_not(solved: dict[tuple[float, float, float], Any]) -> None:
    w, u, g = POINTS[0]
    assert laws.rolling_matsuyama(w, u, g) / g == pytest.approx(solved[POINTS[0]].force, rel=0.1)
    assert laws.rolling_line(w, u, g) / g < 0.6 * solved[POINTS[0]].force


INLET = 0.3
"""Where the oil begins before the contact's centre, over Re: the gap is a twentieth of Re there. k stands for such an inlet; one
without end resists 0 to 15 % more."""


def of_inlet(found: Any, u: float) -> float:
    """Force of a solution whose oil begins there: what the rest of an endless inlet adds is taken off."""
    return float(found.force) - 12.0 * u / INLET


def starved(w: float, u: float, g: float, **how: Any) -> Any:
    for nodes in (120, 150, 134, 170, 201):
        try:
            return solution.solve(w, u, g, nodes, viscosity=0.03, **how)
        except solution.NoSolution:
            continue
    raise AssertionError(f"no solution at W {w:g}, U {u:g}, G {g:g}, {how}")


def test_the_default_law() -> None:
    w, u, g = 5e-5, 1.2e-10, 4460.0
    found = starved(w, u, g)
    assert laws.rolling_line_solution(w, u, g) / g == pytest.approx(of_inlet(found, u), rel=0.05)


def test_heat_and_supply_together() -> None:
    """A meniscus two half widths before the contact: the short inlet hardly heats. A plain product is a quarter too low."""
    w, u, g, loading = 5e-5, 1.2e-10, 4460.0, 1.5
    cold, warm = (starved(w, u, g, meniscus=2.0, heat=heat).force for heat in (0.0, loading))
    left = cold / of_inlet(starved(w, u, g), u)
    phi = laws.film_thermal_aihara(loading)
    assert laws.rolling_supplied(left, phi) * phi / left == pytest.approx(warm / cold, abs=0.03)
    assert phi < 0.8 * warm / cold


@pytest.mark.slow
@pytest.mark.parametrize("g", [3200.0, 4460.0])
def test_the_default_law_over_its_range(g: float) -> None:
    """200 to 330 nodes, the viscosity of Roelands: k holds within 8 % from W 2e-5 on, the law within 10 % below."""
    for w in (2e-6, 1e-5, 2e-5, 5e-5, 1e-4):
        for u in (1e-11, 1e-10, 2.5e-10, 5e-10):
            law = laws.rolling_line_solution(w, u, g) / g
            near = 0.08 if w >= 2e-5 else 0.1
            assert law == pytest.approx(of_inlet(starved(w, u, g), u), rel=near)


@pytest.mark.slow
def test_heat_and_supply_over_their_range() -> None:
    """Meniscus at 2 to 10 half widths, heat up to L 1.5: the law of both within 0.03, that of the supply within 0.06."""
    for w, u, g in ((5e-5, 1.2e-10, 4460.0), (3e-5, 3e-10, 4460.0), (1e-4, 5e-11, 3745.0)):
        full = starved(w, u, g)
        for place in (10.0, 5.0, 3.0, 2.0):
            cold = starved(w, u, g, meniscus=place).force
            left = cold / of_inlet(full, u)
            root = float(np.sqrt(place**2 - 1.0))
            height = full.smallest + 4.0 * w / np.pi * (place * root - np.log(place + root))
            if height > 2.0 * full.smallest:
                assert laws.rolling_meniscus(height / full.smallest) == pytest.approx(left, abs=0.06)
            for loading in (0.5, 1.5):
                warm = starved(w, u, g, meniscus=place, heat=loading).force
                phi = laws.film_thermal_aihara(loading)
                assert laws.rolling_supplied(left, phi) * phi / left == pytest.approx(warm / cold, abs=0.03)
