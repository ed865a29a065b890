"""The bench of peers.py: scene, windows, the core and the alternatives over them."""

from __future__ import annotations

import argparse
import dataclasses
import math
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from accuracy.measure import timed_run
from numpy.typing import NDArray
from numpy_model import Jacobian, NumpyModel, solvers

from trbdyn import Effects, RunOptions, Scene, Simulation, Start
from trbdyn.model.cases import paper_30310
from trbdyn.run.options import ACCURACY, Tolerances

Array = NDArray[np.float64]

SPEED_RPM, AXIAL_LOAD = 3000.0, 4930.0
SETTLING, BETWEEN, LENGTH, OUTPUTS = 0.04, 0.0113, 4e-3, 41
IMPACT = 20.0
"""Windows: first and later starts (s), length (s), number of compared times, pocket force at which they start (N)."""

TURN = 60.0 / SPEED_RPM
"""What is timed from the start of the first windows (s), but for alternatives so slow that a window has to do: a turn."""

TIMED = 3
"""Windows from which runs are timed; the errors are of all."""

EXACT = ", exact"
"""Behind an integrator's name: without tangents of the rings' forces."""


@dataclass
class Window:
    """A short stretch of bearing time that everything is run over."""

    state: Array
    times: Array
    reference: Array = field(default_factory=lambda: np.empty(0))
    uncertainty: float = math.nan
    impacts: int = 0


@dataclass
class Point:
    """What a tolerance gave, over all windows, per turn of the shaft."""

    factor: float
    error: float
    wall: float
    steps: float
    evaluations: float
    jacobians: float


@dataclass(frozen=True)
class Method:
    """An integrator.

    It runs from a window's start with a factor on the standard tolerances over a stretch, and is told whether steps are to be
    counted. Where it is slow, a few windows have to do, for errors and times.
    """

    name: str
    model: str
    run: Callable[[Window, float, float, bool], solvers.Run]
    factors: Sequence[float]
    repeats: int = 1
    slow: bool = False

    @property
    def stretch(self) -> float:
        """What is timed (s)."""
        return LENGTH if self.slow else TURN


def kinds(model: NumpyModel) -> NDArray[np.intp]:
    """Kind of every entry of a state: position, angle, velocity, spin."""
    roller = [0, 1, 0, 1, 1, 2, 2, 2, 3, 3, 3]
    return np.array(roller * model.constants.n_rollers + [0] * 3 + [1] * 3 + [2] * 3 + [3] * 3)


def scaled(factor: float) -> Tolerances:
    """The standard tolerances times a factor."""
    standard = ACCURACY["standard"]
    return Tolerances(**{name: factor * getattr(standard, name) for name in Tolerances.model_fields})


