"""Rounded corners of a drawn window, and the rounded edges of the roller's ends that pass them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.extras.cad.facets import Facet, outside_of

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

FloatArray = NDArray[np.float64]

BAR, WALL = math.cos(math.radians(60.0)), math.cos(math.radians(30.0))
"""Share of a normal along the roller's axis up to which a face runs as a bar, and from which on as an end wall."""
AROUND: Final = 180
"""Points of a circle."""
ALONG: Final = 7
"""Circles of a rounded edge."""
NEAR_END: Final = 0.25
"""Share of the effective length from the roller's middle on that a corner of the window lies beyond."""


def edges_of(bearing: Bearing, chamfer: float) -> FloatArray:
    """Points of the rounded edges of both ends of the roller in the frame of its pocket (m), shape (n, 3): circles that touch the
    flank and the end, which at the large end of a tapered roller is a sphere.
    """
    geometry = bearing.geometry
    turned = np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
    circle = np.stack([np.cos(turned), np.sin(turned), np.zeros(AROUND)], axis=1)
    half_angle, middle = geometry.roller_half_angle, 0.5 * bearing.roller.diameter
    found = []
    for way, end, sphere in (
        (1.0, geometry.large_end_station, geometry.sphere_radius),
        (-1.0, geometry.small_end_station, math.inf),
    ):
        rim = middle + end * math.tan(half_angle) - chamfer
        flat = end - (sphere - math.sqrt(sphere**2 - rim**2) if rim < sphere < math.inf else 0.0)
        centre = flat - way * chamfer
        off = middle + centre * math.tan(half_angle) - chamfer / math.cos(half_angle)
        # from the normal of the flank to that of the end
        for at in np.linspace(-half_angle, way * 0.5 * math.pi, ALONG):
            found.append((off + chamfer * math.cos(at)) * circle + [0.0, 0.0, centre + chamfer * math.sin(at)])
    return np.concatenate(found)


def is_corner(points: FloatArray, normals: FloatArray, effective_length: float) -> bool:
    """Whether a face, by points and normals out of the solid in the frame of a pocket, leads hollow from a bar to an end wall."""
    lean = np.abs(normals[:, 2])
    at_end = np.min(np.abs(points[:, 2])) > NEAR_END * effective_length
    if not at_end or np.ptp(np.sign(points[:, 2])) > 0.0 or lean.min() > BAR or lean.max() < WALL:
        return False
    return radius_of(points, normals) > 0.0


def radius_of(points: FloatArray, normals: FloatArray) -> float:
    """Radius of a rounding (m), positive where it is hollow."""
    away, turned = points - points.mean(axis=0), normals - normals.mean(axis=0)
    return -float(np.sum(away * turned) / max(float(np.sum(turned * turned)), 1e-30))


def depth_in(facets: list[Facet], edges: FloatArray, reach: float) -> float:
    """How far points lie behind facets (m), 0 where none does."""
    deepest = 0.0
    for facet in facets:
        height = (edges - facet.corners[0]) @ facet.normal
        behind = (height < -deepest) & (height > -reach)
        if behind.any():
            depth = -height[behind]
            off = outside_of(facet, edges[behind] + depth[:, None] * facet.normal)
            deepest = float(np.max(depth[off <= 0.3 * depth], initial=deepest))
    return deepest
