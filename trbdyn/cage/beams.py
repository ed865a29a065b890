"""Frames of straight Timoshenko beams in space (docs/theory/cage.md#a-frame-of-beams).

An element carries tension, torsion and bending with shear in two planes. Stiffness and mass both come from the displacements
that are exact for an unloaded beam with shear (Przemieniecki, Theory of Matrix Structural Analysis, 1968, ch. 5 and 11), so
one element is exact for static loads at its ends. The mass, with rotary inertia, is the Gauss quadrature of these
displacements. The local axes are x along the beam and y, z, the axes of its rectangular section; a coordinate vector of a
node is displacement, then rotation. An end may be tied to its node by a rigid arm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Section:
    """A solid rectangular section.

    Attributes
    ----------
    width, thickness : float
        Along the local y and the local z (m).
    """

    width: float
    thickness: float

    @property
    def area(self) -> float:
        """Area (m2)."""
        return self.width * self.thickness

    @property
    def about_y(self) -> float:
        """Second moment of area about the local y (m4)."""
        return self.width * self.thickness**3 / 12.0

    @property
    def about_z(self) -> float:
        """Second moment of area about the local z (m4)."""
        return self.thickness * self.width**3 / 12.0

    @property
    def torsion(self) -> float:
        """Saint-Venant's torsion constant (m4); within 0.5 % of the series (Young and Budynas, Roark's Formulas, table 10.7)."""
        long, short = max(self.width, self.thickness), min(self.width, self.thickness)
        return long * short**3 * (1.0 / 3.0 - 0.21 * short / long * (1.0 - (short / long) ** 4 / 12.0))


@dataclass(frozen=True)
class Beam:
    """An element between two nodes.

    Attributes
    ----------
    start, end : int
        Numbers of its nodes.
    from_start, from_end : ndarray, shape (3,)
        Rigid arms from the nodes to the ends of the beam (m).
    side : ndarray, shape (3,)
        A vector in the plane of the local x and y.
    section : Section
        Its section.
    stiffer : float
        Factor of Young's modulus (1).
    joint : Section, optional
        The section that resists, where a member joins another one; in the plane of the local x and y it does not bend.
    heavy : bool
        Whether it has mass; False where another beam has it already.
    """

    start: int
    end: int
    from_start: FloatArray
    from_end: FloatArray
    side: FloatArray
    section: Section
    stiffer: float = 1.0
    joint: Section | None = None
    heavy: bool = True


@dataclass(frozen=True)
class Elasticity:
    """What beams are made of.

    Attributes
    ----------
    youngs_modulus, poisson_ratio, density : float
        Pa, 1, kg/m3.
    shear : bool
        Whether shear deforms the beams, and sections have rotary inertia: Timoshenko's beam; False: Euler's.
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    shear: bool = True


RIGID: Final = 1e3
"""Factor of a second moment of area that stands for rigid."""


def local_matrices(
    length: float, section: Section, made: Elasticity, joint: Section | None = None
) -> tuple[FloatArray, FloatArray]:
    """Stiffness and mass of a beam in its local axes, each of shape (12, 12); a `joint` resists with its own section."""
    young, rigidity = made.youngs_modulus, 0.5 * made.youngs_modulus / (1.0 + made.poisson_ratio)
    shear = 10.0 * (1.0 + made.poisson_ratio) / (12.0 + 11.0 * made.poisson_ratio)  # Cowper 1966, rectangle
    stiffness, mass = np.zeros((12, 12)), np.zeros((12, 12))
    resists = joint or section
    line = made.density * section.area * length
    polar = made.density * (section.about_y + section.about_z) * length
    for first, stiff, heavy in (
        (0, young * resists.area / length, line),
        (3, rigidity * resists.torsion / length, polar),
    ):
        at = np.ix_((first, first + 6), (first, first + 6))
        stiffness[at] += stiff * np.array([[1.0, -1.0], [-1.0, 1.0]])
        mass[at] += heavy / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
    for places, signs, second, turns in (
        ((1, 5, 7, 11), (1.0, 1.0, 1.0, 1.0), resists.about_z * (1.0 if joint is None else RIGID), section.about_z),
        ((2, 4, 8, 10), (1.0, -1.0, 1.0, -1.0), resists.about_y, section.about_y),
    ):
        soft = 12.0 * young * second / (shear * rigidity * resists.area * length**2) if made.shear else 0.0
        at, sign = np.ix_(places, places), np.outer(signs, signs)
        bend = np.array(
            [
                [12.0, 6.0, -12.0, 6.0],
                [6.0, 4.0 + soft, -6.0, 2.0 - soft],
                [-12.0, -6.0, 12.0, -6.0],
                [6.0, 2.0 - soft, -6.0, 4.0 + soft],
            ]
        )
        scale = np.array([1.0, length, 1.0, length])
        stiffness[at] += sign * young * second / (length**3 * (1.0 + soft)) * bend * np.outer(scale, scale)
        mass[at] += sign * _bending_mass(length, soft, line, made.density * turns * length if made.shear else 0.0)
    return stiffness, mass


