"""The finite-element model of a cage as drawn: its own solid with all its fillets, in second-order tetrahedra
(docs/theory/cage.md#a-drawn-cage-of-finite-elements).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from trbdyn.base.extras import of_extras
from trbdyn.base.own_files import digest_of
from trbdyn.errors import FileError, InputError
from trbdyn.extras.elastic.cage_solid import CageSolid, at_faces, cage_solid, elasticity
from trbdyn.extras.elastic.sections import ENDS, SURFACES
from trbdyn.extras.elastic.solid import EDGES, FloatArray, IntArray, Solid
from trbdyn.model.bearing import Bearing
from trbdyn.model.cage_drawing import MM, STEP_ENDINGS, CageDrawing
from trbdyn.model.pocket import every_surface, pocket_axes

COARSEST: Final = 0.24
"""Longest edge of the plain mesh over the roller's diameter."""
AROUND: Final = 4
"""Edges of the plain mesh around a whole circle of a fillet."""
TEN_NODES: Final = 11
"""Gmsh's number of a tetrahedron with ten nodes."""
MOST_NODES: Final = 200_000
"""Most nodes of a mesh: more need more memory than a workstation has."""
NEAR: Final = 0.3
"""How far a corner of a pocket goes from that of the roller's outline, over the roller's diameter."""
REPEATS: Final = 20
"""Most rounds in which edges of folded elements are made straight."""


def solid_of_cage(bearing: Bearing, *, fineness: float = 1, cracked_bars: Iterable[int] = ()) -> CageSolid:
    """The finite-element model of a bearing's cage, from its drawing where it has one, or else from its body, with arguments and
    errors of `drawn_solid` and `cage_solid`.
    """
    if bearing.cage.drawing is not None:
        return drawn_solid(bearing, fineness=fineness)
    return cage_solid(bearing, fineness=int(fineness), cracked_bars=cracked_bars)


def drawn_solid(bearing: Bearing, *, fineness: float = 1.0) -> CageSolid:
    """The finite-element model of a cage that comes from `Cage.from_step`, with the edges of the plain mesh divided by
    `fineness`. An STL file is refused, as its triangles are not the solid's real surface, and a drawing that has changed.

    Points of stress lie at the corners of the pockets: for each bar, end, side and surface the node of the drawing's surface
    where the largest principal stress under a push on any face is largest, in the direction of that principal stress. So the
    notch is in it, as drawn.
    """
    drawing = bearing.cage.drawing
    assert drawing is not None  # callers have looked
    if digest_of(drawing.file) != drawing.sha256:
        path = ("bearing", "cage", "drawing", "sha256")
        raise InputError.of(path, drawing.sha256, f"must be that of {drawing.file}, which has changed since")
    if Path(drawing.file).suffix.lower() not in STEP_ENDINGS:
        limit = f"must be a file {', '.join(STEP_ENDINGS)}: an STL file has triangles in place of the surfaces that are meshed"
        raise InputError.of(("bearing", "cage", "drawing", "file"), drawing.file, limit)
    made = elasticity(bearing)
    nodes, elements = tetrahedra(drawing, bearing.roller.diameter, fineness)
    solid = Solid.of(nodes, elements, made)
    faces = tuple(every_surface(bearing))
    built = CageSolid(
        solid=solid,
        faces=faces,
        at_faces=at_faces(bearing, faces, solid),
        corners=(),
        corner_places=np.zeros((0, 3)),
        stress_of=None,
        directions=np.zeros((0, 3)),
    )
    names, vertices, directions = _corners(bearing, built)
    return replace(
        built,
        corners=names,
        corner_places=solid.nodes[vertices],
        stress_of=stress_rows(solid, vertices, directions),
        directions=directions,
    )


