"""Stress at the corners of a cage's pockets over time, from the modes and the forces of a run
(docs/theory/cage.md#stress-at-the-corners-of-the-pockets).

Modes that are left out of a simulation hardly move the cage, but they carry most of the stress near a force: for a force on a
bar, the lowest 20 give less than half of it. They follow the force without delay, so their part is static: what the finite
elements carry under the recorded forces of the pockets, less what the modes that move would carry at rest.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError
from trbdyn.extras.elastic.modes import CageModes
from trbdyn.extras.elastic.simulated import cage_modes, mesh_difference, shapes_by_slot, stress_at_rest
from trbdyn.model.pocket import every_surface
from trbdyn.results.cage_stress import CageStress

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene

FloatArray = NDArray[np.float64]


def cage_stress(
    scene: Scene, time: FloatArray, amplitude: FloatArray, force: FloatArray, *, notch_factor: float = 1.0
) -> CageStress:
    """Stress from recorded amplitudes of the modes and forces of the pockets.

    Parameters
    ----------
    scene : Scene
        The scene, with an elastic cage.
    time : ndarray, shape (T,)
        Times (s).
    amplitude : ndarray, shape (T, M)
        Amplitudes of the modes (m): the field cage_mode.
    force : ndarray, shape (T, Z, S)
        Normal forces on the faces of the pockets (N): the field pocket_force. They are taken to act at the faces' middles.
    notch_factor : float
        Factor of the nominal stress.

    Raises
    ------
    InputError
        If the scene's cage is rigid, or the factor not above 0.
    """
    if not (math.isfinite(notch_factor) and notch_factor > 0.0):
        raise InputError.of("notch_factor", notch_factor, "must be > 0 (1)")
    modes, slots = cage_modes(scene), force.shape[2]
    stress, influence = amplitude @ modes.stress, _at_rest(scene, modes)
    elastic = scene.elastic_cage
    assert elastic is not None  # cage_modes has looked
    is_complete, is_drawn = elastic.file is None, scene.bearing.cage.drawing is not None
    if is_complete and is_drawn and notch_factor != 1.0:
        raise InputError.of(
            "notch_factor", notch_factor, "must be 1 for a cage as drawn: its stress is that in the notch (1)"
        )
    if is_complete:
        whole = _whole(scene, modes, slots)
        stress += force.reshape(len(force), -1) @ (whole - influence)
        influence = whole
    return CageStress(
        time=time,
        stress=notch_factor * stress,
        point_name=modes.point_name,
        point_place=modes.point_place,
        is_complete=is_complete,
        force=force,
        face_name=scene.bearing.slot_names,
        influence=notch_factor * influence,
        period=1.0 / float(modes.frequency[0]),
        mesh_difference=mesh_difference(scene.bearing, elastic) if is_complete and is_drawn else None,
    )


def _at_rest(scene: Scene, modes: CageModes) -> FloatArray:
    """Static stress that the modes carry for a unit force on each face of each pocket, shape (Z S, P)."""
    shapes = shapes_by_slot(scene)
    push = np.zeros((*shapes.shape[1:3], 3))
    for pocket, face in every_surface(scene.bearing):
        push[pocket, face.slot] = -face.normal  # the roller pushes against the face
    pull = np.einsum("mzsi,zsi->mzs", shapes[..., :3], push).reshape(len(shapes), -1)
    still = pull / (modes.modal_mass * (2.0 * np.pi * modes.frequency) ** 2)[:, None]
    return np.asarray(still.T @ modes.stress)


def _whole(scene: Scene, modes: CageModes, slots: int) -> FloatArray:
    """The same of the whole finite-element model."""
    assert scene.elastic_cage is not None  # cage_modes has looked
    stress = stress_at_rest(scene.bearing, scene.elastic_cage)
    found = np.zeros((scene.bearing.n_rollers, slots, len(modes.point_name)))
    for at, (pocket, face) in enumerate(every_surface(scene.bearing)):
        found[pocket, face.slot] = stress[at]
    return found.reshape(-1, len(modes.point_name))
