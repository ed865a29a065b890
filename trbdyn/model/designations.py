"""Bearings by their designation: boundary dimensions and ratings of a table with the source of each, the rest estimated.

The tables ship as `trbdyn/data/designations.csv` and `cylindrical_designations.csv`. A row that cannot be right is refused: its
factors must agree (e Y = 0.6), its C0 and C belong together, and its C must be one that a bearing of this size can have
(`USUAL_RATING`).
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any, Final

from trbdyn.base.own_files import file_path
from trbdyn.base.reading import read_input_text
from trbdyn.base.shipped import DATA
from trbdyn.base.shown import Shown, Tabled
from trbdyn.errors import FileError, InputError
from trbdyn.model.catalogue import fields_from_catalogue
from trbdyn.model.designation_names import cylinder, other_kind, plain_tapered
from trbdyn.model.estimated import Estimated

TABLE: Final = DATA / "designations.csv"
CYLINDERS: Final = DATA / "cylindrical_designations.csv"
COLUMNS: Final = ("name", "d", "D", "T", "C", "C0", "e", "Y", "source")
COLUMNS_OF_CYLINDERS: Final = ("name", "d", "D", "B", "C", "C0", "F", "source")
SOURCES: Final = {
    "NACHI": "NACHI, catalogues of its bearings",
    "SKF": "SKF, product tables",
    "ISB": "ISB, catalogue Tapered roller bearings, metric series and inches series",
    "URB": "URB, general catalogue v. 14 (2017)",
    "recalled": "recalled from makers' catalogues",
}
"""What the names in the column `source` stand for. Boundary dimensions are those of ISO 355 and ABMA 19.2."""
PAGES: Final = ("NACHI", "URB")
"""Sources that state e; with others it is recalled, or left open."""
RECALLED: Final = 0.03
"""Band of an e that was recalled (1): what makers' catalogues differ by."""
MOST_ROWS: Final = 20_000
"""Most lines of a table."""
USUAL_E: Final = (0.36, 0.27, 0.55)
"""e where none is known, and its band (1): median of the table's inch series, and what holds all but steep ones."""
USUAL_RATING: Final = (113.0, 0.65, 1.4)
"""C (N) over (T cos(alpha))^(7/9) H^(29/27) (dm/H)^(3/4) with the height H of the section and the mean diameter dm in mm, in the
form of ISO 281: median of the table, and shares of it that can be meant. The table has 0.74 to 1.21; newer bearings have up to a
quarter more.
"""


