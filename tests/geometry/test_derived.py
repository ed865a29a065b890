"""Derived geometry: the table of the 30310, a derivation by other means, and another bearing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from trbdyn import Simulation, cases
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing, Profile
from trbdyn.model.effects import Effects

TABLE = [
    ("roller_half_angle", math.degrees(1.0), 1.8707, 4),
    ("roller_axis_angle", math.degrees(1.0), 11.0820, 4),
    ("cone_half_angle", math.degrees(1.0), 9.2113, 4),
    ("apex_to_mid", 1e3, 214.315, 3),
    ("apex_to_large_end", 1e3, 224.215, 3),
    ("outer_race_radius", 1e3, 48.064, 3),
    ("inner_race_radius", 1e3, 34.325, 3),
    ("outer_equivalent_radius", 1e3, 8.163, 3),
    ("inner_equivalent_radius", 1e3, 5.830, 3),
    ("large_end_diameter", 1e3, 14.646, 3),
    ("small_end_diameter", 1e3, 13.354, 3),
    ("roller_mass", 1e3, 25.0, 1),
    ("roller_inertia_axial", 1e7, 6.16, 2),
    ("roller_inertia_transverse", 1e6, 1.21, 2),
    ("roller_mass_offset", 1e3, 0.336, 3),
    ("sphere_radius", 1e3, 202.24, 2),
    ("rib_contact_radius", 1e3, 37.615, 3),
    ("rib_normal_angle", math.degrees(1.0), 9.475, 3),
    ("rib_curvature_radius", 1e3, 228.5, 1),
    ("rib_rx", 1.0, 1.761, 3),
    ("rib_ry", 1.0, 0.2022, 4),
    ("rib_ellipticity", 1.0, 4.12, 2),
    ("effective_modulus", 1e-9, 226.37, 2),
    ("cage_speed_ratio", 1.0, 0.41662, 5),
    ("roller_spin_ratio", 1.0, 2.8606, 4),
]
LOOSE = ("large_end_diameter", "small_end_diameter", "rib_normal_angle")
"""The table measures the first two along the flank (14 -+ 19.8 sin nu), the core along the axis (tan nu), and cuts the
third off: one unit of the last digit instead of half of it."""


@pytest.mark.parametrize(("name", "factor", "value", "digits"), TABLE)
def test_table(rig: Bearing, name: str, factor: float, value: float, digits: int) -> None:
    found = factor * getattr(rig.geometry, name)
    assert found == pytest.approx(value, rel=0.0, abs=(1.0 if name in LOOSE else 0.5001) * 10.0**-digits)


@pytest.fixture(params=["30310", "32216"])
def bearing(request: pytest.FixtureRequest) -> Bearing:
    return cases.BEARINGS[request.param]()


def test_cones_share_an_apex(bearing: Bearing) -> None:
    g, cup = bearing.geometry, math.radians(bearing.cup_half_angle_deg)

    def off(nu: float) -> float:
        return math.tan(nu) - bearing.roller.diameter / bearing.pitch_diameter * math.sin(cup - nu)

    assert g.roller_half_angle == pytest.approx(brentq(off, 1e-6, cup), rel=1e-12)
    assert g.roller_axis_angle == pytest.approx(cup - g.roller_half_angle, rel=1e-14)
    assert g.cone_half_angle == pytest.approx(cup - 2 * g.roller_half_angle, rel=1e-13)
    assert g.apex_to_mid * math.sin(g.roller_axis_angle) == pytest.approx(bearing.pitch_diameter / 2, rel=1e-14)
    assert g.centre_plane == pytest.approx(g.apex_to_mid * math.cos(g.roller_axis_angle), rel=1e-14)
    taper = bearing.roller.effective_length * math.tan(g.roller_half_angle)
    assert g.large_end_diameter == pytest.approx(bearing.roller.diameter + taper, rel=1e-13)
    assert g.small_end_diameter == pytest.approx(bearing.roller.diameter - taper, rel=1e-13)
    # from the mid of the axis half a diameter out and down, across the axis, is on the race cones
    normal = np.array([math.cos(g.roller_axis_angle), -math.sin(g.roller_axis_angle)])
    mid = g.apex_to_mid * np.array([math.sin(g.roller_axis_angle), math.cos(g.roller_axis_angle)])
    for side, angle, radius in ((1, cup, g.outer_race_radius), (-1, g.cone_half_angle, g.inner_race_radius)):
        point = mid + side * bearing.roller.diameter / 2 * normal
        assert math.atan2(*point) == pytest.approx(angle, rel=1e-12)
        assert point[0] == pytest.approx(radius, rel=1e-12)


def test_equivalent_radii(bearing: Bearing) -> None:
    """Curvature of a cone across its generator is cos(half angle)/radius."""
    g = bearing.geometry
    roller = math.cos(g.roller_half_angle) / (bearing.roller.diameter / 2)
    outer = math.cos(math.radians(bearing.cup_half_angle_deg)) / g.outer_race_radius
    inner = math.cos(g.cone_half_angle) / g.inner_race_radius
    assert 1 / g.outer_equivalent_radius == pytest.approx(roller - outer, rel=1e-12)
    assert 1 / g.inner_equivalent_radius == pytest.approx(roller + inner, rel=1e-12)


def test_mass(bearing: Bearing) -> None:
    g, roller = bearing.geometry, bearing.roller
    half, slope = roller.total_length / 2, math.tan(g.roller_half_angle)

    def moment(power: int, radius_power: int) -> float:
        def slab(s: float) -> float:
            return roller.density * math.pi * s**power * (slope * (g.apex_to_mid + s)) ** radius_power

        return quad(slab, -half, half, epsabs=0, epsrel=1e-12)[0]

    mass = moment(0, 2)
    centre = moment(1, 2) / mass
    assert g.roller_mass == pytest.approx(mass, rel=1e-12)
    assert g.roller_mass_offset == pytest.approx(centre, rel=1e-11)
    assert g.roller_inertia_axial == pytest.approx(moment(0, 4) / 2, rel=1e-12)
    transverse = moment(0, 4) / 4 + moment(2, 2) - mass * centre**2
    assert g.roller_inertia_transverse == pytest.approx(transverse, rel=1e-11)
    place = g.apex_to_mid + centre
    assert g.roller_centre_radius == pytest.approx(place * math.sin(g.roller_axis_angle), rel=1e-13)
    assert g.roller_centre_height == pytest.approx(place * math.cos(g.roller_axis_angle), rel=1e-13)


def test_rib_touches_the_nominal_sphere(bearing: Bearing) -> None:
    g, ribs = bearing.geometry, bearing.ribs
    centre = g.sphere_centre * np.array([math.sin(g.roller_axis_angle), math.cos(g.roller_axis_angle)])
    normal = np.array([math.sin(g.rib_normal_angle), math.cos(g.rib_normal_angle)])
    point = np.array([g.rib_contact_radius, g.rib_contact_z])
    assert point - centre == pytest.approx(g.sphere_radius * normal, rel=1e-12)
    # the height is measured across the raceway
    across = np.array([math.cos(g.cone_half_angle), -math.sin(g.cone_half_angle)])
    assert point @ across == pytest.approx(ribs.contact_height, rel=1e-10)
    assert g.rib_curvature_radius == pytest.approx(point[0] / normal[0], rel=1e-12)
    assert 1 / g.rib_rx == pytest.approx(1 / g.sphere_radius - 1 / g.rib_curvature_radius, rel=1e-10)
    assert g.sphere_centre + g.sphere_radius == pytest.approx(g.apex_to_mid + bearing.roller.total_length / 2)
    assert normal[0] > 0
    assert normal[1] > 0


def test_rib_sliding(rig: Bearing) -> None:
    """The contact height gives a slide-roll ratio of about 0.30, as the paper states."""
    sim = Simulation(cases.paper_30310(3000.0, bearing=rig))
    assert sim.contacts()["rib_slide_roll"] == pytest.approx(0.30, abs=0.01)


def test_ratios_are_those_of_pure_rolling(bearing: Bearing) -> None:
    """At the start both raceways roll without sliding, all along the contact."""
    scene = {"30310": cases.paper_30310, "32216": cases.scene_32216}[bearing.name]
    whole = bearing.replace({"roller.profile": Profile.logarithmic(1400.0)})
    found = Simulation(scene(3000.0, bearing=whole, effects=Effects.paper())).contacts()
    speed = found["raceway_mean_speed"].mean(axis=(0, 1))
    middle = 0.5 * (speed[11] + speed[12])
    half = 0.5 * bearing.roller.diameter
    # interference of some micrometres shifts the contact points: 1e-3 of the radius
    assert middle == pytest.approx(half * bearing.geometry.roller_spin_ratio * 100 * math.pi, rel=1e-3)
    assert found["raceway_slide_roll"].max() < 1e-3
    if bearing.name == "30310":
        assert middle == pytest.approx(6.291, abs=6.291e-3)


def test_surface_speed_of_nominal_rollers(rig: Bearing) -> None:
    """Without the interference of a load the speed is that of the table, to its digits."""
    sim = Simulation(
        cases.scene_30310(3000.0, bearing=rig, effects=Effects.paper().replace(quadrature="gauss", n_slices=1))
    )
    vector = np.zeros_like(sim.state.vector)
    sim.view(vector)["roller_r"] = 1e-9
    found = sim.contacts(vector, 0.0)
    assert found["raceway_mean_speed"][0] == pytest.approx(6.291, abs=0.5e-3)
    assert found["raceway_slide_roll"][0].max() < 1e-6


def test_32216(rig: Bearing) -> None:
    """Within the envelope of the catalogue (80 x 140 x 35.25 mm), and scaled in the right direction."""
    other = cases.bearing_32216()
    g = other.geometry
    assert 40e-3 < g.inner_race_radius < g.outer_race_radius < 70e-3
    assert g.outer_race_radius - g.inner_race_radius == pytest.approx(
        other.roller.diameter * math.cos(g.roller_axis_angle), rel=1e-12
    )
    end = g.outer_race_radius + 0.5 * other.roller.effective_length * math.sin(math.radians(other.cup_half_angle_deg))
    assert end < 70e-3
    assert g.roller_mass / rig.geometry.roller_mass == pytest.approx((17 / 14) ** 2 * 23.7 / 20.8, rel=2e-3)
    assert 40e-3 < g.rib_contact_radius < g.outer_race_radius
    assert 3.0 < g.rib_ellipticity < 6.0


def test_size_does_not_matter(rig: Bearing) -> None:
    """A bearing of twice the size has the same angles and twice the lengths."""
    roller, ribs, cage = rig.roller, rig.ribs, rig.cage
    lengths = ("contact_height", "edge_low", "edge_high", "front_clearance", "front_low", "front_high")
    plays = ("play_radial", "play_circumferential", "play_axial", "bar_width")
    walls = ("wall_inner", "wall_outer", "wall_half_width")
    twice = rig.replace(
        pitch_diameter=2 * rig.pitch_diameter,
        roller=roller.replace(
            diameter=2 * roller.diameter,
            effective_length=2 * roller.effective_length,
            total_length=2 * roller.total_length,
        ),
        ribs=ribs.replace(**{name: 2 * getattr(ribs, name) for name in lengths}),
        cage=cage.replace(**{name: 2 * getattr(cage, name) for name in (*plays, *walls)}),
    )
    small, large = rig.geometry, twice.geometry
    assert large.roller_half_angle == pytest.approx(small.roller_half_angle, rel=1e-13)
    assert large.rib_normal_angle == pytest.approx(small.rib_normal_angle, rel=1e-12)
    assert large.apex_to_mid == pytest.approx(2 * small.apex_to_mid, rel=1e-13)
    assert large.rib_rx == pytest.approx(2 * small.rib_rx, rel=1e-10)
    assert large.roller_mass == pytest.approx(8 * small.roller_mass, rel=1e-12)
    assert large.roller_inertia_transverse == pytest.approx(32 * small.roller_inertia_transverse, rel=1e-12)


@pytest.mark.parametrize(
    ("part", "change", "field"),
    [
        ("", {"n_rollers": 19}, "n_rollers"),
        ("", {"pitch_diameter": 40e-3}, "n_rollers"),
        ("roller", {"total_length": 0.5}, "total_length"),
        ("roller", {"sphere_ratio": 0.05}, "contact_height"),
    ],
)
def test_what_does_not_fit(rig: Bearing, part: str, change: dict[str, float], field: str) -> None:
    changes = {part: getattr(rig, part).replace(**change)} if part else change
    with pytest.raises(InputError) as caught:
        rig.replace(**changes)
    assert caught.value.field.split(".")[-1] == field
