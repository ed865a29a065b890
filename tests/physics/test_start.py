"""A run starts where the equations of motion balance: equilibrium at speed, pure rolling, a cage that rests, whirls or hangs."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trbdyn import Effects, History, InputError
from trbdyn.scene import Start

FREE = Effects.frictionless().replace(gravity=False)
LOADS = {"outer_load": 1832.9, "inner_load": 1812.0, "rib_load": 122.4}
"""Per roller at 4930 N and 3000 rpm (N)."""


def rates(sim: Any) -> dict[str, float]:
    """Largest rate of change of every kind of coordinate at the start."""
    view = sim.view(sim.derivative())
    return {name: float(np.abs(view[name]).max()) for name in view.names}


def test_start_without_friction_is_in_balance(kit: SimpleNamespace) -> None:
    """Every rate vanishes but a roller's tilt: the equilibrium takes the gyroscopic moment at the nominal axis, and the axis is
    tilted by 2e-5, which leaves 1e-4 of it."""
    sim = kit.simulate(FREE)
    found, geometry = rates(sim), sim.scene.bearing.geometry
    mass, transverse = geometry.roller_mass, geometry.roller_inertia_transverse
    for name in ("v_r", "v_t", "v_z"):
        assert found[f"roller_{name}"] * mass < 1e-6, name  # N
    orbit = geometry.cage_speed_ratio * 100.0 * np.pi
    spin = geometry.roller_spin_ratio * 100.0 * np.pi
    gyroscopic = geometry.roller_inertia_axial * spin * orbit * np.sin(geometry.roller_axis_angle)
    assert found["roller_omega_t"] * transverse < 5e-4 * gyroscopic
    for name in ("omega_n", "omega_a"):
        assert found[f"roller_{name}"] * transverse < 1e-12, name  # N m
    for name in ("r", "z", "skew", "tilt", "psi"):
        assert found[f"roller_{name}"] < 1e-12, name
    for name, rate in found.items():
        if name.startswith("cage_"):
            assert rate < 1e-9, name
    assert found["spin_angle"] < 1e-11
    assert found["quadratures"] < 1e-20


def test_start_at_rest_is_in_balance(kit: SimpleNamespace) -> None:
    found = rates(kit.simulate(FREE, scenery={"speed_rpm": 0.0}))
    for name in ("v_r", "v_t", "v_z", "omega_n", "omega_t", "omega_a"):
        assert found[f"roller_{name}"] < 1e-3, name


@pytest.mark.parametrize(
    "scenery",
    [
        {"radial_load": 5530.0},
        {"radial_load": 5530.0, "radial_direction_deg": -37.0},
        {"misalignment_x": 1e-3},
        {"moment_x": 20.0, "moment_y": -10.0},
    ],
    ids=["radial", "radial_oblique", "misaligned", "moment"],
)
def test_contacts_carry_the_load(kit: SimpleNamespace, scenery: dict[str, Any]) -> None:
    """The ring gets from the rollers the opposite of what the scene puts on it, and rollers are in balance in their planes."""
    sim = kit.simulate(FREE, scenery=scenery)
    record, found = sim.record(), rates(sim)
    direction = np.radians(scenery.get("radial_direction_deg", 90.0))
    radial = scenery.get("radial_load", 0.0)
    load = np.array([radial * np.cos(direction), radial * np.sin(direction), -4930.0])
    np.testing.assert_allclose(record["ring_force"], -load, atol=1e-5)
    if "moment_x" in scenery:
        np.testing.assert_allclose(record["ring_moment"][:2], [-20.0, 10.0], atol=1e-5)
    mass = sim.scene.bearing.geometry.roller_mass
    assert found["roller_v_r"] * mass < 1e-5
    assert found["roller_v_z"] * mass < 1e-5


@pytest.mark.parametrize("effects", [Effects.paper(), Effects.standard()], ids=["paper", "standard"])
def test_loads_settle(kit: SimpleNamespace, effects: Effects) -> None:
    """Friction and the cage move the mean loads of a roller by less than a newton."""
    result = kit.simulate(effects).run(revolutions=3.0)
    late = result.window(result.time[-1] / 2.0)
    for name, load in LOADS.items():
        assert result[name][0].mean() == pytest.approx(load, abs=0.2)
        assert late[name].mean() == pytest.approx(load, abs=0.5)


def test_cage_rests_on_its_rollers(kit: SimpleNamespace) -> None:
    """It hangs down until a face touches, no further; touching carries nothing yet."""
    sim = kit.simulate(Effects.paper())
    deepest = sim.contacts()["pocket_interference"].max()
    assert -2e-10 < deepest <= 0.0
    place = sim.record()["cage_position"]
    play = sim.scene.bearing.cage.play_radial
    assert place[1] < -0.2 * play
    assert abs(place[0]) < 1e-12
    assert not sim.record()["pocket_force"].any()


def test_cage_rests_the_way_gravity_points(kit: SimpleNamespace) -> None:
    place = kit.simulate(Effects.paper(), scenery={"gravity": (9.81, 0.0, 0.0)}).record()["cage_position"]
    assert place[0] > 5e-5
    assert abs(place[1]) < 1e-12


def test_whirling_start(kit: SimpleNamespace) -> None:
    """The cage at 0.9 Cpr turns about the bearing axis with its own speed; rollers stand in the middle of their pockets."""
    sim = kit.simulate(Effects.paper(), scenery={"start": Start.whirl(0.9, direction_deg=30.0)})
    record, geometry = sim.record(), sim.scene.bearing.geometry
    place, velocity, play = record["cage_position"], record["cage_velocity"], sim.scene.bearing.cage.play_radial
    assert np.hypot(*place[:2]) == pytest.approx(0.9 * play, rel=1e-12)
    assert np.arctan2(place[1], place[0]) == pytest.approx(np.radians(30.0), rel=1e-12)
    orbit = geometry.cage_speed_ratio * 100.0 * np.pi
    np.testing.assert_allclose(velocity[:2], orbit * np.array([-place[1], place[0]]), rtol=1e-12)
    gaps = -sim.contacts()["pocket_interference"]
    # the roller stands on the ray to its pocket's middle, the pocket leans against it by a third of a degree
    np.testing.assert_allclose(gaps[:, 0], gaps[:, 1], atol=2e-6)
    assert gaps.min() > 0.0


def test_unequal_start(kit: SimpleNamespace) -> None:
    """Seeded: the same places for the same seed, others for another, all within the pockets' play."""
    one, again, other = (
        kit.simulate(Effects.paper(), scenery={"start": Start.unequal(seed)}).view()["roller_psi"].copy()
        for seed in (3, 3, 4)
    )
    np.testing.assert_array_equal(one, again)
    assert np.abs(one - other).max() > 1e-4
    bearing = kit.scene().bearing
    assert np.abs(one).max() * bearing.pitch_diameter / 2.0 <= 0.8 * bearing.cage.play_circumferential


