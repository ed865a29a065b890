"""From validated models to the flat float64 arrays that the core takes.

The core's own tables say which numbers it wants, in which order and range. Everything here goes by their names, so that
a number that is missing, or one too many, is an error at once.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.validation import Model
from trbdyn.errors import MISSING, InputError, Path, Problem
from trbdyn.model.contact_line import nodes
from trbdyn.model.core_table import PARAMETERS
from trbdyn.model.effects import Effects
from trbdyn.model.geometry import Geometry
from trbdyn.model.growth import running_clearance, running_pockets
from trbdyn.model.lubricants import Dicke, Lubricant, replenishment_decline
from trbdyn.model.motion import History, common_period, joint_times, knot_table, periods_of, settled_time, value_at

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing
    from trbdyn.model.material import Material
    from trbdyn.model.pocket import Face
    from trbdyn.model.scene import Scene

FloatArray = NDArray[np.float64]

CODES: Final[dict[str, dict[str, int]]] = {
    "profile": {"straight": 0, "crowned": 1, "logarithmic": 2, "iso": 3, "table": 0},
    "quadrature": {"uniform": 0, "gauss": 1},
    "viscosity_law": {"dicke": 0, "roelands": 1, "barus": 2},
    "lubrication": {"dry": 0, "boundary": 1, "mixed": 2, "full_film": 3},
    "traction": {"none": 0, "coulomb": 1, "muraki_kimura": 2},
    "rolling_resistance": {
        "zhou_hoeprich": 1,
        "goksem_hargreaves": 2,
        "aihara": 3,
        "matsuyama": 4,
        "biboulet_houpert": 5,
        "line_solution": 6,
    },
    "rolling_load": {"slices": 0, "contact": 1},
    "rib_film": {"max": 0, "pe": 1, "needle": 2},
    "thermal": {"gupta": 1, "aihara": 2},
    "mixed_law": {"power": 0, "exponential": 1},
    "damping": {"off": 0, "hunt_crossley": 1, "film": 2},
    "with_cage": {"rollers": 0, "rollers_and_cage": 1, "rollers_and_spacer": 2},
    "guidance": {"rollers": 0, "inner_land": 1, "outer_land": 2},
    "part": {"flank": 0, "large_end": 1, "small_end": 2},
}
"""Numbers that stand for choices, by the core's names: parameters, and the part of a roller that a face of a pocket meets."""


@dataclass(frozen=True)
class Entry:
    """A number for the core (SI), and the field where the user gave it, from the model that the entries describe."""

    path: Path
    value: float


Entries = dict[str, Entry]

WHOLE_LOAD: Final = ("zhou_hoeprich", "aihara")
"""Laws of rolling resistance that were made for the load of a whole contact."""

RING_PLACES: Final = ("displacement_x", "displacement_y", "displacement_z", "rotation_x", "rotation_y")
HOUSING_LOADS: Final = ("housing_force_x", "housing_force_y", "housing_force_z", "housing_moment_x", "housing_moment_y")
"""Channels of the force (N) and the moment through the apex (N m) by which the support of a housing holds it at the start."""


def named_entries(model: Model, *path: str) -> Entries:
    """Numbers of the fields that name their parameter (`trbdyn.model.core_table.parameter`); `path` leads to the model."""
    return {
        str(extra["parameter"]): Entry((*path, name), getattr(model, name))
        for name, field in type(model).model_fields.items()
        if isinstance(extra := field.json_schema_extra, dict) and "parameter" in extra
    }


def _cage_faces(bearing: Bearing) -> Entries:
    """Radii of the cage's end faces: those of its wall, in the middle between both ends."""
    pitch, cosine = 0.5 * bearing.pitch_diameter, math.cos(math.radians(bearing.cup_half_angle_deg))
    names = {"cage_face_inner": "wall_inner", "cage_face_outer": "wall_outer"}
    return {key: Entry(("cage", name), pitch + cosine * getattr(bearing.cage, name)) for key, name in names.items()}


