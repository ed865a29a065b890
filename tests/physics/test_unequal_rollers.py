"""Unequal rollers of a 32008J under 10 kN, beside a published computation (Liu et al. 2022, Lubricants 10:154)."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trbdyn as trb

UM = (
    0.28,
    0.52,
    -0.56,
    0.63,
    0.33,
    -0.03,
    -0.1,
    -0.11,
    -0.15,
    0.01,
    0.03,
    0.41,
    0.76,
    0.23,
    -0.1,
    0.31,
    0.09,
    -0.51,
    0.47,
)
S1 = 1e-6 * np.array([*UM, 0.15, 0.07, 0.26, 0.13])
"""Deviations of the rollers' diameters (m)."""
SETS = {"S1": S1, "S5": 3.0 * S1, "S6": 3.0 * np.sort(S1)[::-1]}
RIGID_RING = {"S1": 1931.0, "S5": 2246.0, "S6": 2221.0}
"""Largest load at the outer raceway (N) by another model: a rigid ring on contacts of Palmgren."""
PUBLISHED = {"S1": 2026.0, "S5": 2539.0, "S6": 2495.0}
"""The same of the publication, whose contacts are stiffer."""


@pytest.mark.parametrize("name", SETS)
def test_largest_load(name: str) -> None:
    roller = trb.Roller(
        diameter=0.5 * (6.131e-3 + 6.846e-3),
        effective_length=13.66e-3,
        profile=trb.Profile.straight(),
        diameter_deviation=tuple(SETS[name]),
    )
    bearing = trb.Bearing(
        n_rollers=23, cup_half_angle_deg=math.degrees(0.2473), pitch_diameter=54e-3, roller=roller, name="32008J"
    )
    load = trb.Simulation(trb.Scene(bearing, speed_rpm=1000.0, axial_load=10e3)).equilibrium.outer_load
    assert load.mean() == pytest.approx(1776.0, rel=1e-3)
    assert load.max() == pytest.approx(RIGID_RING[name], rel=3e-3)
    assert 0.86 < load.max() / PUBLISHED[name] < 0.96
