"""Designs of studies: grids, lists and seeded random draws of overrides."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from trbdyn.base.validation import number_of, whole_number_of
from trbdyn.errors import InputError
from trbdyn.extras.study.definition import PATHS, Axis, Base, Case, Overrides, Study, label, plain
from trbdyn.model.assembly import Subject
from trbdyn.run.options import RunOptions


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
    if not isinstance(name, str):
        raise InputError.of(("grid", str(name)), name, "must be a path or a name")
    if isinstance(values, str | bytes) or not isinstance(values, Mapping | Iterable):
        raise InputError.of(name, values, "must be a sequence of values, or a table of labels and values")
    is_path = name.split(".")[0].split("[")[0] in PATHS and not _are_sets(values)
    if isinstance(values, Mapping):
        labels = tuple(values)
        if not is_path and not all(isinstance(value, Mapping) for value in values.values()):
            raise InputError.of(name, dict(values), "must be a path, or have a mapping of labels to overrides")
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
    base: Subject | Mapping[str, Any] | str | FilePath,
    axes: Mapping[str, Sequence[Any] | Mapping[Any, Any]],
    run: RunOptions | None = None,
    *,
    fixed: Overrides | None = None,
    name: str = "study",
) -> Study:
    """Every combination of values.

    Parameters
    ----------
    base : Scene, Assembly, mapping, str or Path
        What the axes change: a scene or an assembly, the tables of a case, a TOML case or the name of a shipped one.
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
    _check_name(name)
    if not isinstance(axes, Mapping):
        raise InputError.of("grid", axes, "must be a table: values by their paths")
    changed, listed = Base.of(base, run), [_axis(axis, values) for axis, values in axes.items()]
    _check_count(math.prod(len(axis.labels) for axis in listed))
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
    base: Subject | Mapping[str, Any] | str | FilePath,
    overrides: Iterable[Overrides],
    run: RunOptions | None = None,
    *,
    name: str = "study",
) -> Study:
    """A list of cases; each is a set of overrides.

    Parameters
    ----------
    base : Scene, Assembly, mapping, str or Path
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
    _check_name(name)
    if isinstance(overrides, str | bytes | Mapping) or not isinstance(overrides, Iterable):
        raise InputError.of("list", overrides, "must be a sequence of tables: values by their paths")
    changed, listed = Base.of(base, run), list(overrides)
    for place, entry in enumerate(listed):
        if not isinstance(entry, Mapping) or not all(isinstance(path, str) for path in entry):
            raise InputError.of(("list", place), entry, "must be a table: values by their paths")
    paths = list(dict.fromkeys(path for entry in listed for path in entry))
    names = dict(zip(paths, _short_names(paths), strict=True))
    made = [_case(changed, {names[p]: _coordinate(v) for p, v in entry.items()}, entry) for entry in listed]
    return _checked(Study(tuple(made), (), name))


def of_scenes(scenes: Iterable[Subject | tuple[Subject, RunOptions]], run: RunOptions | None = None) -> Study:
    """A study of given scenes, each with the same run options or its own."""
    made = []
    for place, entry in enumerate(scenes):
        scene, own = entry if isinstance(entry, tuple) else (entry, run)
        if own is None:
            raise InputError.of("run", None, "must be given with scenes: RunOptions(revolutions=...)")
        made.append(Case({"number": place}, scene, own))
    return Study(tuple(made))


def random(
    base: Subject | Mapping[str, Any] | str | FilePath,
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
    base : Scene, Assembly, mapping, str or Path
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
    _check_name(name)
    count, seed = whole_number_of("count", count, 1), whole_number_of("seed", seed, 0)
    if not isinstance(ranges, Mapping) or not all(isinstance(path, str) for path in ranges):
        raise InputError.of("ranges", ranges, "must be a table: ranges by their paths")
    _check_count(count)
    columns = {path: _draws(path, entry, count, seed) for path, entry in ranges.items()}
    names = _short_names(list(columns))
    changed, made = Base.of(base, run), []
    for place in range(count):
        drawn = {path: column[place] for path, column in columns.items()}
        parameters = {n: _coordinate(value) for n, value in zip(names, drawn.values(), strict=True)}
        made.append(_case(changed, parameters, {**(fixed or {}), **drawn}))
    return _checked(Study(tuple(made), (), name))


def _draws(path: str, entry: Any, count: int, seed: int) -> list[Any]:
    """Random values of one path: one number for each case, from a random stream that belongs to this path."""
    unit = np.random.default_rng([seed, *path.encode()]).random(count)
    if isinstance(entry, Mapping) and set(entry) == {"choice"}:
        if isinstance(entry["choice"], str) or not isinstance(entry["choice"], Sequence) or not entry["choice"]:
            raise InputError.of((path, "choice"), entry["choice"], "must be a sequence of at least one value")
        choices = list(entry["choice"])
        return [choices[int(u * len(choices))] for u in unit]
    if isinstance(entry, Mapping):
        if not {"low", "high"} <= set(entry) <= {"low", "high", "scale"}:
            raise InputError.of(path, dict(entry), "must have low and high, and may have scale; or choice")
        low, high, scale = entry["low"], entry["high"], entry.get("scale", "linear")
    else:
        if isinstance(entry, str) or not isinstance(entry, Sequence) or len(entry) != 2:
            raise InputError.of(
                path, entry, "must be a range (low, high), or a table of low, high and scale, or of choice"
            )
        low, high = entry
        scale = "linear"
    for end in (low, high):
        if not abs(number_of(path, end)) < 1e300:
            raise InputError.of(path, end, "must be a finite number")
    if not isinstance(scale, str):
        raise InputError.of((path, "scale"), scale, "must be 'linear' or 'log'")
    if scale not in ("linear", "log") or not low < high or (scale == "log" and low <= 0):
        raise InputError.of(path, (low, high, scale), "must be a range low < high, linear or log (then above 0)")
    if scale == "log":
        return [float(low * (high / low) ** u) for u in unit]
    if isinstance(low, int) and isinstance(high, int):
        return [int(low + u * (high - low + 1)) for u in unit]
    return [float(low + u * (high - low)) for u in unit]


MOST_CASES = 1_000_000
"""Most cases of a study."""


def _check_count(count: int) -> None:
    if count > MOST_CASES:
        raise InputError.of("study", count, f"must have at most {MOST_CASES} cases")


def _check_name(name: object) -> None:
    if not isinstance(name, str):
        raise InputError.of("name", name, "must be text")


def _checked(study: Study) -> Study:
    """The study; an error if none of its cases can be built, as after a mistyped path."""
    if not study.cases:
        raise InputError.of("study", "empty", "must have at least one case")
    if all(case.scene is None for case in study.cases):
        raise InputError.of(
            "study", study.cases[0].parameters, f"no case can be built; the first: {study.cases[0].error}"
        )
    return study
