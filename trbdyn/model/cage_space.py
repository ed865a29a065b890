"""The space that a cage can fill, and what follows for its mass and moments of inertia
(docs/theory/geometry.md#mass-and-inertia-of-the-cage).

A cage lies in a ring about the pitch circle, no further from it than a roller's diameter and what the rollers' inclination
asks for. Whatever its shape and material, its radius of gyration about the axis, sqrt(Iz/m), lies between the inner and
the outer radius of that ring; its transverse moment of inertia is It = Iz/2 + m <z^2>, z from its centre of mass along the
axis; and its mass is less than that of the ring without the rollers, made of the cage's material, or of tungsten where its
density is not given.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from trbdyn.errors import Problem

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing
    from trbdyn.model.cage import Cage
    from trbdyn.model.material import Material

DENSEST: Final = 20e3
"""Density that no material of a cage exceeds (kg/m3): tungsten has 19300."""
USUAL_FILL: Final = (30.0, 3000.0)
"""Mass of a cage over the volume of its space (kg/m3) of what can be meant: 90 for plastic, 550 for pressed steel."""
USUAL_SHARE: Final = (0.01, 0.35)
"""Share of its space that a cage of its material fills, of what can be meant: 0.07 for that of the 30310 rig."""
LARGEST_OFFSET: Final = 1.0
"""Distance of the centre of mass from the cage's axis, over the radial play, of what can be meant."""


@dataclass(frozen=True)
class CageSpace:
    """Where a cage can be: a ring."""

    inner: float  # radius of the ring (m)
    outer: float  # radius of the ring (m)
    half_width: float  # of the ring (m)
    near: float  # least radius of gyration of usual cages (m)
    far: float  # largest radius of gyration of usual cages (m)
    volume: float  # of the ring without the rollers (m3)

    @classmethod
    def of(cls, bearing: Bearing) -> CageSpace:
        """The space of the cage of a bearing."""
        roller, geometry, pitch = bearing.roller, bearing.geometry, 0.5 * bearing.pitch_diameter
        reach = roller.diameter + 0.5 * roller.total_length * math.sin(geometry.roller_axis_angle)
        half_width = 0.5 * roller.total_length + roller.diameter
        inner = max(pitch - reach, 0.1 * pitch)
        outer = max(pitch + reach, bearing.land.outer_radius)
        ring = 2.0 * math.pi * half_width * (outer**2 - inner**2)
        rollers = bearing.n_rollers * 0.25 * math.pi * roller.diameter**2 * roller.effective_length
        half = 0.5 * roller.diameter
        return cls(inner, outer, half_width, max(pitch - half, inner), pitch + half, max(ring - rollers, 0.1 * ring))

    def problems(self, cage: Cage, material: Material) -> list[Problem]:
        """What no cage of this bearing can have, made of this material."""
        mass, axial, transverse = cage.mass, cage.inertia_axial, cage.inertia_transverse
        heaviest = (material.density or DENSEST) * self.volume
        if mass > heaviest:
            what = f"the cage's material, {material.density:g} kg/m3" if material.density else "tungsten"
            limit = f"must be <= {heaviest:.3g}: the space between rollers and rings, filled with {what} (kg)"
            return [Problem(("cage", "mass"), mass, limit)]
        if cage.unbalance > mass * self.outer:
            limit = f"must be <= {mass * self.outer:.3g}: cage.mass times the largest radius of a cage (kg m)"
            return [Problem(("cage", "unbalance"), cage.unbalance, limit)]
        least, most = mass * self.inner**2, mass * self.outer**2
        if not least <= axial <= most:
            limit = (
                f"must be from {least:.3g} to {most:.3g}: with cage.mass = {mass:g} kg the radius of gyration is "
                f"{1e3 * math.sqrt(axial / mass):.3g} mm, but the cage lies between {1e3 * self.inner:.3g} and "
                f"{1e3 * self.outer:.3g} mm; leave the inertias out, and they follow the mass (kg m2)"
            )
            return [Problem(("cage", "inertia_axial"), axial, limit)]
        least, most = 0.5 * axial, 0.5 * axial + mass * self.half_width**2
        if not least * (1.0 - 1e-12) <= transverse <= most:
            limit = (
                f"must be from {least:.3g} to {most:.3g}: half of inertia_axial, and more by cage.mass = {mass:g} kg times the "
                f"mean square of the distance along the axis, at most {1e3 * self.half_width:.3g} mm (kg m2)"
            )
            return [Problem(("cage", "inertia_transverse"), transverse, limit)]
        return []

    def unusual(self, cage: Cage, material: Material) -> list[str]:
        """What a cage of this bearing can have, made of this material, but what can hardly be meant; only of what was given."""
        said, (light, heavy) = [], USUAL_FILL
        given = cage.model_fields_set
        radius = math.sqrt(cage.inertia_axial / cage.mass)
        if not self.near <= radius <= self.far and not given.isdisjoint(("mass", "inertia_axial")):
            said.append(
                f"bearing.cage.mass = {cage.mass:g} kg and inertia_axial = {cage.inertia_axial:g} kg m2 belong to a cage "
                f"with most of its mass at a radius of {1e3 * radius:.3g} mm; the rollers are between {1e3 * self.near:.3g} and "
                f"{1e3 * self.far:.3g} mm; leave the inertias out, and they follow the mass"
            )
        if "mass" in given and not light <= cage.mass / self.volume <= heavy:
            kind = "light" if cage.mass < light * self.volume else "heavy"
            said.append(
                f"bearing.cage.mass = {cage.mass:g} kg is {kind} for a cage of this bearing: usual are "
                f"{light * self.volume:.2g} to {heavy * self.volume:.2g} kg; 86 g are 0.086"
            )
        elif material.density is None:
            if "mass" not in given:
                said.append(
                    f"bearing.cage.mass = {cage.mass:g} kg is assumed as of steel, as the cage's material has no density"
                )
        elif "mass" in given and not USUAL_SHARE[0] <= cage.mass / (material.density * self.volume) <= USUAL_SHARE[1]:
            share = cage.mass / (material.density * self.volume)
            said.append(
                f"bearing.cage.mass = {cage.mass:g} kg of a material of {material.density:g} kg/m3 fills {100 * share:.2g} % "
                f"of the space between rollers and rings; usual are {100 * USUAL_SHARE[0]:g} to {100 * USUAL_SHARE[1]:g} %; "
                "a mass that was given does not follow a change of the material"
            )
        if cage.unbalance > LARGEST_OFFSET * cage.play_radial * cage.mass:
            said.append(
                f"bearing.cage.unbalance = {cage.unbalance:g} kg m puts the centre of mass "
                f"{1e3 * cage.unbalance / cage.mass:.3g} mm from the axis, more than the radial play of "
                f"{1e3 * cage.play_radial:.3g} mm; 1 g mm is 1e-6 kg m"
            )
        return said
