"""Cage pockets as data: a pocket is a list of bounded planar faces.

Pocket frame: origin at the mid length of the nominal roller; axes n (outward, perpendicular to the roller's axis, in
the axial plane), t (direction of rotation) and a (along the roller's axis, towards its large end). n, t, a are
right-handed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from trbdyn.base.validation import Flag, Model, Number, Ratio, Vector3, Whole, unit
from trbdyn.errors import InputError, Problem
from trbdyn.model.geometry import Geometry

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

MAX_VERTICES = 12
_UNIT_TOLERANCE = 1e-9
_GAP_TOLERANCE = 1e-9
_FLANK_STATIONS = 101

Part = Literal["flank", "large_end", "small_end"]
Point = tuple[Annotated[Number, unit("m")], Annotated[Number, unit("m")]]
FloatArray = NDArray[np.float64]


class Face(Model):
    """A convex polygon that a part of the roller may touch.

    Parameters
    ----------
    name : str
        Name in messages and results.
    slot : int
        Number of the surface in its pocket: the column of its forces in results.
    part : {'flank', 'large_end', 'small_end'}
        Part of the roller it meets. A face for the small end acts through its vertices, 1/n of the stiffness each.
    origin : tuple of float, shape (3,)
        A point of the plane, in the pocket frame (m).
    u, v : tuple of float, shape (3,)
        Orthogonal unit vectors that span the plane; u x v is the normal and points to the roller.
    outline : tuple of pairs of float
        Vertices (u, v) from the origin, counter-clockwise seen from the roller, 3 to 12 (m).
    stiffness_factor : float
        Factor of the contact's stiffness (1).
    friction_factor : float
        Factor of the contact's friction coefficient (1).
    """

    name: Annotated[str, Field(min_length=1)]
    slot: Annotated[Whole, unit("1", ge=0, le=63)]
    part: Part
    origin: tuple[Annotated[Number, unit("m")], Annotated[Number, unit("m")], Annotated[Number, unit("m")]]
    u: Vector3
    v: Vector3
    outline: tuple[Point, ...]
    stiffness_factor: Annotated[Number, unit("1", gt=0)] = 1.0
    friction_factor: Ratio = 1.0

    def _check(self) -> None:
        u, v = np.array(self.u), np.array(self.v)
        for name, vector in (("u", u), ("v", v)):
            if abs(float(vector @ vector) - 1.0) > 2 * _UNIT_TOLERANCE:
                raise InputError.of(
                    name, tuple(vector.tolist()), f"must be a unit vector; its length is {np.linalg.norm(vector):.9g}"
                )
        if abs(float(u @ v)) > _UNIT_TOLERANCE:
            raise InputError.of("v", self.v, f"must be perpendicular to u; u . v is {float(u @ v):.3g}")
        if not 3 <= len(self.outline) <= MAX_VERTICES:
            raise InputError.of(
                "outline", self.outline, f"must have 3 to {MAX_VERTICES} vertices, not {len(self.outline)}"
            )
        points = np.array(self.outline)
        sides = np.roll(points, -1, axis=0) - points
        turns = _cross(sides, np.roll(sides, -1, axis=0))
        lengths = np.linalg.norm(sides, axis=1)
        winding = float(np.sum(np.arctan2(turns, np.sum(sides * np.roll(sides, -1, axis=0), axis=1))))
        if np.any(lengths == 0) or np.any(turns <= 1e-9 * lengths * np.roll(lengths, -1)) or winding > 3 * np.pi:
            raise InputError.of(
                "outline",
                self.outline,
                "must be convex, counter-clockwise seen from the roller, with an area and no idle vertex",
            )

    @property
    def normal(self) -> FloatArray:
        """Unit normal towards the roller, in the pocket frame, shape (3,)."""
        return np.cross(self.u, self.v)

    @property
    def vertices(self) -> FloatArray:
        """Vertices in the pocket frame (m), shape (n, 3)."""
        return np.array(self.origin) + np.array(self.outline) @ np.array([self.u, self.v])

    def distance(self, points: FloatArray) -> FloatArray:
        """Distance of points to the bounded polygon (m).

        Parameters
        ----------
        points : ndarray, shape (..., 3)
            Points in the pocket frame (m).

        Returns
        -------
        ndarray, shape (...)
        """
        relative = points - np.array(self.origin)
        flat = np.stack([relative @ np.array(self.u), relative @ np.array(self.v)], axis=-1)
        corners = np.array(self.outline)
        sides = np.roll(corners, -1, axis=0) - corners
        offsets = flat[..., None, :] - corners
        along = np.clip(np.sum(offsets * sides, axis=-1) / np.sum(sides * sides, axis=-1), 0.0, 1.0)
        to_sides = np.linalg.norm(offsets - along[..., None] * sides, axis=-1).min(axis=-1)
        inside = np.all(_cross(sides, offsets) >= 0, axis=-1)
        return np.hypot(relative @ self.normal, np.where(inside, 0.0, to_sides))


class Pocket(Model):
    """The faces of a pocket.

    Parameters
    ----------
    faces : tuple of Face
        At least one. Faces that share a slot are one surface of several facets: each point of the roller meets the nearest of
        them.
    allow_interference : bool
        Accept faces that the nominal roller already penetrates.
    """

    faces: Annotated[tuple[Face, ...], Field(min_length=1)]
    allow_interference: Flag = False

    def _check(self) -> None:
        names = [face.name for face in self.faces]
        parts: dict[int, Part] = {}
        for place, face in enumerate(self.faces):
            if face.name in names[:place]:
                limit = f"must differ from those of the other faces: {names}"
                raise InputError.of(("faces", place, "name"), face.name, limit)
            if (part := parts.setdefault(face.slot, face.part)) != face.part:
                limit = (
                    f"must be '{part}', as that of the other faces with slot {face.slot}: together they are one surface"
                )
                raise InputError.of(("faces", place, "part"), face.part, limit)

    @property
    def surfaces(self) -> tuple[Face, ...]:
        """The first face of each slot, whose name is that of the surface."""
        first: dict[int, Face] = {}
        for face in self.faces:
            first.setdefault(face.slot, face)
        return tuple(first.values())

    def face(self, name: str) -> Face:
        """The face of this name.

        Raises
        ------
        InputError
            If there is none.
        """
        for face in self.faces:
            if face.name == name:
                return face
        raise InputError.of("face", name, f"must be one of {[face.name for face in self.faces]}")

    def without(self, *names: str) -> Pocket:
        """The pocket with some faces left out; the others keep their slots."""
        for name in names:
            self.face(name)
        return self.replace(faces=tuple(face for face in self.faces if face.name not in names))

    def with_face(self, face: Face) -> Pocket:
        """The pocket with a face added, or put in the place of the one of its name."""
        if face.name in [own.name for own in self.faces]:
            return self.replace(faces=tuple(face if own.name == face.name else own for own in self.faces))
        return self.replace(faces=(*self.faces, face))

    def gaps(self, geometry: Geometry) -> dict[str, float]:
        """Gap between the nominal roller and each face (m); negative where the roller is inside.

        A flank face meets the roller's straight cone, a large-end face its sphere, a small-end face its end plane.
        """
        return {face.name: _gap(face, geometry) for face in self.faces}

    def problems(self, geometry: Geometry) -> list[Problem]:
        """What does not fit between the pocket and the nominal roller; paths start at the pocket."""
        found = []
        for place, face in enumerate(self.faces):
            gap = _gap(face, geometry)
            if gap < -_GAP_TOLERANCE and not self.allow_interference:
                allowed = (
                    f"clearances do not fit: the nominal roller penetrates face '{face.name}' by {-gap * 1e6:.4g} um; "
                    "move the face away, or set allow_interference"
                )
                found.append(Problem(("faces", place, "origin"), face.origin, allowed))
            reach = float(np.linalg.norm(face.vertices[:, :2], axis=1).max())
            if face.part == "small_end" and reach > geometry.small_end_radius + _GAP_TOLERANCE:
                limit = f"{geometry.small_end_radius:.6g} m from its axis, not {reach:.6g} m"
                allowed = f"face '{face.name}' must lie within the roller's small end, {limit}"
                found.append(Problem(("faces", place, "outline"), face.outline, allowed))
        return found


class OtherPocket(Model):
    """A pocket of the cage that differs from the others.

    Parameters
    ----------
    index : int
        Number of the pocket, 0 to Z - 1.
    pocket : Pocket
        Its faces.
    """

    index: Annotated[Whole, unit("1", ge=0)]
    pocket: Pocket


def every_face(bearing: Bearing) -> list[tuple[int, Face]]:
    """Every face of every pocket of a bearing's cage: (pocket, face)."""
    return [(pocket, face) for pocket in range(bearing.n_rollers) for face in bearing.pocket_of(pocket).faces]


