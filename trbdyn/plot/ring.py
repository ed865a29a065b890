"""Pictures of a ring that moves: its path, its motion in time, and its spectrum with the bearing's orders."""

from __future__ import annotations

from typing import Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from trbdyn.errors import InputError
from trbdyn.plot.cage import last_turns, revolutions, turns_label
from trbdyn.plot.style import COLOURS, GREY, canvas, legend, line, pair, sequence, styled
from trbdyn.results import observables
from trbdyn.results.result import Result

Array = NDArray[np.float64]
Ring = Literal["inner", "outer"]

__all__ = ["ring_motion", "ring_orbit", "ring_orders", "ring_spectrum"]


def _ring_of(ring: Ring) -> tuple[str, str]:
    """Group of fields of a ring, and its name in titles."""
    known: dict[str, tuple[str, str]] = {
        "inner": ("ring", "inner ring"),
        "outer": ("housing", "outer ring with its housing"),
    }
    if ring not in known:
        raise InputError.of("ring", ring, "must be 'inner' or 'outer'")
    return known[ring]


def ring_orbit(result: Result, ax: Axes | None = None, last: float | None = 12.0, *, ring: Ring = "inner") -> Axes:
    """Path of a ring's centre in the plane of the rollers' centres, seen from the large ends, about its mean place."""
    group, name = _ring_of(ring)
    shown = last_turns(result, last)
    with canvas(ax, (5.2, 4.4), f"Path of the centre of the {name}") as ax:
        points = draw_path(ax, 1e6 * shown[f"{group}_position"][:, :2], revolutions(shown))
        ax.axhline(0, color=GREY, linewidth=0.6)
        ax.axvline(0, color=GREY, linewidth=0.6)
        ax.set_aspect("equal")
        ax.figure.colorbar(points, ax=ax, label=turns_label(result))
    return ax


def draw_path(ax: Axes, place: Array, turned: Array) -> PathCollection:
    """The path of a point across the axis, shape (T, 2) (µm), about its mean place, coloured by the turns of the shaft."""
    mean = place.mean(axis=0)
    path = place - mean
    ax.plot(*path.T, color=GREY, linewidth=0.4, zorder=0)
    ax.set(xlabel=f"x from its mean, {mean[0]:.3g} µm (µm)", ylabel=f"y from its mean, {mean[1]:.3g} µm (µm)")
    ax.locator_params(nbins=5)
    return ax.scatter(path[:, 0], path[:, 1], c=turned, s=3, cmap=sequence(), linewidths=0)


def ring_motion(result: Result, last: float | None = None, *, ring: Ring = "inner") -> Figure:
    """Displacement and tilt of a ring over the turns of the shaft."""
    group, title = _ring_of(ring)
    shown = last_turns(result, last)
    place, tilt = shown[f"{group}_position"], shown[f"{group}_tilt"]
    return draw_motion(f"Motion of the {title}", shown, place, tilt, "radial")


def draw_motion(title: str, result: Result, place: Array, tilt: Array, across: str) -> Figure:
    """Place (m), shape (T, 3), and tilt about x and y (rad), shape (T, 2), over the turns of the shaft."""
    turned = revolutions(result)
    with styled():
        figure, axes = plt.subplots(3, 1, figsize=(6.4, 5.6), sharex=True)
        figure.suptitle(title, fontsize=11)
        pair(axes[0], turned, 1e6 * place, "{}")
        pair(axes[2], turned, 1e3 * tilt, "about {}")
        line(axes[1], turned, 1e6 * place[:, 2], 0)
        axes[0].set_ylabel(f"{across} (µm)")
        axes[1].set_ylabel("axial, z (µm)")
        axes[2].set(ylabel="tilt (mrad)", xlabel=turns_label(result), xlim=(turned[0], turned[-1]))
        for ax in (axes[0], axes[2]):
            legend(ax)
    return figure


