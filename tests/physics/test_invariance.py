"""Forces do not depend on where around the bearing axis the whole bearing stands, nor on a mirror image of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from trbdyn import Effects, Simulation

Array = NDArray[np.float64]
WRENCHES = ("force", "moment", "ring_force", "ring_moment", "outer_force", "outer_moment")
SHIFT = np.array([8e-6, -5e-6, -2e-5])
TURN = np.array([4e-4, -7e-4])
ALL = {
    "paper": Effects.paper().replace(gravity=False),
    "standard": Effects.standard().replace(gravity=False),
    "dry": Effects.paper().replace(gravity=False, lubrication="dry"),
}


def placed(kit: SimpleNamespace, effects: Effects, shift: Array, turn: Array, **scenery: Any) -> Simulation:
    """A simulation whose ring stands at a given place."""
    given = {"displacement": tuple(shift.tolist()), "misalignment_x": turn[0], "misalignment_y": turn[1]}
    return kit.simulate(effects, scenery=given | scenery)


def turned_cage(sim: Simulation, vector: Array, by: Rotation, attitude: Rotation) -> None:
    """Turn the cage's place and velocity about z in the state and give it an attitude; spins stay those of the body."""
    state = sim.view(vector)
    old = Rotation.from_rotvec([0, state["cage_tilt"], 0]) * Rotation.from_rotvec([-state["cage_skew"], 0, 0])
    speed = sim.scene.bearing.geometry.cage_speed_ratio * float(sim.record(vector)["shaft_speed"])
    spin = np.array([state["cage_omega_n"], state["cage_omega_t"], speed + state["cage_omega_a"]])
    spin = by.apply(old.apply(spin))
    x, y, _ = by.apply([state["cage_x"], state["cage_y"], 0.0])
    v_x, v_y, _ = by.apply([state["cage_v_x"], state["cage_v_y"], 0.0])
    axis = attitude.apply([0.0, 0.0, 1.0])
    skew, tilt = np.arcsin(axis[1]), np.arctan2(axis[0], axis[2])
    new = Rotation.from_rotvec([0, tilt, 0]) * Rotation.from_rotvec([-skew, 0, 0])
    spin = new.inv().apply(spin)
    state["cage_x"], state["cage_y"], state["cage_v_x"], state["cage_v_y"] = x, y, v_x, v_y
    state["cage_skew"], state["cage_tilt"] = skew, tilt
    state["cage_psi"] = (new.inv() * attitude).as_rotvec()[2]
    state["cage_omega_n"], state["cage_omega_t"], state["cage_omega_a"] = spin[0], spin[1], spin[2] - speed


def assert_same(one: Array, other: Array, name: str) -> None:
    size = max(float(np.abs(one).max()), 1.0)
    np.testing.assert_allclose(other, one, atol=1e-8 * size, rtol=0, err_msg=name)


@pytest.mark.parametrize("effects", ALL.values(), ids=ALL)
@pytest.mark.parametrize("angle", [0.3, 2.0 * np.pi / 12.0, -2.5])
def test_turning_everything_changes_nothing(kit: SimpleNamespace, effects: Effects, angle: float) -> None:
    """Rollers, cage and the displaced, misaligned ring turned about z by any angle, with gravity off."""
    by = kit.about_z(angle)
    turned = by.apply([*TURN, 0.0])[:2]
    one, other = placed(kit, effects, SHIFT, TURN), placed(kit, effects, by.apply(SHIFT), turned)
    vector = kit.perturbed(one, 11)
    moved = vector.copy()
    other.view(moved)["roller_psi"] += angle
    turned_cage(other, moved, by, by * kit.cage_attitude(one, vector))
    before, after = one.contacts(vector, 0.0), other.contacts(moved, 0.0)
    assert before["pocket_load"].max() > 0.0
    for name in (*WRENCHES, "pocket_load", "elastic_energy", "power", "rib_load", "raceway_load"):
        assert_same(before[name], after[name], name)
    for name in ("cage_force", "cage_moment"):
        assert_same(by.apply(before[name]), after[name], name)


