"""Tables and the JSON file of the study.

Schema ``trbdyn-sensitivity-1`` of the JSON file::

    schema          "trbdyn-sensitivity-1"
    trbdyn_version  version of the package
    written         ISO 8601, UTC
    places          [{name, duration_s, small_orbit_over_cpr, small_duration_s}]
    seeds           {nominal, of_a_level}: as planned; entries have their own count
    runs            {planned, done, failed: {name: message}, wall_s: sum over the runs that are done}
    indicators      {name: {text, unit, start}}
    inputs          [{name, text, path, nominal, levels: [label], reason, kind}]
    nominal         {point: {indicator: {mean, deviation, count}}}
    effects         [{point, indicator, input, level, count, value, change, noise, beyond}], units those of the indicator
    statements      {name: text}
    judged          [{statement, input, level, margin, noise, outcome}], outcome "holds", "fails", "open" or "-"

Numbers that do not exist are null.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, Final

from paper.sensitivity.effects import STATEMENTS, Effect, Judged, Nominal
from paper.sensitivity.indicators import INDICATORS
from paper.sensitivity.inputs import Input
from paper.sensitivity.plan import NOMINAL, Place, Plan

if TYPE_CHECKING:
    import xarray

SCHEMA: Final = "trbdyn-sensitivity-1"
COLUMNS: Final = {"orbit_growth": 2, "whirl_radius": 3, "orbit": 3, "pocket_force": 1, "torque": 3}
"""Indicators in the tables, with the decimals."""
LEFT_OPEN: Final = ("load direction", "diameter scatter")
"""Inputs whose levels have columns of their own: the statements on combined load and on whirls at light load hang on them."""
SIGNS: Final = {"holds": "+", "fails": "**no**", "open": "?", "-": "-"}


def to_dict(
    plan: Plan,
    data: xarray.Dataset,
    nominal: Mapping[str, Mapping[str, Nominal]],
    found: Sequence[Effect],
    judged: Sequence[Judged],
) -> dict[str, Any]:
    """Everything, as the schema says."""
    from trbdyn import __version__
    from trbdyn.results.summary import clean

    status = data["status"].values
    done = status == "done"
    messages = {
        "/".join(str(data[key].values[k]) for key in ("point", "start", "input", "level", "seed")): str(
            data["message"].values[k]
        )
        for k in (status == "failed").nonzero()[0]
    }
    values = {
        "schema": SCHEMA,
        "trbdyn_version": __version__,
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "places": [
            {
                "name": place.name,
                "duration_s": place.duration,
                "small_orbit_over_cpr": place.small or None,
                "small_duration_s": place.small_duration or None,
            }
            for place in plan.places
        ],
        "seeds": {"nominal": plan.nominal_seeds, "of_a_level": plan.seeds},
        "runs": {
            "planned": len(status),
            "done": int(done.sum()),
            "failed": messages,
            "wall_s": float(data["wall_time"].values[done].sum()),
        },
        "indicators": {i.name: {"text": plain(i.text), "unit": plain(i.unit), "start": i.start} for i in INDICATORS},
        "inputs": [_input(entry) for entry in plan.inputs],
        "nominal": {point: {name: asdict(value) for name, value in table.items()} for point, table in nominal.items()},
        "effects": [asdict(effect) | {"beyond": effect.beyond} for effect in found],
        "statements": {statement.name: statement.text for statement in STATEMENTS},
        "judged": [asdict(entry) for entry in judged],
    }
    cleaned: dict[str, Any] = clean(values)
    return cleaned


def _input(entry: Input) -> dict[str, Any]:
    keys = ("name", "text", "path", "nominal", "reason", "kind")
    return {key: getattr(entry, key) for key in keys} | {"levels": [level.label for level in entry.levels]}


def plain(text: str) -> str:
    """A text without the marks of formulas."""
    return text.replace("C_{pr}", "Cpr").replace("F_", "F").replace("$", "")


def markdown(
    plan: Plan,
    nominal: Mapping[str, Mapping[str, Nominal]],
    found: Sequence[Effect],
    judged: Sequence[Judged],
) -> str:
    """Values at each level of the inputs that the paper leaves open, statements against inputs, and the effects at each point."""
    parts = []
    for entry in plan.inputs:
        if entry.name in LEFT_OPEN:
            parts += [
                f"## {entry.text[:1].upper()}{entry.text[1:]}\n",
                *_levels(plan, entry, nominal, found, judged),
                "",
            ]
    parts += ["## Statements against inputs\n", *_statements(plan.inputs, judged)]
    for place in plan.places:
        here = [effect for effect in found if effect.point == place.name]
        if here:
            parts += [f"\n## {plain(place.condition.title)}\n"]
            parts += _effects(place, plan.inputs, nominal[place.name], here)
    return "\n".join(parts) + "\n"


def _levels(
    plan: Plan,
    entry: Input,
    nominal: Mapping[str, Mapping[str, Nominal]],
    found: Sequence[Effect],
    judged: Sequence[Judged],
) -> list[str]:
    """A column for each level: the values themselves, and whether the statements hold."""
    labels, units = [level.label for level in entry.levels], {one.name: one for one in INDICATORS}
    lines = [_row(["point", "quantity", entry.nominal, *labels]), _row(["---"] * (3 + len(labels)))]
    table = {(e.point, e.level, e.indicator): e for e in found if e.input == entry.name}
    for place in plan.places:
        for name in (name for name in COLUMNS if name in nominal[place.name]):
            effects = [table.get((place.name, label, name)) for label in labels]
            if any(effects):
                known, digits = nominal[place.name][name], COLUMNS[name]
                cells = [f"{known.mean:.{digits}f} ± {known.deviation:.{digits}f}"]
                cells += [_value(effect, digits) for effect in effects]
                quantity = f"{plain(units[name].text)} ({plain(units[name].unit)})"
                lines.append(_row([plain(place.condition.title), quantity, *cells]))
    signs = {(one.input, one.level, one.statement): SIGNS[one.outcome] for one in judged}
    for statement in dict.fromkeys(one.statement for one in judged):
        shown = [signs.get((entry.name, label, statement), "-") for label in labels]
        if set(shown) != {"-"}:
            lines.append(_row(["statement", statement, signs.get((NOMINAL, NOMINAL, statement), "-"), *shown]))
    return lines


def _value(effect: Effect | None, decimals: int) -> str:
    if effect is None:
        return "-"
    text = f"{effect.value:.{decimals}f}"
    return f"**{text}**" if effect.beyond else text


def _statements(inputs: Sequence[Input], judged: Sequence[Judged]) -> list[str]:
    names = list(dict.fromkeys(entry.statement for entry in judged))
    table = {(entry.input, entry.level, entry.statement): SIGNS[entry.outcome] for entry in judged}
    rows = [("nominal", [NOMINAL], NOMINAL)] + [(e.name, [v.label for v in e.levels], e.name) for e in inputs]
    lines = [_row(["input", "levels", *names]), _row(["---"] * (2 + len(names)))]
    for text, levels, key in rows:
        cells = [" / ".join(table.get((key, level, name), "-") for level in levels) for name in names]
        lines.append(_row([text, " / ".join(levels), *cells]))
    return lines


def _effects(
    place: Place, inputs: Sequence[Input], nominal: Mapping[str, Nominal], effects: Sequence[Effect]
) -> list[str]:
    """One row for each input, the one with the largest effect over its noise first."""
    names = [name for name in COLUMNS if name in nominal]
    table = {(effect.input, effect.level, effect.indicator): effect for effect in effects}
    units = {entry.name: f"{plain(entry.text)} ({plain(entry.unit)})" for entry in INDICATORS}
    rank: dict[str, float] = {}
    for effect in effects:
        if effect.indicator in names and effect.noise > 0.0:
            rank[effect.input] = max(rank.get(effect.input, 0.0), abs(effect.change) / effect.noise)
    shown = sorted((e for e in inputs if e.name in rank), key=lambda entry: -rank[entry.name])
    head = ["input", "nominal", "low", "high", *(units[name] for name in names)]
    first = ["*nominal, ± over seeds*", "", "", ""]
    first += [f"{nominal[n].mean:.{COLUMNS[n]}f} ± {nominal[n].deviation:.{COLUMNS[n]}f}" for n in names]
    lines = [_row(head), _row(["---"] * len(head)), _row(first)]
    for entry in shown:
        labels = [level.label for level in entry.levels]
        cells = [" / ".join(_change(table.get((entry.name, v, n)), COLUMNS[n]) for v in labels) for n in names]
        lines.append(_row([entry.name, entry.nominal, *([*labels, "-"][:1]), " / ".join(labels[1:]) or "-", *cells]))
    largest = {name: [e.noise for e in effects if e.indicator == name] for name in names}
    noise = [f"± {max(v):.{COLUMNS[n]}f}" if v else "-" for n, v in largest.items()]
    lines.append(_row(["*largest noise of a change (95 %)*", "", "", "", *noise]))
    return lines


def _change(effect: Effect | None, decimals: int) -> str:
    if effect is None:
        return "-"
    if effect.change == 0.0:
        return "0"
    text = f"{effect.change:+.{decimals}f}"
    return f"**{text}**" if effect.beyond else text


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"
