"""A result, of a bearing or of several on a shaft, as a moving 3-D view in a browser: one HTML file that needs no network.
A bearing's result can be saved as an animated glTF file, too.

The view is drawn by three.js, which the package jupyter-threejs-sage carries itself (0.6 MB, with orbit controls), so that
picking, histories, exaggerated motion and colours of one's own can be written against it.
"""

from __future__ import annotations

import html as markup
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

import numpy as np

from trbdyn.base.expected import expect
from trbdyn.base.own_files import output_path, write_whole
from trbdyn.errors import InputError
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.results.sources import files_of
from trbdyn.viewer import data as data_of
from trbdyn.viewer.gltf import save_gltf
from trbdyn.viewer.page import Shown, page
from trbdyn.viewer.shapes import shapes

__all__ = ["MAX_SIZE_MB", "View", "save_gltf", "view"]

MAX_SIZE_MB: Final = 12.0
"""Largest file that the view writes unless told otherwise (MB)."""
ENDINGS: Final = (".html", ".htm")
_FIXED_BYTES: Final = 900_000
"""Program, three.js and page (bytes)."""


class View:
    """A 3-D view of a result. In a notebook it shows itself.

    Parameters
    ----------
    html : str
        The page.
    height : int
        Height in a notebook (pixels).
    reads : iterable of Path
        Files of the result that is shown: the view never replaces them.

    Attributes
    ----------
    html : str
        The page: everything that it needs is in it.
    """

    def __init__(self, html: str, *, height: int = 640, reads: Iterable[Path] = ()) -> None:
        self.html = html
        self.height = height
        self._reads = tuple(reads)

    def __repr__(self) -> str:
        return f"<View: {len(self.html) / 1e6:.1f} MB; save(path) writes it as one HTML file>"

    def _repr_html_(self) -> str:
        inside = markup.escape(self.html, quote=True)
        return f'<iframe srcdoc="{inside}" width="100%" height="{self.height}" style="border:1px solid #ccc"></iframe>'

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the view as one HTML file.

        Parameters
        ----------
        path : path-like
            File to write, ``NAME.html``.
        overwrite : bool
            Replace a file that is there.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            If its name does not end in .html, or it is the file of the result.
        FileError
            If the file is there and shall not be replaced, or cannot be written.
        """
        return write_whole(path, self.html, overwrite=overwrite, endings=ENDINGS, reads=self._reads)


def view(
    result: Result | AssemblyResult,
    path: str | os.PathLike[str] | None = None,
    *,
    revolutions: float | None = 10.0,
    max_frames: int = 600,
    max_size_mb: float = MAX_SIZE_MB,
    exaggeration: float | None = None,
    title: str = "",
    height: int = 640,
    overwrite: bool = False,
) -> View:
    """Show a result as a moving 3-D view.

    Rings, rollers with their profile and the cage with the faces of its pockets move as recorded. Motion and
    clearances of cage and rollers are drawn larger by one factor, which is always shown; so a gap closes in the
    picture where it closes in the bearing.

    Parameters
    ----------
    result : Result or AssemblyResult
        Needs the groups time, cage and rollers; colours and arrows come from contacts and pocket. The bearings of an assembly
        are shown where they sit on the shaft, with one scale of colours and arrows for all of them.
    path : path-like, optional
        HTML file to write, ``NAME.html``.
    revolutions : float or None
        Number of last turns of the shaft to show; None shows the whole run.
    max_frames : int
        Most records to take. Between two the motion is interpolated; forces in pockets are the largest since the
        record before.
    max_size_mb : float
        Largest size of the file (MB): fewer records are taken if it needs more.
    exaggeration : float, optional
        Factor by which motion and clearances are drawn larger at the start, at least 1; by default the radial play of
        the cage is drawn as about a fifth of the roller's diameter. It is limited so that the bars of the cage stay
        visible and the cage, drawn so, stays within the cup.
    title : str
        Title of the page.
    height : int
        Height in a notebook (pixels).
    overwrite : bool
        Replace a file that is there; never the file of the result.

    Returns
    -------
    View
        Shows itself in a notebook; ``save(path)`` writes it.

    Raises
    ------
    InputError
        If a group was not recorded or an argument is not allowed.
    FileError
        If the file is there and shall not be replaced, or cannot be written, or three.js is not installed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(3000.0, 4930.0, start=trb.Start.whirl(0.9))
    >>> result = trb.Simulation(scene).run(revolutions=0.5)
    >>> trb.view(result, max_frames=20).html.startswith("<!doctype html>")
    True
    """
    expect("result", result, Result, AssemblyResult)
    if exaggeration is not None and not 1.0 <= exaggeration <= 1e4:
        raise InputError.of("exaggeration", exaggeration, "must be from 1 to 10000 (1)")
    if path is not None:  # before the view is made, which takes a while
        output_path(path, overwrite=overwrite, field="path", endings=ENDINGS, reads=files_of(result))
    if isinstance(result, Result):
        shown, shaft = [_shown(result, revolutions, max_frames, max_size_mb)], None
    else:
        shown, shaft = _on_shaft(result, revolutions, max_frames, max_size_mb)
        title = title or f"{', '.join(result)} on one shaft"
    made = View(page(shown, factor=exaggeration, title=title, shaft=shaft), height=height, reads=files_of(result))
    if path is not None:
        made.save(path, overwrite=overwrite)
    return made


def _shown(result: Result, revolutions: float | None, max_frames: int, max_size_mb: float, **where: Any) -> Shown:
    """A bearing of the page; where: its name and place on a shaft."""
    data_of.check(result, revolutions, max_frames)
    bearing = result.scene.bearing
    stations = (
        data_of.stations(result) if len(result) > 1 else np.linspace(-0.5, 0.5, 2) * bearing.roller.effective_length
    )
    meshes = shapes(bearing, stations, result.scene.effects.guidance if result.has_cage else "rollers")
    limit = frames_that_fit(result, max_size_mb, len(meshes.faces), stations.size)
    taken = data_of.frames(result, revolutions=revolutions, max_frames=min(max_frames, limit))
    return Shown(result, meshes, taken, **where)


def _on_shaft(
    result: AssemblyResult, revolutions: float | None, max_frames: int, max_size_mb: float
) -> tuple[list[Shown], dict[str, float]]:
    """The bearings of an assembly where they sit, and the ends of the shaft."""
    assembly = result.assembly
    if assembly is None:
        raise InputError.of("assembly", None, "must be known, to say where the bearings sit on the shaft")
    reach = [end for one in assembly.bearings for end in one.rollers_reach]
    middle = 0.5 * (min(reach) + max(reach))
    places = [
        {"name": name, "place": at.centre_plane - middle, "turned": at.side > 0.0}
        for name, at in zip(result, assembly.bearings, strict=True)
    ]
    size = max_size_mb / len(result)

    def taken(most: int) -> list[Shown]:
        pairs = zip(result.values(), places, strict=True)
        return [_shown(one, revolutions, most, size, **place) for one, place in pairs]

    shown = taken(max_frames)
    counts = {one.frames.index.size for one in shown}
    if len(counts) > 1:  # each bearing has room for another number; all need the same moments
        shown = taken(min(counts))
    first, beyond = assembly.bearings[0], max(one.bearing.roller.effective_length for one in assembly.bearings)
    ends = [min(reach) - beyond, max(reach) + beyond, assembly.shaft.mass_position]
    ends += [load.position for load in assembly.loads]
    along = [-first.side * (end - first.centre_plane) for end in ends]
    return shown, {"from": min(along), "to": max(along)}


def frames_that_fit(result: Result, max_size_mb: float, n_faces: int, n_stations: int) -> int:
    """Number of frames that a file of a size has room for, before compression."""
    count, slots = result.scene.bearing.n_rollers, len(result.scene.bearing.slot_names)
    a_frame = 4 * (14 + 6 * count) + 2 * count * (15 + slots + n_stations)
    meshes = 32 * (130 * 50 + 300 * count) + 400 * n_faces
    room = (max_size_mb * 1e6 - _FIXED_BYTES - 0.5 * meshes) * 0.75
    fit = int(room / a_frame) if np.isfinite(room) else 0
    if fit < 2:
        need = (_FIXED_BYTES + 0.5 * meshes + 2 * a_frame / 0.75) / 1e6
        raise InputError.of("max_size_mb", max_size_mb, f"must be at least {need:.1f} for this bearing (MB)")
    return fit