@pytest.mark.parametrize("places", [1, 5])
def test_rollers_are_interchangeable(kit: SimpleNamespace, places: int) -> None:
    """Every roller in the next one's place, and the bearing turned by as many pockets: the same forces, at new numbers."""
    angle = 2.0 * np.pi * places / 12.0
    by = kit.about_z(angle)
    effects = ALL["standard"]
    one = placed(kit, effects, SHIFT, TURN)
    other = placed(kit, effects, by.apply(SHIFT), by.apply([*TURN, 0.0])[:2])
    vector = kit.perturbed(one, 12)
    moved = vector.copy()
    state, old = other.view(moved), one.view(vector)
    for name in old.names:
        if name.startswith("roller_"):
            state[name] = np.roll(old[name], places)
    turned_cage(other, moved, by, by * kit.cage_attitude(one, vector) * by.inv())
    before, after = one.contacts(vector, 0.0), other.contacts(moved, 0.0)
    assert before["pocket_load"].max() > 0.0
    for name in (*WRENCHES, "pocket_load"):
        assert_same(np.roll(before[name], places, axis=0), after[name], name)
    rates, moved_rates = one.view(one.derivative(vector, 0.0)), other.view(other.derivative(moved, 0.0))
    for name in old.names:
        if name.startswith("roller_"):
            assert_same(np.roll(rates[name], places), moved_rates[name], name)
    np.testing.assert_allclose(moved_rates["quadratures"], rates["quadratures"], rtol=1e-9, atol=1e-6)


MIRRORED = ("psi", "skew", "v_t", "omega_n", "omega_a")
"""Coordinates of a roller that change sign when y does."""
MIRRORED_CAGE = ("y", "skew", "psi", "v_y", "omega_n", "omega_a")


def mirror(sim: Simulation, vector: Array) -> Array:
    """The state with y reflected: roller j takes the place of roller -j, the cage's pockets likewise."""
    image = vector.copy()
    state, old = sim.view(image), sim.view(vector)
    numbers = -np.arange(sim.scene.bearing.n_rollers) % sim.scene.bearing.n_rollers
    for name in old.names:
        kind, _, part = name.partition("_")
        if kind == "roller":
            state[name] = old[name][numbers] * (-1.0 if part in MIRRORED else 1.0)
        elif kind == "cage":
            state[name] = old[name] * (-1.0 if part in MIRRORED_CAGE else 1.0)
    return image


@pytest.mark.parametrize("effects", ALL.values(), ids=ALL)
def test_mirror_image_at_reversed_speed(kit: SimpleNamespace, effects: Effects) -> None:
    flip = np.array([1.0, -1.0, 1.0])
    one = placed(kit, effects, SHIFT, TURN)
    other = placed(kit, effects, SHIFT * flip, TURN * [-1.0, 1.0], speed_rpm=-3000.0)
    vector = kit.perturbed(one, 13)
    image = mirror(one, vector)
    before, after = one.contacts(vector, 0.0), other.contacts(image, 0.0)
    numbers = -np.arange(12) % 12
    assert before["pocket_load"][:, :2].max(axis=0).min() > 0.0
    for name in (*WRENCHES, "cage_force", "cage_moment"):
        sign = -flip if name.endswith("moment") else flip
        assert_same(before[name][numbers] * sign, after[name], name)
    # leading and trailing bar change places
    assert_same(before["pocket_load"][numbers][:, [1, 0, 2, 3]], after["pocket_load"], "pocket_load")
    assert_same(before["power"][numbers], after["power"], "power")
    rates = other.derivative(image, 0.0)
    expected = mirror(one, one.derivative(vector, 0.0))
    view, wanted = other.view(rates), one.view(expected)
    for name in view.names:
        if name.startswith(("roller_", "cage_", "quadratures")):
            assert_same(wanted[name], view[name], name)


def test_reversed_run_is_the_mirror_image(kit: SimpleNamespace) -> None:
    """A whole run with the other sense of rotation: the same loads, spacings and torques, the cage's path reflected."""
    effects = Effects.standard().replace(gravity=False)
    runs = []
    for speed in (3000.0, -3000.0):
        # every force exact: a tangent's reach turns on roundings, which the mirror does not share
        sim = kit.simulate(effects, scenery={"speed_rpm": speed}, accuracy="reference", rings_share=0.0)
        vector = sim.state.vector
        state = sim.view(vector)
        state["cage_v_x"], state["cage_v_y"], state["cage_v_z"] = 0.05, 0.08 * np.sign(speed), 0.02
        sim.set_state(vector)
        runs.append(sim.run(duration=2e-3, save_every=1e-4))
    one, other = runs
    numbers = -np.arange(12) % 12
    flip = np.array([1.0, -1.0, 1.0])
    assert one.pocket_force.max() > 1.0
    np.testing.assert_allclose(other.cage_position, one.cage_position * flip, atol=1e-9)
    np.testing.assert_allclose(other.outer_load, one.outer_load[:, numbers], rtol=1e-4)
    np.testing.assert_allclose(other.inner_torque, one.inner_torque, rtol=1e-4)
    np.testing.assert_allclose(other.outer_torque, one.outer_torque, rtol=1e-4)
    np.testing.assert_allclose(other.power_loss, one.power_loss, rtol=1e-4)
