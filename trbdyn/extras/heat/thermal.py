"""The temperatures at which a bearing makes as much heat as it gives off: losses of runs, and a network of four nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Unpack, overload

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.stats import qmc

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown
from trbdyn.base.validation import whole_number_of
from trbdyn.errors import InputError, TrbError
from trbdyn.extras.heat.heat_network import LossCurves, film_temperature, heat_of, network, rise
from trbdyn.extras.heat.paths import CONDUCTANCES, FACTOR, PARTS, HeatPaths
from trbdyn.extras.heat.warm_balance import HOTTEST
from trbdyn.extras.study.answer import Answer
from trbdyn.extras.study.definition import Base, Case
from trbdyn.extras.study.runner import Running
from trbdyn.extras.study.settled import JUDGED, TURNS, run_until_settled, short_run
from trbdyn.model.assembly import Assembly, ShaftBearing, Subject
from trbdyn.model.growth import Growth
from trbdyn.model.lubricants import LOWEST_MEASURED_C, LOWEST_TEMPERATURE_C
from trbdyn.model.motion import is_constant, value_at
from trbdyn.model.scene import Scene
from trbdyn.model.start import Start
from trbdyn.run.options import RunOptions

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]
Films = tuple[float, ...]
"""Temperature of the films of each bearing (C)."""
Losses = dict[str, float]
"""Power by mechanism (W)."""

CLOSE: Final = 0.05
"""How near the film's temperature of network and run are in the end (K), beside what the error of the losses makes."""
FULL_RUNS: Final = 4
"""Most full runs."""
STEP: Final = 30.0
"""Step in which hotter films are tried (K)."""
SETTLED: Final = 0.01
"""Error of the torque, and share of the power that is not lost, from which on a run is long enough."""
ROUGH: Final = 0.02
"""The same for runs with a spacer."""
CURVE: Final = 5
"""Temperatures at which losses with a spacer are computed, for the search and for the bands each."""
DRAWS: Final = 512
"""Draws of conductances; each costs nothing but the solution of the network."""


@dataclass(frozen=True, repr=False)
class Thermal(Answer):
    """A bearing in thermal balance; print it for a table.

    Its picture shows the balance of heat made and given off, and the temperatures with their bands.

    Attributes
    ----------
    temperatures : dict of str to float
        Of the nodes `trbdyn.extras.heat.paths.PARTS` and of films, ``film`` (C).
    bands : dict of str to tuple
        Where 95 % of the draws of the conductances lie (C), by the same names, and of ``power`` (W).
    losses : dict of str to float
        Power by mechanism at these temperatures (W).
    flows : dict of str to float
        Heat that leaves each node to the outside (W).
    balance : float
        Heat that leaves over the power that is lost, less 1.
    scene : Scene or ShaftBearing
        The scene, or the bearing on its shaft, at these temperatures.
    known : dict of float to dict
        Power by mechanism (W), by the temperatures of films that were run (C): with the cage at the balance; else with a spacer
        in its place, times the ratio of both at the balance.
    paths : HeatPaths
        The network.
    title : str
        What it is the balance of, in words.
    power_error : float
        How far the power of the run may be off, over the power: two standard errors of its mean over turns of the cage, or what
        may still come (1).
    """

    temperatures: dict[str, float]
    bands: dict[str, tuple[float, float]]
    losses: dict[str, float]
    flows: dict[str, float]
    balance: float
    scene: Scene | ShaftBearing
    known: dict[float, dict[str, float]]
    paths: HeatPaths
    title: str
    power_error: float = 0.0

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

    def _draw(self) -> Any:
        from trbdyn.extras.heat.thermal_picture import draw_balance

        return draw_balance([self])

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
            f"were run. The power of the run is known within {100.0 * self.power_error:.2g} %"
            + ("." if self.power_error <= SETTLED else f", after {TURNS[-1]:g} turns; the bands have it in them.")
        )
        return Shown(
            f"Thermal balance: {self.title}",
            tuple(rows),
            ("part", "value", "95 % of the draws", "gives off"),
            (
                note,
                f"Drawn are conductances, each from a third to three times ({FACTOR:g}); temperatures outside are as given.",
            ),
        )


