"""The grid of operating points, and one bounded run of each."""

from __future__ import annotations

import functools
import math
import time as clock
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

import trbdyn as trb
from trbdyn.results.observables import energy
from trbdyn.results.result import Result
from trbdyn.run.energies import LEAST_ENERGY, STORED_SHARE
from trbdyn.run.options import ACCURACY
from trbdyn.run.watch import SMALLEST_STEP

SPEEDS: Final = (0.01, 1.0, 10.0, 100.0, 1000.0, 3000.0, 10_000.0, 30_000.0)
AXIAL: Final = (500.0, 1230.0, 4930.0, 20_000.0)
COMBINED_AXIAL: Final = 4930.0
COMBINED_AXIAL_FAST: Final = 20_000.0
"""Axial load of the combined points above 10 000 rpm, where centrifugal forces lift rollers off the inner ring (N)."""
SHARES: Final = (0.5, 1.5)
"""Radial loads of the combined points, over that under which the first roller loses its load."""
DIRECTIONS: Final = (90.0, -30.0)
"""Directions of the radial load (deg): up, against gravity, and sideways down."""
EFFECTS: Final = {"paper": trb.Effects.paper, "standard": trb.Effects.standard}
STARTS: Final = {"equal": trb.Start.equal(), "whirl": trb.Start.whirl(0.9)}
PRESETS: Final = tuple(ACCURACY)

PROMISE: Final = 1e-3
"""Closure that is looked at: below it the energy is said to add up."""
BAD: Final = 1e-2
"""Closure above which a run without a warning is a finding."""
RECORDS: Final = 100
PATIENCE_S: Final = 60.0
"""Processor time after which a run is given up."""


@dataclass(frozen=True, order=True)
class Point:
    """One run of the grid."""

    speed_rpm: float
    axial_load: float
    radial_share: float
    direction_deg: float
    effects: str
    preset: str
    start: str

    @property
    def load(self) -> str:
        """Short text of the load."""
        if self.radial_share == 0.0:
            return f"Fa {self.axial_load:g} N"
        return f"combined, Fr {self.radial_share:g}, {self.direction_deg:g}°"

    def scene(self) -> trb.Scene:
        """What is simulated."""
        effects = EFFECTS[self.effects]().replace(quadrature="gauss", n_slices=8)
        radial = round(self.radial_share * unloading(self.axial_load)) if self.radial_share else 0.0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return trb.cases.paper_30310(
                self.speed_rpm,
                self.axial_load,
                radial,
                radial_direction_deg=self.direction_deg,
                effects=effects,
                start=STARTS[self.start],
            )


@functools.cache
def unloading(axial_load: float) -> float:
    """Radial load under which the first roller of the 30310 loses its load on the inner ring (N)."""
    low, high = 0.0, 4.0 * axial_load
    while high - low > 1e-3 * axial_load:
        middle = 0.5 * (low + high)
        scene = trb.cases.paper_30310(100.0, axial_load, middle)
        low, high = (middle, high) if trb.Simulation(scene).equilibrium.inner_load.min() > 0.0 else (low, middle)
    return low


def points(
    speeds: tuple[float, ...] = SPEEDS,
    axial: tuple[float, ...] = AXIAL,
    shares: tuple[float, ...] = SHARES,
    directions: tuple[float, ...] = DIRECTIONS,
    effects: tuple[str, ...] = tuple(EFFECTS),
    presets: tuple[str, ...] = PRESETS,
    starts: tuple[str, ...] = tuple(STARTS),
) -> Iterator[Point]:
    """Every point of the grid."""
    loads = [(one, 0.0, 90.0) for one in axial]
    for speed in speeds:
        held = COMBINED_AXIAL_FAST if speed > 10_000.0 else COMBINED_AXIAL
        combined = [(held, share, direction) for share in shares for direction in directions]
        for load in loads + combined:
            for effect in effects:
                for preset in presets:
                    for start in starts:
                        yield Point(speed, *load, effect, preset, start)


