"""SKF's published model of the friction moment of a tapered roller bearing, without seals and without the drag of a bath.

SKF, Rolling Bearings (general catalogue), "The SKF model for calculating the frictional moment". The constants of the series are
those that are commonly quoted from its table; they were not checked against a printed copy.
"""

from __future__ import annotations

import math
from typing import Final

SERIES: Final = {"322": {"R1": 2.27e-6, "R2": 10.9, "S1": 0.018, "S2": 2.0}}
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
    return 1e-3 * (inlet * supply * rolling * (viscosity * n) ** 0.6 + sliding * coefficient)
