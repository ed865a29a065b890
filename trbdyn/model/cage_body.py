"""Rims and bars of a cage, and what follows from them: mass, centre of mass and moments of inertia
(docs/theory/cage.md#mass-from-dimensions).

The cage is a conical wall whose middle surface runs parallel to the rollers' axes, with a window for each roller and a
rim at each end. A point of it has the coordinates of the pocket frame in the pocket's middle: a along the roller's axis
from mid length, n outward from the roller's axis. With the roller's axis at the angle alpha_m it lies at the radius
rho = Dpw/2 + a sin(alpha_m) + n cos(alpha_m), at the height z = a cos(alpha_m) - n sin(alpha_m) above the roller-centre plane,
and a volume is rho dphi da dn. The sides of a window are the planes of the bars' faces of the default pocket; they cut
the circle of radius rho at the angle phi that solves N . x(phi) = N . origin, N being the face's normal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.validation import Gap, Length, Model, Number, unit
from trbdyn.errors import InputError
from trbdyn.model.pocket_shapes import default_pocket

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

FloatArray = NDArray[np.float64]
_NODES: Final = 16
"""Gauss nodes along and across each part: the integrands are smooth, and the mass has converged to 1e-12."""


class CageBody(Model):
    """Rims and bars of a cage: a conical wall parallel to the rollers' axes, with a window for each roller and a rim at each end.

    Windows follow from the plays: their sides are the planes of the bars' faces of the default pocket, their ends its end
    walls. Steps and reliefs of other pockets, and the corners' radii, are left out of the mass.

    Parameters
    ----------
    thickness : float
        Thickness of the wall, and so of the bars, perpendicular to the cone (m).
    small_rim_width, large_rim_width : float
        Widths of the rims along the cone, beyond the pockets at the small and at the large ends of the rollers (m).
    small_rim_thickness, large_rim_thickness : float, optional
        Thicknesses of the rims (m); by default that of the wall. Rims are centred on the wall's middle surface.
    height : float, optional
        Distance of the wall's middle surface outward from the rollers' axes (m); by default the middle of the end walls' bands,
        ``(wall_inner + wall_outer)/2`` of the cage.
    corner_radius : float, optional
        Radius of the windows' corners (m); by default a third of the wall's thickness. It stiffens the joints of an elastic cage;
        the mass is that of sharp corners.

    Examples
    --------
    >>> import trbdyn as trb
    >>> body = trb.CageBody(thickness=5e-3, small_rim_width=4.8e-3, large_rim_width=4.8e-3)
    >>> rig = trb.cases.rig_30310()
    >>> cage = trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=body)
    >>> for material in (trb.Material.steel(), trb.Material.brass(), trb.Material.polyamide()):
    ...     print(round(rig.replace(cage=cage.replace(material=material)).cage.mass, 3))
    0.2
    0.215
    0.034
    """

    thickness: Length
    small_rim_width: Length
    large_rim_width: Length
    small_rim_thickness: Annotated[Number | None, unit("m", gt=0)] = None
    large_rim_thickness: Annotated[Number | None, unit("m", gt=0)] = None
    height: Annotated[Number | None, unit("m")] = None
    corner_radius: Annotated[Gap | None, unit("m", ge=0)] = None


@dataclass(frozen=True)
class Wall:
    """A cage's wall in numbers: lengths from the roller's mid length (a) and axis (n)."""

    n_pockets: int
    radius: float  # of the pitch circle at the rollers' mid length (m)
    angle: float  # of the cone (rad)
    height: float  # n of the middle surface (m)
    thickness: float  # of the bars (m)
    small_thickness: float  # of the rim at the small ends (m)
    large_thickness: float  # of the rim at the large ends (m)
    small_edge: float  # a of the windows' ends at the rollers' small ends (m)
    large_edge: float  # a of the windows' other ends (m)
    small_width: float  # of the rim at the small ends (m)
    large_width: float  # of the rim at the large ends (m)
    normal: FloatArray  # of the leading bar's face in the axes radial, circumferential, axial, shape (3,)
    distance: float  # of that plane along its normal from the point on the axis in the roller-centre plane (m)
    corner_radius: float  # of the windows' corners (m)

    @classmethod
    def of(cls, bearing: Bearing, body: CageBody) -> Wall:
        """The wall of a bearing's cage; refused where it has no room between the raceways, or windows leave no bar."""
        cage, geometry, pocket = bearing.cage, bearing.geometry, default_pocket(bearing)
        height = 0.5 * (cage.wall_inner + cage.wall_outer) if body.height is None else body.height
        face = pocket.face("leading_bar")
        sine, cosine = math.sin(geometry.roller_axis_angle), math.cos(geometry.roller_axis_angle)
        radius = 0.5 * bearing.pitch_diameter
        axes = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
        normal = axes @ face.normal
        wall = cls(
            n_pockets=bearing.n_rollers,
            radius=radius,
            angle=geometry.roller_axis_angle,
            height=height,
            thickness=body.thickness,
            small_thickness=body.small_rim_thickness or body.thickness,
            large_thickness=body.large_rim_thickness or body.thickness,
            small_edge=pocket.face("small_end_wall").origin[2],
            large_edge=pocket.face("large_end_wall").origin[2],
            small_width=body.small_rim_width,
            large_width=body.large_rim_width,
            normal=normal,
            distance=float(normal @ (axes @ np.array(face.origin) + np.array([radius, 0.0, 0.0]))),
            corner_radius=body.thickness / 3.0 if body.corner_radius is None else body.corner_radius,
        )
        wall._check(bearing)
        return wall

    def _check(self, bearing: Bearing) -> None:
        half = 0.5 * bearing.roller.diameter
        for name, thickness in (
            ("thickness", self.thickness),
            ("small_rim_thickness", self.small_thickness),
            ("large_rim_thickness", self.large_thickness),
        ):
            most = 2.0 * (half - abs(self.height))
            if thickness >= most:
                limit = f"must be < {max(most, 0.0):.4g}: the wall at height {self.height:g} m lies between the raceways (m)"
                raise InputError.of(("body", name), thickness, limit)
        low, high = self.height - 0.5 * self.thickness, self.height + 0.5 * self.thickness
        corners = self.half_angle(np.array([self.small_edge, self.large_edge]), np.array([[low], [high]]))
        widest = float(np.max(corners))
        if not widest < math.pi / self.n_pockets:
            there = f"windows take {math.degrees(widest):.4g} deg to each side, {180 / self.n_pockets:.4g} are there"
            limit = f"must leave a bar: {there} (m)"
            raise InputError.of(("body", "thickness"), self.thickness, limit)
        rho, _ = self.place(np.array([self.small_edge, self.large_edge]), np.array([[low], [high]]))
        most = min(float(np.min(rho * corners)), 0.5 * (self.large_edge - self.small_edge))
        if not self.corner_radius < most:
            raise InputError.of(
                ("body", "corner_radius"), self.corner_radius, f"must be < {most:.4g}: half a window (m)"
            )

    def place(self, a: FloatArray, n: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Radius and height above the roller-centre plane (m) of points of the wall."""
        sine, cosine = math.sin(self.angle), math.cos(self.angle)
        return self.radius + a * sine + n * cosine, a * cosine - n * sine

    def half_angle(self, a: FloatArray, n: FloatArray) -> FloatArray:
        """Half of the angle that a window takes of the circle through points of the wall (rad)."""
        rho, z = self.place(a, n)
        size, phase = math.hypot(self.normal[0], self.normal[1]), math.atan2(self.normal[1], self.normal[0])
        part = (self.distance - self.normal[2] * z) / (rho * size)
        found = np.full(np.shape(part), math.inf)
        cut = np.abs(part) <= 1.0
        found[cut] = phase + np.arccos(part[cut])
        return found

    def bar_width(self, a: float) -> float:
        """Width of a bar at the middle surface, along the circle (m)."""
        at, n = np.array([a]), np.array([self.height])
        rho, _ = self.place(at, n)
        return float(2.0 * rho[0] * (math.pi / self.n_pockets - self.half_angle(at, n)[0]))


@dataclass(frozen=True)
class CageMass:
    """What a cage weighs."""

    mass: float  # kg
    rims: float  # of its two rims alone (kg)
    offset: float  # of the centre of mass above the roller-centre plane, along the axis (m)
    inertia_axial: float  # about the axis (kg m2)
    inertia_transverse: float  # about a transverse axis through the centre of mass (kg m2)


def cage_mass(wall: Wall, density: float) -> CageMass:
    """Mass, centre and moments of inertia of a cage from its wall and its density (kg/m3), by Gauss quadrature."""
    rims = _moments(wall, wall.small_edge - wall.small_width, wall.small_edge, wall.small_thickness, windows=False)
    rims += _moments(wall, wall.large_edge, wall.large_edge + wall.large_width, wall.large_thickness, windows=False)
    bars = _moments(wall, wall.small_edge, wall.large_edge, wall.thickness, windows=True)
    mass, first, second, axial = density * (rims + bars)
    offset = first / mass
    return CageMass(
        mass=float(mass),
        rims=float(density * rims[0]),
        offset=float(offset),
        inertia_axial=float(axial),
        inertia_transverse=float(0.5 * axial + second - mass * offset**2),
    )


def _moments(wall: Wall, start: float, end: float, thickness: float, *, windows: bool) -> FloatArray:
    """Integrals of 1, z, z^2 and rho^2 over the volume of a part of the wall (m3, m4, m5, m5)."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    a = 0.5 * (start + end) + 0.5 * (end - start) * nodes[:, None]
    n = wall.height + 0.5 * thickness * nodes[None, :]
    rho, z = wall.place(a, n)
    there = 2.0 * math.pi - (2.0 * wall.n_pockets * wall.half_angle(a, n) if windows else 0.0)
    volume = 0.25 * (end - start) * thickness * weights[:, None] * weights[None, :] * rho * there
    return np.array([volume.sum(), (volume * z).sum(), (volume * z**2).sum(), (volume * rho**2).sum()])
