"""The cage as a planar body among massless rollers that creep: the smallest model that whirls, for many cases at once.

Lengths are in units of Cpc, times in turns of the cage, forces in units of the cage's weight: a roller under the
force F drifts with chi F, the cage's mass is Fn (Cpc/Cpr)/(4 pi^2). Bars are flat, lean by gamma, and touch
one-sidedly through stiff springs; the roller's spin drags the leading bar outwards and the trailing bar inwards with
Coulomb friction. The only loss is creep and that friction.

Gravity's direction is -y in the inertial frame; pockets turn with the cage's mean speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SAMPLES = 24
"""Samples a turn."""


@dataclass(frozen=True)
class Cage:
    """What the planar model takes of a bearing: Z, lean of the bars from the circumferential direction (rad), Cpc/Cpr,
    Iz/(m_c (Dpw/2)^2), mass of a roller over the cage's (its weight makes it creep, its inertia is left out), friction of bars.
    """

    n_rollers: int = 12
    lean: float = math.radians(26.39)
    play_ratio: float = 0.48
    inertia: float = 1.149
    roller_mass: float = 0.125
    friction: float = 0.1


@dataclass(frozen=True)
class Motion:
    """Motion of N cases, in units of Cpr: cage centre x + i y, and the first harmonic of the rollers' places in the frame that
    turns with the cage, as the place of a cage in whose pockets they would all be centred; both of shape (T, N).
    """

    position: Array
    pattern: Array


def simulate(
    chi: Array,
    froude: float,
    turns: float,
    eccentricity: float,
    cage: Cage | None = None,
    *,
    stiffness: float = 100.0,
    steps_per_period: float = 16.0,
) -> Motion:
    """Run cases that differ in their creep number `chi`, shape (N,). At the start the cage whirls at a distance from the axis
    (Cpr), straight below it, rollers centred in their pockets. Stiffness of a bar in units of the largest of weight and
    centrifugal force, per Cpc; steps in the period of the cage on its springs.
    """
    cage = cage or Cage()
    chi = np.atleast_1d(np.asarray(chi, dtype=np.float64))[:, None]
    z, c, sine = cage.n_rollers, math.cos(cage.lean), math.sin(cage.lean)
    radial = cage.play_ratio * c
    lead, trail = c - cage.friction * sine, c + cage.friction * sine
    lead_out, trail_out = radial + cage.friction * c, radial - cage.friction * c
    mass = froude * cage.play_ratio / (4.0 * math.pi**2)
    spring = stiffness * max(1.0, froude)
    # all rollers together carry the cage with about half of their springs
    period = 2.0 * math.pi * math.sqrt(mass / (0.5 * z * spring))
    per_sample = math.ceil(steps_per_period / period / SAMPLES)
    dt = 1.0 / (per_sample * SAMPLES)
    even = 2.0 * math.pi * np.arange(z) / z
    x = np.full(chi.shape[0], eccentricity / cage.play_ratio * np.exp(-0.5j * math.pi))
    v = 2j * math.pi * x
    turn, spin = np.zeros(chi.shape[0]), np.zeros(chi.shape[0])
    # rollers centred in their pockets
    s = np.imag(x[:, None] * np.exp(-1j * even))
    count = round(turns * SAMPLES)
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
        free = s - dt * chi * cage.roller_mass * np.cos(angle)
        s, push_lead, push_trail = _rollers(free, u, closed, dt * chi * spring, c, lead, trail)
        push_lead, push_trail = spring * push_lead, spring * push_trail
        tangential = push_lead * lead - push_trail * trail
        force = (push_lead * lead_out + push_trail * trail_out + 1j * tangential) * np.conj(arm)
        v = v + dt / mass * (force.sum(axis=1) - 1j)
        spin = spin + dt / (mass * cage.inertia) * tangential.sum(axis=1)
        x, turn = x + dt * v, turn + dt * spin
    return Motion(position * cage.play_ratio, pattern * cage.play_ratio)


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


def growth(motion: Motion, first: int = 2) -> Array:
    """Growth of the pattern a turn: slope of ln|pattern| averaged over each turn from `first` on, by least squares."""
    turns = (motion.pattern.shape[0] - 1) // SAMPLES
    means = motion.pattern[: turns * SAMPLES].reshape(turns, SAMPLES, -1).mean(axis=1)
    logs = np.log(np.abs(means[first:]))
    t = np.arange(logs.shape[0]) - 0.5 * (logs.shape[0] - 1)
    return t @ logs / (t @ t)
