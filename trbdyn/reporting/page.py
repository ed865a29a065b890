"""The report as one HTML page: sentences, drawings, inputs, pictures and numbers of one run, or of two side by side."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from trbdyn.reporting.inputs import Row, rows
from trbdyn.reporting.meanings import CAPTIONS, MEANINGS
from trbdyn.reporting.verdict import verdict, warnings
from trbdyn.results.summary import LABELS, UNPRINTED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from trbdyn.results.result import Result

STYLE = """
:root { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #1b1f24; }
body { max-width: 1080px; margin: 0 auto; padding: 24px; }
h1 { font-size: 26px; margin: 0; } h2 { margin-top: 34px; border-bottom: 2px solid #dce1e6; padding-bottom: 3px; }
p.sub { margin: 2px 0 18px; color: #56616d; }
.cards { display: grid; gap: 10px; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); }
.card { border-left: 6px solid #9aa5b1; background: #f5f7f9; padding: 8px 12px; break-inside: avoid; }
.card.good { border-color: #009e73; } .card.care { border-color: #e69f00; } .card.bad { border-color: #c2185b; }
.card b { display: block; } .card .grade { float: right; font-size: 12px; color: #56616d; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; }
th, td { text-align: left; padding: 3px 8px; border-bottom: 1px solid #e3e7eb; vertical-align: top; }
td.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; } td.u { white-space: nowrap; }
tr.assumed td { background: #fff7e0; } tr.estimated td { background: #fdebd8; } tr.differs td { background: #e6f2fb; }
.mark { font-size: 12px; font-weight: 600; white-space: nowrap; }
.pictures { display: grid; gap: 18px; grid-template-columns: repeat(auto-fit, minmax(460px, 1fr)); align-items: start; }
figure { margin: 0; break-inside: avoid; } figure img { width: 100%; } figcaption { font-size: 13px; color: #39434d; }
.pair { grid-column: 1 / -1; display: grid; grid-template-columns: 1fr 1fr; gap: 12px; } .pair figcaption { grid-column: 1 / -1; }
details summary { cursor: pointer; font-weight: 600; } ul.warnings li { margin-bottom: 4px; }
@media print { body { padding: 0; } details { display: block; } .pictures { grid-template-columns: 1fr 1fr; } }
"""

GRADES = {"good": "good", "care": "take care", "bad": "not good", "plain": ""}


def page(results: Sequence[Result], names: Sequence[str], title: str, pictures: Sequence[str] | None) -> str:
    """The HTML of the report of one run or of two."""
    numbers = [result.summary() for result in results]
    inputs = [rows(result.scene) for result in results]
    parts = [_head(results, names, title)]
    for result, values, listed, name in zip(results, numbers, inputs, names, strict=True):
        parts.append(_verdict(result, values, listed, name if len(results) > 1 else ""))
    if len(results) > 1:
        parts.append(_differences(inputs, names))
    parts.append(_simulated(results, names))
    parts.append(_pictures(results, names, pictures))
    parts.append(_numbers(numbers, names))
    parts.append(_inputs(inputs, names))
    body = "\n".join(parts)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{_safe(title)}</title><style>{STYLE}</style></head>'
        f"<body>\n{body}\n</body></html>\n"
    )


def _safe(text: object) -> str:
    return html.escape(str(text))


def _head(results: Sequence[Result], names: Sequence[str], title: str) -> str:
    from trbdyn.plot import conditions

    lines = []
    for result, name in zip(results, names, strict=True):
        words = conditions(result).replace("$F_a$", "Fa").replace("$F_r$", "Fr")
        made = ", ".join(
            f"{word} {result.meta[key]}"
            for key, word in (("created", "run"), ("trbdyn_version", "trbdyn"), ("instruction_set", "instruction set"))
            if result.meta.get(key)
        )
        label = f"<b>{_safe(name)}</b>: " if len(results) > 1 else ""
        lines.append(f"{label}{_safe(words)}; {_safe(result.scene.lubricant.name)}; {_safe(made)}")
    return f"<h1>{_safe(title)}</h1>\n<p class='sub'>{'<br>'.join(lines)}</p>"


def _verdict(result: Result, numbers: dict[str, Any], listed: list[Row], name: str) -> str:
    cards = "".join(
        f"<div class='card {grade}'><span class='grade'>{GRADES[grade]}</span><b>{_safe(head)}</b>{_safe(text)}</div>"
        for grade, head, text in verdict(result, numbers)
    )
    estimated, assumed = (sum(row.mark == mark for row in listed) for mark in ("estimated", "assumed"))
    notes = "".join(f"<li>{_safe(text)}</li>" for text in warnings(result, numbers, estimated, assumed))
    of = f" of {_safe(name)}" if name else ""
    return f"<h2>Verdict{of}</h2>\n<div class='cards'>{cards}</div>" + (
        f"\n<h3>Before you rely on it</h3><ul class='warnings'>{notes}</ul>"
    )


def _differences(inputs: Sequence[list[Row]], names: Sequence[str]) -> str:
    tables = [{row.path: row for row in listed} for listed in inputs]
    paths = [path for path in {**tables[0], **tables[1]} if _value(tables[0], path) != _value(tables[1], path)]
    if not paths:
        return "<h2>What differs</h2><p>All inputs of the two scenes are equal.</p>"
    body = "".join(
        f"<tr><td>{_safe(path)}</td>"
        + "".join(f"<td class='n'>{_safe(_value(table, path))}</td>" for table in tables)
        + f"<td class='u'>{_safe((tables[0].get(path) or tables[1][path]).unit)}</td></tr>"
        for path in paths
    )
    heads = "".join(f"<th>{_safe(name)}</th>" for name in names)
    return f"<h2>What differs</h2><table><tr><th>input</th>{heads}<th>unit</th></tr>{body}</table>"


def _value(table: Mapping[str, Row], path: str) -> str:
    return table[path].value if path in table else "-"


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


def image(draw: Callable[[], Axes | Figure]) -> str:
    """A picture as the address of a PNG image that holds its own data."""
    import matplotlib.pyplot as plt
    from matplotlib.figure import Figure

    from trbdyn.plot.style import STYLE as PLOT_STYLE

    picture = draw()
    figure = picture if isinstance(picture, Figure) else picture.get_figure(root=True)
    assert figure is not None
    paper = io.BytesIO()
    try:
        with plt.rc_context(PLOT_STYLE):
            figure.savefig(paper, format="png", dpi=110)
    finally:
        plt.close(figure)
    return "data:image/png;base64," + base64.b64encode(paper.getvalue()).decode("ascii")


def _figure(draw: Callable[[], Axes | Figure], caption: str) -> str:
    return f"<figure><img alt='{_safe(caption)}' src='{image(draw)}'><figcaption>{_safe(caption)}</figcaption></figure>"


def _pictures(results: Sequence[Result], names: Sequence[str], wanted: Sequence[str] | None) -> str:
    from trbdyn.plot import PICTURES

    def possible(result: Result, name: str) -> bool:
        there = set(result.groups) - (set() if result.has_cage else {"pocket"})
        needs_cage = "cage" in PICTURES[name][1] and name not in ("pressure_map", "film_map")
        return set(PICTURES[name][1]) <= there and (result.has_cage or not needs_cage)

    chosen = [
        name for name in (PICTURES if wanted is None else wanted) if all(possible(result, name) for result in results)
    ]
    if any(len(result) < 2 for result in results):
        return "<h2>Pictures</h2><p>There are too few records to draw.</p>"
    out = []
    for name in chosen:
        caption = CAPTIONS.get(name, name.replace("_", " "))
        if len(results) == 1:
            out.append(_figure(partial(PICTURES[name][0], results[0]), caption))
            continue
        images = "".join(
            f"<img alt='{_safe(label)}' src='{image(partial(PICTURES[name][0], result))}'>"
            for result, label in zip(results, names, strict=True)
        )
        out.append(
            f"<figure class='pair'>{images}<figcaption>{_safe(caption)} Left: {_safe(names[0])}; right: {_safe(names[1])}."
            "</figcaption></figure>"
        )
    return f"<h2>Pictures</h2><div class='pictures'>{''.join(out)}</div>"


def _numbers(numbers: Sequence[dict[str, Any]], names: Sequence[str]) -> str:
    body = []
    for key, (words, unit) in LABELS.items():
        values = [entry.get(key) for entry in numbers]
        if key in UNPRINTED or all(value is None for value in values):
            continue
        if any(isinstance(value, Mapping) for value in values):
            body.append(f"<tr><th colspan='{3 + len(numbers)}'>{_safe(words)}</th></tr>")
            parts = dict.fromkeys(part for value in values if value for part in value)
            for part in parts:
                entries = [(value or {}).get(part) for value in values]
                if any(entries):
                    body.append(_number_row(part.replace("_", " "), entries, unit, ""))
            continue
        widths = [(entry.get("confidence") or {}).get(key) for entry in numbers]
        body.append(_number_row(words, values, unit, MEANINGS.get(key, ""), widths))
    heads = "".join(f"<th>{_safe(name)}</th>" for name in names) if len(numbers) > 1 else "<th>value</th>"
    return f"<h2>Numbers</h2><table><tr><th>quantity</th>{heads}<th>unit</th><th>what it means</th></tr>{''.join(body)}</table>"


def _number_row(
    words: str, values: Sequence[Any], unit: str, meaning: str, half_widths: Sequence[float | None] = ()
) -> str:
    widths = [*half_widths, *[None] * (len(values) - len(half_widths))]
    shown = [_amount(value) + ("" if w is None else f" ± {w:.2g}") for value, w in zip(values, widths, strict=True)]
    differs = " class='differs'" if len(set(shown)) > 1 else ""
    cells = "".join(f"<td class='n'>{_safe(text)}</td>" for text in shown)
    return f"<tr{differs}><td>{_safe(words.strip())}</td>{cells}<td class='u'>{_safe(unit)}</td><td>{_safe(meaning)}</td></tr>"


def _amount(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _inputs(inputs: Sequence[list[Row]], names: Sequence[str]) -> str:
    tables = []
    for listed, name in zip(inputs, names, strict=True):
        body = "".join(
            f"<tr class='{row.mark}'><td>{_safe(row.path)}</td><td class='n'>{_safe(row.value)}</td>"
            f"<td class='u'>{_safe(row.unit)}</td>"
            f"<td class='mark'>{row.mark}</td><td>{_safe(row.text)}</td></tr>"
            for row in listed
        )
        of = f" of {_safe(name)}" if len(inputs) > 1 else ""
        tables.append(
            f"<details open><summary>All inputs{of}</summary><table>"
            "<tr><th>input</th><th>value</th><th>unit</th><th></th><th>what it is</th></tr>"
            f"{body}</table></details>"
        )
    note = (
        "<p>Marked as <b>assumed</b>: no source gives the value, it is the package's default. "
        "Marked as <b>estimated</b>: derived from the catalogue's numbers.</p>"
    )
    return f"<h2>Inputs</h2>{note}{''.join(tables)}"
