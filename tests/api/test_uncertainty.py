"""Bands of predictions: draws, quantiles, shares of the inputs."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import qmc, sobol_indices, uniform

import trbdyn as trb
from trbdyn.extras.study.definition import Base, Case
from trbdyn.extras.study.uncertainty import (
    Band,
    band_of,
    drawn_case,
    first_order,
    open_inputs,
    share_held,
    uncertainty,
    unit_draws,
)

SHORT = trb.RunOptions(duration=1e-3, accuracy="fast")
BANDS = {"lubricant.temperature_c": (47.0, 53.0), "bearing.cup_half_angle_deg": (14.0, 15.7)}


def bent(x: np.ndarray) -> np.ndarray:
    """Straight, bent, two inputs together, and one that does nothing; inputs along the first axis."""
    return 3.0 * x[0] + 2.0 * (2.0 * x[1] - 1.0) ** 2 + 0.5 * (2.0 * x[0] - 1.0) * (2.0 * x[2] - 1.0)


def test_shares_are_those_of_an_independent_method() -> None:
    draws = qmc.Sobol(4, seed=1).random(256)
    shares, rest = first_order(draws, bent(draws.T))
    expected = sobol_indices(func=bent, n=4096, dists=[uniform()] * 4, rng=2).first_order
    assert shares == pytest.approx(expected, abs=0.02)
    assert rest == pytest.approx(1.0 - expected.sum(), abs=0.02)


def test_chance_is_no_share() -> None:
    """What no input makes is the rest: a result of pure chance has no shares but by chance, taken off on average."""
    random = np.random.default_rng(4)
    found = [first_order(random.random((64, 5)), random.normal(size=64)) for _ in range(200)]
    assert np.mean([shares.mean() for shares, _ in found]) < 0.02
    assert np.mean([rest for _, rest in found]) > 0.9


def test_too_few_draws_have_straight_lines_or_no_shares() -> None:
    draws = qmc.Sobol(4, seed=1).random(16)
    line = 2.0 * draws[:, 1]
    shares, _ = first_order(draws, line)
    assert shares == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=0.1)
    assert first_order(draws[:8], line[:8])[0].size == 0
    assert first_order(draws, np.ones(16))[0].size == 0


def skewed(x: np.ndarray) -> np.ndarray:
    """A sum of three inputs with a skew."""
    return np.asarray(x[:, 0] - np.log1p(-0.999 * x[:, 1]) + 0.5 * x[:, 2] ** 2)


@pytest.fixture(scope="module")
def whole() -> np.ndarray:
    """A million of its values in their order."""
    return np.sort(skewed(np.random.default_rng(1).random((1_000_000, 3))))


@pytest.mark.parametrize("draws", [8, 16, 32, 64, 256])
@pytest.mark.parametrize("kind", ["independent", "Sobol"])
def test_a_band_holds_the_share_that_it_states(whole: np.ndarray, draws: int, kind: str) -> None:
    """The million values show what each band holds; the mean over 300 sets of draws."""
    random, sets = np.random.default_rng(draws), 300
    held, stated = [], share_held(draws)
    for seed in range(sets):
        low, high, said = band_of(
            skewed(random.random((draws, 3)) if kind == "independent" else unit_draws(3, draws, seed))
        )
        assert said == stated
        held.append(np.diff(np.searchsorted(whole, [low, high]))[0] / len(whole))
    off, chance = np.mean(held) - stated, 3.0 * np.std(held) / np.sqrt(sets)
    # values between two draws are interpolated, and a Sobol sequence is more even: a few draws of it hold more
    assert -chance < off < (chance + 3e-3 if kind == "independent" else 0.09)


@pytest.mark.slow
def test_a_band_is_that_of_its_draws(tmp_path: Path) -> None:
    scene = trb.cases.scene_32216(2000.0)
    found = uncertainty(scene, BANDS, samples=12, seed=3, options=SHORT, folder=tmp_path / "draws")
    torque = found["torque"]
    values = found.data["torque"].values
    assert found.draws == 12
    assert torque.value == values[0]
    assert torque.low < torque.mean < torque.high
    assert (torque.low, torque.high) == (values[1:].min(), values[1:].max())
    assert torque.held == pytest.approx(11 / 13)
    # a warmer film is thinner: at these loads the torque falls by about 3 % a kelvin
    assert torque.shares["lubricant.temperature_c"] > torque.shares["bearing.cup_half_angle_deg"]
    assert 0.1 < (torque.high - torque.low) / torque.value < 0.3
    assert "; 85 % lie within" in str(found)
    assert repr(found) == str(found)
    assert "shares of the variance" in found._repr_html_()
    # the draws are there already, and a larger number keeps them
    again = uncertainty(scene, BANDS, samples=13, seed=3, options=SHORT, folder=tmp_path / "draws")
    assert np.array_equal(again.data["torque"].values[:13], values)
    assert again.data["wall_time"].values[:13] == pytest.approx(found.data["wall_time"].values)


def test_whole_numbers_stay_whole() -> None:
    options = trb.RunOptions(revolutions=0.01, accuracy="fast")
    bands = {"effects.n_slices": (6, 12), "lubricant.temperature_c": (50.0, 60.0)}
    found = uncertainty(trb.cases.scene_30310(3000.0), bands, samples=8, seed=1, options=options)
    assert set(np.unique(found.data["effects.n_slices"].values[1:])) <= set(range(6, 13))
    assert not (found.data["lubricant.temperature_c"].values[1:] % 1.0 == 0.0).all()


def test_what_cannot_be_run_is_said() -> None:
    bands = {"bearing.roller.diameter": (0.016, 0.026)}
    found = uncertainty(trb.cases.scene_32216(2000.0), bands, samples=24, options=SHORT)
    assert found.draws < 24
    assert len(found.refused) == 24 - found.draws
    assert f"{len(found.refused)} more could not be run" in str(found)


def test_open_inputs_of_a_catalogue_bearing() -> None:
    bearing = trb.Bearing.from_catalogue(bore=0.05, outside=0.09, width=0.02475, C=82.5e3, e=0.42)
    scene = trb.Scene(
        bearing, speed_rpm=2000.0, axial_load=2000.0, effects=trb.Effects.standard().replace(oil_fill=0.1)
    )
    paths = [band.path for band in open_inputs(scene)]
    assert {"bearing.cup_half_angle_deg", "bearing.cage.mass", "bearing.n_rollers"} <= set(paths)
    assert {"lubricant.temperature_c", "bearing.roughness.raceway", "effects.oil_fill"} <= set(paths)
    assert len(set(paths)) == len(paths)
    found = uncertainty(
        scene, [b for b in open_inputs(scene) if not b.path.startswith("bearing.")], samples=8, options=SHORT
    )
    assert found.draws == 8


CATALOGUE = {
    "30204": {"bore": 0.02, "outside": 0.047, "width": 0.01525, "C": 28e3, "e": 0.35},
    "32208": {"bore": 0.04, "outside": 0.08, "width": 0.02475, "C": 74.8e3, "e": 0.37},
    "33213": {"bore": 0.065, "outside": 0.12, "width": 0.041, "C": 240e3, "e": 0.39},
}


def draws_of(scene: trb.Scene, bands: list[Band], count: int) -> list[Case]:
    base = Base.of(scene)
    unit = unit_draws(len(bands), count, 5)
    return [drawn_case(base, trb.RunOptions(revolutions=1.0), bands, row, k) for k, row in enumerate(unit)]


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_draw_of_a_catalogue_bearing_can_be_built(name: str) -> None:
    """Numbers and sizes that belong together are drawn together: nothing overlaps, is refused or is warned of."""
    bearing = trb.Bearing.from_catalogue(**CATALOGUE[name])
    scene = trb.Scene(bearing, speed_rpm=2000.0, axial_load=0.05 * CATALOGUE[name]["C"])
    bands = list(open_inputs(scene))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cases = draws_of(scene, bands, 64)
    assert [case.error for case in cases if case.scene is None] == []
    drawn = [case.scene.bearing for case in cases if case.scene is not None]
    fill = [one.n_rollers * one.roller.diameter / (np.pi * one.pitch_diameter) for one in drawn]
    one_roller = max(one.roller.diameter / (np.pi * one.pitch_diameter) for one in drawn)
    assert min(fill) > 0.80 - one_roller
    assert max(fill) <= 0.90
    assert np.ptp(fill) > 0.05
    assert len({one.n_rollers for one in drawn}) > 3
    assert all(case.parameters["bearing.n_rollers"] == one.n_rollers for case, one in zip(cases, drawn, strict=True))
    # the radius at which a cage has most of its mass does not follow its mass
    radius = [(one.cage.inertia_axial / one.cage.mass) ** 0.5 for one in drawn]
    assert max(radius) / min(radius) < 1.2
    assert np.ptp([one.cage.mass for one in drawn]) > 0.8 * bearing.cage.mass


def test_bands_of_ones_own_are_drawn_as_they_are() -> None:
    """Whoever gives another band than that of the estimate knows something: nothing is put right."""
    bearing = trb.Bearing.from_catalogue(**CATALOGUE["32208"])
    scene = trb.Scene(bearing, speed_rpm=2000.0, axial_load=3000.0)
    size = bearing.roller.diameter
    bands = [
        Band(path="bearing.n_rollers", low=15, high=17),
        Band(path="bearing.roller.diameter", low=0.98 * size, high=1.01 * size),
        Band(path="bearing.cage.mass", low=0.9 * bearing.cage.mass, high=1.1 * bearing.cage.mass),
        Band(path="bearing.roller.effective_length", low=0.014, high=0.017),
    ]
    alone = [Band(path="lubricant.temperature_c", low=55.0, high=65.0)]
    assert all(case.scene is not None and case.scene.bearing == bearing for case in draws_of(scene, alone, 4))
    cases = draws_of(scene, bands, 16)
    assert {case.parameters["bearing.n_rollers"] for case in cases} == {15, 16, 17}
    apart = bearing.roller.total_length - bearing.roller.effective_length
    for case in cases:
        assert case.scene is not None
        roller, cage = case.scene.bearing.roller, case.scene.bearing.cage
        assert roller.total_length - roller.effective_length == pytest.approx(apart)
        # inertias follow mass and size: the roller's diameter alone moves the radius of gyration, by 0.1 %
        assert (cage.inertia_axial / cage.mass) == pytest.approx(
            bearing.cage.inertia_axial / bearing.cage.mass, rel=4e-3
        )


@pytest.mark.parametrize(
    ("path", "value"), [("n_rollers", 17), ("cage.inertia_transverse", 5.2e-5), ("cage.inertia_axial", 8.4e-5)]
)
def test_what_is_known_stays(path: str, value: float) -> None:
    """Whoever counted the rollers of an estimated bearing does not want their number to follow anything."""
    bearing = trb.Bearing.from_catalogue(**CATALOGUE["32208"])
    known = bearing.replace({path: value})
    assert path not in [entry.path for entry in known.estimated]
    scene = trb.Scene(known, speed_rpm=2000.0, axial_load=3000.0)
    built = [case.scene.bearing for case in draws_of(scene, list(open_inputs(scene)), 24) if case.scene is not None]
    assert len(built) > 6
    for one in built:
        assert (one.n_rollers if path == "n_rollers" else getattr(one.cage, path.removeprefix("cage."))) == value


@pytest.mark.parametrize(
    ("bands", "changes", "field"),
    [
        ({}, {}, "bands"),
        ({"lubricant.temperature_c": (53.0, 47.0)}, {}, "bands.lubricant.temperature_c"),
        ({"lubricant.temperature_c": 50.0}, {}, "bands.lubricant.temperature_c"),
        ({"lubricant.warmth": (1.0, 2.0)}, {}, "bands"),
        ([Band(path="scene.speed_rpm", low=1.0, high=2.0)] * 2, {}, "bands"),
        (BANDS, {"samples": 7}, "samples"),
        (BANDS, {"seed": -1}, "seed"),
        (BANDS, {"samples": 8, "quantities": ["torgue"]}, "quantities"),
        ({"bearing.roller.diameter": (0.03, 0.04)}, {}, "bands"),
    ],
)
def test_bad_bands(bands: object, changes: dict[str, int], field: str) -> None:
    with pytest.raises(trb.InputError) as raised:
        uncertainty(trb.cases.scene_32216(2000.0), bands, options=SHORT, **changes)  # type: ignore[arg-type]
    assert str(raised.value).startswith(field)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["axial", "combined", "catalogue"])
def test_bands_are_those_of_a_sample_ten_times_as_large(case: str) -> None:
    """Ends of the bands of torque and largest pressure, within a fifth of their width."""
    scenes = {
        "axial": lambda: trb.cases.scene_32216(2000.0),
        "combined": lambda: trb.cases.scene_30310(3000.0, 4930.0, 2780.0),
        "catalogue": lambda: trb.Scene(
            trb.Bearing.from_catalogue(bore=0.05, outside=0.09, width=0.02475, C=82.5e3, e=0.42),
            speed_rpm=1500.0,
            axial_load=3000.0,
        ),
    }
    scene = scenes[case]()
    options = trb.RunOptions(revolutions=0.2, accuracy="fast")
    few, many = (uncertainty(scene, samples=n, seed=s, options=options) for n, s in ((64, 5), (640, 6)))
    assert few.refused == many.refused == ()
    for name in ("torque", "outer_pressure_max"):
        # or within what two short runs differ by, where the inputs hardly change it
        room = max(0.2 * (many[name].high - many[name].low), 1e-4 * many[name].value)
        assert few[name].low == pytest.approx(many[name].low, abs=room)
        assert few[name].high == pytest.approx(many[name].high, abs=room)
        for path, share in many[name].shares.items():
            assert few[name].shares.get(path, share) == pytest.approx(share, abs=0.15)


def test_a_measured_torque_narrows_the_bands(tmp_path: Path) -> None:
    """By hand: weights of a normal error over the draws; a torque that no draw gives is refused."""
    scene = trb.cases.scene_32216(2000.0).replace({"effects.bodies": "rollers_and_spacer"})
    options = trb.RunOptions(duration=1e-3, accuracy="fast", save_groups=("contacts", "torque"))
    bands = {"effects.supply": (0.7, 1.0), "lubricant.temperature_c": (47.0, 60.0)}
    how: dict[str, Any] = {"options": options, "folder": tmp_path / "draws"}
    prior = trb.uncertainty(scene, bands, samples=20, **how)
    value = prior["torque"].value
    found = trb.uncertainty(scene, bands, samples=20, given={"torque": (value, 0.05 * value)}, **how)
    drawn = prior.data["torque"].values[1:]
    weight = np.exp(-0.5 * ((drawn - value) / (0.05 * value)) ** 2)
    assert found["torque"].mean == pytest.approx(float(weight @ drawn / weight.sum()))
    assert found.effective == pytest.approx(float(weight.sum() ** 2 / np.sum(weight**2)))
    assert found["torque"].high - found["torque"].low < 0.8 * (prior["torque"].high - prior["torque"].low)
    assert "given torque" in str(found)
    with pytest.raises(trb.InputError, match="count as"):
        trb.uncertainty(scene, bands, samples=8, **how, given={"torque": (10.0 * value, 0.01 * value)})
    with pytest.raises(trb.InputError, match=r"given\.tork"):
        trb.uncertainty(scene, bands, samples=8, options=options, given={"tork": (1.0, 0.1)})
