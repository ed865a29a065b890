"""An outer ring that moves with its housing: its vibrations, what its support carries, energy, limits, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import shared
from numpy.typing import NDArray
from shared import Cut, cut_after

import trbdyn as trb
from trbdyn import Assembly, Effects, History, Housing, InputError, RingBody, Scene, Shaft, ShaftLoad, Simulation, Start
from trbdyn.extras.design.planning.probes import carried_over
from trbdyn.run.replay import Replay

Array = NDArray[np.float64]

HOUSING = Housing.hollow_cylinder(
    mass=9.0, inner_diameter=0.11, outer_diameter=0.17, length=0.06, mass_offset=0.004
).replace(support_radial=3e8, support_axial=2e8, support_tilt=4e5, support_position=0.01)
ROTOR = RingBody.hollow_cylinder(mass=6.0, outer_diameter=0.06, length=0.1)
FRICTIONLESS = shared.FRICTIONLESS


def scene_of(housing: Housing | None = HOUSING, rotor: RingBody | None = None, **given: Any) -> Scene:
    free = {} if rotor is None else {"ring": "free", "ring_body": rotor}
    usual = {"speed_rpm": 3000.0, "axial_load": 4930.0, "radial_load": 800.0, "housing": housing}
    return Scene(trb.cases.rig_30310(), **(usual | free | given))


def strongest(values: Array, step: float, near: float) -> float:
    """Frequency (Hz) of the largest part of a spectrum within 4 % of a frequency."""
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(values.size), 16 * values.size))
    frequencies = np.fft.rfftfreq(16 * values.size, step)
    inside = np.abs(frequencies - near) < 0.04 * near
    return float(frequencies[inside][np.argmax(spectrum[inside])])


@pytest.mark.parametrize(("times", "tolerance"), [pytest.param(7.0, 4e-3, marks=pytest.mark.slow), (1.0, 1.6e-2)])
def test_vibrations_have_the_frequencies_of_springs_and_bearing(times: float, tolerance: float) -> None:
    """A housing vibrates as a shaft of its mass on the same springs would: the bearing knows how far its rings are apart.

    The rollers, 0.3 kg, go with the shaft more than with the housing; beside 63 kg that is 0.25 %, beside 9 kg 1.5 %.
    """
    heavy = HOUSING.replace(
        **{name: times * getattr(HOUSING, name) for name in ("mass", "inertia_axial", "inertia_transverse")}
    )
    scene = scene_of(heavy, effects=FRICTIONLESS, moment_x=0.0, moment_y=0.0)
    numbers = {name: getattr(heavy, name) for name in Housing.model_fields}
    modes = trb.stiffness(scene.replace(housing=None)).modes(RingBody(**numbers), gyroscopic=False)
    simulation = Simulation(scene, integrator="erk", accuracy="reference")
    vector = simulation.state.vector
    view = simulation.view(vector)
    view["outer_ring_v_x"], view["outer_ring_v_z"] = 1e-3, 1e-3
    simulation.set_state(vector)
    step = 1.0 / modes.frequencies[-1] / 8.0
    result = simulation.run(duration=60.0 / modes.frequencies[0], save_every=step)
    axial = float(modes.frequencies[np.argmax(np.abs(modes.shapes[:, 2]))])
    assert strongest(result["housing_position"][:, 2], step, axial) == pytest.approx(axial, rel=tolerance)
    sideways = float(modes.frequencies[np.argmax(np.abs(modes.shapes[:, 0]))])
    assert strongest(result["housing_position"][:, 0], step, sideways) == pytest.approx(sideways, rel=tolerance)


def test_the_support_carries_the_load_of_the_start_and_its_springs_what_comes() -> None:
    """Under a steady load the housing stays near its nominal place; what comes later moves it by the load over the stiffness."""
    damped = HOUSING.replace(damping=4e3, damping_turns=20.0)
    steady = Simulation(scene_of(damped)).run(revolutions=3)
    assert np.abs(steady["housing_position"]).max() < 0.1e-6
    weight = 9.80665 * HOUSING.mass
    later = History.ramp(0.005, 0.010, 4930.0, 7930.0)
    more = Simulation(
        scene_of(damped, ROTOR, axial_load=later, gravity=(0.0, History.ramp(0.005, 0.010, 0.0, -9.80665), 0.0))
    )
    result = more.run(duration=0.06, save_every=1e-4)
    moved = result["housing_position"][-200:].mean(axis=0) - result["housing_position"][:40].mean(axis=0)
    assert moved[2] == pytest.approx(-3000.0 / HOUSING.support_axial, rel=1e-2)
    # the rotor's weight comes to that of the housing
    place = moved[1] + HOUSING.support_position * result["housing_tilt"][-200:, 0].mean() * -1.0
    assert place == pytest.approx(-(weight + 9.80665 * ROTOR.mass) / HOUSING.support_radial, rel=0.05)


OF_ENERGY: dict[str, dict[str, Any]] = {
    "held": {},
    "free": {"rotor": ROTOR.replace(unbalance=2e-4), "radial_load": History.ramp(0.002, 0.004, 800.0, 1500.0)},
    "turning": {"outer_speed_rpm": -1500.0, "effects": Effects.standard()},
    "run up": {"rotor": ROTOR, "torque": 4.0, "speed_rpm": 600.0},
    "land": {"effects": Effects.standard().replace(guidance="outer_land"), "start": Start.whirl(0.2)},
    "shaken": {"gravity": (0.0, History.harmonic(-9.80665, 200.0, frequency_hz=300.0), 0.0)},
    "placed": {"radial_load": 0.0, "axial_load": 0.0, "displacement": (5e-6, None, -25e-6)},
}


@pytest.mark.parametrize("name", OF_ENERGY)
def test_energy(name: str) -> None:
    housing = HOUSING.replace(damping=500.0, damping_turns=2.0)
    result = Simulation(scene_of(housing, **OF_ENERGY[name])).run(duration=0.02, save_every=2e-4)
    assert result.success, result.message
    assert result.energy_closure < 1e-3
    assert result["loss_support"][-1] > 0.0
    assert np.abs(result["housing_position"]).max() > 1e-9


def test_forces_on_both_rings_are_those_on_the_rollers() -> None:
    """What rollers and cage take from one ring they give to the other, but for their weight, in the mean."""
    result = Simulation(scene_of(HOUSING.replace(damping=500.0), ROTOR)).run(revolutions=8)
    rolling = result.scene.bearing.geometry.roller_mass * result.scene.bearing.n_rollers
    weight = 9.80665 * (rolling + result.scene.bearing.cage.mass)
    half = len(result) // 2
    both = (result["housing_force"] + result["ring_force"])[half:].mean(axis=0)
    assert both[1] == pytest.approx(-weight, rel=0.1)
    assert np.abs(both[[0, 2]]).max() < 0.5
    # about the roller-centre plane, where the inner ring has no moment in the mean
    moment = result["housing_moment"][half:].mean(axis=0)
    assert np.abs(moment[:2]).max() < 0.3
    assert moment[2] == pytest.approx(result["outer_torque"][half:].mean(), rel=1e-3)


def test_a_heavy_housing_stands_still() -> None:
    start = Start.whirl(0.5)
    effects = Effects.standard().replace(gravity=False)
    heavy = Housing(mass=9e4, inertia_axial=1e3, inertia_transverse=1e3)
    runs = [
        Simulation(scene_of(housing, effects=effects, start=start)).run(duration=0.01, save_every=1e-3)
        for housing in (None, heavy)
    ]
    off = runs[1]["cage_position"] - runs[0]["cage_position"]
    assert np.abs(off).max() < 2e-3 * trb.cases.rig_30310().cage.play_radial
    assert runs[1]["inner_torque"] == pytest.approx(runs[0]["inner_torque"], rel=1e-2)
    assert np.abs(runs[1]["housing_position"]).max() < 1e-7
    assert "housing" in runs[1].groups
    assert "housing" not in runs[0].groups


@pytest.mark.parametrize("rotor", [None, ROTOR])
def test_a_run_from_a_state_repeats_the_bits_of_a_run_begun_again_there(rotor: RingBody | None) -> None:
    """What the housing's support carries is what it carried in the run that the state is of."""
    scene = scene_of(HOUSING, rotor, start=Start.whirl(0.7))
    simulation = Simulation(scene, accuracy="fast")
    simulation.run(duration=3.1e-3, save_every=1e-3)
    state = simulation.state
    again = Simulation(scene.replace(start=Start.state(state)), accuracy="fast")
    simulation.set_state(state)
    for _ in range(20):
        np.testing.assert_array_equal(again.derivative(), simulation.derivative())
        again.step()
        simulation.step()
    np.testing.assert_array_equal(again.state.vector, simulation.state.vector)


