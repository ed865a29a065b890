"""Band of the largest pocket force after a load that drops and comes back.

A drop lets the rollers leave their order, and where each of them is when the load comes back decides which hit is the hardest. So
the largest force is one draw among many, that other starts and other accuracies would have drawn differently. How far they
scatter is measured by ``benchmarks/load_drop.py``.
"""

from __future__ import annotations

import json
import math
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.base.shipped import DATA
from trbdyn.model.motion import History

if TYPE_CHECKING:
    from trbdyn.results.result import Result

DROP: Final = 0.5
"""Share of its largest value below which a load has dropped."""


@cache
def measured() -> dict[str, Any]:
    """What was measured: `scatter`, the standard deviation of the logarithm of the peak over starts and accuracies; `text`."""
    found: dict[str, Any] = json.loads((DATA / "accuracy.json").read_text(encoding="utf-8"))["load_drop"]
    return found


def band(peak: float) -> tuple[float, float]:
    """Between which forces (N) the peak of a run with another start or accuracy lies in 95 of 100 cases."""
    factor = math.exp(1.96 * math.sqrt(2.0) * float(measured()["scatter"]))  # both peaks are draws
    return peak / factor, peak * factor


def drops(window: Result) -> bool:
    """Whether the axial or the radial load changes in time and falls, within the window, below a share of its largest value."""
    scene, time = window.scene, window["time"]
    for load in (scene.axial_load, scene.radial_load):
        if isinstance(load, History):
            values = np.abs(load.value(time))
            if values.min() < DROP * values.max():
                return True
    return False
