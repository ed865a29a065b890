"""Meshes of a bearing's parts, from its inputs: rings, roller, cage with the faces of its pockets.

Origin: on the bearing axis in the roller-centre plane; z towards the rollers' large ends. Contact surfaces are those
of the model; what the model does not know (outer surface of the cup, bore of the cone, body of the cage behind the
faces) is drawn in usual proportions. Motion and clearances can be drawn larger by one factor (`trbdyn.viewer.meshes`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull

from trbdyn.model.bearing import Bearing
from trbdyn.model.outlines import cone_outline, cup_outline, rail_bands
from trbdyn.model.pocket import Face, pocket_axes
from trbdyn.model.profiles import profile_drop
from trbdyn.viewer.meshes import Mesh, flat_mesh, join, revolve, strip

Array = NDArray[np.float64]

AROUND = 48
"""Facets around a roller; rings have four times as many."""
CUT = (np.radians(-60.0), np.radians(70.0))
"""Sector of the cup that is left out, so that rollers and cage can be seen (rad from x towards y)."""


@dataclass(frozen=True)
class FaceMesh:
    """A face of a pocket: its mesh in the cage's frame, where it is, and where it points."""

    pocket: int
    slot: int  # column of its forces
    name: str
    mesh: Mesh  # its polygon
    centre: Array  # its middle (m), shape (3,)
    normal: Array  # unit normal towards the roller, shape (3,)
    shift: Array  # for each unit of exaggeration (m), shape (3,)


@dataclass(frozen=True)
class Shapes:
    """Every part of a bearing as meshes."""

    outer: Mesh  # the cup
    inner: Mesh  # the cone
    roller: Mesh  # a roller about its centre of mass, axis along z
    mark: Mesh  # a mark on the roller's large end, which shows its spin
    cage: Mesh  # body of the cage, in the cage's frame
    faces: tuple[FaceMesh, ...]  # faces of all pockets
    roller_rows: int  # rings of vertices of the roller's flank: the first rows of its mesh, AROUND + 1 vertices each
    largest_factor: float  # factor of exaggeration at which the bars of the cage become too thin to draw
    land: Mesh | None = None  # land of the ring that guides the cage
    guide: Mesh | None = None  # the cage's guiding surface on it
    land_turns: bool = False  # whether the land belongs to the inner ring


def shapes(bearing: Bearing, stations: ArrayLike, guidance: str = "rollers") -> Shapes:
    """Meshes of a bearing. Its rollers have rings of vertices at places along their flank from mid length towards the large end
    (m); a land is drawn where `guidance` is 'inner_land' or 'outer_land'.
    """
    flank = np.asarray(stations, dtype=float)
    faces = _faces(bearing)
    body, largest = _cage(bearing, faces)
    outer = revolve(cup_outline(bearing), facets=4 * AROUND, start=CUT[1], stop=CUT[0] + 2.0 * np.pi, caps=True)
    land, guide = (None, None) if guidance == "rollers" else _land(bearing, outer=guidance == "outer_land")
    return Shapes(
        outer=outer,
        inner=revolve(cone_outline(bearing), facets=4 * AROUND),
        roller=_roller(bearing, flank),
        mark=_mark(bearing),
        cage=body,
        faces=faces,
        roller_rows=flank.size,
        largest_factor=largest,
        land=land,
        guide=guide,
        land_turns=guidance == "inner_land",
    )


def _land(bearing: Bearing, *, outer: bool) -> tuple[Mesh, Mesh]:
    """Land of a ring as a band (that of the cup with the sector left out), and the cage's band on it: they meet where the real
    ones do.
    """
    land, thickness = bearing.land, 0.12 * bearing.roller.diameter
    radius, away = (land.outer_radius, 1.0) if outer else (land.inner_radius, -1.0)
    low, high = (land.offset + half * land.width for half in (-0.5, 0.5))

    def band(near: float, far: float) -> list[tuple[float, float]]:
        return [(near, low), (near, high), (far, high), (far, low)]

    sector = {"start": CUT[1], "stop": CUT[0] + 2.0 * np.pi, "caps": True} if outer else {}
    ring = revolve(band(radius, radius + away * thickness), facets=4 * AROUND, **sector)
    surface = radius - away * land.clearance
    guide = revolve(band(surface, surface - away * thickness), facets=4 * AROUND)
    outward = guide.position * [1.0, 1.0, 0.0]
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    return ring, Mesh(guide.position, guide.normal, guide.index, -away * land.clearance * outward)


