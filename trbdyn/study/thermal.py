"""The temperatures at which a bearing makes as much heat as it gives off: losses of runs, and a network of four nodes."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.stats import qmc

from trbdyn.base.expected import expect
from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import InputError, TrbError
from trbdyn.model.growth import Growth
from trbdyn.model.heat import CONDUCTANCES, FACTOR, PARTS, HeatPaths
from trbdyn.model.lubricants import LOWEST_MEASURED_C, LOWEST_TEMPERATURE_C
from trbdyn.model.motion import is_constant, value_at
from trbdyn.model.scene import Scene
from trbdyn.run.options import RunOptions
from trbdyn.study.definition import Base
from trbdyn.study.heat_network import LossCurves, film_temperature, heat_of, network, rise
from trbdyn.study.runner import run as run_study
from trbdyn.study.settled import TURNS, drift, short_run, stored

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

CLOSE: Final = 2e-3
"""How near the film's temperature of network and run are in the end (K)."""
HOTTEST: Final = 180.0
"""Films hotter than this are not looked for (C)."""
SETTLED: Final = 0.01
"""Change of the torque that may still come, and share of the power that is not lost, at the end of each run."""
ROUGH: Final = 0.05
"""The same for runs that only tell on which side of the balance their temperature lies."""
CURVE: Final = 7
"""Temperatures at which losses are computed for the bands."""
DRAWS: Final = 512
"""Draws of conductances; each costs nothing but the solution of the network."""


@dataclass(frozen=True, repr=False)
class Thermal(Displayed):
    """A bearing in thermal balance; print it for a table.

    Attributes
    ----------
    temperatures : dict of str to float
        Of the nodes `trbdyn.model.heat.PARTS` and of films, ``film`` (C).
    bands : dict of str to tuple
        Where 95 % of the draws of the conductances lie (C), by the same names, and of ``power`` (W).
    losses : dict of str to float
        Power by mechanism at these temperatures (W).
    flows : dict of str to float
        Heat that leaves each node to the outside (W).
    balance : float
        Heat that leaves over the power that is lost, less 1.
    scene : Scene
        The scene at these temperatures.
    known : dict of float to dict
        Power by mechanism (W), by the temperatures of films that were run (C).
    paths : HeatPaths
        The network.
    """

    temperatures: dict[str, float]
    bands: dict[str, tuple[float, float]]
    losses: dict[str, float]
    flows: dict[str, float]
    balance: float
    scene: Scene
    known: dict[float, dict[str, float]]
    paths: HeatPaths

    @property
    def power(self) -> float:
        """Power that is lost (W)."""
        return sum(self.losses.values())

    @property
    def curve(self) -> Array:
        """Temperatures of films that were run (C), and power that is lost (W), shape (n, 2)."""
        return np.array(sorted((t, sum(found.values())) for t, found in self.known.items()))

    def warming(self, heat_capacities: Mapping[str, float], duration: float, *, points: int = 200) -> xarray.Dataset:
        """How the parts warm up in slow time, from the temperatures that they have without losses.

        The motion follows the temperature at once, as it settles within some turns: losses are those of the runs, between
        them by interpolation.

        Parameters
        ----------
        heat_capacities : mapping of str to float
            Mass times specific heat of each node, outer_ring, inner_ring, rollers and oil (J/K); 460 J/kgK for steel, 2000 J/kgK
            for oil.
        duration : float
            How long (s).
        points : int
            Number of times in the result.

        Returns
        -------
        xarray.Dataset
            ``temperature`` (C) by time and part, and ``power`` (W) by time.

        Raises
        ------
        InputError
            If a number is missing or not allowed.
        """
        ribs = self.scene.bearing.ribs
        return rise(self.paths, LossCurves(self.known), heat_capacities, duration, points, ribs=ribs)

    def picture(self, path: str | os.PathLike[str] | None = None, *, overwrite: bool = False) -> Any:
        """Draw the balance of heat made and given off, and the temperatures with their bands.

        Parameters
        ----------
        path : path-like, optional
            Where to save the picture.
        overwrite : bool
            Replace a file that is there.

        Returns
        -------
        Figure
            The matplotlib figure.
        """
        from trbdyn.plot.heat import draw_balance
        from trbdyn.plot.style import kept

        return kept(draw_balance(self), path, overwrite=overwrite)

    def __str__(self) -> str:
        return self._shown().text(names=True)

    def __repr__(self) -> str:
        return str(self)

    def _shown(self) -> Shown:
        rows = []
        for name, value in self.temperatures.items():
            low, high = self.bands[name]
            out = f"{self.flows[name]:.4g} W" if name in self.flows else ""
            rows.append((name.replace("_", " "), f"{value:.4g} C", f"{low:.3g} to {high:.3g} C", out))
        low, high = self.bands["power"]
        rows.append(("power that is lost", f"{self.power:.4g} W", f"{low:.3g} to {high:.3g} W", ""))
        note = (
            f"Heat that leaves is {100.0 * self.balance:+.2g} % off the power that is lost; {len(self.known)} temperatures "
            "were run."
        )
        return Shown(
            f"Thermal balance: {self.scene._title()}",
            tuple(rows),
            ("part", "value", "95 % of the draws", "gives off"),
            (
                note,
                f"Drawn are conductances, each from a third to three times ({FACTOR:g}); temperatures outside are as given.",
            ),
        )


