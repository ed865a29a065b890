"""The package's finite-element model of a cage beside CalculiX: natural frequencies, forces and stress at the bars' roots.

    python benchmarks/cage_solid.py [--quick] [--json FILE]     # the package beside the stored results of CalculiX
    python benchmarks/cage_solid.py --solid                     # makes these again: needs Gmsh and CalculiX; --quick: one cage

Three cages of a 30310 and one of a 32216. Gmsh turns the wall, cuts the windows with rounded corners and meshes it with quadratic
tetrahedra; CalculiX finds modes and displacements (`examples/cage_solid/solid.py`). A roller pushes with 100 N against the middle
of the leading bar of pocket 0, and the free body is balanced by its rigid acceleration. Forces and moments at the roots are those
of equilibrium: the sum of the nodal forces that the elements of a bar have from the rim. Stress is nominal in both. Mesh,
elements, windows' ends (planes here, circles in the package), load and solver differ; dimensions and material are the same.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import common
import numpy as np

import trbdyn as trb
from trbdyn.extras.elastic.cage_solid import cage_solid
from trbdyn.model.cage_body import Wall
from trbdyn.model.pocket import every_face, pocket_axes

STORED = Path(__file__).parent / "data" / "cage_solid.json"
FORCE = 100.0
"""Push of the roller (N)."""
SPREAD = 1.5e-3
"""Half length of the bar over which it is spread in the solid (m)."""
N_MODES = 20
"""Frequencies that are kept."""
SIZE = 2.0
"""Edges of the tetrahedra (mm)."""
SHOWN = ("cage", "quantity", "calculix", "trbdyn", "difference")
COLUMNS = {
    "cage": "text: which cage",
    "quantity": "text: frequency of two modes (Hz), largest nominal stress at a root (MPa), stress over the largest one (1)",
    "calculix": "Hz, MPa, 1: of CalculiX",
    "trbdyn": "Hz, MPa, 1: of the package",
    "difference": "1: trbdyn over calculix, less 1; of a corner: difference over the largest stress of CalculiX",
}


def bearings() -> dict[str, trb.Bearing]:
    """Bearings whose cages are compared."""
    rig = trb.cases.rig_30310()
    plays = {"play_radial": rig.cage.play_radial, "play_circumferential": rig.cage.play_circumferential}
    body = trb.cases.cage_body_30310()
    bodies = {
        "30310": body,
        "30310, wall of 3 mm": trb.CageBody(thickness=3e-3, small_rim_width=4.8e-3, large_rim_width=4.8e-3),
        "30310, rims of 3.5 and 7 mm": trb.CageBody(thickness=4e-3, small_rim_width=3.5e-3, large_rim_width=7e-3),
    }
    found = {
        name: rig.replace(cage=trb.Cage(**plays, body=one, material=trb.Material.steel()))
        for name, one in bodies.items()
    }
    other = trb.cases.bearing_32216()
    plays = {"play_radial": other.cage.play_radial, "play_circumferential": other.cage.play_circumferential}
    wide = trb.CageBody(thickness=5e-3, small_rim_width=5e-3, large_rim_width=6e-3)
    found["32216"] = other.replace(cage=trb.Cage(**plays, body=wide, material=trb.Material.steel()))
    return found


def face_of(bearing: trb.Bearing) -> int:
    """Number of the face that is pushed."""
    faces = enumerate(every_face(bearing))
    return next(at for at, (pocket, face) in faces if pocket == 0 and face.name == "leading_bar")


def at_roots(bearing: trb.Bearing) -> tuple[np.ndarray, np.ndarray]:
    """Centres of the bars' roots, shape (Z, 2, 3) (m), and axes along, across and through the bars, shape (Z, 3, 3)."""
    wall = Wall.of(bearing, bearing.cage.body)
    count = wall.n_pockets
    centres, axes = np.zeros((count, 2, 3)), np.zeros((count, 3, 3))
    for k in range(count):
        angle = (2 * k + 1) * math.pi / count
        c, s = math.cos(angle), math.sin(angle)
        for end, edge in enumerate((wall.small_edge, wall.large_edge)):
            rho, z = wall.place(np.array(edge), np.array(wall.height))
            centres[k, end] = float(rho) * c, float(rho) * s, float(z)
        along = np.array([math.sin(wall.angle) * c, math.sin(wall.angle) * s, math.cos(wall.angle)])
        across = np.array([-s, c, 0.0])
        axes[k] = along, across, np.cross(along, across)
    return centres, axes


