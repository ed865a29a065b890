"""Surfaces of several facets in the core: each point of a roller meets the nearest facet of a surface, and no other."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.pocket import Face, Pocket

RADIUS = 20e-3


@pytest.fixture(scope="module")
def rig() -> trb.Bearing:
    return trb.cases.rig_30310()


def split(pocket: Pocket) -> Pocket:
    """The same pocket, whose bars are two halves along and two across."""
    faces: list[Face] = []
    for face in pocket.faces:
        if face.part != "flank":
            faces.append(face)
            continue
        (low, left), (high, right) = np.min(face.outline, axis=0), np.max(face.outline, axis=0)
        borders = ((low, 0.3 * low + 0.7 * high, high), (left, 0.5 * (left + right), right))
        for i in range(2):
            for j in range(2):
                (a, b), (c, d) = borders[0][i : i + 2], borders[1][j : j + 2]
                name = face.name if not i + j else f"{face.name}/{2 * i + j}"
                faces.append(face.replace(name=name, outline=((a, c), (b, c), (b, d), (a, d))))
    return Pocket(faces=tuple(faces))


def strips(pocket: Pocket, count: int) -> Pocket:
    """The pocket with bars that bulge across: strips along chords of a circle, which they touch with their edges."""
    faces: list[Face] = []
    for face in pocket.faces:
        if face.part != "flank":
            faces.append(face)
            continue
        u, v, normal = np.array(face.u), np.array(face.v), face.normal
        (low, left), (high, right) = np.min(face.outline, axis=0), np.max(face.outline, axis=0)
        half = math.asin(0.5 * (right - left) / RADIUS)
        centre = np.array(face.origin) + v * 0.5 * (left + right) - RADIUS * normal
        angles = np.linspace(-half, half, count + 1)
        for number, (first, last) in enumerate(pairwise(angles)):
            middle, wide = 0.5 * (first + last), RADIUS * math.sin(0.5 * (last - first))
            out = math.cos(middle) * normal + math.sin(middle) * v
            across = math.cos(middle) * v - math.sin(middle) * normal
            origin = centre + RADIUS * math.cos(0.5 * (last - first)) * out
            outline = ((low, -wide), (high, -wide), (high, wide), (low, wide))
            name = face.name if not number else f"{face.name}/{number}"
            faces.append(
                face.replace(
                    name=name,
                    origin=tuple(origin.tolist()),
                    u=tuple(u.tolist()),
                    v=tuple(across.tolist()),
                    outline=outline,
                )
            )
    return Pocket(faces=tuple(faces))


def loads(rig: trb.Bearing, pocket: Pocket, **scene: object) -> np.ndarray:
    """Forces and moments of the cage at states in which a few rollers touch their bars."""
    bearing = rig.replace({"cage.pocket": pocket})
    sim = trb.Simulation(
        trb.cases.scene_30310(0.0, 4930.0, bearing=bearing, effects=trb.Effects.paper().replace(n_slices=24))
    )
    random, found = np.random.default_rng(3), []
    for _ in range(6):
        vector = np.zeros_like(sim.state.vector)
        state = sim.view(vector)
        state["cage_x"], state["cage_y"] = random.uniform(-1.5e-4, 1.5e-4, 2)
        state["cage_z"] = random.uniform(0.0, 2e-4)
        state["roller_psi"] = random.uniform(-3.5e-3, 3.5e-3, 12)
        state["roller_skew"] = random.uniform(-3e-3, 3e-3, 12)
        contacts = sim.contacts(vector, 0.0)
        found.append(np.concatenate([contacts["cage_force"].ravel(), 1e2 * contacts["cage_moment"].ravel()]))
    return np.array(found)


def test_a_divided_face_is_the_same_face(rig: trb.Bearing) -> None:
    whole, parts = loads(rig, rig.pocket), loads(rig, split(rig.pocket))
    assert np.count_nonzero(whole) > 100
    np.testing.assert_allclose(parts, whole, rtol=1e-9, atol=1e-9 * np.abs(whole).max())


def test_strips_of_a_bulging_bar_converge_with_the_square_of_their_width(rig: trb.Bearing) -> None:
    found = {count: loads(rig, strips(rig.pocket, count)) for count in (7, 14, 28, 224)}
    size = np.abs(found[224]).max()
    off = [float(np.sqrt(np.mean((found[count] - found[224]) ** 2)) / size) for count in (7, 14, 28)]
    assert off[2] < 2e-3
    assert off[0] / off[2] > 8.0  # 16 of the second order; the strips' edges make it uneven


def test_a_run_with_facets_keeps_its_energy(rig: trb.Bearing) -> None:
    bearing = rig.replace({"cage.pocket": strips(rig.pocket, 12)})
    result = trb.Simulation(trb.Scene(bearing, speed_rpm=3000, axial_load=4930.0)).run(duration=0.02)
    assert result.success
    assert abs(result.energy_closure) < 1e-3
    assert result.pocket_force[..., :2].max() > 0.0


def test_an_elastic_cage_moves_a_surface_as_one(rig: trb.Bearing) -> None:
    """All facets of a bar move with the first one: were one moved about another point, work and energy would not agree."""
    bearing = rig.replace({"cage.body": trb.cases.cage_body_30310(), "cage.pocket": strips(rig.pocket, 5)})
    scene = trb.Scene(bearing, speed_rpm=3000, axial_load=4930.0, elastic_cage=trb.ElasticCage(n_modes=4))
    result = trb.Simulation(scene).run(duration=0.01)
    assert result.success
    assert result.pocket_force[..., :2].max() > 0.0
    assert abs(result.energy_closure) < 2e-3
