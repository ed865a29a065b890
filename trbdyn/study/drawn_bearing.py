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
from typing import Any

from trbdyn.model.catalogue_rollers import FILL

WHOLE = 1e-6
"""What a number of rollers may be below a whole one by rounding."""

LINE, LENGTH = "bearing.roller.effective_length", "bearing.roller.total_length"
COUNT, DIAMETER, PITCH = "bearing.n_rollers", "bearing.roller.diameter", "bearing.pitch_diameter"
MASS, AXIAL, TRANSVERSE = "bearing.cage.mass", "bearing.cage.inertia_axial", "bearing.cage.inertia_transverse"


def belongs_together(
    bearing: Any, drawn: Mapping[str, Any], bands: Mapping[str, tuple[float, float, float]]
) -> dict[str, Any]:
    """Inputs of a draw, with those that follow from others put right.

    Parameters
    ----------
    bearing : mapping
        The bearing's table in the base of a study.
    drawn : mapping of str to number
        Inputs of the draw, each drawn by itself.
    bands : mapping of str to tuple
        Both ends of the band of each input, and how far between them it was drawn (0 to 1). A band that is not the one of
        the estimate is somebody's knowledge, and what was drawn from it stays.

    Returns
    -------
    dict
        The inputs of the draw, and estimates that were not drawn and follow from them.
    """
    found = dict(drawn)
    roller = bearing.get("roller") if isinstance(bearing, Mapping) else None
    if not isinstance(roller, Mapping):
        return found
    estimates = {f"bearing.{entry['path']}": entry for entry in bearing.get("estimates") or ()}
    free = {path for path, entry in estimates.items() if bands.get(path, ())[:2] == (entry["low"], entry["high"])}
    whole = roller.get("total_length")
    if LINE in drawn and whole is not None and (LENGTH not in drawn or LENGTH in free):
        found[LENGTH] = drawn.get(LENGTH, whole) + drawn[LINE] - roller["effective_length"]
    if COUNT in free:
        share = FILL.low + bands[COUNT][2] * (FILL.high - FILL.low)
        found[COUNT] = _whole(_around(bearing, drawn), share)
    elif COUNT in estimates and COUNT not in drawn and not drawn.keys().isdisjoint((DIAMETER, PITCH)):
        found[COUNT] = _whole(_around(bearing, drawn), bearing["n_rollers"] / _around(bearing, {}))
    if not free.isdisjoint({AXIAL, TRANSVERSE}) and {AXIAL, TRANSVERSE} <= estimates.keys():
        heavier = drawn[MASS] / estimates[MASS]["value"] if MASS in free else 1.0
        axial, transverse = (drawn.get(name, estimates[name]["value"]) for name in (AXIAL, TRANSVERSE))
        along = transverse - 0.5 * estimates[AXIAL]["value"]  # what the distances along the axis make
        found[AXIAL] = heavier * axial
        found[TRANSVERSE] = heavier * (0.5 * axial + along * (_width(roller, found) / _width(roller, {})) ** 2)
    return found


def _around(bearing: Mapping[str, Any], drawn: Mapping[str, Any]) -> float:
    """How many rollers would fill the pitch circle."""
    pitch, diameter = drawn.get(PITCH, bearing["pitch_diameter"]), drawn.get(DIAMETER, bearing["roller"]["diameter"])
    return float(math.pi * pitch / diameter)


def _width(roller: Mapping[str, Any], drawn: Mapping[str, Any]) -> float:
    """Half of what the cage takes along the rollers' axis at most (m), as `trbdyn.model.cage_space` has it."""
    length = drawn.get(LENGTH, roller.get("total_length") or roller["effective_length"])
    return float(0.5 * length + drawn.get(DIAMETER, roller["diameter"]))


def _whole(around: float, share: float) -> int:
    """The whole number next to a share of the rollers that would fill the pitch circle, within the usual shares if one is."""
    least = math.ceil(around * min(FILL.low, share) - WHOLE)
    most = math.floor(around * max(FILL.high, share) + WHOLE)
    return max(3, min(max(round(around * share), least), most))
