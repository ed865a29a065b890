"""What a run keeps by default: everything in short runs, less of it in long ones, and it is said."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.cases import paper_30310
from trbdyn.run import keeping
from trbdyn.run.options import GROUPS


@pytest.mark.parametrize(
    ("length", "speed", "every"),
    [
        (0.01, 3000.0, 1e-4),
        (0.02, 3000.0, 1e-4),
        (0.04, 3000.0, 6.25e-4 / 4),
        (0.125, 3000.0, 6.25e-4),
        (4000.0, 3000.0, 6.25e-4),
        (40.0, 6000.0, 3.125e-4),
        (40.0, 30000.0, 1e-4),
        (40.0, 100.0, 1e-2),
        (40.0, 0.0, 1e-3),
        (40.0, -3000.0, 6.25e-4),
        (40.0, trb.History.ramp(0.0, 1.0, 0.0, 6000.0), 3.125e-4),
    ],
)
def test_interval(length: float, speed: Any, every: float) -> None:
    assert keeping.interval(length, speed) == pytest.approx(every, rel=1e-12)


def test_groups_of_very_long_runs() -> None:
    short = keeping.kept_by_default(12.5, 3000.0, None, None)
    long = keeping.kept_by_default(13.0, 3000.0, None, None)
    usual = tuple(group for group in GROUPS if group not in keeping.OPTIONAL)
    assert short["save_groups"] == usual
    assert set(usual) - set(long["save_groups"]) == {"contacts", "pocket"}
    assert keeping.kept_by_default(1e4, 3000.0, 1e-4, None) == {"save_every": 1e-4, "save_groups": usual}
    assert keeping.kept_by_default(1e4, 3000.0, 1e-4, None, optional=keeping.OPTIONAL)["save_groups"] == GROUPS
    assert keeping.kept_by_default(1e4, 3000.0, None, ["cage"])["save_groups"] == ("cage",)
    assert "without the groups contacts, pocket" in keeping.said(1e-3, long["save_groups"])


def test_a_run_takes_a_tenth_of_a_megabyte_a_turn_and_says_what_it_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The size between two lengths, as every file has a head; and the steps are the same whatever is kept."""
    sim = trb.Simulation(paper_30310(start=trb.Start.whirl(0.9)), accuracy="fast")
    first = sim.copy().run(revolutions=8.0, output=tmp_path / "short.h5")
    thin = sim.copy().run(revolutions=20.0, output=tmp_path / "long.h5")
    assert first.meta["kept"] == thin.meta["kept"] == "a record every 0.625 ms of bearing time, all groups"
    assert len(thin) == 20 * keeping.A_TURN + 1
    size = {name: (tmp_path / f"{name}.h5").stat().st_size for name in ("short", "long")}
    assert (size["long"] - size["short"]) / 12.0 < 0.095e6
    asked = sim.copy().run(revolutions=20.0, save_every=1e-3)
    np.testing.assert_array_equal(thin.final_state, asked.final_state)
    monkeypatch.setattr(keeping, "MANY", 100)
    bare = sim.copy().run(revolutions=8.0)
    assert not {"contacts", "pocket"} & set(bare.groups)
    assert "without the groups contacts, pocket" in bare.meta["kept"]
    assert sim.estimate(revolutions=20.0).records == 641


def test_cases_of_a_study_keep_as_much_as_a_run(tmp_path: Path) -> None:
    """Not a record every 0.1 ms, as they did: eighteen of them took a gigabyte."""
    made = trb.study.grid(paper_30310(), {"scene.speed_rpm": [3000]}, trb.RunOptions(revolutions=8.0))
    trb.study.run(made, tmp_path, executor="serial")
    (path,) = tmp_path.glob("*.h5")
    assert trb.load(path).meta["kept"] == "a record every 0.625 ms of bearing time, all groups"
    assert path.stat().st_size < 1.2e6


def test_the_groups_that_are_asked_for_are_kept_and_no_others(tmp_path: Path) -> None:
    scene = trb.cases.paper_30310(3000.0, 4930.0)
    groups = ("cage", "torque")
    in_memory = trb.Simulation(scene).run(duration=1e-3, save_groups=groups)
    to_file = trb.Simulation(scene).run(duration=1e-3, save_groups=groups, output=tmp_path / "run.h5")
    for result in (in_memory, to_file, trb.load(tmp_path / "run.h5")):
        assert set(result.groups) == {"time", *groups}
        assert {field.group for field in result.fields} == {"time", *groups}


@pytest.mark.parametrize("groups", [3, "cage", ["cagee"], [], {"cage": 1, "x": 2}, [1], [None]])
def test_groups_that_are_none_are_refused(groups: Any) -> None:
    with pytest.raises(trb.InputError, match="save_groups"):
        trb.Simulation(paper_30310()).run(duration=1e-3, save_groups=groups)


def guided(effects: trb.Effects) -> trb.Effects:
    return effects.replace(guidance="outer_land", oil_fill=0.1, pocket_film=5e-6)


@pytest.mark.parametrize("change", [lambda effects: effects, guided], ids=["default", "guided, with oil"])
def test_what_a_scene_has_switched_off_is_not_in_its_file(change: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is left out is zero at every record, or smallest gaps without a value; what is on is kept."""
    scene = trb.cases.scene_30310(3000.0, 4930.0)
    scene = scene.replace(effects=change(scene.effects.replace(quadrature="gauss", n_slices=4)))
    how = {"duration": 2e-3, "save_every": 1e-4}
    kept = trb.Simulation(scene, accuracy="fast").run(**how)
    monkeypatch.setattr("trbdyn.run.running.absent", lambda scene, moves: ())
    every = trb.Simulation(scene, accuracy="fast").run(**how)
    left_out = {field.name for field in every.fields} - {field.name for field in kept.fields}
    for name in (name for name in left_out if not name.endswith("_time")):
        assert not np.nan_to_num(every[name]).any(), name
    for field in kept.fields:
        np.testing.assert_array_equal(kept[field.name], every[field.name])
    assert {"loss_support", "loss_vibration"} <= left_out
    on = {"land_force", "loss_land_film", "power_drag", "loss_pocket_film"}
    assert on.isdisjoint(left_out) if change is guided else on <= left_out
    assert kept.energy_closure == every.energy_closure
    assert set(kept.summary()["power_split"]) == set(every.summary()["power_split"]) - {
        name.removeprefix("loss_") for name in left_out
    }
