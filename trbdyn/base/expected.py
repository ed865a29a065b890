"""What a function works on is checked first: an object of another kind is refused with the way from it to the right one."""

from __future__ import annotations

from typing import Any, Final

from trbdyn.errors import InputError

_WAYS: Final = {
    ("Scene", "Bearing"): "put it into one, trb.Scene(bearing, speed_rpm=..., axial_load=...)",
    (
        "Scene",
        "Assembly",
    ): "this is done with one bearing alone; trb.equilibrium has the loads of each bearing of a shaft",
    ("Scene", "Result"): "that of a result is result.scene",
    ("Scene", "Simulation"): "that of a simulation is simulation.scene",
    ("Scene", "str"): "trb.load_case reads the scene of a case and its options",
    ("Result", "Scene"): "trb.Simulation(scene).run(revolutions=...) makes one",
    ("Result", "Simulation"): "simulation.run(revolutions=...) makes one",
    ("Result", "Assembly"): "trb.Simulation(assembly).run(revolutions=...) makes one of each bearing",
    ("Result", "AssemblyResult"): "it holds one of each bearing, under the bearing's name",
    ("Result", "str"): "trb.load reads one from a file",
    ("Scene", "Fit"): "that of a fit, with its play of operation, is fit.subject",
    ("LoadCase", "Fit"): 'put its subject into one, trb.LoadCase("warm", 1.0, fit.subject)',
    ("LoadCase", "Scene"): 'put it into one, trb.LoadCase("full", 0.2, scene)',
    ("LoadCase", "Assembly"): 'put it into one, trb.LoadCase("full", 0.2, assembly)',
    ("Assembly", "Scene"): "one bearing alone has trb.Simulation",
    ("Assembly", "str"): "trb.load_assembly reads one and its options",
    ("Uncertainty", "Scene"): "trb.uncertainty(scene) makes one",
}
"""What to do with the second kind where the first one is wanted."""


def expect(field: str, value: Any, *kinds: type) -> None:
    """Refuse a value for an argument that is of none of some kinds, with the way to the right one where there is one."""
    if isinstance(value, kinds):
        return
    names = [kind.__name__ for kind in kinds]
    called = [f"an {name}" if name[0] in "AEIOU" else f"a {name}" for name in names]
    limit = f"must be {' or '.join([', '.join(called[:-1]), called[-1]] if len(called) > 1 else called)}"
    ways = [_WAYS[name, type(value).__name__] for name in names if (name, type(value).__name__) in _WAYS]
    raise InputError.of(field, value, f"{limit}: {ways[0]}" if ways else limit)
