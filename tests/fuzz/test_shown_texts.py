"""Texts that users give, and short or small results: shown as they are, and never an error of Python."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

import trbdyn as trb
from trbdyn.cli import main
from trbdyn.model.cases import paper_30310
from trbdyn.viewer import save_gltf

NAMES = ("$x^{$", "$\x1b[31mred\x07\r\n\u202eabc%s{0}\\frac{" + "a" * 300 + "<!--<script>")


@pytest.mark.parametrize("name", NAMES)
def test_any_name_of_a_bearing_is_shown_everywhere(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = paper_30310().replace({"bearing.name": name})
    result = trb.Simulation(scene).run(duration=2e-4, save_every=1e-5, output=tmp_path / "run.h5")
    assert trb.report(result, tmp_path / "report.html", pictures=["cage_locus"]).is_file()
    assert trb.plot.all(result, tmp_path / "pictures", ["cage_locus"])
    assert save_gltf(result, tmp_path / "a.glb", max_frames=3).is_file()
    page = trb.view(result, max_frames=3).html
    head = page.partition('<script id="head" type="application/json">')[2].partition("</script>")[0]
    assert json.dumps(name)[1:-1] in json.dumps(json.loads(head))
    assert "<!--<script" not in page
    capsys.readouterr()
    assert main(["info", str(tmp_path / "run.h5")]) == 0
    said = capsys.readouterr().out
    assert all(sign.isprintable() or sign == "\n" for sign in said)
    assert main(["info", str(tmp_path / "run.h5"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["records"] == len(result)


def test_a_run_of_few_records_is_reported_and_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every picture of the fewest records that it can be drawn of: two, and eight of a spectrum. They are laid out and drawn, but
    not made into images."""

    def save(figure: Figure, target: Any, **how: Any) -> None:
        figure.draw_without_rendering()
        target.write(b"x")

    monkeypatch.setattr(Figure, "savefig", save)
    drawn: set[str] = set()
    for count in (2, 7, 8):
        result = trb.Simulation(paper_30310()).run(duration=(count - 1) * 1e-5, save_every=1e-5)
        assert len(result) == count
        new = [name for name in trb.plot.drawable(result) if name not in drawn]
        assert ("spectrum" in new) == (count == 8)
        written = [path.stem for path in trb.plot.all(result, tmp_path / str(count), new)] if new else []
        assert written == new
        drawn |= {*new}
        page = trb.report(result, tmp_path / f"{count}.html", pictures=["spectrum", "cage_locus"])
        assert "The energy" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("group", ["peaks", "torque", "cage"])
@pytest.mark.usefixtures("drawn_only")
def test_a_run_of_one_group_is_reported(group: str, tmp_path: Path) -> None:
    result = trb.Simulation(paper_30310()).run(duration=2e-4, save_every=1e-5, save_groups=(group,))
    assert "Verdict" in trb.report(result, tmp_path / "a.html", pictures=[]).read_text(encoding="utf-8")
    assert result.summary()
