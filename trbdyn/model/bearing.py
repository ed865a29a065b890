"""Tapered and cylindrical roller bearings by their catalogue numbers.

Cup, cone and roller cones share one apex, or all are cylinders (``cup_half_angle_deg = 0``); everything else follows from
these numbers (`Bearing.geometry`). Lengths in m, densities in kg/m3; angles in degrees where a field is called ``*_deg``.
What is not given is assumed in proportion to the bearing's size (`trbdyn.model.assumed`) and listed by `Bearing.assumed`;
change it where you know better.
"""

from __future__ import annotations

import math
import os
import pathlib
from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, ClassVar, Final, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator

from trbdyn.base.shown import Shown, field_rows
from trbdyn.base.validation import Gap, Length, Model, Number, Whole, unit
from trbdyn.errors import MISSING, InputError, Path, Problem
from trbdyn.model.assumed import RIG, assumed_inputs, with_assumed
from trbdyn.model.cage_body import CageBody, Wall, cage_mass
from trbdyn.model.cage_drawing import CageDrawing
from trbdyn.model.cage_space import CageSpace
from trbdyn.model.catalogue import fields_from_catalogue
from trbdyn.model.core_table import parameter
from trbdyn.model.designations import designation as row_of
from trbdyn.model.drawn.read import read_cage
from trbdyn.model.estimated import Estimated
from trbdyn.model.flatten import bearing_geometry
from trbdyn.model.geometry import Geometry
from trbdyn.model.land import Land
from trbdyn.model.material import Material, Roughness
from trbdyn.model.pocket import Face, OtherPocket, Pocket, every_face
from trbdyn.model.pocket_shapes import default_pocket
from trbdyn.model.ratings import Ratings
from trbdyn.model.roller import Profile, Roller, Scatter

__all__ = [
    "Bearing",
    "Cage",
    "CageBody",
    "Land",
    "Material",
    "Profile",
    "Ratings",
    "Ribs",
    "Roller",
    "Roughness",
    "Scatter",
]


_TAPERED_RIBS: Final = frozenset({("inner", "large"), ("inner", "small")})
_OUTER_RIBS: Final = frozenset({("outer", "large"), ("outer", "small")})
_RIBS: Final[dict[str | None, frozenset[tuple[str, str]]]] = {
    None: _TAPERED_RIBS,
    "NU": _OUTER_RIBS,
    "NJ": _OUTER_RIBS | {("inner", "large")},
    "NUP": _OUTER_RIBS | _TAPERED_RIBS,
    "N": _TAPERED_RIBS,
}
"""Ribs by the type of a bearing; None: tapered."""


