"""Error bars of averages: they hold the true mean as often as they say, and a run that is too short has none."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

import trbdyn as trb
from trbdyn import observables
from trbdyn.model.cases import scene_30310
from trbdyn.results.confidence import AVERAGES, confidence
from trbdyn.results.summary import LABELS, table
from trbdyn.run.until import Until
from trbdyn.run.watch import Watch

Array = NDArray[np.float64]


def noise(seed: int, n: int, memory: float) -> tuple[Array, Array]:
    """An autoregressive process of mean 0 with the correlation time (1 + memory)/(1 - memory), in ms."""
    driven = np.random.default_rng(seed).normal(size=n + 2000)
    return np.arange(n) * 1e-3, lfilter([1.0], [1.0, -memory], driven)[2000:]


@pytest.mark.parametrize(("memory", "n"), [(0.0, 4000), (0.9, 10_000), (0.98, 40_000)])
def test_correlation_time(memory: float, n: int) -> None:
    found = [observables.correlation_time(*noise(seed, n, memory)) for seed in range(20)]
    assert np.mean(found) == pytest.approx(1e-3 * (1.0 + memory) / (1.0 - memory), rel=0.05)


def test_correlation_time_of_what_does_not_change() -> None:
    assert observables.correlation_time([0.0, 0.1, 0.2], [5.0, 5.0, 5.0]) == pytest.approx(0.1)
    assert math.isnan(observables.correlation_time([0.0], [1.0]))
    assert observables.batches(np.arange(1000.0), [np.arange(1000.0)]) == []  # a drift remembers itself for ever
    turning = np.cos(0.7 * np.arange(4000.0))
    assert (
        observables.correlation_time(np.arange(4000.0), turning) < 3.0
    )  # averages of a steady oscillation are exact soon


@pytest.mark.parametrize(("memory", "n"), [(0.0, 2000), (0.95, 4000), (0.98, 4000)])
def test_intervals_hold_the_true_mean(memory: float, n: int) -> None:
    """In 95 of 100 cases, they say; 300 cases scatter by 1.3 of 100."""
    held = given = 0
    for seed in range(300):
        time, values = noise(1000 + seed, n, memory)
        parts = observables.batches(time, [values])
        if parts:
            means = [values[part].mean() for part in parts]
            given += 1
            held += abs(np.mean(means)) <= observables.half_width(means)
    assert given > 280
    assert 0.90 * given <= held <= 0.985 * given


def test_batches_cover_the_end_and_are_alike() -> None:
    time, values = noise(1, 5003, 0.9)
    parts = observables.batches(time, [values], least=0.4)
    assert parts[-1].stop == time.size
    assert {part.stop - part.start for part in parts} == {400}
    assert all(a.stop == b.start for a, b in itertools.pairwise(parts))
    assert observables.batches(time, [values], least=2.0) == []
    assert observables.batches(time[:9], [values[:9]]) == []
    slow = observables.batches(time, [values, np.cumsum(values)])
    assert slow == []


def test_half_width_needs_numbers() -> None:
    assert math.isnan(observables.half_width([1.0, 2.0, 3.0, 4.0]))
    assert math.isnan(observables.half_width([1.0, 2.0, 3.0, 4.0, math.nan]))
    assert observables.half_width([2.0] * 6) == 0.0


def test_an_average_that_drifts_has_no_half_width() -> None:
    """A drift of the batches' means has none; independent ones lose theirs by chance in about 1 of 100 cases."""
    rng = np.random.default_rng(5)
    assert math.isnan(observables.half_width(np.linspace(1.0, 2.0, 20)))
    assert math.isnan(observables.half_width(rng.normal(size=20) + np.linspace(-3.0, 3.0, 20)))
    for batches in (5, 10, 20):
        lost = sum(math.isnan(observables.half_width(rng.normal(size=batches))) for _ in range(1000))
        assert lost <= 25, batches


def test_the_summary_says_which_averages_drift() -> None:
    """Of made-up batches, the torque climbs and the power loss scatters."""
    time = np.arange(2000) * 1e-3
    rng = np.random.default_rng(2)
    made = MadeUp(time, rng.normal(size=2000), 1.0 + 0.05 * time + 0.01 * rng.normal(size=2000))
    widths, words = confidence(made, MadeUp.averages)  # type: ignore[arg-type]
    assert widths is not None
    assert set(widths) == {"power_loss"}
    assert "none for what drifts from batch to batch: torque;" in words


class MadeUp:
    """A result with only what confidence intervals are computed from."""

    groups = ("power",)
    has_cage = False

    def __init__(self, time: np.ndarray, power: np.ndarray, torque: np.ndarray) -> None:
        self.of = {"time": time, "power_loss": power, "torque": torque}

    def __getitem__(self, name: str) -> np.ndarray:
        return self.of[name]

    def window(self, start: float, stop: float) -> MadeUp:
        inside = (self.of["time"] >= start) & (self.of["time"] <= stop)
        return MadeUp(*(self.of[name][inside] for name in ("time", "power_loss", "torque")))

    def averages(self) -> dict[str, float]:
        return {name: float(self.of[name].mean()) for name in ("torque", "power_loss")}


