"""Where a run begins: the ring's static equilibrium at speed, rollers in pure rolling, the cage at rest or whirling."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError, LoadError
from trbdyn.flatten import equilibrium_times, motion_table, ring_load
from trbdyn.motion import value_at

if TYPE_CHECKING:
    from trbdyn import _core
    from trbdyn.scene import Scene

Array = NDArray[np.float64]

RESTING_AXIAL_SHARE = 0.1
"""Axial place of a cage at the start, in units of its axial play, from where the large ends of the rollers touch."""


@dataclass(frozen=True)
class Equilibrium:
    """Static equilibrium of ring and rollers at speed, without friction, gravity and cage.

    Attributes
    ----------
    displacement : ndarray, shape (5,)
        Inner ring: translation x, y, z (m), rotation about x, y (rad).
    angles : ndarray, shape (Z,)
        Orbit angles at which the rollers stand (rad).
    rollers : ndarray, shape (Z, 3)
        Offsets of each roller: radius, axial position (m), tilt (rad).
    outer_load, inner_load, rib_load : ndarray, shape (Z,)
        Normal loads (N).
    residual : float
        Largest force left unbalanced (N).
    iterations : int
        Steps of Newton's method.
    """

    displacement: Array
    angles: Array
    rollers: Array
    outer_load: Array
    inner_load: Array
    rib_load: Array
    residual: float
    iterations: int


def solve_equilibrium(model: _core.Model, scene: Scene, angles: Array, time: float = 0.0) -> Equilibrium:
    """Equilibrium of the ring under the scene's load at a time, with rollers at the given orbit angles.

    Raises
    ------
    LoadError
        If the bearing cannot carry the load.
    """
    from trbdyn import _core

    load = ring_load(scene, time)
    try:
        found = model.equilibrium(
            np.concatenate([load.force, load.moment]), load.fixed, load.displacement, load.shaft_speed, angles
        )
    except _core.CoreLoadError as error:
        raise LoadError(str(error)) from None
    outer, inner, rib = np.asarray(found["loads"]).T
    return Equilibrium(
        found["displacement"], angles, found["rollers"], outer, inner, rib, found["residual"], found["iterations"]
    )


def nominal_angles(scene: Scene) -> Array:
    """Evenly spaced orbit angles (rad), shape (Z,)."""
    count = scene.bearing.n_rollers
    return 2.0 * math.pi * np.arange(count) / count


def start_angles(scene: Scene) -> Array:
    """Orbit angles at which the rollers start (rad), shape (Z,)."""
    start, cage, even = scene.start, scene.bearing.cage, nominal_angles(scene)
    radius = 0.5 * scene.bearing.pitch_diameter
    if start.kind == "unequal":
        random = np.random.default_rng(start.seed)
        return even + start.spread * random.uniform(-1.0, 1.0, even.size) * cage.play_circumferential / radius
    if start.kind == "whirl":
        shift = start.eccentricity * cage.play_radial
        direction = math.radians(start.direction_deg)
        pocket = radius * np.exp(1j * even) + shift * np.exp(1j * direction)
        return even + np.angle(pocket * np.exp(-1j * even))
    return even


def ring_motion(model: _core.Model, scene: Scene) -> tuple[Array, Equilibrium]:
    """Prescribed motion of the ring as the core takes it, and the equilibrium at the start.

    A ring that follows its load goes through the equilibria of evenly spaced rollers.

    Raises
    ------
    LoadError
        If the bearing cannot carry the load.
    """
    times = equilibrium_times(scene)
    at_start = solve_equilibrium(model, scene, start_angles(scene), float(times[0]))
    if times.size == 1:
        return motion_table(scene, times, at_start.displacement[None, :]), at_start
    even = nominal_angles(scene)
    path = [solve_equilibrium(model, scene, even, float(time)).displacement for time in times]
    return motion_table(scene, times, np.array(path)), at_start


class StateView:
    """Parts of a state vector by name, as views: ``view["roller_r"]`` has shape (Z,), ``view["cage_x"]`` shape ().

    Parameters
    ----------
    model : _core.Model
        The model whose layout it follows.
    vector : ndarray, shape (n_state,)
        The vector; views write through to it.
    """

    def __init__(self, model: _core.Model, vector: Array) -> None:
        self._vector = vector
        self._layout = {name: (offset, shape) for name, offset, shape in model.state_layout()}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parts."""
        return tuple(self._layout)

    def __getitem__(self, name: str) -> Array:
        offset, shape = self._layout[name]
        if len(shape) == 2:
            count, stride = shape
            return self._vector[offset : offset + count * stride : stride]
        return self._vector[offset : offset + (shape[0] if shape else 1)].reshape(shape)

    def __setitem__(self, name: str, value: Array | float) -> None:
        self[name][...] = value


