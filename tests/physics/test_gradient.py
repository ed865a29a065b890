"""Frictionless contact forces are the gradient of the elastic energy in every coordinate of rollers, cage and ring, at faces,
edges and corners alike. Virtual displacements come from the tests' own kinematics."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import trbdyn as trb
from trbdyn import Effects, Simulation
from trbdyn.model.pocket import Face

Array = NDArray[np.float64]
FREE = Effects.frictionless().replace(gravity=False)
STEP = {"r": 3e-10, "x": 3e-10, "y": 3e-10, "z": 3e-10, "psi": 1e-8, "skew": 1e-8, "tilt": 1e-8}
CLOSE = 2e-6
"""Error of a difference over the largest force, or moment at an arm of 10 mm: the law bends within a step where a node has just
touched."""
ARM = 0.01


def energy(sim: Simulation, vector: Array) -> Array:
    return sim.contacts(vector, 0.0)["elastic_energy"].ravel()


def slope(sim: Simulation, vector: Array, name: str) -> Array:
    """Minus the derivative of each roller's elastic energy by a coordinate, of all rollers at once or of the cage."""
    step = STEP[name.partition("_")[2]]
    up, down = vector.copy(), vector.copy()
    sim.view(up)[name] += step
    sim.view(down)[name] -= step
    return -(energy(sim, up) - energy(sim, down)) / (2.0 * step)


def displaced(kit: SimpleNamespace, sim: Simulation, vector: Array, roller: int, name: str) -> tuple[Array, Array]:
    """How a roller's centre moves and its frame turns per unit of a coordinate, in R."""
    places, attitudes = [], []
    for sign in (1.0, -1.0):
        moved = vector.copy()
        state = sim.view(moved)
        state[f"roller_{name}"][roller] += sign * 1e-6
        turn = kit.about_z(kit.orbit_angles(sim, moved)[roller])
        places.append(turn.apply(kit.roller_place(sim, moved, roller)))
        tilt = sim.scene.bearing.geometry.roller_axis_angle + state["roller_tilt"][roller]
        attitudes.append(turn * kit.frame(state["roller_skew"][roller], tilt))
    return (places[0] - places[1]) / 2e-6, (attitudes[0] * attitudes[1].inv()).as_rotvec() / 2e-6


def displaced_cage(kit: SimpleNamespace, sim: Simulation, vector: Array, name: str) -> tuple[Array, Array]:
    places, attitudes = [], []
    for sign in (1.0, -1.0):
        moved = vector.copy()
        sim.view(moved)[f"cage_{name}"] += sign * 1e-6
        places.append(kit.cage_place(sim, moved))
        attitudes.append(kit.cage_attitude(sim, moved))
    return (places[0] - places[1]) / 2e-6, (attitudes[0] * attitudes[1].inv()).as_rotvec() / 2e-6


def scale(found: dict[str, Any], name: str) -> float:
    """Size of the generalised forces of a coordinate."""
    size = float(np.abs(found["force"]).max() + np.abs(found["cage_force"]).max())
    return size * (ARM if name in ("psi", "skew", "tilt") else 1.0)


def assert_gradient(kit: SimpleNamespace, sim: Simulation, vector: Array) -> dict[str, Any]:
    """Every coordinate of every roller and of the cage."""
    found = sim.contacts(vector, 0.0)
    for name in ("r", "psi", "z", "skew", "tilt"):
        wanted = np.empty(12)
        for j, angle in enumerate(kit.orbit_angles(sim, vector)):
            turn = kit.about_z(angle)
            shift, spin = displaced(kit, sim, vector, j, name)
            wanted[j] = turn.apply(found["force"][j]) @ shift + turn.apply(found["moment"][j]) @ spin
        error = np.abs(slope(sim, vector, f"roller_{name}") - wanted).max()
        assert error < CLOSE * scale(found, name), (name, error, scale(found, name))
    for name in ("x", "y", "z", "skew", "tilt", "psi"):
        shift, spin = displaced_cage(kit, sim, vector, name)
        wanted = found["cage_force"] @ shift + found["cage_moment"] @ spin
        error = np.abs(slope(sim, vector, f"cage_{name}") - wanted).max()
        assert error < 5.0 * CLOSE * scale(found, name), (name, error, scale(found, name))
    return found


