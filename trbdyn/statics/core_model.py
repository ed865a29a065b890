"""The core's model of a scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.extras import of_extras
from trbdyn.model.defect_rows import form_rows
from trbdyn.model.flatten import (
    block_of,
    diameter_deviation,
    face_rows,
    input_error_of_core,
    parameter_block,
    scene_entries,
)
from trbdyn.model.profiles import drop_rows
from trbdyn.model.scene import Scene


def build_model(scene: Scene, instruction_set: str = "") -> _core.Model:
    """The core's model of a scene; `InputError` if the scene's numbers do not fit together."""
    try:
        return model_of(scene, parameter_block(scene), instruction_set)
    except _core.CoreInputError as error:
        raise input_error_of_core(error, scene_entries(scene)) from None


def model_of(scene: Scene, block: NDArray[np.float64], instruction_set: str = "") -> _core.Model:
    """The core's model of a scene with a parameter block of its own."""
    return _core.Model(
        block,
        diameter_deviation(scene),
        face_rows(scene),
        instruction_set,
        np.zeros((0, 1)) if scene.elastic_cage is None else of_extras("mode_rows")(scene),
        form_rows(scene),
        drop_rows(scene),
    )


def normal_contacts(scene: Scene) -> _core.Model:
    """The scene's model without friction and films, which act on nothing at rest and take most of the time."""
    quiet = {"lubrication": "full_film", "traction": "none", "thermal": False}
    quiet |= {"rolling_resistance": False, "rolling_pressure_force": False}
    rigid = scene.replace(elastic_cage=None)
    entries = scene_entries(rigid.replace(effects=scene.effects.replace(**quiet)))
    return _core.Model(block_of(entries), diameter_deviation(scene), face_rows(scene), drops=drop_rows(scene))
