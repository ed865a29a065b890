"""Estimates of a catalogue bearing that belong together are drawn together: each draw is a bearing that can be built.

Bands of estimates are given one by one. If each were drawn by itself, a large number of rollers, as there are of thin
ones, would meet thick ones, which overlap, and a light cage would have the moments of inertia of a heavy one. So what an
estimate follows from is kept in each draw:

- the number of rollers is drawn by the share of the pitch circle that they take, and follows their size where it is not drawn;
- a roller is longer than its contact line by what was drawn for both;
- the cage's moments of inertia are drawn for its mass, and the one across its axis for the size of its rollers as well.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final, TypeVar

from trbdyn.model.bearing import Bearing
from trbdyn.model.catalogue_rollers import CYLINDRICAL, FILL_BAND, TAPERED, Usual

V = TypeVar("V")

WHOLE: Final = 1e-6
"""What a number of rollers may be below a whole one by rounding."""
LINE, LENGTH = "bearing.roller.effective_length", "bearing.roller.total_length"
COUNT, DIAMETER, PITCH = "bearing.n_rollers", "bearing.roller.diameter", "bearing.pitch_diameter"
MASS, AXIAL, TRANSVERSE = "bearing.cage.mass", "bearing.cage.inertia_axial", "bearing.cage.inertia_transverse"


def belongs_together(
    bearing: Bearing, drawn: Mapping[str, Any], bands: Mapping[str, tuple[float, float, float]], prefix: str = ""
) -> dict[str, Any]:
    """Inputs of a draw, with those that follow from others put right, and estimates that were not drawn and follow from them.
    What is known of the bearing, and is no estimate, stays.

    `bands` holds both ends of the band of each input, and how far between them it was drawn (0 to 1). A band that is not the
    one of the estimate is somebody's knowledge, and what was drawn from it stays. Paths that do not begin with `prefix` are
    left out.
    """
    drawn, bands = _own(prefix, drawn), _own(prefix, bands)
    found, cage = dict(drawn), bearing.cage
    estimates = {f"bearing.{entry.path}": entry for entry in bearing.estimated}
    free = {path for path, entry in estimates.items() if bands.get(path, ())[:2] == (entry.low, entry.high)}
    whole = bearing.inputs()["roller"].get("total_length")
    if LINE in drawn and whole is not None and (LENGTH not in drawn or LENGTH in free):
        found[LENGTH] = drawn.get(LENGTH, whole) + drawn[LINE] - bearing.roller.effective_length
    usual = TAPERED.fill
    if bearing.is_cylindrical:
        usual = CYLINDRICAL.fill.around(bearing.n_rollers / _around(bearing, {}), FILL_BAND)
    if COUNT in free:
        share = usual.low + bands[COUNT][2] * (usual.high - usual.low)
        found[COUNT] = _whole(_around(bearing, drawn), share, usual)
    elif COUNT in estimates and COUNT not in drawn and not drawn.keys().isdisjoint((DIAMETER, PITCH)):
        found[COUNT] = _whole(_around(bearing, drawn), bearing.n_rollers / _around(bearing, {}), usual)
    if not free.isdisjoint((AXIAL, TRANSVERSE)):
        heavier = drawn[MASS] / cage.mass if MASS in free else 1.0
        if AXIAL in estimates:
            found[AXIAL] = heavier * drawn.get(AXIAL, cage.inertia_axial)
        if TRANSVERSE in estimates:
            # by distances along the axis, which are small in narrow cages and never below none
            along = max(drawn.get(TRANSVERSE, cage.inertia_transverse) - 0.5 * cage.inertia_axial, 0.0)
            wider = _width(bearing, found) / _width(bearing, {})
            found[TRANSVERSE] = 0.5 * found.get(AXIAL, cage.inertia_axial) + heavier * along * wider**2
    return {f"{prefix}{path}": value for path, value in found.items()}


def _own(prefix: str, by_path: Mapping[str, V]) -> dict[str, V]:
    """What belongs to the bearing whose paths begin with a prefix, by paths without it."""
    return {path.removeprefix(prefix): value for path, value in by_path.items() if path.startswith(f"{prefix}bearing.")}


def _around(bearing: Bearing, drawn: Mapping[str, Any]) -> float:
    """How many rollers would fill the pitch circle."""
    pitch, diameter = drawn.get(PITCH, bearing.pitch_diameter), drawn.get(DIAMETER, bearing.roller.diameter)
    return float(math.pi * pitch / diameter)


def _width(bearing: Bearing, drawn: Mapping[str, Any]) -> float:
    """Half of what the cage takes along the rollers' axis at most (m), as `trbdyn.model.cage_space` has it."""
    length, diameter = drawn.get(LENGTH, bearing.roller.total_length), drawn.get(DIAMETER, bearing.roller.diameter)
    return float(0.5 * length + diameter)


def _whole(around: float, share: float, usual: Usual) -> int:
    """The whole number next to a share of the rollers that would fill the pitch circle, within the usual shares if one is."""
    least = math.ceil(around * min(usual.low, share) - WHOLE)
    most = math.floor(around * max(usual.high, share) + WHOLE)
    return max(3, min(max(round(around * share), least), most))
