"""Against what a user would pick instead: the same force model in NumPy under SciPy's and scikit-sundae's integrators.

The model (`numpy_model`) is checked against the core, then a whirling, colliding cage (30310, 4930 N, 3000 rpm) is run from
mid-collision states over short windows, at several tolerances, by every alternative and by the core. The error is the largest
distance of the cage's centre from a reference of the core's explicit method at far tighter tolerances, in units of the radial
play Cpr, as a geometric mean over the windows. `ratio` is an alternative's time over that of the core's standard integrator at
equal error: the error of accuracy="standard", both interpolated in log-log; `ratio_low` and `ratio_high` are the least and the
largest of it from a third to three times that error.

Times are of the processor, so that other processes count little, and each is put in relation to a run of the core just before
and after it. Alternatives integrate the state without its tail (spin angles, energies), which spares them something.
"""

from __future__ import annotations

import argparse
import importlib.util
import math
import sys
import time as clock
import typing
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

import common
import numpy as np
from numpy.typing import NDArray
from numpy_model import Jacobian, NumpyModel, floor, solvers

from trbdyn import Effects, RunOptions, Scene, Simulation, Start
from trbdyn.cases import scene_30310
from trbdyn.run_options import ACCURACY, Tolerances

Array = NDArray[np.float64]

SPEED_RPM, AXIAL_LOAD = 3000.0, 4930.0
SETTLING, BETWEEN, LENGTH, OUTPUTS = 0.04, 0.0113, 4e-3, 41
IMPACT = 20.0
"""Windows: first and later starts (s), length (s), number of compared times, pocket force at which they start (N)."""

EXACT = ", exact"
"""Behind an integrator's name: without tangents of the rings' forces."""

COLUMNS = {
    "name": "1: integrator, with the package it comes from",
    "model": "1: force model under it, 'numpy' or 'core'",
    "ratio": "1: its time over that of the core at equal error",
    "ratio_low": "1: least ratio at errors from a third to three times as large",
    "ratio_high": "1: largest ratio at errors from a third to three times as large",
    "us_per_evaluation": "us: time of one force evaluation",
    "us_per_jacobian": "us: time of one Jacobian; null where the integrator's own times are not known",
    "us_per_step": "us: time of the whole integration over its steps",
    "wall_s_per_revolution": "s: time per turn of the shaft at the error compared",
    "error_cage_over_cpr": "1: error of the cage's centre over Cpr at which it is compared",
    "steps": "1: steps per turn of the shaft at the error compared",
    "evaluations": "1: force evaluations per turn of the shaft, without those for Jacobians",
    "jacobians": "1: Jacobians per turn of the shaft",
    "points": "1: every tolerance measured: factor on the tolerances of 'standard', and the quantities above",
    "failure": "1: why it could not be measured, or null",
    "target_error_over_cpr": "1: error of accuracy='standard' of the core, at which ratios are taken",
    "best_alternative": "1: alternative with the smallest ratio",
    "best_ratio": "1: smallest ratio of the alternatives",
    "us_per_evaluation_numpy": "us: one force evaluation in NumPy, median over states of the windows",
    "us_per_evaluation_core": "us: one force evaluation of the core, called from Python",
    "difference_of_rates": "1: largest difference of NumPy's rates from the core's, over the forces that make them",
    "error_of_reference_over_cpr": "1: distance between the reference and one at tolerances ten times as large",
    "impacts": "1: contacts of rollers and cage that begin, per window",
    "floor": "estimate: operations of a force evaluation over measured rates; see numpy_model/floor.py",
}


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
    """An integrator, the factors on the standard tolerances at which it is measured, and how often a short run is."""

    name: str
    model: str
    run: Callable[[Window, float], solvers.Run]
    factors: Sequence[float]
    repeats: int = 1


