"""What a run says, in sentences; and what to be careful about.

What has not settled is not judged: such a sentence has no grade, says what was seen so far, and how long a run is expected to
tell. Loads, films and pressures at the raceways follow the load on the bearing at once, so they are judged from one turn of the
rollers on.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from trbdyn.model.motion import value_at, values_of
from trbdyn.results.assembly import AssemblyResult, whole
from trbdyn.results.fields import contacts
from trbdyn.results.result import Result
from trbdyn.results.rows.losses import NOT_LOST
from trbdyn.run import estimate
from trbdyn.run.contact_pressure import edge_warnings
from trbdyn.run.torque_laws import straight_rollers, torque_laws
from trbdyn.standards.sheet import life_text

GRAVITY: Final = 9.80665
MIXED_FILM: Final = 1.0
"""Film parameter below which asperities carry a good part of the load: Tallian, ASLE Trans. 10 (1967) 418-439. The one from which
the film carries all is that of the scene, ``effects.friction.lambda_full``.
"""
SOFT_HIT: Final = 0.05
"""Largest force on a pocket, over the mean load of a roller, up to which hits are soft."""
STRAIGHT: Final = 15.0
"""Angle from straight below up to which a cage hangs straight below the axis (deg)."""
FATIGUE_LIMIT: Final = 1.5e9
"""Largest Hertz pressure that clean, well made bearing steel is held to carry for ever (Pa): ISO 281:2007, 9.3.4.2."""
NORMAL_SAFETY: Final = 1.5
"""Static safety C0/P0 that ISO 76:2006 asks of roller bearings in normal operation."""
STATIC_LIMIT: Final = 4.0e9
"""Hertz pressure of the static rating of roller bearings (Pa): ISO 76:2006."""
SHORT_LIFE: Final = 3000.0
"""Life (h) below which even machines that run now and then are not designed."""
USUAL_LIFE: Final = 20_000.0
"""Life (h) from which on a bearing suits machines of eight hours a day; both as in makers' tables of specification lives: SKF,
Rolling Bearings, 2018, selecting bearing size, table 1: 300 to 3000 h and 20 000 to 30 000 h.
"""
LIVES: Final = {
    "basic_life_hours": "L10h",
    "modified_life_hours": "Lnmh",
    "reference_life_hours": "L10rh",
    "modified_reference_life_hours": "Lnmrh",
}
CLOSURE_GOOD: Final = 1e-3
"""Residual of the energy audit over the dissipated work up to which the energy adds up well."""
CLOSURE_LIMIT: Final = 1e-2
"""The same, above which a run is not accurate enough."""

Sentence = tuple[str, str, str]
"""Grade ('good', 'care', 'bad' or 'plain'), headline, sentence."""


def verdict(result: Result, numbers: dict[str, Any]) -> list[Sentence]:
    """Sentences on life, cage, hits, torque, films, pressure, energy and exactness; those that the recorded groups allow.

    The numbers are those of the summary, with the lives of the run's records where it has none, as speed or loads change.
    """
    parts = (_end, _life, _on_ribs, _static, _pressure, _films, _torque, _whirl, _hits, _energy, _exactness)
    return [sentence for part in parts if (sentence := part(result, numbers)) is not None]


def verdict_of_shaft(result: AssemblyResult) -> list[Sentence]:
    """Sentences on the bearings of a shaft together: how the run ended, torque and loss of all, and the energy of the whole."""
    each = result.summary()
    together, first = whole(each), next(iter(each.values()))
    changing = [f"{name}: {values['changing']}" for name, values in each.items() if values.get("changing")]
    waits = [name for name, values in each.items() if not _settled(values)]
    turns = f"{first['revolutions']:.4g} turns of the {_ring(first)} ({first['duration']:.4g} s) were simulated."
    if not result.success:
        ended: Sentence = ("bad", "The run did not reach its end", f"{turns} {result.message}")
    elif changing:
        ended = ("plain", "A run that changes", f"{turns} {'; '.join(changing)}.")
    elif waits:
        said = f"{turns} It is not known whether the cage's motion has settled in {', '.join(waits)}."
        ended = ("care", "Too short to tell how the cages move in the long run", said)
    else:
        ended = ("plain", "Settled", f"{turns} The motion settled in all bearings.")
    found = [ended]
    torque, power = together.get("torque"), together.get("power_loss")
    if torque is not None:
        of_each = ", ".join(f"{name} {values['torque']:.3g} N m" for name, values in each.items())
        heat = "" if power is None else f" The bearings turn {power:.3g} W into heat."
        found.append(
            ("plain", "Torque", f"The shaft has to overcome {torque:.3g} N m of friction in all: {of_each}.{heat}")
        )
    if all("energy" in one.groups for one in result.parts) and (energy := _of_energy(result.energy.closure)):
        found.append(energy)
    return found


def what_matters(result: Result, numbers: dict[str, Any]) -> list[str]:
    """Three sentences: how the cage moves, how hard it is hit, what torque it costs; those that the recorded groups allow."""
    found = (part(result, numbers) for part in (_whirl, _hits, _torque))
    return [f"{sentence[1]}. {sentence[2]}" for sentence in found if sentence is not None]


def _settled(numbers: dict[str, Any]) -> bool:
    return bool(numbers.get("settled") or numbers.get("settling") == "settled")


def _end(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    turns = f"{numbers['revolutions']:.4g} turns of the {_ring(numbers)} ({numbers['duration']:.4g} s)"
    if not result.success:
        return "bad", "The run did not reach its end", f"{turns} were simulated. {result.message}"
    if numbers.get("changing"):
        return (
            "plain",
            "A run that changes",
            f"{turns} were simulated; {numbers['changing']}. {_averages(numbers)} and hold for this stretch alone; largest and "
            "smallest values are those of the whole run.",
        )
    if _settled(numbers):
        return (
            "plain",
            "Settled",
            f"{turns} were simulated. The motion settled; averages are taken from {numbers['window_start']:.4g} s on.",
        )
    drifts = numbers.get("settling") == "drifting"
    reason = f": {numbers['settling_reason']}" if numbers.get("settling_reason") else ""
    known = sorted(
        set(numbers.get("confidence") or ()) & {"torque", "power_loss", "outer_load_mean", "film_parameter_outer"}
    )
    others = (
        "Torque, loads and films do not wait for it: their intervals stand beside them. Take averages of the cage's motion"
        if known
        else "Take averages"
    )
    return (
        "care",
        "The cage's motion still drifts" if drifts else "Too short to tell how the cage moves in the long run",
        f"{turns} were simulated{reason}. {_needed(numbers)}{others} as a first look.",
    )


def _life(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    found = {name: numbers[name] for name in LIVES if numbers.get(name) is not None}
    if not found:
        return None
    best = list(found)[-1]
    shortest = min(found, key=lambda name: found[name])
    hours = found[shortest]
    rest = "; ".join(f"{LIVES[name]} {life_text(found[name])} h" for name in found if name != best)
    said = f"{LIVES[best]}, which counts the most of what acts, is {life_text(found[best])} h{f' ({rest})' if rest else ''}."
    judged = f"It is judged by the shortest, {LIVES[shortest]}: " if len(found) > 1 else ""
    left_out = numbers.get("axial_load_left_out")
    if left_out:
        told = f"No life counts the axial load of {left_out:.4g} N on the ribs: give the maker's e and Y. {said}"
        return "bad" if hours < SHORT_LIFE else "care", "Life, without the axial load", told
    if hours >= USUAL_LIFE:
        return "good", "Life", f"{said} {judged}machines of eight hours a day ask for {USUAL_LIFE:g} h or more."
    if hours >= SHORT_LIFE:
        return (
            "care",
            "Life",
            f"{said} {judged}less than the {USUAL_LIFE:g} h that machines of eight hours a day ask for.",
        )
    return "bad", "Life", f"{said} {judged}less than the {SHORT_LIFE:g} h that even machines for rare use ask for."


def _on_ribs(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    """An axial load on ribs that a maker would not permit."""
    permissible, axial = numbers.get("permissible_axial_load"), max(map(abs, values_of(result.scene.axial_load)))
    if permissible is None or axial <= permissible:
        return None
    return (
        "bad",
        "Axial load on the ribs",
        f"The ribs carry {axial:.4g} N along the axis; a maker permits {permissible:.4g} N at this speed, radial load and "
        "lubrication (trb.rating says by which law).",
    )


def _static(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    safety = numbers.get("static_safety")
    if safety is None or safety >= NORMAL_SAFETY:
        return None
    if safety >= 1.0:
        return "care", "Static safety", f"C0/P0 is {safety:.3g}: ISO 76 requires {NORMAL_SAFETY:g} in normal operation."
    return "bad", "Static safety", f"C0/P0 is {safety:.3g}: below 1 the raceways keep dents (ISO 76)."


def _averages(numbers: dict[str, Any]) -> str:
    return f"Averages are taken from {numbers['window_start']:.4g} to {numbers['window_end']:.4g} s"


def _at(numbers: dict[str, Any], name: str) -> str:
    """When an extreme was, with a space before it."""
    time = numbers.get(f"{name}_time")
    if time is None:
        return ""
    early = time < 1e-3 * (numbers.get("duration") or 0.0)
    return " (at the start)" if early else f" (at {time:.4g} s)"


def _needed(numbers: dict[str, Any]) -> str:
    """How long a run is expected to tell, in a sentence with a space behind it; empty where it is not known."""
    needed, length = numbers.get("settling_needed"), numbers.get("duration")
    if not needed or not length:
        return ""
    highest = numbers.get("settling_needed_to")
    turns = numbers["revolutions"] / length
    wall = numbers.get("wall_s_per_revolution")

    def words(of: Callable[[float], str]) -> str:
        return f"{of(needed)} to {of(highest)}" if highest and of(highest) != of(needed) else of(needed)

    least = "" if highest else "at least "
    cost = f", about {words(lambda t: _time(wall * turns * t))} of computing" if wall and turns else ""
    of_turns = words(lambda t: _two(turns * t))
    return (
        f"A run of {least}{words(_two)} s ({of_turns} turns of the {_ring(numbers)}{cost}) is expected to tell; "
        "trb.cage_answer compares several starts, which often tells sooner, and rollers as they are made. "
    )


def _ring(numbers: dict[str, Any]) -> str:
    """What turns are counted of."""
    return "outer ring" if numbers.get("outer_speed_rpm") and not numbers.get("speed_rpm") else "shaft"


def _two(value: float) -> str:
    """A number with two digits that count, in full."""
    return f"{float(f'{value:.2g}'):g}"


def _time(seconds: float) -> str:
    for size, unit in ((86400.0, "days"), (3600.0, "hours"), (60.0, "minutes")):
        if seconds >= 2.0 * size:
            return f"{_two(seconds / size)} {unit}"
    return f"{_two(seconds)} s"


def _soft(numbers: dict[str, Any]) -> bool | None:
    """Whether the hardest hit is soft; None where it is not known. All sentences on the cage go by this one answer."""
    peak, load = numbers.get("pocket_force_peak"), numbers.get("outer_load_mean")
    return None if peak is None or not load else bool(peak < SOFT_HIT * load)


def _whirl(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    kind = numbers.get("cage_motion")
    if kind is None:
        return None
    grade, headline, sentence = _motion(kind, result, numbers)
    if _settled(numbers) and kind != "unknown":
        return grade, headline, sentence
    so_far = "" if kind == "unknown" else f"So far: {headline[0].lower()}{headline[1:]}. "
    if numbers.get("changing"):
        return (
            "plain",
            "The cage's motion is not judged, as the run changes",
            f"{_averages(numbers)}. {so_far}{sentence}",
        )
    return "plain", "The cage's motion cannot be told yet", f"{so_far}{sentence} {_needed(numbers)}".strip()


def _motion(kind: str, result: Result, numbers: dict[str, Any]) -> Sentence:
    """The motion of the cage as if it had settled."""
    radius, ratio = numbers["axis_distance_over_cpr"], numbers.get("whirl_ratio")
    orbit = numbers["orbit_rms_over_cpr"]
    where = f"on average {radius:.2f} of its radial play Cpr away from the bearing axis"
    if kind == "stable":
        text = f"Its centre stays near one place (it moves by {orbit:.2g} of its radial play Cpr about it), {where}."
        return "good", "The cage does not whirl", text
    if kind == "rocking":
        text = (
            f"Its centre hangs{_place(result, numbers)}, {where}, and moves about that place by {orbit:.2g} Cpr (rms). "
            "It does not go round the bearing axis."
        )
        return ("plain" if _soft(numbers) is False else "good"), "The cage hangs and rocks", text
    if kind == "circling":
        rate = (
            ""
            if ratio is None
            else f", {abs(ratio):.3g} times for each turn of the cage" + (" backwards" if ratio < 0 else "")
        )
        text = (
            f"Its centre goes round in one sense{rate}, on an orbit of {orbit:.2f} Cpr (rms)"
            f"{_within(numbers, 'orbit_rms_over_cpr')}, {where}."
        )
        return "care", "The cage whirls", text
    if kind == "unstable":
        soft = _soft(numbers)
        thrown = {True: " Its hits are soft.", False: " It is thrown from pocket to pocket.", None: ""}[soft]
        text = (
            f"Its centre is {where}; it neither stays on one side of the axis nor goes round it in one sense.{thrown}"
        )
        return ("care" if soft else "bad"), "The cage moves without order", text
    return "plain", "", f"There are fewer than two turns of the cage after the transient. Its centre is {where}."


def _place(result: Result, numbers: dict[str, Any]) -> str:
    """Where the cage hangs, seen from the axis along gravity; empty where nothing pulls across the axis."""
    pull = np.array([value_at(part, 0.0) for part in result.scene.gravity[:2]])
    if not result.scene.effects.gravity or np.hypot(*pull) < 0.1 * GRAVITY or "cage" not in result.groups:
        return ""
    mean = result.window(numbers["window_start"])["cage_position"][:, :2].mean(axis=0)
    across, along = pull[0] * mean[1] - pull[1] * mean[0], float(pull @ mean)
    angle = abs(math.degrees(math.atan2(float(across), along)))
    return " straight below the axis" if angle < STRAIGHT else f" {angle:.0f} deg aside from straight below the axis"


def _hits(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    peak = numbers.get("pocket_force_peak")
    if peak is None:
        return None
    settled = _settled(numbers)
    so_far = "" if settled else " so far"
    if peak == 0.0:
        grade = "good" if settled else "plain"
        return grade, f"No roller touched the cage{so_far}", "No force acted in any pocket."
    weight = result.scene.bearing.cage.mass * GRAVITY
    compared = f"{peak / weight:.3g} times the weight of the cage"
    load = numbers.get("outer_load_mean")
    if load:
        compared += f" and {100.0 * peak / load:.2g} % of the mean load of a roller"
    low, high = numbers.get("pocket_force_peak_low"), numbers.get("pocket_force_peak_high")
    band = (
        f" The load drops and comes back: other starts and accuracies give {low:.2g} to {high:.2g} N."
        if low and high
        else ""
    )
    below, duty = numbers.get("pocket_force_p95"), numbers.get("pocket_duty")
    usual = "" if below is None else f"; while they touch, 95 % of the forces stay below {below:.3g} N"
    often = "" if duty is None else f" A pocket is touched {100.0 * duty:.2g} % of the time."
    return (
        "good" if settled and _soft(numbers) else "plain",
        f"Hits on the cage{so_far}",
        f"The hardest force between a roller and its pocket{so_far} is {peak:.3g} N{_at(numbers, 'pocket_force_peak')}, "
        f"{compared}{usual}.{often}{band}",
    )


def _within(numbers: dict[str, Any], name: str) -> str:
    """How well an average is known, if it is."""
    width = (numbers.get("confidence") or {}).get(name)
    return "" if width is None else f" (± {width:.1g} by its scatter in this run)"


def _torque(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    torque = numbers.get("torque")
    if torque is None:
        return None
    parts = numbers.get("torque_by_loss") or {}
    split = {name: value for name, value in parts.items() if value and name != NOT_LOST}
    part = ""
    if split and torque:
        largest = max(split, key=lambda name: abs(split[name]))
        part = f"; most of it is lost by {largest.replace('_', ' ')}, {split[largest]:.3g} N m"
    power = numbers.get("power_loss")
    heat = "" if power is None else f" The bearing turns {power:.3g} W into heat."
    outer, note = numbers.get("torque_outer"), numbers.get("torque_note")
    other = f" The outer ring carries {outer:.3g} N m: {note}." if outer is not None and note else ""
    laws = torque_laws(result.scene)
    open_law = (
        f" It depends on the law of rolling resistance: {laws.words(torque, torque)}." if laws is not None else ""
    )
    return (
        "plain",
        "Torque",
        f"The shaft has to overcome {torque:.3g} N m of friction{_within(numbers, 'torque')}{part}.{other}{open_law}{heat}",
    )


def _films(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    values = {
        name: numbers[f"film_parameter_{side}"]
        for side, name in contacts().items()
        if numbers.get(f"film_parameter_{side}")
    }
    if not values or not result.scene.effects.films:
        return None
    thinnest = min(values, key=lambda name: values[name])
    value, mean = values[thinnest], values[thinnest]
    number = f"The mean film parameter (film thickness over roughness) is smallest at the {thinnest}: {value:.3g}."
    if numbers.get("changing"):
        least = {
            (name, side): numbers[f"film_parameter_{side}_min"]
            for side, name in contacts().items()
            if numbers.get(f"film_parameter_{side}_min") is not None
        }
        if least:
            (thinnest, side), value = min(least.items(), key=lambda one: one[1])
            when = _at(numbers, f"film_parameter_{side}_min")
            least_said = (
                f"The film parameter (film thickness over roughness) is smallest at the {thinnest}: {value:.3g}{when}."
            )
            number = f"{least_said} {number}"
    elif not _whole_turn(numbers):
        return _too_short("Films", number)
    full = result.scene.effects.friction.lambda_full
    if value >= full:
        return "good", "Films keep the surfaces apart", f"{number} From {full:.3g} on, the film carries all."
    if value >= MIXED_FILM:
        return (
            "care",
            "Films carry, with some contact",
            f"{number} Below {full:.3g} the highest asperities touch and add boundary friction.",
        )
    if mean >= full:
        return (
            "care",
            "Films are thin for a while",
            f"{number} Below {MIXED_FILM:.3g} asperities carry a part of the load.",
        )
    return (
        "bad",
        "Films are too thin",
        f"{number} Below {min(MIXED_FILM, full):.3g} asperities carry a part of the load: "
        "wear and early fatigue are to be expected.",
    )


def _whole_turn(numbers: dict[str, Any]) -> bool:
    """Whether the averages hold one turn of the rollers around the bearing, so that each was in the loaded zone."""
    ratio = numbers.get("cage_speed_ratio_kinematic") or 0.4
    seconds = (numbers.get("window_end") or 0.0) - (numbers.get("window_start") or 0.0)
    turning = numbers.get("speed_rpm") or numbers.get("outer_speed_rpm") or 0.0
    return bool(abs(turning * ratio) / 60.0 * seconds >= 0.99)


def _too_short(headline: str, number: str) -> Sentence:
    text = f"{number} It is not judged: the averages hold less than one turn of the rollers around the bearing."
    return "plain", f"{headline}: cannot be told yet", text


def _pressure(result: Result, numbers: dict[str, Any]) -> Sentence | None:
    found = {
        (name, side): numbers[f"{side}_pressure_max"]
        for side, name in contacts().items()
        if numbers.get(f"{side}_pressure_max")
    }
    if not found:
        return None
    (where, side), value = max(found.items(), key=lambda one: one[1])
    when = _at(numbers, f"{side}_pressure_max")
    number = f"The largest pressure of the run, {1e-9 * value:.3g} GPa, is at the {where}{when}."
    if value < FATIGUE_LIMIT and not _whole_turn(numbers):
        return _too_short("Pressures", number)
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
    return None if closure is None else _of_energy(closure)


def _of_energy(closure: float) -> Sentence | None:
    if not math.isfinite(closure):
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
    preset = estimate.preset_of(result)
    if preset is None:
        return (
            "plain",
            "Accuracy",
            "Tolerances of your own: no error was measured for them. Compare with a run at 'reference'.",
        )
    measured = estimate.table()["presets"][preset]
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
    out = list(dict.fromkeys(str(note) for note in (*(result.meta.get("notes") or ()), *result.warnings)))
    if estimated:
        out.append(
            f"{estimated} inputs are estimated from the catalogue's numbers, see the table of inputs; trb.sensitivity shows "
            "which of them matter."
        )
    if assumed:
        out.append(
            f"{assumed} inputs are assumed by the package because no source gives them, see the table of inputs."
        )
    if (straight := straight_rollers(result.scene)) is not None:
        torque, pressure = straight
        both = "" if torque is None else f"the torque would be {torque:.2g} and "
        out.append(
            f"Nobody gave the profile of the rollers; it is that of ISO/TS 16281. With straight rollers {both}the largest "
            f"pressure would be {pressure:.2g} times as large."
        )
    out += edge_warnings(result)
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
        out.append(f"The run is short: {numbers['revolutions']:.3g} turns of the {_ring(numbers)}.")
    return out
