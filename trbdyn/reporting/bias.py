"""What the accuracy of the integration does to the numbers of a run: the bias of each, as it was measured for its preset.

Two runs of a colliding cage part soon, so the integration's error of a mean or of a peak is no difference of two paths. It is
what many runs give with this preset less what they give with far tighter tolerances, over the latter (of the orbit: over Cpr),
with the half width of its 95 % interval. `benchmarks/work_precision.py` measures it in scenes of several kinds; the one most like
the run is taken. Every number whose bias stands in the table of accuracy is shown.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.results.quantities import QUANTITIES
from trbdyn.run import estimate

if TYPE_CHECKING:
    from trbdyn.results.result import Result

BIASES: Final[Mapping[str, tuple[str, ...]]] = {
    "bias_duty": ("pocket_duty",),
    "bias_pocket_p95": ("pocket_force_p95",),
    "bias_pocket_peak": ("pocket_force_peak",),
    "bias_impulse_peak": ("pocket_impulse_peak",),
    "bias_land_peak": ("land_force_peak",),
    "bias_pressure_peak": ("outer_pressure_max", "inner_pressure_max"),
    "bias_skew": ("skew_rms",),
    "bias_orbit": ("orbit_radius_over_cpr",),
    "bias_loss": ("torque", "power_loss"),
}
"""Entries of the summary that a bias of the table of accuracy belongs to; others are named ``bias_`` and the entry itself."""
UNITS: Final[Mapping[str, str]] = {"bias_orbit": "Cpr"}
"""Biases that are no share of the number itself."""
LEAST: Final = 5e-3
"""Share below which a bias is not worth a word."""


@dataclass(frozen=True)
class Bias:
    """How much too high or too low a number is by the integration.

    Attributes
    ----------
    share : float
        Number of this accuracy over that of a far tighter one, less one, or their difference in `unit`; negative: too low.
    half_width : float
        Half width of its 95 % interval; nan where it is not known.
    preset : str
        The accuracy.
    measured : str
        Where it was measured, in words.
    unit : str
        What the share is of, where it is not of the number itself.
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


def biases(result: Result) -> dict[str, Bias]:
    """Measured biases of the numbers of a run, by the names of the summary.

    Parameters
    ----------
    result : Result
        The run.

    Returns
    -------
    dict of str to Bias
        Empty where no preset was used, or nothing was measured for it.
    """
    preset = preset_of(result)
    if preset is None or not result.has_cage:
        return {}
    table = estimate.table()
    case = estimate.most_like(result.scene, axial_load(result), colliding(result), table["scenes"])
    found = table["presets_of_scenes"].get(case, {}).get(preset, {}).get("bias", {})
    where = (
        f"Measured for accuracy '{preset}' against far tighter tolerances, over many runs of the scene most like this one "
        f"of those measured: {table['scenes'][case]['text']}, 30310 at {table['scenes'][case]['speed_rpm']:g} rpm. "
        "It may be another one here; a run with accuracy='reference' tells."
    )
    out: dict[str, Bias] = {}
    for name in found:
        share, width = found[name], found.get(f"{name}_half_width")
        entries = BIASES.get(name, (name.removeprefix("bias_"),))
        if share is None or not set(entries) <= set(QUANTITIES) or abs(share) + (width or 0.0) < LEAST:
            continue
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
