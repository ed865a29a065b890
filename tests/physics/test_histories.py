"""Runs that go on from a state, quantities that repeat through any time, and curves that steps need not stop for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import trbdyn as trb
from trbdyn import Effects, History, RotatingLoad, Scene, Simulation, Start
from trbdyn.errors import TrbError
from trbdyn.model.motion import knot_table
from trbdyn.statics.plausible import UnusualInput

ROLLERS = Effects.standard().replace(bodies="rollers")

GOES_ON: dict[str, dict[str, Any]] = {
    "unbalance": {"rotating_load": RotatingLoad(500.0), "ring": "follows"},
    "load of its own frequency": {"rotating_load": RotatingLoad(500.0, frequency_hz=37.0), "ring": "follows"},
    "unbalance in a run-up that began before": {
        "rotating_load": RotatingLoad(500.0, turns=0.5),
        "speed_rpm": History.ramp(0, 0.02, 1000, 3000),
        "ring": "follows",
        "start": Start(time=-0.004),
    },
    "held ring in a run-up": {"speed_rpm": History.ramp(0, 0.02, 1000, 12000)},
}


def scene_of(**given: Any) -> Scene:
    return Scene(trb.cases.rig_30310(), **({"speed_rpm": 3000.0, "axial_load": 4930.0, "effects": ROLLERS} | given))


@pytest.mark.parametrize("name", GOES_ON)
def test_a_run_from_a_state_goes_on_with_its_loads_and_its_ring(name: str) -> None:
    """A rotating load began again at its first direction, -1580 N in place of +500; a held ring was placed again, 50 N off."""
    scene = scene_of(**GOES_ON[name])
    sim = Simulation(scene, accuracy="fast")
    sim.run(duration=0.013, save_every=1e-3)
    again = Simulation(scene.replace(start=Start.state(sim.state)), accuracy="fast")
    assert again.record()["ring_force"] == pytest.approx(sim.record()["ring_force"], abs=0.3)
    assert not again.warnings
    third = Simulation(again.scene.replace(start=Start.state(again.state)), accuracy="fast")
    assert third.record()["ring_force"] == pytest.approx(again.record()["ring_force"], abs=0.3)


def test_a_ring_that_does_not_go_on_is_said() -> None:
    scene = scene_of(**GOES_ON["held ring in a run-up"])
    sim = Simulation(scene, accuracy="fast")
    sim.run(duration=0.013, save_every=1e-3)
    state = sim.state
    with pytest.warns(UnusualInput, match=r"start\.displacement is not given"):
        Simulation(scene.replace(start=Start.state(state.vector, time=state.time, shaft_angle=state.shaft_angle)))
    with pytest.warns(UnusualInput, match=r"start\.displacement is [\d.]+ um off the equilibrium"):
        Simulation(scene.replace(speed_rpm=3000.0, axial_load=6000.0, start=Start.state(state)))
    with pytest.raises(trb.InputError, match=r"displacement .*belongs to a start from a state only"):
        Start(displacement=(0.0, 0.0, 0.0, 0.0, 0.0))


@settings(max_examples=8, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
@given(
    start=st.one_of(st.floats(-0.02, 0.0), st.floats(-1e-3, 1e-3), st.floats(1e5, 9e5)),
    frequency=st.sampled_from((37.0, 300.0, 1000.0)),
    phase=st.floats(-180.0, 180.0),
)
def test_what_repeats_goes_on_through_any_time(start: float, frequency: float, phase: float) -> None:
    """Stops were rounded at the start's precision: near t = 0 steps fell to 3e-18 s; beyond 1e5 s no period was found."""
    load = History.harmonic(4000.0, 500.0, frequency_hz=frequency, phase_deg=phase)
    sim = Simulation(scene_of(axial_load=load, ring="follows", start=Start(time=start)), accuracy="fast")
    duration = min(3.0 / frequency, 0.01) if start >= 0.0 else -start + 1e-3
    result = sim.run(duration=duration, save_every=duration / 4)
    assert result.success
    assert sim.statistics["smallest_step"] > 1e-12


def test_times_too_far_apart_are_bad_input() -> None:
    sim = Simulation(scene_of())
    with pytest.raises(TrbError):
        sim._seated.open(0.0, np.full(sim.state.vector.size, np.nan), {})


def test_knots_that_sample_a_smooth_curve_stop_no_step() -> None:
    wave = History.harmonic(3000.0, 500.0, frequency_hz=50.0)
    table = knot_table([wave], 0.0, 0.0, 0.02)
    assert table[table[:, -1] == 0.0, 0] == pytest.approx([0.0, 0.005, 0.01, 0.015, 0.02])
    given_points = History.table((0.0, 0.1, 0.2), (0.0, 1.0, 3.0))
    assert not knot_table([given_points]).T[-1].any()
    sim = Simulation(scene_of(rotating_load=RotatingLoad(14_000.0), ring="follows"), accuracy="fast")
    assert len(sim.bearings[0].motion.table) > 300
    assert np.count_nonzero(sim.bearings[0].motion.table[:, -1] == 0.0) < len(sim.bearings[0].motion.table) / 10


