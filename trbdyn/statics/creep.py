"""How rollers creep when the cage leans on them: traction slope at tiny slip, creep number, Froude number
(docs/theory/whirl.md#creep-of-rollers).

A roller that the cage pushes with a tangential force F drifts in its orbit with the speed v' F: each raceway carries
F/2 by sliding, and the drift of the roller's centre is the mean of both slidings, so v' = (1/Co + 1/Ci)/4 with C =
dF/d(sliding speed) at the outer and inner raceway. The creep number chi = m_c g T_c v'/Cpc is the distance that a
roller drifts under the cage's weight in one turn of the cage, in units of the circumferential play; the Froude number
Fn = omega_c^2 Cpr/g is the centrifugal force of a cage that whirls at the edge of its play over its weight.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trbdyn import laws
from trbdyn.errors import InputError, TrbError
from trbdyn.model.bearing import Bearing
from trbdyn.model.effects import Effects
from trbdyn.model.lubricants import Lubricant
from trbdyn.model.motion import value_at
from trbdyn.model.scene import Scene
from trbdyn.statics.contacts_at_start import contacts_at_start

Array = NDArray[np.float64]

SLIDE_ROLL = 1e-10
"""Slide-roll ratio at which the slope is taken: far inside the linear range of all laws."""


@dataclass(frozen=True)
class Creep:
    """How rollers creep at the equilibrium of a scene.

    Attributes
    ----------
    slope : ndarray, shape (2, Z)
        dF/d(sliding speed) at zero slip, outer and inner raceway, each roller (N s/m).
    drift : ndarray, shape (Z,)
        v': drift speed of a roller per tangential force (m/s/N).
    load : ndarray, shape (2, Z)
        Normal load, outer and inner raceway (N).
    film_parameter : ndarray, shape (2,)
        Smallest film parameter over all loaded nodes, outer and inner raceway (1).
    deborah : ndarray, shape (2,)
        D of Muraki and Kimura, weighted with load: above 2 the film answers tiny slip as an elastic solid, below as a
        liquid (1).
    chi : float
        Creep number from the mean drift (1).
    froude : float
        Froude number (1).
    unevenness : float
        l = 0.5 ln(v'max/v'min): 0 under axial load (1).
    cage_period : float
        T_c, time of a turn of the cage (s).
    """

    slope: Array
    drift: Array
    load: Array
    film_parameter: Array
    deborah: Array
    chi: float
    froude: float
    unevenness: float
    cage_period: float


def contact_viscosity(oil: Lubricant, pressure: Array) -> Array:
    """Viscosity (Pa s) of an oil at a pressure (Pa), by its pressure law."""
    if oil.pressure_law == "dicke":
        law = oil.dicke
        assert law is not None
        exponent = laws.viscosity_dicke(pressure, oil.temperature_c, law.a, law.b, law.c, law.d)
    elif oil.pressure_law == "roelands":
        exponent = laws.viscosity_roelands(
            pressure, oil.pressure_coefficient, oil.viscosity, oil.viscosity_exponent_cap
        )
    else:
        exponent = laws.viscosity_barus(pressure, oil.pressure_coefficient, oil.viscosity_exponent_cap)
    return np.asarray(oil.viscosity * np.exp(exponent))


def friction_slope(
    oil: Lubricant,
    effects: Effects,
    *,
    pressure: Array,
    half_width: Array,
    mean_speed: Array,
    film: Array,
    roughness: float,
) -> tuple[Array, Array]:
    """Friction coefficient over sliding speed of line contacts at zero slip (s/m), and D of Muraki and Kimura (1).

    Parameters
    ----------
    oil, effects : Lubricant, Effects
        The oil in the contact; laws and constants.
    pressure, half_width, mean_speed, film : ndarray
        Largest Hertz pressure (Pa), half width (m), mean surface speed (m/s), film thickness at zero slip (m).
    roughness : float
        Composite rms roughness (m).
    """
    sliding = SLIDE_ROLL * mean_speed
    friction = effects.friction
    boundary = laws.friction_boundary(
        SLIDE_ROLL, friction.boundary_limit, friction.boundary_slope, friction.boundary_decay
    )
    mean_pressure = 0.25 * math.pi * pressure
    viscosity = contact_viscosity(oil, mean_pressure)
    modulus = laws.shear_modulus(mean_pressure, oil.temperature_c, oil.shear_modulus_floor)
    deborah = viscosity * mean_speed / (modulus * half_width)
    stress = laws.traction_muraki_kimura(viscosity * sliding / (oil.eyring_stress * film), deborah)
    fluid = oil.eyring_stress * stress / mean_pressure
    share = 0.0
    if effects.lubrication == "mixed":
        share = laws.boundary_share(film / roughness, friction.lambda_boundary, friction.lambda_full)
    return np.asarray((share * boundary + (1.0 - share) * fluid) / sliding), np.asarray(deborah)


def creep(scene: Scene, *, contact_oil: Lubricant | None = None) -> Creep:
    """Creep of the rollers at the static equilibrium of a scene at its start.

    Loads and pressures along each contact are the core's; films and friction at zero slip come from the core's laws.

    Parameters
    ----------
    scene : Scene
        A scene with films, the traction of Muraki and Kimura, gravity and a cage.
    contact_oil : Lubricant, optional
        The oil as it is in the contacts, where they are warmer than the inlet that makes the film.

    Raises
    ------
    InputError
        If the scene's friction has no slope of this kind.
    """
    effects, oil, bearing = scene.effects, scene.lubricant, scene.bearing
    if not effects.films or effects.traction != "muraki_kimura":
        raise InputError.of(("effects", "traction"), effects.traction, "must be 'muraki_kimura', with films")
    found = contacts_at_start(scene)
    load, pressure = found["raceway_load"], found["raceway_pressure"]
    speed = found["raceway_mean_speed"]
    modulus = bearing.geometry.effective_modulus
    thermal = 1.0
    if effects.thermal:
        loading = oil.viscosity * oil.temperature_coefficient * speed**2 / oil.conductivity
        thermal = laws.film_thermal(pressure / modulus, loading, 0.0, effects.friction.thermal_floor)
    film = effects.starvation_factor * thermal * np.maximum(found["raceway_film_elastic"], found["raceway_film_rigid"])
    per_load, deborah = friction_slope(
        contact_oil or oil,
        effects,
        pressure=pressure,
        half_width=found["raceway_half_width"],
        mean_speed=speed,
        film=film,
        roughness=bearing.roughness.raceway,
    )
    slope = np.sum(load * per_load, axis=-1)
    drift = 0.25 * np.sum(1.0 / slope, axis=0)
    loaded = load > 0.0
    gravity = math.hypot(*(value_at(part, scene.start.time) for part in scene.gravity[:2]))
    orbit = abs(scene.orbit_speed(scene.start.time))
    cage, period = bearing.cage, 2.0 * math.pi / orbit
    return Creep(
        slope=slope,
        drift=drift,
        load=load.sum(axis=-1),
        film_parameter=np.min(np.where(loaded, film / bearing.roughness.raceway, np.inf), axis=(1, 2)),
        deborah=np.sum(load * deborah, axis=(1, 2)) / np.sum(load, axis=(1, 2)),
        chi=cage.mass * gravity * period * float(drift.mean()) / cage.play_circumferential,
        froude=orbit**2 * cage.play_radial / gravity if gravity > 0.0 else math.inf,
        unevenness=0.5 * math.log(float(drift.max() / drift.min())),
        cage_period=period,
    )


def growth_per_turn(
    chi: float,
    froude: float,
    *,
    n_rollers: int,
    lean: float,
    play_ratio: float,
    inertia: float,
    unevenness: float = 0.0,
) -> float:
    """Growth of a whirling cage's orbit in a turn of the cage (1), for small creep and orbits, Fn e/Cpr < 1.

    (2 chi/Z) {q Fn [c^4/(1 - c q Fn/2) + i k^2/2] - c k^2/2}, with c = cos(gamma), q = Cpc/Cpr, k = q c. Centrifugal
    force makes the orbit grow; gravity makes it shrink, as a whirling cage meets the bars of its far side sooner.
    Where the loaded zone is on top, rollers above creep less: each term but c^3 k l/2, which is taken off, falls by l
    sin(gamma).

    Parameters
    ----------
    chi, froude : float
        Creep number and Froude number (1).
    n_rollers : int
        Z.
    lean : float
        gamma, lean of the bars (rad).
    play_ratio : float
        q = Cpc/Cpr (1).
    inertia : float
        i = Iz/(m_c (Dpw/2)^2) (1).
    unevenness : float
        l of `Creep`: positive with the loaded zone on top, negative with it at the bottom (1).
    """
    c = math.cos(lean)
    k = play_ratio * c
    force = play_ratio * froude * (c**4 / (1.0 - 0.5 * c * play_ratio * froude) + 0.5 * inertia * k**2) - 0.5 * c * k**2
    return 2.0 * chi / n_rollers * (force * (1.0 - unevenness * math.sin(lean)) - 0.5 * c**3 * k * unevenness)


def bar_lean(bearing: Bearing) -> float:
    """gamma, lean of a pocket's bars from the circumferential direction (rad), from the plays of the cage.

    sin(gamma) cos(alpha_m) - tan(nu) sin(alpha_m) = (Cpc/Cpr) cos(gamma), as the pocket is built.
    """
    ratio = bearing.cage.play_circumferential / bearing.cage.play_radial
    axis, half = bearing.geometry.roller_axis_angle, bearing.geometry.roller_half_angle
    size = math.hypot(math.cos(axis), ratio)
    return math.asin(math.tan(half) * math.sin(axis) / size) + math.atan2(ratio, math.cos(axis))


def creep_time(scene: Scene) -> float:
    """Time in which creep lets the whirl of the cage change by its own size (s): the scale of every slow change of the
    motion.

    T_c Z/(2 chi) over the larger of q Fn c^4 and c k^2/2, the terms of centrifugal force and weight in
    `growth_per_turn` (q = Cpc/Cpr, c = cos(gamma), k = q c). Both terms count, as they oppose each other: what is left
    of them is a difference. Where rollers differ in load, v' is their mean, as each roller comes to every place of the
    loaded zone; none counts with more than the drift at which it yields within a turn of the cage, chi = 2 Z/c.

    Parameters
    ----------
    scene : Scene
        A scene with a cage, films and the traction of Muraki and Kimura.

    Returns
    -------
    float
        Time (s); nan where this law of creep does not hold (other friction, no cage, standstill).
    """
    effects = scene.effects
    if not effects.has_cage or not effects.films or effects.traction != "muraki_kimura":
        return math.nan
    try:
        with np.errstate(all="ignore"):  # rollers without load creep without bound
            found = creep(scene.replace(ring="held", ring_body=None, torque=None))
    except (TrbError, ArithmeticError):
        return math.nan
    bearing, cage = scene.bearing, scene.bearing.cage
    if not cage.play_radial > 0.0 or not cage.play_circumferential > 0.0:
        return math.nan
    c, q = math.cos(bar_lean(bearing)), cage.play_circumferential / cage.play_radial
    orbit = 2.0 * math.pi / found.cage_period
    gravity = math.hypot(*(value_at(part, scene.start.time) for part in scene.gravity[:2])) if effects.gravity else 0.0
    per_drift = cage.mass * found.cage_period / cage.play_circumferential
    yielding = 2.0 * bearing.n_rollers / (c * per_drift * max(gravity, orbit**2 * cage.play_radial))
    per_force = per_drift * float(np.mean(np.fmin(found.drift, yielding)))
    force = max(q * orbit**2 * cage.play_radial * c**4, 0.5 * c * (q * c) ** 2 * gravity)
    rate = 2.0 * per_force / bearing.n_rollers * force
    return found.cage_period / rate if rate > 0.0 else math.nan