@dataclass(frozen=True)
class Designation(Tabled):
    """A row of the table.

    Attributes
    ----------
    name : str
        Designation: of a metric bearing five digits, of an inch series cone and cup.
    bore, outside, width : float
        d, D and T (m).
    C : float
        Basic dynamic load rating (N).
    C0, e, Y : float or None
        Basic static load rating (N), factors (1); None where the source does not state it.
    source : str
        Where the numbers come from.
    recalled_e : float or None
        e as recalled, no fact (1).
    flanges : str or None
        Type of a cylindrical bearing.
    F : float or None
        Diameter of the raceway of its inner ring (m).
    """

    name: str
    bore: float
    outside: float
    width: float
    C: float
    C0: float | None
    e: float | None
    Y: float | None
    source: str
    recalled_e: float | None = None
    flanges: str | None = None
    F: float | None = None

    def fields(self, **known: Any) -> dict[str, Any]:
        """Fields of the bearing; what is known better goes before the row, by the names of `Bearing.from_catalogue`.

        Raises
        ------
        InputError
            If the row cannot be right, or a number is not allowed.
        """
        page = {
            key: value
            for key in ("bore", "outside", "width", "C", "C0", "e", "Y", "flanges", "F")
            if (value := getattr(self, key)) is not None
        }
        if self.flanges is not None:
            return fields_from_catalogue({**page, "name": self.name, **known})
        told = self.e is not None or {"e", "Y", "contact_angle_deg"} & set(known)
        if {"e", "contact_angle_deg"} & set(known):
            page.pop("e", None), page.pop("Y", None)
        value, low, high = self._guess
        guess = {} if told else {"contact_angle_deg": _angle(value)}
        made = fields_from_catalogue({**page, "name": self.name, **guess, **known})
        self._check_rating(made["cup_half_angle_deg"])
        if not told:
            words = "e as recalled from makers' catalogues" if self.recalled_e is not None else "e not known: usual one"
            angle = Estimated.of(
                "cup_half_angle_deg",
                _angle(value),
                _angle(low),
                _angle(high),
                "deg",
                f"{words}; tan(alpha) = e/1.5 (ISO 281)",
            )
            made["estimates"] = (angle, *made["estimates"])
        return made

    @property
    def _guess(self) -> tuple[float, float, float]:
        if self.recalled_e is None:
            return USUAL_E
        return self.recalled_e, self.recalled_e - RECALLED, self.recalled_e + RECALLED

    def _check_rating(self, angle: float) -> None:
        height, mean = 500.0 * (self.outside - self.bore), 500.0 * (self.outside + self.bore)
        usual, low, high = USUAL_RATING
        size = (1e3 * self.width * math.cos(math.radians(angle))) ** (7.0 / 9.0) * height ** (29.0 / 27.0)
        rating = usual * size * (mean / height) ** 0.75
        if not low * rating <= self.C <= high * rating:
            limit = (
                f"must be from {low * rating:.3g} to {high * rating:.3g} for a bearing of this size, {low:g} to {high:g} times "
                f"the usual rating: the row {self.name} has slipped, or belongs to another bearing (N)"
            )
            raise InputError.of("C", self.C, limit)

    def _shown(self) -> Shown:
        rows = [
            ("bore d", f"{1e3 * self.bore:g}", "mm", "fact"),
            ("outside diameter D", f"{1e3 * self.outside:g}", "mm", "fact"),
            ("width T", f"{1e3 * self.width:g}", "mm", "fact"),
        ]
        mark = "fact of this maker" if self.source != SOURCES["recalled"] else "recalled"
        for words, value, unit in (("C", self.C, "N"), ("C0", self.C0, "N"), ("e", self.e, ""), ("Y", self.Y, "")):
            if value is not None:
                rows.append((words, f"{value:g}", unit, mark))
        if self.F is not None:
            rows.append(("raceway of the inner ring F", f"{1e3 * self.F:g}", "mm", "fact"))
        for one in self.fields()["estimates"]:
            factor, unit = (1e3, "mm") if one.unit == "m" else (1.0, "" if one.unit == "1" else one.unit)
            band = f"{factor * one.low:.4g} to {factor * one.high:.4g}"
            rows.append((one.path, f"{factor * one.value:.4g}", unit, f"estimated, {band}: {one.source}"))
        return Shown(
            f"Bearing {self.name}",
            tuple(rows),
            head=("name", "value", "unit", "fact or estimate"),
            notes=(self.source,),
        )


def designations(table: str | Path | None = None) -> dict[str, Designation]:
    """All rows of the tables by their designation: tapered bearings, and cylindrical ones, which are listed as NU.

    Parameters
    ----------
    table : path-like, optional
        A table of your own with the same columns: name, d, D, T (mm), C, C0 (kN), e, Y, source, or, of cylindrical bearings,
        name, d, D, B, C, C0, F, source; those that ship by default.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If a cell is no number, or a row lacks one that is needed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> sizes = trb.designations()
    >>> sorted(name for name, row in sizes.items() if row.bore == 0.040 and row.outside == 0.080)
    ['30208', '32208', '33208', 'NU208E', 'NU2208E']
    """
    if table is not None:
        return dict(_rows(file_path(table, "table")))
    return {**_rows(TABLE), **_rows(CYLINDERS)}


