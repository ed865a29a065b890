"""A drawing opened by Gmsh, whose kernel for STEP is Open CASCADE. All lengths that leave this module are in m."""

from __future__ import annotations

import math
import os
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import file_path
from trbdyn.base.reading import MOST_TRIANGLES, checked_file, read_input
from trbdyn.errors import FileError, InputError
from trbdyn.extras.cad.stl import doubled, faces_of, read_triangles, solid_of
from trbdyn.model.cage_drawing import MM, STEP_ENDINGS

FloatArray = NDArray[np.float64]

UNITS: Final = {"m": 1.0, "mm": 1e-3, "inch": 25.4e-3}
STEP_UNITS: Final = {
    25.4: ("inches", "millimetres"),
    1.0 / 25.4: ("millimetres", "inches"),
    1e3: ("metres", "millimetres"),
    1e-3: ("millimetres", "metres"),
}
"""By which factor a drawing is too small, and what its numbers and its file say then."""
SIX_NODES: Final = 9
"""Gmsh's number of a triangle with nodes at its corners and the middles of its edges."""
CLOSED: Final = 1e-6
"""Integral of the normal over a closed surface, over its area, at most."""
MOST_FACES: Final = 20_000
"""Most faces of a drawing."""
DEEPEST_STEP: Final = 20
"""Most brackets within brackets in a STEP file."""
_LOCK = threading.RLock()
"""Gmsh has one state for the whole process."""


@dataclass
class DrawnFace:
    """A face of the solid, as drawn."""

    number: int  # in the drawing, from 1
    kind: str  # Plane, Cylinder, Cone, BSpline surface and so on
    area: float  # m2
    centre: FloatArray  # of the area (m)
    triangles: FloatArray  # cover it roughly (m), shape (T, 3, 3); counter-clockwise seen from outside
    neighbours: tuple[tuple[int, FloatArray], ...] = ()  # faces that share an edge, and a point of that edge

    @property
    def is_plane(self) -> bool:
        """Whether it is plane, as drawn."""
        return self.kind == "Plane"


@dataclass
class Drawing:
    """One solid."""

    path: str
    faces: list[DrawnFace]
    volume: float  # m3
    centre: FloatArray  # of the volume (m)
    inertia: FloatArray  # about the centre at a density of 1 (m5), shape (3, 3)
    surfaces: Surfaces | None = None  # None where faces are known by their triangles alone (STL)


def library() -> ModuleType:
    """Gmsh; an ImportError where it is not installed, or lacks a library of the system."""
    try:
        import gmsh
    except ImportError as error:
        raise ImportError("drawings need Gmsh: pip install trbdyn[cad]") from error
    except OSError as error:
        raise ImportError(
            f"Gmsh does not start: {error}; Debian has what it needs as libglu1-mesa libxcursor1 libxft2 libxinerama1 libxrender1"
        ) from error
    return gmsh


