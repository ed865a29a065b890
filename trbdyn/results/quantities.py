"""The quantities of a summary: for each its words in the table, its unit, and a sentence that says what it means."""

from __future__ import annotations

from typing import Final, NamedTuple

from trbdyn.results.fields import contacts


class Quantity(NamedTuple):
    """How an entry of the summary is shown: what it is in a few words, its unit, and a sentence for the report and the
    documentation.
    """

    words: str
    unit: str
    meaning: str


def _of_contacts(name: str, words: str, unit: str, meaning: str) -> dict[str, Quantity]:
    """A quantity of each contact of the rollers with the rings."""
    return {
        name.format(side): Quantity(f"{words}, {place}", unit, meaning.format(place))
        for side, place in contacts().items()
    }


def _peaks_of_contacts(name: str, words: str, unit: str, meaning: str) -> dict[str, Quantity]:
    """An extreme of each contact, and when it was."""
    out: dict[str, Quantity] = {}
    for key, quantity in _of_contacts(name, words, unit, meaning).items():
        out |= {key: quantity, f"{key}_time": Quantity("    at", "s", "When that was.")}
    return out


QUANTITIES: Final[dict[str, Quantity]] = {
    "success": Quantity("finished", "", "Whether the run reached its end."),
    "message": Quantity("how it ended", "", "How it ended."),
    "revolutions": Quantity(
        "revolutions of the shaft, or of the outer ring where the shaft rests",
        "",
        "Turns of the shaft, or of the outer ring where the shaft rests, from the first to the last record.",
    ),
    "duration": Quantity("bearing time", "s", "Time that passed in the bearing."),
    "settled": Quantity("settled", "", "Whether the motion has stopped to drift."),
    "settling": Quantity(
        "settling: settled, drifting or unknown", "", "Settled, still drifting, or not to be told from this record."
    ),
    "settling_reason": Quantity("why it is not known to have settled", "", "Why it is not known."),
    "settling_time_scale": Quantity("time scale of the drift", "s", "How fast it drifts."),
    "settling_needed": Quantity(
        "length of a run expected to tell", "s", "So long a run is expected to tell whether its motion has settled."
    ),
    "creep_time": Quantity(
        "time of the rollers' creep", "s", "Time in which creep of the rollers lets the whirl change by its own size."
    ),
    "window_start": Quantity("averages from", "s", "Averages are taken from this time on."),
    "window_end": Quantity("averages to", "s", "Averages are taken up to this time."),
    "changing": Quantity(
        "what changes in the run", "", "Speeds and loads that change: averages hold for their window alone."
    ),
    "speed_rpm": Quantity("shaft speed", "rpm", "Mean speed of the inner ring over the window of the averages."),
    "outer_speed_rpm": Quantity("outer ring's speed", "rpm", "Mean speed of an outer ring that turns."),
    "cage_speed_ratio": Quantity("cage speed / shaft speed", "", "Turns of the cage for each turn of the shaft."),
    "cage_speed_ratio_kinematic": Quantity(
        "the same, pure rolling", "", "The same if all rollers rolled without slip."
    ),
    "cage_slip": Quantity("slip of the roller set", "", "How much slower than pure rolling the roller set goes round."),
    "cage_motion": Quantity(
        "cage motion",
        "",
        "Stable: the centre stays at a place. Rocking: it hangs beside the bearing axis and moves about that place. "
        "Circling: it goes round the axis in one sense. Unstable: none of these. Unknown: the run is too short.",
    ),
    "orbit_rms_over_cpr": Quantity(
        "orbit radius of the cage about its mean place, rms / Cpr",
        "",
        "How far the cage's centre moves about its mean place, over the radial play: the whirl's size.",
    ),
    "orbit_radius_over_cpr_p05": Quantity("    5 %", "", "Below this for 5 % of the time."),
    "orbit_radius_over_cpr_p95": Quantity("    95 %", "", "Below this for 95 % of the time."),
    "axis_distance_over_cpr": Quantity(
        "distance of the cage from the bearing axis, mean / Cpr",
        "",
        "Mean distance of the cage's centre from the axis over the radial play; 1: the play is used up.",
    ),
    "axis_distance_over_cpr_p05": Quantity("    5 %", "", "Below this for 5 % of the time."),
    "axis_distance_over_cpr_p95": Quantity("    95 %", "", "Below this for 95 % of the time."),
    "whirl_ratio": Quantity(
        "whirl frequency / cage frequency",
        "",
        "Orbits of the cage's centre for each turn of the cage; 1 is the usual whirl with the cage's rotation.",
    ),
    "whirl_frequency": Quantity(
        "whirl frequency", "Hz", "Orbits of the cage's centre in a second; negative: against the rotation."
    ),
    "whirl_coherence": Quantity(
        "share of turning in the cage centre's motion",
        "",
        "1: the centre goes round steadily in one sense; 0: it does not.",
    ),
    "speed_deviation_ratio": Quantity(
        "cage centre speed, deviation / mean",
        "",
        "Spread of the centre's speed over its mean: 0 for a steady circle, 0.52 for random motion.",
    ),
    "axial_over_clearance": Quantity(
        "axial position / axial play", "", "Mean axial place of the cage in its play; 0: against the large ends."
    ),
    "running_play_radial": Quantity(
        "radial play of the warm, turning cage",
        "m",
        "Cpr with the growth of the parts by temperature and rotation; Cpr itself stays that of the drawing.",
    ),
    "running_play_circumferential": Quantity(
        "circumferential play of the warm, turning cage",
        "m",
        "Cpc with the growth of the parts by temperature and rotation.",
    ),
    "cage_deflection": Quantity(
        "displacement of a pocket's face by the cage's deformation, largest",
        "m",
        "How far the modes of an elastic cage move the middle of a pocket's face, at the records.",
    ),
    "tilt_rms": Quantity("cage tilt, rms", "rad", "How far the cage's axis leans."),
    "lean_mean": Quantity(
        "tilt to the side of the cage's displacement, mean",
        "rad",
        "Positive: the axis leans to the side to which the centre is displaced.",
    ),
    "spacing_std_deg": Quantity(
        "roller spacing, deviation", "deg", "Spread of the angles between neighbouring rollers."
    ),
    "pocket_force_p95": Quantity(
        "pocket force, 95 % in contact", "N", "While a roller touches the cage, 95 % of the forces stay below this."
    ),
    "pocket_force_peak": Quantity(
        "pocket force, largest in the run", "N", "The hardest hit on a pocket in the whole run."
    ),
    "pocket_force_peak_time": Quantity("    at", "s", "When that was."),
    "pocket_force_peak_low": Quantity(
        "the same with other starts or accuracies, at least",
        "N",
        "Where the load drops and comes back, other starts and accuracies give a hardest hit above this in 97 of 100 "
        "cases, as measured on a 30310.",
    ),
    "pocket_force_peak_high": Quantity(
        "the same with other starts or accuracies, at most", "N", "And one below this in 97 of 100 cases."
    ),
    "pocket_impacts": Quantity(
        "impacts in the pockets, in the run", "", "How often a roller began to touch its pocket."
    ),
    "pocket_impulse_peak": Quantity(
        "largest impulse of one impact, in the run", "N s", "Momentum that the hardest impact passed on."
    ),
    "land_force_peak": Quantity(
        "force of the land on the cage, largest in the run", "N", "The hardest push of the land that guides the cage."
    ),
    "land_force_peak_time": Quantity("    at", "s", "When that was."),
    "land_gap_min": Quantity(
        "gap between cage and land, smallest in the run",
        "m",
        "How near the cage came to the land; below bearing.land.contact_film they touch.",
    ),
    "land_gap_min_time": Quantity("    at", "s", "When that was."),
    "pocket_duty": Quantity(
        "share of time that a pocket is touched", "", "Share of the time for which a pocket is touched."
    ),
    **_of_contacts("{}_load_mean", "load a roller", "N", "Mean load of a roller at the {}."),
    **_peaks_of_contacts("{}_pressure_max", "largest pressure in the run", "Pa", "Largest Hertz pressure at the {}."),
    "equivalent_load": Quantity(
        "equivalent dynamic load P (ISO 281)",
        "N",
        "The radial load that would wear the bearing out as fast, by the factors of the catalogue.",
    ),
    "axial_load_left_out": Quantity(
        "axial load that no life counts",
        "N",
        "It acts on ribs, which ISO 281 does not rate: give the maker's e and Y, see trb.rating.",
    ),
    "permissible_axial_load": Quantity(
        "axial load that ribs carry for long",
        "N",
        "By heat and strength of the ribs, a law of a maker: see trb.rating.",
    ),
    "basic_life_hours": Quantity(
        "basic rating life L10h (ISO 281)", "h", "Nine of ten bearings last so long, by the catalogue's rating alone."
    ),
    "modified_life_hours": Quantity(
        "modified rating life Lnmh (ISO 281)",
        "h",
        "The same with film and cleanliness of the oil; trb.rating says what is assumed.",
    ),
    "reference_life_hours": Quantity(
        "basic reference rating life L10rh (ISO 16281)",
        "h",
        "The same as the basic life, from the loads along each roller: exponent 4, no allowance for edges.",
    ),
    "modified_reference_life_hours": Quantity(
        "modified reference rating life Lnmrh (ISO 16281)",
        "h",
        "The reference life with lubrication, cleanliness and reliability taken into account.",
    ),
    "smallest_load": Quantity(
        "smallest load, so that rollers roll", "N", "Below this load rollers may slide instead of rolling."
    ),
    "speed_over_limit": Quantity(
        "speed over the catalogue's limiting speed", "", "Above 1 the bearing turns faster than its catalogue allows."
    ),
    "static_safety": Quantity(
        "static safety C0/P0 (ISO 76)",
        "",
        "Static rating over static load: below 1 the raceways keep dents, normal operation requires 1.5 (ISO 76).",
    ),
    "viscosity_ratio": Quantity(
        "viscosity ratio kappa (ISO 281)",
        "",
        "Viscosity over the one that this bearing needs at its speed: below 1 surfaces touch, 1 to 4 is good.",
    ),
    **_of_contacts(
        "film_parameter_{}",
        "film parameter",
        "",
        "Film thickness over roughness at the {}; from effects.friction.lambda_full on, the film carries all.",
    ),
    **_peaks_of_contacts(
        "film_parameter_{}_min",
        "smallest film parameter in the run",
        "",
        "The thinnest film over roughness at the {}, at any moment of the run.",
    ),
    "skew_rms": Quantity("roller skew, rms", "rad", "How far the rollers turn out of their rolling direction."),
    "torque": Quantity("friction torque of the shaft", "N m", "Friction torque that the shaft has to overcome."),
    "torque_outer": Quantity(
        "friction torque on the outer ring", "N m", "Friction torque that the outer ring passes on to the housing."
    ),
    "drag_share": Quantity(
        "share of the oil's drag in the torque",
        "",
        "Drag of the oil round the rollers; 0 where `effects.oil_fill` is 0, as by default: then no drag is counted.",
    ),
    "power_loss": Quantity("power loss", "W", "Heat that the bearing makes."),
    "energy_closure": Quantity(
        "energy audit: residual / dissipated work",
        "",
        "Energy that does not add up, over the dissipated work: below 0.001 is good, above 0.01 too much.",
    ),
    "energy_residual": Quantity("energy audit: residual", "J", "Error of the energy balance."),
    "steps": Quantity("steps", "", "Steps of the integrator."),
    "rhs_evaluations": Quantity("evaluations of the equations of motion", "", "How often all forces were computed."),
    "followed_frequency": Quantity(
        "vibrations are followed up to",
        "Hz",
        "Vibrations up to this frequency keep it within 1 %; steps slow and damp faster ones. Smaller tolerances, or max_step, "
        "raise it; trb.stiffness(scene).modes(body) gives the natural frequencies of a shaft.",
    ),
    "wall_s": Quantity("wall time", "s", "Computing time."),
    "wall_s_per_revolution": Quantity("wall time a revolution", "s", "Computing time for a turn of the shaft."),
    "confidence_note": Quantity(
        "About the numbers behind ±",
        "",
        "How the numbers behind ± were found: the true mean lies within in 95 of 100 cases.",
    ),
    "accuracy_note": Quantity(
        "About the accuracy",
        "",
        "What the tolerances of the run do to peaks, percentiles and contact times, as measured on a like scene.",
    ),
    "confidence": Quantity(
        "half width of the 95 % confidence interval",
        "",
        "Half width of the interval that holds the true mean in 95 of 100 cases.",
    ),
    "torque_note": Quantity("Why the torques of the rings differ", "", "Why the two rings have different torques."),
    "rolling_note": Quantity(
        "About rolling resistance", "", "Whether the law of rolling resistance was made for these loads and this tilt."
    ),
    "power_split": Quantity("power loss by mechanism", "W", "Share of each kind in the power loss."),
    "torque_by_loss": Quantity(
        "the same as friction torque of the shaft", "N m", "The shaft's torque by what loses it."
    ),
    "torque_split": Quantity(
        "forces on the inner ring that make this torque",
        "N m",
        "Forces on the inner ring that make the shaft's torque.",
    ),
}
"""Entries of the summary, in the order of the table.

Cpr is the radial play of the cage, one-sided. A force on the inner ring that makes torque need not lose power: traction passes on
what rolling resistance takes at the outer raceway. So the shares of ``torque_split`` differ from those of ``torque_by_loss``.
"""