def designation(name: str, *, table: str | Path | None = None) -> Designation:
    """The row of a designation: which numbers are facts, with their source, and which are estimates, with their bands.

    Parameters
    ----------
    name : str
        A designation, such as ``"32208"``, with or without the letters of a maker that change neither size nor angle
        ("HR32208J", "32208 J2/Q"), or that of GOST ("7208A", "7508"); of an inch series cone and cup, ``"LM67048/LM67010"``,
        ``"LM67048 - LM67010"`` or ``"LM67048/10"``, or the cone where it has one cup; of a cylindrical bearing type and number,
        with or without letters of cage and maker (``"NU210"``, ``"NJ 210 ECP"``). Of the series that makers list as E alone
        today, E may be left out.
    table : path-like, optional
        A table of your own, as `designations` takes it.

    Raises
    ------
    InputError
        If there is no such row, or several.

    Examples
    --------
    >>> import trbdyn as trb
    >>> row = trb.designation("HR32208J")
    >>> row.name, row.bore, row.width, row.e
    ('32208', 0.04, 0.02475, 0.37)
    """
    rows = designations(table)
    if not isinstance(name, str):
        raise InputError.of("designation", name, "must be a text, such as '32208'")
    asked = name.upper().replace(" ", "")
    plain = plain_tapered(asked)
    for one in (asked, plain):
        if one in rows:
            return rows[one]
    if (kind := cylinder(asked)) is not None:
        flanges, number, reinforced = kind
        for row in (f"NU{number}{'E' if reinforced else ''}", *(() if reinforced else (f"NU{number}E",))):
            if row in rows:
                return _of_type(rows[row], flanges)
    cone, _, cup = asked.replace("-", "/").replace("\N{EN DASH}", "/").partition("/")
    found = [row for key, row in rows.items() if key.partition("/")[0] == cone and key.endswith(cup) and "/" in key]
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError.of("designation", name, f"must say which cup: {', '.join(row.name for row in found)}")
    if kind is None and (other := other_kind(asked)) is not None:
        limit = f"is {other}, by its number; this package has tapered and cylindrical roller bearings of one row"
        raise InputError.of("designation", name, limit)
    near = get_close_matches(asked if kind is not None else plain, [*rows, *_alike(rows, asked)], 4)
    hint = f"did you mean {', '.join(near)}? " if near else ""
    letters = "; letters that stand for another contact angle, such as B, are another bearing"
    letters = letters if near and kind is None else ""
    limit = f"is not in the table: {hint}Bearing.from_catalogue takes the numbers of its page{letters}"
    raise InputError.of("designation", name, limit)


def _of_type(row: Designation, flanges: str) -> Designation:
    """A row of NU as that of another type: what is known of the inner ring's raceway is not of N."""
    name = row.name.replace("NU", flanges, 1)
    return replace(row, name=name, flanges=flanges, F=None if flanges == "N" else row.F)


def _alike(rows: Mapping[str, Designation], asked: str) -> list[str]:
    """Names of cylindrical bearings of the type that was asked for."""
    kind = next((one for one in ("NUP", "NJ", "NU", "N") if asked.startswith(one)), "NU")
    return [row.name.replace("NU", kind, 1) for row in rows.values() if row.flanges is not None and kind != "NU"]


def _angle(e: float) -> float:
    return math.degrees(math.atan(e / 1.5))


@cache
def _rows(file: Path) -> Mapping[str, Designation]:
    lines = read_input_text(file, "CSV", field="table").splitlines()
    if len(lines) > MOST_ROWS:
        raise FileError(f"{file}: has {len(lines)} lines; {MOST_ROWS} are read")
    reader = csv.DictReader(line for line in lines if not line.startswith("#"))
    columns = COLUMNS_OF_CYLINDERS if "F" in (reader.fieldnames or ()) else COLUMNS
    missing = [name for name in columns if name not in (reader.fieldnames or ())]
    if missing:
        raise InputError.of("table", str(file), f"must have the columns {', '.join(columns)}; {missing[0]} is missing")
    return {row.name: row for row in (_row(cells) for cells in reader)}


def _row(cells: Mapping[str, str]) -> Designation:
    def number(column: str, over: float = 1.0) -> float | None:
        text = (cells.get(column) or "").strip()
        if not text:
            return None
        try:
            return float(text) / over
        except ValueError:
            raise InputError.of(("table", cells["name"], column), text, "must be a number") from None

    def needed(column: str, over: float = 1.0) -> float:
        value = number(column, over)
        if value is None or not 0.0 < value < math.inf:
            raise InputError.of(("table", cells["name"], column), value, "must be given, and > 0")
        return value

    tapered = "F" not in cells
    static, e, source = number("C0"), number("e"), (cells["source"] or "").strip()
    stated = source in PAGES or source not in SOURCES
    return Designation(
        name=cells["name"].strip().upper(),
        bore=needed("d", 1e3),
        outside=needed("D", 1e3),
        width=needed("T" if tapered else "B", 1e3),
        C=1e3 * needed("C"),
        C0=None if static is None else 1e3 * static,
        e=e if stated else None,
        Y=number("Y"),
        source=SOURCES.get(source, source),
        recalled_e=None if stated else e,
        flanges=None if tapered else "NU",
        F=number("F", 1e3),
    )
