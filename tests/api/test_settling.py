"""Three answers to whether a run has settled: settled, drifting with its time scale, not to be told from so short a run."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import observables as obs
from trbdyn.model.cases import paper_30310

CAGE = 130.0  # rad/s
NOISE = np.random.default_rng(5)


def judged(
    duration: float,
    radius: Any = 0.5,
    spacing: Any = 0.3,
    creep_time: float = math.nan,
    noise: float = 0.02,
    centre: complex = 0.0,
) -> obs.MotionSettling:
    """A cage whirling with its own rotation, with radius and spacing given as numbers or functions of time."""
    t = np.linspace(0.0, duration, int(2000 * duration) + 1)

    def values(of: Any) -> np.ndarray:
        found = of(t) if callable(of) else np.full(t.size, of)
        return np.asarray(found + noise * NOISE.normal(size=t.size))

    place = centre + values(radius) * np.exp(1j * CAGE * t)
    return obs.motion_settling(
        t, CAGE * t, values(spacing), np.column_stack([place.real, place.imag]), CAGE * t, creep_time
    )


def test_settled() -> None:
    found = judged(3.0, creep_time=0.5)
    assert (found.answer, found.settled, str(found)) == ("settled", True, "yes")
    assert math.isnan(found.time_scale)
    assert set(found.drifts) == set(obs.LIMITS)
    assert found.drifts["orbit radius"].mean == pytest.approx(0.5, rel=0.02)


def test_a_transient_is_cut_off() -> None:
    found = judged(4.0, radius=lambda t: 0.5 + 0.4 * np.exp(-t / 0.1), creep_time=0.5)
    assert found.settled
    assert 0.2 < found.time < 2.0


def test_a_run_that_is_short_against_the_creep_cannot_be_told() -> None:
    """However steady it looks: the same record, and only the creep differs."""
    found = judged(3.0, creep_time=4.5)
    assert found.answer == "unknown"
    assert "creep within 4.5 s" in str(found)
    assert judged(3.0, creep_time=0.9).settled


def test_a_drift_that_matters_within_the_creep_is_a_drift() -> None:
    """2 % a second: 6 % within the record, which may pass, and 27 % within three times the creep, which may not."""
    slow = {"duration": 3.0, "radius": lambda t: 0.5 * (1.0 + 0.02 * t)}
    assert judged(**slow).answer == "settled"
    assert judged(**slow, creep_time=4.5).answer == "drifting"


def test_few_turns_cannot_be_told() -> None:
    assert "only 2.1 turns" in str(judged(0.1))
    assert judged(0.3, creep_time=0.01).answer == "unknown"


@pytest.mark.parametrize("rate", [0.08, -0.08])
def test_drift_has_its_time_scale(rate: float) -> None:
    found = judged(3.0, spacing=lambda t: 0.4 + rate * t, noise=0.002)
    assert found.answer == "drifting"
    assert "roller spacing" in found.reason
    assert ("increases" if rate > 0 else "decreases") in found.reason
    mean = found.drifts["roller spacing"].mean
    assert found.time_scale == pytest.approx(mean / abs(rate), rel=0.1)
    assert found.drifts["roller spacing"].rate == pytest.approx(rate, abs=4 * found.drifts["roller spacing"].error)


def test_a_whirl_that_grows_from_almost_nothing_drifts() -> None:
    """Its radius hardly changes in the record; its logarithm does."""
    found = judged(6.0, radius=lambda t: 1e-3 * np.exp(t / 2.0), creep_time=2.0, noise=1e-4)
    assert found.answer == "drifting"
    assert found.time_scale == pytest.approx(2.0, rel=0.15)
    assert "grows" in found.reason
    assert found.growth_rate == pytest.approx(0.5, rel=0.15)


def test_scatter_is_no_drift() -> None:
    """At most a few in a hundred steady records with slow scatter are called drifting."""
    wrong = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        slow = np.repeat(0.02 * rng.normal(size=80), 100)

        def radius(t: np.ndarray, slow: np.ndarray = slow) -> np.ndarray:
            return 0.5 + slow[np.minimum((t * 20).astype(int), 79)]

        wrong += judged(4.0, radius=radius, creep_time=0.3, noise=0.005).answer == "drifting"
    assert wrong <= 3


def test_rollers_without_a_cage_are_judged_by_their_spacing() -> None:
    t = np.linspace(0.0, 2.0, 4001)
    steady = obs.motion_settling(t, CAGE * t, 0.3 + 0.01 * NOISE.normal(size=t.size))
    assert steady.settled
    assert steady.growth_rate == 0.0
    assert obs.motion_settling(t, CAGE * t, 0.3 + 0.4 * t).answer == "drifting"


def test_a_radius_that_only_scatters_does_not_grow() -> None:
    """A radius that jumps between hardly anything and half of the play: its logarithm ends higher by chance."""
    from trbdyn.results.observables.slow_motion import moving

    when = np.linspace(0.0, 4.0, 40)
    grown = 0
    for seed in range(40):
        size = np.exp(np.random.default_rng(seed).normal(-3.0, 1.0, 40))
        grown += bool(moving(when, {"whirl amplitude": size}, {}, 10.0))
    assert grown <= 3
    assert moving(when, {"whirl amplitude": np.exp(0.5 * when - 3.0)}, {}, 10.0)
    assert not moving(when, {"whirl amplitude": np.exp(0.02 * when - 3.0)}, {}, 10.0)  # by less than a tenth


def test_drift_needs_turns() -> None:
    with pytest.raises(ValueError, match="at least 5"):
        obs.drift([0.0, 1.0], [0.0, 1.0])
    exact = obs.drift(np.arange(10.0), 3.0 + 0.5 * np.arange(10.0))
    assert exact.rate == pytest.approx(0.5)
    assert exact.error == pytest.approx(0.0, abs=1e-12)
    assert exact.significant


def test_the_slow_whirl_at_high_load_is_not_settled_in_a_second() -> None:
    """3000 rpm, equal start: at 4930 N the whirl takes tens of seconds to grow, at 1230 N the rollers yield within a turn."""
    answers = {}
    for load, duration in ((4930.0, 1.0), (1230.0, 1.0)):
        scene = paper_30310(3000.0, load, effects=trb.Effects.paper().replace(quadrature="gauss", n_slices=8))
        run = trb.Simulation(scene, accuracy="fast").run(
            duration=duration, save_every=1e-3, save_groups=["cage", "rollers"]
        )
        answers[load] = run.settling()
        assert run.summary()["settled"] is answers[load].settled
    assert answers[4930.0].answer in ("drifting", "unknown")
    assert 3.0 < answers[4930.0].creep_time < 6.0
    assert answers[1230.0].settled
    assert answers[1230.0].creep_time < 0.1


def test_creep_time_of_any_scene() -> None:
    """A number where the law holds, nan elsewhere; never a warning or an error."""
    import warnings

    from trbdyn.statics.creep import creep_time

    known = [
        paper_30310(),
        paper_30310(2000.0, 4930.0, 5530.0),
        paper_30310(3000.0, 1230.0, 3000.0),
        paper_30310(gravity=(0.0, 0.0, 0.0)),
        paper_30310(effects=trb.Effects.standard()),
        trb.cases.scene_32216(-2000.0),
    ]
    unknown = [
        paper_30310(0.0),
        paper_30310(effects=trb.Effects.minimal()),
        paper_30310(effects=trb.Effects.frictionless()),
        paper_30310(effects=trb.Effects.paper().replace(bodies="rollers")),
        paper_30310(trb.History.ramp(0.0, 1.0, 0.0, 3000.0)),
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for scene in known:
            assert 1e-3 < creep_time(scene) < 100.0
        for scene in unknown:
            assert math.isnan(creep_time(scene))
    light, heavy = (creep_time(paper_30310(3000.0, load)) for load in (1230.0, 4930.0))
    assert light < 0.02 * heavy


def test_bounds_of_a_rate() -> None:
    """Two and three standard errors where there are many blocks; Student's factors where there are few."""
    many = obs.drift(np.arange(4000.0), np.zeros(4000))
    assert many.freedom == 10
    for rate in (0.3, -0.3):
        known = type(many)(mean=1.0, rate=rate, error=0.05, freedom=10**7)
        assert known.bound == pytest.approx(0.3 + 2.0 * 0.05, rel=1e-3)
        few = type(many)(mean=1.0, rate=rate, error=0.05, freedom=4)
        assert few.bound == pytest.approx(0.3 + 2.869 * 0.05, rel=2e-3)
    for rate, stands_out in ((0.155, True), (0.145, False), (-0.155, True), (-0.145, False)):
        assert type(many)(mean=1.0, rate=rate, error=0.05, freedom=10**7).significant is stands_out


