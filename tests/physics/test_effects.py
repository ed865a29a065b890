"""Every switch of a scene: what is off is not evaluated and leaves no trace, what is on is evaluated."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects, InputError
from trbdyn.model.scene import Start

PAPER = Effects.paper()
FILMS = ("film_nodes", "thermal_nodes", "traction_nodes", "rolling_nodes")

SWITCHES: dict[str, tuple[dict[str, Any], dict[str, Any], tuple[str, ...]]] = {
    "gravity": ({"gravity": True}, {"gravity": False}, ("gravity_bodies",)),
    "cage": ({"bodies": "rollers_and_cage"}, {"bodies": "rollers"}, ("pocket_tests", "pocket_nodes")),
    "spacer": ({"bodies": "rollers_and_spacer"}, {"bodies": "rollers_and_cage"}, ("spacers",)),
    "pocket_faces": (
        {"pocket_bars": True, "pocket_ends": True},
        {"pocket_bars": False, "pocket_ends": False},
        ("pocket_tests", "pocket_nodes"),
    ),
    "films": ({}, {"lubrication": "dry"}, FILMS),
    "films_boundary": ({}, {"lubrication": "boundary"}, FILMS),
    "thermal": ({"thermal": True}, {"thermal": False}, ("thermal_nodes",)),
    "traction": ({"traction": "muraki_kimura"}, {"traction": "none"}, ("traction_nodes",)),
    "traction_coulomb": ({"traction": "muraki_kimura"}, {"traction": "coulomb"}, ("traction_nodes",)),
    "coulomb": ({"traction": "coulomb"}, {"traction": "muraki_kimura"}, ("coulomb_nodes",)),
    "coulomb_dry": ({"lubrication": "dry"}, {"lubrication": "mixed"}, ("coulomb_nodes",)),
    "boundary": ({"lubrication": "boundary"}, {"lubrication": "full_film"}, ("boundary_nodes",)),
    "boundary_share": ({"starvation_factor": 0.1}, {"starvation_factor": 1.0}, ("boundary_nodes",)),
    "rolling_resistance": ({"rolling_resistance": True}, {"rolling_resistance": False}, ("rolling_nodes",)),
    "rolling_pressure_force": (
        {"rolling_pressure_force": True},
        {"rolling_pressure_force": False},
        ("pressure_force_nodes",),
    ),
    "back_rib": ({"back_rib": True}, {"back_rib": False, "planar": True}, ("rib_tests", "rib_contacts")),
    "front_rib": ({"front_rib": True}, {"front_rib": False}, ("front_rib_tests",)),
    "drag": ({"oil_fill": 0.1}, {"oil_fill": 0.0}, ("drag_rollers",)),
    "pocket_film": ({"pocket_film": 5e-5}, {"pocket_film": 0.0}, ("pocket_films",)),
    "pocket_film_dry": (
        {"pocket_film": 5e-5, "lubrication": "full_film"},
        {"pocket_film": 5e-5, "lubrication": "boundary"},
        ("pocket_films",),
    ),
    "guidance": ({"guidance": "inner_land"}, {"guidance": "rollers"}, ("land_films",)),
    "guidance_dry": (
        {"guidance": "outer_land", "lubrication": "dry"},
        {"guidance": "outer_land", "pocket_bars": False, "gravity": False},
        ("land_contacts",),
    ),
    "oil_height": ({"oil_height": 2e-5}, {"oil_height": 0.0}, ("meniscus_nodes",)),
    "flooded_gaps": ({"flooded_gaps": True}, {"flooded_gaps": False}, ("gap_nodes",)),
    "hysteresis": ({"hysteresis": 0.02}, {"hysteresis": 0.0}, ("hysteresis_nodes",)),
    "damping": ({"damping": "hunt_crossley"}, {"damping": "off"}, ("damping_nodes",)),
}


@pytest.mark.parametrize("name", SWITCHES)
def test_counters(kit: SimpleNamespace, name: str) -> None:
    on, off, counters = SWITCHES[name]
    for changes, wanted in ((on, True), (off, False)):
        result = kit.simulate(PAPER.replace(**changes)).run(duration=5e-4)
        assert result.success
        for counter in counters:
            assert (result.counters[counter] > 0) is wanted, (counter, changes, result.counters[counter])


def test_front_rib_contacts_are_counted(kit: SimpleNamespace) -> None:
    sim = kit.simulate(PAPER.replace(bodies="rollers", gravity=False))
    sim.set_state(kit.perturbed(sim, 1, back=2.5e-4))
    sim.run(duration=1e-5)
    assert sim.counters["front_rib_contacts"] > 0


def test_each_kind_of_pocket_face_is_left_out_alone(kit: SimpleNamespace) -> None:
    touched = {}
    for name, changes in {"both": {}, "bars": {"pocket_ends": False}, "ends": {"pocket_bars": False}}.items():
        sim, loads = kit.simulate(PAPER.replace(**changes)), []
        for axial in (-1e-5, 4e-4):
            vector = kit.perturbed(sim, 5)
            sim.view(vector)["cage_z"] = axial
            loads.append(sim.contacts(vector)["pocket_load"])
        touched[name] = (np.max(loads, axis=(0, 1)) > 0.0).tolist()
    assert touched == {
        "both": [True, True, True, True],
        "bars": [True, True, False, False],
        "ends": [False, False, True, True],
    }


def test_nothing_else_is_counted_twice(kit: SimpleNamespace) -> None:
    """A node of each loaded contact for every law that acts there, at each evaluation."""
    result = kit.simulate(PAPER.replace(rolling_pressure_force=True), integrator="bdf").run(duration=2e-3)
    count = result.counters
    assert count["raceway_nodes"] % (12 * 2) == 0
    assert count["rolling_nodes"] == count["pressure_force_nodes"] == count["raceway_nodes"]
    ribs = count["film_nodes"] - count["raceway_nodes"]
    # ribs are evaluated together, in lanes padded to a multiple of eight
    exact = count["exact_rollers"]
    assert count["tangent_rollers"] > 0
    assert count["rib_contacts"] <= ribs <= 16 * count["force_evaluations"]
    assert count["rib_tests"] == exact
    assert count["front_rib_tests"] in (exact, 2 * exact)


def test_looking_does_not_count(kit: SimpleNamespace) -> None:
    sim = kit.simulate(PAPER)
    before = sim.counters
    sim.record()
    sim.contacts()
    sim.derivative()
    assert sim.counters == before


@pytest.mark.parametrize("friction", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_planar_freezes_and_conserves(kit: SimpleNamespace, friction: bool) -> None:
    """Axial positions and tilts stay; without friction energy stays with them."""
    effects = (PAPER if friction else Effects.frictionless()).replace(planar=True)
    drift = {}
    for rtol in (1e-5, 1e-6):
        # every force exact: what is left of the drift is the steps' alone
        sim = kit.simulate(effects, scenery={"radial_load": 3000.0}, rings_share=0.0, **kit.tolerances(rtol))
        vector = sim.state.vector
        state = sim.view(vector)
        state["cage_v_x"], state["cage_v_y"], state["cage_omega_a"] = 0.5, -0.3, 20.0
        state["roller_v_r"] += np.random.default_rng(3).normal(0.0, 0.01, 12)
        sim.set_state(vector)
        result = sim.run(duration=6e-4, save_every=1e-4)
        after = sim.view()
        for name in ("z", "skew", "tilt", "v_z", "omega_n", "omega_t"):
            for body in ("roller", "cage"):
                np.testing.assert_allclose(after[f"{body}_{name}"], state[f"{body}_{name}"], atol=1e-15, err_msg=name)
        assert result.pocket_force.max() > 10.0
        np.testing.assert_allclose(np.ptp(result.roller_position[..., 2], axis=0), 0.0, atol=1e-15)
        np.testing.assert_allclose(np.ptp(result.cage_position[:, 2]), 0.0, atol=1e-15)
        residual = np.abs(result.energy_balance["residual"]).max()
        drift[rtol] = residual / result.kinetic_energy[0]
    assert drift[1e-6] < 1e-5
    assert drift[1e-6] < 0.3 * drift[1e-5]


def test_planar_orbit_keeps_angular_momentum(kit: SimpleNamespace) -> None:
    """A roller that nothing touches and that flies outward slows down in its orbit: L = m r v_t + It n_z^2 v_t/r stays, n_z
    the part along the bearing's axis of the roller's first transverse axis."""
    loose = Effects.frictionless().replace(planar=True, gravity=False, pocket_bars=False, pocket_ends=False)
    # the inner ring has gone
    sim = kit.simulate(loose.replace(front_rib=False), scenery={"displacement": (0.0, 0.0, 14e-3)})
    geometry, vector, random = sim.scene.bearing.geometry, sim.state.vector, np.random.default_rng(5)
    state = sim.view(vector)
    state["roller_r"], state["roller_z"], state["roller_v_r"] = -1.1e-3, 0.0, random.uniform(-3.0, 3.0, 12)
    state["roller_v_t"] = random.uniform(-1.0, 1.0, 12)
    rates = sim.view(sim.derivative(vector, 0.0))
    assert not sim.contacts(vector, 0.0)["force"].any()
    radius = geometry.roller_centre_radius + state["roller_r"]
    orbit = geometry.cage_speed_ratio * 3000.0 * np.pi / 30.0
    speed = state["roller_v_t"] + orbit * geometry.roller_centre_radius
    inertia = geometry.roller_inertia_transverse * np.sin(geometry.roller_axis_angle + state["roller_tilt"]) ** 2
    gained = (geometry.roller_mass * radius + inertia / radius) * rates["roller_v_t"]
    carried = (geometry.roller_mass - inertia / radius**2) * speed * state["roller_v_r"]
    assert np.abs(carried).min() > 1e-3
    np.testing.assert_allclose(gained + carried, 0.0, atol=1e-9 * np.abs(carried).max())


def test_rollers_without_a_cage(kit: SimpleNamespace) -> None:
    result = kit.simulate(PAPER.replace(bodies="rollers")).run(duration=5e-3)
    assert result.success
    assert "pocket_force" not in result
    for name in ("cage_force", "cage_velocity"):
        assert not result[name].any(), name
    with_cage = kit.simulate(PAPER).run(duration=1e-3)
    geometry, cage = with_cage.scene.bearing.geometry, with_cage.scene.bearing.cage
    orbit = geometry.cage_speed_ratio * with_cage.shaft_speed[0]
    turning = 0.5 * cage.inertia_axial * orbit**2
    assert with_cage.kinetic_energy[0] - result.kinetic_energy[0] == pytest.approx(turning, rel=1e-9)


def test_a_whirling_start_needs_a_cage(kit: SimpleNamespace) -> None:
    with pytest.raises(InputError, match="needs a cage"):
        kit.scene(PAPER.replace(bodies="rollers"), start=Start.whirl())


def test_gravity_off_is_gravity_zero(kit: SimpleNamespace) -> None:
    off = kit.simulate(PAPER.replace(gravity=False)).derivative()
    zero = kit.simulate(PAPER, scenery={"gravity": (0.0, 0.0, 0.0)}).derivative()
    np.testing.assert_array_equal(off, zero)


CHOICES = {
    "rib_film": (PAPER, PAPER.replace(rib_film="pe"), "rib_film_parameter"),
    "starvation": (PAPER, PAPER.replace(starvation_factor=0.5), "outer_film"),
    "thermal": (PAPER.replace(thermal=False), PAPER, "outer_film"),
    "traction": (PAPER, PAPER.replace(traction="coulomb"), "power_traction_outer"),
    "damping": (PAPER, PAPER.replace(damping="hunt_crossley"), "power_damping"),
}


@pytest.mark.parametrize("name", CHOICES)
def test_choices_change_what_they_name(kit: SimpleNamespace, name: str) -> None:
    one, other, quantity = CHOICES[name]
    vector = kit.perturbed(kit.simulate(PAPER), 9)
    first, second = (kit.simulate(effects).record(vector)[quantity] for effects in (one, other))
    assert not np.allclose(first, second, rtol=1e-3)
    if name in ("rib_film", "starvation", "thermal"):
        assert np.all(second <= first)


def test_edges_bound_the_faces(kit: SimpleNamespace) -> None:
    """Unbounded planes touch wherever bounded faces do, and beyond."""
    bounded, planes = (kit.simulate(PAPER.replace(pocket_edges=edges)) for edges in (True, False))
    vector = kit.perturbed(bounded, 5)
    near, far = (sim.contacts(vector)["pocket_interference"] for sim in (bounded, planes))
    assert np.all(far >= near - 1e-15)
    assert np.any(far > near + 1e-6)


def test_pockets_that_are_clear_are_counted_as_such() -> None:
    """Without gravity the cage floats between rollers that it does not touch: every face that is tested is proven clear."""
    scene = trb.cases.scene_30310(3000.0, 4930.0, effects=Effects.paper().replace(gravity=False, n_slices=4))
    simulation = trb.Simulation(scene.replace(start=trb.Start.equal()))
    for _ in range(30):
        simulation.step()
    assert not (simulation.record()["pocket_force"] > 0.0).any()
    count = simulation.counters
    faces = 12 * len(scene.bearing.pocket_of(0).faces)
    assert count["pocket_tests"] == count["pocket_culled"] >= faces * count["force_evaluations"]


def test_a_table_of_an_earlier_version_is_taken() -> None:
    """It has the coefficients of every law of damping, and lacks the newest fields."""
    table = Effects().to_dict()
    del table["hysteresis"], table["oil_height"], table["flooded_gaps"]
    assert Effects.from_dict(table) == Effects()
