"""A bearing from the numbers of a catalogue page: boundary dimensions, dynamic rating C, factor e (or Y).

Catalogues do not tell what is inside. The cup's angle follows from e. Diameter, length and number of the rollers and the
maker's factor on C are, among all that give this C, those that depart least from what is usual, each in units of the
scatter among real bearings (`solve`); everything else is scaled from a bearing whose inner geometry is published. Every
estimate has a band and a source and stays marked as estimated (`Bearing.estimated`); whatever you know better, give it, or
change it later with ``replace``, which changes that number alone
(docs/theory/estimates.md#inner-geometry-from-a-catalogue-page).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from difflib import get_close_matches
from inspect import signature
from typing import Any, Final

from trbdyn.base.validation import as_number, as_whole_number
from trbdyn.errors import MISSING, InputError, Problem
from trbdyn.model.assumed import ISO_LENGTH, ISO_LONG, ISO_SHORT, RIG, cage_inertias
from trbdyn.model.assumed import cage_mass as steel_cage
from trbdyn.model.catalogue_rollers import FILL, LENGTH, MAKER, PITCH, SECTION, Page, Rollers, solve
from trbdyn.model.core_table import PARAMETERS
from trbdyn.model.estimated import Estimated
from trbdyn.model.ratings import Ratings
from trbdyn.model.roller import Profile, Roller

OTHER_MAKER: Final = 0.6
"""Angle (deg) by which a contact angle that is known may differ from the one that e or Y of another maker tell."""
ROUNDED_TWICE: Final = 0.2
"""Angle (deg) by which e and Y of one page may differ beyond their last digits: a 32303 is listed with e = 0.29, Y = 1.97."""
_ANGLE_SOURCE: Final = "tan(alpha) = e/1.5 (ISO 281), e as rounded in the catalogue"
NAMES_OF_CATALOGUES: Final = {
    "d": "bore",
    "D": "outside",
    "T": "width",
    "C_r": "C",
    "Cr": "C",
    "C_0": "C0",
    "C0r": "C0",
    "Z": "n_rollers",
    "Dwe": "roller_diameter",
    "Lwe": "roller_length",
    "Dpw": "pitch_diameter",
    "alpha": "contact_angle_deg",
    "Y1": "Y",
    "Y2": "Y",
    "Y_0": "Y0",
    "Pu": "Cu",
    "C_u": "Cu",
}
"""Names as they stand in catalogues, and what they are called here."""


NOT_USED: Final = {
    "B": "is the width of the cone, which is not used: width is T, over cone and cup; cup_width is that of the cup, often C",
    "a": "is the distance of the pressure centre, which follows from the angle of the cup: leave it out",
}
"""Numbers of a catalogue page that are not taken, and why."""
STATIC_SHARE: Final = (0.6, 4.0)
"""C0 over C of what can be meant: of 1402 rows of catalogues it is 0.815 to 3.11."""
FATIGUE_SHARE: Final = (0.03, 0.3)
"""Cu over C0 of what can be meant: ISO 281 has 1/8.2 for small bearings and less for large ones."""


def fields_from_catalogue(
    *,
    bore: Any = MISSING,
    outside: Any = MISSING,
    width: Any = MISSING,
    C: Any = MISSING,
    e: float | None = None,
    Y: float | None = None,
    C0: float | None = None,
    Y0: float | None = None,
    Cu: float | None = None,
    cup_width: float | None = None,
    n_rollers: int | None = None,
    roller_diameter: float | None = None,
    roller_length: float | None = None,
    pitch_diameter: float | None = None,
    contact_angle_deg: float | None = None,
    cage_mass: float | None = None,
    maker_factor: float | None = None,
    reference_speed_rpm: float | None = None,
    limiting_speed_rpm: float | None = None,
    name: str = "",
    others: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Fields of a bearing from catalogue numbers; see `Bearing.from_catalogue`, which calls it."""
    _known_names(others or {})
    given = {"bore": bore, "outside": outside, "width": width, "C": C}
    optional = {
        "cup_width": cup_width,
        "roller_diameter": roller_diameter,
        "roller_length": roller_length,
        "pitch_diameter": pitch_diameter,
        "contact_angle_deg": contact_angle_deg,
        "cage_mass": cage_mass,
        "e": e,
        "Y": Y,
        "C0": C0,
        "Y0": Y0,
        "Cu": Cu,
        "maker_factor": maker_factor,
        "reference_speed_rpm": reference_speed_rpm,
        "limiting_speed_rpm": limiting_speed_rpm,
    }
    for key, value in (given | {key: value for key, value in optional.items() if value is not None}).items():
        _positive(key, value)
    _check_dimensions(bore, outside, width)
    _check_share("C0", C0, "C", C, STATIC_SHARE)
    if C0 is not None:
        _check_share("Cu", Cu, "C0", C0, FATIGUE_SHARE)
    if n_rollers is not None:
        _count(n_rollers)
    if maker_factor is not None and not MAKER.low <= maker_factor <= MAKER.high:
        raise InputError.of("maker_factor", maker_factor, f"must be from {MAKER.low:g} to {MAKER.high:g} (1)")
    angle, angle_band = _angle(e, Y, contact_angle_deg)
    page = Page(
        bore, outside, width, angle, cup_width, n_rollers, roller_diameter, roller_length, pitch_diameter, maker_factor
    )
    _check_known(page)
    found, factor = solve(page, C)
    estimates = []
    if contact_angle_deg is None:
        estimates.append(_entry("cup_half_angle_deg", angle, *angle_band, "deg", _ANGLE_SOURCE))
    estimates += _roller_estimates(page, found, factor)
    ratings = Ratings(
        dynamic=C,
        static=C0,
        fatigue_limit=Cu,
        e=e,
        Y=Y,
        Y0=Y0,
        reference_speed_rpm=reference_speed_rpm,
        limiting_speed_rpm=limiting_speed_rpm,
    )
    name = name or f"{1e3 * bore:g}x{1e3 * outside:g}x{1e3 * width:g}"
    return _fields(found, angle, cage_mass, estimates, name) | {"ratings": ratings}


