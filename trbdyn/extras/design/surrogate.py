"""A fast stand-in for runs that were made: it predicts an observable of designs that were not run, says how far off it is on runs
that it has not seen, and which inputs decide.

A Gaussian process (scikit-learn) with a length for each input, and with the scatter of chaotic runs as its noise, is fitted to
the draws of `trbdyn.uncertainty`. Its error is that of five fits, each of which predicts the fifth of the draws that it was not
given. Indices are those of Sobol with samples of Saltelli (SALib), of the prediction alone: what the fit does not explain, by
chance or because the draws are too few, stands beside them as a share of its own.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.errors import InputError, unknown_name
from trbdyn.extras.study.bands import Band
from trbdyn.extras.study.uncertainty import Uncertainty

if TYPE_CHECKING:
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import Kernel

Array = NDArray[np.float64]

FOLDS: Final = 5
"""Fits that measure the error, each on all draws but a part."""
FEWEST_DRAWS: Final = 40
"""Fewest draws, so that a fit of four fifths of them can tell anything."""
SHAPED_BY: Final = 400
"""Draws that lengths and noise are fitted to; the prediction takes all of them."""
TRUSTED: Final = 0.5
"""Share of the variance that must be predicted for the indices to mean anything."""
SALTELLI: Final = 1024
"""Points of the sequence from which the samples of the indices are made."""


@dataclass(frozen=True)
class Index:
    """How much of the variance of the prediction an input makes.

    Attributes
    ----------
    first, total : float
        Sobol's indices: by itself, and with all its interactions (1).
    half_width : float
        Half of the 95 % interval of the total index, of the sampling alone (1).
    """

    first: float
    total: float
    half_width: float


@dataclass(frozen=True, repr=False)
class Surrogate(Tabled):
    """A fast stand-in for runs; print it for a table, call it for a prediction.

    Attributes
    ----------
    quantity, unit : str
        What it predicts.
    bands : tuple of Band
        Inputs, and within which ends it may be asked.
    draws : int
        Runs that it was fitted to.
    error : float
        Root mean square error on runs that the fit has not seen, in the unit of the quantity.
    largest_error : float
        The largest of these errors.
    explained : float
        Share of the variance of the runs that is predicted without having seen them (1); below 0 where a mean would do better.
    indices : dict of str to Index
        By input.
    """

    quantity: str
    unit: str
    bands: tuple[Band, ...]
    draws: int
    error: float
    largest_error: float
    explained: float
    indices: dict[str, Index]
    _fit: GaussianProcessRegressor
    _headed = True

    def __call__(self, inputs: Mapping[str, ArrayLike]) -> Array:
        """The prediction for designs.

        Parameters
        ----------
        inputs : mapping of str to array_like
            A value, or one for each design, for every input, by its path.

        Returns
        -------
        ndarray
            In the unit of the quantity, of the shape of the inputs together.

        Raises
        ------
        InputError
            If an input is missing or unknown, or lies outside of its band: nothing is known there.
        """
        paths = [band.path for band in self.bands]
        for path in inputs:
            if path not in paths:
                raise InputError.of("inputs", path, unknown_name(path, paths))
        columns = []
        for band in self.bands:
            if band.path not in inputs:
                raise InputError.of("inputs", band.path, "is missing: every input must have a value")
            given = np.asarray(inputs[band.path], dtype=float)
            if not np.all((given >= band.low) & (given <= band.high)):
                raise InputError.of(
                    ("inputs", band.path), given, f"must lie from {band.low:g} to {band.high:g}, where runs were made"
                )
            columns.append((given - band.low) / (band.high - band.low))
        shaped = np.broadcast_arrays(*columns)
        unit = np.stack([column.ravel() for column in shaped], axis=1)
        return np.asarray(self._fit.predict(unit)).reshape(shaped[0].shape)

    def _shown(self) -> Shown:
        ordered = sorted(self.indices.items(), key=lambda entry: -entry[1].total)
        rows = [
            (path, f"{index.first:.2f}", f"{index.total:.2f}", f"+/- {index.half_width:.2f}") for path, index in ordered
        ]
        unit = f" {self.unit}" if self.unit else ""
        notes = [
            f"on runs that it has not seen it is off by {self.error:.3g}{unit} (root mean square), by"
            f" {self.largest_error:.3g}{unit} at most, and predicts {100.0 * max(self.explained, 0.0):.0f} % of their variance",
            "the rest is chance, as of a cage that collides, or what so few runs cannot tell; shares are of what is predicted",
        ]
        if self.explained < TRUSTED:
            notes.insert(
                1, "THAT IS TOO LITTLE: the shares above do not tell what decides; more runs, or longer ones, may"
            )
        head = ("input", "by itself", "with others", "95 %")
        return Shown(f"{self.quantity} from {self.draws} runs", tuple(rows), head, tuple(notes))


def surrogate(found: Uncertainty, quantity: str, *, seed: int = 0) -> Surrogate:
    """Fit a fast stand-in to the draws of `trbdyn.uncertainty`, with its error on runs it has not seen, and Sobol's indices.

    Needs the packages of the extra `study` (scikit-learn, SALib).

    Parameters
    ----------
    found : Uncertainty
        At least 40 draws.
    quantity : str
        Which observable of the summary.
    seed : int
        Of the parts that are left out, and of the samples of the indices.

    Returns
    -------
    Surrogate

    Raises
    ------
    InputError
        If the observable is unknown or does not change, or there are too few draws.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_32216(2000.0)
    >>> bands = {"lubricant.temperature_c": (40.0, 60.0), "scene.axial_load": (4000.0, 8000.0)}
    >>> options = trb.RunOptions(duration=1e-3, accuracy="fast")
    >>> found = trb.uncertainty(scene, bands, samples=48, options=options)
    >>> fast = trb.surrogate(found, "torque")
    >>> fast.explained > 0.95
    True
    >>> float(fast({"lubricant.temperature_c": 50.0, "scene.axial_load": 5000.0})) > 0.0
    True
    """
    expect("found", found, Uncertainty)
    if quantity in found.data and quantity not in found.spreads:
        raise InputError.of("quantity", quantity, "must have a number in every draw; in some of them it has none")
    if quantity not in found.spreads:
        raise InputError.of("quantity", quantity, unknown_name(quantity, found.spreads))
    unit, values = _draws(found, quantity)
    if len(values) < FEWEST_DRAWS:
        raise InputError.of("found", f"{len(values)} draws", f"must have at least {FEWEST_DRAWS}")
    if not values.std() > 1e-12 * np.abs(values).max():
        raise InputError.of("quantity", quantity, "must change from draw to draw; it is the same in all of them")
    fit = fitted(unit, values, seed)
    errors = _unseen(unit, values, seed, fit.kernel_)
    return Surrogate(
        quantity=quantity,
        unit=str(found.data[quantity].attrs.get("units", "")).removesuffix("1"),
        bands=found.bands,
        draws=len(values),
        error=float(np.sqrt(np.mean(errors**2))),
        largest_error=float(np.abs(errors).max()),
        explained=float(1.0 - np.mean(errors**2) / values.var()),
        indices=_indices(fit, found.bands, seed),
        _fit=fit,
    )


def _draws(found: Uncertainty, quantity: str) -> tuple[Array, Array]:
    """Draws that ran, in the unit cube, and what came out; the first case is the scene as it is."""
    data = found.data
    ran = np.array([str(text) == "done" for text in data["status"].values])
    ran[0] = False
    columns = [(data[band.path].values[ran].astype(float) - band.low) / (band.high - band.low) for band in found.bands]
    return np.stack(columns, axis=1), data[quantity].values[ran].astype(float)


def fitted(unit: Array, values: Array, seed: int, start: Kernel | None = None) -> GaussianProcessRegressor:
    """Lengths and noise from the first draws, which fill the bands evenly; then all draws with these.

    The search for them begins at `start`.
    """
    try:
        from sklearn.exceptions import ConvergenceWarning
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel
    except ImportError as error:  # pragma: no cover - tests have the package
        raise InputError.of(
            "trbdyn.surrogate", "scikit-learn", "must be installed: pip install trbdyn[study]"
        ) from error
    smooth = Matern(np.full(unit.shape[1], 0.3), (0.05, 100.0), nu=2.5)
    kernel = ConstantKernel(1.0, (1e-3, 1e3)) * smooth + WhiteKernel(1e-2, (1e-8, 10.0))
    first = GaussianProcessRegressor(kernel if start is None else start, normalize_y=True, random_state=seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # a length at its bound: an input that does not matter
        first.fit(unit[:SHAPED_BY], values[:SHAPED_BY])
        if len(values) <= SHAPED_BY:
            return first
        return GaussianProcessRegressor(first.kernel_, optimizer=None, normalize_y=True).fit(unit, values)


def _unseen(unit: Array, values: Array, seed: int, start: Kernel) -> Array:
    """What fits that were not given a draw predict for it, less what came out."""
    part = np.random.default_rng(seed).permutation(len(values)) % FOLDS
    errors = np.empty(len(values))
    for fold in range(FOLDS):
        left = part == fold
        errors[left] = fitted(unit[~left], values[~left], seed, start).predict(unit[left]) - values[left]
    return errors


def _indices(fit: GaussianProcessRegressor, bands: tuple[Band, ...], seed: int) -> dict[str, Index]:
    try:
        from SALib.analyze import sobol as analysis
        from SALib.sample import sobol as sample
    except ImportError as error:  # pragma: no cover - tests have the package
        raise InputError.of("trbdyn.surrogate", "SALib", "must be installed: pip install trbdyn[study]") from error
    problem: dict[str, Any] = {"num_vars": len(bands), "names": [band.path for band in bands]}
    problem["bounds"] = [[0.0, 1.0]] * len(bands)
    points = sample.sample(problem, SALTELLI, calc_second_order=False, seed=seed)
    values = np.concatenate([fit.predict(part) for part in np.array_split(points, max(1, len(points) // 4096))])
    found = analysis.analyze(problem, values, calc_second_order=False, seed=seed)
    return {
        band.path: Index(float(found["S1"][i]), float(found["ST"][i]), float(found["ST_conf"][i]))
        for i, band in enumerate(bands)
    }
