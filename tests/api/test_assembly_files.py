"""Shafts on several bearings from case files and from the shell."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.base.shipped import ASSEMBLIES
from trbdyn.cli import main
from trbdyn.run.toml_assembly import assembly_from_dict

TABLES = tomllib.loads(ASSEMBLIES.find("pair_30310").read_text(encoding="utf-8"))


def changed(*path: Any, value: Any) -> dict[str, Any]:
    """The tables of the shipped case with one value changed; None removes it."""
    tables: Any = json.loads(json.dumps(TABLES))
    place = tables
    for key in path[:-1]:
        place = place[key]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return tables


def test_the_shipped_case_is_what_its_tables_say() -> None:
    pair, run = assembly_from_dict(TABLES)
    assert pair == trb.load_assembly("pair_30310") == trb.Assembly.from_json(pair.to_json())
    assert pair.names == ("left", "right")
    assert pair.bearings[0].bearing == trb.cases.rig_30310()
    assert pair.bearings[1].lubricant.temperature_c == 60.0
    assert pair.bearings[0].effects == trb.Effects.standard()
    assert pair.loads[0] == trb.ShaftLoad.gear(
        position=0.02, pitch_diameter=0.09, torque=180.0, helix_angle_deg=15.0, direction_deg=90.0
    )
    assert run.revolutions == 8.0


def test_a_hub_of_a_file() -> None:
    """The outer rings turn, the road presses on the wheel."""
    tables = changed("assembly", "outer_speed_rpm", value=600.0)
    tables["assembly"]["speed_rpm"] = 0.0
    tables["loads"] = [{"wheel": {"position": 0.01, "rolling_radius": 0.3, "load": 4000.0}}]
    hub, _ = assembly_from_dict(tables)
    assert hub.turning_rpm == 600.0
    assert hub.loads == (trb.ShaftLoad.wheel(position=0.01, rolling_radius=0.3, load=4000.0),)
    assert "600 rpm of the outer rings" in hub.title


def test_a_bearing_may_have_tables_of_its_own() -> None:
    tables = changed("bearings", 1, "bearing", value={"case": "32216"})
    tables["bearings"][1]["lubricant"] = {"oil": "vg68", "temperature_c": 40.0}
    tables["bearings"][0]["effects"] = {"bodies": "rollers"}
    tables["bearings"][1]["start"] = {"kind": "whirl", "eccentricity": 0.5}
    pair, _ = assembly_from_dict(tables)
    assert pair.bearings[1].bearing.name == "32216"
    assert pair.bearings[1].lubricant == trb.lubricants.vg68(40.0)
    assert [one.effects.bodies for one in pair.bearings] == ["rollers", "rollers_and_cage"]
    assert pair.bearings[1].start.kind == "whirl"


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        (changed("shaft", "mass", value=-1.0), r"shaft\.mass = -1\.0"),
        (changed("shaft", "masses", value=1.0), r"shaft\.masses"),
        (changed("bearings", 1, "position", value=-0.075), r"bearings\[1\]\.position|bearings\[0\]\.position"),
        (changed("bearings", 0, "small_ends", value="up"), r"bearings\[0\]\.small_ends = 'up'"),
        (changed("bearings", 0, "end_play", value=1.0), r"bearings\[0\]\.end_play = 1\.0"),
        (changed("bearings", 1, "name", value="left"), r"bearings\[1\]\.name = 'left'"),
        (changed("bearings", 1, "lubricant", value={"oil": "honey"}), r"bearings\[1\]\.lubricant\.oil = 'honey'"),
        (changed("loads", 0, "gear", "torque", value=None), r"loads\[0\]\.gear.*must have torque"),
        (changed("loads", 0, "gear", "tork", value=1.0), r"loads\[0\]\.tork"),
        (changed("loads", 1, "force", value=[1.0]), r"loads\[1\]\.force"),
        (changed("assembly", "speed", value=1.0), r"assembly\.speed = 1\.0 : unknown name.*speed_rpm"),
        (changed("assembly", "speed_rpm", value=None), r"speed_rpm"),
        (changed("run", "turns", value=1.0), r"run\.turns"),
        (changed("bearings", value={}), "bearings"),
        ({**TABLES, "scene": {}}, "scene"),
    ],
)
def test_bad_tables_name_the_full_key(tables: dict[str, Any], says: str) -> None:
    with pytest.raises(trb.InputError, match=says):
        assembly_from_dict(tables)


def test_bearings_alone_are_refused() -> None:
    tables = changed("bearings", 1, "spring", value={"force": 100.0})
    with pytest.raises(trb.InputError, match="must be 0 with a spring"):
        assembly_from_dict(tables)
    del tables["bearings"][1]
    with pytest.raises(trb.InputError, match="ring = 'free' is a shaft on one bearing"):
        assembly_from_dict(tables)


@pytest.mark.slow
def test_from_the_shell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Run, look, draw: with a value of the second bearing changed."""
    monkeypatch.chdir(tmp_path)
    words = ["--revolutions", "0.1", "--quiet", "--summary", "pair.json", "--set", "bearings.1.end_play=-15e-6"]
    assert main(["run", "pair_30310", "-o", "pair.h5", *words]) == 0
    result = trb.load("pair.h5")
    assert result.assembly is not None
    assert result.assembly.bearings[1].end_play == -15e-6
    numbers = json.loads(Path("pair.json").read_text())
    assert numbers["left"]["torque"] == pytest.approx(result["left"].summary()["torque"])
    assert numbers["right"]["axial_load"] == pytest.approx(
        float(np.mean(result.loads("right")["axial_load"])), rel=0.05
    )
    assert main(["info", "pair.h5"]) == 0
    assert "radial load, mean, N" in capsys.readouterr().out
    assert main(["info", "pair_30310"]) == 0
    assert "Equilibrium of" in capsys.readouterr().out
    assert main(["info", "pair.h5", "--json"]) == 0
    assert set(json.loads(capsys.readouterr().out)) == {"left", "right"}
    assert main(["plot", "pair.h5", "--only", "shaft_motion", "cage_locus"]) == 0
    assert Path("pair_plots/right/cage_locus.png").is_file()
    assert main(["cases"]) == 0
    assert "pair_30310" in capsys.readouterr().out
    assert main(["cases", "--print", "pair_30310"]) == 0
    assert assembly_from_dict(tomllib.loads(capsys.readouterr().out))[0] == trb.load_assembly("pair_30310")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--set", "bearings.2.end_play=0"], "must be a number from 0 to 1"),
        (["--set", "bearings.end_play=0"], "bearings.0.end_play"),
        (["--until", "torqe=0.01"], "did you mean torque?"),
        (["--set", "loads.1.force=[0.0, 0.0, 1e7]"], "cannot carry"),
    ],
)
def test_what_cannot_be_run_is_said(
    words: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", "pair_30310", "--revolutions", "0.1", "--quiet", *words]) != 0
    assert says in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
