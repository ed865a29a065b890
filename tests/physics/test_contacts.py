"""Contacts against the tests' own kinematics and laws: velocities, sizes and levers of forces, power of a moving ring."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import Bearing, Effects, History, Simulation
from trbdyn.model.bearing import Profile

Array = NDArray[np.float64]
STILL = Effects.frictionless().replace(gravity=False, back_rib=False, front_rib=False)


def vectors(found: dict[str, Array], letter: str) -> Array:
    """Vectors of the nodes of all raceway contacts, shape (2, Z, n, 3)."""
    return np.stack([found[f"raceway_{letter}{axis}"] for axis in "xyz"], axis=-1)


def surface_velocities(
    kit: SimpleNamespace, sim: Simulation, vector: Array, roller: int, points: Array
) -> tuple[Array, Array]:
    """Inertial velocities of the roller's and the inner ring's material at points, in the roller's frame, each (n, 3)."""
    geometry, state, record = sim.scene.bearing.geometry, sim.view(vector), sim.record(vector, 0.0)
    back = kit.about_z(-kit.orbit_angles(sim, vector)[roller])
    place = back.apply(record["roller_position"][roller])
    spin, speed = back.apply(record["roller_angular_velocity"][roller]), back.apply(record["roller_velocity"][roller])
    assert np.allclose(place, kit.roller_place(sim, vector, roller), atol=1e-12)
    assert state["roller_r"].shape == (12,)
    axis = back.apply((kit.frame(-sim.scene.misalignment_x, sim.scene.misalignment_y)).apply([0.0, 0.0, 1.0]))
    centre = back.apply(record["ring_position"] + [0.0, 0.0, geometry.centre_plane])
    ring_spin = float(record["shaft_speed"]) * axis
    return speed + np.cross(spin, points - place), np.cross(ring_spin, points - centre)


def test_surface_velocities(kit: SimpleNamespace) -> None:
    """Sliding is the difference of both surfaces' velocities in the tangent plane, the mean is seen from the orbiting contact."""
    sim = kit.simulate(Effects.paper(), scenery={"misalignment_x": 6e-4})
    vector = kit.perturbed(sim, 14)
    state = sim.view(vector)
    state["roller_skew"] *= 20.0
    found, orbits = sim.contacts(vector, 0.0), sim.record(vector, 0.0)["roller_orbit_speed"]
    points, normals, sliding, mean = (vectors(found, letter) for letter in "pnsm")
    checked = 0
    for j in range(12):
        for race in range(2):
            if not found["raceway_load"][race, j].any():
                continue
            checked += 1
            point, normal = points[race, j], normals[race, j]
            roller, inner = surface_velocities(kit, sim, vector, j, point)
            ring = inner if race == 1 else np.zeros_like(inner)

            def tangent(v: Array, normal: Array = normal) -> Array:
                return v - np.sum(v * normal, axis=-1, keepdims=True) * normal

            orbit = np.cross([0.0, 0.0, orbits[j]], point)
            np.testing.assert_allclose(sliding[race, j], tangent(roller - ring), atol=1e-11)
            np.testing.assert_allclose(mean[race, j], tangent(0.5 * (roller + ring) - orbit), atol=1e-11)
            rate = np.sum((roller - ring) * normal, axis=-1)
            np.testing.assert_allclose(found["raceway_approach"][race, j], rate, atol=1e-11)
    assert checked > 12


def test_interference_rate_is_the_approach(kit: SimpleNamespace) -> None:
    """The rate at which surfaces approach is the growth of their interference along the motion, and that is what damping sees."""
    sim = kit.simulate(Effects.paper())
    vector, step = kit.perturbed(sim, 15), 1e-8
    rates = sim.derivative(vector, 0.0)
    up, down = (sim.contacts(vector + sign * step * rates, sign * step) for sign in (1.0, -1.0))
    found = sim.contacts(vector, 0.0)
    loaded = found["raceway_load"].min(axis=-1) > 0.0
    growth = (up["raceway_interference"] - down["raceway_interference"]) / (2.0 * step)
    assert loaded.sum() > 5
    np.testing.assert_allclose(found["raceway_approach"][loaded], growth[loaded], atol=1e-5)


