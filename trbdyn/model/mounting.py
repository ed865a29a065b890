"""How a bearing sits on its shaft and in its housing, and the temperatures of these parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Final, Literal, Self

from trbdyn.base.validation import Gap, Length, Model, Number, unit
from trbdyn.errors import InputError
from trbdyn.model.material import Material
from trbdyn.model.tolerances import CLEARANCES, BearingClass, Limits, Series, clearance_limits, limits, series_of

Celsius = Annotated[Number, unit("C", ge=-200, le=600)]
Deviation = Annotated[Number, unit("m", ge=-0.01, le=0.01)]

USUAL_HOUSING: Final = 1.5
"""Outside diameter of a housing over that of the bearing where it is not given; assumed."""
GROUND: Final = 2e-3
"""Length by which smoothing takes of an interference U on the diameter d: U d/(d + GROUND) is left of ground seats (m), 3 mm of
turned ones (NSK, Rolling Bearings, CAT. No. E1102, fits)."""


class Mounting(Model):
    """Boundary dimensions of a bearing, the tolerances of its seats, and what shaft and housing are made of.

    Parameters
    ----------
    bore, outside, width : float
        Bore d, outside diameter D and width T (B of a cylindrical bearing) (m).
    shaft, housing : str or tuple of float
        Tolerance class of the seat by ISO 286, as ``"m6"`` and ``"N7"``, or the lower and upper deviation from the nominal size
        (m).
    accuracy : {'normal', '6', '5', '4', '2', '3', '0', '00'}
        Class of the bearing's tolerances: normal, 6, 5 or 4 by ISO 492; tapered bearings have no 6, and their 6X has the
        diameters of 'normal'. Of an inch series 4, which is 'normal', 2, 3, 0 or 00 by ISO 578.
    series : {'metric', 'inch'}, optional
        Series of a tapered bearing, which decides between ISO 492 and ISO 578. By default its designation tells it, cone and
        cup as LM67048/LM67010 or five digits as 32208, else its diameters, which are whole millimetres in a metric series.
        Cylindrical bearings are metric.
    clearance : str or tuple of float
        Radial clearance of a cylindrical bearing before mounting: 'C2', 'CN', 'C3' or 'C4' by ISO 5753-1, or its limits (m),
        negative ones as well, as a tapered bore that is driven up its seat has them. Tapered bearings do not use it.
    set : {'mounted', 'before mounting'}
        When the end play of tapered bearings was set. That of mounted bearings has the fits in it already: only what
        temperatures change acts. Sets that are matched by spacers before mounting lose end play by their fits.
    shaft_bore : float
        Bore of a hollow shaft (m).
    housing_outside : float, optional
        Outside diameter of the housing around the seat (m); 1.5 times that of the bearing by default, assumed.
    shaft_material, housing_material : Material
        Steel by default. They need their thermal expansion where a temperature differs from `reference_c`.
    smoothing : float
        Length s (m): of an interference U on the diameter d, U d/(d + s) is left when the peaks of both surfaces are flattened;
        2 mm for ground seats, assumed, 3 mm for turned ones, 0 for none.
    reference_c : float
        Temperature of all parts at which dimensions and end play are given (C).

    Examples
    --------
    >>> import trbdyn as trb
    >>> seat = trb.Mounting(bore=0.050, outside=0.110, width=0.02925, shaft="m6", housing="N7")
    >>> [round(1e6 * end) for end in seat.shaft_limits]
    [9, 25]
    """

    bore: Length
    outside: Length
    width: Length
    shaft: str | tuple[Deviation, Deviation]
    housing: str | tuple[Deviation, Deviation]
    accuracy: BearingClass = "normal"
    series: Series | None = None
    clearance: str | tuple[Deviation, Deviation] = "CN"
    set: Literal["mounted", "before mounting"] = "mounted"
    shaft_bore: Gap = 0.0
    housing_outside: Length | None = None
    shaft_material: Material = Material.steel()
    housing_material: Material = Material.steel()
    smoothing: Annotated[Number, unit("m", ge=0.0, le=0.1)] = GROUND
    reference_c: Celsius = 20.0

    def _check(self) -> None:
        if not self.outside > self.bore:
            raise InputError.of("outside", self.outside, f"must be above the bore, {self.bore:g} (m)")
        if not self.shaft_bore < self.bore:
            raise InputError.of("shaft_bore", self.shaft_bore, f"must be below the bearing's bore, {self.bore:g} (m)")
        if not self.outer_housing > self.outside:
            limit = f"must be above the bearing's outside diameter, {self.outside:g} (m)"
            raise InputError.of("housing_outside", self.housing_outside, limit)
        for name, ends in (("shaft", self.shaft_limits), ("housing", self.housing_limits)):
            if not ends[0] <= ends[1]:
                raise InputError.of(name, getattr(self, name), "must be the lower and then the upper deviation (m)")
            code = getattr(self, name)
            if isinstance(code, str) and code[0].isupper() != (name == "housing"):
                kinds = "a capital letter, as N7" if name == "housing" else "a small letter, as m6"
                raise InputError.of(name, code, f"must have {kinds}: capital letters are those of holes")
        if isinstance(self.clearance, str):
            if self.clearance not in CLEARANCES:
                limit = f"must be one of {', '.join(CLEARANCES)}, or two limits (m)"
                raise InputError.of("clearance", self.clearance, limit)
        elif self.clearance[0] > self.clearance[1]:
            raise InputError.of("clearance", self.clearance, "must be the smallest and then the largest one (m)")

    @property
    def outer_housing(self) -> float:
        """Outside diameter of the housing, given or assumed (m)."""
        return USUAL_HOUSING * self.outside if self.housing_outside is None else self.housing_outside

    @property
    def shaft_limits(self) -> Limits:
        """Deviations of the shaft (m)."""
        return limits(self.shaft, self.bore, field="shaft") if isinstance(self.shaft, str) else self.shaft

    @property
    def housing_limits(self) -> Limits:
        """Deviations of the housing's bore (m)."""
        return limits(self.housing, self.outside, field="housing") if isinstance(self.housing, str) else self.housing

    def series_for(self, name: str) -> tuple[Series, str]:
        """Series of a tapered bearing of this name, and what tells it."""
        return (self.series, "as given") if self.series is not None else series_of(name, self.bore, self.outside)

    @property
    def clearance_limits(self) -> Limits:
        """Radial clearance before mounting (m)."""
        if isinstance(self.clearance, str):
            return clearance_limits(self.clearance, self.bore)
        return self.clearance


class Temperatures(Model):
    """Temperatures of a bearing's parts and of what it sits on and in.

    Parameters
    ----------
    shaft_c, inner_ring_c, rollers_c, outer_ring_c, housing_c : float
        Temperatures (C).

    Examples
    --------
    >>> import trbdyn as trb
    >>> trb.Temperatures.uniform(80.0).housing_c
    80.0
    """

    shaft_c: Celsius
    inner_ring_c: Celsius
    rollers_c: Celsius
    outer_ring_c: Celsius
    housing_c: Celsius

    @classmethod
    def uniform(cls, temperature_c: float) -> Self:
        """All parts at one temperature (C)."""
        return cls(**dict.fromkeys(cls.model_fields, temperature_c))

    @classmethod
    def of_nodes(cls, nodes: Mapping[str, float]) -> Self:
        """From the temperatures of `trbdyn.thermal`: its inner ring has the shaft with it, its outer ring the housing."""
        return cls(
            shaft_c=nodes["inner_ring"],
            inner_ring_c=nodes["inner_ring"],
            rollers_c=nodes["rollers"],
            outer_ring_c=nodes["outer_ring"],
            housing_c=nodes["outer_ring"],
        )
