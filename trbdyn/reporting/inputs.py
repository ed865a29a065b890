"""Inputs of a scene as rows for people: name, value, unit, what it is, and whether it is known or assumed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from trbdyn.base.shown import field_texts
from trbdyn.base.validation import Model
from trbdyn.model.scene import Scene

HIDDEN = ("estimates",)
LONGEST_LIST = 6


@dataclass(frozen=True)
class Row:
    """One input."""

    path: str  # full name, for instance ``bearing.roller.diameter``
    value: str  # the value, as text
    unit: str  # its unit; empty for pure numbers, choices and texts
    text: str  # what it is
    mark: str
    """Assumed: no source gives it, and it is the default of the package. Estimated: from the catalogue's
    numbers."""


def rows(scene: Scene) -> list[Row]:
    """Every input of a scene."""
    marks = dict.fromkeys(scene.bearing.assumed, "assumed") | {
        entry.path: "estimated" for entry in scene.bearing.estimated
    }
    return list(_rows(scene, "", marks))


def _rows(model: Model, prefix: str, marks: dict[str, str]) -> Iterator[Row]:
    texts = field_texts(type(model))
    for name, info in type(model).model_fields.items():
        if name in HIDDEN:
            continue
        value, path = getattr(model, name), f"{prefix}{name}"
        if isinstance(value, Model) and name not in ("pocket",) and not _is_history(value):
            yield from _rows(value, f"{path}.", marks)
            continue
        if value is None or value == ():
            continue
        extra = info.json_schema_extra
        unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
        text = texts.get(name, "")
        unit = unit or _unit_in(text)
        default = info.get_default(call_default_factory=True) if not info.is_required() else None
        mark = "assumed" if "assumed" in text and value == default else ""
        if path.startswith("bearing."):
            mark = marks.get(path.removeprefix("bearing."), "")
        yield Row(path, _shown(value), "" if unit == "1" else unit, _short(text), mark)


def _is_history(value: object) -> bool:
    return type(value).__name__ == "History"


def _unit_in(text: str) -> str:
    found = re.search(r"\((m|N|rad|rpm|Pa|kg|deg|C|s|m/s2|N m|kg/m3|kg m2|1/Pa|1/K|Pa s|W/mK)\)", text)
    return found[1] if found else ""


def _short(text: str) -> str:
    text = re.sub(
        r"\s*\((?:m|N|1|rad|rpm|Pa|kg|deg|C|s|N m|kg/m3|kg m2|1/Pa|1/K|Pa s|W/mK|m/s2|s/m|m/s|N/m\^1\.5)\)", "", text
    )
    return re.sub(r";? assumed", "", text).strip()


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, float):
        return f"{value:.6g}"
    if _is_history(value):
        return "changes in time"
    if isinstance(value, Model):
        faces = getattr(value, "faces", None)
        return f"{len(faces)} faces of its own" if faces is not None else str(value)
    if isinstance(value, tuple):
        listed = [_shown(entry) for entry in value[:LONGEST_LIST]]
        return ", ".join(listed) + (f" and {len(value) - LONGEST_LIST} more" if len(value) > LONGEST_LIST else "")
    return str(value)
