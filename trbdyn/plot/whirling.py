"""Pictures of the whirl as a dynamical system: Poincaré section, spectra over speed; and the shaft's torque over
time.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from numpy.typing import NDArray

from trbdyn.base.display import plain as number
from trbdyn.errors import InputError
from trbdyn.plot.cage import revolutions, turns_label
from trbdyn.plot.style import COLOURS, GREY, LINES, canvas, legend, line, scaled, sequence, thin
from trbdyn.results import observables
from trbdyn.results.result import Result

Array = NDArray[np.float64]


def section_points(result: Result, once_per: Literal["cage", "shaft", "roller"] = "cage") -> Array:
    """Places of the cage's centre, in units of Cpr, each time a body has turned once more: between records, shape (n, 2).

    A turn of the cage, a turn of the shaft, or a pitch of the cage (the next roller at the same place).
    """
    periods = {"cage": 2.0 * np.pi, "shaft": 2.0 * np.pi, "roller": 2.0 * np.pi / result.scene.bearing.n_rollers}
    if once_per not in periods:
        raise InputError.of("once_per", once_per, "must be 'cage', 'shaft' or 'roller'")
    angle = np.abs(result.turned if once_per == "shaft" else result["cage_angle"])
    period, path = periods[once_per], result.cage_locus()
    first, last = int(np.ceil(angle[0] / period)), int(np.floor(angle[-1] / period))
    wanted = period * np.arange(first, last + 1)
    return np.stack([np.interp(wanted, angle, path[:, k]) for k in range(2)], axis=1)


def poincare(result: Result, ax: Axes | None = None, once_per: Literal["cage", "shaft", "roller"] = "cage") -> Axes:
    """Poincaré section of the whirl: the cage's centre once a turn, light to dark in time.

    A whirl that repeats itself with the turn gives one point, one with a second frequency a closed curve, a chaotic
    one a cloud.

    Examples
    --------
    >>> import trbdyn as trb
    >>> result = trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))).run(revolutions=5)
    >>> trb.plot.poincare(result).get_xlabel()
    '$x/C_{pr}$'
    """
    points, path = section_points(result, once_per), result.cage_locus()
    words = {"cage": "turn of the cage", "shaft": "turn of the shaft", "roller": "pitch of the cage"}[once_per]
    with canvas(ax, (5.4, 4.8), "Poincaré section of the cage's centre") as ax:
        keep = max(1, len(path) // 20000)
        ax.plot(*path[::keep].T, color="#CCCCCC", linewidth=0.4, zorder=1, label="whole path")
        dots = ax.scatter(
            points[:, 0],
            points[:, 1],
            c=np.arange(len(points)),
            cmap=sequence(),
            s=14,
            zorder=3,
            label=f"once a {words}",
        )
        ax.figure.colorbar(dots, ax=ax, shrink=0.8, pad=0.02).set_label(f"number of the {words}")
        ax.add_patch(Circle((0, 0), 1.0, fill=False, linewidth=1.1))
        reach = 1.08 * max(1.0, float(np.abs(path).max()))
        ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="$x/C_{pr}$", ylabel="$y/C_{pr}$")
        legend(ax, ncols=2)
    return ax


def waterfall(results: Sequence[Result], ax: Axes | None = None, reach: float = 3.0, decades: float = 5.0) -> Axes:
    """Spectra of the cage's motion over the shaft's speed: one line for each run, one above the other.

    Parameters
    ----------
    results : sequence of Result
        Runs at different speeds; need the groups time and cage.
    reach : float
        Frequencies from minus to plus this many times the shaft's frequency; negative ones whirl backwards.
    decades : float
        Height of a line: decades of the spectral density below its peak.

    Raises
    ------
    InputError
        If there is no run, or a run has too few records.

    Examples
    --------
    >>> import trbdyn as trb
    >>> runs = [trb.Simulation(trb.cases.scene_30310(speed, 4930.0)).run(revolutions=2) for speed in (1000.0, 2000.0)]
    >>> trb.plot.waterfall(runs).get_ylabel()
    'shaft speed (rpm)'
    """
    runs = sorted(results, key=_speed)
    if not runs:
        raise InputError.of("results", [], "must hold at least one run")
    if not (reach > 0.0 and decades > 0.0):
        raise InputError.of("reach", (reach, decades), "must be > 0, as decades")
    speeds = [_speed(run) for run in runs]
    gaps = np.diff(speeds)
    height = 0.9 * float(gaps[gaps > 0].min()) if np.any(gaps > 0) else max(0.3 * speeds[0], 1.0)
    title = f"Spectra of the cage's motion over speed ({decades:g} decades each)"
    with canvas(ax, (6.4, 1.8 + 0.45 * min(len(runs), 12)), title) as ax:
        for order, (run, speed) in enumerate(zip(runs, speeds, strict=True)):
            if len(run) < 16:
                raise InputError.of("results", f"{len(run)} records", "must have at least 16 records a run")
            place = run.cage_locus()
            frequency, density = observables.spectrum(run["time"], place[:, 0] + 1j * place[:, 1])
            order_of = frequency / (speed / 60.0)
            inside = np.abs(order_of) <= reach
            level = np.log10(np.maximum(density[inside], density[inside].max() * 10.0**-decades + 1e-300))
            level = (level - level.max() + decades) / decades
            x, y = thin(order_of[inside], level)
            ax.fill_between(x, speed, speed + height * y, color="white", zorder=10 - 0.01 * order, linewidth=0)
            ax.plot(x, speed + height * y, color=COLOURS[0], linewidth=0.9, zorder=10 - 0.01 * order)
        ratio = runs[0].geometry.get("cage_speed_ratio", 0.0)
        for multiple, words in ((ratio, "cage"), (1.0, "shaft")):
            ax.axvline(multiple, color=GREY, linewidth=0.8, linestyle=":", zorder=20)
            ax.annotate(
                words, (multiple, 1.0), xycoords=("data", "axes fraction"), fontsize=8.5, color=GREY, ha="center"
            )
        ax.set(xlim=(-reach, reach), xlabel="frequency / shaft frequency (negative: backward whirl)")
        ax.set_ylabel("shaft speed (rpm)")
        ax.set_yticks(sorted({round(speed) for speed in speeds}))
    return ax


def _speed(result: Result) -> float:
    return float(np.abs(result.turning_speed).mean()) * 30.0 / np.pi


def torque_sources(result: Result, ax: Axes | None = None) -> Axes:
    """Friction torque of the shaft by its sources, over the turns of the shaft."""
    turned = revolutions(result)
    shares = {
        field.name.removeprefix("inner_torque_").replace("_", " "): result[field.name]
        for field in result.fields
        if field.name.startswith("inner_torque_")
    }
    with canvas(ax, (6.4, 3.6), "Friction torque of the shaft by source") as ax:
        factor, unit = scaled("N m", result["inner_torque"])
        total = factor * result["inner_torque"]
        line(ax, turned, total, 2, f"sum (mean {number(total.mean())} {unit})", linestyle="-", linewidth=1.0)
        for index, (name, values) in enumerate(shares.items()):
            if np.any(values):
                look = {"color": COLOURS[(0, 1, 3, 4, 5, 6)[index % 6]], "linestyle": LINES[index % len(LINES)]}
                line(
                    ax,
                    turned,
                    factor * values,
                    0,
                    f"{name} ({number(factor * values.mean(), 3)} {unit})",
                    linewidth=0.9,
                    **look,
                )
        ax.axhline(0, color=GREY, linewidth=0.8)
        ax.set(xlabel=turns_label(result), ylabel=f"friction torque ({unit})", xlim=(turned[0], turned[-1]))
        legend(ax, ncols=2)
    return ax
