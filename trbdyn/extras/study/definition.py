"""What a study is made of: a base, overrides of its values, cases, axes."""

from __future__ import annotations

import copy
import hashlib
import itertools
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as FilePath
from typing import Any, Final

import numpy as np

from trbdyn.base.shipped import SUBJECTS
from trbdyn.base.shown import Displayed, Shown, value_text
from trbdyn.base.validation import Model
from trbdyn.errors import InputError, Path, join_path
from trbdyn.model.assembly import Subject
from trbdyn.model.scene import Scene
from trbdyn.run.options import RunOptions
from trbdyn.run.toml_assembly import TABLES as OF_ASSEMBLIES
from trbdyn.run.toml_assembly import subject_from_dict
from trbdyn.run.toml_case import TABLES, read_tables

Table = dict[str, Any]
PATHS: Final = tuple(dict.fromkeys((*TABLES, *OF_ASSEMBLIES)))
"""With what the paths of overrides begin."""
Overrides = Mapping[str, Any]

LISTED: Final = 50
"""Most cases that a study lists when it shows itself."""
LONGEST_WORDS: Final = 90
"""Most bytes of the part of a file's name that tells the parameters."""

_PART: Final = re.compile(r"([A-Za-z_]\w*)((?:\[\d+\])*)")
_CHOOSERS: Final = {"bearing": "case", "lubricant": "oil", "effects": "preset"}
"""Keys that call for something known: in place of a whole table where the base is a scene."""


@dataclass(frozen=True)
class Base:
    """What overrides change: the tables of a case, as in a TOML case (`trbdyn.run.toml_case`)."""

    tables: Table
    whole: bool = False  # whether every value is given, as for a base made of a scene

    @classmethod
    def of(cls, base: Subject | Mapping[str, Any] | str | FilePath | Base, run: RunOptions | None = None) -> Base:
        """A base from a scene or an assembly, the tables of a case, or the name of a TOML case."""
        if isinstance(base, Base):
            made = base
        elif isinstance(base, Subject):
            made = cls(base.tables(), whole=True)
        elif isinstance(base, Mapping):
            if wrong := [name for name, table in base.items() if not isinstance(table, Mapping | list)]:
                way = ": that of a fit is fit.subject" if type(base).__name__ == "Fit" else ""
                limit = f"must be a Scene, an Assembly, the tables of a case or the name of one{way}; {wrong[0]!r} is no table"
                raise InputError.of("base", type(base).__name__, limit)
            made = cls(dict(base))
        else:
            made = cls(read_toml(base))
        return made if run is None else cls({**made.tables, "run": run.to_dict()}, made.whole)

    @property
    def parts(self) -> dict[str, Table]:
        """The tables of each bearing by the beginning of its paths: empty for one bearing, else ``bearings[0].`` and so on."""
        bearings = self.tables.get("bearings")
        if "assembly" not in self.tables or not isinstance(bearings, list):
            return {"": self.tables}
        return {f"bearings[{index}].": table for index, table in enumerate(bearings) if isinstance(table, dict)}

    def build(self, overrides: Overrides, *, held: bool = True) -> tuple[Subject, RunOptions]:
        """Scene or assembly, and run options, with overrides put in; an error where a path or a value is wrong, or, if it must be
        held, where one bearing cannot hold its load.
        """
        made = Base(copy.deepcopy(self.tables), self.whole)
        tables = made.tables
        for prefix, part in made.parts.items():
            _check_oil(prefix, part, overrides)
            for table, chooser in _CHOOSERS.items() if self.whole else ():
                if f"{prefix}{table}.{chooser}" in overrides:
                    kept = part[table].get("temperature_c")
                    part[table] = {} if kept is None else {"temperature_c": kept}
        for path in sorted(overrides, key=lambda name: (name.count(".") + name.count("["), name)):
            put(tables, path, plain(overrides[path]))
        subject, run = subject_from_dict(tables)
        if held and isinstance(subject, Scene):
            subject.check_capacity()
        return subject, run


