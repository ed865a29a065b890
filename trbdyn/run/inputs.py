"""Inputs that change while a simulation steps: loads, speeds, places of a ring, temperature of the oil, given between steps.

Each call makes a table of what is prescribed from the present time on, and the integrator starts again with it at the present
state. Loads begin at once (held) or change evenly until the end of the step (linear). Speeds and places of a ring always change
evenly: a jump would be an infinite acceleration. After the end of the step everything keeps its value until the next call.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import InputError, LoadError, unknown_name
from trbdyn.model.assembly import Subject, subject_from_dict
from trbdyn.model.flatten import HOUSING_LOADS, load_channels, motion_table
from trbdyn.model.motion import value_at
from trbdyn.model.scene import Scene
from trbdyn.model.shaft import angle_turned
from trbdyn.statics.assembly import ShaftEquilibrium, equilibrium
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import EquilibriumSolver, nominal_angles
from trbdyn.statics.ring_motion import RingMotion
from trbdyn.statics.seat import SeatedBearing, Seating
from trbdyn.statics.seating import loads_of, seated

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation

Array = NDArray[np.float64]

TEMPERATURE: Final = "temperature_c"
OF_A_SCENE: Final = (
    "axial_load",
    "radial_load",
    "radial_direction_deg",
    "moment_x",
    "moment_y",
    "torque",
    "displacement",
    "misalignment_x",
    "misalignment_y",
    "speed_rpm",
    "outer_speed_rpm",
    TEMPERATURE,
)
OF_AN_ASSEMBLY: Final = ("loads", "torque", "speed_rpm", TEMPERATURE)
RATES: Final = {
    "displacement": ("displacement_x", "displacement_y", "displacement_z"),
    "misalignment_x": ("rotation_x",),
    "misalignment_y": ("rotation_y",),
}
"""Inputs whose rates may be given, and their channels."""
BETWEEN: Final = ("held", "linear")
_OF_MOTION: Final = tuple(one.name for one in fields(RingMotion) if one.name != "table")


@dataclass(frozen=True)
class Inputs:
    """What is in force.

    Attributes
    ----------
    subject : Scene or Assembly
        The subject with the inputs that were given last.
    motions : tuple of RingMotion
        What is prescribed for each bearing.
    values : tuple of ndarray
        What the channels of each bearing have reached at `until`.
    until : float
        End of the step for which inputs were given (s). What changed evenly goes on so in the tables, so that no step ends at a
        kink; a simulation that steps on from there takes the values as they are then.
    start : ShaftEquilibrium, optional
        The equilibrium in which an assembly began.
    rates : ndarray, optional
        Rates of the channels at `until`, where they were given.
    """

    subject: Subject
    motions: tuple[RingMotion, ...]
    values: tuple[Array, ...]
    until: float
    start: ShaftEquilibrium | None = None
    rates: Array | None = None

    @property
    def changes(self) -> bool:
        """Whether something changes evenly."""
        return any(len(one.table) > 1 for one in self.motions)

    def angle(self, time: float) -> float:
        """Angle of the shaft at a time (rad)."""
        return turned(self.motions[0], "shaft_speed", self.motions[0].shaft_angle, time)

    def to_dict(self) -> dict[str, Any]:
        """Plain data, from which `of_dict` makes the same numbers."""
        motions = [
            {name: getattr(one, name) for name in _OF_MOTION} | {"table": one.table.tolist()} for one in self.motions
        ]
        return {
            "subject": self.subject.to_dict(),
            "motions": motions,
            "values": [one.tolist() for one in self.values],
            "until": self.until,
            "rates": None if self.rates is None else self.rates.tolist(),
        }

    @classmethod
    def of_dict(cls, found: Mapping[str, Any]) -> Inputs:
        """What `to_dict` wrote; the equilibrium of an assembly is found again where it is needed."""
        motions = [RingMotion(**{**one, "table": np.array(one["table"], dtype=float)}) for one in found["motions"]]
        values = [np.array(one, dtype=float) for one in found["values"]]
        rates = None if found["rates"] is None else np.array(found["rates"], dtype=float)
        return cls(
            subject_from_dict(found["subject"]), tuple(motions), tuple(values), float(found["until"]), rates=rates
        )


def _channel(name: str) -> int:
    """Column of a channel's value in a table."""
    return 1 + 2 * [one for one, _, _ in _core.motion_table()].index(name)


