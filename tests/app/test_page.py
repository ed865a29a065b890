"""The page as a newcomer meets it, in a browser."""

from __future__ import annotations

import os
import re
import time
from pathlib import Path
from typing import Any

import pytest

import trbdyn as trb

PAGE = {
    "page.name": "32208",
    "page.bore": "40",
    "page.outside": "80",
    "page.width": "24.75",
    "page.C": "74.8",
    "page.e": "0.37",
}


def opened(user: Any, server: Any) -> None:
    user.browser.go(server.address_for(user.browser), "window.trbReady && document.querySelector('[data-path=source]')")
    server.opened.setdefault(id(user.browser), user.browser.js("location.origin + location.pathname"))


def ready(user: Any) -> None:
    """A bearing that ships, under a load."""
    user.choose("source", "30310 (ships")
    user.type("scene.speed_rpm", "3000")
    user.type("scene.axial_load", "4930")
    user.says("inputs complete")


def finished(user: Any, seconds: float = 240.0) -> None:
    user.browser.wait("document.querySelector('[data-path=said]').textContent.match(/(done|stopped|failed):/)", seconds)


EVIL = "32208 <img src=x onerror='window.hit=1'><script>window.hit=1</script>"


def test_from_a_catalogue_page_to_a_report(user: Any, server: Any, tmp_path: Path) -> None:
    """The name of the bearing is a stranger's: it stays a name on the page, in the report and in the view."""
    began = time.monotonic()
    opened(user, server)
    user.choose("source", "catalogue")
    for path, text in {**PAGE, "page.name": EVIL}.items():
        user.type(path, text)
    user.type("scene.speed_rpm", "2000")
    user.type("scene.axial_load", "2.5 kN")
    user.click("tab.bearing")
    user.says("Estimated: type what you know better")
    user.click("tab.run")
    user.type("run.revolutions", "3")
    user.click("run")
    finished(user)
    assert "done: reached" in user.text("said")
    script = user.browser.js("document.querySelector('[data-path=script]').textContent")
    user.click("tab.results")
    user.browser.wait("document.querySelector('iframe[data-path=view]')")
    assert user.actions < 20
    assert time.monotonic() - began < 180.0
    assert user.browser.errors == []
    outside = [one for one in user.browser.requests if not one.startswith((server.base, "data:", "blob:", "about:"))]
    assert outside == []  # nothing leaves this machine
    assert user.browser.js("window.hit === undefined")
    assert not user.browser.js("document.querySelector('img[src=x]')")
    # the Python that the page shows gives the same numbers
    folder = next((server.folder / "runs").iterdir())
    assert "Report" in (folder / "report.html").read_text()
    names: dict[str, Any] = {}
    text = script.replace('"run.h5"', repr(str(tmp_path / "run.h5"))).partition("print(")[0]
    exec(text, names)
    of_page = trb.load(folder / "run.h5")
    assert of_page.scene == names["result"].scene
    for name in ("torque", "orbit_rms_over_cpr", "power_loss", "outer_load_mean"):
        assert of_page.summary()[name] == names["result"].summary()[name], name
    assert re.fullmatch(r"0001-[\w-]+", folder.name)
    for name in ("report.html", "view.html"):
        user.browser.go((folder / name).as_uri())
        assert user.browser.js("window.hit === undefined"), name


WRONG = [
    ("start", "page.bore", "0.085", "0.085 mm: must be from 2 to 5000 mm", "40"),
    ("start", "page.C", "74800", "must be from 51.7 to 147 kN", "74.8"),
    ("start", "page.e", "0,37", "with a point in place of the comma", "0.37"),
    ("start", "page.outside", "abc", "must be a number, for instance 12.5 mm", "80"),
    ("start", "page.width", "24.75 kN", "must be in mm or inch", "24.75"),
    ("start", "scene.speed_rpm", "1e12", "must be from -1000000 to 1000000 rpm", "2000"),
    ("start", "scene.axial_load", "0", "0 N: must be > 0 N", "2500"),
    ("operation", "lubricant.temperature_c", "343", "343 C: must be from -20 to 200 C", "60"),
    ("operation", "scene.misalignment_x", "1000", "1000 mrad: must be from -87.27 to 87.27 mrad", ""),
    ("run", "run.revolutions", "0", "must be > 0", "2"),
]
"""Tab, field, what is wrong, what is said, what is right."""


