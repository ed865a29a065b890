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

from trbdyn import _core
from trbdyn.base.shipped import DATA
from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import StepError
from trbdyn.model.flatten import diameter_deviation
from trbdyn.model.motion import History, values_of
from trbdyn.run.keeping import interval
from trbdyn.run.process import has_a_spare_core

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene
    from trbdyn.results.result import Result
    from trbdyn.run.options import RunOptions
    from trbdyn.run.simulation import Simulation

TABLE: Final = DATA / "accuracy.json"
"""Errors over tolerances, written by ``python benchmarks/work_precision.py --make-table``."""

MEASURED: Final = ("bdf", "multirate")
"""Integrators for which the table is given. It was measured with 'bdf'; docs/theory/multirate.md has both side by side."""

PART: Final = 0.5
"""Length of a part of the probe, in turns of the shaft."""
LEAST_PARTS: Final = 8
MOST_PARTS: Final = 32
"""Parts of a probe: at least, unless the run is shorter, and at most."""
STEADY: Final = 0.15
"""Difference of the steps in the halves of a probe up to which the motion is taken to go on as it is."""
MOST_STEPS: Final = 15_000
"""Steps after which a probe ends, about a second of computing."""
WARM_UP: Final = 5e-4
"""Bearing time before the probe (s): the integrator starts with tiny steps."""
MOST_ROWS: Final = 2000
"""Records of a part of a probe, at most."""
SAME: Final = 1e-6
"""Relative difference up to which tolerances count as those of a preset."""
LEAST_SCATTER: Final = 1e-7
"""Range of the rollers' diameters from which they count as unequal (m)."""


NOT_MEASURED: Final = "errors of such a run were not measured beforehand; trbdyn.check measures them at the run"
"""Said of a run that the table of errors does not hold: several bearings, no cage, an integrator or options of its own."""


