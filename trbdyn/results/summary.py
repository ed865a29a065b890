"""The numbers of a run that an engineer asks for first: as a dictionary, as JSON, as a table.

Averages are taken over the window after the transient (``window_start`` to ``window_end``), half of the run at least; peaks,
smallest films and impacts are those of the whole run, with their times. Whether the
motion has settled there is told in three answers, in ``settling``: settled, drifting (with its time scale) or unknown, which
means that it cannot be told from this run (see `Result.settling`). Energies are those of the whole run. Numbers whose fields were
not recorded, or that do not exist (a whirl ratio at standstill), are None.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.base.own_files import write_whole
from trbdyn.base.shown import Displayed, Shown
from trbdyn.cage.simulated import cage_modes
from trbdyn.errors import TrbError
from trbdyn.model.motion import is_constant
from trbdyn.results import conditions, notes, observables
from trbdyn.results.confidence import confidence
from trbdyn.results.fields import carrying
from trbdyn.results.quantities import QUANTITIES
from trbdyn.standards.loading import at_equilibrium
from trbdyn.standards.sheet import Rating, life_text, sheet

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene
    from trbdyn.results.result import Result

RATINGS: Final = (
    "equivalent_load",
    "axial_load_left_out",
    "permissible_axial_load",
    "smallest_load",
    "modified_life_hours",
    "reference_life_hours",
    "modified_reference_life_hours",
    "static_safety",
    "viscosity_ratio",
    "speed_over_limit",
)
"""Numbers of the engineer's sheet that a summary has under the sheet's names."""

UNPRINTED: Final = ("settled", "settling_time_scale", "settling_reason", "confidence")
"""Entries that the table leaves out, as another one tells them."""

RECORDS_AT_ONCE: Final = 4096
"""Records whose deformed cages are in memory together."""


class Summary(dict[str, Any], Displayed):
    """The summary of a run: a dictionary of plain values that prints as a table with units."""

    def __repr__(self) -> str:
        return table(self)

    __str__ = __repr__

    def _shown(self) -> Shown:
        return shown(self)


def summary(result: Result) -> Summary:
    """Summarise a run.

    Parameters
    ----------
    result : Result
        The run.

    Returns
    -------
    Summary
        A dictionary: numbers by the names of `trbdyn.results.quantities.QUANTITIES`, SI units; ``torque_split`` and
        ``power_split`` are dictionaries.
    """
    out: dict[str, Any] = {"success": result.success, "message": result.message}
    out |= {"revolutions": result.revolutions, "duration": result.duration}
    if len(result) > 1:
        out |= _motion(result)
    out |= _running_plays(result.scene) | _deflection(result)
    out |= ratings(steady_sheet(result))
    out |= _cost(result)
    out["accuracy_note"] = result.meta.get("accuracy") or None
    return Summary({name: clean(out.get(name)) for name in QUANTITIES})


def _running_plays(scene: Scene) -> dict[str, Any]:
    """Plays of the pockets where they are not those of the drawing."""
    if scene.growth is None or not scene.effects.has_cage:
        return {}
    radial, circumferential = scene.running_plays
    return {"running_play_radial": radial, "running_play_circumferential": circumferential}


def _deflection(result: Result) -> dict[str, Any]:
    """Largest displacement of the middle of a face by the modes of an elastic cage's finite-element model, at any record."""
    elastic = result.scene.elastic_cage
    is_file = elastic is not None and (elastic.file or result.scene.bearing.cage.drawing) is not None
    if elastic is None or is_file or "cage" not in result.groups:
        return {}  # a summary opens no file whose name stands in a result
    shape, largest = cage_modes(result.scene).shape[:, :, :3], 0.0
    for first in range(0, len(result), RECORDS_AT_ONCE):
        amplitude = result["cage_mode"][first : first + RECORDS_AT_ONCE]
        largest = max(largest, float(np.linalg.norm(np.tensordot(amplitude, shape, 1), axis=2).max()))
    return {"cage_deflection": largest}


def steady_sheet(result: Result) -> Rating | None:
    """The engineer's sheet (`trbdyn.rating`) of a scene whose speed and loads are constant; its equilibrium takes some 10 ms.

    None where they change, and of a bearing on a shaft, whose scene has no loads: there the records make the sheet.
    """
    scene = result.scene
    constant = all(is_constant(quantity) for quantity in scene.ring_quantities().values())
    if not constant or scene.rotating_load is not None or "assembly" in result.meta:
        return None
    try:
        return sheet(scene, at_equilibrium(scene))
    except TrbError:
        return None


