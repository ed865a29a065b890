"""Rollers from a catalogue's C: among all that give it, those that depart least from what is usual
(docs/theory/estimates.md#inner-geometry-from-a-catalogue-page).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

from trbdyn.errors import InputError
from trbdyn.model.ratings import rating_iso76, rating_iso281


@dataclass(frozen=True)
class Usual:
    """A ratio that catalogues do not tell: its usual value, how far real bearings scatter, and between what it must lie (1)."""

    value: float
    spread: float  # standard deviation of its logarithm among real bearings
    low: float  # lower bound of the estimate
    high: float  # upper bound of the estimate

    def around(self, value: float, off: float) -> Usual:
        """The same with bounds that are no farther away from a value."""
        low, high = max(self.low, value - off), min(self.high, value + off)
        return replace(self, low=min(low, value), high=max(high, value))

    def at(self, multiplier: float, weight: float) -> float:
        """The ratio where all of them give way together by `multiplier`; `weight` is its exponent in C."""
        moved = self.value * math.exp(multiplier * weight * self.spread**2)
        return min(max(moved, self.low), self.high)


PITCH: Final = Usual(1.0, 0.015, 0.97, 1.035)
"""Pitch diameter over (d + D)/2."""
SECTION: Final = Usual(0.50, 0.10, 0.40, 0.60)
"""Roller diameter over the height of the section (D - d)/2."""
LENGTH: Final = Usual(0.86, 0.05, 0.75, 0.94)
"""Effective length of a roller over the cup's width along the raceway; corners and edges of the cup take the rest."""
FILL: Final = Usual(0.85, 0.03, 0.80, 0.90)
"""Share of the pitch circle that rollers take, Z Dwe/(pi Dpw)."""
CUP_WIDTH: Final = Usual(0.78, 0.015, 0.75, 0.82)
"""Width of the cup over that of the bearing, as in ISO 355's dimension series."""
STEEP_CUP_WIDTH: Final = Usual(0.66, 0.02, 0.60, 0.72)
"""The same of bearings with a steep cup (e from 0.7, as the series 313), whose cone stands out further."""
STEEP_DEG: Final = (22.0, 25.0)
"""Half angles of the cup up to which it is as wide as usual, and from which it is as wide as that of steep bearings (deg)."""


@dataclass(frozen=True)
class Ratios:
    """What is usual of a kind of bearing: pitch diameter over (d + D)/2, roller diameter over (D - d)/2, effective length over
    the width along the raceway, share of the pitch circle that rollers take.
    """

    pitch: Usual
    section: Usual
    length: Usual
    fill: Usual


TAPERED: Final = Ratios(PITCH, SECTION, LENGTH, FILL)
CYLINDRICAL: Final = Ratios(
    pitch=Usual(1.010, 0.004, 0.995, 1.020),
    section=Usual(0.54, 0.06, 0.42, 0.62),
    length=Usual(0.60, 0.08, 0.33, 0.80),
    fill=Usual(0.81, 0.025, 0.60, 0.88),
)
"""The same of cylindrical bearings, whose length is over the width B: raceways F and E and ratings C and C0 of 28 of them; the
lower bounds of length and fill are those of older types and of the series 10 (docs/theory/estimates.md#cylindrical-bearings)."""
FILL_BAND: Final = 0.07
"""Band of that share of the pitch circle about the one that was found, within its bounds: what 28 bearings scatter by."""
NUMBER_SHARE: Final = 0.3
"""Share of an unusual number times length, as C0 tells it, that the number takes, in logarithms; the length takes the rest. An NU
1010 with 17 rollers has 0.38, an NU 205 with 13 has 0.2."""
NEAR: Final = 0.9
"""C of a catalogue over the smallest one that was found possible, down to which the smallest rollers are taken."""
MAKER: Final = Usual(1.0, 0.20, 0.80, 1.50)
"""C of a catalogue over that of ISO 281 with b_m = 1.1: steel, finish, and what makers have raised since. One and the same
bearing, a 32208, has 74.8 kN in one catalogue and 105 kN in another one."""
WALL: Final = 0.06
"""Least thickness of a ring where it is thinnest, over the height of the section."""

