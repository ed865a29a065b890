"""The frame of a cage, its modes and their file."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest

import trbdyn as trb
from trbdyn.cage.beams import Frame
from trbdyn.cage.frame import CageFrame, cage_frame
from trbdyn.cage.modes import CageModes
from trbdyn.model.cage_body import Wall, cage_mass

BODY = trb.cases.cage_body_30310()
BEARING = trb.cases.rig_30310().replace(cage=trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=BODY))
SMALL = {"rim_elements": 2, "bar_elements": 2}


@pytest.fixture(scope="module")
def built() -> CageFrame:
    return cage_frame(BEARING)


@pytest.fixture(scope="module")
def modes() -> CageModes:
    return CageModes.of_frame(BEARING, 12, **SMALL)


def test_the_frame_weighs_what_the_cage_does(built: CageFrame) -> None:
    rigid = built.frame.rigid_motions()
    heavy = rigid.T @ built.frame.mass @ rigid
    assert heavy[0, 0] == pytest.approx(BEARING.cage.mass, rel=5e-3)
    assert heavy[5, 5] == pytest.approx(BEARING.cage.inertia_axial, rel=2e-2)
    assert heavy[1, 3] / heavy[0, 0] == pytest.approx(-BEARING.cage.offset, abs=2e-4)


def test_faces_follow_rigid_motions(built: CageFrame) -> None:
    """Every face of a cage that turns about its axis moves along t by its radius and turns about the axis."""
    turn = built.frame.rigid_motions()[:, 5]
    moved = built.at_faces @ turn
    angle = BEARING.geometry.roller_axis_angle
    for (_, face), six in zip(built.faces, moved, strict=True):
        middle = face.vertices.mean(axis=0)
        rho = 0.5 * BEARING.pitch_diameter + middle[0] * np.cos(angle) + middle[2] * np.sin(angle)
        assert six[1] == pytest.approx(rho, rel=1e-9)
        assert six[0] == pytest.approx(-middle[1] * np.cos(angle), abs=1e-12)
        assert six[3:] == pytest.approx([-np.sin(angle), 0.0, np.cos(angle)], abs=1e-12)


def test_the_frame_of_the_rig_against_the_solid_model(built: CageFrame) -> None:
    """First frequencies of the solid model of examples/cage_solid at an edge of 3.5 mm; docs/theory/cage.md tells the others."""
    found, _ = built.frame.natural(6)
    assert found == pytest.approx([1237.6, 1237.6, 2558.3, 2558.3, 3454.0, 3454.0], rel=0.06)


def test_frequencies_follow_the_material() -> None:
    plastic = BEARING.replace({"cage.material": trb.Material.polyamide().replace(poisson_ratio=0.3)})
    steel, soft = (CageModes.of_frame(one, 4, **SMALL) for one in (BEARING, plastic))
    ratio = np.sqrt(3.5e9 / 206e9 * 7810 / 1320)
    assert soft.frequency == pytest.approx(ratio * steel.frequency, rel=1e-6)
    assert (soft.damping_ratio[0], steel.damping_ratio[0]) == (0.03, 0.002)


@pytest.mark.parametrize("cracked", [False, True])
def test_a_bar_between_stiff_rims_is_clamped_at_both_ends(cracked: bool) -> None:
    """A force on the middle of a thin bar between heavy rims: F L/8 over the section modulus at its roots, by hand; if the bar is
    cracked through at its small end, F L/2 at the other one.
    """
    body = BODY.replace(
        thickness=1.5e-3,
        small_rim_width=15e-3,
        large_rim_width=15e-3,
        small_rim_thickness=7.5e-3,
        large_rim_thickness=7.5e-3,
    )
    bearing = BEARING.replace({"cage.body": body})
    built, wall = cage_frame(bearing, cracked_bars=[0] if cracked else []), Wall.of(bearing, body)
    frame = built.frame
    node = frame.beams[built.bars[0][2]].end
    first = frame.beams[built.bars[0][0]]
    along = frame.nodes[node] - frame.nodes[first.start] - first.from_start
    outward = np.cross(first.side, along / np.linalg.norm(along))
    load = np.zeros((6 * len(frame.nodes), 1))
    load[6 * node : 6 * node + 3, 0] = outward
    stress = built.stress(frame.static(load))[:, 0]
    clamped = (wall.large_edge - wall.small_edge) / 8.0 / (wall.bar_width(0.0) * wall.thickness**2 / 6.0)
    names = dict(zip(built.corners, stress, strict=True))
    for end, share in (("small", 0.0 if cracked else 1.0), ("large", 4.0 if cracked else 1.0)):
        for side in ("pocket 0, leading", "pocket 1, trailing"):
            # pushed outward, its roots bend the other way: pressed outside, pulled inside
            assert names[f"{side} bar, {end} end, outer"] == pytest.approx(
                -share * clamped, rel=0.07, abs=1e-3 * clamped
            )
            assert names[f"{side} bar, {end} end, inner"] == pytest.approx(
                share * clamped, rel=0.07, abs=1e-3 * clamped
            )
    assert np.abs(stress[8:]).max() < 0.4 * clamped


def test_unit_loads_of_faces_act_at_the_faces(built: CageFrame) -> None:
    """Work of a unit wrench on a face is the motion of the face; static displacements obey the frame's stiffness."""
    loads = built.loads_of_faces()
    motion = np.random.default_rng(5).standard_normal(loads.shape[0])
    assert loads.T @ motion == pytest.approx((built.at_faces @ motion).ravel(), rel=1e-12)
    pair = loads[:, 1:2] - loads[:, 6 * 4 * 6 + 1 : 6 * 4 * 6 + 2]
    moved = built.frame.static(pair)
    rigid = built.frame.rigid_motions()
    heavy = built.frame.mass @ rigid
    balanced = pair - heavy @ np.linalg.solve(rigid.T @ heavy, rigid.T @ pair)
    assert np.abs(built.frame.stiffness @ moved - balanced).max() < 1e-6 * np.abs(pair).max()
    assert np.abs(heavy.T @ moved).max() < 1e-9 * np.abs(heavy).sum() * np.abs(moved).max()


