"""The operating points of the paper, and the starts from which each is run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Final, Literal

from trbdyn.errors import InputError
from trbdyn.model.bearing import Scatter
from trbdyn.model.cases import OPERATING_POINTS, paper_30310, rig_30310
from trbdyn.model.effects import Effects
from trbdyn.model.scene import Scene, Start

StartKind = Literal["equal", "unequal", "whirl"]
STARTS: Final[tuple[StartKind, ...]] = ("equal", "unequal", "whirl")

WHIRL_ECCENTRICITY: Final = 0.9
SCATTER: Final = 1e-6
"""Width of the range of roller diameters (m) where the paper has scatter."""
DIRECTION: Final = 90.0
"""Direction of the radial load in the figures (deg): loaded zone on top. The paper does not give it."""

GAUSS_NODES: Final = 8


def effects() -> Effects:
    """The paper's assumptions, with 8 Gauss nodes along a contact in place of its uniform slices.

    At a fixed interference the load is 0.19 % from that of very many slices, with 20 uniform slices 0.46 %, at half the cost.
    """
    return Effects.paper().replace(quadrature="gauss", n_slices=GAUSS_NODES)


@dataclass(frozen=True, order=True)
class Inputs:
    """Two inputs that the paper leaves open.

    Attributes
    ----------
    direction_deg : float
        Direction of the radial load on the inner ring from +x towards +y (deg). The ring turns from +x towards +y and gravity
        acts along -y: at 90 the loaded zone is on top, at 180 it is where rollers descend, at 0 where they rise.
    scatter : float
        Width of the range of roller diameters (m).
    """

    direction_deg: float = DIRECTION
    scatter: float = 0.0

    @property
    def name(self) -> str:
        """For instance ``180 deg, 0.2 um``."""
        return f"{self.direction_deg:g} deg, {1e6 * self.scatter:g} um"


@dataclass(frozen=True, order=True)
class Condition:
    """Speed, loads and scatter of an operating point.

    Attributes
    ----------
    speed_rpm : float
        Speed of the inner ring (rpm).
    axial_load, radial_load : float
        Loads on the inner ring (N).
    direction_deg : float
        Direction of the radial load on the inner ring from +x towards +y (deg); 90: loaded zone on top.
    scatter : float
        Width of the range of roller diameters (m).
    """

    speed_rpm: float
    axial_load: float
    radial_load: float = 0.0
    direction_deg: float = DIRECTION
    scatter: float = 0.0

    @property
    def name(self) -> str:
        """For instance ``3000rpm_1230N_scatter``, ``2000rpm_4930N_5530N``."""
        parts = [f"{self.speed_rpm:g}rpm", f"{self.axial_load:g}N"]
        if self.radial_load:
            parts.append(f"{self.radial_load:g}N")
        if self.radial_load and self.direction_deg != DIRECTION:
            parts.append(f"{self.direction_deg:g}deg")
        if self.scatter:
            parts.append("scatter" if self.scatter == SCATTER else f"scatter{1e6 * self.scatter:g}um")
        return "_".join(parts)

    @property
    def title(self) -> str:
        """For a figure: ``3000 rpm, Fa 1230 N``."""
        text = f"{self.speed_rpm:g} rpm, $F_a$ {self.axial_load:g} N"
        text += f", $F_r$ {self.radial_load:g} N" if self.radial_load else ""
        return text + (f", scatter {1e6 * self.scatter:g} µm" if self.scatter else "")

    def within(self, inputs: Inputs) -> Condition:
        """The same with the inputs that the paper leaves open; a direction where there is a radial load."""
        direction = inputs.direction_deg if self.radial_load else DIRECTION
        return replace(self, direction_deg=direction, scatter=inputs.scatter)


def _axial(speeds: Iterable[float], loads: Iterable[float]) -> tuple[Condition, ...]:
    return tuple(Condition(speed, load) for load in loads for speed in speeds)


SPEEDS: Final = (1000.0, 2000.0, 3000.0)
AXIAL_LOADS: Final = (1230.0, 3080.0, 4930.0)
RADIAL_LOADS: Final = (2780.0, 5530.0, 8380.0)

FIGURES: Final[dict[str, tuple[Condition, ...]]] = {
    "12a": _axial(SPEEDS, [3080.0]),
    "12b": _axial([3000.0], AXIAL_LOADS),
    "9": _axial(SPEEDS, [3080.0]),
    "10": (Condition(1000.0, 1230.0), Condition(3000.0, 4930.0)),
    "13": _axial([1000.0, 3000.0], [3080.0]),
    "14": _axial([3000.0], [1230.0, 4930.0]),
    "15": (Condition(3000.0, 1230.0), Condition(3000.0, 1230.0, scatter=SCATTER)),
    "16a": tuple(Condition(speed, 4930.0, 5530.0) for speed in SPEEDS),
    "16b": tuple(Condition(2000.0, 4930.0, load) for load in RADIAL_LOADS),
    "17": (Condition(3000.0, 4930.0),),
    "18": (Condition(2000.0, 4930.0, 5530.0),),
}
"""Conditions of each figure, in the order of its panels."""


@dataclass(frozen=True, order=True)
class Point:
    """A condition and a start: one run.

    Attributes
    ----------
    condition : Condition
        The operating point.
    start : {'equal', 'unequal', 'whirl'}
        Rollers evenly spaced, cage at rest; rollers at random places, cage at rest; cage whirling at 0.9 Cpr, rollers centred
        in their pockets.
    seed : int
        Seed of random spacing and of scattered diameters.
    """

    condition: Condition
    start: StartKind
    seed: int = 0

    @property
    def seeded(self) -> bool:
        """Whether the seed plays a part."""
        return self.start == "unequal" or self.condition.scatter > 0.0

    @property
    def name(self) -> str:
        """For instance ``3000rpm_4930N_unequal1``."""
        return f"{self.condition.name}_{self.start}{self.seed if self.seeded else ''}"

    def scene(self) -> Scene:
        """The scene: the 30310 rig with `effects`, the same assumptions for all points."""
        condition = self.condition
        starts = {
            "equal": Start.equal(),
            "unequal": Start.unequal(self.seed),
            "whirl": Start.whirl(WHIRL_ECCENTRICITY),
        }
        bearing = rig_30310()
        if condition.scatter:
            scatter = Scatter(range=condition.scatter, seed=self.seed)
            bearing = bearing.replace(roller=bearing.roller.replace(diameter_scatter=scatter))
        return paper_30310(
            condition.speed_rpm,
            condition.axial_load,
            condition.radial_load,
            bearing=bearing,
            radial_direction_deg=condition.direction_deg,
            effects=effects(),
            start=starts[self.start],
        )


def conditions(every: bool = False) -> tuple[Condition, ...]:
    """Conditions of the figures; or those, and all speeds with all loads."""
    drawn = [condition for figure in FIGURES.values() for condition in figure]
    if every:
        drawn += [Condition(p.speed_rpm, p.axial_load, p.radial_load) for p in OPERATING_POINTS.values()]
    return tuple(dict.fromkeys(sorted(drawn)))


def points(
    patterns: Sequence[str] = (),
    starts: Sequence[StartKind] = STARTS,
    seeds: Sequence[int] = (0,),
    inputs: Sequence[Inputs] = (Inputs(),),
) -> tuple[Point, ...]:
    """The points to run.

    Parameters
    ----------
    patterns : sequence of str
        Names of points or conditions, with * and ?; or ``all``: every speed with every load; by default those of the figures.
    starts : sequence of str
        Starts.
    seeds : sequence of int
        Seeds of whatever is random.
    inputs : sequence of Inputs
        Directions and scatters that every condition is run with.

    Returns
    -------
    tuple of Point

    Raises
    ------
    InputError
        If a pattern fits no point.
    """
    listed = [
        Point(condition, start, seed)
        for condition in _with(conditions(every="all" in patterns), inputs)
        for start in starts
        for seed in (seeds if Point(condition, start).seeded else seeds[:1])
    ]
    listed = list(dict.fromkeys(point if point.seeded else replace(point, seed=0) for point in listed))
    wanted = [pattern for pattern in patterns if pattern != "all"]
    if not wanted:
        return tuple(listed)
    for pattern in wanted:
        if not any(_fits(point, pattern) for point in listed):
            names = ", ".join(condition.name for condition in conditions())
            raise InputError.of(
                "points", pattern, f"fits no point; conditions: {names}, each with _equal, _unequal0 or _whirl"
            )
    return tuple(point for point in listed if any(_fits(point, pattern) for pattern in wanted))


def _with(listed: Sequence[Condition], inputs: Sequence[Inputs]) -> tuple[Condition, ...]:
    """Conditions with each of the inputs; one that has a scatter of its own keeps it."""
    made = [c if c.scatter else c.within(one) for one in inputs for c in listed]
    return tuple(dict.fromkeys(made))


def _fits(point: Point, pattern: str) -> bool:
    return fnmatchcase(point.name, pattern) or fnmatchcase(point.condition.name, pattern)
