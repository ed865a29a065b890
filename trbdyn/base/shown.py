"""How objects show themselves: one table, as text in a terminal and as HTML in a notebook.

An object says what it shows (`Displayed._shown`), and this file renders it. A table is made of texts; notes stand below it, where
a long sentence widens no column; further tables that belong to it are folded away in a notebook.
"""

from __future__ import annotations

import html
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

HEAD: Final = ("name", "value", "unit", "meaning")
WIDTH: Final = 100
"""Characters of a line of a note."""
LONGEST_LIST: Final = 6
"""Most entries of a list that are written out."""

LONGEST_NUMBER: Final = 26
"""Most characters of a value that is not wrapped."""

_TABLE: Final = "border-collapse:collapse;margin:0.3em 0"
_CELL: Final = "text-align:left;vertical-align:top;padding:0.1em 0.8em 0.1em 0"
_NUMBER: Final = (
    "text-align:right;vertical-align:top;padding:0.1em 0.4em;white-space:nowrap;font-variant-numeric:tabular-nums"
)
_UNITS: Final = "m|N|1|rad|rpm|Pa|kg|deg|C|s|m/s2|N m|kg/m3|kg m2|kg m|1/Pa|1/K|Pa s|W/mK|s/m|m/s|N/m\\^1\\.5|N/m|mm2/s"


@dataclass(frozen=True)
class Shown:
    """What an object shows."""

    title: str = ""  # one line: what it is
    rows: tuple[tuple[str, ...], ...] = ()  # the table; a row may be shorter than `head`
    head: tuple[str, ...] = HEAD  # of the columns; a column "value" is set as numbers are
    notes: tuple[str, ...] = ()  # sentences below the table
    parts: tuple[Shown, ...] = ()  # further tables; a notebook folds them away, a terminal leaves them out

    def text(self, columns: int | None = None, *, names: bool = False) -> str:
        """The table for a terminal, or only so many of its columns; a unit stands beside its value. `names` puts those of the
        columns above them.
        """
        rows = (self.head, *self.rows) if names else self.rows
        cells = [_beside(row[:columns], self.head) for row in rows]
        widths = [max((len(row[k]) for row in cells if k < len(row) - 1), default=0) for k in range(len(self.head))]
        lines = [self.title] if self.title else []
        for row in cells:
            lines.append(
                "  ".join([*(cell.ljust(w) for cell, w in zip(row[:-1], widths, strict=False)), row[-1]]).rstrip()
            )
        return "\n".join(lines) + "".join(f"\n\n{textwrap.fill(note, WIDTH)}" for note in self.notes)

    def html(self) -> str:
        """The table for a notebook: plain HTML that takes colours and fonts of the page."""
        parts = [f"<div><b>{html.escape(self.title)}</b></div>"] if self.title else []
        if self.rows:
            head = "".join(f"<th style='{_style(name)}'>{html.escape(name)}</th>" for name in self.head)
            body = "".join(f"<tr>{self._cells(row)}</tr>" for row in self.rows)
            parts.append(f"<table style='{_TABLE}'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>")
        parts += [f"<p style='max-width:50em'>{html.escape(note)}</p>" for note in self.notes]
        for part in self.parts:
            inside = Shown(rows=part.rows, head=part.head, notes=part.notes, parts=part.parts).html()
            parts.append(f"<details><summary>{html.escape(part.title)}</summary>{inside}</details>")
        return f"<div class='trbdyn'>{''.join(parts)}</div>"

    def _cells(self, row: tuple[str, ...]) -> str:
        filled = (*row, *[""] * (len(self.head) - len(row)))
        return "".join(
            f"<td style='{_style(name, cell)}'>{_indented(cell)}</td>"
            for name, cell in zip(self.head, filled, strict=True)
        )


class Displayed:
    """Something that shows itself in a notebook."""

    def _shown(self) -> Shown:
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return self._shown().html()


class Tabled(Displayed):
    """Something that prints as the table it shows."""

    _headed = False
    """Whether the names of the columns are printed above them."""

    def __str__(self) -> str:
        return self._shown().text(names=self._headed)

    def __repr__(self) -> str:
        return str(self)


def _style(name: str, cell: str = "") -> str:
    """Numbers stand in line at the right; a sentence in their column wraps, so that it squeezes no other column."""
    if name == "value" and len(cell) <= LONGEST_NUMBER:
        return _NUMBER
    return f"{_CELL};white-space:nowrap" if name == "unit" else _CELL


def _indented(cell: str) -> str:
    """A cell whose leading spaces, which show what belongs to the row above, stay."""
    plain = cell.lstrip(" ")
    return "&emsp;" * ((len(cell) - len(plain)) // 2) + html.escape(plain)


def _beside(row: tuple[str, ...], head: tuple[str, ...]) -> list[str]:
    """A row whose unit stands in the column of its value."""
    if head[1:3] != ("value", "unit") or len(row) < 3:
        return list(row)
    return [row[0], f"{row[1]} {row[2]}".rstrip(), *row[3:]]


def value_text(value: Any) -> str:
    """A value of an input as text."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, float):
        return f"{value:.6g}"
    if type(value).__name__ == "History":
        return "changes in time"
    if hasattr(value, "model_fields_set"):
        faces = getattr(value, "faces", None)
        return f"{len(faces)} faces of its own" if faces is not None else type(value).__name__
    if isinstance(value, tuple):
        listed = [value_text(entry) for entry in value[:LONGEST_LIST]]
        return ", ".join(listed) + (f" and {len(value) - LONGEST_LIST} more" if len(value) > LONGEST_LIST else "")
    return "free" if value is None else str(value)


def field_texts(kind: Callable[..., Any]) -> dict[str, str]:
    """What each field of a model is, from the part "Parameters" of its docstring."""
    return {name: text for name, (_, text) in described_fields(kind).items()}


@cache
def described_fields(kind: Callable[..., Any]) -> Mapping[str, tuple[str, str]]:
    """What stands in the part "Parameters" of a docstring: of each field what values it has, and what it is."""
    text = inspect.cleandoc(kind.__doc__ or "")
    found = re.search(r"^Parameters\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", text, re.MULTILINE | re.DOTALL)
    out: dict[str, tuple[str, str]] = {}
    for entry in re.split(r"\n(?=\w)", found[1]) if found else ():
        head, _, body = entry.partition("\n")
        names, _, values = head.partition(" : ")
        out |= {name.strip(): (values, " ".join(body.split())) for name in names.split(",")}
    return out


def field_rows(model: Any, marks: Mapping[str, str] | None = None, prefix: str = "") -> Iterator[tuple[str, ...]]:
    """Rows of a model and of the models in it: path, which begins with `prefix`, value, unit, and meaning with the mark that
    `marks` has for the path, such as 'assumed'.
    """
    kind: type = type(model)
    texts = field_texts(kind)
    for name, info in type(model).model_fields.items():
        value, path = getattr(model, name), f"{prefix}{name}"
        if value is None or value == () or name == "estimates":
            continue
        if hasattr(value, "model_fields_set") and name != "pocket" and type(value).__name__ != "History":
            yield from field_rows(value, marks, f"{path}.")
            continue
        extra = info.json_schema_extra
        text = texts.get(name, "")
        unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
        unit = unit or (found[1] if (found := re.search(rf"\(({_UNITS})\)", text)) else "")
        mark = f" ({marks[path]})" if marks and path in marks else ""
        meaning = re.sub(rf"\s*\((?:{_UNITS})\)", "", text) + mark
        yield path, value_text(value), "" if unit == "1" else unit, meaning
