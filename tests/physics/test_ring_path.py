"""A ring that follows its load lies at the equilibria, between their times too, whatever turns or repeats; the start
belongs to its own time."""

from __future__ import annotations

import math
import re
import time as clock
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import trbdyn as trb
from trbdyn import Effects, History, InputError, LoadError, RotatingLoad, Simulation, Start
from trbdyn.model.cases import paper_30310
from trbdyn.statics.equilibrium import EquilibriumSolver, least_axial_load, most_radial_load, nominal_angles
from trbdyn.statics.ring_path import PATH_TOLERANCE

TURNS = {
    "load turned eight times": (
        {"radial_load": 2000.0, "radial_direction_deg": History.ramp(0, 0.06, 90, 90 + 8 * 360)},
        0.07,
    ),
    "load turned twice": (
        {"radial_load": 5530.0, "radial_direction_deg": History.ramp(0, 0.02, 90, 90 + 2 * 360)},
        0.025,
    ),
    "load turned back": ({"radial_load": 5530.0, "radial_direction_deg": History.ramp(-0.01, 0.02, 720, 0)}, 0.025),
    "unbalance": ({"radial_load": 1000.0, "rotating_load": RotatingLoad(500.0)}, 3.0),
    "unbalance in a run-up": (
        {"speed_rpm": History.ramp(0, 0.05, 1000, 3000), "rotating_load": RotatingLoad(900.0, direction_deg=40.0)},
        0.5,
    ),
    "load against the speed": ({"rotating_load": RotatingLoad(500.0, frequency_hz=-37.0)}, 2.0),
    "harmonic load": ({"axial_load": History.harmonic(4000.0, 900.0, frequency_hz=37.0, phase_deg=-90)}, 5.0),
    "two that repeat together": (
        {"axial_load": History.harmonic(4000.0, 900.0, frequency_hz=30.0), "rotating_load": RotatingLoad(500.0)},
        5.0,
    ),
    "ramp, then harmonic": (
        {
            "moment_x": History.ramp(0, 0.03, 0.0, 20.0),
            "axial_load": History.harmonic(4000.0, 900.0, frequency_hz=30.0),
        },
        1.0,
    ),
    "misalignment": ({"misalignment_x": History.ramp(0, 0.02, 0, 1.5e-3)}, 0.03),
    "axial load alone under radial play": (
        {"axial_load": 0.0, "radial_load": History.ramp(0, 0.02, 100, 3000), "displacement": (None, None, -1e-5)},
        0.03,
    ),
}


def offsets(sim: Simulation, times: np.ndarray) -> np.ndarray:
    """Distance of the ring from its equilibria at times (m); rotations at half the pitch diameter."""
    scene, table = sim.scene, sim.bearings[0].motion.table
    solver = EquilibriumSolver(sim.bearings[0].model, scene, nominal_angles(scene))
    arm = 0.5 * scene.bearing.pitch_diameter
    # the core does not record the ring's rotation: columns of rotation_x and rotation_y of its table
    turn = CubicHermiteSpline(table[:, 0], table[:, [7, 9]], table[:, [8, 10]]) if len(table) > 1 else None
    found = []
    for time in times:
        expected = solver.solve(float(time)).displacement
        place = sim.record(sim.state.vector, time=float(time))["ring_position"]
        assert sim.bearings[0].motion.displacement(float(time))[:3] == pytest.approx(
            place, abs=1e-15
        )  # as states keep it
        found.append(float(np.abs(place - expected[:3]).max()))
        if turn is not None and time < table[-1, 0]:
            found.append(arm * float(np.abs(turn(time) - expected[3:]).max()))
    return np.array(found)


@pytest.mark.parametrize("name", TURNS)
def test_path_lies_at_the_equilibria_between_its_knots(name: str) -> None:
    changes, end = TURNS[name]
    sim = Simulation(paper_30310(**{"ring": "follows", **changes}))
    times = np.random.default_rng(len(name)).uniform(0.0, end, 40)
    assert offsets(sim, times).max() < PATH_TOLERANCE
    view = [sim.record(time=float(time))["ring_force"] for time in times]
    assert np.ptp(view, axis=0).max() > 100.0


def test_velocity_of_the_path_is_continuous() -> None:
    sim = Simulation(paper_30310(3000.0, 4930.0, 2000.0, rotating_load=RotatingLoad(800.0), ring="follows"))
    knots = sim.bearings[0].motion.table[:, 0]
    for knot in [*knots[1:-1], 7 * knots[-1]]:
        before, after = (sim.record(time=float(knot + step))["ring_position"] for step in (-1e-7, 1e-7))
        at = sim.record(time=float(knot))["ring_position"]
        assert (at - before) / 1e-7 == pytest.approx((after - at) / 1e-7, abs=2e-7)


def test_long_history_is_quick() -> None:
    """61 knots took 10 s, most of them for starting each search from nothing."""
    values = np.random.default_rng(0).uniform(2000, 5000, 61)
    scene = paper_30310(3000.0, History.table(np.linspace(0, 1, 61), values), ring="follows")
    began = clock.process_time()
    sim = Simulation(scene)
    assert clock.process_time() - began < 5.0
    assert offsets(sim, np.random.default_rng(1).uniform(0, 1, 40)).max() < PATH_TOLERANCE