def tetrahedra(drawing: CageDrawing, size: float, fineness: float) -> tuple[FloatArray, IntArray]:
    """Nodes in the cage's frame (m), and second-order tetrahedra in the order of Gmsh, whose edges follow the drawn surfaces;
    `size` is the diameter of the rollers (m), and edges are divided by `fineness`.
    """
    with of_extras("gmsh_model")() as gmsh:
        try:
            gmsh.model.occ.importShapes(drawing.file)
            gmsh.model.occ.synchronize()
            gmsh.option.setNumber("Mesh.MeshSizeMax", COARSEST * size / MM / fineness)
            gmsh.option.setNumber("Mesh.MeshSizeMin", 0.01 * COARSEST * size / MM)
            gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", AROUND * fineness)
            gmsh.model.mesh.generate(3)
            gmsh.model.mesh.setOrder(2)
        except Exception as error:  # Gmsh raises Exception itself
            raise FileError(f"{drawing.file}: cannot be meshed: {error}") from None
        places = of_extras("nodes_of")(gmsh)
        found = gmsh.model.mesh.getElementsByType(TEN_NODES)[1].astype(np.int64).reshape(-1, 10)
    if not len(found):
        raise FileError(f"{drawing.file}: cannot be meshed: no tetrahedra were made")
    used, elements = np.unique(found, return_inverse=True)
    if len(used) > MOST_NODES:
        limit = f"must be less: the mesh of {drawing.file} has {len(used)} nodes, {MOST_NODES} are allowed"
        raise InputError.of(("elastic_cage", "fineness"), fineness, limit)
    elements = elements.reshape(-1, 10)
    nodes = (places[used] - np.array(drawing.origin)) @ np.array(drawing.axes).T
    return straightened(nodes, elements), elements


def straightened(nodes: FloatArray, elements: IntArray) -> FloatArray:
    """Nodes with the edges of those elements straight that are folded otherwise, as a thin element at a small fillet may be."""
    nodes = nodes.copy()
    ends = np.array(EDGES)
    places = _LOCAL
    for _ in range(REPEATS):
        jacobians = np.einsum("pnk,enx->epkx", _slopes(places), nodes[elements])
        volumes = np.linalg.det(jacobians)
        sign = np.sign(np.median(volumes))
        folded = elements[(sign * volumes).min(axis=1) <= 0.05 * np.abs(volumes).max(axis=1)]
        straight = 0.5 * (nodes[folded[:, ends[:, 0]]] + nodes[folded[:, ends[:, 1]]])
        if np.array_equal(nodes[folded[:, 4:]], straight):
            break
        nodes[folded[:, 4:]] = straight
    return nodes


_LOCAL: FloatArray = np.vstack([np.eye(4), [0.5 * (np.eye(4)[i] + np.eye(4)[j]) for i, j in EDGES]])
"""Barycentric coordinates of a tetrahedron's nodes."""


def _slopes(bary: FloatArray) -> FloatArray:
    """Gradients of the ten shape functions over the three local directions, at points, shape (P, 10, 3)."""
    slope = np.zeros((len(bary), 10, 4))
    slope[:, range(4), range(4)] = 4.0 * bary - 1.0
    for node, (i, j) in enumerate(EDGES, 4):
        slope[:, node, i], slope[:, node, j] = 4.0 * bary[:, j], 4.0 * bary[:, i]
    return slope[:, :, 1:] - slope[:, :, :1]


_GAUSS: FloatArray = np.full((4, 4), 0.1381966011250105) + (0.5854101966249685 - 0.1381966011250105) * np.eye(4)
"""Barycentric coordinates of the four points in which strains of a second-order tetrahedron are best."""


def _gradients(solid: Solid, vertices: IntArray) -> list[tuple[IntArray, FloatArray]]:
    """For each vertex the nodes of every element around it, shape (e, 10), and the gradients of their shape functions, carried on
    linearly from the Gauss points to the vertex, shape (e, 10, 3) (1/m).
    """
    corners = solid.basis.mesh.t.T
    at = np.flatnonzero(np.isin(corners, vertices).any(axis=1))
    slopes, onward = _slopes(_GAUSS), np.linalg.inv(_GAUSS)
    nodes = solid.basis.element_dofs.T[at][:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]  # scikit-fem swaps the last two edges
    jacobians = np.einsum("gnk,enx->egkx", slopes, solid.nodes[nodes])
    at_gauss = np.einsum("gnk,egxk->egnx", slopes, np.linalg.inv(jacobians))
    found = []
    for vertex in vertices:
        here, corner = np.nonzero(corners[at] == vertex)
        found.append((nodes[here], np.einsum("eg,egnx->enx", onward[corner], at_gauss[here])))
    return found


