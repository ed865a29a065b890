"""Pictures of torque, power and energy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from trbdyn.plotting.cage import revolutions
from trbdyn.plotting.style import COLOURS, canvas, legend, line

if TYPE_CHECKING:
    from trbdyn.results import Result


def _bars(ax: Axes, values: Mapping[str, float], unit: str, total: float) -> None:
    """Horizontal bars, the largest on top, each with its number and share; what is exactly zero is left out."""
    shown = sorted(((value, name) for name, value in values.items() if value), key=lambda pair: abs(pair[0]))
    numbers = np.array([value for value, _ in shown])
    ax.barh([name.replace("_", " ") for _, name in shown], numbers, color=COLOURS[0], height=0.6)
    for place, value in enumerate(numbers):
        share = f" ({100 * value / total:.3g} %)" if total else ""
        offset = 4 if value >= 0 else -4
        ax.annotate(
            f"{value:.3g} {unit}{share}",
            (value, place),
            xytext=(offset, 0),
            textcoords="offset points",
            va="center",
            ha="left" if value >= 0 else "right",
            fontsize=9,
        )
    ax.axvline(0, color="black", linewidth=0.8)
    ax.grid(axis="y", visible=False)
    ax.margins(x=0.32)
    if numbers.size and numbers.min() >= 0:
        ax.set_xlim(left=0)


def torque_split(result: Result, ax: Axes | None = None) -> Axes:
    """Mean share of each source in the shaft's friction torque.

    Parameters
    ----------
    result : Result
        Needs the group torque.
    ax : Axes, optional
        Axes to draw into.

    Returns
    -------
    Axes
    """
    total = float(result["inner_torque"].mean())
    with canvas(ax, (6.4, 2.8)) as ax:
        _bars(ax, result.torque_split, "N m", total)
        ax.set_xlabel(f"shaft torque (N m), {total:.4g} N m in all")
    return ax


def power_split(result: Result, ax: Axes | None = None) -> Axes:
    """Mean power loss of each kind.

    Parameters
    ----------
    result : Result
        Needs the group energy or power.
    ax : Axes, optional
        Axes to draw into.

    Returns
    -------
    Axes
    """
    split = result.power_split
    total = sum(split.values())
    with canvas(ax, (6.4, 3.0)) as ax:
        _bars(ax, split, "W", total)
        ax.set_xlabel(f"power loss (W), {total:.4g} W in all")
    return ax


def energy_audit(result: Result, ax: Axes | None = None) -> Axes:
    """The energy audit over the turns of the shaft: size of the work put in, the losses, the stored energy and the residual.

    Parameters
    ----------
    result : Result
        Needs the groups time and energy.
    ax : Axes, optional
        Axes to draw into.

    Returns
    -------
    Axes
    """
    balance = result.energy_balance
    work = np.sum([values for name, values in balance.items() if name.startswith("work_")], axis=0)
    losses = np.sum([values for name, values in balance.items() if name.startswith("loss_")], axis=0)
    stored = balance["kinetic_energy"] + balance["elastic_energy"]
    closure = result.energy_closure
    with canvas(ax) as ax:
        turned = revolutions(result)
        rest = f"residual ({closure:.1e} of the losses)"
        curves = {"work put in": work, "losses": losses, "stored": stored, rest: balance["residual"]}
        for index, (name, values) in enumerate(curves.items()):
            size = np.abs(values)
            line(ax, turned[size > 0], size[size > 0], index, name, linewidth=(2.4, 1.2, 0.8, 0.8)[index])
        ax.set_yscale("log")
        ax.set(xlabel="shaft revolutions", ylabel="size since the start (J)", xlim=(turned[0], turned[-1]))
        legend(ax)
    return ax
