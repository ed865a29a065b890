"""The default beside three formulas over twelve catalogue bearings, beside a maker's starting torques, and its exponents.

Pure axial load of a tenth of C, VG100, without drag of the oil on either side. Aihara's law of rolling resistance (1987), which
its author confirmed on nearly 200 bearings, with the load of the whole contact and the heat of its inlet, and the default's
torque of the ribs; SKF's model with its inlet and its replenishment of a bath; the formula with f0 and f1, as Schaeffler prints
it (Palmgren). No torque of these bearings was measured here.

The formulas are those of bearings with plenty of oil and of rollers as they are made. So the default is also set beside them with
full supply on either side, and `CHANGES` tell what each of its own parts is worth.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

import trbdyn as trb
from validation import skf

SERIES: Final = {
    "30206": "302",
    "30210": "302",
    "30310": "303",
    "30312": "303",
    "31308": "313",
    "32008": "320X",
    "32012": "320X",
    "32208": "322",
    "32216": "322",
    "32308": "323",
    "33210": "332",
    "33114": "331",
}
"""Designations with their series in SKF's table."""
TEMPERATURES: Final = (50.0, 80.0)
SPEEDS: Final = (1000.0, 3000.0)
LOAD: Final = 0.1
"""Axial load over C."""
FULL: Final[dict[str, Any]] = {"effects.supply": 1.0}
CHANGES: Final[dict[str, dict[str, Any]]] = {
    "rollers without a profile": {"bearing.roller.profile": trb.Profile.straight()},
    "flooded gaps beside the loaded length": {"effects.flooded_gaps": True},
    "elastic hysteresis of 0.01": {"effects.hysteresis": 0.01},
}
"""What is changed beside full supply, each by itself."""


def aihara(scene: trb.Scene) -> float:
    """Torque by Aihara's law (N m), written here a second time."""
    bearing, oil = scene.bearing, scene.lubricant
    geometry, speed = bearing.geometry, float(scene.speed_rpm) * math.pi / 30.0  # type: ignore[arg-type]
    load = float(scene.axial_load)  # type: ignore[arg-type]
    modulus, length = geometry.effective_modulus, bearing.roller.effective_length
    mean = geometry.outer_race_radius * geometry.cage_speed_ratio * speed
    heat = 1.0 / (1.0 + 0.29 * (oil.viscosity * oil.temperature_coefficient * mean**2 / oil.conductivity) ** 0.78)
    each = load / (bearing.n_rollers * math.sin(math.radians(bearing.cup_half_angle_deg)))
    lost = 0.0
    for radius in (geometry.outer_equivalent_radius, geometry.inner_equivalent_radius):
        u, w = oil.viscosity * mean / (modulus * radius), each / (modulus * radius * length)
        g = oil.pressure_coefficient * modulus
        lost += 2.0 * 88.0 * g**-0.342 * u**0.658 * w**0.31 * modulus * radius * length * heat * mean
    return bearing.n_rollers * lost / speed


def torque(scene: trb.Scene) -> float:
    """Torque at the equilibrium (N m)."""
    speed = float(scene.speed_rpm) * math.pi / 30.0  # type: ignore[arg-type]
    return float(np.sum(trb.Simulation(scene).contacts()["power"])) / speed


def rows() -> list[dict[str, Any]]:
    """Every bearing, temperature and speed."""
    found = []
    for name, series in SERIES.items():
        row, bearing = trb.designation(name), trb.Bearing.named(name)
        load = LOAD * row.C
        for t in TEMPERATURES:
            for rpm in SPEEDS:
                scene = trb.Scene(bearing, speed_rpm=rpm, axial_load=load, lubricant=trb.lubricants.iso_vg(100, t))
                contacts = trb.Simulation(scene).contacts()
                rib = float(np.sum(contacts["rib_friction"] * contacts["rib_sliding_speed"]))
                angular = rpm * math.pi / 30.0
                own = float(np.sum(contacts["power"])) / angular
                nu = 1e6 * scene.lubricant.viscosity / scene.lubricant.density
                common = {
                    "bore": row.bore,
                    "outside": row.outside,
                    "Y": 0.4 / math.tan(math.radians(bearing.cup_half_angle_deg)),
                    "speed_rpm": rpm,
                    "axial_load": load,
                    "radial_load": 0.0,
                    "viscosity": nu,
                }
                found.append(
                    {
                        "bearing": name,
                        "temperature_c": t,
                        "speed_rpm": rpm,
                        "axial_load": load,
                        "own": own,
                        "full": torque(scene.replace(FULL)),
                        "changes": {key: torque(scene.replace(FULL | change)) for key, change in CHANGES.items()},
                        "rib": rib / angular,
                        "aihara": aihara(scene) + rib / angular,
                        "skf": skf.torque(series=series, **common),
                        "skf_full": skf.torque(series=series, replenishment=0.0, **common),
                        "palmgren": skf.palmgren(**common),
                    }
                )
    return found


