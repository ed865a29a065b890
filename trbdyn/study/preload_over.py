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
from trbdyn.model.assembly import Assembly, Subject, assembly_of
from trbdyn.model.heat import HeatPaths
from trbdyn.model.mounting import Mounting, Temperatures
from trbdyn.model.scene import Scene
from trbdyn.run.rating import rating
from trbdyn.run.simulation import Simulation
from trbdyn.standards.sheet import Rating, life_text
from trbdyn.statics.assembly import equilibrium, stiffness
from trbdyn.statics.fit import WAY, Fit, fit
from trbdyn.study.answer import Answer
from trbdyn.study.definition import Base
from trbdyn.study.heat_network import film_temperature, heat_of, network
from trbdyn.study.thermal import HOTTEST, own_paths

Array = NDArray[np.float64]
Given = float | Temperatures | Mapping[str, Temperatures]
Nodes = list[dict[str, float]]
"""Temperatures of the parts of each bearing (C)."""

USUAL: Final = tuple(float(t) for t in range(-40, 151, 10))
"""Temperatures that are computed where none are given (C)."""
CLOSE: Final = 1e-3
"""Share of the largest loss of a bearing up to which losses and network agree."""
NUDGE: Final = 0.02
"""Share by which losses are changed to see what they do to themselves."""
STEPS: Final = 12
"""Most steps of Newton's method at one temperature outside."""
WARMING: Final = 40
"""Most steps from no loss to the balance at the first temperature outside."""
SMALLEST: Final = 1e-3
"""Smallest part of a step."""
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
        At each temperature, in the order given.
    lost : dict of str to tuple of float
        By the name of a play, temperatures at which it becomes positive or negative in the mean (C): where the preload is lost,
        or comes.
    runs_away_c : float or None
        Temperature outside from which on losses and cooling have no balance (C); None where there is one at all of them.
    torque_rises : tuple of float
        Temperatures (C) at which the torque rises with the temperature, as more preload costs more than thinner oil saves: only
        there heat can drive itself up.
    outside : bool
        Whether temperatures are those outside, with heat paths, and not those of the parts.
    title : str
        What it is of.
    """

    rows: tuple[AtTemperature, ...]
    lost: dict[str, tuple[float, ...]]
    runs_away_c: float | None
    torque_rises: tuple[float, ...]
    outside: bool
    title: str

    def _draw(self) -> Any:
        from trbdyn.plot.preload import draw_preload_over

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
        elif self.outside:
            worst = max(
                (row for row in self.rows if row.feedback is not None),
                key=lambda row: row.feedback or 0.0,
                default=None,
            )
            if worst is not None:
                said.append(
                    f"losses and cooling have a stable balance; at worst a watt of loss makes {worst.feedback:+.2g} W more "
                    f"({worst.temperature_c:.4g} C)"
                )
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
        With them the parts' temperatures are those at which bearings give off the heat that they make, and it is told where there
        are none: where heat makes preload and preload heat without end.
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
    balance = _Balance(warm, own_paths(subject, paths))
    outside = [number_of(f"temperatures[{k}]", one) for k, one in enumerate(temperatures)]
    rows, runs_away = balance.rows(outside)
    return PreloadOver(tuple(rows), warm.lost(rows), runs_away, _rising(rows), True, subject.title)


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


class _Balance:
    """Losses of all bearings and the temperatures that they make, outside of which it has one temperature.

    Unknowns are the losses of each bearing; how they are split between mechanisms follows from the last look at them.
    """

    def __init__(self, warm: _Warm, paths: list[HeatPaths]) -> None:
        self.warm, self.paths = warm, paths
        self.ribs = [part.bearing.ribs for part in warm.subject.parts.values()]
        self.shares: list[dict[str, float]] = []

    def nodes(self, power: Array, outside: float) -> Nodes:
        """Temperatures of the parts of each bearing that has these losses (W)."""
        found = []
        for watts, share, paths, ribs in zip(power, self.shares, self.paths, self.ribs, strict=True):
            own = paths.replace(housing_air_c=outside, shaft_end_c=outside, oil_inlet_c=outside)
            found.append(network(own, heat_of({key: watts * s for key, s in share.items()}, own.oil_share, ribs)))
        return found

    def temperatures(self, nodes: Nodes) -> dict[str, Temperatures]:
        return {name: Temperatures.of_nodes(one) for name, one in zip(self.warm.subject.names, nodes, strict=True)}

    def lost(self, power: Array, outside: float, *, look: bool = False) -> Array:
        """Losses of each bearing (W) at the temperatures that losses make; an error where nothing holds the shaft there, or
        parts are hotter than is looked for.
        """
        nodes = self.nodes(power, outside)
        if max(max(one.values()) for one in nodes) > HOTTEST:
            raise TrbError(f"parts become hotter than {HOTTEST:g} C")
        losses = self.warm.losses(self.warm.at(self.temperatures(nodes))[1])
        if look:
            self.shares = [_shares(one) for one in losses]
        return np.array([sum(one.values()) for one in losses])

    def rows(self, outside: Sequence[float]) -> tuple[list[AtTemperature], float | None]:
        """A row at each temperature outside that has a balance, and where there is none any more (C)."""
        rows: list[AtTemperature] = []
        power: Array | None = None
        for temperature in outside:
            found = self.balanced(temperature, power)
            if found is None:
                if not rows:
                    raise TrbError(
                        f"losses and cooling have no balance at {temperature:g} C outside: the conductances are too small, or "
                        "the preload runs away there already; begin with a temperature that has a balance"
                    )
                return rows, self._edge(rows[-1].temperature_c, temperature, power)
            power, feedback = found
            rows.append(self.warm.row(temperature, self.temperatures(self.nodes(power, temperature)), feedback))
        return rows, None

    def _edge(self, good: float, bad: float, power: Array | None) -> float:
        """The temperature outside between one with a balance and one without from which on there is none (C)."""
        while abs(bad - good) > EDGE:
            middle = 0.5 * (good + bad)
            found = self.balanced(middle, power)
            if found is None:
                bad = middle
            else:
                good, (power, _) = middle, found
        return 0.5 * (good + bad)

    def balanced(self, outside: float, power: Array | None) -> tuple[Array, float] | None:
        """Losses (W) that are in balance, and what one watt of them makes in addition; None where there are none, or where they
        would not stay.
        """
        try:
            return self._newton(outside, self._warmed(outside) if power is None else power)
        except TrbError:
            return None

    def _warmed(self, outside: float) -> Array:
        """Close to the balance, from no losses on: each step goes a part of the way, as a machine warms up, and a smaller one
        where it went too far.
        """
        names = self.warm.subject.names
        cold = self.warm.losses(self.warm.at({name: Temperatures.uniform(outside) for name in names})[1])
        self.shares = [_shares(one) for one in cold]
        power, change, share = np.zeros(len(cold)), np.array([sum(one.values()) for one in cold]), 0.3
        for _ in range(WARMING):
            further = self._step(power, share * change, outside)
            if further is None or np.min(further[1] * change) < -0.25 * np.max(change**2):
                share *= 0.3
                if share < SMALLEST:
                    break
                continue
            power, change = further
            if np.max(np.abs(change)) < 0.1 * np.max(power):
                return power
        raise TrbError("losses make temperatures, and temperatures losses, without an end")

    def _step(self, power: Array, step: Array, outside: float) -> tuple[Array, Array] | None:
        """Losses after a step, and how far they are from those that they make; None where the step leads too far."""
        try:
            return power + step, self.lost(power + step, outside, look=True) - power - step
        except TrbError:
            return None

    def _newton(self, outside: float, power: Array) -> tuple[Array, float] | None:
        now = self.lost(power, outside, look=True)
        for _ in range(STEPS):
            slopes = self._slopes(power, now, outside)
            if np.max(np.abs(now - power)) < CLOSE * np.max(np.abs(power)):
                feedback = float(np.max(np.linalg.eigvals(slopes).real))
                return (power, feedback) if feedback < 1.0 else None
            step = np.asarray(np.linalg.solve(np.eye(power.size) - slopes, now - power), dtype=np.float64)
            step *= min(1.0, 0.5 / max(float(np.max(np.abs(step) / np.maximum(power, 1e-9))), 1e-9))
            while (further := self._step(power, step, outside)) is None:
                step = np.asarray(0.3 * step)
                if np.max(np.abs(step)) < SMALLEST * np.max(power):
                    return None
            power, now = further[0], further[0] + further[1]
        return None

    def _slopes(self, power: Array, now: Array, outside: float) -> Array:
        """Slopes of the losses at the temperatures that losses make, with these losses."""
        columns = []
        for k, watts in enumerate(power):
            nudged = power.copy()
            nudged[k] = watts + NUDGE * max(watts, 1e-6)
            columns.append((self.lost(nudged, outside) - now) / (nudged[k] - watts))
        return np.array(columns).T


def _shares(losses: Mapping[str, float]) -> dict[str, float]:
    total = sum(losses.values())
    return {name: value / total for name, value in losses.items()} if total > 0.0 else dict.fromkeys(losses, 0.0)


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
