"""The cases of a study: a base and overrides of its values, as a grid, a list or seeded random draws."""

from __future__ import annotations

import hashlib
import itertools
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as FilePath
from typing import Any, Final

import numpy as np

from trbdyn.errors import FileError, InputError, Path, join_path
from trbdyn.run_options import RunOptions
from trbdyn.scene import Scene
from trbdyn.toml_case import DATA, TABLES, case_from_dict, find_case, shipped_cases
from trbdyn.validation import Model

Table = dict[str, Any]
Overrides = Mapping[str, Any]

STUDIES: Final = DATA / "studies"

_PART: Final = re.compile(r"([A-Za-z_]\w*)((?:\[\d+\])*)")
_CHOOSERS: Final = {"bearing": "case", "lubricant": "oil", "effects": "preset"}
"""Keys that call for something known: in place of a whole table where the base is a scene."""


@dataclass(frozen=True)
class Base:
    """What overrides change: the tables of a case.

    Attributes
    ----------
    tables : dict
        Tables as in a TOML case, `trbdyn.toml_case`.
    whole : bool
        Whether every value is given, as for a base made of a scene.
    """

    tables: Table
    whole: bool = False

    @classmethod
    def of(cls, base: Scene | Mapping[str, Any] | str | FilePath | Base, run: RunOptions | None = None) -> Base:
        """A base from a scene, the tables of a case, or the name of a TOML case.

        Raises
        ------
        FileError
            If the case cannot be read.
        """
        if isinstance(base, Base):
            made = base
        elif isinstance(base, Scene):
            values = base.to_dict()
            own = {name: values.pop(name) for name in ("bearing", "lubricant", "effects", "start")}
            made = cls({**own, "scene": values}, whole=True)
        elif isinstance(base, Mapping):
            made = cls(dict(base))
        else:
            made = cls(read_toml(base))
        return made if run is None else cls({**made.tables, "run": run.to_dict()}, made.whole)

    def build(self, overrides: Overrides) -> tuple[Scene, RunOptions]:
        """Scene and run options with overrides put in.

        Raises
        ------
        InputError
            If a path leads nowhere or a value is not allowed.
        """
        tables = json.loads(json.dumps(self.tables))
        if self.whole:
            self._check_whole(overrides)
            for table, chooser in _CHOOSERS.items():
                if f"{table}.{chooser}" in overrides:
                    tables[table] = {}
        for path in sorted(overrides, key=lambda name: (name.count(".") + name.count("["), name)):
            put(tables, path, plain(overrides[path]))
        return case_from_dict(tables)

    @staticmethod
    def _check_whole(overrides: Overrides) -> None:
        name = "lubricant.temperature_c"
        if name in overrides and not {"lubricant.oil", "lubricant"} & set(overrides):
            raise InputError.of(
                name,
                overrides[name],
                "would change the temperature but not the viscosities that belong to it; give lubricant.oil beside it, "
                "or a whole lubricant",
            )


def read_toml(path: str | FilePath) -> Table:
    """The tables of a TOML file, or of a case that ships with the package.

    Raises
    ------
    FileError
        If it cannot be read.
    """
    import tomllib

    file = FilePath(path)
    if not file.exists() and str(path).removesuffix(".toml") in shipped_cases():
        file = find_case(str(path))
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(f"{file}: {error.strerror or error}") from None
    except ValueError as error:
        raise FileError(f"{file}: not a TOML file: {error}") from None


def split_path(path: str) -> Path:
    """The parts of a dotted path: ``scene.gravity[1]`` gives ``('scene', 'gravity', 1)``.

    Raises
    ------
    InputError
        If it is no path to a value of a case.
    """
    parts: list[str | int] = []
    for piece in path.split("."):
        match = _PART.fullmatch(piece)
        if match is None:
            raise InputError.of("override", path, "must be a dotted path, for instance 'scene.speed_rpm'")
        parts.append(match[1])
        parts.extend(int(index) for index in re.findall(r"\d+", match[2]))
    if parts[0] not in TABLES or parts == ["scene"]:
        raise InputError.of("override", path, f"must start with one of {', '.join(f'{name}.' for name in TABLES)}")
    return tuple(parts)


