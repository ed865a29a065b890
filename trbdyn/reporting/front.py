"""The first page of a report: a sheet to sign. What was given, estimated and assumed, the verdicts and their margins."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from typing import Any, Final

from trbdyn.base.display import displayed, plain
from trbdyn.base.version import __version__
from trbdyn.model.assembly import Assembly
from trbdyn.model.scene import Scene
from trbdyn.reporting.inputs import Row
from trbdyn.reporting.tables import heads_of, safe, table_of
from trbdyn.reporting.verdict import (
    CLOSURE_LIMIT,
    LIVES,
    NORMAL_SAFETY,
    STATIC_LIMIT,
    USUAL_LIFE,
    Sentence,
)
from trbdyn.results.result import Result
from trbdyn.results.sources import files_of
from trbdyn.standards.sheet import Rating, life_text

MOST_NAMES: Final = 60
"""Most assumed inputs that are named on the sheet; all of them are under "All inputs"."""
SIGNED: Final = ("calculated", "checked", "released")
"""Who signs."""


def front(
    results: Sequence[Result],
    names: Sequence[str],
    inputs: Sequence[list[Row]],
    numbers: Sequence[Mapping[str, Any]],
    sheets: Sequence[Rating | str],
    verdicts: Sequence[list[Sentence]],
    of_all: Scene | Assembly | None = None,
) -> str:
    """The sheet of one bearing, or of all on a shaft; what is the same for several bearings is told once."""
    several = len(results) > 1
    parts = [
        "<section class='sheet'>",
        "<h2>Sheet</h2>",
        f"<p>{'; '.join(f'{name} <b>{safe(text)}</b>' for name, text in _head(results))}</p>",
    ]
    if of_all is not None:
        rows = [("given", "shaft", of_all.title)]
        rows += [("given", row[0], " ".join(_told(row))) for row in of_all._shown().rows]
        parts.append(f"<h3>Shaft</h3>{_given(rows)}")
    told: dict[tuple[str, str], str] = {}
    for one, name, listed, values, sheet, judged in zip(results, names, inputs, numbers, sheets, verdicts, strict=True):
        found = [
            (kind, words, f"as {told[kind, text]}" if (kind, text) in told else text)
            for kind, words, text in _inputs(one, listed)
        ]
        told |= {(kind, text): name for kind, _, text in found if kind != "given" and not text.startswith("as ")}
        parts.append(f"<h3>{f'{safe(name)}: inputs' if several else 'Inputs'}</h3>{_given(found)}")
        parts.append(_margins(values, sheet, judged))
    blank = "".join(f"<tr><td class='q'>{word}</td><td></td><td></td><td></td></tr>" for word in SIGNED)
    heads = heads_of("", "name", "date", "signature")
    parts.append(f"<table class='signed'>{heads}{blank}</table></section>")
    return "\n".join(parts)


def _head(results: Sequence[Result]) -> list[tuple[str, str]]:
    files = dict.fromkeys(path.name for result in results for path in files_of(result))
    run = next((str(one.meta["created"])[:16].replace("T", " ") for one in results if one.meta.get("created")), "")
    version = next((str(one.meta["trbdyn_version"]) for one in results if one.meta.get("trbdyn_version")), __version__)
    rows = [
        ("file", ", ".join(files) or "not saved"),
        ("run", run),
        ("report", f"{datetime.now():%Y-%m-%d %H:%M}"),
        ("trbdyn", version if version == __version__ else f"{version}, report by {__version__}"),
    ]
    return [row for row in rows if row[1]]


def _told(row: Sequence[str]) -> list[str]:
    """Value, unit and note of a row, as a phrase."""
    value, unit, *note = [*row[1:], ""][:3]
    return [f"{value} {unit}{',' if any(note) else ''}".strip(), *note]


def _inputs(result: Result, listed: Sequence[Row]) -> list[tuple[str, str, str]]:
    """Kind, name and text of what was given, estimated and assumed."""
    scene = result.scene
    rows: list[tuple[str, str, str]] = [("given", scene.bearing.name or "bearing", scene.title)]
    ratings = scene.bearing.ratings
    told = {"C": (ratings.dynamic, "N"), "C0": (ratings.static, "N"), "e": (ratings.e, ""), "Y": (ratings.Y, "")}
    said = ", ".join(
        f"{key} {' '.join(displayed(value, unit)).strip()}" for key, (value, unit) in told.items() if value
    )
    if said:
        rows.append(("given", "catalogue", said))
    oil = scene.lubricant
    clean = f", cleanliness -/{oil.cleanliness}" if oil.cleanliness else ", cleanliness not given"
    warm = "" if f"{oil.temperature_c:g} C" in oil.name else f" at {oil.temperature_c:g} C"
    rows.append(("given", "oil", f"{oil.name}{warm}{clean}{', filtered' if oil.filtered else ''}"))
    bands: list[str] = []
    for one in scene.bearing.estimated:
        value, unit = displayed(one.value, one.unit)
        low, high = (displayed(end, one.unit, like=one.value)[0] for end in (one.low, one.high))
        unit = "" if unit == "1" else f" {unit}"
        bands.append(f"{one.path} {value} ({low} to {high}){unit}")
    if bands:
        rows.append(("estimated", f"{len(bands)} inputs", "; ".join(bands)))
    assumed = [row.path.removeprefix("bearing.") for row in listed if row.mark == "assumed"]
    if assumed:
        more = f" and {len(assumed) - MOST_NAMES} more" if len(assumed) > MOST_NAMES else ""
        rows.append(("assumed", f"{len(assumed)} inputs", ", ".join(assumed[:MOST_NAMES]) + more))
    return rows


def _given(rows: Sequence[tuple[str, str, str]]) -> str:
    body = "".join(
        f"<tr class='{kind if kind != 'given' else ''}'><td class='mark'>{kind}</td><td class='q'>{safe(name)}</td>"
        f"<td class='{'' if kind == 'given' else 'small'}'>{safe(text)}</td></tr>"
        for kind, name, text in rows
    )
    return f"<table>{heads_of('', 'input', 'what it is')}{body}</table>"


def _margins(values: Mapping[str, Any], sheet: Rating | str, judged: Sequence[Sentence]) -> str:
    """Numbers that have a limit, how far they are from it, and the sentences of the verdict."""
    rows: list[tuple[str, str, str, str]] = []

    def add(
        words: str,
        value: float | None,
        limit: float,
        unit: str,
        *,
        most: bool = False,
        text: Callable[[float], str] | None = None,
    ) -> None:
        if value is None or not value > 0.0:
            return
        margin = limit / value if most else value / limit
        shown = text or (lambda number: " ".join(displayed(number, unit, like=max(value, limit))).strip())
        verdict = "kept" if margin >= 1.0 else "NOT KEPT"
        rows.append(
            (
                words,
                shown(value),
                f"{'at most' if most else 'at least'} {shown(limit)}",
                f"{plain(margin, 3)}, {verdict}",
            )
        )

    lives = {name: values[key] for key, name in LIVES.items() if isinstance(values.get(key), float)}
    if lives:
        name = min(lives, key=lambda one: lives[one])
        add(f"life {name}, the shortest", lives[name], USUAL_LIFE, "h", text=lambda hours: f"{life_text(hours)} h")
    if isinstance(sheet, Rating):
        add("static safety S0", sheet.static_safety, NORMAL_SAFETY, "")
        add("equivalent load over the smallest", sheet.equivalent_load / sheet.smallest_load, 1.0, "")
        add("speed over the limiting speed", sheet.speed_over_limit, 1.0, "", most=True)
    for ring in ("inner", "outer"):
        add(f"largest pressure, {ring} ring", values.get(f"{ring}_pressure_max"), STATIC_LIMIT, "Pa", most=True)
    add("residual of the energy", values.get("energy_closure"), CLOSURE_LIMIT, "", most=True)
    table = table_of(("limit", "found", "asked for", "margin"), rows) if rows else ""
    grades = {"good": "good", "care": "take care", "bad": "not good", "plain": "not judged"}
    said = "; ".join(f"{safe(head)}: <b>{grades[grade]}</b>" for grade, head, _ in judged)
    return f"<h3>Verdicts and margins</h3>{table}<p>{said}.</p>"
