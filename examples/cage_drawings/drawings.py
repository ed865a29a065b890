"""Cages of a bearing as STEP files, made by Gmsh with its kernel Open CASCADE: parametric, a few lines for each kind.

    python examples/cage_drawings/drawings.py 30310 drawings      # all kinds, into the folder drawings

Kinds: `sheet`, a window cage of steel sheet; `polyamide`, thick, with pockets that follow the rollers and are drafted;
`machined`, with a large rail at the large end, as the test rig's; `relieved`, with bars that are cut back in their middle;
`lands`, whose faces are exactly the polygons of the bearing's pocket.
"""

from __future__ import annotations

import argparse
import itertools
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import trbdyn as trb
from trbdyn.extras.cad.opened import gmsh_model
from trbdyn.model.cage_body import Wall
from trbdyn.model.pocket import pocket_axes

MM = 1e3
"""Drawings are in mm."""
Place = Callable[[float, float, float], Any]


class Cage:
    """What the kinds share: the wall of a bearing's cage, and the frame of pocket 0."""

    def __init__(self, bearing: trb.Bearing, *, thickness: float, rims: tuple[float, float]) -> None:
        self.bearing = bearing
        body = trb.CageBody(thickness=thickness, small_rim_width=rims[0], large_rim_width=rims[1])
        self.wall = Wall.of(bearing, body)
        self.axes = pocket_axes(bearing, 0)

    def at(self, a: float, n: float, t: float = 0.0) -> np.ndarray:
        """A point of the frame of pocket 0 in the drawing (mm)."""
        return MM * (np.array([self.wall.radius, 0.0, 0.0]) + np.array([n, t, a]) @ self.axes)

    def ring(self, gmsh: Any, profile: list[tuple[float, float]]) -> int:
        """A profile of points (a, n) turned about the axis."""
        occ = gmsh.model.occ
        corners = [self.at(a, n) for a, n in profile]
        points = [occ.addPoint(*corner) for corner in corners]
        lines = [occ.addLine(points[k], points[(k + 1) % len(points)]) for k in range(len(points))]
        flat = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        return int(next(tag for dim, tag in occ.revolve([(2, flat)], 0, 0, 0, 0, 0, 1, 2.0 * math.pi) if dim == 3))

    def wall_ring(self, gmsh: Any) -> int:
        """The wall with its rims, before windows are cut."""
        w, half = self.wall, 0.5 * self.wall.thickness
        low, high = w.small_edge - w.small_width, w.large_edge + w.large_width
        return self.ring(
            gmsh, [(low, w.height - half), (high, w.height - half), (high, w.height + half), (low, w.height + half)]
        )

    def window(self, gmsh: Any, corner: float, *, back: float = 0.0, span: tuple[float, float] | None = None) -> int:
        """What cuts the window of pocket 0: the planes of the bars of the default pocket, moved back, and end walls."""
        w, occ, face = self.wall, gmsh.model.occ, self.bearing.pocket.face("leading_bar")
        low, high = span or (w.small_edge, w.large_edge)
        n_low, n_high = w.height - 1.5 * w.thickness, w.height + 1.5 * w.thickness

        def corner_at(a: float, n: float, side: float) -> int:
            t = (
                side
                * (face.normal @ np.array(face.origin) - back - face.normal[0] * n - face.normal[2] * a)
                / face.normal[1]
            )
            return int(occ.addPoint(*self.at(a, n, t)))

        rings = [
            [corner_at(a, n, side) for a, side in ((low, -1), (low, 1), (high, 1), (high, -1))] for n in (n_low, n_high)
        ]
        return self._box(gmsh, rings, corner)

    @staticmethod
    def _box(gmsh: Any, rings: list[list[int]], corner: float = 0.0) -> int:
        """A body between two outlines of as many points; edges between them are rounded."""
        occ, count = gmsh.model.occ, len(rings[0])
        around = [[occ.addLine(ring[k], ring[(k + 1) % count]) for k in range(count)] for ring in rings]
        through = [occ.addLine(rings[0][k], rings[1][k]) for k in range(count)]
        sides = [[around[0][k], through[(k + 1) % count], around[1][k], through[k]] for k in range(count)]
        surfaces = [occ.addPlaneSurface([occ.addCurveLoop(loop)]) for loop in (*around, *sides)]
        body = occ.addVolume([occ.addSurfaceLoop(surfaces)])
        occ.synchronize()
        if corner > 0.0:
            ((_, body),) = occ.fillet([body], through, [MM * corner])
        return int(body)

    def everywhere(self, gmsh: Any, tool: int, *, without: tuple[int, ...] = ()) -> list[tuple[int, int]]:
        """A body of pocket 0, copied into the others."""
        occ, count = gmsh.model.occ, self.wall.n_pockets
        found = []
        for k in range(count):
            if k in without:
                continue
            (copy,) = occ.copy([(3, tool)])
            occ.rotate([copy], 0, 0, 0, 0, 0, 1, 2.0 * math.pi * k / count)
            found.append(copy)
        occ.remove([(3, tool)], recursive=True)
        return found


