"""An inner ring that is free: its vibrations, its energy, its limits, runs that go on, and what is refused."""

from __future__ import annotations

import warnings
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import shared
from numpy.typing import NDArray
from shared import lost, missing

import trbdyn as trb
from trbdyn import Effects, History, InputError, RingBody, RotatingLoad, Scene, Simulation, Start
from trbdyn.run.replay import Replay
from trbdyn.statics.core_model import normal_contacts
from trbdyn.statics.equilibrium import EquilibriumSolver, nominal_angles

Array = NDArray[np.float64]

RING = RingBody.hollow_cylinder(mass=0.7, inner_diameter=0.05, outer_diameter=0.072, length=0.027)
ROTOR = RingBody.hollow_cylinder(mass=20.0, outer_diameter=0.08, length=0.1, mass_offset=0.003)
FRICTIONLESS = shared.FRICTIONLESS.replace(damping="hunt_crossley")


def scene_of(body: RingBody | None = RING, **given: Any) -> Scene:
    free = {} if body is None else {"ring": "free", "ring_body": body}
    return Scene(trb.cases.rig_30310(), **({"speed_rpm": 3000.0, "axial_load": 4930.0} | free | given))


def peaks_of(values: Array, step: float, near: float) -> float:
    """Frequency (Hz) of the largest part of a spectrum within 2 % of a frequency."""
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(values.size), 16 * values.size))
    frequencies = np.fft.rfftfreq(16 * values.size, step)
    inside = np.abs(frequencies - near) < 0.02 * near
    return float(frequencies[inside][np.argmax(spectrum[inside])])


@pytest.mark.parametrize("body", [RING, ROTOR])
def test_vibrations_have_the_frequencies_of_the_stiffness(body: RingBody) -> None:
    """sqrt(k/(m + m_r)), with what the rollers add; radial ones come with tilt, and split by gyroscopic moments. The rollers of
    the ring alone, 0.3 kg beside 0.7, do not quite follow it as in an equilibrium: it vibrates 0.6 to 1.3 % more slowly.
    """
    scene = scene_of(body, effects=FRICTIONLESS)
    modes = trb.stiffness(scene).modes(body)
    simulation = Simulation(scene, integrator="erk")
    vector = simulation.state.vector
    view = simulation.view(vector)
    view["inner_ring_v_x"], view["inner_ring_v_z"] = 1e-3, 1e-3
    simulation.set_state(vector)
    step = 1.0 / modes.frequencies[-1] / 8.0
    result = simulation.run(duration=40.0 / modes.frequencies[0], save_every=step)
    axial = float(modes.frequencies[np.argmax(np.abs(modes.shapes[:, 2]))])
    assert peaks_of(result["ring_position"][:, 2], step, axial) == pytest.approx(axial, rel=1e-2)
    for place in (0, 1):
        found = peaks_of(result["ring_position"][:, 0], step, float(modes.frequencies[place]))
        assert found == pytest.approx(modes.frequencies[place], rel=1.5e-2)


def test_a_support_carries_what_moves_the_shaft() -> None:
    """A shaft on the bearing and on the springs of its twin, which faces it: frequencies of both, and energy in the springs."""
    springs = trb.stiffness(scene_of(None)).springs
    matrix = trb.stiffness(scene_of(None)).matrix
    at = np.eye(5)
    at[0, 4], at[1, 3] = springs["position"], -springs["position"]
    alone = [springs[name] for name in ("radial", "radial", "axial", "tilt", "tilt")]
    assert (
        np.max(np.abs(at.T @ np.diag(alone) @ at - matrix) / np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))) < 1e-6
    )
    held = {f"support_{name}": springs[name] for name in ("radial", "axial", "tilt")}
    body = ROTOR.replace(**held, support_position=0.1 - springs["position"], mass_offset=0.05)
    scene = scene_of(body, effects=FRICTIONLESS)
    modes = trb.stiffness(scene).modes(body)
    free = trb.stiffness(scene).modes(ROTOR.replace(mass_offset=0.05))
    assert (modes.frequencies > 1.2 * free.frequencies)[:3].all()
    simulation = Simulation(scene, integrator="erk")
    vector = simulation.state.vector
    simulation.view(vector)["inner_ring_v_z"] = 1e-3
    simulation.set_state(vector)
    axial = float(modes.frequencies[np.argmax(np.abs(modes.shapes[:, 2]))])
    step = 1.0 / axial / 20.0
    result = simulation.run(duration=16.0 / axial, save_every=step)
    assert peaks_of(result["ring_position"][:, 2], step, axial) == pytest.approx(axial, rel=1e-2)


