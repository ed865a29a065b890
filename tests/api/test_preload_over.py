"""Preload over temperature: against fits, equilibria and ratings one by one, and thermal balances whose answers are known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.heat import PARTS
from trbdyn.study import preload_over as module
from trbdyn.study.heat_network import film_temperature, network

SEAT: dict[str, Any] = {"bore": 0.050, "outside": 0.110, "width": 0.02925, "shaft": "m6", "housing": "P7"}
ALUMINIUM = trb.Mounting(**SEAT, housing_material=trb.Material.aluminium())
CYLINDER = trb.Mounting(bore=0.050, outside=0.090, width=0.020, shaft="k5", housing="H7")


def pair(arrangement: str = "face to face", **fields: Any) -> trb.Assembly:
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    gear = trb.ShaftLoad.gear(position=0.15, pitch_diameter=0.06, torque=150.0, helix_angle_deg=30.0)
    return trb.Assembly.pair(
        trb.cases.rig_30310(),
        arrangement,
        spread=0.088 if arrangement == "face to face" else 0.132,
        end_play=-23e-6,
        shaft=shaft,
        **{"speed_rpm": 1500.0, "lubricant": "vg68", "loads": [gear], **fields},
    )


def test_rows_are_what_each_question_answers() -> None:
    one = pair()
    found = trb.preload_over(one, ALUMINIUM, [0.0, 60.0])
    for row, temperature in zip(found.rows, (0.0, 60.0), strict=True):
        warm = trb.fit(one, ALUMINIUM, temperatures=trb.Temperatures.uniform(temperature)).subject
        warm = warm.replace({f"bearings[{k}].lubricant": trb.lubricants.vg68(temperature) for k in (0, 1)})
        stands = trb.equilibrium(warm)
        assert row.plays["end play"] == pytest.approx(sum(part.end_play for part in warm.bearings))
        assert row.sheets["left"].axial_load == pytest.approx(stands["left"].axial_load, rel=1e-9)
        assert row.life_hours == pytest.approx(trb.rating(stands).life_hours, rel=1e-9)
        assert row.axial_stiffness == pytest.approx(stands.at_mass.matrix[2, 2], rel=1e-9)
        power = sum(part["power"].sum() for part in trb.Simulation(warm).contacts().values())
        assert row.torque == pytest.approx(power / (1500.0 * math.pi / 30.0), rel=1e-6)
    at = found.lost["end play"][0]
    crossing = trb.fit(one, ALUMINIUM, temperatures=trb.Temperatures.uniform(at)).plays["end play"]["operating"]
    assert crossing.mean == pytest.approx(0.0, abs=5e-8)
    assert "changes its sign" in str(found)
    assert "Fa N" in found._repr_html_()


def test_housing_and_arrangement_turn_the_preload() -> None:
    """In aluminium a pair face to face loses its preload when warm; back to back the length of the housing brings it back."""
    cold, warm = [0.0, 60.0], [80.0, 140.0]
    face = trb.preload_over(pair(), ALUMINIUM, [*cold, 100.0])
    plays = [row.plays["end play"] for row in face.rows]
    assert plays[0] < -50e-6 < 50e-6 < plays[1] < plays[2]
    back = [row.plays["end play"] for row in trb.preload_over(pair("back to back"), ALUMINIUM, warm).rows]
    assert back[1] < back[0] - 40e-6


def test_a_cylindrical_bearing() -> None:
    scene = trb.cases.scene_nj210()
    warm = trb.Temperatures(shaft_c=90.0, inner_ring_c=90.0, rollers_c=85.0, outer_ring_c=60.0, housing_c=55.0)
    found = trb.preload_over(scene, CYLINDER, [20.0, warm])
    play = [row.plays[""] for row in found.rows]
    assert play[1] < play[0] - 15e-6
    assert found.rows[1].temperature_c == pytest.approx(80.0)
    assert found.rows[1].sheets[""].life_hours is not None


def test_what_cannot_be_is_said_row_by_row() -> None:
    """The oil is not known at -60 C, and a shaft without load and with play is held by nothing."""
    idle = pair(loads=[trb.ShaftLoad(position=0.0, force=(0.0, -10.0, 0.0))], gravity=(0.0, 0.0, 0.0))
    found = trb.preload_over(idle, ALUMINIUM, [-60.0, 20.0])
    assert "temperature_c" in found.rows[0].said
    assert found.rows[0].torque is None
    assert found.rows[0].plays["end play"] < found.rows[1].plays["end play"] == pytest.approx(-23e-6)
    assert "-60 C: " in str(found)
    picture = found.picture()
    assert next(line.get_label() for line in picture.axes[0].lines) == "end play"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"temperatures": []}, "one temperature or more"),
        ({"temperatures": ["warm"]}, r"temperatures\[0\]"),
        ({"temperatures": [{"left": trb.Temperatures.uniform(20.0)}]}, "left, right"),
        ({"paths": "cold"}, "paths"),
        ({"mounting": {"left": ALUMINIUM}}, "left, right"),
    ],
)
def test_refusals(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(trb.InputError, match=words):
        trb.preload_over(pair(), **{"mounting": ALUMINIUM, "temperatures": [20.0], **arguments})


def test_an_oil_that_is_not_known_at_other_temperatures_is_refused() -> None:
    known = trb.lubricants.vg68()
    oil = trb.Lubricant(**{name: getattr(known, name) for name in type(known).model_fields if name != "oil"})
    scene = trb.cases.scene_nj210(lubricant=oil)
    with pytest.raises(trb.InputError, match=r"lubricant\.oil"):
        trb.preload_over(scene, CYLINDER)


PATHS = trb.HeatPaths(outer_ring_to_surroundings=3.0, inner_ring_to_surroundings=1.0, oil_flow=2.0)


def resistance() -> float:
    """How much warmer films are for one watt of drag in the oil (K/W)."""
    paths = PATHS.replace(housing_air_c=0.0, shaft_end_c=0.0, oil_inlet_c=0.0)
    return film_temperature(network(paths, {**dict.fromkeys(PARTS, 0.0), "oil": 1.0}))


def losses_by_film(monkeypatch: pytest.MonkeyPatch, law: Any) -> None:
    def losses(_: Any, subject: Any) -> list[dict[str, float]]:
        return [{"drag": law(subject.lubricant.temperature_c)}]

    monkeypatch.setattr(module._Warm, "losses", losses)


def test_a_balance_with_a_linear_law(monkeypatch: pytest.MonkeyPatch) -> None:
    """P = P0 + k (t - 20): t = T + R P, and one watt makes k R of it."""
    r = resistance()
    losses_by_film(monkeypatch, lambda t: 40.0 + 0.5 / r * (t - 20.0))
    found = trb.preload_over(trb.cases.scene_nj210(), CYLINDER, [20.0, 30.0], paths=PATHS)
    for row, outside in zip(found.rows, (20.0, 30.0), strict=True):
        power = (40.0 + 0.5 / r * (outside - 20.0)) / 0.5
        film = module._film(row.temperatures[""])
        assert film == pytest.approx(outside + r * power, rel=2e-3)
        assert row.feedback == pytest.approx(0.5, rel=1e-3)
    assert found.runs_away_c is None
    assert "stable balance" in str(found)


def test_a_balance_that_runs_away(monkeypatch: pytest.MonkeyPatch) -> None:
    """P = P0 exp(b t), t = T + R P has no solution beyond b R P = 1: T = (ln[1/(b R P0)] - 1)/b."""
    r, b, p0 = resistance(), 0.03, 8.0
    losses_by_film(monkeypatch, lambda t: p0 * math.exp(b * min(t, 400.0)))
    edge = (math.log(1.0 / (b * r * p0)) - 1.0) / b
    outside = [edge - 30.0, edge - 15.0, edge + 5.0, edge + 20.0]
    found = trb.preload_over(trb.cases.scene_nj210(), CYLINDER, outside, paths=PATHS)
    assert len(found.rows) == 2
    assert found.runs_away_c == pytest.approx(edge, abs=1.0)
    assert 0.0 < found.rows[0].feedback < found.rows[1].feedback < 1.0
    assert "runs away" in str(found)
    with pytest.raises(trb.TrbError, match="that has a balance"):
        trb.preload_over(trb.cases.scene_nj210(), CYLINDER, [edge + 20.0], paths=PATHS)


def test_the_balance_of_a_pair_gives_off_what_it_loses() -> None:
    one, iron = pair(speed_rpm=3000.0, lubricant="vg32"), trb.Mounting(**SEAT)
    paths = trb.HeatPaths.reference(bore=0.050, outside=0.110, width=0.02925)
    row = trb.preload_over(one, iron, [20.0], paths=paths).rows[0]
    given = [
        3.23498 * (row.temperatures[name].outer_ring_c - 20.0) + 1.47045 * (row.temperatures[name].inner_ring_c - 20.0)
        for name in ("left", "right")
    ]
    assert sum(given) == pytest.approx(row.torque * 3000.0 * math.pi / 30.0, rel=3e-3)
    assert row.feedback is not None
    assert row.feedback < 0.0
    assert np.isfinite(row.axial_stiffness)
