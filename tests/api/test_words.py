"""What is said when input is wrong or can hardly be meant."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import pytest

import trbdyn as trb
from trbdyn import Effects, InputError, Simulation
from trbdyn.cli import main
from trbdyn.model.cases import paper_30310, rig_30310
from trbdyn.statics.plausible import UnusualInput


def short(sim: Simulation, **options: Any) -> trb.Result:
    return sim.run(duration=2e-4, save_every=1e-4, **options)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"axial_load": 5e6}, r"2\d.* GPa under axial_load = 5e\+06 N"),
        (
            {"bearing.cage.play_radial": 5e-3, "bearing.cage.play_circumferential": 3e-3},
            "play_radial = 0.005 m is more than a tenth",
        ),
        ({"gravity": (0.0, -1.0, 0.0)}, "an acceleration and not a direction"),
        ({"effects": Effects.minimal(), "radial_load": 1000.0}, "effects.planar = true with radial_load"),
    ],
)
def test_what_can_hardly_be_meant_is_said_and_kept(changes: dict[str, Any], says: str) -> None:
    scene = paper_30310().replace(changes)
    with pytest.warns(UnusualInput, match=says):
        sim = Simulation(scene, accuracy="fast")
    if "axial_load" not in changes:
        result = short(sim)
        assert any(text in sim.warnings for text in result.meta["notes"])


def test_usual_scenes_are_quiet() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", UnusualInput)
        for scene in (
            paper_30310(),
            trb.cases.scene_32216(),
            paper_30310(gravity=(0.0, 0.0, 0.0)),
            paper_30310(1000.0, 30e3),
        ):
            assert Simulation(scene).warnings == ()


def test_warning_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [
        "run",
        "rig_30310",
        "--duration",
        "2e-4",
        "--quiet",
        "-o",
        str(tmp_path / "run.h5"),
        "--set",
        "scene.gravity=[0,-1,0]",
    ]
    assert main(words) == 0
    assert "trbdyn: warning: gravity = (0, -1, 0) m/s2" in capsys.readouterr().err


def test_lean_of_bars_names_the_plays() -> None:
    """It said `bearing.cage.lean_deg = 85`, a key that does not exist."""
    with pytest.raises(InputError, match="bars would lean by 8") as caught:
        rig_30310().replace({"cage.play_circumferential": 3e-3})
    assert caught.value.field == "bearing.cage.play_circumferential"


@pytest.mark.parametrize("name", ["a.csv", "a.JSON", "a.npz"])
def test_output_of_another_kind(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"must end in \.h5"):
        short(Simulation(paper_30310(), accuracy="fast"), output=tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_fields_that_a_result_has_not() -> None:
    result = short(Simulation(paper_30310(), accuracy="fast"), save_groups=["time", "cage"])
    with pytest.raises(InputError, match="needs the group 'torque'"):
        _ = result.torque_split
    with pytest.raises(InputError, match="belongs to the group 'ring', which save_groups left out"):
        result["ring_force"]
    with pytest.raises(AttributeError, match="did you mean 'cage_position'"):
        _ = result.cage_positon
    with pytest.raises(InputError, match=r"did you mean .*orbit_radius"):
        result["orbit_radiu"]


@pytest.mark.parametrize(
    ("name", "group"),
    [
        ("power_split", "power"),
        ("torque_by_loss", "power"),
        ("torque_split", "torque"),
        ("energy_audit", "energy"),
        ("energy_balance", "energy"),
        ("energy_closure", "energy"),
    ],
)
def test_what_was_not_recorded_names_its_group(name, group):
    result = trb.Simulation(trb.cases.paper_30310()).run(duration=1e-3, save_groups=("cage",))
    with pytest.raises(trb.InputError, match=f"needs the group '{group}'"):
        getattr(result, name)
