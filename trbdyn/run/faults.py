"""What a run says of steps that failed or that mean nothing: the body at fault, rollers that touch each other."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import StepError

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation
    from trbdyn.statics.seat import Layout, SeatedBearing

Array = NDArray[np.float64]


def culprit(text: str) -> tuple[str | None, str | None]:
    """Body and quantity named at the end of the core's message."""
    _, _, named = text.partition("largest error: ")
    body, _, quantity = named.partition(", ")
    return (body or None, quantity or None) if quantity else (None, None)


def check_apart(sim: Simulation, bearing: SeatedBearing, layout: Layout, records: Array) -> None:
    """Rollers without a cage must not touch each other, as nothing in the model keeps them apart."""
    places = {name: (offset, shape) for name, offset, shape in layout}
    offset, (count,) = places["roller_orbit_angle"]
    angles = np.sort(np.mod(records[:, offset : offset + count], 2.0 * math.pi), axis=1)
    gaps = np.diff(np.concatenate([angles, angles[:, :1] + 2.0 * math.pi], axis=1), axis=1)
    sizes = bearing.scene.bearing
    nearest = sizes.pitch_diameter * np.sin(0.5 * gaps.min(axis=1))
    if float(nearest.min()) < sizes.roller.diameter:
        raise StepError(
            f"{bearing.said}two rollers touch before {sim.time:.6g} s: without a cage nothing in the model keeps them apart; "
            "shorten the run or give effects.bodies = 'rollers_and_spacer' or 'rollers_and_cage'",
            time=sim.time,
            body="rollers",
            quantity="spacing",
        )
