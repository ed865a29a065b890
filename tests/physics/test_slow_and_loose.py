"""Slow rotation, thick oil, unloaded rollers: scenes in which steps once made energy from nothing, at every preset.

Expected losses are those of runs at a hundredth of the tolerances of "reference" with every force exact.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.cases import paper_30310, scene_32216
from trbdyn.model.lubricants import vg100

PRESETS = ("fast", "standard", "reference")
MOST_STEPS = 60_000

SCENES: dict[str, tuple[Callable[[], trb.Scene], float]] = {
    "50 rpm": (lambda: paper_30310(50.0), 0.05),
    "30 rpm": (lambda: paper_30310(30.0), 0.1),
    "32216 at 10 rpm": (lambda: scene_32216(10.0), 0.2),
    "oil at 20 C, 50 rpm": (lambda: paper_30310(50.0, lubricant=vg100(temperature_c=20.0)), 0.05),
    "3 rpm": (lambda: paper_30310(3.0), 0.05),
    "1 rpm": (lambda: paper_30310(1.0), 0.1),
    "0.1 rpm": (lambda: paper_30310(0.1), 0.2),
    "0.01 rpm": (lambda: paper_30310(0.01), 0.2),
    "whirling start, 15.7 rpm": (lambda: paper_30310(15.7, 3200.0, start=trb.Start.whirl(0.9)), 0.1),
    "light load, 1227 rpm": (lambda: paper_30310(1227.0, 526.0), 0.01),
    "unloaded rollers, 101 rpm": (lambda: paper_30310(101.0, 7100.0, 19_600.0), 0.02),
    "unloaded rollers, 500 rpm": (lambda: paper_30310(500.0, 4930.0, 20_000.0), 0.01),
}


def _lean(scene: trb.Scene) -> trb.Scene:
    return scene.replace(effects=scene.effects.replace(quadrature="gauss", n_slices=8))


def _run(scene: trb.Scene, duration: float, **options: object) -> tuple[float, float, int]:
    """Mean loss (W), residual of the energy over what was lost, steps."""
    sim = trb.Simulation(scene, **options)
    begin, steps = sim.record(), 0
    while sim.time < duration:
        sim.step()
        steps += 1
        assert steps < MOST_STEPS, f"{steps} steps lead to {sim.time:.3g} s only"
    end = sim.record()

    def change(prefix: str) -> float:
        return float(sum(end[name] - begin[name] for name in end if name.startswith(prefix)))

    stored = sum(float(end[name] - begin[name]) for name in ("kinetic_energy", "elastic_energy"))
    lost = change("loss_")
    return lost / sim.time, abs(change("work_") - stored - lost) / lost, steps


@pytest.mark.parametrize("accuracy", PRESETS)
def test_losses_are_the_integral_of_their_power_where_slow_rotation_turns_round(accuracy):
    """Where nothing falls or hits, bodies follow such a history in long steps without any error: the error test does not see a
    power that falls to nothing and rises again. Summed up from eight steps the losses were off by 1.4 to 5 %.
    """
    turning = trb.History(times=(0.5e-3, 2.9e-3), values=(0.011, -0.0094))
    scene = _lean(scene_32216(10.0, 30_000.0)).replace(speed_rpm=turning, gravity=(0.0, 0.0, 0.0))
    result = trb.Simulation(scene, accuracy=accuracy).run(duration=2.9e-3, save_every=1e-5)
    time, power = result.time, result["power_loss"]
    lost = sum(float(result[name][-1]) for name in dir(result) if name.startswith("loss_"))
    assert lost == pytest.approx(float(np.trapezoid(power, time)), rel=6e-3)


@pytest.mark.parametrize("name", SCENES)
def test_no_preset_makes_energy(name):
    make, duration = SCENES[name]
    scene = _lean(make())
    exact, closure, most = _run(scene, duration, accuracy="reference", rings_share=0.0)
    assert closure < 5e-3
    for preset in PRESETS:
        power, closure, steps = _run(scene, duration, accuracy=preset)
        assert power == pytest.approx(exact, rel=0.03), preset
        assert closure < 0.02, preset
        assert steps < 1.5 * most, preset


@pytest.mark.parametrize("shift", [(0.0, 60e-6, 30e-6), (40e-6, 0.0, 45e-6), (-50e-6, 20e-6, 20e-6)])
@pytest.mark.parametrize("speed_rpm", [300.0, 3000.0])
def test_tangents_follow_exact_forces_where_contacts_come_and_go(shift, speed_rpm):
    """Losses with tangents and with exact forces, each beside a tight run: tangents make no preset half as wrong again."""
    scene = _lean(paper_30310(speed_rpm, 0.0, displacement=shift))
    tight, _, _ = _run(scene, 0.006, accuracy="reference", rings_share=0.0)
    for preset in PRESETS:
        exact, _, steps = _run(scene, 0.006, accuracy=preset, rings_share=0.0)
        power, closure, taken = _run(scene, 0.006, accuracy=preset)
        assert abs(power - tight) <= 1.5 * abs(exact - tight) + 0.02 * tight, preset
        assert closure < 0.02, preset
        assert taken < 1.5 * steps + 50, preset  # they scatter, 0.86 to 1.4 times
