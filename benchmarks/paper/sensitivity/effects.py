"""Effects of the inputs on the indicators, and on statements of the paper, each beside its noise.

An effect is the mean over seeds of the change from the nominal run of the same seed. Its noise is the half width of the 95 %
interval of the difference of two means over that many seeds, from the scatter over the nominal seeds as if both were independent;
runs of the same seed share the direction in which the whirl starts, so that this is rather too wide than too narrow. With
hundreds of effects, one in twenty without a cause is beyond its noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from paper.sensitivity.indicators import INDICATORS, Indicator
from paper.sensitivity.inputs import Input, Level
from paper.sensitivity.plan import NOMINAL, PLACES, Plan

if TYPE_CHECKING:
    import xarray

Key = tuple[str, str, str, str]
"""Point, start, input, level."""
Runs = Mapping[Key, Mapping[int, Mapping[str, float]]]
"""Indicators of each seed of each key, runs that are done only."""
Outcome = Literal["holds", "fails", "open", "-"]

CONFIDENCE: Final = 0.975
NO_WHIRL: Final = 0.1
"""Orbit (Cpr) below which a cage is said not to whirl; set before any input was changed."""
SAME_FREQUENCY: Final = 0.02
"""Deviation from one of the whirl's order that passes as whirl at the cage's frequency."""


@dataclass(frozen=True)
class Nominal:
    """An indicator with nominal inputs: mean and standard deviation over the seeds."""

    mean: float
    deviation: float
    count: int

    def noise(self, count: int, *, of_change: bool) -> float:
        """Half width of the 95 % interval of a mean over `count` seeds, or of the change of one from another."""
        if self.count < 2 or count < 1:
            return math.nan
        from scipy.stats import t

        factor = float(t.ppf(CONFIDENCE, self.count - 1))
        return factor * self.deviation * math.sqrt((2.0 if of_change else 1.0) / count)


@dataclass(frozen=True)
class Effect:
    """What a level of an input does to an indicator at a point.

    Attributes
    ----------
    point, indicator, input, level : str
        Names.
    count : int
        Seeds.
    value : float
        Mean of the indicator at the level.
    change : float
        Mean change from the nominal run of the same seed.
    noise : float
        See the module; nan if there are fewer than two nominal seeds.
    """

    point: str
    indicator: str
    input: str
    level: str
    count: int
    value: float
    change: float
    noise: float

    @property
    def beyond(self) -> bool:
        """Whether the change is beyond its noise."""
        return abs(self.change) > self.noise


def runs_of(data: xarray.Dataset) -> Runs:
    """Indicators of the runs that are done, by what tells them apart."""
    found: dict[Key, dict[int, dict[str, float]]] = {}
    names = [entry.name for entry in INDICATORS if f"sens_{entry.name}" in data]
    for k in range(data.sizes["case"]):
        if str(data["status"].values[k]) != "done":
            continue
        point, start, name, level = (str(data[key].values[k]) for key in ("point", "start", "input", "level"))
        values = {entry: float(data[f"sens_{entry}"].values[k]) for entry in names}
        found.setdefault((point, start, name, level), {})[int(data["seed"].values[k])] = values
    return found


def nominals(runs: Runs, point: str) -> dict[str, Nominal]:
    """Nominal values at a point of the indicators that it has."""
    found = {}
    for indicator in INDICATORS:
        seeds = runs.get((point, indicator.start, NOMINAL, NOMINAL), {})
        values = _finite(entry[indicator.name] for entry in seeds.values())
        if values:
            found[indicator.name] = _nominal(values)
    return found


def effects(runs: Runs, plan: Plan) -> list[Effect]:
    """Every effect that the runs tell, in the order of the plan."""
    found = []
    for place in plan.places:
        table = nominals(runs, place.name)
        for entry in plan.inputs:
            for level in entry.levels:
                made = [
                    _effect(runs, place.name, entry, level, i, table[i.name]) for i in INDICATORS if i.name in table
                ]
                found += [effect for effect in made if effect is not None]
    return found


def _effect(
    runs: Runs, point: str, entry: Input, level: Level, indicator: Indicator, nominal: Nominal
) -> Effect | None:
    start, name = indicator.start, indicator.name
    here, there = runs.get((point, start, entry.name, level.label), {}), runs[point, start, NOMINAL, NOMINAL]
    pairs = [(here[seed][name], there[seed][name]) for seed in sorted(here.keys() & there.keys())]
    pairs = [(a, b) for a, b in pairs if math.isfinite(a) and math.isfinite(b)]
    if not pairs:
        return None
    value, change = np.mean([a for a, _ in pairs]), np.mean([a - b for a, b in pairs])
    noise = nominal.noise(len(pairs), of_change=True)
    return Effect(point, name, entry.name, level.label, len(pairs), float(value), float(change), noise)


@dataclass(frozen=True)
class Statement:
    """A statement of the paper, as far as these short runs can tell it.

    Attributes
    ----------
    name, text : str
        What it says.
    needs : tuple of (str, str)
        Points and indicators.
    margin : callable
        Positive where it holds, from the values of `needs`.
    """

    name: str
    text: str
    needs: tuple[tuple[str, str], ...]
    margin: Callable[[Sequence[float]], float]


_LARGE, _MIDDLE, _COMBINED, _SMALL = (place.name for place in PLACES)

STATEMENTS: Final = (
    Statement("grows at 4930 N", "a small orbit grows", ((_LARGE, "orbit_growth"),), lambda v: v[0]),
    Statement("grows at 3080 N", "a small orbit grows", ((_MIDDLE, "orbit_growth"),), lambda v: v[0]),
    Statement(
        "no whirl at 1230 N",
        f"after a start at 0.9 Cpr the orbit is below {NO_WHIRL} Cpr",
        ((_SMALL, "orbit"),),
        lambda v: NO_WHIRL - v[0],
    ),
    Statement(
        "combined smaller",
        "from 0.9 Cpr, the orbit under combined load is the smaller one",
        ((_LARGE, "orbit"), (_COMBINED, "orbit")),
        lambda v: v[0] - v[1],
    ),
    Statement("combined shrinks", "an orbit of 0.5 Cpr shrinks", ((_COMBINED, "orbit_growth"),), lambda v: -v[0]),
    Statement(
        "cage frequency",
        f"at 4930 N the whirl's frequency is the cage's within {100.0 * SAME_FREQUENCY:g} %",
        ((_LARGE, "whirl_order"),),
        lambda v: SAME_FREQUENCY - abs(v[0] - 1.0),
    ),
)
"""What is judged at every level of every input."""


@dataclass(frozen=True)
class Judged:
    """Whether a statement holds at a level of an input (nominal ones for `NOMINAL`).

    Attributes
    ----------
    statement, input, level : str
        Names.
    margin, noise : float
        Mean margin and half width of its 95 % interval; nan where there is none.
    outcome : {'holds', 'fails', 'open', '-'}
        Beyond the noise on the right or the wrong side, within it, or not concerned by the input.
    """

    statement: str
    input: str
    level: str
    margin: float
    noise: float
    outcome: Outcome


def judge(runs: Runs, plan: Plan) -> list[Judged]:
    """Every statement with nominal inputs and at every level; a level whose runs equal the nominal ones is judged as they are."""
    found = []
    levels = [(NOMINAL, NOMINAL)] + [(entry.name, level.label) for entry in plan.inputs for level in entry.levels]
    for statement in STATEMENTS:
        reference = _margins(runs, statement, NOMINAL, NOMINAL)
        if not reference:
            continue
        nominal = _nominal(list(reference.values()))
        for name, level in levels:
            here = _margins(runs, statement, name, level)
            unchanged = bool(here) and all(reference.get(seed) == margin for seed, margin in here.items())
            margins = list((reference if unchanged else here).values())
            margin = float(np.mean(margins)) if margins else math.nan
            noise = nominal.noise(len(margins), of_change=False)
            found.append(Judged(statement.name, name, level, margin, noise, _outcome(margin, noise)))
    return found


def _margins(runs: Runs, statement: Statement, name: str, level: str) -> dict[int, float]:
    """Margins of the seeds; values of points that the input does not concern are nominal ones."""
    start = {entry.name: entry.start for entry in INDICATORS}
    here = [runs.get((point, start[what], name, level), {}) for point, what in statement.needs]
    there = [runs.get((point, start[what], NOMINAL, NOMINAL), {}) for point, what in statement.needs]
    if not any(here):
        return {}
    tables = [a or b for a, b in zip(here, there, strict=True)]
    found = {}
    for seed in sorted(set.intersection(*(set(table) for table in tables))):
        values = [table[seed][what] for table, (_, what) in zip(tables, statement.needs, strict=True)]
        if all(math.isfinite(value) for value in values):
            found[seed] = statement.margin(values)
    return found


def _outcome(margin: float, noise: float) -> Outcome:
    if math.isnan(margin):
        return "-"
    if not abs(margin) > noise:
        return "open"
    return "holds" if margin > 0.0 else "fails"


def _nominal(values: Sequence[float]) -> Nominal:
    deviation = float(np.std(values, ddof=1)) if len(values) > 1 else math.nan
    return Nominal(float(np.mean(values)), deviation, len(values))


def _finite(values: Iterable[Any]) -> list[float]:
    return [float(value) for value in values if math.isfinite(value)]
