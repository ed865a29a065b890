"""Error bars of averages: they hold the true mean as often as they say, and a run that is too short has none."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

import trbdyn as trb
from trbdyn import observables
from trbdyn.model.cases import paper_30310
from trbdyn.results import numbers
from trbdyn.results.confidence import confidence
from trbdyn.results.number import Number
from trbdyn.results.summary import table
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
    turning = np.cos(0.7 * np.arange(4000.0))
    assert (
        observables.correlation_time(np.arange(4000.0), turning) < 3.0
    )  # averages of a steady oscillation are exact soon


TURNS = 60
"""Values of each record, as of turns of the cage."""


def slow(rng: np.random.Generator, length: float) -> Array:
    """An Ornstein-Uhlenbeck process of mean 0 and variance 1 whose time scale is the record's length over `length`."""
    memory = math.exp(-length / TURNS)
    driven = math.sqrt(1.0 - memory**2) * rng.normal(size=20 * TURNS)
    return np.asarray(lfilter([1.0], [1.0, -memory], driven)[-TURNS:])


RECORDS: dict[str, Callable[[np.random.Generator], Array]] = {
    "independent": lambda rng: rng.normal(size=TURNS),
    "slow": lambda rng: slow(rng, 20.0),
    "slower": lambda rng: slow(rng, 10.0),
    "nearly as slow as the record": lambda rng: slow(rng, 5.0),
    "something slow below scatter": lambda rng: rng.normal(size=TURNS) + slow(rng, 5.0) / math.sqrt(0.4 * TURNS),
    "a beat and scatter": lambda rng: rng.normal(size=TURNS) + np.sin(1.7 * np.arange(TURNS) + 6.28 * rng.random()),
    "a beat and a slow drift": lambda rng: 0.3 * np.sin(2.1 * np.arange(TURNS) + 6.28 * rng.random()) + slow(rng, 8.0),
}


@pytest.mark.parametrize("kind", RECORDS)
def test_intervals_hold_the_true_mean(kind: str) -> None:
    """In 90 to 98 of 100 cases, where they are given; 300 cases scatter by 1.3 of 100."""
    rng = np.random.default_rng(7)
    made = [RECORDS[kind](rng) for _ in range(300)]
    widths = [observables.half_width(values) for values in made]
    given = sum(map(math.isfinite, widths))
    held = sum(abs(values.mean()) <= width for values, width in zip(made, widths, strict=True))
    assert given > 200
    assert 0.90 <= held / given <= 0.985, (held, given)


def test_intervals_are_hardly_wider_than_they_must_be() -> None:
    """A third wider than with a known scatter and nothing slow, at most."""
    rng = np.random.default_rng(8)
    widths = [observables.half_width(rng.normal(size=400)) for _ in range(50)]
    assert 1.0 < np.median(widths) / (1.96 / 20.0) < 1.35


@pytest.mark.parametrize("scatter", [0.0, 0.03, 0.1])
def test_creep_as_slow_as_the_record_has_no_interval(scatter: float) -> None:
    """It goes from 1 to 0 with the time scale of the record: its mean in the record, 0.63, tells nothing of the end."""
    rng = np.random.default_rng(9)
    for batches in (16, 40, 400):
        creep = np.exp(-np.arange(batches) / batches)
        made = [observables.mean_error(creep + scatter * rng.normal(size=batches)) for _ in range(50)]
        assert sum(math.isnan(one.half_width) for one in made) >= 45, batches
        assert min(one.drift for one in made) > 0.2


def test_half_width_needs_numbers() -> None:
    enough = np.random.default_rng(1).normal(size=16)
    assert math.isfinite(observables.half_width(enough))
    assert math.isnan(observables.half_width(enough[1:]))
    assert math.isnan(observables.half_width([*enough[1:], math.nan]))
    assert observables.half_width([2.0] * 16) == 0.0
    assert observables.half_width(-3.0 * enough + 5e3) == pytest.approx(3.0 * observables.half_width(enough), rel=1e-9)


def test_turns_of_the_cage_are_whole() -> None:
    """A signal that repeats itself in each turn has no error, however the window is cut."""
    time = np.arange(2000) * 1e-3
    made = MadeUp(time, np.cos(2.0 * math.pi * time / 0.05), np.ones(2000), turn=0.05)
    widths, words = confidence(made, ROWS, MadeUp.averages)  # type: ignore[arg-type]
    assert widths is not None
    assert widths["power_loss"] < 1e-3
    assert "39 batches of 1 turns of the cage" in words
    widths, words = confidence(made.window(1.3, 2.0), ROWS, MadeUp.averages)  # type: ignore[arg-type]
    assert widths is None
    assert "the window has 13 turns of the cage, and it takes 16" in words


