"""Film of a cylinder near a plane: against Reynolds' equation solved on a grid, and its limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import solve_banded

from trbdyn import laws

APPROACHES = [-30.0, -6.0, -1.5, -0.4, 0.0, 0.3, 1.0, 3.0, 12.0]


def on_a_grid(approach: float) -> tuple[float, float, float]:
    """Load, loss and shear of -(h^3 P')' = s - 2 xi, P >= 0, h = 1 + xi^2: linear in the film, whose end is found by halving."""
    xi = np.sinh(np.linspace(math.asinh(-1e5), math.asinh(400.0), 12001))
    step, middle = np.diff(xi), 0.5 * (xi[1:] + xi[:-1])
    width, cube = 0.5 * (step[1:] + step[:-1]), (1.0 + middle**2) ** 3
    flow = cube / step
    right = (approach - 2.0 * xi[1:-1]) * width
    low, high = 1, len(right)
    while high - low > 1:  # the film ends where a longer one would pull
        last = (low + high) // 2
        bands = np.zeros((3, last))
        bands[0, 1:], bands[1], bands[2, :-1] = -flow[1:last], (flow[:-1] + flow[1:])[:last], -flow[1:last]
        found = solve_banded((1, 1), bands, right[:last])
        low, high = (low, last) if (found < 0.0).any() else (last, high)
        if low == last:
            pressure = np.concatenate([found, np.zeros(len(right) - last)])
    slope = np.diff(np.concatenate([[0.0], pressure, [0.0]])) / step
    return float(pressure @ width), float(np.sum(cube * slope**2 * step)), math.atan(xi[low + 1]) + 0.5 * math.pi


@pytest.mark.parametrize("approach", APPROACHES)
def test_the_law_solves_reynolds_equation(approach: float) -> None:
    load, loss, shear = on_a_grid(approach)
    assert laws.squeeze_load(approach) == pytest.approx(load, rel=4e-3)
    assert laws.squeeze_loss(approach) == pytest.approx(loss, rel=4e-3)
    assert laws.squeeze_shear(approach) == pytest.approx(shear, rel=1e-2)


def test_limits() -> None:
    """Martin's load of a film that is only drawn in; the whole film of a cylinder that falls; nothing where it is pulled away."""
    assert 24.0 * laws.squeeze_load(0.0) == pytest.approx(4.896, rel=2e-3)
    assert laws.squeeze_load(1e4) == pytest.approx(math.pi / 8.0 * 1e4, rel=1e-4)
    assert laws.squeeze_load(-1e4) == pytest.approx(16.0 / 81.0 * 1e-8, rel=5e-3)
    assert laws.squeeze_loss(-1e4) == pytest.approx(32.0 / 81.0 * 1e-4, rel=5e-3)


def test_load_is_half_of_the_slope_of_the_loss() -> None:
    """The film has the least of a quadratic form under the pressures that do not pull; also beyond the closed forms."""
    approach = np.concatenate([-np.geomspace(300.0, 0.1, 200), np.geomspace(0.1, 300.0, 200)])
    step = 1e-4 * np.abs(approach)
    slope = (laws.squeeze_loss(approach + step) - laws.squeeze_loss(approach - step)) / (2.0 * step)
    np.testing.assert_allclose(0.5 * slope, laws.squeeze_load(approach), rtol=6e-3)
    assert (np.diff(laws.squeeze_load(approach)) > 0.0).all()
    assert (laws.squeeze_loss(approach) > 0.0).all()
