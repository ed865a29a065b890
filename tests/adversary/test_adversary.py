"""A bounded part of `make adversary`: new random scenes of every kind, and the failures of earlier ones."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import judge as judging
import numpy as np
import pytest
from chance import mean_difference, move
from judge import MOST_STEPS, bounded_run, by_chance, judge, scene_duration
from random_scenes import KINDS, ORDINARY, draw, make

import trbdyn as trb

HERE = Path(__file__).resolve().parent

pytestmark = pytest.mark.usefixtures("probes")
FINE = ("right", "warned", "chance", "stopped", "refused", "unjudged")
FOUND = sorted((HERE / "found").glob("*.json"))


QUICK = {"filmed": (3,), "guided": (2,), "housed": (4,), "pair": (3,), "outer": (3,), "free": (3,), "cylindrical": (1,)}
QUICK |= {
    "damped": (3,),
    "drop": (1,),
    "hub": (1,),
    "pitted": (4,),
    "repeating": (2,),
    "supported": (1,),
    "wide": (3,),
    "usual": (4,),
}
"""Seeds of the scenes of each kind that are not among the slow tests; 0 of the others."""
SHORT = 2000
"""Most steps of their runs, but of those whose load changes; `make adversary` takes 6000."""


def _seeds() -> list[Any]:
    """Five scenes of each kind."""
    return [
        pytest.param(kind, seed, marks=[] if seed in QUICK.get(kind, (0,)) else [pytest.mark.slow])
        for kind in sorted(KINDS)
        for seed in range(5)
    ]


@pytest.mark.parametrize(("kind", "seed"), _seeds())
def test_random_scenes_are_right_or_say_so(kind, seed, monkeypatch):
    if kind not in ("drop", "hub", "repeating"):
        monkeypatch.setattr(judging, "MOST_STEPS", SHORT)
    verdict = judge(draw(kind, 1000 + seed))
    assert verdict.status in FINE, verdict.broken


def _case(path: Path) -> Any:
    marks = [pytest.mark.slow] if json.loads(path.read_text()).get("slow") else []
    return pytest.param(path, id=path.stem, marks=marks)


@pytest.mark.parametrize("path", list(map(_case, FOUND)))
def test_found_failures_stay_mended(path):
    """A file may say that an end with a reason is no longer good enough for its scene, and what the run has to say."""
    found = json.loads(path.read_text())
    verdict = judge(found["scene"])
    assert verdict.status in found.get("fine", FINE), verdict.broken
    if "says" in found:
        assert verdict.run is not None
        assert any(found["says"] in text for text in verdict.run.warnings), verdict.run.warnings


@pytest.mark.parametrize(
    ("kind", "seed"), [pytest.param("cylindrical", 97000007, marks=pytest.mark.slow), ("usual", 97000013)]
)
def test_a_difference_by_chance_gives_no_warning(kind, seed):
    """A piece of 20 ms shows a difference in these right runs by CVODE, a longer one shows that there is none."""
    table = ORDINARY | draw(kind, seed)
    scene = make(table)
    sim = trb.Simulation(scene, accuracy=table["accuracy"], integrator="bdf")
    run = bounded_run(sim, scene_duration(scene), MOST_STEPS)
    assert run.warnings == ()


def test_what_steps_take_after_a_drop_of_load_is_seen_in_the_whole_run():
    """A wheel hub without damping, whose load falls to a tenth at 5.4 ms and comes back at 12.5 ms, loses a third too little
    between them, and 3.5 +/- 2.4 % in all of its run.
    """
    scene = make(draw("hub", 98000011))
    run = bounded_run(trb.Simulation(scene), scene_duration(scene), MOST_STEPS)
    said = next(text for text in run.warnings if "vibrate" in text)
    loss = re.search(r"the loss is ([\d.]+) to ([\d.]+) % too low", said)
    assert loss is not None, said
    assert 0.5 < float(loss[1]) < 3.5 < float(loss[2])


def test_an_interval_that_leaves_much_open_is_no_proof():
    """One piece shows next to no difference by chance, within 24 %; the loss is a tenth too low."""
    table = ORDINARY | draw("pieces", 99000021)
    scene = make(table)
    sim = trb.Simulation(scene, accuracy=table["accuracy"], integrator="bdf")
    run = bounded_run(sim, scene_duration(scene), MOST_STEPS, pieces=table["pieces"])
    assert any("vibrate" in text for text in run.warnings)


def test_the_judge_sees_a_run_that_is_wrong():
    """Tolerances that are far too large: energy is made and losses are off, and the judge's measures show it."""
    scene = make(draw("usual", 3) | {"speed_rpm": 200.0, "start": "equal"})
    good = bounded_run(trb.Simulation(scene, accuracy="reference"), 0.02, 20_000)
    loose = {
        "rtol": 0.1,
        "atol_position": 1e-6,
        "atol_angle": 1e-4,
        "atol_velocity": 1.0,
        "atol_spin": 100.0,
        "impact_share": 1e3,
    }
    bad = bounded_run(trb.Simulation(scene, **loose), 0.02, 20_000)
    assert good.closure < 1e-2
    assert bad.closure > 1e-2 or abs(bad.loss - good.loss) > 0.05 * good.loss
    assert bad.warnings


def test_seeds_give_the_same_scene_again():
    assert draw("wide", 7) == draw("wide", 7) != draw("wide", 8)


@pytest.mark.parametrize(("bias", "scatter", "chance"), [(0.0, 0.03, True), (0.05, 0.03, False), (0.0, 0.3, False)])
def test_moved_runs_tell_a_bias_from_chance(bias, scatter, chance):
    """The mean of moved runs shows a bias of the tolerances, and no bias only where the mean is known well enough."""
    rng = np.random.default_rng(1)
    off, error = mean_difference(lambda _: (1.0 + bias + scatter * float(rng.standard_normal()), 1.0), 32)
    assert abs(off - bias) <= 1.5 * error
    assert by_chance(off, error) is chance
    assert mean_difference(lambda _: (math.nan, 1.0)) == (math.inf, math.inf)


def test_moved_runs_begin_beside_each_other():
    scene = make(draw("usual", 3))
    first, second, third = (move(trb.Simulation(scene), number).state.vector for number in (0, 1, 2))
    assert not np.array_equal(second, third)
    np.testing.assert_allclose(first, second, rtol=5e-5)
