"""Speed and loads of a run in words, and what of them changes: for titles, summaries and verdicts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from trbdyn.model.motion import History

if TYPE_CHECKING:
    from trbdyn.results.records import Records

CHANGE: Final = 0.01
"""Share of the largest value by which a speed or a load changes before it is said."""
PER_RPM: Final = math.pi / 30.0
LOADS: Final = (("axial_load", "Fa"), ("radial_load", "Fr"))
WORDS: Final = {"speed": "speed", "outer ring": "speed of the outer ring", "Fa": "axial load", "Fr": "radial load"}


def ranges(result: Records) -> dict[str, tuple[float, float]]:
    """Smallest and largest value over the records of speed and outer ring (rpm), of axial and radial load (N).

    Loads that are not prescribed are left out, and so is an outer ring at rest.
    """
    found = {"speed": _extent(np.asarray(result["shaft_speed"]) / PER_RPM)}
    if result.scene.outer_turns:
        found["outer ring"] = _extent(np.asarray(result.outer_speed) / PER_RPM)
    for name, symbol in LOADS:
        load = getattr(result.scene, name)
        if isinstance(load, History):
            # a spike between two records counts, too
            time = np.asarray(result["time"])
            inside = [t for t in load.times if time[0] <= t <= time[-1]]
            found[symbol] = _extent(np.concatenate([load.value(time), load.value(np.asarray(inside))]))
        elif load is not None:
            found[symbol] = (float(load), float(load))
    return found


def changes(result: Records) -> dict[str, tuple[float, float]]:
    """Those of `ranges` that change within the records."""
    return {
        name: (low, high)
        for name, (low, high) in ranges(result).items()
        if high - low > CHANGE * max(abs(low), abs(high))
    }


def words(result: Records) -> str | None:
    """What changes in a run, for a sentence; None where nothing does."""
    units = {"speed": "rpm", "outer ring": "rpm"}
    said = [
        f"{WORDS[name]} {_number(low)} to {_number(high)} {units.get(name, 'N')}"
        for name, (low, high) in changes(result).items()
    ]
    return ", ".join(said) or None


def spoken(extent: tuple[float, float]) -> str:
    """A range as its mean, or as "0 to 3000" where it changes."""
    low, high = extent
    return (
        f"{_number(low)} to {_number(high)}"
        if high - low > CHANGE * max(abs(low), abs(high))
        else _number(0.5 * (low + high))
    )


def _extent(values: np.ndarray) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _number(value: float) -> str:
    return f"{value:.4g}" if abs(value) < 1e4 else f"{round(value):d}"
