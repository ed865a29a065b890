"""The numbers of a run that an engineer asks for first: as a dictionary, as JSON, as a table.

Every number is a row of `trbdyn.results.numbers`, which says what records it is of. Averages are taken over the window after the
transient (``window_start`` to ``window_end``), half of the run at least; peaks, smallest films and impacts are those of the whole
run, with their times. Whether the motion has settled there is told in three answers, in ``settling``: settled, drifting (with its
time scale) or unknown, which means that it cannot be told from this run (see `Result.settling`). Lives and energies are those of
the whole run. What a scene does not have, what was not recorded and what does not exist (a whirl ratio at rest) is left out.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.base.display import displayed
from trbdyn.base.own_files import write_whole
from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import unknown_name
from trbdyn.results import numbers
from trbdyn.standards.sheet import life_text

if TYPE_CHECKING:
    from trbdyn.results.records import Records

NOTES: Final = "_note"
"""End of the names of sentences, which stand below a table."""


class Summary(dict[str, Any], Displayed):
    """The summary of a run: a dictionary of plain values that prints as a table with units.

    What the run does not have is left out; a `KeyError` for it says why.
    """

    def __init__(self, values: Mapping[str, Any], absent: Mapping[str, str] | None = None) -> None:
        super().__init__(values)
        self.absent = dict(absent or {})
        """Why rows of the table are left out, by their names."""

    def __missing__(self, name: str) -> Any:
        raise KeyError(f"{name}: {self.absent.get(name) or unknown_name(str(name), self)}")

    def __repr__(self) -> str:
        return table(self)

    __str__ = __repr__

    def _shown(self) -> Shown:
        return shown(self)


def summary(result: Records) -> Summary:
    """Summarise a run.

    Parameters
    ----------
    result : Records
        The run.

    Returns
    -------
    Summary
        A dictionary: numbers by the names of the rows of `trbdyn.results.numbers`, SI units; ``torque_split``, ``torque_by_loss``
        and ``power_split`` are dictionaries.
    """
    seen = numbers.look(result)
    found: dict[str, Any] = {}
    absent: dict[str, str] = {}
    for row in numbers.rows():
        why = row.why_not(seen)
        value = None if why else clean(row.value(seen))
        if value is None or value == {}:
            absent[row.name] = why or "these records do not tell it"
        else:
            found[row.name] = value
    return Summary(found, absent)


def clean(value: Any) -> Any:
    """Plain Python, as strict JSON takes it: numbers that are not finite become None."""
    if isinstance(value, Mapping):
        return {name: clean(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [clean(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_json(values: Mapping[str, Any], path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
    """Write a summary as JSON.

    Parameters
    ----------
    values : mapping
        What `summary` gave.
    path : path-like
        File to write.
    overwrite : bool
        Replace a file that is there.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    text = json.dumps(values, indent=2, allow_nan=False) + "\n"
    return write_whole(path, text, overwrite=overwrite, field="summary")


def table(values: Mapping[str, Any]) -> str:
    """A summary as a table for people: words, number, unit; entries that are None are left out, sentences follow the table."""
    return shown(values).text(columns=3)


def shown(values: Mapping[str, Any]) -> Shown:
    """A summary as a table: words, number, unit, and the name in the summary."""
    lines: list[tuple[str, ...]] = []
    below: list[str] = []
    for row in numbers.rows():
        value, words = values.get(row.name), row.words
        if value is None or not row.printed:
            continue
        if row.name == "settling":
            lines.append(("settled", _settled_words(values), "", row.name))
        elif row.name.endswith(NOTES):
            below.append(f"{words}: {value}")
        elif isinstance(value, Mapping):
            lines.append((words, "", "", row.name))
            lines.extend(
                (f"    {part.replace('_', ' ')}", *_number(entry, None, row.unit))
                for part, entry in value.items()
                if entry
            )
        else:
            number, unit = _number(value, (values.get("confidence") or {}).get(row.name), row.unit)
            lines.append((words, life_text(value) if row.unit == "h" else number, unit, row.name))
    return Shown(rows=tuple(lines), head=("quantity", "value", "unit", "name"), notes=tuple(below))


def _settled_words(values: Mapping[str, Any]) -> str:
    reason = values.get("settling_reason") or ""
    return {"settled": "yes", "drifting": "no, it drifts: "}.get(values["settling"], "cannot be told: ") + reason


def _number(value: Any, half_width: float | None, unit: str) -> tuple[str, str]:
    """A number with its interval, and the unit in which it is shown."""
    if isinstance(value, bool):
        return "yes" if value else "no", unit
    if not isinstance(value, float):
        return str(value), unit
    number, shown_unit = displayed(value, unit, 5)
    width = "" if half_width is None else f" ± {displayed(half_width, unit, 2, like=value)[0]}"
    return number + width, shown_unit