def stress_rows(solid: Solid, vertices: IntArray, directions: FloatArray) -> Any:
    """Normal stress in a direction at vertices from the displacements, the mean over the elements around each, sparse, shape
    (V, 3 N).
    """
    from scipy.sparse import coo_array

    rows, columns, values = [], [], []
    lame, shear = solid.made.lame
    for row, ((nodes, gradients), way) in enumerate(zip(_gradients(solid, vertices), directions, strict=True)):
        parts = (lame * gradients + 2.0 * shear * (gradients @ way)[..., None] * way) / len(nodes)
        columns.append((3 * nodes[..., None] + np.arange(3)).ravel())
        values.append(parts.ravel())
        rows.append(np.full(parts.size, row))
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return coo_array(entries, shape=(len(vertices), solid.nodes.size)).tocsr()


def stress_tensors(solid: Solid, vertices: IntArray, moved: FloatArray) -> FloatArray:
    """Stress at vertices, the mean over the elements around each, shape (V, L, 3, 3) (Pa), of displacements, shape (3 N, L)."""
    lame, shear = solid.made.lame
    by_node = moved.reshape(len(solid.nodes), 3, -1)
    found = np.empty((len(vertices), by_node.shape[2], 3, 3))
    for row, (nodes, gradients) in enumerate(_gradients(solid, vertices)):
        strain = np.tensordot(gradients, by_node[nodes], axes=((0, 1), (0, 1))) / len(
            nodes
        )  # direction, component, load
        strain = 0.5 * (strain + strain.transpose(1, 0, 2))
        whole = 2.0 * shear * strain + lame * np.trace(strain)[None, None] * np.eye(3)[:, :, None]
        found[row] = whole.transpose(2, 0, 1)
    return found


def _corners(bearing: Bearing, built: CageSolid) -> tuple[tuple[str, ...], IntArray, FloatArray]:
    """Names of the corners, the vertex of each, and the direction of its stress, shape (P, 3)."""
    solid, geometry, count = built.solid, bearing.geometry, bearing.n_rollers
    surface = np.unique(solid.basis.mesh.facets[:, solid.basis.mesh.boundary_facets()])
    reach = NEAR * bearing.roller.diameter
    moved = solid.static(built.pushes())
    names, vertices, directions = [], [], []
    ends = (
        (geometry.small_end_station, 0.5 * geometry.small_end_diameter),
        (geometry.large_end_station, 0.5 * geometry.large_end_diameter),
    )
    for pocket in range(count):
        angle = 2.0 * math.pi * pocket / count
        origin = 0.5 * bearing.pitch_diameter * np.array([math.cos(angle), math.sin(angle), 0.0])
        local = (solid.nodes[surface] - origin) @ pocket_axes(bearing, pocket).T
        loads = [k for k, (other, _) in enumerate(built.faces) if (other - pocket + 1) % count <= 2]
        for bar, side in (("trailing", -1.0), ("leading", 1.0)):
            for end, (along, radius) in zip(ENDS, ends, strict=True):
                off = local - np.array([0.0, side * radius, along])
                near = (np.hypot(off[:, 1], off[:, 2]) < reach) & (np.abs(local[:, 0]) < bearing.roller.diameter)
                if not near.any():
                    assert bearing.cage.drawing is not None
                    file = bearing.cage.drawing.file
                    raise FileError(f"{file}: has no surface at the {end} end of the {bar} bar of pocket {pocket}")
                tensors = stress_tensors(solid, surface[near], moved[:, loads])
                middle = 0.5 * (local[near, 0].min() + local[near, 0].max())
                values, ways = np.linalg.eigh(tensors)
                largest = np.abs(values)
                for name in SURFACES:
                    inside = local[near, 0] >= middle if name == "outer" else local[near, 0] < middle
                    where = np.where(inside[:, None, None], largest, -1.0)
                    at, load, which = np.unravel_index(int(np.argmax(where)), where.shape)
                    names.append(f"pocket {pocket}, {bar} bar, {end} end, {name}")
                    vertices.append(int(surface[near][at]))
                    directions.append(ways[at, load, :, which])
    return tuple(names), np.array(vertices), np.array(directions)
