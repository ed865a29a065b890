"""Faces of a drawing as convex polygons: planes exactly, curved faces within a tolerance
(docs/theory/geometry.md#pockets-from-a-drawing).

A curved face is cut along its parameters into cells, each halved across the parameter in which it bends most until its surface
leaves the plane of its corners by less than the tolerance; so a cylinder becomes strips, whatever its length. Cells are clipped
by the border of the face.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import FileError
from trbdyn.extras.cad.opened import Drawing, DrawnFace, Surfaces
from trbdyn.extras.cad.stl import doubled
from trbdyn.model.pocket import MAX_VERTICES

FloatArray = NDArray[np.float64]
MOST_CELLS: Final = 20000
"""Most cells of a face."""


@dataclass(frozen=True)
class Facet:
    """A convex polygon."""

    corners: FloatArray  # counter-clockwise seen along minus the normal (m), shape (n, 3)
    normal: FloatArray  # unit vector out of the solid
    face: int  # number of the face that it is part of

    def moved(self, turn: FloatArray, origin: FloatArray) -> Facet:
        """In axes that are the rows of `turn`, from an origin."""
        return Facet((self.corners - origin) @ turn.T, turn @ self.normal, self.face)


Corner = tuple[float, ...]
Near = Callable[[FloatArray, float, FloatArray, float], bool]
"""Whether a roller may touch anything within an extent (m) of a point, where normals are within an angle (rad) of one there."""


def facets_of(drawing: Drawing, face: DrawnFace, tolerance: float, near: Near) -> list[Facet]:
    """A face as facets, which leave it by at most a tolerance (m); those that are not near are left out. A face whose border is
    not understood, or that needs too many facets, is refused.
    """
    surfaces = drawing.surfaces
    if surfaces is None:
        return _of_triangles(face, near)
    if face.is_plane:
        return _of_plane(drawing.path, surfaces, face, tolerance)
    return _of_curved(drawing.path, surfaces, face, tolerance, near)


def _of_triangles(face: DrawnFace, near: Near) -> list[Facet]:
    if face.is_plane:
        import shapely

        normal, origin, axes = plane_of(face.triangles)
        flat = [shapely.Polygon((corners - origin) @ axes.T) for corners in face.triangles]
        whole = shapely.union_all(flat, grid_size=1e-9).simplify(1e-8)
        return [_lifted(piece, origin, axes, normal, face.number) for piece in convex_pieces(whole)]
    found = []
    for corners in face.triangles:
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        centre = corners.mean(axis=0)
        normal = normal / np.linalg.norm(normal)
        if near(centre, float(np.linalg.norm(corners - centre, axis=1).max()), normal, 0.0):
            found.append(Facet(corners, normal, face.number))
    return found


def plane_of(triangles: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Normal, a point, and two axes (rows) of the plane of triangles."""
    whole = doubled(triangles).sum(axis=0)
    normal = whole / np.linalg.norm(whole)
    points = triangles.reshape(-1, 3)
    origin = points.mean(axis=0)
    first = points[int(np.argmax(np.linalg.norm(points - origin, axis=1)))] - origin
    first -= normal * (first @ normal)
    first /= np.linalg.norm(first)
    return normal, origin, np.array([first, np.cross(normal, first)])


def _lifted(flat: FloatArray, origin: FloatArray, axes: FloatArray, normal: FloatArray, face: int) -> Facet:
    return Facet(origin + flat @ axes, normal, face)


def _of_plane(path: str, surfaces: Surfaces, face: DrawnFace, tolerance: float) -> list[Facet]:
    import shapely

    (ulow, vlow), (uhigh, vhigh) = surfaces.gmsh.model.getParametrizationBounds(2, face.number)
    uv = np.array([[0.5 * (ulow + uhigh), 0.5 * (vlow + vhigh)]])
    normal, origin = surfaces.normals(face.number, uv)[0], surfaces.points(face.number, uv)[0]
    longest = face.triangles.reshape(-1, 3) - origin
    first = longest[int(np.argmax(np.linalg.norm(longest, axis=1)))]
    first = first - normal * (first @ normal)
    first /= np.linalg.norm(first)
    axes = np.array([first, np.cross(normal, first)])
    rings = []
    for loop in surfaces.loops(face.number):
        lines = [surfaces.along(curve, surfaces.stations(curve, 0.4 * tolerance)) for curve in loop]
        rings.append((_chained(path, face, [[line] for line in lines], 1e-6) - origin) @ axes.T)
    whole = _polygon(shapely, rings).simplify(0.5 * tolerance)
    return [_lifted(piece, origin, axes, normal, face.number) for piece in convex_pieces(whole)]