# ---- roller ----


def _roller(bearing: Bearing, stations: Array) -> Mesh:
    geometry, roller = bearing.geometry, bearing.roller
    slope, offset = np.tan(geometry.roller_half_angle), geometry.roller_mass_offset
    drop = profile_drop(bearing, stations)
    radius = 0.5 * roller.diameter + stations * slope
    angles = np.linspace(0.0, 2.0 * np.pi, AROUND + 1)
    rows = np.stack([radius, stations - offset], axis=1)
    outward = np.broadcast_to([np.cos(geometry.roller_half_angle), -np.sin(geometry.roller_half_angle)], rows.shape)
    flank = strip(rows - np.stack([drop, 0.0 * drop], axis=1), angles, np.array(outward))
    inward = np.repeat(-drop, angles.size)[:, None]
    around = np.tile(np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1), (stations.size, 1))
    flank = Mesh(flank.position, flank.normal, flank.index, inward * around)
    # large end: a sphere about the point on the axis that the model uses; rounded corners join it to the flank
    top, bottom = 0.5 * roller.total_length, geometry.small_end_station
    last, first = rows[-1] - [drop[-1], 0.0], rows[0] - [drop[0], 0.0]
    rim = 0.96 * (0.5 * roller.diameter + top * slope)
    centre = geometry.sphere_centre - geometry.apex_to_mid - offset
    r = np.linspace(0.0, rim, 7)
    sphere = np.stack([r, centre + np.sqrt(geometry.sphere_radius**2 - r**2)], axis=1)
    small = 0.95 * geometry.small_end_radius
    parts = [
        flank,
        strip(np.array([sphere[-1], last]), angles),
        strip(sphere, angles, np.stack([r, sphere[:, 1] - centre], axis=1) / geometry.sphere_radius),
        strip(np.array([first, [small, bottom - offset]]), angles),
        strip(np.array([[small, bottom - offset], [0.0, bottom - offset]]), angles),
    ]
    return join(parts)


def _mark(bearing: Bearing) -> Mesh:
    """A bar across half the large end, and down the flank for a short way."""
    geometry = bearing.geometry
    top = 0.5 * bearing.roller.total_length - geometry.roller_mass_offset
    size = 0.5 * geometry.large_end_diameter
    x = np.array([0.12, 0.9]) * size
    lift = top + 0.012 * size
    points = np.array([[a, b * 0.09 * size, lift] for a in x for b in (-1.0, 1.0)])
    return flat_mesh(points, np.array([[0, 2, 1], [1, 2, 3]]))


# ---- cage ----


def _faces(bearing: Bearing) -> tuple[FaceMesh, ...]:
    out = []
    for number in range(bearing.n_rollers):
        pocket = bearing.pocket_of(number)
        gaps = pocket.gaps(bearing.geometry)
        turn, axes = 2.0 * np.pi * number / bearing.n_rollers, pocket_axes(bearing, number)
        origin = 0.5 * bearing.pitch_diameter * np.array([np.cos(turn), np.sin(turn), 0.0])
        for face in pocket.faces:
            points = origin + face.vertices @ axes
            normal = face.normal @ axes
            shift = -max(gaps[face.name], 0.0) * normal
            ring = np.arange(1, points.shape[0] - 1)
            fan = np.stack([np.zeros_like(ring), ring, ring + 1], axis=1)
            mesh = flat_mesh(points, fan, np.broadcast_to(shift, points.shape))
            out.append(FaceMesh(number, face.slot, face.name, mesh, points.mean(axis=0), normal, shift))
    return tuple(out)