def test_the_summary_says_which_averages_drift() -> None:
    """Of made-up batches, the torque climbs and the power loss scatters."""
    time = np.arange(2000) * 1e-3
    rng = np.random.default_rng(2)
    made = MadeUp(time, rng.normal(size=2000), 1.0 + 0.05 * time + 0.01 * rng.normal(size=2000), turn=0.02)
    widths, words = confidence(made, ROWS, MadeUp.averages)  # type: ignore[arg-type]
    assert widths is not None
    assert set(widths) == {"power_loss"}
    assert "none for what drifts in the window: torque;" in words
    widths, words = confidence(made, ROWS, MadeUp.averages, "it creeps")  # type: ignore[arg-type]
    assert widths is not None
    assert set(widths) == {"power_loss"}
    assert "none for the cage's motion, which is not known to have settled: it creeps" in words


def test_what_the_cage_takes_of_the_losses_is_added_where_its_motion_has_not_settled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The cage's motion may change yet, and with it what it takes of the losses: here by up to a tenth of them."""
    monkeypatch.setattr("trbdyn.results.confidence._of_cage", lambda window, edges: 0.1)
    rng = np.random.default_rng(4)
    made = MadeUp(np.arange(2000) * 1e-3, 5.0 + rng.normal(size=2000), np.ones(2000), turn=0.02)
    settled, _ = confidence(made, ROWS, MadeUp.averages)  # type: ignore[arg-type]
    unsettled, _ = confidence(made, ROWS, MadeUp.averages, "it creeps")  # type: ignore[arg-type]
    assert settled is not None
    assert unsettled is not None
    # batches are whole turns: their mean is the record's but for a few records
    assert unsettled["power_loss"] - settled["power_loss"] == pytest.approx(0.1 * 5.0, rel=0.02)


def lingering_whirls(rng: np.random.Generator, cages: int, turns: int, records: int = 40) -> Array:
    """Places over Cpr of cages that whirl about the axis and linger at the bottom, now longer and now shorter: (T, cages, 2)."""
    angle, slow = 2.0 * math.pi * rng.random(cages), np.zeros(cages)
    memory = math.exp(-0.5 / records)
    places = np.empty(((turns + 10) * records, cages, 2))
    for now in places:
        slow = memory * slow + math.sqrt(1.0 - memory**2) * rng.normal(size=cages)
        angle += 2.0 * math.pi / records * (1.0 + np.clip(0.5 + 0.25 * slow, 0.0, 0.95) * np.sin(angle))
        radius = 1.0 + 0.02 * rng.normal(size=cages)
        now[:, 0], now[:, 1] = radius * np.cos(angle), radius * np.sin(angle)
    return places[10 * records :]


class Locus:
    """The place of a cage, as the series of its percentiles read it."""

    groups = ("cage",)
    has_cage = True
    clearances = SimpleNamespace(radial=1.0)

    def __init__(self, place: Array) -> None:
        self.place = place
        self.orbit_radius_over_cpr = np.hypot(*(place - place.mean(axis=0)).T)
        self.axis_distance_over_cpr = np.hypot(*place.T)

    def __getitem__(self, name: str) -> Array:
        return {"cage_position": self.place}[name]


def test_percentiles_of_the_orbit_follow_its_mean_place() -> None:
    """Lingering moves the mean place, from which the orbit is measured, and hardly the cage's distances: without that part
    intervals of the orbit's percentiles held the value of many cages in 16 of 100 cases.
    """
    cages = [Locus(place) for place in lingering_whirls(np.random.default_rng(3), 100, 80).transpose(1, 0, 2)]
    for name, most in (("orbit_radius_over_cpr", 0.99), ("axis_distance_over_cpr", 1.0)):
        for share, end in ((0.05, "p05"), (0.95, "p95")):
            found = np.array([np.quantile(getattr(cage, name), share) for cage in cages])
            as_mean = numbers.TABLE[f"{name}_{end}"].series
            assert as_mean is not None
            series = [as_mean(cage).reshape(40, -1) for cage in cages]  # type: ignore[arg-type]
            widths = np.array([observables.half_width(batches.mean(axis=1)) for batches in series])
            assert np.isfinite(widths).mean() > 0.9
            assert 0.90 <= np.mean(np.abs(found - found.mean()) <= widths) <= most, (name, end)
            assert np.nanmedian(widths) < 4.0 * found.std()  # twice as wide as with a known scatter at most


