"""The summary and derived numbers of small made-up results, against answers computed by hand."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import observables
from trbdyn.results.result import Result

Array = NDArray[np.float64]


def settled_late(build: Callable[..., tuple[Any, Result]], change: Callable[[Any], None]) -> tuple[Any, Result]:
    """A run in whose first fifth the cage runs another circle and everything is a thousandfold: no average may hold
    any of it.
    """
    run, _ = build(n=4001, duration=0.4)
    change(run)
    late = run.column("time") >= 0.0999
    position = run.column("cage_position")
    position[~late, :2] *= 0.3
    from types import SimpleNamespace

    scene = SimpleNamespace(**{name: getattr(build()[1].scene, name) for name in ("bearing", "effects")})
    scene.to_dict, scene.ring_quantities = dict, build()[1].scene.ring_quantities
    scene.rotating_load = scene.growth = None
    scene.speed_rpm = scene.turning_rpm = 3000.0
    scene.outer_speed_rpm, scene.outer_turns, scene.turning_ring, scene.torque = 0.0, False, "shaft", None
    scene.elastic_cage = None
    scene.axial_load, scene.radial_load = build()[1].scene.axial_load, 0.0
    scene.lubricant = build()[1].scene.lubricant
    scene.misalignment_x = scene.misalignment_y = 0.0
    return run, run.result(scene)


NAMES = ("outer_load", "inner_load", "rib_load", "outer_pressure", "inner_pressure", "rib_pressure", "roller_skew")
NAMES += (
    "outer_film_parameter",
    "inner_film_parameter",
    "rib_film_parameter",
    "pocket_force",
    "inner_torque",
    "outer_torque",
)
NAMES += ("inner_torque_traction", "inner_torque_rolling", "inner_torque_rib", "power_loss", "cage_tilt", "shaft_speed")


@pytest.fixture
def late(build: Callable[..., tuple[Any, Result]]) -> tuple[Any, Result, NDArray[np.bool_]]:
    """The run, and which of its records are averaged."""

    def change(run: Any) -> None:
        random = np.random.default_rng(7)
        early = run.column("time") < 0.0999
        for name in NAMES:
            column = run.column(name)
            if name == "roller_skew":
                column[...] = random.normal(2e-4, 1e-4, column.shape)
            if name.endswith("_load"):
                # unequal loads: half of the rollers carry nine times as much as the others
                column[:, ::2] *= 9.0
            if name.endswith("film_parameter"):
                column[:, 1::2] *= 5.0
            column[early] *= 1000.0
        for name, watt in (("traction_outer", 40.0), ("rib", 70.0)):
            run.column(f"loss_{name}")[:] += 1000.0 * np.minimum(run.column("time"), 0.0999) * watt

    run, result = settled_late(build, change)
    start = result.settling().time
    assert 0.09 < start < 0.2
    return run, result, run.column("time") >= start


def test_every_average_is_that_of_the_window(late: tuple[Any, Result, NDArray[np.bool_]]) -> None:
    run, result, kept = late
    values, column = result.summary(), lambda name: run.column(name)[kept]
    assert values["window_start"] == column("time")[0]
    assert values["window_end"] == column("time")[-1]
    assert values["speed_rpm"] == pytest.approx(3000.0)
    for side in ("outer", "inner", "rib"):
        load, film = column(f"{side}_load"), column(f"{side}_film_parameter")
        assert values[f"{side}_load_mean"] == pytest.approx(load.mean())
        assert f"{side}_pressure_max" not in values, "extremes are those of the steps, not of the records"
        weighted = float((film * load).sum() / load.sum())
        assert values[f"film_parameter_{side}"] == pytest.approx(weighted)
        assert weighted < 0.6 * film.mean(), "the plain mean is another one"
    assert values["skew_rms"] == pytest.approx(math.sqrt(np.mean(column("roller_skew") ** 2)))
    assert values["skew_rms"] > 1.05 * abs(column("roller_skew").mean())
    force = column("pocket_force")
    assert values["pocket_force_p95"] == pytest.approx(np.percentile(force[force > 0.0], 95.0))
    assert values["pocket_duty"] == pytest.approx((force.max(axis=2) > 0.0).mean())
    gained = {name: column(name)[-1] - column(name)[0] for name in ("work_shaft", "shaft_angle", "time")}
    assert values["torque"] == pytest.approx(gained["work_shaft"] / gained["shaft_angle"])
    assert values["torque_outer"] == pytest.approx(1.6)
    shares = {name: column(f"inner_torque_{name}").mean() for name in ("traction", "rolling", "rib")}
    assert {name: values["torque_split"][name] for name in shares} == pytest.approx(shares)
    assert values["torque_split"]["front_rib"] == 0.0
    losses = [field.name for field in result.fields if field.name.startswith("loss_")]
    lost = sum(float(column(name)[-1] - column(name)[0]) for name in losses)
    assert values["power_loss"] == pytest.approx(lost / gained["time"])
    assert values["power_split"]["rolling"] == pytest.approx(220.0, rel=1e-6)
    assert values["power_split"]["traction_outer"] == pytest.approx(40.0, rel=1e-6), (
        "not what was lost before the window"
    )
    assert values["power_split"]["rib"] == pytest.approx(70.0, rel=1e-6)
    tilt = column("cage_tilt")
    assert values["tilt_rms"] == pytest.approx(math.sqrt((tilt[:, 0] ** 2 + tilt[:, 1] ** 2).mean()))


def test_quantiles_and_means_of_the_whirl(build: Callable[..., tuple[Any, Result]]) -> None:
    """A radius that goes to and fro evenly between 0.5 and 0.9 Cpr."""
    run, result = build(n=4001, duration=0.4)
    play, time = result.clearances.radial, run.column("time")
    saw = np.abs(np.mod(200.0 * time, 2.0) - 1.0)
    unit = run.column("cage_position")[:, :2] / (0.9 * play)
    run.column("cage_position")[:, :2] = unit * (0.5 + 0.4 * saw[:, np.newaxis]) * play
    values = run.result(result.scene).summary()
    assert values["axis_distance_over_cpr"] == pytest.approx(0.7, abs=2e-3)
    assert values["axis_distance_over_cpr_p05"] == pytest.approx(0.52, abs=5e-3)
    assert values["axis_distance_over_cpr_p95"] == pytest.approx(0.88, abs=5e-3)


def test_numbers_of_a_known_whirl(whirling: Result, synthetic: Any) -> None:
    values = whirling.summary()
    assert values["revolutions"] == pytest.approx(20.0)
    assert values["duration"] == pytest.approx(0.4)
    assert values["cage_speed_ratio"] == pytest.approx(0.41662)
    assert values["cage_speed_ratio_kinematic"] == 0.41662
    assert values["cage_slip"] == pytest.approx(1e-3, abs=1e-9)
    assert values["whirl_ratio"] == pytest.approx(1.0, rel=1e-3)
    assert values["whirl_frequency"] == pytest.approx(0.41662 * 50.0, rel=1e-3)
    assert values["cage_motion"] == whirling.settled.cage_motion.kind
    assert values["speed_deviation_ratio"] == pytest.approx(0.0, abs=1e-9)
    # the play is 0.4 mm; z goes to and fro by 0.01 mm about 0.03 mm
    assert values["axial_over_clearance"] == pytest.approx(0.075, abs=2e-3)
    assert values["tilt_rms"] == pytest.approx(2e-4)
    # (-sin, cos) of the cage's own direction: leaning to it by the whole tilt
    assert values["lean_mean"] == pytest.approx(2e-4)
    assert values["spacing_std_deg"] == pytest.approx(gap_spread(), rel=1e-9)
    assert values["energy_residual"] == pytest.approx(synthetic.residual)
    assert values["energy_closure"] == pytest.approx(synthetic.residual / synthetic.dissipated)
    assert values["wall_s"] == 2.5
    assert values["wall_s_per_revolution"] == pytest.approx(2.5 / 20.0)


def gap_spread() -> float:
    """Of rollers that are off their even places by 0.4 deg times the sine of their place."""
    place = [30.0 * j + 0.4 * math.sin(math.radians(30.0 * j)) for j in range(13)]
    gaps = [after - before for before, after in itertools.pairwise(place)]
    mean = sum(gaps) / 12
    return math.sqrt(sum((gap - mean) ** 2 for gap in gaps) / 12)


# ---- observables ----

TIME = np.array([0.0, 1.0, 3.0])


def test_splits_by_hand() -> None:
    losses = {"loss_rib": np.array([5.0, 7.0, 11.0]), "loss_pocket": np.array([1.0, 1.0, 4.0])}
    powers = {"power_rib": np.array([100.0, 200.0, 600.0]), "power_loss": np.array([1.0, 2.0, 3.0])}
    assert observables.power_split(TIME, losses, powers) == {"rib": 2.0, "pocket": 1.0}
    assert observables.power_split(TIME, {}, powers) == {"rib": 300.0}
    assert observables.power_split(TIME[:1], {"loss_rib": np.array([5.0])}, {"power_rib": np.array([7.0])}) == {
        "rib": 7.0
    }
    torques = {
        "inner_torque": np.array([9.0]),
        "inner_torque_rib": np.array([1.0, 2.0, 6.0]),
        "inner_torque_rolling": np.array([-1.0, 0.0, -2.0]),
    }
    assert observables.torque_split(torques) == {"rib": 3.0, "rolling": -1.0}


def test_audit_by_hand() -> None:
    terms = {
        "work_shaft": np.array([10.0, 20.0, 40.0]),
        "work_gravity": np.array([1.0, 1.0, 0.0]),
        "kinetic_energy": np.array([3.0, 4.0, 8.0]),
        "elastic_energy": np.array([2.0, 2.0, 1.0]),
        "loss_rib": np.array([0.0, 5.0, 15.0]),
        "loss_pocket": np.array([2.0, 4.0, 9.0]),
    }
    balance = observables.energy_balance(terms)
    np.testing.assert_array_equal(balance["residual"], [0.0, 2.0, 3.0])
    audit = observables.energy_audit(terms)
    assert audit.work == {"shaft": 30.0, "gravity": -1.0}
    assert audit.stored == {"kinetic": 5.0, "elastic": -1.0}
    assert audit.losses == {"rib": 15.0, "pocket": 7.0}
    assert (audit.residual, audit.dissipated) == (3.0, 22.0)
    assert audit.closure == 3.0 / 22.0
    assert audit.relative_residual == 3.0 / 30.0


def test_pocket_statistics_by_hand() -> None:
    force = np.zeros((5, 2, 2))
    force[:, 0, 0] = [0.0, 10.0, 20.0, 0.0, 40.0]
    force[:, 1, 1] = [1.0, 1.0, 1.0, 1.0, 5.0]
    found = observables.pocket_statistics(force)
    np.testing.assert_array_equal(found.peak, [[40.0, 0.0], [0.0, 5.0]])
    np.testing.assert_allclose(found.mean, [[14.0, 0.0], [0.0, 1.8]])
    np.testing.assert_allclose(found.duty, [[0.6, 0.0], [0.0, 1.0]])
    # 95 % of the way through three values, 10, 20, 40: a tenth before the last
    np.testing.assert_allclose(found.p95, [[38.0, 0.0], [0.0, 4.2]])
    higher = observables.pocket_statistics(force, threshold=10.0)
    np.testing.assert_allclose(higher.duty, [[0.4, 0.0], [0.0, 0.0]])
    np.testing.assert_allclose(higher.p95, [[39.0, 0.0], [0.0, 0.0]])


def test_slip_and_spacing_by_hand() -> None:
    np.testing.assert_allclose(observables.kinematic_slip([90.0, 0.0, 5.0], [200.0, 200.0, 0.0], 0.5)[:2], [0.1, 1.0])
    assert math.isnan(observables.kinematic_slip([90.0, 0.0, 5.0], [200.0, 200.0, 0.0], 0.5)[2])
    np.testing.assert_allclose(observables.kinematic_slip([[90.0, 110.0]], [200.0], 0.5), [[0.1, -0.1]])
    angle = np.radians([[0.0, 100.0, 230.0], [10.0, 110.0, 240.0]])
    np.testing.assert_allclose(np.degrees(observables.spacing(angle)), [[100.0, 130.0, 130.0]] * 2)
    np.testing.assert_allclose(np.degrees(observables.spacing(angle, 2)), [[230.0, 260.0, 230.0]] * 2)
    # gaps of 80, 80 and 200 deg: two in a row are less than half a turn, or nearly a whole one
    wide = np.radians([[0.0, 80.0, 160.0]])
    np.testing.assert_allclose(np.degrees(observables.spacing(wide, 2)), [[160.0, 280.0, 280.0]])
    np.testing.assert_allclose(observables.spacing_std(angle), [math.sqrt(200.0)] * 2)


def test_settling_by_hand() -> None:
    """Eight batches of two: the first two are far off, the rest scatters evenly."""
    values = np.array([100.0, 100.0, 50.0, 50.0, *[1.0, 1.0, 2.0, 2.0] * 3])
    found = observables.settling(np.arange(16.0) * 0.5, values, 8)
    assert (found.index, found.time, found.settled) == (4, 2.0, True)
    drifting = observables.settling(np.arange(16.0), np.arange(16.0), 8)
    assert (drifting.index, drifting.settled) == (8, False)


def test_cage_by_hand() -> None:
    position = np.array([[3.0, 4.0, 0.0], [0.0, -2.0, 1.0]])
    np.testing.assert_array_equal(observables.axis_distance(position), [5.0, 2.0])
    np.testing.assert_array_equal(observables.locus(position, 0.5), [[6.0, 8.0], [0.0, -4.0]])
    assert observables.cage_speed_ratio([1.0, 5.0], [2.0, 12.0]) == 0.4
    assert math.isnan(observables.cage_speed_ratio([1.0, 5.0], [2.0, 2.0]))
    assert observables.cage_frequency([0.0, 2.0], [1.0, 1.0 + 8.0 * math.pi]) == pytest.approx(2.0)
    turn = np.linspace(0.0, 3.0, 301)
    circle = np.stack([np.cos(-4.0 * math.pi * turn) + 5.0, np.sin(-4.0 * math.pi * turn) - 1.0, 0.0 * turn], axis=1)
    assert observables.whirl_frequency(turn, circle) == pytest.approx(-2.0, abs=0.02)


def test_slip_of_the_set_is_the_mean_of_its_rollers(build: Callable[..., tuple[Any, Result]]) -> None:
    run, result = build(n=201)
    speed = run.column("roller_orbit_speed")
    speed[:, 0] *= 0.9
    values = run.result(result.scene)
    expected = 1.0 - (11.0 * 0.999 + 0.9 * 0.999) / 12.0
    np.testing.assert_allclose(values.cage_slip, expected, rtol=1e-9)


def test_derived_by_hand(whirling: Result) -> None:
    np.testing.assert_allclose(whirling.axial_motion, whirling.cage_position[:, 2] / 0.4e-3)
    np.testing.assert_allclose(whirling.cage_locus("rail"), 1.05 * whirling.cage_locus("centre"))
    np.testing.assert_allclose(whirling.axis_distance_over_cpr, 0.9)
    np.testing.assert_allclose(whirling.roller_slip, 1e-3, atol=1e-12)
    np.testing.assert_allclose(whirling.spin_slip, 0.0, atol=1e-12)
    assert whirling.torque_by_loss["rolling"] == pytest.approx(220.0 / (2 * np.pi * 50.0))
    assert whirling.clearances.circumferential == 0.12e-3
    with pytest.raises(trb.InputError, match="plane"):
        whirling.cage_locus("side")  # type: ignore[arg-type]
    assert whirling.n_rollers == 12
    part = whirling.window(0.1, 0.2)
    assert (part.time[0], part.time[-1], len(part)) == (pytest.approx(0.1), pytest.approx(0.2), 1001)
    assert part.duration == pytest.approx(0.1)
    assert part.revolutions == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("stats", "wanted"),
    [
        ({"wall_s": 2.5, "wall_s_per_revolution": 0.07}, 0.07),
        ({"wall_s": 2.5}, 2.5 / 20.0),
        ({"wall_s_per_revolution": 0.07}, 0.07),
        ({}, None),
    ],
)
def test_wall_time_of_a_turn_is_what_the_statistics_tell(
    stats: dict[str, float], wanted: float | None, synthetic: Any, whirling: Result
) -> None:
    """That of stepping, which the run measured; only where it did not, the whole wall time over the turns."""
    result = synthetic.result(whirling.scene, stats=stats)
    found = result.summary().get("wall_s_per_revolution")
    assert found == (None if wanted is None else pytest.approx(wanted))


def test_torque_and_loss_are_those_of_the_run_and_not_of_its_records() -> None:
    """A cage that collides: means of records every millisecond are off by half a per cent, work over turn is not."""
    scene = trb.cases.paper_30310(3000.0, 1230.0, start=trb.Start.whirl(0.9))
    coarse, fine = (trb.Simulation(scene).run(revolutions=2, save_every=every).summary() for every in (1e-3, 1e-4))
    for name in ("torque", "power_loss"):
        assert coarse[name] == pytest.approx(fine[name], rel=1e-9)


def test_turns_are_those_of_all_rollers_and_not_of_the_fastest(build: Callable[..., tuple[Any, Result]]) -> None:
    """0.18 s at 20.831 turns a second are 3.75 turns; one roller of twelve that gains half a turn adds a twenty-fourth."""
    run, _ = build(n=1801, duration=0.18)
    run.column("roller_orbit_angle")[:, 11] += np.pi * run.column("time") / 0.18
    found = run.result(build()[1].scene).settling()
    assert (found.answer, found.reason) == ("unknown", "only 3.8 turns of the cage")


def test_settling_knows_the_cage_by_the_size_of_its_play(build: Callable[..., tuple[Any, Result]]) -> None:
    """An orbit that grows by a fifth of the play while the rollers stand still is drift; in metres it would be nothing."""
    run, result = build(n=4001, duration=2.0)
    clearance = result.clearances.radial
    grows = np.linspace(0.3, 0.5, 4001)[:, None] * clearance
    place = run.column("cage_position")
    place[:, :2] *= grows / np.linalg.norm(place[:, :2], axis=1, keepdims=True)
    found = run.result(result.scene).settling()
    assert found.answer == "drifting"
