"""Cases as TOML files.

A case has the tables ``[bearing]``, ``[lubricant]``, ``[effects]``, ``[scene]``, ``[start]`` and ``[run]``; their keys
are the fields of `Bearing`, `Lubricant`, `Effects`, `Scene`, `Start` and `RunOptions`. Some tables may start from
something known and then change it:

- ``[bearing] case = "30310"``: a bearing that ships with the package; ``named = "32208"``: one of the table of designations;
- ``[bearing.cage.pocket] shape = "drafted"``: a builder of `trbdyn.pocket_shapes`, its arguments beside it; as well in
  ``[[bearing.cage.other_pockets]]``;
- ``[bearing.cage] drawing = "cage.step"``: a cage as drawn (`Cage.from_step`); or a table of ``file`` and arguments;
- ``[bearing.roller.profile] trace = "roller.csv"``: a measured trace or a drawn line (`trbdyn.read_trace`), its
  arguments beside it; as well in ``[bearing.cup_profile]`` and ``[bearing.cone_profile]``;
- ``[lubricant] oil = "vg100"``: an oil of `trbdyn.lubricants.OILS` at ``temperature_c``, or the table of an `Oil`;
- ``[effects] preset = "paper"``: a preset of `Effects`.

A quantity that changes in time is a table of ``times`` (s) and ``values``.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, TypeVar

from trbdyn.base.extras import of_extras
from trbdyn.base.reading import read_input_text, tables_of
from trbdyn.base.shipped import CASES
from trbdyn.base.validation import Model
from trbdyn.errors import MISSING, MOST_TOLD, FileError, InputError, Problem, unknown_name
from trbdyn.errors import Path as FieldPath
from trbdyn.model.bearing import Bearing
from trbdyn.model.cage import Cage
from trbdyn.model.cases import BEARINGS
from trbdyn.model.effects import PRESETS, Effects, refuse_idle
from trbdyn.model.lubricants import Lubricant, vg100
from trbdyn.model.pocket import Pocket
from trbdyn.model.pocket_shapes import SHAPES
from trbdyn.model.roller import Profile
from trbdyn.model.scene import Scene, Start
from trbdyn.run.options import RunOptions

Table = dict[str, Any]
C = TypeVar("C")
M = TypeVar("M", bound=Model)

TABLES: Final = ("bearing", "lubricant", "effects", "scene", "start", "run")
_OWN_TABLES: Final = ("bearing", "lubricant", "effects", "start")


def load_case(path: str | Path) -> tuple[Scene, RunOptions]:
    """Scene and run options of a TOML file.

    Parameters
    ----------
    path : str or Path
        The file; where there is none of this name, a case that ships with the package.

    Raises
    ------
    FileError
        If the file cannot be read or is no TOML.
    InputError
        If a key is unknown or a value not allowed; the message names the full key.
    """
    return case_from_dict(read_tables(CASES.file(path), CASES.hint()))


def read_tables(file: Path, hint: str = "") -> Table:
    """The tables of a TOML file.

    Raises
    ------
    FileError
        If it cannot be read or is no TOML; where it cannot be opened, `hint` is added to the message.
    """
    text = read_input_text(file, "TOML", hint=hint)
    try:
        return tables_of(text)
    except ValueError as error:
        raise FileError(f"{file}: not a TOML file that can be used: {error}") from None


def case_from_dict(values: Mapping[str, Any]) -> tuple[Scene, RunOptions]:
    """Scene and run options of the tables of a case.

    Raises
    ------
    InputError
        If a key is unknown or a value not allowed; the message names the full key.
    """
    check_names(values, TABLES, ())
    tables = {name: table_of(values, name) for name in TABLES}
    if "bearing" not in values:
        raise InputError([Problem(("bearing",), MISSING, "is required; for instance case = '30310'")])
    run = build(RunOptions, tables["run"], ("run",))
    fields = {
        "bearing": bearing_from_table(tables["bearing"]),
        "lubricant": lubricant_from_table(tables["lubricant"]) if "lubricant" in values else vg100(),
        "effects": effects_from_table(tables["effects"]),
        "start": build(Start, tables["start"], ("start",)),
    }
    check_names(tables["scene"], set(Scene.model_fields) - set(_OWN_TABLES), ("scene",))
    try:
        return Scene(**fields, **tables["scene"]), run
    except InputError as error:
        raise InputError([_in_tables(problem) for problem in error.problems]) from None


def bearing_from_table(table: Table) -> Bearing:
    """The bearing of a ``[bearing]`` table.

    Raises
    ------
    InputError
        If a key is unknown or a value not allowed; the message names the full key.
    """
    path = ("bearing",)
    check_names(table, {*Bearing.model_fields, "case", "named"}, path)
    base = _choose(table, "case", BEARINGS, path)().inputs() if "case" in table else {}
    if "named" in table:
        with located(path):
            base = Bearing.named(table["named"]).inputs()
    values = merged(base, without(table, "case", "named"))
    values = _with_traces(values, table, path)
    cage, own = values.get("cage"), _at(table, "cage")
    if isinstance(cage, dict) and _is_to_be_read(own.get("drawing")):
        plain = build(Bearing, {**values, "cage": {name: own[name] for name in ("material",) if name in own}}, path)
        with located((*path, "cage")):
            drawn = _drawn(plain, cage["drawing"]).replace(**without(own, "drawing", "material"))
        with located(path):
            return plain.replace(cage=drawn)
    if not isinstance(cage, dict) or not _has_shapes(cage):
        return build(Bearing, values, path)
    plain = build(Bearing, {**values, "cage": without(cage, "pocket", "other_pockets")}, path)
    pockets = _pockets(plain, cage, (*path, "cage"))
    with located((*path, "cage")):
        full = plain.cage.replace(**pockets)
    with located(path):
        return plain.replace(cage=full)


def _with_traces(values: Table, table: Table, path: FieldPath) -> Table:
    """The values of a bearing, profiles read where a trace is named; they need the effective length alone."""
    places = [
        (inside, name)
        for inside, name in ((("roller",), "profile"), ((), "cup_profile"), ((), "cone_profile"))
        if isinstance(found := _at(values, *inside).get(name), dict) and "trace" in found
    ]
    if not places:
        return values
    plain = {
        **without(values, "cage", "cup_profile", "cone_profile"),
        "roller": without(_at(values, "roller"), "profile"),
    }
    length = build(Bearing, plain, path).roller.effective_length
    known = {"trace", *tuple(inspect.signature(of_extras("read_trace")).parameters)[2:]}
    for inside, name in places:
        own = _at(table, *inside)[name]
        check_names(own, known, (*path, *inside, name))
        with located((*path, *inside, name)):
            profile = Profile.from_trace(own["trace"], length, **without(own, "trace"))
        values = merged(values, {"roller": {name: profile}} if inside else {name: profile})
    return values


def _at(table: Table, *inside: str) -> Table:
    """A table in a table; an empty one where there is none."""
    for name in inside:
        found = table.get(name)
        table = found if isinstance(found, dict) else {}
    return table


def _is_to_be_read(drawing: object) -> bool:
    """Whether a cage's drawing is a file that is to be read, and not the record of one that a cage was read from."""
    return drawing is not None and not (isinstance(drawing, dict) and "sha256" in drawing)