def ratios(found: list[dict[str, Any]], measured: list[dict[str, Any]]) -> dict[str, dict[str, float]]:
    """Median, smallest and largest ratio of the default to each formula, and the median with full supply on either side (SKF's
    formula without its replenishment). `measured` has rows of the first table: medians of what was measured, and of the
    default, over the same formulas there.
    """
    full = {"aihara": "aihara", "skf": "skf_full", "palmgren": "palmgren"}
    out = {}
    for name in full:
        shares = [one["own"] / one[name] for one in found]
        there = [one["options"]["aihara, full supply"] if name == "aihara" else one[name] for one in measured]
        out[name] = {
            "median": float(np.median(shares)),
            "low": min(shares),
            "high": max(shares),
            "full": float(np.median([one["full"] / one[full[name]] for one in found])),
            "measured": float(np.median([one["measured"] / by for one, by in zip(measured, there, strict=True)])),
            "there": float(np.median([one["predicted"] / by for one, by in zip(measured, there, strict=True)])),
        }
    return out


def parts(found: list[dict[str, Any]]) -> dict[str, float]:
    """What each change makes of the torque: median ratio."""
    own = {"full supply": float(np.median([one["full"] / one["own"] for one in found]))}
    return own | {key: float(np.median([one["changes"][key] / one["full"] for one in found])) for key in CHANGES}


def starting_torque(scene: trb.Scene) -> tuple[float, float]:
    """Torque at a tenth of a turn a minute by the default, and NSK's e mu Fa cos(beta) with mu = 0.2 (N m): e from the inner
    raceway to the contact at the rib, beta half the angle of the roller.
    """
    rpm = 0.1
    found = trb.Simulation(scene.replace(speed_rpm=rpm)).contacts()
    bearing = scene.bearing
    own = float(np.sum(found["power"])) / (rpm * math.pi / 30.0)
    load = float(scene.axial_load)  # type: ignore[arg-type]
    return own, bearing.ribs.contact_height * 0.2 * load * math.cos(bearing.geometry.roller_half_angle)


def starts() -> dict[str, float]:
    """Ratio of the default to that starting torque, with an axial load of a fortieth of C; of the 32208 under 2 kN."""
    found = {}
    for name in SERIES:
        load = 2000.0 if name == "32208" else 0.025 * trb.designation(name).C
        scene = trb.Scene(
            trb.Bearing.named(name), speed_rpm=1.0, axial_load=load, lubricant=trb.lubricants.iso_vg(100, 40.0)
        )
        own, maker = starting_torque(scene)
        found[name] = own / maker
    return found


def exponents(scene: trb.Scene, step: float = 1.25) -> dict[str, float]:
    """Exponents of the torque of a scene with viscosity, speed and load (1), at the equilibrium."""

    oil, base = scene.lubricant, torque(scene)
    cooler = oil.temperature_c - 4.0
    colder = scene.replace({"lubricant.temperature_c": cooler})
    by_oil = math.log(colder.lubricant.viscosity / oil.viscosity)
    speed, load = float(scene.speed_rpm), float(scene.axial_load)  # type: ignore[arg-type]
    return {
        "viscosity": math.log(torque(colder) / base) / by_oil,
        "speed": math.log(torque(scene.replace(speed_rpm=step * speed)) / base) / math.log(step),
        "load": math.log(torque(scene.replace(axial_load=step * load)) / base) / math.log(step),
    }
