"""Bearings on one shaft: what each does to it, its vibrations, its energy, its momentum, its limits."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shared
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import Effects, FileError, InputError, RingBody, Scene, Simulation, Start
from trbdyn.results.assembly import AssemblyResult
from trbdyn.run.replay import Replay
from trbdyn.standards.sheet import life_text
from trbdyn.statics.seat import Seat, Seating

Array = NDArray[np.float64]

SHAFT = RingBody(mass=5.0, inertia_axial=5e-3, inertia_transverse=3e-2)
PRELOAD = -20e-6
"""Axial displacement of each ring (m)."""
STILL = np.array([0.0, 0.0, PRELOAD, 0.0, 0.0])
ROLLERS = 0.28
"""Mass that the rollers of one bearing add to that of an axially vibrating shaft (kg), docs/theory/motion.md#stiffness."""
WEIGHT = (0.0, -9.80665, 0.0)
FRICTIONLESS = shared.FRICTIONLESS.replace(damping="hunt_crossley")


def seat(
    speed_rpm: float = 3000.0, *, turned: bool = False, offset: float = -0.05, shift: float | None = None, **given: Any
) -> Seat:
    """One of two equal bearings; the second one is turned, and so are its speed and its gravity."""
    sign = -1.0 if turned else 1.0
    values = {"effects": Effects.standard(), "displacement": (0.0, 0.0, PRELOAD)} | given
    scene = Scene(trb.cases.rig_30310(), speed_rpm=sign * speed_rpm, gravity=(0.0, sign * WEIGHT[1], 0.0), **values)
    return Seat(scene, offset, turned, (2.0 * PRELOAD if turned else 0.0) if shift is None else shift)


FINE = {"rtol": 1e-5, "atol_position": 1e-11, "atol_angle": 1e-9, "atol_velocity": 1e-6, "atol_spin": 1e-4}


def pair(
    loads: dict[str, Any] | None = None,
    *,
    body: RingBody = SHAFT,
    shaft: Array = STILL,
    options: dict[str, float] | None = None,
    **given: Any,
) -> Simulation:
    seats = {"left": seat(**given), "right": seat(turned=True, **given)}
    return Simulation(Seating(seats, body, shaft, loads or {}), **(options or {}))


def closures(result: AssemblyResult) -> list[float]:
    return [one.energy_closure for one in result.values()]


def force_on_shaft(result: AssemblyResult) -> Array:
    """Sum of the forces of both bearings in the shaft's axes (N), shape (T, 3)."""
    turned = np.array([1.0, -1.0, -1.0])
    return result["left"].ring_force + turned * result["right"].ring_force


