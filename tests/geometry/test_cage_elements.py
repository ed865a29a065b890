"""Finite elements against straight beams and free rings by hand, and the mesh of a cage's wall."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.elastic.cage_solid import cage_solid
from trbdyn.extras.elastic.solid import Elasticity, Solid, told_apart
from trbdyn.extras.elastic.wall_mesh import CORNERS, wall_mesh
from trbdyn.model.cage_body import Wall, cage_mass

STEEL = Elasticity(206e9, 0.3, 7810.0)
BODY = trb.cases.cage_body_30310()
BEARING = trb.cases.rig_30310().replace(cage=trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=BODY))
SIX = np.array([(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)])
"""Tetrahedra of a hexahedron, by its corners as binary numbers."""


def grid(counts: tuple[int, int, int], *, closed: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Corners of a unit cube's cells as numbers of the three directions, and its hexahedra; the first direction may close."""
    sizes = (counts[0] + (not closed), counts[1] + 1, counts[2] + 1)
    number = np.arange(math.prod(sizes)).reshape(sizes)
    cells = np.argwhere(np.ones(counts))[:, None] + CORNERS
    elements = number[cells[..., 0] % sizes[0], cells[..., 1], cells[..., 2]]
    return np.argwhere(np.ones(sizes)) / np.array(counts), elements


def straight(counts: tuple[int, int, int], size: tuple[float, float, float], *, tetrahedra: bool = False) -> Solid:
    places, elements = grid(counts)
    if tetrahedra:
        binary = np.argsort(CORNERS @ [4, 2, 1])
        elements = elements[:, binary][:, SIX].reshape(-1, 4)
    return Solid.of(places * size, elements, STEEL)


def ring(count: int, radius: float, width: float, thickness: float) -> Solid:
    """Width across the plane of the ring, thickness along the radius."""
    places, elements = grid((count, 2, 2), closed=True)
    angle, rho = 2.0 * math.pi * places[:, 0], radius + thickness * (places[:, 1] - 0.5)
    corners = np.stack([rho * np.cos(angle), rho * np.sin(angle), width * places[:, 2]], axis=-1)
    return Solid.of(corners, elements, STEEL)


@pytest.mark.parametrize("tetrahedra", [False, True])
def test_a_free_straight_beam_rings_at_its_frequencies(tetrahedra: bool) -> None:
    """A thin one bends as Euler's free beam, (lambda L)^2 = 22.3733, 61.6728, in both planes; tension n pi c/L."""
    length, width, thickness = 0.2, 4e-3, 2e-3
    found, _ = straight((24, 1, 1), (length, width, thickness), tetrahedra=tetrahedra).natural(10)
    for side in (width, thickness):
        for number in (22.373285, 61.672823):
            wanted = number / (2 * math.pi * length**2) * math.sqrt(206e9 * side**2 / 12.0 / 7810.0)
            assert np.min(np.abs(found / wanted - 1.0)) < 6e-3  # shear and rotary inertia
    stubby, _ = straight((8, 1, 1), (0.02, width, thickness), tetrahedra=tetrahedra).natural(12)
    assert np.min(np.abs(stubby / (math.sqrt(206e9 / 7810.0) / 0.04) - 1.0)) < 3e-3


@pytest.mark.parametrize("waves", [2, 3])
def test_a_free_ring_rings_in_its_plane_and_out_of_it(waves: int) -> None:
    """Thin ring (Love, 1927, art. 293): in its plane n^2 (n^2-1)^2/(n^2+1), out of it n^2 (n^2-1)^2/(n^2 + EI/GJ)."""
    width, thickness, radius = 1.2e-3, 1e-3, 0.05
    found, _ = ring(64, radius, width, thickness).natural(12)
    n, area = waves, width * thickness
    base = n**2 * (n**2 - 1) ** 2 * 206e9 / (7810.0 * area * radius**4)
    plane = math.sqrt(base * width * thickness**3 / 12.0 / (n**2 + 1)) / (2 * math.pi)
    torsion = width * thickness**3 * (1 / 3 - 0.21 * thickness / width * (1 - (thickness / width) ** 4 / 12))
    across = thickness * width**3 / 12.0
    out = math.sqrt(base * across / (n**2 + 2.6 * across / torsion)) / (2 * math.pi)
    for wanted in (plane, out):
        near = np.sort(np.abs(found / wanted - 1.0))
        assert near[1] < 0.01  # a pair of modes
    assert abs(plane / out - 1.0) > 0.05


