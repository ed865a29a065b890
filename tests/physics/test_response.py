"""The loads of the contacts move the bodies: more load changes the rates by that load over mass and inertia, each component."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from trbdyn import Effects, Scene, Simulation

EFFECTS = {"standard": Effects.standard(), "dry": Effects.standard().replace(lubrication="dry", gravity=False)}


def stiffer(scene: Scene, factor: float) -> Scene:
    values = scene.to_dict()
    values["bearing"]["material"]["youngs_modulus"] *= factor
    return Scene.from_dict(values)


@pytest.mark.parametrize("seed", [3, 4])
@pytest.mark.parametrize("name", EFFECTS)
def test_more_load_changes_rates_by_itself_over_inertia(kit: SimpleNamespace, name: str, seed: int) -> None:
    """Two materials at one state: everything in the rates that is not a load is the same and cancels."""
    soft = kit.simulate(EFFECTS[name], scenery={"displacement": (0.0, 0.0, -6e-5)})
    vector = kit.perturbed(soft, seed)
    stiff = Simulation(stiffer(soft.scene, 1.5))
    rates = [s.view(s.derivative(vector)) for s in (soft, stiff)]
    loads = [s.contacts(vector) for s in (soft, stiff)]
    geometry, state, cage = soft.scene.bearing.geometry, soft.view(vector), soft.scene.bearing.cage

    def change(key: str) -> np.ndarray:
        return np.asarray(rates[1][key] - rates[0][key])

    def more(key: str) -> np.ndarray:
        return np.asarray(loads[1][key] - loads[0][key])

    force, moment = more("force"), more("moment")
    assert np.abs(force).min(axis=0).max() > 1.0
    for index, part in enumerate(("r", "t", "z")):
        wanted = force[:, index] / geometry.roller_mass
        np.testing.assert_allclose(change(f"roller_v_{part}"), wanted, rtol=1e-6, atol=1e-6 * np.abs(wanted).max())
    attitudes = [
        kit.frame(float(skew), geometry.roller_axis_angle + float(tilt))
        for skew, tilt in zip(state["roller_skew"], state["roller_tilt"], strict=True)
    ]
    own = np.array([attitude.inv().apply(m) for attitude, m in zip(attitudes, moment, strict=True)])
    inertia = [geometry.roller_inertia_transverse] * 2 + [geometry.roller_inertia_axial]
    for index, part in enumerate("nta"):
        wanted = own[:, index] / inertia[index]
        assert np.abs(wanted).max() > 100.0
        np.testing.assert_allclose(change(f"roller_omega_{part}"), wanted, rtol=1e-6, atol=1e-6 * np.abs(wanted).max())
    force, moment = more("cage_force").sum(axis=0), more("cage_moment").sum(axis=0)
    assert np.abs(force).min() > 1e-3
    np.testing.assert_allclose([change(f"cage_v_{part}") for part in "xyz"], force / cage.mass, rtol=1e-6)
    own = kit.frame(float(state["cage_skew"]), float(state["cage_tilt"])).inv().apply(moment)
    wanted = own / np.array([cage.inertia_transverse] * 2 + [cage.inertia_axial])
    np.testing.assert_allclose([change(f"cage_omega_{part}") for part in "nta"], wanted, rtol=1e-6)
    # what is lost grows by the powers of the contacts
    # (works come first among the quadratures)
    lost = more("power").sum(axis=0)
    np.testing.assert_allclose(change("quadratures")[-lost.size :], lost, rtol=1e-6, atol=1e-9)
