"""A cage as it was recognised in a drawing, and the fields of a `Cage` that it gives."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import digest_of
from trbdyn.model.drawn.opened import DrawnFace
from trbdyn.model.drawn.placing import Place
from trbdyn.model.pocket import OtherPocket, Pocket

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Recognised:
    """What a face of the drawing was taken for.

    Attributes
    ----------
    face : DrawnFace
        The face.
    pocket : int
        Number of the pocket, or -1 where it is part of none.
    surface : str
        Name of the pocket's surface that it belongs to; empty where no roller can touch it.
    """

    face: DrawnFace
    pocket: int
    surface: str


@dataclass(frozen=True)
class Rim:
    """A surface of revolution that a land of a ring can guide.

    Attributes
    ----------
    side : {'outer', 'inner'}
        Which ring's land is opposite to it.
    radius : float
        Its radius (m).
    offset : float
        Axial position of its middle from the roller-centre plane (m).
    width : float
        Its width (m).
    """

    side: str
    radius: float
    offset: float
    width: float


@dataclass(frozen=True, eq=False)
class DrawnCage:
    """A cage as it was recognised in a drawing.

    Attributes
    ----------
    path : str
        The file.
    n_pockets : int
        Number of its pockets.
    place : Place
        Where the drawing lies in the cage's frame.
    pockets : tuple of Pocket
        The different pockets.
    kind_of : tuple of int
        For each pocket, which of them it is.
    volume : float
        Volume (m3).
    offset : float
        Centre of the volume above the roller-centre plane (m).
    centre : ndarray, shape (2,)
        Centre of the volume off the axis of the pockets, along x and y of the cage's frame (m).
    inertia : ndarray, shape (3, 3)
        Moments of inertia about the centre at a density of 1, in the cage's frame (m5).
    tolerance : float
        Largest distance between drawn faces and facets (m).
    plays : dict of str to float
        How far the roller can move from the middle: radial, circumferential, axial (m); infinite where nothing is in the way.
    rims : tuple of Rim
        Surfaces that a land can guide.
    recognised : tuple of Recognised
        All faces of the drawing.
    """

    path: str
    n_pockets: int
    place: Place
    pockets: tuple[Pocket, ...]
    kind_of: tuple[int, ...]
    volume: float
    offset: float
    centre: FloatArray
    inertia: FloatArray
    tolerance: float
    plays: dict[str, float]
    rims: tuple[Rim, ...] = ()
    recognised: tuple[Recognised, ...] = field(default=(), repr=False)

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
