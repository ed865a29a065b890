"""The picture of a torque map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from trbdyn.base.display import amount
from trbdyn.plot.style import COLOURS, LINES, MARKERS, plain, scaled, styled

if TYPE_CHECKING:
    import xarray


def draw_map(data: xarray.Dataset, temperature: int | None = None) -> Any:
    """Draw `TorqueMap.data` over speed: a line for each load and temperature (or for one, by its place), and what loses the
    torque of the last of them. Points whose torque has not settled are hollow.
    """
    chosen = range(data.sizes["temperature_c"]) if temperature is None else [temperature]
    lines = [data.isel(temperature_c=t, load=k).sortby("speed_rpm") for t in chosen for k in range(data.sizes["load"])]
    factor, unit = scaled("N m", data["torque"])
    with styled():
        figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 4.4))
        for number, line in enumerate(lines):
            _line(left, line, number, _words(line, len(chosen) > 1, data.sizes["load"] > 1), factor)
        _sources(right, lines[-1])
        for ax in (left, right):
            if data.sizes["speed_rpm"] > 1:
                ax.set_xscale("log")
            ax.set_xlabel("speed of the shaft (rpm)")
        largest, smallest = float(data["torque"].max()), float(data["torque"].min())
        if 0.0 < smallest < 0.1 * largest:
            left.set_yscale("log")
        else:
            left.set_ylim(bottom=0.0)
        left.set_ylabel(f"friction torque ({unit})")
        left.legend()
        right.set_ylim(0.0, 100.0)
        right.set_ylabel("share of the torque (%)")
        right.legend(loc="lower right", frameon=True)
        right.set_title("what loses it: " + (_words(lines[-1], True, True)))
        left.set_title(f"{plain(data.attrs['bearing'])}, shaft")
    return figure


def _words(line: xarray.Dataset, with_temperature: bool, with_load: bool) -> str:
    words = []
    if with_load or not with_temperature:
        radial = float(line["radial_load"])
        axial = amount(float(line["axial_load"]), "N", 6)
        words.append(f"{axial} axial" + (f", {amount(radial, 'N', 6)} radial" if radial else ""))
    if with_temperature:
        words.append(f"{float(line['temperature_c']):g} °C")
    return ", ".join(words)


def _line(ax: Any, line: xarray.Dataset, number: int, label: str, factor: float) -> None:
    speed, settled, torque = line["speed_rpm"].values, line["settled"].values, factor * line["torque"].values
    colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
    ax.plot(speed, torque, color=colour, linestyle=LINES[number % len(LINES)], marker=marker, ms=4, label=label)
    ax.plot(speed[~settled], torque[~settled], linestyle="", marker=marker, ms=6, mfc="white", mec=colour)
    if "torque_low" in line:
        ax.fill_between(
            speed, factor * line["torque_low"], factor * line["torque_high"], color=colour, alpha=0.15, lw=0.0
        )


def _sources(ax: Any, line: xarray.Dataset) -> None:
    """Shares as they lie upon each other; those that are nothing are left out."""
    shares = line["share"].values.T
    total = np.nansum(shares, axis=0)
    kept = [k for k in range(len(shares)) if np.nanmax(np.abs(shares[k]) / total, initial=0.0) > 0.005]
    names = [str(line["source"].values[k]).replace("_", " ") for k in kept]
    ax.stackplot(
        line["speed_rpm"],
        100.0 * shares[kept] / total,
        labels=names,
        colors=[COLOURS[k % len(COLOURS)] for k in range(len(kept))],
    )
