"""The picture of slip over load."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from trbdyn.plot.style import COLOURS, GREY, LINES, MARKERS, plain, scaled, styled


def draw_least_load(found: Any) -> Any:
    """Draw the slip of the cage and the power per area of entering rollers of a `LeastLoad` over the load, with the least
    loads.
    """
    data, number = found.data, 0
    factor, unit = scaled("N", data["size"], found.by_rule)
    with styled():
        figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 4.4))
        for t in range(data.sizes["temperature_c"]):
            for s in range(data.sizes["speed_rpm"]):
                line = data.isel(temperature_c=t, speed_rpm=s).sortby("size")
                how = {
                    "color": COLOURS[number % len(COLOURS)],
                    "marker": MARKERS[number % len(MARKERS)],
                    "ls": LINES[t % len(LINES)],
                }
                label = f"{float(line['speed_rpm']):g} rpm, {float(line['temperature_c']):g} °C"
                left.plot(factor * line["size"], 100.0 * line["cage_slip"], label=label, **how)
                right.plot(factor * line["size"], 1e-6 * line["entry_power"], label=label, **how)
                if np.isfinite(float(line["least"])):
                    left.plot(
                        factor * float(line["least"]), 100.0 * found.slip, "o", mfc="none", ms=11, color=how["color"]
                    )
                number += 1
        left.axhline(100.0 * found.slip, color=GREY, lw=0.8, ls=":")
        for ax in (left, right):
            ax.axvline(factor * found.by_rule, color=GREY, lw=0.8)
            ax.set_xscale("log")
            ax.set_xlabel(f"load ({unit})")
            ax.set_ylim(bottom=0.0)
        left.set(ylabel="slip of the cage (%)", title=plain(data.attrs["bearing"]) or "bearing")
        right.set(ylabel="power per area (W/mm²)", title="rollers that enter the load zone")
        left.legend(title="vertical line: 0.02 C")
    return figure
