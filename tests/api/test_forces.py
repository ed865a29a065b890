"""Forces over frequency, levels of octaves, sound files and rattle: known ones come back, others are refused."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.io import wavfile

import trbdyn as trb
from trbdyn.results.derived import Derived
from trbdyn.results.fields import Field

SCENE = trb.cases.scene_30310(3000.0, 4930.0)
MASS = SCENE.bearing.cage.mass
GROUPS = ("cage", "rollers", "peaks")


class Recorded(Derived):
    """Records of a cage on which a known force acts: its velocity is the integral of the force over the mass."""

    scene = SCENE  # type: ignore[assignment]
    geometry: dict[str, float] = {}  # type: ignore[assignment]
    peaks = None  # type: ignore[assignment]

    def __init__(self, tones: dict[float, float], *, every: float = 1e-4, seconds: float = 1.0) -> None:
        time = every * np.arange(round(seconds / every) + 1)
        integral = np.sum([-a / (2 * np.pi * f) * np.cos(2 * np.pi * f * time) for f, a in tones.items()], axis=0)
        velocity = np.zeros((time.size, 3))
        velocity[:, 0] = (integral + 3.0 * time) / MASS
        self.values = {
            "time": time,
            "cage_velocity": velocity,
            "shaft_angle": 100.0 * np.pi * time,
            "shaft_speed": np.full(time.shape, 100.0 * np.pi),
        }

    @property
    def fields(self) -> tuple[Field, ...]:
        return (SimpleNamespace(name="cage_velocity", group="cage"),)  # type: ignore[return-value]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.values[name]


@pytest.fixture(scope="module")
def run() -> trb.Result:
    return trb.Simulation(SCENE, accuracy="fast").run(duration=0.1, save_every=2e-5, save_groups=GROUPS)


def test_a_sine_gives_its_line_up_to_a_quarter_of_the_records_frequency() -> None:
    """The mean over an interval is put right: without that the line at 2300 Hz would be 9 % low."""
    found = Recorded({50.0: 4.0, 1000.0: 2.0, 2300.0: 1.0}).force_spectrum("cage", "x")
    for (frequency, amplitude), expected in zip(
        found.strongest(3), [(50.0, 4.0), (1000.0, 2.0), (2300.0, 1.0)], strict=True
    ):
        assert frequency == pytest.approx(expected[0], abs=0.51)
        assert amplitude == pytest.approx(expected[1], rel=0.01)
    assert found.force.mean == pytest.approx(3.0, rel=1e-3)
    assert found.shaft_frequency == pytest.approx(50.0)
    assert "records every 0.1 ms: frequencies up to 5000 Hz" in str(found)


def test_the_densitys_integral_is_the_mean_square() -> None:
    found = Recorded({50.0: 4.0, 1000.0: 2.0}).force_spectrum("cage", "x")
    power = np.trapezoid(found.density, found.frequency)
    assert power == pytest.approx(0.5 * (4.0**2 + 2.0**2), rel=5e-3)
    assert found.force.rms**2 == pytest.approx(power, rel=5e-3)


@pytest.mark.parametrize("segments", [1, 4])
def test_the_density_of_single_hits_has_their_mean_square(segments: int) -> None:
    """Hits near the ends of a run, where a window counts little: 33 to 40 % of their power would be missing."""
    recorded = Recorded({100.0: 1e-9}, every=1e-4)
    hits = np.zeros(recorded["time"].size)
    for at, width in ((500, 9), (700, 5), (3000, 7), (9300, 9), (9600, 5)):
        hits[at : at + width] = np.hanning(width + 2)[1:-1] * 40.0
    recorded.values["cage_velocity"][:, 0] = np.cumsum(hits) * 1e-4 / MASS
    found = recorded.force_spectrum("cage", "x", segments=segments)
    assert np.trapezoid(found.density, found.frequency) == pytest.approx(found.force.rms**2, rel=1e-6)
    assert found.force.rms > 0.5


def test_records_too_far_apart_are_refused(run: trb.Result) -> None:
    with pytest.raises(trb.InputError, match=r"save_every.*must be shorter.*highest octave.*folded"):
        Recorded({50.0: 1.0, 3500.0: 1.0}).force_spectrum()
    # 6 kHz would be folded to 4 kHz
    with pytest.raises(trb.InputError, match=r"save_every.*must be shorter"):
        Recorded({50.0: 1.0, 6000.0: 3.0}).sound("a.wav")
    coarse = trb.Simulation(SCENE, accuracy="fast").run(duration=0.1, save_every=2e-4, save_groups=GROUPS)
    with pytest.raises(trb.InputError, match=r"save_every = 0\.0002.*must be shorter"):
        coarse.force_spectrum("outer_ring", "z")
    assert coarse.rattle.hits == pytest.approx(run.rattle.hits, abs=1)  # hits between records count


def test_what_cannot_be_used_is_refused(run: trb.Result) -> None:
    for call, said in (
        (lambda: run.force_spectrum("housing"), "'cage' or 'outer_ring'"),  # type: ignore[arg-type]
        (lambda: run.force_spectrum("cage", "r"), "'x' or 'y' or 'z'"),  # type: ignore[arg-type]
        (lambda: run.force_spectrum(segments=0), "segments"),
        (lambda: run.octave_levels(fraction=2), "fraction"),  # type: ignore[arg-type]
        (lambda: run.window(0.0, 5e-4).force_spectrum(), "more than 32"),
        (lambda: run.select(["cage"]).force_spectrum("outer_ring"), "rollers"),
        (lambda: run.select(["cage"]).rattle, "peaks|pocket_impacts"),
    ):
        with pytest.raises(trb.InputError, match=said):
            call()
    uneven = Recorded({50.0: 1.0})
    uneven.values["time"][500] += 2e-5
    with pytest.raises(trb.InputError, match="even times"):
        uneven.force_spectrum()


def test_forces_of_a_run_are_those_of_its_loads(run: trb.Result) -> None:
    outer = run.force_spectrum("outer_ring", "z").force
    assert outer.mean == pytest.approx(-4930.0, rel=1e-3)  # all of the axial load, but for friction
    cage = run.force_spectrum("cage", "z").force
    change = run["cage_velocity"][-1, 2] - run["cage_velocity"][0, 2]
    assert cage.mean * run.duration == pytest.approx(MASS * change, rel=1e-6)


def test_the_pass_frequency_of_a_pit_is_a_line_of_the_outer_ring() -> None:
    """Under a radial load, a pit at the loaded place of the outer ring is passed by every roller."""
    pit = trb.Pit(on="outer", length=1.5e-3, width=6e-3, depth=30e-6)
    pitted = SCENE.replace(defects=(pit,))
    length = {"revolutions": 6, "save_every": 2e-5, "save_groups": GROUPS}
    result = trb.Simulation(pitted, accuracy="fast").run(**length)
    plain = trb.Simulation(SCENE, accuracy="fast").run(**length)
    expected = trb.plot.ring_orders(result)["rollers over the outer ring"] * 50.0

    def at_lines(one: trb.Result) -> float:
        """Amplitude at the first four multiples of the pass frequency, the mean of the largest near each."""
        found = one.window(0.04).force_spectrum("outer_ring", "x")
        near = [np.abs(found.frequency - k * expected) < 0.01 * k * expected + found.frequency[1] for k in (1, 2, 3, 4)]
        return float(np.mean([found.amplitude[place].max() for place in near]))

    assert at_lines(result) > 10.0 * at_lines(plain)
    found = result.window(0.04).force_spectrum("outer_ring", "x")
    strongest = np.array([frequency for frequency, _ in found.strongest(6)]) / expected
    assert np.abs(strongest - np.round(strongest)).max() < 0.06
    assert np.round(strongest).min() >= 1


def test_a_sound_file_reads_back_with_its_level(tmp_path: Path) -> None:
    record = Recorded({400.0: 2.0, 1000.0: 1.0}, every=1e-4)
    told = record.sound(tmp_path / "a.wav", full_scale=10.0)
    rate, samples = wavfile.read(tmp_path / "a.wav")
    assert (rate, samples.dtype, samples.size) == (10_000, np.int16, 10_000)
    force = samples / 32767.0 * told.full_scale
    assert np.sqrt(np.mean(force**2)) == pytest.approx(np.sqrt(0.5 * (4.0 + 1.0)), rel=2e-3)
    half = np.abs(np.fft.rfft(force)) / (0.5 * force.size)
    assert half[400] == pytest.approx(2.0, rel=2e-3)
    slow = record.sound(tmp_path / "b.wav", slower=4.0)
    assert wavfile.read(slow.path)[0] == 2500
    assert np.abs(wavfile.read(slow.path)[1]).max() == 32767
    assert "full_scale" in str(slow)
    with pytest.raises(trb.InputError, match="full_scale"):
        record.sound(tmp_path / "c.wav", full_scale=1.0)
    with pytest.raises(trb.InputError, match="slower"):
        record.sound(tmp_path / "c.wav", slower=50.0)
    with pytest.raises(trb.InputError, match=r"\.wav"):
        record.sound(tmp_path / "c.mp3")


def test_levels_are_those_of_sines_in_their_bands() -> None:
    """A sine of amplitude a has 20 lg(a/sqrt 2/1 µN) in its band, and beside it at most what class 1 of IEC 61260-1 lets pass."""
    pytest.importorskip("pyoctaveband")
    for fraction in (1, 3):
        levels = Recorded({1000.0: 2.0}, every=2e-5, seconds=1.0).octave_levels(fraction=fraction)  # type: ignore[arg-type]
        at = dict(zip(levels.names, levels.level, strict=True))
        expected = 20.0 * np.log10(2.0 / np.sqrt(2.0) / 1e-6)
        assert at["1k"] == pytest.approx(expected, abs=0.4)
        octave = {1: {"500": 16.6, "2k": 16.6, "250": 40.5, "4k": 40.5}, 3: {"500": 40.5, "2k": 40.5}}[fraction]
        for name, least in octave.items():
            assert at[name] <= expected - least, (fraction, name)
        assert levels.frequency[levels.names.index("2k")] == pytest.approx(1000.0 * 10.0**0.3)
    sums = Recorded({1000.0: 2.0, 63.0: 0.5, 4000.0: 0.3}, every=2e-5).octave_levels(fraction=3)
    total = 10.0 * np.log10(np.sum(10.0 ** (0.1 * sums.level)))
    assert total == pytest.approx(10.0 * np.log10(0.5 * (4.0 + 0.25 + 0.09) / 1e-12), abs=0.3)


def test_the_filters_are_of_class_1() -> None:
    pyoctaveband = pytest.importorskip("pyoctaveband")
    for fraction in (1, 3):
        bank = pyoctaveband.OctaveFilterBank(50_000, fraction, limits=[60.0, 16_000.0])
        assert pyoctaveband.verify_filter_class(bank)["overall_class"] == 1


def test_rattle_counts_every_hit_once(run: trb.Result) -> None:
    found, peaks = run.rattle, run.peaks
    assert found.hits == peaks["pocket_impacts"].sum() > 10
    assert found.per_second == pytest.approx(found.hits / 0.1)
    assert found.per_turn == pytest.approx(found.hits / 5.0)
    assert sum(found.hits_by_face.values()) == found.hits
    assert found.impulse_per_hit * found.hits == pytest.approx(peaks["pocket_impulse"].sum())
    assert found.impulse_per_second == pytest.approx(peaks["pocket_force_mean"].sum(), rel=1e-6)
    halves = [run.window(0.0, 0.05).rattle, run.window(0.05).rattle]
    assert sum(half.hits for half in halves) == found.hits
    assert "hits in a turn" in str(found)


def test_pictures(run: trb.Result) -> None:
    axes = trb.plot.force_spectrum(run, on="outer_ring", along="x", highest=5000.0)
    found = run.force_spectrum("outer_ring", "x")
    assert axes.get_lines()[0].get_ydata().max() == pytest.approx(found.amplitude[found.frequency <= 5000.0][1:].max())
    assert axes.get_xlim()[1] == 5000.0
    bars = trb.plot.octave_levels(run).patches
    tops = [bar.get_y() + bar.get_height() for bar in bars]
    assert tops == pytest.approx(run.octave_levels().level)
