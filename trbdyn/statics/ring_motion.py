"""Motion of the inner ring as the core takes it: at rest in its equilibrium, or along the path of its equilibria."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.model.flatten import motion_table
from trbdyn.model.motion import History
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import Equilibrium, EquilibriumSolver, nominal_angles
from trbdyn.statics.ring_path import find_path

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene

Array = NDArray[np.float64]


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
    """Prescribed motion of the ring as the core takes it.

    Attributes
    ----------
    table : ndarray, shape (K, 19)
        Knot time, then value and slope of each channel of `_core.motion_table()`.
    period : float
        After the last knot the last part of the table, this long, repeats (s); 0: everything stays.
    start : float
        Time of the start (s).
    angle_time, shaft_angle : float
        A time (s), and the angle of the shaft then (rad).
    """

    table: Array
    period: float
    start: float
    angle_time: float
    shaft_angle: float

    def open(
        self, model: _core.Model, time: float, vector: Array, settings: dict[str, float | str]
    ) -> _core.Simulation:
        """The core's simulation of this motion from a time (s) and state on."""
        return _core.Simulation(
            model,
            self.table,
            time,
            vector,
            settings,
            period=self.period,
            angle_time=self.angle_time,
            angle=self.shaft_angle,
        )


def ring_motion(model: _core.Model, scene: Scene) -> tuple[RingMotion, Equilibrium]:
    """Prescribed motion of the ring as the core takes it, and the equilibrium at the start.

    The ring stands, or moves, where it is in equilibrium with evenly spaced rollers: rollers that start elsewhere do
    not shift it, as they pass through every place in turn. The rollers start in equilibrium with that ring where they
    stand.

    Raises
    ------
    LoadError
        If the bearing cannot carry the load.
    """
    even, angles, time = nominal_angles(scene), start_angles(scene), scene.start.time
    at_start = EquilibriumSolver(model, scene, even).solve(time)
    path: list[float | History] = list(at_start.displacement)
    if scene.ring == "follows":
        path = find_path(scene, EquilibriumSolver(normal_contacts(scene), scene, even), at_start)
    table = motion_table(scene, path)
    moves = len(table) > 1
    # a saved state of a shaft at constant speed: its angle is counted from t = 0, without any rounding
    from_zero = not moves and scene.start.kind == "state" and scene.start.shaft_angle is None
    motion = RingMotion(
        table=table,
        period=(scene.period or 0.0) if moves else 0.0,
        start=time,
        angle_time=0.0 if from_zero else time,
        shaft_angle=0.0 if from_zero else scene.start_shaft_angle,
    )
    if not np.array_equal(angles, even):
        at_start = EquilibriumSolver(model, scene, angles).solve(time, displacement=at_start.displacement)
    return motion, at_start
