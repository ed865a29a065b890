"""Several bearings on one rigid shaft, what acts on the shaft, and how the bearings are set against each other."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, Final, Literal, Self

from trbdyn.base.shown import Shown
from trbdyn.base.validation import Model, unit
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.flatten import scaled
from trbdyn.model.motion import History, Quantity, is_constant, value_at, values_of
from trbdyn.model.on_shaft import PreloadSpring, Shaft, ShaftBearing, ShaftLoad, SharedHousing, load_centre_offset
from trbdyn.model.scene import Scene
from trbdyn.model.start import Start
from trbdyn.model.turning import TurningRings

__all__ = [
    "Assembly",
    "PreloadSpring",
    "Shaft",
    "ShaftBearing",
    "ShaftLoad",
    "SharedHousing",
    "Subject",
    "assembly_of",
    "load_centre_offset",
]

Arrangement = Literal["back to back", "face to face"]
ROWS: Final[dict[str, tuple[Literal["left", "right"], ...]]] = {
    "TDO": ("right", "left"),
    "TDI": ("left", "right"),
    "TQO": ("left", "right", "left", "right"),
    "TQI": ("right", "left", "right", "left"),
}
"""Where the small ends of the rows point, from left to right. TDO: one double outer ring and two inner rings; TDI: one double
inner ring and two outer rings; TQO and TQI: four rows, two TDI or two TDO."""
OWN_FIELDS: Final = ("shaft", "loads", "speed_rpm", "outer_speed_rpm", "torque", "gravity", "shared_housing")
"""Fields of an `Assembly` that its makers take, beside those of its bearings."""


class Assembly(TurningRings, Model):
    """Bearings on a rigid shaft. Their outer rings stand, or turn, in a rigid housing, which may move.

    Frame: z along the shaft, to the right in words; the origin anywhere on its axis. Speeds are positive about +z, loads act on
    the shaft.

    Parameters
    ----------
    shaft : Shaft
        The shaft, with everything that turns with it.
    bearings : sequence of ShaftBearing
        Two or more, in any arrangement.
    loads : sequence of ShaftLoad
        Forces and moments on the shaft, besides its weight.
    speed_rpm : float or History
        Speed of the shaft (rpm).
    outer_speed_rpm : float or History
        Speed of all outer rings (rpm): that of the hub of a wheel, whose spindle has ``speed_rpm = 0``; 0 by default, at rest.
    torque : float or History, optional
        Torque of the drive about z (N m): the shaft then begins at `speed_rpm` and turns as the torque and its bearings let it.
    gravity : tuple of float or History, shape (3,)
        Acceleration of gravity (m/s2), for the weight of the shaft; that of rollers and cages is a choice of each bearing's
        effects.
    shared_housing : SharedHousing, optional
        One housing around all bearings, which moves in runs; without it the outer rings are held in space, or each has a
        `ShaftBearing.housing` of its own.
    start : Start, optional
        A state of a simulation of this assembly from which runs go on: ``Start.state(simulation.state)``. The starts of the
        bearings stay those of the simulation that the state is from, as housings and springs count from its equilibrium.

    Raises
    ------
    InputError
        If bearings overlap on the shaft, share a name, or can never hold the shaft.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> pair = trb.Assembly.pair(trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=3000)
    >>> [one.small_ends for one in pair.bearings], pair.arrangement
    (['right', 'left'], 'back to back')
    """

    shaft: Shaft
    bearings: tuple[ShaftBearing, ...]
    loads: tuple[ShaftLoad, ...] = ()
    speed_rpm: Annotated[Quantity, unit("rpm")]
    outer_speed_rpm: Annotated[Quantity, unit("rpm")] = 0.0
    torque: Annotated[Quantity | None, unit("N m")] = None
    gravity: tuple[Quantity, Quantity, Quantity] = (0.0, -9.80665, 0.0)
    shared_housing: SharedHousing | None = None
    start: Start | None = None

    @classmethod
    def pair(
        cls,
        bearing: Bearing,
        arrangement: Arrangement,
        *,
        spread: float,
        end_play: float = 0.0,
        other: Bearing | None = None,
        loads: Sequence[ShaftLoad] = (),
        shaft: Shaft,
        speed_rpm: Any,
        **fields: Any,
    ) -> Self:
        """Two bearings against each other, named left and right; the middle between their load centres is the shaft's origin.

        Parameters
        ----------
        bearing : Bearing
            The left bearing.
        arrangement : {'back to back', 'face to face'}
            Back to back: the wide faces of the outer rings, where the small ends of the rollers are, face each other, and the
            load centres lie far apart. Face to face: the large ends face each other.
        spread : float
            Distance between the load centres (m); a short one may be negative where the bearings stand face to face.
        end_play : float
            End play of the shaft between both (m); negative: preload. Each outer ring takes half of it.
        other : Bearing, optional
            The right bearing; the same by default.
        loads, shaft, speed_rpm
            As in `Assembly`.
        **fields
            Other fields of the `Assembly`, or of both `ShaftBearing`.
        """
        if arrangement not in ("back to back", "face to face"):
            raise InputError.of("arrangement", arrangement, "must be 'back to back' or 'face to face'")
        ends = ("right", "left") if arrangement == "back to back" else ("left", "right")
        placed = (
            {"bearing": bearing, "name": "left", "position": -0.5 * spread, "small_ends": ends[0]},
            {"bearing": other or bearing, "name": "right", "position": 0.5 * spread, "small_ends": ends[1]},
        )
        fields |= {"end_play": 0.5 * end_play, "loads": tuple(loads), "shaft": shaft, "speed_rpm": speed_rpm}
        return cls._of(placed, fields)

    @classmethod
    def rows(
        cls,
        bearing: Bearing,
        rows: Literal["TDO", "TDI", "TQO", "TQI"] | Sequence[Literal["left", "right"]],
        *,
        row_distance: float | Sequence[float],
        end_play: float = 0.0,
        loads: Sequence[ShaftLoad] = (),
        shaft: Shaft,
        speed_rpm: Any,
        **fields: Any,
    ) -> Self:
        """A bearing of two or more rows, named row_1 and so on from left to right; its middle is the shaft's origin.

        Parameters
        ----------
        bearing : Bearing
            One row. A catalogue's page of a double row gives the row's own C as that of both over 2^(7/9) = 1.715 (ISO 281).
        rows : {'TDO', 'TDI', 'TQO', 'TQI'} or sequence of {'left', 'right'}
            TDO: one double outer ring, the small ends face each other and the load centres lie far apart. TDI: one double inner
            ring, the large ends face each other. TQO and TQI: four rows, two TDI or two TDO. Else where the small ends of each
            row point, from left to right: ``("left", "left")`` are two rows in tandem.
        row_distance : float or sequence of float
            Distance of the roller-centre planes of neighbours (m): one for all, or each. A spacer is part of it.
        end_play : float
            End play of two rows against each other as the spacer sets it (m); negative: preload. Each row takes half of it.
        loads, shaft, speed_rpm
            As in `Assembly`.
        **fields
            Other fields of the `Assembly`, or of all `ShaftBearing`.

        Raises
        ------
        InputError
            If a number is not allowed, or rows lie within each other.

        Examples
        --------
        >>> import trbdyn as trb
        >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
        >>> push = trb.ShaftLoad(position=0.0, force=(0.0, -8000.0, 1500.0))
        >>> double = trb.Assembly.rows(
        ...     trb.cases.rig_30310(), "TDO", row_distance=0.032, end_play=-20e-6, loads=[push], shaft=shaft, speed_rpm=1500
        ... )
        >>> double.arrangement, [round(1e3 * one.position, 1) for one in double.bearings]
        ('back to back', [-25.5, 25.5])
        """
        if isinstance(rows, str):
            if rows not in ROWS:
                limit = f"must be one of {', '.join(ROWS)}, or where the small ends of each row point: ('left', 'left')"
                raise InputError.of("rows", rows, limit)
            ends = ROWS[rows]
        else:
            ends = tuple(rows)
        gaps = [row_distance] * (len(ends) - 1) if isinstance(row_distance, int | float) else list(row_distance)
        if len(gaps) != len(ends) - 1:
            raise InputError.of(
                "row_distance", len(gaps), f"must be one number, or {len(ends) - 1} for {len(ends)} rows"
            )
        planes = [sum(gaps[:index]) - 0.5 * sum(gaps) for index in range(len(ends))]
        offset = load_centre_offset(bearing)
        placed = (
            {"name": f"row_{k + 1}", "position": plane - (offset if end == "right" else -offset), "small_ends": end}
            for k, (end, plane) in enumerate(zip(ends, planes, strict=True))
        )
        fields |= {"end_play": 0.5 * end_play, "loads": tuple(loads), "shaft": shaft, "speed_rpm": speed_rpm}
        return cls._of(placed, {"bearing": bearing, **fields})

    @classmethod
    def _of(cls, placed: Iterable[dict[str, Any]], fields: dict[str, Any]) -> Self:
        """An assembly of bearings with fields of their own; the other ones are those of the assembly, or of all bearings."""
        own = {name: fields.pop(name) for name in OWN_FIELDS if name in fields}
        return cls(bearings=tuple(ShaftBearing(**{**fields, **one}) for one in placed), **own)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the bearings."""
        return tuple(one.name or f"bearing_{index + 1}" for index, one in enumerate(self.bearings))

    @property
    def arrangement(self) -> str:
        """'back to back' or 'face to face', for two bearings that stand against each other; else 'tandem' or 'mixed'."""
        sides = [one.side for one in sorted(self.bearings, key=lambda one: one.centre_plane)]
        if len(set(sides)) == 1:
            return "tandem"
        return "mixed" if len(sides) != 2 else "back to back" if sides[0] > 0.0 else "face to face"

    def acting(self, *, weight: bool = True) -> tuple[ShaftLoad, ...]:
        """The loads on the shaft, with its weight as one of them where it is wanted."""
        if not weight:
            return self.loads
        x, y, z = (scaled(part, self.shaft.mass) for part in self.gravity)
        return (ShaftLoad(position=self.shaft.mass_position, force=(x, y, z)), *self.loads)

    def scene(
        self, index: int, *, time: float | None = None, displacement: Sequence[float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    ) -> Scene:
        """A bearing alone, its inner ring held at a place, in the bearing's own frame.

        A bearing whose small ends point to the right is turned by half a turn about x against the shaft's frame: its y and z,
        speed and gravity change sign.

        Parameters
        ----------
        index : int
            Which bearing.
        time : float, optional
            Time at which speed and gravity are taken (s); by default they change as those of the assembly do.
        displacement : sequence of float, shape (5,)
            Place of its inner ring against its outer ring, in the bearing's frame (m, rad).
        """
        one, turned = self.bearings[index], -self.bearings[index].side
        speed, outer, x, y, z = (
            quantity if time is None else value_at(quantity, time)
            for quantity in (self.speed_rpm, self.outer_speed_rpm, *self.gravity)
        )
        place = [float(value) for value in displacement]
        return Scene(
            one.bearing,
            speed_rpm=scaled(speed, turned),
            outer_speed_rpm=scaled(outer, turned) if self.outer_turns else 0.0,
            displacement=(place[0], place[1], place[2]),
            misalignment_x=place[3],
            misalignment_y=place[4],
            lubricant=one.lubricant,
            effects=one.effects,
            start=one.start,
            growth=one.growth,
            elastic_cage=one.elastic_cage,
            housing=one.housing if self.shared_housing is None else self.shared_housing.seen_from(one),
            defects=one.defects,
            gravity=(x, scaled(y, turned), scaled(z, turned)),
        )

    @property
    def turned_over(self) -> tuple[str, ...]:
        """Names of the bearings whose own axes are turned by half a turn about x against those of the shaft, see `scene`."""
        return tuple(name for name, one in zip(self.names, self.bearings, strict=True) if one.side > 0.0)

    def _check(self) -> None:
        if len(self.bearings) < 2:
            limit = "must be two or more; a Scene with ring = 'free' is a shaft on one bearing"
            raise InputError.of("bearings", len(self.bearings), limit)
        if self.start is not None and self.start.kind != "state":
            limit = "must be 'state': how rollers and cages start is said by the start of each bearing"
            raise InputError.of(("start", "kind"), self.start.kind, limit)
        self.check_speeds()
        self._check_names()
        self._check_places()
        self._check_held()
        self._check_housings()

    def _check_names(self) -> None:
        for index, name in enumerate(self.names):
            if name in self.names[:index]:
                raise InputError.of(
                    ("bearings", index, "name"), name, "must differ from the names of the other bearings"
                )
            if not name.isidentifier():
                limit = "must be made of letters, digits and underscores: it names the bearing's results"
                raise InputError.of(("bearings", index, "name"), name, limit)

    def _check_places(self) -> None:
        """Rollers of two bearings do not share a piece of the shaft."""
        reach = [one.rollers_reach for one in self.bearings]
        for one, other in pairwise(sorted(range(len(reach)), key=lambda index: reach[index])):
            overlap = reach[one][1] - reach[other][0]
            if overlap > 0.0:
                least = self.bearings[other].position + overlap
                limit = (
                    f"must be >= {least:.6g}, or the rollers lie within those of {self.names[one]}; the rings need more "
                    "(load centre, m)"
                )
                raise InputError.of(("bearings", other, "position"), self.bearings[other].position, limit)

    def _check_housings(self) -> None:
        """One outer ring at least has a place along and across the shaft, or all that moves would leave it."""
        if self.shared_housing is not None:
            self._check_shared_housing(self.shared_housing)
            return
        for name in ("support_radial", "support_axial"):
            stiffnesses = [math.inf if one.housing is None else getattr(one.housing, name) for one in self.bearings]
            if not max(stiffnesses) > 0.0:
                limit = (
                    "must be > 0 in one bearing at least: nothing else holds shaft and housings in their place (N/m)"
                )
                raise InputError.of(("bearings", 0, "housing", name), 0.0, limit)

    def _check_shared_housing(self, housing: SharedHousing) -> None:
        for index, one in enumerate(self.bearings):
            if one.housing is not None:
                limit = "must not be given with a shared_housing, in which all outer rings sit"
                raise InputError.of(("bearings", index, "housing"), one.housing, limit)
            if one.spring is not None:
                limit = (
                    "must not be given with a shared_housing: an outer ring that slides in a housing that moves is a body of its "
                    "own, which is not simulated; give an end_play"
                )
                raise InputError.of(("bearings", index, "spring"), one.spring, limit)
        for name, of in (("support_radial", "N/m"), ("support_axial", "N/m"), ("support_tilt", "N m/rad")):
            if not getattr(housing, name) > 0.0:
                limit = f"must be > 0: nothing else holds shaft and housing in their place ({of})"
                raise InputError.of(("shared_housing", name), getattr(housing, name), limit)

    def _check_held(self) -> None:
        """Axial forces that never hold the shaft, as far as it can be told without an equilibrium."""
        forces = [load.force[2] for load in self.loads]
        if not all(is_constant(part) for part in (*forces, self.gravity[2])):
            return
        axial = sum(value_at(part, 0.0) for part in forces) + self.shaft.mass * value_at(self.gravity[2], 0.0)
        sides = {one.side for one in self.bearings}
        if len(sides) == 1:
            way = self.bearings[0].small_ends
            side = sides.pop()
            if side * axial <= 0.0:
                limit = (
                    f"must have axial forces to the {way} in sum (force[2] {'>' if side > 0.0 else '<'} 0): the small ends of "
                    f"all bearings point there, and nothing else holds the shaft along its axis (N)"
                )
                raise InputError.of("loads", round(axial, 9), limit)
            return
        play = sum(one.end_play for one in self.bearings)
        loaded = any(any(values_of(part)) for load in self.loads for part in (*load.force, *load.moment)) or any(
            any(values_of(part)) for part in self.gravity
        )
        if play >= 0.0 and not loaded and all(one.spring is None for one in self.bearings):
            limit = "must be < 0 in sum (preload): without a load on the shaft nothing is pressed together (m)"
            raise InputError.of(("bearings", 0, "end_play"), self.bearings[0].end_play, limit)

    def quantities(self) -> dict[str, float | History]:
        """Everything that may change in time, by the field's name."""
        found: dict[str, float | History] = {"speed_rpm": self.speed_rpm}
        if self.outer_turns:
            found["outer_speed_rpm"] = self.outer_speed_rpm
        for index, load in enumerate(self.loads):
            for name, parts in (("force", load.force), ("moment", load.moment)):
                found |= {f"loads[{index}].{name}[{axis}]": part for axis, part in enumerate(parts)}
        return found | {f"gravity[{axis}]": part for axis, part in enumerate(self.gravity)}

    @property
    def parts(self) -> dict[str, ShaftBearing]:
        """The bearings by the beginnings of their paths in a study: ``bearings[0].`` and so on."""
        return {f"bearings[{index}].": one for index, one in enumerate(self.bearings)}

    @property
    def part(self) -> ShaftBearing:
        """The first bearing."""
        return self.bearings[0]

    def with_part(self, prefix: str, **changes: Any) -> Self:
        """The assembly with fields of a bearing changed."""
        kept = {key: one.replace(**changes) if key == prefix else one for key, one in self.parts.items()}
        return self.replace(bearings=tuple(kept.values()))

    def tables(self) -> dict[str, Any]:
        """The tables of a case file; what was assumed is left out, so that it follows the bearing's size."""
        values = self.to_dict()
        own = {name: values.pop(name) for name in ("shaft", "bearings", "loads")}
        bearings = [
            table | {"bearing": one.bearing.inputs()} for table, one in zip(own["bearings"], self.bearings, strict=True)
        ]
        return {**own, "bearings": bearings, "assembly": values}

    def loaded(self, speed_rpm: float, axial_load: float, radial_load: float) -> dict[str, Any]:
        """Overrides of a study that put another speed (rpm) and a force (N) on its centre of mass in place of its own: along the
        shaft, and across it downwards (towards -y).
        """
        load = ShaftLoad(position=self.shaft.mass_position, force=(0.0, -radial_load, axial_load))
        return {"assembly.speed_rpm": speed_rpm, "loads": [load.to_dict()]}

    def with_axial_load(self, axial_load: float) -> Self:
        """The assembly with another force along its shaft (N), on the centre of mass; what acts across the shaft stays."""
        across = [one.replace(force=(*one.force[:2], 0.0)) for one in self.loads]
        along = ShaftLoad(position=self.shaft.mass_position, force=(0.0, 0.0, axial_load))
        return self.replace(loads=(*across, along))

    def orbit_speed(self, time: float) -> float:
        """Speed at which the slowest of the cages goes round the axis in pure rolling (rad/s)."""
        ratios = [one.bearing.geometry.cage_speed_ratio for one in self.bearings]
        inner, outer = (value_at(speed, time) for speed in (self.speed_rpm, self.outer_speed_rpm))
        return min((ratio * (inner - outer) + outer for ratio in ratios), key=abs) * math.pi / 30.0

    @property
    def title(self) -> str:
        """Bearings, arrangement and speed in words."""
        kinds = ", ".join(f"{name} {one.bearing.name}" for name, one in zip(self.names, self.bearings, strict=True))
        given = self.turning_rpm
        speed = f"{given:g} rpm" if isinstance(given, int | float) else "a speed that changes in time"
        of = "" if self.turning_ring == "shaft" else " of the outer rings"
        both = f", outer rings {self._outer_text()}" if self.outer_turns and not of else ""
        return f"{kinds}, {self.arrangement}, {speed}{of}{both}"

    def _outer_text(self) -> str:
        given = self.outer_speed_rpm
        return f"{given:g} rpm" if isinstance(given, int | float) else "at a speed that changes in time"

    def __repr__(self) -> str:
        return f"<Assembly: {self.title}>"

    __str__ = __repr__

    def _shown(self) -> Shown:
        rows = [
            ("mass of the shaft", f"{self.shaft.mass:g}", "kg", f"centre at {1e3 * self.shaft.mass_position:.4g} mm")
        ]
        for name, one in zip(self.names, self.bearings, strict=True):
            set_by = f"end play {1e6 * one.end_play:.4g} µm" if one.spring is None else f"spring {one.spring.force:g} N"
            rows.append(
                (f"{name}, load centre", f"{1e3 * one.position:.4g}", "mm", f"small ends {one.small_ends}, {set_by}")
            )
            if one.outer_face is not None:
                where = "at the small ends, by a of its page"
                rows.append((f"{name}, face of the outer ring", f"{1e3 * one.outer_face:.4g}", "mm", where))
        if (around := self.shared_housing) is not None:
            row = ("mass of the housing", f"{around.mass:g}", "kg", f"centre at {1e3 * around.mass_position:.4g} mm")
            rows.insert(1, row)
        for index, load in enumerate(self.loads):
            force = ", ".join(f"{part:.5g}" if isinstance(part, int | float) else "changes" for part in load.force)
            note = f"at {1e3 * load.position:.4g} mm"
            if any(load.offset):
                note += f", off the axis by {', '.join(f'{1e3 * part:.4g}' for part in load.offset)} mm"
            if any(moment := [0.0 if isinstance(part, int | float) and not part else part for part in load.moment]):
                told = ", ".join(f"{part:.5g}" if isinstance(part, int | float) else "changes" for part in moment)
                note += f", with the moments {told} N m about x, y"
            rows.append((f"load {index + 1}: x, y, z", force, "N", note))
        return Shown(f"Assembly: {self.title}", tuple(rows))

    def __hash__(self) -> int:
        return hash(self.fingerprint)


Subject = Scene | Assembly
"""What can be simulated: one bearing, or several on a shaft."""


def assembly_of(subject: object) -> Assembly | None:
    """A subject that is an assembly; None for any other."""
    return subject if isinstance(subject, Assembly) else None


def subject_from_dict(values: Mapping[str, Any]) -> Subject:
    """The scene or the assembly that `to_dict` has described."""
    return (Assembly if "shaft" in values else Scene).from_dict(values)
