"""One bearing alone, or bearings that sit on one shaft: where their rings stand, and what the core takes of them.

The shaft has axes of its own (docs/theory/motion.md#bearings-on-one-shaft): z along it, x and y across. A bearing whose rollers'
large ends point along the shaft's z has the same axes. One that sits the other way round has axes that are turned by half a turn
about x: its z, along which its large ends point, is against that of the shaft, its speed and its y have the other sign. Each
bearing is described by a scene of its own, in its own axes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import InputError
from trbdyn.model.core_table import PARAMETERS
from trbdyn.model.flatten import (
    HOUSING_LOADS,
    Entry,
    Load,
    block_of,
    load_channels,
    loads_period,
    motion_table,
    named_entries,
    scaled,
    scene_entries,
)
from trbdyn.model.motion import History
from trbdyn.model.ring_body import RingBody
from trbdyn.model.scene import Scene
from trbdyn.statics.cage_start import pressed_rollers
from trbdyn.statics.core_model import build_model, model_of
from trbdyn.statics.equilibrium import Equilibrium
from trbdyn.statics.free_ring import ALONG, axis_of, put_axis, turn_of
from trbdyn.statics.plausible import unusual
from trbdyn.statics.ring_motion import RingMotion, housing_hold, open_core, placed_again, ring_motion
from trbdyn.statics.start import start_state
from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]

KEPT: Final = 4
"""Equilibria of the start that are kept."""
Layout = list[tuple[str, int, tuple[int, ...]]]


@dataclass(frozen=True)
class Seat:
    """A bearing on a shaft."""

    scene: Scene
    """The bearing, its oil, effects and start, in its own axes; its ring is held. Its displacement and misalignment
    are where the ring stands at the start, see `Seat.at`."""
    mass_offset: float
    """Axial position of the shaft's centre of mass from the bearing's roller-centre plane, along the bearing's own
    z (m)."""
    turned: bool = False  # whether the bearing sits on the shaft the other way round
    shift: float = 0.0
    """Axial displacement of the ring, along the bearing's own z, where the shaft stands at zero (m): negative is
    preload, positive end play."""

    def axes(self, vector: Array) -> Array:
        """A vector of the shaft's axes in those of the bearing, or back."""
        return vector * np.array([1.0, -1.0, -1.0]) if self.turned else vector

    def of_shaft(self, quantity: float | History) -> float | History:
        """What goes along or about the shaft's y or z, such as its speed, in the axes of the bearing."""
        return scaled(quantity, -1.0) if self.turned else quantity

    def numbers(self) -> dict[str, float | bool]:
        """Where it sits, as results keep it."""
        return {"mass_offset": self.mass_offset, "turned": self.turned, "shift": self.shift}

    def ring_place(self, shaft: Array) -> Array:
        """Where the ring stands at its roller-centre plane, in the bearing's axes, with the displacement of the shaft's centre
        of mass (m) and its rotation about x and y (rad), in the shaft's axes; both of shape (5,).
        """
        axis = self.axes(axis_of(shaft[3:])[0])
        if self.turned:
            axis = -axis
        place = self.axes(shaft[:3]) + self.shift * ALONG - self.mass_offset * (axis - ALONG)
        return np.concatenate([place, turn_of(axis)])

    def at(self, shaft: Array) -> Seat:
        """The seat with its ring where the shaft puts it."""
        x, y, z, turn_x, turn_y = (float(value) for value in self.ring_place(shaft))
        values = {"displacement": (x, y, z), "misalignment_x": turn_x, "misalignment_y": turn_y}
        scene = self.scene.replace(
            ring="held", ring_body=None, axial_load=0.0, radial_load=0.0, unloaded="refused", **values
        )
        return Seat(scene, self.mass_offset, self.turned, self.shift)


@dataclass(frozen=True)
class Seating:
    """Bearings on a shaft at the start, and what acts on it."""

    seats: Mapping[str, Seat]  # the bearings by name. The first one must not be turned: its axes are those of the shaft
    body: RingBody
    """Mass, moments of inertia, unbalance, dampers and supports of the shaft with all that is fixed to it. The
    seats say where its centre of mass lies."""
    shaft: Array  # displacement of its centre of mass (m), and rotation about x and y (rad), shape (5,)
    loads: Mapping[str, Load] = field(default_factory=dict)
    """What acts on the shaft at the first bearing's roller-centre plane, by the names of the core's channels:
    ``"force_x"``, ``"moment_y"`` and so on (N, N m); what is not named is zero. With a ``"torque"`` (N m) the shaft
    turns under it, in place of the prescribed speed."""
    one_housing: bool = False
    """Whether all outer rings sit in one housing, which the scene of each bearing has in its own axes, and not each
    in its own."""

    @property
    def torque(self) -> Load | None:
        """Torque that drives the shaft (N m), in place of the prescribed speed."""
        return self.loads.get("torque")

    @property
    def turning_rpm(self) -> float | History:
        """The speed by which turns are counted (rpm)."""
        return next(iter(self.seats.values())).scene.turning_rpm


