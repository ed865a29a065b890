"""The frame of beams that stands for a cage: two rims and a bar between each two windows (docs/theory/cage.md#a-frame-of-beams).

Rims are polygons along the middle of their sections, bars run along the wall's middle surface from window's end to window's
end. Bars and rims are about as wide as the windows, so their joints have a size. Where a bar joins a rim, the rim does not
bend in the wall's surface, and resists bending out of it and torsion as if it were wider by a share of the bar (`JOINED`);
rounded corners make this part longer (`ROUNDED`). A bar goes on into the rim by a share of its thickness (`ROOTED`); from there
to the rim's middle it is rigid.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.validation import as_whole_number
from trbdyn.cage.beams import Beam, Elasticity, Frame, Section, at_end_of_arm, local_axes
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.cage_body import Wall
from trbdyn.model.pocket import Face, every_face

FloatArray = NDArray[np.float64]

JOINED: Final = 0.25
"""Share of a bar's width by which the rim is wider where the bar joins it."""
ROUNDED: Final = 0.5
"""Share of the radius of a window's corners by which the joint goes on into the window."""
ROOTED: Final = 0.25
"""Length over its thickness by which a bar goes on into the rim. These three were chosen beside solid models of three cages,
and a fourth one was held back (docs/theory/cage.md#the-joints-beside-a-solid)."""
CRACKED: Final = 1e-6
"""Factor of Young's modulus of the beam in which a bar is cracked through."""
ENDS: Final = ("small", "large")
SIDES: Final = ("trailing", "leading")
SURFACES: Final = ("outer", "inner")


@dataclass(frozen=True)
class CageFrame:
    """The frame of a cage. Places are those of the cage's frame: origin on the axis in the roller-centre plane, x through
    the middle of pocket 0, z along the axis towards the large ends.

    Attributes
    ----------
    frame : Frame
        The beams.
    bars : tuple of tuple of int
        Numbers of the beams of each bar, from the small to the large end; bar k lies behind pocket k in the direction of
        rotation.
    faces : tuple of (int, Face)
        Every face of every pocket: (pocket, face).
    at_faces : ndarray, shape (F, 6, 6 N)
        Displacement of each face's middle and rotation of the face, in the axes n, t, a of its pocket, from the coordinates.
    corners : tuple of str
        Names of the points at the bars' roots.
    corner_places : ndarray, shape (P, 3)
        Where they are (m).
    """

    frame: Frame
    bars: tuple[tuple[int, ...], ...]
    faces: tuple[tuple[int, Face], ...]
    at_faces: FloatArray
    corners: tuple[str, ...]
    corner_places: FloatArray

    def stress(self, displacements: FloatArray) -> FloatArray:
        """Nominal stress along the bar at its roots' corners (Pa), shape (P, L): tension and bending about both axes."""
        found = []
        for bar in self.bars:
            for number, at, sign in ((bar[0], 0, -1.0), (bar[-1], 6, 1.0)):
                ends, section = self.frame.end_forces(number, displacements), self.frame.beams[number].section
                pull, about_y, about_z = (sign * ends[at + place] for place in (0, 4, 5))
                for across in (-0.5, 0.5):
                    for through in (-0.5, 0.5):
                        found.append(
                            pull / section.area
                            + about_y * (through * section.thickness) / section.about_y
                            - about_z * (across * section.width) / section.about_z
                        )
        return np.stack(found)

    def coriolis(self, shapes: FloatArray) -> FloatArray:
        """Coriolis forces between motions of the frame, shape (M, M): on the first one, over the rate of the second one and the
        angular velocity of the cage about its axis (kg). They are ``-2 u1 . (z x u2)`` summed over the mass; rotary inertia is
        left out.
        """
        moves = shapes.reshape(-1, 6, shapes.shape[1])
        carried = np.zeros_like(moves)
        carried[:, 0], carried[:, 1] = -moves[:, 1], moves[:, 0]
        product = shapes.T @ self.frame.mass @ carried.reshape(shapes.shape)
        return product.T - product

    def loads_of_faces(self) -> FloatArray:
        """Loads at the nodes for each part of a wrench (N, N m) on each face, in the axes of its pocket, shape (6 N, 6 F)."""
        return self.at_faces.reshape(-1, self.at_faces.shape[2]).T.copy()


