"""The runs: operating points, starts, seeds, and the study made of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from paper.points import Condition
from paper.sensitivity.inputs import Input, Level, inputs
from trbdyn.errors import InputError
from trbdyn.extras.study.definition import Base, Case, Study
from trbdyn.model.bearing import Scatter
from trbdyn.model.cases import paper_30310, rig_30310
from trbdyn.model.effects import Effects
from trbdyn.model.scene import Scene, Start
from trbdyn.run.options import Group, RunOptions

StartName = Literal["small", "full"]
FULL: Final = 0.9
"""Orbit of the full start (Cpr), near the largest."""
NOMINAL: Final = "nominal"
GROUPS: Final[tuple[Group, ...]] = ("cage", "rollers", "pocket", "torque")


@dataclass(frozen=True)
class Place:
    """An operating point of the study.

    Attributes
    ----------
    condition : Condition
        Speed and loads.
    duration : float
        Bearing time of a run from the full orbit (s).
    small : float
        Orbit of the small start (Cpr): free to grow or to shrink for as long as its run lasts. 0: no such runs, for a cage that
        does not whirl.
    small_duration : float
        Bearing time of a run from the small orbit (s).
    """

    condition: Condition
    duration: float
    small: float = 0.0
    small_duration: float = 0.0

    @property
    def name(self) -> str:
        """Name of the condition."""
        return self.condition.name

    @property
    def starts(self) -> tuple[StartName, ...]:
        """Orbits from which it is run."""
        return ("small", "full") if self.small else ("full",)

    def start(self, name: StartName) -> tuple[float, float]:
        """Orbit (Cpr) and bearing time (s) of a start."""
        return (self.small, self.small_duration) if name == "small" else (FULL, self.duration)


PLACES: Final = (
    Place(Condition(3000.0, 4930.0), 1.5, 0.3, 2.0),
    Place(Condition(3000.0, 3080.0), 1.5, 0.2, 1.0),
    Place(Condition(2000.0, 4930.0, 5530.0), 1.5, 0.5, 1.5),
    Place(Condition(3000.0, 1230.0), 1.0),
)
"""Where the study looks: the paper's largest whirl, a load at which orbits grow fast, combined load, no whirl."""


@dataclass(frozen=True)
class Plan:
    """What is run.

    Attributes
    ----------
    places : tuple of Place
        Operating points.
    inputs : tuple of Input
        What is changed, one at a time.
    seeds : int
        Seeds of each level.
    nominal_seeds : int
        Seeds of the nominal inputs: their scatter is the noise.
    save_every : float
        Time between records (s).
    """

    places: tuple[Place, ...] = PLACES
    inputs: tuple[Input, ...] = ()
    seeds: int = 3
    nominal_seeds: int = 8
    save_every: float = 1e-3

    @classmethod
    def full(cls, seeds: int = 3) -> Plan:
        """Every input at every point."""
        return cls(inputs=inputs(), seeds=seeds)

    @classmethod
    def quick(cls) -> Plan:
        """A check that everything works: three inputs at one point, too short to tell anything."""
        chosen = tuple(entry for entry in inputs() if entry.name in ("cage mass", "pressure law", "tolerances"))
        return cls((Place(PLACES[0].condition, 0.3, 0.3, 0.3),), chosen, 2, 3, 1e-3)


def scene(place: Place, start: StartName, seed: int) -> Scene:
    """A scene with nominal inputs.

    The seed gives the direction in which the whirl starts, and whatever else is random.
    """
    condition = place.condition
    direction = float(np.random.default_rng([29, seed]).uniform(-180.0, 180.0))
    bearing = rig_30310()
    none = Scatter(range=0.0, seed=seed)
    return paper_30310(
        condition.speed_rpm,
        condition.axial_load,
        condition.radial_load,
        bearing=bearing.replace(roller=bearing.roller.replace(diameter_scatter=none)),
        radial_direction_deg=condition.direction_deg,
        effects=Effects.paper().replace(quadrature="gauss", n_slices=8),
        start=Start.whirl(place.start(start)[0], direction_deg=direction).replace(seed=seed),
    )


def case(
    place: Place, start: StartName, seed: int, entry: Input | None, level: Level | None, save_every: float
) -> Case:
    """One run: nominal inputs, or one of them at another level."""
    overrides: dict[str, Any] = dict(level.overrides) if level else {}
    duration = place.start(start)[1]
    if entry is not None and entry.name == "run time":
        duration *= 2.0
    run = RunOptions(duration=duration, save_every=save_every, save_groups=GROUPS, accuracy="fast")
    parameters = {
        "point": place.name,
        "start": start,
        "input": entry.name if entry else NOMINAL,
        "level": level.label if level else NOMINAL,
        "seed": seed,
    }
    try:
        made, options = Base.of(scene(place, start, seed), run).build(overrides)
    except InputError as error:
        return Case(parameters, None, run, str(error))
    return Case(parameters, made, options)


def study(plan: Plan) -> Study:
    """All runs of a plan: nominal ones first, then one seed of everything after the other."""
    made: list[Case] = []
    orbits = [(place, start) for place in plan.places for start in place.starts]
    for seed in range(plan.nominal_seeds):
        made += [case(place, start, seed, None, None, plan.save_every) for place, start in orbits]
    for seed in range(plan.seeds):
        for entry in plan.inputs:
            made += [
                case(place, start, seed, entry, level, plan.save_every)
                for level in entry.levels
                for place, start in orbits
                if applies(entry, place, start)
            ]
    return Study(tuple(made), (), "sensitivity")


def applies(entry: Input, place: Place, start: StartName) -> bool:
    """Whether an input is changed at a point and a start."""
    if entry.whirl_only and start != "full":
        return False
    return bool(place.condition.radial_load) or not entry.combined_only


def chosen(places: Iterable[Place], names: Sequence[str]) -> tuple[Place, ...]:
    """Places by their names; all if no name is given.

    Raises
    ------
    InputError
        If there is no such place.
    """
    table: Mapping[str, Place] = {place.name: place for place in places}
    for name in names:
        if name not in table:
            raise InputError.of("points", name, f"must be among {', '.join(table)}")
    return tuple(table[name] for name in names) if names else tuple(table.values())
