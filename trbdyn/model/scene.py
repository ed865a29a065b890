"""A scene: one bearing, what acts on it, and how it starts."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import field_validator

from trbdyn.base.shown import Shown, field_rows
from trbdyn.base.validation import Model, unit
from trbdyn.errors import MISSING, InputError, Path
from trbdyn.model.bearing import Bearing
from trbdyn.model.defect_rows import form_rows
from trbdyn.model.defects import Defect
from trbdyn.model.effects import Effects
from trbdyn.model.elastic_cage import ElasticCage, check_elastic_cage
from trbdyn.model.flatten import parameter_block
from trbdyn.model.growth import Growth, grown_pocket, plays, running_pockets, strains
from trbdyn.model.lubricants.shipped import AnyLubricant, vg100
from trbdyn.model.motion import (
    History,
    Quantity,
    check_size,
    common_period,
    is_constant,
    knot_times,
    periods_of,
    settled_time,
    value_at,
    values_of,
)
from trbdyn.model.ring_body import Housing, RingBody, check_free_ring, check_housing
from trbdyn.model.rotating_load import RotatingLoad, check_sign
from trbdyn.model.shaft import angle_turned, turns
from trbdyn.model.start import Start
from trbdyn.model.turning import MAX_SPEED_RPM, TurningRings

__all__ = ["MAX_GRAVITY", "MAX_SPEED_RPM", "RotatingLoad", "Scene", "Start"]

MAX_GRAVITY = 1e7
"""Largest part of gravity (m/s2), a million times the usual: no machine shakes harder, and nothing overflows."""
LEAST_ACROSS = 1e-3
"""Radial load (N) of a ring with clearance below which the balance of forces does not say where it stands."""


class Scene(TurningRings, Model):
    """One bearing, what acts on it, and how it starts. Every quantity is a number or a `History`.

    Frame: origin at the common apex of the cones, or in the middle of a cylindrical bearing; z along the bearing axis towards the
    rollers' large ends; positive speed about +z. Loads act on the inner ring.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    speed_rpm : float or History
        Speed of the inner ring (rpm).
    outer_speed_rpm : float or History
        Speed of the outer ring about the bearing's axis (rpm), as in a wheel hub: 0 by default, at rest.
    axial_load : float or History
        Axial load Fa (N), presses the inner ring towards -z; must be > 0 unless `displacement` gives the axial
        position.
    radial_load : float or History
        Magnitude of the radial load Fr (N).
    radial_direction_deg : float or History
        Direction of the radial load on the inner ring, from +x towards +y (deg); 90: loaded zone on top.
    misalignment_x, misalignment_y : float or History
        Rotation of the inner ring about x and y, through the roller-centre plane (rad).
    moment_x, moment_y : float or History, optional
        Moment on the inner ring about x or y (N m): the ring's rotation follows from it and must not be prescribed.
    rotating_load : RotatingLoad, optional
        A radial load that rotates; needs ``ring = 'follows'``.
    displacement : tuple of float, History or None, shape (3,), optional
        Position of the inner ring along x, y, z (m), in place of loads. Where an entry is None, the load along it
        decides: ``(None, None, -20e-6)`` is a preload by displacement under which `radial_load` acts. TOML writes
        'free' for None. The ring of an NU or N without an axial load is at z = 0 unless its position is given.
    unloaded : {'refused', 'rests'}
        What the inner ring does under an axial load that is too small to hold it, for instance 0. Refused: an error. Rests: the
        ring rests where rollers and rings just touch at this speed. The missing axial force, and a radial load, are then carried
        by what else holds the shaft, such as a second bearing without play. A ring that moves within an end play is not
        modelled.
    lubricant : Lubricant or str
        The oil at its temperature, or the name of one of `trbdyn.lubricants.OILS` at 60 C, such as ``"vg68"``.
    effects : Effects
        Switches and choices; `Effects.standard` by default.
    start : Start
        How a run starts.
    ring : {'held', 'follows', 'free'}
        Held: the ring stays at its equilibrium at the start, as in the paper. Follows: it moves through the equilibria
        of its load history, with evenly spaced rollers; its path lies within `trbdyn.statics.ring_path.PATH_TOLERANCE` of them.
        Free: it is a body with mass that moves under its loads, its weight and the forces of its rollers; it begins in the
        equilibrium of the loads at the start, and no load needs to hold it later.
    ring_body : RingBody, optional
        Mass, inertia and unbalance of a free ring; needed with ``ring = 'free'``.
    housing : Housing, optional
        Mass, inertia and support of an outer ring that moves with its housing; without it the outer ring is held in space.
    torque : float or History, optional
        Torque on a free ring about its axis (N m), in place of a prescribed speed: `speed_rpm` is then its speed at the start.
    growth : Growth, optional
        Temperatures of the bearing's parts, and growth of the cage by its rotation, for the plays of the pockets; without it
        all dimensions are as given.
    elastic_cage : ElasticCage, optional
        Natural modes by which the cage deforms; without it the cage is rigid.
    defects : tuple of Pit, DepthMap or Waviness
        Where raceways and rollers are off their true form; by default nowhere. The equilibrium at the start has none.
    gravity : tuple of float or History, shape (3,)
        Acceleration of gravity (m/s2), each part from -1e7 to 1e7; acts if `effects.gravity`.

    Raises
    ------
    InputError
        If anything is wrong or does not fit together.
    """

    _root: ClassVar[str | None] = ""

    bearing: Bearing
    speed_rpm: Annotated[Quantity, unit("rpm")]
    outer_speed_rpm: Annotated[Quantity, unit("rpm")] = 0.0
    axial_load: Annotated[Quantity, unit("N")] = 0.0
    radial_load: Annotated[Quantity, unit("N")] = 0.0
    radial_direction_deg: Annotated[Quantity, unit("deg")] = 90.0
    misalignment_x: Annotated[Quantity, unit("rad")] = 0.0
    misalignment_y: Annotated[Quantity, unit("rad")] = 0.0
    moment_x: Annotated[Quantity | None, unit("N m")] = None
    moment_y: Annotated[Quantity | None, unit("N m")] = None
    rotating_load: RotatingLoad | None = None
    displacement: tuple[Quantity | None, Quantity | None, Quantity | None] | None = None
    unloaded: Literal["refused", "rests"] = "refused"
    lubricant: AnyLubricant = vg100()
    effects: Effects = Effects()
    start: Start = Start()
    ring: Literal["held", "follows", "free"] = "held"
    ring_body: RingBody | None = None
    housing: Housing | None = None
    torque: Annotated[Quantity | None, unit("N m")] = None
    growth: Growth | None = None
    elastic_cage: ElasticCage | None = None
    defects: tuple[Defect, ...] = ()
    gravity: tuple[Quantity, Quantity, Quantity] = (0.0, -9.80665, 0.0)

    def __init__(self, bearing: Any = MISSING, **fields: Any) -> None:
        super().__init__(**fields if bearing is MISSING else {"bearing": bearing, **fields})

    def __hash__(self) -> int:
        return hash(self.fingerprint)

    @field_validator("displacement", mode="before")
    @classmethod
    def _free_entries(cls, given: Any) -> Any:
        if not isinstance(given, list | tuple):
            return given
        return tuple(None if isinstance(entry, str) and entry == "free" else entry for entry in given)

    def __repr__(self) -> str:
        return f"<Scene: {self.title}>"

    __str__ = __repr__

    @property
    def title(self) -> str:
        """Bearing, speed, loads and oil in words."""
        given = (
            ("speed", self.speed_rpm, "rpm"),
            ("outer ring", self.outer_speed_rpm, "rpm"),
            ("axial load", self.axial_load, "N"),
            ("radial load", self.radial_load, "N"),
        )
        said = [
            f"{name} {value:g} {symbol}" if isinstance(value, int | float) else f"{name} changing in time"
            for name, value, symbol in given
            if name == "speed" or value
        ]
        return f"{self.bearing.name}, {', '.join(said)}, {self._part('lubricant')}"

    def _shown(self) -> Shown:
        parts = ("bearing", "lubricant", "effects", "start")
        own = tuple(row for row in field_rows(self) if row[0].partition(".")[0] not in parts)
        shown = {name: getattr(self, name)._shown() for name in parts}
        folded = (replace(shown[name], title=f"{name}: {self._part(name)}") for name in parts)
        return Shown(f"Scene: {self.title}", own, parts=tuple(folded))

    def _part(self, name: str) -> str:
        """A part in a few words."""
        if name == "bearing":
            return self.bearing._title()
        if name == "effects":
            usual = Effects.standard()
            changed = [key for key in Effects.model_fields if getattr(self.effects, key) != getattr(usual, key)]
            return f"standard but for {', '.join(changed)}" if changed else "standard"
        if name == "start":
            return self.start.kind
        return self.lubricant._title()

    @property
    def moments(self) -> tuple[float | History | None, float | History | None]:
        """Moments about x and y (N m); None where the ring's rotation is prescribed."""
        return self.moment_x, self.moment_y

    @property
    def ring_is_placed(self) -> tuple[bool, bool, bool, bool, bool]:
        """Which coordinates of the ring (x, y, z, rotation about x and y) are prescribed; the others follow from
        loads.
        """
        if self.ring == "free":
            return False, False, False, False, False
        x, y, z = self.displacement or (None, None, None)
        return x is not None, y is not None, z is not None, self.moment_x is None, self.moment_y is None

    def ring_quantities(self) -> dict[str, float | History]:
        """Everything that the ring's equilibrium depends on, but for the load that rotates; by the field's name."""
        found: dict[str, float | History | None] = {
            "axial_load": self.axial_load,
            "radial_load": self.radial_load,
            "radial_direction_deg": self.radial_direction_deg,
            "moment_x": self.moment_x,
            "moment_y": self.moment_y,
            "misalignment_x": self.misalignment_x,
            "misalignment_y": self.misalignment_y,
            **{f"displacement[{axis}]": place for axis, place in enumerate(self.displacement or ())},
            "speed_rpm": self.speed_rpm,
        }
        if self.outer_turns:
            found["outer_speed_rpm"] = self.outer_speed_rpm
        if self.rotating_load is not None:
            found["rotating_load.load"] = self.rotating_load.load
        found["torque"] = self.torque
        return {name: quantity for name, quantity in found.items() if quantity is not None}

    def quantities(self) -> dict[str, float | History]:
        """Everything that may change in time, by the field's name."""
        return self.ring_quantities() | {f"gravity[{axis}]": part for axis, part in enumerate(self.gravity)}

    def rotating_load_angle(self, time: float) -> float:
        """Direction of the load that rotates (rad)."""
        rotating = self.rotating_load
        if rotating is None:
            return 0.0
        first = math.radians(rotating.direction_deg)
        if rotating.frequency_hz is not None:
            return first + 2.0 * math.pi * rotating.frequency_hz * time
        return first + rotating.turns * (self.start_shaft_angle + self.shaft_turn(time))

    @property
    def parts(self) -> dict[str, Self]:
        """The bearing as `Assembly.parts` gives several: by the beginning of its paths in a study, which is empty."""
        return {"": self}

    @property
    def names(self) -> tuple[str, ...]:
        """The name of the bearing as `Assembly.names` gives those of several: it is empty."""
        return ("",)

    @property
    def part(self) -> Self:
        """The bearing; of an assembly the first one."""
        return self

    def with_part(self, prefix: str, **changes: Any) -> Self:
        """The scene with fields of its bearing changed."""
        return self.replace(**changes)

    def tables(self) -> dict[str, Any]:
        """The tables of a case file; what was assumed is left out, so that it follows the bearing's size."""
        values = self.to_dict()
        own = {name: values.pop(name) for name in ("bearing", "lubricant", "effects", "start")}
        return {**own, "bearing": self.bearing.inputs(), "scene": values}

    def loaded(self, speed_rpm: float, axial_load: float, radial_load: float) -> dict[str, Any]:
        """Overrides of a study that put other speed (rpm) and loads (N) in place of its own."""
        return {"scene.speed_rpm": speed_rpm, "scene.axial_load": axial_load, "scene.radial_load": radial_load}

    def with_axial_load(self, axial_load: float) -> Self:
        """The scene with another axial load (N)."""
        return self.replace(axial_load=axial_load)

    def orbit_speed(self, time: float) -> float:
        """Speed at which rollers and cage go round the axis in pure rolling (rad/s)."""
        inner, outer = (value_at(speed, time) for speed in (self.speed_rpm, self.outer_speed_rpm))
        return (self.bearing.geometry.cage_speed_ratio * (inner - outer) + outer) * math.pi / 30.0

    def shaft_turn(self, time: float) -> float:
        """Angle that the shaft has turned by since the start (rad)."""
        return angle_turned(self.speed_rpm, self.start.time, time)

    @property
    def modes_from_file(self) -> bool:
        """Whether the modes of an elastic cage come from a file of their own: what reads a result does not open it."""
        elastic = self.elastic_cage
        return elastic is not None and (elastic.file is not None or self.bearing.cage.drawing is not None)

    @property
    def running_plays(self) -> tuple[float, float]:
        """Radial and circumferential play of the pocket that most rollers have (m): Cpr and Cpc of the running bearing."""
        bearing, pocket = self.bearing, self.bearing.pocket
        if self.growth is not None:
            pocket = grown_pocket(bearing, pocket, strains(self, self.growth))
        return plays(bearing, pocket)

    @property
    def start_shaft_angle(self) -> float:
        """Angle of the shaft at the start (rad)."""
        if self.start.kind != "state":
            return 0.0
        return -self.shaft_turn(0.0) if self.start.shaft_angle is None else self.start.shaft_angle

    @property
    def settled(self) -> float:
        """From when on nothing changes any more but what repeats (s); not before the start."""
        return settled_time(list(self.quantities().values()), self.start.time)

    @cached_property
    def period(self) -> float | None:
        """Common period of everything that repeats (s); None if nothing does.

        Raises
        ------
        InputError
            If two quantities never repeat together.
        """
        return common_period(self._rotation_period() | periods_of(self.quantities()))

    def _rotation_period(self) -> dict[str, float]:
        rotating = self.rotating_load
        if rotating is None or not any(values_of(rotating.load)):
            return {}
        if rotating.frequency_hz is not None:
            return {"rotating_load.frequency_hz": 1.0 / abs(rotating.frequency_hz)} if rotating.frequency_hz else {}
        speed = self.speed_rpm
        if isinstance(speed, History) and speed.repeats:
            span = speed.times[-1] - speed.times[0]
            turned = rotating.turns * turns(speed, speed.times[0], speed.times[-1])
            if abs(turned - round(turned)) > 1e-9:
                limit = (
                    f"must turn a whole number of times in a period of speed_rpm ({span:g} s), not {turned:.9g} times"
                )
                raise InputError.of(("rotating_load", "turns"), rotating.turns, limit)
            return {}
        final = speed.values[-1] if isinstance(speed, History) else speed
        return {"rotating_load": 60.0 / abs(final * rotating.turns)} if final * rotating.turns else {}

    def _check(self) -> None:
        self._place_floating_ring()
        self._check_motion()
        check_free_ring(self)
        check_housing(self)
        check_elastic_cage(self)
        self._check_load()
        self._check_planar()
        self._check_start()
        if self.growth is not None:
            running_pockets(self)
        if self.bearing.cage.unbalance > 0.0 and self.effects.guidance != "rollers":
            limit = "must be 0 where a land guides the cage: its axis passes through the centre of mass (kg m)"
            raise InputError.of(("bearing", "cage", "unbalance"), self.bearing.cage.unbalance, limit)
        _ = self.period
        if self.effects.films and self.effects.rolling_resistance and self.lubricant.pressure_coefficient <= 0.0:
            raise InputError.of(
                ("lubricant", "pressure_coefficient"),
                0.0,
                "must be > 0 for rolling resistance; or switch that off (1/Pa)",
            )
        parameter_block(self)
        form_rows(self)

    def _check_motion(self) -> None:
        self.check_speeds()
        if self.outer_turns:
            self._check_outer()
        for place, quantity in enumerate(self.gravity):
            check_size(("gravity", place), quantity, MAX_GRAVITY, "m/s2")
        for axis, moment, turn in (
            ("x", self.moment_x, self.misalignment_x),
            ("y", self.moment_y, self.misalignment_y),
        ):
            if moment is not None and turn != 0.0:
                raise InputError.of(
                    f"moment_{axis}", moment, f"must not be given together with misalignment_{axis} (N m)"
                )
            check_size(f"misalignment_{axis}", turn, math.radians(5.0), "rad")
        for place, given in enumerate(self.displacement or ()):
            check_size(("displacement", place), 0.0 if given is None else given, self.bearing.roller.diameter, "m")

    def _check_outer(self) -> None:
        """What is not known yet of a bearing whose outer ring turns."""
        if self.start.kind == "state" and not is_constant(self.outer_speed_rpm):
            limit = "must be constant in a run from a state: the angle of the outer ring is counted from t = 0 (rpm)"
            raise InputError.of("outer_speed_rpm", self.outer_speed_rpm, limit)
        if self.effects.oil_fill > 0.0:
            limit = "must be 0 with a turning outer ring: the oil is at rest in the law of drag"
            raise InputError.of(("effects", "oil_fill"), self.effects.oil_fill, limit)

    def _check_load(self) -> None:
        x, y, z, *_ = self.ring_is_placed
        if self.displacement is not None and not (x or y or z):
            raise InputError.of("displacement", self.displacement, "must give one entry at least (m)")
        check_sign("axial_load", self.axial_load)
        check_sign("radial_load", self.radial_load)
        if z and any(values_of(self.axial_load)):
            raise InputError.of(
                "axial_load", self.axial_load, "must be 0 where displacement gives the axial position (N)"
            )
        turning = 0.0 if self.rotating_load is None else self.rotating_load.load
        for path, load in ((("radial_load",), self.radial_load), (("rotating_load", "load"), turning)):
            if (x or y) and any(values_of(load)):
                limit = "must be 0 where displacement gives a radial position; set those entries None (N)"
                raise InputError.of(path, load, limit)
        self._check_held()
        if self.unloaded == "rests" and z:
            raise InputError.of("unloaded", "rests", "must be 'refused' where displacement gives the axial position")
        if self.bearing.is_cylindrical:
            self._check_cylindrical()
        elif not any(values_of(self.radial_load)) and not any(values_of(turning)):
            self.check_capacity()

    def _check_held(self) -> None:
        if self.ring != "held" or all(self.ring_is_placed):
            return
        if self.rotating_load is not None and any(values_of(self.rotating_load.load)):
            raise InputError.of("ring", "held", "must be 'follows' with a rotating_load")
        for name, quantity in self.ring_quantities().items():
            if name != "speed_rpm" and not is_constant(quantity):
                field, _, place = name.partition("[")
                path: Path = (field, int(place[:-1])) if place else (field,)
                limit = "must be constant where the ring is held at an equilibrium; set ring = 'follows'"
                raise InputError.of(path, quantity, limit)

    def _place_floating_ring(self) -> None:
        """Without an axial load an NU or N stands in the middle, where nothing else is said: no rib of it holds its ring."""
        x, y, z = self.displacement or (None, None, None)
        floats = self.ring != "free" and self.unloaded == "refused" and self.bearing.ribs.flanges in ("NU", "N")
        if floats and z is None and not any(values_of(self.axial_load)):
            self.__dict__["displacement"] = (x, y, 0.0)

    def _check_cylindrical(self) -> None:
        """What is not known of cylindrical bearings, and what holds their rings along the axis."""
        for name, given, usual in (("growth", self.growth, None), ("unloaded", self.unloaded, "refused")):
            if given != usual:
                allowed = f"must be {usual!r} for cylindrical rollers: it is made for rollers that a cup's slope holds"
                raise InputError.of(name, given, allowed)
        self._check_held_across()
        if self.ring_is_placed[2]:
            return
        flanges, supported = (
            self.bearing.ribs.flanges,
            self.ring_body is not None and self.ring_body.support_axial > 0.0,
        )
        # no load needs to hold a free ring later; a state says where it is
        times = [self.start.time] if self.ring == "free" else knot_times([self.axial_load], self.start.time)
        if self.ring == "free" and self.start.kind == "state":
            return
        axial = [value_at(self.axial_load, time) for time in times]
        if min(axial) > 0.0 and flanges in ("NU", "N") and not supported:
            allowed = f"must be 0: a bearing {flanges} has no ribs that would carry it, but NJ and NUP have (N)"
            raise InputError.of("axial_load", self.axial_load, allowed)
        for name in ("back_rib", "front_rib"):
            if max(axial) > 0.0 and not getattr(self.effects, name):
                allowed = "must be true with an axial load on cylindrical rollers: a rib of each ring carries it"
                raise InputError.of(("effects", name), False, allowed)
        if min(axial) <= 0.0 and not supported:
            allowed = (
                "must be > 0 for a bearing NJ or NUP, as nothing else holds its ring along the axis; or give its axial position, "
                "displacement = (None, None, 0.0), or a free ring a support, ring_body.support_axial (N)"
            )
            raise InputError.of("axial_load", self.axial_load, allowed)

    def _check_held_across(self) -> None:
        """A radial load that goes leaves a ring with clearance anywhere in it; an axial load centres it by the ribs."""
        x, y, z, *_ = self.ring_is_placed
        if self.rotating_load is not None or x or y or not z:
            return
        loads = {time: value_at(self.radial_load, time) for time in knot_times([self.radial_load], self.start.time)}
        time = min(loads, key=loads.__getitem__)
        if self.bearing.radial_clearance > 0.0 and loads[time] < LEAST_ACROSS and max(loads.values()) > 0.0:
            when = "" if is_constant(self.radial_load) else f" at {time:g} s"
            allowed = (
                f"must be >= {LEAST_ACROSS:g}{when}: with less, nothing says where in its clearance the ring is; keep a "
                "small load, or let the ring move, ring = 'free' (N)"
            )
            raise InputError.of("radial_load", loads[time], allowed)

    def check_capacity(self) -> None:
        """Refuse loads that a tapered bearing cannot hold by itself: it needs ``Fa > Fr tan(alpha)`` at all times. A scene with
        other loads can be made, as `trbdyn.rating` gives it the basic life of ISO 281; what needs an equilibrium refuses it.

        Raises
        ------
        InputError
            If they cannot be held; it names the load, and the time where loads change.
        """
        if self.bearing.is_cylindrical or self.unloaded == "rests" or self.ring_is_placed[2]:
            return
        slope = math.tan(math.radians(self.bearing.cup_half_angle_deg))
        turning = 0.0 if self.rotating_load is None else self.rotating_load.load
        parts = [self.axial_load, self.radial_load, turning]
        steady = all(is_constant(part) for part in parts)
        times = [self.start.time] if self.ring == "free" else knot_times(parts, self.start.time)
        if self.ring == "free" and self.start.kind == "state":
            return
        for time in times:
            axial, radial = value_at(self.axial_load, time), value_at(self.radial_load, time)
            when = "" if steady else f" at {time:g} s"
            if axial <= 0.0:
                raise InputError.of(
                    "axial_load",
                    round(axial, 9) + 0.0,
                    f"must be > 0{when}: nothing else holds rollers and rings together, unless unloaded = 'rests'; or give the "
                    "ring's axial position, as an adjusted pair of bearings has it: displacement = (None, None, -20e-6) (N)",
                )
            most = axial / slope
            if radial >= most:
                limit = f"must be < {most:.6g}{when}: axial_load / tan(cup half angle), all it can carry (N)"
                raise InputError.of("radial_load", radial, limit)
            largest = radial + value_at(turning, time)
            if largest >= most:
                limit = (
                    f"must be < {most - radial:.6g}{when}: with radial_load up to axial_load / tan(cup half angle) (N)"
                )
                raise InputError.of(("rotating_load", "load"), largest - radial, limit)

    def _check_planar(self) -> None:
        """Planar motion freezes axial positions and tilts of the rollers at those of the start."""
        if not self.effects.planar:
            return
        for name in ("misalignment_x", "misalignment_y", "moment_x", "moment_y"):
            quantity = getattr(self, name)
            if quantity is not None and any(values_of(quantity)):
                limit = "must be 0 with effects.planar = true: tilts are frozen, but a tilted ring changes each of them"
                raise InputError.of(name, quantity, limit)
        axial = self.axial_load if self.displacement is None else (self.displacement[2] or 0.0)
        if not is_constant(axial):
            name = "axial_load" if self.displacement is None else "displacement"
            limit = "must be constant along z with effects.planar = true: axial positions of the rollers are frozen"
            raise InputError.of(name, axial, limit)

    def _check_start(self) -> None:
        if self.start.kind == "unequal" and self.effects.bodies == "rollers_and_spacer":
            limit = "must be 'equal' or 'state' with effects.bodies = 'rollers_and_spacer', which holds rollers at even spacing"
            raise InputError.of(("start", "kind"), "unequal", limit)
        if self.start.kind == "whirl" and not self.effects.has_cage:
            path: Path = ("start", "kind")
            raise InputError.of(path, "whirl", "needs a cage: effects.bodies = 'rollers_and_cage'")
        land, play = self.bearing.land, self.bearing.cage.play_radial
        most = (land.clearance - land.contact_film) / play
        if self.start.kind == "whirl" and self.effects.guidance != "rollers" and self.start.eccentricity > most:
            limit = f"must be <= {most:.4g}: bearing.land.clearance less contact_film over bearing.cage.play_radial"
            raise InputError.of(
                ("start", "eccentricity"), self.start.eccentricity, f"{limit}, as a land guides the cage (1)"
            )
