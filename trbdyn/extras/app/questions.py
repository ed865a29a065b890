"""What a user wants to know: the averages that a plan finds for it, and the pictures and tables that show it."""

from __future__ import annotations

from typing import Final, NamedTuple


class Question(NamedTuple):
    """Something that a user wants to know."""

    words: str  # how the page says it
    want: dict[str, float]  # averages that decide it, with the relative errors that are good enough, for `trbdyn.plan`
    pictures: tuple[str, ...] = ()  # names of the pictures that show it
    tables: tuple[str, ...] = ()  # what is computed besides: 'rating', 'stiffness'


QUESTIONS: Final[dict[str, Question]] = {
    "torque": Question("friction torque and losses", {"torque": 0.02}, ("torque_split", "power_split")),
    "life": Question("rating life", {"outer_load_mean": 0.02}, ("load_zone",), ("rating",)),
    "cage": Question(
        "motion of the cage and its forces",
        {"orbit_rms_over_cpr": 0.05, "pocket_force_p95": 0.1},
        ("cage_locus", "orbit_radius", "pocket_forces"),
    ),
    "stiffness": Question("stiffness", {"outer_load_mean": 0.02}, ("contact_loads",), ("stiffness",)),
    "pressures": Question(
        "contact pressures and films",
        {"outer_load_mean": 0.02, "film_parameter_outer": 0.05},
        ("pressure_map", "film_map"),
    ),
}
OF_SHAFT: Final = ("bearing_loads", "shaft_orbits")
"""Pictures of several bearings on a shaft."""


def want_of(names: list[str]) -> dict[str, float]:
    """Averages with their errors that decide all of some questions: the smallest error of each."""
    found: dict[str, float] = {}
    for name in names:
        for average, error in QUESTIONS[name].want.items():
            found[average] = min(error, found.get(average, error))
    return found
