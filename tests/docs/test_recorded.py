"""No figure of a page is older than the command that gives it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.skipif(
    not (ROOT / "docs").is_dir(), reason="the documentation is not part of a source distribution"
)


@pytest.fixture(scope="module")
def recorded() -> Any:
    import recorded

    return recorded


@pytest.fixture(scope="module")
def mark() -> str:
    import common

    return common.defaults_mark()


def test_figures_are_those_of_their_records(recorded: Any) -> None:
    records = recorded.kept()
    for page in recorded.PAGES:
        text = page.read_text(encoding="utf-8")
        assert recorded.FIGURE.search(text), page.name
        assert recorded.unlike(text, records) == [], f"{page.name}: python docs/recorded.py"
        assert recorded.without_record(text) == [], (
            f"{page.name}: a measured figure names the record that it comes from"
        )


def test_no_record_is_older_than_the_defaults_without_a_word(recorded: Any, mark: str) -> None:
    records = recorded.kept()
    for page in recorded.PAGES:
        assert recorded.older(page.read_text(encoding="utf-8"), records, mark) == [], page.name


def test_tables_of_benchmarks_say_which_are_older_than_the_defaults(recorded: Any, mark: str) -> None:
    for page in recorded.STAMPED:
        text = page.read_text(encoding="utf-8")
        assert recorded.STAMP.search(text), page.name
        assert recorded.old_stamps(text, mark) == [], f"{page.name}: python docs/recorded.py --mark, or measure again"


def test_the_page_of_the_paper_has_the_numbers_of_the_campaign() -> None:
    from paper.overview import SHOWN, kept, table

    found = kept()
    assert set(SHOWN) <= {entry["key"] for entry in found["statements"]}
    assert table(found) in (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")


def test_notebooks_say_when_their_outputs_are_older_than_the_defaults(recorded: Any, mark: str) -> None:
    notebooks = sorted((ROOT / "notebooks").glob("*.ipynb"))
    assert notebooks
    for path in notebooks:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        text = "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown")
        assert recorded.STAMP.search(text), path.name
        assert recorded.old_stamps(text, mark) == [], f"{path.name}: make notebooks, and the line that says when"


def test_the_notebook_of_the_paper_tells_the_campaign_as_it_is_kept(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What its cells print of the campaign's file today is what stands below them."""
    monkeypatch.chdir(ROOT / "notebooks")
    cells = json.loads(Path("paper_figures.ipynb").read_text(encoding="utf-8"))["cells"]
    names: dict[str, Any] = {"json": json, "Path": Path}
    told = 0
    for cell in cells:
        source = "".join(cell["source"])
        if cell["cell_type"] == "code" and "campaign" in source and "plt." not in source:
            exec(source, names)
            kept = "".join("".join(one["text"]) for one in cell["outputs"] if one["output_type"] == "stream")
            assert capsys.readouterr().out == kept
            told += 1
    assert told == 2


OLD_TABLE = """
3000 rpm, 4930 N axial load, 50 turns from a whirling start, from `summary.json`:

| figure | measured | expected |
|---|---|---|
| friction torque of the shaft | {} N m | |
"""


def test_the_page_of_before_would_have_failed(recorded: Any, mark: str) -> None:
    """A torque that stood there after the command gave another one."""
    records = recorded.kept()
    assert recorded.without_record(OLD_TABLE.format("2.614")) == ["friction torque of the shaft: 2.614 N m"]
    old = OLD_TABLE.format("2.614<!-- demo.torque -->")
    assert recorded.without_record(old) == []
    assert recorded.unlike(old, records) == [f"2.614: demo.torque is {records['demo']['figures']['torque']:.3f}"]
    assert recorded.unlike(recorded.renewed(old, records), records) == []
    made_then = {"demo": records["demo"] | {"defaults": "00000000"}}
    assert len(recorded.older(old, made_then, mark)) == 1
    said = {"demo": made_then["demo"] | {"older": "with the law of then"}}
    assert len(recorded.older(old, said, mark)) == 1
    assert recorded.older(old + "with the law of then", said, mark) == []
    assert len(recorded.older(old + "with the law of then", {"demo": said["demo"] | {"defaults": mark}}, mark)) == 1


def test_lines_of_measurements(recorded: Any, mark: str) -> None:
    then = "Measured 2026-11-22, trbdyn 0.1.0, revision abc, defaults 00000000; a machine."
    now = then.replace("00000000", mark)
    assert recorded.old_stamps(f"{then}\n\n{now}\n", mark) == [then]
    assert recorded.marked(f"{then}\n\n{now}\n", mark) == f"{then} {recorded.OLDER}\n\n{now}\n"
    assert recorded.old_stamps(f"{now} {recorded.OLDER}", mark) == [f"{now} {recorded.OLDER}"]


def test_the_mark_follows_defaults_and_not_effects_that_are_off(mark: str, monkeypatch: pytest.MonkeyPatch) -> None:
    import common

    import trbdyn as trb

    standard = trb.Effects()
    monkeypatch.setattr(trb, "Effects", type("Other", (), {"__new__": lambda _: standard, "paper": trb.Effects.paper}))
    assert common.defaults_mark() == mark
    changed = standard.replace(rolling_law="aihara")
    monkeypatch.setattr(trb, "Effects", type("Other", (), {"__new__": lambda _: changed, "paper": standard.paper}))
    assert common.defaults_mark() != mark
    assert common._what_is_on({"new": 0.0, "other": {"x": False}, "kept": 1}) == {"other": {}, "kept": 1}