def pressed(
    kit: SimpleNamespace, face: str, depth: float, **effects: Any
) -> tuple[Simulation, Array, dict[str, Array]]:
    """Only one kind of pocket face, pressed by moving roller 0 from its nominal place towards it, along the face's normal."""
    rig = trb.cases.rig_30310()
    pocket = trb.pocket_shapes.default_pocket(rig)
    only = pocket.without(*(other.name for other in pocket.faces if other.name != face))
    roller = rig.roller.replace(profile=Profile.straight())
    bearing: Bearing = rig.replace(cage=rig.cage.replace(pocket=only), roller=roller)
    sim = kit.simulate(STILL.replace(**effects), scenery={"bearing": bearing, "speed_rpm": 0.0})
    vector = np.zeros_like(sim.state.vector)
    gap = only.gaps(bearing.geometry)[face]
    axes = kit.frame(0.0, bearing.geometry.roller_axis_angle)
    shift = axes.apply(-only.face(face).normal) * (gap + depth)
    place = np.array([bearing.geometry.roller_centre_radius, 0.0, 0.0]) + shift
    state = sim.view(vector)
    state["roller_r"][0], state["roller_z"][0] = (
        np.hypot(place[0], place[1]) - bearing.geometry.roller_centre_radius,
        place[2],
    )
    # the attitude stays, so that the axis leans back by the angle that the orbit has turned
    state["roller_psi"][0] = np.arctan2(place[1], place[0])
    axis = kit.about_z(-state["roller_psi"][0]).apply(axes.apply([0.0, 0.0, 1.0]))
    state["roller_skew"][0] = np.arcsin(axis[1])
    state["roller_tilt"][0] = np.arctan2(axis[0], axis[2]) - bearing.geometry.roller_axis_angle
    return sim, vector, sim.contacts(vector, 0.0)


@pytest.mark.parametrize("face", ["leading_bar", "trailing_bar"])
def test_load_of_a_bar(kit: SimpleNamespace, face: str) -> None:
    """Palmgren's load of a line as long as the contact, at an interference that is the same all along."""
    sim, _, found = pressed(kit, face, 5e-6)
    geometry, length = sim.scene.bearing.geometry, sim.scene.bearing.roller.effective_length
    slot = sim.scene.bearing.slot_names.index(face)
    load = 0.356 * geometry.effective_modulus * length ** (8.0 / 9.0) * 5e-6 ** (10.0 / 9.0)
    assert found["pocket_load"][0, slot] == pytest.approx(load, rel=1e-5)
    assert load == pytest.approx(3206.56 * (length / 20e-3) ** (8.0 / 9.0), rel=2e-3)
    np.testing.assert_allclose(np.linalg.norm(found["cage_force"][0]), load, rtol=1e-5)
    assert found["pocket_interference"][0, slot] == pytest.approx(5e-6, rel=1e-5)


def test_load_of_a_small_end(kit: SimpleNamespace) -> None:
    """Plane on plane: the whole stiffness, whatever the number of vertices that carry it."""
    sim, _, found = pressed(kit, "small_end_wall", 8e-6)
    load = sim.scene.bearing.roller.end_stiffness * 8e-6**1.5
    assert found["pocket_load"].sum() == pytest.approx(load, rel=1e-6)


def test_load_and_lever_of_a_large_end(kit: SimpleNamespace) -> None:
    """A sphere: its friction has the sphere's radius as lever about the sphere's centre, its normal force none."""
    sim, vector, found = pressed(kit, "large_end_wall", 6e-6, lubrication="dry")
    geometry = sim.scene.bearing.geometry
    depth = found["pocket_interference"].max()
    load = sim.scene.bearing.roller.end_stiffness * depth**1.5
    assert found["pocket_load"].sum() == pytest.approx(load, rel=1e-9)
    sim.view(vector)["roller_v_t"][0] = 0.5
    sliding = sim.contacts(vector, 0.0)
    calm = kit.simulate(STILL.replace(lubrication="dry"), scenery={"bearing": sim.scene.bearing, "speed_rpm": 0.0})
    away = vector.copy()
    calm.view(away)["cage_z"] = 1e-3
    race = calm.contacts(away, 0.0)
    assert not race["pocket_load"].any()
    force, moment = sliding["force"][0] - race["force"][0], sliding["moment"][0] - race["moment"][0]
    state = sim.view(vector)
    axis = kit.frame(state["roller_skew"][0], geometry.roller_axis_angle + state["roller_tilt"][0]).apply(
        [0.0, 0.0, 1.0]
    )
    arm = (geometry.sphere_centre - geometry.apex_to_mid - geometry.roller_mass_offset) * axis
    friction = float(sliding["pocket_friction"].sum())
    assert friction > 0.09 * load
    lever = np.linalg.norm(moment - np.cross(arm, force)) / friction
    assert lever == pytest.approx(geometry.sphere_radius - 0.5 * depth, rel=1e-6)


def test_power_of_a_turning_ring(kit: SimpleNamespace) -> None:
    """A ring that is turned far and moved under rollers at rest: its power is the growth of the elastic energy."""
    turn_x, turn_y = History.ramp(0.0, 1e-2, 0.0, 0.08), History.ramp(0.0, 1e-2, 0.0, -0.05)
    shift = (History.ramp(0.0, 1e-2, 0.0, 1e-4), 0.0, History.ramp(0.0, 1e-2, -2e-5, -2e-4))
    scenery = {"speed_rpm": 0.0, "misalignment_x": turn_x, "misalignment_y": turn_y, "displacement": shift}
    effects = STILL.replace(bodies="rollers", back_rib=True, front_rib=True)
    sim = kit.simulate(effects, scenery=scenery)
    vector = sim.state.vector
    for time in (3e-3, 5e-3, 8e-3):
        step = 1e-8
        energies = [sim.contacts(vector, time + sign * step)["elastic_energy"].sum() for sign in (1.0, -1.0)]
        growth = (energies[0] - energies[1]) / (2.0 * step)
        quadratures = sim.view(sim.derivative(vector, time))["quadratures"]
        assert abs(growth) > 1e3
        assert quadratures[1] == pytest.approx(growth, rel=1e-6)