def slow(rng: np.random.Generator, count: int, memory: int, size: float) -> np.ndarray:
    """Scatter of a size that remembers itself over some records."""
    from scipy import signal

    keep = math.exp(-1.0 / memory)
    return np.asarray(signal.lfilter([1.0], [1.0, -keep], rng.normal(size=count) * size * math.sqrt(1.0 - keep**2)))


def test_a_promised_length_holds() -> None:
    """Records that grow by a fifth from look to look until they are told: the length lies in 95 of 100 ranges that were promised
    before, also where the scatter is as slow as several turns, and none has settled sooner than was said.
    """
    step, last = 5e-3, 20.0
    t = np.arange(0.0, last, step)
    held: list[bool] = []
    soon: list[bool] = []
    for seed in range(6):
        for memory, size, creep in ((4, 0.05, 1.0), (4, 0.15, 0.1), (20, 0.1, 0.1), (60, 0.1, 0.1)):
            rng = np.random.default_rng(seed)
            place = (0.5 + slow(rng, t.size, memory, size)) * np.exp(1j * CAGE * t)
            centre, spacing = np.column_stack([place.real, place.imag]), 0.3 + slow(rng, t.size, memory, 0.1 * size)
            length, promised = 0.6, []
            while length < last:
                cut = slice(0, int(length / step))
                found = obs.motion_settling(t[cut], CAGE * t[cut], spacing[cut], centre[cut], CAGE * t[cut], creep)
                if found.answer != "unknown":
                    break
                promised.append((found.needed, found.needed_high))
                length *= 1.2
            for low, high in promised:
                soon.append(found.answer == "settled" and length < low / 1.2)
                if not math.isnan(high) and (length < last or 1.2 * high < last):
                    held.append(length <= 1.2 * high)
    assert len(held) > 40
    assert np.mean(held) >= 0.95
    assert np.mean(soon) <= 0.02


