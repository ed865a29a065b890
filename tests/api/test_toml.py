"""Cases as TOML files: what they build, and what they say about a mistake."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

import trbdyn as trb
from trbdyn import cases
from trbdyn.base.shipped import CASES
from trbdyn.cli import main
from trbdyn.errors import FileError, InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.effects import Effects
from trbdyn.model.lubricants import vg100
from trbdyn.model.motion import History
from trbdyn.model.pocket_shapes import drafted_pocket, relieved_pocket
from trbdyn.model.scene import Scene, Start
from trbdyn.run.case_text import case_text
from trbdyn.run.options import RunOptions
from trbdyn.run.toml_case import case_from_dict, load_case

BASE = '[bearing]\ncase = "30310"\n{bearing}\n[scene]\nspeed_rpm = 3000\naxial_load = 4930\n'


def parse(extra: str = "", bearing: str = "") -> tuple[Scene, RunOptions]:
    return case_from_dict(tomllib.loads(BASE.format(bearing=bearing) + extra))


class TestShipped:
    def test_names(self) -> None:
        assert set(CASES.names()) == {"rig_30310", "bearing_32216", "bearing_nj210"}
        assert CASES.find("rig_30310") == CASES.find("rig_30310.toml")
        with pytest.raises(InputError, match="did you mean 'rig_30310'"):
            CASES.find("rig_30130")

    def test_rig_30310(self) -> None:
        scene, run = load_case("rig_30310")
        assert scene == cases.scene_30310(start=Start.whirl(0.9))
        assert scene.bearing == cases.rig_30310()
        assert (run.revolutions, run.end_time(scene)) == (50.0, pytest.approx(1.0))

    def test_bearing_32216(self) -> None:
        scene, _ = load_case(CASES.find("bearing_32216"))
        assert scene == cases.scene_32216(speed_rpm=2000)

    def test_commented_lines_of_the_rig_are_valid(self) -> None:
        lines = CASES.find("rig_30310").read_text().splitlines()
        text = "\n".join(line[2:] if line.startswith("# ") and " = " in line else line for line in lines)
        scene, _ = case_from_dict(tomllib.loads(text))
        assert scene.bearing.roller.profile.kind == "straight"
        assert scene.bearing.cage.pocket == drafted_pocket(cases.rig_30310(), 30.0)


class TestTables:
    def test_defaults(self) -> None:
        scene, run = parse()
        assert scene == Scene(cases.rig_30310(), speed_rpm=3000, axial_load=4930)
        assert run == RunOptions()

    def test_bearing_overrides(self) -> None:
        scene, _ = parse(bearing="cage.mass = 0.3\nroller.profile.kind = 'straight'")
        rig = cases.rig_30310()
        assert scene.bearing.cage == rig.replace(cage=rig.cage.replace(mass=0.3)).cage
        assert scene.bearing.roller.profile.kind == "straight"
        assert scene.bearing.roller.diameter == rig.roller.diameter

    def test_whole_bearing(self) -> None:
        text = """
            [bearing]
            n_rollers = 12
            cup_half_angle_deg = 13
            pitch_diameter = 82e-3
            roller = { diameter = 14e-3, effective_length = 19.8e-3, total_length = 20.8e-3 }
            ribs = { contact_height = 1.7e-3 }
            [bearing.cage]
            mass = 0.2
            inertia_axial = 3.9e-4
            inertia_transverse = 2.1e-4
            play_radial = 0.25e-3
            play_circumferential = 0.12e-3
            [scene]
            speed_rpm = 100
            axial_load = 1000
        """
        scene, _ = case_from_dict(tomllib.loads(text))
        assert scene.bearing.cup_half_angle_deg == 13.0

    def test_pocket_shapes(self) -> None:
        extra = """
            [bearing.cage.pocket]
            shape = "relieved"
            relief = 0.3
            [[bearing.cage.other_pockets]]
            index = 3
            pocket = { shape = "drafted", lean_deg = 10 }
        """
        scene, _ = parse(extra)
        rig = cases.rig_30310()
        assert scene.bearing.pocket == relieved_pocket(rig, 0.3)
        assert scene.bearing.pocket_of(3) == drafted_pocket(rig, 10)
        assert scene.bearing.pocket_of(2) == scene.bearing.pocket

    def test_pocket_shape_follows_the_overrides(self) -> None:
        scene, _ = parse(bearing='cage.play_circumferential = 0.2e-3\ncage.pocket = { shape = "default" }')
        assert scene.bearing.pocket.gaps(scene.bearing.geometry)["leading_bar"] > 0.15e-3

    def test_faces_by_hand(self) -> None:
        extra = """
            [[bearing.cage.pocket.faces]]
            name = "stop"
            slot = 0
            part = "flank"
            origin = [0.0, 7.2e-3, 0.0]
            u = [0.0, 0.0, 1.0]
            v = [1.0, 0.0, 0.0]
            outline = [[-1e-3, -1e-3], [1e-3, -1e-3], [0.0, 1e-3]]
        """
        with pytest.raises(InputError, match="penetrates face 'stop'") as caught:
            parse(extra.replace("7.2e-3", "6.9e-3"))
        assert caught.value.field == "bearing.cage.pocket.faces[0].origin"
        scene, _ = parse(extra)
        assert scene.bearing.slot_names == ("stop",)

    def test_lubricant(self) -> None:
        scene, _ = parse('[lubricant]\noil = "fva3"\ntemperature_c = 50\neyring_stress = 7e6\ndicke.a = 300')
        oil = vg100(50)
        assert scene.lubricant == oil.replace(eyring_stress=7e6, dicke=oil.dicke.replace(a=300))

    def test_effects(self) -> None:
        scene, _ = parse('[effects]\npreset = "standard"\nn_slices = 9\nfriction.dry_friction = 0.2')
        standard = Effects.standard()
        assert scene.effects == standard.replace(n_slices=9, friction=standard.friction.replace(dry_friction=0.2))
        assert parse("[effects]\nthermal = false")[0].effects == Effects.standard().replace(thermal=False)

    def test_histories_and_start(self) -> None:
        extra = 'ring = "follows"\nradial_load = { times = [0, 1], values = [0, 500] }\n[start]\nkind = "unequal"\nseed = 7\n'
        scene, run = parse(extra + "[run]\nduration = 0.1\nsave_groups = ['cage']")
        assert scene.radial_load == History.ramp(0, 1, 0, 500)
        assert scene.start == Start.unequal(7)
        assert run.save_groups == ("cage",)


class TestMistakes:
    @pytest.mark.parametrize(
        ("bearing", "extra", "line"),
        [
            (
                "roller.diamter = 3",
                "",
                "bearing.roller.diamter = 3 : unknown name; did you mean 'diameter'? allowed: density,",
            ),
            (
                "n_roller = 3",
                "",
                "bearing.n_roller = 3 : unknown name; did you mean 'n_rollers'? allowed: bore, cage, case,",
            ),
            ("n_rollers = 30", "", "bearing.n_rollers = 30 : must be <= 18"),
            ("roller.diameter = -1e-3", "", "bearing.roller.diameter = -0.001 : must be >= 0.0001 (m)"),
            ("cage = 3", "", "bearing.cage = 3 : must be a table of named values"),
            ("cage.pocket = 3", "", "bearing.cage.pocket = 3 : must be a table of named values"),
            (
                "cage.pocket = { shape = 'round' }",
                "",
                "bearing.cage.pocket.shape = 'round' : must be one of 'default',",
            ),
            (
                "cage.pocket = { shape = 'drafted' }",
                "",
                "bearing.cage.pocket.lean_deg : is required by the shape 'drafted'",
            ),
            (
                "cage.pocket = { shape = 'stepped', stp = 1 }",
                "",
                "bearing.cage.pocket.stp = 1 : unknown name; did you mean 'step'?",
            ),
            (
                "cage.other_pockets = [{ index = 12, pocket = { shape = 'default' } }]",
                "",
                "bearing.cage.other_pockets[0].index = 12 : must be <= 11",
            ),
            ("", "speed = 1", "scene.speed = 1 : unknown name; did you mean 'speed_rpm'? allowed: axial_load,"),
            ("", "radial_load = '1'", "scene.radial_load = '1' : must be a number"),
            ("", "radial_load = nan", "scene.radial_load = nan : must be a finite number (N)"),
            (
                "",
                "radial_load = { times = [0, 0], values = [1, 2] }",
                "scene.radial_load.times[1] = 0.0 : must be later",
            ),
            ("", "[lubricant]\noil = 'vg10'", "lubricant.oil = 'vg10' : must be one of 'vg100', 'fva3'"),
            (
                "",
                "[lubricant]\noil = 'vg100'\ntemperature_c = 900",
                "lubricant.temperature_c = 900 : must be from -20 to 200 (C)",
            ),
            ("", "[effects]\npreset = 'papr'", "effects.preset = 'papr' : must be one of 'standard', 'paper',"),
            (
                "",
                "[effects]\nfriction.lambda_ful = 1",
                "effects.friction.lambda_ful = 1 : unknown name; did you mean 'lambda_full'?",
            ),
            ("", "[effects]\nthermal = 1", "effects.thermal = 1 : must be true or false"),
            ("", "[start]\nkind = 'wirl'", "start.kind = 'wirl' : must be 'equal', 'unequal', 'whirl' or 'state'"),
            ("", "[start]\nkind = 'whirl'\n[effects]\nbodies = 'rollers'", "start.kind = 'whirl' : needs a cage"),
            ("", "[run]\nrevs = 3", "run.revs = 3 : unknown name; "),
            ("", "[run]\nsave_every = 0", "run.save_every = 0 : must be > 0 (s)"),
            ("", "[lubricnt]", "lubricnt = {} : unknown name; did you mean 'lubricant'? allowed: bearing, effects,"),
        ],
    )
    def test_names_the_full_key(self, bearing: str, extra: str, line: str) -> None:
        with pytest.raises(InputError) as caught:
            parse(extra, bearing)
        assert str(caught.value).startswith(line)

    @pytest.mark.parametrize(
        ("text", "line"),
        [
            ("", "bearing : is required"),
            ("bearing = 3", "bearing = 3 : must be a table of named values"),
            ("[bearing]\ncase = '30311'", "bearing.case = '30311' : must be one of '30310', '32216'"),
            ("[bearing]\ncase = 30310", "bearing.case = 30310 : must be one of '30310', '32216'"),
            ("[bearing]\ncase = '30310'", "scene.speed_rpm : is required (rpm)"),
            ("[bearing]\nn_rollers = 12", "bearing.cup_half_angle_deg : is required (deg)"),
        ],
    )
    def test_what_is_missing(self, text: str, line: str) -> None:
        with pytest.raises(InputError) as caught:
            case_from_dict(tomllib.loads(text))
        assert str(caught.value).startswith(line)

    def test_files(self, tmp_path: Path) -> None:
        with pytest.raises(FileError, match="rig_30310"):
            load_case(tmp_path / "none.toml")
        broken = tmp_path / "broken.toml"
        broken.write_text("[bearing\n")
        with pytest.raises(FileError, match=r"not a TOML file.*line 1"):
            load_case(broken)
        broken.write_bytes(b"\xff\xfe")
        with pytest.raises(FileError, match="is no text in UTF-8"):
            load_case(broken)


def test_a_written_case_keeps_what_the_same_run_in_python_keeps(tmp_path: Path) -> None:
    """All groups are not written as a wish: a run then leaves out those of which there is nothing."""
    text = case_text(trb.cases.scene_30310(3000.0), RunOptions(revolutions=0.01))
    assert "\n# save_groups =\n" in text
    assert "save_groups" not in tomllib.loads(text)["run"]
    assert 'save_groups = ["time", "cage"]' in case_text(
        trb.cases.scene_30310(3000.0), RunOptions(revolutions=0.01, save_groups=("time", "cage"))
    )
    assert main(["new", str(tmp_path / "own.toml")]) == 0
    assert (
        main(["run", str(tmp_path / "own.toml"), "--set", "run.revolutions=0.01", "-o", str(tmp_path / "own.h5")]) == 0
    )
    assert "housing" not in trb.load(tmp_path / "own.h5").groups


def test_a_bearing_from_a_catalogue_is_written_whole(tmp_path):
    """What was estimated does not follow from the size, so it is written as numbers."""
    bearing = Bearing.from_catalogue(bore=0.080, outside=0.140, width=0.03525, C=187e3, e=0.43)
    scene = Scene(bearing, speed_rpm=1000.0, axial_load=5000.0, lubricant=vg100(temperature_c=60.0))
    path = tmp_path / "own.toml"
    path.write_text(case_text(scene, RunOptions(duration=0.01)))
    assert load_case(path)[0].bearing.geometry == bearing.geometry
