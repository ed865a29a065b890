"""What several commands share: a case with changed values, and its run."""

from __future__ import annotations

import argparse
import sys
import tomllib
import warnings
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trbdyn.base.own_files import file_path
from trbdyn.errors import InputError

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene
    from trbdyn.results.result import Result
    from trbdyn.run.options import RunOptions


def add_set(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        dest="changes",
        metavar="KEY=VALUE",
        help="change a value of the case, for instance scene.speed_rpm=1000 (may be given several times)",
    )


def case_with_changes(name: str, changes: Sequence[str]) -> tuple[Scene, RunOptions]:
    """A case, with ``table.key=value`` changes put in."""
    from trbdyn.run.toml_case import case_from_dict, find_case, load_case, read_tables

    if not changes:
        return load_case(name)
    path = file_path(name, "case")
    values = read_tables(path if path.exists() else find_case(name))
    for change in changes:
        key, equals, text = change.partition("=")
        *tables, last = key.strip().split(".")
        if not equals or not last:
            raise InputError.of("--set", change, "must be KEY=VALUE, for instance scene.speed_rpm=1000")
        table = values
        for part in tables:
            table = table.setdefault(part, {})
            if not isinstance(table, dict):
                raise InputError.of("--set", change, f"{part!r} is a value, not a table")
        table[last] = _toml_value(text)
    return case_from_dict(values)


def _toml_value(text: str) -> Any:
    """A TOML value; what is none is text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text.strip()
    except (ValueError, RecursionError):
        raise InputError.of("--set", text, "must be a TOML value that is not that long or deep") from None


def simulate(
    scene: Scene, run: RunOptions, output: Path, *, quiet: bool, overwrite: bool, given: Collection[str] = ()
) -> Result:
    """Run a case; what is not given of what to keep is chosen by the length of the run."""
    from trbdyn.run.simulation import Simulation

    run.end_time(scene.speed_rpm)
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always", UserWarning)
        simulation = Simulation(scene, **run.of_simulation())
    for note in notes:
        print(f"trbdyn: warning: {note.message}", file=sys.stderr)
    return simulation.run(
        revolutions=run.revolutions,
        duration=run.duration,
        until=run.until,
        save_every=run.save_every if "save_every" in given else None,
        save_groups=run.save_groups if "save_groups" in given else None,
        progress=not quiet,
        output=output,
        overwrite=overwrite,
    )
