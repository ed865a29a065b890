"""The report: what it says agrees with the run, in one file that needs nothing else."""

from __future__ import annotations

import html
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.base.shown import field_texts
from trbdyn.cli import main
from trbdyn.plot import PICTURES
from trbdyn.reporting import converter
from trbdyn.reporting.captions import CAPTIONS
from trbdyn.reporting.front import front
from trbdyn.reporting.inputs import rows
from trbdyn.reporting.page import page
from trbdyn.reporting.verdict import verdict
from trbdyn.results.numbers import TABLE
from trbdyn.run.check import Check
from trbdyn.run.judged import Checked


@pytest.fixture(scope="module")
def run_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "run.h5"
    scene = trb.cases.scene_30310(3000.0, 4930.0, effects=trb.Effects.paper(), start=trb.Start.whirl(0.9))
    trb.Simulation(scene).run(revolutions=3, output=path)
    return path


@pytest.fixture(scope="module")
def result(run_file: Path) -> trb.Result:
    return trb.load(run_file)


@pytest.fixture(scope="module")
def usual() -> trb.Result:
    """A run with the default effects, for which biases were measured."""
    return trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))).run(revolutions=1)


@pytest.fixture(scope="module")
def text(result: trb.Result, tmp_path_factory: pytest.TempPathFactory) -> str:
    return trb.report(result, tmp_path_factory.mktemp("r") / "r.html").read_text(encoding="utf-8")


def cells(text: str, words: str) -> list[str]:
    row = re.search(rf"<tr[^>]*><td[^>]*>{re.escape(words)}</td>(.*?)</tr>", text)
    assert row is not None, words
    return re.findall(r"<td[^>]*>(.*?)</td>", row[1])


def test_numbers_units_and_meanings(text: str, result: trb.Result) -> None:
    values = result.summary()
    for key in ("torque", "outer_load_mean", "film_parameter_inner", "pocket_force_peak", "power_loss"):
        words, unit = TABLE[key].words, TABLE[key].unit
        number, shown_unit, meaning = cells(text.partition("<summary>All numbers")[2], words)
        assert float(number.split(" ±")[0]) == pytest.approx(values[key], rel=1e-3)
        assert shown_unit == unit
        assert len(meaning) > 20
    assert f"{values['torque']:.3g} N m of friction" in text
    assert f"{values['pocket_force_peak']:.3g} N" in text


def test_every_entry_of_the_summary_and_every_picture_has_its_sentence() -> None:
    assert all(quantity.meaning.endswith(".") for quantity in TABLE.values())
    assert set(PICTURES) <= set(CAPTIONS)


def test_all_pictures_and_drawings_are_inside(text: str) -> None:
    of_free_rings = [name for name, (_, groups) in PICTURES.items() if {"ring", "housing"} & set(groups)]
    assert text.count("<img ") == len(PICTURES) - len(of_free_rings) + 2
    assert text.count("src='data:image/png;base64,") == text.count("<img ")
    assert not re.search(r"(src|href)=['\"]https?:", text)


def test_inputs_are_listed_with_their_units_and_the_assumed_ones_marked(text: str, result: trb.Result) -> None:
    listed = {row.path: row for row in rows(result.scene)}
    assert (listed["bearing.roller.diameter"].value, listed["bearing.roller.diameter"].unit) == ("0.014", "m")
    assert listed["bearing.roller.diameter"].mark == ""
    assert listed["bearing.roller.sphere_ratio"].mark == "assumed"
    assert cells(text, "bearing.roller.sphere_ratio")[2] == "assumed"
    changed = result.scene.bearing.roller.replace(sphere_ratio=0.85)
    scene = result.scene.replace(bearing=result.scene.bearing.replace(roller=changed))
    assert {row.path: row for row in rows(scene)}["bearing.roller.sphere_ratio"].mark == ""
    assert listed["speed_rpm"].unit == "rpm"
    assert field_texts(trb.Scene)["axial_load"].startswith("Axial load Fa (N)")