def test_the_summary_of_a_run_has_error_bars_that_later_windows_keep() -> None:
    """A whirl at 1230 N: averages of one half of a second agree with those of the other half within both intervals."""
    scene = scene_30310(3000.0, 1230.0, effects=trb.Effects.paper().replace(quadrature="gauss", n_slices=4))
    result = trb.Simulation(scene, accuracy="fast").run(duration=1.2, save_every=5e-4)
    values = result.summary()
    widths = values["confidence"]
    assert set(widths) <= set(AVERAGES) <= set(LABELS)
    assert {"torque", "pocket_duty", "orbit_radius_over_cpr", "cage_speed_ratio"} <= set(widths)
    assert "batches" in values["confidence_note"]
    assert f"± {widths['torque']:.2g}" in table(values)
    middle = 0.5 * (values["window_start"] + values["window_end"])
    halves = [result.window(values["window_start"], middle), result.window(middle)]
    for name, of in (
        ("torque", lambda part: float(part["inner_torque"].mean())),
        ("pocket_duty", lambda part: float((part["pocket_force"] > 0).any(axis=2).mean())),
    ):
        one, other = map(of, halves)
        # each half has twice the variance of the whole, their difference four times: two half widths, and half as much again
        assert abs(one - other) <= 3.0 * widths[name], name
        assert 0.0 < widths[name] < 0.2 * abs(values[name])


def test_a_short_run_has_none_and_says_why() -> None:
    result = trb.Simulation(scene_30310(3000.0, 4930.0)).run(duration=3e-3, save_every=1e-4)
    values = result.summary()
    assert values["confidence"] is None
    assert "too short" in values["confidence_note"]
    assert "±" not in table(values).replace("behind ±", "")


UNTIL = {"torque": 0.02, "orbit_radius_over_cpr": 0.25}


def rolling() -> trb.Simulation:
    effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=4)
    return trb.Simulation(scene_30310(3000.0, 1230.0, effects=effects, start=trb.Start.whirl(0.9)), accuracy="fast")


@pytest.fixture(scope="module")
def enough() -> trb.Result:
    return rolling().run(duration=4.0, until=UNTIL)


def test_a_run_ends_when_averages_are_known_as_well_as_was_asked_for(enough: trb.Result) -> None:
    values = enough.summary()
    assert enough.success
    assert enough.duration < 3.0
    assert "as far as was needed" in enough.message
    assert "orbit_radius_over_cpr is known within" in enough.message
    for name, share in UNTIL.items():
        assert values["confidence"][name] <= share * abs(values[name])
    # two looks in a row were narrow, for the first time: the one before them was not
    looks = Until(UNTIL, 4001)._looks
    place = looks.index(len(enough))
    earlier = enough.window(stop=enough.time[looks[place - 2] - 1]).summary()
    widths = earlier["confidence"] or {}
    assert any(widths.get(name, math.inf) > share * abs(earlier[name]) for name, share in UNTIL.items())


def test_files_and_resuming_change_nothing(enough: trb.Result, tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    groups = ("cage", "rollers", "torque", "energy")
    options: dict[str, Any] = {"duration": 4.0, "until": UNTIL, "output": path, "save_groups": groups}
    written = rolling().run(**options)
    assert len(written) == len(enough)
    np.testing.assert_array_equal(written.final_state, enough.final_state)

    cut, calls = tmp_path / "cut.h5", 0

    def stop(sim: trb.Simulation) -> bool:
        nonlocal calls
        calls += 1
        return sim.time > 0.3

    whole = rolling().run(**options | {"output": tmp_path / "whole.h5", "checkpoint_every": 0.1})
    first = rolling().run(**options | {"output": cut, "checkpoint_every": 0.1, "callback": stop})
    assert calls > 1
    assert not first.success
    again = trb.resume(cut)
    assert len(again) == len(whole) < 4001
    np.testing.assert_array_equal(again.final_state, whole.final_state)
    assert again.message == whole.message


def test_a_run_that_is_wrong_does_not_end_well_because_it_has_what_was_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The look at the energy that a run ends with counts there, too."""
    look = Watch.look
    monkeypatch.setattr(Watch, "look", lambda watch, *, final=False: "the energy" if final else look(watch))
    result = rolling().run(duration=4.0, until=UNTIL)
    assert result.duration < 3.0
    assert not result.success
    assert "the energy" in result.message


def test_a_run_that_ends_without_it_says_so() -> None:
    with pytest.warns(trb.RunWarning, match="without the confidence that was asked for: torque"):
        result = rolling().run(duration=0.1, until={"torque": 1e-6})
    assert result.success
    assert any("without the confidence" in text for text in result.warnings)


@pytest.mark.parametrize(
    ("until", "said"),
    [
        ({"torqe": 0.1}, "did you mean torque"),
        ({"pocket_force_peak": 0.1}, "must name averages"),
        ({"torque": 2}, "run.until.torque = 2"),
        ({"torque": True}, "must be a number"),
        ({"torque": 0.0}, "must be > 0"),
        ({"torque": math.nan}, "run.until.torque = nan"),
    ],
)
def test_what_cannot_be_asked_for(until: dict[str, float], said: str) -> None:
    with pytest.raises(trb.InputError, match=said):
        rolling().run(duration=0.1, until=until)


def test_what_is_not_kept_cannot_be_asked_for() -> None:
    with pytest.raises(trb.InputError, match="must hold torque"):
        rolling().run(duration=0.1, until={"torque": 0.1}, save_groups=("cage", "rollers"))
    effects = trb.Effects.paper().replace(bodies="rollers")
    alone = trb.Simulation(scene_30310(3000.0, 4930.0, effects=effects))
    with pytest.raises(trb.InputError, match="needs a cage"):
        alone.run(duration=0.1, until={"pocket_duty": 0.1})


def test_a_run_too_short_for_a_look_says_so() -> None:
    with pytest.warns(trb.RunWarning, match="it was too short for a look"):
        rolling().run(duration=2e-3, until={"torque": 0.1})
