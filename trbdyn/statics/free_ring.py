"""The coordinates of a free ring in the state, from the place by which equilibria and results know it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]

_ALONG = np.array([0.0, 0.0, 1.0])


def axis_of(turn: Array) -> Array:
    """The axis, shape (3,), of a ring that is rotated about x and y (rad), shape (2,)."""
    angle = math.hypot(*turn)
    sinc = float(np.sinc(angle / math.pi))
    return np.array([sinc * turn[1], -sinc * turn[0], math.cos(angle)])


def turn_of(axis: Array) -> Array:
    """The rotation about x and y (rad), shape (2,), that turns z into an axis."""
    angle = math.atan2(math.hypot(axis[0], axis[1]), axis[2])
    sinc = float(np.sinc(angle / math.pi))
    return np.array([-axis[1] / sinc, axis[0] / sinc])


def place_ring(state: StateView, displacement: Array, offset: float) -> None:
    """Put a free ring, at rest, at a displacement.

    Parameters
    ----------
    state : StateView
        The state; it is written to.
    displacement : ndarray, shape (5,)
        Translation of the ring along x, y, z (m), rotation about x, y (rad).
    offset : float
        Axial position of its centre of mass from the roller-centre plane (m): the state holds that of the centre of mass.
    """
    put_axis(state, displacement[:3], axis_of(displacement[3:]), offset)


def put_axis(state: StateView, place: Array, axis: Array, offset: float, ring: str = "inner_ring") -> None:
    """Put a free ring by the place of its roller-centre plane (m), shape (3,), and by its axis, shape (3,)."""
    for name, value in zip("xyz", place + offset * (axis - _ALONG), strict=True):
        state[f"{ring}_{name}"] = value
    state[f"{ring}_skew"] = math.asin(min(max(axis[1], -1.0), 1.0))
    state[f"{ring}_tilt"] = math.atan2(axis[0], axis[2])
