"""Inputs given between steps: energy, angles, bits, states that keep them, feedback by a callback."""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.run.controlled import Controlled

RING = trb.RingBody(mass=3.0, inertia_axial=2e-3, inertia_transverse=2e-3, damping=500.0)


def free() -> trb.Scene:
    return trb.cases.scene_30310(1000.0, 5e3).replace(ring="free", ring_body=RING)


def energy(record: dict[str, Any], begin: str) -> float:
    return sum(float(np.sum(value)) for name, value in record.items() if name.startswith(begin))


def residual(record: dict[str, Any], before: dict[str, Any]) -> tuple[float, float]:
    """What is missing in the energy, and what was put in without regard to signs (J)."""
    stored = [energy(one, "kinetic_energy") + energy(one, "elastic_energy") for one in (before, record)]
    missing = energy(record, "work_") - energy(record, "loss_") - (stored[1] - stored[0])
    return missing, abs(energy(record, "work_")) + energy(record, "loss_")


def drive(simulation: trb.Simulation, first: int = 0, last: int = 8) -> trb.Simulation:
    for k in range(first, last):
        simulation.step(
            to=(k + 1) * 1e-4,
            between=("held", "linear")[k % 2],
            axial_load=5e3 + 500.0 * math.sin(k),
            radial_load=40.0 * k,
            speed_rpm=1000.0 + 5.0 * k,
        )
    return simulation


def test_the_energy_counts_the_work_of_inputs() -> None:
    before = trb.Simulation(free()).record()
    driven = drive(trb.Simulation(free()))
    missing, size = residual(driven.record(), before)
    assert abs(missing) < 1e-3 * size
    for k in range(3):
        driven.step(to=8e-4 + (k + 1) * 1e-4, temperature_c=62.0 + k)
    assert driven.scene.lubricant.temperature_c == 64.0
    missing, size = residual(driven.record(), before)
    assert abs(missing) < 1e-3 * size


def test_bits_repeat_and_states_keep_the_inputs() -> None:
    whole = drive(trb.Simulation(free()))
    first = drive(trb.Simulation(free()), last=4)
    other = trb.Simulation(free())
    other.set_state(pickle.loads(pickle.dumps(first.state)))
    copied = first.copy()
    for one in (first, other, copied):
        drive(one, first=4)
        assert np.array_equal(one.state.vector, whole.state.vector)
        assert one.state.shaft_angle == whole.state.shaft_angle
    # angles are exact integrals: the speed changes evenly within each step
    speeds = np.array([1000.0, *(1000.0 + 5.0 * k for k in range(8))])
    turned = np.sum(0.5 * (speeds[1:] + speeds[:-1])) * 1e-4 * math.pi / 30.0
    assert whole.state.shaft_angle == pytest.approx(turned, rel=1e-12)
    assert float(whole.record()["shaft_angle"]) == pytest.approx(turned, rel=1e-12)


def test_without_inputs_it_takes_the_steps_of_a_run() -> None:
    run, stepped = trb.Simulation(free()), trb.Simulation(free())
    run.run(duration=5e-4)
    stepped.step(to=2e-4)
    stepped.step(to=5e-4)
    assert np.array_equal(run.state.vector, stepped.state.vector)
    assert stepped.time == 5e-4


def test_what_changed_evenly_stays_until_the_next_call() -> None:
    simulation = trb.Simulation(free())
    simulation.step(to=1e-4, speed_rpm=1010.0)
    simulation.step(to=3e-4)
    assert float(simulation.record()["shaft_speed"]) == pytest.approx(1010.0 * math.pi / 30.0, rel=1e-14)
    simulation.step()
    assert float(simulation.record()["shaft_speed"]) == pytest.approx(1010.0 * math.pi / 30.0, rel=1e-14)


def test_a_ring_that_follows_goes_to_its_equilibrium() -> None:
    scene = trb.cases.scene_30310(1000.0, 5e3, ring="follows")
    simulation = trb.Simulation(scene)
    simulation.step(to=2e-4, axial_load=7e3, radial_load=500.0)
    aim = trb.Simulation(scene.replace(axial_load=7e3, radial_load=500.0)).equilibrium.displacement
    assert simulation.state.displacement == pytest.approx(aim, abs=1e-9)
    with pytest.raises(trb.LoadError, match="inputs at"):
        simulation.step(to=3e-4, radial_load=5e5)
    assert simulation.time == 2e-4


