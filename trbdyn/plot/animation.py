"""A moving picture of cage and rollers in the x-y plane."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.artist import Artist
from matplotlib.patches import Circle
from scipy.integrate import cumulative_trapezoid

from trbdyn.base.expected import expect
from trbdyn.base.own_files import output_path, write_whole
from trbdyn.errors import FileError, InputError, TrbError
from trbdyn.plot.cage import last_turns, revolutions
from trbdyn.plot.style import COLOURS, GREY, LIGHT, styled
from trbdyn.results.result import Result

__all__ = ["animate", "save"]


def __dir__() -> list[str]:
    return sorted(__all__)


RING_POINTS = 181
ENDINGS = (".gif",)


def animate(
    result: Result, last: float = 5.0, frames: int = 120, fps: int = 20, exaggeration: float = 20.0
) -> FuncAnimation:
    """Cage and rollers turning, seen along the bearing axis, with the cage's locus beside them.

    Races and rollers are true to scale at mid length of the rollers; a line on each roller shows its spin. The cage's
    displacement is drawn larger by a factor.

    Parameters
    ----------
    result : Result
        Needs the groups time, cage and rollers.
    last : float
        Number of last shaft revolutions to show.
    frames : int
        Number of frames.
    fps : int
        Frames a second.
    exaggeration : float
        Factor of the cage's displacement.

    Returns
    -------
    FuncAnimation
        Show it in a notebook with ``to_jshtml()``, or save it with `save`.

    Raises
    ------
    InputError
        If a number is not positive or a group was not recorded.
    """
    expect("result", result, Result)
    for name, value in (("last", last), ("frames", frames), ("fps", fps)):
        if not value > 0:
            raise InputError.of(name, value, "must be > 0")
    shown = last_turns(result, last)
    picked = np.unique(np.linspace(0, len(shown) - 1, frames).astype(int))
    geometry = result.geometry
    position = 1e3 * shown["roller_position"][picked, :, :2]
    spin = cumulative_trapezoid(shown["roller_spin_speed"], shown["time"], axis=0, initial=0.0)[picked]
    spin += shown["roller_orbit_angle"][picked]
    centre = 1e3 * exaggeration * shown["cage_position"][picked, :2]
    locus, turned = shown.cage_locus(), revolutions(shown)[picked]
    outer, inner = 1e3 * geometry["outer_race_radius"], 1e3 * geometry["inner_race_radius"]
    size = 0.25e3 * (geometry["large_end_diameter"] + geometry["small_end_diameter"])

    with styled():
        figure, (view, path) = plt.subplots(1, 2, figsize=(8.6, 4.6), width_ratios=(1.7, 1.0))
        view.set(aspect="equal", xlim=(-1.15 * outer, 1.15 * outer), ylim=(-1.15 * outer, 1.15 * outer))
        view.set(xlabel="x (mm)", ylabel="y (mm)", title=f"cage displacement x {exaggeration:g}")
        view.add_patch(Circle((0, 0), outer, fill=False, linewidth=1.5))
        view.add_patch(Circle((0, 0), inner, fill=False, linewidth=1.5))
        rollers = [
            view.add_patch(Circle((0, 0), size, facecolor=LIGHT, edgecolor="black", linewidth=0.8)) for _ in spin[0]
        ]
        marks = [view.plot([], [], color="black", linewidth=1.0)[0] for _ in spin[0]]
        ring = view.plot([], [], color=COLOURS[0], linewidth=2.5)[0]
        hub = view.plot([], [], color=COLOURS[0], marker="+", markersize=10)[0]
        path.add_patch(Circle((0, 0), 1.0, fill=False))
        path.plot(locus[:, 0], locus[:, 1], color=GREY, linewidth=0.6)
        dot = path.plot([], [], color=COLOURS[0], marker="o")[0]
        reach = 1.1 * max(1.0, float(np.abs(locus).max()))
        path.set(aspect="equal", xlim=(-reach, reach), ylim=(-reach, reach), xlabel="$x/C_{pr}$", ylabel="$y/C_{pr}$")

    around = np.linspace(0.0, 2.0 * np.pi, RING_POINTS)
    pitch = 0.5 * (outer + inner)

    def draw(frame: int) -> list[Artist]:
        for roller, mark, place, angle in zip(rollers, marks, position[frame], spin[frame], strict=True):
            roller.center = place[0], place[1]
            tip = size * np.array([np.cos(angle), np.sin(angle)])
            mark.set_data([place[0], place[0] + tip[0]], [place[1], place[1] + tip[1]])
        x, y = centre[frame]
        ring.set_data(x + pitch * np.cos(around), y + pitch * np.sin(around))
        hub.set_data([x], [y])
        dot.set_data([locus[picked[frame], 0]], [locus[picked[frame], 1]])
        path.set_title(f"shaft revolution {turned[frame]:.2f}", fontsize=10)
        return [*rollers, *marks, ring, hub, dot]

    return FuncAnimation(figure, draw, frames=picked.size, interval=1000.0 / fps, blit=False)


def save(
    animation: FuncAnimation, path: str | os.PathLike[str], fps: int = 20, dpi: int = 80, *, overwrite: bool = False
) -> Path:
    """Write an animation as a GIF and close its figure.

    Parameters
    ----------
    animation : FuncAnimation
        What `animate` gave.
    path : path-like
        File to write.
    fps : int
        Frames a second.
    dpi : int
        Dots per inch.
    overwrite : bool
        Replace a file that is there.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        If its name does not end in .gif.
    FileError
        If the file is there and shall not be replaced, or cannot be written.
    """
    try:
        output_path(path, overwrite=overwrite, field="path", endings=ENDINGS)
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder) / "animation.gif"
            animation.save(made, writer=PillowWriter(fps=fps), dpi=dpi)
            content = made.read_bytes()
    except (OSError, ValueError) as error:
        if isinstance(error, TrbError):
            raise
        raise FileError(f"{path}: the animation cannot be written: {error}") from error
    finally:
        plt.close(animation._fig)  # type: ignore[attr-defined]
    return write_whole(path, content, overwrite=overwrite, endings=ENDINGS)