def at_error(points: Sequence[tuple[float, float]], error: float) -> float:
    """Value at an error, from (error, value) by log-log interpolation between points that no other beats in both; that of the
    nearest point beyond the ends.
    """
    kept: list[tuple[float, float]] = []
    for point in sorted(points):
        if not kept or point[1] < kept[-1][1]:
            kept.append(point)
    errors, values = np.log(np.array(kept)).T
    return float(np.exp(np.interp(math.log(error), errors, values)))


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
        effects = Effects.paper()
        if options.gauss is not None:
            effects = effects.replace(quadrature="gauss", n_slices=options.gauss)
        self.scene: Scene = scene_30310(SPEED_RPM, AXIAL_LOAD, start=Start.whirl(0.9), effects=effects)
        self.play = self.scene.bearing.cage.play_radial
        self.turns = LENGTH * SPEED_RPM / 60.0
        self.repeats = 1 if options.quick else 3
        self.model = NumpyModel(self.scene)
        self.jacobian = Jacobian(self.model)
        self.kinds = kinds(self.model)
        self.simulations: dict[tuple[str, float], Simulation] = {}
        self.paces: list[float] = []
        self.windows = self._windows(3 if options.quick else 5)

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

    def core(self, window: Window, factor: float, integrator: str) -> solvers.Run:
        """The core over a window: a run with records for the error, then one that only steps for the time."""
        path, sim = self._core_run(window, factor, integrator)
        sim.set_state(window.state, float(window.times[0]))
        before, end = sim.statistics, float(window.times[-1])
        began = clock.process_time()
        while sim.time < end:
            sim.step()
        wall = clock.process_time() - began
        did = {name: value - before[name] for name, value in sim.statistics.items()}
        return solvers.Run(
            path, wall, int(did["steps"]), int(did["rhs_evaluations"]), int(did.get("jacobian_evaluations", 0))
        )

    def peer(self, window: Window, factor: float, run: Callable[..., solvers.Run]) -> solvers.Run:
        """An alternative over a window."""
        given = scaled(factor)
        absolute = np.array([given.atol_position, given.atol_angle, given.atol_velocity, given.atol_spin])
        tolerances = solvers.Tolerances(np.where(self.kinds >= 2, given.rtol, 0.0), absolute[self.kinds])
        problem = solvers.Problem(
            self.model, self.jacobian, window.state[: self.model.n_state], window.times, limit=60.0
        )
        return run(problem, tolerances)

    def error(self, window: Window, cage: Array) -> float:
        """Largest distance of the cage's centre from the reference over Cpr."""
        return float(np.hypot(*(cage - window.reference).T).max()) / self.play

    def pace(self) -> float:
        """Time of the core over the first window at the standard tolerances (s)."""
        sim, window = self.simulation(RunOptions().integrator, 1.0), self.windows[0]
        spent = []
        for _ in range(3):
            sim.set_state(window.state, float(window.times[0]))
            began = clock.process_time()
            while sim.time < window.times[-1]:
                sim.step()
            spent.append(clock.process_time() - began)
        self.paces.append(float(np.median(spent)))
        return self.paces[-1]

    def measure(self, method: Method) -> list[Point]:
        """Points of an integrator; times in units of the core's pace until `settle`."""
        points = []
        for factor in method.factors:
            errors, walls, counts = [], [], []
            for window in self.windows:
                spent = []
                for _ in range(self.repeats * method.repeats):
                    before = self.pace()
                    run = method.run(window, factor)
                    spent.append(run.wall / (0.5 * (before + self.pace())))
                errors.append(self.error(window, run.cage))
                walls.append(float(np.median(spent)))
                counts.append((run.steps, run.evaluations, run.jacobians))
            steps, evaluations, jacobians = np.mean(counts, axis=0) / self.turns
            error = float(np.exp(np.mean(np.log(errors))))
            points.append(Point(factor, error, float(np.mean(walls)) / self.turns, steps, evaluations, jacobians))
        return points

    def settle(self, points: list[Point]) -> None:
        """From units of the core's pace to seconds."""
        for point in points:
            point.wall *= float(np.median(self.paces))

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


