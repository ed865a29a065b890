"""What a run says, in sentences; and what to be careful about."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.run import estimate

if TYPE_CHECKING:
    from trbdyn.results.result import Result

GRAVITY: Final = 9.80665
FULL_FILM, MIXED_FILM = 3.0, 1.0
"""Film parameters above which surfaces are apart, and below which asperities carry: Tallian, ASLE Trans. 10 (1967)
418-439.
"""
FATIGUE_LIMIT: Final = 1.5e9
"""Largest Hertz pressure that clean, well made bearing steel is held to carry for ever (Pa): ISO 281:2007, 9.3.4.2."""
STATIC_LIMIT: Final = 4.0e9
"""Hertz pressure of the static rating of roller bearings (Pa): ISO 76:2006."""
CLOSURE_GOOD: Final = 1e-3
"""Residual of the energy audit over the dissipated work up to which the energy adds up well."""
CLOSURE_LIMIT: Final = 1e-2
"""The same, above which a run is not accurate enough."""

Sentence = tuple[str, str, str]
"""Grade ('good', 'care', 'bad' or 'plain'), headline, sentence."""


def verdict(result: Result, numbers: dict[str, Any]) -> list[Sentence]:
    """Sentences on cage, hits, torque, films, pressure, energy and exactness; those that the recorded groups allow.

    Parameters
    ----------
    result : Result
        The run.
    numbers : dict
        Its summary.
    """
    parts = (_end, _whirl, _hits, _torque, _films, _pressure, _energy, _exactness)
    return [sentence for part in parts if (sentence := part(result, numbers)) is not None]


def what_matters(result: Result, numbers: dict[str, Any]) -> list[str]:
    """Three sentences: how the cage moves, how hard it is hit, what torque it costs; those that the recorded groups
    allow.

    Parameters
    ----------
    result : Result
        The run.
    numbers : dict
        Its summary.
    """
    found = (part(result, numbers) for part in (_whirl, _hits, _torque))
    return [f"{sentence[1]}. {sentence[2]}" for sentence in found if sentence is not None]


def _end(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    turns = f"{numbers['revolutions']:.4g} turns of the shaft ({numbers['duration']:.4g} s)"
    if not result.success:
        return "bad", "The run did not reach its end", f"{turns} were simulated. {result.message}"
    if numbers.get("settled") or numbers.get("settling") == "settled":
        return (
            "plain",
            "Settled",
            f"{turns} were simulated. The motion settled; averages are taken from {numbers['window_start']:.4g} s on.",
        )
    return (
        "care",
        "Not settled",
        f"{turns} were simulated, and it is not known that the motion has settled"
        + (f" ({numbers['settling_reason']})" if numbers.get("settling_reason") else "")
        + ". Take averages as a first look, and run longer for numbers to rely on.",
    )


def _whirl(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    if numbers.get("cage_motion") is None:
        return None
    radius, ratio = numbers["axis_distance_over_cpr"], numbers.get("whirl_ratio")
    orbit = numbers["orbit_radius_over_cpr"]
    where = f"on average {radius:.2f} of its radial play Cpr away from the bearing axis"
    rate = (
        ""
        if ratio is None
        else f", {abs(ratio):.3g} times for each turn of the cage" + (" backwards" if ratio < 0 else "")
    )
    words: dict[str, Sentence] = {
        "stable": (
            "good",
            "The cage does not whirl",
            f"Its centre stays near one place (it moves by {orbit:.2g} of its radial play Cpr about it), {where}.",
        ),
        "circling": (
            "care",
            "The cage whirls",
            f"Its centre goes round in one sense{rate}, on an orbit of {orbit:.2f} Cpr (rms)"
            f"{_within(numbers, 'orbit_radius_over_cpr')}, {where}.",
        ),
        "unstable": (
            "bad",
            "The cage moves without order",
            f"Its centre is {where} and does not go round in one sense: it is thrown from pocket to pocket.",
        ),
    }
    return words[numbers["cage_motion"]]


def _hits(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    peak = numbers.get("pocket_force_peak")
    if peak is None:
        return None
    if peak == 0.0:
        return "good", "No roller touched the cage", "No force was recorded in any pocket after settling."
    weight = result.scene.bearing.cage.mass * GRAVITY
    compared = f"{peak / weight:.3g} times the weight of the cage"
    load = numbers.get("outer_load_mean")
    if load:
        compared += f" and {100.0 * peak / load:.2g} % of the mean load of a roller"
    grade = "good" if load and peak < 0.05 * load else "plain"
    return (
        grade,
        "Hits on the cage",
        f"The hardest force between a roller and its pocket is {peak:.3g} N, {compared}; while they touch, 95 % of the "
        f"forces stay below {numbers['pocket_force_p95']:.3g} N. A pocket is touched "
        f"{100.0 * numbers['pocket_duty']:.2g} % of the time.",
    )


def _within(numbers: dict[str, Any], name: str) -> str:
    """How well an average is known, if it is."""
    width = (numbers.get("confidence") or {}).get(name)
    return "" if width is None else f" (± {width:.1g} by its scatter in this run)"


def _torque(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    torque = numbers.get("torque")
    if torque is None:
        return None
    split = {name: value for name, value in (numbers.get("torque_by_loss") or {}).items() if value}
    part = ""
    if split and torque:
        largest = max(split, key=lambda name: abs(split[name]))
        part = f"; most of it is lost by {largest.replace('_', ' ')}, {split[largest]:.3g} N m"
    power = numbers.get("power_loss")
    heat = "" if power is None else f" The bearing turns {power:.3g} W into heat."
    return (
        "plain",
        "Torque",
        f"The shaft has to overcome {torque:.3g} N m of friction{_within(numbers, 'torque')}{part}.{heat}",
    )


def _films(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    values = {
        name: numbers[f"film_parameter_{side}"]
        for side, name in (("outer", "outer raceway"), ("inner", "inner raceway"), ("rib", "back-face rib"))
        if numbers.get(f"film_parameter_{side}")
    }
    if not values or not result.scene.effects.films:
        return None
    thinnest = min(values, key=lambda name: values[name])
    value = values[thinnest]
    number = f"The mean film parameter (film thickness over roughness) is smallest at the {thinnest}: {value:.3g}."
    if value >= FULL_FILM:
        return "good", "Films keep the surfaces apart", f"{number} Above 3 the surfaces do not touch."
    if value >= MIXED_FILM:
        return (
            "care",
            "Films carry, with some contact",
            f"{number} Between 1 and 3 the highest asperities touch; above 3 none do.",
        )
    return (
        "bad",
        "Films are too thin",
        f"{number} Below 1 asperities carry a part of the load: wear and early fatigue are to be expected.",
    )


def _pressure(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    found = {
        name: numbers[f"{side}_pressure_max"]
        for side, name in (("outer", "outer raceway"), ("inner", "inner raceway"), ("rib", "back-face rib"))
        if numbers.get(f"{side}_pressure_max")
    }
    if not found:
        return None
    where = max(found, key=lambda name: found[name])
    value = found[where]
    number = f"The largest pressure, {1e-9 * value:.3g} GPa, is at the {where}."
    if value < FATIGUE_LIMIT:
        return (
            "good",
            "Pressures",
            f"{number} It is below the 1.5 GPa that ISO 281 takes as the fatigue limit of bearing steel.",
        )
    if value < STATIC_LIMIT:
        return (
            "care",
            "Pressures",
            f"{number} It is above the 1.5 GPa that ISO 281 takes as the fatigue limit: the life is finite.",
        )
    return "bad", "Pressures", f"{number} It is above the 4 GPa of the static rating (ISO 76): the raceway yields."


def _energy(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    closure = numbers.get("energy_closure")
    if closure is None:
        return None
    said = f"Work put in, energy stored and losses agree within {closure:.1g} of the dissipated work."
    if closure <= CLOSURE_GOOD:
        return "good", "The energy adds up", f"{said} Below {CLOSURE_GOOD:g} is good."
    if closure <= CLOSURE_LIMIT:
        return (
            "care",
            "The energy adds up, not closely",
            f"{said} Losses may be wrong by as much; accuracy='reference' is closer.",
        )
    return (
        "bad",
        "The energy does not add up",
        f"{said} More than {CLOSURE_LIMIT:g} means that the run is not accurate enough.",
    )


def _exactness(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    settings = result.meta.get("settings") or {}
    preset = settings.get("accuracy")
    measured = estimate.table()["presets"].get(preset)
    own = [name for name in ("rtol", "atol_position", "atol_angle", "atol_velocity", "atol_spin") if settings.get(name)]
    if measured is None or own or settings.get("integrator") != "bdf":
        return (
            "plain",
            "Accuracy",
            "Tolerances of your own: no error was measured for them. Compare with a run at 'reference'.",
        )
    cage, power = measured["error_cage_over_cpr"], measured["error_power"]
    return (
        "plain",
        "Accuracy",
        f"With the preset '{preset}' the cage's centre was within {100.0 * cage:.2g} % of Cpr and the power loss within "
        f"{100.0 * power:.2g} % of a reference, measured over collisions of the 30310 test bearing; that is the error of the "
        "integration alone. A cage that collides is chaotic: compare averages of two runs, not their paths.",
    )


def warnings(result: Result, numbers: dict[str, Any], estimated: int, assumed: int) -> list[str]:
    """What a reader must know before relying on the numbers."""
    out = [str(note) for note in result.meta.get("notes") or ()]
    if estimated:
        out.append(
            f"{estimated} inputs are estimated from the catalogue's numbers, see the table of inputs; trb.sensitivity tells "
            "which of them matter."
        )
    if assumed:
        out.append(
            f"{assumed} inputs are assumed by the package because no source gives them, see the table of inputs."
        )
    interval = float(np.median(np.diff(result["time"]))) if len(result) > 2 else math.nan
    if numbers.get("pocket_force_peak") and "peaks" not in result.groups:
        out.append(
            f"Peaks are those of the records, one every {1e3 * interval:.3g} ms: a hit between two records may be harder."
        )
    if "contacts" in result.groups and "rib_overhang" in result:
        overhang = float(result["rib_overhang"].max())
        if overhang > 0.0:
            out.append(f"Up to {100.0 * overhang:.2g} % of the rib's contact ellipse lies beyond an edge of the rib.")
    effects = result.scene.effects
    off = [
        name.replace("_", " ")
        for name in ("gravity", "back_rib", "front_rib", "pocket_bars", "pocket_ends")
        if not getattr(effects, name)
    ]
    if off:
        out.append(f"Switched off in this scene: {', '.join(off)}.")
    if effects.planar:
        out.append("The scene is planar: axial motion and tilts are frozen.")
    if numbers["revolutions"] < 10.0:
        out.append(f"The run is short: {numbers['revolutions']:.3g} turns of the shaft.")
    return out