@dataclass(frozen=True)
class SeatedBearing:
    """What the core takes of a bearing."""

    name: str  # its name; none where it is simulated alone
    number: int  # its place among the bearings
    scene: Scene  # the bearing, its oil, effects and start, in its own axes
    model: _core.Model  # its model; the first bearing of a shaft has the shaft
    motion: RingMotion  # what is prescribed
    equilibrium: Equilibrium  # rollers and ring at the start
    layout: Layout  # where the parts of its state lie in the state of the whole
    unusual: tuple[str, ...]  # what can hardly be meant in its scene
    first: int = 0  # where its quantities begin in a row of the core, without peaks
    seat: Seat | None = None  # where it sits on a shaft

    @property
    def said(self) -> str:
        """Its name before a sentence that concerns it."""
        return f"{self.name}: " if self.name else ""

    @property
    def record_layout(self) -> Layout:
        """Where its quantities lie in a row of the core, without peaks."""
        return [(name, at + self.first, shape) for name, at, shape in self.model.record_layout()]

    def view(self, vector: Array) -> StateView:
        """Its part of the state of the whole, by name."""
        return StateView(self.layout, vector)


@dataclass(frozen=True)
class Seated:
    """What the core takes of one bearing, or of several on one shaft."""

    bearings: tuple[SeatedBearing, ...]
    vector: Array  # the state at the start
    time: float  # of the start (s)

    @property
    def moves(self) -> bool:
        """Whether anything that is prescribed changes in time."""
        return any(len(one.motion.table) > 1 for one in self.bearings)

    def open(self, time: float, vector: Array, settings: dict[str, float | str]) -> _core.Simulation:
        """The core's simulation from a time (s) and state on; `InputError` if it cannot use the state or the settings."""
        models, motions = [one.model for one in self.bearings], [one.motion for one in self.bearings]
        return open_core(models, motions, time, vector, settings)


def seat_alone(scene: Scene, instruction_set: str = "") -> Seated:
    """What the core takes of one bearing: its ring is held, follows its load, or is free. The latest ones are kept, as a run, its
    summary and its check begin in one equilibrium; not where a file is read, which may change.
    """
    if scene.modes_from_file:
        return _seat_alone(scene, instruction_set)
    return apart(_kept_alone(scene, instruction_set))


def apart(kept: Seated) -> Seated:
    """The same with arrays of its own for what a simulation shows of its start."""
    bearings = tuple(replace(one, equilibrium=deepcopy(one.equilibrium)) for one in kept.bearings)
    return replace(kept, bearings=bearings, vector=kept.vector.copy())


def _seat_alone(scene: Scene, instruction_set: str) -> Seated:
    model = build_model(scene, instruction_set)
    motion, equilibrium = ring_motion(model, scene)
    vector = start_state(model, scene, motion, equilibrium)
    said = (pressed_rollers(model, scene, motion, vector), placed_again(model, scene, motion))
    unusual_there = (*unusual(scene, equilibrium), *(text for text in said if text))
    bearing = SeatedBearing("", 0, scene, model, motion, equilibrium, model.state_layout(), unusual_there)
    return Seated((bearing,), vector, scene.start.time)


_kept_alone = lru_cache(maxsize=KEPT)(_seat_alone)


def seat_all(seating: Seating, instruction_set: str = "") -> Seated:
    """What the core takes of bearings on a shaft that stands still at a place."""
    seats, body, shaft, loads = list(seating.seats.values()), seating.body, seating.shaft, seating.loads
    _check(seats, body, loads)
    placed = [seat.at(shaft) for seat in seats]
    # the first bearing has the housing that is around all
    shared = [seating.one_housing and number > 0 for number in range(len(seats))]
    scenes = [one.scene.replace(housing=None) if of else one.scene for one, of in zip(placed, shared, strict=True)]
    held = [build_model(scene, instruction_set) for scene in scenes]
    found = [ring_motion(model, scene) for model, scene in zip(held, scenes, strict=True)]
    motions = [motion for motion, _ in found]
    hold = housing_hold(placed[0].scene, found[0][1])
    if seating.one_housing:
        hold = _of_all(hold, placed, [equilibrium for _, equilibrium in found])
    motions[0] = _with_loads(motions[0], placed[0].scene, {**loads, **hold})
    free = 2.0 if "torque" in loads else 1.0
    models = tuple(
        _model(seat, body, number, free, shared[number], instruction_set) for number, seat in enumerate(placed)
    )
    size, layouts = _core.state_layouts(models)
    vector, bearings, first = np.zeros(size), [], 0
    for number, name in enumerate(seating.seats):
        seat, (alone_motion, equilibrium), layout = placed[number], found[number], layouts[number]
        alone = start_state(held[number], scenes[number], alone_motion, equilibrium)
        pressed = pressed_rollers(held[number], scenes[number], alone_motion, alone)
        said = (*unusual(seat.scene, equilibrium), *((pressed,) if pressed else ()))
        own, whole = StateView(held[number].state_layout(), alone), StateView(layout, vector)
        for entry in own.names:
            if entry != "quadratures":
                whole[entry] = own[entry]
        bearings.append(
            SeatedBearing(
                name, number, seat.scene, models[number], motions[number], equilibrium, layout, said, first, seat
            )
        )
        first += models[number].record_length
    put_axis(StateView(layouts[0], vector), shaft[:3], axis_of(shaft[3:])[0], 0.0)
    return Seated(tuple(bearings), vector, seats[0].scene.start.time)


