"""Hexahedra of a cage's wall: two rims, and a bar between each two windows with rounded corners
(docs/theory/cage.md#a-cage-of-finite-elements).

The mesh is a grid with columns around the cage, rows along the cone and layers through the wall; cells in the windows are left
out. At a window's corner the column between window and bar meets the row between rim and bar in the middle of the rounded
corner, so no element has a corner of 0 degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from trbdyn.model.cage_body import Wall

FloatArray = NDArray[np.float64]
RIM_ROWS, BAR_COLUMNS, BAR_ROWS, WINDOW_COLUMNS = 2, 2, 6, 2
"""Elements of the coarsest mesh: along a rim's width, across half a bar, along a bar and across half a window between the rounded
corners."""
IntArray = NDArray[np.int64]

CORNERS = np.array([(0, 0, 0), (0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0), (1, 1, 1)])
"""Order of a hexahedron's corners in scikit-fem."""


@dataclass(frozen=True)
class WallMesh:
    """Corners and elements of a wall. Bar k lies behind pocket k in the direction of rotation."""

    corners: FloatArray  # in the cage's frame (m), shape (V, 3): x through the middle of pocket 0
    elements: IntArray  # corners of the hexahedra, in the order of scikit-fem, shape (E, 8)
    bar: IntArray  # of each element; -1 in a rim
    rim: IntArray
    """Half of a rim before a window that an element is of, up to the middle of the window's rounded corner: 4 k + 2 (large rim)
    + (the half at the leading bar) of pocket k, else -1."""
    roots: tuple[IntArray, IntArray]  # corners of the bars' sections at the windows' small and large ends
    rim_cuts: IntArray  # corners of the rims' sections through the middles of the windows' rounded corners


def wall_mesh(wall: Wall, *, fineness: int = 1, cracked_bars: frozenset[int] = frozenset()) -> WallMesh:
    """The mesh of a wall: each edge of the coarsest mesh is divided into `fineness` parts, and cracked bars are parted from the
    rim at the small ends.
    """
    levels = _levels(wall, fineness)
    ends = [_corner(wall, end, levels, fineness) for end in (0, 1)]
    rim_rows, bar_columns = RIM_ROWS * fineness, BAR_COLUMNS * fineness  # of a rim, of half a bar
    window_columns = len(ends[0][0]) - 1  # of half a window
    inner = np.linspace(ends[0][1][-1], ends[1][1][-1], BAR_ROWS * fineness + 1)[1:-1]
    side = np.concatenate([ends[0][1], inner, ends[1][1][::-1]])  # a of the rows of a bar
    straight = wall.half_angle(inner[:, None], levels.inside)
    at_side = np.concatenate([ends[0][3], straight, ends[1][3][::-1]])
    columns, bar_rows = window_columns + bar_columns, len(side) - 1
    a = np.empty((columns + 1, 2 * rim_rows + bar_rows + 1))
    angle = np.empty((*a.shape, len(levels.n)))
    pitch, share = math.pi / wall.n_pockets, np.linspace(0.0, 1.0, bar_columns + 1)[:, None]
    bar = slice(rim_rows, rim_rows + bar_rows + 1)
    a[window_columns:, bar] = side
    a[window_columns + 1 :, [rim_rows, rim_rows + bar_rows]] = wall.small_edge, wall.large_edge
    angle[window_columns:, bar] = at_side + share[:, :, None] * (pitch - at_side)
    for end, (top, _, turned, _) in enumerate(ends):
        row = (rim_rows, rim_rows + bar_rows)[end]
        a[: window_columns + 1, row], angle[: window_columns + 1, row] = top, turned
        far = (wall.small_edge - wall.small_width, wall.large_edge + wall.large_width)[end]
        for step in range(rim_rows):
            here = step if end == 0 else 2 * rim_rows + bar_rows - step
            a[:, here] = far + (a[:, row] - far) * step / rim_rows
            angle[:, here] = angle[:, row]
    # half a window and half a bar, then their mirror images, for each pocket
    order = np.concatenate([np.arange(columns), np.arange(columns, 0, -1)])
    a, half = a[order], angle[order]
    half[columns + 1 :] = 2.0 * pitch - half[columns + 1 :]
    whole = 2.0 * pitch * np.arange(wall.n_pockets)[:, None, None, None] + half
    rho, z = wall.place(a[:, :, None], wall.height + levels.n)
    corners = np.stack([rho * np.cos(whole), rho * np.sin(whole), np.broadcast_to(z, whole.shape)], axis=-1)
    return _cells(wall, corners, levels, window_columns, bar, cracked_bars)


