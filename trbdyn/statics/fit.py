"""`trbdyn.fit`: interference of the seats, growth of rings by it and by temperature, the end play or clearance that is left
(docs/theory/fits.md).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri
from scipy.stats import norm, qmc

from trbdyn.base.expected import expect
from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly, ShaftBearing, Subject, assembly_of
from trbdyn.model.bearing import Bearing, check_boundary
from trbdyn.model.growth import apex_slide, material_strain, part_strain
from trbdyn.model.mounting import Mounting, Temperatures
from trbdyn.model.scene import Scene
from trbdyn.model.tolerances import Limits, bore_limits, outside_limits, standard_of
from trbdyn.statics.press_fit import PressFit

Array = NDArray[np.float64]

SIGMAS: Final = 6.0
"""Standard deviations that a tolerance is wide, with its middle as the mean and a normal distribution: assumed, a process that
makes one part in 370 outside of its limits."""
DRAWS: Final = 4096
"""Draws of all diameters; each costs some multiplications."""
END_PLAY: Final = "end play"
WAY: Final = "way of the spring"
"""Names of the play of all tapered bearings of a shaft together: where a spring presses an outer ring, this ring takes up the
play by sliding, back where the play is negative."""
BAND: Final = (0.005, 0.995)
"""Quantiles that a band lies between."""


@dataclass(frozen=True)
class SeatFit:
    """The fit of a ring on its seat.

    Attributes
    ----------
    name : str
        'shaft' or 'housing'.
    tolerance : str
        Its tolerance class, or its deviations in um.
    least, mean, most : float
        Interference on the diameter before mounting, at the reference temperature (m); negative: clearance.
    probability : float
        Share of mounted parts that have an interference at the temperatures of operation (1).
    operating : float
        Mean interference at the temperatures of operation, after smoothing (m).
    pressure, hoop_stress : float
        On the seat, and the largest tensile stress of the outer part, at this mean (Pa).
    raceway : float
        By how much the raceway's diameter changes by this mean (m): the inner ring's grows, the outer ring's shrinks.
    """

    name: str
    tolerance: str
    least: float
    mean: float
    most: float
    probability: float
    operating: float
    pressure: float
    hoop_stress: float
    raceway: float


@dataclass(frozen=True)
class Play:
    """A play over the tolerances (m): its mean and the band that holds 99 % of the parts.

    Attributes
    ----------
    mean, low, high : float
        Play (m); negative: preload.
    preloaded : float
        Share of the parts whose play is below 0 (1).
    """

    mean: float
    low: float
    high: float
    preloaded: float

    @classmethod
    def of(cls, draws: Array) -> Play:
        """From the plays of all draws (m)."""
        low, high = np.quantile(draws, BAND)
        return cls(float(draws.mean()), float(low), float(high), float(np.mean(draws < 0.0)))


@dataclass(frozen=True)
class BearingFit:
    """Fits of one bearing.

    Attributes
    ----------
    name : str
        Name of the bearing on its shaft.
    seats : tuple of SeatFit
        That on the shaft and that in the housing.
    parts : dict of str to float
        What changes the play where all diameters lie in the middle of their tolerances (m): ``shaft_fit`` and ``housing_fit``,
        ``rings`` by their temperatures, and on a shaft ``span`` and ``faces``, the lengths between the bearings and those of
        their rings. Axial play of a tapered bearing, radial (diametral) clearance of a cylindrical one.
    mounting : Mounting
        How it is mounted.
    temperatures : Temperatures
        Of operation.
    tolerances : str
        Standard and class of the bearing's diameters, and what chose them.
    """

    name: str
    seats: tuple[SeatFit, SeatFit]
    parts: dict[str, float]
    mounting: Mounting
    temperatures: Temperatures
    tolerances: str


class Fit(Mapping[str, BearingFit], Displayed):
    """Fits of one bearing, or of all on a shaft; print it for a table.

    Attributes
    ----------
    subject : Bearing, Scene or Assembly
        With its play of operation in the mean: `Bearing.radial_clearance` of a cylindrical bearing, `ShaftBearing.end_play` of
        tapered ones; where a spring presses one, its force at the place where rings and rollers touch in operation.
    plays : dict of str to dict of str to Play
        ``mounted`` and ``operating`` play: of each cylindrical bearing by its name, of all tapered ones together as
        ``end play``, or ``way of the spring`` where a spring takes it up. One tapered bearing alone has none.
    """

    def __init__(self, bearings: Mapping[str, BearingFit], plays: Mapping[str, dict[str, Play]], subject: Any) -> None:
        self._bearings, self.plays, self.subject = dict(bearings), dict(plays), subject

    def __getitem__(self, name: str) -> BearingFit:
        return self._bearings[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._bearings)

    def __len__(self) -> int:
        return len(self._bearings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Seats that lose their interference by temperature: the ring may turn in its seat."""
        return tuple(
            f"{name} {seat.name}".strip()
            + f": {seat.tolerance} interferes by {_um(seat.mean)} um when mounted and by {_um(seat.operating)} um in operation: "
            "the ring may creep on its seat"
            for name, one in self._bearings.items()
            for seat in one.seats
            if seat.mean > 0.0 >= seat.operating
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionaries, lists, numbers and text, as JSON takes them."""
        return {
            "bearings": {
                name: {
                    "seats": [asdict(seat) for seat in one.seats],
                    "parts": dict(one.parts),
                    "tolerances": one.tolerances,
                }
                for name, one in self._bearings.items()
            },
            "plays": {name: {when: asdict(play) for when, play in plays.items()} for name, plays in self.plays.items()},
        }

    def __str__(self) -> str:
        shown = self._shown()
        return "\n\n".join(one.text(names=True) for one in (*shown.parts, shown))

    __repr__ = __str__

    def _shown(self) -> Shown:
        rows = []
        for name, plays in self.plays.items():
            for when, play in plays.items():
                band = f"{_um(play.low)} to {_um(play.high)}"
                rows.append((f"{name or 'radial clearance'}, {when}", _um(play.mean), band, _share(play.preloaded)))
        seats = []
        for name, one in self._bearings.items():
            for seat in one.seats:
                where = f"{name} {seat.name}".strip()
                seats.append(
                    (
                        f"{where} {seat.tolerance}",
                        f"{_um(seat.least)} to {_um(seat.most)}",
                        _share(seat.probability),
                        _um(seat.operating),
                        f"{1e-6 * seat.pressure:.3g}",
                        _um(seat.raceway),
                    )
                )
        changes = [
            (f"{name} {part.replace('_', ' ')}".strip(), _um(value))
            for name, one in self._bearings.items()
            if name not in self._unchanged
            for part, value in one.parts.items()
        ]
        head = ("seat", "interference um", "interferes", "operating um", "pressure MPa", "raceway um")
        return Shown(
            "End play and clearance, negative: preload",
            tuple(rows),
            ("play", "mean um", "99 % of the parts um", "preloaded"),
            (*self.warnings, *self._standards(), *self._why_unchanged(), NOTE),
            (
                Shown("Fits of the seats", tuple(seats), head),
                *([Shown("What changes the play", tuple(changes), ("part", "um"))] if changes else []),
            ),
        )

    @property
    def _mounted(self) -> list[str]:
        """Tapered bearings whose end play was set when they were mounted."""
        return [
            name for name, one in self._bearings.items() if one.mounting.set == "mounted" and name not in self.plays
        ]

    @property
    def _unchanged(self) -> list[str]:
        """Those of them whose end play nothing changes."""
        return [name for name in self._mounted if not any(self._bearings[name].parts.values())]

    def _standards(self) -> list[str]:
        """Whose tolerances the bearings have, those that share them together."""
        said: dict[str, list[str]] = {}
        for name, one in self._bearings.items():
            said.setdefault(one.tolerances, []).append(name)
        return [
            f"{', '.join(names)}: ".lstrip(": ") + f"bore and outside diameter have the tolerances of {text}."
            for text, names in said.items()
        ]

    def _why_unchanged(self) -> list[str]:
        if not self._mounted:
            return []
        still, names = self._unchanged, [name for name in self._mounted if name]
        said = f"{', '.join(names)}: " if names else ""
        said += "the end play was set with mounted bearings, set = 'mounted', and has the fits in it: only temperatures change it"
        if still:
            of = "" if still == self._mounted else f" of {', '.join(still)}"
            said += f"; at these temperatures the parts{of} grow not at all or alike, so nothing does"
        return [f"{said}. Sets that are matched before mounting have set = 'before mounting'."]


NOTE: Final = (
    "Assumed: each diameter is normal with its mean in the middle of its tolerance, which is six standard deviations wide; "
    "rings are cylinders up to the middle of their raceway; the faces of a bearing lie half of its width from the middle of "
    "its rollers."
)


def fit(
    subject: Bearing | Subject,
    mounting: Mounting | Mapping[str, Mounting],
    *,
    temperatures: Temperatures | Mapping[str, Temperatures] | None = None,
    seed: int = 0,
) -> Fit:
    """Interference of shaft and housing, what it makes of the rings, and the play that is left, with its band over the
    tolerances.

    Parameters
    ----------
    subject : Bearing, Scene or Assembly
        The bearing, or all on a shaft.
    mounting : Mounting, or mapping of str to Mounting
        Dimensions and tolerances; those of each bearing on a shaft by its name, or one for all.
    temperatures : Temperatures, or mapping of str to Temperatures, optional
        Of operation, of each bearing by its name or one for all; the reference temperature by default.
    seed : int
        Seed of the draws of diameters.

    Returns
    -------
    Fit
        Prints as a table. `Fit.subject` has the play of operation in the mean, for everything else that takes a subject.

    Raises
    ------
    InputError
        If a number is not allowed, or a material lacks its thermal expansion.

    Notes
    -----
    docs/theory/fits.md. Left out: what rotation and load take of an interference, the bending of conical rings.

    Examples
    --------
    >>> import trbdyn as trb
    >>> seat = trb.Mounting(bore=0.050, outside=0.090, width=0.020, shaft="k5", housing="H7", clearance="C3")
    >>> found = trb.fit(trb.cases.bearing_nj210(), seat)
    >>> round(1e6 * found.plays[""]["mounted"].mean, 1), round(found[""].seats[0].probability, 4)
    (54.1, 1.0)
    """
    expect("subject", subject, Bearing, Scene, Assembly)
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise InputError.of("seed", seed, "must be a whole number, at least 0")
    bearings = {"": subject} if isinstance(subject, Bearing) else _bearings(subject)
    mountings = _by_name("mounting", mounting, Mounting, bearings)
    if temperatures is None:
        warm = {name: Temperatures.uniform(one.reference_c) for name, one in mountings.items()}
    else:
        warm = _by_name("temperatures", temperatures, Temperatures, bearings)
    places = _places(subject)
    shares = ndtri(qmc.Sobol(5 * len(bearings), seed=int(seed)).random(DRAWS))
    shares = np.clip(shares, -SIGMAS, SIGMAS)
    found: dict[str, BearingFit] = {}
    mounted: dict[str, Array] = {}
    operating: dict[str, Array] = {}
    means: dict[str, float] = {}
    for k, (name, bearing) in enumerate(bearings.items()):
        path = ("mounting", name) if isinstance(mounting, Mapping) else ("mounting",)
        one = _Mounted(bearing, mountings[name], warm[name], places.get(name), path)
        draws = one.draws(shares[:, 5 * k : 5 * k + 5])
        middle = one.draws(np.zeros((1, 5)))
        found[name] = BearingFit(
            name, one.seats(middle), one.changes(middle), mountings[name], warm[name], one.tolerances
        )
        mounted[name], operating[name] = one.plays(draws)
        means[name] = float(operating[name].mean())
    groups = {name: [name] for name, bearing in bearings.items() if bearing.is_cylindrical}
    if places:
        sprung = any(one.spring is not None for one, _ in places.values())
        groups[WAY if sprung else END_PLAY] = [name for name in bearings if name not in groups]
    plays = {
        title: {
            "mounted": Play.of(np.sum([mounted[name] for name in names], axis=0)),
            "operating": Play.of(np.sum([operating[name] for name in names], axis=0)),
        }
        for title, names in groups.items()
        if names
    }
    return Fit(found, plays, _in_operation(subject, means))


@dataclass(frozen=True)
class _Drawn:
    """Interference of both seats (m) and radial clearance before mounting (m), of each draw."""

    shaft: Array
    housing: Array
    clearance: Array


class _Mounted:
    """A bearing as it is mounted: its seats, strains of its parts and what they make of its play."""

    def __init__(
        self,
        bearing: Bearing,
        mounting: Mounting,
        warm: Temperatures,
        place: tuple[ShaftBearing, float] | None,
        path: tuple[str, ...] = ("mounting",),
    ) -> None:
        self.bearing, self.mounting, self.place = bearing, mounting, place
        geometry, reference = bearing.geometry, mounting.reference_c
        sizes = {"bore": mounting.bore, "outside": mounting.outside, "width": mounting.width}
        check_boundary(bearing, **sizes, path=path)
        inner, outer = 2.0 * geometry.inner_race_radius, 2.0 * geometry.outer_race_radius
        steel = bearing.material
        self.on_shaft = PressFit(mounting.shaft_bore, mounting.bore, inner, mounting.shaft_material, steel)
        self.in_housing = PressFit(outer, mounting.outside, mounting.outer_housing, steel, mounting.housing_material)
        self.strain = {
            "shaft": material_strain(("mounting", "shaft_material"), mounting.shaft_material, warm.shaft_c - reference),
            "inner_ring": part_strain(bearing, "", warm.inner_ring_c - reference),
            "rollers": part_strain(bearing, "roller", warm.rollers_c - reference),
            "outer_ring": part_strain(bearing, "", warm.outer_ring_c - reference),
            "housing": material_strain(
                ("mounting", "housing_material"), mounting.housing_material, warm.housing_c - reference
            ),
        }
        tapered, accuracy = not bearing.is_cylindrical, mounting.accuracy
        series, why = mounting.series_for(bearing.name) if tapered else ("metric", "")
        if not tapered and mounting.series == "inch":
            limit = "must be 'metric' for cylindrical bearings: ISO 578 has tapered ones alone"
            raise InputError.of((*path, "series"), mounting.series, limit)
        self.tolerances = standard_of(tapered=tapered, accuracy=accuracy, series=series)
        self.tolerances += f" ({series} series, {why if why == 'as given' else f'by {why}'})" if why else ""
        self.limits: tuple[Limits, ...] = (
            mounting.shaft_limits,
            bore_limits(mounting.bore, tapered=tapered, accuracy=accuracy, series=series),
            outside_limits(mounting.outside, tapered=tapered, accuracy=accuracy, series=series),
            mounting.housing_limits,
            mounting.clearance_limits if bearing.is_cylindrical else (0.0, 0.0),
        )

    def draws(self, shares: Array) -> _Drawn:
        """Of standard normal numbers, shape (n, 5)."""
        shaft, bore, outside, housing, clearance = (
            0.5 * (low + high) + (high - low) / SIGMAS * share
            for (low, high), share in zip(self.limits, shares.T, strict=True)
        )
        return _Drawn(shaft - bore, outside - housing, clearance)

    def warm(self, drawn: _Drawn) -> _Drawn:
        """Interferences at the temperatures of operation."""
        strain, mounting = self.strain, self.mounting
        return _Drawn(
            drawn.shaft + mounting.bore * (strain["shaft"] - strain["inner_ring"]),
            drawn.housing + mounting.outside * (strain["outer_ring"] - strain["housing"]),
            drawn.clearance,
        )

    def raceways(self, drawn: _Drawn) -> tuple[Array, Array]:
        """Growth of the inner and shrinkage of the outer raceway's diameter by the fits (m)."""
        shaft, housing = self.left(drawn.shaft, self.mounting.bore), self.left(drawn.housing, self.mounting.outside)
        return self.on_shaft.outside_growth(shaft), self.in_housing.bore_shrinkage(housing)

    def left(self, interference: Array, seat: float) -> Array:
        """Interference that smoothing leaves (m)."""
        share = seat / (seat + self.mounting.smoothing)
        return np.where(interference > 0.0, share * interference, interference)

    @property
    def axial(self) -> float:
        """Play by the change of a raceway's diameter: 1, or half the cotangent of the cup's angle for axial play."""
        if self.bearing.is_cylindrical:
            return 1.0
        return 0.5 / math.tan(math.radians(self.bearing.cup_half_angle_deg))

    def thermal(self) -> dict[str, float]:
        """Change of the play by temperatures alone (m)."""
        strain, geometry = self.strain, self.bearing.geometry
        if self.bearing.is_cylindrical:
            radii = (
                strain["outer_ring"] * geometry.outer_race_radius - strain["inner_ring"] * geometry.inner_race_radius
            )
            return {"rings": 2.0 * (radii - strain["rollers"] * self.bearing.roller.diameter)}
        cup, cone = math.radians(self.bearing.cup_half_angle_deg), geometry.cone_half_angle
        slide = apex_slide(self.bearing, strain["inner_ring"] - strain["rollers"])
        rings = (strain["outer_ring"] - strain["inner_ring"]) * geometry.centre_plane
        found = {"rings": rings + slide * math.sin(cup - cone) / math.sin(cup)}
        if self.place is None:
            return found
        one, middle = self.place
        half, along = 0.5 * self.mounting.width, one.side * (one.centre_plane - middle)
        found["span"] = along * (strain["housing"] - strain["shaft"])
        found["faces"] = half * (strain["housing"] + strain["shaft"] - strain["outer_ring"] - strain["inner_ring"])
        return found

    def plays(self, drawn: _Drawn) -> tuple[Array, Array]:
        """Mounted and operating play of each draw (m)."""
        cold, hot = (sum(self.raceways(one)) for one in (drawn, self.warm(drawn)))
        before = drawn.clearance
        if self.place is not None and not self.bearing.is_cylindrical:
            before = before + self.place[0].end_play
        fits = 0.0 if self._set_mounted else self.axial * cold
        change = self.axial * (hot - cold) - sum(self.thermal().values())
        return before - fits, before - fits - change

    @property
    def _set_mounted(self) -> bool:
        return self.mounting.set == "mounted" and not self.bearing.is_cylindrical

    def changes(self, middle: _Drawn) -> dict[str, float]:
        """What changes the play in the mean (m), from what was given to operation."""
        cold, hot = self.raceways(middle), self.raceways(self.warm(middle))
        base = (cold[0][0], cold[1][0]) if self._set_mounted else (0.0, 0.0)
        return {
            "shaft_fit": -self.axial * float(hot[0][0] - base[0]),
            "housing_fit": -self.axial * float(hot[1][0] - base[1]),
            **self.thermal(),
        }

    def seats(self, middle: _Drawn) -> tuple[SeatFit, SeatFit]:
        """Both seats in the mean."""
        mounting, warm = self.mounting, self.warm(middle)
        shaft, bore, outside, housing, _ = self.limits
        made = []
        for name, code, inside, around, mean, hot, seat, press, raceway in (
            ("shaft", mounting.shaft, shaft, bore, middle.shaft, warm.shaft, mounting.bore, self.on_shaft, 0),
            (
                "housing",
                mounting.housing,
                outside,
                housing,
                middle.housing,
                warm.housing,
                mounting.outside,
                self.in_housing,
                1,
            ),
        ):
            spread = math.hypot(inside[1] - inside[0], around[1] - around[0]) / SIGMAS
            operating, at = float(hot[0]), self.left(hot, seat)
            made.append(
                SeatFit(
                    name=name,
                    tolerance=code if isinstance(code, str) else f"{_um(code[0])} to {_um(code[1])} um",
                    least=inside[0] - around[1],
                    mean=float(mean[0]),
                    most=inside[1] - around[0],
                    probability=float(norm.cdf(operating / spread)) if spread > 0.0 else float(operating > 0.0),
                    operating=float(at[0]),
                    pressure=float(press.pressure(at)[0]),
                    hoop_stress=float(press.hoop_stress(at)[0]),
                    raceway=float(self.raceways(warm)[raceway][0]),
                )
            )
        return made[0], made[1]


def _bearings(subject: Subject) -> dict[str, Bearing]:
    parts: list[Any] = [*subject.parts.values()]
    return {name: part.bearing for name, part in zip(subject.names, parts, strict=True)}


def _places(subject: Bearing | Subject) -> dict[str, tuple[ShaftBearing, float]]:
    """Each bearing of a shaft with the position from which lengths grow: the middle between the bearings."""
    shaft = assembly_of(subject)
    if shaft is None:
        return {}
    planes = [one.centre_plane for one in shaft.bearings]
    middle = 0.5 * (min(planes) + max(planes))
    return {name: (one, middle) for name, one in zip(shaft.names, shaft.bearings, strict=True)}


def _by_name(field: str, given: Any, kind: type, bearings: Mapping[str, Bearing]) -> dict[str, Any]:
    """One for each bearing, by its name."""
    if not isinstance(given, Mapping):
        expect(field, given, kind)
        return dict.fromkeys(bearings, given)
    if set(given) != set(bearings):
        limit = f"must be those of {', '.join(bearings)}" if any(bearings) else f"must be a {kind.__name__}"
        raise InputError.of(field, sorted(given), limit)
    for name, one in given.items():
        expect(f"{field}.{name}", one, kind)
    return {name: given[name] for name in bearings}


def _in_operation(subject: Bearing | Subject, means: Mapping[str, float]) -> Any:
    """The subject with the mean play of operation."""
    if isinstance(subject, Bearing):
        return subject.replace(radial_clearance=means[""]) if subject.is_cylindrical else subject
    parts: dict[str, Any] = dict(subject.parts)
    for (prefix, part), play in zip(parts.items(), means.values(), strict=True):
        if part.bearing.is_cylindrical:
            subject = subject.with_part(prefix, bearing=part.bearing.replace(radial_clearance=play))
        elif isinstance(part, ShaftBearing) and part.spring is None:
            subject = subject.with_part(prefix, end_play=play)
        elif isinstance(part, ShaftBearing) and part.spring is not None:
            spring = part.spring  # less play pushes the ring back, which compresses the spring
            subject = subject.with_part(prefix, spring=spring.replace(force=spring.force - spring.stiffness * play))
    return subject


def _um(value: float) -> str:
    return f"{round(1e6 * value, 1) + 0.0:.1f}"


def _share(value: float) -> str:
    return "< 0.01 %" if 0.0 < value < 1e-4 else "> 99.99 %" if 1.0 - 1e-4 < value < 1.0 else f"{100.0 * value:.4g} %"
