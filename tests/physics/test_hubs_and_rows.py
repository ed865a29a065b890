"""Outer rings that turn on a shaft's bearings, the road's forces on a wheel, and bearings of several rows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import root
from scipy.spatial.transform import Rotation

import trbdyn as trb
from trbdyn import Assembly, InputError, Scene, ShaftLoad, Simulation
from trbdyn.standards import lamina
from trbdyn.standards.loading import at_equilibrium
from trbdyn.statics.core_model import normal_contacts

BEARING = trb.cases.rig_30310()
SHAFT = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
STILL = {"gravity": (0.0, 0.0, 0.0)}
CATALOGUE_LIVES = ("life_hours", "modified_life_hours")
REFERENCE_LIVES = ("reference_life_hours", "modified_reference_life_hours")


def hub(inner: float, outer: float, **given: Any) -> Assembly:
    loads = [ShaftLoad(position=0.01, force=(0.0, 6000.0, 1500.0))]
    values = {"spread": 0.15, "end_play": -20e-6, "shaft": SHAFT, "loads": loads} | given
    return Assembly.pair(BEARING, "back to back", speed_rpm=inner, outer_speed_rpm=outer, **values)


def scene(inner: float, outer: float, radial: float, **given: Any) -> Scene:
    return Scene(BEARING, speed_rpm=inner, outer_speed_rpm=outer, axial_load=5000.0, radial_load=radial, **given)


@pytest.mark.parametrize("speeds", [(0.0, 200.0), (0.0, -200.0), (300.0, 100.0), (-50.0, 150.0)])
def test_lives_depend_on_the_speed_between_the_rings(speeds: tuple[float, float]) -> None:
    """ISO 281 asks for the relative speed alone; under an even load ISO 16281 does so, too: every place has the same load."""
    turning = trb.rating(scene(200.0, 0.0, 8000.0))
    other = trb.rating(scene(*speeds, 8000.0))
    assert other.speed_rpm == 200.0
    for life in CATALOGUE_LIVES:
        assert getattr(other, life) == pytest.approx(getattr(turning, life), rel=1e-12)
    even, also = (trb.rating(scene(*one, 0.0)) for one in ((200.0, 0.0), speeds))
    for life in (*CATALOGUE_LIVES, *REFERENCE_LIVES):
        assert getattr(also, life) == pytest.approx(
            getattr(even, life), rel=2e-3
        )  # centrifugal forces of another orbit


@pytest.mark.parametrize(
    ("speeds", "exponents", "given"),
    [
        ((200.0, 0.0), (4.5, 4.0), {}),
        ((0.0, 200.0), (4.0, 4.5), {}),
        ((300.0, 100.0), (4.0, 4.0), {}),
        ((200.0, 0.0), (4.0, 4.5), {"rotating_load": trb.RotatingLoad(9000.0), "ring": "follows"}),
        ((200.0, 0.0), (4.0, 4.0), {"rotating_load": trb.RotatingLoad(9000.0, frequency_hz=5.0), "ring": "follows"}),
    ],
)
def test_the_exponent_of_a_ring_is_that_of_its_turn_against_the_load(
    speeds: tuple[float, float], exponents: tuple[float, float], given: dict[str, Any]
) -> None:
    """ISO 16281: 4 on a ring that turns against the load, 4.5 on one that stands."""
    own = scene(*speeds, 0.0 if given else 8000.0, **given)
    found, loading = trb.rating(own), at_equilibrium(own)
    ratings = lamina.contact_ratings(
        found.dynamic_rating,
        n_rollers=BEARING.n_rollers,
        roller_diameter=BEARING.roller.diameter,
        pitch_diameter=BEARING.pitch_diameter,
        angle=math.radians(BEARING.cup_half_angle_deg),
    )
    count = loading.lamina_loads.shape[2]
    edge = lamina.stress_concentration(count)
    damage = 0.0
    for ring, exponent in enumerate(exponents):
        means = np.mean(loading.lamina_loads[ring] ** exponent, axis=0) ** (1.0 / exponent)
        damage += np.sum((edge * means / (ratings[ring] * count ** (-7.0 / 9.0))) ** 4.5)
    assert found.reference_life == pytest.approx(damage ** (-8.0 / 9.0), rel=1e-9)


def test_the_loads_of_a_hub_are_those_of_a_shaft_but_for_the_orbit() -> None:
    """Where centrifugal forces are nothing it does not matter which ring turns."""
    both = [trb.equilibrium(hub(*speeds)) for speeds in ((1.0, 0.0), (0.0, 1.0))]
    for one, other in zip(both[0].bearings, both[1].bearings, strict=True):
        assert other.outer_load == pytest.approx(one.outer_load, rel=1e-6, abs=1e-3)
    ratings = [trb.rating(found) for found in both]
    assert ratings[1].life_hours == pytest.approx(ratings[0].life_hours, rel=1e-6)


@pytest.mark.parametrize("speeds", [(0.0, 800.0), (300.0, -500.0)])
def test_cages_of_a_hub_turn_as_kinematics_says(speeds: tuple[float, float]) -> None:
    """Mean speeds of both cages, in a preload that keeps all rollers rolling, against kappa n_i + (1 - kappa) n_o."""
    loads = [ShaftLoad(position=0.01, force=(0.0, 3000.0, 500.0))]
    simulation = Simulation(hub(*speeds, end_play=-60e-6, loads=loads), accuracy="fast")
    result = simulation.run(revolutions=2.0, save_every=1e-3)
    assert result.energy.closure < 1e-3
    for name, sign in (("left", -1.0), ("right", 1.0)):
        one = result[name]
        ratio = one.scene.bearing.geometry.cage_speed_ratio
        expected = sign * (ratio * speeds[0] + (1.0 - ratio) * speeds[1])
        first = len(one) // 4
        angle = np.unwrap(one.cage_angle[first:])
        mean = (angle[-1] - angle[0]) / (one.time[-1] - one.time[first]) * 30.0 / math.pi
        assert mean == pytest.approx(expected, rel=1e-3), name
        assert one.revolutions == pytest.approx(2.0, rel=1e-6)


def test_the_road_presses_on_a_wheel() -> None:
    """By hand: 4000 N, a = 0.3, h/t = 0.4: outer wheel 4960 N and 1488 N inboard, inner wheel 3040 N and 912 N outboard."""
    given: dict[str, Any] = {
        "position": 0.02,
        "rolling_radius": 0.3,
        "load": 4000.0,
        "centre_height": 0.6,
        "track": 1.5,
        "fixed_to": "shaft",
    }
    outer, inner = (ShaftLoad.wheel(cornering=sign * 0.3, **given) for sign in (1.0, -1.0))
    assert outer.force == pytest.approx((0.0, 4960.0, -1488.0))
    assert inner.force == pytest.approx((0.0, 3040.0, 912.0))
    left = ShaftLoad.wheel(cornering=0.3, outboard="left", **given)
    assert left.force == pytest.approx((0.0, 4960.0, 1488.0))
    spindle = ShaftLoad.wheel(cornering=0.3, **(given | {"fixed_to": "outer rings"}))
    assert spindle.force == pytest.approx((0.0, -4960.0, 1488.0))
    assert spindle.offset == outer.offset == (0.0, -0.3)
    with pytest.raises(InputError, match=r"cornering.*must be >= -1.25: the inner wheel leaves the road"):
        ShaftLoad.wheel(cornering=-1.3, **given)
    with pytest.raises(InputError, match=r"track.*must be given"):
        ShaftLoad.wheel(cornering=0.3, **(given | {"track": None}))
    with pytest.raises(InputError, match=r"fixed_to.*must be one of"):
        ShaftLoad.wheel(**(given | {"fixed_to": "hub"}))


def test_bearings_of_a_spindle_hold_the_wheel() -> None:
    """Forces of both bearings and their moments about the contact patch are in balance with the road's."""
    road = ShaftLoad.wheel(position=0.02, rolling_radius=0.3, load=4000.0, cornering=0.3, centre_height=0.6, track=1.5)
    found = trb.equilibrium(hub(0.0, 600.0, loads=[road], **STILL))
    force = np.sum([one.force for one in found.bearings], axis=0)
    assert force == pytest.approx(np.array(road.force), abs=1e-3)
    patch = np.array([*road.offset, road.position])
    moment = sum(
        np.cross(np.array([0.0, 0.0, place.centre_plane]) - patch, one.force) + np.array([*one.moment, 0.0])
        for one, place in zip(found.bearings, found.assembly.bearings, strict=True)
    )
    assert np.asarray(moment)[:2] == pytest.approx(np.zeros(2), abs=0.1)  # of 1488 N x 0.3 m = 446 N m


