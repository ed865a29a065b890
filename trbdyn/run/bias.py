"""What tolerances do to the numbers that users read: biases that ``benchmarks/preset_bias.py`` has measured.

Steps that are too long for an impact take energy from it: peaks come out too low, and contacts last too long, the more the
coarser the tolerances. It is no matter of where a step ends: the solution within the steps has nearly the same peaks (the
largest forces of six pieces of 2 ms are 0.2 to 2.6 % higher there with 'fast', 0.1 to 0.5 % with 'standard'). So the biases
are measured against tight runs: what many windows give with a preset less what they give with far tighter tolerances, over
the latter, with the half width of its 95 % interval. They are stated only for the effects that they were measured with, those
of `Effects.standard`, and for one bearing whose ring is held or follows its load. Summary and report read them here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.model.effects import Effects
from trbdyn.model.motion import is_constant
from trbdyn.results.numbers import TABLE
from trbdyn.run import estimate

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene
    from trbdyn.results.result import Result
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
BIASES: Final[Mapping[str, tuple[str, ...]]] = {
    "bias_duty": ("pocket_duty",),
    "bias_pocket_p95": ("pocket_force_p95",),
    "bias_pocket_peak": ("pocket_force_peak",),
    "bias_impulse_peak": ("pocket_impulse_peak",),
    "bias_land_peak": ("land_force_peak",),
    "bias_pressure_peak": ("outer_pressure_max", "inner_pressure_max"),
    "bias_skew": ("skew_rms",),
    "bias_orbit": ("orbit_rms_over_cpr",),
    "bias_loss": ("torque", "power_loss"),
}
"""Entries of the summary that a bias of the table of accuracy belongs to; others are named ``bias_`` and the entry itself."""
UNITS: Final[Mapping[str, str]] = {"bias_orbit": "Cpr"}
"""Biases that are no share of the number itself."""


@dataclass(frozen=True)
class Bias:
    """How much too high or too low a number is by the integration with an accuracy `preset`.

    `share` is the number of this accuracy over that of a far tighter one, less one, or their difference in `unit` where it is
    no share of the number itself; `half_width` is that of its 95 % interval, nan where it is not known; `measured` says where
    it was measured.
    """

    share: float
    half_width: float
    preset: str
    measured: str
    unit: str = ""

    def __str__(self) -> str:
        width = 0.0 if math.isnan(self.half_width) else self.half_width
        ends = (f"{100.0 * abs(end):.2g}" for end in (self.share - width, self.share + width))
        least, most = sorted(ends, key=float)
        unit = f" % of {self.unit}" if self.unit else " %"
        if abs(self.share) <= width:
            return f"No bias was seen with accuracy '{self.preset}', within {most}{unit}."
        amount = most if least == most else f"{least} to {most}"
        return f"With accuracy '{self.preset}' it is {amount}{unit} too {'low' if self.share < 0.0 else 'high'}."


def measured(
    scene: Scene, preset: str | None, axial_load: float, colliding: bool
) -> tuple[str, Mapping[str, Any]] | None:
    """The measured scene that a scene is most like by its axial load (N) and by whether its cage whirls (`estimate.fast_cage`),
    and the relative biases of a preset there: ``bias_<name>`` and ``bias_<name>_half_width`` for the names of `READ`.

    None for tolerances of one's own (preset None), and for other effects than those that were measured.
    """
    table = estimate.table()
    known = {
        case: one[preset]["bias"] for case, one in table["presets_of_scenes"].items() if "bias" in one.get(preset, {})
    }
    like = Effects.standard().replace(quadrature=scene.effects.quadrature, n_slices=scene.effects.n_slices)
    known = {
        case: found for case, found in known.items() if found.get("effects") == "standard" and scene.effects == like
    }
    if not known or preset is None:
        return None
    case = estimate.most_like(scene, axial_load, colliding, {name: table["scenes"][name] for name in known})
    return case, known[case]


def note(sim: Simulation) -> str:
    """Biases in a sentence for a result; empty where nothing like it was measured."""
    if len(sim.bearings) > 1:
        return ON_A_SHAFT
    options, scene = sim.options, sim.scene
    preset = None if options.integrator != "bdf" or options.max_order != 2 else estimate.preset_like(options)
    found = measured(scene, preset, estimate.axial_of(sim), estimate.whirls(sim))
    if found is None:
        return ""
    case, values = found
    said = []
    for name, (words, of_cage) in READ.items():
        value, half = values.get(f"bias_{name}"), values.get(f"bias_{name}_half_width")
        if value is None or half is None or (of_cage and not scene.effects.has_cage):
            continue
        if abs(value) > max(LEAST, half):
            said.append(
                f"{words} {100.0 * abs(value):.2g} +/- {100.0 * half:.2g} % too {'high' if value > 0.0 else 'low'}"
            )
    told = f"with these tolerances: {', '.join(said)}" if said else NONE_SEEN
    steady = all(is_constant(quantity) for quantity in scene.quantities().values())
    return f"{told} ({_where(case)}){'' if steady else f'; {CHANGING}'}"


def _where(case: str) -> str:
    scene = estimate.table()["scenes"][case]
    place = f"{scene['speed_rpm']:g} rpm and {scene['axial_load']:g} N axial load ('{case}')"
    return f"measured with a 30310 at {place} and the default effects, of the scenes that were measured the one most like this"


def biases(result: Result) -> dict[str, Bias]:
    """Measured biases of the numbers of a run, by the names of the summary; none where no preset was used, or nothing was
    measured for it.
    """
    preset = preset_of(result)
    if not result.has_cage or result.on_shaft:
        return {}
    found = measured(result.scene, preset, axial_load(result), colliding(result))
    if found is None or preset is None:
        return {}
    case, values = found
    where = f"Accuracy '{preset}' against far tighter tolerances, {_where(case)}; a run with accuracy='reference' shows it here."
    out: dict[str, Bias] = {}
    for name in values:
        share, width = values[name], values.get(f"{name}_half_width")
        entries = BIASES.get(name, (name.removeprefix("bias_"),))
        if not name.startswith("bias_") or share is None or not set(entries) <= set(TABLE):
            continue
        if abs(share) + (width or 0.0) >= LEAST:
            bias = Bias(share, math.nan if width is None else width, preset, where, UNITS.get(name, ""))
            out |= dict.fromkeys(entries, bias)
    return out


def preset_of(result: Result) -> str | None:
    """The preset with whose tolerances a run was made; None for tolerances or an integrator of one's own."""
    settings: Mapping[str, Any] = result.meta.get("settings") or {}
    own = [name for name in ("rtol", "atol_position", "atol_angle", "atol_velocity", "atol_spin") if settings.get(name)]
    preset = settings.get("accuracy")
    known = preset in estimate.table()["presets"] and not own and settings.get("integrator") == "bdf"
    return str(preset) if known else None


def axial_load(result: Result) -> float:
    """Mean axial load of the run (N); 0 where the ring's force was not recorded."""
    return float(abs(result["ring_force"][:, 2].mean())) if "ring" in result.groups and len(result) else 0.0


def colliding(result: Result) -> bool:
    """Whether the cage's centre moves fast, as it does in a whirl (see `estimate.fast_cage`)."""
    if "cage" not in result.groups or len(result) < 2:
        return False
    speed = float(np.sqrt(np.mean(np.sum(result["cage_velocity"][:, :2] ** 2, axis=1))))
    return estimate.fast_cage(speed, 2.0 * math.pi * result.cage_frequency, result.clearances.radial)
