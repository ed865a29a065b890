"""What the core takes from the extras (`trbdyn.extras`), where a scene, a file or a command asks for it.

The core imports no extra. What it needs of them is a row of `PLACES`, which is imported when it is called, so that the core runs
without the folder ``trbdyn/extras`` until something of it is wanted.
"""

from __future__ import annotations

import importlib
from typing import Any, Final

from trbdyn.errors import MissingExtra

EXTRAS: Final = "trbdyn.extras"
"""The package of the extras; each is a package in it."""
PLACES: Final = {
    "cage_modes": ("elastic.simulated", "an elastic cage"),
    "displacements": ("elastic.simulated", "the deformed shape of a cage"),
    "mode_rows": ("elastic.simulated", "an elastic cage"),
    "cage_stress": ("elastic.stress", "the stress of a cage"),
    "force_spectrum": ("sound.forces", "a spectrum of forces"),
    "octave_levels": ("sound.forces", "octave levels"),
    "rattle": ("sound.forces", "the rattle of rollers"),
    "sound": ("sound.forces", "sound"),
    "gmsh_model": ("cad.opened", "a mesh of a drawing"),
    "nodes_of": ("cad.opened", "a mesh of a drawing"),
    "opened": ("cad.opened", "a drawing"),
    "read_cage": ("cad.read", "the drawing of a cage"),
    "read_trace": ("cad.read_trace", "a measured profile"),
    "need_nicegui": ("app", "the page"),
    "serve": ("app.server", "the page"),
}
"""Functions of the extras that the core, or another extra, calls; the module of each, and what users call it for."""


def of_extras(name: str) -> Any:
    """A function of `PLACES`.

    Raises
    ------
    MissingExtra
        If its part is not installed.
    """
    place, words = PLACES[name]
    return getattr(module(f"{EXTRAS}.{place}", words), name)


def module(place: str, wanted: str) -> Any:
    """A module of the package; what is wanted of it is named where it is one of an extra that is not installed."""
    try:
        return importlib.import_module(place)
    except ModuleNotFoundError as error:
        if not (error.name or "").startswith(EXTRAS):
            raise
        # where the whole folder is missing, what was asked for tells the part; a name of the package may be the part itself
        part = f"{place if error.name == EXTRAS else error.name}.{wanted}".removeprefix(f"{EXTRAS}.").split(".")[0]
        raise MissingExtra(
            f"{wanted} needs the part '{part}' of trbdyn, which is not installed: there is no folder trbdyn/extras/{part}"
        ) from None
