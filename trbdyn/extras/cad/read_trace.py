"""The profile of a roller or raceway from a measured trace or a drawn line (docs/theory/geometry.md#measured-profiles)."""

from __future__ import annotations

import math
import os
from typing import Final, Literal, get_args

import numpy as np
import scipy
from numpy.typing import NDArray

from trbdyn.base.reading import MOST_POINTS
from trbdyn.base.validation import number_of
from trbdyn.errors import FileError, InputError
from trbdyn.extras.cad.trace_file import points_of
from trbdyn.model.trace import Trace

Array = NDArray[np.float64]
Level = Literal["line", "mean"]
LargeEnd = Literal["last", "first"]
Side = Literal["below", "above"]

STATIONS: Final = 81
"""Places of the table, closer together towards the ends, where profiles drop."""
FEWEST: Final = 50
"""Fewest points of a measured trace along the effective length."""
SIGMA: Final = math.sqrt(0.5 * math.log(2.0)) / math.pi
"""Standard deviation of the Gaussian weights over the cut-off: half of an amplitude of this wavelength passes (ISO 16610-21)."""
SPIKE: Final = 6.0
"""An outlier is further from the median of its neighbours than this many standard deviations of the rest."""
SHORT: Final = 5e-3
"""Part of the effective length that a trace may lack, both ends together."""
NORMAL_90: Final = 1.645
"""90 % of normal deviations are within this many standard deviations."""
FLATTEST, DEEPEST = 50e-9, 0.01
"""Least spread of heights (m), and most of it over the effective length: beyond, a unit is wrong."""
SMALLEST: Final = 10e-9
"""Heights that no instrument tells apart on a rough surface (m)."""
CELLS: Final = 400
"""Cells along the effective length, whose medians have the robust line."""


MOST_WITHIN: Final = 5000
"""Most points within the cut-off: the filter's time grows with them."""


def read_trace(
    path: str | os.PathLike[str],
    effective_length: float,
    *,
    position_unit: str | None = None,
    height_unit: str | None = None,
    level: Level = "line",
    cutoff: float = 0.25e-3,
    centre: float | None = None,
    large_end: LargeEnd = "last",
    material: Side = "below",
    hollow: bool = False,
    magnification: float = 1.0,
    layer: str | None = None,
) -> Trace:
    """The profile of a roller or raceway from a measured trace, or from a line drawn in a DXF file.

    A measured trace is levelled by a robust line (Theil and Sen), points that stick out of their neighbours are left out, and the
    roughness is taken out by the Gaussian filter of ISO 16610-21. Of a drawn line only the slope is taken out.

    Parameters
    ----------
    path : path-like
        CSV file of two columns, position and height, separated by comma, semicolon, tab or spaces; lines of text above them may
        name the units, as in ``position_mm,height_um`` or ``X [mm];Z [µm]``. Or a DXF file (``.dxf``; it needs the extra
        ``trbdyn[cad]``) with the profile as lines, polylines, arcs, ellipses or splines that join.
    effective_length : float
        Effective length of the contact line (m). What is measured beyond it, such as chamfers, is left out.
    position_unit, height_unit : {'nm', 'um', 'mm', 'cm', 'm', 'inch'}, optional
        Units, where the file names none.
    level : {'line', 'mean'}
        What is taken out: a line, or the height alone, where the slope belongs to the profile.
    cutoff : float
        Cut-off wavelength of the filter (m); 0.25 mm is that of surfaces with Ra up to 0.1 µm (ISO 4288).
    centre : float, optional
        Position of mid length in the file (m); the middle of the trace by default.
    large_end : {'last', 'first'}
        At which end of the positions, ascending, the rollers' large end is.
    material : {'below', 'above'}
        On which side of the heights, upwards positive, the material is.
    hollow : bool
        Whether the ends may be higher than the middle.
    magnification : float
        Times that heights are drawn larger than positions (1).
    layer : str, optional
        Layer of a DXF file that has the profile.

    Returns
    -------
    Trace

    Raises
    ------
    InputError
        If an argument is not allowed, or does not fit to the file.
    FileError
        If the file cannot be read or used; the message has the reason.
    ImportError
        If a DXF file is given and ezdxf is not installed.

    Examples
    --------
    >>> import numpy as np, tempfile, pathlib, trbdyn as trb
    >>> x = np.linspace(-10e-3, 10e-3, 2001)
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "roller.csv"
    >>> np.savetxt(file, np.c_[1e3 * x, -1e6 * x**2 / 60], delimiter=",", header="x_mm,z_um", comments="")
    >>> trace = trb.read_trace(file, 20e-3)
    >>> round(1e6 * trace.drops[-1], 2)
    1.66
    """
    _check(effective_length, cutoff, magnification, level, large_end, material)
    drawn = os.fspath(path).lower().endswith(".dxf")
    if drawn and centre is not None:
        raise InputError.of("centre", centre, "must not be given for a drawn line, whose middle is mid length")
    x, z = points_of(path, position_unit=position_unit, height_unit=height_unit, layer=layer)
    z = z / magnification * (1.0 if material == "below" else -1.0)
    turned = 0.0
    if drawn and level == "line":
        x, z, turned = _along_chord(x, z)
    x, z = _one_pass(x, z, path)
    if large_end == "first":
        x, z = -x[::-1], z[::-1]
        centre, turned = None if centre is None else -centre, -turned
    x = x - (0.5 * (x[0] + x[-1]) if centre is None else centre)
    half = 0.5 * effective_length
    _check_length(x, half, path)
    if level == "line":
        x, z, angle = _levelled(x, z, half)
        turned += angle
        if np.any(np.diff(x) <= 0.0):
            raise FileError(f"{path}: the line is too steep somewhere: levelled, it turns back; is height_unit right?")
        _check_length(x, half, path)
    inside = np.abs(x) <= (1.0 + SHORT if drawn else 1.0) * half
    points, raw = x[inside], z[inside]
    outlier, roughness = np.zeros(points.size, dtype=bool), 0.0
    if not drawn:
        _check_points(points, raw, cutoff, path)
        outlier = _outliers(points, raw, cutoff)
        x, z, roughness = _filtered(points[~outlier], raw[~outlier], cutoff)
    stations = half * np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, STATIONS))
    heights = np.interp(stations, x, z)
    _check_heights(heights, effective_length, roughness, hollow, path)
    return Trace(
        stations=stations,
        drops=heights.max() - heights,
        points=points,
        heights=raw - heights.max(),
        outlier=outlier,
        angle_deg=math.degrees(turned),
        roughness=roughness,
        path=os.fspath(path),
        cutoff=0.0 if drawn else cutoff,
        left_out=int(np.count_nonzero(~inside)),
    )


