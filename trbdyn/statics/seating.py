"""What the core takes of a subject. The bearings of an assembly begin in the equilibrium at speed.

The core has the coordinates of the shaft in the axes of the first bearing (`trbdyn.statics.seat`). Where that one sits the other
way round, all that belongs to the shaft is turned by half a turn about x.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache, singledispatch
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly
from trbdyn.model.flatten import Load
from trbdyn.model.motion import History
from trbdyn.model.ring_body import RingBody
from trbdyn.model.scene import Scene
from trbdyn.model.start import Start
from trbdyn.statics.assembly import ShaftEquilibrium, equilibrium
from trbdyn.statics.free_ring import axis_of
from trbdyn.statics.seat import KEPT, Seat, Seated, Seating, apart, seat_all, seat_alone
from trbdyn.statics.shaft_balance import turns_of

Array = NDArray[np.float64]
Parts = list[tuple[float, float | History]]


@singledispatch
def seated(subject: Any, instruction_set: str = "") -> Seated:
    """What the core takes of a scene, of an assembly in its equilibrium, or of a seating."""
    expect("scene", subject, Scene, Assembly)
    raise AssertionError


seated.register(Scene, seat_alone)
seated.register(Seating, seat_all)


@seated.register(Assembly)
def _of_assembly(assembly: Assembly, instruction_set: str = "") -> Seated:
    reads = any(assembly.scene(index).modes_from_file for index in range(len(assembly.bearings)))
    return _seat_assembly(assembly, instruction_set) if reads else apart(_kept_assembly(assembly, instruction_set))


def _seat_assembly(assembly: Assembly, instruction_set: str) -> Seated:
    found = seat_all(seating_of(assembly), instruction_set)
    return found if assembly.start is None else _gone_on(found, assembly.start)


_kept_assembly = lru_cache(maxsize=KEPT)(_seat_assembly)


def _gone_on(seated: Seated, start: Start) -> Seated:
    """Seated bearings in the state of a simulation that began as they do."""
    vector, first = np.array(start.state_vector), seated.bearings[0]
    if vector.size != seated.vector.size:
        limit = f"must have {seated.vector.size} for these bearings"
        raise InputError.of(("start", "state_vector"), f"{vector.size} numbers", limit)
    if start.time < seated.time:
        limit = f"must be >= {seated.time:g}, where the bearings start (s)"
        raise InputError.of(("start", "time"), start.time, limit)
    own: dict[str, Any] = {
        "shaft_angle": first.scene.start_shaft_angle + first.scene.shaft_turn(start.time),
        "displacement": first.motion.displacement(start.time),
        "housing_load": np.zeros(5) if first.scene.housing is None else first.motion.housing_load,
    }
    for name, value in own.items():
        given = getattr(start, name)
        if given is not None and not np.allclose(given, value, rtol=1e-6, atol=1e-8):
            limit = (
                f"must be {np.array2string(np.asarray(value), precision=6)}, which follows from the starts of the bearings: the "
                "state is from a simulation that began otherwise"
            )
            raise InputError.of(("start", name), given, limit)
    return replace(seated, vector=vector, time=start.time)


def seating_of(assembly: Assembly) -> Seating:
    """Bearings and shaft of an assembly in equilibrium at the time at which its first bearing starts."""
    found = equilibrium(assembly, time=assembly.bearings[0].start.time)
    shaft, first = assembly.shaft, assembly.bearings[0]
    turn3, turn2 = turns_of(first)
    seats = {}
    for index, (name, one, outer) in enumerate(
        zip(assembly.names, assembly.bearings, found.outer_ring_places, strict=True)
    ):
        seats[name] = Seat(
            scene=assembly.scene(index, displacement=(0.0, 0.0, -1e-6, 0.0, 0.0)),
            mass_offset=-one.side * (shaft.mass_position - one.centre_plane),
            turned=one.side != first.side,
            shift=outer,
        )
    body = RingBody(
        mass=shaft.mass,
        inertia_axial=shaft.inertia_axial,
        inertia_transverse=shaft.inertia_transverse,
        unbalance=shaft.unbalance,
        unbalance_angle_deg=float(turn3[1]) * shaft.unbalance_angle_deg,
        damping=shaft.damping,
        damping_turns=shaft.damping_turns,
    )
    place = np.concatenate([turn3 * found.displacement(shaft.mass_position), turn2 * found.tilt])
    return Seating(seats, body, place, loads_of(assembly, found), assembly.shared_housing is not None)


def loads_of(assembly: Assembly, found: ShaftEquilibrium) -> dict[str, Load]:
    """Forces and moments at the first bearing's roller-centre plane, in its axes. Lever arms lie along the axis of the start."""
    first = assembly.bearings[0]
    turn3, turn2 = turns_of(first)
    axis, _ = axis_of(found.tilt)
    parts: dict[str, Parts] = {name: [] for name in ("force_x", "force_y", "force_z", "moment_x", "moment_y")}

    def add(name: str, factor: float, quantity: float | History) -> None:
        if factor and quantity != 0.0:
            parts[name].append((float(factor), quantity))

    for load in assembly.acting(weight=not first.effects.gravity):
        lever = np.array([*load.offset, 0.0]) + (load.position - first.centre_plane) * axis
        # the columns are what a force along x, y and z does about x and y
        about = np.array([[0.0, -lever[2], lever[1]], [lever[2], 0.0, -lever[0]]])
        for number, letter in enumerate("xyz"):
            add(f"force_{letter}", turn3[number], load.force[number])
            add("moment_x", turn2[0] * about[0, number], load.force[number])
            add("moment_y", turn2[1] * about[1, number], load.force[number])
        add("moment_x", turn2[0], load.moment[0])
        add("moment_y", turn2[1], load.moment[1])
    loads: dict[str, Load] = {name: tuple(each) for name, each in parts.items() if each}
    if assembly.torque is not None:
        loads["torque"] = ((float(turn3[2]), assembly.torque),)
    return loads