class AssemblyThermal(Mapping[str, Thermal], Answer):
    """Bearings on a shaft in thermal balance: a `Thermal` of each by its name; print it for a table.

    Its picture shows the balance of each bearing, one below the other.

    Parameters
    ----------
    bearings : mapping of str to Thermal
        The balances.
    """

    def __init__(self, bearings: Mapping[str, Thermal]) -> None:
        self._bearings = dict(bearings)

    def __getitem__(self, name: str) -> Thermal:
        return self._bearings[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._bearings)

    def __len__(self) -> int:
        return len(self._bearings)

    def _draw(self) -> Any:
        from trbdyn.extras.heat.thermal_picture import draw_balance

        return draw_balance(list(self.values()))

    def __str__(self) -> str:
        return "\n\n".join(map(str, self.values()))

    def _shown(self) -> Shown:
        return Shown("Thermal balance", parts=tuple(one._shown() for one in self.values()))


@overload
def thermal(
    subject: Scene,
    paths: HeatPaths,
    *,
    options: RunOptions | None = None,
    seed: int = 0,
    **how: Unpack[Running],
) -> Thermal: ...


@overload
def thermal(
    subject: Assembly,
    paths: HeatPaths | Mapping[str, HeatPaths],
    *,
    options: RunOptions | None = None,
    seed: int = 0,
    **how: Unpack[Running],
) -> AssemblyThermal: ...


def thermal(
    subject: Subject,
    paths: HeatPaths | Mapping[str, HeatPaths],
    *,
    options: RunOptions | None = None,
    seed: int = 0,
    **how: Unpack[Running],
) -> Thermal | AssemblyThermal:
    """Temperatures at which the heat flow out of a bearing, or of each bearing on a shaft, equals its losses.

    Losses come from runs, each until they are known within 1 % as in `trbdyn.torque_map`, or over 32 turns: then their error is
    stated and included in the bands. Heat goes through a network of four nodes. The temperature of films, the mean of rings
    and rollers, is the oil's in the run; where the scene has a `Growth`, its parts get those of the nodes, which change
    the plays of the pockets. Runs in which a spacer replaces the cage give limits of the films' temperature, full runs
    find it. Bearings on a shaft run together, each at the temperature of its own films.

    Parameters
    ----------
    subject : Scene or Assembly
        What is simulated; speed and loads must be constant, and the lubricant an oil that is known at other temperatures.
    paths : HeatPaths, or mapping of str to HeatPaths
        Conductances and temperatures outside; those of each bearing on a shaft by its name, or one for all. No heat goes from
        one bearing to another but through the temperatures outside that you give.
    options : RunOptions, optional
        Accuracy and settings of each run, not its length; 'fast' by default.
    seed : int
        Seed of the draws of conductances.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`. Those of the bands go side by side.

    Returns
    -------
    Thermal or AssemblyThermal
        Of several bearings one each, by name.

    Raises
    ------
    InputError
        If an argument cannot be used, or films would be hotter than 180 C.
    TrbError
        If a run fails.

    Notes
    -----
    What is left out: the clearance of the bearing (the ring takes the place at which it carries its load), heat that one
    film gets from another. docs/theory/heat.md.

    Examples
    --------
    >>> import trbdyn as trb
    >>> paths = trb.HeatPaths.reference(bore=0.050, outside=0.110, width=0.02925, oil_flow=15.0, oil_inlet_c=40.0)
    >>> found = trb.thermal(trb.cases.scene_30310(), paths)
    >>> abs(found.balance) < 1e-3
    True
    """
    expect("scene", subject, Scene, Assembly)
    own = own_paths(subject, paths)
    for prefix, part in subject.parts.items():
        if part.lubricant.oil is None:
            limit = "must be given: heat changes the temperature of the lubricant"
            raise InputError.of(f"{prefix}lubricant.oil", None, limit)
    if not all(is_constant(quantity) for quantity in subject.quantities().values()):
        raise InputError.of("scene", "speed or loads", "must be constant in time")
    seed = whole_number_of("seed", seed, 0)
    balance = _Balance(subject, own, RunOptions(accuracy="fast") if options is None else options, how)
    films = balance.found()
    losses, nodes = balance.losses(films), balance.nodes
    bands, at = balance.bands(films, seed), balance.subject_at(tuple(map(film_temperature, nodes)))
    found = {}
    for k, (name, part) in enumerate(zip(subject.names, _parts(at), strict=True)):
        flows = {end: g * (nodes[k][end] - outside) for end, (g, outside) in own[k].outer_links.items()}
        residual = sum(flows.values()) / sum(losses[k].values()) - 1.0
        title = f"{name}, {part.bearing.name}" if name else at.title
        found[name] = Thermal(
            {**nodes[k], "film": film_temperature(nodes[k])},
            bands[k],
            losses[k],
            flows,
            residual,
            part,
            balance.curve(k, films),
            own[k],
            title,
            balance.off[films],
        )
    return found[""] if "" in found else AssemblyThermal(found)


