"""The inputs that are changed: nominal value, plausible other values, and why by so much.

A level is a set of overrides as `trbdyn.study` takes them. Values are assumptions as the nominal ones are; none was chosen after
looking at a result.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

from trbdyn.model.bearing import Bearing, Profile
from trbdyn.model.cases import rig_30310
from trbdyn.model.lubricants import vg100

Kind = Literal["input", "start", "load", "numerics"]
MICRO: Final = 1e-6


@dataclass(frozen=True)
class Level:
    """Another value of an input.

    Attributes
    ----------
    label : str
        The value with its unit, for tables and pictures.
    overrides : mapping of str to value
        What it changes.
    """

    label: str
    overrides: Mapping[str, Any]


@dataclass(frozen=True)
class Input:
    """One input.

    Attributes
    ----------
    name : str
        Short name.
    text : str
        What it is.
    path : str
        Where it is set; several paths, if it takes more than one.
    nominal : str
        Nominal value with its unit.
    levels : tuple of Level
        Other values, from low to high where they have an order.
    reason : str
        Why these are plausible.
    kind : {'input', 'start', 'load', 'numerics'}
        An input that the paper leaves open, the start, the direction of the load, or numerics: a check that the indicators
        do not depend on it.
    whirl_only : bool
        Runs only from the full orbit: other starts have no orbit whose growth could be told.
    combined_only : bool
        Runs only under combined load.
    """

    name: str
    text: str
    path: str
    nominal: str
    levels: tuple[Level, ...]
    reason: str
    kind: Kind = "input"
    whirl_only: bool = False
    combined_only: bool = False


def _levels(path: str, values: Mapping[str, Any]) -> tuple[Level, ...]:
    return tuple(Level(label, {path: value}) for label, value in values.items())


def _cage(factor_mass: float, factor_inertia: float, bearing: Bearing) -> dict[str, Any]:
    cage = bearing.cage
    return {
        "bearing.cage.mass": factor_mass * cage.mass,
        "bearing.cage.inertia_axial": factor_inertia * cage.inertia_axial,
        "bearing.cage.inertia_transverse": factor_inertia * cage.inertia_transverse,
    }


def _pocket(bearing: Bearing, **factors: float) -> dict[str, Any]:
    """The default pocket with factors of its faces."""
    faces = tuple(face.replace(**factors) for face in bearing.pocket.faces)
    return {"bearing.cage.pocket": bearing.pocket.replace(faces=faces)}


def _boundary(factor: float) -> dict[str, Any]:
    """Boundary friction at every slip, by a factor."""
    return {
        "effects.friction.boundary_limit": factor * 0.1,
        "effects.friction.boundary_slope": factor * 22.28,
    }


def _damping(race: float, cage: float) -> dict[str, Any]:
    return {
        "effects.damping": "hunt_crossley",
        "effects.damping_race": race,
        "effects.damping_cage": cage,
    }


def _wall(shift: float, bearing: Bearing) -> dict[str, Any]:
    cage = bearing.cage
    return {
        "bearing.cage.wall_inner": cage.wall_inner + shift,
        "bearing.cage.wall_outer": cage.wall_outer + shift,
    }


def _crown(bearing: Bearing, drop: float) -> Profile:
    """An arc with this drop at the ends of the effective length (m)."""
    return Profile.crowned((0.5 * bearing.roller.effective_length) ** 2 / (2.0 * drop))


def _one_large(bearing: Bearing, deviation: float) -> dict[str, Any]:
    values = [deviation, *(bearing.n_rollers - 1) * [0.0]]
    return {"bearing.roller.diameter_scatter": None, "bearing.roller.diameter_deviation": values}


def inputs(bearing: Bearing | None = None) -> tuple[Input, ...]:
    """The inputs for a bearing, the 30310 rig by default."""
    rig = rig_30310() if bearing is None else bearing
    return (*_cage_inputs(rig), *_contact_inputs(rig), *_oil_inputs(), *_roller_inputs(rig), *_other_inputs())


def _cage_inputs(rig: Bearing) -> tuple[Input, ...]:
    return (
        Input(
            "cage mass",
            "mass of the cage, its inertias in proportion",
            "bearing.cage.mass, .inertia_axial, .inertia_transverse",
            "0.20 kg",
            (Level("0.12 kg", _cage(0.6, 0.6, rig)), Level("0.30 kg", _cage(1.5, 1.5, rig))),
            "pressed steel cages of this size with sheets from 1.5 to 3 mm",
        ),
        Input(
            "cage inertia",
            "moments of inertia of the cage alone",
            "bearing.cage.inertia_axial, .inertia_transverse",
            "3.9e-4, 2.1e-4 kg m2",
            (Level("-25 %", _cage(1.0, 0.75, rig)), Level("+25 %", _cage(1.0, 1.25, rig))),
            "the same mass nearer to one rail or the other",
        ),
        Input(
            "centre of mass",
            "axial place of the cage's centre of mass",
            "bearing.cage.offset",
            "0 mm",
            _levels("bearing.cage.offset", {"-3 mm": -3e-3, "+3 mm": 3e-3}),
            "rails of unequal mass; the pocket is 20.8 mm long",
        ),
        Input(
            "axial play",
            "play of a roller along its axis in the pocket",
            "bearing.cage.play_axial",
            "0.4 mm",
            _levels("bearing.cage.play_axial", {"0.2 mm": 0.2e-3, "0.8 mm": 0.8e-3}),
            "half and twice: from about Cpr to three times Cpr",
        ),
        Input(
            "pocket friction",
            "friction between roller and pocket, all slips",
            "bearing.cage.pocket.faces[*].friction_factor",
            "1",
            (Level("0.5", _pocket(rig, friction_factor=0.5)), Level("2", _pocket(rig, friction_factor=2.0))),
            "boundary friction from 0.05 (good additives) to 0.2 (nearly dry)",
        ),
        Input(
            "pocket stiffness",
            "contact stiffness of the pocket",
            "bearing.cage.pocket.faces[*].stiffness_factor",
            "1 (solid steel)",
            (Level("0.1", _pocket(rig, stiffness_factor=0.1)), Level("0.3", _pocket(rig, stiffness_factor=0.3))),
            "bars of pressed sheet bend, the rigid cage does not: softer only",
        ),
        Input(
            "bar width",
            "width of the bars' faces",
            "bearing.cage.bar_width",
            "3 mm",
            _levels("bearing.cage.bar_width", {"2 mm": 2e-3, "5 mm": 5e-3}),
            "sheet thickness to fully machined bars",
        ),
        Input(
            "end walls",
            "place of the end walls' bands, outward of the roller's axis",
            "bearing.cage.wall_inner, .wall_outer",
            "1.5 to 4.5 mm",
            (Level("1 mm inward", _wall(-1e-3, rig)), Level("1 mm outward", _wall(1e-3, rig))),
            "moves the contact of the roller ends by a seventh of the roller's radius",
        ),
    )


def _contact_inputs(rig: Bearing) -> tuple[Input, ...]:
    return (
        Input(
            "boundary friction",
            "level of eq. 6 in every contact",
            "effects.friction.boundary_limit, .boundary_slope",
            "0.10",
            (Level("0.06", _boundary(0.6)), Level("0.15", _boundary(1.5))),
            "usual range of mineral oils on steel",
        ),
        Input(
            "cage entrainment",
            "speed that guards the slide-roll ratio at the cage",
            "effects.friction.cage_entrainment_speed",
            "0.05 m/s",
            _levels("effects.friction.cage_entrainment_speed", {"0.01 m/s": 0.01, "0.2 m/s": 0.2}),
            "no source: a fifth and four times",
        ),
        Input(
            "raceway roughness",
            "composite rms roughness of the raceways",
            "bearing.roughness.raceway",
            "0.16 µm",
            _levels("bearing.roughness.raceway", {"0.08 µm": 0.08e-6, "0.32 µm": 0.32e-6}),
            "half and twice: honed and run in, to ground",
        ),
        Input(
            "rib roughness",
            "composite rms roughness of the back-face rib",
            "bearing.roughness.rib",
            "0.24 µm",
            _levels("bearing.roughness.rib", {"0.12 µm": 0.12e-6, "0.48 µm": 0.48e-6}),
            "half and twice",
        ),
        Input(
            "rib height",
            "height of the large end's contact on the rib",
            "bearing.ribs.contact_height",
            "1.667 mm",
            _levels("bearing.ribs.contact_height", {"1.2 mm": 1.2e-3, "2.2 mm": 2.2e-3}),
            "within the rib's face, 0.3 to 3.5 mm; slide-roll ratio there in proportion",
        ),
        Input(
            "rib sphere",
            "radius of the large end over its apex distance",
            "bearing.roller.sphere_ratio",
            "0.90",
            _levels("bearing.roller.sphere_ratio", {"0.85": 0.85, "0.97": 0.97}),
            "usual design range",
        ),
        Input(
            "rib film",
            "film at the back-face rib",
            "effects.rib_film",
            "max",
            _levels("effects.rib_film", {"pe": "pe"}),
            "the piezoviscous-elastic film alone, in place of the thicker of both regimes",
        ),
        Input(
            "front rib",
            "gap between small end and front rib",
            "bearing.ribs.front_clearance",
            "0.2 mm",
            _levels("bearing.ribs.front_clearance", {"0.1 mm": 0.1e-3, "0.4 mm": 0.4e-3}),
            "half and twice",
        ),
        Input(
            "end stiffness",
            "stiffness of roller ends against walls",
            "bearing.roller.end_stiffness",
            "1e10 N/m^1.5",
            _levels("bearing.roller.end_stiffness", {"1e9": 1e9, "1e11": 1e11}),
            "from an edge contact to a full sphere on a flat",
        ),
        Input(
            "damping",
            "normal damping of contacts, races and pockets",
            "effects.damping, .damping_race, .damping_cage",
            "off",
            (Level("0.1, 0.5 s/m", _damping(0.1, 0.5)), Level("0.5, 2.5 s/m", _damping(0.5, 2.5))),
            "Hunt-Crossley: the recommended values, and five times them",
        ),
    )


def _oil_inputs() -> tuple[Input, ...]:
    return (
        Input(
            "contact temperature",
            "temperature of the oil in all contacts",
            "lubricant",
            "60 °C",
            _levels("lubricant", {"50 °C": vg100(50.0), "80 °C": vg100(80.0)}),
            "surfaces may be hotter than the measured 60 °C, the oil colder",
        ),
        Input(
            "pressure law",
            "viscosity against pressure in the traction",
            "lubricant.pressure_law",
            "Dicke",
            _levels("lubricant.pressure_law", {"Roelands": "roelands", "Barus": "barus"}),
            "measured law against the two usual extrapolations",
        ),
        Input(
            "starvation",
            "factor of every film thickness",
            "effects.starvation_factor",
            "1",
            _levels("effects.starvation_factor", {"0.25": 0.25, "0.5": 0.5}),
            "the rig ran on air-oil: thinner only",
        ),
        Input(
            "Eyring stress",
            "tau0 of the traction",
            "lubricant.eyring_stress",
            "5 MPa",
            _levels("lubricant.eyring_stress", {"3 MPa": 3e6, "8 MPa": 8e6}),
            "range of mineral oils",
        ),
        Input(
            "shear modulus",
            "smallest limiting shear modulus of the traction",
            "lubricant.shear_modulus_floor",
            "10 MPa",
            _levels("lubricant.shear_modulus_floor", {"1 MPa": 1e6, "100 MPa": 1e8}),
            "the law gives 70 MPa at 4930 N and the floor at 1230 N; the law itself has no factor to change",
        ),
        Input(
            "rolling blend",
            "half width over which rolling resistance sets in",
            "effects.friction.rolling_blend",
            "0.1",
            _levels("effects.friction.rolling_blend", {"0.02": 0.02, "0.4": 0.4}),
            "nearly the paper's switch, to a wide band",
        ),
        Input(
            "pressure force",
            "pressure force of the rolling film on the roller",
            "effects.rolling_pressure_force",
            "off",
            _levels("effects.rolling_pressure_force", {"on": True}),
            "left out by the paper; needed for equal torques on both rings",
        ),
    )


def _roller_inputs(rig: Bearing) -> tuple[Input, ...]:
    return (
        Input(
            "profile",
            "generator of the rollers",
            "bearing.roller.profile",
            "logarithmic",
            _levels("bearing.roller.profile", {"straight": Profile.straight(), "crowned": _crown(rig, 10 * MICRO)}),
            "the other two usual kinds; the arc drops 10 µm at the ends as the logarithm does",
        ),
        Input(
            "diameter scatter",
            "deviation of the rollers' diameters",
            "bearing.roller.diameter_scatter, .diameter_deviation",
            "none",
            (
                Level("0.2 µm range", {"bearing.roller.diameter_scatter.range": 0.2 * MICRO}),
                Level("1 µm range", {"bearing.roller.diameter_scatter.range": MICRO}),
                Level("one +1 µm", _one_large(rig, MICRO)),
            ),
            "the paper's scatter (uniform, seeded), and one roller off by as much",
        ),
    )


def _other_inputs() -> tuple[Input, ...]:
    uniform = {"effects.quadrature": "uniform", "effects.n_slices": 24}
    return (
        Input(
            "start",
            "spacing of the rollers at the start",
            "start.kind",
            "whirl, 0.9 Cpr",
            _levels("start.kind", {"equal": "equal", "unequal": "unequal"}),
            "cage at rest, rollers evenly spaced or off by up to 0.8 Cpc (seeded)",
            "start",
            whirl_only=True,
        ),
        Input(
            "load direction",
            "direction of the radial load on the inner ring",
            "scene.radial_direction_deg",
            "90° (loaded zone on top)",
            _levels("scene.radial_direction_deg", {"0°": 0.0, "180°": 180.0, "-90°": -90.0}),
            "the paper does not give the sense: loaded zone where rollers rise, where they descend, at the bottom",
            "load",
            combined_only=True,
        ),
        Input(
            "tolerances",
            "tolerances of the integrator",
            "run.accuracy",
            "fast",
            _levels("run.accuracy", {"standard": "standard"}),
            "a third of the error",
            "numerics",
        ),
        Input(
            "nodes",
            "nodes along a contact line",
            "effects.quadrature, .n_slices",
            "8 Gauss",
            (Level("24 uniform", uniform), Level("16 Gauss", {"effects.n_slices": 16})),
            "the paper's slices, and twice the nodes",
            "numerics",
        ),
        Input(
            "run time",
            "bearing time of a run; statistics take the last two thirds",
            "run.duration",
            "see the points",
            (Level("twice", {}),),
            "indicators are comparable if this hardly matters",
            "numerics",
        ),
    )
