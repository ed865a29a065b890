"""Cages from drawings: files that examples/cage_drawings writes, read back."""

from __future__ import annotations

import math
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.drawn.opened import library
from trbdyn.model.drawn.read import read_cage

try:
    library()
except ImportError as error:
    pytest.skip(str(error), allow_module_level=True)


@pytest.fixture(scope="module")
def lands(drawings: ModuleType, rig: trb.Bearing, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return drawings.write("lands", rig, tmp_path_factory.mktemp("lands") / "lands.step")


@pytest.fixture(scope="module")
def read(rig: trb.Bearing, lands: Path) -> Any:
    return read_cage(lands, rig)


def same_faces(found: trb.Pocket, pocket: trb.Pocket) -> None:
    """Every polygon of a pocket is among those found; corners of a large-end wall that no roller covers may be cut off."""
    for face in pocket.faces:
        other = found.face(face.name)
        assert other.part == face.part
        assert other.slot == face.slot
        np.testing.assert_allclose(other.normal, face.normal, atol=1e-10)
        for vertex in face.vertices:
            if face.part != "large_end" or math.hypot(vertex[0], vertex[1]) < 7.6e-3:
                assert np.linalg.norm(other.vertices - vertex, axis=1).min() < 1e-10


def loads(bearing: trb.Bearing) -> np.ndarray:
    """Forces and moments on the rollers at random states in which many touch their pockets."""
    sim = trb.Simulation(trb.cases.scene_30310(0.0, 4930.0, bearing=bearing, effects=trb.Effects.paper()))
    random, found = np.random.default_rng(7), []
    for _ in range(5):
        vector = np.zeros_like(sim.state.vector)
        state = sim.view(vector)
        state["cage_x"], state["cage_y"] = random.uniform(-1.2e-4, 1.2e-4, 2)
        state["cage_z"] = random.uniform(-3e-5, 4.2e-4)
        state["cage_tilt"] = random.uniform(-1e-3, 1e-3)
        state["roller_psi"] = random.uniform(-3e-3, 3e-3, bearing.n_rollers)
        state["roller_skew"] = random.uniform(-2e-3, 2e-3, bearing.n_rollers)
        contacts = sim.contacts(vector, 0.0)
        found.append(np.concatenate([contacts["cage_force"].ravel(), 1e2 * contacts["cage_moment"].ravel()]))
    return np.array(found)


def test_the_shipped_cage_through_step(rig: trb.Bearing, read: Any) -> None:
    found = read
    assert found.n_pockets == 12
    assert found.kind_of == (0,) * 12
    same_faces(found.pockets[0], rig.pocket)
    for name, play in found.plays.items():
        assert play == pytest.approx(getattr(rig.cage, f"play_{name}"), abs=1e-10)
    drawn, polygons = (loads(rig.replace({"cage.pocket": pocket})) for pocket in (found.pockets[0], rig.pocket))
    assert np.abs(polygons).max() > 10.0
    assert np.count_nonzero(polygons) > 100
    np.testing.assert_allclose(drawn, polygons, rtol=1e-6, atol=1e-6 * np.abs(polygons).max())


@pytest.mark.slow
def test_walls_beyond_a_large_play_are_found(drawings: ModuleType, rig: trb.Bearing, tmp_path: Path) -> None:
    """Faces are kept as far as the roller moves: beyond a play of a twentieth of its diameter the small end has its wall, too."""
    wide = rig.replace({"cage.play_axial": 0.8e-3})
    found = read_cage(drawings.write("lands", wide, tmp_path / "wide.step"), wide, tolerance=1e-5)
    assert found.pockets[0].face("small_end_wall").part == "small_end"
    assert found.plays["axial"] == pytest.approx(0.8e-3, abs=1e-10)


def test_turned_shifted_and_in_inches(drawings: ModuleType, rig: trb.Bearing, read: Any, tmp_path: Path) -> None:
    path = drawings.write(
        "lands", rig, tmp_path / "moved.step", shift=(12.0, -30.0, 7.0), turn=(0.7, -2.1, 0.3), inches=True
    )
    before, after = read, read_cage(path, rig, tolerance=1e-5)
    same_faces(after.pockets[0], rig.pocket)
    assert after.volume == pytest.approx(before.volume, rel=1e-6)
    assert after.offset == pytest.approx(before.offset, abs=1e-9)
    np.testing.assert_allclose(after.inertia, before.inertia, atol=1e-5 * before.inertia.max())


@pytest.mark.slow
def test_a_broken_pocket_is_told(drawings: ModuleType, rig: trb.Bearing, tmp_path: Path) -> None:
    path = drawings.write("relieved", rig, tmp_path / "broken.step", broken=True)
    found = read_cage(path, rig, tolerance=1e-5)
    kinds = np.array(found.kind_of)
    others = np.flatnonzero(kinds != np.bincount(kinds).argmax())
    assert others.size == 1
    gaps = [
        min(pocket.gaps(rig.geometry)[face.name] for face in pocket.faces if face.part == "flank")
        for pocket in found.pockets
    ]
    assert max(gaps) - min(gaps) < 1.1e-4


def test_what_does_not_belong_together_is_refused(rig: trb.Bearing, lands: Path, tmp_path: Path) -> None:
    other = trb.cases.bearing_32216()
    with pytest.raises(trb.InputError, match=r"bearing\.n_rollers = .*must be the number of pockets in .*, 12"):
        trb.Cage.from_step(lands, other)
    nonsense = tmp_path / "cage.step"
    nonsense.write_text("no drawing")
    with pytest.raises(trb.FileError, match="is no STEP file"):
        trb.Cage.from_step(nonsense, rig)
    cut = tmp_path / "cut.step"
    cut.write_bytes(lands.read_bytes()[:2000])
    with pytest.raises(trb.FileError):
        trb.Cage.from_step(cut, rig)
    with pytest.raises(trb.InputError, match="tolerance"):
        trb.Cage.from_step(lands, rig, tolerance=1.0)
