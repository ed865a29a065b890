"""Jacobian by differences, all columns in one batch of states.

Rollers meet only the rings and the cage, so the matrix is an arrow: a block a roller, a border to and from the cage, the
cage's block. The same entry of all rollers is moved at once (11 states), then every entry of the cage (12 states), for
which only the pockets are evaluated.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix

from .model import NumpyModel

Array = NDArray[np.float64]

POSITION, ANGLE, VELOCITY, SPIN = 1e-10, 1e-8, 1e-7, 1e-5
ROLLER_STEPS = np.array([POSITION, ANGLE, POSITION, ANGLE, ANGLE, *[VELOCITY] * 3, *[SPIN] * 3])
CAGE_STEPS = np.array([*[POSITION] * 3, *[ANGLE] * 3, *[VELOCITY] * 3, *[SPIN] * 3])


class Jacobian:
    """Jacobians of a model, in the layouts that the integrators want.

    Parameters
    ----------
    model : NumpyModel
        The model.
    """

    def __init__(self, model: NumpyModel) -> None:
        z = model.constants.n_rollers
        self.model = model
        self.count = 0
        n, cage = model.n_state, 11 * z
        # moves: column 0 is the state itself
        self.moves = np.zeros((n, 24))
        for k in range(11):
            self.moves[k:cage:11, 1 + k] = ROLLER_STEPS[k]
        self.moves[cage:, 12:] = np.diag(CAGE_STEPS)
        self.pattern = np.zeros((n, n), dtype=bool)
        for j in range(z):
            self.pattern[11 * j : 11 * j + 11, 11 * j : 11 * j + 11] = True
        self.pattern[cage:] = self.pattern[:, cage:] = True
        self.sparsity = csc_matrix(self.pattern.astype(np.float64))
        # the stored entries in the order of a compressed sparse column matrix
        columns, rows = np.nonzero(self.pattern.T)
        self.stored = rows * n + columns
        self._dense = np.zeros((n, n))

    def dense(self, time: float, y: Array) -> Array:
        """As an array, shape (n_state, n_state)."""
        self.count += 1
        model, c, z = self.model, self.model.constants, self.model.constants.n_rollers
        cage = 11 * z
        states = y.reshape(-1, 1) + self.moves
        bodies = model.bodies(time, states)
        wrenches = np.empty((6, z, 24))
        # six states at a time stay in the processor's cache
        wrenches[..., :6] = model.ring_loads(bodies, slice(0, 6))
        wrenches[..., 6:12] = model.ring_loads(bodies, slice(6, 12))
        wrenches[..., 12:] = wrenches[..., :1]
        pocket = model.pocket_loads(bodies)
        on_cage = np.zeros((6, z, 24))
        if pocket is not None:
            wrenches += pocket[0]
            on_cage = pocket[1]
        rates = model.rates(bodies, wrenches, on_cage.sum(axis=1))
        change = rates - rates[:, :1]
        out = self._dense
        own = change[:cage, 1:12].reshape(z, 11, 11) / ROLLER_STEPS
        index = np.arange(cage).reshape(z, 11)
        out[index[:, :, None], index[:, None, :]] = own
        out[:, cage:] = change[:, 12:] / CAGE_STEPS
        # border: what one roller's move does to the cage, whose rates are linear in its wrench
        wrench = (on_cage[..., 1:12] - on_cage[..., :1]) / ROLLER_STEPS
        turn = np.einsum("acB,cjk->ajk", bodies.frames[:, :, z, :1], wrench[3:])
        border = np.zeros((12, z, 11))
        border[6:9] = wrench[:3] * c.per_mass[z]
        border[9:11] = turn[:2] * c.per_transverse[z]
        border[11] = turn[2] * c.per_axial[z]
        out[cage:, :cage] = border.reshape(12, cage)
        return out

    def sparse(self, time: float, y: Array) -> csc_matrix:
        """As a compressed sparse column matrix with a fixed pattern."""
        stored = self.dense(time, y).take(self.stored)
        return csc_matrix((stored, self.sparsity.indices, self.sparsity.indptr), shape=self.sparsity.shape)

    def dense_copy(self, time: float, y: Array) -> Array:
        """As an array that the caller may keep and change."""
        return self.dense(time, y).copy()

    def fill_dense(self, time: float, y: Array, rates: Array, out: Array) -> None:
        """In place, as scikit-sundae's dense solvers want it."""
        out[:] = self.dense(time, y)

    def fill_sparse(self, time: float, y: Array, rates: Array, out: Array) -> None:
        """In place, as scikit-sundae's sparse solver wants it."""
        self.dense(time, y).take(self.stored, out=out)
