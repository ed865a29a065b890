"""The engineer's sheet of a scene: what every catalogue program answers first, each number with its symbol, unit and meaning.

Ratings and factors are those of the catalogue (`Bearing.ratings`); what it does not tell is computed by the standards from the
bearing's rollers, and said. Reference lives stand on the loads of laminas, of an equilibrium or of a run's records.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, fields, replace
from inspect import cleandoc
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.display import displayed, plain
from trbdyn.base.shown import Shown, Tabled
from trbdyn.errors import InputError
from trbdyn.model.ratings import rating_iso76, rating_iso281
from trbdyn.model.scene import Scene
from trbdyn.standards import iso281, lamina, ribs
from trbdyn.standards.loading import Loading, turning_against_load
from trbdyn.statics.plausible import PERMISSIBLE_PRESSURE

if TYPE_CHECKING:
    from trbdyn.statics.fit import Fit

Array = NDArray[np.float64]

ASSUMED_CLEANLINESS: Final = "17/14"
"""Cleanliness where none is given: oil without a filter in an ordinary gearbox."""
_NEIGHBOURS: Final = ("15/12", "19/16")


@dataclass(frozen=True)
class RatingRow:
    """A number of the sheet.

    Attributes
    ----------
    name : str
        Name of the attribute of `Rating`.
    words, symbol : str
        What it is.
    value : float or None
        Its value; None where it cannot be told, with the reason in the note.
    unit : str
        Its unit; empty for pure numbers.
    note : str
        Where it comes from, or what it means.
    longest : float
        Value beyond which no number is shown.
    """

    name: str
    words: str
    symbol: str
    value: float | None
    unit: str
    note: str
    longest: float = math.inf

    @property
    def shown(self) -> str:
        """The value as text, four digits; a life beyond a million hours as such."""
        if self.unit == "h":
            return life_text(self.value)
        if self.value is None or self.value <= self.longest:
            return "-" if self.value is None else displayed(self.value, self.unit)[0]
        return f">{plain(self.longest)}"

    @property
    def shown_unit(self) -> str:
        """The unit of `shown`: kN of 286000 N."""
        return self.unit if self.value is None else displayed(self.value, self.unit)[1]


RATED_AS_RADIAL: Final = 1e-3
"""Axial over radial load of a cylindrical bearing up to which nothing is said of it: a ring that leans makes as much."""


USUAL_OF_CYLINDERS: Final = ((0.2, 0.6), (0.3, 0.4))
"""e and Y that makers give for cylindrical bearings of the series 10, 2, 3 and 4, and of the wider ones."""
_CYLINDERS: Final = 0.12
"""Their product."""
METHOD: Final = f"ISO 16281:2025, Qc of ISO/TS 16281:2008, {lamina.LAMINAS} laminas"


def _number(words: str, symbol: str, unit: str = "") -> dict[str, str]:
    return {"words": words, "symbol": symbol, "unit": unit}


@dataclass(frozen=True, kw_only=True)
class Fitted(Tabled):
    """Ratings that show the fits by which the bearings sit, where they are known."""

    fits: Fit | None = None

    def __str__(self) -> str:
        text = super().__str__()
        return text if self.fits is None else f"{text}\n\n{self.fits}"

    @property
    def fit_tables(self) -> tuple[Shown, ...]:
        """The tables of `trbdyn.fit`."""
        if self.fits is None:
            return ()
        shown = self.fits._shown()
        return (*shown.parts, replace(shown, parts=()))


@dataclass(frozen=True)
class Rating(Fitted):
    """The sheet. Numbers that cannot be told are None; `notes` says why, and where the others come from.

    Attributes
    ----------
    warnings : tuple of str
        What an engineer must know: too small a load, speeds beyond the catalogue's, kappa out of range.
    notes : dict of str to str
        By name of a number, where it comes from or why there is none.
    fits : Fit or None
        How the bearing sits on its shaft and in its housing, where the rating is that of `trbdyn.fit`.
    """

    axial_load: float = field(metadata=_number("axial load", "Fa", "N"))
    radial_load: float = field(metadata=_number("radial load", "Fr", "N"))
    speed_rpm: float = field(metadata=_number("speed", "n", "rpm"))
    dynamic_rating: float = field(metadata=_number("basic dynamic load rating", "C", "N"))
    static_rating: float = field(metadata=_number("basic static load rating", "C0", "N"))
    fatigue_limit: float = field(metadata=_number("fatigue load limit", "Cu", "N"))
    e: float | None = field(metadata=_number("largest Fa/Fr at which P = Fr", "e"))
    Y: float | None = field(metadata=_number("axial factor of P", "Y"))
    Y0: float | None = field(metadata=_number("axial factor of P0", "Y0"))
    equivalent_load: float = field(metadata=_number("equivalent dynamic load", "P", "N"))
    axial_load_left_out: float | None = field(metadata=_number("axial load that no life counts", "Fa left out", "N"))
    permissible_axial_load: float | None = field(
        metadata=_number("axial load that ribs carry for long", "Fa perm", "N")
    )
    load_ratio: float | None = field(metadata=_number("rating over equivalent load", "C/P"))
    smallest_load: float = field(metadata=_number("smallest load, so that rollers roll", "Pmin", "N"))
    life: float | None = field(metadata=_number("basic rating life", "L10", "million revolutions"))
    life_hours: float | None = field(metadata=_number("basic rating life", "L10h", "h"))
    static_equivalent_load: float = field(metadata=_number("equivalent static load", "P0", "N"))
    static_safety: float | None = field(metadata=_number("static safety", "S0"))
    pressure_safety: float | None = field(
        metadata=_number("static safety by the largest pressure of a roller", "(4 GPa/p)^2")
    )
    viscosity: float = field(metadata=_number("viscosity of the oil", "nu", "mm2/s"))
    reference_viscosity: float | None = field(metadata=_number("viscosity that the bearing needs", "nu1", "mm2/s"))
    viscosity_ratio: float | None = field(metadata=_number("viscosity ratio", "kappa"))
    contamination_factor: float | None = field(metadata=_number("contamination factor", "e_C"))
    life_factor: float | None = field(metadata=_number("life modification factor", "a_ISO"))
    reliability_factor: float = field(metadata=_number("factor of reliability", "a1"))
    modified_life: float | None = field(metadata=_number("modified rating life", "Lnm", "million revolutions"))
    modified_life_hours: float | None = field(metadata=_number("modified rating life", "Lnmh", "h"))
    reference_life: float | None = field(metadata=_number("basic reference rating life", "L10r", "million revolutions"))
    reference_life_hours: float | None = field(metadata=_number("basic reference rating life", "L10rh", "h"))
    reference_load: float | None = field(metadata=_number("equivalent load of the reference life", "Pref", "N"))
    modified_reference_life: float | None = field(
        metadata=_number("modified reference rating life", "Lnmr", "million revolutions")
    )
    modified_reference_life_hours: float | None = field(
        metadata=_number("modified reference rating life", "Lnmrh", "h")
    )
    speed_over_reference: float | None = field(
        metadata=_number("speed over the catalogue's reference speed", "n/n_ref")
    )
    speed_over_limit: float | None = field(metadata=_number("speed over the catalogue's limiting speed", "n/n_lim"))
    speed_parameter: float = field(metadata=_number("speed times pitch diameter", "n Dpw", "mm/min"))
    warnings: tuple[str, ...]
    notes: dict[str, str]

    @property
    def rows(self) -> tuple[RatingRow, ...]:
        """Every number with words, symbol, unit and note."""
        turns = 60e-6 * LONGEST_LIFE * self.speed_rpm
        return tuple(
            RatingRow(
                name=one.name,
                value=getattr(self, one.name),
                note=self.notes.get(one.name, ""),
                longest=turns if one.metadata["unit"] == "million revolutions" and turns > 0.0 else math.inf,
                **one.metadata,
            )
            for one in NUMBERS
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionaries, lists, numbers and text, as JSON takes them."""
        fits = None if self.fits is None else self.fits.to_dict()
        return asdict(replace(self, fits=None)) | {"warnings": list(self.warnings), "fits": fits}

    def _shown(self) -> Shown:
        listed = [row for row in self.rows if row.value is not None or row.note]
        return Shown(
            title="ratings and lives",
            rows=tuple((f"{row.words} {row.symbol}", row.shown, row.shown_unit, row.note) for row in listed),
            head=("name", "value", "unit", "where it comes from"),
            notes=(*self.warnings, WHICH_LIFE),
            parts=self.fit_tables,
        )


