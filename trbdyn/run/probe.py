"""A piece of a run that is repeated with much tighter tolerances, to compare its losses and loads.

A longer piece tells a difference from chance (docs/theory/numerics.md#vibrations-that-steps-do-not-resolve).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import InputError
from trbdyn.run.options import ACCURACY, RunOptions

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation
    from trbdyn.statics.seat import SeatedBearing

Array = NDArray[np.float64]

SHORTEST: Final = 1e-3
"""Bearing time below which a comparison says nothing (s)."""
INTERVAL: Final = 1e-4
"""Time between the instants at which a probe compares the loads (s)."""
BLOCKS: Final = 8
"""Pieces of a probe after its beginning, whose scatter says how well its difference is known."""
NOTABLE: Final = 0.02
"""Difference of the loss, or of the mean load of the rollers, from which on a run warns."""
FINER: Final = 0.1
"""Factor of the tolerances where they are those of 'reference' already, or smaller."""


@dataclass(frozen=True)
class Difference:
    """How much larger a quantity is with tighter tolerances, relative to its value, and half of the 95 % confidence interval."""

    value: float
    half_width: float

    @property
    def within(self) -> float:
        """Bound of its size."""
        return abs(self.value) + self.half_width

    def notable(self, *, certain: bool) -> bool:
        """Whether it is said: beyond `NOTABLE`, and beyond the scatter of runs that are as good if it has to be `certain`."""
        return not abs(self.value) <= (max(NOTABLE, self.half_width) if certain else NOTABLE)

    def said(self, what: str) -> str:
        if abs(self.value) <= self.half_width:
            return f"{what} right within {100.0 * self.within:.2g} %"
        way = "low" if self.value > 0.0 else "high"
        return f"{what} {100.0 * abs(self.value):.2g} +/- {100.0 * self.half_width:.2g} % too {way}"


@dataclass(frozen=True)
class Probe:
    """A piece of a run (s), repeated with tighter tolerances in some steps: differences of the lost power, and of the mean load
    of a roller on the outer raceway.
    """

    since: float
    until: float
    loss: Difference
    load: Difference
    steps: int

    def notable(self, *, certain: bool) -> bool:
        """Whether a difference is said, see `Difference.notable`."""
        return self.loss.notable(certain=certain) or self.load.notable(certain=certain)

    def leaves(self, difference: float) -> bool:
        """Whether it leaves a difference of this size possible."""
        return not max(self.loss.within, self.load.within) <= difference

    def said(self) -> str:
        return (
            f"{1e3 * (self.until - self.since):.2g} ms from {self.since:.6g} s on were repeated with tighter tolerances "
            f"({self.steps} steps): beside them {self.loss.said('the loss is')}, {self.load.said('the load of a roller')}"
        )


def tighter(options: RunOptions) -> RunOptions:
    """Options with tolerances that resolve the vibrations of contacts: those of 'reference', or a tenth of smaller ones."""
    own, reference = options.tolerances.model_dump(), ACCURACY["reference"].model_dump()
    finest = all(own[name] < 2.0 * value for name, value in reference.items())
    values = {name: FINER * own[name] if finest else min(own[name], value) for name, value in reference.items()}
    return options.replace(accuracy="reference", **values)


def probe(
    sim: Simulation, bearing: SeatedBearing, time: float, vector: Array, most_steps: int, length: float, growth: float
) -> Probe | None:
    """Repeat a piece of a run, `length` (s) from a time (s) and a state on, with its own tolerances and with tighter ones.

    The simulation is left as it is. What is compared begins when vibrations have had the time `growth` (s) to grow. None where
    `most_steps` steps with the tighter tolerances lead nowhere, or the tighter run fails.
    """
    times = np.linspace(time, time + length, max(round(length / INTERVAL), 4 * BLOCKS) + 1)
    fine, steps = _run(sim, tighter(sim.options), times, vector, most_steps)
    rows = len(fine)
    if rows < 2 * BLOCKS + 1 or times[rows - 1] - time < SHORTEST:
        return None
    own, _ = _run(sim, sim.options, times[:rows], vector, 4 * most_steps)
    if len(own) < rows:
        return None
    return Probe(time, float(times[rows - 1]), *_compared(bearing, times[:rows], own, fine, growth), steps)


def reached(sim: Simulation, time: float, vector: Array, until: float, most_steps: int) -> Array | None:
    """The state at a knot of a load or speed (s), which steps end at: from an earlier time (s) and state on, with the run's own
    tolerances; None where so many steps do not reach it.
    """
    try:
        core = sim._seated.open(time, vector, sim.options.settings())
        rows = np.empty((1, core.row_length))
        core.run(np.array([until]), rows, most_steps)
    except (InputError, ValueError, _core.CoreStepError):
        return None
    return core.state() if math.isclose(core.time, until, rel_tol=1e-9) else None


def _run(sim: Simulation, options: RunOptions, times: Array, vector: Array, most_steps: int) -> tuple[Array, int]:
    """The records that were reached, and the steps that it took."""
    try:
        core = sim._seated.open(float(times[0]), vector, options.settings())
        rows = np.empty((times.size, core.row_length))
        try:
            reached, steps = core.run(times, rows, most_steps)
        except _core.CoreStepError as error:
            reached, steps = getattr(error, "rows", 0), most_steps
    except (InputError, ValueError):
        return np.empty((0, 0)), 0
    return rows[:reached], steps


def _compared(
    bearing: SeatedBearing, times: Array, own: Array, fine: Array, growth: float
) -> tuple[Difference, Difference]:
    """Differences of loss and load over a piece without its beginning, where vibrations grow to their size."""
    losses, load = [], slice(0, 0)
    for name, at, shape in bearing.record_layout:
        if name.startswith("loss_"):
            losses.append(at)
        if name == "outer_load":
            load = slice(at, at + math.prod(shape))
    begin = min(int(np.searchsorted(times, times[0] + (1.0 - 1e-9) * growth)), (len(times) - 1) // 2)
    ends = np.linspace(begin, len(times) - 1, BLOCKS + 1).astype(int)

    def means(rows: Array) -> tuple[Array, Array]:
        lost = np.diff(rows[ends][:, losses].sum(axis=1)) / np.diff(times[ends])
        loads = rows[:, load].mean(axis=1)
        return lost, np.array([loads[a:b].mean() for a, b in pairwise(ends)])

    first, second = (
        _difference(fine_means, own_means) for own_means, fine_means in zip(means(own), means(fine), strict=True)
    )
    return first, second


def _difference(fine: Array, own: Array) -> Difference:
    scale = max(abs(float(np.mean(own))), 1e-300)
    off = (fine - own) / scale
    # 2.36: Student's t of seven degrees of freedom
    return Difference(float(np.mean(off)), 2.36 * float(np.std(off, ddof=1)) / math.sqrt(off.size))
