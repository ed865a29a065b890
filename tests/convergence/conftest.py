"""Scenes and tolerances that the tests of convergence share."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from shared import tolerances

import trbdyn as trb
from trbdyn import Effects, Simulation

THROWN = {"v_x": 0.4, "v_y": -0.3, "v_z": 0.05, "omega_n": 5.0, "omega_t": -4.0}
"""Velocities that are added to the cage's (m/s, rad/s)."""


def simulate(effects: Effects | None = None, *, scenery: dict[str, Any] | None = None, **options: Any) -> Simulation:
    """The 30310 at 3000 rpm and 4930 N."""
    given = {"bearing": trb.cases.rig_30310(), "speed_rpm": 3000.0, "axial_load": 4930.0}
    return Simulation(trb.Scene(**(given | {"effects": effects or Effects.paper()} | (scenery or {}))), **options)


def throw(sim: Simulation, share: float = 1.0) -> None:
    """Throw the cage at its rollers."""
    vector = sim.state.vector
    for name, value in THROWN.items():
        sim.view(vector)[f"cage_{name}"] += share * value
    sim.set_state(vector)


def tilted_state(sim: Simulation, tilt: float) -> NDArray[np.float64]:
    """The present state with skewed and tilted rollers."""
    vector = sim.state.vector
    state = sim.view(vector)
    state["roller_tilt"] += tilt
    state["roller_skew"] += 1e-3
    return vector


@pytest.fixture(scope="session")
def kit() -> SimpleNamespace:
    """The functions of this file."""
    return SimpleNamespace(simulate=simulate, throw=throw, tolerances=tolerances, tilted_state=tilted_state)
