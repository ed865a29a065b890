"""The path of an inner ring that follows its load: through static equilibria, refined until it lies close to all of
them.

Between two times the path is a cubic (docs/theory/motion.md#the-inner-ring). Each interval is tested at its quarters:
where the cubic lies farther than `PATH_TOLERANCE` from the equilibrium, the interval is halved. Equilibria are solved
from their neighbours in time, which takes about a millisecond each. The slope at an interval's ends is that of the
quartic through its five equilibria.
"""

from __future__ import annotations

import bisect
import itertools
import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError, LoadError
from trbdyn.model.motion import History, is_constant, joint_times, knot_times, values_of
from trbdyn.model.scene import Scene
from trbdyn.statics.equilibrium import Equilibrium, EquilibriumSolver

Array = NDArray[np.float64]

PATH_TOLERANCE: Final = 3e-10
"""Largest distance of the ring's path from its equilibria (m); at half the pitch diameter for rotations. About 0.6 N of
radial force in a bearing of the 30310's size."""

_TESTED_TOLERANCE = 0.5 * PATH_TOLERANCE
"""Tolerance at the quarters of an interval (m): elsewhere in it the distance may be a little larger."""

_JOINT_TOLERANCE = PATH_TOLERANCE / 6.0
"""What the common slope of two intervals may add in each of them (m)."""

LARGEST_TURN_DEG: Final = 60.0
"""Bound of how far a load's direction may turn (deg) between two times at which the equilibrium is tested first."""

KNOTS_A_JOINT: Final = 2
"""Knots of a path from one joint to the next."""
KNOTS_A_JOINT_ROUND: Final = 16
"""The same where a load rotates: the ring then goes the same way again and again, and no step is large beside it."""

MOST_INTERVALS: Final = 200_000
"""Most intervals of a path: a larger one would take hours."""

SHORTEST_SHARE: Final = 1e-7
"""Shortest interval, as a share of the one between two knots of the histories."""

_SHOW_AFTER = 1.0
"""How long the search takes before a progress bar is shown (s)."""


@dataclass(frozen=True)
class _Piece:
    """An interval that is fine enough: its ends (s), and the path's slopes there, shape (5,)."""

    begin: float
    end: float
    first: Array
    last: Array


def find_path(
    scene: Scene, solver: EquilibriumSolver, at_start: Equilibrium
) -> tuple[list[float | History], Array | None]:
    """Displacement (m) and rotation (rad) of a ring that follows its load, five quantities in time, and its joints: the times
    (s) at which a part of what acts on the ring ends. Between them the knots only sample it.

    The bearing must carry the load at all times (`LoadError`, also where the ring jumps); too many turns are an `InputError`.
    """
    quantities = list(scene.ring_quantities().values())
    moves = scene.rotating_load is not None and scene.period is not None
    if all(scene.ring_is_placed) or not (moves or any(not is_constant(quantity) for quantity in quantities)):
        return list(at_start.displacement), None
    search = _Search(scene, solver, at_start)
    return search.path(), search.joints()


