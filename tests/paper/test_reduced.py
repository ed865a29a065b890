"""Statements of the paper that runs of a second can tell.

Each limit is the 99 % bound for another run, mean +- 6.5 standard deviations (5.84, t of four runs, times sqrt(1 +
1/4)), by the whirling start itself and with rollers off their places by +-3e-4 rad at random, seeds 0, 1, 2.
Amplitudes over Cpr: 3000 rpm, 4930 N: 0.744, 0.762, 0.760, 0.765; 2000 rpm, 4930 N, Fr 8380 N: 0.041, 0.039, 0.045,
0.045; 3000 rpm, 1230 N: 0.020, 0.008, 0.019, 0.011.
"""

from __future__ import annotations

from paper.points import Condition, Point

import trbdyn as trb
from trbdyn.results.observables import whirl_amplitude


def amplitude(condition: Condition, duration: float) -> float:
    """Amplitude over Cpr of the whirl in the last three turns of the cage, from the whirling start."""
    sim = trb.Simulation(Point(condition, "whirl").scene())
    result = sim.run(duration=duration, save_every=1e-3, save_groups=("cage",))
    _, found = whirl_amplitude(result.time, result.cage_position, result.cage_angle)
    return float(abs(found[-3:]).mean() / result.clearances.radial)


def test_a_whirl_lasts_at_the_highest_axial_load_and_speed() -> None:
    assert amplitude(Condition(3000.0, 4930.0), 1.0) > 0.69


def test_a_whirl_dies_under_the_highest_radial_load() -> None:
    assert amplitude(Condition(2000.0, 4930.0, 8380.0), 1.0) < 0.062


def test_no_whirl_at_the_lowest_axial_load() -> None:
    assert amplitude(Condition(3000.0, 1230.0), 0.6) < 0.052
