"""From a drawing of a cage to the numbers of a `Cage` (docs/theory/geometry.md#pockets-from-a-drawing)."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.validation import number_of
from trbdyn.errors import FileError, InputError
from trbdyn.extras.cad.cage import DrawnCage
from trbdyn.extras.cad.corners import depth_in, edges_of, radius_of
from trbdyn.extras.cad.opened import Drawing, DrawnFace, opened
from trbdyn.extras.cad.placing import Frustum, Place, axis_of, place_of, pockets_of, span
from trbdyn.extras.cad.roller import REACHES
from trbdyn.extras.cad.stl import doubled
from trbdyn.extras.cad.surfaces import NAMES, Surfaces
from trbdyn.model.pocket import Face, Pocket

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

FloatArray = NDArray[np.float64]

NARROWED: Final = 0.1
"""Share of the circumferential play by which a corner of the window may narrow it."""


def read_cage(
    path: str | os.PathLike[str],
    bearing: Bearing,
    *,
    tolerance: float = 1e-6,
    unit: str = "mm",
    roller_plane: float | None = None,
    chamfer: float | None = None,
) -> DrawnCage:
    """Recognise a cage in a drawing, with arguments and errors of `Cage.from_step`."""
    size = bearing.roller.diameter
    tolerance = number_of("tolerance", tolerance, "m", ge=1e-8, le=0.01 * size)
    roller = bearing.roller
    if chamfer is None:
        chamfer = 0.5 * (roller.total_length - roller.effective_length)
    else:
        chamfer = number_of("chamfer", chamfer, "m", ge=0.0, le=0.25 * size)
    with opened(path, mesh_size=0.2 * size, unit=unit, usual=bearing.pitch_diameter + 0.3 * size) as drawing:
        return _Reader(drawing, bearing, tolerance, roller_plane, chamfer).read()


class _Reader:
    """Places the cage, and puts its pockets together."""

    def __init__(
        self, drawing: Drawing, bearing: Bearing, tolerance: float, roller_plane: float | None, chamfer: float
    ) -> None:
        self.drawing, self.bearing, self.tolerance, self.roller_plane = drawing, bearing, tolerance, roller_plane
        self.count, self.chamfer = bearing.n_rollers, chamfer

    def _reach_for(self, share: float) -> None:
        reach = share * self.bearing.roller.diameter
        self.surfaces = Surfaces(self.drawing, self.bearing, self.tolerance, reach)
        self.roller, self.axes = self.surfaces.roller, self.surfaces.axes

    def read(self) -> DrawnCage:
        """The cage with all faces that rollers reach: faces further away are left out only where plays are smaller."""
        start = self._placed()
        for share in REACHES:
            self._reach_for(share)
            if share < REACHES[-1] and not self._is_reached(start):
                continue
            place = self._settled(start)
            kinds, kind_of = self._kinds(place)
            cage = self._cage(place, [self._pocket(place, index) for index in kinds], kind_of)
            if max(play for pocket in cage.pockets for play in self._plays(pocket).values()) <= self.roller.reach:
                break
        return cage

    def _placed(self) -> Place:
        """Where the cage lies, as far as its triangles tell."""
        self._reach_for(REACHES[0])
        axis = axis_of(self.drawing)
        found = pockets_of(self.drawing, axis)
        if found < self.count and self.count % found == 0:
            raise FileError(
                f"{self.drawing.path}: no pitch is found by which all {self.count} pockets come together: only {found} turns "
                "of the cage do; pockets must be alike, triangles of an STL file fine enough for it, and bearing.n_rollers their "
                "number"
            )
        if found != self.count:
            limit = f"must be the number of pockets in {self.drawing.path}, {found}"
            raise InputError.of(("bearing", "n_rollers"), self.count, limit)
        geometry = self.roller.geometry
        half = geometry.apex_to_large_end - geometry.apex_to_mid
        roller = Frustum(
            geometry.roller_axis_angle,
            0.5 * self.bearing.pitch_diameter,
            geometry.small_end_station,
            half,
            0.25 * (geometry.large_end_diameter + geometry.small_end_diameter),
            math.tan(geometry.roller_half_angle),
        )
        return place_of(self.drawing, axis, found, roller)

    def _is_reached(self, place: Place) -> bool:
        """Whether bars of both sides, and a wall at the large ends where it tells the place, are within reach."""
        surfaces = self.surfaces.of_pocket(place, 0)
        bars = all(any(name.startswith(bar) for name in surfaces) for bar in NAMES[:2])
        return bars and (
            self.roller_plane is not None or any(faces[0].part == "large_end" for faces in surfaces.values())
        )

    # where the cage lies

    def _settled(self, place: Place) -> Place:
        """Bars of both sides with the same gap, large ends that touch their walls; the middle one of three pockets decides."""
        radius = 0.5 * self.bearing.pitch_diameter
        if self.roller_plane is not None:
            place = replace(place, height=self.roller_plane)
        for _ in range(8):
            moves = [
                self._move(self.surfaces.of_pocket(place, index))
                for index in sorted({0, self.count // 3, (2 * self.count) // 3})
            ]
            across, along = np.median(np.array(moves), axis=0)
            place = replace(place, height=place.height + along, phase=place.phase + across / radius)
            if abs(along) + abs(across) < 1e-14:
                break
        self.surfaces.cut.clear()
        return place

    def _move(self, surfaces: dict[str, list[Face]]) -> tuple[float, float]:
        """How far the roller must move across its pocket, and along the cage's axis, to lie in the middle, at the wall (m)."""
        sides = [
            [face for name, faces in surfaces.items() if name.startswith(bar) for face in faces] for bar in NAMES[:2]
        ]
        walls = [face for faces in surfaces.values() for face in faces if face.part == "large_end"]
        if self.roller_plane is None and not walls:
            limit = "must be given: no wall is found at the large ends of the rollers, which the cage's place follows from (m)"
            raise InputError.of("roller_plane", None, limit)
        moved = np.zeros(2)

        def gap(faces: list[Face]) -> float:
            way = moved[0] * np.array([0.0, 1.0, 0.0]) + moved[1] * self.axes[:, 2]
            return min(self.roller.gap(face, way) for face in faces)

        for _ in range(6):
            before = moved.copy()
            if all(sides):
                moved[0] += 0.5 * (gap(sides[0]) - gap(sides[1]))
            if self.roller_plane is None:
                moved[1] += gap(walls) / self.axes[2, 2]
            if np.abs(moved - before).max() < 1e-15:
                break
        return float(moved[0]), float(moved[1])

    # a pocket

    def _pocket(self, place: Place, index: int) -> Pocket:
        surfaces = self.surfaces.of_pocket(place, index)
        faces = [face for _, parts in sorted(surfaces.items(), key=lambda item: item[1][0].slot) for face in parts]
        if not any(face.part == "flank" for face in faces):
            raise FileError(f"{self.drawing.path}: pocket {index} has no face that the flank of a roller can touch")
        try:
            pocket = Pocket(faces=tuple(faces))
        except InputError as error:
            raise FileError(f"{self.drawing.path}: pocket {index}: {error}") from None
        if -self.tolerance < min(pocket.gaps(self.roller.geometry).values()) < 0.0:
            pocket = pocket.replace(allow_interference=True)  # pockets of one drawing differ by its rounding
        problems = pocket.problems(self.roller.geometry)
        if problems:
            face = faces[int(problems[0].path[1])]
            at, gap = self._of_face(place, index, face), pocket.gaps(self.roller.geometry)[face.name]
            said = f"the roller in the middle of its pocket is {-1e3 * gap:.3g} mm inside of it: is it this bearing's cage?"
            raise FileError(f"{self.drawing.path}: pocket {index}, {at}: {said if gap < 0.0 else problems[0].allowed}")
        self._check_corners(place, index, pocket)
        return pocket

    def _check_corners(self, place: Place, index: int, pocket: Pocket) -> None:
        """Refuse a corner of a window that the roller comes upon before it touches bar and wall: no face of a pocket is hit by
        the edge of an end.
        """
        corners = [
            (face, self.surfaces.corner_facets(place, index, face))
            for face in self.surfaces.near_faces(place, index)
            if self._is_of(place, index, face) and self.surfaces.is_corner(place, index, face)
        ]
        plays = {name: min(value, self.roller.reach) for name, value in self._plays(pocket).items()}
        outward, across = np.array([self.axes[2, 2], 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
        sides = [way * plays["circumferential"] * across for way in (0.0, -1.0, 1.0)]
        sides += [way * plays["radial"] * outward for way in (-1.0, 1.0)]
        edges = edges_of(self.bearing, self.chamfer)
        moved = [side - along * np.array([0.0, 0.0, 1.0]) for side in sides for along in (0.0, plays["axial"])]
        for face, facets in corners:
            depth = max(depth_in(facets, edges + way, self.roller.reach) for way in moved)
            if depth > 1.5 * self.tolerance + NARROWED * plays["circumferential"]:
                radius = radius_of(*self.surfaces.samples(place, index, face))
                size = f" of radius {1e3 * radius:.3g} mm" if not face.is_plane else ""
                raise FileError(
                    f"{self.drawing.path}: pocket {index}, {_in_words(face)}: the end of the roller, whose edge is rounded by "
                    f"chamfer = {1e3 * self.chamfer:.3g} mm, would meet this corner of the window{size} by {1e3 * depth:.3g} mm "
                    "before it touches bar or wall, which is not simulated; give the roller's chamfer (m) if it is larger: half "
                    "of total less effective length is taken without it; or draw the corner with a smaller radius"
                )

    def _is_of(self, place: Place, index: int, face: DrawnFace) -> bool:
        """Whether a face lies in the sector of a pocket, and not in that of the next one."""
        x, y, _ = place.inside(face.centre)
        turned = math.atan2(y, x) - 2.0 * math.pi * index / self.count
        return abs(math.remainder(turned, 2.0 * math.pi)) < math.pi / self.count

    def _of_face(self, place: Place, index: int, face: Face) -> str:
        """The face of the drawing that a face of a pocket comes from, in words."""
        middle = face.vertices.mean(axis=0)
        near = [
            (float(np.linalg.norm(facet.corners.mean(axis=0) - middle)), drawn)
            for drawn in self.surfaces.near_faces(place, index)
            for facet in self.surfaces.facets(place, index, drawn)
        ]
        return _in_words(min(near, key=lambda pair: pair[0])[1])

    # pockets that differ

    def _kinds(self, place: Place) -> tuple[list[int], tuple[int, ...]]:
        """One pocket of each kind, and the kind of every pocket."""
        seen: list[tuple[int, list[FloatArray]]] = []
        kind_of = []
        for index in range(self.count):
            marks = self._marks(place, index)
            for kind, (_, other) in enumerate(seen):
                if len(marks) == len(other) and all(any(self._alike(mark, its) for its in other) for mark in marks):
                    kind_of.append(kind)
                    break
            else:
                kind_of.append(len(seen))
                seen.append((index, marks))
        return [index for index, _ in seen], tuple(kind_of)

    def _alike(self, mark: FloatArray, other: FloatArray) -> bool:
        far = np.linalg.norm(mark[:3] - other[:3]) < self.tolerance + 1e-9
        return bool(far and abs(mark[3] - other[3]) <= 1e-4 * mark[3] and np.linalg.norm(mark[4:] - other[4:]) < 1e-5)

    def _marks(self, place: Place, index: int) -> list[FloatArray]:
        """What tells a pocket: centre, area and mean normal of its faces in its frame."""
        rows, origin = self.surfaces.in_pocket(place, index)
        marks = []
        for face in self.surfaces.near_faces(place, index):
            centre = rows @ (face.centre - origin)
            if self._is_whole_ring(face, place):
                continue
            whole = doubled(face.triangles).sum(axis=0)
            normal = rows @ whole / max(float(np.linalg.norm(whole)), 1e-30) if face.is_plane else np.zeros(3)
            marks.append(np.concatenate([centre, [face.area], normal]))
        return marks

    def _is_whole_ring(self, face: DrawnFace, place: Place) -> bool:
        own = place.inside(face.triangles.mean(axis=1))
        return span(np.arctan2(own[:, 1], own[:, 0])) > 1.5 * math.pi

    # the whole

    def _cage(self, place: Place, pockets: list[Pocket], kind_of: tuple[int, ...]) -> DrawnCage:
        most = max(range(len(pockets)), key=kind_of.count)
        centre = place.inside(self.drawing.centre)
        return DrawnCage(
            path=self.drawing.path,
            n_pockets=self.count,
            place=place,
            pockets=tuple(pockets),
            kind_of=kind_of,
            volume=self.drawing.volume,
            offset=float(centre[2]),
            centre=centre[:2],
            inertia=place.turn @ self.drawing.inertia @ place.turn.T,
            tolerance=self.tolerance,
            plays=self._plays(pockets[most]),
        )

    def _plays(self, pocket: Pocket) -> dict[str, float]:
        sine, cosine = self.axes[2, 0], self.axes[2, 2]
        outward = np.array([cosine, 0.0, sine])
        ways = {
            "radial": (outward, -outward),
            "circumferential": (np.array([0.0, 1.0, 0.0]), np.array([0.0, -1.0, 0.0])),
        }
        bars = [face for face in pocket.faces if face.part == "flank"]
        found = {name: min(self.roller.closing(bars, way) for way in both) for name, both in ways.items()}
        walls = [face for face in pocket.faces if face.part == "small_end"]
        found["axial"] = self.roller.closing(walls, np.array([0.0, 0.0, -1.0]))
        return found


def _in_words(face: DrawnFace) -> str:
    where = ", ".join(f"{1e3 * value:.4g}" for value in face.centre)
    return f"face {face.number} of the drawing ({face.kind}, at ({where}) mm)"