def measure(point: Point, most_steps: int, most_turns: float) -> dict[str, Any]:
    """Run a point and audit it.

    A first run counts steps and tells how far `most_steps` of them, or `most_turns` of the shaft, lead; a second one goes
    there as a user's run does, with its records, its watch and its warnings.
    """
    row: dict[str, Any] = {**vars(point), "load": point.load}
    began = clock.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            scene = point.scene()
            row["radial_load"] = scene.radial_load
            found = _bounded(scene, point.preset, most_steps, most_turns)
            sim = trb.Simulation(scene, accuracy=point.preset)
            every = found["time_s"] / RECORDS
            result = sim.run(duration=found["time_s"], save_every=every, save_groups=("time", "energy"))
            row |= found | audit(result)
        except (trb.InputError, trb.LoadError) as error:
            row |= {"status": "refused", "message": str(error).splitlines()[0][:300]}
        except trb.TrbError as error:
            row |= {"status": "error", "message": f"{type(error).__name__}: {str(error).splitlines()[0][:300]}"}
    row["cpu_s"] = clock.process_time() - began
    return row


def _bounded(scene: trb.Scene, preset: str, most_steps: int, most_turns: float) -> dict[str, float]:
    sim = trb.Simulation(scene, accuracy=preset)
    length = 60.0 * most_turns / abs(point_speed(scene))
    began, steps = clock.process_time(), 0
    half = (0.0, 0)
    while sim.time < length and steps < most_steps and clock.process_time() - began < PATIENCE_S:
        sim.step()
        steps += 1
        if steps == most_steps // 2:
            half = (sim.time, steps)
    statistics = sim.statistics
    repeated = statistics["error_failures"] + statistics["nonlinear_failures"]
    time = min(sim.time, length)
    return {
        "time_s": time,
        "turns": most_turns * time / length,
        "steps": steps,
        "mean_step_s": (sim.time - half[0]) / max(steps - half[1], 1),
        "repeated_share": repeated / max(steps, 1),
    }


def point_speed(scene: trb.Scene) -> float:
    """Speed of a scene of the grid, which is constant (rpm)."""
    assert not isinstance(scene.speed_rpm, trb.History)
    return scene.speed_rpm


def audit(result: Result) -> dict[str, Any]:
    """Closures of a run: over the dissipated work, and as the watch measures it, of the whole run."""
    balance = result.energy_balance
    whole = result.energy_audit
    terms = {name: np.asarray(result[name]) for name in balance_terms(result)}
    turned_over = 0.5 * float(sum(np.abs(np.diff(values)).sum() for values in terms.values()))
    stored = float(sum(abs(result[name][-1]) for name in energy.STORED))
    closure = abs(whole.residual) / max(turned_over, STORED_SHARE * stored, LEAST_ENERGY)
    return {
        "status": "done" if result.success else "ended",
        "message": "" if result.success else result.message[:300],
        "closure": closure,
        "closure_dissipated": None if not math.isfinite(whole.closure) else whole.closure,
        "residual_j": whole.residual,
        "dissipated_j": whole.dissipated,
        "turned_over_j": turned_over,
        "loss_w": whole.dissipated / result.duration if result.duration > 0.0 else None,
        "warnings": list(result.warnings),
        "largest_residual_j": float(np.abs(balance["residual"]).max()),
    }


def balance_terms(result: Result) -> list[str]:
    """Names of the works, losses and stored energies of a result, in J."""
    names = [field.name for field in result.fields]
    return [name for name in names if name.startswith(("work_", "loss_")) or name in energy.STORED]


def is_bad(row: dict[str, Any]) -> str | None:
    """Why a run is a finding, or None: energy that does not add up without a warning, steps that collapse, an error."""
    if row["status"] == "refused":
        return None
    if row["status"] == "error":
        return "error: " + row["message"]
    if row["status"] == "ended":
        return "ended by the watch: " + row["message"]
    if not row["closure"] <= BAD and not row["warnings"]:
        return f"closure {row['closure']:.2g} without a warning"
    if row["mean_step_s"] < SMALLEST_STEP:
        return f"mean step {row['mean_step_s']:.2g} s"
    return None
