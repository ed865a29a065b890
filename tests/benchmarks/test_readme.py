"""The benchmarks' page: every script has its place, tables are whole, and a script replaces its own part alone."""

from __future__ import annotations

import json
import re
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
PAGES = ("README.md", "log.md")
pytestmark = pytest.mark.skipif(not BENCHMARKS.is_dir(), reason="the benchmarks are not part of a source distribution")


def readme() -> str:
    return (BENCHMARKS / "README.md").read_text(encoding="utf-8")


def test_every_script_is_named() -> None:
    scripts = {path.stem for path in BENCHMARKS.glob("*.py")} - {"common"}
    assert all(f"`{name}.py`" in readme() for name in scripts)


@pytest.mark.parametrize("page", PAGES)
def test_tables_are_whole(page: str) -> None:
    text = (BENCHMARKS / page).read_text(encoding="utf-8")
    tables = re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE)
    assert tables
    for table in tables:
        lines = table.splitlines()
        assert re.fullmatch(r"\|( *:?-+:? *\|)+", lines[1]), lines[:2]
        assert len({line.count("|") for line in lines}) == 1, lines[0]
    assert "{'" not in text


@pytest.mark.parametrize("page", PAGES)
def test_files_that_are_named_exist(page: str) -> None:
    text = (BENCHMARKS / page).read_text(encoding="utf-8")
    for name in re.findall(r"\]\(([^)#]+)\)", text):
        assert (BENCHMARKS / name).exists(), name


def test_a_script_replaces_its_own_part(tmp_path: Path) -> None:
    import common

    path = tmp_path / "README.md"
    path.write_text(readme(), encoding="utf-8")
    for name in re.findall(r"<!-- (\w+) -->", readme()):
        before = path.read_text(encoding="utf-8")
        common.write_readme(name, f"| {name} |\n| --- |", path)
        after = path.read_text(encoding="utf-8")
        head, rest = before.split(f"<!-- {name} -->")
        assert after.startswith(head)
        assert after.endswith(rest.split(f"<!-- /{name} -->")[1])
        assert f"| {name} |" in after
    common.write_readme("work_precision", "the same again", path)
    with pytest.raises(ValueError, match="nowhere"):
        common.write_readme("nowhere", "", path)


def test_table_of_one_narrow_column() -> None:
    import common

    assert common.table([{"x": 1}], ("x",)).splitlines()[1] == "| --: |"
    assert "3000" in common.table([{"x": 3000.0}], ("x",))


def test_report_is_plain_json(tmp_path: Path) -> None:
    from common import SCHEMA, Report

    options = Namespace(quick=True, json=tmp_path / "out.json")
    report = Report("name", options, {"value": "1: a number"})
    report.add(value=np.float64(np.nan))
    with pytest.raises(KeyError, match="other"):
        report.add(other=1)
    report.finish()
    found = json.loads(options.json.read_text(encoding="utf-8"))
    assert found["schema"] == SCHEMA
    assert found["results"] == [{"value": None}]
    assert found["machine"]["numpy"] == np.__version__