def test_run_under_a_rotating_load_goes_round_for_ever() -> None:
    """Also after thousands of periods, where only a repeating table reaches."""
    scene = paper_30310(3000.0, 4930.0, rotating_load=RotatingLoad(800.0), ring="follows", start=Start(time=100.0))
    sim = Simulation(scene, accuracy="fast")
    result = sim.run(duration=0.004, save_every=1e-3)
    place = np.array([sim.record(time=float(time))["ring_position"] for time in result.time])
    angle = np.unwrap(np.arctan2(place[:, 1], place[:, 0]))
    assert angle == pytest.approx(angle[0] + 100.0 * np.pi * (result.time - 100.0), abs=0.02)
    assert result.success


@pytest.mark.parametrize("phase", [0.0, -90.0, 33.0, 400.0])
def test_harmonic(phase: float) -> None:
    history = History.harmonic(3.0, 2.0, frequency_hz=8.0, phase_deg=phase)
    t = np.linspace(-1.3, 2.9, 5001)
    argument = 16.0 * np.pi * t + np.radians(phase)
    assert history.value(t) == pytest.approx(3.0 + 2.0 * np.cos(argument), abs=2 * 1.3e-5)
    assert history.slope(t) == pytest.approx(-32.0 * np.pi * np.sin(argument), abs=32 * np.pi * 1e-3)
    assert (min(history.extremes), max(history.extremes)) == pytest.approx((1.0, 5.0), abs=1e-12)

    def primitive(time: float) -> float:
        return 3.0 * time + 2.0 / (16.0 * np.pi) * np.sin(16.0 * np.pi * time + np.radians(phase))

    for start, end in ((0.0, 0.01), (-1.2, 2.3), (5.0, 4.5)):
        assert history.integral(start, end) == pytest.approx(primitive(end) - primitive(start), abs=1e-5)
    assert History.from_json(history.to_json()) == history


def test_table_that_repeats() -> None:
    history = History(times=(0.0, 0.1, 0.2), values=(1.0, 3.0, 1.0), repeats=True)
    assert history.value([0.05, 0.25, -0.15]) == pytest.approx([float(history.value(0.05))] * 3)
    with pytest.raises(InputError, match="ends as it begins"):
        History(times=(0.0, 0.1), values=(1.0, 3.0), repeats=True)


