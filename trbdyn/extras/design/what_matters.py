"""Which of the estimated inputs matter for a chosen result: each is moved through its band, alone, and the runs are
compared.

A cage that collides is chaotic: a billionth of an input moves the result of a short run as far as a real change does. So each end
of a band is run from several starts and compared with runs of the estimate from the same starts, and these are made again with
the rollers' diameter changed by billionths. A difference is told apart where it is larger than what chance makes of as many ends
as the table has, once in twenty tables (Student's t with Bonferroni's correction). Its error is the largest of three: from its
own scatter over the starts, from that of the other ends in the median, and from that of the repeated runs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Unpack

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import whole_number_of
from trbdyn.errors import InputError, unknown_name
from trbdyn.extras.study.definition import Case, Study
from trbdyn.extras.study.drawn_bearing import belongs_together
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.runner import run as run_study
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.estimated import Estimated
from trbdyn.model.scene import Scene, Start
from trbdyn.run.options import RunOptions

if TYPE_CHECKING:
    import xarray

    from trbdyn.model.bearing import Bearing

Array = NDArray[np.float64]

STARTS: Final = 3
REPEATS: Final = 4
"""Runs of the estimate from each start, all but one with a roller diameter that differs by billionths."""
BILLIONTH: Final = 1e-9
CHANCE: Final = 0.05
"""Chance that any end of a table without influences is told apart."""
MEASURED: Final = "measured"
"""Name of the observable that a function of the result gives."""
LEAST_SHARE: Final = 1e-5
"""Difference over the result below which nothing is told apart: the tolerances of the runs are not finer."""


@dataclass(frozen=True)
class Influence:
    """What an estimated input does to the chosen result.

    Attributes
    ----------
    estimated : Estimated
        The input with its band.
    at_low, at_high : float or None
        The result with the input at the ends of its band, mean over the starts; None where such a bearing cannot be built or run.
    span : float
        Largest difference of the result from its value with the estimate, in the result's unit.
    told_apart : bool
        Whether a difference is larger than what chance makes of it.
    note : str
        Why an end of the band could not be run; empty if both could.
    """

    estimated: Estimated
    at_low: float | None
    at_high: float | None
    span: float
    told_apart: bool
    note: str = ""


@dataclass(frozen=True, repr=False)
class Sensitivity(Tabled):
    """Influence of each estimated input on a result, the largest first.

    Attributes
    ----------
    quantity : str
        Name of the result.
    value : float
        The result with all estimates as they are, mean over the starts.
    scatter : float
        What chance alone makes of the difference at an end of a band, in the median: smaller influences cannot be told.
    influences : tuple of Influence
        One an input.
    """

    quantity: str
    value: float
    scatter: float
    influences: tuple[Influence, ...]

    def _shown(self) -> Shown:
        rows: list[tuple[str, ...]] = []
        for entry in self.influences:
            ends = " to ".join("not possible" if end is None else f"{end:.4g}" for end in (entry.at_low, entry.at_high))
            mark = "" if entry.told_apart else "  (not told apart from chance)"
            share = f"{100.0 * entry.span / abs(self.value):.1f} %" if self.value else f"{entry.span:.3g}"
            rows.append((entry.estimated.path, share.rjust(8), f"{ends}{mark}"))
        notes = [f"Not possible: {entry.estimated.path} = {entry.note}" for entry in self.influences if entry.note]
        if self.influences and not any(entry.told_apart for entry in self.influences):
            notes.append(
                "No influence can be told from chance with runs as short and few as these: allow more turns or starts."
            )
        title = f"{self.quantity} = {self.value:.4g}; by chance alone it moves by up to {self.scatter:.2g}"
        return Shown(
            title, tuple(rows), ("input", "changes it by", "from one end of its band to the other"), tuple(notes)
        )


def sensitivity(
    subject: Subject,
    quantity: str | Callable[[Any], float] = "torque",
    *,
    revolutions: float = 5.0,
    accuracy: str = "fast",
    paths: Sequence[str] | None = None,
    starts: int = STARTS,
    **how: Unpack[Running],
) -> Sensitivity:
    """Which estimated inputs of a scene's bearing, or of the bearings of an assembly, matter for a result.

    Every estimate (`Bearing.estimated`) is put to the low and the high end of its band, and short runs from several starts
    are made for each end. What follows from it moves with it: the number of rollers with their diameter and the pitch
    diameter, their length with that of the contact line; and the number by itself moves as far as rollers of their size have
    room, from 80 to 90 % of the pitch circle. A cage that collides is chaotic, so a result moves whatever is changed:
    influences that are smaller than what chance makes are marked as not told apart. An influence on the slow creep of the
    rollers, which takes longer than the runs, is not seen.

    Parameters
    ----------
    subject : Scene or Assembly
        What is simulated; a bearing of it has estimates. Those of a bearing on a shaft have paths such as
        ``bearings[0].bearing.cage.mass``.
    quantity : str or callable
        Name of an entry of `Result.numbers`, or a function that gives a number for a result.
    revolutions : float
        Turns of the shaft of each run.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances.
    paths : sequence of str, optional
        Only these inputs; all estimates by default.
    starts : int
        Starts of each run, at least 2: that of the scene, and others. More starts tell smaller influences apart.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`.

    Returns
    -------
    Sensitivity
        Print it for a table.

    Raises
    ------
    InputError
        If the bearing has no estimates, a name is unknown, the result is no number, or the scene cannot be run.

    Examples
    --------
    >>> import trbdyn as trb
    >>> bearing = trb.Bearing.from_catalogue(bore=0.050, outside=0.110, width=0.02925, C=125e3, e=0.35, name="30310")
    >>> scene = trb.Scene(bearing, speed_rpm=2000, axial_load=3000.0)
    >>> found = trb.sensitivity(scene, "outer_load_mean", revolutions=0.2, paths=["cup_half_angle_deg", "cage.mass"])
    >>> found.influences[0].estimated.path
    'cup_half_angle_deg'
    """
    expect("scene", subject, Scene, Assembly)
    starts = whole_number_of("starts", starts, 2, 1000)
    chosen = _chosen(subject, paths)
    name = quantity if isinstance(quantity, str) else getattr(quantity, "__name__", "result")
    options = RunOptions(revolutions=revolutions, accuracy=accuracy)
    begun = [_begun(subject, k) for k in range(starts)]
    how = Running(executor="threads") | how
    key, watched = (quantity, {}) if isinstance(quantity, str) else (MEASURED, {MEASURED: quantity})

    def ran(cases: Sequence[Case]) -> xarray.Dataset:
        return run_study(Study(tuple(cases), (), "sensitivity"), observables=watched, **how)

    first, part = next(iter(subject.parts)), subject.part
    diameter = part.bearing.roller.diameter
    same = []
    for k in range(REPEATS):
        change = {"roller.diameter": diameter * (1.0 + k * BILLIONTH)} if k else {}
        same += _cases(begun, first, partial(part.bearing.replace, change), options, f"estimate {k}")
    base = _base(ran(same), key, name).reshape(REPEATS, starts)
    moved = []
    for prefix, entry in chosen:
        for end in (entry.low, entry.high):
            bearing = None if end == entry.value else partial(_moved, subject.parts[prefix].bearing, entry, end)
            moved += _cases(begun, prefix, bearing, options, f"{prefix}{entry.path} {end:.6g}")
    # in a folder the runs of the estimate are done, and stand in its dataset beside the others
    kept = same if how.get("folder") is not None else []
    found, why = _values(ran([*kept, *moved]).isel(case=slice(len(kept), None)), key, starts)
    value, ends = float(base.mean()), found.reshape(len(chosen), 2, starts)
    limits, means = told_from(base, ends), ends.mean(axis=-1)
    apart = np.nan_to_num(np.abs(means - value))
    influences = []
    for k, (prefix, entry) in enumerate(chosen):
        band = (entry.low, entry.high)
        at = [
            value if end == entry.value else None if np.isnan(mean) else float(mean)
            for end, mean in zip(band, means[k], strict=True)
        ]
        note = "; ".join(f"{end:.4g}: {said}" for end, said in zip(band, why[2 * k : 2 * k + 2], strict=True) if said)
        told = bool((apart[k] > limits[k]).any())
        influences.append(Influence(_named(prefix, entry), at[0], at[1], float(apart[k].max()), told, note))
    influences.sort(key=lambda entry: -entry.span)
    known = limits[np.isfinite(limits)]
    return Sensitivity(name, value, float(np.median(known)) if known.size else 0.0, tuple(influences))


def told_from(base: Array, ends: Array) -> Array:
    """Difference of the mean over the starts from which each end of a band is told apart from the estimate, shape (n, 2).

    `base` has the result with the estimates in R repeated runs from each of S starts, shape (R, S); `ends` the result at both
    ends of each band from the same starts, shape (n, 2, S), nan where there is none.
    """
    from scipy import stats

    repeats, starts = base.shape
    mean = base.mean(axis=0)
    of_chance = float(base.var(axis=0, ddof=1).mean()) * (1.0 + 1.0 / repeats)
    own = (ends - mean).var(axis=-1, ddof=1)
    known = own[np.isfinite(own)]
    if not known.size:
        return np.asarray(own)
    usual = float(np.median(known)) / (float(stats.chi2.median(starts - 1)) / (starts - 1))
    factor = float(stats.t.ppf(1.0 - 0.5 * CHANCE / known.size, starts * (repeats - 1)))
    least = LEAST_SHARE * abs(float(mean.mean()))
    return np.maximum(factor * np.sqrt(np.maximum(own, max(usual, of_chance)) / starts), least)


def _named(prefix: str, entry: Estimated) -> Estimated:
    """An estimate with its path in the subject: that in the bearing where there is one bearing alone."""
    return entry.replace(path=f"{prefix}bearing.{entry.path}") if prefix else entry


def _chosen(subject: Subject, paths: Sequence[str] | None) -> list[tuple[str, Estimated]]:
    """Estimates, each with the beginning of its bearing's paths."""
    known = {
        _named(prefix, entry).path: (prefix, entry)
        for prefix, part in subject.parts.items()
        for entry in part.bearing.estimated
    }
    if not known:
        names = ", ".join(part.bearing.name for part in subject.parts.values())
        raise InputError.of("scene", names, "must have a bearing with estimates, as Bearing.from_catalogue makes it")
    for path in paths or ():
        if path not in known:
            raise InputError.of("paths", path, unknown_name(path, known))
    return list(known.values()) if paths is None else [known[path] for path in paths]


def _cases(
    begun: Sequence[Subject], prefix: str, bearing: Callable[[], Bearing] | None, options: RunOptions, words: str
) -> list[Case]:
    """A bearing in place of that of a part, from all starts; none where it cannot be built, or there is nothing to run."""
    subjects: Sequence[Subject | None] = [None] * len(begun)
    why = ""
    if bearing is not None:
        try:
            made = bearing()
            subjects = [one.with_part(prefix, bearing=made) for one in begun]
        except InputError as error:
            why = str(error)
    return [Case({"input": words, "start": k}, one, options, why) for k, one in enumerate(subjects)]


def _base(data: xarray.Dataset, key: str, name: str) -> Array:
    """The result of the runs with the estimates; an error where one failed, or a result is no number."""
    for status, message in zip(data["status"].values, data["message"].values, strict=True):
        if status != "done":
            raise InputError.of("scene", "as it is", f"cannot be run: {message}")
    numbers = {
        str(other): np.asarray(values, dtype=float)
        for other, values in data.data_vars.items()
        if values.dims == ("case",) and values.dtype.kind in "fi" and other != "wall_time"
    }
    if key in numbers and np.isfinite(numbers[key]).all():
        return numbers[key]
    mistake = str(data["message"].values[0]).partition("; ")[2] or "it gave none"
    limit = f"must give a number for each run: {mistake}" if key == MEASURED else unknown_name(name, numbers)
    raise InputError.of("quantity", name, limit)


def _values(data: xarray.Dataset, key: str, starts: int) -> tuple[Array, list[str]]:
    """The result from all starts at each end of a band, shape (ends, starts), nan where there is none, and why."""
    found, why = np.full((data.sizes["case"] // starts, starts), np.nan), []
    for k, values in enumerate(found):
        rows = data.isel(case=slice(k * starts, (k + 1) * starts))
        failed = [str(m) for s, m in zip(rows["status"].values, rows["message"].values, strict=True) if s != "done"]
        given = np.asarray(rows[key].values, dtype=float) if key in rows and not failed else values
        good = bool(np.isfinite(given).all())
        values[:] = given if good else np.nan
        why.append("" if good else _reason(failed[0]) if failed else "the result is no number")
    return found, why


def _begun(subject: Subject, number: int) -> Subject:
    """The subject with the start of its bearings, or another one."""
    for prefix, part in subject.parts.items():
        subject = subject.with_part(prefix, start=_start(part.start, number))
    return subject


def _start(start: Start, number: int) -> Start:
    if number == 0:
        return start
    if start.kind == "whirl":
        return start.replace(direction_deg=start.direction_deg + 37.0 * number)
    if start.kind == "unequal":
        return start.replace(seed=start.seed + number)
    return Start.unequal(number, spread=0.3)


def _reason(text: str) -> str:
    """Why a bearing cannot be built or run, in a line: every problem of an error that has several."""
    return "; ".join(line.strip() for line in text.splitlines() if line.strip())


def _moved(bearing: Bearing, entry: Estimated, value: float) -> Bearing:
    """The bearing with an estimate moved to an end of its band, and with it the estimates that follow from it."""
    path = f"bearing.{entry.path}"
    share = 0.0 if value == entry.low else 1.0
    drawn = belongs_together(bearing, {path: value}, {path: (entry.low, entry.high, share)})
    return bearing.replace({name.removeprefix("bearing."): to for name, to in drawn.items()})
