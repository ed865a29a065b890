"""What was read from a measured trace or a drawn line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.shown import Displayed, Shown

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Trace(Displayed):
    """What was read from a measured trace or a drawn line; print it for a table.

    Attributes
    ----------
    stations, drops : ndarray, shape (81,)
        The profile: places from mid length towards the large end, and drop below the highest place (m). For a run:
        ``trb.Profile.table(trace.stations, trace.drops)``.
    points, heights : ndarray, shape (n,)
        Place and height of each point along the effective length, levelled, crown up (m).
    outlier : ndarray of bool, shape (n,)
        Points that were left out.
    angle_deg : float
        Angle of the line that was taken out (deg).
    roughness : float
        Rq of what the filter took out, without outliers (m).
    path : str
        The file.
    cutoff : float
        Cut-off wavelength of the filter (m); 0 for a drawn line, which is not filtered.
    left_out : int
        Points beyond the effective length.
    """

    stations: Array
    drops: Array
    points: Array
    heights: Array
    outlier: NDArray[np.bool_]
    angle_deg: float
    roughness: float
    path: str
    cutoff: float
    left_out: int

    def __str__(self) -> str:
        return self._shown().text()

    def __repr__(self) -> str:
        return str(self)

    def _shown(self) -> Shown:
        length = self.stations[-1] - self.stations[0]
        rows = [
            ("points", str(self.points.size), "", "along the effective length"),
            ("left_out", str(self.left_out), "", "points beyond the effective length"),
            ("effective_length", f"{1e3 * length:.5g}", "mm", "over which the profile goes"),
            ("angle", f"{self.angle_deg:.4g}", "deg", "of the line that was taken out"),
            ("drop_small_end", f"{1e6 * self.drops[0]:.4g}", "µm", "below the highest place"),
            ("drop_large_end", f"{1e6 * self.drops[-1]:.4g}", "µm", "below the highest place"),
            (
                "highest",
                f"{1e3 * self.stations[np.argmin(self.drops)]:.4g}",
                "mm",
                "place from mid length towards the large end",
            ),
        ]
        if self.cutoff:
            rows += [
                ("outliers", str(np.count_nonzero(self.outlier)), "", "points that were left out"),
                ("cutoff", f"{1e3 * self.cutoff:.3g}", "mm", "wavelength of the Gaussian filter, ISO 16610-21"),
                ("Rq", f"{1e6 * self.roughness:.3g}", "µm", "roughness that the filter took out"),
            ]
        places = [f"{1e3 * place:.3f}" for place in self.points[self.outlier]]
        told = ", ".join(places[:10]) + (f" and {len(places) - 10} more" if len(places) > 10 else "")
        notes = (f"outliers at (mm from mid length): {told}",) if places else ()
        return Shown(f"Profile from {self.path}", tuple(rows), notes=notes)
