"""`trbdyn.preload_over`: play, preload, torque, life and stiffness over temperature, where the preload is lost, and whether heat
and preload drive each other up (docs/theory/fits.md#preload-over-temperature).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError, TrbError
from trbdyn.extras.heat.heat_network import film_temperature
from trbdyn.extras.heat.paths import HeatPaths
from trbdyn.extras.heat.thermal import own_paths
from trbdyn.extras.heat.warm_balance import Balanced, NoBalance, WarmBalance
from trbdyn.extras.study.answer import Answer
from trbdyn.extras.study.definition import Base
from trbdyn.model.assembly import Assembly, Subject, assembly_of
from trbdyn.model.mounting import Mounting, Temperatures
from trbdyn.model.scene import Scene
from trbdyn.run.rating import rating
from trbdyn.run.simulation import Simulation
from trbdyn.standards.sheet import Rating, life_text
from trbdyn.statics.assembly import equilibrium, stiffness
from trbdyn.statics.fit import WAY, Fit, fit

Array = NDArray[np.float64]
Given = float | Temperatures | Mapping[str, Temperatures]

USUAL: Final = tuple(float(t) for t in range(-40, 151, 10))
"""Temperatures that are computed where none are given (C)."""
EDGE: Final = 0.5
"""How closely the temperature outside is found from which on there is no balance (K)."""


@dataclass(frozen=True)
class AtTemperature:
    """One row.

    Attributes
    ----------
    temperature_c : float
        The temperature that was given: of all parts, or outside; of parts with temperatures of their own the mean of the films
        (C).
    temperatures : dict of str to Temperatures
        Of each bearing by its name.
    fit : Fit
        Fits and plays at these temperatures.
    sheets : dict of str to Rating
        Loads and lives of each bearing; empty where nothing holds the shaft.
    life_hours, modified_reference_life_hours : float or None
        L10h and Lnmrh of all bearings together (h).
    torque : float or None
        Friction torque of all bearings by the losses of their contacts in ideal rolling (N m); without drag of the oil and
        friction of the cage.
    axial_stiffness, radial_stiffness : float or None
        Of the shaft (N/m), at its centre of mass.
    feedback : float or None
        Largest loss that one watt of loss makes in addition by warming its bearings (W/W); below 1 the balance is stable. Known
        with heat paths.
    said : str
        Why a number is missing.
    """

    temperature_c: float
    temperatures: dict[str, Temperatures]
    fit: Fit
    sheets: dict[str, Rating]
    life_hours: float | None = None
    modified_reference_life_hours: float | None = None
    torque: float | None = None
    axial_stiffness: float | None = None
    radial_stiffness: float | None = None
    feedback: float | None = None
    said: str = ""

    @property
    def plays(self) -> dict[str, float]:
        """Mean play of operation by its name (m): ``end play`` of all tapered bearings, and that of each cylindrical one."""
        return {name: play["operating"].mean for name, play in self.fit.plays.items()}


@dataclass(frozen=True, repr=False)
class PreloadOver(Answer):
    """Play, preload and what follows over temperature; print it for a table.

    Its picture shows play, preload, torque and life over the temperature.

    Attributes
    ----------
    rows : tuple of AtTemperature
        At each temperature, in the order given; with heat paths at each that has a balance.
    lost : dict of str to tuple of float
        By the name of a play, temperatures at which it becomes positive or negative in the mean (C): where the preload is lost,
        or comes.
    runs_away_c : float or None
        Temperature outside from which on heat and preload drive each other up (C), as one watt of loss makes one watt or more in
        addition; None where they do so at none of them, or at all.
    torque_rises : tuple of float
        Temperatures (C) at which the torque rises with the temperature, as more preload costs more than thinner oil saves: only
        there heat can drive itself up.
    outside : bool
        Whether temperatures are those outside, with heat paths, and not those of the parts.
    title : str
        What it is of.
    without : tuple of NoBalance
        With heat paths, each temperature outside that has no stable balance, with the reason.
    """

    rows: tuple[AtTemperature, ...]
    lost: dict[str, tuple[float, ...]]
    runs_away_c: float | None
    torque_rises: tuple[float, ...]
    outside: bool
    title: str
    without: tuple[NoBalance, ...] = ()

    def _draw(self) -> Any:
        from trbdyn.extras.heat.preload_picture import draw_preload_over

        return draw_preload_over(self)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What an engineer must know of it."""
        of = "temperature outside" if self.outside else "temperature"
        said = [
            f"{name or 'the radial clearance'} changes its sign at a {of} of {', '.join(f'{t:.4g}' for t in at)} C"
            for name, at in self.lost.items()
            if at
        ]
        if self.runs_away_c is not None:
            said.append(
                f"the preload runs away at {self.runs_away_c:.4g} C outside: heat makes preload, and preload heat"
            )
        if self.outside:
            worst = max(
                (row for row in self.rows if row.feedback is not None),
                key=lambda row: row.feedback or 0.0,
                default=None,
            )
            if worst is not None:
                where = f" at {', '.join(f'{row.temperature_c:.4g}' for row in self.rows)} C" if self.without else ""
                more = f"at worst a watt of loss makes {worst.feedback:+.2g} W more ({worst.temperature_c:.4g} C)"
                said.append(f"losses and cooling have a stable balance{where}; {more}")
        said += [f"no balance at {one.temperature_c:.4g} C outside, {one.why}: {one.said}" for one in self.without]
        if self.torque_rises:
            low, high = min(self.torque_rises), max(self.torque_rises)
            said.append(f"the torque rises with the temperature from {low:.4g} to {high:.4g} C")
        loose: dict[str, float] = {}
        for row in self.rows:
            for name, one in row.fit.items():
                for seat in one.seats:
                    if seat.mean > 0.0 >= seat.operating:
                        loose.setdefault(f"{name} {seat.name} {seat.tolerance}".strip(), row.temperature_c)
        seats = (f"{seat} has lost its interference at {t:.4g} C: the ring may creep" for seat, t in loose.items())
        return (*said, *seats)

    def _shown(self) -> Shown:
        first = self.rows[0]
        names = dict.fromkeys(name for row in self.rows for name in row.sheets) or first.temperatures

        def warm(ring: str) -> Callable[[AtTemperature], str]:
            return lambda row: _range(getattr(one, ring) for one in row.temperatures.values())

        def play(name: str) -> Callable[[AtTemperature], str]:
            return lambda row: f"{1e6 * row.plays[name]:.1f}"

        def load(name: str) -> Callable[[AtTemperature], str]:
            return lambda row: f"{row.sheets[name].axial_load:.4g}" if name in row.sheets else "-"

        columns: dict[str, Callable[[AtTemperature], str]] = {
            "outside C" if self.outside else "C": lambda row: f"{row.temperature_c:.4g}",
            "inner rings C": warm("inner_ring_c"),
            "outer rings C": warm("outer_ring_c"),
            **{f"{name or 'clearance'} um": play(name) for name in first.plays},
            **{f"{name} Fa N".strip(): load(name) for name in names},
            "torque N m": lambda row: _digits(row.torque),
            "L10h h": lambda row: life_text(row.life_hours),
            "Lnmrh h": lambda row: life_text(row.modified_reference_life_hours),
            "axial N/um": lambda row: _digits(None if row.axial_stiffness is None else 1e-6 * row.axial_stiffness),
            "feedback": lambda row: _digits(row.feedback),
        }
        for name in () if self.outside else ("inner rings C", "outer rings C", "feedback"):
            del columns[name]
        rows = tuple(tuple(cell(row) for cell in columns.values()) for row in self.rows)
        gaps = dict.fromkeys(f"{row.temperature_c:.4g} C: {row.said}" for row in self.rows if row.said)
        return Shown(f"Preload over temperature: {self.title}", rows, tuple(columns), (*self.warnings, *gaps, NOTE))


