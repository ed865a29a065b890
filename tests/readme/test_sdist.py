"""The source distribution holds sources and nothing that a user's runs have left in the checkout."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LEFT = ("run.h5", "run.h5.checkpoint", "demo/run.h5", "speeds/index.jsonl", "speeds/v1000.h5", "trbdyn/mine.h5", "notes.txt",
        "tests/adversary/run.h5", "report.html", "build/x.o", ".v1000.h5.part")  # fmt: skip
"""What the commands of README, and users, leave behind."""

BUILD = "import sys; from scikit_build_core.build import build_sdist; print(build_sdist(sys.argv[1]))"


@pytest.mark.skipif(not (ROOT / ".git").exists() or shutil.which("git") is None, reason="needs the tracked files")
def test_only_sources_go_into_the_sdist(tmp_path: Path) -> None:
    pytest.importorskip("scikit_build_core")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, text=True).stdout
    tracked = {name for name in listed.split("\0") if name and (ROOT / name).is_file()}
    source, out = tmp_path / "source", tmp_path / "out"
    for name in tracked:
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, source / name)
    for name in LEFT:
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / name).write_bytes(bytes(1 << 20))
    subprocess.run([sys.executable, "-c", BUILD, str(out)], cwd=source, check=True, capture_output=True)
    (made,) = out.glob("*.tar.gz")
    assert made.stat().st_size < 3e6
    with tarfile.open(made) as packed:
        names = {name.partition("/")[2] for name in packed.getnames()}
    assert names - {"PKG-INFO"} <= tracked
    needed = {name for name in tracked if name.startswith(("csrc/", "trbdyn/"))} | {
        "pyproject.toml",
        "README.md",
        "LICENSE",
    }
    assert needed <= names, needed - names


def test_the_wheels_are_built_from_tracked_sources() -> None:
    script = (ROOT / ".ci" / "wheels").read_text(encoding="utf-8")
    assert "git ls-files -z | tar" in script
    assert "--outdir dist build/wheels/source" in script
