"""Running a point until it settles, then for the time of the statistics.

A point runs in whole segments. Each segment starts the integrator again, so that a run that was stopped and goes on gives exactly
the same numbers as one that was not. After each segment past the shortest time the history so far is judged (`judge`); once it
has settled, or at the longest time, the statistics follow.
"""

from __future__ import annotations

import hashlib
import time as clock
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from paper.files import History, is_finished, read_history, write_point, write_progress
from paper.growth import growth_of_history
from paper.points import Point
from trbdyn.errors import StepError, TrbError
from trbdyn.extras.study.work import Report, said
from trbdyn.results import observables

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation

Array = NDArray[np.float64]

LEAST_TURNS: Final = 10
"""Turns of the cage that the settled part must hold: statistics over fewer are those of single events."""
RADIUS_DRIFT: Final = 0.03
"""Largest change of the whirl radius along the settled part, by its trend, in units of Cpr."""
SPACING_DRIFT: Final = 0.1
"""Largest change of the spacing's standard deviation, in units of the angle Cpc/(Dpw/2) that a roller may move in its pocket."""
PROGRESS_S: Final = 10.0
"""Wall time between saves of what a point has reached."""


@dataclass(frozen=True)
class Plan:
    """How long, how fine, how accurately. Times in s of bearing time.

    Attributes
    ----------
    window : float
        Time of the statistics.
    segment : float
        Time between looks at whether it has settled.
    least_time, most_time : float
        Shortest and longest time before the statistics under axial load, where whirls take tens of seconds to grow.
    least_time_combined, most_time_combined : float
        The same under combined load, where everything is faster.
    save_every : float
        Time between records of the history.
    window_save_every : float
        Time between records of the statistics.
    accuracy : str
        Preset of the tolerances.
    """

    window: float = 0.5
    segment: float = 0.5
    least_time: float = 10.0
    most_time: float = 60.0
    least_time_combined: float = 3.0
    most_time_combined: float = 30.0
    save_every: float = 1e-3
    window_save_every: float = 1e-4
    accuracy: str = "standard"

    @classmethod
    def quick(cls) -> Plan:
        """What a second of bearing time tells of directions and scatters: little has settled."""
        return cls(least_time=0.5, most_time=0.5, least_time_combined=0.5, most_time_combined=0.5, accuracy="fast")

    @classmethod
    def smoke(cls) -> Plan:
        """A check that everything works, in a minute: nothing settles."""
        return cls(0.04, 0.03, 0.03, 0.06, 0.03, 0.03, 1e-3, 2e-4, "fast")

    def limits(self, point: Point) -> tuple[float, float]:
        """Shortest and longest time of a point before the statistics (s)."""
        if point.condition.radial_load:
            return self.least_time_combined, max(self.least_time_combined, self.most_time_combined)
        return self.least_time, max(self.least_time, self.most_time)

    def fingerprint(self, point: Point) -> str:
        """What a point's records depend on: its scene and this plan but for the limits of time."""
        parts = (self.window, self.segment, self.save_every, self.window_save_every, self.accuracy)
        return hashlib.sha256(f"{point.scene().fingerprint} {parts}".encode()).hexdigest()


@dataclass(frozen=True)
class Verdict:
    """Whether a history has settled.

    Attributes
    ----------
    settled : bool
        What is left after the transient is long enough, and without drift.
    since : float
        Where the settled part begins (s).
    reason : str
        What is missing.
    drift : dict of str to float
        Change along the settled part by its trend: ``radius`` (Cpr), ``spacing`` (Cpc/(Dpw/2)).
    """

    settled: bool
    since: float
    reason: str
    drift: dict[str, float] = field(default_factory=dict)


