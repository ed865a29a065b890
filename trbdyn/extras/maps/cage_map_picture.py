"""The picture of a map of the cage's motion over speed and load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Patch, Rectangle

from trbdyn.plot.style import plain, scaled, styled

if TYPE_CHECKING:
    import xarray

SHADES: Final = {
    "stable": "#e8f1e4",
    "rocking": "#b9d7ea",
    "circling": "#f0b27a",
    "unstable": "#d98880",
    "unknown": "#ffffff",
}
"""Colours of the classes: light enough for text, and of different lightness, so that they can be told apart in print."""
STARTED: Final = {"equal": "from rest in the middle", "whirl": "from a large whirl"}


def draw_map(data: xarray.Dataset) -> Any:
    """Draw `CageMap.data`: a map for each start, a field for each speed and load, coloured by class, with the orbit over the
    radial play and the hits in a second. Fields of runs that were not decided are hatched.
    """
    starts, loads, speeds = (data[name].values for name in ("start", "axial_load", "speed_rpm"))
    width = 1.6 + 0.75 * len(speeds)
    factor, unit = scaled("N", loads)
    with styled():
        figure, axes = plt.subplots(
            1, len(starts), figsize=(max(width, 3.6) * len(starts), 2.2 + 0.5 * len(loads)), squeeze=False, sharey=True
        )
        for ax, start in zip(axes[0], starts, strict=True):
            _fields(ax, data.sel(start=start))
            ax.set_title(STARTED[str(start)])
            ax.set_xticks(np.arange(len(speeds)), [f"{speed:g}" for speed in speeds])
            ax.set_yticks(np.arange(len(loads)), [f"{factor * load:g}" for load in loads])
            ax.set_xlim(-0.5, len(speeds) - 0.5)
            ax.set_ylim(-0.5, len(loads) - 0.5)
            ax.set_xlabel("speed of the shaft (rpm)")
            ax.grid(visible=False)
        axes[0, 0].set_ylabel(f"axial load ({unit})")
        there = [kind for kind in SHADES if (data["kind"].values == kind).any()]
        keys = [Patch(facecolor=SHADES[kind], edgecolor="0.4", label=kind) for kind in there]
        if not bool(data["decided"].all()):
            keys.append(Patch(facecolor="white", edgecolor="0.4", hatch="///", label="not decided"))
        name = plain(data.attrs["bearing"])
        figure.suptitle(
            f"Motion of the cage of {name}, its orbit over the radial play\nand hits of rollers on it in a second"
        )
        figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure


def _fields(ax: Any, data: xarray.Dataset) -> None:
    for row, line in enumerate(data["kind"].values):
        for column, kind in enumerate(line):
            at = data.isel(axial_load=row, speed_rpm=column)
            hatch = None if bool(at["decided"]) else "///"
            place = (column - 0.5, row - 0.5)
            ax.add_patch(Rectangle(place, 1.0, 1.0, facecolor=SHADES[str(kind)], edgecolor="0.4", hatch=hatch, lw=0.6))
            orbit = float(at["orbit"])
            words = "failed" if np.isnan(orbit) else f"{orbit:.2f}\n{float(at['hits']):.0f}/s"
            ax.text(column, row, words, ha="center", va="center", fontsize=8.0)
