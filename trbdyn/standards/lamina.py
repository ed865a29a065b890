"""Reference life of ISO 16281 from the loads of laminas: slices of the contact lines of rollers and raceways.

A roller's contact line is cut into n_s laminas of equal length. With q the load of a lamina of a roller (N) times the stress
concentration f at its place, the load that counts for the lamina is the mean over all places of the rollers,

    q_ei = [mean q^4]^(1/4) on the ring that turns against the load,   q_ee = [mean q^4.5]^(1/4.5) on the other one,

and the life is L10r = {sum over laminas [(q_ei/q_ci)^4.5 + (q_ee/q_ce)^4.5]}^(-8/9) million revolutions, with the dynamic
load rating of a lamina q_c = Q_c n_s^(-7/9). The ratings Q_c of the contact at one ring follow from C.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LAMINAS: Final = 50
"""Laminas of a contact line; the standard asks for 30 at least."""
ROLLER_FACTOR: Final = 0.83
"""lambda nu, by which C of ISO 281 is lower than line contacts without edge stress would give."""
CONTACT_SHARES: Final = (0.364, 0.378)
"""Load of the roller that counts at the outer and at the inner ring, Z cos(alpha) Q_c over C: J_r/J_2 and J_r/J_1 of half of
the rollers loaded."""


def contact_ratings(C: float, *, n_rollers: int, roller_diameter: float, pitch_diameter: float, angle: float) -> Array:
    """Q_ce and Q_ci, dynamic load ratings of a roller's contact at the outer and the inner ring (N), shape (2,).

    Q_ci = C/(0.378 lambda Z cos a) {1 + G}^(2/9), Q_ce = C/(0.364 lambda Z cos a) {1 + 1/G}^(2/9),
    G = {1.038 [(1 - g)/(1 + g)]^(143/108)}^4.5, g = Dwe cos(a)/Dpw, lambda nu = 0.83.

    Notes
    -----
    Source: ISO/TS 16281:2008, 4.3.1, for one row; the derivation stands in docs/theory/ratings.md.
    """
    gamma = roller_diameter * math.cos(angle) / pitch_diameter
    ratio = (1.038 * ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)) ** 4.5
    each = C / (ROLLER_FACTOR * n_rollers * math.cos(angle))
    outer, inner = CONTACT_SHARES
    return np.array([each / outer * (1.0 + 1.0 / ratio) ** (2.0 / 9.0), each / inner * (1.0 + ratio) ** (2.0 / 9.0)])


def stress_concentration(count: int) -> Array:
    """f of each lamina, shape (count,): 1 - 0.01/ln(1.985 abs(2 k - n_s - 1)/(2 n_s)), k from 1 to n_s.

    ISO/TS 16281:2008, 4.3.2.

    It stands for the edge stress that slices without their neighbours do not know: 1 at mid length, more towards the ends.
    """
    place = np.abs(2.0 * np.arange(1, count + 1) - count - 1.0) / (2.0 * count)
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 - 0.01 / np.log(1.985 * place))


def in_laminas(per_length: Array, stations: Array, load: Array, length: float) -> Array:
    """Loads of the laminas (N) from loads per length (N/m) at stations along the line.

    Parameters
    ----------
    per_length : ndarray, shape (..., n)
        Load per length at the stations (N/m).
    stations : ndarray, shape (n,)
        Places along the line from its middle (m), ascending.
    load : ndarray, shape (...)
        Load of the whole contact (N), which the laminas together keep.
    length : float
        Effective length (m).

    Returns
    -------
    ndarray, shape (..., LAMINAS)
    """
    places = length * ((np.arange(LAMINAS) + 0.5) / LAMINAS - 0.5)
    flat = np.array([np.interp(places, stations, row) for row in per_length.reshape(-1, stations.size)])
    found = flat.reshape(*per_length.shape[:-1], LAMINAS)
    total = found.sum(axis=-1)
    return np.asarray(found * np.divide(load, total, out=np.zeros_like(total), where=total > 0.0)[..., None])


def reference_life(
    loads: Array, ratings: Array, *, weights: Array | None = None, inner_turns: bool = True, edges: bool = True
) -> float:
    """L10r (million revolutions).

    Parameters
    ----------
    loads : ndarray, shape (2, P, n_s)
        Loads of the laminas at the outer and the inner ring (N), for P places of a roller: all rollers of all records.
    ratings : ndarray, shape (2,)
        See `contact_ratings`.
    weights : ndarray, shape (P,), optional
        Share of the revolutions that each place stands for; equal by default.
    inner_turns : bool
        Whether the inner ring turns against the load; else the outer ring does.
    edges : bool
        Whether `stress_concentration` counts.

    Returns
    -------
    float
        The life; infinite without load.
    """
    count = loads.shape[2]
    concentration = stress_concentration(count) if edges else np.ones(count)
    exponents = (4.5, 4.0) if inner_turns else (4.0, 4.5)
    total = 0.0
    for ring, exponent in enumerate(exponents):
        share = np.maximum(loads[ring], 0.0) * concentration / (ratings[ring] * count ** (-7.0 / 9.0))
        mean = np.average(share**exponent, axis=0, weights=weights) ** (1.0 / exponent)
        total += float(np.sum(mean**4.5))
    return float(total ** (-8.0 / 9.0)) if total > 0.0 else math.inf