class MadeUp:
    """A result with only what confidence intervals are computed from."""

    groups = ("power", "rollers")
    has_cage = False
    power_split: ClassVar[dict[str, float]] = {"rolling": 1.0}

    def __init__(self, time: np.ndarray, power: np.ndarray, torque: np.ndarray, turn: float) -> None:
        angle = 2.0 * math.pi * time[:, np.newaxis] / turn
        self.turn = turn
        self.of = {"time": time, "power_loss": power, "torque": torque, "roller_orbit_angle": angle}

    def __getitem__(self, name: str) -> np.ndarray:
        return self.of[name]

    def __len__(self) -> int:
        return int(self.of["time"].size)

    def window(self, start: float, stop: float) -> MadeUp:
        inside = (self.of["time"] >= start) & (self.of["time"] <= stop)
        return MadeUp(*(self.of[name][inside] for name in ("time", "power_loss", "torque")), turn=self.turn)

    def averages(self, rows: Iterable[Number]) -> dict[str, float]:
        return {row.name: float(self.of[row.name].mean()) for row in rows}


ROWS = [numbers.TABLE[name] for name in ("torque", "power_loss")]


@pytest.mark.slow
def test_the_summary_of_a_run_has_error_bars_that_later_windows_keep() -> None:
    """A whirl at 1230 N: averages of one half of two seconds agree with those of the other half.

    The difference of two halves has four times the variance of the mean of the whole. With as few as eight cosines an honest half
    width is 2.3 times the standard error told, so that four half widths are passed in one of 400 starts, and in none of 22 that
    were tried (root mean square 0.6 and 0.5 half widths).
    """
    scene = paper_30310(3000.0, 1230.0, effects=trb.Effects.paper().replace(quadrature="gauss", n_slices=4))
    result = trb.Simulation(scene, accuracy="fast").run(duration=2.0, save_every=1e-3)
    values = result.summary()
    widths = values["confidence"]
    assert set(widths) <= set(numbers.averages())
    assert {"torque", "pocket_duty", "orbit_rms_over_cpr", "cage_speed_ratio"} <= set(widths)
    assert "batches" in values["confidence_note"]
    assert f"± {widths['torque']:.2g}" in table(values)
    middle = 0.5 * (values["window_start"] + values["window_end"])
    halves = [
        numbers.all_averages(part) for part in (result.window(values["window_start"], middle), result.window(middle))
    ]
    for name in ("torque", "pocket_duty"):
        one, other = (half[name] for half in halves)
        assert abs(one - other) <= 4.0 * widths[name], name
        assert 0.0 < widths[name] < 0.4 * abs(values[name])


def test_a_short_run_has_none_and_says_why() -> None:
    result = trb.Simulation(paper_30310(3000.0, 4930.0)).run(duration=3e-3, save_every=1e-4)
    values = result.summary()
    assert "confidence" not in values
    assert "it takes 16 turns" in values["confidence_note"]
    assert "±" not in table(values).replace("behind ±", "")


AVERAGES = {"torque": 0.02, "orbit_rms_over_cpr": 0.25}
UNTIL = AVERAGES | {"cage": observables.LIMITS["orbit radius"]}


def rolling() -> trb.Simulation:
    effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=4)
    return trb.Simulation(paper_30310(3000.0, 1230.0, effects=effects, start=trb.Start.whirl(0.9)), accuracy="fast")


@pytest.fixture(scope="module")
def enough() -> trb.Result:
    return rolling().run(duration=4.0, until=UNTIL)


def test_a_run_ends_when_averages_are_known_as_well_as_was_asked_for(enough: trb.Result) -> None:
    values = enough.summary()
    assert enough.success
    assert enough.duration < 3.0
    assert "as far as was needed" in enough.message
    assert "orbit_rms_over_cpr is known within" in enough.message
    for name, share in AVERAGES.items():
        assert values["confidence"][name] <= share * abs(values[name])
    # two looks in a row were narrow, for the first time: the one before them was not
    looks = Until(UNTIL, 1 + math.ceil(4.0 / (enough.time[1] - enough.time[0]) - 1e-6))._looks
    place = looks.index(len(enough))
    earlier = enough.window(stop=enough.time[looks[place - 2] - 1]).summary()
    widths = earlier.get("confidence", {})
    wide = [widths.get(name, math.inf) > share * abs(earlier[name]) for name, share in AVERAGES.items()]
    assert any(wide) or widths.get("orbit_rms_over_cpr", math.inf) > UNTIL["cage"]