def test_a_ring_that_is_placed_takes_places() -> None:
    scene = trb.cases.scene_30310(1000.0, 5e3)
    simulation = trb.Simulation(scene)
    simulation.step(to=1e-4, misalignment_x=1e-4)
    assert simulation.state.displacement[3] == pytest.approx(1e-4)
    before = trb.Simulation(scene).record()
    missing, size = residual(simulation.record(), before)
    assert abs(missing) < 5e-3 * size
    for inputs, field in (
        ({"axial_load": 6e3}, "axial_load"),
        ({"mass": 1.0}, "mass"),
        ({"speed_rpm": trb.History.ramp(0.0, 1.0, 1.0, 2.0)}, "inputs"),
        ({"outer_speed_rpm": 10.0}, "outer_speed_rpm"),
        ({"torque": 1.0}, "torque"),
    ):
        with pytest.raises(trb.InputError, match=field):
            simulation.step(to=2e-4, **inputs)
    with pytest.raises(trb.InputError, match="between"):
        simulation.step(to=2e-4, between="cubic", speed_rpm=1.0)
    with pytest.raises(trb.InputError, match="after the present time"):
        simulation.step(to=1e-4)
    with pytest.raises(trb.InputError, match="to"):
        simulation.step(speed_rpm=1.0)
    moving = trb.Simulation(scene.replace(speed_rpm=trb.History.ramp(0.0, 1.0, 1e3, 2e3)))
    with pytest.raises(trb.InputError, match="must not change by itself"):
        moving.step(to=1e-4, speed_rpm=900.0)


def test_a_ring_may_follow_a_cubic() -> None:
    """x = a t^3 is met by its places and rates, so that steps of two lengths give the same forces of damping."""
    scene = trb.cases.scene_30310(1000.0, 5e3)
    place = trb.Simulation(scene).equilibrium.displacement
    scene = scene.replace(axial_load=0.0, displacement=tuple(float(one) for one in place[:3]))
    found = []
    for count in (2, 8):
        simulation = trb.Simulation(scene, accuracy="reference")
        for time in np.linspace(0.0, 4e-5, count + 1)[1:]:
            x, y, z = float(place[0]), float(place[1]), float(place[2]) - 1.5e7 * float(time) ** 3
            rates = {"displacement": (0.0, 0.0, -4.5e7 * float(time) ** 2)}
            simulation.step(to=float(time), displacement=(x, y, z), rates=rates)
        record = simulation.record()
        assert float(record["ring_velocity"][2]) == pytest.approx(-4.5e7 * 1.6e-9, rel=1e-9)
        found.append(float(record["ring_force"][2]))
    assert found[0] > 5.2e3
    assert found[1] == pytest.approx(found[0], rel=5e-3)
    with pytest.raises(trb.InputError, match="rates"):
        simulation.step(to=1e-3, rates={"speed_rpm": 1.0})


def pair() -> trb.Assembly:
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    return trb.Assembly.pair(
        trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=1000
    )


def test_bearings_on_a_shaft() -> None:
    push = trb.ShaftLoad(position=0.02, force=(300.0, 0.0, -200.0))
    simulation, again = trb.Simulation(pair()), trb.Simulation(pair())
    before = simulation.record()
    for one in (simulation, again):
        one.step(to=1e-4, loads=(push,), speed_rpm=1004.0)
        one.step(to=2e-4, loads=(), temperature_c=65.0)
    assert np.array_equal(simulation.state.vector, again.state.vector)
    record = simulation.record()
    joined = [
        {f"{key}_{name}": value for name, one in each.items() for key, value in one.items()}
        for each in (record, before)
    ]
    missing, size = residual(*joined)
    assert abs(missing) < 2e-3 * size
    assert [one.scene.lubricant.temperature_c for one in simulation.bearings] == [65.0, 65.0]
    # the load is the one of an assembly that has it from its beginning
    loaded = trb.Simulation(pair().replace(loads=(push,)))
    held = trb.Simulation(pair())
    held.step(to=1e-4, loads=(push,))
    first = [one.bearings[0].motion.table[0] for one in (loaded, held)]
    assert first[0][23:35] == pytest.approx(first[1][23:35], rel=1e-4, abs=1e-3)


def test_feedback_by_a_callback() -> None:
    """An integrating controller moves the ring until the rollers push it back with the force that it shall hold."""
    aim, begin = 6e3, trb.Simulation(trb.cases.scene_30310(1000.0, 5e3)).equilibrium.displacement[2]
    scene = trb.cases.scene_30310(1000.0, 5e3).replace(axial_load=0.0, displacement=(None, None, float(begin)))

    def controlled() -> trb.Result:
        place = [float(begin)]

        def control(simulation: trb.Simulation) -> dict[str, tuple[None, None, float]]:
            place[0] -= 1e-9 * (aim - float(simulation.record()["ring_force"][2]))
            return {"displacement": (None, None, place[0])}

        return trb.Simulation(scene).run(duration=2e-3, callback=control, callback_every=1e-4)

    first, again = controlled(), controlled()
    assert len(first) == 21
    assert first.success
    assert first["ring_force"][0, 2] == pytest.approx(5e3, rel=0.02)
    assert first["ring_force"][-1, 2] == pytest.approx(aim, rel=5e-3)
    assert np.array_equal(first.final_state, again.final_state)
    assert any("callback gave inputs" in note for note in first.meta["notes"])
    stopped = trb.Simulation(free()).run(duration=1e-3, callback=lambda one: one.time > 2e-4, callback_every=1e-4)
    assert not stopped.success
    assert stopped["time"][-1] == pytest.approx(3e-4)


