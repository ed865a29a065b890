"""Studies in TOML files."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Final

from trbdyn.base.own_files import file_path
from trbdyn.base.shipped import DATA
from trbdyn.errors import InputError
from trbdyn.extras.study.definition import Study, Table, read_toml
from trbdyn.extras.study.design import cases, grid, random
from trbdyn.run.toml_case import merged

STUDIES: Final = DATA / "studies"
"""Where the shipped studies lie."""
_KINDS: Final = ("grid", "list", "random")
_OWN_NAMES: Final = (*_KINDS, "count", "seed", "ranges", "name")


def shipped_studies() -> tuple[str, ...]:
    """Names of the studies that ship with the package."""
    return tuple(sorted(path.stem for path in STUDIES.glob("*.toml")))


def load_study(path: str | FilePath) -> Study:
    """A study from a TOML file, or one that ships with the package by its name.

    The file holds the tables of a case (see `trbdyn.run.toml_case`) that every run shares, and a table ``[study]`` with

    - ``case``: name of a case to start from (optional); the tables of the file are put into it;
    - one of ``[study.grid]`` (values of each path), ``[[study.list]]`` (a table of values by paths for each case) and
      ``[study.random]`` (``count``, ``seed`` and a table ``ranges`` as `random` takes it).

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If something in it cannot be used.
    """
    file_path(path, "study")
    if not FilePath(path).exists() and str(path) in shipped_studies():
        path = STUDIES / f"{path}.toml"
    values = read_toml(path)
    table = values.pop("study", None)
    if not isinstance(table, dict):
        raise InputError.of("study", table, "must be a table of the file")
    unknown = set(table) - {"case", "name", *_KINDS}
    if unknown:
        raise InputError.of(
            ("study", min(unknown)), table[min(unknown)], f"unknown; allowed: case, name, {', '.join(_KINDS)}"
        )
    if sum(kind in table for kind in _KINDS) != 1:
        raise InputError.of("study", sorted(table), f"must hold one of {', '.join(_KINDS)}")
    kind = next(kind for kind in _KINDS if kind in table)
    wanted, what = (list, "an array of tables") if kind == "list" else (dict, "a table")
    if not isinstance(table[kind], wanted):
        raise InputError.of(("study", kind), table[kind], f"must be {what}")
    for key in ("case", "name"):
        if not isinstance(table.get(key, ""), str):
            raise InputError.of(("study", key), table[key], "must be text")
    try:
        return _study(path, table, values)
    except InputError as error:
        # what is wrong in the table of the study is told with its whole key
        raise (error if error.problems[0].path[0] not in _OWN_NAMES else error.under(("study",))) from None


def _study(path: str | FilePath, table: Table, values: Table) -> Study:
    tables = read_toml(_beside(path, table["case"])) if "case" in table else {}
    for key, entry in values.items():
        own = tables.get(key)
        tables[key] = merged(own, entry) if isinstance(own, dict) and isinstance(entry, dict) else entry
    name = table.get("name", FilePath(path).stem)
    if "grid" in table:
        return grid(tables, table["grid"], name=name)
    if "list" in table:
        return cases(tables, table["list"], name=name)
    draws = table["random"]
    if set(draws) != {"count", "seed", "ranges"}:
        raise InputError.of("random", sorted(draws), "must hold count, seed and ranges")
    return random(tables, draws["ranges"], draws["count"], draws["seed"], name=name)


def _beside(path: str | FilePath, case: str) -> str | FilePath:
    """A case's file beside the study's, or the name of a shipped case."""
    beside = FilePath(path).parent / case
    return beside if beside.is_file() else case
