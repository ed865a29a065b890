"""The coordinates of a free ring in the state, from the place by which equilibria and results know it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]

_ALONG = np.array([0.0, 0.0, 1.0])


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
    turn_x, turn_y = displacement[3:]
    angle = math.hypot(turn_x, turn_y)
    sinc = float(np.sinc(angle / math.pi))
    put_axis(state, displacement[:3], np.array([sinc * turn_y, -sinc * turn_x, math.cos(angle)]), offset)


def put_axis(state: StateView, place: Array, axis: Array, offset: float) -> None:
    """Put a free ring by the place of its roller-centre plane (m), shape (3,), and by its axis, shape (3,)."""
    for name, value in zip("xyz", place + offset * (axis - _ALONG), strict=True):
        state[f"inner_ring_{name}"] = value
    state["inner_ring_skew"] = math.asin(min(max(axis[1], -1.0), 1.0))
    state["inner_ring_tilt"] = math.atan2(axis[0], axis[2])
