"""Surfaces off their true form: depths that rollers feel, forces from the elastic energy, energy audits, frequencies, and what is
refused."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shared
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import Assembly, DepthMap, Effects, InputError, Pit, RingBody, Scene, Shaft, ShaftLoad, Simulation, Waviness
from trbdyn.model.contact_line import stations
from trbdyn.model.defect_rows import felt
from trbdyn.model.defects import Defect, On
from trbdyn.plot import ring_orders
from trbdyn.results import observables
from trbdyn.run.case_text import case_text
from trbdyn.run.replay import Replay
from trbdyn.run.toml_case import case_from_dict

Array = NDArray[np.float64]

FRICTIONLESS = shared.FRICTIONLESS.replace(damping="off")
SURFACES: tuple[On, ...] = ("outer", "inner", "roller")


def pit(on: On, **given: Any) -> Pit:
    return Pit(**({"on": on, "length": 2e-3, "width": 9e-3, "depth": 30e-6} | given))


def scene_of(*defects: Defect, **given: Any) -> Scene:
    return Scene(trb.cases.rig_30310(), **({"speed_rpm": 3000.0, "axial_load": 4930.0, "defects": defects} | given))


def missing(result: trb.Result) -> float:
    """Energy that is missing at the end over what was lost."""
    return abs(shared.missing(result)) / shared.lost(result)


# ---- the depth that a roller feels ----


@pytest.mark.parametrize(("depth", "equivalent"), [(2e-6, 6e-3), (5e-4, 6e-3), (1e-4, 1e-2)])
def test_a_roller_sinks_into_a_pit_as_a_circle_into_a_slot(depth: float, equivalent: float) -> None:
    """It touches an edge, or the ground."""
    along = np.linspace(-1e-3, 1e-3, 129)
    surface = np.full(129, depth)
    surface[[0, -1]] = 0.0
    to_edge = 1e-3 - np.abs(along)
    assert felt(along, surface, equivalent) == pytest.approx(
        np.minimum(depth, to_edge**2 / (2.0 * equivalent)), rel=1e-12, abs=1e-18
    )


def test_a_raised_edge_is_met_early() -> None:
    """A ridge of the height h lifts the roller from sqrt(2 Re h) before it on."""
    along = np.linspace(-2e-3, 2e-3, 401)
    ridge = np.where(np.abs(along) < 5e-6, -1e-5, 0.0)
    lifted = -felt(along, ridge, 6e-3)
    assert lifted == pytest.approx(np.maximum(0.0, 1e-5 - along**2 / 12e-3), abs=1e-12)


@pytest.mark.parametrize("on", SURFACES)
def test_the_interference_is_less_by_the_depth_under_the_roller(on: On) -> None:
    """At the start roller 0 stands at the angle zero, and roller 3 met the outer ring with its side at the angle zero."""
    roller = 3 if on == "roller" else 0
    found = pit(on, roller=roller if on == "roller" else 0, position=1e-3)
    with_pit, without = (Simulation(scene_of(*given, effects=FRICTIONLESS)).contacts() for given in ((found,), ()))
    less = without["raceway_interference"] - with_pit["raceway_interference"]
    nodes = stations(scene_of())
    race = 1 if on == "inner" else 0
    inside = np.abs(nodes - 1e-3) < 4.5e-3
    assert inside.sum() > 4
    equivalent = with_pit["raceway_radius"][race, roller, : nodes.size]
    # the roller's flank is steeper than its middle: a pit of one angle is as long as the circle there is large
    expected = np.minimum(30e-6, 1e-3**2 / (2.0 * equivalent))
    assert less[race, roller][inside] == pytest.approx(expected[inside], rel=3e-2)
    less[race, roller][inside] = 0.0
    assert not less.any()


def test_a_roller_meets_both_rings_with_its_pit() -> None:
    """Half a turn about its axis later it is the inner ring's."""
    simulation = Simulation(scene_of(pit("roller", roller=3), effects=FRICTIONLESS))
    vector = simulation.state.vector.copy()
    simulation.view(vector)["spin_angle"][3] = math.pi
    turned, plain = simulation.contacts(vector), Simulation(scene_of(effects=FRICTIONLESS)).contacts(vector)
    less = plain["raceway_interference"] - turned["raceway_interference"]
    assert not less[0].any()
    assert less[1, 3].max() > 20e-6
    assert not np.delete(less[1], 3, axis=0).any()


