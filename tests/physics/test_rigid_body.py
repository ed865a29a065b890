"""Bodies that nothing touches move as the equations of a free rigid body say, integrated here in inertial coordinates."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from trbdyn import Effects, History, Result, Simulation

Array = NDArray[np.float64]
LOOSE = Effects.frictionless().replace(pocket_bars=False, pocket_ends=False, front_rib=False)
AWAY = History.table([0.0, 1e-3], [-2e-5, 14e-3])
"""Axial place of a ring that leaves its rollers (m)."""
START = 2e-3
"""When it has gone (s)."""
SPEEDS: dict[str, float | History] = {
    "steady": 3000.0,
    "still": 0.0,
    "run_up": History.ramp(0.0, 12e-3, 500.0, 6000.0),
}


def free_attitude(orientation: Array, spin: Array, inertia: Array, times: Array) -> tuple[list[Rotation], Array]:
    """Attitude and inertial angular velocity of a torque-free body by Euler's equations with a quaternion (x, y, z, w)."""

    def rates(_: float, y: Array) -> Array:
        w = y[4:]
        x, v = y[3], y[:3]
        turn = 0.5 * np.concatenate([x * w + np.cross(v, w), [-v @ w]])
        return np.concatenate([turn, -np.cross(w, inertia * w) / inertia])

    first = Rotation.from_quat(orientation)
    start = np.concatenate([first.as_quat(), first.inv().apply(spin)])
    found = solve_ivp(rates, (times[0], times[-1]), start, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-12)
    attitudes = [Rotation.from_quat(q / np.linalg.norm(q)) for q in found.y[:4].T]
    return attitudes, np.array([a.apply(w) for a, w in zip(attitudes, found.y[4:].T, strict=True)])


def assert_flies_freely(times: Array, quaternion: Array, spin: Array, inertia: list[float], close: float) -> None:
    """Recorded attitudes (w, x, y, z) and angular velocities against the free body's."""
    scalar_last = quaternion[:, [1, 2, 3, 0]].copy()
    attitudes, spins = free_attitude(scalar_last[0], spin[0].copy(), np.array(inertia), times)
    wrong = [(a.inv() * Rotation.from_quat(q)).magnitude() for a, q in zip(attitudes, scalar_last, strict=True)]
    assert max(wrong) < close, max(wrong)
    np.testing.assert_allclose(spin, spins, atol=close * np.linalg.norm(spin[0]))


def assert_falls(times: Array, place: Array, velocity: Array, gravity: Array, close: float) -> None:
    """A parabola."""
    t = (times - times[0])[:, None]
    np.testing.assert_allclose(velocity, velocity[0] + gravity * t, atol=close * 10.0)
    np.testing.assert_allclose(place, place[0] + velocity[0] * t + 0.5 * gravity * t**2, atol=close * 0.1)


GRAVITY = np.array([2.0, -9.0, 4.0])
WAYS = pytest.mark.parametrize(
    ("speed", "integrator"),
    [
        pytest.param(SPEEDS[name], integrator, id=f"{name}-{integrator}")
        for name, integrator in (
            ("steady", "erk"),
            ("still", "bdf"),
            ("run_up", "erk"),
            ("run_up", "bdf"),
            ("run_up", "multirate"),
        )
    ],
)
"""Each speed and each integrator; all integrators where the speed changes."""


def loose_cage(kit: SimpleNamespace, speed: float | History, integrator: str) -> Result:
    """A tilted cage that turns about all its axes, in pockets without faces, while the rollers roll."""
    scenery = {"speed_rpm": speed, "gravity": tuple(GRAVITY)}
    options = kit.tolerances(1e-8 if integrator == "erk" else 1e-7)
    sim = kit.simulate(LOOSE, scenery=scenery, integrator=integrator, **options)
    vector = sim.state.vector
    state = sim.view(vector)
    for name, value in (
        ("x", 1e-3),
        ("y", -2e-3),
        ("skew", 0.25),
        ("tilt", -0.3),
        ("psi", 0.4),
        ("v_x", 0.3),
        ("v_y", 0.2),
    ):
        state[f"cage_{name}"] = value
    for name, value in (("v_z", -0.4), ("omega_n", 60.0), ("omega_t", -45.0), ("omega_a", 80.0)):
        state[f"cage_{name}"] = value
    sim.set_state(vector)
    return sim.run(duration=10e-3, save_every=5e-4)


@WAYS
def test_free_cage(kit: SimpleNamespace, speed: float | History, integrator: str) -> None:
    result = loose_cage(kit, speed, integrator)
    cage = result.scene.bearing.cage
    inertia = [cage.inertia_transverse, cage.inertia_transverse, cage.inertia_axial]
    close = 1e-7 if integrator == "erk" else 2e-5
    assert result.counters["pocket_nodes"] == 0
    assert not result.cage_force.any()
    assert_flies_freely(result.time, result.cage_orientation, result.cage_angular_velocity, inertia, close)
    assert cage.offset == 0.0  # so that the cage's recorded place is that of its centre of mass
    assert_falls(result.time, result.cage_position, result.cage_velocity, GRAVITY, close)