def test_rollers_add_mass() -> None:
    added = np.diag(trb.stiffness(scene_of(None)).roller_mass)
    assert added[2] == pytest.approx(0.2764, rel=1e-3)
    assert added[:2] == pytest.approx(0.0506, rel=2e-3)


def test_stiffness_is_the_slope_of_equilibria_and_symmetric() -> None:
    scene = scene_of(None, moment_x=10.0, moment_y=-5.0, radial_load=1500.0, axial_load=5000.0)
    found = trb.stiffness(scene)
    matrix = found.matrix
    assert np.max(np.abs(matrix - matrix.T) / np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))) < 1e-6
    angles, changes = nominal_angles(scene), np.zeros((5, 5))
    by = {"axial_load": 1.0, "radial_load": 1.0, "moment_x": 0.01, "moment_y": 0.01}
    force = np.zeros((5, 4))
    moved = np.zeros((5, 4))
    for column, (name, step) in enumerate(by.items()):
        ends = []
        for sign in (1.0, -1.0):
            other = scene.replace(**{name: getattr(scene, name) + sign * step})
            ends.append(EquilibriumSolver(normal_contacts(other), other, angles).solve(0.0).displacement)
        moved[:, column] = ends[0] - ends[1]
        force[[2, 1, 3, 4][column], column] = 2.0 * step * (-1.0 if name == "axial_load" else 1.0)
    changes = matrix @ moved
    scale = np.array([2.0, 2.0, 2.0, 0.02, 0.02])
    assert np.max(np.abs(changes - force) / scale[:, None]) < 1e-6


def test_unbalance_moves_the_ring_as_a_rotor() -> None:
    """m e W^2 over (K - W^2 M), within the tilt that comes with it."""
    body = ROTOR.replace(unbalance=2e-4, mass_offset=0.0)
    scene = scene_of(body, effects=FRICTIONLESS, speed_rpm=4000.0)
    stiff = trb.stiffness(scene)
    speed = 4000.0 * np.pi / 30.0
    inertia = np.diag([body.mass] * 3 + [body.inertia_transverse] * 2) + stiff.roller_mass
    gyro = np.zeros((5, 5))
    gyro[3, 4], gyro[4, 3] = body.inertia_axial * speed, -body.inertia_axial * speed
    push = body.unbalance * speed**2 * np.array([1.0, -1j, 0.0, 0.0, 0.0])
    predicted = np.linalg.solve(stiff.matrix - speed**2 * inertia + 1j * speed * gyro, push)
    result = Simulation(scene).run(duration=0.2, save_every=2e-4)
    late = result["time"] > 0.11  # six turns
    turned = np.exp(-1j * result["shaft_angle"][late])
    found = 2.0 * np.mean(result["ring_position"][late, 0] * turned)
    assert abs(found - predicted[0]) < 3e-2 * abs(predicted[0])


