"""Indicators of a run of a few dozen turns of the cage.

An orbit under axial load takes 10 to 25 s to settle, longer than a study can run each of its cases. Indicators therefore tell
what a short run tells: how fast an orbit from a stated start grows or shrinks, and what the motion is near the largest orbit.

The cage's centre in a frame that turns with the cage, averaged over each whole turn, is the orbit as the rollers' places hold
it; its modulus is the *orbit*, free of what is at rest (the cage hanging to one side) and of bounces within the pockets. Every
indicator is taken over the last two thirds of a run.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.results import observables

if TYPE_CHECKING:
    from trbdyn.results.result import Result

Array = NDArray[np.float64]
TRANSIENT: Final = 1.0 / 3.0
"""Share of a run before the statistics."""
SMALLEST_ORBIT: Final = 1e-3
"""Orbit (Cpr) below which growth is not told apart: its logarithm is noise."""


def part(result: Result) -> Result:
    """The part of a run that counts."""
    time = result["time"]
    return result.window(float(time[0] + TRANSIENT * (time[-1] - time[0])), float(time[-1]))


def turns_of(angle: Array) -> list[NDArray[np.intp]]:
    """Records of each whole turn of an angle."""
    turn = (np.abs(angle - angle[0]) // (2.0 * math.pi)).astype(int)
    return [np.flatnonzero(turn == k) for k in range(int(turn[-1]))]


def turning_centre(result: Result) -> NDArray[np.complex128]:
    """Centre of the cage in the frame that turns with it, x + i y over Cpr, mean of each whole turn."""
    position, angle = result["cage_position"], result["cage_angle"]
    centre = (position[:, 0] + 1j * position[:, 1]) / result.clearances.radial * np.exp(-1j * angle)
    return np.array([centre[rows].mean() for rows in turns_of(angle)])


def orbit_growth(result: Result) -> float:
    """Growth of the orbit per cage turn: slope of the logarithm of its radius, by least squares (%); nan below two turns."""
    orbit = np.maximum(np.abs(turning_centre(part(result))), SMALLEST_ORBIT)
    return 100.0 * float(np.polyfit(np.arange(orbit.size), np.log(orbit), 1)[0]) if orbit.size > 1 else math.nan


def orbit(result: Result) -> float:
    """Radius of the orbit, mean over the turns (Cpr)."""
    return float(np.abs(turning_centre(part(result))).mean())


def hang(result: Result) -> float:
    """Distance from the bearing axis of the place about which the cage moves, over whole turns (Cpr)."""
    window = part(result)
    rows = np.concatenate(turns_of(window["cage_angle"]))
    return float(np.hypot(*window["cage_position"][rows, :2].mean(axis=0)) / window.clearances.radial)


def whirl_radius(result: Result) -> float:
    """Distance of the cage's centre from the bearing axis, mean (Cpr): the paper's whirl radius."""
    return float(part(result).axis_distance_over_cpr.mean())


def whirl_radius_range(result: Result) -> list[float]:
    """The same, 5 % and 95 % (Cpr)."""
    return [float(value) for value in np.percentile(part(result).axis_distance_over_cpr, (5.0, 95.0))]


def whirl_order(result: Result) -> float:
    """Whirl frequency about the bearing axis over the cage's rotation frequency (1); zero for a cage that hangs at one side."""
    window = part(result)
    whirl = observables.whirl_frequency(window["time"], window["cage_position"], "axis")
    return whirl / observables.cage_frequency(window["time"], window["cage_angle"])


def pocket_force(result: Result) -> float:
    """Pocket force that 95 % of the moments in contact stay below (N)."""
    force = part(result)["pocket_force"]
    touched = force[force > 0.0]
    return float(np.percentile(touched, 95.0)) if touched.size else 0.0


def torque(result: Result) -> float:
    """Friction torque of the shaft, mean (N m)."""
    return float(part(result)["inner_torque"].mean())


def spacing(result: Result) -> float:
    """Standard deviation of the spacing of neighbours, mean (deg)."""
    return float(observables.spacing_std(part(result)["roller_orbit_angle"]).mean())


@dataclass(frozen=True)
class Indicator:
    """One number of a run.

    Attributes
    ----------
    name : str
        Name in files.
    text, unit : str
        For people.
    start : {'small', 'full'}
        Start of the runs from which it is read.
    """

    name: str
    text: str
    unit: str
    start: str


INDICATORS: Final = (
    Indicator("orbit_growth", "growth of a small orbit", "% a turn", "small"),
    Indicator("whirl_radius", "whirl radius, start at 0.9 $C_{pr}$", "$C_{pr}$", "full"),
    Indicator("orbit", "orbit, start at 0.9 $C_{pr}$", "$C_{pr}$", "full"),
    Indicator("hang", "distance of the orbit's centre", "$C_{pr}$", "full"),
    Indicator("whirl_order", "whirl over cage frequency", "1", "full"),
    Indicator("pocket_force", "pocket force, 95 %", "N", "full"),
    Indicator("torque", "torque of the shaft", "N m", "full"),
    Indicator("spacing", "deviation of the spacing", "deg", "full"),
)
"""Indicators whose effects are told."""

OBSERVABLES: Final[Mapping[str, Callable[[Any], Any]]] = {
    f"sens_{name}": function
    for name, function in {
        "orbit_growth": orbit_growth,
        "whirl_radius": whirl_radius,
        "whirl_radius_range": whirl_radius_range,
        "orbit": orbit,
        "hang": hang,
        "whirl_order": whirl_order,
        "pocket_force": pocket_force,
        "torque": torque,
        "spacing": spacing,
    }.items()
}
"""What a study reads of each run, named apart from the summary's entries."""
