"""Laws against other ways to the same number: SciPy's integrals, Hertz' theory solved again, NumPy's nodes."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, fsolve
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc, elliprd, elliprf

from trbdyn import Effects, Simulation, cases, laws
from trbdyn.model.bearing import Profile

MODULUS = 226.37e9


class TestEllipticIntegrals:
    m = np.concatenate([np.linspace(0.0, 0.999, 200), 1.0 - np.geomspace(1e-12, 1e-3, 40)])

    def test_first(self) -> None:
        assert laws.elliptic_first(self.m) == pytest.approx(ellipk(self.m), rel=4e-15)

    def test_second(self) -> None:
        assert laws.elliptic_second(self.m) == pytest.approx(ellipe(self.m), rel=1e-14)

    def test_incomplete_ones_at_a_right_angle(self) -> None:
        assert laws.elliptic_first(0.7) == pytest.approx(ellipkinc(math.pi / 2, 0.7), rel=1e-14)
        assert laws.elliptic_second(0.7) == pytest.approx(ellipeinc(math.pi / 2, 0.7), rel=1e-14)

    def test_legendres_relation(self) -> None:
        m = np.linspace(0.01, 0.99, 99)
        k, e, k1, e1 = (f(x) for x in (m, 1 - m) for f in (laws.elliptic_first, laws.elliptic_second))
        assert e * k1 + e1 * k - k * k1 == pytest.approx(math.pi / 2, rel=1e-13)


def hertz(load: float, longer: float, shorter: float, modulus: float) -> tuple[float, float, float]:
    """Semi-axes and approach from the displacements under an ellipsoidal pressure, by Carlson's integrals.

    K. L. Johnson, Contact Mechanics, 3.41: pi E* [d - x^2/(2 R_long) - y^2/(2 R_short)] = L - M x^2 - N y^2.
    """
    star = 0.5 * modulus

    def integrals(a: float, b: float) -> tuple[float, float, float]:
        peak = 1.5 * load / (math.pi * a * b)
        scale = 0.5 * math.pi * peak * a * b
        return (
            scale * 2.0 * elliprf(0.0, a * a, b * b),
            scale * 2.0 / 3.0 * elliprd(0.0, b * b, a * a),
            scale * 2.0 / 3.0 * elliprd(0.0, a * a, b * b),
        )

    def off(logs: np.ndarray) -> list[float]:
        _, along, across = integrals(*np.exp(logs))
        return [
            math.log(along / (math.pi * star / (2 * longer))),
            math.log(across / (math.pi * star / (2 * shorter))),
        ]

    start = (0.75 * load * math.sqrt(longer * shorter) / star) ** (1 / 3)
    logs = fsolve(off, [math.log(start) + 0.3, math.log(start) - 0.3], xtol=1e-13)
    a, b = np.exp(logs)
    return a, b, integrals(a, b)[0] / (math.pi * star)


@pytest.mark.parametrize("load", [1e-3, 119.6, 3e4])
@pytest.mark.parametrize(
    ("longer", "shorter"), [(1.761, 0.2022), (0.02, 0.019999), (0.05, 0.04), (1.0, 0.01), (10.0, 0.002)]
)
def test_hertz_point(load: float, longer: float, shorter: float) -> None:
    a, b, approach = hertz(load, longer, shorter, MODULUS)
    for radii in ((longer, shorter), (shorter, longer)):
        assert laws.point_ellipticity(*radii) == pytest.approx(a / b, rel=1e-9)
        assert laws.point_semi_axis_long(load, *radii, MODULUS) == pytest.approx(a, rel=1e-9)
        assert laws.point_semi_axis_short(load, *radii, MODULUS) == pytest.approx(b, rel=1e-9)
        assert laws.point_stiffness(*radii, MODULUS) * approach**1.5 == pytest.approx(load, rel=1e-9)


def test_hertz_sphere_on_plane() -> None:
    """Equal radii: the textbook's formulas, and no jump where the series about the circle takes over."""
    radius, load = 0.01, 50.0
    star = 0.5 * MODULUS
    assert laws.point_ellipticity(radius, radius) == pytest.approx(1.0, abs=1e-9)
    assert laws.point_stiffness(radius, radius, MODULUS) == pytest.approx(4 / 3 * star * math.sqrt(radius), rel=1e-9)
    semi = (0.75 * load * radius / star) ** (1 / 3)
    assert laws.point_semi_axis_long(load, radius, radius, MODULUS) == pytest.approx(semi, rel=1e-9)
    ratio = np.geomspace(1e-9, 1e-3, 400)
    # d ln k / d ln(R ratio) at the circle is 2/3
    assert laws.point_ellipticity(1.0 + ratio, 1.0) - 1.0 == pytest.approx(2 / 3 * ratio, rel=2e-3, abs=1e-9)


