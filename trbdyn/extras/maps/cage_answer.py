"""`trbdyn.cage_answer`: what a cage does in the long run, from starts side by side and with rollers as they are made
(docs/theory/whirl.md#starts-side-by-side).

One run tells what a cage does from one start, and not for sure within a time that is short against the creep of the rollers. Runs
from rest and from a large whirl that come to the same motion tell it from both sides; where they do not, the direction of a start
between them does. Equal rollers, which nobody has, may give another answer than rollers of ordinary scatter.
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import number_of, whole_number_of
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.motion import is_constant
from trbdyn.model.roller import Scatter
from trbdyn.model.scene import Scene
from trbdyn.model.start import Start
from trbdyn.results import observables
from trbdyn.results.observables.starts import OF_STARTS, SLOW
from trbdyn.results.result import Result
from trbdyn.run.options import RunOptions
from trbdyn.run.simulation import Simulation
from trbdyn.statics.creep import creep_time

Array = NDArray[np.float64]

WINDOW: Final = 20
"""Turns of the cage in a window; half as many where half of the first window of the outer runs costs more than `COSTLY`."""
COSTLY: Final = 0.125
"""Share of the processor time."""
RECORDS_A_TURN: Final = 32
GROUPS: Final = ("cage", "rollers", "peaks", "pocket")
FIRST_GROUPS: Final = ("cage", "rollers")
"""The same of the first window, which is a transient of which no hits are told."""
REST, BETWEEN, LARGE = "rest", "whirl 0.3", "whirl 0.9"
STARTS: Final = {REST: Start.equal(), BETWEEN: Start.whirl(0.3), LARGE: Start.whirl(0.9)}
ORDER: Final = (REST, LARGE, BETWEEN)
"""Starts in the order in which they are compared."""
BEFORE_THIRD: Final = 3
"""Windows of the outer starts before the one between is run, where they do not agree; 1 where the rollers creep within more turns
than these windows have, so that a direction is the most that can be told soon.
"""
ENOUGH: Final = 4
"""Windows after which starts that do not agree need no longer runs: two motions, or a direction whose end lies beyond the
processor time.
"""
STEADY: Final = 6.0
"""Longest over shortest time that is left, up to which a direction needs no longer runs: 4 for a rate that does not change."""
SCATTER: Final = (0.0, 0.2e-6, 1e-6)
"""Ranges of the rollers' diameters that are tried unless told otherwise (m): none; those of the finest rollers; those of ordinary
ones (ISO 12297, variation within a lot: 0.5 um of grade 0.5, 1 um of grade 1).
"""
TOLD: Final = ("agreed", "alike", "grows", "dies")
"""Verdicts that tell one motion."""
ONE_CLASS: Final = ("agreed", "alike", "so far")
"""Verdicts that tell the class of all starts."""
WHIRLS: Final = {
    "circling": "whirls",
    "rocking": "hangs and rocks",
    "stable": "does not whirl",
    "unstable": "moves without order",
}


@dataclass(frozen=True)
class OfRollers:
    """What a cage does with rollers of one scatter.

    Attributes
    ----------
    bearing : str
        Name of the bearing on its shaft; empty for one alone.
    scatter : float
        Range of the rollers' diameters (m); 0 for equal ones.
    seed : int
        Seed of the diameters.
    found : Compared
        What the starts tell: agreed, alike, so far, grows, dies, meets, two motions, start decides or unknown.
    kind : str
        Class of the motion, as `observables.classify` names it: of all starts where they agree or are alike, also so far; of the
        one towards which it moves where it grows or dies; else 'unknown'.
    hits : float
        Hits of rollers on the cage in a second (1/s), of that start; nan for an unknown motion.
    force : float
        Largest force of a roller on the cage in the last window of that start (N); nan for an unknown motion.
    turns : int
        Turns of the cage of the longest run; of a direction that of the starts whose way it is.
    processor_time : float
        Processor time of all runs (s).
    kinds : tuple of str
        Classes of the motion in the last window from rest and from a large whirl.
    near : tuple of str
        Agreed, alike, so far: classes of the starts that have come there, and those that their motions have with an orbit as
        small or as large as the answer leaves possible (`CageMotion.kind_at`).
    """

    bearing: str
    scatter: float
    seed: int
    found: observables.Compared
    kind: str
    hits: float
    force: float
    turns: int
    processor_time: float
    kinds: tuple[str, str] = ("unknown", "unknown")
    near: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """The verdict in words."""
        found, does = self.found, WHIRLS.get(self.kind, "")
        if found.verdict in ONE_CLASS:
            does = " or ".join(dict.fromkeys(WHIRLS.get(kind, "moves") for kind in (self.kind, *self.near)))
        if found.verdict == "agreed":
            of, moving = f"it {does}, orbit {found.orbit:.2f} Cpr within {found.error:.2f}", math.isfinite(found.rate)
            last = f"; the orbit of the last one still {_way(found.rate)} towards it" if moving else ""
            return f"{'two of three starts' if moving else 'all starts'} agree: {of}{last}"
        if found.verdict in ("alike", "so far"):
            low, high = (end(*found.ends, found.orbit + way * found.error) for end, way in ((min, -1.0), (max, 1.0)))
            low = max(low, 0.0)
            if found.verdict == "so far":
                now = f"so far it {does} from all starts, orbit {low:.2f} to {high:.2f} Cpr"
                return f"{now}; it may go on to another motion: {found.reason}"
            return f"it {does} from all starts; their orbits differ or wander: {low:.2f} to {high:.2f} Cpr"
        if found.verdict in ("grows", "dies"):
            of = f"{OF_STARTS[found.movers[0]]} " if found.movers else ""
            way = f"{of}the orbit {_way(found.rate)}"
            when = f"expected there {self._when('after')}"
            return f"{way} towards {found.orbit:.2f} Cpr, where it {does}; {when}"
        if found.verdict == "meets":
            when = f"expected {self._when('within')}"
            return f"starts approach each other by {abs(found.rate):.2g} Cpr in a second near {found.orbit:.2f} Cpr; {when}"
        if found.verdict in ("two motions", "start decides"):
            both = "; ".join(
                f"{start} it {WHIRLS.get(kind, 'moves')}, orbit {end:.2f} Cpr"
                for start, kind, end in zip(OF_STARTS[:2], self.kinds, found.ends, strict=True)
            )
            long = f" for {found.time_low:.2g} s or longer" if found.verdict == "start decides" else ""
            return f"two motions are possible, the start decides{long}: {both}"
        return f"cannot be told: {found.reason}"

    def _when(self, within: str) -> str:
        """When a direction comes to its end."""
        low, high = self.found.time_low, self.found.time_high
        if math.isinf(high):
            return f"after {low:.2g} s more at the earliest; it slows down and may end before"
        return f"{within} {low:.2g} to {high:.2g} s more"


def _way(rate: float) -> str:
    """A rate of an orbit in words."""
    return f"{'grows' if rate > 0.0 else 'shrinks'} by {abs(rate):.2g} Cpr in a second"


@dataclass(frozen=True, repr=False)
class CageAnswer(Tabled):
    """What a cage does in the long run; print it for a table.

    Attributes
    ----------
    rows : tuple of OfRollers
        For each bearing and each scatter of the rollers.
    creep_turns : dict of str to float
        Turns of the cage within which creep of the rollers changes the whirl, by bearing; nan where it is not known.
    title : str
        What it is of.
    """

    rows: tuple[OfRollers, ...]
    creep_turns: dict[str, float]
    title: str

    @property
    def warnings(self) -> tuple[str, ...]:
        """What an engineer must know of it."""
        said: list[str] = []
        for name, turns in self.creep_turns.items():
            of = f"{name}: " if name else ""
            rows = [row for row in self.rows if row.bearing == name]
            if turns > SLOW:
                said.append(
                    f"{of}the rollers creep within {turns:.3g} turns of the cage: for a long time the start and the scatter of "
                    "the rollers decide"
                )
            ideal = next((row for row in rows if row.scatter == 0.0), None)
            for row in rows:
                if ideal is not None and row is not ideal and (words := _changes(ideal, row)):
                    said.append(f"{of}{words}")
        return tuple(said)

    def _shown(self) -> Shown:
        rows = []
        for row in self.rows:
            rollers = "equal" if row.scatter == 0.0 else f"{1e6 * row.scatter:g} um, seed {row.seed}"
            hits = [f"{value:.3g}" if math.isfinite(value) else "-" for value in (row.hits, row.force)]
            cells = (rollers, row.words, *hits, f"{row.turns}", f"{row.processor_time:.1f}")
            rows.append((row.bearing, *cells) if len(self.creep_turns) > 1 else cells)
        head = ("rollers", "the cage", "hits 1/s", "largest hit N", "turns of the cage", "processor s")
        note = (
            "Runs from rest and from a whirl of 0.9 Cpr, and from one of 0.3 Cpr where these do not agree; rollers differ in "
            "diameter by the range that is named, evenly."
        )
        return Shown(
            f"The cage in the long run: {self.title}",
            tuple(rows),
            ("bearing", *head) if len(self.creep_turns) > 1 else head,
            (*self.warnings, note),
        )


def _changes(ideal: OfRollers, real: OfRollers) -> str:
    """How scatter of the rollers changes the answer, in a sentence; empty where it does not."""
    if real.found.verdict not in TOLD:
        return ""
    of = f"rollers with a scatter of {1e6 * real.scatter:g} um (seed {real.seed})"
    here = f"the cage {WHIRLS.get(real.kind, 'moves')} ({real.found.orbit:.2f} Cpr)"
    if ideal.found.verdict not in TOLD:
        return f"with {of} {here}; with equal rollers, which nobody has, it cannot be told"
    if ideal.kind != real.kind or abs(ideal.found.orbit - real.found.orbit) > 2.0 * observables.LIMITS["orbit radius"]:
        was = f"{WHIRLS.get(ideal.kind, 'moves')} ({ideal.found.orbit:.2f} Cpr)"
        return f"with {of} {here}; with equal rollers, which nobody has, it {was}"
    return ""


def cage_answer(
    subject: Subject,
    *,
    scatter: Sequence[float] = SCATTER,
    seeds: Sequence[int] = (1,),
    processor_time: float = 60.0,
    options: RunOptions | None = None,
    workers: int | None = None,
) -> CageAnswer:
    """What a cage does in the long run, as soon as it can be told: from starts side by side, with rollers as they are made.

    Runs from rest and from a large whirl go on side by side in threads, window by window of 20 turns of the cage (10 where these
    are costly), until both have come to the same motion. Where they have not, a third run from a whirl of 0.3 of the play shows
    the direction, with its rate: from the second window on where the rollers creep slowly, else from the fourth. A search ends
    when the starts agree; when a direction is told whose end lies beyond the processor time, by a rate that does not change;
    when the rollers creep so slowly that the start decides, and then both motions are told; or when the
    processor time is spent.

    Parameters
    ----------
    subject : Scene or Assembly
        What is run; speed and loads must be constant, and there must be a cage. Its start is not used.
    scatter : sequence of float
        Ranges of the rollers' diameters (m): none, 0.2 and 1 um by default. A bearing whose rollers have deviations of their own
        is run with these.
    seeds : sequence of int
        Seeds of the diameters; each range but none is run with each.
    processor_time : float
        Most processor time for each scatter (s). The answer may depend on it, and so on the machine.
    options : RunOptions, optional
        Accuracy and settings of each run, not its length; 'fast' by default.
    workers : int, optional
        Runs at a time; by default three.

    Returns
    -------
    CageAnswer
        Prints as a table.

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> import trbdyn as trb
    >>> found = trb.cage_answer(trb.cases.scene_30310(3000.0, 1230.0), scatter=[0.0])
    >>> found.rows[0].found.verdict, found.rows[0].kind
    ('agreed', 'circling')
    """
    expect("subject", subject, Scene, Assembly)
    for part in subject.parts.values():
        if not part.effects.has_cage:
            raise InputError.of(("effects", "bodies"), part.effects.bodies, "must be 'rollers_and_cage'")
    if not all(is_constant(quantity) for quantity in subject.quantities().values()):
        raise InputError.of("subject", "speed or loads", "must be constant in time")
    if subject.orbit_speed(subject.part.start.time) == 0.0:
        raise InputError.of("subject", "speed", "must not be 0: a cage that stands has no turns")
    if not 0.0 < number_of("processor_time", processor_time) < math.inf:
        raise InputError.of("processor_time", processor_time, "must be above 0 (s)")
    ranges = [number_of(f"scatter[{k}]", one) for k, one in enumerate(scatter)]
    if not ranges:
        raise InputError.of("scatter", scatter, "must be one range or more (m)")
    drawn = [whole_number_of(f"seeds[{k}]", one, 0) for k, one in enumerate(seeds)]
    if not drawn:
        raise InputError.of("seeds", seeds, "must be one seed or more")
    run = RunOptions(accuracy="fast") if options is None else options
    rows: list[OfRollers] = []
    creep = {name: _creep_turns(part) for name, part in zip(subject.names, subject.parts.values(), strict=True)}
    for width in ranges:
        for seed in drawn if width > 0.0 else drawn[:1]:
            rows += _Search(_scattered(subject, width, seed), run, width, seed, creep, workers or len(STARTS)).rows(
                processor_time
            )
    rows.sort(key=lambda row: list(creep).index(row.bearing))
    return CageAnswer(tuple(rows), creep, subject.title)


def _creep_turns(part: Any) -> float:
    """Turns of the cage within which creep of the rollers changes the whirl (1)."""
    return (
        creep_time(part) * abs(part.orbit_speed(part.start.time)) / (2.0 * math.pi)
        if isinstance(part, Scene)
        else math.nan
    )


def _scattered(subject: Subject, width: float, seed: int) -> Subject:
    """The subject with rollers of a scatter, where they have no deviations of their own."""
    for prefix, part in subject.parts.items() if width > 0.0 else ():
        roller = part.bearing.roller
        if roller.diameter_deviation is None and roller.diameter_scatter is None:
            own = roller.replace(diameter_scatter=Scatter(range=width, seed=seed))
            subject = subject.with_part(prefix, bearing=part.bearing.replace(roller=own))
    return subject


@dataclass
class _Run:
    """A run from one start: what was found so far, by bearing."""

    simulation: Any
    turn: float
    """Time of a turn of the cage (s)."""
    spent: float = 0.0
    turns: int = 0
    times: dict[str, list[Array]] = field(default_factory=dict)
    means: dict[str, list[dict[str, Array]]] = field(default_factory=dict)
    last: dict[str, Result] = field(default_factory=dict)

    def go_on(self, turns: int, groups: Sequence[str]) -> float:
        """Run on for some turns of the cage; the processor time (s)."""
        began = clock.thread_time()
        # a little more than whole turns, as a cage that slips has not quite turned by them
        result = self.simulation.run(
            duration=(turns + 0.2) * self.turn, save_every=self.turn / RECORDS_A_TURN, save_groups=groups
        )
        parts = dict(result.by_name)
        for name, part in parts.items():
            when, means = part.turn_means()
            self.times.setdefault(name, []).append(when)
            self.means.setdefault(name, []).append(means)
        self.last, self.turns = parts, self.turns + turns
        took = clock.thread_time() - began
        self.spent += took
        return took

    def series(self, name: str) -> tuple[Array, dict[str, Array]]:
        """Times of the turns of the cage, and means over them."""
        parts = self.means[name]
        return np.concatenate(self.times[name]), {key: np.concatenate([one[key] for one in parts]) for key in parts[0]}


@dataclass
class _Search:
    """Runs from all starts of one subject."""

    subject: Subject
    options: RunOptions
    scatter: float
    seed: int
    creep: dict[str, float]
    workers: int
    window: int = WINDOW
    """Turns of the cage in a window."""

    def rows(self, most: float) -> list[OfRollers]:
        """The answer of each bearing within a processor time (s)."""
        runs = {name: self._begun(name) for name in (REST, LARGE)}
        with ThreadPoolExecutor(self.workers) as pool:

            def go_on(names: Sequence[str], turns: int, groups: Sequence[str] = GROUPS) -> float:
                """Run on; largest processor time of a run (s)."""
                return max(pool.map(lambda name: runs[name].go_on(turns, groups), names))

            each, windows, going = go_on(list(runs), WINDOW // 2, FIRST_GROUPS), 1, list(runs)
            self.window = WINDOW // 2
            if len(runs) * each <= COSTLY * most:
                each += go_on(going, WINDOW // 2, FIRST_GROUPS)
                self.window = WINDOW
            turns, slowly = self.window, any(one > BEFORE_THIRD * self.window for one in self.creep.values())
            while True:
                found = {name: self._compared(name, runs) for name in self.subject.names}
                spent = sum(one.spent for one in runs.values())
                told = all(one.verdict in ("agreed", "alike") for one in found.values())
                open_ones = set().union(*(one.open for one in found.values()))
                going = [name for k, name in enumerate(ORDER) if k in open_ones and name in runs]
                if third := BETWEEN not in runs and not told and windows >= (1 if slowly else BEFORE_THIRD):
                    going = list(ORDER)
                left = (most - spent) / (each * len(going)) * turns  # turns that can still be run
                done = all(self._is_done(one, windows, left) for one in found.values())
                if windows > 1 and (done or left < self.window // 2):
                    break
                if third:
                    runs[BETWEEN] = self._begun(BETWEEN)
                turns = max(min(self.window, int(left)), self.window // 2)
                each, windows = go_on(going, turns), windows + 1
        return [self._row(name, found[name], runs, spent) for name in self.subject.names]

    @property
    def _turn(self) -> float:
        """Bearing time of a turn of the cage (s)."""
        return 2.0 * math.pi / abs(self.subject.orbit_speed(self.subject.part.start.time))

    def _is_done(self, found: observables.Compared, windows: int, left: float) -> bool:
        """Whether longer runs of a bearing are of no use, with turns of the cage that can still be run."""
        if found.verdict == "agreed":
            return True
        if found.verdict == "start decides":
            left = min(left, windows * self.window)
        beyond = found.time_low > left * self._turn
        if found.verdict in ("grows", "dies", "meets"):
            beyond = beyond and found.time_high <= STEADY * found.time_low
        return windows >= ENOUGH and (found.verdict == "two motions" or beyond)

    def _begun(self, start: str) -> _Run:
        subject = self.subject
        for prefix, part in subject.parts.items():
            subject = subject.with_part(prefix, start=STARTS[start].replace(time=part.start.time))
        own = self.options.replace(revolutions=None, duration=WINDOW * self._turn)
        return _Run(Simulation(subject, **own.of_simulation()), self._turn)

    def _compared(self, name: str, runs: dict[str, _Run]) -> observables.Compared:
        kinds = [runs[start].last[name].cage_motion.kind for start in ORDER if start in runs and runs[start].turns]
        between = runs[BETWEEN].series(name) if BETWEEN in runs and runs[BETWEEN].turns else None
        outer = runs[REST].series(name), runs[LARGE].series(name)
        return observables.compare_starts(outer, between, window=self.window, creep_turns=self.creep[name], kinds=kinds)

    def _row(self, name: str, found: observables.Compared, runs: dict[str, _Run], spent: float) -> OfRollers:
        orbits = {start: runs[start].series(name)[1][observables.COMPARED] for start in (REST, LARGE)}
        ends = {start: float(values[-self.window :].mean()) for start, values in orbits.items()}
        like = min(ends, key=lambda start: abs(ends[start] - found.orbit))
        last = runs[like].last[name]
        told = found.verdict in (*TOLD, *ONE_CLASS)
        hits = float(last.rattle.per_second) if told else math.nan
        force = float(np.max(last.peaks["pocket_force_peak"])) if told else math.nan
        kind = last.cage_motion.kind if told else "unknown"
        directed = found.movers if found.verdict in ("grows", "dies", "meets") else ()
        turns = max(runs[ORDER[k]].turns for k in (directed or range(len(ORDER))) if ORDER[k] in runs)
        first, second = (runs[start].last[name].cage_motion.kind for start in (REST, LARGE))
        near = self._near(name, found, runs)
        return OfRollers(name, self.scatter, self.seed, found, kind, hits, force, turns, spent, (first, second), near)

    def _near(self, name: str, found: observables.Compared, runs: dict[str, _Run]) -> tuple[str, ...]:
        """Classes of starts that agree or are alike, with those that the range of their orbit leaves possible."""
        if found.verdict not in ONE_CLASS:
            return ()
        there = [start for k, start in enumerate(ORDER) if start in runs and k not in found.movers]
        motions = [runs[start].last[name].cage_motion for start in there if runs[start].turns >= 2 * self.window]
        orbits = [max(found.orbit + way * found.error, 0.0) for way in (0.0, -1.0, 1.0)]
        kinds = [one.kind for one in motions] + [one.kind_at(orbit) for one in motions for orbit in orbits]
        return tuple(dict.fromkeys(kinds))
