"""How a bearing's parts have grown: by their temperatures, and the cage by its rotation
(docs/theory/cage.md#play-at-speed-and-temperature).

What a pocket is for a roller is told in the roller's own size, so rollers and raceways keep their numbers, and the faces of the
pockets move. Let e_c, e_r, e_i be the strains of cage, rollers and inner ring. A point X of the cage moves by
e_c X + e_w rho (e_w: by rotation, radially), X from the point of the axis in the roller-centre plane. A roller rests on the
cup, on the cone and, with its large end, on the rib of the inner ring. If it grows otherwise than that ring, its apex moves
along the cone's generator by s = (e_i - e_r) (P . n)/(g . n), P being the contact with the rib, n the rib's normal and g the
generator's direction, all from the apex; the cup moves along the axis with it. So the roller's centre moves outward by

    D = e_r Dpw/2 + s sin(alpha_i),

and the growth of the outer ring does not appear: it moves the inner ring along the axis. A face moves relative to its roller by
(e_c Dpw/2 + e_w rho - D) along the radius, and by e_c - e_r times its place from the roller's centre. The cage may move
along the axis: its place is the one in which the nominal roller's large end touches its pocket, which is where plays are
measured.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Final, Self

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.validation import Flag, Model, Number, unit
from trbdyn.errors import InputError
from trbdyn.model.cage_body import Wall, cage_mass
from trbdyn.model.motion import is_constant
from trbdyn.model.pocket import Face, Pocket

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing
    from trbdyn.model.material import Material
    from trbdyn.model.scene import Scene

FloatArray = NDArray[np.float64]
Celsius = Annotated[Number, unit("C", ge=-200, le=600)]
LARGEST_STRAIN: Final = 0.05
"""Largest strain of a part that is taken: beyond it displacements are not small."""


class Growth(Model):
    """Temperatures of a bearing's parts, and whether its cage grows by its rotation. Dimensions are those at the reference
    temperature; pockets and the land's clearance are those of the running bearing. Loads, raceways and the oil are not
    changed by it.

    Parameters
    ----------
    cage_c, rollers_c, inner_ring_c, outer_ring_c : float
        Temperatures of cage, rollers and rings (deg C). That of the outer ring acts only where its land guides the cage.
    reference_c : float
        Temperature at which the bearing has its dimensions (deg C).
    centrifugal : bool
        Whether the cage grows by its rotation, at the kinematic speed of the cage; needs a constant speed of the shaft.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(growth=trb.Growth.uniform(80.0))
    >>> scene = scene.replace({"bearing.cage.material": trb.Material.polyamide(), "bearing.cage.mass": 0.034})
    >>> round(1e6 * scene.running_plays[1])  # Cpc, 120 um at 20 C
    189
    """

    cage_c: Celsius
    rollers_c: Celsius
    inner_ring_c: Celsius
    outer_ring_c: Celsius
    reference_c: Celsius = 20.0
    centrifugal: Flag = True

    @classmethod
    def uniform(cls, temperature_c: float, *, reference_c: float = 20.0, centrifugal: bool = True) -> Self:
        """All parts at one temperature (deg C)."""
        names = ("cage_c", "rollers_c", "inner_ring_c", "outer_ring_c")
        return cls(**dict.fromkeys(names, temperature_c), reference_c=reference_c, centrifugal=centrifugal)


@dataclass(frozen=True)
class Strains:
    """Growth over size of each part (1), by temperature, and that of the cage's circumference by its rotation."""

    cage: float
    rollers: float
    inner_ring: float
    outer_ring: float
    rotation: float


def strains(scene: Scene, growth: Growth) -> Strains:
    """Strains of a scene's parts; refused where a material lacks what is needed, the speed changes, or a strain is not small."""
    bearing = scene.bearing
    found = Strains(
        cage=part_strain(bearing, "cage", growth.cage_c - growth.reference_c),
        rollers=part_strain(bearing, "roller", growth.rollers_c - growth.reference_c),
        inner_ring=part_strain(bearing, "", growth.inner_ring_c - growth.reference_c),
        outer_ring=part_strain(bearing, "", growth.outer_ring_c - growth.reference_c),
        rotation=_rotation(scene) if growth.centrifugal else 0.0,
    )
    for name, strain in vars(found).items():
        if abs(strain) > LARGEST_STRAIN:
            path = ("growth", "centrifugal" if name == "rotation" else f"{name}_c")
            limit = f"must give a strain within {LARGEST_STRAIN:g}, not {strain:.3g} (1)"
            raise InputError.of(path, getattr(growth, path[1]), limit)
    return found