def test_start_from_a_saved_state(kit: SimpleNamespace) -> None:
    """A state of another run, with its time: place, velocity and angle are those of then."""
    first = kit.simulate(Effects.standard())
    first.run(duration=3e-3)
    saved = first.state
    second = kit.simulate(Effects.standard(), scenery={"start": Start.state(saved.vector, time=saved.time)})
    assert second.time == saved.time
    np.testing.assert_array_equal(second.state.vector, saved.vector)
    one, other = first.record(), second.record()
    for name, values in one.items():
        np.testing.assert_array_equal(values, other[name], err_msg=name)
    with pytest.raises(InputError, match="state_vector"):
        kit.simulate(Effects.standard(), scenery={"start": Start.state(saved.vector[:-1])})


def test_ring_follows_its_load(kit: SimpleNamespace) -> None:
    """Long after a change of load the ring stands, and the contacts carry, what a start at the new load gives."""
    history = History.ramp(0.0, 5e-3, 4930.0, 8000.0)
    scenery = {"axial_load": history, "ring": "follows"}
    sim = kit.simulate(Effects.standard().replace(gravity=False), scenery=scenery)
    result = sim.run(duration=12e-3, save_every=1e-4)
    target = kit.simulate(Effects.standard(), scenery={"axial_load": 8000.0}).equilibrium
    np.testing.assert_allclose(result.ring_position[-1], target.displacement[:3], atol=1e-12)
    assert result.ring_force[0, 2] == pytest.approx(4930.0, rel=1e-3)
    assert result.ring_force[-1, 2] == pytest.approx(8000.0, rel=2e-3)
    held = kit.simulate(Effects.standard()).run(duration=1e-3)
    assert np.ptp(held.ring_position, axis=0).max() == 0.0
