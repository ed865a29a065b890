"""What a sheet of ratings stands on: loads of a bearing, and of the laminas of its contacts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError, LoadError
from trbdyn.model.contact_line import line_length, stations
from trbdyn.model.motion import History, is_constant, value_at, values_of
from trbdyn.model.scene import Scene
from trbdyn.standards import lamina
from trbdyn.standards.iso281 import LIFE_EXPONENT
from trbdyn.statics.contacts_at_start import contacts_at_start
from trbdyn.statics.equilibrium import most_radial_load

Array = NDArray[np.float64]

DIRECTIONS: Final = 72
"""Directions of a load that rotates over which the load of a bearing is averaged."""
HELD_BY: Final = 1.25
"""Axial load over Fr tan(alpha) below which an equilibrium of a tapered bearing may be missing: half of the rollers loaded have
0.5 Fr/Y (ISO 281)."""


@dataclass(frozen=True)
class Loading:
    """What a sheet stands on."""

    axial_load: float  # mean (N)
    radial_load: float  # mean (N)
    speed_rpm: float  # mean of the inner ring against the outer ring, on which lives and films depend (rpm)
    lamina_loads: (
        Array | None
    )  # at the outer and the inner ring (N), see `lamina.LaminaLoads`, shape (2, Z, n_s); None: not known
    largest_pressure: float  # largest pressure on a raceway (Pa)
    source: str  # of what, in words; why there are no loads of laminas where these are not known
    equivalent_load: float | None = None  # steady P with the same life where loads change (N)
    moments: tuple[tuple[float, float], ...] = ()
    """Axial and radial loads (N) at moments of a run: the heaviest makes the static safety."""
    largest_speed_rpm: float | None = None  # where it is not the mean (rpm)
    said: tuple[str, ...] = ()  # what an engineer must know of these loads


def lamina_loads(scene: Scene, contacts: dict[str, Array]) -> Array:
    """Loads of the laminas (N), shape (2, Z, n_s), of the contacts of a scene, as `Simulation.contacts` gives them."""
    per_length, weight = contacts["raceway_load_per_length"], contacts["raceway_weight"]
    load = np.sum(per_length * weight, axis=-1)
    length = scene.bearing.roller.effective_length
    return lamina.in_laminas(per_length, stations(scene), load, length, line_length(scene))


def ring_loads(scene: Scene, loads: Array, angles: Array) -> tuple[float, float]:
    """Axial and radial load (N) that the outer raceway carries by these loads of its rollers (N) at these angles (rad)."""
    slope = math.radians(scene.bearing.cup_half_angle_deg)
    radial = np.array([np.sum(loads * np.cos(angles)), np.sum(loads * np.sin(angles))]) * math.cos(slope)
    return float(np.sum(loads) * math.sin(slope)), float(np.hypot(*radial))


def values(quantity: float | History, times: Array) -> Array:
    """A quantity at times (s), shape (T,)."""
    return quantity.value(times) if isinstance(quantity, History) else np.full(times.shape, float(quantity))


def applied_loads(scene: Scene, times: Array) -> tuple[Array, Array, Array]:
    """Axial load, radial load and the largest radial load of a turn (N) that a scene prescribes at times (s), shapes (T,): with
    the weight of a body on the ring, and a load that rotates. Where one rotates, the radial load is the steady one with the same
    life: the mean of its 10/3rd power over all directions.
    """
    direction = np.radians(values(scene.radial_direction_deg, times))
    radial = values(scene.radial_load or 0.0, times)
    force = np.array([radial * np.cos(direction), radial * np.sin(direction), -values(scene.axial_load or 0.0, times)])
    if scene.ring_body is not None and scene.effects.gravity:
        force += scene.ring_body.mass * np.array([values(part, times) for part in scene.gravity])
    steady = np.hypot(force[0], force[1])
    if scene.rotating_load is None:
        return np.abs(force[2]), steady, steady
    size = np.abs(values(scene.rotating_load.load, times))
    turned = np.exp(2j * math.pi * np.arange(DIRECTIONS) / DIRECTIONS)
    each = np.abs(steady[:, None] + size[:, None] * turned)
    mean = np.mean(each**LIFE_EXPONENT, axis=1) ** (1.0 / LIFE_EXPONENT)
    return np.abs(force[2]), mean, steady + size


def at_equilibrium(scene: Scene) -> Loading:
    """Loads of the equilibrium at the scene's start. A load that a tapered bearing cannot hold by itself has none of laminas."""
    start = scene.start.time
    x, y, z, *_ = scene.ring_is_placed
    axial, radial, largest = (float(one[0]) for one in applied_loads(scene, np.array([start])))
    said = changes(scene.ring_quantities(), start)
    still = scene.replace(start=scene.start.replace(kind="equal")) if scene.start.kind != "state" else scene
    try:
        contacts = contacts_at_start(still)
    except (InputError, LoadError):
        if x or y or not _beyond(scene, axial, largest):
            raise
        reason = f"no equilibrium: an axial load of {axial:.4g} N holds no radial load of {radial:.4g} N in this bearing alone"
        told = (
            f"{reason}, a second bearing must give it more: lives are those of ISO 281, from P alone, and there are no reference "
            "lives; rate both bearings as an Assembly"
        )
        return Loading(axial, radial, scene.rolling_rpm(start), None, 0.0, reason, said=(told, *said))
    loads = lamina_loads(scene, contacts)
    even = 2.0 * math.pi * np.arange(loads.shape[1]) / loads.shape[1]
    carried = ring_loads(scene, loads[0].sum(axis=-1), even)
    axial, radial = carried[0] if z else axial, carried[1] if x or y else radial
    return Loading(
        axial_load=axial,
        radial_load=radial,
        speed_rpm=scene.rolling_rpm(start),
        lamina_loads=loads,
        largest_pressure=float(np.max(contacts["raceway_pressure"])),
        source="equilibrium at the start",
        moments=((axial, largest),) if scene.rotating_load is not None and not (x or y) else (),
        said=said,
    )


