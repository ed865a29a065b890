"""The best designs within limits: plays, profiles or numbers of rollers are changed, each design is run over draws of its
tolerances, and what was learned from all runs tells which designs come next (`trbdyn.extras.design.guide`). Short runs search;
the best designs are run again, longer, and the change that this makes is learned, too.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, Unpack

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown
from trbdyn.base.validation import number_of, whole_number_of
from trbdyn.errors import InputError, LoadError, unknown_name
from trbdyn.extras.design.edge_search import NUMBERS, EdgeCases
from trbdyn.extras.design.guide import Aims, Fits, next_designs
from trbdyn.extras.study.answer import Answer
from trbdyn.extras.study.bands import Band
from trbdyn.extras.study.definition import Base, Case, Study, split_path
from trbdyn.extras.study.drawn_bearing import belongs_together
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.runner import run as run_study
from trbdyn.extras.study.uncertainty import checked_bands, is_whole, unit_draws
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.pocket_shapes import SHAPES
from trbdyn.model.scene import Scene
from trbdyn.model.spectrum import Spectrum
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.options import RunOptions
from trbdyn.run.simulation import Simulation

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Limit = float | tuple[float | None, float | None]

ROUND: Final = 8
"""Designs that are run side by side before the next ones are chosen."""
FEWEST: Final = 10
"""Fewest designs."""
CONFIRMED: Final = 0.25
"""Largest share of the designs that is confirmed by longer runs, besides the first."""
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
        Aims and limited quantities, over the draws of the tolerances; of a confirmed design those of its longer runs.
    expected : dict of str to float
        The same as all runs together tell of longer runs, with less chance in them; of a confirmed design its values.
    confirmed : bool
        Whether it was run longer.
    """

    number: int
    inputs: dict[str, float]
    values: dict[str, float]
    expected: dict[str, float]
    confirmed: bool


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
        Designs that keep the limits and are beaten in all aims by no other one; of designs that were confirmed.
    designs : tuple of Design
        All that could be run.
    want : dict of str to str
        Aims, each 'least' or 'most'.
    refused : tuple of str
        Why others could not be run.
    data : xarray.Dataset
        All runs, as `trbdyn.study.run` gives them; ``design``, ``draw`` and ``length``
        (over that of the search) are coordinates.
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
        from trbdyn.extras.design.front import draw_front

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
        confirmed, moving = sum(one.confirmed for one in self.designs), 0
        told = f"of the longer runs of {confirmed} designs" if confirmed else "as all runs together tell them"
        notes = [f"aims and limits {told}; `pair` runs the first and the chosen design again"]
        if confirmed:
            longer = (self.data["design"] == self.chosen.number) & (self.data["length"] > 1.0)
            # of bearings on a shaft each has one, with its name before it
            settled = [self.data[name].values[longer] for name in self.data if str(name).endswith("settled")]
            moving = int((~np.all(settled, axis=0)).sum())
        if moving:
            notes.append(
                f"{moving} of {int(longer.sum())} longer runs of the chosen design are not known to have settled; a larger"
                " `confirm` proves more"
            )
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
    confirm: float = 10.0,
    seed: int = 0,
    options: RunOptions | None = None,
    over: Spectrum | None = None,
    **how: Unpack[Running],
) -> Optimum:
    """Find the designs with the best results; with several aims, the designs of which none is better in all aims (the front).

    A third of the designs fills the space of the changes evenly. Then Gaussian processes are fitted to all results, and eight
    designs at a time are run where the best results are expected. A longer run may give other results than a short one, because
    a whirl takes time to grow. Before each eight designs the best one so far is therefore run `confirm` times as long, and its
    new results replace the old ones. A fit to the changes from short to long runs corrects the other designs. At the end, longer
    runs are made until the best designs have one. Needs the package scikit-learn of the extra `study`.

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
    confirm : float
        How many times as long as those of the search the runs are that confirm a design, with the same draws. The first design
        and at most a quarter of the others have such runs, and the front is made of designs that have. 1 for none.
    seed : int
        Of the designs, the draws and the search. The same seed finds the same designs.
    options : RunOptions, optional
        How each draw is run; 5 turns of the shaft with 'fast' by default. `Plan.options` of `trbdyn.plan` has the accuracy
        that an aim needs.
    over : Spectrum, optional
        Load cases of one bearing, with its tilts: designs are judged by their equilibria and the pressures of half spaces, and
        nothing is run. `want` and `limits` then name ``edge_pressure``, the largest one in the outer tenth of a contact line
        over all cases, ``largest_pressure`` (Pa), or the same by slices, ``slice_edge_pressure`` and ``slice_pressure``.
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
        whole_number_of("draws", draws, 1) if tolerances else 1,
        judged,
        whole_number_of("designs", designs, FEWEST),
        _longer(confirm) if over is None else 1.0,
        whole_number_of("seed", seed, 0),
        RunOptions(revolutions=5.0, accuracy="fast") if options is None else options,
        Running(executor="threads") | how,
        None if over is None else EdgeCases(over),
    )
    search.begin(max(search.designs // 3, FEWEST - 4))
    while (left := search.designs - len(search.unit)) > 0:
        search.confirm_best(1)
        search.go_on(min(left, ROUND))
    while search.confirm_best(ROUND):
        pass
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
    designs: int
    confirm: float
    seed: int
    options: RunOptions
    how: Running
    cases: EdgeCases | None = None

    def __post_init__(self) -> None:
        if self.judged not in JUDGED:
            raise InputError.of("judged", self.judged, unknown_name(self.judged, JUDGED))
        if self.cases is not None:
            expect("subject", self.subject, Scene)
            self.cases.check("want", self.want)
            self.cases.check("limits", [name for name, *_ in self.limits])
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
        self.unit = np.empty((0, len(self.bands)))
        self.short, self.long = (np.empty((0, len(self.want) + len(self.limits))) for _ in range(2))
        self._values: Array | None = None  # until more is run
        self._smooth: Array | None = None
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
        if self.confirm > 1.0:
            self._confirm([0])
        if not self.ran[0]:
            raise InputError.of("scene", "as it is", f"cannot be run: {self.refused[0]}")
        if self.ran[1:].sum() < 2:
            raise InputError.of("change", list(self.first), f"no designs can be run; the first: {self.refused[0]}")

    def go_on(self, count: int) -> None:
        """Runs the designs that promise most."""
        known = np.isfinite(self.unit).all(axis=1)
        self._run(next_designs(self.unit[known], self.values[known], self.aims, count, self.seed + len(self.unit)))

    def confirm_best(self, most: int) -> bool:
        """Runs the designs longer that are the best as far as is known, at most so many; whether there were any."""
        left = min(most, int(CONFIRMED * self.designs) - int(self.confirmed[1:].sum()))
        smooth, front = self.smooth, self.front(self.ran)
        waiting = front & ~self.confirmed
        best: list[int] = []
        while self.confirm > 1.0 and waiting.any() and len(best) < left:
            best.append(self.aims.compromise(smooth, waiting))
            waiting[best[-1]] = False
        self._confirm(best)
        return bool(best)

    def _run(self, unit: Array) -> None:
        numbers = range(len(self.unit), len(self.unit) + len(unit))
        self.unit = np.vstack([self.unit, unit])
        tables, columns = self._judged(numbers, 1.0)
        self._values = self._smooth = None
        self.tables += tables
        self.short = np.vstack([self.short, columns])
        self.long = np.vstack([self.long, np.full_like(columns, np.nan)])

    def _confirm(self, numbers: Sequence[int]) -> None:
        if numbers:
            tables, columns = self._judged(numbers, self.confirm)
            self._values = self._smooth = None
            self.long[numbers] = columns
            # a design whose longer run fails cannot be run
            self.short[numbers] += 0.0 * columns
            for number, table in zip(numbers, tables, strict=True):
                self.tables[number] = table

    def _judged(self, numbers: Sequence[int], length: float) -> tuple[list[dict[str, float]], Array]:
        """Runs designs over all draws, so many times as long as the options say, and judges each."""
        draws = len(self.offsets)
        if self.cases is not None:
            parts = [self._at_equilibria(number, length) for number in numbers]
            self.parts += parts
            both = [self._judge(part) for part in parts]
            return [table for table, _ in both], np.array([columns for _, columns in both])
        made = [self._case(n, draw, offset, length) for n in numbers for draw, offset in enumerate(self.offsets)]
        data = run_study(Study(tuple(made), (), "optimise"), **self.how)
        self._check_names(data)
        self.parts.append(data)
        found = [self._judge(data.isel(case=slice(k * draws, (k + 1) * draws))) for k in range(len(numbers))]
        return [table for table, _ in found], np.array([columns for _, columns in found])

    def _at_equilibria(self, number: int, length: float) -> xarray.Dataset:
        """Numbers of a design at the equilibria of the load cases, for each draw."""
        import xarray

        assert self.cases is not None
        rows: list[dict[str, Any]] = []
        for draw, offset in enumerate(self.offsets):
            row: dict[str, Any] = dict.fromkeys(NUMBERS, np.nan) | {"status": "done", "message": ""}
            try:
                row |= self.cases.numbers(self._changes(number, offset)[1])
            except (InputError, LoadError) as error:
                row |= {"status": "failed", "message": str(error).splitlines()[0]}
            rows.append(row | {"design": number, "draw": draw, "length": length})
        data = xarray.Dataset({name: ("case", np.array([row[name] for row in rows])) for name in rows[0]})
        return data.set_coords(["design", "draw", "length"])

    @property
    def ran(self) -> Flags:
        """Which designs could be run."""
        return np.asarray(np.isfinite(self.short).all(axis=1))

    @property
    def confirmed(self) -> Flags:
        """Which designs were run longer."""
        return np.asarray(np.isfinite(self.long).all(axis=1))

    @property
    def values(self) -> Array:
        """Results of longer runs: of confirmed designs as they are, of others with the least change that these make likely.

        The change is the lower end of the fit's band: a design counts as worse only where longer runs of designs near to it
        were worse.
        """
        if self._values is not None:
            return self._values
        known = np.isfinite(self.unit).all(axis=1)
        ran, seen = self.ran & known, self.confirmed & known
        values = self.short.copy()
        if seen.any():
            short = Fits(self.unit[ran], self.short[ran], self.seed)
            change = Fits(self.unit[seen], self.long[seen] - short.predicted(self.unit[seen]), self.seed)
            values[ran] += change.predicted(self.unit[ran], 1.0)
        self._values = np.where(self.confirmed[:, None], self.long, values)
        return self._values

    @property
    def smooth(self) -> Array:
        """The same, of designs that were not confirmed as all runs together tell."""
        if self._smooth is not None:
            return self._smooth
        values, fit = self.values, self.ran & np.isfinite(self.unit).all(axis=1)
        told = values.copy()
        told[fit] = Fits(self.unit[fit], values[fit], self.seed).predicted(self.unit[fit])
        self._smooth = np.where(self.confirmed[:, None], values, told)
        return self._smooth

    def front(self, among: Flags) -> Flags:
        """Which of some designs keep the limits and are beaten in all aims by no other one of them."""
        front = among.copy()
        front[among] = self.aims.front(self.smooth[among])
        return front

    def inputs(self, row: Array) -> dict[str, float]:
        """What a design changes; of the subject as it is what it has."""
        found = {}
        for band, share, cells in zip(self.bands, row, self.aims.cells, strict=True):
            value = band.low + share * (band.high - band.low + (1.0 if cells else 0.0))
            found[band.path] = int(value) if cells else float(value)
        return found

    def _changes(self, number: int, offset: Mapping[str, float]) -> tuple[dict[str, float], dict[str, Any]]:
        """What a design has, and what has to be put into the subject for it with a draw of its tolerances."""
        changed = dict(self.first) if number == 0 else self.inputs(self.unit[number])
        overrides: dict[str, Any] = {} if number == 0 else dict(changed)
        for band in self.tolerances:
            value = changed.get(band.path, self._given("tolerances", band)) + offset[band.path]
            overrides[band.path] = int(value) if is_whole(self.base, band) else value
        return changed, overrides

    def _case(self, number: int, draw: int, offset: Mapping[str, float], length: float) -> Case:
        changed, overrides = self._changes(number, offset)
        parameters = {"design": number, "draw": draw, "length": length, **changed}
        given = {name: getattr(self.options, name) for name in ("revolutions", "duration")}
        options = self.options.replace({name: length * value for name, value in given.items() if value is not None})
        try:
            return Case(parameters, self.built(overrides), options)
        except InputError as error:
            return Case(parameters, None, options, str(error).splitlines()[0])

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

        smooth = self.smooth
        front = self.front(self.confirmed if self.confirm > 1.0 else self.ran)
        if not front.any():
            least = {name: f"{side} {value:g}" for name, side, value in self.limits}
            kept = "no design that was run longer keeps them" if self.confirm > 1.0 else "no design keeps them"
            raise InputError.of("limits", least, f"{kept}; more designs, wider changes or other limits may")
        made = {int(n): self._design(int(n), smooth[n]) for n in np.flatnonzero(self.ran)}
        chosen = made[self.aims.compromise(smooth, front)]
        subjects = (self.subject, self.subject if chosen.number == 0 else self.built(chosen.inputs))
        return Optimum(
            first=made[0],
            chosen=chosen,
            front=tuple(made[int(n)] for n in np.flatnonzero(front)),
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
        expected = {name: float(value) for name, value in told.items()}
        return Design(number, dict(inputs), self.tables[number], expected, bool(self.confirmed[number]))


JUDGED: Final[dict[str, Any]] = {"worst": np.max, "mean": np.mean}
"""What counts of the draws of a design, turned so that small is good."""


def _longer(confirm: Any) -> float:
    if not 1.0 <= number_of("confirm", confirm) < np.inf:
        raise InputError.of("confirm", confirm, "must be >= 1 and finite; 1 for no longer runs")
    return float(confirm)


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