def _cage(bearing: Bearing, faces: tuple[FaceMesh, ...]) -> tuple[Mesh, float]:
    """Bars between the flank faces of neighbouring pockets, a rail at each end; and the largest factor of
    exaggeration.
    """
    parts, largest = [], 200.0
    count, bands = bearing.n_rollers, rail_bands(bearing)
    ends = (bands[0][2], bands[1][2])
    by_pocket: dict[int, list[Face]] = {k: list(bearing.pocket_of(k).faces) for k in range(count)}
    meshes = {(face.pocket, face.name): face for face in faces}
    for number in range(count):
        after = (number + 1) % count
        ahead = [f for f in by_pocket[number] if f.part == "flank" and f.vertices[:, 1].mean() > 0.0]
        behind = [f for f in by_pocket[after] if f.part == "flank" and f.vertices[:, 1].mean() < 0.0]
        for one in ahead:
            for two in behind:
                if not _side_by_side(one, two):
                    continue
                pair = (meshes[number, one.name], meshes[after, two.name])
                bar, factor = _bar(bearing, pair, ends)
                largest = min(largest, factor)
                if bar is not None:
                    parts.append(bar)
        lone = [meshes[number, f.name] for f in by_pocket[number]]
        parts += [_plate(face, 0.05 * bearing.roller.diameter) for face in lone]
    parts += [_rail(bearing, band) for band in bands]
    return join(parts), max(largest, 1.0)


def _side_by_side(one: Face, two: Face) -> bool:
    """Whether two faces cover the same part of the roller's length, by more than half of the shorter."""
    low = max(one.vertices[:, 2].min(), two.vertices[:, 2].min())
    high = min(one.vertices[:, 2].max(), two.vertices[:, 2].max())
    shortest = min(np.ptp(one.vertices[:, 2]), np.ptp(two.vertices[:, 2]))
    return bool(high - low > 0.5 * shortest)


def _bar(bearing: Bearing, pair: tuple[FaceMesh, FaceMesh], ends: tuple[float, float]) -> tuple[Mesh | None, float]:
    """The material between two faces: the hull of their polygons, prolonged to the rails by a narrower core."""
    points, shift = [], []
    middle = 0.5 * (pair[0].centre + pair[1].centre)
    for face in pair:
        corners = np.unique(face.mesh.position, axis=0)
        points.append(corners)
        shift.append(np.broadcast_to(face.shift, corners.shape))
    thickness = float(np.linalg.norm(pair[0].centre - pair[1].centre))
    closing = sum(float(np.linalg.norm(face.shift)) for face in pair)
    corners = np.vstack(points)
    direction = np.array([middle[0], middle[1], 0.0])
    direction /= np.linalg.norm(direction)
    axis = bearing.geometry.roller_axis_angle
    along = np.sin(axis) * direction + np.array([0.0, 0.0, np.cos(axis)])
    core = middle + 0.55 * (corners - middle)
    place = (core - middle) @ along
    for station in ends:
        points.append(core - (place - station)[:, None] * along)
        shift.append(np.zeros_like(core))
    everything, moved = np.vstack(points), np.vstack(shift)
    factor = 1.0 + 0.6 * thickness / closing if closing > 0.0 else 200.0
    try:
        hull = ConvexHull(everything)
    except Exception:  # flat or too few points: the plates of the faces are drawn alone
        return None, factor
    triangles = hull.simplices.astype(np.int64)
    a, b, c = everything[triangles].transpose(1, 0, 2)
    inside = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    triangles[inside] = triangles[inside][:, ::-1]
    return flat_mesh(everything, triangles, moved), factor


def _plate(face: FaceMesh, thickness: float) -> Mesh:
    """A thin plate behind a face, so that it has a back."""
    corners = face.mesh.position - 1e-3 * thickness * face.normal
    back = corners[face.mesh.index][:, ::-1].reshape(-1, 3) - thickness * face.normal
    return flat_mesh(back, np.arange(back.shape[0]).reshape(-1, 3), np.broadcast_to(face.shift, back.shape))


def _rail(bearing: Bearing, band: tuple[float, float, float, float, float]) -> Mesh:
    """A ring of the cage."""
    low, high, near, far, shift = band
    geometry = bearing.geometry
    cosine, sine = np.cos(geometry.roller_axis_angle), np.sin(geometry.roller_axis_angle)
    origin = 0.5 * bearing.pitch_diameter

    def place(n: float, a: float) -> tuple[float, float]:
        return origin + n * cosine + a * sine, a * cosine - n * sine

    corners = [place(low, near), place(low, far), place(high, far), place(high, near)]
    mesh = revolve(corners, facets=4 * AROUND)
    radius = np.hypot(mesh.position[:, 0], mesh.position[:, 1])[:, None]
    outward = mesh.position / radius * [1.0, 1.0, 0.0]
    return Mesh(mesh.position, mesh.normal, mesh.index, shift * (sine * outward + np.array([0.0, 0.0, cosine])))
