"""What is drawn: every curve, bar and mark against the result, where no two panels, faces, sides or components are
alike.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from numpy.typing import NDArray

from trbdyn import plot
from trbdyn.plot.style import COLOURS
from trbdyn.results.result import Result

Array = NDArray[np.float64]


@pytest.fixture(autouse=True)
def _close() -> Iterator[None]:
    yield
    plt.close("all")


@pytest.fixture
def uneven(synthetic: Any, whirling: Result) -> Result:
    """As the whirling run, but every pocket, face, side and component with its own numbers; too short to be thinned."""
    keep = slice(0, 400)
    time = synthetic.column("time")[keep]
    for name in ("pocket_force", "cage_tilt", "cage_position", "outer_load", "inner_load", "rib_load"):
        column = synthetic.column(name)
        random = np.random.default_rng(len(name))
        column[...] *= 1.0 + random.random(column.shape)
    force = synthetic.column("pocket_force")
    force[...] = (
        1.0 + np.arange(48).reshape(12, 4) + np.sin(40.0 * synthetic.column("time"))[:, np.newaxis].reshape(-1, 1, 1)
    )
    force[:, :, 3] = 0.0
    assert time.size == 400
    return synthetic.result(whirling.scene, synthetic.records[keep])


def data(line: Any) -> tuple[Array, Array]:
    return np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float)


def turns(result: Result) -> Array:
    return result.shaft_angle / (2.0 * np.pi)


def curve(ax: Any, label: str) -> tuple[Array, Array]:
    return data(next(line for line in ax.lines if label in str(line.get_label())))


def test_tilt(uneven: Result) -> None:
    ax = plot.tilt(uneven, last=None)
    for index, label in enumerate((r"\theta_x", r"\theta_y")):
        x, y = curve(ax, label)
        np.testing.assert_allclose(x, turns(uneven))
        np.testing.assert_allclose(y, 1e3 * uneven.cage_tilt[:, index])


def test_axial_motion(uneven: Result) -> None:
    x, y = data(plot.axial_motion(uneven).lines[0])
    np.testing.assert_allclose(x, turns(uneven))
    np.testing.assert_allclose(y, 100.0 * uneven.cage_position[:, 2] / 0.4e-3)


def test_orbit_radius(uneven: Result) -> None:
    ax = plot.orbit_radius(uneven)
    start, place = uneven.settling().index, uneven.cage_position[:, :2] / 0.25e-3
    x, y = curve(ax, "distance from the bearing axis")
    np.testing.assert_allclose(x, turns(uneven))
    np.testing.assert_allclose(y, np.hypot(*place.T))
    x, y = curve(ax, "orbit radius about the mean place")
    np.testing.assert_allclose(x, turns(uneven))
    np.testing.assert_allclose(y, np.hypot(*(place - place[start:].mean(axis=0)).T))
    ends, level = curve(ax, "rms after the transient")
    np.testing.assert_allclose(ends, [x[start], x[-1]])
    np.testing.assert_allclose(level, [np.sqrt(np.mean(y[start:] ** 2))] * 2)


@pytest.mark.parametrize("plane", ["centre", "rail"])
def test_cage_locus(uneven: Result, plane: Any) -> None:
    place = uneven.cage_position if plane == "centre" else uneven.cage_rail_position
    expected = place[:, :2] / 0.25e-3
    ax = plot.cage_locus(uneven, plane=plane)
    path = next(item for item in ax.collections if isinstance(item, LineCollection))
    segments = np.array(path.get_segments())
    np.testing.assert_allclose(segments[:, 0], expected[:-1])
    np.testing.assert_allclose(segments[:, 1], expected[1:])
    np.testing.assert_allclose(path.get_array(), turns(uneven)[:-1])
    np.testing.assert_allclose(np.ravel(data(ax.lines[-3])), expected[-1], err_msg="the mark of the end")
    one = plot.cage_locus(uneven, plane=plane, colour_by_time=False).lines[0]
    np.testing.assert_allclose(np.column_stack(data(one)), expected)


@pytest.mark.parametrize("pockets", [None, [7, 2]])
def test_pocket_forces(uneven: Result, pockets: list[int] | None) -> None:
    """A panel for each face that is touched, a row for each pocket: the largest force within each stretch of time."""
    names = [name.replace("_", " ") for name in uneven.slot_names]
    figure = plot.pocket_forces(uneven, pockets=pockets, last=None)
    chosen, force = list(range(12)) if pockets is None else pockets, uneven.pocket_force
    panels = [ax for ax in figure.axes if ax.get_title(loc="left")]
    assert [ax.get_title(loc="left") for ax in panels] == names[:3], "a face that is never touched has no panel"
    for slot, ax in enumerate(panels):
        shown = np.asarray(ax.collections[0].get_array()).reshape(len(chosen), -1)
        edges = np.unique(np.linspace(0, 400, shown.shape[1] + 1).astype(int))
        for row, pocket in enumerate(chosen):
            largest = [force[a:b, pocket, slot].max() for a, b in pairwise(edges)]
            np.testing.assert_allclose(shown[row], largest)
        assert [label.get_text() for label in ax.get_yticklabels()] == [str(pocket) for pocket in chosen]


def test_the_scale_of_pocket_forces_says_how_long_a_stretch_is(build: Any) -> None:
    """Five records of 200 ms in all, a stretch each."""
    figure = plot.pocket_forces(build(n=5, duration=0.2)[1], last=None)
    assert figure.axes[-1].get_ylabel() == "largest force within 40 ms (N)"


def test_pocket_statistics(uneven: Result) -> None:
    ax, force = plot.pocket_statistics(uneven), uneven.pocket_force
    marks = [line for line in ax.lines if len(line.get_xdata()) == 12]
    assert len(marks) == 6
    for slot in range(3):
        x, low = data(marks[2 * slot])
        y, high = data(marks[2 * slot + 1])
        np.testing.assert_allclose(x, np.arange(12) + 0.16 * (slot - 1))
        np.testing.assert_allclose(y, x)
        np.testing.assert_allclose(low, np.percentile(force[:, :, slot], 95.0, axis=0))
        np.testing.assert_allclose(high, force[:, :, slot].max(axis=0))
        assert "touched 1e+02 %" in str(marks[2 * slot].get_label())


@pytest.mark.parametrize(("picture", "quantity"), [("contact_loads", "load"), ("film_parameter", "film_parameter")])
def test_around_the_bearing(uneven: Result, picture: str, quantity: str) -> None:
    ax = getattr(plot, picture)(uneven)
    angle = np.degrees(np.mod(uneven.roller_orbit_angle, 2.0 * np.pi))
    for index, (side, name) in enumerate(
        {"outer": "outer raceway", "inner": "inner raceway", "rib": "back-face rib"}.items()
    ):
        values, load = uneven[f"{side}_{quantity}"], uneven[f"{side}_load"]
        weight = load if quantity == "film_parameter" else np.ones_like(load)
        line = next(line for line in ax.lines if str(line.get_label()).startswith(name))
        assert line.get_color() == COLOURS[index]
        x, y = data(line)
        width = 5.0
        assert np.allclose(np.mod(x, width), 0.5 * width)
        for place, mean in zip(x, y, strict=True):
            inside = (angle >= place - 0.5 * width) & (angle < place + 0.5 * width)
            carried = inside & (weight > 0.0)
            expected = np.average(values[carried], weights=weight[carried]) if carried.any() else np.nan
            assert mean == pytest.approx(expected, rel=1e-9, nan_ok=True), place
        if quantity == "film_parameter":
            assert f"mean {np.average(values, weights=weight):.4g}" in str(line.get_label())  # that of the summary
        band = ax.collections[index].get_paths()[0].vertices
        here = (angle >= x[0] - 0.5 * width) & (angle < x[0] + 0.5 * width) & (weight > 0.0)
        low, high = np.percentile(values[here], (5.0, 95.0))
        at = band[np.isclose(band[:, 0], x[0]), 1]
        assert (at.min(), at.max()) == (pytest.approx(low), pytest.approx(high))


def test_spacing_angles(uneven: Result) -> None:
    ax = plot.spacing_angles(uneven)
    gaps = np.degrees(uneven.spacing_angles())
    curves = [line for line in ax.lines if len(line.get_xdata()) == len(uneven)]
    assert len(curves) == 12
    drawn = []
    for line in curves:
        x, y = data(line)
        np.testing.assert_allclose(x, turns(uneven))
        roller = int(np.argmin(np.abs(gaps - y[:, np.newaxis]).max(axis=0)))
        np.testing.assert_allclose(y, gaps[:, roller], rtol=1e-12)
        drawn.append(roller)
        label = str(line.get_label())
        assert label.startswith("_") or label == f"{roller}–{roller + 1}"
    assert sorted(drawn) == list(range(12)), "each gap once"


def test_bars_of_the_splits(uneven: Result) -> None:
    for draw, split, unit in (
        (plot.torque_split, uneven.torque_by_loss, "N m"),
        (plot.power_split, uneven.power_split, "W"),
    ):
        ax = draw(uneven)
        shown = {name.replace("_", " "): value for name, value in split.items() if value}
        labels = [label.get_text() for label in ax.get_yticklabels()]
        assert {label: bar.get_width() for label, bar in zip(labels, ax.patches, strict=True)} == pytest.approx(shown)
        assert [abs(bar.get_width()) for bar in ax.patches] == sorted(abs(value) for value in shown.values())
        total = sum(split.values())
        texts = [text.get_text() for text in ax.texts]
        for bar, text in zip(ax.patches, texts, strict=True):
            assert text == f"{bar.get_width():.3g} {unit} ({100.0 * bar.get_width() / total:.3g} %)"
        whole = uneven.inner_torque.mean() if unit == "N m" else total
        assert f"{whole:.4g} {unit} in all" in ax.get_xlabel()


@pytest.mark.parametrize("sizes", [(1.0, 2.0, 3.0), (-1.0, 2.0, 3.0), (1.0, 2.0, -3.0), (-1.0, -2.0, -3.0)])
def test_all_bars_lie_within_the_axes(
    uneven: Result, monkeypatch: pytest.MonkeyPatch, sizes: tuple[float, float, float]
) -> None:
    """Those that point to the left, too; the axis begins at zero only where there are none."""
    split = dict(zip(("raceways", "ribs", "pockets"), sizes, strict=True))
    monkeypatch.setattr(Result, "power_split", property(lambda _: split))
    ax = plot.power_split(uneven)
    low, high = ax.get_xlim()
    assert all(low <= bar.get_width() <= high for bar in ax.patches)
    assert (low == 0.0) == (min(sizes) > 0.0)


def test_energy_audit(uneven: Result) -> None:
    ax, balance = plot.energy_audit(uneven), uneven.energy_balance
    parts = {
        "work put in": balance["work_shaft"] + balance["work_gravity"] + balance["work_ring"],
        "losses": sum(values for name, values in balance.items() if name.startswith("loss_")),
        "stored": balance["kinetic_energy"] + balance["elastic_energy"],
        "residual": balance["residual"],
    }
    for label, values in parts.items():
        x, y = curve(ax, label)
        size, shaft = np.abs(values), turns(uneven)
        assert len(y) > 200
        assert y.max() == pytest.approx(size.max(), rel=1e-12)
        # each point is the largest of its own short stretch
        for place, value in list(zip(x, y, strict=True))[5:-5:10]:
            near = size[np.abs(shaft - place) < 1.6 * (shaft[1] - shaft[0])]
            assert np.isclose(near, value, rtol=1e-12).any(), label


def test_spectrum(uneven: Result) -> None:
    """Peaks at the order of the cage's whirl, and not at its mirror image."""
    ax = plot.spectrum(uneven)
    x, y = max((data(line) for line in ax.lines), key=lambda pair: pair[0].size)
    assert x[np.argmax(y)] == pytest.approx(1.0, abs=0.6)
    assert y[np.argmin(np.abs(x + 1.0))] < 0.5 * y.max()
