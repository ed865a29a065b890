"""A bearing from few numbers: what is not given follows its size, and is listed; materials per body; cases as text."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Bearing, Cage, InputError, Material, Profile, Ribs, Roller, Simulation
from trbdyn.base.shipped import CASES
from trbdyn.cli import main
from trbdyn.run.case_text import case_text, rounded
from trbdyn.run.toml_case import case_from_dict, load_case

# number of rollers, half angle of the cup (deg), pitch diameter, diameter and length of the rollers (mm), axial load (N)
CATALOGUE = {
    "30204": (15, 12.95, 33.5, 6.2, 9.5, 2000.0),
    "32008": (22, 14.17, 54.0, 6.8, 13.5, 4000.0),
    "31310": (14, 28.81, 80.0, 13.3, 17.0, 8000.0),
    "33217": (19, 15.2, 117.0, 17.0, 35.0, 25e3),
    "30230": (20, 16.17, 212.0, 26.0, 36.0, 45e3),
    "32330": (16, 12.95, 240.0, 38.0, 80.0, 90e3),
    "tiny": (12, 11.0, 14.0, 2.5, 4.0, 300.0),
}


def catalogue(name: str, **fields: Any) -> Bearing:
    """A bearing from its required inputs alone."""
    count, angle, pitch, diameter, length, _ = CATALOGUE[name]
    roller = Roller(diameter=1e-3 * diameter, effective_length=1e-3 * length)
    return Bearing(
        n_rollers=count, cup_half_angle_deg=angle, pitch_diameter=1e-3 * pitch, roller=roller, name=name, **fields
    )


@pytest.mark.parametrize("name", CATALOGUE)
def test_catalogue_bearings_run_from_required_inputs(name: str) -> None:
    """Four of six failed on numbers that nobody gave, two ran with pockets and profile of another bearing."""
    bearing, load = catalogue(name), CATALOGUE[name][-1]
    sim = Simulation(trb.Scene(bearing, speed_rpm=60.0 / bearing.pitch_diameter, axial_load=load), accuracy="fast")
    pressure = sim.contacts()["raceway_pressure"]
    # 30310 at 4930 N: the pressure along the contact is even to 25 % where the profile fits the load
    assert 0.4e9 < pressure.max() < 1.5e9
    assert sim.run(revolutions=0.05).success
    gaps = bearing.pocket.gaps(bearing.geometry)
    assert all(-1e-12 <= gap < 0.1 * bearing.roller.diameter for gap in gaps.values())


@pytest.mark.parametrize(
    ("kind", "first", "other"),
    [
        (Ribs, {"edge_low": 1e-4}, {"edge_high": 3e-3}),
        (Cage, {"mass": 0.1}, {"bar_width": 2e-3}),
        (trb.Land, {"clearance": 1e-4}, {"width": 3e-3}),
        (Profile, {"load": 1e4}, {"load": 2e4}),
        (Material, {"density": 7000.0}, {"youngs_modulus": 2e11}),
        (trb.Roughness, {"raceway": 1e-7}, {"rib": 1e-7}),
    ],
)
def test_a_part_that_is_changed_still_leaves_open_what_was_not_given(
    kind: Any, first: dict[str, float], other: dict[str, float]
) -> None:
    """Else what follows the size of the bearing would be fixed at the numbers of another one."""
    assert kind(**first).replace(**other).model_fields_set == first.keys() | other.keys()
    roller = Roller(diameter=6e-3, effective_length=9e-3).replace(end_stiffness=1e9)
    assert roller.model_fields_set == {"diameter", "effective_length", "end_stiffness"}


def test_assumed_numbers_follow_the_size_exactly() -> None:
    """The same bearing 1.7 times as large: every assumed length is, too."""
    small, factor = catalogue("31310"), 1.7
    large = small.replace(
        pitch_diameter=factor * small.pitch_diameter,
        roller=small.roller.replace(
            diameter=factor * small.roller.diameter, effective_length=factor * small.roller.effective_length
        ),
    )
    powers = {"mass": 3, "inertia_axial": 5, "inertia_transverse": 5, "load": 2, "end_stiffness": 0.5}
    same = {
        "density",
        "expansion",
        "damping_ratio",
        "sphere_ratio",
        "youngs_modulus",
        "poisson_ratio",
        "raceway",
        "rib",
        "pocket",
        "kind",
        "k1",
        "k2",
        "zm",
        "a_p",
        "k_p",
        "fill",
    }
    assert large.assumed.keys() == small.assumed.keys()
    assert len(small.assumed) > 25
    for path, value in small.assumed.items():
        name = path.rsplit(".", 1)[-1]
        if name in same or path == "cage.offset":
            assert large.assumed[path] == value, path
        else:
            assert large.assumed[path] == pytest.approx(value * factor ** powers.get(name, 1), rel=1e-12), path
    assert large.geometry.rib_normal_angle == pytest.approx(small.geometry.rib_normal_angle, rel=1e-9)


def test_shipped_bearings_keep_their_numbers() -> None:
    rig, other = trb.cases.rig_30310(), trb.cases.bearing_32216()
    old = {
        "ribs": {
            "edge_low": 0.3e-3,
            "edge_high": 3.5e-3,
            "front_clearance": 0.2e-3,
            "front_low": 0.3e-3,
            "front_high": 2e-3,
        },
        "cage": {
            "play_axial": 0.4e-3,
            "rail_offset": 12e-3,
            "bar_width": 3e-3,
            "wall_inner": 1.5e-3,
            "wall_outer": 4.5e-3,
        },
    }
    for section, numbers in old.items():
        for name, value in numbers.items():
            assert getattr(getattr(rig, section), name) == value
    assert (rig.cage.wall_half_width, rig.roller.end_stiffness, other.roller.end_stiffness) == (6e-3, 1e10, 1e10)
    assert {"cage.bar_width", "ribs.edge_high", "roller.density"} <= set(rig.assumed)
    assert not {"cage.bar_width", "cage.mass", "roller.profile.load", "roller.end_stiffness"} & set(other.assumed)


def test_what_was_assumed_is_kept_with_the_result(tmp_path: Path) -> None:
    bearing = catalogue("32008", cage=Cage(mass=0.05, play_axial=3e-4))
    assert {"cage.bar_width", "roller.profile.c_p"} <= set(bearing.assumed)
    assert not {"cage.mass", "cage.play_axial", "roller.diameter"} & set(bearing.assumed)
    # the radius of gyration of the rig's cage, 44.159 mm, lies outside of its pitch circle by a share of its roller's diameter
    gyration = 0.5 * bearing.pitch_diameter + (44.1588e-3 - 41.1945e-3) * bearing.roller.diameter / 14e-3
    assert bearing.cage.inertia_axial == pytest.approx(0.05 * gyration**2, rel=1e-5)
    sim = Simulation(trb.Scene(bearing, speed_rpm=1000.0, axial_load=4000.0), accuracy="fast")
    result = sim.run(duration=1e-3, output=tmp_path / "run.h5")
    assert result.scene.bearing == bearing
    assert result.scene.bearing.assumed == bearing.assumed
    stored = bearing.to_dict()
    stored["cage"]["bar_width"] = 1.234e-3  # by an older rule: the result keeps the number that it was made with
    again = Bearing.from_dict(stored)
    assert (again.cage.bar_width, "cage.bar_width" in again.assumed) == (1.234e-3, True)


def test_given_numbers_stay_and_assumed_ones_follow() -> None:
    bearing = catalogue("32008")
    changed = bearing.replace(cage=bearing.cage.replace(bar_width=1e-3))
    assert (changed.cage.bar_width, "cage.bar_width" in changed.assumed) == (1e-3, False)
    assert changed.cage.wall_outer == bearing.cage.wall_outer
    larger = changed.replace({"roller.diameter": 7.2e-3})
    assert larger.cage.bar_width == 1e-3
    assert larger.cage.wall_half_width == pytest.approx(bearing.cage.wall_half_width * 7.2 / 6.8)
    built = trb.study.grid(
        trb.Scene(bearing, speed_rpm=100.0, axial_load=4e3),
        {"bearing.roller.diameter": [7.2e-3]},
        trb.RunOptions(revolutions=1),
    )
    scene = built.cases[0].scene
    assert scene is not None
    assert scene.bearing.cage.wall_half_width == larger.cage.wall_half_width
    tables = {
        "bearing": {"case": "30310", "roller": {"diameter": 12e-3}},
        "scene": {"speed_rpm": 100.0, "axial_load": 4e3},
    }
    assert case_from_dict(tables)[0].bearing.cage.bar_width == pytest.approx(3e-3 * 12 / 14)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: Bearing(n_rollers=12, cup_half_angle_deg=13.0, pitch_diameter=0.08), "bearing.roller"),
        (lambda: catalogue("32008", cage={"mass": -1.0}), "bearing.cage.mass"),
        (
            lambda: catalogue("32008", ribs=Ribs(contact_height=1e-3, edge_low=0.9e-3, edge_high=0.95e-3)),
            "ribs.contact_height",
        ),
        (lambda: catalogue("32008", ribs={"edge_lo": 1e-3}), "bearing.ribs.edge_lo"),
        (lambda: catalogue("32008").replace({"roller.profile.lod": 1.0}), "roller.profile.lod"),
        (lambda: catalogue("32008").replace({"cage.mass": "1"}), "cage.mass"),
        (lambda: catalogue("32008", cage=Cage(play_radial=1e-6)), "bearing.cage.play_circumferential"),
    ],
)
def test_mistakes_name_the_field(make: Any, field: str) -> None:
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.field == field


def test_changes_by_path() -> None:
    scene = trb.cases.paper_30310()
    changed = scene.replace(
        {"bearing.cage.mass": 0.1, "bearing.roller.profile.load": 900.0, "gravity[1]": 0.0}, speed_rpm=500.0
    )
    assert (changed.bearing.cage.mass, changed.bearing.roller.profile.load) == (0.1, 900.0)
    assert (changed.gravity, changed.speed_rpm) == ((0.0, 0.0, 0.0), 500.0)
    assert scene.replace({"lubricant.temperature_c": 90.0}).lubricant == trb.lubricants.vg100(90.0)
    # both at once, as neither fits alone
    assert scene.replace({"bearing.n_rollers": 20, "bearing.pitch_diameter": 0.12}).bearing.n_rollers == 20
    for path, says in (
        ("bearing.cage.mas", "did you mean 'mass'"),
        ("bearing.n_rollers.x", "nothing below it"),
        ("gravity[3]", r"\[0\] to \[2\]"),
        ("bearing..cage", "must be a path"),
    ):
        with pytest.raises(InputError, match=says):
            scene.replace({path: 1.0})


def pocket_push(sim: Simulation) -> np.ndarray:
    """Loads of every pocket's faces with the cage pushed by 50 um beyond its radial play."""
    vector = sim.state.vector
    state = sim.view(vector)
    state["cage_x"] = 3.0e-4
    state["cage_z"] = 5e-4
    return sim.contacts(vector)["pocket_load"]


