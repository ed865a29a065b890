"""How far the cage can move between its rollers: geometry alone, with the core's own contacts.

The cage's centre moves in the x-y plane, parallel to itself, until a bar touches a roller whose large end rests in its pocket.
Rollers are held at given places, or are free to move along their raceways: then each gives way to the place where both of its
bars have the same gap. The cage may turn a little about its axis to make room.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from trbdyn.errors import InputError
from trbdyn.model.scene import Scene
from trbdyn.run.simulation import Simulation

Array = NDArray[np.float64]

BARS = ("leading_bar", "trailing_bar")
"""Names of the faces that bound the motion."""
PRECISION = 1e-9
"""To which distances are found (m)."""
STEPS = 6
"""Secant steps of a roller to its place: the gaps are almost linear in it."""
MOST = 1e-3
"""Largest distance that is looked at (m)."""


@dataclass(frozen=True)
class Movable:
    """Distance that the cage's centre can move, by direction.

    Attributes
    ----------
    direction : ndarray, shape (N,)
        Direction in the cage's frame from x towards y (rad).
    distance : ndarray, shape (N,)
        Distance (m).
    """

    direction: Array
    distance: Array


class Pockets:
    """Gaps between bars and rollers as functions of where the cage and the rollers are.

    Parameters
    ----------
    scene : Scene
        Scene of the bearing; loads and speeds do not matter.

    Raises
    ------
    InputError
        If the pockets have no faces called 'leading_bar' and 'trailing_bar', as those of `trbdyn.pocket_shapes` have.

    Examples
    --------
    >>> import trbdyn as trb
    >>> from paper.movable import Pockets
    >>> scene = trb.cases.scene_30310(3000.0, 4930.0)
    >>> reach = Pockets(scene).held(0.0, [0.0]).distance[0]
    >>> bool(reach < scene.bearing.cage.play_radial)
    True
    """

    def __init__(self, scene: Scene) -> None:
        names = scene.bearing.slot_names
        for bar in BARS:
            if bar not in names:
                raise InputError.of(("bearing", "cage", "pocket"), ", ".join(names), f"must have a face called '{bar}'")
        self.sim = Simulation(scene)
        self.bars = [names.index(bar) for bar in BARS]
        self.count = scene.bearing.n_rollers
        self.radius = 0.5 * scene.bearing.pitch_diameter
        self.vector = np.zeros_like(self.sim.state.vector)

    def interference(self, x: float, y: float, turn: float, places: ArrayLike) -> Array:
        """Interference of both bars with each roller (m), shape (Z, 2); negative for a gap.

        Parameters
        ----------
        x, y : float
            Place of the cage's centre (m).
        turn : float
            Turn of the cage about its axis (rad).
        places : array_like, shape () or (Z,)
            Angle of each roller from its even place (rad).
        """
        state = self.sim.view(self.vector)
        state["cage_x"], state["cage_y"], state["cage_psi"] = x, y, turn
        state["roller_psi"] = np.asarray(places, dtype=float)
        found = self.sim.contacts(self.vector, 0.0)["pocket_interference"]
        return np.asarray(found[:, self.bars], dtype=float)

    def held(self, places: ArrayLike, directions: ArrayLike, centre: tuple[float, float] = (0.0, 0.0)) -> Movable:
        """With every roller held at its place (rad from the even one); distances are from a place of the cage (m)."""
        widest = 2.0 * float(np.max(np.abs(places), initial=0.0)) + MOST / self.radius

        def least(x: float, y: float) -> float:
            """Largest interference, with the cage turned so that bars on both sides have the same one."""

            def uneven(turn: float) -> float:
                leading, trailing = self.interference(x, y, turn, places).max(axis=0)
                return float(leading - trailing)

            turn = scipy.optimize.brentq(uneven, -widest, widest, xtol=PRECISION / self.radius)
            return float(self.interference(x, y, turn, places).max())

        return _reach(lambda x, y: least(centre[0] + x, centre[1] + y), directions)

    def free(self, directions: ArrayLike) -> Movable:
        """With rollers that give way."""

        def uneven(x: float, y: float, places: Array) -> Array:
            gaps = self.interference(x, y, 0.0, places)
            return gaps[:, 0] - gaps[:, 1]

        def least(x: float, y: float) -> float:
            """Largest interference, with each roller where both of its bars have the same one."""
            old, new = np.zeros(self.count), np.full(self.count, 1e-3 * MOST / self.radius)
            before, now = uneven(x, y, old), uneven(x, y, new)
            for _ in range(STEPS):
                change = now - before
                step = np.divide(now * (new - old), change, out=np.zeros_like(change), where=change != 0.0)
                old, before, new = new, now, new - step
                now = uneven(x, y, new)
            return float(self.interference(x, y, 0.0, new).max())

        return _reach(least, directions)


def _reach(least: Callable[[float, float], float], directions: ArrayLike) -> Movable:
    """Where the least interference becomes zero, along each direction."""
    angles = np.atleast_1d(np.asarray(directions, dtype=float))
    reached = []
    for x, y in zip(np.cos(angles), np.sin(angles), strict=True):
        along = partial(_along, least, x, y)
        reached.append(scipy.optimize.brentq(along, 0.0, MOST, xtol=PRECISION) if along(0.0) < 0.0 else 0.0)
    return Movable(angles, np.array(reached))


def _along(least: Callable[[float, float], float], x: float, y: float, distance: float) -> float:
    return least(distance * x, distance * y)
