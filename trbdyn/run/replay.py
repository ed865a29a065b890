"""Any record of a result, evaluated again by the core: every quantity of every contact, along the rollers too.

A result keeps one number for each contact (its load, its largest pressure). The state of a record follows from the recorded
motion, and from the state the core gives everything again: pressure, film and slip at every node along a roller.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.extras import of_extras
from trbdyn.errors import InputError
from trbdyn.model import contact_line
from trbdyn.model.motion import value_at
from trbdyn.model.shaft import angle_turned
from trbdyn.run.simulation import Simulation
from trbdyn.statics.free_ring import put_axis, turn_of
from trbdyn.statics.ring_motion import RingMotion
from trbdyn.statics.state_view import StateView

if TYPE_CHECKING:
    from trbdyn.model.ring_body import MovingBody
    from trbdyn.results.result import Result

Array = NDArray[np.float64]

NEEDED = ("cage", "rollers")
"""Groups of fields that a state is made of."""


class Replay:
    """Evaluates records of a result again.

    Parameters
    ----------
    result : Result
        Needs the groups time, cage and rollers, the group ring where the ring is free or sits on a shaft with other bearings,
        and the group housing where the outer ring moves with a housing.

    Raises
    ------
    InputError
        If a group was not recorded.
    """

    def __init__(self, result: Result) -> None:
        self._on_shaft = result.on_shaft
        moving = (*(("ring",) if result.ring_moves else ()), *(("housing",) if result.housing_moves else ()))
        for group in (*NEEDED, *moving):
            if group not in result.groups:
                raise InputError.of(
                    "result", f"groups {', '.join(result.groups)}", f"must have the recorded group {group!r}"
                )
        self.result = result
        self._simulation = Simulation(result.scene)
        geometry = result.scene.bearing.geometry
        self._geometry = geometry
        count = result.scene.bearing.n_rollers
        self._even = 2.0 * np.pi * np.arange(count) / count

    @property
    def stations(self) -> Array:
        """Places of the nodes along the effective length, from its middle towards the large end (m), shape (n,)."""
        return contact_line.stations(self.result.scene)

    def state(self, index: int) -> Array:
        """The core's state vector at a record, shape (n_state,); energies are zero, nothing depends on them.

        Parameters
        ----------
        index : int
            Number of the record.
        """
        result, geometry = self.result, self._geometry
        vector = np.zeros(self._simulation.state.vector.size)
        view = self._simulation.view(vector)
        shaft_angle, shaft_speed = self._prescribed(index)
        outer_angle, outer_speed = self._outer(index)
        frame = geometry.cage_speed_ratio * (shaft_angle - outer_angle) + outer_angle
        orbit = geometry.cage_speed_ratio * (shaft_speed - outer_speed) + outer_speed
        nominal = geometry.roller_axis_angle

        angle, skew, tilt = (result[f"roller_{name}"][index] for name in ("orbit_angle", "skew", "tilt"))
        position, velocity = result["roller_position"][index], result["roller_velocity"][index]
        view["roller_psi"] = angle - frame - self._even
        view["roller_r"] = np.hypot(position[:, 0], position[:, 1]) - geometry.roller_centre_radius
        view["roller_z"] = position[:, 2] - geometry.roller_centre_height
        view["roller_skew"], view["roller_tilt"] = skew, tilt
        own = _in_orbit(velocity, angle)
        view["roller_v_r"], view["roller_v_z"] = own[:, 0], own[:, 2]
        view["roller_v_t"] = own[:, 1] - orbit * geometry.roller_centre_radius
        spin = _in_frame(_in_orbit(result["roller_angular_velocity"][index], angle), skew, nominal + tilt)
        view["roller_omega_n"] = spin[:, 0] + orbit * np.sin(nominal)
        view["roller_omega_t"] = spin[:, 1]
        view["roller_omega_a"] = spin[:, 2] - (
            orbit * np.cos(nominal) - geometry.roller_spin_ratio * (shaft_speed - outer_speed)
        )
        own = _in_frame(_in_orbit(_first_axes(result["roller_orientation"][index]), angle), skew, nominal + tilt)
        kinematic = -geometry.roller_spin_ratio * (shaft_angle - outer_angle)
        view["spin_angle"] = np.arctan2(own[:, 1], own[:, 0]) - kinematic
        if result.has_cage:
            self._put_cage(view, index, frame, orbit)
        if result.scene.ring_body is not None:
            angle, speed = self._prescribed(index)
            self._put_ring(view, index, result.scene.ring_body, "inner_ring", "ring", speed)
            view["inner_ring_psi"] = float(result["shaft_angle"][index]) - angle
        if result.scene.housing is not None:
            self._put_ring(view, index, result.scene.housing, "outer_ring", "housing", outer_speed)
        return vector

    def _put_cage(self, view: object, index: int, frame: float, orbit: float) -> None:
        result, offset = self.result, self.result.scene.bearing.cage.offset
        axis = _third_axis(result["cage_orientation"][index])
        place = result["cage_position"][index] + offset * axis - np.array([0.0, 0.0, offset])
        turned = np.array([frame])
        place, axis, velocity, spin = (
            _in_orbit(vector[None, :], turned)[0]
            for vector in (place, axis, result["cage_velocity"][index], result["cage_angular_velocity"][index])
        )
        skew, tilt = np.arcsin(np.clip(axis[1], -1.0, 1.0)), np.arctan2(axis[0], axis[2])
        spin = _in_frame(spin[None, :], np.array([skew]), np.array([tilt]))[0]
        values = {
            **dict(zip("xyz", place, strict=True)),
            "skew": skew,
            "tilt": tilt,
            "psi": result["cage_angle"][index] - frame,
            **dict(zip(("v_x", "v_y", "v_z"), velocity, strict=True)),
            **dict(zip(("omega_n", "omega_t"), spin[:2], strict=True)),
            "omega_a": spin[2] - orbit,
        }
        for name, value in values.items():
            view[f"cage_{name}"] = value  # type: ignore[index]
        if result.scene.elastic_cage is not None:
            speeds = 2.0 * np.pi * of_extras("cage_modes")(result.scene).frequency
            scale = np.maximum(speeds, _core.least_mode_frequency)
            rates = scale / speeds * result["cage_mode_rate"][index]
            for mode, (amplitude, rate) in enumerate(zip(scale * result["cage_mode"][index], rates, strict=True)):
                view[f"cage_q{mode}"], view[f"cage_p{mode}"] = amplitude, rate  # type: ignore[index]

    def _put_ring(self, view: StateView, index: int, body: MovingBody, ring: str, group: str, speed: float) -> None:
        """Put a ring that moves, from its group of the result; speed: what is prescribed about its axis (rad/s)."""
        result = self.result
        turn_x, turn_y = result[f"{group}_tilt"][index]
        axis = np.array([np.tan(turn_y), -np.tan(turn_x), 1.0])
        axis /= np.linalg.norm(axis)
        put_axis(view, result[f"{group}_position"][index], axis, body.mass_offset, ring)
        spin, arm = result[f"{group}_angular_velocity"][index], body.mass_offset * axis
        for name, value in zip("xyz", result[f"{group}_velocity"][index] + np.cross(spin, arm), strict=True):
            view[f"{ring}_v_{name}"] = value
        own = _in_frame(spin[None, :], *(np.array([float(view[f"{ring}_{name}"])]) for name in ("skew", "tilt")))[0]
        for name, value in zip(("omega_n", "omega_t", "omega_a"), (*own[:2], own[2] - speed), strict=True):
            view[f"{ring}_{name}"] = value

    def _prescribed(self, index: int) -> tuple[float, float]:
        """Angle (rad) and speed (rad/s) that count as pure rolling: those of the shaft, unless a torque turns it."""
        result, scene = self.result, self.result.scene
        if scene.torque is None:
            return float(result["shaft_angle"][index]), float(result["shaft_speed"][index])
        time = float(result["time"][index])
        return scene.start_shaft_angle + scene.shaft_turn(time), value_at(scene.speed_rpm, time) * np.pi / 30.0

    def _outer(self, index: int) -> tuple[float, float]:
        """Angle (rad) and speed (rad/s) of the outer ring."""
        scene, time = self.result.scene, float(self.result["time"][index])
        if not scene.outer_turns:
            return 0.0, 0.0
        turned = angle_turned(scene.outer_speed_rpm, 0.0, time)
        return turned, value_at(scene.outer_speed_rpm, time) * np.pi / 30.0

    def contacts(self, index: int) -> dict[str, Array]:
        """Every quantity of every contact at a record; names, shapes and units as in `Simulation.contacts`.

        Parameters
        ----------
        index : int
            Number of the record.
        """
        time, state = float(self.result["time"][index]), self.state(index)
        return self._place(index).contacts(time, state) if self._on_shaft else self._simulation.contacts(state, time)

    def _place(self, index: int) -> _core.Simulation:
        """The core with the ring where the shaft, which other bearings carry as well, had it at a record."""
        result, time = self.result, float(self.result["time"][index])
        angle, speed = self._prescribed(index)
        outer_angle, outer_speed = self._outer(index)
        turn_x, turn_y = result["ring_tilt"][index]
        axis = np.array([np.tan(turn_y), -np.tan(turn_x), 1.0])
        axis /= np.linalg.norm(axis)
        spin = result["ring_angular_velocity"][index]
        values = {"shaft_speed": (speed, 0.0), "outer_speed": (outer_speed, 0.0)}
        leaning = spin - (spin @ axis) * axis  # rates of small rotations, to the square of the rotation
        for name, *both in zip("xyz", result["ring_position"][index], result["ring_velocity"][index], strict=True):
            values[f"displacement_{name}"] = (both[0], both[1])
        for name, *both in zip("xy", turn_of(axis), leaning[:2], strict=True):
            values[f"rotation_{name}"] = (both[0], both[1])
        channels = [values.get(name, (0.0, 0.0)) for name, _, _ in _core.motion_table()]
        table = np.array([[time, *(number for channel in channels for number in channel), 0.0]])
        motion = RingMotion(table, 0.0, time, time, angle, outer_angle)
        return motion.open(self._simulation.bearings[0].model, time, self.state(index))

    def record(self, index: int) -> dict[str, Array]:
        """A record, evaluated again: what was recorded, to rounding, but for spin angles and energies."""
        time, state = float(self.result["time"][index]), self.state(index)
        if not self._on_shaft:
            return self._simulation.record(state, time)
        row, layout = self._place(index).observe(time, state), self._simulation.bearings[0].model.record_layout()
        return {name: row[offset : offset + math.prod(shape)].reshape(shape) for name, offset, shape in layout}


def _in_orbit(vectors: Array, angles: Array) -> Array:
    """Inertial vectors, shape (n, 3), in cylindrical frames at these angles, shape (n,)."""
    cosine, sine = np.cos(angles), np.sin(angles)
    x, y, z = vectors.T
    return np.stack([cosine * x + sine * y, cosine * y - sine * x, np.broadcast_to(z, x.shape)], axis=-1)


def _in_frame(vectors: Array, skew: Array, tilt: Array) -> Array:
    """Vectors, shape (n, 3), along the axes n, t, a of the frames R_y(tilt) R_x(-skew)."""
    cs, ss, ct, st = np.cos(skew), np.sin(skew), np.cos(tilt), np.sin(tilt)
    zero = np.zeros_like(ct)
    axes = np.array([[ct, zero, -st], [-ss * st, cs + zero, -ss * ct], [cs * st, ss + zero, cs * ct]])
    return np.einsum("ijn,nj->ni", axes, vectors)


def _first_axes(quaternions: Array) -> Array:
    """The x axis turned by quaternions (w, x, y, z), shape (n, 4); shape (n, 3)."""
    w, x, y, z = quaternions.T
    return np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=-1)


def _third_axis(quaternion: Array) -> Array:
    """The z axis turned by a quaternion (w, x, y, z)."""
    w, x, y, z = quaternion
    return np.array([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])
