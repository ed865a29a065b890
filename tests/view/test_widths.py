"""The report on a phone, a small and a large screen, and on paper: nothing is wider than the page, and the values are there."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.reporting import converter, save_pdf
from trbdyn.results.numbers import TABLE

WIDTHS = (420, 1000, 1400)


@pytest.fixture(scope="module")
def long_run() -> trb.Result:
    """Long enough for every note, and why it has no intervals: the paper's effects give the rings different torques."""
    scene = trb.cases.scene_30310(3000.0, 4930.0, effects=trb.Effects.paper(), start=trb.Start.whirl(0.9))
    return trb.Simulation(scene, accuracy="fast").run(revolutions=60)


@pytest.fixture(scope="module")
def pages(long_run: trb.Result, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A report of one run, and one of two side by side."""
    folder = tmp_path_factory.mktemp("widths")
    one = trb.report(long_run, folder / "one.html", pictures=["cage_locus"])
    two = trb.report(long_run, folder / "two.html", other=long_run, pictures=["cage_locus"])
    return one, two


UNFOLD = "document.querySelectorAll('details').forEach((one) => { one.open = true; })"
TALLEST = 5500
"""Height of a report with all pictures, its details folded (px); with all of them unfolded it was 16 700."""


@pytest.mark.slow
def test_a_report_is_short_until_its_details_are_unfolded(sized: Any, long_run: trb.Result, tmp_path: Path) -> None:
    page = trb.report(long_run, tmp_path / "all.html")
    set_width(sized, 1200)
    sized.open(page)
    folded = sized.js("document.documentElement.scrollHeight")
    assert 1000 < folded < TALLEST
    sized.js(UNFOLD)
    assert sized.js("document.documentElement.scrollHeight") > 2 * folded


def set_width(browser: Any, width: int, height: int = 800) -> None:
    browser.call(
        "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500
    )


@pytest.fixture
def sized(browser: Any) -> Any:
    yield browser
    set_width(browser, *browser.size)


@pytest.mark.parametrize("width", WIDTHS)
def test_the_report_is_no_wider_than_the_page(sized: Any, pages: tuple[Path, Path], width: int) -> None:
    for page in pages:
        set_width(sized, width)
        sized.open(page)
        sized.js(UNFOLD)
        assert sized.js("document.documentElement.scrollWidth") <= width
        assert sized.js("document.documentElement.clientWidth") == width  # not a wider page that is shown smaller
        # no cell sticks out of its table, and a name stands beside its value
        assert sized.js(
            "[...document.querySelectorAll('td, th, dd, img, .card')].every("
            "(part) => part.getBoundingClientRect().right <= innerWidth + 1)"
        )
        beside = sized.js(
            "[...document.querySelectorAll('tr')].filter((row) => row.querySelector('td.number')).every((row) =>"
            "Math.abs(row.querySelector('td.q').getBoundingClientRect().top"
            " - row.querySelector('td.number').getBoundingClientRect().top) < 2)"
        )
        assert beside


def test_sentences_stand_below_the_table(long_run: trb.Result, pages: tuple[Path, Path]) -> None:
    text = pages[0].read_text(encoding="utf-8")
    values = long_run.summary()
    assert values["confidence_note"]
    table, _, below = text.partition("<summary>All numbers")[2].partition("</table>")
    for name in ("confidence_note", "torque_note", "settling_reason"):
        assert values[name], name
        said = values[name][1:40].replace("'", "&#x27;")
        assert said not in table
        assert said in below
    longest = max(map(len, re.findall(r"<td class='n[^>]*>(.*?)</td>", table)))
    assert longest < 30


@pytest.mark.skipif(converter() is None, reason="no Chromium is installed: apt-get install chromium")
def test_values_stand_in_the_pdf(long_run: trb.Result, pages: tuple[Path, Path], tmp_path: Path) -> None:
    from pypdf import PdfReader

    save_pdf(pages[0], tmp_path / "r.pdf")
    found: list[str] = []
    for page in PdfReader(tmp_path / "r.pdf").pages:
        text, begins = _text(page)
        found += text.split()
        assert max(begins, default=0.0) < float(page.mediabox.width)  # it lies on the paper, not beside it
    text = " ".join(found)
    values = long_run.summary()
    widths = values["confidence"] or {}
    for name in ("torque", "orbit_rms_over_cpr", "pocket_force_peak", "power_loss", "cage_speed_ratio"):
        shown = f"{values[name]:.4g}" + (f" ± {widths[name]:.2g}" if name in widths else "")
        assert shown in text, (name, shown)
        assert TABLE[name].words.split()[0] in text
    for name in ("torque_note", "confidence_note"):
        assert values[name][1:20] in text


def _text(page: Any) -> tuple[str, list[float]]:
    """Text of a page, and where its parts begin, from the left edge."""
    places: list[float] = []

    def note(text: str, cm: list[float], tm: list[float], *_: Any) -> None:
        if text.strip():
            places.append(cm[0] * tm[4] + cm[4])

    return page.extract_text(visitor_text=note), places


READY = "window.trbView && document.getElementById('message').textContent == ''"


@pytest.mark.parametrize("width", WIDTHS)
def test_the_view_fits_and_its_words_do_not_cover_each_other(sized: Any, view_page: Path, width: int) -> None:
    set_width(sized, width)
    sized.open(view_page, READY)
    sized.frame()
    assert sized.js("document.documentElement.scrollWidth") <= width
    box = "(({left, right, top, bottom}) => [left, right, top, bottom])(document.getElementById('NAME').getBoundingClientRect())"
    names = ("about", "scale", "factor-note", "canvas", "clock", "play")
    boxes = {name: sized.js(box.replace("NAME", name)) for name in names}
    for left, right, top, bottom in boxes.values():
        assert 0 <= left < right <= width
        assert 0 <= top < bottom <= 800
    words = (
        "about",
        "scale",
        "factor-note",
        *(("canvas",) if width < 500 else ()),
    )  # on a phone not on the picture either
    for k, one in enumerate(words):
        for other in words[k + 1 :]:
            a, b = boxes[one], boxes[other]
            assert a[1] <= b[0] or b[1] <= a[0] or a[3] <= b[2] or b[3] <= a[2], (one, other)
    assert sized.errors == []


@pytest.fixture(scope="module")
def view_page(long_run: trb.Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("view") / "view.html"
    trb.view(long_run, path, max_frames=200)
    return path


def test_the_view_says_what_it_shows(browser: Any, view_page: Path) -> None:
    browser.open(view_page, READY)
    browser.frame()
    assert "the last 10 of 60 turns of the shaft are shown, so that" in browser.js(
        "document.getElementById('about').textContent"
    )
    legend = "document.getElementById('arrow-legend')"
    assert browser.js(f"{legend}.hidden")
    browser.js("trbView.setSwitch('arrows', true)")
    browser.frame()
    assert not browser.js(f"{legend}.hidden")
    said = browser.js(f"{legend}.textContent")
    largest = browser.js(
        "Math.max(...trbView.head.bearings[0].quantities.filter((q) => /^(outer|inner)_load$/.test(q.name))"
        ".map((q) => q.values.high))"
    )
    assert f"the longest {largest:.4g} N" in said
    assert f"as long as a roller is thick is {largest / 1.1:.4g} N" in said
    assert "forces of the rollers on the cage" in said
    assert browser.js(f"{legend}.querySelectorAll('i').length") == 3
    # the orbit of the cage is drawn, and can be hidden
    assert "the circle is the radial play, 0.25 mm" in browser.js("document.getElementById('trail-legend').textContent")
    browser.js("trbView.setSwitch('arrows', false); trbView.setCamera('axis')")
    browser.frame()
    with_trail = browser.picture()
    browser.js("trbView.setSwitch('trail', false)")
    browser.frame()
    assert (abs(with_trail - browser.picture()).max(axis=-1) > 0.03).mean() > 5e-4
    # loads of rollers that are all nearly alike: said so
    browser.js("var m = document.getElementById('mode'); m.value = 'outer_load'; m.dispatchEvent(new Event('change'))")
    browser.frame()
    assert "all within" in browser.js("document.querySelector('#scale .said').textContent")