def _drawn(bearing: Bearing, given: object) -> Cage:
    """A cage from a drawing."""
    table: Table = dict(given) if isinstance(given, Mapping) else {"file": given}
    if not isinstance(file := table.pop("file", None), str):
        raise InputError.of(("drawing", "file"), file, "must be the path of a STEP or STL file")
    check_names(table, ("tolerance", "unit", "roller_plane", "chamfer"), ("drawing",))
    return Cage.from_step(file, bearing, material=bearing.cage.material, **table)


def _has_shapes(cage: Table) -> bool:
    """Whether a pocket of the cage is given by a builder's name."""
    others = cage.get("other_pockets")
    listed = others if isinstance(others, list) else []
    return _is_shape(cage.get("pocket")) or any(isinstance(o, dict) and _is_shape(o.get("pocket")) for o in listed)


def _pockets(bearing: Bearing, cage: Table, path: FieldPath) -> Table:
    """The pockets of a cage's table, shapes built for the bearing."""
    pockets = {name: cage[name] for name in ("pocket", "other_pockets") if cage.get(name) is not None}
    if _is_shape(pockets.get("pocket")):
        pockets["pocket"] = _pocket(bearing, pockets["pocket"], (*path, "pocket"))
    others = pockets.get("other_pockets")
    if isinstance(others, list):
        pockets["other_pockets"] = [_other(bearing, o, (*path, "other_pockets", i)) for i, o in enumerate(others)]
    return pockets


