"""A bearing as a unit of FMI 3: its description, its steps in a master by FMPy, and a rotor of two units beside an assembly."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.exchange.fmu_unit import BearingUnit

PLACES = ("ring_position_x", "ring_position_y", "ring_position_z", "ring_tilt_x", "ring_tilt_y")
RATES = ("ring_velocity_x", "ring_velocity_y", "ring_velocity_z", "ring_tilt_rate_x", "ring_tilt_rate_y")
FORCES = ("ring_force_x", "ring_force_y", "ring_force_z", "ring_moment_x", "ring_moment_y")


@contextmanager
def running(path: Path, folder: Path) -> Iterator[Callable[..., Any]]:
    """A unit in FMPy, as a function: values of inputs, time and length of a step in, values of outputs out."""
    fmpy = pytest.importorskip("fmpy")
    description = fmpy.read_model_description(str(path))
    numbers = {one.name: one.valueReference for one in description.modelVariables}
    fmpy.extract(str(path), str(folder))
    unit = fmpy.fmi3.FMU3Slave(
        guid=description.guid,
        unzipDirectory=str(folder),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName=path.stem,
    )
    unit.instantiate()
    unit.enterInitializationMode()
    unit.exitInitializationMode()

    def go(names: tuple[str, ...], values: Any, asked: tuple[str, ...], time: float = 0.0, size: float = 0.0) -> Any:
        if names:
            unit.setFloat64([numbers[name] for name in names], [float(one) for one in values])
        if size:
            unit.doStep(currentCommunicationPoint=time, communicationStepSize=size)
        return np.array(unit.getFloat64([numbers[name] for name in asked]))

    try:
        yield go
    finally:
        unit.terminate()
        unit.freeInstance()


def directly(unit: BearingUnit) -> Callable[..., Any]:
    """The same of a unit in this process, without FMI."""

    def go(names: tuple[str, ...], values: Any, asked: tuple[str, ...], time: float = 0.0, size: float = 0.0) -> Any:
        for name, value in zip(names, values, strict=True):
            unit.put(name, value)
        if size:
            unit.step(time, size)
        return np.array([unit.get(name) for name in asked])

    return go


def test_fmpy_finds_nothing_wrong_and_its_steps_are_ours(tmp_path: Path) -> None:
    validation = pytest.importorskip("fmpy.validation")
    pytest.importorskip("pythonfmu3")
    from trbdyn.extras.exchange.fmu import write_fmu

    scene = trb.cases.scene_30310(1000.0, 5e3)
    path = write_fmu(scene, tmp_path / "bearing.fmu")
    assert validation.validate_fmu(str(path)) == []
    with pytest.raises(trb.FileError, match="exists already"):
        write_fmu(scene, path)
    unit = BearingUnit(scene)
    own = directly(unit)
    names = ("ring_position_z", "shaft_speed", "oil_temperature")
    asked = (*FORCES, "inner_torque", "power_loss", "cage_position_y", "pocket_force", "axial_stiffness", "time")
    with running(path, tmp_path / "unpacked") as theirs:
        begin = theirs((), (), ("ring_position_z", "ring_force_z"))
        assert begin == pytest.approx([unit.get("ring_position_z"), 5e3], rel=1e-6)
        for k in range(2):
            values = (begin[0] - 1e-7 * (k + 1), 105.0 + k, 61.0)
            found = theirs(names, values, asked, k * 1e-5, 1e-5)
            assert np.array_equal(found[:-1], own(names, values, asked[:-1], k * 1e-5, 1e-5))
            assert found[-1] == pytest.approx((k + 1) * 1e-5)
    assert found[2] > 5.1e3


def test_forces_go_in_and_motion_comes_out() -> None:
    scene = trb.cases.scene_30310(1000.0, 5e3)
    free = scene.replace(ring="free", ring_body=trb.RingBody(mass=3.0, inertia_axial=2e-3, inertia_transverse=2e-3))
    unit = BearingUnit(free, ring="forces")
    z = unit.get("ring_position_z")
    unit.put("load_force_z", unit.get("load_force_z") - 600.0)
    for k in range(3):
        unit.step(k * 1e-5, 1e-5)
    # free fall under the load that nothing holds yet, to what the rollers already hold of it
    fallen = unit.get("ring_position_z") - z
    assert -0.5 * 200.0 * (3e-5) ** 2 < fallen < -0.25 * 200.0 * (3e-5) ** 2
    assert unit.get("radial_stiffness") > 1e8
    for subject, how, field in (
        (scene, {"ring": "forces"}, "ring"),
        (free, {}, "ring"),
        (scene, {"ring": "both"}, "ring"),
        (scene.replace(speed_rpm=trb.History.ramp(0.0, 1.0, 1e3, 2e3)), {}, "speed_rpm"),
    ):
        with pytest.raises(trb.InputError, match=field):
            BearingUnit(subject, **how)
    with pytest.raises(trb.InputError, match="name"):
        unit.put("ring_force_x", 1.0)


MASS, AXIAL, ACROSS = 12.0, 0.01, 0.09
KICK = np.array([4000.0, 1000.0, 1500.0])
"""Force that begins at once on the centre of mass, in the axes of the first bearing (N)."""


def rotor() -> trb.Assembly:
    """A rigid rotor, as of two discs on a light shaft, on two bearings."""
    shaft = trb.Shaft(mass=MASS, inertia_axial=AXIAL, inertia_transverse=ACROSS, mass_position=0.02)
    bearing = trb.cases.rig_30310()
    return trb.Assembly.pair(bearing, "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=1000)


def master(units: list[Callable[..., Any]], assembly: trb.Simulation, step: float, count: int) -> np.ndarray:
    """Newton's and Euler's equations of the rotor in the axes of the first bearing, by Heun's method: the place of the first ring
    and its rates after each step.
    """
    seats, scene = [one.seat for one in assembly.bearings], assembly.bearings[0].scene
    spin, gravity = scene.speed_rpm * math.pi / 30.0, np.array(scene.gravity)
    base = [unit((), (), PLACES) for unit in units]
    # a bearing that sits the other way round has axes turned by half a turn about x; arms lie along the axis
    turns = [np.array([1.0, -1.0, -1.0]) if seat.turned else np.ones(3) for seat in seats]
    arms = [seat.mass_offset if seat.turned else -seat.mass_offset for seat in seats]

    def seen(number: int, q: np.ndarray) -> np.ndarray:
        place = turns[number] * [q[0] + arms[number] * q[4], q[1] - arms[number] * q[3], q[2]]
        return np.concatenate([place, turns[number][:2] * q[3:]])

    def rates(forces: list[np.ndarray], v: np.ndarray) -> np.ndarray:
        force, moment = KICK + MASS * gravity, np.zeros(2)
        for turn, arm, found in zip(turns, arms, forces, strict=True):
            on = turn * found[:3]
            force = force + on
            moment = moment + turn[:2] * found[3:] + arm * np.array([-on[1], on[0]])
        gyroscopic = AXIAL * spin * np.array([-v[4], v[3]])
        return np.concatenate([force / MASS, (moment + gyroscopic) / ACROSS])

    q, v, out = np.zeros(5), np.zeros(5), []
    a = rates([unit((), (), FORCES) for unit in units], v)
    for k in range(count):
        ahead, faster, forces = q + step * v + 0.5 * step**2 * a, v + step * a, []
        for number, unit in enumerate(units):
            values = [*(base[number] + seen(number, ahead)), *seen(number, faster)]
            forces.append(unit((*PLACES, *RATES), values, FORCES, k * step, step))
        new = rates(forces, faster)
        q, v, a = ahead, v + 0.5 * step * (a + new), new
        out.append([*(base[0] + seen(0, q)), *seen(0, v)])
    return np.array(out)


def kinetic(rows: np.ndarray, arm: float) -> np.ndarray:
    """Kinetic energy of the rotor, without its spin, from the rates of the first ring (J)."""
    x, y, z, turn_x, turn_y = rows[:, 5:].T
    centre = (x - arm * turn_y) ** 2 + (y + arm * turn_x) ** 2 + z**2
    return 0.5 * MASS * centre + 0.5 * ACROSS * (turn_x**2 + turn_y**2)


@pytest.mark.slow
@pytest.mark.parametrize("by", ["fmpy", "this process"])
def test_a_rotor_of_two_units_moves_as_an_assembly(by: str, tmp_path: Path) -> None:
    step, count = 1e-5, 30
    assembly = trb.Simulation(rotor(), accuracy="reference")
    scenes, arm = [one.scene for one in assembly.bearings], -assembly.bearings[0].seat.mass_offset
    if by == "fmpy":
        pytest.importorskip("pythonfmu3")
        from trbdyn.extras.exchange.fmu import write_fmu

        paths = [write_fmu(one, tmp_path / f"bearing_{k}.fmu", accuracy="reference") for k, one in enumerate(scenes)]
        with running(paths[0], tmp_path / "0") as first, running(paths[1], tmp_path / "1") as second:
            found = master([first, second], assembly, step, count)
    else:
        units = [directly(BearingUnit(one, accuracy="reference")) for one in scenes]
        found = master(units, assembly, step, count)
    ours, turn = [], np.array([1.0, -1.0, -1.0]) * KICK
    load = trb.ShaftLoad(position=0.02, force=tuple(turn.tolist()))
    for k in range(count):
        assembly.step(to=(k + 1) * step, **({} if k else {"loads": (load,)}))
        record = assembly.record()["left"]
        rates = [*record["ring_velocity"], *record["ring_angular_velocity"][:2]]
        ours.append([*record["ring_position"], *record["ring_tilt"], *rates])
    own = np.array(ours)
    assert (np.abs(found - own)[:, :5].max(axis=0) < 0.01 * np.ptp(own[:, :5], axis=0)).all()
    energy = kinetic(own, arm)
    assert np.abs(kinetic(found, arm) - energy).max() < 0.01 * energy.max()
