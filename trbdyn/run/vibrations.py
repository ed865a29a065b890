"""Vibrations of rollers on their raceways, and how fast the integration takes them away.

A roller that was struck, or that no load holds, vibrates on its raceways at some thousand cycles a second. Without normal
damping hardly anything but the integration takes energy from that, so that the size of the vibrations depends on the tolerances,
although the energy of the whole run adds up well: tenths of a millijoule decide about watts of rolling resistance where lightly
loaded contacts grow and shrink with every swing. So three things are looked at: whether vibrations are large, whether the losses
on the raceways swing with them, and whether the energy that is missing is much beside that of the vibrations.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation

LARGE: Final = 1e-4
"""Energy of the motion across the raceways over the elastic energy from which on vibrations are large."""
SWINGS: Final = 0.05
"""Standard deviation of the losses on the raceways over their mean from which on they are said to swing."""
RACEWAYS: Final = ("power_traction_outer", "power_traction_inner", "power_rolling")
"""Fields of these losses."""
LEAST_LOOKS: Final = 3
"""Looks below which nothing is said."""
LOST_IN_A_TURN: Final = 0.1
"""Share of the vibrations' energy that the integration may take in one turn of the shaft."""


class Vibrations:
    """Sees the motion of rollers across the raceways.

    Parameters
    ----------
    sim : Simulation
        The simulation that runs.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._places = {name: at for name, at, _ in sim._model.record_layout()}
        self._looks = 0
        self._kinetic = self._elastic = self._speed = 0.0
        self._losses: list[float] = []

    def look(self, row: np.ndarray) -> None:
        """Look at the present state and its record.

        Parameters
        ----------
        row : ndarray
            A row of all recorded quantities.
        """
        state = self._sim.view(self._sim._core.state())
        mass = self._sim.scene.bearing.geometry.roller_mass
        self._kinetic += float(0.5 * mass * np.sum(state["roller_v_r"] ** 2 + state["roller_v_z"] ** 2))
        self._elastic += float(row[self._places["elastic_energy"]])
        self._speed += abs(float(row[self._places["shaft_speed"]]))
        self._losses.append(sum(float(row[self._places[name]]) for name in RACEWAYS))
        self._looks += 1

    def judge(self, missing: float, since: float, until: float) -> str | None:
        """What is to be said about them, or None.

        Parameters
        ----------
        missing : float
            Energy that the integration took, or made if negative, between the two times (J).
        since, until : float
            The times (s).
        """
        if self._looks < LEAST_LOOKS or self._speed == 0.0 or self._kinetic <= LARGE * self._elastic:
            return None
        if np.std(self._losses) <= SWINGS * np.mean(self._losses):
            return None
        turns = self._speed / self._looks * (until - since) / (2.0 * math.pi)
        share = abs(missing) / max(self._kinetic / self._looks * turns, 1e-300)
        if share <= LOST_IN_A_TURN:
            return None
        return (
            f"from {since:.6g} s to {until:.6g} s rollers vibrate on their raceways, and the integration changes the energy of "
            f"these vibrations by {100.0 * share:.2g} % in a turn of the shaft: their size, and with it rolling resistance and "
            "slip, depend on the accuracy; give the contacts the damping that they have (effects.damping), or try smaller "
            "tolerances"
        )
