"""How much the law of rolling resistance leaves open of a friction torque, and how far predicted torques were off where they were
measured.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import numpy as np

from trbdyn.base.expected import expect
from trbdyn.base.shipped import DATA
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.effects import Effects
from trbdyn.model.lubricants import OIL_SUPPLIES, ROLLING_SUPPLY
from trbdyn.model.motion import is_constant, knot_times
from trbdyn.model.roller import Profile
from trbdyn.model.scene import Scene
from trbdyn.model.start import Start
from trbdyn.run.simulation import Simulation

DEFENDED: Final = ("zhou_hoeprich", "biboulet_houpert")
"""Laws of rolling resistance that can be defended beside the default: the one that was fitted to measurements of a tapered roller
bearing, and the theory of a contact that is full of oil."""
RECORD: Final = "torque_record.json"
APART: Final = frozenset(
    {
        *("gravity", "bodies", "quadrature", "n_slices", "oil_fill", "drag_coefficient", "supply"),
        *("damping", "film_damping", "film_damping_depth", "damping_race", "damping_cage"),
    }
)
"""Effects that may differ from `Effects.standard` where its record of measured torques is told: they hardly change a steady
torque, or are looked at by themselves."""
DRAGS: Final = {
    0.0: "no_drag",
    OIL_SUPPLIES["bath"].fill: "drag_of_the_state",
    OIL_SUPPLIES["flooded"].fill: "drag_of_the_state",
}
"""Parts of the record, by `Effects.oil_fill`: bearings were run with the default, and with the fill of their state."""


@dataclass(frozen=True)
class TorqueLaws:
    """What other laws make of a torque: `factors`, by the law's name, of that of the subject. `record` says how far the
    subject's effects were off measured torques; it is empty where they were not compared.
    """

    factors: dict[str, float]
    record: str

    @property
    def low(self) -> float:
        """Smallest factor, the subject's own law among them (1)."""
        return min(1.0, *self.factors.values())

    @property
    def high(self) -> float:
        """Largest factor (1)."""
        return max(1.0, *self.factors.values())

    def band(self, low: float, high: float) -> tuple[float, float]:
        """A band of a torque, or its value twice, with what the laws leave open (N m)."""
        ends = [factor * end for factor in (self.low, self.high) for end in (low, high)]
        return min(ends), max(ends)

    def words(self, low: float, high: float) -> str:
        """The band in words, with the laws and the record."""
        wide = self.band(low, high)
        names = " and ".join(name.replace("_", "-").title() for name in self.factors)
        return f"{wide[0]:.3g} to {wide[1]:.3g} N m with the laws {names}" + (f"; {self.record}" if self.record else "")


def torque_laws(subject: Subject) -> TorqueLaws | None:
    """What the laws of rolling resistance that can be defended make of the torque of a scene or an assembly; None without
    rolling resistance. The power that all contacts lose at the equilibrium, in ideal rolling, is taken with each law.
    """
    expect("subject", subject, Scene, Assembly)
    parts = [part for part in subject.parts.values() if part.effects.films and part.effects.rolling_resistance]
    if not parts:
        return None
    subject = at_largest_speed(subject)
    # an elastic cage has no part in it, and its file is not read
    subject = subject.replace({f"{prefix}elastic_cage": None for prefix in subject.parts})
    own = _power(subject)
    if not own > 0.0:
        return None
    used = {part.effects.rolling_law for part in parts}
    factors = {}
    for law in DEFENDED:
        if used != {law}:
            changed = subject.replace({f"{prefix}effects.rolling_law": law for prefix in subject.parts})
            factors[law] = _power(changed) / own
    words = {record_words(part.effects) for part in parts}
    return TorqueLaws(factors, words.pop() if len(words) == 1 else "")


def at_largest_speed(subject: Subject) -> Subject:
    """A subject that starts where its speed is largest, if speeds change: at rest nothing is lost that can be compared."""
    speeds = (subject.speed_rpm, subject.outer_speed_rpm)
    if all(is_constant(one) for one in speeds):
        return subject
    times = knot_times(speeds, subject.part.start.time)
    fastest = max(times.tolist(), key=lambda time: abs(subject.rolling_rpm(time)))
    return subject.replace({f"{prefix}start": Start(time=fastest) for prefix in subject.parts})


def straight_rollers(scene: Scene) -> tuple[float | None, float] | None:
    """Torque and largest pressure with straight rollers over those with a profile that nobody gave, at the equilibrium (1), where
    the speed is largest; None where the profile is given, or straight, and no torque where nothing turns.
    """
    bearing, still = scene.bearing, at_largest_speed(scene.replace(elastic_cage=None))
    if bearing.roller.profile.kind == "straight" or not any(
        path.startswith("roller.profile") for path in bearing.assumed
    ):
        return None
    profiled, straight = (
        Simulation(one).contacts() for one in (still, still.replace({"bearing.roller.profile": Profile.straight()}))
    )
    lost = float(np.sum(profiled["power"]))
    pressure = float(np.max(straight["raceway_pressure"]) / np.max(profiled["raceway_pressure"]))
    return float(np.sum(straight["power"])) / lost if lost > 0.0 else None, pressure


def _power(subject: Subject) -> float:
    """Power that the contacts lose at the start (W)."""
    found = Simulation(subject).contacts()
    parts = [found] if "power" in found else list(found.values())
    return float(sum(np.sum(part["power"]) for part in parts))


@cache
def record() -> Mapping[str, Any]:
    """Summary of ``benchmarks/validation``, by the values of `DRAGS`: numbers of bearings and of torques, mean error over
    bearings, the same with the supply of oil fitted without each bearing, largest error, and by bearing the mean error at points
    that no choice of the package was made with (%).
    """
    found: dict[str, Any] = json.loads((DATA / RECORD).read_text(encoding="utf-8"))
    return found


def record_words(effects: Effects) -> str:
    """How far these effects were off measured torques, in a sentence; empty where they were not compared."""
    standard, whole = Effects.standard(), record()
    same = all(getattr(effects, name) == getattr(standard, name) for name in Effects.model_fields if name not in APART)
    stated = effects.supply is None or effects.supply in {state.value for state in ROLLING_SUPPLY.values()}
    one = whole.get(DRAGS.get(effects.oil_fill, ""))
    if one is None or not (same and stated):
        return ""
    apart = " and ".join(f"{error:.0f} % ({name})" for name, error in one["held_back"].items())
    return (
        f"on {one['bearings']} bearings these effects were {one['left_out_error']:.0f} % off {one['torques']} measured "
        f"torques in the mean over bearings, each left out of the fit of the oil's supply, {one['max_error']:.0f} % at most "
        f"(from {whole['from_rpm']:g} rpm on), and {apart} off {one['held_back_torques']} others that no choice was made with"
    )