def methods(bench: Bench, quick: bool) -> list[Method]:
    """The core's integrators, the standard one first, then the alternatives."""
    standard = RunOptions().integrator
    own = [standard, standard + EXACT, *(name for name in _integrators() if name != standard)]
    out = []
    for name in own:
        explicit = name == "erk"
        factors = [10.0, 1.0, 0.1] if explicit else [30.0, 10.0, 3.0, 1.0, 0.3, 0.1]
        run_core = partial(bench.core, integrator=name)
        out.append(Method(f"trbdyn {name}", "core", run_core, factors, 1 if explicit else 3))
    peers: list[tuple[str, Callable[..., solvers.Run], list[float]]] = [
        ("SciPy Radau", solvers.radau, [30.0, 3.0, 1.0]),
        ("SciPy BDF", solvers.bdf, [10.0, 3.0, 1.0]),
        ("SciPy BDF, order 2", solvers.bdf_two, [10.0, 3.0, 1.0]),
        ("SciPy LSODA", solvers.lsoda, [30.0, 10.0, 3.0]),
        ("SciPy LSODA, order 2", solvers.lsoda_two, [30.0, 10.0, 3.0]),
    ]
    if importlib.util.find_spec("sksundae") is None:
        print("scikit-sundae is not installed (pip install scikit-sundae): its CVODE is left out")
    else:
        peers.append(("scikit-sundae CVODE", solvers.sundae, [10.0, 3.0, 1.0, 0.3]))
        peers.append(("scikit-sundae CVODE, its differences", solvers.sundae_pattern, [10.0, 3.0, 1.0]))
        if not quick:
            peers.append(("scikit-sundae CVODE, dense", solvers.sundae_dense, [10.0, 3.0, 1.0, 0.3]))
    for name, run_peer, factors in peers:
        more = factors if quick else sorted({100.0, *factors, 0.3, 0.1}, reverse=True)
        out.append(Method(name, "numpy", partial(bench.peer, run=run_peer), more))
    return out


def _integrators() -> tuple[str, ...]:
    return typing.get_args(RunOptions.model_fields["integrator"].annotation)


def compared(points: list[Point], own: list[Point], target: float) -> dict[str, float]:
    """An integrator at the error at which it is compared with the core."""

    def curve(which: list[Point], name: str) -> list[tuple[float, float]]:
        return [(point.error, getattr(point, name)) for point in which]

    def within(error: float) -> float:
        low = max(min(p.error for p in points), min(p.error for p in own))
        high = min(max(p.error for p in points), max(p.error for p in own))
        return min(max(error, low), max(high, low))

    def ratio(error: float) -> float:
        return at_error(curve(points, "wall"), within(error)) / at_error(curve(own, "wall"), within(error))

    near = [ratio(target * part) for part in np.geomspace(1.0 / 3.0, 3.0, 9)]
    wall = at_error(curve(points, "wall"), within(target))
    # counts belong to the time: those of the points between which it lies
    order = sorted(points, key=lambda point: point.wall)

    def beside(name: str) -> float:
        return float(np.interp(math.log(wall), [math.log(p.wall) for p in order], [getattr(p, name) for p in order]))

    return {
        "ratio": ratio(target),
        "ratio_low": min(near),
        "ratio_high": max(near),
        "wall_s_per_revolution": wall,
        "error_cage_over_cpr": within(target),
        "steps": beside("steps"),
        "evaluations": beside("evaluations"),
        "jacobians": beside("jacobians"),
        "us_per_step": 1e6 * wall / beside("steps"),
    }


def least(bench: Bench, row: dict[str, Any], us: float) -> dict[str, Any]:
    """The floor of a force evaluation, and of a turn of the shaft with the steps of the core. An estimate."""
    rates, nodes = floor.measure(), 2 * bench.model.constants.n_rollers * bench.model.constants.n_nodes
    rollers = bench.model.constants.n_rollers
    evaluation = 1e-3 * (nodes * rates.of(floor.NODE) + rollers * rates.of(floor.ROLLER))
    turn = evaluation * row["evaluations"]
    return {
        "estimate": True,
        "rates": rates.how,
        "ns_per_operation": rates.nanoseconds,
        "operations_per_node": floor.totals(floor.NODE),
        "operations_per_roller": floor.totals(floor.ROLLER),
        "nodes": nodes,
        "ns_per_node": rates.of(floor.NODE),
        "us_per_evaluation": evaluation,
        "core_over_floor": us / evaluation,
        "wall_s_per_revolution": 1e-6 * turn,
        "text": "all nodes and rollers at the rates of long loops; a turn: as many evaluations as the core's standard integrator "
        "makes, without Jacobians and linear algebra",
    }


