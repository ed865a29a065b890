"""What users meet of a simulation: runs and how they end, files, states, looks inside."""

from __future__ import annotations

import math
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared import assert_same_fields

import trbdyn as trb
from trbdyn import History, InputError, Result, Simulation, StepError
from trbdyn.model.cases import paper_30310
from trbdyn.results import fields as field_table
from trbdyn.results import peaks as peak_table
from trbdyn.results.file_format import as_kept
from trbdyn.run.keeping import absent, there
from trbdyn.run.options import RunOptions
from trbdyn.statics import seat


def simulate(**options: Any) -> Simulation:
    return Simulation(paper_30310(3000.0, 4930.0), **options)


@pytest.fixture(scope="module")
def short() -> Result:
    """2 ms in memory."""
    return simulate().run(duration=2e-3, save_every=1e-4)


@pytest.mark.parametrize("begun", [None, 7.0])
def test_a_state_has_the_angle_of_the_shaft(begun: float | None) -> None:
    """That of the record of its instant: the angle at the start, and the turn since."""
    scene = paper_30310(3000.0, 4930.0)
    vector = Simulation(scene).state.vector
    sim = Simulation(scene.replace(start=trb.Start.state(vector, time=0.02, shaft_angle=begun)))
    first = sim.state.shaft_angle
    assert first == pytest.approx(begun or 100.0 * np.pi * 0.02)
    sim.run(duration=1e-4)
    assert sim.state.shaft_angle == pytest.approx(first + 100.0 * np.pi * 1e-4)
    assert sim.state.shaft_angle == pytest.approx(float(sim.record()["shaft_angle"]), rel=1e-12)


def test_simulations_of_equal_scenes_begin_in_one_equilibrium() -> None:
    one = simulate()
    solved = seat._kept_alone.cache_info().misses
    same = simulate(accuracy="fast")
    assert seat._kept_alone.cache_info().misses == solved
    np.testing.assert_array_equal(one.equilibrium.rollers, same.equilibrium.rollers)
    Simulation(paper_30310(3000.0, 4900.0))
    assert seat._kept_alone.cache_info().misses == solved + 1
    before = same.state.vector
    one.equilibrium.rollers[:] = 0.0
    one.run(duration=1e-4)
    np.testing.assert_array_equal(same.state.vector, before)
    np.testing.assert_array_equal(simulate().state.vector, before)
    np.testing.assert_array_equal(simulate().equilibrium.rollers, same.equilibrium.rollers)


def test_run_returns_everything(short: Result) -> None:
    assert short.success
    assert "reached 0.002" in short.message
    np.testing.assert_allclose(short.time, 1e-4 * np.arange(21), atol=1e-18)
    assert short.final_time == 2e-3
    assert short.final_state is not None
    assert short.final_state.shape == (12 * 11 + 12 + 12 + 11,)
    other = ("housing_", "outer_rib_", "outer_front_rib_", "front_rib_")  # the outer ring rests, and has no ribs
    every = there((*field_table.table(), *peak_table.table()), absent(short.scene, moves=False))
    assert [field.name for field in short.fields] == [
        field.name
        for field in every
        if (field.kind != "mode" and not field.name.startswith(other)) or field.name.startswith("front_rib_load")
    ]
    for name in ("steps", "rhs_evaluations", "jacobian_evaluations", "wall_s", "wall_s_per_revolution"):
        assert short.stats[name] > 0, name
    assert 0.0 < short.stats["smallest_step"] < 0.1 * 2e-3 / short.stats["steps"]  # a run begins with tiny steps
    assert short.stats["bearing_time_s"] == pytest.approx(2e-3)
    assert short.stats["revolutions"] == pytest.approx(0.1)
    assert short.meta["settings"]["integrator"] == "multirate"
    assert short.meta["sundials_version"]
    assert short.counters["force_evaluations"] > 0
    assert short.geometry["cage_speed_ratio"] == pytest.approx(0.41662, abs=1e-5)
    for field in short.fields:
        assert np.isfinite(short[field.name]).all(), field.name