REACH = 8e-5
ROUGH = trb.cases.rig_30310().roughness.pocket


def share(gap: float) -> float:
    """Of the film that the oil there is makes."""
    x = gap / REACH
    return 1.0 - x * x * (3.0 - 2.0 * x)


@pytest.mark.parametrize("face", ["leading_bar", "trailing_bar"])
def test_wedge_between_roller_and_bar(kit: SimpleNamespace, face: str) -> None:
    """Martin's load of a roller that turns near a bar, whichever way; shear and flow take all of the power."""
    gap, spin = 1e-5, 900.0
    sim, vector, _ = pressed(kit, face, -gap, lubrication="full_film", pocket_film=REACH)
    roller, geometry = sim.scene.bearing.roller, sim.scene.bearing.geometry
    eta, slope = sim.scene.lubricant.viscosity, np.cos(geometry.roller_half_angle)
    radius = 0.5 * roller.diameter / slope
    for way in (1.0, -1.0):
        sim.view(vector)["roller_omega_a"][0] = way * spin
        found, record = sim.contacts(vector, 0.0), sim.record(vector, 0.0)
        u = 0.5 * radius * slope * float(np.linalg.norm(record["roller_angular_velocity"][0]))
        load = 4.896 * eta * u * radius / gap * roller.effective_length * share(gap)
        assert found["pocket_load"].sum() == pytest.approx(load, rel=5e-3)
        assert np.linalg.norm(found["cage_force"][0]) == pytest.approx(load, rel=5e-3)
        # sliding at 2 u, and the flow of the pressure
        root = np.sqrt(2.0 * radius / gap) * roller.effective_length * share(gap)
        power = eta * root * u * u * (4.0 * trb.laws.squeeze_shear(0.0) + 12.0 * trb.laws.squeeze_loss(0.0))
        assert float(record["power_pocket_film"]) == pytest.approx(power, rel=5e-3)


@pytest.mark.parametrize("speed", [0.2, -0.2])
def test_roller_that_falls_on_a_bar(kit: SimpleNamespace, speed: float) -> None:
    """The whole film of a cylinder that nears a plane; next to nothing, and no pull, where it leaves the plane."""
    gap = 2e-5
    sim, vector, _ = pressed(kit, "leading_bar", -gap, lubrication="full_film", pocket_film=REACH)
    bearing, state = sim.scene.bearing, sim.view(vector)
    geometry, axes = bearing.geometry, kit.frame(0.0, bearing.geometry.roller_axis_angle)
    towards = axes.apply(-bearing.cage.pocket.face("leading_bar").normal)
    for name, part in zip("rtz", kit.about_z(-float(state["roller_psi"][0])).apply(towards), strict=True):
        state[f"roller_v_{name}"][0] = speed * part
    found = sim.contacts(vector, 0.0)
    radius = 0.5 * bearing.roller.diameter / np.cos(geometry.roller_half_angle)
    load = 3.0 * np.pi * np.sqrt(2.0) * sim.scene.lubricant.viscosity * 0.2 * (radius / gap) ** 1.5
    load *= bearing.roller.effective_length * share(gap)
    if speed > 0.0:
        assert found["pocket_load"].sum() == pytest.approx(load, rel=1e-2)
        assert float(sim.record(vector)["power_pocket_film"]) == pytest.approx(load * speed, rel=1e-2)
    else:
        assert 0.0 < found["pocket_load"].sum() < 1e-6 * load


def test_film_of_a_bar_goes_over_into_contact(kit: SimpleNamespace) -> None:
    """From the farthest oil to dry contact the load has no jump and no kink, and the film is no thinner than the roughness."""
    gaps = np.concatenate([np.linspace(-3e-6, 5e-6, 81), np.linspace(5.5e-6, 1.1 * REACH, 40)])
    loads = []
    for gap in gaps:
        sim, vector, _ = pressed(kit, "leading_bar", -gap, lubrication="full_film", pocket_film=REACH)
        sim.view(vector)["roller_omega_a"][0] = 900.0
        loads.append(float(sim.contacts(vector, 0.0)["pocket_load"].sum()))
    load = np.array(loads)
    assert (load[gaps > REACH] == 0.0).all()
    inside = gaps < REACH
    assert (np.diff(load[inside]) < 0.0).all()
    near = np.flatnonzero(np.abs(gaps - ROUGH) < 0.9 * ROUGH)
    slope = np.gradient(load, gaps)
    assert np.abs(np.diff(slope[near])).max() < 0.2 * np.abs(slope[near]).max()
    assert load[inside][-1] < 1e-3 * load.max()


def test_films_of_bars_only_take_energy(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.standard().replace(pocket_film=2e-4))
    lost = [float(sim.record(kit.perturbed(sim, seed))["power_pocket_film"]) for seed in range(30)]
    assert min(lost) >= 0.0
    assert np.count_nonzero(lost) >= 25
