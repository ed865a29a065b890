"""The paper's statements, fig. 8 to 18, by shorter runs than the campaign's: 2 to 3 min of processor time in all, with
-m slow.

Conditions are the paper's; bearing times are 2 to 10 s where the campaign takes 10 to 60 s, so whirls that take longer
to grow are started as whirls. Tolerances are `T` times the standard deviation over three seeds of random spacing in
the campaign (benchmarks/paper/paper.json), or over the seeds of these runs. What we find not to hold is a strict xfail.
"""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from paper.movable import Pockets
from paper.point_numbers import read_run
from paper.points import SCATTER, Condition, Point, StartKind
from paper.settle import Plan, PointTask, run_point

pytestmark = pytest.mark.slow

T = 4.3
"""Student's t for three seeds, two-sided 95 %."""
SEEDS = (0, 1, 2)
CAMPAIGN = Path(__file__).resolve().parents[2] / "benchmarks" / "paper" / "paper.json"
ABOUT_ONE, MUCH, CLEARLY = 0.15, 2.0, 1.5
"""How the paper's "about 1", "much higher", "clearly larger" are read."""

SLOW, MIDDLE, FAST = (Condition(speed, 3080.0) for speed in (1000.0, 2000.0, 3000.0))
LIGHT, HEAVY = Condition(3000.0, 1230.0), Condition(3000.0, 4930.0)
LIGHT_SLOW, SCATTERED = Condition(1000.0, 1230.0), Condition(3000.0, 1230.0, scatter=SCATTER)
COMBINED = Condition(2000.0, 4930.0, 5530.0)
COMBINED_FAST = Condition(3000.0, 4930.0, 5530.0)
OTHERS = {
    "1000 rpm": Condition(1000.0, 4930.0, 5530.0),
    "3000 rpm": COMBINED_FAST,
    "2780 N": Condition(2000.0, 4930.0, 2780.0),
    "8380 N": Condition(2000.0, 4930.0, 8380.0),
}
SECONDS = {SLOW: 9.5, LIGHT: 1.5, SCATTERED: 1.5}
"""Bearing time before the 0.5 s of statistics, 3 s for others: at 1000 rpm a whirl takes this long to die, at 1230 N
everything is over in a few turns of the cage."""

Run = Any


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("points")

    @cache
    def numbers(
        condition: Condition, start: StartKind = "whirl", seed: int = 0, seconds: float = 0.0
    ) -> dict[str, Any]:
        before = seconds or SECONDS.get(condition, 3.0)
        plan = Plan(least_time=before, most_time=before, least_time_combined=before, most_time_combined=before)
        point = Point(condition, start, seed)
        path = folder / f"{point.name}_{before:g}.h5"
        report = run_point(PointTask(point, plan, str(path)), lambda: False)
        assert report.status == "done", report.message
        found = read_run(path)
        assert found is not None
        return found.numbers

    return numbers


def taken(numbers: dict[str, Any], *names: str | int) -> float:
    """A number; several names lead into tables."""
    value: Any = numbers
    for name in names:
        value = value[name]
    return float(value)


@cache
def campaign() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(CAMPAIGN.read_text())["points"]
    return found


def scatter(condition: Condition, *names: str | int) -> float:
    """Standard deviation over the seeds of random spacing in the campaign."""
    values = [taken(campaign()[Point(condition, "unequal", seed).name], *names) for seed in SEEDS]
    return float(np.std(values, ddof=1))


def margin(one: Condition, other: Condition, *names: str | int) -> float:
    """What a difference between two conditions must exceed."""
    return T * math.hypot(scatter(one, *names), scatter(other, *names))


REACH = ("whirl_radius_over_cpr", "p95")
dies = pytest.mark.xfail(
    strict=True, reason="at 1000 rpm, 3080 N every whirl of equal rollers dies: the cage comes to rest at one place"
)


@pytest.mark.parametrize("condition", [pytest.param(SLOW, marks=dies), MIDDLE, FAST], ids=lambda c: c.name)
def test_8a_the_cage_whirls_at_its_own_frequency(run: Run, condition: Condition) -> None:
    found = run(condition)
    assert found["cage_motion"] == "circling"
    # half a turn in the turns of the statistics: what the ratio cannot tell
    assert found["whirl_ratio"] == pytest.approx(1.0, abs=0.5 / found["cage_turns"])


