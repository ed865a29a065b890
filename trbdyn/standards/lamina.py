"""Reference life of ISO 16281:2025 from the loads of laminas: slices of the contact lines of rollers and raceways. What is of
that edition and what of ISO/TS 16281:2008 stands in docs/theory/ratings.md#reference-life.

A roller's contact line is cut into n_s laminas of equal length. With q the load of a lamina of a roller (N) times the stress
concentration f at its place, the load that counts for the lamina is the mean over all places of the rollers,

    q_ei = [mean q^4]^(1/4) on a ring that turns against the load,   q_ee = [mean q^4.5]^(1/4.5) on one that stands,

and the life is L10r = {sum over laminas [(q_ei/q_ci)^4.5 + (q_ee/q_ce)^4.5]}^(-8/9) million revolutions, with the dynamic
load rating of a lamina q_c = Q_c n_s^(-7/9). The ratings Q_c of the contact at one ring follow from C.

The life factor is taken lamina by lamina, too: each has an equivalent load P_sk, and the modified reference life is
L_nmr = a1 {sum over laminas a_ISO,k^(-9/8) [(q_ei/q_ci)^4.5 + (q_ee/q_ce)^4.5]}^(-8/9) million revolutions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
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
    """f of each lamina, shape (count,): 1 - 0.01/ln(1.985 abs(2 k - n_s - 1)/(2 n_s - 2)), k from 1 to n_s, n_s from 2.

    It stands for the edge stress that slices without their neighbours do not know: 1 at mid length, and 2.33 in both laminas at
    the ends, however many there are.

    Notes
    -----
    ISO/TS 16281:2008, 4.3.2; ISO 16281:2025, formula (60). The standard was not at hand: the divisor 2 n_s - 2 is that of two
    published codes that cite this formula.

    Examples
    --------
    >>> from trbdyn.standards.lamina import stress_concentration
    >>> [round(float(stress_concentration(count)[0]), 2) for count in (30, 50, 100)]
    [2.33, 2.33, 2.33]
    """
    place = np.abs(2.0 * np.arange(1, count + 1) - count - 1.0) / (2.0 * count - 2.0)
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 - 0.01 / np.log(1.985 * place))


def in_laminas(per_length: Array, stations: Array, load: Array, length: float, line: float) -> Array:
    """Loads of the laminas (N), shape (..., LAMINAS), from loads per length (N/m), shape (..., n), at stations along the line
    (m, from its middle, ascending). The laminas together keep the load of the contact (N); beyond the line that may touch (m)
    they have none.
    """
    places = length * ((np.arange(LAMINAS) + 0.5) / LAMINAS - 0.5)
    flat = np.array([np.interp(places, stations, row) for row in per_length.reshape(-1, stations.size)])
    flat[:, np.abs(places) > 0.5 * line] = 0.0
    found = flat.reshape(*per_length.shape[:-1], LAMINAS)
    total = found.sum(axis=-1)
    return np.asarray(found * np.divide(load, total, out=np.zeros_like(total), where=total > 0.0)[..., None])


@dataclass(frozen=True)
class LaminaLoads:
    """Loads that count for the laminas of all rollers together."""

    over_rating: Array  # q_ee/q_ce and q_ei/q_ci, at the outer and at the inner ring (1), shape (2, n_s)
    ratings: Array  # q_ce and q_ci (N), shape (2,)

    @classmethod
    def of(
        cls,
        loads: Array,
        ratings: Array,
        *,
        turning: tuple[bool, bool] = (False, True),
        edges: bool = True,
    ) -> LaminaLoads:
        """The means over all places of the rollers.

        The loads at the outer and the inner ring (N), shape (2, P, n_s), are those of P places of a roller. `turning` says
        whether outer and inner ring turn against the load, `edges` whether `stress_concentration` counts.
        """
        count = loads.shape[2]
        concentration = stress_concentration(count) if edges else np.ones(count)
        each = ratings * count ** (-7.0 / 9.0)
        means = []
        for ring, turns in enumerate(turning):
            exponent = 4.0 if turns else 4.5
            share = np.maximum(loads[ring], 0.0) * concentration / each[ring]
            means.append(np.mean(share**exponent, axis=0) ** (1.0 / exponent))
        return cls(np.array(means), each)

    @property
    def reference_life(self) -> float:
        """L10r (million revolutions); infinite without load."""
        return self.modified_life(lambda _: 1.0)

    def equivalent_loads(self, *, n_rollers: int, angle: float) -> Array:
        """P_sk, the equivalent load of each lamina, to be compared with Cu of the bearing (N), shape (n_s,).

        P_sk = 0.323 Z n_s cos(alpha) {[q_ei^4.5 + (r q_ee)^4.5] / [1 + r^4.5]}^(2/9), r = 1.038 q_ci/q_ce.

        Notes
        -----
        ISO 16281:2025, formula (31). The standard itself was not at hand: the formula and the sum of `modified_life`, formula
        (33) there, were read in published code that cites these numbers.
        """
        outer, inner = self.over_rating * self.ratings[:, None]
        ratio = 1.038 * self.ratings[1] / self.ratings[0]
        mean = ((inner**4.5 + (ratio * outer) ** 4.5) / (1.0 + ratio**4.5)) ** (2.0 / 9.0)
        return np.asarray(0.323 * n_rollers * inner.size * math.cos(angle) * mean)

    def modified_life(self, factor: Callable[[int], float]) -> float:
        """Life with a life factor for each lamina, by its number (million revolutions); infinite without load."""
        damage = np.sum(self.over_rating**4.5, axis=0)
        total = sum(factor(k) ** (-9.0 / 8.0) * damage[k] for k in range(damage.size) if damage[k] > 0.0)
        return float(total ** (-8.0 / 9.0)) if total > 0.0 else math.inf
