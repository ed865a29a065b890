"""Pictures of torque, power and energy."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from trbdyn.base.display import plain as number
from trbdyn.plot.cage import revolutions, turns_label
from trbdyn.plot.style import COLOURS, LINES, canvas, envelope, legend, scaled
from trbdyn.results.result import Result
from trbdyn.results.rows.losses import mean_loss, shaft_torque, torque_by_force, torque_by_loss


def _bars(ax: Axes, values: Mapping[str, float], si: str, total: float) -> tuple[float, str]:
    """Horizontal bars, the largest on top, each with its number and share; what is exactly zero is left out. Gives factor and
    unit in which they are shown.
    """
    factor, unit = scaled(si, total)
    shown = sorted(((value, name) for name, value in values.items() if value), key=lambda pair: abs(pair[0]))
    numbers = factor * np.array([value for value, _ in shown])
    ax.barh([name.replace("_", " ") for _, name in shown], numbers, color=COLOURS[0], height=0.6)
    for place, value in enumerate(numbers):
        share = f" ({100 * value / (factor * total):.3g} %)" if total else ""
        offset = 4 if value >= 0 else -4
        ax.annotate(
            f"{number(value, 3)} {unit}{share}",
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
    return factor, unit


def torque_split(result: Result, ax: Axes | None = None) -> Axes:
    """Friction torque of the shaft by what loses it: power loss of each mechanism over the shaft's speed.

    The shares are those of `power_split`. A line under the axis tells the forces on the inner ring that make this torque
    (`Result.torque_split`): traction on the inner raceway passes on what rolling resistance takes at the outer one, and loses
    little itself. Where the power losses were not recorded, the bars are these forces.

    Parameters
    ----------
    result : Result
        Needs the group torque; energy or power for the losses.
    """
    total, forces = shaft_torque(result), torque_by_force(result)
    if {"power", "energy"} & set(result.groups):
        split, title = torque_by_loss(result), "Friction torque of the shaft by what loses it"
        factor, unit = scaled("N m", total)
        told = ", ".join(
            f"{name.replace('_', ' ')} {number(factor * value, 3)}" for name, value in forces.items() if value
        )
        note = f"\nforces on the inner ring that make this torque:\n{told} {unit}"
    else:
        split, title, note = forces, "Friction torque of the shaft by the force on the inner ring", ""
    with canvas(ax, (6.4, 3.2), title) as ax:
        factor, unit = _bars(ax, split, "N m", total)
        ax.set_xlabel(f"torque ({unit}), {number(factor * total)} {unit} in all{note}")
    return ax


def power_split(result: Result, ax: Axes | None = None) -> Axes:
    """Mean power loss of each mechanism.

    Parameters
    ----------
    result : Result
        Needs the group energy or power.
    """
    split = result.power_split
    total = mean_loss(result)
    with canvas(ax, (6.4, 3.2), "Power loss by mechanism") as ax:
        factor, unit = _bars(ax, split, "W", total)
        ax.set_xlabel(f"power loss ({unit}), {number(factor * total)} {unit} in all")
    return ax


def energy_audit(result: Result, ax: Axes | None = None) -> Axes:
    """The energy audit over the turns of the shaft: work put in, losses, stored energy and residual, each since the first record.

    Sizes in a logarithmic scale. Of stored energy and residual, which go up and down, the largest size within each of some
    stretches of time is drawn.
    """
    balance = result.energy_balance
    work = np.sum([values for name, values in balance.items() if name.startswith("work_")], axis=0)
    losses = np.sum([values for name, values in balance.items() if name.startswith("loss_")], axis=0)
    stored = balance["kinetic_energy"] + balance["elastic_energy"]
    closure = result.energy_closure
    with canvas(ax, (6.4, 4.0), "Energy audit") as ax:
        turned = revolutions(result)
        factor, unit = scaled("J", work, losses)
        rest = f"residual, largest ({closure:.1e} of the losses at the end)"
        curves = {
            "work put in": work,
            "losses": losses,
            "change of stored energy, largest": stored,
            rest: balance["residual"],
        }
        for index, (name, values) in enumerate(curves.items()):
            x, size = envelope(turned, factor * np.abs(values))
            colour, width = (COLOURS[5], COLOURS[0], COLOURS[1], COLOURS[6])[index], (4.0, 1.4, 1.0, 1.0)[index]
            dashes = LINES[1] if index == 1 else "-"
            ax.plot(x[size > 0], size[size > 0], label=name, color=colour, linewidth=width, linestyle=dashes)
        ax.set_yscale("log")
        ax.set(xlabel=turns_label(result), ylabel=f"size since the start ({unit})", xlim=(turned[0], turned[-1]))
        legend(ax, ncols=2)
    return ax
