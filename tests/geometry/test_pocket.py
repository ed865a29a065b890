"""Pocket faces in the core: gaps of the centred cage, bounded polygons against sampled points, and how far the cage moves."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from trbdyn import Effects, Simulation, cases, pocket_shapes
from trbdyn.model.bearing import Bearing
from trbdyn.model.pocket import Face, OtherPocket

Array = NDArray[np.float64]
BARS, LARGE_END, SMALL_END = slice(0, 2), 2, 3


def simulate(bearing: Bearing, **effects: Any) -> Simulation:
    return Simulation(
        cases.scene_30310(0.0, 4930.0, bearing=bearing, effects=Effects.paper().replace(n_slices=12, **effects))
    )


@pytest.fixture(scope="module")
def sim(straight_rig: Bearing) -> Simulation:
    return simulate(straight_rig)


def nominal(sim: Simulation, **parts: Any) -> Array:
    """A state vector with every roller and the cage at their nominal places, but for the parts given."""
    vector = np.zeros_like(sim.state.vector)
    for part, value in parts.items():
        sim.view(vector)[part] = value
    return vector


def gaps(sim: Simulation, vector: Array) -> Array:
    """Gap of every roller to each face of its pocket, shape (Z, slots); negative where it touches."""
    return -sim.contacts(vector, 0.0)["pocket_interference"]


class TestCentredCage:
    def test_gaps(self, sim: Simulation) -> None:
        found = gaps(sim, nominal(sim))
        assert found[:, BARS] == pytest.approx(0.1074e-3, abs=0.5e-7)
        lean = pocket_shapes.bar_lean(sim.scene.bearing)
        nu = sim.scene.bearing.geometry.roller_half_angle
        assert found[:, BARS] == pytest.approx(0.12e-3 * math.cos(nu) * math.cos(lean), rel=1e-10)
        assert found[:, LARGE_END] == pytest.approx(0.0, abs=1e-15)
        assert found[:, SMALL_END] == pytest.approx(0.4e-3, rel=1e-10)

    def test_profile_widens_only_the_ends(self, rig: Bearing, sim: Simulation) -> None:
        """The middle of a logarithmic profile is a cone."""
        crowned = simulate(rig)
        assert gaps(crowned, nominal(crowned)) == pytest.approx(gaps(sim, nominal(sim)), abs=1e-15)

    @pytest.mark.parametrize(("pocket", "direction"), [(0, 180.0), (3, -90.0), (7, 30.0)])
    def test_radial_play_closes_both_bars(self, sim: Simulation, pocket: int, direction: float) -> None:
        """Towards the axis at a pocket: both bars of it touch after Cpr."""
        for share, sign in ((1.0 - 2e-3, 1.0), (1.0 + 2e-3, -1.0)):
            x, y = (share * 0.25e-3 * f(math.radians(direction)) for f in (math.cos, math.sin))
            found = sign * gaps(sim, nominal(sim, cage_x=x, cage_y=y))[pocket, BARS]
            assert np.all(found > 0.0)
            assert found == pytest.approx(2e-3 * 0.1074e-3, rel=0.2)

    def test_circumferential_play_closes_one_bar(self, sim: Simulation) -> None:
        """Along the direction of rotation at pocket 0: its trailing bar touches after Cpc."""
        closed = gaps(sim, nominal(sim, cage_y=0.12e-3))[0]
        assert closed[1] == pytest.approx(0.0, abs=1e-7)
        assert closed[0] == pytest.approx(2 * 0.1074e-3, rel=1e-3)

    def test_axial_play(self, sim: Simulation) -> None:
        """+z opens the gap of the large end; along the roller's axis the small end closes after the play."""
        assert np.all(gaps(sim, nominal(sim, cage_z=1e-4))[:, LARGE_END] > 0.9e-4)
        play = 0.4e-3 * math.cos(sim.scene.bearing.geometry.roller_axis_angle)
        inwards = nominal(sim, cage_z=1.05 * play, roller_z=0.0)
        assert np.all(gaps(sim, inwards)[:, SMALL_END] < 0.0)
        assert np.all(gaps(sim, nominal(sim, cage_z=0.95 * play))[:, SMALL_END] > 0.0)


