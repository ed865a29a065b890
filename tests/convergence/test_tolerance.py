"""Trajectories converge with the tolerance, and the implicit and the explicit method converge to the same one."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trbdyn import Effects, Result

CASES = {"rolling": (Effects.standard(), 0.0, 2e-3), "colliding": (Effects.paper(), 1.0, 8e-4)}
"""Effects, how hard the cage is thrown, how long."""
TRUTH = 1e-9


def trajectory(kit: SimpleNamespace, case: str, rtol: float, **options: Any) -> Result:
    effects, share, duration = CASES[case]
    sim = kit.simulate(effects, **options, **kit.tolerances(rtol))
    if share:
        kit.throw(sim, share)
    return sim.run(duration=duration, save_every=duration / 40)


@pytest.fixture(scope="module", params=list(CASES))
def truth(request: pytest.FixtureRequest, kit: SimpleNamespace) -> tuple[str, Result]:
    """The explicit method at a tolerance far below those under test."""
    return request.param, trajectory(kit, request.param, TRUTH, integrator="erk")


def errors(result: Result, truth: Result) -> dict[str, float]:
    """Largest difference over the run, in units in which 1 matters: plays of a cage, its speed, a roller's load."""
    return {
        "cage_position": float(np.abs(result.cage_position - truth.cage_position).max()) / 0.25e-3,
        "cage_velocity": float(np.abs(result.cage_velocity - truth.cage_velocity).max()) / 0.1,
        "cage_tilt": float(np.abs(result.cage_tilt - truth.cage_tilt).max()) / 1e-3,
        "roller_orbit_angle": float(np.abs(result.roller_orbit_angle - truth.roller_orbit_angle).max()) / 3e-3,
    }


def test_runs_are_what_they_are_called(truth: tuple[str, Result]) -> None:
    case, result = truth
    assert (result.pocket_force.max() > 100.0) == (case == "colliding")


@pytest.mark.parametrize("integrator", ["bdf", pytest.param("multirate", marks=pytest.mark.slow)])
def test_implicit_method_converges_to_the_explicit_one(
    kit: SimpleNamespace, truth: tuple[str, Result], integrator: str
) -> None:
    case, exact = truth
    found = {rtol: errors(trajectory(kit, case, rtol, integrator=integrator), exact) for rtol in (1e-4, 1e-5, 1e-7)}
    for name in found[1e-4]:
        assert found[1e-4][name] < 5e-2, name
        assert found[1e-5][name] < 1e-2, name
        assert found[1e-7][name] < 1e-3, name
        assert found[1e-7][name] < 0.1 * found[1e-4][name], name


def test_explicit_method_converges(kit: SimpleNamespace, truth: tuple[str, Result]) -> None:
    """Stability holds its steps down at loose tolerances, so that its error falls late."""
    case, exact = truth
    found = {rtol: errors(trajectory(kit, case, rtol, integrator="erk"), exact) for rtol in (1e-5, 1e-8)}
    for name in found[1e-5]:
        assert found[1e-5][name] < 1e-2, name
        assert found[1e-8][name] < 1e-4, name
        assert found[1e-8][name] < 0.5 * found[1e-5][name], name


def test_higher_order_reaches_the_same(kit: SimpleNamespace, truth: tuple[str, Result]) -> None:
    case, exact = truth
    found = errors(trajectory(kit, case, 1e-7, max_order=5), exact)
    for name, error in found.items():
        assert error < 5e-3, name


def test_largest_step_is_kept(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.standard(), max_step=2e-6)
    times = np.array([sim.time] + [sim.step() for _ in range(200)])
    assert np.diff(times).max() <= 2e-6 * (1.0 + 1e-12)


def test_first_step_is_taken(kit: SimpleNamespace) -> None:
    for integrator in ("bdf", "erk", "multirate"):
        sim = kit.simulate(Effects.standard(), first_step=1e-9, integrator=integrator)
        assert sim.step() == pytest.approx(1e-9, rel=1e-12)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("integrator", ["bdf", "erk", "multirate"])
def test_tight_tolerances_start(kit: SimpleNamespace, integrator: str, seed: int) -> None:
    """SUNDIALS bounds its guess of the first step by a tenth of tolerance over rate: 1e-16 s where a coordinate near zero moves
    at a metre a second. It is no failure, and the steps grow from there."""
    sim = kit.simulate(Effects.frictionless(), integrator=integrator, **kit.tolerances(1e-10))
    random, vector = np.random.default_rng(seed), sim.state.vector
    state = sim.view(vector)
    for names, size in (
        (("v_x", "v_y", "v_z"), 2.0),
        (("omega_n", "omega_t", "omega_a"), 60.0),
        (("skew", "tilt"), 4e-3),
    ):
        for name in names:
            state[f"cage_{name}"] += random.uniform(-size, size)
    state["cage_z"] += random.uniform(0.0, 2e-4)
    sim.set_state(vector)
    for _ in range(24):
        sim.step()
    assert sim.time > 1e-8
