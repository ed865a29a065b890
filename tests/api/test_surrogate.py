"""A stand-in for runs: a function whose indices are known, chance, designs outside, and real runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import trbdyn as trb
from trbdyn.cli import main
from trbdyn.errors import InputError
from trbdyn.extras.design.surrogate import Surrogate, surrogate
from trbdyn.extras.study.uncertainty import Band, Spread, Uncertainty, unit_draws


def made_of(values: Any, unit: Any, bands: tuple[Band, ...]) -> Uncertainty:
    """Draws that a function has made, as those of runs; a draw that failed among them."""
    whole = np.vstack([np.full(len(bands), np.nan), unit, np.zeros(len(bands))])
    coordinates = {band.path: ("case", band.low + (band.high - band.low) * whole[:, i]) for i, band in enumerate(bands)}
    status = ["done"] * (len(values) + 1) + ["error"]
    data = xarray.Dataset(
        {"torque": ("case", [0.0, *values, np.nan]), "status": ("case", np.array(status, dtype=object))}, coordinates
    )
    spreads = {"torque": Spread("torque", "N m", 0.0, 0.0, 0.0, 0.0, {}, 0.0)}
    return Uncertainty(spreads, bands, len(values), ("one",), data, ("torque",))


BANDS = tuple(Band(path=name, low=2.0, high=6.0) for name in ("one", "two", "three"))


def ishigami(unit: Any) -> Any:
    x = np.pi * (2.0 * unit - 1.0)
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


@pytest.fixture(scope="module")
def smooth() -> Surrogate:
    unit = unit_draws(3, 256, 1)
    return surrogate(made_of(ishigami(unit), unit, BANDS), "torque")


def test_indices_of_a_known_function(smooth: Surrogate) -> None:
    """Ishigami and Homma (1990): 0.3139, 0.4424, 0 by themselves; 0.5576, 0.4424, 0.2437 in total."""
    first = [smooth.indices[band.path].first for band in BANDS]
    total = [smooth.indices[band.path].total for band in BANDS]
    np.testing.assert_allclose(first, (0.3139, 0.4424, 0.0), atol=0.03)
    np.testing.assert_allclose(total, (0.5576, 0.4424, 0.2437), atol=0.03)
    assert smooth.explained > 0.9


def test_its_error_is_that_of_new_runs(smooth: Surrogate) -> None:
    """Against 2000 others. It was fitted to all draws, of which its error was not given a fifth, so it is a little better."""
    unit = np.random.default_rng(7).random((2000, 3))
    predicted = smooth({band.path: 2.0 + 4.0 * unit[:, i] for i, band in enumerate(BANDS)})
    error = np.sqrt(np.mean((predicted - ishigami(unit)) ** 2))
    assert 0.4 * smooth.error < error < 1.3 * smooth.error


def test_chance_is_no_share_of_an_input() -> None:
    """Half of the variance is chance: as much is not explained, and the error is its size."""
    unit = unit_draws(2, 200, 2)
    slope = 3.0 * unit[:, 0]
    noisy = slope + np.random.default_rng(3).normal(0.0, slope.std(), 200)
    found = surrogate(made_of(noisy, unit, BANDS[:2]), "torque")
    assert found.explained == pytest.approx(0.5, abs=0.1)
    assert found.error == pytest.approx(slope.std(), rel=0.15)
    assert found.indices["one"].total > 0.9 > 0.1 > found.indices["two"].total
    assert "predicts" in str(found)
    assert "one" in str(found)


def test_nothing_but_chance_is_said() -> None:
    unit = unit_draws(2, 100, 2)
    found = surrogate(made_of(np.random.default_rng(5).normal(size=100), unit, BANDS[:2]), "torque")
    assert found.explained < 0.1
    assert "TOO LITTLE" in str(found)


def test_bad_input(smooth: Surrogate) -> None:
    unit = unit_draws(3, 64, 1)
    few, even = made_of(ishigami(unit[:20]), unit[:20], BANDS), made_of(np.ones(64), unit, BANDS)
    for found, name, text in (
        (few, "torque", "at least 40"),
        (even, "torque", "same in all"),
        (few, "torke", "torque"),
    ):
        with pytest.raises(InputError, match=text):
            surrogate(found, name)
    for inputs, text in (
        ({"one": 3.0, "two": 3.0}, "missing"),
        ({"one": 3.0, "two": 3.0, "three": 7.0}, "from 2 to 6"),
        ({"one": 3.0, "two": 3.0, "tree": 3.0}, "three"),
    ):
        with pytest.raises(InputError, match=text):
            smooth(inputs)


@pytest.mark.slow
def test_of_real_runs() -> None:
    """Oil and load decide on the torque, roughness of the rib hardly; predicted designs are run and compared."""
    scene, options = trb.cases.scene_32216(2000.0), trb.RunOptions(duration=2e-3, accuracy="fast")
    bands = {
        "lubricant.temperature_c": (40.0, 60.0),
        "scene.axial_load": (4e3, 8e3),
        "bearing.roughness.rib": (1e-7, 2e-7),
    }
    fast = trb.surrogate(trb.uncertainty(scene, bands, samples=48, options=options), "torque")
    assert fast.explained > 0.95
    assert fast.indices["bearing.roughness.rib"].total < 0.1
    other = scene.replace(axial_load=6500.0).replace(lubricant=scene.lubricant.replace(temperature_c=44.0))
    ran = trb.Simulation(other, accuracy="fast").run(duration=2e-3).summary()["torque"]
    predicted = float(
        fast({"lubricant.temperature_c": 44.0, "scene.axial_load": 6500.0, "bearing.roughness.rib": 1.5e-7})
    )
    assert predicted == pytest.approx(ran, abs=4.0 * fast.error)


WORDS = ["ensemble", "rig_30310", "--band", "scene.speed_rpm=1000:6000", "--set", "run.revolutions=0.02"]


@pytest.mark.slow
def test_the_command_goes_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Another forty draws beside forty that are there: these are not run again."""
    folder = tmp_path / "many"
    words = [*WORDS, "--predict", "torque", "-o", str(folder)]
    assert main([*words, "--designs", "40"]) == 0
    assert "torque from 40 runs" in capsys.readouterr().out
    before = {path: path.stat().st_mtime_ns for path in folder.glob("*.h5")}
    assert len(before) == 41
    assert main([*words, "--designs", "48"]) == 0
    assert "torque from 48 runs" in capsys.readouterr().out
    assert len(list(folder.glob("*.h5"))) == 49
    assert all(path.stat().st_mtime_ns == at for path, at in before.items())


def test_the_command_says_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words, text in (
        ([*WORDS, "--band", "scene.axial_load=3"], "must be PATH=LOW:HIGH"),
        ([*WORDS, "--designs", "39"], "at least 40"),
        ([*WORDS, "--band", "scene.speed_rpm=1:2"], "must not name an input twice"),
        ([*WORDS, "--predict", "torke"], "did you mean 'torque'"),
    ):
        assert main([*words, "-o", str(tmp_path / "none")]) == 2
        assert text in capsys.readouterr().err