def test_materials_act_in_every_contact_of_their_body() -> None:
    """Line contacts: load = 0.356 E' ..., so that loads go with the composite modulus of the pair at the same
    interference.
    """
    place = {"axial_load": 0.0, "displacement": (0.0, 0.0, -2e-5)}
    rig = trb.cases.rig_30310()
    steel = Simulation(trb.cases.paper_30310(**place))
    nitride, plastic = Material.silicon_nitride(), Material.polyamide()
    stiff, soft = nitride.youngs_modulus / (1 - 0.26**2), plastic.youngs_modulus / (1 - 0.4**2)
    iron = 206e9 / (1 - 0.3**2)

    def composite(one: float, other: float) -> float:
        return 2.0 / (1.0 / one + 1.0 / other)

    def simulation(**changes: Any) -> Simulation:
        paths = {f"bearing.{path.replace('__', '.')}": value for path, value in changes.items()}
        return Simulation(trb.cases.paper_30310(**place).replace(paths))

    ceramic, light = simulation(roller__material=nitride), simulation(cage__material=plastic)
    both = simulation(material=nitride)
    vector = steel.state.vector
    base = steel.contacts(vector)
    # the profile's drop depends on E' too: a straight roller shows the load alone
    straight = {"roller__profile": Profile.straight()}
    flat = simulation(**straight).contacts(vector)["raceway_load"]
    for sim, ratio in (
        (simulation(roller__material=nitride, **straight), composite(stiff, iron) / iron),
        (simulation(material=nitride, **straight), stiff / iron),
        (simulation(cage__material=plastic, **straight), 1.0),
    ):
        assert sim.contacts(vector)["raceway_load"] == pytest.approx(ratio * flat, rel=1e-9)
    rib = base["rib_load"]
    assert ceramic.contacts(vector)["rib_load"] == pytest.approx(composite(stiff, iron) / iron * rib, rel=1e-9)
    assert light.contacts(vector)["rib_load"] == pytest.approx(rib, rel=1e-12)
    push = pocket_push(steel)
    assert np.count_nonzero(push) > 6
    assert pocket_push(light) / np.where(push > 0, push, 1.0) == pytest.approx(
        np.where(push > 0, composite(iron, soft) / iron, 0.0), rel=1e-9
    )
    assert rig.geometry.effective_modulus == rig.geometry.pocket_modulus == iron
    assert both.scene.bearing.geometry.pocket_modulus == pytest.approx(stiff)


