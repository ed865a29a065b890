"""Rolling resistance is right with the usual number of nodes, whatever the profile and the load."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.contact_line import PROFILED_NODES, USUAL_NODES, nodes

FINE = 192
SHARES = np.geomspace(0.02, 0.4, 3)
BEARINGS = {
    "30310": (trb.cases.rig_30310(), 122e3),
    "32216": (trb.cases.bearing_32216(), 200e3),
    "NJ 210": (trb.cases.bearing_nj210(), 75e3),
    "33113 of a catalogue": (
        trb.Bearing.from_catalogue(bore=0.065, outside=0.110, width=0.034, C=134e3, e=0.39),
        134e3,
    ),
}


def scene(name: str, load: float, **effects: Any) -> trb.Scene:
    loads = {"radial_load": load, "displacement": (None, None, 0.0)} if name == "NJ 210" else {"axial_load": load}
    return trb.Scene(
        BEARINGS[name][0],
        speed_rpm=2000.0,
        lubricant=trb.lubricants.vg100(60.0),
        effects=trb.Effects(**effects),
        **loads,
    )


def lost(one: trb.Scene) -> float:
    """Power that the raceways take by rolling at the equilibrium (W), in proportion."""
    return float(trb.Simulation(one).contacts()["raceway_rolling"].sum())


@pytest.mark.parametrize("name", BEARINGS)
def test_rolling_resistance_is_within_three_quarters_of_a_per_cent(name: str) -> None:
    for share in SHARES:
        load = share * BEARINGS[name][1]
        assert lost(scene(name, load)) == pytest.approx(lost(scene(name, load, n_slices=FINE)), rel=7.5e-3), share


@pytest.mark.parametrize("law", ["zhou_hoeprich", "biboulet_houpert", "matsuyama"])
def test_other_laws_are_within_one_per_cent(law: str) -> None:
    for share in SHARES:
        load = share * BEARINGS["32216"][1]
        usual, fine = (lost(scene("32216", load, rolling_law=law, n_slices=n)) for n in (0, FINE))
        assert usual == pytest.approx(fine, rel=1e-2), share


def test_ends_move_through_nodes_without_a_jump() -> None:
    """Rolling resistance over the load: its steps are those of a smooth curve, with whole nodes they jump."""
    loads = np.linspace(4000.0, 5000.0, 81)
    found = np.array([lost(scene("32216", load, n_slices=16)) for load in loads])
    bends = np.abs(np.diff(found, 2)) / found[1:-1]
    assert bends.max() < 1e-3


def test_number_of_nodes_follows_the_profile() -> None:
    assert nodes(scene("30310", 4000.0)) == USUAL_NODES
    assert nodes(scene("32216", 4000.0)) == PROFILED_NODES
    assert nodes(scene("32216", 4000.0, n_slices=9)) == 9
