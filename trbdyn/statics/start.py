"""The state at which a run begins: rollers in equilibrium and in pure rolling, the cage at rest or whirling."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import InputError
from trbdyn.model.motion import value_at
from trbdyn.model.scene import Scene
from trbdyn.statics.cage_start import place_cage
from trbdyn.statics.equilibrium import Equilibrium, nominal_angles
from trbdyn.statics.free_ring import axis_of, put_axis
from trbdyn.statics.ring_motion import RingMotion
from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]


def start_state(model: _core.Model, scene: Scene, motion: RingMotion, equilibrium: Equilibrium) -> Array:
    """The state vector at the start, shape (n_state,)."""
    if scene.start.kind == "state":
        vector = np.array(scene.start.state_vector, dtype=np.float64)
        if vector.size != model.n_state:
            raise InputError.of(
                ("start", "state_vector"), f"{vector.size} numbers", f"must have {model.n_state} for this bearing"
            )
        if scene.effects.bodies == "rollers_and_spacer":
            _join_orbits(StateView(model.state_layout(), vector), scene)
        return vector
    vector = np.zeros(model.n_state)
    state = StateView(model.state_layout(), vector)
    geometry = scene.bearing.geometry
    orbit = _orbit(scene)
    radius, axial, tilt, skew = equilibrium.rollers.T
    angle = geometry.roller_axis_angle
    state["roller_r"], state["roller_z"], state["roller_tilt"], state["roller_skew"] = radius, axial, tilt, skew
    state["roller_psi"] = equilibrium.angles - nominal_angles(scene)
    # pure rolling: all velocities follow from the orbit, offsets are against the nominal place
    state["roller_v_t"] = orbit * radius
    state["roller_omega_n"] = -orbit * (np.sin(angle + tilt) - np.sin(angle))
    state["roller_omega_t"] = -orbit * np.sin(skew) * np.cos(angle + tilt)
    state["roller_omega_a"] = orbit * (np.cos(angle + tilt) * np.cos(skew) - np.cos(angle))
    if scene.effects.planar:
        state["roller_omega_n"] = 0.0
    if scene.ring_body is not None:
        place, turn = equilibrium.displacement[:3], equilibrium.displacement[3:]
        put_axis(state, place, axis_of(turn)[0], scene.ring_body.mass_offset)
    if scene.effects.bodies == "rollers_and_spacer":
        state["cage_psi"] = float(np.mean(state["roller_psi"]))
    if scene.effects.has_cage:
        place_cage(model, scene, motion, vector)
    if scene.start.slip > 0.0:
        _slow_down(state, scene)
    return vector


def _slow_down(state: StateView, scene: Scene) -> None:
    """Rollers and cage turn slower than in pure rolling by the start's slip, around the bearing and about their axes.

    Velocities of the state are offsets from those of the nominal place in pure rolling.
    """
    slip, orbit, geometry = scene.start.slip, _orbit(scene), scene.bearing.geometry
    inner, outer = (
        value_at(speed, scene.start.time) * math.pi / 30.0 for speed in (scene.speed_rpm, scene.outer_speed_rpm)
    )
    tilt, skew = state["roller_tilt"], state["roller_skew"]
    angle = geometry.roller_axis_angle + tilt
    state["roller_v_t"] -= slip * orbit * (geometry.roller_centre_radius + state["roller_r"])
    if not scene.effects.planar:
        state["roller_omega_n"] += slip * orbit * np.sin(angle)
    state["roller_omega_t"] *= 1.0 - slip
    spin = geometry.roller_spin_ratio * (inner - outer)
    state["roller_omega_a"] += slip * (spin - orbit * np.cos(angle) * np.cos(skew))
    if scene.effects.bodies != "rollers":
        state["cage_omega_a"] -= slip * orbit
    if scene.effects.has_cage:
        state["cage_v_x"] *= 1.0 - slip
        state["cage_v_y"] *= 1.0 - slip


def _orbit(scene: Scene) -> float:
    """Speed of the rollers' orbit in pure rolling at the start (rad/s)."""
    inner, outer = (
        value_at(speed, scene.start.time) * math.pi / 30.0 for speed in (scene.speed_rpm, scene.outer_speed_rpm)
    )
    return scene.bearing.geometry.cage_speed_ratio * (inner - outer) + outer


def _join_orbits(state: StateView, scene: Scene) -> None:
    """The spacer takes the mean place and all angular momentum of the orbits of a state in which rollers orbit alone."""
    if np.all(state["roller_psi"] == state["cage_psi"]):
        return
    geometry, cage = scene.bearing.geometry, scene.bearing.cage
    radius = geometry.roller_centre_radius + state["roller_r"]
    # offsets from pure rolling: of the tangential velocity against the nominal radius, of the spacer against its speed
    faster = state["roller_v_t"] - _orbit(scene) * state["roller_r"]
    momentum = geometry.roller_mass * np.sum(radius * faster) + cage.inertia_axial * state["cage_omega_a"]
    state["cage_omega_a"] = float(momentum) / (geometry.roller_mass * np.sum(radius**2) + cage.inertia_axial)
    state["cage_psi"] = float(np.mean(state["roller_psi"]))
