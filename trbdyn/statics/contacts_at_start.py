"""Contacts of a bearing at the start of a run."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from trbdyn.model.scene import Scene
from trbdyn.model.start import Start
from trbdyn.statics.seat import seat_alone

Array = NDArray[np.float64]


def contacts_at_start(scene: Scene) -> dict[str, Array]:
    """Every intermediate quantity of every contact at the start; names, shapes and units as in `Simulation.contacts`. The arrays
    are read-only: the latest scenes are kept, as rating and creep of a run ask for one equilibrium.
    """
    return dict(_contacts_at_start(scene))


@lru_cache(maxsize=8)
def _contacts_at_start(scene: Scene) -> Mapping[str, Array]:
    if scene.elastic_cage is not None and scene.elastic_cage.file is not None:
        # contacts of rollers do not need the modes, whose file is not opened for the summary of a result
        start = Start(time=scene.start.time) if scene.start.kind == "state" else scene.start
        scene = scene.replace(elastic_cage=None, start=start)
    seated = seat_alone(scene)
    onlooker = seated.bearings[0].motion.open(seated.bearings[0].model, seated.time, seated.vector)
    found = onlooker.contacts(seated.time, seated.vector)
    for values in found.values():
        np.asarray(values).setflags(write=False)
    return found