def _check(
    length: object, cutoff: object, magnification: object, level: object, large_end: object, material: object
) -> None:
    for name, value, least, most, unit in (
        ("effective_length", length, 1e-4, 1.0, "m"),
        ("cutoff", cutoff, 1e-6, 1e-2, "m"),
        ("magnification", magnification, 1e-3, 1e6, "1"),
    ):
        number_of(name, value, unit, ge=least, le=most)
    for name, value, kinds in (
        ("level", level, Level),
        ("large_end", large_end, LargeEnd),
        ("material", material, Side),
    ):
        if value not in get_args(kinds):
            raise InputError.of(name, value, f"must be {' or '.join(map(repr, get_args(kinds)))}")


def _along_chord(x: Array, z: Array) -> tuple[Array, Array, float]:
    """A drawn line turned so that its ends have the same height, the end on the left first; and the angle (rad)."""
    if (x[-1], z[-1]) < (x[0], z[0]):
        x, z = x[::-1], z[::-1]
    angle = math.atan2(z[-1] - z[0], x[-1] - x[0])
    turned = (x + 1j * z) * np.exp(-1j * angle)
    return turned.real, turned.imag, angle


def _one_pass(x: Array, z: Array, path: object) -> tuple[Array, Array]:
    """Points in ascending order."""
    steps = np.diff(x)
    if np.all(steps < 0.0):
        return x[::-1], z[::-1]
    if np.any(wrong := steps <= 0.0):
        backward = int(np.count_nonzero(steps < 0.0))
        if backward:
            place = int(np.argmax(wrong)) + 1
            raise FileError(
                f"{path}: positions turn back, first at point {place + 1} ({1e3 * x[place]:.5g} mm), in {backward} of "
                f"{steps.size} steps: two passes, or a line that turns back; one pass from end to end must be given"
            )
        place = int(np.argmax(wrong))
        raise FileError(
            f"{path}: position {1e3 * x[place]:.6g} mm is there twice: one height for each position must be given"
        )
    return x, z


def _check_length(x: Array, half: float, path: object) -> None:
    low, high = 1e3 * float(x[0]), 1e3 * float(x[-1])
    need = 1e3 * half
    covered = f"{path}: goes from {low:.5g} to {high:.5g} mm from mid length; the effective length, {-need:.5g} to {need:.5g} mm,"
    if low > -(1.0 - SHORT) * need or high < (1.0 - SHORT) * need:
        raise FileError(
            f"{covered} must be covered: a longer trace, another centre or effective_length, or another position_unit"
        )
    if high - low > 6.0 * need:
        raise FileError(f"{covered} is less than a third of it: is position_unit right?")


