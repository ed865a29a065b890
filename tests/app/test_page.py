"""The page as a newcomer meets it, in a browser."""

from __future__ import annotations

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
    user.browser.go(server.address, "document.querySelector('[data-path=source]')")


def finished(user: Any, seconds: float = 60.0) -> None:
    user.browser.wait("document.querySelector('[data-path=said]').textContent.match(/(done|stopped|failed):/)", seconds)


EVIL = "32208 <img src=x onerror='window.hit=1'><script>window.hit=1</script>"


def test_from_a_catalogue_page_to_a_report(user: Any, server: Any, tmp_path: Path) -> None:
    """The name of the bearing is a stranger's: it stays a name on the page, in the report and in the view."""
    began = time.monotonic()
    opened(user, server)
    user.choose("source", "catalogue")
    for path, text in {**PAGE, "page.name": EVIL}.items():
        user.type(path, text)
    user.says("Estimated: type what you know better")
    user.click("tab.operation")
    user.type("scene.speed_rpm", "2000")
    user.type("scene.axial_load", "2.5 kN")
    user.click("tab.run")
    user.type("run.revolutions", "3")
    user.click("run")
    finished(user)
    assert "done: reached" in user.text("said")
    script = user.browser.js("document.querySelector('[data-path=script]').textContent")
    user.click("tab.results")
    user.browser.wait("document.querySelector('iframe[data-path=view]')")
    assert user.actions < 20
    assert time.monotonic() - began < 60.0
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


def test_a_wrong_unit_is_said_at_its_field(user: Any, shared: Any) -> None:
    opened(user, shared)
    user.choose("source", "catalogue")
    for path, text in {**PAGE, "page.bore": "0.04"}.items():
        user.type(path, text)
    field = "document.querySelector('[data-path=\"page.bore\"]').closest('.q-field')"
    user.browser.wait(f"{field}.classList.contains('q-field--error')")
    assert "50 mm is 0.05" in user.browser.js(f"{field}.textContent")
    assert user.browser.js("document.querySelectorAll('.q-field--error').length") == 1
    user.click("tab.run")
    assert user.browser.js("document.querySelector('[data-path=run]').disabled")
    user.click("tab.bearing")
    user.type("page.bore", "40")
    user.browser.wait("!document.querySelector('.q-field--error')")


def test_a_run_can_be_stopped_and_survives_the_browser(user: Any, shared: Any) -> None:
    opened(user, shared)
    user.click("tab.run")
    user.type("run.revolutions", "1000000")
    user.click("run")
    user.browser.wait("/ ms of /.test(document.querySelector('[data-path=said]').textContent)")
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
def test_two_tabs_show_the_same(user: Any, other_tab: Any, server: Any) -> None:
    for tab in (user, other_tab):
        opened(tab, server)
        tab.click("tab.operation")
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


@pytest.mark.parametrize("width", [420, 1400])
def test_nothing_is_wider_than_the_page(user: Any, shared: Any, width: int) -> None:
    browser = user.browser
    browser.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500)
    try:
        opened(user, shared)
        for name in ("operation", "effects", "run", "results", "compare", "sweep", "bearing"):
            user.click(f"tab.{name}")
            browser.frame()
            assert browser.js("document.documentElement.scrollWidth") <= width, name
    finally:
        size = browser.size
        browser.call(
            "Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False
        )
