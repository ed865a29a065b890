"""The roller in a drawn pocket: which faces it can touch, and how far it moves until it does."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.extras.cad.facets import Facet, outside_of
from trbdyn.model.geometry import Geometry
from trbdyn.model.pocket import Face, Part

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

FloatArray = NDArray[np.float64]

NODES: Final = 101
REACHES: Final = (0.05, 0.1, 0.25)
"""How far roller and pocket may move against each other, over the roller's diameter, for the faces that are kept: the least one
that no play is above."""
WIDE: Final = 1.05
"""Faces at an end of the roller are kept up to this share of the end's radius."""
END: Final = math.sqrt(0.5)
"""Faces whose normal is nearer to the roller's axis than 45 degrees meet its ends."""


@dataclass(frozen=True)
class RollerInPocket:
    """The nominal roller as its chain of spheres, in the frame of its pocket, and how far it may move against that (m)."""

    geometry: Geometry
    diameter: float
    reach: float
    centres: FloatArray
    radii: FloatArray

    @classmethod
    def of(cls, bearing: Bearing, reach: float) -> RollerInPocket:
        geometry = bearing.geometry
        half_angle = geometry.roller_half_angle
        half = geometry.apex_to_large_end - geometry.apex_to_mid
        stations = np.linspace(-half, half, NODES)
        radii = 0.25 * (geometry.large_end_diameter + geometry.small_end_diameter) + stations * math.tan(half_angle)
        centres = np.zeros((NODES, 3))
        centres[:, 2] = stations + radii * math.tan(half_angle)
        return cls(geometry, bearing.roller.diameter, reach, centres, radii / math.cos(half_angle))

    def gap(self, face: Face, moved: FloatArray) -> float:
        """Gap to a face after the roller has moved (m)."""
        if face.part == "small_end":
            return float(np.min(self.geometry.small_end_station + moved[2] - face.vertices[:, 2]))
        if face.part == "large_end":
            centre = np.array([0.0, 0.0, self.geometry.sphere_centre - self.geometry.apex_to_mid]) + moved
            return float(face.distance(centre)) - self.geometry.sphere_radius
        return float(np.min(face.distance(self.centres + moved) - self.radii))

    def is_near(self, points: FloatArray, extents: FloatArray) -> NDArray[np.bool_]:
        """Whether anything within an extent of points in the frame of a pocket is within reach of the roller."""
        reach = self.reach + extents
        radius, along, end = np.hypot(points[:, 0], points[:, 1]), points[:, 2], 0.5 * self.geometry.large_end_diameter
        off = np.linalg.norm(self.centres - points[:, None], axis=2) - self.radii
        small, large = self.geometry.small_end_station, self.geometry.large_end_station
        at_flank = (small - reach < along) & (along < large + reach) & (off.min(axis=1) < reach)
        at_end = (radius < WIDE * end + reach) & ((np.abs(along - small) < reach) | (np.abs(along - large) < reach))
        return np.asarray(at_flank | at_end)

    def may_touch(self, point: FloatArray, extent: float, normal: FloatArray, spread: float) -> bool:
        """Whether the roller can touch anything within an extent of a point, with a normal within an angle of one there.

        A sphere of the flank that touches a face from without has its centre on the face's normal, a radius away. It may be off
        as far as roller and pocket move against each other, and as points and normals of the patch differ; further off, none can.
        """
        if not self.is_near(point[None], np.array([extent]))[0]:
            return False
        if spread > 0.5 or abs(normal[2]) > END - spread:
            return True
        off = np.linalg.norm(self.centres - point - self.radii[:, None] * normal, axis=1)
        return bool(np.any(off < self.reach + extent + 2.0 * math.sin(0.5 * spread) * self.radii))

    def meets(self, facet: Facet) -> Part | None:
        """The part of the roller that can touch the inside of a facet; None if none can."""
        reach, along = self.reach, float(facet.normal[2])
        if abs(along) > END:
            part: Part = "large_end" if along < 0.0 else "small_end"
            end = self.geometry.large_end_station if part == "large_end" else self.geometry.small_end_station
            low, high = facet.corners[:, 2].min() - end, facet.corners[:, 2].max() - end
            return part if low < reach and high > -reach else None
        return "flank" if self._touches(facet) else None

    def _touches(self, facet: Facet) -> bool:
        """Whether a sphere of the flank can touch a facet elsewhere than from behind an edge of it."""
        centres, radii = self.centres, self.radii
        height = (centres - facet.corners[0]) @ facet.normal
        touching = np.abs(height - radii) < self.reach
        feet = centres[touching] - height[touching, None] * facet.normal
        return bool(touching.any() and np.any(outside_of(facet, feet) < self.reach))

    def closing(self, faces: list[Face], way: FloatArray) -> float:
        """How far the roller moves until it touches one of some faces (m); infinite beyond a quarter of its diameter."""
        from scipy.optimize import brentq

        if not faces:
            return math.inf

        def gap(by: float) -> float:
            return min(self.gap(face, by * way) for face in faces)

        low, most = 0.0, REACHES[-1] * self.diameter
        while low < most:
            left = gap(low)
            if left < 1e-7:
                break
            low += left
        if low >= most:
            return math.inf
        high = low + 1e-6
        while gap(high) > 0.0 and high < most:
            high += 1e-6
        return float(brentq(gap, max(low - 1e-6, 0.0), high, xtol=1e-15)) if gap(high) <= 0.0 else math.inf
