"""Rating life of ISO 281 and static rating of ISO 76 for single-row tapered roller bearings: plain numbers in and out.

Forces in N, diameters in m, viscosities in mm2/s, speeds in rpm, lives in million revolutions.
"""

from __future__ import annotations

import math
from typing import Final, Literal

from trbdyn.errors import InputError

Cleanliness = Literal["13/10", "15/12", "17/14", "19/16", "21/18"]
"""Particles in the oil, last two numbers of the code of ISO 4406."""

LIFE_EXPONENT: Final = 10.0 / 3.0
LEAST_VISCOSITY_RATIO: Final = 0.1
MOST_VISCOSITY_RATIO: Final = 4.0
MOST_LIFE_FACTOR: Final = 50.0
SMALLEST_LOAD_SHARE: Final = 0.02
"""Least load of a roller bearing over its C, so that rollers roll: general catalogue of SKF, Frm = 0.02 C."""

RELIABILITY: Final = {
    90.0: 1.0,
    95.0: 0.64,
    96.0: 0.55,
    97.0: 0.47,
    98.0: 0.37,
    99.0: 0.25,
    99.2: 0.22,
    99.4: 0.19,
    99.6: 0.16,
    99.8: 0.12,
    99.9: 0.093,
    99.92: 0.087,
    99.94: 0.080,
    99.95: 0.077,
}
"""a1 by reliability (%): ISO 281:2007, table 12."""
SAFE_SHARE: Final = 0.05
"""Share of L10 within which no bearing fails, C_gamma of the distribution behind that table: ISO/TR 1281-2:2008."""
CHANGE_OF_SPEED: Final = 1000.0
"""Speed (rpm) at which the formula of nu1 changes: ISO 281:2007, 9.3.3.3.1."""
ROUNDING: Final = 1e-9
"""Share by which a number may miss a limit of the standard by rounding alone."""

_FILTERED: Final = {
    "13/10": (0.0864, 0.5663),
    "15/12": (0.0432, 0.9987),
    "17/14": (0.0288, 1.6329),
    "19/16": (0.0216, 2.3362),
}
_UNFILTERED: Final = {
    "13/10": (0.0864, 0.5796),
    "15/12": (0.0288, 1.141),
    "17/14": (0.0133, 1.67),
    "19/16": (0.00864, 2.5164),
    "21/18": (0.00411, 3.8974),
}
"""Constants of the contamination factor, in-line filter and oil bath: ISO 281:2007, annex A, as in SKF's Rolling Bearings,
table 7 of "Selecting bearing size"."""


def equivalent_load(radial_load: float, axial_load: float, *, e: float, Y: float) -> float:
    """P = Fr where Fa/Fr <= e, else 0.4 Fr + Y Fa (N): ISO 281:2007, 7.3, single-row radial roller bearings."""
    return radial_load if within_e(radial_load, axial_load, e) else 0.4 * radial_load + Y * axial_load


def equivalent_load_of_cylinders(radial_load: float, axial_load: float, *, e: float, Y: float) -> float:
    """P of a cylindrical bearing whose ribs carry an axial load (N): Fr where Fa/Fr <= e, else 0.92 Fr + Y Fa.

    Notes
    -----
    Source: catalogues of makers (SKF, Rolling Bearings, cylindrical roller bearings, equivalent dynamic bearing load), who give
    e = 0.2 and Y = 0.6 for the series 10, 2, 3 and 4, e = 0.3 and Y = 0.4 for the wider ones. ISO 281 has no such factors.

    Examples
    --------
    >>> from trbdyn.standards.iso281 import equivalent_load_of_cylinders
    >>> equivalent_load_of_cylinders(10e3, 20e3, e=0.2, Y=0.6)
    21200.0
    """
    return radial_load if within_e(radial_load, axial_load, e) else 0.92 * radial_load + Y * axial_load


def within_e(radial_load: float, axial_load: float, e: float) -> bool:
    """Whether Fa/Fr <= e, but for rounding."""
    return axial_load <= e * radial_load * (1.0 + ROUNDING)


def static_equivalent_load(radial_load: float, axial_load: float, *, Y0: float) -> float:
    """P0, the larger of 0.5 Fr + Y0 Fa and Fr (N): ISO 76:2006, 7.2."""
    return max(0.5 * radial_load + Y0 * axial_load, radial_load)


def basic_life(C: float, P: float) -> float:
    """L10 = (C/P)^(10/3) in million revolutions; infinite without load."""
    return (C / P) ** LIFE_EXPONENT if P > 0.0 else math.inf


def hours(life: float, speed_rpm: float) -> float:
    """Hours that a life in million revolutions lasts at a speed (rpm); infinite at standstill."""
    return 1e6 * life / (60.0 * abs(speed_rpm)) if speed_rpm else math.inf