def largest(free: Callable[[float], bool]) -> float:
    """Largest distance at which a cage that starts free is still free, by bisection."""
    low, high = 0.0, 1e-3
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if free(middle) else (low, middle)
    return low


class TestMovableDistance:
    """The paper's figure 17: equal spacing against rollers that give way."""

    directions = np.radians(np.arange(0.0, 31.0, 5.0))

    def test_rollers_held_at_30_degrees(self, sim: Simulation) -> None:
        def reach(direction: float) -> float:
            def free(distance: float) -> bool:
                x, y = distance * math.cos(direction), distance * math.sin(direction)
                return bool(np.all(gaps(sim, nominal(sim, cage_x=x, cage_y=y))[:, BARS] > 0.0))

            return largest(free)

        found = np.array([reach(float(direction)) for direction in self.directions]) * 1e3
        assert found.min() == pytest.approx(0.1082, abs=0.5e-4)
        assert found.max() == pytest.approx(0.1101, abs=0.5e-4)
        assert found / 0.25 == pytest.approx(0.435, abs=0.006)

    def test_free_rollers(self, sim: Simulation) -> None:
        """Each roller settles midway between its bars and turns with its pocket."""
        lean = math.sin(sim.scene.bearing.geometry.roller_axis_angle)

        def settled(x: float, y: float) -> Array:
            behind, ahead = np.full(12, -0.02), np.full(12, 0.02)
            for _ in range(30):
                psi = 0.5 * (behind + ahead)
                # an axis that orbits by psi is skewed by it against the pocket: a free roller turns back
                vector = nominal(sim, cage_x=x, cage_y=y, roller_psi=psi, roller_skew=-lean * psi)
                found = gaps(sim, vector)[:, BARS]
                close = found[:, 0] < found[:, 1]
                ahead, behind = np.where(close, psi, ahead), np.where(close, behind, psi)
            return found

        def reach(direction: float) -> float:
            return largest(lambda d: bool(np.all(settled(d * math.cos(direction), d * math.sin(direction)) > 0.0)))

        found = np.array([reach(float(direction)) for direction in self.directions]) * 1e3
        assert found.min() == pytest.approx(0.250, abs=0.5e-3)
        assert found.max() == pytest.approx(0.259, abs=0.5e-3)


def nearest_sampled(face: Face, point: Array) -> float:
    """Distance of a point to a face: its height where its foot sees the outline all around, else points of the edges."""
    corners = face.vertices
    foot = point - ((point - corners[0]) @ face.normal) * face.normal
    sight = corners - foot
    ahead = np.roll(sight, -1, axis=0)
    turns = np.arctan2(np.cross(sight, ahead) @ face.normal, np.sum(sight * ahead, axis=1))
    if abs(turns.sum()) > math.pi:
        return float(np.linalg.norm(point - foot))
    low, high = np.zeros(len(corners)), np.ones(len(corners))
    for _ in range(12):
        share = np.linspace(low, high, 21)
        points = corners + share[..., None] * (np.roll(corners, -1, axis=0) - corners)
        distance = np.linalg.norm(points - point, axis=-1)
        nearest, step = share[np.argmin(distance, axis=0), range(len(corners))], (high - low) / 20
        low, high = np.maximum(nearest - 2 * step, 0.0), np.minimum(nearest + 2 * step, 1.0)
    return float(distance.min())


POLYGON = [(10e-3 * math.cos(a), 1.5e-3 * math.sin(a)) for a in np.linspace(0, 2 * math.pi, 12, endpoint=False)]


