"""The NumPy model of the peers' benchmark gives what the core gives."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from trbdyn import Effects, Simulation, Start
from trbdyn.model.cases import paper_30310, scene_32216

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
pytestmark = pytest.mark.skipif(not BENCHMARKS.is_dir(), reason="the benchmarks are not part of a source distribution")

Array = NDArray[np.float64]


SCENES = {
    "colliding": lambda: paper_30310(start=Start.whirl(0.9)),
    "combined": lambda: paper_30310(2000.0, 4930.0, 5530.0),
    "misaligned": lambda: paper_30310(3000.0, 1230.0, misalignment_x=2e-4, start=Start.unequal(3)),
    "other bearing": lambda: scene_32216(effects=Effects.paper()),
}


def moved(rng: np.random.Generator, z: int, size: float) -> Array:
    """A random move of a state's main part: micrometres of interference, slip of a per cent, contact in the pockets."""
    roller = [1e-7, 1e-5, 1e-7, 1e-6, 1e-6, 1e-3, 1e-3, 1e-3, 0.1, 0.1, 1.0]
    cage = [3e-5, 3e-5, 1e-4, 1e-5, 1e-5, 1e-4, 1e-2, 1e-2, 1e-2, 1.0, 1.0, 1.0]
    return size * rng.normal(size=11 * z + 12) * np.concatenate([np.tile(roller, z), cage])


def scales(sim: Simulation, load: float) -> Array:
    """What rates are compared to: forces cancel, so that a force over the mass is the scale of an acceleration."""
    geometry, cage, z = sim.scene.bearing.geometry, sim.scene.bearing.cage, sim.scene.bearing.n_rollers
    arm = 0.5 * sim.scene.bearing.roller.effective_length
    roller = [1.0, 10.0, 1.0, 10.0, 10.0, *[load / geometry.roller_mass] * 3]
    roller += [*[load * arm / geometry.roller_inertia_transverse] * 2, load * arm / geometry.roller_inertia_axial]
    held = [1.0] * 3 + [10.0] * 3 + [load / cage.mass] * 3 + [load * arm / cage.inertia_transverse] * 3
    return np.concatenate([np.tile(roller, z), held])


@pytest.mark.parametrize("name", SCENES)
def test_derivative_is_the_cores(name: str) -> None:
    from numpy_model import NumpyModel

    scene = SCENES[name]()
    sim = Simulation(scene)
    sim.run(duration=2e-3)
    model, start, time = NumpyModel(scene), sim.state.vector, sim.time
    n, rng, touched = model.n_state, np.random.default_rng(5), np.zeros(4)
    states = [start[:n] + moved(rng, scene.bearing.n_rollers, size) for size in (0.0, 1.0, 1.0, 1.0, 4.0, 4.0, 20.0)]
    for state in states:
        full = start.copy()
        full[:n] = state
        contacts = sim.contacts(full, time)
        touched += (contacts["pocket_load"] > 0.0).sum(axis=0)
        load = max(float(contacts["raceway_load"].sum(axis=2).max()), float(contacts["pocket_load"].sum(axis=1).max()))
        error = np.abs(model.derivative(time, state) - sim.derivative(full, time)[:n]) / scales(sim, load)
        assert error.max() < 1e-10, f"entry {error.argmax()}"
    together = model.derivative(time, np.array(states).T)
    alone = np.array([model.derivative(time, state) for state in states]).T
    np.testing.assert_allclose(together, alone, rtol=1e-9, atol=1e-5)
    assert touched[:2].all(), "bars were not touched"
    assert touched[2:].any(), "ends were not touched"


def test_front_rib_is_the_cores() -> None:
    from numpy_model import NumpyModel

    scene = paper_30310()
    sim, model = Simulation(scene), NumpyModel(scene)
    view = sim.view()
    view["roller_z"] -= 2.1e-4
    full, n = view._vector, model.n_state
    contacts = sim.contacts(full)
    assert contacts["front_rib_load"].max() > 0.0
    load = float(max(contacts["raceway_load"].sum(axis=2).max(), contacts["front_rib_load"].max()))
    error = np.abs(model.derivative(0.0, full[:n]) - sim.derivative(full)[:n]) / scales(sim, load)
    assert error.max() < 1e-10


def test_jacobian_is_that_of_all_differences() -> None:
    from numpy_model import Jacobian, NumpyModel
    from numpy_model.jacobian import CAGE_STEPS, ROLLER_STEPS

    scene = SCENES["colliding"]()
    sim = Simulation(scene)
    sim.run(duration=2e-3)
    model = NumpyModel(scene)
    jacobian, n, rng = Jacobian(model), model.n_state, np.random.default_rng(2)
    state = sim.state.vector[:n] + moved(rng, 12, 1.0)
    assert (sim.contacts(np.concatenate([state, sim.state.vector[n:]]))["pocket_load"] > 0.0).any()
    steps = np.concatenate([np.tile(ROLLER_STEPS, 12), CAGE_STEPS])
    moves = np.concatenate([np.zeros((n, 1)), np.diag(steps)], axis=1)
    rates = model.derivative(sim.time, state[:, None] + moves)
    plain = (rates[:, 1:] - rates[:, :1]) / steps
    found = jacobian.dense(sim.time, state)
    assert not plain[~jacobian.pattern].any()
    scale = np.abs(plain).max(axis=1, keepdims=True)
    assert (np.abs(found - plain) / scale).max() < 1e-9
    np.testing.assert_array_equal(jacobian.sparse(sim.time, state).toarray(), found)