def _known_names(others: Mapping[str, Any]) -> None:
    known = tuple(signature(fields_from_catalogue).parameters)
    for key, value in others.items():
        called, near = NAMES_OF_CATALOGUES.get(key), get_close_matches(key, known, 1)
        hint = (
            f"is called {called} here"
            if called
            else NOT_USED.get(key)
            or (
                f"is unknown: did you mean {near[0]}?" if near else "is no number of a catalogue page that is used here"
            )
        )
        raise InputError.of(key, value, f"{hint}; d, D and T are bore, outside and width (m), C and C0 are in N")


def _check_share(key: str, value: float | None, whole: str, size: float, share: tuple[float, float]) -> None:
    """A rating that is no usual share of another one has another unit, or belongs to another bearing."""
    low, high = share[0] * size, share[1] * size
    if value is None or low <= value <= high:
        return
    kilo = f": {value:g} kN are {1e3 * value:g} N" if low <= 1e3 * value <= high else ""
    raise InputError.of(
        key, value, f"must be from {low:.3g} to {high:.3g}, {share[0]:g} to {share[1]:g} times {whole} (N){kilo}"
    )


def _positive(key: str, value: object) -> None:
    units = {
        "C": "N",
        "C0": "N",
        "Cu": "N",
        "Y0": "1",
        "e": "1",
        "Y": "1",
        "contact_angle_deg": "deg",
        "cage_mass": "kg",
        "maker_factor": "1",
    }
    unit = "rpm" if key.endswith("_rpm") else units.get(key, "m")
    if value is MISSING:
        raise InputError([Problem((key,), MISSING, f"must be given ({unit})")])
    try:
        number = as_number(value)
    except ValueError as error:
        raise InputError.of(key, value, f"{error} ({unit})") from None
    if not 0.0 < number < math.inf:
        raise InputError.of(key, value, f"must be > 0 ({unit})")


def _count(value: object) -> None:
    try:
        number = as_whole_number(value)
    except ValueError as error:
        raise InputError.of("n_rollers", value, f"{error} (1)") from None
    allowed = PARAMETERS["n_rollers"]
    if not allowed.lower <= number <= allowed.upper:
        raise InputError.of("n_rollers", value, f"must be from {allowed.lower:g} to {allowed.upper:g} (1)")


def _check_dimensions(bore: float, outside: float, width: float) -> None:
    if not 2e-3 <= bore <= 5.0:
        raise InputError.of("bore", bore, "must be from 0.002 to 5 (m): 50 mm is 0.05, 2 inches are 0.0508")
    if not 1.1 * bore <= outside <= 5.0 * bore:
        raise InputError.of(
            "outside", outside, f"must be from {1.1 * bore:g} to {5 * bore:g}, 1.1 to 5 times the bore (m)"
        )
    height = 0.5 * (outside - bore)
    if not 0.3 * height <= width <= 5.0 * height:
        raise InputError.of(
            "width", width, f"must be from {0.3 * height:g} to {5 * height:g}, for a section {height:g} m high (m)"
        )