def _parts(subject: Subject) -> list[Scene | ShaftBearing]:
    return [*subject.parts.values()]


def own_paths(subject: Subject, paths: HeatPaths | Mapping[str, HeatPaths]) -> list[HeatPaths]:
    """The paths of each bearing."""
    if not isinstance(paths, Mapping):
        expect("paths", paths, HeatPaths)
        return [paths] * len(subject.names)
    if set(paths) != set(subject.names):
        limit = f"must be those of {', '.join(subject.names)}" if any(subject.names) else "must be a HeatPaths"
        raise InputError.of("paths", sorted(paths), limit)
    for name, own in paths.items():
        expect(f"paths.{name}", own, HeatPaths)
    return [paths[name] for name in subject.names]


@dataclass
class _Balance:
    """Losses of bearings at temperatures of their films, and the temperatures at which they balance.

    `cheap` holds losses of runs in which a spacer stands for the cage, which cost a tenth, by the films' temperatures; `known`
    those of the runs themselves, and `off` how far these may be off (1). Between them losses are those of the cheap runs, times
    the ratio that was found at the temperature of the last full run.
    """

    subject: Subject
    paths: list[HeatPaths]
    options: RunOptions
    how: Running
    known: dict[Films, list[Losses]] = field(default_factory=dict)
    off: dict[Films, float] = field(default_factory=dict)
    cheap: dict[Films, list[Losses]] = field(default_factory=dict)
    nodes: list[dict[str, float]] = field(default_factory=list)  # of each bearing (C), from the last losses

    def found(self) -> Films:
        """Temperatures of the films at which each network gives off what its bearing makes: bracketed with cheap runs, all
        bearings at the same time, and found with full runs at the temperature that the last one leads to.
        """
        cold = np.array([self.coldest(k) for k in range(len(self.paths))])
        ratios: list[Losses] = [{} for _ in self.paths]
        for k in np.flatnonzero(self._excess(cold, ratios) <= 0.0):
            raise InputError.of("paths", cold[k], "temperatures outside lie below what the oil is known at (C)")
        high = np.minimum(cold + STEP, HOTTEST)
        for _ in range(FULL_RUNS):
            high = self._bracket(high, ratios)
            self._grid(cold, high)
            film = np.array([self._root(k, one, cold[k], high[k]) for k, one in enumerate(ratios)])
            at = tuple(film.tolist())
            losses = self.losses(at)
            self.nodes = self._nodes(losses)
            away = np.abs(np.array([film_temperature(nodes) for nodes in self.nodes]) - film)
            if (away <= CLOSE + self.off[at] * (film - cold)).all():
                return at
            ratios = [_ratios(full, LossCurves(self._cheap(k))(film[k])) for k, full in enumerate(losses)]
        self.off[at] += float(np.max(away / (film - cold)))
        return at

    def _bracket(self, high: Array, ratios: Sequence[Losses]) -> Array:
        """Films (C) so hot that no bearing makes as much heat as it gives off there."""
        while (hotter := self._excess(high, ratios) > 0.0).any():
            if (high[hotter] >= HOTTEST).any():
                limit = (
                    f"would make films hotter than {HOTTEST:g} C: the conductances are too small for these losses (W/K)"
                )
                raise InputError.of("paths", "conductances", limit)
            high = np.where(hotter, np.minimum(high + STEP, HOTTEST), high)
        return high

    def _grid(self, cold: Array, high: Array) -> None:
        """Cheap runs at temperatures between, side by side."""
        grids = zip(
            *(np.linspace(one, other, CURVE).tolist() for one, other in zip(cold, high, strict=True)), strict=True
        )
        self._run([films for films in grids if films not in self.cheap], spacer=True)

    def _root(self, k: int, ratios: Losses, cold: float, high: float) -> float:
        """The temperature of a bearing's films at which its network gives off what its curve of losses makes (C)."""
        ribs, curve = _parts(self.subject)[k].bearing.ribs, self._curve(k, ratios)

        def excess(film: float) -> float:
            return film_temperature(network(self.paths[k], heat_of(curve(film), self.paths[k].oil_share, ribs))) - film

        return float(brentq(excess, cold, high, xtol=1e-4))

    def _curve(self, k: int, ratios: Losses) -> Callable[[float], Losses]:
        """Losses of a bearing over its films' temperature: those of cheap runs, times ratios."""
        curves = LossCurves(self._cheap(k))
        return lambda film: _times(curves(film), ratios)

    def _cheap(self, k: int) -> dict[float, Losses]:
        return {films[k]: losses[k] for films, losses in self.cheap.items()}

    def curve(self, k: int, films: Films) -> dict[float, Losses]:
        """Losses of a bearing by its films' temperature: those of the full run where it balances, and of the cheap runs, times
        the ratio between both there.
        """
        ratios = _ratios(self.known[films][k], LossCurves(self._cheap(k))(films[k]))
        at = self._curve(k, ratios)
        return {t: at(t) for t in self._cheap(k)} | {films[k]: self.known[films][k]}

    def coldest(self, k: int) -> float:
        """Films of a bearing that makes no heat, or the lowest temperature at which its oil is known (C)."""
        oil = _parts(self.subject)[k].lubricant.oil
        known = LOWEST_TEMPERATURE_C if oil is not None and oil.vogel is None else LOWEST_MEASURED_C
        return max(film_temperature(network(self.paths[k], dict.fromkeys(PARTS, 0.0))), known)

    def _excess(self, films: Array, ratios: Sequence[Losses]) -> Array:
        """How much hotter the films of each bearing become than they are (K), by the losses of cheap runs, times ratios."""
        at = tuple(films.tolist())
        if at not in self.cheap:
            self._run([at], spacer=True)
        found = self._nodes([_times(lost, own) for lost, own in zip(self.cheap[at], ratios, strict=True)])
        return np.array([film_temperature(nodes) for nodes in found]) - films

    def _nodes(self, losses: Sequence[Losses]) -> list[dict[str, float]]:
        """Temperatures of the parts of each bearing that has these losses."""
        parts = _parts(self.subject)
        return [
            network(paths, heat_of(lost, paths.oil_share, part.bearing.ribs))
            for paths, lost, part in zip(self.paths, losses, parts, strict=True)
        ]

    def subject_at(self, films: Films, nodes: Sequence[Mapping[str, float]] | None = None) -> Subject:
        """What is run with its films, and the parts that grow, at their temperatures."""
        given = self.nodes if nodes is None else nodes
        oils = {f"{prefix}lubricant.temperature_c": t for prefix, t in zip(self.subject.parts, films, strict=True)}
        warm, _ = Base.of(self.subject).build(oils)
        for prefix, part, own in zip(warm.parts, _parts(warm), given, strict=False):
            if part.growth is None:
                continue
            growth = Growth(
                cage_c=own["rollers"],
                rollers_c=own["rollers"],
                inner_ring_c=own["inner_ring"],
                outer_ring_c=own["outer_ring"],
                reference_c=part.growth.reference_c,
                centrifugal=part.growth.centrifugal,
            )
            warm = warm.with_part(prefix, growth=growth)
        return warm

    def losses(self, films: Films) -> list[Losses]:
        """Losses of each bearing in full runs."""
        if films not in self.known:
            self.nodes = self.nodes or self._nodes([LossCurves(self._cheap(k))(t) for k, t in enumerate(films)])
            self._run([films])
        return self.known[films]

    def _run(self, points: Sequence[Films], *, spacer: bool = False) -> None:
        speed = value_at(self.subject.speed_rpm, 0.0)

        def case(films: Films, turns: float) -> Case:
            parameters: dict[str, Any] = {
                f"{prefix}film_c": t for prefix, t in zip(self.subject.parts, films, strict=True)
            }
            subject = self.subject_at(films, [] if spacer else self.nodes)
            if spacer:
                parameters["spacer"] = True
                subject = with_spacer(subject)
            return Case(parameters, subject, short_run(self.options, speed, turns))

        def judged(found: xarray.Dataset) -> dict[str, Any]:
            moves = max(float(found["drift"]), float(found["stored"]))
            losses = [_losses(found, f"{name}_" if name else "") for name in self.subject.names]
            return {"settled": moves <= (ROUGH if spacer else SETTLED), "moves": moves, "losses": losses}

        for films, row in run_until_settled(points, TURNS, case, judged, JUDGED, self.how).items():
            said = " and ".join(f"{t:.4g}" for t in films)
            if row["message"]:
                raise TrbError(f"the run at {said} C failed: {row['message']}")
            (self.cheap if spacer else self.known)[films] = row["losses"]
            if not spacer:
                self.off[films] = row["moves"]

    def bands(self, films: Films, seed: int) -> list[dict[str, tuple[float, float]]]:
        """Bands of temperatures and power of each bearing."""
        cold = np.array([self.coldest(k) for k in range(len(self.paths))])
        self._grid(cold, np.minimum(films + 1.2 * (films - cold), HOTTEST))
        parts = _parts(self.subject)
        return [
            _drawn(paths, LossCurves(self.curve(k, films)), part.bearing.ribs, seed, self.off[films])
            for k, (paths, part) in enumerate(zip(self.paths, parts, strict=True))
        ]


