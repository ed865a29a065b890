"""Preload over temperature: against fits, equilibria and ratings one by one, and thermal balances whose answers are known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.heat import preload_over as module
from trbdyn.extras.heat.heat_network import film_temperature, network
from trbdyn.extras.heat.paths import PARTS

SEAT: dict[str, Any] = {"bore": 0.050, "outside": 0.110, "width": 0.02925, "shaft": "m6", "housing": "P7"}
ALUMINIUM = trb.Mounting(**SEAT, housing_material=trb.Material.aluminium())
CYLINDER = trb.Mounting(bore=0.050, outside=0.090, width=0.020, shaft="k5", housing="H7")
EFFECTS = trb.Effects.standard().replace(n_slices=4)
NJ210 = trb.cases.scene_nj210(effects=EFFECTS)


def pair(arrangement: str = "face to face", **fields: Any) -> trb.Assembly:
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    gear = trb.ShaftLoad.gear(position=0.15, pitch_diameter=0.06, torque=150.0, helix_angle_deg=30.0)
    return trb.Assembly.pair(
        trb.cases.rig_30310(),
        arrangement,
        spread=0.088 if arrangement == "face to face" else 0.132,
        end_play=-23e-6,
        shaft=shaft,
        **{"speed_rpm": 1500.0, "lubricant": "vg68", "loads": [gear], "effects": EFFECTS, **fields},
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
    outside = [edge - 30.0, edge - 15.0, edge + 5.0]
    found = trb.preload_over(NJ210, CYLINDER, outside, paths=PATHS)
    assert len(found.rows) == 2
    assert found.runs_away_c == pytest.approx(edge, abs=1.0)
    assert 0.0 < found.rows[0].feedback < found.rows[1].feedback < 1.0
    assert [one.why for one in found.without] == ["runs away"]
    assert all(one.feedback >= 1.0 for one in found.without)
    assert "runs away" in str(found)
    with pytest.raises(trb.TrbError, match="runs away: one watt of loss makes"):
        trb.preload_over(NJ210, CYLINDER, [edge + 20.0], paths=PATHS)


def test_losses_of_the_row_before_do_not_decide(monkeypatch: pytest.MonkeyPatch) -> None:
    """Losses that fall from 100 K/R to 10 K/R: with those of the row before parts would be hotter than 180 C at 100 C outside;
    from cold there is the balance t = T + R P(t).
    """
    r = resistance()
    losses_by_film(monkeypatch, lambda t: (100.0 if t < 100.0 else max(100.0 - 9.0 * (t - 100.0), 10.0)) / r)
    found = trb.preload_over(NJ210, CYLINDER, [0.0, 105.0], paths=PATHS)
    assert not found.without
    assert module._film(found.rows[0].temperatures[""]) == pytest.approx(100.0, abs=0.2)
    assert module._film(found.rows[1].temperatures[""]) == pytest.approx(115.0, abs=0.2)


def test_parts_that_are_too_hot_do_not_run_away(monkeypatch: pytest.MonkeyPatch) -> None:
    """Constant losses that would need 300 C: the feedback is 0, so that nothing runs away."""
    r = resistance()
    losses_by_film(monkeypatch, lambda t: 280.0 / r)
    with pytest.raises(trb.TrbError, match=r"20 C, too hot: parts become hotter than 180 C"):
        trb.preload_over(NJ210, CYLINDER, [20.0], paths=PATHS)


def test_an_error_of_the_machine_is_not_a_missing_balance(monkeypatch: pytest.MonkeyPatch) -> None:
    def law(t: float) -> float:
        raise RuntimeError("a step failed")

    losses_by_film(monkeypatch, lambda t: 1.0 if t <= 21.0 else law(t))
    with pytest.raises(RuntimeError, match="a step failed"):
        trb.preload_over(NJ210, CYLINDER, [20.9], paths=PATHS)


def test_a_play_that_opens_is_no_preload_that_runs_away() -> None:
    """Aluminium and no load on the shaft: heat opens the play (-5.4 um at 0 C outside, none is left at 40 C with cold parts)."""
    idle = pair(loads=[], gravity=(0.0, 0.0, 0.0))
    paths = trb.HeatPaths.reference(bore=0.050, outside=0.110, width=0.02925)
    found = trb.preload_over(idle, ALUMINIUM, [0.0, 40.0], paths=paths)
    assert found.runs_away_c is None
    assert [one.why for one in found.without] == ["nothing holds the shaft"]
    assert found.rows[0].plays["end play"] == pytest.approx(-5.4e-6, abs=0.3e-6)
    assert "heat opens the play" in str(found)
    assert "heat makes preload" not in str(found)


def test_a_range_of_plays_has_its_best_marked() -> None:
    """Each row is that of preload_over; where the preload is heavy the life is short, and the shaft stiffer than with play."""
    one, seat = pair(), trb.Mounting(**SEAT)
    plays = [-100e-6, -20e-6, 60e-6]
    found = trb.preload_range(one, seat, plays[::-1], temperature=40.0)
    assert [row.play for row in found.rows] == plays
    alone = trb.preload_over(
        one.replace(bearings=tuple(b.replace(end_play=-10e-6) for b in one.bearings)), seat, [40.0]
    )
    assert found.rows[1].life_hours == pytest.approx(alone.rows[0].modified_reference_life_hours, rel=1e-9)
    lives = [row.life_hours for row in found.rows]
    assert found.best is not None
    assert found.best[0] <= plays[int(np.argmax(lives))] <= found.best[1]
    assert found.rows[0].found.axial_stiffness > found.rows[2].found.axial_stiffness
    assert "best: " in str(found)
    beyond = trb.preload_range(trb.cases.scene_nj210(), CYLINDER, [20e-6, 60e-6])
    more = beyond.rows[1].found.plays[""] - beyond.rows[0].found.plays[""]
    assert more == pytest.approx(40e-6, abs=1e-9)
    with pytest.raises(trb.InputError, match="which have a play"):
        trb.preload_range(trb.cases.scene_30310(), seat, [0.0])
    with pytest.raises(trb.InputError, match="one play or more"):
        trb.preload_range(one, seat, [])


def spindle(speed_rpm: float, arrangement: str, spread: float) -> trb.Assembly:
    """That of docs/howto/spindle.md."""
    shaft = trb.Shaft.hollow_cylinder(mass=12.0, inner_diameter=0.02, outer_diameter=0.05, length=0.45)
    tool = trb.ShaftLoad(position=-0.2, force=(300.0, -500.0, 800.0))
    made: dict[str, Any] = {"end_play": -10e-6, "shaft": shaft, "speed_rpm": speed_rpm, "loads": [tool]}
    return trb.Assembly.pair(trb.cases.rig_30310(), arrangement, spread=spread, lubricant="vg32", **made)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed_rpm", "arrangement", "spread", "outside"),
    [(6000.0, "back to back", 0.30, [20.0, 40.0]), (3000.0, "face to face", 0.24, [20.0])],
)
def test_the_spindle_has_a_balance(speed_rpm: float, arrangement: str, spread: float, outside: list[float]) -> None:
    """Each row gives off what it loses, and losing 2 % more would not last; at 3000 rpm each bearing has 0.34 mm of preload."""
    seat = trb.Mounting(**{**SEAT, "shaft": "k5", "housing": "JS6", "accuracy": "5", "shaft_bore": 0.020})
    hot = {"outer_ring_to_surroundings": 30.0, "inner_ring_to_surroundings": 0.3, "outer_ring_to_rollers": 3.0}
    paths = trb.HeatPaths(**hot, outer_ring_to_oil=1.0)
    found = trb.preload_over(spindle(speed_rpm, arrangement, spread), seat, outside, paths=paths)
    assert [row.temperature_c for row in found.rows] == outside
    assert found.runs_away_c is None
    for row in found.rows:
        parts = row.temperatures.values()
        given = sum(
            30.0 * (p.outer_ring_c - row.temperature_c) + 0.3 * (p.inner_ring_c - row.temperature_c) for p in parts
        )
        assert given == pytest.approx(row.torque * speed_rpm * math.pi / 30.0, rel=3e-3)
        assert -1.0 < row.feedback < 0.5


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
