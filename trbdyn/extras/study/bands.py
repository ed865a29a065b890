"""Inputs that nobody knows exactly, and the bands in which they lie: one list for the bands of a user and for those of the
validation (``benchmarks/validation``).
"""

from __future__ import annotations

from typing import Final

from trbdyn.base.validation import Model, Number
from trbdyn.model.assembly import ShaftBearing, Subject
from trbdyn.model.assumed import PROFILE_BAND
from trbdyn.model.lubricants import REPLENISHMENT, ROLLING_SUPPLY, TEMPERATURES, rolling_supply_of, supply_of
from trbdyn.model.scene import Scene

RIB_LIMIT: Final = (0.1, 0.25)
"""Boundary friction at ribs: 0.1 (Sakaguchi and Harada 2006), 0.2 (Aihara 1987, Zhou and Hoeprich 1991, a maker's starting
torques), a quarter more (assumed)."""


class Band(Model):
    """An input that is not known exactly; every value between both ends is as likely.

    Parameters
    ----------
    path : str
        Which input, as in a study: ``lubricant.temperature_c``, ``bearing.roller.diameter``.
    low, high : float
        Ends, in the unit of the input. Whole numbers at both ends of a number that is whole stay whole.
    source : str
        Why the band is what it is.
    """

    path: str
    low: Number
    high: Number
    source: str = "given"


def open_inputs(subject: Subject) -> tuple[Band, ...]:
    """Inputs of a scene or an assembly that are hardly ever known exactly, and the bands they have without better knowledge.

    Estimates of a catalogue bearing with their own bands; a profile of rollers that nobody gave; temperature, roughness, boundary
    friction, the supply of oil to the raceways and, where oil drags, its share in the mixture.

    Parameters
    ----------
    subject : Scene or Assembly
        What is simulated. The bearings of an assembly have bands of their own, which are drawn by themselves.

    Returns
    -------
    tuple of Band
    """
    return tuple(band for prefix, part in subject.parts.items() for band in _of_part(prefix, part))


def _of_part(prefix: str, part: Scene | ShaftBearing) -> list[Band]:
    """Those of a bearing, whose paths begin with a prefix."""
    oil, effects, bearing = part.lubricant, part.effects, part.bearing
    found: list[Band] = []

    def add(path: str, low: float, high: float, source: str) -> None:
        found.append(Band(path=f"{prefix}{path}", low=low, high=high, source=source))

    for entry in bearing.estimated:
        if entry.low < entry.high:
            add(f"bearing.{entry.path}", entry.low, entry.high, entry.source)
    shape = "bearing.roller.profile.a_p"
    if "roller.profile.a_p" in bearing.assumed and f"{prefix}{shape}" not in {band.path for band in found}:
        add(shape, *PROFILE_BAND, "profiles that were published")
    if effects.films and oil.oil is not None:
        cooler, warmer, words = TEMPERATURES[oil.temperature_of]
        add("lubricant.temperature_c", oil.temperature_c + cooler, oil.temperature_c + warmer, words)
    if effects.films:
        for name, value in (("raceway", bearing.roughness.raceway), ("rib", bearing.roughness.rib)):
            add(f"bearing.roughness.{name}", 0.7 * value, 1.5 * value, "finishing and running in: assumed")
    if effects.lubrication in ("mixed", "boundary"):
        limit, at_rib = effects.friction.boundary_limit, effects.friction.rib_boundary_limit
        add("effects.friction.boundary_limit", 0.7 * limit, 2.0 * limit, "0.07 to 0.2, published")
        if effects.back_rib or effects.front_rib:
            add(
                "effects.friction.rib_boundary_limit", min(RIB_LIMIT[0], at_rib), max(RIB_LIMIT[1], at_rib), "published"
            )
    if effects.films and effects.rolling_resistance:
        state = next((one for one in ROLLING_SUPPLY.values() if one.value == effects.rolling_supply), None)
        state = rolling_supply_of(effects.oil_fill) if effects.supply is None else state
        if state is not None:
            add("effects.supply", state.low, state.high, f"{state.words}: assumed")
        for other in REPLENISHMENT.values():
            if effects.replenishment == other.value > 0.0:
                add("effects.replenishment", other.low, other.high, f"{other.words}: assumed")
                break
    if effects.oil_fill > 0.0:
        supply = supply_of(effects.oil_fill)
        low, high = (0.0, min(2.0 * effects.oil_fill, 1.0)) if supply is None else (supply.low, supply.high)
        words = "known in no bearing" if supply is None else supply.words
        add("effects.oil_fill", low, high, f"{words}: assumed")
    return found
