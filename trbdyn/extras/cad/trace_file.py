"""Points of a measured trace (CSV), or of a drawn line (DXF), in metres."""

from __future__ import annotations

import os
import re
from itertools import islice
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import file_path
from trbdyn.base.reading import LARGEST_DRAWN, MOST_LINES, MOST_POINTS, checked_file, read_input
from trbdyn.errors import FileError, InputError

Array = NDArray[np.float64]

UNITS: Final = {"nm": 1e-9, "um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
FLATTENING: Final = 1e-9
"""Largest distance of a drawn curve from its polyline (m)."""
JOINED: Final = 1e-6
"""Largest gap between ends of drawn lines that belong together (m)."""
MOST_DEGREE: Final = 9
MOST_CONTROLS: Final = 5000
"""Degree and control points of a spline, at most."""
_WRITTEN_UNIT: Final = re.compile(r"(?:[\[(]|_|\s)\s*(nm|um|µm|μm|mm|cm|m|inch|in)\s*(?:[\])]|$)", re.IGNORECASE)
_LINES: Final = ("LINE", "LWPOLYLINE", "POLYLINE", "ARC", "SPLINE", "ELLIPSE")
_DRAWN_UNITS: Final = {1: "inch", 4: "mm", 5: "cm", 6: "m", 13: "um"}
"""Units of a DXF file ($INSUNITS)."""


def points_of(
    path: str | os.PathLike[str],
    *,
    position_unit: str | None,
    height_unit: str | None,
    layer: str | None,
) -> tuple[Array, Array]:
    """Positions and heights (m) in the order of the file, shape (n,), with arguments and errors of `trbdyn.read_trace`."""
    file = file_path(path, "path")
    for name, unit in (("position_unit", position_unit), ("height_unit", height_unit)):
        if unit is not None and unit not in UNITS:
            raise InputError.of(name, unit, f"must be one of {', '.join(UNITS)}")
    if file.suffix.lower() == ".dxf":
        if height_unit is not None and height_unit != position_unit:
            raise InputError.of("height_unit", height_unit, "must be position_unit: a drawing has one unit")
        return _drawn(file, position_unit, layer)
    if layer is not None:
        raise InputError.of("layer", layer, "must not be given: only a DXF file has layers")
    return _measured(file, position_unit, height_unit)


def _measured(file: Path, position_unit: str | None, height_unit: str | None) -> tuple[Array, Array]:
    data = read_input(file, "CSV")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    head: list[str] = []
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        cells = _cells(line)
        try:
            values = [float(cell) for cell in cells]
        except ValueError:
            values = []
        if not values and not rows:
            head = cells
        elif len(values) != 2 or not np.isfinite(values).all():
            raise FileError(
                f"{file}, line {number}: must be two finite numbers, position and height: {line.strip()[:60]!r}"
            )
        else:
            rows.append((values[0], values[1]))
    if not rows:
        raise FileError(f"{file}: holds no line of two numbers, position and height")
    written = [_unit_in(cell) for cell in head] if len(head) == 2 else [None, None]
    scales = []
    for name, given, found in zip(("position_unit", "height_unit"), (position_unit, height_unit), written, strict=True):
        if given is not None and found is not None and given != found:
            raise InputError.of(name, given, f"must be the unit in the head of {file.name}, {found}, or left out")
        unit = given or found
        if unit is None:
            raise InputError.of(
                name, None, f"must be given, one of {', '.join(UNITS)}: the head of {file.name} names no unit"
            )
        scales.append(UNITS[unit])
    points = np.array(rows) * scales
    return points[:, 0], points[:, 1]


def _cells(line: str) -> list[str]:
    """Cells of a line; commas are decimal points where something else separates the cells."""
    for separator in (";", "\t"):
        if separator in line:
            return [cell.strip().replace(",", ".") for cell in line.strip().strip(separator).split(separator)]
    if "," in line:
        return [cell.strip() for cell in line.split(",")]
    return line.split()


def _unit_in(cell: str) -> str | None:
    found = _WRITTEN_UNIT.search(cell.strip().strip('"'))
    if found is None:
        return None
    unit = found[1].lower().replace("µ", "u").replace("μ", "u")
    return "inch" if unit == "in" else unit


def _drawn(file: Path, unit: str | None, layer: str | None) -> tuple[Array, Array]:
    """Points of the one line in a DXF file, or on one of its layers."""
    ezdxf = _library()
    checked_file(file, "DXF")
    try:
        document = ezdxf.readfile(file)
    except OSError as error:
        raise FileError(f"{file}: {error.strerror or 'not a DXF file'}") from None
    except (ezdxf.DXFError, ValueError) as error:
        raise FileError(f"{file}: not a DXF file that can be used: {error}") from None
    lines = [entity for entity in document.modelspace() if entity.dxftype() in _LINES]
    layers = sorted({entity.dxf.layer for entity in lines})
    if layer is not None and layer not in layers:
        raise InputError.of(
            "layer", layer, f"must be a layer with lines; those of {file.name}: {', '.join(layers) or 'none'}"
        )
    lines = [entity for entity in lines if layer is None or entity.dxf.layer == layer]
    if not lines:
        raise FileError(f"{file}: holds no line, polyline, arc, ellipse or spline")
    told = _DRAWN_UNITS.get(document.units)
    if told is None and unit is None:
        raise InputError.of(
            "position_unit", None, f"must be given, one of {', '.join(UNITS)}: {file.name} names no unit"
        )
    if told is not None and unit is not None and told != unit:
        raise InputError.of("position_unit", unit, f"must be the unit of {file.name}, {told}, or left out")
    scale = UNITS[told or str(unit)]
    points = _joined(_pieces(lines, scale, file), file, layers)
    return points[:, 0], points[:, 1]


def _pieces(lines: list[Any], scale: float, file: Path) -> list[Array]:
    """Points of each drawn line (m)."""
    from ezdxf.path import make_path

    if len(lines) > MOST_LINES:
        raise FileError(
            f"{file}: has {len(lines)} lines; {MOST_LINES} are joined: give the layer that holds the profile alone"
        )
    found: list[Array] = []
    count = 0
    for entity in lines:
        kind, number = entity.dxftype(), entity.dxf.handle
        if kind == "SPLINE" and not (entity.dxf.degree <= MOST_DEGREE and len(entity.control_points) <= MOST_CONTROLS):
            raise FileError(
                f"{file}: a spline has degree {entity.dxf.degree} and {len(entity.control_points)} control points; "
                f"{MOST_DEGREE} and {MOST_CONTROLS} are drawn"
            )
        try:
            path = make_path(entity)
            reach = max((abs(part) for point in path.control_vertices() for part in point.xyz), default=0.0)
        except (ValueError, ArithmeticError, IndexError, TypeError) as error:
            raise FileError(f"{file}: {kind} {number} cannot be drawn: {error}") from None
        if not scale * reach <= LARGEST_DRAWN:  # not a number, too
            raise FileError(f"{file}: {kind} {number} reaches farther than {LARGEST_DRAWN:g} m, or is not finite")
        left = MOST_POINTS - count
        flat = [(point.x, point.y) for point in islice(path.flattening(FLATTENING / scale, segments=8), left + 1)]
        if len(flat) > left:
            raise FileError(f"{file}: has more than {MOST_POINTS} points within {1e9 * FLATTENING:g} nm of its curves")
        count += len(flat)
        if len(flat) > 1:
            found.append(scale * np.array(flat))
    if not found:
        raise FileError(f"{file}: holds no line with two points")
    return found


def _library() -> Any:
    try:
        import ezdxf
    except ImportError as error:
        raise ImportError("drawn lines need ezdxf: pip install trbdyn[cad]") from error
    return ezdxf


def _joined(pieces: list[Array], file: Path, layers: list[str]) -> Array:
    """One line of pieces that meet at their ends, whichever way and in whatever order each was drawn."""
    ends = np.array([[piece[0], piece[-1]] for piece in pieces])
    free = np.ones(len(pieces), dtype=bool)
    free[0] = False
    chain = [pieces[0]]
    while free.any():
        for at in (-1, 0):
            tip = chain[at][at]
            gaps = np.where(free[:, None], np.hypot(*(ends - tip).transpose(2, 0, 1)), np.inf)
            place, end = np.unravel_index(int(np.argmin(gaps)), gaps.shape)
            if gaps[place, end] < JOINED:
                piece = pieces[int(place)]
                turned = piece if end == (0 if at == -1 else 1) else piece[::-1]
                chain.insert(len(chain) if at == -1 else 0, turned)
                free[place] = False
                break
        else:
            told = ", ".join(layers[:20])
            raise FileError(
                f"{file}: lines do not join to one: {np.count_nonzero(free)} of them meet no end of the others within "
                f"{1e6 * JOINED:g} µm; give the layer that holds the profile alone; layers: {told}"
            )
    line = np.vstack([chain[0], *(piece[1:] for piece in chain[1:])])
    if np.hypot(*(line[0] - line[-1])) < JOINED:
        raise FileError(f"{file}: the line is closed: the profile alone must be drawn, from end to end")
    return line
