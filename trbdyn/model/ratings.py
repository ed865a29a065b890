"""Load ratings of a bearing: those that its catalogue states, and those that the standards compute from its rollers."""

from __future__ import annotations

import math
from typing import Annotated

from trbdyn.base.validation import Model, Number, unit


class Ratings(Model):
    """What the catalogue says of the bearing besides its dimensions. The simulation does not use it; `trbdyn.rating` does.

    Parameters
    ----------
    dynamic : float, optional
        C, basic dynamic load rating (N).
    static : float, optional
        C0, basic static load rating (N).
    fatigue_limit : float, optional
        Cu (or Pu), fatigue load limit (N).
    e : float, optional
        Largest Fa/Fr at which P = Fr (1).
    Y : float, optional
        Factor of the axial load in P = 0.4 Fr + Y Fa, of a cylindrical bearing in P = 0.92 Fr + Y Fa (1).
    Y0 : float, optional
        Factor of the axial load in P0 = 0.5 Fr + Y0 Fa (1).
    reference_speed_rpm : float, optional
        Speed that the catalogue permits for the heat made (rpm).
    limiting_speed_rpm : float, optional
        Speed that the catalogue permits for the cage and the forces (rpm).
    load_centre : float, optional
        a, distance of the load centre of a tapered bearing from the face of its outer ring at the small ends of the rollers (m).
    """

    dynamic: Annotated[Number, unit("N", gt=0, le=1e9)] | None = None
    static: Annotated[Number, unit("N", gt=0, le=1e9)] | None = None
    fatigue_limit: Annotated[Number, unit("N", gt=0, le=1e9)] | None = None
    e: Annotated[Number, unit("1", gt=0, le=3)] | None = None
    Y: Annotated[Number, unit("1", gt=0, le=10)] | None = None
    Y0: Annotated[Number, unit("1", gt=0, le=10)] | None = None
    reference_speed_rpm: Annotated[Number, unit("rpm", gt=0, le=1e6)] | None = None
    limiting_speed_rpm: Annotated[Number, unit("rpm", gt=0, le=1e6)] | None = None
    load_centre: Annotated[Number, unit("m", gt=0, le=10)] | None = None


def rating_iso281(
    *, n_rollers: float, roller_diameter: float, roller_length: float, pitch_diameter: float, contact_angle_deg: float
) -> float:
    """Basic dynamic radial load rating of a single-row radial roller bearing.

    Cr = bm fc (Lwe cos alpha)^(7/9) Z^(3/4) Dwe^(29/27) with bm = 1.1 and fc a function of Dwe cos(alpha)/Dpw.

    Parameters
    ----------
    n_rollers : float
        Z.
    roller_diameter, roller_length, pitch_diameter : float
        Dwe, Lwe, Dpw (m).
    contact_angle_deg : float
        alpha, half angle of the cup (deg).

    Returns
    -------
    float
        Cr (N).

    Notes
    -----
    Source: ISO 281:2007, 7.1; fc by the formula behind its table 8 (ISO/TR 1281-1:2008);
    docs/theory/estimates.md#dynamic-rating-of-iso-281.

    Examples
    --------
    >>> from trbdyn.model.ratings import rating_iso281
    >>> round(rating_iso281(n_rollers=12, roller_diameter=0.014, roller_length=0.0198, pitch_diameter=0.082389,
    ...                     contact_angle_deg=12.9528) / 1e3)
    107
    """
    cosine = math.cos(math.radians(contact_angle_deg))
    gamma = roller_diameter * cosine / pitch_diameter
    one, other = (1.0 - gamma), (1.0 + gamma)
    bracket = 1.0 + (1.04 * (one / other) ** (143.0 / 108.0)) ** 4.5
    factor = 207.9 * 0.83 * gamma ** (2.0 / 9.0) * one ** (29.0 / 27.0) / other**0.25 * bracket ** (-2.0 / 9.0)
    length, diameter = 1e3 * roller_length * cosine, 1e3 * roller_diameter
    return 1.1 * factor * length ** (7.0 / 9.0) * n_rollers**0.75 * diameter ** (29.0 / 27.0)


def rating_iso76(
    *, n_rollers: float, roller_diameter: float, roller_length: float, pitch_diameter: float, contact_angle_deg: float
) -> float:
    """Basic static radial load rating of a single-row radial roller bearing.

    C0r = 44 (1 - Dwe cos(alpha)/Dpw) Z Lwe Dwe cos(alpha), lengths in mm.

    Parameters
    ----------
    n_rollers, roller_diameter, roller_length, pitch_diameter, contact_angle_deg : float
        As in `rating_iso281`.

    Returns
    -------
    float
        C0r (N).

    Notes
    -----
    Source: ISO 76:2006, 7.1: the radial load under which the most loaded line contact has 4 GPa where half of the
    rollers are loaded.

    Examples
    --------
    >>> from trbdyn.model.ratings import rating_iso76
    >>> round(rating_iso76(n_rollers=12, roller_diameter=0.014, roller_length=0.0198, pitch_diameter=0.082389,
    ...                    contact_angle_deg=12.9528) / 1e3)
    119
    """
    cosine = math.cos(math.radians(contact_angle_deg))
    gamma = roller_diameter * cosine / pitch_diameter
    return 44.0 * (1.0 - gamma) * n_rollers * (1e3 * roller_length) * (1e3 * roller_diameter) * cosine
