"""What a run will cost and how accurate it will be, before it is run: a short probe, and a table of measured errors."""

from __future__ import annotations

import json
import math
import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.base.shipped import DATA
from trbdyn.errors import InputError, StepError
from trbdyn.model.flatten import diameter_deviation
from trbdyn.model.motion import History, values_of
from trbdyn.run.keeping import interval

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation

TABLE: Final = DATA / "accuracy.json"
"""Errors over tolerances, written by ``python benchmarks/work_precision.py --make-table``."""

PROBE: Final = 50e-3
"""Bearing time of the probe (s): about a turn of the cage at 3000 rpm, with its quiet and its busy parts."""
PATIENCE: Final = 0.25
"""Wall time after which the probe ends early (s)."""
WARM_UP: Final = 5e-4
"""Bearing time before the probe (s): the integrator starts with tiny steps."""
_RECORDS: Final = 20
SAME: Final = 1e-6
"""Relative difference up to which tolerances count as those of a preset."""
LEAST_SCATTER: Final = 1e-7
"""Range of the rollers' diameters from which they count as unequal (m)."""


@dataclass(frozen=True)
class Estimate:
    """What a run is expected to take and give.

    Attributes
    ----------
    bearing_time : float
        Length of the run (s).
    wall_s : float
        Expected wall time (s), records included.
    real_time_factor : float
        Bearing time over wall time.
    steps, evaluations : int
        Expected steps of the integrator, and evaluations of all forces for them.
    records : int
        Records that are kept.
    memory_mb : float
        Size of the records (MB): in memory, or uncompressed in a file.
    error_cage_over_cpr : float
        Expected error of the cage's centre by the integration, over the radial play Cpr: median over collisions that were
        measured, each followed for `window` seconds. Beyond that a colliding cage is chaotic, and means are what counts.
        nan where nothing like it was measured.
    error_cage_over_cpr_worst : float
        The largest of them.
    error_load, error_cage_speed, error_power : float
        Expected relative errors of contact load (rms), cage speed and power loss within the window.
    bias_pocket_force, bias_contact_duty : float
        Expected bias of the mean pocket force, and of the share of time that pockets are touched, over a longer run: mean
        relative difference from runs with far smaller tolerances. nan where it was not measured: for tolerances that are not
        those of a preset.
    window : float
        Length of trajectories that the errors belong to (s), median.
    case : str
        Measured scene that the errors are taken from, the one most like this: 'collision', 'smooth', 'combined', 'light',
        'heavy', 'slow', 'fast' or 'scatter' (see benchmarks/README.md).
    extrapolated : bool
        Whether the tolerances lie outside those that were measured: the errors are then those at the end of the table.
    """

    bearing_time: float
    wall_s: float
    real_time_factor: float
    steps: int
    evaluations: int
    records: int
    memory_mb: float
    error_cage_over_cpr: float
    error_cage_over_cpr_worst: float
    error_load: float
    error_cage_speed: float
    error_power: float
    bias_pocket_force: float
    bias_contact_duty: float
    window: float
    case: str
    extrapolated: bool

    def __str__(self) -> str:
        lines = [
            f"{self.bearing_time:.4g} s of bearing time in about {self.wall_s:.3g} s "
            f"(real time x {self.real_time_factor:.3g}), {self.steps:,} steps",
            f"{self.records:,} records, {self.memory_mb:.3g} MB",
            f"cage centre within {100.0 * self.error_cage_over_cpr:.2g} % of Cpr over {1e3 * self.window:.2g} ms "
            f"(worst {100.0 * self.error_cage_over_cpr_worst:.2g} %), power loss within {100.0 * self.error_power:.2g} % "
            f"(scene '{self.case}')",
        ]
        if math.isfinite(self.bias_pocket_force):
            lines.append(
                f"bias of means over longer runs: pocket force {100.0 * self.bias_pocket_force:+.2g} %, "
                f"contact duty {100.0 * self.bias_contact_duty:+.2g} %"
            )
        return "\n".join(lines)