NOTE: Final = (
    "Negative play is preload. The torque is that of the contacts in ideal rolling, without drag of the oil and friction of the "
    "cage. Plays are means over the tolerances."
)


def preload_over(
    subject: Subject,
    mounting: Mounting | Mapping[str, Mounting],
    temperatures: Sequence[Given] = USUAL,
    *,
    paths: HeatPaths | Mapping[str, HeatPaths] | None = None,
    **oil: Any,
) -> PreloadOver:
    """End play or clearance, preload, torque, life and stiffness over temperature.

    Parameters
    ----------
    subject : Scene or Assembly
        A bearing, or bearings on a shaft; its end play and clearances are those at the mountings' reference temperature. Speed
        and loads are those at its start. The lubricant must be an oil that is known at other temperatures.
    mounting : Mounting, or mapping of str to Mounting
        How each bearing is mounted, by its name or one for all.
    temperatures : sequence of float, Temperatures, or mapping of str to Temperatures
        A number is one temperature of all parts (C), with `paths` that of everything outside: air, end of the shaft, oil that
        flows in. Else temperatures of the parts, of each bearing by its name or for all; `Temperatures.of_nodes` takes those of
        `trbdyn.thermal`.
    paths : HeatPaths, or mapping of str to HeatPaths, optional
        With them the parts' temperatures are those at which bearings give off the heat that they make. Where there are none, the
        reason is told: heat and preload drive each other up, parts become too hot, the play opens and nothing holds the shaft, or
        play or oil leave the range that can be computed.
    **oil
        Cleanliness and others of `trbdyn.rating`.

    Returns
    -------
    PreloadOver
        Prints as a table.

    Raises
    ------
    InputError
        If an argument cannot be used.
    TrbError
        If no temperature outside has a stable balance.

    Notes
    -----
    docs/theory/fits.md#preload-over-temperature. The way to the balance is not looked at: while a machine warms up, its shaft
    can be warmer than in the end.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> pair = trb.Assembly.pair(trb.cases.rig_30310(), "face to face", spread=0.08, end_play=-30e-6, shaft=shaft,
    ...                          speed_rpm=1500, lubricant="vg68")
    >>> seat = trb.Mounting(bore=0.050, outside=0.110, width=0.02925, shaft="m6", housing="N7",
    ...                     housing_material=trb.Material.aluminium())
    >>> found = trb.preload_over(pair, seat, [20.0, 80.0])
    >>> [round(1e6 * row.plays["end play"]) for row in found.rows]
    [-30, 96]
    """
    expect("subject", subject, Scene, Assembly)
    if not len(temperatures):
        raise InputError.of("temperatures", temperatures, "must be one temperature or more (C)")
    for prefix, part in subject.parts.items():
        if part.lubricant.oil is None:
            limit = "must be given: the temperature of the lubricant changes"
            raise InputError.of(f"{prefix}lubricant.oil", None, limit)
    warm = _Warm(subject, mounting, oil)
    if paths is None:
        rows = [warm.row(*warm.given(k, one)) for k, one in enumerate(temperatures)]
        return PreloadOver(tuple(rows), warm.lost(rows), None, _rising(rows), False, subject.title)
    ribs = [part.bearing.ribs for part in subject.parts.values()]
    balance = WarmBalance(subject.names, lambda own: warm.losses(warm.at(own)[1]), own_paths(subject, paths), ribs)
    outside = [number_of(f"temperatures[{k}]", one) for k, one in enumerate(temperatures)]
    found = _at_each(balance, outside)
    without = tuple(one for one in found if isinstance(one, NoBalance))
    rows = [
        warm.row(t, balance.temperatures(one.nodes), one.feedback)
        for t, one in zip(outside, found, strict=True)
        if isinstance(one, Balanced)
    ]
    if not rows:
        said = "; ".join(f"{one.temperature_c:g} C, {one.why}: {one.said}" for one in without)
        raise TrbError(f"losses and cooling have no stable balance at any of these temperatures outside: {said}")
    runs_away = _edge(balance, outside, found)
    return PreloadOver(tuple(rows), warm.lost(rows), runs_away, _rising(rows), True, subject.title, without)


