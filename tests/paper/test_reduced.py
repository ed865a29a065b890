"""Statements of the paper short runs can tell; limits lie many times the scatter over seeds (0.01 Cpr) from both sides."""

from __future__ import annotations

import pytest

pytest.importorskip("trbdyn._core")

import trbdyn as trb
from trbdyn.paper.growth import whirl_amplitude
from trbdyn.paper.points import Condition, Point


def amplitude(condition: Condition, duration: float) -> float:
    """Amplitude over Cpr of the whirl in the last three turns of the cage, from the whirling start."""
    sim = trb.Simulation(Point(condition, "whirl").scene())
    result = sim.run(duration=duration, save_every=1e-3, save_groups=("cage",))
    _, found = whirl_amplitude(result.time, result.cage_position, result.cage_angle)
    return float(abs(found[-3:]).mean() / result.clearances.radial)


def test_a_whirl_lasts_at_the_highest_axial_load_and_speed() -> None:
    assert amplitude(Condition(3000.0, 4930.0), 1.0) > 0.6


def test_a_whirl_dies_under_the_highest_radial_load() -> None:
    assert amplitude(Condition(2000.0, 4930.0, 8380.0), 1.0) < 0.2


def test_no_whirl_at_the_lowest_axial_load() -> None:
    assert amplitude(Condition(3000.0, 1230.0), 0.6) < 0.2
