"""Friction torque over speed, load and temperature of the oil: many short runs, each repeated longer until its torque stands."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Unpack

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.scene import Scene
from trbdyn.results.fields import table
from trbdyn.run.options import RunOptions
from trbdyn.run.torque_laws import torque_laws
from trbdyn.study.answer import Answer
from trbdyn.study.definition import Base, Case
from trbdyn.study.runner import Running
from trbdyn.study.settled import JUDGED, TURNS, failure, run_until_settled, short_run
from trbdyn.study.uncertainty import FEWEST, Band, band_of, checked_bands, drawn_case, open_inputs, unit_draws

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
FILMS: Final = ("film_parameter_inner", "film_parameter_rib")


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
        from trbdyn.plot.torque import draw_map

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
    scene = subject_of(subject)
    run = RunOptions(accuracy="fast") if options is None else options
    places = places_of(scene, speeds, loads, temperatures)
    if not 0.0 < number_of("tolerance", tolerance) < 1.0:
        raise InputError.of("tolerance", tolerance, "must be above 0 and below 1")
    drawn = () if bands is False else checked_bands(open_inputs(scene) if bands is True else bands)
    for field, value, least in (("samples", samples, FEWEST), ("seed", seed, 0)):
        if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
            raise InputError.of(field, value, f"must be a whole number, at least {least}")
    unit = unit_draws(len(drawn), int(samples), int(seed)) if drawn else np.empty((0, 0))
    bases = [at_place(scene, place) for place in places]
    if not any(base for base, _ in bases):
        raise InputError.of("loads", loads, f"no point can be built; the first: {bases[0][1]}")
    rows = run_until_settled(
        [(p, d) for p in range(len(places)) for d in range(1 + len(unit))],
        TURNS,
        lambda point, turns: _case(bases[point[0]], drawn, unit, *point, places[point[0]][1], run, turns),
        lambda found, turns: _row(found, turns, tolerance),
        JUDGED,
        how,
    )
    return TorqueMap(_gathered(scene, places, bases, rows, len(unit)), float(tolerance))


def subject_of(subject: Bearing | Subject) -> Subject:
    if isinstance(subject, Bearing):
        return Scene(subject, speed_rpm=1000.0, axial_load=1000.0)
    expect("subject", subject, Scene, Assembly, Bearing)
    return subject


Place = tuple[float, float, tuple[float, float]]


def places_of(scene: Subject, speeds: Any, loads: Any, temperatures: Any) -> list[Place]:
    """(temperature, speed, (axial, radial)) of every point, the last changing fastest."""
    listed = {"speeds": speeds, "loads": loads}
    listed |= {} if temperatures is None else {"temperatures": temperatures}
    for field, values in listed.items():
        if isinstance(values, str) or not isinstance(values, Iterable) or not len(list(values)):
            raise InputError.of(field, values, "must be a sequence of at least one number")
    pairs = []
    for load in loads:
        pair = tuple(load) if isinstance(load, Sequence) and not isinstance(load, str) else (load, 0.0)
        if len(pair) != 2:
            raise InputError.of("loads", load, "must be an axial load, or a pair of axial and radial load (N)")
        pairs.append((number_of("loads", pair[0]), number_of("loads", pair[1])))
    turned = [number_of("speeds", speed) for speed in speeds]
    if not all(turned):
        raise InputError.of("speeds", speeds, "must not hold 0: a shaft that stands has no friction torque (rpm)")
    own = [_temperature(scene)] if temperatures is None else temperatures
    warm = [number_of("temperatures", temperature) for temperature in own]
    for field, found in (("speeds", turned), ("loads", pairs), ("temperatures", warm)):
        if len(set(found)) != len(found):
            raise InputError.of(field, listed.get(field), "must not hold a value twice")
    return [(t, n, load) for t in warm for n in turned for load in pairs]


def _temperature(subject: Subject) -> float:
    """Temperature of the oil (C), of several bearings that of the first one."""
    return subject.part.lubricant.temperature_c


def at_place(scene: Subject, place: Place) -> tuple[Base | None, str]:
    temperature, speed, (axial, radial) = place
    overrides = scene.loaded(speed, axial, radial)
    if temperature != _temperature(scene):
        overrides |= {f"{prefix}lubricant.temperature_c": temperature for prefix in scene.parts}
    try:
        return Base.of(Base.of(scene).build(overrides)[0]), ""
    except InputError as error:
        return None, str(error).splitlines()[0]


def _case(
    made: tuple[Base | None, str],
    bands: Sequence[Band],
    unit: Array,
    place: int,
    draw: int,
    speed: float,
    run: RunOptions,
    turns: float,
) -> Case:
    base, error = made
    parameters = {"point": place, "draw": draw}
    if base is None:
        return Case(parameters, None, run, error)
    own = short_run(run, speed, turns)
    if draw == 0:
        return Case(parameters, base.build({})[0], own)
    found = drawn_case(base, own, bands, unit[draw - 1], draw)
    return Case(parameters, found.scene, own, found.error)


def _row(found: xarray.Dataset, turns: float, tolerance: float) -> dict[str, Any]:
    """What is kept of a run."""
    message = failure(found)
    row: dict[str, Any] = {"turns": turns, "message": message}
    for name in ("torque", "drift", "stored", *FILMS):
        row[name] = float(found[name]) if not message and name in found else np.nan
    row["share"] = np.full(len(SOURCES), np.nan) if message else _shares(found)
    row["settled"] = not message and max(row["drift"], row["stored"]) <= tolerance
    return row


def _shares(found: xarray.Dataset) -> Array:
    sums = dict.fromkeys(SOURCES, 0.0)
    for name, value in found.data_vars.items():
        part = str(name).removeprefix("torque_by_loss_")
        if part == name:
            continue
        kind = next(kind for kind in SOURCES if part.startswith(kind))
        sums[kind] += float(np.nan_to_num(value))
    return np.array([sums[name] for name in SOURCES])


def _gathered(
    scene: Subject,
    places: Sequence[Place],
    bases: Sequence[tuple[Base | None, str]],
    rows: Mapping[tuple[int, int], Mapping[str, Any]],
    draws: int,
) -> xarray.Dataset:
    import xarray

    warm = list(dict.fromkeys(place[0] for place in places))
    speeds = list(dict.fromkeys(place[1] for place in places))
    loads = list(dict.fromkeys(place[2] for place in places))
    dims, shape = ("temperature_c", "speed_rpm", "load"), (len(warm), len(speeds), len(loads))
    first = [rows[p, 0] for p in range(len(places))]

    def column(name: str) -> Any:
        return np.array([row[name] for row in first]).reshape(shape)

    variables: dict[str, Any] = {
        "torque": (dims, column("torque"), {"long_name": "friction torque of the shaft", "units": "N m"}),
        "share": (
            (*dims, "source"),
            np.array([row["share"] for row in first]).reshape(*shape, len(SOURCES)),
            {"long_name": "torque by what loses it", "units": "N m"},
        ),
        "settled": (dims, column("settled")),
        "drift": (dims, column("drift"), {"long_name": "change of the torque that may still come", "units": "1"}),
        "stored": (dims, column("stored"), {"long_name": "share of the power that was not lost", "units": "1"}),
        "turns": (dims, column("turns"), {"units": "1"}),
        "message": (dims, np.array([row["message"] for row in first], dtype=object).reshape(shape)),
        **{name: (dims, column(name), {"units": "1"}) for name in FILMS},
    }
    if draws:
        low, high, held = (np.full(len(places), np.nan) for _ in range(3))
        for p in range(len(places)):
            torques = [rows[p, d]["torque"] for d in range(1, draws + 1) if rows[p, d]["settled"]]
            if len(torques) >= FEWEST:
                low[p], high[p], held[p] = band_of(torques)
        variables["torque_low"] = (dims, low.reshape(shape), {"units": "N m"})
        variables["torque_high"] = (dims, high.reshape(shape), {"units": "N m"})
        variables["torque_held"] = (dims, held.reshape(shape), {"units": "1"})
    found = [torque_laws(base.build({})[0]) if base is not None else None for base, _ in bases]
    if any(one is not None for one in found):
        plain = variables["torque"][1].ravel()
        ends = [variables[name][1].ravel() if draws else plain for name in ("torque_low", "torque_high")]
        wide = [
            (np.nan, np.nan) if one is None else one.band(low, high)
            for one, low, high in zip(found, *ends, strict=True)
        ]
        for k, name in enumerate(("torque_laws_low", "torque_laws_high")):
            variables[name] = (dims, np.array([pair[k] for pair in wide]).reshape(shape), {"units": "N m"})
    record = next((one.record for one in found if one is not None and one.record), "")
    coordinates = {
        "temperature_c": ("temperature_c", warm, {"units": "C"}),
        "speed_rpm": ("speed_rpm", speeds, {"units": "rpm"}),
        "axial_load": ("load", [load[0] for load in loads], {"units": "N"}),
        "radial_load": ("load", [load[1] for load in loads], {"units": "N"}),
        "source": ("source", list(SOURCES)),
    }
    return xarray.Dataset(
        variables,
        coords=coordinates,
        attrs={
            "bearing": ", ".join(part.bearing.name for part in scene.parts.values()),
            "torque_record": record,
        },
    )
