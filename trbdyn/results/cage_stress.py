"""Stress at the corners of a cage's pockets over time, its cycles and their damage
(docs/theory/cage.md#stress-at-the-corners-of-the-pockets).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError

FloatArray = NDArray[np.float64]

COARSER: Final = 1.4
"""Edges of the mesh that a drawn cage is compared with, over those of its own."""
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
        Of a cage as drawn: what a coarser mesh changes (`trbdyn.extras.elastic.simulated.mesh_difference`): frequencies, and
        stress over the largest one.
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
    >>> from trbdyn.results.cage_stress import rainflow
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
