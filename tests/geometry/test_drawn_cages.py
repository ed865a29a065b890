"""Cages from drawings: files that examples/cage_drawings writes, read back."""

from __future__ import annotations

import math
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.cad.corners import depth_in, edges_of, is_corner, radius_of
from trbdyn.extras.cad.facets import Facet
from trbdyn.extras.cad.opened import gmsh_model, library
from trbdyn.extras.cad.read import read_cage

try:
    library()
except ImportError as error:
    pytest.skip(str(error), allow_module_level=True)


@pytest.fixture(scope="module")
def lands(drawings: ModuleType, rig: trb.Bearing, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The shipped cage, turned, shifted and in inches."""
    path = tmp_path_factory.mktemp("lands") / "lands.step"
    return drawings.write("lands", rig, path, shift=(12.0, -30.0, 7.0), turn=(0.7, -2.1, 0.3), inches=True)


@pytest.fixture(scope="module")
def read(rig: trb.Bearing, lands: Path) -> Any:
    return read_cage(lands, rig, tolerance=1e-5)


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


@pytest.mark.slow
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


@pytest.mark.slow
def test_turned_shifted_and_in_inches(drawings: ModuleType, rig: trb.Bearing, read: Any, tmp_path: Path) -> None:
    """Mass and inertia are those of the drawing in its place."""
    before, after = read_cage(drawings.write("lands", rig, tmp_path / "lands.step"), rig), read
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


def hollow(radius: float, bar: float, wall: float, strips: int = 24) -> list[Facet]:
    """A corner of a window between a bar at t = bar and a wall at the small ends at z = wall, rounded, as strips along n (m)."""
    turned = np.linspace(0.0, 0.5 * math.pi, strips + 1)
    t, z = bar - radius * (1.0 - np.cos(turned)), wall + radius * (1.0 - np.sin(turned))
    found = []
    for k in range(strips):
        corners = np.array(
            [(-2e-3, t[k], z[k]), (2e-3, t[k], z[k]), (2e-3, t[k + 1], z[k + 1]), (-2e-3, t[k + 1], z[k + 1])]
        )
        middle = 0.5 * (turned[k] + turned[k + 1])
        found.append(Facet(corners, np.array([0.0, -math.cos(middle), math.sin(middle)]), 1))
    return found


@pytest.mark.parametrize(("radius", "chamfer"), [(0.3e-3, 0.5e-3), (0.5e-3, 0.5e-3), (0.8e-3, 0.5e-3), (0.3e-3, 0.0)])
def test_a_corner_up_to_the_chamfer_is_free_of_the_roller(radius: float, chamfer: float) -> None:
    """A roller that touches bar and wall is in the corner by (sqrt(2) - 1) times what the radius is above the chamfer: both
    roundings have their centres on the line at 45 degrees."""
    bearing = trb.cases.bearing_nj210()
    edges = edges_of(bearing, chamfer)
    facets = hollow(radius, 0.5 * bearing.roller.diameter, bearing.geometry.small_end_station)
    expected = (math.sqrt(2.0) - 1.0) * max(radius - chamfer, 0.0)
    assert depth_in(facets, edges, 1e-3) == pytest.approx(expected, abs=4e-6)
    points, normals = np.array([f.corners.mean(axis=0) for f in facets]), np.array([f.normal for f in facets])
    length = bearing.roller.effective_length
    assert is_corner(points, normals, length)
    assert radius_of(points, normals) == pytest.approx(radius, rel=0.01)
    assert not is_corner(points, -normals, length)  # round outwards
    assert not is_corner(points + np.array([0.0, 0.0, 0.5 * length]), normals, length)  # in the middle of a bar
    assert not is_corner(points[:8], normals[:8], length)  # a bar with a round side


@pytest.mark.slow
def test_corners_larger_than_the_chamfer(drawings: ModuleType, rig: trb.Bearing, tmp_path: Path) -> None:
    """The chamfer of the 30310's rollers, 0.5 mm, follows from their lengths: corners of 0.8 mm are refused in words of what can
    be given, and change no play with a chamfer of 0.8 mm. Those of 0.3 mm are in the table of test_drawn_kinds.py."""
    path = drawings.write("machined", rig, tmp_path / "large.step", corner=0.8e-3)
    with pytest.raises(trb.FileError, match=r"chamfer = 0\.5 mm, .* radius 0\.8 mm .* give the roller's chamfer"):
        trb.Cage.from_step(path, rig, tolerance=1e-5)
    cage = trb.Cage.from_step(path, rig, tolerance=1e-5, chamfer=0.8e-3)
    assert cage.play_circumferential == pytest.approx(0.12e-3, abs=2e-6)
    assert cage.play_axial == pytest.approx(0.4e-3, abs=5e-6)  # the wall begins 1 mm off the apex of the end's sphere


def test_a_wrong_unit_is_named(rig: trb.Bearing, tmp_path: Path) -> None:
    """A cage of 87 mm that is 1/25.4 or 25.4 times as large."""
    for size, words in (
        (87.0 / 25.4, "are inches, and the file says millimetres"),
        (87.0 * 25.4, "are millimetres, and"),
    ):
        path = tmp_path / f"{size:.0f}.step"
        with gmsh_model() as gmsh:
            gmsh.model.occ.addBox(0.0, 0.0, 0.0, size, size, 0.2 * size)
            gmsh.model.occ.synchronize()
            gmsh.write(str(path))
        with pytest.raises(trb.FileError, match=words.replace("are ", "seem to be ")):
            trb.Cage.from_step(path, rig)
    with pytest.raises(trb.InputError, match="a STEP file tells its unit"):
        trb.Cage.from_step(path, rig, unit="inch")
    for number, unit, right in ((87.0 / 25.4, "mm", "inch"), (87.0, "inch", "mm"), (0.087, "mm", "m")):
        corners = "\n".join(f"vertex {x} {y} 0" for x, y in ((0.0, 0.0), (number, 0.0), (0.0, number)))
        path = tmp_path / "cage.stl"
        path.write_text(f"solid a\nfacet normal 0 0 1\nouter loop\n{corners}\nendloop\nendfacet\n")
        with pytest.raises(trb.InputError, match=f"try '{right}'"):
            trb.Cage.from_step(path, rig, unit=unit)


@pytest.mark.parametrize("chamfer", [-1e-4, 4e-3])
def test_a_chamfer_that_no_roller_has(chamfer: float, rig: trb.Bearing, tmp_path: Path) -> None:
    with pytest.raises(trb.InputError, match="chamfer"):
        trb.Cage.from_step(tmp_path / "cage.step", rig, chamfer=chamfer)
