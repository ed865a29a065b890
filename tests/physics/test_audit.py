"""The energy audit closes: every term is an integral of its own, and what they leave is the integrator's error."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trbdyn import Effects, History, Result
from trbdyn.model.scene import Start

LOSSES = (
    "traction_outer",
    "traction_inner",
    "rolling",
    "rolling_pressure",
    "rib",
    "front_rib",
    "pocket",
    "damping",
)
END = 8e-3
FOLLOWING = {
    "ring": "follows",
    "axial_load": History.ramp(0.0, END, 4000.0, 6000.0),
    "radial_load": History.table([0.0, END / 2, END], [0.0, 3000.0, 1000.0]),
    "misalignment_x": History.ramp(0.0, END, 0.0, 5e-4),
}
MOVED = {
    "displacement": (
        History.ramp(0.0, END, 0.0, 1e-5),
        History.table([0.0, END / 2, END], [0.0, 8e-6, -3e-6]),
        History.ramp(0.0, END, -2e-5, -3e-5),
    ),
    "misalignment_y": History.ramp(0.0, END, 3e-4, -3e-4),
}
PAPER, STANDARD = Effects.paper(), Effects.standard()
CASES: dict[str, tuple[Effects, dict[str, Any]]] = {
    "paper": (PAPER, {}),
    "standard": (STANDARD, {}),
    "whirl": (STANDARD, {"start": Start.whirl()}),
    "ring_follows_load": (STANDARD, FOLLOWING),
    "ring_displaced": (STANDARD, MOVED),
    "planar": (PAPER.replace(planar=True), {}),
    "damped": (PAPER.replace(damping="hunt_crossley", damping_race=1.0, damping_cage=2.0), {}),
    "dry": (PAPER.replace(lubrication="dry"), {}),
    "boundary": (PAPER.replace(lubrication="boundary"), {}),
    "minimal": (Effects.minimal(), {}),
    "run_up": (STANDARD, {"speed_rpm": History.ramp(0.0, END, 1000.0, 4000.0)}),
    "backwards": (STANDARD, {"speed_rpm": -3000.0}),
}


def run(kit: SimpleNamespace, case: str, rtol: float, **options: Any) -> Result:
    """A cage thrown gently at its rollers, so that every pocket face works."""
    effects, scenery = CASES[case]
    sim = kit.simulate(effects, scenery=scenery, **(kit.tolerances(rtol) | options))
    vector = sim.state.vector
    state = sim.view(vector)
    state["cage_v_x"] += 0.3
    state["cage_v_y"] -= 0.2
    state["cage_v_z"] += 0.0 if effects.planar else 0.1
    sim.set_state(vector)
    return sim.run(duration=END, save_every=1e-4)


def closure(result: Result) -> float:
    """Largest residual at any time over the dissipated work."""
    return float(np.abs(result.energy_balance["residual"]).max()) / result.energy_audit.dissipated


LONG = {"paper", "whirl", "ring_displaced", "planar", "dry", "boundary", "run_up"}


@pytest.mark.parametrize(
    "case", [pytest.param(name, marks=pytest.mark.slow) if name in LONG else name for name in CASES]
)
def test_closure_falls_with_the_tolerance(kit: SimpleNamespace, case: str) -> None:
    loose, tight = (run(kit, case, rtol) for rtol in (1e-4, 1e-6))
    assert loose.pocket_force.max() > 10.0
    assert closure(tight) < 1e-4
    assert closure(loose) < 5e-3
    # what is as small with loose tolerances has no need to fall; without friction the closures scatter by a factor of 3
    assert closure(tight) < max(0.1 * closure(loose), 3e-6)


@pytest.mark.parametrize("case", ["paper", "standard", "whirl", "ring_follows_load"])
def test_presets_close_at_standard_accuracy(kit: SimpleNamespace, case: str) -> None:
    effects, scenery = CASES[case]
    result = kit.simulate(effects, scenery=scenery).run(duration=0.04)
    assert result.energy_audit.dissipated > 1.0
    assert closure(result) < 1e-3
    assert result.energy_closure <= closure(result)


@pytest.mark.parametrize("integrator", ["erk", "multirate"])
def test_other_methods_close(kit: SimpleNamespace, integrator: str) -> None:
    assert closure(run(kit, "standard", 1e-5, integrator=integrator)) < 1e-4


def test_work_of_a_moving_ring_is_in_the_balance(kit: SimpleNamespace) -> None:
    """Without it the audit would be off by many times its residual; it is the ring's force along its path."""
    result = run(kit, "ring_displaced", 1e-5)
    work = result.work_ring - result.work_ring[0]
    assert abs(work[-1]) > 100.0 * np.abs(result.energy_balance["residual"]).max()
    scene = result.scene
    path = np.array([history.value(result.time) for history in scene.displacement]).T
    np.testing.assert_allclose(result.ring_position, path, atol=1e-12)
    velocity = np.array([history.slope(result.time) for history in scene.displacement]).T
    turning = scene.misalignment_y.slope(result.time)
    power = -np.sum(result.ring_force * velocity, axis=1) - result.ring_moment[:, 1] * turning
    expected = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(result.time))])
    np.testing.assert_allclose(work, expected, atol=5e-3 * np.abs(work).max())


