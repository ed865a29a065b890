"""Whether a loss is off by the way of one motion, or by a bias of the tolerances.

Bodies that hit each other go their own ways: the first impacts of a run decide about its loss, and all runs with tolerances near
its own may take the same way, which is another one than that of tight runs. Scenes like it, with other speeds, loads and starts,
take other ways each. Where tolerances are at fault, their losses are off in the mean; where the way is, they are not.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

import trbdyn as trb

Table = dict[str, Any]

LIKE = 32
"""Scenes like the judged one."""
FEWEST = 0.75
"""Share of them that must have been compared."""


def like(table: Table, number: int) -> Table:
    """A scene like another one."""
    rng = np.random.default_rng(number)
    found = table | {"seed": int(rng.integers(1000)), "direction_deg": float(rng.uniform(0.0, 360.0))}
    factors = {"speed": rng.uniform(0.7, 1.4), "load": rng.uniform(0.5, 2.0), "share": rng.uniform(0.5, 1.5)}
    names = {
        "speed": ("speed_rpm", "outer_speed_rpm", "end_speed_rpm"),
        "load": ("axial_load", "end_axial_load"),
        "share": ("radial_share",),
    }
    for kind, fields in names.items():
        found |= {name: factors[kind] * table[name] for name in fields if isinstance(table.get(name), float)}
    if "eccentricity" in table:
        found["eccentricity"] = float(rng.uniform(0.5, 0.9))
    if "temperature_c" in table:
        found["temperature_c"] = table["temperature_c"] + float(rng.uniform(-12.0, 12.0))
    return found


def mean_difference(
    table: Table, losses: Callable[[Table], tuple[float, float]], count: int = LIKE
) -> tuple[float, float]:
    """By how much losses of scenes like this are off in the mean, and twice its standard error; infinite if too few can be run.

    Parameters
    ----------
    table : dict
        The scene.
    losses : callable
        Losses of a scene by the tolerances that are judged, and by tight ones (J); nan where a run did not come to its end.

    count : int
        How many scenes; three quarters of them must have been compared.

    Returns
    -------
    tuple of float
        Over the loss by tight tolerances.
    """
    off = []
    for number in range(count):
        try:
            own, tight = losses(like(table, number))
        except trb.TrbError:
            continue
        if math.isfinite(own) and math.isfinite(tight) and tight > 0.0:
            off.append(own / tight - 1.0)
    if len(off) < FEWEST * count:
        return math.inf, math.inf
    return float(np.mean(off)), 2.0 * float(np.std(off, ddof=1)) / math.sqrt(len(off))


def within_its_interval(result: trb.Result, tight: trb.Result) -> bool:
    """Whether the power loss of the tight run lies in the 95 % interval that the summary of the other one states."""
    said, right = result.summary(), tight.summary()
    half = (said.get("confidence") or {}).get("power_loss")
    return half is not None and abs(said["power_loss"] - right["power_loss"]) <= half
