"""Averages of a run of one bearing, or of several on a shaft.

Averages of several bearings have the names of their bearings before them: ``left_cage_slip``. Torque and power loss without such
a name are the sums over all bearings.

An error of an average is a share of its value, or of the least value that means anything where it is smaller. An orbit of the
cage of a hundred-thousandth of its play is no orbit, and six percent of it is no promise that anybody could keep or use.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from trbdyn.errors import InputError
from trbdyn.results import numbers
from trbdyn.run.until import check_average

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from trbdyn.model.assembly import Subject
    from trbdyn.results.assembly import AssemblyResult
    from trbdyn.results.observables import MotionSettling
    from trbdyn.results.result import Result


def least_size(name: str) -> float:
    """The least value of an average that means anything; 0 where each does."""
    return numbers.TABLE[of_bearing(name)[1]].least


def size_of(name: str, value: float) -> float:
    """What errors of an average are shares of."""
    return max(abs(value), least_size(name))


def prefixes(subject: Subject) -> tuple[str, ...]:
    """What the names of the averages of each bearing begin with: nothing where it is the only one."""
    return tuple(f"{name}_" if name else "" for name in subject.names)


def of_bearing(name: str) -> tuple[str, str]:
    """The beginning of a name, which says the bearing, and the average of the table (`trbdyn.results.numbers.averages`)."""
    own = max((one for one in numbers.averages() if name == one or name.endswith(f"_{one}")), key=len, default=name)
    return name.removesuffix(own), own


def groups_of(name: str) -> tuple[str, ...]:
    """Groups of records that an average needs: those that tell whether the motion has settled, and its own."""
    return (*numbers.SETTLING, *numbers.TABLE[of_bearing(name)[1]].missing(()))


def check_names(subject: Subject, names: Iterable[str]) -> None:
    """Refuse names that are no averages of the subject."""
    bearings, sums = prefixes(subject), numbers.sums()
    for name in names:
        bearing, own = of_bearing(name)
        check_average(own, "want")
        if bearing not in bearings and not (name in sums and len(bearings) > 1):
            limit = f"must begin with the name of a bearing ({', '.join(bearings)}), or be one of the sums {', '.join(sums)}"
            raise InputError.of("want", name, limit if len(bearings) > 1 else f"must be {own}: there is one bearing")


def joined(each: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Numbers of all bearings in one table, with the sums of several."""
    found = {f"{bearing}{name}": value for bearing, values in each.items() for name, value in values.items()}
    for name in numbers.sums() if len(each) > 1 else ():
        values = [one.get(name) for one in each.values()]
        if None not in values:
            found[name] = sum(values)
    return found


@dataclass(frozen=True)
class Records:
    """The records of a run of each bearing, by what the names of its averages begin with."""

    parts: Mapping[str, Result]

    @classmethod
    def of(cls, subject: Subject, result: Result | AssemblyResult) -> Records:
        """The records of a result of a scene or an assembly."""
        return cls(dict(zip(prefixes(subject), result.parts, strict=True)))

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the records (s), shape (T,)."""
        return next(iter(self.parts.values())).time

    def window(self, start: float = -math.inf, stop: float = math.inf) -> Records:
        """The records between two times (s), both included."""
        return Records({bearing: part.window(start, stop) for bearing, part in self.parts.items()})

    def averages(self) -> dict[str, Any]:
        """The averages over the records."""
        return joined({bearing: numbers.all_averages(part) for bearing, part in self.parts.items()})

    def half_widths(self) -> dict[str, float]:
        """Half widths of their 95 % confidence intervals, as far as they are known; of a sum the sum of those of its parts."""
        return joined({bearing: numbers.half_widths(part) for bearing, part in self.parts.items()})

    def settling(self) -> MotionSettling:
        """Whether the motion has settled; of several bearings of the one that has not, or that took longest."""
        found = [part.settling() for part in self.parts.values()]
        return max(found, key=lambda one: (not one.settled, one.time))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the watch over the run said."""
        return tuple(text for part in self.parts.values() for text in part.warnings)