def _check_known(page: Page) -> None:
    """What is given of the rollers lies within the bearing, and not over each other."""
    if not page.bore < page.pitch_diameter < page.outside:
        limit = f"must lie between bore and outside, {page.bore:g} and {page.outside:g} (m)"
        raise InputError.of("pitch_diameter", page.pitch_diameter, limit)
    if page.cup_width is not None and not 0.3 * page.width <= page.cup_width <= page.width:
        limit = f"must be from {0.3 * page.width:g} to {page.width:g}, 0.3 to 1 times the width (m)"
        raise InputError.of("cup_width", page.cup_width, limit)
    longest = page.along(1.0)
    if page.length is not None and page.length > longest:
        whose = "width of the bearing" if page.cup_width is None else "cup's width"
        limit = f"must be <= {longest:.4g}, the {whose} along the raceway (m)"
        raise InputError.of("roller_length", page.length, limit)
    if page.diameter is None:
        return
    if page.diameter >= page.height:
        raise InputError.of("roller_diameter", page.diameter, f"must be < {page.height:g}, the section's height (m)")
    most = math.floor(0.97 * math.pi / math.asin(min(page.diameter / page.pitch_diameter, 1.0)))
    if page.n_rollers is not None and page.n_rollers > most:
        raise InputError.of("n_rollers", page.n_rollers, f"must be <= {most} for rollers of {page.diameter:g} m (1)")


def _angle(e: float | None, Y: float | None, angle: float | None) -> tuple[float, tuple[float, float]]:
    """Half angle of the cup (deg) and its band by the rounding of e to 0.01 and Y to 0.1; what contradicts is refused. Where both
    miss each other by little, the angle is that of e, and the band holds both.
    """
    bands: dict[str, tuple[float, float]] = {}
    if e is not None:
        bands["e"] = (math.degrees(math.atan(max(e - 0.005, 1e-3) / 1.5)), math.degrees(math.atan((e + 0.005) / 1.5)))
    if Y is not None:
        bands["Y"] = (math.degrees(math.atan(0.4 / (Y + 0.05))), math.degrees(math.atan(0.4 / max(Y - 0.05, 1e-2))))
    if angle is not None:
        chosen, band = angle, (angle, angle)
    elif e is not None:
        chosen, band = math.degrees(math.atan(e / 1.5)), bands["e"]
    elif Y is not None:
        chosen, band = math.degrees(math.atan(0.4 / Y)), bands["Y"]
    else:
        raise InputError.of("e", None, "must be given, or Y, or contact_angle_deg: it tells the angle of the cup (1)")
    key, value = ("contact_angle_deg", angle) if angle is not None else ("e", e) if e is not None else ("Y", Y)
    if not 7.0 <= chosen <= 35.0:
        raise InputError.of(key, value, f"must give a contact angle from 7 to 35 deg, not {chosen:.3g} deg")
    slack = ROUNDED_TWICE if angle is None else OTHER_MAKER
    for other, (low, high) in bands.items():
        if band[1] + slack < low or high + slack < band[0]:
            right = 0.4 / math.tan(math.radians(chosen)) if other == "Y" else 1.5 * math.tan(math.radians(chosen))
            limit = (
                f"must be about {right:.3g}, as {key} = {value:g} says: e = 1.5 tan(alpha) and Y = 0.4 cot(alpha), so "
                "e times Y is 0.6; give the right ones, or one of them (1)"
            )
            raise InputError.of(other, e if other == "e" else Y, limit)
        if angle is None:
            common = max(band[0], low), min(band[1], high)
            band = common if common[0] <= common[1] else (min(band[0], low), max(band[1], high))
    return min(max(chosen, band[0]), band[1]), band


def _entry(path: str, value: float, low: float, high: float, unit: str, source: str) -> Estimated:
    return Estimated(path=path, value=value, low=min(low, value), high=max(high, value), unit=unit, source=source)


