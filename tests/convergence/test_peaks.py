"""Peaks: what happens between records, whatever records are made; looked at step by step."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects, Result, Simulation
from trbdyn.model.cases import paper_30310
from trbdyn.results import peaks as peak_table
from trbdyn.results.file_format import as_kept

SPAN = 0.06
EVERY = [1e-3, 2e-4, 1e-4, 2e-5]
SHARE = 2e-3
"""What a held load of a ring's contact may be off; TRB_PEAK_SHARE of the core."""
FOLLOWED = 1e-3
"""The same of raceways, whose values follow slopes."""


def whirling() -> trb.Scene:
    return paper_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))


@pytest.fixture(scope="module")
def runs() -> dict[float, Result]:
    return {every: Simulation(whirling()).run(duration=SPAN, save_every=every) for every in EVERY}


@pytest.mark.parametrize("every", EVERY[1:])
def test_peaks_do_not_depend_on_records(runs: dict[float, Result], every: float) -> None:
    one, other = runs[EVERY[0]].peaks, runs[every].peaks
    names = {name for name, _, _ in Simulation(whirling()).bearings[0].model.peak_layout()}
    assert set(one) == {name for name in names if not name.startswith("land_")}  # no land guides this cage
    for name in one:
        np.testing.assert_array_equal(one[name], other[name], err_msg=name)


def test_pocket_statistics_are_those_of_all_steps(runs: dict[float, Result]) -> None:
    stats = runs[EVERY[0]].pocket_statistics()
    np.testing.assert_array_equal(stats.peak, runs[EVERY[-1]].peaks["pocket_force_peak"])
    np.testing.assert_array_equal(stats.mean, runs[EVERY[-1]].peaks["pocket_force_mean"])
    assert runs[EVERY[0]].summary()["pocket_force_peak"] == runs[EVERY[-1]].summary()["pocket_force_peak"]


def test_records_miss_what_peaks_see(runs: dict[float, Result]) -> None:
    samples = [runs[every].pocket_force.max() for every in EVERY]
    peaks = runs[EVERY[0]].peaks
    peak = peaks["pocket_force_peak"].max()
    assert samples[0] < 0.5 * peak
    # peaks look at the ends of steps: a record between two of them may see slightly more
    assert samples[-1] <= 1.02 * peak
    when = float(peaks["pocket_force_peak_time"].flat[peaks["pocket_force_peak"].argmax()])
    fine = Simulation(whirling()).run(duration=when + 1e-5, save_every=5e-7, save_groups=("pocket",))
    assert fine.pocket_force.max() == pytest.approx(peak, rel=0.02)


@pytest.mark.parametrize("every", EVERY)
def test_intervals_make_the_run(runs: dict[float, Result], every: float) -> None:
    """Extremes and numbers of impacts to the last bit, integrals to rounding; times lie in their intervals."""
    result = runs[every]
    whole, joined, time = result.peaks, result.window().peaks, result.time
    kept = {field.name for field in result.fields}
    for name, how in ((row[0], row[5]) for row in trb._core.peak_table() if row[0] in kept):
        if how == "time":
            start, end = time[:-1, None], time[1:, None]
            rows = result[name].reshape(time.size, -1)[1:]
            assert ((rows >= start) & (rows <= end)).all(), name
        if how in ("mean", "sum") or name == "pocket_impulse_peak":
            np.testing.assert_allclose(joined[name], whole[name], rtol=1e-12, atol=1e-15, err_msg=name)
        else:
            np.testing.assert_array_equal(joined[name], whole[name], err_msg=name)
    assert whole["pocket_impacts"].sum() > 20
    np.testing.assert_array_equal(joined["pocket_impacts"], result.pocket_impacts.sum(axis=0))


