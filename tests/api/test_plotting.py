"""Pictures go into given axes, change no global setting, save themselves, and say what cannot be drawn.

What each of them shows is kept by `test_seen.py`; here are those that evaluate records again, and what depends on the result.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

import trbdyn as trb
from trbdyn import animation, plot
from trbdyn.errors import FileError, InputError
from trbdyn.plot.style import COLOURS, thin
from trbdyn.results.result import Result
from trbdyn.run.replay import Replay


@pytest.fixture(autouse=True)
def _no_traces() -> Iterator[None]:
    before = dict(mpl.rcParams)
    yield
    plt.close("all")
    assert dict(mpl.rcParams) == before


def test_the_legend_of_the_locus_lies_beside_the_colour_bar(whirling: Result) -> None:
    """Play with three digits made the legend reach under the bar."""
    ax = plot.cage_locus(
        whirling, circles={"radial play $C_{pr}$ = 0.179 mm": 1.0, "circumferential play = 0.0857 mm": 0.48}
    )
    figure = ax.figure
    figure.canvas.draw()
    found = ax.get_legend() or figure.legends[0]
    bar = next(other for other in figure.axes if other is not ax)
    assert not found.get_window_extent().overlaps(bar.get_tightbbox())
    assert figure.bbox.contains(*found.get_window_extent().min)
    assert figure.bbox.contains(*found.get_window_extent().max)


def test_pictures_draw_into_given_axes(whirling: Result) -> None:
    figure, axes = plt.subplots(2, 2)
    for draw, ax in zip((plot.tilt, plot.axial_motion, plot.spacing_angles, plot.torque_split), axes.flat, strict=True):
        assert draw(whirling, ax=ax) is ax
    assert len(plt.get_fignums()) == 1
    assert figure.axes == list(axes.flat)


def test_the_map_shows_the_orbit(build: Callable[..., tuple[Any, Result]]) -> None:
    """A cage that hangs far from the axis and hardly moves is no whirl."""
    hanging = build(radius=0.01e-3, centre=(0.0, -0.225e-3))[1]
    assert float(plot.whirl_map([hanging]).collections[0].get_array()[0]) < 0.05
    ax = plot.orbit_radius(hanging)
    distance, orbit = (line.get_ydata() for line in ax.lines[:2])
    assert orbit.max() < 0.1 < 0.8 < distance.min()
    assert "not known to have settled" in ax.get_legend().get_texts()[2].get_text()


NEED_A_SCENE = ("pressure_map", "film_map", "ring_orbit", "ring_motion", "housing_orbit", "housing_motion")
"""Records are evaluated again for them, or belong to free rings, so a stub of a scene does not do; the map of contacts below,
tests/physics/test_free_ring.py and tests/physics/test_housing.py draw them."""

WHOLE = ("pocket_forces", "attitude", "load_zone", "pocket_polar", *NEED_A_SCENE)
"""Pictures that are a figure of their own, or need polar axes."""

DRAWN = [name for name in plot.PICTURES if name not in WHOLE]


@pytest.mark.parametrize("name", [name for name in plot.PICTURES if name not in NEED_A_SCENE])
def test_the_title_names_the_quantity(
    name: str, whirling: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(plt.Figure, "savefig", lambda figure, target, **how: target.write(b"x"))
    picture = plot.PICTURES[name][0](whirling)
    figure = picture if isinstance(picture, plt.Figure) else picture.figure
    quantity = figure.get_suptitle()
    assert len(quantity) > 8
    plot.save(picture, tmp_path / "a.png", "stub: 3000 rpm")
    assert figure.get_suptitle() == f"{quantity}\nstub: 3000 rpm"


@pytest.mark.parametrize("name", DRAWN)
def test_given_axes_keep_their_title_and_their_place(name: str, whirling: Result) -> None:
    """In somebody's own subplots nothing lies above the axes but their title."""
    figure, axes = plt.subplots(2, 1, figsize=(6, 6))
    axes[0].set_title("mine")
    for ax in axes:
        plot.PICTURES[name][0](whirling, ax=ax)
    figure.draw_without_rendering()
    assert axes[0].get_title() == "mine"
    assert len(axes[1].get_title()) > 8
    assert not figure.get_suptitle()
    legend = axes[1].get_legend()
    if legend is not None:
        inside = axes[1].get_window_extent()
        box = legend.get_window_extent()
        assert box.y1 <= inside.y1 + 1


