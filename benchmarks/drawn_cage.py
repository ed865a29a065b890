"""The finite-element model of a cage as drawn beside CalculiX on the same mesh, other meshes, and the model without a drawing.

    python benchmarks/drawn_cage.py [--quick] [--json FILE]     # needs the extra cad; CalculiX (Debian: calculix-ccx) where it is

Two cages of a 30310 in steel, written as STEP by `examples/cage_drawings`: of sheet, 2 mm thick, whose windows have corners of
0.5 mm, and machined with a rail. A roller pushes with 100 N against the leading bar of pocket 0; rigid acceleration balances the
free body. The stress is that of the surface in the corners. CalculiX has the same nodes, tetrahedra and nodal forces.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import common
import numpy as np

import trbdyn as trb
from trbdyn.cage.cage_solid import CageSolid, cage_solid
from trbdyn.cage.drawn_solid import drawn_solid
from trbdyn.cage.solid import RIGID

ROOT = Path(__file__).resolve().parents[1]
FORCE = 100.0
"""Push of the roller (N)."""
SAME = "CalculiX, same mesh"
SHOWN = ("cage", "quantity", "trbdyn", "other", "of", "difference")
COLUMNS = {
    "cage": "text: which cage",
    "quantity": "text: frequency of modes (Hz), largest stress at a corner (MPa), corner that differs most (MPa)",
    "trbdyn": "Hz, MPa: of the package, plain mesh",
    "other": "Hz, MPa: of the other model",
    "of": "text: the other model",
    "difference": "1: trbdyn over the other one, less 1; of a corner: difference over the largest stress",
}


def drawn(kind: str, folder: Path, **options: Any) -> trb.Bearing:
    """The 30310 with a drawn cage."""
    sys.path.insert(0, str(ROOT / "examples" / "cage_drawings"))
    import drawings

    rig = trb.cases.rig_30310()
    path = drawings.write(kind, rig, folder / f"{kind}.step", **options)
    return rig.replace(cage=trb.Cage.from_step(path, rig, tolerance=1e-5, material=trb.Material.steel()))


def without_drawing(drawn_one: trb.Bearing, thickness: float, corner: float) -> trb.Bearing:
    """The same cage of sheet as rims and bars."""
    plays = {"play_radial": 0.25e-3, "play_circumferential": 0.12e-3, "play_axial": 0.4e-3}
    body = trb.CageBody(thickness=thickness, small_rim_width=4e-3, large_rim_width=4e-3, corner_radius=corner)
    return drawn_one.replace(cage=trb.Cage(**plays, body=body, material=trb.Material.steel()))


def pushed(built: CageSolid) -> np.ndarray:
    """Forces at the nodes for the push, balanced by rigid acceleration, shape (3 N,)."""
    at = next(k for k, (pocket, face) in enumerate(built.faces) if pocket == 0 and face.name == "leading_bar")
    rigid, heavy = built.solid.rigid_motions, built.solid.mass_of_motions
    load = FORCE * built.pushes()[:, at]
    return np.asarray(load - heavy @ np.linalg.solve(rigid.T @ heavy, rigid.T @ load))


def calculix(built: CageSolid, material: trb.Material, count: int, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (Hz), and stress tensors at all nodes under the push (Pa), shape (N, 3, 3)."""
    sys.path.insert(0, str(ROOT / "examples" / "cage_solid"))
    import solid as model

    nodes, elements = built.solid.nodes, built.solid.basis.element_dofs.T.copy()
    # edges are in the order of scikit-fem's tetrahedra; these may be left-handed, those of CalculiX may not
    turned = np.linalg.det(nodes[elements[:, 1:4]] - nodes[elements[:, :1]]) < 0.0
    elements[turned] = elements[turned][:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]]
    squares = model.solve(nodes, elements, material, count, folder)
    held = _held(nodes)
    load = pushed(built).reshape(-1, 3)
    with (folder / "push.inp").open("w") as file:
        file.write((folder / "cage.inp").read_text().split("*STEP")[0])
        file.write("*BOUNDARY\n" + "".join(f"{node + 1},{axis + 1},{axis + 1},0.\n" for node, axis in held))
        file.write("*STEP\n*STATIC\n*CLOAD\n")
        rows = [(n, k) for n, k in zip(*np.nonzero(load), strict=True)]
        file.writelines(f"{n + 1},{k + 1},{load[n, k]:.12e}\n" for n, k in rows)
        file.write("*EL FILE\nS\n*END STEP\n")
    run = subprocess.run(["ccx", "-i", "push"], cwd=folder, capture_output=True, text=True, check=False)
    if run.returncode:
        raise SystemExit(f"CalculiX: {run.stdout[-2000:]}")
    found, inside = np.zeros((len(nodes), 6)), False
    for line in (folder / "push.frd").open():
        if line.startswith(" -4"):
            inside = line.split()[1] == "STRESS"
        elif line.startswith(" -1") and inside:
            found[int(line[3:13]) - 1] = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(6)]
    xx, yy, zz, xy, yz, zx = found.T
    tensors = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]).transpose(2, 0, 1)
    return np.sqrt(squares[RIGID:]) / (2.0 * np.pi), tensors


