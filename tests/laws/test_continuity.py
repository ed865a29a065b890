"""Where branches of a law meet: values and slopes agree from both sides; limits at zero and far out."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq

from trbdyn import laws

BOUNDARY = (0.1, 22.28, 181.46)


def sided_slopes(law, x: float, step: float) -> tuple[float, float]:
    """Slopes at x from below and from above: one-sided differences of second order."""
    below, above = law(x - step * np.arange(3)), law(x + step * np.arange(3))
    return float((3 * below[0] - 4 * below[1] + below[2]) / (2 * step)), float(
        (-3 * above[0] + 4 * above[1] - above[2]) / (2 * step)
    )


def junction(d: float) -> float:
    """Sigma where Xc = (D/Sigma) asinh(Sigma) = 2, for D > 2."""
    return brentq(lambda sigma: d * math.asinh(sigma) - 2.0 * sigma, 1e-6, 10.0 * d * math.log(d + 10.0), xtol=1e-14)


class TestMurakiKimura:
    """Erratum of eq. 7: S = Sigma/D, the only choice that meets eq. 8 at Xc = 2, and vanishes at zero slip."""

    def test_meets_with_one_slope_at_the_junction(self) -> None:
        for d in np.geomspace(2.001, 1e6, 60):
            sigma, relative = junction(d), 1e-6
            inside, outside = (laws.traction_muraki_kimura(sigma * (1 + side * relative), d) for side in (-1, 1))
            assert inside == pytest.approx(outside, rel=3 * relative), d
            assert laws.traction_muraki_kimura(sigma, d) == pytest.approx(sigma / d, rel=1e-12), d
            below, above = sided_slopes(lambda x, d=d: laws.traction_muraki_kimura(x, d), sigma, 1e-5 * sigma)
            assert below == pytest.approx(1.0 / d, rel=1e-8), d
            # the error of the one-sided difference is of second order in the relative step
            assert above == pytest.approx(below, rel=1e-8), d

    def test_what_is_printed_would_not_meet(self) -> None:
        d = 10.0
        sigma = junction(d)
        assert abs(d / sigma - laws.traction_muraki_kimura(sigma * (1 + 1e-9), d)) > 1.0

    def test_vanishes_with_slip(self) -> None:
        d = np.geomspace(1e-9, 1e9, 37)
        assert np.all(laws.traction_muraki_kimura(0.0, d) >= 0.0)
        assert np.all(laws.traction_muraki_kimura(0.0, d) <= 1e-290)
        small = laws.traction_muraki_kimura(1e-12, d)
        # linear in slip: Sigma/D where D >= 2, else Sigma (1 - D/4)
        assert small == pytest.approx(1e-12 * np.where(d >= 2.0, 1.0 / d, 1.0 - d / 4.0), rel=1e-11)

    def test_slope_at_zero_slip_is_continuous_in_d(self) -> None:
        low, high = (laws.traction_muraki_kimura(1e-9, 2.0 + side * 1e-6) for side in (-1, 1))
        assert low == pytest.approx(high, rel=2e-6)

    def test_logarithm_at_large_slip(self) -> None:
        sigma = 1e9
        assert laws.traction_muraki_kimura(sigma, 1.0) == pytest.approx(math.log(2 * sigma), rel=1e-7)

    @mpmath.workdps(40)
    def test_against_many_digits(self) -> None:
        for sigma in map(float, np.geomspace(1e-14, 1e12, 40)):
            exact_sigma = mpmath.mpf(sigma)
            a = mpmath.asinh(exact_sigma)
            for d in (1e-6, 0.1, 1.0, 1.9, 2.1, 30.0, 1e4):
                critical = d * a / exact_sigma
                exact = exact_sigma / d if critical >= 2 else a * (1 - d * a / (4 * exact_sigma))
                assert laws.traction_muraki_kimura(sigma, d) == pytest.approx(float(exact), rel=1e-14), (sigma, d)


class TestSmoothMax:
    @pytest.mark.parametrize(("low", "half_width"), [(0.05, 0.025), (-25.0, 1.0), (1e7, 0.5e7)])
    def test_one_slope_at_both_ends_of_its_band(self, low: float, half_width: float) -> None:
        for end, slope in ((low - half_width, 0.0), (low + half_width, 1.0)):
            step = 1e-4 * half_width
            below, above = sided_slopes(lambda x: laws.smooth_max(x, low, half_width), end, step)
            assert (below, above) == pytest.approx((slope, slope), abs=1e-9)

    def test_exact_outside_its_band(self) -> None:
        x = np.array([-1e300, -7.0, 0.0, 0.4999, 1.5001, 2.0, 1e5])
        assert laws.smooth_max(x, 1.0, 0.5) == pytest.approx(np.maximum(x, 1.0), rel=1e-15)

    def test_never_below_and_at_most_a_quarter_of_the_band_above(self) -> None:
        x = np.linspace(-3, 3, 6001)
        over = laws.smooth_max(x, 1.0, 0.5) - np.maximum(x, 1.0)
        assert over.min() >= 0.0
        assert over.max() == pytest.approx(0.5 / 4, rel=1e-12)


class TestThermalFactor:
    def test_floor_is_reached_smoothly(self) -> None:
        """At 30 000 rpm the numerator turns negative with pressure."""
        floor, thermal_loading = 0.05, 0.0346 * 0.0392 * 62.9**2 / 0.134
        pressures = np.linspace(0.0, 8e9, 200001) / 226.37e9
        factor = laws.film_thermal(pressures, thermal_loading, 0.0, floor)
        numerator = 1.0 - 13.2 * pressures * thermal_loading**0.42
        assert pressures[np.argmax(numerator < 0)] * 226.37e9 == pytest.approx(3.6e9, abs=0.1e9)
        assert factor.min() == floor
        assert np.all(np.diff(factor) <= 0)
        bends = np.abs(np.diff(factor, 2)) / (pressures[1] - pressures[0])
        # a kink of the bare maximum would show as one jump of the slope; the smooth one has none
        slope = np.abs(np.diff(factor)).max() / (pressures[1] - pressures[0])
        assert bends.max() < 0.01 * slope

    def test_one_at_rest(self) -> None:
        assert laws.film_thermal(0.003, 1e-30, 0.0, 0.05) == pytest.approx(1.0, abs=1e-11)
        assert laws.film_thermal(0.003, 0.0, 0.0, 0.05) == 1.0

    def test_exact_above_the_floor(self) -> None:
        p, lt, s = 0.0034, 0.4, 0.03
        expected = (1 - 13.2 * p * lt**0.42) / (1 + 0.213 * (1 + 2.23 * s**0.83) * lt**0.64)
        assert laws.film_thermal(p, lt, s, 0.05) == pytest.approx(expected, rel=1e-14)


class TestBoundaryShare:
    def test_both_ends(self) -> None:
        low, high = 0.01, 1.5
        share = laws.boundary_share(np.array([0.0, low, high, 99.0]), low, high)
        assert share.tolist() == [1.0, 1.0, 0.0, 0.0]
        assert laws.boundary_share(low + 1e-9, low, high) == pytest.approx(1.0, abs=1e-8)
        assert laws.boundary_share(high - 1e-3, low, high) == pytest.approx(0.0, abs=1e-17)

    def test_thick_end_is_flat(self) -> None:
        """Six times zero slope where the film takes over; at the thin end the paper's law has a corner of slope -6/1.49."""
        below, above = sided_slopes(lambda x: laws.boundary_share(x, 0.01, 1.5), 1.5, 1e-4)
        assert (below, above) == pytest.approx((0.0, 0.0), abs=1e-15)
        below, above = sided_slopes(lambda x: laws.boundary_share(x, 0.01, 1.5), 0.01, 1e-5)
        assert below == 0.0
        assert above == pytest.approx(-6 / 1.49, rel=1e-7)