@pytest.mark.parametrize(
    "shape", ["default", "drafted", "stepped", "relieved", "chamfered", "one_sided", "polygon", "triangle"]
)
def test_bounded_faces(rig: Bearing, places: Any, shape: str) -> None:
    """Rollers and cage anywhere: the core's largest interference against sampled polygons."""
    if shape in ("polygon", "triangle"):
        pocket = pocket_shapes.default_pocket(rig)
        outline = tuple(POLYGON) if shape == "polygon" else ((-9e-3, -1e-3), (8e-3, -1.4e-3), (2e-3, 1.5e-3))
        pocket = pocket.with_face(pocket.face("leading_bar").replace(outline=outline))
    else:
        pocket = pocket_shapes.SHAPES[shape](rig, **({"lean_deg": 40.0} if shape == "drafted" else {}))
    sim = simulate(rig.replace(cage=rig.cage.replace(pocket=pocket)))
    g, random = rig.geometry, np.random.default_rng(11)
    parts = {"x": 2e-4, "y": 2e-4, "z": 4e-4, "skew": 3e-3, "tilt": 3e-3, "psi": 4e-3}
    vector = nominal(sim, **{f"cage_{part}": size * random.uniform(-1, 1) for part, size in parts.items()})
    for part, size in {"r": 1e-4, "z": 3e-4, "psi": 6e-3, "skew": 5e-3, "tilt": 2e-3}.items():
        # psi moves rollers by up to 0.25 mm: many lie beyond an edge of a bar's face
        sim.view(vector)[f"roller_{part}"] = size * random.uniform(-1, 1, 12)
    found, at = gaps(sim, vector), places(sim, vector)
    station = 0.5 * 19.8e-3 * ((2.0 * np.arange(12) + 1.0) / 12 - 1.0)
    half = 0.5 * 19.8e-3
    amplitude = 2 * 1.5 * 1833.0 / (math.pi * 19.8e-3 * g.effective_modulus)
    t = np.maximum((np.abs(station) - half) / (0.4 * half) + 1.0, 0.0)
    radius = (g.apex_to_mid + station) * math.tan(g.roller_half_angle)
    radius += amplitude * np.log(1.0 - (1.0 - math.exp(-10e-6 / amplitude)) * t**2)
    along = np.concatenate([station + radius * math.tan(g.roller_half_angle), [g.sphere_centre - g.apex_to_mid]])
    spheres = np.append(radius / math.cos(g.roller_half_angle), g.sphere_radius)
    for roller in (0, 4, 9):
        frame, placed = at.pocket(roller), at.roller(roller)
        centres = (placed.points(np.outer(along, [0, 0, 1])) - frame.origin) @ frame.axes
        for face in pocket.faces:
            if face.part == "small_end":
                end = (placed.points(np.array([0, 0, g.small_end_station])) - frame.origin) @ frame.axes
                axis = placed.axes[:, 2] @ frame.axes
                exact = float(np.min((end - face.vertices) @ axis))
            else:
                chosen = slice(0, -1) if face.part == "flank" else slice(-1, None)
                exact = min(nearest_sampled(face, c) - r for c, r in zip(centres[chosen], spheres[chosen], strict=True))
            assert found[roller, face.slot] == pytest.approx(exact, abs=1e-11)


def test_flank_against_its_surface(sim: Simulation, places: Any) -> None:
    """Spheres on a bar's plane against the rims of discs; a rim digs in deeper by radius tilt^2/2."""
    g, random = sim.scene.bearing.geometry, np.random.default_rng(12)
    vector = nominal(sim, cage_x=1e-4, cage_y=-1e-4, roller_psi=1e-3 * random.uniform(-1, 1, 12))
    sim.view(vector)["roller_tilt"] = 1e-4 * random.uniform(-1, 1, 12)
    found, at = gaps(sim, vector), places(sim, vector)
    station = 0.5 * 19.8e-3 * ((2.0 * np.arange(12) + 1.0) / 12 - 1.0)
    radius, around = (g.apex_to_mid + station) * math.tan(g.roller_half_angle), np.linspace(0, 2 * math.pi, 40001)
    for roller in range(12):
        frame, placed = at.pocket(roller), at.roller(roller)
        surface = np.stack(
            [
                np.outer(radius, np.cos(around)),
                np.outer(radius, np.sin(around)),
                np.outer(station, np.ones_like(around)),
            ],
            axis=-1,
        )
        points = (placed.points(surface) - frame.origin) @ frame.axes
        for face in sim.scene.bearing.pocket.faces[BARS]:
            height = (points - np.array(face.origin)) @ face.normal
            tilt = 1e-4 + math.sin(g.roller_axis_angle) * 1e-3
            assert found[roller, face.slot] == pytest.approx(height.min(), abs=5e-10 + 0.5 * 7e-3 * tilt**2)


