"""Where a drawn cage lies: its axis, its number of pockets, and its place about the rollers of a bearing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import FileError
from trbdyn.extras.cad.opened import Drawing, DrawnFace
from trbdyn.extras.cad.stl import doubled

FloatArray = NDArray[np.float64]

SAME: Final = 2e-3
"""Faces that a turn by a pitch brings together agree within this share of the cage's radius, and in area within this share."""
ENOUGH: Final = 0.6
"""Share of the area that must come together: a broken pocket does not, nor a mark."""
MOST_POCKETS: Final = 200
LEAST_FIT: Final = -0.03
"""Overlap of roller and cage, over the roller's radius, up to which a place is still one: triangles are rough."""
FREE: Final = 0.2
"""Distance, over the roller's radius, beyond which none is looked for."""
STOPPED: Final = 0.1
"""Overlap, over the roller's radius, from which on a cage stops a roller."""
MOST_MAXIMA: Final = 3
"""Most local maxima of the distance that are looked at for each direction of the cage."""


@dataclass(frozen=True)
class Axis:
    """The axis of a cage, as drawn."""

    origin: FloatArray  # the point of it next to the centre of the volume (m)
    axes: FloatArray  # rows: two directions across, and that of the axis

    def inside(self, points: FloatArray) -> FloatArray:
        """Points of the drawing in its axes (m)."""
        return (points - self.origin) @ self.axes.T


def axis_of(drawing: Drawing) -> Axis:
    """The axis of the cage; a solid that is no ring is refused.

    It is first taken from the moments of inertia: that of the axis differs most from the other two. Then it follows exactly:
    normals of surfaces of revolution meet it, and normals of end planes run along it.
    """
    values, vectors = np.linalg.eigh(drawing.inertia)
    alone = int(np.argmax(np.abs(values - np.median(values))))
    direction, origin = vectors[:, alone], drawing.centre.copy()
    points = np.concatenate([face.triangles.reshape(-1, 3) for face in drawing.faces])
    reach = float(np.linalg.norm(np.cross(points - origin, direction), axis=1).max())
    share = 0.05
    for _ in range(30):
        rows, off = _revolved(drawing, origin, direction, reach, share)
        if len(rows) < 6:
            break
        across = _across(direction)
        # unknowns: shift of the origin across, turn of the direction, over reach
        system = np.column_stack([rows[:, :3] @ across.T, rows[:, 3:] @ across.T])
        change, *_ = np.linalg.lstsq(system, off, rcond=1e-10)
        origin = origin + reach * (change[:2] @ across)
        direction = direction + change[2:] @ across
        direction /= np.linalg.norm(direction)
        share = max(0.2 * share, 1e-6 if drawing.surfaces is not None else 0.02)
        if np.abs(change).max() < 1e-15:
            break
    direction = direction * (1.0 if direction[int(np.argmax(np.abs(direction)))] > 0.0 else -1.0)
    origin = origin + direction * ((drawing.centre - origin) @ direction)
    found = Axis(origin, np.array([*_across(direction), direction]))
    inner = np.linalg.norm(found.inside(points)[:, :2], axis=1).min()
    if inner < 0.2 * reach:
        raise FileError(
            f"{drawing.path}: is no cage: it comes within {1e3 * inner:.3g} mm of its axis, its radius is {1e3 * reach:.3g} mm"
        )
    return found


def _across(direction: FloatArray) -> FloatArray:
    """Two unit vectors across a direction, rows; right-handed with it."""
    start = np.eye(3)[int(np.argmin(np.abs(direction)))]
    first = start - direction * (start @ direction)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(direction, first)])


