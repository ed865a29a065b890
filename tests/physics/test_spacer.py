"""The cage as a spacer: even spacing, one orbit speed out of all tangential forces, energy, and what is refused."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from shared import lost, missing

import trbdyn as trb
from trbdyn import Assembly, Effects, History, InputError, Result, RingBody, Scene, ShaftLoad, Simulation, Start

Array = NDArray[np.float64]

SPACED = Effects(bodies="rollers_and_spacer")
BEARING = trb.cases.rig_30310()
RING = RingBody.hollow_cylinder(mass=0.7, inner_diameter=0.05, outer_diameter=0.072, length=0.027)


def scene_of(effects: Effects = SPACED, **given: Any) -> Scene:
    return Scene(BEARING, effects=effects, **({"speed_rpm": 2000.0, "axial_load": 4930.0} | given))


def closure(result: Result) -> float:
    """Energy that is missing over what was put in and lost."""
    return abs(missing(result)) / (
        abs(lost(result)) + float(np.ptp(result["kinetic_energy"] + result["elastic_energy"]))
    )


SCENES: dict[str, dict[str, Any]] = {
    "axial": {},
    "combined": {"radial_load": 5530.0},
    "drag": {"effects": SPACED.replace(oil_fill=0.1)},
    "planar": {"effects": SPACED.replace(planar=True)},
    "outer ring turns": {"outer_speed_rpm": -700.0},
    "runs up": {"speed_rpm": History(times=(0.0, 0.05), values=(500.0, 3000.0))},
    "follows": {"ring": "follows", "radial_load": History(times=(0.0, 0.02, 0.05), values=(0.0, 4000.0, 500.0))},
    "free": {
        "ring": "free",
        "ring_body": RING,
        "radial_load": History(times=(0.0, 0.01, 0.05), values=(0.0, 3e3, 1e3)),
    },
    "torque": {"ring": "free", "ring_body": RING, "torque": 4.0},
}


@pytest.mark.parametrize("name", SCENES)
def test_even_spacing_and_energy(name: str) -> None:
    """In every scene that the mechanism meets, rollers stay at even places and energies add up."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        # integrals of losses and works control no step: a run-up takes steps that are too long for them
        simulation = Simulation(scene_of(**SCENES[name]), max_step=1e-4)
        result = simulation.run(duration=0.05, save_every=2.5e-4)
    assert result.success
    assert result.counters["spacers"] > 0
    angles = result["roller_orbit_angle"] - 2.0 * np.pi * np.arange(BEARING.n_rollers) / BEARING.n_rollers
    assert np.max(np.abs(angles - angles[:, :1])) < 1e-12
    speeds = result["roller_orbit_speed"]
    assert np.max(np.abs(speeds - speeds[:, :1])) < 1e-9 * np.max(np.abs(speeds))
    assert closure(result) < 1e-4
    assert simulation.statistics["steps"] < 3000


def angular_momentum(simulation: Simulation, vector: Array) -> float:
    """Of the orbits of rollers and spacer about the bearing's axis."""
    record = simulation.record(vector, 0.0)
    radius = np.hypot(record["roller_position"][:, 0], record["roller_position"][:, 1])
    speed = float(record["roller_orbit_speed"][0])
    mass = BEARING.geometry.roller_mass
    return float((mass * np.sum(radius**2) + BEARING.cage.inertia_axial) * speed)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_speed_follows_from_all_tangential_forces(kit: Any, seed: int) -> None:
    """The angular momentum of all orbits changes by the moments of what acts on rollers along their orbits, and by nothing else.

    Contacts and the momentum's derivative, by differences along the motion, come from elsewhere than the equations.
    """
    simulation = Simulation(scene_of(effects=SPACED.replace(gravity=False)))
    vector = kit.perturbed(simulation, seed)
    simulation.set_state(vector)
    vector = simulation.state.vector
    rates = simulation.derivative(vector, 0.0)
    step = 1e-10
    slope = (
        angular_momentum(simulation, vector + step * rates) - angular_momentum(simulation, vector - step * rates)
    ) / (2.0 * step)
    record = simulation.record(vector, 0.0)
    radius = np.hypot(record["roller_position"][:, 0], record["roller_position"][:, 1])
    force = simulation.contacts(vector, 0.0)["force"]
    assert slope == pytest.approx(float(np.sum(radius * force[:, 1])), rel=1e-5)


def test_two_methods_agree(kit: Any) -> None:
    """BDF, which has the Jacobian of a spacer, and an explicit method, which needs none."""
    ends = []
    for integrator, rtol in (("bdf", 1e-7), ("erk", 1e-8)):
        simulation = Simulation(
            scene_of(radial_load=5530.0), integrator=integrator, max_order=5, **kit.tolerances(rtol)
        )
        assert simulation.run(duration=1e-4).success
        view = simulation.view(simulation.state.vector)
        ends.append([np.array(view[name]) for name in ("cage_omega_a", "roller_omega_a", "roller_v_t", "roller_r")])
    assert abs(float(ends[0][0])) > 1e-3
    for one, other, within in zip(*ends, (1e-6, 1e-5, 1e-7, 1e-12), strict=True):
        assert one == pytest.approx(other, abs=within)