class Ribs(Model):
    """Back-face rib (against the large ends) and front-face rib of the inner ring. Heights are above the raceway,
    perpendicular to it. What is not given is assumed in proportion to the 30310 rig.

    Parameters
    ----------
    contact_height : float
        Height of the nominal contact of the large end (m); by default 1.667/14 of the roller's diameter.
    edge_low, edge_high : float
        Heights of the back-face rib's edges (m); by default 0.3/1.667 and 3.5/1.667 of the contact height.
    front_clearance : float
        Nominal gap between small end and front rib (m); by default 0.2/14 of the roller's diameter. The front rib's
        face is perpendicular to the roller's axis.
    front_low, front_high : float
        Heights of the front rib's edges (m); by default 0.3/14 and 2/14 of the roller's diameter.
    flanges : {'NU', 'NJ', 'NUP', 'N'}, optional
        Which ribs a cylindrical bearing has, by its type in ISO 15; it must be given there, and nowhere else. NU: two of the
        outer ring. NJ: these, and one of the inner ring, against the ends towards +z. NUP: two of each ring. N: two of the inner
        ring. All have the contact height and the edges above; `front_clearance`, `front_low` and `front_high` are for cones.
    clearance : float
        Gap between a cylindrical roller in the middle and each rib (m); by default 1.5e-3 of the roller's diameter.
    """

    _assumed: ClassVar[bool] = True

    contact_height: Annotated[Number, parameter("rib_contact_height", gt=0)] = RIG["contact_height"]
    edge_low: Annotated[Number, parameter("rib_edge_low")] = RIG["edge_low"]
    edge_high: Annotated[Number, parameter("rib_edge_high", gt=0)] = RIG["edge_high"]
    front_clearance: Annotated[Number, parameter("front_rib_clearance")] = RIG["front_clearance"]
    front_low: Annotated[Number, parameter("front_rib_low")] = RIG["front_low"]
    front_high: Annotated[Number, parameter("front_rib_high", gt=0)] = RIG["front_high"]
    flanges: Literal["NU", "NJ", "NUP", "N"] | None = None
    clearance: Annotated[Number, parameter("rib_clearance")] = 0.0

    @property
    def places(self) -> frozenset[tuple[str, str]]:
        """Of which ring, and against which end of the rollers they are; the large end of a cylinder is the one towards +z."""
        return _RIBS[self.flanges]

    def carry(self, force: float) -> bool:
        """Whether ribs of a cylindrical bearing carry an axial force on the inner ring (N): NJ one towards -z, NUP either."""
        return force < 0.0 if self.flanges == "NJ" else self.flanges == "NUP" and force != 0.0

    @model_validator(mode="after")
    def _check(self) -> Self:
        given = self.model_fields_set
        if {"contact_height", "edge_low"} <= given and self.edge_low >= self.contact_height:
            limit = f"must be > edge_low, {self.edge_low:g}: between the rib's edges (m)"
            raise InputError.of("contact_height", self.contact_height, limit)
        if {"contact_height", "edge_high"} <= given and self.edge_high <= self.contact_height:
            limit = f"must be < edge_high, {self.edge_high:g}: between the rib's edges (m)"
            raise InputError.of("contact_height", self.contact_height, limit)
        if {"front_high", "front_low"} <= given and self.front_high <= self.front_low:
            raise InputError.of("front_high", self.front_high, f"must be > front_low, {self.front_low:g} (m)")
        return self


