"""The 3-D view, judged by what a browser draws."""

from __future__ import annotations

import json
import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import trbdyn as trb
from trbdyn.model.outlines import cup_outline
from trbdyn.viewer import View, frames_that_fit
from trbdyn.viewer.data import Quantity, frames, largest_between
from trbdyn.viewer.fit import largest_factor
from trbdyn.viewer.page import colour_range
from trbdyn.viewer.shapes import shapes

READY = "window.trbView"
CANVAS = (slice(60, 640), slice(10, 890))


@pytest.fixture(scope="module")
def page(whirling: trb.Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("view") / "run.html"
    trb.view(whirling, path, revolutions=None, max_frames=120)
    return path


def different(one: Any, other: Any) -> float:
    """Share of pixels that differ."""
    return float((np.abs(one - other).max(axis=-1) > 0.03).mean())


# ---- in a browser ----


def test_it_draws_a_bearing(browser: Any, page: Path) -> None:
    browser.open(page, READY)
    browser.frame()
    seen = browser.picture()[CANVAS]
    background = seen[0, 0]
    assert 0.25 < (np.abs(seen - background).max(axis=-1) > 0.03).mean() < 0.9
    assert np.unique((seen.reshape(-1, 3) * 15).astype(int), axis=0).shape[0] > 30
    assert browser.js("document.getElementById('message').textContent") == ""
    assert browser.errors == []
    # hiding a part changes what is drawn, and the rest stays
    for part in ("outer", "inner", "rollers", "cage"):
        browser.js(f"trbView.setSwitch('{part}', false)")
        browser.frame()
        assert 0.01 < different(seen, browser.picture()[CANVAS]) < 0.9, part
        browser.js(f"trbView.setSwitch('{part}', true)")
    browser.frame()
    assert different(seen, browser.picture()[CANVAS]) < 0.001


def test_it_needs_no_network(browser: Any, page: Path) -> None:
    browser.open(page, READY)
    browser.frame()
    assert {address.partition(":")[0] for address in browser.requests} <= {"file", "about", "data", "blob"}
    assert not re.search(r"""(src|href)=["']?(https?:)?//""", page.read_text())


def test_it_plays_pauses_and_goes_to_a_time(browser: Any, page: Path) -> None:
    browser.open(page, READY)
    browser.frame()
    before, clock = browser.picture(), browser.js("document.getElementById('clock').textContent")
    browser.js(
        "document.getElementById('speed').value = '1'; document.getElementById('speed').dispatchEvent(new Event('change'))"
    )
    browser.js("document.getElementById('play').click()")
    browser.wait("trbView.state.place > 5")
    browser.js("document.getElementById('play').click()")
    browser.frame()
    assert browser.js("document.getElementById('clock').textContent") != clock
    after = browser.picture()
    assert different(before[CANVAS], after[CANVAS]) > 0.01
    place = browser.js("trbView.state.place")
    browser.frame()
    assert browser.js("trbView.state.place") == place  # it stands still while paused
    browser.js("const s = document.getElementById('time'); s.value = 119; s.dispatchEvent(new Event('input'))")
    browser.frame()
    assert browser.js("document.getElementById('clock').textContent").endswith("turn 3.00 of the shaft")


def test_the_cage_stands_still_in_its_own_view(browser: Any, page: Path) -> None:
    browser.open(page, READY)
    browser.js("trbView.setSwitch('follow', true)")
    browser.frame()
    start = np.array(browser.js("trbView.whereIsRoller(0)"))
    browser.js("trbView.setPlace(60)")
    browser.frame()
    followed = np.linalg.norm(np.array(browser.js("trbView.whereIsRoller(0)")) - start)
    browser.js("trbView.setSwitch('follow', false)")
    browser.frame()
    free = np.linalg.norm(np.array(browser.js("trbView.whereIsRoller(0)")) - start)
    assert followed < 15 < 60 < free


def test_a_click_shows_a_roller_with_its_numbers(browser: Any, page: Path, whirling: trb.Result) -> None:
    browser.open(page, READY)
    browser.js(
        "trbView.setSwitch('outer', false); trbView.setSwitch('cage', false); trbView.setCamera('side'); trbView.setPlace(0)"
    )
    browser.frame()
    places = np.array(browser.js("[...Array(12).keys()].map(trbView.whereIsRoller)"))
    nearest = int(np.argmax(whirling.roller_position[0, :, 0]))  # the camera looks from +x
    browser.click(*places[nearest])
    assert browser.js("document.querySelector('#picked h3').textContent") == f"Roller {nearest}"
    rows = dict(
        browser.js(
            "[...document.querySelectorAll('#picked tr')].map((r) => [r.cells[0].textContent, r.cells[1].textContent])"
        )
    )
    shown = float(rows["load on the outer raceway"].removesuffix(" N"))
    assert shown == pytest.approx(whirling.outer_load[0, nearest], rel=2e-3)
    ink = browser.js(
        "(() => { const c = document.getElementById('history');"
        "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        "let n = 0; for (let k = 3; k < d.length; k += 4) n += d[k] > 0; return n; })()"
    )
    assert ink > 1000
    browser.click(20, 600)
    assert browser.js("document.querySelector('#picked h3')") is None


