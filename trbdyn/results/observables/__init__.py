"""Observables: what engineers read from recorded motion. Functions of arrays alone, without files and simulations."""

from trbdyn.results.observables.cage import (
    CageMotion,
    axis_distance,
    cage_frequency,
    cage_speed_ratio,
    classify,
    lean,
    locus,
    orbit_radius,
    speed_deviation_ratio,
    whirl_angle,
    whirl_coherence,
    whirl_frequency,
    whirl_frequency_spectral,
)
from trbdyn.results.observables.drift import (
    LIMITS,
    Drift,
    MotionSettling,
    by_turns,
    drift,
    motion_settling,
    whirl_amplitude,
)
from trbdyn.results.observables.energy import EnergyAudit, energy_audit, energy_balance, power_split, torque_split
from trbdyn.results.observables.growth import Growth, whirl_growth
from trbdyn.results.observables.rollers import (
    PocketStatistics,
    kinematic_slip,
    pocket_statistics,
    spacing,
    spacing_std,
    wrap_angle,
)
from trbdyn.results.observables.signals import FOLDED, Settling, high_share, peak_frequency, settling, spectrum, uniform
from trbdyn.results.observables.uncertainty import MeanError, correlation_time, half_width, mean_error

__all__ = [
    "FOLDED",
    "LIMITS",
    "CageMotion",
    "Drift",
    "EnergyAudit",
    "Growth",
    "MeanError",
    "MotionSettling",
    "PocketStatistics",
    "Settling",
    "axis_distance",
    "by_turns",
    "cage_frequency",
    "cage_speed_ratio",
    "classify",
    "correlation_time",
    "drift",
    "energy_audit",
    "energy_balance",
    "half_width",
    "high_share",
    "kinematic_slip",
    "lean",
    "locus",
    "mean_error",
    "motion_settling",
    "orbit_radius",
    "peak_frequency",
    "pocket_statistics",
    "power_split",
    "settling",
    "spacing",
    "spacing_std",
    "spectrum",
    "speed_deviation_ratio",
    "torque_split",
    "uniform",
    "whirl_amplitude",
    "whirl_angle",
    "whirl_coherence",
    "whirl_frequency",
    "whirl_frequency_spectral",
    "whirl_growth",
    "wrap_angle",
]


def __dir__() -> list[str]:
    return sorted(__all__)
