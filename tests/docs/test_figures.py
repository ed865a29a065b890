"""No picture of README and site is older than what it shows: its numbers, computed again, are those of the day it was made."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.skipif(
    not (ROOT / "docs").is_dir(), reason="the documentation is not part of a source distribution"
)


@pytest.fixture(scope="module")
def figures() -> Any:
    import figures

    return figures


STEPS_SCATTER = 0.15
"""Steps of a colliding run differ between machines by rounding; beyond this, costs in a picture are those of another solver."""


def test_no_picture_is_older_than_what_it_shows(figures: Any) -> None:
    shown = json.loads(figures.SHOWN.read_text())
    old = []
    for name, (_, numbers) in figures.PICTURES.items():
        assert (ROOT / name).exists(), name
        now, then = numbers(), shown.get(name, {})
        if now.keys() != then.keys() or any(
            now[key] != pytest.approx(then[key], rel=STEPS_SCATTER if key == "steps" else 0.01) for key in now
        ):
            old.append(Path(name).name)
    assert not old, f"make figures FIGURES={' '.join(old)!r}"


def test_every_picture_has_its_maker(figures: Any) -> None:
    """Those that README and site show, and those that lie in the folder of the site."""
    made = {(ROOT / name).resolve() for name in figures.PICTURES}
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    shown = {
        (page.parent / place).resolve()
        for page in pages
        for place in re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
        if "://" not in place
    }
    lie = {path.resolve() for path in (ROOT / "docs" / "pictures").glob("*.png")}
    assert len(shown) >= 8
    assert shown | lie <= made


def test_figures_of_the_readme(figures: Any) -> None:
    """Loads, cage speed and torque of the table "How fast, how accurate"."""
    now, text = figures.numbers(figures.scene), (ROOT / "README.md").read_text(encoding="utf-8")

    def row(start: str) -> list[float]:
        found = re.search(rf"^\| {start}[^|]*\|([^|]*)\|", text, re.MULTILINE)
        assert found is not None, start
        return [float(number) for number in re.findall(r"\d+\.\d+", found[1])]

    loads = [now[f"{side}_load_mean"] for side in ("outer", "inner", "rib")]
    assert row("load of a roller at outer race, inner race, rib") == pytest.approx(loads, rel=2e-3)
    assert row("cage speed over shaft speed") == pytest.approx([now["cage_speed_ratio"]], rel=1e-3)
    assert row("friction torque of the shaft")[0] == pytest.approx(now["torque"], rel=0.01)