def sheet(gmsh: Any, bearing: trb.Bearing, *, thickness: float = 2e-3, corner: float = 0.12e-3) -> None:
    """A window cage of steel sheet; its windows' corners are rounded."""
    cage = Cage(bearing, thickness=thickness, rims=(4e-3, 4e-3))
    ring = cage.wall_ring(gmsh)
    gmsh.model.occ.cut([(3, ring)], cage.everywhere(gmsh, cage.window(gmsh, corner)))


def polyamide(
    gmsh: Any, bearing: trb.Bearing, *, play: float = 0.15e-3, draft_deg: float = 3.0, corner: float = 0.0
) -> None:
    """A thick cage whose bars follow the rollers up to their axes, and open outwards with a draft."""
    cage = Cage(bearing, thickness=5.5e-3, rims=(3e-3, 4e-3))
    g, occ, w = bearing.geometry, gmsh.model.occ, cage.wall
    slope, middle = math.tan(g.roller_half_angle), 0.25 * (g.large_end_diameter + g.small_end_diameter)
    low, high = w.small_edge, w.large_edge
    radii = [middle + play / math.cos(g.roller_half_angle) + a * slope for a in (low, high)]
    axis, start = cage.axes[2], cage.at(low, 0.0)
    cone = occ.addCone(*start, *(MM * (high - low) * axis), MM * radii[0], MM * radii[1])
    edge = 3.2e-3  # from here on, outwards, the window is a box with drafted sides
    rings = []
    for n, more in ((edge, 0.0), (w.height + 2.0 * w.thickness, math.tan(math.radians(draft_deg)))):
        half = [math.sqrt(radius**2 - edge**2) + more * (n - edge) for radius in radii]
        rings.append(
            [
                occ.addPoint(*cage.at(a, n, t))
                for a, t in ((low, -half[0]), (low, half[0]), (high, half[1]), (high, -half[1]))
            ]
        )
    box = cage._box(gmsh, rings, corner)
    ring = cage.wall_ring(gmsh)
    occ.cut([(3, ring)], cage.everywhere(gmsh, cone) + cage.everywhere(gmsh, box))


def machined(gmsh: Any, bearing: trb.Bearing, *, rail: float = 3e-3, corner: float = 0.12e-3) -> None:
    """A machined cage with a rail at the large end, cylindrical outside, as sensors and lands want it."""
    cage = Cage(bearing, thickness=4e-3, rims=(3e-3, 4e-3))
    w, occ = cage.wall, gmsh.model.occ
    half, edge = 0.5 * w.thickness, w.large_edge
    low, high = w.small_edge - w.small_width, edge + w.large_width
    inner, outer = cage.at(high, w.height - half), cage.at(edge + 0.8e-3, w.height + half)
    profile = [
        cage.at(low, w.height - half),
        inner,
        np.add(inner, [0.0, 0.0, MM * 1e-3]),
        [outer[0] + MM * rail, 0.0, inner[2] + MM * 1e-3],
        [outer[0] + MM * rail, 0.0, outer[2]],
        outer,
        cage.at(low, w.height + half),
    ]
    points = [occ.addPoint(*corner_) for corner_ in profile]
    lines = [occ.addLine(points[k], points[(k + 1) % len(points)]) for k in range(len(points))]
    flat = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    ring = next(tag for dim, tag in occ.revolve([(2, flat)], 0, 0, 0, 0, 0, 1, 2.0 * math.pi) if dim == 3)
    occ.cut([(3, ring)], cage.everywhere(gmsh, cage.window(gmsh, corner)))