def nominal(bearing: trb.Bearing, forces: np.ndarray) -> np.ndarray:
    """Stress at the corners, in the order of the package, from forces and moments at the roots, shape (Z, 2, 6), on the bar."""
    wall = Wall.of(bearing, bearing.cage.body)
    found = []
    for bar in forces:
        for end, sign in ((0, -1.0), (1, 1.0)):
            width = wall.bar_width((wall.small_edge, wall.large_edge)[end])
            thickness = wall.thickness
            pull, about_across, about_through = sign * bar[end][[0, 4, 5]]
            for across in (-0.5, 0.5):
                for through in (-0.5, 0.5):
                    found.append(
                        pull / (width * thickness)
                        + about_across * through * thickness / (width * thickness**3 / 12.0)
                        - about_through * across * width / (thickness * width**3 / 12.0)
                    )
    return np.array(found)


def elements(bearing: trb.Bearing) -> dict[str, Any]:
    """Frequencies (Hz), forces and moments on the bars at their roots (N, N m), stress at the corners (Pa) of the package."""
    built = cage_solid(bearing)
    frequency, _ = built.solid.natural(N_MODES)
    moved = built.solid.static(FORCE * built.pushes()[:, [face_of(bearing)]])
    roots = (built.at_roots @ moved).reshape(-1, 2, 6)
    at_bars, at_rims = np.split((built.stress_of @ moved)[:, 0], [8 * bearing.n_rollers])
    return {"frequency": frequency, "root": roots, "stress": at_bars, "rims": at_rims}


def solid(bearing: trb.Bearing, size: float) -> dict[str, Any]:
    """The same of the solid, with edges of `size` (mm)."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "examples" / "cage_solid"))
    import solid as model  # Gmsh is needed for this alone

    nodes, tets = model.mesh(bearing, size)
    material = bearing.cage_material
    mass = model.lumped_mass(nodes, tets, material.density)
    with tempfile.TemporaryDirectory() as folder:
        squares = model.solve(nodes, tets, material, N_MODES, Path(folder))
        pushed = _loads(bearing, nodes, mass)
        moved = _pushed(Path(folder), nodes, pushed, model)
    forces = _root_forces(bearing, nodes, tets, moved, material)
    return {
        "tetrahedra": len(tets),
        "frequency": np.sqrt(squares[model.RIGID :]) / (2.0 * math.pi),
        "root": forces,
        "stress": nominal(bearing, forces),
    }


def _loads(bearing: trb.Bearing, nodes: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Forces at the nodes: the push on the middle of the face, less what accelerates the free body."""
    face = every_face(bearing)[face_of(bearing)][1]
    axes = pocket_axes(bearing, 0)
    local = (nodes - np.array([0.5 * bearing.pitch_diameter, 0.0, 0.0])) @ axes.T
    middle = face.vertices.mean(axis=0)
    on = np.abs((local - np.array(face.origin)) @ face.normal) < 1e-5
    on &= np.abs(local[:, 2] - middle[2]) < SPREAD
    # the least weights whose sum is one and whose centre is the face's middle
    system = np.vstack([np.ones(int(on.sum())), (local[on] - middle).T])
    weights = np.linalg.lstsq(system, np.array([1.0, 0.0, 0.0, 0.0]), rcond=1e-9)[0]
    loads = np.zeros_like(nodes)
    loads[on] = FORCE * weights[:, None] * (-face.normal @ axes)
    centre = mass @ nodes / mass.sum()
    arms = nodes - centre
    inertia = np.einsum(
        "n,nij->ij", mass, np.einsum("nk,nk,ij->nij", arms, arms, np.eye(3)) - np.einsum("ni,nj->nij", arms, arms)
    )
    turned = np.linalg.solve(inertia, np.cross(arms, loads).sum(axis=0))
    return loads - mass[:, None] * (loads.sum(axis=0) / mass.sum() + np.cross(turned, arms))


