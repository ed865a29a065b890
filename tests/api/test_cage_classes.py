"""Classes of the cage's motion, held against loci that were looked at one by one.

`loci.npz` holds thinned loci of the cage's centre from runs of eighteen bearings at speeds of 60 to 10 000 rpm, light and heavy,
axial and combined loads, three starts, with and without gravity, drag, films in the pockets and guidance by lands: place over the
radial play times 20 000, velocity over play and cage speed times 10 000, as whole numbers, and the class by eye. Those that are
held back were not used when the bounds of `trbdyn.observables.classify` were chosen. Of the first 52 loci three others were
left out, as eyes do not agree on them; the 153 that follow were drawn at random and labelled before they were classified, none
left out.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import observables as obs

LOCI = np.load(Path(__file__).with_name("loci.npz"))
NAMES = [str(name) for name in LOCI["name"]]
PLACES, KINDS = LOCI["locus"].astype(float), [str(kind) for kind in LOCI["kind"]]

DIFFER = {
    "32216_1500_33420_48100_unequal_outerland": "rocking",
    "30215_1110_26430_0_unequal": "stable",
    "32216_380_5730_1170_whirl_film24": "stable",
    "32306_2820_2080_1300_equal": "stable",
    "32216_150_24000_7550_equal": "stable",
    "32012_1930_12420_24880_unequal_film44": "rocking",
    "32210_150_2290_3310_unequal": "rocking",
    "30310_180_25410_54260_equal": "stable",
    "32306_650_13840_27590_unequal": "stable",
    "32220_130_21570_0_unequal": "rocking",
    "30310_190_6700_0_whirl": "unstable",
    "30312_120_5590_3990_whirl": "unstable",
    "32306_230_1570_1980_whirl": "unstable",
    "32012_120_2350_3740_equal_g0": "unstable",
    "32220_130_20900_19130_whirl": "unstable",
    "32220_1400_11040_0_whirl": "unstable",
    "32220_880_41850_73900_equal": "unstable",
    "32012_2910_2370_0_unequal": "circling",
}
"""Loci whose class is not the one that eyes saw. The first ten are small: eyes tell stable from rocking at 0.09 to 0.11 of
the play as the bound does not, and once at 0.03, misled by large velocities. Then five that go round the axis with blows, which
make their speed uneven: a coherence of 0.28 to 0.48. Last three that touch the axis."""


def test_a_locus_has_the_class_that_eyes_see() -> None:
    found = [obs.classify(locus[:, :2] / 20000.0, locus[:, 2:] / 10000.0, 1.0).kind for locus in PLACES]
    seen = [DIFFER.get(name, kind) for name, kind in zip(NAMES, KINDS, strict=True)]
    assert dict(zip(NAMES, found, strict=True)) == dict(zip(NAMES, seen, strict=True))


@pytest.mark.parametrize("aside", [0.0, 0.1, 0.3, 0.6])
def test_coherence_about_the_axis_counts_the_way_to_it(aside: float) -> None:
    """A circle of radius a about a place at c turns about it with coherence 1, and about the axis with a/sqrt(a^2 + c^2)."""
    turn = np.linspace(0.0, 40.0 * np.pi, 4001)[:-1]
    place = 0.3 * np.column_stack([np.cos(turn), np.sin(turn)]) + [aside, 0.0]
    speed = 0.3 * 50.0 * np.column_stack([-np.sin(turn), np.cos(turn)])
    found = obs.classify(1e-4 * place, 1e-4 * speed, 1e-4)
    assert found.whirl_coherence == pytest.approx(1.0, rel=1e-6)
    assert found.orbit_over_play == pytest.approx(0.3, rel=1e-6)
    assert found.axis_coherence == pytest.approx(0.3 / np.hypot(0.3, aside), rel=1e-6)


def test_the_loci_are_many_and_half_of_them_are_held_back() -> None:
    """Of those that are held back, nine of ten have the class that eyes saw; no whirl is called small."""
    assert len(NAMES) == len(set(NAMES)) >= 200
    assert LOCI["held_back"].mean() >= 0.5
    held = [name for name, back in zip(NAMES, LOCI["held_back"], strict=True) if back]
    assert 1.0 - sum(name in DIFFER for name in held) / len(held) >= 0.89
    seen = dict(zip(NAMES, KINDS, strict=True))
    assert not {"stable", "circling"} & {DIFFER[name] for name in DIFFER if seen[name] in ("circling", "unstable")}
    for part in (LOCI["held_back"], ~LOCI["held_back"]):
        assert {"stable", "rocking", "circling", "unstable"} == set(LOCI["kind"][part])
    assert len({name.partition("_")[0] for name in NAMES}) >= 8


def circle(centre: float, radius: float, turns: float = 3.0) -> tuple[np.ndarray, np.ndarray]:
    angle = np.linspace(0.0, 2.0 * np.pi * turns, 3000, endpoint=False)
    place = np.column_stack([radius * np.cos(angle), radius * np.sin(angle) - centre])
    return place, radius * np.column_stack([-np.sin(angle), np.cos(angle)])


@pytest.mark.parametrize(
    ("centre", "radius", "kind"),
    [
        (0.5, 0.05, "stable"),
        (0.0, 0.05, "stable"),
        (0.5, 0.2, "rocking"),
        (0.4, 0.6, "circling"),
        (0.0, 0.9, "circling"),
    ],
)
def test_circles_by_their_place_and_size(centre: float, radius: float, kind: str) -> None:
    place, velocity = circle(centre, radius)
    for sense in (1.0, -1.0):
        mirror = np.array([sense, 1.0])
        assert obs.classify(place * mirror, velocity * mirror, 1.0).kind == kind


def test_a_short_record_has_no_class() -> None:
    place, velocity = circle(0.0, 0.9)
    angle = np.linspace(0.0, 2.0 * np.pi * 3.0, 3000)
    assert obs.classify(place, velocity, 1.0, cage_angle=angle).kind == "circling"
    assert obs.classify(place, velocity, 1.0, cage_angle=0.5 * angle).kind == "unknown"
    assert obs.classify(place, velocity, 1.0, cage_angle=-angle).kind == "circling"
    for begun in (-50.0, -10.0, 100.0):  # where the cage stands at the beginning does not count
        assert obs.classify(place, velocity, 1.0, cage_angle=begun + angle).kind == "circling"
        assert obs.classify(place, velocity, 1.0, cage_angle=begun + 0.5 * angle).kind == "unknown"


def test_how_long_it_takes_to_tell() -> None:
    t = np.linspace(0.0, 0.15, 1501)
    turned = 2.0 * np.pi * 14.0 * t
    short = obs.motion_settling(t, turned, np.full(t.size, 0.1), creep_time=3.0)
    assert short.answer == "unknown"
    assert short.needed == pytest.approx(0.15 + 9.0)
    standing = obs.motion_settling(t, 1e-14 * t, np.full(t.size, 0.1), creep_time=3.0)
    assert standing.answer == "unknown"
    assert np.isnan(standing.needed)
    t = np.linspace(0.0, 3.0, 6001)
    creeping = obs.motion_settling(t, 2.0 * np.pi * 14.0 * t, np.full(t.size, 0.1), creep_time=3.0)
    assert creeping.answer == "unknown"
    assert creeping.needed == pytest.approx(9.0, abs=0.1)
    drifting = obs.motion_settling(t, 2.0 * np.pi * 14.0 * t, 0.1 + 0.2 * t, creep_time=0.1)
    assert drifting.answer == "drifting"
    assert 3.0 <= drifting.needed <= 3.0 + 3.0 * drifting.time_scale
    assert np.isnan(drifting.needed_high)
    settled = obs.motion_settling(t, 2.0 * np.pi * 14.0 * t, np.full(t.size, 0.1), creep_time=0.1)
    assert settled.answer == "settled"
    assert np.isnan(settled.needed)


def test_the_run_of_the_readme_is_not_judged_too_early() -> None:
    bearing = trb.Bearing.from_catalogue(bore=0.040, outside=0.080, width=0.02475, C=74.8e3, e=0.37, name="32208")
    scene = trb.Scene(bearing, speed_rpm=2000, axial_load=2500.0)
    sim = trb.Simulation(scene)
    values = sim.run(revolutions=5).summary()
    assert values["cage_motion"] == "unknown"
    assert values["settling_needed"] > 3.0 * values["creep_time"]
    values = sim.run(revolutions=10).summary()
    assert values["cage_motion"] in ("stable", "rocking")  # eyes tell them apart at 0.09 to 0.11
    assert values["orbit_rms_over_cpr"] == pytest.approx(0.107, abs=0.02)
