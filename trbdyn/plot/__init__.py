"""Engineers' pictures of a result: ``trb.plot.cage_locus(result)``.

Every function takes a `Result`, and axes to draw into (``ax=``) unless it needs a whole figure; it gives the axes, or
the figure, back. The style holds for the new picture only: nothing global is changed, and no window is opened.
"""

# ruff: isort: skip_file
from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Final

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from trbdyn.base.expected import expect
from trbdyn.base.own_files import folder_path, output_path
from trbdyn.errors import FileError, InputError, unknown_name
from trbdyn.plot import described, style
from trbdyn.plot.around import (
    attitude as attitude,
    contact_map as contact_map,
    film_map as film_map,
    load_zone as load_zone,
    pocket_polar as pocket_polar,
    pressure_map as pressure_map,
)
from trbdyn.plot.assembly import (
    bearing_loads as bearing_loads,
    load_zones as load_zones,
    preload_diagram as preload_diagram,
    shaft_drawing as shaft_drawing,
    shaft_motion as shaft_motion,
    shaft_orbits as shaft_orbits,
)
from trbdyn.plot.cage import (
    axial_motion as axial_motion,
    cage_locus as cage_locus,
    orbit_radius as orbit_radius,
    spectrum as spectrum,
    tilt as tilt,
    whirl_map as whirl_map,
)
from trbdyn.plot.contact_line import contact_line as contact_line
from trbdyn.plot.contact_pressure import contact_pressure as contact_pressure
from trbdyn.plot.drawing import (
    bearing_drawing as bearing_drawing,
    cage_drawing as cage_drawing,
    pocket_drawing as pocket_drawing,
    profile_trace as profile_trace,
)
from trbdyn.plot.elastic import cage_shape as cage_shape, cage_stress as cage_stress
from trbdyn.plot.energy import energy_audit as energy_audit, power_split as power_split, torque_split as torque_split
from trbdyn.plot.ring import (
    ring_motion as ring_motion,
    ring_orbit as ring_orbit,
    ring_orders as ring_orders,
    ring_spectrum as ring_spectrum,
)
from trbdyn.plot.rollers import (
    contact_loads as contact_loads,
    film_parameter as film_parameter,
    pocket_forces as pocket_forces,
    pocket_statistics as pocket_statistics,
    spacing_angles as spacing_angles,
)
from trbdyn.plot.sound import force_spectrum as force_spectrum, octave_levels as octave_levels
from trbdyn.plot.wearing import wear_map as wear_map
from trbdyn.plot.whirling import poincare as poincare, torque_sources as torque_sources, waterfall as waterfall
from trbdyn.plot.assembly import of_result as _of_shaft
from trbdyn.plot.style import STYLE as STYLE
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.conditions import ranges, spoken
from trbdyn.results.result import Result

__all__ = ["PICTURES", "STYLE", "all", "conditions", "drawable", "make_folder", "save"]


def __dir__() -> list[str]:
    return sorted(__all__)


GROUPS: Final[dict[str, tuple[str, ...]]] = {
    "cage_locus": ("cage",),
    "orbit_radius": ("cage", "rollers"),
    "axial_motion": ("cage",),
    "tilt": ("cage",),
    "spectrum": ("cage",),
    "spacing_angles": ("rollers",),
    "pocket_forces": ("pocket",),
    "pocket_statistics": ("pocket",),
    "contact_loads": ("rollers", "contacts"),
    "film_parameter": ("rollers", "contacts"),
    "torque_split": ("torque",),
    "power_split": ("power",),
    "energy_audit": ("energy",),
    "load_zone": ("rollers", "contacts"),
    "pressure_map": ("cage", "rollers"),
    "film_map": ("cage", "rollers"),
    "attitude": ("rollers",),
    "pocket_polar": ("pocket",),
    "poincare": ("cage",),
    "torque_sources": ("torque",),
    "ring_orbit": ("ring",),
    "ring_motion": ("ring",),
}
"""Groups that the pictures of one result need; those of the group ring are of a ring that moves by itself."""

_KINDS: Final = {"Result": Result, "AssemblyResult": AssemblyResult}
for _name, _draw in list(globals().items()):
    if inspect.isfunction(_draw) and _draw.__module__.startswith(f"{__name__}.") and not _name.startswith("_"):
        __all__ += [_name]
        described.describe(_draw, GROUPS.get(_name, ()))
        _kind = _KINDS.get(next(iter(inspect.signature(_draw).parameters.values())).annotation)
        globals()[_name] = _draw if _kind is None else described.of_its_kind(_draw, _kind)

Picture = Callable[["Result"], Axes | Figure]

PICTURES: Final[dict[str, tuple[Picture, tuple[str, ...]]]] = {
    **{name: (globals()[name], groups) for name, groups in GROUPS.items()},
    "housing_orbit": (partial(ring_orbit, ring="outer"), ("housing",)),
    "housing_motion": (partial(ring_motion, ring="outer"), ("housing",)),
}
"""Pictures of one result, by name, and the groups that each needs."""

_OF_ROLLERS: Final = ("pressure_map", "film_map")
"""Pictures that need the group cage where there is a cage, and are of the rollers."""

