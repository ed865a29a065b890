"""The finite elements of a cage, its modes and their file."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from threadpoolctl import threadpool_limits

import trbdyn as trb
from trbdyn.extras.elastic.cage_solid import CageSolid, cage_solid
from trbdyn.extras.elastic.modes import CageModes
from trbdyn.extras.elastic.sections import forces_on, rim_sections
from trbdyn.extras.elastic.wall_mesh import wall_mesh
from trbdyn.model.cage_body import Wall, cage_mass
from trbdyn.model.pocket import pocket_axes

BODY = trb.cases.cage_body_30310()
BEARING = trb.cases.rig_30310().replace(cage=trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=BODY))


@pytest.fixture(scope="module")
def built() -> CageSolid:
    return cage_solid(BEARING)


@pytest.fixture(scope="module")
def modes() -> CageModes:
    return CageModes.of_body(BEARING, 12)


def test_the_elements_weigh_what_the_cage_does(built: CageSolid) -> None:
    """But for the rounded corners, which the cage's mass leaves out."""
    heavy = built.solid.rigid_motions.T @ built.solid.mass_of_motions
    assert heavy[0, 0] == pytest.approx(BEARING.cage.mass, rel=6e-3)
    assert heavy[5, 5] == pytest.approx(BEARING.cage.inertia_axial, rel=6e-3)
    assert heavy[1, 3] / heavy[0, 0] == pytest.approx(-BEARING.cage.offset, abs=2e-5)


def test_bits_do_not_depend_on_the_threads_of_the_machine(built: CageSolid) -> None:
    """A run that a checkpoint continues elsewhere has the same modes."""
    found = []
    for threads in (1, 2):
        with threadpool_limits(limits=threads, user_api="blas"):
            found.append(built.solid.natural(20))
    for one, other in zip(*found, strict=True):
        assert np.array_equal(one, other)