@pytest.mark.parametrize("name", CASES.names())
def test_case_as_text(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    scene, run = load_case(name)
    assert main(["cases", "--print", name]) == 0
    text = capsys.readouterr().out
    assert case_from_dict(tomllib.loads(text)) == (scene, run)
    assert case_text(scene, run) in text
    for section in (trb.Bearing, trb.Roller, trb.Cage, trb.Ribs, trb.Land, trb.Effects, trb.Start, trb.RunOptions):
        for field in set(section.model_fields) - {
            "roller",
            "cage",
            "ribs",
            "material",
            "roughness",
            "land",
            "ratings",
            "profile",
            "friction",
        }:
            assert re.search(rf"^(# )?([\w.]+\.)?{field} =", text, re.MULTILINE), field
    assumed = re.findall(r"^# ([\w.]+) = .*  # assumed$", text, re.MULTILINE)
    assert set(assumed) == set(scene.bearing.assumed)


def test_displacement_with_loads_as_text() -> None:
    scene = trb.cases.paper_30310(
        500.0, 0.0, 800.0, displacement=(None, None, -1e-5), rotating_load=trb.RotatingLoad(30.0), ring="follows"
    )
    text = case_text(scene, trb.RunOptions(revolutions=1))
    assert 'displacement = ["free", "free", -1e-05]' in text
    assert case_from_dict(tomllib.loads(text))[0] == scene


def test_new_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "my.toml"
    assert main(["new", str(path), "--case", "rig_30310"]) == 0
    assert load_case(path) == load_case("rig_30310")
    # the size is changed, and what was assumed follows
    path.write_text(path.read_text().replace("roller.diameter = 0.014", "roller.diameter = 0.012"))
    assert load_case(path)[0].bearing.cage.bar_width == pytest.approx(3e-3 * 12 / 14)
    assert main(["new", str(path)]) == 2
    assert "exists already" in capsys.readouterr().err
    assert main(["new", str(tmp_path / "my.txt")]) == 2
    assert main(["cases", "--print", "rig_30311"]) == 2
    assert "did you mean 'rig_30310'" in capsys.readouterr().err


def test_names_of_parts_are_exported() -> None:
    for name in (
        "Roller",
        "Ribs",
        "Cage",
        "Profile",
        "Pocket",
        "Face",
        "Material",
        "Roughness",
        "Scatter",
        "Oil",
        "RotatingLoad",
    ):
        assert name in trb.__all__
        assert getattr(trb, name).__doc__


def test_every_name_that_can_be_used_is_listed() -> None:
    """Completion, ``from trbdyn import *`` and type checkers know what `trbdyn` gives."""
    known = set(trb.__all__)
    assert known == set(dir(trb))
    assert {"Bearing", "Scene", "Simulation", "plot", "study"} <= known
    assert all(getattr(trb, name) is not None for name in known)


def test_a_new_case_has_the_usual_effects(tmp_path: Path) -> None:
    own, named = tmp_path / "own.toml", tmp_path / "named.toml"
    assert main(["new", str(own)]) == 0
    assert main(["new", str(named), "--case", "rig_30310"]) == 0
    assert trb.load_case(own) == trb.load_case(named) == trb.load_case("rig_30310")
    assert trb.load_case(own)[0].effects == trb.Effects.standard()


def test_a_new_case_from_catalogue_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    numbers = ["bore=0.04", "outside=0.08", "width=0.02475", "C=74800", "e=0.37", "name=32208"]
    path = tmp_path / "32208.toml"
    assert main(["new", str(path), "--catalogue", *numbers]) == 0
    scene, _ = trb.load_case(path)
    bearing = trb.Bearing.from_catalogue(bore=0.04, outside=0.08, width=0.02475, C=74800, e=0.37, name="32208")
    assert rounded(scene.bearing.inputs()) == rounded(bearing.inputs())
    assert [entry.path for entry in scene.bearing.estimated] == [entry.path for entry in bearing.estimated]
    numbers_in_it = re.findall(r"^[\w.# ]+ = ([\d.e-]+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    assert max(len(number.partition("e")[0].replace(".", "").strip("0")) for number in numbers_in_it) <= 7
    assert scene.effects == trb.Effects.standard()
    assert 0.02 * 74800 < scene.axial_load < 0.08 * 74800
    assert "Speed and load are examples" in path.read_text(encoding="utf-8")
    for words, said in (
        (["bore=x"], "must be NAME=VALUE"),
        (["bor=1"], "must be one of bore"),
        (["bore=0.04"], "must hold outside, width, C as well"),
        ([*numbers, "C=-1"], "C = -1"),
    ):
        assert main(["new", str(tmp_path / "bad.toml"), "--catalogue", *words]) == 2
        assert said in capsys.readouterr().err
    assert not (tmp_path / "bad.toml").exists()
