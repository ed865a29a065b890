"""Published measurements of tapered roller bearings, with what their sources tell of the conditions.

Here belongs what was measured and nothing that was computed. A row needs bearing, loads, speed, oil and temperature; what lacks
one of them stands in `NOT_ENOUGH` with the reason.
"""

from __future__ import annotations

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
        Name in `trbdyn.cases.BEARINGS`.
    quantity : str
        'torque' (N m) or 'loaded_rollers' (1).
    value : float
        What was measured.
    reading_error : float
        How far the reading of a figure may be off, in the unit of the value.
    speed_rpm, axial_load, radial_load : float
        Speed (rpm) and loads (N); the radial load points down, into the oil.
    ring_c : float
        Temperature of the outer ring (C).
    supply : str
        State of lubrication.
    """

    source: str
    bearing: str
    quantity: str
    value: float
    reading_error: float
    speed_rpm: float
    axial_load: float
    radial_load: float
    ring_c: float
    supply: str


SOURCES: Final = (
    Source(
        key="Wingertszahn 2023",
        title="Predicting Friction of Tapered Roller Bearings with Detailed Multi-Body Simulation Models",
        authors="P. Wingertszahn, O. Koch, L. Maccioni, F. Concli, B. Sauer",
        where="Lubricants 11 (2023) 369",
        doi="10.3390/lubricants11090369",
        reading="read from figures by the maintainers of trbdyn, to about 0.05 N m",
    ),
)

_TORQUE = {
    (500.0, 0.0): 1.30,
    (2000.0, 0.0): 2.95,
    (4000.0, 0.0): 3.75,
    (500.0, 6500.0): 1.50,
    (1000.0, 6500.0): 1.95,
    (2000.0, 6500.0): 2.50,
    (4000.0, 6500.0): 3.25,
}

MEASUREMENTS: Final = (
    *(
        Measurement(
            "Wingertszahn 2023", "32216", "torque", torque, 0.05, speed, 6000.0, radial, 50.0, "bath to half a roller"
        )
        for (speed, radial), torque in _TORQUE.items()
    ),
    Measurement(
        "Wingertszahn 2023", "32216", "loaded_rollers", 16.0, 0.5, 500.0, 6000.0, 0.0, 50.0, "bath to half a roller"
    ),
    Measurement(
        "Wingertszahn 2023", "32216", "loaded_rollers", 11.0, 0.5, 500.0, 6000.0, 16000.0, 50.0, "bath to half a roller"
    ),
)

_UNREAD = "measured torques are published in figures of which no reading is at hand"

NOT_ENOUGH: Final = {
    "32216 at 42 C (Wingertszahn 2023)": _UNREAD,
    "LM12700, LM12749 (Zhou and Hoeprich 1991), HM801349": _UNREAD,
    "LM501300, skew of 2.6 to 10.5 mrad under two greases": "the greases' viscosity, loads and temperature are not at hand",
    "30310 (Sakaguchi and Harada 2006)": "paths of the cage, no torque: benchmarks/paper",
}
"""What was published and could not be used, and why."""
