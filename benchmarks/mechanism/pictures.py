"""Pictures of the mechanism; every function gives a figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import common
import numpy as np
from matplotlib import ticker
from numpy.typing import NDArray

from trbdyn.plot.style import COLOURS, GREY, LIGHT, LINES, MARKERS, STYLE
from trbdyn.results.result import Result

from . import motions
from .slip import SIDES, Budget

Array = NDArray[np.float64]
Rows = Sequence[Mapping[str, Any]]

KINDS = ("stable", "rocking", "circling", "unstable")
MEASURED = "measured"
MOST_ORDER = 14.0

plt = common.pyplot()


def _plainly(value: float, _: int) -> str:
    return f"{value:g}"


def short(name: str) -> str:
    """A point's name for a title: ``3000 rpm, 4930 N, whirl``."""
    return name.replace("rpm", " rpm").replace("N", " N").replace("_", ", ")


def frequencies(rows: Rows) -> Any:
    """Whirl frequency against cage frequency."""
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(1, 2, figsize=(9.0, 3.9))
        most = 1.1 * max(row["cage_hz"] for row in rows)
        for index, kind in enumerate(KINDS):
            mine = [row for row in rows if row["kind"] == kind]
            style = {"linestyle": "none", "marker": MARKERS[index], "color": COLOURS[index], "alpha": 0.75}
            face = COLOURS[index] if kind == "circling" else "none"
            label = f"{kind} ({len(mine)})"
            x = np.array([row["cage_hz"] for row in mine])
            # spread points of one speed, so that they can be told apart
            x = x + 0.012 * most * (np.arange(x.size) % 7 - 3)
            axes[0].plot(x, [row["whirl_hz"] for row in mine], markerfacecolor=face, label=label, **style)
            axes[1].plot(
                [row["orbit_over_cpr"] for row in mine],
                [row["synchronous_share"] for row in mine],
                markerfacecolor=face,
                label=label,
                **style,
            )
        axes[0].plot([0.0, most], [0.0, most], color=GREY, linestyle=LINES[1], label="cage frequency")
        axes[0].set_yticks(np.arange(-120.0, 61.0, 20.0))
        axes[0].set(xlim=(0.0, most), xlabel="cage frequency (Hz)", ylabel="whirl frequency (Hz)")
        axes[0].set_title("mean rate of the centre's angle about its mean place", fontsize=9)
        axes[0].legend(loc="lower right", fontsize=8)
        axes[1].set(ylim=(-0.02, 1.05), xlabel="orbit (rms) over $C_{pr}$", ylabel="share of the motion (1)")
        axes[1].set_title("share that turns with the cage", fontsize=9)
        fig.suptitle("Whirl against the rotation of the cage, all points (positive: with the shaft)", fontsize=10)
    return fig


