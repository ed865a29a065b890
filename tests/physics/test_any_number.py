"""Any number of rollers and of nodes along them: contacts are evaluated in groups, and the last group is seldom full."""

from __future__ import annotations

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import Effects, Scene, Simulation


@pytest.mark.parametrize("rollers", [3, 7, 11, 12])
@pytest.mark.parametrize("nodes", [1, 5, 8, 24])
def test_rollers_under_an_axial_load_carry_the_same(rollers: int, nodes: int) -> None:
    """Together they carry the load; each contact as in a bearing with another number of rollers under the same load each."""
    rig = trb.cases.rig_30310()
    effects = Effects.paper().replace(quadrature="gauss", n_slices=nodes, bodies="rollers", gravity=False)

    def found(count: int) -> dict[str, np.ndarray]:
        bearing = rig.replace(n_rollers=count)
        given = {"speed_rpm": 0.0, "axial_load": 400.0 * count, "effects": effects}
        return Simulation(Scene(bearing=bearing, start=trb.Start.equal(), **given)).contacts()

    here, other = found(rollers), found(6)
    for race in range(2):
        loads = here["raceway_load"][race].sum(axis=-1)
        assert loads.shape == (rollers,)
        np.testing.assert_allclose(loads, loads[0], rtol=1e-9)
        np.testing.assert_allclose(here["raceway_load"][race][0], other["raceway_load"][race][0], rtol=1e-6)
    np.testing.assert_allclose(here["force"], np.broadcast_to(other["force"][0], (rollers, 3)), atol=1e-6)
    carried = -np.sum(here["outer_force"][:, 2])
    assert abs(carried) == pytest.approx(400.0 * rollers, rel=1e-6)