def _at_each(balance: WarmBalance, outside: Sequence[float]) -> list[Balanced | NoBalance]:
    """The balance at each temperature outside: from that of the row before, from cold, and where both lead to none from that of
    the row behind.
    """
    found: list[Balanced | NoBalance] = []
    for temperature in outside:
        before = found[-1].power if found and isinstance(found[-1], Balanced) else None
        found.append(balance.find(temperature, before))
    for k in range(len(outside) - 2, -1, -1):
        behind = found[k + 1]
        if isinstance(found[k], NoBalance) and isinstance(behind, Balanced):
            again = balance.find(outside[k], behind.power)
            found[k] = again if isinstance(again, Balanced) else found[k]
    return found


def _edge(balance: WarmBalance, outside: Sequence[float], found: Sequence[Balanced | NoBalance]) -> float | None:
    """The temperature outside between one with a balance and one at which heat runs away (C); None where there are no such two
    beside each other, or what lies between them ends in another way.
    """
    for (good, one), (bad, other) in pairwise(zip(outside, found, strict=True)):
        if not isinstance(one, Balanced) or not isinstance(other, NoBalance) or other.why != "runs away":
            continue
        while abs(bad - good) > EDGE:
            middle = 0.5 * (good + bad)
            between = balance.find(middle, one.power)
            if isinstance(between, Balanced):
                good, one = middle, between
            else:
                bad, other = middle, between
        if other.why == "runs away":
            return 0.5 * (good + bad)
    return None


