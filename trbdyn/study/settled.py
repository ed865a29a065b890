"""Whether torque and losses of a short run have settled."""

from __future__ import annotations

from typing import Final

from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.results.summary import mean_loss, shaft_torque
from trbdyn.run.options import RunOptions

TURNS: Final = (2.0, 8.0, 32.0)
"""Turns of the shaft after which a torque is judged; the next number where it does not stand yet."""
RECORDS: Final = 64
"""Records of a run."""
STEADY: Final = 0.9
"""Largest factor from quarter to quarter by which a change is taken to shrink."""
GROUPS: Final = ("contacts", "torque", "power", "energy")


def short_run(options: RunOptions, speed_rpm: float, turns: float) -> RunOptions:
    """Options of a run over some turns of the shaft (1) at a speed (rpm) that keeps what is judged."""
    save_every = 60.0 / abs(speed_rpm) * turns / RECORDS
    return options.replace(revolutions=turns, duration=None, save_every=save_every, save_groups=GROUPS)


def drift(result: Result | AssemblyResult) -> float:
    """How far the torque at the end of a run may still be from where it settles, over that torque (1).

    From the means over the last three quarters of the run: a change that shrinks from quarter to quarter by a steady factor
    goes on so. A factor above 0.9 counts as 0.9, as a mean that only scatters has any. Of several bearings the largest.
    """
    return max(map(_drift, result.parts))


def _drift(result: Result) -> float:
    start, end = result["time"][0], result["time"][-1]
    cuts = [start + share * (end - start) for share in (0.25, 0.5, 0.75)]
    # means from each cut to the end, and from them those of the quarters
    third, half, quarter = (shaft_torque(result.window(cut)) for cut in cuts)
    quarters = (3.0 * third - 2.0 * half, 2.0 * half - quarter, quarter)
    before, last = abs(quarters[1] - quarters[0]), abs(quarters[2] - quarters[1])
    shrinking = min(last / before, STEADY) if before > 0.0 else 0.0
    return float(last / (1.0 - shrinking) / max(abs(quarter), 1e-300))


def stored(result: Result | AssemblyResult) -> float:
    """How much of the shaft's power over the second half of a run was not lost but went into motion or springs (1); of several
    bearings the largest.
    """
    return max(map(_stored, result.parts))


def _stored(result: Result) -> float:
    half = result.window(0.5 * (result["time"][0] + result["time"][-1]))
    power = abs(shaft_torque(half) * half.rolling_speed.mean())
    return abs(power - mean_loss(half)) / max(power, 1e-300)
