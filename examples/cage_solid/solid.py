"""Natural modes of the 30310 cage from an independent solid model, beside those of the package.

    python examples/cage_solid/solid.py            # frequencies side by side; solid_modes.h5, which trbdyn's CageModes.load reads
    python examples/cage_solid/solid.py --size 2   # finer: edges of the tetrahedra in mm

Gmsh (PyPI: gmsh) makes the body by turning the wall about the axis and cutting the windows with their rounded corners, and
meshes it with quadratic tetrahedra; CalculiX (Debian: calculix-ccx) finds the modes of the free body. Nothing of trbdyn's
finite elements is in it but the cage's dimensions. What is done with the modes is what a script for any other program has to do.
"""

from __future__ import annotations

import argparse
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import gmsh
import numpy as np

import trbdyn as trb
from trbdyn.extras.elastic.cage_solid import cage_solid
from trbdyn.extras.elastic.modes import CageModes
from trbdyn.model.cage_body import Wall, cage_mass
from trbdyn.model.pocket import pocket_axes

RIGID = 6
NEAR_FACE = 1e-4
"""Nodes so near to a face's plane belong to it (m)."""


def window(wall: Wall, bearing: trb.Bearing, corner: float) -> int:
    """The body that cuts the window of pocket 0 (mm): six planes, the four edges through the wall rounded."""
    face, occ = bearing.pocket.face("leading_bar"), gmsh.model.occ
    axes = pocket_axes(bearing, 0)
    n_low, n_high = wall.height - wall.thickness, wall.height + wall.thickness

    def corner_at(a: float, n: float, side: float) -> int:
        normal, origin = face.normal, np.array(face.origin)
        t = side * (normal @ origin - normal[0] * n - normal[2] * a) / normal[1]
        place = np.array([wall.radius, 0.0, 0.0]) + np.array([n, t, a]) @ axes
        return occ.addPoint(*(1e3 * place))

    low, high = wall.small_edge, wall.large_edge
    points = [
        [corner_at(a, n, side) for a, side in ((low, -1), (low, 1), (high, 1), (high, -1))] for n in (n_low, n_high)
    ]
    rings = [[occ.addLine(ring[k], ring[(k + 1) % 4]) for k in range(4)] for ring in points]
    through = [occ.addLine(points[0][k], points[1][k]) for k in range(4)]
    sides = [[rings[0][k], through[(k + 1) % 4], rings[1][k], through[k]] for k in range(4)]
    surfaces = [occ.addPlaneSurface([occ.addCurveLoop(loop)]) for loop in (*rings, *sides)]
    body = occ.addVolume([occ.addSurfaceLoop(surfaces)])
    occ.synchronize()
    if corner > 0.0:
        ((_, body),) = occ.fillet([body], through, [1e3 * corner])
    return body


