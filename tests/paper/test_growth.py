"""Growth of a whirl: rate and extrapolation from signals whose rate is known."""

from __future__ import annotations

import numpy as np
import pytest

from trbdyn.results.observables import whirl_amplitude, whirl_growth
from trbdyn.results.observables.growth import FULL

TURNS = np.arange(400) / 20.0


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("rate", [0.05, 0.15, -0.1])
def test_rate_of_a_noisy_exponential(rate: float, seed: int) -> None:
    noise = 1.0 + 0.1 * np.random.default_rng(seed).normal(size=TURNS.size)
    found = whirl_growth(TURNS, 0.02 * np.exp(rate * TURNS) * noise)
    assert found.rate == pytest.approx(rate, abs=5.0 * max(found.rate_error, 1e-4))
    assert found.rate_error < 0.02
    assert found.growing == (rate > 0.0)
    if found.growing:
        assert found.time_to_full == pytest.approx(np.log(FULL / found.amplitude) / found.rate)


def test_a_whirl_that_stands_does_not_grow() -> None:
    noise = 0.05 * np.random.default_rng(0).normal(size=TURNS.size)
    assert not whirl_growth(TURNS, 0.5 * np.exp(noise)).growing
    short = whirl_growth(TURNS[:10], np.full(10, 0.5))
    assert np.isnan(short.rate)
    assert (short.amplitude, short.fitted, short.growing) == (pytest.approx(0.5), 0.0, False)
    assert np.isnan(short.time_to_full)
    assert whirl_growth(TURNS, 0.5 * np.exp(noise)).fitted == pytest.approx(TURNS[-1] - TURNS[200])


def test_amplitude_counts_only_what_turns_with_the_cage() -> None:
    time = np.linspace(0.0, 1.0, 5001)
    angle = 2.0 * np.pi * 20.0 * time
    place = 0.3 * np.exp(1j * (angle + 0.7)) - 0.5j + 0.2 * np.exp(2j * angle)
    at, amplitude = whirl_amplitude(time, np.column_stack([place.real, place.imag]), angle)
    assert at.size in (19, 20)
    assert np.abs(amplitude) == pytest.approx(0.3, abs=0.005)
