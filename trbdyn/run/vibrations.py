"""Vibrations of rollers on their raceways: what the integration takes from them, and what that does to losses and loads.

A roller that was struck, or that hardly any load holds, vibrates on its raceways at some thousand cycles a second. What feeds the
vibration has to be taken again by the normal damping of the contacts. Steps that do not resolve the vibration take energy from
it, too (BDF damps what it does not follow); the vibrations are then smaller than they are in the bearing, and with them loads,
rolling resistance and slip. What is left of them does not show this, but what was taken does: the residual of the energy audit
stands beside the energy that damping took, and both together are what fed the vibrations. Where the integration's share is more
than `SHARE`, and large enough beside the elastic energy to matter, a piece of the run is repeated with much tighter tolerances,
and losses and loads of both are compared. Where they differ, a longer piece is repeated, which tells a difference from chance
(docs/theory/numerics.md#vibrations-that-steps-do-not-resolve).
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

SHARE: Final = 0.25
"""Share of the energy fed into vibrations that the integration may take in place of damping: so much of the vibrations, and of
what they do to losses and loads, is missing (N12)."""
GROWING: Final = 0.9
"""The same from which on vibrations would grow to more than ten times what is left of them, longer than a probe lasts (N12)."""
MEMORY: Final = 5e-3
"""Time over which vibrations add up before the damping of a lightly loaded contact takes them (s)."""
SIZE: Final = 0.01
"""Energy that is missing in `MEMORY`, over the elastic energy, below which it is too little to change a load."""
MOST: Final = 1.0
"""The same from which on vibrations are most of what the contacts hold, so that a probe of one piece scatters with them."""
SIZE_UNDAMPED: Final = 2e-4
"""The same where nothing damps: vibrations of rollers that carry hardly any load then change how long these roll in contact, and
with that the rolling resistance, while the elastic energy lies in others."""
LENGTH: Final = 20e-3
"""Bearing time of a probe at most (s)."""
LONGER: Final = 80e-3
"""The same of the one that repeats a difference."""
GROWTH: Final = 10e-3
"""Time at the beginning of a probe that is left to vibrations to grow to their size (s); half of a shorter one."""
SHORTEST: Final = 1e-3
"""Bearing time below which a comparison says nothing (s)."""
STEPS: Final = 20_000
"""Steps of a probe with tighter tolerances at most, or `STEPS_SHARE` of the simulation's own steps if that is more."""
STEPS_LONGER: Final = 60_000
"""The same of the longer one."""
STEPS_IN_ALL: Final = 80_000
"""The same of all probes of a simulation."""
STEPS_SHARE: Final = 0.05
LEAST_STEPS: Final = 2000
"""Steps below which no further probe is begun."""
INTERVAL: Final = 1e-4
"""Time between the instants at which a probe compares the loads (s)."""
BLOCKS: Final = 8
"""Pieces of a probe after its beginning, whose scatter says how well its difference is known."""
NOTABLE: Final = 0.02
"""Difference of the loss, or of the mean load of the rollers, from which on a run warns."""
OPEN: Final = 0.1
"""Difference that a probe must exclude."""
OPEN_UNCLEAR: Final = 0.05
"""The same where vibrations grow or are most of the loads."""
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
    """A piece of a run, repeated with tighter tolerances.

    Attributes
    ----------
    since, until : float
        The piece (s).
    loss, load : Difference
        Of the lost power, and of the mean load of a roller on the outer raceway.
    steps : int
        Steps that it took with the tighter tolerances.
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


def taken(missing: float, damped: float, elastic: float, span: float) -> tuple[float, float]:
    """Share of the vibrations' energy that the integration took, and what it took within `MEMORY` over the elastic energy.

    Parameters
    ----------
    missing : float
        Energy that the integration took, or made if negative (J).
    damped : float
        Energy that the normal damping of the contacts took (J).
    elastic : float
        Mean elastic energy (J).
    span : float
        Time (s).
    """
    share = abs(missing) / max(abs(missing) + max(damped, 0.0), 1e-300)
    return share, abs(missing) / max(span, 1e-300) * MEMORY / max(elastic, 1e-300)


def matter(share: float, size: float, *, damped: bool) -> bool:
    """Whether what the integration took may have changed loads and losses."""
    return share > SHARE and size > (SIZE if damped else SIZE_UNDAMPED)


def tighter(options: RunOptions) -> RunOptions:
    """Options with tolerances that resolve the vibrations of contacts: those of 'reference', or a tenth of smaller ones."""
    own, reference = options.tolerances.model_dump(), ACCURACY["reference"].model_dump()
    finest = all(own[name] < 2.0 * value for name, value in reference.items())
    values = {name: FINER * own[name] if finest else min(own[name], value) for name, value in reference.items()}
    return options.replace(accuracy="reference", **values)


def probe(
    sim: Simulation,
    bearing: SeatedBearing,
    time: float,
    vector: Array,
    most_steps: int,
    length: float = LENGTH,
    growth: float = GROWTH,
) -> Probe | None:
    """Repeat a piece of a run with its own tolerances and with tighter ones, which leaves the simulation as it is.

    Parameters
    ----------
    sim : Simulation
        Whose run it is.
    bearing : SeatedBearing
        Whose losses and loads are compared.
    time, vector : float, ndarray
        Where the piece begins (s), and the state there.
    most_steps : int
        Steps with the tighter tolerances.
    length : float
        Bearing time of the piece (s).
    growth : float
        Time at its beginning that is left to vibrations to grow (s).

    Returns
    -------
    Probe or None
        None where that many steps lead nowhere, or the tighter run fails.
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
    """The state at a knot of a load or speed, which steps end at: from an earlier one with the run's own tolerances.

    Parameters
    ----------
    sim : Simulation
        Whose run it is.
    time, vector : float, ndarray
        Where it begins (s), and the state there.
    until : float
        The time of the knot (s).
    most_steps : int
        Steps after which it is given up.

    Returns
    -------
    ndarray or None
        The state; None where it was not reached.
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
