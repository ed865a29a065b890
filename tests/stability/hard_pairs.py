"""Hard cases of bearings on one shaft: what each is, why it is hard, and what held."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from hard_runs import TIGHT, Verdict

import trbdyn as trb
from trbdyn import Assembly, History, Shaft, ShaftBearing, ShaftLoad
from trbdyn.results.assembly import AssemblyResult

BEARING = trb.cases.rig_30310()
SHAFT = Shaft(mass=6.0, inertia_axial=4e-3, inertia_transverse=5e-2)


@dataclass(frozen=True)
class HardPair:
    """One hard case.

    Attributes
    ----------
    name, why : str
        What it is called, and why it is hard.
    make : callable
        Makes the assembly.
    duration : float
        Bearing time (s).
    closure : float
        Bound of the energy audit's closure, of every bearing and of the whole.
    tolerances : float
        Bound of what the loss differs by from a run with tight tolerances, relative.
    path, window : float
        Bound of what two methods differ by over a time (s): speeds of rollers, cages and shaft, over the largest.
    """

    name: str
    why: str
    make: Callable[[], Assembly]
    duration: float = 0.02
    closure: float = 1e-3
    tolerances: float = 0.02
    path: float = 2e-3
    window: float = 3e-4


def pair(end_play: float = -20e-6, **given: Any) -> Assembly:
    return Assembly.pair(
        BEARING, "back to back", **{"spread": 0.15, "end_play": end_play, "shaft": SHAFT, "speed_rpm": 3000.0} | given
    )


def push(axial: float | History, radial: float | History = 0.0) -> ShaftLoad:
    return ShaftLoad(position=0.02, force=(0.0, radial, axial))


def unequal_tandem() -> Assembly:
    """A large and a small bearing side by side in cold oil, and one against them in hot oil."""
    bearings = (
        ShaftBearing(
            trb.cases.bearing_32216(), position=-0.12, small_ends="right", lubricant=trb.lubricants.vg100(30.0)
        ),
        ShaftBearing(BEARING, position=-0.02, small_ends="right", lubricant=trb.lubricants.vg100(30.0)),
        ShaftBearing(BEARING, position=0.12, small_ends="left", end_play=-30e-6, lubricant=trb.lubricants.vg100(90.0)),
    )
    return Assembly(shaft=SHAFT, bearings=bearings, loads=(push(2000.0, -3000.0),), speed_rpm=-4000.0)


PAIRS: tuple[HardPair, ...] = (
    HardPair(
        "pair_one_side_unloaded",
        "end play and an axial load: one bearing carries nothing but the weight of its own rollers",
        lambda: pair(120e-6, loads=[push(4000.0)]),
    ),
    HardPair(
        "pair_reversing_load",
        "the axial load goes through zero, and the shaft through its end play onto the other bearing, in 10 ms",
        lambda: pair(20e-6, loads=[push(History.ramp(2e-3, 12e-3, 3000.0, -3000.0), -300.0)]),
    ),
    HardPair(
        "pair_load_drops",
        "all of the load drops to zero for 8 ms and comes back within a tenth of a millisecond",
        lambda: pair(
            0.0,
            loads=[
                push(
                    History.step([2e-3, 10e-3], [3000.0, 0.0, 3000.0]),
                    History.step([2e-3, 10e-3], [-4000.0, 0.0, -4000.0]),
                )
            ],
        ),
    ),
    HardPair(
        "pair_unbalance_10000_rpm",
        "an unbalance of 600 N turns with the shaft at 10 000 rpm",
        lambda: pair(speed_rpm=10000.0, shaft=SHAFT.replace(unbalance=5.5e-4)),
        duration=0.012,
    ),
    HardPair(
        "pair_run_up",
        "from standstill to 6000 rpm under a torque, through every speed and film",
        lambda: pair(speed_rpm=0.0, torque=130.0, loads=[push(500.0, -2000.0)]),
    ),
    HardPair(
        "pair_torque_stops",
        "the torque of a running shaft is taken away suddenly",
        lambda: pair(torque=History.step([5e-3], [5.2, 0.0])),
    ),
    HardPair(
        "pair_impact",
        "a hit of 20 kN for half a millisecond at the end of the shaft, which tilts it out of the bearings",
        lambda: pair(
            loads=[
                ShaftLoad(position=0.2, force=(0.0, History.table([4e-3, 4.25e-3, 4.5e-3], [0.0, -20000.0, 0.0]), 0.0))
            ]
        ),
    ),
    HardPair(
        "three_bearings",
        "sizes, oils and directions differ, and three cages hit their rollers at different times",
        unequal_tandem,
    ),
)


def judge_pair(hard: HardPair, *, quick: bool = False) -> Verdict:
    """Run an assembly in every way; `quick` leaves out the comparisons."""
    verdict = Verdict(hard.name)
    try:
        assembly = hard.make()
        result = _run(assembly, hard.duration, accuracy="standard")
        _look_at(hard, result, verdict)
        if not quick and not verdict.broken:
            _compare(hard, assembly, result, verdict)
    except Exception as error:
        verdict.broken.append(f"{type(error).__name__}: {error}")
    verdict.status = "failed" if verdict.broken else "ok"
    return verdict


def _run(assembly: Assembly, duration: float, **options: Any) -> AssemblyResult:
    return trb.Simulation(assembly, **options).run(duration=duration, save_every=max(duration / 1000, 1e-5))


def _look_at(hard: HardPair, result: AssemblyResult, verdict: Verdict) -> None:
    verdict.steps, verdict.message = int(result.stats["steps"]), result.message
    verdict.smallest_step = float(result.stats["smallest_step"])
    verdict.wall_s_per_revolution = float(result.stats["wall_s_per_revolution"])
    verdict.demand(result.success, f"did not finish: {result.message}")
    for name, one in result.items():
        for entry in one.fields:
            values = one[entry.name]
            values = values[~np.isnan(values)] if "film_parameter_min" in entry.name else values
            verdict.demand(bool(np.isfinite(values).all()), f"{name}: {entry.name} is not finite")
    verdict.closure = max(result.energy.closure, *(one.energy_closure for one in result.values()))
    verdict.demand(
        verdict.closure <= hard.closure, f"energy closes to {verdict.closure:.2g} only, not {hard.closure:g}"
    )


def _lost(result: AssemblyResult) -> float:
    return sum(
        float(one[entry.name][-1]) for one in result.values() for entry in one.fields if entry.name.startswith("loss_")
    )


def _compare(hard: HardPair, assembly: Assembly, result: AssemblyResult, verdict: Verdict) -> None:
    tight = _run(assembly, hard.duration, **TIGHT)
    verdict.demand(tight.success, f"the reference did not finish: {tight.message}")
    verdict.tolerances = abs(_lost(result) - _lost(tight)) / max(abs(_lost(tight)), 1e-6)
    verdict.demand(verdict.tolerances <= hard.tolerances, f"two tolerances differ by {verdict.tolerances:.2g}")
    speeds = []
    for options in ({"max_order": 2}, {"integrator": "erk"}):
        short = _run(assembly, hard.window, **TIGHT, **options)
        parts = [part.reshape(-1) for one in short.values() for part in (one.roller_velocity, one.cage_velocity)]
        parts.append(np.gradient(short.shaft_position, short.time, axis=0).reshape(-1))
        speeds.append(np.concatenate(parts))
    largest = max(float(np.abs(speeds[0]).max()), 1e-3)
    verdict.path = float(np.abs(speeds[0] - speeds[1]).max()) / largest if math.isfinite(largest) else math.inf
    verdict.demand(verdict.path <= hard.path, f"two methods differ by {verdict.path:.2g} in their speeds")