def every_surface(bearing: Bearing) -> list[tuple[int, Face]]:
    """The first face of every surface of every pocket of a bearing's cage: (pocket, face)."""
    return [(pocket, face) for pocket in range(bearing.n_rollers) for face in bearing.pocket_of(pocket).surfaces]


def _cross(first: FloatArray, second: FloatArray) -> FloatArray:
    """Third component of the cross product of plane vectors, shape (..., 2)."""
    return first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]


def _gap(face: Face, geometry: Geometry) -> float:
    if face.part == "small_end":
        return float(np.min(geometry.small_end_station - face.vertices[:, 2]))
    if face.part == "large_end":
        centre = np.array([0.0, 0.0, geometry.sphere_centre - geometry.apex_to_mid])
        return float(face.distance(centre)) - geometry.sphere_radius
    half_angle = geometry.roller_half_angle
    half_length = geometry.apex_to_large_end - geometry.apex_to_mid
    stations = np.linspace(-half_length, half_length, _FLANK_STATIONS)
    radii = 0.25 * (geometry.large_end_diameter + geometry.small_end_diameter) + stations * np.tan(half_angle)
    centres = np.zeros((_FLANK_STATIONS, 3))
    centres[:, 2] = stations + radii * np.tan(half_angle)
    return float(np.min(face.distance(centres) - radii / np.cos(half_angle)))


def pocket_axes(bearing: Bearing, pocket: int) -> FloatArray:
    """Axes n, t, a of a pocket as rows, in the cage's frame."""
    angle, lean = 2.0 * math.pi * pocket / bearing.n_rollers, bearing.geometry.roller_axis_angle
    sine, cosine = math.sin(lean), math.cos(lean)
    around = math.cos(angle), math.sin(angle)
    return np.array(
        [
            [cosine * around[0], cosine * around[1], -sine],
            [-around[1], around[0], 0.0],
            [sine * around[0], sine * around[1], cosine],
        ]
    )
