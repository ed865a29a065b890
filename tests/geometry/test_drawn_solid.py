"""The finite-element model of a cage as drawn, and a run with it."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.cad.opened import library
from trbdyn.extras.elastic.drawn_solid import drawn_solid, straightened, stress_rows, stress_tensors
from trbdyn.extras.elastic.solid import EDGES, Elasticity, Solid
from trbdyn.extras.study.definition import Base

try:
    library()
except ImportError as error:
    pytest.skip(str(error), allow_module_level=True)
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cage of sheet without fillets, so that its mesh is small."""
    spec = importlib.util.spec_from_file_location("cage_drawings", ROOT / "examples/cage_drawings/drawings.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    path: Path = module.write(
        "sheet", trb.cases.rig_30310(), tmp_path_factory.mktemp("sheet") / "sheet.step", corner=0.0
    )
    return path


@pytest.fixture(scope="module")
def scene(drawing: Path) -> trb.Scene:
    """A case file with the drawing."""
    case = drawing.with_suffix(".toml")
    case.write_text(
        f'[bearing]\ncase = "30310"\n[bearing.cage]\ndrawing = {{file = "{drawing}", tolerance = 1e-5}}\nunbalance = 1e-6\n'
        "[bearing.cage.material]\nyoungs_modulus = 2.08e11\npoisson_ratio = 0.3\ndensity = 7850.0\ndamping_ratio = 0.01\n"
        "[scene]\nspeed_rpm = 3000\naxial_load = 4930.0\n[scene.elastic_cage]\nn_modes = 4\n"
    )
    read, _ = trb.load_case(case)
    assert isinstance(read, trb.Scene)
    return read


@pytest.fixture(scope="module")
def bearing(scene: trb.Scene) -> trb.Bearing:
    return scene.bearing


def one_block(bulge: float) -> Solid:
    """A block of six tetrahedra, one edge of which is bent."""
    nodes = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    corners = np.array([(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)])
    pairs = np.sort(corners[:, np.array(EDGES)].reshape(-1, 2), axis=1)
    edges, which = np.unique(pairs, axis=0, return_inverse=True)
    middles = nodes[edges].mean(axis=1)
    middles[0] += bulge * np.array([-1.0, -1.0, 0.0])
    elements = np.hstack([corners, len(nodes) + which.reshape(-1, 6)])
    return Solid.of(np.vstack([nodes, middles]), elements, Elasticity(2e11, 0.3, 7850.0))


def test_curved_tetrahedra_stretch_as_the_law_says() -> None:
    """Rigid motions leave no force; a linear displacement has the same stress everywhere, whatever the edges are."""
    solid = one_block(0.1)
    assert np.abs(solid.stiffness @ solid.rigid_motions).max() < 1e-6 * np.abs(solid.stiffness.data).max()
    assert np.trace(solid.rigid_motions[:, :3].T @ solid.mass_of_motions[:, :3]) > 3.0 * 7850.0
    slope = np.random.default_rng(1).standard_normal((3, 3)) * 1e-3
    moved = (solid.nodes @ slope.T).reshape(-1, 1)
    strain = 0.5 * (slope + slope.T)
    lame, shear = solid.made.lame
    expected = lame * np.trace(strain) * np.eye(3) + 2.0 * shear * strain
    vertices = np.arange(8)
    np.testing.assert_allclose(stress_tensors(solid, vertices, moved)[:, 0], np.tile(expected, (8, 1, 1)), rtol=1e-7)
    ways = np.linalg.qr(np.random.default_rng(2).standard_normal((3, 3)))[0][[0] * 8]
    found = np.asarray(stress_rows(solid, vertices, ways) @ moved)[:, 0]
    np.testing.assert_allclose(found, np.einsum("i,ij,j->", ways[0], expected, ways[0]), rtol=1e-7)


def test_edges_of_folded_elements_are_made_straight() -> None:
    solid = one_block(0.0)
    elements = solid.basis.element_dofs.T[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]
    bent = solid.nodes.copy()
    bent[elements[0, 4]] += 0.9 * (bent[elements[0, 2]] - bent[elements[0, 4]])
    with pytest.raises(trb.InputError, match="folded"):
        Solid.of(bent, elements, solid.made)
    np.testing.assert_allclose(straightened(bent, elements), solid.nodes, atol=1e-15)


