"""The report as one HTML page: sentences, drawings, inputs, pictures and numbers of one run, or of two side by side."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from trbdyn.base.shown import Shown
from trbdyn.model.assembly import Assembly
from trbdyn.model.scene import Scene
from trbdyn.plot.assembly import of_result
from trbdyn.reporting import tables
from trbdyn.reporting.captions import CAPTIONS
from trbdyn.reporting.front import front
from trbdyn.reporting.inputs import Row, rows
from trbdyn.reporting.ratings import frequencies_section, ratings_section, sheet_of, system_section
from trbdyn.reporting.tables import number_text, safe
from trbdyn.reporting.verdict import Sentence, verdict, verdict_of_shaft, warnings
from trbdyn.results.assembly import TURNED_OVER, AssemblyResult
from trbdyn.results.numbers import drawn_of, of_picture
from trbdyn.results.result import Result
from trbdyn.results.rows.ratings import RATINGS, of_sheet
from trbdyn.run.check import Check
from trbdyn.standards.sheet import Rating

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


UNFOLD = "addEventListener('beforeprint', () => document.querySelectorAll('details').forEach((one) => { one.open = true; }));"
"""What is folded on a screen is printed."""
FIRST_PICTURES = ("cage_locus", "load_zone", "torque_split", "film_parameter")
"""Pictures that are not folded away."""
GRADES = {"good": "good", "care": "take care", "bad": "not good", "plain": ""}


def page(
    results: Sequence[Result | AssemblyResult],
    names: Sequence[str],
    title: str,
    pictures: Sequence[str] | None,
    shown: Sequence[Shown] = (),
    checks: Sequence[Check] = (),
    reliability: float = 90.0,
) -> str:
    """The HTML of the report of one run or of two, of one bearing or of several on a shaft, with further tables below.

    Of a shaft: what the bearings share, then each bearing as in a report of its own.
    """
    bearings = list(results[0].by_name)
    checks = checks or [Check({}) for _ in results]
    if bearings == [""]:
        of_one = [result.parts[0] for result in results]
        heading = title or f"Report: {' and '.join(dict.fromkeys(run.scene.bearing.name for run in of_one))}"
        body = _body(of_one, names, heading, pictures, "", checks, reliability, signed=True)
        return _whole(heading, body + tables.further(shown))
    heading = title or f"Report: {', '.join(bearings)} on one shaft"
    parts = [f"<h1>{safe(heading)}</h1>"]
    if len(results) == 1:
        parts.append(_sheet(list(results[0].by_name.values()), bearings, reliability, results[0].subject))
    for result, name in zip(results, names, strict=True):
        parts.append(_shaft(result, name if len(results) > 1 else "", pictures, reliability))
    own = of_result(results[0])
    of_bearings = None if pictures is None else [name for name in pictures if name not in own]
    for bearing in bearings:
        of_one = [result.by_name[bearing] for result in results]
        called = names if len(results) > 1 else [bearing]
        note = TURNED_OVER.format("This bearing is") if bearing in results[0].turned_over else ""
        parts.append(_body(of_one, called, f"Bearing {bearing}", of_bearings, bearing, checks, reliability, note=note))
    return _whole(heading, "\n".join(parts) + tables.further(shown))


def _shaft(result: Any, name: str, pictures: Sequence[str] | None, reliability: float) -> str:
    """What the bearings of a shaft share: verdict, the bearings side by side, lives, pictures of the shaft."""
    own, shown = of_result(result), result._shown()
    of = f" of {safe(name)}" if name else ""
    cards = "".join(_card(sentence) for sentence in verdict_of_shaft(result))
    table = tables.table_of(("quantity", *shown.head[1:]), shown.rows[1:])
    notes = "".join(f"<li>{safe(note)}</li>" for note in shown.notes)
    wanted = [picture for picture in own if pictures is None or picture in pictures]
    figures = "".join(_figure(own[picture], CAPTIONS[picture]) for picture in wanted if len(result.time) > 1)
    return "\n".join(
        [
            f"<p class='sub'>{safe(result.assembly.title if result.assembly else '')}</p>",
            f"<h2>Verdict of the shaft{of}</h2><div class='cards'>{cards}</div>",
            f"<h2>The bearings side by side{of}</h2>{table}<ul class='warnings'>{notes}</ul>",
            system_section(result, reliability),
            f"<h2>The shaft{of}</h2><div class='pictures'>{figures}</div>",
        ]
    )


def _card(sentence: Sentence) -> str:
    grade, head, text = sentence
    return f"<div class='card {grade}'><span class='grade'>{GRADES[grade]}</span><b>{safe(head)}</b>{safe(text)}</div>"


def judgement(result: Result) -> list[Sentence]:
    """What a run says of life, cage, hits, torque, films and pressures: grade, headline, sentence."""
    return verdict(result, _with_lives(result.summary(), sheet_of(result)))


def _sheet(
    results: Sequence[Result], names: Sequence[str], reliability: float, of_all: Scene | Assembly | None = None
) -> str:
    """The first page, to be signed; `of_all`: the bearings together, whose loads the page has too."""
    sheets = [sheet_of(result, reliability) for result in results]
    numbers = [_with_lives(result.summary(), sheet) for result, sheet in zip(results, sheets, strict=True)]
    judged = [verdict(result, values) for result, values in zip(results, numbers, strict=True)]
    listed = [rows(result.scene) for result in results]
    return front(results, names, listed, numbers, sheets, judged, of_all)


def _body(
    results: Sequence[Result],
    names: Sequence[str],
    title: str,
    pictures: Sequence[str] | None,
    bearing: str,
    checks: Sequence[Check],
    reliability: float,
    *,
    signed: bool = False,
    note: str = "",
) -> str:
    """One bearing of each run; `bearing` is its name on a shaft, and a note is said at its head."""
    numbers = [result.summary() for result in results]
    sheets = [sheet_of(result, reliability) for result in results]
    inputs = [rows(result.scene) for result in results]
    judged = [
        _verdict(result, _with_lives(values, sheet), listed, name if len(results) > 1 else "", check)
        for result, values, sheet, listed, name, check in zip(
            results, numbers, sheets, inputs, names, checks, strict=True
        )
    ]
    parts = [_head(results, names, title), *([f"<p>{safe(note)}</p>"] if note else [])]
    if signed and len(results) == 1:
        parts.append(_sheet(results, names, reliability))
    if len(results) > 1:
        parts += [
            tables.comparison(numbers, names),
            tables.key_numbers(numbers, names),
            tables.differences(inputs, names),
        ]
        parts += [
            f"<details><summary>{safe(name)} by itself</summary>{text}</details>"
            for name, text in zip(names, judged, strict=True)
        ]
    else:
        parts += [*judged, "<h2>Numbers</h2>", tables.key_numbers(numbers, names)]
    parts.append(_simulated(results, names))
    parts.append(_pictures(results, numbers, names, pictures))
    parts.append("<h2>Details</h2>")
    parts.append(tables.numbers(numbers, names, [check.of(bearing) for check in checks]))
    parts.append(ratings_section(sheets, names))
    parts.append(frequencies_section(results, numbers, names))
    parts.append(tables.inputs(inputs, names))
    return "\n".join(parts)


def _with_lives(numbers: dict[str, Any], sheet: Rating | str) -> dict[str, Any]:
    """A summary with the ratings of the run's records where it has none of its own."""
    known = {} if isinstance(sheet, str) else {row.name: of_sheet(sheet, row.name) for row in RATINGS}
    return numbers | {name: value for name, value in known.items() if value is not None and name not in numbers}