class _Warm:
    """A subject as its parts become warm."""

    def __init__(self, subject: Subject, mounting: Mounting | Mapping[str, Mounting], oil: Mapping[str, Any]) -> None:
        self.subject, self.mounting, self.oil = subject, mounting, oil
        self.base = Base.of(subject)

    def given(self, k: int, one: Given) -> tuple[float, dict[str, Temperatures]]:
        """Temperatures of each bearing, and the one that stands for them (C)."""
        names = self.subject.names
        if isinstance(one, Temperatures | Mapping):
            own = dict(one) if isinstance(one, Mapping) else dict.fromkeys(names, one)
            fit(self.subject, self.mounting, temperatures=own)
            return float(np.mean([_film(part) for part in own.values()])), own
        temperature = number_of(f"temperatures[{k}]", one)
        return temperature, dict.fromkeys(names, Temperatures.uniform(temperature))

    def at(self, own: Mapping[str, Temperatures]) -> tuple[Fit, Subject]:
        """Fits, and the subject with its plays of operation and its oils at their temperatures."""
        found = fit(self.subject, self.mounting, temperatures=own)
        oils = {
            f"{prefix}lubricant.temperature_c": _film(own[name])
            for name, prefix in zip(self.subject.names, self.subject.parts, strict=True)
        }
        return found, Base.of(found.subject).build(oils)[0]

    def losses(self, subject: Subject) -> list[dict[str, float]]:
        """Power by mechanism (W) of each bearing in ideal rolling."""
        record = Simulation(subject).record()
        parts = [record] if "" in subject.names else [record[name] for name in subject.names]
        return [
            {key[6:]: float(power) for key, power in one.items() if key.startswith("power_") and key != "power_loss"}
            for one in parts
        ]

    def row(self, temperature: float, own: dict[str, Temperatures], feedback: float | None = None) -> AtTemperature:
        """All numbers at temperatures."""
        try:
            found, warm = self.at(own)
        except InputError as error:
            found = fit(self.subject, self.mounting, temperatures=own)
            return AtTemperature(temperature, own, found, {}, said=str(error).splitlines()[0])
        try:
            shaft = assembly_of(warm)
            stands: Any = warm if shaft is None else equilibrium(shaft)
            sheet: Any = rating(stands, **self.oil)
            matrix = stiffness(warm).matrix if shaft is None else stands.at_mass.matrix
            losses = self.losses(warm)
        except TrbError as error:
            return AtTemperature(temperature, own, found, {}, said=str(error).splitlines()[0])
        speed = abs(float(sheet_speed(sheet))) * np.pi / 30.0
        return AtTemperature(
            temperature,
            own,
            found,
            {"": sheet} if isinstance(sheet, Rating) else sheet.bearings,
            sheet.life_hours,
            sheet.modified_reference_life_hours,
            sum(sum(one.values()) for one in losses) / speed if speed > 0.0 else None,
            float(matrix[2, 2]),
            float(np.mean([matrix[0, 0], matrix[1, 1]])),
            feedback,
        )

    def lost(self, rows: Sequence[AtTemperature]) -> dict[str, tuple[float, ...]]:
        """Temperatures at which plays change their sign, between each two rows (C)."""
        crossings: dict[str, list[float]] = {name: [] for name in rows[0].plays if name != WAY}
        for before, after in pairwise(rows):
            for name, found in crossings.items():
                one, other = before.plays[name], after.plays[name]
                if one * other < 0.0:
                    share = brentq(self._play(name, before, after), 0.0, 1.0, xtol=1e-4)
                    found.append(before.temperature_c + share * (after.temperature_c - before.temperature_c))
        return {name: tuple(found) for name, found in crossings.items()}

    def _play(self, name: str, before: AtTemperature, after: AtTemperature) -> Callable[[float], float]:
        def play(share: float) -> float:
            own = {
                key: _between(before.temperatures[key], after.temperatures[key], share) for key in before.temperatures
            }
            return fit(self.subject, self.mounting, temperatures=own).plays[name]["operating"].mean

        return play


def _film(one: Temperatures) -> float:
    nodes = {"outer_ring": one.outer_ring_c, "inner_ring": one.inner_ring_c, "rollers": one.rollers_c}
    return film_temperature(nodes)


def _between(one: Temperatures, other: Temperatures, share: float) -> Temperatures:
    values = {
        name: (1.0 - share) * getattr(one, name) + share * getattr(other, name) for name in Temperatures.model_fields
    }
    return Temperatures(**values)


def _rising(rows: Sequence[AtTemperature]) -> tuple[float, ...]:
    """Temperatures at the ends of steps in which the torque rises with the temperature (C)."""
    known = sorted((row.temperature_c, row.torque) for row in rows if row.torque is not None)
    return tuple(dict.fromkeys(t for low, high in pairwise(known) if high[1] > low[1] for t in (low[0], high[0])))


def sheet_speed(sheet: Any) -> float:
    """The speed of a sheet, or of all sheets of a shaft (rpm)."""
    return sheet.speed_rpm if isinstance(sheet, Rating) else next(iter(sheet.bearings.values())).speed_rpm


def _range(values: Any) -> str:
    found = [f"{value:.0f}" for value in values]
    return " ".join(dict.fromkeys(found))


def _digits(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"