_IN_C: Final = {
    "diameter": 29.0 / 27.0 + 2.0 / 9.0 - 0.75,
    "diameter_of_counted": 29.0 / 27.0 + 2.0 / 9.0,
    "length": 7.0 / 9.0,
    "fill": 0.75,
}
"""Exponents with which roller diameter, length and fill raise C; where the rollers are not counted, thicker ones are fewer."""

_LARGEST: Final = 400.0
"""A multiplier at which everything is at its bound, see `solve`."""


@dataclass(frozen=True)
class Page:
    """The numbers of a catalogue page, checked (m, N, deg), and what is known of the rollers. An angle of zero: cylinders, whose
    static rating, where it is given, tells number times length of the rollers.
    """

    bore: float
    outside: float
    width: float
    angle: float
    cup_width: float | None
    n_rollers: int | None
    diameter: float | None
    length: float | None
    pitch: float | None
    maker_factor: float | None
    static: float | None = None

    @property
    def usual(self) -> Ratios:
        """What is usual of this kind of bearing."""
        return CYLINDRICAL if self.angle == 0.0 else TAPERED

    @property
    def height(self) -> float:
        """Height of the section."""
        return 0.5 * (self.outside - self.bore)

    @property
    def mean(self) -> float:
        return 0.5 * (self.outside + self.bore)

    @property
    def pitch_diameter(self) -> float:
        return self.usual.pitch.value * self.mean if self.pitch is None else self.pitch

    @property
    def cup_share(self) -> Usual:
        """Width of the cup over that of the bearing, by the angle."""
        if self.angle == 0.0:
            return Usual(1.0, 0.0, 1.0, 1.0)
        low, high = STEEP_DEG
        part = min(max((self.angle - low) / (high - low), 0.0), 1.0)
        ends = (
            (getattr(one, name) for one in (CUP_WIDTH, STEEP_CUP_WIDTH)) for name in ("value", "spread", "low", "high")
        )
        return Usual(*(usual + part * (steep - usual) for usual, steep in ends))

    def along(self, share: float | None = None) -> float:
        """Width of the cup along the raceway; `share` of the bearing's width where that of the cup is not known."""
        share = self.cup_share.value if share is None else share
        width = share * self.width if self.cup_width is None else self.cup_width
        return width / math.cos(math.radians(self.angle))

    def count(self, share: float, diameter: float) -> float:
        """Number of rollers that take a share of the pitch circle; not a whole number."""
        return share * math.pi * self.pitch_diameter / diameter

    @property
    def diameters(self) -> tuple[Usual, float]:
        """Roller diameter over the section's height, and its exponent in C; from the fill as well where rollers are counted."""
        section, fill = self.usual.section, self.usual.fill
        if self.n_rollers is None:
            return section, _IN_C["diameter"]
        one = math.pi * self.pitch_diameter / (self.n_rollers * self.height)
        first, second = section.spread**-2, fill.spread**-2
        total = first + second
        value = math.exp((first * math.log(section.value) + second * math.log(fill.value * one)) / total)
        low, high = max(section.low, fill.low * one), min(section.high, fill.high * one)
        if low > high:
            few = math.ceil(fill.low * one * self.n_rollers / section.high)
            many = math.floor(fill.high * one * self.n_rollers / section.low)
            circle, across = (f"{100 * one.low:g} to {100 * one.high:g} %" for one in (fill, section))
            limit = (
                f"must be from {few} to {many}: then rollers take {circle} of the pitch circle and {across} of the section's "
                "height; give roller_diameter as well if this bearing is different (1)"
            )
            raise InputError.of("n_rollers", self.n_rollers, limit)
        return Usual(min(max(value, low), high), total**-0.5, low, high), _IN_C["diameter_of_counted"]


def _ends(usual: Usual) -> tuple[float, float]:
    return usual.low, usual.high