def _whole(title: str, body: str) -> str:
    style = files("trbdyn.reporting").joinpath("report.css").read_text(encoding="utf-8")
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{safe(title)}</title><style>{style}</style></head>"
        f"<body>\n{body}\n<script>{UNFOLD}</script></body></html>\n"
    )


def _head(results: Sequence[Result], names: Sequence[str], title: str) -> str:
    from trbdyn.plot import conditions

    lines = []
    for result, name in zip(results, names, strict=True):
        words = conditions(result).replace("$F_a$", "Fa").replace("$F_r$", "Fr").replace(r"\$", "$")
        made = ", ".join(
            f"{word} {str(result.meta[key])[:16].replace('T', ' ')}"
            for key, word in (("created", "run"), ("trbdyn_version", "trbdyn"))
            if result.meta.get(key)
        )
        label = f"<b>{safe(name)}</b>: " if len(results) > 1 else ""
        parts = [words, result.scene.lubricant.name, made]
        lines.append(label + safe("; ".join(part for part in parts if part)))
    return f"<h1>{safe(title)}</h1>\n<p class='sub'>{'<br>'.join(lines)}</p>"


def _verdict(result: Result, numbers: dict[str, Any], listed: list[Row], name: str, check: Check) -> str:
    cards = "".join(_card(sentence) for sentence in verdict(result, numbers))
    estimated, assumed = (sum(row.mark == mark for row in listed) for mark in ("estimated", "assumed"))
    notes = "".join(
        f"<li>{safe(text)}</li>" for text in [*warnings(result, numbers, estimated, assumed), *check.said()]
    )
    of = f" of {safe(name)}" if name else ""
    return f"<h2>Verdict{of}</h2>\n<div class='cards'>{cards}</div>" + (
        f"\n<h3>Before you rely on it</h3><ul class='warnings'>{notes}</ul>"
    )


