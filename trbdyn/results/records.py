"""The records of a run: every recorded field by its name, and what is known of the run besides."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import FileError, InputError
from trbdyn.model.scene import Scene
from trbdyn.results import fields as field_table
from trbdyn.results import peaks as peak_table
from trbdyn.results.derived import Derived
from trbdyn.results.fields import Field
from trbdyn.results.file_format import RunInfo
from trbdyn.results.peaks import Peaks
from trbdyn.results.sources import Source, WindowSource

Array = NDArray[np.float64]


class Records(Derived):
    """The records of a run, of which the functions of this package are; `Result` adds to them what these functions give.

    Parameters
    ----------
    source : Source
        Where the fields come from.
    info : RunInfo
        Settings, length and messages of the run.
    scene : Scene, optional
        The scene; by default it is made from ``info.scene`` when first asked for.
    """

    def __init__(self, source: Source, info: RunInfo, scene: Scene | None = None) -> None:
        self._source = source
        self._info = info
        self._scene = scene
        self._fields = {field.name: field for field in source.fields}

    def __getitem__(self, name: str) -> Array:
        """A field by its name.

        Raises
        ------
        InputError
            If it was not recorded, or does not exist.
        """
        if name not in self._fields:
            raise InputError.of("field", name, self._unknown(name))
        return self._source.read(name)

    def __getattr__(self, name: str) -> Array:
        # a copy that is being made asks for such names before it has any fields
        if name.startswith("_"):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        if name not in self._fields:
            raise AttributeError(f"this result has no {name!r}: {self._unknown(name)}")
        return self[name]

    def _unknown(self, name: str) -> str:
        """Why there is no such field: its group was not saved, or what the name may have meant."""
        every = {field.name: field.group for field in field_table.table()}
        saved = f"saved groups: {', '.join(self.groups)}"
        if every.get(name) in self.groups:
            return f"this bearing has none, its scene has switched it off, or its file is of an older version; {saved}"
        if name in every:
            left_out = f"the group '{every[name]}', which save_groups left out, or which this bearing or its scene does not have"
            return f"was not recorded: it belongs to {left_out}; {saved}"
        derived = [entry for entry in super().__dir__() if not entry.startswith("_")]
        near = difflib.get_close_matches(str(name), [*every, *derived], n=3)
        hint = f"did you mean {' or '.join(repr(entry) for entry in near)}? " if near else ""
        return f"unknown name; {hint}{saved}; `dir(result)` lists every name"

    def __contains__(self, name: object) -> bool:
        return name in self._fields

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._fields})

    def __len__(self) -> int:
        return self._source.n_records

    @property
    def turned_over(self) -> tuple[str, ...]:
        """As `AssemblyResult.turned_over`: a bearing alone is in its own axes."""
        return ()

    @property
    def success(self) -> bool:
        """Whether the run reached its end."""
        return self._info.success

    @property
    def message(self) -> str:
        """How it ended, in a sentence."""
        return self._info.message

    @property
    def stats(self) -> dict[str, Any]:
        """Solver statistics: steps, rhs_evaluations, wall_s and others."""
        return self._info.stats

    @property
    def counters(self) -> dict[str, int]:
        """How often the core evaluated each effect; zero for effects that are off."""
        return self._info.counters

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the watch over the run found (`trbdyn.run.watch`): energy that does not add up, steps so small that it makes no
        progress.
        """
        return self._info.warnings

    @property
    def geometry(self) -> dict[str, float]:
        """Derived geometry of the bearing, SI."""
        return self._info.geometry

    @property
    def final_time(self) -> float:
        """Time of the final state, s."""
        return self._info.final_time

    @property
    def final_state(self) -> Array | None:
        """The integrator's state at the end, from which a run can go on, shape (n_state,), or None."""
        return self._info.final_state

    @property
    def meta(self) -> dict[str, Any]:
        """Versions, instruction set and settings of the run."""
        return self._info.meta

    @property
    def scene(self) -> Scene:
        """The scene that was run.

        Raises
        ------
        FileError
            If the stored scene cannot be read by this version.
        """
        if self._scene is None:
            try:
                self._scene = Scene.from_dict(self._info.scene)
            except InputError as error:
                raise FileError(f"the stored scene cannot be used: {error}") from error
        return self._scene

    @property
    def fields(self) -> tuple[Field, ...]:
        """The recorded fields: names, groups, units and texts."""
        return tuple(self._fields.values())

    @property
    def subject(self) -> Scene | None:
        """What was simulated: the scene; None of a bearing on a shaft, which runs with the others alone."""
        return None if self.on_shaft else self.scene

    @property
    def ring_loads(self) -> tuple[Array, Array]:
        """Axial load towards the small ends of the rollers, and radial load, that the inner ring carries at each record (N)."""
        force = self["ring_force"]
        return force[:, 2], np.hypot(force[:, 0], force[:, 1])

    @property
    def on_shaft(self) -> bool:
        """Whether the bearing is one of several on a shaft: its loads follow from the shaft's, and are those of its records."""
        return "assembly" in self.meta

    @property
    def ring_moves(self) -> bool:
        """Whether the inner ring is a body that moves by itself, or with a shaft on several bearings."""
        return self.on_shaft or self.scene.ring_body is not None

    @property
    def housing_moves(self) -> bool:
        """Whether the outer ring is a body that moves with a housing."""
        return self.scene.housing is not None

    @cached_property
    def groups(self) -> tuple[str, ...]:
        """Names of the recorded groups."""
        return field_table.groups(self._fields.values())

    def select(self, groups: Iterable[str]) -> Self:
        """The result with only the fields of some groups (and the times).

        Raises
        ------
        InputError
            If a group was not recorded.
        """
        kept = field_table.select(self.fields, groups)
        return type(self)(WindowSource(self._source, kept, 0, len(self)), self._info, self._scene)

    def window(self, start: float = -np.inf, stop: float = np.inf) -> Self:
        """The result between two times (s), both included.

        Raises
        ------
        InputError
            If no record lies between them.
        """
        time = self["time"]
        first, last = np.searchsorted(time, start, "left"), np.searchsorted(time, stop, "right")
        if last <= first:
            raise InputError.of(
                "window", (start, stop), f"must hold a record; the last one is at {self.final_time:g} s"
            )
        part = WindowSource(self._source, self.fields, int(first), int(last))
        return type(self)(part, replace(self._info, peaks={}), self._scene)

    @property
    def is_window(self) -> bool:
        """Whether it is a part of the records of a run, as `window` makes it."""
        return self._source.is_part

    @property
    def peaks(self) -> Peaks:
        """Extremes, means and impacts between the records too: of the whole run, or of a window's records.

        ``result.peaks["pocket_force_peak"]`` is the largest force on each face of each pocket,
        ``result.pocket_force_peak`` the largest since the record before, at each record.

        Raises
        ------
        InputError
            If the run was made without the group 'peaks'.
        """
        if self._info.peaks:
            return Peaks(self._info.peaks)
        kept = peak_table.names(self.fields)
        if not kept or not len(self):
            raise InputError.of("peaks", "asked for", "were not kept: the run was made without the group 'peaks'")
        return peak_table.join(self["time"], {name: self[name] for name in kept})

    def peak(self, mean: str) -> Array:
        """One of the means of `peaks`, without the others being joined."""
        if self._info.peaks:
            return Peaks(self._info.peaks)[mean]
        return peak_table.join(self["time"], {mean: self[mean]})[mean]

    @property
    def settled(self) -> Self:
        """The result after the transient, the second half of the run at least; `settling` says whether it has settled
        there.
        """
        return self.window(self.settling().time)

    @property
    def n_rollers(self) -> int:
        """Number of rollers, Z; zero if nothing was recorded of them."""
        sized = (self[field.name].shape[1] for field in self.fields if field.dims[:1] == ("roller",))
        return next(sized, 0)

    @property
    def parts(self) -> tuple[Self, ...]:
        """The results of all bearings: this one."""
        return (self,)

    @property
    def by_name(self) -> Mapping[str, Self]:
        """The results of all bearings by their names: this one by the name ''."""
        return {"": self}

    def moved(self, path: Path) -> Self:
        """The result, whose file has another name now; nothing is read again."""
        self._source.moved(path)
        return self
