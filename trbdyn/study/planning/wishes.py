"""What is asked of a plan: checked, and put in the units of the scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.model.motion import History
from trbdyn.model.scene import Scene, Start
from trbdyn.run.until import check_average, groups_for
from trbdyn.study.planning.probes import Array, carried_over

TOLD_APART: Final = 0.3
"""Half width of an influence over the wish, up to which it counts as told apart from chance."""


@dataclass(frozen=True)
class Wishes:
    """What is asked of a plan.

    Attributes
    ----------
    scene : Scene
        What is simulated.
    want : dict of str to float
        Wanted relative error by the name of the average.
    budget : float or None
        Most computing time of the run (s).
    effort : float
        Computing time for the probes, about (s).
    """

    scene: Scene
    want: dict[str, float]
    budget: float | None
    effort: float

    @property
    def names(self) -> list[str]:
        """The averages."""
        return list(self.want)

    @property
    def size(self) -> Array:
        """The wanted errors, in their order."""
        return np.array(list(self.want.values()))

    @property
    def period(self) -> float:
        """Time of a turn of the shaft, or of the outer ring where the shaft rests (s)."""
        assert isinstance(self.scene.turning_rpm, float)
        return 60.0 / abs(self.scene.turning_rpm)

    @property
    def of_cage(self) -> bool:
        """Whether an average is one of the cage."""
        return any(map(of_cage, self.want))


def checked(scene: Scene, want: Mapping[str, float], budget: float | None, effort: float) -> Wishes:
    """What is asked for, if it can be planned.

    Parameters
    ----------
    scene : Scene
        What is simulated.
    want : mapping of str to float
        Wanted relative error by the name of the average.
    budget, effort : float
        Computing time of the run at most, and of the probes (s).

    Raises
    ------
    InputError
        If a name or number cannot be used, or the scene has no constant speed and loads.
    """
    if not want:
        raise InputError.of("want", dict(want), "must name an average with its error, for instance torque = 0.02")
    for name, wish in want.items():
        check_average(name, "want")
        if not 0.0 < number_of(f"want.{name}", wish) < 1.0:
            raise InputError.of(("want", name), wish, "must be a number above 0 and below 1: error over average (1)")
        if of_cage(name) and not scene.effects.has_cage:
            raise InputError.of("want", name, "needs a cage: effects.bodies = 'rollers_and_cage'")
    for field, value in (("budget", budget), ("effort", effort)):
        if value is not None and not 0.0 < number_of(field, value) < 1e7:
            raise InputError.of(field, value, "must be > 0 and < 1e7 (s)")
    for field in type(scene).model_fields:
        quantity = getattr(scene, field)
        parts = quantity if isinstance(quantity, tuple) else (quantity,)
        if any(isinstance(part, History) for part in parts):
            raise InputError.of(field, "a history", "must be constant: averages of a changing motion cannot be planned")
    if scene.torque is not None:
        limit = (
            "must not be given: the speed changes with it, and averages of a changing motion cannot be planned (N m)"
        )
        raise InputError.of("torque", scene.torque, limit)
    if scene.turning_rpm == 0.0:
        limit = "must not be 0 where the outer ring rests, too: averages of a bearing at rest cannot be planned (rpm)"
        raise InputError.of("speed_rpm", 0.0, limit)
    return Wishes(scene, {name: float(wish) for name, wish in want.items()}, budget, float(effort))


def of_cage(name: str) -> bool:
    """Whether an average is one of the cage."""
    return groups_for(name)[-1] in ("cage", "pocket")


def changed(scene: Scene, effects: Mapping[str, Any], start: Start) -> Scene:
    """A scene with other effects that starts as is given.

    Without a cage it cannot start with a whirl of the cage: the rollers are then equally spaced. A state is carried over to the
    other effects.

    Parameters
    ----------
    scene : Scene
        The scene; `start` fits to it.
    effects : mapping
        Fields of `Effects` that are changed.
    start : Start
        How it starts.

    Raises
    ------
    InputError
        If the effects cannot be used.
    """
    new = scene.effects.replace(**effects)
    if start.kind == "state":
        return carried_over(scene.replace(effects=new, start=Start.equal()), start, scene)
    spaced = new.bodies == "rollers_and_spacer" and start.kind == "unequal"
    own = Start.equal() if spaced or (start.kind == "whirl" and not new.has_cage) else start
    return scene.replace(effects=new, start=own)