def with_spacer(subject: Subject) -> Subject:
    """The subject with a spacer in place of each cage, where it takes one; else as it is."""
    for prefix, part in subject.parts.items():
        if not part.effects.has_cage:
            continue
        start = part.start if part.start.kind == "state" else Start(time=part.start.time)
        spaced = part.effects.replace(bodies="rollers_and_spacer")
        try:
            subject = subject.with_part(prefix, effects=spaced, start=start)
        except InputError:  # an elastic cage, or one that a land guides
            return subject
    return subject


ADDED: Final = "added "
"""Beginning of the name of a loss that the spacer does not have."""


def _ratios(full: Losses, cheap: Losses) -> Losses:
    """Each loss of a full run over that of a cheap one; where this has none, the loss itself (W), with a name of its own."""
    return {
        (name if cheap.get(name, 0.0) > 0.0 else f"{ADDED}{name}"): (
            value / cheap[name] if cheap.get(name, 0.0) > 0.0 else value
        )
        for name, value in full.items()
    }


def _times(losses: Losses, ratios: Losses) -> Losses:
    """Losses of a cheap run times ratios, and those that it does not have."""
    added = {name[len(ADDED) :]: value for name, value in ratios.items() if name.startswith(ADDED)}
    return {name: value * ratios.get(name, 1.0) for name, value in losses.items()} | added