def _held(nodes: np.ndarray) -> list[tuple[int, int]]:
    """Nodes and directions that hold a rigid body without forces: three far apart."""
    first, second, third = int(np.argmax(nodes[:, 0])), int(np.argmin(nodes[:, 0])), int(np.argmax(nodes[:, 1]))
    return [(first, 0), (first, 1), (first, 2), (second, 1), (second, 2), (third, 2)]


def _nearest(built: CageSolid) -> np.ndarray:
    """Nodes at the corners."""
    return np.array(
        [int(np.argmin(np.linalg.norm(built.solid.nodes - place, axis=1))) for place in built.corner_places]
    )


def rows_of(
    name: str, of: str, own: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]
) -> list[dict[str, Any]]:
    """Rows: frequencies of pairs of modes, largest stress, and on the same mesh the corner that differs most."""
    rows: list[tuple[str, float, float, str, float]] = []
    for k in range(0, len(own[0]), 2):
        first, second = float(own[0][k]), float(other[0][k])
        rows.append((f"modes {k + 1}, {k + 2} (Hz)", first, second, of, first / second - 1.0))
    first, second = (1e-6 * float(np.abs(stress).max()) for stress in (own[1], other[1]))
    rows.append(("largest stress (MPa)", first, second, of, first / second - 1.0))
    if of == SAME:
        worst = int(np.argmax(np.abs(own[1] - other[1])))
        first, second = 1e-6 * float(own[1][worst]), 1e-6 * float(other[1][worst])
        rows.append(
            ("corner that differs most (MPa)", first, second, of, 1e6 * (first - second) / np.abs(other[1]).max())
        )
    return [dict(zip(SHOWN, (name, *row), strict=True)) for row in rows]


def of_package(built: CageSolid, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (Hz), and stress at the corners under the push (Pa)."""
    frequency, _ = built.solid.natural(count)
    moved = built.solid.static(pushed(built)[:, None])
    return frequency, np.asarray(built.stress_of @ moved)[:, 0]


def main(arguments: Sequence[str] | None = None) -> common.Report:
    """Run it."""
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("drawn_cage", options, COLUMNS, inputs={"force": FORCE})
    kinds = {"sheet": {"corner": 0.0 if options.smoke else 0.5e-3}, "machined": {"corner": 0.5e-3}}
    if options.quick:
        kinds.pop("machined")
    plain, count = (0.4, 6) if options.smoke else (1.0, 20)
    with tempfile.TemporaryDirectory() as folder:
        for kind, given in kinds.items():
            bearing = drawn(kind, Path(folder), **given)
            built = drawn_solid(bearing, fineness=plain)
            own = of_package(built, count)
            if shutil.which("ccx"):
                frequency, tensors = calculix(built, bearing.cage_material, count, Path(folder))
                stress = np.einsum("pi,pij,pj->p", built.directions, tensors[_nearest(built)], built.directions)
                for row in rows_of(kind, SAME, own, (frequency, stress)):
                    report.add(**row)
            for fineness in () if options.quick else (1.0 / 1.4, 1.4):
                other = of_package(drawn_solid(bearing, fineness=fineness), count)
                for row in rows_of(kind, f"edges {1.0 / fineness:.2g} times as long", own, other):
                    report.add(**row)
            if kind == "sheet":
                other = of_package(cage_solid(without_drawing(bearing, 2e-3, given["corner"])), count)
                for row in rows_of(kind, "without drawing, nominal stress", own, other):
                    report.add(**row)
    print(common.table(report.results, SHOWN))
    report.finish()
    return report


if __name__ == "__main__":
    main()
