"""The tables of a report: numbers with their meaning and the notes below them, inputs, and what differs between two scenes.

A cell holds a number, a unit or a few words. Sentences (a name of the summary that ends in ``_note`` or ``_reason``) stand below
the table, so that no table is wider than its page.
"""

from __future__ import annotations

import html
import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from trbdyn.base.display import plain, step_of
from trbdyn.base.shown import Shown
from trbdyn.reporting.inputs import Row
from trbdyn.results.number import Number
from trbdyn.results.numbers import rows
from trbdyn.run.judged import Checked
from trbdyn.standards.sheet import life_text

SENTENCES: Final = ("_note", "_reason")
"""Ends of the names of entries that are sentences."""
LEAST_DIFFERENCE: Final = 0.01
"""Share of a number by which two runs differ at least before it is said."""
MOST_DIFFERENCES: Final = 12
"""Inputs that differ between two runs which are not folded away."""
MINUS: Final = "\u2212"
LONGEST_NUMBER: Final = 24
"""Letters of a number with its interval, at most."""


def safe(text: object) -> str:
    """Text as HTML shows it."""
    return html.escape(str(text))


def differences(inputs: Sequence[list[Row]], names: Sequence[str]) -> str:
    """Inputs in which two scenes differ."""
    tables = [{row.path: row for row in listed} for listed in inputs]
    paths = [path for path in {**tables[0], **tables[1]} if _value(tables[0], path) != _value(tables[1], path)]
    if not paths:
        return "<h3>Inputs that differ</h3><p>All inputs of the two scenes are equal.</p>"
    body = "".join(
        f"<tr><td class='q'>{safe(path)}</td>"
        + "".join(f"<td class='n {_kind(_value(table, path))}'>{safe(_value(table, path))}</td>" for table in tables)
        + f"<td class='u'>{safe((tables[0].get(path) or tables[1][path]).unit)}</td></tr>"
        for path in paths
    )
    shown = f"<table>{heads_of('input', *names, 'unit')}{body}</table>"
    if len(paths) <= MOST_DIFFERENCES:
        return f"<h3>Inputs that differ</h3>{shown}"
    return f"<details><summary>{len(paths)} inputs that differ</summary>{shown}</details>"


def _value(table: Mapping[str, Row], path: str) -> str:
    return table[path].value if path in table else "-"


TEXTS: Final = ("", "unit", "what it means", "where it comes from", "what it is", "input", "name", "date", "signature")
"""Heads of columns that are no numbers, beside the first one."""


def heads_of(*words: str) -> str:
    """The head of a table, which each printed page repeats; above numbers it is set in line with them."""
    made = [f"<th{' class=n' if k and word not in TEXTS else ''}>{safe(word)}</th>" for k, word in enumerate(words)]
    return f"<thead><tr class='heads'>{''.join(made)}</tr></thead>"