@contextmanager
def gmsh_model() -> Iterator[Any]:
    """An empty model of Gmsh, which is alone and silent, in mm."""
    gmsh = library()
    with _LOCK:
        ours = not gmsh.isInitialized()
        if ours:
            gmsh.initialize(interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
            gmsh.option.setNumber("General.NumThreads", 1)
            gmsh.model.add("drawing")
            yield gmsh
        finally:
            if ours:
                gmsh.finalize()
            else:
                gmsh.model.remove()


@dataclass
class Surfaces:
    """Evaluates the faces of an opened drawing."""

    gmsh: Any
    _loops: dict[int, list[list[int]]] = field(default_factory=dict)

    def points(self, face: int, uv: FloatArray) -> FloatArray:
        """Points of a face at parameters, shapes (..., 2) and (..., 3) (m)."""
        found = self.gmsh.model.getValue(2, face, uv.reshape(-1).tolist())
        return MM * np.asarray(found).reshape(*uv.shape[:-1], 3)

    def normals(self, face: int, uv: FloatArray) -> FloatArray:
        """Normals out of the solid there, shape (..., 3)."""
        return np.asarray(self.gmsh.model.getNormal(face, uv.reshape(-1).tolist())).reshape(*uv.shape[:-1], 3)

    def normal_at(self, face: int, point: FloatArray) -> FloatArray:
        """Normal out of the solid at the place of a face next to a point (m)."""
        uv = self.gmsh.model.getParametrization(2, face, (point / MM).tolist())
        return np.asarray(self.gmsh.model.getNormal(face, uv))

    def loops(self, face: int) -> list[list[int]]:
        """Curves of each closed line of a face's border, in turn."""
        if face not in self._loops:
            _, curves = self.gmsh.model.occ.getCurveLoops(face)
            self._loops[face] = [[int(curve) for curve in loop] for loop in curves]
        return self._loops[face]

    def stations(self, curve: int, tolerance: float) -> FloatArray:
        """Parameters of points along a curve, between which it leaves the straight line by less than a tolerance (m)."""
        (low,), (high,) = self.gmsh.model.getParametrizationBounds(1, curve)
        stations = np.array([low, high])
        for _ in range(12):
            between = 0.5 * (stations[1:] + stations[:-1])
            quarter = stations[:-1] + 0.3 * np.diff(stations)
            ends, off = self.along(curve, stations), np.zeros(between.size)
            for at in (between, quarter):
                off = np.maximum(off, _distance_to_lines(self.along(curve, at), ends[:-1], ends[1:]))
            wide = off > tolerance
            if not wide.any():
                return stations
            stations = np.sort(np.concatenate([stations, between[wide]]))
        return stations

    def along(self, curve: int, stations: FloatArray) -> FloatArray:
        """Points of a curve (m), shape (n, 3)."""
        return MM * np.asarray(self.gmsh.model.getValue(1, curve, stations.tolist())).reshape(-1, 3)

    def on_face(self, curve: int, stations: FloatArray, face: int, which: int) -> FloatArray:
        """Parameters of a face along a curve of its border, shape (n, 2)."""
        found = self.gmsh.model.reparametrizeOnSurface(1, curve, stations.tolist(), face, which)
        return np.asarray(found).reshape(-1, 2)


def _distance_to_lines(points: FloatArray, first: FloatArray, last: FloatArray) -> FloatArray:
    way = last - first
    size = np.sum(way * way, axis=1)
    share = np.clip(np.sum((points - first) * way, axis=1) / np.where(size > 0.0, size, 1.0), 0.0, 1.0)
    return np.linalg.norm(points - first - share[:, None] * way, axis=1)


@contextmanager
def opened(
    path: str | os.PathLike[str], *, mesh_size: float, unit: str = "mm", usual: float | None = None
) -> Iterator[Drawing]:
    """A drawing of one solid, as long as the context lasts: a STEP file, or an STL file, which does not tell its unit. Triangles
    of `mesh_size` (m) cover its faces roughly. With the `usual` diameter of what is drawn (m), a wrong unit is refused.
    """
    ending = file_path(path, "drawing").suffix.lower()
    if ending not in (*STEP_ENDINGS, ".stl"):
        raise InputError.of("drawing", str(path), f"must be a file {', '.join(STEP_ENDINGS)} or .stl")
    if unit not in UNITS:
        raise InputError.of("unit", unit, f"must be one of {', '.join(UNITS)}")
    if ending == ".stl":
        yield _stl(checked_file(path, "STL", field="drawing"), unit, usual)
        return
    if unit != "mm":
        raise InputError.of("unit", unit, "must be left out: a STEP file tells its unit")
    file = checked_file(path, "STEP", field="drawing")
    _check_step(file)
    with gmsh_model() as gmsh:
        yield _step(gmsh, str(file), mesh_size, usual)


def _check_step(file: Path) -> None:
    """Refuse what is no STEP file, and one whose brackets are nested so deeply that reading it needs a stack without end."""
    data = read_input(file, "STEP")
    if b"ISO-10303-21" not in data[:512]:
        raise FileError(f"{file}: is no STEP file: it does not begin with ISO-10303-21")
    marks = np.frombuffer(data, dtype=np.uint8)
    level = np.cumsum((marks == ord("(")).astype(np.int32) - (marks == ord(")")))
    if level.size and level.max() > DEEPEST_STEP:
        raise FileError(f"{file}: is no STEP file that can be used: brackets are nested {level.max()} deep")


def _check_size(gmsh: Any, path: str, mesh_size: float) -> None:
    """Refuse a solid that so many triangles cover that they do not fit into memory."""
    faces = gmsh.model.getEntities(2)
    area = MM**2 * sum(gmsh.model.occ.getMass(2, tag) for _, tag in faces)
    if len(faces) > MOST_FACES or not 2.0 * area / mesh_size**2 < MOST_TRIANGLES:
        raise FileError(
            f"{path}: has {len(faces)} faces and {area:.3g} m2, too much to be covered by triangles of {1e3 * mesh_size:.3g} mm: "
            "is its unit right?"
        )


def _step(gmsh: Any, path: str, mesh_size: float, usual: float | None) -> Drawing:
    try:
        gmsh.model.occ.importShapes(path)
        gmsh.model.occ.synchronize()
    except Exception as error:  # Gmsh raises Exception itself
        raise FileError(f"{path}: Open CASCADE cannot read it: {error}") from None
    solids = [tag for _, tag in gmsh.model.getEntities(3)]
    if len(solids) != 1:
        raise FileError(f"{path}: has {len(solids)} solids; a cage is one: join its parts, or save it alone")
    occ = gmsh.model.occ
    box = np.array(gmsh.model.getBoundingBox(-1, -1)).reshape(2, 3)
    if (off := _wrong_unit(MM * float(np.ptp(box, axis=0).max()), usual, STEP_UNITS)) is not None:
        meant, said = STEP_UNITS[off]
        raise FileError(
            f"{path}: is {_times(1.0 / off)} as large as a cage of the bearing: its numbers seem to be {meant}, and the file "
            f"says {said}; save it again with the unit {meant}"
        )
    _check_size(gmsh, path, mesh_size)
    tags = [tag for _, tag in gmsh.model.getEntities(2)]
    triangles = _rough(gmsh, path, tags, mesh_size)
    volume, centre, inertia = _solid(gmsh, path, sum(len(one) for one in triangles.values()))
    faces = [
        DrawnFace(
            number=tag,
            kind=gmsh.model.getType(2, tag),
            area=MM**2 * occ.getMass(2, tag),
            centre=MM * np.array(occ.getCenterOfMass(2, tag)),
            triangles=triangles[tag],
        )
        for tag in tags
    ]
    surfaces = Surfaces(gmsh)
    _connect(faces, _edges(faces, surfaces))
    return Drawing(path, faces, volume, centre, inertia, surfaces)


def _wrong_unit(size: float, usual: float | None, factors: Iterable[float]) -> float | None:
    """By which of some factors a size (m) must be multiplied to be the usual one; None where it is near enough as it is."""
    if usual is None or 0.4 < size / usual < 2.5:
        return None
    best = min(factors, key=lambda factor: abs(math.log(factor * size / usual)))
    return best if 0.6 < best * size / usual < 1.7 else None


def _times(ratio: float) -> str:
    return f"{ratio:g} times" if ratio > 1.0 else f"1/{1.0 / ratio:g}"


def _stl(path: Path, unit: str, usual: float | None) -> Drawing:
    triangles = read_triangles(path, UNITS[unit])
    units = {other / UNITS[unit]: name for name, other in UNITS.items() if name != unit}
    if (off := _wrong_unit(float(np.ptp(triangles.reshape(-1, 3), axis=0).max()), usual, units)) is not None:
        said = f"must be that of the file: with it the cage is {_times(1.0 / off)} as large as one of the bearing"
        raise InputError.of("unit", unit, f"{said}; try {units[off]!r}")
    members, planes, edges, corners = faces_of(path, triangles)
    volume, centre, inertia = solid_of(triangles)
    if volume <= 0.0:
        raise FileError(f"{path}: its triangles are seen clockwise from outside; they must be counter-clockwise")
    owner = np.zeros(len(triangles), dtype=int)
    faces = []
    for number, (own, is_plane) in enumerate(zip(members, planes, strict=True), 1):
        owner[own] = number
        areas = 0.5 * np.linalg.norm(doubled(triangles[own]), axis=1)
        middle = np.average(triangles[own].mean(axis=1), axis=0, weights=areas)
        faces.append(
            DrawnFace(number, "Plane" if is_plane else "Triangles", float(areas.sum()), middle, triangles[own])
        )
    _connect(
        faces,
        (
            ({int(owner[one]), int(owner[other])}, 0.5 * (corners[start] + corners[end]))
            for one, other, start, end in edges
        ),
    )
    return Drawing(str(path), faces, volume, centre, inertia)


def _rough(gmsh: Any, path: str, tags: list[int], mesh_size: float) -> dict[int, FloatArray]:
    gmsh.option.setNumber("Mesh.MeshSizeMax", mesh_size / MM)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.1 * mesh_size / MM)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
    try:
        gmsh.model.mesh.generate(2)
    except Exception as error:
        raise FileError(f"{path}: its faces cannot be covered by triangles: {error}") from None
    points, found = nodes_of(gmsh), {}
    for tag in tags:
        corners = gmsh.model.mesh.getElementsByType(2, tag)[1]
        if not len(corners):
            raise FileError(f"{path}: face {tag} cannot be covered by triangles")
        found[tag] = points[corners.astype(int).reshape(-1, 3)]
    return found


