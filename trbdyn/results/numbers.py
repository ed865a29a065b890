"""The table of numbers: one row for each number of a run, which every summary, file, report, study and page reads.

A new number is one row: a `Number` with its function, in the file of `trbdyn.results.rows` that it belongs to. Whatever reads the
table does so when it is asked, and names no number by itself: the short lists are marks of the rows (`Number.shown`).

Names are those of the rows. Of several bearings on a shaft the name of the bearing stands before them (``left_torque``), and the
name alone is the number of the whole where `Number.together` says how it is made. A part of a table has its name behind that of
the row (``torque_by_loss_rolling``), and the half width of a confidence interval ``confidence_`` before it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar

from trbdyn.errors import InputError, unknown_name
from trbdyn.results.confidence import confidence
from trbdyn.results.number import Number, Place, Seen, part_values
from trbdyn.results.rows import cage, contacts, losses, ratings, run

if TYPE_CHECKING:
    from trbdyn.results.records import Records

R = TypeVar("R", bound="Records")

TABLE: Final[dict[str, Number]] = {
    row.name: row
    for row in (
        *run.BEGIN,
        *cage.MOTION,
        *cage.POCKETS,
        *contacts.LOADS,
        *contacts.PRESSURES,
        *ratings.RATINGS,
        *contacts.FILMS,
        *cage.SKEW,
        *losses.TORQUES,
        *run.COST,
        *run.SAID,
        *losses.NOTES,
        *losses.SPLITS,
    )
}
"""Every number by its name, in the order of tables. Cpr is the radial play of the cage, one-sided."""

ABOUT: Final = frozenset(row.name for row in (*run.BEGIN, *run.SAID))
"""Rows about a run and its numbers, which a part of it has not."""
SETTLING: Final = ("cage", "rollers")
"""Groups of records that tell whether the motion has settled."""
CONFIDENCE: Final = "confidence_"
"""Before the name of a number: the half width of its confidence interval."""


class Found(NamedTuple):
    """What a name in a dataset or a list means: the bearing that it begins with, the row, and what stands behind it."""

    bearing: str  # with the underline behind it; empty for one bearing alone and for the whole
    row: Number
    part: str  # entry of a table, or 'confidence'

    @property
    def words(self) -> str:
        """In words."""
        said = self.row.words.strip() or self.row.name
        if self.part == "confidence":
            said += ": half width of the 95 % confidence interval"
        elif self.part:
            said += f": {self.part.replace('_', ' ')}"
        return f"{self.bearing.removesuffix('_')}: {said}" if self.bearing else said

    @property
    def unit(self) -> str:
        """The SI unit; empty for pure numbers."""
        return self.row.unit


def rows(place: Place | None = None) -> list[Number]:
    """All rows, or those of a short list, in the order of tables."""
    return [row for row in TABLE.values() if place is None or place in row.shown]


def averages() -> dict[str, Number]:
    """Rows of averages that have confidence intervals, by their names."""
    return {row.name: row for row in TABLE.values() if row.interval}


def sums() -> tuple[str, ...]:
    """Averages of several bearings that can be added up."""
    return tuple(row.name for row in averages().values() if row.together == "sum")


def find(name: str, bearings: Iterable[str] = ()) -> Found | None:
    """What a name means, None if it is none of the table's; `bearings` are the names of those on a shaft."""
    for bearing in ("", *(f"{one}_" for one in bearings if one)):
        if not name.startswith(bearing):
            continue
        own = name.removeprefix(bearing)
        if own in TABLE:
            return Found(bearing, TABLE[own], "")
        if own.startswith(CONFIDENCE) and own.removeprefix(CONFIDENCE) in TABLE:
            return Found(bearing, TABLE[own.removeprefix(CONFIDENCE)], "confidence")
        for row in TABLE.values():
            if row.kind == "table" and own.startswith(f"{row.name}_"):
                return Found(bearing, row, own.removeprefix(f"{row.name}_"))
    return None


def check(name: str, *field: str, bearings: Iterable[str] = ()) -> Found:
    """What a name means. If it is none of the table's, an InputError at that field has the names that are nearest."""
    found = find(name, bearings)
    if found is None:
        every = [f"{one}_{row}" for one in bearings if one for row in TABLE] + list(TABLE)
        raise InputError.of(field, name, unknown_name(name, every))
    return found


def listed(place: Place, names: Iterable[object], bearings: Iterable[str] = ()) -> list[str]:
    """Those of some names that are numbers of a short list, of each bearing and of the whole, in the order of the table."""
    wanted, given = rows(place), [str(name) for name in names]
    ways = ["", *(f"{one}_" for one in bearings if one)]
    return [f"{way}{row.name}" for row in wanted for way in ways if f"{way}{row.name}" in given]


def of_picture(name: str) -> list[Number]:
    """Rows that the caption of a picture tells."""
    return [row for row in TABLE.values() if name in row.pictures]


def drawn_of(name: str, result: R, window_start: float | None) -> R:
    """Records that a picture is drawn of: those of the averages where it tells numbers of the window, else all."""
    told = of_picture(name)
    of_window = told and all(row.of == "window" for row in told)
    return result.window(window_start) if of_window and window_start is not None else result


def look(result: Records) -> Seen:
    """The records of a run, from which rows are computed."""
    return Seen(result, averages=averages().values())


def values(part: Records, names: Iterable[str]) -> dict[str, Any]:
    """Numbers over a part of the records that is run and window both, by their names; None where it does not have them."""
    return part_values(part, [TABLE[name] for name in names])


def all_averages(window: Records) -> dict[str, Any]:
    """Every number of the window that needs no more than its records, by its name; None where it does not have it."""
    seen = Seen.part(window)
    return {row.name: seen.value(row) for row in rows() if row.of == "window" and row.name not in ABOUT}


def half_widths(window: Records) -> dict[str, float]:
    """Half widths of the confidence intervals of the averages over a window whose motion has settled, as far as known."""
    seen = Seen.part(window)
    given = [row for row in averages().values() if not row.why_not(seen)]
    return confidence(window, given, part_values)[0] or {}


def of_table(found: Mapping[str, Any]) -> dict[str, Any]:
    """The entries of a summary with those of its tables as ``table_entry``."""
    out: dict[str, Any] = {}
    for name, value in found.items():
        out |= {f"{name}_{key}": part for key, part in value.items()} if isinstance(value, Mapping) else {name: value}
    return out
