"""A bearing that another program steps: what goes in, what comes out, and a step. It needs nothing of FMI."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from trbdyn.base.expected import expect
from trbdyn.errors import InputError, unknown_name
from trbdyn.model.motion import is_constant, value_at
from trbdyn.model.scene import Scene
from trbdyn.run.simulation import Simulation
from trbdyn.statics.stiffness import stiffness

Kind = Literal["motion", "forces"]
KINDS: Final = ("motion", "forces")
RPM: Final = 30.0 / math.pi


@dataclass(frozen=True)
class Variable:
    """What goes into a unit, or comes out of it.

    Attributes
    ----------
    name, unit, text : str
        Its name, unit and meaning.
    is_input : bool
        Whether it goes in.
    """

    name: str
    unit: str
    text: str
    is_input: bool


def _axes(name: str, axes: str, unit: str, text: str, *, is_input: bool) -> list[Variable]:
    return [Variable(f"{name}_{axis}", unit, text.format(axis), is_input) for axis in axes]


_PLACE: Final = "of the inner ring's roller-centre plane"
_RATES: Final = "the path of the ring is a cubic as soon as one of the rates is given, and straight before"
INPUTS: Final[dict[str, list[Variable]]] = {
    "motion": [
        *_axes(
            "ring_position",
            "xyz",
            "m",
            f"displacement along {{}} {_PLACE}; reached at the end of a step",
            is_input=True,
        ),
        *_axes(
            "ring_tilt", "xy", "rad", "rotation of the inner ring about {}; reached at the end of a step", is_input=True
        ),
        *_axes(
            "ring_velocity", "xyz", "m/s", f"velocity along {{}} {_PLACE} at the end of a step; {_RATES}", is_input=True
        ),
        *_axes(
            "ring_tilt_rate",
            "xy",
            "rad/s",
            f"rate of the rotation about {{}} at the end of a step; {_RATES}",
            is_input=True,
        ),
    ],
    "forces": [
        *_axes(
            "load_force",
            "xyz",
            "N",
            "force along {} on the inner ring, from outside; held in a step",
            is_input=True,
        ),
        *_axes(
            "load_moment", "xy", "N m", f"moment about {{}} on the inner ring, {_PLACE}; held in a step", is_input=True
        ),
    ],
}
OF_ALL: Final = [
    Variable("shaft_speed", "rad/s", "speed of the inner ring; reached evenly at the end of a step", True),
    Variable("oil_temperature", "degC", "temperature of the oil at the inlets of the contacts; held in a step", True),
]
OUTPUTS: Final[list[Variable]] = [
    *_axes("ring_force", "xyz", "N", "force along {} of rollers and cage on the inner ring", is_input=False),
    *_axes(
        "ring_moment", "xy", "N m", f"moment about {{}} of rollers and cage on the inner ring, {_PLACE}", is_input=False
    ),
    Variable("inner_torque", "N m", "friction torque that the shaft overcomes", False),
    Variable("power_loss", "W", "power that the bearing turns into heat", False),
    *_axes("cage_position", "xyz", "m", "displacement along {} of the cage's centre", is_input=False),
    Variable("pocket_force", "N", "largest force between a roller and its pocket, at the end of the step", False),
    Variable(
        "axial_stiffness", "N/m", "static stiffness along z where the ring stands, computed when it is asked for", False
    ),
    Variable(
        "radial_stiffness",
        "N/m",
        "static stiffness along x where the ring stands, computed when it is asked for",
        False,
    ),
]
OF_A_FREE_RING: Final = [
    *_axes("ring_position", "xyz", "m", f"displacement along {{}} {_PLACE}", is_input=False),
    *_axes("ring_tilt", "xy", "rad", "rotation of the inner ring about {}", is_input=False),
    *_axes("ring_velocity", "xyz", "m/s", f"velocity along {{}} {_PLACE}", is_input=False),
]


class BearingUnit:
    """A bearing that is stepped from outside.

    Parameters
    ----------
    scene : Scene
        The bearing, at constant loads and speed. It begins in its equilibrium.
    ring : {'motion', 'forces'}
        Whether the motion of the inner ring goes in and forces come out, or forces go in and its motion comes out, which needs a
        free ring.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances.

    Examples
    --------
    >>> import trbdyn as trb
    >>> from trbdyn.extras.exchange.fmu_unit import BearingUnit
    >>> unit = BearingUnit(trb.cases.scene_30310(1000.0, 5e3))
    >>> unit.put("ring_position_z", unit.get("ring_position_z") - 1e-7)
    >>> unit.step(0.0, 1e-5)
    >>> unit.get("ring_force_z") > 5e3
    True
    """

    def __init__(self, scene: Scene, *, ring: Kind = "motion", accuracy: str = "standard") -> None:
        expect("scene", scene, Scene)
        if ring not in KINDS:
            raise InputError.of("ring", ring, unknown_name(str(ring), KINDS))
        for name, quantity in {**scene.ring_quantities(), "speed_rpm": scene.speed_rpm}.items():
            if not is_constant(quantity):
                raise InputError.of(
                    ("scene", name), "a history", "must be a number: what goes into a unit changes by its inputs"
                )
        if (ring == "forces") != (scene.ring == "free"):
            limit = "must be 'free' for forces that go in, and 'held' or 'follows' for a motion that goes in"
            raise InputError.of(("scene", "ring"), scene.ring, limit)
        self.ring = ring
        self.scene = _placed(scene) if ring == "motion" else scene
        self.simulation: Any = Simulation(self.scene, accuracy=accuracy)
        self.variables = [*INPUTS[ring], *OF_ALL, *OUTPUTS, *(OF_A_FREE_RING if ring == "forces" else ())]
        self._names = {one.name: one for one in self.variables}
        self._given: dict[str, float] = self._start()
        self._done = dict(self._given)
        self._begun: float | None = None
        self._record: dict[str, Any] | None = None
        self._with_rates = False

    def _start(self) -> dict[str, float]:
        scene = self.scene
        found = {
            "shaft_speed": value_at(scene.speed_rpm, 0.0) / RPM,
            "oil_temperature": float(scene.lubricant.temperature_c),
        }
        if self.ring == "motion":
            assert scene.displacement is not None
            places = [*scene.displacement, scene.misalignment_x, scene.misalignment_y]
            start = dict.fromkeys((one.name for one in INPUTS["motion"]), 0.0)
            return (
                found
                | start
                | {name: float(value_at(place or 0.0, 0.0)) for name, place in zip(start, places, strict=False)}
            )
        radial, turned = value_at(scene.radial_load, 0.0), math.radians(value_at(scene.radial_direction_deg, 0.0))
        moments = [0.0 if one is None else value_at(one, 0.0) for one in scene.moments]
        loads = [radial * math.cos(turned), radial * math.sin(turned), -value_at(scene.axial_load, 0.0), *moments]
        return found | {one.name: float(load) for one, load in zip(INPUTS["forces"], loads, strict=True)}

    def put(self, name: str, value: float) -> None:
        """Give a value to an input, for the next step."""
        if name not in self._given:
            raise InputError.of("name", name, unknown_name(name, self._given))
        self._given[name] = float(value)

    def get(self, name: str) -> float:
        """The value of a variable at the present time."""
        if name in self._given:
            return self._given[name]
        if name not in self._names:
            raise InputError.of("name", name, unknown_name(name, self._names))
        if name.endswith("_stiffness"):
            return self._stiffness(2 if name.startswith("axial") else 0)
        if self._record is None:
            self._record = self.simulation.record()
        if name == "pocket_force":
            pockets = self._record.get("pocket_force")
            return 0.0 if pockets is None or not np.size(pockets) else float(np.max(pockets))
        head, _, axis = name.rpartition("_")
        if name in self._record:
            return float(self._record[name])
        return float(self._record[head]["xyz".index(axis)])

    @property
    def time(self) -> float:
        """Time of the master (s)."""
        return float(self.simulation.time) + (self._begun or 0.0)

    def step(self, time: float, size: float) -> None:
        """Step from a time over a length of time (s)."""
        if self._begun is None:
            self._begun = time - self.simulation.time
        inputs = self._inputs()
        self._record = None
        self.simulation.step(to=time + size - self._begun, rates=self._rates(), **inputs)
        self._done = dict(self._given)

    def _rates(self) -> dict[str, Any] | None:
        """Rates of the ring's places at the end of a step, from when one of them was given on."""
        names = [name for name in self._given if name.startswith(("ring_velocity", "ring_tilt_rate"))]
        self._with_rates = self._with_rates or any(self._given[name] != 0.0 for name in names)
        if not self._with_rates:
            return None
        found: dict[str, Any] = {f"misalignment_{axis}": self._given[f"ring_tilt_rate_{axis}"] for axis in "xy"}
        return found | {"displacement": tuple(self._given[f"ring_velocity_{axis}"] for axis in "xyz")}

    def _inputs(self) -> dict[str, Any]:
        """What changed since the last step, in the words of `Simulation.step`."""
        given, done = self._given, self._done
        new = {name for name, value in given.items() if value != done[name]}
        found: dict[str, Any] = {}
        if "shaft_speed" in new:
            found["speed_rpm"] = RPM * given["shaft_speed"]
        if "oil_temperature" in new:
            found["temperature_c"] = given["oil_temperature"]
        if any(name.startswith("ring_position") for name in new):
            found["displacement"] = tuple(given[f"ring_position_{axis}"] for axis in "xyz")
        for axis in "xy":
            if f"ring_tilt_{axis}" in new:
                found[f"misalignment_{axis}"] = given[f"ring_tilt_{axis}"]
            if f"load_moment_{axis}" in new:
                found[f"moment_{axis}"] = given[f"load_moment_{axis}"]
        if any(name.startswith("load_force") for name in new):
            x, y, z = (given[f"load_force_{axis}"] for axis in "xyz")
            found |= {
                "axial_load": -z,
                "radial_load": math.hypot(x, y),
                "radial_direction_deg": math.degrees(math.atan2(y, x)),
            }
        return found

    def _stiffness(self, axis: int) -> float:
        if self.ring == "motion":
            return float(stiffness(self.simulation.scene).matrix[axis, axis])
        if self._record is None:
            self._record = self.simulation.record()
        place = [*self._record["ring_position"], *self._record["ring_tilt"]]
        return float(stiffness(_at(self.simulation.scene, place)).matrix[axis, axis])


def _placed(scene: Scene) -> Scene:
    """The scene with its ring where it is in equilibrium."""
    return _at(scene, Simulation(scene).equilibrium.displacement)


def _at(scene: Scene, place: Any) -> Scene:
    x, y, z, turn_x, turn_y = (float(value) for value in place)
    return scene.replace(
        ring="held",
        ring_body=None,
        axial_load=0.0,
        radial_load=0.0,
        unloaded="refused",
        moment_x=None,
        moment_y=None,
        displacement=(x, y, z),
        misalignment_x=turn_x,
        misalignment_y=turn_y,
    )
