"""The drawing that a cage comes from."""

from __future__ import annotations

from typing import Annotated, Final

from pydantic import Field

from trbdyn.base.validation import Model, Number, unit

Row = tuple[Annotated[Number, unit("1")], Annotated[Number, unit("1")], Annotated[Number, unit("1")]]

MM: Final = 1e-3
"""Gmsh converts every file to mm, whatever its unit, and this is that in m."""
STEP_ENDINGS: Final = (".step", ".stp", ".p21")
"""Endings of files that hold surfaces, not triangles alone."""


class CageDrawing(Model):
    """The drawing that a cage comes from, and where it lies. `Cage.from_step` makes it; an elastic cage is meshed from it.

    Parameters
    ----------
    file : str
        STEP or STL file.
    sha256 : str
        Its SHA-256, by which another file of the same name is found out.
    origin : tuple of float, shape (3,)
        Where the cage's frame has its origin in the drawing (m).
    axes : tuple of tuple of float, shape (3, 3)
        Directions of the cage's axes in the drawing.
    """

    file: Annotated[str, Field(min_length=1)]
    sha256: Annotated[str, Field(min_length=64, max_length=64)]
    origin: tuple[Annotated[Number, unit("m")], Annotated[Number, unit("m")], Annotated[Number, unit("m")]]
    axes: tuple[Row, Row, Row]
