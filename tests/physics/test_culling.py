"""Pocket faces that are left out because they are out of reach must never have carried anything.

Looking into contacts evaluates every face; the right-hand side leaves out what its bound proves out of reach. Both must push
the cage alike, wherever rollers and cage stand.
"""

from __future__ import annotations

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.bearing import Profile, Scatter

STATES = 400


def bearing(profile: str) -> trb.Bearing:
    """A rig bearing with another roller profile and rollers of 20 um scatter."""
    rig = trb.cases.rig_30310()
    made = {"straight": Profile.straight(), "logarithmic": Profile.logarithmic(1833.0)}[profile]
    return rig.replace(roller=rig.roller.replace(profile=made, diameter_scatter=Scatter(range=2e-5, seed=3)))


@pytest.mark.parametrize(("profile", "film"), [("straight", 0.0), ("logarithmic", 0.0), ("straight", 4e-5)])
def test_culled_faces_carry_nothing(profile: str, film: float) -> None:
    effects = trb.Effects.standard().replace(pocket_film=film)
    scene = trb.Scene(bearing(profile), speed_rpm=3000, axial_load=4930.0, start=trb.Start.whirl(0.9), effects=effects)
    sim = trb.Simulation(scene)
    mass, gravity = scene.bearing.cage.mass, np.array([0.0, -9.80665, 0.0])
    speed = scene.bearing.geometry.cage_speed_ratio * 3000 * np.pi / 30
    random = np.random.default_rng(11)
    start, touching, spared = sim.state.vector, 0, 0
    for _ in range(STATES):
        vector = start.copy()
        view = sim.view(vector)
        view["roller_psi"] += random.normal(0.0, 2e-3, view["roller_psi"].shape)
        view["roller_skew"] += random.normal(0.0, 2e-3, view["roller_skew"].shape)
        view["roller_tilt"] += random.normal(0.0, 5e-4, view["roller_tilt"].shape)
        for name in ("cage_x", "cage_y", "cage_z"):
            view[name] += random.normal(0.0, 1e-4)
        for name in ("cage_skew", "cage_tilt", "cage_psi"):
            view[name] += random.normal(0.0, 2e-3)
        every = sim.contacts(vector, 0.0)
        force = every["cage_force"].sum(axis=0)
        velocity = np.array([view[name].item() for name in ("cage_v_x", "cage_v_y", "cage_v_z")])
        expected = force / mass + gravity - np.cross([0.0, 0.0, speed], velocity)
        rates = sim.view(sim.derivative(vector, 0.0))
        found = np.array([rates[name].item() for name in ("cage_v_x", "cage_v_y", "cage_v_z")])
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-9 * (1.0 + np.abs(expected).max()))
        reach = every["pocket_interference"][:, :2]
        touching += int(np.count_nonzero(reach > 0.0))
        spared += int(np.count_nonzero(reach < -1e-5))
    assert touching > STATES
    assert spared > STATES
