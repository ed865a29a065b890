"""The cage as a planar body among massless rollers that creep: the smallest model that whirls, for many cases at once.

Lengths are in units of Cpc, times in turns of the cage, forces in units of the cage's weight: a roller under the
force F drifts with chi F, the cage's mass is Fn (Cpc/Cpr)/(4 pi^2). Bars are flat, lean by gamma, and touch
one-sidedly through stiff springs; the roller's spin drags the leading bar outwards and the trailing bar inwards with
Coulomb friction. The only loss is creep and that friction.

Gravity's direction is -y in the inertial frame; pockets turn with the cage's mean speed. With weight 0 the unit of
force is that of a weight that does not act: then the growth of the orbit is that of centrifugal force alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Cage:
    """What the planar model takes of a bearing.

    Attributes
    ----------
    n_rollers : int
        Z.
    lean : float
        gamma: lean of the bars from the circumferential direction (rad).
    play_ratio : float
        Cpc/Cpr.
    inertia : float
        Iz/(m_c (Dpw/2)^2).
    roller_mass : float
        Mass of a roller over the cage's: its weight makes it creep, its inertia is left out.
    friction : float
        Coulomb coefficient between bars and rollers.
    """

    n_rollers: int = 12
    lean: float = math.radians(26.39)
    play_ratio: float = 0.48
    inertia: float = 1.149
    roller_mass: float = 0.125
    friction: float = 0.1


@dataclass(frozen=True)
class Motion:
    """Motion of N cases, S samples a turn. Positions in units of Cpr.

    Attributes
    ----------
    position : ndarray, shape (T, N)
        Cage centre x + i y.
    pattern : ndarray, shape (T, N)
        First harmonic of the rollers' places in the frame that turns with the cage: the place, x + i y, of a cage in
        whose pockets they would all be centred.
    samples : int
        Samples a turn.
    """

    position: Array
    pattern: Array
    samples: int


def simulate(
    chi: Array,
    froude: float,
    turns: float,
    eccentricity: float | Array,
    cage: Cage | None = None,
    *,
    weight: float = 1.0,
    unevenness: float = 0.0,
    loaded_zone_deg: float = 90.0,
    samples: int = 24,
    stiffness: float = 100.0,
    steps_per_period: float = 16.0,
    direction_deg: float = -90.0,
) -> Motion:
    """Run cases that differ in creep number.

    Parameters
    ----------
    chi : ndarray, shape (N,)
        Creep numbers.
    froude : float
        Froude number.
    turns : float
        How long, in turns of the cage.
    eccentricity : float or ndarray, shape (N,)
        At the start the cage whirls at this distance from the axis (Cpr), rollers centred in their pockets.
    cage : Cage, optional
        The cage; that of the 30310 rig by default.
    weight : float
        Gravity in units of the one in chi and froude.
    unevenness, loaded_zone_deg : float
        l and the direction of the loaded zone (deg): a roller's drift is chi exp(-l cos(angle from the loaded zone)).
    samples : int
        Samples a turn.
    stiffness : float
        Stiffness of a bar in units of the largest of weight and centrifugal force, per Cpc.
    steps_per_period : float
        Steps in the period of the cage on its springs.
    direction_deg : float
        Direction of the cage's centre at the start (deg).
    """
    cage = cage or Cage()
    chi = np.atleast_1d(np.asarray(chi, dtype=np.float64))[:, None]
    z, c, sine = cage.n_rollers, math.cos(cage.lean), math.sin(cage.lean)
    radial = cage.play_ratio * c
    lead, trail = c - cage.friction * sine, c + cage.friction * sine
    lead_out, trail_out = radial + cage.friction * c, radial - cage.friction * c
    mass = froude * cage.play_ratio / (4.0 * math.pi**2)
    spring = stiffness * max(weight, froude)
    # all rollers together carry the cage with about half of their springs
    period = 2.0 * math.pi * math.sqrt(mass / (0.5 * z * spring))
    per_sample = math.ceil(steps_per_period / period / samples)
    dt = 1.0 / (per_sample * samples)
    even = 2.0 * math.pi * np.arange(z) / z
    zone = math.radians(loaded_zone_deg)
    place = np.broadcast_to(np.asarray(eccentricity) / cage.play_ratio, chi.shape[:1])[:, None]
    start = np.exp(1j * math.radians(direction_deg))
    x = place[:, 0] * start
    v = 2j * math.pi * x
    turn, spin = np.zeros(chi.shape[0]), np.zeros(chi.shape[0])
    # rollers centred in their pockets
    s = np.imag(x[:, None] * np.exp(-1j * even))
    count = round(turns * samples)
    position = np.empty((count + 1, chi.shape[0]), complex)
    pattern = np.empty_like(position)
    for i in range(count * per_sample + 1):
        angle = even + 2.0 * math.pi * dt * i
        if i % per_sample == 0:
            position[i // per_sample] = x
            pattern[i // per_sample] = 2j * (s @ np.exp(1j * even)) / z
        arm = np.exp(-1j * angle)
        along = x[:, None] * arm
        u, closed = np.imag(along) + turn[:, None], -c - radial * np.real(along)
        rate = dt * chi * np.exp(-unevenness * np.cos(angle - zone))
        free = s - rate * weight * cage.roller_mass * np.cos(angle)
        s, push_lead, push_trail = _rollers(free, u, closed, rate * spring, c, lead, trail)
        push_lead, push_trail = spring * push_lead, spring * push_trail
        tangential = push_lead * lead - push_trail * trail
        force = (push_lead * lead_out + push_trail * trail_out + 1j * tangential) * np.conj(arm)
        v = v + dt / mass * (force.sum(axis=1) - 1j * weight)
        spin = spin + dt / (mass * cage.inertia) * tangential.sum(axis=1)
        x, turn = x + dt * v, turn + dt * spin
    return Motion(position * cage.play_ratio, pattern * cage.play_ratio, samples)


def _rollers(
    free: Array, u: Array, closed: Array, rate: Array, c: float, lead: float, trail: float
) -> tuple[Array, Array, Array]:
    """Places of the rollers after a step, implicit in the bars' forces, and how far both bars are pressed in.

    The place solves s = free - rate (lead [closed - c (u - s)] - trail [closed + c (u - s)]), [.] the positive part:
    its left minus its right side grows with s and is made of straight pieces, so that Newton's method ends after a
    few of them.
    """
    s = free
    for _ in range(4):
        on_lead, on_trail = closed - c * (u - s), closed + c * (u - s)
        wrong = s - free + rate * (lead * np.maximum(on_lead, 0.0) - trail * np.maximum(on_trail, 0.0))
        slope = 1.0 + rate * c * (lead * (on_lead > 0.0) + trail * (on_trail > 0.0))
        s = s - wrong / slope
    return s, np.maximum(closed - c * (u - s), 0.0), np.maximum(closed + c * (u - s), 0.0)


def growth(motion: Motion, first: int = 2, last: int | None = None) -> tuple[Array, Array]:
    """Growth of the pattern a turn, and its standard error: slope of ln|pattern| averaged over each turn, by least squares.

    Parameters
    ----------
    motion : Motion
        What ran.
    first, last : int
        Turns that count.
    """
    turns = (motion.pattern.shape[0] - 1) // motion.samples
    means = motion.pattern[: turns * motion.samples].reshape(turns, motion.samples, -1).mean(axis=1)
    logs = np.log(np.abs(means[first:last]))
    t = np.arange(logs.shape[0]) - 0.5 * (logs.shape[0] - 1)
    slope = t @ logs / (t @ t)
    rest = logs - logs.mean(axis=0) - np.outer(t, slope)
    return slope, np.sqrt((rest**2).sum(axis=0) / max(logs.shape[0] - 2, 1) / (t @ t))
