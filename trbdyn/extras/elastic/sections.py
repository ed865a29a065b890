"""Cross-sections of a cage's bars and rims at the corners of its pockets: forces on them, and the nominal stress there
(docs/theory/cage.md#a-cage-of-finite-elements).

A bar is cut at the ends of the windows. A rim is cut in the planes through the middles of the windows' rounded corners; the half
of the rim before a window that lies between such a plane and the window's middle is one part of the model. Forces and moments on
a section are sums of the forces at its nodes by the elements of one part, so they are those of equilibrium.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.extras.elastic.solid import Solid, crossed, stiffness_of
from trbdyn.extras.elastic.wall_mesh import WallMesh
from trbdyn.model.cage_body import Wall

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

ENDS: Final = ("small", "large")
SIDES: Final = ("trailing", "leading")
SURFACES: Final = ("outer", "inner")


@dataclass(frozen=True, eq=False)
class Section:
    """A rectangular cross-section."""

    part: int  # the part of the model whose elements act on it
    nodes: IntArray  # corners of elements of the mesh among which those of the section are
    centre: FloatArray  # m
    axes: FloatArray  # unit vectors along the bar or rim, across it, and through the wall towards the axis, as rows
    sign: float  # 1 if the part's outward normal points along the first axis, else -1
    width: float  # of its side across (m)
    thickness: float  # of its side through the wall (m)
    points: tuple[tuple[str, float, float], ...]  # at corners of pockets: name, place across and through (1)


def bar_sections(wall: Wall, mesh: WallMesh) -> Iterator[Section]:
    """The roots of the bars: of each bar at its small and its large end. Bar k lies behind pocket k."""
    for bar in range(wall.n_pockets):
        angle = (2.0 * bar + 1.0) * math.pi / wall.n_pockets
        for end, (edge, sign) in enumerate(((wall.small_edge, -1.0), (wall.large_edge, 1.0))):
            centre, (around, along) = _place(wall, edge, angle)
            pockets = (bar, "leading"), ((bar + 1) % wall.n_pockets, "trailing")
            yield Section(
                part=bar,
                nodes=mesh.roots[end],
                centre=centre,
                axes=np.array([along, around, np.cross(along, around)]),
                sign=sign,
                width=wall.bar_width(edge),
                thickness=wall.thickness,
                points=tuple(
                    (f"pocket {pocket}, {side} bar, {ENDS[end]} end, {surface}", across, through)
                    for (pocket, side), across in zip(pockets, (-0.5, 0.5), strict=True)
                    for surface, through in zip(SURFACES, (-0.5, 0.5), strict=True)
                ),
            )


def rim_sections(wall: Wall, mesh: WallMesh) -> Iterator[Section]:
    """The rims beside the windows' corners: of each pocket at its small and its large end, behind and before the window."""
    off, deep = (1.0 - math.sqrt(0.5)) * wall.corner_radius, np.array([wall.height])
    for pocket in range(wall.n_pockets):
        middle = 2.0 * math.pi * pocket / wall.n_pockets
        for end, (edge, wide, thick, way) in enumerate(
            (
                (wall.small_edge, wall.small_width, wall.small_thickness, 1.0),
                (wall.large_edge, wall.large_width, wall.large_thickness, -1.0),
            )
        ):
            at = np.array([edge])
            half = float((wall.half_angle(at, deep) - off / wall.place(at, deep)[0])[0])
            for side, sign in enumerate((-1.0, 1.0)):
                centre, (around, along) = _place(wall, edge + 0.5 * way * (off - wide), middle + sign * half)
                yield Section(
                    part=4 * pocket + 2 * end + side,
                    nodes=mesh.rim_cuts,
                    centre=centre,
                    axes=np.array([around, -along, np.cross(along, around)]),
                    sign=sign,
                    width=wide + off,
                    thickness=thick,
                    points=tuple(
                        (f"pocket {pocket}, {ENDS[end]} rim at the {SIDES[side]} bar, {surface}", -0.5 * way, through)
                        for surface, through in zip(SURFACES, (-0.5, 0.5), strict=True)
                    ),
                )


def forces_on(solid: Solid, part: IntArray, sections: Iterable[Section]) -> Any:
    """Forces (N) and moments (N m) on sections from the displacements, in their axes, sparse, shape (6 S, 3 N); `part` has the
    part of each element, -1 for none.
    """
    import skfem
    from scipy.sparse import lil_array, vstack

    basis, grid = solid.basis, solid.basis.mesh
    parts = skfem.CellBasis(grid, basis.elem, quadrature=basis.quadrature, elements=np.flatnonzero(part >= 0))
    cuts: dict[int, tuple[IntArray, IntArray]] = {}
    rows = []
    for section in sections:
        if id(section.nodes) not in cuts:
            cut = np.flatnonzero(np.isin(grid.facets, section.nodes).all(axis=0))
            beside = grid.f2t[:, cut]
            cuts[id(section.nodes)] = cut, np.where(beside < 0, -1, part[beside]).max(axis=0)
        cut, of = cuts[id(section.nodes)]
        found = basis.get_dofs(facets=cut[of == section.part]).flatten()
        sums = lil_array((6, solid.nodes.size))
        for node in found:
            arm = crossed(solid.nodes[node] - section.centre)
            sums[:, 3 * node : 3 * node + 3] = np.concatenate([section.axes, section.axes @ arm])
        rows.append(sums.tocsr())
    return vstack(rows).tocsr() @ stiffness_of(parts, solid.made)


def nominal_stress(sections: list[Section]) -> tuple[Any, tuple[str, ...], FloatArray, FloatArray]:
    """Stress at the points of sections by tension and bending about both axes from forces and moments, sparse, shape (P, 6 S),
    names of the points, their places, shape (P, 3) (m), and the directions of the stress, shape (P, 3).
    """
    from scipy.sparse import csr_array

    stress, names, places, directions = [], [], [], []
    for at, one in enumerate(sections):
        for name, across, through in one.points:
            row = np.zeros((len(sections), 6))
            row[at, 0] = one.sign / (one.width * one.thickness)
            row[at, 4] = one.sign * through * 12.0 / (one.width * one.thickness**2)
            row[at, 5] = -one.sign * across * 12.0 / (one.thickness * one.width**2)
            stress.append(row.ravel())
            names.append(name)
            directions.append(one.axes[0])
            places.append(one.centre + [0.0, across * one.width, through * one.thickness] @ one.axes)
    return csr_array(np.array(stress)), tuple(names), np.array(places), np.array(directions)


def _place(wall: Wall, a: float, angle: float) -> tuple[FloatArray, FloatArray]:
    """A place on the wall's middle surface, and unit vectors around the cage and along the cone there, shape (2, 3)."""
    rho, z = wall.place(np.array(a), np.array(wall.height))
    c, s = math.cos(angle), math.sin(angle)
    lean = math.sin(wall.angle)
    axes = np.array([[-s, c, 0.0], [lean * c, lean * s, math.cos(wall.angle)]])
    return np.array([rho * c, rho * s, z]), axes