# ---- forces ----


@pytest.mark.parametrize("on", SURFACES)
def test_forces_are_the_slopes_of_the_elastic_energy(on: On) -> None:
    """Whatever the roller does: also about its own axis, about the bearing's, skewed and tilted, on a tilted ring."""
    waves = Waviness(on=on, orders=(30, 7), amplitudes=(1.5e-6, 3e-6), phases_deg=(3.0, 30.0))
    given = {"effects": FRICTIONLESS, "radial_load": 1500.0, "misalignment_x": 2e-4}
    simulation = Simulation(scene_of(waves, **given))
    base = simulation.state.vector.copy()
    geometry, roller = simulation.scene.bearing.geometry, 4
    simulation.view(base)["roller_skew"][roller] = 2e-4
    simulation.view(base)["spin_angle"][roller] = 0.3

    def energy(name: str, change: float) -> float:
        vector = base.copy()
        simulation.view(vector)[name][roller] += change
        return float(simulation.contacts(vector)["elastic_energy"][roller, 0])

    at = simulation.contacts(base)
    force, moment = at["force"][roller], at["moment"][roller]
    view = simulation.view(base)
    skew, tilt = float(view["roller_skew"][roller]), geometry.roller_axis_angle + float(view["roller_tilt"][roller])
    radius = geometry.roller_centre_radius + float(view["roller_r"][roller])
    normal = np.array([math.cos(tilt), 0.0, -math.sin(tilt)])
    axis = np.array([math.cos(skew) * math.sin(tilt), math.sin(skew), math.cos(skew) * math.cos(tilt)])
    expected = {
        "roller_r": force[0],
        "roller_z": force[2],
        "roller_psi": radius * force[1] + moment[2],
        "roller_tilt": moment[1],
        "roller_skew": -moment @ normal,
        "spin_angle": moment @ axis,
    }
    for name, value in expected.items():
        step = 1e-9 if name in ("roller_r", "roller_z") else 1e-7
        slope = -(energy(name, step) - energy(name, -step)) / (2.0 * step)
        # the depth on a roller is read where it would be if the roller were not skewed
        allowed = 2e-4 * float(np.abs(moment).max()) if name == "roller_skew" and on == "roller" else 1e-6
        assert slope == pytest.approx(value, rel=1e-4, abs=allowed), name
    assert abs(expected["spin_angle" if on == "roller" else "roller_psi"]) > 5e-3


def test_waves_go_on_over_their_seam() -> None:
    """A roller that stands at the angle zero, to the last bit or a hair beside it."""
    waves = Waviness(on="outer", orders=(5,), amplitudes=(2e-6,), phases_deg=(0.0,))
    simulation = Simulation(scene_of(waves, effects=FRICTIONLESS))
    for beside in (-1e-9, -1e-17, 0.0, 1e-17, 1e-9):
        vector = simulation.state.vector.copy()
        simulation.view(vector)["roller_psi"][0] = beside
        least = simulation.contacts(vector)["raceway_interference"][0, 0]
        plain = Simulation(scene_of(effects=FRICTIONLESS)).contacts(vector)["raceway_interference"][0, 0]
        assert plain - least == pytest.approx(2e-6, rel=1e-6)


