"""Natural modes and static displacements of a free elastic solid from a finite-element mesh
(docs/theory/cage.md#a-cage-of-finite-elements).

Shape functions, their gradients and the quadrature come from scikit-fem; the mesh may be one of hexahedra or of tetrahedra and
come from anywhere. Displacements are quadratic: 20 nodes in a hexahedron, 10 in a tetrahedron, whose edges may be curved.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from trbdyn.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

EDGES: Final = ((0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3))
"""Corners of a tetrahedron between which its nodes 4 to 9 lie, in the order of Gmsh."""
SPARE: Final = 4
"""Modes that are computed beyond those that are asked for, so that none of a group of equal frequency is missing."""
SAME: Final = 1e-6
"""Relative distance of two frequencies that count as equal."""
RIGID: Final = 6
"""Motions of a rigid body."""
REPEATS: Final = 50
"""Most repetitions of a static solution."""
PRECISE: Final = 1e-7
"""Forces that a static solution may leave, over the largest load."""

_ALONE: Final = threading.RLock()
if hasattr(os, "register_at_fork"):  # a fork waits for the solution of another thread, or its child would wait for ever
    os.register_at_fork(before=_ALONE.acquire, after_in_parent=_ALONE.release, after_in_child=_ALONE.release)


@contextmanager
def _one_thread() -> Iterator[None]:
    """Linear algebra by one thread: with several, the last bits of the results depend on how many the machine gives. The limit
    holds for the whole process, so that one solution is found at a time.
    """
    with _ALONE, threadpool_limits(limits=1, user_api="blas"):
        yield


@dataclass(frozen=True)
class Elasticity:
    """What a solid is made of (Pa, 1, kg/m3)."""

    youngs_modulus: float
    poisson_ratio: float
    density: float

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's two constants; the second one is the shear modulus (Pa)."""
        young, ratio = self.youngs_modulus, self.poisson_ratio
        return young * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio)), young / (2.0 * (1.0 + ratio))


