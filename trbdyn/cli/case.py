"""What several commands share: a case with changed values, and its run."""

from __future__ import annotations

import math
import sys
import tomllib
import warnings
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trbdyn.cli.outcome import say
from trbdyn.errors import InputError

if TYPE_CHECKING:
    from trbdyn.model.assembly import Assembly
    from trbdyn.model.scene import Scene
    from trbdyn.run.options import RunOptions


def subject_with_changes(name: str, changes: Sequence[str]) -> tuple[Scene | Assembly, RunOptions]:
    """A case of one bearing or of several on a shaft, with ``table.key=value`` changes put in."""
    from trbdyn.run.toml_assembly import subject_from_dict

    return subject_from_dict(_tables(name, changes))


def _tables(name: str, changes: Sequence[str]) -> dict[str, Any]:
    from trbdyn.base.shipped import SUBJECTS
    from trbdyn.model.scene import Scene
    from trbdyn.run.toml_case import read_tables

    path = SUBJECTS.file(name)
    if changes and not path.exists():
        path = SUBJECTS.find(name)
    values = read_tables(path, SUBJECTS.hint())
    for change in changes:
        key, equals, text = change.partition("=")
        *tables, last = key.strip().split(".")
        if not equals or not last:
            raise InputError.of("--set", change, "must be KEY=VALUE, for instance scene.speed_rpm=1000")
        if not tables and "scene" in values and not isinstance(values.get(last), dict):
            hint = f"; did you mean scene.{last}?" if last in Scene.model_fields else ""
            raise InputError.of("--set", change, f"must name a table, for instance scene.speed_rpm=1000{hint}")
        table: Any = values
        for part in tables:
            if isinstance(table, list):
                if not part.isdigit() or int(part) >= len(table):
                    raise InputError.of("--set", change, f"{part!r} must be a number from 0 to {len(table) - 1}")
                table = table[int(part)]
            else:
                table = table.setdefault(part, {})
            if not isinstance(table, dict | list):
                raise InputError.of("--set", change, f"{part!r} is a value, not a table")
        if isinstance(table, list):
            raise InputError.of(
                "--set", change, f"{tables[-1]!r} is a list of tables: name one of them, {tables[-1]}.0.{last}"
            )
        table[last] = _toml_value(text)
    return values


def _toml_value(text: str) -> Any:
    """A TOML value; what is none is text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text.strip()
    except (ValueError, RecursionError):
        raise InputError.of("--set", text, "must be a TOML value that is not that long or deep") from None


def named_numbers(option: str, texts: Sequence[str], form: str, example: str) -> dict[str, float]:
    """Numbers by their names, of texts ``NAME=NUMBER`` that were given for an option; each name once."""
    found: dict[str, float] = {}
    for text in texts:
        name, _, number = text.partition("=")
        try:
            value = float(number)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError.of(option, text, f"must be {form}, for instance {example}")
        if name.strip() in found:
            raise InputError.of(option, text, f"must not name {name.strip()} again: it was given before")
        found[name.strip()] = value
    return found


def simulate(
    subject: Scene | Assembly,
    run: RunOptions,
    output: Path,
    *,
    quiet: bool,
    overwrite: bool,
    given: Collection[str] = (),
) -> Any:
    """Run a case, which gives a result; what is not given of what to keep is chosen by the length of the run."""
    from trbdyn.run.simulation import Simulation

    run.end_time(subject)
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always", UserWarning)
        simulation = Simulation(subject, **run.of_simulation())
    for note in notes:
        say(f"trbdyn: warning: {note.message}", file=sys.stderr)
    how: dict[str, Any] = {
        name: getattr(run, name) if name in given else None for name in ("save_every", "save_groups")
    }
    how |= {"revolutions": run.revolutions, "duration": run.duration, "progress": not quiet}
    how |= {"output": output, "overwrite": overwrite}
    return simulation.run(until=run.until, **how)
