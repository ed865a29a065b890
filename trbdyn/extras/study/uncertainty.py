"""The band of a prediction: inputs that nobody knows exactly are drawn from their bands together, each draw is run, and the
spread of the results is told, with the share of it that each input makes.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.stats import qmc

from trbdyn.base.expected import expect
from trbdyn.base.shown import Displayed, Shown
from trbdyn.base.validation import whole_number_of
from trbdyn.errors import InputError, unknown_name
from trbdyn.extras.study.bands import Band, open_inputs
from trbdyn.extras.study.definition import Base, Case, Study, split_path
from trbdyn.extras.study.drawn_bearing import belongs_together
from trbdyn.extras.study.gather import listed_in
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.runner import run as run_study
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.scene import Scene
from trbdyn.run.options import RunOptions
from trbdyn.run.torque_laws import TorqueLaws, torque_laws

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

LEVEL: Final = 0.95
"""Share of what may come that a band holds, if the draws are enough for it."""
FEWEST: Final = 8
"""Fewest draws that make a band."""


@dataclass(frozen=True)
class Spread:
    """What an observable does over all draws.

    Attributes
    ----------
    name : str
        Name in `Result.summary`.
    unit : str
        Its unit.
    value : float
        With every input as the scene has it.
    mean, low, high : float
        Mean of the draws, and the band that follows from them.
    shares : dict of str to float
        First-order index of each input: the share of the variance that this input makes by itself, from an additive model
        with a parabola for each input. Empty where the draws are too few.
    rest : float
        Share of the variance that no input makes by itself: inputs acting together, and chance.
    held : float
        Share of what may come that the band holds in the mean (`share_held`): 0.95, or less where draws are few.
    """

    name: str
    unit: str
    value: float
    mean: float
    low: float
    high: float
    shares: dict[str, float]
    rest: float
    held: float = LEVEL


@dataclass(frozen=True, repr=False)
class Uncertainty(Displayed):
    """Bands of all observables of a scene; print it for a table.

    Attributes
    ----------
    spreads : dict of str to Spread
        By the names of `Result.summary`.
    bands : tuple of Band
        Inputs that were drawn.
    draws : int
        How many draws could be run.
    refused : tuple of str
        Why others could not.
    data : xarray.Dataset
        All draws: inputs as coordinates, observables as variables.
    shown : tuple of str
        Observables that are printed.
    laws : TorqueLaws or None
        What the law of rolling resistance leaves open of the torque beside the inputs; None where a measurement is given.
    given : mapping or None
        What was measured: value and standard deviation by observable.
    effective : float or None
        As how many draws those that agree with it count (1).
    """

    spreads: dict[str, Spread]
    bands: tuple[Band, ...]
    draws: int
    refused: tuple[str, ...]
    data: xarray.Dataset
    shown: tuple[str, ...]
    laws: TorqueLaws | None = None
    given: Mapping[str, tuple[float, float]] | None = None
    effective: float | None = None

    def __getitem__(self, name: str) -> Spread:
        return self.spreads[name]

    def __str__(self) -> str:
        lines = [f"{self.draws} draws of {len(self.bands)} inputs" + self._refusals()]
        for name in self.shown:
            spread = self.spreads[name]
            unit = f" {spread.unit}" if spread.unit else ""
            held = f"{100.0 * spread.held:.0f} % lie within {spread.low:.4g} to {spread.high:.4g}{unit}"
            lines.append(f"{name} = {spread.value:.4g}{unit}; {held}")
            largest = sorted(spread.shares.items(), key=lambda entry: -entry[1])[:5]
            lines += [f"  {100.0 * share:5.1f} %  {path}" for path, share in largest if share >= 0.01]
            if spread.shares:
                lines.append(f"  {100.0 * spread.rest:5.1f} %  inputs together, and chance")
            if name == "torque" and self.laws is not None:
                lines.append(f"  {self.laws.words(spread.low, spread.high)}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return str(self)

    def _shown(self) -> Shown:
        rows = []
        for name in self.shown:
            spread = self.spreads[name]
            largest = sorted(spread.shares.items(), key=lambda entry: -entry[1])[:5]
            causes = ", ".join(f"{path} {100.0 * share:.0f} %" for path, share in largest if share >= 0.01)
            band = f"{spread.low:.4g} to {spread.high:.4g} ({100.0 * spread.held:.0f} %)"
            rows.append((name, f"{spread.value:.4g}", spread.unit, band, causes))
        title = f"{self.draws} draws of {len(self.bands)} inputs{self._refusals()}"
        torque = self.spreads["torque"] if "torque" in self.shown else None
        notes = () if self.laws is None or torque is None else (f"torque: {self.laws.words(torque.low, torque.high)}",)
        head = ("name", "value", "unit", "band (share that it holds)", "shares of the variance")
        return Shown(title, tuple(rows), head, notes)

    def _refusals(self) -> str:
        if self.given is not None:
            known = ", ".join(f"{name} = {value:g} ± {error:g}" for name, (value, error) in self.given.items())
            return f", given {known}: they count as {self.effective:.0f}"
        if not self.refused:
            return ""
        return f"; {len(self.refused)} more could not be run, so that the bands leave them out: {self.refused[0]}"


def uncertainty(
    subject: Subject,
    bands: Mapping[str, tuple[float, float]] | Sequence[Band] | None = None,
    *,
    samples: int = 64,
    seed: int = 0,
    options: RunOptions | None = None,
    quantities: Sequence[str] | None = None,
    given: Mapping[str, tuple[float, float]] | None = None,
    **how: Unpack[Running],
) -> Uncertainty:
    """The band of every observable that follows from the bands of the inputs.

    Inputs are drawn together by a scrambled Sobol sequence (`scipy.stats.qmc`), every draw is run, and their results give the
    band. It holds 95 % of what may come, if there are 39 draws at least; fewer have the smallest and the largest of them as
    band, which holds less, and the share is printed.

    Parameters
    ----------
    subject : Scene or Assembly
        What is simulated. Inputs of a bearing on a shaft have paths such as ``bearings[0].bearing.cup_half_angle_deg``, its
        observables names such as ``left_torque``; ``torque`` is that of the shaft.
    bands : mapping of str to tuple, or sequence of Band, optional
        Which inputs are drawn, and between which ends; `open_inputs` of the subject by default.
    samples : int
        Number of draws, at least 8. A larger number keeps the first ones. Shares need twice as many draws as the model has
        numbers: 2 (2 n + 1) for n inputs, else straight lines take the place of parabolas, else there are none.
    seed : int
        Seed of the draws.
    options : RunOptions, optional
        How each draw is run; 5 turns of the shaft with 'fast' by default.
    quantities : sequence of str, optional
        Observables that are printed; by default torque, largest pressure, films and the size of the whirl.
    given : mapping of str to tuple, optional
        What was measured of this bearing: observable, its value and the standard deviation of the measurement in the same unit,
        ``{"torque": (2.95, 0.15)}``. Draws then count by how well they agree with it (Bayes' rule with a normal error), in all
        bands and means; shares are left out.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`.

    Returns
    -------
    Uncertainty
        Print it for a table.

    Raises
    ------
    InputError
        If a band is wrong or names no input, there are none, a quantity is unknown, or so few draws can be run, or agree with
        what was measured, that they make no band.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_32216(2000.0)
    >>> bands = {"lubricant.temperature_c": (47.0, 53.0), "bearing.cup_half_angle_deg": (14.0, 15.7)}
    >>> options = trb.RunOptions(duration=2e-3, accuracy="fast")
    >>> found = trb.uncertainty(scene, bands, samples=16, options=options)
    >>> found["torque"].low < found["torque"].high
    True
    """
    expect("scene", subject, Scene, Assembly)
    drawn = checked_bands(open_inputs(subject) if bands is None else bands)
    count, seed = whole_number_of("samples", samples, FEWEST), whole_number_of("seed", seed, 0)
    options = RunOptions(revolutions=5.0, accuracy="fast") if options is None else options
    base = Base.of(subject, options)
    unit = unit_draws(len(drawn), count, seed)
    made = [
        Case({"draw": 0}, subject, options),
        *(drawn_case(base, options, drawn, row, k + 1) for k, row in enumerate(unit)),
    ]
    if all(case.scene is None for case in made[1:]):
        raise InputError.of("bands", drawn[0].path, f"no draw can be built; the first: {made[1].error}")
    data = run_study(Study(tuple(made), (), "uncertainty"), **(Running(executor="threads") | how))
    found = _gathered(data, drawn, unit, quantities, torque_laws(subject))
    return found if given is None else updated(found, given)


def updated(prior: Uncertainty, given: Mapping[str, tuple[float, float]]) -> Uncertainty:
    """The bands with what was measured, by the weights of the draws; `uncertainty` says more.

    Raises
    ------
    InputError
        If an observable is unknown, an error is not above 0, or the draws that agree count as fewer than 8 (Kish).
    """
    ran = np.array([text == "done" for text in prior.data["status"].values])[1:]

    def drawn(name: str) -> Array:
        return np.asarray(prior.data[name].values, dtype=float)[1:][ran]

    log_weight = np.zeros(prior.draws)
    for name, pair in given.items():
        if name not in prior.spreads:
            raise InputError.of(("given", name), pair, unknown_name(name, prior.spreads))
        value, error = (float(number) for number in pair)
        if not error > 0.0:
            raise InputError.of(("given", name), pair, "must be a value and its standard deviation, > 0")
        log_weight -= 0.5 * ((drawn(name) - value) / error) ** 2
    weight = np.exp(log_weight - log_weight.max())
    weight /= weight.sum()
    count = float(1.0 / np.sum(weight**2))
    if count < FEWEST:
        raise InputError.of(
            "given",
            dict(given),
            f"the draws that agree with it count as {count:.1f}, of {prior.draws}; {FEWEST} are needed: take more samples, or "
            "look at the inputs, of which none may give what was measured",
        )
    held = share_held(round(count))
    ends = (0.5 - 0.5 * held, 0.5 + 0.5 * held)
    spreads = {}
    for name, spread in prior.spreads.items():
        values = drawn(name)
        low, high = (float(np.interp(end, *_distribution(values, weight))) for end in ends)
        spreads[name] = replace(spread, mean=float(weight @ values), low=low, high=high, shares={}, rest=1.0, held=held)
    return replace(prior, spreads=spreads, given=dict(given), effective=count, laws=None)


def _distribution(values: Array, weight: Array) -> tuple[Array, Array]:
    """Cumulated weights, each value in the middle of its own, and the values in order."""
    order = np.argsort(values)
    return np.cumsum(weight[order]) - 0.5 * weight[order], values[order]


def checked_bands(bands: Mapping[str, tuple[float, float]] | Sequence[Band]) -> tuple[Band, ...]:
    """Bands as a user gives them, checked."""
    if isinstance(bands, Mapping):
        made = []
        for path, ends in bands.items():
            if isinstance(ends, str) or not isinstance(ends, Sequence) or len(ends) != 2:
                raise InputError.of(("bands", path), ends, "must be a band (low, high)")
            made.append(Band(path=path, low=ends[0], high=ends[1]))
    else:
        made = list(bands)
    if not made:
        raise InputError.of("bands", "none", "must name at least one input; this scene has none that is open by itself")
    for band in made:
        if not band.low < band.high:
            raise InputError.of(("bands", band.path), (band.low, band.high), "must have low < high")
    paths = [band.path for band in made]
    if len(set(paths)) != len(paths):
        raise InputError.of("bands", paths, "must not name an input twice")
    return tuple(made)


def unit_draws(inputs: int, count: int, seed: int) -> Array:
    """Points of the unit cube, shape (count, inputs)."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "The balance properties", UserWarning)  # counts that are no powers of two
        return np.asarray(qmc.Sobol(inputs, seed=seed).random(count), dtype=float)


def is_whole(base: Base, band: Band) -> bool:
    """Whether an input is drawn in whole numbers: both ends are, and so is what the scene has."""
    value: Any = base.tables
    for name in split_path(band.path):
        value = value.get(name) if isinstance(value, dict) else value[name] if isinstance(value, list) else None  # type: ignore[index]
    whole = band.path.endswith("n_rollers") or (isinstance(value, int) and not isinstance(value, bool))
    return whole and float(band.low).is_integer() and float(band.high).is_integer()


def drawn_case(base: Base, options: RunOptions, bands: Sequence[Band], row: Array, number: int) -> Case:
    """The case of a draw; `row` tells how far between the ends of each band."""
    overrides: dict[str, Any] = {}
    for band, share in zip(bands, row, strict=True):
        if is_whole(base, band):
            value: float = int(band.low + share * (band.high - band.low + 1.0))
        else:
            value = float(band.low + share * (band.high - band.low))
        overrides[band.path] = value
    ends = {band.path: (band.low, band.high, float(share)) for band, share in zip(bands, row, strict=True)}
    parameters = {"draw": number, **overrides}
    try:
        for prefix, part in base.parts.items():
            overrides |= belongs_together(Bearing.model_validate(part["bearing"]), overrides, ends, prefix)
        parameters |= {band.path: overrides[band.path] for band in bands}
        scene, _ = base.build(overrides)
    except InputError as error:
        return Case(parameters, None, options, str(error).splitlines()[0])
    return Case(parameters, scene, options)


def _gathered(
    data: xarray.Dataset,
    bands: tuple[Band, ...],
    unit: Array,
    quantities: Sequence[str] | None,
    laws: TorqueLaws | None,
) -> Uncertainty:
    status = [str(text) for text in data["status"].values]
    ran = np.array([text == "done" for text in status])
    if not ran[0]:
        raise InputError.of("scene", "as it is", f"cannot be run: {data['message'].values[0]}")
    good = ran[1:]
    refused = tuple(str(text) for text in data["message"].values[1:][~good])
    if good.sum() < FEWEST:
        raise InputError.of(
            "bands", f"{int(good.sum())} draws", f"so few could be run; the first that failed: {refused[0]}"
        )
    spreads = {}
    for name, variable in data.data_vars.items():
        if variable.dims != ("case",) or variable.dtype.kind not in "fi" or name in ("wall_time", "number", "draw"):
            continue
        values = np.asarray(variable.values, dtype=float)
        if np.isfinite(values[0]) and np.isfinite(values[1:][good]).all():
            units = str(variable.attrs.get("units", "")).removesuffix("1")
            spreads[str(name)] = _spread(str(name), units, values[0], values[1:][good], bands, unit[good])
    if quantities is not None and (strange := [name for name in quantities if name not in spreads]):
        raise InputError.of("quantities", strange[0], unknown_name(strange[0], spreads))
    shown = tuple(name for name in (quantities or listed_in(data, "band")) if name in spreads)
    return Uncertainty(spreads, bands, int(good.sum()), refused, data, shown, laws)


def _spread(name: str, units: str, value: float, values: Array, bands: Sequence[Band], unit: Array) -> Spread:
    low, high, held = band_of(values)
    found, rest = first_order(unit, values)
    shares = {band.path: float(share) for band, share in zip(bands, found, strict=False)}
    return Spread(name, units, float(value), float(values.mean()), low, high, shares, rest, held)


def share_held(draws: int) -> float:
    """Share of what may come that a band of so many draws holds in the mean: `LEVEL`, but at most that of the smallest and the
    largest of them.

    Of n independent draws the next one lies between the k-th and the (n + 1 - k)-th with the probability (n + 1 - 2 k) / (n + 1),
    whatever their distribution (Wilks 1941, Ann. Math. Stat. 12, 91). Draws of a Sobol sequence are more even, and hold more.
    """
    return min(LEVEL, (draws - 1) / (draws + 1))


def band_of(values: ArrayLike) -> tuple[float, float, float]:
    """Ends of the band of some draws, and the share of what may come that it holds in the mean (`share_held`)."""
    given = np.asarray(values, dtype=float)
    held = share_held(given.size)
    low, high = np.quantile(given, [0.5 - 0.5 * held, 0.5 + 0.5 * held], method="weibull")
    return float(low), float(high), held


def first_order(unit: Array, values: Array) -> tuple[Array, float]:
    """First-order indices of independent inputs, from given draws: shares of the variance of each input, empty where the draws
    are too few even for straight lines, and one less their sum, not below 0.

    The values, shape (n,), over draws that are uniform over 0 to 1, shape (n, inputs), are fitted by a sum of one parabola for
    each input, in Legendre polynomials, which are orthogonal over the unit interval: the variance that an input makes by itself
    is the sum of its two squared coefficients (Sudret 2008, Reliab. Eng. Syst. Saf. 93, 964, to second degree and without
    products). What chance adds to a squared coefficient is taken off.
    """
    n, inputs = unit.shape
    variance = float(values.var(ddof=1))
    degree = 2 if n >= 2 * (1 + 2 * inputs) else 1 if n >= 2 * (1 + inputs) else 0
    if degree == 0 or variance <= (1e-12 * float(np.abs(values).max())) ** 2:
        return np.empty(0), 1.0
    x = 2.0 * unit - 1.0
    columns = [np.ones(n), *(np.sqrt(3.0) * x.T)]
    if degree == 2:
        columns += list(np.sqrt(5.0) * 0.5 * (3.0 * x.T**2 - 1.0))
    matrix = np.stack(columns, axis=1)
    coefficients, *_ = np.linalg.lstsq(matrix, values, rcond=None)
    left = values - matrix @ coefficients
    chance = float(left @ left) / (n - matrix.shape[1]) * np.diag(np.linalg.pinv(matrix.T @ matrix))
    made = (coefficients**2 - chance)[1:].reshape(degree, inputs).sum(axis=0)
    shares = np.clip(made / variance, 0.0, 1.0)
    return shares, max(1.0 - float(shares.sum()), 0.0)
