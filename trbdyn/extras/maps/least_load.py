"""`trbdyn.least_load`: slip of cage and rollers over load, speed and temperature of the oil, the frictional power per area of
rollers that enter the load zone, and the load from which on they roll (docs/theory/whirl.md#slip-and-least-load).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Unpack

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.shown import Shown
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.extras.maps.points import DIMS, Points
from trbdyn.extras.study.answer import Answer
from trbdyn.extras.study.definition import Case
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.settled import TURNS, run_until_settled, variables
from trbdyn.model.assembly import Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.ratings import rating_iso281
from trbdyn.model.start import Start
from trbdyn.results import observables
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.options import RunOptions
from trbdyn.run.replay import Replay
from trbdyn.standards.iso281 import SMALLEST_LOAD_SHARE

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

SIDES: Final = {"above": 1.0, "below": -1.0, "unknown": 0.0}
USUAL_SLIP: Final = 0.1
"""Slip of the cage up to which rollers are taken to roll; assumed."""
RECORDS: Final = 120
"""Records of a run."""
EVALUATED: Final = 24
"""Records of the last half of a run whose contacts are evaluated again."""
LOADED: Final = 0.05
"""Load of a roller over the heaviest of its record from which on it is in the load zone."""
STANDING: Final = 0.9
"""Slip with which the second run of a point starts: nearly at a standstill (1)."""
AGREE: Final = (0.01, 0.1)
"""Difference of the slips from both starts up to which the slip has settled: in itself, and over their mean (1)."""
ROLLS: Final = "rolls"
SLIPS: Final = "slips"
EITHER: Final = "rolls or slips, as it starts"
OPEN: Final = "not known"
NUMBERS: Final = {
    "cage_slip": ("slip of the roller set, mean, from rolling", "1"),
    "loaded_slip": ("slip of the rollers' spin in the load zone, mean", "1"),
    "unloaded_slip": ("slip of the rollers' spin outside of the load zone, mean", "1"),
    "entry_power": ("frictional power per area of contact, largest of rollers that enter the load zone", "W/m2"),
}


@dataclass(frozen=True, repr=False)
class LeastLoad(Answer):
    """Slip over load, speed and temperature; print it for a table.

    Its picture shows slip and power per area over the load, a line for each speed and temperature.

    Attributes
    ----------
    data : xarray.Dataset
        Dimensions temperature_c, speed_rpm and load, the latter with the coordinates axial_load and radial_load. Variables:
        cage_slip, loaded_slip, unloaded_slip (1) of the run that starts in rolling, of several bearings those of the one whose
        set of rollers slips most, entry_power (W/m2), slip_from_standing, the slip of the set in the run that starts with nearly
        standing rollers (1), verdict (text: rolls, slips, "rolls or slips, as it starts", not known), settled (whether both slips
        agree), turns, message; and least (N) over temperature and speed.
    slip : float
        Slip of the cage up to which rollers are taken to roll (1).
    by_rule : float
        0.02 C, the rule of catalogues for roller bearings (N); of several bearings the largest.
    """

    data: xarray.Dataset
    slip: float
    by_rule: float

    def _draw(self) -> Any:
        from trbdyn.extras.maps.slip_picture import draw_least_load

        return draw_least_load(self)

    def _shown(self) -> Shown:
        rows, least = [], []
        data = self.data
        for t, temperature in enumerate(data["temperature_c"].values):
            for s, speed in enumerate(data["speed_rpm"].values):
                line = data.isel(temperature_c=t, speed_rpm=s)
                found = float(line["least"])
                words = (
                    f"{found:.3g}" if math.isfinite(found) else "above all loads" if found > 0.0 else _not_known(line)
                )
                if found == float(line["size"].min()):
                    words = f"at most {found:.3g}"
                least.append((f"{temperature:g}", f"{speed:g}", words))
                for k in range(data.sizes["load"]):
                    at = line.isel(load=k)
                    names = ("cage_slip", "slip_from_standing", "loaded_slip", "unloaded_slip")
                    slips = [f"{100.0 * float(at[name]):.3g}" for name in names]
                    state = str(at["message"].values) or str(at["verdict"].values)
                    radial = float(at["radial_load"])
                    load = f"{float(at['axial_load']):g}" + (f", radial {radial:g}" if radial else "")
                    rows.append(
                        (
                            f"{temperature:g}",
                            f"{speed:g}",
                            load,
                            *slips,
                            f"{1e-6 * float(at['entry_power']):.3g}",
                            state,
                        )
                    )
        head = (
            "oil C",
            "rpm",
            "load N",
            "cage slip %",
            "from standing %",
            "loaded %",
            "unloaded %",
            "entry W/mm2",
            "verdict",
        )
        note = (
            f"Rollers are taken to roll where the cage slips by {100.0 * self.slip:g} % at most, assumed; by the rule of "
            f"catalogues, 0.02 C, the least load is {self.by_rule:.4g} N. Which power per area smears depends on oil and finish; "
            "no limit is assumed."
        )
        if not bool(data["settled"].all()):
            note += (
                " Where the slips from rolling and from nearly standing rollers differ, that of a long run is expected between "
                "them; the verdict is that of both runs beside the limit."
            )
        if not bool(data["drag"]):
            note += " Drag of the oil on rollers and cage is off (effects.oil_fill), so that slip is underestimated."
        table = Shown("Least load, from which on rollers roll", tuple(least), ("oil C", "rpm", "least load N"))
        return Shown("Slip over load", tuple(rows), head, (note,), (table,))


def least_load(
    subject: Bearing | Subject,
    speeds: Sequence[float],
    loads: Sequence[float | tuple[float, float]],
    *,
    temperatures: Sequence[float] | None = None,
    slip: float = USUAL_SLIP,
    options: RunOptions | None = None,
    **how: Unpack[Running],
) -> LeastLoad:
    """Slip of cage and rollers over load, speed and temperature of the oil, and the least load for them to roll.

    Every point is run from both sides: from pure rolling, and from rollers and a cage that nearly stand. It slips where the slip
    from rolling is above the limit and does not fall back; it rolls where the slip from standing is below the limit and does not
    rise again, by the rates of both with their errors. Where neither holds after 2 turns of the shaft it is run again over 8, and
    then over 32; then it is not known, or either is possible where both have stopped to change.

    Parameters
    ----------
    subject : Bearing, Scene or Assembly
        A bearing takes the default oil and effects; a scene or an assembly gives all but speed and loads. What slows rollers down
        outside of the load zone is mostly the drag of the oil, which is an effect: `Effects.oil_fill`.
    speeds : sequence of float
        Speeds of the shaft (rpm), none of them 0.
    loads : sequence of float or tuple
        Axial loads (N), or pairs of axial and radial load, as for `trbdyn.torque_map`.
    temperatures : sequence of float, optional
        Temperatures of the oil (C), which give its viscosity; that of the scene by default.
    slip : float
        Slip of the cage up to which rollers are taken to roll (1).
    options : RunOptions, optional
        Accuracy and settings of each run, not its length; 'fast' by default.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`.

    Returns
    -------
    LeastLoad
        Prints as a table; `LeastLoad.picture` draws it.

    Raises
    ------
    InputError
        If an argument cannot be used, or no point at all can be built.

    Notes
    -----
    Sources: the power per area that friction makes in a contact as the measure of smearing: Matveevsky 1992, Wear 155, 1; Evans,
    Barr, Houpert and Boyd 2013, Tribology Transactions 56, 703. 0.02 C: SKF, requisite minimum load.
    docs/theory/whirl.md#slip-and-least-load.

    Examples
    --------
    >>> import trbdyn as trb
    >>> found = trb.least_load(trb.cases.scene_nj210(), [3000.0], [(100.0, 100.0), (100.0, 3000.0)])
    >>> bool(found.data["cage_slip"][0, 0, 1] < 0.01)
    True
    """
    run = RunOptions(accuracy="fast") if options is None else options
    points = Points(subject, speeds, loads, temperatures)
    if not 0.0 < number_of("slip", slip) < 1.0:
        raise InputError.of("slip", slip, "must be above 0 and below 1")

    def case(run_of: tuple[int, float], turns: float) -> Case:
        point, start = run_of
        base, error = points.bases[point]
        save_every = 60.0 / abs(points.speed_at[point]) * turns / RECORDS
        own = run.replace(revolutions=turns, duration=None, save_every=save_every)
        subject = None if base is None else base.build({})[0]
        if subject is not None and start:
            for prefix, part in subject.parts.items():
                first = Start.equal() if part.start.kind == "state" else part.start
                subject = subject.with_part(prefix, start=first.replace(slip=start, time=part.start.time))
        return Case({"point": point} | ({"slip": start} if start else {}), subject, own, error)

    def judged(found: xarray.Dataset) -> dict[str, Any]:
        return {name: float(found[name]) for name in observed} | {"settled": True}

    observed = {name: partial(number_of_worst, name) for name in NUMBERS}
    observed["side"] = partial(number_of_worst, "side", limit=slip)
    observed["steady"] = partial(number_of_worst, "steady", limit=slip)
    unknown = dict.fromkeys(observed, math.nan)
    rows: dict[int, dict[str, Any]] = {}
    waiting = list(range(len(points)))
    for turns in TURNS:
        both = [(point, start) for point in waiting for start in (0.0, STANDING)]
        found = run_until_settled(both, (turns,), case, judged, observed, how, unknown)
        for point in waiting:
            rows[point] = _judged(found[point, 0.0], found[point, STANDING])
        waiting = [point for point in waiting if rows[point]["verdict"] == OPEN and not rows[point]["message"]]
    data = _gathered(points, [rows[point] for point in range(len(points))], slip)
    return LeastLoad(data, float(slip), max(map(_rule, points.bearings)))


def _judged(rolling: Mapping[str, Any], standing: Mapping[str, Any]) -> dict[str, Any]:
    """The row of a point from its runs from rolling and from standing."""
    message = rolling["message"] or standing["message"]
    low, high = rolling["cage_slip"], standing["cage_slip"]
    slips, rolls = rolling["side"] > 0.0, standing["side"] < 0.0
    verdict = OPEN
    if slips != rolls:
        verdict = SLIPS if slips else ROLLS
    elif rolling["side"] < 0.0 < standing["side"] and rolling["steady"] and standing["steady"]:
        verdict = EITHER
    # where each has passed the limit towards the other, both come to one slip near it, whose side longer runs tell
    near = abs(high - low) <= max(AGREE[0], AGREE[1] * 0.5 * (low + high))
    found = {name: rolling[name] for name in NUMBERS} | {"slip_from_standing": high, "verdict": verdict}
    return {**found, "settled": bool(near) and not message, "turns": rolling["turns"], "message": message}


def _not_known(line: xarray.Dataset) -> str:
    """What is said of a least load that is not known: below which load it lies, where all heavier ones roll."""
    order = np.argsort(line["size"].values)
    rolls = line["verdict"].values[order] == ROLLS
    heavier = np.flatnonzero(~rolls)[-1] + 1
    return "not known" if heavier == rolls.size else f"not known, at most {line['size'].values[order][heavier]:.3g}"


def number_of_worst(name: str, result: Result | AssemblyResult, limit: float = USUAL_SLIP) -> float:
    """A number of a result, of several bearings that of the one whose rollers slip most; ``side``: 1 where its slip stays above
    the limit, -1 where it stays below, else 0; ``steady``: whether its rate does not stand out of its scatter.
    """
    worst = max(result.parts, key=lambda part: float(_half(part)["cage_slip"].mean()))
    if name == "side":
        return SIDES[observables.side_of(limit, worst["time"], worst.cage_slip)]
    if name == "steady":
        half = len(worst) // 2
        return float(not observables.drift(worst["time"][half:], worst.cage_slip[half:]).significant)
    return numbers_of(worst)[name]


def _half(result: Result) -> dict[str, Array]:
    half = slice(len(result) // 2, None)
    return {
        "cage_slip": result.cage_slip[half],
        "spin_slip": result.spin_slip[half],
        "load": result["inner_load"][half],
    }


def numbers_of(result: Result) -> dict[str, float]:
    """Slips and power per area of the last half of a run of one bearing, with the groups cage, rollers and contacts; see
    `LeastLoad`.
    """
    half = _half(result)
    heaviest = half["load"].max(axis=1, keepdims=True)
    loaded = half["load"] > LOADED * heaviest
    replay, powers = Replay(result), []
    first = len(result) // 2
    for index in np.unique(np.linspace(first, len(result) - 1, EVALUATED).round().astype(int)).tolist():
        enters = entering(
            result["inner_load"][index],
            result["roller_orbit_angle"][index],
            float(result["roller_orbit_speed"][index].mean()),
        )
        if enters.any():
            powers.append(float(power_per_area(replay.contacts(index))[:, enters].max()))
    spin = half["spin_slip"]
    return {
        "cage_slip": float(half["cage_slip"].mean()),
        "loaded_slip": float(spin[loaded].mean()) if loaded.any() else math.nan,
        "unloaded_slip": float(spin[~loaded].mean()) if not loaded.all() else math.nan,
        "entry_power": max(powers, default=math.nan),
    }


def entering(loads: Array, angles: Array, orbit_speed: float) -> Array:
    """Which rollers are in the half of the load zone that they enter by; all of them where it has no beginning. From loads at
    the inner ring (N) and angles (rad) of the rollers, shape (Z,), and the speed at which they go round (rad/s).
    """
    zone = loads > LOADED * loads.max()
    if zone.all() or not zone.any():
        return zone
    held = np.where(zone, loads, 0.0)
    centre = math.atan2(float(np.sum(held * np.sin(angles))), float(np.sum(held * np.cos(angles))))
    ahead = np.remainder(angles - centre + math.pi, 2.0 * math.pi) - math.pi
    return zone & (ahead * math.copysign(1.0, orbit_speed) <= 1e-9)


def power_per_area(contacts: dict[str, Array]) -> Array:
    """Frictional power of sliding over the area of contact (W/m2), shape (2, Z), at the outer and the inner raceway, of contacts
    as `Simulation.contacts` gives them; 0 without contact.
    """
    load, speed = contacts["raceway_load"], np.abs(contacts["raceway_sliding_speed"])
    power = np.sum(np.abs(contacts["raceway_friction_coefficient"]) * load * speed, axis=-1)
    area = np.sum(2.0 * contacts["raceway_half_width"] * contacts["raceway_weight"] * (load > 0.0), axis=-1)
    return np.divide(power, area, out=np.zeros_like(power), where=area > 0.0)


def _rule(bearing: Bearing) -> float:
    """0.02 C (N)."""
    rating = bearing.ratings.dynamic or rating_iso281(
        n_rollers=bearing.n_rollers,
        roller_diameter=bearing.roller.diameter,
        roller_length=bearing.roller.effective_length,
        pitch_diameter=bearing.pitch_diameter,
        contact_angle_deg=bearing.cup_half_angle_deg,
    )
    return SMALLEST_LOAD_SHARE * rating


def least_of(sizes: Array, slips: Array, limit: float) -> float:
    """The load from which on slips (1) at some loads (N), both of shape (n,), stay within a limit (1), between loads along the
    logarithm of the load (N); infinite where the largest load still slips, the smallest load where none does, not a number
    where the slip of the heaviest load that may slip is not known.
    """
    order = np.argsort(sizes)
    load, slip = sizes[order], slips[order]
    over = np.flatnonzero(~(slip <= limit))
    if over.size == 0:
        return float(load[0])
    last = int(over[-1])
    if np.isnan(slip[last]):
        return math.nan
    if last == load.size - 1:
        return math.inf
    share = (slip[last] - limit) / (slip[last] - slip[last + 1])
    return float(load[last] * (load[last + 1] / load[last]) ** share)


def _gathered(points: Points, rows: Sequence[Mapping[str, Any]], slip: float) -> xarray.Dataset:
    import xarray

    about = NUMBERS | {"slip_from_standing": ("slip of the roller set, mean, from standing", "1")}
    made = variables(
        rows, about | dict.fromkeys(("verdict", "settled", "turns", "message"), ("", "")), DIMS, points.shape
    )
    sizes = np.hypot(*np.array(points.loads, dtype=float).T)
    low, high, verdict = (made[name][1] for name in ("cage_slip", "slip_from_standing", "verdict"))
    # where it slips the slip is that from rolling at least, where it rolls that from standing at most
    known = np.where(verdict == SLIPS, low, np.where(verdict == ROLLS, np.minimum(high, slip), np.nan))
    least = [[least_of(sizes, line, slip) for line in lines] for lines in known.astype(float)]
    made["least"] = (DIMS[:2], np.array(least), {"long_name": "least load for rollers to roll", "units": "N"})
    parts: list[Any] = [*points.subject.parts.values()]
    made["drag"] = ((), all(part.effects.oil_fill > 0.0 for part in parts))
    places = points.coordinates | {"size": ("load", sizes, {"long_name": "load", "units": "N"})}
    return xarray.Dataset(made, places, points.about)
