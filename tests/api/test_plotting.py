"""Pictures show the numbers they should, change no global setting and save themselves."""

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
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from PIL import Image

from trbdyn import animation, plot
from trbdyn.errors import FileError, InputError
from trbdyn.plot.style import COLOURS, thin
from trbdyn.results.result import Result


@pytest.fixture(autouse=True)
def _no_traces() -> Iterator[None]:
    before = dict(mpl.rcParams)
    yield
    plt.close("all")
    assert dict(mpl.rcParams) == before


def test_cage_locus_shows_the_path_and_the_circles(whirling: Result) -> None:
    ax = plot.cage_locus(whirling)
    path = next(item for item in ax.collections if isinstance(item, LineCollection))
    points = np.concatenate(path.get_segments())
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), 0.9, rtol=1e-9)
    assert [patch.get_radius() for patch in ax.patches] == [1.0, pytest.approx(0.48)]
    assert ax.get_aspect() == 1.0
    assert "C_{pr}" in ax.get_xlabel()
    texts = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert texts[:2] == ["radial play $C_{pr}$ = 0.25 mm", "circumferential play $C_{pc}$ = 0.12 mm"]
    plain = plot.cage_locus(whirling, plane="rail", colour_by_time=False, circles={"Cpr": 1.0, "equal spacing": 0.436})
    assert len(plain.patches) == 2
    assert not plain.collections
    for shown in (ax, plain):  # the largest circle fills the picture
        assert 1.0 < shown.get_xlim()[1] == shown.get_ylim()[1] < 1.2


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


def test_axes_carry_units_and_numbers(whirling: Result) -> None:
    tilt = plot.tilt(whirling, last=5.0)
    assert tilt.get_ylabel() == "cage tilt (mrad)"
    assert tilt.get_xlim() == pytest.approx((15.0, 20.0), abs=0.01)
    np.testing.assert_allclose(np.abs(tilt.lines[0].get_ydata()).max(), 0.2, rtol=1e-4)
    spacing = plot.spacing_angles(whirling, n=5)
    assert "5 gaps" in spacing.get_ylabel()
    named = [line for line in spacing.lines if not line.get_label().startswith("_")]
    assert [line.get_label() for line in named] == ["0–5", "1–6", "2–7", "3–8", "4–9"]
    expected = np.degrees(whirling.spacing_angles(5)[0, 0])
    assert named[0].get_ydata()[0] == pytest.approx(expected)
    loads = plot.contact_loads(whirling)
    assert "1833 N" in loads.get_legend().get_texts()[0].get_text()
    audit = plot.energy_audit(whirling)
    assert any("1.3e-06" in text.get_text() for text in audit.get_legend().get_texts())


def test_the_map_shows_the_orbit(build: Callable[..., tuple[Any, Result]]) -> None:
    """A cage that hangs far from the axis and hardly moves is no whirl."""
    hanging = build(radius=0.01e-3, centre=(0.0, -0.225e-3))[1]
    assert float(plot.whirl_map([hanging]).collections[0].get_array()[0]) < 0.05
    ax = plot.orbit_radius(hanging)
    distance, orbit = (line.get_ydata() for line in ax.lines[:2])
    assert orbit.max() < 0.1 < 0.8 < distance.min()
    assert "not known to have settled" in ax.get_legend().get_texts()[2].get_text()