def _beyond(scene: Scene, axial: float, radial: float) -> bool:
    """Whether a radial load is more than a tapered bearing holds by itself, or nearly so."""
    if scene.bearing.is_cylindrical or scene.ring_is_placed[2] or not radial > 0.0:
        return False
    if any(value_at(one or 0.0, scene.start.time) for one in scene.moments):
        return False
    return radial * HELD_BY > most_radial_load(scene, axial, scene.start.time)


def changes(quantities: Mapping[str, float | History], time: float) -> tuple[str, ...]:
    """That loads at a time (s) are not those of the whole, where some of the quantities change."""
    changing = [name for name, one in quantities.items() if not is_constant(one)]
    if not changing:
        return ()
    return (
        f"{', '.join(changing)} change: this sheet is of the loads at {time:.4g} s alone; rate the result of a run, or a "
        "trb.spectrum of its load cases",
    )


def turning_against_load(scene: Scene) -> tuple[bool, bool]:
    """Whether the outer, and whether the inner ring turns against the larger one of both loads, which may rotate itself; by the
    largest values of what changes.
    """
    rotating = scene.rotating_load
    inner, outer = (_largest(speed) for speed in (scene.speed_rpm, scene.outer_speed_rpm))
    load = 0.0
    if rotating is not None and abs(_largest(rotating.load)) > abs(_largest(scene.radial_load or 0.0)):
        load = rotating.turns * inner if rotating.frequency_hz is None else 60.0 * rotating.frequency_hz
    turning = tuple(not math.isclose(speed, load, rel_tol=1e-9, abs_tol=1e-9) for speed in (outer, inner))
    return (turning[0], turning[1]) if any(turning) else (False, True)


def _largest(quantity: float | History) -> float:
    return max(values_of(quantity), key=abs)
