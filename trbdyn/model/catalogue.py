"""A bearing from the numbers of a catalogue page: boundary dimensions, dynamic rating C, factor e (or Y).

Catalogues do not tell what is inside. The inner geometry is estimated: the cup's angle from e, the size of the rollers
from the rating formula of ISO 281, everything else from usual ratios. Every estimate has a band and a source and stays
marked as estimated (`Bearing.estimated`); whatever you know better, give it, or change it later with ``replace``
(docs/theory/estimates.md#inner-geometry-from-a-catalogue-page).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from trbdyn.base.validation import as_number, as_whole_number
from trbdyn.errors import InputError
from trbdyn.model.assumed import RIG
from trbdyn.model.core_table import PARAMETERS
from trbdyn.model.estimated import Estimated
from trbdyn.model.roller import Profile, Roller

RATIOS: Final[dict[str, tuple[float, float, float]]] = {
    "pitch": (1.0, 0.97, 1.035),
    "diameter": (0.50, 0.42, 0.60),
    "cup_width": (0.78, 0.72, 0.87),
    "length": (0.86, 0.72, 1.0),
    "fill": (0.82, 0.70, 0.88),
}
"""Usual value, lowest and highest of the ratios that the estimates rest on.

pitch: pitch diameter over (d + D)/2. diameter: roller diameter over section height (D - d)/2. cup_width: width of the
cup over that of the bearing, as in ISO 355's dimension series 02, 03, 20, 22, 33. length: effective length over the
cup's width along the raceway. fill: Z Dwe/(pi Dpw), the share of the pitch circle that rollers take. Set so that the
two bearings of known inner geometry that ship with the package lie inside."""

_ANGLE_SOURCE: Final = "tan(alpha) = e/1.5 (ISO 281), e as rounded in the catalogue"

MAX_FACTOR: Final = 1.6
"""Largest ratio of a catalogue's C to ISO 281's that is still taken as a maker's factor for steel and finish."""


