"""A ``paper.json`` that is there, with the numbers of more points: what was computed once is not computed again.

The judges need nothing of a point but its numbers, so that all statements are judged again from the file alone.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, cast

from common import revision

from paper.point_numbers import Run, Runs
from paper.points import STARTS, Inputs, Point, conditions, points
from paper.statements import by_inputs, judge_all, judge_inputs
from trbdyn.base.own_files import write_whole
from trbdyn.results.summary import clean

DIRECTIONS: Final = (90.0, 180.0, 0.0, -90.0)
SCATTERS: Final = (0.0, 0.2e-6, 1e-6)
SEEDS: Final = (0, 1, 2, 3)


def known() -> dict[str, Point]:
    """Points of the campaign by their names."""
    asked = [Inputs(direction, scatter) for direction in DIRECTIONS for scatter in SCATTERS]
    listed = [*points((), STARTS, SEEDS, asked), *(Point(c, start, 0) for c in conditions() for start in STARTS)]
    return {point.name: point for point in listed}


def runs_of(numbers: Mapping[str, Mapping[str, Any]]) -> Runs:
    """Points of a file, with nothing but their numbers."""
    found, nothing = known(), cast("Any", None)
    return Runs([Run(found[name], nothing, nothing, {"settled": n["settled"]}, dict(n)) for name, n in numbers.items()])


def keep(path: Path, added: Runs) -> str:
    """Add points to a file, judge all statements again, and give the table of verdicts by inputs.

    Parameters
    ----------
    path : Path
        The file.
    added : Runs
        Points; they take the place of those of the same name.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    values: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    old = values["points"]
    new = {run.point.name: clean(run.numbers) | {"revision": revision()} for run in added.all}
    values["points"] = old | {name: n for name, n in new.items() if _differs(old.get(name), n)}
    every = runs_of(values["points"])
    judged = {entry.statement.key: entry.to_dict() for entry in judge_all(every.within(Inputs()))}
    values["statements"] = [judged.get(entry["key"], entry) for entry in values["statements"]]
    sets = {inputs: judge_inputs(every, inputs) for inputs in every.inputs}
    values["statements_by_inputs"] = {
        inputs.name: [entry.to_dict() for entry in found] for inputs, found in sets.items()
    }
    text = json.dumps(json.loads(json.dumps(clean(values))), indent=1) + "\n"
    write_whole(path, text, overwrite=True, field="into")
    return by_inputs(sets)


def _differs(old: Mapping[str, Any] | None, new: Mapping[str, Any]) -> bool:
    """Whether a point is another run than that of the file: the time that it took, and the revision, tell nothing of it."""
    aside = ("wall_s", "revision")
    return old is None or any(old.get(name) != value for name, value in new.items() if name not in aside)
