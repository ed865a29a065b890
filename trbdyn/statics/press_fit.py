"""Two thick rings, one pressed into the other: the pressure between them, and how far their other surfaces move
(docs/theory/fits.md#rings).

Plane stress, no pressure on the other surfaces (Lame). With the diameters a of the inner one's bore, d of the seat, b of the
outer one's outside, and U the interference on the diameter,

    U/d = p {[(b^2 + d^2)/(b^2 - d^2) + nu_b]/E_b + [(d^2 + a^2)/(d^2 - a^2) - nu_a]/E_a}.

The outside of the outer one grows by 2 p d^2 b/[E_b (b^2 - d^2)], the bore of the inner one shrinks by
2 p d^2 a/[E_a (d^2 - a^2)], both on the diameter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trbdyn.model.material import Material

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PressFit:
    """A seat of two rings."""

    bore: float  # diameter a (m); 0 for a solid shaft
    seat: float  # diameter d (m)
    outside: float  # diameter b (m)
    inner: Material
    outer: Material

    def pressure(self, interference: Array) -> Array:
        """Pressure on the seat (Pa) by the interference on the diameter (m); 0 where the fit is loose."""
        a, d, b = self.bore**2, self.seat**2, self.outside**2
        soft = ((b + d) / (b - d) + self.outer.poisson_ratio) / self.outer.youngs_modulus
        soft += ((d + a) / (d - a) - self.inner.poisson_ratio) / self.inner.youngs_modulus
        return np.asarray(np.maximum(interference, 0.0) / (self.seat * soft))

    def outside_growth(self, interference: Array) -> Array:
        """How much the outside diameter of the outer one grows (m)."""
        d, b = self.seat**2, self.outside**2
        return 2.0 * self.pressure(interference) * d * self.outside / (self.outer.youngs_modulus * (b - d))

    def bore_shrinkage(self, interference: Array) -> Array:
        """How much the bore of the inner one shrinks (m)."""
        a, d = self.bore**2, self.seat**2
        return 2.0 * self.pressure(interference) * d * self.bore / (self.inner.youngs_modulus * (d - a))

    def hoop_stress(self, interference: Array) -> Array:
        """Largest tensile stress of the outer one, along its bore (Pa)."""
        d, b = self.seat**2, self.outside**2
        return self.pressure(interference) * (b + d) / (b - d)