@pytest.mark.parametrize("on", SURFACES)
def test_what_acts_on_the_roller_acts_on_the_rings(on: On) -> None:
    simulation = Simulation(scene_of(Waviness(on=on, orders=(30,), amplitudes=(2e-6,), seed=5), effects=FRICTIONLESS))
    at = simulation.contacts()
    force = at["force"] + at["ring_force"] + at["outer_force"]
    assert np.abs(force).max() < 1e-10 * np.abs(at["force"]).max() + 1e-9
    geometry = simulation.scene.bearing.geometry
    view = simulation.view(simulation.state.vector)
    centre = np.zeros((12, 3))
    centre[:, 0] = geometry.roller_centre_radius + view["roller_r"]
    centre[:, 2] = geometry.roller_centre_height + view["roller_z"]
    place = np.array(simulation.record()["ring_position"]) + np.array([0.0, 0.0, geometry.centre_plane])
    about = (
        at["moment"]
        + np.cross(centre, at["force"])
        + at["outer_moment"]
        + at["ring_moment"]
        + np.cross(np.broadcast_to([0.0, 0.0, place[2]], (12, 3)), at["ring_force"])
    )
    assert np.abs(about).max() < 1e-9 * float(np.abs(np.cross(centre, at["force"])).max() + 1.0)
    assert np.abs(at["ring_moment"][:, 2] + at["outer_moment"][:, 2]).max() > (0.0 if on == "roller" else 1e-3)


# ---- runs ----


@pytest.mark.parametrize("on", SURFACES)
def test_the_energy_audit_closes_over_pits(on: On) -> None:
    result = Simulation(scene_of(pit(on), radial_load=1000.0)).run(revolutions=3)
    assert missing(result) < 3e-4
    free = scene_of(pit(on), ring="free", ring_body=ROTOR)
    assert missing(Simulation(free).run(revolutions=2)) < 3e-4


ROTOR = RingBody.hollow_cylinder(mass=5.0, outer_diameter=0.08, length=0.1, mass_offset=0.003).replace(
    damping=2000.0, damping_turns=2.0
)


@pytest.mark.parametrize("on", SURFACES)
def test_an_explicit_method_agrees_over_pits(on: On) -> None:
    """It knows no tangents; the loads of all rollers, within 1 % of the largest."""
    scene = scene_of(pit(on, angle_deg=60.0))
    own, other = (
        Simulation(scene, integrator=integrator, accuracy="reference").run(revolutions=0.4, save_every=2e-5)
        for integrator in ("bdf", "erk")
    )
    for name in ("outer_load", "inner_load"):
        assert own[name] == pytest.approx(other[name], abs=0.012 * float(own[name].max()))
    shallow = own["outer_load" if on == "outer" else "inner_load"]
    assert shallow.min() < 0.9 * np.median(shallow)


@pytest.mark.parametrize(
    ("on", "line"),
    [
        ("outer", "rollers over the outer ring"),
        ("inner", "rollers over the inner ring"),
        ("roller", "spin of a roller, twice"),
    ],
)
@pytest.mark.slow
def test_a_pit_shows_at_its_order(on: On, line: str) -> None:
    """The strongest lines of the axial vibration are multiples of the order, within 0.1 orders of the shaft; without the pit they
    are a twentieth as strong."""

    def lines(*defects: Defect) -> tuple[trb.Result, Array, float]:
        scene = scene_of(*defects, ring="free", ring_body=ROTOR)
        result = Simulation(scene).run(revolutions=16, save_every=2e-5)
        late = result["time"] > 0.08
        acceleration = np.gradient(result["ring_velocity"][late][:, 2], 2e-5)
        frequency, density = observables.spectrum(result["time"][late], acceleration)
        kept = (frequency > 40.0) & (frequency < 3000.0)
        order = frequency[kept][np.argsort(density[kept])[::-1]] / 50.0
        return result, order, float(acceleration.std())

    result, found, strong = lines(pit(on, length=1.5e-3))
    expected = ring_orders(result)[line]
    times = np.round(found[:4] / expected)
    assert (times >= 1).all()
    assert found[:4] == pytest.approx(times * expected, abs=0.1)
    assert strong > 20.0 * lines()[2]


