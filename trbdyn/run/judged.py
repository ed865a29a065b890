"""What repetitions of a run say of the accuracy of a number: those with its own tolerances from states that are moved a little,
beside those with tighter ones (docs/theory/numerics.md#check-of-a-run).

The check that a user asks for (`trbdyn.run.check`) and the one that a run makes of itself where rollers vibrate
(`trbdyn.run.vibrations`) judge by this one rule.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from trbdyn.run.options import ACCURACY, RunOptions

CLEAR: Final = 0.03
"""Share of a number within which it must be known to be right."""
YARDSTICK: Final = 1e-3
"""Share of a number within which repetitions with tighter tolerances are right themselves (`benchmarks/check_held.py` compares
those of 'reference' with a tenth of them). No check can tell less."""
MOST_PAIRS: Final = 6
"""Pairs of repetitions of a whole run at most."""
MOVED: Final = 1e-6
"""Share by which the numbers of a state are moved: enough for bodies that hit each other to go ways of their own; a thousandth
would be another problem."""
FINER: Final = 0.1
"""Factor of tolerances that are those of 'reference' already."""


@dataclass(frozen=True)
class Piece:
    """A part of a run from a record on, between two times (s); it is compared from `since` on."""

    record: int
    begin: float
    since: float
    until: float


@dataclass
class Sample:
    """Numbers of a piece: of the run itself and of repetitions that are as good, and of tight ones."""

    piece: Piece
    own: list[dict[str, float]] = field(default_factory=list)
    tight: list[dict[str, float]] = field(default_factory=list)

    def has(self, name: str) -> bool:
        """Whether all of them have a number."""
        return all(name in run for run in (*self.own, *self.tight))


@dataclass(frozen=True)
class Checked:
    """What a check has found of a number.

    Attributes
    ----------
    bias : float
        What the tolerances of the run do to it, over its size: positive where the run has too much.
    half_width : float
        Half of the 95 % confidence interval of the bias, over the value.
    scatter : float
        Standard deviation over repetitions that are as good, over the value.
    degrees : int
        Degrees of freedom that the scatter is known by.
    answer : {'clear', 'biased', 'unsettled'}
        Known to be right within `CLEAR`; known to be wrong by more than the interval of its bias, and not known to be within
        `CLEAR`; or not known.
    """

    bias: float
    half_width: float
    scatter: float
    answer: str
    degrees: int

    @property
    def error(self) -> float:
        """Error over the value that the number may have in this run: of bias, its interval, the scatter, of which 95 of 100 runs
        keep within Student's t, and the repetitions with tighter tolerances themselves.
        """
        scatter = float(stdtrit(self.degrees, 0.975)) * self.scatter if self.degrees else math.inf
        return abs(self.bias) + self.half_width + scatter + YARDSTICK

    def __str__(self) -> str:
        low, high = (100.0 * (self.bias + sign * self.half_width) for sign in (-1.0, 1.0))
        if not self.error < 1.0:
            return "not known: it scatters too much, or too little of the run was repeated"
        if self.answer == "clear":
            return f"right within {100.0 * self.error:.2g} %"
        if self.answer == "biased":
            way = "high" if self.bias > 0.0 else "low"
            least, most = sorted(abs(end) for end in (low, high))
            return f"{least:.2g} to {most:.2g} % too {way} by the tolerances of the run"
        return f"not known better than within {100.0 * self.error:.2g} %"


def judged(name: str, samples: Sequence[Sample]) -> Checked:
    """Bias, its interval and scatter of a number: over pieces that are repeated once each, or over one that is repeated often."""
    sizes = [[abs(run[name]) for one in samples for run in runs(one)] for runs in (lambda s: s.own, lambda s: s.tight)]
    scale = max(float(np.mean(size)) for size in sizes)
    if scale == 0.0:
        return Checked(0.0, 0.0, 0.0, "clear", len(samples))
    squares, degrees = 0.0, 0
    for one in samples:
        for runs in (one.own, one.tight):
            values = np.array([run[name] for run in runs]) / scale
            squares += float(np.sum((values - values.mean()) ** 2))
            degrees += values.size - 1
    scatter = math.sqrt(squares / max(degrees, 1))
    off = np.array([(_mean(one.own, name) - _mean(one.tight, name)) / scale for one in samples])
    errors = [scatter**2 * (1.0 / len(one.own) + 1.0 / len(one.tight)) for one in samples]
    # pieces that differ by more than their own scatter tell how far others, which were not repeated, may be off
    between = float(np.var(off, ddof=1)) if off.size > 1 else 0.0
    error = max(float(np.mean(errors)), between) / off.size
    known = degrees if off.size == 1 else off.size - 1
    bias, half = float(off.mean()), float(stdtrit(known, 0.975)) * math.sqrt(error) if known else math.inf
    if abs(bias) + half < CLEAR:
        return Checked(bias, half, scatter, "clear", degrees)
    return Checked(bias, half, scatter, "biased" if abs(bias) > max(half, CLEAR) else "unsettled", degrees)


def _mean(runs: Sequence[Mapping[str, float]], name: str) -> float:
    return float(np.mean([run[name] for run in runs]))


def moved(vector: NDArray[np.float64], random: np.random.Generator) -> NDArray[np.float64]:
    """A state whose numbers are moved by `MOVED` of themselves."""
    shifted: NDArray[np.float64] = vector * (1.0 + MOVED * random.standard_normal(vector.size))
    return shifted


def tighter(options: RunOptions) -> dict[str, Any]:
    """Options of a repetition that is right: tolerances of 'reference', or a tenth of smaller ones, and every force exact."""
    own, reference = options.tolerances.model_dump(), ACCURACY["reference"].model_dump()
    finest = all(own[name] < 2.0 * value for name, value in reference.items())
    values = {name: FINER * own[name] if finest else min(own[name], value) for name, value in reference.items()}
    return {"accuracy": "reference", "rings_share": 0.0, "impact_share": None, **values}