def _levelled(x: Array, z: Array, half: float) -> tuple[Array, Array, float]:
    """Points turned about mid length by the angle (rad) of the median slope (Theil and Sen) of medians of cells.

    The line of a profile that is the same on both sides has no slope, and up to 29 % of outliers turn it little.
    """
    edges = np.linspace(max(-half, x[0]), min(half, x[-1]), CELLS + 1)
    middles = 0.5 * (edges[1:] + edges[:-1])
    slope = float(scipy.stats.theilslopes(np.interp(middles, x, z), middles).slope)
    medians = scipy.stats.binned_statistic(x, z - slope * x, "median", edges).statistic
    held = np.isfinite(medians)
    if np.count_nonzero(held) > CELLS // 2:  # points are dense enough to take noise out first
        slope += float(scipy.stats.theilslopes(medians[held], middles[held]).slope)
    angle = math.atan(slope)
    turned = (x + 1j * (z - np.interp(0.0, x, z))) * np.exp(-1j * angle)
    return turned.real, turned.imag, angle


def _check_points(x: Array, z: Array, cutoff: float, path: object) -> None:
    if x.size < FEWEST:
        raise FileError(f"{path}: has {x.size} points along the effective length; at least {FEWEST} must be given")
    steps = np.diff(x)
    if (typical := float(np.median(steps))) > 0.25 * cutoff:
        raise FileError(
            f"{path}: has a point every {1e3 * typical:.3g} mm: at most a quarter of the cut-off, {250.0 * cutoff:.3g} mm, "
            "must be between them; a longer cutoff takes fewer points"
        )
    if (x[-1] - x[0]) / typical > MOST_POINTS or cutoff / typical > MOST_WITHIN:
        raise FileError(
            f"{path}: most points lie {1e9 * typical:.3g} nm apart, so that the filter would need "
            f"{(x[-1] - x[0]) / typical:.3g} points, or {cutoff / typical:.3g} within its cut-off; thin the trace to even steps"
        )
    if (widest := float(steps.max())) > cutoff:
        place = 1e3 * x[int(np.argmax(steps))]
        raise FileError(
            f"{path}: a gap of {1e3 * widest:.3g} mm at {place:.4g} mm from mid length is longer than the cut-off"
        )
    if np.ptp(z) < FLATTEST:
        raise FileError(
            f"{path}: all heights lie within {1e9 * np.ptp(z):.3g} nm, flatter than any ground surface: is height_unit right?"
        )


def _outliers(x: Array, z: Array, cutoff: float) -> NDArray[np.bool_]:
    """Points that stick out of the median of those within half of the cut-off by more than `SPIKE` standard deviations."""
    window = 2 * max(2, round(0.5 * cutoff / float(np.median(np.diff(x))))) + 1
    ends = [
        2.0 * np.median(end[:5]) - end[window:0:-1] for end in (z, z[::-1])
    ]  # continued with the slope that it has there
    median = scipy.ndimage.median_filter(np.concatenate([ends[0], z, ends[1][::-1]]), window)[window:-window]
    rest = z - median
    spread = float(np.percentile(np.abs(rest), 90.0)) / NORMAL_90
    return np.asarray(np.abs(rest) > SPIKE * max(spread, SMALLEST))


def _filtered(x: Array, z: Array, cutoff: float) -> tuple[Array, Array, float]:
    """The trace at even steps without its roughness, and Rq of that (m).

    The mean with Gaussian weights; at the ends, where weights are missing on one side, the line with these weights, which is the
    mean elsewhere (moments kept, ISO 16610-28).
    """
    even = np.linspace(x[0], x[-1], 1 + math.ceil((x[-1] - x[0]) / float(np.median(np.diff(x)))))
    height, place = np.interp(even, x, z), np.arange(even.size, dtype=float)
    sigma = SIGMA * cutoff / float(even[1] - even[0])

    def weighted(values: Array) -> Array:
        return np.asarray(scipy.ndimage.gaussian_filter1d(values, sigma, mode="constant"))

    total, first = weighted(np.ones_like(place)), weighted(place)
    m1 = first - place * total
    m2 = weighted(place**2) - 2.0 * place * first + place**2 * total
    mean = weighted(height)
    smooth = (m2 * mean - m1 * (weighted(place * height) - place * mean)) / (m2 * total - m1**2)
    return even, smooth, float(np.std(height - smooth))


def _check_heights(heights: Array, length: float, roughness: float, hollow: bool, path: object) -> None:
    if (spread := float(np.ptp(heights))) > DEEPEST * length:
        raise FileError(
            f"{path}: the profile drops by {1e3 * spread:.4g} mm, more than a hundredth of the effective length: is "
            "height_unit right, do chamfers lie within effective_length, or is the slope part of level='mean'?"
        )
    below = 0.5 * float(heights[0] + heights[-1]) - float(heights[heights.size // 2])
    if not hollow and below > max(3.0 * roughness, SMALLEST):
        raise FileError(
            f"{path}: the ends are {1e6 * below:.3g} µm higher than the middle: where heights grow into the material, give "
            "material='above'; where the surface is hollow, hollow=True"
        )
