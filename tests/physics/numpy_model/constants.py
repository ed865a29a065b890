"""Numbers of a scene that stay the same in time, in the shapes that the contacts want."""

from __future__ import annotations

from math import cos, log, pi, sin, tan

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.model.flatten import diameter_deviation, face_rows, scene_entries
from trbdyn.model.scene import Scene
from trbdyn.statics.core_model import build_model
from trbdyn.statics.ring_motion import ring_motion

Array = NDArray[np.float64]

PALMGREN = 10.0 / 9.0
SMALLEST_INTERFERENCE = 1e-15
SLIDING_GUARD = 1e-9
PASCAL_PER_BAR = 1e5

NORMAL, TRACTION, RESISTANCE, ROLLING_SPEED, PRESSURE, ELASTIC, RIGID, THERMAL_1, THERMAL_2, THERMAL_3 = range(10)
"""Powers of interference, sliding and mean speed: load (N); traction over sliding speed at S = 1; rolling resistance
over mean speed; mean speed over half width times viscosity over the floor's half width; mean pressure (bar); both
films times tau0 over viscosity; the three powers of the thermal factor."""


class Constants:
    """Everything about a scene that the right-hand side reads.

    Parameters
    ----------
    scene : Scene
        The scene; effects of the paper, constant in time.

    Raises
    ------
    NotImplementedError
        If the scene has effects that are not written here.
    """

    def __init__(self, scene: Scene) -> None:
        self.p = {name: float(entry.value) for name, entry in scene_entries(scene).items()}
        self.g = scene.bearing.geometry
        motion = ring_motion(build_model(scene), scene)[0].table
        self.check(motion)
        self.n_rollers = int(self.p["n_rollers"])
        self.n_nodes = int(self.p["n_slices"])
        self._motion(motion[0])
        self._nodes(diameter_deviation(scene))
        self._exponents()
        self._ribs()
        self._layout()
        self._faces(face_rows(scene))

    def check(self, motion: Array) -> None:
        """Say what is not written here."""
        p = self.p
        needed = {
            "with_cage": 1, "planar": 0, "lubrication": 2, "traction": 2, "thermal": 1, "rolling_resistance": 1,
            "rolling_pressure_force": 0, "back_rib": 1, "front_rib": 1, "rib_film": 0, "pocket_bars": 1, "pocket_ends": 1,
            "pocket_edges": 1, "damping": 0, "viscosity_law": 0,
        }  # fmt: skip
        other = [name for name, value in needed.items() if p[name] != value]
        if other or len(motion) != 1:
            raise NotImplementedError(f"the NumPy model has the paper's effects and constant motion; {other} differ")

    def _motion(self, row: Array) -> None:
        at = {name: float(row[1 + 2 * i]) for i, (name, _, _) in enumerate(_core.motion_table())}
        self.shaft_speed = at["shaft_speed"]
        self.frame_speed = self.g.cage_speed_ratio * self.shaft_speed
        self.start_time = float(row[0])
        turn = np.array([at["rotation_x"], at["rotation_y"]])
        angle = float(np.hypot(*turn))
        sinc = sin(angle) / angle if angle > 1e-8 else 1.0 - angle * angle / 6.0
        axis = np.array([sinc * turn[1], -sinc * turn[0], cos(angle)])
        centre = np.array([at["displacement_x"], at["displacement_y"], at["displacement_z"] + self.g.centre_plane])
        gravity = np.array([at["gravity_x"], at["gravity_y"], at["gravity_z"]])
        # (component, which): ring axis, ring centre, gravity, ring's angular velocity: what every roller's frame sees turned
        self.fixed_vectors = np.stack([axis, centre, gravity, self.shaft_speed * axis], axis=1)[:, :, None, None]

    def _nodes(self, deviation: Array) -> None:
        p, g, n = self.p, self.g, self.n_nodes
        if p["quadrature"] == 1:
            raise ValueError("quadrature = 'gauss': this model has uniform slices alone")
        length = (
            min(p["effective_length"], p["profile_c"] + p["profile_d"]) if p["profile"] == 3 else p["effective_length"]
        )
        nu, half = g.roller_half_angle, 0.5 * length
        node, weight = (2.0 * np.arange(n) + 1.0) / n - 1.0, np.full(n, 2.0 / n)
        station = half * node
        nominal, along = (g.apex_to_mid + station) * tan(nu), (g.apex_to_mid + station) / cos(nu)
        radius = nominal + 0.5 * deviation[:, None] - self._drop(station)
        self.weight = half * weight
        self.centre = (station + radius * tan(nu) - g.roller_mass_offset)[:, None, :]
        self.sphere = (radius / cos(nu))[:, None, :]
        angles = np.array([p["cup_half_angle"], g.cone_half_angle])[:, None]
        sign = np.array([1.0, -1.0])[:, None]
        self.race_radius = 1.0 / (cos(nu) / nominal - sign * np.cos(angles) / (along * np.sin(angles)))
        # A sphere on the axis against a cone: d = offset + outward * (distance from the ring's axis) + upward * height. The
        # last node of the inner race is the large end on the rib; that of the outer race never touches.
        shape = (2, len(deviation), 1, n + 1)
        self.station, self.radius, self.offset = np.zeros(shape), np.zeros(shape), np.full(shape, -1e-3)
        self.outward, self.upward = np.zeros(shape), np.zeros(shape)
        self.station[..., :n], self.radius[..., :n], self.offset[..., :n] = self.centre, self.sphere, self.sphere
        self.outward[..., :n] = (sign * np.cos(angles))[:, :, None, None]
        self.upward[..., :n] = (-sign * np.sin(angles))[:, :, None, None]
        sine, cosine = sin(g.rib_normal_angle), cos(g.rib_normal_angle)
        self.large_station = g.sphere_centre - g.apex_to_mid - g.roller_mass_offset
        self.station[1, ..., n], self.radius[1, ..., n] = self.large_station, g.sphere_radius
        self.offset[1, ..., n] = g.sphere_radius - sine * g.rib_contact_radius - cosine * g.rib_contact_z
        self.outward[1, ..., n], self.upward[1, ..., n] = sine, cosine

    def _drop(self, station: Array) -> Array:
        p = self.p
        if p["profile"] == 0:
            return np.zeros_like(station)
        if p["profile"] == 1:
            return _core.law("profile_crowned", np.stack([station, np.full_like(station, p["crown_radius"])]))
        if p["profile"] == 3:
            of_iso = (p["profile_a"] * p["roller_diameter"], p["profile_c"], p["profile_d"], p["profile_k"])
            return _core.law("profile_iso", np.stack([station, *(np.full_like(station, x) for x in of_iso)]))
        names = ("effective_length", "profile_k1", "profile_k2", "profile_zm", "profile_load")
        numbers = [*(p[name] for name in names), self.g.effective_modulus]
        return _core.law("profile_logarithmic", np.stack([station, *(np.full_like(station, x) for x in numbers)]))

    def _exponents(self) -> None:
        """Logarithms of all powers are linear in (ln d, ln sliding, ln mean): a matrix and a constant for races and
        rib.
        """
        p, g, modulus = self.p, self.g, self.g.effective_modulus
        eta, tau = log(p["viscosity"]), log(p["eyring_stress"])
        log_g = log(p["pressure_coefficient"] * modulus)
        thermal = log(p["viscosity"] * p["temperature_coefficient"] / p["conductivity"])
        per_film = tau - eta + log(p["starvation_factor"])
        d, slide, mean = np.eye(4)[:3]
        one = np.eye(4)[3]

        def rows(load: Array, w: Array, u: Array, wide: Array, pressure: Array, top: Array, films: tuple[Array, Array],
                 mean_share: float, rolling: Array) -> Array:  # fmt: skip
            lt = thermal * one + 2.0 * mean
            bar = pressure + log(mean_share / PASCAL_PER_BAR) * one
            return np.stack([
                load,
                load - bar - slide + (tau - log(PASCAL_PER_BAR)) * one,
                rolling - mean,
                mean - wide + (eta - log(0.5 * p["shear_modulus_floor"])) * one,
                bar,
                films[0] + per_film * one,
                films[1] + per_film * one,
                log(13.2 / modulus) * one + top + 0.42 * lt,
                log(0.213) * one + 0.64 * lt,
                log(0.213 * 2.23) * one + 0.64 * lt + 0.83 * (slide - mean),
            ])  # fmt: skip

        # races: W = w/(E' Re), U = eta0 u/(E' Re)
        self.log_palmgren = log(0.356 * modulus) - log(p["effective_length"]) / 9.0
        races = np.empty((2, self.n_nodes, 10, 4))
        for index in np.ndindex(2, self.n_nodes):
            r = log(self.race_radius[index])
            line = self.log_palmgren * one + PALMGREN * d
            w, u = line - (log(modulus) + r) * one, mean + (eta - log(modulus) - r) * one
            pressure = 0.5 * (line + (log(modulus / (2.0 * pi)) - r) * one)
            races[index] = rows(
                line + log(self.weight[index[1]]) * one, w, u,
                0.5 * (line + (log(8.0 / (pi * modulus)) + r) * one), pressure, pressure,
                ((r + 1.0722683133285078 + 0.470 * log_g) * one - 0.166 * w + 0.692 * u, (r + log(4.9)) * one + u - w),
                pi / 4.0,
                (log(29.2 / p["pressure_coefficient"] * self.weight[index[1]]) + r + 0.648 * log_g) * one + 0.648 * u
                + 0.246 * w,
            )  # fmt: skip
        self.race_matrix = np.ascontiguousarray(races[0, 0, :, :3])
        self.constant = np.zeros((10, *self.station.shape))
        self.constant[..., : self.n_nodes] = np.moveaxis(races[..., 3], 2, 0)[:, :, None, None, :]

        # rib: W = Q/(E' Rx^2), U = eta0 u/(E' Rx)
        rx, ratio = log(g.rib_rx), g.rib_ry / g.rib_rx
        load = log(g.rib_stiffness) * one + 1.5 * d
        w, u = load - (log(modulus) + 2.0 * rx) * one, mean + (eta - log(modulus) - rx) * one
        shape = -np.expm1(-1.23 * ratio ** (2.0 / 3.0))
        phi = 1.0 / (1.0 + 2.0 / (3.0 * ratio))
        rigid = 128.0 * ratio * (phi * (0.131 * np.arctan(0.5 * ratio) + 1.683)) ** 2
        pressure = load / 3.0 + log(1.5 / (pi * g.rib_semi_axis_rolling * g.rib_semi_axis_across)) * one
        rib = rows(
            load, w, u, load / 3.0 + log(g.rib_semi_axis_rolling) * one, pressure, pressure,
            ((rx + log(4.31 * shape) + 0.49 * log_g) * one + 0.68 * u - 0.073 * w, (rx + log(rigid)) * one + 2.0 * (u - w)),
            2.0 / 3.0,
            -1e4 * one,
        )  # fmt: skip
        self.rib_change = rib[:, :3] - self.race_matrix
        self.constant[:, 1, ..., -1] = rib[:, 3][:, None, None]
        # film parameter = film row * this
        self.per_film = np.full(self.station.shape, p["viscosity"] / (p["eyring_stress"] * p["roughness_raceway"]))
        self.per_film[..., -1] *= p["roughness_raceway"] / p["roughness_rib"]
        self.least_film = p["lambda_full"] / self.per_film.min()
        self.dicke_a = p["dicke_a"] + p["dicke_b"] * p["temperature"]
        self.dicke_c = p["dicke_c"] + p["dicke_d"] * p["temperature"]
        # Dyson's modulus from its floor, in units of the half width of the floor's smoothing
        half = 0.5 * p["shear_modulus_floor"]
        self.shear_slope = 1.2 * PASCAL_PER_BAR / (2.52 + 0.024 * p["temperature"]) / half
        self.shear_offset = (1e8 + p["shear_modulus_floor"]) / half

    def _ribs(self) -> None:
        p, g = self.p, self.g
        heights = np.array([p["front_rib_low"], p["front_rib_high"]])
        along = g.apex_to_mid + g.small_end_station - p["front_rib_clearance"]
        below = (along * sin(g.roller_half_angle) - heights) / cos(g.roller_half_angle)
        sine, cosine = sin(g.roller_axis_angle), cos(g.roller_axis_angle)
        self.front_radius = (along * sine - below * cosine)[:, None, None]
        self.front_z = (along * cosine + below * sine)[:, None, None]
        self.small_end = g.small_end_station - g.roller_mass_offset
        # smallest speeds, (sliding, mean)
        self.guards = np.array([SLIDING_GUARD**2, p["speed_floor"] ** 2]).reshape(2, 1, 1, 1, 1)

    def _layout(self) -> None:
        """Rollers and the cage as bodies of eleven entries; the cage's turn is the twelfth of its own."""
        p, g, z = self.p, self.g, self.n_rollers
        self.n_state = 11 * z + 12
        cage = 11 * z + np.array([0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11])
        self.index = np.concatenate([11 * np.arange(z)[None, :] + np.arange(11)[:, None], cage[:, None]], axis=1)
        self.cage_turn = 11 * z + 5
        sine, cosine = sin(g.roller_axis_angle), cos(g.roller_axis_angle)
        orbit = self.frame_speed
        base = np.zeros((11, z + 1, 1))
        roller = base[:, :z, 0]
        roller[0], roller[1], roller[2] = g.roller_centre_radius, 2.0 * pi * np.arange(z) / z, g.roller_centre_height
        roller[4], roller[6] = g.roller_axis_angle, orbit * g.roller_centre_radius
        roller[8], roller[10] = -orbit * sine, orbit * cosine - g.roller_spin_ratio * self.shaft_speed
        base[2, z], base[10, z] = g.centre_plane + p["cage_offset"], orbit
        self.base = base

        def bodies(rollers: float, cage: float) -> Array:
            out = np.full((z + 1, 1), 1.0 / rollers)
            out[z] = 1.0 / cage
            return out

        self.per_mass = bodies(g.roller_mass, p["cage_mass"])
        self.per_transverse = bodies(g.roller_inertia_transverse, p["cage_inertia_transverse"])
        self.per_axial = bodies(g.roller_inertia_axial, p["cage_inertia_axial"])
        self.axial = 1.0 / self.per_axial
        self.transverse = 1.0 / self.per_transverse

    def _faces(self, rows: Array) -> None:
        p, g, z = self.p, self.g, self.n_rollers
        sine, cosine = sin(g.roller_axis_angle), cos(g.roller_axis_angle)
        angle = 2.0 * pi * np.arange(z) / z
        c, s, zero = np.cos(angle), np.sin(angle), np.zeros(z)
        # (roller, 1, component, axis): axes of the pockets in the cage
        self.pocket_axes = np.moveaxis(
            np.array([
                [cosine * c, -s, sine * c],
                [cosine * s, c, sine * s],
                [zero - sine, zero, zero + cosine],
            ]), 2, 0)[:, None]  # fmt: skip
        origin = np.stack([g.apex_to_mid * sine * c, g.apex_to_mid * sine * s, zero - p["cage_offset"]], axis=1)
        # pocket's origin from the cage's centre of mass, along the pocket's axes: (component, roller)
        self.pocket_origin = np.einsum("zbij,zi->jz", self.pocket_axes, origin)
        at, offsets = 0, {}
        for name, width, _, _ in _core.face_table():
            offsets[name] = slice(at, at + width)
            at += width
        column = {name: rows[:, where] for name, where in offsets.items()}
        self.face_origin, self.face_u, self.face_v = (column[name].T.copy() for name in ("origin", "u", "v"))
        self.face_normal = np.cross(self.face_u, self.face_v, axis=0)
        # (what, component, face): origin, u, v, normal
        self.face_vectors = np.stack([self.face_origin, self.face_u, self.face_v, self.face_normal])
        part, count = column["part"][:, 0].astype(int), column["n_vertices"][:, 0].astype(int)
        stiffness = column["stiffness_factor"][:, 0]
        self.face_friction = column["friction_factor"][:, 0]
        pocket = column["pocket"][:, 0].astype(int)
        belongs = (pocket[None, :] < 0) | (pocket[None, :] == np.arange(z)[:, None])
        # edges as (start, direction, 1/length^2); outlines with fewer repeat their first
        most = int(count.max())
        outline = column["outline"].reshape(len(rows), -1, 2)
        turn = np.where(np.arange(most)[None, :] < count[:, None], np.arange(most)[None, :], 0)
        start = np.take_along_axis(outline, turn[:, :, None], axis=1)
        end = np.take_along_axis(outline, ((turn + 1) % count[:, None])[:, :, None], axis=1)
        # (u or v, face, edge)
        self.edge_start, self.edge = np.moveaxis(start, 2, 0).copy(), np.moveaxis(end - start, 2, 0).copy()
        self.edge_per_square = 1.0 / (self.edge**2).sum(axis=0)

        # spheres that meet a face: nodes of the flank, and the large end: (roller, face, node)
        self.flank, self.large, self.small = (np.flatnonzero(part == kind) for kind in range(3))
        plane = (self.face_origin * self.face_normal).sum(axis=0)
        far = 1e3  # a face of another pocket is out of reach

        def reach(faces: NDArray[np.intp], radius: Array) -> Array:
            out: Array = plane[faces][None, :, None] + radius - np.where(belongs[:, faces], 0.0, far)[:, :, None]
            return out

        self.flank_reach = reach(self.flank, self.sphere)[:, None]
        self.large_reach = reach(self.large, np.full((1, 1, 1), g.sphere_radius))[:, None]
        self.flank_log_stiffness = (
            self.log_palmgren + np.log(self.weight)[None, :] + np.log(stiffness[self.flank])[:, None]
        )
        self.large_log_stiffness = np.log(p["end_stiffness"] * stiffness[self.large])
        # vertices of the small end's faces
        vertex = [(f, i) for f in self.small for i in range(count[f])]
        self.vertex_face = np.array([f for f, _ in vertex], dtype=int)
        self.vertex = np.array(
            [
                self.face_origin[:, f] + outline[f, i] @ np.stack([self.face_u[:, f], self.face_v[:, f]])
                for f, i in vertex
            ]
        ).reshape(-1, 3)
        self.vertex_log_stiffness = np.log(p["end_stiffness"] * stiffness[self.vertex_face] / count[self.vertex_face])
        self.vertex_off = np.where(belongs[:, self.vertex_face], self.small_end, far)[:, None]
