"""The pictures around the bearing, of the whirl, and the drawings: what they show agrees with the records."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest

import trbdyn as trb
from trbdyn.plot.around import binned
from trbdyn.plot.whirling import section_points
from trbdyn.run.replay import Replay


@pytest.fixture(scope="module")
def loaded() -> trb.Result:
    return trb.Simulation(trb.cases.paper_30310(2000.0, 4930.0, 5530.0)).run(revolutions=4)


@pytest.fixture(autouse=True)
def _close() -> object:
    yield
    plt.close("all")


def test_load_zone_is_largest_where_the_load_acts(loaded: trb.Result) -> None:
    ax = trb.plot.load_zone(loaded)
    angle, load = ax.lines[0].get_data()
    assert np.degrees(angle[np.argmax(load)]) == pytest.approx(90.0, abs=10.0)
    assert load.max() == pytest.approx(loaded.outer_load.max(), rel=0.01)
    assert load.min() == pytest.approx(loaded.outer_load.min(), rel=0.01)
    with pytest.raises(trb.InputError, match="polar"):
        trb.plot.load_zone(loaded, ax=plt.subplots()[1])


def test_bins() -> None:
    place, mean, low, high = binned(np.array([0.1, 0.2, 3.0, -0.1]), np.array([1.0, 3.0, 5.0, 7.0]), 4)
    assert np.allclose(np.degrees(place), [45, 135, 315])
    assert mean.tolist() == [2.0, 5.0, 7.0]
    assert (low.tolist(), high.tolist()) == ([1.0, 5.0, 7.0], [3.0, 5.0, 7.0])


def test_pressure_map_shows_the_recorded_pressures(loaded: trb.Result) -> None:
    figure = trb.plot.pressure_map(loaded, records=40)
    outer, inner = (axes.collections[0].get_array() for axes in figure.axes[:2])
    assert np.nanmax(outer) == pytest.approx(1e-9 * loaded.outer_pressure.max(), rel=0.02)
    assert np.nanmax(inner) == pytest.approx(1e-9 * loaded.inner_pressure.max(), rel=0.02)
    least, most = min(np.nanmin(outer), np.nanmin(inner)), max(np.nanmax(outer), np.nanmax(inner))
    for axes in figure.axes[:2]:  # both rings by the same colours
        assert axes.collections[0].get_clim() == pytest.approx((least, most))
    places, _ = np.asarray(inner).T.shape[::-1] if np.asarray(inner).ndim == 2 else (72, 24)
    assert places in (24, 72)


def test_contact_map_of_other_quantities(loaded: trb.Result) -> None:
    figure = trb.plot.contact_map(loaded, "load_per_length", sides=["inner"], records=5)
    found = np.nanmax(figure.axes[0].collections[0].get_array())
    contacts = Replay(loaded).contacts(0)
    assert found == pytest.approx(1e-3 * contacts["raceway_load_per_length"][1].max(), rel=0.1)
    for options, match in (
        ({"quantity": "colour"}, "quantity = 'colour' : must be one of pressure"),
        ({"sides": ["rib"]}, "sides = 'rib'"),
        ({"records": 0}, "records = 0"),
    ):
        with pytest.raises(trb.InputError, match=match):
            trb.plot.contact_map(loaded, **options)


def test_attitude_and_torque_follow_the_records(loaded: trb.Result) -> None:
    figure = trb.plot.attitude(loaded)
    skew = figure.axes[0].lines[0].get_ydata()
    assert 1e3 * loaded.roller_skew.min() <= skew.min() <= skew.max() <= 1e3 * loaded.roller_skew.max()
    ax = trb.plot.torque_sources(loaded)
    assert ax.lines[0].get_ydata().max() == pytest.approx(loaded.inner_torque.max())
    labels = " ".join(text.get_text() for text in ax.get_legend().get_texts())
    assert f"mean {loaded.inner_torque.mean():.4g} N m" in labels


def test_poincare_takes_the_cage_once_a_turn() -> None:
    scene = trb.cases.paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))
    result = trb.Simulation(scene).run(revolutions=8)
    points = section_points(result, "cage")
    assert len(points) == 1 + int(result.cage_angle[-1] / (2 * np.pi))
    assert np.allclose(points[0], result.cage_locus()[0])
    assert len(section_points(result, "shaft")) == 9
    assert len(section_points(result, "roller")) == 1 + int(result.cage_angle[-1] / (2 * np.pi / 12))
    with pytest.raises(trb.InputError, match="once_per = 'day'"):
        section_points(result, "day")  # type: ignore[arg-type]
    dots = trb.plot.poincare(result).collections[0].get_offsets()
    assert np.allclose(dots, points)


def test_pocket_polar_shows_the_peaks() -> None:
    scene = trb.cases.paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))
    result = trb.Simulation(scene).run(revolutions=2)
    heights = [bar.get_height() for bar in trb.plot.pocket_polar(result).patches]
    assert max(heights) == pytest.approx(result.peaks["pocket_force_peak"].max())
    quiet = result.window(stop=0.0)
    trb.plot.pocket_polar(quiet)


def test_waterfall_peaks_at_the_whirl() -> None:
    runs = [
        trb.Simulation(trb.cases.paper_30310(speed, 4930.0, start=trb.Start.whirl(0.9))).run(revolutions=6)
        for speed in (3000.0, 1000.0)
    ]
    ax = trb.plot.waterfall(runs)
    for line, run in zip(ax.lines[:2], reversed(runs), strict=True):
        x, y = line.get_data()
        shaft = abs(float(run.shaft_speed.mean())) / (2 * np.pi)
        assert x[np.argmax(y)] == pytest.approx(run.whirl_frequency / shaft, abs=0.2)
    narrow = trb.plot.waterfall(runs, reach=0.5, decades=0.5)
    assert narrow.get_xlim() == pytest.approx((-0.5, 0.5), abs=0.1)
    for reach, decades in ((0.0, 1.0), (1.0, 0.0)):
        with pytest.raises(trb.InputError, match="must be > 0"):
            trb.plot.waterfall(runs, reach=reach, decades=decades)
    for bad in ([], [runs[0].window(stop=1e-3)]):
        with pytest.raises(trb.InputError, match="results"):
            trb.plot.waterfall(bad)


def test_drawings_of_every_pocket_shape(tmp_path: Path) -> None:
    bearing = trb.cases.bearing_32216()
    for name, build in trb.pocket_shapes.SHAPES.items():
        pocket = build(bearing, 20.0) if name == "drafted" else build(bearing)
        own = bearing.replace(cage=bearing.cage.replace(pocket=pocket))
        figure = trb.plot.pocket_drawing(own, 3)
        assert len(figure.axes[1].lines) == len(pocket.faces)
    figure = trb.plot.save(trb.plot.bearing_drawing(bearing), tmp_path / "b.png")
    assert figure.stat().st_size > 10_000
    with pytest.raises(trb.InputError, match="pocket = 16"):
        trb.plot.pocket_drawing(bearing, 16)