def mesh(bearing: trb.Bearing, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (m), shape (N, 3), and quadratic tetrahedra in CalculiX's order, shape (E, 10), of the cage."""
    body = bearing.cage.body
    wall = Wall.of(bearing, body)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    parts = []
    for low, high, thickness in (
        (wall.small_edge - wall.small_width, wall.small_edge, wall.small_thickness),
        (wall.small_edge, wall.large_edge, wall.thickness),
        (wall.large_edge, wall.large_edge + wall.large_width, wall.large_thickness),
    ):
        points = []
        for a, side in ((low, -0.5), (low, 0.5), (high, 0.5), (high, -0.5)):
            rho, z = wall.place(np.array(a), np.array(wall.height + side * thickness))
            points.append(occ.addPoint(1e3 * float(rho), 0.0, 1e3 * float(z)))
        loop = occ.addCurveLoop([occ.addLine(points[k], points[(k + 1) % 4]) for k in range(4)])
        turned = occ.revolve([(2, occ.addPlaneSurface([loop]))], 0, 0, 0, 0, 0, 1, 2.0 * math.pi)
        parts += [entity for entity in turned if entity[0] == 3]
    whole, _ = occ.fuse(parts[:1], parts[1:])
    first = window(wall, bearing, wall.corner_radius)
    cutters = [(3, first)]
    for pocket in range(1, wall.n_pockets):
        copy = occ.copy([(3, first)])
        occ.rotate(copy, 0, 0, 0, 0, 0, 1, 2.0 * math.pi * pocket / wall.n_pockets)
        cutters += copy
    occ.cut(whole, cutters)
    occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.5 * size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.HighOrderOptimize", 1)
    gmsh.model.mesh.generate(3)
    tags, places, _ = gmsh.model.mesh.getNodes()
    _, connected = gmsh.model.mesh.getElementsByType(11)
    gmsh.finalize()
    order = np.zeros(int(tags.max()) + 1, dtype=int)
    used = np.unique(connected)
    order[used.astype(int)] = np.arange(len(used))
    where = {int(tag): k for k, tag in enumerate(tags)}
    nodes = 1e-3 * places.reshape(-1, 3)[[where[int(tag)] for tag in used]]
    tets = order[connected.astype(int)].reshape(-1, 10)[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]  # gmsh swaps the last two
    return nodes, tets


def solve(nodes: np.ndarray, tets: np.ndarray, material: trb.Material, count: int, folder: Path) -> np.ndarray:
    """Modes of the free body by CalculiX: squares of angular frequencies (1/s2); the shapes stay in the folder's ``cage.frd``."""
    with (folder / "cage.inp").open("w") as file:
        file.write("*NODE, NSET=ALL\n")
        np.savetxt(
            file, np.column_stack([np.arange(1, len(nodes) + 1), nodes]), fmt=["%d", *["%.12e"] * 3], delimiter=","
        )
        file.write("*ELEMENT, TYPE=C3D10, ELSET=CAGE\n")
        np.savetxt(file, np.column_stack([np.arange(1, len(tets) + 1), tets + 1]), fmt="%d", delimiter=",")
        file.write(
            f"*MATERIAL, NAME=M\n*ELASTIC\n{material.youngs_modulus:g},{material.poisson_ratio:g}\n*DENSITY\n"
            f"{material.density:g}\n*SOLID SECTION, ELSET=CAGE, MATERIAL=M\n*STEP\n*FREQUENCY, SOLVER=ARPACK\n"
            f"{count + RIGID}\n*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n"
        )
    run = subprocess.run(["ccx", "-i", "cage"], cwd=folder, capture_output=True, text=True, check=False)
    text = (folder / "cage.dat").read_text() if (folder / "cage.dat").exists() else ""
    rows = []
    for line in text.split("P A R T I C I P A T I O N")[0].splitlines():
        parts = line.split()
        if len(parts) == 5 and parts[0].isdigit():
            rows.append(float(parts[1]))
    if len(rows) < count + RIGID:
        raise SystemExit(f"CalculiX found {len(rows)} of {count + RIGID} modes:\n{run.stdout[-2000:]}")
    return np.array(rows[: count + RIGID])


def results(path: Path, count: int, n_nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Displacements, shape (M, N, 3), and stresses xx, yy, zz, xy, yz, zx, shape (M, N, 6), of the modes in a file of
    CalculiX.
    """
    shapes: list[np.ndarray] = []
    stresses: list[np.ndarray] = []
    into: np.ndarray | None = None
    with path.open() as file:
        for line in file:
            if line.startswith(" -4"):
                kind = line.split()[1]
                into = np.zeros((n_nodes, 3 if kind == "DISP" else 6)) if kind in ("DISP", "STRESS") else None
                if into is not None:
                    (shapes if kind == "DISP" else stresses).append(into)
            elif line.startswith(" -3"):
                into = None
            elif line.startswith(" -1") and into is not None:
                width = into.shape[1]
                into[int(line[3:13]) - 1] = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(width)]
    return np.array(shapes[RIGID : RIGID + count]), np.array(stresses[RIGID : RIGID + count])


def lumped_mass(nodes: np.ndarray, tets: np.ndarray, density: float) -> np.ndarray:
    """Diagonal of the consistent mass, scaled to each element's mass (Hinton, Rock and Zienkiewicz 1976), shape (N,) (kg)."""
    corners = nodes[tets[:, :4]]
    edges = corners[:, 1:] - corners[:, :1]
    volume = np.abs(np.linalg.det(edges)) / 6.0
    share = np.array([6.0 / 420.0] * 4 + [32.0 / 420.0] * 6)  # diagonal of a straight one: corners, middles of edges
    mass = np.zeros(len(nodes))
    np.add.at(mass, tets, density * volume[:, None] * share / share.sum())
    return mass


def modes_of(
    bearing: trb.Bearing,
    nodes: np.ndarray,
    tets: np.ndarray,
    squares: np.ndarray,
    shapes: np.ndarray,
    stresses: np.ndarray,
) -> CageModes:
    """What trbdyn needs of the modes: motion of the faces by least squares over their nodes, stress at the corners."""
    built, radius = cage_solid(bearing), 0.5 * bearing.pitch_diameter
    weights = lumped_mass(nodes, tets, float(bearing.cage_material.density or 0.0))
    modal = np.einsum("n,mnk,mnk->m", weights, shapes, shapes)
    motions = np.zeros((len(shapes), len(built.faces), 6))
    for number, (pocket, face) in enumerate(built.faces):
        axes = pocket_axes(bearing, pocket)
        angle = 2.0 * math.pi * pocket / bearing.n_rollers
        local = (nodes - radius * np.array([math.cos(angle), math.sin(angle), 0.0])) @ axes.T
        middle = face.vertices.mean(axis=0)
        low, high = face.vertices.min(axis=0) - 3e-4, face.vertices.max(axis=0) + 3e-4
        on = np.abs((local - np.array(face.origin)) @ face.normal) < NEAR_FACE
        on &= np.all((local > low) & (local < high), axis=1)
        if on.sum() < 6:
            raise SystemExit(f"only {on.sum()} nodes on {face.name} of pocket {pocket}: take a smaller --size")
        arms = local[on] - middle
        system = np.zeros((3 * len(arms), 6))
        for row, arm in enumerate(arms):
            system[3 * row : 3 * row + 3, :3] = np.eye(3)
            system[3 * row : 3 * row + 3, 3:] = [[0, arm[2], -arm[1]], [-arm[2], 0, arm[0]], [arm[1], -arm[0], 0]]
        moved = (shapes[:, on] @ axes.T).reshape(len(shapes), -1)
        motions[:, number] = np.linalg.lstsq(system, moved.T, rcond=None)[0].T
    at = [int(np.argmin(np.linalg.norm(nodes - place, axis=1))) for place in built.corner_places]
    x, y, z = built.directions.T
    tensor = stresses[:, at]
    direction = np.stack([x * x, y * y, z * z, 2 * x * y, 2 * y * z, 2 * z * x])
    along = np.einsum("mpc,cp->mp", tensor, direction)
    largest = np.linalg.norm(motions[:, :, :3], axis=2).max(axis=1)
    return CageModes(
        frequency=np.sqrt(squares) / (2.0 * math.pi),
        damping_ratio=np.full(len(squares), float(bearing.cage_material.damping_ratio or 0.0)),
        modal_mass=modal / largest**2,
        face_pocket=tuple(pocket for pocket, _ in built.faces),
        face_name=tuple(face.name for _, face in built.faces),
        shape=motions / largest[:, None, None],
        point_name=built.corners,
        point_place=nodes[at],
        stress=along / largest[:, None],
        source=f"CalculiX, {len(tets)} quadratic tetrahedra",
    )


def main() -> None:
    """Solve, print both lists of frequencies, write the file."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--size", type=float, default=2.5, help="edges of the tetrahedra (mm)")
    options.add_argument("--modes", type=int, default=20)
    options.add_argument("--material", default="steel", help="a maker of trb.Material")
    options.add_argument("--output", default="solid_modes.h5")
    options.add_argument("--overwrite", action="store_true", help="replace the file if it is there")
    given = options.parse_args()
    if shutil.which("ccx") is None:
        sys.exit("CalculiX is not installed: apt-get install calculix-ccx")
    rig = trb.cases.rig_30310()
    cage = trb.Cage(
        play_radial=rig.cage.play_radial,
        play_circumferential=rig.cage.play_circumferential,
        body=trb.cases.cage_body_30310(),
        material=getattr(trb.Material, given.material)(),
    )
    bearing = rig.replace(cage=cage)
    nodes, tets = mesh(bearing, given.size)
    weight = lumped_mass(nodes, tets, bearing.cage_material.density).sum()
    wall_mass = cage_mass(Wall.of(bearing, cage.body), bearing.cage_material.density).mass
    print(f"{len(nodes)} nodes, {len(tets)} tetrahedra")
    print(
        f"mass of the solid {1e3 * weight:.2f} g, of the quadrature, without rounded corners, {1e3 * wall_mass:.2f} g"
    )
    with tempfile.TemporaryDirectory() as folder:
        squares = solve(nodes, tets, bearing.cage_material, given.modes, Path(folder))
        shapes, stresses = results(Path(folder) / "cage.frd", given.modes, len(nodes))
    solid = modes_of(bearing, nodes, tets, squares[RIGID:], shapes, stresses)
    own = CageModes.of_body(bearing, 2 * given.modes)
    both = np.einsum("mfi,nfi->mn", solid.shape[:, :, :3], own.shape[:, :, :3])
    sizes = np.einsum("mfi,mfi->m", solid.shape[:, :, :3], solid.shape[:, :, :3])
    other = np.einsum("mfi,mfi->m", own.shape[:, :, :3], own.shape[:, :, :3])
    alike = both**2 / np.outer(sizes, other)
    print("mode   solid Hz   trbdyn Hz   difference   likeness of the shapes (MAC, over the modes of one frequency)")
    one = np.abs(own.frequency[:, None] / own.frequency[None, :] - 1.0) < 1e-4
    for k in range(given.modes):
        likeness = one @ alike[k]
        j = int(np.argmax(likeness))
        ratio = own.frequency[j] / solid.frequency[k] - 1.0
        print(
            f"{k + 1:4} {solid.frequency[k]:10.1f} {own.frequency[j]:10.1f} {100 * ratio:+10.1f} %   {likeness[j]:.3f}"
        )
    print(solid.save(given.output, overwrite=given.overwrite))


if __name__ == "__main__":
    main()