def test_a_ring_pulled_apart_by_two_forces() -> None:
    """Widening F R^3/(E I) (pi/4 - 2/pi) of a thin ring (Timoshenko, Strength of Materials I), and the loads against the
    stiffness.
    """
    width, thickness, radius, force = 1.2e-3, 1e-3, 0.05, 3.0
    solid = ring(64, radius, width, thickness)
    loads = np.zeros((solid.nodes.size, 1))
    for side in (1.0, -1.0):
        at = np.flatnonzero((np.abs(solid.nodes[:, 1]) < 1e-9) & (side * solid.nodes[:, 0] > 0.0))
        loads[3 * at, 0] = side * force / len(at)
    moved = solid.static(loads)
    assert solid.stiffness @ moved == pytest.approx(loads, abs=1e-6 * force)
    wanted = force**2 * radius**3 / (206e9 * width * thickness**3 / 12.0) * (math.pi / 4 - 2 / math.pi)
    assert float(loads[:, 0] @ moved[:, 0]) == pytest.approx(wanted, rel=5e-3)


def test_all_modes_together_bend_as_the_stiffness() -> None:
    """A force on one end of a free block: it accelerates and bends, and the sum over every mode is the static solution."""
    from scipy.linalg import eigh

    solid = straight((3, 1, 1), (6e-3, 2e-3, 1e-3))
    squares, shapes = eigh(solid.stiffness.toarray(), solid.mass.toarray())
    loads = np.zeros((solid.nodes.size, 1))
    loads[2] = 1.0
    amplitude = (shapes.T @ loads)[6:, 0] / squares[6:]
    moved = solid.static(loads)[:, 0]
    assert shapes[:, 6:] @ amplitude == pytest.approx(moved, abs=1e-6 * np.abs(moved).max())
    assert np.abs(solid.mass_of_motions.T @ moved).max() < 1e-9 * np.abs(moved).max()


def test_modes_of_equal_frequency_are_the_same_on_every_machine() -> None:
    """A free ring's modes come in pairs. Whatever basis and signs a solver gives them, the same modes are kept; also
    of a pair that is cut.
    """
    solid = ring(24, 0.03, 3e-3, 2e-3)
    frequencies, shapes = solid.natural(8)
    assert frequencies[1] == pytest.approx(frequencies[0], rel=1e-7)
    np.testing.assert_allclose(shapes.T @ (solid.mass @ shapes), np.eye(8), atol=1e-8)
    size = np.abs(shapes).max(axis=0)
    np.testing.assert_allclose(solid.natural(7)[1] / size[:7], shapes[:, :7] / size[:7], atol=1e-5)
    turned, angle = shapes.copy(), 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned[:, :2] = shapes[:, :2] @ turn @ np.diag([1.0, -1.0])
    np.testing.assert_allclose(told_apart(frequencies, turned) / size, shapes / size, atol=1e-5)


def test_a_folded_mesh_is_refused() -> None:
    places, elements = grid((2, 1, 1))
    places[places[:, 0] == 0.5] += [0.8, 0.0, 0.0] * (places[places[:, 0] == 0.5][:, 1:2] == 0.0)
    with pytest.raises(trb.InputError, match="must not be folded"):
        Solid.of(places, elements, STEEL)


@pytest.mark.parametrize(
    "change",
    [
        {"corner_radius": 0.0},
        {},
        {"corner_radius": 3e-3},
        {"thickness": 1.5e-3, "small_rim_thickness": 7.5e-3, "large_rim_thickness": 2e-3},
    ],
)
def test_the_mesh_weighs_what_the_wall_does(change: dict[str, float]) -> None:
    """The rounded corners add (1 - pi/4) r^2 of the wall each; edges are straight, so the mesh has a little less of a ring and a
    little more of a corner.
    """
    body = BODY.replace(**change)
    bearing = BEARING.replace({"cage.body": body})
    wall = Wall.of(bearing, body)
    expected = cage_mass(wall, 7810.0).mass
    expected += 7810.0 * 4 * wall.n_pockets * (1.0 - math.pi / 4.0) * wall.corner_radius**2 * wall.thickness
    solid = cage_solid(bearing).solid
    heavy = solid.rigid_motions.T @ solid.mass_of_motions
    assert heavy[0, 0] == pytest.approx(expected, rel=4e-3)


def test_a_crack_parts_a_bar_from_its_rim() -> None:
    wall = Wall.of(BEARING, BODY)
    whole, cracked = wall_mesh(wall), wall_mesh(wall, cracked_bars=frozenset({3}))
    assert len(cracked.elements) == len(whole.elements)
    shared = np.intersect1d(cracked.elements[cracked.bar == 3], cracked.elements[cracked.bar < 0])
    assert set(shared) == set(np.intersect1d(cracked.roots[1], shared))
    assert len(cracked.corners) - len(whole.corners) == len(shared)


def test_corners_that_do_not_fit_are_refused() -> None:
    with pytest.raises(trb.InputError, match=r"corner_radius = 0\.02 : must be < "):
        Wall.of(BEARING, BODY.replace(corner_radius=0.02))
