"""The energy of a run over a time: what changed hands, and what of it is missing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STORED_SHARE: Final = 1e-3
"""Share of the kinetic and elastic energy below which an exchange of energy counts as this share."""
LEAST_STORED_SHARE: Final = 5e-8
"""The same below which nothing is looked at beside the losses."""
LEAST_ENERGY: Final = 1e-9
"""Energy below which nothing is judged (J)."""


@dataclass
class Span:
    """A time that is judged, from `since` on (s): works, losses, kinetic and elastic energy at its beginning (J), and the state
    there; the energy that changed hands since then (J), and the sum of the elastic energy over the looks (J).
    """

    since: float
    first: dict[str, float]
    state: Array | None
    turned_over: float = 0.0
    elastic: float = 0.0
    looks: int = 0

    def add(self, exchanged: float, elastic: float) -> None:
        """Add what a look has found."""
        self.turned_over += exchanged
        self.elastic += elastic
        self.looks += 1


def missing(then: dict[str, float], now: dict[str, float]) -> tuple[float, float, float]:
    """Energy that is missing, that was put in, and that was lost between two states (J)."""
    change = {name: now[name] - then[name] for name in now}
    put_in = sum(value for name, value in change.items() if name.startswith("work_"))
    lost = sum(value for name, value in change.items() if name.startswith("loss_"))
    return put_in - lost - change["kinetic_energy"] - change["elastic_energy"], put_in, lost


def scale(turned_over: float, now: dict[str, float]) -> float:
    """Energy that an error of it is compared with (J)."""
    stored = abs(now["kinetic_energy"]) + abs(now["elastic_energy"])
    return max(turned_over, STORED_SHARE * stored, LEAST_ENERGY)
