"""With friction rollers and cage run at the speeds of pure rolling, either way round and after a run-up from rest."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from trbdyn import Effects, History, Result

CAGE_RATIO, SPIN_RATIO = 0.41662, 2.8606
"""Check values: sin(alpha_i)/(sin(alpha_i) + sin(alpha_o)), and the roller's spin in the cage's frame, over the shaft's speed."""
PRESETS = {"paper": Effects.paper(), "standard": Effects.standard()}


def spin_ratio(result: Result) -> float:
    """Spin of the rollers relative to their orbit, over the shaft's speed; negative: the roller turns against the shaft."""
    return float(np.mean(result.roller_spin_speed / result.shaft_speed[:, None]))


@pytest.mark.parametrize("effects", PRESETS.values(), ids=PRESETS)
@pytest.mark.parametrize("speed", [3000.0, -3000.0])
def test_kinematic_speeds(kit: SimpleNamespace, effects: Effects, speed: float) -> None:
    sim = kit.simulate(effects, scenery={"speed_rpm": speed})
    result = sim.run(revolutions=4.0)
    assert result.success
    assert result.cage_speed_ratio == pytest.approx(CAGE_RATIO, rel=5e-3)
    assert spin_ratio(result) == pytest.approx(-SPIN_RATIO, rel=1e-3)
    orbit = np.diff(result.roller_orbit_angle[[0, -1]], axis=0) / (result.shaft_angle[-1] - result.shaft_angle[0])
    np.testing.assert_allclose(orbit, CAGE_RATIO, rtol=5e-3)
    assert np.abs(result.roller_slip[-1]).max() < 5e-3


def test_slip_without_friction_stays_what_it_was(kit: SimpleNamespace) -> None:
    """Nothing but friction brings a roller to its rolling speed."""
    spins = []
    for effects in (Effects.frictionless(), Effects.paper()):
        sim = kit.simulate(effects.replace(bodies="rollers", gravity=False), **kit.tolerances(1e-5))
        vector = sim.state.vector
        sim.view(vector)["roller_omega_a"] += 50.0
        sim.set_state(vector)
        spins.append(sim.run(duration=2e-3, save_every=1e-4).spin_slip)
    start = spins[0][0]
    assert np.abs(start).min() > 0.04
    np.testing.assert_allclose(spins[0][-1], start, rtol=1e-6)
    assert np.abs(spins[1][-1]).max() < 0.02 * np.abs(start).max()


@pytest.mark.parametrize("effects", PRESETS.values(), ids=PRESETS)
@pytest.mark.parametrize("end", [3000.0, -3000.0])
def test_run_up_from_rest(kit: SimpleNamespace, effects: Effects, end: float) -> None:
    sim = kit.simulate(effects, scenery={"speed_rpm": History.ramp(0.0, 0.04, 0.0, end)})
    result = sim.run(duration=0.06, save_every=5e-4)
    assert result.success
    for field in result.fields:
        assert np.isfinite(result[field.name]).all(), field.name
    assert result.shaft_speed[0] == 0.0
    late = result.window(0.045)
    np.testing.assert_allclose(late.shaft_speed, end * np.pi / 30.0, rtol=1e-12)
    assert late.cage_speed_ratio == pytest.approx(CAGE_RATIO, rel=5e-3)
    assert spin_ratio(late) == pytest.approx(-SPIN_RATIO, rel=1e-3)
    # a half turn of the ramp and the turns after it: the mean speed of a smooth ramp is half its end
    assert result.shaft_angle[-1] == pytest.approx(end * np.pi / 30.0 * (0.02 + 0.02), rel=1e-9)


def test_bearing_at_rest_stays(kit: SimpleNamespace) -> None:
    """Without speed and gravity nothing begins to turn."""
    sim = kit.simulate(Effects.paper().replace(gravity=False), scenery={"speed_rpm": 0.0})
    result = sim.run(duration=5e-3)
    assert np.abs(result.cage_angle).max() < 1e-9
    assert np.abs(result.roller_orbit_speed).max() < 1e-6
    np.testing.assert_allclose(
        result.outer_load, sim.equilibrium.outer_load[None, :].repeat(len(result), axis=0), rtol=1e-6
    )