def _of_curved(path: str, surfaces: Surfaces, face: DrawnFace, tolerance: float, near: Near) -> list[Facet]:
    import shapely

    rings = []
    for loop in surfaces.loops(face.number):
        lines = []
        for curve in loop:
            stations = surfaces.stations(curve, 0.5 * tolerance)
            sides = 2 if loop.count(curve) > 1 else 1
            lines.append([surfaces.on_face(curve, stations, face.number, which) for which in range(sides)])
        rings.append(_chained(path, face, lines, None))
    low, high = np.min(np.concatenate(rings), axis=0), np.max(np.concatenate(rings), axis=0)
    scale = 1.0 / np.maximum(high - low, 1e-300)
    size = float(np.linalg.norm(np.ptp(face.triangles.reshape(-1, 3), axis=0)))
    border = _polygon(shapely, [(ring - low) * scale for ring in rings]).simplify(0.5 * tolerance / size)
    found: list[Facet] = []
    cells = [(np.zeros(2), np.ones(2))]
    tried = 0
    while cells:
        corner, far = cells.pop()
        tried += 1
        if tried > MOST_CELLS:
            raise FileError(
                f"{path}: face {face.number} ({face.kind}) needs more than {MOST_CELLS} cells within {1e6 * tolerance:g} um"
            )
        shares = np.linspace(0.0, 1.0, 3)
        grid = corner + (far - corner) * np.stack(np.meshgrid(shares, shares, indexing="ij"), axis=-1)
        at = surfaces.points(face.number, low + grid / scale)
        centre = at[1, 1]
        normals = surfaces.normals(face.number, low + grid / scale)
        normal = normals[1, 1]
        spread = 1.5 * float(np.arccos(np.clip(normals @ normal, -1.0, 1.0)).max())
        if not near(centre, 1.5 * float(np.linalg.norm(at - centre, axis=-1).max()), normal, spread):
            continue
        bend_u, bend_v = _bend(at), _bend(at.swapaxes(0, 1))
        twist = 0.25 * abs(float((at[0, 0] + at[2, 2] - at[0, 2] - at[2, 0]) @ normal))
        if bend_u + bend_v + twist > tolerance:
            halves = (
                [0]
                if bend_u > 2.0 * bend_v and bend_u > twist
                else [1]
                if bend_v > 2.0 * bend_u and bend_v > twist
                else [0, 1]
            )
            cells += _halved(corner, far, halves)
            continue
        piece = border.intersection(shapely.box(*corner, *far))
        for flat in convex_pieces(piece):
            points = surfaces.points(face.number, low + flat / scale)
            facet = _flattened(points, normal, face.number)
            if facet is not None:
                found.append(facet)
    return found


def _bend(at: FloatArray) -> float:
    """How far the middle of a grid's lines along its first axis is off the straight lines."""
    return float(np.linalg.norm(at[1] - 0.5 * (at[0] + at[2]), axis=-1).max())


def _halved(corner: FloatArray, far: FloatArray, halves: list[int]) -> list[tuple[FloatArray, FloatArray]]:
    cells = [(corner, far)]
    for axis in halves:
        split = []
        for low, high in cells:
            middle = 0.5 * (low[axis] + high[axis])
            upper, lower = low.copy(), high.copy()
            upper[axis] = lower[axis] = middle
            split += [(low, lower), (upper, high)]
        cells = split
    return cells


def _flattened(points: FloatArray, outward: FloatArray, face: int) -> Facet | None:
    """The polygon that is nearest to points around a facet; None if it has no area."""
    import shapely

    origin = points.mean(axis=0)
    _, size, axes = np.linalg.svd(points - origin)
    if size[1] < 1e-9:
        return None
    normal = np.cross(axes[0], axes[1])
    if normal @ outward < 0.0:
        axes[1], normal = -axes[1], -normal
    hull = shapely.MultiPoint((points - origin) @ axes[:2].T).convex_hull
    if hull.geom_type != "Polygon":
        return None
    pieces = convex_pieces(hull)
    return _lifted(pieces[0], origin, axes[:2], normal, face) if pieces else None