def test_a_click_shows_a_face_of_a_pocket(browser: Any, page: Path) -> None:
    browser.open(page, READY, "#outer=0&inner=0&rollers=0&mode=pocket_force")
    browser.js("trbView.setCamera('pocket')")
    browser.frame()
    places = [(x, y) for x in range(200, 700, 25) for y in range(200, 560, 25)]
    found = None
    for x, y in sorted(places, key=lambda place: math.hypot(place[0] - 325, place[1] - 300)):
        browser.click(x, y)
        found = browser.js("document.querySelector('#picked h3')?.textContent")
        if found:
            break
    assert found is not None
    assert re.match(r"Pocket \d+, (leading bar|trailing bar|large end wall|small end wall)$", found)
    assert browser.js("document.getElementById('history-note').textContent").endswith("largest since the frame before.")


def test_colours_follow_the_choice_and_the_factor_is_always_said(browser: Any, page: Path) -> None:
    browser.open(page, READY, "#place=0.5&outer=0")
    browser.js("trbView.setSwitch('arrows', false)")
    pictures = []
    for mode in ("outer_load", "pressure_along", "slip", "outer_film_parameter", "pocket_force"):
        browser.js(
            f"const m = document.getElementById('mode'); m.value = '{mode}'; m.dispatchEvent(new Event('change'))".replace(
                "const m", "var m"
            )
        )
        browser.frame()
        pictures.append(browser.picture()[CANVAS])
        label = browser.js(f"trbView.head.bearings[0].quantities.find((q) => q.name == '{mode}').label")
        assert label in browser.js("document.getElementById('scale').textContent")
    for one, other in pairwise(pictures):
        assert different(one, other) > 0.01
    for factor in (1, 5, 20):
        browser.js(f"trbView.setFactor({factor})")
        browser.frame()
        said = browser.js("document.getElementById('factor-note').textContent")
        drawn = min(
            factor, browser.js("trbView.head.largest_factor")
        )  # the slider ends where the cage would leave the cup
        assert f"drawn {drawn:.4g} times" in said if factor > 1 else "true to scale" in said
    browser.js("trbView.setSwitch('arrows', true)")
    before = browser.picture()[CANVAS]
    browser.frame()
    assert different(before, pictures[-1]) > 0.002


def test_another_bearing(browser: Any, tmp_path: Path) -> None:
    """A bearing that nobody tuned the view to: more rollers, a pocket of its own, turning backwards, no records of
    contacts.
    """
    bearing = trb.cases.rig_30310()
    bearing = bearing.replace(n_rollers=17, pitch_diameter=0.11)
    bearing = bearing.replace(cage=bearing.cage.replace(pocket=trb.pocket_shapes.stepped_pocket(bearing)))
    scene = trb.Scene(bearing, speed_rpm=-800.0, axial_load=900.0)
    result = trb.Simulation(scene).run(revolutions=0.3, save_groups=("cage", "rollers"))
    trb.view(result, tmp_path / "v.html", title="<b>17 & more</b>")
    browser.open(tmp_path / "v.html", READY)
    browser.frame()
    assert browser.errors == []
    assert browser.js("document.querySelector('#about b').textContent") == "<b>17 & more</b>"
    seen = browser.picture()[CANVAS]
    assert (np.abs(seen - seen[0, 0]).max(axis=-1) > 0.03).mean() > 0.2


def test_the_cup_moves_with_its_housing(browser: Any, tmp_path: Path) -> None:
    housing = trb.Housing.hollow_cylinder(mass=4.0, inner_diameter=0.11, outer_diameter=0.16, length=0.05)
    housing = housing.replace(support_radial=2e7, support_axial=2e7, support_tilt=1e5, damping=500.0)
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0, radial_load=1000.0, housing=housing)
    result = trb.Simulation(scene).run(revolutions=0.3, save_every=1e-4)
    trb.view(result, tmp_path / "v.html")
    browser.open(tmp_path / "v.html", READY)
    browser.frame()
    browser.js("trbView.setFactor(100); trbView.setPlace(40); trbView.draw()")
    browser.frame()
    shown = np.array(browser.js("trbView.cup()"))
    place = result["housing_position"][40]
    assert np.abs(place).max() > 1e-10
    assert shown == pytest.approx(browser.js("trbView.state.factor") * 1e3 * place, rel=1e-3, abs=1e-7)
    assert browser.errors == []
    trb.viewer.save_gltf(result, tmp_path / "v.glb")