def test_the_first_record_has_the_peaks_of_its_instant() -> None:
    """Its interval has no length: of a run that begins, and of one that goes on with a ring of another load."""
    sim = Simulation(paper_30310(3000.0, 4930.0, 2000.0), accuracy="fast")
    for _ in range(2):
        result = sim.run(duration=1e-3, save_every=2e-4)
        for name in ("outer", "inner", "rib"):
            for kind in ("peak", "mean"):
                np.testing.assert_allclose(result[f"{name}_load_{kind}"][0], result[f"{name}_load"][0], rtol=SHARE)
        assert result.outer_load[0].min() > 100.0
        assert (result.outer_load_peak_time[0] == result.time[0]).all()


def test_means_do_not_alias(runs: dict[float, Result]) -> None:
    """Samples of the pockets' forces do not tell their mean; the impulse does, and a fine record agrees."""
    fine, coarse = runs[EVERY[-1]], runs[EVERY[0]]
    mean = coarse.peaks["pocket_force_mean"].sum()
    assert fine.pocket_force.mean(axis=0).sum() == pytest.approx(mean, rel=0.02)
    np.testing.assert_allclose(coarse.peaks["pocket_impulse"], coarse.peaks["pocket_force_mean"] * SPAN, rtol=1e-12)
    np.testing.assert_allclose(fine.outer_load.mean(), coarse.peaks["outer_load_mean"].mean(), rtol=2e-4)
    assert (coarse.peaks["pocket_impulse_peak"] <= coarse.peaks["pocket_impulse"]).all()


SCENES = {
    "axial": {},
    "radial": {"radial_load": 2000.0},
    "light": {"axial_load": 300.0},
    "two slices": {"effects": Effects.standard().replace(n_slices=2)},
    "tilted": {"misalignment_x": 1e-3},
    "dry": {
        "effects": Effects.standard().replace(lubrication="dry", rolling_resistance=False, rolling_pressure_force=False)
    },
    "damped": {
        "effects": Effects.standard().replace(
            lubrication="dry",
            rolling_resistance=False,
            rolling_pressure_force=False,
            damping="hunt_crossley",
            damping_race=2.0,
        )
    },
    "rollers": {"effects": Effects.standard().replace(bodies="rollers"), "start": trb.Start.equal()},
    "moving ring": {
        "axial_load": 0.0,
        "displacement": (0.0, trb.History.harmonic(0.0, 4e-6, frequency_hz=900.0), -3e-5),
    },
}


@pytest.mark.parametrize("name", SCENES)
def test_step_by_step(name: str) -> None:
    """Against records at the end of every step: of pockets to the last bit, of rings to what may be held."""
    usual = {"axial_load": 4930.0, "effects": Effects.standard(), "start": trb.Start.whirl(0.9)}
    scene = paper_30310(3000.0, **(usual | SCENES[name]))
    sim = Simulation(scene)
    sim._core.begin_peaks(0.0)
    rows = [sim.record()]
    while sim.time < 4e-3:
        sim.step()
        rows.append(sim.record())
    found = peak_table.from_row(sim._core.whole_peaks(sim.time), sim.bearings[0].model.peak_layout())
    records = {field: np.array([row[field] for row in rows]) for field in rows[0]}
    time = records["time"]
    np.testing.assert_array_equal(found["pocket_force_peak"], records["pocket_force"].max(axis=0))
    np.testing.assert_array_equal(found["pocket_force_peak_time"], time[records["pocket_force"].argmax(axis=0)])
    np.testing.assert_array_equal(found["skew_peak"], np.abs(records["roller_skew"]).max(axis=0))
    spacing = np.array([trb.observables.spacing(row["roller_orbit_angle"][None])[0] for row in rows])
    np.testing.assert_allclose(found["spacing_max"], spacing.max(axis=0), atol=1e-12)
    np.testing.assert_allclose(found["spacing_min"], spacing.min(axis=0), atol=1e-12)
    begun = (records["pocket_force"][1:] > 0.0) & (records["pocket_force"][:-1] <= 0.0)
    np.testing.assert_array_equal(found["pocket_impacts"], begun.sum(axis=0))
    for quantity in ("outer_load", "inner_load", "rib_load", "front_rib_load", "pocket_force"):
        mean = np.trapezoid(records[quantity], time, axis=0) / time[-1]
        size = records[quantity].max()
        np.testing.assert_allclose(
            found[f"{quantity}_mean"], mean, rtol=SHARE, atol=SHARE * size + 1e-300, err_msg=quantity
        )
    for quantity in ("outer_load", "inner_load", "rib_load", "outer_pressure", "inner_pressure", "rib_pressure"):
        rtol = SHARE if quantity.startswith("rib") else FOLLOWED
        np.testing.assert_allclose(
            found[f"{quantity}_peak"], records[quantity].max(axis=0), rtol=rtol, err_msg=quantity
        )
    for side in ("outer", "inner", "rib"):
        loaded = np.where(records[f"{side}_load"] > 0.0, records[f"{side}_film_parameter"], np.inf).min(axis=0)
        wanted = np.where(np.isfinite(loaded) & scene.effects.films, loaded, np.nan)
        np.testing.assert_allclose(
            found[f"{side}_film_parameter_min"], wanted, rtol=SHARE if side == "rib" else FOLLOWED, err_msg=side
        )