def _revolved(
    drawing: Drawing, origin: FloatArray, direction: FloatArray, reach: float, share: float
) -> tuple[FloatArray, FloatArray]:
    """Equations of faces of revolution: for a point p with normal m, m . (d x (p - c)) = 0; and of end planes: m . across = 0."""
    rows, off = [], []
    for face in drawing.faces:
        points, normals = samples(drawing, face)
        arms = points - origin
        lever = np.cross(direction, arms)
        radius = np.linalg.norm(lever, axis=1)
        wrong = np.sum(normals * lever, axis=1)
        if np.any(np.abs(wrong) > share * radius):
            continue
        turned = np.arctan2(*(arms @ _across(direction).T).T[::-1])
        if span(turned) < 0.5 * math.pi:
            continue
        if face.is_plane:
            for across in _across(direction):
                rows.append(np.concatenate([np.zeros(3), across]))
                off.append(float(normals[0] @ across) * float(normals[0] @ direction))
            continue
        # change of m . (d x (p - c)): by a shift, -m . (d x s) = s . (d x m); by a turn t of d, t . ((p - c) x m)
        rows += [
            np.concatenate(pair)
            for pair in zip(np.cross(direction, normals), np.cross(arms, normals) / reach, strict=True)
        ]
        off += list(-wrong / reach)
    return np.array(rows).reshape(-1, 6), np.array(off)


def span(angles: FloatArray) -> float:
    """Range that angles cover: the circle less its widest gap (rad)."""
    ordered = np.sort(np.mod(angles, 2.0 * math.pi))
    return float(2.0 * math.pi - np.max(np.diff(np.concatenate([ordered, ordered[:1] + 2.0 * math.pi]))))


def samples(drawing: Drawing, face: DrawnFace) -> tuple[FloatArray, FloatArray]:
    """Points of a face and the normals there; exact where it can be evaluated."""
    if drawing.surfaces is None:
        corners = face.triangles
        normals = doubled(corners)
        return corners.mean(axis=1), normals / np.linalg.norm(normals, axis=1)[:, None]
    low, high = (np.array(end) for end in drawing.surfaces.gmsh.model.getParametrizationBounds(2, face.number))
    shares = np.stack(
        np.meshgrid(np.linspace(0.02, 0.98, 9), np.linspace(0.1, 0.9, 3), indexing="ij"), axis=-1
    ).reshape(-1, 2)
    uv = low + (high - low) * shares
    return drawing.surfaces.points(face.number, uv), drawing.surfaces.normals(face.number, uv)


def pockets_of(drawing: Drawing, axis: Axis) -> int:
    """Number of pockets, 3 or more: the largest number of pitches by which the turned cage comes together with itself."""
    from scipy.spatial import cKDTree

    centres = np.array([axis.inside(face.centre) for face in drawing.faces])
    areas = np.array([face.area for face in drawing.faces])
    radius = np.linalg.norm(centres[:, :2], axis=1)
    size = float(np.max(radius))
    apart = radius > 0.2 * size
    centres, areas = centres[apart], areas[apart]
    best, share_of_best = 0, 0.0
    tree = cKDTree(centres)
    for count in range(min(MOST_POCKETS, len(areas)), 2, -1):
        near = tree.query_ball_point(centres @ _turn(2.0 * math.pi / count).T, SAME * size)
        alike = [
            bool(np.any(np.abs(areas[found] - area) <= SAME * area)) for found, area in zip(near, areas, strict=True)
        ]
        together = float(areas[alike].sum() / areas.sum())
        if together > max(ENOUGH, share_of_best + 0.1):
            best, share_of_best = count, together
    if not best:
        raise FileError(
            f"{drawing.path}: no pitch is found by which the cage comes together with itself: pockets must be alike"
        )
    return best


def _turn(angle: float) -> FloatArray:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True)
class Place:
    """Where the drawing lies in the cage's frame: origin on the axis in the roller-centre plane, x through the middle of pocket
    0, z towards the large ends.
    """

    axis: Axis
    is_turned: bool  # whether z of the cage runs against the direction of the axis
    height: float  # of the roller-centre plane above the axis' origin, along z (m)
    phase: float  # angle of pocket 0 about z (rad)

    @property
    def turn(self) -> FloatArray:
        """Rows: axes of the cage's frame in the drawing."""
        flip = np.diag([1.0, -1.0, -1.0]) if self.is_turned else np.eye(3)
        return np.asarray(_turn(-self.phase) @ flip @ self.axis.axes)

    @property
    def origin(self) -> FloatArray:
        """Origin of the cage's frame in the drawing (m)."""
        return np.asarray(self.axis.origin + self.height * self.turn[2])

    def inside(self, points: FloatArray) -> FloatArray:
        """Points of the drawing in the cage's frame (m)."""
        return (points - self.origin) @ self.turn.T