def test_no_cage(browser: Any, tmp_path: Path) -> None:
    effects = trb.Effects.paper().replace(bodies="rollers")
    result = trb.Simulation(trb.cases.scene_30310(1000.0, 3000.0, effects=effects)).run(revolutions=0.3)
    trb.view(result, tmp_path / "v.html")
    browser.open(tmp_path / "v.html", READY)
    browser.frame()
    assert browser.errors == []
    assert not browser.js("trbView.head.bearings[0].has_cage")
    assert browser.js("document.getElementById('switch-cage')") is None


# ---- without a browser ----


def test_a_gap_is_drawn_closed_where_it_is_closed(whirling: trb.Result) -> None:
    """To first order: a cage moved by its circumferential play touches, drawn at any factor."""
    bearing = whirling.scene.bearing
    made = shapes(bearing, np.linspace(-0.5, 0.5, 9) * bearing.roller.effective_length)
    face = next(face for face in made.faces if face.pocket == 0 and face.name == "trailing_bar")
    gap = bearing.pocket.gaps(bearing.geometry)["trailing_bar"]
    assert np.linalg.norm(face.shift) == pytest.approx(gap, rel=1e-9)
    assert face.shift @ face.normal < 0  # away from the roller
    for factor in (1.0, 10.0):
        drawn = gap + (factor - 1.0) * np.linalg.norm(face.shift)
        assert drawn == pytest.approx(factor * gap)


def test_the_largest_factor_keeps_the_cage_within_the_cup(whirling: trb.Result) -> None:
    """By the vertices of the cage as they are drawn, with whole rotations and all frames."""
    bearing = whirling.scene.bearing
    made = shapes(bearing, np.linspace(-0.5, 0.5, 3) * bearing.roller.effective_length)
    pose = frames(whirling, revolutions=None, max_frames=60, along=False).pose
    largest = largest_factor(bearing, made, pose)
    assert 1.0 < largest < made.largest_factor
    (r_small, z_small), (r_large, z_large) = cup_outline(bearing)[:2]

    def least_gap(factor: float) -> float:
        points = made.cage.exaggerated(factor)
        gaps = []
        for k in range(pose["cage_x"].size):
            turn = Rotation.from_rotvec([factor * pose["cage_tilt_x"][k], factor * pose["cage_tilt_y"][k], 0.0])
            turn = turn * Rotation.from_rotvec([0.0, 0.0, pose["cage_angle"][k]])
            x, y, z = (turn.apply(points) + factor * np.array([pose[f"cage_{axis}"][k] for axis in "xyz"])).T
            wall = r_small + (r_large - r_small) * (z - z_small) / (z_large - z_small)
            gaps.append((wall - np.hypot(x, y))[(z > z_small) & (z < z_large)].min())
        return min(gaps)

    assert least_gap(1.0) > 0.0
    assert abs(least_gap(largest)) < 0.02 * bearing.roller.diameter
    assert least_gap(1.3 * largest) < -0.02 * bearing.roller.diameter


def test_lands_are_drawn_where_they_guide() -> None:
    """The cage's band meets the land where the real ones do, drawn at any factor."""
    bearing = trb.cases.rig_30310()
    stations = np.linspace(-0.5, 0.5, 3) * bearing.roller.effective_length
    assert shapes(bearing, stations).land is None
    for guidance, radius, sign in (
        ("outer_land", bearing.land.outer_radius, 1.0),
        ("inner_land", bearing.land.inner_radius, -1.0),
    ):
        made = shapes(bearing, stations, guidance)
        assert made.land is not None
        assert made.guide is not None
        land = sign * np.hypot(*made.land.position[:, :2].T)
        assert land.min() == pytest.approx(sign * radius)
        for factor in (1.0, 7.0):
            guide = sign * np.hypot(*made.guide.exaggerated(factor)[:, :2].T)
            assert land.min() - guide.max() == pytest.approx(factor * bearing.land.clearance)
        assert np.ptp(made.land.position[:, 2]) == pytest.approx(bearing.land.width)


