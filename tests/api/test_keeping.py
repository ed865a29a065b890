"""What a run keeps by default: everything in short runs, less of it in long ones, and it is said."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.cases import scene_30310
from trbdyn.run import keeping
from trbdyn.run.options import GROUPS


@pytest.mark.parametrize(
    ("length", "speed", "every"),
    [
        (0.01, 3000.0, 1e-4),
        (0.5, 3000.0, 1e-4),
        (0.51, 3000.0, 2e-4),
        (2.5, 3000.0, 5e-4),
        (10.0, 3000.0, 1e-3),
        (4000.0, 3000.0, 1e-3),
        (40.0, 6000.0, 5e-4),
        (40.0, 30000.0, 1e-4),
        (40.0, 0.0, 1e-3),
        (40.0, -3000.0, 1e-3),
        (40.0, trb.History.ramp(0.0, 1.0, 0.0, 6000.0), 5e-4),
    ],
)
def test_interval(length: float, speed: Any, every: float) -> None:
    assert keeping.interval(length, speed) == pytest.approx(every, rel=1e-12)


def test_groups_of_very_long_runs() -> None:
    short = keeping.kept_by_default(20.0, 3000.0, None, None)
    long = keeping.kept_by_default(21.0, 3000.0, None, None)
    assert short["save_groups"] == GROUPS
    assert set(GROUPS) - set(long["save_groups"]) == {"contacts", "pocket"}
    assert keeping.kept_by_default(1e4, 3000.0, 1e-4, None) == {"save_every": 1e-4, "save_groups": GROUPS}
    assert keeping.kept_by_default(1e4, 3000.0, None, ["cage"])["save_groups"] == ("cage",)
    assert "without the groups contacts, pocket" in keeping.said(1e-3, long["save_groups"])


def test_a_long_run_is_small_and_says_what_it_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a shorter limit, so that the test is short: the interval grows, the file is compressed, the steps are the same."""
    sim = trb.Simulation(scene_30310(start=trb.Start.whirl(0.9)), accuracy="fast")
    dense = sim.copy().run(duration=0.2, output=tmp_path / "dense.h5")
    assert dense.meta["kept"] == "a record every 0.1 ms of bearing time, all groups"
    monkeypatch.setattr(keeping, "RECORDS", 200)
    thin = sim.copy().run(duration=0.2, output=tmp_path / "thin.h5")
    assert thin.meta["kept"] == "a record every 1 ms of bearing time, all groups"
    assert len(thin) == 201
    np.testing.assert_allclose(
        thin.cage_position, dense.cage_position[::10], rtol=1e-9, atol=1e-12
    )  # times to rounding
    np.testing.assert_array_equal(thin.final_state, dense.final_state)
    size = {name: (tmp_path / f"{name}.h5").stat().st_size for name in ("dense", "thin")}
    assert size["thin"] < 0.1 * size["dense"]
    asked = sim.copy().run(duration=0.2, save_every=1e-4)
    assert len(asked) == 2001
    monkeypatch.setattr(keeping, "MANY", 100)
    bare = sim.copy().run(duration=0.2)
    assert not {"contacts", "pocket"} & set(bare.groups)
    assert "without the groups contacts, pocket" in bare.meta["kept"]
    assert sim.estimate(duration=0.2).records == 201


def test_the_groups_that_are_asked_for_are_kept_and_no_others(tmp_path: Path) -> None:
    scene = trb.cases.scene_30310(3000.0, 4930.0)
    groups = ("cage", "torque")
    in_memory = trb.Simulation(scene).run(duration=1e-3, save_groups=groups)
    to_file = trb.Simulation(scene).run(duration=1e-3, save_groups=groups, output=tmp_path / "run.h5")
    for result in (in_memory, to_file, trb.load(tmp_path / "run.h5")):
        assert set(result.groups) == {"time", *groups}
        assert {field.group for field in result.fields} == {"time", *groups}


@pytest.mark.parametrize("groups", [3, "cage", ["cagee"], [], {"cage": 1, "x": 2}, [1], [None]])
def test_groups_that_are_none_are_refused(groups: Any) -> None:
    with pytest.raises(trb.InputError, match="save_groups"):
        trb.Simulation(scene_30310()).run(duration=1e-3, save_groups=groups)