@pytest.mark.parametrize("rotor", [None, ROTOR])
def test_a_run_from_a_state_goes_on_and_records_are_found_again(rotor: RingBody | None) -> None:
    scene = scene_of(HOUSING.replace(damping=300.0), rotor, start=Start.whirl(0.7))
    simulation = Simulation(scene)
    result = simulation.run(duration=0.01, save_every=1e-3)
    state = simulation.state
    again = Simulation(scene.replace(start=Start.state(state)))
    for name in (
        "housing_force",
        "housing_position",
        "housing_velocity",
        "outer_load",
        "elastic_energy",
        "kinetic_energy",
    ):
        assert again.record()[name] == pytest.approx(simulation.record()[name], rel=1e-9, abs=1e-12), name
    rates = [sim.derivative(state.vector, state.time) for sim in (again, simulation)]
    for name in ("v_x", "v_y", "v_z", "omega_n", "omega_t"):  # with what the support holds
        one, other = (
            sim.view(rate)[f"outer_ring_{name}"] for sim, rate in zip((again, simulation), rates, strict=True)
        )
        assert one == pytest.approx(other, rel=1e-6, abs=1e-4), name
    with pytest.raises(InputError, match=r"start\.displacement .*must be given with a housing"):
        scene.replace(start=Start.state(state.vector, time=state.time, shaft_angle=state.shaft_angle))
    replay = Replay(result)
    record = replay.record(-1)
    for name in (
        "housing_force",
        "housing_velocity",
        "housing_angular_velocity",
        "outer_load",
        "rib_load",
        "cage_force",
    ):
        assert record[name] == pytest.approx(result[name][-1], rel=1e-5, abs=2e-4), name
    with pytest.raises(InputError, match="must have the recorded group 'housing'"):
        Replay(result.select(("cage", "rollers", "ring")))


