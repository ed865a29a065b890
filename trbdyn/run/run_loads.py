"""What a bearing carries within a run: stretches of time, each with its loads and a record whose laminas stand for it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.model.motion import History, is_constant
from trbdyn.model.scene import Scene
from trbdyn.model.shaft import angle_turned
from trbdyn.results.result import Result
from trbdyn.run.replay import Replay
from trbdyn.standards.iso281 import LIFE_EXPONENT, SMALLEST_LOAD_SHARE
from trbdyn.standards.loading import Loading, applied_loads, lamina_loads, ring_loads, turning_against_load, values
from trbdyn.standards.sheet import dynamic_rating, equivalent_loads

Array = NDArray[np.float64]

RECORDS: Final = 60
"""Records of a run that are evaluated, at most."""
BETWEEN: Final = 8
"""Parts into which the time between two records, or knots of loads, is cut where loads are prescribed."""
MOST_TIMES: Final = 200_000
"""Most times at which prescribed loads are taken."""
LAMINA_EXPONENT: Final = 4.0
"""Exponent of the life of a line contact in its load (ISO 16281)."""
LIGHT_TIME: Final = 0.01
"""Share of the time below the smallest load from which on it is said."""


@dataclass(frozen=True)
class RunLoads:
    """Loads of a run.

    Attributes
    ----------
    shares : tuple of float
        Share of the time of each stretch (1).
    loadings : tuple of Loading
        What it carries; its lamina loads are ordered by the places of the ring that stands.
    whole : Loading
        All of them together, without loads of laminas.
    """

    shares: tuple[float, ...]
    loadings: tuple[Loading, ...]
    whole: Loading


@dataclass(frozen=True)
class _Samples:
    """Loads (N) and speed between the rings (rpm) at times (s); `largest`: the largest radial load of a turn (N)."""

    time: Array
    axial: Array
    radial: Array
    largest: Array
    speed: Array

    @property
    def lasts(self) -> Array:
        """The time for which each stands (s)."""
        if self.time.size < 2:
            return np.ones(self.time.size)
        edges = np.concatenate([self.time[:1], 0.5 * (self.time[1:] + self.time[:-1]), self.time[-1:]])
        return np.asarray(np.diff(edges))

    @property
    def turns(self) -> Array:
        """Its share of the revolutions; of the time where nothing turns."""
        turns = self.lasts * np.abs(self.speed)
        return turns if turns.sum() > 0.0 else self.lasts


def loads_change(result: Result) -> bool:
    """Whether speed or loads of a run change by what is prescribed; of a bearing on a shaft, as the run says."""
    if "assembly" in result.meta:
        return bool(result.meta["assembly"].get("changes", True))
    return not all(is_constant(one) for one in result.scene.ring_quantities().values())


def of_run(result: Result) -> RunLoads:
    """Loads of a run: of the whole run where they change, of all records where a window was asked for, else after the transient.
    An InputError if the groups cage and rollers were not recorded.
    """
    replay, scene, time = Replay(result), result.scene, np.asarray(result["time"], dtype=float)
    changing, first = loads_change(result), 0
    if not changing and not result.is_window and len(result) > 2:
        first = min(int(np.searchsorted(time, result.settling().time)), len(result) - 1)
    samples = _prescribed(result, first, changing=changing) or _carried(result, first, replay)
    loads = equivalent_loads(scene, samples.axial, samples.radial)
    chosen = _chosen(samples, loads, time, first)
    ends = np.concatenate([[-math.inf], 0.5 * (time[chosen][1:] + time[chosen][:-1]), [math.inf]])
    lasts, turns = samples.lasts, samples.turns
    shares, loadings, pressure = [], [], 0.0
    for index, low, high in zip(chosen.tolist(), ends[:-1], ends[1:], strict=True):
        inside = (samples.time >= low) & (samples.time < high)
        contacts = replay.contacts(index)
        pressure = max(pressure, float(np.max(contacts["raceway_pressure"])))
        if not lasts[inside].sum() > 0.0:
            continue
        weights = turns[inside] if turns[inside].sum() > 0.0 else lasts[inside]
        # a record stands for its stretch: its loads are raised by what the load does between records
        at = float(np.interp(time[index], samples.time, loads))
        mean = float(np.average(loads[inside] ** LAMINA_EXPONENT, weights=weights)) ** (1.0 / LAMINA_EXPONENT)
        laminas = _by_place(lamina_loads(scene, contacts), result, index)
        loadings.append(
            Loading(
                axial_load=_mean(samples.axial[inside], weights),
                radial_load=_mean(samples.radial[inside], weights),
                speed_rpm=_mean(np.abs(samples.speed[inside]), lasts[inside]),
                lamina_loads=laminas * (mean / at if at > 0.0 else 1.0),
                largest_pressure=pressure,
                source="",
                equivalent_load=_mean_load(loads[inside], weights),
            )
        )
        shares.append(float(lasts[inside].sum()))
    if "peaks" in result.groups:
        peaks = result.peaks
        pressure = max([pressure, *(float(np.max(peaks[f"{side}_pressure_peak"])) for side in ("outer", "inner"))])
    total = sum(shares)
    stretch = "the whole run" if changing else "after the transient, as nothing prescribed changes"
    stretch = "the window that was asked for" if result.is_window else stretch
    source = f"{len(loadings)} records from {samples.time[0]:.4g} to {samples.time[-1]:.4g} s, {stretch}"
    whole = _whole(scene, samples, loads, pressure, source, changing=changing)
    return RunLoads(tuple(share / total for share in shares), tuple(loadings), whole)


def _whole(scene: Scene, samples: _Samples, loads: Array, pressure: float, source: str, *, changing: bool) -> Loading:
    speed, turns, lasts = np.abs(samples.speed), samples.turns, samples.lasts
    mean, smallest = _mean_load(loads, turns), SMALLEST_LOAD_SHARE * dynamic_rating(scene)
    light, said = float(np.average(loads < smallest, weights=lasts)), []
    if changing and light > LIGHT_TIME and mean >= smallest:
        said.append(
            f"the load is below the smallest load {smallest:.4g} N (0.02 C) for {100.0 * light:.3g} % of the time: rollers may "
            "slide"
        )
    same = bool(
        np.ptp(samples.axial) == 0.0 and np.ptp(samples.largest) == 0.0 and samples.largest[0] == samples.radial[0]
    )
    moments = () if same else tuple(zip(samples.axial.tolist(), samples.largest.tolist(), strict=True))
    return Loading(
        axial_load=_mean(samples.axial, turns),
        radial_load=_mean(samples.radial, turns),
        speed_rpm=_mean(speed, lasts),
        lamina_loads=None,
        largest_pressure=pressure,
        source=source,
        equivalent_load=mean,
        moments=moments,
        largest_speed_rpm=float(speed.max()),
        said=tuple(said),
    )


def _mean_load(loads: Array, turns: Array) -> float:
    """Steady load with the same basic life: the mean of P^(10/3) over revolutions (N)."""
    if np.all(loads == loads[0]):
        return float(loads[0])
    return float(np.average(loads**LIFE_EXPONENT, weights=turns)) ** (1.0 / LIFE_EXPONENT)


def _mean(of: Array, weights: Array) -> float:
    """Mean of values; the value itself, without rounding, where they are all the same."""
    return float(of[0]) if np.all(of == of[0]) else float(np.average(of, weights=weights))


def _chosen(samples: _Samples, loads: Array, time: Array, first: int) -> NDArray[np.int64]:
    """Records that are evaluated: they part time and damage evenly, both by half, and the heaviest one is among them."""
    count = time.size - first
    if count <= RECORDS:
        return np.arange(first, time.size)
    damage = samples.turns * loads**LIFE_EXPONENT
    total = float(damage.sum())
    parts = samples.lasts / samples.lasts.sum() + (damage / total if total > 0.0 else 0.0)
    ahead = np.concatenate([[0.0], np.cumsum(parts)])[:-1] + 0.5 * parts
    wanted = ahead[-1] * (np.arange(RECORDS - 1) + 0.5) / (RECORDS - 1)
    at = np.append(np.interp(wanted, ahead, samples.time), samples.time[int(np.argmax(loads))])
    own = time[first:]
    nearest = np.clip(np.searchsorted(0.5 * (own[1:] + own[:-1]), at), 0, count - 1)
    return np.unique(np.concatenate([nearest, [0, count - 1]])) + first


def _prescribed(result: Result, first: int, *, changing: bool) -> _Samples | None:
    """Loads that the scene prescribes, also between records; None where a place is prescribed, a shaft carries, or a ring that is
    free answers to loads that change.
    """
    scene, time = result.scene, np.asarray(result["time"], dtype=float)[first:]
    free = scene.ring_body is not None and changing and "ring" in result.groups
    if "assembly" in result.meta or any(scene.ring_is_placed[:3]) or free:
        return None
    if changing:
        histories = [one for one in scene.ring_quantities().values() if isinstance(one, History)]
        knots = [one.knots(float(time[0]), float(time[-1])) for one in histories]
        time = np.unique(np.concatenate([time, *knots]))
        parts = max(1, min(BETWEEN, MOST_TIMES // time.size))
        inner = (time[:-1, None] + np.diff(time)[:, None] * (np.arange(parts) / parts)).ravel()
        time = np.append(inner, time[-1])
    axial, radial, largest = applied_loads(scene, time)
    speed = values(scene.speed_rpm, time) - values(scene.outer_speed_rpm, time)
    if scene.torque is not None:
        speed = np.interp(time, result["time"], result.rolling_speed * 30.0 / math.pi)
    return _Samples(time, axial, radial, largest, speed)


def _carried(result: Result, first: int, replay: Replay) -> _Samples:
    """Loads that the bearing carries at its records."""
    scene, time = result.scene, np.asarray(result["time"], dtype=float)
    kept = np.arange(first, time.size)
    if "ring" in result.groups:
        axial, radial = (one[kept] for one in result.ring_loads)
    else:
        kept = np.unique(np.linspace(first, time.size - 1, RECORDS).round().astype(int))
        found = [
            ring_loads(scene, lamina_loads(scene, replay.contacts(k))[0].sum(axis=-1), result["roller_orbit_angle"][k])
            for k in kept.tolist()
        ]
        axial, radial = np.array(found).T
    axial, radial = np.abs(axial), np.asarray(radial)
    return _Samples(time[kept], axial, radial, radial, result.rolling_speed[kept] * 30.0 / math.pi)


def _by_place(loads: Array, result: Result, index: int) -> Array:
    """Loads of the rollers' laminas (N) in the order of the places of the ring that stands against the load, shape (2, Z, n_s):
    rollers that pass a place load it one after the other.
    """
    scene, count = result.scene, loads.shape[1]
    angle = np.asarray(result["roller_orbit_angle"][index], dtype=float)
    outer, _ = turning_against_load(scene)
    if outer:
        angle = angle - float(result["shaft_angle"][index])
    elif scene.outer_turns:
        angle = angle - angle_turned(scene.outer_speed_rpm, 0.0, float(result["time"][index]))
    order = np.argsort(np.mod(angle, 2.0 * math.pi))
    pitch = 2.0 * math.pi / count
    off = np.mod(angle, 2.0 * math.pi)[order] / pitch - np.arange(count)
    shift = round(
        math.atan2(*(float(np.mean(one(2.0 * math.pi * off / count))) for one in (np.sin, np.cos)))
        * count
        / (2.0 * math.pi)
    )
    return np.roll(loads[:, order], shift, axis=1)