def test_rollers_thrown_at_the_front_rib_have_their_peaks() -> None:
    sim = Simulation(paper_30310(3000.0, 4930.0, effects=Effects.standard().replace(front_rib=True)))
    vector, geometry = sim.state.vector, sim.scene.bearing.geometry
    state = sim.view(vector)
    for roller in (2, 7):
        state["roller_r"][roller] -= 3e-4 * np.sin(geometry.roller_axis_angle)
        state["roller_z"][roller] -= 3e-4 * np.cos(geometry.roller_axis_angle)
        state["roller_v_z"][roller] -= 0.3
    sim.set_state(vector)
    sim._core.begin_peaks(0.0)
    rows = [sim.record()]
    while sim.time < 1e-3:
        sim.step()
        rows.append(sim.record())
    found = peak_table.from_row(sim._core.whole_peaks(sim.time), sim.bearings[0].model.peak_layout())
    loads = np.array([row["front_rib_load"] for row in rows])
    assert {*np.flatnonzero(loads.max(axis=0))} >= {2, 7}
    np.testing.assert_allclose(found["front_rib_load_peak"], loads.max(axis=0), rtol=SHARE)
    time = np.array([row["time"] for row in rows])
    mean = np.trapezoid(loads, time, axis=0) / time[-1]
    np.testing.assert_allclose(found["front_rib_load_mean"], mean, rtol=SHARE, atol=SHARE * loads.max())


def test_nobody_pays_who_does_not_ask(kit: SimpleNamespace, tmp_path: Path) -> None:
    """Without the group no look is made, rows are records, and asking says why there is nothing."""
    sim = kit.simulate(Effects.paper())
    seen = []
    result = sim.run(
        duration=1e-3,
        save_groups=["pocket"],
        output=tmp_path / "r.h5",
        callback=lambda now: seen.append(now._core.row_length),
    )
    assert set(seen) == {sim.bearings[0].model.record_length}
    assert not result._info.peaks
    with pytest.raises(trb.InputError, match="without the group 'peaks'"):
        _ = result.peaks
    assert "pocket_force_peak" not in result.summary()
    sim.run(duration=1e-3)
    assert sim._core.row_length == sim.bearings[0].model.record_length
    assert not sim._core.save_peaks().size


def test_files_hold_the_peaks(runs: dict[float, Result], tmp_path: Path) -> None:
    result = Simulation(whirling()).run(
        duration=SPAN, save_every=1e-3, save_groups=["peaks"], output=tmp_path / "run.h5"
    )
    loaded = trb.load(tmp_path / "run.h5")
    for found in (result, loaded):
        assert found.groups == ("time", "peaks")
        kept = {field.name: field for field in result.fields}
        for name in set(runs[1e-3].peaks) & set(kept):
            np.testing.assert_array_equal(found.peaks[name], runs[1e-3].peaks[name])
            # a file keeps seven digits of them, and nine of their times
            np.testing.assert_array_equal(found[name], as_kept(kept[name], runs[1e-3][name]))
    assert {field.unit for field in loaded.fields if field.name.endswith("_time")} == {"s"}
    with pytest.raises(trb.InputError, match="pocket_force_peak"):
        loaded.peaks["pocket_force_peek"]