def bearing_entries(bearing: Bearing) -> Entries:
    """Numbers of a bearing, by their names in the core's table; paths start at the bearing."""
    roller, cage = bearing.roller, bearing.cage
    return {
        **named_entries(bearing),
        **named_entries(roller, "roller"),
        **named_entries(roller.profile, "roller", "profile"),
        **named_entries(bearing.ribs, "ribs"),
        **named_entries(cage, "cage"),
        **_cage_faces(bearing),
        **named_entries(bearing.roughness, "roughness"),
        **named_entries(bearing.land, "land"),
        "cup_half_angle": Entry(("cup_half_angle_deg",), math.radians(bearing.cup_half_angle_deg)),
        "profile": Entry(("roller", "profile", "kind"), CODES["profile"][roller.profile.kind]),
        **_material("", ("material",), bearing.material),
        **_material("roller_", ("roller", "material") if roller.material else ("material",), bearing.roller_material),
        **_material("cage_", ("cage", "material") if cage.material else ("material",), bearing.cage_material),
    }


def _material(prefix: str, path: Path, material: Material) -> Entries:
    return {
        f"{prefix}{name}": Entry((*path, name), getattr(material, name)) for name in ("youngs_modulus", "poisson_ratio")
    }


def lubricant_entries(lubricant: Lubricant) -> Entries:
    """Numbers of a lubricant, by their names in the core's table; paths start at the lubricant."""
    return {
        **named_entries(lubricant.dicke or Dicke(), "dicke"),
        **named_entries(lubricant),
        "viscosity_law": Entry(("pressure_law",), CODES["viscosity_law"][lubricant.pressure_law]),
    }


def effects_entries(effects: Effects) -> Entries:
    """Numbers of the effects, by their names in the core's table, which most fields have; paths start at the effects.

    Effects of films are handed on as off where there are no films.
    """
    own = {name: getattr(effects, name) for name in Effects.model_fields if name in PARAMETERS}
    rolling, off = effects.films and effects.rolling_resistance, effects.damping == "off"
    own["thermal"] = effects.films and effects.thermal and effects.thermal_law
    own["rolling_resistance"] = rolling and effects.rolling_law
    own["rolling_load"] = effects.rolling_load == "contact" and effects.rolling_law in WHOLE_LOAD
    own["supply"] = effects.rolling_supply
    own["rolling_pressure_force"] = rolling and effects.rolling_pressure_force
    own["damping"] = effects.damping if effects.films or off else "hunt_crossley"
    return {
        **{
            name: Entry((name,), CODES[name][value] if isinstance(value, str) else value) for name, value in own.items()
        },
        "with_cage": Entry(("bodies",), CODES["with_cage"][effects.bodies]),
        **named_entries(effects.friction, "friction"),
    }


def block_of(entries: Mapping[str, Entry], *, partial: bool = False) -> FloatArray:
    """The core's parameter block, shape (P,): float64 in the order of `_core.parameter_table()`; numbers beyond the table's
    ranges are refused.

    With `partial`, numbers that have no entry are NaN: for a caller in the core that does not read them. Else names that only one
    of table and entries has are a RuntimeError: package and core do not belong together.
    """
    table = _core.parameter_table()
    names = {row[0] for row in table}
    strange = set(entries) - names if partial else names ^ set(entries)
    if strange:
        raise RuntimeError(f"the core's table of parameters and the models differ in {sorted(strange)}")
    problems = [
        Problem(
            entries[name].path,
            entries[name].value,
            f"must be from {lower:g} to {upper:g}{'' if unit == '1' else f' ({unit})'}",
        )
        for name, unit, lower, upper, *_ in table
        if name in entries and not lower <= entries[name].value <= upper
    ]
    if problems:
        raise InputError(problems)
    return np.array([entries[row[0]].value if row[0] in entries else math.nan for row in table], dtype=np.float64)


def prefixed(prefix: str, entries: Entries) -> Entries:
    """The entries with their paths starting at `prefix`."""
    return {name: Entry((prefix, *entry.path), entry.value) for name, entry in entries.items()}


def bearing_geometry(bearing: Bearing) -> Geometry:
    """Derived geometry of a bearing; it needs no oil and no effects."""
    entries = bearing_entries(bearing)
    try:
        return Geometry.from_parameters(block_of(entries, partial=True))
    except _core.CoreError as error:
        raise input_error_of_core(error, entries) from None


def input_error_of_core(error: Exception, entries: Mapping[str, Entry]) -> InputError:
    """The core's complaint about a parameter (``name = value unit: what is allowed``), told in the user's terms."""
    text = str(error)
    match = re.match(r"(\w+) = (\S+?)[:\s](.*)", text, re.DOTALL)
    if match is None or match[1] not in entries:
        return InputError([Problem((), MISSING, text)])
    entry = entries[match[1]]
    return InputError([Problem(entry.path, entry.value, text.split(": ", 1)[-1])])