def _bending_mass(length: float, soft: float, line: float, rotary: float) -> FloatArray:
    """Mass matrix of deflection and rotation at the two ends, by Gauss quadrature (exact: polynomials of the sixth degree)."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    x, w = 0.5 + 0.5 * nodes, 0.5 * weights
    shape = np.stack(
        [
            1 - 3 * x**2 + 2 * x**3 + soft * (1 - x),
            length * (x - 2 * x**2 + x**3 + 0.5 * soft * (x - x**2)),
            3 * x**2 - 2 * x**3 + soft * x,
            length * (-(x**2) + x**3 - 0.5 * soft * (x - x**2)),
        ]
    ) / (1.0 + soft)
    turn = np.stack(
        [
            6 * (x**2 - x) / length,
            1 - 4 * x + 3 * x**2 + soft * (1 - x),
            6 * (x - x**2) / length,
            -2 * x + 3 * x**2 + soft * x,
        ]
    ) / (1.0 + soft)
    found: FloatArray = line * (shape * w) @ shape.T + rotary * (turn * w) @ turn.T
    return found


def crossed(arm: FloatArray) -> FloatArray:
    """The matrix that gives ``arm x v``, shape (3, 3)."""
    x, y, z = arm
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def at_end_of_arm(arm: FloatArray) -> FloatArray:
    """Displacement and rotation at the end of a rigid arm from those of the node, shape (6, 6)."""
    found = np.eye(6)
    found[:3, 3:] = -crossed(arm)
    return found


SPARE: Final = 4
"""Modes that are computed beyond those that are asked for, so that none of a group of equal frequency is missing."""
SAME: Final = 1e-6
"""Relative distance of two frequencies that count as equal."""


@dataclass(frozen=True)
class Frame:
    """A free frame of beams.

    Attributes
    ----------
    nodes : ndarray, shape (N, 3)
        Places of the nodes (m).
    beams : tuple of Beam
        The elements.
    made : Elasticity
        What they are made of.
    stiffness, mass : ndarray, shape (6 N, 6 N)
        Matrices of the frame.
    """

    nodes: FloatArray
    beams: tuple[Beam, ...]
    made: Elasticity
    stiffness: FloatArray
    mass: FloatArray

    @classmethod
    def of(cls, nodes: FloatArray, beams: Sequence[Beam], made: Elasticity) -> Frame:
        """The frame of these beams."""
        size = 6 * len(nodes)
        stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
        for beam in beams:
            own = Elasticity(beam.stiffer * made.youngs_modulus, made.poisson_ratio, made.density, made.shear)
            turn, length = _to_local(nodes, beam)
            places = _places(beam)
            stiff, heavy = local_matrices(length, beam.section, own, beam.joint)
            stiffness[np.ix_(places, places)] += turn.T @ stiff @ turn
            if beam.heavy:
                mass[np.ix_(places, places)] += turn.T @ heavy @ turn
        return cls(nodes, tuple(beams), made, stiffness, mass)

    def rigid_motions(self) -> FloatArray:
        """Three displacements along x, y, z and three rotations about them through the origin, shape (6 N, 6)."""
        return np.concatenate([at_end_of_arm(node) for node in self.nodes])

    def natural(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Natural frequencies (Hz), shape (count,), and mode shapes with unit modal mass, shape (6 N, count), of the free frame,
        without its six rigid motions. Modes of equal frequency, as a ring has them, are the ones that `told_apart` chooses,
        also where `count` leaves one of them out.
        """
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import eigsh

        below = -self._softest()  # below all squares, so that the shifted matrix is positive
        first = np.random.default_rng(0).standard_normal(len(self.mass))  # the same one in every run
        squares, shapes = eigsh(
            csc_array(self.stiffness),
            k=min(count + 6 + SPARE, len(self.mass) - 1),
            M=csc_array(self.mass),
            sigma=below,
            v0=first,
            tol=1e-12,
        )
        order = np.argsort(squares)[6:]
        frequencies = np.sqrt(np.maximum(squares[order], 0.0)) / (2.0 * np.pi)
        return frequencies[:count], told_apart(frequencies, shapes[:, order])[:, :count]

    def _softest(self) -> float:
        """A square of an angular frequency that is below those of bending: stiffness over mass of displacements, by their
        traces.
        """
        moves = np.arange(len(self.mass)) % 6 < 3
        return float(1e-6 * np.diag(self.stiffness)[moves].sum() / np.diag(self.mass)[moves].sum())

    def static(self, loads: FloatArray) -> FloatArray:
        """Displacements of the free frame under loads, which accelerate it as a rigid body and bend it; the part of the
        displacement that is a rigid motion (orthogonal in mass) is left out.

        Parameters
        ----------
        loads : ndarray, shape (6 N, L)
            Forces (N) and moments (N m) at the nodes.

        Returns
        -------
        ndarray, shape (6 N, L)
            Displacements (m) and rotations (rad).
        """
        from scipy.sparse import bmat, csc_array
        from scipy.sparse.linalg import splu

        rigid = self.rigid_motions()
        heavy = self.mass @ rigid
        balanced = loads - heavy @ np.linalg.solve(rigid.T @ heavy, rigid.T @ loads)
        held = heavy * (np.trace(self.stiffness) / np.abs(heavy).sum())  # in the size of the stiffness, for the solver
        system = bmat([[csc_array(self.stiffness), csc_array(held)], [csc_array(held.T), None]], format="csc")
        right = np.concatenate([balanced, np.zeros((6, loads.shape[1]))])
        found: FloatArray = splu(system).solve(right)[:-6]
        return found

    def end_forces(self, number: int, displacements: FloatArray) -> FloatArray:
        """Forces and moments on the two ends of a beam in its local axes, shape (12, L)."""
        beam = self.beams[number]
        own = Elasticity(
            beam.stiffer * self.made.youngs_modulus, self.made.poisson_ratio, self.made.density, self.made.shear
        )
        turn, length = _to_local(self.nodes, beam)
        stiffness, _ = local_matrices(length, beam.section, own, beam.joint)
        found: FloatArray = stiffness @ (turn @ displacements[_places(beam)])
        return found


