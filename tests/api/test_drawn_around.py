"""What is drawn around the bearing and of its shapes, against the result and the geometry; what every picture carries besides."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.ticker import MultipleLocator

import trbdyn as trb
from trbdyn import plot
from trbdyn.plot.whirling import section_points
from trbdyn.results.result import Result
from trbdyn.run.replay import Replay


@pytest.fixture(scope="module")
def loaded() -> Result:
    return trb.Simulation(trb.cases.paper_30310(2000.0, 4930.0, 5530.0)).run(revolutions=1)


@pytest.fixture(autouse=True)
def _close() -> Iterator[None]:
    yield
    plt.close("all")


@pytest.mark.parametrize("quantity", ["pressure", "slide_roll"])
def test_a_map_is_the_mean_of_the_rollers_that_passed(loaded: Result, quantity: str) -> None:
    """Every cell: mean over the records used and the rollers in that sector whose node carries load."""
    records, bins = 7, 23  # no roller stands on a border at the start, save at 0
    figure = plot.contact_map(loaded, quantity, records=records, bins=bins)
    replay, factor = Replay(loaded), 1e-9 if quantity == "pressure" else 1.0
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
    last = figure.axes[1]
    assert last.get_xlabel() == "place around the bearing from x towards y (deg)"
    np.testing.assert_array_equal(last.get_xticks(), np.arange(0, 361, 45))


def test_bars_of_a_pocket_stand_side_by_side_at_its_place(whirling: Result) -> None:
    ax, statistics = plot.pocket_polar(whirling), whirling.pocket_statistics()
    touched = [slot for slot in range(statistics.peak.shape[1]) if statistics.peak[:, slot].max() > 0.0]
    assert len(touched) > 1
    count = statistics.peak.shape[0]
    for label, angle in zip(ax.get_xticklabels(), ax.get_xticks(), strict=True):
        assert float(label.get_text()) == pytest.approx(angle * count / (2.0 * np.pi)), "pockets count from 0"
    width = 0.8 * (2.0 * np.pi / count) / len(touched)
    bars: list[Any] = list(ax.patches)
    assert len(bars) == 2 * count * len(touched)
    for order, slot in enumerate(touched):
        light, dark = (bars[(2 * order + k) * count : (2 * order + k + 1) * count] for k in range(2))
        for pocket in range(count):
            for bar, height in ((light[pocket], statistics.peak[pocket, slot]), (dark[pocket], None)):
                middle = bar.get_x() + 0.5 * bar.get_width()
                # the faces' bars of a pocket are centred on it
                shift = (order - 0.5 * (len(touched) - 1)) * width
                assert middle == pytest.approx(2.0 * np.pi * pocket / count + shift, abs=1e-12)
                assert bar.get_width() == pytest.approx(width)
                if height is not None:
                    assert bar.get_height() == pytest.approx(height)


@pytest.mark.parametrize("once_per", ["cage", "shaft", "roller"])
def test_sections_of_a_record_that_begins_late(whirling: Result, once_per: Any) -> None:
    """Points where the angle is a whole number of periods, inside the record alone."""
    part = whirling.window(start=0.1, stop=0.3)
    angle = part.shaft_angle if once_per == "shaft" else part.cage_angle
    period = 2.0 * np.pi / (12 if once_per == "roller" else 1)
    numbers = [k for k in range(2000) if angle[0] <= k * period <= angle[-1]]
    assert numbers[0] > 1
    path = part.cage_locus()
    wanted = [[np.interp(k * period, angle, path[:, axis]) for axis in range(2)] for k in numbers]
    np.testing.assert_allclose(section_points(part, once_per), wanted)


def test_waterfall_stands_on_the_speed_and_marks_the_cage(loaded: Result) -> None:
    ax = plot.waterfall([loaded])
    assert list(ax.get_yticks()) == [2000]
    marks = [float(np.asarray(line.get_xdata())[0]) for line in ax.lines[1:]]
    assert marks == pytest.approx([loaded.geometry["cage_speed_ratio"], 1.0])
    lowest, highest = np.min(ax.lines[0].get_ydata()), np.max(ax.lines[0].get_ydata())
    assert 2000.0 <= lowest < highest == pytest.approx(2000.0 + 0.9 * max(0.3 * 2000.0 / 0.9, 1.0), rel=0.2)


PICTURES = ("cage_locus", "orbit_radius", "tilt", "axial_motion", "spacing_angles", "torque_split", "power_split")
PICTURES += ("energy_audit", "pocket_statistics", "contact_loads", "film_parameter", "torque_sources", "poincare")


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_has_its_legend_and_its_grid(name: str, whirling: Result) -> None:
    """Whatever has a label of its own stands in the legend; marks lie on a grid."""
    ax = getattr(plot, name)(whirling)
    _, labels = ax.get_legend_handles_labels()
    if len(labels) > 1:
        legend = ax.get_legend() or ax.figure.legends[0]
        assert [text.get_text() for text in legend.get_texts()] == labels
    # bars have a grid across them alone
    assert ax.xaxis.get_gridlines()[0].get_visible()
    assert ax.get_xlabel()


def test_scales(whirling: Result) -> None:
    audit = plot.energy_audit(whirling)
    assert (audit.get_xscale(), audit.get_yscale()) == ("linear", "log")
    # four curves that lie upon each other are told apart by colour and width
    looks = [(to_rgb(line.get_color()), line.get_linewidth()) for line in audit.lines]
    assert len(set(looks)) == 4
    assert max(width for _, width in looks) == looks[0][1]
    locus = plot.cage_locus(whirling)
    for axis in (locus.xaxis, locus.yaxis):
        assert isinstance(axis.get_major_locator(), MultipleLocator)
        np.testing.assert_allclose(np.diff(axis.get_major_locator().tick_values(-1.0, 1.0)), 0.5)
    statistics = plot.pocket_statistics(whirling)
    assert statistics.get_ylim()[0] == 0.0


def test_dimensions_of_the_drawing() -> None:
    """The arrows of a bearing's drawing end on the roller, at the ends of its length and on the bearing's axis."""
    bearing = trb.cases.rig_30310()
    geometry = bearing.geometry
    ax = plot.bearing_drawing(bearing)
    turn = np.array(
        [
            [np.cos(geometry.roller_axis_angle), np.sin(geometry.roller_axis_angle)],
            [-np.sin(geometry.roller_axis_angle), np.cos(geometry.roller_axis_angle)],
        ]
    )
    mid = np.array([0.0, geometry.apex_to_mid * np.sin(geometry.roller_axis_angle)])
    mid[0] = 0.0
    arrows = [item for item in ax.texts if item.arrow_patch is not None]
    ends = [(np.array(item.xyann), np.array(item.xy)) for item in arrows]
    lengths = sorted(float(np.hypot(*(b - a))) for a, b in ends)
    wanted = [1e3 * bearing.roller.diameter, 1e3 * bearing.roller.effective_length, 5e2 * bearing.pitch_diameter]
    assert lengths == pytest.approx(sorted(wanted))
    for a, b in ends:
        along = (b - a) / np.hypot(*(b - a))
        if np.isclose(np.hypot(*(b - a)), wanted[0]):
            assert abs(along @ turn[1]) == pytest.approx(1.0)
        elif np.isclose(np.hypot(*(b - a)), wanted[1]):
            assert abs(along @ turn[0]) == pytest.approx(1.0)
        else:
            assert min(a[1], b[1]) == pytest.approx(0.0, abs=1e-9)
            assert a[0] == pytest.approx(b[0])


def test_the_roller_of_a_pocket_drawing_is_a_cone() -> None:
    bearing = trb.cases.rig_30310()
    end, top = plot.pocket_drawing(bearing, 2).axes[:2]
    outline = np.asarray(top.patches[0].get_xy())
    geometry, half = bearing.geometry, 0.5e3 * bearing.roller.total_length
    for x, y in outline:
        assert abs(x) <= half * (1.0 + 1e-12)
        assert abs(y) == pytest.approx((1e3 * geometry.apex_to_mid + x) * np.tan(geometry.roller_half_angle))
    assert {round(x / half) for x, _ in outline} == {-1, 0, 1}
    circle = end.lines[0]
    np.testing.assert_allclose(np.hypot(*circle.get_data()), 0.5e3 * bearing.roller.diameter)


@pytest.mark.parametrize("case", ["paper_30310", "scene_32216"])
def test_the_drawing_of_a_bearing_has_room_for_all_of_it(case: str) -> None:
    """And is not lost in it: the section takes a third of the width at least."""
    ax = plot.bearing_drawing(getattr(trb.cases, case)().bearing)
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    points = np.vstack(
        [patch.get_xy() for patch in ax.patches if hasattr(patch, "get_xy") and len(np.shape(patch.get_xy())) == 2]
    )
    assert left < points[:, 0].min()
    assert points[:, 0].max() < right
    assert bottom < 0.0 < points[:, 1].min()
    assert points[:, 1].max() < top < 1.2 * points[:, 1].max()
    assert np.ptp(points[:, 0]) > (right - left) / 3.0
    wide = 1.1 * np.abs(points[:, 0]).max()
    assert left == pytest.approx(-wide, rel=0.02)
    # room for the dimensions beside the section, as wide as its larger half at least; hardly higher than wide
    assert right > 2.3 * wide
    assert right - left > 0.9 * (top - bottom)


def test_the_faces_of_a_pocket_are_drawn_in_both_views() -> None:
    bearing = trb.cases.rig_30310()
    end, top = plot.pocket_drawing(bearing, 2).axes[:2]
    faces = bearing.pocket_of(2).faces
    for view, columns in ((end, (1, 0)), (top, (2, 1))):
        drawn = [np.column_stack(line.get_data()) for line in view.lines]
        for face in faces:
            corners = 1e3 * face.vertices[:, columns]
            closed = np.vstack([corners, corners[:1]])
            assert any(one.shape == closed.shape and np.allclose(one, closed) for one in drawn), face.name
    half = 0.5e3 * bearing.roller.total_length
    assert top.get_xlim() == pytest.approx((-1.35 * half, 1.35 * half))


@pytest.mark.parametrize(("radius", "wanted"), [(0.9, 1.08), (1.5, 1.62)])
def test_a_section_shows_the_circle_of_the_play_or_the_whole_path(build: Any, radius: float, wanted: float) -> None:
    """Eight per cent of room around the farther one."""
    ax = plot.poincare(build(radius=radius * 0.25e-3)[1])
    assert (*ax.get_xlim(), *ax.get_ylim()) == pytest.approx((-wanted, wanted) * 2, rel=1e-3)
