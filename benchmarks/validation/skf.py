"""SKF's published model of the friction moment of a tapered roller bearing, without seals and without the drag of a bath.

SKF, Rolling Bearings (general catalogue), "The SKF model for calculating the frictional moment". The constants of the series are
those that are commonly quoted from its table; they were not checked against a printed copy.
"""

from __future__ import annotations

import math
from typing import Final

SERIES: Final = {
    "302": {"R1": 1.76e-6, "R2": 10.9, "S1": 0.017, "S2": 2.0},
    "303": {"R1": 1.69e-6, "R2": 10.9, "S1": 0.017, "S2": 2.0},
    "313": {"R1": 1.84e-6, "R2": 10.9, "S1": 0.048, "S2": 2.0},
    "322": {"R1": 2.27e-6, "R2": 10.9, "S1": 0.018, "S2": 2.0},
    "323": {"R1": 2.38e-6, "R2": 10.9, "S1": 0.019, "S2": 2.0},
    "331": {"R1": 2.71e-6, "R2": 10.9, "S1": 0.015, "S2": 2.0},
    "332": {"R1": 2.71e-6, "R2": 10.9, "S1": 0.018, "S2": 2.0},
    "320X": {"R1": 2.38e-6, "R2": 10.9, "S1": 0.014, "S2": 2.0},
    "HM": {"R1": 2.60e-6, "R2": 10.9, "S1": 0.020, "S2": 2.0},
    "LM": {"R1": 2.25e-6, "R2": 10.9, "S1": 0.011, "S2": 2.0},
}
"""Geometric constants by series."""


def torque(
    *,
    series: str,
    bore: float,
    outside: float,
    Y: float,
    speed_rpm: float,
    axial_load: float,
    radial_load: float,
    viscosity: float,
    replenishment: float = 3e-8,
    rolling_alone: bool = False,
) -> float:
    """Friction moment (N m).

    Parameters
    ----------
    series : str
        Key of `SERIES`.
    bore, outside : float
        Bore and outside diameter (m).
    Y : float
        Axial factor of the bearing (1).
    speed_rpm : float
        Speed (rpm).
    axial_load, radial_load : float
        Loads (N).
    viscosity : float
        Kinematic viscosity at the bearing's temperature (mm2/s).
    replenishment : float
        K_rs: 3e-8 for a low bath or a jet, 6e-8 for oil and air or grease.
    rolling_alone : bool
        Without the part of sliding, which is that of the rib.
    """
    constants = SERIES[series]
    d, D = 1e3 * bore, 1e3 * outside
    mean = 0.5 * (d + D)
    n = abs(speed_rpm)
    rolling = constants["R1"] * mean**2.38 * (radial_load + constants["R2"] * Y * axial_load) ** 0.31
    inlet = 1.0 / (1.0 + 1.84e-9 * (n * mean) ** 1.28 * viscosity**0.64)
    supply = 1.0 / math.exp(replenishment * viscosity * n * (d + D) * math.sqrt(6.0 / (2.0 * (D - d))))
    sliding = constants["S1"] * mean**0.82 * (radial_load + constants["S2"] * Y * axial_load)
    boundary = 1.0 / math.exp(2.6e-8 * (n * viscosity) ** 1.4 * mean)
    coefficient = boundary * 0.15 + (1.0 - boundary) * 0.002
    sliding *= 0.0 if rolling_alone else coefficient
    return 1e-3 * (inlet * supply * rolling * (viscosity * n) ** 0.6 + sliding)


def palmgren(
    *, bore: float, outside: float, Y: float, speed_rpm: float, axial_load: float, radial_load: float, viscosity: float
) -> float:
    """Palmgren's friction moment (N m): f0 1e-7 (nu n)^(2/3) dm^3 + f1 P1 dm in mm, f0 3 (bath), f1 0.0004, P1 the larger of
    2 Y Fa and Fr (N); arguments as of `torque`.
    """
    mean, flow = 500.0 * (bore + outside), viscosity * abs(speed_rpm)
    viscous = 3e-7 * flow ** (2.0 / 3.0) if flow >= 2000.0 else 3.0 * 160e-7
    return 1e-3 * (viscous * mean**3 + 0.0004 * max(2.0 * Y * axial_load, radial_load) * mean)
