"""The paper's statements, judged by our runs.

A judge looks at one start and gives what it finds and whether that agrees: yes, no, or None where a point is missing. Nothing is
decided beforehand: the words "agrees" come out of `judge_all` alone. The radius of a whirl is that of the orbit about its own
centre: a cage that hangs at the bottom is far from the axis without whirling. Where the paper tells how far the locus reaches,
the 95th percentile of the distance from the axis is taken. Differences count if they are larger than twice their standard error
(`SIGMAS`), from the turns of the cage within a run and from the seeds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any, Final, Literal

from paper.figures import MovableLimits
from paper.point_numbers import Runs
from paper.points import FIGURES, Condition, Inputs, Point, StartKind
from trbdyn.model.bearing import Bearing
from trbdyn.model.cases import rig_30310

SIGMAS: Final = 2.0
"""Standard errors that a difference must have to count."""
RATIO_TOLERANCE: Final = 0.05
"""Of whirl over cage frequency: half a turn in the ten or so that the statistics hold."""
ABOUT_ONE: Final = 0.15
"""Reach of the locus / Cpr "about 1": free rollers let the cage go to 1.00 to 1.04."""
ABOUT_CPC: Final = 0.15
"""Tolerance of "about Cpc/Cpr", which is 0.48: the play between equal spacing (0.43) and what a locus shows."""
INSENSITIVE: Final = 0.1
"""Largest range of the reach / Cpr over speeds and loads that counts as insensitive."""
MUCH: Final = 2.0
"""Factor of "much higher"."""
CLEARLY: Final = 1.5
"""Factor of "clearly larger"."""
AXIAL_LIMIT: Final = 0.15
"""Share of the axial play, as the paper says."""
NO_HANG: Final = 0.5
"""Orbit / Cpr from which the reach of a locus is that of a whirl, and not of a cage that hangs at the limit of its play."""
UNEQUAL: Final = 0.1
"""Standard deviation of mean gaps, in units of Cpc/(Dpw/2), from which spacing is unequal."""
ORDER_SHARE: Final = 0.5
"""Share of variance at the cage's frequency from which a signal changes with the cage's turn."""

NAMED: Final = Inputs(180.0, 0.2e-6)
"""Loaded zone where rollers descend, a scatter as of rollers of a class: the choice, within what the paper leaves open, for which
most statements hold. It was found by comparing directions and scatters with the statements, so that it is no prediction."""

Finding = tuple[str, bool | None]
Judge = Callable[[Runs, StartKind], Finding]

STAR: Final = "\\*"

NOT_RUN: Final[Finding] = ("not run", None)


@dataclass(frozen=True)
class Statement:
    """A statement of the paper.

    Attributes
    ----------
    key : str
        Short name.
    figure : str
        Figure of the paper (measured / simulated).
    text : str
        What it says.
    conditions : tuple of Condition
        Points that it is about.
    judge : callable
        Gives finding and verdict from one start.
    """

    key: str
    figure: str
    text: str
    conditions: tuple[Condition, ...]
    judge: Judge


@dataclass(frozen=True)
class Judged:
    """A statement with what we find.

    Attributes
    ----------
    statement : Statement
        The statement.
    findings : dict of str to (finding, verdict)
        By start.
    unsettled : dict of str to tuple of str
        Points among them that had not settled, by start.
    verdict : str
        'agrees', 'disagrees', 'depends on the start', or 'open' where nothing was run.
    """

    statement: Statement
    findings: dict[str, Finding]
    unsettled: dict[str, tuple[str, ...]]
    verdict: Literal["agrees", "disagrees", "depends on the start", "open"]

    def to_dict(self) -> dict[str, Any]:
        """Plain data."""
        rows = {start: {"finding": text, "agrees": agrees} for start, (text, agrees) in self.findings.items()}
        return {
            "key": self.statement.key,
            "figure": self.statement.figure,
            "statement": self.statement.text,
            "verdict": self.verdict,
            "unsettled": sorted({name for names in self.unsettled.values() for name in names}),
            "by_start": rows,
        }


def _have(runs: Runs, start: StartKind, conditions: Sequence[Condition]) -> bool:
    return all(runs.of(condition, start) for condition in conditions)


def _orbit(runs: Runs, condition: Condition, start: StartKind) -> tuple[float, float]:
    name = "orbit_over_cpr"
    return runs.mean(condition, start, name), runs.error(condition, start, (name,), "orbit_standard_error")


def _reach(runs: Runs, condition: Condition, start: StartKind) -> float:
    return runs.mean(condition, start, "whirl_radius_over_cpr", "p95")


def _grows(values: Sequence[tuple[float, float]]) -> bool | None:
    """Whether each value is larger than the one before, beyond the noise; None where the noise is not known."""
    if not all(math.isfinite(number) for value in values for number in value):
        return None
    return all(after - before > SIGMAS * math.hypot(one, other) for (before, one), (after, other) in pairwise(values))


def _and(verdicts: Sequence[bool | None]) -> bool | None:
    """Whether all are true; None if that is not known."""
    if any(verdict is False for verdict in verdicts):
        return False
    return None if any(verdict is None for verdict in verdicts) else True


def _listed(names: Sequence[str], values: Sequence[tuple[float, float]], digits: int = 2) -> str:
    return ", ".join(f"{name}: {_with_error(*value, digits)}" for name, value in zip(names, values, strict=True))


def _with_error(value: float, error: float, digits: int = 2) -> str:
    if not math.isfinite(error):
        return f"{value:.{digits}f} ± ?"
    # as many digits as the error needs to show
    shown = max(digits, math.ceil(-math.log10(error)) if error > 0.0 else digits)
    return f"{value:.{shown}f} ± {error:.{shown}f}"


def _rpm(conditions: Sequence[Condition]) -> list[str]:
    return [f"{condition.speed_rpm:g} rpm" for condition in conditions]


def _newton(conditions: Sequence[Condition]) -> list[str]:
    return [f"{condition.axial_load:g} N" for condition in conditions]


def _circles(runs: Runs, condition: Condition, start: StartKind) -> tuple[bool, str]:
    """Whether the cage circles with its own frequency, in every seed."""
    kinds = [run.numbers["cage_motion"] for run in runs.of(condition, start)]
    ratio = runs.mean(condition, start, "whirl_ratio")
    circling = all(kind == "circling" for kind in kinds)
    text = f"ratio {ratio:.2f}" if circling else "/".join(sorted(set(kinds)))
    return circling and abs(ratio - 1.0) <= RATIO_TOLERANCE, text


def _whirls(runs: Runs, condition: Condition, start: StartKind) -> tuple[bool, str]:
    """Whether the orbit has the cage's own frequency, in every seed: it circles, or most of its orbit is at that frequency.
    A cage that hangs to one side may do so, too.
    """
    circles, text = _circles(runs, condition, start)
    numbers = [run.numbers for run in runs.of(condition, start)]
    if circles or not all(_has_own_frequency(one) for one in numbers):
        return circles, text
    ratio = runs.mean(condition, start, "whirl_ratio")
    return True, f"ratio {ratio:.2f}, {text}"


def _has_own_frequency(numbers: Mapping[str, Any]) -> bool:
    ratio = numbers["whirl_ratio"]
    if ratio is None or abs(ratio - 1.0) > RATIO_TOLERANCE or numbers["cage_motion"] == "stable":
        return False
    if numbers["cage_motion"] == "circling":
        return True
    return bool((numbers["whirl_amplitude_over_cpr"] / numbers["orbit_over_cpr"]) ** 2 >= ORDER_SHARE)


def _own_frequency(runs: Runs, start: StartKind) -> Finding:
    conditions = FIGURES["12a"]
    if not _have(runs, start, conditions):
        return NOT_RUN
    found = [_whirls(runs, condition, start) for condition in conditions]
    words = ", ".join(f"{name}: {text}" for name, (_, text) in zip(_rpm(conditions), found, strict=True))
    return words, all(circles for circles, _ in found)


def _mostly_own_frequency(runs: Runs, start: StartKind) -> Finding:
    conditions = tuple(dict.fromkeys((*FIGURES["12a"], *FIGURES["12b"])))
    if not _have(runs, start, conditions):
        return NOT_RUN
    count = sum(_whirls(runs, condition, start)[0] for condition in conditions)
    return f"in {count} of {len(conditions)} conditions of figs. 12a and 12b", count > len(conditions) / 2


def _growing(figure: str, name: Callable[[Sequence[Condition]], list[str]]) -> Judge:
    def judge(runs: Runs, start: StartKind) -> Finding:
        conditions = FIGURES[figure]
        if not _have(runs, start, conditions):
            return NOT_RUN
        values = [_orbit(runs, condition, start) for condition in conditions]
        full = [abs(_reach(runs, condition, start) - 1.0) <= ABOUT_ONE for condition in conditions]
        text = "orbit/Cpr " + _listed(name(conditions), values)
        return text, _and([_grows_or_fills(*pair) for pair in zip(pairwise(values), pairwise(full), strict=True)])

    return judge


def _grows_or_fills(values: tuple[tuple[float, float], tuple[float, float]], full: tuple[bool, bool]) -> bool | None:
    """Whether the second value is the larger one; where both whirls fill the play it is as large as it can be, and no smaller."""
    grows = _grows(values)
    if grows is None or not (all(full) and min(value for value, _ in values) > NO_HANG):
        return grows
    return grows or not _grows(values[::-1])


def _about_one(runs: Runs, start: StartKind) -> Finding:
    condition = FIGURES["12b"][-1]
    if not _have(runs, start, [condition]):
        return NOT_RUN
    reach, (circles, text) = _reach(runs, condition, start), _circles(runs, condition, start)
    orbit = _orbit(runs, condition, start)
    return f"{text}, orbit/Cpr {_with_error(*orbit)}, reaches {reach:.2f}", circles and abs(reach - 1.0) <= ABOUT_ONE


def _no_whirl(runs: Runs, start: StartKind) -> Finding:
    condition = FIGURES["12b"][0]
    if not _have(runs, start, [condition]):
        return NOT_RUN
    circles, text = _circles(runs, condition, start)
    orbit = runs.mean(condition, start, "orbit_over_cpr")
    return f"{text}, orbit about its own centre {orbit:.2f} Cpr", not circles


def _axial_grows(runs: Runs, start: StartKind) -> Finding:
    conditions = FIGURES["9"]
    if not _have(runs, start, conditions):
        return NOT_RUN
    values = [
        (
            100.0 * runs.mean(condition, start, "axial_range", 1),
            100.0 * runs.error(condition, start, ("axial_over_clearance",), "axial_standard_error"),
        )
        for condition in conditions
    ]
    return "95 % of the axial place, % of play: " + _listed(_rpm(conditions), values, 1), _grows(values)


def _axial_small(runs: Runs, start: StartKind) -> Finding:
    conditions = FIGURES["9"]
    if not _have(runs, start, conditions):
        return NOT_RUN
    largest = max(runs.mean(condition, start, "axial_range", 1) for condition in conditions)
    return f"95 % below {100.0 * largest:.1f} % of the axial play", largest < AXIAL_LIMIT


def _tilt_frequency(runs: Runs, start: StartKind) -> Finding:
    conditions = FIGURES["10"]
    if not _have(runs, start, conditions):
        return NOT_RUN
    found = [runs.values(condition, start, "tilt_peak_order") for condition in conditions]
    shares = [runs.mean(condition, start, "tilt_order_share") for condition in conditions]
    words = ", ".join(
        f"{c.speed_rpm:g} rpm {c.axial_load:g} N: strongest order {'/'.join(f'{o:g}' for o in sorted(set(orders)))}, "
        f"share of order 1 {share:.2f}"
        for c, orders, share in zip(conditions, found, shares, strict=True)
    )
    if not all(math.isfinite(share) for share in shares):
        return "less than a turn of the cage", None
    return words, all(order == 1.0 for orders in found for order in orders)


def _tilt_direction(runs: Runs, start: StartKind) -> Finding:
    conditions = FIGURES["10"]
    if not _have(runs, start, conditions):
        return NOT_RUN
    lean = [1e3 * runs.mean(condition, start, "lean_mean") for condition in conditions]
    with_y = [runs.mean(condition, start, "tilt_x_with_y") for condition in conditions]
    words = ", ".join(
        f"{c.speed_rpm:g} rpm {c.axial_load:g} N: lean {value:.3f} mrad, correlation of theta_x with y {r:.2f}"
        for c, value, r in zip(conditions, lean, with_y, strict=True)
    )
    return words, all(value > 0.0 for value in lean)


def _forces(runs: Runs, start: StartKind) -> Finding:
    conditions = FIGURES["13"]
    if not _have(runs, start, conditions):
        return NOT_RUN
    slow, fast = (runs.mean(condition, start, "pocket_force_p95") for condition in conditions)
    return f"95 % of the force in contact: {slow:.1f} N at 1000 rpm, {fast:.1f} N at 3000 rpm", fast >= MUCH * slow


@cache
def _rig() -> Bearing:
    return rig_30310()


def _spacing_unit() -> float:
    """Angle Cpc/(Dpw/2) that a roller may move in its pocket (deg)."""
    return math.degrees(_rig().cage.play_circumferential / (0.5 * _rig().pitch_diameter))


def _yields(runs: Runs, start: StartKind) -> Finding:
    condition = FIGURES["14"][0]
    if not _have(runs, start, [condition]):
        return NOT_RUN
    varies, share = (runs.mean(condition, start, name) for name in ("spacing_varies_deg", "spacing_order_share"))
    if not math.isfinite(share):
        return "less than a turn of the cage", None
    text = f"gaps vary by {varies:.3f} deg rms, {100.0 * share:.0f} % of its square with the cage's turn"
    return text, varies >= UNEQUAL * _spacing_unit() and share >= ORDER_SHARE


def _persists(runs: Runs, start: StartKind) -> Finding:
    condition = FIGURES["14"][1]
    if not _have(runs, start, [condition]):
        return NOT_RUN
    lasting, varies = (runs.mean(condition, start, name) for name in ("spacing_mean_std_deg", "spacing_varies_deg"))
    text = f"mean gaps differ by {lasting:.3f} deg rms, each varies by {varies:.3f} deg rms"
    return text, lasting >= UNEQUAL * _spacing_unit() and lasting > varies


def _scatter(runs: Runs, start: StartKind) -> Finding:
    even, scattered = FIGURES["15"]
    if not _have(runs, start, [even, scattered]):
        return NOT_RUN
    one, other = (runs.mean(condition, start, "orbit_over_cpr") for condition in (even, scattered))
    return f"orbit {one:.3f} Cpr without, {other:.3f} Cpr with scatter", other >= CLEARLY * one


def _combined() -> tuple[Condition, ...]:
    return tuple(dict.fromkeys((*FIGURES["16a"], *FIGURES["16b"])))


def _names(conditions: Sequence[Condition]) -> list[str]:
    return [f"{condition.speed_rpm:g} rpm {condition.radial_load:g} N" for condition in conditions]


def _combined_smaller(runs: Runs, start: StartKind) -> Finding:
    combined, alone = FIGURES["16a"][-1], FIGURES["12b"][-1]
    if not _have(runs, start, [combined, alone]):
        return NOT_RUN
    values = [_orbit(runs, condition, start) for condition in (combined, alone)]
    return "orbit/Cpr " + _listed([f"Fr {combined.radial_load:g} N", "axial load alone"], values), _grows(values)


def _combined_size(runs: Runs, start: StartKind) -> Finding:
    conditions = _combined()
    if not _have(runs, start, conditions):
        return NOT_RUN
    size = _rig().cage.play_circumferential / _rig().cage.play_radial
    reached = [_reach(runs, condition, start) for condition in conditions]
    orbits = [_orbit(runs, condition, start)[0] for condition in conditions]
    text = f"the locus reaches {min(reached):.2f} to {max(reached):.2f} Cpr, orbit {min(orbits):.2f} to {max(orbits):.2f} Cpr"
    return f"{text}; Cpc/Cpr is {size:.2f}", all(abs(reach - size) <= ABOUT_CPC for reach in reached)


def _combined_insensitive(runs: Runs, start: StartKind) -> Finding:
    conditions = _combined()
    if not _have(runs, start, conditions):
        return NOT_RUN
    reached = [_reach(runs, condition, start) for condition in conditions]
    values = zip(_names(conditions), reached, strict=True)
    text = "the locus reaches " + ", ".join(f"{name}: {value:.2f}" for name, value in values)
    return text, max(reached) - min(reached) <= INSENSITIVE


def _equalises(runs: Runs, start: StartKind) -> Finding:
    condition = FIGURES["18"][0]
    if not _have(runs, start, [condition]):
        return NOT_RUN
    if start == "equal":
        end = runs.mean(condition, start, "spacing_std_deg")
        return f"started even; deviation {end:.3f} deg at the end", None
    before, after = (runs.mean(condition, start, name) for name in ("spacing_std_start_deg", "spacing_std_deg"))
    return f"deviation of the spacing {before:.3f} deg at the start, {after:.3f} deg at the end", after <= 0.5 * before


STATEMENTS: Final = (
    Statement(
        "8a-measured",
        "8a",
        "Measured: the cage whirls at its own rotation frequency at every speed (3080 N).",
        FIGURES["12a"],
        _own_frequency,
    ),
    Statement(
        "12-simulated",
        "12",
        "Simulated: it whirls at its own rotation frequency in most conditions.",
        tuple(dict.fromkeys((*FIGURES["12a"], *FIGURES["12b"]))),
        _mostly_own_frequency,
    ),
    Statement(
        "8a-speed", "8a / 12a", "The radius grows with the speed (3080 N).", FIGURES["12a"], _growing("12a", _rpm)
    ),
    Statement(
        "8b-load", "8b / 12b", "The radius grows with the load (3000 rpm).", FIGURES["12b"], _growing("12b", _newton)
    ),
    Statement("8b-one", "8b / 12b", "It reaches about 1 at 4930 N.", FIGURES["12b"][-1:], _about_one),
    Statement("12b-none", "12b", "No clear whirl at 1230 N, 3000 rpm (simulated).", FIGURES["12b"][:1], _no_whirl),
    Statement("9-speed", "9", "Axial motion grows with the speed (3080 N).", FIGURES["9"], _axial_grows),
    Statement("9-small", "9", "It stays under 15 % of the axial play.", FIGURES["9"], _axial_small),
    Statement("10-frequency", "10", "The tilt's fundamental is at the cage frequency.", FIGURES["10"], _tilt_frequency),
    Statement(
        "10-direction",
        "10",
        "theta_x < 0 with the cage's centre at +y (it leans to its displacement).",
        FIGURES["10"],
        _tilt_direction,
    ),
    Statement(
        "13-forces",
        "13",
        "Roller-cage forces at 3000 rpm are much higher than at 1000 rpm (3080 N).",
        FIGURES["13"],
        _forces,
    ),
    Statement("14-yields", "14", "The spacing changes with the cage's turn at 1230 N.", FIGURES["14"][:1], _yields),
    Statement("14-persists", "14", "It is unequal and persistent at 4930 N.", FIGURES["14"][1:], _persists),
    Statement(
        "15-scatter", "15", "The whirl at 1230 N is clearly larger with 1 um of scatter.", FIGURES["15"], _scatter
    ),
    Statement(
        "16-smaller",
        "11 / 16",
        "The radius is smaller under combined load (3000 rpm).",
        (FIGURES["16a"][-1], FIGURES["12b"][-1]),
        _combined_smaller,
    ),
    Statement("16-size", "11 / 16", "It is about Cpc/Cpr there.", _combined(), _combined_size),
    Statement(
        "16-insensitive",
        "11 / 16",
        "It is insensitive to speed and radial load there.",
        _combined(),
        _combined_insensitive,
    ),
    Statement(
        "18-equalises",
        "18",
        "The spacings drift from unequal to 30 deg (2000 rpm, Fr 5530 N).",
        FIGURES["18"],
        _equalises,
    ),
)


def _movable(limits: MovableLimits) -> Judged:
    equal, free = limits.equal.distance, limits.free.distance
    text = f"equal {equal.min():.3f} to {equal.max():.3f} Cpr, free rollers {free.min():.3f} to {free.max():.3f} Cpr"
    agrees = bool(equal.max() < free.min())
    statement = Statement(
        "17-movable",
        "17",
        "The cage can move farther with unequal spacing than with equal spacing.",
        (),
        lambda runs, start: (text, agrees),
    )
    return Judged(statement, {"geometry": (text, agrees)}, {}, "agrees" if agrees else "disagrees")


def judge_all(runs: Runs, limits: MovableLimits | None = None) -> list[Judged]:
    """Judge every statement from every start that was run."""
    out = [judge_statement(runs, statement) for statement in STATEMENTS]
    if limits is not None:
        out.insert(-1, _movable(limits))
    return out


def judge_statement(runs: Runs, statement: Statement) -> Judged:
    """Judge one statement from every start that was run."""
    findings: dict[str, Finding] = {start: statement.judge(runs, start) for start in runs.starts}
    verdicts = {agrees for _, agrees in findings.values() if agrees is not None}
    verdict: Literal["agrees", "disagrees", "depends on the start", "open"] = "open"
    if verdicts:
        verdict = "depends on the start" if len(verdicts) == 2 else ("agrees" if verdicts == {True} else "disagrees")
    unsettled = {
        start: tuple(run.point.name for c in statement.conditions for run in runs.of(c, start) if not run.settled)
        for start in runs.starts
    }
    return Judged(statement, findings, {start: names for start, names in unsettled.items() if names}, verdict)


def judge_inputs(every: Runs, inputs: Inputs) -> list[Judged]:
    """Judge every statement with some inputs, from equal spacing; that on the spacing from random spacing, where it begins."""
    unequal = FIGURES["18"][0]
    runs = every.within(inputs)
    chosen = [run for run in runs.all if run.point.start == "equal" or _begins(run.point, unequal)]
    return judge_all(Runs(chosen) if "equal" in runs.starts else runs)


def _begins(point: Point, condition: Condition) -> bool:
    return point.start == "unequal" and point.condition == condition


def by_inputs(sets: Mapping[Inputs, Sequence[Judged]]) -> str:
    """Verdicts by the inputs that the paper leaves open: a table with a column for each, and how many agree."""
    words = {"agrees": "yes", "disagrees": "**no**", "depends on the start": "by start", "open": "–"}
    order = sorted(sets, key=lambda inputs: (inputs.scatter, inputs.direction_deg))
    heads = [inputs.name + (" (named)" if inputs == NAMED else "") for inputs in order]
    lines = [f"| Fig. | statement | {' | '.join(heads)} |", "| --- | --- |" + " --- |" * len(heads)]
    for found in zip(*(sets[inputs] for inputs in order), strict=True):
        axial = not any(condition.radial_load for condition in found[0].statement.conditions)
        cells = [
            words[entry.verdict] if not axial or inputs.direction_deg == first_with(order, inputs) else "same"
            for inputs, entry in zip(order, found, strict=True)
        ]
        lines.append(f"| {found[0].statement.figure} | {found[0].statement.text} | {' | '.join(cells)} |")
    counts = [
        f"{sum(e.verdict == 'agrees' for e in sets[i])} of {sum(e.verdict != 'open' for e in sets[i])}" for i in order
    ]
    return "\n".join([*lines, f"| | agree, of those judged | {' | '.join(counts)} |"]) + "\n"


def first_with(order: Sequence[Inputs], inputs: Inputs) -> float:
    """The direction of the first of the inputs with this scatter: under axial load alone the others repeat it."""
    return next(one.direction_deg for one in order if one.scatter == inputs.scatter)


def markdown(judged: Sequence[Judged], early: Sequence[Judged] = ()) -> str:
    """The table of statements.

    Parameters
    ----------
    judged : sequence of Judged
        By the settled runs.
    early : sequence of Judged
        By runs whose statistics end after a second, as the paper's did; they have columns of their own.
    """
    names = ["Fig.", "statement of the paper", "verdict", "start", "what we find", "agrees"]
    names += ["from 0.5 to 1 s", "agrees then"] if early else []
    lines = [f"| {' | '.join(names)} |", "|" + " --- |" * len(names)]
    words = {True: "yes", False: "no", None: "–"}
    then = {entry.statement.key: entry.findings for entry in early}
    for entry in judged:
        mark = STAR if entry.unsettled else ""
        head = f"| {entry.statement.figure} | {entry.statement.text} | **{entry.verdict}**{mark} "
        for start, (text, agrees) in (entry.findings or {"–": NOT_RUN}).items():
            row = f"{head}| {start}{STAR if start in entry.unsettled else ''} | {text} | {words[agrees]} |"
            if early:
                said, so = then.get(entry.statement.key, {}).get(start, ("–", None))
                row += f" {said} | {words[so]} |"
            lines.append(row)
            head = "| | | "
    if any(entry.unsettled for entry in judged):
        lines += ["", f"{STAR} with points that had not settled when their statistics began."]
    return "\n".join(lines) + "\n"
