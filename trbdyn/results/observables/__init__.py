"""Observables: what engineers read from recorded motion. Functions of arrays alone, without files and simulations."""

# ruff: isort: skip_file
from __future__ import annotations

from typing import TYPE_CHECKING

from trbdyn.base.lazy import lazy_names

if TYPE_CHECKING:
    from trbdyn.results.observables.cage import (
        CageMotion as CageMotion,
        axis_distance as axis_distance,
        cage_frequency as cage_frequency,
        cage_speed_ratio as cage_speed_ratio,
        classify as classify,
        lean as lean,
        locus as locus,
        orbit_radius as orbit_radius,
        speed_deviation_ratio as speed_deviation_ratio,
        whirl_angle as whirl_angle,
        whirl_coherence as whirl_coherence,
        whirl_frequency as whirl_frequency,
        whirl_frequency_spectral as whirl_frequency_spectral,
    )
    from trbdyn.results.observables.rates import (
        LEAST_BLOCKS as LEAST_BLOCKS,
        Drift as Drift,
        Forecast as Forecast,
        by_turns as by_turns,
        drift as drift,
        forecast as forecast,
        latest as latest,
        mean_unknown as mean_unknown,
        side_of as side_of,
        time_left as time_left,
    )
    from trbdyn.results.observables.slow_motion import (
        LIMITS as LIMITS,
        MotionSettling as MotionSettling,
        motion_settling as motion_settling,
        turn_means as turn_means,
        whirl_amplitude as whirl_amplitude,
    )
    from trbdyn.results.observables.starts import (
        COMPARED as COMPARED,
        Compared as Compared,
        agree as agree,
        compare_starts as compare_starts,
    )
    from trbdyn.results.observables.energy import (
        EnergyAudit as EnergyAudit,
        energy_audit as energy_audit,
        energy_balance as energy_balance,
        power_split as power_split,
        torque_split as torque_split,
    )
    from trbdyn.results.observables.growth import Growth as Growth, whirl_growth as whirl_growth
    from trbdyn.results.observables.rollers import (
        PocketStatistics as PocketStatistics,
        kinematic_slip as kinematic_slip,
        pocket_statistics as pocket_statistics,
        spacing as spacing,
        spacing_std as spacing_std,
        wrap_angle as wrap_angle,
    )
    from trbdyn.results.observables.signals import (
        FOLDED as FOLDED,
        Settling as Settling,
        high_share as high_share,
        peak_frequency as peak_frequency,
        settling as settling,
        spectrum as spectrum,
        uniform as uniform,
        windowed as windowed,
    )
    from trbdyn.results.observables.uncertainty import (
        MeanError as MeanError,
        correlation_time as correlation_time,
        half_width as half_width,
        mean_error as mean_error,
    )

__all__, __getattr__, __dir__ = lazy_names(__name__, __file__)