def test_rotation_widens_the_frame_as_rims_that_carry_bars(built: CageFrame) -> None:
    """Centrifugal load on the frame's masses against the formula that growth uses: mass over that of the rims."""
    frame: Frame = built.frame
    speed = 500.0
    across = np.zeros((len(frame.nodes), 6))
    across[:, :2] = frame.nodes[:, :2]
    loads = speed**2 * frame.mass @ across.reshape(-1, 1)
    moved = frame.static(loads)[:, 0].reshape(-1, 6)[:, :2]
    radius = np.linalg.norm(frame.nodes[:, :2], axis=1)
    strain = np.mean(np.sum(moved * frame.nodes[:, :2], axis=1) / radius**2)
    found = cage_mass(Wall.of(BEARING, BODY), 7810.0)
    formula = found.mass / found.rims * 7810.0 * (speed * radius.mean()) ** 2 / 206e9
    assert strain == pytest.approx(formula, rel=0.3)


def test_modes_are_orthogonal_to_rigid_motions_and_scaled(modes: CageModes) -> None:
    assert np.linalg.norm(modes.shape[:, :, :3], axis=2).max(axis=1) == pytest.approx(np.ones(12), rel=1e-9)
    assert np.all((modes.modal_mass > 0.005) & (modes.modal_mass < 1.0))
    assert modes.stress.shape == (12, 12 * 8)
    finer = CageModes.of_frame(BEARING, 4)
    assert modes.frequency[:4] == pytest.approx(finer.frequency, rel=0.03)


def test_the_file_keeps_every_number(modes: CageModes, tmp_path: Path) -> None:
    path = modes.save(tmp_path / "modes.h5")
    again = CageModes.load(path)
    for name in ("frequency", "damping_ratio", "modal_mass", "shape", "point_place", "stress"):
        assert np.array_equal(getattr(again, name), getattr(modes, name)), name
    assert (again.face_pocket, again.face_name, again.point_name) == (
        modes.face_pocket,
        modes.face_name,
        modes.point_name,
    )
    assert again.source == modes.source


@pytest.mark.parametrize(
    ("name", "change", "match"),
    [
        ("frequency", lambda f: f[::-1], "frequency = .* must be > 0 and rising"),
        ("modal_mass", lambda m: -m, "modal_mass = .* must be > 0"),
        ("shape", lambda s: s[:, :, :5], r"shape = 'shape \(12, 48, 5\)' : must have the shape \(12, 48, 6\)"),
        ("stress", lambda s: s * np.nan, "stress = 'not finite'"),
        ("damping_ratio", lambda d: d + 1.0, "damping_ratio = "),
    ],
)
def test_wrong_files_are_refused(modes: CageModes, tmp_path: Path, name: str, change: object, match: str) -> None:
    path = modes.save(tmp_path / "modes.h5")
    with h5py.File(path, "r+") as file:
        values = file[name][()]
        del file[name]
        file.create_dataset(name, data=change(values))  # type: ignore[operator]
    with pytest.raises(trb.FileError, match=match):
        CageModes.load(path)


def test_other_files_are_refused(modes: CageModes, tmp_path: Path) -> None:
    path = tmp_path / "other.h5"
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "something"
    with pytest.raises(trb.FileError, match="is no file of cage modes"):
        CageModes.load(path)
    with pytest.raises(trb.FileError, match="cannot be read"):
        CageModes.load(tmp_path / "none.h5")
    good = modes.save(tmp_path / "modes.h5")
    with h5py.File(good, "r+") as file:
        del file["stress"]
    with pytest.raises(trb.FileError, match="lacks stress"):
        CageModes.load(good)


def test_a_frame_asks_for_what_it_needs() -> None:
    with pytest.raises(trb.InputError, match=r"cage\.body = None : must be given"):
        cage_frame(trb.cases.rig_30310())
    with pytest.raises(trb.InputError, match="rim_elements = 3 : must be even"):
        cage_frame(BEARING, rim_elements=3)
    bare = BEARING.replace({"cage.material": trb.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=8000.0)})
    with pytest.raises(trb.InputError, match="damping_ratio = None"):
        CageModes.of_frame(bare)