def rows(kind: Any, **given: Any) -> Assembly:
    load = ShaftLoad(position=0.02, force=(800.0, -9000.0, 2000.0))
    values = {"row_distance": 0.034, "end_play": -15e-6, "loads": [load], "shaft": SHAFT, "speed_rpm": 900.0} | given
    return Assembly.rows(BEARING, kind, **values)


@pytest.mark.parametrize("kind", ["TDO", "TDI"])
def test_two_rows_against_an_own_equilibrium(kind: str) -> None:
    """The core's equilibrium of each row alone, its ring held at the place that the rigid shaft gives it; scipy finds the place
    where forces and moments of both rows and the load are in balance.
    """
    assembly = rows(kind, **STILL)
    found = trb.equilibrium(assembly)
    load = assembly.loads[0]
    force, unit = np.array(load.force, dtype=float), np.array([1e-6, 1e-6, 1e-6, 1e-4, 1e-4])
    models = [normal_contacts(assembly.scene(index, displacement=(0, 0, -1e-6, 0, 0))) for index in (0, 1)]
    speed = assembly.speed_rpm * math.pi / 30.0
    even = 2.0 * math.pi * np.arange(BEARING.n_rollers) / BEARING.n_rollers

    def axis_of(place: np.ndarray) -> np.ndarray:
        return Rotation.from_rotvec([*place[3:], 0.0]).apply([0.0, 0.0, 1.0])

    def each(place: np.ndarray) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Of each row: loads of its rollers, force of the shaft on it, and its moment about the shaft's moved origin."""
        out = []
        for one, model in zip(assembly.bearings, models, strict=True):
            turned = np.array([1.0, -one.side, -one.side])
            moved = turned * (place[:3] + one.centre_plane * (axis_of(place) - [0.0, 0.0, 1.0])) + [
                0.0,
                0.0,
                one.end_play,
            ]
            where = np.concatenate([moved, turned[:2] * place[3:]])
            held = model.equilibrium(np.zeros(5), np.ones(5), where, -one.side * speed, even, None, True, True)
            pull, turning = turned * held["reaction"][:3], turned[:2] * held["reaction"][3:]
            out.append((held["loads"], pull, np.cross(one.centre_plane * axis_of(place), pull)[:2] + turning))
        return out

    def missing(scaled: np.ndarray) -> np.ndarray:
        place = scaled * unit
        held = each(place)
        moment = np.cross(load.position * axis_of(place), force)[:2] - sum(one[2] for one in held)
        return np.concatenate([force - sum(one[1] for one in held), moment / 0.05])

    start = np.concatenate([found.displacement(), found.tilt]) / unit
    solved = root(missing, start + np.array([0.3, -0.2, 0.5, 0.1, -0.1]), tol=1e-12)
    assert np.abs(solved.fun).max() < 1e-3  # N, of 9000
    for one, (loads, pull, _) in zip(found.bearings, each(solved.x * unit), strict=True):
        assert one.force == pytest.approx(pull, abs=1e-6 * np.linalg.norm(pull))
        assert one.outer_load == pytest.approx(loads[:, 0], abs=1e-6 * loads.max())