def test_states_are_handed_on_with_where_the_ring_stood(tmp_path: Path) -> None:
    """By checkpoints, and by plans, which go on from a state with other switches."""
    scene = scene_of(HOUSING.replace(damping=300.0), start=Start.whirl(0.7))
    whole = Simulation(scene).run(duration=0.012, save_every=1e-3, checkpoint_every=0.004, output=tmp_path / "whole.h5")

    path = tmp_path / "cut.h5"
    with pytest.raises(Cut):
        Simulation(scene).run(
            duration=0.012, save_every=1e-3, checkpoint_every=0.004, output=path, callback=cut_after(0.007)
        )
    again = trb.resume(path)
    assert np.array_equal(again["housing_position"], whole["housing_position"])
    simulation = Simulation(scene)
    simulation.run(duration=0.004)
    bare = scene.replace(effects=scene.effects.replace(bodies="rollers"), start=Start.equal())
    there = carried_over(bare, Start.state(simulation.state), scene)
    assert there.start.displacement == pytest.approx(simulation.state.displacement)
    assert Simulation(there).record()["housing_position"] == pytest.approx(
        simulation.record()["housing_position"], abs=1e-15
    )


@pytest.mark.slow
@pytest.mark.parametrize("rotor", [None, ROTOR.replace(support_radial=1e8)])
def test_a_plan_knows_springs(rotor: RingBody | None) -> None:
    plan = trb.plan(scene_of(HOUSING, rotor), want={"torque": 0.05}, effort=10.0)
    assert plan.promised["torque"] < 0.05


