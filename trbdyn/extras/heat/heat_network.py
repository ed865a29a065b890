"""The network of four nodes: who gets the heat, the temperatures that it makes, and how they rise over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

from trbdyn.base.validation import number_of, whole_number_of
from trbdyn.errors import InputError
from trbdyn.extras.heat.paths import PARTS, HeatPaths
from trbdyn.model.ribs import Ribs

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

SURFACES: Final = {"outer_ring": 0.25, "inner_ring": 0.25, "rollers": 0.5}
"""What the temperature of films is made of: each film lies between a ring and the rollers."""


def heat_of(losses: Mapping[str, float], oil_share: float, ribs: Ribs | None = None) -> dict[str, float]:
    """Heat that each node gets (W).

    Parameters
    ----------
    losses : mapping of str to float
        Power by mechanism (W), as `Result.power_split`. Rolling resistance is that of both raceways, half each.
    oil_share : float
        `HeatPaths.oil_share`.
    ribs : Ribs, optional
        Ribs of the bearing: the heat of those against one end of the rollers is that of the rings that have them, in equal
        parts. By default they are those of a tapered bearing, at the inner ring.
    """
    got = dict.fromkeys(PARTS, 0.0)

    def film(power: float, ring: str) -> None:
        got["oil"] += oil_share * power
        got[ring] += 0.5 * (1.0 - oil_share) * power
        got["rollers"] += 0.5 * (1.0 - oil_share) * power

    for name, power in losses.items():
        if name in ("rolling", "rolling_pressure", "damping"):
            film(0.5 * power, "outer_ring")
            film(0.5 * power, "inner_ring")
        elif name == "traction_outer":
            film(power, "outer_ring")
        elif name == "traction_inner":
            film(power, "inner_ring")
        elif name in ("rib", "front_rib"):
            end = "large" if name == "rib" else "small"
            rings = sorted(ring for ring, at in (ribs or Ribs()).places if at == end)
            for ring in rings:
                film(power / len(rings), f"{ring}_ring")
        elif name == "drag":
            got["oil"] += power
        elif name in ("pocket", "pocket_film", "land", "land_film", "vibration"):
            got["rollers"] += power
        elif name != "support" and power != 0.0:  # what supports of a ring take is lost outside of the bearing
            raise RuntimeError(f"heat_of does not say which node gets the heat of the loss {name}")
    return got


def equations(paths: HeatPaths) -> tuple[Array, Array]:
    """Matrix (W/K) and heat from outside (W) of the nodes: matrix @ temperatures = heat from outside + heat of the losses."""
    place = {name: k for k, name in enumerate(PARTS)}
    matrix, right = np.zeros((len(PARTS), len(PARTS))), np.zeros(len(PARTS))
    for (one, two), conductance in paths.inner_links.items():
        i, j = place[one], place[two]
        matrix[i, i] += conductance
        matrix[j, j] += conductance
        matrix[i, j] -= conductance
        matrix[j, i] -= conductance
    for name, (conductance, outside) in paths.outer_links.items():
        matrix[place[name], place[name]] += conductance
        right[place[name]] += conductance * outside
    return matrix, right


def network(paths: HeatPaths, heat: Mapping[str, float]) -> dict[str, float]:
    """Temperatures (C) of the nodes that give off the heat (W) that they get."""
    matrix, outside = equations(paths)
    try:
        found = np.linalg.solve(matrix, outside + np.array([heat[name] for name in PARTS]))
    except np.linalg.LinAlgError:
        raise InputError.of("paths", "conductances", "leave a node without a way out for its heat (W/K)") from None
    return dict(zip(PARTS, found.tolist(), strict=True))


def film_temperature(nodes: Mapping[str, float]) -> float:
    """Temperature of films (C): the mean of both rings and, twice, the rollers."""
    return sum(share * nodes[name] for name, share in SURFACES.items())


class LossCurves:
    """Losses by mechanism (W) over the temperature of films (C), between those that were run by monotone cubics."""

    def __init__(self, known: Mapping[float, Mapping[str, float]]) -> None:
        self.temperatures = np.array(sorted(known))
        names = dict.fromkeys(name for found in known.values() for name in found)
        self._curves = {
            name: PchipInterpolator(self.temperatures, [known[t].get(name, 0.0) for t in self.temperatures.tolist()])
            for name in names
        }

    def __call__(self, film: float) -> dict[str, float]:
        """Power by mechanism (W) at a temperature (C), within those that were run."""
        at = min(max(film, float(self.temperatures[0])), float(self.temperatures[-1]))
        return {name: float(curve(at)) for name, curve in self._curves.items()}


def rise(
    paths: HeatPaths,
    losses: LossCurves,
    capacities: Mapping[str, float],
    duration: float,
    points: int,
    *,
    ribs: Ribs | None = None,
) -> xarray.Dataset:
    """Temperatures over time from those without losses; see `Thermal.warming`."""
    import xarray

    if set(capacities) != set(PARTS):
        raise InputError.of("heat_capacities", sorted(capacities), f"must be those of {', '.join(PARTS)} (J/K)")
    for name, value in capacities.items():
        if not 0.0 < number_of(f"heat_capacities.{name}", value) < 1e9:
            raise InputError.of(("heat_capacities", name), value, "must be above 0 and below 1e9 (J/K)")
    if not 0.0 < number_of("duration", duration) < 1e9:
        raise InputError.of("duration", duration, "must be above 0 and below 1e9 (s)")
    matrix, outside = equations(paths)
    held = np.array([capacities[name] for name in PARTS])

    def rates(_: float, nodes: Array) -> Array:
        heat = heat_of(losses(film_temperature(dict(zip(PARTS, nodes, strict=True)))), paths.oil_share, ribs)
        return (outside + np.array([heat[name] for name in PARTS]) - matrix @ nodes) / held

    start = network(paths, dict.fromkeys(PARTS, 0.0))
    time = np.linspace(0.0, duration, whole_number_of("points", points, 2))
    found = solve_ivp(
        rates, (0.0, duration), [start[name] for name in PARTS], method="LSODA", t_eval=time, rtol=1e-8, atol=1e-6
    )
    film = np.array([film_temperature(dict(zip(PARTS, nodes, strict=True))) for nodes in found.y.T])
    power = np.array([sum(losses(t).values()) for t in film.tolist()])
    return xarray.Dataset(
        {
            "temperature": (("time", "part"), np.column_stack([found.y.T, film]), {"units": "C"}),
            "power": ("time", power, {"long_name": "power that is lost", "units": "W"}),
        },
        coords={"time": ("time", time, {"units": "s"}), "part": ("part", [*PARTS, "film"])},
    )