@pytest.mark.parametrize("integrator", ["erk", "bdf", "multirate"])
def test_a_step_ends_at_every_knot(integrator: str) -> None:
    """Where a load bends, whatever the method."""
    knots = (0.0, 2.1e-4, 2.5e-4, 7.3e-4)
    load = History.table(knots, (3000.0, 3000.0, 4000.0, 3500.0))
    sim = Simulation(scene_of(axial_load=load, ring="follows"), integrator=integrator)
    ends = [sim.time]
    while sim.time < 8e-4:
        sim.step()
        ends.append(sim.time)
    for knot in knots:
        assert np.min(np.abs(np.array(ends) - knot)) < 1e-12, knot


def test_a_load_that_turns_with_a_shaft_must_come_round_in_a_period() -> None:
    """The period is from the first to the last time of the speed, whatever the speed does between them."""
    speed = History.table((0.0, 0.1, 0.3, 0.4), (600.0, 1200.0, 1200.0, 600.0)).replace(repeats=True)
    mean = 600.0 + 600.0 * 0.75
    whole = 60.0 / (0.4 * mean)
    about = {"speed_rpm": speed, "ring": "follows"}
    scene = scene_of(**about, rotating_load=RotatingLoad(100.0, turns=3.0 * whole))
    assert scene.period == pytest.approx(0.4)
    with pytest.raises(trb.InputError, match="must turn a whole number of times in a period"):
        scene_of(**about, rotating_load=RotatingLoad(100.0, turns=3.3 * whole)).period  # noqa: B018


def test_a_history_with_slopes_at_its_ends_is_constant_outside() -> None:
    """Its kink was rounded off: between the start and its first time the curve dipped below its first value."""
    kinked = History(times=(1.0, 2.0), values=(0.0, 1.0), slopes=(1.0, 1.0))
    table = knot_table([kinked, History.ramp(0.0, 3.0, 0.0, 1.0)])
    assert table[:, 0] == pytest.approx([0.0, 1.0, 1.0, 2.0, 2.0, 3.0])
    assert table[:, 2] == pytest.approx([0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
    sim = Simulation(
        scene_of(gravity=(0.0, History(times=(0.01, 0.02), values=(0.0, -9.8), slopes=(-980.0, -980.0)), 0.0))
    )
    assert sim.run(duration=0.03, save_every=1e-3).success


@pytest.mark.parametrize(("times", "named"), [((0.0, 2e6), 1), ((-2e6, 0.0), 0), ((-3e6, 0.0, 2e6), 0)])
def test_times_beyond_the_longest_run_are_refused(times: tuple[float, ...], named: int) -> None:
    """The error names the time that lies farthest."""
    with pytest.raises(trb.InputError, match=rf"times\[{named}\].* must be from -1e\+06 to 1e\+06 \(s\)"):
        History.table(times, [1.0] * len(times))


class TestSteps:
    def test_a_step_takes_a_stated_time(self) -> None:
        drop = History.step((0.1, 0.12), (3000.0, 300.0, 3000.0))
        assert drop.times == pytest.approx((0.1, 0.101, 0.12, 0.121))
        assert drop.value([0.0, 0.1, 0.1005, 0.101, 0.11, 0.12, 0.2]) == pytest.approx(
            [3000.0, 3000.0, 1650.0, 300.0, 300.0, 300.0, 3000.0]
        )
        assert History.step(1.0, (0.0, 5.0), rise=0.1).times == pytest.approx((1.0, 1.1))
        with pytest.raises(trb.InputError, match=r"rise = 0\.0 : must be > 0"):
            History.step(1.0, (0.0, 5.0), rise=0.0)
        with pytest.raises(trb.InputError, match="one entry more than times, 2"):
            History.step(1.0, (0.0, 5.0, 1.0))
        with pytest.raises(trb.InputError, match="must be later than the time before it"):
            History.step((1.0, 1.0005), (0.0, 5.0, 1.0))

    def test_a_load_may_drop_to_zero(self) -> None:
        """The ring goes back to where rollers and rings just touch, and no further; the path has no jump."""
        load = History.step((0.004, 0.012), (3000.0, 0.0, 3000.0))
        scene = scene_of(axial_load=load, ring="follows", unloaded="rests")
        sim = Simulation(scene, accuracy="fast")
        place = sim.bearings[0].motion.table[:, 5]
        assert -4e-7 < place.max() < -2e-7  # the rollers' centrifugal forces press them this far into the cup
        result = sim.run(duration=0.02, save_every=2e-4)
        force, time = np.asarray(result["ring_force"])[:, 2], np.asarray(result["time"])
        assert force[(time > 0.007) & (time < 0.012)].mean() == pytest.approx(47.0, abs=30.0)
        assert force[time > 0.016].mean() == pytest.approx(3000.0, rel=0.01)
        with pytest.raises(trb.InputError, match="unless unloaded = 'rests'"):
            scene.replace(unloaded="refused")

    def test_what_holds_the_ring_carries_the_rest(self) -> None:
        sim = Simulation(scene_of(axial_load=0.0, radial_load=2000.0, unloaded="rests"), accuracy="fast")
        force = np.asarray(sim.record()["ring_force"])
        assert force[1] == pytest.approx(-2000.0, rel=0.01)
        assert force[2] > 300.0
        held = Simulation(scene_of(unloaded="rests")).equilibrium
        assert held.displacement == pytest.approx(Simulation(scene_of()).equilibrium.displacement, abs=1e-12)
        with pytest.raises(trb.InputError, match="must be 'refused' where displacement gives the axial position"):
            scene_of(axial_load=0.0, displacement=(None, None, -1e-5), unloaded="rests")
