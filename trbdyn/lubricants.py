"""Oils: viscosity against temperature and pressure."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import model_validator

from trbdyn.errors import InputError
from trbdyn.validation import Model, Number, as_number, unit

_ROELANDS_VISCOSITY = 6.31e-5
_HIGHEST_PRESSURE = 1e10
"""Largest pressure (Pa) at which a viscosity law is asked."""


class Dicke(Model):
    """Constants of the pressure law of Dicke, measured for FVA3: eta = eta0 exp{p / [a + b t + (c + d t) p]}, p in bar,
    t in C.

    Parameters
    ----------
    a : float
        Constant term (bar).
    b : float
        Factor of temperature (bar/C).
    c : float
        Factor of pressure (1).
    d : float
        Factor of pressure times temperature (1/C).

    Notes
    -----
    Source: Schwarz 2023, Lubricants 11:369.
    """

    a: Annotated[Number, unit("bar", ge=1e-3, le=1e6)] = 327.79
    b: Annotated[Number, unit("bar/C", ge=-1e4, le=1e4)] = 2.9862
    c: Annotated[Number, unit("1", ge=0, le=1e3)] = 4.419e-3
    d: Annotated[Number, unit("1/C", ge=-1, le=1)] = 3.0115e-4

    def pressure_coefficient(self, temperature_c: float) -> float:
        """alpha0 = d ln(eta)/dp at p = 0 (1/Pa), that is 1e-5/(a + b t): 1.97e-8 at 60 C, 2.096e-8 at 50 C for FVA3."""
        return 1e-5 / (self.a + self.b * temperature_c)


class Lubricant(Model):
    """An oil at one temperature.

    Parameters
    ----------
    viscosity : float
        eta0, dynamic viscosity at ambient pressure (Pa s).
    pressure_coefficient : float
        alpha0, pressure-viscosity coefficient, used by the films (1/Pa).
    temperature_coefficient : float
        beta = -d ln(eta0)/dt (1/K).
    temperature_c : float
        Temperature of the oil (C).
    density : float
        Density (kg/m3).
    conductivity : float
        k', thermal conductivity (W/mK).
    pressure_law : {'dicke', 'roelands', 'barus'}
        Law of viscosity against pressure that the traction uses; Barus is capped.
    dicke : Dicke
        Constants of the law of Dicke.
    viscosity_exponent_cap : float
        Largest ln(eta/eta0) of Roelands and Barus (assumed: 25).
    eyring_stress : float
        tau0, characteristic shear stress (Pa): 3 to 8 MPa.
    shear_modulus_floor : float
        Smallest limiting shear modulus Ginf (Pa).
    name : str
        Name of the oil.
    """

    viscosity: Annotated[Number, unit("Pa s", gt=0, le=1e6)]
    pressure_coefficient: Annotated[Number, unit("1/Pa", ge=0, le=1e-6)]
    temperature_coefficient: Annotated[Number, unit("1/K", ge=0, le=1)]
    temperature_c: Annotated[Number, unit("C", ge=-80, le=400)]
    density: Annotated[Number, unit("kg/m3", gt=0)] = 860.6
    conductivity: Annotated[Number, unit("W/mK", ge=1e-4, le=1e3)] = 0.134
    pressure_law: Literal["dicke", "roelands", "barus"] = "dicke"
    dicke: Dicke = Dicke()
    viscosity_exponent_cap: Annotated[Number, unit("1", ge=1, le=60)] = 25.0
    eyring_stress: Annotated[Number, unit("Pa", ge=1e3, le=1e9)] = 5e6
    shear_modulus_floor: Annotated[Number, unit("Pa", ge=1, le=1e10)] = 1e7
    name: str = "oil"

    @model_validator(mode="after")
    def _check(self) -> Self:
        stiffness = self.dicke.a + self.dicke.b * self.temperature_c
        if self.pressure_law == "dicke" and stiffness <= 0:
            raise InputError.of("temperature_c", self.temperature_c, "must keep a + b t of the Dicke law > 0 (C)")
        slope = self.dicke.c + self.dicke.d * self.temperature_c
        if self.pressure_law == "dicke" and slope < 0 and stiffness * 1e5 <= -slope * _HIGHEST_PRESSURE:
            limit = f"{_HIGHEST_PRESSURE / 1e9:g} GPa"
            raise InputError.of(
                "temperature_c", self.temperature_c, f"must keep the pole of the Dicke law above {limit} (C)"
            )
        if self.pressure_law == "roelands" and self.viscosity <= _ROELANDS_VISCOSITY:
            raise InputError.of(
                "viscosity", self.viscosity, f"must be > {_ROELANDS_VISCOSITY:g}, where the Roelands law ends (Pa s)"
            )
        return self

    @property
    def kinematic_viscosity(self) -> float:
        """Kinematic viscosity (m2/s)."""
        return self.viscosity / self.density


def vg100(
    temperature_c: float = 60.0,
    *,
    pressure_law: Literal["dicke", "roelands", "barus"] = "dicke",
    eyring_stress: float = 5e6,
) -> Lubricant:
    """ISO VG100: the mineral oil FVA3.

    Parameters
    ----------
    temperature_c : float
        Temperature of the oil (C), -20 to 200.
    pressure_law : {'dicke', 'roelands', 'barus'}
        Law of viscosity against pressure; the measured one is Dicke's.
    eyring_stress : float
        tau0, characteristic shear stress (Pa).

    Returns
    -------
    Lubricant
        eta0(t) = 0.062 exp[1021.7/(t + 101.55)] mPa s (34.59 mPa s at 60 C), beta = 1021.7/(t + 101.55)^2 (0.0392 1/K
        at 60 C), alpha0 = slope of the Dicke law at zero pressure (1.97e-8 1/Pa at 60 C).

    Raises
    ------
    InputError
        If the temperature lies outside the range.

    Notes
    -----
    Source: Schwarz 2023, Lubricants 11:369.
    """
    try:
        temperature = as_number(temperature_c)
    except ValueError as error:
        raise InputError.of("temperature_c", temperature_c, f"{error} (C)") from None
    if not -20.0 <= temperature <= 200.0:
        raise InputError.of("temperature_c", temperature_c, "must be between -20 and 200 (C)")
    above = temperature + 101.55
    law = Dicke()
    return Lubricant(
        viscosity=0.062e-3 * math.exp(1021.7 / above),
        pressure_coefficient=law.pressure_coefficient(temperature),
        temperature_coefficient=1021.7 / above**2,
        temperature_c=temperature,
        pressure_law=pressure_law,
        dicke=law,
        eyring_stress=eyring_stress,
        name=f"VG100 (FVA3) at {temperature:g} C",
    )


fva3 = vg100
OILS = {"vg100": vg100, "fva3": fva3}