def test_a_drift_does_not_end_before_its_promised_length() -> None:
    """An approach with scatter, looked at as above: it has not settled before what was promised while it drifted."""
    t, step = np.arange(0.0, 12.0, 5e-3), 5e-3
    soon: list[bool] = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        place = (0.5 + 0.4 * np.exp(-t) + slow(rng, t.size, 10, 0.02)) * np.exp(1j * CAGE * t)
        centre, spacing = np.column_stack([place.real, place.imag]), np.full(t.size, 0.3)
        length, promised = 0.6, []
        while length < 12.0:
            cut = slice(0, int(length / step))
            found = obs.motion_settling(t[cut], CAGE * t[cut], spacing[cut], centre[cut], CAGE * t[cut], 0.1)
            if found.settled:
                break
            if found.answer == "drifting":
                promised.append(found.needed)
                assert math.isnan(found.needed_high)
            length *= 1.2
        assert found.settled
        soon += [length < low / 1.2 for low in promised]
    assert len(soon) > 10
    assert np.mean(soon) <= 0.05


def test_a_mean_is_known_as_the_square_root_of_the_length() -> None:
    """Sixteen times the turns, a quarter of the error; and the interval holds the true mean, also of turns that are alike."""
    for memory in (0, 3):
        widths, held = [], []
        for count in (96, 1536):
            found = []
            for seed in range(30):
                rng = np.random.default_rng(seed)
                scatter = slow(rng, count + 50, memory, 0.01)[50:] if memory else 0.01 * rng.normal(size=count)
                found.append(obs.mean_unknown(np.arange(count), 1.0 + scatter))
                held.append(abs(scatter.mean()) <= found[-1])
            widths.append(np.median(found))
        assert widths[0] / widths[1] == pytest.approx(4.0, rel=0.45 if memory else 0.25)
        assert np.mean(held) >= 0.95


def test_the_mean_of_a_drift_is_not_known() -> None:
    """Turns that climb by one and scatter: their mean may be off by as much."""
    t = np.linspace(0.0, 1.0, 40)
    for seed in range(5):
        assert obs.mean_unknown(t, t + 0.05 * np.random.default_rng(seed).normal(size=40)) > 0.8


@pytest.mark.parametrize(
    ("start", "rate", "side"), [(0.08, 0.002, "above"), (0.03, 0.0, "below"), (0.06, 0.0015, "unknown")]
)
def test_a_side_of_a_limit(start: float, rate: float, side: str) -> None:
    """3 % of slip that grows does not stay below 10 %, however small its change from quarter to quarter."""
    time = np.arange(24.0)
    assert obs.side_of(0.1, time, start + rate * time + 1e-4 * np.sin(7.0 * time)) == side