@dataclass(frozen=True)
class Frustum:
    """A roller in numbers: angle of its axis, radius of the pitch circle, ends, radius at mid length and its slope (rad, m)."""

    angle: float
    pitch_radius: float
    small: float
    large: float
    radius: float
    slope: float

    def depth(self, points: FloatArray) -> FloatArray:
        """How far points in the cage's frame, near pocket 0, are outside of the roller; negative inside (m)."""
        sine, cosine = math.sin(self.angle), math.cos(self.angle)
        out = points[..., 0] - self.pitch_radius
        along, outward = sine * out + cosine * points[..., 2], cosine * out - sine * points[..., 2]
        across = np.hypot(outward, points[..., 1])
        side = (across - self.radius - self.slope * along) / math.hypot(1.0, self.slope)
        return np.maximum(side, np.maximum(along - self.large, self.small - along))


def place_of(drawing: Drawing, axis: Axis, count: int, roller: Frustum) -> Place:
    """Where the drawing must lie so that rollers fit into its pockets: by a search over both directions, heights and angles.

    At each the least distance between roller and cage counts, the middle one of all pockets. Its local maxima are looked at one
    by one, as rollers fit beside a cage and between its bars as well: a pocket holds its roller on both sides and at both ends.
    The place with most of these stops is taken, and of several that with the largest distance. A cage into which no roller fits
    is refused.
    """
    points = _spread(np.concatenate([face.triangles for face in drawing.faces]), 0.3 * roller.radius)
    own = axis.inside(points)
    spans = (float(own[:, 2].min()), float(own[:, 2].max()))
    best: tuple[int, float, bool, tuple[float, float]] | None = None
    for is_turned in (False, True):
        flipped = own * np.array([1.0, -1.0, -1.0]) if is_turned else own
        flipped = np.stack(
            [np.arctan2(flipped[:, 1], flipped[:, 0]), np.hypot(flipped[:, 0], flipped[:, 1]), flipped[:, 2]], axis=1
        )
        search = _Search(flipped, sorted((-spans[0], -spans[1]) if is_turned else spans), count, roller)
        for fit, at in search.maxima():
            entry = (search.stops(at) if fit >= LEAST_FIT * roller.radius else -1, fit, is_turned, at)
            if best is None or entry[:2] > (best[0], best[1] + 1e-9):
                best = entry
    assert best is not None  # the largest value of a grid is a local maximum
    _, fit, is_turned, (height, phase) = best
    if fit < LEAST_FIT * roller.radius:
        raise FileError(
            f"{drawing.path}: rollers of the bearing do not fit into its pockets: they overlap by {-1e3 * fit:.3g} mm at best"
        )
    return Place(axis, is_turned, float(height), float(phase))