class Bench:
    """Scene, windows, and the two models."""

    def __init__(self, options: argparse.Namespace) -> None:
        effects = Effects.paper().replace(n_slices=options.slices)
        self.scene: Scene = paper_30310(SPEED_RPM, AXIAL_LOAD, start=Start.whirl(0.9), effects=effects)
        self.play = self.scene.bearing.cage.play_radial
        self.repeats = 1 if options.quick else 3
        self.model = NumpyModel(self.scene)
        self.jacobian = Jacobian(self.model)
        self.kinds = kinds(self.model)
        self.simulations: dict[tuple[str, float], Simulation] = {}
        self.paces: dict[float, list[float]] = {}
        self.windows = self._windows(1 if options.smoke else 12 if options.quick else 24)

    def _windows(self, count: int) -> list[Window]:
        sim = Simulation(self.scene)
        out = []
        for index in range(count):
            while sim.time < SETTLING + index * BETWEEN or sim.contacts()["pocket_load"].max() < IMPACT:
                sim.step()
            out.append(Window(sim.state.vector, sim.time + np.linspace(0.0, LENGTH, OUTPUTS)))
        for window in out:
            tight, _ = self._core_run(window, 1e-5, "erk")
            loose, _ = self._core_run(window, 1e-4, "erk")
            window.reference = tight
            window.uncertainty = self.error(window, loose)
            reference = self.simulation("erk", 1e-5)
            reference.set_state(window.state, float(window.times[0]))
            result = reference.run(duration=LENGTH, save_every=LENGTH / 800)
            touching = np.asarray(result["pocket_force"]) > 0.0
            window.impacts = int((touching[1:] & ~touching[:-1]).sum())
        return out

    def simulation(self, integrator: str, factor: float) -> Simulation:
        """A simulation with an integrator of the core; with `EXACT` behind its name every force is evaluated exactly."""
        key = (integrator, factor)
        if key not in self.simulations:
            given = scaled(factor).model_dump()
            given |= {"rings_share": 0.0} if integrator.endswith(EXACT) else {}
            name = integrator.removesuffix(EXACT)
            self.simulations[key] = Simulation(self.scene, integrator=name, **given)
        return self.simulations[key]

    def _core_run(self, window: Window, factor: float, integrator: str) -> tuple[Array, Simulation]:
        """Path of the cage's centre in the frame that turns with the kinematic cage angle."""
        sim = self.simulation(integrator, factor)
        sim.set_state(window.state, float(window.times[0]))
        result = sim.run(duration=LENGTH, save_every=LENGTH / (OUTPUTS - 1))
        angle = self.scene.bearing.geometry.cage_speed_ratio * np.asarray(result["shaft_angle"])
        place = np.asarray(result["cage_position"])
        turned = (place[:, 0] + 1j * place[:, 1]) * np.exp(-1j * angle)
        return np.stack([turned.real, turned.imag], axis=1), sim

    def core(self, window: Window, factor: float, stretch: float, _: bool, *, integrator: str) -> solvers.Run:
        """The core: a run with records over the window for the error, then one without over the stretch for the time."""
        path, sim = self._core_run(window, factor, integrator)
        wall, did = self._timed(sim, window, stretch)
        return solvers.Run(
            path, wall, int(did["steps"]), int(did["rhs_evaluations"]), int(did.get("jacobian_evaluations", 0))
        )

    def _timed(self, sim: Simulation, window: Window, stretch: float) -> tuple[float, dict[str, float]]:
        """Time from a window's start over a stretch (s), and what the integrator did there."""
        sim.set_state(window.state, float(window.times[0]))
        before = sim.statistics
        after = timed_run(sim, stretch / TURN, stretch)
        return after["cpu"], {name: after[name] - value for name, value in before.items() if not isinstance(value, str)}

    def peer(
        self, window: Window, factor: float, stretch: float, count: bool, *, run: Callable[..., solvers.Run]
    ) -> solvers.Run:
        """An alternative over a stretch; its path over the window."""
        given = scaled(factor)
        absolute = np.array([given.atol_position, given.atol_angle, given.atol_velocity, given.atol_spin])
        tolerances = solvers.Tolerances(np.where(self.kinds >= 2, given.rtol, 0.0), absolute[self.kinds])
        end = window.times[0] + stretch
        times = window.times if stretch <= LENGTH else np.append(window.times, end)
        problem = solvers.Problem(
            self.model, self.jacobian, window.state[: self.model.n_state], times, limit=120.0, count=count
        )
        found = run(problem, tolerances)
        return dataclasses.replace(found, cage=found.cage[:OUTPUTS])

    def error(self, window: Window, cage: Array) -> float:
        """Largest distance of the cage's centre from the reference over Cpr."""
        return float(np.hypot(*(cage - window.reference).T).max()) / self.play

    def pace(self, window: Window, stretch: float) -> float:
        """Time of the core over a stretch at the standard tolerances (s)."""
        sim = self.simulation(RunOptions().integrator, 1.0)
        spent = min(self._timed(sim, window, stretch)[0] for _ in range(3))
        self.paces.setdefault(stretch, []).append(spent)
        return spent

    def measure(self, method: Method) -> list[Point]:
        """Points of an integrator; times in units of the core's pace over the same stretch until `settle`."""
        points = []
        turns = method.stretch / TURN
        for factor in method.factors:
            errors, ratios, counts = [], [], []
            for index, window in enumerate(self.windows[: TIMED if method.slow else None]):
                if index >= TIMED:
                    errors.append(self.error(window, method.run(window, factor, LENGTH, False).cage))
                    continue
                spent = []
                for _ in range(self.repeats * method.repeats):
                    before = self.pace(window, method.stretch)
                    run = method.run(window, factor, method.stretch, index == 0)
                    spent.append(run.wall / min(before, self.pace(window, method.stretch)))
                errors.append(self.error(window, run.cage))
                ratios.append(float(np.median(spent)))
                counts.append((run.steps, run.evaluations, run.jacobians))
            steps, evaluations, jacobians = np.nanmean(counts, axis=0) / turns
            error = float(np.exp(np.mean(np.log(errors))))
            points.append(Point(factor, error, float(np.mean(ratios)), steps, evaluations, jacobians))
        return points

    def settle(self, points: list[Point]) -> None:
        """From units of the core's pace to seconds a turn."""
        for point in points:
            point.wall *= float(np.median(self.paces[TURN]))

    def check(self) -> float:
        """Largest difference of NumPy's rates from the core's over the forces that make them, at the windows' ends."""
        largest, n = 0.0, self.model.n_state
        geometry, cage = self.scene.bearing.geometry, self.scene.bearing.cage
        for window in self.windows:
            sim = self.simulation("erk", 1e-5)
            sim.set_state(window.state, float(window.times[0]))
            for _ in range(20):
                sim.step()
                vector, time = sim.state.vector, sim.time
                load = float(sim.contacts()["raceway_load"].sum(axis=2).max())
                roller = [1.0, 10.0, 1.0, 10.0, 10.0, *[load / geometry.roller_mass] * 3]
                roller += [1e-2 * load / geometry.roller_inertia_transverse] * 2 + [
                    1e-2 * load / geometry.roller_inertia_axial
                ]
                held = [1.0] * 3 + [10.0] * 3 + [load / cage.mass] * 3 + [1e-2 * load / cage.inertia_transverse] * 3
                scale = np.concatenate([np.tile(roller, self.model.constants.n_rollers), held])
                difference = np.abs(self.model.derivative(time, vector[:n]) - sim.derivative()[:n]) / scale
                largest = max(largest, float(difference.max()))
        return largest

    def costs(self) -> dict[str, float]:
        """Times of single evaluations (us), medians over the windows' starts."""
        numpy_us, jacobian_us, core_us = [], [], []
        for window in self.windows:
            time, state = float(window.times[0]), window.state
            sim, main = self.simulation("erk", 1e-5), state[: self.model.n_state]
            core_us.append(per_call(partial(sim._core.derivative, time, state)))
            numpy_us.append(per_call(partial(self.model.derivative, time, main)))
            jacobian_us.append(per_call(partial(self.jacobian.sparse, time, main)))
        return {
            "numpy": float(np.median(numpy_us)),
            "jacobian": float(np.median(jacobian_us)),
            "core": float(np.median(core_us)),
        }


def per_call(function: Callable[[], Any]) -> float:
    """Processor time of a call (us)."""
    spent = []
    for _ in range(9):
        count, began = 0, clock.process_time()
        while clock.process_time() - began < 0.01:
            function()
            count += 1
        spent.append((clock.process_time() - began) / count)
    return 1e6 * float(np.median(spent))
