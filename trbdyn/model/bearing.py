"""Tapered and cylindrical roller bearings by their catalogue numbers.

Cup, cone and roller cones share one apex, or all are cylinders (``cup_half_angle_deg = 0``); everything else follows from
these numbers (`Bearing.geometry`). Lengths in m, densities in kg/m3; angles in degrees where a field is called ``*_deg``.
What is not given is assumed in proportion to the bearing's size (`trbdyn.model.assumed`) and listed by `Bearing.assumed`;
change it where you know better.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator

from trbdyn.base.shown import Shown, field_rows
from trbdyn.base.validation import Length, Model, Number, Whole, unit
from trbdyn.errors import InputError, Path, Problem
from trbdyn.model.assumed import assumed_inputs, with_assumed
from trbdyn.model.cage import Cage
from trbdyn.model.cage_body import CageBody, Wall, cage_mass
from trbdyn.model.cage_space import CageSpace
from trbdyn.model.catalogued import Catalogued
from trbdyn.model.core_table import parameter
from trbdyn.model.estimated import Estimated
from trbdyn.model.flatten import bearing_geometry
from trbdyn.model.geometry import Geometry
from trbdyn.model.land import Land
from trbdyn.model.material import Material, Roughness
from trbdyn.model.pocket import Face, Pocket, every_face
from trbdyn.model.pocket_shapes import default_pocket
from trbdyn.model.ratings import Ratings
from trbdyn.model.ribs import Ribs
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


class Bearing(Catalogued):
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
        Negative: preload, each roller is pressed together by half of it; by a tenth of its diameter at most.
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
        least = -MOST_PRELOAD * most
        if not least <= self.radial_clearance < most:
            allowed = (
                f"must be at least {least:g} and below {most:g}: from a preload by a tenth of the rollers' diameter to a "
                "clearance as large as it (m)"
            )
            raise InputError.of("radial_clearance", self.radial_clearance, allowed)

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

    def _check(self) -> None:
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
MOST_PRELOAD: Final = 0.1
"""Largest preload of a cylindrical bearing, in units of the rollers' diameter: steel is dented from about 0.015 of it on."""
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
    its own. What is None is not looked at; the path of an error begins with `path`.
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
