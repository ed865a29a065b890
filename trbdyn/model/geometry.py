"""Everything that follows from a bearing's catalogue numbers. The core derives it, and gives names, units and texts."""

from __future__ import annotations

from dataclasses import dataclass, make_dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core

_TABLE = _core.geometry_table()


if TYPE_CHECKING:

    class _Numbers:
        def __init__(self, **numbers: float) -> None: ...

        def __getattr__(self, name: str) -> float: ...

else:
    _Numbers = make_dataclass("_Numbers", [(name, float) for name, *_ in _TABLE], frozen=True)


@dataclass(frozen=True)
class Geometry(_Numbers):
    __doc__ = """Derived geometry of a bearing whose cup, cone and rollers share one apex, or are cylinders.

    SI units; angles in radians. Cylinders have no apex: distances from it are then from the middle of the bearing.

    Attributes
    ----------
    """ + "\n    ".join(f"{name} : float\n        {text} ({unit})" for name, unit, text in _TABLE)

    @classmethod
    def from_parameters(cls, block: NDArray[np.float64]) -> Geometry:
        """Geometry of a parameter block, a value for each row of the core's table; those that are not a bearing's own may be NaN.
        The core's `CoreInputError`, a ValueError, where it refuses the numbers.
        """
        return cls(**dict(zip((name for name, *_ in _TABLE), _core.geometry(block).tolist(), strict=True)))