@pytest.mark.slow
def test_ten_wrong_inputs_are_red_at_their_fields(user: Any, server: Any) -> None:
    """One after another: in the units of the page, at the field that was just typed, and correct input clears it. A tab is in the
    address, so that a reload and the browser's button back come to tabs.
    """
    opened(user, server)
    user.choose("source", "catalogue")
    for path, text in {**PAGE, "scene.speed_rpm": "2000", "scene.axial_load": "2500"}.items():
        user.type(path, text)
    user.says("inputs complete")
    reds = "[...document.querySelectorAll('.q-field--error [data-path]')].map((one) => one.dataset.path)"
    before = "start"
    for tab, path, wrong, said, right in WRONG:
        if tab != before:
            user.click(f"tab.{tab}")
            before = tab
        if path == "scene.misalignment_x":
            user.click("fold.scene.outer_speed_rpm")
        user.type(path, wrong)
        user.browser.wait(f"{reds}.join() == {path!r}")
        field = f"document.querySelector('[data-path=\"{path}\"]').closest('.q-field')"
        assert said in user.browser.js(f"{field}.textContent"), path
        assert user.browser.js("document.querySelector('[data-path=run]').disabled")
        user.type(path, right)
        user.browser.wait("!document.querySelector('.q-field--error')")
    user.says("inputs complete")
    for units in ("m", "N", "deg"):  # lists have a name for a reader of the screen
        assert user.browser.js(f"document.querySelector('[data-path=\"unit.{units}\"]').outerHTML").count("unit of")
    assert user.browser.js("location.hash") == "#run"
    user.browser.js("window.old = true")
    user.browser.call("Page.reload")
    user.browser.wait("!window.old && window.trbReady")
    user.browser.wait("document.querySelector('[data-path=\"run.revolutions\"]')?.getBoundingClientRect().height > 0")
    user.browser.js("history.back()")
    user.browser.wait(
        "document.querySelector('[data-path=\"lubricant.temperature_c\"]')?.getBoundingClientRect().height > 0"
    )
    assert user.browser.errors == []


JOURNEYS: dict[str, tuple[str, dict[str, str], str]] = {
    "32208": ("one bearing", {"named.designation": "32208", "scene.speed_rpm": "2000", "scene.axial_load": "2.5 kN"}, ""),
    "gear": (
        "two bearings on a shaft with a gear",
        {"named.designation": "32208", "pair.other": "32207", "scene.speed_rpm": "1500", "gear.torque": "200",
         "gear.pitch_diameter": "80", "gear.helix_angle_deg": "15", "pair.spread": "120"},
        "name;share;speed;torque\nidle;80,5;800;50\nfull;19,5;1500;250\n",
    ),
    "wheel": (
        "a wheel hub",
        {"named.designation": "32210", "pair.other": "32008", "scene.outer_speed_rpm": "800", "wheel.load": "6 kN",
         "wheel.rolling_radius": "320", "wheel.cornering": "0.1", "pair.spread": "80", "pair.end_play": "-0.01"},
        "",
    ),
}  # fmt: skip
"""What turns, what is typed, and a spectrum that is pasted."""


