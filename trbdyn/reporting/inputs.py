"""Inputs of a scene as rows for people: name, value, unit, what it is, and whether it is known or assumed."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import reduce

from trbdyn.base.shown import field_rows
from trbdyn.base.validation import Model
from trbdyn.model.scene import Scene


@dataclass(frozen=True)
class Row:
    """One input."""

    path: str  # full name, for instance ``bearing.roller.diameter``
    value: str  # the value, as text
    unit: str  # its unit; empty for pure numbers, choices and texts
    text: str  # what it is
    mark: (
        str  # 'assumed': no source gives it, and it is the package's default; 'estimated': from the catalogue's numbers
    )


def rows(scene: Scene) -> list[Row]:
    """Every input of a scene."""
    marks = dict.fromkeys(scene.bearing.assumed, "assumed") | {
        entry.path: "estimated" for entry in scene.bearing.estimated
    }
    found = []
    for path, value, unit, text in field_rows(scene):
        *parts, name = path.split(".")
        owner = reduce(getattr, parts, scene)
        given, info = getattr(owner, name), type(owner).model_fields[name]
        if parts[:1] == ["bearing"]:
            mark = marks.get(path.removeprefix("bearing."), "")
        else:
            default = None if info.is_required() else info.get_default(call_default_factory=True)
            mark = "assumed" if "assumed" in text and given == default else ""
        if isinstance(given, tuple) and any(isinstance(one, Model) for one in given):
            value = ", ".join(map(str, given))  # with all numbers, so that a report of two runs shows which differ
        found.append(Row(path, value, unit, re.sub(r";? assumed", "", text).strip(), mark))
    return found
