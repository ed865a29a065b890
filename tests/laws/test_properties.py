"""What holds for any numbers: laws are finite, have the right sign, and rise or fall as they must."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trbdyn import laws

DICKE = (327.79, 2.9862, 4.419e-3, 3.0115e-4)
BOUNDARY = (0.1, 22.28, 181.46)
STEP = 1.01
examples = settings(max_examples=200, deadline=None, derandomize=True)


def powers(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers spread over the decades from low to high."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


loads = powers(1e-9, 1e-2)
speeds = powers(1e-16, 1e-6)
materials = powers(1.0, 1e6)
ratios = powers(1e-3, 1e3)


@examples
@given(loads, speeds, materials)
def test_line_film(w: float, u: float, g: float) -> None:
    film = laws.film_line_elastic(w, u, g)
    assert math.isfinite(film)
    assert film > 0
    assert film == pytest.approx(2.922 * w**-0.166 * u**0.692 * g**0.470, rel=1e-12)
    assert laws.film_line_elastic(STEP * w, u, g) < film
    assert laws.film_line_elastic(w, STEP * u, g) > film
    assert laws.film_line_elastic(w, u, STEP * g) > film
    assert laws.film_line_rigid(w, u) == pytest.approx(4.9 * u / w, rel=1e-14)


@examples
@given(loads, speeds, materials, ratios)
def test_point_film(w: float, u: float, g: float, ratio: float) -> None:
    film, rigid = laws.film_point_elastic(w, u, g, ratio), laws.film_point_rigid(w, u, ratio)
    assert math.isfinite(film)
    assert film > 0
    assert rigid > 0
    shape = 1.0 - math.exp(-1.23 * ratio ** (2.0 / 3.0))
    assert film == pytest.approx(4.31 * u**0.68 * g**0.49 * w**-0.073 * shape, rel=1e-12)
    assert laws.film_point_elastic(w, STEP * u, g, ratio) > film
    assert laws.film_point_elastic(STEP * w, u, g, ratio) < film
    # wider across rolling leaks less
    assert laws.film_point_elastic(w, u, g, STEP * ratio) >= film
    assert laws.film_point_rigid(w, u, STEP * ratio) > rigid
    phi = 1.0 / (1.0 + 2.0 / (3.0 * ratio))
    bracket = 0.131 * math.atan(0.5 * ratio) + 1.683
    assert rigid == pytest.approx(128 * ratio * phi**2 * bracket**2 * (u / w) ** 2, rel=1e-12)


@examples
@given(powers(1e-6, 0.1), powers(1e-14, 1e3), powers(1e-12, 2.0), powers(1e-3, 0.5))
def test_thermal_factor(pressure: float, loading: float, slip: float, floor: float) -> None:
    factor = laws.film_thermal(pressure, loading, slip, floor)
    assert floor <= factor <= max(1.0, 1.5 * floor) + 1e-12
    for heavier in (
        (STEP * pressure, loading, slip),
        (pressure, STEP * loading, slip),
        (pressure, loading, STEP * slip),
    ):
        assert laws.film_thermal(*heavier, floor) <= factor + 1e-14


@examples
@given(powers(1e-15, 1e9), powers(1e-9, 1e9))
def test_traction(sigma: float, d: float) -> None:
    s = laws.traction_muraki_kimura(sigma, d)
    assert math.isfinite(s)
    assert s > 0
    # never more than the purely viscous fluid carries, nor than the purely elastic one
    assert s <= math.asinh(sigma) * (1 + 1e-12)
    assert s <= sigma / d * (1 + 1e-12)
    assert laws.traction_muraki_kimura(STEP * sigma, d) >= s
    assert laws.traction_muraki_kimura(sigma, STEP * d) <= s


@examples
@given(st.floats(0.0, 2.0))
def test_boundary_friction(slip: float) -> None:
    mu = laws.friction_boundary(slip, *BOUNDARY)
    assert 0.0 <= mu <= 0.12001
    assert mu <= 40.43 * slip


@examples
@given(st.floats(0.0, 5.0), st.floats(0.0, 5.0))
def test_boundary_share(one: float, other: float) -> None:
    thin, thick = sorted((one, other))
    shares = laws.boundary_share(np.array([thin, thick]), 0.01, 1.5)
    assert 0.0 <= shares[1] <= shares[0] <= 1.0
    inside = min(max(thin, 0.01), 1.5)
    assert shares[0] == pytest.approx(((inside - 1.5) / (0.01 - 1.5)) ** 6, abs=1e-14)


@examples
@given(st.floats(0.0, 4e9), st.floats(-14.0, 200.0))
def test_viscosity_of_dicke(pressure: float, temperature: float) -> None:
    a, b, c, d = DICKE
    exponent = laws.viscosity_dicke(pressure, temperature, *DICKE)
    assert 0.0 <= exponent < 1.0 / (c + d * temperature)
    assert exponent <= 1e-5 * pressure / (a + b * temperature)
    assert laws.viscosity_dicke(STEP * pressure, temperature, *DICKE) >= exponent
    assert laws.viscosity_dicke(pressure, temperature + 1.0, *DICKE) <= exponent


@examples
@given(st.floats(0.0, 1e11), powers(1e-10, 1e-7), powers(1e-4, 10.0), st.floats(1.0, 60.0))
def test_capped_viscosities(pressure: float, alpha: float, viscosity: float, cap: float) -> None:
    barus = laws.viscosity_barus(pressure, alpha, cap)
    roelands = laws.viscosity_roelands(pressure, alpha, viscosity, cap)
    for exponent in (barus, roelands):
        assert exponent <= cap + 1e-12
        # the smooth cap takes off at most a quarter of its half width of 1, and nothing where there is nothing
        assert exponent >= min(0.0, cap - 1.25) - 1e-12
    assert barus >= min(alpha * pressure, cap) - 0.25 - 1e-12
    assert laws.viscosity_barus(STEP * pressure, alpha, cap) >= barus - 1e-12
    assert laws.viscosity_roelands(STEP * pressure, alpha, viscosity, cap) >= roelands - 1e-12


@examples
@given(st.floats(0.0, 5e9), st.floats(-80.0, 400.0), powers(1e4, 1e9))
def test_shear_modulus(pressure: float, temperature: float, floor: float) -> None:
    modulus = laws.shear_modulus(pressure, temperature, floor)
    assert modulus >= floor * (1 - 1e-12)
    assert laws.shear_modulus(STEP * pressure, temperature, floor) >= modulus * (1 - 1e-12)
    bare = 1.2 * pressure / (2.52 + 0.024 * temperature) - 1e8
    # the smooth floor adds at most an eighth of the floor
    assert modulus == pytest.approx(max(bare, floor), rel=1e-12, abs=0.126 * floor)


@examples
@given(st.floats(-1e-3, 1e-3), powers(1e9, 1e12), powers(1e-3, 1.0))
def test_line_load(interference: float, modulus: float, length: float) -> None:
    load = laws.line_load(interference, modulus, length)
    if interference <= 0:
        assert load == 0
    else:
        expected = 0.356 * modulus * length ** (-1 / 9) * interference ** (10 / 9)
        assert load == pytest.approx(expected, rel=1e-12, abs=1e-300)


@examples
@given(powers(1e-4, 1e2), powers(1e-4, 1e2), powers(1e-6, 1e6))
def test_point(one: float, two: float, load: float) -> None:
    k, stiffness = laws.point_ellipticity(one, two), laws.point_stiffness(one, two, 226e9)
    along, across = laws.point_semi_axis_long(load, one, two, 226e9), laws.point_semi_axis_short(load, one, two, 226e9)
    assert k >= 1.0
    assert math.isfinite(stiffness)
    assert stiffness > 0
    assert along == pytest.approx(k * across, rel=1e-12)
    # Hertz: between equal radii of the smaller and of the larger one
    small, large = (4 / 3 * 113e9 * math.sqrt(radius) for radius in sorted((one, two)))
    assert small * (1 - 1e-9) <= stiffness <= large * (1 + 1e-9)


@examples
@given(loads, speeds, materials)
def test_rolling(w: float, u: float, g: float) -> None:
    force = laws.rolling_line(w, u, g)
    assert force == pytest.approx(29.2 * (g * u) ** 0.648 * w**0.246, rel=1e-12)


@examples
@given(powers(1e-12, 1e3), powers(1e-6, 1e2))
def test_slide_roll_of_the_cage(speed: float, entrainment: float) -> None:
    ratio = laws.slide_roll_cage(speed, entrainment)
    assert 0 < ratio <= 2.0 + 1e-12
    assert laws.slide_roll_cage(STEP * speed, entrainment) >= ratio
