"""Slip over load: its parts against numbers made here, and runs of a cylindrical bearing that skids and rolls."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.maps import least_load
from trbdyn.extras.maps.least_load import EITHER, OPEN, entering, least_of, power_per_area


def scene(**effects: Any) -> trb.Scene:
    return trb.Scene(
        trb.cases.bearing_nj210(),
        speed_rpm=6000.0,
        radial_load=500.0,
        axial_load=0.0,
        displacement=(None, None, 0.0),
        lubricant="vg68",
        effects=trb.Effects(**effects),
    )


def test_the_least_load_lies_between_loads() -> None:
    loads, slips = np.array([1000.0, 10.0, 100.0]), np.array([0.01, 0.5, 0.2])
    assert least_of(loads, slips, 0.1) == pytest.approx(100.0 * 10.0 ** (0.1 / 0.19))
    assert least_of(loads, slips, 0.3) == pytest.approx(10.0 * 10.0 ** (0.2 / 0.3))
    assert least_of(loads, slips, 0.6) == 10.0
    assert least_of(loads, slips, 0.005) == math.inf
    assert least_of(loads, np.array([0.01, math.nan, 0.2]), 0.1) > 100.0
    assert math.isnan(least_of(loads, np.array([0.01, 0.5, math.nan]), 0.1))
    assert (
        least_of(loads, np.array([0.01, 0.05, 0.2]), 0.1) > 100.0
    )  # a light load that rolls says nothing of a heavier one


def test_which_rollers_enter() -> None:
    angles = np.radians([-90.0, -60.0, -120.0, 90.0, 0.0, 180.0])
    loads = np.array([10.0, 5.0, 5.0, 0.0, 0.4, 0.0])
    assert entering(loads, angles, 50.0).tolist() == [True, False, True, False, False, False]
    assert entering(loads, angles, -50.0).tolist() == [True, True, False, False, False, False]
    turned = entering(loads, angles + np.radians(100.0), 50.0)
    assert turned.tolist() == [True, False, True, False, False, False]
    assert entering(np.ones(6), angles, 50.0).all()
    assert not entering(np.zeros(6), angles, 50.0).any()


def test_the_power_is_that_of_the_energy_audit() -> None:
    """Power per area times the area, of rollers that skid, against the power that the core books for sliding on the raceways."""
    sim = trb.Simulation(scene(), accuracy="fast")
    state = sim.state.vector.copy()
    sim.run(revolutions=0.2)
    assert not np.array_equal(state, sim.state.vector)
    contacts = sim.contacts()
    area = np.sum(
        2.0 * contacts["raceway_half_width"] * contacts["raceway_weight"] * (contacts["raceway_load"] > 0.0), axis=-1
    )
    assert np.count_nonzero(area) > 3
    power = power_per_area(contacts) * area
    booked = contacts["power"][:, :2].T
    assert power.sum(axis=1) == pytest.approx(booked.sum(axis=1), rel=1e-6)


@pytest.fixture(scope="module")
def found() -> Any:
    """Of runs of 4 turns alone."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(least_load, "TURNS", (4.0,))
        return trb.least_load(
            scene(oil_fill=0.1, n_slices=4), [6000.0], [(0.0, 100.0), (0.0, 2000.0)], temperatures=[30.0]
        )


def test_a_light_bearing_skids_and_a_loaded_one_rolls(found: Any) -> None:
    skids, rolls = (found.data.isel(temperature_c=0, speed_rpm=0, load=k) for k in (0, 1))
    assert float(skids["cage_slip"]) > 0.1 > 0.01 > float(rolls["cage_slip"])
    assert float(rolls["unloaded_slip"]) > float(rolls["loaded_slip"])
    least = float(found.data["least"][0, 0])
    assert 100.0 < least < 2000.0
    assert f"{least:.3g}" in found._shown().parts[0].text()
    assert found.by_rule == pytest.approx(0.02 * trb.rating(scene()).dynamic_rating)
    assert "0.02 C" in str(found)
    assert "oil_fill" not in str(found)
    assert [ax.get_xscale() for ax in found.picture().axes] == ["log", "log"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"slip": 0.0}, "slip"),
        ({"speeds": [0.0]}, "speeds"),
        ({"loads": []}, "loads"),
        ({"loads": [(0.0, -5.0)]}, "no point can be built"),
        ({"subject": "NJ210"}, "subject"),
    ],
)
def test_refusals(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(trb.InputError, match=words):
        trb.least_load(**{"subject": scene(), "speeds": [3000.0], "loads": [(0.0, 100.0)], **arguments})


@pytest.mark.parametrize(
    ("rolling", "standing", "verdict"),
    [(-1.0, 1.0, EITHER), (1.0, -1.0, OPEN), (1.0, 1.0, "slips"), (-1.0, -1.0, "rolls"), (0.0, 1.0, OPEN)],
)
def test_starts_on_both_sides_of_the_limit(rolling: float, standing: float, verdict: str) -> None:
    """A slip that rises above the limit and one that falls below it come to one slip near it (30206 under 0.0015 C: 0.1032)."""
    numbers = dict.fromkeys(least_load.NUMBERS, 0.1) | {"steady": 1.0, "turns": 8.0, "message": ""}
    assert least_load._judged(numbers | {"side": rolling}, numbers | {"side": standing})["verdict"] == verdict
