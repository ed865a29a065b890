"""The surfaces of a drawn pocket that a roller can touch, each a list of plane faces."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import FileError
from trbdyn.extras.cad.corners import BAR, WALL, is_corner
from trbdyn.extras.cad.facets import Facet, convex_pieces, facets_of
from trbdyn.extras.cad.opened import Drawing, DrawnFace
from trbdyn.extras.cad.placing import Place, samples
from trbdyn.extras.cad.roller import WIDE, RollerInPocket
from trbdyn.model.pocket import MAX_VERTICES, Face, Part

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

FloatArray = NDArray[np.float64]

SMOOTH_DEG, SMOOTH_STL_DEG = 2.0, 25.0
"""Faces that meet at less than this angle go on smoothly, of STEP and of STL files."""
NAMES: Final = ("leading_bar", "trailing_bar", "large_end_wall", "small_end_wall")
MOST_FACETS: Final = 2000
"""Most facets of a pocket."""


class Surfaces:
    """The surfaces of each pocket, for a place of the cage, as far as a roller can move (m)."""

    def __init__(self, drawing: Drawing, bearing: Bearing, tolerance: float, reach: float) -> None:
        self.drawing, self.bearing, self.tolerance = drawing, bearing, tolerance
        self.roller = RollerInPocket.of(bearing, reach)
        self.by_number = {face.number: face for face in drawing.faces}
        angle = bearing.geometry.roller_axis_angle
        sine, cosine = math.sin(angle), math.cos(angle)
        self.axes = np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
        self.cut: dict[tuple[int, int], list[Facet]] = {}
        self._corners: dict[tuple[int, int], bool] = {}

    def in_pocket(self, place: Place, index: int) -> tuple[FloatArray, FloatArray]:
        """Axes (rows) and origin of a pocket's frame, in the drawing."""
        angle = 2.0 * math.pi * index / self.bearing.n_rollers
        cosine, sine = math.cos(angle), math.sin(angle)
        about = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        rows = self.axes @ about @ place.turn
        outward = place.turn.T @ np.array([cosine, sine, 0.0])
        return rows, place.origin + 0.5 * self.bearing.pitch_diameter * outward

    def near_faces(self, place: Place, index: int) -> list[DrawnFace]:
        rows, origin = self.in_pocket(place, index)
        found = []
        for face in self.drawing.faces:
            corners = (face.triangles - origin) @ rows.T
            centres = corners.mean(axis=1)
            extents = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
            reach = 3.0 * self.roller.diameter + extents + self.bearing.roller.total_length
            close = np.linalg.norm(centres, axis=1) < reach
            if np.any(close) and np.any(self.roller.is_near(centres[close], extents[close])):
                found.append(face)
        return found

    def facets(self, place: Place, index: int, face: DrawnFace) -> list[Facet]:
        rows, origin = self.in_pocket(place, index)
        key = (index, face.number)
        if key not in self.cut:

            def near(point: FloatArray, extent: float, normal: FloatArray, spread: float) -> bool:
                return self.roller.may_touch(rows @ (point - origin), extent, rows @ normal, spread)

            self.cut[key] = facets_of(self.drawing, face, self.tolerance, near)
        return [facet.moved(rows, origin) for facet in self.cut[key]]

    def is_corner(self, place: Place, index: int, face: DrawnFace) -> bool:
        """Whether a face is a corner of a pocket's window, which leads from a bar to an end wall, rounded or cut."""
        if (key := (index, face.number)) not in self._corners:
            points, normals = self.samples(place, index, face)
            self._corners[key] = (
                self._is_cut(place, index, face, float(abs(normals[0, 2])))
                if face.is_plane
                else is_corner(points, normals, self.bearing.roller.effective_length)
            )
        return self._corners[key]

    def samples(self, place: Place, index: int, face: DrawnFace) -> tuple[FloatArray, FloatArray]:
        """Points of a face and its normals, in the frame of a pocket."""
        rows, origin = self.in_pocket(place, index)
        points, normals = samples(self.drawing, face)
        return (points - origin) @ rows.T, normals @ rows.T

    def _is_cut(self, place: Place, index: int, face: DrawnFace, lean: float) -> bool:
        """Whether a plane face lies in the notch between a bar and an end wall."""
        if not BAR < lean < WALL:
            return False
        beside = []
        for number, point in face.neighbours:
            other = self.by_number[number]
            if not self._joins(face, other, point):
                beside.append(np.abs(self.samples(place, index, other)[1][:, 2]))
        return any(own.max() < BAR for own in beside) and any(own.min() > WALL for own in beside)

    def corner_facets(self, place: Place, index: int, face: DrawnFace) -> list[Facet]:
        """A corner of a pocket's window as facets, as far as the roller is near."""
        rows, origin = self.in_pocket(place, index)

        def near(point: FloatArray, extent: float, _: FloatArray, __: float) -> bool:
            return bool(self.roller.is_near((rows @ (point - origin))[None], np.array([extent]))[0])

        return [facet.moved(rows, origin) for facet in facets_of(self.drawing, face, self.tolerance, near)]

    def of_pocket(self, place: Place, index: int) -> dict[str, list[Face]]:
        """The surfaces of a pocket by their names, each a list of faces."""
        kept: list[tuple[Part, Facet]] = []
        for face in self.near_faces(place, index):
            if self.is_corner(place, index, face):
                continue
            for facet in self.facets(place, index, face):
                part = self.roller.meets(facet)
                if part is not None:
                    kept += [(part, piece) for piece in self._clipped(part, facet)]
        surfaces: dict[str, list[Face]] = {}
        for part, facets in sorted(self._joined(kept, index), key=self._distance):
            name = self._name(part, facets, surfaces)
            slot = NAMES.index(name) if name in NAMES else len(NAMES) + sum(other not in NAMES for other in surfaces)
            surfaces[name] = self._faces(part, name, slot, facets)
        return surfaces

    def _distance(self, surface: tuple[Part, list[Facet]]) -> float:
        """Distance of the roller from a surface, so that the nearest one gets the plain name."""
        part, facets = surface
        return min(self.roller.gap(_face(facet, part, "surface", 0), np.zeros(3)) for facet in facets)

    def _clipped(self, part: Part, facet: Facet) -> Iterator[Facet]:
        """What an end of the roller covers of a facet: for a plane small-end wall the convex outline of it."""
        if part == "flank":
            yield facet
            return
        import shapely

        radius = (
            self.roller.geometry.small_end_radius
            if part == "small_end"
            else WIDE * 0.5 * self.roller.geometry.large_end_diameter
        )
        flat = facet.corners[:, :2]
        if np.linalg.norm(flat, axis=1).max() <= radius:
            yield facet
            return
        disc = shapely.Point(0.0, 0.0).buffer(radius * (1.0 - 1e-9), quad_segs=16)
        cut = shapely.Polygon(flat).intersection(disc)
        for piece in convex_pieces(cut):
            lifted = np.column_stack([piece, self._height(facet, piece)])
            yield Facet(lifted if facet.normal[2] > 0.0 else lifted[::-1], facet.normal, facet.face)

    @staticmethod
    def _height(facet: Facet, flat: FloatArray) -> FloatArray:
        return np.asarray(facet.corners[0, 2] - (flat - facet.corners[0, :2]) @ facet.normal[:2] / facet.normal[2])

    def _joined(self, kept: list[tuple[Part, Facet]], index: int) -> list[tuple[Part, list[Facet]]]:
        """Facets as surfaces: faces that meet the same part of the roller and join without a notch are one."""
        groups: dict[tuple[Part, int], int] = {}
        for part, facet in kept:
            groups.setdefault((part, facet.face), len(groups))
        parent = list(range(len(groups)))

        def root(one: int) -> int:
            while parent[one] != one:
                one = parent[one]
            return one

        for (part, number), one in groups.items():
            for other, point in self.by_number[number].neighbours:
                if (part, other) in groups and self._joins(self.by_number[number], self.by_number[other], point):
                    parent[root(groups[part, other])] = root(one)
        found: dict[int, tuple[Part, list[Facet]]] = {}
        for part, facet in kept:
            found.setdefault(root(groups[part, facet.face]), (part, []))[1].append(facet)
        if sum(len(facets) for _, facets in found.values()) > MOST_FACETS:
            raise FileError(
                f"{self.drawing.path}: pocket {index} needs more than {MOST_FACETS} facets within {1e6 * self.tolerance:g} um; "
                "a larger tolerance needs fewer"
            )
        return list(found.values())

    def _joins(self, one: DrawnFace, other: DrawnFace, point: FloatArray) -> bool:
        """Whether the solid has no notch where two faces meet: the other face falls off, or goes on smoothly."""
        near = [
            face.triangles[int(np.argmin(np.linalg.norm(face.triangles.mean(axis=1) - point, axis=1)))]
            for face in (one, other)
        ]
        if (surfaces := self.drawing.surfaces) is not None:
            first, second = (surfaces.normal_at(face.number, point) for face in (one, other))
        else:
            first, second = (np.cross(corners[1] - corners[0], corners[2] - corners[0]) for corners in near)
            first, second = first / np.linalg.norm(first), second / np.linalg.norm(second)
        away = near[1].mean(axis=0) - point
        smooth = math.radians(SMOOTH_DEG if surfaces is not None else SMOOTH_STL_DEG)
        return bool(first @ second > math.cos(smooth) or away @ first <= 0.0)

    def _name(self, part: Part, facets: list[Facet], taken: dict[str, list[Face]]) -> str:
        areas = np.array([_area(facet) for facet in facets])
        normal = np.average([facet.normal for facet in facets], axis=0, weights=areas)
        if part != "flank":
            name = f"{part}_wall"
        elif abs(normal[1]) > 0.3 * np.linalg.norm(normal):
            name = "leading_bar" if normal[1] < 0.0 else "trailing_bar"
        else:
            name = "inner_stop" if normal[0] > 0.0 else "outer_stop"
        number = 1
        while (name if number == 1 else f"{name}_{number}") in taken:
            number += 1
        return name if number == 1 else f"{name}_{number}"

    def _faces(self, part: Part, name: str, slot: int, facets: list[Facet]) -> list[Face]:
        """The faces of a surface; the one in its middle comes first."""
        if part == "small_end" and len(facets) > 1 and np.ptp([facet.normal for facet in facets], axis=0).max() < 1e-9:
            facets = [self._hull(facets)]
        middle = np.average([f.corners.mean(axis=0) for f in facets], axis=0, weights=[_area(f) for f in facets])
        facets = sorted(facets, key=lambda facet: float(np.linalg.norm(facet.corners.mean(axis=0) - middle)))
        return [
            _face(facet, part, name if not number else f"{name}/{number}", slot) for number, facet in enumerate(facets)
        ]

    def _hull(self, facets: list[Facet]) -> Facet:
        """Convex outline of plane facets, by at most 12 of its corners."""
        import shapely

        flat = np.concatenate([facet.corners[:, :2] for facet in facets])
        outline = np.array(shapely.MultiPoint(flat).convex_hull.exterior.coords)[:-1]
        if not shapely.Polygon(outline).exterior.is_ccw:
            outline = outline[::-1]
        while len(outline) > MAX_VERTICES:
            before, after = outline - np.roll(outline, 1, axis=0), np.roll(outline, -1, axis=0) - outline
            outline = np.delete(
                outline, int(np.argmin(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])), axis=0
            )
        first = facets[0]
        lifted = np.column_stack([outline, self._height(first, outline)])
        return Facet(lifted if first.normal[2] > 0.0 else lifted[::-1], first.normal, first.face)


def _face(facet: Facet, part: Part, name: str, slot: int) -> Face:
    sides = np.roll(facet.corners, -1, axis=0) - facet.corners
    longest = sides[int(np.argmax(np.linalg.norm(sides, axis=1)))]
    u = longest - facet.normal * (longest @ facet.normal)
    u /= np.linalg.norm(u)
    v = np.cross(facet.normal, u)
    origin = facet.corners.mean(axis=0)
    outline = (facet.corners - origin) @ np.array([u, v]).T
    return Face(
        name=name,
        slot=slot,
        part=part,
        origin=tuple(origin.tolist()),
        u=tuple(u.tolist()),
        v=tuple(v.tolist()),
        outline=tuple((float(x), float(y)) for x, y in outline),
    )


def _area(facet: Facet) -> float:
    first = facet.corners[0]
    return float(0.5 * np.linalg.norm(np.cross(facet.corners[1:-1] - first, facet.corners[2:] - first).sum(axis=0)))
