"""How objects show themselves: tables in a notebook, short texts in a terminal."""

from __future__ import annotations

import html
import json
import pickle
from html.parser import HTMLParser

import pytest

import trbdyn as trb
from trbdyn.base.shown import Displayed, Shown
from trbdyn.extras.design.what_matters import Influence, Sensitivity
from trbdyn.results.numbers import TABLE


class Cells(HTMLParser):
    """Collects the cells of every table, and sees that each tag that is opened is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.rows: list[list[str]] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


def cells(shown: Displayed) -> list[list[str]]:
    found = Cells()
    found.feed(shown._repr_html_())
    assert found.open == []
    return found.rows


@pytest.fixture(scope="module")
def simulation() -> trb.Simulation:
    return trb.Simulation(trb.cases.scene_30310(2000.0, 4930.0, 5530.0), accuracy="fast")


@pytest.fixture(scope="module")
def result(simulation: trb.Simulation) -> trb.Result:
    return simulation.run(revolutions=0.5)


def test_inputs_show_as_a_table_with_units_and_meanings() -> None:
    bearing = trb.Bearing.from_catalogue(bore=0.045, outside=0.085, width=0.02075, C=67e3, e=0.4, name="<32009 & Co>")
    rows = {row[0]: row for row in cells(bearing)}
    value, unit, meaning = rows["pitch_diameter"][1:]
    assert float(value) == pytest.approx(bearing.pitch_diameter, rel=1e-5)
    assert unit == "m"
    assert "estimated" in meaning
    assert "assumed" in rows["land.clearance"][3]
    assert rows["name"][1] == "<32009 & Co>"  # escaped in the page
    assert len(repr(bearing)) < 160
    assert f"{bearing.n_rollers} rollers" in repr(bearing)
    assert rows["roller.density"][2] == "kg/m3"


def test_a_scene_shows_its_own_inputs_and_folds_its_parts() -> None:
    history = trb.History.ramp(0.0, 0.1, 0.0, 3000.0)
    scene = trb.cases.scene_30310(effects=trb.Effects.paper()).replace(speed_rpm=history)
    page = scene._repr_html_()
    assert page.count("<details>") == 4
    assert (
        "standard but for thermal_law, supply, rolling_law, rolling_load, rolling_pressure_force, rib_film, damping, "
        "quadrature, n_slices" in page
    )
    assert ["axial_load", "4930", "N"] in [row[:3] for row in cells(scene)]
    assert repr(scene) == "<Scene: 30310, speed changing in time, axial load 4930 N, VG100 (FVA3) at 60 C>"


def test_a_simulation_and_a_result_show_what_they_are(simulation: trb.Simulation, result: trb.Result) -> None:
    shown = cells(simulation)
    assert ["time", f"{simulation.time:g}", "s"] in [row[:3] for row in shown]
    assert ["accuracy", "fast"] in [row[:2] for row in shown]
    assert "2000 rpm" in repr(simulation)
    shown = cells(result)
    words, unit = TABLE["torque"].words, TABLE["torque"].unit
    found = [row[:3] for row in shown if row[0] == words]
    assert found[0][1].split(" ±")[0] == f"{result.summary()['torque']:.5g}"
    assert found[0][2] == unit
    assert "success" in repr(result)


def test_a_summary_is_a_dictionary_that_prints_as_a_table(result: trb.Result) -> None:
    numbers = result.summary()
    assert isinstance(numbers, dict)
    assert json.loads(json.dumps(numbers)) == numbers
    assert pickle.loads(pickle.dumps(numbers)) == numbers
    line = next(line for line in str(numbers).splitlines() if line.startswith("friction torque of the shaft"))
    assert f"{numbers['torque']:.5g} ± " in line
    assert line.split()[-2:] == ["N", "m"]
    assert str(numbers) == repr(numbers)
    assert max(map(len, repr(numbers).splitlines())) < 140
    (row,) = (row for row in cells(numbers) if row[3:] == ["torque"])
    assert row[1].startswith(f"{numbers['torque']:.5g} ± ")


def test_a_study_shows_its_axes_and_cases() -> None:
    places = {"scene.speed_rpm": [1000, 2000, 3000], "bearing.cage.mass": [0.1, 0.2]}
    study = trb.study.grid(trb.cases.scene_30310(), places, trb.study.RunOptions(revolutions=1), name="masses")
    assert repr(study) == "<Study masses: 6 cases, 3 speed_rpm x 2 mass>"
    shown = cells(study)
    assert ["mass", "0.1, 0.2", "bearing.cage.mass"] in shown
    assert len([row for row in shown if len(row) == 2]) == 7
    many = trb.study.grid(trb.cases.scene_30310(), {"scene.speed_rpm": list(range(1000, 1120))})
    assert "and 70 cases more" in many._repr_html_()


def test_an_end_that_is_not_possible_says_why() -> None:
    """It said 'not possible' without the reason."""
    bearing = trb.Bearing.from_catalogue(
        bore=0.040, outside=0.080, width=0.02475, C=74.8e3, e=0.37, n_rollers=17, name="32208"
    )
    entry = next(entry for entry in bearing.estimated if entry.path == "roller.diameter")
    reason = "0.012: bearing.n_rollers = 17 : must be <= 15"
    found = Sensitivity("torque", 0.6, 0.001, (Influence(entry, 0.59, None, 0.01, True, reason),))
    assert f"Not possible: roller.diameter = {reason}" in str(found)
    assert repr(found) == str(found)
    assert reason in html.unescape(found._repr_html_())


def test_text_stands_in_columns() -> None:
    shown = Shown("title", (("a", "1", "N", "one"), ("long name", "22", "mm", "two")), notes=("n " * 80,))
    lines = shown.text().splitlines()
    assert lines[:3] == ["title", "a          1 N    one", "long name  22 mm  two"]
    assert shown.text(columns=3).splitlines()[1:3] == ["a          1 N", "long name  22 mm"]
    assert max(map(len, lines)) <= 100


def test_a_sentence_among_values_wraps_and_a_number_does_not() -> None:
    """A long value that did not wrap left the words beside it a column of one word."""
    page = Shown(
        rows=(("groups", "time, cage, rollers, contacts, pocket", ""), ("torque", "1.484 ± 0.00035", "N m"))
    ).html()
    for text, wraps in (("time, cage", True), ("1.484", False), ("N m", False)):
        style = page[: page.index(text)].rpartition("<td style='")[2]
        assert ("nowrap" not in style) == wraps, text


PYDANTIC = (
    "model_dump",
    "model_fields",
    "model_config",
    "model_copy",
    "copy",
    "dict",
    "json",
    "schema",
    "parse_obj",
    "construct",
)


@pytest.mark.parametrize("kind", ["Scene", "Bearing", "Lubricant", "Effects", "Start"])
def test_completion_of_an_input_shows_what_users_need(kind: str) -> None:
    """It listed the forty names that pydantic gives to every model; they work as before."""
    scene = trb.cases.scene_30310()
    model = scene if kind == "Scene" else getattr(scene, kind.lower())
    names = dir(model)
    assert set(type(model).model_fields) | {"replace", "to_dict", "to_json"} <= set(names)
    assert not set(PYDANTIC) & set(names)
    assert not [name for name in names if name.startswith(("_", "model_"))]
    assert all(hasattr(model, name) for name in names)
    assert model.model_copy() == model
    assert set(model.model_dump()) <= set(names)


def test_an_estimate_and_peaks_show_as_tables(simulation: trb.Simulation, result: trb.Result) -> None:
    estimate = simulation.estimate(revolutions=1)
    rows = {row[0]: row[1:] for row in cells(estimate)}
    assert rows["steps"][0] == f"{estimate.steps:,}"
    assert rows["expected wall time"][1] == "s"
    assert repr(estimate) == str(estimate)
    assert "Estimate(" not in repr(estimate)
    rows = {row[0]: row[1:] for row in cells(result.peaks)}
    assert rows["pocket_force_peak"][:2] == [f"{result.peaks['pocket_force_peak'].max():.5g}", "N"]
    assert rows["spacing_min"][0] == f"{result.peaks['spacing_min'].min():.5g}"
    assert "pocket_force_peak_time" not in rows
    assert len(repr(result.peaks)) < 120


def test_a_lubricant_is_short_as_text() -> None:
    oil = trb.Lubricant(oil="vg68", temperature_c=60.0)
    assert str(oil) == repr(oil) == "<Lubricant VG68 at 60 C, 24.48 mPa s>"
    assert str(oil.oil) == "<Oil VG68: 68 and 8.7 mm2/s at 40 and 100 C>"
    assert "law of Vogel" in str(trb.lubricants.FVA3)
