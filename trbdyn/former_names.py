"""Modules by shorter names: ``trbdyn.cases`` is `trbdyn.model.cases`, and modules that have moved are found by their old names.

An object that was pickled names the module of its class, and a script imports what its author knew. Both must go on to work, so
an import of a name in `MODULES`, or of a module below it, gives the module that stands there now. It is imported once: both names
mean the same object. The package itself imports every module by its own name.
"""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.machinery
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Final

MODULES: Final = {
    "trbdyn.animation": "trbdyn.plot.animation",
    "trbdyn.assumed": "trbdyn.model.assumed",
    "trbdyn.bearing": "trbdyn.model.bearing",
    "trbdyn.cage_start": "trbdyn.statics.cage_start",
    "trbdyn.case_text": "trbdyn.run.case_text",
    "trbdyn.cases": "trbdyn.model.cases",
    "trbdyn.catalogue": "trbdyn.model.catalogue",
    "trbdyn.checkpoint": "trbdyn.run.checkpoint",
    "trbdyn.confidence": "trbdyn.results.confidence",
    "trbdyn.derived": "trbdyn.results.derived",
    "trbdyn.effects": "trbdyn.model.effects",
    "trbdyn.estimate": "trbdyn.run.estimate",
    "trbdyn.estimated": "trbdyn.model.estimated",
    "trbdyn.fields": "trbdyn.results.fields",
    "trbdyn.flatten": "trbdyn.model.flatten",
    "trbdyn.geometry": "trbdyn.model.geometry",
    "trbdyn.hdf5_marks": "trbdyn.results.hdf5_marks",
    "trbdyn.keeping": "trbdyn.run.keeping",
    "trbdyn.law_texts": "trbdyn.laws.texts",
    "trbdyn.lubricants": "trbdyn.model.lubricants",
    "trbdyn.motion": "trbdyn.model.motion",
    "trbdyn.observables": "trbdyn.results.observables",
    "trbdyn.own_files": "trbdyn.base.own_files",
    "trbdyn.peaks": "trbdyn.results.peaks",
    "trbdyn.plausible": "trbdyn.statics.plausible",
    "trbdyn.plotting": "trbdyn.plot",
    "trbdyn.pocket": "trbdyn.model.pocket",
    "trbdyn.pocket_shapes": "trbdyn.model.pocket_shapes",
    "trbdyn.replay": "trbdyn.run.replay",
    "trbdyn.result_file": "trbdyn.results.result_file",
    "trbdyn.resuming": "trbdyn.run.resume",
    "trbdyn.ring_path": "trbdyn.statics.ring_path",
    "trbdyn.run_options": "trbdyn.run.options",
    "trbdyn.running": "trbdyn.run.running",
    "trbdyn.scene": "trbdyn.model.scene",
    "trbdyn.simulation": "trbdyn.run.simulation",
    "trbdyn.sources": "trbdyn.results.sources",
    "trbdyn.start": "trbdyn.statics.start",
    "trbdyn.summary": "trbdyn.results.summary",
    "trbdyn.toml_case": "trbdyn.run.toml_case",
    "trbdyn.validation": "trbdyn.base.validation",
    "trbdyn.vibrations": "trbdyn.run.vibrations",
    "trbdyn.watch": "trbdyn.run.watch",
    "trbdyn.what_matters": "trbdyn.study.what_matters",
}
"""Where each module stands, by its other name."""


def present_name(name: str) -> str | None:
    """The name under which a module stands; None if this is no other name of a module.

    Parameters
    ----------
    name : str
        A name of a module, such as ``"trbdyn.cases"`` or ``"trbdyn.plotting.style"``.
    """
    top = ".".join(name.split(".", 2)[:2])
    if top not in MODULES:
        return None
    return MODULES[top] + name[len(top) :]


class _SameModule(importlib.abc.Loader):
    """Gives the module that stands under its present name, and leaves it as it is."""

    def __init__(self, name: str) -> None:
        self._name = name

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        module = importlib.import_module(self._name)
        self._own = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__ = self._own  # the import system has put in that of the other name


class _Finder(importlib.abc.MetaPathFinder):
    """Finds modules by their other names."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        present = present_name(fullname)
        if present is None:
            return None
        return importlib.machinery.ModuleSpec(fullname, _SameModule(present))


def install() -> None:
    """Let imports find modules by their other names; a second call changes nothing."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())