FORK = """
import os, sys, threading, time
from trbdyn.extras.elastic.solid import _one_thread

def other():
    with _one_thread():
        begun.set()
        time.sleep(0.2)

begun = threading.Event()
threading.Thread(target=other).start()
begun.wait()
child = os.fork()
with _one_thread():
    pass
sys.exit(os.waitpid(child, 0)[1] if child else 0)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_a_process_forked_while_modes_are_found_finds_some_too() -> None:
    assert subprocess.run([sys.executable, "-c", FORK], timeout=60.0, check=False).returncode == 0


def test_faces_follow_rigid_motions(built: CageSolid) -> None:
    """Every face of a cage that turns about its axis moves along t by its radius and turns about the axis."""
    turn = built.solid.rigid_motions[:, 5]
    moved = (built.at_faces @ turn).reshape(-1, 6)
    angle = BEARING.geometry.roller_axis_angle
    for (_, face), six in zip(built.faces, moved, strict=True):
        middle = face.vertices.mean(axis=0)
        rho = 0.5 * BEARING.pitch_diameter + middle[0] * np.cos(angle) + middle[2] * np.sin(angle)
        assert six[1] == pytest.approx(rho, rel=1e-9)
        assert six[0] == pytest.approx(-middle[1] * np.cos(angle), abs=1e-12)
        assert six[3:] == pytest.approx([-np.sin(angle), 0.0, np.cos(angle)], abs=1e-12)


def test_frequencies_follow_the_material() -> None:
    plastic = BEARING.replace({"cage.material": trb.Material.polyamide().replace(poisson_ratio=0.3)})
    steel, soft = (CageModes.of_body(one, 4) for one in (BEARING, plastic))
    ratio = np.sqrt(3.5e9 / 206e9 * 7810 / 1320)
    assert soft.frequency == pytest.approx(ratio * steel.frequency, rel=1e-6)
    assert (soft.damping_ratio[0], steel.damping_ratio[0]) == (0.03, 0.002)


def push_on_bar_0(built: CageSolid, wall: Wall, force: np.ndarray) -> np.ndarray:
    """Forces at the nodes, shape (3 N, 1), of a force (N) on the middle of bar 0."""
    angle, middle = np.pi / wall.n_pockets, 0.5 * (wall.small_edge + wall.large_edge)
    rho, z = wall.place(np.array(middle), np.array(wall.height))
    off = built.solid.nodes - np.array([rho * np.cos(angle), rho * np.sin(angle), z])
    sine, cosine = np.sin(wall.angle), np.cos(wall.angle)
    along = np.abs(off @ [sine * np.cos(angle), sine * np.sin(angle), cosine])
    near = np.flatnonzero((along < 1e-5) & (np.linalg.norm(off, axis=1) < wall.bar_width(middle)))
    load = np.zeros((built.solid.nodes.size, 1))
    for axis in range(3):
        load[3 * near + axis, 0] = force[axis] / len(near)
    return load


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
    built, wall = cage_solid(bearing, cracked_bars=[0] if cracked else []), Wall.of(bearing, body)
    direction = np.pi / wall.n_pockets
    upright = np.array(
        [np.cos(wall.angle) * np.cos(direction), np.cos(wall.angle) * np.sin(direction), -np.sin(wall.angle)]
    )
    load = push_on_bar_0(built, wall, upright)
    stress = (built.stress_of @ built.solid.static(load))[:, 0]
    clamped = (wall.large_edge - wall.small_edge) / 8.0 / (wall.bar_width(0.0) * wall.thickness**2 / 6.0)
    names = dict(zip(built.corners, stress, strict=True))
    bent = ("pocket 0, leading", "pocket 1, trailing")
    for end, share in (("small", 0.0 if cracked else 1.0), ("large", 4.0 if cracked else 1.0)):
        for side in bent:
            # pushed outward, its roots bend the other way: pressed outside, pulled inside
            assert names[f"{side} bar, {end} end, outer"] == pytest.approx(
                -share * clamped, rel=0.07, abs=1e-3 * clamped
            )
            assert names[f"{side} bar, {end} end, inner"] == pytest.approx(
                share * clamped, rel=0.07, abs=1e-3 * clamped
            )
    others = [size for name, size in names.items() if " end, " in name and not name.startswith(bent)]
    assert np.abs(others).max() < 0.4 * clamped


def sheet() -> tuple[Wall, CageSolid]:
    """A cage of thin sheet with slim rims."""
    body = trb.CageBody(thickness=2e-3, small_rim_width=4e-3, large_rim_width=4e-3, corner_radius=0.5e-3)
    bearing = BEARING.replace({"cage.body": body})
    return Wall.of(bearing, body), cage_solid(bearing)


def test_rims_hold_what_turns_with_them() -> None:
    """Tension of both rims beside each window of a cage that turns, by hand: mass times radius times speed squared / 2 pi."""
    wall, built = sheet()
    solid, speed = built.solid, 500.0
    across = solid.nodes * [1.0, 1.0, 0.0]
    pull = speed**2 * (solid.mass @ across.reshape(-1, 1))
    sections = list(rim_sections(wall, wall_mesh(wall)))
    forces = (forces_on(solid, wall_mesh(wall).rim, sections) @ solid.static(pull)).reshape(-1, 6)
    tension = np.array([one.sign for one in sections]) * forces[:, 0]
    both = tension.reshape(-1, 2, 2).sum(axis=1)  # pocket, side of the window
    radius = np.linalg.norm(across, axis=1)
    by_hand = np.sum(pull.reshape(-1, 3) * across / radius[:, None]) / (2.0 * np.pi)
    assert both == pytest.approx(np.full(both.shape, by_hand), rel=2e-3)


def test_rims_bend_as_a_ring_that_a_force_pushes_outward() -> None:
    """Bending of both rims beside each window by an outward force on a bar of a free cage: that of a ring whose inertia balances
    the force, M/(F R) = (1/2) sin t - (t sin t - 1 + cos t)/(2 pi) - 1/pi + cos(t)/(4 pi) at the angle t from the force (Roark,
    table 9.2: 0.239 at the force). The largest stress is there: outside pulled, inside pressed, beyond all roots of bars.
    """
    wall, built = sheet()
    direction = np.pi / wall.n_pockets
    load = push_on_bar_0(built, wall, np.array([np.cos(direction), np.sin(direction), 0.0]))
    moved = built.solid.static(load)
    sections = list(rim_sections(wall, wall_mesh(wall)))
    moments = (forces_on(built.solid, wall_mesh(wall).rim, sections) @ moved).reshape(-1, 6)[:, 4]
    bending = (np.array([one.sign for one in sections]) * moments).reshape(-1, 2, 2).sum(axis=1)
    places = np.array([one.centre for one in sections]).reshape(-1, 2, 2, 3)
    radius = np.linalg.norm(places[..., :2], axis=-1).mean()
    for angles, found in zip(np.arctan2(places[:, 0, :, 1], places[:, 0, :, 0]), bending, strict=True):
        for angle, one in zip(angles, found, strict=True):
            t = abs((angle - direction + np.pi) % (2.0 * np.pi) - np.pi)
            ring = (
                0.5 * np.sin(t)
                - (t * np.sin(t) - 1.0 + np.cos(t)) / (2.0 * np.pi)
                - 1.0 / np.pi
                + np.cos(t) / (4.0 * np.pi)
            )
            assert one / radius == pytest.approx(ring, abs=4e-3)
    stress = dict(zip(built.corners, (built.stress_of @ moved)[:, 0], strict=True))
    worst = max(stress, key=lambda name: abs(stress[name]))
    assert " rim at the " in worst
    assert worst.endswith("outer")
    assert stress[worst] > 0.0 > stress[worst.replace("outer", "inner")]
    assert abs(stress[worst]) > 2.0 * max(abs(size) for name, size in stress.items() if " end, " in name)


def test_unit_loads_of_faces_act_at_the_faces(built: CageSolid) -> None:
    """A unit push of a face acts along its normal at its middle: on the whole cage, force and moment are those by hand."""
    pushes, rigid = built.pushes(), built.solid.rigid_motions
    for at in (0, 2, 3, 17, 40):
        pocket, face = built.faces[at]
        axes, angle = pocket_axes(BEARING, pocket), 2.0 * np.pi * pocket / BEARING.n_rollers
        radius = 0.5 * BEARING.pitch_diameter * np.array([np.cos(angle), np.sin(angle), 0.0])
        force, place = -face.normal @ axes, radius + face.vertices.mean(axis=0) @ axes
        assert rigid.T @ pushes[:, at] == pytest.approx(np.concatenate([force, np.cross(place, force)]), abs=1e-9)


def test_rotation_widens_the_cage_as_rims_that_carry_bars(built: CageSolid) -> None:
    """Centrifugal load against the formula that growth uses: mass over that of the rims."""
    solid, speed = built.solid, 500.0
    across = solid.nodes * [1.0, 1.0, 0.0]
    moved = solid.static(speed**2 * (solid.mass @ across.reshape(-1, 1)))[:, 0].reshape(-1, 3)
    radius = np.linalg.norm(across, axis=1)
    strain = np.mean(np.sum(moved * across, axis=1) / radius**2)
    found = cage_mass(Wall.of(BEARING, BODY), 7810.0)
    formula = found.mass / found.rims * 7810.0 * (speed * radius.mean()) ** 2 / 206e9
    assert strain == pytest.approx(formula, rel=0.3)


def test_modes_are_orthogonal_to_rigid_motions_and_scaled(modes: CageModes) -> None:
    assert np.linalg.norm(modes.shape[:, :, :3], axis=2).max(axis=1) == pytest.approx(np.ones(12), rel=1e-9)
    assert np.all((modes.modal_mass > 0.005) & (modes.modal_mass < 1.0))
    assert modes.stress.shape == (12, 12 * 16)  # bars and rims


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
    with pytest.raises(trb.FileError, match="there is no such file"):
        CageModes.load(tmp_path / "none.h5")
    good = modes.save(tmp_path / "modes.h5")
    with h5py.File(good, "r+") as file:
        del file["stress"]
    with pytest.raises(trb.FileError, match="lacks stress"):
        CageModes.load(good)


def test_a_model_asks_for_what_it_needs() -> None:
    with pytest.raises(trb.InputError, match=r"cage\.body = None : must be given"):
        cage_solid(trb.cases.rig_30310())
    with pytest.raises(trb.InputError, match="fineness = 4 : must be a whole number, from 1 to 3"):
        cage_solid(BEARING, fineness=4)
    bare = BEARING.replace({"cage.material": trb.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=8000.0)})
    with pytest.raises(trb.InputError, match="damping_ratio = None"):
        CageModes.of_body(bare)
