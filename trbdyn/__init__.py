"""Dynamics of tapered roller bearings: rollers, ribs and cage with six degrees of freedom, and lubricated contacts.

    import trbdyn as trb

    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0)
    result = trb.Simulation(scene).run(revolutions=50)
    trb.plot.cage_locus(result)

Everything is SI unless a name says otherwise. Names are imported when they are first used.
"""

from __future__ import annotations

import importlib
import importlib.metadata
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from trbdyn import animation, cases, errors, laws, lubricants, observables, pocket_shapes, study
    from trbdyn import plotting as plot
    from trbdyn.bearing import Bearing, Cage, Land, Material, Profile, Ribs, Roller, Roughness, Scatter
    from trbdyn.effects import Effects
    from trbdyn.errors import FileError, InputError, LoadError, RunWarning, StepError, TrbError
    from trbdyn.lubricants import Lubricant, Oil
    from trbdyn.motion import History
    from trbdyn.pocket import Face, OtherPocket, Pocket
    from trbdyn.reporting import report
    from trbdyn.results import Result, load
    from trbdyn.resuming import resume
    from trbdyn.run_options import RunOptions
    from trbdyn.scene import RotatingLoad, Scene, Start
    from trbdyn.simulation import Simulation
    from trbdyn.toml_case import load_case
    from trbdyn.viewer import view
    from trbdyn.what_matters import sensitivity

_MODULES = {
    "animation": "trbdyn.animation",
    "cases": "trbdyn.cases",
    "errors": "trbdyn.errors",
    "laws": "trbdyn.laws",
    "lubricants": "trbdyn.lubricants",
    "observables": "trbdyn.observables",
    "plot": "trbdyn.plotting",
    "pocket_shapes": "trbdyn.pocket_shapes",
    "study": "trbdyn.study",
}

_NAMES = {
    "Bearing": "trbdyn.bearing",
    "Cage": "trbdyn.bearing",
    "Effects": "trbdyn.effects",
    "Face": "trbdyn.pocket",
    "FileError": "trbdyn.errors",
    "History": "trbdyn.motion",
    "InputError": "trbdyn.errors",
    "Land": "trbdyn.bearing",
    "LoadError": "trbdyn.errors",
    "Lubricant": "trbdyn.lubricants",
    "Material": "trbdyn.bearing",
    "Oil": "trbdyn.lubricants",
    "OtherPocket": "trbdyn.pocket",
    "Pocket": "trbdyn.pocket",
    "Profile": "trbdyn.bearing",
    "Result": "trbdyn.results",
    "Ribs": "trbdyn.bearing",
    "Roller": "trbdyn.bearing",
    "RotatingLoad": "trbdyn.scene",
    "Roughness": "trbdyn.bearing",
    "RunOptions": "trbdyn.run_options",
    "RunWarning": "trbdyn.errors",
    "Scatter": "trbdyn.bearing",
    "Scene": "trbdyn.scene",
    "Simulation": "trbdyn.simulation",
    "Start": "trbdyn.scene",
    "StepError": "trbdyn.errors",
    "TrbError": "trbdyn.errors",
    "load": "trbdyn.results",
    "load_case": "trbdyn.toml_case",
    "report": "trbdyn.reporting",
    "resume": "trbdyn.resuming",
    "sensitivity": "trbdyn.what_matters",
    "view": "trbdyn.viewer",
}

__all__ = [
    "Bearing",
    "Cage",
    "Effects",
    "Face",
    "FileError",
    "History",
    "InputError",
    "Land",
    "LoadError",
    "Lubricant",
    "Material",
    "Oil",
    "OtherPocket",
    "Pocket",
    "Profile",
    "Result",
    "Ribs",
    "Roller",
    "RotatingLoad",
    "Roughness",
    "RunOptions",
    "RunWarning",
    "Scatter",
    "Scene",
    "Simulation",
    "Start",
    "StepError",
    "TrbError",
    "__version__",
    "animation",
    "cases",
    "errors",
    "laws",
    "load",
    "load_case",
    "lubricants",
    "observables",
    "plot",
    "pocket_shapes",
    "report",
    "resume",
    "sensitivity",
    "study",
    "view",
]

try:
    __version__ = importlib.metadata.version("trbdyn")
except importlib.metadata.PackageNotFoundError:
    __version__ = "0+unknown"


def __getattr__(name: str) -> Any:
    if name == "_core":
        return _load_core()
    if name in _MODULES:
        value = importlib.import_module(_MODULES[name])
    elif name in _NAMES:
        value = getattr(importlib.import_module(_NAMES[name]), name)
    else:
        raise AttributeError(f"module 'trbdyn' has no attribute {name!r}")
    globals()[name] = value
    return value


def _load_core() -> Any:
    """The compiled core; an error that says what to do where it is missing, as in sources that nobody built."""
    try:
        return importlib.import_module("trbdyn._core")
    except ModuleNotFoundError as error:
        if error.name != "trbdyn._core":
            raise
        raise ImportError(
            f"the compiled core of trbdyn (trbdyn._core) is not in {__path__[0]}: these are its sources, not an installed "
            "package. In a checkout, run `make install` (or `pip install -e .`) and use .venv/bin/python; "
            "if trbdyn is installed elsewhere, start Python in another folder."
        ) from None


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
