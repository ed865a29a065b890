"""Drawings of every kind read back: a table of files, STL beside STEP, and curved faces over the tolerance of their facets."""

from __future__ import annotations

import math
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.cad.opened import gmsh_model, library
from trbdyn.extras.cad.read import DrawnCage, read_cage

try:
    library()
except ImportError as error:
    pytest.skip(str(error), allow_module_level=True)
BARS = {"leading_bar", "trailing_bar"}
WALLS = {"large_end_wall", "small_end_wall"}
PLANES = {"radial": 0.25e-3, "circumferential": 0.12e-3, "axial": 0.4e-3}
ROUND = {"circumferential": 0.15e-3, "axial": 0.4e-3}
RELIEF = {f"{bar}_{part}" for bar in BARS for part in (2, 3)}
TABLE: dict[str, tuple[str, dict[str, Any], set[str], dict[str, float], int]] = {
    # kind, options, surfaces that must be there, plays (m), kinds of pockets
    "sheet": ("sheet", {"corner": 0.0}, BARS | WALLS, PLANES, 1),
    "sheet with fillets": ("sheet", {"corner": 0.12e-3}, BARS | WALLS, PLANES, 1),
    "sheet, turned": ("sheet", {"corner": 0.0, "turn": (2.0, 0.4, -1.0)}, BARS | WALLS, PLANES, 1),
    "polyamide": ("polyamide", {}, BARS | WALLS, ROUND, 1),
    "polyamide, turned, shifted, in inches": (
        "polyamide",
        {"turn": (-0.3, 1.1, 2.5), "shift": (40.0, 5.0, -300.0), "inches": True},
        BARS | WALLS,
        ROUND,
        1,
    ),
    "machined with fillets": ("machined", {"corner": 0.3e-3}, BARS | WALLS, PLANES, 1),
    "relieved": ("relieved", {}, BARS | RELIEF | WALLS, PLANES, 1),
    "relieved, one pocket broken": ("relieved", {"broken": True}, BARS | WALLS, PLANES, 2),
}
TOLERANCE = 1e-5


@pytest.mark.slow
@pytest.mark.parametrize("name", TABLE)
def test_every_kind_is_recognised(name: str, drawings: ModuleType, rig: trb.Bearing, tmp_path: Path) -> None:
    kind, options, surfaces, plays, kinds = TABLE[name]
    found = read_cage(drawings.write(kind, rig, tmp_path / "cage.step", **options), rig, tolerance=TOLERANCE)
    assert found.n_pockets == 12
    assert len(set(found.kind_of)) == kinds
    whole = found.pockets[int(np.bincount(found.kind_of).argmax())]
    assert surfaces <= {face.name for face in whole.surfaces}
    for play, value in plays.items():
        assert found.plays[play] == pytest.approx(value, abs=2.5 * TOLERANCE), play
    for end in ("large_end", "small_end"):
        assert any(face.part == end for face in whole.faces)


def as_stl(step: Path, around: int) -> Path:
    """A drawing as triangles, so many around a circle."""
    path = step.with_suffix(".stl")
    with gmsh_model() as gmsh:
        gmsh.model.occ.importShapes(str(step))
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 8.0)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", around)
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(path))
    return path


@pytest.mark.slow
def test_stl_gives_the_cage_of_the_step_file(drawings: ModuleType, rig: trb.Bearing, tmp_path: Path) -> None:
    """Corners in an STL file have some seven digits: planes and plays are those of the polygons within two micrometres. Where the
    triangles of the rims are so coarse that pitches differ, the file is refused."""
    step = drawings.write("lands", rig, tmp_path / "cage.step")
    found = read_cage(as_stl(step, 48), rig, tolerance=TOLERANCE)
    assert found.n_pockets == 12
    for play, value in PLANES.items():
        assert found.plays[play] == pytest.approx(value, abs=2e-6), play
    for name in BARS:
        np.testing.assert_allclose(found.pockets[0].face(name).normal, rig.pocket.face(name).normal, atol=1e-4)
    with pytest.raises(trb.FileError, match="no pitch is found"):
        read_cage(as_stl(step, 24), rig, tolerance=TOLERANCE)


def test_a_wrong_stl_file_is_refused(rig: trb.Bearing, tmp_path: Path) -> None:
    path = tmp_path / "open.stl"
    path.write_text(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    )
    with pytest.raises(trb.FileError, match="not the closed surface of a solid"):
        trb.Cage.from_step(path, rig)


def forces(bearing: trb.Bearing) -> np.ndarray:
    """Forces on the rollers at random states in which many touch their bars."""
    sim = trb.Simulation(trb.cases.scene_30310(0.0, 4930.0, bearing=bearing, effects=trb.Effects.paper()))
    random, found = np.random.default_rng(7), []
    for _ in range(5):
        vector = np.zeros_like(sim.state.vector)
        state = sim.view(vector)
        state["cage_x"], state["cage_y"] = random.uniform(-1.6e-4, 1.6e-4, 2)
        state["roller_psi"] = random.uniform(-4e-3, 4e-3, bearing.n_rollers)
        state["roller_skew"] = random.uniform(-2e-3, 2e-3, bearing.n_rollers)
        found.append(sim.contacts(vector, 0.0)["cage_force"].ravel())
    return np.array(found)


@pytest.mark.slow
def test_curved_faces_converge_with_their_facets(drawings: ModuleType, rig: trb.Bearing, tmp_path: Path) -> None:
    """A facet leaves a curve by the square of its width: a quarter of the tolerance takes half of the width, and forces and plays
    differ from those of the curve by a quarter."""
    path = drawings.write("polyamide", rig, tmp_path / "cage.step")
    read: list[DrawnCage] = [read_cage(path, rig, tolerance=tolerance) for tolerance in (4e-5, 1e-5, 6e-7)]
    counts = [sum(face.part == "flank" for face in one.pockets[0].faces) for one in read]
    assert counts[1] == pytest.approx(2 * counts[0], rel=0.2)
    found = [forces(rig.replace({"cage.pocket": one.pockets[0]})) for one in read]
    off = [float(np.linalg.norm(one - found[-1])) for one in found[:-1]]
    assert 1.8 < math.log2(off[0] / off[1]) < 2.5
    for one in read:
        assert 0.0 <= 0.15e-3 - one.plays["circumferential"] < one.tolerance
