"""The best designs within limits: plays, profiles or numbers of rollers are changed, each design is run over draws of its
tolerances, and what was learned from all runs tells which designs come next (`trbdyn.study.guide`).
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, Unpack

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError, unknown_name
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.pocket_shapes import SHAPES
from trbdyn.model.scene import Scene
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.options import RunOptions
from trbdyn.run.simulation import Simulation
from trbdyn.study.answer import Answer
from trbdyn.study.definition import Base, Case, Study, split_path
from trbdyn.study.drawn_bearing import belongs_together
from trbdyn.study.guide import Aims, Fits, next_designs
from trbdyn.study.runner import Running
from trbdyn.study.runner import run as run_study
from trbdyn.study.uncertainty import Band, checked_bands, is_whole, unit_draws

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]
Limit = float | tuple[float | None, float | None]

ROUND: Final = 8
"""Designs that are run side by side before the next ones are chosen."""
FEWEST: Final = 10
"""Fewest designs."""
SHAPE_OF: Final = {
    name: shape for shape, build in SHAPES.items() for name in list(inspect.signature(build).parameters)[1:]
}
"""Which shape of pocket has an argument, for paths such as ``bearing.cage.pocket.lean_deg``."""
POCKET: Final = "bearing.cage.pocket."


@dataclass(frozen=True)
class Design:
    """A design that was run.

    Attributes
    ----------
    number : int
        Place in the order in which designs were run; 0 is the scene as it is given.
    inputs : dict of str to float
        What was changed, by its path.
    values : dict of str to float
        Aims and limited quantities, over the draws of the tolerances.
    expected : dict of str to float
        The same as all runs together tell: with less chance in them.
    """

    number: int
    inputs: dict[str, float]
    values: dict[str, float]
    expected: dict[str, float]


@dataclass(frozen=True, repr=False)
class Optimum(Answer):
    """Designs that were run, and the best of them; print it for a table.

    Its picture shows the designs over the first two aims, or one aim over the order of the runs; the front, the chosen and the
    first.

    Attributes
    ----------
    first : Design
        The scene as it is given.
    chosen : Design
        The design of the front that is nearest to the best of all aims at once.
    front : tuple of Design
        Designs that keep the limits and are beaten in all aims by no other one.
    designs : tuple of Design
        All that could be run.
    want : dict of str to str
        Aims, each 'least' or 'most'.
    refused : tuple of str
        Why others could not be run.
    data : xarray.Dataset
        All runs, as `trbdyn.study.run` gives them; ``design`` and ``draw`` are coordinates.
    subjects : tuple of Scene or Assembly
        What was run, of the first and of the chosen design without their tolerances.
    """

    first: Design
    chosen: Design
    front: tuple[Design, ...]
    designs: tuple[Design, ...]
    want: dict[str, str]
    refused: tuple[str, ...]
    data: xarray.Dataset
    subjects: tuple[Subject, Subject]

    def pair(self, **how: Any) -> tuple[Result | AssemblyResult, Result | AssemblyResult]:
        """Runs of the first and of the chosen design that the search did not make, for ``trb.report(first, ..., other=chosen)``.

        Parameters
        ----------
        **how
            Those of `Simulation.run`; 200 turns by default.
        """
        length = {} if {"revolutions", "duration"} & how.keys() else {"revolutions": 200.0}
        first, chosen = (Simulation(subject).run(**(how | length)) for subject in self.subjects)
        return first, chosen

    def _draw(self) -> Any:
        from trbdyn.study.front import draw_front

        return draw_front(self)

    def _shown(self) -> Shown:
        inputs, values = list(self.chosen.inputs), list(self.chosen.values)
        listed = [("first", self.first), ("chosen", self.chosen), *(("front", one) for one in self.front)]
        rows = [
            (
                name,
                str(one.number),
                *(f"{one.inputs[path]:.4g}" for path in inputs),
                *(f"{one.expected[aim]:.4g}" for aim in values),
            )
            for name, one in listed
        ]
        notes = ["aims and limits as all runs together tell them; `pair` runs the first and the chosen design again"]
        if self.refused:
            notes.append(f"{len(self.refused)} designs could not be run; the first: {self.refused[0]}")
        aims = ", ".join(f"{kind} {name}" for name, kind in self.want.items())
        return Shown(
            f"{len(self.designs)} designs for {aims}", tuple(rows), ("", "number", *inputs, *values), tuple(notes)
        )


def optimise(
    subject: Subject,
    change: Mapping[str, tuple[float, float]],
    want: Mapping[str, Literal["least", "most"]],
    *,
    limits: Mapping[str, Limit] | None = None,
    tolerances: Mapping[str, tuple[float, float]] | None = None,
    draws: int = 4,
    judged: Literal["worst", "mean"] = "worst",
    designs: int = 64,
    seed: int = 0,
    options: RunOptions | None = None,
    **how: Unpack[Running],
) -> Optimum:
    """The designs with the best results, of several aims the front.

    A third of the designs fills the space of the changes evenly. Then Gaussian processes are fitted to all results, and eight
    designs at a time are run where they promise most. Needs the package scikit-learn of the extra `study`.

    Parameters
    ----------
    subject : Scene or Assembly
        The first design.
    change : mapping of str to tuple
        Inputs that may be changed, by their paths, and between which ends. Whole numbers stay whole.
        ``bearing.cage.pocket.lean_deg`` and other arguments of `trbdyn.pocket_shapes` choose their shape.
    want : mapping of str to {'least', 'most'}
        Numbers of the summary that shall be as small, or as large, as can be.
    limits : mapping of str to float or tuple, optional
        Numbers of the summary that must keep limits: the largest value, or (lowest, largest) with None for none.
    tolerances : mapping of str to tuple, optional
        By how much an input of every design may be less and more: (-20e-6, 20e-6). The seed of ``diameter_scatter`` draws rollers
        as they are manufactured: ``{"bearing.roller.diameter_scatter.seed": (0, 9999)}``.
    draws : int
        Runs of each design over its tolerances, the same draws for all designs; without tolerances there is one.
    judged : {'worst', 'mean'}
        Whether the worst of its draws or their mean counts for a design.
    designs : int
        How many designs are run, at least 10.
    seed : int
        Of the designs, the draws and the search. The same seed finds the same designs.
    options : RunOptions, optional
        How each draw is run; 5 turns of the shaft with 'fast' by default. `Plan.options` of `trbdyn.plan` has the accuracy
        that an aim needs.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`. A second call with the same folder goes on
        where the first one ended.

    Returns
    -------
    Optimum
        Print it for a table.

    Raises
    ------
    InputError
        If a name is unknown, an argument cannot be used, the scene as it is given cannot be run, or no design keeps the limits.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_32216(2000.0)
    >>> options = trb.RunOptions(duration=5e-4, accuracy="fast")
    >>> change = {"bearing.roller.profile.crown_radius": (5.0, 100.0), "lubricant.temperature_c": (40.0, 60.0)}
    >>> scene = scene.replace(bearing=scene.bearing.replace({"roller.profile": trb.Profile.crowned(20.0)}))
    >>> found = trb.optimise(scene, change, {"torque": "least"}, designs=12, options=options)
    >>> found.chosen.values["torque"] < found.first.values["torque"]
    True
    """
    expect("scene", subject, Scene, Assembly)
    search = Search(
        subject,
        checked_bands(change),
        _wanted(want),
        _limited(limits or {}),
        checked_bands(tolerances) if tolerances else (),
        _whole("draws", draws, 1) if tolerances else 1,
        judged,
        _whole("seed", seed, 0),
        RunOptions(revolutions=5.0, accuracy="fast") if options is None else options,
        Running(executor="threads") | how,
    )
    count = _whole("designs", designs, FEWEST)
    search.begin(max(count // 3, FEWEST - 4))
    while (left := count - len(search.unit)) > 0:
        search.go_on(min(left, ROUND))
    return search.found()


@dataclass
class Search:
    """Designs that were run so far, and the fits to their results."""

    subject: Subject
    bands: tuple[Band, ...]
    want: dict[str, str]
    limits: tuple[tuple[str, str, float], ...]
    tolerances: tuple[Band, ...]
    draws: int
    judged: str
    seed: int
    options: RunOptions
    how: Running

    def __post_init__(self) -> None:
        if self.judged not in JUDGED:
            raise InputError.of("judged", self.judged, unknown_name(self.judged, JUDGED))
        self.base = Base.of(self.subject, self.options)
        whole = [is_whole(self.base, band) for band in self.bands]
        cells = [int(b.high - b.low) + 1 if one else 0 for b, one in zip(self.bands, whole, strict=True)]
        self.aims = Aims(len(self.want), tuple(cells))
        rows = unit_draws(len(self.tolerances), self.draws, self.seed) if self.tolerances else np.zeros((1, 0))
        self.offsets = [
            {
                band.path: band.low + share * (band.high - band.low)
                for band, share in zip(self.tolerances, row, strict=True)
            }
            for row in rows
        ]
        for band in self.tolerances:
            if band.path not in {one.path for one in self.bands}:
                self._given("tolerances", band)
        self.first = {band.path: self._given("change", band) for band in self.bands}
        self.unit, self.columns = np.empty((0, len(self.bands))), np.empty((0, len(self.want) + len(self.limits)))
        self.tables: list[dict[str, float]] = []
        self.parts: list[xarray.Dataset] = []

    def _given(self, field: str, band: Band) -> float:
        """The number of the subject at a path; of an argument of a pocket that it has not, nan."""
        value: Any = self.base.tables
        for part in split_path(band.path):
            inside = part in value if isinstance(value, dict) else isinstance(value, list) and int(part) < len(value)
            value = value[part] if inside else None
        if isinstance(value, bool) or not isinstance(value, int | float):
            if band.path.startswith(POCKET) and band.path.removeprefix(POCKET) in SHAPE_OF:
                return np.nan
            raise InputError.of(
                (field, band.path), (band.low, band.high), f"the scene has no number there, but {value!r}"
            )
        return float(value)

    def begin(self, count: int) -> None:
        """Runs the subject as it is, and designs that fill the space of the changes evenly."""
        ends = [(band.low, band.high) for band in self.bands]
        first = [(self.first[b.path] - low) / (high - low) for b, (low, high) in zip(self.bands, ends, strict=True)]
        even = self.aims.snapped(unit_draws(len(self.bands), count - 1, self.seed))
        self._run(np.vstack([first, even]))
        if not np.isfinite(self.columns[0]).all():
            raise InputError.of("scene", "as it is", f"cannot be run: {self.refused[0]}")
        if np.isfinite(self.columns[1:]).all(axis=1).sum() < 2:
            raise InputError.of("change", list(self.first), f"no designs can be run; the first: {self.refused[0]}")

    def go_on(self, count: int) -> None:
        """Runs the designs that promise most."""
        known = np.isfinite(self.unit).all(axis=1)
        self._run(next_designs(self.unit[known], self.columns[known], self.aims, count, self.seed + len(self.unit)))

    def _run(self, unit: Array) -> None:
        start = len(self.unit)
        made = tuple(
            self._case(start + k, row, draw, offset)
            for k, row in enumerate(unit)
            for draw, offset in enumerate(self.offsets)
        )
        data = run_study(Study(made, (), "optimise"), **self.how)
        self._check_names(data)
        self.parts.append(data)
        for k in range(len(unit)):
            table, columns = self._judge(data.isel(case=slice(k * len(self.offsets), (k + 1) * len(self.offsets))))
            self.tables.append(table)
            self.columns = np.vstack([self.columns, columns])
        self.unit = np.vstack([self.unit, unit])

    def inputs(self, row: Array) -> dict[str, float]:
        """What a design changes; of the subject as it is what it has."""
        found = {}
        for band, share, cells in zip(self.bands, row, self.aims.cells, strict=True):
            value = band.low + share * (band.high - band.low + (1.0 if cells else 0.0))
            found[band.path] = int(value) if cells else float(value)
        return found

    def _case(self, number: int, row: Array, draw: int, offset: Mapping[str, float]) -> Case:
        changed = dict(self.first) if number == 0 else self.inputs(row)
        overrides: dict[str, Any] = {} if number == 0 else dict(changed)
        for band in self.tolerances:
            value = changed.get(band.path, self._given("tolerances", band)) + offset[band.path]
            overrides[band.path] = int(value) if is_whole(self.base, band) else value
        parameters = {"design": number, "draw": draw, **changed}
        try:
            return Case(parameters, self.built(overrides), self.options)
        except InputError as error:
            return Case(parameters, None, self.options, str(error).splitlines()[0])

    def built(self, overrides: Mapping[str, Any]) -> Subject:
        """The subject with changes, and with estimates that follow from them."""
        made = dict(overrides)
        for prefix, part in self.base.parts.items():
            made |= belongs_together(Bearing.model_validate(part["bearing"]), made, {}, prefix)
            shapes = {
                SHAPE_OF[path.removeprefix(f"{prefix}{POCKET}")]
                for path in made
                if path.startswith(f"{prefix}{POCKET}")
            }
            made |= {f"{prefix}{POCKET}shape": shape for shape in shapes}
        return self.base.build(made)[0]

    def _check_names(self, data: xarray.Dataset) -> None:
        if (data["status"].values == "done").any():
            known = [
                str(name)
                for name, column in data.data_vars.items()
                if column.dims == ("case",) and column.dtype.kind in "fi"
            ]
            for field, names in (("want", self.want), ("limits", [name for name, *_ in self.limits])):
                for name in names:
                    if name not in known:
                        raise InputError.of(field, name, unknown_name(name, known))

    def _judge(self, data: xarray.Dataset) -> tuple[dict[str, float], Array]:
        """Aims and limits of a design from the runs of its draws."""
        wanted = [(name, 1.0 if kind == "least" else -1.0) for name, kind in self.want.items()]
        bounded = [(name, 1.0 if side == "largest" else -1.0) for name, side, _ in self.limits]
        if (data["status"].values != "done").any():
            return {}, np.full(len(wanted) + len(bounded), np.nan)
        over = JUDGED[self.judged]
        turned = [sign * float(over(sign * data[name].values.astype(float))) for name, sign in wanted + bounded]
        table = dict(zip([name for name, _ in reversed(wanted + bounded)], reversed(turned), strict=True))
        lines = [0.0] * len(wanted) + [value for *_, value in self.limits]
        signs = [sign for _, sign in wanted + bounded]
        return table, np.array([s * (v - line) for s, v, line in zip(signs, turned, lines, strict=True)])

    @property
    def refused(self) -> tuple[str, ...]:
        """Why runs could not be made."""
        return tuple(
            str(text) for part in self.parts for text in part["message"].values[part["status"].values != "done"]
        )

    def found(self) -> Optimum:
        """The designs, and the best of them."""
        import xarray

        ran, known = np.isfinite(self.columns).all(axis=1), np.isfinite(self.unit).all(axis=1)
        fits = Fits(self.unit[ran & known], self.columns[ran & known], self.seed)
        smooth = self.columns.copy()
        smooth[ran & known] = fits.predicted(self.unit[ran & known])
        numbers = np.flatnonzero(ran)
        front = self.aims.front(smooth[ran])
        if not front.any():
            least = {name: f"{side} {value:g}" for name, side, value in self.limits}
            raise InputError.of(
                "limits", least, "no design keeps them; more designs, wider changes or other limits may"
            )
        made = {int(n): self._design(int(n), smooth[n]) for n in numbers}
        chosen = made[int(numbers[self.aims.compromise(smooth[ran], front)])]
        subjects = (self.subject, self.subject if chosen.number == 0 else self.built(chosen.inputs))
        return Optimum(
            first=made[0],
            chosen=chosen,
            front=tuple(made[int(n)] for n in numbers[front]),
            designs=tuple(made.values()),
            want=self.want,
            refused=self.refused,
            data=xarray.concat(self.parts, "case", data_vars="all", join="outer"),
            subjects=subjects,
        )

    def _design(self, number: int, smooth: Array) -> Design:
        signs = [1.0 if kind == "least" else -1.0 for kind in self.want.values()]
        told = dict(zip(self.want, [sign * value for sign, value in zip(signs, smooth, strict=False)], strict=True))
        for (name, side, line), value in zip(self.limits, smooth[len(signs) :], strict=True):
            told.setdefault(name, line + (value if side == "largest" else -value))
        inputs = self.first if number == 0 else self.inputs(self.unit[number])
        return Design(number, dict(inputs), self.tables[number], {name: float(value) for name, value in told.items()})


JUDGED: Final[dict[str, Any]] = {"worst": np.max, "mean": np.mean}
"""What counts of the draws of a design, turned so that small is good."""


def _whole(field: str, value: Any, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise InputError.of(field, value, f"must be a whole number, at least {least}")
    return int(value)


def _wanted(want: Any) -> dict[str, str]:
    if not isinstance(want, Mapping) or not want:
        raise InputError.of("want", want, "must name at least one number of the summary: {'torque': 'least'}")
    for name, kind in want.items():
        if kind not in ("least", "most"):
            raise InputError.of(("want", name), kind, "must be 'least' or 'most'")
    return dict(want)


def _limited(limits: Mapping[str, Limit]) -> tuple[tuple[str, str, float], ...]:
    """(name, lowest or largest, value) of each end."""
    found = []
    for name, given in limits.items():
        ends = given if isinstance(given, tuple | list) else (None, given)
        if len(ends) != 2 or all(end is None for end in ends):
            raise InputError.of(
                ("limits", name), given, "must be the largest value, or (lowest, largest) with None for none"
            )
        sides = zip(("lowest", "largest"), ends, strict=True)
        found += [(name, side, number_of(f"limits.{name}", end)) for side, end in sides if end is not None]
    return tuple(found)
