"""Inputs of a bearing that were not given: assumed in proportion to the 30310 rig (docs/theory/geometry.md#the-30310-in-numbers).

A number is *given* where the user gave it, and *assumed* otherwise; `Bearing.assumed` lists the latter, and a result
keeps the list. An assumed number follows the bearing: after ``bearing.replace(pitch_diameter=...)`` it is that of the
new size.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from trbdyn.base.validation import Model, as_number
from trbdyn.errors import InputError, Problem

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing

RIG: Final[dict[str, float]] = {
    "diameter": 14.0e-3,
    "effective_length": 19.8e-3,
    "pitch_diameter": 82.389e-3,
    "total_length": 20.8e-3,
    "end_stiffness": 1e10,
    "load": 1833.0,
    "contact_height": 1.667e-3,
    "edge_low": 0.3e-3,
    "edge_high": 3.5e-3,
    "front_clearance": 0.2e-3,
    "front_low": 0.3e-3,
    "front_high": 2.0e-3,
    "density": 7810.0,
    "mass": 0.20,
    "inertia_axial": 3.9e-4,
    "inertia_transverse": 2.1e-4,
    "play_radial": 0.25e-3,
    "play_circumferential": 0.12e-3,
    "play_axial": 0.4e-3,
    "rail_offset": 12e-3,
    "bar_width": 3e-3,
    "wall_inner": 1.5e-3,
    "wall_outer": 4.5e-3,
    "wall_half_width": 6e-3,
    "land_inner_radius": 39.5e-3,
    "land_outer_radius": 50.5e-3,
    "land_width": 3e-3,
    "land_clearance": 0.1e-3,
    "land_contact_film": 1e-6,
}
"""Numbers of the 30310 rig (m, kg, kg m2, kg/m3, N, N/m^1.5), to which assumed ones are in proportion."""

ISO_SHORT, ISO_LONG, ISO_LENGTH = 0.00035, 0.0005, 2.5
"""Profile of ISO/TS 16281: drop over diameter of cylindrical rollers up to the third number's diameters long, and of longer ones,
whose ends drop over this length."""
ISO_TAPERED: Final = 0.00045
"""The same of tapered rollers of any length (ISO 16281)."""
PROFILE_BAND: Final = (0.00025, 0.0006)
"""Drop over diameter that rollers of unknown profile may have: makers crown them; the standard has 0.00035 and 0.00045, rollers
of a 32216 have 0.0005 (Wingertszahn et al. 2023). Both ends lie a fifth to a third beyond these: assumed."""

PROFILE_FIELDS: Final[dict[str, tuple[str, ...]]] = {
    "iso": ("a_p", "c_p", "d_p", "k_p"),
    "logarithmic": ("k1", "k2", "zm", "load"),
    "crowned": ("crown_radius",),
    "straight": (),
    "table": (),
}
"""Numbers of a profile that its kind uses."""
RACEWAY_PROFILES: Final = ("cup_profile", "cone_profile")

END_RADIUS: Final = 50.0
"""Radius of the ends of cylindrical rollers over their diameter: the ribs' faces then open by 0.4 degrees."""
RIB_CLEARANCE: Final = 1.5e-3
"""Gap between the end of a cylindrical roller and each rib over the roller's diameter."""

_WITH_DIAMETER: Final = {
    "ribs": ("contact_height", "front_clearance", "front_low", "front_high"),
    "cage": ("play_radial", "play_circumferential", "play_axial", "bar_width", "wall_half_width"),
}
_CONSTANT: Final = {
    "roller": ("sphere_ratio",),
    "roller.profile": ("kind", "k1", "k2", "zm", "k_p"),
    "cage": ("offset",),
    "material": ("youngs_modulus", "poisson_ratio", "density", "expansion", "damping_ratio"),
    "roughness": ("raceway", "rib", "pocket"),
    "land": ("fill",),
}
"""Assumed numbers that do not depend on the size."""
_SECTIONS: Final = ("roller", "ribs", "cage", "material", "roughness", "land")

Values = dict[str, Any]


def _small_end_radius(given: Mapping[str, float]) -> float:
    """Radius of the roller's small end (m); the cones follow from the same fixed-point iteration as in the core."""
    cup, pitch, diameter = math.radians(given["cup_half_angle_deg"]), given["pitch_diameter"], given["diameter"]
    nu = 0.0
    for _ in range(50):
        nu = math.atan2(0.5 * diameter * math.sin(cup - nu), 0.5 * pitch)
    return 0.5 * diameter - 0.5 * given["total_length"] * math.tan(nu)