class TestRollingShare:
    def test_band(self) -> None:
        x = np.array([0.0, 0.9, 1.0, 1.1, 50.0])
        assert laws.rolling_share(x, 0.1) == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0], abs=1e-14)
        for end in (0.9, 1.1):
            below, above = sided_slopes(lambda x: laws.rolling_share(x, 0.1), end, 1e-6)
            assert (below, above) == pytest.approx((0.0, 0.0), abs=1e-8)

    def test_narrow_band_is_the_papers_switch(self) -> None:
        assert laws.rolling_share(np.array([1 - 2e-6, 1 + 2e-6]), 1e-6).tolist() == [0.0, 1.0]


class TestViscosity:
    @pytest.mark.parametrize("name", ["viscosity_barus", "viscosity_roelands"])
    def test_cap_is_reached_smoothly(self, name: str) -> None:
        cap = 11.0
        arguments = (2e-8, cap) if name == "viscosity_barus" else (2e-8, 0.0346, cap)
        pressure = np.linspace(0.0, 3e9, 300001)
        exponent = getattr(laws, name)(pressure, *arguments)
        assert exponent.max() == cap
        assert np.all(np.diff(exponent) >= -1e-14)
        slope = np.diff(exponent) / np.diff(pressure)
        assert np.abs(np.diff(slope)).max() < 0.001 * slope.max()
        uncapped = getattr(laws, name)(pressure, *arguments[:-1], 1e3)
        free = uncapped < cap - 1.0
        assert exponent[free] == pytest.approx(uncapped[free], abs=1e-12)

    @pytest.mark.parametrize("alpha", [5e-9, 1.97e-8, 4e-8])
    def test_laws_agree_for_small_pressure(self, alpha: float) -> None:
        pressure = 1e3
        roelands = laws.viscosity_roelands(pressure, alpha, 0.0346, 25.0)
        barus = laws.viscosity_barus(pressure, alpha, 25.0)
        dicke = laws.viscosity_dicke(pressure, 60.0, 1e-5 / alpha, 0.0, 0.0, 3e-4)
        assert barus == pytest.approx(alpha * pressure, abs=1e-14)
        assert roelands == pytest.approx(barus, rel=1e-4)
        assert dicke == pytest.approx(barus, rel=1e-4)


class TestSlideRoll:
    def test_cage_ratio(self) -> None:
        assert laws.slide_roll_cage(0.0, 0.05) == 0.0
        assert laws.slide_roll_cage(1e-9, 0.05) == pytest.approx(2e-8, rel=1e-12)
        assert laws.slide_roll_cage(1e6, 0.05) == pytest.approx(2.0, rel=1e-12)


@mpmath.workdps(50)
def test_boundary_friction_keeps_its_digits() -> None:
    """1 - exp(-x) at small slip cancels unless it is evaluated as expm1."""
    for slide_roll in map(float, np.geomspace(1e-16, 1.0, 17)):
        s = mpmath.mpf(slide_roll)
        exact = (-mpmath.mpf(0.1) + mpmath.mpf(22.28) * s) * mpmath.exp(-mpmath.mpf(181.46) * s) + mpmath.mpf(0.1)
        assert laws.friction_boundary(slide_roll, *BOUNDARY) == pytest.approx(float(exact), rel=2e-14), slide_roll
