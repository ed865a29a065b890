"""Three catalogue bearings that no other test has, through everything that an engineer asks: what is read agrees with formulas
and with equilibria that the run does not know, and each number of a report is that of the summary.
"""

from __future__ import annotations

import html
import re
from pathlib import Path

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.results.numbers import TABLE

pytestmark = pytest.mark.slow

PAGES = {  # boundary dimensions of ISO 355 (m), C and C0 (N), e and Y about as makers' catalogues have them
    "32928": {"bore": 0.140, "outside": 0.190, "width": 0.032, "C": 205e3, "C0": 390e3, "e": 0.36, "Y": 1.7},
    "30228": {"bore": 0.140, "outside": 0.250, "width": 0.04575, "C": 418e3, "C0": 570e3, "e": 0.43, "Y": 1.4},
    "33118": {"bore": 0.090, "outside": 0.150, "width": 0.045, "C": 251e3, "C0": 390e3, "e": 0.40, "Y": 1.5},
}
SPEED = 1000.0
SCALES = {"GPa": 1e9, "MPa": 1e6, "mm": 1e-3, "µm": 1e-6}


@pytest.fixture(scope="module", params=PAGES)
def scene(request: pytest.FixtureRequest) -> trb.Scene:
    page = PAGES[request.param]
    bearing = trb.Bearing.from_catalogue(**page, name=request.param)
    return trb.Scene(bearing, speed_rpm=SPEED, axial_load=0.06 * page["C"], radial_load=0.08 * page["C"])


@pytest.fixture(scope="module")
def result(scene: trb.Scene) -> trb.Result:
    return trb.Simulation(scene, accuracy="fast").run(revolutions=1.0)


def short(scene: trb.Scene, **changes: object) -> trb.Result:
    return trb.Simulation(scene.replace(**changes), accuracy="fast").run(duration=0.02)


def test_each_number_of_the_report_is_that_of_the_summary(result: trb.Result, tmp_path: Path) -> None:
    text = trb.report(result, tmp_path / "r.html", pictures=[]).read_text(encoding="utf-8")
    values = result.summary()
    table = text.partition("<summary>All numbers")[2].partition("</table>")[0]
    shown = re.findall(r"<td class='q'>(.*?)</td><td[^>]*>(.*?)</td><td class='u'>(.*?)</td>", table)
    left = [(html.unescape(words), number.split(" ±")[0], unit) for words, number, unit in shown]
    compared = 0
    for name, row in TABLE.items():
        value = values.get(name)
        if not isinstance(value, float):
            continue
        for k, (said, number, unit) in enumerate(left):
            if said == row.words.strip():
                if not number.startswith("&gt;"):
                    assert float(number) * SCALES.get(unit, 1.0) == pytest.approx(value, rel=1e-3), name
                compared += 1
                del left[k]
                break
        else:
            raise AssertionError(f"{name} is not in the report")
    assert compared > 30


def test_loads_torque_and_speeds_of_the_run(scene: trb.Scene, result: trb.Result) -> None:
    values, bearing = result.summary(), scene.bearing
    slope = np.radians(bearing.cup_half_angle_deg)
    carried = bearing.n_rollers * values["outer_load_mean"] * np.sin(slope)
    assert carried == pytest.approx(scene.axial_load, rel=0.01)
    omega = SPEED * np.pi / 30.0
    assert values["torque"] * omega == pytest.approx(values["power_loss"], rel=0.03)
    assert sum(values["torque_by_loss"].values()) == pytest.approx(values["torque"], rel=0.03)
    assert values["energy_closure"] < 1e-2
    found = trb.frequencies(bearing, speed_rpm=SPEED)
    assert found.bpfo + found.bpfi == pytest.approx(bearing.n_rollers * SPEED / 60.0)
    assert values["cage_speed_ratio"] == pytest.approx(found.ftf / (SPEED / 60.0), rel=0.01)
    still = trb.Simulation(scene).contacts()["raceway_pressure"].max()
    assert max(values["inner_pressure_max"], values["outer_pressure_max"]) == pytest.approx(still, rel=0.05)


