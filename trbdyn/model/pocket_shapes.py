"""Builders of pockets: each gives a list of faces for a bearing's roller and clearances
(docs/theory/geometry.md#pockets-and-plays).

The bars of the default pocket are flat faces parallel to the roller's flank. A bar at the side +-t meets the flank in
the direction m = cos(gamma) (+-t) + sin(gamma) n around the roller's axis; N = cos(nu) m - sin(nu) a is the flank's
normal there. gamma follows from the two plays: a cage that moves radially inward by Cpr, or circumferentially by Cpc,
just closes the normal gap g = Cpc cos(nu) cos(gamma).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.model.pocket import Face, Pocket

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

LEADING_BAR, TRAILING_BAR, LARGE_END_WALL, SMALL_END_WALL = 0, 1, 2, 3
LARGEST_LEAN_DEG = 80.0
"""Largest lean of a bar (deg): beyond it nothing would hold the roller in its pocket."""
SIDES = {"leading": 1.0, "trailing": -1.0}
FloatArray = NDArray[np.float64]
Outline = list[tuple[float, float]]

__all__ = [
    "SHAPES",
    "bar_lean",
    "chamfered_pocket",
    "default_pocket",
    "drafted_pocket",
    "large_end_wall",
    "one_sided_pocket",
    "relieved_pocket",
    "small_end_wall",
    "stepped_pocket",
]


def __dir__() -> list[str]:
    return sorted(__all__)


def bar_lean(bearing: Bearing) -> float:
    """gamma: lean of the bars from the circumferential direction that gives the plays Cpr and Cpc (rad).

    It solves sin(gamma) cos(alpha_m) - tan(nu) sin(alpha_m) = (Cpc/Cpr) cos(gamma).

    Raises
    ------
    InputError
        If no bar can give these plays.
    """
    geometry, cage = bearing.geometry, bearing.cage
    ratio = cage.play_circumferential / cage.play_radial
    amplitude = math.hypot(math.cos(geometry.roller_axis_angle), ratio)
    sine = math.tan(geometry.roller_half_angle) * math.sin(geometry.roller_axis_angle) / amplitude
    if sine >= 1.0:
        raise InputError.of("play_radial", cage.play_radial, "clearances do not fit: no bar gives this radial play (m)")
    lean = math.atan2(ratio, math.cos(geometry.roller_axis_angle)) + math.asin(sine)
    if math.degrees(lean) > LARGEST_LEAN_DEG:
        limit = (
            f"clearances do not fit: with play_radial = {cage.play_radial:g} m the bars would lean by "
            f"{math.degrees(lean):.3g} deg, {LARGEST_LEAN_DEG:g} deg at most; less circumferential play, or more radial (m)"
        )
        raise InputError.of("play_circumferential", cage.play_circumferential, limit)
    return lean


def default_pocket(bearing: Bearing) -> Pocket:
    """The pocket of the test bearing: two bars and two end walls.

    Slots: 0 leading bar (+t), 1 trailing bar (-t), 2 large-end wall, 3 small-end wall.
    """
    return drafted_pocket(bearing, math.degrees(bar_lean(bearing)))


def drafted_pocket(bearing: Bearing, lean_deg: float) -> Pocket:
    """Bars that lean by a free angle; the circumferential play stays Cpc, the radial play follows.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    lean_deg : float
        Angle of the contact line around the roller, from the circumferential direction outward (deg), -80 to 80.
    """
    lean = math.radians(number_of("lean_deg", lean_deg, "deg", ge=-LARGEST_LEAN_DEG, le=LARGEST_LEAN_DEG))
    half = 0.5 * bearing.roller.effective_length
    bars = [_bar(bearing, side, lean, _box(-half, half, 0.5 * bearing.cage.bar_width)) for side in SIDES]
    return Pocket(faces=(*bars, large_end_wall(bearing), small_end_wall(bearing)))


def stepped_pocket(bearing: Bearing, step: float = 5e-5, split: float = 0.5) -> Pocket:
    """Bars in two steps: the large-end part stands back.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    step : float
        How far the large-end part stands back (m).
    split : float
        Share of the bar's length that the small-end part takes, 0.05 to 0.95.
    """
    step = number_of("step", step, "m", ge=0.0, le=1e-2)
    split = number_of("split", split, "1", ge=0.05, le=0.95)
    half, half_width = 0.5 * bearing.roller.effective_length, 0.5 * bearing.cage.bar_width
    border = half * (2.0 * split - 1.0)
    parts = [
        ("", 0, _box(-half, border, half_width), 0.0),
        ("_step", 4, _box(border, half, half_width), step),
    ]
    return _pocket_of_lands(bearing, parts)


def relieved_pocket(bearing: Bearing, relief: float = 0.5) -> Pocket:
    """Bars with a relief in the middle: the flank meets two lands at the ends.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    relief : float
        Share of the bar's length that is relieved, 0.05 to 0.95.
    """
    relief = number_of("relief", relief, "1", ge=0.05, le=0.95)
    half, half_width = 0.5 * bearing.roller.effective_length, 0.5 * bearing.cage.bar_width
    parts = [
        ("", 0, _box(-half, -relief * half, half_width), 0.0),
        ("_large_end_land", 4, _box(relief * half, half, half_width), 0.0),
    ]
    return _pocket_of_lands(bearing, parts)


def chamfered_pocket(bearing: Bearing, chamfer: float = 1e-3) -> Pocket:
    """Bars whose corners are cut: octagons.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    chamfer : float
        Length cut from each side at a corner (m).
    """
    half, half_width = 0.5 * bearing.roller.effective_length, 0.5 * bearing.cage.bar_width
    cut = number_of("chamfer", chamfer, "m", ge=1e-6, le=0.98 * min(half, half_width))
    inner, narrow = half - cut, half_width - cut
    outline = [
        (-inner, -half_width),
        (inner, -half_width),
        (half, -narrow),
        (half, narrow),
        (inner, half_width),
        (-inner, half_width),
        (-half, narrow),
        (-half, -narrow),
    ]
    return _pocket_of_lands(bearing, [("", 0, outline, 0.0)])


def one_sided_pocket(bearing: Bearing, missing: str = "leading") -> Pocket:
    """The default pocket without one of its bars, 'leading' or 'trailing'."""
    if not isinstance(missing, str) or missing not in SIDES:
        raise InputError.of("missing", missing, "must be 'leading' or 'trailing'")
    return default_pocket(bearing).without(f"{missing}_bar")


def large_end_wall(bearing: Bearing) -> Face:
    """Wall behind the large end, perpendicular to the roller's axis; the nominal sphere just touches its nearest
    edge.
    """
    geometry, cage = bearing.geometry, bearing.cage
    place = geometry.sphere_centre - geometry.apex_to_mid + math.sqrt(geometry.sphere_radius**2 - cage.wall_inner**2)
    low, high, half = cage.wall_inner, cage.wall_outer, cage.wall_half_width
    return Face(
        name="large_end_wall",
        slot=LARGE_END_WALL,
        part="large_end",
        origin=(0.0, 0.0, place),
        u=(0.0, 1.0, 0.0),
        v=(1.0, 0.0, 0.0),
        outline=((-half, low), (half, low), (half, high), (-half, high)),
    )


def small_end_wall(bearing: Bearing) -> Face:
    """Wall before the small end, perpendicular to the roller's axis: the part of the band that the roller's end covers.

    A cage that moves along the roller's axis towards its large end by the axial play closes it. Corners outside the
    roller's end are moved in along t.
    """
    geometry, cage = bearing.geometry, bearing.cage
    if cage.wall_outer >= geometry.small_end_radius:
        limit = f"must be < radius of the roller's small end, {geometry.small_end_radius:.6g} (m)"
        raise InputError.of("wall_outer", cage.wall_outer, limit)

    def half_width(n: float) -> float:
        return min(cage.wall_half_width, math.sqrt(geometry.small_end_radius**2 - n**2))

    low, high = cage.wall_inner, cage.wall_outer
    return Face(
        name="small_end_wall",
        slot=SMALL_END_WALL,
        part="small_end",
        origin=(0.0, 0.0, geometry.small_end_station - cage.play_axial),
        u=(1.0, 0.0, 0.0),
        v=(0.0, 1.0, 0.0),
        outline=((low, -half_width(low)), (high, -half_width(high)), (high, half_width(high)), (low, half_width(low))),
    )


def _pocket_of_lands(bearing: Bearing, parts: list[tuple[str, int, Outline, float]]) -> Pocket:
    """Bars made of lands (suffix of the name, first slot, outline, how far it stands back), and the two end walls."""
    lean = bar_lean(bearing)
    bars = [
        _bar(bearing, side, lean, outline, suffix=suffix, slot=slot + number, back=back)
        for suffix, slot, outline, back in parts
        for number, side in enumerate(SIDES)
    ]
    return Pocket(faces=(*bars, large_end_wall(bearing), small_end_wall(bearing)))


def _bar(
    bearing: Bearing,
    side: str,
    lean: float,
    outline: Outline,
    *,
    suffix: str = "",
    slot: int | None = None,
    back: float = 0.0,
) -> Face:
    """A flat face parallel to the roller's flank at a side; `outline` is along the generator and across it."""
    half_angle = bearing.geometry.roller_half_angle
    around = np.array([math.sin(lean), SIDES[side] * math.cos(lean), 0.0])
    axis = np.array([0.0, 0.0, 1.0])
    outward = math.cos(half_angle) * around - math.sin(half_angle) * axis
    along = math.cos(half_angle) * axis + math.sin(half_angle) * around
    gap = bearing.cage.play_circumferential * math.cos(half_angle) * math.cos(lean) + back
    return Face(
        name=f"{side}_bar{suffix}",
        slot=(LEADING_BAR if side == "leading" else TRAILING_BAR) if slot is None else slot,
        part="flank",
        origin=tuple(0.5 * bearing.roller.diameter * around + gap * outward),
        u=tuple(along),
        v=tuple(np.cross(-outward, along)),
        outline=tuple(outline),
    )


def _box(start: float, end: float, half_width: float) -> Outline:
    return [(start, -half_width), (end, -half_width), (end, half_width), (start, half_width)]


SHAPES: dict[str, Callable[..., Pocket]] = {
    "default": default_pocket,
    "drafted": drafted_pocket,
    "stepped": stepped_pocket,
    "relieved": relieved_pocket,
    "chamfered": chamfered_pocket,
    "one_sided": one_sided_pocket,
}
