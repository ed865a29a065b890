"""In a notebook, and on the site, every cell that draws shows its picture, not only the first one."""

from __future__ import annotations

from types import ModuleType

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

CELLS = (
    "import trbdyn as trb\nbearing = trb.cases.rig_30310()\ntrb.plot.bearing_drawing(bearing);",
    "trb.plot.pocket_drawing(bearing);",
    "axes = trb.plot.bearing_drawing(bearing)",
)


def test_every_cell_of_a_notebook_shows_its_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a kernel: the first picture loads the backend, and what this sets must outlive the style of the picture."""
    monkeypatch.delenv("MPLBACKEND", raising=False)
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS])
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    pictures = [sum("image/png" in output.get("data", {}) for output in cell.outputs) for cell in notebook.cells]
    assert pictures == [1, 1, 1]


def extension() -> ModuleType:
    return pytest.importorskip("shown_pictures", reason="the documentation is not part of a source distribution")


def cell(source: str, output: str) -> str:
    return (
        f'<div class="cell docutils container"><div class="cell_input docutils container"><div><pre>{source}</pre></div></div>'
        f'<div class="cell_output docutils container">{output}</div></div>'
    )


def test_the_site_sees_a_cell_without_its_picture() -> None:
    """Seven of eight pictures of a page were missing, and the build said nothing."""
    check, image = extension(), '<img src="a.png"/>'
    draw = "<span>trb</span><span>.</span><span>plot</span><span>.</span><span>tilt</span><span>(</span>result);"
    full = cell(draw, image) + cell("trb.plot.save(axes, 'a.png')", "") + cell("figure = plan.picture()", image)
    assert check.missing(full) == []
    assert check.drawn(full) == 2
    assert len(check.missing(full + image + cell(draw, ""))) == 1
    assert len(check.missing(cell(draw + draw, image))) == 1
