"""The result of bearings on one shaft: a result of each, and the shaft's own motion and energy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import InputError
from trbdyn.results.observables.energy import EnergyAudit, energy_audit
from trbdyn.results.result import Result
from trbdyn.statics.seat import Seat

Array = NDArray[np.float64]


class AssemblyResult(Mapping[str, Result], Displayed):
    """What a run of bearings on one shaft gives: a result of each bearing by its name, each in the bearing's own axes.

    Parameters
    ----------
    bearings : mapping of str to Result
        The results. The first bearing's energies are those of the shaft, too.
    seats : sequence of Seat
        How the bearings sit on the shaft, in the same order.
    """

    def __init__(self, bearings: Mapping[str, Result], seats: Sequence[Seat]) -> None:
        self._bearings = dict(bearings)
        self._seats = tuple(seats)

    def __getitem__(self, name: str) -> Result:
        """The result of a bearing.

        Raises
        ------
        InputError
            If no bearing has this name.
        """
        if name not in self._bearings:
            raise InputError.of("bearing", name, f"must be one of {', '.join(self._bearings)}")
        return self._bearings[name]

    def __iter__(self) -> Any:
        return iter(self._bearings)

    def __len__(self) -> int:
        return len(self._bearings)

    def __repr__(self) -> str:
        return f"<AssemblyResult: {', '.join(self._bearings)}: {self.message}>"

    def _shown(self) -> Shown:
        rows: list[tuple[str, ...]] = [("how it ended", self.message), ("energy closure", f"{self.energy.closure:.2g}")]
        parts = tuple(Shown(name, notes=(repr(result),)) for name, result in self.items())
        return Shown(f"Result: {'success' if self.success else 'failed'}", tuple(rows), parts=parts)

    @property
    def _first(self) -> Result:
        return next(iter(self._bearings.values()))

    @property
    def success(self) -> bool:
        """Whether the run reached its end."""
        return self._first.success

    @property
    def message(self) -> str:
        """How it ended, in a sentence."""
        return self._first.message

    @property
    def stats(self) -> dict[str, Any]:
        """What the integrator did, for all bearings together."""
        return self._first.stats

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the watch found, with the bearing's name where it concerns one."""
        return tuple(dict.fromkeys(f"{name}: {text}" for name, result in self.items() for text in result.warnings))

    @property
    def time(self) -> Array:
        """Times of the records (s), shape (T,)."""
        return self._first.time

    @property
    def shaft_position(self) -> Array:
        """Displacement of the shaft's centre of mass along its axes x, y, z (m), shape (T, 3)."""
        seat, axis = self._seats[0], self.shaft_axis
        return self._first.ring_position - [0.0, 0.0, seat.shift] + seat.mass_offset * (axis - [0.0, 0.0, 1.0])

    @property
    def shaft_axis(self) -> Array:
        """Direction of the shaft's axis (1), shape (T, 3)."""
        turn = self._first.ring_tilt
        across = np.column_stack([np.tan(turn[:, 1]), -np.tan(turn[:, 0]), np.ones(len(turn))])
        return across / np.linalg.norm(across, axis=1)[:, None]

    @property
    def energy(self) -> EnergyAudit:
        """The audit of all bearings and the shaft together; what passes between them is left out."""
        terms: dict[str, Array] = {}
        for result in self._bearings.values():
            for field in result.fields:
                if field.group == "energy" and result[field.name].ndim == 1:
                    terms[field.name] = terms.get(field.name, 0.0) + result[field.name]
        return energy_audit(terms)
