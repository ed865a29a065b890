"""Load spectra: damages of cases add up, tables and time series."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import InputError, LoadCase, Scene, Spectrum
from trbdyn.standards import iso281, lamina
from trbdyn.standards.loading import at_equilibrium

BEARING = trb.Bearing.named("32208")
SCENE = Scene(BEARING, speed_rpm=1000.0, axial_load=3000.0, radial_load=4000.0, lubricant="vg68")
LIVES = ("life_hours", "modified_life_hours", "reference_life_hours", "modified_reference_life_hours")
CASES: list[dict[str, Any]] = [
    {"name": "idle", "share": 70, "speed_rpm": 800.0, "axial_load": 1500.0, "radial_load": 2000.0},
    {"name": "pull", "share": 25, "speed_rpm": 1500.0, "axial_load": 5000.0, "radial_load": 7000.0},
    {"name": "start", "share": 5, "speed_rpm": 300.0, "axial_load": 9000.0, "radial_load": 12000.0},
]


def case(name: str, share: float, **changes: Any) -> LoadCase:
    return LoadCase(name, share, SCENE.replace(**changes))


@pytest.mark.parametrize("cases", [[case("all", 3.0)], [case("a", 1.0), case("b", 2.0)]])
def test_a_steady_load_has_its_own_life(cases: list[LoadCase]) -> None:
    """However it is cut into cases."""
    found, alone = trb.rating(Spectrum(cases)), trb.rating(SCENE)
    for life in LIVES:
        assert getattr(found, life) == pytest.approx(getattr(alone, life), rel=1e-12), life
    assert found.equivalent_load == pytest.approx(alone.equivalent_load)


def test_a_machine_at_rest_does_not_tire() -> None:
    """It stands for half of the time: all lives are twice as long."""
    found, alone = trb.rating(Spectrum([case("runs", 1.0), case("rests", 1.0, speed_rpm=0.0)])), trb.rating(SCENE)
    for life in LIVES:
        assert getattr(found, life) == pytest.approx(2.0 * getattr(alone, life), rel=1e-12), life
    assert found.damage == {"runs": 1.0, "rests": 0.0}


def test_damages_by_hand() -> None:
    """P = 0.4 Fr + 1.6 Fa, (C/P)^(10/3) and Miner's sum over revolutions."""
    found = trb.rating(trb.spectrum(SCENE, CASES))
    parts = {}
    for row in CASES:
        load = 0.4 * row["radial_load"] + 1.6 * row["axial_load"]
        parts[row["name"]] = row["share"] / 100.0 * 60e-6 * row["speed_rpm"] * (load / 77.7e3) ** (10.0 / 3.0)
    total = sum(parts.values())
    assert found.life_hours == pytest.approx(1.0 / total, rel=1e-9)
    assert found.damage == pytest.approx({name: part / total for name, part in parts.items()})
    assert found.worst == max(parts, key=lambda name: parts[name]) == "pull"
    revolutions = sum(row["share"] / 100.0 * row["speed_rpm"] for row in CASES)
    assert found.speed_rpm == pytest.approx(revolutions)
    mean = (total / (60e-6 * revolutions)) ** 0.3 * 77.7e3
    assert found.equivalent_load == pytest.approx(mean)
    each = [trb.rating(one.subject).modified_life_hours for one in trb.spectrum(SCENE, CASES).cases]
    expected = 1.0 / sum(row["share"] / 100.0 / life for row, life in zip(CASES, each, strict=True))
    assert found.modified_life_hours == pytest.approx(expected)
    assert "pull makes" in str(found)


