"""What a catalogue page of a cylindrical bearing tells besides: its type, the diameters of its raceways, and the usual clearance
(docs/theory/estimates.md#cylindrical-bearings).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final

from trbdyn.errors import InputError
from trbdyn.model.catalogue_rollers import Page
from trbdyn.model.estimated import Estimated
from trbdyn.model.tolerances import CLEARANCE_SIZES, clearance_limits

TYPES: Final = ("NU", "NJ", "NUP", "N")
"""Types of cylindrical bearings (ISO 15)."""
OF_CYLINDERS: Final[tuple[str, ...]] = ("F", "E", "radial_clearance")
OF_CONES: Final[tuple[str, ...]] = ("Y0", "contact_angle_deg", "cup_width", "a")
"""What a page of one kind of bearing tells, and one of the other kind does not."""
AFTER_FIT: Final = 0.5
"""Share of that clearance that fits and warm shafts leave; assumed, between none and all of it."""


def check_kind(given: Mapping[str, Any]) -> None:
    """Refuse a type that is unknown, and numbers that only the other kind of bearing has."""
    flanges, more = given.get("flanges"), "(docs/howto/cylindrical.md)"
    if flanges is None:
        strange, limit = OF_CYLINDERS, f"must not be given without flanges: {', '.join(TYPES)} {more}"
    elif flanges in TYPES:
        strange = OF_CONES
        limit = f"must not be given with flanges = {flanges!r}: a cylindrical bearing has none {more}"
    else:
        raise InputError.of("flanges", flanges, f"must be one of {', '.join(TYPES)}, the type in ISO 15 {more}")
    for name in strange:
        if name in given:
            raise InputError.of(name, given[name], limit)


def with_raceways(page: Page, F: float | None, E: float | None) -> tuple[Page, list[Estimated]]:
    """What the raceways of a cylindrical bearing tell: both together give roller and pitch diameter, one with a usual pitch
    diameter an estimate.
    """
    for key, value, low, high in (("F", F, page.bore, page.mean), ("E", E, page.mean, page.outside)):
        if value is not None and not low < value < high:
            whose = "inner" if key == "F" else "outer"
            limit = f"must be from {low:.4g} to {high:.4g}: diameter of the raceway of the {whose} ring (m)"
            raise InputError.of(key, value, limit)
    if F is not None and E is not None:
        told = {"roller_diameter": (page.diameter, 0.5 * (E - F)), "pitch_diameter": (page.pitch, 0.5 * (E + F))}
        for key, (given, found) in told.items():
            if given is not None and not math.isclose(given, found, rel_tol=0.01):
                raise InputError.of(key, given, f"must be {found:.4g}, as E and F say, or be left out (m)")
        diameter, pitch = (found if given is None else given for given, found in told.values())
        return replace(page, diameter=diameter, pitch=pitch), []
    if F is None and E is None:
        return page, []
    race, side = (F, 1.0) if F is not None else (float(E or 0.0), -1.0)
    name = f"{'F' if side > 0 else 'E'} = {1e3 * race:g} mm"
    if page.diameter is not None:
        return (page if page.pitch else replace(page, pitch=race + side * page.diameter)), []
    if page.pitch is not None:
        return replace(page, diameter=side * (page.pitch - race)), []
    usual = page.usual.pitch
    pitch = usual.value * page.mean
    source = f"{usual.value:g} of the mean of bore and outside diameter, as usual"
    low, high = usual.low * page.mean, usual.high * page.mean
    least, most = sorted(side * (one - race) for one in (low, high))
    if not least > 0.0:
        raise InputError.of(
            "F" if side > 0 else "E", race, f"must leave room for rollers around the circle of {pitch:.4g} m (m)"
        )
    diameter = side * (pitch - race)
    return replace(page, diameter=diameter, pitch=pitch), [
        Estimated.of("pitch_diameter", pitch, low, high, "m", source),
        Estimated.of(
            "roller.diameter", diameter, least, most, "m", f"between the raceway {name} and the pitch circle, {source}"
        ),
    ]


def usual_clearance(bore: float) -> Estimated:
    """Operating clearance of a cylindrical bearing: what fits leave of group N."""
    listed = min(bore, 1e-3 * CLEARANCE_SIZES[-1])
    least, most = (end * bore / listed for end in clearance_limits("CN", listed))
    source = (
        f"{AFTER_FIT:g} of group N of ISO 5753-1, {1e6 * least:.3g} to {1e6 * most:.3g} um before mounting, assumed; band from "
        "none to all of it"
    )
    return Estimated.of("radial_clearance", AFTER_FIT * 0.5 * (least + most), 0.0, most, "m", source)