def _pushed(folder: Path, nodes: np.ndarray, loads: np.ndarray, model: Any) -> np.ndarray:
    """Displacements under balanced loads, shape (N, 3); three nodes hold the six motions of the rigid body."""
    text = (folder / "cage.inp").read_text().split("*STEP")[0]
    held = _held(nodes)
    with (folder / "push.inp").open("w") as file:
        file.write(text + "*BOUNDARY\n" + "".join(f"{node + 1},{axis + 1},{axis + 1},0.\n" for node, axis in held))
        file.write("*STEP\n*STATIC\n*CLOAD\n")
        file.writelines(f"{n + 1},{k + 1},{loads[n, k]:.12e}\n" for n in range(len(nodes)) for k in range(3))
        file.write("*NODE FILE\nU\n*END STEP\n")
    run = subprocess.run(["ccx", "-i", "push"], cwd=folder, capture_output=True, text=True, check=False)
    path, found = folder / "push.frd", np.zeros_like(nodes)
    if run.returncode or not path.exists():
        raise SystemExit(f"CalculiX: {run.stdout[-2000:]}")
    inside = False
    for line in path.open():
        if line.startswith(" -4"):
            inside = line.split()[1] == "DISP"
        elif line.startswith(" -1") and inside:
            found[int(line[3:13]) - 1] = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(3)]
    return found


def _held(nodes: np.ndarray) -> list[tuple[int, int]]:
    """Nodes and directions that hold a rigid body without forces: three far apart."""
    first = int(np.argmax(nodes[:, 0]))
    second = int(np.argmin(nodes[:, 0]))
    third = int(np.argmax(nodes[:, 1]))
    return [(first, 0), (first, 1), (first, 2), (second, 1), (second, 2), (third, 2)]


_GAUSS = np.array([0.5854101966249685, 0.1381966011250105])


def _root_forces(
    bearing: trb.Bearing, nodes: np.ndarray, tets: np.ndarray, moved: np.ndarray, material: Any
) -> np.ndarray:
    """Forces and moments on each bar at its roots, in its axes, shape (Z, 2, 6)."""
    wall = Wall.of(bearing, bearing.cage.body)
    young, nu = material.youngs_modulus, material.poisson_ratio
    lame, shear = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
    centres, axes = at_roots(bearing)
    middle = nodes[tets[:, :4]].mean(axis=1)
    rho, z = np.hypot(middle[:, 0], middle[:, 1]), middle[:, 2]
    along = (rho - wall.radius) * math.sin(wall.angle) + z * math.cos(wall.angle)
    inside = (along > wall.small_edge) & (along < wall.large_edge)
    bar_of = (
        np.round(np.arctan2(middle[:, 1], middle[:, 0]) * wall.n_pockets / (2 * math.pi) - 0.5).astype(int)
        % wall.n_pockets
    )
    found = np.zeros((wall.n_pockets, 2, 6))
    pairs = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
    for k in range(wall.n_pockets):
        elements = tets[inside & (bar_of == k)]
        others = np.zeros(len(nodes), dtype=bool)
        others[tets[~(inside & (bar_of == k))].ravel()] = True
        forces = np.zeros_like(nodes)
        for corner in range(4):
            bary = np.full(4, _GAUSS[1])
            bary[corner] = _GAUSS[0]
            slope = np.zeros((10, 4))  # of the shape functions, over the barycentric coordinates
            slope[range(4), range(4)] = 4 * bary - 1
            for n, (i, j) in enumerate(pairs):
                slope[4 + n, i], slope[4 + n, j] = 4 * bary[j], 4 * bary[i]
            local = slope[:, 1:] - slope[:, :1]
            jacobian = np.einsum("enk,nl->ekl", nodes[elements], local)
            gradient = np.einsum("nl,elk->enk", local, np.linalg.inv(jacobian))
            strain = np.einsum("enk,enl->ekl", moved[elements], gradient)
            strain = 0.5 * (strain + strain.transpose(0, 2, 1))
            stress = 2 * shear * strain + lame * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3)
            volume = np.abs(np.linalg.det(jacobian)) / 24.0
            np.add.at(forces, elements, np.einsum("enl,ekl,e->enk", gradient, stress, volume))
        cut = np.flatnonzero(others & np.any(forces != 0.0, axis=1))
        where = (nodes[cut] - centres[k].mean(axis=0)) @ axes[k][0]
        for end, part in enumerate((cut[where < 0.0], cut[where >= 0.0])):
            push = forces[part]  # what the bar needs from outside at these nodes
            turn = np.cross(nodes[part] - centres[k, end], push)
            found[k, end] = np.concatenate([axes[k] @ push.sum(axis=0), axes[k] @ turn.sum(axis=0)])
    return found


