"""Observables: what engineers read from recorded motion. Pure functions over arrays that know no file and no simulation."""

from trbdyn.observables.cage import (
    CageMotion,
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
    whirl_radius,
)
from trbdyn.observables.energy import EnergyAudit, energy_audit, energy_balance, power_split, torque_split
from trbdyn.observables.rollers import (
    PocketStatistics,
    kinematic_slip,
    pocket_statistics,
    spacing,
    spacing_std,
    wrap_angle,
)
from trbdyn.observables.signals import Settling, peak_frequency, settling, spectrum, uniform

__all__ = [
    "CageMotion",
    "EnergyAudit",
    "PocketStatistics",
    "Settling",
    "cage_frequency",
    "cage_speed_ratio",
    "classify",
    "energy_audit",
    "energy_balance",
    "kinematic_slip",
    "lean",
    "locus",
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
    "whirl_angle",
    "whirl_coherence",
    "whirl_frequency",
    "whirl_frequency_spectral",
    "whirl_radius",
    "wrap_angle",
]
