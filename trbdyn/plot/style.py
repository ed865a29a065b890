"""How the pictures look: readable in print, safe for colour-blind readers, told apart in grey."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike, NDArray

from trbdyn.base.display import step_of
from trbdyn.base.own_files import output_path, write_whole
from trbdyn.base.printable import printable
from trbdyn.errors import FileError

Array = NDArray[np.float64]

# Okabe and Ito's colours, ordered so that neighbours differ in lightness too.
COLOURS = ("#0072B2", "#E69F00", "#000000", "#009E73", "#CC79A7", "#56B4E9", "#D55E00")
LINES: tuple[Any, ...] = (
    "-",
    (0, (5, 1.5)),
    (0, (1, 1)),
    (0, (6, 1.5, 1, 1.5)),
    (0, (3, 1, 1, 1, 1, 1)),
    (0, (9, 2)),
    "-",
)
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
GREY = "#666666"
LIGHT = "#BFBFBF"

STYLE: Any = {
    "font.size": 10,
    "axes.titlesize": 10,
    "axes.labelsize": 10,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.fontsize": 9,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "axes.linewidth": 0.8,
    "lines.linewidth": 1.2,
    "figure.dpi": 110,
    "figure.figsize": (6.4, 4.0),
    "figure.constrained_layout.use": True,
    "image.cmap": "cividis",
    "agg.path.chunksize": 20000,
    "axes.formatter.useoffset": False,
}

SAVE_DPI = 200


OWN = "trbdyn"
"""Label of figures that a picture made for itself."""


def colour_of(index: int) -> tuple[float, float, float]:
    """A colour for each of many things: those of `COLOURS`, then the same ones half and more mixed with white."""
    share = 1.0 / (1.0 + index // len(COLOURS))
    red, green, blue = (1.0 - share * (1.0 - part) for part in to_rgb(COLOURS[index % len(COLOURS)]))
    return red, green, blue


@contextmanager
def styled() -> Iterator[None]:
    """The style inside the block; after it, what the style has changed is as before, and nothing else.

    Matplotlib's own ``rc_context`` puts back every setting, also those that a backend makes when the first figure loads it.
    In a notebook this is the one that shows figures at the end of a cell: only the first picture would ever appear.
    """
    before = {name: matplotlib.rcParams[name] for name in STYLE}
    matplotlib.rcParams.update(STYLE)
    try:
        yield
    finally:
        matplotlib.rcParams.update(before)


@contextmanager
def canvas(ax: Axes | None, figsize: tuple[float, float] = (6.4, 4.0), title: str = "") -> Iterator[Axes]:
    """The given axes, or new ones in a figure of their own; the style holds inside the block only.

    The title names the quantity: above a figure of its own, or on given axes that have no title yet.
    """
    with styled():
        if ax is None:
            figure, ax = plt.subplots(figsize=figsize)
            figure.set_label(OWN)
            if title:
                figure.suptitle(title, fontsize=11)
        elif title and not ax.get_title():
            ax.set_title(title)
        yield ax


def is_own(ax: Axes) -> bool:
    """Whether the axes belong to a figure that a picture made for itself."""
    figure = ax.get_figure(root=True)
    return figure is not None and figure.get_label() == OWN


def sequence() -> Colormap:
    """A sequential map from dark blue to a yellow that still shows on white: even in lightness, so it works in grey."""
    return ListedColormap(plt.get_cmap("cividis")(np.linspace(0.0, 0.88, 256)), name="trbdyn")


def scaled(unit: str, *values: ArrayLike) -> tuple[float, str]:
    """Factor and unit in which numbers in SI are drawn, by the largest of them: those of `trbdyn.base.display`."""
    sizes = [np.abs(np.asarray(part, dtype=float)) for part in values]
    return step_of(unit, [float(one.max(initial=0.0, where=np.isfinite(one))) for one in sizes])


def legend(ax: Axes, **options: Any) -> None:
    """A legend: in a figure of its own above the axes, where it covers no data; on given axes inside them, as above them is
    the place of their title and of other axes.
    """
    handles, labels = ax.get_legend_handles_labels()
    if handles and not is_own(ax):
        options = {"fontsize": 8, **options, "ncols": 1}
        ax.legend(handles, labels, loc="best", frameon=True, framealpha=0.85, edgecolor="none", **options)
    elif handles:
        columns = options.pop("ncols", min(len(labels), 4))
        ax.legend(handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, **options)


def thin(x: Array, y: Array, points: int = 6000) -> tuple[Array, Array]:
    """A curve with at most about `points` points that looks the same: the smallest and the largest value of each bin."""
    if x.size <= points:
        return x, y
    bins = points // 2
    edges = np.linspace(0, x.size, bins + 1).astype(int)
    low = np.array([a + int(np.argmin(y[a:b])) for a, b in pairwise(edges)])
    high = np.array([a + int(np.argmax(y[a:b])) for a, b in pairwise(edges)])
    kept = np.unique(np.concatenate([low, high, [0, x.size - 1]]))
    return x[kept], y[kept]


def envelope(x: Array, y: Array, bins: int = 240) -> tuple[Array, Array]:
    """The largest of a signal in each of some bins, so that what goes up and down within a bin is one quiet line."""
    if x.size <= bins:
        return x, y
    edges = np.linspace(0, x.size, bins + 1).astype(int)
    return x[(edges[:-1] + edges[1:]) // 2], np.maximum.reduceat(y, edges[:-1])


def line(ax: Axes, x: Array, y: Array, index: int = 0, label: str | None = None, **options: Any) -> Line2D:
    """A thinned curve in the colour and dashes of its index."""
    style = {"color": COLOURS[index % len(COLOURS)], "linestyle": LINES[index % len(LINES)], "label": label} | options
    return ax.plot(*thin(x, y), **style)[0]


def pair(ax: Axes, x: Array, values: Array, label: str) -> None:
    """Curves of the x and the y part of a vector, shape (n, 2); the label has {} where x and y stand."""
    for index, name in enumerate("xy"):
        line(ax, x, values[:, index], 2 * index, label.format(name), linestyle=("-", "--")[index])


def plain(text: str) -> str:
    """A text that a user gave, as Matplotlib shows it letter by letter: no mathematics, nothing that moves a cursor."""
    return printable(text).replace("$", r"\$")


def write(figure: Figure, path: str | os.PathLike[str], *, overwrite: bool) -> Path:
    """Write a figure; the ending of the file gives the format."""
    formats = [f".{name}" for name in figure.canvas.get_supported_filetypes()]
    target, picture = output_path(path, overwrite=overwrite, field="path", endings=formats), io.BytesIO()
    try:
        figure.savefig(picture, dpi=SAVE_DPI, format=target.suffix[1:].lower())
    except (OSError, ValueError) as error:
        raise FileError(f"{path}: the picture cannot be written: {error}") from error
    return write_whole(path, picture.getvalue(), overwrite=overwrite)


def kept(figure: Figure, path: str | os.PathLike[str] | None, *, overwrite: bool) -> Figure:
    """The figure, written where a path is given."""
    if path is not None:
        with styled():
            write(figure, path, overwrite=overwrite)
    return figure
