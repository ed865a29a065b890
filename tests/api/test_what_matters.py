"""Which estimates matter: what is told apart from chance, and what is not."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.design.what_matters import REPEATS, STARTS, _moved, told_from
from trbdyn.model.bearing import Bearing


def table(seed: int, effect: float, chaos: float) -> int:
    """Number of ends of 52 inputs that are told apart; the first ten inputs have an effect."""
    rng = np.random.default_rng(seed)
    start = 1.0 + 0.1 * rng.normal(size=STARTS)
    base = start + chaos * rng.normal(size=(REPEATS, STARTS))
    ends = np.array(
        [
            (start - effect * (k < 10) + chaos * rng.normal(size=STARTS), start + chaos * rng.normal(size=STARTS))
            for k in range(52)
        ]
    )
    return int((np.abs(ends.mean(axis=-1) - base.mean()) > told_from(base, ends)).sum())


def test_chance_tells_nothing_apart() -> None:
    """Of 52 inputs that do nothing, none in 19 of 20 tables at least; the old measure, a single difference, told 29 apart."""
    found = [table(seed, 0.0, 0.05) for seed in range(100)]
    assert sum(count > 0 for count in found) <= 10
    assert max(found) <= 10


def test_influences_that_are_large_against_chance_are_told_apart() -> None:
    assert all(table(seed, 0.6, 0.05) >= 8 for seed in range(20))
    assert all(table(seed, 1e-3, 1e-6) >= 10 for seed in range(20))


def test_what_is_below_the_tolerances_is_never_told_apart() -> None:
    assert table(1, 1e-7, 0.0) == 0


@pytest.mark.slow
def test_bands_of_a_billionth(monkeypatch: pytest.MonkeyPatch) -> None:
    """A colliding cage: none of the inputs, though the orbit differs from run to run."""
    page = {"bore": 0.050, "outside": 0.110, "width": 0.02925, "C": 125e3, "e": 0.35, "name": "30310"}
    bearing = trb.Bearing.from_catalogue(**page)
    paths = ["cage.mass", "cage.play_radial"]
    tiny = [
        entry.model_copy(update={"low": entry.value * (1.0 - 1e-9), "high": entry.value * (1.0 + 1e-9)})
        for entry in bearing.estimated
        if entry.path in paths
    ]
    monkeypatch.setattr(Bearing, "estimated", property(lambda self: tuple(tiny)))
    effects = trb.Effects.standard().replace(n_slices=6)
    scene = trb.Scene(bearing, speed_rpm=3000.0, axial_load=1000.0, effects=effects)
    found = trb.sensitivity(scene, "orbit_rms_over_cpr", revolutions=0.5)
    assert len(found.influences) == len(tiny)
    assert not any(entry.told_apart for entry in found.influences)
    assert "No influence can be told from chance" in str(found)
    for wrong in (1, 2.5, True):
        with pytest.raises(trb.InputError, match="starts"):
            trb.sensitivity(scene, revolutions=0.1, starts=wrong)  # type: ignore[arg-type]


PAGE = {"bore": 0.050, "outside": 0.110, "width": 0.02925, "C": 125e3, "e": 0.35, "name": "30310"}


@pytest.mark.parametrize("factor", [1.0 - 1e-9, 1.0 + 1e-9])
def test_rounding_takes_no_roller_away(factor: float) -> None:
    """With a diameter larger by a billionth the pitch circle had room for one roller less, and the torque was 5 % off."""
    bearing = trb.Bearing.from_catalogue(**PAGE)
    (entry,) = (entry for entry in bearing.estimated if entry.path == "roller.diameter")
    moved = _moved(bearing, entry, bearing.roller.diameter * factor)
    assert moved.n_rollers == bearing.n_rollers
    assert moved.roller.diameter == pytest.approx(bearing.roller.diameter, rel=1e-8)


def test_a_number_of_rollers_that_is_known_stays() -> None:
    known = trb.Bearing.from_catalogue(**PAGE).replace(n_rollers=12)
    for entry in known.estimated:
        if entry.path in ("pitch_diameter", "roller.effective_length"):
            assert _moved(known, entry, entry.low).n_rollers == _moved(known, entry, entry.high).n_rollers == 12


def test_what_follows_from_an_estimate_moves_with_it() -> None:
    """Both ends of every band can be built, and nothing is warned of: rollers neither overlap nor leave gaps."""
    bearing = trb.Bearing.from_catalogue(**PAGE)
    usual = bearing.n_rollers * bearing.roller.diameter / bearing.pitch_diameter
    for entry in bearing.estimated:
        for value in {entry.low, entry.high} - {entry.value}:
            moved = _moved(bearing, entry, value)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                trb.Simulation(trb.Scene(moved, speed_rpm=1000.0, axial_load=2000.0))
            fill = moved.n_rollers * moved.roller.diameter / moved.pitch_diameter
            if entry.path in ("roller.diameter", "pitch_diameter"):
                assert abs(fill - usual) <= 0.51 * moved.roller.diameter / moved.pitch_diameter
                assert moved.n_rollers != bearing.n_rollers or entry.path == "pitch_diameter"
            elif entry.path == "n_rollers":
                assert moved.roller == bearing.roller
                assert 0.8 * np.pi - 1e-9 < fill < 0.9 * np.pi + 1e-9
            if entry.path == "roller.effective_length":
                apart = bearing.roller.total_length - bearing.roller.effective_length
                assert moved.roller.total_length - moved.roller.effective_length == pytest.approx(apart)