def test_hertz_line() -> None:
    """Load, width and pressure of a line belong together, and Johnson's formulas with R and E*."""
    load, radius, star = 9.2e4, 8.163e-3, 0.5 * MODULUS
    b = math.sqrt(4 * load * radius / (math.pi * star))
    assert laws.line_half_width(load, radius, MODULUS) == pytest.approx(b, rel=1e-14)
    assert laws.line_pressure(load, radius, MODULUS) == pytest.approx(2 * load / (math.pi * b), rel=1e-14)
    assert laws.line_pressure(load, radius, MODULUS) == pytest.approx(math.sqrt(load * star / (math.pi * radius)))


def logarithmic_drop(y: float, length: float, k1: float, k2: float, zm: float, load: float, modulus: float) -> float:
    amplitude, half = 2 * k1 * load / (math.pi * length * modulus), 0.5 * length
    if abs(y) <= half - k2 * half:
        return 0.0
    t = (abs(y) - half) / (k2 * half) + 1.0
    with mpmath.workdps(60):
        exact = mpmath.mpf(amplitude)
        return float(exact * mpmath.log(1 / (1 - (1 - mpmath.exp(-mpmath.mpf(zm) / exact)) * mpmath.mpf(t) ** 2)))


class TestProfiles:
    length, k1, k2, zm, load = 19.8e-3, 1.5, 0.4, 10e-6, 1833.0

    def test_logarithmic(self) -> None:
        y = np.linspace(-0.5, 0.5, 1001) * self.length
        numbers = (self.length, self.k1, self.k2, self.zm, self.load, MODULUS)
        expected = [logarithmic_drop(float(station), *numbers) for station in y]
        found = laws.profile_logarithmic(y, *numbers)
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-20)
        assert found[0] == pytest.approx(10e-6, rel=1e-12)
        assert np.all(found[np.abs(y) < 0.3 * self.length] == 0.0)
        assert found == pytest.approx(found[::-1], rel=1e-9)

    def test_logarithmic_starts_smoothly(self) -> None:
        start, step = 0.3 * self.length, 1e-9
        drop = laws.profile_logarithmic(start + step, self.length, self.k1, self.k2, self.zm, self.load, MODULUS)
        assert 0.0 < drop < 1e-6 * step

    def test_crowned(self) -> None:
        y, radius = np.linspace(-9e-3, 9e-3, 51), 10.0
        # y^2/(R + sqrt(R^2 - y^2)) = R - sqrt(R^2 - y^2) without cancellation
        assert laws.profile_crowned(y, radius) == pytest.approx(radius - np.sqrt(radius**2 - y**2), abs=1e-14)
        assert laws.profile_crowned(y, radius) == pytest.approx(y**2 / (2 * radius), rel=1e-6)

    @pytest.mark.parametrize(
        "profile", [Profile.straight(), Profile.crowned(30.0), Profile.logarithmic(1833.0)], ids=lambda p: p.kind
    )
    def test_profile_reaches_the_contact(self, profile: Profile) -> None:
        """Interference along an untilted roller falls by the drop over cos(nu) beside a straight one's."""
        lost = []
        for shape in (Profile.straight(), profile):
            rig = cases.rig_30310()
            rig = rig.replace(roller=rig.roller.replace(profile=shape))
            sim = Simulation(
                cases.scene_30310(bearing=rig, effects=Effects.paper().replace(quadrature="gauss", n_slices=16))
            )
            vector = np.zeros_like(sim.state.vector)
            view = sim.view(vector)
            view["roller_r"] = 5e-6
            lost.append(sim.contacts(vector, 0.0)["raceway_interference"][0, 0])
        station = 0.5 * self.length * np.polynomial.legendre.leggauss(16)[0]
        drop = {
            "straight": np.zeros(16),
            "crowned": laws.profile_crowned(station, 30.0),
            "logarithmic": laws.profile_logarithmic(
                station, self.length, self.k1, self.k2, self.zm, self.load, rig.geometry.effective_modulus
            ),
        }[profile.kind]
        # the sphere at a station shrinks by drop/cos(nu) and moves by drop tan(nu): along the flank that adds up to
        # drop (1/cos(nu) - sin(nu) tan(nu)) = drop cos(nu)
        assert lost[0] - lost[1] == pytest.approx(drop * math.cos(rig.geometry.roller_half_angle), abs=1e-16)


