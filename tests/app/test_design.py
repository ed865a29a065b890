"""What is typed means what the Python that the page shows means; what is wrong stands at its field."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from trbdyn.app.design import Design, all_fields, built, script
from trbdyn.app.outcome import case_of
from trbdyn.app.units import read
from trbdyn.run.toml_assembly import subject_from_dict

PAGE = {
    "page.name": "32208",
    "page.bore": "40",
    "page.outside": "80",
    "page.width": "24.75",
    "page.C": "74.8",
    "page.e": "0.37",
    "scene.speed_rpm": "2000",
    "scene.axial_load": "2.5 kN",
    "run.revolutions": "2",
}


def design(pair: bool = False, **typed: str) -> Design:
    return Design(
        source="page", typed={**PAGE, **{key.replace("__", "."): text for key, text in typed.items()}}, pair=pair
    )


CHANGES: dict[str, str] = {
    "bearing.cage.mass": "80 g",
    "bearing.n_rollers": "17",
    "effects.thermal": "off",
    "bearing.cage.pocket.shape": "drafted",
    "bearing.cage.pocket.lean_deg": "20",
    "lubricant.oil": "vg68",
    "lubricant.temperature_c": "70",
    "scene.radial_load": "300",
}


@pytest.mark.parametrize("pair", [False, True])
@pytest.mark.parametrize("changes", [{}, CHANGES])
def test_python_and_case_give_what_the_page_runs(pair: bool, changes: dict[str, str]) -> None:
    chosen = Design(source="page", typed={**PAGE, **changes}, pair=pair)
    made = built(chosen)
    assert made.problems == {}
    names: dict[str, Any] = {}
    exec(script(chosen, made).partition("result =")[0], names)
    assert names["subject"] == made.subject
    subject, options = subject_from_dict(tomllib.loads(case_of(made)))
    assert options.revolutions == 2.0
    if pair:
        assert subject == made.subject
    else:  # a commented case has six digits of what is assumed
        assert subject.replace(bearing=made.bearing) == made.subject


def test_numbers_of_a_page_are_those_in_si() -> None:
    made = built(design())
    assert made.values["scene.axial_load"] == 2500.0
    assert "bore=0.04, outside=0.08, width=0.02475, C=74800.0" in script(design(), made)
    inches = design(page__bore="1.5748031496062992 in", page__C="16815.7 lbf")
    assert built(inches).base.pitch_diameter == pytest.approx(made.base.pitch_diameter, rel=1e-5)


def test_a_change_of_units_changes_no_quantity() -> None:
    chosen = design()
    before = built(chosen)
    fields = list(all_fields(chosen, before.base).values())
    for si, unit in (("m", "inch"), ("N", "lbf"), ("deg", "rad")):
        chosen.change_unit(si, unit, fields)
    assert chosen.typed["page.bore"].startswith("1.5748")
    assert built(chosen).base.roller.diameter == pytest.approx(before.base.roller.diameter, rel=1e-9)


@pytest.mark.parametrize(
    ("path", "text", "said"),
    [
        ("page.bore", "0.04", "50 mm is 0.05"),
        ("page.bore", "40 kN", "not in kN"),
        ("page.bore", "40,5", "with a point in place of the comma"),
        ("page.bore", "1e999", "must be"),
        ("page.bore", "9" * 400, "must be a number"),
        ("page.bore", "nan", "must be a number"),
        ("page.C", "74800", "for rollers that fit these dimensions"),
        ("bearing.cage.mass", "-1", "must be >="),
        ("bearing.n_rollers", "99", "overlap"),
        ("bearing.n_rollers", "12.5", "whole number"),
        ("scene.speed_rpm", "1e12", "must be from"),
        ("scene.axial_load", "0", "must be > 0"),
        ("lubricant.temperature_c", "900", "from -20 to 200"),
        ("run.revolutions", "0", "must be > 0"),
        ("run.revolutions", "1e12", "must end the run"),
        ("effects.starvation_factor", "7", "must be"),
    ],
)
def test_an_error_stands_at_the_field_that_it_names(path: str, text: str, said: str) -> None:
    problems = built(design(**{path.replace(".", "__"): text})).problems
    assert list(problems) == [path]
    assert said in problems[path]


@pytest.mark.parametrize(
    ("path", "text"), [("pair.end_play", "5"), ("pair.diameter", "-1"), ("scene.speed_rpm", "1e12")]
)
def test_errors_of_a_pair_stand_at_its_fields(path: str, text: str) -> None:
    assert path in built(design(True, **{path.replace(".", "__"): text})).problems


def test_what_was_kept_by_another_version_or_hand_is_read_or_left_out() -> None:
    assert Design.from_json("{").source == "30310"
    assert Design.from_json("[1]").source == "30310"
    assert Design.from_json('{"source": "page", "new": 1, "units": {"m": "parsec"}}').units == {}
    assert Design.from_json(design().to_json()) == design()


def test_every_unit_has_its_size() -> None:
    assert [read(text, "m", "mm") for text in ("24.75", "1 in", '2"', "3 m", "5 um")] == [
        0.02475,
        0.0254,
        0.0508,
        3.0,
        5e-6,
    ]
    assert read("180 deg", "rad", "rad") == pytest.approx(3.14159265358979)