def held_place() -> trb.Scene:
    place = float(trb.Simulation(trb.cases.scene_30310(1000.0, 5e3)).equilibrium.displacement[2])
    return trb.cases.scene_30310(1000.0, 5e3).replace(axial_load=0.0, displacement=(None, None, place))


def of_one(simulation: trb.Simulation) -> dict[str, Any]:
    """An integrating controller, which keeps its place and changes speed and oil as well."""
    kept = simulation.memory
    kept["place"] = kept.get("place", simulation.scene.displacement[2]) - 1e-9 * (
        6e3 - float(simulation.record()["ring_force"][2])
    )
    given: dict[str, Any] = {"displacement": (None, None, kept["place"])}
    return given | (
        {"speed_rpm": 1000.0 + 1e4 * simulation.time, "temperature_c": 62.0} if simulation.time > 2e-4 else {}
    )


def of_two(simulation: trb.Simulation) -> dict[str, Any] | None:
    count = simulation.memory["count"] = simulation.memory.get("count", 0) + 1
    if count % 2:
        return None
    return {"loads": (trb.ShaftLoad(position=0.02, force=(100.0 * count, 0.0, -200.0)),), "speed_rpm": 1000.0 + count}


@pytest.mark.parametrize("several", [False, True], ids=["a bearing", "bearings on a shaft"])
def test_checkpoints_keep_inputs(several: bool, tmp_path: Path) -> None:
    """A run whose callback gives inputs goes on from a checkpoint with the bits of one that was never cut."""
    subject, callback = (pair(), of_two) if several else (held_place(), of_one)
    path, how = tmp_path / "run.h5", {"duration": 7e-4, "callback_every": 1e-4, "checkpoint_every": 1.5e-4}
    whole = trb.Simulation(subject)
    expected = whole.run(**how, callback=callback)

    def cut(simulation: trb.Simulation) -> Any:
        if simulation.time > 4.5e-4:
            raise RuntimeError("cut")
        return callback(simulation)

    with pytest.raises(RuntimeError, match="cut"):
        trb.Simulation(subject).run(**how, callback=cut, output=path)
    with pytest.raises(trb.InputError, match="callback"):
        trb.resume(path)
    memories: list[dict[str, Any]] = []

    def watching(simulation: trb.Simulation) -> Any:
        memories.append(dict(simulation.memory))
        return callback(simulation)

    found = trb.resume(path, callback=watching)
    assert memories[0]  # the callback finds what it kept
    assert len(memories) < 6  # it did not begin again
    names = ("time", "cage_position", "ring_force", "work_shaft", "shaft_speed")
    for of, own in ((found.by_name[name], expected.by_name[name]) for name in found.by_name):
        assert len(of) == len(own) == 8
        for name in names:
            np.testing.assert_allclose(of[name], own[name], rtol=2e-7, atol=1e-30)  # 7 digits in a file
        assert of.stats["steps"] == own.stats["steps"]
        assert of.stats["restarts"] == own.stats["restarts"]
    if not several:
        np.testing.assert_array_equal(found.final_state, expected.final_state)
    # the schedule is part of the run, whether or not it has a file
    assert whole.state.memory == memories[-1] | whole.memory


def test_what_a_callback_keeps_is_part_of_a_state() -> None:
    simulation = trb.Simulation(held_place())
    simulation.run(duration=2e-4, callback=of_one, callback_every=1e-4)
    state, copied = simulation.state, simulation.copy()
    simulation.memory["place"] = 0.0
    assert copied.memory == state.memory == {"place": pytest.approx(-1.1e-5, abs=2e-5)}
    assert copied.memory["place"] != 0.0
    simulation.set_state(pickle.loads(pickle.dumps(state)))
    assert simulation.memory == copied.memory
    for kept in ({"a": (1.0, 2.0)}, {"a": math.nan}, {1: 2.0}, {"a": np.zeros(2)}):
        simulation.memory = kept
        with pytest.raises(trb.InputError, match="memory"):
            Controlled(simulation, simulation.options, np.array([0.0]), None)._control()


def test_runs_and_inputs_do_not_mix_unsaid() -> None:
    simulation = trb.Simulation(free())
    simulation.step(to=1e-4, axial_load=5.5e3)
    with pytest.raises(trb.InputError, match="callback_every"):
        simulation.run(duration=1e-3)
    with pytest.raises(trb.InputError, match="callback"):
        simulation.run(duration=1e-3, callback_every=1e-4, callback=lambda one: 3.0)