def test_rows_lie_where_they_are_said_to() -> None:
    """Distances of the roller-centre planes; the arrangement; four rows and a spacer between the inner two."""
    for kind, arrangement in (("TDO", "back to back"), ("TDI", "face to face"), (("left", "left"), "tandem")):
        push = [ShaftLoad(position=0.0, force=(0.0, 0.0, -3000.0))]
        double = rows(kind, loads=push)
        planes = [one.centre_plane for one in double.bearings]
        assert double.arrangement == arrangement
        assert planes == pytest.approx([-0.017, 0.017])
    four = rows("TQO", row_distance=(0.034, 0.045, 0.034))
    planes = [one.centre_plane for one in four.bearings]
    assert np.diff(planes) == pytest.approx([0.034, 0.045, 0.034])
    assert four.names == ("row_1", "row_2", "row_3", "row_4")
    with pytest.raises(InputError, match=r"rows.*must be one of TDO, TDI, TQO, TQI"):
        rows("TDX")
    with pytest.raises(InputError, match=r"row_distance.*must be one number, or 3 for 4 rows"):
        rows("TQO", row_distance=(0.034, 0.045))
    with pytest.raises(InputError, match=r"position.*must be >= "):
        rows("TDO", row_distance=0.01)


@pytest.mark.parametrize("kind", ["TDO", "TQO", ("left", "left", "left")])
def test_the_life_of_all_rows_is_that_of_independent_failures(kind: Any) -> None:
    """By probabilities of survival, each row alone and all together: Weibull slopes of 9/8 for the reference lives, and of 27/20
    for those of ISO 281, with which equal rows have its i^(7/9).
    """
    push = [ShaftLoad(position=0.005, force=(0.0, -9000.0, -3000.0))]
    rated = trb.rating(rows(kind, loads=push, end_play=0.0 if kind[0] == "left" else -15e-6))
    for life in (*CATALOGUE_LIVES, *REFERENCE_LIVES):
        whole = getattr(rated, life)
        slope = 27.0 / 20.0 if life in CATALOGUE_LIVES else 9.0 / 8.0
        survive = [0.9 ** ((whole / getattr(one, life)) ** slope) for one in rated.bearings.values()]
        assert math.prod(survive) == pytest.approx(0.9, rel=1e-9), life