def _roller_estimates(page: Page, found: Rollers, factor: float) -> list[Estimated]:
    out = []
    usual, _ = page.diameters
    diameters = (
        (usual.low * page.height, usual.high * page.height) if page.diameter is None else (page.diameter, page.diameter)
    )
    rating = (
        f"C of the catalogue is {factor:.3f} times that of ISO 281 (maker's factor, {MAKER.low:g} to {MAKER.high:g})"
    )
    if page.maker_factor is not None:
        rating = (
            f"C of the catalogue is {factor:.3f} times that of ISO 281, maker_factor = {page.maker_factor:g} was given"
        )
    if page.pitch is None:
        low, high = PITCH.low * page.mean, PITCH.high * page.mean
        out.append(_entry("pitch_diameter", found.pitch, low, high, "m", "mean of bore and outside diameter"))
    if page.diameter is None:
        share = f"usual share of the section's height, {SECTION.value:g}, thicker or thinner by C; {rating}"
        if page.n_rollers is not None:
            share = f"{page.n_rollers} rollers that take {FILL.value:g} of the pitch circle, thicker or thinner by C; {rating}"
        out.append(_entry("roller.diameter", found.diameter, *diameters, "m", share))
    if page.length is None:
        low, high = LENGTH.low * page.along(page.cup_share.low), LENGTH.high * page.along(page.cup_share.high)
        source = f"usual share of the cup's width along the raceway, {LENGTH.value:g}, longer or shorter by C; {rating}"
        out.append(_entry("roller.effective_length", found.length, low, high, "m", source))
    if page.n_rollers is None:
        few = math.floor(page.count(FILL.low, diameters[1]))
        many = math.floor(page.count(FILL.high, diameters[0]))
        source = f"rollers take {FILL.low:g} to {FILL.high:g} of the pitch circle in real bearings"
        out.append(_entry("n_rollers", found.count, max(3, few), many, "1", source))
    return out


def _fields(
    found: Rollers, angle: float, cage_mass: float | None, estimates: list[Estimated], name: str
) -> dict[str, Any]:
    """Fields of the bearing: what is left is scaled from the 30310 test bearing, whose inner geometry is published."""
    scale, longer = found.diameter / RIG["diameter"], found.length / RIG["effective_length"]
    wide = found.pitch / RIG["pitch_diameter"]
    mass = steel_cage(wide, scale, longer) if cage_mass is None else cage_mass
    inertia = cage_inertias(mass, wide, scale, longer)
    heights = ("contact_height", "edge_low", "edge_high", "front_clearance", "front_low", "front_high")
    ribs = {key: scale * RIG[key] for key in heights}
    lengths = (
        "play_radial",
        "play_circumferential",
        "play_axial",
        "bar_width",
        "wall_inner",
        "wall_outer",
        "wall_half_width",
    )
    cage = {key: scale * RIG[key] for key in lengths}
    cage["rail_offset"] = longer * RIG["rail_offset"]
    if cage_mass is not None:
        cage["mass"] = cage_mass  # an estimated mass follows the cage's material, inertias follow the mass
    roller = Roller(
        diameter=found.diameter,
        effective_length=found.length,
        total_length=found.length + scale * (RIG["total_length"] - RIG["effective_length"]),
        profile=Profile.iso(),
    )
    scaled = "30310 test bearing (Sakaguchi and Harada 2006), scaled with"
    inertias = f"{scaled} mass and radius squared, the part along the axis with length squared"
    rows: list[tuple[str, float, float, float, str, str]] = [
        ("roller.total_length", roller.total_length, 1.0, 1.05, "m", f"{scaled} the roller's diameter"),
        ("ribs.contact_height", ribs["contact_height"], 0.7, 1.3, "m", f"{scaled} the roller's diameter"),
        ("cage.play_radial", cage["play_radial"], 0.5, 2.0, "m", f"{scaled} the roller's diameter"),
        ("cage.play_circumferential", cage["play_circumferential"], 0.5, 2.0, "m", f"{scaled} the roller's diameter"),
        ("cage.play_axial", cage["play_axial"], 0.5, 2.0, "m", f"{scaled} the roller's diameter"),
        ("cage.inertia_axial", inertia["inertia_axial"], 0.75, 1.07, "kg m2", inertias),
        ("cage.inertia_transverse", inertia["inertia_transverse"], 0.95, 1.35, "kg m2", inertias),
    ]  # fmt: skip
    if cage_mass is None:
        rows.append(
            ("cage.mass", mass, 0.4, 1.6, "kg", f"{scaled} pitch diameter, roller diameter and roller length; of steel")
        )
    listed = [
        _entry(path, value, low * value, high * value, unit, source) for path, value, low, high, unit, source in rows
    ]
    amplitude = ISO_SHORT if found.length <= ISO_LENGTH * found.diameter else ISO_LONG
    source = "profile of ISO/TS 16281; band from straight (0) to the larger of its constants, which a 32216 was measured with"
    listed.append(_entry("roller.profile.a_p", amplitude, 0.0, ISO_LONG, "1", source))
    return {
        "name": name,
        "n_rollers": found.count,
        "cup_half_angle_deg": angle,
        "pitch_diameter": found.pitch,
        "roller": roller,
        "ribs": ribs,
        "cage": cage,
        "estimates": tuple(estimates + listed),
    }
