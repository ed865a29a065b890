"""A cage weighs what its rims and bars weigh; material, mass and inertias go together."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.cage_body import Wall, cage_mass

RIG, BODY = trb.cases.rig_30310(), trb.cases.cage_body_30310()
PLAYS = {"play_radial": 0.25e-3, "play_circumferential": 0.12e-3}


def with_body(body: trb.CageBody = BODY, **numbers: Any) -> trb.Bearing:
    return RIG.replace(cage=trb.Cage(**PLAYS, body=body, **numbers))


def test_mass_and_inertias_against_random_points() -> None:
    """Points spread evenly over a box around the cage, each judged by the planes of the faces themselves."""
    bearing, count = with_body(), 700_000
    wall, random = Wall.of(bearing, BODY), np.random.default_rng(1)
    low, high = np.array([0.034, -0.02]), np.array([0.055, 0.02])
    rho, z = (low + (high - low) * random.random((count, 2))).T
    phi = random.uniform(-math.pi / 12, math.pi / 12, count)
    sine, cosine = math.sin(wall.angle), math.cos(wall.angle)
    a, n = (rho - wall.radius) * sine + z * cosine, (rho - wall.radius) * cosine - z * sine
    face = bearing.pocket.face("leading_bar")
    x, y = rho * np.cos(phi), rho * np.sin(np.abs(phi))  # in the frame of the pocket's middle
    place = np.stack([(x - wall.radius) * cosine - z * sine, y, (x - wall.radius) * sine + z * cosine], axis=-1)
    window = (place - np.array(face.origin)) @ face.normal > 0.0
    solid = (np.abs(n - wall.height) < 0.5 * wall.thickness) & (a > wall.small_edge - wall.small_width)
    solid &= (a < wall.large_edge + wall.large_width) & ~((a > wall.small_edge) & (a < wall.large_edge) & window)
    weight = 7810.0 * 12 * solid * rho * (math.pi / 6) * np.prod(high - low) / count
    mass, offset = weight.sum(), (weight * z).sum() / weight.sum()
    axial = (weight * rho**2).sum()
    found = cage_mass(wall, 7810.0)
    assert found.mass == pytest.approx(mass, rel=5e-3)
    assert found.offset == pytest.approx(offset, abs=5e-5)
    assert found.inertia_axial == pytest.approx(axial, rel=5e-3)
    transverse = 0.5 * axial + (weight * (z - offset) ** 2).sum()
    assert found.inertia_transverse == pytest.approx(transverse, rel=5e-3)


def test_a_flat_hoop() -> None:
    """Rims of a cylinder with pockets of no length, by hand: two tubes."""
    wall = Wall(12, 0.05, 0.0, 0.0, 2e-3, 2e-3, 2e-3, 0.0, 0.0, 4e-3, 4e-3, np.array([-0.4, -0.9, 0.0]), -0.02, 0.0)
    found = cage_mass(wall, 8000.0)
    mass = 8000.0 * math.pi * (0.051**2 - 0.049**2) * 8e-3
    assert found.mass == pytest.approx(mass, rel=1e-12)
    assert found.offset == pytest.approx(0.0, abs=1e-15)
    assert found.inertia_axial == pytest.approx(0.5 * mass * (0.051**2 + 0.049**2), rel=1e-12)
    assert found.inertia_transverse == pytest.approx(0.5 * found.inertia_axial + mass * 8e-3**2 / 12, rel=1e-12)


def test_the_body_of_the_rig_weighs_what_the_rig_does() -> None:
    cage = with_body().cage
    assert cage.mass == pytest.approx(RIG.cage.mass, rel=2e-3)
    assert cage.inertia_axial == pytest.approx(RIG.cage.inertia_axial, rel=0.02)
    assert cage.inertia_transverse == pytest.approx(RIG.cage.inertia_transverse, rel=0.05)


def test_the_material_changes_mass_and_inertias_together() -> None:
    steel, plastic = with_body().cage, with_body(material=trb.Material.polyamide()).cage
    for name in ("mass", "inertia_axial", "inertia_transverse"):
        assert getattr(plastic, name) == pytest.approx(1320 / 7810 * getattr(steel, name), rel=1e-12)
    assert plastic.offset == pytest.approx(steel.offset, rel=1e-12)
    plain = RIG.replace(cage=trb.Cage(**PLAYS))
    light = plain.replace({"cage.material": trb.Material.polyamide()}).cage
    assert light.mass == pytest.approx(1320 / 7810 * plain.cage.mass, rel=1e-12)
    assert light.inertia_axial == pytest.approx(1320 / 7810 * plain.cage.inertia_axial, rel=1e-12)
    ceramic = RIG.replace({"roller.material": trb.Material.silicon_nitride()})
    assert (ceramic.roller.density, RIG.roller.density) == (3200.0, 7810.0)


def test_a_weighed_cage_keeps_its_mass() -> None:
    cage = with_body(mass=0.1).cage
    assert cage.mass == 0.1
    assert cage.inertia_axial == pytest.approx(0.1 / with_body().cage.mass * with_body().cage.inertia_axial, rel=1e-12)


def test_files_keep_what_followed_from_the_body() -> None:
    bearing = with_body()
    assert trb.Bearing.from_json(bearing.to_json()) == bearing
    assert {"cage.mass", "cage.inertia_axial"} <= set(bearing.assumed)
    values = bearing.to_dict()
    values["cage"]["mass"] = 0.199  # as another version of the package may have found it
    assert trb.Bearing.from_dict(values).cage.mass == 0.199


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"thickness": 9e-3}, r"cage\.body\.thickness = 0\.009 : must be < 0\.008"),
        ({"large_rim_thickness": 9e-3}, r"cage\.body\.large_rim_thickness = 0\.009"),
        ({"height": -6e-3, "thickness": 1.9e-3}, "must leave a bar"),
    ],
)
def test_walls_without_room_are_refused(change: dict[str, float], match: str) -> None:
    with pytest.raises(trb.InputError, match=match):
        RIG.replace(n_rollers=17, cage=trb.Cage(**PLAYS, body=BODY.replace(**change)))


def test_a_material_without_density_is_asked_for_it() -> None:
    with pytest.raises(trb.InputError, match=r"cage\.material\.density = None : must be given"):
        with_body(material=trb.Material(youngs_modulus=70e9, poisson_ratio=0.33))


def test_the_mass_of_steel_in_plastic_is_said() -> None:
    scene = trb.cases.scene_30310().replace({"bearing.cage.material": trb.Material.polyamide()})
    assert any("does not follow a change of the material" in text for text in trb.Simulation(scene).warnings)
    assert not any("material" in text for text in trb.Simulation(trb.cases.scene_30310()).warnings)