_BIASES: Final = {"bias_pocket_force": "bias_pocket_mean", "bias_contact_duty": "bias_duty"}
_ERRORS: Final = ("error_cage_over_cpr", "error_cage_over_cpr_worst", "error_load", "error_cage_speed", "error_power")


@cache
def table() -> dict[str, Any]:
    """The measured errors."""
    found: dict[str, Any] = json.loads(TABLE.read_text(encoding="utf-8"))
    return found


def estimate(
    sim: Simulation,
    *,
    revolutions: float | None = None,
    duration: float | None = None,
    save_every: float | None = None,
    probe: float = PROBE,
) -> Estimate:
    """Expected wall time and error of a run from the present state.

    The wall time is extrapolated from a probe of a copy, so it holds for as long as the bearing moves as it does now. Errors
    are those measured for the same tolerances on the shipped bearing: on another they are a guide.

    Parameters
    ----------
    sim : Simulation
        What would be run; it is left as it is.
    revolutions, duration : float, optional
        How far to go, in turns of the shaft or s; one of both must be given.
    save_every : float, optional
        Time between records (s); by default that of `Simulation.run`.
    probe : float
        Bearing time of the probe (s); not more than the run, and it ends early after `PATIENCE` seconds of wall time.

    Raises
    ------
    InputError
        If an argument cannot be used.
    StepError
        If the probe fails.
    """
    if not probe > 0.0:
        raise InputError.of("probe", probe, "must be > 0 (s)")
    changes = {"revolutions": revolutions, "duration": duration}
    options = sim.options.replace(**changes if save_every is None else {**changes, "save_every": save_every})
    start = sim.time
    length = options.end_time(sim.scene.speed_rpm, start) - start
    save_every = interval(length, sim.scene.speed_rpm) if save_every is None else save_every
    rates = _probe(sim, min(probe, length))
    records = max(math.ceil(length / save_every - 1e-9), 1) + 1
    wall = length * rates["wall"] + records * rates["record"]
    found = _errors(sim)
    return Estimate(
        bearing_time=length,
        wall_s=wall,
        real_time_factor=length / wall,
        steps=round(length * rates["steps"]),
        evaluations=round(length * rates["rhs_evaluations"]),
        records=records,
        memory_mb=8e-6 * records * (sim._model.record_length + sim._model.peak_length),
        **found,
    )


def _probe(sim: Simulation, length: float) -> dict[str, float]:
    """Wall time, steps and evaluations per second of bearing time, and the wall time of a record."""
    other = sim.copy()
    try:
        _advance(other, min(WARM_UP, 0.25 * length))
        before, began, from_time = other.statistics, clock.perf_counter(), other.time
        _advance(other, length)
    except StepError as error:
        raise StepError(f"the probe of the estimate failed: {error}", time=other.time) from None
    wall, bearing = clock.perf_counter() - began, other.time - from_time
    after = other.statistics
    state = other.state
    began = clock.perf_counter()
    for _ in range(_RECORDS):
        other._core.observe(state.time, state.vector)
    record = (clock.perf_counter() - began) / _RECORDS
    counted = {name: (after[name] - before[name]) / bearing for name in ("steps", "rhs_evaluations")}
    return counted | {"wall": wall / bearing, "record": record}


def _advance(sim: Simulation, length: float) -> None:
    end, enough = sim.time + length, clock.perf_counter() + PATIENCE
    while sim.time < end and clock.perf_counter() < enough:
        sim.step()


