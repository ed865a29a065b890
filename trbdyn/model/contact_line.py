"""The nodes of the contact line of a roller with a raceway."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene


def stations(scene: Scene) -> NDArray[np.float64]:
    """Places of the nodes along the effective length, from its middle towards the large end (m), shape (n,)."""
    effects, length = scene.effects, scene.bearing.roller.effective_length
    if effects.quadrature == "gauss":
        return np.asarray(0.5 * length * np.polynomial.legendre.leggauss(effects.n_slices)[0])
    return np.asarray(length * ((np.arange(effects.n_slices) + 0.5) / effects.n_slices - 0.5))