BODIES = {
    "raceways": (FREE.replace(bodies="rollers", back_rib=False, front_rib=False), 0.0, "raceway_load"),
    "back_rib": (FREE.replace(bodies="rollers", front_rib=False), 0.0, "rib_load"),
    "front_rib": (FREE.replace(bodies="rollers", back_rib=False), 2.5e-4, "front_rib_load"),
    "pocket": (FREE, 0.0, "pocket_load"),
    "pocket_unbounded": (FREE.replace(pocket_edges=False), 0.0, "pocket_load"),
}


@pytest.mark.parametrize("kind", BODIES)
def test_forces_are_the_gradient(kit: SimpleNamespace, kind: str) -> None:
    effects, back, load = BODIES[kind]
    sim = kit.simulate(effects.replace(n_slices=40), scenery={"misalignment_x": 1e-3, "misalignment_y": -5e-4})
    loaded = 0
    for seed in range(3):
        found = assert_gradient(kit, sim, kit.perturbed(sim, 20 + seed, back=back))
        loaded += int(np.count_nonzero(found[load] > 0.0))
    assert loaded > 5


@pytest.mark.parametrize("effects", [FREE.replace(bodies="rollers"), FREE], ids=["rollers", "with_cage"])
@pytest.mark.parametrize("back", [0.0, 2.5e-4])
def test_ring_forces_are_the_gradient(kit: SimpleNamespace, effects: Effects, back: float) -> None:
    """Elastic energy against the ring's five coordinates: raceway, back-face and front rib together."""
    place = np.array([6e-6, -4e-6, -2.5e-5, 6e-4, -8e-4])

    def ring(at: Array) -> Simulation:
        scenery = {"displacement": tuple(at[:3].tolist()), "misalignment_x": at[3], "misalignment_y": at[4]}
        return kit.simulate(effects, scenery=scenery)

    sim = ring(place)
    vector = kit.perturbed(sim, 31, back=back)
    record = sim.record(vector, 0.0)
    assert record["inner_load"].max() > 0.0
    assert record["front_rib_load" if back else "rib_load"].max() > 0.0
    force, moment = record["ring_force"], record["ring_moment"]
    for column in range(5):
        step = 3e-10 if column < 3 else 1e-8
        up, down = place.copy(), place.copy()
        up[column] += step
        down[column] -= step
        found = -(energy(ring(up), vector).sum() - energy(ring(down), vector).sum()) / (2.0 * step)
        if column < 3:
            wanted, size = force[column], np.abs(force).max()
        else:
            turns = [
                ring_attitude(at[3:] + sign * 1e-6 * np.eye(2)[column - 3]) for at, sign in ((place, 1), (place, -1))
            ]
            wanted = moment @ (turns[0] * turns[1].inv()).as_rotvec() / 2e-6
            size = np.abs(moment).max() + ARM * np.abs(force).max()
        assert abs(found - wanted) < 5.0 * CLOSE * size, (column, found, wanted)


def ring_attitude(turn: Array) -> Rotation:
    return Rotation.from_rotvec([*turn, 0.0])