def ring_orders(result: Result) -> dict[str, float]:
    """Orders of the bearing: frequencies over that of the shaft, with the outer ring at rest and pure rolling.

    Parameters
    ----------
    result : Result
        The run.

    Returns
    -------
    dict of str to float
        Turns of the cage, passes of rollers at a point of either raceway, and spin of a roller, which meets both raceways in each
        turn (1).
    """
    geometry, count = result.scene.bearing.geometry, result.scene.bearing.n_rollers
    inner, outer = (
        float(speed.mean() / result.turning_speed.mean()) for speed in (result["shaft_speed"], result.outer_speed)
    )
    cage = geometry.cage_speed_ratio * (inner - outer) + outer
    return {
        "shaft": inner,
        "cage": cage,
        "rollers over the outer ring": count * abs(cage - outer),
        "rollers over the inner ring": count * abs(inner - cage),
        "spin of a roller, twice": 2.0 * geometry.roller_spin_ratio * abs(inner - outer),
    }


def mark_orders(ax: Axes, result: Result, scale: float, ends: tuple[float, float], label: str) -> None:
    """Mark the bearing's orders times a scale, where they lie between two ends, with their numbers in the legend."""
    for index, (name, order) in enumerate(ring_orders(result).items()):
        place, colour = scale * abs(order), COLOURS[(index + 1) % len(COLOURS)]
        if ends[0] <= place <= ends[1]:
            words = f"{name}, {label.format(place)}"
            ax.axvline(place, color=colour, linewidth=0.9, linestyle="--", label=words)


def ring_spectrum(
    result: Result,
    ax: Axes | None = None,
    *,
    of: Literal["displacement", "velocity", "acceleration"] = "velocity",
    along: Literal["x", "y", "z"] = "x",
    orders: float = 20.0,
    segments: int = 1,
    ring: Ring = "inner",
) -> Axes:
    """Spectrum of a ring's vibration over the order of the shaft, with the bearing's orders marked.

    Parameters
    ----------
    result : Result
        Needs the groups time and ring, or housing for the outer ring; best after settling, at constant speed. Vibrations
        faster than half of the records are folded to lower orders; a line below the picture says so where much of the power
        lies in the highest octave of the records.
    of : {'displacement', 'velocity', 'acceleration'}
        What of the vibration.
    orders : float
        Highest order to show.

    Raises
    ------
    InputError
        If an argument is not allowed.
    """
    powers = {"displacement": -1, "velocity": 0, "acceleration": 1}
    if of not in powers:
        raise InputError.of("of", of, f"must be one of {', '.join(map(repr, powers))}")
    if along not in ("x", "y", "z"):
        raise InputError.of("along", along, "must be 'x', 'y' or 'z'")
    group, title = _ring_of(ring)
    frequency, density = observables.spectrum(
        result["time"], result[f"{group}_velocity"][:, "xyz".index(along)], segments
    )
    shaft = abs(float(result.turning_speed.mean())) / (2.0 * np.pi)
    kept = (frequency > 0.0) & (frequency <= orders * shaft)
    scale = (2.0 * np.pi * frequency[kept]) ** powers[of]
    amplitude = np.sqrt(density[kept]) * scale
    unit = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s$^2$"}[of]
    with canvas(ax, (6.4, 3.6), f"Vibration of the {title} along {along}: {of}") as ax:
        ax.semilogy(frequency[kept] / shaft, amplitude, color=COLOURS[0], linewidth=0.9)
        mark_orders(ax, result, 1.0, (-np.inf, orders), "{:.3g}")
        highest = float(amplitude.max(initial=0.0))
        if highest > 0.0:
            ax.set_ylim(max(1e-6 * highest, float(amplitude[amplitude > 0.0].min())), 3.0 * highest)
        xlabel, high = "frequency / shaft frequency", observables.high_share(frequency, density)
        if high > observables.FOLDED:
            xlabel += f"\n{100.0 * high:.0f} % of the power at {0.5 * frequency[-1]:.3g} to {frequency[-1]:.3g} Hz, the fastest"
            xlabel += " of these records: faster vibrations may\nappear at lower orders here; save more often"
        ax.set(xlabel=xlabel, ylabel=f"amplitude density ({unit}/$\\sqrt{{Hz}}$)", xlim=(0, orders))
        legend(ax, ncols=2)
    return ax
