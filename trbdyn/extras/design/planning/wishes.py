"""What is asked of a plan: checked, and put in the units of the scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.extras.design.planning.averaged import check_names, groups_of, of_bearing, prefixes
from trbdyn.extras.design.planning.probes import Array, carried_over
from trbdyn.model.motion import History
from trbdyn.model.scene import Start

if TYPE_CHECKING:
    from trbdyn.model.assembly import Subject


@dataclass(frozen=True)
class Wishes:
    """What is asked of a plan."""

    scene: Subject
    want: dict[str, float]  # wanted relative error by the name of the average
    budget: float | None  # most computing time of the run (s)
    effort: float  # computing time for the probes, about (s)

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


def checked(scene: Subject, want: Mapping[str, float], budget: float | None, effort: float) -> Wishes:
    """What is asked for, if it can be planned: an error where a name or number cannot be used, or the scene has no constant
    speed and loads.
    """
    if not want:
        raise InputError.of("want", dict(want), "must name an average with its error, for instance torque = 0.02")
    check_names(scene, want)
    parts: list[Any] = list(scene.parts.values())
    bare = [name for name, one in zip(prefixes(scene), parts, strict=True) if not one.effects.has_cage]
    for name, wish in want.items():
        if not 0.0 < number_of(f"want.{name}", wish) < 1.0:
            raise InputError.of(("want", name), wish, "must be a number above 0 and below 1: error over average (1)")
        if of_cage(name) and of_bearing(name)[0] in bare:
            raise InputError.of("want", name, "needs a cage: effects.bodies = 'rollers_and_cage'")
    for field, value in (("budget", budget), ("effort", effort)):
        if value is not None and not 0.0 < number_of(field, value) < 1e7:
            raise InputError.of(field, value, "must be > 0 and < 1e7 (s)")
    for field, quantity in scene.quantities().items():
        if isinstance(quantity, History):
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
    return groups_of(name)[-1] in ("cage", "pocket")


def with_effects(scene: Subject, effects: Mapping[str, Any]) -> Subject:
    """A scene, or an assembly in all its bearings, with other effects. Without a cage none starts with a whirl of the cage, and
    none is spaced unevenly by an even spacer: the rollers are then equally spaced.
    """
    for place, part in scene.parts.items():
        new = part.effects.replace(**effects)
        spaced = new.bodies == "rollers_and_spacer" and part.start.kind == "unequal"
        other = spaced or (part.start.kind == "whirl" and not new.has_cage)
        scene = scene.with_part(place, effects=new, **({"start": Start.equal()} if other else {}))
    return scene


def changed(scene: Subject, effects: Mapping[str, Any], start: Start) -> Subject:
    """A subject with other fields of `Effects` that starts in a state of it, which is carried over to the other effects."""
    return carried_over(with_effects(scene, effects), start, scene)
