"""A number of a run: one row of the table in `trbdyn.results.numbers`, and the records that its function reads."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal, Self

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import TrbError
from trbdyn.model.motion import is_constant
from trbdyn.results import observables
from trbdyn.results.confidence import confidence
from trbdyn.standards.loading import at_equilibrium
from trbdyn.standards.sheet import Rating, sheet

if TYPE_CHECKING:
    from trbdyn.results.peaks import Peaks
    from trbdyn.results.records import Records

Array = NDArray[np.float64]

Kind = Literal["mean", "rms", "percentile", "smallest", "largest", "time", "count", "state", "life", "table", "words"]
"""What a number is of the records that it is computed from."""
Place = Literal["result", "report", "shaft", "sweep", "page", "band", "ensemble"]
"""Short lists of numbers: a result in a notebook, the first table of a report, the table of bearings on a shaft, the tables of
``trbdyn sweep`` and of the page's sweep, the observables of `trbdyn.uncertainty` and of ``trbdyn ensemble``."""
NOWHERE: Final[frozenset[Place]] = frozenset()


@dataclass(frozen=True)
class Number:
    """A row of the table of numbers.

    Attributes
    ----------
    name : str
        Name in a summary, a JSON file, a dataset.
    words, unit, meaning : str
        How it is called in a table, its SI unit (empty for pure numbers), and a sentence that says what it means.
    value : callable
        Computes it from a `Seen`; None where these records do not tell it.
    kind : str
        Mean, root mean square, percentile, extreme, time of an extreme, count, state at the end, life, table or words.
    of : {'window', 'run'}
        Records that it is of: those after the transient, or all. Extremes, lives, static safety, counts and the audit of the
        energy are of the whole run.
    groups : tuple of str
        Groups of records that it needs; of alternatives, ``"energy|power"``, one is enough.
    exists : callable
        Whether a run has such a number at all: a scene without a cage has no orbit of one.
    least : float
        Size below which it means nothing, in its unit; 0 where each size does. Errors are shares of its size or of this.
    interval : {'', 'motion', 'load', 'loss'}
        Whether it is an average with a confidence interval: of the cage's motion, which must have settled; of what follows the
        load at once; of a loss, a part of which is the cage's.
    series : callable, optional
        For an average that is no mean: a series over the records of the window whose mean changes as the number, to first order.
    grows : float
        Power of the whirl's size that the number grows with; 2 as energies do, 1 for lengths of the whirl.
    together : {'', 'sum', 'smallest', 'same'}
        How the numbers of several bearings on a shaft make one of the shaft; '' where they do not.
    shown : frozenset of str
        Short lists that it stands in, see `Place`; every table of all numbers has it.
    printed : bool
        Whether tables show it; not where another row tells it.
    pictures : tuple of str
        Pictures whose captions tell it. A picture that tells numbers of the window is drawn of the window.
    source : str
        Where its definition or limit comes from.
    checked : bool
        Whether `trbdyn.check` measures what the tolerances do to it: its memory is short enough for pieces of a run.
    """

    name: str
    words: str
    unit: str
    meaning: str
    value: Callable[[Seen], Any]
    kind: Kind = "mean"
    of: Literal["window", "run"] = "window"
    groups: tuple[str, ...] = ()
    exists: Callable[[Seen], bool] = lambda seen: True
    least: float = 0.0
    interval: Literal["", "motion", "load", "loss"] = ""
    series: Callable[[Records], Array] | None = None
    grows: float = 2.0
    together: Literal["", "sum", "smallest", "same"] = ""
    shown: frozenset[Place] = NOWHERE
    printed: bool = True
    pictures: tuple[str, ...] = ()
    source: str = ""
    checked: bool = False

    def missing(self, groups: Iterable[str]) -> tuple[str, ...]:
        """Groups of records that it needs besides these."""
        known = set(groups)
        return tuple(need.partition("|")[0] for need in self.groups if not known & set(need.split("|")))

    def why_not(self, seen: Seen) -> str:
        """Why a run does not have it; empty where it has."""
        if (self.of == "window" or self.groups) and len(seen.run) < 2:
            return "it needs two records"
        if not self.exists(seen):
            return "the scene of this run has none"
        missing = self.missing(seen.run.groups)
        return f"it needs the group {', '.join(missing)} of records" if missing else ""


