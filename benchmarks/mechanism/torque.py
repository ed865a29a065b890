"""Friction torque of the 32216 against measurements."""

from __future__ import annotations

import time as clock
from typing import Any

import numpy as np

import trbdyn as trb

TURNS = 6.0
"""Turns of the shaft; the last half counts."""
AXIAL_LOAD = 6000.0


def run(speed_rpm: float, pressure_force: bool, turns: float = TURNS) -> dict[str, Any]:
    """Mean torques on both rings in one run (N m), the scatter of the inner one, and its shares."""
    effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=8, rolling_pressure_force=pressure_force)
    scene = trb.cases.scene_32216(speed_rpm, AXIAL_LOAD, effects=effects)
    began = clock.process_time()
    result = trb.Simulation(scene).run(
        duration=60.0 * turns / speed_rpm, save_every=0.15 / speed_rpm, save_groups=("torque",)
    )
    last = result.window(0.5 * result.final_time)
    first, second = np.array_split(last["inner_torque"], 2)
    return {
        "speed_rpm": speed_rpm,
        "pressure_force": pressure_force,
        "inner_torque": float(last["inner_torque"].mean()),
        "outer_torque": float(last["outer_torque"].mean()),
        "drift": float(second.mean() - first.mean()),
        "shares": last.torque_split,
        "cpu": clock.process_time() - began,
    }
