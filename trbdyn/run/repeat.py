"""A run, or pieces of it, made a second time: with its own tolerances from states that are moved a little, and with tighter ones.

A piece of a run of one bearing begins in the state of a record; one of bearings on a shaft at the start of the run alone.
"""

from __future__ import annotations

import math
import time as clock
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import StepError
from trbdyn.model.assembly import Assembly
from trbdyn.model.motion import History
from trbdyn.model.scene import Scene
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.number import Number, Seen
from trbdyn.results.result import Result
from trbdyn.run.judged import Piece, Sample, moved, tighter
from trbdyn.run.options import OF_ONE_RUN, RunOptions
from trbdyn.run.replay import NEEDED, Replay
from trbdyn.run.running import STOPPED, Run, output_times
from trbdyn.run.simulation import Simulation

STRATA: Final = 8
"""Pieces over which a run is divided that is too long to be repeated."""
LEFT_OUT: Final = 5e-3
"""Time at the beginning of such a piece in which vibrations grow to their size (s)."""
AFTER_JUMP: Final = 2.0
"""Turns after a jump of a load or a speed that belong to its piece."""
LEAST_RECORDS: Final = 8
"""Records of the run in a piece below which its numbers there come from repetitions alone; and records of a repetition below
which the time that ended it was too short to compare anything."""
UNKNOWN_COST: Final = 1.0
"""Time of a second of the bearing (s) where a result does not tell what it took: about real time."""
DEARER: Final = 6.0
"""Expected time of a tight repetition over that of one with the run's own tolerances, before any was made."""


class Repeating:
    """Repeats a run and reads some numbers of its summary (`rows`)."""

    def __init__(self, result: Result | AssemblyResult, rows: Sequence[Number]) -> None:
        self.rows = rows
        self.parts: Mapping[str, Result] = result.by_name
        self.first = next(iter(self.parts.values()))
        self.time = self.first["time"]
        self.subject: Scene | Assembly | None = result.subject
        given: dict[str, Any] = dict(self.first.meta.get("settings") or {})
        known = set(RunOptions.model_fields) - set(OF_ONE_RUN) - {"checkpoint_every"}
        self._own = {name: value for name, value in given.items() if name in known and value is not None}
        self._own["when_wrong"] = "go_on"
        self._tight = self._own | tighter(RunOptions(**self._own)) | {"integrator": "bdf"}
        self._every = float(np.median(np.diff(self.time)))
        self._replay: Replay | None = None
        has_motion = set(NEEDED) <= set(self.first.groups)
        moving = {"ring": self.first.ring_moves, "housing": self.first.housing_moves}
        needed = {*NEEDED, *(group for group, moves in moving.items() if moves)}
        self.has_states = len(self.parts) == 1 and needed <= set(self.first.groups)
        """Whether a piece may begin at any record."""
        self.window = self.first.settling().time if has_motion else float(self.time[0])
        """Begin of the averages of the run (s)."""
        self.whole = Piece(0, float(self.time[0]), float(self.time[0]), float(self.time[-1]))
        self.values = self._numbers(self.parts, self.whole.since, self.window)
        self._random = np.random.default_rng(20)
        spent = self.first.stats.get("stepping_s") or self.first.stats.get("wall_s")
        self.took = float(spent) / self.length if spent else UNKNOWN_COST
        """Time of a second of the bearing with the run's own tolerances (s): that of the run, then of the latest repetition."""

    @property
    def why_not(self) -> str:
        """Why the run cannot be repeated; empty where it can."""
        if self.subject is None:
            return "a bearing on a shaft is repeated with the others, by the result of all of them, and not from seats alone"
        if not self.length > 0.0:
            return "its records are of one instant"
        if any(part.scene.modes_from_file for part in self.parts.values()):
            return "the modes of its cage come from another file, which the check of a result does not open"
        return ""

    @property
    def length(self) -> float:
        """Length of the run (s)."""
        return float(self.time[-1] - self.time[0])

    def expected(self, piece: Piece) -> float:
        """Time that a repetition of a piece with the run's own tolerances is expected to take (s)."""
        return self.took * (piece.until - piece.begin)

    def sample(self, piece: Piece) -> Sample:
        """A piece with the numbers of the run itself, if it has records enough there."""
        if piece == self.whole:
            return Sample(piece, [self.values])
        if int(np.sum((self.time >= piece.since) & (self.time <= piece.until))) < LEAST_RECORDS:
            return Sample(piece)
        parts = {name: part.window(piece.begin, piece.until) for name, part in self.parts.items()}
        return Sample(piece, [self._numbers(parts, piece.since, piece.since)])

    def own(self, sample: Sample, until: float = math.inf) -> bool:
        """Repeat a piece with the run's own tolerances from a state that is moved. False where that did not come to its end, or
        not up to a processor time (s).
        """
        found = self._repeat_own(sample.piece, until)
        if found is None or not _reached(found, sample.piece):
            return False
        self._add(sample, sample.own, found)
        return True

    def pair(self, sample: Sample, *, shifted: bool, until: float = math.inf) -> bool:
        """Repeat a piece with the run's own tolerances from a state that is moved, and with tighter ones, from such a state if
        `shifted`. False where a repetition failed.

        Both end at a processor time (s) at the latest, that of the own tolerances when half of what is left has passed. The
        sample then is of the shorter piece that both have come through, if it is long enough to be compared and nothing was
        measured of the longer one.
        """
        piece, half = sample.piece, 0.5 * (clock.process_time() + until)
        own = self._repeat_own(piece, half)
        tight = None if own is None else self._repeat(piece, self._tight, shifted=shifted, until=until)
        if own is None or tight is None:
            return False
        if not (_reached(own, piece) and _reached(tight, piece)):
            times = min((_times(own), _times(tight)), key=len)
            reached = float(times[-1])
            if sample.tight or int(np.sum(times >= piece.since)) < LEAST_RECORDS:
                return False
            sample.piece = replace(piece, until=reached)
            sample.own = self.sample(sample.piece).own
            own, tight = (
                {name: part.window(piece.begin, reached) for name, part in one.items()} for one in (own, tight)
            )
        self._add(sample, sample.own, own)
        self._add(sample, sample.tight, tight)
        return True

    def _repeat_own(self, piece: Piece, until: float) -> Mapping[str, Result] | None:
        began = clock.process_time()
        found = self._repeat(piece, self._own, shifted=True, until=until)
        if found is not None and (length := float(_times(found)[-1]) - piece.begin) > 0.0:
            self.took = (clock.process_time() - began) / length
        return found

    def _add(self, sample: Sample, to: list[dict[str, float]], parts: Mapping[str, Result]) -> None:
        piece = sample.piece
        to.append(self._numbers(parts, piece.since, self.window if piece == self.whole else piece.since))

    def _repeat(
        self, piece: Piece, options: Mapping[str, Any], *, shifted: bool, until: float
    ) -> Mapping[str, Result] | None:
        """A repetition of a piece with these options, not watched, up to a processor time (s); None where it fails."""
        assert self.subject is not None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            sim: Simulation[Any] = Simulation(self.subject, **options)
            vector = sim.state.vector
            if piece.record or not math.isclose(piece.begin, sim.time, abs_tol=1e-12):
                self._replay = self._replay or Replay(self.first)
                vector = self._replay.state(piece.record)
            if shifted:
                vector = moved(vector, self._random)
            sim.set_state(vector, piece.begin)
            every = min(self._every, (piece.until - piece.since) / (2 * LEAST_RECORDS))
            times = output_times(piece.begin, piece.until, every)
            settings = sim.options.replace(save_every=every, save_groups=self.first.groups)
            try:
                run = Run(sim, settings, times, lambda _: clock.process_time() > until, watched=False, look_every=1)
                found = run.go(progress=False).by_name
            except StepError:
                return None
        if next(iter(found.values())).message.startswith(STOPPED):
            raise KeyboardInterrupt  # a run keeps what it has; a check that is stopped has nothing to say
        return found

    def _numbers(self, parts: Mapping[str, Result], since: float, averaged: float) -> dict[str, float]:
        """Extremes from a time (s) on, and averages from another one on; of several bearings with their names."""
        found: dict[str, float] = {}
        for name, part in parts.items():
            seen = Seen(part if since <= part["time"][0] else part.window(since), part.window(averaged))
            values = {row.name: seen.value(row) for row in self.rows}
            found |= {
                f"{name}_{key}" if name else key: float(value)
                for key, value in values.items()
                if value is not None and math.isfinite(value)
            }
        return found


