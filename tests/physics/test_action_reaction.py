"""What a roller's contacts put on roller, rings and cage adds up to nothing, force and moment, for each kind of contact."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trbdyn import Effects

BARE = Effects.paper().replace(
    bodies="rollers", back_rib=False, front_rib=False, rolling_resistance=False, gravity=False
)
ROUNDING = 1e-12
"""Of the sums, beside the forces that cancel in them."""

KINDS: dict[str, tuple[dict[str, Any], str]] = {
    "race_mixed": ({}, "raceway_load"),
    "race_boundary": ({"lubrication": "boundary"}, "raceway_load"),
    "race_dry": ({"lubrication": "dry"}, "raceway_load"),
    "race_normal": ({"lubrication": "full_film", "traction": "none", "thermal": False}, "raceway_load"),
    "back_rib": ({"back_rib": True}, "rib_load"),
    "back_rib_dry": ({"back_rib": True, "lubrication": "dry"}, "rib_load"),
    "front_rib": ({"front_rib": True}, "front_rib_load"),
    "pocket": ({"bodies": "rollers_and_cage"}, "pocket_load"),
    "pocket_unbounded": ({"bodies": "rollers_and_cage", "pocket_edges": False}, "pocket_load"),
    "pocket_dry": ({"bodies": "rollers_and_cage", "lubrication": "dry"}, "pocket_load"),
    "pocket_film": ({"bodies": "rollers_and_cage", "pocket_film": 3e-4}, "pocket_load"),
    "race_damping": ({"damping": "hunt_crossley", "damping_race": 3.0}, "raceway_load"),
    "rib_damping": ({"back_rib": True, "damping": "hunt_crossley", "damping_race": 3.0}, "rib_load"),
    "front_rib_damping": ({"front_rib": True, "damping": "hunt_crossley", "damping_race": 3.0}, "front_rib_load"),
    "pocket_damping": (
        {"bodies": "rollers_and_cage", "damping": "hunt_crossley", "damping_cage": 3.0},
        "pocket_load",
    ),
}
RING = {"misalignment_x": 1e-3, "misalignment_y": -5e-4, "radial_load": 2000.0}


def sizes(kit: SimpleNamespace, sim: Any, vector: Any, found: dict[str, Any]) -> tuple[float, float]:
    """Sizes of the forces and moments that cancel."""
    force = max(float(np.abs(found[name]).max()) for name in ("force", "ring_force", "outer_force", "cage_force"))
    return force, force * float(np.linalg.norm(kit.roller_place(sim, vector, 0)))


@pytest.mark.parametrize("kind", KINDS)
def test_forces_and_moments_vanish(kit: SimpleNamespace, kind: str) -> None:
    changes, load = KINDS[kind]
    sim = kit.simulate(BARE.replace(**changes), scenery=RING)
    seen = 0
    for seed in range(4):
        vector = kit.perturbed(sim, seed, back=2.5e-4 if "front_rib" in kind else 0.0)
        force, moment, found = kit.balance(sim, vector, time=3e-3 * seed)
        force_size, moment_size = sizes(kit, sim, vector, found)
        assert np.abs(force).max() < ROUNDING * force_size
        assert np.abs(moment).max() < ROUNDING * moment_size
        seen += int(np.count_nonzero(found[load] > 0.0))
    assert seen >= 12


@pytest.mark.parametrize(("kind", "switch"), [("back_rib", "back_rib"), ("front_rib", "front_rib")])
def test_a_rib_alone_balances(kit: SimpleNamespace, kind: str, switch: str) -> None:
    """The difference that a rib makes, with the same raceway forces in both sums."""
    with_rib = kit.simulate(BARE.replace(**{switch: True}), scenery=RING)
    without = kit.simulate(
        BARE, scenery=RING | {"displacement": tuple(with_rib.equilibrium.displacement[:3])} | {"radial_load": 0.0}
    )
    vector = kit.perturbed(with_rib, 5, back=2.5e-4 if kind == "front_rib" else 0.0)
    _, _, a = kit.balance(with_rib, vector)
    _, _, b = kit.balance(without, vector)
    on_roller, on_ring = a["force"] - b["force"], a["ring_force"] - b["ring_force"]
    assert np.abs(on_roller).max() > 1.0
    np.testing.assert_allclose(on_roller, -on_ring, atol=1e-12 * np.abs(a["force"]).max())
    assert np.array_equal(a["outer_force"], b["outer_force"])


def drag(found: dict[str, Any]) -> tuple[Any, Any]:
    """Force and moment about the apex of the rolling resistance on both surfaces, from each node's own numbers."""
    mean = np.stack([found[f"raceway_m{axis}"] for axis in "xyz"], axis=-1)
    point = np.stack([found[f"raceway_p{axis}"] for axis in "xyz"], axis=-1)
    loaded = found["raceway_rolling"] > 0.0
    size = np.divide(found["raceway_rolling"], found["raceway_mean_speed"], out=np.zeros(loaded.shape), where=loaded)
    force = -2.0 * size[..., None] * mean
    return force.sum(axis=(0, 2)), np.cross(point, force).sum(axis=(0, 2))