def scaled(size: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Numbers that belong to a bearing of a size, by section: 'roller', 'roller.profile', 'ribs', 'cage', 'land'. The size has
    diameter, effective_length, pitch_diameter (m), cup_half_angle_deg (deg), and as far as they are given total_length (m),
    contact_height (m), the cage's mass (kg), the land's clearance (m), and the densities of the materials of rollers and cage
    (kg/m3; else that of steel).
    """
    across, along = size["diameter"] / RIG["diameter"], size["effective_length"] / RIG["effective_length"]
    pitch = size["pitch_diameter"] / RIG["pitch_diameter"]
    total = size.get(
        "total_length", size["effective_length"] + (RIG["total_length"] - RIG["effective_length"]) * across
    )
    made: dict[str, dict[str, float]] = {
        section: {name: RIG[name] * across for name in names} for section, names in _WITH_DIAMETER.items()
    }
    made["roller"] = {"total_length": total, "end_stiffness": RIG["end_stiffness"] * math.sqrt(across)}
    made["roller"]["density"] = size.get("roller_density", RIG["density"])
    cylinder = size["cup_half_angle_deg"] == 0.0
    made["roller"]["end_radius"] = END_RADIUS * size["diameter"] if cylinder else 0.0
    made["ribs"]["clearance"] = RIB_CLEARANCE * size["diameter"] if cylinder else 0.0
    ends = min(size["effective_length"], ISO_LENGTH * size["diameter"]) if cylinder else size["effective_length"]
    middle = size["effective_length"] - ends
    made["roller.profile"] = {
        "load": RIG["load"] * (across * along),
        "a_p": ISO_LONG if middle > 0.0 else ISO_SHORT if cylinder else ISO_TAPERED,
        "c_p": ends,
        "d_p": middle,
    }
    made |= dict.fromkeys(RACEWAY_PROFILES, made["roller.profile"])
    height = size.get("contact_height", made["ribs"]["contact_height"]) / RIG["contact_height"]
    made["ribs"] |= {name: RIG[name] * height for name in ("edge_low", "edge_high")}
    dense = size.get("cage_density", RIG["density"]) / RIG["density"]
    mass = size.get("mass", cage_mass(pitch, across, along) * dense)
    made["cage"] |= cage_inertias(mass, pitch, across, along)
    end = _small_end_radius({**size, "total_length": total})
    end = end if end > 0.0 else math.inf  # a roller beyond the apex: the core reports it
    # the rails of a cylindrical bearing's cage stay clear of the outer ring's ribs
    free = 0.5 * size["diameter"] - made["ribs"]["edge_high"] if cylinder else end
    made["cage"] |= {
        "mass": mass,
        "rail_offset": RIG["rail_offset"] * along,
        "wall_inner": min(RIG["wall_inner"] * across, 0.3 * end),
        "wall_outer": min(RIG["wall_outer"] * across, 0.9 * free),
    }
    clearance = size.get("clearance", RIG["land_clearance"] * across)
    made["land"] = {
        "offset": RIG["rail_offset"] * along,
        "inner_radius": RIG["land_inner_radius"] * pitch,
        "outer_radius": RIG["land_outer_radius"] * pitch,
        "width": RIG["land_width"] * along,
        "clearance": clearance,
        "contact_film": RIG["land_contact_film"] * (clearance / RIG["land_clearance"]),
    }
    return made


def cage_mass(pitch: float, across: float, along: float) -> float:
    """Mass (kg) of a cage of steel, whose walls are thicker by the roller's diameter. `pitch`, `across` and `along` are pitch
    diameter, roller diameter and roller length over those of the rig.
    """
    return RIG["mass"] * (pitch * across * along)


def cage_inertias(mass: float, pitch: float, across: float, along: float) -> dict[str, float]:
    """Moments of inertia (kg m2) of a cage of this mass (kg): Iz with the square of its radius of gyration, which lies outside
    of the pitch circle by a share of the roller's diameter; It = Iz/2 + m <z^2>, its second part with length squared. `pitch`,
    `across` and `along` as for `cage_mass`.
    """
    heavier = mass / RIG["mass"]
    circle = (
        0.5 * RIG["pitch_diameter"] / math.sqrt(RIG["inertia_axial"] / RIG["mass"])
    )  # over the rig's radius of gyration
    wider = 1.0 + circle * (pitch - 1.0) + (1.0 - circle) * (across - 1.0)
    axial = RIG["inertia_axial"] * (heavier * wider**2)
    along_axis = RIG["inertia_transverse"] - 0.5 * RIG["inertia_axial"]
    return {"inertia_axial": axial, "inertia_transverse": 0.5 * axial + along_axis * (heavier * along**2)}


_SCALED: Final = {name: tuple(numbers) for name, numbers in scaled({**RIG, "cup_half_angle_deg": 12.95}).items()}
"""Names of those numbers, by section."""


def with_assumed(values: Mapping[str, Any], kinds: Mapping[str, type[Model]]) -> Values:
    """Fields of a bearing, its sections made whole with assumed numbers; `kinds` has the model of each section by its path.

    A list ``assumed`` among the fields, as `Bearing.to_dict` writes it, says which of the numbers were not given: they stay as
    they are, so that a result keeps what it was made with.
    """
    found = dict(values)
    kept = found.pop("assumed", ())
    if not isinstance(kept, list | tuple) or not all(isinstance(path, str) for path in kept):
        raise InputError.of(("bearing", "assumed"), kept, "must be a list of paths of inputs, such as 'cage.bar_width'")
    kept = set(kept)
    sections = {name: _given(found.get(name, {})) for name in _SECTIONS}
    if any(section is None for section in sections.values()) or "roller" not in found:
        return found
    given: dict[str, Values] = {name: dict(section or {}) for name, section in sections.items()}
    profile = _given(given["roller"].get("profile", {}))
    if profile is None:
        return found
    given["roller.profile"] = profile
    for name in RACEWAY_PROFILES:
        if (raceway := _given(found.get(name))) is not None:
            given[name] = raceway
    stored = {
        section: {name: numbers.pop(name) for name in list(numbers) if f"{section}.{name}" in kept}
        for section, numbers in given.items()
    }
    size = _size(found, given)
    made: Mapping[str, Mapping[str, float]] = {} if size is None else scaled(size)
    problems: list[Problem] = []

    def build(kind: type[Model], section: str, extra: Values, raw: Any) -> Any:
        numbers = {**made.get(section, {}), **stored[section], **given[section], **extra}
        try:
            model = kind(**numbers)
        except InputError as error:
            if isinstance(raw, Mapping):
                return numbers  # reported with everything else that is wrong when the fields of the bearing are checked
            problems.extend(error.under(tuple(section.split("."))).problems)
            return raw
        object.__setattr__(model, "__pydantic_fields_set__", {*given[section], *extra})
        return model

    own = build(kinds["roller.profile"], "roller.profile", {}, given["roller"].get("profile", {}))
    for section in _SECTIONS:
        given[section].pop("profile", None)
        extra = {"profile": own} if section == "roller" else {}
        found[section] = build(kinds[section], section, extra, found.get(section, {}))
    for name in RACEWAY_PROFILES:
        if name in given:
            found[name] = build(kinds["roller.profile"], name, {}, found[name])
    if problems:
        raise InputError(problems)
    return found


def _given(section: Any) -> Values | None:
    """What was given of a section; None if it is none."""
    if isinstance(section, Model):
        return {name: getattr(section, name) for name in section.model_fields_set}
    return dict(section) if isinstance(section, Mapping) else None


def _size(found: Values, given: Mapping[str, Values]) -> dict[str, float] | None:
    """What assumed numbers depend on; None where it is missing or cannot be right, which is reported elsewhere."""
    wanted = {
        "diameter": given["roller"].get("diameter"),
        "effective_length": given["roller"].get("effective_length"),
        "pitch_diameter": found.get("pitch_diameter"),
        "cup_half_angle_deg": found.get("cup_half_angle_deg"),
    }
    optional = {
        "total_length": given["roller"].get("total_length"),
        "contact_height": given["ribs"].get("contact_height"),
        "mass": given["cage"].get("mass"),
        "clearance": given["land"].get("clearance"),
        "roller_density": _density(given["roller"].get("material") or given["material"]),
        "cage_density": _density(given["cage"].get("material") or given["material"]),
    }
    size: dict[str, float] = {}
    for name, value in {**wanted, **optional}.items():
        try:
            number = as_number(value)
        except ValueError:
            number = math.nan
        cylinders = name == "cup_half_angle_deg" and number == 0.0
        if cylinders or (math.isfinite(number) and 0.0 < number < 1e6):
            size[name] = number
        elif name in wanted:
            return None
    return size


def _density(material: object) -> object:
    """Density of a material as it was given (kg/m3); None if it has none. Steel, where no material was given."""
    if isinstance(material, Mapping):
        return material.get("density") if material else RIG["density"]
    return getattr(material, "density", None)


def assumed_inputs(bearing: Bearing) -> dict[str, float]:
    """Inputs that were not given: value by path."""
    names = {section: (*_SCALED.get(section, ()), *_CONSTANT.get(section, ())) for section in {**_CONSTANT, **_SCALED}}
    for raceway in RACEWAY_PROFILES:
        names[raceway] = names["roller.profile"] if getattr(bearing, raceway) is not None else ()
    found: dict[str, float] = {}
    for section, fields in names.items():
        part: Any = bearing
        for name in section.split("."):
            part = getattr(part, name)
        of_kind = PROFILE_FIELDS.get(getattr(part, "kind", ""))
        unused = set() if of_kind is None else {*fields} - {"kind", *of_kind}
        found |= {
            f"{section}.{name}": getattr(part, name)
            for name in fields
            if name not in part.model_fields_set and name not in unused and getattr(part, name) is not None
        }
    return found