def told_apart(frequencies: FloatArray, shapes: FloatArray) -> FloatArray:
    """The same modes, with those of equal frequency turned into each other, and with signs, so that every machine has the same.

    A solver gives any basis of the motions with one frequency, another one on another processor. Here a fixed draw of loads picks
    it: the second mode does not answer to the first load, the third not to the first two, and each answers to its own with
    a positive amplitude.

    Parameters
    ----------
    frequencies : ndarray, shape (M,)
        Natural frequencies, ascending (Hz).
    shapes : ndarray, shape (6 N, M)
        Mode shapes with unit modal mass.

    Returns
    -------
    ndarray, shape (6 N, M)
    """
    loads = np.random.default_rng(1).standard_normal(shapes.shape[::-1])
    found, first = shapes.copy(), 0
    while first < len(frequencies):
        equal = np.abs(frequencies[first:] - frequencies[first]) < SAME * frequencies[first]
        group = slice(first, first + int(np.argmin(np.append(equal, False))))
        turn, answers = np.linalg.qr((loads[: group.stop - first] @ shapes[:, group]).T)
        found[:, group] = shapes[:, group] @ (turn * np.sign(np.diag(answers)))
        first = group.stop
    return found


def local_axes(along: FloatArray, side: FloatArray) -> FloatArray:
    """Rows: local x, y, z of a beam; `side` lies in the plane of x and y."""
    x = along / np.linalg.norm(along)
    y = side - (side @ x) * x
    y /= np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)])


def _to_local(nodes: FloatArray, beam: Beam) -> tuple[FloatArray, float]:
    """From coordinates of the two nodes to those of the beam's ends in its axes, shape (12, 12), and the beam's length (m)."""
    along = nodes[beam.end] + beam.from_end - nodes[beam.start] - beam.from_start
    axes = np.kron(np.eye(2), local_axes(along, beam.side))
    found = np.zeros((12, 12))
    found[:6, :6] = axes @ at_end_of_arm(beam.from_start)
    found[6:, 6:] = axes @ at_end_of_arm(beam.from_end)
    return found, float(np.linalg.norm(along))


def _places(beam: Beam) -> NDArray[np.int64]:
    return np.concatenate([6 * beam.start + np.arange(6), 6 * beam.end + np.arange(6)])