@pytest.mark.parametrize("name", ["radau", "bdf_two", "lsoda_two", "sundae", "sundae_pattern", "sundae_dense"])
def test_alternatives_reach_the_cores_path(name: str) -> None:
    from numpy_model import Jacobian, NumpyModel, solvers

    scene = SCENES["colliding"]()
    sim = Simulation(scene)
    while sim.time < 2e-3 or sim.contacts()["pocket_load"].max() < 5.0:
        sim.step()
    model, times, place = NumpyModel(scene), sim.time + np.linspace(0.0, 3e-4, 7), sim.state
    entries = scene.bearing.n_rollers
    kinds = np.array([0, 1, 0, 1, 1, 2, 2, 2, 3, 3, 3] * entries + [0] * 3 + [1] * 3 + [2] * 3 + [3] * 3)
    tolerances = solvers.Tolerances(np.where(kinds >= 2, 1e-4, 0.0), np.array([3e-11, 3e-9, 1e-5, 1e-3])[kinds])
    problem = solvers.Problem(model, Jacobian(model), place.vector[: model.n_state], times, limit=60.0)
    found = getattr(solvers, name)(problem, tolerances)
    result = sim.run(duration=3e-4, save_every=5e-5)
    angle = scene.bearing.geometry.cage_speed_ratio * np.asarray(result["shaft_angle"])
    path = (result.cage_position[:, 0] + 1j * result.cage_position[:, 1]) * np.exp(-1j * angle)
    assert np.ptp(np.abs(path)) > 1e-7
    np.testing.assert_allclose(found.cage, np.stack([path.real, path.imag], axis=1), atol=1e-3 * 0.25e-3)
    assert found.steps > 5
    # LSODA stays with its explicit method over so short a run
    assert found.jacobians > 0 or name == "lsoda_two"


def test_other_effects_are_refused() -> None:
    from numpy_model import NumpyModel

    with pytest.raises(NotImplementedError, match="damping"):
        NumpyModel(paper_30310(effects=Effects.standard()))


def test_interpolation_at_equal_error() -> None:
    from peer_cost.compare import at_error

    points = [(1e-1, 1.0), (1e-3, 100.0), (2e-3, 500.0)]
    assert at_error(points, 1e-2) == pytest.approx(10.0)
    # what is slower at a larger error is no choice; beyond the ends the nearest point stands
    assert at_error(points, 1.0) == pytest.approx(1.0)
    assert at_error(points, 1e-9) == pytest.approx(100.0)


def test_report_is_plain_json(tmp_path: Path) -> None:
    from common import SCHEMA, Report

    options = Namespace(quick=True, json=tmp_path / "out.json")
    report = Report("name", options, {"value": "1: a number"})
    report.add(value=np.float64(np.nan))
    with pytest.raises(KeyError, match="other"):
        report.add(other=1)
    report.finish()
    found = json.loads(options.json.read_text(encoding="utf-8"))
    assert found["schema"] == SCHEMA
    assert found["results"] == [{"value": None}]
    assert found["machine"]["numpy"] == np.__version__


def test_an_alternative_that_is_not_installed_has_a_row_that_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    import peers
    from numpy_model import Jacobian, NumpyModel, solvers
    from peer_cost.methods import alternatives

    monkeypatch.setitem(sys.modules, "sksundae", None)
    monkeypatch.setitem(sys.modules, "sksundae.cvode", None)
    scene = SCENES["colliding"]()
    sim, model = Simulation(scene), NumpyModel(scene)
    start = sim.state.vector[: model.n_state]
    tolerances = solvers.Tolerances(np.full(model.n_state, 1e-4), np.full(model.n_state, 1e-9))
    problem = solvers.Problem(model, Jacobian(model), start, sim.time + np.linspace(0.0, 1e-6, 3), limit=60.0)

    class Bench:
        def peer(self, *_: object, run: Callable[..., Any]) -> Any:
            return run(problem, tolerances)

        def measure(self, method: Any) -> list[Any]:
            return [method.run(None, 1.0, 1e-6, True)]

    bench: Any = Bench()
    found = [method for method in alternatives(bench, True) if "sundae" in method.name]
    assert [method.name for method in found] == ["scikit-sundae CVODE", "scikit-sundae CVODE, our Jacobian"]
    for method in found:
        points, failure = peers.attempt(bench, method)
        assert points == []
        assert failure is not None
        assert "sksundae" in failure
