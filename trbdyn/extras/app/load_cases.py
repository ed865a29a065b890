"""The spectrum of the page: rows of load cases that change what was typed into fields."""

from __future__ import annotations

import copy
from typing import Any, Final

from trbdyn.errors import InputError, TrbError
from trbdyn.extras.app.design import Design, all_fields, built
from trbdyn.extras.study.spectrum import table_rows

COLUMNS: Final = {
    "speed": "scene.speed_rpm",
    "outer_speed": "scene.outer_speed_rpm",
    "axial_load": "scene.axial_load",
    "radial_load": "scene.radial_load",
    "torque": "gear.torque",
    "wheel_load": "wheel.load",
    "cornering": "wheel.cornering",
    "temperature": "lubricant.temperature_c",
}
"""Columns by the fields that they change; numbers are in the units of the page."""
NEEDS: Final = {
    "torque": ("gear", "two bearings on a shaft with a gear"),
    "wheel_load": ("wheel", "a wheel hub"),
    "cornering": ("wheel", "a wheel hub"),
}
"""Columns of what acts on some shafts alone: what that is, and how the page calls it."""
MOST: Final = 200
"""Most load cases."""


def cases_of(design: Design) -> list[tuple[str, float, dict[str, Any]]]:
    """Name, share of time and tables of each load case; a ValueError that names the row if one cannot be used."""
    if not design.spectrum.strip():
        return []
    try:
        rows = table_rows(design.spectrum, "the spectrum")
    except TrbError as error:
        raise ValueError(str(error)) from None
    if len(rows) > MOST:
        raise ValueError(f"has {len(rows)} load cases: at most {MOST} are taken")
    found = []
    for index, row in enumerate(rows, 1):
        name = row.get("name") or f"case {index}"
        if unknown := sorted(set(row) - {"name", "share", *COLUMNS}):
            raise ValueError(f"{unknown[0]}: must be one of the columns name, share, {', '.join(COLUMNS)}")
        for column, (acts, words) in NEEDS.items():
            if row.get(column) and not (design.pair and design.acts == acts):
                raise ValueError(f"{column}: must not be given here: it is of {words}, see What turns?")
        try:
            share = float(row.get("share", ""))
        except ValueError:
            raise ValueError(f"{name}: share must be a number, the time of the case") from None
        if not 0.0 <= share < float("inf"):
            raise ValueError(f"{name}: share must be >= 0 and finite")
        one = copy.deepcopy(design)
        one.typed |= {COLUMNS[key]: text for key, text in row.items() if key in COLUMNS and text}
        made = built(one)
        if made.problems or made.subject is None:
            where, why = next(iter(made.problems.items()), ("", "cannot be made"))
            field = all_fields(one, made.base).get(where)
            raise ValueError(f"{name}: {field.words if field else where}: {why}")
        found.append((name, share, made.tables))
    if not any(share > 0.0 for _, share, _ in found):
        raise ValueError("must have a share > 0 in one case at least")
    return found


def checked(design: Design) -> str | None:
    """What is wrong with the table of load cases, None if nothing."""
    try:
        cases_of(design)
    except (ValueError, InputError) as error:
        return str(error)
    return None
