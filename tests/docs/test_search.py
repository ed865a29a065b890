"""The search of a built site, in a browser: a how-to that uses a word comes before the API's entry that is named by it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCORER = ROOT / "docs" / "static" / "scorer.js"
pytestmark = pytest.mark.skipif(
    not (ROOT / "docs").is_dir(), reason="the documentation is not part of a source distribution"
)
PAGES = {
    "index": "Site\n====\n\n.. toctree::\n\n   api/shaft\n   theory/motion\n   howto/pair\n   tutorials/first\n",
    "api/shaft": "stiffness\n=========\n\n.. py:function:: stiffness(scene)\n\n   Stiffness of a bearing.\n",
    "theory/motion": "Stiffness\n=========\n\nThe stiffness of contacts.\n",
    "howto/pair": "Two bearings\n============\n\nThe stiffness at the gear.\n",
    "tutorials/first": "A first run\n===========\n\nLoads and stiffness.\n",
}


def test_a_how_to_is_found_before_the_api(tmp_path: Path) -> None:
    pytest.importorskip("sphinx")
    from browser import Browser, executable

    if executable() is None:
        pytest.skip("no Chromium is installed: apt-get install chromium")
    source, site = tmp_path / "source", tmp_path / "site"
    for name, text in PAGES.items():
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / f"{name}.rst").write_text(text)
    (source / "conf.py").write_text(f"html_theme = 'basic'\nhtml_search_scorer = {str(SCORER)!r}\n")
    subprocess.run([sys.executable, "-m", "sphinx", "-q", source, site], check=True)
    browser = Browser(tmp_path)
    try:
        browser.open(site / "search.html", place="?q=stiffness")
        listed = "Array.from(document.querySelectorAll('ul.search > li > a')).map(one => one.href)"
        browser.wait(f"{listed}.length >= {len(PAGES) - 1}")
        found = [place.split("/site/")[1].split("/")[0] for place in browser.js(listed)]
    finally:
        browser.close()
    assert set(found[:2]) == {"howto", "tutorials"}
    assert found.index("theory") < found.index("api")
