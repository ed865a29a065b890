"""The finite-element model of a bearing's cage: faces of its pockets, and stress at their corners
(docs/theory/cage.md#a-cage-of-finite-elements).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.validation import whole_number_of
from trbdyn.errors import InputError
from trbdyn.extras.elastic.sections import bar_sections, forces_on, nominal_stress, rim_sections
from trbdyn.extras.elastic.solid import Elasticity, Solid, crossed
from trbdyn.extras.elastic.wall_mesh import wall_mesh
from trbdyn.model.bearing import Bearing
from trbdyn.model.cage_body import Wall
from trbdyn.model.pocket import Face, every_surface, pocket_axes

FloatArray = NDArray[np.float64]

PATCH: Final = 0.1
"""Part of the wall that follows a face: surfaces whose middles are farther from the face's middle than the nearest one by this
share of the face's length."""
ALONG: Final = 0.7
"""Cosine of the largest angle between a face and the surface of the wall that follows it."""


@dataclass(frozen=True, eq=False)
class CageSolid:
    """The finite-element model of a cage. Places are those of the cage's frame: origin on the axis in the roller-centre plane, x
    through the middle of pocket 0, z along the axis towards the large ends.

    Attributes
    ----------
    solid : Solid
        Its elements.
    faces : tuple of (int, Face)
        Every face of every pocket: (pocket, face).
    at_faces : sparse array, shape (6 F, 3 N)
        Displacement of each face's middle and rotation of the face, in the axes n, t, a of its pocket, from the displacements.
    corners : tuple of str
        Names of the points at the corners of the pockets.
    corner_places : ndarray, shape (P, 3)
        Where they are (m).
    stress_of : sparse array, shape (P, 3 N)
        Stress at the corners (Pa) from the displacements: nominal along bar and rim, tension and bending about both axes, first
        at the roots of all bars, then in the rims beside the windows' corners; of a cage as drawn the normal stress of the solid
        in the notch.
    directions : ndarray, shape (P, 3)
        Directions of that stress.
    at_roots : sparse array, shape (12 Z, 3 N)
        Force (N) and moment (N m) on each bar at its small and its large end, along, across and through the bar, from the
        displacements. Bar k lies behind pocket k in the direction of rotation. None of a cage as drawn.
    """

    solid: Solid
    faces: tuple[tuple[int, Face], ...]
    at_faces: Any
    corners: tuple[str, ...]
    corner_places: FloatArray
    stress_of: Any
    directions: FloatArray
    at_roots: Any = None

    def coriolis(self, shapes: FloatArray) -> FloatArray:
        """Coriolis forces between motions, shape (M, M): on the first one, over the rate of the second one and the cage's angular
        velocity about its axis (kg). They are ``-2 u1 . (z x u2)`` summed over the mass.
        """
        moves = shapes.reshape(-1, 3, shapes.shape[1])
        carried = np.zeros_like(moves)
        carried[:, 0], carried[:, 1] = -moves[:, 1], moves[:, 0]
        product: FloatArray = shapes.T @ (self.solid.mass @ carried.reshape(shapes.shape))
        return product.T - product

    def pushes(self) -> FloatArray:
        """Forces at the nodes for a unit normal force on each face, shape (3 N, F)."""
        normals = np.zeros((6 * len(self.faces), len(self.faces)))
        for at, (_, face) in enumerate(self.faces):
            normals[6 * at : 6 * at + 3, at] = -face.normal  # the roller pushes against the face
        return np.asarray(self.at_faces.T @ normals)


