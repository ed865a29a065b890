"""Scenes, random states and rigid-body sums that the tests of physics share; not taken from the core."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from shared import tolerances

import trbdyn as trb
from trbdyn import Bearing, Effects, Scene, Simulation
from trbdyn.model.pocket import Pocket

Array = NDArray[np.float64]

BODIES = ("r", "psi", "z", "skew", "tilt")
"""Coordinates of a roller; a cage has x and y in place of r, and the same others."""


def scene(effects: Effects | None = None, **changes: Any) -> Scene:
    """The 30310 at 3000 rpm and 4930 N."""
    given = {"bearing": trb.cases.rig_30310(), "speed_rpm": 3000.0, "effects": effects or Effects.paper()}
    if "displacement" not in changes:
        given["axial_load"] = 4930.0
    return Scene(**(given | changes))


def simulate(effects: Effects | None = None, *, scenery: dict[str, Any] | None = None, **options: Any) -> Simulation:
    """A simulation of `scene(effects, **scenery)`."""
    return Simulation(scene(effects, **(scenery or {})), **options)


def perturbed(sim: Simulation, seed: int, *, back: float = 0.0) -> Array:
    """A random state around the present one: loaded and unloaded races, skewed rollers, a tilted cage in contact.

    `back` moves the rollers towards the front rib along their axis (m).
    """
    random = np.random.default_rng(seed)
    vector = sim.state.vector
    state, count = sim.view(vector), sim.scene.bearing.n_rollers
    geometry, cage = sim.scene.bearing.geometry, sim.scene.bearing.cage

    def add(name: str, size: float) -> None:
        state[name] += random.uniform(-size, size, state[name].shape)

    for name, size in (("r", 6e-6), ("z", 4e-6), ("skew", 2e-3), ("tilt", 3e-4)):
        add(f"roller_{name}", size)
    add("roller_psi", 2.0 * cage.play_circumferential / geometry.roller_centre_radius)
    state["roller_r"] -= back * np.sin(geometry.roller_axis_angle)
    state["roller_z"] -= back * np.cos(geometry.roller_axis_angle)
    for name, size in (("v_r", 0.1), ("v_t", 0.3), ("v_z", 0.1), ("omega_n", 5.0), ("omega_t", 5.0), ("omega_a", 50.0)):
        add(f"roller_{name}", size)
    for name, size in (("x", 4e-4), ("y", 4e-4), ("skew", 4e-3), ("tilt", 4e-3), ("psi", 0.3)):
        add(f"cage_{name}", size)
    state["cage_z"] = random.uniform(-1e-4, 5e-4)
    for name, size in (
        ("v_x", 1.0),
        ("v_y", 1.0),
        ("v_z", 1.0),
        ("omega_n", 30.0),
        ("omega_t", 30.0),
        ("omega_a", 30.0),
    ):
        add(f"cage_{name}", size)
    # the cage turns with the rollers, which are spread around their places
    state["cage_psi"] *= 0.003
    assert state["roller_r"].shape == (count,)
    return vector


def frame(skew: float, tilt: float) -> Rotation:
    """Attitude of an axis: turned by `tilt` about the second axis after -`skew` about the first."""
    return Rotation.from_rotvec([0.0, tilt, 0.0]) * Rotation.from_rotvec([-skew, 0.0, 0.0])


def about_z(angle: float) -> Rotation:
    return Rotation.from_rotvec([0.0, 0.0, angle])


def orbit_angles(sim: Simulation, vector: Array) -> Array:
    """Orbit angles of the rollers in R (rad), shape (Z,)."""
    count = sim.scene.bearing.n_rollers
    return 2.0 * np.pi * np.arange(count) / count + sim.view(vector)["roller_psi"]


def frame_angle(sim: Simulation, vector: Array, time: float) -> float:
    """Angle of R (rad)."""
    return sim.scene.bearing.geometry.cage_speed_ratio * float(sim.record(vector, time)["shaft_angle"])


def roller_place(sim: Simulation, vector: Array, roller: int) -> Array:
    """Centre of mass of a roller in its cylindrical frame (m), shape (3,)."""
    geometry, state = sim.scene.bearing.geometry, sim.view(vector)
    radius = geometry.roller_centre_radius + state["roller_r"][roller]
    return np.array([radius, 0.0, geometry.roller_centre_height + state["roller_z"][roller]])


def cage_place(sim: Simulation, vector: Array) -> Array:
    """Centre of mass of the cage in R (m), shape (3,)."""
    state = sim.view(vector)
    height = sim.scene.bearing.geometry.centre_plane + sim.scene.bearing.cage.offset
    return np.array([state["cage_x"], state["cage_y"], height + state["cage_z"]], dtype=float)


def cage_attitude(sim: Simulation, vector: Array) -> Rotation:
    """Attitude of the cage's body in R."""
    state = sim.view(vector)
    return frame(float(state["cage_skew"]), float(state["cage_tilt"])) * about_z(float(state["cage_psi"]))