NUMBERS: Final = tuple(one for one in fields(Rating) if one.metadata)
"""The numbers of a sheet in their order, with words, symbol and unit."""
_TEXTS = (
    f"{one.name} : {one.type}\n    {one.metadata['symbol']}, {one.metadata['words']} ({one.metadata['unit'] or 1}).\n"
    for one in NUMBERS
)
Rating.__doc__ = cleandoc(Rating.__doc__ or "").replace("-\n", f"-\n{''.join(_TEXTS)}", 1)

LONGEST_LIFE: Final = 1e6
"""Life (h) beyond which no number is shown: 114 years, and no standard was tested there."""
LIVES: Final = ("life_hours", "modified_life_hours", "reference_life_hours", "modified_reference_life_hours")
"""The lives of a sheet in hours."""
WHICH_LIFE: Final = (
    "Which life to use: Lnmrh where there is one: it counts how the load spreads along and between the rollers, the oil's film "
    "and its dirt; Lnmh to compare with a maker's modified life; L10h to compare catalogues; L10rh to see what misalignment, "
    "preload and play alone do to L10h."
)


def life_text(hours: float | None) -> str:
    """A life (h) as text, four digits that count, without an exponent."""
    if hours is None:
        return "-"
    return ">1e6" if hours > LONGEST_LIFE else f"{float(f'{hours:.4g}'):g}"