def test_revolutions_and_last_record() -> None:
    """A run ends at its end, even where that is no multiple of the time between records; the next goes on there."""
    sim = simulate()
    first = sim.run(revolutions=0.07, save_every=3e-4)
    assert first.time[-1] == pytest.approx(1.4e-3, rel=1e-12)
    assert first.revolutions == pytest.approx(0.07, rel=1e-12)
    second = sim.run(duration=3e-4, save_every=1e-4)
    np.testing.assert_allclose(second.time, 1.4e-3 + 1e-4 * np.arange(4), rtol=1e-12)
    for name in ("cage_position", "roller_position", "work_shaft"):
        np.testing.assert_array_equal(second[name][0], first[name][-1])


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({}, "revolutions"),
        ({"revolutions": 1.0, "duration": 1.0}, "duration"),
        ({"duration": -1.0}, "duration"),
        ({"duration": float("nan")}, "duration"),
        ({"revolutions": 0}, "revolutions"),
        ({"duration": 1e-3, "save_every": 0.0}, "save_every"),
        ({"duration": 1e-3, "save_every": "often"}, "save_every"),
        ({"duration": 1e-3, "save_groups": ["cages"]}, "save_groups"),
        ({"duration": 1e-3, "save_groups": []}, "save_groups"),
    ],
)
def test_bad_arguments_of_run(arguments: dict[str, Any], field: str) -> None:
    sim = simulate()
    with pytest.raises(InputError, match=field):
        sim.run(**arguments)
    assert sim.time == 0.0


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"accuracy": "best"}, "accuracy"),
        ({"integrator": "euler"}, "integrator"),
        ({"rtol": 0.0}, "rtol"),
        ({"rtol": float("nan")}, "rtol"),
        ({"atol_position": -1e-9}, "atol_position"),
        ({"max_order": 6}, "max_order"),
        ({"max_step": -1.0}, "max_step"),
        ({"tolerance": 1e-3}, "tolerance"),
    ],
)
def test_bad_options(options: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError, match=field):
        simulate(**options)


def test_a_shaft_at_rest_turns_no_revolutions() -> None:
    sim = Simulation(paper_30310(0.0, 4930.0))
    with pytest.raises(InputError, match="is at rest"):
        sim.run(revolutions=1.0)


def test_groups_of_quantities(short: Result) -> None:
    result = simulate().run(duration=2e-3, save_groups=["cage", "torque"])
    assert set(result.groups) == {"time", "cage", "torque"}
    np.testing.assert_array_equal(result.cage_position, short.cage_position)
    with pytest.raises(AttributeError):
        _ = result.outer_load
    with pytest.raises(InputError, match="outer_load"):
        result["outer_load"]


