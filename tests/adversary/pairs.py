"""Random bearings on one shaft, judged as single ones are: energy, losses and speeds beside a run with tighter tolerances."""

from __future__ import annotations

import math
import time as clock
import warnings
from typing import Any

import numpy as np
import random_scenes as scenes

import trbdyn as trb

Table = dict[str, Any]

ORDINARY: Table = {
    "arrangement": "back to back",
    "left": {},
    "right": {},
    "speed_rpm": 3000.0,
    "spread": 0.15,
    "end_play": -20e-6,
    "spring": None,
    "axial": 0.0,
    "radial": 0.0,
    "position": 0.0,
    "moment": 0.0,
    "end_share": None,
    "drop_share": None,
    "drop_rise": 1e-3,
    "history_s": 5e-3,
    "shaft_mass": 6.0,
    "mass_position": 0.0,
    "unbalance_share": 0.0,
    "damping": 0.0,
    "torque": None,
    "accuracy": "standard",
    "seed": 0,
}
"""What a table that says nothing means; loads of the shaft are over the dynamic rating of its smaller bearing, 30310: 130 kN."""
RATING = 130e3


def pair(rng: np.random.Generator) -> Table:
    """Two bearings on a shaft: equal or not, loose or pressed together, with forces, unbalance, a torque, loads that go."""
    low_load = bool(rng.random() < 0.3)
    table: Table = {
        "arrangement": scenes._one_of(rng, "back to back", "face to face"),
        "speed_rpm": scenes._log(rng, 50.0, 12e3) * scenes._one_of(rng, 1.0, -1.0),
        "end_play": float(rng.uniform(-80e-6, 60e-6)),
        "axial": float(rng.uniform(-0.08, 0.08)) * (0.1 if low_load else 1.0),
        "radial": scenes._log(rng, 1e-3, 0.15) * (0.1 if low_load else 1.0),
        "position": float(rng.uniform(-0.1, 0.25)),
        "shaft_mass": scenes._log(rng, 0.5, 100.0),
        "accuracy": scenes._one_of(rng, "fast", "standard", "standard", "reference"),
        "seed": int(rng.integers(1000)),
    }
    table["spread"] = float(
        rng.uniform(0.12, 0.4) if table["arrangement"] == "back to back" else rng.uniform(0.07, 0.3)
    )
    for side in ("left", "right"):
        one: Table = {
            "bearing": scenes._one_of(rng, "30310", "30310", "32216"),
            "temperature_c": float(rng.uniform(20.0, 100.0)),
            "effects": scenes._one_of(rng, "paper", "standard", "standard"),
        } | scenes._start(rng)
        options: Table = {
            "gravity": lambda: False,
            "cage_mass": lambda: scenes._log(rng, 0.1, 10.0),
            "play": lambda: scenes._log(rng, 0.3, 3.0),
            "scatter": lambda: scenes._log(rng, 1e-7, 1e-5),
            "oil_fill": lambda: scenes._log(rng, 1e-3, 0.5),
            "lubrication": lambda: scenes._one_of(rng, "mixed", "full_film", "boundary", "dry"),
            "nodes": lambda: int(rng.integers(4, 24)),
        }
        for name, draw in options.items():
            if rng.random() < 0.15:
                one[name] = draw()
        table[side] = one
    more: Table = {
        "moment": lambda: float(rng.uniform(-100.0, 100.0)),
        "mass_position": lambda: float(rng.uniform(-0.1, 0.2)),
        "unbalance_share": lambda: scenes._log(rng, 1e-3, 0.3),
        "damping": lambda: scenes._log(rng, 1.0, 1e4),
        "end_share": lambda: scenes._one_of(rng, 0.0, -1.0, float(rng.uniform(0.0, 2.0))),
        "torque": lambda: float(rng.uniform(-10.0, 20.0)),
        "spring": lambda: scenes._log(rng, 100.0, 5000.0),
    }
    for name, draw in more.items():
        if rng.random() < 0.2:
            table[name] = draw()
    if table.get("torque") is not None:
        table.pop("unbalance_share", None)
    for side in ("left", "right"):
        if rng.random() < 0.25:
            table[side] |= {
                "housing_mass": scenes._log(rng, 0.2, 100.0),
                "housing_stiffness": scenes._log(rng, 1e7, 1e10),
                "housing_damping": scenes._log(rng, 1.0, 1e5),
            }
    # drawn last, so that a seed's other entries stay what they were
    for side in ("left", "right"):
        if table[side]["bearing"] == "30310" and rng.random() < 0.2:
            table[side].pop("cage_mass", None)
            table[side]["elastic_modes"] = int(scenes._log(rng, 1.0, 25.0))
    if "end_share" not in table and rng.random() < 0.2:
        table |= {
            "drop_share": scenes._one_of(rng, 0.0, scenes._log(rng, 1.2, 5.0)),
            "history_s": scenes._log(rng, 2e-3, 2e-2),
        }
        table["drop_rise"] = scenes._log(rng, 1e-4, 0.3 * table["history_s"])
    return table