def test_free_cage_precesses(kit: SimpleNamespace) -> None:
    """The axis of a body of revolution circles its angular momentum at |L|/It; momentum and energy stay."""
    result = loose_cage(kit, 3000.0, "erk")
    cage = result.scene.bearing.cage
    attitude = Rotation.from_quat(result.cage_orientation[:, [1, 2, 3, 0]])
    inertia = np.array([cage.inertia_transverse, cage.inertia_transverse, cage.inertia_axial])
    momentum = attitude.apply(attitude.inv().apply(result.cage_angular_velocity.copy()) * inertia)
    np.testing.assert_allclose(
        momentum, np.broadcast_to(momentum[0], momentum.shape), atol=1e-7 * np.linalg.norm(momentum[0])
    )
    along = momentum[0] / np.linalg.norm(momentum[0])
    axis = attitude.apply([0.0, 0.0, 1.0])
    off = axis - np.outer(axis @ along, along)
    np.testing.assert_allclose(axis @ along, axis[0] @ along, atol=1e-7)
    turned = np.unwrap(np.arctan2(np.cross(off[0], off) @ along, off @ off[0]))
    rate = np.linalg.norm(momentum[0]) / cage.inertia_transverse
    np.testing.assert_allclose(turned, rate * (result.time - result.time[0]), atol=1e-6)
    assert turned[-1] > 2.0


def loose_rollers(kit: SimpleNamespace, speed: float | History, **options: Any) -> tuple[Simulation, Result]:
    """Rollers set free between the rings after the inner one has gone, each with its own velocity, attitude and spin."""
    scenery = {"speed_rpm": speed, "gravity": tuple(GRAVITY), "displacement": (0.0, 0.0, AWAY)}
    sim = kit.simulate(LOOSE, scenery=scenery, **options)
    geometry = sim.scene.bearing.geometry
    random, vector = np.random.default_rng(7), sim.state.vector
    state = sim.view(vector)
    now = float(sim.record(vector, START)["shaft_speed"])
    state["roller_r"], state["roller_z"] = -1.1e-3, random.uniform(-2e-4, 2e-4, 12)
    state["roller_psi"] = random.uniform(-0.1, 0.1, 12)
    state["roller_skew"], state["roller_tilt"] = random.uniform(-0.04, 0.04, (2, 12))
    state["roller_v_r"], state["roller_v_z"] = random.uniform(-0.05, 0.05, (2, 12))
    # hardly orbiting: the state holds the difference from the kinematic orbit
    orbit = geometry.cage_speed_ratio * now
    state["roller_v_t"] = random.uniform(-0.4, 0.4, 12) - orbit * geometry.roller_centre_radius
    for name, size in (("omega_n", 8.0), ("omega_t", 8.0), ("omega_a", 80.0)):
        state[f"roller_{name}"] += random.uniform(-size, size, 12)
    sim.set_state(vector, START)
    return sim, sim.run(duration=4e-3, save_every=2e-4)


@WAYS
def test_free_rollers(kit: SimpleNamespace, speed: float | History, integrator: str) -> None:
    sim, result = loose_rollers(
        kit, speed, integrator=integrator, **kit.tolerances(1e-9 if integrator == "erk" else 1e-8)
    )
    geometry = sim.scene.bearing.geometry
    inertia = [geometry.roller_inertia_transverse, geometry.roller_inertia_transverse, geometry.roller_inertia_axial]
    close = 1e-7 if integrator == "erk" else 2e-5
    loads = [field.name for field in result.fields if field.name.endswith(("_load", "pocket_force"))]
    assert {"outer_load", "inner_load"} <= set(loads)
    for load in loads:
        assert not result[load].any(), load
    for j in range(12):
        assert_flies_freely(
            result.time, result.roller_orientation[:, j], result.roller_angular_velocity[:, j], inertia, close
        )
        assert_falls(result.time, result.roller_position[:, j], result.roller_velocity[:, j], GRAVITY, close)


def test_energy_of_free_flight(kit: SimpleNamespace) -> None:
    """Kinetic energy grows by the work of gravity alone."""
    _, result = loose_rollers(kit, 3000.0, integrator="erk", **kit.tolerances(1e-9))
    work = result.work_gravity - result.work_gravity[0]
    assert np.ptp(work) > 1e-4
    np.testing.assert_allclose(result.kinetic_energy - result.kinetic_energy[0], work, atol=1e-9)
    assert not result.work_shaft.any()