@pytest.mark.parametrize("hub", [False, True])
def test_reference_lives_add_up_at_each_place(hub: bool) -> None:
    """Lamina by lamina and place by place, in plain loops: fourth powers over the cases, and with a life factor of each."""
    swap = {"speed_rpm": "outer_speed_rpm"} if hub else {}
    rows = [{swap.get(key, key): value for key, value in row.items()} for row in CASES]
    spectrum = trb.spectrum(SCENE.replace(speed_rpm=0.0, outer_speed_rpm=1.0) if hub else SCENE, rows)
    found = trb.rating(spectrum, cleanliness="17/14")
    angle, count = math.radians(BEARING.cup_half_angle_deg), BEARING.n_rollers
    ratings = lamina.contact_ratings(
        77.7e3,
        n_rollers=count,
        roller_diameter=BEARING.roller.diameter,
        pitch_diameter=BEARING.pitch_diameter,
        angle=angle,
    )
    loads = [at_equilibrium(one.subject).lamina_loads for one in spectrum.cases]
    slices = loads[0].shape[2]
    each = ratings * slices ** (-7.0 / 9.0)
    edge = lamina.stress_concentration(slices)
    turns = np.array([row["share"] * row["speed_rpm"] for row in CASES])
    mean_speed = turns.sum() / 100.0
    exponents = (4.0, 4.5) if hub else (4.5, 4.0)
    plain = modified = 0.0
    for k in range(slices):
        factors = []
        for row, load in zip(CASES, loads, strict=True):
            q = [edge[k] * np.mean(load[ring, :, k] ** power) ** (1.0 / power) for ring, power in enumerate(exponents)]
            weight = (1.038 * each[1] / each[0]) ** 4.5
            equivalent = 0.323 * count * slices * math.cos(angle)
            equivalent *= ((q[1] ** 4.5 + weight * q[0] ** 4.5) / (1.0 + weight)) ** (2.0 / 9.0)
            kappa = 1e6 * SCENE.lubricant.kinematic_viscosity
            kappa /= iso281.reference_viscosity(row["speed_rpm"], BEARING.pitch_diameter)
            clean = iso281.contamination_factor(
                "17/14", filtered=False, viscosity_ratio=min(kappa, 4.0), pitch_diameter=BEARING.pitch_diameter
            )
            limit = iso281.fatigue_limit(90.8e3, BEARING.pitch_diameter)
            factors.append(iso281.life_factor(kappa, clean * limit / equivalent) if equivalent else 50.0)
        for ring, power in enumerate(exponents):
            for by in ("plain", "modified"):
                places = []
                for place in range(count):
                    fourth = sum(
                        turn * (edge[k] * load[ring, place, k] / each[ring]) ** 4 / (1.0 if by == "plain" else factor)
                        for turn, load, factor in zip(turns, loads, factors, strict=True)
                    )
                    places.append((fourth / turns.sum()) ** 0.25)
                part = np.mean(np.array(places) ** power) ** (4.5 / power)
                plain, modified = (plain + part, modified) if by == "plain" else (plain, modified + part)
    for life, damage in (("reference_life_hours", plain), ("modified_reference_life_hours", modified)):
        assert getattr(found, life) == pytest.approx(damage ** (-8.0 / 9.0) / (60e-6 * mean_speed), rel=1e-9), life


def test_a_table_of_a_file(tmp_path: Path) -> None:
    table = tmp_path / "cases.csv"
    table.write_text(
        "# hours of a year\nname,share,speed_rpm,axial_load,radial_load\nidle,70,800,1500,2000\npull,25,1500,5000,7000\n"
        "start,5,300,9000,12000\n",
        encoding="utf-8",
    )
    assert trb.spectrum(SCENE, table) == trb.spectrum(SCENE, CASES)
    table.write_text("name,share,axial_load\nidle,70,\n", encoding="utf-8")
    assert trb.spectrum(SCENE, table).cases[0].subject == SCENE


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([{"share": 1, "axial_lod": 1.0}], r"cases\[0\].*axial_lod"),
        ([{"share": 1, "axial_load": -1.0}], r"cases\[0\].*axial_load"),
        ([{"axial_load": 1.0}], r"share.*must be given"),
        ([{"share": -1.0}], r"share = -1.0 : must be >= 0"),
        ([{"share": 0.0}], r"a share > 0"),
        ([], r"a share > 0"),
        ([{"share": 1, "name": "a"}, {"share": 1, "name": "a"}], r"must differ"),
        ([{"share": "much"}], r"share = 'much' : must be a number"),
    ],
)
def test_tables_that_are_refused(rows: list[dict[str, Any]], said: str) -> None:
    with pytest.raises(InputError, match=said):
        trb.spectrum(SCENE, rows)


def test_cases_of_other_bearings_are_refused() -> None:
    other = SCENE.replace(bearing=trb.Bearing.named("32209"))
    with pytest.raises(InputError, match="must have the bearing of the other cases"):
        trb.rating(Spectrum([case("a", 1.0), LoadCase("b", 1.0, other)]))


