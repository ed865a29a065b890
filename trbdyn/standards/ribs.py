"""The axial load that the ribs of a cylindrical bearing carry, by a law of makers: plain numbers in and out."""

from __future__ import annotations

import math
from typing import Final

OIL: Final = (1.5, 0.15)
GREASE: Final = (1.0, 0.1)
"""k1 and k2 for oil and for grease."""
LARGE_SURFACE: Final = 50_000.0
"""Reference surface pi B (D + d) (mm2) above which the law of large bearings holds."""
SHARE_OF_RADIAL: Final = 0.5
"""Fa/Fr up to which rollers are guided well."""


def permissible_axial_load(
    *,
    speed_rpm: float,
    radial_load: float,
    C0: float,
    bore: float,
    outside: float,
    width: float | None = None,
    grease: bool = False,
) -> float:
    """Axial load that ribs of a cylindrical bearing with a cage carry for long (N), the smaller one of two limits; 0 where the
    radial load leaves none.

    By heat: F = k1 C0 1e4/[n (d + D)] - k2 Fr, above a surface pi B (d + D) of 50 000 mm2 with 7.5 C0^(2/3) in place of C0; in
    kN, rpm and mm, k1 and k2 are 1.5 and 0.15 for oil, 1 and 0.1 for grease. By strength: the smaller one of 0.0045 D^1.5, that
    of diameter series 2, and 0.0023 D^1.7.

    Notes
    -----
    Source: SKF, Rolling Bearings, cylindrical roller bearings, dynamic axial load carrying capacity; there for kappa from 2 on,
    60 K between bearing and surroundings, and Fa up to 0.5 Fr. C0 is the basic static load rating.

    Examples
    --------
    >>> from trbdyn.standards.ribs import permissible_axial_load
    >>> round(permissible_axial_load(speed_rpm=2000, radial_load=10e3, C0=112e3, bore=0.050, outside=0.110, width=0.027))
    3750
    """
    first, second = GREASE if grease else OIL
    across, static = 1e3 * (bore + outside), 1e-3 * C0
    strength = 1e3 * min(0.0045 * (1e3 * outside) ** 1.5, 0.0023 * (1e3 * outside) ** 1.7)
    if speed_rpm == 0.0:
        return strength
    large = width is not None and math.pi * 1e3 * width * across > LARGE_SURFACE
    carried = 7.5 * static ** (2.0 / 3.0) if large else static
    heat = 1e3 * first * carried * 1e4 / (abs(speed_rpm) * across) - second * radial_load
    return max(min(heat, strength), 0.0)
