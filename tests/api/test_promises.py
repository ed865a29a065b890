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


@pytest.mark.parametrize(("promise", "named"), promises(), ids=[promise[:40] for promise, _ in promises()])
def test_every_promise_has_its_tests(promise: str, named: list[tuple[str, str]]) -> None:
    assert named, promise
    for file, name in named:
        assert (ROOT / file).is_file(), f"{file} does not exist"
        assert name in names_in(ROOT / file), f"{file} has no {name}"


def test_a_name_that_is_gone_is_found() -> None:
    """The look into sources finds what is there and nothing else."""
    here = names_in(Path(__file__))
    assert "test_there_are_promises" in here
    assert "test_there_are_no_promises" not in here
    assert {"fail_each", "fail_in_steps", "main"} <= names_in(ROOT / "csrc/tests/test_memory.c")
    assert "fail_never" not in names_in(ROOT / "csrc/tests/test_memory.c")
