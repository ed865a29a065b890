"""Outlines of a bearing's parts in a plane through its axis, for drawings: raceways, ribs, profile of the roller, cage rails.

Contact surfaces are those of the model; what the model does not know (outer surface of the cup, bore of the cone, body of
the cage behind its faces) has usual proportions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

Array = NDArray[np.float64]


def _on_race(bearing: Bearing, half_angle: float, station: float, height: float = 0.0) -> Array:
    """(r, z) on a raceway where a roller's station touches it, or a height above it (away from the material)."""
    geometry = bearing.geometry
    distance = (geometry.apex_to_mid + station) / np.cos(geometry.roller_half_angle)
    sine, cosine = np.sin(half_angle), np.cos(half_angle)
    return np.array([distance * sine + height * cosine, distance * cosine - height * sine - geometry.centre_plane])


def _cylindrical(bearing: Bearing, ring: Literal["inner", "outer"]) -> list[Array]:
    """Outline of a ring of a cylindrical bearing: its raceway first, from the small to the large ends, then round its body."""
    roller, ribs, geometry = bearing.roller, bearing.ribs, bearing.geometry
    out = 1.0 if ring == "outer" else -1.0  # from the rollers into the ring
    race = 0.5 * (bearing.pitch_diameter + out * (roller.diameter + 0.5 * bearing.radial_clearance))
    half, size, round_end = 0.5 * roller.total_length, roller.diameter, geometry.sphere_radius
    sine = out * (0.5 * roller.diameter + 0.25 * bearing.radial_clearance - ribs.contact_height) / round_end
    cosine = np.sqrt(1.0 - sine**2)
    body = race + out * 0.3 * size if ring == "outer" else max(race - 0.35 * size, 0.4 * race)
    ends: dict[str, list[tuple[float, float]]] = {}
    for end, along in (("small", -1.0), ("large", 1.0)):
        if (ring, end) not in ribs.places:
            edge = along * 1.06 * half
            ends[end] = [(race, edge), (body, edge)]
            continue
        contact = np.array(
            [
                0.5 * bearing.pitch_diameter + round_end * sine,
                along * (half - round_end * (1.0 - cosine) + ribs.clearance),
            ]
        )
        face = -out * np.array([cosine, -along * sine])
        foot, top = (contact + (height - ribs.contact_height) * face for height in (0.0, ribs.edge_high))
        back = float(foot[1]) + along * 0.28 * size
        ends[end] = [(race, float(foot[1])), (float(top[0]), float(top[1])), (float(top[0]), back), (body, back)]
    outline = [ends["small"][0], *ends["large"], *ends["small"][:0:-1]]
    return [np.array(corner) for corner in outline]


def cup_outline(bearing: Bearing) -> list[Array]:
    if bearing.is_cylindrical:
        return _cylindrical(bearing, "outer")
    roller = bearing.roller
    half = 0.5 * roller.total_length
    small, large = (
        _on_race(bearing, np.radians(bearing.cup_half_angle_deg), station) for station in (-1.06 * half, 1.06 * half)
    )
    outside = large[0] + 0.3 * roller.diameter
    return [small, large, np.array([outside, large[1]]), np.array([outside, small[1]])]


def cone_outline(bearing: Bearing) -> list[Array]:
    if bearing.is_cylindrical:
        return _cylindrical(bearing, "inner")
    geometry, roller, ribs = bearing.geometry, bearing.roller, bearing.ribs
    size, angle = roller.diameter, geometry.cone_half_angle
    front_station = geometry.small_end_station - ribs.front_clearance
    small, large = (_on_race(bearing, angle, station) for station in (front_station, 0.5 * roller.total_length))
    tilt = geometry.rib_normal_angle
    face = np.array([np.cos(tilt), -np.sin(tilt)])
    contact = np.array([geometry.rib_contact_radius, geometry.rib_contact_z - geometry.centre_plane])
    rib_foot, rib_top = (contact + (h - ribs.contact_height) * face for h in (0.0, ribs.edge_high))
    axis = geometry.roller_axis_angle
    across = np.array([np.cos(axis), -np.sin(axis)])
    front_top = small + ribs.front_high * across
    bore = max(small[0] - 0.35 * size, 0.4 * small[0])
    back, front = rib_foot[1] + 0.28 * size, small[1] - 0.16 * size
    outline = [
        (bore, front),
        (bore, back),
        (rib_top[0], back),
        rib_top,
        rib_foot,
        large,
        small,
        front_top,
        (front_top[0], front),
    ]
    return [np.array(corner) for corner in outline]


def rail_bands(bearing: Bearing) -> list[tuple[float, float, float, float, float]]:
    """Lowest n, highest n, stations of the near and the far side, shift along a: of the small- and the large-end
    rail.
    """
    roller, cage = bearing.roller, bearing.cage
    half, thickness = 0.5 * roller.total_length, 0.22 * roller.diameter
    out = []
    for part, sign in (("small_end", -1.0), ("large_end", 1.0)):
        walls = [face for face in bearing.pocket.faces if face.part == part]
        near, low, high = half + cage.play_axial, cage.wall_inner, cage.wall_outer
        shift = cage.play_axial if part == "small_end" else 0.0
        if walls:
            corners = np.vstack([face.vertices for face in walls])
            low, high = float(corners[:, 0].min()), float(corners[:, 0].max())
            near = float(np.abs(corners[:, 2]).max())
        near += 1e-4 * roller.diameter
        out.append((low, high, sign * near, sign * (near + thickness), sign * shift))
    return out
