"""Whether a run stays within the loads that its law of rolling resistance was fitted to, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.model.motion import values_of

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene
    from trbdyn.results.result import Result

FITTED: Final = {"zhou_hoeprich": (1e-4, 3.5e-4)}
"""Range of the load group W = Q/(l E' Re) of a law's data, by the name in `Effects.rolling_law`; for the other laws none is known
(docs/theory/lubrication.md#rolling-resistance)."""


def load_groups(result: Result) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The load group W of every roller's contact with a raceway that carries, at every record.

    Parameters
    ----------
    result : Result
        Needs the group contacts.
    """
    geometry, length = result.scene.bearing.geometry, result.scene.bearing.roller.effective_length
    groups = [
        np.ravel(result[f"{side}_load"]) / (length * geometry.effective_modulus * radius)
        for side, radius in (("outer", geometry.outer_equivalent_radius), ("inner", geometry.inner_equivalent_radius))
    ]
    found = np.concatenate(groups)
    return found[found > 0.0]


def rolling_note(result: Result) -> str | None:
    """What the law of rolling resistance is used for that it was not made for; None where it is not.

    Parameters
    ----------
    result : Result
        The part of a run that averages are taken of; needs the group contacts.
    """
    scene = result.scene
    if not (scene.effects.rolling_resistance and scene.effects.films):
        return None
    said = [text for text in (_outside(result), _tilted(scene)) if text]
    return "; ".join(said) or None


def _outside(result: Result) -> str:
    law = result.scene.effects.rolling_law
    if law not in FITTED or "contacts" not in result.groups:
        return ""
    low, high = FITTED[law]
    found = load_groups(result)
    if not found.size or (low <= found.min() and found.max() <= high):
        return ""
    share = 100.0 * float(np.mean((found < low) | (found > high)))
    return (
        f"the law of rolling resistance, {law}, was fitted to loads W = Q/(l E' Re) of {low:g} to {high:g}; "
        f"{share:.3g} % of the loaded contacts lie outside, W is {found.min():.2g} to {found.max():.2g}. At W of 2.8e-5 "
        "to 1e-4 independent laws give 1.7 to 1.9 times as much: compare effects.rolling_law = 'biboulet_houpert'"
    )


def _tilted(scene: Scene) -> str:
    if not any(
        value for quantity in (scene.misalignment_x, scene.misalignment_y) for value in values_of(quantity or 0.0)
    ):
        return ""
    return (
        "rolling resistance acts on the loaded part of each contact only: with a tilted ring the torque is a lower bound where "
        "the gaps beside it are full of oil"
    )
