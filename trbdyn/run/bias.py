"""What tolerances do to the numbers that users read: biases that ``benchmarks/preset_bias.py`` has measured.

Steps that are too long for an impact take energy from it: peaks come out too low, and contacts last too long, the more the
coarser the tolerances. It is no matter of where a step ends: the solution within the steps has nearly the same peaks (the largest
forces of six pieces of 2 ms are 0.2 to 2.6 % higher there with 'fast', 0.1 to 0.5 % with 'standard'). So the biases are measured
against tight runs and told with a result.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from trbdyn.model.motion import is_constant
from trbdyn.run.estimate import case_like, same_tolerances, table

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation

READ: Final = {
    "pocket_peak": ("largest pocket forces", True),
    "pocket_p95": ("95th percentiles of pocket forces", True),
    "duty": ("shares of time in contact with a pocket", True),
    "raceway_peak": ("largest loads on raceways", False),
    "pressure_peak": ("largest pressures on raceways", False),
    "skew": ("skew angles", False),
}
"""What is told: in words, and whether it needs a cage."""
NONE_SEEN: Final = "peaks, percentiles and contact times: no bias by these tolerances was seen"
ON_A_SHAFT: Final = (
    "The bias of the presets was measured with one bearing whose ring is held, not with bearings on a shaft."
)
CHANGING: Final = (
    "that was measured under constant loads and speeds; after a change the largest forces differ more from start to start than "
    "from accuracy to accuracy: a summary gives their band where a load drops, several seeds of Start.unequal that of this scene"
)
LEAST: Final = 0.01
"""Bias below which nothing is said."""


def measured(sim: Simulation) -> tuple[str, Mapping[str, Any]] | None:
    """The measured scene that a simulation is most like, and the biases of its tolerances there.

    Returns
    -------
    tuple of str and mapping, or None
        ``bias_<name>`` and ``bias_<name>_half_width`` for the names of `READ`, relative. None for tolerances that are not those
        of a preset, and other integrators.
    """
    options, known = sim.options, table()["presets_of_scenes"]
    if options.integrator != "bdf" or options.max_order != 2:
        return None
    measured_there = {
        case for case, presets in known.items() if any("tolerances" in _bias(one) for one in presets.values())
    }
    scenes = {name: scene for name, scene in table()["scenes"].items() if name in measured_there}
    if not scenes:
        return None
    case = case_like(sim, scenes)
    tolerances = options.tolerances.model_dump()
    for preset in known[case].values():
        if same_tolerances(tolerances, _bias(preset).get("tolerances", {})):
            return case, _bias(preset)
    return None


def _bias(preset: Mapping[str, Any]) -> Mapping[str, Any]:
    found: Mapping[str, Any] = preset.get("bias", {})
    return found


def note(sim: Simulation) -> str:
    """Biases in a sentence for a result; empty where nothing like it was measured."""
    if len(sim.bearings) > 1:
        return ON_A_SHAFT
    found = measured(sim)
    if found is None:
        return ""
    case, values = found
    said = []
    for name, (words, of_cage) in READ.items():
        value, half = values.get(f"bias_{name}"), values.get(f"bias_{name}_half_width")
        if value is None or half is None or (of_cage and sim.scene.effects.bodies == "rollers"):
            continue
        if abs(value) > max(LEAST, half):
            said.append(
                f"{words} {100.0 * abs(value):.2g} +/- {100.0 * half:.2g} % too {'high' if value > 0.0 else 'low'}"
            )
    scene = table()["scenes"][case]
    place = f"{scene['speed_rpm']:g} rpm and {scene['axial_load']:g} N axial load ('{case}')"
    where = f"measured with a 30310 at {place}, of the scenes that were measured the one most like this"
    told = f"with these tolerances: {', '.join(said)}" if said else NONE_SEEN
    steady = all(is_constant(quantity) for quantity in sim.scene.quantities().values())
    changing = "" if steady else f"; {CHANGING}"
    return f"{told} ({where}){changing}"
