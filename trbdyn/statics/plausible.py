"""Inputs that are allowed but can hardly be meant: said in a warning, and kept with the result."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from trbdyn.model.cage_body import Wall, cage_mass
from trbdyn.model.cage_space import CageSpace
from trbdyn.model.catalogue_rollers import CYLINDRICAL, TAPERED
from trbdyn.model.defects import DepthMap, Pit
from trbdyn.model.motion import value_at, values_of
from trbdyn.model.scene import Scene
from trbdyn.statics.equilibrium import Equilibrium

PERMISSIBLE_PRESSURE: Final = 4e9
"""Pressure (Pa) at which the most loaded roller keeps a dent of a ten thousandth of its diameter: ISO 76, roller
bearings.
"""

LOADED_SHARE: Final = 0.05
"""Share of the heaviest load of a roller up to which a place of the outer ring counts as unloaded."""
BODY_MASS: Final = 0.05
"""Share by which a cage may be heavier or lighter than the finite-element model by whose modes it deforms."""
LARGEST_PLAY_SHARE: Final = 0.1
"""Largest usual play of a cage's pocket, in units of the roller's diameter; usual are 0.01 to 0.03."""
LARGEST_TILT: Final = 0.01
"""Largest misalignment (rad) that can be meant: with 10 mrad rollers carry at one end only; bearings are made for 0.5 to 1."""

_PRESSURES: Final = ("outer_pressure_peak", "inner_pressure_peak")


class UnusualInput(UserWarning):
    """Input that is allowed but can hardly be meant."""


def unusual(scene: Scene, equilibrium: Equilibrium) -> tuple[str, ...]:
    """What can hardly be meant in a scene: one sentence for each, with the field, its value and what is usual."""
    return tuple(
        text
        for text in (
            _pressure(scene, equilibrium),
            *_plays(scene),
            *_pocket_film(scene),
            *_cage(scene),
            _fill(scene),
            _gravity(scene),
            *_tilts(scene),
            _planar(scene),
            *_defects(scene, equilibrium),
        )
        if text
    )


def _tilts(scene: Scene) -> list[str]:
    """Misalignments that can hardly be meant in radians."""
    found = []
    for name in ("misalignment_x", "misalignment_y"):
        angle = max(values_of(getattr(scene, name)), key=abs)
        if abs(angle) > LARGEST_TILT:
            found.append(
                f"{name} = {angle:g} rad is {math.degrees(angle):.3g} degrees: bearings are made for about 0.001 rad; "
                f"if it was meant in mrad, give {1e-3 * angle:g}"
            )
    return found


def _pressures(scene: Scene, equilibrium: Equilibrium) -> dict[str, float]:
    """Hertz pressure (Pa) of the most loaded roller on each raceway at mid length, its load spread over its effective length."""
    geometry, roller = scene.bearing.geometry, scene.bearing.roller
    radii = {"outer": geometry.outer_equivalent_radius, "inner": geometry.inner_equivalent_radius}
    loads = {"outer": equilibrium.outer_load, "inner": equilibrium.inner_load}
    lines = {race: max(float(np.max(load)), 0.0) / roller.effective_length for race, load in loads.items()}
    return {
        race: math.sqrt(line * geometry.effective_modulus / (2.0 * math.pi * radii[race]))
        for race, line in lines.items()
    }


def _defects(scene: Scene, equilibrium: Equilibrium) -> list[str]:
    """Pits that are shorter than the contact, which rollers roll over on their whole width; defects that no load meets."""
    geometry, pressures = scene.bearing.geometry, _pressures(scene, equilibrium)
    radii = {"outer": geometry.outer_equivalent_radius, "inner": geometry.inner_equivalent_radius}
    widths = {race: 8.0 * radii[race] * pressure / geometry.effective_modulus for race, pressure in pressures.items()}
    found = []
    for place, defect in enumerate(scene.defects):
        length = defect.length if isinstance(defect, Pit) else math.inf
        width = max(widths.values()) if defect.on == "roller" else widths[defect.on]
        if length < width:
            found.append(
                f"defects[{place}].length = {length:g} m is less than the width of the most loaded contact, {width:.2g} m: a "
                "contact is a line here, which sinks in further than one that bears on both sides of the pit"
            )
        if isinstance(defect, Pit | DepthMap) and defect.on == "outer" and not scene.outer_turns:
            found += _unmet(place, defect.angle_deg, equilibrium)
    return found


def _unmet(place: int, angle_deg: float, equilibrium: Equilibrium) -> list[str]:
    """What is said of a defect of an outer ring at rest where no roller carries a load that is worth the name."""
    off = np.abs((np.rad2deg(equilibrium.angles) - angle_deg + 180.0) % 360.0 - 180.0)
    load = equilibrium.outer_load
    beside = np.argsort(off)[:2]
    if load[beside].max() > LOADED_SHARE * load.max():
        return []
    heaviest = float(np.rad2deg(equilibrium.angles[int(np.argmax(load))]) % 360.0)
    return [
        f"defects[{place}].angle_deg = {angle_deg:g} lies where the rollers carry hardly any load, so that the defect changes "
        f"nothing: the heaviest load is near {heaviest:.0f} deg, and a radial load acts at radial_direction_deg, by default 90"
    ]


def _pressure(scene: Scene, equilibrium: Equilibrium) -> str:
    worst = max(_pressures(scene, equilibrium).values())
    if worst <= PERMISSIBLE_PRESSURE:
        return ""
    loads = f"axial_load = {value_at(scene.axial_load, scene.start.time):g} N, radial_load = "
    loads += f"{value_at(scene.radial_load, scene.start.time):g} N"
    cause = loads if scene.displacement is None else f"displacement = {scene.displacement} m, {loads}"
    return (
        f"the most loaded roller has a pressure of {worst / 1e9:.3g} GPa under {cause}: above "
        f"{PERMISSIBLE_PRESSURE / 1e9:g} GPa (ISO 76) raceways are dented, but contacts are elastic here"
    )


def dented(peaks: Mapping[str, Any]) -> str:
    """A sentence where the largest pressure of a run on a raceway is above the static limit; empty where it is not."""
    worst = max((float(np.max(peaks[name])) for name in _PRESSURES if name in peaks), default=0.0)
    if worst <= PERMISSIBLE_PRESSURE:
        return ""
    return (
        f"the largest pressure on a raceway was {worst / 1e9:.3g} GPa: above {PERMISSIBLE_PRESSURE / 1e9:g} GPa (ISO 76) "
        "raceways are dented, but contacts are elastic here"
    )


def _cage(scene: Scene) -> list[str]:
    """Mass and inertia that a cage can have, but that can hardly be meant."""
    if not scene.effects.has_cage:
        return []
    return CageSpace.of(scene.bearing).unusual(scene.bearing.cage, scene.bearing.cage_material) + _body(scene)


def _body(scene: Scene) -> list[str]:
    """A cage that weighs something else than the finite-element model whose modes it deforms by."""
    bearing, cage = scene.bearing, scene.bearing.cage
    density = bearing.cage_material.density
    if scene.elastic_cage is None or scene.elastic_cage.file is not None or cage.body is None or density is None:
        return []
    weighed = cage_mass(Wall.of(bearing, cage.body), density).mass
    if abs(cage.mass / weighed - 1.0) <= BODY_MASS:
        return []
    return [
        f"bearing.cage.mass = {cage.mass:g} kg, but the rims and bars whose natural modes elastic_cage takes weigh "
        f"{weighed:.4g} kg: its frequencies are those of that body; let mass and inertia follow from bearing.cage.body"
    ]


def _fill(scene: Scene) -> str:
    """Number or size of rollers changed by hand, where the others are still those that were estimated with it."""
    bearing = scene.bearing
    kept = {entry.path for entry in bearing.estimated}
    listed = {entry.path for entry in bearing.estimates}
    sizes = {"n_rollers", "roller.diameter", "pitch_diameter"}
    if not sizes & kept or not sizes & (listed - kept):
        return ""
    fill = bearing.n_rollers * bearing.roller.diameter / (math.pi * bearing.pitch_diameter)
    usual = (CYLINDRICAL if bearing.is_cylindrical else TAPERED).fill
    if usual.low - 0.02 <= fill <= usual.high + 0.02:
        return ""
    changed = ", ".join(f"bearing.{path}" for path in sorted(sizes & (listed - kept)))
    return (
        f"{changed} was changed, and the other sizes are still those that were estimated with the former value: rollers take "
        f"{100 * fill:.3g} % of the pitch circle, usual are {100 * usual.low:g} to {100 * usual.high:g} %; give it to "
        "Bearing.from_catalogue, which derives the others again"
    )


def _plays(scene: Scene) -> list[str]:
    cage, most = scene.bearing.cage, LARGEST_PLAY_SHARE * scene.bearing.roller.diameter
    if not scene.effects.has_cage:
        return []
    return [
        f"bearing.cage.{name} = {getattr(cage, name):g} m is more than a tenth of the roller's diameter "
        f"({scene.bearing.roller.diameter:g} m); usual are 0.01 to 0.03 of it"
        for name in ("play_radial", "play_circumferential", "play_axial")
        if getattr(cage, name) > most
    ]


def _pocket_film(scene: Scene) -> list[str]:
    """A film in the pockets that cannot be, or that is hardly one."""
    film, rough = scene.effects.pocket_film, scene.bearing.roughness.pocket
    most = LARGEST_PLAY_SHARE * scene.bearing.roller.diameter
    if not film:
        return []
    if not scene.effects.films or not scene.effects.has_cage or not scene.effects.pocket_bars:
        return [f"effects.pocket_film = {film:g} m makes no film: it needs lubricant films, a cage and its bars"]
    found = []
    if film > most:
        found.append(
            f"effects.pocket_film = {film:g} m is more than a tenth of the roller's diameter, where its law, of narrow "
            "gaps, does not hold; usual are 1e-5 to 2e-4 m"
        )
    if film < 2.0 * rough:
        found.append(
            f"effects.pocket_film = {film:g} m is less than twice bearing.roughness.pocket = {rough:g} m, below which the "
            "film gets no thinner: so it does not depend on the gap"
        )
    return found


def _gravity(scene: Scene) -> str:
    size = math.hypot(*(max(values_of(part), key=abs) for part in scene.gravity))
    if not scene.effects.gravity or abs(size - 1.0) > 1e-6:
        return ""
    given = ", ".join(f"{value_at(part, scene.start.time):g}" for part in scene.gravity)
    return (
        f"gravity = ({given}) m/s2 is a tenth of the Earth's: it is an acceleration and not a direction; "
        "(0, -9.80665, 0) is the usual one"
    )


def _planar(scene: Scene) -> str:
    if not scene.effects.planar or not any(values_of(scene.radial_load)):
        return ""
    return (
        "effects.planar = true with radial_load: axial positions of the rollers stay those of the start as they orbit, so "
        "that ring forces are off by some per cent"
    )
