"""Rollers on both rings: raceways, back-face rib, front rib. Wrenches on the rollers, in their orbiting frames.

Vectors have their component first, (x, y, z), or (x, y, z, x, y) where a cross product is a difference of two slices.
Contacts are (race, roller, state), nodes add a last axis; the rib is one more node of the inner race.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .constants import (
    ELASTIC,
    NORMAL,
    PRESSURE,
    RESISTANCE,
    RIGID,
    ROLLING_SPEED,
    SMALLEST_INTERFERENCE,
    THERMAL_1,
    THERMAL_2,
    THERMAL_3,
    TRACTION,
    Constants,
)

Array = NDArray[np.float64]
sum_of = np.add.reduce
smallest = np.minimum.reduce


@dataclass
class Poses:
    """Rollers in their orbiting frames, and the inner ring as each of them sees it; (3, roller, state)."""

    x: Array
    axis: Array
    velocity: Array
    omega: Array
    orbit: Array
    ring_axis: Array
    ring_centre: Array
    ring_omega: Array


def cross(a: Array, b: Array) -> Array:
    """Cross product of vectors of five components."""
    out = a[1:4] * b[2:5]
    out -= a[2:5] * b[1:4]
    return out


def five(a: Array) -> Array:
    """(x, y, z) as (x, y, z, x, y)."""
    return np.concatenate((a, a[:2]))


def boundary(c: Constants, slide_roll: Array) -> Array:
    """Boundary friction coefficient (6)."""
    e = np.expm1(-c.p["boundary_decay"] * slide_roll)
    mu: Array = c.p["boundary_slope"] * slide_roll * (1.0 + e) - c.p["boundary_limit"] * e
    return mu


def slip(c: Constants, speed: Array) -> Array:
    """Slide-roll ratio of surfaces that do not roll."""
    out: Array = speed / np.sqrt(0.25 * speed * speed + c.p["cage_entrainment_speed"] ** 2)
    return out


def motion(p: Poses, away: Array) -> tuple[Array, Array]:
    """Sliding and mean velocity at a point are V + W x arm, relative to the contact that orbits with the roller; arm from the
    roller's centre of mass. V (kind, 3, race, roller, state), W with five components; away: from the ring's centre.
    """
    ring = cross(five(p.ring_omega), five(away))
    v = np.empty((2, 3, 2, *p.orbit.shape))
    v[0, :, 0] = p.velocity
    np.subtract(p.velocity, ring, out=v[0, :, 1])
    np.multiply(p.velocity, 0.5, out=v[1, :, 0])
    v[1, 1, 0] -= p.velocity[1]
    np.multiply(ring, 0.5, out=v[1, :, 1])
    v[1, :, 1] += v[1, :, 0]
    w = np.empty((2, 5, 2, *p.orbit.shape))
    w[0, :3, 0] = p.omega
    np.subtract(p.omega, p.ring_omega, out=w[0, :3, 1])
    np.multiply(p.omega, 0.5, out=w[1, :3, 0])
    w[1, 2, 0] -= p.orbit
    np.multiply(p.ring_omega, 0.5, out=w[1, :3, 1])
    w[1, :3, 1] += w[1, :3, 0]
    w[:, 3:] = w[:, :2]
    return v, w


def shares(c: Constants, e: Array, speeds: Array, touching: Array) -> Array:
    """Load, friction over sliding speed and rolling resistance over mean speed of every node, from its powers."""
    slide = speeds[0]
    top = 1.0 - e[THERMAL_1]
    bottom = e[THERMAL_2] + e[THERMAL_3]
    bottom += 1.0
    top /= bottom
    floor = c.p["thermal_floor"]
    if smallest(top, axis=None) < 1.5 * floor:
        t = np.clip(top - floor, -0.5 * floor, 0.5 * floor) + 0.5 * floor
        top = floor + t * t / (2.0 * floor) + np.maximum(top - 1.5 * floor, 0.0)
    e[RESISTANCE] *= top
    film = np.maximum(e[ELASTIC], e[RIGID], out=bottom)
    film *= top
    # (7)-(9): sigma = eta |Du|/(tau0 h), ratio = D/Sigma
    bar = e[PRESSURE]
    sigma = c.dicke_c * bar
    sigma += c.dicke_a
    np.divide(bar, sigma, out=sigma)
    np.exp(sigma, out=sigma)
    sigma *= slide
    sigma /= film
    above = bar
    above *= c.shear_slope
    above -= c.shear_offset
    shear = np.minimum(above, 1.0)
    np.maximum(shear, -1.0, out=shear)
    shear += 1.0
    shear *= shear
    shear *= 0.25
    above -= 1.0
    shear += np.maximum(above, 0.0, out=above)
    shear += 2.0
    shear *= slide
    ratio = e[ROLLING_SPEED]
    ratio *= film
    ratio /= shear
    s = np.arcsinh(sigma, out=sigma)
    product = ratio * s
    plastic = product >= 2.0
    if plastic.any():
        np.copyto(product, 2.0, where=plastic)
        np.copyto(s, 2.0 / ratio, where=plastic)
    product *= -0.25
    product += 1.0
    s *= product
    drag = e[TRACTION]
    drag *= s
    # (2): boundary friction only where some film is thin enough to share it
    if smallest(film, axis=None) < c.least_film:
        full, low = c.p["lambda_full"], c.p["lambda_boundary"]
        t = np.clip((film * c.per_film - full) / (low - full), 0.0, 1.0)
        t *= t
        drag += t * t * t * (e[NORMAL] * boundary(c, slide / speeds[1]) / slide - drag)
    # rolling resistance sets in over a band of h_PE/h_IR
    quotient = e[ELASTIC] / e[RIGID]
    if smallest(quotient[..., : c.n_nodes], axis=None) < 1.0 + c.p["rolling_blend"]:
        t = quotient
        t -= 1.0 - c.p["rolling_blend"]
        t *= 0.5 / c.p["rolling_blend"]
        np.minimum(np.maximum(t, 0.0, out=t), 1.0, out=t)
        e[RESISTANCE] *= t * t * (3.0 - 2.0 * t)
    out: Array = e[: RESISTANCE + 1]
    out *= touching
    return out


def front_rib(c: Constants, p: Poses, d: Array, across: Array, lean: Array, v: Array, w: Array) -> Array:
    """Wrench of the small end on the front rib's edges, d: their interference (edge, roller, state)."""
    centre = p.ring_centre - c.g.centre_plane * p.ring_axis - p.x
    d = np.maximum(d, 0.0)
    arm = five(centre[:, None] + c.front_z * p.ring_axis[:, None] + c.front_radius / lean * across[:, None])
    sliding = w[0, 1:4, None] * arm[2:5] - w[0, 2:5, None] * arm[1:4] + v[0, :, None]
    normal = -p.axis[:, None]
    sliding -= sum_of(sliding * normal) * normal
    speed = np.sqrt(sum_of(sliding * sliding) + c.guards.flat[0])
    load = 0.5 * c.p["end_stiffness"] * d * np.sqrt(d)
    force = five(-load * normal - load * boundary(c, slip(c, speed)) / speed * sliding)
    out: Array = sum_of(np.concatenate((force[:3], cross(arm, force))), axis=1)
    return out