def ratings(found: Rating | None) -> dict[str, Any]:
    """Numbers of a sheet by their names in a summary."""
    if found is None:
        return {}
    return {"basic_life_hours": found.life_hours} | {name: getattr(found, name) for name in RATINGS}


def _motion(result: Result) -> dict[str, Any]:
    groups = set(result.groups)
    out: dict[str, Any] = {"settled": False, "settling": "unknown"}
    if {"cage", "rollers"} <= groups:
        found = result.settling()
        out |= {"settled": found.settled, "settling": found.answer, "settling_reason": found.reason or None}
        out |= {"settling_time_scale": found.time_scale, "creep_time": found.creep_time}
        out["settling_needed"] = found.needed
        window = result.window(found.time)
        unsettled = "" if found.settled else found.reason
    else:
        out["settling_reason"] = unsettled = "the groups cage and rollers were not recorded"
        window = result.window(float(result["time"][len(result) // 2]))
    time = window["time"]
    out |= {"window_start": float(time[0]), "window_end": float(time[-1])}
    out["speed_rpm"] = float(window["shaft_speed"].mean()) * 30.0 / np.pi
    if window.scene.outer_turns:
        out["outer_speed_rpm"] = float(window.outer_speed.mean()) * 30.0 / np.pi
    out |= averages(window) | extremes(result)
    out["changing"] = conditions.words(result)
    if "pocket_force_peak" in out and notes.load_drops(result):
        out["pocket_force_peak_low"], out["pocket_force_peak_high"] = notes.drop_band(out["pocket_force_peak"])
    out["confidence"], out["confidence_note"] = confidence(window, averages, unsettled)
    if not result.has_cage:
        out |= dict.fromkeys(name for name in out if name.startswith("pocket_"))
    if "energy" in groups:
        audit = result.energy_audit
        out |= {"energy_closure": audit.closure, "energy_residual": audit.residual}
    return out


def averages(window: Result) -> dict[str, Any]:
    parts: dict[str, Callable[[Result], dict[str, Any]]] = {
        "cage": _cage,
        "rollers": _rollers,
        "pocket": _pocket,
        "peaks": _means_of_loads,
        "torque": _torque,
        "power": _power,
    }
    out: dict[str, Any] = {}
    for group, part in parts.items():
        if group in window.groups and (window.has_cage or group not in ("cage", "pocket")):
            out |= part(window)
    return _contacts(window) | out


def _cage(window: Result) -> dict[str, Any]:
    orbit, distance, motion = window.orbit_radius_over_cpr, window.axis_distance_over_cpr, window.cage_motion
    (orbit_low, orbit_high), (low, high) = np.percentile(orbit, (5.0, 95.0)), np.percentile(distance, (5.0, 95.0))
    return {
        "cage_speed_ratio": window.cage_speed_ratio,
        "cage_motion": motion.kind,
        "orbit_rms_over_cpr": motion.orbit_over_play,
        "orbit_radius_over_cpr_p05": orbit_low,
        "orbit_radius_over_cpr_p95": orbit_high,
        "axis_distance_over_cpr": distance.mean(),
        "axis_distance_over_cpr_p05": low,
        "axis_distance_over_cpr_p95": high,
        "whirl_ratio": window.whirl_ratio,
        "whirl_frequency": window.whirl_frequency,
        "whirl_coherence": motion.whirl_coherence,
        "speed_deviation_ratio": motion.speed_deviation_ratio,
        "axial_over_clearance": window.axial_motion.mean(),
        "lean_mean": observables.lean(window["cage_position"], window["cage_tilt"]).mean(),
        "tilt_rms": np.sqrt(np.mean(np.sum(window["cage_tilt"] ** 2, axis=1))),
    }


def _kinematic_ratio(window: Result) -> float | None:
    """Speed of the cage over that of the shaft, or of the outer ring where the shaft rests, in pure rolling."""
    ratio: float | None = window.geometry.get("cage_speed_ratio")
    if ratio is None or not window.scene.outer_turns:
        return ratio
    return float(window.rolling_orbit.mean() / window.turning_speed.mean())


def _rollers(window: Result) -> dict[str, Any]:
    return {
        "cage_speed_ratio_kinematic": _kinematic_ratio(window),
        "cage_slip": window.cage_slip.mean() if "cage_speed_ratio" in window.geometry else None,
        "spacing_std_deg": window.spacing_std.mean(),
        "skew_rms": np.sqrt(np.mean(window["roller_skew"] ** 2)),
    }


def _pocket(window: Result) -> dict[str, Any]:
    force = window["pocket_force"]
    touched = force[force > 0]
    return {
        "pocket_force_p95": np.percentile(touched, 95.0) if touched.size else 0.0,
        "pocket_duty": (force > 0).any(axis=2).mean(),
    }


def _loaded_mean(values: Any, load: Any) -> float | None:
    """Mean weighted by load; None: the thickness of a film that carries nothing has no meaning."""
    total = float(load.sum())
    return float((values * load).sum() / total) if total > 0.0 else None


def _contacts(window: Result) -> dict[str, Any]:
    out: dict[str, Any] = {}
    for side in carrying(window):
        load = window[f"{side}_load"]
        out[f"{side}_load_mean"] = load.mean()
        if f"{side}_film_parameter" in window:
            out[f"film_parameter_{side}"] = _loaded_mean(window[f"{side}_film_parameter"], load)
    return out


def _means_of_loads(window: Result) -> dict[str, Any]:
    """Time integrals between the ends of steps, in place of means of records."""
    peaks = window.peaks
    return {f"{side}_load_mean": peaks[f"{side}_load_mean"].mean() for side in carrying(peaks, "_load_peak")}


def extremes(result: Result) -> dict[str, Any]:
    """Extremes of a run at the ends of all its steps, not those of its records, each with its time (s); and its impacts."""
    if "peaks" not in result.groups:
        return {}
    peaks = result.peaks
    out: dict[str, Any] = {}

    def put(name: str, peak: str, *, smallest: bool = False) -> None:
        values = np.atleast_1d(peaks[peak])
        if np.isnan(values).all():
            out[name] = out[f"{name}_time"] = None
            return
        at = int(np.nanargmin(values) if smallest else np.nanargmax(values))
        out[name] = float(values.flat[at])
        out[f"{name}_time"] = float(np.atleast_1d(peaks[f"{peak}_time"]).flat[at])

    for side in carrying(peaks, "_load_peak"):
        if f"{side}_pressure_peak" in peaks:
            put(f"{side}_pressure_max", f"{side}_pressure_peak")
            put(f"film_parameter_{side}_min", f"{side}_film_parameter_min", smallest=True)
    if result.scene.effects.guidance != "rollers":
        put("land_force_peak", "land_force_peak")
        put("land_gap_min", "land_gap_min", smallest=True)
    if result.has_cage:
        put("pocket_force_peak", "pocket_force_peak")
        out["pocket_impacts"] = int(peaks["pocket_impacts"].sum())
        out["pocket_impulse_peak"] = peaks["pocket_impulse_peak"].max()
    return out


def _torque(window: Result) -> dict[str, Any]:
    inner, outer = shaft_torque(window), float(window["outer_torque"].mean())
    return {
        "torque": inner,
        "torque_outer": outer,
        "torque_note": notes.torque_note(window, inner, outer),
        "rolling_note": notes.rolling_note(window),
        "torque_split": window.torque_split,
    }


def shaft_torque(window: Result) -> float:
    """Mean friction torque of the shaft (N m): the work of both rings' drives over the turn between the rings, which records
    between impacts do not alias.

    The mean of the records where the work was not recorded, or is not that of friction alone: where the rings do not turn against
    each other in one direction, a torque turns the shaft, or other bearings sit on it.
    """
    speed = window.rolling_speed
    if window.scene.torque is not None or "assembly" in window.meta:
        return float(window["inner_torque"].mean())
    one_way = bool(np.all(speed > 0.0) or np.all(speed < 0.0))
    if "energy" not in window.groups or not one_way or len(window) < 2:
        return float(window["inner_torque"].mean())
    rolled = window.rolled
    return float((window["work_shaft"][-1] - window["work_shaft"][0]) / abs(rolled[-1] - rolled[0]))


def mean_loss(window: Result) -> float:
    """Mean power loss (W): energy lost over time, which records between impacts do not alias; of the records without it."""
    if "energy" not in window.groups or len(window) < 2:
        return float(window["power_loss"].mean())
    losses = [field.name for field in window.fields if field.name.startswith("loss_")]
    time = window["time"]
    return float(sum(window[name][-1] - window[name][0] for name in losses) / (time[-1] - time[0]))


def _power(window: Result) -> dict[str, Any]:
    split = window.power_split
    lost = sum(split.values())
    return {
        "drag_share": split.get("drag", 0.0) / lost if lost > 0.0 else None,
        "power_loss": mean_loss(window),
        "power_split": split,
        "torque_by_loss": window.torque_by_loss,
    }


def _cost(result: Result) -> dict[str, Any]:
    """Cost of the run; wall time per revolution is that of stepping where the statistics tell it."""
    out = {name: result.stats.get(name) for name in ("steps", "rhs_evaluations", "wall_s", "wall_s_per_revolution")}
    if not math.isfinite(out["wall_s_per_revolution"] or math.nan) and out["wall_s"] is not None and result.revolutions:
        out["wall_s_per_revolution"] = out["wall_s"] / result.revolutions
    return out | {"followed_frequency": _followed(result)}


FOLLOWED: Final = math.sqrt(3.0 * 0.01)
"""Phase of a vibration in a step by which BDF of order 2 lowers its frequency by 1 % (rad).

For y' = i w y its formula, whose root is exp(l) with l = i w h + l^3 / 3 - l^4 / 4 + ..., lowers the frequency by the share
(w h)^2 / 3 and takes the share pi (w h)^3 / 2 of the amplitude in a period, to leading order in the step h: 0.8 % here.
"""


def _followed(result: Result) -> float | None:
    """Frequency (Hz) up to which vibrations keep their frequency within 1 %, from the mean step; None for another method."""
    settings, step = result.meta.get("settings"), result.stats.get("mean_step_s") or math.nan
    if (
        not isinstance(settings, Mapping)
        or settings.get("integrator", "bdf") != "bdf"
        or settings.get("max_order", 2) > 2
    ):
        return None
    return FOLLOWED / (2.0 * math.pi * step)


def clean(value: Any) -> Any:
    """Plain Python, as strict JSON takes it: numbers that are not finite become None."""
    if isinstance(value, Mapping):
        return {name: clean(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [clean(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_json(values: Mapping[str, Any], path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
    """Write a summary as JSON.

    Parameters
    ----------
    values : mapping
        What `summary` gave.
    path : path-like
        File to write.
    overwrite : bool
        Replace a file that is there.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    text = json.dumps(values, indent=2, allow_nan=False) + "\n"
    return write_whole(path, text, overwrite=overwrite, field="summary")


def table(values: Mapping[str, Any]) -> str:
    """A summary as a table for people: words, number, unit; entries that are None are left out, sentences follow the table."""
    return shown(values).text(columns=3)


def shown(values: Mapping[str, Any]) -> Shown:
    """A summary as a table: words, number, unit, and the name in the summary."""
    rows: list[tuple[str, ...]] = []
    below: list[str] = []
    for name, (words, unit, _) in QUANTITIES.items():
        value = values.get(name)
        if value is None or name in UNPRINTED:
            continue
        if name == "settling":
            rows.append(("settled", _settled_words(values), "", name))
        elif name in ("torque_note", "rolling_note", "confidence_note", "accuracy_note"):
            below.append(f"{words}: {value}")
        elif isinstance(value, Mapping):
            rows.append((words, "", "", name))
            rows.extend(
                (f"    {part.replace('_', ' ')}", _number(entry), unit) for part, entry in value.items() if entry
            )
        else:
            number = _number(value, (values.get("confidence") or {}).get(name))
            rows.append((words, life_text(value) if unit == "h" else number, unit, name))
    return Shown(rows=tuple(rows), head=("quantity", "value", "unit", "name"), notes=tuple(below))


def _settled_words(values: Mapping[str, Any]) -> str:
    reason = values.get("settling_reason") or ""
    return {"settled": "yes", "drifting": "no, it drifts: "}.get(values["settling"], "cannot be told: ") + reason


def _number(value: Any, half_width: float | None = None) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    number = f"{value:.5g}" if isinstance(value, float) else str(value)
    return number if half_width is None else f"{number} ± {half_width:.2g}"
