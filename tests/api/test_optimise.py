"""Designs that a search finds: of formulas whose best designs are known, and of runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import trbdyn as trb
from trbdyn.errors import InputError
from trbdyn.extras.design.guide import Aims, Fits, next_designs
from trbdyn.extras.study.uncertainty import unit_draws

SCENE = trb.cases.scene_32216(2000.0)
SCENE = SCENE.replace(bearing=SCENE.bearing.replace({"roller.profile": trb.Profile.crowned(20.0)}))
OPTIONS = trb.RunOptions(duration=2e-4, accuracy="fast", save_groups=("contacts", "torque"))
RADIUS, WARM = "bearing.roller.profile.crown_radius", "lubricant.temperature_c"
CHANGE = {RADIUS: (5.0, 100.0), WARM: (40.0, 60.0)}
TORQUE: Any = {"torque": "least"}


def searched(results: Any, aims: Aims, inputs: int, seed: int, rounds: int = 3) -> tuple[Any, Any]:
    unit = aims.snapped(unit_draws(inputs, 16, seed))
    for k in range(rounds):
        unit = np.vstack([unit, next_designs(unit, results(unit), aims, 8, seed + k)])
    return unit, results(unit)


def two_aims(unit: Any) -> Any:
    """Both aims are best where the second input is 0.3; along the first one they contradict each other."""
    off = (unit[:, 1] - 0.3) ** 2
    return np.stack([unit[:, 0] ** 2 + off, (unit[:, 0] - 1.0) ** 2 + off], axis=1)


def test_the_front_of_two_aims_with_chance_is_found() -> None:
    random = np.random.default_rng(1)
    made: dict[bytes, Any] = {}

    def results(unit: Any) -> Any:
        rows = [
            made.setdefault(row.tobytes(), two_aims(row[None])[0] + 0.05 * random.standard_normal(2)) for row in unit
        ]
        return np.array(rows)

    aims = Aims(2, (0, 0))
    unit, values = searched(results, aims, 2, 1)
    front = unit[aims.front(Fits(unit, values, 0).predicted(unit))]
    assert len(front) >= 5
    # what the second input costs in both aims, in the mean: a fifth of the chance in a result, and 0.12 of designs at random
    assert ((front[:, 1] - 0.3) ** 2).mean() < 0.015
    assert np.ptp(front[:, 0]) > 0.6


def test_a_limit_a_whole_number_and_designs_that_cannot_be_run() -> None:
    """The best number of eleven is 7; a limit keeps the second input above 0.4; beyond 0.8 of the third nothing runs."""
    aims = Aims(1, (11, 0, 0))

    def results(unit: Any) -> Any:
        number = np.floor(unit[:, 0] * 11.0)
        values = np.stack([(number - 7.0) ** 2 / 20.0 + unit[:, 1] - unit[:, 2], 0.4 - unit[:, 1]], axis=1)
        values[unit[:, 2] > 0.8] = np.nan
        return values

    unit, values = searched(results, aims, 3, 5)
    good = np.isfinite(values).all(axis=1) & (values[:, 1] <= 0.0)
    best = unit[np.where(good, values[:, 0], np.inf).argmin()]
    assert best[0] * 11.0 == pytest.approx(7.5)
    assert 0.4 <= best[1] < 0.48
    assert 0.72 < best[2] <= 0.8


def test_front_and_compromise_by_hand() -> None:
    values = np.array([[0.0, 1.0, -1.0], [0.4, 0.4, -1.0], [1.0, 0.0, 0.0], [0.5, 0.5, -1.0], [-1.0, -1.0, 0.1]])
    front = Aims(2, (0,)).front(values)
    assert front.tolist() == [True, True, True, False, False]
    assert Aims(2, (0,)).compromise(values, front) == 1


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("search")


def test_a_search_finds_a_better_design_and_goes_on_in_its_folder(kept: Path) -> None:
    tolerances = {RADIUS: (-1.0, 1.0)}
    how: dict[str, Any] = {"tolerances": tolerances, "draws": 2, "options": OPTIONS, "folder": kept}
    how["confirm"] = 3.0
    short = trb.optimise(SCENE, CHANGE, TORQUE, designs=10, **how)
    files = {path.name: path.stat().st_mtime_ns for path in kept.glob("*.h5")}
    long = trb.optimise(SCENE, CHANGE, TORQUE, designs=12, **how)
    assert all(path.stat().st_mtime_ns == files[path.name] for path in kept.glob("*.h5") if path.name in files)
    assert len(list(kept.glob("*.h5"))) > len(files)
    assert [one.inputs for one in long.designs[:6]] == [one.inputs for one in short.designs[:6]]
    again = trb.optimise(SCENE, CHANGE, TORQUE, designs=10, **how)
    assert [one.inputs for one in again.designs] == [one.inputs for one in short.designs]
    assert again.chosen == short.chosen
    assert long.first.inputs == {RADIUS: 20.0, WARM: 50.0}
    assert long.chosen.values["torque"] < 0.8 * long.first.values["torque"]
    # the torque of a design is that of its worst draw
    assert long.chosen.confirmed
    own = long.data.torque.values[(long.data.design == long.chosen.number) & (long.data.length == 3.0)]
    assert len(own) == 2
    assert long.chosen.values["torque"] == own.max() > own.min()
    first, chosen = long.pair(duration=2e-4)
    assert chosen.scene.bearing.roller.profile.crown_radius == long.chosen.inputs[RADIUS]
    assert chosen.numbers()["torque"] < first.numbers()["torque"]
    assert "chosen" in str(long)


def whirls_later(study: Any, **_: Any) -> xarray.Dataset:
    """What runs would give whose torque is least at the largest radius, but in longer runs is large beyond 60 m."""
    radius, length = (np.array([case.parameters[name] for case in study.cases], float) for name in (RADIUS, "length"))
    torque = 2.0 - 0.01 * radius + np.where(length > 1.0, 0.1 + 3.0 * (radius > 60.0), 0.0)
    columns = {
        "torque": torque,
        "settled": torque < 2.0,
        "status": np.full(len(torque), "done"),
        "message": np.full(len(torque), ""),
    }
    places = {name: ("case", [case.parameters[name] for case in study.cases]) for name in ("design", "length")}
    return xarray.Dataset({name: ("case", column) for name, column in columns.items()}, places)


def test_only_designs_that_longer_runs_confirm_are_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trbdyn.extras.design.optimise.run_study", whirls_later)
    change = {RADIUS: (5.0, 100.0)}
    short = trb.optimise(SCENE, change, TORQUE, designs=12, confirm=1.0)
    assert short.chosen.inputs[RADIUS] > 90.0
    assert not any(one.confirmed for one in short.designs)
    found = trb.optimise(SCENE, change, TORQUE, designs=28)
    assert 40.0 < found.chosen.inputs[RADIUS] <= 60.0
    assert all(one.confirmed for one in (*found.front, found.first))
    assert sum(one.confirmed for one in found.designs) <= 8
    assert found.chosen.expected["torque"] == found.chosen.values["torque"] < found.first.values["torque"]
    # the search goes on below the radius that longer runs refute
    assert np.median([one.inputs[RADIUS] for one in found.designs[-8:]]) < 65.0


def test_a_longer_run_that_fails_refuses_the_design(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails_later(study: Any, **how: Any) -> xarray.Dataset:
        data = whirls_later(study, **how)
        data["status"] = data["status"].where(data["torque"] < 3.0, "failed")
        data["message"] = data["message"].where(data["torque"] < 3.0, "the cage is torn")
        return data

    monkeypatch.setattr("trbdyn.extras.design.optimise.run_study", fails_later)
    found = trb.optimise(SCENE, {RADIUS: (5.0, 100.0)}, TORQUE, designs=16)
    assert 40.0 < found.chosen.inputs[RADIUS] <= 60.0
    assert set(found.refused) == {"the cage is torn"}


def test_an_angle_of_bars_that_the_scene_has_not() -> None:
    """The first design has the usual pocket; the others bars that lean by what is drawn."""
    found = trb.optimise(SCENE, {"bearing.cage.pocket.lean_deg": (5.0, 40.0)}, TORQUE, designs=10, options=OPTIONS)
    assert np.isnan(found.first.inputs["bearing.cage.pocket.lean_deg"])
    leans = [one.inputs["bearing.cage.pocket.lean_deg"] for one in found.designs[1:]]
    assert len(leans) >= 8
    assert 5.0 <= min(leans) < 12.0 < 30.0 < max(leans) <= 40.0


@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ({"want": {"torqe": "least"}}, "torqe"),
        ({"want": {"torque": "small"}}, "must be 'least' or 'most'"),
        ({"want": {}}, "must name at least one"),
        ({"change": {"bearing.roller.diametre": (1.0, 2.0)}}, "the scene has no number there"),
        ({"change": {RADIUS: (5.0, 5.0)}}, "must have low < high"),
        ({"limits": {"torque": -1.0}}, "keeps them; more designs"),
        ({"limits": {"torque": (None, None)}}, "must be the largest value"),
        ({"designs": 4}, "at least 10"),
        ({"judged": "median"}, "judged"),
        ({"confirm": 0.5}, "must be >= 1"),
    ],
)
def test_what_cannot_be_searched_for(changed: dict[str, Any], text: str) -> None:
    how: dict[str, Any] = {"change": CHANGE, "want": TORQUE, "designs": 10, "options": OPTIONS} | changed
    with pytest.raises(InputError, match=text):
        trb.optimise(SCENE, **how)
