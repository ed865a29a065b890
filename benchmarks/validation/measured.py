"""Published measurements of tapered roller bearings, with what their sources tell of the conditions.

Here belongs what was measured and nothing that was computed. A row needs bearing, loads, speed, oil and temperature; what lacks
one of them stands in `NOT_ENOUGH` with the reason.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Source:
    """Where a measurement is published.

    Attributes
    ----------
    key : str
        Short name.
    title, authors, where, doi : str
        The publication.
    reading : str
        How the numbers were got from it.
    """

    key: str
    title: str
    authors: str
    where: str
    doi: str
    reading: str


@dataclass(frozen=True)
class Measurement:
    """One measured number.

    Attributes
    ----------
    source : str
        Key of its source.
    bearing : str
        Name in `validation.assumptions.BEARINGS`.
    quantity : str
        'torque' (N m), 'rolling_torque' (N m; without the ribs), 'loaded_rollers' (1) or 'torque_change' (%; where the radius of
        the rollers' end sphere goes from 0.95 to 0.85 of the apex distance).
    value : float
        What was measured.
    reading_error : float
        How far the reading of a figure may be off, in the unit of the value.
    speed_rpm, axial_load, radial_load : float
        Speed (rpm) and loads (N); the radial load points down, into the oil.
    temperature_c : float
        Temperature that the source gives (C), of what says `validation.assumptions`; not a number where it gives none.
    supply : str
        State of lubrication, a name in `trbdyn.lubricants.REPLENISHMENT`.
    held_back : bool
        No choice of the package was made with it: neither the supply of oil was fitted to it, nor the ribs compared.
    """

    source: str
    bearing: str
    quantity: str
    value: float
    reading_error: float
    speed_rpm: float
    axial_load: float
    radial_load: float
    temperature_c: float
    supply: str
    held_back: bool = False


_FIGURES = "read from figures by others, good to 10 %"

SOURCES: Final = (
    Source(
        key="Wingertszahn 2023",
        title="Predicting Friction of Tapered Roller Bearings with Detailed Multi-Body Simulation Models",
        authors="P. Wingertszahn, O. Koch, L. Maccioni, F. Concli, B. Sauer",
        where="Lubricants 11 (2023) 369",
        doi="10.3390/lubricants11090369",
        reading=_FIGURES,
    ),
    Source(
        key="Zhou 1991",
        title="Torque of Tapered Roller Bearings",
        authors="R. S. Zhou, M. R. Hoeprich",
        where="ASME J. Tribology 113 (1991) 590-597",
        doi="10.1115/1.2920664",
        reading=f"{_FIGURES}; the load follows from the load group W that the source gives, 2.8 to 3.8 kN",
    ),
    Source(
        key="Manjunath 2023",
        title="Experimental Analysis of Rolling Torque and Thermal Inlet Shear Heating in Tapered Roller Bearings",
        authors="M. Manjunath, D. Fauconnier, W. Ost, P. De Baets",
        where="Machines 11 (2023) 801",
        doi="10.3390/machines11080801",
        reading=f"{_FIGURES}; the measured torque less that of the rib by SKF's formula",
    ),
    Source(
        key="Zhang 2025",
        title="Torque of a 32208 with other radii of the rollers' end sphere",
        authors="Zhang, Li",
        where="Machines 13 (2025) 910",
        doi="10.3390/machines13100910",
        reading="means of the text: 0.61 and 0.56 N m",
    ),
    Source(
        key="Cruz 2021",
        title="Tandem tapered roller bearings no-load torque loss in a rear axle gear transmission",
        authors="J. A. O. Cruz, P. M. T. Marques, J. H. O. Seabra, R. C. Martins",
        where="Tribology International 157 (2021) 106876",
        doi="10.1016/j.triboint.2021.106876",
        reading=f"{_FIGURES}, who took 0.10 N m for the seal and the axial load from the starting torque; half of what two "
        "bearings have",
    ),
)

_AXIAL = {500.0: 1.30, 2000.0: 2.95, 4000.0: 3.75}
_COMBINED = {500.0: 1.50, 1000.0: 1.95, 2000.0: 2.50, 4000.0: 3.25}
_AXIAL_42 = {500.0: 1.70}
_COMBINED_42 = {500.0: 2.00, 1000.0: 2.65, 2000.0: 3.50, 4000.0: 4.45}
_PAIR = {(1500.0, 5279.0): 1.35, (2000.0, 5279.0): 1.60, (1500.0, 2083.0): 0.95, (1500.0, 8336.0): 1.65}
"""Two HM801349 with a seal (N m), by speed (rpm) and axial load (N)."""
_SEAL = 0.10
_LM = {200.0: 0.45, 400.0: 0.2, 800.0: 0.115, 1600.0: 0.085, 2400.0: 0.09, 3200.0: 0.1, 4000.0: 0.11, 4800.0: 0.12}


def _torques(
    source: str,
    bearing: str,
    torques: dict[float, float],
    error: float,
    axial: float,
    radial: float,
    t: float,
    supply: str,
    held_back: bool = False,
) -> list[Measurement]:
    return [
        Measurement(
            source, bearing, "torque", torque, max(error, 0.1 * torque), speed, axial, radial, t, supply, held_back
        )
        for speed, torque in torques.items()
    ]


MEASUREMENTS: Final = (
    *_torques("Wingertszahn 2023", "32216", _AXIAL, 0.15, 6000.0, 0.0, 50.0, "bath"),
    *_torques("Wingertszahn 2023", "32216", _COMBINED, 0.15, 6000.0, 6500.0, 50.0, "bath"),
    *_torques("Zhou 1991", "LM12700", _LM, 0.01, 3600.0, 0.0, 80.0, "bath"),
    Measurement("Manjunath 2023", "32008", "rolling_torque", 1.07, 0.107, 2200.0, 12850.0, 0.0, 55.0, "flooded"),
    Measurement("Manjunath 2023", "32008", "rolling_torque", 0.95, 0.095, 2200.0, 12850.0, 0.0, 65.0, "flooded"),
    *_torques("Wingertszahn 2023", "32216", _AXIAL_42, 0.15, 6000.0, 0.0, 42.0, "bath", held_back=True),
    *_torques("Wingertszahn 2023", "32216", _COMBINED_42, 0.15, 6000.0, 6500.0, 42.0, "bath", held_back=True),
    *(
        one
        for (speed, axial), pair in _PAIR.items()
        for one in _torques(
            "Cruz 2021",
            "HM801349",
            {speed: 0.5 * (pair - _SEAL)},
            0.05 * pair,
            axial,
            0.0,
            62.2,
            "bath",
            held_back=True,
        )
    ),
    Measurement("Wingertszahn 2023", "32216", "loaded_rollers", 16.0, 0.5, 500.0, 6000.0, 0.0, 50.0, "bath"),
    Measurement("Wingertszahn 2023", "32216", "loaded_rollers", 11.0, 0.5, 500.0, 6000.0, 16000.0, 50.0, "bath"),
    Measurement("Zhang 2025", "32208", "torque_change", -8.2, 8.0, 1800.0, 2160.0, 0.0, math.nan, "jet"),
)

NOT_ENOUGH: Final = {
    "32216 under 6.5 kN of preload with 1 to 15 kN radial, 2000 rpm (Wingertszahn 2023, figure 7)": "1.30 to 1.62 N m, half "
    "of what figure 5 has under an axial load of 6 kN: what the preload becomes under load is not told",
    "32216 and 32208 at other speeds and loads (Wingertszahn 2023)": "no reading of the figures is at hand",
    "32008 below 2200 rpm (Manjunath 2023)": "two readings of one figure by the same reader differ: 0.58 and 0.97 N m at "
    "1000 rpm",
    "two HH926749, breakaway (Hu 2025)": "torque at rest, in a grease that is not named: 25 N m at 5 kN and 42 N m at "
    "25 kN, most of it without a load",
    "30306 (SKF's tool)": "computed, not measured",
    "LM501300, skew of 2.6 to 10.5 mrad under two greases": "loads, speeds and temperature are not at hand",
    "FAG 807811.09, skew and tilt (Zhao 2026)": "powers are computed from measured motions; no torque",
    "30310 (Sakaguchi and Harada 2006)": "paths of the cage, no torque: benchmarks/paper",
    "Timken's formula": "its factors G1 of these bearings are not at hand",
}
"""What was published and could not be used, and why."""
