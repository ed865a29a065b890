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
from trbdyn.model.assembly import Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.ratings import rating_iso281
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.options import RunOptions
from trbdyn.run.replay import Replay
from trbdyn.standards.iso281 import SMALLEST_LOAD_SHARE
from trbdyn.study.answer import Answer
from trbdyn.study.definition import Case
from trbdyn.study.points import DIMS, Points
from trbdyn.study.runner import Running
from trbdyn.study.settled import TURNS, run_until_settled, variables

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

USUAL_SLIP: Final = 0.1
"""Slip of the cage up to which rollers are taken to roll; assumed."""
RECORDS: Final = 120
"""Records of a run."""
EVALUATED: Final = 24
"""Records of the last half of a run whose contacts are evaluated again."""
LOADED: Final = 0.05
"""Load of a roller over the heaviest of its record from which on it is in the load zone."""
STEADY: Final = 0.01
"""Change of a slip from the third to the last quarter of a run up to which it has settled (1)."""
NUMBERS: Final = {
    "cage_slip": ("slip of the roller set, mean", "1"),
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
        cage_slip, loaded_slip, unloaded_slip (1), of several bearings those of the one whose set of rollers slips most,
        entry_power (W/m2), settled, turns, message; and least (N) over temperature and speed.
    slip : float
        Slip of the cage up to which rollers are taken to roll (1).
    by_rule : float
        0.02 C, the rule of catalogues for roller bearings (N); of several bearings the largest.
    """

    data: xarray.Dataset
    slip: float
    by_rule: float

    def _draw(self) -> Any:
        from trbdyn.plot.slip import draw_least_load

        return draw_least_load(self)

    def _shown(self) -> Shown:
        rows, least = [], []
        data = self.data
        for t, temperature in enumerate(data["temperature_c"].values):
            for s, speed in enumerate(data["speed_rpm"].values):
                line = data.isel(temperature_c=t, speed_rpm=s)
                found = float(line["least"])
                words = f"{found:.3g}" if math.isfinite(found) else "above all loads" if found > 0.0 else "not known"
                if found == float(line["size"].min()):
                    words = f"at most {found:.3g}"
                least.append((f"{temperature:g}", f"{speed:g}", words))
                for k in range(data.sizes["load"]):
                    at = line.isel(load=k)
                    slips = [f"{100.0 * float(at[name]):.3g}" for name in ("cage_slip", "loaded_slip", "unloaded_slip")]
                    state = str(at["message"].values) or ("yes" if bool(at["settled"]) else "no")
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
        head = ("oil C", "rpm", "load N", "cage slip %", "loaded %", "unloaded %", "entry W/mm2", "settled")
        note = (
            f"Rollers are taken to roll where the cage slips by {100.0 * self.slip:g} % at most, assumed; by the rule of "
            f"catalogues, 0.02 C, the least load is {self.by_rule:.4g} N. Which power per area smears depends on oil and finish; "
            "no limit is assumed."
        )
        if not bool(data["settled"].all()):
            note += " Where a run has not settled its slip may still grow."
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

    Every point is a run of its own, of 2 turns of the shaft; where the slip of the cage still changes by more than 1 % from the
    third to the last quarter, it is run again over 8, and then over 32.

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

    def case(point: int, turns: float) -> Case:
        base, error = points.bases[point]
        save_every = 60.0 / abs(points.speed_at[point]) * turns / RECORDS
        own = run.replace(revolutions=turns, duration=None, save_every=save_every)
        return Case({"point": point}, None if base is None else base.build({})[0], own, error)

    def judged(found: xarray.Dataset) -> dict[str, Any]:
        row = {name: float(found[name]) for name in observed}
        return {**row, "settled": row["moves"] <= STEADY}

    observed = {name: partial(number_of_worst, name) for name in (*NUMBERS, "moves")}
    unknown = dict.fromkeys(observed, math.nan)
    rows = run_until_settled(range(len(points)), TURNS, case, judged, observed, how, unknown)
    found = _gathered(points, [rows[point] for point in range(len(points))], slip)
    return LeastLoad(found, float(slip), max(map(_rule, points.bearings)))


def number_of_worst(name: str, result: Result | AssemblyResult) -> float:
    """A number of a result, of several bearings that of the one whose rollers slip most."""
    worst = max(result.parts, key=lambda part: float(_half(part)["cage_slip"].mean()))
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
    quarter = len(half["cage_slip"]) // 2
    moves = abs(half["cage_slip"][quarter:].mean() - half["cage_slip"][:quarter].mean())
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
        "moves": float(moves),
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
    where a slip is not known.
    """
    order = np.argsort(sizes)
    load, slip = sizes[order], slips[order]
    if np.isnan(slip).any():
        return math.nan
    over = np.flatnonzero(slip > limit)
    if over.size == 0:
        return float(load[0])
    last = int(over[-1])
    if last == load.size - 1:
        return math.inf
    share = (slip[last] - limit) / (slip[last] - slip[last + 1])
    return float(load[last] * (load[last + 1] / load[last]) ** share)


def _gathered(points: Points, rows: Sequence[Mapping[str, Any]], slip: float) -> xarray.Dataset:
    import xarray

    made = variables(rows, NUMBERS | dict.fromkeys(("settled", "turns", "message"), ("", "")), DIMS, points.shape)
    sizes = np.hypot(*np.array(points.loads, dtype=float).T)
    slips, settled = made["cage_slip"][1], made["settled"][1].astype(bool)
    known = np.where(settled | (slips > slip), slips, np.nan)  # a slip that still grows may pass the limit
    least = [[least_of(sizes, line, slip) for line in lines] for lines in known]
    made["least"] = (DIMS[:2], np.array(least), {"long_name": "least load for rollers to roll", "units": "N"})
    parts: list[Any] = [*points.subject.parts.values()]
    made["drag"] = ((), all(part.effects.oil_fill > 0.0 for part in parts))
    places = points.coordinates | {"size": ("load", sizes, {"long_name": "load", "units": "N"})}
    return xarray.Dataset(made, places, points.about)