def ring_wrenches(c: Constants, p: Poses) -> Array:
    """Force and moment of both rings on every roller, (6, roller, state)."""
    z, states, n = *p.orbit.shape, c.n_nodes + 1
    # the line of the spheres' centres against each race's axis
    race_axis = np.zeros((3, 2, z, states))
    race_axis[2, 0] = 1.0
    race_axis[:, 1] = p.ring_axis
    line = np.empty((3, 2, 2, z, states))
    away = p.x - p.ring_centre
    line[:, 0, 0] = p.x
    np.multiply(p.ring_axis, c.g.centre_plane, out=line[:, 0, 1])
    line[:, 0, 1] += away
    line[:, 1] = p.axis[:, None]
    along = sum_of(line * race_axis[:, None])
    across = line - along * race_axis[:, None]
    squares = sum_of(across * across)
    mixed = sum_of(across[:, 0] * across[:, 1])
    mixed *= 2.0
    v, w = motion(p, away)

    # interference, normals and arms of the nodes
    s, shape = c.station, (2, z, states, n)
    off = squares[1, ..., None] * s
    off += mixed[..., None]
    off *= s
    off += squares[0, ..., None]
    np.sqrt(off, out=off)
    d = along[1, ..., None] * s
    d += along[0, ..., None]
    d *= c.upward
    d += c.offset
    d += off * c.outward
    at = np.empty((3, 3, *shape))
    normal = at[0]
    np.multiply(across[:, 1, ..., None], s, out=normal)
    normal += across[:, 0, ..., None]
    normal *= np.divide(c.outward, off, out=off)
    normal += race_axis[..., None] * c.upward
    arm = np.empty((5, *shape))
    np.multiply(d, -0.5, out=off)
    off += c.radius
    np.multiply(normal, off, out=arm[:3])
    arm[:3] += p.axis[:, None, ..., None] * s
    arm[3:] = arm[:2]

    # sliding and mean velocities along the surface, and their magnitudes
    velocity = at[1:]
    np.multiply(w[:, 1:4, ..., None], arm[2:5], out=velocity)
    velocity -= w[:, 2:5, ..., None] * arm[1:4]
    velocity += v[..., None]
    velocity -= sum_of(velocity * normal, axis=1)[:, None] * normal
    speeds = sum_of(velocity * velocity, axis=1)
    speeds += c.guards
    np.sqrt(speeds, out=speeds)

    # logarithms of (interference, sliding, mean) give every power
    logs = np.empty((3, *shape))
    np.maximum(d, SMALLEST_INTERFERENCE, out=logs[0])
    logs[1:] = speeds
    np.log(logs, out=logs)
    e = np.matmul(c.race_matrix, logs.reshape(3, -1)).reshape(10, *shape)
    e += c.constant
    e[:, 1, ..., -1] += np.matmul(c.rib_change, logs[:, 1, ..., -1].reshape(3, -1)).reshape(10, z, states)
    np.exp(e, out=e)

    # forces: load along the normal, friction along sliding, rolling resistance along the mean velocity
    at *= shares(c, e, speeds, d > 0.0)[:, None]
    total, force = np.empty((6, *shape)), np.empty((5, *shape))
    sum_of(at, axis=0, out=force[:3])
    force[3:] = force[:2]
    total[:3] = force[:3]
    np.multiply(arm[1:4], force[2:5], out=total[3:])
    total[3:] -= arm[2:5] * force[1:4]
    out: Array = sum_of(total, axis=(1, 4))
    np.negative(out, out=out)

    lean = np.sqrt(squares[1, 1])
    front = c.front_radius * lean
    front += c.front_z * along[1, 1]
    front -= sum_of(line[:, 0, 1] * p.axis) + c.small_end
    if front.max() > 0.0:
        out += front_rib(c, p, front, across[:, 1, 1], lean, v[:, :, 1], w[:, :, 1])
    return out