def rows_of(name: str, bearing: trb.Bearing, stored: dict[str, Any]) -> list[dict[str, Any]]:
    """Rows of a cage: frequencies of each pair of modes, the largest stress, and the corner with the largest difference."""
    found, rows = elements(bearing), []
    for k in range(0, N_MODES, 2):
        first, second = float(stored["frequency"][k]), float(found["frequency"][k])
        rows.append((f"modes {k + 1}, {k + 2} (Hz)", first, second, second / first - 1.0))
    stress = np.array(stored["stress"])
    largest, own = np.abs(stress).max(), np.abs(found["stress"]).max()
    rows.append(("largest stress (MPa)", 1e-6 * largest, 1e-6 * own, own / largest - 1.0))
    worst = int(np.argmax(np.abs(found["stress"] - stress)))
    first, second = stress[worst] / largest, found["stress"][worst] / largest
    rows.append(("corner that differs most (1)", first, second, second - first))
    spread = float(np.sqrt(np.mean((found["stress"] - stress) ** 2)) / largest)
    rows.append(("all corners, in the mean square (1)", 0.0, spread, spread))
    rows.append(("largest stress in a rim (MPa)", np.nan, 1e-6 * np.abs(found["rims"]).max(), np.nan))
    return [dict(zip(SHOWN, (name, *row), strict=True)) for row in rows]


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    parser = common.parser(__doc__)
    parser.add_argument("--solid", action="store_true", help="make the results of CalculiX again and store them")
    options = parser.parse_args(arguments)
    report = common.Report("cage_solid", options, COLUMNS, inputs={"force": FORCE, "size_mm": SIZE})
    cages = dict(list(bearings().items())[: 1 if options.quick else None])
    stored = json.loads(STORED.read_text(encoding="utf-8")) if STORED.exists() else {}
    for name, bearing in cages.items():
        if options.solid:
            stored[name] = solid(bearing, SIZE)
            save(stored)
        for row in rows_of(name, bearing, stored[name]):
            report.add(**row)
    print(common.table(report.results, SHOWN))
    report.finish()
    return report


def save(found: dict[str, Any]) -> None:
    """Store results of the solid, with six digits."""
    text = {
        name: {
            key: value
            if isinstance(value, int)
            else json.loads(json.dumps(np.array(value).tolist()), parse_float=_short)
            for key, value in one.items()
        }
        for name, one in found.items()
    }
    STORED.write_text(
        json.dumps(text, indent=None, separators=(",", ":")).replace('},"', '},\n"') + "\n", encoding="utf-8"
    )


def _short(text: str) -> float:
    return float(f"{float(text):.6g}")


if __name__ == "__main__":
    main()
