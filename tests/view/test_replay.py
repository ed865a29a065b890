"""A record evaluated again gives what was recorded."""

from __future__ import annotations

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.contact_line import line_length
from trbdyn.run.replay import Replay

NOT_IN_A_STATE = ("energy", "peaks")


@pytest.mark.parametrize("name", ["whirling", "loaded_on_one_side"])
def test_a_record_comes_back(name: str, request: pytest.FixtureRequest) -> None:
    result = request.getfixturevalue(name)
    replay = Replay(result)
    for index in (0, len(result) // 3, len(result) - 1):
        found = replay.record(index)
        for field in result.fields:
            if field.group in NOT_IN_A_STATE or field.name == "roller_orientation":
                continue
            given = result[field.name][index]
            assert np.allclose(found[field.name], given, rtol=1e-6, atol=1e-6 * np.abs(given).max()), field.name


def test_stations_are_those_of_the_contacts(whirling: trb.Result, loaded_on_one_side: trb.Result) -> None:
    for result in (whirling, loaded_on_one_side):
        replay = Replay(result)
        weights = replay.contacts(0)["raceway_weight"][0, 0]
        length = line_length(result.scene)
        assert replay.stations.shape == weights.shape
        # a rule's nodes and weights integrate x^2 over the length
        assert np.sum(weights * replay.stations**2) / np.sum(weights) == pytest.approx(length**2 / 12, rel=2e-3)


def test_the_largest_pressure_is_the_recorded_one(loaded_on_one_side: trb.Result) -> None:
    replay, index = Replay(loaded_on_one_side), 150
    pressure = replay.contacts(index)["raceway_pressure"].max(axis=2)
    assert np.allclose(pressure[0], loaded_on_one_side.outer_pressure[index], rtol=1e-7)
    assert np.allclose(pressure[1], loaded_on_one_side.inner_pressure[index], rtol=1e-7)


def test_missing_groups_are_named(whirling: trb.Result) -> None:
    with pytest.raises(trb.InputError, match="recorded group 'rollers'"):
        Replay(whirling.select(["cage"]))
