"""The nodes of the contact line of a roller with a raceway."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from trbdyn.model.assembly import ShaftBearing
    from trbdyn.model.roller import Profile
    from trbdyn.model.scene import Scene


USUAL_NODES: Final = 16
"""Nodes along a contact whose rollers and raceways have a straight middle."""
PROFILED_NODES: Final = 24
"""The same where a profile drops from the middle on, so that the loaded part of the line has an end. With these the power that
all contacts lose at the equilibrium is within 0.5 % of that with 192 nodes (tests/convergence/test_nodes.py)."""
STRAIGHT_MIDDLE: Final = 0.5
"""Largest share of half the length over which a logarithmic profile drops, `k2`, with which the middle counts as straight."""


def nodes(scene: Scene | ShaftBearing) -> int:
    """Number of nodes along a contact: that of the effects, or as many as the profiles need."""
    bearing = scene.bearing
    if scene.effects.n_slices > 0:
        return scene.effects.n_slices
    profiles = (bearing.roller.profile, bearing.cup_profile, bearing.cone_profile)
    return USUAL_NODES if all(one is None or _has_straight_middle(one) for one in profiles) else PROFILED_NODES


def _has_straight_middle(profile: Profile) -> bool:
    return profile.kind == "straight" or (profile.kind == "logarithmic" and profile.k2 <= STRAIGHT_MIDDLE)


def line_length(scene: Scene) -> float:
    """Length of the contact line (m): the ISO profile drops without bound at c_p + d_p."""
    roller = scene.bearing.roller
    if roller.profile.kind != "iso":
        return roller.effective_length
    return min(roller.effective_length, roller.profile.c_p + roller.profile.d_p)


def stations(scene: Scene) -> NDArray[np.float64]:
    """Places of the nodes along the contact line, from its middle towards the large end (m), shape (n,)."""
    count, length = nodes(scene), line_length(scene)
    if scene.effects.quadrature == "gauss":
        return np.asarray(0.5 * length * np.polynomial.legendre.leggauss(count)[0])
    return np.asarray(length * ((np.arange(count) + 0.5) / count - 0.5))