def test_shaft_power_is_torque_times_speed(kit: SimpleNamespace) -> None:
    """At instants, and integrated over a run whose speed changes."""
    result = run(kit, "run_up", 1e-5)
    power = result.inner_torque * result.shaft_speed
    expected = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(result.time))])
    np.testing.assert_allclose(result.work_shaft, expected, atol=5e-3 * result.work_shaft[-1])
    sim = kit.simulate(STANDARD)
    for seed in range(3):
        vector = kit.perturbed(sim, seed)
        record = sim.record(vector)
        shaft = sim.view(sim.derivative(vector))["quadratures"][0]
        assert shaft == pytest.approx(float(record["inner_torque"] * record["shaft_speed"]), rel=1e-10)


def test_losses_are_minus_the_power_of_all_contact_forces(kit: SimpleNamespace) -> None:
    """At random states: work put in less the growth of kinetic and elastic energy, by differences, is the power of the losses."""
    sim = kit.simulate(STANDARD.replace(film_damping=1e-4, damping_cage=2.0), scenery={"radial_load": 2000.0})
    for seed in range(3):
        vector = kit.perturbed(sim, 60 + seed)
        rates, step = sim.derivative(vector), 1e-9
        up, down = (sim.record(vector + sign * step * rates, sign * step) for sign in (1.0, -1.0))
        growth = sum((up[name] - down[name]) / (2.0 * step) for name in ("kinetic_energy", "elastic_energy"))
        put_in = sum(
            float((up[name] - down[name]) / (2.0 * step)) for name in ("work_shaft", "work_ring", "work_gravity")
        )
        lost = float(sim.record(vector)["power_loss"])
        assert lost > 0.0
        parts = [float(sim.record(vector)[f"power_{name}"]) for name in LOSSES]
        assert lost == pytest.approx(sum(parts), rel=1e-12)
        size = abs(put_in) + abs(lost) + abs(float((up["elastic_energy"] - down["elastic_energy"]) / (2.0 * step)))
        assert put_in - float(growth) == pytest.approx(lost, abs=1e-5 * size)


@pytest.mark.parametrize(("case", "share"), [("standard", 0.0), ("standard", 0.1), ("damped", 0.1), ("dry", 0.1)])
def test_every_loss_is_a_loss(kit: SimpleNamespace, case: str, share: float) -> None:
    """Sliding friction and damping only ever take energy, tangents or not."""
    result = run(kit, case, 1e-4, rings_share=share)
    there = {field.name for field in result.fields}
    losses = [
        name
        for name in ("traction_outer", "traction_inner", "rib", "front_rib", "pocket", "damping")
        if f"loss_{name}" in there
    ]
    assert {"traction_outer", "traction_inner", "rib", "pocket"} <= set(losses)
    for name in losses:
        assert result[f"power_{name}"].min() >= 0.0, name
        assert np.diff(result[f"loss_{name}"]).min() >= -1e-12, name


def test_without_friction_nothing_is_lost(kit: SimpleNamespace) -> None:
    result = kit.simulate(Effects.frictionless()).run(duration=2e-3)
    for name in [field.name for field in result.fields if field.name.startswith("loss_")]:
        assert not result[name].any(), name
    assert not result.power_loss.any()
    # normal forces of a round ring have no moment about its axis
    assert np.abs(result.inner_torque).max() < 1e-9
    assert np.abs(result.work_shaft).max() < 1e-9


def unloaded_within(kit: SimpleNamespace, within: float, effects: Effects) -> Result:
    """The load falls to 1 % and comes back, each within a time (s)."""
    load = History.table([0.0, 2e-3, 2e-3 + within, 4e-3, 4e-3 + within], [4930.0, 4930.0, 49.3, 49.3, 4930.0])
    return kit.simulate(effects, scenery={"ring": "follows", "axial_load": load}).run(duration=6e-3)


SUDDEN = [
    pytest.param(effects, within, marks=pytest.mark.slow)
    for effects in (PAPER, STANDARD)
    for within in (1e-5, 1e-6, 1e-8)
]
SUDDEN += [pytest.param(PAPER, 1e-9, marks=pytest.mark.slow), pytest.param(STANDARD, 1e-9)]
"""Effects, and times in which the load falls and comes back (s)."""


@pytest.mark.parametrize(("effects", "within"), SUDDEN)
def test_the_work_of_a_sudden_load_is_in_the_balance(kit: SimpleNamespace, within: float, effects: Effects) -> None:
    """However sudden: no step passes over it."""
    result = unloaded_within(kit, within, effects)
    assert result.energy_audit.work["ring"] > 1.0
    assert closure(result) < 1e-2


@pytest.mark.parametrize(("integrator", "within"), [("bdf", 2e-3), ("erk", 2e-3), ("multirate", 4e-3)])
def test_a_shock_between_two_steps_is_not_missed(kit: SimpleNamespace, integrator: str, within: float) -> None:
    """A cage that falls freely has the impulse of a shock far shorter than a step, to two tolerances of its velocity."""
    effects = Effects.frictionless().replace(pocket_bars=False, pocket_ends=False)
    width, height = 1e-8, 1e6
    pulse = [0.0, 0.0, height, 0.0, 0.0]
    times = [0.0, 1e-3, 1e-3 + width, 1e-3 + 2 * width, 2e-3]
    gravity = (0.0, History.table(times, pulse), 0.0)
    sim = kit.simulate(effects, scenery={"gravity": gravity}, integrator=integrator, accuracy="reference")
    result = sim.run(duration=1.5e-3)
    assert float(result.cage_velocity[-1, 1]) == pytest.approx(width * height, rel=within)
