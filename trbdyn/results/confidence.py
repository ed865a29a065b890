"""How well the averages of a run are known: half widths of 95 % confidence intervals, from batches of its window.

Each number of the summary that is an average is computed again in batches that are long against the correlation time of the
motion (`trbdyn.observables.batches`), and its scatter over the batches tells the error of the whole. This is the scatter within
the window: it tells nothing of a slow drift (see `Result.settling`), of a second whirl that another start would lead to, or of
errors of the model.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.results import observables

if TYPE_CHECKING:
    from trbdyn.results.result import Result

AVERAGES: Final = (
    "cage_speed_ratio",
    "cage_slip",
    "orbit_radius_over_cpr",
    "orbit_radius_over_cpr_p05",
    "orbit_radius_over_cpr_p95",
    "axis_distance_over_cpr",
    "axis_distance_over_cpr_p05",
    "axis_distance_over_cpr_p95",
    "whirl_ratio",
    "whirl_frequency",
    "whirl_coherence",
    "speed_deviation_ratio",
    "axial_over_clearance",
    "tilt_rms",
    "lean_mean",
    "spacing_std_deg",
    "pocket_force_p95",
    "pocket_duty",
    "outer_load_mean",
    "inner_load_mean",
    "rib_load_mean",
    "film_parameter_outer",
    "film_parameter_inner",
    "film_parameter_rib",
    "skew_rms",
    "torque",
    "torque_outer",
    "power_loss",
)
"""Entries of the summary that are averages over its window."""


def confidence(window: Result, average: Callable[[Result], dict[str, Any]]) -> tuple[dict[str, float] | None, str]:
    """Half widths of the confidence intervals of averages over a window.

    Parameters
    ----------
    window : Result
        The records that averages are taken over.
    average : callable
        Gives the averages of a part of them, by the names of `AVERAGES`.

    Returns
    -------
    half_widths : dict of str to float, or None
        In the units of the averages; None where they cannot be told.
    words : str
        From how many batches of which length, or why it cannot be told.
    """
    time = window["time"]
    signals = _signals(window)
    parts = observables.batches(time, signals, _turn_of_the_cage(window))
    if not parts:
        times = [observables.correlation_time(time, signal) for signal in signals]
        long = f"{max(times):.2g} s" if times and all(map(math.isfinite, times)) else "a large part of it"
        length = float(time[-1] - time[0])
        return (
            None,
            f"the window of {length:.3g} s is too short for the motion in it, which remembers itself for {long}",
        )
    found = [average(window.window(time[part.start], time[part.stop - 1])) for part in parts]
    widths: dict[str, float] = {}
    drifting: list[str] = []
    for name in AVERAGES:
        values = [one.get(name) for one in found]
        if any(value is None or not math.isfinite(value) for value in values):
            continue
        width = observables.half_width(np.asarray(values, dtype=float))
        if math.isfinite(width):
            widths[name] = width
        else:
            drifting.append(name)
    length = float(time[parts[0].stop] - time[parts[0].start])
    none = f"; none for what drifts from batch to batch: {', '.join(drifting)}" if drifting else ""
    return widths, (
        f"half widths of 95 % confidence intervals, from {len(parts)} batches of {length:.3g} s{none}; drift slower than the "
        "window and errors of the model are not in them"
    )


def _signals(window: Result) -> list[Any]:
    """What must be independent from batch to batch: the motion of the cage, its hits, and the losses."""
    groups = set(window.groups)
    signals: list[Any] = []
    if "cage" in groups and window.has_cage:
        signals.append(window.orbit_radius)
    if "pocket" in groups and window.has_cage:
        signals.append(window["pocket_force"].sum(axis=(1, 2)))
    if "torque" in groups:
        signals.append(window["inner_torque"])
    if "power" in groups:
        signals.append(window["power_loss"])
    return signals


def _turn_of_the_cage(window: Result) -> float:
    """Time of one turn of the rollers around the bearing (s); 0 where they stand or were not recorded."""
    if "rollers" not in window.groups:
        return 0.0
    angle, time = window["roller_orbit_angle"].mean(axis=1), window["time"]
    turns = abs(float(angle[-1] - angle[0])) / (2.0 * math.pi)
    return float(time[-1] - time[0]) / turns if turns > 0.0 else 0.0