def test_the_verdict_follows_the_run(result: trb.Result) -> None:
    values = result.summary()

    def said(**changes: object) -> dict[str, str]:
        return {head: grade for grade, head, _ in verdict(result, values | changes)}

    settled = {"settled": True, "settling": "settled"}
    assert said(cage_motion="circling", **settled)["The cage whirls"] == "care"
    assert said(cage_motion="stable", **settled)["The cage does not whirl"] == "good"
    assert said(cage_motion="rocking", pocket_force_peak=1.0, **settled)["The cage hangs and rocks"] == "good"
    assert said(cage_motion="unstable", pocket_force_peak=1e3, **settled)["The cage moves without order"] == "bad"
    assert said(energy_closure=9e-4)["The energy adds up"] == "good"
    assert said(energy_closure=2e-3)["The energy adds up, not closely"] == "care"
    assert said(energy_closure=2e-2)["The energy does not add up"] == "bad"
    unlike = verdict(result, values | {"torque_outer": 1.8, "torque_note": "the film's pressure force is off"})
    assert (
        "outer ring carries 1.8 N m: the film's pressure force is off." in dict(line[1:] for line in unlike)["Torque"]
    )
    long = {"window_start": 0.0, "window_end": 1.0}
    assert said(film_parameter_rib=0.5, **long)["Films are too thin"] == "bad"
    assert said(film_parameter_rib=1.3, **long)["Films carry, with some contact"] == "care"
    assert said(inner_pressure_max=5e9)["Pressures"] == "bad"
    assert said(pocket_force_peak=0.0, **settled)["No roller touched the cage"] == "good"
    assert said(settled=False)["Too short to tell how the cage moves in the long run"] == "care"
    drifts = said(settled=False, settling="drifting", settling_reason="it drifts")
    assert drifts["The cage's motion still drifts"] == "care"
    changing = said(changing="speed 0 to 3000 rpm", film_parameter_inner_min=0.01, **long)
    assert changing["A run that changes"] == "plain"
    assert changing["Films are thin for a while"] == "care"


def test_what_has_not_settled_is_not_judged(result: trb.Result) -> None:
    """Three turns of the shaft: no sentence on the cage or on films has a grade, and it is said how long it takes."""
    values = result.summary()
    told = {head: (grade, text) for grade, head, text in verdict(result, values)}
    grade, text = told["The cage's motion cannot be told yet"]
    assert grade == "plain"
    assert f"A run of at least {values['settling_needed']:.0f} s" in text
    longer = {head: text for _, head, text in verdict(result, values | {"settling_needed_to": 99.0})}
    assert f"A run of {values['settling_needed']:.0f} to 99 s" in longer["The cage's motion cannot be told yet"]
    assert "turns of the shaft" in text
    assert told["Hits on the cage so far"][0] == "plain"
    assert told["Films: cannot be told yet"][0] == "plain"
    assert told["Pressures: cannot be told yet"][0] == "plain"
    assert "turns of the shaft" in told["Too short to tell how the cage moves in the long run"][1]
    for kind in ("stable", "rocking", "circling", "unstable"):
        told = {head: (grade, text) for grade, head, text in verdict(result, values | {"cage_motion": kind})}
        grade, text = told["The cage's motion cannot be told yet"]
        assert grade == "plain"
        assert "So far: " in text


def test_sentences_on_the_cage_do_not_contradict_each_other(result: trb.Result) -> None:
    """Motion and hits go by one answer to how hard the cage is hit."""
    values = result.summary() | {"settled": True, "settling": "settled", "outer_load_mean": 1000.0}
    for peak, soft in ((11.0, True), (400.0, False)):
        told = {
            head: (grade, text)
            for grade, head, text in verdict(result, values | {"pocket_force_peak": peak, "cage_motion": "unstable"})
        }
        grade, text = told["The cage moves without order"]
        assert (told["Hits on the cage"][0] == "good") == soft
        assert ("thrown from pocket to pocket" in text) == (not soft)
        assert grade == ("care" if soft else "bad")
        rocking = verdict(result, values | {"pocket_force_peak": peak, "cage_motion": "rocking"})
        assert {head: grade for grade, head, _ in rocking}["The cage hangs and rocks"] == ("good" if soft else "plain")


def test_films_have_one_limit_in_sentences_and_pictures(result: trb.Result) -> None:
    """Both take that of the scene's friction."""
    values = result.summary() | {"window_start": 0.0, "window_end": 1.0, "film_parameter_inner": 2.0}
    heads = {head: text for _, head, text in verdict(result, values)}
    assert "From 1.5 on" in heads["Films keep the surfaces apart"]
    axes = trb.plot.film_parameter(result)
    marked = [
        float(line.get_ydata()[0])
        for line in axes.lines
        if len(set(line.get_ydata())) == 1 and len(line.get_ydata()) == 2
    ]
    assert result.scene.effects.friction.lambda_full in marked
    assert "above 3" not in " ".join([*(quantity.meaning for quantity in TABLE.values()), *CAPTIONS.values()])


@pytest.mark.usefixtures("drawn_only")
def test_what_the_check_of_the_run_found_stands_beside_each_number(result: trb.Result, tmp_path: Path) -> None:
    checked = [
        Check(
            {"torque": Checked(-0.2, 0.01, 0.001, "biased", 4)}, 1, 1.0, 0.1, "How it was done.", {"torque": "torque"}
        )
    ]
    text = page([result], ["first"], "", [], (), checked)
    assert "By the check of the run: 19 to 21 % too low by the tolerances of the run." in text
    assert "Not known to be right within 3 %: torque: 19 to 21 % too low" in text
    assert "How it was done." in text
    measured = trb.report(result, tmp_path / "r.html", pictures=[], check_budget_s=2.0).read_text(encoding="utf-8")
    assert "By the check of the run: " in measured
    without = trb.report(result, tmp_path / "w.html", pictures=[], check_budget_s=0).read_text(encoding="utf-8")
    assert "check of the run" not in without