@pytest.mark.slow
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
    monkeypatch.setattr(Until, "reached", lambda until, done, so_far: True)
    monkeypatch.setattr(Watch, "look", lambda watch, *, final=False: "the energy" if final else look(watch))
    result = rolling().run(duration=4.0, until={"torque": 0.1})
    assert result.duration < 1.0
    assert not result.success
    assert "the energy" in result.message


class Looked:
    """Records with narrow intervals and an answer to whether the motion has settled."""

    def __init__(self, settling: str) -> None:
        self.settling, self.times = settling, np.arange(1000.0)

    def __getitem__(self, name: str) -> Array:
        return self.times

    def window(self, start: float = 0.0, stop: float = 0.0) -> Looked:
        return self

    def summary(self) -> dict[str, Any]:
        widths = {"torque": 1e-3} | ({"orbit_rms_over_cpr": 1e-3} if self.settling == "settled" else {})
        return {"torque": 1.0, "orbit_rms_over_cpr": 1.0, "confidence": widths, "confidence_note": "half widths"}


@pytest.mark.parametrize("settling", ["settled", "unknown", "drifting"])
def test_each_average_is_judged_by_itself(settling: str) -> None:
    """A torque does not wait for a cage that creeps; an orbit does."""
    for name, known in (("torque", True), ("orbit_rms_over_cpr", settling == "settled")):
        looks = Until({name: 0.01}, 1000)
        ended = [looks.reached(done, lambda: Looked(settling)) for done in looks._looks]  # type: ignore[arg-type, return-value]
        assert any(ended) == known, name


@pytest.mark.parametrize("settling", ["settled", "unknown", "drifting"])
def test_the_motion_of_the_cage_is_waited_for(settling: str) -> None:
    """By its name alone, or with the share of Cpr within which its orbit must be known."""
    short: Any = "cage"
    wanted = trb.RunOptions(revolutions=1.0, until=short).until
    assert wanted == {"cage": observables.LIMITS["orbit radius"]}
    for share, known in ((wanted["cage"], settling == "settled"), (1e-4, False)):
        looks = Until({"cage": share}, 1000)
        ended = [looks.reached(done, lambda: Looked(settling)) for done in looks._looks]  # type: ignore[arg-type, return-value]
        assert any(ended) == known
        said = "has settled within 0.001 Cpr" if settling == "settled" else "is not known to have settled"
        assert looks.said.startswith(f"the cage's motion {said}")


def test_a_run_ends_when_the_motion_of_the_cage_has_settled(enough: trb.Result) -> None:
    """1230 N at 3000 rpm: the whirl dies within half a second, and the rollers creep within 0.1 s."""
    assert enough.settling().settled
    assert "the cage's motion has settled within" in enough.message


@pytest.mark.slow
def test_creep_that_a_run_is_short_against_leaves_the_cage_no_interval() -> None:
    """Combined load: the rollers creep within 1.3 s, so that half a second tells nothing of the cage, and the run goes on."""
    scene = paper_30310(3000.0, 4930.0, 5530.0, effects=trb.Effects.standard(), start=trb.Start.unequal(1))
    with pytest.warns(trb.RunWarning, match="not known to have settled"):
        result = trb.Simulation(scene, accuracy="fast").run(
            duration=0.5, save_every=1e-3, until={"orbit_rms_over_cpr": 0.1}
        )
    assert result.duration == pytest.approx(0.5)
    widths = result.summary()["confidence"]
    assert "orbit_rms_over_cpr" not in widths
    assert 0.0 < widths["torque"] < 0.02 * result.summary()["torque"]


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
    alone = trb.Simulation(paper_30310(3000.0, 4930.0, effects=effects))
    with pytest.raises(trb.InputError, match="needs a cage"):
        alone.run(duration=0.1, until={"pocket_duty": 0.1})
    with pytest.raises(trb.InputError, match="needs a cage"):
        alone.run(duration=0.1, until="cage")
    with pytest.raises(trb.InputError, match="must be 'cage', or shares by the names of averages"):
        trb.RunOptions(revolutions=1.0, until="torque")  # type: ignore[arg-type]


def test_a_run_too_short_for_a_look_says_so() -> None:
    with pytest.warns(trb.RunWarning, match="it was too short for a look"):
        rolling().run(duration=2e-3, until={"torque": 0.1})