def test_a_spectrum_of_a_shaft() -> None:
    """Each bearing has its life over the cases, and the whole that of independent failures."""
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    push = trb.ShaftLoad(position=0.02, force=(0.0, -4000.0, 1000.0))
    pair = trb.Assembly.pair(
        BEARING, "back to back", spread=0.12, end_play=-10e-6, shaft=shaft, speed_rpm=900.0, loads=[push]
    )
    rows = [
        {"name": "light", "share": 3.0, "loads[0].force[1]": -1500.0},
        {"name": "heavy", "share": 1.0, "speed_rpm": 1400.0, "loads[0].force[1]": -9000.0, "loads[0].force[2]": 3000.0},
    ]
    spectrum = trb.spectrum(pair, rows)
    found = trb.rating(spectrum)
    alone = [trb.rating(one.subject) for one in spectrum.cases]
    for name, over in found.bearings.items():
        each = [one.bearings[name].life_hours for one in alone]
        assert over.life_hours == pytest.approx(1.0 / (0.75 / each[0] + 0.25 / each[1]))
        assert over.worst == "heavy"
    expected = sum(one.life_hours ** (-27.0 / 20.0) for one in found.bearings.values()) ** (-20.0 / 27.0)
    assert found.life_hours == pytest.approx(expected)
    assert "left" in str(found)


def test_classes_of_a_time_series() -> None:
    """The basic life over the classes goes to that of the integral of n P^(10/3), and their time is that of the series."""
    time = np.linspace(0.0, 60.0, 4001)
    axial = 4000.0 + 2500.0 * np.sin(0.7 * time) + 400.0 * np.sin(9.0 * time)
    speed = 900.0 + 300.0 * np.sin(0.2 * time + 1.0)
    damage = np.trapezoid(60e-6 * speed * (1.6 * axial / 77.7e3) ** (10.0 / 3.0), time) / 60.0
    off = []
    for classes in (2, 4, 12):
        rows = trb.series_table(time, {"axial_load": axial, "speed_rpm": speed}, classes=classes)
        assert sum(row["share"] for row in rows) == pytest.approx(60.0)
        parts = [
            row["share"] / 60.0 * 60e-6 * row["speed_rpm"] * (1.6 * row["axial_load"] / 77.7e3) ** (10.0 / 3.0)
            for row in rows
        ]
        off.append(abs(sum(parts) / damage - 1.0))
    assert off[0] > off[1] > off[2]
    assert off[2] < 5e-3
    rows = trb.series_table(time, {"axial_load": axial, "speed_rpm": speed}, classes=4)
    found = trb.rating(trb.spectrum(SCENE.replace(radial_load=0.0), rows))
    assert found.life_hours == pytest.approx(1.0 / damage, rel=2.0 * off[1])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (([0.0, 0.0], {"axial_load": [1.0, 1.0]}), "ascending"),
        (([0.0, 1.0], {"axial_load": [1.0]}), "2 finite numbers"),
        (([0.0, 1.0], {"axial_load": [1.0, math.nan]}), "2 finite numbers"),
    ],
)
def test_series_that_are_refused(given: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        trb.series_table(*given)


def test_what_is_no_load_case_is_refused_with_the_way() -> None:
    seat = trb.Mounting(bore=0.040, outside=0.080, width=0.02475, shaft="m6", housing="N7")
    fitted = trb.fit(SCENE, seat)
    with pytest.raises(
        trb.InputError, match=r"(?s)cases\[0\]\.subject = .*must be a Scene or an Assembly: .* fit\.subject"
    ):
        Spectrum([LoadCase("fitted", 1.0, fitted)])  # type: ignore[arg-type]
    with pytest.raises(trb.InputError, match=r"(?s)cases = .*must be a list or a tuple"):
        Spectrum(fitted)  # type: ignore[arg-type]
    with pytest.raises(trb.InputError, match=r"(?s)cases\[0\] = .*must be a LoadCase: put it into one"):
        Spectrum([SCENE])  # type: ignore[list-item]
    with pytest.raises(trb.InputError, match=r"base = .*Fit.*fit\.subject"):
        trb.spectrum(fitted, [{"share": 1.0}])
    assert len(Spectrum([LoadCase("fitted", 1.0, fitted.subject)])) == 1