class Seen:
    """The records of a run as the functions of the table read them; what several of them need is computed once.

    Parameters
    ----------
    run : Records
        All records.
    window : Records, optional
        Those that averages are of; by default those after the transient, the second half of the run at least.
    averages : sequence of Number
        Rows with confidence intervals.
    """

    def __init__(self, run: Records, window: Records | None = None, averages: Iterable[Number] = ()) -> None:
        self.run = run
        self._window = window
        self._averages = tuple(averages)

    @classmethod
    def part(cls, window: Records) -> Self:
        """Records that are run and window both."""
        return cls(window, window)

    def value(self, row: Number) -> Any:
        """The number of a row; None where this run does not have it."""
        return None if row.why_not(self) else row.value(self)

    @cached_property
    def settling(self) -> observables.MotionSettling | None:
        """Whether the motion has settled; None where it was not recorded."""
        if not {"cage", "rollers"} <= set(self.run.groups) or len(self.run) < 2:
            return None
        return self.run.settling()

    @property
    def settled(self) -> bool:
        """Whether the motion is known to have settled."""
        return self.settling is not None and self.settling.settled

    @property
    def settling_reason(self) -> str:
        """Why it is not known to have settled; empty where it is."""
        return "the groups cage and rollers were not recorded" if self.settling is None else self.settling.reason

    @cached_property
    def window(self) -> Records:
        """Records that averages are of."""
        if self._window is not None:
            return self._window
        begin = float(self.run["time"][len(self.run) // 2]) if self.settling is None else self.settling.time
        return self.run.window(begin)

    @cached_property
    def intervals(self) -> tuple[dict[str, float] | None, str]:
        """Half widths of confidence intervals by the names of their numbers, and how they were found."""
        rows = [row for row in self._averages if not row.why_not(self)]
        return confidence(self.window, rows, part_values, "" if self.settled else self.settling_reason)

    @cached_property
    def orbit(self) -> Array:
        """Distance of the cage's centre from its mean place over the radial play."""
        return self.window.orbit_radius_over_cpr

    @cached_property
    def distance(self) -> Array:
        """Distance of the cage's centre from the bearing axis over the radial play."""
        return self.window.axis_distance_over_cpr

    @cached_property
    def motion(self) -> observables.CageMotion:
        """Class of the cage's motion."""
        return self.window.cage_motion

    @cached_property
    def power_split(self) -> dict[str, float]:
        """Mean power loss by mechanism (W)."""
        return self.window.power_split

    @cached_property
    def peaks(self) -> Peaks:
        """Extremes and means between the ends of steps, of the run."""
        return self.run.peaks

    @cached_property
    def audit(self) -> observables.EnergyAudit:
        """Audit of the energy over the run."""
        return self.run.energy_audit

    @cached_property
    def sheet(self) -> Rating | None:
        """The engineer's sheet of a scene with constant speed and loads."""
        return steady_sheet(self.run)


def part_values(part: Records, rows: Iterable[Number]) -> dict[str, Any]:
    """Numbers of some rows, which the run has, over a part of its records."""
    seen = Seen.part(part)
    return {row.name: row.value(seen) for row in rows}


def steady_sheet(result: Records) -> Rating | None:
    """The engineer's sheet (`trbdyn.rating`) of a scene whose speed and loads are constant; its equilibrium takes some 10 ms.

    None where they change, and of a bearing on a shaft, whose scene has no loads: there the records make the sheet.
    """
    scene = result.scene
    constant = all(is_constant(quantity) for quantity in scene.ring_quantities().values())
    if not constant or scene.rotating_load is not None or result.on_shaft:
        return None
    try:
        return sheet(scene, at_equilibrium(scene))
    except TrbError:
        return None


def of_whole(together: str, values: Iterable[Any]) -> Any:
    """One number of a shaft of the numbers of its bearings, by `Number.together`; None where one of them is not known."""
    given = list(values)
    if together == "smallest":
        return min((value for value in given if value is not None), default=None)
    if any(value is None for value in given):
        return None
    if together == "same":
        return given[0]
    if isinstance(given[0], Mapping):
        return {key: sum(one.get(key, 0.0) for one in given) for key in {key: None for one in given for key in one}}
    return sum(given)
