"""How much oil is round the rollers: states of lubrication by name, and the fill of a bath at rest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

from trbdyn.base.validation import number_of
from trbdyn.errors import InputError, unknown_name

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing
    from trbdyn.model.lubricants.lubricant import Lubricant


class OilSupply(NamedTuple):
    """A state of lubrication.

    Attributes
    ----------
    fill : float
        Share of oil in the mixture of oil and air round the rollers (1).
    low, high : float
        Band in which it may lie (1).
    words : str
        What the state is.
    """

    fill: float
    low: float
    high: float
    words: str


OIL_SUPPLIES: Final = {
    "minimum": OilSupply(0.01, 0.0, 0.03, "minimum oil: drops or grease that has run in"),
    "oil_air": OilSupply(0.03, 0.0, 0.1, "oil and air, or mist"),
    "bath": OilSupply(0.1, 0.02, 0.3, "bath to the middle of the lowest roller"),
    "flooded": OilSupply(1.0, 0.5, 1.0, "flooded: the bearing lies below the oil, or a jet fills it"),
}
"""States by the names that `Effects.oil_fill` takes. No measurement gives these shares: they and their bands are assumed, and the
same for all bearings and speeds."""


REPLENISHMENT: Final = {"low_bath": 3e-8, "oil_air": 6e-8}
"""SKF's constant K_rs by the supply of oil."""


def supply_of(fill: float) -> OilSupply | None:
    """The named state that has this fill; None if none has."""
    return next((supply for supply in OIL_SUPPLIES.values() if supply.fill == fill), None)


def bath_fill(bearing: Bearing, level: float) -> float:
    """Share of the space between the raceways that lies below the oil of a bath at rest.

    A bearing that turns carries oil round and throws it off: take this as the middle of a wide band, a third to three times.

    Parameters
    ----------
    bearing : Bearing
        Its axis lies level.
    level : float
        Height of the oil above the lowest point of the outer raceway at mid roller (m).

    Returns
    -------
    float
        Share of the ring between both raceways at mid roller (1).

    Raises
    ------
    InputError
        If the level is below 0 or above the outer raceway's diameter.

    Examples
    --------
    >>> import trbdyn as trb
    >>> bearing = trb.cases.rig_30310()
    >>> round(trb.lubricants.bath_fill(bearing, level=7e-3), 3)
    0.067
    >>> trb.lubricants.bath_fill(bearing, level=bearing.geometry.outer_race_radius)
    0.5
    """
    outer, inner = bearing.geometry.outer_race_radius, bearing.geometry.inner_race_radius
    if not 0.0 <= number_of("level", level) <= 2.0 * outer:
        raise InputError.of("level", level, f"must be from 0 to the raceway's diameter, {2.0 * outer:g} (m)")
    below = _segment(outer, level - outer) - _segment(inner, level - outer)
    return below / (math.pi * (outer**2 - inner**2))


def replenishment_decline(lubricant: Lubricant, *, bore: float, outside: float, supply: str = "low_bath") -> float:
    """How fast the supply of the contacts declines with speed, by SKF's kinematic replenishment of a tapered roller bearing: for
    `Effects.replenishment`.

    Oil that rollers push aside is not all back when the next one comes. SKF multiplies rolling resistance by a factor for that;
    the simulation thins the films of the raceways by it as well.

    Parameters
    ----------
    lubricant : Lubricant
        The oil at its temperature.
    bore, outside : float
        Bore d and outside diameter D of the bearing (m).
    supply : {'low_bath', 'oil_air'}
        A low bath or a jet (K_rs 3e-8), or oil and air or grease (6e-8).

    Returns
    -------
    float
        c of the factor exp(-c speed) (s): K_rs nu n (d + D) sqrt(K_Z/(2 (D - d))) over the speed in rad/s, with K_Z = 6, nu in
        mm2/s, n in rpm, d and D in mm.

    Raises
    ------
    InputError
        If the supply is unknown, or the diameters are no bearing's.

    Notes
    -----
    Source: SKF, Rolling Bearings (general catalogue), kinematic replenishment. No range is given.

    Examples
    --------
    >>> import trbdyn as trb
    >>> oil = trb.lubricants.vg100(50.0)
    >>> decline = trb.lubricants.replenishment_decline(oil, bore=0.080, outside=0.140)
    >>> effects = trb.Effects.standard().replace(replenishment=decline)
    >>> round(decline, 6)
    0.000855
    """
    if supply not in REPLENISHMENT:
        raise InputError.of("supply", supply, unknown_name(supply, REPLENISHMENT))
    if not 0.0 < number_of("bore", bore) < number_of("outside", outside) < 10.0:
        raise InputError.of("bore", bore, f"must be above 0 and below outside, {outside:g}, below 10 (m)")
    d, outer = 1e3 * bore, 1e3 * outside
    viscosity, turns = 1e6 * lubricant.viscosity / lubricant.density, 30.0 / math.pi
    return REPLENISHMENT[supply] * viscosity * turns * (d + outer) * math.sqrt(6.0 / (2.0 * (outer - d)))


def replenishment(
    lubricant: Lubricant, speed_rpm: float, *, bore: float, outside: float, supply: str = "low_bath"
) -> float:
    """The factor of `replenishment_decline` at one speed: for `Effects.starvation_factor`, which thins every film.

    Parameters
    ----------
    lubricant, bore, outside, supply
        As of `replenishment_decline`.
    speed_rpm : float
        Speed of the shaft (rpm).

    Returns
    -------
    float
        exp(-c speed) (1).

    Raises
    ------
    InputError
        If the supply is unknown, or the diameters are no bearing's.

    Examples
    --------
    >>> import trbdyn as trb
    >>> round(trb.lubricants.replenishment(trb.lubricants.vg100(50.0), 4000.0, bore=0.080, outside=0.140), 3)
    0.699
    """
    speed = abs(number_of("speed_rpm", speed_rpm)) * math.pi / 30.0
    return math.exp(-replenishment_decline(lubricant, bore=bore, outside=outside, supply=supply) * speed)


def _segment(radius: float, height: float) -> float:
    """Area of a circle that lies below a height above its centre."""
    height = min(max(height, -radius), radius)
    return radius**2 * math.acos(-height / radius) + height * math.sqrt(radius**2 - height**2)
