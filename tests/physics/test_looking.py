"""What a look into a simulation shows: contacts with every intermediate quantity, records, states and their parts by name."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects, InputError, laws
from trbdyn.results import fields as field_table

LANES = (
    "interference",
    "load",
    "load_per_length",
    "half_width",
    "pressure",
    "mean_speed",
    "sliding_speed",
    "slide_roll",
    "film_elastic",
    "film_rigid",
    "thermal_factor",
    "film",
    "film_parameter",
    "friction_coefficient",
    "rolling",
)
POINTS = ("interference", "load", "pressure", "film", "film_parameter", "slide_roll", "friction_coefficient", "height")
WRENCHES = ("force", "moment", "ring_force", "ring_moment", "outer_force", "outer_moment", "cage_force", "cage_moment")


def test_contacts_have_their_shapes(kit: SimpleNamespace) -> None:
    found = kit.simulate(Effects.paper().replace(n_slices=17)).contacts()
    for name in LANES:
        assert found[f"raceway_{name}"].shape == (2, 12, 17), name
    for name in POINTS:
        assert found[f"rib_{name}"].shape == (12,), name
        assert found[f"front_rib_{name}"].shape == (12,), name
    for name in WRENCHES:
        assert found[name].shape == (12, 3), name
    for name in ("pocket_load", "pocket_friction", "pocket_interference"):
        assert found[name].shape == (12, 4), name
    assert found["power"].shape == (12, 8)
    assert all(values.dtype == np.float64 for values in found.values())


def test_intermediate_quantities_follow_from_each_other(kit: SimpleNamespace) -> None:
    """The chain of laws, each from the values before it."""
    sim = kit.simulate(Effects.paper().replace(starvation_factor=0.4))
    vector = kit.perturbed(sim, 4)
    found = {name.removeprefix("raceway_"): values for name, values in sim.contacts(vector).items()}
    loaded = found["load"] > 0.0
    assert 0.3 < loaded.mean() < 1.0

    def at(name: str) -> np.ndarray:
        return found[name][loaded]

    scene, modulus = sim.scene, sim.scene.bearing.geometry.effective_modulus
    length = scene.bearing.roller.effective_length
    weight = length / found["load"].shape[-1]
    per_length = 0.356 * modulus * length ** (-1.0 / 9.0) * at("interference") ** (10.0 / 9.0)
    np.testing.assert_allclose(at("load_per_length"), per_length, rtol=1e-10)
    np.testing.assert_allclose(at("load"), per_length * weight, rtol=1e-10)
    # a slice's sphere is the same at both races, as large as the roller there but for its profile
    sphere = found["reach"] + 0.5 * found["interference"]
    both = loaded.all(axis=0)
    np.testing.assert_allclose(sphere[0][both], sphere[1][both], rtol=1e-12)
    np.testing.assert_allclose(2.0 * sphere[:, both], scene.bearing.roller.diameter, rtol=0.1)
    radius = at("radius")
    half_width = np.sqrt(8.0 * per_length * radius / (np.pi * modulus))
    np.testing.assert_allclose(at("half_width"), half_width, rtol=1e-10)
    np.testing.assert_allclose(at("pressure"), 2.0 * per_length / (np.pi * half_width), rtol=1e-10)
    np.testing.assert_allclose(at("slide_roll"), at("sliding_speed") / at("mean_speed"), rtol=1e-12)
    speed = scene.lubricant.viscosity * at("mean_speed") / (modulus * radius)
    load, stiffness = per_length / (modulus * radius), scene.lubricant.pressure_coefficient * modulus
    elastic = 2.922 * load**-0.166 * speed**0.692 * stiffness**0.470 * radius
    np.testing.assert_allclose(at("film_elastic"), elastic, rtol=1e-10)
    np.testing.assert_allclose(at("film_rigid"), 4.9 * speed / load * radius, rtol=1e-10)
    film = 0.4 * at("thermal_factor") * np.maximum(at("film_elastic"), at("film_rigid"))
    np.testing.assert_allclose(at("film"), film, rtol=1e-12)
    np.testing.assert_allclose(at("film_parameter"), film / scene.bearing.roughness.raceway, rtol=1e-12)
    friction = scene.effects.friction
    share = laws.boundary_share(at("film_parameter"), friction.lambda_boundary, friction.lambda_full)
    boundary = laws.friction_boundary(
        at("slide_roll"), friction.boundary_limit, friction.boundary_slope, friction.boundary_decay
    )
    mixed = at("traction_coefficient") + share * (boundary - at("traction_coefficient"))
    np.testing.assert_allclose(at("friction_coefficient"), mixed, rtol=1e-9, atol=1e-15)


def test_records_have_their_fields(kit: SimpleNamespace) -> None:
    """Rigid cages have no modes, and tapered bearings no contacts of cylindrical ones."""
    table = {field.name: field for field in field_table.table()}
    scene = trb.Scene(trb.cases.bearing_nj210(), speed_rpm=3000.0, radial_load=4000.0, axial_load=500.0)
    tapered, cylindrical = kit.simulate(Effects.paper()).record(), trb.Simulation(scene).record()
    for record in (tapered, cylindrical):
        for name, values in record.items():
            assert values.shape == table[name].shape(*record["pocket_force"].shape), name
    assert set(cylindrical) == {name for name, field in table.items() if field.kind != "mode"}
    other = set(cylindrical) - set(tapered)
    assert {name for name in table if name.startswith(("outer_rib_", "outer_front_rib_"))} < other
    assert all("rib_" in name for name in other)
    assert "front_rib_load" in tapered


def test_records_sum_up_contacts(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.standard())
    vector = kit.perturbed(sim, 8)
    found, record = sim.contacts(vector), sim.record(vector)
    for side, name in enumerate(("outer", "inner")):
        np.testing.assert_allclose(record[f"{name}_load"], found["raceway_load"][side].sum(axis=-1), rtol=1e-12)
        # pressure counts where there is load
        pressure = np.where(found["raceway_load"][side] > 0.0, found["raceway_pressure"][side], 0.0)
        np.testing.assert_allclose(record[f"{name}_pressure"], pressure.max(axis=-1), rtol=1e-12)
    np.testing.assert_array_equal(record["pocket_force"], found["pocket_load"])
    np.testing.assert_allclose(record["power_loss"], found["power"].sum(), rtol=1e-12)
    np.testing.assert_allclose(record["elastic_energy"], found["elastic_energy"].sum(), rtol=1e-12)


def test_a_look_shows_nothing_of_the_look_before(kit: SimpleNamespace) -> None:
    """Rollers that have left their raceways, ribs and pockets have no trace of the contacts that they had."""
    effects = Effects.standard()
    sim, fresh = kit.simulate(effects), kit.simulate(effects)
    for seed in range(4):
        sim.contacts(kit.perturbed(sim, seed))
        sim.record(kit.perturbed(sim, seed))
        vector = kit.perturbed(sim, 10 + seed)
        sim.view(vector)["roller_r"][seed::3] -= 2e-4  # off the outer raceway
        sim.view(vector)["roller_z"][seed::3] += 5e-4  # and off the others
        looks = [(one.contacts(vector), one.record(vector)) for one in (sim, fresh)]
        for seen, wanted in zip(*looks, strict=True):
            for name, values in wanted.items():
                np.testing.assert_array_equal(seen[name], values, err_msg=name)
        assert (looks[0][0]["raceway_load"][0].sum(axis=-1) == 0.0).any()
        fresh = kit.simulate(effects)


def test_parts_of_a_state_are_views(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.paper())
    vector = sim.state.vector
    state = sim.view(vector)
    assert state["roller_r"].shape == (12,)
    assert state["cage_x"].shape == ()
    state["roller_skew"][3] = 1e-3
    state["cage_x"] = 2e-4
    assert np.count_nonzero(vector == 1e-3) == 1
    assert float(sim.view(vector)["cage_x"]) == 2e-4
    # the simulation's own state is not touched
    assert float(sim.view()["cage_x"]) != 2e-4
    covered = sum(state[name].size for name in state.names)
    assert covered == vector.size
    with pytest.raises(KeyError):
        _ = state["roller_colour"]


@pytest.mark.parametrize("name", ["roller_v_r", "roller_psi", "cage_tilt", "spin_angle"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_state_that_is_not_finite(kit: SimpleNamespace, name: str, value: float) -> None:
    """The complaint names the entry; the simulation stays where it is."""
    sim = kit.simulate(Effects.paper())
    sim.step()
    before, vector = sim.state, sim.state.vector
    part = sim.view(vector)[name]
    part[(2,) if part.ndim else ()] = value
    with pytest.raises(InputError) as caught:
        sim.set_state(vector)
    message = str(caught.value)
    if name.startswith("roller_"):
        assert "roller 2" in message
        assert name.removeprefix("roller_") in message
    elif name.startswith("cage_"):
        assert "cage" in message
        assert "tilt" in message
    assert "finite" in message
    assert sim.time == before.time
    np.testing.assert_array_equal(sim.state.vector, before.vector)


WRONG_STATES = (np.zeros(3), np.zeros((167, 1)), "state", 1.0, [[0.0] * 167])


def test_a_state_of_another_shape(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.paper())
    for state in (*WRONG_STATES, None):
        with pytest.raises(InputError, match="state"):
            sim.set_state(state)
    with pytest.raises(InputError, match="time"):
        sim.set_state(sim.state, time=float("nan"))


def test_looking_at_a_state_of_another_shape(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.paper())
    for state in WRONG_STATES:
        for look in (sim.record, sim.contacts, sim.derivative):
            with pytest.raises(InputError, match="state"):
                look(state)


def test_a_state_beyond_the_coordinates(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.paper())
    for name, value in (("roller_r", -0.05), ("roller_skew", 1.6), ("cage_skew", -1.6)):
        vector = sim.state.vector
        part = sim.view(vector)[name]
        part[(1,) if part.ndim else ()] = value
        with pytest.raises(InputError, match="beyond what the coordinates hold"):
            sim.set_state(vector)


def test_one_simulation_belongs_to_one_thread(kit: SimpleNamespace) -> None:
    """A second thread that touches a running simulation is told so or answered between two chunks; the run goes on."""
    sim, stop, running = kit.simulate(Effects.paper()), threading.Event(), threading.Event()

    def callback(_: object) -> bool:
        running.set()
        return stop.is_set()

    results = []
    thread = threading.Thread(
        target=lambda: results.append(sim.run(duration=100.0, save_every=1e-3, callback=callback))
    )
    thread.start()
    assert running.wait(60.0)
    refusal, until = "", time.monotonic() + 60.0
    # looks between two chunks of the run are answered; how soon one falls into a chunk is up to the scheduler
    while not refusal and time.monotonic() < until:
        try:
            sim.record()
        except RuntimeError as error:
            refusal = str(error)
    stop.set()
    thread.join(60.0)
    assert "another thread" in refusal
    assert results[0].message.startswith("ended by the callback")
