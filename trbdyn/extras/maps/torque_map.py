"""Friction torque over speed, load and temperature of the oil: many short runs, each repeated longer until its torque stands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Unpack

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.shown import Shown
from trbdyn.base.validation import number_of, whole_number_of
from trbdyn.errors import InputError
from trbdyn.extras.maps.points import DIMS, Points
from trbdyn.extras.study.answer import Answer
from trbdyn.extras.study.bands import Band, open_inputs
from trbdyn.extras.study.definition import Case
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.settled import JUDGED, TURNS, run_until_settled, short_run, variables
from trbdyn.extras.study.uncertainty import FEWEST, band_of, checked_bands, drawn_case, unit_draws
from trbdyn.model.assembly import Subject
from trbdyn.model.bearing import Bearing
from trbdyn.results.fields import table
from trbdyn.results.rows.losses import BETWEEN, NOT_LOST
from trbdyn.run.options import RunOptions
from trbdyn.run.torque_laws import torque_laws

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

_USUAL: Final = (
    "rolling",
    "rib",
    "traction",
    "pocket",
    "drag",
    "land",
    "front_rib",
    "damping",
    "support",
    "vibration",
)
_LOSSES: Final = tuple(field.name.removeprefix("loss_") for field in table() if field.name.startswith("loss_"))
SOURCES: Final = (*_USUAL, *(name for name in _LOSSES if not name.startswith(_USUAL)))
"""Names of the shares of a torque. What a run calls rolling_pressure belongs to rolling, both raceways make traction, film and
contact of a land are one."""
NUMBERS: Final = {
    "torque": ("friction torque of the shaft", "N m"),
    "drift": ("change of the torque that may still come", "1"),
    "stored": ("share of the power that was not lost", "1"),
    "turns": ("", "1"),
    "film_parameter_inner": ("", "1"),
    "film_parameter_rib": ("", "1"),
}


@dataclass(frozen=True, repr=False)
class TorqueMap(Answer):
    """Torques by temperature, speed and load; print it for a table.

    Its picture shows torque over speed, a line for each load or temperature, and its sources; `temperature` is the place of the
    one temperature to draw, all by default.

    Attributes
    ----------
    data : xarray.Dataset
        Dimensions temperature_c, speed_rpm and load, the latter with the coordinates axial_load and radial_load, and source.
        Variables: torque, share (torque of each source), film_parameter_inner and film_parameter_rib, settled, drift,
        stored, turns, message; with bands torque_low and torque_high. Where there is rolling resistance torque_laws_low and
        torque_laws_high: the torque, or its band, with the other laws that can be defended
        (`trbdyn.run.torque_laws.torque_laws`); how far measured torques were off is in the attribute torque_record.
    tolerance : float
        Change of the torque that was allowed (1).
    """

    data: xarray.Dataset
    tolerance: float

    @property
    def settled(self) -> bool:
        """Whether every torque has settled."""
        return bool(self.data["settled"].all())

    def lowest(self, *, load: int = 0, temperature: int = 0) -> tuple[float, float]:
        """Speed (rpm) at which the torque is smallest, and that torque (N m), of the settled points of a load.

        Parameters
        ----------
        load, temperature : int
            Places in the map.

        Raises
        ------
        InputError
            If no point of this load has settled.
        """
        line = self.data.isel(load=load, temperature_c=temperature)
        torque = np.where(line["settled"], line["torque"], np.inf)
        if not np.isfinite(torque).any():
            raise InputError.of("load", load, "has no point whose torque has settled")
        place = int(np.argmin(torque))
        return float(line["speed_rpm"][place]), float(torque[place])

    def _draw(self, temperature: int | None = None) -> Any:
        from trbdyn.extras.maps.torque_picture import draw_map

        return draw_map(self.data, temperature)

    def _shown(self) -> Shown:
        data = self.data
        rows = []
        banded, by_law = "torque_low" in data, "torque_laws_low" in data
        for t, temperature in enumerate(data["temperature_c"].values):
            for k in range(data.sizes["load"]):
                for s, speed in enumerate(data["speed_rpm"].values):
                    at = data.isel(temperature_c=t, load=k, speed_rpm=s)
                    value = float(at["torque"])
                    largest = sorted(
                        ((float(at["share"].sel(source=name)), name) for name in SOURCES), key=lambda entry: -entry[0]
                    )
                    causes = ", ".join(
                        f"{name.replace('_', ' ')} {100.0 * share / value:.0f} %"
                        for share, name in largest[:3]
                        if value and share > 0.005 * value
                    )
                    row = [f"{temperature:g}", _load_words(at), f"{speed:g}", f"{value:.4g}"]
                    if banded:
                        held = 100.0 * float(at["torque_held"])
                        row.append(f"{float(at['torque_low']):.4g} to {float(at['torque_high']):.4g} ({held:.0f} %)")
                    if by_law:
                        row.append(f"{float(at['torque_laws_low']):.3g} to {float(at['torque_laws_high']):.3g}")
                    rows.append((*row, causes, _state(at)))
        head = ["oil (C)", "load (N)", "speed (rpm)", "torque (N m)"]
        head += ["band (share that it holds)"] if banded else []
        head += ["with other laws"] if by_law else []
        open_points = int((~data["settled"]).sum())
        notes = [f"{open_points} points without a settled torque: see the last column"] if open_points else []
        notes += [data.attrs["torque_record"]] if data.attrs.get("torque_record") else []
        return Shown("Friction torque of the shaft", tuple(rows), (*head, "sources", "settled"), tuple(notes))


def _load_words(at: xarray.Dataset) -> str:
    radial = float(at["radial_load"])
    return f"{float(at['axial_load']):g}" + (f", radial {radial:g}" if radial else "")


def _state(at: xarray.Dataset) -> str:
    if bool(at["settled"]):
        return "yes"
    message = str(at["message"].values)
    return (
        message or f"no: it may still change by {100.0 * float(at['drift']):.2g} % after {float(at['turns']):g} turns"
    )


def torque_map(
    subject: Bearing | Subject,
    speeds: Sequence[float],
    loads: Sequence[float | tuple[float, float]],
    *,
    temperatures: Sequence[float] | None = None,
    tolerance: float = 0.01,
    bands: bool | Mapping[str, tuple[float, float]] | Sequence[Band] = False,
    samples: int = 16,
    seed: int = 0,
    options: RunOptions | None = None,
    **how: Unpack[Running],
) -> TorqueMap:
    """Friction torque of the shaft over speed, load and temperature of the oil, split by what loses it.

    Every point is a run of its own. It lasts 2 turns of the shaft; where its torque does not stand, it is run again over 8, and
    then over 32. A torque stands where what it has still to go, as the means of the last three quarters of the run tell, is no
    more than `tolerance`, and where no more than this share of the shaft's power went into anything but losses over the last
    half. A point whose torque does not stand after that keeps its number, is marked as not settled, and says why.

    Parameters
    ----------
    subject : Bearing, Scene or Assembly
        A bearing takes the default oil and effects; a scene or an assembly gives all but speed and loads.
    speeds : sequence of float
        Speeds of the shaft (rpm), none of them 0.
    loads : sequence of float or tuple
        Axial loads (N), or pairs of axial and radial load. On an assembly they act on the shaft's centre of mass, in place of its
        loads: along the shaft, and across it downwards (towards -y).
    temperatures : sequence of float, optional
        Temperatures of the oil (C); that of the scene by default.
    tolerance : float
        Change that may still come, and share of the power that is not lost, up to which a torque has settled (1).
    bands : bool, mapping of str to tuple, or sequence of Band
        Draw inputs that nobody knows exactly, as `trbdyn.uncertainty` does, and tell the band of the torques of
        each point lie: those of `trbdyn.study.open_inputs` if true, or bands of your own.
    samples : int
        Draws of each point, at least 8.
    seed : int
        Seed of the draws.
    options : RunOptions, optional
        Accuracy and settings of each run, not its length; 'fast' by default.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`.

    Returns
    -------
    TorqueMap
        Print it for a table; `TorqueMap.picture` draws it.

    Raises
    ------
    InputError
        If an argument cannot be used, or no point at all can be built.

    Examples
    --------
    >>> import trbdyn as trb
    >>> found = trb.torque_map(trb.cases.rig_30310(), speeds=[500.0, 3000.0], loads=[1230.0, (4930.0, 2780.0)])
    >>> found.settled
    True
    >>> found.lowest(load=1)[0]
    500.0
    """
    run = RunOptions(accuracy="fast") if options is None else options
    points = Points(subject, speeds, loads, temperatures)
    if not 0.0 < number_of("tolerance", tolerance) < 1.0:
        raise InputError.of("tolerance", tolerance, "must be above 0 and below 1")
    drawn = () if bands is False else checked_bands(open_inputs(points.subject) if bands is True else bands)
    count, seed = whole_number_of("samples", samples, FEWEST), whole_number_of("seed", seed, 0)
    unit = unit_draws(len(drawn), count, seed) if drawn else np.empty((0, 0))

    def case(point: tuple[int, int], turns: float) -> Case:
        place, draw = point
        (base, error), parameters = points.bases[place], {"point": place, "draw": draw}
        if base is None:
            return Case(parameters, None, run, error)
        own = short_run(run, points.speed_at[place], turns)
        if draw == 0:
            return Case(parameters, base.build({})[0], own)
        found = drawn_case(base, own, drawn, unit[draw - 1], draw)
        return Case(parameters, found.scene, own, found.error)

    def judged(found: xarray.Dataset) -> dict[str, Any]:
        row: dict[str, Any] = {name: float(found[name]) if name in found else np.nan for name in NUMBERS}
        return {**row, "share": _shares(found), "settled": max(row["drift"], row["stored"]) <= tolerance}

    unknown = dict.fromkeys(NUMBERS, np.nan) | {"share": np.full(len(SOURCES), np.nan)}
    each = [(place, draw) for place in range(len(points)) for draw in range(1 + len(unit))]
    rows = run_until_settled(each, TURNS, case, judged, JUDGED, how, unknown)
    return TorqueMap(_gathered(points, rows, len(unit)), float(tolerance))


def _shares(found: xarray.Dataset) -> Array:
    sums = dict.fromkeys(SOURCES, 0.0)
    for name, value in found.data_vars.items():
        part = str(name).removeprefix("torque_by_loss_")
        # what is stored, or lies between records, is no loss of a contact
        if part == name or part in (NOT_LOST, BETWEEN):
            continue
        kind = next(kind for kind in SOURCES if part.startswith(kind))
        sums[kind] += float(np.nan_to_num(value))
    return np.array([sums[name] for name in SOURCES])


def _gathered(points: Points, rows: Mapping[tuple[int, int], Mapping[str, Any]], draws: int) -> xarray.Dataset:
    import xarray

    first, shape = [rows[place, 0] for place in range(len(points))], points.shape
    made = variables(first, NUMBERS | dict.fromkeys(("settled", "message"), ("", "")), DIMS, shape)
    about = {"share": ("torque by what loses it", "N m")}
    made |= variables(first, about, (*DIMS, "source"), (*shape, len(SOURCES)))

    def torques(name: str, values: Any, unit: str = "N m") -> None:
        made[name] = (DIMS, np.array(values).reshape(shape), {"units": unit})

    ends = [(row["torque"], row["torque"]) for row in first]
    if draws:
        bands = [(np.nan, np.nan, np.nan)] * len(points)
        for place in range(len(points)):
            settled = [rows[place, d]["torque"] for d in range(1, draws + 1) if rows[place, d]["settled"]]
            if len(settled) >= FEWEST:
                bands[place] = band_of(settled)
        ends = [(low, high) for low, high, _ in bands]
        torques("torque_low", [low for low, _ in ends])
        torques("torque_high", [high for _, high in ends])
        torques("torque_held", [held for *_, held in bands], "1")
    laws = [torque_laws(base.build({})[0]) if base is not None else None for base, _ in points.bases]
    if any(one is not None for one in laws):
        wide = [(np.nan, np.nan) if one is None else one.band(*pair) for one, pair in zip(laws, ends, strict=True)]
        torques("torque_laws_low", [low for low, _ in wide])
        torques("torque_laws_high", [high for _, high in wide])
    record = next((one.record for one in laws if one is not None and one.record), "")
    places = points.coordinates | {"source": ("source", list(SOURCES))}
    return xarray.Dataset(made, places, points.about | {"torque_record": record})