def _digits(value: float | None) -> str:
    return "-" if value is None else plain(value)


def sheet(scene: Scene, loading: Loading, **options: Any) -> Rating:
    """The sheet of a scene under a loading; see `trbdyn.rating`."""
    return rated(scene, loading, **options)[0]


def dynamic_rating(scene: Scene) -> float:
    """C of its bearing (N)."""
    return _factors(scene, {})[0]


def contact_ratings(scene: Scene) -> Array:
    """Q_ce and Q_ci of its bearing (N), see `lamina.contact_ratings`."""
    bearing = scene.bearing
    return lamina.contact_ratings(
        dynamic_rating(scene),
        n_rollers=bearing.n_rollers,
        roller_diameter=bearing.roller.diameter,
        pitch_diameter=bearing.pitch_diameter,
        angle=math.radians(bearing.cup_half_angle_deg),
    )


def rated(
    scene: Scene,
    loading: Loading,
    *,
    cleanliness: str | None = None,
    filtered: bool | None = None,
    contamination: float | None = None,
    reliability: float = 90.0,
) -> tuple[Rating, Array | None]:
    """The sheet, and the life factor of each lamina; None where there is none."""
    notes: dict[str, str] = {}
    if scene.outer_turns:
        notes["speed_rpm"] = "of the inner ring relative to the outer ring"
    said: list[str] = []
    bearing = scene.bearing
    pitch, angle = bearing.pitch_diameter, math.radians(bearing.cup_half_angle_deg)
    C, C0, Cu, e, Y, Y0 = _factors(scene, notes)
    axial, radial, speed = abs(loading.axial_load), loading.radial_load, abs(loading.speed_rpm)
    said += loading.said
    moments = [(axial, radial), *((abs(a), r) for a, r in loading.moments)]
    P = _equivalent_load(scene, axial, radial, e, Y) if loading.equivalent_load is None else loading.equivalent_load
    P0 = max(r if Y0 is None else iso281.static_equivalent_load(r, a, Y0=Y0) for a, r in moments)
    left_out, permissible = None, None
    if loading.equivalent_load is not None and loading.moments:
        notes["equivalent_load"] = "the steady load with the same life as the loads of the run"
    elif e is None or Y is None:
        notes["equivalent_load"] = "Fr (ISO 281, contact angle 0)"
    else:
        beyond = "0.92 Fr + Y Fa (makers)" if bearing.is_cylindrical else "0.4 Fr + Y Fa"
        notes["equivalent_load"] = "Fr" if iso281.within_e(radial, axial, e) else beyond
    if bearing.is_cylindrical and max(a for a, _ in moments) > RATED_AS_RADIAL * radial:
        heaviest = max(moments)
        if e is None or Y is None:
            left_out = axial
            said.append(_left_out(C, axial, radial, speed))
        if bearing.ribs.flanges in ("NJ", "NUP"):
            permissible = _permissible(scene, notes, C0, radial, speed)
            said += _of_ribs(heaviest, permissible, notes["permissible_axial_load"])
    if loading.moments:
        notes["static_equivalent_load"] = "heaviest moment of the run"
    smallest = iso281.SMALLEST_LOAD_SHARE * C
    notes["smallest_load"] = "0.02 C"
    if smallest > P:
        said.append(
            f"the equivalent load {P:.4g} N is below the smallest load {smallest:.4g} N (0.02 C): rollers may slide"
        )

    life = _finite(iso281.basic_life(C, P))
    laminas, reference = None, None
    notes["reference_life"] = loading.source
    if loading.lamina_loads is not None:
        laminas = lamina.LaminaLoads.of(
            loading.lamina_loads, contact_ratings(scene), turning=turning_against_load(scene)
        )
        reference = _finite(laminas.reference_life)
        notes["reference_life"] = f"{METHOD}, {loading.source}"
    reference_load = None if reference is None else C / reference ** (1.0 / iso281.LIFE_EXPONENT)

    viscosity = 1e6 * scene.lubricant.kinematic_viscosity
    nu1 = _finite(iso281.reference_viscosity(speed, pitch))
    kappa = None if nu1 is None else viscosity / nu1
    oil = _Oil.of(scene, cleanliness, filtered, contamination)
    factor, e_C = _life_factor(kappa, oil, Cu, P, pitch, notes, said)
    a1 = iso281.reliability_factor(reliability)
    notes["reliability_factor"] = f"reliability {reliability:g} %"
    modified_reference, factors = None, None
    if factor is not None and reference is not None and laminas is not None:
        parts = laminas.equivalent_loads(n_rollers=bearing.n_rollers, angle=angle)
        factors = np.array([_life_factor(kappa, oil, Cu, float(part), pitch, {}, [])[0] or 1.0 for part in parts])
        modified_reference = a1 * laminas.modified_life(factors.__getitem__)
    modified = _times(a1, factor, life)
    if modified is not None and oil.assumed:
        others = (_life_factor(kappa, replace(oil, cleanliness=code), Cu, P, pitch, {}, [])[0] for code in _NEIGHBOURS)
        lives = (_times(a1, other, life) for other in others)
        listed = zip(_NEIGHBOURS, lives, strict=True)
        notes["modified_life"] = ", ".join(f"{_digits(other)} with -/{code}" for code, other in listed)

    over: dict[str, Any] = {}
    fastest = speed if loading.largest_speed_rpm is None else loading.largest_speed_rpm
    for name, limit in (
        ("speed_over_reference", bearing.ratings.reference_speed_rpm),
        ("speed_over_limit", bearing.ratings.limiting_speed_rpm),
    ):
        over[name] = None if limit is None else fastest / limit
        if limit is not None and fastest > limit * (1.0 + iso281.ROUNDING):
            words = "reference" if name == "speed_over_reference" else "limiting"
            said.append(f"the speed of {fastest:g} rpm is above the catalogue's {words} speed of {limit:g} rpm")
    safety = PERMISSIBLE_PRESSURE / loading.largest_pressure if loading.largest_pressure > 0.0 else None
    if axial <= 0.0 and radial <= 0.0:
        notes["life"] = "no load"
    found = Rating(
        axial_load=axial,
        radial_load=radial,
        speed_rpm=speed,
        dynamic_rating=C,
        static_rating=C0,
        fatigue_limit=Cu,
        e=e,
        Y=Y,
        Y0=Y0,
        equivalent_load=P,
        axial_load_left_out=left_out,
        permissible_axial_load=permissible,
        load_ratio=C / P if P > 0.0 else None,
        smallest_load=smallest,
        life=life,
        life_hours=_hours(life, speed),
        static_equivalent_load=P0,
        static_safety=C0 / P0 if P0 > 0.0 else None,
        pressure_safety=None if safety is None else safety**2,
        viscosity=viscosity,
        reference_viscosity=nu1,
        viscosity_ratio=kappa,
        contamination_factor=e_C,
        life_factor=factor,
        reliability_factor=a1,
        modified_life=modified,
        modified_life_hours=_hours(modified, speed),
        reference_life=reference,
        reference_life_hours=_hours(reference, speed),
        reference_load=reference_load,
        modified_reference_life=modified_reference,
        modified_reference_life_hours=_hours(modified_reference, speed),
        speed_parameter=speed * 1e3 * pitch,
        warnings=tuple(said),
        notes=notes,
        **over,
    )
    return found, factors