@dataclass(frozen=True)
class Rollers:
    """Sizes that are looked for (m); the number of rollers need not be whole while they are."""

    count: float
    diameter: float
    length: float
    pitch: float
    angle: float

    @property
    def _sizes(self) -> dict[str, float]:
        return {
            "n_rollers": self.count,
            "roller_diameter": self.diameter,
            "roller_length": self.length,
            "pitch_diameter": self.pitch,
            "contact_angle_deg": self.angle,
        }

    @property
    def rating(self) -> float:
        return rating_iso281(**self._sizes)

    def with_static_rating(self, static: float) -> Rollers:
        """The same with the length that has this rating of ISO 76 (N)."""
        return replace(self, length=self.length * static / rating_iso76(**self._sizes))

    def shared(self, static: float, page: Page) -> Rollers:
        """The same with the number and the length that have this rating of ISO 76 (N), both unusual by `NUMBER_SHARE`."""
        usual = page.usual
        one = page.count(1.0, self.diameter)
        unusual = self.with_static_rating(static).length * self.count / (page.along() * usual.length.value * one)
        fill = usual.fill.value * (unusual / usual.fill.value) ** NUMBER_SHARE
        least, most = (
            self.count * self.with_static_rating(static).length / page.along(end) for end in _ends(usual.length)
        )
        count = min(max(fill * one, most), least)
        count = min(max(count, usual.fill.low * one), usual.fill.high * one)
        return replace(self, count=count).with_static_rating(static)

    def walls(self, page: Page) -> float:
        """Thickness of the thinner ring where it is thinnest (m): the cup at the large ends, the cone at the small ones.

        With Rc = Dwe/(2 tan nu) from the apex to the rollers' middle, a raceway of half angle a has at the station x the
        radius (Rc + x) sin(a)/cos(nu), a = alpha for the cup and alpha - 2 nu for the cone.
        """
        if self.angle == 0.0:
            return 0.5 * min(page.outside - self.pitch - self.diameter, self.pitch - self.diameter - page.bore)
        cup, nu = math.radians(self.angle), 0.0
        for _ in range(50):
            nu = math.atan2(self.diameter * math.sin(cup - nu), self.pitch)
        apex, half = 0.5 * self.diameter / math.tan(nu), 0.5 * self.length
        outer = (apex + half) * math.sin(cup) / math.cos(nu)
        inner = (apex - half) * math.sin(cup - 2.0 * nu) / math.cos(nu)
        return min(0.5 * page.outside - outer, inner - 0.5 * page.bore)


def solve(page: Page, C: float) -> tuple[Rollers, float]:
    """Rollers of a bearing with this C, and the maker's factor on C.

    One number says how far the bearing departs from the usual one (the multiplier of the least sum of squares of what is
    unusual, each in units of its spread, among all bearings with this C): diameter, length, fill and the maker's factor all
    give way by it, each by its spread squared times its exponent in C, within its bounds. Each of them and C rise with it, so
    the answer is continuous in C, but for the whole number of rollers: the maker's factor takes what rounding leaves.
    """
    usual, weight = page.diameters
    most = _LARGEST

    def sizes(multiplier: float) -> Rollers:
        shift = min(multiplier, most)
        diameter = page.height * usual.at(shift, weight) if page.diameter is None else page.diameter
        length = page.along() * page.usual.length.at(shift, _IN_C["length"]) if page.length is None else page.length
        count = (
            page.count(page.usual.fill.at(shift, _IN_C["fill"]), diameter) if page.n_rollers is None else page.n_rollers
        )
        return told(Rollers(count, diameter, length, page.pitch_diameter, page.angle))

    def told(rollers: Rollers, *, counted: bool = page.n_rollers is not None) -> Rollers:
        if page.static is None or page.length is not None:
            return rollers
        return rollers.with_static_rating(page.static) if counted else rollers.shared(page.static, page)

    def factor(multiplier: float) -> float:
        return MAKER.at(multiplier, 1.0) if page.maker_factor is None else page.maker_factor

    def above(multiplier: float) -> float:
        return math.log(factor(multiplier) * sizes(multiplier).rating / C)

    from scipy.optimize import brentq

    most = _largest_that_fits(page, sizes)
    lowest, highest = C * math.exp(above(-_LARGEST)), C * math.exp(above(_LARGEST))
    known = page.maker_factor is not None and None not in (page.n_rollers, page.diameter, page.length)
    if known and lowest * 0.97 <= C <= 1.03 * highest:
        return sizes(0.0), factor(0.0)
    if NEAR * lowest <= C < lowest and page.maker_factor is None:
        smallest = sizes(-_LARGEST)
        count = smallest.count if page.n_rollers is not None else max(3, math.floor(smallest.count + 0.5))
        smallest = told(replace(smallest, count=count), counted=True)
        return smallest, C / smallest.rating
    if not lowest <= C <= highest:
        raise _wrong_rating(page, C, lowest, highest)
    found = sizes(brentq(above, -_LARGEST, _LARGEST, xtol=1e-10))
    if page.n_rollers is None:
        ceiling = page.count(page.usual.fill.high, found.diameter)
        found = told(replace(found, count=max(3, math.floor(min(found.count + 0.5, ceiling + 1e-9)))), counted=True)
    if page.static is not None and page.length is None:
        _check_static(page, found)
    return found, C / found.rating


