"""Torque maps: numbers of single runs, shares that add up, settled or said so, bands, refusals, the command."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.cli import main
from trbdyn.extras.maps import torque_map as module
from trbdyn.extras.maps.torque_map import SOURCES, TorqueMap, torque_map
from trbdyn.extras.study.settled import drift


@pytest.fixture(scope="module")
def found() -> TorqueMap:
    return torque_map(trb.cases.rig_30310(), [3000.0, 500.0], [4930.0, (4930.0, 2780.0)], temperatures=[60.0, 40.0])


def test_points_are_those_of_single_runs(found: TorqueMap) -> None:
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=500.0, axial_load=4930.0, radial_load=2780.0)
    oil = scene.lubricant.at(40.0) if hasattr(scene.lubricant, "at") else trb.lubricants.vg100(40.0)
    alone = trb.Simulation(scene.replace(lubricant=oil), accuracy="standard").run(revolutions=4.0).summary()
    at = found.data.sel(temperature_c=40.0, speed_rpm=500.0).isel(load=1)
    assert float(at["torque"]) == pytest.approx(alone["torque"], rel=0.01)
    assert float(at["radial_load"]) == 2780.0
    assert float(at["film_parameter_rib"]) == pytest.approx(alone["film_parameter_rib"], rel=0.02)
    # thinner oil, less torque
    assert np.all(found.data["torque"].sel(temperature_c=60.0) < found.data["torque"].sel(temperature_c=40.0))


def test_shares_add_up(found: TorqueMap) -> None:
    assert found.settled
    total = found.data["share"].sum("source")
    np.testing.assert_allclose(total, found.data["torque"], rtol=found.tolerance)
    assert tuple(found.data["source"].values) == SOURCES
    assert np.all(found.data["share"].sel(source="rolling") > 0.9 * found.data["torque"])


def test_what_is_shown(found: TorqueMap, tmp_path: Path) -> None:
    text = str(found)
    assert "speed (rpm)" in text
    assert "4930, radial 2780" in text
    assert found.lowest()[0] == 500.0
    assert found.lowest(temperature=1)[1] == pytest.approx(float(found.data["torque"][1, 1, 0]))
    found.picture(tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 10_000


def test_a_torque_that_does_not_stand_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tolerance below the scatter of a colliding cage: runs get longer, and the point says that it has not settled."""
    monkeypatch.setattr(module, "TURNS", (0.5, 1.0))
    found = torque_map(trb.cases.rig_30310(), [3000.0], [4930.0], tolerance=1e-7)
    assert not found.settled
    assert float(found.data["turns"].item()) == 1.0
    assert "no: it may still change by" in str(found)
    assert "1 points without a settled torque" in str(found)
    with pytest.raises(trb.InputError, match="no point whose torque has settled"):
        found.lowest()


@pytest.mark.parametrize(("time_scale", "left"), [(0.1, 0.0), (0.4, None), (4.0, None)])
def test_what_may_still_come(time_scale: float, left: float | None) -> None:
    """A torque that settles exponentially over a run of length 1: exact but for the cap, never less than a tenth of it."""
    time = np.linspace(0.0, 1.0, 4001)
    torque = 1.0 + np.exp(-time / time_scale)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.diff(time))])
    run = FakeRun(time, {"shaft_speed": np.ones_like(time), "shaft_angle": time, "work_shaft": work})
    found, last = drift(run), float((work[-1] - np.interp(0.75, time, work)) / 0.25)  # type: ignore[arg-type]
    shrinks = np.exp(-0.25 / time_scale)
    change = (last - 1.0) / shrinks - (last - 1.0)
    assert found == pytest.approx(change / (1.0 - min(shrinks, 0.9)) / last, rel=1e-3)
    if left is None:
        assert found > 0.3 * (last - 1.0) / last


def of_torque(torque: np.ndarray, turns: float) -> FakeRun:
    """A run over some turns of the shaft with a torque by time (N m)."""
    time = np.linspace(0.0, 1.0, torque.size)
    speed = 2.0 * np.pi * turns
    work = speed * np.concatenate([[0.0], np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.diff(time))])
    return FakeRun(time, {"shaft_speed": np.full_like(time, speed), "shaft_angle": speed * time, "work_shaft": work})


def test_a_torque_that_scatters_is_known() -> None:
    """Means of quarters of 0.23423, 0.23409, 0.23440 N m turn round: 0.13 % is what may still come, and not ten times as much."""
    quarters = np.repeat([0.23423, 0.23423, 0.23409, 0.23440], 250)
    assert drift(of_torque(quarters, 2.0)) == pytest.approx(0.00031 / 0.2344, rel=0.02)  # type: ignore[arg-type]


def test_a_torque_is_known_by_turns_of_the_cage() -> None:
    """Scatter of 0.35 % from turn to turn: the mean over six turns is mostly known within 1 %; one that grows by 4 % is not."""
    held, errors = [], []
    for seed in range(20):
        each = 1.0 + 0.0035 * np.random.default_rng(seed).normal(size=13)
        scatter = np.interp(np.linspace(0.0, 13.0, 2001), np.arange(13) + 0.5, each)
        found = drift(of_torque(scatter, 32.0))  # type: ignore[arg-type]
        assert 0.0002 < found < 0.03
        errors.append(found)
        held.append(abs(scatter[1000:].mean() / 1.0 - 1.0) < found)
        grows = scatter * np.linspace(1.0, 1.08, scatter.size)
        assert drift(of_torque(grows, 32.0)) > 0.01  # type: ignore[arg-type]
    assert np.mean(held) >= 0.8
    assert np.median(errors) < 0.006