def equivalent_loads(scene: Scene, axial: Array, radial: Array) -> Array:
    """P (N) of axial and radial loads (N), shape (T,)."""
    *_, e, Y, _ = _factors(scene, {})
    return np.array([_equivalent_load(scene, a, r, e, Y) for a, r in zip(axial.tolist(), radial.tolist(), strict=True)])


def _equivalent_load(scene: Scene, axial: float, radial: float, e: float | None, Y: float | None) -> float:
    if e is None or Y is None:
        return radial
    law = iso281.equivalent_load_of_cylinders if scene.bearing.is_cylindrical else iso281.equivalent_load
    return law(radial, abs(axial), e=e, Y=Y)


def _left_out(C: float, axial: float, radial: float, speed: float) -> str:
    """That no life counts an axial load, and what makers' usual factors would say."""
    lives = []
    for e, Y in USUAL_OF_CYLINDERS:
        load = iso281.equivalent_load_of_cylinders(radial, axial, e=e, Y=Y)
        lives.append(f"{life_text(_hours(iso281.basic_life(C, load), speed))} h with e = {e:g} and Y = {Y:g}")
    would = f"; L10h would be {lives[0]} (series 10, 2, 3, 4), {lives[1]} (wider series)" if speed else ""
    return (
        f"the axial load {axial:.4g} N acts on ribs, which ISO 281 does not rate: all lives leave it out; give the maker's e and "
        f"Y as ratings.e and ratings.Y{would}"
    )