def _material(bearing: Bearing, part: str) -> tuple[tuple[str, ...], Material]:
    own: Material | None = getattr(getattr(bearing, part), "material", None) if part else None
    return (("bearing", part, "material"), own) if own else (("bearing", "material"), bearing.material)


def part_strain(bearing: Bearing, part: str, rise: float) -> float:
    """Strain of a bearing's part, cage or roller or, without a name, a ring, that is warmer by some kelvin (1)."""
    return material_strain(*_material(bearing, part), rise)


def material_strain(path: tuple[str, ...], material: Material, rise: float) -> float:
    """Strain of a material that is warmer by some kelvin (1); the path names it where its thermal expansion is missing."""
    if rise == 0.0:
        return 0.0
    if material.expansion is None:
        raise InputError.of((*path, "expansion"), None, "must be given: its temperature changes (1/K)")
    return material.expansion * rise


def _rotation(scene: Scene) -> float:
    """Strain of the cage's circumference by its rotation: density times speed squared over Young's modulus, the free ring's;
    where rims and bars are known the rims, which carry, bear the bars' mass too.
    """
    bearing, speed = scene.bearing, scene.speed_rpm
    if not is_constant(speed) or not is_constant(scene.outer_speed_rpm):
        raise InputError.of(("growth", "centrifugal"), True, "must be false where the speed of a ring changes in time")
    path, material = _material(bearing, "cage")
    if material.density is None:
        raise InputError.of((*path, "density"), None, "must be given: the cage grows by its rotation (kg/m3)")
    cage, geometry, carried = bearing.cage, bearing.geometry, 1.0
    height = 0.5 * (cage.wall_inner + cage.wall_outer)
    if cage.body is not None:
        wall = Wall.of(bearing, cage.body)
        weighed, height = cage_mass(wall, material.density), wall.height
        carried = weighed.mass / weighed.rims
    radius = 0.5 * bearing.pitch_diameter + height * math.cos(geometry.roller_axis_angle)
    rim_speed = scene.orbit_speed(scene.start.time) * radius
    return carried * material.density * rim_speed**2 / material.youngs_modulus


def roller_shift(bearing: Bearing, found: Strains) -> float:
    """How far the rollers' centres move outward (m); see the top of this file."""
    slide = apex_slide(bearing, found.inner_ring - found.rollers)
    return 0.5 * found.rollers * bearing.pitch_diameter + slide * math.sin(bearing.geometry.cone_half_angle)


def apex_slide(bearing: Bearing, relative: float) -> float:
    """How far the rollers slide along the cone, towards their large ends, when the inner ring has grown more than they by a
    strain (m); s at the top of this file.
    """
    geometry = bearing.geometry
    contact = np.array([geometry.rib_contact_radius, geometry.rib_contact_z])
    normal = np.array([math.sin(geometry.rib_normal_angle), math.cos(geometry.rib_normal_angle)])
    along = np.array([math.sin(geometry.cone_half_angle), math.cos(geometry.cone_half_angle)])
    return relative * float(contact @ normal) / float(along @ normal)


def grown_pocket(bearing: Bearing, pocket: Pocket, found: Strains) -> Pocket:
    """A pocket as its roller finds it when the parts have grown; refused where the nominal roller penetrates a face."""
    angle, radius = bearing.geometry.roller_axis_angle, 0.5 * bearing.pitch_diameter
    outward, axial = (
        np.array([math.cos(angle), 0.0, math.sin(angle)]),
        np.array([-math.sin(angle), 0.0, math.cos(angle)]),
    )
    relative, shift = found.cage - found.rollers, found.cage * radius - roller_shift(bearing, found)

    def moved(face: Face, along_axis: float) -> Face:
        origin = np.array(face.origin)
        middle = np.array(face.vertices.mean(axis=0))
        rho = radius + float(middle @ outward)
        by = (shift + found.rotation * rho) * outward + along_axis * axial
        by += relative * origin + found.rotation * middle[1] * np.array([0.0, 1.0, 0.0])
        if (
            face.part == "small_end"
        ):  # the part of the wall that the roller's end covers: it moves along the roller's axis alone
            return face.replace(origin=tuple((origin + np.array([0.0, 0.0, by[2]])).tolist()))
        outline = tuple((u * (1.0 + relative), v * (1.0 + relative)) for u, v in face.outline)
        return face.replace(origin=tuple((origin + by).tolist()), outline=outline)

    kept = [face.name for face in pocket.faces if face.part == "large_end"]
    before, along_axis = pocket.gaps(bearing.geometry), 0.0
    for _ in range(
        3 if kept else 0
    ):  # the gap of the large end is linear in the place along the axis but for 1e-4 of it
        grown = Pocket(faces=tuple(moved(face, along_axis) for face in pocket.faces), allow_interference=True)
        after = grown.gaps(bearing.geometry)
        along_axis -= (min(after[name] for name in kept) - min(before[name] for name in kept)) / math.cos(angle)
    return Pocket(
        faces=tuple(moved(face, along_axis) for face in pocket.faces), allow_interference=pocket.allow_interference
    )


