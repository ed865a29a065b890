"""Interference of the core against points sampled on the surfaces: discs' rims, the large end's sphere, edges of ribs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from trbdyn import Effects, Simulation, cases
from trbdyn.model.bearing import Bearing, Profile

Array = NDArray[np.float64]
SKEW, TILT = 5e-3, 2e-4
AGREED = 2e-10
"""Inscribed spheres and rims of discs agree within 2e-4 um at 5 mrad of skew and 0.2 mrad of tilt; it grows as tilt^2."""


def rim(radius: Array, station: Array, around: Array) -> Array:
    """Points of discs in the roller's axes, shape (stations, angles, 3)."""
    axial = np.broadcast_to(station[:, None], (station.size, around.size))
    return np.stack([radius[:, None] * np.cos(around), radius[:, None] * np.sin(around), axial], axis=-1)


def stations_and_radii(sim: Simulation, roller: int) -> tuple[Array, Array]:
    """Stations of the slices from mid length and the flank's radius there, from the definition of the roller."""
    bearing, n = sim.scene.bearing, sim.scene.effects.n_slices
    station = 0.5 * bearing.roller.effective_length * ((2.0 * np.arange(n) + 1.0) / n - 1.0)
    shape, half = bearing.roller.profile, 0.5 * bearing.roller.effective_length
    drop = np.zeros(n)
    if shape.kind == "logarithmic":
        modulus = bearing.geometry.effective_modulus
        amplitude = 2 * shape.k1 * shape.load / (math.pi * bearing.roller.effective_length * modulus)
        t = np.maximum((np.abs(station) - half) / (shape.k2 * half) + 1.0, 0.0)
        drop = -amplitude * np.log(1.0 - (1.0 - math.exp(-shape.zm / amplitude)) * t**2)
    geometry = bearing.geometry
    radius = (geometry.apex_to_mid + station) * math.tan(geometry.roller_half_angle)
    return station, radius + 0.5 * bearing.diameter_deviation[roller] - drop


def deepest_of_rims(sim: Simulation, vector: Array, roller: int, race: int, places: Any, cone: Any) -> Array:
    """Largest interference of every disc's rim with a race, shape (n,): samples refined about the deepest one."""
    at = places(sim, vector)
    placed, ring, geometry = at.roller(roller), at.ring(), sim.scene.bearing.geometry
    station, radius = stations_and_radii(sim, roller)
    if race == 0:
        apex, axis, angle, sign = (
            np.zeros(3),
            np.array([0.0, 0.0, 1.0]),
            math.radians(sim.scene.bearing.cup_half_angle_deg),
            1,
        )
    else:
        apex, axis, angle, sign = ring.origin, ring.axes[:, 2], geometry.cone_half_angle, -1

    def depth(around: Array) -> Array:
        return sign * cone(placed.points(rim(radius, station, around)), apex, axis, angle)

    middle = 0.0 if race == 0 else math.pi
    for width in (1.5, 0.05, 1e-3):
        around = middle + np.linspace(-width, width, 401)
        found = depth(around)
        middle = float(around[np.argmax(found.max(axis=0))])
    # the deepest points of all discs lie close together
    return np.array(depth(middle + np.linspace(-0.02, 0.02, 4001)).max(axis=1))


def random_state(sim: Simulation, seed: int, skew: float = SKEW, tilt: float = TILT) -> Array:
    """Rollers of a state moved and turned at random, half of them by the most."""
    random, vector = np.random.default_rng(seed), sim.state.vector
    state, count = sim.view(vector), sim.scene.bearing.n_rollers
    for part, size in (("skew", skew), ("tilt", tilt)):
        state[f"roller_{part}"] += size * np.where(
            random.random(count) < 0.5, random.choice([-1, 1], count), random.uniform(-1, 1, count)
        )
    for part, size in (("r", 2e-6), ("z", 5e-6), ("psi", 1e-3)):
        state[f"roller_{part}"] += size * random.uniform(-1.0, 1.0, count)
    return vector


@pytest.fixture(scope="module", params=["straight", "logarithmic", "misaligned", "scattered", "32216"])
def sim(request: pytest.FixtureRequest, rig: Bearing, straight_rig: Bearing) -> Simulation:
    effects = Effects.paper().replace(n_slices=31)
    if request.param == "32216":
        bearing = cases.bearing_32216().replace({"roller.profile": Profile.logarithmic(1391.0)})
        return Simulation(cases.scene_32216(0.0, bearing=bearing, effects=effects))
    if request.param == "scattered":
        deviation = tuple(np.random.default_rng(1).uniform(-1e-6, 1e-6, 12))
        rig = rig.replace(roller=rig.roller.replace(diameter_deviation=deviation))
    turn = {"misalignment_x": 4e-4, "misalignment_y": -6e-4} if request.param == "misaligned" else {}
    bearing = straight_rig if request.param == "straight" else rig
    return Simulation(cases.scene_30310(0.0, 8000.0, 3000.0, bearing=bearing, effects=effects, **turn))