class TestQuadrature:
    """Nodes and weights as the contacts use them."""

    @staticmethod
    def weights(kind: str, n: int) -> np.ndarray:
        sim = Simulation(cases.scene_30310(effects=Effects.paper().replace(quadrature=kind, n_slices=n)))
        return sim.contacts()["raceway_weight"]

    @pytest.mark.parametrize("n", [1, 2, 3, 5, 8, 16, 31, 64, 200])
    def test_gauss(self, n: int) -> None:
        weights = self.weights("gauss", n)
        expected = 0.5 * 19.8e-3 * np.polynomial.legendre.leggauss(n)[1]
        assert weights.shape == (2, 12, n)
        assert weights == pytest.approx(np.broadcast_to(expected, weights.shape), rel=1e-11)

    @pytest.mark.parametrize("n", [1, 7, 24])
    def test_uniform(self, n: int) -> None:
        assert self.weights("uniform", n) == pytest.approx(19.8e-3 / n, rel=1e-14)


@pytest.mark.parametrize("zm_over_amplitude", [0.1, 1.0, 3.0, 10.0])
def test_logarithmic_profile_with_any_drop_at_its_end(zm_over_amplitude: float) -> None:
    """Also where the drop at the end is small, so that both terms of the sum under the logarithm count along the whole end."""
    length, k1, k2, load = 20e-3, 1.5, 0.4, 2000.0
    amplitude = 2.0 * k1 * load / (np.pi * length * MODULUS)
    zm = zm_over_amplitude * amplitude
    for x in (0.01, 0.3, 0.7, 0.9, 0.99, 1.0):
        y = 0.5 * length * (1.0 + k2 * (x - 1.0))
        wanted = -amplitude * np.log(1.0 - (1.0 - np.exp(-zm_over_amplitude)) * x**2)
        for side in (y, -y):
            assert laws.profile_logarithmic(side, length, k1, k2, zm, load, MODULUS) == pytest.approx(wanted, rel=1e-9)


def test_logarithmic_profile_where_it_begins() -> None:
    """A (1 - exp(-zm/A)) x^2 [1 + (1 - exp(-zm/A)) x^2/2] to the last digits: 1 - x^2 is not subtracted from one on the way."""
    length, k1, k2, load = 2.0, 1.5, 0.5, 2000.0  # powers of two, so that x is exact; 1 - x^2 is not
    amplitude = 2.0 * k1 * load / (np.pi * length * MODULUS)
    share = 1.0 - np.exp(-2.0)
    for x in (1001 * 2.0**-26, 1001 * 2.0**-30, 1001 * 2.0**-34):
        square = share * x**2
        drop = laws.profile_logarithmic(0.5 + 0.5 * x, length, k1, k2, 2.0 * amplitude, load, MODULUS)
        assert drop == pytest.approx(amplitude * square * (1.0 + 0.5 * square), rel=1e-11, abs=0.0)


@pytest.mark.parametrize(("half_widths", "share"), [(5.0, 0.72), (3.0, 0.50), (2.0, 0.27)])
def test_a_meniscus_takes_rolling_resistance(half_widths: float, share: float) -> None:
    """Its place in half widths of a Hertz contact at W 5e-5, U 1.2e-10, G 4460; shares as an independent solver of the contact
    has them; at 1.5 half widths, with S below 2, it has 0.11 where the law has 0.22."""
    w, u, g = 5e-5, 1.2e-10, 4460.0
    root = math.sqrt(half_widths**2 - 1.0)
    gap = 4.0 * w / math.pi * (half_widths * root - math.log(half_widths + root))
    smallest = laws.film_line_smallest(w, u, g)
    assert laws.rolling_meniscus((smallest + gap) / smallest) == pytest.approx(share, abs=0.05)


