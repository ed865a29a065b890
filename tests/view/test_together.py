"""Bearings on one shaft: one page with a view of each, which keep step; and their report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.results.assembly import AssemblyResult


@pytest.fixture(scope="module")
def pair() -> AssemblyResult:
    return trb.AssemblySimulation(trb.load_assembly("pair_30310")).run(revolutions=0.5)


def test_the_views_keep_step(pair: AssemblyResult, browser: Any, tmp_path: Path) -> None:
    """The time of one is that of the other, whichever is moved, and also while one plays."""
    path = tmp_path / "pair.html"
    trb.view(pair, path, max_frames=20, title="A pair")
    browser.open(path, "window.trbViews && trbViews().every((view) => view && view.drawn() > 0)")
    assert browser.js("trbViews().map((view) => view.head.frames)") == [20, 20]
    assert "mean Fa" in browser.js("trbViews()[0].head.loads")
    for moved, other in ((0, 1), (1, 0)):
        browser.frame()
        browser.js(f"trbViews()[{moved}].setPlace({5.0 + moved})")
        browser.wait(f"Math.abs(trbViews()[{other}].state.place - {5.0 + moved}) < 1e-9")
    browser.js("document.querySelectorAll('iframe')[1].contentDocument.getElementById('play').click()")
    browser.wait("trbViews()[0].state.place > 6.5")
    assert not browser.errors
    assert not [address for address in browser.requests if address.startswith("http")]


def test_the_report_has_the_shaft_and_each_bearing(pair: AssemblyResult, browser: Any, tmp_path: Path) -> None:
    path = trb.report(pair, tmp_path / "pair.html", pictures=["shaft_drawing", "bearing_loads", "cage_locus"])
    for width in (420, 1000, 1400):
        browser.call("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=False)
        browser.open(path)
        assert browser.js("document.documentElement.scrollWidth") <= width
    heads = browser.js("[...document.querySelectorAll('h1, h2')].map((head) => head.textContent)")
    assert heads[:3] == ["Report: left, right on one shaft", "The bearings side by side", "The shaft"]
    assert [head for head in heads if head.startswith("Bearing ")] == ["Bearing left", "Bearing right"]
    # two of the shaft; section, pocket and locus of each bearing
    assert browser.js("document.querySelectorAll('img').length") == 8
    assert browser.js("[...document.querySelectorAll('img')].every((one) => one.naturalWidth > 100)")


def test_pictures_go_into_a_folder_for_each_bearing(pair: AssemblyResult, tmp_path: Path) -> None:
    written = trb.plot.all(
        pair, tmp_path, ["shaft_orbits", "load_zones", "preload_diagram", "shaft_motion", "ring_orbit"]
    )
    assert sorted(str(path.relative_to(tmp_path)) for path in written) == [
        "left/ring_orbit.png",
        "load_zones.png",
        "preload_diagram.png",
        "right/ring_orbit.png",
        "shaft_motion.png",
        "shaft_orbits.png",
    ]
    with pytest.raises(trb.InputError, match="unknown"):
        trb.report(pair, tmp_path / "x.html", pictures=["shaft_orbit"])