class Cage(Model):
    """The cage and its pockets. What is not given is assumed in proportion to the 30310 rig: lengths with the roller's
    diameter unless it is said otherwise.

    Parameters
    ----------
    mass : float
        Mass (kg); by default it follows from `body`, or else it is 0.2 kg times pitch diameter, roller diameter, roller
        length and density of the material over those of the rig, a cage of steel.
    inertia_axial, inertia_transverse : float
        Moments of inertia about its axis, and about a transverse axis through its centre of mass (kg m2); by default
        with mass and radius squared (what lies along the axis: with length squared), so that they follow a mass
        that is changed; with a `body` they are its own, in proportion to the mass. Given ones must belong to the mass: no
        cage has its mass outside of the bearing.
    play_radial, play_circumferential : float
        Cpr and Cpc: plays in the x-y plane, radial and circumferential, one-sided, measured to one roller with the cage
        centred and the roller's large end touching its pocket (m); by default 0.25/14 and 0.12/14 of the diameter.
    play_axial : float
        Play along the roller's axis from large-end to small-end contact (m); by default 0.4/14 of the diameter.
    offset : float
        Axial position of the centre of mass from the roller-centre plane (m); that of the `body`, or 0 (assumed).
    unbalance : float
        Unbalance: mass times distance of the centre of mass from the axis of the pockets (kg m; 1 g mm is 1e-6 kg m).
    unbalance_direction_deg : float
        Direction of the centre of mass, from the middle of pocket 0 in the direction of positive rotation (deg).
    rail_offset : float
        Axial position of the large-end rail, where sensors look, from the roller-centre plane (m); by default 12/19.8
        of the roller's length.
    bar_width : float
        Width of the bars' faces across the contact line (m); by default 3/14 of the diameter.
    wall_inner, wall_outer : float
        Inner and outer edge of the end walls' bands, outward of the roller's axis (m); by default 1.5/14 and 4.5/14 of
        the diameter, at most 0.3 and 0.9 of the small end's radius.
    wall_half_width : float
        Half width of the end walls' bands (m); by default 6/14 of the diameter.
    pocket : Pocket, optional
        Faces of every pocket; without it the default pocket of `trbdyn.pocket_shapes` is built from the plays.
    other_pockets : sequence of OtherPocket
        Pockets that differ from the others.
    material : Material, optional
        What it is made of; that of the bearing by default.
    body : CageBody, optional
        Its rims and bars, from which mass, centre and moments of inertia follow.
    drawing : CageDrawing, optional
        The drawing it was read from (`from_step`); not together with a `body`.
    """

    _assumed: ClassVar[bool] = True

    mass: Annotated[Number, parameter("cage_mass")] = RIG["mass"]
    inertia_axial: Annotated[Number, parameter("cage_inertia_axial")] = RIG["inertia_axial"]
    inertia_transverse: Annotated[Number, parameter("cage_inertia_transverse")] = RIG["inertia_transverse"]
    play_radial: Length = RIG["play_radial"]
    play_circumferential: Length = RIG["play_circumferential"]
    play_axial: Gap = RIG["play_axial"]
    offset: Annotated[Number, parameter("cage_offset")] = 0.0
    unbalance: Annotated[Number, unit("kg m", ge=0)] = 0.0
    unbalance_direction_deg: Annotated[Number, unit("deg")] = 0.0
    rail_offset: Annotated[Number, parameter("cage_rail_offset")] = RIG["rail_offset"]
    bar_width: Length = RIG["bar_width"]
    wall_inner: Gap = RIG["wall_inner"]
    wall_outer: Length = RIG["wall_outer"]
    wall_half_width: Length = RIG["wall_half_width"]
    pocket: Pocket | None = None
    other_pockets: tuple[OtherPocket, ...] = ()
    material: Material | None = None
    body: CageBody | None = None
    drawing: CageDrawing | None = None

    @classmethod
    def from_step(
        cls,
        path: str | os.PathLike[str],
        bearing: Bearing,
        *,
        material: Material | None = None,
        tolerance: float = 1e-6,
        unit: str = "mm",
        roller_plane: float | None = None,
    ) -> Cage:
        """A cage as drawn: its pockets with all faces that a roller can touch, plays, mass, centre and moments of inertia.

        The cage is placed so that bars of both sides have the same gap and the large ends of the rollers just touch their walls.
        Plane faces are exact, curved faces are facets. It needs the extra ``trbdyn[cad]``
        (docs/theory/geometry.md#pockets-from-a-drawing).

        Parameters
        ----------
        path : path-like
            STEP file (``.step``, ``.stp``), which tells its unit, or STL file, of one solid.
        bearing : Bearing
            The bearing whose cage it is.
        material : Material, optional
            What it is made of; that of the bearing by default. Its density gives the mass.
        tolerance : float
            Largest distance between a curved face and its facets (m).
        unit : {'mm', 'm', 'inch'}
            Unit of an STL file.
        roller_plane : float, optional
            Height of the roller-centre plane above the cage's centre of volume, positive towards the large ends (m); needed where
            no wall faces the large ends.

        Raises
        ------
        InputError
            If an argument is not allowed, or the cage does not belong to the bearing.
        FileError
            If the file cannot be read, or what is in it is not understood; the message names the face.
        ImportError
            If the extra is not installed.
        """
        drawn = read_cage(path, bearing, tolerance=tolerance, unit=unit, roller_plane=roller_plane)
        density = (material or bearing.material).density
        if density is None:
            raise InputError.of(("material", "density"), None, "must be given: the cage's mass follows from it (kg/m3)")
        return cls(**drawn.fields(density), material=material)

    @model_validator(mode="after")
    def _check(self) -> Self:
        given = self.model_fields_set
        if {"inertia_axial", "inertia_transverse"} <= given and self.inertia_axial > 2.0 * self.inertia_transverse:
            limit = f"must be <= 2 inertia_transverse, {2 * self.inertia_transverse:g} (kg m2): no body has more"
            raise InputError.of("inertia_axial", self.inertia_axial, limit)
        if self.body is not None and self.drawing is not None:
            raise InputError.of(
                "body", "given", "must not be given together with a drawing, which has rims and bars of its own"
            )
        if {"wall_inner", "wall_outer"} <= given and self.wall_outer <= self.wall_inner:
            raise InputError.of("wall_outer", self.wall_outer, f"must be > wall_inner, {self.wall_inner:g} (m)")
        indices = [other.index for other in self.other_pockets]
        for place, index in enumerate(indices):
            if index in indices[:place]:
                raise InputError.of(("other_pockets", place, "index"), index, "must differ from the other indices")
        return self


