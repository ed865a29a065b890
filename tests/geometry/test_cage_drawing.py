"""The picture of a drawn cage beside what was recognised in it."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.plot.drawing import triangles_in_pocket

pytest.importorskip("gmsh")
WRITE = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "cage_drawings" / "drawings.py"))["write"]


@pytest.mark.slow
def test_recognised_faces_lie_on_the_drawn_ones_and_a_changed_file_is_refused(tmp_path: Path) -> None:
    bearing = trb.cases.rig_30310()
    path = WRITE("lands", bearing, tmp_path / "lands.step", shift=(3.0, -7.0, 20.0), turn=(0.4, 0.2, 1.0))
    own = bearing.replace(cage=trb.Cage.from_step(path, bearing))
    drawn = triangles_in_pocket(own, 5)
    normals = np.cross(drawn[:, 1] - drawn[:, 0], drawn[:, 2] - drawn[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    for face in own.pocket_of(5).faces:
        corners = 1e3 * np.asarray(face.vertices)[:, [1, 2, 0]]
        off = np.abs(np.einsum("cd,td->ct", corners, normals) - np.einsum("td,td->t", drawn[:, 0], normals))
        near = np.linalg.norm(drawn.mean(axis=1) - corners.mean(axis=0), axis=1) < 3.0
        assert off.max(axis=0)[near].min() < 1e-3, face.name
    figure = trb.plot.cage_drawing(own, 5)
    labels = {text.get_text().split(",")[0] for text in figure.legends[0].get_texts()}
    assert labels == {face.name.split("/")[0].replace("_", " ") for face in own.pocket_of(5).faces}
    path.write_text(path.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    with pytest.raises(trb.InputError, match=r"sha256.*has changed since"):
        trb.plot.cage_drawing(own)


def test_a_cage_without_a_drawing_is_refused() -> None:
    with pytest.raises(trb.InputError, match=r"cage\.drawing.*STEP file"):
        trb.plot.cage_drawing(trb.cases.rig_30310())
    with pytest.raises(trb.InputError, match="pocket"):
        trb.plot.cage_drawing(trb.cases.rig_30310(), 99)
