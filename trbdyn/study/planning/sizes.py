"""What an error of an average is measured by: its value, or the least value that means anything where it is smaller.

An orbit of the cage of a hundred-thousandth of its play is no orbit, and six percent of it is no promise that anybody could keep
or use. Errors of such an average are shares of the least value, so that what is promised is an absolute bound.
"""

from __future__ import annotations

from typing import Final

from trbdyn.results.fields import contacts
from trbdyn.study.planning.averaged import of_bearing

LEAST: Final = {
    "cage_slip": 1e-4,
    "orbit_": 0.01,
    "axis_": 0.01,
    "axial_": 0.01,
    "whirl_ratio": 0.05,
    "whirl_coherence": 0.05,
    "speed_deviation_": 0.05,
    "tilt_": 1e-5,
    "lean_": 1e-5,
    "skew_": 1e-5,
    "spacing_": 1e-3,
    "pocket_force_": 0.1,
    "pocket_duty": 1e-3,
    **{f"{side}_load_": 0.1 for side in contacts()},
}
"""Least value that means anything, by the beginning of the average's name, in the units of the summary; 0 for others."""


def least_size(name: str) -> float:
    """The least value of an average that means anything; 0 where each does."""
    own = of_bearing(name)[1]
    return next((size for start, size in LEAST.items() if own.startswith(start)), 0.0)


def size_of(name: str, value: float) -> float:
    """What errors of an average are shares of."""
    return max(abs(value), least_size(name))
