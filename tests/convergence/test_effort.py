"""What a run costs in steps, iterations and evaluations: a fault in the solver, its tangents or its Jacobian costs effort first.

The results stay right, because error tests and the test of Newton's method refuse what is wrong; only the effort tells. The
numbers were measured: the middle of four instruction sets. A solver that became better moves them, too: measure again.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects, Result, Simulation

EFFECTS = Effects.paper().replace(quadrature="gauss", n_slices=8)
WHIRL: dict[str, Any] = {"start": trb.Start.whirl(0.9)}
TILTED: dict[str, Any] = {"radial_load": 2000.0, "misalignment_x": 2e-4}


def tolerances(rtol: float) -> dict[str, float]:
    """Given as numbers, so that other presets do not change what is measured here."""
    parts = {"atol_position": 3e-7, "atol_angle": 3e-5, "atol_velocity": 0.1, "atol_spin": 10.0}
    return {"rtol": rtol} | {name: part * rtol for name, part in parts.items()}


USUAL = tolerances(1e-3) | {"integrator": "bdf", "rings_share": 0.1}
TIGHT = tolerances(1e-4) | {"integrator": "bdf", "rings_share": 0.03}


def run(duration: float, scenery: dict[str, Any], options: dict[str, Any]) -> Result:
    given = {"bearing": trb.cases.rig_30310(), "speed_rpm": 3000.0, "axial_load": 4930.0, "effects": EFFECTS}
    return Simulation(trb.Scene(**(given | scenery)), **options).run(duration=duration)


MEASURED: dict[str, tuple[float, dict[str, Any], dict[str, Any], dict[str, float]]] = {
    "whirl": (
        0.02,
        WHIRL,
        USUAL,
        {"steps": 1152, "iterations": 2.129, "setups": 156, "jacobians": 78, "refused": 40, "tangents": 0.968},
    ),
    "tilted ring": (
        0.02,
        TILTED,
        USUAL,
        {"steps": 945, "iterations": 2.133, "setups": 141, "jacobians": 73, "refused": 32, "tangents": 0.871},
    ),
    "exact forces": (
        0.02,
        WHIRL,
        USUAL | {"rings_share": 0.0},
        {"steps": 1138, "iterations": 2.135, "setups": 159, "jacobians": 78, "refused": 41, "tangents": 0.0},
    ),
    "tight tolerances": (
        0.01,
        WHIRL,
        TIGHT,
        {"steps": 3138, "iterations": 2.017, "setups": 209, "jacobians": 164, "refused": 22, "tangents": 0.984},
    ),
    "radial load, backwards": (
        0.02,
        {"speed_rpm": -3000.0, "radial_load": 4000.0},
        USUAL,
        {"steps": 794, "iterations": 2.155, "setups": 125, "jacobians": 60, "refused": 25, "tangents": 0.853},
    ),
    "speed that turns back": (
        0.012,
        {"speed_rpm": trb.History.ramp(0.0, 0.01, -2000.0, 2000.0), "effects": Effects.standard()},
        USUAL,
        {"steps": 1483, "iterations": 2.213, "setups": 156, "jacobians": 98, "refused": 23, "tangents": 0.046},
    ),
    "explicit": (
        0.002,
        WHIRL,
        USUAL | {"integrator": "erk"},
        {"steps": 265, "iterations": 0.0, "setups": 0, "jacobians": 0, "refused": 126, "tangents": 0.0},
    ),
}
OFF = {"steps": 0.08, "iterations": 0.06, "setups": 0.12, "jacobians": 0.25, "refused": 0.4}
"""Share by which each may be off; instruction sets differ from these numbers by about half of it at most."""


@pytest.mark.parametrize("name", MEASURED)
def test_a_run_costs_what_it_did(name: str) -> None:
    duration, scenery, options, wanted = MEASURED[name]
    result = run(duration, scenery, options)
    stats, counters = result.stats, result.counters
    found = {
        "steps": stats["steps"],
        "iterations": stats["nonlinear_iterations"] / stats["steps"],
        "setups": stats["linear_setups"],
        "jacobians": stats["jacobian_evaluations"],
        "refused": stats["error_failures"],
    }
    for quantity, share in OFF.items():
        assert found[quantity] == pytest.approx(wanted[quantity], rel=share), (quantity, found)
    rollers = 12 * counters["force_evaluations"]
    assert counters["tangent_rollers"] / rollers == pytest.approx(wanted["tangents"], abs=0.04)
    assert stats["nonlinear_failures"] <= 0.02 * stats["steps"]
    assert counters["force_evaluations"] == stats["rhs_evaluations"]


@pytest.mark.parametrize("integrator", ["bdf", "erk", "multirate"])
def test_the_smallest_step_is_the_smallest(integrator: str) -> None:
    scene = trb.cases.scene_30310(3000.0, 4930.0, effects=trb.Effects.paper().replace(n_slices=4))
    simulation = trb.Simulation(scene, integrator=integrator, first_step=1e-10)
    times = [0.0, *(simulation.step() for _ in range(60))]
    steps = np.diff(times)
    assert simulation.statistics["smallest_step"] == pytest.approx(steps.min(), rel=1e-6)
    assert simulation.statistics["last_step"] == pytest.approx(steps[-1], rel=1e-6)
    assert steps.min() < 0.1 * steps.max()


def test_slopes_serve_several_solves_while_a_load_changes() -> None:
    """Where every solve takes new slopes, these cost three quarters of the time of such runs.

    Here a step of a body takes 0.75 factorisations.
    """
    load = trb.History.ramp(0.0, 4e-3, 4930.0, 1500.0)
    scenery = {"axial_load": load, "ring": "follows", "effects": Effects.standard()}
    stats = run(4e-3, scenery, {"integrator": "multirate"}).stats
    assert stats["body_steps"] > 500
    assert stats["linear_setups"] < 0.3 * stats["body_steps"]