def _values(motion: RingMotion, time: float) -> Array:
    """Value of each channel at a time, of a table of straight lines, or before and after any table."""
    table = motion.table
    last = int(np.searchsorted(table[:, 0], time, side="right")) - 1
    row = table[max(last, 0)]
    past = max(time - row[0], 0.0) if 0 <= last < len(table) - 1 else 0.0
    return np.asarray(row[1:-1:2] + past * row[2:-1:2])


def turned(motion: RingMotion, name: str, angle: float, time: float) -> float:
    """Angle (rad) at a time: that at `motion.angle_time`, and the integral of a speed since, along straight lines."""
    column, table = _channel(name), motion.table
    knots = [motion.angle_time, *(t for t in table[:, 0] if motion.angle_time < t < time), time]
    for begin, end in itertools.pairwise(knots):
        speed = _values(motion, 0.5 * (begin + end))[(column - 1) // 2]
        angle += float(speed) * (end - begin)
    return angle


def give(
    sim: Simulation[Any], to: float, between: str, given: Mapping[str, Any], rates: Mapping[str, Any] | None = None
) -> None:
    """Put inputs in force from the present time of a simulation on. What changes evenly reaches its value at `to` (s); places of
    a ring whose rates then are given follow a cubic, which begins with the rates that were given before.
    """
    if between not in BETWEEN:
        raise InputError.of("between", between, unknown_name(str(between), BETWEEN))
    before = _present(sim)
    subject, now, start = _changed(before.subject, given), sim.time, before.start
    if not isinstance(subject, Scene) and start is None:
        assembly = sim.assembly
        assert assembly is not None
        start = equilibrium(assembly, time=assembly.bearings[0].start.time)
    models = [one.model for one in sim.bearings]
    if TEMPERATURE in given:
        models = [one.model for one in seated(subject, sim.instruction_set).bearings]
    aims = _aims(sim, subject, start, given)
    end = np.zeros_like(before.values[0]) if rates is None else _rates(subject, rates)
    bearings, motions, values = [], [], []
    for one, motion, model, aim, reached in zip(sim.bearings, before.motions, models, aims, before.values, strict=True):
        present = reached if now >= before.until else _values(motion, now)
        wanted = np.where(np.isnan(aim), present, aim)
        moved = _moved(motion, now, to, present, wanted, jumps=between == "held")
        if rates is not None:
            moved = _bent(moved, to, wanted, before.rates, end)
        bearings.append(replace(one, model=model, motion=moved, scene=_scene(subject, one)))
        motions.append(moved)
        values.append(wanted)
    sim._begin_with(
        tuple(bearings), Inputs(subject, tuple(motions), tuple(values), to, start, None if rates is None else end)
    )


def _scene(subject: Subject, one: SeatedBearing) -> Scene:
    """The scene of a bearing with inputs."""
    if isinstance(subject, Scene):
        return subject
    lubricant = subject.bearings[one.number].lubricant
    return one.scene if one.scene.lubricant == lubricant else one.scene.replace(lubricant=lubricant)


def _oils(subject: Subject) -> list[Any]:
    return [subject.lubricant] if isinstance(subject, Scene) else [one.lubricant for one in subject.bearings]


def put_back(sim: Simulation[Any], inputs: Inputs) -> tuple[SeatedBearing, ...]:
    """The bearings of a simulation with inputs that were in force when a state was saved."""
    models = [one.model for one in sim.bearings]
    if _oils(inputs.subject) != _oils(_present(sim).subject):
        models = [one.model for one in seated(inputs.subject, sim.instruction_set).bearings]
    return tuple(
        replace(one, model=model, motion=motion, scene=_scene(inputs.subject, one))
        for one, model, motion in zip(sim.bearings, models, inputs.motions, strict=True)
    )


def _present(sim: Simulation[Any]) -> Inputs:
    """What is in force; of a simulation that never had inputs what its subject prescribes, which must not change any more."""
    if sim._inputs is not None:
        return sim._inputs
    subject = sim.subject
    if isinstance(subject, Seating):
        raise InputError.of("subject", type(subject).__name__, "must be a Scene or an Assembly, to take inputs")
    motions = []
    for one in sim.bearings:
        motion, time = one.motion, sim.time
        if len(motion.table) > 1 and (motion.period > 0.0 or time < motion.table[-1, 0]):
            limit = "must not change by itself any more where inputs are given between steps: give constant numbers"
            raise InputError.of("subject", f"what is prescribed at {time:g} s", limit)
        motions.append(
            motion
            if len(motion.table) == 1
            else replace(
                motion,
                table=motion.table[-1:],
                period=0.0,
                angle_time=time,
                shaft_angle=sim.state.shaft_angle or 0.0,
                outer_angle=_outer_angle(sim, one, time),
            )
        )
    return Inputs(subject, tuple(motions), tuple(motion.table[-1, 1:-1:2].copy() for motion in motions), -math.inf)


def _outer_angle(sim: Simulation[Any], one: SeatedBearing, time: float) -> float:
    return angle_turned(one.scene.outer_speed_rpm, 0.0, time) if one.scene.outer_turns else 0.0


def _changed(subject: Subject, given: Mapping[str, Any]) -> Subject:
    """The subject with inputs; an InputError that names what is wrong."""
    allowed = OF_A_SCENE if isinstance(subject, Scene) else OF_AN_ASSEMBLY
    for name in given:
        if name not in allowed:
            raise InputError.of(name, given[name], unknown_name(name, allowed))
    fields = {name: value for name, value in given.items() if name != TEMPERATURE}
    if TEMPERATURE in given:
        if isinstance(subject, Scene):
            fields["lubricant"] = subject.lubricant.replace(temperature_c=given[TEMPERATURE])
        else:
            fields["bearings"] = tuple(
                one.replace(lubricant=one.lubricant.replace(temperature_c=given[TEMPERATURE]))
                for one in subject.bearings
            )
    made = subject.replace(**fields)
    if isinstance(made, Scene):
        assert isinstance(subject, Scene)
        if made.ring_is_placed != subject.ring_is_placed or (made.torque is None) != (subject.torque is None):
            raise InputError.of("inputs", list(given), "must not change which motions of the ring are prescribed")
        if made.outer_turns != subject.outer_turns:
            raise InputError.of("outer_speed_rpm", made.outer_speed_rpm, "must not begin: the outer ring is at rest")
        if made.ring == "held" and _loads(made) != _loads(subject):
            limit = "must not be given: the ring is held, and no load moves it; ring = 'free' or 'follows' takes loads"
            raise InputError.of(next(iter(given)), given[next(iter(given))], limit)
    return made


def _loads(scene: Scene) -> tuple[Any, ...]:
    return scene.axial_load, scene.radial_load, scene.radial_direction_deg, scene.moment_x, scene.moment_y


def _aims(
    sim: Simulation[Any], subject: Subject, start: ShaftEquilibrium | None, given: Mapping[str, Any]
) -> list[Array]:
    """Values of the channels of each bearing that inputs ask for; nan where one keeps what it has."""
    if isinstance(subject, Scene):
        path = [math.nan] * 5
        if subject.ring == "follows" and set(given) - {TEMPERATURE}:
            path = _followed(sim, subject)
        table = _of_scene(subject, path)
        own = [_channel(name) for name in HOUSING_LOADS]
        table[0, own] = math.nan
        return [table[0, 1:-1:2]]
    assert start is not None
    found = []
    for one in sim.bearings:
        row = np.full((sim.bearings[0].motion.table.shape[1]), math.nan)
        scene = subject.scene(one.number, displacement=(0.0, 0.0, -1e-6, 0.0, 0.0))
        row[_channel("shaft_speed")] = value_at(scene.speed_rpm, 0.0) * math.pi / 30.0
        if one.number == 0:
            loads = loads_of(subject, start)
            for name in load_channels():
                parts = loads.get(name, ())
                assert isinstance(parts, tuple)
                row[_channel(name)] = sum(factor * value_at(quantity, 0.0) for factor, quantity in parts)
        found.append(row[1:-1:2])
    return found


def _of_scene(scene: Scene, path: list[float]) -> Array:
    """The table of a scene; a coordinate of the ring that is not prescribed is nan where the path is."""
    places = [0.0 if math.isnan(value) else value for value in path]
    table = motion_table(scene, places)
    if len(table) > 1:
        raise InputError.of("inputs", "a history", "must be numbers: they change by the next call")
    for axis, (value, placed) in enumerate(zip(path, scene.ring_is_placed, strict=True)):
        if math.isnan(value) and not placed:
            table[0, 1 + 2 * axis] = math.nan
    return table


def _followed(sim: Simulation[Any], scene: Scene) -> list[float]:
    """Where a ring that follows its load is in equilibrium with it (m, rad)."""
    solver = EquilibriumSolver(normal_contacts(scene), scene, nominal_angles(scene))
    try:
        return [float(value) for value in solver.solve(sim.time).displacement]
    except LoadError as error:
        raise LoadError(f"inputs at {sim.time:.6g} s: {error}") from None


def _moved(motion: RingMotion, now: float, to: float, present: Array, wanted: Array, *, jumps: bool) -> RingMotion:
    """What is prescribed from now on (s): straight lines through the values at a later time, loads at once where they jump."""
    shaft = turned(motion, "shaft_speed", motion.shaft_angle, now)
    outer = turned(motion, "outer_speed", motion.outer_angle, now)
    begin = present.copy()
    if jumps:
        loads = [(_channel(name) - 1) // 2 for name in load_channels()]
        begin[loads] = wanted[loads]
    slope, length = (wanted - begin) / (to - now), 2.0 * (to - now)
    rows = [(now, begin)] if not slope.any() else [(now, begin), (now + length, begin + length * slope)]
    table = np.zeros((len(rows), motion.table.shape[1]))
    for row, (time, values) in zip(table, rows, strict=True):
        row[0], row[1:-1:2], row[2:-1:2] = time, values, slope
    return replace(motion, table=table, period=0.0, angle_time=now, shaft_angle=shaft, outer_angle=outer)


def _rates(subject: Subject, rates: Mapping[str, Any]) -> Array:
    """Rates of the channels at the end of a step, of places of a ring."""
    if not isinstance(subject, Scene):
        raise InputError.of("rates", list(rates), "must not be given for an assembly: its shaft moves by itself")
    found = np.zeros(len(_core.motion_table()))
    for name, value in rates.items():
        if name not in RATES:
            raise InputError.of(("rates", name), value, unknown_name(name, RATES))
        axes = np.atleast_1d(np.asarray([0.0 if one is None else one for one in np.atleast_1d(value)], dtype=float))
        if axes.size != len(RATES[name]) or not np.isfinite(axes).all():
            raise InputError.of(
                ("rates", name), value, f"must have {len(RATES[name])} finite numbers (1/s of the input)"
            )
        for channel, one in zip(RATES[name], axes, strict=True):
            found[(_channel(channel) - 1) // 2] = one
    return found


def _bent(motion: RingMotion, to: float, wanted: Array, begin: Array | None, end: Array) -> RingMotion:
    """A motion whose places of a ring follow a cubic to their rates at the end of a step, and go on with these."""
    places = [(_channel(name) - 1) // 2 for names in RATES.values() for name in names]
    first = motion.table[0].copy()
    now, slope = first[0], first[2:-1:2].copy()
    values, last, length = first[1:-1:2], slope.copy(), to - now
    slope[places] = (slope if begin is None else begin)[places]
    last[places] = end[places]
    table = np.zeros((3, motion.table.shape[1]))
    for row, time, value, rate in zip(
        table, (now, to, to + length), (values, wanted, wanted + length * last), (slope, last, last), strict=True
    ):
        row[0], row[1:-1:2], row[2:-1:2] = time, value, rate
    table[1, -1] = 1.0  # the curve goes on smoothly
    jumps = [(_channel(name) - 1) // 2 for name in load_channels()]
    table[1, 1 + 2 * np.array(jumps)] = values[jumps] + length * last[jumps]
    return replace(motion, table=table)