def scene_entries(scene: Scene) -> Entries:
    """Numbers of a scene, by their names in the core's table; paths start at the scene."""
    size = {"pitch_diameter": scene.bearing.pitch_diameter, "roller_diameter": scene.bearing.roller.diameter}
    decline = replenishment_decline(scene.lubricant, scene.effects.replenishment, **size)
    return {
        **prefixed("bearing", bearing_entries(scene.bearing)),
        "land_clearance": Entry(("bearing", "land", "clearance"), running_clearance(scene)),
        **prefixed("lubricant", lubricant_entries(scene.lubricant)),
        **prefixed("effects", effects_entries(scene.effects)),
        **prefixed("effects", rib_entries(scene.bearing, scene.effects)),
        "replenishment": Entry(("effects", "replenishment"), decline),
        "n_slices": Entry(("effects", "n_slices"), float(nodes(scene))),
        **ring_entries(scene),
        **housing_entries(scene),
        "outer_turns": Entry(("outer_speed_rpm",), float(scene.outer_turns)),
        **elastic_entries(scene),
    }


def rib_entries(bearing: Bearing, effects: Effects) -> Entries:
    """Which ribs act, by their names in the core's table: those that the bearing has, where the effects let them act; paths start
    at the effects.
    """
    there = bearing.ribs.places
    return {
        name: Entry((effect,), float(acts and place in there))
        for name, effect, acts, place in (
            ("back_rib", "back_rib", effects.back_rib, ("inner", "large")),
            ("front_rib", "front_rib", effects.front_rib, ("inner", "small")),
            ("outer_rib", "back_rib", effects.back_rib, ("outer", "large")),
            ("outer_front_rib", "front_rib", effects.front_rib, ("outer", "small")),
        )
    }


def ring_entries(scene: Scene) -> Entries:
    """Numbers of a free ring, by their names in the core's table; zero where there is none. Paths start at the scene."""
    found = {name: Entry(("ring",), 0.0) for name in PARAMETERS if name.startswith("ring_")}
    if (body := scene.ring_body) is not None:
        found |= named_entries(body, "ring_body")
        found["ring_free"] = Entry(("ring",), 1.0 if scene.torque is None else 2.0)
        angle = math.radians(body.unbalance_angle_deg)
        found["ring_unbalance_angle"] = Entry(("ring_body", "unbalance_angle_deg"), angle)
    return found


def housing_entries(scene: Scene) -> Entries:
    """Numbers of an outer ring with its housing, by their names in the core's table; zero where it is held."""
    of_ring = [name for name, row in PARAMETERS.items() if row.part == "outer_ring" and name != "outer_turns"]
    found = {name: Entry(("housing",), 0.0) for name in of_ring}
    if scene.housing is not None:
        # its fields name the parameters of an inner ring; the core has the same ones for both
        own = named_entries(scene.housing, "housing")
        found |= {name.replace("ring_", "outer_", 1): entry for name, entry in own.items()}
        found["outer_free"] = Entry(("housing",), 1.0)
    return found


def elastic_entries(scene: Scene) -> Entries:
    """The number of an elastic cage's modes, by its name in the core's table; zero for a rigid one."""
    modes = 0 if scene.elastic_cage is None else scene.elastic_cage.n_modes
    return {"cage_modes": Entry(("elastic_cage", "n_modes"), modes)}


def parameter_block(scene: Scene) -> FloatArray:
    """The core's parameter block of a scene, shape (P,): float64 in the order of `_core.parameter_table()`."""
    return block_of(scene_entries(scene))


def face_rows(scene: Scene) -> FloatArray:
    """Faces of the cage's pockets as the core takes them, shape (F, C): one row for each face, columns of
    `_core.face_table()`.
    """
    columns = [(name, count) for name, count, _, _ in _core.face_table()]
    return np.array([_face_row(columns, pocket, face) for pocket, face in running_pockets(scene)], dtype=np.float64)