def table_of(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table of texts: a name, numbers that are set in line, and the rest; a row may be shorter than its head."""
    body = "".join(
        f"<tr><td class='q'>{safe(row[0])}</td>"
        + "".join(
            f"<td class='{_column(name)}'>{safe(cell)}</td>" for name, cell in zip(head[1:], row[1:], strict=False)
        )
        + "</tr>"
        for row in rows
    )
    return f"<table>{heads_of(*head)}{body}</table>"


def further(shown: Sequence[Shown]) -> str:
    """Sections of tables that were given with a report: of fits, of a preload over temperature, of a least load."""
    return "".join(
        f"<h2>{safe(one.title)}</h2>{table_of(one.head, one.rows)}"
        + "".join(f"<h3>{safe(part.title)}</h3>{table_of(part.head, part.rows)}" for part in one.parts)
        + "".join(f"<p>{safe(note)}</p>" for note in one.notes)
        for one in shown
    )


def _column(name: str) -> str:
    return {"unit": "u", "where it comes from": "m"}.get(name, "n number")


def comparison(summaries: Sequence[Mapping[str, Any]], names: Sequence[str]) -> str:
    """What changes from the first run to the second, in one sentence."""
    more, less, same = [], [], []
    for row in rows("report"):
        key = row.name
        first, second = (values.get(key) for values in summaries)
        if not isinstance(first, float) or not isinstance(second, float) or first == 0.0:
            continue
        words = row.words.partition(" (")[0]
        change = difference(first, second, *((values.get("confidence") or {}).get(key) for values in summaries))
        if change.startswith("+"):
            more.append(f"{words} {change}")
        elif change[:1] == MINUS:
            less.append(f"{words} {change}")
        else:
            same.append(words)
    parts = []
    for found, word in ((more, "larger"), (less, "smaller"), (same, "the same within its scatter or 1 %")):
        if found:
            parts.append(f"{word}: {', '.join(found)}")
    said = f"{names[1]} against {names[0]}: {'; '.join(parts) or 'no number can be compared'}."
    unsettled = [name for name, values in zip(names, summaries, strict=True) if not values.get("settled")]
    if unsettled:
        said += f" The cage's motion of {' and '.join(unsettled)} has not settled: its numbers are a first look."
    return f"<h2>Verdict</h2><div class='cards'><div class='card'><b>What differs</b>{safe(said)}</div></div>"


def difference(first: Any, second: Any, first_width: float | None, second_width: float | None) -> str:
    """Change of a number from the first run to the second, in per cent of the first; "same" within the scatter or 1 %."""
    if not isinstance(first, float) or not isinstance(second, float):
        return "" if first == second else "differs"
    scatter = math.hypot(first_width or 0.0, second_width or 0.0)
    if abs(second - first) <= max(scatter, LEAST_DIFFERENCE * abs(first)):
        return "same"
    if first == 0.0 or first * second < 0.0 or abs(second) > 10.0 * abs(first):
        return f"{second - first:+.3g}".replace("-", MINUS)
    return f"{'+' if second > first else ''}{plain(100.0 * (second / first - 1.0), 3)} %".replace("-", MINUS)


def key_numbers(summaries: Sequence[Mapping[str, Any]], names: Sequence[str]) -> str:
    """The numbers that are asked for first."""
    body = []
    for row in rows("report"):
        key = row.name
        values = [entry.get(key) for entry in summaries]
        if any(value is not None for value in values):
            widths = [(entry.get("confidence") or {}).get(key) for entry in summaries]
            body.append(_number(row.words, row.unit, values, widths, None, []))
    heads = heads_of("quantity", *_columns(names), "unit")
    return f"<table>{heads}{''.join(body)}</table>" if body else ""


def _columns(names: Sequence[str]) -> tuple[str, ...]:
    return (*names, "difference") if len(names) > 1 else ("value",)


def numbers(
    summaries: Sequence[Mapping[str, Any]], names: Sequence[str], checks: Sequence[Mapping[str, Checked]]
) -> str:
    """Every number of the summaries with its interval, unit, meaning and what the check of its run says; then the notes."""
    body: list[str] = []
    notes: list[str] = []
    for row in rows():
        key, words, unit = row.name, row.words, row.unit
        values = [entry.get(key) for entry in summaries]
        if all(value is None for value in values):
            continue
        if key.endswith(SENTENCES):
            notes += _notes(words, values, names)
        elif not row.printed:
            continue
        elif any(isinstance(value, Mapping) for value in values):
            body += _parts(words, unit, values)
        else:
            widths = [(entry.get("confidence") or {}).get(key) for entry in summaries]
            body.append(_number(words, unit, values, widths, row.meaning, _said(key, values, checks, names)))
    heads = heads_of("quantity", *_columns(names), "unit", "what it means")
    listed = f"<dl class='notes'>{''.join(notes)}</dl>" if notes else ""
    return f"<details><summary>All numbers and what they mean</summary><table>{heads}{''.join(body)}</table>{listed}</details>"


def _notes(words: str, values: Sequence[Any], names: Sequence[str]) -> list[str]:
    said = [
        (f"{safe(name)}: " if len(values) > 1 else "") + safe(value[:1].upper() + value[1:])
        for name, value in zip(names, values, strict=True)
        if value is not None
    ]
    head = words[:1].upper() + words[1:]
    return [f"<dt>{safe(head)}</dt>"] + [f"<dd>{text}</dd>" for text in said]


def _said(key: str, values: Sequence[Any], checks: Sequence[Mapping[str, Checked]], names: Sequence[str]) -> list[str]:
    """What the accuracy of each run does to this number."""
    found = [
        (name, listed[key])
        for name, listed, value in zip(names, checks, values, strict=True)
        if key in listed and value is not None
    ]
    return [f"By the check of {name if len(values) > 1 else 'the run'}: {one}." for name, one in found]


def _parts(words: str, unit: str, values: Sequence[Any]) -> list[str]:
    made = [f"<tr><th colspan='{3 + len(values) + (len(values) > 1)}'>{safe(words)}</th></tr>"]
    for part in dict.fromkeys(part for value in values if value for part in value):
        entries = [(value or {}).get(part) for value in values]
        if any(entries):
            made.append(_number(part.replace("_", " "), unit, entries, [None] * len(values), "", []))
    return made


def _number(
    words: str,
    unit: str,
    values: Sequence[Any],
    widths: Sequence[float | None],
    meaning: str | None,
    bias: Sequence[str],
) -> str:
    factor, unit = _scale(unit, values)
    shown = [
        _amount(value * factor if isinstance(value, float) and factor != 1.0 else value)
        + ("" if w is None else f" ± {plain(w * factor, 2)}")
        for value, w in zip(values, widths, strict=True)
    ]
    if unit == "h":
        shown = [life_text(value) if isinstance(value, float) else "-" for value in values]
    differs = " class='differs'" if len(set(shown)) > 1 else ""
    cells = "".join(f"<td class='n {_kind(text)}'>{safe(text)}</td>" for text in shown)
    if len(values) > 1:
        cells += f"<td class='n number'>{safe(difference(values[0], values[1], *widths))}</td>"
    said = "".join(f"<span class='bias'>{safe(text)}</span>" for text in bias)
    meant = "" if meaning is None else f"<td class='m'>{safe(meaning)}{said}</td>"
    return f"<tr{differs}><td class='q'>{safe(words.strip())}</td>{cells}<td class='u'>{safe(unit)}</td>{meant}</tr>"


def number_text(row: Number, value: Any) -> str:
    """A number with its unit as the tables of a report show it."""
    factor, unit = _scale(row.unit, [value])
    shown = _amount(value * factor if isinstance(value, float) and factor != 1.0 else value)
    return f"{shown} {unit}".strip()


def _scale(unit: str, values: Sequence[Any]) -> tuple[float, str]:
    """Factor and unit in which a row of numbers is shown."""
    return step_of(unit, [value for value in values if isinstance(value, float)])


def _kind(text: str) -> str:
    """Whether a cell may wrap: words may, a number with its interval may not."""
    return "number" if len(text) <= LONGEST_NUMBER else "words"


def _amount(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return plain(value) if isinstance(value, float) else str(value)


def inputs(listed_inputs: Sequence[list[Row]], names: Sequence[str]) -> str:
    """All inputs of each scene, the assumed and the estimated ones marked."""
    tables = []
    for listed, name in zip(listed_inputs, names, strict=True):
        body = "".join(
            f"<tr class='{row.mark}'><td class='q'>{safe(row.path)}</td><td class='n {_kind(row.value)}'>{safe(row.value)}</td>"
            f"<td class='u'>{safe(row.unit)}</td><td class='mark'>{row.mark}</td><td class='m'>{safe(row.text)}</td></tr>"
            for row in listed
        )
        of = f" of {safe(name)}" if len(listed_inputs) > 1 else ""
        heads = heads_of("input", "value", "unit", "", "what it is")
        tables.append(f"<details><summary>All inputs{of}</summary><table>{heads}{body}</table></details>")
    note = (
        "<p>Marked as <b>assumed</b>: no source gives the value, it is the package's default. "
        "Marked as <b>estimated</b>: derived from the catalogue's numbers.</p>"
    )
    return f"{''.join(tables)}{note}"