class Bearing(Model):
    """A single-row tapered or cylindrical roller bearing. What is not needed below (rollers, pitch diameter, cup's angle) has a
    default in proportion to the bearing's size, listed by `assumed`.

    Parameters
    ----------
    n_rollers : int
        Z, number of rollers.
    cup_half_angle_deg : float
        alpha_o, half angle of the outer raceway's cone (deg), from 0.6; 0: rollers and raceways are cylinders.
    pitch_diameter : float
        Dpw, pitch diameter at the rollers' mid length (m).
    roller : Roller
        The rollers.
    ribs : Ribs
        Ribs of the inner ring.
    cage : Cage
        The cage.
    material : Material
        Elasticity of the rings, and of rollers and cage unless they have their own.
    roughness : Roughness
        Roughness of the contacts.
    land : Land
        The land of a ring that guides the cage, where one does.
    radial_clearance : float
        Radial internal clearance of a cylindrical bearing in operation (m); 0 by default: rollers and rings just touch.
    name : str
        Name in titles and files.
    bore, outside, width : float, optional
        d, D and T (B of a cylindrical bearing), where they are known (m); the simulation does not use them, and a `Mounting` with
        other ones is refused. `from_catalogue` and `named` keep them.
    ratings : Ratings
        Load ratings and factors of the catalogue, where they are known; the simulation does not use them.
    estimates : sequence of Estimated
        Inputs that were estimated when the bearing was made from catalogue numbers; see `estimated`.

    Raises
    ------
    InputError
        If a number is not allowed, rollers overlap, or pockets do not fit the rollers.

    Examples
    --------
    >>> import trbdyn as trb
    >>> bearing = trb.Bearing(
    ...     n_rollers=15,
    ...     cup_half_angle_deg=14.0,
    ...     pitch_diameter=65e-3,
    ...     roller=trb.Roller(diameter=9e-3, effective_length=14e-3),
    ... )
    >>> round(1e3 * bearing.cage.bar_width, 3), "cage.bar_width" in bearing.assumed
    (1.929, True)
    """

    n_rollers: Annotated[Whole, parameter("n_rollers")]
    cup_half_angle_deg: Annotated[Number, unit("deg", ge=0, le=45)]
    pitch_diameter: Annotated[Number, parameter("pitch_diameter")]
    roller: Roller
    ribs: Ribs = Ribs()
    cage: Cage = Cage()
    material: Material = Material()
    roughness: Roughness = Roughness()
    land: Land = Land()
    radial_clearance: Annotated[Number, parameter("radial_clearance")] = 0.0
    cup_profile: Profile | None = None
    cone_profile: Profile | None = None
    name: Annotated[str, Field(min_length=1)] = "bearing"
    bore: Length | None = None
    outside: Length | None = None
    width: Length | None = None
    ratings: Ratings = Ratings()
    estimates: tuple[Estimated, ...] = ()

    @classmethod
    def from_catalogue(
        cls,
        *,
        bore: Any = MISSING,
        outside: Any = MISSING,
        width: Any = MISSING,
        C: Any = MISSING,
        e: float | None = None,
        Y: float | None = None,
        C0: float | None = None,
        Y0: float | None = None,
        Cu: float | None = None,
        cup_width: float | None = None,
        n_rollers: int | None = None,
        roller_diameter: float | None = None,
        roller_length: float | None = None,
        pitch_diameter: float | None = None,
        contact_angle_deg: float | None = None,
        cage_mass: float | None = None,
        maker_factor: float | None = None,
        reference_speed_rpm: float | None = None,
        limiting_speed_rpm: float | None = None,
        flanges: str | None = None,
        F: float | None = None,
        E: float | None = None,
        radial_clearance: float | None = None,
        name: str = "",
        **others: Any,
    ) -> Bearing:
        """A bearing from the numbers of a catalogue page; what is inside is estimated.

        The angle of the cup follows from e = 1.5 tan(alpha) or Y = 0.4 cot(alpha) (ISO 281). Diameter, length and number of the
        rollers and the maker's factor on C are the least unusual ones with this C; the rest is scaled from the 30310 rig.
        See `estimated`. What is given here derives the others; a later ``replace(n_rollers=17)`` changes that number alone.

        Parameters
        ----------
        bore, outside, width : float
            Boundary dimensions d, D and T, of a cylindrical bearing B (m).
        C, C0, Cu : float
            Ratings and fatigue load limit, also called Pu (N); C alone is needed, the others are for `trbdyn.rating`.
        e, Y, Y0 : float, optional
            Calculation factors; e or Y, or the contact angle, must be given, and they must agree (1).
        n_rollers : int, optional
            Z.
        roller_diameter, roller_length, pitch_diameter, cup_width : float, optional
            Dwe, Lwe, Dpw, and the width of the cup, often called C beside T and B (m).
        contact_angle_deg, cage_mass : float, optional
            Half angle of the cup (deg); mass of the cage (kg).
        maker_factor : float, optional
            C over the rating of ISO 281 with b_m = 1.1, where it is known; 0.8 to 1.5 (1).
        reference_speed_rpm, limiting_speed_rpm : float, optional
            Speeds that the catalogue permits (rpm): kept for `trbdyn.rating`.
        flanges : {'NU', 'NJ', 'NUP', 'N'}, optional
            Type of a cylindrical bearing; without it the bearing is tapered. With it C0 tells the rollers' number times length.
        F, E : float, optional
            Diameters of the raceways of the inner and the outer ring of a cylindrical bearing (m).
        radial_clearance : float, optional
            Clearance of a cylindrical bearing in operation (m); by default half of group N of ISO 5753-1.
        name : str
            Name; by default the boundary dimensions.

        Returns
        -------
        Bearing

        Raises
        ------
        InputError
            If a number is not allowed or contradicts another one, a name is unknown, or no rollers that fit the
            dimensions come near this C.

        Examples
        --------
        >>> import trbdyn as trb
        >>> bearing = trb.Bearing.from_catalogue(bore=0.080, outside=0.140, width=0.03525, C=187e3, e=0.43)
        >>> print(bearing.estimated[0])
        cup_half_angle_deg = 16 deg (15.82 to 16.17): tan(alpha) = e/1.5 (ISO 281), e as rounded in the catalogue
        >>> page = {"bore": 0.050, "outside": 0.090, "width": 0.020, "C": 69e3, "C0": 76.5e3, "F": 0.0595}
        >>> cylindrical = trb.Bearing.from_catalogue(flanges="NU", **page)
        >>> print(cylindrical.n_rollers, round(1e3 * cylindrical.roller.diameter, 2))
        16 11.2
        """
        given = {name: value for name, value in locals().items() if name not in ("cls", "others")}
        return cls(**fields_from_catalogue(**given, others=others))

    @classmethod
    def named(cls, designation: str, *, table: str | pathlib.Path | None = None, **known: Any) -> Bearing:
        """A bearing by its designation: boundary dimensions and ratings of a table, the rest estimated as `from_catalogue` does.

        `trbdyn.designation` shows which number is a fact and of which source, and which one is an estimate.

        Parameters
        ----------
        designation : str
            Such as ``"32208"`` or ``"LM67048/LM67010"``, see `trbdyn.designation`.
        table : path-like, optional
            A table of your own, see `trbdyn.designations`.
        **known
            What you know better, by the names of `from_catalogue`: ``C=95e3, n_rollers=17``.

        Raises
        ------
        InputError
            If there is no such row, or it cannot be right.

        Examples
        --------
        >>> import trbdyn as trb
        >>> bearing = trb.Bearing.named("32208")
        >>> bearing.ratings.dynamic, bearing.estimated[0].path
        (77700.0, 'cup_half_angle_deg')
        """
        return cls(**row_of(designation, table=table).fields(**known))

    @property
    def estimated(self) -> tuple[Estimated, ...]:
        """Inputs that are estimated, with bands and sources, but for those that were changed since."""
        return tuple(found for entry in self.estimates if (found := self._now(entry)) is not None)

    def _now(self, entry: Estimated) -> Estimated | None:
        """An estimate as it is now; digits that a case file leaves out change nothing. None: it was changed."""
        *parts, name = entry.path.split(".")
        owner: object = self
        for part in parts:
            owner = getattr(owner, part, None)
        value = getattr(owner, name, None)
        if not isinstance(value, int | float):
            return None
        if math.isclose(value, entry.value, rel_tol=1e-5):
            return entry
        if not isinstance(owner, Cage) or name in owner.model_fields_set or not entry.value:
            return None
        share = value / entry.value
        return entry.replace(value=float(value), low=share * entry.low, high=share * entry.high)

    @model_validator(mode="before")
    @classmethod
    def _fill(cls, values: Any) -> Any:
        if not isinstance(values, Mapping):
            return values
        return cls._weighed(with_assumed(values, _SECTIONS), set(values.get("assumed", ())))

    @classmethod
    def _weighed(cls, fields: dict[str, Any], kept: set[str]) -> dict[str, Any]:
        """Fields of a bearing with what its cage's body weighs; what was kept by a file stays as it is."""
        cage = fields.get("cage")
        if not isinstance(cage, Cage) or cage.body is None:
            return fields
        given = cage.model_fields_set
        plain = Cage(**{name: getattr(cage, name) for name in given - {"body", *_OF_BODY}})
        try:
            bearing = cls(**{**fields, "cage": plain})
            density = bearing.cage_material.density
            if density is None:
                path = ("material", "density") if cage.material is None else ("cage", "material", "density")
                raise InputError.of(path, None, "must be given: the cage's mass follows from its body (kg/m3)")
            found = cage_mass(Wall.of(bearing, cage.body), density)
        except InputError as error:
            raise (error.under(("cage",)) if error.problems[0].path[:1] == ("body",) else error) from None
        share = cage.mass / found.mass if "mass" in given else 1.0
        numbers = {
            "mass": found.mass,
            "offset": found.offset,
            "inertia_axial": share * found.inertia_axial,
            "inertia_transverse": share * found.inertia_transverse,
        }
        own = {name: value for name, value in numbers.items() if name not in given and f"cage.{name}" not in kept}
        made = Cage(**{**{name: getattr(cage, name) for name in Cage.model_fields}, **own})
        object.__setattr__(made, "__pydantic_fields_set__", set(given))
        return {**fields, "cage": made}

    @property
    def assumed(self) -> dict[str, float]:
        """Inputs that were not given: value by path, such as ``{"cage.bar_width": 0.003}`` (SI units). They follow from the
        bearing's size, or were estimated from a catalogue page; `estimated` gives the band and the source of the latter.
        """
        return assumed_inputs(self) | {entry.path: float(entry.value) for entry in self.estimated}

    def __repr__(self) -> str:
        return f"<Bearing {self._title()}>"

    __str__ = __repr__

    def _title(self) -> str:
        roller = self.roller
        return (
            f"{self.name}: {self.n_rollers} rollers of {1e3 * roller.diameter:.4g} x {1e3 * roller.effective_length:.4g} mm on a "
            f"pitch circle of {1e3 * self.pitch_diameter:.4g} mm, "
            + (
                f"cylindrical, {self.ribs.flanges}"
                if self.is_cylindrical
                else f"half angle of the cup {self.cup_half_angle_deg:.4g} deg"
            )
        )

    def _shown(self) -> Shown:
        marks = dict.fromkeys(self.assumed, "assumed") | {entry.path: "estimated" for entry in self.estimated}
        return Shown(f"Bearing {self._title()}", tuple(field_rows(self, marks)))

    def inputs(self) -> dict[str, Any]:
        """What was given, as plain data: as `to_dict`, without what was assumed."""
        values = super().to_dict()
        for path in values.pop("assumed"):
            *tables, last = path.split(".")
            table = values
            for name in tables:
                table = table[name]
            table.pop(last, None)
        return values

    @model_serializer(mode="wrap")
    def _plain(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        values: dict[str, Any] = handler(self)
        return {**values, "assumed": list(assumed_inputs(self))}

    @property
    def roller_material(self) -> Material:
        """Elasticity of the rollers."""
        return self.roller.material or self.material

    @property
    def cage_material(self) -> Material:
        """Elasticity of the cage's faces."""
        return self.cage.material or self.material

    @cached_property
    def geometry(self) -> Geometry:
        """Everything that follows from the catalogue numbers (m, rad), as the core derives it."""
        return bearing_geometry(self)

    @property
    def pocket(self) -> Pocket:
        """The pocket of the cage that every roller has unless `cage.other_pockets` says otherwise."""
        return self.cage.pocket if self.cage.pocket is not None else default_pocket(self)

    def pocket_of(self, index: int) -> Pocket:
        """The pocket of a roller, 0 to Z - 1."""
        for other in self.cage.other_pockets:
            if other.index == index:
                return other.pocket
        return self.pocket

    def pocket_faces(self) -> list[tuple[int, Face]]:
        """Every face of every pocket: (pocket, face); pocket -1 stands for all of them."""
        if not self.cage.other_pockets:
            return [(-1, face) for face in self.pocket.faces]
        return every_face(self)

    @property
    def slot_names(self) -> tuple[str, ...]:
        """Name of each slot of the pockets, in order: the columns of pocket forces; empty where no face has the slot."""
        faces = [face for _, face in self.pocket_faces()]
        names = [""] * (1 + max(face.slot for face in faces))
        for face in faces:
            names[face.slot] = names[face.slot] or face.name
        return tuple(names)

    @property
    def diameter_deviation(self) -> NDArray[np.float64]:
        """Deviation of each roller's diameter (m), shape (Z,)."""
        if self.roller.diameter_scatter is not None:
            return self.roller.diameter_scatter.draw(self.n_rollers)
        given = self.roller.diameter_deviation
        return np.zeros(self.n_rollers) if given is None else np.array(given)

    @property
    def is_cylindrical(self) -> bool:
        """Whether rollers and raceways are cylinders."""
        return self.cup_half_angle_deg == 0.0

    def _check_kind(self) -> None:
        """What only tapered, and what only cylindrical bearings have."""
        if self.is_cylindrical:
            if self.ribs.flanges is None:
                allowed = "must be given where cup_half_angle_deg = 0: 'NU', 'NJ', 'NUP' or 'N'"
                raise InputError.of(("ribs", "flanges"), None, allowed)
            for part, name in _OF_CONES:
                if name in (own := getattr(self, part)).model_fields_set:
                    allowed = "must not be given for cylindrical rollers: their ends and ribs have end_radius and ribs.clearance"
                    raise InputError.of((part, name), getattr(own, name), allowed)
            return
        if self.cup_half_angle_deg < LEAST_CONE_DEG:
            allowed = f"must be 0, for cylindrical rollers, or from {LEAST_CONE_DEG:g} to 45 (deg)"
            raise InputError.of("cup_half_angle_deg", self.cup_half_angle_deg, allowed)
        for path, value in (
            (("ribs", "flanges"), self.ribs.flanges),
            (("ribs", "clearance"), self.ribs.clearance or None),
            (("radial_clearance",), self.radial_clearance or None),
        ):
            if value is not None:
                allowed = (
                    "must not be given for tapered rollers: only cylindrical bearings, cup_half_angle_deg = 0, have it"
                )
                raise InputError.of(path, value, allowed)

    def _check_clearances(self) -> None:
        """No clearance is as large as a roller is thick: such a number was meant in millimetres."""
        most = self.roller.diameter
        for part, name in _CLEARANCES:
            value = getattr(getattr(self, part), name)
            if value >= most:
                allowed = (
                    f"must be below the diameter of the rollers, {most:g} (m); {value:g} mm would be {1e-3 * value:g} m"
                )
                raise InputError.of((part, name), value, allowed)

    def _check_profiles(self) -> None:
        half = 0.5 * self.roller.effective_length
        for path, profile in (
            (("roller", "profile"), self.roller.profile),
            (("cup_profile",), self.cup_profile),
            (("cone_profile",), self.cone_profile),
        ):
            if profile is None or profile.kind != "table":
                continue
            if profile.stations[0] > -(1.0 - 1e-6) * half or profile.stations[-1] < (1.0 - 1e-6) * half:
                allowed = f"must go from {-half:g} to {half:g}: over the effective length (m)"
                raise InputError.of((*path, "stations"), profile.stations, allowed)

    @model_validator(mode="after")
    def _check(self) -> Self:
        self._check_kind()
        self._check_clearances()
        self._check_profiles()
        given = self.roller.diameter_deviation
        if given is not None and len(given) != self.n_rollers:
            limit = f"must have one entry for each roller, {self.n_rollers}"
            raise InputError.of(("roller", "diameter_deviation"), given, limit)
        most = int(np.pi / np.arcsin(min(self.roller.diameter / self.pitch_diameter, 1.0)))
        if self.pitch_diameter * np.sin(np.pi / self.n_rollers) <= self.roller.diameter:
            size = f"{self.roller.diameter:g} m overlap on pitch diameter {self.pitch_diameter:g} m"
            limit = f"must be <= {most}: more rollers of {size}"
            raise InputError.of("n_rollers", self.n_rollers, limit)
        land, thinnest, thickest = self.land, 1e-4 * self.land.clearance, 0.5 * self.land.clearance
        if not thinnest <= land.contact_film <= thickest:
            limit = f"must be from {thinnest:g} to {thickest:g}: 1e-4 to 0.5 of land.clearance, {land.clearance:g} (m)"
            raise InputError.of(("land", "contact_film"), land.contact_film, limit)
        if impossible := CageSpace.of(self).problems(self.cage, self.cage_material):
            raise InputError(impossible)
        self._check_pockets(self.geometry)
        check_boundary(self, bore=self.bore, outside=self.outside, width=self.width)
        return self

    def _check_pockets(self, geometry: Geometry) -> None:
        try:
            pocket = self.pocket
        except InputError as error:
            raise error.under(("cage",)) from None
        problems = _under(("cage", "pocket"), pocket.problems(geometry))
        for place, other in enumerate(self.cage.other_pockets):
            path = ("cage", "other_pockets", place)
            if other.index >= self.n_rollers:
                problems.append(
                    Problem((*path, "index"), other.index, f"must be <= {self.n_rollers - 1}: the last pocket")
                )
            problems += _under((*path, "pocket"), other.pocket.problems(geometry))
        if problems:
            raise InputError(problems)


_CLEARANCES: Final = (
    ("cage", "play_radial"),
    ("cage", "play_circumferential"),
    ("cage", "play_axial"),
    ("land", "clearance"),
    ("ribs", "clearance"),
    ("ribs", "front_clearance"),
)
_OF_CONES: Final = (
    ("ribs", "front_clearance"),
    ("ribs", "front_low"),
    ("ribs", "front_high"),
    ("roller", "sphere_ratio"),
)
"""Numbers of the plane front rib and of an end whose sphere the apex scales: only tapered bearings have them."""
SAME_SIZE: Final = 1e-5
"""Difference by which two statements of one boundary dimension differ by rounding (m)."""
LEAST_CONE_DEG: Final = 0.6
"""Smallest half angle of the cup of a tapered bearing (deg)."""

_OF_BODY: Final = ("mass", "offset", "inertia_axial", "inertia_transverse")
"""What follows from the body of a cage."""

_SECTIONS: Final[dict[str, type[Model]]] = {
    "roller": Roller,
    "roller.profile": Profile,
    "ribs": Ribs,
    "cage": Cage,
    "material": Material,
    "roughness": Roughness,
    "land": Land,
}
"""Parts of a bearing whose numbers may be assumed, by their paths."""


def _under(path: Path, problems: list[Problem]) -> list[Problem]:
    return [Problem(path + problem.path, problem.value, problem.allowed) for problem in problems]


def check_boundary(
    bearing: Bearing, *, bore: float | None, outside: float | None, width: float | None, path: Path = ()
) -> None:
    """Refuse boundary dimensions (m) that a bearing cannot have: rollers and raceways lie between them, and those that it has are
    its own. What is None is not looked at.

    Raises
    ------
    InputError
        With the field and what is allowed; its path begins with `path`.
    """
    geometry = bearing.geometry
    length = bearing.roller.effective_length * math.cos(geometry.roller_axis_angle)
    for field, given, sense, least, what in (
        ("bore", bore, -1.0, 2.0 * geometry.inner_race_radius, "below the diameter of the raceway"),
        ("outside", outside, 1.0, 2.0 * geometry.outer_race_radius, "above the diameter of the raceway"),
        ("width", width, 1.0, length, "above the length of the rollers along the axis"),
    ):
        if given is None:
            continue
        if (own := getattr(bearing, field)) is not None and abs(given - own) > SAME_SIZE:
            raise InputError.of((*path, field), given, f"must be {own:g}, that of the bearing {bearing.name} (m)")
        if not sense * (given - least) > 0.0:
            raise InputError.of((*path, field), given, f"must be {what}, {least:.4g} (m)")
