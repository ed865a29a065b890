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

# ruff: isort: skip_file
from __future__ import annotations

from typing import TYPE_CHECKING

from trbdyn.base.lazy import lazy_names

if TYPE_CHECKING:
    from trbdyn.run.options import RunOptions as RunOptions
    from trbdyn.extras.study.definition import Axis as Axis, Case as Case, Study as Study, fingerprint as fingerprint
    from trbdyn.extras.study.design import cases as cases, grid as grid, of_scenes as of_scenes, random as random
    from trbdyn.extras.study.gather import load as load, save as save
    from trbdyn.extras.study.runner import Running as Running, collect as collect, run as run
    from trbdyn.extras.study.study_file import (
        STUDIES as STUDIES,
        load_study as load_study,
        shipped_studies as shipped_studies,
    )
    from trbdyn.extras.study.bands import Band as Band, open_inputs as open_inputs

__all__, __getattr__, __dir__ = lazy_names(__name__, __file__)
