"""How much oil is round the rollers: states of lubrication by name, and the fill of a bath at rest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

from trbdyn.base.validation import number_of
from trbdyn.errors import InputError

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


class Replenishment(NamedTuple):
    """SKF's constant of a state of lubrication.

    Attributes
    ----------
    value : float
        K_rs.
    low, high : float
        Band in which it may lie: assumed.
    words : str
        What the state is.
    """

    value: float
    low: float
    high: float
    words: str


REPLENISHMENT: Final = {
    "flooded": Replenishment(0.0, 0.0, 3e-8, "the bearing lies below the oil"),
    "bath": Replenishment(3e-8, 0.0, 6e-8, "bath to the middle of the lowest roller"),
    "jet": Replenishment(3e-8, 0.0, 6e-8, "jet of oil"),
    "oil_air": Replenishment(6e-8, 3e-8, 9e-8, "oil and air"),
    "grease": Replenishment(6e-8, 3e-8, 9e-8, "grease, with the viscosity of its base oil"),
}
"""States by the names that `Effects.replenishment` takes, with SKF's constants: 3e-8 for a low bath or a jet, 6e-8 for oil and
air or grease. The bands are assumed."""


class RollingSupply(NamedTuple):
    """What a state of lubrication leaves of the rolling resistance of contacts that are full of oil.

    Attributes
    ----------
    value : float
        Share (1).
    low, high : float
        Band in which it may lie (1).
    words : str
        What the state is.
    """

    value: float
    low: float
    high: float
    words: str


ROLLING_SUPPLY: Final = {
    "bath": RollingSupply(0.83, 0.7, 1.0, "bath, or a supply that nobody states"),
    "flooded": RollingSupply(1.0, 0.7, 1.0, "flooded: the bearing lies below the oil, or a jet fills it"),
}
"""States by the names that `Effects.supply` takes. No published law gives this share: it is assumed. Torques of a 32216 in a bath
over those of full contacts were 0.94, 0.77, 0.63 and 0.53 at 500 to 4000 rpm."""
SECTION_ROLLERS: Final = 4.0
"""D - d over the roller's diameter: assumed, as rollers take about half of the section's height."""


def supply_of(fill: float) -> OilSupply | None:
    """The named state that has this fill; None if none has."""
    return next((supply for supply in OIL_SUPPLIES.values() if supply.fill == fill), None)


def rolling_supply_of(fill: float) -> RollingSupply:
    """The state of lubrication of raceways where none is stated: flooded where all round the rollers is oil, else a bath."""
    return ROLLING_SUPPLY["flooded" if fill == OIL_SUPPLIES["flooded"].fill else "bath"]


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


def replenishment_decline(
    lubricant: Lubricant, constant: float, *, pitch_diameter: float, roller_diameter: float
) -> float:
    """How fast rolling resistance declines with speed, by SKF's kinematic replenishment of a tapered roller bearing.

    Parameters
    ----------
    lubricant : Lubricant
        The oil at its temperature.
    constant : float
        K_rs.
    pitch_diameter, roller_diameter : float
        Dpw and Dwe (m): (d + D)/2 is the former, D - d four times the latter.

    Returns
    -------
    float
        c of the factor exp(-c speed) (s): K_rs nu n (d + D) sqrt(K_Z/(2 (D - d))) over the speed in rad/s, with K_Z = 6, nu in
        mm2/s, n in rpm, d and D in mm.

    Notes
    -----
    Source: SKF, Rolling Bearings (general catalogue), kinematic replenishment. No range is given.

    Examples
    --------
    >>> import trbdyn as trb
    >>> oil = trb.lubricants.vg100(50.0)
    >>> round(trb.lubricants.replenishment_decline(oil, 3e-8, pitch_diameter=0.1085, roller_diameter=0.017), 6)
    0.000792
    """
    across, section = 2e3 * pitch_diameter, 1e3 * SECTION_ROLLERS * roller_diameter
    viscosity, turns = 1e6 * lubricant.viscosity / lubricant.density, 30.0 / math.pi
    return constant * viscosity * turns * across * math.sqrt(6.0 / (2.0 * section))


def _segment(radius: float, height: float) -> float:
    """Area of a circle that lies below a height above its centre."""
    height = min(max(height, -radius), radius)
    return radius**2 * math.acos(-height / radius) + height * math.sqrt(radius**2 - height**2)