@pytest.mark.parametrize(
    "name", ["cage_locus", "orbit_radius", "axial_motion", "tilt", "spectrum", "pocket_forces", "pocket_statistics"]
)
def test_a_run_without_a_cage_has_no_picture_of_it(name: str, whirling: Result) -> None:
    whirling.scene.effects = SimpleNamespace(
        **(vars(whirling.scene.effects) | {"bodies": "rollers", "has_cage": False, "has_pockets": False})
    )
    with pytest.raises(InputError, match="has no cage"):
        plot.PICTURES[name][0](whirling)


def test_a_torque_without_its_losses_is_one_force(whirling: Result) -> None:
    assert "forces on the inner ring" in plot.torque_split(whirling).get_xlabel()
    alone = plot.torque_split(whirling.select(["torque"]))
    assert "force on the inner ring" in alone.figure.get_suptitle()


@pytest.mark.parametrize("sizes", [(1.0, 2.0, 3.0), (-1.0, 2.0, 3.0), (1.0, 2.0, -3.0), (-1.0, -2.0, -3.0)])
def test_all_bars_lie_within_the_axes(
    whirling: Result, monkeypatch: pytest.MonkeyPatch, sizes: tuple[float, float, float]
) -> None:
    """Those that point to the left, too; the axis begins at zero only where there are none."""
    split = dict(zip(("raceways", "ribs", "pockets"), sizes, strict=True))
    monkeypatch.setattr(Result, "power_split", property(lambda _: split))
    ax = plot.power_split(whirling)
    low, high = ax.get_xlim()
    assert all(low <= bar.get_width() <= high for bar in ax.patches)
    assert (low == 0.0) == (min(sizes) > 0.0)


@pytest.mark.parametrize(("radius", "wanted"), [(0.9, 1.08), (1.5, 1.62)])
def test_a_section_shows_the_circle_of_the_play_or_the_whole_path(build: Any, radius: float, wanted: float) -> None:
    """Eight per cent of room around the farther one."""
    ax = plot.poincare(build(radius=radius * 0.25e-3)[1])
    assert (*ax.get_xlim(), *ax.get_ylim()) == pytest.approx((-wanted, wanted) * 2, rel=1e-3)


# ---- of runs ----


@pytest.fixture(scope="module")
def loaded() -> Result:
    return trb.Simulation(trb.cases.paper_30310(2000.0, 4930.0, 5530.0)).run(revolutions=1)