def reference_viscosity(speed_rpm: float, pitch_diameter: float) -> float:
    """nu1 (mm2/s), the viscosity that a bearing asks for.

    45000 n^-0.83 Dpw^-0.5 below 1000 rpm, 4500 n^-0.5 Dpw^-0.5 from there on, Dpw in mm: ISO 281:2007, 9.3.3.3.1.

    Examples
    --------
    >>> from trbdyn.standards.iso281 import reference_viscosity
    >>> round(reference_viscosity(1500.0, 0.050), 2)
    16.43
    """
    speed, pitch = abs(speed_rpm), 1e3 * pitch_diameter
    if speed == 0.0:
        return math.inf
    slow = speed < CHANGE_OF_SPEED * (1.0 - ROUNDING)
    factor = 45000.0 * speed**-0.83 if slow else 4500.0 * speed**-0.5
    return factor * pitch**-0.5


def contamination_factor(cleanliness: str, *, filtered: bool, viscosity_ratio: float, pitch_diameter: float) -> float:
    """e_C = a (1 - c2/Dpw^(1/3)) with a = c1 kappa^0.68 Dpw^0.55, at most 1, Dpw in mm: ISO 281:2007, annex A.

    Cleanliness is a code of ISO 4406, the last one only without a filter; filtered: circulating oil with an in-line filter,
    else oil bath, or circulating oil with a filter off line.
    """
    constants = _FILTERED if filtered else _UNFILTERED
    if cleanliness not in constants:
        raise InputError.of("cleanliness", cleanliness, f"must be one of {', '.join(constants)} (ISO 4406)")
    first, second = constants[cleanliness]
    pitch = 1e3 * pitch_diameter
    share = min(first * viscosity_ratio**0.68 * pitch**0.55, 1.0)
    return max(share * (1.0 - second * pitch ** (-1.0 / 3.0)), 0.0)


def fatigue_limit(C0: float, pitch_diameter: float) -> float:
    """Cu of a roller bearing from C0 (N): C0/8.2, above a pitch diameter of 100 mm times (100/Dpw)^0.3; ISO 281:2007, B.3.3."""
    pitch = 1e3 * pitch_diameter
    return C0 / 8.2 * ((100.0 / pitch) ** 0.3 if pitch > 100.0 else 1.0)


def life_factor(viscosity_ratio: float, load_ratio: float) -> float:
    """a_ISO of radial roller bearings by kappa, from 0.1 (above 4 it counts as 4), and by the load ratio e_C Cu/P.

    a_ISO = 0.1 [1 - (1.5859 - c/kappa^p)(e_C Cu/P)^0.4]^-9.185, at most 50: ISO 281:2007, 9.3.3.4, equations 34 to 36.

    Examples
    --------
    >>> from trbdyn.standards.iso281 import life_factor
    >>> round(life_factor(1.0, 0.1), 3), life_factor(4.0, 5.0)
    (0.399, 50.0)
    """
    if viscosity_ratio < LEAST_VISCOSITY_RATIO:
        raise InputError.of(
            "viscosity_ratio", viscosity_ratio, f"must be >= {LEAST_VISCOSITY_RATIO:g}: ISO 281 ends there (1)"
        )
    kappa = min(viscosity_ratio, MOST_VISCOSITY_RATIO)
    if kappa < 0.4:
        film = 1.3993 / kappa**0.054381
    elif kappa < 1.0:
        film = 1.2348 / kappa**0.19087
    else:
        film = 1.2348 / kappa**0.071739
    bracket = 1.0 - (1.5859 - film) * load_ratio**0.4
    if bracket <= 0.0:
        return MOST_LIFE_FACTOR
    return float(min(0.1 * bracket**-9.185, MOST_LIFE_FACTOR))


def reliability_factor(reliability: float) -> float:
    """a1 for a reliability from 90 to 99.95 (%): that of the standard's table, between its rows by its distribution.

    a1 = (1 - C_g) [ln(100/S)/ln(100/90)]^(2/3) + C_g with C_g = 0.05: a Weibull distribution with slope 1.5 and a life that all
    bearings reach (ISO/TR 1281-2:2008). It gives the rows of the table within their two digits.

    Examples
    --------
    >>> from trbdyn.standards.iso281 import reliability_factor
    >>> reliability_factor(99.9), round(reliability_factor(99.5), 3)
    (0.093, 0.175)
    """
    least, most = min(RELIABILITY), max(RELIABILITY)
    if not least <= reliability <= most:
        raise InputError.of("reliability", reliability, f"must be from {least:g} to {most:g}, table 12 of ISO 281 (%)")
    share = math.log(100.0 / reliability) / math.log(100.0 / least)
    return RELIABILITY.get(reliability, (1.0 - SAFE_SHARE) * share ** (2.0 / 3.0) + SAFE_SHARE)
