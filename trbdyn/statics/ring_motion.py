"""Motion of the inner ring as the core takes it: at rest in its equilibrium, or along the path of its equilibria."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import scipy
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import InputError, LoadError
from trbdyn.model.flatten import HOUSING_LOADS, motion_table, ring_load
from trbdyn.model.motion import History, is_constant
from trbdyn.model.scene import Scene
from trbdyn.model.shaft import angle_turned
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import Equilibrium, EquilibriumSolver, nominal_angles
from trbdyn.statics.ring_path import find_path

Array = NDArray[np.float64]


SAME_PLACE: Final = 1e-8
"""Distance of a ring from where it stood before that is worth a warning (m): thirty times the tolerance of its path."""
OTHER_SPEED: Final = 2e-6
"""The same for a held ring whose speed changes: by less it moves with the centrifugal forces of the rollers (m)."""


def start_angles(scene: Scene) -> Array:
    """Orbit angles at which the rollers start (rad), shape (Z,)."""
    start, cage, even = scene.start, scene.bearing.cage, nominal_angles(scene)
    radius = 0.5 * scene.bearing.pitch_diameter
    if start.kind == "unequal":
        random = np.random.default_rng(start.seed)
        return even + start.spread * random.uniform(-1.0, 1.0, even.size) * cage.play_circumferential / radius
    if start.kind == "whirl":
        shift = start.eccentricity * cage.play_radial
        direction = math.radians(start.direction_deg)
        pocket = radius * np.exp(1j * even) + shift * np.exp(1j * direction)
        return even + np.angle(pocket * np.exp(-1j * even))
    return even


@dataclass(frozen=True)
class RingMotion:
    """Prescribed motion of the ring as the core takes it."""

    table: Array  # as of `trbdyn.model.flatten.motion_table`, shape (K, 44)
    period: float  # after the last knot the last part of the table, this long, repeats (s); 0: everything stays
    start: float  # time of the start (s)
    angle_time: float  # when both angles are counted (s)
    shaft_angle: float  # angle of the shaft then (rad)
    outer_angle: float  # angle of the outer ring then (rad)

    def displacement(self, time: float) -> Array:
        """Where the ring stands at a time (s): translation (m), rotation (rad), shape (5,)."""
        times, first, last = self.table[:, 0], float(self.table[0, 0]), float(self.table[-1, 0])
        places = self.table[:, 1:11:2]
        if len(times) == 1:
            return places[0].copy()
        if self.period > 0.0 and time >= last:
            begin = last - self.period
            time = begin + (time - begin) % self.period
        if not first < time < last:
            return places[0 if time <= first else -1].copy()
        place = int(np.searchsorted(times, time, side="right"))
        ends = slice(place - 1, place + 1)
        curve = scipy.interpolate.CubicHermiteSpline(times[ends], places[ends], self.table[ends, 2:12:2])
        return np.asarray(curve(time), dtype=np.float64)

    @property
    def housing_load(self) -> Array:
        """What the support of a housing carries at the start (N, N m), shape (5,)."""
        names = [name for name, _, _ in _core.motion_table()]
        return self.table[0, [1 + 2 * names.index(name) for name in HOUSING_LOADS]]

    @property
    def prescribed(self) -> tuple[Array, float, float, float, float]:
        """What the core takes: table, period, a time and the angles of shaft and outer ring then."""
        return self.table, self.period, self.angle_time, self.shaft_angle, self.outer_angle

    def open(self, model: _core.Model, time: float, vector: Array) -> _core.Simulation:
        """The core's simulation of this motion alone, without settings, from a time (s) and state on."""
        return open_core([model], [self], time, vector, {})


def open_core(
    models: Sequence[_core.Model],
    motions: Sequence[RingMotion],
    time: float,
    vector: Array,
    settings: dict[str, float | str],
) -> _core.Simulation:
    """The core's simulation of bearings from a time (s) and state on; `InputError` if it cannot use the state or the settings."""
    try:
        return _core.Simulation(tuple(models), tuple(one.prescribed for one in motions), time, vector, settings)
    except ValueError as error:
        kind, text = settings.get("integrator", ""), str(error)
        of_integrator = text.removeprefix(f"integrator = '{kind}': ")
        if of_integrator == text:
            raise InputError.of("state", "given", text) from None
        raise InputError.of("integrator", kind, of_integrator) from None