def cage_frame(
    bearing: Bearing,
    *,
    rim_elements: int = 4,
    bar_elements: int = 6,
    shear: bool = True,
    cracked_bars: Sequence[int] = (),
) -> CageFrame:
    """The frame of a bearing's cage.

    Parameters
    ----------
    bearing : Bearing
        A bearing whose cage has a `body`, and a material with density.
    rim_elements : int
        Beams of a rim along a window: even, 2 to 20.
    bar_elements : int
        Beams of a bar: even, 2 to 20.
    shear : bool
        Whether shear deforms the beams (Timoshenko); False: Euler's beams.
    cracked_bars : sequence of int
        Bars that are cracked through at their root at the small end; bar k lies behind pocket k in the direction of rotation.

    Returns
    -------
    CageFrame

    Raises
    ------
    InputError
        If the cage has no body, its material no density, or a number is not allowed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> from trbdyn.cage.frame import cage_frame
    >>> bearing = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})
    >>> frequencies, shapes = cage_frame(bearing).frame.natural(2)
    >>> bool(frequencies[0] > 1e3)
    True
    """
    for name, number in (("rim_elements", rim_elements), ("bar_elements", bar_elements)):
        try:
            even = as_whole_number(number)
        except ValueError as error:
            raise InputError.of(name, number, str(error)) from None
        if not 2 <= even <= 20 or even % 2:
            raise InputError.of(name, number, "must be even, 2 to 20")
    body, material = bearing.cage.body, bearing.cage_material
    if body is None:
        raise InputError.of(("bearing", "cage", "body"), None, "must be given: beams need rims and bars (trb.CageBody)")
    if material.density is None:
        raise InputError.of(("bearing", "cage", "material", "density"), None, "must be given (kg/m3)")
    made = Elasticity(material.youngs_modulus, material.poisson_ratio, material.density, shear)
    wall = Wall.of(bearing, body)
    return _Builder(bearing, wall, made, rim_elements, bar_elements, frozenset(cracked_bars)).build()


