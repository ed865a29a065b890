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
MOST_OWN: Final = 6
"""Repetitions with the run's own tolerances alone, at most, where the time does not allow another pair: they tell the scatter."""
LEFT_FOR_OWN: Final = 2
"""Of them, those that time is left for, if a fifth of all is enough for it."""

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
        Processor time that the check may take (s); by default 2 s, or a tenth of the time of the run if that is more. A
        repetition that takes longer ends there, and what it has come through is compared.

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
    >>> found = trb.check(result)
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
        reading = clock.process_time() - self.began
        self.end = self.began + max(budget - 3.0 * reading, 0.5 * budget)
        """Processor time at which a repetition ends (s): its numbers are read then, as those of the run were."""
        self.whole = False

    def go(self) -> Check:
        repeating = self.repeating
        if repeating.why_not:
            return Check({}, note=f"{NOTHING}{repeating.why_not}.")
        samples = self._repeated()
        samples = [one for one in samples if one.own and one.tight]
        self.whole = [one.piece for one in samples] == [repeating.whole]
        names = [name for name in repeating.values if all(one.has(name) for one in samples)] if samples else []
        numbers = {name: judged(name, samples) for name in names}
        covered = min(sum(one.piece.until - one.piece.begin for one in samples) / repeating.length, 1.0)
        pairs = sum(len(one.tight) for one in samples)
        spent = clock.process_time() - self.began
        return Check(numbers, pairs, covered, spent, self._note(samples, covered, spent), self._words())

    def _repeated(self) -> list[Sample]:
        """The whole run, if the time is expected to be enough for it, before or after a piece has shown what a tight repetition
        takes; else pieces of it.
        """
        repeating, length = self.repeating, self.repeating.length
        cost = repeating.took * (1.0 + DEARER)
        if cost * length <= self.budget:
            return self._again(repeating.sample(repeating.whole))
        chosen = pieces(repeating, self.budget / cost)
        before, first = clock.process_time(), self._once(next(chosen))
        now = clock.process_time()
        if first.tight and (now - before) * length / (first.piece.until - first.piece.begin) <= self.end - now:
            whole = self._again(repeating.sample(repeating.whole))
            return whole if whole[0].tight else [first]
        return self._each(first, now - before, chosen) if repeating.has_states else self._again(first)

    def _again(self, sample: Sample) -> list[Sample]:
        """Pairs of one piece, until its numbers are known or the time is over; what is left of the time then goes to repetitions
        with the run's own tolerances, as they are cheap and tell the scatter.
        """
        repeating, before = self.repeating, clock.process_time()
        until = self.end - min(LEFT_FOR_OWN * repeating.expected(sample.piece), 0.2 * self.budget)
        for pair in range(MOST_PAIRS):
            if not repeating.pair(sample, shifted=pair > 0, until=self.end if pair else until):
                break
            spent = clock.process_time() - before
            if self._known(sample) or spent * (pair + 2) / (pair + 1) > self.end - before:
                break
        for _ in range(MOST_OWN):
            left = self.end - clock.process_time()
            if not sample.tight or self._known(sample) or repeating.expected(sample.piece) > left:
                break
            repeating.own(sample, self.end)
        return [sample]

    def _once(self, piece: Piece) -> Sample:
        """One pair of a piece; and where the run has too few records in it, two repetitions as good as the run, which tell their
        scatter.
        """
        sample = self.repeating.sample(piece)
        if self.repeating.pair(sample, shifted=True, until=self.end) and len(sample.own) == 1:
            self.repeating.own(sample, self.end)
        return sample

    def _known(self, sample: Sample) -> bool:
        """Whether every number of a piece is known to be right, or to be wrong."""
        return all(judged(name, [sample]).answer != "unsettled" for name in sample.own[0] if sample.has(name))

    def _each(self, first: Sample, spent: float, others: Iterable[Piece]) -> list[Sample]:
        """A pair of each of the other pieces, too, as many as the time allows; the latest one took so much of it (s)."""
        samples = [first]
        for piece in others:
            before = clock.process_time()
            if before + spent > self.end:
                break
            samples.append(self._once(piece))
            spent = clock.process_time() - before
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
            return "Nothing could be checked: a repetition with tighter tolerances failed, or the time was too short for it."
        unseen = ""
        if self.whole:
            what = f"the whole run was repeated, {_times(len(samples[0].tight))}"
        elif len(samples) == 1 and samples[0].piece.begin == self.repeating.whole.begin:
            what = f"the first {100.0 * covered:.2g} % of the run were repeated, {_times(len(samples[0].tight))}"
            unseen = " what follows them (more time for the check covers more);"
        else:
            count = "one piece was" if len(samples) == 1 else f"{len(samples)} pieces were"
            what = f"{count} repeated from a state of the run, {100.0 * covered:.2g} % of it in all"
            unseen = " what the tolerances did before a piece began;"
        return (
            f"Measured at this run: {what}, with its own tolerances and with those of 'reference' or a tenth of them, in "
            f"{spent:.2g} s of processor time that are no part of the run's. Not checked:{unseen} {SLOW}; and "
            "errors of the model."
        )


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"
