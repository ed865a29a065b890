"""From which speed on a cage whirls: runs over speeds from two starts, longer where their motion is not decided, and a search
between the speeds where it changes.

What a cage does may depend on how it began. A run is decided when its motion has settled by the rule of all runs
(`Result.settling`), or when the runs from both starts have come to the same motion (`trbdyn.observables.agree`); one
that is not is made again, four times as long. The class of a cage that creeps towards a whirl over thousands of turns is that of
its last quarter, and it stands there as not decided; where the creep of the rollers is so slow that no longer run would tell,
none is made.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Literal, Unpack

import numpy as np

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.extras.study.definition import Case
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.settled import run_until_settled, variables
from trbdyn.extras.study.work import Observable
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.scene import Scene
from trbdyn.model.start import Start
from trbdyn.results import observables
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.observables.slow_motion import CREEP_TIMES
from trbdyn.results.result import Result
from trbdyn.run.options import RunOptions

if TYPE_CHECKING:
    import xarray

KINDS: Final = ("unknown", "stable", "rocking", "circling", "unstable")
"""Classes, as `trbdyn.observables.classify` names them."""
TURNS: Final = (40.0, 160.0, 640.0)
"""Turns of the cage after which a run is judged; the next number where it is not decided."""
RECORDS_A_TURN: Final = 32
GROUPS: Final = ("cage", "rollers", "peaks")
STARTS: Final = {"equal": Start.equal(), "whirl": Start.whirl(0.9)}
WHIRLS: Final = "circling"
ABOUT: Final = {
    "kind": ("class of the cage's motion", ""),
    "orbit": ("orbit of the cage over the radial play", "1"),
    "hits": ("hits of rollers on the cage in a second", "1/s"),
    "impulse": ("mean impulse of a hit", "N s"),
    "settled": ("", ""),
    "turns": ("turns of the cage", "1"),
    "message": ("", ""),
}
"""What is kept of a run."""
UNKNOWN: Final = {
    "kind": "unknown",
    "orbit": np.nan,
    "hits": np.nan,
    "impulse": np.nan,
    "unknown": np.inf,
    "needed": 0.0,
}
"""The same of a run that failed."""

Point = tuple[str, float, float | None]


def _quarter(result: Result, number: int) -> Result:
    start, end = float(result["time"][0]), float(result["time"][-1])
    step = 0.25 * (end - start)
    return result.window(start + number * step, start + (number + 1) * step)


def kind_in(number: int, result: Result | AssemblyResult) -> float:
    """Class of the motion in a quarter of a run, as a place in `KINDS`. Of several cages: unknown if that of one is, else of
    those that move most: one that whirls, one that moves without order, one that rocks.
    """
    kinds = {_quarter(one, number).cage_motion.kind for one in result.parts}
    return float(
        KINDS.index(next(kind for kind in ("unknown", WHIRLS, "unstable", "rocking", "stable") if kind in kinds))
    )


def orbit_in(number: int, result: Result | AssemblyResult) -> float:
    """Orbit of the cage in a quarter of a run over the radial play (1); of several cages the largest."""
    return max(float(_quarter(one, number).cage_motion.orbit_over_play) for one in result.parts)


def orbit_unknown_at_end(result: Result | AssemblyResult) -> float:
    """How far the mean orbit of the last quarter may be off over the radial play (1); of several cages the largest."""
    found = []
    for one in result.parts:
        when, means = _quarter(one, 3).turn_means()
        enough = when.size >= observables.LEAST_BLOCKS
        found.append(observables.mean_unknown(when, means[observables.COMPARED]) if enough else np.inf)
    return max(found)


def hits_at_end(result: Result | AssemblyResult) -> float:
    """Hits of rollers on their cages in a second of the last quarter (1/s), all bearings together."""
    return sum(_quarter(one, 3).rattle.per_second for one in result.parts)


def impulse_at_end(result: Result | AssemblyResult) -> float:
    """Mean impulse of a hit in the last quarter (N s), all bearings together; 0 without hits."""
    found = [_quarter(one, 3).rattle for one in result.parts]
    return sum(one.hits * one.impulse_per_hit for one in found) / max(1, sum(one.hits for one in found))


def settled(result: Result | AssemblyResult) -> float:
    """1 where the motion of each bearing has settled, else 0."""
    return float(all(one.settling().settled for one in result.parts))


def needed_turns(result: Result | AssemblyResult) -> float:
    """Turns of the cage after which the creep of the rollers lets the motion be told (1); 0 where it is not known."""
    rates = [abs(float(np.mean(one.rolling_orbit))) / (2.0 * np.pi) for one in result.parts]
    found = (CREEP_TIMES * one.creep_time * rate for one, rate in zip(result.parts, rates, strict=True))
    return max((turns for turns in found if np.isfinite(turns)), default=0.0)


OBSERVED: Final[Mapping[str, Observable]] = {
    "settled_by_rule": settled,
    "needed_turns": needed_turns,
    "kind_at_end": partial(kind_in, 3),
    "orbit_at_end": partial(orbit_in, 3),
    "orbit_unknown_at_end": orbit_unknown_at_end,
    "hits_at_end": hits_at_end,
    "impulse_at_end": impulse_at_end,
}


@dataclass(frozen=True, repr=False)
class WhirlOnset(Tabled):
    """What a cage does over speed; print it for a table.

    Attributes
    ----------
    data : xarray.Dataset
        Dimensions start and speed_rpm, ascending in size. Variables: kind (text), orbit (over the radial play), decided, turns
        (of the cage), message.
    """

    data: xarray.Dataset
    _headed = True

    def onset(self, start: Literal["equal", "whirl"] = "equal") -> tuple[float, float]:
        """Between which speeds (rpm) the cage begins to whirl: the fastest one below the whirl, and the slowest with it.

        Parameters
        ----------
        start : {'equal', 'whirl'}
            From which start.

        Returns
        -------
        tuple of float
            The first is 0 where the cage whirls at the slowest speed whose motion is known, the second infinite where it never
            whirls.

        Raises
        ------
        InputError
            If the start was not run.
        """
        if start not in self.data["start"].values:
            raise InputError.of("start", start, f"must be one of {', '.join(map(str, self.data['start'].values))}")
        line = self.data.sel(start=start)
        speeds = np.abs(line["speed_rpm"].values)
        whirls = line["kind"].values == WHIRLS
        if not whirls.any():
            return float(speeds[-1]), np.inf
        first = int(np.argmax(whirls))
        # of a run that failed nothing is known
        below = speeds[:first][line["kind"].values[:first] != "unknown"]
        return (float(below[-1]) if below.size else 0.0, float(speeds[first]))

    def _shown(self) -> Shown:
        rows = []
        for name in self.data["start"].values:
            for speed in self.data["speed_rpm"].values:
                at = self.data.sel(start=name, speed_rpm=speed)
                said = str(at["message"].values) or ("yes" if bool(at["decided"]) else "no")
                turns = f"{float(at['turns']):g}"
                rows.append((str(name), f"{speed:g}", str(at["kind"].values), f"{float(at['orbit']):.3f}", turns, said))
        head = ("start", "speed (rpm)", "motion", "orbit / Cpr", "turns of the cage", "decided")
        notes = tuple(self._words(str(name)) for name in self.data["start"].values)
        return Shown("Motion of the cage over speed", tuple(rows), head, notes)

    def _words(self, start: Any) -> str:
        low, high = self.onset(start)
        if low == 0.0:
            return (
                f"from the start {start!r} the cage whirls at {high:g} rpm, and its motion is known at no slower speed"
            )
        if np.isinf(high):
            return f"from the start {start!r} it whirls at none of these speeds"
        return f"from the start {start!r} it begins to whirl between {low:g} and {high:g} rpm"


def whirl_onset(
    subject: Subject,
    speeds: Sequence[float],
    *,
    starts: Sequence[Literal["equal", "whirl"]] = ("equal", "whirl"),
    resolution: float | None = None,
    longest: float = TURNS[-1],
    options: RunOptions | None = None,
    **how: Unpack[Running],
) -> WhirlOnset:
    """What the cage of a bearing does at some speeds, and between which of them it begins to whirl. Of bearings on a shaft: what
    the cage does that moves most.

    Every speed is run from each start: from rest in the middle between even rollers, and from a large whirl, which tells whether
    a whirl lasts. A run has 40 turns of the cage; where neither its motion has settled nor both starts agree it is made again
    over 160, and then 640, unless the rollers creep so slowly that this would not tell.

    Parameters
    ----------
    subject : Scene or Assembly
        Gives all but speed and start.
    speeds : sequence of float
        Speeds of the shaft (rpm), all of one sign, none 0.
    starts : sequence of {'equal', 'whirl'}
        Starts.
    resolution : float, optional
        Search on between the speeds where the whirl begins, from each start, until they lie this near (rpm).
    longest : float
        Turns of the cage of the longest runs (1).
    options : RunOptions, optional
        Accuracy and settings of each run, not its length; 'fast' by default.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`.

    Returns
    -------
    WhirlOnset

    Raises
    ------
    InputError
        If an argument cannot be used.

    Notes
    -----
    A whirl that grows over tens of seconds, as under high loads, is not seen in 640 turns of the cage: such a run is not decided,
    or its orbit is small and looks steady. So look at both starts.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(2000.0, 1230.0)
    >>> found = trb.whirl_onset(scene, [1000.0], starts=["equal"], longest=40.0)
    >>> str(found.data.kind.values[0, 0])
    'stable'
    """
    expect("scene", subject, Scene, Assembly)
    wanted = speeds_of(speeds)
    if resolution is not None and not 0.0 < number_of("resolution", resolution) < np.inf:
        raise InputError.of("resolution", resolution, "must be > 0 (rpm)")
    search = CageRuns(subject, starts, options, longest, how)
    names = search.starts
    search.add([(name, speed, None) for name in names for speed in wanted])
    while resolution is not None and (points := search.between(resolution)):
        search.add([(name, speed, None) for speed in points for name in names])
    return search.gathered()


def numbers_of(field: str, values: Any, unit: str) -> list[float]:
    """Finite numbers of an argument, ascending in size, each once."""
    if isinstance(values, str) or not isinstance(values, Sequence | np.ndarray) or not len(values):
        raise InputError.of(field, values, f"must be a sequence of at least one number ({unit})")
    found = sorted({number_of(field, value) for value in values}, key=lambda value: (abs(value), value))
    if not all(np.isfinite(found)):
        raise InputError.of(field, values, f"must be finite ({unit})")
    return found


def speeds_of(speeds: Any) -> list[float]:
    """Speeds of one sign (rpm), ascending in size."""
    found = numbers_of("speeds", speeds, "rpm")
    if min(found) * max(found) <= 0.0:
        raise InputError.of("speeds", speeds, "must be of one sign and not 0 (rpm)")
    return found


class CageRuns:
    """Runs that were made, by start, speed (rpm) and axial load (N; None: that of the scene)."""

    def __init__(
        self, subject: Subject, starts: Sequence[str], options: RunOptions | None, longest: float, how: Running
    ) -> None:
        for name in starts:
            if name not in STARTS:
                raise InputError.of("starts", name, f"must be one of {', '.join(STARTS)}")
        for part in subject.parts.values():
            if not part.effects.has_cage:
                raise InputError.of(("effects", "bodies"), part.effects.bodies, "must be 'rollers_and_cage'")
        if not TURNS[0] <= number_of("longest", longest):
            raise InputError.of("longest", longest, f"must be >= {TURNS[0]:g} (1)")
        self.subject, self.longest, self.how = subject, float(longest), how
        self.starts = list(dict.fromkeys(starts))
        self.options = RunOptions(accuracy="fast") if options is None else options
        self.rows: dict[Point, dict[str, Any]] = {}

    def add(self, points: Sequence[Point]) -> None:
        """Run points until they are decided."""
        waiting = [point for point in points if point not in self.rows]
        for turns in (*(turns for turns in TURNS if turns < self.longest), self.longest):
            made = run_until_settled(
                waiting, (turns,), lambda point, n: self._case(*point, n), _row, OBSERVED, self.how, UNKNOWN
            )
            self.rows |= made
            for place in {point[1:] for point in waiting}:
                both = [self.rows[point] for name in self.starts if (point := (name, *place)) in self.rows]
                if len(both) > 1 and _agree(both):
                    for row in both:
                        row["settled"] = True
            waiting = [point for point in waiting if not self._ends(self.rows[point])]

    def _ends(self, row: Mapping[str, Any]) -> bool:
        """Whether a longer run of a point is of no use."""
        return bool(row["settled"] or row["message"] or row["needed"] > self.longest)

    def _case(self, start: str, speed: float, load: float | None, turns: float) -> Case:
        parameters = {"start": start, "speed_rpm": speed} | ({} if load is None else {"axial_load": load})
        try:
            built = self.subject if load is None else self.subject.with_axial_load(load)
            built = built.replace(speed_rpm=speed)
            for prefix in built.parts:
                built = built.with_part(prefix, start=STARTS[start])
            if isinstance(built, Scene):
                built.check_capacity()
        except InputError as error:
            return Case(parameters, None, self.options, str(error).splitlines()[0])
        length = turns * 2.0 * np.pi / abs(built.orbit_speed(built.part.start.time))
        save_every = length / (turns * RECORDS_A_TURN)
        own = self.options.replace(revolutions=None, duration=length, save_every=save_every, save_groups=GROUPS)
        return Case(parameters, built, own)

    def between(self, resolution: float) -> list[float]:
        """Speeds in the middle of where the whirl begins, as far as the speeds beside it are not near enough."""
        found = set()
        for name in self.starts:
            low, high = self.gathered().onset(name)  # type: ignore[arg-type]
            if low > 0.0 and np.isfinite(high) and high - low > resolution:
                sign = np.sign(next(iter(self.rows))[1])
                middle = float(sign * 0.5 * (low + high))
                if (name, middle, None) not in self.rows:  # one that failed is not tried again
                    found.add(middle)
        return sorted(found)

    def gathered(self) -> WhirlOnset:
        speeds = sorted({speed for _, speed, _ in self.rows}, key=abs)
        # a speed that was asked of one start only has a row for each
        places = {"start": self.starts, "speed_rpm": ("speed_rpm", speeds, {"units": "rpm"})}
        return WhirlOnset(self.dataset([(name, speed, None) for name in self.starts for speed in speeds], places))

    def dataset(self, points: Sequence[Point], places: Mapping[str, Any]) -> xarray.Dataset:
        """Runs of points, which are listed as the coordinates say, the last changing fastest."""
        import xarray

        shape = [len(one[1] if isinstance(one, tuple) else one) for one in places.values()]
        made = variables([self.rows[point] for point in points], ABOUT, list(places), shape)
        data = xarray.Dataset(made, places, {"bearing": self.subject.part.bearing.name})
        return data.rename_vars(settled="decided")


def _row(found: xarray.Dataset) -> dict[str, Any]:
    """What is kept of a run."""
    kind = KINDS[int(found["kind_at_end"])]
    rattle = {"hits": float(found["hits_at_end"]), "impulse": float(found["impulse_at_end"])}
    told = kind != "unknown" and bool(found["settled_by_rule"])
    needed = float(found["needed_turns"])
    orbit, unknown = float(found["orbit_at_end"]), float(found["orbit_unknown_at_end"])
    return {"kind": kind, "orbit": orbit, "unknown": unknown, **rattle, "settled": told, "needed": needed}


def _agree(rows: Sequence[Mapping[str, Any]]) -> bool:
    """Whether runs from both starts, of one length, have come to the same motion."""
    return observables.agree(*([row[name] for row in rows] for name in ("orbit", "unknown", "kind")))
