"""The engineer's sheet (`trbdyn.rating`) as a section of a report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from trbdyn.errors import TrbError
from trbdyn.reporting.tables import safe
from trbdyn.run.rating import rating

if TYPE_CHECKING:
    from trbdyn.results.result import Result


def ratings_section(results: Sequence[Result], names: Sequence[str]) -> str:
    """A table of the sheet of each result; where there is none, the reason."""
    parts = []
    for result, name in zip(results, names, strict=True):
        of = f"<h3>{safe(name)}</h3>" if len(results) > 1 else ""
        try:
            found = rating(result)
        except TrbError as error:
            parts.append(f"{of}<p>No ratings: {safe(str(error).splitlines()[0])}.</p>")
            continue
        body = (
            "<tr class='heads'><th>quantity</th><th>value</th><th>unit</th><th>where it comes from</th></tr>"
            + "".join(
                f"<tr><td class='q'>{safe(row.words)} {safe(row.symbol)}</td><td class='n number'>{row.shown}</td>"
                f"<td class='u'>{safe(row.unit)}</td><td>{safe(row.note)}</td></tr>"
                for row in found.rows
                if row.value is not None or row.note
            )
        )
        notes = "".join(f"<li>{safe(text)}</li>" for text in found.warnings)
        listed = f"<ul class='warnings'>{notes}</ul>" if notes else ""
        parts.append(f"{of}{listed}<table>{body}</table>")
    return f"<h2>Ratings and lives</h2>{''.join(parts)}"