def _permissible(scene: Scene, notes: dict[str, str], C0: float, radial: float, speed: float) -> float:
    bearing = scene.bearing
    pitch, thick = bearing.pitch_diameter, bearing.roller.diameter
    bore, outside = bearing.bore or pitch - 2.0 * thick, bearing.outside or pitch + 2.0 * thick
    given: dict[str, Any] = {"speed_rpm": speed, "radial_load": radial, "C0": C0, "bore": bore, "outside": outside}
    oil, grease = (ribs.permissible_axial_load(**given, width=bearing.width, grease=one) for one in (False, True))
    notes["permissible_axial_load"] = (
        f"law of SKF by heat and strength of the ribs, with oil; with grease {grease:.4g} N"
    )
    return oil


def _of_ribs(moment: tuple[float, float], permissible: float, law: str) -> list[str]:
    """What is wrong with an axial and a radial load (N) on ribs."""
    axial, radial = moment
    said = []
    if axial > permissible:
        said.append(f"the axial load {axial:.4g} N is above the {permissible:.4g} N that ribs carry for long ({law})")
    if axial > ribs.SHARE_OF_RADIAL * radial:
        times = axial / radial if radial else math.inf
        said.append(
            f"the axial load is {times:.3g} times the radial one: makers permit up to {ribs.SHARE_OF_RADIAL:g} times"
        )
    return said


