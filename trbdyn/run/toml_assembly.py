"""Assemblies as TOML files.

A file has the tables ``[assembly]`` (speed_rpm, torque, gravity), ``[shaft]``, ``[run]`` as a case, a table ``[[bearings]]`` for
each bearing and a table
``[[loads]]`` for each load; their keys are the fields of `Assembly`, `Shaft`, `ShaftBearing` and `ShaftLoad`. The tables
``[bearing]``, ``[lubricant]`` and ``[effects]`` are those of a case (`trbdyn.run.toml_case`) and hold for all bearings; a bearing
may have its own. A load with ``gear = {...}`` or ``wheel = {...}`` has the arguments of `ShaftLoad.gear` or `ShaftLoad.wheel`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from trbdyn.base.shipped import ASSEMBLIES
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly, Shaft, ShaftBearing, ShaftLoad
from trbdyn.model.scene import Scene
from trbdyn.run.options import RunOptions
from trbdyn.run.toml_case import (
    Table,
    bearing_from_table,
    build,
    case_from_dict,
    check_names,
    effects_from_table,
    located,
    lubricant_from_table,
    read_tables,
    table_of,
    without,
)

SHARED: Final = {"bearing": bearing_from_table, "lubricant": lubricant_from_table, "effects": effects_from_table}
MADE_LOADS: Final[dict[str, Callable[..., ShaftLoad]]] = {"gear": ShaftLoad.gear, "wheel": ShaftLoad.wheel}
TABLES: Final = ("assembly", "shaft", "bearings", "loads", "run", *SHARED)


def load_assembly(path: str | Path) -> Assembly:
    """The assembly of a TOML file.

    Parameters
    ----------
    path : str or Path
        The file; where there is none of this name, an assembly that ships with the package.

    Raises
    ------
    FileError
        If the file cannot be read or is no TOML.
    InputError
        If a key is unknown or a value not allowed; the message names the full key.

    Examples
    --------
    >>> import trbdyn as trb
    >>> trb.load_assembly("pair_30310").arrangement
    'back to back'
    """
    return assembly_from_dict(read_tables(ASSEMBLIES.file(path), ASSEMBLIES.hint()))[0]


def assembly_from_dict(values: Mapping[str, Any]) -> tuple[Assembly, RunOptions]:
    """The assembly of the tables of a file, and how it is run.

    Raises
    ------
    InputError
        If a key is unknown or a value not allowed; the message names the full key.
    """
    check_names(values, TABLES, ())
    own = table_of(values, "assembly")
    check_names(own, set(Assembly.model_fields) - {"shaft", "bearings", "loads"}, ("assembly",))
    shared = {name: make(table_of(values, name)) for name, make in SHARED.items() if name in values}
    bearings = tuple(_bearing(table, shared, index) for index, table in enumerate(_tables(values, "bearings")))
    loads = tuple(_load(table, index) for index, table in enumerate(_tables(values, "loads")))
    shaft = build(Shaft, table_of(values, "shaft"), ("shaft",))
    run = build(RunOptions, table_of(values, "run"), ("run",))
    try:
        return Assembly(shaft=shaft, bearings=bearings, loads=loads, **own), run
    except InputError as error:
        inner = ("bearings", "loads", "shaft")
        if any(problem.path and problem.path[0] in inner for problem in error.problems):
            raise
        raise error.under(("assembly",)) from None


def subject_from_dict(values: Mapping[str, Any]) -> tuple[Scene | Assembly, RunOptions]:
    """The scene or the assembly of the tables of a file, and how it is run.

    Raises
    ------
    InputError
        If a key is unknown or a value not allowed; the message names the full key.
    """
    return assembly_from_dict(values) if "assembly" in values else case_from_dict(values)


def _tables(values: Mapping[str, Any], name: str) -> list[Table]:
    tables = values.get(name, [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError.of(name, tables, f"must be tables [[{name}]]")
    return tables


def _bearing(table: Table, shared: Mapping[str, Any], index: int) -> ShaftBearing:
    path = ("bearings", index)
    check_names(table, ShaftBearing.model_fields, path)
    with located(path):
        parts = {name: make(table_of(table, name)) for name, make in SHARED.items() if name in table}
    return build(ShaftBearing, {**shared, **without(table, *SHARED), **parts}, path)


def _load(table: Table, index: int) -> ShaftLoad:
    path = ("loads", index)
    kind = next((name for name in MADE_LOADS if name in table), None)
    if kind is None:
        return build(ShaftLoad, table, path)
    arguments = {**table_of(table, kind), **without(table, kind)}
    known = inspect.signature(MADE_LOADS[kind]).parameters
    check_names(arguments, known, path)
    for name, parameter in known.items():
        if parameter.default is parameter.empty and name not in arguments:
            raise InputError.of((*path, kind), table[kind], f"must have {name}")
    with located(path):
        return MADE_LOADS[kind](**arguments)
