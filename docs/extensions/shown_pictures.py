"""Sphinx extension: a cell that draws must show its pictures, or the build fails.

A cell draws with every call of ``trb.plot.NAME(`` but those that write files, and of ``.picture(``. The built pages are read,
as a reader sees them.
"""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

DRAWS = re.compile(r"(?:\btrb\.plot\.(?!save\b|all\b|conditions\b|make_folder\b)\w+|\.picture)\(")


class Cells(HTMLParser):
    """Collects of every code cell of a page its source and the number of pictures in its output."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[tuple[str, int]] = []
        self._divs: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "div":
            kind = (dict(attrs).get("class") or "").split()
            name = next((name for name in ("cell_input", "cell_output", "cell") if name in kind), "")
            self._divs.append(name)
            if name == "cell":
                self.found.append(("", 0))
        elif tag in ("img", "svg") and "cell_output" in self._divs:
            source, pictures = self.found[-1]
            self.found[-1] = source, pictures + 1

    def handle_endtag(self, tag: str) -> None:
        if tag == "div" and self._divs:
            self._divs.pop()

    def handle_data(self, data: str) -> None:
        if "cell_input" in self._divs:
            source, pictures = self.found[-1]
            self.found[-1] = source + data, pictures


def missing(page: str) -> list[str]:
    """Sources of the cells of a page that show fewer pictures than they draw."""
    cells = Cells()
    cells.feed(page)
    return [source.strip() for source, pictures in cells.found if pictures < len(DRAWS.findall(source))]


def drawn(page: str) -> int:
    """How many pictures the cells of a page draw."""
    cells = Cells()
    cells.feed(page)
    return sum(len(DRAWS.findall(source)) for source, _ in cells.found)


def check(app: Any, error: Exception | None) -> None:
    """Look at every page that was built."""
    from sphinx.errors import ExtensionError
    from sphinx.util import logging

    if error is not None or app.builder.format != "html":
        return
    pages = {path: path.read_text(encoding="utf-8") for path in sorted(Path(app.outdir).rglob("*.html"))}
    wrong = [
        f"{path.relative_to(app.outdir)}: no picture of\n{cell}"
        for path, page in pages.items()
        for cell in missing(page)
    ]
    if wrong:
        raise ExtensionError("cells that draw show no picture:\n" + "\n".join(wrong))
    logging.getLogger(__name__).info("%d pictures of cells are shown", sum(map(drawn, pages.values())))


def setup(app: Any) -> dict[str, Any]:
    """Tell Sphinx when to look."""
    app.connect("build-finished", check)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