class _Search:
    """Distances between roller and cage over heights (m) and angles of a pitch (rad)."""

    def __init__(self, points: FloatArray, span: list[float], count: int, roller: Frustum) -> None:
        self.points, self.count, self.roller, self.pitch = points, count, roller, 2.0 * math.pi / count
        self.heights, self.phases = np.linspace(span[0], span[1], 17), np.arange(16) * self.pitch / 16

    def fit(self, height: float, phase: float) -> float:
        """Least distance at a place, the middle one of all pockets (m)."""
        return _clearance(self.points, height, phase, self.pitch, self.count, self.roller)

    def maxima(self) -> list[tuple[float, tuple[float, float]]]:
        """Local maxima and their places, from those of a grid: the `MOST_MAXIMA` with most stops."""
        from scipy import ndimage

        fits = np.array([[self.fit(height, phase) for phase in self.phases] for height in self.heights])
        around = np.pad(np.pad(fits, ((0, 0), (1, 1)), mode="wrap"), ((1, 1), (0, 0)), constant_values=-np.inf)
        rows, columns = fits.shape
        beside = [
            around[1 + i : 1 + i + rows, 1 + j : 1 + j + columns] for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j
        ]
        level, number = ndimage.label(fits >= np.max(beside, axis=0), np.ones((3, 3)))
        tops = [np.argwhere(level == one + 1)[0] for one in range(number)]  # of a plateau one place
        tops.sort(key=lambda top: (-self._stops_on(fits, *top), -fits[tuple(top)]))
        return [self._refined(float(self.heights[i]), float(self.phases[j])) for i, j in tops[:MOST_MAXIMA]]

    def _stops_on(self, fits: FloatArray, row: int, column: int) -> int:
        """As `stops`, on the grid."""
        least = -STOPPED * self.roller.radius
        rows = int((self.roller.large - self.roller.small) / (self.heights[1] - self.heights[0]))
        around, half = np.roll(fits[row], -column), len(self.phases) // 2
        ways = (
            around[: half + 1],
            around[half:],
            fits[row : row + rows + 1, column],
            fits[max(row - rows, 0) : row + 1, column],
        )
        return sum(bool(way.min() < least) for way in ways)

    def _refined(self, height: float, phase: float) -> tuple[float, tuple[float, float]]:
        best, step = (height, phase), np.array([self.heights[1] - self.heights[0], self.phases[1]])
        fit = self.fit(*best)
        for _ in range(6 if fit < FREE * self.roller.radius else 0):
            for i in (-1.0, -0.5, 0.0, 0.5, 1.0):
                for j in (-1.0, -0.5, 0.0, 0.5, 1.0):
                    at = (best[0] + i * step[0], best[1] + j * step[1])
                    if (i or j) and (found := self.fit(*at)) > fit:
                        fit, best = found, at
            step = 0.5 * step
        return fit, best

    def stops(self, at: tuple[float, float]) -> int:
        """In how many of four directions, to both sides and along the axis, the cage stops a roller from a place."""
        (height, phase), least = at, -STOPPED * self.roller.radius
        length = self.roller.large - self.roller.small
        return sum(
            any(self.fit(height + share * along, phase + share * turn) < least for share in np.linspace(0.1, 1.0, 10))
            for along, turn in ((0.0, 0.5 * self.pitch), (0.0, -0.5 * self.pitch), (length, 0.0), (-length, 0.0))
        )


def _clearance(points: FloatArray, height: float, phase: float, pitch: float, count: int, roller: Frustum) -> float:
    """Least distance between roller and points (angle, radius, height), the middle one of all pockets."""
    angle = points[:, 0] - phase
    pocket = np.round(angle / pitch)
    folded = angle - pitch * pocket
    close = np.abs(points[:, 1] * folded) < 1.2 * roller.radius
    folded, pocket, (_, radius, along) = folded[close], pocket[close], points[close].T
    placed = np.stack([radius * np.cos(folded), radius * np.sin(folded), along - height], axis=1)
    least = np.full(count, FREE * roller.radius)
    np.minimum.at(least, pocket.astype(int) % count, roller.depth(placed))
    return float(np.median(least))


def _spread(triangles: FloatArray, size: float) -> FloatArray:
    """Points on triangles no further apart than a size."""
    found = [triangles.reshape(-1, 3)]
    longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    for parts in (2, 4, 8, 16, 32, 64):
        rest = (
            triangles[(longest / size > 0.5 * parts) & (longest / size <= parts)]
            if parts < 64
            else triangles[longest / size > 32]
        )
        for i in range(parts + 1):
            for j in range(parts + 1 - i):
                if len(rest):
                    share = np.array([i, j, parts - i - j]) / parts
                    found.append(np.einsum("tkx,k->tx", rest, share))
    points = np.concatenate(found)
    return points[np.unique(np.round(points / (0.05 * size)).astype(int), axis=0, return_index=True)[1]]
