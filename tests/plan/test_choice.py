"""The choice of the cheapest set: answers that are computed by hand, and every set tried in another way."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from trbdyn.extras.design.planning.choice import LEAST_ROOM, Choice, Option, Task, choose

NONE = np.zeros(1)
PLAIN = Option("plain", NONE, 1.0)


def task(want: float = 0.02, scatter: float = 0.01, fixed: float = 0.0, **other: float) -> Task:
    """An average that is known within `scatter` after 1 s, on a machine that needs 2 s for a second."""
    given = {"window": 1.0, "settle": 0.5, "least": 1e-3, "most": 1e3, "rate": 2.0} | other
    return Task(want=np.array([want]), fixed=np.array([fixed]), scatter=np.array([scatter]), **given)


def test_without_anything_to_choose_the_length_follows_from_the_scatter() -> None:
    """Half the scatter takes four times as long."""
    found = choose(task(), [], [PLAIN])
    assert found.averaging == pytest.approx(0.25)
    assert found.cost == pytest.approx(2.0 * 0.75)
    assert found.errors == pytest.approx([0.02])
    assert found.within
    assert choose(task(want=0.01), [], [PLAIN]).averaging == pytest.approx(1.0)


def test_an_error_of_the_model_makes_the_run_longer() -> None:
    """Half of the wish for the model leaves the other half: a run four times as long, at 0.8 s a second in place of 2 s."""
    half = Option("half", np.array([0.01]), 0.4)
    found = choose(task(), [half], [PLAIN])
    assert found.left_out == ("half",)
    assert found.averaging == pytest.approx(1.0)
    assert found.cost == pytest.approx(0.8 * 1.5)  # less than the 1.5 s of a run without it
    dear = Option("dear", np.array([0.0125]), 0.5)  # (0.5 + 1.78) s at 1 s a second: more than 1.5 s
    assert choose(task(), [dear], [PLAIN]).left_out == ()


def test_what_costs_more_than_the_wish_is_never_made() -> None:
    wrong = Option("wrong", np.array([0.021]), 1e-3)
    found = choose(task(), [wrong], [PLAIN])
    assert found.left_out == ()
    two = [Option(f"part {k}", np.array([0.012]), 0.1) for k in range(2)]
    assert len(choose(task(), two, [PLAIN]).left_out) == 1  # together they are above the wish


def test_a_wish_out_of_reach_is_said() -> None:
    found = choose(task(want=0.02, fixed=0.05), [], [PLAIN])
    assert not found.within
    assert found.errors[0] > 0.05
    assert not choose(task(most=0.1), [], [PLAIN]).within


def test_no_averaging_is_spent_on_what_it_cannot_take_away() -> None:
    """An error of the settling of five times the wish: the statistical one may be as large as the wish."""
    found = choose(task(want=0.02, scatter=0.04, fixed=0.1), [], [PLAIN])
    assert not found.within
    assert found.errors[0] - found.bounds[0] == pytest.approx(LEAST_ROOM * 0.1)


def test_a_budget_gives_the_most_exact() -> None:
    rough, fine = Option("rough", np.array([0.004]), 0.25), Option("fine", NONE, 1.0)
    short = choose(task(settle=0.1), [], [rough, fine], budget=0.3)
    assert short.numerics == "rough"
    assert short.cost == pytest.approx(0.3)
    assert short.errors == pytest.approx([0.004 + 0.01 / np.sqrt(0.5)])
    long = choose(task(settle=0.1), [], [rough, fine], budget=30.0)
    assert long.numerics == "fine"
    assert long.errors == pytest.approx([0.01 / np.sqrt(14.9)])
    assert not choose(task(settle=10.0), [], [fine], budget=1.0).within


@pytest.mark.parametrize("seed", range(20))
def test_nothing_cheaper_is_within_the_wish(seed: int) -> None:
    """Every set, priced by the formulas written once more."""
    rng = np.random.default_rng(seed)
    want, scatter, fixed = rng.uniform(0.01, 0.1, 2), rng.uniform(1e-3, 0.05, 2), rng.uniform(0.0, 5e-3, 2)
    effects = [Option(f"e{k}", rng.uniform(0.0, 0.05, 2), rng.uniform(0.3, 1.1)) for k in range(5)]
    numbers = [Option(f"n{k}", rng.uniform(0.0, 0.03, 2), rng.uniform(0.3, 3.0)) for k in range(3)]
    given = Task(want, fixed, scatter, window=1.3, settle=0.4, least=0.05, most=50.0, rate=3.0)
    costs = []
    for size in range(6):
        for made in itertools.combinations(effects, size):
            for one in numbers:
                bounds = fixed + one.bounds + np.sum([e.bounds for e in made], axis=0) if made else fixed + one.bounds
                for length in np.geomspace(0.05, 50.0, 400):
                    if np.all(bounds + scatter * np.sqrt(1.3 / length) <= want):
                        rate = 3.0 * one.time_ratio * np.prod([e.time_ratio for e in made])
                        costs.append(rate * (0.4 + length))
                        break
    found: Choice = choose(given, effects, numbers)
    assert found.within == bool(costs)
    if costs:
        assert found.cost <= min(costs) * (1.0 + 1e-9)
        assert found.cost >= 0.97 * min(costs)  # lengths of the list are 2 % apart
        assert np.all(found.errors <= want * (1.0 + 1e-9))
