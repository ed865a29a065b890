"""Scenes at the edge of what is allowed: either they are refused, or every rate and every quantity of a contact is a
number.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from trbdyn import Effects, InputError, Scene, Simulation, cases, laws
from trbdyn.model.lubricants import Dicke, Lubricant, vg100


def assert_finite(scene: Scene) -> None:
    sim = Simulation(scene)
    state = sim.state.vector
    view = sim.view(state)
    random = np.random.default_rng(1)
    for part, size in (("skew", 1e-3), ("v_t", 0.1), ("omega_a", 30.0), ("z", -2e-5)):
        view[f"roller_{part}"] += size * random.uniform(0.0, 1.0, scene.bearing.n_rollers)
    for vector in (sim.state.vector, state):
        assert np.all(np.isfinite(sim.derivative(vector)))
        for name, values in sim.contacts(vector).items():
            # a slot that is not there has no gap: -inf
            assert np.all(np.isfinite(values) | ((name == "pocket_interference") & np.isneginf(values))), name


EXTREMES: dict[str, dict[str, Any]] = {
    "standstill": {"speed_rpm": 0.0},
    "backwards": {"speed_rpm": -3000.0},
    "creeping": {"speed_rpm": 1e-9},
    "fast": {"speed_rpm": 30000.0, "axial_load": 40e3},
    "light": {"axial_load": 60.0},
    "heavy": {"axial_load": 500e3},
    "cold": {"lubricant": vg100(-14.0)},
    "hot": {"lubricant": vg100(200.0)},
    "barus": {"lubricant": vg100(0.0, pressure_law="barus"), "axial_load": 200e3},
    "roelands": {"lubricant": vg100(0.0, pressure_law="roelands"), "axial_load": 200e3},
    "thin": {"lubricant": vg100(60.0).replace(viscosity=1e-9)},
    "thick": {"lubricant": vg100(60.0).replace(viscosity=1e4)},
    "no_beta": {"lubricant": vg100(60.0).replace(temperature_coefficient=0.0)},
    "starved": {"effects": Effects.paper().replace(starvation_factor=1e-4)},
    "one_slice": {"effects": Effects.paper().replace(n_slices=1)},
    "many_nodes": {"effects": Effects.paper().replace(n_slices=200, quadrature="gauss")},
    "standard": {"effects": Effects.standard()},
    "frictionless": {"effects": Effects.frictionless()},
    "minimal": {"effects": Effects.minimal()},
}


@pytest.mark.parametrize("changes", EXTREMES.values(), ids=EXTREMES)
def test_every_quantity_is_a_number(changes: dict[str, Any]) -> None:
    assert_finite(cases.paper_30310(**changes))


def test_dicke_beyond_its_pole() -> None:
    """Below -14.7 C the constants of FVA3 give a viscosity that is infinite at a finite pressure: 0.45 GPa at -80 C."""
    oil = {
        "viscosity": 1.0,
        "pressure_coefficient": 2e-8,
        "temperature_coefficient": 0.04,
        "temperature_c": -80.0,
        "dicke": Dicke(),
    }
    try:
        scene = cases.paper_30310(300.0, lubricant=Lubricant(**oil))
    except InputError:
        return
    assert_finite(scene)


def test_isoviscous_oil() -> None:
    try:
        scene = cases.paper_30310(lubricant=vg100(60.0).replace(pressure_coefficient=0.0))
    except InputError:
        return
    assert_finite(scene)


def test_logarithmic_profile_at_its_end() -> None:
    """The drop at the end is zm for any design load."""
    load = np.geomspace(10.0, 1e5, 30)
    drop = laws.profile_logarithmic(9.9e-3, 19.8e-3, 1.5, 0.4, 10e-6, load, 226.37e9)
    assert drop == pytest.approx(10e-6, rel=1e-12)


@pytest.mark.parametrize(("zm", "load"), [(0.0, 1833.0), (-1e-6, 1833.0), (10e-6, 0.0), (10e-6, -5.0)])
@pytest.mark.parametrize("station", [7e-3, 9.9e-3])
def test_logarithmic_profile_without_a_drop_or_a_load_is_straight(zm: float, load: float, station: float) -> None:
    assert laws.profile_logarithmic(station, 19.8e-3, 1.5, 0.4, zm, load, 226.37e9) == 0.0


def test_rib_above_the_roller() -> None:
    rig = cases.rig_30310()
    with pytest.raises(InputError):
        rig.replace(ribs=rig.ribs.replace(contact_height=0.05, edge_high=0.09))