def test_rolling_resistance_drags_both_surfaces(kit: SimpleNamespace) -> None:
    """Without its pressure force it has no opposite: what is left is exactly the drag of both surfaces."""
    sim = kit.simulate(BARE.replace(rolling_resistance=True), scenery=RING)
    for seed in range(4):
        vector = kit.perturbed(sim, seed)
        force, moment, found = kit.balance(sim, vector, time=2e-3)
        force_size, moment_size = sizes(kit, sim, vector, found)
        left_force, left_moment = drag(found)
        assert np.abs(left_force).max() > 1.0
        np.testing.assert_allclose(force, left_force, atol=ROUNDING * force_size)
        np.testing.assert_allclose(moment, left_moment, atol=ROUNDING * moment_size)


def test_pressure_force_balances_rolling_resistance(kit: SimpleNamespace) -> None:
    sim = kit.simulate(BARE.replace(rolling_resistance=True, rolling_pressure_force=True), scenery=RING)
    for seed in range(4):
        vector = kit.perturbed(sim, seed)
        force, moment, found = kit.balance(sim, vector, time=2e-3)
        force_size, moment_size = sizes(kit, sim, vector, found)
        assert found["raceway_rolling"].max() > 0.0
        assert np.abs(force).max() < ROUNDING * force_size
        assert np.abs(moment).max() < ROUNDING * moment_size


def test_recorded_sums_are_those_of_the_contacts(kit: SimpleNamespace) -> None:
    """Ring and cage forces of a record, in inertial coordinates, are the contacts' turned there."""
    sim = kit.simulate(Effects.standard(), scenery=RING)
    vector, time = kit.perturbed(sim, 3), 4e-3
    found, record = sim.contacts(vector, time), sim.record(vector, time)
    turn = kit.frame_angle(sim, vector, time)
    ring = sum(
        kit.about_z(turn + angle).apply(force)
        for angle, force in zip(kit.orbit_angles(sim, vector), found["ring_force"], strict=True)
    )
    cage = kit.about_z(turn).apply(found["cage_force"].sum(axis=0))
    np.testing.assert_allclose(record["ring_force"], ring, rtol=1e-11, atol=1e-8)
    np.testing.assert_allclose(record["cage_force"], cage, rtol=1e-11, atol=1e-8)
    assert np.linalg.norm(cage) > 1.0


def test_friction_of_the_front_rib_is_its_load_times_the_coefficient(kit: SimpleNamespace) -> None:
    """And it is what acts on the ring across the load; where both edges of the rib touch, theirs may point to different sides."""
    with_rib = kit.simulate(BARE.replace(front_rib=True), scenery=RING)
    place = {"displacement": tuple(with_rib.equilibrium.displacement[:3]), "radial_load": 0.0}
    without = kit.simulate(BARE, scenery=RING | place)
    shares = []
    for seed, back in enumerate(np.linspace(2.1e-4, 2.5e-4, 8)):
        vector = kit.perturbed(with_rib, seed, back=float(back))
        found = with_rib.contacts(vector, 0.0)
        force = np.linalg.norm(found["ring_force"] - without.contacts(vector, 0.0)["ring_force"], axis=1)
        touching = found["front_rib_load"] > 0.0
        load, friction = found["front_rib_load"][touching], found["front_rib_friction"][touching]
        coefficient = found["front_rib_friction_coefficient"][touching]
        assert friction == pytest.approx(load * coefficient, rel=1e-6)
        shares += list(np.sqrt(force[touching] ** 2 - load**2) / friction)
    assert len(shares) >= 12
    assert 0.999 < max(shares) < 1.0 + 1e-9