@pytest.mark.parametrize(("waves", "along", "line"), [(12, 2, 7.0), (13, 0, 8.0), (11, 0, 6.0)])
def test_waves_of_the_inner_ring_vibrate_as_known(waves: int, along: int, line: float) -> None:
    """As many waves as rollers move the ring along its axis at the rollers' order, 7 here; one more or less moves it across, one
    turn of the ring away (Wardle 1988, Proc. IMechE 202C)."""
    scene = scene_of(
        Waviness(on="inner", orders=(waves,), amplitudes=(3e-7,)),
        ring="free",
        ring_body=ROTOR,
        effects=Effects.standard().replace(gravity=False),
    )
    result = Simulation(scene).run(revolutions=14, save_every=5e-5)
    late = result["time"] > 0.08
    frequency, density = observables.spectrum(result["time"][late], result["ring_velocity"][late][:, along])
    kept = (frequency > 40.0) & (frequency < 1500.0)
    assert frequency[kept][np.argmax(density[kept])] / 50.0 == pytest.approx(line, abs=0.1)
    across = result["ring_velocity"][late].std(axis=0)
    assert across[along] > 5.0 * across[2 - along]


def test_an_outer_ring_takes_its_pit_along() -> None:
    """A turning outer ring and a shaft at rest: rollers pass a pit of either ring at the same orders."""
    scene = scene_of(pit("outer", angle_deg=10.0), speed_rpm=0.0, outer_speed_rpm=3000.0)
    result = Simulation(scene).run(revolutions=2.0, save_every=1e-5)
    load = result["outer_load"]
    passed = np.array([load[:, j] < 0.93 * np.median(load[:, j]) for j in range(12)])
    hits = int((np.diff(passed.any(axis=0).astype(int)) == 1).sum())
    assert hits == pytest.approx(12 * 2 * (1.0 - 0.58338), abs=1.0)
    assert missing(result) < 3e-4


def test_peaks_see_what_happens_in_a_pit() -> None:
    result = Simulation(scene_of(pit("outer"))).run(revolutions=1, save_every=2e-4)
    fine = Simulation(scene_of(pit("outer"))).run(revolutions=1, save_every=5e-6)
    largest = fine["outer_load"].max(axis=0)
    assert result["outer_load_peak"].max(axis=0) == pytest.approx(largest, rel=5e-3)


def test_where_there_is_no_defect_nothing_is_looked_at() -> None:
    simulation = Simulation(scene_of())
    simulation.run(revolutions=0.2)
    assert simulation.counters["uneven_contacts"] == 0
    pitted = Simulation(scene_of(pit("outer")))
    pitted.run(revolutions=0.2)
    contacts = pitted.counters["force_evaluations"] * 24
    assert 0 < pitted.counters["uneven_contacts"] < 0.1 * contacts


@pytest.mark.parametrize("on", SURFACES)
def test_a_run_over_a_pit_goes_on_from_a_state_and_comes_back_from_a_file(on: On, tmp_path: Path) -> None:
    """Rollers keep the angle that they have turned by."""
    scene = scene_of(pit(on, angle_deg=35.0))
    whole = Simulation(scene)
    whole.run(revolutions=0.5)
    begun = Simulation(scene)
    begun.run(revolutions=0.25)
    after = Simulation(scene.replace(start=trb.Start.state(begun.state)))
    after.run(revolutions=0.25)
    assert after.contacts()["raceway_interference"] == pytest.approx(whole.contacts()["raceway_interference"], abs=3e-8)
    result = Simulation(scene).run(revolutions=0.5, save_every=2e-4, output=tmp_path / "pit.h5")
    result = trb.load(tmp_path / "pit.h5")
    assert result.scene == scene
    replay = Replay(result)
    least = int(np.argmin(result["outer_load" if on == "outer" else "inner_load"].min(axis=1)))
    for index in (0, least, len(result) - 1):
        for name in ("outer_load", "inner_load"):
            assert replay.record(index)[name] == pytest.approx(result[name][index], rel=1e-6)


