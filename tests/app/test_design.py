"""What is typed means what the Python that the page shows means; what is wrong stands at its field."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from trbdyn.extras.app.design import Design, all_fields, built
from trbdyn.extras.app.load_cases import cases_of, checked
from trbdyn.extras.app.outcome import case_of
from trbdyn.extras.app.program import script
from trbdyn.extras.app.units import read
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
        ("page.bore", "0.04", "0.04 mm: must be from 2 to 5000 mm"),
        ("page.bore", "40 kN", "not in kN"),
        ("page.bore", "40,5", "with a point in place of the comma"),
        ("page.bore", "1e999", "must be"),
        ("page.bore", "9" * 400, "must be a number"),
        ("page.bore", "nan", "must be a number"),
        ("page.C", "74800", "must be from 51.7 to 147 kN for rollers that fit these dimensions"),
        ("scene.misalignment_x", "1000", "1000 mrad: must be from -87.27 to 87.27 mrad"),
        ("page.roller_length", "70", "must be <= 25.49 mm"),
        ("fit.shaft", "m6", "must be given: a tolerance"),
        ("fit.over", "20, x", "temperatures"),
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
    path = "fit.housing" if path == "fit.shaft" else path  # what belongs to it is missing
    assert list(problems) == [path]
    assert said in problems[path]


@pytest.mark.parametrize(
    ("path", "text", "said"),
    [
        ("pair.end_play", "5", "5 mm: must be from -0.6 to 0.6 mm"),
        ("pair.diameter", "-1", "-1 mm: must be > 0 mm"),
        ("scene.speed_rpm", "1e12", "must be from"),
        ("pair.other", "99999", "not in the table"),
        ("gear.helix_angle_deg", "80", "must be from -60 to 60 deg"),
    ],
)
def test_errors_of_a_pair_stand_at_its_fields(path: str, text: str, said: str) -> None:
    chosen = design(True, **{path.replace(".", "__"): text})
    if path.startswith("gear."):
        chosen.acts = "gear"
        chosen.typed |= {"gear.torque": "100", "gear.pitch_diameter": "80"}
    assert said in built(chosen).problems[path]


def test_what_was_kept_by_another_version_or_hand_is_read_or_left_out() -> None:
    for text in ("{", "[1]", '{"source": [1]}', '{"case": 5, "source": "case"}', "[" * 100_000, '{"typed": {"page.bore": [1]}}',
                 '{"wants": 3}', '{"units": {"m": ["mm"]}}', '{"case": {"bearing": 5}, "source": "case"}', "null"):  # fmt: skip
        kept = Design.from_json(text)
        assert kept.source in ("named", "case")
        assert kept.source == "case" or set(kept.typed) <= {"run.revolutions"}
        assert built(kept).problems  # as no designation was typed, or the case is none
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


def test_a_pair_of_two_bearings_with_gear_fits_and_oil_is_the_program_that_is_shown() -> None:
    typed = {"named.designation": "HR32208J", "pair.other": "30207", "scene.speed_rpm": "1500", "gear.torque": "200",
             "gear.pitch_diameter": "80", "gear.helix_angle_deg": "15", "pair.spread": "120", "fit.shaft": "m6",
             "fit.housing": "N7",
             "fit.set": "before mounting", "fit.inner_c": "70", "fit.outer_c": "60", "lubricant.cleanliness": "15/12",
             "lubricant.filtered": "on", "page.Y0": "0.9", "run.revolutions": "1", "pair.end_play": "50 um"}  # fmt: skip
    chosen = Design(source="named", typed=typed, pair=True, acts="gear")
    made = built(chosen)
    assert made.problems == {}
    names: dict[str, Any] = {}
    exec(script(chosen, made).partition("result =")[0], names)
    assert names["subject"] == made.subject
    assert names["fits"].plays == made.fits.plays
    left, right = made.subject.bearings
    assert (left.bearing.ratings.Y0, left.lubricant.cleanliness, right.bearing.name) == (0.9, "15/12", "30207")
    assert made.subject.loads[0].force[2] == pytest.approx(2 * 200 / 0.08 * 0.2679492, rel=1e-6)  # Ft tan(beta)


@pytest.mark.parametrize(("column", "acts"), [("torque", "gear"), ("wheel_load", "wheel"), ("cornering", "wheel")])
def test_a_column_of_something_that_does_not_act_is_refused(column: str, acts: str) -> None:
    for pair, of in ((False, ""), (True, ""), (False, acts), (True, "wheel" if acts == "gear" else "gear")):
        chosen = design(pair=pair)
        chosen.acts, chosen.spectrum = of, f"share,{column}\n1,0.5"
        with pytest.raises(ValueError, match=f"{column}: must not be given here"):
            cases_of(chosen)


def test_a_spectrum_may_have_semicolons_and_decimal_commas() -> None:
    table = "name;share;speed;axial_load\nidle;80,5;800;1500,5\nfull;19,5;1500;9000"
    chosen = design()
    chosen.spectrum = table
    (idle, share, tables), (full, *_) = cases_of(chosen)
    assert (idle, share, full) == ("idle", 80.5, "full")
    assert tables["scene"]["axial_load"] == 1500.5
    chosen.change_unit("N", "kN", all_fields(chosen, built(chosen).base).values())
    chosen.spectrum = "share,axial_load\n1,1.5"
    assert cases_of(chosen)[0][2]["scene"]["axial_load"] == pytest.approx(1500.0)
    for wrong, said in (("share,colour\n1,2", "colour: must be one of the columns"), ("share\nx", "share must be a number"),
                        ("share,speed\n1", "must have a cell for each column"), ("share,speed\n1,1e12", "speed: 1e+12 rpm: must"),
                        ("share\n" + "1\n" * 500, "at most 200")):  # fmt: skip
        chosen.spectrum = wrong
        assert said in str(checked(chosen))
