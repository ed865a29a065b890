"""A seeded part of the hard scenes in short; all of them, in every way, are in the table that `make stability` prints."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from hard_pairs import PAIRS
from hard_runs import judge
from hard_scenes import HARD, Hard

QUICK = 6
"""Scenes that every test run looks at, besides the impossible ones."""


def chosen() -> list[Hard]:
    """A pair, and others with every change of the catalogue, the same ones for everybody, without one that takes seconds."""
    pair = next(hard for hard in PAIRS if hard.name == "pair_unbalance_10000_rpm")
    drawn = random.Random(5).sample([hard for hard in HARD if not hard.slow and hard.error is None], QUICK)
    return [pair, *(hard for hard in drawn if hard.name != "deep_interference")]


def test_the_catalogue_is_whole() -> None:
    assert len(HARD) >= 30
    assert len({hard.name for hard in (*HARD, *PAIRS)}) == len(HARD) + len(PAIRS)
    assert all(hard.why for hard in (*HARD, *PAIRS))


@pytest.mark.parametrize("hard", [hard for hard in HARD if hard.error and not hard.slow], ids=lambda hard: hard.name)
def test_impossible_scenes_end_with_the_promised_error(hard: Hard) -> None:
    verdict = judge(hard)
    assert verdict.status == "error", verdict.broken
    assert verdict.message


@pytest.mark.parametrize("hard", chosen(), ids=lambda hard: hard.name)
@pytest.mark.filterwarnings("ignore::trbdyn.errors.RunWarning")
def test_hard_scenes_in_short(hard: Hard) -> None:
    """A quarter of its length, without the comparisons; what follows an event is left to the table. Bounds of rates are four
    times as wide, as what happens at the start counts for more.
    """
    bounds = {"steps": 4.0 * hard.steps, "closure": 4.0 * hard.closure}
    verdict = judge(replace(hard, duration=0.25 * hard.duration, calm=None, **bounds), quick=True)
    assert verdict.status == "ok", verdict.broken


@pytest.mark.slow
@pytest.mark.parametrize("hard", [*HARD, *PAIRS], ids=lambda hard: hard.name)
def test_hard_scenes(hard: Hard) -> None:
    verdict = judge(hard)
    assert verdict.status != "failed", verdict.broken
