"""Viscosity of oils: against temperature (ASTM D341, Vogel), against pressure (Dicke), and the pressure coefficient (Wooster)."""

from __future__ import annotations

import math
from typing import Annotated

from trbdyn.base.validation import Model, Number, unit
from trbdyn.model.core_table import parameter

_KELVIN = 273.15


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
    Source: Wingertszahn 2023, Lubricants 11:369.
    """

    a: Annotated[Number, parameter("dicke_a")] = 327.79
    b: Annotated[Number, parameter("dicke_b")] = 2.9862
    c: Annotated[Number, parameter("dicke_c")] = 4.419e-3
    d: Annotated[Number, parameter("dicke_d")] = 3.0115e-4

    def pressure_coefficient(self, temperature_c: float) -> float:
        """alpha0 = d ln(eta)/dp at p = 0 (1/Pa), that is 1e-5/(a + b t): 1.97e-8 at 60 C, 2.096e-8 at 50 C for FVA3."""
        return 1e-5 / (self.a + self.b * temperature_c)


class Vogel(Model):
    """Measured law of Vogel: eta0(t) = a exp[b / (t + c)], t in C.

    Parameters
    ----------
    a : float
        Factor (Pa s).
    b, c : float
        Constants (C).
    """

    a: Annotated[Number, unit("Pa s", gt=0, le=1)]
    b: Annotated[Number, unit("C", gt=0, le=1e5)]
    c: Annotated[Number, unit("C", ge=50, le=500)]


def astm_d341(temperature_c: float, nu40: float, nu100: float) -> float:
    """Kinematic viscosity (mm2/s) at a temperature, from those at 40 and 100 C.

    log10 log10 Z = A - B log10 T, Z = nu + 0.7 + exp(-1.47 - 1.84 nu - 0.51 nu^2), nu in mm2/s, T in K; valid from 0.21
    mm2/s up.

    Notes
    -----
    Source: ASTM D341, standard practice for viscosity-temperature charts.

    Examples
    --------
    >>> import trbdyn as trb
    >>> round(trb.lubricants.astm_d341(70.0, 68.0, 8.7), 2)
    20.12
    """

    def doubled(nu: float) -> float:
        return math.log10(math.log10(nu + 0.7 + math.exp(-1.47 - 1.84 * nu - 0.51 * nu * nu)))

    cold, warm = math.log10(40.0 + _KELVIN), math.log10(100.0 + _KELVIN)
    share = (math.log10(temperature_c + _KELVIN) - cold) / (warm - cold)
    z: float = 10.0 ** (10.0 ** (doubled(nu40) + share * (doubled(nu100) - doubled(nu40)))) - 0.7
    if z > 20.0:
        return z
    return z - math.exp(-0.7487 - 3.295 * z + 0.6119 * z * z - 0.3193 * z**3)


def wooster(viscosity: float) -> float:
    """alpha0 of a mineral oil (1/Pa) from its dynamic viscosity (Pa s): (0.6 + 0.965 log10 eta) 1e-8, eta in mPa s.

    Notes
    -----
    Source: Wooster, as in Briant, Denis and Parc 1989, Rheological Properties of Lubricants; within about 15 % of
    measured mineral oils (FVA3 at 60 C: 2.09e-8 for 1.97e-8). Below 0.8 mPa s it is kept at 0.5e-8.
    """
    return max(0.6 + 0.965 * math.log10(1e3 * viscosity), 0.5) * 1e-8