class _Search:
    def __init__(self, scene: Scene, solver: EquilibriumSolver, at_start: Equilibrium) -> None:
        self.scene, self.solver = scene, solver
        self.begin = scene.start.time
        self.quantities = list(scene.ring_quantities().values())
        # the path repeats with everything else, also with what does not act on the ring
        self.settled = scene.settled
        self.end = self.settled + (scene.period or 0.0)
        self.free = ~np.array(scene.ring_is_placed)
        arm = 0.5 * scene.bearing.pitch_diameter
        self.scale = np.array([1.0, 1.0, 1.0, arm, arm])[self.free]
        self.times = [self.begin]
        self.known = {self.begin: at_start}
        self.knots = [self.begin, self.end]

    def path(self) -> list[float | History]:
        from tqdm import tqdm

        if self.end <= self.begin:
            return list(self.at(self.begin).displacement)
        starts = self._first_times()
        with tqdm(
            total=self.end - self.begin,
            desc="the ring's path",
            delay=_SHOW_AFTER,
            disable=None,
            leave=False,
            bar_format="{desc} {percentage:3.0f}% |{bar}| {n:.4g}/{total:.4g} s [{elapsed}<{remaining}]",
        ) as bar:
            pieces: list[_Piece] = []
            for low, high in itertools.pairwise(starts):
                pieces += self.refine(float(low), float(high), bar)
            pieces = self._joined(pieces)
        return self._histories(pieces)

    def _first_times(self) -> Array:
        """Knots of what acts on the ring, and enough times between them that no turn of a load is missed."""
        knots = knot_times(self.quantities, self.begin, self.end)
        if self.scene.period is not None and self.begin < self.settled < self.end:
            knots = np.unique(np.append(knots, self.settled))
        times = [knots[:1]]
        total = 0.0
        for low, high in itertools.pairwise(knots):
            parts = max(2, math.ceil(self._turn(float(low), float(high)) / LARGEST_TURN_DEG))
            total += parts
            if total > MOST_INTERVALS:
                limit = f"turns the load more often than {MOST_INTERVALS} equilibria can follow; shorten the history"
                raise InputError.of("radial_direction_deg", "given", limit)
            times.append(low + (high - low) * np.arange(1, parts + 1) / parts)
            times[-1][-1] = high
        return np.concatenate(times)

    def joints(self) -> Array:
        """Joints of what acts on the ring, and, where a load turns, times between them that it takes for `LARGEST_TURN_DEG`."""
        ends = np.concatenate(
            [[self.begin], joint_times(self.quantities, self.begin, self.end), [self.settled, self.end]]
        )
        parts = [ends]
        for low, high in itertools.pairwise(np.unique(ends)):
            count = math.ceil(self._turn(float(low), float(high)) / LARGEST_TURN_DEG)
            parts.append(low + (high - low) * np.arange(1, count) / max(count, 1))
        times = np.array(sorted(self.knots))
        # the work on a ring is integrated beside the motion: where its path has many knots, that needs a step now and then
        parts.append(times[:: KNOTS_A_JOINT if self.scene.rotating_load is None else KNOTS_A_JOINT_ROUND])
        wanted = np.unique(np.concatenate(parts))
        # the knot of the path that is next to each
        place = np.clip(np.searchsorted(times, wanted), 1, len(times) - 1)
        place -= wanted - times[place - 1] < times[place] - wanted
        return times[place]

    def _turn(self, low: float, high: float) -> float:
        """A bound of how far the loads' directions turn between two times (deg); monotone curves have slopes up to 3
        means.
        """
        scene, turn = self.scene, 0.0
        direction = scene.radial_direction_deg
        if isinstance(direction, History):
            turn = 3.0 * abs(float(direction.value(high) - direction.value(low)))
        rotating = scene.rotating_load
        if rotating is not None:
            fastest = max(abs(speed) for speed in values_of(scene.speed_rpm)) / 60.0 * abs(rotating.turns)
            rate = fastest if rotating.frequency_hz is None else abs(rotating.frequency_hz)
            turn = max(turn, 360.0 * rate * (high - low))
        return turn

    def at(self, time: float) -> Equilibrium:
        """The equilibrium at a time, from a guess between or beyond its neighbours."""
        found = self.known.get(time)
        if found is not None:
            return found
        if len(self.times) > 8 * MOST_INTERVALS:
            limit = f"changes more than {MOST_INTERVALS} equilibria can follow; shorten the history"
            raise InputError.of("ring", "follows", limit)
        place = bisect.bisect(self.times, time)
        after = min(max(place, 1), len(self.times) - 1)
        before, beyond = self.times[max(after - 1, 0)], self.times[after]
        share = (time - before) / (beyond - before) if beyond > before else 0.0
        first, second = self.known[before], self.known[beyond]
        if not 0.0 <= share <= 2.0:  # a guess far beyond the last equilibrium is worse than that equilibrium itself
            first = second
        ring = first.displacement + share * (second.displacement - first.displacement)
        rollers = first.rollers + share * (second.rollers - first.rollers)
        found = self.solver.solve(time, near=(ring, rollers))
        self.times.insert(place, time)
        self.known[time] = found
        return found

    def refine(self, begin: float, end: float, bar: Any) -> list[_Piece]:
        """Pieces from `begin` to `end`, each within the tolerance at its quarters."""
        pieces: list[_Piece] = []
        shortest = max(SHORTEST_SHARE * (end - begin), 1e-14 * max(abs(begin), abs(end)))
        waiting = [(begin, end)]
        while waiting:
            low, high = waiting.pop()
            length = high - low
            values = np.array(
                [self.at(low + length * i / 4 if i < 4 else high).displacement[self.free] for i in range(5)]
            )
            first = (-25 * values[0] + 48 * values[1] - 36 * values[2] + 16 * values[3] - 3 * values[4]) / (3 * length)
            last = (25 * values[4] - 48 * values[3] + 36 * values[2] - 16 * values[1] + 3 * values[0]) / (3 * length)
            if self._off(values, first * length, last * length) <= _TESTED_TOLERANCE:
                pieces.append(_Piece(low, high, first, last))
                bar.update(length)
                continue
            if length <= shortest:
                raise LoadError(
                    f"the ring jumps at {low:.9g} s: its equilibria do not follow one another there; the bearing is about to "
                    "lose this load"
                )
            middle = low + length * 2 / 4
            waiting += [(middle, high), (low, middle)]
        return pieces

    def _off(self, values: Array, first: Array, last: Array) -> float:
        """Largest distance of the cubic from the equilibria at the quarters (m); slopes times the length."""
        worst = 0.0
        for i in (1, 2, 3):
            s = i / 4
            cubic = (1 + 2 * s) * (1 - s) ** 2 * values[0] + s * s * (3 - 2 * s) * values[4]
            cubic += s * (1 - s) ** 2 * first + s * s * (s - 1) * last
            worst = max(worst, float(np.max(np.abs(cubic - values[i]) * self.scale)))
        return worst

    def _joined(self, pieces: list[_Piece]) -> list[_Piece]:
        """The pieces, halved where the slopes of two neighbours do not agree: the mean of both is taken there."""
        from tqdm import tqdm

        quiet = tqdm(disable=True)
        while True:
            result: list[_Piece] = []
            for place, piece in enumerate(pieces):
                length, off = piece.end - piece.begin, 0.0
                for other, own in (
                    (pieces[place - 1].last if place else None, piece.first),
                    (pieces[place + 1].first if place + 1 < len(pieces) else None, piece.last),
                ):
                    if other is not None:
                        # the cubic of a slope of one has its largest value at a third: 4/27 of the length
                        off = max(off, float(np.max(0.5 * np.abs(other - own) * self.scale)) * length * 4 / 27)
                if off <= _JOINT_TOLERANCE:
                    result.append(piece)
                    continue
                middle = piece.begin + length * 2 / 4
                result += self.refine(piece.begin, middle, quiet) + self.refine(middle, piece.end, quiet)
            if len(result) == len(pieces):
                return result
            if len(result) > MOST_INTERVALS:
                raise LoadError(f"the ring's path has a bend that {MOST_INTERVALS} equilibria do not resolve")
            pieces = result

    def _histories(self, pieces: list[_Piece]) -> list[float | History]:
        times = np.array([piece.begin for piece in pieces] + [pieces[-1].end])
        self.knots = times.tolist()
        slopes = np.zeros((len(times), len(self.scale)))
        slopes[0], slopes[-1] = pieces[0].first, pieces[-1].last
        for place in range(1, len(pieces)):
            slopes[place] = 0.5 * (pieces[place - 1].last + pieces[place].first)
        values = np.array([self.at(float(time)).displacement for time in times])
        if self.scene.period is None:
            slopes[-1] = 0.0
        else:
            tail = int(np.argmin(np.abs(times - self.settled)))
            slopes[-1] = slopes[tail] = 0.5 * (slopes[-1] + slopes[tail])
            values[-1] = values[tail]
        found: list[float | History] = list(values[0])
        for column, axis in enumerate(np.flatnonzero(self.free)):
            found[axis] = History(times=tuple(times), values=tuple(values[:, axis]), slopes=tuple(slopes[:, column]))
        return found