def nodes_of(gmsh: Any) -> FloatArray:
    """Places of the nodes of a mesh (m), each in the row of its number."""
    numbers, places, _ = gmsh.model.mesh.getNodes()
    points = np.zeros((int(numbers.max()) + 1, 3))
    points[numbers.astype(int)] = MM * places.reshape(-1, 3)
    return points


def _solid(gmsh: Any, path: str, count: int) -> tuple[float, FloatArray, FloatArray]:
    """Volume, centre, and moments of inertia about it at a density of 1, of what the faces enclose.

    Faces are covered by triangles with six nodes. With n the normal out of the solid and f homogeneous of degree k,
    div(x f) = (3 + k) f, so that Gauss' theorem gives the integral of f over the solid as that of f x.n / (3 + k) over its faces.
    Open CASCADE's own moments change by some per cent when the same solid is turned.
    """
    gmsh.model.mesh.setOrder(2)
    nodes = gmsh.model.mesh.getElementsByType(SIX_NODES)[1].astype(int).reshape(-1, 6)
    points = nodes_of(gmsh)[nodes]
    origin = points.mean(axis=(0, 1))
    points = points - origin
    line, weights = np.polynomial.legendre.leggauss(5)
    line, weights = 0.5 * (line + 1.0), 0.5 * weights
    volume, first, second, closed, area = 0.0, np.zeros(3), np.zeros((3, 3)), np.zeros(3), 0.0
    for u, of_u in zip(line, weights, strict=True):
        for share, of_share in zip(line, weights, strict=True):
            v = share * (1.0 - u)
            w = 1.0 - u - v
            shape = np.array([w * (2 * w - 1), u * (2 * u - 1), v * (2 * v - 1), 4 * w * u, 4 * u * v, 4 * v * w])
            along_u = np.array([1 - 4 * w, 4 * u - 1, 0.0, 4 * (w - u), 4 * v, -4 * v])
            along_v = np.array([1 - 4 * w, 0.0, 4 * v - 1, -4 * u, 4 * u, 4 * (w - v)])
            place = np.einsum("k,tki->ti", shape, points)
            normal = np.cross(np.einsum("k,tki->ti", along_u, points), np.einsum("k,tki->ti", along_v, points))
            normal *= of_u * of_share * (1.0 - u)
            out = np.einsum("ti,ti->t", place, normal)
            volume += float(out.sum()) / 3.0
            first += out @ place / 4.0
            second += np.einsum("t,ti,tj->ij", out, place, place) / 5.0
            closed += normal.sum(axis=0)
            area += float(np.linalg.norm(normal, axis=1).sum())
    if len(nodes) != count or not volume > 0.0 or not np.abs(closed).max() < CLOSED * area:
        raise FileError(f"{path}: its faces are not the closed surface of one solid")
    centre = first / volume
    second -= volume * np.outer(centre, centre)
    return volume, origin + centre, np.trace(second) * np.eye(3) - second


def _connect(faces: list[DrawnFace], edges: Iterable[tuple[set[int], FloatArray]]) -> None:
    """Tell faces which others share an edge with them, by the numbers of an edge's faces and its middle."""
    shared: dict[int, list[tuple[int, FloatArray]]] = {face.number: [] for face in faces}
    for owners, middle in edges:
        for one in owners:
            shared[one] += [(other, middle) for other in owners if other != one]
    for face in faces:
        face.neighbours = tuple(shared[face.number])


def _edges(faces: list[DrawnFace], surfaces: Surfaces) -> Iterator[tuple[set[int], FloatArray]]:
    """Numbers of the faces that share each curve, and its middle."""
    of_curve: dict[int, set[int]] = {}
    for face in faces:
        for loop in surfaces.loops(face.number):
            for curve in loop:
                of_curve.setdefault(curve, set()).add(face.number)
    for curve, owners in of_curve.items():
        (low,), (high,) = surfaces.gmsh.model.getParametrizationBounds(1, curve)
        yield owners, surfaces.along(curve, np.array([0.5 * (low + high)]))[0]