@pytest.mark.parametrize("quantity", ["pressure", "slide_roll"])
def test_a_map_is_the_mean_of_the_rollers_that_passed(loaded: Result, quantity: str) -> None:
    """Every cell: mean over the records used and the rollers in that sector whose node carries load."""
    records, bins = 7, 23  # no roller stands on a border at the start, save at 0
    figure = plot.contact_map(loaded, quantity, records=records, bins=bins)
    replay, factor = Replay(loaded), 1e-6 if quantity == "pressure" else 1.0
    index = np.linspace(0, len(loaded) - 1, records).round().astype(int)
    angle = np.mod(loaded.roller_orbit_angle[index], 2.0 * np.pi)
    found = [replay.contacts(int(k)) for k in index]
    nodes = replay.stations.size
    for row, ax in enumerate(figure.axes[:2]):
        assert ax.get_title(loc="left") == ("outer raceway", "inner raceway")[row]
        mesh = ax.collections[0]
        shown = np.ma.filled(np.ma.asarray(mesh.get_array()).reshape(nodes, bins), np.nan)
        corners = mesh.get_coordinates()
        np.testing.assert_allclose(corners[0, :, 0], np.linspace(0.0, 360.0, bins + 1))
        half = 0.5e3 * loaded.scene.bearing.roller.effective_length
        np.testing.assert_allclose(corners[[0, -1], 0, 1], (-half, half))
        passed = 0
        for place in range(bins):
            inside = (angle >= 2.0 * np.pi * place / bins) & (angle < 2.0 * np.pi * (place + 1) / bins)
            if not inside.any():
                continue
            passed += 1
            values = np.concatenate([found[k][f"raceway_{quantity}"][row][inside[k]] for k in range(records)])
            loads = np.concatenate([found[k]["raceway_load"][row][inside[k]] for k in range(records)])
            for node in range(nodes):
                touching = loads[:, node] > 0.0
                wanted = factor * values[touching, node].mean() if touching.any() else np.nan
                np.testing.assert_allclose(shown[node, place], wanted, rtol=1e-9)
        assert passed > 8
    clims = [ax.collections[0].get_clim() for ax in figure.axes[:2]]
    assert clims[0] == clims[1], "both rings by the same colours"
    last = figure.axes[1]
    assert last.get_xlabel() == "place around the bearing from x towards y (deg)"
    np.testing.assert_array_equal(last.get_xticks(), np.arange(0, 361, 45))


def test_waterfall_peaks_at_the_whirl() -> None:
    runs = [
        trb.Simulation(trb.cases.paper_30310(speed, 4930.0, start=trb.Start.whirl(0.9))).run(revolutions=6)
        for speed in (3000.0, 1000.0)
    ]
    ax = plot.waterfall(runs)
    for line, run in zip(ax.lines[:2], reversed(runs), strict=True):
        x, y = line.get_data()
        shaft = abs(float(run.shaft_speed.mean())) / (2 * np.pi)
        assert x[np.argmax(y)] == pytest.approx(run.whirl_frequency / shaft, abs=0.2)
    narrow = plot.waterfall(runs, reach=0.5, decades=0.5)
    assert narrow.get_xlim() == pytest.approx((-0.5, 0.5), abs=0.1)
    with pytest.raises(InputError, match="results"):
        plot.waterfall([runs[0].window(stop=1e-3)])


@pytest.mark.parametrize(
    ("draw", "match"),
    [
        (lambda result: plot.load_zone(result, ax=plt.subplots()[1]), "polar"),
        (lambda result: plot.contact_map(result, quantity="colour"), "quantity = 'colour' : must be one of pressure"),
        (lambda result: plot.contact_map(result, sides=["rib"]), "sides = 'rib'"),
        (lambda result: plot.contact_map(result, records=0), "records = 0"),
        (lambda result: plot.poincare(result, once_per="day"), "once_per = 'day'"),
        (lambda result: plot.waterfall([result], reach=0.0), "must be > 0"),
        (lambda result: plot.waterfall([result], decades=0.0), "must be > 0"),
        (lambda result: plot.waterfall([]), "results"),
        (lambda result: plot.pocket_drawing(result.scene.bearing, 16), "pocket = 16"),
        (lambda result: plot.pocket_forces(result, pockets=[12]), "pockets"),
        (lambda result: plot.spacing_angles(result, rollers=[12]), "rollers"),
    ],
)
def test_what_cannot_be_drawn_is_said(loaded: Result, draw: Callable[[Result], object], match: str) -> None:
    with pytest.raises(InputError, match=match):
        draw(loaded)


def test_nothing_is_drawn_of_pockets_that_were_not_touched(loaded: Result) -> None:
    assert "no pocket was touched" in plot.pocket_polar(loaded.window(stop=0.0)).texts[0].get_text()