def test_pieces_have_peaks_of_their_own(runs: dict[float, Result]) -> None:
    sim = Simulation(whirling())
    pieces = [sim.run(duration=SPAN / 2, save_every=1e-3).peaks for _ in range(2)]
    whole = runs[1e-3].peaks
    for name in ("pocket_force_peak", "outer_load_peak", "skew_peak"):
        np.testing.assert_allclose(np.maximum(pieces[0][name], pieces[1][name]), whole[name], rtol=SHARE)
    for half, when in zip(pieces, (0.0, SPAN / 2), strict=True):
        assert (half["pocket_force_peak_time"] >= when).all()
        assert (half["pocket_force_peak_time"] <= when + SPAN / 2).all()
    np.testing.assert_allclose(
        pieces[0]["pocket_impulse"] + pieces[1]["pocket_impulse"], whole["pocket_impulse"], rtol=1e-3, atol=1e-9
    )


def test_a_run_that_ends_early_has_its_peaks() -> None:
    sim = Simulation(whirling())
    result = sim.run(duration=SPAN, save_every=1e-2, callback=lambda now: now.time > 0.02)
    assert not result.success
    assert sim.time == result.final_time > 0.02
    assert result.peaks["pocket_force_peak_time"].max() <= result.final_time
    reference = Simulation(whirling()).run(duration=result.final_time, save_every=1e-3)
    np.testing.assert_array_equal(result.peaks["pocket_force_peak"], reference.peaks["pocket_force_peak"])


def test_what_users_read_after_a_run_is_at_its_end(kit: SimpleNamespace) -> None:
    """The integrator's last step reaches beyond; what is read does not, and the next run goes on as if nothing had been read."""
    end = 1.23456e-3
    sim = kit.simulate(Effects.paper())
    kit.throw(sim)
    whole = sim.copy()
    result = sim.run(duration=end, save_every=1e-4)
    assert sim._core.time > end
    assert sim.time == sim.state.time == result.final_time == result.time[-1] == end
    record = sim.record()
    kept = {field.name for field in result.fields}
    for name in record:
        if name in kept:
            np.testing.assert_array_equal(record[name], result[name][-1], err_msg=name)
    np.testing.assert_array_equal(result.final_state, sim.state.vector)
    np.testing.assert_array_equal(sim.view()["cage_x"], sim.view(sim.state.vector)["cage_x"])
    np.testing.assert_array_equal(sim.contacts()["pocket_load"], record["pocket_force"])
    copy = sim.copy()
    assert copy.time == end
    np.testing.assert_array_equal(copy.state.vector, sim.state.vector)
    sim.run(duration=1e-3)
    whole.run(duration=end + 1e-3)
    np.testing.assert_array_equal(sim._core.state(), whole._core.state())
    before = sim.time
    assert sim.step() > before
    assert sim.time == sim._core.time
    sim.run(duration=1e-4)
    sim.restart()
    assert sim._core.time == sim.time


def test_peaks_of_another_instant_or_length_are_refused() -> None:
    sim = Simulation(whirling())
    sim._core.begin_peaks(0.0)
    for _ in range(3):
        sim.step()
    saved = sim._core.save_peaks()
    later = saved.copy()
    later[0] += 1e-6
    for wrong, says in (
        (later, f"peaks: of t = {later[0]:.9g} s, not of {sim.time:.9g} s"),
        (saved[:-1], f"peaks: {saved.size} values needed, {saved.size - 1} given"),
    ):
        with pytest.raises(trb._core.CoreInputError) as caught:
            sim._core.restore_peaks(wrong)
        assert says in str(caught.value)
        assert sim._core.save_peaks().size == 0
    sim._core.restore_peaks(saved)
    np.testing.assert_array_equal(sim._core.save_peaks(), saved)
