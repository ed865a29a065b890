"""From a drawing of a cage to the numbers of a `Cage` (docs/theory/geometry.md#pockets-from-a-drawing)."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import digest_of
from trbdyn.errors import FileError, InputError
from trbdyn.model.drawn.facets import Facet, convex_pieces, facets_of
from trbdyn.model.drawn.opened import Drawing, DrawnFace, opened
from trbdyn.model.drawn.placing import Frustum, Place, axis_of, place_of, pockets_of
from trbdyn.model.geometry import Geometry
from trbdyn.model.pocket import MAX_VERTICES, Face, OtherPocket, Part, Pocket

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

FloatArray = NDArray[np.float64]

NODES: Final = 101
REACH: Final = 0.05
"""How far roller and pocket may move against each other, over the roller's diameter, for the faces that are kept."""
WIDE: Final = 1.05
"""Faces at an end of the roller are kept up to this share of the end's radius."""
END: Final = math.sqrt(0.5)
"""Faces whose normal is nearer to the roller's axis than 45 degrees meet its ends."""
SMOOTH_DEG, SMOOTH_STL_DEG = 2.0, 25.0
"""Faces that meet at less than this angle go on smoothly, of STEP and of STL files."""
NAMES: Final = ("leading_bar", "trailing_bar", "large_end_wall", "small_end_wall")
MOST_FACETS: Final = 2000
"""Most facets of a pocket."""


@dataclass(frozen=True)
class Recognised:
    """What a face of the drawing was taken for.

    Attributes
    ----------
    face : DrawnFace
        The face.
    pocket : int
        Number of the pocket, or -1 where it is part of none.
    surface : str
        Name of the pocket's surface that it belongs to; empty where no roller can touch it.
    """

    face: DrawnFace
    pocket: int
    surface: str


@dataclass(frozen=True)
class Rim:
    """A surface of revolution that a land of a ring can guide.

    Attributes
    ----------
    side : {'outer', 'inner'}
        Which ring's land is opposite to it.
    radius : float
        Its radius (m).
    offset : float
        Axial position of its middle from the roller-centre plane (m).
    width : float
        Its width (m).
    """

    side: str
    radius: float
    offset: float
    width: float


@dataclass(frozen=True, eq=False)
class DrawnCage:
    """A cage as it was recognised in a drawing.

    Attributes
    ----------
    path : str
        The file.
    n_pockets : int
        Number of its pockets.
    place : Place
        Where the drawing lies in the cage's frame.
    pockets : tuple of Pocket
        The different pockets.
    kind_of : tuple of int
        For each pocket, which of them it is.
    volume : float
        Volume (m3).
    offset : float
        Centre of the volume above the roller-centre plane (m).
    centre : ndarray, shape (2,)
        Centre of the volume off the axis of the pockets, along x and y of the cage's frame (m).
    inertia : ndarray, shape (3, 3)
        Moments of inertia about the centre at a density of 1, in the cage's frame (m5).
    tolerance : float
        Largest distance between drawn faces and facets (m).
    plays : dict of str to float
        How far the roller can move from the middle: radial, circumferential, axial (m); infinite where nothing is in the way.
    rims : tuple of Rim
        Surfaces that a land can guide.
    recognised : tuple of Recognised
        All faces of the drawing.
    """

    path: str
    n_pockets: int
    place: Place
    pockets: tuple[Pocket, ...]
    kind_of: tuple[int, ...]
    volume: float
    offset: float
    centre: FloatArray
    inertia: FloatArray
    tolerance: float
    plays: dict[str, float]
    rims: tuple[Rim, ...] = ()
    recognised: tuple[Recognised, ...] = field(default=(), repr=False)

    def fields(self, density: float) -> dict[str, Any]:
        """Fields of `Cage`, for a density (kg/m3)."""
        mass = density * self.volume
        across = 0.5 * density * (self.inertia[0, 0] + self.inertia[1, 1])
        most = max(range(len(self.pockets)), key=self.kind_of.count)
        found: dict[str, Any] = {
            "mass": mass,
            "inertia_axial": density * float(self.inertia[2, 2]),
            "inertia_transverse": float(across),
            "offset": self.offset,
            "drawing": {
                "file": self.path,
                "sha256": digest_of(self.path),
                "origin": tuple(self.place.origin.tolist()),
                "axes": tuple(tuple(row) for row in self.place.turn.tolist()),
            },
            "pocket": self.pockets[most],
            "other_pockets": tuple(
                OtherPocket(index=index, pocket=self.pockets[kind])
                for index, kind in enumerate(self.kind_of)
                if kind != most
            ),
        }
        off = float(np.linalg.norm(self.centre))
        if off > self.tolerance:
            found["unbalance"] = mass * off
            found["unbalance_direction_deg"] = math.degrees(math.atan2(self.centre[1], self.centre[0]))
        return found | {f"play_{name}": value for name, value in self.plays.items() if math.isfinite(value)}


