"""Sums along a contact converge with the number of its slices or nodes."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import Bearing, Effects
from trbdyn.model.bearing import Profile

Array = NDArray[np.float64]
TILT = 5e-5


def bearing(profile: Profile) -> Bearing:
    rig = trb.cases.rig_30310()
    return rig.replace(roller=rig.roller.replace(profile=profile))


CROWNED, LOGARITHMIC = bearing(Profile.crowned(100.0)), bearing(Profile.logarithmic(1833.0))


def sums(
    kit: SimpleNamespace, of: Bearing, quadrature: str, count: int, place: tuple[float, ...], vector: Array
) -> Array:
    """Outer load, radial force, moment and elastic energy of a roller at a given state."""
    effects = Effects.frictionless().replace(bodies="rollers", quadrature=quadrature, n_slices=count, back_rib=False)
    sim = kit.simulate(effects, scenery={"bearing": of, "displacement": place, "axial_load": 0.0})
    found = sim.contacts(vector)
    load = found["raceway_load"][0].sum(axis=-1)[0]
    return np.array([load, found["force"][0][0], found["moment"][0][1], found["elastic_energy"][0, 0]])


def errors(kit: SimpleNamespace, of: Bearing, quadrature: str, counts: tuple[int, ...]) -> dict[int, Array]:
    """Relative to 200 Gauss nodes, at the same state."""
    base = kit.simulate(Effects.frictionless().replace(bodies="rollers"), scenery={"bearing": of})
    vector, place = kit.tilted_state(base, TILT), tuple(base.equilibrium.displacement[:3])
    exact = sums(kit, of, "gauss", 200, place, vector)
    size = np.array([exact[0], exact[0], exact[0] * 1e-2, exact[3]])
    return {n: np.abs(sums(kit, of, quadrature, n, place, vector) - exact) / size for n in counts}


def test_uniform_slices_are_of_second_order(kit: SimpleNamespace) -> None:
    """Where the generator is smooth over the whole contact, doubling them takes three quarters of the error."""
    found = errors(kit, CROWNED, "uniform", (12, 24, 48))
    for one, two in ((12, 24), (24, 48)):
        ratio = found[one] / found[two]
        np.testing.assert_allclose(ratio, 4.0, rtol=0.05)
    assert found[24].max() < 1e-3


def test_gauss_nodes_are_exact_soon(kit: SimpleNamespace) -> None:
    found = errors(kit, CROWNED, "gauss", (2, 4, 8))
    assert found[4].max() < 1e-5
    assert found[8].max() < 1e-10
    assert found[4].max() < 1e-2 * found[2].max()


def test_logarithmic_profile(kit: SimpleNamespace) -> None:
    """Its end is nearly a logarithm's pole, which costs an order: first in slices, second in nodes, of load and energy."""
    carried = [0, 3]
    slices, nodes = errors(kit, LOGARITHMIC, "uniform", (16, 32, 64)), errors(kit, LOGARITHMIC, "gauss", (8, 16, 32))
    assert np.all(slices[32][carried] < 0.6 * slices[16][carried])
    assert np.all(slices[64][carried] < 0.6 * slices[32][carried])
    assert np.all(nodes[16][carried] < 0.4 * nodes[8][carried])
    assert np.all(nodes[32][carried] < 0.4 * nodes[16][carried])
    # with as many as the presets have
    shipped = errors(kit, LOGARITHMIC, "uniform", (24,))[24], errors(kit, LOGARITHMIC, "gauss", (16,))[16]
    assert shipped[0].max() < 1e-2
    assert shipped[1].max() < 1e-3


@pytest.mark.parametrize("quadrature", ["uniform", "gauss"])
@pytest.mark.parametrize("count", [2, 3, 8, 24, 50])
def test_even_contact_needs_no_slices(kit: SimpleNamespace, quadrature: str, count: int) -> None:
    """Along an aligned straight generator the interference hardly changes: any count gives the load."""
    straight = bearing(Profile.straight())
    base = kit.simulate(
        Effects.frictionless().replace(bodies="rollers", quadrature="gauss"), scenery={"bearing": straight}
    )
    place, vector = tuple(base.equilibrium.displacement[:3]), base.state.vector
    exact = sums(kit, straight, "gauss", 200, place, vector)[0]
    assert sums(kit, straight, quadrature, count, place, vector)[0] == pytest.approx(exact, rel=2e-3)


def test_equilibrium_carries_the_load_with_any_count(kit: SimpleNamespace) -> None:
    """The loads of the start do not depend on the slices; the ring's place does, a little."""
    loads, places = [], []
    for quadrature, count in (("uniform", 8), ("uniform", 24), ("gauss", 16), ("gauss", 100)):
        effects = Effects.paper().replace(quadrature=quadrature, n_slices=count)
        found = kit.simulate(effects, scenery={"radial_load": 0.0}).equilibrium
        loads.append([found.outer_load[0], found.inner_load[0], found.rib_load[0]])
        places.append(found.displacement[2])
    np.testing.assert_allclose(loads, np.broadcast_to(loads[-1], (4, 3)), rtol=1e-4)
    assert np.ptp(places) < 0.05 * abs(places[-1])
    assert abs(places[2] - places[3]) < 0.01 * abs(places[3])
