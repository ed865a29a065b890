"""A cage as it was recognised in a drawing, and the fields of a `Cage` that it gives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import digest_of
from trbdyn.extras.cad.placing import Place
from trbdyn.model.pocket import OtherPocket, Pocket

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DrawnCage:
    """A cage as it was recognised in a drawing."""

    path: str
    n_pockets: int
    place: Place
    pockets: tuple[Pocket, ...]  # the different ones
    kind_of: tuple[int, ...]  # for each pocket, which of them it is
    volume: float  # m3
    offset: float  # of the centre of the volume above the roller-centre plane (m)
    centre: FloatArray  # of the volume off the axis of the pockets, along x and y of the cage's frame (m), shape (2,)
    inertia: FloatArray  # about the centre at a density of 1, in the cage's frame (m5), shape (3, 3)
    tolerance: float  # largest distance between drawn faces and facets (m)
    plays: dict[str, float]  # radial, circumferential, axial (m); infinite where nothing is in the roller's way

    def fields(self, density: float) -> dict[str, Any]:
        """Fields of `Cage`, for a density (kg/m3)."""
        mass = density * self.volume
        across = 0.5 * density * (self.inertia[0, 0] + self.inertia[1, 1])
        most = max(range(len(self.pockets)), key=self.kind_of.count)
        found: dict[str, Any] = {
            "mass": mass,
            "inertia_axial": density * float(self.inertia[2, 2]),
            "inertia_transverse": float(across),
            "offset": self.offset,
            "drawing": {
                "file": self.path,
                "sha256": digest_of(self.path),
                "origin": tuple(self.place.origin.tolist()),
                "axes": tuple(tuple(row) for row in self.place.turn.tolist()),
            },
            "pocket": self.pockets[most],
            "other_pockets": tuple(
                OtherPocket(index=index, pocket=self.pockets[kind])
                for index, kind in enumerate(self.kind_of)
                if kind != most
            ),
        }
        off = float(np.linalg.norm(self.centre))
        if off > self.tolerance:
            found["unbalance"] = mass * off
            found["unbalance_direction_deg"] = math.degrees(math.atan2(self.centre[1], self.centre[0]))
        return found | {f"play_{name}": value for name, value in self.plays.items() if math.isfinite(value)}