def _chained(path: str, face: DrawnFace, lines: list[list[FloatArray]], tolerance: float | None) -> FloatArray:
    """One closed line of several; each may be turned, or be one of two (sides of a seam)."""
    best, best_gap = None, np.inf
    size = max(float(np.ptp(line[0], axis=0).max()) for line in lines)
    for begin in lines[0]:
        for first in (begin, begin[::-1]):
            points, gap, used = [first], 0.0, {0: id(begin)}
            for number, choices in enumerate(lines[1:], 1):
                ways = [way for line in choices for way in (line, line[::-1])]
                ends = [float(np.linalg.norm(way[0] - points[-1][-1])) for way in ways]
                pick = int(np.argmin(ends))
                used[number] = pick
                points.append(ways[pick])
                gap = max(gap, ends[pick])
            gap = max(gap, float(np.linalg.norm(points[-1][-1] - points[0][0])))
            if gap < best_gap:
                best, best_gap = np.concatenate([part[:-1] for part in points]), gap
    if best is None or best_gap > (tolerance if tolerance is not None else 1e-3 * size):
        raise FileError(f"{path}: the border of face {face.number} ({face.kind}, at {_place(face)}) is not closed")
    return best


def _place(face: DrawnFace) -> str:
    return "(" + ", ".join(f"{1e3 * value:.4g}" for value in face.centre) + ") mm"


def _polygon(shapely: Any, rings: list[FloatArray]) -> Any:
    areas = [abs(shapely.Polygon(ring).area) for ring in rings]
    outer = int(np.argmax(areas))
    holes = [ring for number, ring in enumerate(rings) if number != outer]
    whole = shapely.Polygon(rings[outer], holes)
    return whole if whole.is_valid else shapely.make_valid(whole)


def convex_pieces(shape: Any) -> list[FloatArray]:
    """A shape of Shapely as convex polygons of 3 to 12 corners, counter-clockwise."""
    found: list[FloatArray] = []
    for part in getattr(shape, "geoms", [shape]):
        if part.geom_type != "Polygon":
            found += convex_pieces(part) if hasattr(part, "geoms") else []
            continue
        if part.is_empty or part.area == 0.0:
            continue
        outline = _without_idle(np.array(part.exterior.coords)[:-1], part.exterior.is_ccw)
        if not part.interiors and len(outline) >= 3 and _is_convex(outline):
            found += _few_corners(outline)
            continue
        found += _joined_triangles(part)
    return found


def _without_idle(points: FloatArray, is_ccw: bool) -> FloatArray:
    """Corners of an outline, without those on straight lines, counter-clockwise."""
    if not is_ccw:
        points = points[::-1]
    while len(points) > 3:
        turn, size = _turns(points)
        idle = np.abs(turn) <= 1e-8 * size
        if not idle.any():
            break
        points = np.delete(points, int(np.argmax(np.where(idle, 1.0 - np.abs(turn), -np.inf))), axis=0)
    return points


def _turns(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How much the outline turns at each corner, times the lengths of both sides there; and these lengths multiplied."""
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    size = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    return before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], size


def _is_convex(points: FloatArray) -> bool:
    turn, size = _turns(points)
    return bool(np.all(turn / np.where(size > 0.0, size, 1.0) > 1e-9))


def _few_corners(outline: FloatArray) -> list[FloatArray]:
    """A convex outline, in as many pieces as corners ask for."""
    if len(outline) <= MAX_VERTICES:
        return [outline]
    return [outline[:MAX_VERTICES], *_few_corners(np.concatenate([outline[:1], outline[MAX_VERTICES - 1 :]]))]


def _joined_triangles(part: Any) -> list[FloatArray]:
    """Triangles of a polygon, joined as long as they are convex."""
    import shapely

    pieces = []
    for triangle in shapely.constrained_delaunay_triangles(part).geoms:
        corners = _without_idle(np.array(triangle.exterior.coords)[:-1], triangle.exterior.is_ccw)
        if len(corners) == 3 and _is_convex(corners):
            pieces.append(list(map(tuple, corners.tolist())))
    number = 0
    while number < len(pieces):
        for other in range(number + 1, len(pieces)):
            both = _joined(pieces[number], pieces[other])
            if both is not None:
                pieces[number] = both
                del pieces[other]
                break
        else:
            number += 1
    return [np.array(piece) for piece in pieces]


def _joined(one: list[Corner], other: list[Corner]) -> list[Corner] | None:
    """Two convex polygons that share a side as one, if that is convex."""
    following = {corner: number for number, corner in enumerate(other)}
    for i, begin in enumerate(one):
        end = one[(i + 1) % len(one)]
        j = following.get(end)
        if j is not None and other[(j + 1) % len(other)] == begin:
            both = _without_idle(np.array(one[i + 1 :] + one[: i + 1] + (other[j + 1 :] + other[: j + 1])[1:-1]), True)
            return list(map(tuple, both.tolist())) if len(both) <= MAX_VERTICES and _is_convex(both) else None
    return None


def outside_of(facet: Facet, feet: FloatArray) -> FloatArray:
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
