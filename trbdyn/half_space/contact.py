"""Pressure between two elastic bodies whose gap, load and moment are given: conjugate gradients.

Polonsky and Keer (1999), Wear 231, 206-219, with one thing added: beside the approach of the bodies, their tilt about the middle
is found from the moment of the pressure, in the same way.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import LoadError
from trbdyn.half_space.influence import Influence

Array = NDArray[np.float64]

MOST_STEPS: Final = 2000


@dataclass(frozen=True)
class Pressed:
    """Pressures of a contact.

    Attributes
    ----------
    pressure : ndarray, shape (along, across)
        Pressure (Pa).
    approach : float
        Approach of the bodies at the middle (m).
    tilt : float
        Angle by which they came closer towards positive y (rad); 0 where the moment is not given.
    gap : ndarray, shape (along, across)
        What is left of the gap (m); 0 where they touch, to the tolerance.
    steps : int
        Steps of the conjugate gradients.
    """

    pressure: Array
    approach: float
    tilt: float
    gap: Array
    steps: int


def press(
    influence: Influence,
    gap: Array,
    *,
    load: float,
    places: Array | None = None,
    moment: float = 0.0,
    start: Array | None = None,
    tolerance: float = 1e-4,
) -> Pressed:
    """The pressure under a load, and under a moment where places are given.

    Parameters
    ----------
    influence : Influence
        Displacements from pressures.
    gap : ndarray, shape (along, across)
        Gap of the undeformed bodies (m), up to a constant, and up to a tilt where the moment is given.
    load : float
        Sum of the pressure over the grid (N).
    places : ndarray, shape (along,), optional
        Places of the cells (m); without them the bodies do not tilt.
    moment : float
        Sum of pressure times place (N m).
    start : ndarray, shape (along, across), optional
        A guess of the pressure (Pa).
    tolerance : float
        Change of all pressures together in a step, over their sum (1), and largest overlap over the approach's scale.

    Raises
    ------
    LoadError
        If the pressure is not found.
    """
    area = influence.cell[0] * influence.cell[1]
    along = None if places is None else np.asarray(places, dtype=float) / np.abs(places).max()
    scale = 1.0 if places is None else float(np.abs(places).max())
    wanted = np.array([load / area]) if along is None else np.array([load / area, moment / (area * scale)])
    pressure = _balanced(np.ones_like(gap) if start is None else np.maximum(start, 0.0), along, wanted)
    direction, before, restart = np.zeros_like(gap), 1.0, True
    shapes = [np.ones_like(gap)] + ([] if along is None else [np.repeat(along[:, None], gap.shape[1], axis=1)])
    for step in range(1, MOST_STEPS + 1):
        touching = (pressure > 0.0).astype(float)
        left = influence(pressure) + gap
        likely = _stiffened(left, touching, influence)
        planes = [_stiffened(one, touching, influence) for one in shapes]
        fitted = _solved(planes, shapes, likely)
        left -= sum(factor * one for factor, one in zip(fitted, shapes, strict=True))
        likely -= sum(factor * one for factor, one in zip(fitted, planes, strict=True))
        square = float(np.vdot(left, likely))
        direction = likely if restart else likely + square / before * direction * touching
        before = square
        moved = influence(direction)
        turned = float(np.vdot(moved, direction))
        length = float(np.vdot(left, direction)) / turned if turned > 0.0 else 0.0
        new = pressure - length * direction
        np.maximum(new, 0.0, out=new)
        overlapping = (new <= 0.0) & (left < 0.0)
        restart = bool(overlapping.any())
        if restart:
            new -= length * _stiffened(left, overlapping.astype(float), influence)
            np.maximum(new, 0.0, out=new)
        new = _balanced(new, along, wanted)
        change = float(np.abs(new - pressure).sum()) / wanted[0]
        pressure = new
        if change < tolerance:
            tilt = float(fitted[1] / scale) if along is not None else 0.0
            return Pressed(pressure, float(fitted[0]), tilt, left, step)
    raise LoadError(f"the pressure of a contact under {load:g} N was not found in {MOST_STEPS} steps")


def _stiffened(values: Array, touching: Array, influence: Influence) -> Array:
    """About the pressures that displace cells which touch by these values: those of each row alone."""
    return np.asarray(((values * touching) @ influence.row_stiffness) * touching)


def _solved(planes: list[Array], shapes: list[Array], likely: Array) -> Array:
    """Constant and slope whose part of the pressures leaves no load and no moment."""
    matrix = [[float(np.vdot(plane, shape)) for plane in planes] for shape in shapes]
    return np.linalg.lstsq(
        np.array(matrix), np.array([float(np.vdot(likely, shape)) for shape in shapes]), rcond=1e-12
    )[0]


def _balanced(pressure: Array, along: Array | None, wanted: Array) -> Array:
    """Pressures multiplied by a constant, and by a slope along the contact, so that load and moment are those wanted."""
    if along is None:
        return np.asarray(pressure * (wanted[0] / pressure.sum()))
    rows = pressure.sum(axis=1)
    sums = [float(rows @ along**power) for power in range(3)]
    factors = np.linalg.solve(np.array([[sums[0], sums[1]], [sums[1], sums[2]]]), wanted)
    return np.asarray(np.maximum(pressure * (factors[0] + factors[1] * along)[:, None], 0.0))