def test_every_number_of_the_housing_acts() -> None:
    body = HOUSING.replace(damping=50.0, damping_turns=0.2)

    def rates(changed: Housing) -> dict[str, float]:
        simulation = Simulation(scene_of(changed, effects=FRICTIONLESS))
        vector = simulation.state.vector
        view = simulation.view(vector)
        view["outer_ring_v_x"], view["outer_ring_omega_n"] = 0.3, 0.5
        view["outer_ring_x"], view["outer_ring_z"], view["outer_ring_skew"] = 2e-6, 1e-6, 1e-5
        found = simulation.view(simulation.derivative(vector, 0.0))
        return {name: float(found[f"outer_ring_{name}"]) for name in ("v_x", "v_y", "v_z", "omega_n", "omega_t")}

    plain = rates(body)
    assert rates(body.replace(mass=2.0 * body.mass))["v_x"] == pytest.approx(0.5 * plain["v_x"], rel=1e-6)
    assert rates(body.replace(damping=0.0))["v_x"] - plain["v_x"] == pytest.approx(50.0 * 0.3 / body.mass, rel=1e-5)
    undamped = rates(body.replace(damping_turns=0.0))["omega_n"] - plain["omega_n"]
    assert undamped == pytest.approx(0.2 * 0.5 / body.inertia_transverse, rel=1e-4)
    heavy = rates(body.replace(inertia_transverse=2.0 * body.inertia_transverse))
    assert heavy["omega_n"] == pytest.approx(0.5 * plain["omega_n"], rel=1e-6)
    softer = rates(body.replace(support_axial=0.5 * body.support_axial))
    assert softer["v_z"] - plain["v_z"] == pytest.approx(0.5 * body.support_axial * 1e-6 / body.mass, rel=1e-2)
    for name, of in (
        ("support_radial", "v_x"),
        ("support_tilt", "omega_n"),
        ("support_position", "v_y"),
        ("mass_offset", "omega_t"),
    ):
        changed = rates(body.replace(**{name: 1.5 * getattr(body, name)}))
        assert abs(changed[of] - plain[of]) > 1e-3 * max(1.0, abs(plain[of])), name


