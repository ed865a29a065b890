"""Which designs to run next: a Gaussian process for each aim and limit, and SciPy's differential evolution on what they predict.

Several aims are weighed to one by Chebyshev's norm, with other weights for each design, so that together the designs follow the
whole front (ParEGO: Knowles 2006, IEEE Trans. Evol. Comput. 10, 50). A design is looked for where the prediction, less its
standard deviation, is small; then the prediction itself is taken for its result, so that the next one of the same round goes
elsewhere ("kriging believer": Ginsbourger et al. 2010).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, stats

from trbdyn.extras.design.surrogate import fitted

Array = NDArray[np.float64]

SUM: Final = 0.05
"""Share of the plain sum in Chebyshev's norm, so that a design that is better in one aim alone counts as better (Knowles)."""
BROKEN: Final = 10.0
"""What a limit that is missed by the spread of its quantity costs, in spreads of the aims."""
NEAREST: Final = 1e-3
"""Two designs of one round are at least so far apart, of the unit cube's side."""


@dataclass(frozen=True)
class Aims:
    """What is wanted of the results of a design, shape (designs, aims + limits)."""

    aims: int  # so many of the columns are to be small; the others are to be at most 0
    cells: tuple[int, ...]  # for each input how many values it has, 0 for any

    def snapped(self, unit: Array) -> Array:
        """Points of the unit cube, whole numbers in the middle of their cells."""
        cells = np.array(self.cells)
        whole = (np.minimum(np.floor(unit * cells), np.maximum(cells - 1, 0)) + 0.5) / np.maximum(cells, 1)
        return np.asarray(np.where(cells > 0, whole, unit))

    def allowed(self, values: Array) -> NDArray[np.bool_]:
        """Whether each design keeps all limits."""
        return np.asarray((values[..., self.aims :] <= 0.0).all(axis=-1))

    def front(self, values: Array) -> NDArray[np.bool_]:
        """Which designs keep the limits and are beaten in all aims by no other one that does."""
        allowed, aims = self.allowed(values), values[:, : self.aims]
        better = (aims[:, None] <= aims[None]).all(axis=-1) & (aims[:, None] < aims[None]).any(axis=-1)
        return np.asarray(allowed & ~(better & allowed[:, None]).any(axis=0))

    def weighed(self, values: Array, weights: Array, best: Array, span: Array) -> Array:
        """Chebyshev's norm of the aims from the best of each, in the span of each."""
        parts = weights * (values[..., : self.aims] - best) / span
        return np.asarray(parts.max(axis=-1) + SUM * parts.sum(axis=-1))

    def compromise(self, values: Array, among: NDArray[np.bool_]) -> int:
        """The design of some that is nearest to the best of all aims at once, all aims alike."""
        aims = values[among, : self.aims]
        best, span = aims.min(axis=0), np.maximum(np.ptp(aims, axis=0), 1e-300)
        norm = self.weighed(values, np.full(self.aims, 1.0 / self.aims), best, span)
        return int(np.where(among, norm, np.inf).argmin())


class Fits:
    """Gaussian processes of results, one for each column."""

    def __init__(self, unit: Array, values: Array, seed: int) -> None:
        self.unit, self.seed = unit, seed
        self.middle, self.spread = values.mean(axis=0), np.maximum(values.std(axis=0), 1e-300)
        self.scaled = (values - self.middle) / self.spread
        self.fits = [fitted(unit, column, seed) if np.ptp(column) > 0.0 else None for column in self.scaled.T]

    def believing(self, point: Array) -> None:
        """Takes what is predicted at a point for a result, with the lengths and the noise that were found before."""
        self.scaled = np.vstack([self.scaled, self._columns(point[None], 0.0)])
        self.unit = np.vstack([self.unit, point])
        for k, fit in enumerate(self.fits):
            if fit is not None:
                fit.set_params(kernel=fit.kernel_, optimizer=None).fit(self.unit, self.scaled[:, k])

    def predicted(self, points: Array, optimism: float = 0.0) -> Array:
        """Results at points, less so many standard deviations."""
        return self.middle + self.spread * self._columns(points, optimism)

    def _columns(self, points: Array, optimism: float) -> Array:
        columns = []
        for fit, scaled in zip(self.fits, self.scaled.T, strict=True):
            if fit is None:
                columns.append(np.full(len(points), scaled[0]))
                continue
            mean, deviation = fit.predict(points, return_std=True)
            columns.append(mean - optimism * deviation)
        return np.stack(columns, axis=1)


def weights_of(aims: int, count: int, seed: int) -> Array:
    """Weights of the aims, each row of the sum 1, even over all that there are; of one aim 1."""
    draws = stats.qmc.Sobol(aims, seed=seed).random_base2(int(np.ceil(np.log2(max(count, 2)))))[:count]
    drawn = -np.log(np.clip(draws, 1e-6, 1.0 - 1e-6))
    return np.asarray(drawn / drawn.sum(axis=1, keepdims=True))


def next_designs(unit: Array, values: Array, aims: Aims, count: int, seed: int) -> Array:
    """Points of the unit cube whose designs shall be run next, shape (count, inputs).

    From designs that were run, `unit` of shape (n, inputs), and their results, `values` of shape (n, aims + limits); rows that
    are not finite could not be run.
    """
    ran = np.isfinite(values).all(axis=1)
    fits = Fits(unit[ran], values[ran], seed)
    runs = Fits(unit, np.where(ran, -0.5, 0.5)[:, None], seed)
    seen = fits.predicted(unit[ran])
    allowed = aims.allowed(seen)
    good = seen[allowed if allowed.any() else slice(None), : aims.aims]
    best, span = good.min(axis=0), np.maximum(np.ptp(good, axis=0), 1e-3 * fits.spread[: aims.aims])
    found: list[Array] = []
    for k, weights in enumerate(weights_of(aims.aims, count, seed)):

        def cost(points: Array, weights: Array = weights, taken: Sequence[Array] = found) -> Any:
            at = aims.snapped(points.T)
            told, broken = fits.predicted(at, 1.0), runs.predicted(at)[:, 0]
            missed = np.maximum(told[:, aims.aims :] / fits.spread[aims.aims :], 0.0).sum(axis=1)
            near = sum((np.abs(at - one).max(axis=1) < NEAREST).astype(float) for one in taken)
            return aims.weighed(told, weights, best, span) + BROKEN * (missed + np.maximum(broken, 0.0) + near)

        search = optimize.differential_evolution(
            cost,
            [(0.0, 1.0)] * unit.shape[1],
            maxiter=40,
            popsize=8,
            polish=False,
            vectorized=True,
            updating="deferred",
            seed=seed + k,
        )
        point = aims.snapped(np.asarray(search.x)[None])[0]
        found.append(point)
        fits.believing(point)
    return np.array(found)
