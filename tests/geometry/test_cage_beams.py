"""Frames of beams against straight beams and free rings by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.cage.beams import Beam, Elasticity, Frame, Section, told_apart
from trbdyn.cage.frame import JOINED, ROUNDED, cage_frame
from trbdyn.model.cage_body import Wall

NONE = np.zeros(3)
STEEL = Elasticity(206e9, 0.3, 7810.0)
THIN = Elasticity(206e9, 0.3, 7810.0, shear=False)


def straight(count: int, length: float, section: Section, made: Elasticity) -> Frame:
    direction = np.array([0.36, -0.48, 0.8])
    nodes = np.linspace(0.0, length, count + 1)[:, None] * direction
    side = np.array([0.8, 0.6, 0.0])
    return Frame.of(nodes, [Beam(k, k + 1, NONE, NONE, side, section) for k in range(count)], made)


def ring(count: int, radius: float, section: Section, made: Elasticity) -> Frame:
    """Width across the plane of the ring, thickness along the radius."""
    angles = 2.0 * math.pi * np.arange(count) / count
    nodes = radius * np.stack([np.cos(angles), np.sin(angles), np.zeros(count)], axis=-1)
    side = np.array([0.0, 0.0, 1.0])
    return Frame.of(nodes, [Beam(k, (k + 1) % count, NONE, NONE, side, section) for k in range(count)], made)


def test_a_free_straight_beam_rings_at_its_frequencies() -> None:
    """Euler's free beam: (lambda L)^2 = 22.3733, 61.6728, in both planes; tension n pi c/L; torsion n pi/L sqrt(GJ/(rho Ip))."""
    section, length = Section(4e-3, 2e-3), 0.5
    found, _ = straight(24, length, section, THIN).natural(12)
    line = THIN.density * section.area
    for second in (section.about_y, section.about_z):
        for number in (22.373285, 61.672823):
            wanted = number / (2 * math.pi * length**2) * math.sqrt(THIN.youngs_modulus * second / line)
            assert np.min(np.abs(found / wanted - 1.0)) < 1e-4
    stubby, _ = straight(24, 0.02, section, STEEL).natural(40)
    rigidity = STEEL.youngs_modulus / 2.6
    polar = section.about_y + section.about_z
    for wave in (math.sqrt(206e9 / 7810.0), math.sqrt(rigidity * section.torsion / (7810.0 * polar))):
        assert np.min(np.abs(stubby / (wave / 0.04) - 1.0)) < 2e-3


def test_shear_slows_a_stubby_beam() -> None:
    """Simply supported Timoshenko beam: the lower root of its frequency equation for half a wave (Timoshenko 1922)."""
    section, length = Section(10e-3, 10e-3), 0.05
    frame = straight(20, length, section, STEEL)
    held = np.concatenate([6 * node + np.arange(3) for node in (0, 20)])
    free = np.setdiff1d(np.arange(6 * 21), np.append(held, [3, 4, 5]))
    local = np.kron(np.eye(21 * 2), _axes())
    stiff, heavy = (local @ matrix @ local.T for matrix in (frame.stiffness, frame.mass))
    free = np.setdiff1d(np.arange(6 * 21), [0, 1, 2, 3, 120 + 1, 120 + 2])
    squares = np.linalg.eigvals(np.linalg.solve(heavy[np.ix_(free, free)], stiff[np.ix_(free, free)])).real
    found = math.sqrt(squares.min())
    shear, rigidity = 10 * 1.3 / (12 + 11 * 0.3), 206e9 / 2.6
    wave, second, line = math.pi / length, section.about_z, 7810.0 * section.area
    a = 7810.0 * second * 7810.0 / (shear * rigidity)
    b = -(line + 7810.0 * second * wave**2 + 206e9 * second * wave**2 * 7810.0 / (shear * rigidity))
    c = 206e9 * second * wave**4
    wanted = math.sqrt((-b - math.sqrt(b * b - 4 * a * c)) / (2 * a))
    assert found == pytest.approx(wanted, rel=1e-4)
    assert found < 0.96 * wave**2 * math.sqrt(206e9 * second / line)


def _axes() -> np.ndarray:
    x, side = np.array([0.36, -0.48, 0.8]), np.array([0.8, 0.6, 0.0])
    y = side - (side @ x) * x
    y /= np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)])


@pytest.mark.parametrize("waves", [2, 3])
def test_a_free_ring_rings_in_its_plane_and_out_of_it(waves: int) -> None:
    """Thin ring (Love, 1927, art. 293): in its plane n^2 (n^2-1)^2/(n^2+1), out of it n^2 (n^2-1)^2/(n^2 + EI/GJ)."""
    section, radius = Section(1.2e-3, 1e-3), 0.05
    found, _ = ring(96, radius, section, STEEL).natural(16)
    line, n = 7810.0 * section.area, waves
    base = n**2 * (n**2 - 1) ** 2 * STEEL.youngs_modulus / (line * radius**4)
    plane = math.sqrt(base * section.about_y / (n**2 + 1)) / (2 * math.pi)
    ratio = STEEL.youngs_modulus * section.about_z / (STEEL.youngs_modulus / 2.6 * section.torsion)
    out = math.sqrt(base * section.about_z / (n**2 + ratio)) / (2 * math.pi)
    for wanted in (plane, out):
        near = np.sort(np.abs(found / wanted - 1.0))
        assert near[1] < 0.01  # a pair of modes
    assert abs(plane / out - 1.0) > 0.05


