"""The run of small faults itself: what it draws, what it counts, and that processes of tests meet the fault."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections import Counter
from pathlib import Path
from typing import Any

import faults
import mutate
import noticing
import pytest
import sandbox

import trbdyn._core as core

HERE = Path(__file__).resolve().parent

OUTER = """
import json, sys
sys.path.insert(0, {here!r})
import noticing, sandbox
from pathlib import Path
sandbox.WORK = noticing.WORK = Path({work!r})
sandbox.TREE = noticing.TREE = Path({work!r}) / "tree"
noticing.preload()
outcome = noticing.run_tests({names!r}, baseline=None, longest=120.0, stop=False)
print(json.dumps([[notice.test, notice.kind] for notice in outcome.failed]), outcome.ended)
"""


@pytest.mark.slow
def test_a_seed_gives_the_same_faults_again() -> None:
    first = faults.draw(1)
    again = faults.draw.__wrapped__(1)
    assert [fault.key for fault in first[:300]] == [fault.key for fault in again[:300]]
    assert first[:50] != faults.draw(2)[:50]
    assert len({fault.key for fault in first}) == len(first)


def is_there(name: str) -> bool:
    """A file or folder of tests, or a test in a file."""
    file, _, test = name.partition("::")
    path = faults.ROOT / "tests" / file
    return path.exists() and (not test or f"def {test}(" in path.read_text(encoding="utf-8"))


def test_every_area_has_its_share_and_its_tests() -> None:
    drawn = Counter(fault.area for fault in faults.draw(1)[:250])
    for area, (share, _) in faults.AREAS.items():
        assert abs(drawn[area] - 250 * share) < 2.0, area
        for name in (*noticing.FIRST[area], *noticing.THEN[area]):
            assert is_there(name), name
        for name in noticing.QUICK_C_TESTS.get(area, ()):
            assert (faults.ROOT / "csrc" / "tests" / f"{name}.c").exists(), name
    assert sum(share for share, _ in faults.AREAS.values()) == pytest.approx(1.0)


def test_a_fault_changes_its_place_alone() -> None:
    for fault in faults.draw(1)[250:350]:
        text = (faults.ROOT / fault.file).read_text(encoding="utf-8")
        changed = fault.applied(text)
        assert changed != text
        assert changed[: fault.place] == text[: fault.place]
        assert changed[fault.place + len(fault.new) :] == text[fault.place + len(fault.old) :]
        assert text.splitlines()[fault.line - 1].strip() == fault.text
        with pytest.raises(ValueError, match="is not the source"):
            fault.applied(" " * len(text))


def test_comments_and_strings_get_no_faults() -> None:
    assert not list(faults.faults_of_c('/* a + b */ // c * d\nconst char *s = "x - y";\n'))
    assert not list(faults.faults_of_python('"""a + b"""\n# c * d\ns = "x - y"\n'))
    assert [new for _, _, new in faults.faults_of_c("double f(double a, double b)\n{\n  return a + 2.0 * b;\n}\n")] == [
        "-",
        "3.0",
        "/",
    ]


ROW = {
    "file": "trbdyn/x.py",
    "line": 3,
    "column": 4,
    "nth": 1,
    "old": "+",
    "new": "-",
    "text": "a + b",
    "area": "results",
}


def row(**changes: Any) -> dict[str, Any]:
    return ROW | {"test": "", "kind": "", "why": "", "turn": "then", "tests": "t"} | changes


def test_what_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Equivalent faults are counted apart; a fault that does not compile is none; a survivor is listed with its place."""
    rows = [
        row(test="tests/a.py::b", kind="assertion AssertionError"),
        row(),
        row(new="*"),
        row(why="does not compile"),
    ]
    rows += [row(why="same program")]
    monkeypatch.setattr(mutate, "judgements", lambda: [ROW | {"new": "*", "reason": "b is zero"}])
    text = mutate.table(rows)
    assert "results         4           2        2        1  50 %" in text
    assert "do not compile, not counted: 1" in text
    assert text.split("not noticed:")[1].count("trbdyn/x.py:3:4") == 1
    assert "b is zero" in text.split("judged:")[1].split("not noticed:")[0]


def test_survivors_are_tried_again_when_tests_change() -> None:
    assert mutate.is_open("first", None, "t")
    assert mutate.is_open("near", row(turn="first"), "t")
    assert not mutate.is_open("then", row(turn="first"), "t")
    assert mutate.is_open("then", row(turn="near"), "t")
    assert not mutate.is_open("near", row(turn="first", test="tests/a.py::b"), "t")
    assert not mutate.is_open("first", row(), "t")
    assert mutate.is_open("first", row(), "other")
    assert not mutate.is_open("first", row(test="tests/a.py::b"), "other")
    assert not mutate.is_open("first", row(why="same program"), "other")


def test_every_source_has_tests_near_it() -> None:
    """And they are there."""
    for file in {fault.file for fault in faults.draw(1)}:
        for name in noticing.near(file):
            assert is_there(name), name


def test_judgements_name_faults_that_are_there() -> None:
    """A judgement of a line that changed since says nothing any more."""
    judged = mutate.judgements()
    there = [entry for fault in faults.draw(1) if (entry := mutate.judgement(vars(fault), judged))]
    for entry in judged:
        assert entry in there, entry
        assert entry["reason"].endswith(".")


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A small copy: the package with the installed core, and tests that start processes."""
    tree = tmp_path / "tree"
    shutil.copytree(faults.ROOT / "trbdyn", tree / "trbdyn", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copyfile(core.__file__, tree / "trbdyn" / Path(core.__file__).name)
    shutil.copyfile(faults.ROOT / "pyproject.toml", tree / "pyproject.toml")
    (tree / "tests").mkdir()
    (tree / "tests" / "test_it.py").write_text(
        "import subprocess, sys, time\n"
        "def run(*words):\n"
        "    return subprocess.run([sys.executable, *words], capture_output=True, text=True).stderr\n"
        "def test_program():\n    assert run('-m', 'trbdyn').startswith('trbdyn:')\n"
        "def test_program_without_the_folder():\n    assert run('-P', '-m', 'trbdyn').startswith('trbdyn:')\n"
        "def test_other():\n    assert 1 + 1 == 2\n"
    )
    for name, path in (("TREE", tree), ("VENV", tmp_path / "venv"), ("PYTHON", tmp_path / "venv" / "bin" / "python")):
        monkeypatch.setattr(sandbox, name, path)
    sandbox._make_environment()
    return tmp_path


def failures(copy: Path) -> list[list[str]]:
    code = OUTER.format(here=str(HERE), work=str(copy), names=["test_it.py"])
    done = subprocess.run([copy / "venv/bin/python", "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found, ended = done.stdout.rsplit(maxsplit=1)
    assert ended == "True", done.stdout
    return json.loads(found)


@pytest.mark.slow
def test_a_process_of_a_test_meets_the_fault(copy: Path) -> None:
    """One planted in the command line: tests that start a process notice it, the others do not."""
    assert failures(copy) == []
    file, old, new, _ = mutate.PLANTED
    source = copy / "tree" / file
    text = source.read_text(encoding="utf-8")
    assert text.count(old) == 1
    source.write_text(text.replace(old, new), encoding="utf-8")
    tests = ["tests/test_it.py::test_program", "tests/test_it.py::test_program_without_the_folder"]
    assert failures(copy) == [[test, "assertion AssertionError"] for test in tests]
