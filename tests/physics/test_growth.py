"""Pockets at speed and temperature, and unbalance of the cage."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.flatten import face_rows, parameter_block
from trbdyn.model.growth import roller_shift, running_clearance, strains

PLASTIC = trb.cases.rig_30310().replace({"cage.material": trb.Material.polyamide(), "cage.mass": 0.034})
SCENE = trb.cases.scene_30310(bearing=PLASTIC)


def grown(temperature: float = 80.0, **changes: object) -> trb.Scene:
    return SCENE.replace(growth=trb.Growth.uniform(temperature).replace(**changes))


def test_the_reference_temperature_changes_no_bit() -> None:
    still = SCENE.replace(growth=trb.Growth.uniform(20.0, centrifugal=False))
    assert np.array_equal(face_rows(still), face_rows(SCENE))
    assert np.array_equal(parameter_block(still), parameter_block(SCENE))


def test_plays_at_the_reference_are_those_of_the_cage() -> None:
    cage = SCENE.bearing.cage
    assert SCENE.running_plays == pytest.approx((cage.play_radial, cage.play_circumferential), rel=1e-9)


def test_one_material_at_one_temperature_keeps_its_plays() -> None:
    scene = trb.cases.scene_30310(growth=trb.Growth.uniform(120.0, centrifugal=False))
    assert scene.running_plays == pytest.approx((0.25e-3, 0.12e-3), rel=1e-6)


def test_a_cage_of_polyamide_opens_its_pockets() -> None:
    """By hand: the bars move outward by e R, which their lean turns into a normal gap e R sin(gamma) cos(alpha) and so on;
    the bar faces lie at the place x from the roller's centre, which the cage stretches by e x.
    """
    rise = (50e-6 - 12e-6) * 60.0
    bearing = SCENE.bearing
    face = bearing.pocket.face("leading_bar")
    angle, normal, origin = bearing.geometry.roller_axis_angle, face.normal, np.array(face.origin)
    along = 0.5 * bearing.pitch_diameter * rise
    gap = -along * (normal[0] * math.cos(angle) + normal[2] * math.sin(angle)) - rise * float(normal @ origin)
    # the large end keeps its play: the cage goes back along the axis
    wall = bearing.pocket.face("large_end_wall").origin[2]
    gap -= (
        -(along * math.sin(angle) + rise * wall)
        / math.cos(angle)
        * (normal[2] * math.cos(angle) - normal[0] * math.sin(angle))
    )
    opened = gap / abs(normal[1])
    found = grown(centrifugal=False).running_plays[1] - 0.12e-3
    assert found == pytest.approx(opened, rel=5e-3)
    assert 60e-6 < found < 75e-6
    assert grown(-40.0, centrifugal=False).running_plays[1] - 0.12e-3 == pytest.approx(-found, rel=2e-2)


def test_a_cold_cage_that_holds_its_rollers_is_refused() -> None:
    with pytest.raises(trb.InputError, match=r"leaves no play in bearing\.cage\.pocket"):
        grown(-120.0)


def test_the_rollers_of_warm_rings_move_with_their_roller_set() -> None:
    """Rollers and rings that grow alike move their centres by e Dpw/2; the roller set of a cup, a cone and a rib that are
    set up by hand as straight lines moves as the rule says.
    """
    scene = grown(centrifugal=False)
    found, bearing = strains(scene, scene.growth), scene.bearing
    assert roller_shift(bearing, found) == pytest.approx(0.5 * 12e-6 * 60 * bearing.pitch_diameter, rel=1e-12)
    mixed = grown(rollers_c=50.0, inner_ring_c=90.0, centrifugal=False)
    found, g = strains(mixed, mixed.growth), bearing.geometry
    roller, ring = 1.0 + found.rollers, 1.0 + found.inner_ring
    # unknown: place of the roller's apex along the cone's generator. The rib's plane lies at ring * (P . n); the roller's end, at
    # roller * P from its own apex, touches it.
    point, normal = (
        np.array([g.rib_contact_radius, g.rib_contact_z]),
        np.array([math.sin(g.rib_normal_angle), math.cos(g.rib_normal_angle)]),
    )
    generator = np.array([math.sin(g.cone_half_angle), math.cos(g.cone_half_angle)])
    along = (ring * point @ normal - roller * point @ normal) / (generator @ normal)
    centre = along * generator[0] + roller * 0.5 * bearing.pitch_diameter
    assert roller_shift(bearing, found) == pytest.approx(centre - 0.5 * bearing.pitch_diameter, rel=1e-9)


def test_rotation_widens_the_cage_as_a_free_ring() -> None:
    scene = SCENE.replace(growth=trb.Growth.uniform(20.0), speed_rpm=15000.0)
    bearing, cage = scene.bearing, scene.bearing.cage
    radius = 0.5 * bearing.pitch_diameter + 3e-3 * math.cos(bearing.geometry.roller_axis_angle)
    speed = bearing.geometry.cage_speed_ratio * 15000.0 * math.pi / 30.0 * radius
    assert strains(scene, scene.growth).rotation == pytest.approx(1320.0 * speed**2 / 3.5e9, rel=1e-12)
    assert scene.running_plays[0] > cage.play_radial + 5e-6
    body = scene.replace({"bearing.cage.body": trb.cases.cage_body_30310()})
    assert strains(body, body.growth).rotation > 1.5 * strains(scene, scene.growth).rotation


def test_the_clearance_of_a_land_follows() -> None:
    scene = grown(centrifugal=False, inner_ring_c=90.0, outer_ring_c=70.0)
    for guidance, sign, radius in (("inner_land", 1.0, 39.5e-3), ("outer_land", -1.0, 50.5e-3)):
        led = scene.replace({"effects.guidance": guidance, "bearing.land.clearance": 0.3e-3})
        ring = 12e-6 * (70.0 if guidance == "inner_land" else 50.0) * radius
        cage = 50e-6 * 60.0 * (radius + sign * 0.3e-3)
        assert running_clearance(led) - 0.3e-3 == pytest.approx(sign * (cage - ring), rel=1e-9)
        assert parameter_block(led).tolist().count(running_clearance(led)) == 1


def test_growth_asks_for_what_it_needs() -> None:
    with pytest.raises(trb.InputError, match=r"material\.expansion = None : must be given"):
        grown().replace({"bearing.cage.material": trb.Material(youngs_modulus=3e9, poisson_ratio=0.4)})
    with pytest.raises(
        trb.InputError, match=r"growth\.centrifugal = True : must be false where the speed of a ring changes"
    ):
        grown().replace(speed_rpm=trb.History.ramp(0.0, 1.0, 1000.0, 2000.0))


def test_the_summary_tells_the_plays() -> None:
    result = trb.Simulation(grown(), accuracy="fast").run(revolutions=0.2)
    assert result.summary()["running_play_circumferential"] == grown().running_plays[1]
    assert "circumferential play of the warm" in str(result.summary())
    assert "running_play_radial" not in trb.Simulation(SCENE, accuracy="fast").run(revolutions=0.2).summary()


def test_pockets_of_a_cage_with_unbalance_lie_off_its_centre() -> None:
    """Contacts of the cage with its centre of mass at a place are those of the balanced cage at that place less the distance."""
    plain = trb.Simulation(trb.cases.paper_30310())
    mass, off, direction = plain.scene.bearing.cage.mass, 30e-6, 40.0
    heavy = trb.Simulation(
        plain.scene.replace({"bearing.cage.unbalance": off * mass, "bearing.cage.unbalance_direction_deg": direction})
    )
    vector = plain.state.vector.copy()
    state = plain.view(vector)
    state["cage_x"], state["cage_y"], state["cage_psi"] = 2.9e-4, -1e-5, 0.0
    moved = vector.copy()
    angle = math.radians(direction)
    plain.view(moved)["cage_x"] += off * math.cos(angle)
    plain.view(moved)["cage_y"] += off * math.sin(angle)
    wanted, found = plain.contacts(vector)["pocket_load"], heavy.contacts(moved)["pocket_load"]
    assert np.count_nonzero(wanted) > 2
    assert found == pytest.approx(wanted, rel=1e-6, abs=1e-6)


def test_unbalance_pulls_the_cage_round() -> None:
    """The mean force of the pockets on a cage that turns with its centre of mass off the axis; and lands, which know no such
    cage.
    """
    scene = trb.cases.scene_30310()
    wild = scene.replace({"bearing.cage.unbalance": 20e-6, "gravity": (0.0, 0.0, 0.0)})
    calm = scene.replace({"gravity": (0.0, 0.0, 0.0)})
    orbit = [
        float(trb.Simulation(one, accuracy="fast").run(revolutions=3).orbit_radius_over_cpr[-200:].mean())
        for one in (calm, wild)
    ]
    assert orbit[1] > orbit[0] + 0.1
    with pytest.raises(trb.InputError, match=r"cage\.unbalance = 2e-05 : must be 0 where a land guides"):
        wild.replace({"effects.guidance": "inner_land"})
    with pytest.raises(trb.InputError, match=r"cage\.unbalance = 1\.0 : must be <="):
        scene.replace({"bearing.cage.unbalance": 1.0})
