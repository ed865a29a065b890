"""The default effects, and what a source gives of the 32216, are those that users get."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

import trbdyn as trb
from trbdyn.cli import demo, make_parser

ROOT = Path(__file__).resolve().parents[2]


def test_the_cup_angle_is_that_of_iso_355() -> None:
    bearing = trb.cases.bearing_32216()
    assert bearing.cup_half_angle_deg == pytest.approx(15 + 38 / 60 + 32 / 3600, abs=1e-9)
    factor = 1.5 * math.tan(math.radians(bearing.cup_half_angle_deg))
    assert 0.415 < factor < 0.43
    profile = bearing.roller.profile
    assert (profile.kind, profile.a_p, profile.c_p, profile.d_p, profile.k_p) == ("iso", 0.0005, 20.7e-3, 0.0, 2.0)


def test_users_get_the_standard_effects_everywhere() -> None:
    """The shipped case, the demo and the sample of the README told 1.24, 1.24 and 1.48 N m for the same words."""
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0)
    assert scene.effects == trb.Effects.standard() == trb.Effects()
    assert trb.cases.scene_30310() == trb.load_case("rig_30310")[0].replace(start=trb.Start.equal()) == scene
    assert trb.cases.scene_32216().effects == trb.Effects.standard()
    assert trb.cases.paper_30310() == scene.replace(effects=trb.Effects.paper())


def test_the_demo_is_the_sample_of_the_readme(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    seen: list[trb.Scene] = []

    def look(scene: trb.Scene, *_: object, **__: object) -> None:
        seen.append(scene)
        raise Enough

    monkeypatch.setattr(demo, "simulate", look)
    options = make_parser().parse_args(["demo", "-o", str(tmp_path / "demo"), "--quiet"])
    with pytest.raises(Enough):
        options.command(options)
    sample = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0, start=trb.Start.whirl(0.9))
    assert seen == [sample]


def test_pages_for_users_take_the_standard_effects() -> None:
    """Tutorials, how-tos and the README take the default: nobody has to know of the paper to read a torque."""
    pages = [ROOT / "README.md", *ROOT.glob("docs/tutorials/*.md"), *ROOT.glob("docs/howto/*.md")]
    found = [page.name for page in pages if re.search(r"Effects\.paper|paper_30310", page.read_text(encoding="utf-8"))]
    assert found == []