def test_the_verdict_judges_the_life_by_the_shortest(result: trb.Result) -> None:
    """A basic life of 5628 h is not hidden behind good pressures and a long reference life."""
    values = result.summary()

    def said(**lives: float) -> tuple[str, str]:
        return {head: (grade, text) for grade, head, text in verdict(result, values | lives)}["Life"]

    for name in ("basic_life_hours", "modified_life_hours", "reference_life_hours", "modified_reference_life_hours"):
        values[name] = 3e7
    grade, text = said()
    assert grade == "good"
    assert "Lnmrh, which counts the most of what acts, is >1e6 h" in text
    grade, text = said(basic_life_hours=5628.0)
    assert grade == "care"
    assert "shortest, L10h" in text
    assert "5628 h" in text
    assert said(modified_reference_life_hours=900.0)[0] == "bad"
    told = {head: grade for grade, head, _ in verdict(result, values | {"static_safety": 0.8})}
    assert told["Static safety"] == "bad"


def test_a_verdict_has_words_and_no_names_of_fields(text: str) -> None:
    """Sentences speak of films, loads and times of the run; a name with dots or underscores belongs into the tables."""
    judged = re.search(r"<h2>Verdict.*?(?=<h2>Numbers)", text, re.DOTALL)
    assert judged is not None
    plain = html.unescape(re.sub(r"<[^>]*>", " ", judged[0]))
    plain = re.sub(r"trb\.\w+|accuracy='\w+'", "", plain)  # functions to call are no fields
    assert not re.findall(r"\b[a-z]+_[a-z_]+\b|\b[a-z]{3,}\.[a-z]{3,}", plain)
    assert not re.search(r"avx|instruction set|e-0[5-9] s", plain)
    assert not re.search(r"\d\d:\d\d:\d\d", text)


def test_frequencies_and_ratings_are_those_of_the_package(text: str, result: trb.Result) -> None:
    """Each number of the sections stands in the summary, the sheet or the frequencies, too."""
    values = result.summary()
    found = trb.frequencies(result.scene.bearing, speed_rpm=values["speed_rpm"])
    for name in ("bpfo", "bpfi", "bsf", "ftf"):
        row = re.search(rf"<td class='q'>{name.upper()}, [^<]*</td><td[^>]*>([^<]*)</td><td[^>]*>([^<]*)<", text)
        assert row is not None
        assert float(row[1]) == pytest.approx(getattr(found, name), rel=1e-4)
        assert float(row[2]) == pytest.approx(found.orders[name], rel=1e-4)
    sheet = trb.rating(result.scene)
    assert cells(text, "basic rating life L10h")[0] == next(row for row in sheet.rows if row.name == "life_hours").shown
    assert values["basic_life_hours"] == sheet.life_hours


@pytest.mark.usefixtures("drawn_only")
def test_a_failed_or_partial_run_still_gets_a_report(tmp_path: Path) -> None:
    scene = trb.cases.scene_30310(1000.0, 3000.0, effects=trb.Effects.paper().replace(bodies="rollers"))
    short = trb.Simulation(scene).run(revolutions=0.2, save_groups=("rollers", "torque"))
    text = trb.report(short, tmp_path / "r.html").read_text(encoding="utf-8")
    assert "Torque" in text
    assert "The run is short" in text
    assert "The cage whirls" not in text


@pytest.mark.usefixtures("drawn_only")
def test_two_runs_side_by_side(result: trb.Result, tmp_path: Path) -> None:
    other = trb.Simulation(result.scene.replace(axial_load=3080.0)).run(revolutions=2)
    text = trb.report(
        result, tmp_path / "r.html", other=other, names=["as <built>", "lighter"], pictures=["cage_locus", "load_zone"]
    ).read_text(encoding="utf-8")
    assert cells(text, "axial_load")[:2] == ["4930", "3080"]
    assert "as &lt;built&gt;" in text
    assert "<built>" not in text
    assert text.count("<img ") == 2 * 2 + 2  # both bearings are equal: drawn once
    assert text.count("<h2>Verdict</h2>") == 1
    assert "lighter against as &lt;built&gt;: " in text
    numbers = cells(text, "friction torque of the shaft")
    shown = [float(number.split(" ±")[0]) for number in numbers[:2]]
    change = float(numbers[2].replace("\u2212", "-").removesuffix(" %"))
    assert change == pytest.approx(100.0 * (shown[1] / shown[0] - 1.0), abs=0.1)
    one, other_torque = (float(text.split(" ±")[0]) for text in numbers[:2])
    assert one > other_torque


