"""The tables of promises in the documentation, and that of what was found: every test that they name exists."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "promises.md"
FOUND = ROOT / "tests" / "adversary" / "found" / "README.md"
NAMED = re.compile(r"`([\w/.]*)::(\w+)`")
pytestmark = pytest.mark.skipif(not PAGE.is_file(), reason="the documentation is not part of a source distribution")


def promises() -> list[tuple[str, list[tuple[str, str]]]]:
    """(promise, [(file, test)]) of each row; `::name` alone is in the file named before it."""
    rows = []
    pages = (PAGE, FOUND) if PAGE.is_file() else ()
    for line in [line for page in pages for line in page.read_text(encoding="utf-8").splitlines()]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|") or cells[0] in ("promise", "found", "---"):
            continue
        named, file = [], ""
        for path, name in NAMED.findall(cells[1]):
            file = path or file
            named.append((file, name))
        rows.append((cells[0], named))
    return rows


def names_in(path: Path) -> set[str]:
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        return {node.name for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)}
    return set(re.findall(r"^[\w ]+[ *](\w+)\([^;]*\)\n\{", text, re.M))


def test_there_are_promises() -> None:
    assert len(promises()) > 20


def test_every_promise_has_its_tests() -> None:
    assert [promise for promise, named in promises() if not named] == []
    tests: dict[str, set[str]] = {}
    for file, name in (one for _, named in promises() for one in named):
        tests.setdefault(file, set()).add(name)
    assert [file for file in tests if not (ROOT / file).is_file()] == []
    assert {file: missing for file, named in tests.items() if (missing := named - names_in(ROOT / file))} == {}


def test_a_name_that_is_gone_is_found() -> None:
    """The look into sources finds what is there and nothing else."""
    here = names_in(Path(__file__))
    assert "test_there_are_promises" in here
    assert "test_there_are_no_promises" not in here
    assert {"fail_each", "fail_in_steps", "main"} <= names_in(ROOT / "csrc/tests/test_memory.c")
    assert "fail_never" not in names_in(ROOT / "csrc/tests/test_memory.c")
