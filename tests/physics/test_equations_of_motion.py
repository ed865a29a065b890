"""The core's rates are those of the same model written in NumPy, at states moved at random."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from numpy_model import NumpyModel

from trbdyn import Effects, Simulation, Start
from trbdyn.model.cases import paper_30310, scene_32216

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


def test_other_effects_are_refused() -> None:
    with pytest.raises(NotImplementedError, match="damping"):
        NumpyModel(paper_30310(effects=Effects.standard()))