def plays(bearing: Bearing, pocket: Pocket) -> tuple[float, float]:
    """Radial and circumferential play of a pocket as Cpr and Cpc are defined: how far the centred cage moves along the
    middle of the pocket, or across it, until a bar touches the nominal roller (m); infinite where no bar is in the way.
    """
    angle, gaps = bearing.geometry.roller_axis_angle, pocket.gaps(bearing.geometry)
    outward, across = np.array([math.cos(angle), 0.0, math.sin(angle)]), np.array([0.0, 1.0, 0.0])
    bars = [face for face in pocket.faces if face.part == "flank"]

    def play(direction: FloatArray) -> float:
        closing = [(gaps[face.name], float(face.normal @ direction)) for face in bars]
        return min((gap / rate for gap, rate in closing if rate > 1e-9), default=math.inf)

    return min(play(-outward), play(outward)), min(play(across), play(-across))


def running_pockets(scene: Scene) -> list[tuple[int, Face]]:
    """Every face of every pocket of the running bearing, about its cage's centre of mass: (pocket, face); pocket -1 stands
    for all.
    """
    bearing, growth = scene.bearing, scene.growth
    faces = bearing.pocket_faces()
    if growth is not None:
        found = strains(scene, growth)
        other = {entry.index: (place, entry.pocket) for place, entry in enumerate(bearing.cage.other_pockets)}
        grown: list[tuple[int, Face]] = []
        for index in [-1] if not other else range(bearing.n_rollers):
            where = "bearing.cage.pocket"
            pocket = bearing.pocket if index < 0 else bearing.pocket_of(index)
            if index in other:
                where = f"bearing.cage.other_pockets[{other[index][0]}].pocket"
            made = grown_pocket(bearing, pocket, found)
            if problems := made.problems(bearing.geometry):
                limit = f"leaves no play in {where}: {problems[0].allowed}"
                raise InputError.of("growth", str(growth), limit)
            grown += [(index, face) for face in made.faces]
        faces = grown
    return _off_centre(bearing, faces)


def _off_centre(bearing: Bearing, faces: list[tuple[int, Face]]) -> list[tuple[int, Face]]:
    """Faces about the centre of mass of a cage with unbalance: it lies off their axis, so they lie off its centre."""
    cage, angle = bearing.cage, bearing.geometry.roller_axis_angle
    if cage.unbalance == 0.0:
        return faces
    off, shifted = cage.unbalance / cage.mass, []
    for index in range(bearing.n_rollers):
        turned = math.radians(cage.unbalance_direction_deg) - 2.0 * math.pi * index / bearing.n_rollers
        radial, across = -off * math.cos(turned), -off * math.sin(turned)
        by = np.array([math.cos(angle) * radial, across, math.sin(angle) * radial])
        shifted += [
            (index, face.replace(origin=tuple((np.array(face.origin) + by).tolist())))
            for pocket, face in faces
            if pocket in (-1, index)
        ]
    return shifted


def running_clearance(scene: Scene) -> float:
    """Radial clearance of the land that guides the cage, of the running bearing (m)."""
    land, growth, guidance = scene.bearing.land, scene.growth, scene.effects.guidance
    if growth is None or guidance == "rollers":
        return land.clearance
    found = strains(scene, growth)
    cage = found.cage + found.rotation
    if guidance == "inner_land":
        return land.clearance + cage * (land.inner_radius + land.clearance) - found.inner_ring * land.inner_radius
    return land.clearance + found.outer_ring * land.outer_radius - cage * (land.outer_radius - land.clearance)
