"""Pictures of forces over frequency: spectrum, and levels of octaves."""

from __future__ import annotations

from typing import Literal

import numpy as np
from matplotlib.axes import Axes

from trbdyn.plot.ring import mark_orders
from trbdyn.plot.style import COLOURS, canvas, legend, scaled
from trbdyn.results.forces import Along, On
from trbdyn.results.result import Result


def force_spectrum(
    result: Result,
    ax: Axes | None = None,
    *,
    on: On = "cage",
    along: Along = "x",
    segments: int = 1,
    highest: float | None = None,
) -> Axes:
    """Amplitude spectrum of the force on cage or outer ring, with the bearing's frequencies marked (`Result.force_spectrum`).

    Parameters
    ----------
    highest : float, optional
        Highest frequency to show (Hz); half of that of the records by default.
    """
    found = result.force_spectrum(on, along, segments=segments)
    top = min(highest or np.inf, found.force.nyquist)
    shown = (found.frequency > 0.0) & (found.frequency <= top)
    factor, unit = scaled("N", found.amplitude[shown])
    amplitude = factor * found.amplitude[shown]
    with canvas(ax, (7.2, 4.2), found.force.words) as ax:
        ax.loglog(found.frequency[shown], amplitude, color=COLOURS[0], linewidth=0.8)
        mark_orders(ax, result, found.shaft_frequency, (found.frequency[1], top), "{:.4g} Hz")
        if (peak := float(amplitude.max(initial=0.0))) > 0.0:
            ax.set_ylim(1e-4 * peak, 3.0 * peak)
        ax.set(xlabel=f"frequency (Hz); {found.force.sampling}", ylabel=f"amplitude ({unit})")
        ax.set_xlim(float(found.frequency[1]), top)
        legend(ax, ncols=2)
    return ax


def octave_levels(
    result: Result, ax: Axes | None = None, *, on: On = "cage", along: Along = "x", fraction: Literal[1, 3] = 3
) -> Axes:
    """Levels of the force on cage or outer ring by third octaves or octaves (`Result.octave_levels`).

    Parameters
    ----------
    fraction : {1, 3}
        1: octaves; 3: third octaves.
    """
    found = result.octave_levels(on, along, fraction=fraction)
    places = np.arange(found.level.size)
    low = 10.0 * np.floor(0.1 * found.level.min() - 0.5)
    kind = "octaves" if fraction == 1 else "third octaves"
    with canvas(ax, (7.2, 4.0), f"{found.force.words} by {kind}") as ax:
        ax.bar(places, found.level - low, bottom=low, width=0.85, color=COLOURS[0])
        ax.set_xticks(places, found.names, rotation=60 if fraction == 3 else 0, fontsize=8)
        ax.set(xlabel=f"band (Hz); {found.force.sampling}", ylabel="level (dB re 1 µN)")
        ax.set_ylim(low, float(found.level.max()) + 3.0)
        ax.grid(axis="x", visible=False)
    return ax
