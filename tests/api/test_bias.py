"""What other starts and accuracies do to a largest force after a load that drops."""

from __future__ import annotations

import math
import warnings

import pytest

import trbdyn as trb
from trbdyn.model.cases import scene_30310
from trbdyn.reporting import verdict
from trbdyn.results import notes

DROP = trb.History.step((0.02, 0.04), (3000.0, 300.0, 3000.0))


def dropped(accuracy: str, seed: int) -> trb.Result:
    """A load that drops for 20 ms; the watch has much to say of rollers that vibrate then."""
    scene = scene_30310(3000.0, DROP, ring="follows", start=trb.Start.unequal(seed=seed))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", trb.RunWarning)
        return trb.Simulation(scene, accuracy=accuracy).run(duration=0.06)


@pytest.mark.slow
def test_the_peak_after_a_load_drop_is_a_band_that_holds_other_accuracies():
    """Peaks of 8.9 to 25.1 N, by damping and accuracy, were told as numbers without a band."""
    runs = {accuracy: dropped(accuracy, seed=1) for accuracy in ("fast", "standard")}
    numbers = {accuracy: result.summary() for accuracy, result in runs.items()}
    for accuracy, other in (("fast", "standard"), ("standard", "fast")):
        low, high = (numbers[accuracy][f"pocket_force_peak_{end}"] for end in ("low", "high"))
        assert low < numbers[accuracy]["pocket_force_peak"] < high
        assert low < numbers[other]["pocket_force_peak"] < high
        assert high / low == pytest.approx(math.exp(2.0 * 1.96 * math.sqrt(2.0) * notes.drop_measured()["scatter"]))
    assert "at most" in str(numbers["fast"])
    said = " ".join(text for _, _, text in verdict.verdict(runs["fast"], numbers["fast"]))
    assert "other starts and accuracies give" in said


@pytest.mark.slow
def test_bands_after_a_load_drop_hold_the_peaks_of_other_starts_and_accuracies():
    """Seeds that the scatter was not measured with: of 36 pairs at least nine in ten."""
    peaks = [
        dropped(accuracy, seed).summary()["pocket_force_peak"]
        for accuracy in ("fast", "standard", "reference")
        for seed in (11, 12, 13)
    ]
    held = [
        low < other < high for one in peaks for low, high in [notes.drop_band(one)] for other in peaks if other != one
    ]
    assert sum(held) >= 0.9 * len(held), peaks


def test_loads_that_do_not_drop_have_no_band():
    rise = trb.History.ramp(0.0, 2e-3, 3000.0, 4000.0)
    for load in (3000.0, rise):
        result = trb.Simulation(scene_30310(3000.0, load, ring="follows"), accuracy="fast").run(duration=3e-3)
        assert "pocket_force_peak_low" not in result.summary()