def regions(kit: SimpleNamespace, sim: Simulation, vector: Array, face: Face, slices: int) -> dict[str, int]:
    """How many inscribed spheres touch a face inside its outline, at a side and at a corner, by the tests' own geometry."""
    geometry, half = sim.scene.bearing.geometry, 0.5 * sim.scene.bearing.roller.effective_length
    centre, attitude = kit.cage_place(sim, vector), kit.cage_attitude(sim, vector)
    corners, counts = np.array(face.outline), {"inside": 0, "side": 0, "corner": 0}
    if face.part == "flank":
        stations = half * (2.0 * (np.arange(slices) + 0.5) / slices - 1.0)
        radii = (geometry.apex_to_mid + stations) * np.tan(geometry.roller_half_angle)
        along, sphere = (
            stations + radii * np.tan(geometry.roller_half_angle),
            radii / np.cos(geometry.roller_half_angle),
        )
    else:
        along, sphere = np.array([geometry.sphere_centre - geometry.apex_to_mid]), np.array([geometry.sphere_radius])
    for j, angle in enumerate(kit.orbit_angles(sim, vector)):
        pocket = attitude * kit.about_z(2.0 * np.pi * j / 12.0) * kit.frame(0.0, geometry.roller_axis_angle)
        middle = np.array(
            [geometry.apex_to_mid * np.sin(geometry.roller_axis_angle), 0.0, -sim.scene.bearing.cage.offset]
        )
        origin = centre + (attitude * kit.about_z(2.0 * np.pi * j / 12.0)).apply(middle)
        state = sim.view(vector)
        turn = kit.about_z(angle)
        axis = (turn * kit.frame(state["roller_skew"][j], geometry.roller_axis_angle + state["roller_tilt"][j])).apply(
            [0, 0, 1]
        )
        place = turn.apply(kit.roller_place(sim, vector, j)) + np.outer(along - geometry.roller_mass_offset, axis)
        points = pocket.inv().apply(place - origin)
        touching = sphere - face.distance(points) > 0.0
        flat = np.stack([(points - face.origin) @ face.u, (points - face.origin) @ face.v], axis=-1)[touching]
        sides = np.roll(corners, -1, axis=0) - corners
        offset = flat[:, None, :] - corners
        outside = sides[:, 0] * offset[..., 1] - sides[:, 1] * offset[..., 0] < 0.0
        share = np.sum(offset * sides, axis=-1) / np.sum(sides**2, axis=-1)
        at_side = np.any(outside & (share > 0.0) & (share < 1.0), axis=-1)
        inside = ~np.any(outside, axis=-1)
        counts["inside"] += int(inside.sum())
        counts["side"] += int((at_side & ~inside).sum())
        counts["corner"] += int((~at_side & ~inside).sum())
    return counts


def test_sides_and_corners_of_pocket_faces(kit: SimpleNamespace) -> None:
    """Small triangular faces: forces at their insides, sides and corners are the gradient of one energy."""
    rig = trb.cases.rig_30310()
    bearing = rig.replace(
        cage=rig.cage.replace(pocket=kit.small_faces(rig)),
        roller=rig.roller.replace(profile=trb.Profile.straight()),
    )
    slices = 200
    sim = kit.simulate(FREE.replace(n_slices=slices), scenery={"bearing": bearing})
    total: dict[str, dict[str, int]] = {}
    loads = np.zeros(4)
    for seed in range(6):
        vector = kit.perturbed(sim, 40 + seed)
        sim.view(vector)["cage_z"] = 4e-4 if seed % 2 else -1e-5
        found = assert_gradient(kit, sim, vector)
        loads = np.maximum(loads, found["pocket_load"].max(axis=0))
        for face in bearing.cage.pocket.faces:
            if face.part != "small_end":
                for region, count in regions(kit, sim, vector, face, slices).items():
                    part = total.setdefault(face.part, {})
                    part[region] = part.get(region, 0) + count
    assert loads.min() > 0.0, loads
    assert min(total["flank"].values()) > 5, total
    assert min(total["large_end"].values()) > 0, total


SHAPES = ["default", "drafted", "stepped", "relieved", "chamfered", "one_sided"]


@pytest.mark.parametrize("shape", SHAPES)
def test_every_shipped_pocket_shape(kit: SimpleNamespace, shape: str) -> None:
    rig = trb.cases.rig_30310()
    arguments = {"drafted": {"lean_deg": 15.0}}.get(shape, {})
    bearing = rig.replace(cage=rig.cage.replace(pocket=trb.pocket_shapes.SHAPES[shape](rig, **arguments)))
    sim = kit.simulate(FREE, scenery={"bearing": bearing})
    found = assert_gradient(kit, sim, kit.perturbed(sim, 50))
    assert found["pocket_load"].max() > 0.0
