"""A spectrum of load cases: what a machine does, and for which share of its time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from trbdyn.base.expected import expect
from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.scene import Scene


@dataclass(frozen=True)
class LoadCase:
    """A case of a spectrum.

    Attributes
    ----------
    name : str
        Its name.
    share : float
        Its time, in any unit that is the same for all cases: hours, percent, a share of 1.
    subject : Scene or Assembly
        Speed, loads and oil of the case.
    """

    name: str
    share: float
    subject: Subject


@dataclass(frozen=True)
class Spectrum(Displayed):
    """Load cases with their shares of time; `trbdyn.spectrum` makes one of a table or a time series, `trbdyn.rating` takes it.

    Attributes
    ----------
    cases : tuple of LoadCase
        Each with a name of its own, all with the same bearings.

    Raises
    ------
    InputError
        If there is no case, a name stands twice, or a share is not allowed.
    """

    cases: tuple[LoadCase, ...]

    def __init__(self, cases: Sequence[LoadCase]) -> None:
        expect("cases", cases, list, tuple)
        for index, one in enumerate(cases):
            expect(f"cases[{index}]", one, LoadCase)
            expect(f"cases[{index}].subject", one.subject, Scene, Assembly)
        object.__setattr__(self, "cases", tuple(cases))
        names = [one.name for one in self.cases]
        for index, one in enumerate(self.cases):
            if one.name in names[:index]:
                raise InputError.of(("cases", index, "name"), one.name, "must differ from the names of the other cases")
            if not 0.0 <= one.share < math.inf:
                raise InputError.of(("cases", index, "share"), one.share, "must be >= 0: the time of the case")
            if one.subject.names != self.cases[0].subject.names:
                raise InputError.of(("cases", index, "subject"), one.name, "must have the bearings of the first case")
        if not sum(one.share for one in self.cases) > 0.0:
            raise InputError.of("cases", len(names), "must have a share > 0 in one case at least")

    @property
    def shares(self) -> tuple[float, ...]:
        """Shares of the time, whose sum is 1."""
        total = sum(one.share for one in self.cases)
        return tuple(one.share / total for one in self.cases)

    def __len__(self) -> int:
        return len(self.cases)

    def _shown(self) -> Shown:
        rows = [
            (one.name, f"{100.0 * share:.4g}", one.subject.title)
            for one, share in zip(self.cases, self.shares, strict=True)
        ]
        head = ("case", "time %", "what")
        return Shown(f"Spectrum of {len(self)} load cases", (head, *rows), head=head)
