"""Numbers of a point, from its file: what the table of statements and ``paper.json`` are made of.

Standard errors within the time of the statistics are those of means over single turns of the cage. They see nothing that is
slower. That of the orbit is at least what the turns of the whole settled history tell, with what is slow in them
(`trbdyn.observables.mean_error`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from paper.files import History, read_about, read_history
from paper.growth import growth_of_history
from paper.points import FIGURES, Condition, Inputs, Point, StartKind
from trbdyn.errors import FileError
from trbdyn.results import observables
from trbdyn.results.assembly import load
from trbdyn.results.result import Result
from trbdyn.results.summary import clean

Array = NDArray[np.float64]

LEAST_TURNS = 16
"""Turns of the cage that tell an error."""
STUDENT = 1.96
"""Half width of a 95 % interval over the standard error."""


@dataclass(frozen=True)
class Run:
    """A point that was run.

    Attributes
    ----------
    point : Point
        What was run.
    result : Result
        The time of the statistics.
    history : History
        What came before.
    about : dict
        What the file says of itself.
    numbers : dict
        `numbers_of`.
    """

    point: Point
    result: Result
    history: History
    about: dict[str, Any]
    numbers: dict[str, Any] = field(default_factory=dict)

    @property
    def settled(self) -> bool:
        """Whether it had settled before the statistics."""
        return bool(self.about["settled"])


def read_run(path: Path) -> Run | None:
    """A point from its file; None if there is no such file.

    Raises
    ------
    FileError
        If the file is damaged.
    """
    if not path.is_file():
        return None
    about, history = read_about(path), read_history(path)
    if about is None or history is None:
        raise FileError(f"{path}: this is no whole file of a point of the paper")
    point = Point(Condition(**about["condition"]), about["start"], about["seed"] or 0)
    result = load(path)
    return Run(point, result, history, about, numbers_of(result, history, about))


def standard_error(values: Array, angle: Array) -> float:
    """Standard error of a mean, from the means over the turns of an angle (rad); nan for fewer than two turns."""
    turns = int(abs(angle[-1] - angle[0]) / (2.0 * math.pi))
    if turns < 2:
        return math.nan
    parts = np.array_split(values, turns)
    return float(np.std([part.mean() for part in parts], ddof=1) / math.sqrt(turns))


def settled_error(history: History, since: float | None, clearance: float, turns_of_mean: float) -> float:
    """Standard error of the orbit over Cpr in a mean over some turns of the cage, from all turns since the motion settled; nan
    where it has not, or drifts.
    """
    if since is None:
        return math.nan
    kept = history["time"] >= since
    angle, position = history["cage_angle"][kept], history["cage_position"][kept]
    turns = int(abs(angle[-1] - angle[0]) / (2.0 * math.pi)) if angle.size else 0
    if turns < LEAST_TURNS:
        return math.nan
    orbit = observables.orbit_radius(position) / clearance
    means = np.array([part.mean() for part in np.array_split(orbit, turns)])
    return observables.mean_error(means).half_width / STUDENT * math.sqrt(turns / max(turns_of_mean, 1.0))


def order_share(values: Array, angle: Array, order: int = 1) -> float:
    """Share of a signal's variance that lies at an order of an angle, over its whole turns; nan for less than one turn."""
    turned = np.abs(angle - angle[0])
    turns = int(turned[-1] / (2.0 * math.pi))
    if turns < 1:
        return math.nan
    kept = turned <= 2.0 * math.pi * turns
    x = values[kept] - values[kept].mean()
    total = float(np.mean(x**2))
    if total <= 0.0:
        return math.nan
    return float(2.0 * abs(np.mean(x * np.exp(-1j * order * turned[kept]))) ** 2 / total)


def peak_order(values: Array, angle: Array, most: int = 12) -> int:
    """The order of an angle, 1 to `most`, with the largest share of a real signal; 0 for less than one turn."""
    shares = [order_share(values, angle, order) for order in range(1, most + 1)]
    return 0 if not np.isfinite(shares).all() else int(np.argmax(shares)) + 1


