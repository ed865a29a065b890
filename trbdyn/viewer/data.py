"""What the 3-D view shows of a result: a thinned record of the motion, and numbers for colours, arrows and histories.

Angles are stored unwrapped and relative to the cage, so that the motion between two frames can be interpolated however
far they lie apart. Forces in the pockets are stored as the largest since the frame before: thinning hides no hit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError
from trbdyn.model.motion import value_at
from trbdyn.results.conditions import ranges, spoken
from trbdyn.results.fields import carrying, contacts
from trbdyn.results.result import Result
from trbdyn.run.replay import Replay
from trbdyn.run.simulation import Simulation

Array = NDArray[np.float64]

MAX_STATIONS: Final = 24
NEEDED: Final = ("cage", "rollers")


@dataclass(frozen=True)
class Quantity:
    """Something that can be coloured, and plotted for a roller or a pocket face."""

    name: str
    label: str  # words
    unit: str  # of the values as shown
    values: Array  # by frame, shape (n, Z), (n, Z, slots) or (n, Z, stations)
    kind: str = "roller"  # what the second and third axis are: 'roller', 'pocket' or 'station'
    note: str = "at the moment shown"  # what a value is between two frames


@dataclass(frozen=True)
class Frames:
    """A thinned record."""

    index: NDArray[np.int64]  # records that were taken, shape (n,)
    total: int  # records that the shown part of the run has
    time: Array  # (s), shape (n,)
    turns: Array  # of the shaft, shape (n,)
    pose: dict[str, Array]
    """Scalars, shape (n,): shaft, cage_angle (rad), cage_x, cage_y, cage_z (m), cage_tilt_x, cage_tilt_y (rad),
    ring_x, ring_y, ring_z (m), ring_tilt_x, ring_tilt_y (rad), cup_x and so on of the outer ring; of the rollers,
    shape (n, Z): psi (rad, against their place in an even spacing that turns with the cage), r, z (m, against
    nominal), skew, tilt, spin (rad)."""
    quantities: tuple[Quantity, ...] = field(default=())  # what can be coloured and plotted


def frames(result: Result, *, revolutions: float | None, max_frames: int, along: bool = True) -> Frames:
    """At most so many frames, evenly spread over the last turns of the shaft (all of them for None), with the pressure along
    the rollers if `along`. It needs the groups of `NEEDED`; forces, films and slip are there if contacts and pocket were
    recorded.
    """
    from trbdyn.plot.cage import last_turns

    check(result, revolutions, max_frames)
    shown = last_turns(result, revolutions)
    if len(shown) < 2:
        raise InputError.of("revolutions", revolutions, "must hold at least two records")
    first = len(result) - len(shown)
    index = np.unique(np.linspace(first, len(result) - 1, min(max_frames, len(shown))).round().astype(np.int64))
    pose = _pose(result, index)
    quantities = _quantities(result, index, pose)
    if along:
        quantities.append(_along(result, index))
    time, turns = result["time"][index], np.abs(result.turned[index]) / (2.0 * np.pi)
    return Frames(index, len(shown), time, turns, pose, tuple(quantities))


def check(result: Result, revolutions: float | None, max_frames: int) -> None:
    """Refuse what cannot be shown."""
    for group in NEEDED:
        if group not in result.groups:
            raise InputError.of(
                "result", f"groups {', '.join(result.groups)}", f"must have the recorded group {group!r} to be shown"
            )
    if len(result) < 2:
        raise InputError.of("result", len(result), "must have at least two records to be shown")
    if revolutions is not None and not (isinstance(revolutions, int | float) and 0.0 < revolutions < math.inf):
        raise InputError.of("revolutions", revolutions, "must be > 0, or None for the whole run (1)")
    if not isinstance(max_frames, int) or isinstance(max_frames, bool) or not 2 <= max_frames <= 100_000:
        raise InputError.of("max_frames", max_frames, "must be a whole number from 2 to 100000 (1)")


def _pose(result: Result, index: NDArray[np.int64]) -> dict[str, Array]:
    bearing, geometry = result.scene.bearing, result.scene.bearing.geometry
    count = bearing.n_rollers
    orbit, position = result["roller_orbit_angle"][index], result["roller_position"][index]
    even, still = 2.0 * np.pi * np.arange(count) / count, np.zeros((index.size, 3))
    if result.has_cage:
        angle, place, tilt = result["cage_angle"][index], result["cage_position"][index], result["cage_tilt"][index]
    else:
        angle = (orbit - even).mean(axis=1)
        place, tilt = still, still[:, :2]
    bodies = [("cage", place, tilt), ("ring", still, _ring_tilt(result, index)), ("cup", still, still[:, :2])]
    if "ring_position" in result:
        bodies[1] = ("ring", result["ring_position"][index], bodies[1][2])
    if result.housing_moves and "housing_position" in result:
        bodies[2] = ("cup", result["housing_position"][index], result["housing_tilt"][index])
    pose = {
        "shaft": result["shaft_angle"][index],
        "cage_angle": angle,
        **{f"{body}_{axis}": at[:, k] for body, at, _ in bodies for k, axis in enumerate("xyz")},
        **{f"{body}_tilt_{axis}": leans[:, k] for body, _, leans in bodies for k, axis in enumerate("xy")},
        "psi": orbit - angle[:, None] - even,
        "r": np.hypot(position[..., 0], position[..., 1]) - geometry.roller_centre_radius,
        "z": position[..., 2] - geometry.roller_centre_height,
        "skew": result["roller_skew"][index],
        "tilt": result["roller_tilt"][index],
        "spin": _spin(result)[index],
    }
    return {name: np.asarray(values, dtype=float) for name, values in pose.items()}


def _spin(result: Result) -> Array:
    """Angle by which each roller has turned about its own axis against its orbit, unwrapped (rad), shape (T, Z)."""
    time, speed = result["time"], result["roller_spin_speed"]
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(time)[:, None]
    return np.vstack([np.zeros((1, speed.shape[1])), np.cumsum(steps, axis=0)])


def _ring_tilt(result: Result, index: NDArray[np.int64]) -> Array:
    """Rotation of the inner ring about x and y (rad): as it moved, as prescribed, or from the equilibrium at the start."""
    scene = result.scene
    if result.ring_moves and "ring_tilt" in result:
        return result["ring_tilt"][index]
    if scene.moments != (None, None):
        return np.broadcast_to(Simulation(scene).equilibrium.displacement[3:5], (index.size, 2))
    turns = (scene.misalignment_x, scene.misalignment_y)
    time = result["time"][index]
    return np.array([[value_at(turn, float(when)) for turn in turns] for when in time])


_CONTACTS: Final = (
    ("load", "load on", "N", 1.0),
    ("pressure", "largest pressure at", "GPa", 1e-9),
    ("film", "film thickness at", "µm", 1e6),
    ("film_parameter", "film parameter Λ at", "1", 1.0),
    ("slide_roll", "slide-roll ratio at", "1", 1.0),
)


def _quantities(result: Result, index: NDArray[np.int64], pose: dict[str, Array]) -> list[Quantity]:
    out = []
    for side in carrying(result):
        out += [
            Quantity(
                f"{side}_{name}", f"{words} the {contacts()[side]}", unit, factor * result[f"{side}_{name}"][index]
            )
            for name, words, unit, factor in _CONTACTS
            if f"{side}_{name}" in result
        ]
    if "pocket" in result.groups and result.has_cage:
        held = largest_between(result["pocket_force"], index)
        out.append(
            Quantity("pocket_force", "force in the pocket", "N", held, "pocket", "largest since the frame before")
        )
    slip = 100.0 * result.roller_slip[index]
    out.append(Quantity("slip", "slip of the roller's orbit against pure rolling", "%", slip))
    for name, label in (("skew", "skew"), ("tilt", "tilt")):
        out.append(Quantity(name, label, "mrad", 1e3 * pose[name]))
    return [quantity for quantity in out if np.isfinite(quantity.values).all()]  # slip is none where the shaft stands


def largest_between(values: Array, index: NDArray[np.int64]) -> Array:
    """The largest of each value since the frame before, shape (n, ...), in records of shape (T, ...); at the first frame the
    value itself.
    """
    starts = np.concatenate([index[:1], index[:-1] + 1])
    parts = values[: index[-1] + 1]
    return np.maximum.reduceat(parts, starts, axis=0)


def _along(result: Result, index: NDArray[np.int64]) -> Quantity:
    """Pressure along the rollers at both raceways, evaluated again by the core: the larger of both."""
    replay = Replay(result)
    keep = _kept(replay)
    rows = [replay.contacts(int(k))["raceway_pressure"].max(axis=0)[:, keep] for k in index]
    values = 1e-9 * np.array(rows)
    return Quantity("pressure_along", "pressure along the roller, larger of both raceways", "GPa", values, "station")


def stations(result: Result) -> Array:
    """Places of the values of ``pressure_along`` along the roller (m)."""
    replay = Replay(result)
    return replay.stations[_kept(replay)]


def _kept(replay: Replay) -> NDArray[np.int64]:
    count = replay.stations.size
    return np.unique(np.linspace(0, count - 1, min(MAX_STATIONS, count)).round().astype(np.int64))


def default_factor(result: Result, largest: float) -> float:
    """A factor of exaggeration that draws the cage's radial play as about a fifth of a roller's diameter: 1, 2, 5, 10,
    20, ...
    """
    bearing = result.scene.bearing
    wish = min(0.2 * bearing.roller.diameter / bearing.cage.play_radial, largest)
    steps = [base * 10**power for power in range(3) for base in (1, 2, 5)]
    return float(max([step for step in steps if step <= wish], default=1))


def facts(result: Result) -> dict[str, Any]:
    """Words and numbers for the head of the view."""
    scene, found = result.scene, ranges(result)
    loads = []
    on_shaft = "assembly" in result.meta and "ring" in result.groups
    for label, load in zip(("mean Fa", "mean Fr"), result.ring_loads if on_shaft else (), strict=False):
        loads.append(f"{label} {float(load.mean()):.4g} N")
    for label in () if on_shaft else ("Fa", "Fr"):
        if label in found:
            loads.append(f"{label} {spoken(found[label])} N")
    turning = np.abs(result.turning_speed) * 30.0 / np.pi
    return {
        "bearing": scene.bearing.name,
        "speed_rpm": float(turning.mean()),
        "speed": spoken((float(turning.min()), float(turning.max()))),
        "turning": scene.turning_ring,
        "loads": ", ".join(loads),
    }