def test_8a_the_radius_grows_with_the_speed(run: Run) -> None:
    slow, middle, fast = (run(condition)["orbit_over_cpr"] for condition in (SLOW, MIDDLE, FAST))
    assert middle - slow > margin(SLOW, MIDDLE, "orbit_over_cpr")
    assert fast - middle > margin(MIDDLE, FAST, "orbit_over_cpr")


same = pytest.mark.xfail(strict=True, reason="the large whirl at 3080 N, which lasts, is as large as that at 4930 N")


@pytest.mark.parametrize("start", ["equal", pytest.param("whirl", marks=same)])
def test_8b_the_radius_grows_with_the_load(run: Run, start: StartKind) -> None:
    """At 4930 N from the whirling start: from rest that orbit takes 40 s."""
    light, middle = (run(condition, start)["orbit_over_cpr"] for condition in (LIGHT, FAST))
    assert middle - light > margin(LIGHT, FAST, "orbit_over_cpr")
    assert run(HEAVY)["orbit_over_cpr"] - middle > margin(FAST, HEAVY, "orbit_over_cpr")


def test_8b_it_reaches_about_one_at_the_highest_load(run: Run) -> None:
    assert taken(run(HEAVY), *REACH) > 1.0 - ABOUT_ONE + T * scatter(HEAVY, *REACH)
    assert run(HEAVY)["cage_motion"] == "circling"


@pytest.mark.parametrize("start", ["equal", "whirl"])
def test_12b_no_clear_whirl_at_the_lowest_load(run: Run, start: StartKind) -> None:
    found = run(LIGHT, start)
    assert found["cage_motion"] != "circling"
    # clear would be as large as what scattered diameters excite
    least = min(run(SCATTERED, "whirl", seed)["whirl_amplitude_over_cpr"] for seed in SEEDS)
    assert found["whirl_amplitude_over_cpr"] + T * scatter(LIGHT, "whirl_amplitude_over_cpr") < least


def test_9_axial_motion_grows_with_the_speed(run: Run) -> None:
    slow, middle, fast = (taken(run(condition), "axial_range", 1) for condition in (SLOW, MIDDLE, FAST))
    assert middle - slow > margin(SLOW, MIDDLE, "axial_range", 1)
    assert fast - middle > margin(MIDDLE, FAST, "axial_range", 1)


far = pytest.mark.xfail(
    strict=True, reason="in the whirl of 0.75 Cpr at 3000 rpm, 3080 N the cage moves by a third of its axial play"
)


@pytest.mark.parametrize("start", ["equal", pytest.param("whirl", marks=far)])
def test_9_it_stays_under_15_percent_of_the_play(run: Run, start: StartKind) -> None:
    assert taken(run(FAST, start), "axial_range", 1) + T * scatter(FAST, "axial_range", 1) < 0.15


rests = pytest.mark.xfail(
    strict=True, reason="at 1000 rpm, 1230 N the cage hangs still; its tilt is strongest at order 12"
)


@pytest.mark.parametrize("condition", [pytest.param(LIGHT_SLOW, marks=rests), HEAVY], ids=lambda c: c.name)
def test_10_the_tilts_fundamental_is_at_the_cage_frequency(run: Run, condition: Condition) -> None:
    assert run(condition)["tilt_peak_order"] == 1


@pytest.mark.parametrize("condition", [LIGHT_SLOW, HEAVY], ids=lambda c: c.name)
def test_10_the_cage_leans_to_its_displacement(run: Run, condition: Condition) -> None:
    found = run(condition)
    assert found["lean_mean"] > T * scatter(condition, "lean_mean")
    assert found["tilt_x_with_y"] < -T * scatter(condition, "tilt_x_with_y")


def test_13_forces_are_much_higher_at_3000_rpm(run: Run) -> None:
    """From random spacing; the mean of the seeds, as a single one tells less than the factor asks for."""
    slow = run(SLOW, "equal")["pocket_force_p95"] + T * scatter(SLOW, "pocket_force_p95")
    fast = [run(FAST, "unequal", seed)["pocket_force_p95"] for seed in SEEDS]
    error = float(np.std(fast, ddof=1)) / math.sqrt(len(fast))
    assert float(np.mean(fast)) - T * error > MUCH * slow