def cage_solid(bearing: Bearing, *, fineness: int = 1, cracked_bars: Iterable[int] = ()) -> CageSolid:
    """The finite-element model of a bearing's cage.

    Parameters
    ----------
    bearing : Bearing
        A bearing whose cage has a `body`, and a material with density.
    fineness : int
        Into how many parts each edge of the coarsest mesh is divided, 1 to 3.
    cracked_bars : iterable of int
        Bars that are cracked through at their root at the small end; bar k lies behind pocket k in the direction of rotation.

    Raises
    ------
    InputError
        If the cage has no body, its material no density, or a number is not allowed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> from trbdyn.extras.elastic.cage_solid import cage_solid
    >>> bearing = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})
    >>> frequencies, shapes = cage_solid(bearing).solid.natural(2)
    >>> bool(frequencies[0] > 1e3)
    True
    """
    from scipy.sparse import vstack

    parts = whole_number_of("fineness", fineness, 1, 3)
    body = bearing.cage.body
    if body is None:
        limit = "must be given: a finite-element model needs rims and bars (trb.CageBody)"
        raise InputError.of(("bearing", "cage", "body"), None, limit)
    made = elasticity(bearing)
    wall = Wall.of(bearing, body)
    mesh = wall_mesh(wall, fineness=parts, cracked_bars=frozenset(cracked_bars))
    solid = Solid.of(mesh.corners, mesh.elements, made)
    faces = tuple(every_surface(bearing))
    bars, rims = list(bar_sections(wall, mesh)), list(rim_sections(wall, mesh))
    at_roots = forces_on(solid, mesh.bar, bars)
    of_bars, of_rims = nominal_stress(bars), nominal_stress(rims)
    return CageSolid(
        solid=solid,
        faces=faces,
        at_faces=at_faces(bearing, faces, solid),
        corners=of_bars[1] + of_rims[1],
        corner_places=np.concatenate([of_bars[2], of_rims[2]]),
        directions=np.concatenate([of_bars[3], of_rims[3]]),
        at_roots=at_roots,
        stress_of=vstack([of_bars[0] @ at_roots, of_rims[0] @ forces_on(solid, mesh.rim, rims)]),
    )


def elasticity(bearing: Bearing) -> Elasticity:
    """What the cage of a bearing is made of; its material must have a density."""
    material = bearing.cage_material
    if material.density is None:
        raise InputError.of(("bearing", "cage", "material", "density"), None, "must be given (kg/m3)")
    return Elasticity(material.youngs_modulus, material.poisson_ratio, material.density)


def at_faces(bearing: Bearing, faces: tuple[tuple[int, Face], ...], solid: Solid) -> Any:
    """From the displacements of a solid to the displacement of each face's middle and the rotation of the face, sparse, shape
    (6 F, 3 N): those of the rigid body that is nearest, by least squares, to the surface around the face's middle.
    """
    from scipy.sparse import coo_array

    mesh = solid.basis.mesh
    surface = mesh.boundary_facets()
    ring = mesh.p.T[mesh.facets[:, surface]]  # corner, surface, direction
    middles = ring.mean(axis=0)
    normals = np.cross(ring[2] - ring[0], ring[-1] - ring[1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    inward = mesh.p[:, mesh.t[:, mesh.f2t[0, surface]]].mean(axis=1).T - middles
    normals *= -np.sign(np.einsum("fk,fk->f", inward, normals))[:, None]
    rows, columns, values = [], [], []
    for number, (pocket, face) in enumerate(faces):
        axes = pocket_axes(bearing, pocket)
        angle = 2.0 * math.pi * pocket / bearing.n_rollers
        outline = face.vertices
        origin = 0.5 * bearing.pitch_diameter * np.array([math.cos(angle), math.sin(angle), 0.0])
        place = origin + outline.mean(axis=0) @ axes
        facets = [one.vertices for one in bearing.pocket_of(pocket).faces if one.slot == face.slot]
        extent = np.ptp(np.concatenate(facets), axis=0).max()
        far = np.linalg.norm(middles - place, axis=1)
        far[normals @ (face.normal @ axes) < ALONG] = math.inf
        near = surface[far <= far.min() + PATCH * float(extent)]
        found = solid.basis.get_dofs(facets=near).flatten()
        arms = solid.nodes[found] - place
        motions = np.concatenate([np.hstack([np.eye(3), -crossed(arm)]) for arm in arms])
        rigid = np.kron(np.eye(2), axes) @ np.linalg.pinv(motions)
        places = (3 * found[:, None] + np.arange(3)).ravel()
        rows.append(np.repeat(6 * number + np.arange(6), len(places)))
        columns.append(np.tile(places, 6))
        values.append(rigid.ravel())
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return coo_array(entries, shape=(6 * len(faces), solid.nodes.size)).tocsr()
