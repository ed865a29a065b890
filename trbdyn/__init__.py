"""Dynamics of tapered and cylindrical roller bearings: rollers, ribs and cage move freely, in lubricated contacts.

    import trbdyn as trb

    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0)
    result = trb.Simulation(scene).run(revolutions=50)
    trb.plot.cage_locus(result)

Everything is SI unless a name says otherwise. Names are imported when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from trbdyn import errors, laws, plot, study
    from trbdyn.base.version import __version__
    from trbdyn.errors import FileError, InputError, LoadError, RunWarning, StepError, TrbError
    from trbdyn.model import cases, lubricants, pocket_shapes
    from trbdyn.model.assembly import Assembly, PreloadSpring, Shaft, ShaftBearing, ShaftLoad
    from trbdyn.model.bearing import Bearing, Cage, CageBody, Material, Profile, Ribs, Roller, Roughness, Scatter
    from trbdyn.model.defects import DepthMap, Pit, Waviness
    from trbdyn.model.effects import Effects
    from trbdyn.model.elastic_cage import ElasticCage
    from trbdyn.model.growth import Growth
    from trbdyn.model.heat import HeatPaths
    from trbdyn.model.land import Land
    from trbdyn.model.lubricants import Lubricant, Oil
    from trbdyn.model.motion import History
    from trbdyn.model.planet import planet
    from trbdyn.model.pocket import Face, OtherPocket, Pocket
    from trbdyn.model.ring_body import Housing, RingBody
    from trbdyn.model.scene import RotatingLoad, Scene, Start
    from trbdyn.plot import animation
    from trbdyn.reporting import report
    from trbdyn.results import observables
    from trbdyn.results.assembly import AssemblyResult, load
    from trbdyn.results.result import Result
    from trbdyn.run.options import RunOptions
    from trbdyn.run.rating import rating
    from trbdyn.run.resume import resume
    from trbdyn.run.simulation import Simulation
    from trbdyn.run.toml_assembly import load_assembly
    from trbdyn.run.toml_case import load_case
    from trbdyn.run.wear import wear
    from trbdyn.standards.frequencies import frequencies
    from trbdyn.statics.assembly import equilibrium, stiffness
    from trbdyn.statics.preload import preload_diagram
    from trbdyn.study.cage_map import cage_map
    from trbdyn.study.planning import plan
    from trbdyn.study.surrogate import surrogate
    from trbdyn.study.thermal import thermal
    from trbdyn.study.torque_map import torque_map
    from trbdyn.study.uncertainty import uncertainty
    from trbdyn.study.what_matters import sensitivity
    from trbdyn.study.whirl import whirl_onset
    from trbdyn.viewer import view

_MODULES = {
    "animation": "trbdyn.plot.animation",
    "cases": "trbdyn.model.cases",
    "errors": "trbdyn.errors",
    "laws": "trbdyn.laws",
    "lubricants": "trbdyn.model.lubricants",
    "observables": "trbdyn.results.observables",
    "plot": "trbdyn.plot",
    "pocket_shapes": "trbdyn.model.pocket_shapes",
    "study": "trbdyn.study",
}

_NAMES = {
    "Assembly": "trbdyn.model.assembly",
    "AssemblyResult": "trbdyn.results.assembly",
    "Bearing": "trbdyn.model.bearing",
    "Cage": "trbdyn.model.bearing",
    "CageBody": "trbdyn.model.bearing",
    "DepthMap": "trbdyn.model.defects",
    "Effects": "trbdyn.model.effects",
    "ElasticCage": "trbdyn.model.elastic_cage",
    "Face": "trbdyn.model.pocket",
    "FileError": "trbdyn.errors",
    "Growth": "trbdyn.model.growth",
    "HeatPaths": "trbdyn.model.heat",
    "History": "trbdyn.model.motion",
    "Housing": "trbdyn.model.ring_body",
    "InputError": "trbdyn.errors",
    "Land": "trbdyn.model.land",
    "LoadError": "trbdyn.errors",
    "Lubricant": "trbdyn.model.lubricants",
    "Material": "trbdyn.model.bearing",
    "Oil": "trbdyn.model.lubricants",
    "OtherPocket": "trbdyn.model.pocket",
    "Pit": "trbdyn.model.defects",
    "Pocket": "trbdyn.model.pocket",
    "PreloadSpring": "trbdyn.model.assembly",
    "Profile": "trbdyn.model.bearing",
    "Result": "trbdyn.results.result",
    "Ribs": "trbdyn.model.bearing",
    "RingBody": "trbdyn.model.ring_body",
    "planet": "trbdyn.model.planet",
    "Roller": "trbdyn.model.bearing",
    "RotatingLoad": "trbdyn.model.scene",
    "Roughness": "trbdyn.model.bearing",
    "RunOptions": "trbdyn.run.options",
    "RunWarning": "trbdyn.errors",
    "Scatter": "trbdyn.model.bearing",
    "Scene": "trbdyn.model.scene",
    "Shaft": "trbdyn.model.assembly",
    "ShaftBearing": "trbdyn.model.assembly",
    "ShaftLoad": "trbdyn.model.assembly",
    "Simulation": "trbdyn.run.simulation",
    "Start": "trbdyn.model.scene",
    "StepError": "trbdyn.errors",
    "TrbError": "trbdyn.errors",
    "Waviness": "trbdyn.model.defects",
    "__version__": "trbdyn.base.version",
    "equilibrium": "trbdyn.statics.assembly",
    "frequencies": "trbdyn.standards.frequencies",
    "load": "trbdyn.results.assembly",
    "load_assembly": "trbdyn.run.toml_assembly",
    "load_case": "trbdyn.run.toml_case",
    "plan": "trbdyn.study.planning",
    "preload_diagram": "trbdyn.statics.preload",
    "rating": "trbdyn.run.rating",
    "report": "trbdyn.reporting",
    "resume": "trbdyn.run.resume",
    "sensitivity": "trbdyn.study.what_matters",
    "stiffness": "trbdyn.statics.assembly",
    "thermal": "trbdyn.study.thermal",
    "torque_map": "trbdyn.study.torque_map",
    "surrogate": "trbdyn.study.surrogate",
    "uncertainty": "trbdyn.study.uncertainty",
    "view": "trbdyn.viewer",
    "wear": "trbdyn.run.wear",
    "cage_map": "trbdyn.study.cage_map",
    "whirl_onset": "trbdyn.study.whirl",
}

__all__ = [
    "Assembly",
    "AssemblyResult",
    "Bearing",
    "Cage",
    "CageBody",
    "DepthMap",
    "Effects",
    "ElasticCage",
    "Face",
    "FileError",
    "Growth",
    "HeatPaths",
    "History",
    "Housing",
    "InputError",
    "Land",
    "LoadError",
    "Lubricant",
    "Material",
    "Oil",
    "OtherPocket",
    "Pit",
    "Pocket",
    "PreloadSpring",
    "Profile",
    "Result",
    "Ribs",
    "RingBody",
    "Roller",
    "RotatingLoad",
    "Roughness",
    "RunOptions",
    "RunWarning",
    "Scatter",
    "Scene",
    "Shaft",
    "ShaftBearing",
    "ShaftLoad",
    "Simulation",
    "Start",
    "StepError",
    "TrbError",
    "Waviness",
    "__version__",
    "animation",
    "cage_map",
    "cases",
    "equilibrium",
    "errors",
    "frequencies",
    "laws",
    "load",
    "load_assembly",
    "load_case",
    "lubricants",
    "observables",
    "plan",
    "planet",
    "plot",
    "pocket_shapes",
    "preload_diagram",
    "rating",
    "report",
    "resume",
    "sensitivity",
    "stiffness",
    "study",
    "surrogate",
    "thermal",
    "torque_map",
    "uncertainty",
    "view",
    "wear",
    "whirl_onset",
]


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
    """What users need: completion in a notebook shows these names, and not what this file imports."""
    return sorted(__all__)