def test_colours_show_differences_or_say_that_there_are_none() -> None:
    def quantity(values: Any, kind: str = "roller") -> Quantity:
        return Quantity("q", "q", "N", np.asarray(values, dtype=float), kind)

    alike = 1000.0 + np.linspace(-10.0, 10.0, 50).reshape(10, 5)
    assert colour_range(quantity(alike)) == (990.0, 1010.0, "all within 1 % of 1000")
    assert colour_range(quantity(np.zeros((4, 3))))[:2] == (0.0, 0.0)
    wide = np.linspace(0.0, 100.0, 500).reshape(100, 5)
    assert colour_range(quantity(wide)) == (0.0, 100.0, "")
    wide[0, 0] = 9000.0  # a single value must not make all others look alike
    low, high, said = colour_range(quantity(wide))
    assert 0.0 <= low < 1.0
    assert 99.0 < high < 101.0
    assert said == "1 % of the values lie beyond, 0.2 to 9e+03"
    hits = np.zeros((1000, 2, 2))
    hits[::7] = 3.0
    hits[::49] = 5.0
    hits[0, 0, 0] = 400.0
    assert colour_range(quantity(hits, "pocket"))[:2] == (0.0, 5.0)


def test_a_shaft_that_stands_is_shown(tmp_path: Path) -> None:
    """Slip has no value there."""
    result = trb.Simulation(trb.cases.scene_30310(0.0, 3000.0)).run(duration=2e-3)
    assert "slip" not in [quantity.name for quantity in frames(result, revolutions=None, max_frames=5).quantities]
    assert trb.view(result).save(tmp_path / "v.html").stat().st_size > 600_000


def test_thinning_hides_no_hit(whirling: trb.Result) -> None:
    taken = frames(whirling, revolutions=None, max_frames=20, along=False)
    force = next(q for q in taken.quantities if q.name == "pocket_force")
    assert force.values.max() == whirling.pocket_force.max()
    assert taken.index.size == 20
    assert np.array_equal(largest_between(np.array([1.0, 5.0, 2.0, 3.0, 9.0]), np.array([0, 2, 3])), [1.0, 5.0, 3.0])


def test_files_stay_below_their_size(whirling: trb.Result, tmp_path: Path) -> None:
    full = trb.view(whirling, tmp_path / "full.html", revolutions=None)
    for size in (2.0, 1.3):
        trb.view(whirling, tmp_path / "v.html", revolutions=None, max_frames=100_000, max_size_mb=size, overwrite=True)
        assert (tmp_path / "v.html").stat().st_size < size * 1e6
    with pytest.raises(trb.InputError, match=r"max_size_mb = 0\.5 : must be at least"):
        trb.view(whirling, max_size_mb=0.5)
    assert frames_that_fit(whirling, 12.0, 48, 24) > 1000
    assert "View: " in repr(full)


def test_it_shows_itself_in_a_notebook(whirling: trb.Result) -> None:
    shown = View('<!doctype html><p class="a">&amp;</p>')._repr_html_()
    assert shown.startswith('<iframe srcdoc="&lt;!doctype html&gt;&lt;p class=&quot;a&quot;&gt;&amp;amp;')


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"revolutions": 0.0}, "revolutions = 0.0 : must be > 0"),
        ({"revolutions": -1}, "revolutions = -1 : must be > 0"),
        ({"revolutions": float("nan")}, "revolutions"),
        ({"max_frames": 1}, "max_frames = 1 : must be a whole number from 2"),
        ({"max_frames": 2.5}, "max_frames = 2.5"),
        ({"exaggeration": 0.5}, "exaggeration = 0.5 : must be from 1"),
        ({"exaggeration": float("nan")}, "exaggeration"),
        ({"max_size_mb": float("nan")}, "max_size_mb"),
    ],
)
def test_bad_arguments_are_refused(whirling: trb.Result, options: dict[str, Any], match: str) -> None:
    with pytest.raises(trb.InputError, match=match):
        trb.view(whirling, **options)


def test_missing_groups_and_folders_are_named(whirling: trb.Result, tmp_path: Path) -> None:
    with pytest.raises(trb.InputError, match="recorded group 'rollers' to be shown"):
        trb.view(whirling.select(["cage"]))
    with pytest.raises(trb.FileError, match="cannot be written: there is no folder"):
        trb.view(whirling, tmp_path / "none" / "v.html", max_frames=5)


def test_the_command(whirling: trb.Result, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from trbdyn.cli import main

    run = tmp_path / "run.h5"
    trb.Simulation(whirling.scene).run(revolutions=0.2, output=run)
    glb = tmp_path / "run.glb"
    assert main(["view", str(run), "--no-open", "--frames", "12", "--gltf", str(glb)]) == 0
    assert "run_view.html" in capsys.readouterr().out
    assert (tmp_path / "run_view.html").stat().st_size > 600_000
    assert glb.read_bytes()[:4] == b"glTF"
    head = re.search(
        r'<script id="head" type="application/json">(.*?)</script>', (tmp_path / "run_view.html").read_text(), re.S
    )
    assert head is not None
    assert json.loads(head[1])["frames"] == 12
    assert main(["view", str(run), "--no-open", "--frames", "1"]) == 2