@pytest.mark.parametrize(
    ("changes", "field", "says"),
    [
        ({"misalignment_x": History.ramp(0, 0.02, 0, 1.5e-3)}, "misalignment_x", "ring = 'follows'"),
        ({"rotating_load": RotatingLoad(500.0)}, "ring", "rotating_load"),
        ({"rotating_load": RotatingLoad(22000.0), "ring": "follows"}, "rotating_load.load", "must be < 21434"),
        ({"misalignment_x": 1e-3, "effects": Effects.minimal()}, "misalignment_x", "planar"),
        ({"moment_y": 5.0, "effects": Effects.minimal()}, "moment_y", "planar"),
        (
            {"axial_load": History.ramp(0, 1, 1000, 2000), "ring": "follows", "effects": Effects.minimal()},
            "axial_load",
            "planar",
        ),
        ({"displacement": (None, None, None)}, "displacement", "one entry at least"),
        ({"displacement": (None, None, -1e-5)}, "axial_load", "displacement gives the axial position"),
        ({"displacement": (0.0, None, None), "radial_load": 10.0}, "radial_load", "set those entries None"),
        (
            {"axial_load": 0.0, "displacement": (None, None, History.ramp(0, 1, 0, -1e-5))},
            "displacement[2]",
            "ring = 'follows'",
        ),
        (
            {
                "rotating_load": RotatingLoad(500.0, frequency_hz=7**0.5),
                "axial_load": History.harmonic(4000.0, 100.0, frequency_hz=50.0),
                "ring": "follows",
            },
            "axial_load",
            "no common period",
        ),
    ],
)
def test_refused(changes: dict[str, Any], field: str, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        paper_30310(**{"speed_rpm": 3000.0, "axial_load": 4930.0, **changes}).check_capacity()
    assert caught.value.field == field


def test_history_that_begins_before_the_start() -> None:
    """The start was that of the first knot: 53 kN on the ring, a cage at (101, 13) um."""
    sim = Simulation(paper_30310(3000.0, History.ramp(-0.02, 0.02, 1230, 4930), ring="follows"))
    assert sim.record()["ring_force"][2] == pytest.approx(3080.0, rel=2e-3)
    assert float(sim.record()["shaft_angle"]) == 0.0
    plain = Simulation(paper_30310(3000.0))
    steady = Simulation(paper_30310(History.table([-0.013, 0.01], [3000, 3000])))
    assert np.array_equal(steady.state.vector, plain.state.vector)


def test_start_inside_a_history_is_that_of_the_shifted_one() -> None:
    late = Simulation(paper_30310(3000.0, History.ramp(0, 0.02, 1230, 4930), ring="follows", start=Start(time=0.0125)))
    shifted = Simulation(paper_30310(3000.0, History.ramp(-0.0125, 0.0075, 1230, 4930), ring="follows"))
    assert late.state.vector == pytest.approx(shifted.state.vector, abs=1e-12)
    for step in (0.0, 0.001, 0.02):
        assert late.record(time=0.0125 + step)["ring_position"] == pytest.approx(
            shifted.record(time=step)["ring_position"], abs=1e-12
        )
    with pytest.raises(InputError, match=r"must be >= 0\.0125"):
        late.set_state(late.state.vector, time=0.0)


def test_saved_state_keeps_the_angle_of_its_shaft() -> None:
    scene = paper_30310(3000.0, 4930.0, 2000.0, start=Start(time=2.0))
    saved = Simulation(scene)
    saved.run(duration=0.003, save_every=1e-3)
    state = saved.state
    again = Simulation(scene.replace(start=Start.state(state.vector, time=state.time, shaft_angle=state.shaft_angle)))
    assert float(again.record()["shaft_angle"]) == pytest.approx(float(saved.record()["shaft_angle"]), rel=1e-12)
    assert again.record()["ring_force"] == pytest.approx(saved.record()["ring_force"], abs=1e-6)


@pytest.mark.parametrize("start", [Start.whirl(), Start.unequal(3)], ids=["whirl", "unequal"])
def test_uneven_start_does_not_shift_the_ring(start: Start) -> None:
    """It was held at the equilibrium of the rollers' places at the start, which loaded it by 58 N for the whole run."""
    even, uneven = Simulation(paper_30310()), Simulation(paper_30310(start=start))
    assert uneven.record()["ring_position"] == pytest.approx(even.record()["ring_position"], abs=1e-15)
    view, rates = uneven.view(), uneven.view(uneven.derivative())
    assert np.abs(view["roller_psi"]).max() > 1e-4
    assert np.abs(rates["roller_v_r"]).max() * uneven.scene.bearing.geometry.roller_mass < 1.0


@pytest.mark.parametrize("play", [-5e-5, -5e-6, 0.0, 2e-5, 2e-4])
@pytest.mark.parametrize("radial", [0.0, 10.0, 5000.0])
def test_radial_load_with_given_axial_place(play: float, radial: float) -> None:
    """Preload by displacement, or play, under a pure radial load."""
    for speed in (0.0, 3000.0):
        sim = Simulation(
            paper_30310(speed, 0.0, radial, displacement=(None, None, play), effects=Effects.frictionless())
        )
        place, force = sim.equilibrium.displacement, sim.record()["ring_force"]
        assert place[2] == play
        assert force[:2] == pytest.approx([0.0, -radial], abs=1e-3 * max(radial, 1.0))
        assert (force[2] > 1e-6) == (play < 0.0 or speed > 0.0 or radial > 0.0)


def test_axial_load_with_given_radial_place() -> None:
    sim = Simulation(paper_30310(3000.0, 2000.0, displacement=(5e-6, None, None), effects=Effects.frictionless()))
    assert sim.equilibrium.displacement[0] == 5e-6
    assert sim.record()["ring_force"][1:] == pytest.approx([0.0, 2000.0], abs=1.0)


@pytest.mark.parametrize(("speed", "axial"), [(5000.0, 600.0), (10000.0, 1000.0), (10000.0, 4930.0)])
def test_the_largest_radial_load_knows_the_centrifugal_force(speed: float, axial: float) -> None:
    """At three quarters of it there is an equilibrium, above it there is none, and the message tells it."""
    scene = paper_30310(speed, axial)
    most = most_radial_load(scene, axial)
    assert most < 0.95 * axial / math.tan(math.radians(scene.bearing.cup_half_angle_deg))
    found = Simulation(scene.replace(radial_load=0.75 * most)).equilibrium
    cosine = math.cos(math.radians(scene.bearing.cup_half_angle_deg))
    assert abs(float(np.sum(found.outer_load * cosine * np.sin(found.angles)))) == pytest.approx(0.75 * most, rel=1e-3)
    told = rf"is more than axial_load = {axial:g} N can hold .* radial load below {re.escape(f'{most:.4g}')} N"
    with pytest.raises(LoadError, match=told):
        Simulation(scene.replace(radial_load=1.02 * most))


def test_light_load_is_told_the_least() -> None:
    """The least axial load: at one half per cent more there is an equilibrium, at as much less there is none."""
    scene = paper_30310(10000.0, 100.0)
    least = least_axial_load(scene)
    with pytest.raises(LoadError, match=rf"axial_load must be at least {least:.4g} N at this speed") as caught:
        Simulation(scene)
    assert "cannot carry" not in str(caught.value)
    with pytest.raises(LoadError):
        Simulation(scene.replace(axial_load=0.995 * least))
    assert Simulation(scene.replace(axial_load=1.005 * least)).equilibrium.residual < 1e-3
    with pytest.raises(LoadError, match=r"at 0\.\d+ s"):
        Simulation(trb.cases.paper_30310(3000.0, History.ramp(0, 0.01, 4930, 0.1), ring="follows"))