def test_two_bearings_carry_a_load() -> None:
    """Both reactions balance load and weight in the mean; they share a load that stands nearer to one of them."""
    load = 2000.0
    result = pair({"force_x": load}).run(duration=0.04)
    mean = force_on_shaft(result)[len(result.time) // 2 :].mean(axis=0)
    assert mean == pytest.approx([-load, 5.0 * 9.80665, 0.0], abs=0.02 * load)
    left, right = (np.linalg.norm(one.ring_force[-1][:2]) for one in result.values())
    assert left > 3.0 * right
    # with the effective centres outside of the bearings, the far one pulls: their distance is larger than that of the rollers
    assert max(closures(result)) < 1e-4
    assert result.energy.closure < 1e-4
    assert result.success
    assert not result.warnings


def test_symmetry() -> None:
    """Two equal bearings, the second the mirror of the first about the shaft's middle, do the same in their own axes."""
    effects = Effects.standard().replace(gravity=False)
    result = pair(effects=effects).run(duration=0.02)
    left, right = result["left"], result["right"]
    assert np.abs(result.shaft_position - [0.0, 0.0, PRELOAD]).max() < 2e-9
    assert np.mean(right.inner_torque) == pytest.approx(np.mean(left.inner_torque), rel=1e-4)
    assert right.ring_force[-1, 2] == pytest.approx(left.ring_force[-1, 2], rel=1e-4)


def stiffness_of_pair() -> tuple[float, float]:
    """Axial and radial stiffness (N/m) of both bearings, by differences of reactions where the shaft stands still elsewhere."""
    h, values = 2e-7, []
    for axis in (2, 0):
        forces = []
        for sign in (1.0, -1.0):
            shaft = STILL.copy()
            shaft[axis] += sign * h
            records = pair(effects=FRICTIONLESS, shaft=shaft).record()
            forces.append(
                records["left"]["ring_force"][axis]
                + (-1.0 if axis == 2 else 1.0) * records["right"]["ring_force"][axis]
            )
        values.append((forces[1] - forces[0]) / (2.0 * h))
    return values[0], values[1]


def test_axial_vibration() -> None:
    """A heavy shaft that is released beside its equilibrium vibrates with the stiffness of both bearings."""
    body = RingBody(mass=60.0, inertia_axial=0.05, inertia_transverse=0.5)
    stiffness, _ = stiffness_of_pair()
    shaft = STILL + np.array([0.0, 0.0, 2e-7, 0.0, 0.0])
    result = pair(effects=FRICTIONLESS, body=body, shaft=shaft, options=FINE).run(duration=0.02, save_every=1e-5)
    place = result.shaft_position[:, 2] - PRELOAD
    crossings = result.time[1:][np.diff(np.sign(place)) != 0.0]
    found = 0.5 * (crossings.size - 1) / (crossings[-1] - crossings[0])
    expected = np.sqrt(stiffness / (body.mass + 2.0 * ROLLERS)) / (2.0 * np.pi)
    assert found == pytest.approx(expected, rel=5e-3)
    assert np.abs(place).max() == pytest.approx(2e-7, rel=0.1)


def test_each_bearing_keeps_its_energy_while_the_shaft_vibrates() -> None:
    """Without friction, what a bearing gains is what passes between it and the shaft, in each direction and at each instant."""
    shaft = STILL + np.array([3e-6, -2e-6, 3e-7, 1e-5, 2e-5])
    result = pair(effects=FRICTIONLESS, shaft=shaft, options=FINE).run(duration=1.5e-3, save_every=2e-5)
    for name, one in result.items():
        passed = np.abs(one.work_ring - one.work_ring[0]).max()
        assert passed > 0.01, name
        assert np.abs(one.energy_balance["residual"]).max() < 2e-3 * passed, name
    moved = np.ptp(result.shaft_position[:, :2], axis=0)
    assert moved.min() > 3e-6


def test_a_heavy_shaft_stands_still() -> None:
    """Each bearing then does what it does alone with its ring held."""
    body = RingBody(mass=1e5, inertia_axial=1e3, inertia_transverse=1e4)
    effects = Effects.standard().replace(gravity=False)
    seats = {"left": seat(effects=effects, start=Start.whirl(0.9)), "right": seat(turned=True, effects=effects)}
    together = Simulation(Seating(seats, body, STILL), **FINE).run(duration=4e-3)
    for name, one in seats.items():
        alone = Simulation(one.scene, **FINE).run(duration=4e-3)
        moved = np.abs(alone.cage_position - alone.cage_position[0]).max()
        assert np.abs(together[name].cage_position - alone.cage_position).max() < 0.01 * moved + 1e-9
        assert together[name].inner_torque == pytest.approx(alone.inner_torque, rel=2e-3)


def test_momentum() -> None:
    """What the outer rings, the only support, do to rollers and shaft is the change of their momentum."""
    shaft = STILL + np.array([2e-6, -1e-6, 3e-7, 1e-5, 2e-5])
    effects = Effects.standard().replace(bodies="rollers", gravity=False, damping="hunt_crossley")
    simulation = pair(effects=effects, shaft=shaft)
    result = simulation.run(duration=2e-3, save_every=2e-6)
    velocity = np.diff(result.shaft_position, axis=0) / np.diff(result.time)[:, None]
    change = SHAFT.mass * (velocity[-1] - velocity[0])
    middle = slice(1, -1)
    force = force_on_shaft(result)[middle]
    pushed = np.trapezoid(force, result.time[middle], axis=0)
    assert change == pytest.approx(pushed, abs=0.01 * float(np.abs(pushed).max()))
    assert np.abs(pushed).max() > 1e-3


def test_one_side_unloaded_and_back() -> None:
    """An axial load larger than the preload lifts the rollers of one bearing off; a load that turns round loads it again.

    Nothing holds the rollers that are lifted off; how they vibrate alters no loss, so that no warning is needed.
    """
    history = trb.History.table([0.0, 4e-3, 14e-3, 20e-3, 40e-3], [0.0, 12e3, 12e3, -12e3, -12e3])
    result = pair({"force_z": history}).run(duration=0.03)
    tight = pair({"force_z": history}, options={"accuracy": "reference"}).run(duration=0.03)
    for name in result:
        assert result[name].summary()["power_loss"] == pytest.approx(tight[name].summary()["power_loss"], rel=0.02)
    left, right = (one.outer_load.sum(axis=1) for one in result.values())
    first = int(np.searchsorted(result.time, 13e-3))
    assert result.success
    assert left[first] < 0.05 * left[0]
    assert right[first] > 3.0 * right[0]
    assert right[-1] < 0.05 * right[0]
    assert left[-1] > 3.0 * left[0]
    assert force_on_shaft(result)[first : first + 10, 2].mean() == pytest.approx(-12e3, rel=0.05)
    assert max(closures(result)) < 1e-3


def test_run_up_under_a_torque() -> None:
    """The shaft turns faster as a torque beyond friction says; energy adds up in each bearing and in the whole."""
    torque = 20.0
    result = pair({"torque": torque}, effects=Effects.standard().replace(gravity=False)).run(duration=0.01)
    speed = result["left"].shaft_speed
    friction = np.trapezoid(result["left"].inner_torque + result["right"].inner_torque, result.time)
    turned = torque * result.time[-1] - friction
    assert SHAFT.inertia_axial * (speed[-1] - speed[0]) == pytest.approx(turned, rel=0.01)
    assert speed[-1] > 1.05 * speed[0]
    assert result["right"].shaft_speed[-1] == pytest.approx(-speed[-1], rel=1e-12)
    assert max(closures(result)) < 1e-3
    assert result.energy.closure < 1e-3


def test_unbalance() -> None:
    """At 10 000 rpm an unbalance turns the shaft round its place; its force is that of the circling mass."""
    body = SHAFT.replace(unbalance=5e-5)
    result = pair({}, body=body, speed_rpm=10_000.0).run(duration=0.03)
    half = len(result.time) // 2
    force = force_on_shaft(result)[half:, 0]
    wanted = 5e-5 * (10_000.0 * np.pi / 30.0) ** 2
    assert np.std(force) * np.sqrt(2.0) == pytest.approx(wanted, rel=0.25)
    assert max(closures(result)) < 1e-3


def test_files(tmp_path: Path) -> None:
    """A run into a file gives the numbers of a run in memory, and each bearing in it is a result of its own."""
    kept = pair().run(duration=1e-3)
    path = tmp_path / "pair.h5"
    written = pair().run(duration=1e-3, output=path)
    assert list(tmp_path.iterdir()) == [path]
    assert written.shaft_position == pytest.approx(kept.shaft_position, rel=1e-9, abs=1e-15)
    for name, one in kept.items():
        again = trb.load(path, bearing=name)
        assert again.cage_position == pytest.approx(one.cage_position, rel=1e-6)
        assert written[name].outer_load == pytest.approx(one.outer_load, rel=1e-6)
        assert again.meta["assembly"]["bearing"] == name
    assert again.peaks["pocket_force_peak"].shape == one.peaks["pocket_force_peak"].shape
    for wrong in ("middle", "run", "left/run", ".."):
        with pytest.raises(FileError, match="no bearing of the name"):
            trb.load(path, bearing=wrong)
    assert list(trb.load(path)) == ["left", "right"]
    with pytest.raises(FileError, match="exists already"):
        pair().run(duration=1e-3, output=path)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.usefixtures("drawn_only")
def test_lives_of_a_pair_stand_in_its_report(tmp_path: Path) -> None:
    """Each bearing's lives by the loads of its run, and the life of both, as `trb.rating` has them; pressures in MPa."""
    result = pair({"force_x": 20e3}).run(duration=2e-3)
    found = trb.rating(result)
    own = [trb.rating(one).life_hours for one in result.values()]
    assert [one.life_hours for one in found.bearings.values()] == own
    assert found.life_hours == pytest.approx(sum(life ** (-27 / 20) for life in own) ** (-20 / 27), rel=1e-12)
    text = trb.report(result, tmp_path / "pair.html", pictures=[]).read_text(encoding="utf-8")
    lives = text.partition("<h2>Lives</h2>")[2].partition("</table>")[0]
    for life in (*own, found.life_hours):
        assert f">{life_text(life)}<".replace(">>", ">&gt;") in lives
    pressure = result.summary()["left"]["inner_pressure_max"]
    assert f"{1e-9 * pressure:.5g}" in str(result)
    assert "inner raceway, GPa" in str(result)


def test_records_are_evaluated_again() -> None:
    """With the ring where the shaft had it: loads, films and slip of both bearings, and a rating by the loads of the run."""
    load = 2000.0
    result = pair({"force_x": load}, shaft=STILL + np.array([1e-6, 0.0, 0.0, 2e-5, -1e-5])).run(duration=0.01)
    for one in result.values():
        again = Replay(one).record(len(one) - 1)
        for name in (
            "inner_load",
            "outer_load",
            "rib_load",
            "inner_film_parameter",
            "inner_slide_roll_ratio",
            "ring_force",
        ):
            if name in again:
                largest = np.abs(one[name][-1]).max()
                assert again[name] == pytest.approx(one[name][-1], abs=1e-5 * largest + 1e-12), name
        assert again["inner_torque"] == pytest.approx(one["inner_torque"][-1], rel=1e-4)
        assert "basic_life_hours" not in one.summary()  # its scene does not know what the shaft carries
    rated = trb.rating(result["left"])
    carried = np.linalg.norm(result["left"].ring_force[len(result.time) // 2 :, :2], axis=1).mean()
    assert rated.radial_load == pytest.approx(carried, rel=0.1)


def test_what_single_bearings_warn_of_is_said(tmp_path: Path) -> None:
    """Pressures that dent raceways, and scenes that can hardly be meant, with the bearing's name."""
    heavy = {"left": seat(displacement=(0.0, 0.0, -8e-4)), "right": seat(turned=True, shift=-1.6e-3)}
    with pytest.warns(UserWarning, match=r"left: .*GPa"):
        simulation = Simulation(Seating(heavy, SHAFT, np.array([0.0, 0.0, -8e-4, 0.0, 0.0])))
    result = simulation.run(duration=1e-4, output=tmp_path / "heavy.h5")
    for one in result.values():
        assert sum("ISO 76" in text for text in one.warnings) == 1
    (tmp_path / "other.h5").touch()
    with pytest.raises(FileError, match=r"other\.h5: the file exists already"):
        simulation.run(duration=1e-4, output=tmp_path / "other.h5")


def test_refused() -> None:
    with pytest.raises(InputError, match="first bearing has the shaft's axes"):
        Simulation(Seating({"left": seat(turned=True)}, SHAFT, STILL))
    wrong = seat(turned=True)
    for scene, text in (
        (wrong.scene.replace(speed_rpm=3000.0), r"seats\[1\]\.scene\.speed_rpm = 3000\.0 : must be -3000"),
        (wrong.scene.replace(gravity=WEIGHT), r"seats\[1\]\.scene\.gravity"),
        (wrong.scene.replace(start=Start.equal().replace(time=1.0)), r"start\.time = 1\.0 : must be 0"),
    ):
        with pytest.raises(InputError, match=text):
            Simulation(Seating({"left": seat(), "right": replace(wrong, scene=scene)}, SHAFT, STILL))
    with pytest.raises(InputError, match=r"loads\.force_q.*must be one of force_x"):
        pair({"force_q": 1.0})
    with pytest.raises(InputError, match=r"mass_offset.*each seat"):
        pair(body=SHAFT.replace(mass_offset=0.01))
    with pytest.raises(InputError, match=r"unbalance.*torque"):
        pair({"torque": 1.0}, body=SHAFT.replace(unbalance=1e-5))
    with pytest.raises(InputError, match="checkpoint_every"):
        Simulation(Seating({"left": seat()}, SHAFT, STILL), checkpoint_every=0.1).run(duration=1e-4)
    with pytest.raises(InputError, match="must be one of left"):
        pair().run(duration=1e-4)["middle"]
    with pytest.raises(InputError, match=r"revolutions"):
        pair().run()


def test_elastic_cages_on_one_shaft() -> None:
    """Cages with modes of their own, in a bearing that is turned, too: the energy of each bearing adds up."""
    seats = {}
    for name, count, turned in (("left", 8, False), ("right", 5, True)):
        changes = {"bearing.cage.body": trb.cases.cage_body_30310(), "elastic_cage": trb.ElasticCage(n_modes=count)}
        one = seat(turned=turned)
        seats[name] = replace(one, scene=one.scene.replace(changes | {"start": trb.Start.whirl(0.9)}))
    result = Simulation(Seating(seats, SHAFT, STILL)).run(duration=5e-3)
    assert [result[name]["cage_mode"].shape[1] for name in seats] == [8, 5]
    for one in result.values():
        assert np.abs(one["cage_mode"]).max() > 1e-8
        assert one["loss_vibration"][-1] > 0.0
        assert one.energy_closure < 1e-3


def test_a_blow_in_the_first_half_counts_in_the_lives_of_a_pair() -> None:
    """30 kN across for 1 ms in 5 ms: lives and static safety are those of the whole run, by Miner over the recorded loads."""
    blow = trb.History.step((0.001, 0.0015), (0.0, -30e3, 0.0), rise=4e-4)
    quiet = trb.load_assembly("pair_30310")
    struck = quiet.replace(loads=(*quiet.loads, trb.ShaftLoad(position=0.0, force=(0.0, blow, 0.0))))
    result = trb.Simulation(struck).run(duration=5e-3)
    found = trb.rating(result)
    for name, sheet in found.bearings.items():
        axial, radial = (np.abs(one) for one in result[name].ring_loads)
        loads = np.where(axial <= sheet.e * radial, radial, 0.4 * radial + sheet.Y * axial)
        turns = np.gradient(result[name].time)
        turns[[0, -1]] *= 0.5
        mean = np.average(loads ** (10.0 / 3.0), weights=turns) ** 0.3
        assert sheet.equivalent_load == pytest.approx(mean, rel=0.01)
        assert sheet.static_equivalent_load == pytest.approx(
            max(np.maximum(radial, 0.5 * radial + sheet.Y0 * axial)), rel=1e-6
        )
        assert "the whole run" in sheet.notes["life"]
