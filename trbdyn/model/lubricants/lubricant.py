"""An oil at every temperature, a lubricant at one, and the oils that ship."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Final, Literal, Self

from pydantic import SerializerFunctionWrapHandler, model_serializer, model_validator

from trbdyn.base.validation import Flag, Model, Number, as_number, number_of, split_paths, unit
from trbdyn.errors import InputError
from trbdyn.model.core_table import parameter
from trbdyn.model.lubricants.viscosity import Dicke, Vogel, astm_d341, wooster

_ROELANDS_VISCOSITY = 6.31e-5
_HIGHEST_PRESSURE = 1e10
"""Largest pressure (Pa) at which a viscosity law is asked."""
_SAME_OIL = 1e-6
"""Share by which a number may differ from what its oil gives and still be the same."""
_SAME_SLOPE = 0.01
"""Share by which alpha0 may differ from the slope of the pressure law."""
_MM2 = 1e-6
LOWEST_TEMPERATURE_C: Final = -40.0
LOWEST_MEASURED_C: Final = -20.0
HIGHEST_TEMPERATURE_C: Final = 200.0
"""Temperatures (C) at which an oil is known: by ASTM D341, by a law of Vogel, and at most."""
TEMPERATURES: Final = {
    "ring": (-3.0, 10.0, "of the ring: films are as warm or warmer, the thermocouple errs by 3 K: assumed"),
    "film": (-3.0, 3.0, "of the films: assumed"),
    "supply": (0.0, 25.0, "of the oil that is supplied: films are warmer: assumed"),
}
"""By what the temperature was measured on (`Lubricant.temperature_of`): how far films may be from it (K), and why."""
PressureLaw = Literal["dicke", "roelands", "barus"]


class Oil(Model):
    """An oil at every temperature: by its viscosities at 40 and 100 C (ASTM D341), or by a measured law of Vogel.

    Parameters
    ----------
    name : str
        Name of the oil.
    nu40, nu100 : float, optional
        Kinematic viscosities at 40 and 100 C (mm2/s).
    vogel : Vogel, optional
        Measured dynamic viscosity, in place of `nu40` and `nu100`.
    density : float
        Density at 15 C (kg/m3).
    expansion : float
        Share by which the density falls for a degree (1/K).
    base : {'mineral', 'synthetic'}
        Base of the oil. alpha0 follows from `wooster`; synthetic oils (PAO) have three quarters of it (assumed:
        published ratios lie between 0.7 and 0.8).
    pressure_coefficient : float, optional
        Measured alpha0 (1/Pa) at `pressure_coefficient_c`, in place of that correlation, which then only carries it to
        other temperatures.
    pressure_coefficient_c : float
        Temperature at which alpha0 was measured (C).
    dicke : Dicke, optional
        Measured law of viscosity against pressure; alpha0 is then its slope at zero pressure. Without it: Roelands.
    conductivity : float
        k', thermal conductivity (W/mK).
    eyring_stress : float
        tau0, characteristic shear stress (Pa).

    Examples
    --------
    >>> import trbdyn as trb
    >>> own = trb.Oil(name="own", nu40=68.0, nu100=8.7, density=880.0)
    >>> round(1e3 * own.at(70.0).viscosity, 2)
    17.08
    """

    name: str = "oil"
    nu40: Annotated[Number, unit("mm2/s", ge=0.5, le=1e5)] | None = None
    nu100: Annotated[Number, unit("mm2/s", ge=0.3, le=1e4)] | None = None
    vogel: Vogel | None = None
    density: Annotated[Number, unit("kg/m3", ge=500, le=2500)] = 880.0
    expansion: Annotated[Number, unit("1/K", ge=0, le=2e-3)] = 6.5e-4
    base: Literal["mineral", "synthetic"] = "mineral"
    pressure_coefficient: Annotated[Number, unit("1/Pa", ge=1e-10, le=1e-6)] | None = None
    pressure_coefficient_c: Annotated[Number, unit("C", ge=-40, le=200)] = 40.0
    dicke: Dicke | None = None
    conductivity: Annotated[Number, parameter("conductivity")] = 0.134
    eyring_stress: Annotated[Number, parameter("eyring_stress")] = 5e6

    def _check(self) -> None:
        for name, value in (("nu40", self.nu40), ("nu100", self.nu100)):
            if value is None and self.vogel is None:
                raise InputError.of(name, value, "must be given, or vogel (mm2/s)")
            if value is not None and self.vogel is not None:
                raise InputError.of(name, value, "must not be given together with vogel (mm2/s)")
        if self.nu40 is not None and self.nu100 is not None and self.nu100 >= self.nu40:
            raise InputError.of("nu100", self.nu100, f"must be < nu40, {self.nu40:g} (mm2/s)")
        if self.dicke is not None and self.pressure_coefficient is not None:
            limit = "must not be given together with dicke, whose slope at zero pressure it is (1/Pa)"
            raise InputError.of("pressure_coefficient", self.pressure_coefficient, limit)

    def __repr__(self) -> str:
        known = f"{self.nu40:g} and {self.nu100:g} mm2/s at 40 and 100 C" if self.vogel is None else "law of Vogel"
        return f"<Oil {self.name}: {known}>"

    __str__ = __repr__

    def density_at(self, temperature_c: float) -> float:
        """Density (kg/m3) at a temperature (C)."""
        return self.density * (1.0 - self.expansion * (temperature_c - 15.0))

    def viscosity_at(self, temperature_c: float) -> float:
        """eta0 (Pa s) at a temperature (C)."""
        if self.vogel is not None:
            return self.vogel.a * math.exp(self.vogel.b / (temperature_c + self.vogel.c))
        assert self.nu40 is not None
        assert self.nu100 is not None
        return _MM2 * astm_d341(temperature_c, self.nu40, self.nu100) * self.density_at(temperature_c)

    def temperature_coefficient_at(self, temperature_c: float) -> float:
        """beta = -d ln(eta0)/dt (1/K) at a temperature (C)."""
        if self.vogel is not None:
            return self.vogel.b / (temperature_c + self.vogel.c) ** 2
        step = 1e-2
        ratio = self.viscosity_at(temperature_c - step) / self.viscosity_at(temperature_c + step)
        return math.log(ratio) / (2.0 * step)

    def pressure_coefficient_at(self, temperature_c: float) -> float:
        """alpha0 (1/Pa) at a temperature (C)."""
        if self.dicke is not None:
            return self.dicke.pressure_coefficient(temperature_c)
        found = wooster(self.viscosity_at(temperature_c)) * (0.75 if self.base == "synthetic" else 1.0)
        if self.pressure_coefficient is None:
            return found
        there = wooster(self.viscosity_at(self.pressure_coefficient_c)) * (0.75 if self.base == "synthetic" else 1.0)
        return self.pressure_coefficient * found / there

    def at(self, temperature_c: float, **fields: Any) -> Lubricant:
        """The oil at a temperature (C); `fields` are other fields of `Lubricant`."""
        return Lubricant(oil=self, temperature_c=temperature_c, **fields)


_OF_THE_OIL: Final = {
    "viscosity": ("viscosity_at", "Pa s"),
    "pressure_coefficient": ("pressure_coefficient_at", "1/Pa"),
    "temperature_coefficient": ("temperature_coefficient_at", "1/K"),
    "density": ("density_at", "kg/m3"),
}
"""Fields of a lubricant that follow from its oil and temperature: how, and their unit."""


class Lubricant(Model):
    """An oil at one temperature: by its `oil`, from which everything follows, or by numbers that belong to this
    temperature.

    Parameters
    ----------
    oil : Oil or str, optional
        The oil, or the name of one that ships, see `OILS`. viscosity, pressure_coefficient, temperature_coefficient and
        density follow from it and must then not be given.
    temperature_c : float
        Temperature of the oil in the contacts (C).
    temperature_of : {'ring', 'film', 'supply'}
        What this temperature was measured on, or is that of: the ring, the films themselves, or the oil that is supplied. It
        changes no number but the band of the temperature in `trbdyn.uncertainty`: from 3 K below to 10 K above that of the
        ring, 3 K about that of films, up to 25 K above that of supplied oil.
    viscosity : float
        eta0, dynamic viscosity at ambient pressure (Pa s).
    pressure_coefficient : float
        alpha0, pressure-viscosity coefficient (1/Pa), used by the films and by the laws of Roelands and Barus; it must
        agree with the slope of the law of Dicke where that is used.
    temperature_coefficient : float
        beta = -d ln(eta0)/dt (1/K).
    density : float
        Density (kg/m3).
    conductivity : float
        k', thermal conductivity (W/mK).
    pressure_law : {'dicke', 'roelands', 'barus'}
        Law of viscosity against pressure that the traction uses; by default that of Dicke where its constants are
        known, else that of Roelands. Barus is capped.
    dicke : Dicke, optional
        Measured constants of the law of Dicke.
    viscosity_exponent_cap : float
        Largest ln(eta/eta0) of Roelands and Barus (assumed: 25).
    eyring_stress : float
        tau0, characteristic shear stress (Pa): 3 to 8 MPa.
    shear_modulus_floor : float
        Smallest limiting shear modulus Ginf (Pa).
    cleanliness : {'13/10', '15/12', '17/14', '19/16', '21/18'}, optional
        Particles in the oil, the last two numbers of the code of ISO 4406; only `trbdyn.rating` uses it.
    filtered : bool
        Circulating oil with an in-line filter; only `trbdyn.rating` uses it.
    name : str
        Name of the oil.

    Raises
    ------
    InputError
        If a number is not allowed, or contradicts the oil or the pressure law.

    Examples
    --------
    >>> import trbdyn as trb
    >>> warm = trb.Lubricant(oil="vg68", temperature_c=60.0)
    >>> hot = warm.replace(temperature_c=90.0)
    >>> warm.viscosity > 2 * hot.viscosity
    True
    """

    viscosity: Annotated[Number, parameter("viscosity")]
    pressure_coefficient: Annotated[Number, parameter("pressure_coefficient")]
    temperature_coefficient: Annotated[Number, parameter("temperature_coefficient")]
    temperature_c: Annotated[Number, parameter("temperature")]
    temperature_of: Literal["ring", "film", "supply"] = "ring"
    density: Annotated[Number, parameter("oil_density")] = 860.6
    conductivity: Annotated[Number, parameter("conductivity")] = 0.134
    pressure_law: PressureLaw = "roelands"
    dicke: Dicke | None = None
    viscosity_exponent_cap: Annotated[Number, parameter("viscosity_exponent_cap")] = 25.0
    eyring_stress: Annotated[Number, parameter("eyring_stress")] = 5e6
    shear_modulus_floor: Annotated[Number, parameter("shear_modulus_floor")] = 1e7
    cleanliness: Literal["13/10", "15/12", "17/14", "19/16", "21/18"] | None = None
    filtered: Flag = False
    oil: Oil | None = None
    name: str = "oil"

    _root: ClassVar[str | None] = "lubricant"

    def __repr__(self) -> str:
        return f"<Lubricant {self._title()}, {1e3 * self.viscosity:.4g} mPa s>"

    __str__ = __repr__

    def _title(self) -> str:
        temperature = f" at {self.temperature_c:g} C"
        return self.name if self.name.endswith(temperature) else f"{self.name}{temperature}"

    @model_validator(mode="before")
    @classmethod
    def _from_oil(cls, values: Any) -> Any:
        if not isinstance(values, Mapping):
            return values
        found = dict(values)
        if found.get("oil") is None:
            if found.get("dicke") is not None:
                found.setdefault("pressure_law", "dicke")
            return found
        oil = _oil(found["oil"])
        found["oil"] = oil
        lowest = LOWEST_TEMPERATURE_C if oil.vogel is None else LOWEST_MEASURED_C
        given = found.setdefault("temperature_c", 60.0)
        temperature = number_of("temperature_c", given, "C", ge=lowest, le=HIGHEST_TEMPERATURE_C)
        found.setdefault("dicke", oil.dicke)
        found.setdefault("pressure_law", "dicke" if found["dicke"] is not None else "roelands")
        own = Dicke.model_validate(found["dicke"]) if found["pressure_law"] == "dicke" and found["dicke"] else None
        for name, (law, symbol) in _OF_THE_OIL.items():
            right = getattr(oil, law)(temperature)
            if name == "pressure_coefficient" and own is not None:
                right = own.pressure_coefficient(temperature)
            given = found.setdefault(name, right)
            try:
                number = as_number(given)
            except ValueError:
                continue  # reported with its field
            if abs(number - right) > _SAME_OIL * abs(right):
                limit = (
                    f"must be left out: {oil.name} has {right:.6g} at {temperature:g} C; for an oil of your own give "
                    f"{', '.join(_OF_THE_OIL)} without oil ({symbol})"
                )
                raise InputError.of(name, given, limit)
        found.setdefault("conductivity", oil.conductivity)
        found.setdefault("eyring_stress", oil.eyring_stress)
        found.setdefault("name", f"{oil.name} at {temperature:g} C")
        return found

    def _check(self) -> None:
        if self.pressure_law == "dicke":
            self._check_dicke()
        if self.pressure_law == "roelands" and self.viscosity <= _ROELANDS_VISCOSITY:
            raise InputError.of(
                "viscosity", self.viscosity, f"must be > {_ROELANDS_VISCOSITY:g}, where the Roelands law ends (Pa s)"
            )

    def _check_dicke(self) -> None:
        law, temperature = self.dicke, self.temperature_c
        if law is None:
            limit = "must be 'roelands' or 'barus': 'dicke' needs its measured constants, dicke = {a, b, c, d}"
            raise InputError.of("pressure_law", self.pressure_law, limit)
        stiffness = law.a + law.b * temperature
        if stiffness <= 0:
            raise InputError.of("temperature_c", temperature, "must keep a + b t of the Dicke law > 0 (C)")
        slope = law.c + law.d * temperature
        if slope < 0 and stiffness * 1e5 <= -slope * _HIGHEST_PRESSURE:
            limit = f"{_HIGHEST_PRESSURE / 1e9:g} GPa"
            raise InputError.of("temperature_c", temperature, f"must keep the pole of the Dicke law above {limit} (C)")
        expected = law.pressure_coefficient(temperature)
        if abs(self.pressure_coefficient - expected) > _SAME_SLOPE * expected:
            limit = (
                f"must be {expected:.4g}, the slope of its Dicke law at {temperature:g} C; or give other constants of that "
                "law, or pressure_law = 'roelands' (1/Pa)"
            )
            raise InputError.of("pressure_coefficient", self.pressure_coefficient, limit)

    @model_serializer(mode="wrap")
    def _plain(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        values: dict[str, Any] = handler(self)
        if self.oil is not None:
            for name in (*_OF_THE_OIL, "name"):
                values.pop(name, None)
        return values

    def replace(self, changes: Mapping[str, Any] | None = None, /, **fields: Any) -> Self:
        """A copy with some fields changed, validated again; `changes` by path as for every model.

        With an `oil` a change of `temperature_c` changes everything that follows from it. A change of what follows
        from the oil (viscosity, pressure_coefficient, temperature_coefficient, density) gives a lubricant by numbers,
        without oil.

        Raises
        ------
        InputError
            If a name is unknown or a value not allowed, or the numbers of a lubricant without oil do not belong to the
            new temperature.
        """
        new = {**(self._changed(split_paths(changes)) if changes is not None else {}), **fields}
        own = {name: getattr(self, name) for name in type(self).model_fields}
        derived = (*_OF_THE_OIL, "name")
        if new.get("oil") is not None:
            for name in (*derived, "dicke", "pressure_law", "conductivity", "eyring_stress"):
                own.pop(name)
        elif self.oil is not None and "oil" not in new:
            if any(name in new for name in _OF_THE_OIL):
                if "temperature_c" in new:
                    moved = self.replace(temperature_c=new["temperature_c"])
                    own = {name: getattr(moved, name) for name in own}
                own |= {"oil": None, "name": f"{own['name']}, changed"}
            else:
                for name in derived:
                    own.pop(name)
        elif self._moved_without_viscosity(new):
            limit = (
                f"must come with viscosity, pressure_coefficient and temperature_coefficient: those given belong to "
                f"{self.temperature_c:g} C; or give an oil, which has them at every temperature (C)"
            )
            raise InputError.of("temperature_c", new["temperature_c"], limit)
        return type(self)(**{**own, **new})

    def _moved_without_viscosity(self, new: Mapping[str, Any]) -> bool:
        moved = new.get("temperature_c", self.temperature_c) != self.temperature_c
        return self.oil is None and moved and "viscosity" not in new

    @property
    def kinematic_viscosity(self) -> float:
        """Kinematic viscosity (m2/s)."""
        return self.viscosity / self.density


def _oil(given: Any) -> Oil:
    """An oil as users give it: itself, its table, or the name of one that ships."""
    if isinstance(given, Oil):
        return given
    if isinstance(given, Mapping):
        try:
            return Oil(**given)
        except InputError as error:
            raise error.under(("oil",)) from None
    if not isinstance(given, str) or given.lower() not in SHIPPED:
        choices = ", ".join(repr(name) for name in SHIPPED)
        raise InputError.of("oil", given, f"must be one of {choices}, or an Oil")
    return SHIPPED[given.lower()]


FVA3: Final = Oil(
    name="VG100 (FVA3)",
    vogel=Vogel(a=0.062e-3, b=1021.7, c=101.55),
    density=887.6,
    expansion=0.6 / 887.6,
    dicke=Dicke(),
)
"""The mineral oil FVA3, an ISO VG 100, as measured (Wingertszahn 2023, Lubricants 11:369)."""

_TYPICAL_NU100: Final = {32: 5.4, 46: 6.8, 68: 8.7, 100: 11.4, 150: 15.0, 220: 19.4, 320: 25.0, 460: 30.8}
"""Typical viscosities at 100 C (mm2/s) of mineral oils of a viscosity index of 95 to 100, by ISO VG."""

_DENSITY_OF_GRADE: Final = {32: 870.0, 46: 875.0, 68: 880.0, 100: 885.0, 150: 890.0, 220: 895.0, 320: 900.0, 460: 903.0}

MINERAL: Final = {
    grade: Oil(name=f"VG{grade}", nu40=float(grade), nu100=nu100, density=_DENSITY_OF_GRADE[grade])
    for grade, nu100 in _TYPICAL_NU100.items()
}
"""Ordinary mineral oils by ISO VG (ISO 3448): typical data-sheet values."""

GEAR_75W90: Final = Oil(name="gear oil 75W-90", nu40=100.0, nu100=15.0, density=866.0, base="synthetic")
"""A synthetic gear oil SAE 75W-90: typical data-sheet values."""
GEAR_80W90: Final = Oil(name="gear oil 80W-90", nu40=138.0, nu100=14.5, density=895.0)
"""A mineral gear oil SAE 80W-90: typical data-sheet values."""
ATF: Final = Oil(name="ATF", nu40=30.0, nu100=6.0, density=848.0)
"""An automatic transmission fluid of the present low-viscosity kind: typical data-sheet values."""

SHIPPED: Final[dict[str, Oil]] = {
    "vg100": FVA3,
    "fva3": FVA3,
    **{f"vg{grade}": oil for grade, oil in MINERAL.items() if grade != 100},
    "gear_75w90": GEAR_75W90,
    "gear_80w90": GEAR_80W90,
    "atf": ATF,
}