@pytest.mark.slow
def test_all_saves_what_was_recorded(tmp_path: Path, whirling: Result) -> None:
    drawn = [name for name in plot.PICTURES if name not in NEED_A_SCENE]
    files = plot.all(whirling, tmp_path / "new" / "pictures", only=drawn)
    assert [file.stem for file in files] == drawn
    for file in files:
        with Image.open(file) as image:
            assert image.width > 800
            assert len(image.convert("L").getcolors(256) or []) > 2
    assert not plt.get_fignums()
    some = plot.all(whirling.select(["torque", "cage"]), tmp_path / "some")
    cage_and_torque = {"cage_locus", "axial_motion", "tilt", "spectrum", "poincare", "torque_split", "torque_sources"}
    assert {file.stem for file in some} == cage_and_torque
    whirling.scene.effects = SimpleNamespace(
        **(vars(whirling.scene.effects) | {"bodies": "rollers", "has_cage": False, "has_pockets": False})
    )
    assert not whirling.has_cage
    without_cage = whirling.select(["cage", "rollers", "pocket"])
    assert plot.drawable(without_cage) == ("spacing_angles", "pressure_map", "film_map", "attitude")
    bare = plot.all(without_cage.select(["rollers", "pocket"]), tmp_path / "bare")
    assert [file.stem for file in bare] == ["spacing_angles", "attitude"]
    assert "orbit_rms_over_cpr" not in whirling.summary()
    assert plot.conditions(whirling) == "stub: 3000 rpm, $F_a$ 4930 N"


def test_all_refuses_unknown_pictures_and_bad_folders(tmp_path: Path, whirling: Result) -> None:
    with pytest.raises(InputError, match="did you mean 'tilt'"):
        plot.all(whirling, tmp_path, only=["tilts"])
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="folder"):
        plot.all(whirling, tmp_path / "file" / "below", only=["tilt"])
    with pytest.raises(FileError, match="cannot be written"):
        plot.save(plot.tilt(whirling), tmp_path / "missing" / "tilt.png")
    assert not plt.get_fignums()


def test_colours_differ_in_grey() -> None:
    grey = [np.dot(mpl.colors.to_rgb(colour), (0.299, 0.587, 0.114)) for colour in COLOURS[:3]]
    assert min(abs(a - b) for i, a in enumerate(grey) for b in grey[:i]) > 0.2


def test_thin_keeps_the_extremes() -> None:
    x = np.linspace(0, 1, 100_001)
    y = np.zeros_like(x)
    y[[12345, 67890]] = 5.0, -7.0
    tx, ty = thin(x, y)
    assert tx.size < 7000
    assert (ty.max(), ty.min()) == (5.0, -7.0)
    assert tx[np.argmax(ty)] == x[12345]
    assert (tx[0], tx[-1]) == (0.0, 1.0)


def test_animation_moves_and_saves(tmp_path: Path, whirling: Result) -> None:
    path = animation.save(animation.animate(whirling, last=2.0, frames=4), tmp_path / "cage.gif", dpi=40)
    with Image.open(path) as image:
        assert image.n_frames == 4
        first = np.asarray(image.convert("L"), dtype=float)
        image.seek(2)
        assert np.abs(np.asarray(image.convert("L"), dtype=float) - first).max() > 50
    with pytest.raises(InputError, match="frames"):
        animation.animate(whirling, frames=0)


def test_descriptions_of_pictures_are_complete() -> None:
    """Each argument stands in the description once, in the order of the call; and so does what is returned."""
    for name in plot.GROUPS:
        draw = getattr(plot, name)
        text = inspect.getdoc(draw) or ""
        if name not in ("pressure_map", "film_map"):  # these name `contact_map`
            told = [line.partition(" : ")[0] for line in text.splitlines() if re.match(r"\w+ : ", line)]
            assert told == list(inspect.signature(draw).parameters), name
        assert all(group in text for group in plot.GROUPS[name]), name
        assert text.count("Returns\n-------\n") == 1, name