def test_13_forces_are_much_higher_at_3000_rpm_in_the_large_whirl(run: Run) -> None:
    slow, fast = (run(condition)["pocket_force_p95"] for condition in (SLOW, FAST))
    assert fast - T * scatter(FAST, "pocket_force_p95") > MUCH * (slow + T * scatter(SLOW, "pocket_force_p95"))


def test_14_gaps_change_with_the_cages_turn_at_the_lowest_load(run: Run) -> None:
    found = run(LIGHT)
    assert found["spacing_varies_deg"] > found["spacing_mean_std_deg"] + T * scatter(LIGHT, "spacing_varies_deg")
    assert found["spacing_order_share"] > 0.5 + T * scatter(LIGHT, "spacing_order_share")


@pytest.mark.parametrize("start", ["equal", "whirl"])
def test_14_gaps_are_unequal_and_persistent_at_the_highest_load(run: Run, start: StartKind) -> None:
    found = run(HEAVY, start)
    assert found["spacing_mean_std_deg"] > found["spacing_varies_deg"] + T * scatter(HEAVY, "spacing_mean_std_deg")


def test_15_the_whirl_is_clearly_larger_with_scatter(run: Run) -> None:
    even = run(LIGHT)["orbit_over_cpr"] + T * scatter(LIGHT, "orbit_over_cpr")
    assert min(run(SCATTERED, "whirl", seed)["orbit_over_cpr"] for seed in SEEDS) > CLEARLY * even


def test_16_the_orbit_is_smaller_under_combined_load(run: Run) -> None:
    combined, alone = (run(condition)["orbit_over_cpr"] for condition in (COMBINED_FAST, HEAVY))
    assert alone - combined > margin(COMBINED_FAST, HEAVY, "orbit_over_cpr")


small = pytest.mark.xfail(
    strict=True,
    reason="with the loaded zone on top, Fr 8380 N, the cage hangs still nearer the axis; where rollers descend it does not",
)
CONDITIONS = [COMBINED, *(pytest.param(c, marks=small) if name == "8380 N" else c for name, c in OTHERS.items())]


@pytest.mark.parametrize("condition", CONDITIONS, ids=lambda c: c.name)
def test_16_the_locus_reaches_the_circumferential_play(run: Run, condition: Condition) -> None:
    cage = Point(condition, "equal").scene().bearing.cage
    size = cage.play_circumferential / cage.play_radial
    assert taken(run(condition, "equal"), *REACH) == pytest.approx(size, abs=T * scatter(condition, *REACH))


OTHER = [pytest.param(c, marks=small) if name == "8380 N" else c for name, c in OTHERS.items()]


@pytest.mark.parametrize("condition", OTHER, ids=lambda c: c.name)
def test_16_it_does_not_depend_on_speed_and_radial_load(run: Run, condition: Condition) -> None:
    one, other = (taken(run(c, "equal"), *REACH) for c in (condition, COMBINED))
    assert abs(one - other) < margin(condition, COMBINED, *REACH)


def test_17_the_cage_moves_farther_with_unequal_spacing() -> None:
    scene = Point(HEAVY, "equal").scene()
    cage, pockets = scene.bearing.cage, Pockets(scene)
    directions = np.radians(np.arange(0.0, 30.0, 7.5))
    equal, free = (
        found.distance / cage.play_radial for found in (pockets.held(0.0, directions), pockets.free(directions))
    )
    # geometry, found to 1e-9 m: nothing scatters
    assert equal.max() < cage.play_circumferential / cage.play_radial
    assert free.min() > 2.0 * equal.max()


def test_18_spacings_drift_to_equal(run: Run) -> None:
    changes = [
        math.log(found["spacing_std_deg"] / found["spacing_std_start_deg"])
        for found in (run(COMBINED, "unequal", seed) for seed in SEEDS)
    ]
    error = float(np.std(changes, ddof=1)) / math.sqrt(len(changes))
    assert float(np.mean(changes)) + T * error < math.log(0.5)