def _errors(sim: Simulation) -> dict[str, Any]:
    """Errors from the table: those of a preset, else interpolated over the tolerances' scale."""
    options, measured = sim.options, table()
    case = _case(sim, measured["scenes"])
    window = float(np.median(measured["windows_s"][case]))
    place = {"window": window, "case": case} | dict.fromkeys(_BIASES, math.nan)
    standard = options.max_order == 2 and options.rings_share is None and options.impact_share is None
    known = options.integrator == "bdf" and standard and sim.scene.effects.bodies == "rollers_and_cage"
    if not known:
        return place | dict.fromkeys(_ERRORS, math.nan) | {"extrapolated": True}
    tolerances = options.tolerances.model_dump()
    for preset in measured["presets_of_scenes"].get(case, {}).values():
        if _same(tolerances, preset["tolerances"]):
            bias = preset.get("bias", {})
            far = {name: _number(bias.get(key)) for name, key in _BIASES.items()}
            return place | far | {name: _number(preset[name]) for name in _ERRORS} | {"extrapolated": False}
    scale = _scale(tolerances, measured["base_tolerances"])
    points = measured["points"][case]
    scales = [point["scale"] for point in points]
    errors = {name: _between(scale, scales, [point[name] for point in points]) for name in _ERRORS}
    return place | errors | {"extrapolated": not scales[0] <= scale <= scales[-1]}


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def _case(sim: Simulation, scenes: Mapping[str, Mapping[str, Any]]) -> str:
    """The measured scene that a simulation is most like: loaded on one side, with unequal rollers, or by speed and axial load;
    of those with the same, by whether its cage lies still or whirls.
    """
    scene = sim.scene
    if _largest(scene.radial_load) > 0.0:
        like = [name for name, one in scenes.items() if one["radial_load"] > 0.0]
    elif float(np.ptp(diameter_deviation(scene))) > LEAST_SCATTER:
        like = [name for name, one in scenes.items() if one["diameter_range"] > 0.0]
    else:
        like = [name for name, one in scenes.items() if one["radial_load"] == 0.0 and one["diameter_range"] == 0.0]
    like = like or list(scenes)
    speed, load = max(_largest(scene.speed_rpm), 1e-3), max(_axial(sim), 1.0)
    distance = {
        name: math.hypot(math.log(speed / scenes[name]["speed_rpm"]), math.log(load / scenes[name]["axial_load"]))
        for name in like
    }
    nearest = [name for name in like if distance[name] <= min(distance.values()) + 1e-9]
    colliding = scene.effects.bodies != "rollers" and _whirls(sim)
    same = [name for name in nearest if scenes[name]["colliding"] == colliding]
    return (same or nearest)[0]


def _largest(quantity: float | History) -> float:
    """Largest size of a quantity."""
    return max(map(abs, values_of(quantity)))


def _axial(sim: Simulation) -> float:
    """Axial load, that of the ring's equilibrium where its position is given (N)."""
    displacement = sim.scene.displacement
    if displacement is None or displacement[2] is None:
        return _largest(sim.scene.axial_load)
    equilibrium, bearing = sim.equilibrium, sim.scene.bearing
    return float(equilibrium.outer_load.sum()) * math.sin(math.radians(bearing.cup_half_angle_deg))


def _whirls(sim: Simulation) -> bool:
    """Whether the cage's centre moves about as fast as on an orbit with the cage's speed and its play as radius."""
    record = sim.record()
    speed = record["cage_velocity"]
    whirl = float(np.hypot(speed[0], speed[1])) / sim.scene.bearing.cage.play_radial
    return whirl > 0.3 * abs(float(record["cage_angular_velocity"][2]))


def _same(one: Mapping[str, float], other: Mapping[str, float]) -> bool:
    return all(math.isclose(one[name], value, rel_tol=SAME) for name, value in other.items())


def _scale(tolerances: Mapping[str, float], base: Mapping[str, float]) -> float:
    """Geometric mean of tolerances over those of the base."""
    return math.exp(sum(math.log(tolerances[name] / value) for name, value in base.items()) / len(base))


def _between(scale: float, scales: Sequence[float], values: Sequence[float]) -> float:
    """Straight lines in log-log; constant beyond the ends. Errors are made to grow with the tolerance."""
    grown = np.maximum.accumulate(np.maximum(values, 1e-12))
    return float(np.exp(np.interp(math.log(scale), np.log(scales), np.log(grown))))