def _check_oil(prefix: str, part: Table, overrides: Overrides) -> None:
    """Numbers of a lubricant without oil belong to its temperature."""
    name, lubricant = f"{prefix}lubricant.temperature_c", part.get("lubricant") or {}
    others = {f"{prefix}{other}" for other in ("lubricant.oil", "lubricant", "lubricant.viscosity")}
    if name in overrides and "viscosity" in lubricant and not others & set(overrides):
        raise InputError.of(
            name,
            overrides[name],
            f"would change the temperature but not the viscosities that belong to it; give {prefix}lubricant.oil beside it, "
            "or a whole lubricant",
        )


def read_toml(path: str | FilePath) -> Table:
    """The tables of a TOML file, or of a case that ships with the package."""
    try:
        file = SUBJECTS.file(path)
    except InputError:
        limit = "must be a Scene or an Assembly, the tables of a case, or the name or file of one"
        raise InputError.of("base", path, limit) from None
    return read_tables(file)


def split_path(path: str) -> Path:
    """The parts of a dotted path to a value of a case: ``scene.gravity[1]`` gives ``('scene', 'gravity', 1)``."""
    parts: list[str | int] = []
    if not isinstance(path, str):
        raise InputError.of("override", path, "must be a dotted path, for instance 'scene.speed_rpm'")
    for piece in path.split("."):
        match = _PART.fullmatch(piece)
        if match is None:
            raise InputError.of("override", path, "must be a dotted path, for instance 'scene.speed_rpm'")
        parts.append(match[1])
        parts.extend(int(index) for index in re.findall(r"\d+", match[2]))
    if parts[0] not in PATHS or parts in (["scene"], ["assembly"]):
        raise InputError.of("override", path, f"must start with one of {', '.join(f'{name}.' for name in PATHS)}")
    return tuple(parts)


def put(tables: Table, path: str, value: Any) -> None:
    """Put a value into nested tables; tables that are missing on the way are made. A path that leads through a value that is no
    table, or to a place that a list does not have, is an error.
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


def fingerprint(scene: Subject, run: RunOptions) -> str:
    """What tells a case from another: SHA-256 of scene and run options, as hexadecimal digits."""
    return hashlib.sha256(f"{scene.fingerprint} {run.fingerprint}".encode()).hexdigest()


@dataclass(frozen=True)
class Case:
    """One case of a study.

    Attributes
    ----------
    parameters : dict of str to value
        What tells it from the others: numbers or texts.
    scene : Scene, Assembly or None
        What is run; None if it cannot be built.
    run : RunOptions
        How it is run.
    error : str
        Why it cannot be built.
    """

    parameters: dict[str, Any]
    scene: Subject | None
    run: RunOptions
    error: str = ""

    @cached_property
    def fingerprint(self) -> str:
        """`fingerprint` of scene and run options."""
        if self.scene is None:
            return hashlib.sha256(f"{plain(self.parameters)!r} {self.error}".encode()).hexdigest()
        return fingerprint(self.scene, self.run)

    @cached_property
    def name(self) -> str:
        """A name for files: the parameters, and the beginning of the fingerprint."""
        words = "_".join(f"{key.rsplit('.', 1)[-1]}={label(value)}" for key, value in self.parameters.items())
        words = re.sub(r"[^\w.=+-]+", "-", words)
        # file systems count bytes, and a letter may have four
        words = words.encode("utf-8", "replace")[:LONGEST_WORDS].decode("utf-8", "ignore").strip("-._")
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
class Study(Displayed):
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

    def __repr__(self) -> str:
        return f"<Study {self._title()}>"

    def _title(self) -> str:
        over = " x ".join(f"{len(axis.labels)} {axis.name}" for axis in self.axes)
        return f"{self.name}: {len(self)} cases{f', {over}' if over else ''}"

    def _shown(self) -> Shown:
        rows = [(axis.name, value_text(tuple(axis.labels)), axis.path) for axis in self.axes]
        names = tuple(dict.fromkeys(name for case in self.cases for name in case.parameters))
        each = [tuple(value_text(label(case.parameters.get(name))) for name in names) for case in self.cases[:LISTED]]
        notes = (f"and {len(self) - LISTED} cases more",) if len(self) > LISTED else ()
        cases = Shown("cases", tuple(each), names, notes)
        wrong = tuple(f"cannot be built: {case.error}" for case in self.cases if case.error)[:LISTED]
        return Shown(f"Study {self._title()}", tuple(rows), ("axis", "values", "what it changes"), wrong, (cases,))

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