def _times(parts: Mapping[str, Result]) -> NDArray[np.float64]:
    return next(iter(parts.values())).time


def _reached(parts: Mapping[str, Result], piece: Piece) -> bool:
    return math.isclose(_times(parts)[-1], piece.until, rel_tol=1e-9)


def pieces(run: Repeating, most: float) -> Iterator[Piece]:
    """Pieces of a run, of a bearing time of at most so much in all (s), in the order in which they are to be repeated: its start,
    the jumps of its loads and speeds, and evenly spread ones.
    """
    begin, end = run.whole.begin, run.whole.until
    speed = float(np.abs(run.first.turning_speed).mean())
    turn = 2.0 * math.pi / speed if speed > 0.0 else run.length / STRATA
    length = min(max(turn, 2.0 * LEFT_OUT), most / 3.0 if run.has_states else most, run.length)
    yield _piece(run, begin, begin, begin + length)
    if not run.has_states:
        return
    for first, last in _jumps(run):
        yield _piece(run, first - LEFT_OUT, first - LEFT_OUT, last + AFTER_JUMP * turn)
    lead = min(LEFT_OUT, 0.5 * length)
    starts = np.linspace(run.window, end - length - lead, STRATA)
    for start in map(float, starts[[0, 4, 2, 6, 1, 5, 3, 7]]):
        if begin < start < end - length:
            yield _piece(run, start, start + lead, start + lead + length)


def _piece(run: Repeating, begin: float, since: float, until: float) -> Piece:
    """A piece that begins at a record; it keeps its length where the record lies before."""
    record = max(int(np.searchsorted(run.time, begin, "right")) - 1, 0)
    first = float(run.time[record])
    return Piece(record, first, first + since - begin, min(max(first + until - begin, first), run.whole.until))


def _jumps(run: Repeating) -> list[tuple[float, float]]:
    """First and last instant of each change of a load or a speed that does not repeat (s); knots close together are one."""
    given = run.first.scene.quantities().values()
    knots = np.unique(np.concatenate([[], *(q.times for q in given if isinstance(q, History) and not q.repeats)]))
    knots = knots[(knots > run.whole.begin) & (knots < run.whole.until)]
    chains = np.split(knots, np.flatnonzero(np.diff(knots) > 2.0 * LEFT_OUT) + 1)
    return [(float(chain[0]), float(chain[-1])) for chain in chains if chain.size]