def _simulated(results: Sequence[Result], names: Sequence[str]) -> str:
    from trbdyn.plot import bearing_drawing, pocket_drawing

    bearings = [result.scene.bearing for result in results]
    chosen = [0] if len(results) == 1 or bearings[0] == bearings[1] else [0, 1]
    figures = []
    for number in chosen:
        of = f"{names[number]}: " if len(chosen) > 1 else ""
        bearing = bearings[number]
        caption = f"{of}The bearing in section, from its inputs; dashed parts are not simulated."
        figures.append(_figure(partial(bearing_drawing, bearing), caption))
        if results[number].has_cage:
            caption = f"{of}A pocket of the cage with its roller, and the gaps of its faces."
            figures.append(_figure(partial(pocket_drawing, bearing), caption))
    return f"<h2>What was simulated</h2><div class='pictures'>{''.join(figures)}</div>"


def image(draw: Callable[[], Axes | Figure], dpi: int = 110) -> str:
    """A picture as the address of a PNG image that holds its own data."""
    import matplotlib.pyplot as plt
    from matplotlib.figure import Figure

    from trbdyn.plot.style import styled

    picture = draw()
    figure = picture if isinstance(picture, Figure) else picture.get_figure(root=True)
    assert figure is not None
    paper = io.BytesIO()
    try:
        with styled():
            if (engine := figure.get_layout_engine()) is not None:  # which savefig would do by drawing once more
                engine.execute(figure)
                figure.set_layout_engine("none")
            figure.savefig(paper, format="png", dpi=dpi)
    finally:
        plt.close(figure)
    return "data:image/png;base64," + base64.b64encode(paper.getvalue()).decode("ascii")


def _figure(draw: Callable[[], Axes | Figure], caption: str) -> str:
    return f"<figure><img alt='{safe(caption)}' src='{image(draw)}'><figcaption>{safe(caption)}</figcaption></figure>"


def told(name: str, numbers: Sequence[Mapping[str, Any]]) -> str:
    """The numbers that belong to a picture, of each run, as a sentence behind its caption."""
    said = []
    for row in of_picture(name):
        values = [number_text(row, one[row.name]) for one in numbers if one.get(row.name) is not None]
        if values:
            said.append(f"{row.words}: {' and '.join(values)}")
    return f" {'; '.join(said)}." if said else ""


def _pictures(
    results: Sequence[Result],
    numbers: Sequence[Mapping[str, Any]],
    names: Sequence[str],
    wanted: Sequence[str] | None,
) -> str:
    from trbdyn.plot import PICTURES, drawable

    possible = [drawable(result) for result in results]
    chosen = [name for name in (PICTURES if wanted is None else wanted) if all(name in allowed for allowed in possible)]
    if any(len(result) < 2 for result in results):
        return "<h2>Pictures</h2><p>There are too few records to draw.</p>"
    out: dict[bool, list[str]] = {True: [], False: []}
    for name in chosen:
        first = wanted is not None or name in FIRST_PICTURES
        caption = CAPTIONS.get(name, name.replace("_", " ")) + told(name, numbers)
        drawn = [
            drawn_of(name, result, values.get("window_start")) for result, values in zip(results, numbers, strict=True)
        ]
        if len(results) == 1:
            out[first].append(_figure(partial(PICTURES[name][0], drawn[0]), caption))
            continue
        images = "".join(
            f"<img alt='{safe(label)}' src='{image(partial(PICTURES[name][0], result))}'>"
            for result, label in zip(drawn, names, strict=True)
        )
        out[first].append(
            f"<figure class='pair'>{images}<figcaption>{safe(caption)} Left: {safe(names[0])}; right: {safe(names[1])}."
            "</figcaption></figure>"
        )
    shown, folded = (f"<div class='pictures'>{''.join(out[first])}</div>" for first in (True, False))
    more = f"<details><summary>{len(out[False])} more pictures</summary>{folded}</details>" if out[False] else ""
    return f"<h2>Pictures</h2>{shown}{more}"