def balance(sim: Simulation, vector: Array, time: float = 0.0) -> tuple[Array, Array, dict[str, Array]]:
    """What each roller, the rings and the cage get from that roller's contacts, summed: it must vanish.

    Returns
    -------
    force, moment : ndarray, shape (Z, 3)
        Sum of forces (N), and of moments about the apex (N m), in the roller's cylindrical frame.
    found : dict
        What `Simulation.contacts` gives.
    """
    found, height = sim.contacts(vector, time), sim.scene.bearing.geometry.centre_plane
    ring = sim.record(vector, time)["ring_position"] + np.array([0.0, 0.0, height])
    turn = frame_angle(sim, vector, time)
    force, moment = np.empty((2, sim.scene.bearing.n_rollers, 3))
    for j, angle in enumerate(orbit_angles(sim, vector)):
        to_roller = about_z(-angle)
        cage_force = to_roller.apply(found["cage_force"][j])
        cage_moment = to_roller.apply(
            found["cage_moment"][j] + np.cross(cage_place(sim, vector), found["cage_force"][j])
        )
        centre = about_z(-angle - turn).apply(ring)
        force[j] = found["force"][j] + found["ring_force"][j] + found["outer_force"][j] + cage_force
        moment[j] = (
            found["moment"][j]
            + np.cross(roller_place(sim, vector, j), found["force"][j])
            + found["ring_moment"][j]
            + np.cross(centre, found["ring_force"][j])
            + found["outer_moment"][j]
            + cage_moment
        )
    return force, moment, found


def small_faces(bearing: Bearing) -> Pocket:
    """Triangles of about a millimetre on the default faces, where sides and corners are met as often as the inside."""
    pocket = trb.pocket_shapes.default_pocket(bearing)
    corners = {
        "leading_bar": ((-4e-3, -2e-4), (3e-3, -1e-4), (1e-3, 3e-4)),
        "trailing_bar": ((-2e-3, -3e-4), (4e-3, 0.0), (-1e-3, 2e-4)),
        "large_end_wall": ((-1e-4, -5e-5), (1.2e-3, -2e-4), (6e-4, 1e-3)),
        "small_end_wall": ((1e-3, -2e-3), (4e-3, 1e-3), (2e-3, 3e-3)),
    }
    faces = tuple(face.replace(outline=corners[face.name]) for face in pocket.faces)
    return Pocket(faces=faces, allow_interference=True)


@pytest.fixture(scope="session")
def kit() -> SimpleNamespace:
    """The functions of this file."""
    return SimpleNamespace(
        scene=scene,
        simulate=simulate,
        tolerances=tolerances,
        perturbed=perturbed,
        frame=frame,
        about_z=about_z,
        orbit_angles=orbit_angles,
        frame_angle=frame_angle,
        roller_place=roller_place,
        cage_place=cage_place,
        cage_attitude=cage_attitude,
        balance=balance,
        small_faces=small_faces,
    )