def numbers_of(result: Result, history: History, about: dict[str, Any]) -> dict[str, Any]:
    """Everything that is told of a point, as plain data.

    The first entries are those that ``paper.json`` promises; lengths are in units of the plays, angles in degrees where the name
    says so, else rad; forces in N.
    """
    radius, axial, angle = result.axis_distance_over_cpr, result.axial_motion, result["cage_angle"]
    low, high = np.percentile(radius, (5.0, 95.0))
    force = result["pocket_force"]
    touched = force[force > 0.0]
    tilt, position = result["cage_tilt"], result["cage_position"]
    motion = result.cage_motion
    gaps = np.degrees(result.spacing_angles())
    started = observables.spacing_std(history["roller_orbit_angle"][:1])[0]
    lean = observables.lean(position, tilt)
    growth = growth_of_history(history, result.clearances.radial)
    since = about["settled_since"] if about["settled"] else None
    within = standard_error(observables.orbit_radius(position) / result.clearances.radial, angle)
    slow = settled_error(history, since, result.clearances.radial, abs(angle[-1] - angle[0]) / (2.0 * math.pi))
    out: dict[str, Any] = {
        "whirl_radius_over_cpr": {"mean": radius.mean(), "p5": low, "p95": high},
        "whirl_ratio": result.whirl_ratio,
        "axial_over_clearance": axial.mean(),
        "tilt_rms": np.sqrt(np.mean(np.sum(tilt**2, axis=1))),
        "spacing_std_deg": result.spacing_std.mean(),
        "pocket_force_p95": np.percentile(touched, 95.0) if touched.size else 0.0,
        "seeds": [] if about["seed"] is None else [about["seed"]],
        "start": about["start"],
        "settled": about["settled"],
        "bearing_time": about["bearing_time"],
        "not_settled_because": about["reason"],
        "settled_since": about["settled_since"] if about["settled"] else None,
        "cage_turns": abs(angle[-1] - angle[0]) / (2.0 * math.pi),
        "whirl_radius_standard_error": standard_error(radius, angle),
        "orbit_over_cpr": motion.orbit_over_play,
        "speed_deviation_ratio": motion.speed_deviation_ratio,
        "whirl_amplitude_over_cpr": growth.amplitude,
        "growth_rate": growth.rate,
        "growth_rate_error": growth.rate_error,
        "whirl_grows": growth.growing,
        "time_to_full_whirl": growth.time_to_full,
        "orbit_standard_error": np.fmax(within, slow),
        "cage_motion": motion.kind,
        "whirl_coherence": observables.whirl_coherence(position, result["cage_velocity"]),
        "centre_over_cpr": list(position[:, :2].mean(axis=0) / result.clearances.radial),
        "axial_range": list(np.percentile(axial, (5.0, 95.0))),
        "axial_standard_error": standard_error(axial, angle),
        "tilt_peak_order": peak_order(tilt[:, 0], angle),
        "tilt_order_share": order_share(tilt[:, 0], angle),
        "lean_mean": lean.mean(),
        "tilt_x_with_y": _correlation(tilt[:, 0], position[:, 1]),
        "spacing_std_start_deg": started,
        "spacing_mean_std_deg": gaps.mean(axis=0).std(),
        "spacing_varies_deg": np.sqrt(np.mean(gaps.std(axis=0) ** 2)),
        "spacing_order_share": np.mean([order_share(column, angle) for column in gaps.T]),
        "pocket_force_peak": force.max(),
        "pocket_duty": (force > 0.0).any(axis=2).mean(),
        "cage_speed_ratio": result.cage_speed_ratio,
        "skew_rms": np.sqrt(np.mean(result["roller_skew"] ** 2)),
        "roller_tilt_rms": np.sqrt(np.mean(result["roller_tilt"] ** 2)),
        "torque": result["inner_torque"].mean(),
        "wall_s": result.stats["wall_s"],
    }
    plain: dict[str, Any] = clean(out)
    return plain


def _correlation(one: Array, other: Array) -> float:
    x, y = one - one.mean(), other - other.mean()
    size = float(np.sqrt(np.mean(x**2) * np.mean(y**2)))
    return float(np.mean(x * y) / size) if size > 0.0 else math.nan


class Runs:
    """The points that were run, by condition and start.

    Parameters
    ----------
    runs : sequence of Run
        The points.
    """

    def __init__(self, runs: Sequence[Run]) -> None:
        self.all = tuple(runs)

    @property
    def starts(self) -> tuple[StartKind, ...]:
        """Starts that were run, in their usual order."""
        order = {"equal": 0, "unequal": 1, "whirl": 2}
        found: set[StartKind] = {run.point.start for run in self.all}
        return tuple(sorted(found, key=order.__getitem__))

    @property
    def inputs(self) -> tuple[Inputs, ...]:
        """Directions and scatters that were run under combined load."""
        return tuple(sorted({Inputs(c.direction_deg, c.scatter) for c in self._conditions if c.radial_load}))

    @property
    def _conditions(self) -> set[Condition]:
        return {run.point.condition for run in self.all}

    def within(self, inputs: Inputs) -> Runs:
        """Runs with these inputs, under the names that the figures have for their conditions; and, unless that is the scatter
        of all, those with the scatter of the paper's Fig. 15.
        """
        scattered, kept = FIGURES["15"][-1], []
        for run in self.all:
            condition = run.point.condition
            base = condition.within(Inputs())
            if condition == base.within(inputs):
                kept.append(replace(run, point=replace(run.point, condition=base)))
            elif condition == scattered:
                kept.append(run)
        return Runs(kept)

    def of(self, condition: Condition, start: StartKind) -> list[Run]:
        """Every seed of a condition and a start."""
        return [run for run in self.all if run.point.condition == condition and run.point.start == start]

    def first(self, condition: Condition, start: StartKind) -> Run | None:
        """The first seed, for pictures."""
        found = self.of(condition, start)
        return found[0] if found else None

    def mean(self, condition: Condition, start: StartKind, *names: str | int) -> float:
        """Mean of a number over the seeds; nan if nothing was run. Several names lead into tables."""
        return float(np.mean(values)) if (values := self.values(condition, start, *names)) else math.nan

    def values(self, condition: Condition, start: StartKind, *names: str | int) -> list[float]:
        """A number of every seed; nan where it does not exist."""
        out = []
        for run in self.of(condition, start):
            value: Any = run.numbers
            for name in names:
                value = value[name]
            out.append(math.nan if value is None else float(value))
        return out

    def error(self, condition: Condition, start: StartKind, mean: tuple[str, ...], within: str) -> float:
        """Standard error of a mean over seeds: from their scatter, and not below what the runs say of themselves; nan if neither
        tells.
        """
        single, seeds = self.values(condition, start, within), self.values(condition, start, *mean)
        own = float(np.sqrt(np.mean(np.square(single)) / len(single))) if single else math.nan
        scatter = float(np.std(seeds, ddof=1) / math.sqrt(len(seeds))) if len(seeds) > 1 else math.nan
        return float(np.fmax(own, scatter))