def _factors(
    scene: Scene, notes: dict[str, str]
) -> tuple[float, float, float, float | None, float | None, float | None]:
    """C, C0, Cu, e, Y and Y0: of the catalogue, else by the standards from the rollers and the cup's angle; a cylindrical bearing
    has e and Y where its catalogue gives one of them, and no Y0.
    """
    bearing, known = scene.bearing, scene.bearing.ratings
    slope = math.tan(math.radians(bearing.cup_half_angle_deg))
    sizes: dict[str, Any] = {
        "n_rollers": bearing.n_rollers,
        "roller_diameter": bearing.roller.diameter,
        "roller_length": bearing.roller.effective_length,
        "pitch_diameter": bearing.pitch_diameter,
        "contact_angle_deg": bearing.cup_half_angle_deg,
    }
    C = known.dynamic or rating_iso281(**sizes)
    C0 = known.static or rating_iso76(**sizes)
    limit = known.fatigue_limit or iso281.fatigue_limit(C0, bearing.pitch_diameter)
    for name, value, how in (
        ("dynamic_rating", known.dynamic, "ISO 281 from the rollers, b_m = 1.1"),
        ("static_rating", known.static, "ISO 76 from the rollers"),
        ("fatigue_limit", known.fatigue_limit, "C0/8.2 (ISO 281, B.3.3)"),
    ):
        notes[name] = "catalogue" if value is not None else how
    if bearing.is_cylindrical:
        if known.e is None and known.Y is None:
            return C, C0, limit, None, None, None
        e, Y = known.e or _CYLINDERS / (known.Y or 1.0), known.Y or _CYLINDERS / (known.e or 1.0)
        for name, value in (("e", known.e), ("Y", known.Y)):
            notes[name] = "catalogue" if value is not None else "e Y = 0.12, as makers have it for cylindrical bearings"
        return C, C0, limit, e, Y, None
    # a catalogue that tells one of e and Y: the other one by e Y = 0.6
    e = known.e or (0.6 / known.Y if known.Y is not None else 1.5 * slope)
    Y = known.Y or (0.6 / known.e if known.e is not None else 0.4 / slope)
    for name, value, how in (
        ("e", known.e, "1.5 tan(alpha), or 0.6/Y"),
        ("Y", known.Y, "0.4 cot(alpha), or 0.6/e"),
        ("Y0", known.Y0, "0.55 Y, that is 0.22 cot(alpha)"),
    ):
        notes[name] = "catalogue" if value is not None else how
    return C, C0, limit, e, Y, known.Y0 or 0.55 * Y


@dataclass(frozen=True)
class _Oil:
    """How clean the oil is."""

    cleanliness: str
    filtered: bool
    factor: float | None
    assumed: bool

    @classmethod
    def of(cls, scene: Scene, cleanliness: str | None, filtered: bool | None, factor: float | None) -> _Oil:
        if factor is not None and not 0.0 <= factor <= 1.0:
            raise InputError.of("contamination", factor, "must be from 0 to 1 (1)")
        given = cleanliness or scene.lubricant.cleanliness
        clean = given or ASSUMED_CLEANLINESS
        filters = scene.lubricant.filtered if filtered is None else filtered
        iso281.contamination_factor(clean, filtered=filters, viscosity_ratio=1.0, pitch_diameter=0.1)
        return cls(clean, filters, factor, factor is None and given is None)


def _life_factor(
    kappa: float | None,
    oil: _Oil,
    limit: float,
    load: float | None,
    pitch: float,
    notes: dict[str, str],
    said: list[str],
) -> tuple[float | None, float | None]:
    """a_ISO and e_C."""
    if kappa is None or not load:
        notes["life_factor"] = "not known at standstill" if kappa is None else "no load"
        return None, None
    e_C = oil.factor
    if e_C is None:
        counted = min(kappa, iso281.MOST_VISCOSITY_RATIO)
        e_C = iso281.contamination_factor(
            oil.cleanliness, filtered=oil.filtered, viscosity_ratio=counted, pitch_diameter=pitch
        )
        how = "in-line filter" if oil.filtered else "without in-line filter"
        notes["contamination_factor"] = f"oil of -/{oil.cleanliness} (ISO 4406), {how}"
        notes["contamination_factor"] += ", assumed: give cleanliness" if oil.assumed else ""
    if kappa < iso281.LEAST_VISCOSITY_RATIO:
        text = f"kappa = {kappa:.3g} is below 0.1, where ISO 281 has no life factor: surfaces touch, expect wear"
        notes["life_factor"] = text
        said.append(text)
        return None, e_C
    return iso281.life_factor(kappa, e_C * limit / load), e_C


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _times(*factors: float | None) -> float | None:
    known = [factor for factor in factors if factor is not None]
    return math.prod(known) if len(known) == len(factors) else None


def _hours(life: float | None, speed: float) -> float | None:
    return None if life is None else _finite(iso281.hours(life, speed))