@dataclass(frozen=True)
class _Levels:
    """Heights of the layers' borders from the middle surface (m), and which layers each part has: small rim, bars, large rim."""

    n: FloatArray
    inside: FloatArray  # heights of the wall's points nearest to them, from the rollers' axes
    parts: tuple[NDArray[np.bool_], ...]


def _levels(wall: Wall, fineness: int) -> _Levels:
    thick = (wall.small_thickness, wall.thickness, wall.large_thickness)
    coarse = np.unique([sign * 0.5 * one for one in thick for sign in (-1.0, 1.0)])
    n = np.concatenate([[coarse[0]], *(np.linspace(*pair, fineness + 1)[1:] for pair in pairwise(coarse))])
    middle = 0.5 * (n[1:] + n[:-1])
    inside = wall.height + np.clip(n, -0.5 * wall.thickness, 0.5 * wall.thickness)
    return _Levels(n, inside, tuple(np.abs(middle) < 0.5 * one for one in thick))


def _corner(
    wall: Wall, end: int, levels: _Levels, fineness: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """The window's outline at an end, from its middle to the middle of the rounded corner and on to the straight side: a of the
    first and of the second part, their angles at each level.
    """
    edge, way, radius = ((wall.small_edge, 1.0), (wall.large_edge, -1.0))[end] + (wall.corner_radius,)
    rho, _ = wall.place(np.array(edge), levels.inside)
    wide = rho * wall.half_angle(np.full(levels.inside.shape, edge), levels.inside)
    flat = np.linspace(0.0, 1.0, WINDOW_COLUMNS * fineness + 1)[:, None] * (wide - radius)
    turn = np.linspace(0.0, 0.5 * math.pi, 2 * fineness + 1)[:, None] if radius else np.zeros((0, 1))
    arc = wide - radius * (1.0 - np.sin(turn))
    up = edge + way * radius * (1.0 - np.cos(turn[:, 0]))
    first, second = slice(1, fineness + 1), slice(fineness, None)
    top = np.concatenate([np.full(len(flat), edge), up[first]])
    angles = np.concatenate([flat, arc[first]]) / rho
    if not radius:
        return top, np.array([edge]), angles, angles[-1:]
    return top, up[second], angles, arc[second] / rho


def _cells(
    wall: Wall,
    corners: FloatArray,
    levels: _Levels,
    window_columns: int,
    bar: slice,
    cracked_bars: frozenset[int],
) -> WallMesh:
    count, columns, rows, heights = corners.shape[:4]
    number = np.arange(corners.size // 3).reshape(count * columns, rows, heights)
    column, row, layer = np.meshgrid(
        np.arange(count * columns), np.arange(rows - 1), np.arange(heights - 1), indexing="ij"
    )
    part = 1 - (row < bar.start) + (row >= bar.stop - 1)
    place = column % columns
    at_bar = (place >= window_columns) & (place < columns - window_columns)
    there = np.stack(levels.parts)[part, layer] & (at_bar | (part != 1))
    cells = np.stack([column[there], row[there], layer[there]], axis=-1)
    whole = np.where(part[there] == 1, cells[:, 0] // columns, -1)
    each = cells[:, None] + CORNERS
    elements = number[each[..., 0] % len(number), each[..., 1], each[..., 2]]
    cracked = np.isin(whole, list(cracked_bars))[:, None] & (each[..., 1] == bar.start)
    elements[cracked] += number.size  # the bar's own corners at the crack
    used, elements = np.unique(elements, return_inverse=True)
    elements = elements.reshape(-1, 8)
    inside = (whole >= 0)[:, None]
    roots = tuple(np.unique(elements[inside & (each[..., 1] == at)]) for at in (bar.start, bar.stop - 1))
    before = (part != 1) & ~at_bar
    leading = place < window_columns
    half = 4 * ((column // columns + ~leading) % count) + (part + leading)
    rim = np.where(before, half, -1)[there]
    borders = np.isin(each[..., 0] % columns, (window_columns, columns - window_columns))
    return WallMesh(
        corners=corners.reshape(-1, 3)[used % number.size],
        elements=elements,
        bar=whole,
        rim=rim,
        roots=(roots[0], roots[1]),
        rim_cuts=np.unique(elements[(rim >= 0)[:, None] & borders]),
    )
