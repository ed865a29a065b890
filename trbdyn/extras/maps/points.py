"""Points of a map over temperature of the oil, speed and load: each of them is a run of its own."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import Any, Final

from trbdyn.base.expected import expect
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.extras.study.definition import Base
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.bearing import Bearing
from trbdyn.model.scene import Scene

DIMS: Final = ("temperature_c", "speed_rpm", "load")


class Points:
    """Temperatures (C), speeds (rpm) and pairs of axial and radial load (N) that a map has, and what is run at each.

    A bearing takes the default oil and effects; `temperatures` are those of the subject where none are given. Points are listed
    with the load changing fastest.
    """

    def __init__(self, subject: Bearing | Subject, speeds: Any, loads: Any, temperatures: Any) -> None:
        expect("subject", subject, Scene, Assembly, Bearing)
        self.subject = Scene(subject, speed_rpm=1000.0, axial_load=1000.0) if isinstance(subject, Bearing) else subject
        self.own_temperature = self.subject.part.lubricant.temperature_c
        own = [self.own_temperature]
        given = {"speeds": speeds, "loads": loads, "temperatures": own if temperatures is None else temperatures}
        for field, values in given.items():
            if isinstance(values, str) or not isinstance(values, Iterable) or not (listed := list(values)):
                raise InputError.of(field, values, "must be a sequence of at least one number")
            given[field] = listed
        self.speeds = [number_of("speeds", one) for one in given["speeds"]]
        self.loads = [_pair(one) for one in given["loads"]]
        self.temperatures = [number_of("temperatures", one) for one in given["temperatures"]]
        if not all(self.speeds):
            raise InputError.of("speeds", speeds, "must not hold 0: a shaft at rest has no friction torque (rpm)")
        for field, values in given.items():
            if len(set(getattr(self, field))) != len(values):
                raise InputError.of(field, values, "must not hold a value twice")
        places = [*itertools.product(self.temperatures, self.speeds, self.loads)]
        self.speed_at = [speed for _, speed, _ in places]
        self.bases = [self._base(*place) for place in places]
        if not any(base for base, _ in self.bases):
            raise InputError.of("loads", loads, f"no point can be built; the first: {self.bases[0][1]}")

    def _base(self, temperature: float, speed: float, load: tuple[float, float]) -> tuple[Base | None, str]:
        """What is run at a point, or why it cannot be built."""
        overrides = self.subject.loaded(speed, *load)
        if temperature != self.own_temperature:
            overrides |= {f"{prefix}lubricant.temperature_c": temperature for prefix in self.subject.parts}
        try:
            return Base.of(Base.of(self.subject).build(overrides)[0]), ""
        except InputError as error:
            return None, str(error).splitlines()[0]

    def __len__(self) -> int:
        return len(self.bases)

    @property
    def shape(self) -> tuple[int, ...]:
        """Numbers of temperatures, speeds and loads."""
        return len(self.temperatures), len(self.speeds), len(self.loads)

    @property
    def coordinates(self) -> dict[str, Any]:
        """Coordinates of a dataset of the map."""
        return {
            "temperature_c": ("temperature_c", self.temperatures, {"units": "C"}),
            "speed_rpm": ("speed_rpm", self.speeds, {"units": "rpm"}),
            "axial_load": ("load", [load[0] for load in self.loads], {"units": "N"}),
            "radial_load": ("load", [load[1] for load in self.loads], {"units": "N"}),
        }

    @property
    def bearings(self) -> list[Bearing]:
        """The bearings that are run."""
        parts: list[Any] = [*self.subject.parts.values()]
        return [part.bearing for part in parts]

    @property
    def about(self) -> dict[str, str]:
        """Attributes of a dataset of the map."""
        return {"bearing": ", ".join(bearing.name for bearing in self.bearings)}


def _pair(load: Any) -> tuple[float, float]:
    pair = tuple(load) if isinstance(load, Sequence) and not isinstance(load, str) else (load, 0.0)
    if len(pair) != 2:
        raise InputError.of("loads", load, "must be an axial load, or a pair of axial and radial load (N)")
    return number_of("loads", pair[0]), number_of("loads", pair[1])
