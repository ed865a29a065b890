"""Parameter studies: many scenes, run side by side, with one result file each and their observables in one dataset::

    import trbdyn as trb

    study = trb.study.grid(
        trb.cases.scene_30310(),
        {"scene.speed_rpm": [1000, 2000, 3000], "bearing.cage.mass": [0.1, 0.2, 0.4]},
        trb.study.RunOptions(revolutions=50),
    )
    data = trb.study.run(study, "cage_mass", progress=True)
    data.orbit_rms_over_cpr.plot()

Names are imported when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from trbdyn.run.options import RunOptions
    from trbdyn.study.definition import Axis, Case, Study, fingerprint
    from trbdyn.study.design import cases, grid, of_scenes, random
    from trbdyn.study.gather import load, save
    from trbdyn.study.runner import Running, collect, run
    from trbdyn.study.study_file import STUDIES, load_study, shipped_studies
    from trbdyn.study.uncertainty import Band, open_inputs

_NAMES = {
    "Axis": "trbdyn.study.definition",
    "Band": "trbdyn.study.uncertainty",
    "Case": "trbdyn.study.definition",
    "RunOptions": "trbdyn.run.options",
    "Running": "trbdyn.study.runner",
    "STUDIES": "trbdyn.study.study_file",
    "Study": "trbdyn.study.definition",
    "cases": "trbdyn.study.design",
    "collect": "trbdyn.study.runner",
    "fingerprint": "trbdyn.study.definition",
    "grid": "trbdyn.study.design",
    "load": "trbdyn.study.gather",
    "load_study": "trbdyn.study.study_file",
    "of_scenes": "trbdyn.study.design",
    "open_inputs": "trbdyn.study.uncertainty",
    "random": "trbdyn.study.design",
    "run": "trbdyn.study.runner",
    "save": "trbdyn.study.gather",
    "shipped_studies": "trbdyn.study.study_file",
}

__all__ = [
    "STUDIES",
    "Axis",
    "Band",
    "Case",
    "RunOptions",
    "Running",
    "Study",
    "cases",
    "collect",
    "fingerprint",
    "grid",
    "load",
    "load_study",
    "of_scenes",
    "open_inputs",
    "random",
    "run",
    "save",
    "shipped_studies",
]


def __getattr__(name: str) -> Any:
    if name not in _NAMES:
        raise AttributeError(f"module 'trbdyn.study' has no attribute {name!r}")
    value = getattr(importlib.import_module(_NAMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