@dataclass(frozen=True)
class _Roller:
    """The nominal roller as its chain of spheres, in the frame of its pocket (m)."""

    geometry: Geometry
    centres: FloatArray
    radii: FloatArray

    @classmethod
    def of(cls, geometry: Geometry) -> _Roller:
        half_angle = geometry.roller_half_angle
        half = geometry.apex_to_large_end - geometry.apex_to_mid
        stations = np.linspace(-half, half, NODES)
        radii = 0.25 * (geometry.large_end_diameter + geometry.small_end_diameter) + stations * math.tan(half_angle)
        centres = np.zeros((NODES, 3))
        centres[:, 2] = stations + radii * math.tan(half_angle)
        return cls(geometry, centres, radii / math.cos(half_angle))

    def gap(self, face: Face, moved: FloatArray) -> float:
        """Gap to a face after the roller has moved (m)."""
        if face.part == "small_end":
            return float(np.min(self.geometry.small_end_station + moved[2] - face.vertices[:, 2]))
        if face.part == "large_end":
            centre = np.array([0.0, 0.0, self.geometry.sphere_centre - self.geometry.apex_to_mid]) + moved
            return float(face.distance(centre)) - self.geometry.sphere_radius
        return float(np.min(face.distance(self.centres + moved) - self.radii))


def read_cage(
    path: str | os.PathLike[str],
    bearing: Bearing,
    *,
    tolerance: float = 1e-6,
    unit: str = "mm",
    roller_plane: float | None = None,
) -> DrawnCage:
    """Recognise a cage in a drawing.

    The cage is placed so that its pockets' middles hold the rollers: bars of both sides have the same gap, and the large ends
    just touch their walls. Where there is no such wall, `roller_plane` must be given.

    Parameters
    ----------
    path : path-like
        STEP (``.step``, ``.stp``) or STL file of one solid. STEP tells its unit.
    bearing : Bearing
        The bearing whose cage it is; its own cage is of no concern.
    tolerance : float
        Largest distance between curved faces and their facets (m).
    unit : {'mm', 'm', 'inch'}
        Unit of an STL file.
    roller_plane : float, optional
        Height of the roller-centre plane above the cage's centre of volume, positive towards the large ends (m).

    Raises
    ------
    InputError
        If an argument is not allowed, or the cage does not belong to the bearing.
    FileError
        If the file cannot be read, or what is in it is not understood.
    ImportError
        If the extra ``trbdyn[cad]`` is not installed.
    """
    geometry = bearing.geometry
    size = bearing.roller.diameter
    if not 1e-8 <= tolerance <= 0.01 * size:
        raise InputError.of("tolerance", tolerance, f"must be from 1e-8 to {0.01 * size:g} (m)")
    with opened(path, mesh_size=0.2 * size, unit=unit) as drawing:
        return _Reader(drawing, bearing, geometry, tolerance, roller_plane).read()