def _drawn(paths: HeatPaths, curves: LossCurves, ribs: Any, seed: int, off: float) -> dict[str, tuple[float, float]]:
    """Bands of temperatures and power from draws of all conductances, and of losses that may be off by a share either way."""
    names = [name for name in CONDUCTANCES if getattr(paths, name) > 0.0]
    known = curves.temperatures
    found: dict[str, list[float]] = {name: [] for name in (*PARTS, "film", "power")}
    for row in qmc.Sobol(len(names) + 2, seed=seed).random(DRAWS):
        changes = {name: getattr(paths, name) * FACTOR ** (2.0 * u - 1.0) for name, u in zip(names, row, strict=False)}
        drawn, factor = paths.replace(**changes, oil_share=float(row[-2])), 1.0 + off * (2.0 * float(row[-1]) - 1.0)

        def losses_at(t: float, factor: float = factor) -> Losses:
            return {name: factor * value for name, value in curves(t).items()}

        def nodes_at(
            t: float, drawn: HeatPaths = drawn, losses: Callable[[float], Losses] = losses_at
        ) -> dict[str, float]:
            return network(drawn, heat_of(losses(t), drawn.oil_share, ribs))

        def excess(t: float, nodes: Callable[[float], dict[str, float]] = nodes_at) -> float:
            return film_temperature(nodes(t)) - t

        if excess(known[-1]) > 0.0:  # hotter than the runs go: the band ends there
            t = float(known[-1])
        else:
            t = float(brentq(excess, known[0], known[-1], xtol=1e-3)) if excess(known[0]) > 0.0 else float(known[0])
        nodes = nodes_at(t)
        for name, value in {**nodes, "film": t, "power": sum(losses_at(t).values())}.items():
            found[name].append(value)
    return {name: tuple(np.quantile(values, [0.025, 0.975]).tolist()) for name, values in found.items()}


def _losses(run: Any, name: str) -> Losses:
    """Power by mechanism (W) of a run in a dataset, of a bearing with the beginning of its quantities' names; without that of a
    free ring's damping, which heats the surroundings.
    """
    prefix = f"{name}power_split_"
    found = {str(key)[len(prefix) :]: float(run[key]) for key in run.data_vars if str(key).startswith(prefix)}
    found.pop("support", None)
    return found