def test_bad_arguments(result: trb.Result, tmp_path: Path) -> None:
    with pytest.raises(trb.InputError, match="pictures = 'nothing'"):
        trb.report(result, tmp_path / "r.html", pictures=["nothing"])
    with pytest.raises(trb.InputError, match="must be two names"):
        trb.report(result, tmp_path / "r.html", names=["one"])
    with pytest.raises(trb.FileError, match="cannot be written"):
        trb.report(result, tmp_path / "none" / "r.html", pictures=["cage_locus"])


@pytest.mark.usefixtures("drawn_only")
def test_the_command(run_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", str(run_file), "--title", "Mine & yours"]) == 0
    path = Path(capsys.readouterr().out.strip())
    assert path == run_file.with_name("run_report.html")
    assert "<h1>Mine &amp; yours</h1>" in path.read_text(encoding="utf-8")
    assert main(["report", str(run_file.with_name("none.h5"))]) == 2


@pytest.mark.skipif(converter() is None, reason="no Chromium is installed: apt-get install chromium")
def test_pdf(result: trb.Result, tmp_path: Path) -> None:
    trb.report(result, tmp_path / "r.html", pictures=["cage_locus"], pdf=True)
    data = (tmp_path / "r.pdf").read_bytes()
    assert data.startswith(b"%PDF-")
    assert np.log10(len(data)) > 4


@pytest.mark.usefixtures("drawn_only")
def test_further_tables(result: trb.Result, tmp_path: Path) -> None:
    seat = trb.Mounting(bore=0.05, outside=0.11, width=0.02925, shaft="m6", housing="N7")
    fits = trb.fit(result.scene, seat)
    text = trb.report(result, tmp_path / "r.html", pictures=[], tables=[fits]).read_text(encoding="utf-8")
    assert cells(text, "shaft m6")[0] == "9.0 to 37.0"
    with pytest.raises(trb.InputError, match=r"tables\[0\]"):
        trb.report(result, tmp_path / "r.html", tables=["fits"], overwrite=True)


@pytest.mark.usefixtures("drawn_only")
def test_a_ramp_from_rest_has_its_torque_compared_at_speed(tmp_path: Path) -> None:
    """At rest nothing is lost, and torques at the start have no ratio: they are compared where the speed is largest."""
    from trbdyn.run.torque_laws import straight_rollers, torque_laws

    bearing = trb.Bearing.from_catalogue(bore=0.050, outside=0.110, width=0.02925, C=125e3, e=0.35)
    ramp = trb.Scene(bearing, speed_rpm=trb.History.ramp(0.0, 0.02, 0.0, 1000.0), axial_load=3000.0)
    steady = ramp.replace(speed_rpm=1000.0)
    assert straight_rollers(ramp) == pytest.approx(straight_rollers(steady))
    assert straight_rollers(ramp.replace(speed_rpm=0.0))[0] is None
    assert torque_laws(ramp).factors == pytest.approx(torque_laws(steady).factors)
    page = trb.report(trb.Simulation(ramp).run(duration=5e-4), tmp_path / "ramp.html", pictures=[])
    text = page.read_text(encoding="utf-8")
    assert re.search(
        r"With straight rollers the torque would be \d\.\d+ and the largest pressure would be 0\.\d+", text
    )
    assert not re.search(r"\bnan\b", text)


def test_a_sheet_of_a_shaft_tells_its_loads_and_what_bearings_share_once() -> None:
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    push = trb.ShaftLoad(position=0.02, force=(3000.0, -800.0, 900.0), offset=(0.0, 0.04), moment=(5.0, 0.0))
    pair = trb.Assembly.pair(
        trb.Bearing.named("32208"),
        "back to back",
        spread=0.12,
        end_play=-1e-5,
        shaft=shaft,
        speed_rpm=1500,
        loads=(push,),
    )
    result = trb.Simulation(pair, accuracy="fast").run(duration=1e-5)
    parts = list(result.by_name.values())
    judged: list[Any] = [[("good", "Life", "")], [("care", "Life", "")]]
    listed = [rows(one.scene) for one in parts]
    text = front(parts, ["left", "right"], listed, [{"energy_closure": 1e-6}, {}], ["", ""], judged, pair)
    for said in (
        "3000, -800, 900 N",
        "at 20 mm, off the axis by 0, 40 mm, with the moments 5, 0 N m about x, y",
        "1500 rpm",
    ):
        assert said in text
    assert text.count("as left") == 2  # estimated and assumed
    assert text.count("cage.play_radial") == 1
    assert "10000, kept" in text  # a margin without a power of ten
    assert text.index("signature") > text.index("right: inputs")