def put(tables: Table, path: str, value: Any) -> None:
    """Put a value into nested tables; tables that are missing on the way are made.

    Raises
    ------
    InputError
        If the path leads through a value that is no table, or to a place that a list does not have.
    """
    parts = split_path(path)
    place: Any = tables
    for done, (part, after) in enumerate(itertools.zip_longest(parts, parts[1:])):
        if isinstance(part, int):
            if not isinstance(place, list) or part >= len(place):
                raise InputError.of(join_path(parts[: done + 1]), value, "there is no such place; give the whole list")
        elif not isinstance(place, dict):
            raise InputError.of(path, value, f"{join_path(parts[:done])} is a value, not a table")
        elif isinstance(after, str) and place.get(part) is None:
            place[part] = {}
        elif isinstance(after, int) and part not in place:
            raise InputError.of(path, value, f"{join_path(parts[: done + 1])} is not given; give the whole list")
        if after is None:
            place[part] = value
        else:
            place = place[part]


def plain(value: Any) -> Any:
    """A value as plain data, as the tables of a case hold it."""
    if isinstance(value, Model):
        return value.to_dict()
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    return value


def fingerprint(scene: Scene, run: RunOptions) -> str:
    """What tells a case from another: SHA-256 of scene and run options, as hexadecimal digits."""
    return hashlib.sha256(f"{scene.fingerprint} {run.fingerprint}".encode()).hexdigest()


@dataclass(frozen=True)
class Case:
    """One case of a study.

    Attributes
    ----------
    parameters : dict of str to value
        What tells it from the others: numbers or texts.
    scene : Scene or None
        What is run; None if it cannot be built.
    run : RunOptions
        How it is run.
    error : str
        Why it cannot be built.
    """

    parameters: dict[str, Any]
    scene: Scene | None
    run: RunOptions
    error: str = ""

    @cached_property
    def fingerprint(self) -> str:
        """`fingerprint` of scene and run options."""
        if self.scene is None:
            return hashlib.sha256(f"{self.parameters!r} {self.error}".encode()).hexdigest()
        return fingerprint(self.scene, self.run)

    @cached_property
    def name(self) -> str:
        """A name for files: the parameters, and the beginning of the fingerprint."""
        words = "_".join(f"{key.rsplit('.', 1)[-1]}={label(value)}" for key, value in self.parameters.items())
        words = re.sub(r"[^\w.=+-]+", "-", words)[:90].strip("-._")
        return f"{words or 'case'}-{self.fingerprint[:10]}"


@dataclass(frozen=True)
class Axis:
    """One axis of a grid.

    Attributes
    ----------
    name : str
        Name of the dimension in the dataset.
    path : str
        The dotted path that it changes; empty for an axis of named sets of overrides.
    labels : tuple
        Coordinates.
    overrides : tuple of dict
        What each place of the axis changes.
    """

    name: str
    path: str
    labels: tuple[Any, ...]
    overrides: tuple[dict[str, Any], ...]


