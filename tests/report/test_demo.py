"""The demo opens with what it does, and ends with what matters and where it is."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from trbdyn.cli import main


@pytest.mark.usefixtures("drawn_only")
def test_demo(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "demo"
    assert main(["demo", "-o", str(folder), "--revolutions", "1"]) == 0
    said = capsys.readouterr().out.strip().splitlines()
    assert said[0].startswith("A tapered roller bearing 30310 turns at 3000 rpm under 4930 N axial load, for 1 turns")
    numbers = json.loads((folder / "summary.json").read_text())
    sentences = [line for line in said if line[:2] in ("1.", "2.", "3.")]
    assert len(sentences) == 3
    assert "cage" in sentences[0]
    assert f"{numbers['pocket_force_peak']:.3g} N" in sentences[1]
    assert f"{numbers['torque']:.3g} N m" in sentences[2]
    assert said[-2] == f"report: {folder / 'report.html'}"
    assert said[-1] == f"3-D view: {folder / 'view.html'}"
    assert "The energy adds up" in (folder / "report.html").read_text(encoding="utf-8")
    assert (folder / "view.html").stat().st_size > 600_000
    assert len(said) < 16  # no wall of numbers


@pytest.mark.slow
def test_quiet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demo", "-o", str(tmp_path / "demo"), "--revolutions", "1", "--quiet"]) == 0
    assert capsys.readouterr().out == ""
