"""STL files: triangles without faces. Triangles in one plane are a plane face; of the rest, those that join smoothly are one."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.reading import LARGEST_DRAWN, MOST_TRIANGLES, read_input
from trbdyn.errors import FileError

FloatArray = NDArray[np.float64]
Edges = list[tuple[int, int, int, int]]

FLAT: Final = math.cos(1e-3)
SMOOTH: Final = math.cos(math.radians(25.0))
LARGE: Final = 1e-5
"""Least area of a plane face over the square of the solid's size."""


def doubled(triangles: FloatArray) -> FloatArray:
    """Normals of triangles, shape (T, 3), as long as twice their areas."""
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])


def read_triangles(path: Path, scale: float) -> FloatArray:
    """Triangles of an STL file, shape (T, 3, 3), times a scale."""
    data = read_input(path, "STL", field="drawing")
    if len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little"):
        rows = np.frombuffer(data, dtype=np.dtype([("v", "<f4", (4, 3)), ("a", "<u2")]), offset=84)
        corners = rows["v"][:, 1:].astype(float)
    else:
        words = data.split()
        places = [at for at, word in enumerate(words) if word.lower() == b"vertex"]
        try:
            corners = np.array([[float(word) for word in words[at + 1 : at + 4]] for at in places]).reshape(-1, 3, 3)
        except ValueError as error:
            raise FileError(f"{path}: is no STL file: {error}") from None
    if not len(corners) or not np.all(np.isfinite(corners)):
        raise FileError(f"{path}: is no STL file: it has no triangles, or numbers that are not finite")
    if len(corners) > MOST_TRIANGLES:
        raise FileError(f"{path}: has {len(corners)} triangles; {MOST_TRIANGLES} are read")
    if not 0.0 < scale * np.ptp(corners.reshape(-1, 3), axis=0).max() < 2.0 * LARGEST_DRAWN:
        raise FileError(f"{path}: is no drawing of a part: it is a point, or larger than {2.0 * LARGEST_DRAWN:g} m")
    return scale * corners


def faces_of(path: Path, triangles: FloatArray) -> tuple[list[NDArray[np.intp]], list[bool], Edges, FloatArray]:
    """Numbers of the triangles of each face, whether it is plane, edges (two triangles, two corners), and all corners. Triangles
    that are not the closed surface of a solid are refused.
    """
    size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
    _, first, which = np.unique(
        np.round(triangles.reshape(-1, 3) / (1e-6 * size)).astype(np.int64),
        axis=0,
        return_index=True,
        return_inverse=True,
    )
    corners = triangles.reshape(-1, 3)[first]
    rows = which.reshape(-1, 3)
    of_edge: dict[tuple[int, int], int] = {}
    edges: Edges = []
    for number, row in enumerate(rows):
        for k in range(3):
            start, end = int(row[k]), int(row[(k + 1) % 3])
            if (other := of_edge.pop((end, start), None)) is not None:
                edges.append((other, number, start, end))
            else:
                of_edge[start, end] = number
    if of_edge:
        raise FileError(
            f"{path}: its triangles are not the closed surface of a solid: {len(of_edge)} edges have one triangle alone"
        )
    normals = doubled(triangles)
    areas = 0.5 * np.linalg.norm(normals, axis=1)
    normals /= np.maximum(2.0 * areas, 1e-300)[:, None]
    flat = _groups(len(rows), [(one, other) for one, other, *_ in edges if normals[one] @ normals[other] > FLAT])
    of_flat = np.bincount(flat, weights=areas)
    is_large = of_flat[flat] > LARGE * size**2
    smooth = _groups(
        len(rows),
        [
            (one, other)
            for one, other, *_ in edges
            if (is_large[one] and is_large[other] and flat[one] == flat[other])
            or (not is_large[one] and not is_large[other] and normals[one] @ normals[other] > SMOOTH)
        ],
    )
    found = [np.flatnonzero(smooth == number) for number in np.unique(smooth)]
    return found, [bool(is_large[members[0]]) for members in found], edges, corners


def _groups(count: int, pairs: list[tuple[int, int]]) -> NDArray[np.intp]:
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    one, other = np.array(pairs, dtype=int).reshape(-1, 2).T
    return np.asarray(
        connected_components(coo_matrix((np.ones(len(one)), (one, other)), (count, count)), directed=False)[1]
    )


def solid_of(triangles: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    """Volume, centre, and moments of inertia about it at a density of 1, of what triangles enclose."""
    first, second, third = triangles.swapaxes(0, 1)
    volumes = np.einsum("ti,ti->t", first, np.cross(second, third)) / 6.0
    volume = float(volumes.sum())
    sums = first + second + third
    centre = (volumes[:, None] * sums).sum(axis=0) / (4.0 * volume)
    squares = sum(np.einsum("t,ti,tj->ij", volumes, corner, corner) for corner in (first, second, third, sums)) / 20.0
    squares = squares - volume * np.outer(centre, centre)
    return volume, centre, np.trace(squares) * np.eye(3) - squares
