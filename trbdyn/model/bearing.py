"""Tapered roller bearings by their catalogue numbers.

Cup, cone and roller cones share one apex; everything else follows from these numbers (`Bearing.geometry`). Lengths in
m, densities in kg/m3; angles in degrees where a field is called ``*_deg``. What is not given is assumed in
proportion to the bearing's size (`trbdyn.model.assumed`) and listed by `Bearing.assumed`; change it where you know better.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, ClassVar, Final, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator

from trbdyn.base.validation import Gap, Length, Model, Number, Whole, unit
from trbdyn.errors import InputError, Path, Problem
from trbdyn.model.assumed import RIG, assumed_inputs, with_assumed
from trbdyn.model.catalogue import fields_from_catalogue
from trbdyn.model.core_table import parameter
from trbdyn.model.estimated import Estimated
from trbdyn.model.flatten import bearing_geometry
from trbdyn.model.geometry import Geometry
from trbdyn.model.land import Land
from trbdyn.model.material import Material, Roughness
from trbdyn.model.pocket import Face, OtherPocket, Pocket
from trbdyn.model.pocket_shapes import default_pocket
from trbdyn.model.roller import Profile, Roller, Scatter

__all__ = ["Bearing", "Cage", "Land", "Material", "Profile", "Ribs", "Roller", "Roughness", "Scatter"]


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
    """

    _assumed: ClassVar[bool] = True

    contact_height: Annotated[Number, parameter("rib_contact_height", gt=0)] = RIG["contact_height"]
    edge_low: Annotated[Number, parameter("rib_edge_low")] = RIG["edge_low"]
    edge_high: Annotated[Number, parameter("rib_edge_high", gt=0)] = RIG["edge_high"]
    front_clearance: Annotated[Number, parameter("front_rib_clearance")] = RIG["front_clearance"]
    front_low: Annotated[Number, parameter("front_rib_low")] = RIG["front_low"]
    front_high: Annotated[Number, parameter("front_rib_high", gt=0)] = RIG["front_high"]

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
        Mass (kg); by default 0.2 kg times the pitch diameter squared and the roller's length over those of the rig.
    inertia_axial, inertia_transverse : float
        Moments of inertia about its axis, and about a transverse axis through its centre of mass (kg m2); by default
        with mass and pitch diameter squared.
    play_radial, play_circumferential : float
        Cpr and Cpc: plays in the x-y plane, radial and circumferential, one-sided, measured to one roller with the cage
        centred and the roller's large end touching its pocket (m); by default 0.25/14 and 0.12/14 of the diameter.
    play_axial : float
        Play along the roller's axis from large-end to small-end contact (m); by default 0.4/14 of the diameter.
    offset : float
        Axial position of the centre of mass from the roller-centre plane (m); assumed.
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
        Elasticity of its faces; that of the bearing by default.
    """

    _assumed: ClassVar[bool] = True

    mass: Annotated[Number, parameter("cage_mass")] = RIG["mass"]
    inertia_axial: Annotated[Number, parameter("cage_inertia_axial")] = RIG["inertia_axial"]
    inertia_transverse: Annotated[Number, parameter("cage_inertia_transverse")] = RIG["inertia_transverse"]
    play_radial: Length = RIG["play_radial"]
    play_circumferential: Length = RIG["play_circumferential"]
    play_axial: Gap = RIG["play_axial"]
    offset: Annotated[Number, parameter("cage_offset")] = 0.0
    rail_offset: Annotated[Number, parameter("cage_rail_offset")] = RIG["rail_offset"]
    bar_width: Length = RIG["bar_width"]
    wall_inner: Gap = RIG["wall_inner"]
    wall_outer: Length = RIG["wall_outer"]
    wall_half_width: Length = RIG["wall_half_width"]
    pocket: Pocket | None = None
    other_pockets: tuple[OtherPocket, ...] = ()
    material: Material | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        given = self.model_fields_set
        if {"inertia_axial", "inertia_transverse"} <= given and self.inertia_axial > 2.0 * self.inertia_transverse:
            limit = f"must be <= 2 inertia_transverse, {2 * self.inertia_transverse:g} (kg m2): no body has more"
            raise InputError.of("inertia_axial", self.inertia_axial, limit)
        if {"wall_inner", "wall_outer"} <= given and self.wall_outer <= self.wall_inner:
            raise InputError.of("wall_outer", self.wall_outer, f"must be > wall_inner, {self.wall_inner:g} (m)")
        indices = [other.index for other in self.other_pockets]
        for place, index in enumerate(indices):
            if index in indices[:place]:
                raise InputError.of(("other_pockets", place, "index"), index, "must differ from the other indices")
        return self


class Bearing(Model):
    """A single-row tapered roller bearing. What is not needed below (rollers, pitch diameter, cup's angle) has a default in
    proportion to the bearing's size, listed by `assumed`.

    Parameters
    ----------
    n_rollers : int
        Z, number of rollers.
    cup_half_angle_deg : float
        alpha_o, half angle of the outer raceway's cone (deg).
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
    name : str
        Name in titles and files.
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
    cup_half_angle_deg: Annotated[Number, unit("deg", ge=0.6, le=45)]
    pitch_diameter: Annotated[Number, parameter("pitch_diameter")]
    roller: Roller
    ribs: Ribs = Ribs()
    cage: Cage = Cage()
    material: Material = Material()
    roughness: Roughness = Roughness()
    land: Land = Land()
    name: Annotated[str, Field(min_length=1)] = "bearing"
    estimates: tuple[Estimated, ...] = ()

    @classmethod
    def from_catalogue(
        cls,
        *,
        bore: float,
        outside: float,
        width: float,
        C: float,
        e: float | None = None,
        Y: float | None = None,
        cup_width: float | None = None,
        n_rollers: int | None = None,
        roller_diameter: float | None = None,
        roller_length: float | None = None,
        pitch_diameter: float | None = None,
        contact_angle_deg: float | None = None,
        cage_mass: float | None = None,
        name: str = "",
    ) -> Bearing:
        """A bearing from the numbers of a catalogue page; what is inside is estimated.

        The angle of the cup follows from e or Y, the length of the rollers from the rating formula of ISO 281, the
        rest from usual ratios. `estimated` lists every estimate with its band and source. Give what you know better.

        Parameters
        ----------
        bore, outside, width : float
            Boundary dimensions d, D and T (m).
        C : float
            Basic dynamic load rating (N).
        e, Y : float, optional
            Calculation factors; one of them, or the contact angle, must be given (1).
        cup_width : float, optional
            Width of the cup, often called C beside T and B (m).
        n_rollers : int, optional
            Z.
        roller_diameter, roller_length, pitch_diameter : float, optional
            Dwe, Lwe, Dpw (m).
        contact_angle_deg : float, optional
            Half angle of the cup (deg).
        cage_mass : float, optional
            Mass of the cage (kg).
        name : str
            Name; by default the boundary dimensions.

        Returns
        -------
        Bearing

        Raises
        ------
        InputError
            If a number is not allowed, or no rollers that fit the dimensions come near this C.

        Notes
        -----
        Sources: ISO 281:2007 (rating, e = 1.5 tan alpha, Y = 0.4 cot alpha); ISO 355 (proportions of the dimension
        series).

        Examples
        --------
        >>> import trbdyn as trb
        >>> bearing = trb.Bearing.from_catalogue(bore=0.080, outside=0.140, width=0.03525, C=187e3, e=0.43,
        ...                                     name="32216")
        >>> print(bearing.estimated[0])
        cup_half_angle_deg = 16 deg (15.82 to 16.17): tan(alpha) = e/1.5 (ISO 281), e as rounded in the catalogue
        """
        fields = fields_from_catalogue(
            bore=bore,
            outside=outside,
            width=width,
            C=C,
            e=e,
            Y=Y,
            cup_width=cup_width,
            n_rollers=n_rollers,
            roller_diameter=roller_diameter,
            roller_length=roller_length,
            pitch_diameter=pitch_diameter,
            contact_angle_deg=contact_angle_deg,
            cage_mass=cage_mass,
            name=name,
        )
        return cls(**fields)

    @property
    def estimated(self) -> tuple[Estimated, ...]:
        """Inputs that are estimated, with their bands and sources; one that was changed since is no longer among
        them.
        """
        return tuple(entry for entry in self.estimates if self._at(entry.path) == entry.value)

    def _at(self, path: str) -> object:
        value: object = self
        for part in path.split("."):
            value = getattr(value, part, None)
        return value

    @model_validator(mode="before")
    @classmethod
    def _fill(cls, values: Any) -> Any:
        return with_assumed(values, _SECTIONS) if isinstance(values, Mapping) else values

    @property
    def assumed(self) -> dict[str, float]:
        """Inputs that were not given: value by path, such as ``{"cage.bar_width": 0.003}``. Lengths in m, SI units.

        Those that follow from the bearing's size, and those that were estimated from a catalogue page; `estimated` gives
        the band and the source of the latter.
        """
        return assumed_inputs(self) | {entry.path: float(entry.value) for entry in self.estimated}

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
        return [(index, face) for index in range(self.n_rollers) for face in self.pocket_of(index).faces]

    @property
    def slot_names(self) -> tuple[str, ...]:
        """Name of each slot of the pockets, in order: the columns of pocket forces in results; empty where no face has
        the slot.
        """
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

    @model_validator(mode="after")
    def _check(self) -> Self:
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
        self._check_pockets(self.geometry)
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