@dataclass(frozen=True, repr=False)
class Estimate(Displayed):
    """What a run is expected to take and give.

    Attributes
    ----------
    bearing_time : float
        Length of the run (s).
    wall_s : float
        Expected wall time (s), records included.
    wall_s_low, wall_s_high : float
        The same from the quickest and the slowest half turn of the shaft in the second half of the probe (s).
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
    wall_s_low: float
    wall_s_high: float
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
    window: float
    case: str
    extrapolated: bool

    def __str__(self) -> str:
        return "\n".join(
            [
                f"{self.bearing_time:.4g} s of bearing time in about {self.wall_s:.3g} s, {self.wall_s_low:.2g} to "
                f"{self.wall_s_high:.2g} s (real time x {self.real_time_factor:.3g}), {self.steps:,} steps",
                f"{self.records:,} records, {self.memory_mb:.3g} MB in memory",
                self._errors_said,
            ]
        )

    @property
    def _errors_said(self) -> str:
        if not math.isfinite(self.error_cage_over_cpr):
            return NOT_MEASURED
        return (
            f"cage centre within {100.0 * self.error_cage_over_cpr:.2g} % of Cpr over {1e3 * self.window:.2g} ms "
            f"(worst {100.0 * self.error_cage_over_cpr_worst:.2g} %), power loss within {100.0 * self.error_power:.2g} % "
            f"(scene '{self.case}')"
        )

    __repr__ = __str__

    def _shown(self) -> Shown:
        numbers = {
            "time in the bearing": (self.bearing_time, "s"),
            "expected wall time": (self.wall_s, "s"),
            "at least": (self.wall_s_low, "s"),
            "at most": (self.wall_s_high, "s"),
            "steps": (self.steps, ""),
            "evaluations of all forces": (self.evaluations, ""),
            "records": (self.records, ""),
            "size of the records in memory": (self.memory_mb, "MB"),
            "error of the cage's centre over Cpr": (100.0 * self.error_cage_over_cpr, "%"),
            "error of contact loads": (100.0 * self.error_load, "%"),
            "error of the power loss": (100.0 * self.error_power, "%"),
        }
        rows = tuple(
            (words, f"{value:,}" if isinstance(value, int) else f"{value:.3g}", unit)
            for words, (value, unit) in numbers.items()
            if math.isfinite(value)
        )
        note = NOT_MEASURED
        if math.isfinite(self.error_cage_over_cpr):
            note = (
                f"Errors are those of the measured scene '{self.case}', the one most like this; "
                f"errors over {1e3 * self.window:.2g} ms."
            )
        return Shown("Estimate of a run", rows, ("quantity", "value", "unit"), (note,))


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
) -> Estimate:
    """Expected wall time and error of a run from the present state.

    The wall time is extrapolated from a probe of a copy, which steps on until its second half takes about as many steps as its
    first: rollers that leave the loaded zone, or a cage that begins to whirl, may take a turn or more until they are as busy as
    they stay. The second half is what counts, so the estimate holds for as long as the bearing moves as it does there. Errors
    are those measured for the same tolerances on the shipped bearing: on another they are a guide.

    Parameters
    ----------
    sim : Simulation
        What would be run; it is left as it is.
    revolutions, duration : float, optional
        How far to go, in turns of the shaft or s; one of both must be given.
    save_every : float, optional
        Time between records (s); by default that of `Simulation.run`.

    Raises
    ------
    InputError
        If an argument cannot be used.
    StepError
        If the probe fails.
    """
    changes = {"revolutions": revolutions, "duration": duration}
    options = sim.options.replace(**changes if save_every is None else {**changes, "save_every": save_every})
    start = sim.time
    length = options.end_time(sim.subject, start) - start
    save_every = interval(length, sim.scene.turning_rpm) if save_every is None else save_every
    rates = _probe(sim, length, save_every)
    records = max(math.ceil(length / save_every - 1e-9), 1) + 1
    found = _errors(sim)
    return Estimate(
        bearing_time=length,
        wall_s=length * rates["wall"],
        wall_s_low=length * rates["wall_low"],
        wall_s_high=length * rates["wall_high"],
        real_time_factor=1.0 / rates["wall"],
        steps=round(length * rates["steps"]),
        evaluations=round(length * rates["rhs_evaluations"]),
        records=records,
        memory_mb=8e-6 * records * sum(one.model.record_length + one.model.peak_length for one in sim.bearings),
        **found,
    )


@dataclass(frozen=True)
class _Part:
    """A part of a probe: how long it is in bearing time and wall time (s), and what it took."""

    bearing: float
    wall: float
    steps: float
    rhs_evaluations: float


def _probe(sim: Simulation, length: float, save_every: float) -> dict[str, float]:
    """Wall time, steps and evaluations per second of bearing time, with records and peaks as a run has them."""
    other = sim.copy()
    turn = 60.0 / max(_largest(sim.scene.turning_rpm), 60.0 / length)
    part = min(PART * turn, length / 2)
    parts: list[_Part] = []
    try:
        _part(other, min(WARM_UP, 0.25 * length), save_every, MOST_STEPS)
        other._core.begin_peaks(other.time)
        end, left = other.time + length, float(MOST_STEPS)
        while other.time < end and left > 0:
            parts.append(_part(other, min(part, end - other.time), save_every, int(left)))
            left -= parts[-1].steps
            if len(parts) >= LEAST_PARTS and (_steady(parts) or len(parts) >= MOST_PARTS):
                break
    except _core.CoreStepError as error:
        raise StepError(f"the probe of the estimate failed: {error}", time=other.time) from None
    later = parts[len(parts) // 2 :]
    bearing = sum(one.bearing for one in later)
    out = {name: sum(getattr(one, name) for one in later) / bearing for name in ("wall", "steps", "rhs_evaluations")}
    each = [one.wall / one.bearing for one in later]
    return out | {"wall_low": min(each), "wall_high": max(each)}


def _part(sim: Simulation, length: float, save_every: float, most_steps: int) -> _Part:
    """At least one step."""
    core, before, since = sim._core, sim.statistics, sim._core.time
    count = min(max(round(length / save_every), 1), MOST_ROWS)
    times = since + length * np.arange(1, count + 1) / count
    rows = np.empty((count, core.row_length))
    began = clock.perf_counter()
    core.run(times, rows, max(most_steps, 1), math.inf, has_a_spare_core())
    wall, after = clock.perf_counter() - began, sim.statistics
    counted = {name: after[name] - before[name] for name in ("steps", "rhs_evaluations")}
    return _Part(core.time - since, wall, **counted)


def _steady(parts: Sequence[_Part]) -> bool:
    """Whether the halves of a probe take about as many steps."""
    first, second = parts[: len(parts) // 2], parts[len(parts) // 2 :]
    rates = [sum(one.steps for one in half) / sum(one.bearing for one in half) for half in (first, second)]
    return abs(rates[1] - rates[0]) <= STEADY * max(rates)


def _errors(sim: Simulation) -> dict[str, Any]:
    """Errors from the table: those of a preset, else interpolated over the tolerances' scale."""
    options, measured = sim.options, table()
    case = case_like(sim, measured["scenes"])
    window = float(np.median(measured["windows_s"][case]))
    place = {"window": window, "case": case}
    standard = options.max_order == 2 and options.rings_share is None and options.impact_share is None
    known = len(sim.bearings) == 1 and options.integrator in MEASURED and standard and sim.scene.effects.has_cage
    if not known:
        return place | dict.fromkeys(_ERRORS, math.nan) | {"extrapolated": True}
    preset = measured["presets_of_scenes"].get(case, {}).get(preset_like(options))
    if preset is not None:
        return place | {name: preset[name] for name in _ERRORS} | {"extrapolated": False}
    scale = _scale(options.tolerances.model_dump(), measured["base_tolerances"])
    points = measured["points"][case]
    scales = [point["scale"] for point in points]
    errors = {name: _between(scale, scales, [point[name] for point in points]) for name in _ERRORS}
    return place | errors | {"extrapolated": not scales[0] <= scale <= scales[-1]}


