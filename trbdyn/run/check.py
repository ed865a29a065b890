"""How accurate the numbers of a run are: measured at that run, by repeating it.

The run, or pieces of it, is repeated in pairs: once with its own tolerances from a state that is moved by a millionth, and
once with those of 'reference' and every force exact (a tenth of them where the run itself had those of 'reference'). The
difference of both is what the tolerances do to a number, its bias; what repetitions that are as good differ by is its
scatter. Further pairs are made until every number is known to be right within `CLEAR`, or wrong beyond it, or the time that
was given is over. A number that still scatters too much then is called unsettled.

What a check cannot tell: errors of the model, and numbers whose memory is longer than the pieces, as the orbit of a cage that
creeps for seconds (docs/theory/numerics.md#check-of-a-run).
"""

from __future__ import annotations

import time as clock
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from trbdyn.base.shown import Displayed, Shown
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.results import numbers as table
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.judged import CLEAR, MOST_PAIRS, Checked, Piece, Sample, judged
from trbdyn.run.repeat import DEARER, Repeating, pieces

BUDGET_S: Final = 2.0
"""Processor time of a check (s), or `BUDGET_SHARE` of that of the run if it is more."""
BUDGET_SHARE: Final = 0.1

SLOW: Final = "orbit of the cage, spacing of the rollers and settling: their memory is longer than a check"


NOTHING: Final = "Nothing was checked: "
"""How the note begins of a run that cannot be repeated."""


@dataclass(frozen=True)
class Check(Displayed):
    """What `trbdyn.check` has found.

    Attributes
    ----------
    numbers : dict of str to Checked
        By the names of the summary; of bearings on a shaft with the bearing's name before it.
    pairs : int
        Repetitions with the run's own tolerances and with tighter ones, each.
    covered : float
        Share of the run that was repeated.
    spent_s : float
        Processor time of the check (s); it is no part of that of the run.
    note : str
        In a sentence what was done, and what it cannot tell.
    """

    numbers: Mapping[str, Checked]
    pairs: int = 0
    covered: float = 0.0
    spent_s: float = 0.0
    note: str = ""
    words: Mapping[str, str] = field(default_factory=dict)

    @property
    def answer(self) -> str:
        """The worst of the answers: 'biased', 'unsettled', 'clear', or 'unknown' where nothing was checked."""
        found = {one.answer for one in self.numbers.values()}
        return next((answer for answer in ("biased", "unsettled", "clear") if answer in found), "unknown")

    def of(self, bearing: str) -> dict[str, Checked]:
        """What was found of a bearing on a shaft, or of the only one by the name ''."""
        before = f"{bearing}_" if bearing else ""
        return {name.removeprefix(before): one for name, one in self.numbers.items() if name.startswith(before)}

    def said(self) -> list[str]:
        """For a reader of the numbers: those that are not known to be right, and what was done; nothing of no check."""
        doubted = "; ".join(self.doubts())
        known = f"Not known to be right within {100.0 * CLEAR:.2g} %: {doubted}." if doubted else ""
        return [text for text in (known, self.note) if text]

    def doubts(self) -> list[str]:
        """A sentence for each number that is not known to be right within `CLEAR`."""
        return [f"{self.words.get(name, name)}: {one}" for name, one in self.numbers.items() if one.answer != "clear"]

    def __repr__(self) -> str:
        return self._shown().text()

    def _shown(self) -> Shown:
        rows = tuple(
            (self.words.get(name, name), f"{100.0 * one.error:.2g}", "%", str(one))
            for name, one in self.numbers.items()
        )
        return Shown(f"Check of the run: {self.answer}", rows, ("number", "value", "unit", "meaning"), (self.note,))


def check(result: Result | AssemblyResult, *, budget_s: float | None = None) -> Check:
    """Measure how accurate the numbers of a run are, by repeating it or pieces of it.

    Parameters
    ----------
    result : Result or AssemblyResult
        The run, in memory or from a file.
    budget_s : float, optional
        Processor time that the check may take (s); by default 2 s, or a tenth of the time of the run if that is more. The
        pair that is begun is finished.

    Returns
    -------
    Check
        Bias, its interval and scatter of losses, torque, loads, films and forces in pockets.

    Raises
    ------
    InputError
        If `budget_s` is not positive, or the run has no records to compare.

    Notes
    -----
    Pieces of a run of bearings on a shaft, or of one that did not keep the motion of its bodies, begin at its start alone; what
    follows is not checked, and the note says so.

    Examples
    --------
    >>> import trbdyn as trb
    >>> result = trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).run(revolutions=0.2)
    >>> found = trb.check(result, budget_s=0.5)
    >>> found.numbers["torque"].answer
    'clear'
    """
    budget = _budget(result) if budget_s is None else number_of("budget_s", budget_s)
    if not budget > 0.0:
        raise InputError.of("budget_s", budget_s, "must be > 0 (s)")
    if result.time.size < 2:
        raise InputError.of("result", f"{result.time.size} records", "must have two records at least, to compare them")
    return _Checking(result, budget).go()


