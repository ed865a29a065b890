"""What a cage does in the long run: one quick scene from all starts, what is said of scatter, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.extras.maps.cage_answer import CageAnswer, OfRollers
from trbdyn.results.observables import Compared

SCENE = trb.cases.scene_30310(3000.0, 4930.0)


def row(scatter: float, verdict: Any, orbit: float, kind: str, **more: Any) -> OfRollers:
    return OfRollers("", scatter, 1, Compared(verdict, orbit, 0.02, **more), kind, 12.0, 30.0, 120, 9.0)


def test_scatter_that_changes_the_answer_is_said() -> None:
    falls = row(0.0, "dies", 0.10, "stable", rate=-0.02, rate_error=0.001, time_low=4.0, time_high=16.0)
    told = CageAnswer(
        (falls, row(0.2e-6, "agreed", 0.90, "circling"), row(1e-6, "agreed", 0.12, "stable")), {"": 4000.0}, "x"
    )
    text = str(told)
    assert (
        "shrinks by 0.02 Cpr in a second towards 0.10 Cpr, where it does not whirl; expected there after 4 to 16 s"
        in text
    )
    assert "with a scatter of 0.2 um (seed 1) the cage whirls (0.90 Cpr); with equal" in text.replace("\n", " ")
    assert "scatter of 1 um" not in " ".join(told.warnings)
    assert "the rollers creep within 4e+03 turns" in text.replace("\n", " ")
    open_one = row(0.0, "unknown", 0.5, "unknown", reason="the rollers creep")
    said = CageAnswer((open_one, row(1e-6, "agreed", 0.94, "circling")), {"": math.nan}, "x").warnings
    assert said == (
        "with rollers with a scatter of 1 um (seed 1) the cage whirls (0.94 Cpr); with equal rollers, which nobody has, it "
        "cannot be told",
    )


def test_words_of_starts_that_agree() -> None:
    assert row(0.0, "agreed", 0.7, "circling").words == "all starts agree: it whirls, orbit 0.70 Cpr within 0.02"
    comes = row(0.0, "agreed", 0.1, "stable", rate=-0.02, rate_error=0.001).words
    assert comes == (
        "two of three starts agree: it does not whirl, orbit 0.10 Cpr within 0.02; the orbit of the last one still shrinks by "
        "0.02 Cpr in a second towards it"
    )
    alike = replace(row(0.0, "alike", 0.7, "circling", ends=(0.8, 0.6)), kinds=("circling", "circling"))
    assert alike.words == "it whirls from all starts; their orbits differ or wander: 0.60 to 0.80 Cpr"
    two = replace(row(0.0, "agreed", 0.23, "rocking"), near=("rocking", "unstable"))
    assert two.words == "all starts agree: it hangs and rocks or moves without order, orbit 0.23 Cpr within 0.02"
    goes = row(0.0, "so far", 0.7, "circling", ends=(0.8, 0.6), reason="from rest the roller spacing increases").words
    assert goes == (
        "so far it whirls from all starts, orbit 0.60 to 0.80 Cpr; it may go on to another motion: from rest the roller spacing "
        "increases"
    )


def test_words_of_a_direction() -> None:
    """Whose way it is, and when it comes there, if ever."""
    way = {"rate": 0.05, "rate_error": 0.001, "time_low": 4.0, "movers": (0,)}
    assert row(0.0, "grows", 0.9, "circling", time_high=16.0, **way).words == (
        "from rest the orbit grows by 0.05 Cpr in a second towards 0.90 Cpr, where it whirls; expected there after 4 to 16 s more"
    )
    late = row(0.0, "grows", 0.9, "circling", time_high=math.inf, **way).words
    assert late.endswith("expected there after 4 s more at the earliest; it slows down and may end before")


@pytest.mark.slow
def test_all_starts_come_to_one_motion() -> None:
    """The answer of three starts is that of a run of its own, five times as long."""
    scene = trb.cases.scene_30310(6000.0, 4930.0)
    (one,) = trb.cage_answer(scene, scatter=[0.0]).rows
    assert one.found.verdict == "agreed"
    turns = 5.0 * one.turns / scene.bearing.geometry.cage_speed_ratio
    alone = trb.Simulation(scene.replace(start=trb.Start.equal()), accuracy="fast").run(revolutions=turns)
    late = alone.window(0.6 * alone.duration)
    assert late.cage_motion.kind == one.kind
    assert late.cage_motion.orbit_over_play == pytest.approx(one.found.orbit, abs=0.1)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"scatter": []}, "scatter"),
        ({"scatter": [2e-3]}, "range"),
        ({"seeds": []}, "seeds"),
        ({"processor_time": 0.0}, "processor_time"),
        ({"subject": SCENE.replace(effects=SCENE.effects.replace(bodies="rollers"))}, "rollers_and_cage"),
        ({"subject": SCENE.replace(speed_rpm=trb.History.ramp(0.0, 0.1, 0.0, 3000.0))}, "constant"),
        ({"subject": SCENE.replace(speed_rpm=0.0)}, "must not be 0"),
    ],
)
def test_refusals(given: dict[str, Any], words: str) -> None:
    with pytest.raises(trb.InputError, match=words):
        trb.cage_answer(**{"subject": SCENE, **given})
