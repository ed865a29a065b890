"""What a summary says beside its numbers: where a law is used that was not made for these loads and oils, why the torques of the
rings differ, and how far a largest force would scatter.

After a load that drops and comes back the largest pocket force is one draw among many: a drop lets the rollers leave their order,
and where each of them is when the load comes back decides which hit is the hardest. How far other starts and other accuracies
scatter was measured in 72 runs of a 30310 (docs/howto/loads.md).
"""

from __future__ import annotations

import json
import math
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from trbdyn.base.shipped import DATA
from trbdyn.model.motion import History, values_of

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene
    from trbdyn.results.records import Records

RINGS_DIFFER: Final = 0.01
"""Share by which the torques of the two rings may differ without a word."""
DROP: Final = 0.5
"""Share of its largest value below which a load has dropped."""


class Range(NamedTuple):
    """Loads and oils that a law was made for: smallest and largest load group W = Q/(l E' Re), and material group G = alpha0
    E'.
    """

    load: tuple[float, float]
    material: tuple[float, float]


RANGES: Final = {
    "zhou_hoeprich": Range((1e-4, 3.5e-4), (3000.0, 4500.0)),
    "goksem_hargreaves": Range((1e-5, 3.5e-4), (2500.0, 6000.0)),
    "aihara": Range((2.8e-5, 1e-4), (2500.0, 6000.0)),
    "matsuyama": Range((2.8e-5, 3.5e-4), (2500.0, 6000.0)),
    "biboulet_houpert": Range((2e-7, 3.5e-4), (1000.0, 6000.0)),
    "line_solution": Range((2e-7, 3.5e-4), (1000.0, 6000.0)),
}
"""By the name in `Effects.rolling_law`: for 'zhou_hoeprich' that of its data, for the others where they were compared with a
numerical solution (docs/theory/lubrication.md#which-law-of-rolling-resistance)."""


def load_groups(result: Records) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The load group W of every roller's contact with a raceway that carries, at every record; needs the group contacts."""
    geometry, length = result.scene.bearing.geometry, result.scene.bearing.roller.effective_length
    groups = [
        np.ravel(result[f"{side}_load"]) / (length * geometry.effective_modulus * radius)
        for side, radius in (("outer", geometry.outer_equivalent_radius), ("inner", geometry.inner_equivalent_radius))
    ]
    found = np.concatenate(groups)
    return found[found > 0.0]


def rolling_note(result: Records) -> str | None:
    """What the law of rolling resistance is used for, in the part of a run that averages are taken of, that it was not made
    for; None where it is not. Needs the group contacts.
    """
    scene = result.scene
    if not (scene.effects.rolling_resistance and scene.effects.films):
        return None
    said = [text for text in (_outside(result), _tilted(scene)) if text]
    return "; ".join(said) or None


def _outside(result: Records) -> str:
    law, scene = result.scene.effects.rolling_law, result.scene
    (low, high), (thin, thick) = RANGES[law]
    said = []
    material = scene.lubricant.pressure_coefficient * scene.bearing.geometry.effective_modulus
    if not thin <= material <= thick:
        said.append(f"G = alpha0 E' is {material:.4g}")
    if "contacts" in result.groups:
        found = load_groups(result)
        share = 100.0 * float(np.mean((found < low) | (found > high))) if found.size else 0.0
        if share > 0.0:
            where = f"{found.min():.2g} to {found.max():.2g}"
            said.append(f"{share:.3g} % of the loaded contacts lie outside, W is {where}")
    if not said:
        return ""
    return (
        f"the law of rolling resistance, {law}, holds for loads W = Q/(l E' Re) of {low:g} to {high:g} and for G of "
        f"{thin:g} to {thick:g}; {' and '.join(said)}: see effects.rolling_law"
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


def torque_note(window: Records, inner: float, outer: float) -> str | None:
    """Why the friction torques on shaft and outer ring (N m) differ, in a sentence; None if they agree."""
    if abs(outer - inner) <= RINGS_DIFFER * max(abs(inner), abs(outer)):
        return None
    effects = window.scene.effects
    if effects.films and effects.rolling_resistance and not effects.rolling_pressure_force:
        return (
            "rolling resistance acts without the film's pressure force on the roller, as in the paper, so moments on a roller "
            "balance only if its raceways carry different torques; the standard effects have that force, and both rings agree"
        )
    return (
        "rollers and cage speed up or slow down within the window, "
        "or a moment acts that is neither on the shaft nor on the ring"
    )


@cache
def drop_measured() -> dict[str, Any]:
    """What was measured: `scatter`, the standard deviation of the logarithm of the peak over starts and accuracies; `text`."""
    found: dict[str, Any] = json.loads((DATA / "accuracy.json").read_text(encoding="utf-8"))["load_drop"]
    return found


def drop_band(peak: float) -> tuple[float, float]:
    """Between which forces (N) the peak of a run with another start or accuracy lies in 95 of 100 cases."""
    factor = math.exp(1.96 * math.sqrt(2.0) * float(drop_measured()["scatter"]))  # both peaks are draws
    return peak / factor, peak * factor


def load_drops(window: Records) -> bool:
    """Whether the axial or the radial load changes in time and falls, within the window, below a share of its largest value."""
    scene, time = window.scene, window["time"]
    for load in (scene.axial_load, scene.radial_load):
        if isinstance(load, History):
            values = np.abs(load.value(time))
            if values.min() < DROP * values.max():
                return True
    return False
