"""Creep of rollers: creep number against independent values and the core's own forces; the planar model against its law."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.statics.creep import creep, growth_per_turn

GAUSS = trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
RIG = {"n_rollers": 12, "lean": math.radians(26.39), "play_ratio": 0.48, "inertia": 1.149}


@pytest.mark.parametrize(
    ("load", "stated", "within"), [(1230.0, 43.0, 0.15), (3080.0, 2.7, 0.06), (4930.0, 0.46, 0.06)]
)
def test_creep_number_of_an_independent_study(load: float, stated: float, within: float) -> None:
    found = creep(trb.cases.scene_30310(3000.0, load, effects=GAUSS))
    assert found.chi == pytest.approx(stated, rel=within)
    assert found.froude == pytest.approx(0.437, abs=1e-3)


def test_starved_films_creep_less() -> None:
    full, starved = (
        creep(trb.cases.scene_30310(3000.0, 4930.0, effects=GAUSS.replace(starvation_factor=factor)))
        for factor in (1.0, 0.5)
    )
    assert starved.chi == pytest.approx(0.5 * full.chi, rel=0.01)


def test_creep_number_scales_with_gravity_and_froude_against_it() -> None:
    one, two = (
        creep(trb.cases.scene_30310(3000.0, 4930.0, effects=GAUSS, gravity=(0.0, -g, 0.0))) for g in (9.80665, 19.6133)
    )
    assert two.chi == pytest.approx(2.0 * one.chi, rel=1e-6)
    assert two.froude == pytest.approx(0.5 * one.froude, rel=1e-9)


@pytest.fixture
def planar() -> Any:
    import planar_cage as planar

    return planar


@pytest.mark.parametrize("froude", [pytest.param(0.1, marks=pytest.mark.slow), 0.2, 0.437])
def test_planar_model_follows_the_growth_law(planar: Any, froude: float) -> None:
    cage = planar.Cage(friction=0.0, roller_mass=0.0)
    rate = planar.growth(planar.simulate(np.array([0.1]), froude, 8, 0.2, cage))
    # 0.003: scatter of the planar model over eccentricities 0.1 to 0.6
    assert rate[0] / 0.1 == pytest.approx(growth_per_turn(1.0, froude, **RIG), abs=0.003)


def test_planar_cage_above_the_yield_limit_rests(planar: Any) -> None:
    motion = planar.simulate(np.array([2.7, 36.0]), 0.437, 16, 0.9)
    whirl = whirl_at_the_end(planar, motion)
    assert whirl[0] > 0.6
    assert whirl[1] < 0.1


def whirl_at_the_end(planar: Any, motion: Any) -> np.ndarray:
    """Radius of the circle that the cage runs with the rollers in the last eight turns (Cpr)."""
    samples = planar.SAMPLES
    turning = motion.position * np.exp(-2j * np.pi * np.arange(motion.position.shape[0]) / samples)[:, None]
    return np.abs(turning[-8 * samples - 1 : -1].mean(axis=0))


@pytest.mark.slow
def test_planar_growth_is_converged_in_stiffness_and_steps(planar: Any) -> None:
    cage = planar.Cage(friction=0.0, roller_mass=0.0)
    rates = [
        planar.growth(planar.simulate(np.array([0.5]), 0.437, 6, 0.3, cage, stiffness=stiff, steps_per_period=steps))[0]
        for stiff, steps in ((100.0, 16.0), (400.0, 16.0), (100.0, 48.0))
    ]
    assert rates[0] > 0.0
    # per creep number, within the scatter over eccentricities
    assert np.array(rates[1:]) / 0.5 == pytest.approx(rates[0] / 0.5, abs=0.003)


def grown(planar: Any, scene: trb.Scene, turns: float) -> tuple[Any, float]:
    """A run of the complete model for some turns of its cage, and the growth of its pattern a turn."""
    bearing = scene.bearing
    period = 60.0 / (scene.speed_rpm * bearing.geometry.cage_speed_ratio)
    result = trb.Simulation(scene, accuracy="fast").run(
        duration=turns * period, save_every=period / planar.SAMPLES, save_groups=("cage", "rollers")
    )
    even = 2.0 * np.pi * np.arange(bearing.n_rollers) / bearing.n_rollers
    off = result["roller_orbit_angle"] - even
    pattern = 2j * ((off - off.mean(axis=1, keepdims=True)) @ np.exp(1j * even)) / bearing.n_rollers
    size = np.array([1.0, 0.5 * bearing.pitch_diameter]) / bearing.cage.play_radial
    place = result["cage_position"][:, :2] @ np.array([1.0, 1j])
    motion = planar.Motion((size[0] * place)[:, None], (size[1] * pattern)[:, None])
    return motion, float(planar.growth(motion)[0])


@pytest.mark.slow
# measured: from 0.2 and 0.4 Cpr, "fast" and "standard"; +- the spread and the scatter of the derived law, 0.003 chi
@pytest.mark.parametrize(
    ("speed", "gravity", "low", "high"),
    [
        (3000.0, 9.80665, 0.0058, 0.0099),
        (3000.0, 4.9, 0.0100, 0.0125),
        (2000.0, 20.0, -0.0137, -0.0066),
        (1000.0, 9.80665, -0.0111, -0.0058),
    ],
)
def test_growth_of_a_whirl(planar: Any, speed: float, gravity: float, low: float, high: float) -> None:
    """In all four 5 s."""
    what = trb.cases.scene_30310(speed, 4930.0, effects=GAUSS, gravity=(0.0, -gravity, 0.0), start=trb.Start.whirl(0.4))
    _, rate = grown(planar, what, 20)
    assert low < rate < high


@pytest.mark.slow
def test_rollers_that_creep_fast_end_a_whirl(planar: Any) -> None:
    """4 s: 1230 N (chi 49) against 3080 N (chi 2.8), from 0.9 Cpr."""
    ends = []
    for load in (1230.0, 3080.0):
        what = trb.cases.scene_30310(3000.0, load, effects=GAUSS, start=trb.Start.whirl(0.9))
        ends.append(whirl_at_the_end(planar, grown(planar, what, 20)[0])[0])
    assert ends[0] < 0.1
    assert ends[1] > 0.5


@pytest.mark.slow
def test_loaded_zone_on_top_slows_growth_and_at_the_bottom_hastens_it(planar: Any) -> None:
    """2 s; 0.002: spread of the rate over eccentricities and tolerances."""
    top, axial, bottom = (
        grown(
            planar,
            trb.cases.paper_30310(
                3000.0, 4930.0, radial, effects=GAUSS, radial_direction_deg=direction, start=trb.Start.whirl(0.3)
            ),
            12,
        )[1]
        for radial, direction in ((1400.0, 90.0), (0.0, 90.0), (1400.0, -90.0))
    )
    assert top < axial - 0.002
    assert bottom > axial + 0.002