def test_file_holds_what_memory_does(short: Result, tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    written = simulate().run(duration=2e-3, save_every=1e-4, output=path)
    loaded = trb.load(path)
    for result in (written, loaded):
        assert [entry.name for entry in result.fields] == [entry.name for entry in short.fields]
        # contacts, torque and peaks have seven digits in a file, motion has twelve
        assert_same_fields(result, {entry.name: as_kept(entry, short[entry.name]) for entry in short.fields})
        assert result.success
        assert result.message == short.message
        assert result.final_state is not None
        np.testing.assert_array_equal(result.final_state, short.final_state)
        assert result.counters == short.counters
        assert result.stats["steps"] == short.stats["steps"]
        assert result.scene == paper_30310(3000.0, 4930.0)


@pytest.mark.parametrize("in_file", [False, True])
def test_what_a_callback_raises_comes_out_with_the_records(tmp_path: Path, in_file: bool) -> None:
    def callback(sim: trb.Simulation) -> None:
        if sim.time > 1e-3:
            raise ValueError("enough")

    sim = trb.Simulation(trb.cases.paper_30310(3000.0))
    with pytest.raises(ValueError, match="enough") as caught:
        sim.run(duration=1.0, save_every=1e-5, output=tmp_path / "run.h5" if in_file else None, callback=callback)
    assert "'result'" in caught.value.__notes__[0]
    result = trb.load(tmp_path / "run.h5") if in_file else caught.value.result
    assert not result.success
    assert "ended by ValueError" in result.message
    assert len(result) > 100
    assert result.time[-1] == pytest.approx(1e-5 * (len(result) - 1))
    assert sim.run(duration=1e-3).success


@pytest.mark.parametrize("in_file", [False, True])
def test_ctrl_c_in_python(tmp_path: Path, in_file: bool) -> None:
    path = tmp_path / "run.h5" if in_file else None
    sim = simulate()
    result = sim.run(duration=10.0, save_every=1e-5, output=path, callback=lambda _: signal.raise_signal(signal.SIGINT))
    assert not result.success
    assert "stopped by the user" in result.message
    assert len(result) >= 256
    assert np.isfinite(result.cage_position).all()
    # the simulation can go on
    assert sim.run(duration=1e-4).success


def test_progress_bar(capsys: pytest.CaptureFixture[str]) -> None:
    simulate().run(duration=1e-3, progress=True)
    assert "bearing time" in capsys.readouterr().err
    simulate().run(duration=1e-3)
    assert not capsys.readouterr().err


@pytest.fixture
def any_gravity(monkeypatch: pytest.MonkeyPatch) -> None:
    """Takes the limit of gravity away, so that a scene can be made which no step survives."""
    monkeypatch.setattr("trbdyn.model.scene.MAX_GRAVITY", math.inf)


def failing(**options: Any) -> Simulation:
    """Gravity that nothing can stand comes on after 1 ms."""
    weight = History.ramp(1e-3, 1.1e-3, 0.0, 1e60)
    return Simulation(paper_30310(3000.0, 4930.0, gravity=(0.0, -9.81, weight)), **options)


@pytest.mark.usefixtures("any_gravity")
@pytest.mark.parametrize("integrator", ["bdf", "erk", "multirate"])
@pytest.mark.parametrize("in_file", [False, True])
def test_failed_step_keeps_what_was_good(tmp_path: Path, integrator: str, in_file: bool) -> None:
    path = tmp_path / "run.h5"
    sim = failing(integrator=integrator)
    with pytest.raises(StepError) as caught:
        sim.run(duration=3e-3, save_every=1e-5, output=path if in_file else None)
    error = caught.value
    assert 0.9e-3 < error.time < 1.1e-3
    assert error.body is not None
    assert error.body.split()[0] in ("roller", "cage")
    assert error.quantity
    assert error.body in str(error)
    assert f"{error.time:.9g}" in str(error)
    kept = trb.load(path) if in_file else error.result
    for result in (error.result, kept):
        assert not result.success
        assert result.message == str(error)
        assert 90 <= len(result) <= 112
        assert result.time[-1] <= error.time
        for field in result.fields:
            assert np.isfinite(result[field.name]).all(), field.name
    # the state is the last good one
    assert sim.time == error.time
    assert np.isfinite(sim.state.vector).all()
    assert np.isfinite(sim.record()["cage_position"]).all()


def test_failed_single_step() -> None:
    sim = simulate()
    vector = sim.state.vector
    sim.view(vector)["roller_omega_a"][4] = 1e200
    sim.set_state(vector)
    with pytest.raises(StepError) as caught:
        sim.step()
    assert caught.value.time == 0.0
    np.testing.assert_array_equal(sim.state.vector, vector)
    sim.set_state(simulate().state)
    assert sim.step() > 0.0


@pytest.mark.parametrize("in_file", [False, True])
def test_rollers_that_touch_end_the_run(tmp_path: Path, in_file: bool) -> None:
    """Without a cage nothing keeps rollers apart: a run in which they meet, one faster than the others, is no result."""
    effects = trb.Effects.frictionless().replace(bodies="rollers", gravity=False)
    sim = Simulation(paper_30310(3000.0, 4930.0, effects=effects))
    vector = sim.state.vector
    sim.view(vector)["roller_v_t"][3] += 4.0
    sim.set_state(vector)
    with pytest.raises(StepError, match="touch") as caught:
        sim.run(duration=0.02, save_every=1e-4, output=tmp_path / "run.h5" if in_file else None)
    assert caught.value.body == "rollers"
    kept = trb.load(tmp_path / "run.h5") if in_file else caught.value.result
    assert not kept.success
    assert "touch" in kept.message
    assert len(kept) > 10


def test_run_after_single_steps() -> None:
    """A run goes on where single steps have led."""
    sim = simulate()
    for _ in range(30):
        sim.step()
    reached = sim.time
    result = sim.run(duration=1e-4, save_every=1e-5)
    assert result.success
    assert result.time[0] <= reached
    assert result.time[-1] > reached


def test_a_setting_of_zero_is_not_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    """Age 0: the rings' part of the Jacobian is evaluated with every other part, as at an age below every step."""
    usual = RunOptions.settings

    def state(**changes: float) -> np.ndarray:
        monkeypatch.setattr(RunOptions, "settings", lambda self: usual(self) | changes)
        sim = Simulation(paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9)))
        sim.run(duration=5e-3)
        return sim.state.vector

    zero = state(rings_age=0.0)
    np.testing.assert_array_equal(zero, state(rings_age=1e-12))
    assert (zero != state()).any()


def test_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    """Not even where a step is too small to move the time, which CVODE would warn of."""
    sim = simulate(first_step=1e-16)
    sim.set_state(sim.state.vector, time=1e3)
    assert sim.step() == 1e3
    assert capfd.readouterr() == ("", "")


def test_the_system_lists_what_is_simulated_and_what_is_off() -> None:
    """What the effects leave out is listed as off, and its counters stay at zero."""
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000.0, axial_load=4930.0)
    simulation = Simulation(scene)
    system = simulation.system
    assert sum(body.coordinates for body in system.bodies) == 12 * 11 + 12
    on = {pair.name for pair in system.pairs if pair.on}
    assert on == {"outer", "inner", "rib", "front_rib", "pocket"}
    by_name = {pair.name: pair for pair in system.pairs}
    assert by_name["pocket"].bodies == ("rollers", "cage")
    assert by_name["inner_land"].surfaces == ("guiding surface", "land of the inner ring")
    assert "drag" in repr(system)
    assert "<table" in system._repr_html_()
    body = trb.RingBody.hollow_cylinder(mass=1.0, outer_diameter=0.06, length=0.1)
    other = scene.replace(
        ring="free",
        ring_body=body,
        effects=trb.Effects.standard().replace(oil_fill=0.1, back_rib=False, guidance="outer_land"),
    )
    system = Simulation(other).system
    assert {pair.name for pair in system.pairs if pair.on} == on - {"rib"} | {"drag", "cage_drag", "outer_land"}
    assert {body.name: body.coordinates for body in system.bodies}["inner ring"] == 12
