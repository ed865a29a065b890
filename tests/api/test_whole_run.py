"""Extremes are those of the whole run, with their times; what changes in a run is said everywhere it is read."""

from __future__ import annotations

from pathlib import Path

import pytest

import trbdyn as trb
from trbdyn.reporting.verdict import verdict

LOAD = trb.History(times=(0.0, 0.0049, 0.005, 0.007, 0.0071, 0.06), values=(4930.0, 4930.0, 60e3, 60e3, 4930.0, 4930.0))


@pytest.fixture(scope="module")
def spike() -> trb.Result:
    """A spike of load in the first tenth of a run; averages are of its second half."""
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000.0, axial_load=LOAD, ring="follows")
    return trb.Simulation(scene, accuracy="fast").run(duration=0.06)


@pytest.fixture(scope="module")
def ramp() -> trb.Result:
    speed = trb.History(times=(0.0, 0.04), values=(0.0, 3000.0))
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=speed, axial_load=4930.0)
    return trb.Simulation(scene, accuracy="fast").run(duration=0.06)


def test_a_spike_of_load_is_in_summary_verdict_and_rating(spike: trb.Result) -> None:
    values = spike.summary()
    still = trb.cases.scene_30310(3000.0, 60e3)
    # the ring of a bearing under 60 kN; the run overshoots it a little
    pressure = trb.Simulation(still).contacts()["raceway_pressure"].max()
    assert pressure == pytest.approx(2.69e9, rel=0.02)
    assert values["inner_pressure_max"] == pytest.approx(pressure, rel=0.03)
    assert 0.0045 < values["inner_pressure_max_time"] < 0.0085
    assert values["inner_pressure_max"] == spike.peaks["inner_pressure_peak"].max()
    assert values["window_start"] > 0.02
    assert values["changing"] == "axial load 4930 to 60000 N"
    told = {head: (grade, text) for grade, head, text in verdict(spike, values)}
    assert told["Pressures"][0] == "care"
    assert told["A run that changes"][0] == "plain"
    static = trb.rating(still).static_safety
    assert trb.rating(spike).static_safety == pytest.approx(static, rel=1e-9)
    assert "4930 to 60000 N" in trb.plot.conditions(spike)


def test_a_ramp_from_rest_has_its_thinnest_film_at_its_start(ramp: trb.Result) -> None:
    values = ramp.summary()
    assert values["film_parameter_inner_min"] < 0.05
    assert values["film_parameter_inner_min_time"] < 1e-3
    assert values["film_parameter_inner_min"] <= ramp["inner_film_parameter"].min() * 1.2
    assert values["changing"] == "speed 0 to 3000 rpm"
    assert trb.plot.conditions(ramp).startswith("30310: 0 to 3000 rpm")
    assert values["pocket_force_peak"] == ramp.peaks["pocket_force_peak"].max()


@pytest.mark.usefixtures("drawn_only")
def test_report_and_summary_have_the_same_numbers(spike: trb.Result, tmp_path: Path) -> None:
    text = trb.report(spike, tmp_path / "spike.html", pictures=[]).read_text(encoding="utf-8")
    values = spike.summary()
    assert "A run that changes" in text
    assert f"{1e-9 * values['inner_pressure_max']:.3g} GPa" in text
    assert "4930 to 60000 N" in text


def test_a_constant_run_changes_nothing() -> None:
    result = trb.Simulation(trb.cases.scene_30310(), accuracy="fast").run(duration=0.01)
    assert "changing" not in result.summary()