def _check(seats: Sequence[Seat], body: RingBody, loads: Mapping[str, Load]) -> None:
    """Refuse what no shaft can do, or what would not act."""
    first = seats[0]
    if first.turned:
        raise InputError.of(("seats", 0, "turned"), True, "must be False: the first bearing has the shaft's axes")
    if body.mass_offset != 0.0:
        raise InputError.of(
            ("body", "mass_offset"), body.mass_offset, "must be 0: each seat has its own mass_offset (m)"
        )
    if body.unbalance > 0.0 and "torque" in loads:
        limit = "must be 0 together with a torque: its effect on the speed is not simulated (kg m)"
        raise InputError.of(("body", "unbalance"), body.unbalance, limit)
    for name in loads:
        if name not in load_channels():
            raise InputError.of(("loads", name), loads[name], f"must be one of {', '.join(load_channels())}")
    for number, seat in enumerate(seats):
        start = seat.scene.start
        if start.kind == "state":
            limit = "must not be 'state': the state of a bearing alone holds nothing of the shaft"
            raise InputError.of(("seats", number, "scene", "start", "kind"), "state", limit)
        for name, own, needed in (
            ("speed_rpm", seat.scene.speed_rpm, seat.of_shaft(first.scene.speed_rpm)),
            ("gravity", seat.scene.gravity, (first.scene.gravity[0], *map(seat.of_shaft, first.scene.gravity[1:]))),
            ("start.time", start.time, first.scene.start.time),
        ):
            if own != needed:
                limit = f"must be {needed}: that of the first bearing, in the axes of this one"
                raise InputError.of(("seats", number, "scene", name), own, limit)


def _of_all(hold: Mapping[str, float], seats: Sequence[Seat], found: Sequence[Equilibrium]) -> dict[str, float]:
    """What the support of one housing carries at the start: force (N), and moment through the apex of the first bearing (N m), of
    which `hold` has what the first bearing does, and the weight.
    """
    sums = np.array([hold[name] for name in HOUSING_LOADS])
    first = seats[0].scene.bearing.geometry.centre_plane + seats[0].mass_offset
    for seat, equilibrium in zip(seats[1:], found[1:], strict=True):
        force = -seat.axes(equilibrium.on_outer[:3])
        moment = -seat.axes(np.array([*equilibrium.on_outer[3:], 0.0]))[:2]
        own = seat.scene.bearing.geometry.centre_plane + seat.mass_offset
        arm = first - (-own if seat.turned else own)  # of its apex
        sums += np.concatenate([force, moment + arm * np.array([-force[1], force[0]])])
    return dict(zip(HOUSING_LOADS, sums.tolist(), strict=True))


def _with_loads(motion: RingMotion, scene: Scene, loads: Mapping[str, Load]) -> RingMotion:
    table, period = motion_table(scene, [0.0] * 5, loads=loads), loads_period(scene, loads)
    return replace(motion, table=table, period=(period or 0.0) if len(table) > 1 else 0.0)


def _model(seat: Seat, body: RingBody, number: int, free: float, shared: bool, instruction_set: str) -> _core.Model:
    """The core's model of a bearing on the shaft; `shared`: in the housing of the first one, which has its springs."""
    own = {
        "ring_free": free,
        "ring_offset": seat.mass_offset,
        "ring_unbalance_angle": math.radians(body.unbalance_angle_deg),
        "ring_carried": float(number > 0),
        "ring_turned": float(seat.turned),
        "ring_shift": seat.shift,
    }
    if shared:
        own |= {name: 0.0 for name in PARAMETERS if name.startswith(("outer_support_", "outer_damping"))}
        own |= {"outer_carried": 1.0, "outer_turned": float(seat.turned)}
    entries = (
        scene_entries(seat.scene)
        | named_entries(body)
        | {name: Entry(("shaft",), value) for name, value in own.items()}
    )
    return model_of(seat.scene, block_of(entries), instruction_set)
