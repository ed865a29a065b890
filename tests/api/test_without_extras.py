"""The core runs without the extras: in a copy of the package whose folder ``extras`` is away, README's samples, the demo and
tests of the core pass, and a name of an extra says which part is missing.
"""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import trbdyn as trb
from trbdyn import _core
from trbdyn.base.extras import PLACES

ROOT = Path(__file__).resolve().parents[2]
ALONE = """
import sys
sys.meta_path = [finder for finder in sys.meta_path if getattr(finder, "__module__", "").startswith("_frozen")]
sys.path.insert(0, {folder!r})
import trbdyn as trb
assert trb.__file__.startswith({folder!r}), trb.__file__
"""
"""The package of a folder, and not the one that an editable installation finds wherever it is asked for."""
TESTS = ("tests/api/test_by_hand.py", "tests/geometry/test_derived.py")
MORE_TESTS = (
    "tests/geometry/test_pocket.py",
    "tests/api/test_simulation.py",
    "tests/api/test_results.py",
    "tests/api/test_rating.py",
    "tests/api/test_toml.py",
    "tests/geometry/test_equilibrium.py",
    "tests/physics/test_audit.py",
    "tests/physics/test_assembly.py",
    "tests/physics/test_records.py",
)


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the package alone, its extras taken away."""
    folder = tmp_path_factory.mktemp("core")
    ignored = shutil.ignore_patterns("__pycache__", "extras", "*.so")
    shutil.copytree(
        Path(trb.__file__).parent, folder / "trbdyn", ignore=lambda at, names: ignored(at, names) - {"extras.py"}
    )
    shutil.copy(_core.__file__, folder / "trbdyn")
    return folder


def run(core: Path, code: str, where: Path) -> str:
    environment = os.environ | {"MPLBACKEND": "Agg"}
    words = [sys.executable, "-P", "-c", ALONE.format(folder=str(core)) + code]
    done = subprocess.run(words, cwd=where, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


def passes(core: Path, files: tuple[str, ...], folder: Path) -> None:
    words = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--basetemp", str(folder), "-W", "ignore", *files]
    out = run(core, f"import os, pytest; sys.exit(pytest.main({words!r}))", ROOT)
    assert " passed" in out, out


def samples() -> list[str]:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_first_sample_and_the_demo(core: Path, tmp_path: Path) -> None:
    """README's first sample and the demo, with fewer turns."""
    text = samples()[0].replace("revolutions=50", "revolutions=1")
    command = ["demo", "--revolutions", "0.2", "--quiet", "-o", "demo"]
    text += f"""
from trbdyn.cli import main
import matplotlib.pyplot as plt
import trbdyn.reporting.page
import trbdyn.run.check
trbdyn.reporting.page.image = lambda draw: plt.close(draw().figure) or ""  # drawn, but not made into images
trbdyn.run.check.BUDGET_S = 0.1
assert main({command!r}) == 0
"""
    run(core, text, tmp_path)
    assert {"whirl.h5", "locus.png"} < {path.name for path in tmp_path.iterdir()}
    assert {"run.h5", "report.html", "view.html"} < {path.name for path in (tmp_path / "demo").iterdir()}


@pytest.mark.slow
def test_samples(core: Path, tmp_path: Path) -> None:
    run(core, "\n".join(samples()), tmp_path)
    assert {"whirl.h5", "locus.png", "32208.html", "32208_report.html"} < {path.name for path in tmp_path.iterdir()}


def test_tests_of_the_core(core: Path, tmp_path: Path) -> None:
    passes(core, TESTS, tmp_path / "tests")


@pytest.mark.slow
@pytest.mark.parametrize("file", MORE_TESTS)
def test_more_tests_of_the_core(core: Path, tmp_path: Path, file: str) -> None:
    passes(core, (file,), tmp_path / "tests")


def test_what_is_missing_is_named(core: Path, tmp_path: Path) -> None:
    code = """
from trbdyn.cli import main
body = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})
elastic = trb.Scene(body, speed_rpm=3000, axial_load=4930.0, elastic_cage=trb.ElasticCage(n_modes=6))
for call in (
    lambda: trb.optimise,
    lambda: trb.study.run,
    lambda: trb.Simulation(elastic),
    lambda: trb.Profile.from_trace("a.csv", 1e-2),
    lambda: trb.wear,
):
    try:
        call()
    except trb.MissingExtra as error:
        assert isinstance(error, ImportError)
        print(error)
print(main(["plan", "rig_30310", "--want", "torque=0.02"]), main(["app"]))
"""
    out = run(core, code, tmp_path).splitlines()
    words = " of trbdyn, which is not installed: there is no folder trbdyn/extras/"
    expected = (
        ("optimise", "design"),
        ("study", "study"),
        ("an elastic cage", "elastic"),
        ("a measured profile", "cad"),
        ("wear", "wear"),
    )
    assert out == [f"{name} needs the part '{part}'{words}{part}" for name, part in expected] + ["2 2"]


def test_every_place_is_there() -> None:
    """What the core asks of the extras is where its table says."""
    for name, (place, _) in PLACES.items():
        path = Path(trb.__file__).parent / "extras" / place.replace(".", "/")
        file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
        body = ast.parse(file.read_text(encoding="utf-8")).body
        assert name in [node.name for node in body if isinstance(node, ast.FunctionDef)]
