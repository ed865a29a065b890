"""Numbers of torque, power and energy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from trbdyn.model.lubricants import TEMPERATURES
from trbdyn.results import notes
from trbdyn.results.number import Number, Seen

if TYPE_CHECKING:
    from trbdyn.results.records import Records


def shaft_torque(window: Records) -> float:
    """Mean friction torque of the shaft (N m): the work of both rings' drives over the turn between the rings, which records
    between impacts do not alias.

    The mean of the records where the work was not recorded, or is not that of friction alone: where the rings do not turn against
    each other in one direction, a torque turns the shaft, or other bearings sit on it.
    """
    speed = window.rolling_speed
    if window.scene.torque is not None or window.on_shaft:
        return float(window["inner_torque"].mean())
    one_way = bool(np.all(speed > 0.0) or np.all(speed < 0.0))
    if "energy" not in window.groups or not one_way or len(window) < 2:
        return float(window["inner_torque"].mean())
    rolled = window.rolled
    return float((window["work_shaft"][-1] - window["work_shaft"][0]) / abs(rolled[-1] - rolled[0]))


def mean_loss(window: Records) -> float:
    """Mean power loss (W): energy lost over time, which records between impacts do not alias; of the records without it."""
    if "energy" not in window.groups or len(window) < 2:
        return float(window["power_loss"].mean())
    losses = [field.name for field in window.fields if field.name.startswith("loss_")]
    time = window["time"]
    return float(sum(window[name][-1] - window[name][0] for name in losses) / (time[-1] - time[0]))


def _torque_outer(seen: Seen) -> float:
    return float(seen.window["outer_torque"].mean())


def _torque_note(seen: Seen) -> str | None:
    return notes.torque_note(seen.window, shaft_torque(seen.window), _torque_outer(seen))


def _drag_share(seen: Seen) -> float | None:
    lost = sum(seen.power_split.values())
    return seen.power_split.get("drag", 0.0) / lost if lost > 0.0 else None


def _oil_temperature(seen: Seen) -> str:
    oil = seen.run.scene.lubricant
    cooler, warmer, words = TEMPERATURES[oil.temperature_of]
    return f"{oil.temperature_c:g} C {words.partition(':')[0]}, films from {cooler:+g} to {warmer:+g} K"


def torque_by_loss(window: Records) -> dict[str, float]:
    """Torque of the shaft by what loses it (N m), and as 'not lost' what is left to the torque: energy that parts store or give
    back meanwhile, work of loads, and what records between impacts miss.
    """
    found = dict(window.torque_by_loss)
    if found and "torque" in window.groups:
        torque = shaft_torque(window)
        left = torque - sum(found.values())
        if abs(left) > DUST * abs(torque):
            found[NOT_LOST] = left
    return found


def torque_by_force(window: Records) -> dict[str, float]:
    """Mean torque of each force on the inner ring (N m), and as 'between records' what is left to the torque."""
    found = dict(window.torque_split)
    torque = shaft_torque(window)
    left = torque - sum(found.values())
    if abs(left) > DUST * abs(torque):
        found[BETWEEN] = left
    return found


def has_drag(seen: Seen) -> bool:
    return seen.run.scene.effects.oil_fill > 0.0


NOT_LOST: Final = "not_lost"
BETWEEN: Final = "between_records"
"""Entries of what is left of a torque beside its parts."""
DUST: Final = 1e-9
"""Share of a torque below which its parts are the whole."""
LOST: Final = ("power|energy",)
"""Groups of records that tell what is lost."""

TORQUES: Final = (
    Number(
        "torque",
        "friction torque of the shaft",
        "N m",
        "Friction torque that the shaft has to overcome.",
        lambda seen: shaft_torque(seen.window),
        groups=("torque",),
        interval="loss",
        together="sum",
        shown=frozenset({"result", "report", "shaft", "sweep", "page", "band", "ensemble"}),
        pictures=("torque_split",),
        checked=True,
    ),
    Number(
        "torque_outer",
        "friction torque on the outer ring",
        "N m",
        "Friction torque that the outer ring passes on to the housing.",
        _torque_outer,
        groups=("torque",),
        interval="loss",
    ),
    Number(
        "drag_share",
        "share of the oil's drag in the torque",
        "",
        "Drag of the oil round the rollers; 0 where `effects.oil_fill` is 0, as by default: then no drag is counted.",
        _drag_share,
        groups=LOST,
        exists=has_drag,
    ),
    Number(
        "power_loss",
        "power loss",
        "W",
        "Heat that the bearing makes.",
        lambda seen: mean_loss(seen.window),
        groups=LOST,
        interval="loss",
        together="sum",
        shown=frozenset({"result", "report", "shaft", "page"}),
        pictures=("power_split",),
        checked=True,
    ),
    Number(
        "energy_closure",
        "energy audit: residual / dissipated work",
        "",
        "Energy that does not add up, over the dissipated work: below 0.001 is good, above 0.01 too much.",
        lambda seen: seen.audit.closure,
        "state",
        "run",
        groups=("energy",),
        shown=frozenset({"result", "shaft"}),
        pictures=("energy_audit",),
    ),
    Number(
        "energy_residual",
        "energy audit: residual",
        "J",
        "Error of the energy balance.",
        lambda seen: seen.audit.residual,
        "state",
        "run",
        groups=("energy",),
        pictures=("energy_audit",),
    ),
)
"""Rows of torque, power loss and energy."""

NOTES: Final = (
    Number(
        "oil_temperature_note",
        "Temperature that was given for the oil",
        "",
        "What `lubricant.temperature_c` was measured on (`temperature_of`), and how far films may be from it: films of the run "
        "have this temperature, those of `trbdyn.uncertainty` the whole band.",
        _oil_temperature,
        "words",
        "run",
        exists=lambda seen: seen.run.scene.effects.films and seen.run.scene.lubricant.oil is not None,
    ),
    Number(
        "torque_note",
        "Why the torques of the rings differ",
        "",
        "Why the two rings have different torques.",
        _torque_note,
        "words",
        groups=("torque",),
    ),
    Number(
        "rolling_note",
        "About rolling resistance",
        "",
        "Whether the law of rolling resistance was made for these loads and this tilt.",
        lambda seen: notes.rolling_note(seen.window),
        "words",
        groups=("torque",),
    ),
)
"""Rows of what is said of the torques."""

SPLITS: Final = (
    Number(
        "power_split",
        "power loss by mechanism",
        "W",
        "Share of each kind in the power loss.",
        lambda seen: seen.power_split,
        "table",
        groups=LOST,
    ),
    Number(
        "torque_by_loss",
        "the same as friction torque of the shaft",
        "N m",
        "The shaft's torque by what loses it; not lost: what parts store meanwhile, works on loads, or falls between records.",
        lambda seen: torque_by_loss(seen.window),
        "table",
        groups=LOST,
        together="sum",
    ),
    Number(
        "torque_split",
        "forces on the inner ring that make this torque",
        "N m",
        "Forces on the inner ring that make the shaft's torque, at the records; what falls between them.",
        lambda seen: torque_by_force(seen.window),
        "table",
        groups=("torque",),
    ),
)
"""Rows of torque and power by their parts.

A force on the inner ring that makes torque need not lose power: traction passes on what rolling resistance takes at the outer
raceway. So the shares of ``torque_split`` differ from those of ``torque_by_loss``.
"""