def test_energy_of_a_coast_down_a_run_up_and_a_drop_to_no_load() -> None:
    """A ring that coasts loses what the audit says; a torque puts in its work; without load the ring floats and comes back."""
    body = RingBody.hollow_cylinder(mass=2.0, outer_diameter=0.06, length=0.09)
    coast = Simulation(scene_of(body, torque=0.0, speed_rpm=1500.0, axial_load=2000.0)).run(
        duration=0.15, save_every=1e-3
    )
    assert coast["shaft_speed"][-1] < 0.7 * coast["shaft_speed"][0]
    assert abs(missing(coast)) < 1e-3 * lost(coast)
    kinetic = coast["kinetic_energy"]
    assert kinetic[0] - kinetic[-1] == pytest.approx(lost(coast), rel=1e-3)
    run_up = Simulation(scene_of(body, torque=9.0, speed_rpm=0.0, axial_load=3000.0)).run(duration=0.1, save_every=1e-3)
    assert run_up["shaft_speed"][-1] > 500.0
    assert abs(missing(run_up)) < 1e-3 * lost(run_up)
    assert run_up["work_shaft"][-1] == pytest.approx(
        9.0 * (run_up["shaft_angle"][-1] - run_up["shaft_angle"][0]), rel=1e-4
    )
    drop = History.step((0.005, 0.02), (3000.0, 0.0, 3000.0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it falls back upon its rollers, and dents them
        dropped = Simulation(scene_of(body, axial_load=drop)).run(duration=0.035, save_every=2e-4)
    loads = dropped["inner_load"].sum(axis=1)
    gone = (dropped["time"] > 0.012) & (dropped["time"] < 0.019)
    assert np.median(loads[gone]) < 0.1 * loads[0]
    assert dropped["ring_position"][-1, 2] == pytest.approx(dropped["ring_position"][0, 2], rel=0.15)


@pytest.mark.parametrize(("options", "off"), [({}, 0.05), ({"max_step": 1e-5}, 1e-3)])
def test_a_summary_says_up_to_which_frequency_vibrations_are_followed(options: dict[str, float], off: float) -> None:
    """After a small step of the load a ring swings at its natural frequency, or slower where the steps are too long for it."""
    body = RingBody.hollow_cylinder(mass=5.0, outer_diameter=0.06, length=0.1)
    scene = scene_of(body, effects=FRICTIONLESS, speed_rpm=300.0, axial_load=4930.0)
    natural = trb.stiffness(scene).modes(body).frequencies[:2].mean()
    loaded = scene.replace(radial_load=History.step(0.001, [0.0, 60.0], rise=2e-4))
    result = Simulation(loaded, **options).run(duration=0.05, save_every=1e-4)
    course = result["ring_position"][20:, 1]
    spectrum = np.abs(np.fft.rfft((course - course.mean()) * np.hanning(course.size), 32 * course.size))
    share = np.fft.rfftfreq(32 * course.size, 1e-4)[spectrum.argmax()] / natural - 1.0
    is_followed = result.summary()["followed_frequency"] > natural
    assert is_followed == bool(options)
    assert (abs(share) < off) if is_followed else (-2.0 * off < share < -0.01)


def test_a_heavy_ring_is_a_held_one() -> None:
    start = Start.whirl(0.5)
    held = Simulation(scene_of(None, start=start, effects=Effects.standard().replace(gravity=False)))
    heavy = RING.replace(mass=9e4, inertia_axial=1e3, inertia_transverse=1e3)
    free = Simulation(scene_of(heavy, start=start, effects=Effects.standard().replace(gravity=False)))
    runs = [simulation.run(duration=0.01, save_every=1e-3) for simulation in (held, free)]
    off = runs[1]["cage_position"] - runs[0]["cage_position"]
    assert np.max(np.abs(off)) < 2e-3 * trb.cases.rig_30310().cage.play_radial
    # two integrators, and single records of a cage that is hit
    assert runs[1]["inner_torque"] == pytest.approx(runs[0]["inner_torque"], rel=1.5e-2)


def test_a_run_from_a_state_goes_on_and_records_are_found_again() -> None:
    body = ROTOR.replace(support_radial=1e8, support_tilt=1e4, support_position=0.05)
    push = History.ramp(0.0, 0.005, 800.0, 1500.0)
    scene = scene_of(body, radial_load=push, torque=1.2, effects=Effects.standard())
    simulation = Simulation(scene)
    result = simulation.run(duration=0.01, save_every=1e-3)
    again = Simulation(scene.replace(start=Start.state(simulation.state)))
    for name in ("ring_force", "ring_position", "shaft_speed", "shaft_angle", "inner_load"):
        assert again.record()[name] == pytest.approx(simulation.record()[name], rel=1e-9, abs=1e-12), name
    for name in ("elastic_energy", "kinetic_energy"):  # of the support, too, which keeps its place
        assert again.record()[name] == pytest.approx(simulation.record()[name], rel=1e-9), name
    rates = [sim.derivative(simulation.state.vector, simulation.time) for sim in (again, simulation)]
    assert again.view(rates[0])["inner_ring_v_y"] == pytest.approx(
        simulation.view(rates[1])["inner_ring_v_y"], rel=1e-9
    )
    state = simulation.state
    with pytest.raises(InputError, match=r"start\.displacement .*must be given with a support"):
        scene.replace(start=Start.state(state.vector, time=state.time, shaft_angle=state.shaft_angle))
    record = Replay(result).record(-1)
    for name in ("ring_force", "ring_velocity", "ring_angular_velocity", "inner_load", "rib_load", "cage_force"):
        assert record[name] == pytest.approx(result[name][-1], rel=1e-5, abs=2e-4), name


def test_a_load_that_rotates_is_the_same_as_one_of_a_held_path() -> None:
    """Slow against the ring's vibrations: the free ring lies where the path of equilibria lies."""
    turning = {"rotating_load": RotatingLoad(400.0, frequency_hz=-20.0, direction_deg=30.0), "radial_load": 300.0}
    quiet = Effects.standard().replace(gravity=False)
    free = Simulation(scene_of(RING, effects=quiet, moment_x=0.0, moment_y=0.0, **turning))
    path = Simulation(scene_of(None, effects=quiet, ring="follows", moment_x=0.0, moment_y=0.0, **turning))
    runs = [simulation.run(duration=0.05, save_every=2.5e-3) for simulation in (free, path)]
    force = [run["ring_force"][4:, :2] for run in runs]
    assert np.max(np.abs(force[0] - force[1])) < 60.0
    place = [run["ring_position"][4:, :2] for run in runs]
    assert np.max(np.abs(place[0] - place[1])) < 0.1 * np.max(np.abs(place[1]))


def test_a_rotating_load_that_stands_is_a_radial_load() -> None:
    """With no turns for a turn of the shaft it has the direction that it begins with."""
    quiet = Effects.standard().replace(gravity=False)
    standing = Simulation(
        scene_of(RING, effects=quiet, rotating_load=RotatingLoad(400.0, turns=0.0, direction_deg=30.0))
    )
    radial = Simulation(scene_of(RING, effects=quiet, radial_load=400.0, radial_direction_deg=30.0))
    vector = radial.state.vector
    np.testing.assert_allclose(standing.derivative(vector), radial.derivative(vector), rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(standing.state.vector, vector, rtol=1e-9, atol=1e-12)


def test_every_number_of_the_ring_acts() -> None:
    """Rates of a ring that moves, with each number of it changed by a factor, as its equations say."""
    body = ROTOR.replace(unbalance=1e-3, unbalance_angle_deg=40.0, damping=50.0, damping_turns=0.2)
    still = Effects.standard().replace(gravity=False)
    turning = {"effects": still, "moment_x": 5.0, "radial_load": 300.0}

    def rates(changed: RingBody, **given: float) -> dict[str, float]:
        simulation = Simulation(scene_of(changed, **turning, **given))
        vector = Simulation(scene_of(body, **turning)).state.vector
        view = simulation.view(vector)
        view["inner_ring_v_x"], view["inner_ring_v_y"], view["inner_ring_omega_n"] = 0.3, -0.2, 0.5
        found = simulation.view(simulation.derivative(vector, 0.0))
        return {name: float(found[f"inner_ring_{name}"]) for name in ("v_x", "v_y", "omega_n", "omega_t", "omega_a")}

    plain, free = rates(body), rates(body.replace(unbalance=0.0))
    speed = 3000.0 * np.pi / 30.0
    push = 1e-3 * speed**2 / body.mass
    assert plain["v_x"] - free["v_x"] == pytest.approx(push * np.cos(np.radians(40.0)), rel=1e-6)
    assert plain["v_y"] - free["v_y"] == pytest.approx(push * np.sin(np.radians(40.0)), rel=1e-6)
    turned = rates(body.replace(unbalance_angle_deg=100.0))
    assert turned["v_x"] - free["v_x"] == pytest.approx(push * np.cos(np.radians(100.0)), rel=1e-6)
    assert rates(body.replace(mass=2.0 * body.mass))["v_x"] == pytest.approx(0.5 * plain["v_x"], rel=1e-9)
    assert rates(body.replace(damping=0.0))["v_x"] - plain["v_x"] == pytest.approx(50.0 * 0.3 / body.mass, rel=1e-6)
    undamped = rates(body.replace(damping_turns=0.0))["omega_n"] - plain["omega_n"]
    assert undamped == pytest.approx(0.2 * 0.5 / body.inertia_transverse, rel=1e-4)
    light = rates(body.replace(inertia_axial=0.5 * body.inertia_axial))
    turned_by = [
        rates(body.replace(unbalance=0.0, inertia_axial=factor * body.inertia_axial), torque=3.0)["omega_a"]
        for factor in (0.5, 1.0)
    ]
    assert abs(turned_by[1]) > 1.0
    assert turned_by[0] == pytest.approx(2.0 * turned_by[1], rel=1e-9)
    gyroscopic = body.inertia_axial * speed * 0.5 / body.inertia_transverse  # a turn about n precesses about t
    assert abs(light["omega_t"] - plain["omega_t"]) == pytest.approx(0.5 * gyroscopic, rel=1e-3)
    heavy = rates(body.replace(inertia_transverse=2.0 * body.inertia_transverse))
    assert heavy["omega_n"] == pytest.approx(0.5 * plain["omega_n"], rel=1e-6)
    for name, value in (("radial", 1e6), ("axial", 1e6), ("tilt", 1e4)):
        assert rates(body.replace(**{f"support_{name}": value})) == pytest.approx(plain), name  # nothing at the start
    assert rates(body.replace(support_position=0.1)) == plain
    shifted = rates(body.replace(mass_offset=body.mass_offset + 0.01))
    assert abs(shifted["omega_t"] - plain["omega_t"]) > 1.0


def test_pictures_of_a_ring() -> None:
    scene = scene_of(ROTOR.replace(unbalance=1e-4), radial_load=800.0)
    result = Simulation(scene, accuracy="fast").run(revolutions=2, save_every=1e-4)
    assert {"ring_orbit", "ring_motion"} <= set(trb.plot.drawable(result))
    ax = trb.plot.ring_spectrum(result, of="acceleration", along="z", orders=10.0)
    assert "acceleration" in ax.figure.get_suptitle()
    marked = [line.get_xdata()[0] for line in ax.lines[1:]]
    orders = trb.plot.ring_orders(result)
    assert marked == [order for order in orders.values() if order <= 10.0]
    assert orders["rollers over the outer ring"] + orders["rollers over the inner ring"] == pytest.approx(12.0)
    plt.close("all")
    for given, said in (({"of": "jerk"}, "must be one of"), ({"along": "r"}, "must be 'x', 'y' or 'z'")):
        with pytest.raises(InputError, match=said):
            trb.plot.ring_spectrum(result, **given)


def test_a_spectrum_of_too_few_records_says_that_it_folds() -> None:
    scene = scene_of(ROTOR.replace(unbalance=1e-4), radial_load=800.0)
    for save_every, folds in ((1e-4, False), (1e-3, True)):
        result = Simulation(scene, accuracy="fast").run(revolutions=3, save_every=save_every)
        ax = trb.plot.ring_spectrum(result, along="z")
        assert ("save more often" in ax.get_xlabel()) == folds
        plt.close("all")


def test_a_ring_that_leaves_its_bearing_is_said() -> None:
    """Without the back-face rib nothing holds the rollers along the cup: the ring went out by 6 mm without a word."""
    effects = Effects.standard().replace(bodies="rollers", gravity=False, back_rib=False)
    with pytest.warns(trb.RunWarning, match="nothing holds it there"):
        result = Simulation(scene_of(ROTOR, effects=effects)).run(duration=0.05, save_every=1e-3)
    assert not result.success
    assert "free inner ring is" in result.message
    # a run is looked at after each 2000 steps, in which the ring falls by some 40 mm here
    assert np.max(np.abs(result["ring_position"])) < 60e-3


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "no body": ({"ring_body": None}, r"ring_body .*must be given where ring = 'free'"),
    "a body of a held ring": ({"ring": "held"}, r"ring_body .*must not be given unless ring = 'free'"),
    "a torque on a held ring": (
        {"ring": "held", "ring_body": None, "torque": 1.0},
        r"torque .*must not be given unless",
    ),
    "a place": ({"displacement": (None, None, -1e-5)}, r"displacement .*must not be given where ring = 'free'"),
    "a misalignment": ({"misalignment_x": 1e-4}, r"misalignment_x .*must be 0 where ring = 'free'"),
    "a ring that rests": ({"unloaded": "rests"}, r"unloaded .*must be 'refused' where ring = 'free'"),
    "a load that turns its direction": (
        {"radial_load": 10.0, "radial_direction_deg": History.ramp(0, 1, 0, 90)},
        r"radial_direction_deg .*must be constant",
    ),
    "a torque and a speed in time": (
        {"torque": 1.0, "speed_rpm": History.ramp(0, 1, 0, 90)},
        r"speed_rpm .*must be a number with torque",
    ),
    "a load of the shaft's speed that changes": (
        {"torque": 1.0, "rotating_load": RotatingLoad(100.0)},
        r"rotating_load\.load .*ring_body\.unbalance",
    ),
    "a torque and an unbalance": (
        {"torque": 1.0, "ring_body": RING.replace(unbalance=1e-5)},
        r"ring_body\.unbalance .*must be 0 with torque",
    ),
    "no load at the start": ({"axial_load": 0.0}, r"axial_load .*must be > 0"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(name: str) -> None:
    given, said = REFUSED[name]
    with pytest.raises(InputError, match=said):
        scene_of(**given)


def test_bodies_that_cannot_be() -> None:
    with pytest.raises(InputError, match=r"ring_body\.inertia_axial .*must be <= 0\.002"):
        RingBody(mass=1.0, inertia_axial=3e-3, inertia_transverse=1e-3)
    with pytest.raises(InputError, match=r"ring_body\.mass .*must be > 0"):
        RingBody(mass=0.0, inertia_axial=1e-3, inertia_transverse=1e-3)
    with pytest.raises(InputError, match=r"inner_diameter .*must be from 0 to less than outer_diameter"):
        RingBody.hollow_cylinder(mass=1.0, inner_diameter=0.1, outer_diameter=0.08, length=0.1)
