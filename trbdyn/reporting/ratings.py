"""The engineer's sheet (`trbdyn.rating`) and the frequencies of defects as sections of a report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from trbdyn.errors import InputError, TrbError
from trbdyn.reporting.tables import safe, table_of
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.number import steady_sheet
from trbdyn.results.result import Result
from trbdyn.run.rating import rating
from trbdyn.standards.frequencies import frequencies
from trbdyn.standards.sheet import WHICH_LIFE, Rating


def sheet_of(result: Result, reliability: float = 90.0) -> Rating | str:
    """The sheet of a run: that of its summary where speed and loads are constant, else that of its records; or the reason. The
    summary has lives of a reliability of 90 %.
    """
    try:
        return (steady_sheet(result) if reliability == 90.0 else None) or rating(result, reliability=reliability)
    except TrbError as error:
        return str(error).splitlines()[0]


def ratings_section(sheets: Sequence[Rating | str], names: Sequence[str]) -> str:
    """A table of each sheet; where there is none, the reason."""
    parts = []
    for found, name in zip(sheets, names, strict=True):
        of = f"<h3>{safe(name)}</h3>" if len(sheets) > 1 else ""
        if isinstance(found, str):
            parts.append(f"{of}<p>No ratings: {safe(found)}.</p>")
            continue
        notes = "".join(f"<li>{safe(text)}</li>" for text in found.warnings)
        listed = f"<ul class='warnings'>{notes}</ul>" if notes else ""
        parts.append(
            f"{of}{listed}{table_of(('quantity', 'value', 'unit', 'where it comes from'), found._shown().rows)}"
        )
    return f"<details><summary>Ratings and lives</summary>{''.join(parts)}<p>{safe(WHICH_LIFE)}</p></details>"


def system_section(result: AssemblyResult, reliability: float = 90.0) -> str:
    """Lives of each bearing of a shaft and of the whole."""
    try:
        shown = rating(result, reliability=reliability)._shown()
    except TrbError as error:
        return f"<h2>Lives</h2><p>No ratings: {safe(str(error).splitlines()[0])}.</p>"
    notes = "".join(f"<li>{safe(text)}</li>" for text in shown.notes)
    return f"<h2>Lives</h2>{table_of(shown.head, shown.rows[1:])}<ul class='warnings'>{notes}</ul>"


def frequencies_section(results: Sequence[Result], numbers: Sequence[Mapping[str, Any]], names: Sequence[str]) -> str:
    """BPFO, BPFI, BSF and FTF at the mean speeds of the averages' window."""
    rows: list[tuple[str, ...]] = []
    for result, values, name in zip(results, numbers, names, strict=True):
        speeds = {key: values.get(key) or 0.0 for key in ("speed_rpm", "outer_speed_rpm")}
        try:
            shown = frequencies(result.scene.bearing, **speeds)._shown()
        except InputError:
            continue
        of = f"{name}: " if len(results) > 1 else ""
        rows += [(f"{of}{row[0]}, {row[3]}", *row[1:3]) for row in shown.rows[1:]]
    if not rows:
        return ""
    table = table_of(("frequency", "Hz", "order of the shaft"), rows)
    return f"<details><summary>Frequencies of defects: BPFO, BPFI, BSF, FTF</summary>{table}</details>"