def test_rings_converge_with_their_elements() -> None:
    """A polygon's error falls with the square of its number of sides."""
    section = Section(3e-3, 2e-3)
    first = [ring(count, 0.045, section, STEEL).natural(1)[0][0] for count in (12, 24, 48, 192)]
    errors = np.abs(np.array(first[:3]) / first[3] - 1.0)
    assert errors[2] < 3e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.2)


def test_a_ring_pulled_apart_by_two_forces() -> None:
    """Widening F R^3/(E I) (pi/4 - 2/pi) of a thin ring (Timoshenko, Strength of Materials I), and the loads against the
    stiffness.
    """
    section, radius, force = Section(1.2e-3, 1e-3), 0.05, 3.0
    frame = ring(96, radius, section, STEEL)
    loads = np.zeros((6 * 96, 1))
    loads[0], loads[6 * 48] = force, -force
    moved = frame.static(loads)
    assert frame.stiffness @ moved == pytest.approx(loads, abs=1e-6 * force)
    widening = float(moved[0, 0] - moved[6 * 48, 0])
    wanted = force * radius**3 / (STEEL.youngs_modulus * section.about_y) * (math.pi / 4 - 2 / math.pi)
    assert widening == pytest.approx(wanted, rel=5e-3)


@pytest.mark.parametrize("thickness", [5e-3, 2e-3])
def test_a_cage_pulled_apart_at_two_bars(thickness: float) -> None:
    """Two opposite radial forces in the middle of two bars. By hand each rim gets half of them, and is a ring
    (F/2) R^3/(E I) (pi/4 - 2/pi) that is wider in the joints; the mean of both rims is the
    widening. Bars that tie unlike rims together, and shear, are left out, and 5 % are between both.
    """
    body = trb.CageBody(thickness=thickness, small_rim_width=4.8e-3, large_rim_width=4.8e-3)
    bearing = trb.cases.rig_30310().replace({"cage.body": body})
    cage, wall, count = cage_frame(bearing), Wall.of(bearing, body), bearing.n_rollers
    frame, loads = cage.frame, np.zeros((len(cage.frame.mass), 1))
    for bar in (cage.bars[0], cage.bars[count // 2]):
        node = frame.beams[bar[len(bar) // 2 - 1]].end
        loads[6 * node : 6 * node + 2, 0] = frame.nodes[node, :2] / np.linalg.norm(frame.nodes[node, :2])
    moved = frame.static(loads)
    assert frame.stiffness @ moved == pytest.approx(loads, abs=1e-6)
    by_hand = []
    for edge, sign in ((wall.small_edge, -0.5), (wall.large_edge, 0.5)):
        radius = float(wall.place(np.array(edge + sign * 4.8e-3), np.array(wall.height))[0])
        window = float(wall.half_angle(np.array([edge]), np.array([wall.height]))[0])
        at_edge = float(wall.place(np.array(edge), np.array(wall.height))[0])
        free = (window - ROUNDED * wall.corner_radius / at_edge) * count / math.pi
        bends = free + (1.0 - free) * 4.8e-3 / (4.8e-3 + JOINED * wall.bar_width(edge))
        second = 4.8e-3 * thickness**3 / 12.0
        modulus = bearing.cage_material.youngs_modulus
        by_hand.append(bends * 0.5 * radius**3 / (modulus * second) * (math.pi / 4.0 - 2.0 / math.pi))
    assert float(loads[:, 0] @ moved[:, 0]) == pytest.approx(np.mean(by_hand), rel=0.05)


def test_one_force_accelerates_and_bends() -> None:
    """A free beam pushed at one end: it moves as a rigid body, and the moment in its middle is F L/8."""
    section, length = Section(4e-3, 2e-3), 0.1
    frame = straight(20, length, section, STEEL)
    side = _axes()[1]
    loads = np.zeros((6 * 21, 1))
    loads[:3, 0] = side
    ends = frame.end_forces(9, frame.static(loads))
    assert abs(ends[11, 0]) == pytest.approx(length / 8.0, rel=5e-3)


def test_rigid_arms_carry_rigid_motions() -> None:
    section, arm = Section(4e-3, 2e-3), np.array([0.0, 3e-3, -2e-3])
    nodes = np.array([[0.0, 0.0, 0.0], [0.04, 0.01, 0.0]])
    frame = Frame.of(nodes, [Beam(0, 1, arm, -arm, np.array([0.0, 0.0, 1.0]), section)], STEEL)
    rigid = frame.rigid_motions()
    scale = np.abs(frame.stiffness).max()
    assert np.abs(frame.stiffness @ rigid).max() < 1e-9 * scale
    assert (rigid.T @ frame.mass @ rigid)[0, 0] == pytest.approx(
        7810.0 * section.area * np.linalg.norm(nodes[1] - 2 * arm), rel=1e-12
    )


def test_modes_of_equal_frequency_are_the_same_on_every_machine() -> None:
    """A free ring's modes come in pairs. Whatever basis and signs a solver gives them, the same modes are kept; also
    of a pair that is cut.
    """
    bearing = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})
    frame = cage_frame(bearing).frame
    frequencies, shapes = frame.natural(8)
    assert frequencies[1] == pytest.approx(frequencies[0], rel=1e-7)
    np.testing.assert_allclose(shapes.T @ frame.mass @ shapes, np.eye(8), atol=1e-8)
    size = np.abs(shapes).max(axis=0)
    np.testing.assert_allclose(frame.natural(7)[1] / size[:7], shapes[:, :7] / size[:7], atol=1e-5)
    turned, angle = shapes.copy(), 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned[:, :2] = shapes[:, :2] @ turn @ np.diag([1.0, -1.0])
    np.testing.assert_allclose(told_apart(frequencies, turned) / size, shapes / size, atol=1e-5)
