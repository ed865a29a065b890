"""Peaks: what happens between records, kept by the core at the end of every step of the integrator.

Between the ends of two steps every quantity is taken as a straight line. So peaks do not depend on `save_every`, and the largest
of the peaks of a run's records is that of the run. The core owns the table (``csrc/motion/peak_fields.h``).

Between the ends of two steps a force may rise a little above both: for the hardest impacts of a colliding cage with the preset
``standard`` by up to 0.5 %, for weak ones by up to 2 %. At the ends of steps forces of pockets are exact; loads, pressures and
film parameters of raceways and ribs are evaluated again once they may have changed by 0.2 %.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn import _core
from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import InputError, unknown_name
from trbdyn.results import fields as field_table
from trbdyn.results.fields import Field, Layout

Array = NDArray[np.float64]

GROUP = "peaks"
"""The group of fields that are peaks of each record's interval."""


@cache
def table() -> tuple[Field, ...]:
    """Every peak that the core keeps, in the order of a row."""
    return field_table.from_rows(row[:5] for row in _core.peak_table())


@cache
def _joined() -> dict[str, str]:
    """How the peaks of two neighbouring intervals are joined: largest, smallest, time, mean or sum."""
    return {row[0]: row[5] for row in _core.peak_table()}


class Peaks(Mapping[str, Array], Displayed):
    """Extremes, means and impacts over a stretch of time, by name.

    ``peaks["pocket_force_peak"]`` is the largest normal force between each roller and each face of its pocket (N), shape
    (Z, slots), and ``peaks["pocket_force_peak_time"]`` says when it was (s). `trbdyn.results.peaks.table` lists all
    with their units.

    Parameters
    ----------
    values : mapping of str to ndarray
        The peaks, SI.
    """

    def __init__(self, values: Mapping[str, Array]) -> None:
        self._values = dict(values)

    def __getitem__(self, name: str) -> Array:
        """One of them, shape (Z,) or (Z, slots).

        Raises
        ------
        InputError
            If there is none of this name.
        """
        if name not in self._values:
            raise InputError.of("peaks", name, unknown_name(name, tuple(self._values)))
        return self._values[name]

    def __contains__(self, name: object) -> bool:
        return name in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"<Peaks: {len(self._values)} of the pockets, raceways, ribs, skew, spacing and land; list(peaks) names them>"

    def _shown(self) -> Shown:
        rows = []
        for field in table():
            how = _joined()[field.name]
            if field.name in self._values and how != "time":
                worst = (np.fmin if how == "smallest" else np.fmax).reduce(self._values[field.name], axis=None)
                unit = "" if field.unit == "1" else field.unit
                rows.append((field.name, "" if np.isnan(worst) else f"{worst:.5g}", unit, field.text))
        return Shown("Peaks: over all rollers and faces the largest number, of minima the smallest", tuple(rows))


def from_row(row: ArrayLike, layout: Layout) -> Peaks:
    """Peaks from a row of the core."""
    values = np.asarray(row, dtype=float)
    return Peaks({name: values[at : at + int(np.prod(shape))].reshape(shape) for name, at, shape in layout})


def join(time: Array, rows: Mapping[str, Array]) -> Peaks:
    """Peaks of some neighbouring intervals, shape (T, ...), as those of one. `time` has the times of the records (s); the
    interval of the first one, which ends where they begin, counts only if it is alone.
    """
    later = slice(1, None) if time.size > 1 else slice(None)
    length = np.diff(time) if time.size > 1 else np.ones(1)
    values: dict[str, Array] = {}
    best: dict[str, NDArray[np.intp]] = {}
    for name, how in _joined().items():
        if name not in rows:
            continue
        kept = rows[name][later]
        if how in ("largest", "smallest"):
            sign = 1.0 if how == "largest" else -1.0
            best[name] = np.argmax(np.where(np.isnan(kept), -np.inf, sign * kept), axis=0)
            values[name] = np.take_along_axis(kept, best[name][None], axis=0)[0]
        elif how == "time":
            values[name] = np.take_along_axis(kept, best[name.removesuffix("_time")][None], axis=0)[0]
        elif how == "mean":
            values[name] = np.tensordot(length, kept, axes=(0, 0)) / length.sum()
        else:
            values[name] = kept.sum(axis=0)
    return Peaks(values)


def names(fields: Sequence[Field]) -> tuple[str, ...]:
    """Names of those fields that are peaks."""
    return tuple(field.name for field in fields if field.group == GROUP)
