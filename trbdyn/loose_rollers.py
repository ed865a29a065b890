"""Rollers that bounce between their raceways, and how fast the integration takes their vibrations away.

In a bearing with clearance no roller is held by a load: the rollers bounce between cup and cone. Without normal damping hardly
anything but the integration takes energy from these vibrations, so that their size, and with it rolling resistance and slip,
depends on the tolerances, although the energy of the whole run adds up well: vibrations of tenths of a millijoule decide about
watts. Here the energy that is missing is compared with the energy of the vibrations.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from trbdyn.simulation import Simulation

LOOSE_SHARE: Final = 0.3
"""Share of looks at which each roller must be without load at a raceway to be called loose."""
LEAST_LOOKS: Final = 5
"""Looks below which nothing is said."""
LOST_IN_A_TURN: Final = 0.1
"""Share of the vibrations' energy that the integration may take in one turn of the shaft."""


class LooseRollers:
    """Sees rollers without load, and the energy of their motion across the raceways.

    Parameters
    ----------
    sim : Simulation
        The simulation that runs.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._places = {name: (at, shape) for name, at, shape in sim._model.record_layout()}
        self._looks = 0
        self._loose = np.zeros(sim.scene.bearing.n_rollers)
        self._energy = 0.0
        self._speed = 0.0

    def look(self, row: np.ndarray) -> None:
        """Look at the present record.

        Parameters
        ----------
        row : ndarray
            A row of all recorded quantities.
        """
        loads = [self._read(row, name) for name in ("outer_load", "inner_load")]
        self._loose += np.minimum(*loads) <= 0.0
        state = self._sim.view(self._sim._core.state())
        mass = self._sim.scene.bearing.geometry.roller_mass
        self._energy += float(0.5 * mass * np.sum(state["roller_v_r"] ** 2 + state["roller_v_z"] ** 2))
        self._speed += abs(float(self._read(row, "shaft_speed")[0]))
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
        if self._looks < LEAST_LOOKS or self._speed == 0.0 or not np.all(self._loose >= LOOSE_SHARE * self._looks):
            return None
        energy, speed = self._energy / self._looks, self._speed / self._looks
        turns = speed * (until - since) / (2.0 * math.pi)
        share = abs(missing) / max(energy * turns, 1e-300)
        if share <= LOST_IN_A_TURN:
            return None
        return (
            f"from {since:.6g} s to {until:.6g} s no roller is held by a load: they bounce between the raceways, and the "
            f"integration changes the energy of these vibrations by {100.0 * share:.2g} % in a turn of the shaft: their "
            "size, rolling resistance and slip depend on the accuracy; give the contacts the damping that they have "
            "(effects.damping), or try smaller tolerances"
        )

    def _read(self, row: np.ndarray, name: str) -> np.ndarray:
        at, shape = self._places[name]
        return row[at : at + math.prod(shape)]
