"""Runs that are made again, longer, until what is wanted of them has settled; and whether torque and losses of a run have."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from trbdyn.extras.study.definition import Case, Study
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.runner import run as run_study
from trbdyn.extras.study.work import Observable
from trbdyn.results import observables
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.results.rows.losses import mean_loss, shaft_torque
from trbdyn.run.options import RunOptions

if TYPE_CHECKING:
    import xarray

Point = TypeVar("Point")

TURNS: Final = (2.0, 8.0, 32.0)
"""Turns of the shaft after which a torque is judged; the next number where it has not settled yet."""
RECORDS: Final = 64
"""Records of a run."""
STEADY: Final = 0.9
"""Largest factor from quarter to quarter by which a change is taken to shrink."""
GROUPS: Final = ("contacts", "torque", "power", "energy")


def run_until_settled(
    points: Sequence[Point],
    turns: Sequence[float],
    case: Callable[[Point, float], Case],
    judged: Callable[[xarray.Dataset], Mapping[str, Any]],
    observables: Mapping[str, Observable],
    how: Running,
    unknown: Mapping[str, Any] | None = None,
) -> dict[Point, dict[str, Any]]:
    """Run points, each again with the next number of turns (ascending) until it has settled or cannot be run.

    `case` makes the case of a point with a number of turns; `judged` gives from the entry of a run in the dataset whether it has
    ``settled``, and what else is wanted, in place of which a run that failed has `unknown`. Each point's longest run is returned:
    what was judged, its ``turns``, and a ``message`` that says why it failed, else empty. Runs go side by side in threads unless
    `how` says otherwise.
    """
    rows: dict[Point, dict[str, Any]] = {}
    waiting = list(points)
    for length in turns:
        if not waiting:
            break
        study = Study(tuple(case(point, length) for point in waiting), (), "settled")
        data = run_study(study, observables=observables, **(Running(executor="threads") | how))
        for k, point in enumerate(waiting):
            found = data.isel(case=k)
            done = str(found["status"].values) == "done"
            message = "" if done else str(found["message"].values).splitlines()[0]
            own = judged(found) if done else {**(unknown or {}), "settled": False}
            rows[point] = {**own, "turns": length, "message": message}
        waiting = [point for point in waiting if not rows[point]["settled"] and not rows[point]["message"]]
    return rows


def variables(
    rows: Sequence[Mapping[str, Any]], about: Mapping[str, tuple[str, str]], dims: Sequence[str], shape: Sequence[int]
) -> dict[str, Any]:
    """Variables of a dataset over some dimensions, each with its words and unit, from rows of runs: the last dimension changes
    fastest.
    """
    made: dict[str, Any] = {}
    for name, told in about.items():
        values = np.array([row[name] for row in rows], dtype=object if isinstance(rows[0][name], str) else None)
        attributes = {key: text for key, text in zip(("long_name", "units"), told, strict=True) if text}
        made[name] = (dims, values.reshape(shape), attributes)
    return made


def short_run(options: RunOptions, speed_rpm: float, turns: float) -> RunOptions:
    """Options of a run over some turns of the shaft (1) at a speed (rpm) that keeps what is judged."""
    save_every = 60.0 / abs(speed_rpm) * turns / RECORDS
    return options.replace(revolutions=turns, duration=None, save_every=save_every, save_groups=GROUPS)


def drift(result: Result | AssemblyResult) -> float:
    """How far the torque at the end of a run may still be from where it settles, over that torque (1).

    Of runs whose last half holds several turns of the cage: two standard errors of the mean over these turns, and what their
    rate makes of it in that time, where it stands out of their scatter. Of shorter ones from the means over the last three
    quarters of the run: a change that shrinks from quarter to quarter by a steady factor goes on so, at most with a factor of
    0.9; one that turns round is scatter and counts as it is. Of several bearings the largest, by the power that each loses: the
    shaft's work is known of all together only, and the mean of few records of a torque scatters.
    """
    if len(result.parts) == 1:
        return _drift(result.parts[0], shaft_torque)
    return max(_drift(part, mean_loss) for part in result.parts)


def _drift(result: Result, mean: Callable[[Result], float]) -> float:
    time = result["time"]
    half = 0.5 * (time[0] + time[-1])
    turns = int(abs(np.mean(result.rolling_orbit)) * (time[-1] - half) / (2.0 * np.pi))
    if turns >= observables.LEAST_BLOCKS:
        edges = np.searchsorted(time, np.linspace(half, time[-1], turns + 1) - 1e-12)
        values = np.array([mean(result.window(time[a], time[b])) for a, b in pairwise(edges.tolist())])
        middles = 0.5 * (time[edges[1:]] + time[edges[:-1]])
        return observables.mean_unknown(middles, values) / max(abs(float(values.mean())), 1e-300)
    return _by_quarters(result, mean)


def _by_quarters(result: Result, mean: Callable[[Result], float]) -> float:
    start, end = result["time"][0], result["time"][-1]
    cuts = [start + share * (end - start) for share in (0.25, 0.5, 0.75)]
    # means from each cut to the end, and from them those of the quarters
    third, half, quarter = (mean(result.window(cut)) for cut in cuts)
    quarters = (3.0 * third - 2.0 * half, 2.0 * half - quarter, quarter)
    before, last = quarters[1] - quarters[0], quarters[2] - quarters[1]
    if before * last < 0.0:
        return float(max(abs(before), abs(last)) / max(abs(quarter), 1e-300))
    shrinking = min(last / before, STEADY) if before != 0.0 else 0.0
    return float(abs(last) / (1.0 - shrinking) / max(abs(quarter), 1e-300))


def stored(result: Result | AssemblyResult) -> float:
    """How much of the shaft's power over the second half of a run was not lost but went into motion or springs (1)."""
    halves = [part.window(0.5 * (part["time"][0] + part["time"][-1])) for part in result.parts]
    if len(halves) == 1:
        power = abs(shaft_torque(halves[0]) * halves[0].rolling_speed.mean())
    else:
        power = abs(sum(np.ptp(half["work_shaft"][[0, -1]]) / np.ptp(half["time"]) for half in halves))
    return float(abs(power - sum(map(mean_loss, halves))) / max(power, 1e-300))


JUDGED: Final = {"drift": drift, "stored": stored}
"""What tells whether a torque has settled."""