def test_housings_on_one_shaft(tmp_path: Path) -> None:
    """Each outer ring of a pair in a housing of its own: energy of both, momentum, and the file."""
    shaft = Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    load = ShaftLoad(position=0.02, force=(0.0, History.ramp(0.002, 0.004, 0.0, 3000.0), 500.0))
    made = Assembly.pair(
        trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=3000.0, loads=[load]
    )
    housings = (HOUSING.replace(damping=500.0), HOUSING.replace(support_radial=1e8, damping=900.0))
    bearings = tuple(one.replace(housing=housing) for one, housing in zip(made.bearings, housings, strict=True))
    result = trb.Simulation(made.replace(bearings=bearings)).run(duration=0.02, output=tmp_path / "pair.h5")
    for one, housing in zip(result.values(), housings, strict=True):
        assert one.energy_closure < 1e-3
        late = slice(-len(one) // 4, None)
        change = one["housing_force"][late].mean(axis=0) - one["housing_force"][0]
        place = one["housing_position"][late].mean(axis=0)
        tilt = one["housing_tilt"][late].mean(axis=0)
        lever = housing.support_position
        springs = np.array([housing.support_radial] * 2 + [housing.support_axial])
        moved = place + lever * np.array([tilt[1], -tilt[0], 0.0])
        assert springs * moved == pytest.approx(change, rel=0.08, abs=15.0)
    again = trb.load(tmp_path / "pair.h5")
    assert np.array_equal(again["left"]["housing_position"], result["left"]["housing_position"])
    assert Replay(again["right"]).record(-1)["housing_force"] == pytest.approx(
        result["right"]["housing_force"][-1], rel=1e-4, abs=1e-2
    )
    loose = tuple(
        one.replace(housing=housing.replace(support_axial=0.0)) for one, housing in zip(bearings, housings, strict=True)
    )
    with pytest.raises(
        InputError, match=r"bearings\[0\]\.housing\.support_axial .*must be > 0 in one bearing at least"
    ):
        made.replace(bearings=loose)


def test_an_outer_ring_on_a_spring_slides_to_the_next_equilibrium() -> None:
    """The gear pushes the shaft away from the sprung bearing: the spring's ring follows by what the equilibria say."""
    shaft = Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    load = ShaftLoad(position=0.02, force=(0.0, 500.0, History.ramp(0.004, 0.012, 0.0, -1500.0)))
    made = Assembly.pair(
        trb.cases.rig_30310(), "back to back", spread=0.15, shaft=shaft, speed_rpm=3000.0, loads=[load]
    )
    left, right = made.bearings
    sliding = Housing.hollow_cylinder(mass=0.5, inner_diameter=0.08, outer_diameter=0.11, length=0.023)
    sliding = sliding.replace(support_radial=1e9, support_axial=2e7, support_tilt=1e6, damping=2e3)
    right = right.replace(spring=trb.PreloadSpring(force=2000.0, stiffness=2e7), housing=sliding)
    sprung = made.replace(bearings=(left, right))
    result = trb.Simulation(sprung).run(duration=0.03)
    way = np.diff([trb.equilibrium(sprung, time=time).outer_ring_places[1] for time in (0.0, 0.03)])[0]
    assert abs(way) > 5e-6
    found = result["right"]["housing_position"][-len(result.time) // 5 :, 2].mean()
    assert found == pytest.approx(-way, rel=0.06)  # friction of the rollers takes a few newtons
    assert max(one.energy_closure for one in result.values()) < 1e-3
    with pytest.raises(InputError, match=r"housing\.support_axial .*must be 2e\+07, the stiffness of the spring"):
        right.replace(housing=sliding.replace(support_axial=1e7))


def test_pictures() -> None:
    result = Simulation(scene_of(HOUSING, ROTOR), accuracy="fast").run(revolutions=2, save_every=1e-4)
    assert {"ring_orbit", "housing_motion"} <= set(trb.plot.drawable(result))
    held = Simulation(scene_of(None), accuracy="fast").run(revolutions=1)
    assert "housing_motion" not in trb.plot.drawable(held)
    for given, said in (({"ring": "middle"}, "must be 'inner' or 'outer'"), ({"ring": "outer"}, "housing")):
        with pytest.raises(InputError, match=said):
            trb.plot.ring_orbit(held, **given)
    plt.close("all")


def test_a_housing_that_leaves_its_bearing_is_said() -> None:
    """The support without stiffness keeps its 4930 N; a machine that falls pulls harder."""
    falls = History.ramp(0.001, 0.002, 0.0, -5000.0)
    scene = scene_of(Housing(mass=2.0, inertia_axial=5e-3, inertia_transverse=4e-3), gravity=(0.0, 0.0, falls))
    with pytest.warns(trb.RunWarning, match="nothing holds it there"):
        result = Simulation(scene, accuracy="fast").run(duration=0.2, save_every=1e-3)
    assert not result.success
    assert "free outer ring is" in result.message
    assert "a support of housing" in result.message


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "a ring that follows": ({"ring": "follows"}, r"ring .*must be 'held' or 'free' with a housing"),
    "nothing holds both rings": (
        {"rotor": ROTOR, "housing": HOUSING.replace(support_radial=0.0)},
        r"housing\.support_radial .*must be > 0 where ring = 'free'",
    ),
    "nothing holds both along the axis": (
        {"rotor": ROTOR, "housing": HOUSING.replace(support_axial=0.0)},
        r"housing\.support_axial .*must be > 0",
    ),
}


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"gravity": (0.0, History.harmonic(-9.8, 300.0, frequency_hz=50.0), 0.0)}, r"gravity\[1\]"),
        ({"speed_rpm": History.ramp(0.0, 0.01, 500.0, 3000.0)}, "speed_rpm"),
    ],
)
def test_a_state_does_not_know_what_the_support_carried_first(changes: dict[str, Any], field: str) -> None:
    """Without it such a run went on with 300 m/s2 of the housing that were not there before."""
    scene = scene_of(HOUSING, ROTOR, **changes)
    begun = Start.state(Simulation(scene).state)
    with pytest.raises(InputError, match=rf"{field} .*must be constant in a run from a state with a housing"):
        scene.replace(start=begun.replace(housing_load=None))
    there = Simulation(scene.replace(start=begun))
    assert there.derivative() == pytest.approx(Simulation(scene).derivative(), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", REFUSED)
def test_refused(name: str) -> None:
    given, said = REFUSED[name]
    with pytest.raises(InputError, match=said):
        scene_of(**given)
    held_by_the_other = HOUSING.replace(support_radial=0.0)
    scene_of(held_by_the_other, ROTOR.replace(support_radial=1e8))


def test_bodies_that_cannot_be() -> None:
    with pytest.raises(InputError, match=r"housing\.inertia_axial .*must be <= 0\.002"):
        Housing(mass=1.0, inertia_axial=3e-3, inertia_transverse=1e-3)
    with pytest.raises(InputError, match=r"housing\.mass .*must be > 0"):
        Housing(mass=0.0, inertia_axial=1e-3, inertia_transverse=1e-3)
    with pytest.raises(InputError, match=r"housing\.support_axial .*must be >= 0"):
        HOUSING.replace(support_axial=-1.0)
