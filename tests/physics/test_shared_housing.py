"""One rigid housing around all bearings of a shaft: its limits, its statics by another way, its files."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import curve_fit, root

import trbdyn as trb
from trbdyn import Assembly, InputError, ShaftLoad, SharedHousing
from trbdyn.run.toml_assembly import assembly_from_dict
from trbdyn.statics.shaft_balance import ShaftOnBearings

Array = NDArray[np.float64]

BEARING = trb.cases.rig_30310()
SHAFT = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
PLACES = (-0.1, 0.12)
LOAD = (500.0, -3000.0, 800.0)
BODY = SharedHousing.hollow_cylinder(
    mass=12.0, inner_diameter=0.11, outer_diameter=0.16, length=0.25, mass_position=0.01
)
SOFT = BODY.on_supports(PLACES, radial=1e7, axial=5e6)


def pair(around: SharedHousing | None = SOFT, **changes: Any) -> Assembly:
    given = {"spread": 0.15, "end_play": -40e-6, "loads": [ShaftLoad(position=0.02, force=LOAD)]} | changes
    return Assembly.pair(BEARING, "back to back", shaft=SHAFT, speed_rpm=3000, shared_housing=around, **given)


def simulation(assembly: Assembly, **options: Any) -> trb.Simulation:
    return trb.Simulation(assembly, accuracy=options.pop("accuracy", "fast"), **options)


def signs(one: trb.ShaftBearing) -> tuple[Array, Array]:
    """From the axes of the shaft to those of a bearing, of a vector and of a rotation about x and y."""
    return np.array([1.0, -one.side, -one.side]), np.array([1.0, -one.side])


def test_supports_are_summed_as_springs_on_a_stiff_beam() -> None:
    one = BODY.on_supports((-0.1, 0.05, 0.12), radial=(1e7, 3e7, 2e7), axial=1e6, tilt=10.0)
    moved, turned = 1e-5, 2e-4
    at = np.array([-0.1, 0.05, 0.12])
    forces = np.array([1e7, 3e7, 2e7]) * (moved + turned * at)
    middle = one.support_position
    assert forces.sum() == pytest.approx(one.support_radial * (moved + turned * middle), rel=1e-12)
    about = forces @ (at - middle) + 30.0 * turned
    assert about == pytest.approx(one.support_tilt * turned, rel=1e-9)
    assert one.support_axial == pytest.approx(3e6)


def test_a_very_stiff_support_is_an_outer_ring_at_rest() -> None:
    stiff = BODY.on_supports(PLACES, radial=1e12, axial=1e12).replace(damping=1e4, damping_turns=1e2)
    held, housed = (
        simulation(one, accuracy="standard").run(duration=1e-3, save_every=2e-4) for one in (pair(None), pair(stiff))
    )
    for name in ("left", "right"):
        assert np.abs(housed[name]["housing_position"]).max() < 2e-11
        for field, off in (("roller_position", 1e-9), ("ring_position", 1e-10), ("roller_velocity", 1e-5)):
            np.testing.assert_allclose(housed[name][field], held[name][field], rtol=0.0, atol=off)


def test_a_soft_support_carries_shaft_and_housing_as_one_mass() -> None:
    """The preload couples both at 1 kHz and more; together they swing on the support at the natural frequency of their mass. The
    cages follow by friction.
    """
    sim = simulation(pair())
    vector = sim.state.vector
    speed, views = 5e-3, sim.view(vector)
    for name, sense in (("left", -1.0), ("right", 1.0)):
        for part in ("roller_v_z", "cage_v_z"):
            views[name][part] = views[name][part] - sense * speed
    for ring in ("inner_ring_v_z", "outer_ring_v_z"):
        views["left"][ring] = speed
    assert float(views["right"]["outer_ring_v_z"]) == speed  # it is the same coordinate
    sim.set_state(vector)
    result = sim.run(duration=0.03, save_every=1e-4)
    mass = 12.0 + 6.0 + 2 * BEARING.n_rollers * BEARING.geometry.roller_mass + 2 * BEARING.cage.mass
    expected = math.sqrt(1e7 / mass) / (2.0 * math.pi)

    def swing(time: Array, size: float, frequency: float, phase: float, decay: float) -> Array:
        return size * np.exp(-decay * time) * np.sin(2.0 * math.pi * frequency * time + phase)

    place = result["left"]["housing_position"][:, 2]
    found, _ = curve_fit(swing, result["left"]["time"], place, [5e-6, expected, 0.0, 1.0])
    assert abs(found[0]) > 3e-6
    assert found[1] == pytest.approx(expected, rel=0.012)
    # places and tilts of both outer rings are those of one body
    left, right = (one for one in pair().bearings)
    arm = right.centre_plane - left.centre_plane
    for record in (3, -1):
        one, other = (
            {f: result[name][f][record] for f in ("housing_position", "housing_tilt")} for name in ("left", "right")
        )
        (t3, t2), (u3, u2) = signs(left), signs(right)
        tilt = t2 * one["housing_tilt"]
        np.testing.assert_allclose(u2 * other["housing_tilt"], tilt, rtol=0.0, atol=1e-13)
        along = np.array([tilt[1], -tilt[0], 0.0]) * arm
        np.testing.assert_allclose(
            u3 * other["housing_position"], t3 * one["housing_position"] + along, rtol=0.0, atol=1e-13
        )
    for name in ("left", "right"):
        assert abs(result[name].energy_closure) < 1e-3


def test_the_place_under_another_load_is_that_of_a_solution_of_our_own() -> None:
    """Forces change in a run; damped, shaft and housing come to rest where SciPy finds ten forces and moments in balance."""
    new, times = (1300.0, -2000.0, 1500.0), [1e-3]
    parts = tuple(trb.History.step(times, [one, other], rise=1e-3) for one, other in zip(LOAD, new, strict=True))
    housing = BODY.on_supports(PLACES, radial=2e7, axial=1e7).replace(damping=8e3, damping_turns=80.0)
    assembly = pair(housing, loads=[ShaftLoad(position=0.02, force=parts)])
    sim = simulation(assembly)
    result = sim.run(duration=0.045, save_every=1e-4)

    def forces(system: ShaftOnBearings, shaft: Array, moved: Array) -> tuple[Array, Array]:
        """On shaft and housing, about the origin."""
        on_shaft, on_housing = np.zeros(6), np.zeros(6)
        for index, one in enumerate(assembly.bearings):
            (t3, t2), z, apart = signs(one), one.centre_plane, shaft - moved
            place = t3 * np.array([apart[0] + apart[4] * z, apart[1] - apart[3] * z, apart[2]])
            place[2] += one.end_play
            reaction = system.answer(index, np.concatenate([place, t2 * apart[3:]])).reaction
            force = -t3 * reaction[:3]
            wrench = np.concatenate([force, np.cross([0.0, 0.0, z], force) + np.array([*(-t2 * reaction[3:]), 0.0])])
            on_shaft += wrench
            on_housing -= wrench
        for position, offset, force, moment in system.loads:
            on_shaft += np.concatenate([force, moment + np.cross(offset + np.array([0.0, 0.0, position]), force)])
        return on_shaft[:5], on_housing[:5]

    early, late = ShaftOnBearings(assembly, 0.0), ShaftOnBearings(assembly, 0.04)
    unit = 1e-5 / np.array([1.0, 1.0, 1.0, 0.1, 0.1])
    start = root(lambda x: forces(early, unit * x, np.zeros(5))[0] * unit, np.full(5, 0.1))
    hold = -forces(early, unit * start.x, np.zeros(5))[1]
    # the support carries this, and the weight of the housing
    t3, _ = signs(assembly.bearings[0])
    carried = t3 * sim.state.housing_load[:3] - [0.0, 12.0 * 9.80665, 0.0]
    np.testing.assert_allclose(carried, hold[:3], rtol=0.0, atol=0.5)

    def left(x: Array) -> Array:
        shaft, moved = unit * x[:5], unit * x[5:]
        on_shaft, on_housing = forces(late, shaft, moved)
        at = housing.support_position
        gone = np.array([moved[0] + moved[4] * at, moved[1] - moved[3] * at, moved[2]])
        force = -np.array([4e7, 4e7, 2e7]) * gone
        about = np.cross([0.0, 0.0, at], force)[:2] - housing.support_tilt * moved[3:]
        return np.concatenate([on_shaft * unit, (on_housing + hold + np.concatenate([force, about])) * unit])

    found = root(left, np.r_[start.x, np.zeros(5)] + 0.3)
    assert found.success
    moved = unit * found.x[5:]
    for name, one in zip(assembly.names, assembly.bearings, strict=True):
        (t3, t2), z = signs(one), one.centre_plane
        place = t3 * np.array([moved[0] + moved[4] * z, moved[1] - moved[3] * z, moved[2]])
        rest = result[name]["time"] > 0.035
        size = float(np.abs(place).max())
        np.testing.assert_allclose(
            result[name]["housing_position"][rest].mean(axis=0), place, rtol=0.0, atol=0.015 * size
        )
        tilt = result[name]["housing_tilt"][rest].mean(axis=0)
        np.testing.assert_allclose(tilt, t2 * moved[3:], rtol=0.0, atol=4e-7)
        assert abs(result[name].energy_closure) < 1e-3


def test_a_run_goes_on_from_a_state() -> None:
    """From a checkpoint to the same bits, and files: tests/restart/test_assemblies.py."""
    half = simulation(pair(), checkpoint_every=1e-3)
    half.run(duration=1e-3, save_every=1e-4)
    onward = simulation(pair().replace(start=trb.Start.state(half.state)))
    end, other = (sim.run(duration=1e-3, save_every=1e-4) for sim in (half, onward))
    off = end["right"]["housing_position"][-1] - other["right"]["housing_position"][-1]
    assert np.abs(off).max() < 2e-9


def test_a_case_file_has_the_housing() -> None:
    assembly = pair()
    tables = assembly.tables()
    assert tables["assembly"]["shared_housing"]["mass"] == 12.0
    read, _ = assembly_from_dict({**tables, "run": {"revolutions": 1.0}})
    assert read == assembly
    assert "mass of the housing" in repr(assembly._shown().text())


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"housing": trb.Housing(mass=1.0, inertia_axial=1e-3, inertia_transverse=1e-3)},
            "must not be given with a shared_housing",
        ),
        (
            {"spring": trb.PreloadSpring(force=500.0), "end_play": 0.0},
            "slides in a housing that moves is a body of its own",
        ),
        ({"shared_housing": SOFT.replace(support_radial=0.0)}, "shared_housing.support_radial = 0.0 : must be > 0"),
        ({"shared_housing": SOFT.replace(support_axial=0.0)}, "shared_housing.support_axial = 0.0 : must be > 0"),
        ({"shared_housing": SOFT.replace(support_tilt=0.0)}, "shared_housing.support_tilt = 0.0 : must be > 0"),
    ],
)
def test_what_cannot_be_is_refused(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        pair(changes.pop("shared_housing", SOFT), **changes)


@pytest.mark.parametrize(
    ("given", "field"),
    [({"radial": 0.0}, "radial"), ({"radial": (1.0,)}, "radial"), ({"radial": 1.0, "axial": -1.0}, "axial")],
)
def test_supports_that_cannot_be_are_refused(given: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError, match=field):
        BODY.on_supports(PLACES, **given)
