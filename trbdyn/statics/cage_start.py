"""Where the cage begins: with the rollers that carry, whirling or lying on its rollers, pressed into none of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.model.motion import value_at
from trbdyn.model.scene import Scene
from trbdyn.statics.ring_motion import RingMotion
from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]

RESTING_AXIAL_SHARE: Final = 0.1
"""Axial place of a cage at the start, in units of its axial play, from where the large ends of the rollers touch."""
PRESSED: Final = 1e-7
"""Interference with a pocket from which on room is looked for (m)."""
RESTING_FILM: Final = 0.5
"""Gap over the clearance at which a cage begins on the oil film of a land, when gravity draws it there."""
STRONGLY_PRESSED: Final = 2e-6
"""Interference with a pocket at the start that is worth a warning (m)."""


def place_cage(model: _core.Model, scene: Scene, motion: RingMotion, vector: Array) -> None:
    """Put the cage where a run begins, and rollers that carry nothing into their pockets; the state has all rollers' places."""
    state, start, cage = StateView(model.state_layout(), vector), scene.start, scene.bearing.cage
    orbit = scene.orbit_speed(start.time)
    onlooker = motion.open(model, motion.start, vector)
    load = _inner_load(onlooker, motion.start, vector)
    # the heaviest loads push rollers along the axis by more than the play of their pockets: the cage goes with those that
    # carry, and takes along the cup the others that it would otherwise push into, but for those that would meet the inner ring
    rest, held = RESTING_AXIAL_SHARE * cage.play_axial, load > 0.0
    rollers = float(np.average(state["roller_z"], weights=load if held.any() else np.ones(held.size)))
    state["cage_z"] = cage_z = min(max(rest, rollers + rest), rollers + cage.play_axial - rest)
    taken = np.clip(state["roller_z"], cage_z - cage.play_axial + rest, cage_z - rest) - state["roller_z"]
    taken[held] = 0.0
    slope = math.tan(math.radians(scene.bearing.cup_half_angle_deg))
    state["roller_z"] += taken
    state["roller_r"] += slope * taken
    back = np.where((_inner_load(onlooker, motion.start, vector) > 0.0) & ~held, taken, 0.0)
    state["roller_z"] -= back
    state["roller_r"] -= slope * back
    state["roller_v_t"] += orbit * slope * (taken - back)
    gravity = np.array([value_at(part, start.time) for part in scene.gravity[:2]])
    size = float(np.hypot(*gravity))

    land = scene.bearing.land
    thinnest = RESTING_FILM * land.clearance if scene.effects.films and land.fill > 0.0 else land.contact_film

    def depths(gap: float = land.contact_film) -> Array:
        return _depths(onlooker, scene, motion.start, vector, gap)

    if start.kind == "whirl":
        direction = math.radians(start.direction_deg)
        state["cage_x"], state["cage_y"] = (
            start.eccentricity * cage.play_radial * part for part in (math.cos(direction), math.sin(direction))
        )
    elif scene.effects.gravity and size > 0.0:
        _lay_down(lambda: depths(thinnest), state, gravity / size, cage.play_radial)
    # a cage that whirls stays at the eccentricity that was asked for
    ways = ("cage_z",) if start.kind == "whirl" else ("cage_x", "cage_y", "cage_z")
    _make_room(depths, state, cage.play_radial, ways)
    if start.kind == "whirl":
        state["cage_v_x"], state["cage_v_y"] = -orbit * state["cage_y"], orbit * state["cage_x"]


def pressed_rollers(model: _core.Model, scene: Scene, motion: RingMotion, vector: Array) -> str:
    """A sentence if the start presses rollers into their pockets, or the cage into its land, as they were moved further than
    the play allows; or nothing.
    """
    if not scene.effects.has_cage or scene.start.kind == "state":
        return ""
    onlooker = motion.open(model, motion.start, vector)
    depth = _interference(onlooker, motion.start, vector)
    worst, roller = float(depth.max()), int(np.argmax(depth.max(axis=1)))
    if not worst > STRONGLY_PRESSED:
        return _pressed_land(scene, onlooker, motion.start, vector)
    cause = "load and displacement of the rings move the rollers further than the play of the pockets lets a stiff cage follow"
    if scene.start.kind == "whirl":
        cause = f"start.eccentricity = {scene.start.eccentricity:g} takes the cage further than these rollers allow, or {cause}"
    return f"at the start roller {roller} is pressed {1e6 * worst:.3g} um into its pocket: {cause}; the run begins with a blow"


def _pressed_land(scene: Scene, onlooker: _core.Simulation, time: float, vector: Array) -> str:
    """A sentence if the start presses the cage into the land that guides it, or nothing."""
    if scene.effects.guidance == "rollers":
        return ""
    depth = scene.bearing.land.contact_film - float(onlooker.contacts(time, vector)["land_gap"])
    if not depth > STRONGLY_PRESSED:
        return ""
    return (
        f"at the start the cage is pressed {1e6 * depth:.3g} um into the land that guides it: its rollers or start.eccentricity "
        f"hold it further from the land's axis than bearing.land.clearance = {scene.bearing.land.clearance:g} m allows; "
        "the run begins with a blow"
    )


def _inner_load(onlooker: _core.Simulation, time: float, vector: Array) -> Array:
    return np.asarray(onlooker.contacts(time, vector)["raceway_load"])[1].sum(axis=-1)


def _interference(onlooker: _core.Simulation, time: float, vector: Array) -> Array:
    return np.asarray(onlooker.contacts(time, vector)["pocket_interference"])


def _depths(onlooker: _core.Simulation, scene: Scene, time: float, vector: Array, gap: float) -> Array:
    """Interferences of the cage with its rollers, and, where a land guides it, by how much its gap there is below one (m)."""
    found = onlooker.contacts(time, vector)
    depths = np.asarray(found["pocket_interference"]).ravel()
    if scene.effects.guidance == "rollers":
        return depths
    return np.append(depths, gap - float(found["land_gap"]))


def _lay_down(depths: Callable[[], Array], state: StateView, direction: Array, play: float) -> None:
    """Move the cage along a direction until it touches, by bisection on the smallest gap."""

    def touches(distance: float) -> bool:
        state["cage_x"], state["cage_y"] = distance * direction
        return float(np.max(depths())) > 0.0

    low, high = 0.0, 4.0 * play
    if touches(low) or not touches(high):
        state["cage_x"], state["cage_y"] = 0.0, 0.0
        return
    while high - low > 1e-10:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if touches(middle) else (middle, high)
    state["cage_x"], state["cage_y"] = low * direction


def _make_room(depths: Callable[[], Array], state: StateView, play: float, ways: tuple[str, ...]) -> None:
    """Move a cage that is pressed into its rollers or its land along some of its coordinates to where the squares of all
    interferences are least.
    """
    begin = np.array([float(state[name]) for name in ways])

    def pressed(place: Array) -> Array:
        for name, value in zip(ways, begin + play * place, strict=True):
            state[name] = value
        return np.maximum(depths(), 0.0) / play

    still = np.zeros(len(ways))
    first = pressed(still)
    if float(first.max()) * play <= PRESSED:
        return
    from scipy.optimize import least_squares  # takes a third of a second to import, and few cages are pressed

    found = least_squares(pressed, still, diff_step=1e-4, x_scale=0.1)
    if not float(pressed(found.x).max()) < float(first.max()):
        pressed(still)