def test_a_meniscus_far_away_takes_nothing() -> None:
    assert laws.rolling_meniscus(1e9) == pytest.approx(1.0, abs=1e-6)
    assert laws.rolling_supplied(0.0, 0.7) == 0.0
    assert laws.rolling_supplied(1.0, 0.7) == 1.0  # full: the heat of a full inlet alone
    assert laws.rolling_supplied(0.3, 1.0) == pytest.approx(0.3)  # no heat: the supply alone
    heights = np.geomspace(0.1, 1e4, 200)
    assert np.all(np.diff(laws.rolling_meniscus(heights)) > 0.0)


def test_hysteresis_loses_its_share_of_the_moment() -> None:
    """The moment a_v 2 b/(3 pi) Q turns by u/Re a second; two surfaces with F each lose 2 F u."""
    loss, b, radius, load, u = 0.01, 1e-4, 6e-3, 500.0, 7.0
    lost = loss * 2.0 * b / (3.0 * math.pi) * load * u / radius
    assert 2.0 * laws.rolling_hysteresis(loss, b, radius) * load * u == pytest.approx(lost, rel=1e-12)


def test_a_gap_resists_as_reynolds_equation_says() -> None:
    """Rigid cylinder, X = x/sqrt(2 R h), H = 1 + X^2: dp/dx goes with (H - H*)/H^3, the force with this slope times H."""

    def total(end: float, power: int) -> float:
        return float(quad(lambda x: (x * x - end * end) / (1.0 + x * x) ** power, -np.inf, end)[0])

    end = float(brentq(total, 0.1, 1.0, args=(3,)))
    assert laws.rolling_gap(1.0) == pytest.approx(6.0 * math.sqrt(2.0) * total(end, 2), rel=2e-3)
    assert laws.rolling_gap(400.0) == pytest.approx(20.0 * laws.rolling_gap(1.0))


def test_flooded_gaps_are_booked() -> None:
    """The crowned rollers of a 32216 carry on a part of their length; the gaps beside it add a quarter to rolling resistance."""
    scene = cases.scene_32216(2000.0)
    found = {}
    for on in (False, True):
        sim = Simulation(scene.replace({"effects.flooded_gaps": on}), accuracy="reference")
        found[on] = (float(sim.contacts()["raceway_rolling"].sum()), sim.run(duration=2e-3).summary())
        assert found[on][1]["energy_closure"] < 3e-5
    assert 1.15 < found[True][0] / found[False][0] < 1.35
    assert found[True][1]["torque"] > 1.1 * found[False][1]["torque"]


def test_gaps_set_in_with_the_load() -> None:
    """They grow with the load, from nothing."""
    found = []
    for load in (100.0, 300.0, 1000.0):
        scene = cases.scene_32216(2000.0, load, effects=Effects(flooded_gaps=True))
        plain = scene.replace({"effects.flooded_gaps": False})
        found.append(
            float(
                (
                    Simulation(scene).contacts()["raceway_rolling"] - Simulation(plain).contacts()["raceway_rolling"]
                ).sum()
            )
        )
    assert 0.0 < found[0] < found[1] < found[2]


@pytest.mark.parametrize("changes", [{"oil_height": 2e-5}, {"hysteresis": 0.02}, {"replenishment": 6e-8}], ids=str)
def test_supply_and_hysteresis_are_booked(changes: dict[str, float]) -> None:
    """The energy adds up with each of them; films keep their thickness."""
    plain = cases.scene_30310(effects=Effects(n_slices=8))
    runs = {}
    for name, effects in {"off": plain.effects, "on": plain.effects.replace(changes)}.items():
        sim = Simulation(plain.replace(effects=effects), accuracy="reference")
        runs[name] = (sim.contacts(), sim.run(duration=2e-3).summary())
        assert runs[name][1]["energy_closure"] < 1e-5
    ratio = runs["on"][1]["torque"] / runs["off"][1]["torque"]
    assert ratio > 1.002 if "hysteresis" in changes else ratio < 0.95
    loaded = runs["off"][0]["raceway_load"] > 0.0
    films = [runs[name][0]["raceway_film"][loaded] for name in ("on", "off")]
    assert films[0] == pytest.approx(films[1], rel=1e-3)
