"""The speed from which on a cage whirls: classes from two starts, the search between speeds, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import trbdyn as trb
from trbdyn import InputError
from trbdyn.extras.maps import whirl
from trbdyn.extras.maps.whirl import CageRuns, WhirlOnset, whirl_onset

SCENE = trb.cases.scene_30310(2000.0, 3080.0)


@pytest.fixture(scope="module")
def found() -> WhirlOnset:
    return whirl_onset(SCENE, [4000.0, 1000.0], resolution=1500.0, longest=40.0)


@pytest.mark.slow
def test_what_a_cage_does_depends_on_speed_and_start(found: WhirlOnset) -> None:
    data = found.data
    assert list(data.speed_rpm.values) == [1000.0, 2500.0, 4000.0]
    assert str(data.kind.sel(start="equal", speed_rpm=1000.0).values) == "stable"
    assert str(data.kind.sel(start="equal", speed_rpm=2500.0).values) != "circling"
    assert str(data.kind.sel(start="whirl", speed_rpm=4000.0).values) == "circling"
    assert str(data.kind.sel(start="equal", speed_rpm=4000.0).values) == "circling"
    assert float(data.orbit.sel(start="whirl", speed_rpm=4000.0)) > 0.7
    assert found.onset("equal") == (2500.0, 4000.0)
    low, high = found.onset("whirl")
    assert high <= 2500.0
    assert low < high


@pytest.mark.slow
def test_it_prints_a_table(found: WhirlOnset) -> None:
    text = str(found)
    assert "from the start 'equal' it begins to whirl between 2500 and 4000 rpm" in text
    assert "circling" in text
    assert "rpm" in found._repr_html_()
    with pytest.raises(InputError, match="start"):
        found.onset("unequal")  # type: ignore[arg-type]


def test_no_whirl_and_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against the other sense of rotation, kept in files and taken from there."""
    monkeypatch.setattr(whirl, "TURNS", (20.0,))
    light = trb.cases.scene_30310(-3000.0, 1230.0)
    once = whirl_onset(light, [-3000.0], starts=["equal"], longest=20.0, folder=tmp_path)
    assert once.onset() == (3000.0, np.inf)
    assert "whirls at none of these speeds" in str(once)
    again = whirl_onset(light, [-3000.0], starts=["equal"], longest=20.0, folder=tmp_path)
    assert again.data.equals(once.data)


def test_a_map_over_speed_and_load(monkeypatch: pytest.MonkeyPatch) -> None:
    """At the load of the scene it is what the search over speeds finds; a load that cannot be is told."""
    monkeypatch.setattr(whirl, "TURNS", (20.0,))
    how: Any = {"starts": ["whirl"], "longest": 20.0}
    found = whirl_onset(SCENE, [1000.0], **how)
    chart = trb.cage_map(SCENE, [1000.0], [3080.0, -10.0], **how)
    data = chart.data
    assert data.kind.dims == ("start", "axial_load", "speed_rpm")
    assert list(data.axial_load.values) == [-10.0, 3080.0]
    one, other = (
        data.sel(start="whirl", axial_load=3080.0, speed_rpm=1000.0),
        found.data.sel(start="whirl", speed_rpm=1000.0),
    )
    assert str(one.kind.values) == str(other.kind.values)
    assert float(one.orbit) == float(other.orbit)
    assert (data.kind.sel(axial_load=-10.0).values == "unknown").all()
    text = str(chart)
    assert f"{one.kind.values} 0." in text
    assert float(one.hits) > 0.0
    assert 0.0 < float(one.impulse) < 0.1
    assert f", {float(one.hits):.0f}/s" in text
    assert "failed" in text
    assert "axial_load" in text
    with pytest.raises(InputError, match="axial_loads"):
        trb.cage_map(SCENE, [1000.0], [])
    with pytest.raises(InputError, match="axial_loads"):
        trb.cage_map(SCENE, [1000.0], [math.inf])
    with pytest.raises(InputError, match="starts"):
        trb.cage_map(SCENE, [1000.0], [1230.0], starts=["middle"])  # type: ignore[list-item]


@pytest.mark.parametrize(
    ("speeds", "given", "words"),
    [
        ([], {}, "speeds"),
        ([0.0, 1000.0], {}, "speeds"),
        ([-1000.0, 1000.0], {}, "speeds"),
        ("1000", {}, "speeds"),
        ([1000.0], {"starts": ["unequal"]}, "starts"),
        ([1000.0], {"resolution": 0.0}, "resolution"),
        ([1000.0], {"longest": 3.0}, "longest"),
    ],
)
def test_what_cannot_be_used_is_refused(speeds: Any, given: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        whirl_onset(SCENE, speeds, **given)


def test_a_speed_that_fails_is_said() -> None:
    """A scene without a cage has no whirl; one that cannot be built at a speed says so in its row."""
    with pytest.raises(InputError, match="bodies"):
        whirl_onset(SCENE.replace(effects=SCENE.effects.replace(bodies="rollers")), [1000.0])
    found = whirl_onset(SCENE, [2e6], starts=["equal"], longest=40.0)
    assert "1e+06" in str(found.data.message.values[0, 0])


def test_a_run_that_failed_is_no_cage_at_rest() -> None:
    """Nothing is known of the speed between, so the whirl begins somewhere above the last speed that is known."""
    kinds = np.array([["stable", "unknown", "circling"]], dtype=object)
    data = xarray.Dataset(
        {"kind": (("start", "speed_rpm"), kinds)}, {"start": ["equal"], "speed_rpm": [1000.0, 2000.0, 3000.0]}
    )
    assert WhirlOnset(data).onset("equal") == (1000.0, 3000.0)
    assert WhirlOnset(data.isel(speed_rpm=slice(1, 3))).onset("equal") == (0.0, 3000.0)


def test_a_map_of_a_pair_changes_the_force_along_its_shaft_alone() -> None:
    pair = trb.load_assembly("pair_30310")
    before = np.sum([load.force for load in pair.loads], axis=0)
    case = CageRuns(pair, ["equal"], None, 40.0, {})._case("equal", 1000.0, 1500.0, 40.0)
    assert isinstance(case.scene, trb.Assembly)
    after = np.sum([load.force for load in case.scene.loads], axis=0)
    np.testing.assert_allclose(after, [*before[:2], 1500.0])
    assert case.scene.speed_rpm == 1000.0
    assert case.parameters == {"start": "equal", "speed_rpm": 1000.0, "axial_load": 1500.0}
