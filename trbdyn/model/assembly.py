"""Several bearings on one rigid shaft, what acts on the shaft, and how the bearings are set against each other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Final, Literal, Self

from pydantic import field_validator, model_validator

from trbdyn.base.shown import Shown
from trbdyn.base.validation import Model, Number, unit
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.core_table import parameter
from trbdyn.model.defects import Defect
from trbdyn.model.effects import Effects
from trbdyn.model.elastic_cage import ElasticCage
from trbdyn.model.flatten import scaled
from trbdyn.model.growth import Growth
from trbdyn.model.lubricants import Lubricant, vg100
from trbdyn.model.motion import History, Quantity, is_constant, value_at, values_of
from trbdyn.model.ring_body import Housing, RingBody, check_inertias
from trbdyn.model.scene import Scene, oil_by_name
from trbdyn.model.start import Start
from trbdyn.model.turning import TurningRings

__all__ = [
    "Assembly",
    "PreloadSpring",
    "Shaft",
    "ShaftBearing",
    "ShaftLoad",
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
OWN_FIELDS: Final = ("outer_speed_rpm", "torque", "gravity")
"""Fields of an `Assembly` beside those that its makers name."""
MAX_END_PLAY: Final = 3e-4
"""Largest end play or preload of one bearing by displacement (m): where a shaft goes farther, the rollers of the other bearing
have no equilibrium in the wide gap."""


class Shaft(Model):
    """The rigid shaft, with everything that turns with it: inner rings, gears, rotor.

    Parameters
    ----------
    mass : float
        Mass (kg).
    inertia_axial, inertia_transverse : float
        Moments of inertia about the axis, and about a transverse axis through the centre of mass (kg m2).
    mass_position : float
        Position of the centre of mass along the shaft (m).
    unbalance : float
        Mass times radius (kg m), in the plane of the centre of mass. It acts in runs; the drive keeps the speed against it, so it
        is refused together with a torque.
    unbalance_angle_deg : float
        Angle of the unbalance from +x towards +y where the shaft's angle is zero (deg).
    damping : float
        Damping between the shaft and the surroundings, of translations of its centre of mass (N s/m). It stands for whatever else
        takes energy from the shaft's vibrations; none by default.
    damping_turns : float
        The same of turns about transverse axes (N m s).

    Raises
    ------
    InputError
        If no body can have these moments of inertia: the axial one is at most twice the transverse one.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> round(1e4 * shaft.inertia_axial, 3)
    18.75
    """

    mass: Annotated[Number, parameter("ring_mass", gt=0.0)]
    inertia_axial: Annotated[Number, parameter("ring_inertia_axial", gt=0.0)]
    inertia_transverse: Annotated[Number, parameter("ring_inertia_transverse", gt=0.0)]
    mass_position: Annotated[Number, unit("m", ge=-100.0, le=100.0)] = 0.0
    unbalance: Annotated[Number, parameter("ring_unbalance")] = 0.0
    unbalance_angle_deg: Annotated[Number, unit("deg", ge=-360.0, le=360.0)] = 0.0
    damping: Annotated[Number, parameter("ring_damping")] = 0.0
    damping_turns: Annotated[Number, parameter("ring_damping_turns")] = 0.0

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_inertias(self.inertia_axial, self.inertia_transverse)
        return self

    @classmethod
    def hollow_cylinder(
        cls,
        *,
        mass: float,
        inner_diameter: float = 0.0,
        outer_diameter: float,
        length: float,
        mass_position: float = 0.0,
    ) -> Self:
        """A hollow or solid cylinder.

        Parameters
        ----------
        mass : float
            Mass (kg).
        inner_diameter, outer_diameter : float
            Its diameters (m).
        length : float
            Its length (m).
        mass_position : float
            Position of its middle along the shaft (m).

        Raises
        ------
        InputError
            If a dimension is not allowed.
        """
        body = RingBody.hollow_cylinder(
            mass=mass, inner_diameter=inner_diameter, outer_diameter=outer_diameter, length=length
        )
        return cls(
            mass=mass,
            inertia_axial=body.inertia_axial,
            inertia_transverse=body.inertia_transverse,
            mass_position=mass_position,
        )


class PreloadSpring(Model):
    """A spring that presses the outer ring of a bearing, which slides in its housing, onto its rollers.

    Parameters
    ----------
    force : float
        Force of the spring (N) where the outer ring stands at its nominal place: it just touches the rollers while the shaft is
        not displaced.
    stiffness : float
        Stiffness of the spring (N/m); 0 for a force that does not change.
    """

    force: Annotated[Number, unit("N", gt=0.0, le=1e9)]
    stiffness: Annotated[Number, unit("N/m", ge=0.0, le=1e12)] = 0.0


class ShaftBearing(Model):
    """A bearing with its place on the shaft, its oil and its effects.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    position : float
        Position of its load centre along the shaft (m). The load centre, or pressure centre, is where the normals of the cup's
        raceway at the middle of the rollers cross the axis: catalogues give its distance `a` from a face of the bearing.
    small_ends : {'left', 'right'}
        Where the small ends of the rollers point: to the left (towards smaller positions) or to the right. Such a bearing holds
        the shaft against axial forces in this direction.
    end_play : float
        Axial place of the outer ring (m) from where rings and rollers just touch at standstill while the shaft is not displaced;
        positive: it stands back and leaves end play, negative: preload. Only the sum over the bearings of a pair matters.
    spring : PreloadSpring, optional
        The outer ring slides and a spring presses it, in place of an `end_play`.
    name : str
        Its name in results; by default ``bearing_1`` and so on, from left to right as they are listed.
    lubricant : Lubricant or str
        The oil at its temperature, as in a `Scene`.
    effects : Effects
        Switches and choices, as in a `Scene`.
    start : Start
        How rollers and cage start in a run.
    growth : Growth, optional
        Temperatures of the parts, as in a `Scene`; they change the plays of the pockets. `trbdyn.fit` tells what they make of
        the end play.
    elastic_cage : ElasticCage, optional
        Deform the cage in runs, as in a `Scene`.
    housing : Housing, optional
        Let the outer ring move with a housing of its own in runs, as in a `Scene`; with a `spring`, whose stiffness is then its
        `support_axial`, what slides. One housing around several bearings is not modelled.
    defects : tuple of Pit, DepthMap or Waviness
        Where raceways and rollers are off their true form, as in a `Scene`.
    """

    _root: ClassVar[str | None] = "bearings"

    bearing: Bearing
    position: Annotated[Number, unit("m", ge=-100.0, le=100.0)]
    small_ends: Literal["left", "right"]
    end_play: Annotated[Number, unit("m", ge=-MAX_END_PLAY, le=MAX_END_PLAY)] = 0.0
    spring: PreloadSpring | None = None
    name: str = ""
    lubricant: Lubricant = vg100()
    effects: Effects = Effects()
    start: Start = Start()
    growth: Growth | None = None
    elastic_cage: ElasticCage | None = None
    housing: Housing | None = None
    defects: tuple[Defect, ...] = ()

    def __init__(self, bearing: Any = None, **fields: Any) -> None:
        super().__init__(**fields if bearing is None else {"bearing": bearing, **fields})

    @field_validator("lubricant", mode="before")
    @classmethod
    def _oil_by_name(cls, given: Any) -> Any:
        return oil_by_name(given)

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.spring is not None and self.end_play != 0.0:
            limit = "must be 0 with a spring, which moves the outer ring to the rollers (m)"
            raise InputError.of("end_play", self.end_play, limit)
        if self.spring is not None and self.housing is not None:
            stiffness = self.spring.stiffness
            if not math.isclose(self.housing.support_axial, stiffness, rel_tol=1e-9):
                limit = (
                    f"must be {stiffness:g}, the stiffness of the spring that holds the outer ring along the axis (N/m)"
                )
                raise InputError.of(("housing", "support_axial"), self.housing.support_axial, limit)
        return self

    @property
    def side(self) -> float:
        """1 where the small ends point to the right, -1 where they point to the left."""
        return 1.0 if self.small_ends == "right" else -1.0

    @property
    def centre_plane(self) -> float:
        """Position of the roller-centre plane along the shaft (m)."""
        return self.position + self.side * load_centre_offset(self.bearing)

    @property
    def rollers_reach(self) -> tuple[float, float]:
        """Positions between which the rollers lie on the shaft (m); the rings reach further."""
        geometry = self.bearing.geometry
        cosine, sine = math.cos(geometry.roller_axis_angle), math.sin(geometry.roller_axis_angle)
        ends = (
            geometry.small_end_station * cosine - geometry.small_end_radius * sine,
            geometry.large_end_station * cosine + 0.5 * geometry.large_end_diameter * sine,
        )
        low, high = sorted(self.centre_plane - self.side * end for end in ends)
        return low, high


def load_centre_offset(bearing: Bearing) -> float:
    """Distance of the load centre from the roller-centre plane along the axis (m), positive towards the large ends.

    A normal of the cup at the distance s = Rc cos(nu) from the apex, the middle of the rollers, crosses the axis at
    s/cos(alpha_o) from the apex.

    Parameters
    ----------
    bearing : Bearing
        The bearing.

    Examples
    --------
    >>> import trbdyn as trb
    >>> from trbdyn.model.assembly import load_centre_offset
    >>> round(1e3 * load_centre_offset(trb.cases.rig_30310()), 1)
    9.5
    """
    geometry = bearing.geometry
    along = geometry.apex_to_mid * math.cos(geometry.roller_half_angle)
    return along / math.cos(math.radians(bearing.cup_half_angle_deg)) - geometry.centre_plane


class ShaftLoad(Model):
    """A force and a moment on the shaft. They keep their direction, and their point moves with the shaft but does not turn.

    Parameters
    ----------
    position : float
        Position along the shaft (m).
    force : tuple of float or History, shape (3,)
        Force along x, y and z, the last one along the shaft to the right (N).
    offset : tuple of float, shape (2,)
        Where the force acts across the shaft, along x and y from the axis (m): a point of the pitch circle, for a gear.
    moment : tuple of float or History, shape (2,)
        Moment about x and y (N m). A moment about the shaft's axis belongs to the drive, which keeps the speed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> overhung = trb.ShaftLoad(position=0.2, force=(0.0, -1500.0, 0.0))
    >>> gear = trb.ShaftLoad.gear(position=0.05, pitch_diameter=0.12, torque=200.0, helix_angle_deg=15.0)
    >>> tuple(round(part) for part in gear.force)
    (-1256, 3333, 893)
    """

    _root: ClassVar[str | None] = "loads"

    position: Annotated[Number, unit("m", ge=-100.0, le=100.0)]
    force: tuple[Quantity, Quantity, Quantity] = (0.0, 0.0, 0.0)
    offset: tuple[Number, Number] = (0.0, 0.0)
    moment: tuple[Quantity, Quantity] = (0.0, 0.0)

    @classmethod
    def wheel(
        cls,
        *,
        position: float,
        rolling_radius: float,
        load: float,
        cornering: float = 0.0,
        centre_height: float = 0.0,
        track: float | None = None,
        driving_force: float = 0.0,
        outboard: Literal["left", "right"] = "right",
        fixed_to: Literal["outer rings", "shaft"] = "outer rings",
    ) -> Self:
        """What the road does to a wheel at its contact patch, which lies below the axis (-y).

        A vehicle that corners with the lateral acceleration a (over that of gravity) presses its outer wheel onto the road with
        Fz = W (1 + 2 a h/t) and its inner wheel with W (1 - 2 a h/t). Both share the lateral force as they share the load:
        Fy = a Fz, inboard on the outer wheel.

        Parameters
        ----------
        position : float
            Position of the wheel's middle plane, where the contact patch lies, along the shaft (m).
        rolling_radius : float
            Distance of the contact patch from the axis (m).
        load : float
            W, load of the wheel on a straight level road (N).
        cornering : float
            a (1): positive where this is the outer wheel of the curve, negative where it is the inner one. Usual values of load
            spectra are up to 0.25, the most that a tyre holds is about 0.8.
        centre_height : float
            h, height of the vehicle's centre of mass (m).
        track : float, optional
            t, distance of both wheels of the axle (m); needed with a `centre_height`.
        driving_force : float
            Force of the road on the tyre along +x (N), of driving or braking. The torque that belongs to it acts about the axis.
        outboard : {'left', 'right'}
            Where the outer side of the vehicle lies along the shaft.
        fixed_to : {'outer rings', 'shaft'}
            What the wheel turns with. On outer rings, as in a hub on a spindle, the shaft of the assembly is the spindle: it
            bears the same forces in the opposite direction.

        Raises
        ------
        InputError
            If a number is not allowed, or the wheel would leave the road.

        Notes
        -----
        Balance of moments of an axle with the load 2 W; the lateral forces of both wheels in the ratio of their loads are an
        assumption, as is a contact patch without width.

        Examples
        --------
        >>> import trbdyn as trb
        >>> curve = trb.ShaftLoad.wheel(
        ...     position=0.01, rolling_radius=0.3, load=4000.0, cornering=0.3, centre_height=0.6, track=1.5, fixed_to="shaft"
        ... )
        >>> tuple(round(part) for part in curve.force), curve.offset
        ((0, 4960, -1488), (0.0, -0.3))
        """
        if not rolling_radius > 0.0:
            raise InputError.of("rolling_radius", rolling_radius, "must be > 0 (m)")
        if not load >= 0.0:
            raise InputError.of("load", load, "must be >= 0 (N)")
        if not centre_height >= 0.0:
            raise InputError.of("centre_height", centre_height, "must be >= 0 (m)")
        if (centre_height > 0.0 or track is not None) and not (track or 0.0) > 0.0:
            raise InputError.of("track", track, "must be given with a centre_height, and > 0 (m)")
        for name, value, known in (
            ("outboard", outboard, ("left", "right")),
            ("fixed_to", fixed_to, ("outer rings", "shaft")),
        ):
            if value not in known:
                raise InputError.of(name, value, f"must be one of {', '.join(map(repr, known))}")
        moved = 0.0 if track is None else 2.0 * cornering * centre_height / track
        if moved < -1.0:
            limit = f"must be >= {cornering / -moved:.4g}: the inner wheel leaves the road there (1)"
            raise InputError.of("cornering", cornering, limit)
        vertical, side = load * (1.0 + moved), 1.0 if outboard == "right" else -1.0
        force = (driving_force, vertical, -side * cornering * vertical)
        sign = 1.0 if fixed_to == "shaft" else -1.0
        x, y, z = (sign * part + 0.0 for part in force)
        return cls(position=position, force=(x, y, z), offset=(0.0, -rolling_radius))

    @classmethod
    def gear(
        cls,
        *,
        position: float,
        pitch_diameter: float,
        torque: float,
        pressure_angle_deg: float = 20.0,
        helix_angle_deg: float = 0.0,
        direction_deg: float = 0.0,
    ) -> Self:
        """The force of the other gear on a spur or helical gear of the shaft.

        Tangential force Ft = 2 T/d, radial force Ft tan(alpha_n)/cos(beta) towards the axis, axial force Ft tan(beta).

        Parameters
        ----------
        position : float
            Position of the middle of its teeth along the shaft (m).
        pitch_diameter : float
            d (m).
        torque : float
            T, of the mesh on this shaft about +z (N m).
        pressure_angle_deg : float
            alpha_n, in the normal section (deg).
        helix_angle_deg : float
            beta (deg); its sign, with that of the torque, gives the direction of the axial force: both positive: to the right.
        direction_deg : float
            Direction from the axis to the mesh, from +x towards +y (deg).

        Raises
        ------
        InputError
            If a number is not allowed.

        Notes
        -----
        Source: ISO 21771:2007 for the angles; the balance of the mesh for the forces.
        """
        if not pitch_diameter > 0.0:
            raise InputError.of("pitch_diameter", pitch_diameter, "must be > 0 (m)")
        for name, angle, most in (
            ("pressure_angle_deg", pressure_angle_deg, 45.0),
            ("helix_angle_deg", helix_angle_deg, 60.0),
        ):
            if not abs(angle) < most:
                raise InputError.of(name, angle, f"must be from {-most:g} to {most:g} (deg)")
        tangential, where = 2.0 * torque / pitch_diameter, math.radians(direction_deg)
        pressure, helix = math.radians(pressure_angle_deg), math.radians(helix_angle_deg)
        inward = abs(tangential) * math.tan(pressure) / math.cos(helix)
        cosine, sine = math.cos(where), math.sin(where)
        force = (
            -inward * cosine - tangential * sine,
            -inward * sine + tangential * cosine,
            tangential * math.tan(helix),
        )
        radius = 0.5 * pitch_diameter
        return cls(position=position, force=force, offset=(radius * cosine, radius * sine))


class Assembly(TurningRings, Model):
    """Bearings on a rigid shaft. Their outer rings stand, or turn, in a rigid housing.

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
        own = {name: fields.pop(name) for name in OWN_FIELDS if name in fields}
        bearings = tuple(
            ShaftBearing(
                one, name=name, position=sign * 0.5 * spread, small_ends=small, end_play=0.5 * end_play, **fields
            )
            for one, name, sign, small in zip(
                (bearing, other or bearing), ("left", "right"), (-1.0, 1.0), ends, strict=True
            )
        )
        return cls(shaft=shaft, bearings=bearings, loads=tuple(loads), speed_rpm=speed_rpm, **own)

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
        own = {name: fields.pop(name) for name in OWN_FIELDS if name in fields}
        bearings = tuple(
            ShaftBearing(
                bearing,
                name=f"row_{index + 1}",
                position=plane - (load_centre_offset(bearing) if end == "right" else -load_centre_offset(bearing)),
                small_ends=end,
                end_play=0.5 * end_play,
                **fields,
            )
            for index, (end, plane) in enumerate(zip(ends, planes, strict=True))
        )
        return cls(shaft=shaft, bearings=bearings, loads=tuple(loads), speed_rpm=speed_rpm, **own)

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
            housing=one.housing,
            defects=one.defects,
            gravity=(x, scaled(y, turned), scaled(z, turned)),
        )

    @model_validator(mode="after")
    def _check(self) -> Self:
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
        return self

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
        for name in ("support_radial", "support_axial"):
            stiffnesses = [math.inf if one.housing is None else getattr(one.housing, name) for one in self.bearings]
            if not max(stiffnesses) > 0.0:
                limit = (
                    "must be > 0 in one bearing at least: nothing else holds shaft and housings in their place (N/m)"
                )
                raise InputError.of(("bearings", 0, "housing", name), 0.0, limit)

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
            set_by = f"end play {1e6 * one.end_play:.4g} um" if one.spring is None else f"spring {one.spring.force:g} N"
            rows.append(
                (f"{name}, load centre", f"{1e3 * one.position:.4g}", "mm", f"small ends {one.small_ends}, {set_by}")
            )
        for index, load in enumerate(self.loads):
            force = ", ".join(f"{part:.5g}" if isinstance(part, int | float) else "changes" for part in load.force)
            rows.append((f"load {index + 1}", force, "N", f"at {1e3 * load.position:.4g} mm"))
        return Shown(f"Assembly: {self.title}", tuple(rows))

    def __hash__(self) -> int:
        return hash(self.fingerprint)


Subject = Scene | Assembly
"""What can be simulated: one bearing, or several on a shaft."""


def assembly_of(subject: object) -> Assembly | None:
    """A subject that is an assembly; None for any other."""
    return subject if isinstance(subject, Assembly) else None


def subject_from_dict(values: Mapping[str, Any]) -> Subject:
    """The scene or the assembly that `to_dict` has described.

    Raises
    ------
    InputError
        If a value is not allowed.
    """
    return (Assembly if "shaft" in values else Scene).from_dict(values)