def test_the_mesh_is_the_drawn_cage(bearing: trb.Bearing) -> None:
    """Mass, centre and moments of inertia are those of the drawing in the cage's frame; faces follow rigid motions."""
    built = drawn_solid(bearing)
    rigid = built.solid.rigid_motions
    inertia = rigid.T @ built.solid.mass_of_motions
    cage = bearing.cage
    np.testing.assert_allclose(np.diag(inertia)[:3], cage.mass, rtol=1e-3)
    assert inertia[5, 5] == pytest.approx(cage.inertia_axial, rel=2e-3)
    assert inertia[0, 4] / cage.mass == pytest.approx(cage.offset, abs=2e-5)
    moved = (built.at_faces @ rigid[:, 2]).reshape(-1, 6)  # along the axis
    np.testing.assert_allclose(np.linalg.norm(moved[:, :3], axis=1), 1.0, rtol=1e-6)
    assert len(built.corners) == len(set(built.corners)) == 8 * bearing.n_rollers
    pushes = built.pushes().reshape(-1, 3, len(built.faces))
    np.testing.assert_allclose(np.linalg.norm(pushes.sum(axis=0), axis=0), 1.0, rtol=1e-6)


def test_mass_is_that_of_the_body(bearing: trb.Bearing) -> None:
    """Volume, centre and moments of a window cage, beside the quadrature over its dimensions."""
    cage = bearing.cage
    assert cage.unbalance == 1e-6
    assert cage.pocket is not None
    assert cage.pocket.face("leading_bar").part == "flank"
    body = trb.CageBody(thickness=2e-3, small_rim_width=4e-3, large_rim_width=4e-3)
    plays = {"play_radial": 0.25e-3, "play_circumferential": 0.12e-3, "play_axial": 0.4e-3}
    other = bearing.replace(cage=trb.Cage(**plays, body=body, material=cage.material)).cage
    assert cage.mass == pytest.approx(other.mass, rel=1e-3)
    assert cage.inertia_axial == pytest.approx(other.inertia_axial, rel=1e-3)
    assert cage.inertia_transverse == pytest.approx(other.inertia_transverse, rel=1e-3)
    assert cage.play_circumferential == pytest.approx(
        0.12e-3, rel=1e-2
    )  # a thinner wall touches the end's sphere elsewhere


def test_a_case_with_an_elastic_drawn_cage_runs(scene: trb.Scene, drawing: Path, tmp_path: Path) -> None:
    result = trb.Simulation(scene).run(duration=2e-4, save_every=1e-5, output=tmp_path / "run.h5")
    assert result.success
    found = trb.load(tmp_path / "run.h5")
    assert found.scene.bearing.cage.drawing == scene.bearing.cage.drawing
    stress = found.cage_stress()
    assert stress.is_complete
    assert stress.mesh_difference is not None
    assert 0.0 < stress.mesh_difference[0] < 0.02
    assert "a mesh with edges 1.4 times as long" in repr(stress)
    with pytest.raises(trb.InputError, match="notch_factor"):
        found.cage_stress(notch_factor=2.0)
    with drawing.open("a") as file:
        file.write("\n")
    changed = scene.bearing.replace({"name": "another"})
    with pytest.raises(trb.InputError, match="which has changed since"):
        drawn_solid(changed)


def test_a_study_keeps_what_a_cage_was_read_from(bearing: trb.Bearing) -> None:
    """A bearing written as tables and read back is the same, with a drawing, without opening it, and without one."""
    for one in (bearing, trb.cases.rig_30310()):
        scene = trb.Scene(one, speed_rpm=3000, axial_load=4930.0)
        built, _ = Base.of(scene, trb.RunOptions()).build({"scene.speed_rpm": 2000})
        assert built == scene.replace(speed_rpm=2000)


def test_what_a_drawn_cage_cannot_do_is_refused(bearing: trb.Bearing, tmp_path: Path) -> None:
    with pytest.raises(trb.InputError, match="draw the crack"):
        trb.Scene(bearing, speed_rpm=3000, axial_load=1e3, elastic_cage=trb.ElasticCage(cracked_bars=(1,)))
    with pytest.raises(trb.InputError, match="together with a drawing"):
        bearing.cage.replace(body=trb.cases.cage_body_30310())
