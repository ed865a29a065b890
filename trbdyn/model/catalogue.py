"""A bearing from the numbers of a catalogue page: boundary dimensions, dynamic rating C, factor e (or Y); of a cylindrical
bearing its type, C0, and the diameter of a raceway.

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
from dataclasses import replace
from difflib import get_close_matches
from typing import Any, Final

from trbdyn.base.validation import number_of, whole_number_of
from trbdyn.errors import MISSING, InputError, Problem
from trbdyn.model.assumed import PROFILE_BAND, scaled
from trbdyn.model.catalogue_cylinders import check_kind, usual_clearance, with_raceways
from trbdyn.model.catalogue_rollers import FILL_BAND, MAKER, Page, Rollers, solve
from trbdyn.model.core_table import PARAMETERS
from trbdyn.model.estimated import Estimated
from trbdyn.model.ratings import Ratings
from trbdyn.model.roller import Profile, Roller

OTHER_MAKER: Final = 0.6
"""Angle (deg) by which a contact angle that is known may differ from the one that e or Y of another maker tell."""
ROUNDED_TWICE: Final = 0.2
"""Angle (deg) by which e and Y of one page may differ beyond their last digits: a 32303 is listed with e = 0.29, Y = 1.97."""
ANGLES: Final = (5.0, 45.0)
"""Half angles of the cup that a page may tell (deg): e from 0.13 to 1.5. Flatter ones were not found in any catalogue."""
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
    "B": "is the width of the cone, which is not used: width is T, over cone and cup; cup_width is that of the cup, often C; "
    "of a cylindrical bearing width is B",
}
"""Numbers of a catalogue page that are not taken, and why."""
STATIC_SHARE: Final = (0.6, 4.0)
"""C0 over C of what can be meant: of 1402 rows of catalogues it is 0.815 to 3.11."""
FATIGUE_SHARE: Final = (0.03, 0.3)
"""Cu over C0 of what can be meant: ISO 281 has 1/8.2 for small bearings and less for large ones."""


NUMBERS: Final = {
    "bore": "m",
    "outside": "m",
    "width": "m",
    "C": "N",
    "cup_width": "m",
    "roller_diameter": "m",
    "roller_length": "m",
    "pitch_diameter": "m",
    "contact_angle_deg": "deg",
    "cage_mass": "kg",
    "e": "1",
    "Y": "1",
    "C0": "N",
    "Y0": "1",
    "Cu": "N",
    "maker_factor": "1",
    "reference_speed_rpm": "rpm",
    "limiting_speed_rpm": "rpm",
    "F": "m",
    "E": "m",
    "a": "m",
}
"""Numbers of a catalogue page that are > 0, with their units; the first four are needed."""
OTHERS: Final = ("n_rollers", "flanges", "radial_clearance", "name")
"""What a page may tell besides."""


def fields_from_catalogue(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """Fields of a bearing from a catalogue page, by the names of `Bearing.from_catalogue`; what is None was not given."""
    _check_names(numbers)
    given = {name: value for name, value in numbers.items() if value is not None}
    for name in NUMBERS:
        if name in given or name in ("bore", "outside", "width", "C"):
            _positive(name, given.get(name, MISSING))
    get = given.get
    bore, C, C0, flanges = given["bore"], given["C"], get("C0"), get("flanges")
    _check_dimensions(bore, given["outside"], given["width"])
    _check_share("C0", C0, "C", C, STATIC_SHARE)
    if C0 is not None:
        _check_share("Cu", get("Cu"), "C0", C0, FATIGUE_SHARE)
    if "n_rollers" in given:
        allowed = PARAMETERS["n_rollers"]
        whole_number_of("n_rollers", given["n_rollers"], int(allowed.lower), int(allowed.upper))
    if not MAKER.low <= get("maker_factor", 1.0) <= MAKER.high:
        limit = f"must be from {MAKER.low:g} to {MAKER.high:g} (1)"
        raise InputError.of("maker_factor", given["maker_factor"], limit)
    check_kind(given)
    estimates: list[Estimated] = []
    angle = 0.0
    if flanges is None:
        angle, band = _angle(get("e"), get("Y"), get("contact_angle_deg"))
        if "contact_angle_deg" not in given:
            estimates.append(Estimated.of("cup_half_angle_deg", angle, *band, "deg", _ANGLE_SOURCE))
    page = Page(
        bore,
        given["outside"],
        given["width"],
        angle,
        cup_width=get("cup_width"),
        n_rollers=get("n_rollers"),
        diameter=get("roller_diameter"),
        length=get("roller_length"),
        pitch=get("pitch_diameter"),
        maker_factor=get("maker_factor"),
        static=None if flanges is None else C0,
    )
    if flanges is not None:
        page, more = with_raceways(page, get("F"), get("E"))
        estimates += more
    _check_known(page)
    found, factor = solve(page, C)
    estimates += _roller_estimates(page, found, factor)
    cylinder = None
    if flanges is not None:
        if (clearance := get("radial_clearance")) is None:
            estimates.append(usual_clearance(bore))
            clearance = estimates[-1].value
        cylinder = {"flanges": flanges, "radial_clearance": clearance}
    sizes = {name: float(given[name]) for name in ("bore", "outside", "width")}
    _check_load_centre(get("a"), given["width"], given["outside"], angle)
    factors = ("e", "Y", "Y0", "reference_speed_rpm", "limiting_speed_rpm")
    ratings = Ratings(
        dynamic=C, static=C0, fatigue_limit=get("Cu"), load_centre=get("a"), **{name: get(name) for name in factors}
    )
    name = get("name") or "x".join(f"{1e3 * size:g}" for size in sizes.values())
    return _fields(found, get("cage_mass"), estimates, cylinder) | {"name": name, **sizes, "ratings": ratings}


def _check_names(numbers: Mapping[str, Any]) -> None:
    known = (*NUMBERS, *OTHERS)
    for key, value in numbers.items():
        if key in known:
            continue
        called, near = NAMES_OF_CATALOGUES.get(key), get_close_matches(key, known, 1)
        hint = f"is unknown: did you mean {near[0]}?" if near else "is no number of a catalogue page that is used here"
        hint = f"is called {called} here" if called else NOT_USED.get(key, hint)
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


def _check_load_centre(a: float | None, width: float, outside: float, angle: float) -> None:
    """The load centre lies where normals of a cup of this angle can cross the axis."""
    most = width + 0.5 * outside * math.tan(math.radians(angle))
    if a is not None and not 0.3 * width <= a <= most:
        limit = (
            f"must be from {0.3 * width:.4g} to {most:.4g}: distance of the load centre from the outer ring's face at the small "
            f"ends, for a half angle of {angle:.3g} deg (m)"
        )
        raise InputError.of("a", a, limit)


def _positive(key: str, value: object) -> None:
    unit = NUMBERS[key]
    if value is MISSING:
        raise InputError([Problem((key,), MISSING, f"must be given ({unit})")])
    if not number_of(key, value, unit, gt=0.0) < math.inf:
        raise InputError.of(key, value, f"must be a finite number ({unit})")


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
        raise InputError.of("e", None, "must be given, or Y, or contact_angle_deg: it gives the angle of the cup (1)")
    key, value = ("contact_angle_deg", angle) if angle is not None else ("e", e) if e is not None else ("Y", Y)
    least, most = ANGLES
    if not least <= chosen <= most:
        raise InputError.of(
            key, value, f"must give a contact angle from {least:g} to {most:g} deg, not {chosen:.3g} deg"
        )
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


def _roller_estimates(page: Page, found: Rollers, factor: float) -> list[Estimated]:
    out = []
    usual, _ = page.diameters
    kind = page.usual
    if page.angle == 0.0:
        taken = found.count * found.diameter / (math.pi * found.pitch)
        kind = replace(kind, fill=kind.fill.around(taken, FILL_BAND))
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
        low, high = kind.pitch.low * page.mean, kind.pitch.high * page.mean
        times = "" if kind.pitch.value == 1.0 else f"{kind.pitch.value:g} of the "
        out.append(
            Estimated.of("pitch_diameter", found.pitch, low, high, "m", f"{times}mean of bore and outside diameter")
        )
    if page.diameter is None:
        share = f"usual share of the section's height, {kind.section.value:g}, thicker or thinner by C; {rating}"
        if page.n_rollers is not None:
            counted = f"{page.n_rollers} rollers that take {kind.fill.value:g} of the pitch circle"
            share = f"{counted}, thicker or thinner by C; {rating}"
        out.append(Estimated.of("roller.diameter", found.diameter, *diameters, "m", share))
    if page.length is None:
        low, high = kind.length.low * page.along(page.cup_share.low), kind.length.high * page.along(page.cup_share.high)
        whose = "bearing's width" if page.angle == 0.0 else "cup's width along the raceway"
        source = f"usual share of the {whose}, {kind.length.value:g}, longer or shorter by C; {rating}"
        if page.static is not None:
            source = f"C0 by ISO 76 with {found.count} rollers; {rating}"
            few, many = (page.count(one, found.diameter) for one in (kind.fill.low, kind.fill.high))
            counts = (few, many) if page.n_rollers is None else (page.n_rollers, page.n_rollers)
            ends = [share * found.length * found.count / one for one, share in zip(counts, (1.05, 0.95), strict=True)]
            low, high = max(low, ends[1]), min(high, ends[0])
        out.append(Estimated.of("roller.effective_length", found.length, low, high, "m", source))
    if page.n_rollers is None:
        few = math.floor(page.count(kind.fill.low, diameters[1]))
        many = math.floor(page.count(kind.fill.high, diameters[0]))
        source = f"rollers take {kind.fill.low:.2g} to {kind.fill.high:.2g} of the pitch circle in real bearings"
        out.append(Estimated.of("n_rollers", found.count, max(3, few), many, "1", source))
    return out


def _fields(
    found: Rollers, cage_mass: float | None, estimates: list[Estimated], cylinder: dict[str, Any] | None
) -> dict[str, Any]:
    """Fields of the bearing: what is left is scaled from the 30310 test bearing, whose inner geometry is published. `cylinder`:
    type and clearance of a cylindrical bearing.
    """
    size = {
        "diameter": found.diameter,
        "effective_length": found.length,
        "pitch_diameter": found.pitch,
        "cup_half_angle_deg": found.angle,
    }
    made = scaled(size if cage_mass is None else size | {"mass": cage_mass})
    heights = ["contact_height", "edge_low", "edge_high"]
    heights += ["front_clearance", "front_low", "front_high"] if cylinder is None else ["clearance"]
    ribs: dict[str, Any] = {key: made["ribs"][key] for key in heights}
    inner = made["cage"]
    plays = ("play_radial", "play_circumferential", "play_axial")
    lengths = (*plays, "bar_width", "wall_inner", "wall_outer", "wall_half_width", "rail_offset")
    cage = {key: inner[key] for key in lengths}
    if cage_mass is not None:
        cage["mass"] = cage_mass  # an estimated mass follows the cage's material, inertias follow the mass
    total = made["roller"]["total_length"]
    ends = {} if cylinder is None else {"end_radius": made["roller"]["end_radius"]}
    roller = Roller(
        diameter=found.diameter, effective_length=found.length, total_length=total, profile=Profile.iso(), **ends
    )
    origin = "30310 test bearing (Sakaguchi and Harada 2006), scaled with"
    across = f"{origin} the roller's diameter"
    inertias = f"{origin} mass and radius squared, the part along the axis with length squared"

    def share(path: str, value: float, low: float, high: float, unit: str, source: str) -> None:
        """List an estimate; its band is over its value."""
        estimates.append(Estimated.of(path, value, low * value, high * value, unit, source))

    share("roller.total_length", total, 1.0, 1.05, "m", across)
    share("ribs.contact_height", ribs["contact_height"], 0.7, 1.3, "m", across)
    for name in plays:
        share(f"cage.{name}", cage[name], 0.5, 2.0, "m", across)
    share("cage.inertia_axial", inner["inertia_axial"], 0.75, 1.07, "kg m2", inertias)
    share("cage.inertia_transverse", inner["inertia_transverse"], 0.95, 1.35, "kg m2", inertias)
    if cylinder is not None:
        share("ribs.clearance", ribs["clearance"], 0.3, 3.0, "m", "1.5e-3 of the roller's diameter, assumed")
    if cage_mass is None:
        of_mass = f"{origin} pitch diameter, roller diameter and roller length; of steel"
        share("cage.mass", inner["mass"], 0.4, 1.6, "kg", of_mass)
    source = "profile of ISO 16281; band of published profiles (docs/theory/geometry.md#roller-profile)"
    amplitude = made["roller.profile"]["a_p"]
    estimates.append(Estimated.of("roller.profile.a_p", amplitude, *PROFILE_BAND, "1", source))
    fields = {
        "n_rollers": found.count,
        "cup_half_angle_deg": found.angle,
        "pitch_diameter": found.pitch,
        "roller": roller,
        "ribs": ribs,
        "cage": cage,
        "estimates": tuple(estimates),
    }
    if cylinder is not None:
        ribs["flanges"] = cylinder["flanges"]
        fields["radial_clearance"] = cylinder["radial_clearance"]
    return fields