def test_bearings_on_a_shaft_have_their_own_defects() -> None:
    bearing = trb.cases.rig_30310()

    def loads(*defects: Defect) -> list[Array]:
        pair = Assembly(
            shaft=Shaft.hollow_cylinder(mass=8.0, outer_diameter=0.05, length=0.25),
            bearings=(
                {"bearing": bearing, "position": -0.06, "small_ends": "right", "end_play": -1e-5, "defects": defects},
                {"bearing": bearing, "position": 0.06, "small_ends": "left", "end_play": -1e-5},
            ),
            loads=(ShaftLoad(position=0.0, force=(0.0, -1000.0, 0.0)),),
            speed_rpm=2000.0,
        )
        result = trb.Simulation(pair).run(revolutions=0.5, save_every=2e-5)
        return [result[name]["inner_load"] for name in ("bearing_1", "bearing_2")]

    pitted, plain = loads(pit("inner")), loads()
    one, other = (np.abs(a - b).max() for a, b in zip(pitted, plain, strict=True))
    assert one > 50.0
    assert other < 0.5 * one


# ---- what is refused ----


@pytest.mark.parametrize(
    ("defect", "words"),
    [
        (pit("outer", position=0.05), "defects[0].position"),
        (pit("outer", width=1e-4), "effects.n_slices"),
        (pit("inner", length=0.3), "defects[0].length"),
        (pit("roller", roller=40), "defects[0].roller"),
        (Waviness(on="roller", orders=(200,), amplitudes=(1e-5,)), "defects[0].amplitudes"),
        (
            DepthMap(on="outer", along=(-1e-3, 0.0, 1e-3), across=(0.05, 0.06), depth=((0, 0), (1e-5, 1e-5), (0, 0))),
            "defects[0].across",
        ),
    ],
)
def test_what_cannot_be_is_refused(defect: Defect, words: str) -> None:
    with pytest.raises(InputError, match="must") as caught:
        scene_of(defect)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Pit(on="cage", length=1e-3, width=1e-3, depth=1e-6), "on"),
        (lambda: pit("outer", depth=-1e-6), "depth"),
        (lambda: Waviness(on="outer", orders=(3, 4), amplitudes=(1e-6,)), "amplitudes"),
        (lambda: Waviness(on="outer", orders=(3,), amplitudes=(1e-6,), roller=2), "roller"),
        (lambda: DepthMap(on="outer", along=(0.0, 0.0, 1e-3), across=(0.0, 1e-3), depth=((0, 0),) * 3), "along[1]"),
        (lambda: DepthMap(on="outer", along=(0.0, 5e-4, 1e-3), across=(0.0, 1e-3), depth=((0, 0),) * 2), "depth"),
        (lambda: DepthMap(on="outer", along=(0.0, 5e-4, 1e-3), across=(0.0, 1e-3), depth=((1e-6, 0),) * 3), "depth[0]"),
    ],
)
def test_numbers_that_do_not_fit_are_refused(make: Any, words: str) -> None:
    with pytest.raises(InputError) as caught:
        make()
    assert words in str(caught.value)


def test_a_case_file_names_defects() -> None:
    scene = scene_of(
        pit("outer"),
        Waviness(on="roller", orders=(2, 3), amplitudes=(1e-7, 2e-7)),
        DepthMap(on="inner", along=(-1e-3, 0.0, 1e-3), across=(-5e-3, 5e-3), depth=((0, 0), (1e-5, 1e-5), (0, 0))),
    )
    assert case_from_dict(tomllib.loads(case_text(scene, trb.RunOptions())))[0] == scene


def test_a_roller_of_a_ring_is_refused() -> None:
    """A pit that was meant for a roller would else be one of the ring, without a word."""
    with pytest.raises(InputError, match="roller = 3 : must not be given"):
        trb.Pit(on="outer", length=1e-3, width=5e-3, depth=1e-5, roller=3)
    with pytest.raises(InputError, match="roller = 3 : must not be given"):
        trb.DepthMap(
            on="inner", along=(-1e-3, 0, 1e-3), across=(-3e-3, 3e-3), depth=((0, 0), (1e-5, 1e-5), (0, 0)), roller=3
        )
