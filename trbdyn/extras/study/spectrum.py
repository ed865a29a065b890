"""`trbdyn.spectrum`: load cases of a table, or of a time series by its classes of load and speed."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from trbdyn.base.own_files import file_path
from trbdyn.base.reading import MOST_CASES, read_input_text
from trbdyn.base.validation import as_number, whole_number_of
from trbdyn.errors import FileError, InputError
from trbdyn.extras.study.definition import Base
from trbdyn.model.assembly import Subject
from trbdyn.model.spectrum import LoadCase, Spectrum

OWN_COLUMNS: Final = ("name", "share")
MOST_COLUMNS: Final = 100


def spectrum(
    base: Subject | Mapping[str, Any] | str | Path, table: str | Path | Sequence[Mapping[str, Any]]
) -> Spectrum:
    """Load cases of a table with the share of time of each.

    Parameters
    ----------
    base : Scene, Assembly, mapping or path-like
        What the cases change: a subject, the tables of a case, or the name of one.
    table : path-like or sequence of mapping
        A CSV file, or its rows. Semicolons or tabs between its cells are taken, too; numbers may then have decimal commas.
        Columns: ``share``, the time of the case in hours, percent or any other unit; ``name``; every other one is the path
        of a value as in a study, ``loads[0].force[1]``, where ``scene.`` or ``assembly.`` may be left out:
        ``speed_rpm``, ``axial_load``. An empty cell leaves the value of the base. Lines that begin with # are left out.

    Returns
    -------
    Spectrum
        For `trbdyn.rating`.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If a path does not exist or a value is not allowed; the message names the case.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.Scene(trb.Bearing.named("32208"), speed_rpm=1000, axial_load=2000.0)
    >>> cases = [
    ...     {"name": "idle", "share": 80, "speed_rpm": 800, "axial_load": 1500.0},
    ...     {"name": "full", "share": 20, "speed_rpm": 1500, "axial_load": 9000.0},
    ... ]
    >>> found = trb.rating(trb.spectrum(scene, cases))
    >>> found.worst, round(found.life_hours, -2)
    ('full', 15200.0)
    """
    if isinstance(table, str | Path):
        file = file_path(table, "table")
        rows: list[dict[str, Any]] = [*table_rows(read_input_text(file, "CSV"), str(file))]
    else:
        rows = [dict(row) for row in table]
    made = Base.of(base)
    main = next((name for name in ("assembly", "scene") if name in made.tables), "scene")
    cases = []
    for index, row in enumerate(rows):
        name = str(row.get("name") or f"case {index + 1}")
        if row.get("share") in (None, ""):
            raise InputError.of(("cases", index, "share"), None, f"must be given: the time of {name}")
        changes = {
            key if "." in key or "[" in key else f"{main}.{key}": _value(key, cell)
            for key, cell in row.items()
            if key not in OWN_COLUMNS and cell not in (None, "")
        }
        try:
            subject, _ = made.build(changes, held=False)
        except InputError as error:
            raise error.under(("cases", index)) from None
        cases.append(LoadCase(name, _number("share", row["share"]), subject))
    return Spectrum(cases)


def series_table(
    time: Sequence[float], columns: Mapping[str, Sequence[float]], *, classes: int = 10
) -> list[dict[str, Any]]:
    """The rows of a table for `spectrum` from a time series: how long loads and speeds lie in which class.

    Bearings tire by revolutions under load, so what counts is how long a load acts at which speed, not how often it swings:
    that is what a load-duration distribution says, and what is lost by counting cycles (rainflow). Every column is cut into
    classes of equal width; a case is a set of classes in which the series is at the same time, with its mean values there.

    Parameters
    ----------
    time : sequence of float, shape (T,)
        Times of the samples (s), ascending.
    columns : mapping of str to sequence of float, shape (T,)
        Values by the path of a column of the table.
    classes : int
        Classes of each column. The life converges with their number.

    Returns
    -------
    list of dict
        With ``name``, ``share`` in seconds, and the columns.

    Raises
    ------
    InputError
        If lengths differ, times do not ascend, or a number is not finite.

    Examples
    --------
    >>> import trbdyn as trb
    >>> rows = trb.series_table([0.0, 1.0, 2.0, 3.0], {"axial_load": [1000.0, 1000.0, 5000.0, 5000.0]}, classes=2)
    >>> [(row["share"], row["axial_load"]) for row in rows]
    [(1.5, 1000.0), (1.5, 5000.0)]
    """
    at = np.asarray(time, dtype=float)
    if at.ndim != 1 or at.size < 2 or not np.all(np.diff(at) > 0.0):
        raise InputError.of("time", at.size, "must have two samples or more, in ascending order (s)")
    classes = whole_number_of("classes", classes, 1, 1000)
    weights = np.gradient(at)
    weights[[0, -1]] *= 0.5
    places, values = [], {}
    for name, given in columns.items():
        values[name] = series = np.asarray(given, dtype=float)
        if series.shape != at.shape or not np.all(np.isfinite(series)):
            raise InputError.of(("columns", name), series.size, f"must have {at.size} finite numbers, as time has")
        low, high = series.min(), series.max()
        share = (series - low) / (high - low) if high > low else np.zeros(at.size)
        places.append(np.minimum((classes * share).astype(int), classes - 1))
    _, index = np.unique(np.array(places), axis=1, return_inverse=True)
    lasts = np.bincount(index.ravel(), weights=weights)
    means = {name: np.bincount(index.ravel(), weights=weights * one) / lasts for name, one in values.items()}
    return [
        {"name": f"class {k + 1}", "share": float(lasts[k]), **{name: float(one[k]) for name, one in means.items()}}
        for k in range(lasts.size)
    ]


def table_rows(text: str, name: str) -> list[dict[str, str]]:
    """Rows of a table with a head: cells lie between commas, semicolons or tabs. Where they lie between semicolons or tabs, a
    comma in a number is its decimal point.

    Raises
    ------
    FileError
        If a line cannot be read, or there are more cases than are taken.
    InputError
        If a row has not a cell for each column.
    """
    lines = [line for line in text.lstrip("\ufeff").splitlines() if line.strip() and not line.startswith("#")]
    mark = next((one for one in (";", "\t") if lines and one in lines[0]), ",")
    if len(lines) > MOST_CASES + 1:
        raise FileError(f"{name}: has {len(lines) - 1} load cases; {MOST_CASES} are taken")
    if lines and lines[0].count(mark) >= MOST_COLUMNS:
        raise FileError(f"{name}: has more than {MOST_COLUMNS} columns")
    try:
        rows = list(csv.DictReader(lines, delimiter=mark))
    except csv.Error as error:
        raise FileError(f"{name}: is no table: {error}") from None
    found = []
    for index, row in enumerate(rows):
        if None in row or None in row.values():
            raise InputError.of(("cases", index), len(row), "must have a cell for each column")
        cells = {key.strip(): cell.strip() for key, cell in row.items()}
        found.append({key: _point(cell) if mark != "," else cell for key, cell in cells.items()})
    return found


def _point(cell: str) -> str:
    """A number with a point in place of its comma; any other text as it is."""
    return cell.replace(",", ".") if re.fullmatch(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?", cell) else cell


def _value(key: str, cell: Any) -> Any:
    """A cell of a file as a number where it is one."""
    if not isinstance(cell, str):
        return cell
    try:
        return float(cell)
    except ValueError:
        return cell


def _number(key: str, cell: Any) -> float:
    try:
        return float(cell) if isinstance(cell, str) else as_number(cell)
    except ValueError as error:
        raise InputError.of(key, cell, f"must be a number: {error}") from None
