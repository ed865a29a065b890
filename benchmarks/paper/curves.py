"""The paper's figures with the named set of inputs: curves of the points, which are run where their files are missing.

python docs/figures.py paper_09.png
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

from matplotlib.figure import Figure

from paper import figures
from paper.command import POINTS, run_points
from paper.point_numbers import Runs, read_run
from paper.points import FIGURES, Condition, Point, StartKind
from paper.settle import Plan
from paper.statements import NAMED
from trbdyn.errors import TrbError

SEED: Final = 1
DPI: Final = 100
LONGEST: Final = 40.0
"""Longest bearing time under axial load (s); whirls of these points settle within 20 s."""
SHORT: Final = 3.0
"""Bearing time before the statistics (s) under combined load, and where no whirl has to grow."""

Made = Callable[[Runs], dict[str, Figure]]
SHOWN: Final[dict[str, tuple[Made, tuple[Condition, ...], StartKind]]] = {
    "fig_09": (figures.figure_9, FIGURES["9"], "equal"),
    "fig_10": (figures.figure_10, FIGURES["10"], "equal"),
    "fig_11a_16a": (figures.figure_11_16, FIGURES["16a"], "equal"),
    "fig_13": (figures.figure_13, FIGURES["13"], "equal"),
    "fig_14": (figures.figure_14, FIGURES["14"], "equal"),
    "fig_15": (figures.figure_15, FIGURES["15"], "equal"),
    "fig_17": (figures.figure_17, FIGURES["17"], "equal"),
    "fig_18": (figures.figure_18, FIGURES["18"], "unequal"),
}
"""Figures that show curves over time or paths: who draws them, their points, and the start."""


def points_of(name: str) -> tuple[Point, ...]:
    """The points of a figure with the named set of inputs; one that has a scatter of its own keeps it."""
    _, conditions, start = SHOWN[name]
    return tuple(Point(c if c.scatter else c.within(NAMED), start, SEED) for c in conditions)


def runs_of(name: str, folder: Path) -> Runs:
    """Those points, from a folder of the campaign.

    Raises
    ------
    TrbError
        If a point fails.
    """
    wanted = points_of(name)
    missing = [point for point in wanted if not (folder / POINTS / f"{point.name}.h5").is_file()]
    for point in missing:
        plan = replace(Plan(), most_time=LONGEST, most_time_combined=SHORT)
        if point.condition.axial_load <= FIGURES["15"][0].axial_load:
            plan = replace(plan, least_time=SHORT, most_time=SHORT)
        failed = run_points([point], folder, plan, 1, resume=True)
        if failed:
            raise TrbError(f"{point.name}: {failed[point.name]}")
    found = [read_run(folder / POINTS / f"{point.name}.h5") for point in wanted]
    return Runs([run for run in found if run is not None]).within(NAMED)


def draw(name: str, path: Path, folder: Path) -> None:
    """Draw one figure, small enough for a page."""
    from PIL import Image

    made = SHOWN[name][0](runs_of(name, folder))[name]
    made.savefig(path, dpi=DPI, bbox_inches="tight")
    with Image.open(path) as picture:
        fewer = picture.convert("RGB").quantize(48)
    fewer.save(path, optimize=True)