@dataclass(frozen=True, eq=False)
class Solid:
    """A free solid of finite elements. A coordinate vector has three displacements for each node.

    Attributes
    ----------
    basis : skfem.CellBasis
        Mesh, shape functions and quadrature of scikit-fem.
    made : Elasticity
        What it is made of.
    nodes : ndarray, shape (N, 3)
        Places of the nodes: corners and middles of edges (m).
    stiffness, mass : sparse array, shape (3 N, 3 N)
        Matrices.
    """

    basis: Any
    made: Elasticity
    nodes: FloatArray
    stiffness: Any
    mass: Any

    @classmethod
    def of(cls, corners: FloatArray, elements: IntArray, made: Elasticity) -> Solid:
        """The solid of a mesh.

        Parameters
        ----------
        corners : ndarray, shape (V, 3)
            Corners of the elements (m).
        elements : ndarray, shape (E, 8), (E, 4) or (E, 10)
            Corners of each hexahedron, in the order 000, 001, 010, 100, 011, 101, 110, 111 of its three directions, or of each
            tetrahedron; or corners of each tetrahedron and the middles of its edges `EDGES`.
        made : Elasticity
            What it is made of.

        Raises
        ------
        InputError
            If an element is folded.
        """
        import skfem

        hexahedra = elements.shape[1] == 8
        if elements.shape[1] == 4 + len(EDGES):
            mesh = _curved(corners, elements)
        else:
            mesh = (skfem.MeshHex if hexahedra else skfem.MeshTet)(
                np.ascontiguousarray(corners.T), np.ascontiguousarray(elements.T)
            )
        element = skfem.ElementHexS2() if hexahedra else skfem.ElementTetP2()
        basis = skfem.CellBasis(mesh, element, intorder=5 if hexahedra else 4)
        determinants = basis.mapping.detDF(basis.X)
        if folded := np.flatnonzero(determinants.min(axis=1) * determinants.max(axis=1) <= 0.0).tolist():
            raise InputError.of("elements", folded[:3], "must not be folded: their volume has both signs")
        return cls(basis, made, basis.doflocs.T.copy(), stiffness_of(basis, made), _mass(basis, made))

    @cached_property
    def rigid_motions(self) -> FloatArray:
        """Three displacements along x, y, z and three rotations about them through the origin, shape (3 N, 6)."""
        return np.concatenate([np.hstack([np.eye(3), -crossed(node)]) for node in self.nodes])

    @_one_thread()
    def natural(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Natural frequencies (Hz), shape (count,), and mode shapes with unit modal mass, shape (3 N, count), of the free solid,
        without its six rigid motions. Modes of equal frequency, as a ring has them, are the ones that `told_apart` chooses,
        also where `count` leaves one of them out.
        """
        from scipy.sparse.linalg import LinearOperator, eigsh

        size = len(self.mass_of_motions)
        first = np.random.default_rng(0).standard_normal(size)  # the same one in every run
        inverse = LinearOperator((size, size), matvec=self._shifted.solve, dtype=float)
        squares, shapes = eigsh(
            self.stiffness, k=count + RIGID + SPARE, M=self.mass, sigma=-self._shift, OPinv=inverse, v0=first, tol=1e-10
        )
        order = np.argsort(squares)[RIGID:]
        frequencies = np.sqrt(np.maximum(squares[order], 0.0)) / (2.0 * np.pi)
        return frequencies[:count], told_apart(frequencies, shapes[:, order])[:, :count]

    @cached_property
    def mass_of_motions(self) -> FloatArray:
        """Mass times rigid motions, shape (3 N, 6)."""
        return np.asarray(self.mass @ self.rigid_motions)

    @cached_property
    def _shift(self) -> float:
        """A square of an angular frequency far below those of the lowest modes: that of a wave over a thousand times its size."""
        length = float(np.ptp(self.nodes, axis=0).max())
        return (0.001 * np.pi / length) ** 2 * self.made.youngs_modulus / self.made.density

    @cached_property
    def _shifted(self) -> Any:
        """Factors of stiffness plus shift times mass, which is positive."""
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import splu

        whole = csc_array(self.stiffness + self._shift * self.mass)
        return splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    @_one_thread()
    def static(self, loads: FloatArray) -> FloatArray:
        """Displacements of the free solid under loads, which accelerate it as a rigid body and bend it; the part of the
        displacement that is a rigid motion (orthogonal in mass) is left out.

        Parameters
        ----------
        loads : ndarray, shape (3 N, L)
            Forces at the nodes (N).

        Returns
        -------
        ndarray, shape (3 N, L)
            Displacements (m).
        """
        rigid, heavy = self.rigid_motions, self.mass_of_motions
        weights = np.linalg.inv(rigid.T @ heavy)
        balanced = loads - heavy @ (weights @ (rigid.T @ loads))
        found, rest = np.zeros_like(balanced), balanced
        for _ in range(REPEATS):  # each leaves the shift over the lowest square of what was left
            found += np.stack([self._shifted.solve(load) for load in rest.T], axis=1)  # faster than all at once
            found -= rigid @ (weights @ (heavy.T @ found))
            rest = balanced - self.stiffness @ found
            if np.abs(rest).max() <= PRECISE * np.abs(balanced).max():
                break
        return found


def _curved(nodes: FloatArray, elements: IntArray) -> Any:
    """Mesh of scikit-fem of tetrahedra with curved edges."""
    import skfem

    used, corners = np.unique(elements[:, :4], return_inverse=True)
    corners = corners.reshape(-1, 4)
    flat = skfem.MeshTet(np.ascontiguousarray(nodes[used].T), np.ascontiguousarray(corners.T))
    middles = elements[:, 4:].ravel()
    ends = np.sort(corners[:, np.array(EDGES)].reshape(-1, 2), axis=1)
    key = len(used) * flat.edges[0].astype(np.int64) + flat.edges[1]  # ends of scikit-fem's edges rise
    order = np.argsort(key)
    of_edge = order[np.searchsorted(key[order], len(used) * ends[:, 0].astype(np.int64) + ends[:, 1])]
    places = np.empty((3, len(used) + len(key)))
    places[:, : len(used)] = nodes[used].T
    places[:, len(used) + of_edge] = nodes[middles].T
    return skfem.MeshTet2(places, flat.t)


def stiffness_of(basis: Any, made: Elasticity) -> Any:
    """Stiffness of isotropic elasticity (N/m), sparse, shape (3 N, 3 N); of the elements of the basis alone."""
    lame, shear = made.lame
    slopes = np.stack([one[0].grad for one in basis.basis])  # node, direction, element, point
    slopes = slopes.transpose(2, 0, 1, 3)
    count = slopes.shape[1]
    flat = slopes.reshape(len(slopes), 3 * count, -1)
    product = (flat * basis.dx[:, None, :]) @ flat.transpose(0, 2, 1)
    product = product.reshape(-1, count, 3, count, 3)
    blocks = lame * product + shear * product.transpose(0, 1, 4, 3, 2)
    same = shear * np.einsum("eikjk->eij", product)
    for axis in range(3):
        blocks[:, :, axis, :, axis] += same
    return _gathered(basis, blocks)


def _mass(basis: Any, made: Elasticity) -> Any:
    """Consistent mass (kg), sparse, shape (3 N, 3 N)."""
    shapes = np.stack([np.broadcast_to(np.asarray(one[0]), basis.dx.shape) for one in basis.basis]).transpose(1, 0, 2)
    from scipy.sparse import eye_array, kron

    product = made.density * (shapes * basis.dx[:, None, :]) @ shapes.transpose(0, 2, 1)
    return kron(_gathered(basis, product[:, :, None, :, None]), eye_array(3), format="csc")


def _gathered(basis: Any, blocks: FloatArray) -> Any:
    """Matrices of elements, shape (E, n, 3, n, 3), in their places."""
    from scipy.sparse import coo_array

    parts = blocks.shape[2]
    places = parts * basis.element_dofs.T[:, :, None] + np.arange(parts)
    places = places.reshape(len(places), -1).astype(np.int32)
    size = places.shape[1]
    rows, columns = np.repeat(places, size, axis=1).ravel(), np.tile(places, (1, size)).ravel()
    return coo_array((blocks.ravel(), (rows, columns)), shape=(parts * basis.N,) * 2).tocsc()


def crossed(arm: FloatArray) -> FloatArray:
    """The matrix that gives ``arm x v``, shape (3, 3)."""
    x, y, z = arm
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def told_apart(frequencies: FloatArray, shapes: FloatArray) -> FloatArray:
    """The same modes, with those of equal frequency turned into each other, and with signs, so that every machine has the same.
    Frequencies rise, shapes, shape (3 N, M), have unit modal mass.

    A solver gives any basis of the motions with one frequency, another one on another processor. Here a fixed draw of loads picks
    it: the second mode does not answer to the first load, the third not to the first two, and each answers to its own with a
    positive amplitude.
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
