"""Tapered roller bearings by their catalogue numbers.

Cup, cone and roller cones share one apex; everything else follows from these numbers (`Bearing.geometry`). Lengths in
m, densities in kg/m3; angles in degrees where a field is called ``*_deg``. What is not given is assumed in
proportion to the bearing's size (`trbdyn.assumed`) and listed by `Bearing.assumed`; change it where you know better.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator

from trbdyn.assumed import RIG, assumed_inputs, with_assumed
from trbdyn.errors import InputError, Path, Problem
from trbdyn.estimated import Estimated
from trbdyn.geometry import Geometry
from trbdyn.pocket import Face, OtherPocket, Pocket
from trbdyn.validation import Gap, Length, Model, Number, Whole, unit


class Profile(Model):
    """Shape of the roller's generator; only the numbers of its kind are used.

    Parameters
    ----------
    kind : {'logarithmic', 'crowned', 'straight'}
        Logarithmic: drop A ln{1/[1 - (1 - exp(-zm/A)) ((abs(y) - a)/(k2 a) + 1)^2]} for abs(y) > a - k2 a with A = 2 k1 Q/(pi
        L E'), a = L/2.
    crown_radius : float
        Radius of the arc of a crowned roller (m).
    k1, k2 : float
        Constants of the logarithmic profile (1).
    zm : float
        Drop of the logarithmic profile at the end (m).
    load : float
        Design load Q of the logarithmic profile (N); by default the one of the 30310 rig times diameter and length of
        the roller over those of the rig, that is at the same pressure.
    """

    _assumed: ClassVar[bool] = True

    kind: Literal["logarithmic", "crowned", "straight"] = "logarithmic"
    crown_radius: Annotated[Number, unit("m", ge=1e-3, le=1e9)] = 100.0
    k1: Annotated[Number, unit("1", ge=0, le=100)] = 1.5
    k2: Annotated[Number, unit("1", ge=0.001, le=1)] = 0.4
    zm: Annotated[Number, unit("m", ge=0, le=1e-3)] = 10e-6
    load: Annotated[Number, unit("N", ge=1e-3, le=1e9)] = RIG["load"]

    @classmethod
    def straight(cls) -> Self:
        """A straight generator."""
        return cls(kind="straight")

    @classmethod
    def crowned(cls, radius: float) -> Self:
        """An arc of this radius (m)."""
        return cls(kind="crowned", crown_radius=radius)

    @classmethod
    def logarithmic(cls, load: float | None = None, *, k1: float = 1.5, k2: float = 0.4, zm: float = 10e-6) -> Self:
        """A logarithmic profile for a design load (N); without it the one that the roller's size gives."""
        given = {} if load is None else {"load": load}
        return cls(kind="logarithmic", k1=k1, k2=k2, zm=zm, **given)


class Material(Model):
    """Elasticity of a body.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus (Pa).
    poisson_ratio : float
        Poisson's ratio (1).
    """

    _assumed: ClassVar[bool] = True

    youngs_modulus: Annotated[Number, unit("Pa", ge=1e8, le=1e13)] = 206e9
    poisson_ratio: Annotated[Number, unit("1", ge=0, le=0.4999)] = 0.3

    @classmethod
    def steel(cls) -> Self:
        """Bearing steel: 206 GPa, 0.3."""
        return cls(youngs_modulus=206e9, poisson_ratio=0.3)

    @classmethod
    def silicon_nitride(cls) -> Self:
        """Silicon nitride of rollers: 310 GPa, 0.26; give the rollers a density of 3200 kg/m3."""
        return cls(youngs_modulus=310e9, poisson_ratio=0.26)

    @classmethod
    def polyamide(cls) -> Self:
        """Polyamide 66 with a quarter of glass fibre at 60 C, conditioned: 3.5 GPa, 0.4; such a cage weighs a sixth of
        steel.
        """
        return cls(youngs_modulus=3.5e9, poisson_ratio=0.4)

    @classmethod
    def brass(cls) -> Self:
        """Brass of machined cages: 100 GPa, 0.34."""
        return cls(youngs_modulus=100e9, poisson_ratio=0.34)


class Scatter(Model):
    """Random deviations of the rollers' diameters.

    Parameters
    ----------
    range : float
        Width of the range (m): each deviation is uniform over -range/2 to range/2.
    seed : int
        Seed of the random numbers.
    """

    range: Annotated[Number, unit("m", ge=0, le=1e-3)]
    seed: Annotated[Whole, unit("1", ge=0)]

    def draw(self, count: int) -> NDArray[np.float64]:
        """The deviations (m), shape (count,): the same ones for the same seed."""
        return np.random.default_rng(self.seed).uniform(-0.5 * self.range, 0.5 * self.range, count)


class Roller(Model):
    """A tapered roller.

    Parameters
    ----------
    diameter : float
        Dwe, diameter at mid length, perpendicular to the roller's axis (m).
    effective_length : float
        Lwe, effective length of the contact line (m).
    total_length : float
        Length over the ends, centred on the effective length (m); by default the effective length and a fourteenth of
        the diameter.
    density : float
        Density (kg/m3).
    profile : Profile
        Shape of the generator.
    diameter_deviation : sequence of float, optional
        Deviation of each roller's diameter (m), one a roller; not together with `diameter_scatter`.
    diameter_scatter : Scatter, optional
        Random deviations, one for each roller.
    sphere_ratio : float
        Radius of the large end's sphere over the distance from the apex to the large end (1); assumed.
    end_stiffness : float
        k of roller end against a flat of the ring, force = k d^1.5 (N/m^1.5); against the cage's walls in the ratio of
        the composite moduli. By default 1e10 times the root of the diameter over that of the 30310 rig; assumed.
    material : Material, optional
        Elasticity of the rollers; that of the bearing by default.
    """

    _assumed: ClassVar[bool] = True

    diameter: Length
    effective_length: Length
    total_length: Length = RIG["total_length"]
    density: Annotated[Number, unit("kg/m3", ge=100, le=30000)] = 7810.0
    profile: Profile = Profile()
    diameter_deviation: tuple[Annotated[Number, unit("m", ge=-1e-3, le=1e-3)], ...] | None = None
    diameter_scatter: Scatter | None = None
    sphere_ratio: Annotated[Number, unit("1", ge=0.05, le=0.999)] = 0.90
    end_stiffness: Annotated[Number, unit("N/m^1.5", ge=1, le=1e14)] = RIG["end_stiffness"]
    material: Material | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        if "total_length" in self.model_fields_set and self.total_length < self.effective_length:
            limit = f"must be >= effective_length, {self.effective_length:g} (m)"
            raise InputError.of("total_length", self.total_length, limit)
        if self.diameter_deviation is not None and self.diameter_scatter is not None:
            raise InputError.of(
                "diameter_scatter", self.diameter_scatter, "must not be given together with diameter_deviation"
            )
        return self


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

    contact_height: Length = RIG["contact_height"]
    edge_low: Gap = RIG["edge_low"]
    edge_high: Length = RIG["edge_high"]
    front_clearance: Gap = RIG["front_clearance"]
    front_low: Gap = RIG["front_low"]
    front_high: Length = RIG["front_high"]

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

    mass: Annotated[Number, unit("kg", gt=0)] = RIG["mass"]
    inertia_axial: Annotated[Number, unit("kg m2", gt=0)] = RIG["inertia_axial"]
    inertia_transverse: Annotated[Number, unit("kg m2", gt=0)] = RIG["inertia_transverse"]
    play_radial: Length = RIG["play_radial"]
    play_circumferential: Length = RIG["play_circumferential"]
    play_axial: Gap = RIG["play_axial"]
    offset: Annotated[Number, unit("m", ge=-1, le=1)] = 0.0
    rail_offset: Annotated[Number, unit("m", ge=-1, le=1)] = RIG["rail_offset"]
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


class Land(Model):
    """The land of a ring that guides the cage, and the guiding surface of the cage on it: a ring about the cage's axis. It acts
    where `Effects.guidance` says so. What is not given is assumed in proportion to the 30310 rig; catalogues tell nothing of it,
    so show the effect of its numbers over their bands.

    Parameters
    ----------
    offset : float
        Axial position of the middle of the guiding surface from the roller-centre plane, positive towards the large ends (m);
        by default 12/19.8 of the roller's length, at the large-end rail.
    inner_radius, outer_radius : float
        Radius of the land of the inner ring, and of the outer ring (m); `Effects.guidance` chooses one. By default 39.5/82.389
        and 50.5/82.389 of the pitch diameter.
    width : float
        Width of the guiding surface (m); by default 3/19.8 of the roller's length.
    clearance : float
        Radial clearance between cage and land (m); by default 0.1/14 of the roller's diameter; usual are 0.1 to 0.4 % of the
        land's radius. The rollers guide the cage where their plays are smaller.
    contact_film : float
        Height of the film below which roughness peaks of cage and land touch (m), from 1e-4 to 0.5 of the clearance; by
        default a hundredth of the clearance, which is 1 um at the rig. The law of the film holds down to this height.
    fill : float
        Share of the guiding surface's width that is filled with oil, from 0 (no film) to 1 (1); 1 by default. It is known in no
        bearing.
    """

    _assumed: ClassVar[bool] = True

    offset: Annotated[Number, unit("m", ge=-1, le=1)] = RIG["rail_offset"]
    inner_radius: Annotated[Number, unit("m", ge=1e-4, le=10)] = RIG["land_inner_radius"]
    outer_radius: Annotated[Number, unit("m", ge=1e-4, le=10)] = RIG["land_outer_radius"]
    width: Annotated[Number, unit("m", ge=1e-5, le=1)] = RIG["land_width"]
    clearance: Annotated[Number, unit("m", ge=1e-7, le=0.1)] = RIG["land_clearance"]
    contact_film: Annotated[Number, unit("m", ge=1e-9, le=1e-2)] = RIG["land_contact_film"]
    fill: Annotated[Number, unit("1", ge=0, le=1)] = 1.0


class Roughness(Model):
    """Composite rms roughness of the rolling contacts.

    Parameters
    ----------
    raceway : float
        Roller and raceway (m).
    rib : float
        Roller end and back-face rib (m).
    """

    _assumed: ClassVar[bool] = True

    raceway: Annotated[Number, unit("m", ge=1e-10, le=1e-3)] = 0.16e-6
    rib: Annotated[Number, unit("m", ge=1e-10, le=1e-3)] = 0.24e-6


class Bearing(Model):
    """A single-row tapered roller bearing. Needed are the number of rollers, their diameter and length, the pitch
    diameter and the cup's angle; every other number has a default in proportion to the bearing's size, listed by
    `assumed`.

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

    n_rollers: Annotated[Whole, unit("1", ge=3, le=200)]
    cup_half_angle_deg: Annotated[Number, unit("deg", ge=0.6, le=45)]
    pitch_diameter: Length
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
        from trbdyn.catalogue import bearing_from_catalogue

        return bearing_from_catalogue(
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
        return with_assumed(values) if isinstance(values, Mapping) else values

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
        from trbdyn.flatten import bearing_geometry

        return bearing_geometry(self)

    @property
    def pocket(self) -> Pocket:
        """The pocket of the cage that every roller has unless `cage.other_pockets` says otherwise."""
        from trbdyn.pocket_shapes import default_pocket

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


def _under(path: Path, problems: list[Problem]) -> list[Problem]:
    return [Problem(path + problem.path, problem.value, problem.allowed) for problem in problems]