def _budget(result: Result | AssemblyResult) -> float:
    first = next(iter(result.by_name.values()))
    return max(BUDGET_S, BUDGET_SHARE * float(first.stats.get("stepping_s") or 0.0))


class _Checking:
    """One check: pairs of repetitions until all numbers are known or the time is over, and what they say."""

    def __init__(self, result: Result | AssemblyResult, budget: float) -> None:
        self.budget, self.began = budget, clock.process_time()
        self.repeating = Repeating(result, [row for row in table.rows() if row.checked])
        self.whole = False

    def go(self) -> Check:
        repeating = self.repeating
        if repeating.why_not:
            return Check({}, note=f"{NOTHING}{repeating.why_not}.")
        cost = repeating.cost_per_second * (1.0 + DEARER)
        length = repeating.length
        self.whole = cost * length <= self.budget
        if self.whole:
            samples = self._again(repeating.whole)
        elif not repeating.has_states:
            samples = self._again(next(pieces(repeating, self.budget / cost)))
        else:
            samples = self._each(pieces(repeating, self.budget / cost))
        samples = [one for one in samples if one.own and one.tight]
        names = [name for name in repeating.values if all(one.has(name) for one in samples)] if samples else []
        numbers = {name: judged(name, samples) for name in names}
        covered = min(sum(one.piece.until - one.piece.begin for one in samples) / length, 1.0)
        pairs = sum(len(one.tight) for one in samples)
        spent = clock.process_time() - self.began
        return Check(numbers, pairs, covered, spent, self._note(samples, covered, spent), self._words())

    def _again(self, piece: Piece) -> list[Sample]:
        """Pairs of one piece, until its numbers are known."""
        repeating = self.repeating
        sample = repeating.sample(piece)
        for pair in range(MOST_PAIRS):
            if not repeating.pair(sample, shifted=pair > 0):
                break
            if all(judged(name, [sample]).answer != "unsettled" for name in sample.own[0] if sample.has(name)):
                break
            if (clock.process_time() - self.began) * (pair + 2) / (pair + 1) > self.budget:
                break
        return [sample]

    def _each(self, all_pieces: Iterable[Piece]) -> list[Sample]:
        """A pair of each piece, as many as the time allows, at least one."""
        samples: list[Sample] = []
        for piece in all_pieces:
            before = clock.process_time()
            sample = self.repeating.sample(piece)
            self.repeating.pair(sample, shifted=True)
            samples.append(sample)
            now = clock.process_time()
            if now - self.began + (now - before) > self.budget:
                break
        return samples

    def _words(self) -> dict[str, str]:
        words = {row.name: row.words for row in self.repeating.rows}
        return {
            f"{name}_{key}" if name else key: f"{name}: {text}" if name else text
            for name in self.repeating.parts
            for key, text in words.items()
        }

    def _note(self, samples: Sequence[Sample], covered: float, spent: float) -> str:
        if not samples:
            return "Nothing could be checked: the repetitions with tighter tolerances did not come to their end."
        if self.whole:
            what = f"the whole run was repeated, {_times(len(samples[0].tight))}"
        elif not self.repeating.has_states:
            what = f"the first {100.0 * covered:.2g} % of the run were repeated, {_times(len(samples[0].tight))}"
        else:
            count = "one piece was" if len(samples) == 1 else f"{len(samples)} pieces were"
            what = f"{count} repeated from a state of the run, {100.0 * covered:.2g} % of it in all"
        older = "" if self.whole else " what the tolerances did before a piece began;"
        return (
            f"Measured at this run: {what}, with its own tolerances and with those of 'reference' or a tenth of them, in "
            f"{spent:.2g} s of processor time that are no part of the run's. Not checked:{older} {SLOW}; and errors of the model."
        )


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"
