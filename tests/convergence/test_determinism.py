"""Who looks, how often, from which thread or process, and with how many interruptions: the steps are the same to the last bit."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects, Simulation, _core

SPANS = {"bdf": 1e-3, "erk": 4e-4, "multirate": 1e-3}
"""Time of a run (s), with some hundred steps; the cage collides within it."""


def started(kit: SimpleNamespace, **options: Any) -> Simulation:
    """A cage that collides from the start."""
    sim = kit.simulate(Effects.paper(), **options)
    kit.throw(sim)
    return sim


def same(one: Simulation, other: Simulation) -> bool:
    return one.time == other.time and np.array_equal(one.state.vector, other.state.vector)


@pytest.fixture(scope="module", params=SPANS)
def reference(request: pytest.FixtureRequest, kit: SimpleNamespace) -> tuple[str, Simulation]:
    sim = started(kit, integrator=request.param)
    result = sim.run(duration=SPANS[request.param], save_every=1e-4)
    assert result.pocket_force.max() > 0.0
    return request.param, sim


@pytest.mark.parametrize("every", [1e-6, 3.7e-5, 1.0])
def test_dense_output_does_not_change_steps(
    kit: SimpleNamespace, reference: tuple[str, Simulation], every: float
) -> None:
    integrator, wanted = reference
    sim = started(kit, integrator=integrator)
    result = sim.run(duration=SPANS[integrator], save_every=every)
    assert same(sim, wanted)
    assert result.stats["steps"] == wanted.statistics["steps"]
    assert result.time[-1] == SPANS[integrator]


def test_records_do_not_depend_on_each_other(kit: SimpleNamespace, reference: tuple[str, Simulation]) -> None:
    """A record at an instant is the same whatever other instants are recorded; peaks are those since the record before."""
    integrator, _ = reference
    coarse = started(kit, integrator=integrator).run(duration=SPANS[integrator], save_every=2e-4)
    fine = started(kit, integrator=integrator).run(duration=SPANS[integrator], save_every=1e-4)
    for field in coarse.select(set(coarse.groups) - {"peaks"}).fields:
        np.testing.assert_array_equal(coarse[field.name], fine[field.name][::2], err_msg=field.name)


def test_pieces_make_the_whole(kit: SimpleNamespace, reference: tuple[str, Simulation]) -> None:
    integrator, wanted = reference
    sim = started(kit, integrator=integrator)
    for _ in range(4):
        sim.run(duration=SPANS[integrator] / 4, save_every=1e-4)
    assert same(sim, wanted)


def test_groups_files_and_callbacks_do_not_change_steps(
    kit: SimpleNamespace, reference: tuple[str, Simulation], tmp_path: Path
) -> None:
    integrator, wanted = reference
    sim = started(kit, integrator=integrator)
    looks = []

    def look(now: Simulation) -> None:
        looks.append((now.record()["time"], now.contacts()["force"], now.derivative(), now.counters, now.state))

    sim.run(
        duration=SPANS[integrator], save_every=1e-5, save_groups=["cage"], output=tmp_path / "run.h5", callback=look
    )
    assert looks
    assert same(sim, wanted)


def test_runs_repeat(kit: SimpleNamespace, reference: tuple[str, Simulation]) -> None:
    integrator, wanted = reference
    sim = started(kit, integrator=integrator)
    sim.run(duration=SPANS[integrator])
    assert same(sim, wanted)


@pytest.mark.parametrize("integrator", SPANS)
def test_restarts_are_exact(kit: SimpleNamespace, integrator: str) -> None:
    """A restart, a copy, a state set and a start from that state all go on alike, whatever the integrator did before."""
    sim = started(kit, integrator=integrator)
    sim.run(duration=SPANS[integrator] / 2)
    saved, copy = sim.state, sim.copy()
    scenery = {"start": trb.Start.state(saved.vector, time=saved.time)}
    anew = kit.simulate(Effects.paper(), scenery=scenery, integrator=integrator)
    elsewhere = started(kit, integrator=integrator)
    for _ in range(300):
        elsewhere.step()
    elsewhere.set_state(saved)
    sim.restart()
    others = [copy, anew, elsewhere]
    assert all(same(sim, other) for other in others)
    for steps in (1, 10, 300):
        for each in (sim, *others):
            for _ in range(steps):
                each.step()
        assert all(same(sim, other) for other in others)


@pytest.mark.parametrize(
    "changing",
    [
        {"ring": "follows", "radial_load": trb.History(times=(0.0, 4e-3, 8e-3), values=(0.0, 3000.0, 1000.0))},
        {"ring": "held", "speed_rpm": trb.History(times=(0.0, 8e-3), values=(2000.0, 3000.0))},
    ],
    ids=["follows", "held"],
)
def test_a_start_from_a_state_under_changing_loads(changing: dict[str, Any]) -> None:
    """A copy and a restart keep the motion that is prescribed. A start from a state computes it again from there: not the same
    bits, but as close to the equilibria (0.3 nm each)."""
    scene = trb.Scene(trb.cases.rig_30310(), **({"speed_rpm": 3000.0, "axial_load": 4930.0} | changing))
    sim = Simulation(scene)
    sim.run(duration=2.3e-3)
    copy, anew = sim.copy(), Simulation(scene.replace(start=trb.Start.state(sim.state)))
    sim.restart()
    loads = [one.run(duration=1e-3)["inner_load"][-1] for one in (sim, copy, anew)]
    assert same(sim, copy)
    assert anew.time == sim.time
    assert np.abs(anew.state.displacement - sim.state.displacement).max() < 6e-10
    np.testing.assert_allclose(loads[2], loads[0], atol=1e-4 * loads[0].max())


def test_a_copy_leaves_the_original_alone(kit: SimpleNamespace, reference: tuple[str, Simulation]) -> None:
    integrator, wanted = reference
    sim = started(kit, integrator=integrator)
    sim.run(duration=SPANS[integrator] / 2, save_every=1e-4)
    branch = sim.copy()
    branch.run(duration=SPANS[integrator])
    vector = branch.state.vector
    vector[0] += 1e-6
    branch.set_state(vector)
    sim.run(duration=SPANS[integrator] / 2, save_every=1e-4)
    assert same(sim, wanted)


SCRIPT = """
import hashlib, trbdyn as trb
sim = trb.Simulation(trb.Scene(trb.cases.rig_30310(), speed_rpm=3000.0, axial_load=4930.0, effects=trb.Effects.paper()))
sim.run(duration=2e-3)
print(hashlib.sha256(sim.state.vector.tobytes()).hexdigest())
"""


def test_processes_repeat(kit: SimpleNamespace) -> None:
    sim = kit.simulate(Effects.paper())
    sim.run(duration=2e-3)
    told = subprocess.run(
        [sys.executable, "-P", "-c", SCRIPT], capture_output=True, text=True, check=True
    ).stdout.strip()
    assert told == hashlib.sha256(sim.state.vector.tobytes()).hexdigest()


@pytest.mark.parametrize("name", _core.instruction_sets())
@pytest.mark.parametrize(
    "effects", [Effects.paper(), Effects.standard(), Effects.minimal()], ids=["paper", "standard", "minimal"]
)
def test_instruction_sets_agree(kit: SimpleNamespace, name: str, effects: Effects) -> None:
    """Forces to rounding, and a short run to the tolerance."""
    one, other = (kit.simulate(effects, instruction_set=chosen, accuracy="reference") for chosen in ("scalar", name))
    assert other.instruction_set == name
    vector = one.state.vector
    state = one.view(vector)
    state["cage_x"] += 2e-4
    state["roller_skew"] += np.linspace(-1e-3, 1e-3, 12)
    # in pure rolling differences of large velocities cancel down to their rounding
    for speed in ("roller_v_r", "roller_v_t", "roller_v_z", "roller_omega_n", "roller_omega_t", "roller_omega_a"):
        state[speed] += np.random.default_rng(5).uniform(0.1, 0.2, 12)
    wanted, found = one.contacts(vector), other.contacts(vector)
    assert wanted["pocket_load"].max() > 0.0
    for quantity, values in wanted.items():
        finite = values[np.isfinite(values)]
        size = np.abs(finite).max() if finite.size else 0.0
        np.testing.assert_allclose(found[quantity], values, rtol=1e-9, atol=1e-12 * size, err_msg=quantity)
    for sim in (one, other):
        kit.throw(sim, 0.2 if not effects.planar else 0.0)
    results = [sim.run(duration=5e-4, save_every=5e-5) for sim in (one, other)]
    np.testing.assert_allclose(results[1].cage_position, results[0].cage_position, atol=1e-9)
    np.testing.assert_allclose(results[1].outer_load, results[0].outer_load, rtol=1e-3)


def test_unknown_instruction_set(kit: SimpleNamespace) -> None:
    with pytest.raises(trb.InputError, match="instruction_set"):
        kit.simulate(Effects.paper(), instruction_set="mmx")
