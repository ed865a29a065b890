"""Pictures around the bearing: load zone, attitude of the rollers, forces of the pockets, maps of pressure and film
along the rollers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from trbdyn.base.display import plain as number
from trbdyn.errors import InputError
from trbdyn.plot.cage import last_turns
from trbdyn.plot.style import COLOURS, GREY, LINES, legend, scaled, sequence, styled
from trbdyn.results.fields import contacts
from trbdyn.results.result import Result
from trbdyn.run.replay import Replay

Array = NDArray[np.float64]


def _polar(ax: Axes | None, title: str, size: tuple[float, float] = (5.2, 5.2)) -> Any:
    """Polar axes with a title: the given ones, or new ones in a figure of their own."""
    if ax is not None:
        if ax.name != "polar":
            raise InputError.of("ax", ax.name, "must be polar axes: subplot_kw={'projection': 'polar'}")
        if not ax.get_title():
            ax.set_title(title, pad=14)
        return ax
    figure, own = plt.subplots(figsize=size, subplot_kw={"projection": "polar"})
    figure.suptitle(title, fontsize=10)
    return own


def binned(angle: Array, values: Array, bins: int) -> tuple[Array, Array, Array, Array]:
    """Values at angles around the bearing (rad) in bins: the middles of those that hold something (rad), and the mean, smallest
    and largest value there.
    """
    number = (np.mod(angle, 2.0 * np.pi) / (2.0 * np.pi) * bins).astype(int).ravel() % bins
    count = np.bincount(number, minlength=bins)
    held = count > 0
    low, high = np.full(bins, np.inf), np.full(bins, -np.inf)
    np.minimum.at(low, number, values.ravel())
    np.maximum.at(high, number, values.ravel())
    mean = np.bincount(number, values.ravel(), bins)[held] / count[held]
    return (np.flatnonzero(held) + 0.5) * 2.0 * np.pi / bins, mean, low[held], high[held]


def load_zone(result: Result, ax: Axes | None = None, last: float | None = None, bins: int = 72) -> Axes:
    """Load distribution around the bearing (polar): mean load of a roller at each place, with its range.

    Examples
    --------
    >>> import trbdyn as trb
    >>> result = trb.Simulation(trb.cases.scene_30310(2000.0, 4930.0, 5530.0)).run(revolutions=1)
    >>> trb.plot.load_zone(result).figure.get_suptitle()
    'Load of a roller by its place around the bearing (N)'
    """
    shown = last_turns(result, last)
    orbit = shown["roller_orbit_angle"]
    with styled():
        loads = {name: shown[f"{side}_load"] for side, name in contacts().items() if f"{side}_load" in shown}
        factor, unit = scaled("N", *loads.values())
        ax = _polar(ax, f"Load of a roller by its place around the bearing ({unit})")
        for index, (name, values) in enumerate(loads.items()):
            if not values.any():
                continue
            load = factor * values
            place, mean, low, high = binned(orbit, load, bins)
            around = [np.append(values, values[0]) for values in (place, mean, low, high)]
            label = f"{name}, {number(load.min())} to {number(load.max())} {unit}"
            ax.plot(around[0], around[1], color=COLOURS[index], linestyle=LINES[index], label=label)
            ax.fill_between(around[0], around[2], around[3], color=COLOURS[index], alpha=0.2, linewidth=0)
        ax.set_ylim(bottom=0)
        name_angles(ax)
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=1)
    return ax


def name_angles(ax: Any) -> None:
    """Name the directions of a picture around the bearing."""
    ax.set_thetagrids(range(0, 360, 45), ["x", "45°", "y", "135°", "-x", "225°", "-y", "315°"])
    ax.set_rlabel_position(22.5)


def attitude(result: Result, last: float | None = None, bins: int = 72) -> Figure:
    """Skew and tilt of the rollers over their place around the bearing: mean and range."""
    shown = last_turns(result, last)
    orbit = shown["roller_orbit_angle"]
    with styled():
        figure, axes = plt.subplots(2, 1, figsize=(6.4, 4.6), sharex=True)
        words = {"skew": "skew (mrad)", "tilt": "tilt against nominal (mrad)"}
        for index, (ax, (name, label)) in enumerate(zip(axes, words.items(), strict=True)):
            place, mean, low, high = binned(orbit, 1e3 * shown[f"roller_{name}"], bins)
            degrees = np.degrees(place)
            ax.plot(degrees, mean, color=COLOURS[index], label="mean")
            ax.fill_between(
                degrees, low, high, color=COLOURS[index], alpha=0.25, linewidth=0, label="smallest to largest"
            )
            ax.axhline(0, color=GREY, linewidth=0.8)
            ax.set_ylabel(label)
            legend(ax)
        axes[1].set(xlim=(0, 360), xticks=range(0, 361, 45), xlabel="place around the bearing from x towards y (deg)")
        figure.suptitle("Attitude of the rollers", fontsize=10)
    return figure


def pocket_polar(result: Result, ax: Axes | None = None, threshold: float = 0.0) -> Axes:
    """Force in each pocket (polar): peak and 95th percentile while it is touched, a group of bars for each pocket."""
    statistics = result.pocket_statistics(threshold)
    count = statistics.peak.shape[0]
    touched = np.flatnonzero(statistics.peak.max(axis=0) > threshold).tolist()
    width = 2.0 * np.pi / count
    with styled():
        factor, unit = scaled("N", statistics.peak)
        paper: Any = _polar(ax, f"Force in each pocket ({unit}): peak (light) and 95 % while touched (dark)")
        for order, slot in enumerate(touched):
            bar = 0.8 * width / len(touched)
            place = width * np.arange(count) + bar * (order - 0.5 * (len(touched) - 1))
            name = result.slot_names[slot].replace("_", " ") or f"face {slot}"
            colour = COLOURS[order % len(COLOURS)]
            peak = statistics.peak[:, slot]
            p95 = np.where(peak > threshold, np.nan_to_num(statistics.p95[:, slot]), 0.0)
            paper.bar(place, factor * peak, bar, color=colour, alpha=0.35, linewidth=0)
            paper.bar(place, factor * p95, bar, color=colour, linewidth=0, label=name)
        every = max(1, count // 24)
        paper.set_thetagrids(np.degrees(width * np.arange(0, count, every)), [str(k) for k in range(0, count, every)])
        if touched:
            paper.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=2)
        else:
            paper.text(0.5, 0.5, "no pocket was touched", transform=paper.transAxes, ha="center")
            paper.set_yticks([])
    found: Axes = paper
    return found


THICK_FILM: Final = 5.0
"""Film parameter at which the scale of its map ends: beyond it no surface touches, and thicker films, which unloaded ends of
rollers have a thousand times, would hide the thin ones.
"""
_MAPS: Final[dict[str, tuple[str, str, str, str]]] = {
    "pressure": ("raceway_pressure", "largest Hertz pressure ({})", "Pa", "Pressure"),
    "film": ("raceway_film", "central film thickness (µm)", "", "Film thickness"),
    "film_parameter": ("raceway_film_parameter", r"film parameter $\Lambda$", "1", "Film parameter"),
    "slide_roll": ("raceway_slide_roll", "slide-roll ratio", "1", "Slide-roll ratio"),
    "load_per_length": ("raceway_load_per_length", "load per length (N/mm)", "", "Load per length"),
}
"""Of each quantity its field, label, unit in SI, and title; without a unit it has that of the label, see `_FIXED`."""
_FIXED: Final = {"film": 1e6, "load_per_length": 1e-3}


def contact_map(
    result: Result,
    quantity: str = "pressure",
    sides: Sequence[str] = ("outer", "inner"),
    records: int = 60,
    bins: int = 72,
) -> Figure:
    """A quantity along the rollers and around the bearing, at the raceways: mean over the records used.

    Records keep one number for each contact, so records are evaluated again by the core, node by node along each roller.

    Parameters
    ----------
    result : Result
        Needs the groups time, cage and rollers.
    quantity : {'pressure', 'film', 'film_parameter', 'slide_roll', 'load_per_length'}
        What is shown.
    sides : sequence of {'outer', 'inner'}
        Raceways.

    Raises
    ------
    InputError
        If a name is unknown or a number is not allowed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> result = trb.Simulation(trb.cases.scene_30310(2000.0, 4930.0, 5530.0)).run(revolutions=1)
    >>> len(trb.plot.contact_map(result, "film_parameter", records=10).axes)
    3
    """
    if quantity not in _MAPS:
        raise InputError.of("quantity", quantity, f"must be one of {', '.join(_MAPS)}")
    for side in sides:
        if side not in ("outer", "inner"):
            raise InputError.of("sides", side, "must be 'outer' or 'inner'")
    if not isinstance(records, int) or records < 1:
        raise InputError.of("records", records, "must be a whole number >= 1")
    key, label, si, title = _MAPS[quantity]
    replay = Replay(result)
    index = np.unique(np.linspace(0, len(result) - 1, min(records, len(result))).round().astype(int))
    orbit = result["roller_orbit_angle"][index]
    found = [replay.contacts(int(k)) for k in index]
    stations = 1e3 * replay.stations
    number = (np.mod(orbit, 2.0 * np.pi) / (2.0 * np.pi) * bins).astype(int).ravel() % bins
    count = np.bincount(number, minlength=bins)
    factor, unit = (_FIXED[quantity], "") if not si else scaled(si, *(contact[key] for contact in found))
    label, grids = label.format(unit), []
    for side in sides:
        row = 0 if side == "outer" else 1
        loaded = np.array([contact["raceway_load"][row] for contact in found]).reshape(-1, stations.size) > 0.0
        values = factor * np.array([contact[key][row] for contact in found]).reshape(-1, stations.size)
        total, held = np.zeros((bins, stations.size)), np.zeros((bins, stations.size))
        np.add.at(total, number, np.where(loaded, values, 0.0))
        np.add.at(held, number, loaded)
        with np.errstate(invalid="ignore"):
            grid = np.where(held > 0, total / held, np.nan)
        grids.append(_filled(grid, count))
    finite = np.concatenate([grid[np.isfinite(grid)] for grid in grids])
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    cut = quantity == "film_parameter" and high > THICK_FILM
    high = max(THICK_FILM, low) if cut else high
    edges = np.linspace(0.0, 360.0, bins + 1)
    half = 0.5e3 * result.scene.bearing.roller.effective_length
    borders = np.concatenate([[-half], 0.5 * (stations[1:] + stations[:-1]), [half]])
    with styled():
        figure, axes = plt.subplots(len(sides), 1, figsize=(6.8, 0.9 + 2.0 * len(sides)), sharex=True, squeeze=False)
        for ax, side, grid in zip(axes[:, 0], sides, grids, strict=True):
            mesh = ax.pcolormesh(edges, borders, grid.T, cmap=sequence(), vmin=low, vmax=high)
            ax.set_title(contacts()[side], loc="left")
            ax.set_ylabel("along the roller (mm)")
            ax.grid(visible=False)
        axes[-1, 0].set(xticks=range(0, 361, 45), xlabel="place around the bearing from x towards y (deg)")
        bar = figure.colorbar(mesh, ax=axes[:, 0], extend="max" if cut else "neither")
        bar.set_label(label)
        figure.suptitle(f"{title} along the rollers (large end: +) and around the bearing", fontsize=10)
    return figure


def _filled(grid: Array, count: NDArray[np.int64]) -> Array:
    """A grid whose places that no roller passed show their nearest neighbour; places without load stay empty."""
    passed = np.flatnonzero(count)
    distance = np.abs(np.arange(count.size)[:, None] - passed)
    nearest = passed[np.argmin(np.minimum(distance, count.size - distance), axis=1)]
    return grid[nearest]


def pressure_map(result: Result, records: int = 60) -> Figure:
    """Pressure along the rollers and around the bearing, at both raceways; see `contact_map`."""
    return contact_map(result, "pressure", records=records)


def film_map(result: Result, records: int = 60) -> Figure:
    """Film parameter along the rollers and around the bearing, at both raceways; see `contact_map`."""
    return contact_map(result, "film_parameter", records=records)