@pytest.mark.parametrize("count", [2, 4])
def test_equal_rows_have_the_life_of_iso_281(count: int) -> None:
    """Rows in tandem that share an axial load: C = i^(7/9) C1 and P = i P1 in (C/P)^(10/3) (ISO 281, 7.1). The reference lives go
    with the fourth power.
    """
    push = [ShaftLoad(position=0.0, force=(0.0, 0.0, -6000.0 * count))]
    rated = trb.rating(
        rows(("left",) * count, loads=push, end_play=0.0, row_distance=(0.05,) * (count - 1), gravity=(0.0,) * 3)
    )
    one = next(iter(rated.bearings.values()))
    share = count ** (7.0 / 9.0) / count
    assert rated.life_hours == pytest.approx(one.life_hours * share ** (10.0 / 3.0), rel=1e-3)
    assert rated.reference_life_hours == pytest.approx(one.reference_life_hours * share**4.0, rel=1e-3)


def test_a_double_row_runs() -> None:
    """Two rows with outer rings that turn: one integrator, both cages, the energy adds up."""
    double = rows("TDO", speed_rpm=0.0, outer_speed_rpm=1000.0)
    result = Simulation(double, accuracy="fast").run(revolutions=0.25)
    assert result.success
    assert result.energy.closure < 1e-3
    loads = {name: result.loads(name)["radial_load"].mean() for name in result}
    found = trb.equilibrium(double)
    for one in found.bearings:
        assert loads[one.name] == pytest.approx(one.radial_load, rel=0.02)
