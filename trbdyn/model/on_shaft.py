"""What a rigid shaft consists of and what sits and acts on it: its mass, bearings with their places, loads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Final, Literal, Self

from trbdyn.base.validation import Model, Number, number_of, unit
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.core_table import parameter
from trbdyn.model.defects import Defect
from trbdyn.model.effects import Effects
from trbdyn.model.elastic_cage import ElasticCage
from trbdyn.model.growth import Growth
from trbdyn.model.lubricants.shipped import AnyLubricant, vg100
from trbdyn.model.motion import Quantity
from trbdyn.model.ring_body import Housing, Revolved
from trbdyn.model.start import Start

MAX_PRELOAD: Final = 1e-3
"""Largest preload of one bearing by displacement (m), far above what raceways bear."""
MAX_END_PLAY: Final = 3e-4
"""Largest end play of one bearing (m): where a shaft goes farther, the rollers of the other bearing
have no equilibrium in the wide gap."""


class OnAxis(Revolved):
    """A body about the axis of an assembly: what `Shaft` and `SharedHousing` have in common."""

    mass_position: Annotated[Number, unit("m", ge=-100.0, le=100.0)] = 0.0
    damping: Annotated[Number, parameter("ring_damping")] = 0.0
    damping_turns: Annotated[Number, parameter("ring_damping_turns")] = 0.0


class Shaft(OnAxis):
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

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> round(1e4 * shaft.inertia_axial, 3)
    18.75
    """

    unbalance: Annotated[Number, parameter("ring_unbalance")] = 0.0
    unbalance_angle_deg: Annotated[Number, unit("deg", ge=-360.0, le=360.0)] = 0.0


class SharedHousing(OnAxis):
    """One rigid housing around all bearings of an assembly, with their outer rings (``Assembly(shared_housing=...)``).

    At the start the outer rings stand at their nominal places, and the support carries what all bearings do to the housing, and
    its weight. From there on the springs act on what moves the housing, and the dampers on its velocity.

    Parameters
    ----------
    mass : float
        Mass (kg).
    inertia_axial, inertia_transverse : float
        Moments of inertia about the axis, and about a transverse axis through the centre of mass (kg m2).
    mass_position : float
        Position of the centre of mass along the shaft (m).
    damping : float
        Damping between the housing and the surroundings, of translations of its centre of mass (N s/m).
    damping_turns : float
        The same of turns about transverse axes (N m s).
    support_radial, support_axial : float
        Stiffness of the support across and along the axis (N/m).
    support_tilt : float
        Its stiffness against tilt (N m/rad).
    support_position : float
        Position of the support along the shaft (m). Several supports on the axis, k_i at the places z_i, are one: the sum of k_i
        at z = sum(k_i z_i)/sum(k_i), with sum(k_i (z_i - z)^2) in addition against tilt (`on_supports`).

    Examples
    --------
    >>> import trbdyn as trb
    >>> housing = trb.SharedHousing.hollow_cylinder(mass=12.0, inner_diameter=0.11, outer_diameter=0.16, length=0.25)
    >>> housing = housing.on_supports((-0.1, 0.1), radial=1e8, axial=5e7)
    >>> round(housing.support_radial / 1e6), round(housing.support_tilt / 1e6, 3)
    (200, 2.0)
    """

    support_radial: Annotated[Number, parameter("ring_support_radial")] = 0.0
    support_axial: Annotated[Number, parameter("ring_support_axial")] = 0.0
    support_tilt: Annotated[Number, parameter("ring_support_tilt")] = 0.0
    support_position: Annotated[Number, unit("m", ge=-100.0, le=100.0)] = 0.0

    def on_supports(self, positions: Sequence[float], *, radial: Any, axial: Any = 0.0, tilt: Any = 0.0) -> Self:
        """The housing on several supports in place of its own.

        Parameters
        ----------
        positions : sequence of float
            Their places along the shaft (m).
        radial, axial : float or sequence of float
            Stiffness of each across and along the axis (N/m); one number is that of all.
        tilt : float or sequence of float
            Its stiffness against tilt (N m/rad).

        Raises
        ------
        InputError
            If a number is not allowed.
        """
        places = [number_of(f"positions[{index}]", one) for index, one in enumerate(positions)]
        sums = {}
        for name, given in (("radial", radial), ("axial", axial), ("tilt", tilt)):
            each = [given] * len(places) if isinstance(given, int | float) else list(given)
            if len(each) != len(places):
                raise InputError.of(name, len(each), f"must be one number, or {len(places)} for {len(places)} supports")
            sums[name] = [number_of(name, one, "N m/rad" if name == "tilt" else "N/m", ge=0.0) for one in each]
        if not sum(sums["radial"]) > 0.0:
            raise InputError.of("radial", radial, "must be > 0 in one support at least (N/m)")
        whole = math.fsum(sums["radial"])
        middle = math.fsum(k * place for k, place in zip(sums["radial"], places, strict=True)) / whole
        apart = math.fsum(k * (place - middle) ** 2 for k, place in zip(sums["radial"], places, strict=True))
        return self.replace(
            support_radial=whole,
            support_axial=math.fsum(sums["axial"]),
            support_tilt=math.fsum(sums["tilt"]) + apart,
            support_position=middle,
        )

    def seen_from(self, one: ShaftBearing) -> Housing:
        """The housing as the outer ring of a bearing sees it: places from its roller-centre plane, towards its large ends."""
        own = {name: getattr(self, name) for name in Housing.model_fields if name in type(self).model_fields}
        places = {"mass_offset": self.mass_position, "support_position": self.support_position}
        return Housing(**{**own, **{name: -one.side * (at - one.centre_plane) for name, at in places.items()}})


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
        `support_axial`, what slides. One housing around all bearings is `Assembly.shared_housing`.
    defects : tuple of Pit, DepthMap or Waviness
        Where raceways and rollers are off their true form, as in a `Scene`.
    """

    _root: ClassVar[str | None] = "bearings"

    bearing: Bearing
    position: Annotated[Number, unit("m", ge=-100.0, le=100.0)]
    small_ends: Literal["left", "right"]
    end_play: Annotated[Number, unit("m", ge=-MAX_PRELOAD, le=MAX_END_PLAY)] = 0.0
    spring: PreloadSpring | None = None
    name: str = ""
    lubricant: AnyLubricant = vg100()
    effects: Effects = Effects()
    start: Start = Start()
    growth: Growth | None = None
    elastic_cage: ElasticCage | None = None
    housing: Housing | None = None
    defects: tuple[Defect, ...] = ()

    def __init__(self, bearing: Any = None, **fields: Any) -> None:
        super().__init__(**fields if bearing is None else {"bearing": bearing, **fields})

    def _check(self) -> None:
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

    @property
    def side(self) -> float:
        """1 where the small ends point to the right, -1 where they point to the left."""
        return 1.0 if self.small_ends == "right" else -1.0

    @property
    def outer_face(self) -> float | None:
        """Position of the outer ring's face at the small ends of the rollers along the shaft (m); None where the page does not
        say how far it is from the load centre.
        """
        distance = self.bearing.ratings.load_centre
        return None if distance is None else self.position + self.side * distance

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
        number_of("rolling_radius", rolling_radius, "m", gt=0.0)
        number_of("load", load, "N", ge=0.0)
        number_of("centre_height", centre_height, "m", ge=0.0)
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
        number_of("pitch_diameter", pitch_diameter, "m", gt=0.0)
        number_of("pressure_angle_deg", pressure_angle_deg, "deg", ge=-45.0, le=45.0)
        number_of("helix_angle_deg", helix_angle_deg, "deg", ge=-60.0, le=60.0)
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
