"""The contact of a roller with a raceway: grid, and start from slices on a coarse grid.

The gap at a place y along the line is (x - x0)^2/(2 R) + drop, with the equivalent radius R, and x0 from the skew.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.half_space.contact import Pressed, press
from trbdyn.half_space.influence import Influence

Array = NDArray[np.float64]

MARGIN: Final = 1.3
"""Half width of the grid over the largest half width of the slices."""
WIDER: Final = 1.4
"""Factor by which a grid is made wider when the contact reaches its border."""
COARSE: Final = 1e-2
"""Tolerance on the coarse grid."""
MOST_WIDENED: Final = 12
SPREAD: Final = 1e-3
"""Least pressure of a guess, over the largest one."""


@dataclass(frozen=True)
class Line:
    """What a contact line is made of, at cells of equal length along it.

    Attributes
    ----------
    places : ndarray, shape (m,)
        Middles of the cells along the line, from mid length (m); an even number.
    drop : ndarray, shape (m,)
        Gap along the line, up to a constant and a tilt (m).
    radius : ndarray, shape (m,)
        Equivalent radius (m).
    shift : ndarray, shape (m,)
        Place across at which the gap is least (m).
    compliance : tuple of float
        (1 - nu^2)/E of the roller and of the ring (1/Pa).
    mirrored : float
        Factor of the pressure mirrored at the roller's ends (1); 0 for a roller without ends.
    beyond : float
        Distance from the ends of the line to those of the roller (m).
    """

    places: Array
    drop: Array
    radius: Array
    shift: Array
    compliance: tuple[float, float]
    mirrored: float = 0.0
    beyond: float = 0.0

    def coarse(self) -> Line:
        """The same with cells of twice the length."""
        drop, radius, shift, places = (
            one.reshape(-1, 2).mean(axis=1) for one in (self.drop, self.radius, self.shift, self.places)
        )
        return Line(places, drop, radius, shift, self.compliance, self.mirrored, self.beyond)


@dataclass(frozen=True)
class Pressures:
    """Pressures on a grid.

    Attributes
    ----------
    x, y : ndarray, shape (n,) and (m,)
        Places of the cells across and along the line (m).
    found : Pressed
        Pressure, approach and tilt.
    coarse : ndarray, shape (m / 2,)
        Largest pressure across, of the grid with cells twice as wide and long (Pa).
    """

    x: Array
    y: Array
    found: Pressed
    coarse: Array


def press_line(
    line: Line, *, load: float, moment: float | None, per_length: Array, cells: int = 24, tolerance: float = 3e-4
) -> Pressures:
    """Pressures of a contact line under a load and a moment.

    Parameters
    ----------
    line : Line
        The contact line.
    load : float
        Load (N).
    moment : float or None
        Moment of the load about mid length (N m); None for a tilt that `line.drop` has.
    per_length : ndarray, shape (m,)
        Load per length of slices (N/m): where the search begins.
    cells : int
        Cells across the grid, even.
    tolerance : float
        As in `press`.

    Raises
    ------
    LoadError
        If the pressure is not found.
    """
    total = sum(line.compliance)
    length = float(line.places[1] - line.places[0])
    guess = np.maximum(per_length, SPREAD**2 * per_length.max())
    guess *= load / (guess.sum() * length)
    halves = np.sqrt(4.0 * guess * line.radius * total / np.pi)
    half = MARGIN * float(halves.max()) + float(np.abs(line.shift).max())
    small = line.coarse()
    coarse_guess, coarse_halves = (one.reshape(-1, 2).mean(axis=1) for one in (guess, halves))
    for _ in range(MOST_WIDENED):
        first = _solved(
            small, half, cells // 2, load, moment, _ellipses(small, half, cells // 2, coarse_guess, coarse_halves), 1e-2
        )
        if first[1].pressure[:, [0, -1]].any():
            half *= WIDER
            continue
        start = np.repeat(np.repeat(first[1].pressure, 2, axis=0), 2, axis=1)
        x, found = _solved(line, half, cells, load, moment, start, tolerance)
        if not found.pressure[:, [0, -1]].any():
            break
        half *= WIDER
    return Pressures(x, line.places, found, first[1].pressure.max(axis=1))


def _across(half: float, cells: int) -> Array:
    return np.asarray(half * (2.0 * (np.arange(cells) + 0.5) / cells - 1.0))


def _ellipses(line: Line, half: float, cells: int, per_length: Array, halves: Array) -> Array:
    """Pressures of Hertz on slices (Pa), no slice without any."""
    x = _across(half, cells)
    share = (x[None, :] - line.shift[:, None]) / halves[:, None]
    round_ = np.sqrt(np.maximum(1.0 - share**2, 0.0)) + SPREAD * (np.abs(share) < 1.0)
    return np.asarray(2.0 * (per_length / (np.pi * halves))[:, None] * round_)


def _solved(
    line: Line, half: float, cells: int, load: float, moment: float | None, start: Array, tolerance: float
) -> tuple[Array, Pressed]:
    x = _across(half, cells)
    size = float(x[1] - x[0]), float(line.places[1] - line.places[0])
    influence = Influence(
        (cells, line.places.size),
        size,
        compliance=sum(line.compliance),
        mirrored=line.mirrored * line.compliance[0],
        beyond=line.beyond,
    )
    gap = (x[None, :] - line.shift[:, None]) ** 2 / (2.0 * line.radius[:, None]) + line.drop[:, None]
    places = None if moment is None else line.places
    return x, press(influence, gap, load=load, places=places, moment=moment or 0.0, start=start, tolerance=tolerance)
