"""Rollers in their cage pockets: spheres of flank and large end against bounded faces, vertices against the small end.

All points that a plane does not rule out are put on one list, whatever roller, state, face and node they belong to.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .constants import PALMGREN, SLIDING_GUARD, Constants
from .rings import boundary, cross, five, slip, smallest, sum_of

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def distance_in_plane(c: Constants, face: Index, u: Array, v: Array) -> tuple[Array | None, Array | None]:
    """From points in the planes of faces to the nearest points of their outlines, (du, dv); None if all lie inside."""
    start, edge = c.edge_start.take(face, axis=1), c.edge.take(face, axis=1)
    along_u, along_v = u[:, None] - start[0], v[:, None] - start[1]
    outside = edge[0] * along_v < edge[1] * along_u
    if not outside.any():
        return None, None
    share = np.clip((along_u * edge[0] + along_v * edge[1]) * c.edge_per_square[face], 0.0, 1.0)
    gap_u, gap_v = share * edge[0] - along_u, share * edge[1] - along_v
    square = np.where(outside, gap_u * gap_u + gap_v * gap_v, np.inf)
    best = np.arange(len(u)), square.argmin(axis=1)
    out = outside.any(axis=1)
    return np.where(out, gap_u[best], 0.0), np.where(out, gap_v[best], 0.0)


def pocket_wrenches(
    c: Constants, roller: Array, turn: tuple[Array, Array], cage: Array, cage_axes: Array
) -> tuple[Array, Array] | None:
    """Wrenches on rollers, in their orbiting frames, and on the cage, in R and about its centre, from each roller.

    Parameters
    ----------
    roller : ndarray, shape (3, 4, roller, state)
        Position, axis, velocity, angular velocity in the orbiting frames.
    turn : tuple of ndarray, shape (roller, state)
        Cosine and sine of the orbit angles in R.
    cage : ndarray, shape (3, 3, state)
        Position, velocity, angular velocity in R.
    cage_axes : ndarray, shape (state, 3, 3)
        Axes of the cage's body in R, as columns.

    Returns
    -------
    tuple of ndarray, shape (6, roller, state), or None
        None if nothing touches.
    """
    z, states = turn[0].shape
    cosine, sine = turn
    # relative to the cage, in R: x - x_cage, axis, velocity of the centre against the cage there, angular velocity
    seen = np.empty_like(roller)
    np.multiply(roller[0], cosine, out=seen[0])
    seen[0] -= roller[1] * sine
    np.multiply(roller[0], sine, out=seen[1])
    seen[1] += roller[1] * cosine
    seen[2] = roller[2]
    away = seen[:, 0]
    away -= cage[:, 0, None]
    seen[:, 3] -= cage[:, 2, None]
    seen[:, 2] -= cross(five(cage[:, 2, None]), five(away))
    seen[:, 2] -= cage[:, 1, None]
    axes = np.matmul(cage_axes, c.pocket_axes)
    local = np.matmul(axes.swapaxes(-1, -2), seen.transpose(2, 3, 0, 1))
    local[..., 0] -= c.pocket_origin.T[:, None]

    # heights over the planes, interference of vertices; what is left is a short list
    height = np.matmul(c.face_normal.T, local[..., :2])
    flank = height[..., c.flank, 1, None] * c.centre[:, :, None, :]
    flank += height[..., c.flank, 0, None]
    flank -= c.flank_reach
    large = c.large_station * height[..., c.large, 1]
    large += height[..., c.large, 0]
    large -= c.large_reach[..., 0]
    small = np.matmul(local[..., 1], c.vertex.T)
    small -= sum_of(local[..., 0] * local[..., 1], axis=-1)[..., None]
    small -= c.vertex_off

    parts = []
    state = local.transpose(2, 3, 0, 1).reshape(3, 4, z * states)
    if flank.size and smallest(flank, axis=None) < 0.0:
        j, b, f, k = np.nonzero(flank < 0.0)
        at, node, stiffness = j * states + b, j * c.n_nodes + k, c.flank_log_stiffness[f, k]
        station, radius = c.centre.take(node), c.sphere.take(node)
        parts.append(_spheres(c, at, state.take(at, axis=2), c.flank.take(f), station, radius, stiffness, PALMGREN))
    if large.size and smallest(large, axis=None) < 0.0:
        j, b, f = np.nonzero(large < 0.0)
        at, stiffness = j * states + b, c.large_log_stiffness[f]
        station, radius = np.full(j.size, c.large_station), np.full(j.size, c.g.sphere_radius)
        parts.append(_spheres(c, at, state.take(at, axis=2), c.large.take(f), station, radius, stiffness, 1.5))
    if small.size and small.max() > 0.0:
        j, b, i = np.nonzero(small > 0.0)
        at = j * states + b
        own = state.take(at, axis=2)
        load = np.exp(c.vertex_log_stiffness[i] + 1.5 * np.log(small[j, b, i]))
        parts.append((at, c.vertex_face[i], own, c.vertex[i].T - own[:, 0], -own[:, 1], load))
    parts = [part for part in parts if part[0].size]
    if not parts:
        return None
    at, face, own, arm, normal, load = (
        parts[0] if len(parts) == 1 else (np.concatenate(p, axis=-1) for p in zip(*parts, strict=True))
    )

    # wrenches of the points, summed over those of one roller and state
    arm = five(arm)
    sliding = cross(five(own[:, 3]), arm)
    sliding += own[:, 2]
    sliding -= sum_of(sliding * normal) * normal
    speed = np.sqrt(sum_of(sliding * sliding) + SLIDING_GUARD**2)
    mu = boundary(c, slip(c, speed)) * c.face_friction[face]
    normal = load * normal
    sliding *= load * mu / speed
    sliding += normal
    force = five(sliding)
    wrench = np.concatenate((sliding, cross(arm, force)))
    np.negative(wrench, out=wrench)
    keys = at + (z * states * np.arange(6))[:, None]
    total = np.bincount(keys.ravel(), weights=wrench.ravel(), minlength=6 * z * states).reshape(2, 3, z, states)
    in_r = np.matmul(axes, total.transpose(2, 3, 1, 0)).transpose(3, 2, 0, 1)
    on_cage = np.empty((6, z, states))
    np.negative(in_r[0], out=on_cage[:3])
    np.negative(in_r[1] + cross(five(away), five(in_r[0])), out=on_cage[3:])
    on_roller = np.empty((2, 3, z, states))
    on_roller[:, 0] = in_r[:, 0] * cosine + in_r[:, 1] * sine
    on_roller[:, 1] = in_r[:, 1] * cosine - in_r[:, 0] * sine
    on_roller[:, 2] = in_r[:, 2]
    return on_roller.reshape(6, z, states), on_cage


def _spheres(
    c: Constants, at: Index, own: Array, face: Index, station: Array, radius: Array, log_stiffness: Array, power: float
) -> tuple[Index, Index, Array, Array, Array, Array]:
    """Those of a list of spheres that touch their face: (roller and state, face, state, arm, normal, load)."""
    along = station * own[:, 1]
    origin, *axes = c.face_vectors.take(face, axis=2)
    rel = own[:, 0] + along
    rel -= origin
    u, v, normal = axes
    du, dv = distance_in_plane(c, face, sum_of(rel * u), sum_of(rel * v))
    to = sum_of(rel * normal) * -normal
    if du is not None:
        to += du * u + dv * v
    distance = np.sqrt(sum_of(to * to))
    d = radius - distance
    if smallest(d) <= 0.0:
        near = np.flatnonzero(d > 0.0)
        at, face, own, along, to = at[near], face[near], own[..., near], along[:, near], to[:, near]
        distance, d, radius, log_stiffness = distance[near], d[near], radius[near], log_stiffness[near]
    to /= np.maximum(distance, 1e-12)
    load = np.exp(log_stiffness + power * np.log(d))
    return at, face, own, along + (radius - 0.5 * d) * to, to, load
