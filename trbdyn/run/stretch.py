"""A stretch of a simulation that is repeated while the simulation waits: with its own tolerances, and with tighter ones.

Losses of the stretch and the mean load of a roller are compared by the rule of `trbdyn.run.judged`: in parts of one
repetition, or over pairs of the whole stretch.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import InputError
from trbdyn.run.judged import MOST_PAIRS, Checked, Piece, Sample, judged, moved, tighter

if TYPE_CHECKING:
    from trbdyn.run.options import RunOptions
    from trbdyn.run.simulation import Simulation
    from trbdyn.statics.seat import SeatedBearing

Array = NDArray[np.float64]

SHORTEST: Final = 1e-3
"""Bearing time below which a comparison says nothing (s)."""
INTERVAL: Final = 1e-4
"""Time between the instants at which loads are compared (s)."""
PARTS: Final = 8
"""Parts of a stretch after its beginning, whose scatter tells how well a difference is known that was measured once."""
INSTANTS: Final = 20 * PARTS
"""Instants at which loads are compared, at least."""
WORDS: Final = {"loss": "the loss", "load": "the load of a roller"}
"""What is compared: the lost energy, and the mean load of the rollers on the outer raceway."""


@dataclass(frozen=True)
class Measured:
    """What the tolerances do to loss and load in a stretch between two times (s), by so many pairs, whose tight repetitions took
    some steps.
    """

    since: float
    until: float
    numbers: dict[str, Checked]
    pairs: int
    steps: int

    @property
    def clear(self) -> bool:
        """Whether loss and load are known to be right."""
        return all(one.answer == "clear" for one in self.numbers.values())

    @property
    def known(self) -> bool:
        """Whether both are known to be right, or one of them is known to be wrong: further pairs then change nothing."""
        return self.clear or any(one.answer == "biased" for one in self.numbers.values())

    def said(self) -> str:
        times = "" if self.pairs == 1 else f" {self.pairs} times"
        found = ", ".join(f"{WORDS[name]} is {one}" for name, one in self.numbers.items())
        return (
            f"{1e3 * (self.until - self.since):.2g} ms from {self.since:.6g} s on were repeated{times} with tighter tolerances "
            f"({self.steps} steps): beside them {found}"
        )


@dataclass(frozen=True)
class Stretch:
    """A stretch of a simulation, from a time (s) and a state on; what is compared begins `growth` (s) later."""

    sim: Simulation
    bearing: SeatedBearing
    begin: float
    state: Array
    length: float
    growth: float = 0.0

    def in_parts(self, most_steps: int) -> Measured | None:
        """Repeat it once, and compare parts of it; None where so many steps with tighter tolerances do not reach its end, or one
        of both repetitions fails.
        """
        pair = self._pair(most_steps)
        if pair is None:
            return None
        own, fine, steps = pair
        times, begin = self._times, self._first
        ends = np.linspace(begin, len(times) - 1, PARTS + 1).astype(int)
        piece = Piece(0, self.begin, float(times[begin]), self.begin + self.length)
        parts = [
            Sample(piece, [self._numbers(own[a : b + 1])], [self._numbers(fine[a : b + 1])])
            for a, b in pairwise(ends.tolist())
        ]
        return self._measured(parts, 1, steps)

    def in_pairs(self, most_steps: int) -> Measured | None:
        """Repeat it, at least twice, until loss and load are known to be right or wrong, or so many steps with tighter tolerances
        are taken; None where the second pair does not come to its end.
        """
        random = np.random.default_rng(20)
        sample = Sample(Piece(0, self.begin, float(self._times[self._first]), self.begin + self.length))
        steps, found = 0, None
        for number in range(MOST_PAIRS):
            # a second pair is needed in any case: the first one alone tells no scatter
            left = most_steps if not number else max(most_steps - steps, 2 * steps)
            pair = self._pair(left, random if number else None)
            if pair is None:
                break
            own, fine, taken = pair
            steps += taken
            sample.own.append(self._numbers(own[self._first :]))
            sample.tight.append(self._numbers(fine[self._first :]))
            if number:
                found = self._measured([sample], number + 1, steps)
                if found.known or steps * (number + 2) > most_steps * (number + 1):
                    break
        return found

    def state_at_end(self, most_steps: int) -> Array | None:
        """The state at its end, a knot of a load or speed, which steps end at; None where so many steps do not reach it."""
        return _run(
            self.sim, self.sim.options, np.array([self.begin, self.begin + self.length]), self.state, most_steps
        )[2]

    @property
    def _times(self) -> Array:
        return np.linspace(self.begin, self.begin + self.length, max(round(self.length / INTERVAL), INSTANTS) + 1)

    @property
    def _first(self) -> int:
        """Number of the instant from which on it is compared: after `growth`, or after half of it if that is less."""
        times = self._times
        return min(int(np.searchsorted(times, self.begin + (1.0 - 1e-9) * self.growth)), (len(times) - 1) // 2)

    def _pair(self, most_steps: int, random: np.random.Generator | None = None) -> tuple[Array, Array, int] | None:
        """Records with the run's own tolerances and with tighter ones, both from a moved state if there are random numbers; and
        the steps of the latter.
        """
        times, options = self._times, self.sim.options
        tight = options.replace(**tighter(options))
        fine, steps, _ = _run(self.sim, tight, times, self._start(random), most_steps)
        if len(fine) < len(times):
            return None
        own, _, _ = _run(self.sim, options, times, self._start(random), 4 * most_steps)
        return None if len(own) < len(times) else (own, fine, steps)

    def _start(self, random: np.random.Generator | None) -> Array:
        return self.state if random is None else moved(self.state, random)

    def _numbers(self, rows: Array) -> dict[str, float]:
        """Lost energy between the first and the last of some records (J), and the mean load of a roller (N)."""
        losses, load = [], slice(0, 0)
        for name, at, shape in self.bearing.record_layout:
            if name.startswith("loss_"):
                losses.append(at)
            if name == "outer_load":
                load = slice(at, at + math.prod(shape))
        return {"loss": float((rows[-1] - rows[0])[losses].sum()), "load": float(rows[:-1, load].mean())}

    def _measured(self, samples: Sequence[Sample], pairs: int, steps: int) -> Measured:
        numbers = {name: judged(name, samples) for name in WORDS}
        return Measured(self.begin, self.begin + self.length, numbers, pairs, steps)


def _run(
    sim: Simulation, options: RunOptions, times: Array, vector: Array, most_steps: int
) -> tuple[Array, int, Array | None]:
    """The records that were reached, the steps that it took, and the state at the last time, or None if it is not reached."""
    try:
        core = sim._seated.open(float(times[0]), vector, options.settings())
        rows = np.empty((times.size, core.row_length))
        try:
            reached, steps = core.run(times, rows, most_steps)
        except _core.CoreStepError as error:
            reached, steps = getattr(error, "rows", 0), most_steps
    except (InputError, ValueError):
        return np.empty((0, 0)), 0, None
    at_end = math.isclose(core.time, float(times[-1]), rel_tol=1e-9)
    return rows[:reached], steps, core.state() if at_end else None
