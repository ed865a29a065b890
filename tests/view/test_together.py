"""Bearings on one shaft: their 3-D view and their report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.results.assembly import AssemblyResult


@pytest.fixture(scope="module")
def pair() -> AssemblyResult:
    return trb.Simulation(trb.load_assembly("pair_30310")).run(revolutions=0.5)


def test_the_bearings_stand_on_their_shaft(pair: AssemblyResult, browser: Any, tmp_path: Path) -> None:
    """Rollers are drawn where the records have them, in the axes of the shaft; one scale of colours holds for both bearings."""
    path = tmp_path / "pair.html"
    trb.view(pair, path, max_frames=20, title="A pair", exaggeration=1.0)
    browser.open(path, "window.trbView && trbView.drawn() > 0")
    assert pair.assembly is not None
    low = min(one.rollers_reach[0] for one in pair.assembly.bearings)
    middle = 0.5 * (low + max(one.rollers_reach[1] for one in pair.assembly.bearings))
    index = np.linspace(0, len(pair["left"]) - 1, 20).round().astype(int)
    for frame in (0, 13):
        browser.js(f"trbView.setPlace({frame}); trbView.draw()")
        for k, (one, at) in enumerate(zip(pair.values(), pair.assembly.bearings, strict=True)):
            count = one.scene.bearing.n_rollers
            shown = np.array(browser.js(f"[...Array({count}).keys()].map((i) => trbView.placeOfRoller(i, {k}))"))
            own = one.roller_position[index[frame]] - [0.0, 0.0, one.scene.bearing.geometry.centre_plane]
            place = np.array([1.0, -at.side, -at.side]) * own + [0.0, 0.0, at.centre_plane - middle]
            assert shown == pytest.approx(1e3 * place, abs=2e-4)
    assert "left: 30310, mean Fa" in browser.js("document.getElementById('about').textContent")
    loads = [one.outer_load[index] for one in pair.values()]
    browser.js("var m = document.getElementById('mode'); m.value = 'outer_load'; m.dispatchEvent(new Event('change'))")
    browser.js("trbView.draw()")
    ends = browser.js("[...document.querySelectorAll('#scale .ends span')].map((end) => Number(end.textContent))")
    assert ends[0] == pytest.approx(min(load.min() for load in loads), rel=0.02, abs=1.0)
    assert ends[2] == pytest.approx(max(load.max() for load in loads), rel=0.02)
    assert not browser.errors
    assert not [address for address in browser.requests if address.startswith("http")]


@pytest.mark.slow
def test_a_roller_of_either_bearing_is_picked_and_the_shaft_hidden(
    pair: AssemblyResult, browser: Any, tmp_path: Path
) -> None:
    path = tmp_path / "pair.html"
    trb.view(pair, path, max_frames=10)
    browser.open(path, "window.trbView && trbView.drawn() > 0")
    for k, name in enumerate(pair):
        browser.js(f"trbView.pick({{ bearing: {k}, kind: 'roller', index: 3 }}); trbView.draw()")
        assert browser.js("document.querySelector('#picked h3').textContent") == f"Roller 3 of {name}"
        shown = float(browser.js("document.querySelector('#picked td:last-child').textContent").removesuffix(" N"))
        assert shown == pytest.approx(pair[name].outer_load[0, 3], rel=2e-3, abs=0.1)
    browser.frame()
    before = browser.picture()
    browser.js("trbView.setSwitch('shaft', false)")
    browser.frame()
    assert (np.abs(before - browser.picture()).max(axis=-1) > 0.03).mean() > 0.005
    unknown = AssemblyResult(dict(pair))
    with pytest.raises(trb.InputError, match="to say where the bearings sit on the shaft"):
        trb.view(unknown)


def test_the_report_has_the_shaft_and_each_bearing(pair: AssemblyResult, browser: Any, tmp_path: Path) -> None:
    path = trb.report(pair, tmp_path / "pair.html", pictures=["shaft_drawing", "bearing_loads", "cage_locus"])
    for width in (420, 1000, 1400):
        browser.call("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=False)
        browser.open(path)
        assert browser.js("document.documentElement.scrollWidth") <= width
    heads = browser.js("[...document.querySelectorAll('h1, h2')].map((head) => head.textContent)")
    assert [one for one in heads if one in ("The bearings side by side", "Lives")] == [
        "The bearings side by side",
        "Lives",
    ]
    assert heads[0] == "Report: left, right on one shaft"
    assert [head for head in heads if head.startswith("Bearing ")] == ["Bearing left", "Bearing right"]
    # two of the shaft; section, pocket and locus of each bearing
    assert browser.js("document.querySelectorAll('img').length") == 8
    assert browser.js("[...document.querySelectorAll('img')].every((one) => one.naturalWidth > 100)")


@pytest.mark.slow
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