@pytest.mark.slow
@pytest.mark.parametrize("name", JOURNEYS)
def test_from_nothing_to_a_signed_sheet(user: Any, server: Any, name: str) -> None:
    turns, typed, spectrum = JOURNEYS[name]
    assert len(typed) + 1 + bool(spectrum) <= 12
    opened(user, server)
    user.browser.wait("document.querySelector('[data-path=machine]')")
    entry = f"[...document.querySelectorAll('[data-path=machine] .q-radio')].find((one) => one.textContent.includes({turns!r}))"
    user._press(entry)
    path = list(typed)[-1]  # which only what was chosen asks for
    user.browser.wait(f"document.querySelector('[data-path=\"{path}\"]')")
    for path, text in typed.items():
        user.type(path, text)
    if spectrum:
        user.click("tab.operation")
        user.click("fold.spectrum")
        user.type("spectrum", spectrum)
    user.click("tab.run")
    user.type("run.revolutions", "0.2")
    user.says("inputs complete")
    user.click("run")
    finished(user, 600.0)
    assert "done: reached" in user.text("said")
    user.click("tab.results")
    user.browser.wait("document.querySelector('[data-path=verdict]')")
    user.click("make.pdf")
    user.browser.wait("document.querySelector('[data-path=\"file.report.pdf\"]')", 120.0)
    folder = next((server.folder / "runs").iterdir())
    assert (folder / "report.pdf").read_bytes().startswith(b"%PDF")
    report = (folder / "report.html").read_text()
    assert "signature" in report
    assert ("idle" in report) == bool(spectrum)
    assert user.browser.errors == []


@pytest.mark.slow
def test_a_run_can_be_stopped_and_survives_the_browser(user: Any, shared: Any) -> None:
    opened(user, shared)
    ready(user)
    user.click("tab.run")
    user.type("run.revolutions", "1000000")
    user.click("run")
    user.browser.wait("/ m?s of /.test(document.querySelector('[data-path=said]').textContent)")
    user.browser.call("Page.navigate", url="about:blank")
    opened(user, shared)  # what was typed and the run are still there
    user.click("tab.run")
    user.browser.wait("document.querySelector('[data-path=\"run.revolutions\"]')?.value == '1000000'")
    assert "run: " in user.text("said")
    user.click("stop")
    finished(user)
    assert "run stopped: stopped by the user" in user.text("said")
    (path,) = (shared.folder / "runs").glob("*/run.h5")
    assert len(trb.load(path)) > 1  # what was recorded is kept
    assert shared.process.poll() is None


@pytest.mark.slow
def test_stop_while_a_report_is_drawn(user: Any, shared: Any) -> None:
    """The run has ended by then: its report is drawn to its end."""
    opened(user, shared)
    ready(user)
    user.click("tab.run")
    user.type("run.revolutions", "0.05")
    before = {path.name for path in (shared.folder / "runs").iterdir()}
    user.click("run")
    user.browser.wait("/(drawing|view|report)$/.test(document.querySelector('[data-path=said]').textContent)")
    user.click("stop")
    finished(user)
    assert "done: reached" in user.text("said")
    (name,) = {path.name for path in (shared.folder / "runs").iterdir()} - before
    assert "Report" in (shared.folder / "runs" / name / "report.html").read_text()


@pytest.mark.slow
def test_two_tabs_show_the_same(user: Any, other_tab: Any, server: Any) -> None:
    for tab in (user, other_tab):
        opened(tab, server)
    ready(user)
    user.type("scene.speed_rpm", "1234")
    value = "document.querySelector('[data-path=\"scene.speed_rpm\"]').value"
    other_tab.browser.wait(f"{value} == '1234'")
    other_tab.type("scene.speed_rpm", "0.5e3")
    user.browser.wait(f"{value} == '0.5e3'")
    other_tab.click("tab.run")
    user.click("tab.run")
    other_tab.type("run.revolutions", "1")
    other_tab.click("run")
    for tab in (user, other_tab):
        finished(tab)
        assert "done: reached" in tab.text("said")
    assert user.browser.errors == other_tab.browser.errors == []


@pytest.mark.parametrize("width", [480, pytest.param(1280, marks=pytest.mark.slow)])
def test_nothing_is_wider_than_the_page(user: Any, shared: Any, width: int) -> None:
    browser = user.browser
    browser.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500)
    try:
        opened(user, shared)
        for name in ("operation", "effects", "run", "results", "compare", "sweep", "bearing", "start"):
            user.click(f"tab.{name}")
            browser.frame()
            assert browser.js("document.documentElement.scrollWidth") <= width, name
            if folder := os.environ.get("TRB_SHOW_PAGES"):
                browser.picture(Path(folder) / f"{name}_{width}.png")
    finally:
        size = browser.size
        browser.call(
            "Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False
        )
