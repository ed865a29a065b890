"""A run that goes on until averages, or the cage's motion, are known as well as was asked for (`Simulation.run` with `until`).

From time to time the averages of the records so far are computed with their confidence intervals (`trbdyn.results.confidence`).
The run ends when each half width is below the wanted share of its average; there is none as long as the motion is not known to
have settled. Whoever looks often enough finds a narrow interval by chance, so a look is taken each time the run has become an
eighth longer, and the intervals must be narrow at two looks in a row. Looks lie at fixed records of the run, so that a run that
was cut off and resumed ends where it would have ended.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final

from trbdyn.errors import InputError
from trbdyn.results import numbers
from trbdyn.results.fields import contacts

if TYPE_CHECKING:
    from trbdyn.results.result import Result

CAGE: Final = "cage"
"""Name of what is none of the averages: the cage's motion, which has settled and whose orbit is known within a share of Cpr."""
OF_CAGE: Final = "orbit_rms_over_cpr"
"""Average by which it is judged."""
FIRST: Final = 0.02
"""Share of the longest run before the first look."""
GROWTH: Final = 1.125
"""Length of the run at a look over that at the look before."""
LEAST_RECORDS: Final = 50
"""Records before the first look."""


def check_wanted(wanted: Mapping[str, float], groups: tuple[str, ...], fields: Collection[str], has_cage: bool) -> None:
    """Check that the averages in `wanted` can be had with the groups that a run keeps and the fields that this bearing has. An
    InputError if a name is none of an average, or what an average needs is not kept or does not exist.
    """
    for name in wanted:
        if name != CAGE:
            check_average(name, "run", "until")
        side = next(
            (side for side in reversed(contacts()) if name in (f"{side}_load_mean", f"film_parameter_{side}")), ""
        )
        field = f"{side}_load" if name.endswith("_load_mean") else f"{side}_film_parameter"
        if side and field not in fields:
            raise InputError.of(
                ("run", "until"), name, f"needs a contact that this bearing does not have: {contacts()[side]}"
            )
        row = numbers.TABLE[OF_CAGE if name == CAGE else name]
        missing = sorted({*numbers.SETTLING, *row.missing(groups)} - set(groups))
        if missing:
            raise InputError.of(("run", "save_groups"), groups, f"must hold {', '.join(missing)} for until = {name}")
        if not has_cage and {"cage", "pocket"} & set(row.groups):
            raise InputError.of(("run", "until"), name, "needs a cage: effects.bodies = 'rollers_and_cage'")


def check_average(name: str, *field: str) -> None:
    """Check that a name is one of an average of the summary. If it is none, an InputError at that field has the name that is
    nearest.
    """
    known = numbers.averages()
    if name not in known:
        near = get_close_matches(str(name), known, 1)
        meant = f"did you mean {near[0]}? " if near else ""
        raise InputError.of(field, name, f"{meant}must name averages of the summary: {', '.join(known)}")


class Until:
    """Looks whether averages are known as well as was asked for, in a run of at most so many records. `wanted` has the largest
    half width over the size of each average, by the names of the summary.
    """

    def __init__(self, wanted: Mapping[str, float], records: int) -> None:
        self.wanted = dict(wanted)
        self.said = ""
        self._looks: list[int] = []
        at = max(FIRST * records, LEAST_RECORDS)
        while self.wanted and at < records:
            self._looks.append(math.ceil(at))
            at *= GROWTH

    def next_look(self, done: int) -> int | None:
        """Number of records at the next look after a number of records; None if no look is left."""
        return next((look for look in self._looks if look > done), None)

    def reached(self, done: int, so_far: Callable[[], Result]) -> bool:
        """Whether the run may end after a number of records; `so_far` gives them."""
        if done not in self._looks[1:]:
            return False
        result, before = so_far(), self._looks[self._looks.index(done) - 1]
        return self._is_narrow(result) and self._is_narrow(
            result.window(stop=float(result["time"][before - 1])), said=False
        )

    def _is_narrow(self, result: Result, *, said: bool = True) -> bool:
        values = result.summary()
        widths = values.get("confidence") or {}
        found = {
            name: _share(1.0, widths.get(OF_CAGE)) if name == CAGE else _share(values.get(name), widths.get(name))
            for name in self.wanted
        }
        if said:
            known = "; ".join(_words(name, share, self.wanted[name]) for name, share in found.items())
            unknown = not all(math.isfinite(share) for share in found.values())
            why = f". Intervals: {values['confidence_note'].removeprefix('they ')}" if unknown else ""
            self.said = known + why
        return all(share <= self.wanted[name] for name, share in found.items())


def _share(value: float | None, width: float | None) -> float:
    if value is None or width is None or value == 0.0:
        return math.inf
    return abs(width / value)


def _words(name: str, share: float, wanted: float) -> str:
    if name == CAGE:
        known = f"has settled within {share:.2g} Cpr" if math.isfinite(share) else "is not known to have settled"
        return f"the cage's motion {known}, {wanted:.2g} Cpr was asked for"
    known = f"is known within {100.0 * share:.2g} %" if math.isfinite(share) else "has no confidence interval"
    return f"{name} {known}, {100.0 * wanted:.2g} % was asked for"