def test_without_edges_faces_are_planes(straight_rig: Bearing, places: Any) -> None:
    bounded, planes = simulate(straight_rig), simulate(straight_rig, pocket_edges=False)
    shifted = {"roller_psi": 8e-3, "cage_z": 2e-4}
    inside, outside = gaps(bounded, nominal(bounded, **shifted)), gaps(planes, nominal(planes, **shifted))
    assert np.all(outside[:, [0, 1, 2]] <= inside[:, [0, 1, 2]] + 1e-15)
    # the deepest point of the large end lies outside the wall's band
    assert np.all(outside[:, LARGE_END] < inside[:, LARGE_END] - 1e-6)
    at = places(planes, nominal(planes, **shifted))
    frame, placed, g = at.pocket(0), at.roller(0), straight_rig.geometry
    centre = (placed.points(np.array([0, 0, g.sphere_centre - g.apex_to_mid])) - frame.origin) @ frame.axes
    wall = straight_rig.pocket.face("large_end_wall")
    assert outside[0, LARGE_END] == pytest.approx((centre - wall.origin) @ wall.normal - g.sphere_radius, abs=1e-14)


def test_touching_pushes_apart(sim: Simulation) -> None:
    """Loads appear with interference, grow with it, and push roller and cage apart with equal forces."""
    vector = nominal(sim, cage_y=0.16e-3, roller_r=-1e-4)
    found = sim.contacts(vector, 0.0)
    load, gap = found["pocket_load"], -found["pocket_interference"]
    assert np.array_equal(load > 0.0, gap < 0.0)
    assert np.count_nonzero(load[:, BARS]) > 0
    free = sim.contacts(nominal(sim, roller_r=-1e-4, cage_z=1e-4), 0.0)
    assert not free["pocket_load"].any()
    assert not free["cage_force"].any()
    angle = 2 * math.pi * np.arange(12) / 12
    change = found["force"] - free["force"]
    turned = np.stack(
        [
            np.cos(angle) * change[:, 0] - np.sin(angle) * change[:, 1],
            np.sin(angle) * change[:, 0] + np.cos(angle) * change[:, 1],
            change[:, 2],
        ],
        axis=-1,
    )
    assert found["cage_force"] == pytest.approx(-turned, abs=1e-9 * np.abs(turned).max())
    assert found["cage_force"].sum(axis=0)[1] < 0.0


def test_a_pocket_of_another_shape_is_the_only_one(straight_rig: Bearing) -> None:
    """Faces of one pocket are in that pocket alone, whichever it is: all others keep their own."""
    for index in (0, 1, 11):
        other = pocket_shapes.default_pocket(straight_rig)
        other = other.replace(faces=other.faces[:-1])
        cage = straight_rig.cage.replace(other_pockets=(OtherPocket(index=index, pocket=other),))
        sim = simulate(straight_rig.replace(cage=cage))
        touched = np.isfinite(gaps(sim, nominal(sim))).sum(axis=1)
        usual = np.isfinite(gaps(simulate(straight_rig), nominal(sim))).sum(axis=1)
        assert touched[index] == usual[index] - 1, index
        assert np.array_equal(np.delete(touched, index), np.delete(usual, index)), index
