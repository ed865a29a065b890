"""What a function works on is checked first: an object of another kind is refused with the way to the right one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import trbdyn as trb
from trbdyn.errors import InputError

BEARING = trb.cases.rig_30310()
SCENE = trb.Scene(BEARING, speed_rpm=3000.0, axial_load=4930.0)
ASSEMBLY = trb.Assembly.pair(
    BEARING,
    "back to back",
    spread=0.15,
    end_play=-40e-6,
    shaft=trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3),
    speed_rpm=3000.0,
)
OF_ANY: dict[str, Callable[[Any], Any]] = {
    name: getattr(trb, name) for name in ("Simulation", "stiffness", "uncertainty", "sensitivity")
} | {
    "plan": lambda given: trb.plan(given, {"torque": 0.02}),
    "optimise": lambda given: trb.optimise(given, {"scene.axial_load": (1e3, 2e3)}, {"torque": "least"}),
    "cage_answer": trb.cage_answer,
    "cage_map": lambda given: trb.cage_map(given, [1000.0, 2000.0], [1000.0]),
    "whirl_onset": lambda given: trb.whirl_onset(given, [1000.0, 2000.0]),
    "thermal": lambda given: trb.thermal(given, trb.HeatPaths(oil_flow=30.0)),
}
OF_RESULT: dict[str, Callable[[Any], Any]] = {
    "wear": lambda given: trb.wear(given, coefficient=1e-17),
    "report": lambda given: trb.report(given, "never.html"),
    "view": trb.view,
    "animation": trb.animation.animate,
} | {
    name: getattr(trb.plot, name)
    for name in (*trb.plot.PICTURES, "cage_shape")
    if name not in ("housing_orbit", "housing_motion")
}
OF_ASSEMBLY: dict[str, Callable[[Any], Any]] = {
    "equilibrium": trb.equilibrium,
    "preload_diagram": trb.preload_diagram,
}


def refused(call: Callable[[Any], Any], given: Any) -> str:
    with pytest.raises(InputError) as caught:
        call(given)
    return caught.value.allowed


@pytest.mark.parametrize("name", OF_RESULT)
def test_of_a_result(name: str) -> None:
    assert "trb.Simulation(scene).run(revolutions=...) makes one" in refused(OF_RESULT[name], SCENE)
    assert "trb.Simulation(assembly).run" in refused(OF_RESULT[name], ASSEMBLY)
    assert "trb.load reads one" in refused(OF_RESULT[name], "run.h5")
    assert refused(OF_RESULT[name], None).startswith("must be a Result")


@pytest.mark.parametrize("name", OF_ASSEMBLY)
def test_of_an_assembly(name: str) -> None:
    assert refused(OF_ASSEMBLY[name], SCENE) == "must be an Assembly: one bearing alone has trb.Simulation"
    assert refused(OF_ASSEMBLY[name], None) == "must be an Assembly"


def test_others() -> None:
    for call in OF_ANY.values():
        assert refused(call, BEARING).startswith("must be a Scene or an Assembly: put it into one, trb.Scene(bearing")
        assert refused(call, None) == "must be a Scene or an Assembly"
    assert refused(trb.rating, BEARING).startswith("must be a Scene, a Result, an Assembly, an AssemblyResult")
    assert (
        refused(lambda given: trb.torque_map(given, [1000.0], [1000.0]), None)
        == "must be a Scene, an Assembly or a Bearing"
    )
    assert "trb.uncertainty(scene) makes one" in refused(lambda given: trb.surrogate(given, "torque"), SCENE)
    for given in (SCENE, BEARING, "study.toml", None):
        assert refused(trb.study.run, given).startswith("must be a Study, or scenes in a list")
    assert refused(trb.plot.bearing_loads, SCENE) == "must be an AssemblyResult"
    for given in (BEARING, None):
        assert refused(lambda base: trb.study.grid(base, {"scene.speed_rpm": [1.0]}), given).startswith(
            "must be a Scene or an Assembly, the tables"
        )