class _Reader:
    def __init__(
        self, drawing: Drawing, bearing: Bearing, geometry: Geometry, tolerance: float, roller_plane: float | None
    ) -> None:
        self.drawing, self.bearing, self.tolerance, self.roller_plane = drawing, bearing, tolerance, roller_plane
        self.roller, self.count = _Roller.of(geometry), bearing.n_rollers
        self.diameter, self.geometry = bearing.roller.diameter, geometry
        self.by_number = {face.number: face for face in drawing.faces}
        sine, cosine = math.sin(geometry.roller_axis_angle), math.cos(geometry.roller_axis_angle)
        self.axes = np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
        self.cut: dict[tuple[int, int], list[Facet]] = {}

    def read(self) -> DrawnCage:
        axis = axis_of(self.drawing)
        found = pockets_of(self.drawing, axis)
        if found != self.count:
            limit = f"must be the number of pockets in {self.drawing.path}, {found}"
            raise InputError.of(("bearing", "n_rollers"), self.count, limit)
        geometry = self.geometry
        half = geometry.apex_to_large_end - geometry.apex_to_mid
        roller = Frustum(
            geometry.roller_axis_angle,
            0.5 * self.bearing.pitch_diameter,
            geometry.small_end_station,
            half,
            0.25 * (geometry.large_end_diameter + geometry.small_end_diameter),
            math.tan(geometry.roller_half_angle),
        )
        place = self._settled(place_of(self.drawing, axis, found, roller))
        kinds, kind_of = self._kinds(place)
        pockets, names = [], {}
        for index in kinds:
            pocket, of_face = self._pocket(place, index)
            pockets.append(pocket)
            names[len(pockets) - 1] = of_face
        return self._cage(place, pockets, kind_of, names, kinds)

    # where the cage lies

    def _settled(self, place: Place) -> Place:
        """Bars of both sides with the same gap, large ends that touch their walls; the middle one of three pockets decides."""
        radius = 0.5 * self.bearing.pitch_diameter
        if self.roller_plane is not None:
            place = replace(place, height=self.roller_plane)
        for _ in range(8):
            moves = [
                self._move(self._surfaces(place, index))
                for index in sorted({0, self.count // 3, (2 * self.count) // 3})
            ]
            across, along = np.median(np.array(moves), axis=0)
            place = replace(place, height=place.height + along, phase=place.phase + across / radius)
            if abs(along) + abs(across) < 1e-14:
                break
        self.cut.clear()
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

    # the faces of a pocket

    def _in_pocket(self, place: Place, index: int) -> tuple[FloatArray, FloatArray]:
        """Axes (rows) and origin of a pocket's frame, in the drawing."""
        angle = 2.0 * math.pi * index / self.count
        cosine, sine = math.cos(angle), math.sin(angle)
        about = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        rows = self.axes @ about @ place.turn
        outward = place.turn.T @ np.array([cosine, sine, 0.0])
        return rows, place.origin + 0.5 * self.bearing.pitch_diameter * outward

    def _is_near(self, points: FloatArray, extents: FloatArray) -> NDArray[np.bool_]:
        """Whether anything within an extent of points in the frame of a pocket is within reach of the roller."""
        reach = REACH * self.diameter + extents
        radius, along, end = np.hypot(points[:, 0], points[:, 1]), points[:, 2], 0.5 * self.geometry.large_end_diameter
        off = np.linalg.norm(self.roller.centres - points[:, None], axis=2) - self.roller.radii
        small, large = self.geometry.small_end_station, self.geometry.large_end_station
        at_flank = (small - reach < along) & (along < large + reach) & (off.min(axis=1) < reach)
        at_end = (radius < WIDE * end + reach) & ((np.abs(along - small) < reach) | (np.abs(along - large) < reach))
        return np.asarray(at_flank | at_end)

    def _may_touch(self, point: FloatArray, extent: float, normal: FloatArray, spread: float) -> bool:
        """Whether the roller can touch anything within an extent of a point, with a normal within an angle of one there.

        A sphere of the flank that touches a face from without has its centre on the face's normal, a radius away. It may be off
        as far as roller and pocket move against each other, and as points and normals of the patch differ; further off, none can.
        """
        if not self._is_near(point[None], np.array([extent]))[0]:
            return False
        if spread > 0.5 or abs(normal[2]) > END - spread:
            return True
        off = np.linalg.norm(self.roller.centres - point - self.roller.radii[:, None] * normal, axis=1)
        return bool(np.any(off < REACH * self.diameter + extent + 2.0 * math.sin(0.5 * spread) * self.roller.radii))

    def _near_faces(self, place: Place, index: int) -> list[DrawnFace]:
        rows, origin = self._in_pocket(place, index)
        found = []
        for face in self.drawing.faces:
            corners = (face.triangles - origin) @ rows.T
            centres = corners.mean(axis=1)
            extents = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
            close = np.linalg.norm(centres, axis=1) < 3.0 * self.diameter + extents + self.bearing.roller.total_length
            if np.any(close) and np.any(self._is_near(centres[close], extents[close])):
                found.append(face)
        return found

    def _facets(self, place: Place, index: int, face: DrawnFace) -> list[Facet]:
        rows, origin = self._in_pocket(place, index)
        key = (index, face.number)
        if key not in self.cut:

            def near(point: FloatArray, extent: float, normal: FloatArray, spread: float) -> bool:
                return self._may_touch(rows @ (point - origin), extent, rows @ normal, spread)

            self.cut[key] = facets_of(self.drawing, face, self.tolerance, near)
        return [facet.moved(rows, origin) for facet in self.cut[key]]

    def _meets(self, facet: Facet) -> Part | None:
        """The part of the roller that can touch the inside of a facet; None if none can."""
        reach, along = REACH * self.diameter, float(facet.normal[2])
        if abs(along) > END:
            part: Part = "large_end" if along < 0.0 else "small_end"
            end = self.geometry.large_end_station if part == "large_end" else self.geometry.small_end_station
            low, high = facet.corners[:, 2].min() - end, facet.corners[:, 2].max() - end
            return part if low < reach and high > -reach else None
        return "flank" if self._touches(facet, reach) else None

    def _touches(self, facet: Facet, reach: float) -> bool:
        """Whether a sphere of the flank can touch a facet elsewhere than from behind an edge of it."""
        centres, radii = self.roller.centres, self.roller.radii
        height = (centres - facet.corners[0]) @ facet.normal
        touching = np.abs(height - radii) < reach
        feet = centres[touching] - height[touching, None] * facet.normal
        return bool(touching.any() and np.any(_outside(facet, feet) < reach))

    def _surfaces(self, place: Place, index: int) -> dict[str, list[Face]]:
        """The surfaces of a pocket by their names, each a list of faces."""
        kept: list[tuple[Part, Facet]] = []
        for face in self._near_faces(place, index):
            for facet in self._facets(place, index, face):
                part = self._meets(facet)
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
            self.geometry.small_end_radius if part == "small_end" else WIDE * 0.5 * self.geometry.large_end_diameter
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

    def _pocket(self, place: Place, index: int) -> tuple[Pocket, dict[int, str]]:
        surfaces = self._surfaces(place, index)
        faces = [face for _, parts in sorted(surfaces.items(), key=lambda item: item[1][0].slot) for face in parts]
        if not any(face.part == "flank" for face in faces):
            raise FileError(f"{self.drawing.path}: pocket {index} has no face that the flank of a roller can touch")
        try:
            pocket = Pocket(faces=tuple(faces))
        except InputError as error:
            raise FileError(f"{self.drawing.path}: pocket {index}: {error}") from None
        if -self.tolerance < min(pocket.gaps(self.geometry).values()) < 0.0:
            pocket = pocket.replace(allow_interference=True)  # pockets of one drawing differ by its rounding
        problems = pocket.problems(self.geometry)
        if problems:
            at = self._of_face(place, index, faces[int(problems[0].path[1])])
            raise FileError(f"{self.drawing.path}: pocket {index}, {at}: {problems[0].allowed}")
        return pocket, self._names_of_faces(place, index, surfaces)

    def _of_face(self, place: Place, index: int, face: Face) -> str:
        """The face of the drawing that a face of a pocket comes from, in words."""
        middle = face.vertices.mean(axis=0)
        near = [
            (float(np.linalg.norm(facet.corners.mean(axis=0) - middle)), drawn)
            for drawn in self._near_faces(place, index)
            for facet in self._facets(place, index, drawn)
        ]
        drawn = min(near, key=lambda pair: pair[0])[1]
        where = ", ".join(f"{1e3 * value:.4g}" for value in drawn.centre)
        return f"face {drawn.number} of the drawing ({drawn.kind}, at ({where}) mm)"

    def _names_of_faces(self, place: Place, index: int, surfaces: dict[str, list[Face]]) -> dict[int, str]:
        """Names of surfaces by the faces of the drawing."""
        planes = [(name, face) for name, faces in surfaces.items() for face in faces]
        found = {}
        for drawn in self._near_faces(place, index):
            for facet in self._facets(place, index, drawn):
                if self._meets(facet) is None:
                    continue
                middle = facet.corners.mean(axis=0)
                close = min(
                    planes,
                    key=lambda pair: (
                        float(pair[1].distance(middle)) + float(np.linalg.norm(pair[1].normal - facet.normal))
                    ),
                )
                if (
                    close[1].distance(middle) < REACH * self.diameter + 1.0
                    and np.linalg.norm(close[1].normal - facet.normal) < 1e-6
                ):
                    found[drawn.number] = close[0]
                    break
        return found

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
        rows, origin = self._in_pocket(place, index)
        marks = []
        for face in self._near_faces(place, index):
            centre = rows @ (face.centre - origin)
            if self._is_whole_ring(face, place):
                continue
            doubled = np.cross(
                face.triangles[:, 1] - face.triangles[:, 0], face.triangles[:, 2] - face.triangles[:, 0]
            ).sum(axis=0)
            normal = rows @ doubled / max(float(np.linalg.norm(doubled)), 1e-30) if face.is_plane else np.zeros(3)
            marks.append(np.concatenate([centre, [face.area], normal]))
        return marks

    def _is_whole_ring(self, face: DrawnFace, place: Place) -> bool:
        own = place.inside(face.triangles.mean(axis=1))
        angles = np.sort(np.arctan2(own[:, 1], own[:, 0]))
        return bool(np.max(np.diff(np.concatenate([angles, angles[:1] + 2.0 * math.pi]))) < 0.5 * math.pi)

    # the whole

    def _cage(
        self,
        place: Place,
        pockets: list[Pocket],
        kind_of: tuple[int, ...],
        names: dict[int, dict[int, str]],
        kinds: list[int],
    ) -> DrawnCage:
        most = max(range(len(pockets)), key=kind_of.count)
        centre = place.inside(self.drawing.centre)
        recognised = []
        for face in self.drawing.faces:
            pocket, surface = -1, ""
            for kind, index in enumerate(kinds):
                if face.number in names[kind]:
                    pocket, surface = index, names[kind][face.number]
            recognised.append(Recognised(face, pocket, surface))
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
            rims=self._rims(place),
            recognised=tuple(recognised),
        )

    def _plays(self, pocket: Pocket) -> dict[str, float]:
        sine, cosine = self.axes[2, 0], self.axes[2, 2]
        outward = np.array([cosine, 0.0, sine])
        ways = {
            "radial": (outward, -outward),
            "circumferential": (np.array([0.0, 1.0, 0.0]), np.array([0.0, -1.0, 0.0])),
        }
        bars = [face for face in pocket.faces if face.part == "flank"]
        found = {name: min(self._closing(bars, way) for way in both) for name, both in ways.items()}
        walls = [face for face in pocket.faces if face.part == "small_end"]
        found["axial"] = self._closing(walls, np.array([0.0, 0.0, -1.0]))
        return found

    def _closing(self, faces: list[Face], way: FloatArray) -> float:
        """How far the roller moves until it touches one of some faces (m); infinite beyond a quarter of its diameter."""
        from scipy.optimize import brentq

        if not faces:
            return math.inf

        def gap(by: float) -> float:
            return min(self.roller.gap(face, by * way) for face in faces)

        low, most = 0.0, 0.25 * self.diameter
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

    def _rims(self, place: Place) -> tuple[Rim, ...]:
        """Cylinders about the axis over the whole circle."""
        found = []
        for face in self.drawing.faces:
            if face.kind != "Cylinder" or not self._is_whole_ring(face, place):
                continue
            own = place.inside(face.triangles.reshape(-1, 3)).reshape(-1, 3, 3)
            radii = np.hypot(own[..., 0], own[..., 1])
            if np.ptp(radii) > self.tolerance:
                continue
            normal = np.cross(own[:, 1] - own[:, 0], own[:, 2] - own[:, 0])
            middle = own.mean(axis=1)
            side = "outer" if np.sum(normal[:, :2] * middle[:, :2]) > 0.0 else "inner"
            low, high = float(own[..., 2].min()), float(own[..., 2].max())
            found.append(Rim(side, float(radii.mean()), 0.5 * (low + high), high - low))
        return tuple(found)


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


def _outside(facet: Facet, feet: FloatArray) -> FloatArray:
    """Distance of points of a facet's plane to it."""
    best = np.full(len(feet), np.inf)
    inside = np.ones(len(feet), dtype=bool)
    for start, end in zip(facet.corners, np.roll(facet.corners, -1, axis=0), strict=True):
        side = end - start
        off = feet - start
        inside &= np.cross(side, off) @ facet.normal >= 0.0
        share = np.clip(off @ side / (side @ side), 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(off - share[:, None] * side, axis=1))
    return np.where(inside, 0.0, best)