def rating_iso281(
    *, n_rollers: int, roller_diameter: float, roller_length: float, pitch_diameter: float, contact_angle_deg: float
) -> float:
    """Basic dynamic radial load rating of a single-row radial roller bearing.

    Cr = bm fc (Lwe cos alpha)^(7/9) Z^(3/4) Dwe^(29/27) with bm = 1.1 and fc a function of Dwe cos(alpha)/Dpw.

    Parameters
    ----------
    n_rollers : int
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
    >>> from trbdyn.model.catalogue import rating_iso281
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


@dataclass(frozen=True)
class _Rollers:
    """Sizes that are looked for (m)."""

    count: int
    diameter: float
    length: float
    pitch: float
    angle: float

    @property
    def rating(self) -> float:
        return rating_iso281(
            n_rollers=self.count,
            roller_diameter=self.diameter,
            roller_length=self.length,
            pitch_diameter=self.pitch,
            contact_angle_deg=self.angle,
        )


def fields_from_catalogue(
    *,
    bore: float,
    outside: float,
    width: float,
    C: float,
    e: float | None = None,
    Y: float | None = None,
    cup_width: float | None = None,
    n_rollers: int | None = None,
    roller_diameter: float | None = None,
    roller_length: float | None = None,
    pitch_diameter: float | None = None,
    contact_angle_deg: float | None = None,
    cage_mass: float | None = None,
    name: str = "",
) -> dict[str, Any]:
    """Fields of a bearing from catalogue numbers; see `Bearing.from_catalogue`, which calls it."""
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
    }
    for key, value in (given | {key: value for key, value in optional.items() if value is not None}).items():
        _positive(key, value)
    _check_dimensions(bore, outside, width)
    if n_rollers is not None:
        _count(n_rollers)
    estimates: list[Estimated] = []
    angle, angle_band = _angle(e, Y, contact_angle_deg)
    if contact_angle_deg is None:
        estimates.append(
            _entry(
                "cup_half_angle_deg",
                angle,
                *angle_band,
                "deg",
                _ANGLE_SOURCE,
            )
        )
    found, factor = _solve(
        bore, outside, width, C, angle, cup_width, n_rollers, roller_diameter, roller_length, pitch_diameter
    )
    sizes = {"roller_diameter": roller_diameter, "roller_length": roller_length, "pitch_diameter": pitch_diameter}
    estimates += _roller_estimates(
        found, bore, outside, width, C / factor, cup_width, factor,
        known={"n_rollers": n_rollers, **sizes},
    )  # fmt: skip
    return _fields(found, C, angle, cage_mass, estimates, name or f"{1e3 * bore:g}x{1e3 * outside:g}x{1e3 * width:g}")


def _positive(key: str, value: object) -> None:
    units = {"C": "N", "e": "1", "Y": "1", "contact_angle_deg": "deg", "cage_mass": "kg"}
    unit = units.get(key, "m")
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
        raise InputError.of("bore", bore, "must be from 0.002 to 5 (m): 50 mm is 0.05")
    if not 1.1 * bore <= outside <= 5.0 * bore:
        raise InputError.of(
            "outside", outside, f"must be from {1.1 * bore:g} to {5 * bore:g}, 1.1 to 5 times the bore (m)"
        )
    height = 0.5 * (outside - bore)
    if not 0.3 * height <= width <= 5.0 * height:
        raise InputError.of(
            "width", width, f"must be from {0.3 * height:g} to {5 * height:g}, for a section {height:g} m high (m)"
        )


def _angle(e: float | None, Y: float | None, angle: float | None) -> tuple[float, tuple[float, float]]:
    """Half angle of the cup (deg) and its band by the rounding of e to 0.01 or Y to 0.1."""
    if angle is not None:
        chosen, band = angle, (angle, angle)
    elif e is not None:
        chosen = math.degrees(math.atan(e / 1.5))
        band = (math.degrees(math.atan(max(e - 0.005, 1e-3) / 1.5)), math.degrees(math.atan((e + 0.005) / 1.5)))
    elif Y is not None:
        chosen = math.degrees(math.atan(0.4 / Y))
        band = (math.degrees(math.atan(0.4 / (Y + 0.05))), math.degrees(math.atan(0.4 / max(Y - 0.05, 1e-2))))
    else:
        raise InputError.of("e", None, "must be given, or Y, or contact_angle_deg: it tells the angle of the cup (1)")
    if not 7.0 <= chosen <= 35.0:
        key, value = ("contact_angle_deg", angle) if angle is not None else ("e", e) if e is not None else ("Y", Y)
        raise InputError.of(key, value, f"must give a contact angle from 7 to 35 deg, not {chosen:.3g} deg")
    return chosen, band


def _cup(width: float, cup_width: float | None) -> float:
    return RATIOS["cup_width"][0] * width if cup_width is None else cup_width


def _most(diameter: float, pitch: float, share: float) -> int:
    """Number of rollers that take a share of the pitch circle, at least 3 and never overlapping."""
    return max(
        3, min(int(share * math.pi * pitch / diameter), int(0.97 * math.pi / math.asin(min(diameter / pitch, 1.0))))
    )


def _solve(
    bore: float,
    outside: float,
    width: float,
    C: float,
    angle: float,
    cup_width: float | None,
    n_rollers: int | None,
    diameter: float | None,
    length: float | None,
    pitch: float | None,
) -> tuple[_Rollers, float]:
    """Rollers whose rating is C, and the factor of the maker that remains where no usual rollers reach it."""
    height = 0.5 * (outside - bore)
    chosen_pitch = RATIOS["pitch"][0] * 0.5 * (bore + outside) if pitch is None else pitch
    if not bore < chosen_pitch < outside:
        raise InputError.of(
            "pitch_diameter", chosen_pitch, f"must lie between bore and outside, {bore:g} and {outside:g} (m)"
        )
    most = _most(RATIOS["diameter"][1] * height if diameter is None else diameter, chosen_pitch, 1.0)
    if n_rollers is not None and n_rollers > most:
        raise InputError.of("n_rollers", n_rollers, f"must be <= {most} for rollers that fit these dimensions (1)")
    along = _cup(width, cup_width) / math.cos(math.radians(angle))
    usual, low, high = RATIOS["length"]
    shares = RATIOS["diameter"]

    def rollers(share: float, fill: float, size: float | None) -> _Rollers:
        chosen = share * height if diameter is None else diameter
        count = _most(chosen, chosen_pitch, fill) if n_rollers is None else n_rollers
        found = _Rollers(count, chosen, usual * along, chosen_pitch, angle)
        if size is not None:
            return _Rollers(count, chosen, size, chosen_pitch, angle)
        wanted = found.length * (C / found.rating) ** (9.0 / 7.0)
        return _Rollers(count, chosen, min(max(wanted, low * along), high * along), chosen_pitch, angle)

    # the usual rollers first; then thicker or thinner ones, then more or fewer, until the length is a usual one
    tries = [(shares[0], RATIOS["fill"][0])]
    steps = [0.25, 0.5, 0.75, 1.0]
    grows = rollers(*tries[0], length).rating < C
    end, fill_end = (shares[2], RATIOS["fill"][2]) if grows else (shares[1], RATIOS["fill"][1])
    tries += [(shares[0] + step * (end - shares[0]), RATIOS["fill"][0]) for step in steps]
    tries += [(end, RATIOS["fill"][0] + step * (fill_end - RATIOS["fill"][0])) for step in steps]
    best = None
    for share, fill in tries:
        found = rollers(share, fill, length)
        if best is None or abs(math.log(C / found.rating)) < abs(math.log(C / best.rating)):
            best = found
        if abs(C / found.rating - 1.0) < 1e-9:
            break
    assert best is not None
    factor = C / best.rating
    if not 1.0 / MAX_FACTOR <= factor <= MAX_FACTOR:
        smallest, largest = best.rating / MAX_FACTOR, best.rating * MAX_FACTOR
        raise InputError.of(
            "C",
            C,
            f"must be from about {smallest:.3g} to {largest:.3g} for rollers that fit these dimensions (N): 125 kN is 125e3",
        )
    return best, 1.0 if abs(factor - 1.0) < 1e-9 else factor


def _entry(path: str, value: float, low: float, high: float, unit: str, source: str) -> Estimated:
    return Estimated(path=path, value=value, low=min(low, value), high=max(high, value), unit=unit, source=source)


def _roller_estimates(
    found: _Rollers,
    bore: float,
    outside: float,
    width: float,
    rating: float,
    cup_width: float | None,
    factor: float,
    known: dict[str, Any],
) -> list[Estimated]:
    height, mean = 0.5 * (outside - bore), 0.5 * (bore + outside)
    along = _cup(width, cup_width) / math.cos(math.radians(found.angle))
    maker = (
        ""
        if factor == 1.0
        else f"; the catalogue's C is {factor:.3f} times that of ISO 281, taken as the maker's factor"
    )
    out = []
    if known["pitch_diameter"] is None:
        _, low, high = RATIOS["pitch"]
        out.append(
            _entry("pitch_diameter", found.pitch, low * mean, high * mean, "m", "mean of bore and outside diameter")
        )
    if known["roller_diameter"] is None:
        _, low, high = RATIOS["diameter"]
        source = f"usual share of the section's height, as far as C allows{maker}"
        out.append(_entry("roller.diameter", found.diameter, low * height, high * height, "m", source))
    if known["roller_length"] is None:
        _, low, high = RATIOS["length"]
        source = f"ISO 281 rating solved for the length: C = {rating:.4g} N{maker}"
        out.append(_entry("roller.effective_length", found.length, low * along, high * along, "m", source))
    if known["n_rollers"] is None:
        _, low, high = RATIOS["fill"]
        few, many = (_most(found.diameter, found.pitch, share) for share in (low, high))
        out.append(
            _entry("n_rollers", found.count, few, many, "1", "usual share of the pitch circle that rollers take")
        )
    return out


def _fields(
    found: _Rollers, C: float, angle: float, cage_mass: float | None, estimates: list[Estimated], name: str
) -> dict[str, Any]:
    """Fields of the bearing: what is left is scaled from the 30310 test bearing, whose inner geometry is published."""
    scale, longer = found.diameter / RIG["diameter"], found.length / RIG["effective_length"]
    wide = found.pitch / RIG["pitch_diameter"]
    mass = RIG["mass"] * wide**2 * longer if cage_mass is None else cage_mass
    inertia = mass / RIG["mass"] * wide**2
    load = 5.0 * 0.05 * C / (found.count * math.cos(math.radians(angle)))
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
    cage |= {
        "mass": mass,
        "inertia_axial": inertia * RIG["inertia_axial"],
        "inertia_transverse": inertia * RIG["inertia_transverse"],
        "rail_offset": longer * RIG["rail_offset"],
    }
    roller = Roller(
        diameter=found.diameter,
        effective_length=found.length,
        total_length=found.length + scale * (RIG["total_length"] - RIG["effective_length"]),
        profile=Profile.logarithmic(load),
    )
    scaled = "30310 test bearing (Sakaguchi and Harada 2006), scaled with"
    inertias = f"{scaled} mass and pitch diameter squared"
    rows: list[tuple[str, float, float, float, str, str]] = [
        ("roller.total_length", roller.total_length, 1.0, 1.05, "m", f"{scaled} the roller's diameter"),
        ("roller.profile.load", load, 0.3, 3.0, "N", "heaviest roller at a radial load of 5 % of C (Stribeck)"),
        ("ribs.contact_height", ribs["contact_height"], 0.7, 1.3, "m", f"{scaled} the roller's diameter"),
        ("cage.play_radial", cage["play_radial"], 0.5, 2.0, "m", f"{scaled} the roller's diameter"),
        ("cage.play_circumferential", cage["play_circumferential"], 0.5, 2.0, "m", f"{scaled} the roller's diameter"),
        ("cage.play_axial", cage["play_axial"], 0.5, 2.0, "m", f"{scaled} the roller's diameter"),
        ("cage.inertia_axial", cage["inertia_axial"], 0.5, 1.5, "kg m2", inertias),
        ("cage.inertia_transverse", cage["inertia_transverse"], 0.51, 1.5, "kg m2", inertias),
    ]  # fmt: skip
    if cage_mass is None:
        rows.append(("cage.mass", mass, 0.4, 1.6, "kg", f"{scaled} pitch diameter squared and roller length"))
    listed = [
        _entry(path, value, low * value, high * value, unit, source) for path, value, low, high, unit, source in rows
    ]
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
