"""Error bars of averages: they hold the true mean as often as they say, and a run that is too short has none."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

import trbdyn as trb
from trbdyn import observables
from trbdyn.model.cases import scene_30310
from trbdyn.results.confidence import AVERAGES
from trbdyn.results.summary import LABELS, table

Array = NDArray[np.float64]


def noise(seed: int, n: int, memory: float) -> tuple[Array, Array]:
    """An autoregressive process of mean 0 with the correlation time (1 + memory)/(1 - memory), in ms."""
    driven = np.random.default_rng(seed).normal(size=n + 2000)
    return np.arange(n) * 1e-3, lfilter([1.0], [1.0, -memory], driven)[2000:]


@pytest.mark.parametrize(("memory", "n"), [(0.0, 4000), (0.9, 10_000), (0.98, 40_000)])
def test_correlation_time(memory: float, n: int) -> None:
    found = [observables.correlation_time(*noise(seed, n, memory)) for seed in range(20)]
    assert np.mean(found) == pytest.approx(1e-3 * (1.0 + memory) / (1.0 - memory), rel=0.05)


def test_correlation_time_of_what_does_not_change() -> None:
    assert observables.correlation_time([0.0, 0.1, 0.2], [5.0, 5.0, 5.0]) == pytest.approx(0.1)
    assert math.isnan(observables.correlation_time([0.0], [1.0]))
    assert observables.batches(np.arange(1000.0), [np.arange(1000.0)]) == []  # a drift remembers itself for ever
    turning = np.cos(0.7 * np.arange(4000.0))
    assert (
        observables.correlation_time(np.arange(4000.0), turning) < 3.0
    )  # averages of a steady oscillation are exact soon


@pytest.mark.parametrize(("memory", "n"), [(0.0, 2000), (0.95, 4000), (0.98, 4000)])
def test_intervals_hold_the_true_mean(memory: float, n: int) -> None:
    """In 95 of 100 cases, they say; 300 cases scatter by 1.3 of 100."""
    held = given = 0
    for seed in range(300):
        time, values = noise(1000 + seed, n, memory)
        parts = observables.batches(time, [values])
        if parts:
            means = [values[part].mean() for part in parts]
            given += 1
            held += abs(np.mean(means)) <= observables.half_width(means)
    assert given > 280
    assert 0.90 * given <= held <= 0.985 * given


def test_batches_cover_the_end_and_are_alike() -> None:
    time, values = noise(1, 5003, 0.9)
    parts = observables.batches(time, [values], least=0.4)
    assert parts[-1].stop == time.size
    assert {part.stop - part.start for part in parts} == {400}
    assert all(a.stop == b.start for a, b in itertools.pairwise(parts))
    assert observables.batches(time, [values], least=2.0) == []
    assert observables.batches(time[:9], [values[:9]]) == []
    slow = observables.batches(time, [values, np.cumsum(values)])
    assert slow == []


def test_half_width_needs_numbers() -> None:
    assert math.isnan(observables.half_width([1.0, 2.0, 3.0, 4.0]))
    assert math.isnan(observables.half_width([1.0, 2.0, 3.0, 4.0, math.nan]))
    assert observables.half_width([2.0] * 6) == 0.0


def test_the_summary_of_a_run_has_error_bars_that_later_windows_keep() -> None:
    """A whirl at 1230 N: averages of one half of a second agree with those of the other half within both intervals."""
    scene = scene_30310(3000.0, 1230.0, effects=trb.Effects.paper().replace(quadrature="gauss", n_slices=4))
    result = trb.Simulation(scene, accuracy="fast").run(duration=1.2, save_every=5e-4)
    values = result.summary()
    widths = values["confidence"]
    assert set(widths) <= set(AVERAGES) <= set(LABELS)
    assert {"torque", "pocket_duty", "orbit_radius_over_cpr", "cage_speed_ratio"} <= set(widths)
    assert "batches" in values["confidence_note"]
    assert f"± {widths['torque']:.2g}" in table(values)
    middle = 0.5 * (values["window_start"] + values["window_end"])
    halves = [result.window(values["window_start"], middle), result.window(middle)]
    for name, of in (
        ("torque", lambda part: float(part["inner_torque"].mean())),
        ("pocket_duty", lambda part: float((part["pocket_force"] > 0).any(axis=2).mean())),
    ):
        one, other = map(of, halves)
        # each half has twice the variance of the whole, their difference four times: two half widths, and half as much again
        assert abs(one - other) <= 3.0 * widths[name], name
        assert 0.0 < widths[name] < 0.2 * abs(values[name])


def test_a_short_run_has_none_and_says_why() -> None:
    result = trb.Simulation(scene_30310(3000.0, 4930.0)).run(duration=3e-3, save_every=1e-4)
    values = result.summary()
    assert values["confidence"] is None
    assert "too short" in values["confidence_note"]
    assert "±" not in table(values).replace("behind ±", "")
