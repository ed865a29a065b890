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
    "cage_modes": "elastic.simulated",
    "displacements": "elastic.simulated",
    "mode_rows": "elastic.simulated",
    "cage_stress": "elastic.stress",
    "force_spectrum": "sound.forces",
    "octave_levels": "sound.forces",
    "rattle": "sound.forces",
    "sound": "sound.forces",
    "gmsh_model": "cad.opened",
    "nodes_of": "cad.opened",
    "opened": "cad.opened",
    "read_cage": "cad.read",
    "read_trace": "cad.read_trace",
    "need_nicegui": "app",
    "serve": "app.server",
}
"""Functions of the extras that the core, or another extra, calls, and the module of each."""


def of_extras(name: str) -> Any:
    """A function of `PLACES`.

    Raises
    ------
    MissingExtra
        If its part is not installed.
    """
    return getattr(module(f"{EXTRAS}.{PLACES[name]}", name), name)


def module(place: str, wanted: str) -> Any:
    """A module of the package; what is wanted of it is named where it is one of an extra that is not installed."""
    try:
        return importlib.import_module(place)
    except ModuleNotFoundError as error:
        if not (error.name or "").startswith(EXTRAS):
            raise
        missing = place if error.name == EXTRAS else str(error.name)
        part = f"{missing}.{wanted}".removeprefix(f"{EXTRAS}.").split(".")[0]
        raise MissingExtra(
            f"{wanted} needs the part '{part}' of trbdyn, which is not installed: there is no folder trbdyn/extras/{part}"
        ) from None
