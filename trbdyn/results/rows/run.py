"""Numbers of the run itself: how it ended, its window, its speeds, its cost, and what is said of its numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.results import conditions
from trbdyn.results.number import Number, Seen

if TYPE_CHECKING:
    from trbdyn.results.observables import MotionSettling

FOLLOWED: Final = math.sqrt(3.0 * 0.01)
"""Phase of a vibration in a step by which BDF of order 2 lowers its frequency by 1 % (rad).

For y' = i w y its formula, whose root is exp(l) with l = i w h + l^3 / 3 - l^4 / 4 + ..., lowers the frequency by the share
(w h)^2 / 3 and takes the share pi (w h)^3 / 2 of the amplitude in a period, to leading order in the step h: 0.8 % here.
"""


def _followed(seen: Seen) -> float | None:
    """Frequency (Hz) up to which vibrations keep their frequency within 1 %, from the mean step; None for another method."""
    settings, step = seen.run.meta.get("settings"), seen.run.stats.get("mean_step_s") or math.nan
    if not isinstance(settings, Mapping) or settings.get("max_order", 2) > 2:
        return None
    kind = settings.get("integrator", "bdf")
    if kind == "multirate":
        # of the bodies, whose steps differ
        steps, of_bodies = (seen.run.stats.get(name) or math.nan for name in ("steps", "body_steps"))
        step *= steps * (seen.run.scene.bearing.n_rollers + 1) / of_bodies
    return FOLLOWED / (2.0 * math.pi * step) if kind in ("bdf", "multirate") else None


def _wall_of_turn(seen: Seen) -> float | None:
    """Wall time of stepping for a turn where the statistics tell it, else the whole wall time over the turns."""
    stats, turns = seen.run.stats, seen.run.revolutions
    own, wall = stats.get("wall_s_per_revolution"), stats.get("wall_s")
    if not math.isfinite(own or math.nan) and wall is not None and turns:
        return wall / turns
    return own


def _of_settling(take: Callable[[MotionSettling], Any]) -> Callable[[Seen], Any]:
    return lambda seen: None if seen.settling is None else take(seen.settling)


def outer_turns(seen: Seen) -> bool:
    return seen.run.scene.outer_turns


def on_shaft(seen: Seen) -> bool:
    return seen.run.on_shaft


def _mean_load(place: int) -> Callable[[Seen], float]:
    return lambda seen: float(seen.window.ring_loads[place].mean())


def _stats(name: str, words: str, meaning: str, unit: str = "") -> Number:
    return Number(name, words, unit, meaning, lambda seen: seen.run.stats.get(name), "count", "run")


BEGIN: Final = (
    Number(
        "success",
        "finished",
        "",
        "Whether the run reached its end.",
        lambda seen: seen.run.success,
        "state",
        "run",
        together="same",
    ),
    Number(
        "message",
        "how it ended",
        "",
        "How it ended.",
        lambda seen: seen.run.message,
        "words",
        "run",
        together="same",
    ),
    Number(
        "revolutions",
        "revolutions of the shaft, or of the outer ring where the shaft rests",
        "",
        "Turns of the shaft, or of the outer ring where the shaft rests, from the first to the last record.",
        lambda seen: seen.run.revolutions,
        "count",
        "run",
        together="same",
    ),
    Number(
        "duration",
        "bearing time",
        "s",
        "Time that passed in the bearing.",
        lambda seen: seen.run.duration,
        "count",
        "run",
        together="same",
    ),
    Number(
        "settled",
        "settled",
        "",
        "Whether the motion has stopped to drift.",
        lambda seen: seen.settled,
        "state",
        groups=("time",),
        printed=False,
    ),
    Number(
        "settling",
        "settling: settled, drifting or unknown",
        "",
        "Settled, still drifting, or not to be told from this record.",
        lambda seen: "unknown" if seen.settling is None else seen.settling.answer,
        "words",
        groups=("time",),
        shown=frozenset({"result", "sweep", "page"}),
        source="docs/theory/whirl.md",
    ),
    Number(
        "settling_reason",
        "why it is not known to have settled",
        "",
        "Why it is not known.",
        lambda seen: seen.settling_reason or None,
        "words",
        groups=("time",),
        printed=False,
    ),
    Number(
        "settling_time_scale",
        "time scale of the drift",
        "s",
        "How fast it drifts.",
        _of_settling(lambda found: found.time_scale),
        "time",
        printed=False,
    ),
    Number(
        "settling_needed",
        "least length of a run expected to tell",
        "s",
        "At least so long a run is needed to tell whether its motion has settled.",
        _of_settling(lambda found: found.needed),
        "time",
    ),
    Number(
        "settling_needed_to",
        "largest length of a run expected to tell",
        "s",
        "At most so long a run is expected to be needed for it, where that is known.",
        _of_settling(lambda found: found.needed_high),
        "time",
    ),
    Number(
        "creep_time",
        "time of the rollers' creep",
        "s",
        "Time in which creep of the rollers lets the whirl change by its own size.",
        _of_settling(lambda found: found.creep_time),
        "time",
    ),
    Number(
        "window_start",
        "averages from",
        "s",
        "Averages are taken from this time on.",
        lambda seen: float(seen.window["time"][0]),
        "time",
    ),
    Number(
        "window_end",
        "averages to",
        "s",
        "Averages are taken up to this time.",
        lambda seen: float(seen.window["time"][-1]),
        "time",
    ),
    Number(
        "changing",
        "what changes in the run",
        "",
        "Speeds and loads that change: averages hold for their window alone.",
        lambda seen: conditions.words(seen.run),
        "words",
        groups=("time",),
    ),
    Number(
        "speed_rpm",
        "shaft speed",
        "rpm",
        "Mean speed of the inner ring over the window of the averages.",
        lambda seen: float(seen.window["shaft_speed"].mean()) * 30.0 / np.pi,
        shown=frozenset({"result"}),
    ),
    Number(
        "outer_speed_rpm",
        "outer ring's speed",
        "rpm",
        "Mean speed of an outer ring that turns.",
        lambda seen: float(seen.window.outer_speed.mean()) * 30.0 / np.pi,
        exists=outer_turns,
    ),
    Number(
        "axial_load",
        "axial load of the shaft on the bearing, mean",
        "N",
        "Mean axial load that the inner ring carries, towards the small ends of the rollers.",
        _mean_load(0),
        groups=("ring",),
        exists=on_shaft,
        shown=frozenset({"shaft"}),
        pictures=("bearing_loads",),
    ),
    Number(
        "radial_load",
        "radial load of the shaft on the bearing, mean",
        "N",
        "Mean size of the radial load that the inner ring carries.",
        _mean_load(1),
        groups=("ring",),
        exists=on_shaft,
        shown=frozenset({"shaft"}),
        pictures=("bearing_loads",),
    ),
)
"""Rows of how the run went and what its averages are of."""

COST: Final = (
    _stats("steps", "steps", "Steps of the integrator."),
    _stats("rhs_evaluations", "evaluations of the equations of motion", "How often all forces were computed."),
    Number(
        "followed_frequency",
        "vibrations are followed up to",
        "Hz",
        "Vibrations up to this frequency keep it within 1 %; steps slow and damp faster ones. Smaller tolerances, or max_step, "
        "raise it; trb.stiffness(scene).modes(body) gives the natural frequencies of a shaft.",
        _followed,
        "state",
        "run",
    ),
    _stats("wall_s", "wall time", "Computing time.", "s"),
    Number(
        "wall_s_per_revolution",
        "wall time a revolution",
        "s",
        "Computing time for a turn of the shaft.",
        _wall_of_turn,
        "count",
        "run",
    ),
)
"""Rows of what the run took."""

SAID: Final = (
    Number(
        "confidence_note",
        "About the numbers behind ±",
        "",
        "How the numbers behind ± were found: the true mean lies within in 95 of 100 cases.",
        lambda seen: seen.intervals[1],
        "words",
        groups=("time",),
    ),
    Number(
        "confidence",
        "half width of the 95 % confidence interval",
        "",
        "Half width of the interval that holds the true mean in 95 of 100 cases.",
        lambda seen: seen.intervals[0],
        "table",
        groups=("time",),
        printed=False,
    ),
)
"""Rows of what is said of the numbers."""