@dataclass(frozen=True)
class Study:
    """A set of cases; made by `grid`, `cases`, `random` or `load_study`.

    Attributes
    ----------
    cases : tuple of Case
        The cases, the last axis changing fastest.
    axes : tuple of Axis
        Axes of a grid; without any, the cases are a list.
    name : str
        Name in reports.
    """

    cases: tuple[Case, ...]
    axes: tuple[Axis, ...] = ()
    name: str = "study"

    def __len__(self) -> int:
        return len(self.cases)

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the dimensions."""
        return tuple(len(axis.labels) for axis in self.axes) or (len(self.cases),)


def label(value: Any) -> Any:
    """A value as a coordinate: numbers and texts as they are, other values by their name or kind, or as short text."""
    value = plain(value) if isinstance(value, np.generic) else value
    if isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return int(value) if value.is_integer() and abs(value) < 1e15 else value
    for attribute in ("name", "kind"):
        text = getattr(value, attribute, None)
        if isinstance(text, str):
            return text
    return json.dumps(plain(value), default=str)[:40]


def _case(base: Base, parameters: Mapping[str, Any], overrides: Overrides) -> Case:
    try:
        scene, run = base.build(overrides)
    except InputError as error:
        return Case(dict(parameters), None, RunOptions(), str(error))
    return Case(dict(parameters), scene, run)


def _coordinate(value: Any) -> Any:
    value = plain(value) if isinstance(value, np.generic) else value
    return value if isinstance(value, bool | int | float | str) else label(value)


def _are_sets(values: Any) -> bool:
    """Whether these are sets of overrides by labels: every key of theirs is a dotted path."""
    sets = list(values.values()) if isinstance(values, Mapping) else []
    return bool(sets) and all(isinstance(entry, Mapping) and all("." in str(key) for key in entry) for entry in sets)


def _axis(name: str, values: Any) -> Axis:
    is_path = name.split(".")[0].split("[")[0] in TABLES and not _are_sets(values)
    if isinstance(values, Mapping):
        labels = tuple(values)
        overrides = [{name: value} if is_path else dict(value) for value in values.values()]
    elif is_path:
        listed = list(values)
        labels = tuple(_coordinate(value) for value in listed)
        overrides = [{name: value} for value in listed]
    else:
        raise InputError.of(name, "a sequence", "must be a path, or have a mapping of labels to overrides")
    if not labels:
        raise InputError.of(name, "empty", "must have at least one value")
    if len(set(labels)) != len(labels):
        raise InputError.of(name, list(labels), "must not have the same value or label twice")
    return Axis(name, name if is_path else "", labels, tuple(overrides))


def _short_names(paths: Sequence[str]) -> list[str]:
    """The last part of each path where that is enough to tell them apart, else the whole path."""
    last = [path.rsplit(".", 1)[-1] for path in paths]
    return [short if last.count(short) == 1 else path for short, path in zip(last, paths, strict=True)]


def grid(
    base: Scene | Mapping[str, Any] | str | FilePath,
    axes: Mapping[str, Sequence[Any] | Mapping[Any, Any]],
    run: RunOptions | None = None,
    *,
    fixed: Overrides | None = None,
    name: str = "study",
) -> Study:
    """Every combination of values.

    Parameters
    ----------
    base : Scene, mapping, str or Path
        What the axes change: a scene, the tables of a case, a TOML case or the name of a shipped one.
    axes : mapping of str to sequence or mapping
        Values of each path, such as ``{"scene.speed_rpm": [1000, 2000]}``. Labels may be given as ``{label: value}``. A name
        that is no path may have a mapping of labels to sets of overrides, to change several values together.
    run : RunOptions, optional
        How each case is run; by default as the base says.
    fixed : mapping, optional
        Overrides of every case.
    name : str
        Name of the study.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        If an axis is wrong, or no case at all can be built.
    """
    changed, listed = Base.of(base, run), [_axis(axis, values) for axis, values in axes.items()]
    names = _short_names([axis.name for axis in listed])
    listed = [Axis(short, a.path, a.labels, a.overrides) for short, a in zip(names, listed, strict=True)]
    made = []
    for places in itertools.product(*(range(len(axis.labels)) for axis in listed)):
        overrides = dict(fixed or {})
        for axis, place in zip(listed, places, strict=True):
            overrides |= axis.overrides[place]
        made.append(_case(changed, {a.name: a.labels[p] for a, p in zip(listed, places, strict=True)}, overrides))
    return _checked(Study(tuple(made), tuple(listed), name))


def cases(
    base: Scene | Mapping[str, Any] | str | FilePath,
    overrides: Iterable[Overrides],
    run: RunOptions | None = None,
    *,
    name: str = "study",
) -> Study:
    """A list of cases, one a set of overrides.

    Parameters
    ----------
    base : Scene, mapping, str or Path
        As in `grid`.
    overrides : iterable of mapping
        For each case its values by their paths.
    run : RunOptions, optional
        How each case is run; by default as the base says.
    name : str
        Name of the study.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        If no case at all can be built.
    """
    changed = Base.of(base, run)
    listed = [dict(entry) for entry in overrides]
    paths = list(dict.fromkeys(path for entry in listed for path in entry))
    names = dict(zip(paths, _short_names(paths), strict=True))
    made = [_case(changed, {names[p]: _coordinate(v) for p, v in entry.items()}, entry) for entry in listed]
    return _checked(Study(tuple(made), (), name))


def of_scenes(scenes: Iterable[Scene | tuple[Scene, RunOptions]], run: RunOptions | None = None) -> Study:
    """A study of given scenes, each with the same run options or its own."""
    made = []
    for place, entry in enumerate(scenes):
        scene, own = entry if isinstance(entry, tuple) else (entry, run)
        if own is None:
            raise InputError.of("run", None, "must be given with scenes: RunOptions(revolutions=...)")
        made.append(Case({"number": place}, scene, own))
    return Study(tuple(made))


def random(
    base: Scene | Mapping[str, Any] | str | FilePath,
    ranges: Mapping[str, Any],
    count: int,
    seed: int,
    run: RunOptions | None = None,
    *,
    fixed: Overrides | None = None,
    name: str = "study",
) -> Study:
    """Random cases, the same ones for the same seed.

    Parameters
    ----------
    base : Scene, mapping, str or Path
        As in `grid`.
    ranges : mapping of str to tuple or mapping
        For each path a range ``(low, high)``, or ``{"low": ..., "high": ..., "scale": "linear" | "log"}``, or
        ``{"choice": [...]}``. Whole numbers at both ends give whole numbers, both ends included.
    count : int
        Number of cases. A larger count keeps the first ones, and so does another path.
    seed : int
        Seed of the random numbers.
    run : RunOptions, optional
        How each case is run; by default as the base says.
    fixed : mapping, optional
        Overrides of every case.
    name : str
        Name of the study.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        If a range is wrong, or no case at all can be built.
    """
    if count < 1 or seed < 0:
        raise InputError.of("count" if count < 1 else "seed", min(count, seed), "must be positive")
    columns = {path: _draws(path, entry, count, seed) for path, entry in ranges.items()}
    names = _short_names(list(columns))
    changed, made = Base.of(base, run), []
    for place in range(count):
        drawn = {path: column[place] for path, column in columns.items()}
        parameters = {n: _coordinate(value) for n, value in zip(names, drawn.values(), strict=True)}
        made.append(_case(changed, parameters, {**(fixed or {}), **drawn}))
    return _checked(Study(tuple(made), (), name))


def _draws(path: str, entry: Any, count: int, seed: int) -> list[Any]:
    """Random values of one path: from a stream of its own, one number a case."""
    unit = np.random.default_rng([seed, *path.encode()]).random(count)
    if isinstance(entry, Mapping) and set(entry) == {"choice"}:
        choices = list(entry["choice"])
        return [choices[int(u * len(choices))] for u in unit]
    if isinstance(entry, Mapping):
        if not {"low", "high"} <= set(entry) <= {"low", "high", "scale"}:
            raise InputError.of(path, dict(entry), "must have low and high, and may have scale; or choice")
        low, high, scale = entry["low"], entry["high"], entry.get("scale", "linear")
    else:
        low, high = entry
        scale = "linear"
    if scale not in ("linear", "log") or not low < high or (scale == "log" and low <= 0):
        raise InputError.of(path, (low, high, scale), "must be a range low < high, linear or log (then above 0)")
    if scale == "log":
        return [float(low * (high / low) ** u) for u in unit]
    if isinstance(low, int) and isinstance(high, int):
        return [int(low + u * (high - low + 1)) for u in unit]
    return [float(low + u * (high - low)) for u in unit]


def _checked(study: Study) -> Study:
    """The study; an error if none of its cases can be built, as after a mistyped path."""
    if not study.cases:
        raise InputError.of("study", "empty", "must have at least one case")
    if all(case.scene is None for case in study.cases):
        raise InputError.of(
            "study", study.cases[0].parameters, f"no case can be built; the first: {study.cases[0].error}"
        )
    return study


_KINDS: Final = ("grid", "list", "random")


def shipped_studies() -> tuple[str, ...]:
    """Names of the studies that ship with the package."""
    return tuple(sorted(path.stem for path in STUDIES.glob("*.toml")))


def load_study(path: str | FilePath) -> Study:
    """A study from a TOML file, or one that ships with the package by its name.

    The file holds the tables of a case (see `trbdyn.toml_case`) that every run shares, and a table ``[study]`` with

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
    tables = read_toml(_beside(path, table["case"])) if "case" in table else {}
    for key, entry in values.items():
        own = tables.get(key)
        tables[key] = _merged(own, entry) if isinstance(own, dict) and isinstance(entry, dict) else entry
    name = table.get("name", FilePath(path).stem)
    if "grid" in table:
        return grid(tables, table["grid"], name=name)
    if "list" in table:
        return cases(tables, table["list"], name=name)
    draws = table["random"]
    if set(draws) != {"count", "seed", "ranges"}:
        raise InputError.of(("study", "random"), sorted(draws), "must hold count, seed and ranges")
    return random(tables, draws["ranges"], draws["count"], draws["seed"], name=name)


def _beside(path: str | FilePath, case: str) -> str | FilePath:
    """A case's file beside the study's, or the name of a shipped case."""
    beside = FilePath(path).parent / case
    return beside if beside.is_file() else case


def _merged(base: Table, changes: Table) -> Table:
    result = dict(base)
    for key, value in changes.items():
        own = result.get(key)
        result[key] = _merged(own, value) if isinstance(own, dict) and isinstance(value, dict) else value
    return result