def thermal(
    scene: Scene,
    paths: HeatPaths,
    *,
    options: RunOptions | None = None,
    seed: int = 0,
    folder: str | os.PathLike[str] | None = None,
    executor: Any = "threads",
    workers: int | None = None,
) -> Thermal:
    """The temperatures at which a bearing gives off as much heat as it makes.

    Losses come from runs, each until they stand as in `trbdyn.torque_map`; heat goes through a network of four nodes. The
    temperature of films, the mean of rings and rollers, is the oil's in the run; where the scene has a `Growth`, its parts
    get the temperatures of the nodes, which change the plays of the pockets. The film's temperature is found by bracketing, as
    plain iteration of run and network can swing.

    Parameters
    ----------
    scene : Scene
        What is simulated; speed and loads must be constant, and its lubricant an oil that is known at other temperatures.
    paths : HeatPaths
        Conductances and temperatures outside.
    options : RunOptions, optional
        Accuracy and settings of each run, not its length; 'fast' by default.
    seed : int
        Seed of the draws of conductances.
    folder, executor, workers : optional
        As in `trbdyn.study.run`; the runs of the bands go side by side.

    Returns
    -------
    Thermal

    Raises
    ------
    InputError
        If an argument cannot be used, or films would be hotter than 180 C.
    TrbError
        If a run fails, or its losses do not stand after 32 turns.

    Notes
    -----
    What is left out: the clearance of the bearing (a given load sets the ring's place, whatever grows), heat that one
    film gets from another. docs/theory/heat.md.

    Examples
    --------
    >>> import trbdyn as trb
    >>> paths = trb.HeatPaths.reference(bore=0.050, outside=0.110, width=0.02925, oil_flow=15.0, oil_inlet_c=40.0)
    >>> found = trb.thermal(trb.cases.scene_30310(), paths)
    >>> abs(found.balance) < 1e-3
    True
    """
    expect("scene", scene, Scene)
    expect("paths", paths, HeatPaths)
    if scene.lubricant.oil is None:
        raise InputError.of("lubricant.oil", None, "must be given: heat changes the temperature of the lubricant")
    if not all(is_constant(quantity) for quantity in scene.ring_quantities().values()):
        raise InputError.of("scene", "speed or loads", "must be constant in time")
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise InputError.of("seed", seed, "must be a whole number, at least 0")
    runs = _Runs(scene, RunOptions(accuracy="fast") if options is None else options, folder, executor, workers)
    nodes = _balanced(runs, paths)
    film = film_temperature(nodes)
    losses, flows = runs.losses(film, nodes), {}
    for name, (conductance, outside) in paths.outer_links.items():
        flows[name] = conductance * (nodes[name] - outside)
    bands = _bands(runs, paths, film, int(seed))
    balance = sum(flows.values()) / sum(losses.values()) - 1.0
    return Thermal(
        {**nodes, "film": film}, bands, losses, flows, balance, runs.scene_at(film, nodes), dict(runs.known), paths
    )


def _balanced(runs: _Runs, paths: HeatPaths) -> dict[str, float]:
    """Temperatures of the nodes whose films make as much heat as the network gives off."""
    nodes: dict[str, float] = {}

    def excess(film: float, losses: Callable[[float, Mapping[str, float]], dict[str, float]] = runs.losses) -> float:
        nonlocal nodes
        nodes = network(paths, heat_of(losses(film, nodes), paths.oil_share, runs.scene.bearing.ribs))
        return film_temperature(nodes) - film

    low = max(film_temperature(network(paths, dict.fromkeys(PARTS, 0.0))), runs.coldest)
    if excess(low) <= 0.0:
        raise InputError.of("paths", low, "temperatures outside lie below what the oil is known at (C)")
    high = min(low + 30.0, HOTTEST)
    while excess(high, runs.roughly) > 0.0:
        if high >= HOTTEST:
            limit = f"would make films hotter than {HOTTEST:g} C: the conductances are too small for these losses (W/K)"
            raise InputError.of("paths", "conductances", limit)
        low, high = high, min(high + 30.0, HOTTEST)
    excess(float(brentq(lambda film: excess(film, runs.roughly), low, high, xtol=CLOSE, rtol=1e-6)))
    return nodes