@pytest.mark.parametrize("end", [0.2, 0.9])
def test_a_forecast_holds_the_end(end: float) -> None:
    """An exponential approach with scatter, seen over one time scale: its end and the time to come there lie in the range."""
    held = []
    for seed in range(20):
        t = np.linspace(0.0, 2.0, 120)
        rng = np.random.default_rng(seed)
        found = obs.forecast(t, end + (0.5 - end) * np.exp(-t / 2.0) + 0.003 * rng.normal(size=t.size))
        held.append(found.low <= end <= found.high and found.time_low <= 2.0 * math.log(20.0) <= found.time_high)
    assert np.mean(held) >= 0.9
    grows = obs.forecast(t, 0.01 * np.exp(t))
    assert grows.high == grows.time_high == math.inf


def whirling(values: Any, turns: int = 120, spacing: Any = None) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Orbit by turns of the cage, with a scatter of 0.003 Cpr; and the spacing of the rollers."""
    t = np.arange(turns) * 0.05
    means = {"orbit radius": np.asarray(values(t)) + 0.003 * np.random.default_rng(turns).normal(size=turns)}
    return t, means if spacing is None else means | {"roller spacing": np.asarray(spacing(t))}


def test_starts_side_by_side() -> None:
    """Agreed from both sides; one direction, with a forecast; two motions; and nothing to be told, with the reason."""
    rest, large = whirling(lambda t: 0.1 + 0 * t), whirling(lambda t: 0.1 + 0.8 * np.exp(-t))
    found = obs.compare_starts((rest, large), window=20)
    assert found.verdict == "agreed"
    assert found.orbit == pytest.approx(0.1, abs=found.error)
    assert obs.compare_starts((rest, large), window=20, kinds=["rocking", "stable"]).verdict == "agreed"
    assert not obs.agree([0.1, 0.1], [0.01, math.nan], ["stable", "stable"])
    assert not obs.agree([0.1, 0.1], [0.01, 0.01], ["unknown", "unknown"])
    apart = obs.compare_starts((rest, large), window=20, kinds=["rocking", "circling"])
    assert apart.verdict == "unknown"
    assert "one of them is circling, the other rocking" in apart.reason
    high = whirling(lambda t: 0.9 + 0 * t)
    between = whirling(lambda t: 0.3 + 0.056 * t, 60)
    grows = obs.compare_starts((rest, high), between, window=20, creep_turns=90.0)
    assert grows.verdict == "grows"
    assert grows.rate == pytest.approx(0.056, abs=4.0 * grows.rate_error)
    assert grows.orbit == pytest.approx(0.9, abs=0.01)
    assert grows.time_low < (0.9 - 0.45) / 0.056 < grows.time_high
    dies = obs.compare_starts((rest, high), whirling(lambda t: 0.5 - 0.056 * t, 60), window=20)
    assert (dies.verdict, round(dies.orbit, 1)) == ("dies", 0.1)
    gone = whirling(lambda t: 0.9 - 0.6 * np.exp(-4.0 * t), 120)
    assert obs.compare_starts((rest, high), gone, window=20, creep_turns=30.0).verdict == "two motions"
    still = obs.compare_starts((rest, high), whirling(lambda t: 0.3 + 0 * t, 60), window=20, creep_turns=5000.0)
    assert still.verdict == "start decides"
    assert still.ends == pytest.approx((0.1, 0.9), abs=0.01)
    assert still.time_low > 6.0
    creeping = whirling(lambda t: 0.1 + 0.011 * t, 120)
    for_now = obs.compare_starts((creeping, high), whirling(lambda t: 0.3 + 0 * t, 60), window=20, creep_turns=5000.0)
    assert (for_now.verdict, round(for_now.time_low, 1)) == ("start decides", 2.0)
    soon = obs.compare_starts((rest, high), whirling(lambda t: 0.3 + 0 * t, 60), window=20, creep_turns=90.0)
    assert soon.verdict == "unknown"
    assert "creep within 90 turns" in soon.reason


def test_starts_that_move_towards_each_other_or_apart() -> None:
    """From both sides; a start between that is there already shows where the other goes; and what cannot be: apart."""
    up, down = whirling(lambda t: 0.1 + 0.05 * t), whirling(lambda t: 0.9 - 0.04 * t)
    still, low, high = (whirling(lambda t, at=at: at + 0 * t) for at in (0.4, 0.1, 0.9))
    meets = obs.compare_starts((up, down), still, window=20)
    assert meets.verdict == "meets"
    assert meets.rate == pytest.approx(-0.09, abs=4.0 * meets.rate_error)
    assert meets.time_low < (meets.ends[1] - meets.ends[0]) / 0.09 < meets.time_high
    between = obs.compare_starts((low, down), whirling(lambda t: 0.2 + 0.03 * t), window=20)
    assert (between.verdict, round(between.orbit, 2)) == ("meets", 0.52)
    assert obs.compare_starts((low, down), low, window=20).verdict == "dies"
    assert obs.compare_starts((up, high), high, window=20).verdict == "grows"
    assert obs.compare_starts((low, down), still, window=20).verdict == "unknown"
    apart = obs.compare_starts(
        (whirling(lambda t: 0.3 - 0.03 * t), high), whirling(lambda t: 0.4 + 0.03 * t), window=20
    )
    assert apart.verdict == "two motions"
    beyond = obs.compare_starts((up, high), whirling(lambda t: 0.3 - 0.03 * t, 60), window=20)
    assert beyond.verdict == "unknown"  # the smaller one grows beyond where the other comes from


def test_two_of_three_starts_agree_and_the_third_comes() -> None:
    """It needs no longer runs of the others; one that slows down before it gets there is another matter."""
    still, down = whirling(lambda t: 0.1 + 0 * t), whirling(lambda t: 0.72 - 0.04 * t)
    comes = whirling(lambda t: 0.1 + 0.2 * np.exp(-1.5 * t), 100)
    found = obs.compare_starts((still, down), comes, window=20, kinds=["stable", "circling", "stable"])
    assert (found.verdict, round(found.orbit, 2)) == ("agreed", 0.10)
    assert found.rate == pytest.approx(-0.04, rel=0.1)
    ends = whirling(lambda t: 0.45 + 0.2 * np.exp(-0.6 * t))
    assert obs.compare_starts((still, ends), comes, window=20).verdict != "agreed"
    far = whirling(lambda t: 0.9 - 0.04 * t)
    assert obs.compare_starts((still, far), comes, window=20).verdict == "dies"
    slowly = whirling(lambda t: 0.3 - 0.02 * t)
    goes = obs.compare_starts((still, down), slowly, window=20)
    assert (goes.verdict, goes.open) == ("dies", (2,))


def test_a_start_between_that_stays_apart_is_no_agreement() -> None:
    """Two that agree do not tell the motion where a third one has another; one that comes there, or has only begun, is none."""
    outer = whirling(lambda t: 0.7 + 0 * t), whirling(lambda t: 0.7 + 0 * t, 100)
    apart, comes = whirling(lambda t: 0.4 + 0 * t), whirling(lambda t: 0.4 + 0.03 * t)
    kinds = ["circling"] * 3
    assert obs.compare_starts(outer, apart, window=20, creep_turns=30.0, kinds=kinds).verdict == "unknown"
    found = obs.compare_starts(outer, comes, window=20, creep_turns=30.0, kinds=kinds)
    assert (found.verdict, found.movers, round(found.orbit, 2)) == ("agreed", (2,), 0.70)
    begun = comes[0][:20], {"orbit radius": comes[1]["orbit radius"][:20]}
    assert obs.compare_starts(outer, begun, window=20, creep_turns=30.0, kinds=kinds).verdict == "agreed"


def test_starts_of_one_class_whose_orbits_differ_are_alike() -> None:
    one, other = whirling(lambda t: 0.66 + 0 * t), whirling(lambda t: 0.81 + 0 * t)
    both = ["circling", "circling"]
    found = obs.compare_starts((one, other), window=20, creep_turns=30.0, kinds=both)
    assert (found.verdict, round(found.orbit, 2)) == ("alike", 0.73)
    assert found.error > 0.07
    assert obs.compare_starts((one, other), window=20, creep_turns=90.0, kinds=both).verdict == "unknown"
    assert (
        obs.compare_starts((one, other), window=20, creep_turns=30.0, kinds=["circling", "rocking"]).verdict != "alike"
    )
    far = whirling(lambda t: 0.95 + 0 * t)
    assert obs.compare_starts((one, far), window=20, creep_turns=30.0, kinds=both).verdict == "unknown"


def test_what_goes_on_does_not_agree() -> None:
    """Orbits that pass each other, and a spacing that grows, by which a whirl grows later: as long as either matters within three
    creep times the motion may go on; a slow drift of a large spacing does not matter (runs of a 32310, a 33217 and a 30206).
    """
    both = ["circling", "circling"]

    def told(outer: Any, creep_turns: float) -> str:
        return obs.compare_starts(outer, window=20, creep_turns=creep_turns, kinds=both).verdict

    passing = whirling(lambda t: 0.44 + 0.01 * t), whirling(lambda t: 0.52 - 0.01 * t)
    assert told(passing, 40.0) == "so far"
    still = whirling(lambda t: 0.44 + 0 * t, spacing=lambda t: 0.47 + 0 * t)
    grows = whirling(lambda t: 0.44 + 0 * t, spacing=lambda t: 0.5 + 0.04 * t)
    assert told((still, still), 80.0) == "agreed"
    assert told((grows, still), 80.0) == "so far"
    reason = obs.compare_starts((grows, still), window=20, creep_turns=80.0, kinds=both).reason
    assert "from rest the roller spacing increases" in reason
    assert told((whirling(lambda t: 0.44 + 0 * t, spacing=lambda t: 2.0 + 0.02 * t), still), 80.0) == "agreed"


@pytest.mark.parametrize(
    ("way", "to", "arrives"),
    [
        (lambda t: np.where(t < 3.0, 0.3 + 0.005 * t, 0.315 + 0.06 * (t - 3.0)), 0.9, 3.0 + (0.85 - 0.315) / 0.06),
        (lambda t: 0.3 * np.exp(0.1 * t), 0.9, 10.0 * math.log(0.85 / 0.3)),
        (lambda t: 0.1 + 0.25 * np.exp(-0.1 * t), 0.1, 10.0 * math.log(0.25 / 0.05)),
        (lambda t: 0.4 - 0.03 * t, 0.1, (0.4 - 0.15) / 0.03),
    ],
    ids=["constant after a slow beginning", "exponential growth", "exponential decay", "constant"],
)
def test_a_direction_tells_when_it_comes_there(way: Any, to: float, arrives: float) -> None:
    """By the latest rate and its change, whatever the beginning was: not by the mean rate of the run."""
    rest, high = whirling(lambda t: 0.1 + 0 * t), whirling(lambda t: 0.9 + 0 * t)
    found = obs.compare_starts((rest, high), whirling(way), window=20, creep_turns=9000.0)
    assert (found.verdict, found.movers) == ("grows" if to > 0.5 else "dies", (2,))
    assert found.orbit == pytest.approx(to, abs=0.01)
    assert found.time_low < arrives - 6.0 < found.time_high
    assert found.time_high < 10.0 * found.time_low


def test_a_direction_that_slows_down_has_no_longest_time() -> None:
    rest, high = whirling(lambda t: 0.1 + 0 * t), whirling(lambda t: 0.9 + 0 * t)
    slows = obs.compare_starts((rest, high), whirling(lambda t: 0.6 - 0.3 * np.exp(-0.5 * t)), window=20)
    assert slows.verdict == "grows"
    assert slows.time_high == math.inf


def test_a_class_near_its_bound_names_its_neighbour() -> None:
    """A cage that rocks beside the axis by 0.6 of its distance; with an orbit larger by a third it comes over the middle."""
    t = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    place, speed = 0.4 + 0.24 * np.exp(1j * t), 0.24j * np.exp(1j * t)
    motion = obs.classify(*(np.column_stack([z.real, z.imag]) for z in (place, speed)), 1.0)
    assert motion.kind == motion.kind_at(motion.orbit_over_play) == "rocking"
    for orbit in (0.05, 0.28, 0.32, 0.38, 0.6, 2.0):
        larger = 0.4 + orbit * np.exp(1j * t), orbit * 1j * np.exp(1j * t)
        assert motion.kind_at(orbit) == obs.classify(*(np.column_stack([z.real, z.imag]) for z in larger), 1.0).kind
    assert [motion.kind_at(orbit) for orbit in (0.05, 0.32)] == ["stable", "circling"]


def test_starts_that_scatter_agree_over_a_longer_part() -> None:
    """Scatter of 0.08 Cpr: a window of 20 turns tells no mean, half of 240 mostly does, and then holds it."""
    t, agreed = np.arange(240) * 0.05, 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        one, other = (0.6 + slow(rng, 240, 1, 0.08) for _ in range(2))
        short, whole = (
            ((t[:end], {"orbit radius": one[:end]}), (t[:end], {"orbit radius": other[:end]})) for end in (40, 240)
        )
        assert obs.compare_starts(short, window=20).verdict == "unknown"
        found = obs.compare_starts(whole, window=20)
        agreed += found.verdict == "agreed"
        assert found.verdict != "agreed" or found.orbit == pytest.approx(0.6, abs=found.error)
    assert agreed >= 9
