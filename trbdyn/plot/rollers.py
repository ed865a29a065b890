"""Pictures of the rollers: spacing, forces on the cage, contact loads and films around the bearing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter

from trbdyn.base.display import plain as number
from trbdyn.errors import InputError
from trbdyn.plot.cage import last_turns, need_cage, revolutions, turns_label
from trbdyn.plot.style import COLOURS, GREY, LIGHT, MARKERS, OWN, canvas, legend, line, scaled, sequence, styled
from trbdyn.results.fields import contacts
from trbdyn.results.result import Result

BINS = 72
STRETCHES = 300
"""Stretches of time into which a picture of pocket forces is divided."""


def spacing_angles(result: Result, ax: Axes | None = None, n: int = 1, rollers: Sequence[int] | None = None) -> Axes:
    """Spacing of the rollers: the angle from a roller to the n-th after it, over the turns of the shaft.

    Parameters
    ----------
    n : int
        Number of adjacent gaps to add up.
    rollers : sequence of int, optional
        Rollers to name, the first five by default; the others are drawn in light grey.
    """
    angles = np.degrees(result.spacing_angles(n))
    count = angles.shape[1]
    named = range(min(5, count)) if rollers is None else rollers
    for roller in named:
        if not 0 <= roller < count:
            raise InputError.of("rollers", roller, f"must lie between 0 and {count - 1}")
    with canvas(ax, (6.4, 4.0), "Spacing of the rollers" if n == 1 else f"Spacing of the rollers over {n} gaps") as ax:
        turned = revolutions(result)
        for roller in sorted(set(range(count)) - set(named)):
            line(ax, turned, angles[:, roller], color=LIGHT, linestyle="-", linewidth=0.6, zorder=1)
        for index, roller in enumerate(named):
            label = f"{roller}–{(roller + n) % count}"
            line(ax, turned, angles[:, roller], index, label, zorder=3)
        ax.axhline(360.0 * n / count, color=GREY, linewidth=0.9, zorder=2)
        ax.set(xlabel=turns_label(result), xlim=(turned[0], turned[-1]))
        ax.set_ylabel("angle between neighbours (deg)" if n == 1 else f"angle over {n} gaps (deg)")
        legend(
            ax, ncols=6, title=f"rollers; even spacing is {360.0 * n / count:g} deg", title_fontsize=9, alignment="left"
        )
    return ax


def _face_name(result: Result, slot: int) -> str:
    return result.slot_names[slot].replace("_", " ") or f"face {slot}"


def pocket_forces(result: Result, pockets: Sequence[int] | None = None, last: float | None = 12.0) -> Figure:
    """Normal forces between rollers and cage over the turns of the shaft: a panel for each face, a row for each pocket.

    The colour is the largest force within a short stretch of time (the colour bar says how long), in a logarithmic scale; of all
    steps where the group peaks was recorded, else of the records. So an impact of some tens of microseconds is seen as well as a
    force that lasts. White: not touched.

    Parameters
    ----------
    pockets : sequence of int, optional
        Pockets to show, from 0; all by default.
    """
    need_cage(result)
    shown = last_turns(result, last)
    force = shown["pocket_force_peak" if "pocket_force_peak" in shown else "pocket_force"]
    turned = revolutions(shown)
    count, slots = force.shape[1:]
    chosen = list(range(count)) if pockets is None else list(pockets)
    for pocket in chosen:
        if not 0 <= pocket < count:
            raise InputError.of("pockets", pocket, f"must lie between 0 and {count - 1}")
    edges = np.unique(np.linspace(0, len(turned), min(len(turned), STRETCHES) + 1).astype(int))
    largest = np.maximum.reduceat(force[:, chosen], edges[:-1], axis=0)
    touched = [slot for slot in range(slots) if largest[:, :, slot].any()]
    borders = np.append(turned[edges[:-1]], turned[-1])
    factor, unit = scaled("N", largest)
    largest = factor * largest
    top = float(largest.max(initial=0.0)) or 1.0
    with styled():
        height = 0.55 + max(0.9, 0.13 * len(chosen))
        figure, axes = plt.subplots(
            max(1, len(touched)), 1, figsize=(6.8, 1.2 + height * max(1, len(touched))), sharex=True, squeeze=False
        )
        figure.set_label(OWN)
        figure.suptitle("Normal forces between rollers and cage", fontsize=11)
        mesh = None
        for ax, slot in zip(axes.flat, touched, strict=False):
            mesh = ax.pcolormesh(
                borders,
                np.arange(len(chosen) + 1) - 0.5,
                np.ma.masked_less_equal(largest[:, :, slot].T, 0.0),
                norm=LogNorm(1e-3 * top, top),
                cmap=sequence().reversed(),
                rasterized=True,
            )
            ax.set_title(_face_name(result, slot), loc="left", pad=3)
            rows = np.unique(np.linspace(0, len(chosen) - 1, min(len(chosen), 12)).astype(int))
            ax.set_yticks(rows, [str(chosen[row]) for row in rows])
            ax.set_ylabel("pocket")
            ax.grid(visible=False)
        axes[-1, 0].set(xlabel=turns_label(result), xlim=(turned[0], turned[-1]))
        if mesh is None:
            axes[0, 0].text(0.5, 0.5, "no pocket was touched", transform=axes[0, 0].transAxes, ha="center")
        else:
            long = 1e3 * (shown["time"][-1] - shown["time"][0]) / (len(edges) - 1)
            bar = figure.colorbar(mesh, ax=axes.ravel().tolist(), shrink=0.9, pad=0.02, extend="min")
            bar.set_label(f"largest force within {long:.2g} ms ({unit})")
    return figure


def pocket_statistics(result: Result, ax: Axes | None = None, threshold: float = 0.0) -> Axes:
    """Force of each pocket and face: 95th percentile while in contact (filled) and peak (open), with the duty of each face."""
    need_cage(result)
    stats = result.pocket_statistics(threshold)
    touched = np.flatnonzero(stats.peak.max(axis=0) > 0).tolist()
    with canvas(ax, title="Forces on the pockets: 95 % in contact (filled), peak (open)") as ax:
        place = np.arange(stats.peak.shape[0])
        factor, unit = scaled("N", stats.peak)
        for index, slot in enumerate(touched):
            shift = 0.16 * (index - 0.5 * (len(touched) - 1))
            label = f"{_face_name(result, slot)} (touched {100 * stats.duty[:, slot].mean():.2g} % of the time)"
            look: dict[str, Any] = {
                "color": COLOURS[index % 7],
                "marker": MARKERS[index % 7],
                "linestyle": "none",
                "markersize": 5,
            }
            peak = np.where(stats.peak[:, slot] > threshold, factor * stats.peak[:, slot], np.nan)
            p95 = np.where(stats.peak[:, slot] > threshold, factor * stats.p95[:, slot], np.nan)
            ax.vlines(place + shift, p95, peak, color=look["color"], linewidth=0.8)
            ax.plot(place + shift, p95, label=label, **look)
            ax.plot(place + shift, peak, markerfacecolor="white", **look)
        ax.set(xlabel="pocket", ylabel=f"normal force ({unit})", xticks=place[:: max(1, place.size // 12)])
        ax.set_ylim(bottom=0)
        legend(ax, ncols=1)
    return ax


def _around(
    angle: np.ndarray, values: np.ndarray, weight: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Place (deg), weighted mean, 5 % and 95 % of values in bins of the angle around the bearing.

    Values without weight, such as the film of a roller without load, are left out. A bin without any has no line.
    """
    bins = (np.mod(angle, 2 * np.pi) / (2 * np.pi) * BINS).astype(int)
    rows = []
    for k in range(BINS):
        inside = (bins == k) & (weight > 0.0)
        found = (math.nan, math.nan, math.nan)
        if inside.any():
            part = values[inside]
            low, high = np.percentile(part, (5.0, 95.0))
            found = (float(np.average(part, weights=weight[inside])), float(low), float(high))
        if inside.any() or (bins == k).any():
            rows.append(((k + 0.5) * 360.0 / BINS, *found))
    place, mean, low, high = np.array(rows).T
    return place, mean, low, high