NEED_A_SCENE = ("pressure_map", "film_map", "ring_orbit", "ring_motion", "housing_orbit", "housing_motion")
"""Records are evaluated again for them, or belong to free rings, so a stub of a scene does not do; tests/api/test_pictures.py,
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
        **(vars(whirling.scene.effects) | {"bodies": "rollers", "has_cage": False})
    )
    with pytest.raises(InputError, match="has no cage"):
        plot.PICTURES[name][0](whirling)


def test_the_audit_is_drawn_by_quiet_lines(whirling: Result) -> None:
    ax = plot.energy_audit(whirling)
    assert all(line.get_xdata().size <= 241 for line in ax.lines)
    stored = np.abs(whirling.energy_balance["kinetic_energy"] + whirling.energy_balance["elastic_energy"])
    assert ax.lines[2].get_ydata().max() == pytest.approx(stored.max())


def test_the_split_of_torque_has_the_shares_of_the_losses(whirling: Result) -> None:
    ax = plot.torque_split(whirling)
    loss = whirling.power_split
    widths = sorted(bar.get_width() for bar in ax.patches)
    np.testing.assert_allclose(
        widths, sorted(value / (2 * np.pi * 50.0) for value in loss.values() if value), rtol=1e-9
    )
    assert "forces on the inner ring" in ax.get_xlabel()
    alone = plot.torque_split(whirling.select(["torque"]))
    assert "force on the inner ring" in alone.figure.get_suptitle()


def test_spectrum_peaks_at_the_cage_frequency(whirling: Result) -> None:
    ax = plot.spectrum(whirling)
    order, density = ax.lines[0].get_data()
    assert order[np.argmax(density)] == pytest.approx(1.0, abs=0.1)


def test_pocket_forces_have_a_panel_a_face(whirling: Result) -> None:
    figure = plot.pocket_forces(whirling, last=4.0)
    panels = [ax for ax in figure.axes if ax.get_ylabel() == "pocket"]
    assert [ax.get_title(loc="left") for ax in panels] == ["leading bar", "trailing bar", "large end wall"]
    shown = panels[0].collections[0].get_array()
    last = whirling.window(whirling.final_time - 4 / 50.0)
    np.testing.assert_allclose(shown.reshape(12, -1).max(axis=1), last.pocket_force[:, :, 0].max(axis=0), rtol=0.02)
    assert np.ma.count_masked(shown) > 0.5 * shown.size
    assert "(N)" in figure.axes[-1].get_ylabel()
    few = plot.pocket_forces(whirling, pockets=[0, 6], last=None)
    assert [text.get_text() for text in few.axes[0].get_yticklabels()] == ["0", "6"]
    with pytest.raises(InputError, match="pockets"):
        plot.pocket_forces(whirling, pockets=[12])
    with pytest.raises(InputError, match="rollers"):
        plot.spacing_angles(whirling, rollers=[12])


def test_whirl_map_marks_every_run(build: Callable[..., tuple[Any, Result]]) -> None:
    runs = [build(radius=radius, n=2001)[1] for radius in (0.1e-3, 0.225e-3)]
    ax = plot.whirl_map(runs)
    np.testing.assert_allclose(ax.collections[0].get_array(), [0.4, 0.9], rtol=1e-2)
    assert "orbit" in ax.figure.axes[1].get_ylabel()
    np.testing.assert_allclose(ax.collections[0].get_offsets(), [[3000.0, 4.93]] * 2)
    # runs at one load and speed do not look as if they differed
    assert np.ptp(ax.get_ylim()) >= 0.2 * 4.93
    assert np.ptp(ax.get_xlim()) >= 0.2 * 3000.0


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
        **(vars(whirling.scene.effects) | {"bodies": "rollers", "has_cage": False})
    )
    assert not whirling.has_cage
    without_cage = whirling.select(["cage", "rollers", "pocket"])
    assert plot.drawable(without_cage) == ("spacing_angles", "pressure_map", "film_map", "attitude")
    bare = plot.all(without_cage.select(["rollers", "pocket"]), tmp_path / "bare")
    assert [file.stem for file in bare] == ["spacing_angles", "attitude"]
    assert whirling.summary()["orbit_rms_over_cpr"] is None
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
    path = animation.save(animation.animate(whirling, last=2.0, frames=6), tmp_path / "cage.gif", dpi=40)
    with Image.open(path) as image:
        assert image.n_frames == 6
        first = np.asarray(image.convert("L"), dtype=float)
        image.seek(3)
        assert np.abs(np.asarray(image.convert("L"), dtype=float) - first).max() > 50
    with pytest.raises(InputError, match="frames"):
        animation.animate(whirling, frames=0)


def test_animation_draws_the_cage_as_a_circle_and_marks_on_the_rollers(whirling: Result) -> None:
    moving = animation.animate(whirling, last=2.0, frames=4)
    for frame in (0, 3):
        drawn = moving._func(frame)
        ring = next(one for one in drawn if isinstance(one, Line2D) and len(one.get_xdata()) > 20)
        hub = next(one for one in drawn if isinstance(one, Line2D) and one.get_marker() == "+")
        x, y = (np.asarray(values) for values in ring.get_data())
        assert (x[0], y[0]) == pytest.approx((x[-1], y[-1]))
        radius = np.hypot(x - hub.get_xdata()[0], y - hub.get_ydata()[0])
        geometry = whirling.geometry
        assert radius == pytest.approx(500.0 * (geometry["outer_race_radius"] + geometry["inner_race_radius"]))
        turned = np.unwrap(np.arctan2(y - hub.get_ydata()[0], x - hub.get_xdata()[0]))
        assert turned[-1] - turned[0] == pytest.approx(2.0 * np.pi)
        rollers = [one for one in drawn if isinstance(one, Circle)]
        marks = [one for one in drawn if isinstance(one, Line2D) and len(one.get_xdata()) == 2]
        assert len(marks) == len(rollers) > 0
        path = hub.axes.figure.axes[1]  # the locus and the play fill its picture
        assert max(1.0, np.abs(whirling.cage_locus()).max()) < path.get_xlim()[1] == path.get_ylim()[1] < 1.3
        for roller, mark in zip(rollers, marks, strict=True):
            (x0, x1), (y0, y1) = mark.get_data()
            assert (x0, y0) == pytest.approx(roller.center)
            assert np.hypot(x1 - x0, y1 - y0) == pytest.approx(roller.radius)
            if frame == 0:  # marks begin on the rays from the axis
                assert (x1 - x0) * roller.center[1] == pytest.approx(
                    (y1 - y0) * roller.center[0], abs=0.02 * roller.radius**2
                )
                assert (x1 - x0) * roller.center[0] + (y1 - y0) * roller.center[1] > 0.0
    plt.close(moving._fig)


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
