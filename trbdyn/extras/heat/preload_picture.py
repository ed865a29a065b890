"""The picture of a preload over temperature."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from trbdyn.plot.style import COLOURS, GREY, LINES, scaled, styled


def draw_preload_over(found: Any) -> Any:
    """Draw play with its band, axial loads, torque and life of a `PreloadOver` over the temperature."""
    rows, where = found.rows, "temperature outside (°C)" if found.outside else "temperature (°C)"
    at = np.array([row.temperature_c for row in rows])
    with styled():
        figure, axes = plt.subplots(2, 2, figsize=(10.0, 7.0), sharex=True)
        play, load, torque, life = axes.flat
        for k, name in enumerate(rows[0].plays):
            plays = [row.fit.plays[name]["operating"] for row in rows]
            label = name or "radial clearance"
            play.fill_between(
                at, [1e6 * p.low for p in plays], [1e6 * p.high for p in plays], color=COLOURS[k], alpha=0.25, lw=0.0
            )
            play.plot(at, [1e6 * p.mean for p in plays], color=COLOURS[k], ls=LINES[k % len(LINES)], label=label)
            for crossing in found.lost.get(name, ()):
                play.axvline(crossing, color=GREY, lw=0.8, ls=":")
        play.axhline(0.0, color=GREY, lw=0.8)
        play.set(ylabel="play, negative: preload (µm)", title="play and 99 % of the parts")
        play.legend()
        factor, unit = scaled("N", [sheet.axial_load for row in rows for sheet in row.sheets.values()])
        for k, name in enumerate(dict.fromkeys(name for row in rows for name in row.sheets)):
            loads = [factor * row.sheets[name].axial_load if name in row.sheets else np.nan for row in rows]
            load.plot(at, loads, color=COLOURS[k], ls=LINES[k % len(LINES)], label=name or None)
        load.set(ylabel=f"axial load ({unit})", title="preload and load")
        load.set_ylim(bottom=0.0)
        if len(rows[0].temperatures) > 1:
            load.legend()
        torques = np.array([np.nan if row.torque is None else row.torque for row in rows])
        factor, unit = scaled("N m", torques)
        torque.plot(at, factor * torques, color=COLOURS[0])
        torque.set(xlabel=where, ylabel=f"friction torque ({unit})", title="torque of the contacts")
        torque.set_ylim(bottom=0.0)
        for k, (name, label) in enumerate((("life_hours", "L10h"), ("modified_reference_life_hours", "Lnmrh"))):
            lives = [np.nan if getattr(row, name) is None else min(getattr(row, name), 1e6) for row in rows]
            life.plot(at, lives, color=COLOURS[k], ls=LINES[k], label=label)
        life.set_yscale("log")
        life.set(xlabel=where, ylabel="life (h), at most 1e6", title="life of all bearings together")
        life.legend()
        if found.runs_away_c is not None:
            for ax in axes.flat:
                ax.axvline(found.runs_away_c, color=COLOURS[6], lw=1.2)
    return figure
