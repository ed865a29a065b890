"""A defect of the outer ring that no loaded roller meets is said."""

from __future__ import annotations

import warnings

import pytest

import trbdyn as trb


def scene(angle: float, **loads: float) -> trb.Scene:
    pit = trb.Pit(on="outer", length=2e-3, width=6e-3, depth=30e-6, angle_deg=angle)
    return trb.Scene(trb.cases.rig_30310(), speed_rpm=1000.0, defects=(pit,), **loads)


def test_a_pit_beside_the_load_zone_is_said() -> None:
    loads = {"axial_load": 3000.0, "radial_load": 10000.0}
    with pytest.warns(
        UserWarning, match=r"defects\[0\].angle_deg = 270 lies where the rollers carry hardly any load.*near 90 deg"
    ):
        trb.Simulation(scene(270.0, **loads))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        trb.Simulation(scene(90.0, **loads))
        trb.Simulation(scene(270.0, axial_load=5000.0))