@pytest.mark.parametrize("race", [0, 1], ids=["outer", "inner"])
def test_discs_on_races(sim: Simulation, race: int, places: Any, cone_distance: Any) -> None:
    vector = random_state(sim, 5)
    found = sim.contacts(vector)["raceway_interference"][race]
    compared = 0
    for roller in range(sim.scene.bearing.n_rollers):
        if not found[roller].any():
            continue  # nothing of it touches: the core keeps no nodes
        exact = deepest_of_rims(sim, vector, roller, race, places, cone_distance)
        tilt = abs(sim.view(vector)["roller_tilt"][roller]) + race * np.linalg.norm(sim.equilibrium.displacement[3:])
        assert found[roller] == pytest.approx(exact, rel=0.0, abs=AGREED * max(1.0, (tilt / TILT) ** 2))
        compared += 1
    assert compared >= 6


def test_the_comparison_sees_a_tenth_of_a_nanometre(rig: Bearing, places: Any, cone_distance: Any) -> None:
    """Without skew and tilt sphere and rim touch in the same point."""
    sim = Simulation(cases.scene_30310(0.0, 4930.0, bearing=rig, effects=Effects.paper().replace(n_slices=31)))
    vector = random_state(sim, 6, skew=0.0, tilt=0.0)
    sim.view(vector)["roller_tilt"] = 0.0
    found = sim.contacts(vector)["raceway_interference"]
    for race in (0, 1):
        exact = deepest_of_rims(sim, vector, 4, race, places, cone_distance)
        assert found[race, 4] == pytest.approx(exact, rel=0.0, abs=2e-12)


def test_normals_and_points(sim: Simulation, places: Any, cone_distance: Any) -> None:
    """The contact point lies midway between both surfaces, the normal is the race's there."""
    vector = random_state(sim, 7)
    found, at = sim.contacts(vector), places(sim, vector)
    for roller in range(sim.scene.bearing.n_rollers):
        angle = 2 * math.pi * roller / sim.scene.bearing.n_rollers + at.state["roller_psi"][roller]
        turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
        for race, sign in ((0, 1.0), (1, -1.0)):
            depth = found["raceway_interference"][race, roller]
            if not depth.any():
                continue
            point = np.stack([found[f"raceway_p{c}"][race, roller] for c in "xyz"], axis=-1) @ turn.T
            normal = np.stack([found[f"raceway_n{c}"][race, roller] for c in "xyz"], axis=-1) @ turn.T
            ring = at.ring()
            cone = (np.zeros(3), np.array([0.0, 0.0, 1.0])) if race == 0 else (ring.origin, ring.axes[:, 2])
            half = (
                math.radians(sim.scene.bearing.cup_half_angle_deg)
                if race == 0
                else sim.scene.bearing.geometry.cone_half_angle
            )

            def beyond(points: Array, cone: Any = cone, half: float = half, sign: float = sign) -> Array:
                return sign * cone_distance(points, *cone, half)

            assert beyond(point) == pytest.approx(0.5 * depth, abs=1e-15)
            assert np.linalg.norm(normal, axis=-1) == pytest.approx(1.0, rel=1e-13)
            step = 1e-6
            for c, unit in enumerate(np.eye(3)):
                slope = (beyond(point + step * unit) - beyond(point - step * unit)) / (2 * step)
                assert slope == pytest.approx(normal[:, c], abs=1e-8)