def _face_row(columns: list[tuple[str, int]], pocket: int, face: Face) -> list[float]:
    values: dict[str, list[float]] = {
        "pocket": [pocket],
        "slot": [face.slot],
        "part": [CODES["part"][face.part]],
        "origin": list(face.origin),
        "u": list(face.u),
        "v": list(face.v),
        "stiffness_factor": [face.stiffness_factor],
        "friction_factor": [face.friction_factor],
        "n_vertices": [len(face.outline)],
        "outline": [number for vertex in face.outline for number in vertex],
    }
    if set(values) != {name for name, _ in columns}:
        raise RuntimeError(
            f"the core's table of faces and Face differ in {sorted(set(values) ^ {name for name, _ in columns})}"
        )
    row: list[float] = []
    for name, count in columns:
        row += values[name] + [0.0] * (count - len(values[name]))
    return row


def diameter_deviation(scene: Scene) -> FloatArray:
    """Deviation of each roller's diameter (m), shape (Z,)."""
    return np.ascontiguousarray(scene.bearing.diameter_deviation, dtype=np.float64)


@dataclass(frozen=True)
class RingLoad:
    """What acts on the inner ring at an instant; moments and turns are about x and y through the roller-centre plane."""

    force: FloatArray  # on the ring (N), shape (3,)
    moment: FloatArray  # on the ring (N m), shape (2,)
    fixed: FloatArray  # 1 where `displacement` is prescribed, 0 where it is to be found, shape (5,)
    displacement: FloatArray  # along x, y, z (m) and rotation (rad), shape (5,)
    shaft_speed: float  # rad/s
    outer_speed: float  # rad/s
    gravity: FloatArray  # m/s2, shape (3,)


def ring_load(scene: Scene, time: float = 0.0) -> RingLoad:
    """What acts on the inner ring at a time (s)."""
    radial, direction = value_at(scene.radial_load, time), math.radians(value_at(scene.radial_direction_deg, time))
    force = np.array([radial * math.cos(direction), radial * math.sin(direction), -value_at(scene.axial_load, time)])
    if scene.rotating_load is not None:
        size, turned = value_at(scene.rotating_load.load, time), scene.rotating_load_angle(time)
        force[:2] += size * np.array([math.cos(turned), math.sin(turned)])
    places = scene.displacement or (None, None, None)
    moment = np.array([0.0 if given is None else value_at(given, time) for given in scene.moments])
    gravity = np.array([value_at(quantity, time) for quantity in _gravity(scene)])
    if scene.ring_body is not None:
        weight, arm = scene.ring_body.mass * gravity, scene.ring_body.mass_offset
        force += weight
        moment += arm * np.array([-weight[1], weight[0]])
    turns = (value_at(scene.misalignment_x, time), value_at(scene.misalignment_y, time))
    fixed = np.array([float(held) for held in scene.ring_is_placed])
    if scene.bearing.is_cylindrical and not scene.bearing.ribs.carry(float(force[2])):
        fixed[2] = 1.0  # no rib holds a free ring: it begins in the middle, and its support takes up what pushes it
    return RingLoad(
        force=force,
        moment=moment,
        fixed=fixed,
        displacement=np.array([*(0.0 if place is None else value_at(place, time) for place in places), *turns]),
        shaft_speed=value_at(scene.speed_rpm, time) * math.pi / 30.0,
        outer_speed=value_at(scene.outer_speed_rpm, time) * math.pi / 30.0,
        gravity=gravity,
    )