def _check_static(page: Page, found: Rollers) -> None:
    """The length that C0 tells lies within the width of the bearing."""
    low, high = (page.along(share) for share in (page.usual.length.low, page.usual.length.high))
    if low <= found.length <= high:
        return
    least, most = (float(page.static or 0.0) * length / found.length for length in (low, high))
    limit = (
        f"must be from {least:.3g} to {most:.3g} for rollers that fit these dimensions (N); give n_rollers, roller_diameter or "
        "roller_length if this bearing is different"
    )
    raise InputError.of("C0", page.static, limit)


def _largest_that_fits(page: Page, sizes: Callable[[float], Rollers]) -> float:
    """Largest multiplier at which the rings keep walls; sizes do not grow beyond it."""
    from scipy.optimize import brentq

    wall = WALL * page.height

    def room(multiplier: float) -> float:
        return sizes(multiplier).walls(page) - wall

    if room(_LARGEST) >= 0.0:
        return _LARGEST
    smallest = room(-_LARGEST)
    if smallest < 0.0:
        names = {"roller_diameter": page.diameter, "roller_length": page.length, "pitch_diameter": page.pitch}
        known = {name: value for name, value in names.items() if value is not None}
        key, value = next(iter(known.items())) if known else ("width", page.width)
        limit = (
            f"must leave room for the rings: of a section of {1e3 * page.height:.3g} mm at {page.angle:.3g} deg the thinner one "
            f"has {1e3 * (smallest + wall):.2g} mm where it is thinnest, at least {1e3 * wall:.2g} mm are needed (m)"
        )
        raise InputError.of(key, value, limit)
    return float(brentq(room, -_LARGEST, _LARGEST, xtol=1e-10))


def _wrong_rating(page: Page, C: float, lowest: float, highest: float) -> InputError:
    """What is wrong where no rollers that fit have this C: the unit of C, inches, or C itself."""
    inch = 0.0254
    if lowest * inch**1.9 <= C <= highest * inch**1.8 and page.bore * inch >= 2e-3:
        limit = (
            f"must be in m: with this C it looks like inches, and {page.bore:g} inches are {page.bore * inch:.4g} m; "
            f"if it is in m, C must be from {lowest:.3g} to {highest:.3g} (N)"
        )
        return InputError.of("bore", page.bore, limit)
    hint = ""
    if lowest <= 1e3 * C <= highest:
        hint = f": {C:g} kN are {1e3 * C:g}"
    elif page.maker_factor is not None:
        hint = " with this maker_factor"
    else:
        hint = "; give n_rollers, roller_diameter or roller_length if this bearing is different"
    limit = f"must be from {lowest:.3g} to {highest:.3g} for rollers that fit these dimensions (N){hint}"
    return InputError.of("C", C, limit)
