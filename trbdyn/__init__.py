"""Dynamics of tapered and cylindrical roller bearings: rollers, ribs and cage move freely, in lubricated contacts.

    import trbdyn as trb

    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0)
    result = trb.Simulation(scene).run(revolutions=50)
    trb.plot.cage_locus(result)

Everything is SI unless a name says otherwise. Names are imported when they are first used.
"""

# ruff: isort: skip_file
from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from trbdyn.base.lazy import lazy_names

if TYPE_CHECKING:
    from trbdyn import errors as errors, laws as laws, plot as plot
    from trbdyn.extras import study as study
    from trbdyn.base.version import __version__ as __version__
    from trbdyn.errors import (
        FileError as FileError,
        InputError as InputError,
        LoadError as LoadError,
        MissingExtra as MissingExtra,
        RunWarning as RunWarning,
        StepError as StepError,
        TrbError as TrbError,
    )
    from trbdyn.extras.exchange.fmu import write_fmu as write_fmu
    from trbdyn.model import cases as cases, lubricants as lubricants, pocket_shapes as pocket_shapes
    from trbdyn.model.assembly import Assembly as Assembly
    from trbdyn.model.bearing import (
        Bearing as Bearing,
        Cage as Cage,
        CageBody as CageBody,
        Material as Material,
        Profile as Profile,
        Ribs as Ribs,
        Roller as Roller,
        Roughness as Roughness,
        Scatter as Scatter,
    )
    from trbdyn.model.defects import DepthMap as DepthMap, Pit as Pit, Waviness as Waviness
    from trbdyn.model.designations import designation as designation, designations as designations
    from trbdyn.model.effects import Effects as Effects
    from trbdyn.model.elastic_cage import ElasticCage as ElasticCage
    from trbdyn.model.growth import Growth as Growth
    from trbdyn.extras.heat.paths import HeatPaths as HeatPaths
    from trbdyn.model.land import Land as Land
    from trbdyn.model.lubricants import Lubricant as Lubricant, Oil as Oil
    from trbdyn.model.motion import History as History
    from trbdyn.model.mounting import Mounting as Mounting, Temperatures as Temperatures
    from trbdyn.model.on_shaft import (
        PreloadSpring as PreloadSpring,
        Shaft as Shaft,
        ShaftBearing as ShaftBearing,
        ShaftLoad as ShaftLoad,
        SharedHousing as SharedHousing,
    )
    from trbdyn.model.planet import planet as planet
    from trbdyn.model.pocket import Face as Face, OtherPocket as OtherPocket, Pocket as Pocket
    from trbdyn.model.ring_body import Housing as Housing, RingBody as RingBody
    from trbdyn.model.scene import RotatingLoad as RotatingLoad, Scene as Scene, Start as Start
    from trbdyn.model.spectrum import LoadCase as LoadCase, Spectrum as Spectrum
    from trbdyn.extras.cad.read_trace import read_trace as read_trace
    from trbdyn.model.trace import Trace as Trace
    from trbdyn.plot import animation as animation
    from trbdyn.reporting import report as report
    from trbdyn.results import observables as observables
    from trbdyn.results.assembly import AssemblyResult as AssemblyResult, load as load
    from trbdyn.results.result import Result as Result
    from trbdyn.run.check import check as check
    from trbdyn.run.contact_pressure import ContactPressure as ContactPressure, contact_pressure as contact_pressure
    from trbdyn.run.edge_life import edge_life as edge_life
    from trbdyn.run.options import RunOptions as RunOptions
    from trbdyn.run.rating import rating as rating
    from trbdyn.run.resume import resume as resume
    from trbdyn.extras.exchange.rexs import read_rexs as read_rexs, write_rexs as write_rexs
    from trbdyn.run.simulation import Simulation as Simulation
    from trbdyn.run.toml_assembly import load_assembly as load_assembly
    from trbdyn.run.toml_case import load_case as load_case
    from trbdyn.extras.wear.wear import wear as wear
    from trbdyn.standards.frequencies import frequencies as frequencies
    from trbdyn.statics.assembly import equilibrium as equilibrium, stiffness as stiffness
    from trbdyn.statics.fit import fit as fit
    from trbdyn.statics.preload import preload_diagram as preload_diagram
    from trbdyn.extras.maps.cage_answer import cage_answer as cage_answer
    from trbdyn.extras.maps.cage_map import cage_map as cage_map
    from trbdyn.extras.maps.least_load import least_load as least_load
    from trbdyn.extras.design.optimise import optimise as optimise
    from trbdyn.extras.design.planning import plan as plan
    from trbdyn.extras.heat.preload_over import preload_over as preload_over
    from trbdyn.extras.heat.preload_range import preload_range as preload_range
    from trbdyn.extras.study.spectrum import series_table as series_table, spectrum as spectrum
    from trbdyn.extras.design.surrogate import surrogate as surrogate
    from trbdyn.extras.heat.thermal import thermal as thermal
    from trbdyn.extras.maps.torque_map import torque_map as torque_map
    from trbdyn.extras.study.uncertainty import uncertainty as uncertainty
    from trbdyn.extras.design.what_matters import sensitivity as sensitivity
    from trbdyn.extras.maps.whirl import whirl_onset as whirl_onset
    from trbdyn.viewer import view as view

__all__, _found, __dir__ = lazy_names(__name__, __file__)


def __getattr__(name: str) -> Any:
    return _load_core() if name == "_core" else _found(name)


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
