"""How far the view may draw motion larger than it is: until the cage, drawn so, would leave the cup.

Motion and clearances grow by one factor, the rings keep their size. So a cage that moves by a tenth of a millimetre would, drawn
a hundred times as large, pass through the cup. The largest factor is the one at which the drawn cage just stays within the cup's
raceway at every frame; it is found by halving an interval, as more factor always means more motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from trbdyn.model.bearing import Bearing
from trbdyn.model.outlines import cup_outline
from trbdyn.viewer.meshes import Mesh
from trbdyn.viewer.shapes import Shapes

Array = NDArray[np.float64]

MOST_FRAMES: Final = 40
"""Frames that are tried: those in which the cage is farthest out."""
HALVINGS: Final = 14


def largest_factor(bearing: Bearing, shapes: Shapes, pose: Mapping[str, Array]) -> float:
    """Factor up to which the bars of the cage have a thickness, and the drawn cage stays within the cup at every frame."""
    return factor_within(np.array(cup_outline(bearing)[:2]), shapes.cage, pose, shapes.largest_factor)


def factor_within(cup: Array, cage: Mesh, pose: Mapping[str, Array], largest: float) -> float:
    """Largest factor, not above a largest one, at which the drawn cage stays within the cup; at least 1, as true to scale is
    allowed.

    The cup is given by radius and height of the ends of its raceway (m), shape (2, 2), the pose as in `Frames.pose`.
    """
    points, shift = _outside(cage)
    moves = np.column_stack([pose[f"cage_{name}"] for name in ("x", "y", "z", "tilt_x", "tilt_y")])
    reach = float(np.hypot(points[:, 0], points[:, 1]).max())
    size = np.linalg.norm(moves[:, :3], axis=1) + reach * np.hypot(moves[:, 3], moves[:, 4])
    moves = moves[np.argsort(size)[-MOST_FRAMES:]]
    allowed = min(_room(cup, points, shift, moves, 1.0), 0.0)
    if _room(cup, points, shift, moves, largest) >= allowed:
        return largest
    low, high = 1.0, largest
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _room(cup, points, shift, moves, middle) >= allowed else (low, middle)
    return low


def _outside(cage: Mesh) -> tuple[Array, Array]:
    """Points of the cage that can come to the cup first, and their shifts."""
    shift = np.zeros_like(cage.position) if cage.shift is None else cage.shift
    try:
        kept = ConvexHull(cage.position).vertices
    except QhullError:
        kept = np.arange(cage.position.shape[0])
    return cage.position[kept], shift[kept]


def _room(cup: Array, points: Array, shift: Array, moves: Array, factor: float) -> float:
    """Least gap between the drawn cage and the cup (m), over all frames; negative where it reaches through."""
    drawn = points + (factor - 1.0) * shift
    tilt_x, tilt_y = factor * moves[:, 3, None], factor * moves[:, 4, None]
    x = drawn[:, 0] + tilt_y * drawn[:, 2] + factor * moves[:, 0, None]
    y = drawn[:, 1] - tilt_x * drawn[:, 2] + factor * moves[:, 1, None]
    z = drawn[:, 2] + tilt_x * drawn[:, 1] - tilt_y * drawn[:, 0] + factor * moves[:, 2, None]
    (one, low), (two, high) = cup[np.argsort(cup[:, 1])]
    wall = one + (two - one) * (z - low) / (high - low)
    within = (z >= low) & (z <= high)
    gap = np.where(within, wall - np.hypot(x, y), np.inf)
    return float(gap.min())