def _bands(runs: _Runs, paths: HeatPaths, film: float, seed: int) -> dict[str, tuple[float, float]]:
    """Bands of temperatures and power from draws of all conductances; losses between the runs are interpolated."""
    names = [name for name in CONDUCTANCES if getattr(paths, name) > 0.0]
    coldest = film_temperature(network(paths, dict.fromkeys(PARTS, 0.0)))
    grid = np.linspace(max(coldest, runs.coldest), min(film + 1.2 * (film - coldest), HOTTEST), CURVE)
    runs.side_by_side(grid.tolist())
    curves = LossCurves(runs.known)
    known = curves.temperatures
    unit = qmc.Sobol(len(names) + 1, seed=seed).random(DRAWS)
    found: dict[str, list[float]] = {name: [] for name in (*PARTS, "film", "power")}
    for row in unit:
        changes = {name: getattr(paths, name) * FACTOR ** (2.0 * u - 1.0) for name, u in zip(names, row, strict=False)}
        drawn = paths.replace(**changes, oil_share=float(row[-1]))

        def nodes_at(t: float, drawn: HeatPaths = drawn) -> dict[str, float]:
            return network(drawn, heat_of(curves(t), drawn.oil_share, runs.scene.bearing.ribs))

        def excess(t: float) -> float:
            return film_temperature(nodes_at(t)) - t

        if excess(known[-1]) > 0.0:  # hotter than the runs go: the band ends there
            t = float(known[-1])
        else:
            t = float(brentq(excess, known[0], known[-1], xtol=1e-3)) if excess(known[0]) > 0.0 else float(known[0])
        nodes = nodes_at(t)
        for name, value in {**nodes, "film": t, "power": sum(curves(t).values())}.items():
            found[name].append(value)
    return {name: tuple(np.quantile(values, [0.025, 0.975]).tolist()) for name, values in found.items()}


@dataclass
class _Runs:
    """Losses of a scene at temperatures of its films."""

    scene: Scene
    options: RunOptions
    folder: str | os.PathLike[str] | None
    executor: Any
    workers: int | None
    known: dict[float, dict[str, float]] = field(default_factory=dict)
    rough: dict[float, dict[str, float]] = field(default_factory=dict)

    @property
    def coldest(self) -> float:
        """Below this the oil is not known (C)."""
        oil = self.scene.lubricant.oil
        return LOWEST_TEMPERATURE_C if oil is not None and oil.vogel is None else LOWEST_MEASURED_C

    def scene_at(self, film: float, nodes: Mapping[str, float]) -> Scene:
        """The scene with its films, and the parts that grow, at their temperatures."""
        growth, changes = self.scene.growth, {}
        if growth is not None and nodes:
            changes["growth"] = Growth(
                cage_c=nodes["rollers"],
                rollers_c=nodes["rollers"],
                inner_ring_c=nodes["inner_ring"],
                outer_ring_c=nodes["outer_ring"],
                reference_c=growth.reference_c,
                centrifugal=growth.centrifugal,
            )
        warm = cast(Scene, Base.of(self.scene).build({"lubricant.temperature_c": film})[0])
        return warm.replace(**changes) if changes else warm

    def losses(self, film: float, nodes: Mapping[str, float]) -> dict[str, float]:
        """Power by mechanism (W)."""
        if film not in self.known:
            self._run({film: self.scene_at(film, nodes)})
        return self.known[film]

    def roughly(self, film: float, nodes: Mapping[str, float]) -> dict[str, float]:
        """The same, good enough to tell on which side of the balance it lies: also where the losses scatter by `ROUGH`."""
        if film not in self.known and film not in self.rough:
            self._run({film: self.scene_at(film, nodes)}, ROUGH)
        return self.known[film] if film in self.known else self.rough[film]

    def side_by_side(self, films: list[float]) -> None:
        self._run({film: self.scene_at(film, {}) for film in films if film not in self.known})

    def _run(self, waiting: dict[float, Scene], within: float = SETTLED) -> None:
        speed = value_at(self.scene.speed_rpm, 0.0)
        for turns in TURNS:
            run = short_run(self.options, speed, turns)
            data = run_study(
                [(scene, run) for scene in waiting.values()],
                self.folder,
                executor=self.executor,
                workers=self.workers,
                observables={"drift": drift, "stored": stored},
            )
            left, last = {}, turns == TURNS[-1]
            for k, (film, scene) in enumerate(waiting.items()):
                one = data.isel(case=k)
                if str(one["status"].values) != "done":
                    raise TrbError(f"the run at {film:.4g} C failed: {one['message'].values}")
                moves = max(float(one["drift"]), float(one["stored"]))
                if moves <= SETTLED:
                    self.known[film] = _losses(one)
                elif last and moves <= within:
                    self.rough[film] = _losses(one)
                else:
                    left[film] = scene
            waiting = left
            if not waiting:
                return
        film = next(iter(waiting))
        raise TrbError(
            f"the losses at {film:.4g} C do not stand after {TURNS[-1]:g} turns, within {100.0 * SETTLED:g} %"
        )


def _losses(run: Any) -> dict[str, float]:
    """Power by mechanism (W) of a run in a dataset; without that of a free ring's damping, which heats the surroundings."""
    prefix = "power_split_"
    found = {str(name)[len(prefix) :]: float(run[name]) for name in run.data_vars if str(name).startswith(prefix)}
    found.pop("support", None)
    return found
