"""The table of numbers: a new number is one row and its function, and stands everywhere."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.cli.sweep import table
from trbdyn.extras.design.planning.averaged import Records, check_names, least_size
from trbdyn.extras.study.gather import listed_in
from trbdyn.model.assembly import Subject
from trbdyn.results import numbers, summary
from trbdyn.results.number import Number, Place
from trbdyn.run.until import check_average

NAME = "angle_of_cage"
TURNS = 0.3


@pytest.fixture(scope="module", params=["bearing", "pair"])
def subject(request: pytest.FixtureRequest) -> Subject:
    effects = {"quadrature": "gauss", "n_slices": 4}
    if request.param == "bearing":
        scene = trb.cases.scene_30310(3000.0, 4930.0)
        return scene.replace(effects=scene.effects.replace(**effects))
    return trb.load_assembly("pair_30310")


@pytest.fixture(scope="module")
def result(subject: Subject) -> Any:
    return trb.Simulation(subject, accuracy="fast").run(revolutions=TURNS)


@pytest.fixture
def added(monkeypatch: pytest.MonkeyPatch) -> Number:
    """One more number: how far the cage has turned, in the mean."""
    row = Number(
        NAME,
        "mean angle of the cage",
        "rad",
        "How far the cage has turned, in the mean.",
        lambda seen: float(seen.window["cage_angle"].mean()),
        groups=("cage",),
        exists=lambda seen: seen.run.has_cage,
        least=1e-3,
        interval="load",
        together="sum",
        shown=frozenset(get_args(Place)),
        pictures=("cage_locus", "shaft_motion"),
        source="a test",
    )
    monkeypatch.setitem(numbers.TABLE, NAME, row)
    return row


def named(subject: Subject) -> list[str]:
    """The number of each bearing, and of the whole."""
    return [*(f"{name}_{NAME}" if name else NAME for name in subject.names)]


def test_a_new_number_is_everywhere(subject: Subject, result: Any, added: Number, tmp_path: Path) -> None:
    parts = [part.summary() for part in result.parts]
    values = [part[NAME] for part in parts]
    assert all(isinstance(value, float) for value in values)
    # print, HTML, JSON
    assert all(added.words in str(part) for part in parts)
    assert added.words in str(result) or added.words in result._shown().html()
    written = json.loads(summary.write_json(parts[0], tmp_path / "s.json").read_text(encoding="utf-8"))
    assert written[NAME] == values[0]
    # one table of all numbers, and the sum of the whole
    every = result.numbers()
    assert [every[name] for name in named(subject)] == values
    assert every[NAME] == pytest.approx(sum(values))
    # averages: until, plans, least sizes
    check_average(NAME, "until")
    check_names(subject, named(subject))
    assert least_size(named(subject)[-1]) == 1e-3
    found = Records.of(subject, result).averages()
    assert [found[name] for name in named(subject)] == pytest.approx(
        [float(part["cage_angle"].mean()) for part in result.parts]
    )


def test_studies_have_it(subject: Subject, added: Number, tmp_path: Path) -> None:
    options = trb.study.RunOptions(duration=2e-3, accuracy="fast")
    speeds = [2000.0 + 100.0 * k for k in range(2)]
    data = trb.study.run([subject.replace(speed_rpm=speed) for speed in speeds], tmp_path, options=options)
    for name in {*named(subject), NAME}:
        assert np.isfinite(data[name].values).all()
        assert data[name].attrs["units"] == "rad"
        assert added.words in data[name].attrs["long_name"]
        for place in get_args(Place):
            assert name in listed_in(data, place)
        assert name in table(data)


def test_a_name_is_found_with_its_bearing_and_its_part() -> None:
    found = numbers.find("left_torque_by_loss_rolling_pressure", ("left", "right"))
    assert found is not None
    assert (found.bearing, found.row.name, found.part) == ("left_", "torque_by_loss", "rolling_pressure")
    assert found.words == "left: the same as friction torque of the shaft: rolling pressure"
    width = numbers.find("confidence_torque")
    assert width is not None
    assert (width.row.name, width.part, width.unit) == ("torque", "confidence", "N m")
    assert numbers.find("left_torque") is None
    with pytest.raises(trb.InputError, match="did you mean 'torque'"):
        numbers.check("torqe", "want")


def test_a_summary_says_why_a_number_is_not_there(result: Any) -> None:
    values = result.parts[0].summary()
    assert all(value is not None and value != {} for value in values.values())
    assert set(values) | set(values.absent) == set(numbers.TABLE)
    with pytest.raises(KeyError, match="the scene of this run has none"):
        values["land_force_peak"]
    with pytest.raises(KeyError, match="needs the group pocket"):
        result.parts[0].select(["cage", "rollers"]).summary()["pocket_duty"]
    with pytest.raises(KeyError, match="did you mean 'torque'"):
        values["torqe"]


def test_rows_are_whole() -> None:
    """Extremes, lives and counts are of the whole run, averages of the window; each row says what it needs."""
    for row in numbers.rows():
        assert row.words, row.name
        assert row.meaning.endswith("."), row.name
        if row.kind in ("largest", "smallest", "life", "count"):
            assert row.of == "run", row.name
        if row.interval:
            assert row.of == "window", row.name
            assert row.groups, row.name
        if row.name.endswith("_time"):
            assert row.unit == "s", row.name
        assert math.isfinite(row.least)