class TestRibs:
    def test_nominal_sphere_just_touches(self, rig: Bearing) -> None:
        sim = Simulation(cases.paper_30310(0.0, bearing=rig))
        found = sim.contacts(np.zeros_like(sim.state.vector), 0.0)
        # the ring is displaced by its load: only the sphere's place is nominal
        shift = sim.equilibrium.displacement[2]
        assert found["rib_interference"] == pytest.approx(-shift * math.cos(rig.geometry.rib_normal_angle), abs=1e-13)
        assert found["rib_height"] == pytest.approx(rig.ribs.contact_height, abs=1e-4)

    def test_sphere_on_rib(self, sim: Simulation, places: Any) -> None:
        """Against points of the large end, over the rib's cone; 5 mrad of skew moves the contact by millimetres."""
        g, vector = sim.scene.bearing.geometry, random_state(sim, 8)
        found, at = sim.contacts(vector)["rib_interference"], places(sim, vector)
        ring = at.ring()
        for roller in range(sim.scene.bearing.n_rollers):
            placed = at.roller(roller)
            centre = placed.points(np.array([0.0, 0.0, g.sphere_centre - g.apex_to_mid]))
            middle = np.zeros(2)
            for width in (0.15, 4e-3, 1e-4):
                lean_n, lean_t = np.meshgrid(*(m + np.linspace(-width, width, 161) for m in middle))
                away = np.stack(
                    [np.sin(lean_n), np.sin(lean_t) * np.cos(lean_n), np.cos(lean_t) * np.cos(lean_n)], axis=-1
                )
                relative = centre + g.sphere_radius * away @ placed.axes.T - ring.origin
                along = relative @ ring.axes[:, 2]
                off = np.linalg.norm(relative - along[..., None] * ring.axes[:, 2], axis=-1)
                depth = math.sin(g.rib_normal_angle) * (off - g.rib_contact_radius) + math.cos(g.rib_normal_angle) * (
                    along - g.rib_contact_z
                )
                best = np.unravel_index(np.argmax(depth), depth.shape)
                middle = np.array([lean_n[best], lean_t[best]])
            assert found[roller] == pytest.approx(depth.max(), abs=1e-12)

    def test_front_rib_edges_on_the_small_end(self, sim: Simulation, places: Any) -> None:
        """Against points of the two circles that bound the rib's face."""
        bearing, vector = sim.scene.bearing, random_state(sim, 9)
        g, ribs = bearing.geometry, bearing.ribs
        found, at = sim.contacts(vector)["front_rib_interference"], places(sim, vector)
        ring = at.ring()
        # the face in the axial plane: perpendicular to the roller's axis, at a height above the raceway
        axis = np.array([math.sin(g.roller_axis_angle), math.cos(g.roller_axis_angle)])
        inward = np.array([-math.cos(g.roller_axis_angle), math.sin(g.roller_axis_angle)])
        raceway_normal = np.array([math.cos(g.cone_half_angle), -math.sin(g.cone_half_angle)])
        edges = []
        for height in (ribs.front_low, ribs.front_high):
            foot = (g.apex_to_mid + g.small_end_station - ribs.front_clearance) * axis
            below = (foot @ raceway_normal - height) / -(inward @ raceway_normal)
            edges.append(foot + below * inward)
        for roller in range(bearing.n_rollers):
            placed = at.roller(roller)
            end = placed.points(np.array([0.0, 0.0, g.small_end_station]))
            depths = []
            for radius, z in edges:
                middle = 0.0
                for width in (math.pi, 5e-3, 1e-5):
                    around = middle + np.linspace(-width, width, 2001)
                    circle = np.stack([radius * np.cos(around), radius * np.sin(around), np.full(2001, z)], axis=-1)
                    depth = (ring.points(circle) - end) @ placed.axes[:, 2]
                    middle = float(around[np.argmax(depth)])
                depths.append(depth.max())
            assert found[roller] == pytest.approx(max(depths), abs=1e-12)

    def test_front_clearance(self, rig: Bearing) -> None:
        placed = Simulation(cases.paper_30310(0.0, bearing=rig).replace(axial_load=0.0, displacement=(0.0, 0.0, 0.0)))
        found = placed.contacts(np.zeros_like(placed.state.vector), 0.0)
        assert found["front_rib_interference"] == pytest.approx(-rig.ribs.front_clearance, abs=1e-15)
        assert found["rib_interference"] == pytest.approx(0.0, abs=1e-15)


def test_interference_is_a_potential(sim: Simulation) -> None:
    """Frictionless wrenches are the gradient of the elastic energy."""
    bare = Effects.frictionless().replace(n_slices=31, gravity=False)
    still = Simulation(sim.scene.replace(effects=bare), instruction_set="scalar")
    vector = random_state(still, 10)
    loads = still.contacts(vector)
    axis = {"r": (0, 1e-9), "z": (2, 1e-9)}
    for part, (component, step) in axis.items():
        energies: list[Array] = []
        for side in (-1, 1):
            moved = vector.copy()
            still.view(moved)[f"roller_{part}"] += side * step
            energies.append(still.contacts(moved)["elastic_energy"].ravel())
        slope = (energies[1] - energies[0]) / (2 * step)
        assert -slope == pytest.approx(loads["force"][:, component], rel=1e-5, abs=1e-3)