def make(table: Table) -> trb.Assembly:
    """The assembly that a table stands for.

    Raises
    ------
    TrbError
        If it is refused.
    """
    t = ORDINARY | table
    ends = ("right", "left") if t["arrangement"] == "back to back" else ("left", "right")
    bearings = []
    for name, sign, small in zip(("left", "right"), (-1.0, 1.0), ends, strict=True):
        own = scenes.ORDINARY | {"seed": t["seed"]} | t[name]
        sprung = t["spring"] is not None and name == "right"
        bearing = scenes._bearing(own)
        housing = None if own["housing_mass"] is None else scenes._housing(own, bearing)
        if housing is not None and sprung:
            housing = housing.replace(support_axial=0.0)  # the spring's force does not change
        bearings.append(
            trb.ShaftBearing(
                bearing,
                name=name,
                position=0.5 * sign * t["spread"],
                small_ends=small,
                end_play=0.0 if sprung else 0.5 * t["end_play"],
                spring=trb.PreloadSpring(force=t["spring"]) if sprung else None,
                lubricant=trb.lubricants.vg100(own["temperature_c"]),
                effects=scenes._effects(own),
                start=scenes._start_of(own),
                housing=housing,
                elastic_cage=scenes._elastic_cage(own),
                defects=scenes._defects(own, bearing),
            )
        )
    mass, speed = t["shaft_mass"], abs(t["speed_rpm"]) * math.pi / 30.0
    shaft = trb.Shaft.hollow_cylinder(
        mass=mass, outer_diameter=0.06, length=0.3 + t["spread"], mass_position=t["mass_position"]
    ).replace(damping=t["damping"], unbalance=t["unbalance_share"] * t["radial"] * RATING / max(speed, 50.0) ** 2)

    def force(size: float) -> float | trb.History:
        if t["drop_share"] is not None:
            return scenes.dropped(size, t["drop_share"], t["history_s"], t["drop_rise"])
        if t["end_share"] is None:
            return size
        return trb.History.ramp(0.2 * t["history_s"], 1.2 * t["history_s"], size, t["end_share"] * size)

    angle = np.random.default_rng(t["seed"]).uniform(0.0, 2.0 * math.pi)
    across = [force(RATING * t["radial"] * part) for part in (math.cos(angle), math.sin(angle))]
    load = trb.ShaftLoad(position=t["position"], force=(*across, force(RATING * t["axial"])), moment=(t["moment"], 0.0))
    return trb.Assembly(shaft=shaft, bearings=bearings, loads=(load,), speed_rpm=t["speed_rpm"], torque=t["torque"])


def duration_of(table: Table) -> float:
    """Half a turn of the shaft, between 3 and 50 ms; loads that change to their end."""
    t = ORDINARY | table
    turn = min(max(30.0 / abs(t["speed_rpm"]), 3e-3), 0.05)
    return turn if t["end_share"] is t["drop_share"] is None else max(turn, 1.5 * t["history_s"])


def run(assembly: trb.Assembly, duration: float, **options: Any) -> tuple[dict[str, Any], trb.AssemblyResult]:
    """What a run gave: loss (J), mean speeds of the rollers over pure rolling, closure, warnings, how it ended."""
    began = clock.process_time()
    with warnings.catch_warnings(record=True) as of_input:
        warnings.simplefilter("always")
        sim = trb.Simulation(assembly, **options)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        result = sim.run(duration=duration, save_every=duration / 100)
    audit, stored = result.energy, sum(float(one["kinetic_energy"].max()) for one in result.values())
    lost = sum(
        float(one[entry.name][-1] - one[entry.name][0])
        for one in result.values()
        for entry in one.fields
        if entry.name.startswith("loss_")
    )
    speeds = []
    for one in result.values():
        kinematic = one.scene.bearing.geometry.cage_speed_ratio * float(np.abs(one["shaft_speed"]).max()) * duration
        least = 10.0 * one.scene.bearing.cage.play_circumferential / (0.5 * one.scene.bearing.pitch_diameter)
        path = float(np.mean(one["roller_orbit_angle"][-1] - one["roller_orbit_angle"][0]))
        speeds.append(path / max(kinematic, least))
    scale = max(abs(audit.dissipated), sum(map(abs, audit.work.values())), 1e-3 * stored, 1e-9)
    found = {
        "status": "done" if result.success else "ended",
        "message": result.message,
        "time": float(result.time[-1]),
        "steps": result.stats["steps"],
        "cpu_s": clock.process_time() - began,
        "loss": lost,
        "closure": abs(audit.residual) / scale,
        "stored": stored,
        "speeds": speeds,
        "warnings": [text for text in result.warnings if text not in {str(one.message) for one in of_input}],
    }
    return found, result


scenes.KINDS["pair"] = pair