def placed_again(model: _core.Model, scene: Scene, motion: RingMotion) -> str:
    """A sentence if the ring of a run from a state does not go on from where it stood, or may not; or nothing."""
    start, free = scene.start, ~np.array(scene.ring_is_placed)
    if start.kind != "state" or not free.any() or scene.ring == "free":
        return ""
    changes = not is_constant(scene.speed_rpm)
    if start.displacement is None:
        if scene.ring == "held" and changes:
            return (
                f"start.displacement is not given: the ring is held at the equilibrium at {start.time:g} s, while the run that "
                "this state is from may hold it at that of another speed; Start.state(simulation.state) has its place"
            )
        return ""
    arm = 0.5 * scene.bearing.pitch_diameter
    found = motion.displacement(start.time)
    if scene.ring == "held":
        try:
            found = EquilibriumSolver(model, scene, nominal_angles(scene)).solve(start.time).displacement
        except LoadError:
            return ""
    off = float(np.max(np.abs((found - start.displacement) * [1.0, 1.0, 1.0, arm, arm])[free]))
    if off <= (OTHER_SPEED if scene.ring == "held" and changes else SAME_PLACE):
        return ""
    what = (
        "the ring is held there all the same; without start.displacement it is in that equilibrium"
        if scene.ring == "held"
        else "the ring begins in that equilibrium, so that the forces on it jump"
    )
    return (
        f"start.displacement is {1e6 * off:.3g} um off the equilibrium under the load at {start.time:g} s, as if loads or "
        f"bearing had been changed: {what}"
    )


def housing_hold(scene: Scene, equilibrium: Equilibrium) -> dict[str, float]:
    """What the support of a housing carries at the start, by the names of the core's channels (N, N m).

    It is the load of the bearing in its equilibrium, and the weight of the housing; nothing without a housing. A run that begins
    in a state of another run has that run's.
    """
    if scene.housing is None:
        return {}
    if scene.start.housing_load is not None:
        return dict(zip(HOUSING_LOADS, scene.start.housing_load, strict=True))
    weight = scene.housing.mass * ring_load(scene, scene.start.time).gravity
    arm = scene.bearing.geometry.centre_plane + scene.housing.mass_offset
    turning = arm * np.array([-weight[1], weight[0]])
    held = -equilibrium.on_outer - np.concatenate([weight, turning])
    return dict(zip(HOUSING_LOADS, held.tolist(), strict=True))


def ring_motion(model: _core.Model, scene: Scene) -> tuple[RingMotion, Equilibrium]:
    """Prescribed motion of the ring as the core takes it, and the equilibrium at the start.

    The ring stands, or moves, where it is in equilibrium with evenly spaced rollers: rollers that start elsewhere do
    not shift it, as they pass through every place in turn. The rollers start in equilibrium with that ring where they
    stand.
    """
    scene.check_capacity()
    even, angles, time = nominal_angles(scene), start_angles(scene), scene.start.time
    stands = scene.start.displacement if scene.ring == "held" else None
    place = None if stands is None else np.where(scene.ring_is_placed, ring_load(scene, time).displacement, stands)
    if (
        scene.ring == "free" and scene.start.kind == "state"
    ):  # the state says where the ring is; nothing need hold it there
        place = np.zeros(5) if scene.start.displacement is None else np.array(scene.start.displacement)
    at_start = EquilibriumSolver(model, scene, even).solve(time, displacement=place)
    path: list[float | History] = list(at_start.displacement)
    joints: Array | None = None
    if scene.ring == "follows":
        path, joints = find_path(scene, EquilibriumSolver(normal_contacts(scene), scene, even), at_start)
    table = motion_table(scene, path, joints, housing_hold(scene, at_start))
    moves = len(table) > 1
    # a saved state of a shaft at constant speed: its angle is counted from t = 0, without any rounding
    from_zero = not moves and scene.start.kind == "state" and scene.start.shaft_angle is None
    motion = RingMotion(
        table=table,
        period=(scene.period or 0.0) if moves else 0.0,
        start=time,
        angle_time=0.0 if from_zero else time,
        shaft_angle=0.0 if from_zero else scene.start_shaft_angle,
        outer_angle=0.0 if from_zero or not scene.outer_turns else angle_turned(scene.outer_speed_rpm, 0.0, time),
    )
    if not np.array_equal(angles, even):
        at_start = EquilibriumSolver(model, scene, angles).solve(time, displacement=at_start.displacement)
    return motion, at_start