class FakeRun:
    """A run of made-up records."""

    groups = ("energy", "torque")
    meta: ClassVar = {}
    scene = SimpleNamespace(torque=None)
    on_shaft = False

    @property
    def parts(self) -> tuple[FakeRun, ...]:
        return (self,)

    def __init__(self, time: np.ndarray, fields: dict[str, np.ndarray]) -> None:
        self.fields = fields | {"time": time}
        self.rolling_speed, self.rolled = fields["shaft_speed"], fields["shaft_angle"]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.fields[name]

    def __len__(self) -> int:
        return len(self.fields["time"])

    @property
    def rolling_orbit(self) -> np.ndarray:
        return 0.42 * self.rolling_speed

    def window(self, start: float, stop: float = np.inf) -> FakeRun:
        kept = (self.fields["time"] >= start - 1e-12) & (self.fields["time"] <= stop + 1e-12)
        cut = {name: values[kept] for name, values in self.fields.items()}
        return FakeRun(cut.pop("time"), cut)


def test_longer_runs_only_where_they_are_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """At 10 rpm the rib's friction takes a good part of a turn to settle: after a tenth much may still come. At 100 rpm it has
    settled by then; what the cage's hits leave there is 0.1 to 1 %.
    """
    monkeypatch.setattr(module, "TURNS", (0.1, 2.0))
    found = torque_map(trb.cases.rig_30310(), [10.0, 100.0], [4930.0], tolerance=2e-2)
    assert found.settled
    assert found.data["turns"].values.ravel().tolist() == [2.0, 0.1]


def test_bands() -> None:
    scene = trb.cases.scene_32216(1000.0)
    bands = {"lubricant.temperature_c": (47.0, 53.0)}
    found = torque_map(scene, [500.0], [6000.0], bands=bands, samples=8)
    low, middle, high = (found.data[name].values.ravel() for name in ("torque_low", "torque", "torque_high"))
    assert np.all(low < middle)
    assert np.all(middle < high)
    # -2.2 % of torque per K over +-3 K
    np.testing.assert_allclose(high / low, np.exp(0.75 * 0.0445 * 6.0 * 0.9), rtol=0.1)


def test_a_folder_is_taken_up_again(tmp_path: Path) -> None:
    one = torque_map(trb.cases.rig_30310(), [1000.0], [4930.0], folder=tmp_path / "kept")
    files = {path: path.stat().st_mtime_ns for path in (tmp_path / "kept").glob("*.h5")}
    two = torque_map(trb.cases.rig_30310(), [1000.0, 2000.0], [4930.0], folder=tmp_path / "kept")
    assert float(two.data["torque"][0, 0, 0]) == float(one.data["torque"].item())
    assert all(path.stat().st_mtime_ns == time for path, time in files.items())
    assert any("point=1" in path.name for path in (tmp_path / "kept").glob("*.h5"))
    assert {path for path in (tmp_path / "kept").glob("*.h5") if "point=0" in path.name} == set(files)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"speeds": []}, "speeds = .*at least one number"),
        ({"speeds": [0.0]}, "speeds = .*must not hold 0"),
        ({"speeds": [100.0, 100.0]}, "must not hold a value twice"),
        ({"loads": [(1.0, 2.0, 3.0)]}, "axial load, or a pair"),
        ({"loads": ["a"]}, "loads = "),
        ({"tolerance": 0.0}, "tolerance = .*above 0 and below 1"),
        ({"samples": 2, "bands": True}, "samples = 2.*at least 8"),
        ({"loads": [-1e9]}, "no point can be built"),
        ({"subject": "30310"}, "subject = .*a Scene, an Assembly or a Bearing"),
    ],
)
def test_refusals(changes: dict[str, Any], words: str) -> None:
    given = {"subject": trb.cases.rig_30310(), "speeds": [1000.0], "loads": [4930.0], **changes}
    with pytest.raises(trb.InputError, match=words):
        torque_map(**given)


def test_a_load_that_nothing_carries_leaves_the_others() -> None:
    found = torque_map(trb.cases.rig_30310(), [1000.0], [4930.0, (100.0, 50_000.0)])
    assert bool(found.data["settled"].values.ravel()[0])
    assert not bool(found.data["settled"].values.ravel()[1])
    assert np.isnan(found.data["torque"].values.ravel()[1])
    assert str(found.data["message"].values.ravel()[1])


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = str(tmp_path / "map")
    words = ["torque", "rig_30310", "--speeds", "1000", "--loads", "4930", "4930:2780", "-o", name]
    assert main(words) == 0
    assert "4930, radial 2780" in capsys.readouterr().out
    data = trb.study.load(f"{name}.nc")
    assert data["torque"].shape == (1, 1, 2)
    assert (tmp_path / "map.png").is_file()
    assert main(words) == 2  # files that are there are kept
    assert main(["torque", "rig_30310", "--speeds", "1000", "--loads", "x"]) == 2
    assert "must be FA or FA:FR" in capsys.readouterr().err