def test_means_are_those_with_a_cage() -> None:
    """What the spacer is for: load, torque, film and speed of the set under axial load, at a small part of the steps."""
    found = {}
    for bodies in ("rollers_and_cage", "rollers_and_spacer"):
        simulation = Simulation(scene_of(effects=Effects(bodies=bodies), speed_rpm=3000.0))
        found[bodies] = simulation.run(revolutions=4).summary(), simulation.statistics["steps"]
    (cage, many), (spacer, few) = found["rollers_and_cage"], found["rollers_and_spacer"]
    assert few < 0.3 * many
    assert spacer["torque"] == pytest.approx(cage["torque"], rel=0.01)
    assert spacer["outer_load_mean"] == pytest.approx(cage["outer_load_mean"], rel=1e-3)
    assert spacer["film_parameter_inner"] == pytest.approx(cage["film_parameter_inner"], rel=5e-3)
    assert spacer["cage_slip"] == pytest.approx(cage["cage_slip"], abs=1e-4)


def test_a_run_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    scene = scene_of(radial_load=3000.0)
    whole = Simulation(scene).run(duration=0.02, save_every=1e-3, checkpoint_every=0.01)
    again = Simulation(scene).run(duration=0.02, save_every=1e-3, checkpoint_every=0.01)
    assert np.array_equal(whole.final_state, again.final_state)
    first = Simulation(scene)
    first.run(duration=0.01, save_every=1e-3)
    vector = first.state.vector
    first.set_state(vector)
    assert np.array_equal(first.state.vector, vector)
    onward = Simulation(scene.replace(start=Start.state(first.state)))
    assert np.array_equal(onward.state.vector, vector)


def test_a_state_of_rollers_that_orbit_alone_keeps_its_momentum() -> None:
    free = Simulation(scene_of(effects=Effects()))
    free.run(revolutions=0.5)
    record = free.record(free.state.vector, free.state.time)
    radius = np.hypot(record["roller_position"][:, 0], record["roller_position"][:, 1])
    mass, inertia = BEARING.geometry.roller_mass, BEARING.cage.inertia_axial
    momentum = mass * np.sum(radius**2 * record["roller_orbit_speed"]) + inertia * record["cage_angular_velocity"][2]
    held = Simulation(scene_of(start=Start.state(free.state)))
    assert angular_momentum(held, held.state.vector) == pytest.approx(float(momentum), rel=1e-6)


def test_bearings_on_a_shaft_have_spacers_by_the_same_mechanism() -> None:
    """One bearing with a spacer, one with a cage, on one free shaft; then both with spacers, at fewer steps."""
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    steps = []
    for second in ("rollers_and_cage", "rollers_and_spacer"):
        subject = Assembly.pair(
            BEARING,
            "back to back",
            spread=0.15,
            end_play=-20e-6,
            shaft=shaft,
            loads=(ShaftLoad(position=0.13, force=(300.0, -900.0, 0.0)),),
            speed_rpm=3000.0,
        )
        kinds = zip(subject.bearings, ("rollers_and_spacer", second), strict=True)
        ends = tuple(one.replace(effects=Effects(bodies=kind)) for one, kind in kinds)
        simulation = Simulation(subject.replace(bearings=ends))
        result = simulation.run(duration=0.01)
        assert result.success
        steps.append(simulation.statistics["steps"])
        for one in result.parts:
            speeds = one["roller_orbit_speed"]
            if one.scene.effects.bodies == "rollers_and_spacer":
                assert np.max(np.ptp(speeds, axis=1)) < 1e-9 * np.max(np.abs(speeds))
            assert closure(one) < 3e-4
    assert steps[1] < steps[0]


def test_what_needs_a_cage_is_refused_by_name() -> None:
    scene = scene_of()
    with pytest.raises(InputError, match="multirate"):
        Simulation(scene, integrator="multirate")
    with pytest.raises(InputError, match="even spacing"):
        scene.replace(start=Start.unequal(1))
    with pytest.raises(InputError, match="whirl"):
        scene.replace(start=Start.whirl(0.5))
    with pytest.raises(InputError, match="guidance"):
        SPACED.replace(guidance="inner_land")
    with pytest.raises(InputError, match="rollers_and_cage"):
        Simulation(scene).run(revolutions=1, until={"whirl_ratio": 0.01})
    with pytest.raises(InputError, match="rollers_and_cage"):
        trb.plan(scene, {"orbit_rms_over_cpr": 0.1})
    result = Simulation(scene).run(revolutions=0.2)
    assert "pocket_force_peak" not in result.summary()
    assert "orbit_rms_over_cpr" not in result.summary()
    with pytest.raises(InputError, match="has no cage"):
        trb.plot.cage_locus(result)


def test_rollers_that_slide_are_said() -> None:
    """Below the least load a cage's pockets make most of the loss: a run without them says what it leaves out."""
    with pytest.warns(trb.RunWarning, match="a spacer leaves out"):
        Simulation(scene_of(speed_rpm=3000.0, axial_load=400.0)).run(revolutions=4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Simulation(scene_of(speed_rpm=3000.0)).run(revolutions=1)


@pytest.mark.parametrize(
    "scene",
    [
        # with a cage these lose 4.4 and 3.7 % more
        scene_of(speed_rpm=1000.0, radial_load=18e3),
        Scene(trb.Bearing.named("32208"), speed_rpm=2000.0, axial_load=2500.0, radial_load=9500.0, effects=SPACED),
        # all rollers outside of the zone of a radial load have the same lack, whatever the bearing
        Scene(trb.cases.bearing_nj210(), speed_rpm=2000.0, axial_load=100.0, radial_load=5000.0, effects=SPACED),
    ],
)
def test_unloaded_rollers_are_said(scene: Scene) -> None:
    """They roll as well as the others here, but a cage would have to drive them."""
    with pytest.warns(trb.RunWarning, match="of .* rollers carry no load at the inner raceway"):
        Simulation(scene).run(duration=2e-3)
