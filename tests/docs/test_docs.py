"""The documentation is true: the code of every page runs, its commands exist, links inside lead somewhere, examples of
docstrings hold.
"""

from __future__ import annotations

import doctest
import importlib
import re
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import pytest

from trbdyn.cli import make_parser

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="the documentation is not part of a source distribution")

PAGES = sorted(DOCS.rglob("*.md")) if DOCS.is_dir() else []
CELL = re.compile(r"^```\{code-cell\}[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
SHELL = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)#]+)[^)]*\)")
EXAMPLES = (
    "trbdyn.model.ratings",
    "trbdyn.standards.iso281",
    "trbdyn.run.rating",
    "trbdyn.model.bearing",
    "trbdyn.model.catalogued",
    "trbdyn.extras.design.what_matters",
    "trbdyn.viewer",
    "trbdyn.viewer.gltf",
    "trbdyn.reporting",
    "trbdyn.plot.around",
    "trbdyn.plot.whirling",
    "trbdyn.plot.drawing",
)


def name(page: Path) -> str:
    return str(page.relative_to(DOCS))


@pytest.mark.slow  # `make docs` runs every page, too, and stops at an error
@pytest.mark.parametrize("page", [page for page in PAGES if CELL.search(page.read_text(encoding="utf-8"))], ids=name)
def test_code_of_the_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    matplotlib.use("Agg")
    names: dict[str, object] = {"__name__": "__main__"}
    for number, cell in enumerate(CELL.findall(page.read_text(encoding="utf-8"))):
        code = "\n".join(line for line in cell.splitlines() if not line.startswith(":tags:"))
        if "IPython" in code:
            pytest.importorskip("IPython")
        exec(compile(code, f"{page.name}, cell {number + 1}", "exec"), names)
    plt.close("all")


def test_commands_exist() -> None:
    parser, makefile, seen = make_parser(), (ROOT / "Makefile").read_text(encoding="utf-8"), 0
    for page in PAGES:
        for block in SHELL.findall(page.read_text(encoding="utf-8")):
            for line in block.splitlines():
                words = line.partition("#")[0].split()
                if words[:3] == ["python", "-m", "trbdyn"]:
                    parser.parse_args(words[3:])
                    seen += 1
                elif words[:1] == ["make"]:
                    assert re.search(rf"^{words[1]}:", makefile, re.MULTILINE), line
    assert seen >= 4


def test_links_lead_somewhere() -> None:
    for page in PAGES:
        for target in LINK.findall(CELL.sub("", page.read_text(encoding="utf-8"))):
            if "://" not in target:
                assert (page.parent / target).exists(), f"{name(page)}: {target}"


def test_every_page_is_linked_and_leads_on() -> None:
    """Of those of the interface, which are lists, only the first."""
    pages = {page for page in PAGES if page.parent.name != "api" and page.name != "changelog.md"}
    links = {
        page: {(page.parent / link).resolve() for link in LINK.findall(page.read_text(encoding="utf-8"))}
        for page in pages
    }
    led_to = set().union(*links.values())
    for page in pages:
        assert links[page] & (set(PAGES) - {page}), f"{page}: it links to no other page"
        assert page in led_to or page == DOCS / "index.md", f"{page}: no page links to it"


def test_every_page_is_in_the_contents() -> None:
    listed = set()
    for page in PAGES:
        for block in re.findall(r"```\{toctree\}(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
            entries = [line.strip() for line in block.splitlines() if line.strip() and not line.strip().startswith(":")]
            listed |= {(page.parent / f"{entry}.md").resolve() for entry in entries}
    assert {page.resolve() for page in PAGES} - listed == {(DOCS / "index.md").resolve()}


@pytest.mark.parametrize("module", EXAMPLES)
def test_examples_of_docstrings_hold(module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    matplotlib.use("Agg")
    done = doctest.testmod(importlib.import_module(module), optionflags=doctest.NORMALIZE_WHITESPACE)
    plt.close("all")
    assert done.failed == 0
    assert done.attempted > 0


def test_pictures_are_small() -> None:
    assert sum(path.stat().st_size for path in (DOCS / "pictures").iterdir()) < 2_000_000
