"""Forces of raceways and ribs taken from tangents between their exact evaluations: as accurate as exact ones, where allowed."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import Effects, Simulation
from trbdyn.run.options import ACCURACY

WINDOW = 3e-3
PLAY = 0.25e-3


def whirl(**options: object) -> Simulation:
    """A cage that whirls and collides."""
    effects = Effects.paper().replace(quadrature="gauss", n_slices=8)
    return Simulation(
        trb.cases.scene_30310(3000.0, 4930.0, effects=effects, start=trb.Start.whirl(0.9)),
        **options,  # type: ignore[arg-type]
    )


@pytest.fixture(scope="module")
def states() -> list[tuple[NDArray[np.float64], float]]:
    """Places in mid-collision."""
    sim, found = whirl(), []
    for start in 0.02 + 0.0073 * np.arange(16):
        while sim.time < start or sim.contacts()["pocket_load"].max() < 20.0:
            sim.step()
        found.append((sim.state.vector, sim.time))
    return found


def cage_path(sim: Simulation, place: tuple[NDArray[np.float64], float]) -> NDArray[np.float64]:
    """Path of the cage's centre over a window (m)."""
    sim.set_state(*place)
    return np.asarray(sim.run(duration=WINDOW, save_every=WINDOW / 30)["cage_position"])[:, :2]


@pytest.fixture(scope="module")
def truth(states: list[tuple[NDArray[np.float64], float]]) -> list[NDArray[np.float64]]:
    """Paths by the explicit method at far tighter tolerances."""
    tight = {name: 1e-4 * value for name, value in ACCURACY["reference"].model_dump().items()}
    sim = whirl(integrator="erk", **tight)
    return [cage_path(sim, place) for place in states]


@pytest.mark.parametrize("accuracy", [pytest.param("standard", marks=pytest.mark.slow), "reference"])
def test_tangents_cost_no_accuracy(
    accuracy: str, states: list[tuple[NDArray[np.float64], float]], truth: list[NDArray[np.float64]]
) -> None:
    error: dict[float | None, float] = {}
    for share in (0.0, None):
        sim = whirl(accuracy=accuracy, rings_share=share)
        off = [np.abs(cage_path(sim, place) - path).max() / PLAY for place, path in zip(states, truth, strict=True)]
        error[share] = float(np.exp(np.mean(np.log(off))))
    # geometric means over sixteen windows of errors that impacts scatter over a factor of ten
    assert error[None] < 3.0 * error[0.0]
    assert error[None] < {"standard": 5e-3, "reference": 5e-4}[accuracy]


@pytest.mark.parametrize("accuracy", ["fast", "standard", "reference"])
@pytest.mark.parametrize("law", ["coulomb", "boundary"])
def test_tangents_stay_in_the_linear_range_of_friction(law: str, accuracy: str) -> None:
    """At 27 000 rpm tolerances are ten times the slip over which friction of unloaded rollers turns round."""
    effects = Effects.minimal().replace(back_rib=False, damping="hunt_crossley", damping_race=0.93, damping_cage=0.93)
    if law == "boundary":
        steep = effects.friction.replace(boundary_decay=5000.0, boundary_slope=614.0)
        effects = effects.replace(lubrication="boundary", friction=steep)
    scene = trb.cases.scene_32216(27094.0, 627.0, effects=effects, start=trb.Start.unequal(506))
    lost = []
    for share in (0.0, None):
        sim = Simulation(scene, accuracy=accuracy, rings_share=share)  # type: ignore[arg-type]
        before = sim.record()
        while sim.time < 4e-3:
            sim.step()
        after = sim.record()
        lost.append(sum(float(after[name] - before[name]) for name in after if name.startswith("loss_")))
    assert lost[1] == pytest.approx(lost[0], rel={"fast": 0.1, "standard": 0.05, "reference": 0.02}[accuracy])


def test_most_forces_come_from_tangents(states: list[tuple[NDArray[np.float64], float]]) -> None:
    counted = {}
    for share in (0.0, None):
        sim = whirl(rings_share=share)
        sim.set_state(*states[0])
        counted[share] = sim.run(duration=0.02).counters
    exact, saved = counted.values()
    assert exact["tangent_rollers"] == 0
    assert saved["tangent_rollers"] > 3.0 * saved["exact_rollers"]
    assert saved["raceway_nodes"] < 0.35 * exact["raceway_nodes"]
    assert 0.8 < saved["force_evaluations"] / exact["force_evaluations"] < 1.2


def test_the_energy_audit_closes_as_well(states: list[tuple[NDArray[np.float64], float]]) -> None:
    for share in (0.0, None):
        sim = whirl(rings_share=share)
        sim.set_state(*states[0])
        assert sim.run(duration=0.02).energy_closure < 5e-4


def test_explicit_method_is_exact(kit: SimpleNamespace) -> None:
    assert kit.simulate(integrator="erk").run(duration=2e-4).counters["tangent_rollers"] == 0


def test_motion_under_way_is_exact(kit: SimpleNamespace) -> None:
    """To the bit, and tangents are used once it has ended."""
    speed = trb.History(times=(0.0, 4e-3), values=(3000.0, 3100.0))
    runs = []
    for share in (0.0, None):
        sim = kit.simulate(scenery={"speed_rpm": speed}, rings_share=share)
        runs.append(sim.run(duration=3e-3))
        assert runs[-1].counters["tangent_rollers"] == 0
    np.testing.assert_array_equal(runs[0].final_state, runs[1].final_state)
    assert sim.run(duration=5e-3).counters["tangent_rollers"] > 0