def start_state(model: _core.Model, scene: Scene, motion: Array, equilibrium: Equilibrium) -> Array:
    """The state vector at the start, shape (n_state,).

    Raises
    ------
    InputError
        If a saved state does not fit the scene.
    """
    if scene.start.kind == "state":
        vector = np.array(scene.start.state_vector, dtype=np.float64)
        if vector.size != model.n_state:
            raise InputError.of(
                ("start", "state_vector"), f"{vector.size} numbers", f"must have {model.n_state} for this bearing"
            )
        return vector
    vector = np.zeros(model.n_state)
    state = StateView(model, vector)
    geometry = scene.bearing.geometry
    speed = value_at(scene.speed_rpm, scene.start.time) * math.pi / 30.0
    orbit = geometry.cage_speed_ratio * speed
    radius, axial, tilt = equilibrium.rollers.T
    angle = geometry.roller_axis_angle
    state["roller_r"], state["roller_z"], state["roller_tilt"] = radius, axial, tilt
    state["roller_psi"] = equilibrium.angles - nominal_angles(scene)
    # pure rolling: all velocities follow from the orbit, offsets are against the nominal place
    state["roller_v_t"] = orbit * radius
    state["roller_omega_n"] = -orbit * (np.sin(angle + tilt) - np.sin(angle))
    state["roller_omega_a"] = orbit * (np.cos(angle + tilt) - np.cos(angle))
    if scene.effects.planar:
        state["roller_omega_n"] = 0.0
    if scene.effects.bodies == "rollers_and_cage":
        _place_cage(model, scene, motion, state, vector, orbit)
    return vector


def _place_cage(model: _core.Model, scene: Scene, motion: Array, state: StateView, vector: Array, orbit: float) -> None:
    start, cage = scene.start, scene.bearing.cage
    # the heaviest loads push rollers along the axis by more than the play of their pockets: the cage goes with them
    rest, rollers = RESTING_AXIAL_SHARE * cage.play_axial, float(np.mean(state["roller_z"]))
    state["cage_z"] = min(max(rest, rollers + rest), rollers + cage.play_axial - rest)
    if start.kind == "whirl":
        direction = math.radians(start.direction_deg)
        x, y = (start.eccentricity * cage.play_radial * part for part in (math.cos(direction), math.sin(direction)))
        state["cage_x"], state["cage_y"] = x, y
        state["cage_v_x"], state["cage_v_y"] = -orbit * y, orbit * x
        return
    gravity = np.array([value_at(part, start.time) for part in scene.gravity[:2]])
    size = float(np.hypot(*gravity))
    if scene.effects.gravity and size > 0.0:
        _lay_down(model, motion, state, vector, gravity / size, cage.play_radial)


def _lay_down(
    model: _core.Model, motion: Array, state: StateView, vector: Array, direction: Array, play: float
) -> None:
    """Move the cage along a direction until a face touches, by bisection on the smallest gap."""
    from trbdyn import _core

    onlooker = _core.Simulation(model, motion, float(motion[0, 0]), vector, {})

    def touches(distance: float) -> bool:
        state["cage_x"], state["cage_y"] = distance * direction
        found = onlooker.contacts(float(motion[0, 0]), vector)
        return float(np.max(found["pocket_interference"])) > 0.0

    low, high = 0.0, 4.0 * play
    if touches(low) or not touches(high):
        state["cage_x"], state["cage_y"] = 0.0, 0.0
        return
    while high - low > 1e-10:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if touches(middle) else (middle, high)
    state["cage_x"], state["cage_y"] = low * direction