def _other(bearing: Bearing, table: object, path: FieldPath) -> object:
    if isinstance(table, dict) and _is_shape(table.get("pocket")):
        return {**table, "pocket": _pocket(bearing, table["pocket"], (*path, "pocket"))}
    return table


def _is_shape(table: object) -> bool:
    return isinstance(table, dict) and "shape" in table


def _pocket(bearing: Bearing, table: Table, path: FieldPath) -> Pocket:
    """The pocket that a builder makes of the arguments in a table."""
    builder = _choose(table, "shape", SHAPES, path)
    arguments = without(table, "shape", "allow_interference")
    parameters = list(inspect.signature(builder).parameters.values())[1:]
    check_names(arguments, {"allow_interference", *(parameter.name for parameter in parameters)}, path)
    for parameter in parameters:
        if parameter.default is parameter.empty and parameter.name not in arguments:
            raise InputError(
                [Problem((*path, parameter.name), MISSING, f"is required by the shape '{table['shape']}'")]
            )
    with located(path):
        pocket = builder(bearing, **arguments)
        return pocket.replace(allow_interference=table.get("allow_interference", False))


def lubricant_from_table(table: Table) -> Lubricant:
    return build(Lubricant, table, ("lubricant",))


def effects_from_table(table: Table) -> Effects:
    path = ("effects",)
    check_names(table, {*Effects.model_fields, "preset"}, path)
    preset = _choose({"preset": "standard", **table}, "preset", PRESETS, path)
    # a whole table has the coefficients of every law, and no line of what is None; one of an earlier version had full supply
    always = {name for name, one in Effects.model_fields.items() if one.default is not None}
    earlier = {"rolling_load": "slices", "supply": 1.0} if table.keys() >= always - {"rolling_load"} else {}
    own = without(table, "preset")
    values = merged(preset().to_dict(), (earlier if "rolling_load" not in table else {}) | own)
    if not table.keys() >= always - {"rolling_load"}:
        with located(path):
            refuse_idle(values["damping"], values["lubrication"], table)
    return build(Effects, values, path)


def _in_tables(problem: Problem) -> Problem:
    """A problem of a scene, at the key of the case that it comes from."""
    path = problem.path if problem.path and problem.path[0] in _OWN_TABLES else ("scene", *problem.path)
    return Problem(path, problem.value, problem.allowed)


def table_of(values: Mapping[str, Any], name: str) -> Table:
    table = values.get(name, {})
    if not isinstance(table, dict):
        raise InputError.of(name, table, "must be a table of named values")
    return table


def check_names(table: Mapping[str, Any], allowed: Iterable[str], path: FieldPath) -> None:
    names = set(allowed)
    unknown = [(key, value) for key, value in table.items() if key not in names]
    if unknown:
        told = unknown[:MOST_TOLD]
        raise InputError([Problem((*path, key), value, unknown_name(key, names)) for key, value in told])


def _choose(table: Mapping[str, Any], key: str, choices: Mapping[str, C], path: FieldPath) -> C:
    """What a key of a table names."""
    value = table[key]
    if not isinstance(value, str) or value not in choices:
        allowed = ", ".join(repr(choice) for choice in choices)
        raise InputError([Problem((*path, key), value, f"must be one of {allowed}")])
    return choices[value]


def build(model: type[M], table: Mapping[str, Any], path: FieldPath) -> M:
    with located(path):
        return model(**table)


@contextmanager
def located(path: FieldPath) -> Iterator[None]:
    """Problems that arise inside are told with their full key."""
    try:
        yield
    except InputError as error:
        raise error.under(path) from None


def without(table: Table, *names: str) -> Table:
    return {key: value for key, value in table.items() if key not in names}


def merged(base: Table, changes: Mapping[str, Any]) -> Table:
    """A table with the values of another put in, table by table."""
    result = dict(base)
    for key, value in changes.items():
        own = result.get(key)
        result[key] = merged(own, value) if isinstance(own, dict) and isinstance(value, dict) else value
    return result