class _Builder:
    def __init__(
        self,
        bearing: Bearing,
        wall: Wall,
        made: Elasticity,
        rim_elements: int,
        bar_elements: int,
        cracked: frozenset[int],
    ) -> None:
        self.bearing, self.wall, self.made = bearing, wall, made
        self.rim_elements, self.bar_elements, self.cracked = rim_elements, bar_elements, cracked
        self.nodes: list[FloatArray] = []
        self.beams: list[Beam] = []

    def build(self) -> CageFrame:
        joints, middles = zip(*(self._rim(end) for end in ENDS), strict=True)
        bars = [self._bar(k, joints[0][k], joints[1][k]) for k in range(self.wall.n_pockets)]
        frame = Frame.of(np.array(self.nodes), self.beams, self.made)
        faces = tuple(every_face(self.bearing))
        at_faces = np.stack([self._at_face(pocket, face, bars, middles, frame) for pocket, face in faces])
        corners = [
            f"pocket {(k + (side == 'leading')) % self.wall.n_pockets}, {'trailing' if side == 'leading' else 'leading'} bar, "
            f"{end} end, {surface}"
            for k in range(self.wall.n_pockets)
            for end in ENDS
            for side in SIDES
            for surface in SURFACES
        ]
        places = np.concatenate([self._corner_places(frame, bar) for bar in bars])
        return CageFrame(frame, tuple(bars), faces, at_faces, tuple(corners), places)

    def _point(self, a: float, angle: float) -> FloatArray:
        """A point of the middle surface, in the cage's frame."""
        rho, z = self.wall.place(np.array(a), np.array(self.wall.height))
        return np.array([float(rho) * math.cos(angle), float(rho) * math.sin(angle), float(z)])

    def _along_wall(self, angle: float) -> FloatArray:
        sine, cosine = math.sin(self.wall.angle), math.cos(self.wall.angle)
        return np.array([sine * math.cos(angle), sine * math.sin(angle), cosine])

    def _add(self, place: FloatArray) -> int:
        self.nodes.append(place)
        return len(self.nodes) - 1

    def _rim(self, end: str) -> tuple[list[int], list[int]]:
        """Nodes of a rim in the middle of each bar and of each window; its beams."""
        wall, count = self.wall, self.wall.n_pockets
        small = end == "small"
        edge, width = (wall.small_edge, wall.small_width) if small else (wall.large_edge, wall.large_width)
        middle = edge + (-0.5 if small else 0.5) * width
        section = Section(width, wall.small_thickness if small else wall.large_thickness)
        window = float(wall.half_angle(np.array([edge]), np.array([wall.height]))[0])
        pitch = math.pi / count
        rho, _ = wall.place(np.array(edge), np.array(wall.height))
        free = max(window - ROUNDED * wall.corner_radius / float(rho), 0.5 * window)
        joint = Section(width + JOINED * wall.bar_width(edge), section.thickness)
        steps = np.linspace(-free, free, self.rim_elements + 1)
        ring = [  # (angle, section of the joint if the beam that ends there is one), from the middle of a bar to the next
            (2.0 * pitch * k + step, joint if place in (0, self.rim_elements + 1) else None)
            for k in range(count)
            for place, step in enumerate((*steps, pitch))
        ]
        numbers = [self._add(self._point(middle, angle)) for angle, _ in ring]
        for place, (_, wider) in enumerate(ring):
            before = numbers[place - 1]
            half = 0.5 * (self.nodes[numbers[place]] + self.nodes[before])
            side = self._along_wall(math.atan2(half[1], half[0]))
            self.beams.append(Beam(before, numbers[place], np.zeros(3), np.zeros(3), side, section, joint=wider))
        block = self.rim_elements + 2
        joints = [numbers[block * k + block - 1] for k in range(count)]
        return joints, [numbers[block * k + self.rim_elements // 2] for k in range(count)]

    def _bar(self, k: int, small: int, large: int) -> tuple[int, ...]:
        """Beams of the bar behind pocket k."""
        wall, angle = self.wall, (2 * k + 1) * math.pi / self.wall.n_pockets
        stations = np.linspace(wall.small_edge, wall.large_edge, self.bar_elements + 1)
        numbers = [self._add(self._point(float(a), angle)) for a in stations]
        side, none = np.array([-math.sin(angle), math.cos(angle), 0.0]), np.zeros(3)
        for rim, root, a in ((small, numbers[0], stations[0]), (large, numbers[-1], stations[-1])):
            way = self.nodes[root] - self.nodes[rim]
            arm = max(1.0 - ROOTED * wall.thickness / float(np.linalg.norm(way)), 0.0) * way
            section = Section(wall.bar_width(float(a)), wall.thickness)
            self.beams.append(Beam(rim, root, arm, none, side, section, heavy=False))  # the rim has its mass
        first = len(self.beams)
        for place in range(self.bar_elements):
            width = wall.bar_width(float(0.5 * (stations[place] + stations[place + 1])))
            section, stiffer = Section(width, wall.thickness), CRACKED if place == 0 and k in self.cracked else 1.0
            self.beams.append(Beam(numbers[place], numbers[place + 1], none, none, side, section, stiffer))
        return tuple(range(first, len(self.beams)))

    def _at_face(
        self,
        pocket: int,
        face: Face,
        bars: list[tuple[int, ...]],
        middles: tuple[list[int], ...],
        frame: Frame,
    ) -> FloatArray:
        """From the coordinates to the six of a face: it is tied rigidly to the nearest node of its bar, or of its rim."""
        axes = pocket_axes(self.bearing, pocket)
        radius = self.wall.radius
        angle = 2.0 * math.pi * pocket / self.wall.n_pockets
        origin = np.array([radius * math.cos(angle), radius * math.sin(angle), 0.0])
        place = origin + face.vertices.mean(axis=0) @ axes
        if face.part == "flank":
            ahead = float(face.vertices[:, 1].mean()) > 0.0
            bar = bars[pocket if ahead else pocket - 1]
            candidates = [self.beams[number].end for number in bar[:-1]]
        else:
            candidates = [middles[ENDS.index("small" if face.part == "small_end" else "large")][pocket]]
        node = min(candidates, key=lambda number: float(np.linalg.norm(frame.nodes[number] - place)))
        found = np.zeros((6, 6 * len(frame.nodes)))
        found[:, 6 * node : 6 * node + 6] = np.kron(np.eye(2), axes) @ at_end_of_arm(place - frame.nodes[node])
        return found

    def _corner_places(self, frame: Frame, bar: tuple[int, ...]) -> FloatArray:
        places = []
        for number, start in ((bar[0], True), (bar[-1], False)):
            beam = frame.beams[number]
            first, last = frame.nodes[beam.start] + beam.from_start, frame.nodes[beam.end] + beam.from_end
            _, y, z = local_axes(last - first, beam.side)
            for across in (-0.5, 0.5):
                for through in (-0.5, 0.5):
                    off = across * beam.section.width * y + through * beam.section.thickness * z
                    places.append((first if start else last) + off)
        return np.array(places)


def pocket_axes(bearing: Bearing, pocket: int) -> FloatArray:
    """Axes n, t, a of a pocket as rows, in the cage's frame."""
    angle, lean = 2.0 * math.pi * pocket / bearing.n_rollers, bearing.geometry.roller_axis_angle
    sine, cosine = math.sin(lean), math.cos(lean)
    around = math.cos(angle), math.sin(angle)
    return np.array(
        [
            [cosine * around[0], cosine * around[1], -sine],
            [-around[1], around[0], 0.0],
            [sine * around[0], sine * around[1], cosine],
        ]
    )
