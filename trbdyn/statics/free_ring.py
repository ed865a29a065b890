"""The coordinates of a free ring in the state, from the place by which equilibria and results know it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]

ALONG = np.array([0.0, 0.0, 1.0])
"""The axis of a shaft or ring that is not tilted."""


def axis_of(rotation: Array) -> tuple[Array, Array]:
    """Direction of an axis that a rotation about x and y (rad) turned from z, shape (3,), and its slopes, shape (3, 2)."""
    tx, ty = rotation
    angle = math.hypot(tx, ty)
    sinc = float(np.sinc(angle / math.pi))
    bend = (math.cos(angle) - sinc) / angle**2 if angle > 1e-4 else -1.0 / 3.0 + angle**2 / 30.0
    axis = np.array([sinc * ty, -sinc * tx, math.cos(angle)])
    slopes = np.array(
        [[bend * tx * ty, sinc + bend * ty**2], [-sinc - bend * tx**2, -bend * tx * ty], [-sinc * tx, -sinc * ty]]
    )
    return axis, slopes


def turn_of(axis: Array) -> Array:
    """The rotation about x and y (rad), shape (2,), that turns z into an axis."""
    angle = math.atan2(math.hypot(axis[0], axis[1]), axis[2])
    sinc = float(np.sinc(angle / math.pi))
    return np.array([-axis[1] / sinc, axis[0] / sinc])


def put_axis(state: StateView, place: Array, axis: Array, offset: float, ring: str = "inner_ring") -> None:
    """Put a free ring by the place of its roller-centre plane (m), shape (3,), and by its axis, shape (3,).

    The state holds the place of its centre of mass, which lies at an axial offset (m) from that plane.
    """
    for name, value in zip("xyz", place + offset * (axis - ALONG), strict=True):
        state[f"{ring}_{name}"] = value
    state[f"{ring}_skew"] = math.asin(min(max(axis[1], -1.0), 1.0))
    state[f"{ring}_tilt"] = math.atan2(axis[0], axis[2])