def draw(rows: list[dict[str, Any]], summary: dict[str, Any]) -> None:
    """Time against error, and times of a force evaluation."""
    plt = common.pyplot()
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(12.0, 6.0), width_ratios=[2.2, 1.0], constrained_layout=True
    )  # fmt: skip
    colours = plt.get_cmap("tab10").colors
    for index, row in enumerate(rows):
        own = row["model"] == "core"
        points = sorted(row["points"], key=lambda point: point["error"])
        if not points:
            continue
        text = row["name"] if row["ratio"] is None else f"{row['name']}: {row['ratio']:.3g}"
        left.loglog(
            [point["error"] for point in points],
            [point["wall"] for point in points],
            marker="o" if own else "s",
            linestyle="-" if own else "--",
            linewidth=2.2 if own else 1.2,
            markersize=6 if own else 4.5,
            color=colours[index % 10],
            label=text,
        )
    target = summary["target_error_over_cpr"]
    left.axvline(target, color="0.7", linewidth=1.0, zorder=0)
    left.plot(
        target,
        summary["floor"]["wall_s_per_revolution"],
        marker="v",
        color="0.3",
        linestyle="none",
        label="floor, estimate",
    )
    left.annotate(
        "error of accuracy='standard'",
        (target, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(3, -11),
        textcoords="offset points",
        fontsize=8,
        color="0.4",
    )
    left.set_xlabel("error of the cage's centre, in units of Cpr")
    left.set_ylabel("time per turn of the shaft, s")
    left.set_title(f"Whirling, colliding cage, {AXIAL_LOAD:g} N, {SPEED_RPM:g} rpm")
    left.grid(True, which="major", color="0.9")
    left.margins(y=0.12)
    handles, texts = left.get_legend_handles_labels()
    figure.legend(
        handles,
        texts,
        title="with the ratio of times at equal error",
        ncols=5,
        fontsize=8,
        title_fontsize=8,
        loc="outside lower center",
    )
    names = ["NumPy", "core", "floor,\nestimate"]
    values = [
        summary["us_per_evaluation_numpy"],
        summary["us_per_evaluation_core"],
        summary["floor"]["us_per_evaluation"],
    ]
    bars = right.bar(names, values, color=["tab:orange", "tab:blue", "0.6"])
    right.bar_label(bars, [f"{value:.3g}" for value in values])
    right.set_yscale("log")
    right.set_ylim(0.5 * min(values), 2.0 * max(values))
    right.set_ylabel("time of a force evaluation, us")
    right.set_title("One force evaluation")
    common.save_picture(figure, "peers")
    plt.close(figure)


def main(arguments: Sequence[str] | None = None) -> dict[str, Any]:
    """Run the benchmark."""
    parser = common.parser(__doc__)
    parser.add_argument(
        "--gauss", type=int, metavar="N", help="N Gauss nodes along a contact for all, in place of slices"
    )
    options = parser.parse_args(arguments)
    report = common.Report("peers", options, COLUMNS)
    bench = Bench(options)
    difference = bench.check()
    print(f"NumPy's rates differ from the core's by {difference:.1e} of the forces that make them")
    if difference > 1e-9:
        raise SystemExit("the NumPy model does not give what the core gives")
    measured: list[tuple[Method, list[Point], str | None]] = []
    for method in methods(bench, options.quick):
        points: list[Point] = []
        failure = None
        began = clock.perf_counter()
        try:
            points = bench.measure(method)
        except Exception as error:
            failure = f"{type(error).__name__}: {error}"
        measured.append((method, points, failure))
        print(f"  {method.name:28s} {clock.perf_counter() - began:6.1f} s  {failure or ''}", flush=True)
    costs = bench.costs()
    own = measured[0][1]
    if not own:
        raise SystemExit(f"the core could not be measured: {measured[0][2]}")
    target = next(point.error for point in own if point.factor == 1.0)
    for method, points, failure in measured:
        bench.settle(points)
        row: dict[str, Any] = dict.fromkeys(
            ("ratio", "ratio_low", "ratio_high", "wall_s_per_revolution", "error_cage_over_cpr", "steps", "evaluations",
             "jacobians", "us_per_step", "us_per_jacobian")
        )  # fmt: skip
        if points:
            row |= compared(points, own, target)
        row["us_per_evaluation"] = costs[method.model]
        if method.model == "numpy":
            row["us_per_jacobian"] = costs["jacobian"]
        listed = [vars(point) for point in points]
        report.add(name=method.name, model=method.model, points=listed, failure=failure, **row)

    peers = [row for row in report.results if row["model"] == "numpy" and row["ratio"] is not None]
    best = min(peers, key=lambda row: row["ratio"], default=None)
    report.summary = {
        "target_error_over_cpr": target,
        "best_alternative": None if best is None else best["name"],
        "best_ratio": None if best is None else best["ratio"],
        "us_per_evaluation_numpy": costs["numpy"],
        "us_per_evaluation_core": costs["core"],
        "us_per_jacobian": costs["jacobian"],
        "difference_of_rates": difference,
        "error_of_reference_over_cpr": max(window.uncertainty for window in bench.windows),
        "impacts": [window.impacts for window in bench.windows],
        "floor": least(bench, report.results[0], costs["core"]),
    }
    report.inputs = {
        "scene": f"30310, {SPEED_RPM:g} rpm, {AXIAL_LOAD:g} N, effects of the paper, cage whirling at 0.9 Cpr",
        "nodes": f"{bench.scene.effects.n_slices} {bench.scene.effects.quadrature}",
        "windows": [float(window.times[0]) for window in bench.windows],
        "window_s": LENGTH,
        "standard_tolerances": ACCURACY["standard"].model_dump(),
        "instruction_set": Simulation(bench.scene).instruction_set,
        "scikit_sundae": _version("sksundae"),
    }
    report.notes = [
        "LSODA takes a dense Jacobian only; solve_ivp does not hand on its limits of order: 'order 2' goes around it.",
        "SciPy's BDF has no limit of order: 'order 2' changes a private constant while it steps.",
        "Radau, BDF and scikit-sundae take one relative tolerance for all entries, LSODA one for each.",
        "Alternatives have the Jacobian in one batched call (24 states), sparse where the package takes it; 'its differences' "
        "has what the package offers alone.",
        "trbdyn's bdf takes forces of raceways and ribs from tangents between exact evaluations; 'exact' does not.",
    ]
    shown = ["name", "ratio", "ratio_low", "ratio_high", "us_per_evaluation", "us_per_step", "wall_s_per_revolution",
             "error_cage_over_cpr", "steps", "evaluations", "jacobians"]  # fmt: skip
    print(common.table(report.results, shown))
    bottom = report.summary["floor"]
    print(
        f"a force evaluation: NumPy {costs['numpy']:.0f} us, core {costs['core']:.1f} us, floor "
        f"{bottom['us_per_evaluation']:.1f} us (estimate: {bottom['nodes']} nodes of {bottom['ns_per_node']:.1f} ns, "
        f"{bottom['rates']} rates)"
    )
    if best is not None:
        print(f"best alternative: {best['name']}, {best['ratio']:.1f} times the core's time at equal error")
    if not options.no_picture:
        draw(report.results, report.summary)
    return report.finish()


def _version(package: str) -> str | None:
    if importlib.util.find_spec(package) is None:
        return None
    version: str = __import__(package).__version__
    return version


if __name__ == "__main__":
    main()