def motion_table(
    scene: Scene,
    path: Sequence[float | History],
    joints: FloatArray | None = None,
    loads: Mapping[str, Load] | None = None,
) -> FloatArray:
    """Prescribed motion of the inner ring, as the core takes it, shape (K, 44): knot time, value and slope of each channel of
    `_core.motion_table()`, and 1 where a step need not end; the last `scene.period` repeats.

    `path` has the five displacements (m) and rotations (rad) of the ring that equilibria gave; what the scene prescribes is taken
    from the scene instead. `joints` are times at which a part of the path ends (s): where what acts on the ring has a joint.
    `loads` on a free ring, by the names of their channels such as ``"force_x"``, stand in place of the scene's.
    """
    given = [*(scene.displacement or (None, None, None)), scene.misalignment_x, scene.misalignment_y]
    ring = [
        path[axis] if place is None or not held else place
        for axis, (place, held) in enumerate(zip(given, scene.ring_is_placed, strict=True))
    ]
    gravity = _gravity(scene)
    channels: dict[str, float | History] = {
        **dict(zip(RING_PLACES, ring, strict=True)),
        "shaft_speed": scaled(scene.speed_rpm, math.pi / 30.0),
        "outer_speed": scaled(scene.outer_speed_rpm, math.pi / 30.0),
        **{f"gravity_{axis}": part for axis, part in zip("xyz", gravity, strict=True)},
        **_loads_on_free_ring(scene),
        **dict.fromkeys(HOUSING_LOADS, 0.0),
    }
    names = [name for name, _, _ in _core.motion_table()]
    if set(names) != set(channels):
        raise RuntimeError(f"the core's table of motion and the scene differ in {sorted(set(names) ^ set(channels))}")
    sums = {name: parts_of(load) for name, load in (loads or {}).items()}
    quantities = [0.0 if name in sums else channels[name] for name in names]
    added = [quantity for parts in sums.values() for _, quantity in parts]
    if joints is not None:
        own = [*gravity, scene.speed_rpm, scene.outer_speed_rpm, *(place for place in given if place is not None)]
        end = scene.settled + (scene.period or 0.0)
        joints = np.append(joints, joint_times(own, scene.start.time, end))
    settled = settled_time(added, scene.settled)
    table = knot_table([*quantities, *added], scene.start.time, settled, loads_period(scene, loads or {}), joints)
    columns = iter(range(1 + 2 * len(names), table.shape[1] - 1, 2))
    for name, parts in sums.items():
        to = 1 + 2 * names.index(name)
        for factor, _ in parts:
            column = next(columns)
            table[:, to : to + 2] += factor * table[:, column : column + 2]
    return np.delete(table, np.s_[1 + 2 * len(names) : -1], axis=1)


Load = float | History | tuple[tuple[float, float | History], ...]
"""What acts in a channel: a quantity, or a sum of quantities, each with its factor."""


def parts_of(load: Load) -> tuple[tuple[float, float | History], ...]:
    """A load as a sum."""
    return load if isinstance(load, tuple) else ((1.0, load),)


def loads_period(scene: Scene, loads: Mapping[str, Load]) -> float | None:
    """Common period of a scene and of loads that act besides (s), None if nothing repeats; it must be there if both repeat."""
    own = {} if scene.period is None else {"scene": scene.period}
    parts = {f"{name}[{place}]": part for name, load in loads.items() for place, (_, part) in enumerate(parts_of(load))}
    return common_period(own | periods_of(parts))


def load_channels() -> list[str]:
    """Names of the core's channels of loads on a free ring."""
    return [name for name, _, _ in _core.motion_table() if name.startswith(("force_", "moment_", "torque"))]


def _loads_on_free_ring(scene: Scene) -> dict[str, float | History]:
    """Loads on a free ring, by the names of their channels; zero for any other."""
    loads: dict[str, float | History] = dict.fromkeys(load_channels(), 0.0)
    if scene.ring != "free":
        return loads
    direction = math.radians(value_at(scene.radial_direction_deg, 0.0))
    for axis, factor, quarter in (("x", math.cos(direction), 0.0), ("y", math.sin(direction), -90.0)):
        loads[f"force_{axis}"] = _with_rotating(scene, scaled(scene.radial_load, factor), quarter)
    loads["force_z"] = scaled(scene.axial_load, -1.0)
    for axis, moment in zip("xy", scene.moments, strict=True):
        loads[f"moment_{axis}"] = 0.0 if moment is None else moment
    loads["torque"] = 0.0 if scene.torque is None else scene.torque
    return loads


def _with_rotating(scene: Scene, steady: float | History, phase_deg: float) -> float | History:
    """A part of the radial load with its part of the load that rotates; both are constant where there is such a load."""
    rotating = scene.rotating_load
    if rotating is None or not (size := value_at(rotating.load, 0.0)):
        return steady
    turned = scene.rotating_load_angle(0.0)
    later = (scene.rotating_load_angle(1.0) - turned) / (2.0 * math.pi)
    phase, mean = math.degrees(turned) + phase_deg, value_at(steady, 0.0)
    if not later:
        return mean + size * math.cos(math.radians(phase))
    return History.harmonic(mean, size, frequency_hz=abs(later), phase_deg=math.copysign(phase, later * phase))


def _gravity(scene: Scene) -> tuple[float | History, float | History, float | History]:
    return scene.gravity if scene.effects.gravity else (0.0, 0.0, 0.0)


def scaled(quantity: float | History, factor: float) -> float | History:
    if not isinstance(quantity, History):
        return factor * quantity
    slopes = quantity.slopes
    return quantity.replace(
        values=tuple(factor * value for value in quantity.values),
        slopes=None if slopes is None else tuple(factor * slope for slope in slopes),
    )