def _draw_around(result: Result, ax: Axes, quantity: str, si: str = "1") -> str:
    """Draw a quantity of both raceways; gives the unit in which it is shown."""
    named = [f"{side}_{quantity}" for side in contacts() if f"{side}_{quantity}" in result]
    factor, unit = scaled(si, *(result[name] for name in named))
    said = "" if si == "1" else f" {unit}"
    for index, (side, name) in enumerate(contacts().items()):
        if f"{side}_{quantity}" not in result or not result[f"{side}_{quantity}"].any():
            continue
        values = factor * result[f"{side}_{quantity}"]
        weight = result[f"{side}_load"] if quantity == "film_parameter" else np.ones_like(values)
        place, mean, low, high = _around(result["roller_orbit_angle"], values, weight)
        line(ax, place, mean, index, f"{name} (mean {number(np.average(values, weights=weight))}{said})")
        ax.fill_between(place, low, high, color=COLOURS[index], alpha=0.25, linewidth=0)
    ax.set(xlim=(0, 360), xticks=range(0, 361, 45))
    ax.set_xlabel("place around the bearing from x towards y (deg)\nline: mean, band: 5 to 95 %")
    return unit


def contact_loads(result: Result, ax: Axes | None = None) -> Axes:
    """Contact loads around the bearing: mean, and the range from 5 to 95 %."""
    with canvas(ax, title="Contact loads of the rollers around the bearing") as ax:
        unit = _draw_around(result, ax, "load", "N")
        ax.set_ylabel(f"normal load ({unit})")
        ax.set_ylim(bottom=0)
        legend(ax, ncols=2)
    return ax


def film_parameter(result: Result, ax: Axes | None = None) -> Axes:
    """Film parameter Lambda of the loaded rollers, around the bearing: mean weighted by load, and the range from 5 to 95 %."""
    with canvas(ax, title="Film parameter of loaded rollers around the bearing") as ax:
        _draw_around(result, ax, "film_parameter")
        full = result.scene.effects.friction.lambda_full
        ax.axhline(full, color=GREY, linewidth=0.9)
        ax.text(358, full, "full film above", ha="right", va="bottom", fontsize=8.5, color=GREY)
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter(LogFormatter())
        ax.yaxis.set_minor_formatter(LogFormatter(minor_thresholds=(1.5, 0.5)))
        ax.set_ylabel(r"film parameter $\Lambda$")
        legend(ax, ncols=2)
    return ax
