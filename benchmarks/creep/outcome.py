"""What the paper states of the cage's whirl, judged by short runs from a small and from a large orbit.

Statements on axial motion, tilt and forces (Figs. 9, 10, 13) are not judged here; Fig. 17 is geometry.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .planar import Motion, growth

CLEAR = 0.2
"""Synchronous whirl radius over Cpr from which a cage whirls."""
LARGER = 0.02
"""Difference of radii over Cpr that counts."""
SIZE = 0.15
"""How near the reach of the locus, over Cpr, must be to 1 or to Cpc/Cpr."""
SCATTER = 1.5
"""Factor by which scatter must enlarge the whirl."""
DRIFT = 0.03
"""Change of the radius, over Cpr, in the last turns from which a run has not settled."""
FLUTTER = 1.3
"""Distance from the axis, over Cpr, that no cage with stiff bars reaches."""
LAST = 6
"""Turns of the cage that are averaged."""

Key = tuple[float, float, float, bool]
"""Speed (1/min), axial load (N), radial load (N), scatter of diameters."""


@dataclass(frozen=True)
class Outcome:
    """Where a run ended, in units of Cpr.

    Attributes
    ----------
    whirl : float
        Synchronous whirl radius over the last turns.
    drift : float
        Its change from the turns before.
    reach : float
        95th percentile of the distance from the axis.
    lasting, varying : float
        Pattern of the rollers: its mean over the last turns, and rms of what varies.
    rate : float
        Growth of the pattern a turn.
    """

    whirl: float
    drift: float
    reach: float
    lasting: float
    varying: float
    rate: float


def outcome(motion: Motion, case: int = 0) -> Outcome:
    """Outcome of one case of a motion."""
    count, size = motion.samples * LAST, motion.position.shape[0] - 1
    position, pattern = motion.position[:size, case], motion.pattern[:size, case]
    turned = position * np.exp(-2j * np.pi * np.arange(size) / motion.samples)
    whirl, before = (abs(turned[part].mean()) for part in (slice(-count, None), slice(-2 * count, -count)))
    mean = pattern[-count:].mean()
    only = Motion(motion.position[:, case : case + 1], motion.pattern[:, case : case + 1], motion.samples)
    return Outcome(
        whirl=float(whirl),
        drift=float(whirl - before),
        reach=float(np.percentile(np.abs(position[-count:]), 95.0)),
        lasting=float(abs(mean)),
        varying=float(np.sqrt(np.mean(np.abs(pattern[-count:] - mean) ** 2))),
        rate=float(growth(only)[0][0]),
    )


def point(speed: float, load: float, radial: float = 0.0, scatter: bool = False) -> Key:
    """Key of a point."""
    return speed, load, radial, scatter


SPEEDS = tuple(point(speed, 3080.0) for speed in (1000.0, 2000.0, 3000.0))
LOADS = tuple(point(3000.0, load) for load in (1230.0, 3080.0, 4930.0))
AXIAL = tuple(dict.fromkeys((*SPEEDS, *LOADS)))
COMBINED = (point(2000.0, 4930.0, 5530.0), point(3000.0, 4930.0, 5530.0))
SCATTERED = point(3000.0, 1230.0, scatter=True)
POINTS = (*AXIAL, *COMBINED, SCATTERED)


def _grows(radii: list[float]) -> bool:
    return all(after - before > LARGER for before, after in pairwise(radii))


def judge(found: Mapping[Key, Outcome], play_ratio: float) -> dict[str, tuple[bool, bool]]:
    """Verdict on each statement whose points are there, and whether all of them had settled."""
    light, heavy = LOADS[0], LOADS[-1]
    slow, fast = COMBINED
    rules = {
        "8a whirls at all speeds": (SPEEDS, lambda: all(found[key].whirl >= CLEAR for key in SPEEDS)),
        "8a grows with speed": (SPEEDS, lambda: _grows([found[key].whirl for key in SPEEDS])),
        "8b grows with load": (LOADS, lambda: _grows([found[key].whirl for key in LOADS])),
        "8b about 1 at 4930 N": (
            (heavy,),
            lambda: found[heavy].whirl >= CLEAR and abs(found[heavy].reach - 1.0) <= SIZE,
        ),
        "12b none at 1230 N": ((light,), lambda: found[light].whirl < CLEAR),
        "14 yields at 1230 N": ((light,), lambda: found[light].varying > found[light].lasting),
        "14 persists at 4930 N": ((heavy,), lambda: found[heavy].lasting > found[heavy].varying),
        "15 scatter enlarges": (
            (light, SCATTERED),
            lambda: found[SCATTERED].whirl >= SCATTER * found[light].whirl,
        ),
        "16 smaller if combined": ((fast, heavy), lambda: found[heavy].whirl - found[fast].whirl > LARGER),
        "16 about Cpc/Cpr": (COMBINED, lambda: all(abs(found[key].reach - play_ratio) <= SIZE for key in COMBINED)),
        "18 equalises": ((slow,), lambda: found[slow].rate < 0.0),
    }
    return {
        name: (bool(rule()), all(abs(found[key].drift) < DRIFT for key in keys))
        for name, (keys, rule) in rules.items()
        if all(key in found for key in keys)
    }