def relieved(
    gmsh: Any, bearing: trb.Bearing, *, depth: float = 0.3e-3, share: float = 0.5, broken: bool = False
) -> None:
    """A cage of sheet whose bars are cut back in their middle; `broken`: one pocket has a bar that stands 0.1 mm back."""
    cage = Cage(bearing, thickness=2.5e-3, rims=(4e-3, 4e-3))
    occ, w = gmsh.model.occ, cage.wall
    length = w.large_edge - w.small_edge
    middle = 0.5 * (w.large_edge + w.small_edge)
    cut = cage.window(gmsh, 0.0, back=depth, span=(middle - 0.5 * share * length, middle + 0.5 * share * length))
    tools = cage.everywhere(gmsh, cut) + cage.everywhere(gmsh, cage.window(gmsh, 0.12e-3))
    if broken:
        extra = cage.everywhere(
            gmsh, cage.window(gmsh, 0.0, back=1e-4), without=tuple(k for k in range(w.n_pockets) if k != 4)
        )
        tools += extra
    ring = cage.wall_ring(gmsh)
    occ.cut([(3, ring)], tools)


def lands(gmsh: Any, bearing: trb.Bearing, *, depth: float = 0.6e-3) -> None:
    """A cage in whose wide windows each polygon of the bearing's pocket stands as the face of a land."""
    cage = Cage(bearing, thickness=5e-3, rims=(4.8e-3, 4.8e-3))
    occ, w = gmsh.model.occ, cage.wall
    span = (w.small_edge - 0.5 * depth, w.large_edge + 0.5 * depth)
    (whole,), _ = occ.cut(
        [(3, cage.wall_ring(gmsh))], cage.everywhere(gmsh, cage.window(gmsh, 0.0, back=0.5 * depth, span=span))
    )
    bodies = []
    for face in bearing.pocket.faces:
        corners = face.vertices
        rings = [
            [occ.addPoint(*cage.at(point[2], point[0], point[1])) for point in corners - back * face.normal]
            for back in (0.0, 2.0 * depth)
        ]
        bodies += cage.everywhere(gmsh, cage._box(gmsh, rings))
    occ.fuse([whole], bodies)


KINDS: dict[str, Callable[..., None]] = {
    "sheet": sheet,
    "polyamide": polyamide,
    "machined": machined,
    "relieved": relieved,
    "lands": lands,
}


def write(
    kind: str,
    bearing: trb.Bearing,
    path: Path,
    *,
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0),
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0),
    inches: bool = False,
    **options: Any,
) -> Path:
    """Write a cage.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    bearing : trb.Bearing
        The bearing.
    path : Path
        The file, ``.step``, or another format that Gmsh writes.
    shift : tuple of float
        Moves the drawing (mm).
    turn : tuple of float
        Turns it about x, y and z in turn (rad).
    inches : bool
        Whether the file is in inches.
    **options
        Arguments of the kind.
    """
    with gmsh_model() as gmsh:
        occ = gmsh.model.occ
        KINDS[kind](gmsh, bearing, **options)
        bodies = occ.getEntities(3)
        for axis, angle in enumerate(turn):
            if angle:
                occ.rotate(bodies, 0, 0, 0, *np.eye(3)[axis], angle)
        if any(shift):
            occ.translate(bodies, *shift)
        if inches:
            occ.dilate(bodies, 0, 0, 0, *(3 * [1.0 / 25.4]))
        occ.synchronize()
        gmsh.write(str(path))
    if inches:
        path.write_text(_in_inches(path.read_text()))
    return path


def _in_inches(text: str) -> str:
    """A STEP file in mm as one in inches: its numbers stay."""
    unit = re.compile(r"\(\s*LENGTH_UNIT\(\)\s*NAMED_UNIT\(\*\)\s*SI_UNIT\(\.MILLI\.,\.METRE\.\)\s*\);")
    number = itertools.count(900001, 3)

    def inch(_: re.Match[str]) -> str:
        mm = next(number)
        return (
            f"( CONVERSION_BASED_UNIT('INCH',#{mm + 1}) LENGTH_UNIT() NAMED_UNIT(#{mm + 2}) );\n"
            f"#{mm} = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );\n"
            f"#{mm + 1} = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{mm});\n"
            f"#{mm + 2} = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);"
        )

    changed, count = unit.subn(inch, text)
    if not count:
        raise ValueError("the file does not tell its unit in the expected form")
    return changed


def main() -> None:
    parser = argparse.ArgumentParser(description="write cages of a bearing as STEP files")
    parser.add_argument("bearing", help="a bearing that ships with trbdyn, for instance 30310")
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    bearing = trb.cases.BEARINGS[options.bearing]()
    for kind in KINDS:
        print(write(kind, bearing, options.folder / f"{kind}.step"))


if __name__ == "__main__":
    main()
