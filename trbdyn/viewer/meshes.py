"""Meshes of triangles: outlines turned about an axis, flat faces with sharp edges, and how they are joined.

Motion and clearances can be drawn larger by one factor: a mesh may carry a `shift`, by which its points move for each
unit of the factor beyond one. A gap drawn so closes exactly where the real one closes, to first order in the motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mesh:
    """Triangles."""

    position: Array  # vertices (m), shape (n, 3)
    normal: Array  # unit normals there, shape (n, 3)
    index: NDArray[np.int64]  # triangles, counter-clockwise seen from outside, shape (m, 3)
    shift: Array | None = None
    """How far each vertex moves for each unit of the factor of exaggeration beyond one (m), shape (n, 3)."""

    def exaggerated(self, factor: float) -> Array:
        """Vertices for a factor of exaggeration, shape (n, 3)."""
        return self.position if self.shift is None else self.position + (factor - 1.0) * self.shift


def revolve(
    profile: ArrayLike, *, facets: int, start: float = 0.0, stop: float = 2.0 * np.pi, caps: bool = False
) -> Mesh:
    """A closed outline of corners (r, z), shape (k, 2), turned about the z axis from `start` to `stop` (rad) in flat facets;
    `caps` close the two ends of a sector.
    """
    corners = np.asarray(profile, dtype=float)
    r, z = corners.T
    if float(np.sum(z * np.roll(r, -1) - r * np.roll(z, -1))) < 0.0:
        corners = corners[::-1]
    angles = np.linspace(start, stop, facets + 1)
    parts = [strip(np.array([a, b]), angles) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    if caps:
        parts += [_cap(corners, angle, sign) for angle, sign in ((start, -1.0), (stop, 1.0))]
    return join(parts)


def strip(rows: Array, angles: Array, normal_rows: Array | None = None) -> Mesh:
    """The surface between rows (r, z), turned about z; normals from the rows' direction unless given."""
    if normal_rows is None:
        along = np.gradient(rows, axis=0)
        normal_rows = np.stack([along[:, 1], -along[:, 0]], axis=1)
        length = np.linalg.norm(normal_rows, axis=1, keepdims=True)
        normal_rows = -normal_rows / np.where(length > 0.0, length, 1.0)
    cosine, sine = np.cos(angles), np.sin(angles)
    flat = np.ones_like(angles)

    def turned(values: Array) -> Array:
        r, z = values[:, :1], values[:, 1:]
        return np.stack([r * cosine, r * sine, z * flat], axis=-1).reshape(-1, 3)

    count = angles.size
    first = (np.arange(rows.shape[0] - 1)[:, None] * count + np.arange(count - 1)).ravel()
    index = np.concatenate(
        [np.stack([first, first + count, first + 1], 1), np.stack([first + 1, first + count, first + count + 1], 1)]
    )
    return _facing(Mesh(turned(rows), turned(normal_rows), index))


def _facing(mesh: Mesh) -> Mesh:
    """The mesh with every triangle counter-clockwise seen from the side of its normals."""
    a, b, c = mesh.position[mesh.index].transpose(1, 0, 2)
    away = np.einsum("ij,ij->i", np.cross(b - a, c - a), mesh.normal[mesh.index].sum(axis=1)) < 0.0
    index = mesh.index.copy()
    index[away] = index[away][:, ::-1]
    return Mesh(mesh.position, mesh.normal, index, mesh.shift)


def _cap(corners: Array, angle: float, sign: float) -> Mesh:
    """A flat end of a revolved outline."""
    position = np.stack([corners[:, 0] * np.cos(angle), corners[:, 0] * np.sin(angle), corners[:, 1]], axis=1)
    normal = np.broadcast_to(sign * np.array([-np.sin(angle), np.cos(angle), 0.0]), position.shape)
    return _facing(Mesh(position, np.array(normal), np.array(ears(corners))))


def ears(corners: Array) -> list[tuple[int, int, int]]:
    """Triangles that fill an outline without crossings, shape (k, 2): corners that cut off no other one go in turn."""

    def turns(a: int, b: int, c: int) -> float:
        (ax, ay), (bx, by), (cx, cy) = corners[a], corners[b], corners[c]
        return float((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))

    left = list(range(len(corners)))
    sense = np.sign(sum(turns(0, k, k + 1) for k in range(1, len(corners) - 1)))
    out: list[tuple[int, int, int]] = []
    while len(left) > 3:
        for place, b in enumerate(left):
            a, c = left[place - 1], left[(place + 1) % len(left)]
            inside = [min(sense * turns(a, b, p), sense * turns(b, c, p), sense * turns(c, a, p)) for p in left]
            if sense * turns(a, b, c) > 0.0 and not any(s > 0.0 for s in inside):
                out.append((a, b, c))
                left.pop(place)
                break
        else:
            break
    return [*out, (left[0], left[1], left[2])]


def join(parts: list[Mesh]) -> Mesh:
    """Several meshes as one."""
    offsets = np.cumsum([0, *(part.position.shape[0] for part in parts[:-1])])
    shift = None
    if any(part.shift is not None for part in parts):
        shift = np.vstack([np.zeros_like(part.position) if part.shift is None else part.shift for part in parts])
    return Mesh(
        np.vstack([part.position for part in parts]),
        np.vstack([part.normal for part in parts]),
        np.vstack([part.index + offset for part, offset in zip(parts, offsets, strict=True)]),
        shift,
    )


def flat_mesh(points: Array, triangles: NDArray[np.int64], shift: Array | None = None) -> Mesh:
    """A mesh whose triangles keep their own corners and normals, so that its edges look sharp."""
    position = points[triangles].reshape(-1, 3)
    a, b, c = points[triangles].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.repeat(normal / np.where(length > 0.0, length, 1.0), 3, axis=0)
    moved = None if shift is None else shift[triangles].reshape(-1, 3)
    return Mesh(position, normal, np.arange(position.shape[0]).reshape(-1, 3), moved)
