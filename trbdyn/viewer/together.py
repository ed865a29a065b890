"""Bearings on one shaft in one page: a view of each, side by side or one above the other, that show the same instant.

Each view is a page of its own within the page. A program of a few lines lets them keep step: the view that plays, or in which the
time was changed, leads the others.
"""

from __future__ import annotations

import html
from collections.abc import Mapping

_STYLE = """
html, body { margin: 0; height: 100%; font: 15px/1.4 system-ui, "DejaVu Sans", sans-serif; background: #e6ebf0; color: #1b1f24; }
body { display: flex; flex-direction: column; }
h1 { font-size: 17px; margin: 6px 12px; }
main { flex: 1; display: flex; flex-wrap: wrap; gap: 4px; }
section { flex: 1 1 420px; display: flex; flex-direction: column; min-height: 480px; }
h2 { font-size: 14px; margin: 0 12px 4px; font-weight: 600; }
iframe { flex: 1; width: 100%; border: 0; }
"""

_PROGRAM = """
const frames = [...document.querySelectorAll("iframe")], seen = [];
const part = (view) => view.state.place / (view.head.frames - 1);
function keepStep() {
  const views = frames.map((frame) => frame.contentWindow && frame.contentWindow.trbView);
  if (views.every(Boolean)) {
    let lead = views.findIndex((view) => view.state.playing);
    if (lead < 0) lead = views.findIndex((view, k) => seen[k] !== undefined && view.state.place !== seen[k]);
    if (lead >= 0) views.forEach((view, k) => { if (k !== lead) view.setPlace(part(views[lead]) * (view.head.frames - 1)); });
    views.forEach((view, k) => { seen[k] = view.state.place; });
  }
  requestAnimationFrame(keepStep);
}
requestAnimationFrame(keepStep);
window.trbViews = () => frames.map((frame) => frame.contentWindow.trbView);
"""


def together(pages: Mapping[str, str], title: str) -> str:
    """The HTML of several views in one page.

    Parameters
    ----------
    pages : mapping of str to str
        The page of each view, by its heading.
    title : str
        Title of the page.
    """
    sections = "".join(
        f'<section><h2>{html.escape(name)}</h2><iframe srcdoc="{html.escape(page, quote=True)}" title="{html.escape(name)}">'
        "</iframe></section>"
        for name, page in pages.items()
    )
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{html.escape(title)}</title><style>{_STYLE}</style></head>"
        f"<body><h1>{html.escape(title)}</h1><main>{sections}</main><script>{_PROGRAM}</script></body></html>\n"
    )