def case_like(sim: Simulation, scenes: Mapping[str, Mapping[str, Any]]) -> str:
    """The measured scene that a simulation is most like."""
    colliding = sim.scene.effects.has_cage and whirls(sim)
    return most_like(sim.scene, axial_of(sim), colliding, scenes)


def most_like(scene: Scene, axial: float, colliding: bool, scenes: Mapping[str, Mapping[str, Any]]) -> str:
    """The measured scene that another one is most like: loaded on one side, with unequal rollers, or by speed and axial load
    (N); of those with the same, by whether its cage lies still or whirls.
    """
    if _largest(scene.radial_load) > 0.0:
        like = [name for name, one in scenes.items() if one["radial_load"] > 0.0]
    elif float(np.ptp(diameter_deviation(scene))) > LEAST_SCATTER:
        like = [name for name, one in scenes.items() if one["diameter_range"] > 0.0]
    else:
        like = [name for name, one in scenes.items() if one["radial_load"] == 0.0 and one["diameter_range"] == 0.0]
    like = like or list(scenes)
    speed, load = max(_largest(scene.turning_rpm), 1e-3), max(axial, 1.0)
    distance = {
        name: math.hypot(math.log(speed / scenes[name]["speed_rpm"]), math.log(load / scenes[name]["axial_load"]))
        for name in like
    }
    nearest = [name for name in like if distance[name] <= min(distance.values()) + 1e-9]
    same = [name for name in nearest if scenes[name]["colliding"] == colliding]
    return (same or nearest)[0]


def _largest(quantity: float | History) -> float:
    """Largest size of a quantity."""
    return max(map(abs, values_of(quantity)))


def axial_of(sim: Simulation) -> float:
    """Axial load, that of the ring's equilibrium where its position is given (N)."""
    displacement = sim.scene.displacement
    if displacement is None or displacement[2] is None:
        return _largest(sim.scene.axial_load)
    equilibrium, bearing = sim.equilibrium, sim.scene.bearing
    return float(equilibrium.outer_load.sum()) * math.sin(math.radians(bearing.cup_half_angle_deg))


def whirls(sim: Simulation) -> bool:
    row = sim._core.observe(*sim._place(None, None))
    record = {name: row[at : at + math.prod(shape)] for name, at, shape in sim.bearings[0].record_layout}
    speed = record["cage_velocity"]
    spin = float(record["cage_angular_velocity"][2])
    return fast_cage(float(np.hypot(speed[0], speed[1])), spin, sim.scene.bearing.cage.play_radial)


def fast_cage(speed: float, spin: float, play: float) -> bool:
    """Whether the cage's centre moves (m/s) about as fast as on an orbit with the cage's speed (rad/s) and its play (m)."""
    return speed > 0.3 * abs(spin) * play


def preset_like(options: RunOptions) -> str | None:
    """The measured preset whose tolerances these options have; None for tolerances of one's own."""
    own = options.tolerances.model_dump()
    for name, preset in table()["presets"].items():
        if all(math.isclose(own[entry], value, rel_tol=SAME) for entry, value in preset["tolerances"].items()):
            return str(name)
    return None


def _scale(tolerances: Mapping[str, float], base: Mapping[str, float]) -> float:
    """Geometric mean of tolerances over those of the base."""
    return math.exp(sum(math.log(tolerances[name] / value) for name, value in base.items()) / len(base))


def _between(scale: float, scales: Sequence[float], values: Sequence[float]) -> float:
    """Straight lines in log-log; constant beyond the ends. Errors are made to grow with the tolerance."""
    grown = np.maximum.accumulate(np.maximum(values, 1e-12))
    return float(np.exp(np.interp(math.log(scale), np.log(scales), np.log(grown))))


def preset_of(result: Result) -> str | None:
    """The preset with whose tolerances a run was made; None for tolerances or an integrator of one's own."""
    settings: Mapping[str, Any] = result.meta.get("settings") or {}
    own = [name for name in ("rtol", "atol_position", "atol_angle", "atol_velocity", "atol_spin") if settings.get(name)]
    preset = settings.get("accuracy")
    known = preset in table()["presets"] and not own and settings.get("integrator") in MEASURED
    return str(preset) if known else None