SPECTRUM_RECORDS: Final = 8
"""Fewest records of a spectrum."""


def save(
    picture: Axes | Figure, path: str | os.PathLike[str], title: str | None = None, *, overwrite: bool = False
) -> Path:
    """Save a picture and close its figure.

    Parameters
    ----------
    picture : Axes or Figure
        What a function of this module gave.
    path : path-like
        File to write; its ending gives the format.
    title : str, optional
        A line under the figure's own title, which names the quantity.
    overwrite : bool
        Replace a file that is there.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        If no picture has this ending.
    FileError
        If the file is there and shall not be replaced, or cannot be written.
    """
    figure = picture.figure
    while not isinstance(figure, Figure):
        figure = figure.figure
    try:
        with style.styled():
            if title:
                quantity = figure.get_suptitle()
                figure.suptitle(f"{quantity}\n{title}" if quantity else title, fontsize=10)
            return style.write(figure, path, overwrite=overwrite)
    finally:
        plt.close(figure)


def all(
    result: Result | AssemblyResult,
    folder: str | os.PathLike[str],
    only: Iterable[str] | None = None,
    title: str | None = None,
    *,
    overwrite: bool = False,
) -> list[Path]:
    """Save every picture that the recorded groups allow, as PNG; those of the cage only if there is one.

    Parameters
    ----------
    result : Result or AssemblyResult
        The run. The pictures of each bearing of an assembly go into a folder of its name.
    folder : path-like
        Folder to write to; made if it is missing.
    only : iterable of str, optional
        Names of the pictures to draw, of those in `PICTURES`; all by default.
    title : str, optional
        A line under the title of every picture, which names the quantity; by default bearing, speed and loads.
    overwrite : bool
        Replace files that are there.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    FileError
        If a file is there and shall not be replaced (nothing is written then), or cannot be written.
    InputError
        If a picture is unknown, or needs a group that was not recorded.
    """
    expect("result", result, Result, AssemblyResult)
    of_shaft = _of_shaft(result)
    wanted = None if only is None else list(only)
    drawn: dict[Path, tuple[Callable[[], Axes | Figure], str | None]] = {
        Path(f"{name}.png"): (of_shaft[name], title)
        for name in (of_shaft if wanted is None else wanted)
        if name in of_shaft
    }
    for place, one in result.by_name.items():
        chosen = drawable(one) if wanted is None else [name for name in wanted if name not in of_shaft]
        _check(one, chosen)
        heading = conditions(one) if title is None else title
        drawn |= {Path(place, f"{name}.png"): (partial(PICTURES[name][0], one), heading) for name in chosen}
    folder = make_folder(folder)
    for path in drawn:  # before the first is drawn
        output_path(make_folder(folder / path.parent) / path.name, overwrite=overwrite)
    return [save(draw(), folder / path, heading, overwrite=overwrite) for path, (draw, heading) in drawn.items()]


def _check(result: Result, pictures: Sequence[str]) -> None:
    for name in pictures:
        if name not in PICTURES:
            raise InputError.of("only", name, unknown_name(name, PICTURES))
    least = SPECTRUM_RECORDS if "spectrum" in pictures else 2
    if pictures and len(result) < least:
        raise InputError.of("result", len(result), f"must have at least {least} records to draw this")


def drawable(result: Result) -> tuple[str, ...]:
    """Names of the pictures that the recorded groups allow; those of the cage if there is one, of the ring if it is free.

    Parameters
    ----------
    result : Result
        The run.
    """
    there = set(result.groups) - (set() if result.has_cage else {"pocket"})
    if not result.ring_moves:
        there -= {"ring"}
    if not result.housing_moves:
        there -= {"housing"}
    names = [name for name, (_, groups) in PICTURES.items() if set(groups) <= there]
    if len(result) < SPECTRUM_RECORDS:
        names = [name for name in names if name != "spectrum"]
    return tuple(name for name in names if result.has_cage or name in _OF_ROLLERS or "cage" not in PICTURES[name][1])


def conditions(result: Result) -> str:
    """Bearing, speed and loads of a run, for a title."""
    scene = result.scene
    found = ranges(result)
    parts = [f"{spoken(found['speed'])} rpm"]
    if scene.outer_turns:
        parts.append(f"outer ring {spoken(found['outer ring'])} rpm")
    if "assembly" in result.meta:
        parts.insert(0, f"{result.meta['assembly']['bearing']} on its shaft")
        if "ring" in result.groups:
            axial, radial = (float(load.mean()) for load in result.ring_loads)
            parts.append(f"mean $F_a$ {axial:.4g} N, $F_r$ {radial:.4g} N")
    for symbol, name in (("Fa", "$F_a$"), ("Fr", "$F_r$")):
        if any(found.get(symbol, ())):
            parts.append(f"{name} {spoken(found[symbol])} N")
    return f"{style.plain(scene.bearing.name)}: {', '.join(parts)}"


def make_folder(folder: str | os.PathLike[str]) -> Path:
    """A folder, made if it is missing.

    Raises
    ------
    FileError
        If it cannot be made.
    """
    folder = folder_path(folder, "folder")
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder}: the folder cannot be made: {error.strerror}") from error
    return Path(folder)