def spectra(results: Mapping[str, Result]) -> Any:
    """Two-sided spectra of the centre over orders of the cage."""
    columns = min(3, len(results))
    lines = -(-len(results) // columns)
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(
            lines,
            columns,
            figsize=(3.1 * columns + 0.4, 2.2 * lines + 0.6),
            squeeze=False,
            sharex=True,
            sharey=True,
        )
        for ax, (name, result) in zip(axes.flat, results.items(), strict=False):
            order, density = motions.spectrum(result)
            kept = np.abs(order) <= MOST_ORDER
            ax.axvline(1.0, color=LIGHT, linewidth=3.0)
            ax.semilogy(order[kept], np.maximum(density[kept], 1e-9), color=COLOURS[0], linewidth=0.7)
            ax.set_title(f"{short(name)}: {result.cage_motion.kind}", fontsize=8.5)
            ax.set_ylim(1e-8, 10.0)
        for ax in axes[-1]:
            ax.set_xlabel("order of the cage (negative: backward)", fontsize=9)
        for ax in axes[:, 0]:
            ax.set_ylabel("density ($C_{pr}^2$ an order)", fontsize=9)
        fig.suptitle("Spectra of the cage's centre x + i y; grey: the cage's own frequency", fontsize=10)
    return fig


def leans(results: Mapping[str, Result]) -> Any:
    """Lean of the cage's axis seen from the direction of its displacement, as histograms on a circle."""
    columns = len(results)
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(
            1, columns, figsize=(2.7 * columns, 3.4), squeeze=False, subplot_kw={"projection": "polar"}
        )
        edges = np.linspace(-np.pi, np.pi, 37)
        for ax, (name, result) in zip(axes[0], results.items(), strict=True):
            place, axis = motions.displacement(result), motions.lean(result)
            found = motions.phasor(place, axis)
            size, _ = np.histogram(np.angle(axis * np.conj(place)), edges)
            middle = 0.5 * (edges[1:] + edges[:-1])
            share = 100.0 * size / size.sum()
            ax.bar(middle, share, width=edges[1] - edges[0], color=COLOURS[5], edgecolor="white", linewidth=0.3)
            arrow = found.coherence * share.max()
            ax.plot([0.0, np.radians(found.phase_deg)], [0.0, arrow], color=COLOURS[6], linewidth=2.0)
            ax.set_title(f"{short(name)}\nphase {found.phase_deg:+.0f}°, coherence {found.coherence:.2f}", fontsize=8.5)
            ax.tick_params(labelsize=7)
            ax.set_yticks([5.0, 10.0], ["5 %", "10 %"])
            ax.set_rlabel_position(225)
        fig.suptitle("Direction of the cage's lean, seen from its displacement (0°: the axis leans to it)", fontsize=10)
    return fig


def attitudes(results: Mapping[str, Result]) -> Any:
    """Skew and tilt of the rollers over their place in a turn of the cage."""
    columns = len(results)
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(2, columns, figsize=(3.5 * columns + 0.3, 4.6), squeeze=False, sharex=True)
        for column, (name, result) in enumerate(results.items()):
            angle = result["roller_orbit_angle"]
            last = np.abs(angle[:, 0] - angle[-1, 0]) <= 2.0 * np.pi
            for ax, field in zip(axes[:, column], ("roller_skew", "roller_tilt"), strict=True):
                for roller in range(angle.shape[1]):
                    place = np.degrees(angle[last, roller]) % 360.0
                    order = np.argsort(place)
                    style = {"color": COLOURS[0], "zorder": 3} if roller == 0 else {"color": LIGHT, "linewidth": 0.6}
                    ax.plot(place[order], 1e6 * result[field][last, roller][order], **style)
            axes[0, column].set_title(short(name), fontsize=8.5)
            axes[1, column].set(xlabel="orbit angle from x (deg)", xticks=[0, 90, 180, 270, 360])
        axes[0, 0].set_ylabel("skew (µrad)")
        axes[1, 0].set_ylabel("tilt (µrad)")
        fig.suptitle("Skew and tilt of the rollers over one turn of the cage (blue: roller 1)", fontsize=10)
    return fig


def slips(found: Budget, exponents: Mapping[str, float], title: str) -> Any:
    """Rolling resistance, coefficient that it takes, and slip over the load."""
    names = ("rolling", "coefficient", "slide_roll")
    labels = ("rolling resistance (N)", "sliding friction / load (1)", "slide-roll ratio, absolute (1)")
    with plt.rc_context(STYLE):
        fig, axes = plt.subplots(1, 3, figsize=(10.2, 3.6))
        for ax, name, label in zip(axes, names, labels, strict=True):
            for index, side in enumerate(SIDES):
                load, values = found.load[:, index].ravel(), np.abs(getattr(found, name)[:, index]).ravel()
                ax.loglog(
                    load,
                    values,
                    linestyle="none",
                    marker="os"[index],
                    markersize=2.2,
                    color=COLOURS[index],
                    label=f"{side}, $\\propto$ load$^{{{exponents[f'{name}_{side}']:.2f}}}$",
                )
            if name != "slide_roll":
                power = 0.246 if name == "rolling" else 0.246 - 1.0
                middle = np.exp(np.log(found.load).mean())
                height = np.exp(np.log(np.abs(getattr(found, name))).mean())
                x = np.geomspace(found.load.min(), found.load.max(), 20)
                ax.loglog(
                    x, height * (x / middle) ** power, color="black", linestyle=LINES[1], label=f"load$^{{{power:g}}}$"
                )
            ax.set(xlabel="load at the raceway (N)", ylabel=label)
            ax.xaxis.set_minor_locator(ticker.LogLocator(subs=(1.5, 2.0, 2.5)))
            for scale in (ax.xaxis, ax.yaxis) if name == "rolling" else (ax.xaxis,):
                scale.set_major_formatter(_plainly)
                scale.set_minor_formatter(_plainly)
            ax.legend(fontsize=8)
        fig.suptitle(f"Slip budget of the rollers over one turn of the cage, {title}", fontsize=10)
    return fig


def torques(rows: Rows, measured: Mapping[float, float], axial_load: float) -> Any:
    """Friction torque over speed against measurements."""
    with plt.rc_context(STYLE):
        fig, ax = plt.subplots(figsize=(6.0, 3.8))
        for index, force in enumerate((False, True)):
            mine = [row for row in rows if row["pressure_force"] is force]
            words = "with" if force else "without"
            label = f"simulated, {words} the rolling film's pressure force"
            speed = [row["speed_rpm"] for row in mine]
            ax.plot(
                speed, [row["inner_torque"] for row in mine], color=COLOURS[index], marker=MARKERS[index], label=label
            )
        ax.plot(
            list(measured),
            list(measured.values()),
            color="black",
            marker="x",
            markersize=8,
            linestyle="none",
            label=MEASURED,
        )
        ax.set(xlim=(0.0, None), ylim=(0.0, None), xlabel="speed (rpm)", ylabel="torque on the inner ring (N m)")
        ax.set_title(f"32216, $F_a$ {axial_load:g} N, oil 50 °C", fontsize=10)
        ax.legend(loc="lower right", fontsize=8.5)
    return fig


def reaches(rows: Rows) -> Any:
    """Movable distance over the spacing of the rollers, in runs and by geometry."""
    with plt.rc_context(STYLE):
        fig, ax = plt.subplots(figsize=(6.0, 3.8))
        x = [row["eccentricity"] for row in rows]
        names = ("reach", "geometry", "free")
        words = ("run", "geometry, rollers held as at the start", "geometry, rollers that give way")
        for index, (name, label) in enumerate(zip(names, words, strict=True)):
            values = [row[name] for row in rows]
            ax.plot(x, values, linestyle="none", marker=("o", "x", "_")[index], color=COLOURS[2 * index], label=label)
        ax.set(ylim=(0.0, 1.1), xlabel="unevenness of the spacing: cage's place that it is centred for, over $C_{pr}$")
        ax.set_ylabel("movable distance over $C_{pr}$")
        ax.legend(loc="lower right")
        ax.set_title("Fig. 17 by simulation: cage pushed by its weight; 0: equal spacing", fontsize=10)
    return fig