def judge(time: Array, radius: Array, spacing: Array, turns: float) -> Verdict:
    """Whether whirl radius and spacing have settled.

    The transient is cut off by the marginal standard error rule (`trbdyn.observables.settling`) over batches of at least one
    turn of the cage; it takes away half of the record at most. What is left must hold `LEAST_TURNS` turns, and its trend must
    change neither signal by more than `RADIUS_DRIFT` and `SPACING_DRIFT`.

    Parameters
    ----------
    time : ndarray, shape (T,)
        Times (s).
    radius, spacing : ndarray, shape (T,)
        Whirl radius in units of Cpr, standard deviation of the spacing in units of Cpc/(Dpw/2).
    turns : float
        Turns of the cage in this time.
    """
    if turns < LEAST_TURNS:
        return Verdict(False, float(time[time.size // 2]), f"only {turns:.1f} turns of the cage")
    found = observables.settling(time, np.column_stack([radius, spacing]), min(int(turns), 50))
    left = turns * (time[-1] - found.time) / (time[-1] - time[0])
    part = slice(found.index, None)
    drift = {"radius": _drift(time[part], radius[part]), "spacing": _drift(time[part], spacing[part])}
    if left < LEAST_TURNS:
        return Verdict(False, found.time, f"settled for {left:.1f} turns of the cage only", drift)
    for name, limit in (("radius", RADIUS_DRIFT), ("spacing", SPACING_DRIFT)):
        if abs(drift[name]) > limit:
            return Verdict(False, found.time, f"{name} drifts", drift)
    return Verdict(True, found.time, "", drift)


def _drift(time: Array, values: Array) -> float:
    """Change along a record by the least-squares line."""
    centred = time - time.mean()
    return float(centred @ (values - values.mean()) / (centred @ centred) * (time[-1] - time[0]))


def judge_history(history: History, point: Point) -> Verdict:
    """`judge` for a point's history; a whirl that grows from almost nothing has not settled, however little it moves."""
    bearing = point.scene().bearing
    unit = np.degrees(bearing.cage.play_circumferential / (0.5 * bearing.pitch_diameter))
    radius = observables.axis_distance(history["cage_position"]) / bearing.cage.play_radial
    spacing = observables.spacing_std(history["roller_orbit_angle"]) / unit
    turned = np.mean(history["roller_orbit_angle"][-1] - history["roller_orbit_angle"][0])
    verdict = judge(history["time"], radius, spacing, float(abs(turned)) / (2.0 * np.pi))
    if verdict.settled and growth_of_history(history, bearing.cage.play_radial).growing:
        return replace(verdict, settled=False, reason="the whirl grows")
    return verdict


@dataclass(frozen=True)
class PointTask:
    """What a worker is to do.

    Attributes
    ----------
    point : Point
        What is run.
    plan : Plan
        How.
    path : str
        Its file.
    """

    point: Point
    plan: Plan
    path: str

    @property
    def fingerprint(self) -> str:
        """Of the point and the plan."""
        return self.plan.fingerprint(self.point)


def progress_path(path: Path) -> Path:
    """Where a point that is under way, or was stopped, keeps what it has reached."""
    return path.with_name(f".{path.stem}.progress.h5")


def is_there(path: Path) -> bool:
    """Whether a point has been run, if only in part."""
    return path.exists() or progress_path(path).exists()


def is_done(task: PointTask) -> bool:
    """Whether the point's file is there, and settled or as long as the plan wants."""
    found = is_finished(Path(task.path), task.fingerprint)
    least, most = task.plan.limits(task.point)
    return found is not None and (found.time >= most - 1e-9 or (found.settled and found.time >= least - 1e-9))


def run_point(task: PointTask, stopped: Callable[[], bool]) -> Report:
    """Run a point, from where an earlier run left it.

    Raises
    ------
    KeyboardInterrupt
        If it was stopped; what it reached is saved.
    """
    began = clock.perf_counter()
    try:
        message = _Run(task, stopped).go()
    except Exception as error:
        return Report("failed", said(error), wall_s=clock.perf_counter() - began)
    return Report("done", message, Path(task.path).name, wall_s=clock.perf_counter() - began)


class _Run:
    def __init__(self, task: PointTask, stopped: Callable[[], bool]) -> None:
        from trbdyn.run.simulation import Simulation

        self.task, self.stopped = task, stopped
        self.least, self.most = task.plan.limits(task.point)
        self.path = Path(task.path)
        self.progress = progress_path(self.path)
        self.sim: Simulation = Simulation(task.point.scene(), accuracy=task.plan.accuracy)
        self.history = self._earlier() or History({}, float("nan"), np.empty(0), 0.0)
        self.saved = clock.perf_counter()

    def _earlier(self) -> History | None:
        """What an earlier run reached, if it was of the same scene."""
        found = [read_history(path, self.task.fingerprint) for path in (self.progress, self.path)]
        best = max((h for h in found if h is not None), key=lambda history: history.reached, default=None)
        if best is not None:
            self.sim.set_state(best.state, best.reached)
        return best

    def go(self) -> str:
        plan, point = self.task.plan, self.task.point
        verdict = judge_history(self.history, point) if self.history.fields else Verdict(False, 0.0, "")
        while self._wants_more(verdict):
            self._segment(plan.segment)
            verdict = judge_history(self.history, point)
        self._window(verdict)
        self.progress.unlink(missing_ok=True)
        return f"settled since {verdict.since:.3g} s" if verdict.settled else f"not settled: {verdict.reason}"

    def _wants_more(self, verdict: Verdict) -> bool:
        end = self.history.end
        if not self.history.fields or end < self.least - 1e-9:
            return True
        return not verdict.settled and end < self.most - 1e-9

    def _segment(self, duration: float) -> None:
        began = clock.perf_counter()
        result = self._stepped(duration, self.task.plan.save_every, ("cage", "rollers"))
        self.history = self.history.extended(result, self.sim.state, clock.perf_counter() - began)
        if clock.perf_counter() - self.saved > PROGRESS_S:
            self._save_progress()

    def _save_progress(self) -> None:
        write_progress(self.progress, self.history, self.task.fingerprint)
        self.saved = clock.perf_counter()

    def _stepped(self, duration: float, every: float, groups: tuple[Any, ...]) -> Any:
        self.sim.set_state(self.sim.state)
        try:
            result = self.sim.run(
                duration=duration, save_every=every, save_groups=groups, callback=lambda _: self.stopped()
            )
        except StepError as error:
            self._save_progress()
            raise TrbError(f"at {error.time:.4g} s: {error}") from None
        if not result.success:
            if self.history.fields:
                self._save_progress()
            raise KeyboardInterrupt
        return result

    def _window(self, verdict: Verdict) -> None:
        plan, point = self.task.plan, self.task.point
        groups = ("cage", "rollers", "pocket", "torque", *(("contacts",) if point.condition.radial_load else ()))
        result = self._stepped(plan.window, plan.window_save_every, groups)
        about = {
            "point": point.name,
            "condition": asdict(point.condition),
            "start": point.start,
            "seed": point.seed if point.seeded else None,
            "plan": asdict(plan),
            "settled": verdict.settled,
            "settled_since": verdict.since,
            "reason": verdict.reason,
            "drift": verdict.drift,
            "bearing_time": float(result["time"][-1]),
        }
        write_point(self.path, result, self.history, about, self.task.fingerprint)
