"""The worked examples of docs/design.md: each applies to the sources and, once built, does what the page says."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "docs" / "examples").glob("*.diff"))
PAGE = ROOT / "docs" / "design.md"

pytestmark = pytest.mark.skipif(not EXAMPLES, reason="the examples are not part of a source distribution")

SHOWN = {
    "recorded_quantity": """
r = trb.Simulation(trb.cases.scene_30310(3000, 4930)).run(duration=1e-3)
assert abs(r["outer_heat"].sum(axis=1) / r["power_traction_outer"] - 1.0).max() < 1e-6""",
    "input": """
def drag(factor):
    effects = trb.Effects(oil_fill=0.2, cage_drag_factor=factor)
    return trb.Simulation(trb.cases.scene_30310(3000, 4930, effects=effects)).record()["power_drag"]
assert abs((drag(3.0) - drag(1.0)) / (drag(2.0) - drag(1.0)) - 2.0) < 1e-6""",
    "loss": """
r = trb.Simulation(trb.cases.scene_30310(3000, 4930, effects=trb.Effects(oil_fill=0.2))).run(duration=1e-3)
assert r["power_cage_drag"][-1] > 0.0 and r.energy_closure < 1e-3""",
    "roller_pair": """
r = trb.Simulation(trb.cases.scene_30310(3000, 4930, effects=trb.Effects(oil_fill=0.2, churning=5.0))).run(duration=1e-3)
assert r["power_churn"][-1] > 1.0 and r.energy_closure < 1e-3
assert trb.laws.churn_torque(1.0, 0.03, 7e-3, 2e-2, 700.0) > 0.0""",
    "hub_pair": """
r = trb.Simulation(trb.cases.scene_30310(3000, 4930, effects=trb.Effects(skirt_damping=1e-5))).run(duration=1e-3)
assert r["power_skirt"][-1] > 0.1 and r.energy_closure < 1e-3""",
}
"""What each does, once it is built."""
BUILT = """
import sys
sys.meta_path = [finder for finder in sys.meta_path if getattr(finder, "__module__", "").startswith("_frozen")]
sys.path.insert(0, ".")
import trbdyn as trb
"""
"""The package of this folder, and not the one that an editable installation finds wherever it is asked for."""


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """The sources, and what a build needs of the rest."""
    for name in ("csrc", "trbdyn", "LICENSE", "README.md", "pyproject.toml"):
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "*.so"))
        else:
            shutil.copy2(source, tmp_path / name)
    return tmp_path


def apply(example: Path, folder: Path) -> None:
    # within a repository git would pass over files of a folder that is not its own, without an error
    env = os.environ | {"GIT_CEILING_DIRECTORIES": str(folder.parent)}
    done = subprocess.run(
        ["git", "apply", "--verbose", example], cwd=folder, env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{example.name} has to follow the sources: {done.stderr}"


def test_each_is_shown() -> None:
    assert {example.stem for example in EXAMPLES} == set(SHOWN)
    for example in EXAMPLES:
        assert f"examples/{example.name}" in PAGE.read_text(encoding="utf-8")


@pytest.mark.skipif(shutil.which("git") is None, reason="no git here")
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_it_applies_and_touches_what_the_page_says(example: Path, copy: Path) -> None:
    apply(example, copy)
    touched = len(re.findall(r"^diff --git", example.read_text(encoding="utf-8"), re.MULTILINE))
    row = re.search(rf"\]\(examples/{example.name}\)[^|]*\| (\d+) \|", PAGE.read_text(encoding="utf-8"))
    assert row is not None
    assert int(row[1]) == touched


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_it_does_what_the_page_says(example: Path, copy: Path) -> None:
    apply(example, copy)
    env = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "MAKEFLAGS", "MFLAGS")}
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "-q", "install"]
    settings = ("build-dir=build", "cmake.define.TRB_WERROR=ON", "cmake.define.TRB_BUILD_TESTS=ON")
    given = [word for setting in settings for word in ("-C", setting)]
    built = subprocess.run(
        [*pip, "--no-build-isolation", "--no-deps", "--target", "there", *given, "."],
        cwd=copy,
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stdout[-4000:] + built.stderr[-4000:]
    ctest = Path(sysconfig.get_path("scripts")) / "ctest"
    tested = subprocess.run(
        [ctest, "--test-dir", "build", "--output-on-failure"], cwd=copy, capture_output=True, text=True, check=False
    )
    assert tested.returncode == 0, tested.stdout[-4000:]
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", BUILT + SHOWN[example.stem]],
        cwd=copy / "there",
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-4000:]