def test_ratings_by_hand(scene: trb.Scene, result: trb.Result) -> None:
    page = PAGES[scene.bearing.name]
    axial, radial = scene.axial_load, scene.radial_load
    load = 0.4 * radial + page["Y"] * axial if axial > page["e"] * radial else radial
    sheet, values = trb.rating(scene), result.summary()
    hours = (page["C"] / load) ** (10.0 / 3.0) * 1e6 / (60.0 * SPEED)
    static = page["C0"] / max(0.5 * radial + 0.55 * page["Y"] * axial, radial)
    assert sheet.life_hours == values["basic_life_hours"] == pytest.approx(hours, rel=1e-9)
    assert sheet.static_safety == values["static_safety"] == pytest.approx(static, rel=1e-9)
    assert trb.rating(result).reference_load == pytest.approx(sheet.reference_load, rel=0.02)
    diameter = 1e3 * scene.bearing.pitch_diameter
    assert sheet.viscosity_ratio == pytest.approx(sheet.viscosity / (4500.0 * SPEED**-0.5 * diameter**-0.5), rel=1e-6)


def test_stiffness_is_the_slope_of_equilibria(scene: trb.Scene) -> None:
    stiffness = trb.stiffness(scene).matrix
    assert np.linalg.eigvalsh(0.5 * (stiffness + stiffness.T)).min() > 0.0
    step = 0.002 * scene.axial_load
    places = [
        np.asarray(trb.Simulation(scene.replace(axial_load=scene.axial_load + sign * step)).equilibrium.displacement)
        for sign in (-1.0, 1.0)
    ]
    # forces of the difference of both places: axial as it was changed, none across
    forces = stiffness[:3, :3] @ (places[1] - places[0])[:3]
    assert abs(forces[2]) == pytest.approx(2.0 * step, rel=0.02)
    assert np.abs(forces[:2]).max() < 0.05 * step


def test_a_pair_carries_its_shaft(scene: trb.Scene) -> None:
    bearing, force = scene.bearing, np.array([0.0, 0.05 * PAGES[scene.bearing.name]["C"], 3e3])
    pair = trb.Assembly.pair(
        bearing,
        "back to back",
        spread=0.3,
        end_play=-10e-6,
        shaft=trb.Shaft.hollow_cylinder(mass=20.0, outer_diameter=PAGES[bearing.name]["bore"], length=0.5),
        speed_rpm=SPEED,
        loads=[trb.ShaftLoad(position=0.05, force=tuple(force))],
    )
    found = trb.equilibrium(pair)
    axial = [one.axial_load for one in found.bearings]
    assert abs(axial[0] - axial[1]) == pytest.approx(force[2], rel=0.01)
    radial = [one.radial_load for one in found.bearings]
    weight = 20.0 * 9.80665
    assert abs(sum(radial) - force[1]) < 1.2 * weight + 0.01 * force[1]
    lives = trb.rating(found)
    own = [one.life_hours for one in lives.bearings.values()]
    assert lives.life_hours == pytest.approx(sum(life ** (-27 / 20) for life in own) ** (-20 / 27), rel=1e-9)


def test_a_ramp_says_that_it_is_one(scene: trb.Scene) -> None:
    speed = trb.History(times=(0.0, 0.015), values=(0.0, SPEED))
    values = short(scene, speed_rpm=speed, ring="follows").summary()
    assert values["changing"] == f"speed 0 to {SPEED:g} rpm"
    assert values["film_parameter_inner_min"] < 0.3 * values["film_parameter_inner"]
    assert "basic_life_hours" not in values
    assert "static_safety" not in values


def test_a_spike_of_load_is_a_peak(scene: trb.Scene) -> None:
    low, high = scene.axial_load, 6.0 * scene.axial_load
    load = trb.History(times=(0.0, 0.003, 0.004, 0.006, 0.007), values=(low, low, high, high, low))
    result = short(scene, axial_load=load, ring="follows")
    values = result.summary()
    heavy = scene.replace(axial_load=high)
    still = trb.Simulation(heavy).contacts()["raceway_pressure"].max()
    assert max(values["inner_pressure_max"], values["outer_pressure_max"]) == pytest.approx(still, rel=0.08)
    assert 0.003 < values["inner_pressure_max_time"] < 0.008
    assert "static_safety" not in values
    assert trb.rating(result).static_safety == pytest.approx(trb.rating(heavy).static_safety, rel=1e-6)


def test_cold_oil_is_thicker(scene: trb.Scene, result: trb.Result) -> None:
    oil = trb.lubricants.OILS["vg100"]
    warm, cold = (trb.rating(scene.replace(lubricant=oil(at))) for at in (60.0, 10.0))
    assert cold.viscosity / warm.viscosity == pytest.approx(cold.viscosity_ratio / warm.viscosity_ratio)
    assert cold.viscosity > 5.0 * warm.viscosity
    assert cold.life_hours == warm.life_hours
    films = short(scene, lubricant=oil(10.0)).summary()
    assert films["film_parameter_inner"] > 2.0 * result.summary()["film_parameter_inner"]
    assert films["torque"] > result.summary()["torque"]
