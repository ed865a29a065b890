"""Stress at the corners of a cage's pockets over time, its cycles and their damage
(docs/theory/cage.md#stress-at-the-corners-of-the-pockets).

Modes that are left out of a simulation hardly move the cage, but they carry most of the stress near a force: for a force on a
bar, the lowest 20 give less than half of it. They follow the force without delay, so their part is static: what the finite
elements carry under the recorded forces of the pockets, less what the modes that move would carry at rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.cage.modes import CageModes
from trbdyn.cage.simulated import COARSER, cage_modes, mesh_difference, shapes_by_slot, stress_at_rest
from trbdyn.errors import InputError
from trbdyn.model.pocket import every_surface

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene

FloatArray = NDArray[np.float64]

ACTS_NOW: Final = 0.3
"""Share of a stress from which a contact that acts at that time is said to make it."""


@dataclass(frozen=True, eq=False, repr=False)
class CageStress:
    """Normal stress at the corners of the pockets: along the bars at their roots, and along the rims beside the windows.

    Attributes
    ----------
    time : ndarray, shape (T,)
        Times (s).
    stress : ndarray, shape (T, P)
        Nominal stress times the notch factor (Pa).
    point_name : tuple of str, length P
        Names of the points.
    point_place : ndarray, shape (P, 3)
        Where they are in the cage's frame (m).
    is_complete : bool
        Whether the static part of the modes that are left out is in it; it is not where the modes come from a file.
    force : ndarray, shape (T, Z, S)
        Normal forces on the faces of the pockets (N).
    face_name : tuple of str, length S
        Names of the faces, by their slot.
    influence : ndarray, shape (Z S, P)
        Stress at rest for a unit force on each face (Pa/N), times the notch factor.
    period : float
        Period of the lowest mode (s).
    mesh_difference : tuple of float, optional
        Of a cage as drawn: what a coarser mesh changes (`trbdyn.cage.simulated.mesh_difference`): frequencies, and stress over
        the largest one.
    """

    time: FloatArray
    stress: FloatArray
    point_name: tuple[str, ...]
    point_place: FloatArray
    is_complete: bool
    force: FloatArray
    face_name: tuple[str, ...]
    influence: FloatArray
    period: float
    mesh_difference: tuple[float, float] | None = None

    def __repr__(self) -> str:
        name, time, stress = self.worst
        size = f"{len(self.time)} records at {len(self.point_name)} points"
        said = ""
        if self.mesh_difference is not None:
            of_frequency, of_stress = (100.0 * value for value in self.mesh_difference)
            said = f"; a mesh with edges {COARSER:g} times as long: frequencies {of_frequency:.2g} %, stress {of_stress:.2g} %"
        return f"<CageStress: {size}; largest {stress / 1e6:.4g} MPa at {time:g} s: {name}{said}>"

    @property
    def worst(self) -> tuple[str, float, float]:
        """Name of the point with the largest stress by magnitude, its time (s), and the stress (Pa)."""
        at, point = np.unravel_index(int(np.argmax(np.abs(self.stress))), self.stress.shape)
        return self.point_name[point], float(self.time[at]), float(self.stress[at, point])

    @property
    def cause(self) -> str:
        """Which contact made the largest stress: the one that would make most of it at rest, by its force at that time; or, where
        none makes `ACTS_NOW` of it, by its largest force within `period` before.
        """
        at, point = np.unravel_index(int(np.argmax(np.abs(self.stress))), self.stress.shape)
        size, flat = float(self.stress[at, point]), self.force.reshape(len(self.force), -1)
        shares = flat * self.influence[:, point] / size if size else np.zeros_like(flat)
        acts = float(shares[at].max()) >= ACTS_NOW
        first = int(at) if acts else int(np.searchsorted(self.time, self.time[at] - self.period))
        later, contact = divmod(int(np.argmax(shares[first : at + 1])), shares.shape[1])
        moment = first + later
        share = float(shares[moment, contact])
        if share <= 0.0:
            return "no contact within a period of the lowest mode before: the cage vibrates from earlier on"
        pocket, slot = divmod(contact, self.force.shape[2])
        apart = np.flatnonzero(flat[:moment, contact] == 0.0)
        began = int(apart[-1]) + 1 if apart.size else 0
        said = (
            f"roller {pocket} on the {self.face_name[slot].replace('_', ' ')} of pocket {pocket}, in contact from "
            f"{self.time[began]:.6g} s on: its {flat[moment, contact]:.4g} N at {self.time[moment]:.6g} s would make "
            f"{100.0 * share:.0f} % of the stress at rest"
        )
        return said if acts else f"{said}; the rest is vibration"

    def damage(self, *, reference_range: float, reference_cycles: float, slope: float) -> FloatArray:
        """Damage by Miner's sum at every point, shape (P,), from rainflow cycles and the S-N line N = Nr (S/Sr)^-k; 1: broken.

        Parameters
        ----------
        reference_range : float
            Sr, a range of stress (Pa), twice the amplitude.
        reference_cycles : float
            Nr, the cycles that it can be borne.
        slope : float
            k.

        Raises
        ------
        InputError
            If a number is not above 0.
        """
        for name, value in (
            ("reference_range", reference_range),
            ("reference_cycles", reference_cycles),
            ("slope", slope),
        ):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError.of(name, value, "must be > 0")
        found = np.zeros(self.stress.shape[1])
        for point in range(found.size):
            ranges, counts = rainflow(self.stress[:, point])
            found[point] = np.sum(counts * (ranges / reference_range) ** slope) / reference_cycles
        return found


def rainflow(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ranges of the cycles of a series, and how often each occurs, 1 or 0.5 (ASTM E1049-85, section 5.4.4).

    Parameters
    ----------
    values : ndarray, shape (T,)
        The series.

    Returns
    -------
    tuple of ndarray, shape (C,)
        Ranges, in the unit of the series, and counts.

    Examples
    --------
    >>> from trbdyn.cage.stress import rainflow
    >>> import numpy as np
    >>> ranges, counts = rainflow(np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]))
    >>> sorted(zip(ranges.tolist(), counts.tolist()))
    [(3.0, 0.5), (4.0, 0.5), (4.0, 1.0), (6.0, 0.5), (8.0, 0.5), (8.0, 0.5), (9.0, 0.5)]
    """
    moves = np.diff(values)
    turns = np.flatnonzero(moves[:-1] * moves[1:] < 0.0) + 1
    series = values[np.concatenate([[0], turns, [len(values) - 1]])] if len(values) > 1 else values
    ranges: list[float] = []
    counts: list[float] = []
    open_ones: list[float] = []
    for value in series:
        open_ones.append(float(value))
        while len(open_ones) >= 3:
            last, before = abs(open_ones[-1] - open_ones[-2]), abs(open_ones[-2] - open_ones[-3])
            if last < before:
                break
            ranges.append(before)
            if len(open_ones) == 3:
                counts.append(0.5)
                del open_ones[0]
            else:
                counts.append(1.0)
                del open_ones[-3:-1]
    for first, second in pairwise(open_ones):
        ranges.append(abs(second - first))
        counts.append(0.5)
    return np.array(ranges), np.array(counts)


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
